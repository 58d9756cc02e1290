"""Static equilibrium with friction in any direction, and the wall's contact angle on a climb with a bank."""

import math

import numpy as np
import pytest
from mechanics_samples import DEG, bowl, box_posture, random_bowl, random_seat, rectangle

from feederscrew.mechanics import floor_balance as floor
from feederscrew.mechanics import track_balance, track_contacts
from feederscrew.mechanics.track_balance import card_seat, frame, seat


def at_rest(static, climb=0.0, wall=0.0, bank=0.0):
    settings = bowl(
        amplitude=0.0, static=static, kinetic=static, wall=wall, climb=climb, bank=bank, radius=1e6
    )
    return seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 1.0 if bank else 0.0), settings


@pytest.mark.parametrize("climb", [3 * DEG, 20 * DEG])
def test_a_smooth_wall_leaves_the_angle_of_friction(climb):
    """Both sides of mu = tan(climb), within what the pyramid leaves of the cone."""
    for share, held in ((1.002, True), (0.998, False)):
        assert track_contacts.exists(*at_rest(math.tan(climb) * share, climb)) is held


def test_friction_across_the_track_wedges_the_part_against_a_rough_wall():
    """Pushing to the wall costs some of the friction of the floor and earns the wall's, and more."""
    climb = 20 * DEG
    gain = math.sqrt(1.0 + 0.5**2)
    for share, held in ((1.005, True), (0.9, False)):
        part, settings = at_rest(math.tan(climb) / gain * share, climb, wall=0.5)
        assert track_contacts.exists(part, settings) is held
        assert track_balance.motion(part, settings).state == floor.SLIDE


def test_a_part_that_tips_has_no_equilibrium():
    settings = bowl(amplitude=0.0, static=5.0, kinetic=5.0, wall=0.0, climb=40 * DEG, bank=0.0, radius=1e6)
    tall = box_posture(length=0.006, height=0.02)
    assert not track_contacts.exists(seat(tall, 0.0, rectangle(0.006, 0.01)[:2], 0.0), settings)
    assert track_contacts.exists(seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 0.0), settings)


def test_what_the_least_friction_holds_is_an_equilibrium():
    """Random parts are taken until five of them stick."""
    held = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        part, settings = random_seat(rng), random_bowl(rng)
        if track_balance.motion(part, settings).state == floor.STICK:
            held.append(track_contacts.exists(part, settings))
        if len(held) == 5:
            break
    assert held == [True] * 5


def test_of_a_card_without_contact_polygon_it_cannot_be_told():
    told = {"track": {"wall_lever": 8e-3, "wall_lever_angle": 64 * DEG, "wall_x": (7e-3, 9e-3)}}
    card = seat(box_posture(), 0.0, rectangle(0.03, 0.01)[:2], 0.0)
    posture = box_posture()
    posture = type(posture)(**{**vars(posture), "printed": told, "contact": np.zeros((0, 2))})
    assert track_contacts.exists(card, bowl(amplitude=0.0))
    assert not track_contacts.exists(card_seat(posture), bowl(amplitude=0.0))


@pytest.mark.parametrize(
    ("climb", "bank"), [(0.0, 0.0), (5 * DEG, 0.0), (5 * DEG, 20 * DEG), (-8 * DEG, 40 * DEG)]
)
def test_wall_normals_pass_through_the_axis_of_the_bowl(climb, bank):
    """Seen level, each normal leads over the wall's radius to the axis, which lies inward of the centre."""
    part = random_seat(np.random.default_rng(2))
    axes = frame(bowl(climb=climb, bank=bank, radius=0.05), part.walls)
    ahead = np.cross(axes.radial, axes.up)  # level
    at_axis = part.walls + 0.05 * axes.normals
    np.testing.assert_allclose(at_axis @ ahead, 0.0, atol=1e-15)
    np.testing.assert_allclose(axes.normals @ axes.up, 0.0, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(axes.normals, axis=1), 1.0, rtol=1e-12)
