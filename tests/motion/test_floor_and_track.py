"""A part on the floor and on the track: closed forms, Newton and Euler, the cycle, contacts that open."""

import json
import math
from dataclasses import replace
from pathlib import Path

import mechanics_samples
import numpy as np
import pytest
from mechanics_samples import BOWL, DEG, bowl, box_posture, random_bowl, random_seat, rectangle

from feederscrew.base.errors import FeederError
from feederscrew.bowl.record import Bowl, Drive, Friction, Track
from feederscrew.motion import conveying as answer
from feederscrew.motion import cycle, floor_balance
from feederscrew.motion import motion_maps as maps
from feederscrew.motion import track_balance as track
from feederscrew.motion.floor_balance import MOTION_STATES, solve_rolling
from feederscrew.motion.screws import Point, Wrench, reactions
from feederscrew.motion.track_balance import Seat, card_seat, frame, loads, seat
from feederscrew.motion.track_contacts import contact_wrenches, first_to_open, has_equilibrium

G = 9.81
PARTS = Path(__file__).parents[2] / "parts"
FLAT = box_posture(height=0.0005)  # low enough not to tip
LISTED = """
mass: 2 g
centre_of_mass: [0 mm, 0 mm, 0 mm]
inertia: [[100 g mm2, 0 g mm2, 0 g mm2], [0 g mm2, 100 g mm2, 0 g mm2], [0 g mm2, 0 g mm2, 100 g mm2]]
aspects: [{aspect: x, height: 3 mm, polar_inertia: 1 g mm2},
  {aspect: y, height: 2 mm, polar_inertia: 1 g mm2}]
"""
PHASE = cycle.phases(24)
ANGLE = Seat(
    9.891e-3, 4.5e-3, 0.0, np.array([0.0, 0.0, 6.7e-7]),
    np.array([[-9.8303e-3, -7.5494e-3, 4.5e-3], [12.3724e-3, -7.3472e-3, 4.5e-3]]), rectangle(0.025, 0.0175),
)  # fmt: skip
CHANNEL = Seat(
    10.362e-3, 5.35e-3, 0.0, np.array([0.0, 0.0, 5.55e-7]),
    np.array([[-9e-3, -5.5e-3, 8.65e-3], [9e-3, -5.5e-3, 8.65e-3]]), rectangle(0.018, 0.011),
)  # fmt: skip


def drive_acceleration(settings):
    return settings.drive.amplitude * (2 * np.pi * settings.drive.frequency) ** 2


def test_sliding_sticking_and_tipping():
    """Eqs. [4.14], [4.20] at both reversals; eqs. [4.16], [4.26], [4.28]."""
    settings, posture = bowl(static=0.4, kinetic=0.25), box_posture()
    push, lift = (drive_acceleration(settings) * f(20 * DEG) for f in (np.cos, np.sin))
    both = floor_balance.motion(posture, settings, 0.0, np.array([0.5, 1.5]) * np.pi)
    assert both.normal_force == pytest.approx(posture.mass * np.array([G - lift, G + lift]))
    motion = floor_balance.motion(posture, settings, 0.0)
    assert MOTION_STATES[motion.state] == "slide"
    assert motion.acceleration == pytest.approx([push - 0.25 * (G - lift), 0.0])
    assert motion.limiting_friction == pytest.approx(push / (G - lift))
    limit = float(floor_balance.motion(posture, bowl(), 0.0).limiting_friction)
    for static, state in ((limit * (1 + 1e-9), "stick"), (limit * (1 - 1e-9), "slide")):
        motion = floor_balance.motion(posture, bowl(static=static, kinetic=0.1), 0.0)
        assert MOTION_STATES[motion.state] == state
    held = floor_balance.motion(posture, bowl(static=2.0), 0.7)
    assert held.acceleration == pytest.approx([0.0, 0.0], abs=1e-15)
    assert held.turning == 0.0
    # Tips where h R / N leaves the contact polygon: mu > half length / h.
    tall = box_posture(length=0.004, width=0.004, height=0.02)
    state = floor_balance.motion(tall, bowl(static=0.9, kinetic=np.array([0.19, 0.21])), 0.0).state
    assert [MOTION_STATES[code] for code in state] == ["slide", "tip"]
    motion = floor_balance.motion(tall, bowl(static=0.9, kinetic=0.15), 0.0)
    assert (motion.offset[0], motion.inside) == pytest.approx((0.01 * 0.15, 0.002 - 0.0015))


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
    """Eqs. [4.14] to [4.19]: the wrenches make the rate of momentum, whatever inertia, drive and phase."""
    rng = np.random.default_rng(seed)
    base = rng.normal(size=(3, 3))
    inertia = 1e-7 * (base @ base.T + 3 * np.eye(3))
    posture = replace(box_posture(offset=rng.uniform(0, 3e-3)), inertia=inertia)
    direction, angle, static = rng.uniform(-3, 3), rng.uniform(0, 0.5), rng.uniform(0.1, 0.9)
    settings = bowl(direction=direction, vibration_angle=angle, static=static)
    heading, phase = rng.uniform(-3, 3), cycle.phases(36)
    motion = floor_balance.motion(posture, settings, heading, phase)
    drive = floor_balance.drive_force(posture.mass, settings, heading, phase)
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
    force = np.abs(drive + weight).max()
    moment = max(np.abs(np.cross(at_d, normal)).max(), np.abs(spun).max())
    np.testing.assert_allclose(total.resultant, accelerated, rtol=0, atol=1e-12 * force)
    np.testing.assert_allclose(total.moment, spun, rtol=0, atol=1e-10 * moment)


def test_rolling():
    posture, settings = mechanics_samples.rolling_posture(), bowl(direction=90 * DEG, static=0.4)
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
    # The contact line accelerates exactly against friction of mu N.
    posture, settings = (
        mechanics_samples.rolling_posture(),
        bowl(direction=35 * DEG, static=0.2, kinetic=0.15),
    )
    force = floor_balance.drive_force(posture.mass, settings, 0.0)
    normal = np.array(posture.mass * G - force[2])
    motion = solve_rolling(posture, settings.friction, force[:2], normal)
    spin = motion.rolling_acceleration
    contact = motion.acceleration + spin * posture.height * np.array([0.0, 1.0])
    assert np.hypot(*motion.friction) == pytest.approx(0.15 * float(normal))
    assert contact @ motion.friction == pytest.approx(-np.hypot(*contact) * np.hypot(*motion.friction))
    about = -float(np.cross([0.0, 0.0, -posture.height], [*motion.friction, 0.0])[0]) / posture.inertia[0, 0]
    assert abs(spin) == pytest.approx(abs(about))


def test_maps_of_floor_and_track():
    """A cell is the single answer; figure 5-6's own values hop above asin(g / A w^2) = 7.9 deg."""
    beta, mu = np.radians([10.0, 20.0, 30.0])[:, None], np.array([[0.1, 0.3]])
    posture, settings = box_posture(offset=1e-3), bowl(direction=10 * DEG, vibration_angle=beta)
    cells = maps.floor_cells(posture, floor_balance.with_friction(settings, mu), 0.2)
    alone = bowl(direction=10 * DEG, vibration_angle=30 * DEG, static=0.1, kinetic=0.1)
    single = floor_balance.motion(posture, alone, 0.2)
    assert cells["acceleration_z_m_s2"][2, 0] == pytest.approx(float(single.acceleration[0]))
    assert cells["regime"][2, 0] == single.state
    settings = bowl(amplitude=0.5e-3, gravity=9.8, vibration_angle=np.radians([7.8, 8.0]))
    cells = maps.floor_cells(box_posture(), settings, 0.0)
    assert np.isnan(cells["acceleration_z_m_s2"]).tolist() == [False, True]
    assert [MOTION_STATES[code] for code in cells["regime"]][1] == "hop"
    bank, climb = np.radians([5.0, 15.0])[:, None], np.radians([[0.0, 2.0, 4.0]])
    cells = maps.track_cells(box_posture(), replace(BOWL, track=Track(climb, bank, 0.15, 0.025)))
    own = bowl(bank=15 * DEG, climb=4 * DEG)
    motion = track.motion(maps.seated(box_posture(), own)[0], own)
    assert cells["acceleration_x_m_s2"][1, 2] == pytest.approx(float(motion.acceleration[0]), rel=1e-9)
    assert cells["wall_2_N"][1, 2] == pytest.approx(float(motion.walls[1]), rel=1e-9)
    assert maps.TRACK_REGIMES[cells["regime"][1, 2]] == "slide"


@pytest.mark.parametrize(
    ("seed", "bank"), [*((seed, False) for seed in range(6)), *((seed, True) for seed in range(4))]
)
def test_track_and_floor_travel_as_convey_does(seed, bank):
    """Where wall and bank play no part, to 1e-9 A w; without a steady state neither settles."""
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


@pytest.mark.parametrize("seed", range(4))
def test_it_follows_the_accelerations_of_the_balance(seed):
    """The rows of three numbers give what the wrench equations give, at any phase, speed and sense."""
    part, settings = random_seat(np.random.default_rng(seed)), random_bowl(np.random.default_rng(seed))
    tolerance = -track.PULL_TOLERANCE * G
    slips = track.sliding_acceleration(part, settings, frame(settings, part.walls), tolerance)
    for phase, speed, sense in ((0.3, 0.02, 1.0), (1.6, 0.01, 1.0), (4.6, -0.01, -1.0), (5.9, -0.03, -1.0)):
        want = track.motion(part, settings, np.array([phase]), sense, speed).acceleration[0, 0]
        assert slips(phase, speed, sense) == pytest.approx(want, rel=1e-9)


def test_short_slips_and_slow_settling():
    """Just above the limit of slip the slip lasts a fraction of a degree."""
    limit = float(floor_balance.motion(FLAT, bowl(), 0.0).limiting_friction)
    held, lost = (floor_balance.with_friction(bowl(), limit * share) for share in (1 + 1e-7, 1 - 1e-7))
    assert floor_balance.over_cycle(FLAT, held, 0.0)[1].mean == 0.0
    level = replace(lost, restitution=0.0, track=replace(lost.track, climb=0.0, bank=0.0))
    mean = floor_balance.over_cycle(FLAT, lost, 0.0)[1].mean
    assert mean == pytest.approx(answer.answer(level).velocity, rel=1e-4)
    assert 0.0 < mean < 1e-9
    windows = [(0.0, cycle.PERIOD_PHASE, 1.0)]
    assert not cycle.settle(lambda phase, speed, sense: 1.0, windows, 0.02).settled
    braked = cycle.settle(lambda phase, speed, sense: 1.0 - speed, windows, 0.02)  # slowly, to a speed of 1
    assert (braked.settled, braked.mean) == (True, pytest.approx(1.0, rel=1e-9))


def seated(length=0.03, width=0.01, height=0.005, pull=1.0):
    return seat(box_posture(length, width, height), 0.0, rectangle(length, width)[:2], pull)


@pytest.mark.parametrize("moving", [0.0, 1.0, -1.0])
@pytest.mark.parametrize("seed", range(12))
def test_newton_and_euler_on_random_parts_and_bowls(seed, moving):
    """Eqs. [4.32] to [4.37], eqs. [4.57] to [4.62], to the largest term of its kind."""
    rng = np.random.default_rng(seed)
    part, settings = random_seat(rng), random_bowl(rng)
    motion = track.motion(part, settings, PHASE, moving, speed=0.03 * moving)
    assert motion.normal_force.min() > 0.0
    assert motion.walls.min() >= 0.0
    axes, count = frame(settings, part.walls), len(PHASE)
    nothing, flat = np.zeros((count, 3)), np.zeros((count, 2))
    at_d = np.column_stack([np.nan_to_num(motion.offset), np.full(count, -part.height)])
    normal = np.column_stack([flat, motion.normal_force])
    friction = np.column_stack([-motion.traction, motion.radial_friction, np.zeros(count)])
    couple = np.column_stack([flat, motion.couple])
    wrenches = [
        Wrench(motion.load, nothing),
        Wrench(normal, np.cross(at_d, normal)),
        Wrench(friction, np.cross(at_d, friction) + couple),
    ]
    for k in (0, 1):
        push, rub = motion.walls[:, k, None], motion.wall_friction[:, k, None]
        force = push * axes.normals[k] - rub * axes.courses[k]
        wrenches.append(Wrench(force, np.cross(part.walls[k], force)))
    total = sum(wrenches[1:], wrenches[0])
    rate = part.mass * np.column_stack([motion.acceleration, np.zeros(count)])
    spun = motion.turning[:, None] * part.inertia
    force, moment = (
        max(np.abs(getattr(w, kind)).max() for w in wrenches) for kind in ("resultant", "moment")
    )
    assert np.abs(total.resultant - rate).max() < 1e-10 * force
    assert np.abs(total.moment - spun).max() < 1e-10 * moment


def test_the_floor_is_its_limit():
    """A straight, smooth wall, no bank, no climb: the wall carries nothing and all is as on the floor."""
    posture, settings = box_posture(), bowl(radius=1e9, bank=0.0, climb=0.0, wall=0.0, kinetic=0.25)
    part = seated(pull=0.0)
    on_track = track.motion(part, settings, PHASE)
    on_floor = floor_balance.motion(posture, settings, 0.0, PHASE)
    assert (on_track.state == on_floor.state).all()
    assert np.abs(on_track.walls).max() < 1e-9 * posture.mass * 9.81
    np.testing.assert_allclose(on_track.normal_force, on_floor.normal_force, rtol=1e-12)
    for own, other in (
        (on_track.acceleration[:, 0], on_floor.acceleration[:, 0]),
        (on_track.offset, on_floor.offset),
        (track.over_cycle(part, settings)[1].velocity,
         floor_balance.over_cycle(posture, settings, 0.0)[1].velocity),
    ):  # fmt: skip
        np.testing.assert_allclose(own, other, rtol=1e-9, atol=1e-12)


def test_what_presses_against_the_wall_and_rest():
    """Without drive, friction and curvature: N = m g / cos(delta), R1 + R2 = m g tan(delta)."""
    settings = bowl(amplitude=0.0, static=0.0, kinetic=0.0, wall=0.0, climb=0.0, radius=1e9, bank=20 * DEG)
    motion, weight = track.motion(seated(), settings), 0.01 * 9.81
    assert motion.normal_force == pytest.approx(weight / np.cos(20 * DEG))
    assert motion.walls == pytest.approx([weight * np.tan(20 * DEG) / 2] * 2)
    settings = bowl(amplitude=0.0, bank=0.0, climb=0.0, static=0.5)  # only the centrifugal force presses
    motion = track.motion(seated(pull=0.0), settings, 0.0, 1.0, speed=0.2)
    sigma = np.arcsin(0.015 / 0.15)
    across = motion.walls.sum() * np.cos(sigma) + motion.wall_friction @ [np.sin(sigma), -np.sin(sigma)]
    assert across == pytest.approx(0.01 * 0.2**2 / 0.15)
    part = seated()
    limit = float(track.motion(part, bowl(), 0.5 * np.pi).needed[0])
    frictions = (limit * (1 + 1e-7), limit * (1 - 1e-7))
    rest, slip = (track.motion(part, bowl(static=mu, kinetic=mu, wall=mu)) for mu in frictions)
    assert [MOTION_STATES[motion.state] for motion in (rest, slip)] == ["stick", "slide"]
    for name in ("normal_force", "walls", "traction", "wall_friction", "offset"):
        np.testing.assert_allclose(getattr(rest, name), getattr(slip, name), rtol=1e-5)
    motion = track.motion(seated(), bowl(static=1.5, kinetic=1.0, wall=0.6))
    assert MOTION_STATES[motion.state] == "stick"
    used = motion.wall_friction / motion.walls
    assert used == pytest.approx(motion.needed[1:])
    assert used / 0.6 == pytest.approx([motion.needed[0] / 1.5] * 2)
    assert motion.acceleration == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("seed", range(8))
def test_reactions_by_reciprocal_screws_agree(seed):
    """Six unit wrenches against the linear system: two ways to the same reactions."""
    rng = np.random.default_rng(seed)
    part, settings = random_seat(rng), random_bowl(rng)
    settings = replace(settings, drive=replace(settings.drive, direction=-20 * DEG))  # against the wall
    motion = track.motion(part, settings, 0.5 * np.pi, 1.0)
    assert motion.closed.all()
    axes, mu = frame(settings, part.walls), settings.friction
    six = contact_wrenches(part, axes, part.contact[:3], floor=mu.kinetic, wall=np.full(2, mu.wall))
    load = loads(part, settings, axes, 0.5 * np.pi)
    pushed = reactions(six, Wrench(load, np.zeros(3), Point("C", np.zeros(3))))
    assert pushed[:3].sum() == pytest.approx(motion.normal_force, rel=1e-9)
    assert pushed[3:5] == pytest.approx(motion.walls, rel=1e-8, abs=1e-12)
    assert pushed[5] == pytest.approx(-part.mass * motion.acceleration[0], rel=1e-9)
    acting = (pushed[:3, None] * part.contact[:3]).sum(axis=0) / pushed[:3].sum()
    assert acting == pytest.approx(motion.offset, rel=1e-8)


def test_first_to_open_is_where_the_reaction_is_nought():
    """At the drive it names, the contact carries nothing; just below, all carry."""
    part = seated(0.008, 0.008, 0.012)
    settings = bowl(bank=5 * DEG, climb=0.0, static=0.2, kinetic=0.2, wall=0.1)
    first = first_to_open(part, settings)
    assert first.drive_factor > 1.0
    at = (0.5 * np.pi, 1.0) if first.reversal == "upper" else (1.5 * np.pi, -1.0)
    below, above = (
        track.motion(part, bowl(bank=5 * DEG, climb=0.0, static=0.2, kinetic=0.2, wall=0.1,
                                amplitude=settings.drive.amplitude * first.drive_factor * share), *at)
        for share in (0.999, 1.001)
    )  # fmt: skip
    assert below.closed.all() and below.inside > 0.0 and below.normal_force > 0.0
    opened = {"floor": above.inside < 0.0 or above.normal_force == 0.0}
    opened |= {f"wall_{k + 1}": not above.closed[k] for k in (0, 1)}
    assert opened[first.contact]


def test_a_tall_part_tips_over_its_leading_edge():
    """On the level the axis is the edge of the contact polygon that it slides towards."""
    part = seated(0.006, 0.02, 0.02, pull=0.0)
    first = first_to_open(part, bowl(bank=0.0, climb=0.0, radius=1e6, static=5.0, kinetic=5.0, wall=0.0))
    assert first.contact == "floor"
    assert first.pitch == pytest.approx(0.0, abs=1e-9)
    assert np.abs(first.direction) == pytest.approx([0.0, 1.0, 0.0], abs=1e-6)
    assert abs(first.point[0]) == pytest.approx(0.003)
    push = 0.05e-3 * (2 * np.pi * 60) ** 2
    edge = 0.003 * 9.81 / (0.01 * push * np.cos(20 * DEG) + 0.003 * push * np.sin(20 * DEG))
    assert first.drive_factor == pytest.approx(edge, rel=1e-6)


def test_wall_contacts_open():
    motion = track.motion(seated(pull=0.0), bowl(direction=20 * DEG, bank=0.0))
    assert not motion.closed.any() and not motion.walls.any()
    assert motion.acceleration[1] > 0.0 > motion.radial_friction
    assert np.hypot(motion.traction, motion.radial_friction) == pytest.approx(0.3 * motion.normal_force)
    # Wall friction at a long side lever unloads the leading contact of a short part.
    part, settings = seated(0.006, 0.02), bowl(wall=1.0, bank=15 * DEG, climb=0.0)
    motion = track.motion(part, settings, 0.5 * np.pi, 1.0)
    assert motion.closed.sum() == 1
    for k, normal in enumerate(frame(settings, part.walls).normals):
        x, y = part.walls[k][:2]
        rate = (motion.acceleration * [0.0, 1.0] + motion.turning * np.array([-y, x])) @ normal[:2]
        assert abs(rate) < 1e-9 if motion.closed[k] else rate > 1e-9
        assert (motion.walls[k] > 0.0) == motion.closed[k]
    # A bolt along the wall: its far end is pulled at by little; the near contact goes on pressing.
    walls = np.array([[-19.183, -5.713, -2.342], [5.964, -6.826, 0.646]]) * 1e-3
    part = Seat(0.013, 5.8e-3, 0.0, np.array([0.0, 0.0, 1.2e-6]), walls, rectangle(0.03, 0.02))
    drive = {"amplitude": 0.05e-3, "vibration_angle": 30 * DEG}
    settings = bowl(**drive, static=0.6, kinetic=0.6, wall=0.6, bank=24 * DEG, climb=2 * DEG)
    axes = frame(settings, walls)
    both = track.solve_rest(part, axes, loads(part, settings, axes, 0.5 * np.pi), (True, True), 1.0)
    motion = track.motion(part, settings)
    assert both.walls[0] < 0.0 < both.walls[1]
    assert motion.closed.tolist() == [False, True]
    assert motion.needed[0] == pytest.approx(both.mobilised, rel=0.01)


@pytest.mark.parametrize("rub", [0.1, 0.4, 1.0])
def test_wall_friction_takes_power_from_a_part_that_starts_to_turn(rub):
    """One closed contact: it slides ahead, back, or stays in place and the part rolls along the wall."""
    part, settings = seated(0.002, 0.02), bowl(static=0.31, wall=rub, bank=15 * DEG, climb=0.0)
    motion, axes = track.motion(part, settings, PHASE), frame(settings, part.walls)
    alone = motion.slides & (motion.closed.sum(axis=-1) == 1)
    assert alone.any()
    for k in (0, 1):
        course, place = axes.courses[k], part.walls[k]
        lever = place[0] * course[1] - place[1] * course[0]
        slip = motion.acceleration @ course[:2] + motion.turning * lever
        force, limit = motion.wall_friction[:, k], rub * motion.walls[:, k]
        assert (np.abs(force) <= limit * (1 + 1e-9)).all()
        assert (force * slip >= -1e-9 * limit)[alone].all()
        in_place = alone & (np.abs(force) < 0.999 * limit)
        assert np.abs(slip[in_place]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("part", "bank"), [(ANGLE, 15.0), (CHANNEL, 7.5)])
def test_a_strong_drive_pulls_a_part_that_wedges_itself_ahead_at_every_climb(part, bank):
    """Friction at the wall grows without bound at a coefficient of 7 to 8: nothing beyond it is taken."""
    settings = bowl(
        amplitude=0.125e-3, vibration_angle=25 * DEG, direction=0.0, static=0.35, kinetic=0.3, wall=0.2,
        climb=np.linspace(0.0, 8.0, 4001) * DEG, bank=bank * DEG, radius=0.14,
    )  # fmt: skip
    motion = track.motion(part, settings)
    assert (motion.state == floor_balance.SLIDE).all() and (motion.traction > 0.0).all()
    assert (np.diff(motion.acceleration[:, 0]) < 0.0).all()


def test_bank_without_radial_friction_puts_the_wall_through_the_centre_of_mass():
    part = random_seat(np.random.default_rng(5))
    part = replace(part, walls=part.walls * [1, 1, 0] + [0, 0, 2e-3])
    up = frame(bowl(bank=track.bank_without_radial_friction(part), climb=0.0), part.walls).up
    assert (part.walls @ up).mean() == pytest.approx(0.0, abs=1e-3 * np.abs(part.walls).max())


def still(static, climb=0.0, wall=0.0):
    own = {"amplitude": 0.0, "static": static, "kinetic": static, "wall": wall}
    return bowl(**own, climb=climb, bank=0.0, radius=1e6)


@pytest.mark.parametrize(
    ("climb", "wall", "high", "low"), [(3, 0.0, 1.002, 0.998), (20, 0.0, 1.002, 0.998), (20, 0.5, 1.005, 0.9)]
)
def test_friction_wedges_a_part_against_a_rough_wall(climb, wall, high, low):
    """A smooth wall leaves the angle of friction, within what the pyramid leaves of the cone."""
    least = math.tan(climb * DEG) / math.sqrt(1.0 + wall**2)
    assert has_equilibrium(seated(pull=0.0), still(least * high, climb * DEG, wall))
    assert not has_equilibrium(seated(pull=0.0), still(least * low, climb * DEG, wall))
    if wall:
        motion = track.motion(seated(pull=0.0), still(least * high, climb * DEG, wall))
        assert motion.state == floor_balance.SLIDE


def test_a_card_without_data_of_its_contacts():
    printed = {"track": {"wall_lever": 8e-3, "wall_lever_angle": 64 * DEG, "wall_x": (7e-3, 9e-3)}}
    card = replace(box_posture(), printed=printed, contact=np.zeros((0, 2)))
    assert not has_equilibrium(seated(0.006, 0.01, 0.02, pull=0.0), still(5.0, 40 * DEG))  # it tips
    assert has_equilibrium(seated(pull=0.0), still(5.0, 40 * DEG))
    assert not has_equilibrium(card_seat(card), bowl(amplitude=0.0))  # it cannot be told
    with pytest.raises(FeederError) as fault:
        card_seat(replace(box_posture(), corners=None, printed={"floor": {}, "track": {}}))
    assert str(fault.value) == (
        "part card, aspect A: the card has no wall_lever for this aspect in its track block"
        " - choose the aspect that its track block names, or give the part as a mesh"
    )


@pytest.mark.parametrize(("climb", "bank"), [(0, 0), (5, 0), (5, 20), (-8, 40)])
def test_wall_normals_pass_through_the_axis_of_the_bowl(climb, bank):
    """Seen level, each normal leads over the wall's radius to the axis, which lies inward of the centre."""
    part = random_seat(np.random.default_rng(2))
    axes = frame(bowl(climb=climb * DEG, bank=bank * DEG, radius=0.05), part.walls)
    ahead = np.cross(axes.radial, axes.up)  # level
    np.testing.assert_allclose((part.walls + 0.05 * axes.normals) @ ahead, 0.0, atol=1e-15)
    np.testing.assert_allclose(axes.normals @ axes.up, 0.0, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(axes.normals, axis=1), 1.0, rtol=1e-12)


@pytest.mark.parametrize("command", ["floor", "track"])
def test_of_a_card_the_aspect_of_its_block_or_the_first_is_taken(run, tmp_path, command):
    card = PARTS / "arc_chute.yaml"
    chosen, asked = (run(command, card, *own, "--format", "json") for own in ([], ["--aspect", "5"]))
    assert json.loads(chosen.stdout) == json.loads(asked.stdout)
    assert chosen.stderr.splitlines()[0] == f"Aspect 5, the one of the card's {command} block"
    (tmp_path / "card.yaml").write_text(LISTED)
    if command == "floor":
        assert run(command, "card.yaml").stderr.splitlines()[0] == "Aspect x, the first of the card"
