"""Tables 3-1, 3-8 and 3-9: the T shape by hand (two blocks and the parallel-axis rule) and by its surface."""

import numpy as np
import pytest

from feederscrew.part import mass
from feederscrew.resting.aspects import find
from feederscrew.thesis import parts, t_shape
from feederscrew.thesis.digits import prints_as
from feederscrew.thesis.printed_tables import table
from feederscrew.thesis.recompute import rounded_shares

RATIOS = [float(ratio) for ratio in t_shape.RATIOS]


def by_hand(ratio):
    """Polar moments [g mm2] and heights [mm] of aspects A to E, from the head and the stem as blocks."""
    thick, blocks = 25.0 * ratio, [(11.0, 12.0, 6.0), (25.0, 13.0, 18.5)]  # width, height, middle
    masses = [1e-3 * w * h * thick for w, h, _ in blocks]
    middle = sum(m * y for m, (_, _, y) in zip(masses, blocks)) / sum(masses)
    i_x = sum(m * ((h * h + thick**2) / 12 + (y - middle) ** 2) for m, (_, h, y) in zip(masses, blocks))
    i_y = sum(m * (w * w + thick**2) / 12 for m, (w, _, _) in zip(masses, blocks))
    i_z = sum(m * ((w * w + h * h) / 12 + (y - middle) ** 2) for m, (w, h, y) in zip(masses, blocks))
    lean = np.array([12.0, -7.0]) / np.hypot(12.0, 7.0)  # normal of the line from stem end to head edge
    leaning = lean[0] ** 2 * i_x + lean[1] ** 2 * i_y
    heights = [middle, 12.5, 25.0 - middle, lean @ [5.5, -middle], 0.5 * thick]
    return np.array([i_y, i_x, i_y, leaning, i_z]), np.array(heights)


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_surface_gives_what_two_blocks_give(ratio):
    moments, heights = by_hand(ratio)
    found = parts.t_aspects(ratio)
    np.testing.assert_allclose(found.moments / parts.G_MM2, moments, rtol=1e-9, atol=0)
    np.testing.assert_allclose(found.heights / parts.MM, heights, rtol=1e-9, atol=0)


def test_the_surface_is_closed_and_of_the_right_volume():
    vertices, faces = t_shape.solid(0.6)
    assert mass.solid(vertices[faces]).volume == pytest.approx((25 * 13 + 11 * 12) * 15e-9, rel=1e-12)
    edges = {tuple(edge) for face in faces for edge in zip(face, np.roll(face, -1))}
    assert len(edges) == 3 * len(faces)
    assert edges == {edge[::-1] for edge in edges}


@pytest.mark.parametrize("ratio", RATIOS)
def test_five_classes_of_one_or_two_faces(ratio):
    found = find(parts.t_part(ratio))
    assert sorted(found.faces) == [1, 1, 2, 2, 2]
    assert list(parts.t_aspects(ratio).faces) == [1, 2, 1, 2, 2]


def test_an_impossible_ratio_is_a_wrong_call():
    with pytest.raises(ValueError, match="ratio is -1"):
        t_shape.solid(-1)


@pytest.mark.parametrize("column", t_shape.RATIOS)
def test_table_3_9_within_0_005_points_without_any_rounding(column):
    ours = 100.0 * parts.t_aspects(float(column)).pmi
    np.testing.assert_allclose(ours, table("3-9").numbers(column), rtol=0, atol=0.005)


@pytest.mark.parametrize("column", t_shape.RATIOS)
def test_table_3_9_to_the_last_digit_with_the_thesis_roundings(column):
    shares = 100.0 * rounded_shares(float(column))[2]
    printed = [table("3-9").text(row, column) for row in table("3-9").names]
    assert all(prints_as(share, text) for share, text in zip(shares, printed))


def test_density_cancels_but_for_the_rounding():
    moments, heights = by_hand(0.6)
    plain = moments / heights
    np.testing.assert_allclose(parts.t_aspects(0.6).pmi, plain / plain.sum(), rtol=1e-9, atol=0)


def test_table_3_8_needs_the_density_the_text_does_not_state():
    printed = table("3-8").numbers("I")
    ours = parts.t_aspects(0.6).moments / parts.G_MM2
    wrong = ours * t_shape.DENSITY_IN_TEXT / t_shape.DENSITY
    assert np.abs(ours - printed).max() < 0.005
    assert np.abs(wrong - printed).max() > 0.5


def test_pmi_counts_a_class_once():
    counted = find(parts.t_part(0.6)).probabilities["pmi"]
    assert counted.max() == pytest.approx(0.4294, abs=5e-5)
    assert parts.t_aspects(0.6).pmi[4] == pytest.approx(0.3628, abs=5e-5)


@pytest.mark.parametrize(
    ("ratio", "expected"), [(0.4, [1.5, 5.1, 7.0, 5.8, 80.6]), (0.6, [3.1, 10.4, 13.9, 11.8, 60.9])]
)
def test_csa_of_the_t_shape(ratio, expected):
    np.testing.assert_allclose(100.0 * parts.t_aspects(ratio).csa, expected, rtol=0, atol=0.05)


def test_table_3_1_is_a_thinner_prism():
    printed = table("3-1").numbers("csa")
    gaps = {ratio: np.abs(100.0 * parts.t_aspects(ratio).csa - printed).max() for ratio in RATIOS}
    assert gaps[0.4] < 1.0
    assert gaps[0.6] > 19.0
    assert min(gaps, key=gaps.get) == 0.4
