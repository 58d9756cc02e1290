"""Moments of a solid up to order six, and whether a rotation leaves them alone."""

from functools import cache, cached_property
from itertools import product
from math import factorial

import numpy as np

from feederscrew import check
from feederscrew.geometry import coordinates, vectors

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
MIDDLE, SMALL = 0.5, 0.16  # of the part: on facets with shorter edges a rule of order four, or two, will do
BLOCK = 1 << 13  # points at a time: what a processor's cache holds


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
        """Return directional moments of every order from 1 to 6.

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
        """Return how far rotations are from being symmetries of the solid.

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
    places, weights = _quadrature(np.ascontiguousarray(points.T) / scale, faces.T)
    table = np.zeros((ORDER + 1, ORDER + 1, ORDER + 1))
    for start in range(0, len(weights), BLOCK):
        half = _monomials(places[:, start : start + BLOCK])
        weighted = half * weights[start : start + BLOCK]
        for powers, (i, j) in AS_PRODUCTS.items():
            table[powers] += np.einsum("n,n->", weighted[i], half[j])
    volume, second = table[0, 0, 0] / 3.0, (table[2, 0, 0] + table[0, 2, 0] + table[0, 0, 2]) / 5.0
    size = np.sqrt(abs(second / volume))  # facets that overlap may leave either negative
    order = np.indices(table.shape).sum(axis=0)
    return table / (order + 3.0) / size**order, volume, scale * size


def _monomials(places):
    """(20, N) products of coordinates (3, N) up to half the order."""
    half = np.ones((len(HALF), places.shape[1]))
    for row, (before, axis) in zip(half[1:], ONE_LESS):
        np.multiply(half[before], places[axis], out=row)
    return half


def _quadrature(points, facets):
    """Nodes (3, N) and weights (N,) of the surface, each weight times the distance of its facet's plane.

    Of points (3, V) and facets (3, F).
    """
    a, b, c = (points[:, corner] for corner in facets)
    ab, bc, ca = b - a, c - b, a - c
    flux = 0.5 * coordinates.dot(a, coordinates.cross(ca, ab))
    extent = np.abs([ab, bc, ca]).max(axis=(0, 1))
    large, small = extent >= MIDDLE, extent < SMALL
    by_nodes = ((large, _sixth_order), (~(large | small), _fourth_order))
    rules = [
        _inside([p[:, some] for p in (a, b, c)], flux[some], *rule()) for some, rule in by_nodes if some.any()
    ]
    if small.any():
        rules.append(_second_order(points, facets[:, small], flux[small]))
    nodes, weights = zip(*rules)
    return np.concatenate(nodes, axis=1), np.concatenate(weights)


def _inside(corners, flux, barycentric, shares):
    """Nodes and weights of a rule whose nodes are inside each facet."""
    i, j, k = barycentric.T[:, :, None]
    a, b, c = (corner[:, None] for corner in corners)
    return (i * a + j * b + k * c).reshape(3, -1), (shares[:, None] * flux).ravel()


@cache
def _sixth_order():
    """(16, 3) and (16,) Gauss's rule on the square, folded to triangles."""
    x, w = np.polynomial.legendre.leggauss(4)
    u, v = (g.ravel() for g in np.meshgrid(0.5 * (x + 1.0), 0.5 * (x + 1.0), indexing="ij"))
    shares = 0.5 * np.outer(w, w).ravel() * (1.0 - u)
    barycentric = np.column_stack([u, v * (1.0 - u), (1.0 - u) * (1.0 - v)])
    return check.frozen(barycentric), check.frozen(shares)


@cache
def _fourth_order():
    """(6, 3) and (6,) rule of six nodes.

    G. R. Cowper, "Gaussian quadrature formulas for triangles", Int. J. Numer. Methods Eng. 7(3), 1973.
    """
    root, sign = np.sqrt(10.0), np.array([1.0, -1.0])
    near = (8.0 - root + sign * np.sqrt(38.0 - 44.0 * np.sqrt(0.4))) / 18.0
    shares = (620.0 + sign * np.sqrt(213125.0 - 53320.0 * root)) / 3720.0
    barycentric = near[:, None, None] + (1.0 - 3.0 * near[:, None, None]) * np.eye(3)
    return check.frozen(barycentric.reshape(-1, 3)), check.frozen(np.repeat(shares, 3))


def _second_order(points, facets, flux):
    """Exact to order two: three quarters at the centroid, the rest at the corners."""
    a, b, c = (points[:, corner] for corner in facets)
    shared = np.bincount(facets.ravel(), np.tile(flux / 12.0, 3))
    used = np.flatnonzero(shared)
    nodes = np.concatenate([(a + b + c) / 3.0, points[:, used]], axis=1)
    return nodes, np.concatenate([0.75 * flux, shared[used]])


@cache
def _sphere(count):
    """(count, 3) directions spread over half the sphere."""
    k = np.arange(count) + 0.5
    z, turn = k / count, np.pi * (1.0 + np.sqrt(5.0)) * k
    r = np.sqrt(1.0 - z * z)
    return check.frozen(np.column_stack([r * np.cos(turn), r * np.sin(turn), z]))
