"""The moving floor: its kinematics in closed form, and rides on it against the exact motion of a point."""

import math

import drop_bodies
import numpy as np
import pytest
from drop_bodies import lying_flat
from scipy.spatial.transform import Rotation

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.dropping import plate_test
from feederscrew.dropping.kernel import body, falling, floor_motion, one_drop
from feederscrew.dropping.kernel import ride as shaken
from feederscrew.dropping.kernel.floor_motion import Floor, at_rest
from feederscrew.dropping.launch_conditions import PRESETS, sample

BOX, _ = drop_bodies.box((1.0, 1.3, 1.7))
PLATE, _ = drop_bodies.box((3.0, 3.0, 0.6))
LENGTH = 0.01  # [m]
ELLIPSE = Floor(3.0, 0.2, 0.1, 0.7, 0.06, 0.05, -0.4, 0.01)
AXES = (ELLIPSE.along, ELLIPSE.second_along), (ELLIPSE.up, ELLIPSE.second_up)
SECOND = "drive.second_harmonic_phase=60 deg"


@pytest.mark.parametrize("axis", AXES)
def test_speed_is_the_slope_of_place(axis):
    for angle in 3.0 * np.linspace(0.0, 3.0, 7):
        after, before = (floor_motion.place(ELLIPSE, *axis, angle + 3.0 * step) for step in (1e-6, -1e-6))
        assert floor_motion.speed(ELLIPSE, *axis, angle) == pytest.approx((after - before) / 2e-6, abs=1e-8)


def test_flight_over_a_moving_floor_is_a_parabola_in_the_room():
    """Seen from the room a flying part knows nothing of the floor."""
    work, time = falling.scratch(BOX), 0.4
    work.state[:] = sample(PRESETS["roll"], BOX, 1, np.random.default_rng(2)).states[0]

    def in_the_room(state, time):
        at = 3.0 * time
        place, speed = (
            [motion(ELLIPSE, *AXES[0], at + 0.7), 0.0, motion(ELLIPSE, *AXES[1], at)]
            for motion in (floor_motion.place, floor_motion.speed)
        )
        return state[:3] + place, state[3:6] + speed

    start, speed = in_the_room(work.state, time)
    for dt in (0.03, 0.2, 0.17):
        body.keep(work.state, work.saved)
        falling.gap_after(BOX.solid, work, ELLIPSE, time, 0, dt)
        time += dt
    gone = time - 0.4
    place, now = in_the_room(work.state, time)
    assert place == pytest.approx(start + gone * speed - [0.0, 0.0, 0.5 * gone**2], abs=1e-12)
    assert now == pytest.approx(speed - [0.0, 0.0, gone], abs=1e-12)


def test_a_floor_that_does_not_move_is_the_floor_of_a_drop_test():
    """To the share of drops by which stopping early and running to rest may differ."""
    starts = sample(PRESETS["roll"], BOX, 150, np.random.default_rng(4)).launched()
    faces, times = np.empty(150, int), np.empty(150)
    steps = one_drop.Steps(early=False, longest=60.0)
    one_drop.settle_all(BOX, one_drop.scratch(BOX), starts, steps, faces, times)
    looks = shaken.empty_looks(150, np.array([60.0]))
    shaken.ride_all(BOX, falling.scratch(BOX), at_rest(), starts, one_drop.Steps(), looks, np.inf)
    assert (looks.faces[:, 0] == faces).mean() >= 0.985


def ride(bowl, state, looks, friction):
    """Places (looks, 2) of a plate on a bowl's floor, looked at after some cycles."""
    floor, unit = plate_test.floor_of(bowl, LENGTH), math.sqrt(LENGTH / bowl.gravity)
    work = falling.scratch(PLATE)
    work.state[:] = state
    pairing, steps = falling.Pairing(0.0, friction), plate_test.steps_of(floor)
    record = shaken.ride(PLATE, work, floor, pairing, steps, np.asarray(looks) / 60.0 / unit)
    assert record.taken[0] == len(looks)
    return record.places[0]


def bowl_of(ratio, *more):
    """A level bowl with a peak acceleration of ``ratio`` g along its normal."""
    stroke = ratio * 9.81 / (2.0 * math.pi * 60.0) ** 2 / math.sin(math.radians(20.0))
    own = (
        "drive.frequency=60 Hz", f"drive.amplitude={1e3 * stroke} mm", "drive.vibration_angle=20 deg",
        "track.climb=0 deg", "friction.static=0.4", "restitution=0", *more,
    )  # fmt: skip
    return bowls.record(bowls.settings(path=None, overrides=own))


@pytest.mark.parametrize(
    ("ratio", "more"),
    [
        (0.5, ()),
        (0.9, ()),
        (1.2, ()),  # hops
        (2.5, ()),  # thrown
        (0.7, ("drive.phase=40 deg",)),
        (0.7, ("drive.phase=-40 deg",)),
        (0.5, ("drive.second_harmonic=0.15", SECOND)),
        (0.5, ("drive.second_harmonic=0.3", SECOND, "drive.second_harmonic_angle=5 deg")),
    ],
)
def test_a_flat_part_travels_like_a_point(ratio, more):
    """At the velocity of a point on the level floor, from event to event."""
    bowl = bowl_of(ratio, *more)
    quickest = 2.0 * math.pi * 60.0 * LENGTH * plate_test.floor_of(bowl, LENGTH).along
    places = (ride(bowl, lying_flat(PLATE, turn), [40.0, 160.0], 0.4) for turn in (0.0, 0.4))
    speeds = [LENGTH * (last[0] - first[0]) / 2.0 for first, last in places]
    assert speeds == pytest.approx([answer.answer(bowl).velocity] * 2, abs=0.012 * quickest)


def test_a_part_without_friction_stays_where_it_is_in_the_room():
    """Below the hop nothing pushes it along: it stays in the room, and the floor moves below it."""
    bowl, state = bowl_of(0.8), lying_flat(PLATE)
    floor = plate_test.floor_of(bowl, LENGTH)
    state[body.VX] = -floor_motion.speed(floor, floor.along, floor.second_along, 0.0)
    assert np.abs(ride(bowl, state, np.arange(10, 60), 0.0)[:, 0]).max() < 0.05 * floor.along


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0)])
def test_a_part_near_its_edge_lies_on_no_face(axis):
    """Tilted almost over the lowest way out, it holds nearly the whole barrier: it may be tipping over."""
    flat, share, work = lying_flat(BOX), shaken.SURE_BARRIER_SHARE, falling.scratch(BOX)
    tipping = []
    for tilt in (0.0, *np.linspace(0.02, 1.5, 40)):
        turn = Rotation.from_rotvec(tilt * np.array(axis)) * Rotation.from_quat(flat[[7, 8, 9, 6]])
        work.state[:] = flat
        work.state[body.Q : body.Q + 4] = turn.as_quat()[[3, 0, 1, 2]]
        corner, gap = falling.start(BOX.solid, work)
        face = shaken.lying(BOX, work.state, work.turn, corner, share)
        level = work.state[body.Z] - gap
        assert tilt or face != one_drop.UNSETTLED
        if face == one_drop.UNSETTLED:
            tipping.append(level - flat[body.Z])
        else:
            assert level - BOX.heights[face] < share * BOX.barriers[face]
    assert tipping and max(tipping) > share * BOX.barriers.min()
