"""Tables 3-1, 3-8 and 3-9: the T shape by hand (two blocks and the parallel-axis rule) and by its surface."""

import numpy as np
import pytest

from feederscrew.part import mass
from feederscrew.thesis import parts
from feederscrew.thesis.tables import table

RATIOS = [float(ratio) for ratio in parts.T_RATIOS]


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


def test_the_surface_gives_what_two_blocks_give():
    for ratio in RATIOS:
        moments, heights = by_hand(ratio)
        ours = parts.t_aspects(ratio)
        np.testing.assert_allclose(ours.moments / parts.G_MM2, moments, rtol=1e-9, atol=0)
        np.testing.assert_allclose(ours.heights / parts.MM, heights, rtol=1e-9, atol=0)
        plain = moments / heights  # the density cancels
        np.testing.assert_allclose(ours.pmi, plain / plain.sum(), rtol=1e-9, atol=0)


def test_the_surface_is_closed_and_of_the_right_volume():
    vertices, faces = parts.t_solid(0.6)
    assert mass.integrate_solid(vertices[faces]).volume == pytest.approx(
        (25 * 13 + 11 * 12) * 15e-9, rel=1e-12
    )
    edges = {tuple(edge) for face in faces for edge in zip(face, np.roll(face, -1))}
    assert len(edges) == 3 * len(faces)
    assert edges == {edge[::-1] for edge in edges}
    with pytest.raises(ValueError, match="ratio is -1"):
        parts.t_solid(-1)


def test_table_3_9_within_0_005_points_without_any_rounding():
    for ratio in parts.T_RATIOS:
        ours = 100.0 * parts.t_aspects(float(ratio)).pmi
        np.testing.assert_allclose(ours, table("3-9").numbers(ratio), rtol=0, atol=0.005)
