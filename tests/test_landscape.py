"""Heights, passes and basins of the hull."""

import numpy as np
import pytest
import shapes

from feederscrew.part.hull import convex_hull
from feederscrew.resting.landscape import edges, landscape, passes


def hull_of(mesh, centre=None):
    return convex_hull(mesh.vertices, mesh.center_mass if centre is None else centre)


def test_a_box_tips_over_its_edges():
    hull = hull_of(shapes.box(2, 4, 6))
    pairs, ends = edges(hull)
    assert len(pairs) == 18  # 12 edges and 6 diagonals
    sharp = np.abs(np.einsum("ei,ei->e", hull.normals[pairs[:, 0]], hull.normals[pairs[:, 1]])) < 0.5
    tops = np.unique(np.round(passes(hull, pairs, ends)[sharp], 9))
    np.testing.assert_allclose(tops, [np.sqrt(5), np.sqrt(10), np.sqrt(13)])


def test_a_coarse_cylinder_keeps_its_strips_and_says_how_deep_they_are():
    found = landscape(hull_of(shapes.cylinder(5, 20, 16)))
    assert len(found.sinks) == 18
    np.testing.assert_allclose(found.rises, 1 / np.cos(np.pi / 16) - 1)
    np.testing.assert_allclose(found.bends, np.pi / 8)


@pytest.mark.parametrize("sections", [6, 12, 14])
def test_a_bar_of_few_sides_keeps_every_basin(sections):
    assert len(landscape(hull_of(shapes.cylinder(5, 20, sections))).sinks) == sections + 2


@pytest.mark.parametrize("sections", [64, 256, 500])
def test_the_ripple_of_a_fine_cylinder_merges(sections):
    assert len(landscape(hull_of(shapes.cylinder(5, 20, sections))).sinks) == 3


def test_a_slender_pin_keeps_its_ends():
    found = landscape(hull_of(shapes.box(1, 1, 60)))
    assert len(found.sinks) == 6


def test_an_unstable_end_belongs_to_the_basin_it_rolls_into():
    slanted = shapes.prism(
        [(0, 0), (10, 0), (40, 20), (30, 20)], 8
    )  # leans too far to stand on its short side
    hull = hull_of(slanted)
    found = landscape(hull)
    standing = hull.normals[found.sinks]
    assert not np.any(standing @ [0, -1, 0] > 0.999)
    assert set(np.unique(found.basins)) == set(found.sinks)
