"""A skew body in a small banked bowl beside a rough wall, its friction unlike each way, by closed forms."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes

from feederscrew.conveying import answer
from feederscrew.conveying.answer import at_radius
from feederscrew.dropping.kernel import body
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.base import Sensor
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import course, part_poses, queue, runs, shape, staging

BOWL = awkward.bowl()
PART, ASPECTS = awkward.part()
EVERY = awkward.lying()
SOLID, LENGTH, PRINCIPAL = shape.solid_of(PART)
BLOCK = shapes.part(shapes.box(20, 12, 5))


def point_velocity(bowl, distance):
    """Velocity [m/s] along the wall of a point so far from it: nearer to the axis it is shaken less."""
    off = bowl.track.radius - distance
    there = answer.answer(at_radius(bowl, float(off)))
    return there.velocity * bowl.track.radius / off


def test_a_skew_body_travels_as_a_point_where_its_centre_of_mass_is():
    """In three of the ways it lies, 11 to 15 mm from a wall of 150: 4 to 6 % faster than at the wall."""
    sent = [k for k, one in enumerate(EVERY) if one.name in ("A@268", "B@217", "C@330")]
    seen = course.course(PART, BOWL, EVERY, course.Sending(sent, 3), (), run=RunSettings(2))
    assert (seen.fates == course.PASSED).all() and (seen.orientations[-1] == sent).all()
    own = [point_velocity(BOWL, EVERY[k].distance) for k in sent]
    assert seen.velocities == pytest.approx(own, rel=0.02)
    assert (np.array(own) > 1.035 * answer.answer(BOWL).velocity).all()


@pytest.mark.parametrize("aspect", ["A", "C"])
@pytest.mark.parametrize(("ahead", "friction"), [(0.6, 0.42), (-0.6, 0.55)])
def test_a_skew_body_slides_round_the_bowl_until_floor_and_wall_have_stopped_it(aspect, ahead, friction):
    """The wall bears what the tilted floor pushes at it with, and what keeps the body on its circle."""
    track = replace(BOWL.track, climb=0.0)
    still = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0), track=track)
    one = next(one for one in EVERY if one.aspect == aspect)
    known, stage = runs.setting(SOLID, LENGTH, still), staging.plain(track, EVERY, 0.5)
    state = part_poses.pose_on_track(one, PRINCIPAL, LENGTH, track, place=0.2)
    state[body.Z] -= part_poses.lowest(SOLID.corners, state)
    state = part_poses.clear(state, SOLID, track, LENGTH, 0.0)
    x, y = LENGTH * state[0], track.radius - LENGTH * state[1]
    off, up = np.hypot(x, y), part_poses.matrix(state)[2]
    state[body.VX : body.VX + 2] = ahead * np.array([y, x]) / off * known.unit / LENGTH
    state[body.W : body.W + 3] = up * ahead / off * known.unit
    limits = (0.25, 1.0, 0.0, 10.0)
    ride = runs.ride(runs.past(known, stage, limits=limits, interval=1.0, places=1), state[None], np.zeros(1))
    turning = 1.0 + (up**2 * SOLID.inertia).sum() * LENGTH**2 / off**2  # of its inertia, over its mass
    wall = 0.27 * track.radius / off  # it rubs farther out than the centre of mass is
    braked = 9.81 * (friction / np.cos(track.bank) + wall * np.tan(track.bank))
    way = 0.5 * off / wall * turning * np.log(1.0 + wall / off * ahead**2 / braked)
    assert ride.distances[0] * off / track.radius == pytest.approx(np.sign(ahead) * way, rel=0.012)


@pytest.mark.parametrize("radius", [50.0, 0.15])
def test_blocks_that_touch_leave_as_near_to_each_other_as_their_inner_corners_let_them(radius):
    """Their outer corners are at the wall; the inner ones, 12 mm nearer to the axis, touch."""
    bowl = awkward.bowl(f"track.radius={radius} m")
    aspects = find(BLOCK)
    every = orientations(BLOCK, aspects, bowl.track)
    flat = next(one for one in every if one.height < 6e-3 and one.length > 0.015)
    shares = np.array([one is flat for one in every], float)
    plan = queue.QueuePlan(4, 3.0, 0.0)
    found = queue.queue_of(BLOCK, bowl, aspects, every, every, shares, plan, RunSettings(3))
    pitch = 2.0 * radius * np.arctan(0.01 / (np.sqrt(radius**2 - 0.01**2) - 0.012))  # 20 and 21.8 mm
    assert found.velocity == pytest.approx(point_velocity(bowl, flat.distance), rel=0.02)
    assert found.rate == pytest.approx(found.velocity / pitch, rel=0.01)
    # they came out of level by 0.2 deg, 17 um over their height
    assert found.gap < 5e-5 and found.jams == found.returned == 0
    assert found.leaving.sum() == found.leaving[every.index(flat)] == 4


@pytest.mark.parametrize("place", [-0.2, 0.33])
def test_a_sensor_tells_orientations_of_a_skew_body_apart_anywhere_round_the_bowl(place):
    known, level = runs.setting(SOLID, LENGTH, BOWL), -5e-3
    for like in EVERY[::7]:
        seen = {sees: Sensor(place, sees, (like,), 3e-4, 1e-4) for sees in ("height", "outline", "side")}
        for one in EVERY:
            state = part_poses.pose_on_track(one, PRINCIPAL, LENGTH, BOWL.track, place=place)
            state[body.Z] += level / LENGTH
            blown = {sees: runs.blows_off(of, known, state[None], level) for sees, of in seen.items()}
            assert blown["height"] == (abs(one.height - like.height) > 3e-4)
            assert one is not like or not (blown["outline"] or blown["side"])
            long = abs(one.length - like.length) + abs(one.width - like.width)
            assert long < 4e-3 or blown["outline"]
