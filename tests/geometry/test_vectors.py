"""Small linear algebra against numpy's, and against what it must give exactly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.geometry import graphs, vectors

SEEDS = st.integers(0, 2**31)
FEW = {"max_examples": 60, "deadline": None, "derandomize": True}


def drawn(seed, *shape):
    return np.random.default_rng(seed).normal(size=shape)


SHAPES = "4,4 4,4x3 2x4,4 2x4,4x3 5x2x4,4 5x2x4,5x4x3 4,5x4x3 5x2x4,4x3"


@pytest.mark.parametrize("shapes", SHAPES.split())
def test_products_have_the_shape_and_value_of_the_matrix_product(shapes):
    a, b = (drawn(k, *map(int, shape.split("x"))) for k, shape in enumerate(shapes.split(",")))
    got = vectors.product(a, b)
    assert np.shape(got) == np.shape(a @ b) and np.allclose(got, a @ b, rtol=1e-13, atol=1e-14)


def test_columns_have_the_digits_of_rows():
    u, v = drawn(1, 50, 3), drawn(2, 50, 3)
    assert np.array_equal(vectors.cross_columns(u.T, v.T).T, vectors.cross(u, v))
    assert vectors.dot_columns(u.T, v.T) == pytest.approx(vectors.dot(u, v), rel=1e-14, abs=1e-15)
    places = np.array([[0, 7], [7, 3], [49, 0]])
    assert np.array_equal(vectors.columns_at(u, places).transpose(2, 0, 1), u[places])


def test_lengths_units_and_determinants():
    u = np.array([[3.0, 4.0, 0.0], [1.0, 2.0, 2.0]])
    assert vectors.length(u).tolist() == [5.0, 3.0] and vectors.length([3, 4]) == 5.0
    assert vectors.unit(u[0]).tolist() == [0.6, 0.8, 0.0]
    stack = drawn(3, 7, 3, 3)
    assert vectors.determinant(stack) == pytest.approx(np.linalg.det(stack))
    assert vectors.determinant(np.eye(3)[[1, 0, 2]]) == -1.0


@given(SEEDS, st.integers(2, 5))
@settings(**FEW)
def test_eigenvalues_ascend_and_axes_rebuild_the_matrix(seed, size):
    matrix = drawn(seed, size, size)
    matrix = (matrix + matrix.T) * 10.0 ** (seed % 9 - 4)
    values, axes = vectors.eigen(matrix)
    scale = np.abs(matrix).max()
    assert (np.diff(values) >= 0.0).all()
    assert np.allclose(axes.T @ axes, np.eye(size), atol=1e-13)
    assert np.allclose(axes * values @ axes.T, matrix, rtol=0, atol=1e-13 * scale)
    assert np.allclose(values, np.linalg.eigvalsh(matrix), rtol=0, atol=1e-13 * scale)


def test_equal_values_keep_the_axes_of_the_matrix():
    noise = 1e-17 * np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 3.0], [2.0, 3.0, 0.0]])
    values, axes = vectors.eigen(np.diag([2.0, 1.0, 2.0]) + noise)
    assert values.tolist() == [1.0, 2.0, 2.0] and axes.tolist() == [[0, 1, 0], [1, 0, 0], [0, 0, 1]]


def test_a_matrix_that_is_not_finite_has_no_eigenvalues():
    with pytest.raises(ValueError, match=r"^matrix: every entry must be finite$"):
        vectors.eigen([[np.nan, 0.0], [0.0, 1.0]])


@given(SEEDS, st.integers(1, 8))
@settings(**FEW)
def test_solutions_solve(seed, size):
    matrix, right = drawn(seed, 6, size, size), drawn(seed + 1, 6, size)
    found = vectors.solve(matrix, right)
    assert np.allclose(np.einsum("nij,nj->ni", matrix, found), right, atol=1e-7)
    assert vectors.solve(matrix[0], right[0]) == pytest.approx(found[0], rel=1e-12)


def test_a_zero_on_the_diagonal_is_no_obstacle_and_a_singular_matrix_has_no_solution():
    assert vectors.solve(np.eye(3)[[1, 2, 0]], [1.0, 2.0, 3.0]).tolist() == [3.0, 1.0, 2.0]
    both = vectors.solve([[[1.0, 2.0], [2.0, 4.0]], [[2.0, 0.0], [0.0, 4.0]]], [[1.0, 1.0], [2.0, 2.0]])
    assert not np.isfinite(both[0]).all() and both[1].tolist() == [1.0, 0.5]


@given(SEEDS)
@settings(**FEW)
def test_what_least_squares_leave_is_square_to_the_columns(seed):
    columns, right = drawn(seed, 12, 3), drawn(seed + 1, 12)
    columns = np.column_stack([columns, columns[:, 0] - 2.0 * columns[:, 1]])  # depends on the others
    left = vectors.misfit(columns, right)
    want = right - columns @ np.linalg.lstsq(columns, right, rcond=None)[0]
    assert left == pytest.approx(want, abs=1e-12)


def test_covariances_are_those_of_numpy():
    points, weights = drawn(5, 20, 3), np.abs(drawn(6, 20))
    want = np.cov(points.T, aweights=weights)
    assert np.allclose(vectors.covariance(points, weights), want, rtol=1e-12)


GROUPS = st.lists(st.lists(st.integers(0, 99), min_size=1).map(np.array), min_size=1)


@given(GROUPS)
def test_sums_are_of_each_group(given_groups):
    members, owners = graphs.join_groups(given_groups)
    both = np.stack([members, 2 * members])
    expected = np.array([group.sum() for group in given_groups])
    np.testing.assert_array_equal(graphs.group_sums(members, owners, len(expected)), expected)
    np.testing.assert_array_equal(graphs.group_sums(both, owners, len(expected)), np.outer(expected, [1, 2]))
