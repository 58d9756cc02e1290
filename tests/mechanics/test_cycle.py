"""The cycle of sticking and slipping against convey, closed forms and both sides of its thresholds."""

import math
from dataclasses import replace

import numpy as np
import pytest
from mechanics_samples import DEG, bowl, box_posture, random_bowl, random_seat, rectangle

from feederscrew.bowl.record import Bowl, Drive, Friction, Track
from feederscrew.conveying import answer
from feederscrew.mechanics import cycle
from feederscrew.mechanics import floor_balance as floor
from feederscrew.mechanics import track_balance as track
from feederscrew.mechanics.track_balance import frame, seat

FLAT = box_posture(height=0.0005)  # low enough not to tip


def random_drive(rng):
    """A bowl whose wall and bank play no part, below the hop."""
    static, beta, climb = rng.uniform(0.05, 0.9), rng.uniform(5, 60) * DEG, rng.uniform(0, 6) * DEG
    ratio = rng.uniform(0.2, 0.98) / math.sin(beta) * math.cos(climb)
    return Bowl(
        Drive(ratio * 9.81 / (2 * math.pi * 50) ** 2, 50.0, beta, 0.0),
        Friction(static, static * rng.choice([1.0, rng.uniform(0.3, 1.0)]), 0.0),
        Track(climb, 0.0, 1e6, 0.025),
        0.0,
        9.81,
    )


@pytest.mark.parametrize("seed", range(6))
def test_track_and_floor_travel_as_convey_does(seed):
    """Where wall and bank play no part, to 1e-9 A w; without a steady state neither settles."""
    settings = random_drive(np.random.default_rng(seed))
    part, speed = seat(FLAT, 0.0, rectangle(0.03, 0.01)[:2], 0.0), answer.greatest_speed(settings)
    found, (_, course) = answer.answer(settings), track.over_cycle(part, settings)
    assert course.settled == (found.status == "periodic")
    if course.settled:
        assert course.mean == pytest.approx(found.velocity, rel=0, abs=1e-9 * speed)
    level = replace(settings, track=replace(settings.track, climb=0.0))
    _, on_floor = floor.over_cycle(FLAT, level, 0.0)
    assert on_floor.mean == pytest.approx(answer.answer(level).velocity, rel=0, abs=1e-9 * speed)


@pytest.mark.parametrize("seed", range(4))
def test_a_banked_track_travels_as_convey_does(seed):
    """A flat box against a straight, rough, upright wall: convey's level track of another friction."""
    rng = np.random.default_rng(seed)
    settings = random_drive(rng)
    bank, wall = rng.uniform(2, 25) * DEG, rng.uniform(0.1, 1.0)
    settings = replace(settings, friction=replace(settings.friction, wall=wall))
    settings = replace(settings, track=replace(settings.track, bank=bank))
    part, speed = seat(FLAT, 0.0, rectangle(0.03, 0.01)[:2], bank), answer.greatest_speed(settings)
    found, (_, course) = answer.answer(settings), track.over_cycle(part, settings)
    assert course.settled == (found.status == "periodic")
    if course.settled:
        assert course.mean == pytest.approx(found.velocity, rel=0, abs=1e-8 * speed)


def test_the_mean_does_not_depend_on_the_samples():
    part, settings = random_seat(np.random.default_rng(4)), random_bowl(np.random.default_rng(4))
    means = [track.over_cycle(part, settings, samples)[1].mean for samples in (60, 360)]
    assert means[0] == pytest.approx(means[1], rel=1e-8)


def test_it_follows_the_accelerations_of_the_balance():
    """The rows of three numbers give what the wrench equations give, at any phase, speed and sense."""
    for seed in range(4):
        part, settings = random_seat(np.random.default_rng(seed)), random_bowl(np.random.default_rng(seed))
        slips = track.sliding_acceleration(
            part, settings, frame(settings, part.walls), -track.PULL_TOLERANCE * 9.81
        )
        for phase, speed, sense in (
            (0.3, 0.02, 1.0),
            (1.6, 0.01, 1.0),
            (4.6, -0.01, -1.0),
            (5.9, -0.03, -1.0),
        ):
            want = track.motion(part, settings, np.array([phase]), sense, speed).acceleration[0, 0]
            assert slips(phase, speed, sense) == pytest.approx(want, rel=1e-9)


def test_a_slip_shorter_than_a_sample_is_not_missed():
    """Just above the limit of slip the slip lasts a fraction of a degree."""
    limit = floor.motion(FLAT, bowl(), 0.0).limiting_friction
    above, below = (floor.with_friction(bowl(), float(limit) * share) for share in (1 + 1e-7, 1 - 1e-7))
    assert floor.over_cycle(FLAT, above, 0.0)[1].mean == 0.0
    moved = floor.over_cycle(FLAT, below, 0.0)[1].mean
    assert moved == pytest.approx(answer.answer(replace(below, restitution=0.0, track=replace(
        below.track, climb=0.0, bank=0.0))).velocity, rel=1e-4)  # fmt: skip
    assert 0.0 < moved < 1e-9


def test_a_part_that_gets_faster_with_every_period_has_not_settled():
    windows = [(0.0, cycle.PERIOD_PHASE, 1.0)]
    assert not cycle.settle(lambda phase, speed, sense: 1.0, windows, 0.02).settled
    braked = cycle.settle(lambda phase, speed, sense: 1.0 - speed, windows, 0.02)  # slowly, to a speed of 1
    assert braked.settled
    assert braked.mean == pytest.approx(1.0, rel=1e-9)
