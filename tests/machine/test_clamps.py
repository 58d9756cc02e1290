"""Leaf springs between rigid clamps, against a frame of beam elements that is moved in a screw."""

from dataclasses import replace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.machine.springs import analyse_springs, in_plane, leaf_stiffness, twist

SET = (
    "machine.bowl_mass=6 kg", "machine.bowl_inertia=0.06 kg m2", "machine.base_mass=25 kg",
    "machine.base_inertia=0.25 kg m2", "machine.spring_radius=90 mm", "machine.spring_angle=20 deg",
    "machine.leaf_width=40 mm", "machine.leaf_thickness=2.5 mm", "machine.leaf_length=80 mm",
    "machine.leaves=10",
)  # fmt: skip
MACHINE = bowls.read(None, SET).machine
POISSON, SHEAR = 0.3, 5.0 / 6.0


def element(machine):
    """Stiffness (12, 12) of Timoshenko's beam: along x, its width along y, its thickness along z."""
    b, t, long, e = machine.leaf_width, machine.leaf_thickness, machine.leaf_length, machine.leaf_modulus
    g, area, whole = e / (2.0 * (1.0 + POISSON)), b * t, np.zeros((12, 12))

    def bending(moment, sign):
        phi = 12.0 * e * moment / (SHEAR * g * area * long**2)
        a, near, far = sign * 6.0 * long, (4.0 + phi) * long**2, (2.0 - phi) * long**2
        rows = [[12.0, a, -12.0, a], [a, near, -a, far], [-12.0, -a, 12.0, -a], [a, far, -a, near]]
        return e * moment / (long**3 * (1.0 + phi)) * np.array(rows)

    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    blocks = (
        ([0, 6], e * area / long * pair),
        ([3, 9], g * b * t**3 / (3.0 * long) * pair),
        ([1, 5, 7, 11], bending(t * b**3 / 12.0, 1.0)),
        ([2, 4, 8, 10], bending(b * t**3 / 12.0, -1.0)),
    )
    for places, block in blocks:
        whole[np.ix_(places, places)] += block
    return whole


def stiffness(machine, offset):
    """Of one leaf whose lower clamp is held while the upper one moves along the springs [N/m]."""
    psi, radius, half = machine.spring_angle, machine.spring_radius, 0.5 * machine.leaf_length
    along, outward = np.array([0.0, -np.sin(psi), np.cos(psi)]), np.array([1.0, 0.0, 0.0])
    axes = np.array([along, outward, np.cross(along, outward)])
    turn = np.array([0.0, 0.0, np.cos(psi) / radius])
    top = radius * outward + (offset + half) * along
    moved = np.cross(turn, top) + np.array([0.0, 0.0, np.sin(psi)])
    way = np.concatenate([np.zeros(6), axes @ moved, axes @ turn])
    return way @ element(machine) @ way


@pytest.mark.parametrize("psi, thick", [(10.0, 2.5), (20.0, 2.5), (30.0, 2.5), (20.0, 1.0), (45.0, 1.5)])
@pytest.mark.parametrize("at_an_end", [0.0, 1.0, -1.0])
def test_rigid_clamps_bend_a_leaf_in_its_own_plane(psi, thick, at_an_end):
    """The frame twists by the turn's component along the leaf alone: up to a few per mille less."""
    one = replace(MACHINE, spring_angle=np.radians(psi), leaf_thickness=1e-3 * thick)
    offset = 0.5 * at_an_end * one.leaf_length
    closed = leaf_stiffness(one) * (twist(one) + in_plane(one, offset))
    assert np.sqrt(closed / stiffness(one, offset)) == pytest.approx(1.0, abs=4e-3)


def test_rigid_clamps_make_the_frequency_more_than_a_few_per_cent_higher():
    """Leaf 40 x 2.5 x 80 mm at 20 deg: 1.68 times where its middle is nearest to the axis, 2.40 at an end."""
    found = analyse_springs(MACHINE)
    plain = found.natural_frequency_without_twist
    assert found.natural_frequency_rigid / plain == pytest.approx(1.68, abs=0.01)
    assert found.natural_frequency_rigid_end / plain == pytest.approx(2.40, abs=0.01)
    assert found.natural_frequency / plain == pytest.approx(1.044, abs=0.001)
