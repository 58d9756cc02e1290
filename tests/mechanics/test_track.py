"""A part on the track: Newton and Euler, the floor as its limit, contacts that open, reciprocal screws."""

from dataclasses import replace

import numpy as np
import pytest
from mechanics_samples import BOWL, DEG, bowl, box_posture, random_bowl, random_seat, rectangle

from feederscrew.bowl.record import Track
from feederscrew.errors import FeederError
from feederscrew.mechanics import cycle, floor_balance
from feederscrew.mechanics import motion_maps as track_cells
from feederscrew.mechanics import track_balance as track
from feederscrew.mechanics.track_balance import bank_without_radial_friction, card_seat, frame, loads, seat
from feederscrew.mechanics.track_contacts import contact_wrenches, first_to_open
from feederscrew.screw import Point, Wrench, reactions

PHASE = cycle.phases(24)


def wrenches(part, settings, found):
    """Every force on the part as a wrench about its centre of mass, (contacts and loads, 24)."""
    axes, below = frame(settings, part.walls), -part.height
    count = len(found.normal_force)
    at_d = np.column_stack([np.nan_to_num(found.offset), np.full(count, below)])
    normal = np.column_stack([np.zeros((count, 2)), found.normal_force])
    friction = np.column_stack([-found.traction, found.radial_friction, np.zeros(count)])
    couple = np.column_stack([np.zeros((count, 2)), found.couple])
    made = [
        Wrench(found.load, np.zeros((count, 3))),
        Wrench(normal, np.cross(at_d, normal)),
        Wrench(friction, np.cross(at_d, friction) + couple),
    ]
    for k in (0, 1):
        force = found.walls[:, k, None] * axes.normals[k] - found.wall_friction[:, k, None] * axes.courses[k]
        made.append(Wrench(force, np.cross(part.walls[k], force)))
    return made


def residual(part, settings, found):
    """Largest miss of the six equations, over the largest term of its kind."""
    made = wrenches(part, settings, found)
    total = made[0]
    for one in made[1:]:
        total = total + one
    rate = part.mass * np.column_stack([found.acceleration, np.zeros(len(PHASE))])
    spun = found.turning[:, None] * part.inertia
    force = np.abs(total.resultant - rate).max() / max(np.abs(w.resultant).max() for w in made)
    moment = np.abs(total.moment - spun).max() / max(np.abs(w.moment).max() for w in made)
    return max(force, moment)


@pytest.mark.parametrize("moving", [0.0, 1.0, -1.0])
@pytest.mark.parametrize("seed", range(12))
def test_newton_and_euler_on_random_parts_and_bowls(seed, moving):
    """Eqs. [4.32] to [4.37], eqs. [4.57] to [4.62]."""
    rng = np.random.default_rng(seed)
    part, settings = random_seat(rng), random_bowl(rng)
    found = track.motion(part, settings, PHASE, moving, speed=0.03 * moving)
    assert residual(part, settings, found) < 1e-10
    assert found.normal_force.min() > 0.0
    assert found.walls.min() >= 0.0


def test_the_floor_is_its_limit():
    """A straight, smooth wall, no bank, no climb: the wall carries nothing and all is as on the floor."""
    posture, settings = box_posture(), bowl(radius=1e9, bank=0.0, climb=0.0, wall=0.0, kinetic=0.25)
    part = seat(posture, 0.0, rectangle(0.03, 0.01)[:2], 0.0)
    on_track, on_floor = (
        track.motion(part, settings, PHASE),
        floor_balance.motion(posture, settings, 0.0, PHASE),
    )
    assert (on_track.state == on_floor.state).all()
    weight = posture.mass * 9.81
    assert np.abs(on_track.walls).max() < 1e-9 * weight
    np.testing.assert_allclose(on_track.normal_force, on_floor.normal_force, rtol=1e-12)
    np.testing.assert_allclose(
        on_track.acceleration[:, 0], on_floor.acceleration[:, 0], rtol=1e-9, atol=1e-12
    )
    np.testing.assert_allclose(on_track.offset, on_floor.offset, rtol=1e-9, atol=1e-12)
    ridden = [over(*args)[1].velocity for over, args in ((track.over_cycle, (part, settings)),
              (floor_balance.over_cycle, (posture, settings, 0.0)))]  # fmt: skip
    np.testing.assert_allclose(*ridden, rtol=1e-9, atol=1e-12)


def test_wall_and_floor_share_the_weight_of_a_banked_part():
    """Without drive, friction and curvature: N = m g / cos(delta), R1 + R2 = m g tan(delta)."""
    settings = bowl(amplitude=0.0, static=0.0, kinetic=0.0, wall=0.0, climb=0.0, radius=1e9, bank=20 * DEG)
    posture = box_posture()
    found = track.motion(seat(posture, 0.0, rectangle(0.03, 0.01)[:2], 1.0), settings)
    weight = posture.mass * 9.81
    assert found.normal_force == pytest.approx(weight / np.cos(20 * DEG))
    assert found.walls == pytest.approx([weight * np.tan(20 * DEG) / 2] * 2)


def test_centrifugal_force_presses_against_the_wall():
    settings = bowl(amplitude=0.0, bank=0.0, climb=0.0, static=0.5)
    part = seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 0.0)
    found = track.motion(part, settings, 0.0, 1.0, speed=0.2)
    sigma = np.arcsin(0.015 / 0.15)
    across = found.walls.sum() * np.cos(sigma) + found.wall_friction @ [np.sin(sigma), -np.sin(sigma)]
    assert across == pytest.approx(0.01 * 0.2**2 / 0.15)


def test_rest_goes_over_into_sliding_without_a_jump():
    part = seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 1.0)
    limit = float(track.motion(part, bowl(), 0.5 * np.pi).needed[0])
    above, below = (
        track.motion(part, bowl(static=mu, kinetic=mu, wall=mu))
        for mu in (limit * (1 + 1e-7), limit * (1 - 1e-7))
    )
    assert [floor_balance.MOTION_STATES[f.state] for f in (above, below)] == ["stick", "slide"]
    for name in ("normal_force", "walls", "traction", "wall_friction", "offset"):
        np.testing.assert_allclose(getattr(above, name), getattr(below, name), rtol=1e-5)


def test_friction_at_rest_uses_one_share_of_every_limit():
    found = track.motion(
        seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 1.0), bowl(static=1.5, kinetic=1.0, wall=0.6)
    )
    assert floor_balance.MOTION_STATES[found.state] == "stick"
    used = found.wall_friction / found.walls
    assert used == pytest.approx(found.needed[1:])
    assert used / 0.6 == pytest.approx([found.needed[0] / 1.5] * 2)
    assert found.acceleration == pytest.approx([0.0, 0.0], abs=1e-12)


def test_forward_limit_with_the_wall():
    """Level, straight, unbanked, pressed by the drive alone: slips when |F| > mu N + mu_w N_w."""
    settings = bowl(bank=0.0, climb=0.0, radius=1e9, direction=-15 * DEG)
    part = seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 0.0)
    ratio = 0.05e-3 * (2 * np.pi * 60) ** 2 / 9.81
    along, across = ratio * np.cos(20 * DEG) * np.cos(15 * DEG), ratio * np.cos(20 * DEG) * np.sin(15 * DEG)
    want = along / (1 - ratio * np.sin(20 * DEG) + across)
    assert track.motion(part, settings).needed[0] == pytest.approx(want, rel=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_reactions_by_reciprocal_screws_agree(seed):
    """Six unit wrenches against the linear system: two ways to the same reactions."""
    rng = np.random.default_rng(seed)
    part, settings = random_seat(rng), random_bowl(rng)
    settings = replace(settings, drive=replace(settings.drive, direction=-20 * DEG))  # against the wall
    found = track.motion(part, settings, 0.5 * np.pi, 1.0)
    assert found.closed.all()
    axes = frame(settings, part.walls)
    coefficients = settings.friction
    six = contact_wrenches(
        part, axes, part.contact[:3], floor=coefficients.kinetic, wall=np.full(2, coefficients.wall)
    )
    load = loads(part, settings, axes, 0.5 * np.pi)
    pushed = reactions(six, Wrench(load, np.zeros(3), Point("C", np.zeros(3))))
    assert pushed[:3].sum() == pytest.approx(found.normal_force, rel=1e-9)
    assert pushed[3:5] == pytest.approx(found.walls, rel=1e-8, abs=1e-12)
    assert pushed[5] == pytest.approx(-part.mass * found.acceleration[0], rel=1e-9)
    acting = (pushed[:3, None] * part.contact[:3]).sum(axis=0) / pushed[:3].sum()
    assert acting == pytest.approx(found.offset, rel=1e-8)


def test_first_to_open_is_where_the_reaction_is_nought():
    """At the drive it names, the contact carries nothing; just below, all carry."""
    posture = box_posture(length=0.008, width=0.008, height=0.012)
    part = seat(posture, 0.0, rectangle(0.008, 0.008)[:2], 1.0)
    settings = bowl(bank=5 * DEG, climb=0.0, static=0.2, kinetic=0.2, wall=0.1)
    first = first_to_open(part, settings)
    assert first.drive_factor > 1.0
    phase = 0.5 * np.pi if first.reversal == "upper" else 1.5 * np.pi
    sense = 1.0 if first.reversal == "upper" else -1.0

    def at(share):
        drive = replace(settings.drive, amplitude=settings.drive.amplitude * first.drive_factor * share)
        return track.motion(part, replace(settings, drive=drive), phase, sense)

    below, above = at(0.999), at(1.001)
    assert below.closed.all()
    assert below.inside > 0.0
    assert below.normal_force > 0.0
    opened = {
        "floor": above.inside < 0.0 or above.normal_force == 0.0,
        "wall_1": not above.closed[0],
        "wall_2": not above.closed[1],
    }
    assert opened[first.contact]


def test_a_tall_part_tips_over_its_leading_edge():
    """On the level the axis is the edge of the contact polygon that it slides towards."""
    posture = box_posture(length=0.006, width=0.02, height=0.02)
    part = seat(posture, 0.0, rectangle(0.006, 0.02)[:2], 0.0)
    first = first_to_open(part, bowl(bank=0.0, climb=0.0, radius=1e6, static=5.0, kinetic=5.0, wall=0.0))
    assert first.contact == "floor"
    assert first.pitch == pytest.approx(0.0, abs=1e-9)
    assert np.abs(first.direction) == pytest.approx([0.0, 1.0, 0.0], abs=1e-6)
    assert abs(first.point[0]) == pytest.approx(0.003)
    push = 0.05e-3 * (2 * np.pi * 60) ** 2
    edge = 0.003 * 9.81 / (0.01 * push * np.cos(20 * DEG) + 0.003 * push * np.sin(20 * DEG))
    assert first.drive_factor == pytest.approx(edge, rel=1e-6)


def test_bank_without_radial_friction_puts_the_wall_through_the_centre_of_mass():
    rng = np.random.default_rng(5)
    part = random_seat(rng)
    part = replace(part, walls=part.walls * [1, 1, 0] + [0, 0, 2e-3])
    bank = bank_without_radial_friction(part)
    up = frame(bowl(bank=bank, climb=0.0), part.walls).up
    assert (part.walls @ up).mean() == pytest.approx(0.0, abs=1e-3 * np.abs(part.walls).max())


def test_a_map_cell_is_the_single_answer():
    posture = box_posture()
    bank, climb = np.radians([5.0, 15.0])[:, None], np.radians([[0.0, 2.0, 4.0]])
    cells = track_cells.track_cells(posture, replace(BOWL, track=Track(climb, bank, 0.15, 0.025)))
    part, _, _ = track_cells.seated(posture, bowl(bank=15 * DEG, climb=4 * DEG))
    one = track.motion(part, bowl(bank=15 * DEG, climb=4 * DEG))
    assert cells["acceleration_x_m_s2"][1, 2] == pytest.approx(float(one.acceleration[0]), rel=1e-9)
    assert cells["wall_2_N"][1, 2] == pytest.approx(float(one.walls[1]), rel=1e-9)
    assert track_cells.TRACK_REGIMES[cells["regime"][1, 2]] == "slide"


def test_a_card_without_track_data_is_refused():
    card = replace(box_posture(), corners=None, printed={"floor": {}, "track": {}})
    with pytest.raises(FeederError) as fault:
        card_seat(card)
    assert str(fault.value) == (
        "part card, aspect A: the card has no wall_lever for this aspect in its track block"
        " - choose the aspect that its track block names, or give the part as a mesh"
    )
