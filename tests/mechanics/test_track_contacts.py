"""Wall contacts of a part on the track that open: which, when, and what friction does at the other."""

import numpy as np
import pytest
from mechanics_samples import DEG, bowl, box_posture, rectangle

from feederscrew.mechanics import cycle, track_balance
from feederscrew.mechanics import floor_balance as floor
from feederscrew.mechanics.track_balance import Seat, frame, loads, seat

PHASE = cycle.phases(24)


def test_a_drive_inward_opens_the_wall_and_is_solved_without_it():
    settings = bowl(direction=20 * DEG, bank=0.0)
    found = track_balance.motion(seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 0.0), settings)
    assert not found.closed.any()
    assert not found.walls.any()
    assert found.acceleration[1] > 0.0
    assert found.radial_friction < 0.0
    assert np.hypot(found.traction, found.radial_friction) == pytest.approx(0.3 * found.normal_force)


def test_one_wall_contact_opens_and_the_part_turns_off_it():
    """Wall friction at a long side lever unloads the leading contact of a short part."""
    posture = box_posture(length=0.006, width=0.02)
    settings = bowl(wall=1.0, bank=15 * DEG, climb=0.0)
    part = seat(posture, 0.0, rectangle(0.006, 0.02)[:2], 1.0)
    found = track_balance.motion(part, settings, 0.5 * np.pi, 1.0)
    assert found.closed.sum() == 1
    opened = int(np.argmin(found.closed))
    axes = frame(settings, part.walls)
    for k, least in ((opened, 1e-9), (1 - opened, -1e-9)):
        place = part.walls[k]
        gained = np.append(found.acceleration * [0.0, 1.0], 0.0) + found.turning * np.array(
            [-place[1], place[0], 0.0]
        )
        rate = gained @ (axes.normals[k] * [1.0, 1.0, 0.0])
        assert rate > least if k == opened else abs(rate) < 1e-9
    assert found.walls[opened] == 0.0
    assert found.walls[1 - opened] > 0.0


def test_at_rest_the_contact_opens_that_would_have_to_pull():
    """A bolt along the wall: its far end is pulled at by little; the near contact goes on pressing."""
    walls = np.array([[-19.183, -5.713, -2.342], [5.964, -6.826, 0.646]]) * 1e-3
    part = Seat(0.013, 5.8e-3, 0.0, np.array([0.0, 0.0, 1.2e-6]), walls, rectangle(0.03, 0.02))
    settings = bowl(
        amplitude=0.05e-3,
        vibration_angle=30 * DEG,
        static=0.6,
        kinetic=0.6,
        wall=0.6,
        bank=24 * DEG,
        climb=2 * DEG,
    )
    axes = frame(settings, walls)
    load = loads(part, settings, axes, 0.5 * np.pi)
    both = track_balance.held(part, axes, load, (True, True), 1.0)
    found = track_balance.motion(part, settings)
    assert both.walls[0] < 0.0 < both.walls[1]
    assert found.closed.tolist() == [False, True]
    assert found.needed[0] == pytest.approx(both.mobilised, rel=0.01)


@pytest.mark.parametrize("rub", [0.1, 0.4, 1.0])
def test_wall_friction_takes_power_from_a_part_that_starts_to_turn(rub):
    """One closed contact: it slides ahead, back, or stays in place and the part rolls along the wall."""
    part = seat(box_posture(length=0.002, width=0.02), 0.0, rectangle(0.002, 0.02)[:2], 1.0)
    settings = bowl(static=0.31, wall=rub, bank=15 * DEG, climb=0.0)
    found, axes = track_balance.motion(part, settings, PHASE), frame(settings, part.walls)
    alone = found.slides & (found.closed.sum(axis=-1) == 1)
    assert alone.any()
    for k in (0, 1):
        course, lever = (
            axes.courses[k, :2],
            part.walls[k, 0] * axes.courses[k, 1] - part.walls[k, 1] * axes.courses[k, 0],
        )
        slip = found.acceleration @ course + found.turning * lever
        force, limit = found.wall_friction[:, k], rub * found.walls[:, k]
        assert (np.abs(force) <= limit * (1 + 1e-9)).all()
        assert (force * slip >= -1e-9 * limit)[alone].all()
        in_place = alone & (np.abs(force) < 0.999 * limit)
        assert np.abs(slip[in_place]) == pytest.approx(0.0, abs=1e-9)


ANGLE = Seat(
    9.891e-3, 4.5e-3, 0.0, np.array([0.0, 0.0, 6.7e-7]),
    np.array([[-9.8303e-3, -7.5494e-3, 4.5e-3], [12.3724e-3, -7.3472e-3, 4.5e-3]]), rectangle(0.025, 0.0175),
)  # fmt: skip
CHANNEL = Seat(
    10.362e-3, 5.35e-3, 0.0, np.array([0.0, 0.0, 5.55e-7]),
    np.array([[-9e-3, -5.5e-3, 8.65e-3], [9e-3, -5.5e-3, 8.65e-3]]), rectangle(0.018, 0.011),
)  # fmt: skip


@pytest.mark.parametrize(("part", "bank"), [(ANGLE, 15.0), (CHANNEL, 7.5)])
def test_a_strong_drive_pulls_a_part_that_wedges_itself_ahead_at_every_climb(part, bank):
    """Friction at the wall grows without bound at a coefficient of about 7 to 8: nothing beyond it is taken.

    The angle would be held by about 5, the channel by no friction at all.
    """
    settings = bowl(
        amplitude=0.125e-3, vibration_angle=25 * DEG, direction=0.0, static=0.35, kinetic=0.3, wall=0.2,
        climb=np.linspace(0.0, 8.0, 4001) * DEG, bank=bank * DEG, radius=0.14,
    )  # fmt: skip
    found = track_balance.motion(part, settings)
    assert (found.state == floor.SLIDE).all() and (found.traction > 0.0).all()
    assert (np.diff(found.acceleration[:, 0]) < 0.0).all()
