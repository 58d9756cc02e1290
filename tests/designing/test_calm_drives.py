"""Drives below the throw number of 1, against what friction does to each."""

from dataclasses import replace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.designing import calm_drive
from feederscrew.dropping.plate.drive import throw_number
from feederscrew.machine.stroke import greatest_amplitude


def plain(*given):
    return calm_drive.PlainBowl(bowls.default(), frozenset(given), None)


@pytest.mark.parametrize("velocity", (0.0, 0.06, 0.1, 0.14))
def test_a_drive_through_tooling_is_calm_and_fast_enough_at_any_friction(velocity):
    made = calm_drive.driven(plain(), velocity)
    asked = max(velocity, calm_drive.LEAST)
    assert throw_number(made) <= calm_drive.CALM + 1e-3
    assert made.drive.amplitude <= greatest_amplitude(made)
    assert calm_drive.speed(made) >= asked > calm_drive.speed(weaker(made))
    assert calm_drive.slowest(made) >= calm_drive.STEADY * asked


def weaker(bowl):
    """The bowl at 0.95 of its stroke."""
    return replace(bowl, drive=replace(bowl.drive, amplitude=0.95 * bowl.drive.amplitude))


def test_out_of_phase_friction_hardly_matters_and_in_phase_it_does():
    made = calm_drive.driven(plain(), 0.08)
    assert np.degrees(made.drive.phase) == pytest.approx(-60.0)
    straight = replace(made, drive=replace(made.drive, phase=0.0))
    assert calm_drive.slowest(made) > 0.8 * calm_drive.speed(made)
    assert calm_drive.slowest(straight) < 0.3 * calm_drive.speed(straight)


def test_what_the_user_says_of_the_drive_is_kept():
    bowl = bowls.default()
    assert calm_drive.driven(plain("drive.amplitude"), 0.2) == bowl
    made = calm_drive.driven(plain("drive.phase", "drive.frequency"), 0.2)
    assert (made.drive.phase, made.drive.frequency) == (bowl.drive.phase, bowl.drive.frequency)
    assert calm_drive.driven(plain(), 9.0).drive.frequency == 30.0  # none is so fast: the fastest


def test_without_tooling_the_simplest_drive_may_hop():
    calm, hops = (calm_drive.driven(plain(), v, hops=True) for v in (0.01, 0.05))
    assert calm.drive.phase == hops.drive.phase == 0.0
    assert throw_number(calm) < 1.0 < throw_number(hops)


def test_where_nothing_has_to_be_met_lying_a_drive_out_of_phase_may_hop_too():
    calm, lively = (calm_drive.driven(plain(), 0.18, hops=hops) for hops in (False, True))
    assert calm_drive.speed(calm) < 0.16 and calm_drive.speed(lively) >= 0.18
    assert throw_number(calm) < 1.0 < throw_number(lively) <= max(calm_drive.LIVELY) + 1e-3


def test_friction_is_scaled_in_every_place():
    bowl = bowls.default()
    rubbed = calm_drive.rubbed(bowl, 0.5).friction
    assert rubbed.static == 0.5 * bowl.friction.static and rubbed.wall == 0.5 * bowl.friction.wall
    assert rubbed.kinetic == 0.5 * bowl.friction.kinetic
