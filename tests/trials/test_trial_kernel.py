"""One part on the moving track against closed forms: a block, and a skew body in a small banked bowl.

The skew body lies beside a rough wall, and its friction is unlike each way: see ``awkward``.
"""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from block_rides import ASPECTS, BOWL, EVERY, FLAT, LENGTH, PART, aspects_of, laid, ridden, sent, still

from feederscrew.arrivals import plate_test
from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.launch_conditions import named, sample
from feederscrew.base.geometry import vectors
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.features import Sensor
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.motion import conveying as answer
from feederscrew.motion.conveying import at_radius
from feederscrew.sorting.orientations import orientations
from feederscrew.trials import course, looks, part_poses, queue, runs, shape, staging

LEVEL = still(climb=0.0)
STEEP, TURNED = [[0.34, 0.0, -0.94], [0.0, 1.0, 0.0]], [[0.71, 0.71, 0.0], [-0.5, 0.5, 0.71]]
BELOW, BESIDE = [[9.0, 0.0, -4.0], [9.0, 60.0, -4.0]], [[9.0, 60.0, 0.0], [9.0, 60.0, -4.0]]
LOWER, OUTER = (STEEP, [3.0, 30.0, -4.0], [0.2, 0.0], BELOW), (TURNED, [3.5, 65.5, -2.0], [0.2, -0.2], BESIDE)
SKEW_BOWL, SKEW_EVERY = awkward.bowl(), awkward.lying()


def placed(one=FLAT, bowl=BOWL):
    return laid(PART, one, bowl, aside=1e-3)


def test_a_flat_part_slides_as_the_point_mass_and_turns_about_the_axis_of_the_bowl():
    _, ride = ridden(PART, BOWL, placed(), 0.6, interval=1.0 / 60.0, places=2000)
    path = ride.paths[0][np.isfinite(ride.paths[0][:, 0])]
    half = len(path) // 2
    speed = (path[-1, 1] - path[half, 1]) / (path[-1, 0] - path[half, 0])
    assert speed == pytest.approx(answer.answer(BOWL).velocity, rel=0.02)
    assert ride.depths[0] < 1e-6 and ride.gains[0] < 1e-7
    state = placed(next(one for one in EVERY if one.height < 6e-3 and one.length < 0.013))[None]
    radius = BOWL.track.radius / LENGTH
    there = part_poses.move_along_wall(state, 30.0, radius)
    assert part_poses.ways_along_wall(there, radius)[0] == pytest.approx(30.0)
    np.testing.assert_allclose(part_poses.move_along_wall(there, -30.0, radius), state, atol=1e-9)
    np.testing.assert_allclose(part_poses.quaternion(part_poses.matrix(state[0])), state[0][6:10], atol=1e-12)


@pytest.mark.parametrize(("climb", "slides"), [(0.99, False), (1.01, True)])
def test_a_part_at_rest_slides_beyond_its_friction_angle(climb, slides):
    bowl = still(climb=climb * np.arctan(0.4))
    _, ride = ridden(PART, bowl, placed(bowl=bowl), 0.5)
    steep = np.sin(bowl.track.climb) - 0.4 * np.cos(bowl.track.climb)
    way = -0.5 * bowl.gravity * steep * 0.25 if slides else 0.0
    assert ride.distances[0] == pytest.approx(way, abs=2e-6, rel=0.02)


def test_a_corner_hit_rebounds_by_its_restitution():
    part = shapes.part(shapes.box(10, 10, 10))
    solid, length, _ = shape.solid_of(part)
    state, far = np.zeros(body.STATE), np.linalg.norm(solid.corners[0])
    up = solid.corners[0] / far  # this corner down, under the centre of mass
    turn = np.cross(up, [0.0, 0.0, -1.0])
    half = 0.5 * np.arctan2(np.linalg.norm(turn), -up[2])
    axis = turn / np.linalg.norm(turn)
    state[body.Q], state[body.Q + 1 : body.Q + 4] = np.cos(half), np.sin(half) * axis
    fall = 1.0
    state[:3] = 0.0, 2.0, far + fall
    landing, bowl = np.sqrt(2.0 * fall), replace(LEVEL, restitution=0.3)
    unit = runs.setting(solid, length, bowl).unit
    _, ride = ridden(part, bowl, state, (landing + 0.3 * landing) * unit)
    height = ride.states[0][body.Z] - far
    assert height == pytest.approx(0.3**2 * fall, rel=0.03)  # e2 h, at the top of its rebound


@pytest.mark.parametrize("amplitude", [0.0, 1.0, 4.0])
def test_what_a_part_has_gravity_and_the_drive_gave(amplitude):
    drive, state = replace(BOWL.drive, amplitude=amplitude * BOWL.drive.amplitude), placed()
    state[body.Z] += 1.0
    state[body.W : body.W + 3] = 2.0, -1.5, 1.0
    _, ride = ridden(PART, replace(BOWL, drive=drive), state, 0.4)
    assert ride.gains[0] < 1e-6  # as a height [m]; it falls from 13e-3


def test_a_part_that_is_not_convex_lands_as_on_the_plate_of_a_drop_test():
    """Two contact models, of the true mesh and of its hull: the same launches end on the same aspects."""
    part = shapes.part(shapes.prism(shapes.l_profile(20, 15, 6), 12))
    bowl = replace(BOWL, track=replace(BOWL.track, climb=0.0, width=0.8), restitution=0.3)
    surface = {"restitution": (0.3, 0.3), "friction": (0.4, 0.4)}
    below, (_, length, _) = looks.AspectsBelow(part, aspects_of(part)), shape.solid_of(part)
    launched = sample(replace(named("feed"), **surface), below.shape, 30, np.random.default_rng(5))
    floor, settled = plate_test.floor_of(bowl, length), 40.0
    ride = plate_test.ride(below.shape, floor, launched, np.array([settled]), plate_test.steps_of(floor))
    on_plate = below.rows[ride.faces[:, 0]]
    states = np.array(launched.states)
    states[:, body.Y] += 0.5 * bowl.track.width / length  # in the middle of the track
    states = part_poses.move_along_wall(states, 0.5 / length, bowl.track.radius / length)
    stage = staging.stage_bare_track(bowl.track, orientations(part, aspects_of(part), bowl.track), 1.0)
    seconds = settled * np.sqrt(length / bowl.gravity)
    _, ride = ridden(part, bowl, states, seconds, stage, back=np.inf, interval=seconds)
    on_track = below.find_aspects(ride.states)
    assert np.mean(on_track == on_plate) > 0.8  # 0.97 of very many: a close call goes the other way


@pytest.mark.parametrize(("axes", "place", "speed", "line"), [LOWER, OUTER])
def test_nothing_passes_the_edges_below_the_surface(axes, place, speed, line):
    """A gap's lower edge, met by a face; its outer end, met by an edge; both by no corner of the part."""
    stage = staging.stage_device(make_device("gap", "9 mm", limit=9e-3), LEVEL.track, EVERY)
    principal = shape.solid_of(PART)[2]
    u, v = (vectors.unit(np.array(axis)) for axis in axes)
    state = np.zeros(body.STATE)
    state[body.Q : body.Q + 4] = part_poses.quaternion(np.column_stack([u, v, np.cross(u, v)]) @ principal)
    state[:3] = 1e-3 * np.array(place) / LENGTH
    state[body.VX : body.VX + 2] = np.array(speed) / np.sqrt(LENGTH * LEVEL.gravity)
    points = 1e-3 * np.linspace(*np.array(line), 61)
    inside, half = 0.0, 0.5e-3 * np.array([20.0, 12.0, 5.0])
    for _ in range(12):
        _, ride = ridden(PART, LEVEL, state, 2e-3, stage, back=1.0)
        state = np.array(ride.states[0])
        own = (points - LENGTH * state[:3]) @ part_poses.matrix(state) @ principal.T
        inside = max(inside, float((half - np.abs(own)).min(axis=1).max()))
    assert ride.distances[0] < 3e-4  # [m] of the last 2 ms, of 4e-4 without the edge
    assert inside < 5e-5


SKEW, _ = awkward.part()
SKEW_SOLID, SKEW_LENGTH, _ = shape.solid_of(SKEW)


def point_velocity(bowl, distance):
    """Velocity [m/s] along the wall of a point so far from it: nearer to the axis it is shaken less."""
    off = bowl.track.radius - distance
    there = answer.answer(at_radius(bowl, float(off)))
    return there.velocity * bowl.track.radius / off


def test_a_skew_body_travels_as_a_point_where_its_centre_of_mass_is():
    """In three of the ways it lies, 11 to 15 mm from a wall of 150: 4 to 6 % faster than at the wall."""
    rows = [k for k, one in enumerate(SKEW_EVERY) if one.name in ("A@268", "B@217", "C@330")]
    seen = sent(SKEW, SKEW_BOWL, rows, 3, seed=2, every=SKEW_EVERY)
    assert (seen.fates == course.PASSED).all() and (seen.orientations[-1] == rows).all()
    own = [point_velocity(SKEW_BOWL, SKEW_EVERY[k].distance) for k in rows]
    assert seen.velocities == pytest.approx(own, rel=0.02)
    assert (np.array(own) > 1.035 * answer.answer(SKEW_BOWL).velocity).all()


@pytest.mark.parametrize("aspect", ["A", "C"])
@pytest.mark.parametrize(("ahead", "friction"), [(0.6, 0.42), (-0.6, 0.55)])
def test_a_skew_body_slides_round_the_bowl_until_floor_and_wall_have_stopped_it(aspect, ahead, friction):
    """The wall bears what the tilted floor pushes at it with, and what keeps the body on its circle."""
    bowl = still(SKEW_BOWL, climb=0.0)
    track, unit = bowl.track, runs.setting(SKEW_SOLID, SKEW_LENGTH, bowl).unit
    one = next(one for one in SKEW_EVERY if one.aspect == aspect)
    state = laid(SKEW, one, bowl, place=0.2)
    state[body.Z] -= part_poses.lowest_height(SKEW_SOLID.corners, state)
    state = part_poses.set_play(state, SKEW_SOLID, track, SKEW_LENGTH, 0.0)
    x, y = SKEW_LENGTH * state[0], track.radius - SKEW_LENGTH * state[1]
    off, up = np.hypot(x, y), part_poses.matrix(state)[2]
    state[body.VX : body.VX + 2] = ahead * np.array([y, x]) / off * unit / SKEW_LENGTH
    state[body.W : body.W + 3] = up * ahead / off * unit
    _, ride = ridden(SKEW, bowl, state, 0.25, staging.stage_bare_track(track, SKEW_EVERY, 0.5))
    # of its inertia, over its mass
    turning = 1.0 + (up**2 * SKEW_SOLID.inertia).sum() * SKEW_LENGTH**2 / off**2
    wall = 0.27 * track.radius / off  # it rubs farther out than the centre of mass is
    braked = 9.81 * (friction / np.cos(track.bank) + wall * np.tan(track.bank))
    way = 0.5 * off / wall * turning * np.log(1.0 + wall / off * ahead**2 / braked)
    assert ride.distances[0] * off / track.radius == pytest.approx(np.sign(ahead) * way, rel=0.012)


@pytest.mark.parametrize("radius", [50.0, 0.15])
def test_blocks_that_touch_leave_as_near_to_each_other_as_their_inner_corners_let_them(radius):
    """Their outer corners are at the wall; the inner ones, 12 mm nearer to the axis, touch."""
    bowl = awkward.bowl(f"track.radius={radius} m")
    every = orientations(PART, ASPECTS, bowl.track)
    flat = next(one for one in every if one.height < 6e-3 and one.length > 0.015)
    shares = np.array([one is flat for one in every], float)
    plan = queue.QueuePlan(4, 3.0, 0.0)
    found = queue.queue_of(PART, bowl, ASPECTS, every, every, shares, plan, RunSettings(3))
    pitch = 2.0 * radius * np.arctan(0.01 / (np.sqrt(radius**2 - 0.01**2) - 0.012))  # 20 and 21.8 mm
    assert found.velocity == pytest.approx(point_velocity(bowl, flat.distance), rel=0.02)
    assert found.rate == pytest.approx(found.velocity / pitch, rel=0.01)
    # they came out of level by 0.2 deg, 17 um over their height
    assert found.gap < 5e-5 and found.jams == found.returned == 0
    assert found.leaving_counts.sum() == found.leaving_counts[every.index(flat)] == 4


@pytest.mark.parametrize("place", [-0.2, 0.33])
def test_a_sensor_tells_orientations_of_a_skew_body_apart_anywhere_round_the_bowl(place):
    known, level = runs.setting(SKEW_SOLID, SKEW_LENGTH, SKEW_BOWL), -5e-3
    for like in SKEW_EVERY[::7]:
        seen = {sees: Sensor(place, sees, (like,), 3e-4, 1e-4) for sees in ("height", "outline", "side")}
        for one in SKEW_EVERY:
            state = laid(SKEW, one, SKEW_BOWL, place=place)
            state[body.Z] += level / SKEW_LENGTH
            blown = {sees: runs.blows_off(of, known, state[None], level) for sees, of in seen.items()}
            assert blown["height"] == (abs(one.height - like.height) > 3e-4)
            assert one is not like or not (blown["outline"] or blown["side"])
            long = abs(one.length - like.length) + abs(one.width - like.width)
            assert long < 4e-3 or blown["outline"]
