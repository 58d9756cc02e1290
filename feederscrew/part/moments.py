"""Moments of a solid up to order six, and whether a rotation leaves them alone."""

from functools import cache, cached_property
from itertools import product
from math import factorial

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors

ORDER = 6
HALF = [powers for powers in product(range(4), repeat=3) if sum(powers) <= ORDER // 2]  # 20 monomials
ONE_LESS = [  # of each but the first: the monomial, listed before, that makes it with one more factor; which
    (HALF.index(tuple(power - (k == axis) for k, power in enumerate(powers))), axis)
    for powers in HALF[1:]
    for axis in [max(k for k in range(3) if powers[k])]
]
AS_PRODUCTS = {  # powers up to the order: two of those monomials that make them
    tuple(int(power) for power in np.add(p, q)): (i, j)
    for (i, p), (j, q) in product(enumerate(HALF), repeat=2)
}
POWERS = np.array(sorted((p for p in product(range(ORDER + 1), repeat=3) if 1 <= sum(p) <= ORDER), key=sum)).T
WAYS = np.array(
    [factorial(sum(p)) // (factorial(p[0]) * factorial(p[1]) * factorial(p[2])) for p in POWERS.T]
)
SMALL = 0.08  # of the part: on facets with shorter edges a rule of second order will do
BLOCK = 1 << 15  # points at a time: what a processor's cache holds


class Moments:
    """What a solid looks like from its centre of mass, blind to how its surface is cut into triangles.

    The d-th directional moment, the integral of (x . u)^d over the solid, is a polynomial in u. A rotation
    is a symmetry of the solid only if it leaves all of them alone; up to order six they tell any features
    apart but those repeated seven times or more about one axis.
    """

    def __init__(self, vertices, faces, centre):
        """Moments of a closed surface, integrated when they are first asked for.

        Parameters
        ----------
        vertices : (V, 3) float [m]
        faces : (F, 3) int
            Counter-clockwise seen from outside.
        centre : (3,) float [m]
            Centre of mass.
        """
        self._surface = np.asarray(vertices) - centre, np.asarray(faces)
        self.error = 1e-4  # [1] of the quadrature, of float32 files and of uneven tessellation

    @cached_property
    def _integrated(self):
        table, volume, size = _integrals(*self._surface)
        return table / volume, size

    @property
    def size(self):
        """Root mean square distance from the centre of mass [m], the unit of length."""
        return self._integrated[1]

    def directional(self, directions):
        """Directional moments of every order from 1 to 6.

        Parameters
        ----------
        directions : (..., 3) float [1]
            Unit vectors.

        Returns
        -------
        (..., 6) float [1]
            In units of the size to the power of the order.
        """
        moments, _ = self._integrated
        a, b, c = POWERS
        power = np.ones((*directions.shape[:-1], ORDER + 1, 3))
        power[..., 1:, :] = directions[..., None, :]
        power = np.cumprod(power, axis=-2)
        terms = WAYS * moments[a, b, c] * power[..., a, 0] * power[..., b, 1] * power[..., c, 2]
        return np.add.reduceat(terms, np.searchsorted(POWERS.sum(axis=0), np.arange(1, ORDER + 1)), axis=-1)

    def mismatch(self, rotations):
        """How far rotations are from being symmetries of the solid.

        Parameters
        ----------
        rotations : (N, 3, 3) float [1]

        Returns
        -------
        (N,) float [1]
            Largest change of a directional moment by its order; a feature of 1e-3 of the volume, as far out
            as the size, that finds no counterpart gives about 1e-3.
        """
        directions = _sphere(24)
        turned = np.einsum("nij,kj->nki", np.asarray(rotations), directions)
        change = np.abs(self.directional(turned) - self.directional(directions))
        return (change / np.arange(1, ORDER + 1)).max(axis=(1, 2))


def _integrals(points, faces):
    """(7, 7, 7) integrals of x^a y^b z^c over the solid, scaled by its size; its volume; its size.

    From surface integrals of x^a y^b z^c (x . n): by Euler's theorem they are (a + b + c + 3) times the
    solid's.
    """
    scale = vectors.norm(points).mean()
    nodes, weights = _quadrature(points / scale, faces)
    table = np.zeros((ORDER + 1, ORDER + 1, ORDER + 1))
    for start in range(0, len(weights), BLOCK):
        half = _monomials(nodes[start : start + BLOCK])
        weighted = half * weights[start : start + BLOCK]
        for powers, (i, j) in AS_PRODUCTS.items():
            table[powers] += np.einsum("n,n->", weighted[i], half[j])
    volume, second = table[0, 0, 0] / 3.0, (table[2, 0, 0] + table[0, 2, 0] + table[0, 0, 2]) / 5.0
    size = np.sqrt(abs(second / volume))  # facets that overlap may leave either negative
    order = np.indices(table.shape).sum(axis=0)
    return table / (order + 3.0) / size**order, volume, scale * size


def _monomials(points):
    """(20, N) products of coordinates up to half the order."""
    half, coordinates = np.ones((len(HALF), len(points))), np.ascontiguousarray(points.T)
    for row, (before, axis) in zip(half[1:], ONE_LESS):
        np.multiply(half[before], coordinates[axis], out=row)
    return half


def _quadrature(points, faces):
    """Nodes (N, 3) and weights (N,) of the surface, each weight times the distance of its facet's plane."""
    corners = points[faces]
    a, b, c = np.moveaxis(corners, 1, 0)
    flux = 0.5 * np.einsum("fi,fi->f", a, vectors.cross(b - a, c - a))
    small = np.abs(corners - np.roll(corners, 1, axis=1)).max(axis=(1, 2)) < SMALL
    large_nodes, large_weights = _gauss(corners[~small], flux[~small])
    small_nodes, small_weights = _second_order(points, faces[small], corners[small], flux[small])
    return np.concatenate([large_nodes, small_nodes]), np.concatenate([large_weights, small_weights])


def _gauss(corners, flux):
    """Exact to order six: Gauss's rule on the square, folded to triangles."""
    x, w = _gauss_legendre()
    u, v = (g.ravel() for g in np.meshgrid(x, x, indexing="ij"))
    share = 2.0 * np.outer(w, w).ravel() * (1.0 - u)
    barycentric = np.column_stack([u, v * (1.0 - u), (1.0 - u) * (1.0 - v)])
    return np.einsum("qk,fki->fqi", barycentric, corners).reshape(-1, 3), np.outer(flux, share).ravel()


@cache
def _gauss_legendre():
    """Nodes and weights of Gauss's rule of four nodes from 0 to 1."""
    x, w = np.polynomial.legendre.leggauss(4)
    return check.frozen(0.5 * (x + 1.0)), check.frozen(0.5 * w)


def _second_order(points, faces, corners, flux):
    """Exact to order two: three quarters at the centroid, the rest at the corners."""
    shared = np.bincount(faces.ravel(), np.repeat(flux / 12.0, 3), minlength=len(points))
    return np.concatenate([corners.mean(axis=1), points]), np.concatenate([0.75 * flux, shared])


def _sphere(count):
    """(count, 3) directions spread over half the sphere."""
    k = np.arange(count) + 0.5
    z, turn = k / count, np.pi * (1.0 + np.sqrt(5.0)) * k
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), z])
