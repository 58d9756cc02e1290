"""A part on the floor: closed forms, Newton and Euler, rolling, and the cycle of sticking and slipping."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mechanics_samples import (
    DEG,
    bowl,
    box_posture,
    random_bowl,
    random_seat,
    rectangle,
    rolling_posture,
)

from feederscrew.bowl.record import Bowl, Drive, Friction, Track
from feederscrew.conveying import answer
from feederscrew.mechanics import cycle, floor_balance
from feederscrew.mechanics import motion_maps as floor_cells
from feederscrew.mechanics import track_balance as track
from feederscrew.mechanics.floor_balance import MOTION_STATES, solve_rolling
from feederscrew.mechanics.track_balance import frame, seat
from feederscrew.screw import Wrench

G = 9.81
PARTS = Path(__file__).parents[2] / "parts"


def drive_acceleration(settings):
    return settings.drive.amplitude * (2 * np.pi * settings.drive.frequency) ** 2


def test_normal_force_and_sliding():
    """Eqs. [4.14], [4.20] at both reversals; eqs. [4.16], [4.26], [4.28]."""
    settings, posture = bowl(static=0.4, kinetic=0.25), box_posture()
    push, lift = (drive_acceleration(settings) * f(20 * DEG) for f in (np.cos, np.sin))
    both = floor_balance.motion(posture, settings, 0.0, np.array([0.5, 1.5]) * np.pi)
    assert both.normal_force == pytest.approx(posture.mass * np.array([G - lift, G + lift]))
    motion = floor_balance.motion(posture, settings, 0.0)
    assert MOTION_STATES[motion.state] == "slide"
    assert motion.acceleration == pytest.approx([push - 0.25 * (G - lift), 0.0])
    assert motion.limiting_friction == pytest.approx(push / (G - lift))


def test_static_friction_holds_up_to_the_limit():
    posture = box_posture()
    limit = float(floor_balance.motion(posture, bowl(), 0.0).limiting_friction)
    for static, state in ((limit * (1 + 1e-9), "stick"), (limit * (1 - 1e-9), "slide")):
        motion = floor_balance.motion(posture, bowl(static=static, kinetic=0.1), 0.0)
        assert MOTION_STATES[motion.state] == state
    held = floor_balance.motion(posture, bowl(static=2.0), 0.7)
    assert held.acceleration == pytest.approx([0.0, 0.0], abs=1e-15)
    assert held.turning == 0.0


def test_friction_is_a_vector_against_the_drive():
    """A free part slides along the drive however it is turned; only its own axes turn."""
    settings = bowl(direction=25 * DEG)
    aligned, turned = (floor_balance.motion(box_posture(), settings, way * DEG) for way in (25, -40))
    assert np.hypot(*turned.acceleration) == pytest.approx(np.hypot(*aligned.acceleration))
    assert np.arctan2(turned.acceleration[1], turned.acceleration[0]) == pytest.approx(65 * DEG)
    assert turned.limiting_friction == pytest.approx(aligned.limiting_friction)


def test_alignment_turns_towards_the_drive():
    """Eqs. [4.17], [4.23]."""
    posture, settings = box_posture(offset=2e-3), bowl(direction=30 * DEG)
    headings = np.radians(np.linspace(-170, 170, 35))
    turning = floor_balance.motion(posture, settings, headings).turning
    push = posture.mass * drive_acceleration(settings) * np.cos(20 * DEG)
    want = 2e-3 * push * np.sin(30 * DEG - headings) / posture.turning_inertia
    np.testing.assert_allclose(turning, want, rtol=1e-12, atol=1e-9)
    stable = [floor_balance.stable_heading(replace(posture, offset=way), settings) for way in (2e-3, -2e-3)]
    assert stable == pytest.approx([30 * DEG, 30 * DEG + np.pi])
    assert np.isnan(floor_balance.stable_heading(box_posture(), settings))


@pytest.mark.parametrize("seed", range(5))
def test_newton_and_euler(seed):
    """All wrenches on the part make its momentum rate, whatever the inertia, the drive and the phase.

    Eqs. [4.14] to [4.19].
    """
    rng = np.random.default_rng(seed)
    base = rng.normal(size=(3, 3))
    inertia = 1e-7 * (base @ base.T + 3 * np.eye(3))
    posture = replace(box_posture(offset=rng.uniform(0, 3e-3)), inertia=inertia)
    direction, angle, static = rng.uniform(-3, 3), rng.uniform(0, 0.5), rng.uniform(0.1, 0.9)
    settings = bowl(direction=direction, vibration_angle=angle, static=static)
    heading, phase = rng.uniform(-3, 3), cycle.phases(36)
    motion = floor_balance.motion(posture, settings, heading, phase)
    drive = floor_balance.drive_force(posture, settings, heading, phase)
    nothing, weight = np.zeros((36, 1)), np.array([0.0, 0.0, -posture.mass * settings.gravity])
    normal = np.column_stack([np.zeros((36, 2)), motion.normal_force])
    at_d = np.column_stack([motion.offset, np.full(36, -posture.height)])
    friction = np.concatenate([motion.friction, nothing], axis=1)
    below = np.array([0.0, 0.0, -posture.height])
    couple = np.column_stack([np.zeros((36, 2)), motion.turning * posture.turning_inertia])
    total = (
        Wrench(drive + weight, np.zeros((36, 3)))
        + Wrench(normal, np.cross(at_d, normal))
        + Wrench(friction, np.cross(below, friction) + couple)
    )
    accelerated = posture.mass * np.concatenate([motion.acceleration, nothing], axis=1)
    spun = motion.turning[:, None] * inertia[:, 2]
    force, moment = (
        np.abs(drive + weight).max(),
        max(np.abs(np.cross(at_d, normal)).max(), np.abs(spun).max()),
    )
    np.testing.assert_allclose(total.resultant, accelerated, rtol=0, atol=1e-12 * force)
    np.testing.assert_allclose(total.moment, spun, rtol=0, atol=1e-10 * moment)


def test_a_tall_part_tips_before_it_slides():
    """Tips where h R / N leaves the contact polygon: mu > half length / h."""
    tall = box_posture(length=0.004, width=0.004, height=0.02)
    state = floor_balance.motion(tall, bowl(static=0.9, kinetic=np.array([0.19, 0.21])), 0.0).state
    assert [MOTION_STATES[code] for code in state] == ["slide", "tip"]
    motion = floor_balance.motion(tall, bowl(static=0.9, kinetic=0.15), 0.0)
    assert (motion.offset[0], motion.inside) == pytest.approx((0.01 * 0.15, 0.002 - 0.0015))


def test_a_rolling_cylinder_needs_a_third_of_the_drive():
    posture, settings = rolling_posture(), bowl(direction=90 * DEG, static=0.4)
    push = posture.mass * drive_acceleration(settings) * np.cos(20 * DEG)
    motion = floor_balance.motion(posture, settings, 0.0)
    assert motion.friction == pytest.approx([0.0, -push / 3], abs=1e-15)
    assert motion.acceleration == pytest.approx([0.0, push / posture.mass * 2 / 3], abs=1e-12)
    assert motion.limiting_friction == pytest.approx(push / 3 / motion.normal_force)
    assert MOTION_STATES[motion.state] == "stick"
    assert np.abs(motion.friction).max() < 0.4 * motion.normal_force
    # It swings with the drive: v = -(2/3) A w cos(b) cos(w t) across its axis.
    over, course = floor_balance.over_cycle(posture, bowl(direction=90 * DEG, static=0.9), 0.0)
    want = -2 / 3 * 0.05e-3 * 2 * np.pi * 60 * np.cos(20 * DEG) * np.cos(cycle.phases())
    np.testing.assert_allclose(course.velocity, want, rtol=0, atol=1e-4 * want.max())
    assert floor_balance.regime(over.state) == "stick"


def test_slip_of_a_rolling_part_opposes_its_friction():
    """The contact line accelerates exactly against friction of mu N."""
    posture, settings = rolling_posture(), bowl(direction=35 * DEG, static=0.2, kinetic=0.15)
    force = floor_balance.drive_force(posture, settings, 0.0)
    normal = np.array(posture.mass * G - force[2])
    motion = solve_rolling(posture, settings.friction, force[:2], normal)
    spin = motion.rolling_acceleration
    contact = motion.acceleration + spin * posture.height * np.array([0.0, 1.0])
    assert np.hypot(*motion.friction) == pytest.approx(0.15 * float(normal))
    assert contact @ motion.friction == pytest.approx(-np.hypot(*contact) * np.hypot(*motion.friction))
    about = -float(np.cross([0.0, 0.0, -posture.height], [*motion.friction, 0.0])[0]) / posture.inertia[0, 0]
    assert abs(spin) == pytest.approx(abs(about))


def test_maps_of_the_floor():
    """A cell is the single answer; figure 5-6's own values hop above asin(g / A w^2) = 7.9 deg."""
    beta, mu = np.radians([10.0, 20.0, 30.0])[:, None], np.array([[0.1, 0.3]])
    posture, settings = box_posture(offset=1e-3), bowl(direction=10 * DEG, vibration_angle=beta)
    cells = floor_cells.floor_cells(posture, floor_balance.with_friction(settings, mu), 0.2)
    alone = bowl(direction=10 * DEG, vibration_angle=30 * DEG, static=0.1, kinetic=0.1)
    single = floor_balance.motion(posture, alone, 0.2)
    assert cells["acceleration_z_m_s2"][2, 0] == pytest.approx(float(single.acceleration[0]))
    assert cells["regime"][2, 0] == single.state
    settings = bowl(amplitude=0.5e-3, gravity=9.8, vibration_angle=np.radians([7.8, 8.0]))
    cells = floor_cells.floor_cells(box_posture(), settings, 0.0)
    assert np.isnan(cells["acceleration_z_m_s2"]).tolist() == [False, True]
    assert [MOTION_STATES[code] for code in cells["regime"]][1] == "hop"


# The cycle of sticking and slipping against convey, closed forms and both sides of its thresholds.
FLAT = box_posture(height=0.0005)  # low enough not to tip


@pytest.mark.parametrize(
    ("seed", "bank"), [*((seed, False) for seed in range(6)), *((seed, True) for seed in range(4))]
)
def test_track_and_floor_travel_as_convey_does(seed, bank):
    """Where wall and bank play no part, to 1e-9 A w; without a steady state neither settles.

    A flat box against a straight, rough, upright wall: convey's level track of another friction.
    """
    rng = np.random.default_rng(seed)
    static, beta, climb = rng.uniform(0.05, 0.9), rng.uniform(5, 60) * DEG, rng.uniform(0, 6) * DEG
    ratio = rng.uniform(0.2, 0.98) / math.sin(beta) * math.cos(climb)  # below the hop
    kinetic = static * rng.choice([1.0, rng.uniform(0.3, 1.0)])
    angle, wall = (rng.uniform(2, 25) * DEG, rng.uniform(0.1, 1.0)) if bank else (0.0, 0.0)
    drive = Drive(ratio * G / (2 * math.pi * 50) ** 2, 50.0, beta, 0.0)
    settings = Bowl(drive, Friction(static, kinetic, wall), Track(climb, angle, 1e6, 0.025), 0.0, G)
    part, speed = seat(FLAT, 0.0, rectangle(0.03, 0.01)[:2], angle), answer.greatest_speed(settings)
    convey, (_, course) = answer.answer(settings), track.over_cycle(part, settings)
    assert course.settled == (convey.status == "periodic")
    if course.settled:
        assert course.mean == pytest.approx(convey.velocity, rel=0, abs=(1e-8 if bank else 1e-9) * speed)
    if not bank:
        level = replace(settings, track=replace(settings.track, climb=0.0))
        for samples in (60, 360):
            _, on_floor = floor_balance.over_cycle(FLAT, level, 0.0, samples)
            assert on_floor.mean == pytest.approx(answer.answer(level).velocity, rel=0, abs=1e-9 * speed)


def test_the_mean_does_not_depend_on_the_samples():
    part, settings = random_seat(np.random.default_rng(4)), random_bowl(np.random.default_rng(4))
    means = [track.over_cycle(part, settings, samples)[1].mean for samples in (60, 360)]
    assert means[0] == pytest.approx(means[1], rel=1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_it_follows_the_accelerations_of_the_balance(seed):
    """The rows of three numbers give what the wrench equations give, at any phase, speed and sense."""
    part, settings = random_seat(np.random.default_rng(seed)), random_bowl(np.random.default_rng(seed))
    tolerance = -track.PULL_TOLERANCE * G
    slips = track.sliding_acceleration(part, settings, frame(settings, part.walls), tolerance)
    for phase, speed, sense in ((0.3, 0.02, 1.0), (1.6, 0.01, 1.0), (4.6, -0.01, -1.0), (5.9, -0.03, -1.0)):
        want = track.motion(part, settings, np.array([phase]), sense, speed).acceleration[0, 0]
        assert slips(phase, speed, sense) == pytest.approx(want, rel=1e-9)


def test_a_slip_shorter_than_a_sample_is_not_missed():
    """Just above the limit of slip the slip lasts a fraction of a degree."""
    limit = float(floor_balance.motion(FLAT, bowl(), 0.0).limiting_friction)
    held, lost = (floor_balance.with_friction(bowl(), limit * share) for share in (1 + 1e-7, 1 - 1e-7))
    assert floor_balance.over_cycle(FLAT, held, 0.0)[1].mean == 0.0
    level = replace(lost, restitution=0.0, track=replace(lost.track, climb=0.0, bank=0.0))
    mean = floor_balance.over_cycle(FLAT, lost, 0.0)[1].mean
    assert mean == pytest.approx(answer.answer(level).velocity, rel=1e-4)
    assert 0.0 < mean < 1e-9


def test_a_part_that_gets_faster_with_every_period_has_not_settled():
    windows = [(0.0, cycle.PERIOD_PHASE, 1.0)]
    assert not cycle.settle(lambda phase, speed, sense: 1.0, windows, 0.02).settled
    braked = cycle.settle(lambda phase, speed, sense: 1.0 - speed, windows, 0.02)  # slowly, to a speed of 1
    assert (braked.settled, braked.mean) == (True, pytest.approx(1.0, rel=1e-9))


# Which aspect ``feeder floor`` and ``feeder track`` take where none is asked for.
LISTED = """
mass: 2 g
centre_of_mass: [0 mm, 0 mm, 0 mm]
inertia: [[100 g mm2, 0 g mm2, 0 g mm2], [0 g mm2, 100 g mm2, 0 g mm2], [0 g mm2, 0 g mm2, 100 g mm2]]
aspects:
  - {aspect: x, height: 3 mm, polar_inertia: 100 g mm2}
  - {aspect: y, height: 2 mm, polar_inertia: 100 g mm2}
"""


@pytest.mark.parametrize("command", ["floor", "track"])
@pytest.mark.parametrize(
    ("part", "aspect", "why"),
    [
        ("arc_chute.yaml", "5", "the one of the card's {} block"),
        ("lbracket_30x20x15.stl", "A", r"the likeliest \(fed onto the moving floor, \d+ parts, seed 1\)"),
    ],
    ids=["card", "mesh"],
)
def test_an_aspect_is_chosen_and_told(run, command, part, aspect, why):
    chosen, asked = (
        run(command, PARTS / part, *own, "--format", "json") for own in ([], ["--aspect", aspect])
    )
    assert json.loads(chosen.stdout) == json.loads(asked.stdout)
    first, rest = chosen.stderr.split("\n", maxsplit=1)
    assert re.fullmatch(f"Aspect {aspect}, {why.replace('{}', command)}", first)
    assert rest == asked.stderr


def test_of_a_card_that_analyses_none_the_first_is_taken(run, tmp_path):
    (tmp_path / "card.yaml").write_text(LISTED)
    assert run("floor", "card.yaml").stderr.splitlines()[0] == "Aspect x, the first of the card"
