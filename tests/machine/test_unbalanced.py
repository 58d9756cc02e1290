"""A bowl whose mass lies to a side: against clouds of points whose energy is least, and against symmetry."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Unbalance
from feederscrew.errors import FeederError
from feederscrew.machine import sizing
from feederscrew.machine.springs import (
    BASE_DENSITY,
    analyse_springs,
    centred_mass,
    held_fast,
    is_even,
    rocking,
    unbalanced_effective_mass,
)

MACHINE = bowls.read(None, ("machine.base_mass=20 kg", "machine.base_inertia=0.3 kg m2")).machine


def cloud(rng, turns=1.0):
    """Points of a lopsided bowl [m] with their masses [kg], and the machine that knows them."""
    at = rng.uniform(-0.15, 0.15, (40, 3)) + [0.02, -0.03, 0.15]
    kg = rng.uniform(0.05, 0.25, 40)
    x, y, z = at.T
    known = Unbalance(
        moment=tuple((kg[:, None] * at).sum(axis=0)),
        upright=(float((kg * (y**2 + z**2)).sum()), float((kg * (x**2 + z**2)).sum())),
        products=(float((kg * y * z).sum()), float((kg * x * z).sum()), float((kg * x * y).sum())),
        turns=turns,
    )
    inertia = float((kg * (x**2 + y**2)).sum())
    return at, kg, replace(MACHINE, bowl_mass=kg.sum(), bowl_inertia=inertia, unbalance=known)


def base(machine):
    """Points of the base: eight of a round plate of steel, that has its inertia about every axis."""
    mass, inertia = machine.base_mass, machine.base_inertia
    thick = mass / (BASE_DENSITY * np.pi * 2.0 * inertia / mass)
    low = -machine.leaf_length * np.cos(machine.spring_angle) - 0.5 * thick
    r, h = np.sqrt(inertia / mass), thick / np.sqrt(12.0)
    theta = 0.5 * np.pi * np.arange(4)
    ring = np.column_stack([r * np.cos(theta), r * np.sin(theta), np.zeros(4)])
    return np.concatenate([ring + [0, 0, low - h], ring + [0, 0, low + h]]), np.full(8, mass / 8.0)


def least_energy(machine, at, kg):
    """Motion of the bowl (6,) and energy [J] of both bodies where that is least, at 1 m/s between them."""
    along = np.array([0.0, 0.0, np.sin(machine.spring_angle)])
    spin = np.array(
        [0.0, 0.0, machine.unbalance.turns * np.cos(machine.spring_angle) / machine.spring_radius]
    )
    feet, weights = base(machine)

    def energy(base_moves):
        v, w = base_moves[:3], base_moves[3:]
        below = v + np.cross(w, feet)
        above = v + along + np.cross(w + spin, at)
        return 0.5 * (weights[:, None] * below**2).sum() + 0.5 * (kg[:, None] * above**2).sum()

    found = minimize(energy, np.zeros(6), method="BFGS", options={"gtol": 1e-12, "maxiter": 500})
    return np.concatenate([found.x[:3] + along, found.x[3:] + spin]), found.fun


@pytest.mark.filterwarnings("ignore:.*precision loss")
@pytest.mark.parametrize("turns", [1.0, -1.0])
def test_the_motion_of_least_energy(turns, rng):
    at, kg, machine = cloud(rng, turns)
    motion, energy = least_energy(machine, at, kg)
    assert unbalanced_effective_mass(machine) == pytest.approx(2.0 * energy, rel=1e-8)
    found = rocking(machine, 0.15, 0.08)
    theta = 2.0 * np.pi * np.arange(3600) / 3600
    ring = np.column_stack([0.15 * np.cos(theta), 0.15 * np.sin(theta), np.full(3600, 0.08)])
    strokes = np.sqrt(((motion[:3] + np.cross(motion[3:], ring)) ** 2).sum(axis=1))
    strokes /= np.sqrt((strokes**2).mean())
    assert found.greatest == pytest.approx(strokes.max(), rel=1e-4)
    assert found.least == pytest.approx(strokes.min(), rel=1e-4)
    assert found.greatest > 1.05  # it is a bad one
    assert abs((found.angle - theta[strokes.argmax()] + np.pi) % (2 * np.pi) - np.pi) < 0.02


def test_a_weight_is_a_point_more_of_the_cloud(rng):
    at, kg, machine = cloud(rng)
    weight = 0.4, (-0.1, 0.12, 0.05)
    both = np.concatenate([at, [weight[1]]]), np.append(kg, weight[0])
    _, energy = least_energy(machine, *both)
    found = rocking(machine, 0.15, 0.08, weight)
    assert found.effective_mass == pytest.approx(2.0 * energy, rel=1e-8)


def test_an_even_bowl_is_that_of_the_closed_form():
    even = replace(MACHINE, unbalance=Unbalance((0.0, 0.0, 0.3), (0.05, 0.05)))
    assert is_even(even) and analyse_springs(even) == analyse_springs(MACHINE)
    assert unbalanced_effective_mass(even) == pytest.approx(centred_mass(even), rel=1e-12)
    found = rocking(even, 0.1, 0.05)
    assert (found.least, found.greatest) == pytest.approx((1.0, 1.0), abs=1e-12)


def test_off_its_axis_it_moves_less_mass_and_on_a_held_base_as_much(rng):
    """On a base that is held, a screw is all that is left: the place of the mass is in the inertia."""
    _, _, machine = cloud(rng)
    found = analyse_springs(machine)
    assert found.effective_mass < centred_mass(machine)
    assert found.effective_mass_held == pytest.approx(centred_mass(held_fast(machine)), rel=1e-12)
    higher = analyse_springs(replace(machine, unbalance=Unbalance()))
    assert found.natural_frequency > higher.natural_frequency


def test_the_weight_of_a_solid_steadies_it(rng):
    _, kg, machine = cloud(rng)
    x, y, z = machine.unbalance.moment
    off, there = np.hypot(x, y), np.arctan2(-y, -x)
    weight = off / 0.2, (0.2 * np.cos(there), 0.2 * np.sin(there), z / kg.sum())
    as_is, balanced = rocking(machine, 0.15, 0.08), rocking(machine, 0.15, 0.08, weight)
    assert balanced.greatest - balanced.least < 0.5 * (as_is.greatest - as_is.least)


def test_a_fill_lies_evenly(rng):
    _, _, machine = cloud(rng)
    full = sizing.loaded_bowl(machine, sizing.Fill(1e-3, 2.0, 0.02), 0.5)
    assert full.unbalance.moment == machine.unbalance.moment
    gained = np.subtract(full.unbalance.upright, machine.unbalance.upright)
    assert gained == pytest.approx([0.005, 0.005])


def test_an_inertia_that_cannot_be(rng):
    _, _, machine = cloud(rng)
    with pytest.raises(FeederError, match=r"^machine.bowl_inertia: 0.0001 kg m2 is less than"):
        unbalanced_effective_mass(replace(machine, bowl_inertia=1e-4))
