"""A part on the track: Newton and Euler, the floor as its limit, contacts that open, static equilibrium."""

import math
from dataclasses import replace

import numpy as np
import pytest
from mechanics_samples import BOWL, DEG, bowl, box_posture, random_bowl, random_seat, rectangle

from feederscrew.bowl.record import Track
from feederscrew.errors import FeederError
from feederscrew.mechanics import cycle, floor_balance
from feederscrew.mechanics import motion_maps as track_cells
from feederscrew.mechanics import track_balance as track
from feederscrew.mechanics.floor_balance import MOTION_STATES
from feederscrew.mechanics.track_balance import (
    Seat,
    bank_without_radial_friction,
    card_seat,
    frame,
    loads,
    seat,
)
from feederscrew.mechanics.track_contacts import contact_wrenches, exists, first_to_open
from feederscrew.screw import Point, Wrench, reactions

PHASE = cycle.phases(24)


def seated(length=0.03, width=0.01, height=0.005, pull=1.0):
    """A box with its long side to the wall."""
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
        force = (
            motion.walls[:, k, None] * axes.normals[k] - motion.wall_friction[:, k, None] * axes.courses[k]
        )
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


def test_what_presses_against_the_wall():
    """Without drive, friction and curvature: N = m g / cos(delta), R1 + R2 = m g tan(delta).

    Unbanked, the centrifugal force presses.
    """
    settings = bowl(amplitude=0.0, static=0.0, kinetic=0.0, wall=0.0, climb=0.0, radius=1e9, bank=20 * DEG)
    motion, weight = track.motion(seated(), settings), 0.01 * 9.81
    assert motion.normal_force == pytest.approx(weight / np.cos(20 * DEG))
    assert motion.walls == pytest.approx([weight * np.tan(20 * DEG) / 2] * 2)
    settings = bowl(amplitude=0.0, bank=0.0, climb=0.0, static=0.5)
    motion = track.motion(seated(pull=0.0), settings, 0.0, 1.0, speed=0.2)
    sigma = np.arcsin(0.015 / 0.15)
    across = motion.walls.sum() * np.cos(sigma) + motion.wall_friction @ [np.sin(sigma), -np.sin(sigma)]
    assert across == pytest.approx(0.01 * 0.2**2 / 0.15)


def test_rest_goes_over_into_sliding_without_a_jump():
    part = seated()
    limit = float(track.motion(part, bowl(), 0.5 * np.pi).needed[0])
    frictions = (limit * (1 + 1e-7), limit * (1 - 1e-7))
    rest, slip = (track.motion(part, bowl(static=mu, kinetic=mu, wall=mu)) for mu in frictions)
    assert [MOTION_STATES[motion.state] for motion in (rest, slip)] == ["stick", "slide"]
    for name in ("normal_force", "walls", "traction", "wall_friction", "offset"):
        np.testing.assert_allclose(getattr(rest, name), getattr(slip, name), rtol=1e-5)


def test_friction_at_rest_uses_one_share_of_every_limit():
    motion = track.motion(seated(), bowl(static=1.5, kinetic=1.0, wall=0.6))
    assert MOTION_STATES[motion.state] == "stick"
    used = motion.wall_friction / motion.walls
    assert used == pytest.approx(motion.needed[1:])
    assert used / 0.6 == pytest.approx([motion.needed[0] / 1.5] * 2)
    assert motion.acceleration == pytest.approx([0.0, 0.0], abs=1e-12)


def test_forward_limit_with_the_wall():
    """Level, straight, unbanked, pressed by the drive alone: slips when |F| > mu N + mu_w N_w."""
    settings = bowl(bank=0.0, climb=0.0, radius=1e9, direction=-15 * DEG)
    ratio = 0.05e-3 * (2 * np.pi * 60) ** 2 / 9.81
    along, across = (ratio * np.cos(20 * DEG) * f(15 * DEG) for f in (np.cos, np.sin))
    want = along / (1 - ratio * np.sin(20 * DEG) + across)
    assert track.motion(seated(pull=0.0), settings).needed[0] == pytest.approx(want, rel=1e-9)


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


# Contacts that open: which, when, and what friction does at the other.


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


def test_a_drive_inward_opens_the_wall_and_is_solved_without_it():
    motion = track.motion(seated(pull=0.0), bowl(direction=20 * DEG, bank=0.0))
    assert not motion.closed.any() and not motion.walls.any()
    assert motion.acceleration[1] > 0.0 > motion.radial_friction
    assert np.hypot(motion.traction, motion.radial_friction) == pytest.approx(0.3 * motion.normal_force)


def test_one_wall_contact_opens_and_the_part_turns_off_it():
    """Wall friction at a long side lever unloads the leading contact of a short part."""
    part, settings = seated(0.006, 0.02), bowl(wall=1.0, bank=15 * DEG, climb=0.0)
    motion = track.motion(part, settings, 0.5 * np.pi, 1.0)
    assert motion.closed.sum() == 1
    for k, normal in enumerate(frame(settings, part.walls).normals):
        x, y = part.walls[k][:2]
        rate = (motion.acceleration * [0.0, 1.0] + motion.turning * np.array([-y, x])) @ normal[:2]
        assert abs(rate) < 1e-9 if motion.closed[k] else rate > 1e-9
        assert (motion.walls[k] > 0.0) == motion.closed[k]


def test_at_rest_the_contact_opens_that_would_have_to_pull():
    """A bolt along the wall: its far end is pulled at by little; the near contact goes on pressing."""
    walls = np.array([[-19.183, -5.713, -2.342], [5.964, -6.826, 0.646]]) * 1e-3
    part = Seat(0.013, 5.8e-3, 0.0, np.array([0.0, 0.0, 1.2e-6]), walls, rectangle(0.03, 0.02))
    drive = {"amplitude": 0.05e-3, "vibration_angle": 30 * DEG}
    settings = bowl(**drive, static=0.6, kinetic=0.6, wall=0.6, bank=24 * DEG, climb=2 * DEG)
    axes = frame(settings, walls)
    both = track.held(part, axes, loads(part, settings, axes, 0.5 * np.pi), (True, True), 1.0)
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
        slip = motion.acceleration @ course[:2] + motion.turning * (
            place[0] * course[1] - place[1] * course[0]
        )
        force, limit = motion.wall_friction[:, k], rub * motion.walls[:, k]
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
    motion = track.motion(part, settings)
    assert (motion.state == floor_balance.SLIDE).all() and (motion.traction > 0.0).all()
    assert (np.diff(motion.acceleration[:, 0]) < 0.0).all()


def test_bank_without_radial_friction_puts_the_wall_through_the_centre_of_mass():
    part = random_seat(np.random.default_rng(5))
    part = replace(part, walls=part.walls * [1, 1, 0] + [0, 0, 2e-3])
    up = frame(bowl(bank=bank_without_radial_friction(part), climb=0.0), part.walls).up
    assert (part.walls @ up).mean() == pytest.approx(0.0, abs=1e-3 * np.abs(part.walls).max())


def test_a_map_cell_is_the_single_answer():
    bank, climb = np.radians([5.0, 15.0])[:, None], np.radians([[0.0, 2.0, 4.0]])
    cells = track_cells.track_cells(box_posture(), replace(BOWL, track=Track(climb, bank, 0.15, 0.025)))
    own = bowl(bank=15 * DEG, climb=4 * DEG)
    motion = track.motion(track_cells.seated(box_posture(), own)[0], own)
    assert cells["acceleration_x_m_s2"][1, 2] == pytest.approx(float(motion.acceleration[0]), rel=1e-9)
    assert cells["wall_2_N"][1, 2] == pytest.approx(float(motion.walls[1]), rel=1e-9)
    assert track_cells.TRACK_REGIMES[cells["regime"][1, 2]] == "slide"


# Static equilibrium with friction in any direction, and the wall's contact angle on a climb with a bank.


def still(static, climb=0.0, wall=0.0):
    own = {"amplitude": 0.0, "static": static, "kinetic": static, "wall": wall}
    return bowl(**own, climb=climb, bank=0.0, radius=1e6)


@pytest.mark.parametrize(
    ("climb", "wall", "high", "low"),
    [(3, 0.0, 1.002, 0.998), (20, 0.0, 1.002, 0.998), (20, 0.5, 1.005, 0.9)],
)
def test_friction_wedges_a_part_against_a_rough_wall(climb, wall, high, low):
    """A smooth wall leaves the angle of friction, within what the pyramid leaves of the cone.

    Pushing to a rough one costs some of the friction of the floor and earns the wall's, and more.
    """
    least = math.tan(climb * DEG) / math.sqrt(1.0 + wall**2)
    assert exists(seated(pull=0.0), still(least * high, climb * DEG, wall))
    assert not exists(seated(pull=0.0), still(least * low, climb * DEG, wall))
    if wall:
        motion = track.motion(seated(pull=0.0), still(least * high, climb * DEG, wall))
        assert motion.state == floor_balance.SLIDE


def test_a_part_that_tips_has_no_equilibrium_and_one_that_sticks_has():
    """Random parts are taken until five of them stick."""
    settings = still(5.0, 40 * DEG)
    assert not exists(seated(0.006, 0.01, 0.02, pull=0.0), settings)
    assert exists(seated(pull=0.0), settings)
    rngs = (np.random.default_rng(seed) for seed in range(60))
    pairs = ((random_seat(rng), random_bowl(rng)) for rng in rngs)
    stuck = [pair for pair in pairs if track.motion(*pair).state == floor_balance.STICK][:5]
    assert [exists(*pair) for pair in stuck] == [True] * 5


def test_a_card_without_data_of_its_contacts():
    printed = {"track": {"wall_lever": 8e-3, "wall_lever_angle": 64 * DEG, "wall_x": (7e-3, 9e-3)}}
    card = replace(box_posture(), printed=printed, contact=np.zeros((0, 2)))
    assert exists(seated(pull=0.0), bowl(amplitude=0.0))
    assert not exists(card_seat(card), bowl(amplitude=0.0))  # it cannot be told
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
