"""Small linear algebra, solid angles, and areas that are seen."""

from pathlib import Path

import numpy as np
import pytest
import shapely
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.base.geometry import graphs, shaded, vectors
from feederscrew.base.geometry.vectors import solid_angles
from feederscrew.part import load

PARTS = Path(__file__).resolve().parents[2] / "parts"
SEEDS = st.integers(0, 2**31)
FEW = {"max_examples": 60, "deadline": None, "derandomize": True}


def drawn(seed, *shape):
    return np.random.default_rng(seed).normal(size=shape)


@pytest.mark.parametrize("shapes", "4,4 4,4x3 2x4,4 2x4,4x3 5x2x4,4 5x2x4,5x4x3 4,5x4x3 5x2x4,4x3".split())
def test_products_have_the_shape_and_value_of_the_matrix_product(shapes):
    a, b = (drawn(k, *map(int, shape.split("x"))) for k, shape in enumerate(shapes.split(",")))
    product = vectors.product(a, b)
    assert np.shape(product) == np.shape(a @ b) and np.allclose(product, a @ b, rtol=1e-13, atol=1e-14)


def test_small_vector_algebra():
    u, v = drawn(1, 50, 3), drawn(2, 50, 3)
    assert np.array_equal(vectors.cross_columns(u.T, v.T).T, vectors.cross(u, v))
    assert vectors.dot_columns(u.T, v.T) == pytest.approx(vectors.dot(u, v), rel=1e-14, abs=1e-15)
    places = np.array([[0, 7], [7, 3], [49, 0]])
    assert np.array_equal(vectors.columns_at(u, places).transpose(2, 0, 1), u[places])
    u = np.array([[3.0, 4.0, 0.0], [1.0, 2.0, 2.0]])
    assert vectors.length(u).tolist() == [5.0, 3.0] and vectors.length([3, 4]) == 5.0
    assert vectors.unit(u[0]).tolist() == [0.6, 0.8, 0.0]
    stack = drawn(3, 7, 3, 3)
    assert vectors.determinant(stack) == pytest.approx(np.linalg.det(stack))
    assert vectors.determinant(np.eye(3)[[1, 0, 2]]) == -1.0
    points, weights = drawn(5, 20, 3), np.abs(drawn(6, 20))
    want = np.cov(points.T, aweights=weights)
    assert np.allclose(vectors.covariance(points, weights), want, rtol=1e-12)
    # Degenerate matrices.
    noise = 1e-17 * np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 3.0], [2.0, 3.0, 0.0]])
    eigen, axes = vectors.eigen(np.diag([2.0, 1.0, 2.0]) + noise)
    assert eigen.tolist() == [1.0, 2.0, 2.0] and axes.tolist() == [[0, 1, 0], [1, 0, 0], [0, 0, 1]]
    assert vectors.solve(np.eye(3)[[1, 2, 0]], [1.0, 2.0, 3.0]).tolist() == [3.0, 1.0, 2.0]
    both = vectors.solve([[[1.0, 2.0], [2.0, 4.0]], [[2.0, 0.0], [0.0, 4.0]]], [[1.0, 1.0], [2.0, 2.0]])
    assert not np.isfinite(both[0]).all() and both[1].tolist() == [1.0, 0.5]


@given(SEEDS, st.integers(2, 5))
@settings(**FEW)
def test_eigenvalues_ascend_and_axes_rebuild_the_matrix(seed, size):
    matrix = drawn(seed, size, size)
    matrix = (matrix + matrix.T) * 10.0 ** (seed % 9 - 4)
    eigen, axes = vectors.eigen(matrix)
    scale = np.abs(matrix).max()
    assert (np.diff(eigen) >= 0.0).all()
    assert np.allclose(axes.T @ axes, np.eye(size), atol=1e-13)
    assert np.allclose(axes * eigen @ axes.T, matrix, rtol=0, atol=1e-13 * scale)
    assert np.allclose(eigen, np.linalg.eigvalsh(matrix), rtol=0, atol=1e-13 * scale)


@given(SEEDS, st.integers(1, 8))
@settings(**FEW)
def test_solutions_solve(seed, size):
    matrix, right = drawn(seed, 6, size, size), drawn(seed + 1, 6, size)
    solution = vectors.solve(matrix, right)
    assert np.allclose(np.einsum("nij,nj->ni", matrix, solution), right, atol=1e-7)
    assert vectors.solve(matrix[0], right[0]) == pytest.approx(solution[0], rel=1e-12)


@given(SEEDS)
@settings(**FEW)
def test_what_least_squares_leave_is_square_to_the_columns(seed):
    columns, right = drawn(seed, 12, 3), drawn(seed + 1, 12)
    columns = np.column_stack([columns, columns[:, 0] - 2.0 * columns[:, 1]])  # depends on the others
    want = right - columns @ np.linalg.lstsq(columns, right, rcond=None)[0]
    assert vectors.misfit(columns, right) == pytest.approx(want, abs=1e-12)


@given(st.lists(st.lists(st.integers(0, 99), min_size=1).map(np.array), min_size=1))
def test_sums_are_of_each_group(groups):
    members, owners = graphs.join_groups(groups)
    sums = np.array([group.sum() for group in groups])
    np.testing.assert_array_equal(graphs.group_sums(members, owners, len(sums)), sums)
    both = np.stack([members, 2 * members])
    np.testing.assert_array_equal(graphs.group_sums(both, owners, len(sums)), np.outer(sums, [1, 2]))


@pytest.mark.parametrize(("a", "b", "h"), [(1.0, 1.0, 0.5), (10.0, 20.0, 15.0), (3.0, 0.1, 40.0)])
def test_the_solid_angle_of_a_rectangle_from_over_its_middle(a, b, h):
    corners = np.array([[-a, -b, -2 * h], [a, -b, -2 * h], [a, b, -2 * h], [-a, b, -2 * h]]) / 2
    want = 4 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)))
    assert solid_angles(np.zeros(3), corners[[[0, 2, 1], [0, 3, 2]]]).sum() == pytest.approx(want, rel=1e-12)


@pytest.mark.parametrize(
    ("apex", "total"),
    [((0, 0, 0), 4 * np.pi), ((0.4, -0.9, 1.4), 4 * np.pi), ((0.99999, 0, 0), 4 * np.pi), ((5, 1, 2), 0.0)],
)
def test_a_closed_surface_fills_the_sphere_from_inside_and_nothing_from_outside(apex, total):
    mesh = shapes.box(2, 2, 3)
    angles = solid_angles(np.array(apex, dtype=float), mesh.vertices[mesh.faces])
    assert angles.sum() == pytest.approx(total, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: vectors.eigen([[np.nan, 0.0], [0.0, 1.0]]), "^matrix: every entry must be finite$"),
        (lambda: solid_angles(np.zeros(3), np.zeros((4, 3))), "triangles has shape"),
        (lambda: solid_angles([0, np.nan, 0], np.zeros((4, 3, 3))), "apex has an entry that is not finite"),
    ],
)
def test_wrong_calls_name_the_argument(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def alike(corners, faces, others):
    """Whether the area is that of the union of the facets whose outer side is seen."""
    a, b, c = corners[others].transpose(1, 0, 2)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    facets = shapely.union_all(shapely.polygons(corners[others][twice > shaded.LEAST_AREA_M2]))
    return shaded.area(corners, faces).symmetric_difference(facets).area < 1e-9 * facets.area


@pytest.mark.parametrize("name", ["lbracket_30x20x15", "cap_14x10", "washer_m6"])
@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_area_is_that_of_all_facets_together(name, seed):
    part = load(PARTS / f"{name}.stl")
    turn = np.eye(3) if seed is None else np.linalg.qr(drawn(seed, 3, 3))[0]
    points, faces = part.vertices @ turn, part.faces if np.linalg.det(turn) > 0.0 else part.faces[:, ::-1]
    for axes in ([0, 1], [2, 0]):
        assert alike(points[:, axes], faces, faces)
        assert alike(points[:, axes], faces, faces[:, ::-1])  # a closed body's other side covers as much


def test_pieces_that_overlap_or_lie_apart_count_once_each():
    """Two boxes, one over a part of the other, and one far off; a facet twice changes nothing."""
    box = shapes.box(10, 8, 5)
    offsets = ((0.0, 0.0), (0.007, 0.003), (0.05, 0.0))
    corners = np.vstack([0.001 * np.asarray(box.vertices)[:, :2] + off for off in offsets])
    faces = np.vstack([np.asarray(box.faces) + k * len(box.vertices) for k in range(3)])
    area = shaded.area(corners, faces)
    assert area.area == pytest.approx((2 * 80.0 - 3.0 * 5.0 + 80.0) * 1e-6, rel=1e-12)
    assert len(shapely.get_parts(area)) == 2
    assert shaded.area(corners, np.vstack([faces, faces[:6]])).symmetric_difference(area).area < 1e-12
    assert shaded.area(corners, faces[:0]).is_empty


def below_each(sides):
    ends = (shapely.Polygon([*side, (side[1, 0], 0.0), (side[0, 0], 0.0)]).buffer(0.0) for side in sides)
    return shapely.union_all(list(ends))


def test_below_sides_counts_what_is_highest_and_leaves_what_is_not_there():
    """A roof over 0 to 4 mm over a floor, a side of 1 um between its halves, and a slope apart."""
    sides = 1e-3 * np.array(
        [
            [[0.0, 1.0], [1.999, 3.0]], [[1.999, 3.0], [2.0, 3.0]], [[4.0, 1.0], [2.0, 3.0]],
            [[4.0, 0.5], [0.0, 0.5]], [[7.0, 0.0], [9.0, 4.0]], [[9.0, 4.0], [9.0, 0.0]],
        ]
    )  # fmt: skip
    sides[:, :, 0] -= 9e-3
    for some in (sides, sides[::-1, ::-1], sides[[3, 0, 4, 1, 5, 2]]):
        below = shaded.below(some, 1e-6)
        assert [piece.area for piece in shapely.get_parts(below)] == pytest.approx([8e-6, 4e-6], rel=1e-3)
        assert [round(1e3 * end, 6) for end in below.bounds] == [-9.0, 0.0, 0.0, 4.0]
        assert len(shapely.get_coordinates(below)) == 10  # no corner where sides only go on
    roof = shapely.get_parts(shaded.below(sides, 1e-6))[0]
    assert roof.symmetric_difference(below_each(sides[:4])).area < 2e-9
    # What crosses is told to half a strip.
    rng = np.random.default_rng(3)
    for _ in range(20):
        sides = 0.02 * rng.random((30, 2, 2))
        want = below_each(sides)
        assert shaded.below(sides, 1e-6).symmetric_difference(want).area < 0.02 * want.area
