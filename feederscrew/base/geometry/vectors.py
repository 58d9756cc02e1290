"""Small linear algebra with the same digits on every processor.

numpy hands `@`, `dot` and `numpy.linalg` to BLAS and LAPACK, whose kernels are chosen by the processor and
add in different orders. A drop is chaotic, and a last digit decides ties between equal faces, so nothing that
is computed for an answer may pass through them. Here sums are written out, or left to `numpy.einsum` without
optimisation, which adds in one order.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Ints, Points, Vector

PRODUCT_SUBSCRIPTS = {  # by whether each factor is a matrix
    (False, False): "k,k->",
    (False, True): "k,...km->...m",
    (True, False): "...nk,k->...n",
    (True, True): "...nk,...km->...nm",
}
OFF_DIAGONAL_ROUNDING = 1e-15  # [1] of the largest entry: an entry off the diagonal that is rounding
MAX_JACOBI_SWEEPS = 50  # of Jacobi rotations: six suffice for any 3 x 3 matrix
DEPENDENT_COLUMN_SHARE = 1e-6  # [1] of its length: what is left of a column that depends on those before it


def product(a: Array, b: Array) -> Floats:
    """Return the matrix product, like ``a @ b``, with the same digits on every processor.

    Parameters
    ----------
    a : (K,) or (..., N, K) array [any unit]
    b : (K,) or (..., K, M) array [any unit]

    Returns
    -------
    (), (..., M), (..., N) or (..., N, M) array [product of their units]
    """
    return np.einsum(PRODUCT_SUBSCRIPTS[np.ndim(a) > 1, np.ndim(b) > 1], a, b)


def dot(u: Floats, v: Floats) -> Any:
    """Return the scalar products of vectors along the last axis.

    Parameters
    ----------
    u, v : (..., K) float [any units]
        They broadcast.

    Returns
    -------
    (...,) float [product of their units]
    """
    return np.einsum("...k,...k->...", u, v)


def cross(u: ArrayLike, v: ArrayLike) -> Any:
    """Return the vector products u x v of vectors along the last axis.

    The digits are those of ``numpy.cross``, whose own checks take four times as long as a few products.

    Parameters
    ----------
    u, v : (..., 3) array_like [any units]
        They broadcast.

    Returns
    -------
    (..., 3) float [product of their units]
    """
    u, v = np.asarray(u, float), np.asarray(v, float)
    a, b, c = u[..., 0], u[..., 1], u[..., 2]
    x, y, z = v[..., 0], v[..., 1], v[..., 2]
    products = np.empty(u.shape if u.shape == v.shape else np.broadcast_shapes(u.shape, v.shape))
    products[..., 0] = b * z - c * y
    products[..., 1] = c * x - a * z
    products[..., 2] = a * y - b * x
    return products


def length(vectors: ArrayLike) -> Any:
    """Return the lengths of vectors.

    Parameters
    ----------
    vectors : (..., K) float [any]

    Returns
    -------
    (...) float [any]
    """
    vectors = np.asarray(vectors, float)
    return np.sqrt(dot(vectors, vectors))


def norm(vectors: Array) -> Any:
    """Return the lengths of vectors in space.

    The digits are those of ``numpy.linalg.norm`` along the last axis, which takes seven times as long.

    Parameters
    ----------
    vectors : (..., 3) float [any]

    Returns
    -------
    (...) float [any]
    """
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    return np.sqrt(x * x + y * y + z * z)


def unit(vectors: ArrayLike) -> Any:
    """Return vectors divided by their lengths.

    Parameters
    ----------
    vectors : (..., K) float [any]
        None may be zero.

    Returns
    -------
    (..., K) float [1]
    """
    return np.asarray(vectors, float) / length(vectors)[..., None]


def ratio(above: ArrayLike, below: ArrayLike, otherwise: ArrayLike = np.nan) -> Floats:
    """Return quotients, with a value of one's own where the divisor is zero.

    Parameters
    ----------
    above, below : array_like [any units]
        They broadcast.
    otherwise : array_like [quotient of their units]
        Where ``below`` is 0.

    Returns
    -------
    (...) float [quotient of their units]
    """
    shape = np.broadcast_shapes(np.shape(above), np.shape(below))
    return np.divide(above, below, out=np.full(shape, otherwise), where=np.asarray(below) != 0.0)


def determinant(matrix: ArrayLike) -> Any:
    """Return the determinant of a matrix, or of a stack of them: a . (b x c) of its rows.

    Parameters
    ----------
    matrix : (..., 3, 3) float [any]

    Returns
    -------
    (...) float [any cubed]
    """
    a, b, c = np.moveaxis(np.asarray(matrix, float), -2, 0)
    return dot(a, cross(b, c))


def covariance(vectors: Floats, weights: Floats) -> Floats:
    """Return the unbiased covariance of vectors that count with different weights.

    C = sum w_n (x_n - m) (x_n - m)^T / (W - sum w_n^2 / W), with W = sum w_n and m the weighted mean. With
    equal weights that is the sample covariance, divided by N - 1. A single vector has none: it gives NaN.

    Parameters
    ----------
    vectors : (N, K) float [any unit]
    weights : (N,) float [1]
        How much each vector counts: none negative, some positive.

    Returns
    -------
    (K, K) float [square of the unit]
    """
    total = weights.sum()
    off = vectors - np.einsum("n,nk->k", weights, vectors) / total
    share = total - (weights**2).sum() / total
    # a quantity a row: einsum adds along memory, in one order on every processor
    off = np.ascontiguousarray(off.T)
    return np.einsum("in,jn->ij", weights * off, off) / share


def eigen(matrix: ArrayLike) -> tuple[Floats, Floats]:
    """Return eigenvalues, ascending, and eigenvectors of a small symmetric matrix.

    Cyclic Jacobi rotations. Entries off the diagonal that are rounding are left alone, as they would choose
    among the axes of equal values.

    Parameters
    ----------
    matrix : (K, K) array_like [any unit]
        Symmetric.

    Returns
    -------
    (K,) float [unit of the matrix]
        Eigenvalues, ascending.
    (K, K) float [1]
        Orthonormal eigenvectors, a column each, in the order of the values. Equal values keep the axes of the
        matrix as far as possible.

    Raises
    ------
    ValueError
        If the matrix is not finite.

    References
    ----------
    G. H. Golub, C. F. Van Loan, "Matrix Computations", 4th ed., Johns Hopkins, 2013, section 8.5.
    """
    entries = np.array(matrix, float)
    if not np.isfinite(entries).all():
        raise ValueError("matrix: every entry must be finite")
    small = OFF_DIAGONAL_ROUNDING * np.abs(entries).max(initial=0.0)
    a, turned = entries.tolist(), np.eye(len(entries)).tolist()  # a dozen numbers are no work for numpy
    for _ in range(MAX_JACOBI_SWEEPS):
        pairs = [(p, q) for p in range(len(a)) for q in range(p + 1, len(a)) if abs(a[p][q]) > small]
        if not pairs:
            break
        for p, q in pairs:  # turn axes p and q until the entry between them is zero
            if a[p][q] == 0.0:
                continue
            half = (a[q][q] - a[p][p]) / (2.0 * a[p][q])
            t = math.copysign(1.0, half) / (abs(half) + math.hypot(1.0, half))  # tangent of the angle
            c = 1.0 / math.hypot(1.0, t)
            s = t * c
            for row in (*a, *turned):
                row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
            first, second = a[p], a[q]
            a[p] = [c * x - s * y for x, y in zip(first, second)]
            a[q] = [s * x + c * y for x, y in zip(first, second)]
            a[p][q] = a[q][p] = 0.0
    values = np.array([row[k] for k, row in enumerate(a)])
    order = np.argsort(values, kind="stable")
    return values[order], np.array(turned)[:, order]


def solve(matrix: ArrayLike, right: ArrayLike) -> Floats:
    """Return the solutions of systems of linear equations.

    Gaussian elimination; in each column the largest pivot comes first.

    Parameters
    ----------
    matrix : (..., K, K) array_like [any unit]
    right : (..., K) array_like [any unit]
        The right side; both broadcast.

    Returns
    -------
    (..., K) float [unit of the right side over that of the matrix]
        Not finite where a matrix is singular.
    """
    matrix, right = np.asarray(matrix, float), np.asarray(right, float)
    shape = np.broadcast_shapes(matrix.shape[:-1], right.shape)
    size = shape[-1]
    both = np.empty((*shape, size + 1))
    both[..., :-1], both[..., -1] = matrix, right
    rows = np.ascontiguousarray(np.moveaxis(both.reshape(-1, size, size + 1), 0, -1))  # a system a column
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for k in range(size):
            # In each system the row below that is largest in column k changes places with row k.
            best = k + np.abs(rows[k:, k]).argmax(axis=0)
            swapped = np.flatnonzero(best != k)
            upper, lower = rows[k][:, swapped].T, rows[best[swapped], :, swapped]
            rows[best[swapped], :, swapped] = upper
            rows[k][:, swapped] = lower.T
            factors = rows[k + 1 :, k] / rows[k, k]
            rows[k + 1 :, k:] -= factors[:, None] * rows[k, k:]
        for k in reversed(range(size)):
            for j in range(k + 1, size):
                rows[k, -1] -= rows[k, j] * rows[j, -1]
            rows[k, -1] /= rows[k, k]
    return rows[:, -1].T.reshape(shape)


def misfit(columns: ArrayLike, right: ArrayLike) -> Floats:
    """Return what a least-squares fit leaves of the right side: less the nearest sum of the columns.

    Modified Gram-Schmidt; each column is freed twice from those before it, because once leaves rounding. The
    columns may depend on each other: what is left of one that does is dropped.

    Parameters
    ----------
    columns : (N, K) array_like [any unit]
    right : (N,) array_like [any unit]

    Returns
    -------
    (N,) float [unit of the right side]
        Square to every column.
    """
    basis: list[Floats] = []
    left = np.array(right, float)
    for column in np.asarray(columns, float).T:
        free = column
        for axis in basis * 2:
            free = free - dot(free, axis) * axis
        if length(free) > DEPENDENT_COLUMN_SHARE * length(column):
            basis.append(unit(free))
    for axis in basis * 2:
        left = left - dot(left, axis) * axis
    return left


def plane_axes(normals: Floats) -> tuple[Floats, Floats]:
    """Return two axes in the plane across each normal; with it they are right-handed.

    Parameters
    ----------
    normals : (..., 3) float [1]
        Unit vectors.

    Returns
    -------
    first, second : (..., 3) float [1]
    """
    first = np.eye(3)[np.abs(normals).argmin(axis=-1)]
    u = unit(cross(normals, first))
    return u, cross(normals, u)


def spiral(count: int) -> Floats:
    """Return unit vectors spread over the sphere, along a spiral.

    Parameters
    ----------
    count : int

    Returns
    -------
    (count, 3) float [1]

    References
    ----------
    R. Swinbank, R. J. Purser, "Fibonacci grids: a novel approach to global modelling", Q. J. R.
    Meteorol. Soc. 132(619), 1769-1793, 2006.
    """
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, np.pi * (1.0 + np.sqrt(5.0)) * k
    flat = np.sqrt(1.0 - z * z)
    return np.column_stack([flat * np.cos(turn), flat * np.sin(turn), z])


def carried(axis: Vector, start: Vector, end: Vector) -> Any:
    """Return a unit vector turned as the shortest turn takes one direction to another.

    Two mirrors make the turn: one square to the middle of both directions, one square to ``end``. Rounding is
    taken away at the end, so that the result is square to ``end``.

    Parameters
    ----------
    axis : (3,) float [1]
        Square to ``start``.
    start, end : (3,) float [1]
        Unit vectors that are not opposite: their shortest turn is not known.

    Returns
    -------
    (3,) float [1]
    """
    middle = unit(start + end)
    turned = axis - 2.0 * dot(axis, middle) * middle
    turned = turned - 2.0 * dot(turned, end) * end  # two mirrors make the turn
    return unit(turned - end * dot(turned, end))


def columns_at(rows: Points, places: Ints) -> Floats:
    """Return vectors at chosen places as columns, which numpy reads faster than rows.

    Parameters
    ----------
    rows : (M, 3) float [any unit]
    places : (N, K) int
        Rows that are chosen, K for each of N things.

    Returns
    -------
    (K, 3, N) float [unit of the rows]
    """
    return np.ascontiguousarray(rows.T)[:, places.T].swapaxes(0, 1)


def dot_columns(u: Floats, v: Floats) -> Floats:
    """Return the scalar products of vectors that are columns.

    Parameters
    ----------
    u, v : (3, N) float [any units]

    Returns
    -------
    (N,) float [product of their units]
    """
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cross_columns(u: Floats, v: Floats) -> Floats:
    """Return the vector products u x v of vectors that are columns.

    Parameters
    ----------
    u, v : (3, N) float [any units]

    Returns
    -------
    (3, N) float [product of their units]
    """
    return np.stack([u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)])


def solid_angles(apex: ArrayLike, triangles: ArrayLike) -> Any:
    """Return the solid angle of each triangle, seen from a point.

    tan(Omega / 2) = a . (b x c) / (|a| |b| |c| + (a . b) |c| + (b . c) |a| + (c . a) |b|), with the corners
    a, b and c seen from the point. It is positive where the outer side faces away from ``apex``; triangles
    closed around it sum to 4 pi.

    Parameters
    ----------
    apex : (3,) array_like [m]
    triangles : (T, 3, 3) array_like [m]
        Corners counter-clockwise seen from outside.

    Returns
    -------
    (T,) float [sr]
        Where ``apex`` lies on a triangle, plus or minus 2 pi by rounding.

    Raises
    ------
    ValueError
        If a shape is wrong or an entry is not finite.

    References
    ----------
    A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. BME-30(2),
    125-126, 1983.
    """
    apex = check.shaped("apex", apex, (3,))
    triangles = check.shaped("triangles", triangles, (-1, 3, 3))

    a, b, c = np.moveaxis(triangles - apex, 1, 0)  # corners from the apex, each (T, 3)
    la, lb, lc = (norm(corner) for corner in (a, b, c))
    triple = dot(a, cross(b, c))
    rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    return 2.0 * np.arctan2(triple, rest)  # arctan would fold past half a sphere
