"""What checking the thesis showed: the numbers in the evidence of each finding."""

import re

import numpy as np
import pytest
import yaml

from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.thesis import parts
from feederscrew.thesis.findings import FINDING_OF, FINDINGS
from feederscrew.thesis.tables import chapter_4

# By hand from the printed columns where a comment says so; elsewhere as the solids and equations give them,
# which the tests of T shape, figures and motion hold.
EVIDENCE = {
    "t-shape-drawing": [0.0032, 0.0027],
    "t-shape-density": [0.0027, 0.58],
    "t-shape-rounded": [5.0e-06, 0.0044],
    "pmi-class-once": [0.3628, 0.3628, 0.4294],
    "csa-ratio": [1, 6, 7, 5.60, 80.4, 1.5, 5.1, 7.0, 5.8, 80.6, 3.1, 10.4, 13.9, 11.8, 60.9, 0.40],
    "experiment-total": [99.88, 100.00],
    "pmi-equation": [0.1633, 0.2418],
    "q-unit": [151.39, 26.27, 12.57],  # 12.57 = 4 pi
    "q-total": [151.3884, 133.3128, 133.313],  # sums of the printed column
    "arc-chute-heights": [1.48, 1.64, 7.4007, 7.4007],
    "h-total": [11.2894, 5e-06],
    "rounded-inputs": [42.69151, 0.00042, 42.6914],
    "cut-ratios": [215.47, 215.45],
    "sum-of-rounded": [0.9999, 0.9999],
    "magnet-total": [804.1073, 804.1],  # printed 804.1.73
    "magnet-probability-total": [1.0],
    "cut-deviations": [0.1898, 0.189, 0.212],  # 0.1898 sqrt(5/4)
    "magnet-csa-mixed": [0.1430, 0.3032, 0.5538, 0.0897, 0.089, 0.229],
    "magnet-heights": [1.64, 2.69, 0.94],
    "dominant-aspect": [2, 5],
    "masses-swapped": [4.630, 1.982, 4.63],
    "axes-swapped": [114.74, 95.32],
    "aspect-5-moment": [0.0330, 95.32, 0.0275, 114.75],  # 3.15 mm over each moment
    "magnet-matrix": [10.91, -10.91],
    "magnet-axes": [43.9, 0.89],
    "magnet-height": [2.17, 2.16, 746.62, 755.91],
    "bank-angle": [64.44, 64.22],
    "wall-lever": [4.05, 4.01],
    "hop": [7.9, 71, 53, 21],  # asin(9.8 / 71.06), 0.5 mm (2 pi 60 Hz)^2
    "beta-sliding": [0.1, 0.100, 0.082, 1.0, 1.192, 2.145],  # G cos b / (1 - G sin b)
    "figure-references": [],
    "drawings-lost": [],
    "fixed-axes": [20, -1.46],
    "alpha-plus-theta": [20, 0.766],  # cos 40 deg
    "sign-of-r-y": [],
    "radial-gravity": [3.37, 19.4],  # 1.982 g at sin 10 deg
    "centripetal": [0.0034, 19.4],
    "wall-tangent": [4.8e-05, 0.00043],
    "track-moments": [0.007, 0.00025, 19.4],
    "wall-pulls": [-1.12, 0.06],
    "normal-force-line": [1.99],  # h mu of a part that slides: 3.31 mm by 0.6
    "seven-unknowns": [10, -2.20, 0.00, 0.033],
    "one-instant": [0.5, 20, 0.567, 0.401],  # G cos b / (1 - G sin b), G cos b / (1 + G sin b)
    "dual-numbers": [10.0, 0.2222, -2.0, -0.2222],  # ad + bc, (bc - ad)/c^2
    "momentum-cross": [1.982],
    "equation-4-24": [],
    "conclusion-1": [47.8],  # half of 0.010 + 0.308 + 0.160 + 0.101 + 0.377
    "conclusion-2": [0.064],  # half of 0.6 + 4.2 + 2.74 + 3.6 + 1.66 percent
    "conclusion-4": [0.0032, 0.0027],
    "conclusion-5": [3.37, 19.4, 53],
    "conclusion-8": [0.5, 0.283, 0.567],  # 0.5 cos 20 / (1 - 0.5 sin 20), half of it at 60 deg
}
NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e-\d+)?")


def test_each_finding_shows_its_numbers():
    assert set(EVIDENCE) == set(FINDING_OF) and len(FINDING_OF) == len(FINDINGS)
    for finding in FINDINGS:
        assert finding.where and finding.what.endswith(".") and finding.evidence().endswith(".")
        numbers = iter([float(text) for text in NUMBER.findall(finding.evidence())])
        assert all(number in numbers for number in EVIDENCE[finding.id]), finding.id  # in this order


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
    track = yaml.safe_load(path.read_text())["track"]
    assert track["wall_lever_angle"] == f"{chapter_4(name)['wall_lever_angle']} deg"
