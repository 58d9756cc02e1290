"""The moving floor: its kinematics in closed form, and rides on it against the exact motion of a point."""

import math

import drop_bodies
import numpy as np
import pytest
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


def lying_flat(shape, turn=0.0):
    """A state at rest on the largest face, relative to the floor."""
    across = np.argmin(shape.vertices.max(axis=0))
    upright = Rotation.align_vectors([[0.0, 0.0, 1.0]], [np.eye(3)[across]])[0]
    state = np.zeros(body.STATE)
    state[body.Q : body.Q + 4] = (Rotation.from_rotvec([0, 0, turn]) * upright).as_quat()[[3, 0, 1, 2]]
    state[body.Z] = shape.vertices[:, across].max()
    return state


def ride(shape, plate, state, looks, friction, restitution=0.0, steps=None):
    """Faces and places of one ride."""
    work = falling.scratch(shape)
    work.state[:] = state
    steps = steps or plate_test.steps_of(plate)
    seen = shaken.ride(shape, work, plate, falling.Pairing(restitution, friction), steps, looks)
    assert seen.taken[0] == len(looks)
    return seen.faces[0], seen.places[0]


@pytest.mark.parametrize("axis", AXES)
def test_speed_is_the_slope_of_place(axis):
    for time in np.linspace(0.0, 3.0, 7):
        angle, step = 3.0 * time, 1e-6
        ahead, behind = (floor_motion.place(ELLIPSE, *axis, angle + 3.0 * way * step) for way in (1, -1))
        slope = (ahead - behind) / (2.0 * step)
        assert floor_motion.speed(ELLIPSE, *axis, angle) == pytest.approx(slope, abs=1e-8)


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
    begun = time
    for dt in (0.03, 0.2, 0.17):
        body.keep(work.state, work.saved)
        falling.gap_after(BOX.solid, work, ELLIPSE, time, 0, dt)
        time += dt
    gone = time - begun
    place, now = in_the_room(work.state, time)
    assert place == pytest.approx(start + gone * speed - [0.0, 0.0, 0.5 * gone**2], abs=1e-12)
    assert now == pytest.approx(speed - [0.0, 0.0, gone], abs=1e-12)


def test_a_floor_that_does_not_move_is_the_floor_of_a_drop_test():
    """To the share of drops by which stopping early and running to rest may differ."""
    starts = sample(PRESETS["roll"], BOX, 150, np.random.default_rng(4))
    faces, times = np.empty(150, int), np.empty(150)
    given = starts.launched()
    one_drop.settle_all(
        BOX, one_drop.scratch(BOX), given, one_drop.Steps(early=False, longest=60.0), faces, times
    )
    seen = shaken.empty_looks(150, np.array([60.0]))
    shaken.ride_all(BOX, falling.scratch(BOX), at_rest(), given, one_drop.Steps(), seen, np.inf)
    assert (seen.faces[:, 0] == faces).mean() >= 0.985


def exact(bowl):
    """Velocity of a point on the level floor, from event to event."""
    return answer.answer(bowl).velocity


def bowl_of(ratio, *more, degrees=20.0, friction=0.4, restitution=0.0):
    """A level bowl with a peak acceleration of ``ratio`` g along its normal."""
    stroke = ratio * 9.81 / (2.0 * math.pi * 60.0) ** 2 / math.sin(math.radians(degrees))
    own = (
        "drive.frequency=60 Hz", f"drive.amplitude={1e3 * stroke} mm",
        f"drive.vibration_angle={degrees} deg", "track.climb=0 deg", f"friction.static={friction}",
        f"restitution={restitution}", *more,
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
        (0.5, ("drive.second_harmonic=0.15", "drive.second_harmonic_phase=60 deg")),
        (
            0.5,
            (
                "drive.second_harmonic=0.3",
                "drive.second_harmonic_phase=60 deg",
                "drive.second_harmonic_angle=5 deg",
            ),
        ),
    ],
)
def test_a_flat_part_travels_like_a_point(ratio, more):
    bowl = bowl_of(ratio, *more)
    plate, unit = plate_test.floor_of(bowl, LENGTH), math.sqrt(LENGTH / bowl.gravity)
    looks = np.array([40.0, 160.0]) / 60.0 / unit
    quickest, speeds = 2.0 * math.pi * 60.0 * LENGTH * plate.along, []
    for turn in (0.0, 0.4):
        _, places = ride(PLATE, plate, lying_flat(PLATE, turn), looks, 0.4)
        speeds.append(LENGTH * (places[1, 0] - places[0, 0]) / 2.0)
    assert speeds == pytest.approx([exact(bowl)] * 2, abs=0.012 * quickest)


def test_a_part_without_friction_stays_where_it_is_in_the_room():
    """Below the hop nothing pushes it along: it stays in the room, and the floor moves below it."""
    bowl = bowl_of(0.8)
    plate, unit = plate_test.floor_of(bowl, LENGTH), math.sqrt(LENGTH / bowl.gravity)
    state = lying_flat(PLATE)
    state[body.VX] = -floor_motion.speed(plate, plate.along, plate.second_along, 0.0)
    _, places = ride(PLATE, plate, state, np.arange(10, 60) / 60.0 / unit, 0.0)
    assert np.abs(places[:, 0]).max() < 0.05 * plate.along


def test_a_part_near_its_edge_lies_on_no_face():
    """Tilted almost over the lowest way out, it holds nearly the whole barrier: it may be tipping over."""
    flat, least, work = lying_flat(BOX), BOX.barriers.min(), falling.scratch(BOX)

    def seen(tilt, axis):
        turn = Rotation.from_rotvec(tilt * np.array(axis)) * Rotation.from_quat(flat[[7, 8, 9, 6]])
        work.state[:] = flat
        work.state[body.Q : body.Q + 4] = turn.as_quat()[[3, 0, 1, 2]]
        corner, gap = falling.start(BOX.solid, work)
        share = shaken.SURE_BARRIER_SHARE
        return shaken.lying(BOX, work.state, work.turn, corner, share), work.state[body.Z] - gap - flat[
            body.Z
        ]

    assert seen(0.0, (1, 0, 0))[0] != one_drop.UNSETTLED
    for axis in ((1, 0, 0), (0, 1, 0)):
        for tilt in np.linspace(0.02, 1.5, 40):
            face, lift = seen(tilt, axis)
            if face != one_drop.UNSETTLED:
                assert (
                    lift - (BOX.heights[face] - flat[body.Z]) < shaken.SURE_BARRIER_SHARE * BOX.barriers[face]
                )
        tipping = [lift for face, lift in (seen(t, axis) for t in np.linspace(0.0, 1.5, 40)) if face < 0]
        assert tipping and max(tipping) > shaken.SURE_BARRIER_SHARE * least
