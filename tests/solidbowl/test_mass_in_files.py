"""Where a solid's mass lies, written to a bowl file and read back: the same springs."""

from types import SimpleNamespace

import numpy as np
import pytest
from test_solid import CHAINS, planned

from feederscrew import bowl as bowls
from feederscrew.bowl import schema
from feederscrew.designing import design
from feederscrew.errors import FeederError
from feederscrew.machine.drive_sizing import machine_for
from feederscrew.machine.sizing import Size
from feederscrew.machine.springs import analyse_springs, centred_mass, rocking
from feederscrew.output import designs
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.plan import SolidOptions


def sized(solid):
    return Size(0.3, {}, 0.02, 0.0, 0.0, 0.06, 0.05, 1.5, 0.05,
                mass=solid.mass, inertia=solid.inertia, unbalance=solid.unbalance)  # fmt: skip


@pytest.mark.parametrize("hand", ["right", "left"])
def test_a_solid_s_springs_are_the_same_when_its_bowl_file_is_read_back(hand):
    solid = body(planned(CHAINS["gap"], asked=SolidOptions(left=hand == "left", outlet_angle=0.8)))
    under = machine_for(bowls.read(None, ()), sized(solid), set())
    assert analyse_springs(under).effective_mass < centred_mass(under) * (1.0 - 1e-5)
    texts = [f"machine.{word}={text}" for word, text in design._machine(under)]
    again = bowls.read(None, (*texts, f"track.hand={hand}")).machine
    for name in ("moment", "upright", "products", "turns"):
        np.testing.assert_allclose(getattr(again.unbalance, name), getattr(under.unbalance, name), rtol=1e-5)
    assert analyse_springs(again).effective_mass == pytest.approx(
        analyse_springs(under).effective_mass, rel=1e-5
    )
    assert rocking(again, 0.15, 0.05).greatest == pytest.approx(rocking(under, 0.15, 0.05).greatest, rel=1e-6)
    lines = dict(designs._unbalance(under))
    assert list(lines) == list(schema.UNBALANCE_NAMES)
    assert lines["centre_z"] == f"{1e3 * (solid.centre[2] - solid.plan.underside):.9g} mm"
    assert lines["product_xy"] == f"{under.unbalance.products[2]:.9g} kg m2"


def test_what_a_file_says_of_the_mass_is_kept():
    solid = body(planned(CHAINS["gap"]))
    given = ("machine.centre_x=3 mm", "machine.inertia_x=0.05 kg m2", "machine.inertia_y=0.05 kg m2")
    bowl = bowls.read(None, given)
    assert bowl.machine.unbalance.moment == pytest.approx((0.018, 0.0, 0.0))
    assert machine_for(bowl, sized(solid), {"centre_x"}).unbalance == bowl.machine.unbalance
    assert machine_for(bowl, sized(solid), set()).unbalance == solid.unbalance


def test_a_balanced_machine_has_nothing_to_write():
    machine = bowls.read(None, ()).machine
    assert schema.unbalance_values(machine) == {} and list(designs._unbalance(machine)) == []
    assert schema.with_unbalance(
        {"bowl_mass": 2.0, **dict.fromkeys(schema.UNBALANCE_NAMES, 0.0)}, "left"
    ) == {"bowl_mass": 2.0}


@pytest.mark.parametrize(
    "given",
    [
        ("centre_x=90 mm", "inertia_x=0.05 kg m2", "inertia_y=0.05 kg m2"),  # 6 kg, 0.06 kg m2
        ("centre_y=5 mm",),
        ("inertia_x=0.2 kg m2", "inertia_y=0.05 kg m2"),
        ("inertia_x=0.05 kg m2", "inertia_y=0.05 kg m2", "product_xy=0.031 kg m2"),
        ("inertia_x=0.05 kg m2", "inertia_y=0.05 kg m2", "product_yz=-0.03 kg m2"),
    ],
)
def test_what_no_body_has_is_a_fault(given):
    with pytest.raises(FeederError) as fault:
        bowls.read(None, [f"machine.{one}" for one in given])
    assert str(fault.value) == (
        "machine.inertia_x: no body has such a centre of mass, moments and products of inertia - give all "
        "eight of one body, or leave them out"
    )


def test_a_tensor_is_judged_about_the_centre_of_mass(rng):
    """Points of mass are a body; with their centre further off than their spread allows they are none."""
    for _ in range(20):
        at, weights = rng.normal(scale=0.05, size=(7, 3)) + [0.01, -0.02, 0.06], rng.uniform(0.1, 1.0, 7)
        second = np.einsum("k,ki,kj->ij", weights, at, at)
        inertia = np.trace(second) - np.diag(second)
        centre = weights @ at / weights.sum()
        values = dict(
            zip(schema.UNBALANCE_NAMES, (*centre, *inertia[:2], second[1, 2], second[0, 2], second[0, 1]))
        )
        values |= {"bowl_mass": weights.sum(), "bowl_inertia": inertia[2]}
        found = schema.with_unbalance(values, "right")["unbalance"]
        np.testing.assert_allclose(found.moment, weights @ at)
        own = second - weights.sum() * np.outer(centre, centre)
        least = np.linalg.eigvalsh(own)[0]
        spare = SimpleNamespace(**values)
        off = {
            "bowl_mass": spare.bowl_mass,
            "centre_x": spare.centre_x + 3.0 * np.sqrt(own[0, 0] / spare.bowl_mass),
        }
        assert least > 0.0
        with pytest.raises(FeederError):
            schema.with_unbalance(values | off, "right")
