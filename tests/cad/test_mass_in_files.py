"""Where a solid's mass lies: in its springs, written to a bowl file and read back."""

from dataclasses import replace

import numpy as np
import pytest
from solids import built, sized

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl import schema
from feederscrew.cad.plan import SolidOptions
from feederscrew.designing import design
from feederscrew.machine.drive_sizing import machine_for
from feederscrew.machine.springs import analyse_springs, centred_mass, rocking
from feederscrew.output import designs

BOWL = bowls.read(None, ())


@pytest.mark.parametrize("left", [False, True])
def test_the_springs_know_where_its_mass_lies(left):
    """Against moments of points in the body; a left hand rocks as its mirror image does."""
    solid = built("gap", asked=SolidOptions(left=left))
    size = sized(solid)
    under = machine_for(BOWL, size, set())
    assert under.unbalance == solid.unbalance and under.unbalance.turns == (-1.0 if left else 1.0)
    corners = solid.vertices[solid.faces] - [0.0, 0.0, solid.plan.underside]
    weights = np.linalg.det(corners) / 6.0 * solid.plan.material.density  # of tetrahedra from there
    at = corners.sum(axis=1) / 4.0
    np.testing.assert_allclose(under.unbalance.moment, weights @ at, rtol=1e-9)
    second = np.einsum("t,tki,tkj->ij", weights, corners, corners)
    second = (second + np.einsum("t,ti,tj->ij", weights, 4.0 * at, 4.0 * at)) / 20.0
    products = [second[1, 2], second[0, 2], second[0, 1]]
    np.testing.assert_allclose(under.unbalance.products, products, rtol=1e-6)
    about = np.trace(second) - np.diag(second)
    np.testing.assert_allclose([*under.unbalance.upright, solid.inertia], about, rtol=1e-9)
    assert analyse_springs(under).effective_mass < centred_mass(under)
    heavier = machine_for(replace(BOWL, machine=replace(BOWL.machine, bowl_mass=9.0)), size, {"bowl_mass"})
    np.testing.assert_allclose(heavier.unbalance.moment, 9.0 / solid.mass * (weights @ at), rtol=1e-9)
    as_is, balanced = rocking(under, 0.15, 0.05), rocking(under, 0.15, 0.05, solid.weight)
    assert 1.001 < balanced.greatest < as_is.greatest < 1.02
    own = under.unbalance
    mirrored = replace(
        own, moment=tuple(np.multiply(own.moment, [1, -1, 1])),
        products=tuple(np.multiply(own.products, [-1, 1, -1])), turns=-own.turns,
    )  # fmt: skip
    other = rocking(replace(under, unbalance=mirrored), 0.15, 0.05)
    assert other.angle == pytest.approx(2.0 * np.pi - as_is.angle)
    assert other.greatest == pytest.approx(as_is.greatest, rel=1e-12)


@pytest.mark.parametrize("hand", ["right", "left"])
def test_a_solid_s_springs_are_the_same_when_its_bowl_file_is_read_back(hand):
    solid = built("gap", asked=SolidOptions(left=hand == "left", outlet_angle=0.8))
    under = machine_for(BOWL, sized(solid), set())
    assert analyse_springs(under).effective_mass < centred_mass(under) * (1.0 - 1e-5)
    texts = [f"machine.{word}={text}" for word, text in design._machine(under)]
    copy = bowls.read(None, (*texts, f"track.hand={hand}")).machine
    for name in ("moment", "upright", "products", "turns"):
        np.testing.assert_allclose(getattr(copy.unbalance, name), getattr(under.unbalance, name), rtol=1e-5)
    masses = [analyse_springs(one).effective_mass for one in (copy, under)]
    assert masses[0] == pytest.approx(masses[1], rel=1e-5)
    assert rocking(copy, 0.15, 0.05).greatest == pytest.approx(rocking(under, 0.15, 0.05).greatest, rel=1e-6)
    lines = designs.unbalance_texts(under)
    assert list(lines) == list(schema.UNBALANCE_NAMES)
    assert lines["centre_z"] == f"{1e3 * (solid.centre[2] - solid.plan.underside):.9g} mm"
    assert lines["product_xy"] == f"{under.unbalance.products[2]:.9g} kg m2"


def test_what_a_file_says_of_the_mass_is_kept_and_a_balanced_machine_has_nothing_to_write():
    size = sized(built("gap"))
    own = ("machine.centre_x=3 mm", "machine.inertia_x=0.05 kg m2", "machine.inertia_y=0.05 kg m2")
    bowl = bowls.read(None, own)
    assert bowl.machine.unbalance.moment == pytest.approx((0.018, 0.0, 0.0))
    assert machine_for(bowl, size, {"centre_x"}).unbalance == bowl.machine.unbalance
    assert machine_for(bowl, size, set()).unbalance == size.unbalance
    assert schema.unbalance_values(BOWL.machine) == {} and designs.unbalance_texts(BOWL.machine) == {}
    zeros = {"bowl_mass": 2.0, **dict.fromkeys(schema.UNBALANCE_NAMES, 0.0)}
    assert schema.with_unbalance(zeros, "left") == {"bowl_mass": 2.0}


@pytest.mark.parametrize(
    "values",
    [
        ("centre_x=90 mm", "inertia_x=0.05 kg m2", "inertia_y=0.05 kg m2"),  # 6 kg, 0.06 kg m2
        ("centre_y=5 mm",),
        ("inertia_x=0.2 kg m2", "inertia_y=0.05 kg m2"),
        ("inertia_x=0.05 kg m2", "inertia_y=0.05 kg m2", "product_xy=0.031 kg m2"),
        ("inertia_x=0.05 kg m2", "inertia_y=0.05 kg m2", "product_yz=-0.03 kg m2"),
    ],
)
def test_what_no_body_has_is_a_fault(values):
    with pytest.raises(FeederError) as fault:
        bowls.read(None, [f"machine.{one}" for one in values])
    line = "machine.inertia_x: no body has such a centre of mass, moments and products of inertia - give all "
    assert str(fault.value) == f"{line}eight of one body, or leave them out"


def test_a_tensor_is_judged_about_the_centre_of_mass(rng):
    """Points of mass are a body; with their centre further off than their spread allows they are none."""
    for _ in range(20):
        at, weights = rng.normal(scale=0.05, size=(7, 3)) + [0.01, -0.02, 0.06], rng.uniform(0.1, 1.0, 7)
        total = weights.sum()
        second, centre = np.einsum("k,ki,kj->ij", weights, at, at), weights @ at / total
        inertia, products = np.trace(second) - np.diag(second), (second[1, 2], second[0, 2], second[0, 1])
        values = dict(zip(schema.UNBALANCE_NAMES, (*centre, *inertia[:2], *products)))
        values |= {"bowl_mass": total, "bowl_inertia": inertia[2]}
        unbalance = schema.with_unbalance(values, "right")["unbalance"]
        np.testing.assert_allclose(unbalance.moment, weights @ at)
        own = second - total * np.outer(centre, centre)
        off = values["centre_x"] + 3.0 * np.sqrt(own[0, 0] / total)
        with pytest.raises(FeederError):
            schema.with_unbalance(values | {"centre_x": off}, "right")
