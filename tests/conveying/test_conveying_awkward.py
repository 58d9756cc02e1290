"""A banked track beside a rough wall, its friction unlike each way: the answers, and what scales them."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
from conveying_reference import Reference

from feederscrew.bowl.record import Friction
from feederscrew.conveying import answer


def level(bowl, share=1.0):
    """The bowl without bank on the floor that holds as much: mu / cos(bank) + mu_wall tan(bank)."""
    mu, bank = bowl.friction, bowl.track.bank
    held = [
        float(share * (one / np.cos(bank) + mu.wall * np.tan(bank)))
        for one in (mu.static, mu.kinetic, mu.static_backward, mu.kinetic_backward)
    ]
    surfaces = Friction(held[0], held[1], mu.wall, held[2], held[3])
    return replace(bowl, friction=surfaces, track=replace(bowl.track, bank=0.0))


@pytest.mark.parametrize("stroke", [0.17, 0.21])
def test_floor_and_wall_told_apart_by_a_general_solver_carry_a_part_as_fast(stroke):
    bowl = awkward.bowl(f"drive.amplitude={stroke} mm", "track.bank=14 deg")
    mu, drive, track = bowl.friction, bowl.drive, bowl.track
    rate = 2.0 * np.pi * drive.frequency
    other = Reference(
        drive.amplitude * rate**2 / bowl.gravity, drive.vibration_angle, track.climb, mu.static, mu.kinetic,
        bank=track.bank, wall=mu.wall, back=(mu.static_backward, mu.kinetic_backward),
    )  # fmt: skip
    found = answer.answer(bowl)
    assert found.period == 1 and found.throw_number < 1.0 and found.fractions["backward"] > 0.02
    assert found.velocity == pytest.approx(other.velocity(9, 1) * drive.amplitude * rate, rel=1e-5)


def test_a_level_track_of_the_friction_of_both_carries_as_fast_at_any_share_of_it():
    bowl = awkward.bowl("track.bank=14 deg")
    own, nearby = answer.answer(bowl).velocity, answer.sensitivity(bowl)["friction"]
    assert own == pytest.approx(answer.answer(level(bowl)).velocity, rel=1e-9)
    assert nearby.less == pytest.approx(answer.answer(level(bowl, 0.9)).velocity, rel=1e-9)
    assert nearby.more == pytest.approx(answer.answer(level(bowl, 1.1)).velocity, rel=1e-9)
    assert nearby.less < 0.98 * own or nearby.less > 1.02 * own  # or the shares would not matter


def test_friction_is_scaled_in_all_its_places_and_nothing_else_is():
    bowl = awkward.bowl()
    other = answer.scaled(bowl, friction=0.5)
    found = (other.friction.static, other.friction.kinetic, *other.friction.backward, other.friction.wall)
    assert found == pytest.approx((0.25, 0.21, 0.31, 0.275, 0.135), rel=1e-12)
    assert replace(other, friction=bowl.friction) == bowl
