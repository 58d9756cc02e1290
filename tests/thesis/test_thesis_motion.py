"""The thesis's printed equations against the sum of wrenches, and the slips in print, each by its size."""

from pathlib import Path

import numpy as np
import pytest
from mechanics_samples import DEG, bowl, box_posture, rectangle

from feederscrew.motion import floor_balance
from feederscrew.motion import track_balance as track
from feederscrew.motion.screws import Wrench
from feederscrew.motion.track_balance import frame, seat
from feederscrew.output import floor as floor_output
from feederscrew.output import track as track_output
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.posture import posture
from feederscrew.thesis.motion import (
    FLOOR_TERMS,
    TRACK_TERMS,
    Levers,
    half_angle,
    levers_of,
    omitted_terms,
    solve_floor,
    solve_track,
)

PARTS = Path(__file__).parents[2] / "parts"
ASPECTS = {"arc_chute": "5", "magnet": "3"}


@pytest.fixture(params=sorted(ASPECTS))
def printed_card(request):
    """Posture of a card on the aspect that chapter 4 analyses."""
    part = load(PARTS / f"{request.param}.yaml")
    return request.param, posture(part, find(part), ASPECTS[request.param])


def at(point, force):
    return Wrench(np.array(force), np.cross(point, force))


def floor_wrench(h, e, d, push, weight, normal, friction, beta, turn):
    """Sum over the printed levers, in the thesis's body axes: X up, Z' ahead, Y' from Z' on by theta."""
    drive = push * np.array([np.sin(beta), np.cos(beta) * np.sin(turn), np.cos(beta) * np.cos(turn)])
    held = at([-h, 0, d], [normal, 0, 0]) + at([-h, 0, 0], [0, -friction[0], -friction[1]])
    return at([-h, 0, e], drive) + held + at([0, 0, 0], [-weight, 0, 0])


def printed_floor_dual(h, e, d, push, normal, friction, beta, alpha, theta):
    """Dual part of [4.13] and [4.43], the sign of R_y as in [4.19] and [4.43]."""
    fixed = e * push * np.sin(beta) + h * push * np.cos(beta) * np.cos(alpha)
    about_x = -e * push * np.cos(beta) * np.sin(alpha - theta)
    about_y = -h * friction[1] + d * normal + np.cos(theta) * fixed
    return np.array([about_x, about_y, h * friction[0] - np.sin(theta) * fixed])


def test_wrench_of_the_floor_4_13_and_4_43(printed_card):
    """Eqs. [4.13], [4.43]: every component but Y' and Z' of the moment; these for a part that is aligned.
    They are eqs. [4.18], [4.19], eqs. [4.48], [4.49]."""
    _, card = printed_card
    rng = np.random.default_rng(0)
    h, e, d = card.height, card.offset, rng.normal()
    push, weight, normal = rng.uniform(0.5, 2, 3)
    friction, beta, (alpha, theta) = rng.normal(size=2), rng.uniform(0, 1), rng.uniform(-1, 1, 2)
    total = floor_wrench(h, e, d, push, weight, normal, friction, beta, alpha - theta)
    across, along = push * np.cos(beta) * np.array([np.sin(alpha - theta), np.cos(alpha - theta)])
    real = [push * np.sin(beta) + normal - weight, across - friction[0], along - friction[1]]
    np.testing.assert_allclose(total.resultant, real, rtol=0, atol=1e-14)
    printed = printed_floor_dual(h, e, d, push, normal, friction, beta, alpha, theta)
    assert total.moment[0] == pytest.approx(printed[0])
    aligned = floor_wrench(h, e, d, push, weight, normal, friction, beta, 0.0)
    want = printed_floor_dual(h, e, d, push, normal, friction, beta, 0.0, 0.0)
    np.testing.assert_allclose(aligned.moment, want, rtol=1e-12, atol=1e-14)


def test_erratum_floor_moment_is_projected_on_fixed_axes(printed_card):
    """Eqs. [4.13], [4.43]: factors cos(theta), sin(theta) stand where the body axes have alpha - theta."""
    _, card = printed_card
    h, e, push, beta, alpha, theta = card.height, card.offset, 1.3, 0.4, 0.5, 0.2
    total = floor_wrench(h, e, 0.0, push, 0.0, 0.0, [0.0, 0.0], beta, alpha - theta).moment
    printed = printed_floor_dual(h, e, 0.0, push, 0.0, [0.0, 0.0], beta, alpha, theta)
    level, lift = push * np.cos(beta), push * np.sin(beta)
    about_y = e * lift * (np.cos(theta) - 1) - h * level * np.sin(alpha) * np.sin(theta)
    about_z = -e * lift * np.sin(theta) + h * level * (np.sin(alpha - theta) - np.sin(theta) * np.cos(alpha))
    assert printed - total == pytest.approx([0.0, about_y, about_z], abs=1e-15)
    assert np.abs(printed - total)[1:].min() > 1e-5


PUSH = 0.05e-3 * (2 * np.pi * 60) ** 2  # [m/s2] of the sample drive, at 20 deg


def test_published_floor_on_the_card(printed_card):
    """By hand, of the Arc Chute: eqs. [4.14] to [4.18], eqs. [4.20] to [4.23], eqs. [4.25] to [4.27]. Of the
    Magnet: eqs. [4.44] to [4.48], eqs. [4.50] to [4.53]."""
    _, card = printed_card
    printed = solve_floor(card, bowl(direction=10 * DEG), 4 * DEG)
    normal = 9.81 - PUSH * np.sin(20 * DEG)
    across, ahead = (PUSH * np.cos(20 * DEG) * f(6 * DEG) for f in (np.sin, np.cos))
    assert printed.normal_force == pytest.approx(card.mass * normal)
    assert printed.turning == pytest.approx(card.offset * card.mass * across / card.turning_inertia)
    assert printed.limiting_friction == pytest.approx(ahead / normal)
    assert printed.acceleration == pytest.approx([ahead - 0.3 * normal, across])
    moment = card.offset * PUSH * np.sin(20 * DEG) + card.height * PUSH * np.cos(20 * DEG) * np.cos(10 * DEG)
    assert printed.offset == pytest.approx((card.height * 0.3 * normal - np.cos(4 * DEG) * moment) / normal)
    # An aligned print and the complete motion agree but for the line of action.
    solvers = solve_floor, floor_balance.motion
    printed, complete = (solve(card, bowl(direction=10 * DEG), 10 * DEG) for solve in solvers)
    for name in ("normal_force", "turning", "limiting_friction", "acceleration"):
        np.testing.assert_allclose(getattr(printed, name), getattr(complete, name), rtol=1e-12, atol=1e-12)
    raised, turn = card.offset * np.sin(20 * DEG), np.cos(10 * DEG)
    gap, ratio = raised + card.height * np.cos(20 * DEG) * turn * turn, PUSH / 9.81
    # the print's cos(theta) multiplies both terms
    want = ((1 - turn) * raised - gap) * ratio / (1 - ratio * np.sin(20 * DEG))
    assert printed.offset - complete.offset[0] == pytest.approx(want, rel=1e-9)


def levers_of_card(name, card):
    """The card's printed levers."""
    track = card.printed["track"]
    behind, ahead = track["wall_x"]
    return Levers(
        card.mass, card.height, card.offset, track["wall_lever"], track["wall_lever_angle"],
        behind, ahead, track["wall_y"], track["wall_friction_y"], track["axes"],
    )  # fmt: skip


def banked(vector, delta):
    """Level components (X, across, up) as components along tilted axes."""
    x, y, z = vector
    c, s = np.cos(delta), np.sin(delta)
    return np.array([x, y * c + z * s, z * c - y * s])


def summed(lever, settings, heading, x):
    """Sum over the printed contact points of a printed solution, in the tilted axes. The print's axes are
    left-handed, ahead, from the wall, up: its moments are minus r x F."""
    h, e, delta, phi = lever.height, lever.offset, settings.track.bank, settings.track.climb
    sigma, weight = half_angle(lever, settings.track.radius), lever.mass * 9.81
    raised, turn = lever.wall * np.sin(lever.wall_angle - delta), settings.drive.direction - heading
    level_push = np.cos(20 * DEG) * np.array([np.cos(turn), np.sin(turn)])
    drive = lever.mass * PUSH * np.array([*level_push, np.sin(20 * DEG)])
    level = at([e, 0, -h], drive)
    for sign, place, reaction in ((1, -lever.behind, x.walls[0]), (-1, lever.ahead, x.walls[1])):
        normal = reaction * np.array([sign * np.sin(sigma), np.cos(sigma), 0.0])
        dragged = np.array([-settings.friction.wall * reaction, 0.0, 0.0])
        level = level + at([place, -lever.side, raised], normal)
        level = level + at([place, -lever.friction_side, raised], dragged)
    tilted = at([x.offset, 0, -h], [0, 0, x.normal_force])
    tilted = tilted + at([0, 0, -h], [-x.traction, x.radial_friction, 0])
    tilted = tilted + at([0, 0, 0], banked([-weight * np.sin(phi), 0, -weight * np.cos(phi)], delta))
    force = banked(level.resultant, delta) + tilted.resultant
    return force, -(banked(level.moment, delta) + tilted.moment), (drive, raised)


@pytest.mark.parametrize("delta", [0.0, 0.2, 0.5])
def test_track_equations_follow_from_the_wrench_sum_but_for_three_slips(printed_card, delta):
    """Eqs. [4.32] to [4.37], eqs. [4.57] to [4.62], of the wrenches of eqs. [4.29], [4.54]. Left over are
    radial gravity, the drive about X, wall friction."""
    name, card = printed_card
    lever = levers_of_card(name, card)
    settings = bowl(bank=delta, direction=15 * DEG, wall=0.2)
    x = solve_track(lever, settings, 5 * DEG)
    assert x.slides
    assert x.traction == pytest.approx(0.3 * x.normal_force)
    force, moment, (drive, raised) = summed(lever, settings, 5 * DEG, x)
    radial = -lever.mass * 9.81 * np.cos(3 * DEG) * np.sin(delta) if lever.axes == "tilted" else 0.0
    rate = np.array([lever.mass * float(x.acceleration), radial, 0.0])
    size = lever.mass * 9.81
    np.testing.assert_allclose(force, rate, rtol=0, atol=1e-12 * size)
    dragged = 0.2 * x.walls.sum()
    slips = banked([-lever.height * drive[1], raised * dragged, 0.0], delta)
    np.testing.assert_allclose(moment, slips, rtol=0, atol=1e-12 * size * 0.03)
    assert abs(drive[1] * lever.height) > 1e-3 * size * lever.height


def test_erratum_4_33_leaves_out_radial_gravity():
    """Eq. [4.33]. With it, a banked part without drive presses on the wall; as printed it does not."""
    part = seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 1.0)
    settings = bowl(amplitude=0.0, bank=20 * DEG, climb=0.0, static=0.0, kinetic=0.0, wall=0.0)
    printed = solve_track(levers_of(part, 0.0), settings, 0.0)
    complete = track.motion(part, settings)
    assert printed.walls == pytest.approx([0.0, 0.0], abs=1e-15)
    assert complete.walls.sum() == pytest.approx(0.01 * 9.81 * np.tan(20 * DEG) / np.cos(np.arcsin(0.1)))
    # Omitted terms by hand.
    settings = bowl()
    complete = track.motion(part, settings)
    terms = {t.name: t.value for t in omitted_terms(part, settings, complete, 1e-3)}
    weight, push, speed = 0.01 * 9.81, 0.01 * PUSH, 0.05e-3 * 2 * np.pi * 60 * np.cos(20 * DEG)
    lifted = push * np.sin(20 * DEG) * np.cos(10 * DEG)
    courses = frame(settings, part.walls).courses[:, 1]  # friction drags against them
    by_hand = {
        "radial gravity, -m g cos(phi) sin(delta)": -weight * np.cos(3 * DEG) * np.sin(10 * DEG),
        "centripetal force at mid-stroke": 0.01 * speed**2 / 0.15,
        "drive at the contact plane, about Y": 1e3 * (0.0025 * push * np.cos(20 * DEG) + 1e-3 * lifted),
    }
    assert {name: terms[name] for name in by_hand} == pytest.approx(by_hand)
    assert terms["moment of the drive about X"] == pytest.approx(0.0, abs=1e-12)
    dragged = complete.wall_friction @ -courses
    assert terms["wall friction turned by sigma, along Y"] == pytest.approx(dragged, rel=0.1)  # unbanked


@pytest.mark.parametrize(("name", "bank"), [("arc_chute", 64.22), ("magnet", 57.12)])
def test_no_radial_friction_at_the_printed_bank(name, bank):
    part = load(PARTS / f"{name}.yaml")
    lever = levers_of_card(name, posture(part, find(part), ASPECTS[name]))
    printed = solve_track(lever, bowl(bank=bank * DEG), 0.0)
    assert abs(printed.radial_friction) < 1e-12 * lever.mass * 9.81


def test_every_contract_quantity_names_its_term():
    extra = {"stable_heading_deg", "friction_N", "greatest_friction_N", "normal_line_offset_y_mm", "tips"}
    assert set(floor_output.FLOOR_LABELS) - extra == set(FLOOR_TERMS)
    extra = {"normal_line_offset_y_mm", "acceleration_y_m_s2", "turning_rad_s2", "tips"}
    assert set(track_output.TRACK_LABELS) - extra == set(TRACK_TERMS)
