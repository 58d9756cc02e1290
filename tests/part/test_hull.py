"""The hull seen from the centre of mass."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.errors import MeshError
from feederscrew.part.hull import convex_hull


def test_a_box_has_its_heights_areas_and_radius():
    mesh = shapes.box(2.0, 4.0, 6.0)
    hull = convex_hull(mesh.vertices, [0.0, 0.0, 0.5])
    assert sorted(set(np.round(hull.heights, 12))) == [1.0, 2.0, 2.5, 3.5]
    assert hull.areas.sum() == pytest.approx(2 * (8 + 12 + 24))
    assert hull.radius == pytest.approx(np.sqrt(1 + 4 + 3.5**2))
    assert hull.volume == pytest.approx(48.0)


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(5, 60))
@settings(max_examples=40, deadline=None)
def test_triangles_turn_outward_and_neighbours_share_the_opposite_edge(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    hull = convex_hull(points, points.mean(axis=0))
    a, b, c = np.moveaxis(hull.corners, 1, 0)
    assert (np.einsum("ti,ti->t", np.cross(b - a, c - a), hull.normals) > 0).all()
    np.testing.assert_allclose(np.einsum("ti,ti->t", a, hull.normals), hull.heights, rtol=1e-9, atol=1e-12)
    for t, (corners, others) in enumerate(zip(hull.triangles, hull.neighbours)):
        for k, other in enumerate(others):
            assert set(np.delete(corners, k)) == set(corners) & set(hull.triangles[other]), t


def test_flat_points_and_a_centre_outside_are_said():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    with pytest.raises(MeshError, match=r"^flat.stl: the part has no volume - export it as a closed solid$"):
        convex_hull(square, square.mean(axis=0), "flat.stl")
    for centre in ([0.5, 0, 0], [0.7, 0, 0]):
        with pytest.raises(
            MeshError, match=r"^b.stl: the centre of mass is not inside the part's convex hull - "
        ):
            convex_hull(shapes.box(1, 1, 1).vertices, centre, "b.stl")


@pytest.mark.parametrize("seed", range(4))
def test_a_split_and_rounded_surface_has_the_hull_of_the_whole_one(seed, rng):
    """Corners in the middle of edges and faces stand out by single precision: they are none."""
    mesh = shapes.turned(shapes.prism(shapes.l_profile(), 9.0), np.random.default_rng(seed))
    fine = shapes.subdivided(mesh, 3)
    points = fine.vertices.astype(np.float32).astype(float)
    hull = convex_hull(points, points.mean(axis=0))
    assert len(hull.vertices) == len(convex_hull(mesh.vertices, mesh.vertices.mean(axis=0)).vertices)


def test_a_fine_circle_and_a_shallow_bevel_keep_their_corners():
    turn = 2.0 * np.pi * np.arange(1000) / 12000  # as fine as a whole circle of 12000
    ring = np.vstack([np.column_stack([np.cos(turn), np.sin(turn)]), [(-1.0, -0.3)]])
    coin = np.concatenate([np.column_stack([ring, np.full(len(ring), z)]) for z in (-0.1, 0.1)])
    assert len(convex_hull(coin, np.zeros(3)).vertices) == 2 * len(ring)
    bevelled = np.vstack([shapes.box(2.0, 2.0, 2.0).vertices, [(0.0, 0.0, 1.0 + 1e-3)]])
    assert len(convex_hull(bevelled, np.zeros(3)).vertices) == 9
