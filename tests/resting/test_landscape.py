"""Heights, passes and basins of the hull."""

import numpy as np
import pytest
import shapes

from feederscrew.part.hull import convex_hull
from feederscrew.resting.landscape import MIN_BARRIER_SHARE, RIPPLE_OF_RADIUS, edges, landscape, passes


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


def keel(chamfer=0.0):
    """A bar standing on a strip 0.6 wide whose sides leave at 40 deg, its centre of mass 5 over it.

    The way over the strip's edge rises by less than a ripple may, but it is sharp.
    """
    away = np.array([np.cos(np.radians(40)), np.sin(np.radians(40))])
    edge = np.array([0.3, -5.0])
    corner = [edge] if chamfer == 0.0 else [edge - (chamfer, 0.0), edge + chamfer * away]
    right = np.array([*corner, edge + 4 * away, (edge[0] + 4 * away[0], 5.0)])
    return shapes.prism(np.vstack([right, right[::-1] * (-1, 1)]), 20.0)


def stands_on_its_keel(mesh):
    hull = convex_hull(mesh.vertices, np.zeros(3))
    rise = np.hypot(0.3, 5.0) - 5.0
    assert MIN_BARRIER_SHARE * hull.radius < rise < RIPPLE_OF_RADIUS * hull.radius
    found = landscape(hull)
    assert len(found.sinks) == 8
    return hull.normals[found.sinks, 1].min() < -0.999


def test_a_sharp_edge_with_a_low_barrier_parts_two_faces():
    assert stands_on_its_keel(keel())


@pytest.mark.parametrize("chamfer", [1e-6, 1e-4, 5e-3])
def test_a_chamfer_too_small_to_see_leaves_its_edge_sharp(chamfer):
    assert stands_on_its_keel(keel(chamfer))


@pytest.mark.parametrize("seed", range(8))
def test_slivers_that_noise_leaves_at_an_edge_leave_it_sharp(seed):
    rng = np.random.default_rng(seed)
    assert stands_on_its_keel(shapes.noisy(shapes.subdivided(keel(), 1), 1e-4, rng))
