"""Every line of what checking the thesis showed."""

import re

import numpy as np
import pytest
import yaml
from published_cells import cell

from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.counts.deviation import deviation
from feederscrew.thesis import evidence, motion_evidence, parts
from feederscrew.thesis.findings import BY_ID, FINDINGS
from feederscrew.thesis.printed_tables import table


@pytest.mark.parametrize("finding", FINDINGS, ids=lambda finding: finding.id)
def test_a_finding_says_what_and_shows_it(finding):
    assert BY_ID[finding.id] is finding
    assert finding.where and finding.what.endswith(".")
    assert finding.shown.endswith(".")
    assert not re.search(r"nan|\{|\binf\b", finding.shown)


def test_santos_heights_are_not_the_thesis_heights():
    ratios = table("3-2").numbers("h") / table("3-10").numbers("h")
    assert (round(ratios.min(), 2), round(ratios.max(), 2)) == (1.48, 1.64)
    assert len(set(table("3-2").numbers("h")[1:4])) == 1
    np.testing.assert_array_equal(table("3-2").numbers("h"), table("3-3").numbers("h"))


def test_h_total_is_one_number_that_print_does_not_state():
    implied = table("3-2").numbers("h") * table("3-2").numbers("h_total_over_h")
    np.testing.assert_allclose(implied, 11.2894, rtol=0, atol=5e-5)


def test_q_is_no_solid_angle_in_steradians():
    assert evidence.q_unit()["arc_chute"] > 4.0 * np.pi
    assert evidence.q_unit()["magnet"] > 4.0 * np.pi


def test_the_total_of_q_leaves_out_aspect_1():
    values = table("3-2").numbers("Q")
    assert cell("3-2", "total", "Q").published == "133.313"
    assert round(values[1:].sum(), 3) == 133.313
    assert values.sum() == pytest.approx(151.3884, abs=5e-5)


def test_the_general_equation_prints_a_wrong_height():
    numbers = evidence.t_equation()
    assert round(numbers["right"], 4) == float(table("3-8").text("D", "probability"))
    assert round(numbers["wrong"], 4) != float(table("3-8").text("D", "probability"))


@pytest.mark.parametrize("number", ["3-8", "3-10"])
def test_quotients_are_cut_not_rounded(number):
    printed = table(number)
    quotients = printed.numbers("I") / printed.numbers("h")
    np.testing.assert_allclose(
        np.floor(100 * quotients) / 100, printed.numbers("I_over_h"), rtol=0, atol=1e-9
    )
    assert (np.round(quotients, 2) != printed.numbers("I_over_h")).any()
    assert printed.numbers("probability").sum() == pytest.approx(0.9999, abs=1e-9)


def test_the_magnets_totals_are_misprinted():
    assert table("3-11").text("total", "I_over_h") == "804.1.73"
    assert evidence.magnet_total()["sum"] == pytest.approx(804.1073, abs=5e-5)
    assert table("3-11").numbers("probability").sum() == pytest.approx(1.0, abs=1e-9)


def test_deviation_is_over_all_aspects_and_cut():
    rows = [cell("3-12", row, "deviation") for row in table("3-12").names]
    assert all(row.cut for row in rows)
    assert sum(round(row.recomputed, 3) != row.printed for row in rows) > 3  # rounding would not do
    assert evidence.deviations()["sample"] > 0.21


def test_the_magnets_csa_deviations_rest_on_mixed_heights():
    mixed = parts.mixed_heights()
    np.testing.assert_allclose(mixed, [0.1430, 0.3032, 0.5538], rtol=0, atol=5e-5)
    profiles = parts.profiles("magnet")
    found = [deviation(mixed, profiles[name]) for name in ("MDBT_78", "MDBT_80", "STABILITY", "PMI")]
    plain = [deviation(profiles["CSA"], profiles[n]) for n in ("MDBT_78", "MDBT_80", "STABILITY", "PMI")]
    np.testing.assert_allclose(found, [0.1790, 0.1898, 0.1286, 0.0897], rtol=0, atol=5e-5)
    np.testing.assert_allclose(plain, [0.0618, 0.0617, 0.0272, 0.2292], rtol=0, atol=5e-5)


def test_the_masses_are_swapped():
    arc_chute, magnet = evidence.printed("arc_chute"), evidence.printed("magnet")
    x, y, z = (arc_chute[axis] for axis in "xyz")
    arms = np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    origin = np.array([arc_chute[f"origin_{a}{a}"] for a in "xyz"])
    centre = origin - magnet["mass"] * arms
    np.testing.assert_allclose(centre, [114.75, 109.57, 95.32], rtol=0, atol=0.01)
    own = origin - arc_chute["mass"] * arms
    assert np.abs(own - [114.75, 109.57, 95.32]).min() > 20.0


def test_x_and_z_are_exchanged_in_the_matrix():
    value, found = evidence.printed("arc_chute"), evidence.parallel_axes()
    assert found["I_xx"] == pytest.approx(value["I_zz"], abs=0.01)
    assert found["I_zz"] == pytest.approx(value["I_xx"], abs=0.01)
    assert float(table("3-10").text("5", "I")) == value["I_zz"]
    assert float(table("3-10").text("5", "h")) == pytest.approx(value["x"], abs=0.005)


def test_the_alignment_coefficients_as_printed():
    value, magnet = evidence.printed("arc_chute"), evidence.printed("magnet")
    assert round(value["drive_offset"] / value["I_xx"], 3) == value["alignment_coefficient"]
    assert round(magnet["drive_offset"] / magnet["I_xx"], 4) == magnet["alignment_coefficient"]
    assert round(evidence.alignment()["table"], 3) != value["alignment_coefficient"]


def test_the_magnets_matrix_is_not_symmetric():
    assert evidence.magnet_matrix() == {"upper": 10.91, "lower": -10.91}


def test_the_magnets_axes_are_not_four_degrees_off():
    found = evidence.principal_axes()
    assert found["text"] == 4.0
    assert found["about_z"] == pytest.approx(43.93, abs=0.01)
    assert found["about_y"] == pytest.approx(0.885, abs=0.001)


def test_the_magnets_lowest_aspect_has_two_heights():
    assert evidence.magnet_pose()["h"] - evidence.magnet_pose()["x"] == pytest.approx(0.01)


def test_the_bank_of_the_remark_is_a_misprint():
    assert evidence.bank_angle() == {"remark": 64.44, "equation": 64.22}
    magnet = evidence.printed("magnet")
    assert magnet["bank_without_radial_friction"] == magnet["wall_lever_angle"]


def test_one_lever_has_two_values():
    assert evidence.wall_lever() == {"first": 4.05, "second": 4.01}


def test_figures_5_6_and_5_7_are_drawn_past_the_hop():
    numbers = motion_evidence.hop()
    assert numbers["beta_deg"] == pytest.approx(7.93, abs=0.005)
    assert numbers["acceleration"] == pytest.approx(71.06, abs=0.005)
    assert 50.0 < numbers["share"] < 56.0


def test_a_larger_beta_slides_less_at_low_g_and_more_at_high():
    numbers = motion_evidence.sliding()
    assert numbers["low_10"] > numbers["low_40"]
    assert numbers["high_10"] < numbers["high_40"]


@pytest.mark.parametrize("name", ["arc_chute", "magnet"])
def test_the_part_card_holds_the_tables(name, request):
    """The cards of parts/ and the tables here are typed once each; they must not drift apart."""
    path = request.config.rootpath / "parts" / f"{name}.yaml"
    card, ours = load(str(path)), parts.card(name)
    assert card.mass == pytest.approx(ours.mass, rel=1e-12)
    np.testing.assert_allclose(card.centre_of_mass, ours.centre_of_mass, rtol=1e-12, atol=0)
    np.testing.assert_allclose(np.diag(card.inertia), np.diag(ours.inertia), rtol=1e-12, atol=0)
    theirs, own = find(card), find(ours)
    assert theirs.names == own.names
    for rule, chance in own.probabilities.items():
        np.testing.assert_allclose(theirs.probabilities[rule], chance, rtol=1e-12, atol=0)
    with path.open() as file:
        track = yaml.safe_load(file)["track"]
    assert track["wall_lever_angle"] == f"{evidence.printed(name)['wall_lever_angle']} deg"
