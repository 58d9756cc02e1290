"""Volume, mass, inertia and higher moments of a solid from its surface; which rotations leave it alone."""

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import product
from math import factorial

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.part.record import Part

EQUAL_MOMENTS_TOLERANCE = 1e-6  # [1] principal moments closer than this, by the largest, count as equal


@dataclass(frozen=True, eq=False)
class Solid:
    """Volume integrals of a surface, for unit density."""

    volume: float  # [m3] negative where the surface faces inwards
    centre: Floats  # (3,) [m] centroid
    inertia: Floats  # (3, 3) [m5] about the centroid; times the density, [kg m2]

    @property
    def inside_out(self) -> "Solid":
        """Return the same solid with its surface turned inside out."""
        return Solid(-self.volume, self.centre, -self.inertia)

    def scale(self, factor: float) -> "Solid":
        """Return the same solid measured in a unit of ``factor`` metres.

        Parameters
        ----------
        factor : float [m]
            The length of the unit that the solid is measured in so far.

        Returns
        -------
        Solid
        """
        return Solid(self.volume * factor**3, self.centre * factor, self.inertia * factor**5)


def integrate_solid(corners: Floats) -> Solid:
    """Return volume, centroid and inertia enclosed by triangles.

    Sums over the tetrahedra between the triangles and a point near them: exact for a polyhedron, and free of
    cancellation however far from the origin the part lies.

    Parameters
    ----------
    corners : (F, 3, 3) float [m]
        Corners by triangle, counter-clockwise seen from outside; together the triangles close. In another
        unit of length the results are in its powers.

    Returns
    -------
    Solid

    Raises
    ------
    ValueError
        If the shape is wrong or an entry is not finite.

    References
    ----------
    A. M. Messner, G. Q. Taylor, "Algorithm 550: Solid polyhedron measures", ACM Trans. Math. Softw. 6(1),
    121-130, 1980.
    """
    corners = check.shaped("corners", corners, (-1, 3, 3))

    near, (a, b, c), six = _spanned_tetrahedra(corners)
    volume = float(six.sum()) / 6.0
    total = a + b + c
    first = vectors.product(six, total) / 24.0
    parts = [vectors.product((p * six[:, None]).T, p) for p in (a, b, c, total)]
    second = sum(parts) / 120.0  # integral of x x^T
    offset = first / volume if volume else np.zeros(3)
    second = second - volume * np.outer(offset, offset)
    return Solid(volume, near + offset, np.trace(second) * np.eye(3) - second)


def tetrahedron_volumes(corners: Floats) -> Floats:
    """Return the signed volumes between triangles and the middle of them all.

    Parameters
    ----------
    corners : (F, 3, 3) float [m]
        Corners by triangle, counter-clockwise seen from outside.

    Returns
    -------
    (F,) float [m3]
        a . (b x c) / 6 of each, with corners a, b, c from that middle. The sum over a closed surface is its
        volume.
    """
    return _spanned_tetrahedra(corners)[2] / 6.0


def _spanned_tetrahedra(corners: Floats) -> tuple[Floats, tuple[Floats, Floats, Floats], Floats]:
    """A point in the midst of triangles, their corners from there, six times the volumes between."""
    near = np.array([0.5 * (corners[..., k].min() + corners[..., k].max()) for k in range(3)])
    a, b, c = (corners[:, k] - near for k in range(3))
    return near, (a, b, c), np.einsum("fi,fi->f", a, vectors.cross(b, c))


def shift_inertia(inertia: Floats, mass: float, offset: Floats) -> Floats:
    """Return the inertia about a point other than the centre of mass.

    The parallel-axis theorem: I + m (d . d E - d d^T).

    Parameters
    ----------
    inertia : (3, 3) float [kg m2]
        I, about the centre of mass.
    mass : float [kg]
        m.
    offset : (3,) float [m]
        d, from the centre of mass to the point or the other way: its sign does not matter.

    Returns
    -------
    (3, 3) float [kg m2]

    Raises
    ------
    ValueError
        If a shape is wrong or an entry is not finite.
    """
    offset = check.shaped("offset", offset, (3,))
    return check.shaped("inertia", inertia, (3, 3)) + mass * (
        vectors.dot(offset, offset) * np.eye(3) - np.outer(offset, offset)
    )


def principal_inertia(inertia: Floats) -> tuple[Floats, Floats]:
    """Return principal moments and axes of an inertia.

    The largest component of the first two axes is positive; where moments are equal to within
    ``EQUAL_MOMENTS_TOLERANCE``, and any axes would do, they are those nearest to the file's.

    Parameters
    ----------
    inertia : (3, 3) float [kg m2]
        Symmetric.

    Returns
    -------
    moments : (3,) float [kg m2]
        Ascending.
    axes : (3, 3) float [1]
        Unit vectors, one a row, right-handed.

    Raises
    ------
    ValueError
        If the shape is wrong or an entry is not finite.
    """
    moments, columns = vectors.eigen(check.shaped("inertia", inertia, (3, 3)))
    same = np.diff(moments) <= EQUAL_MOMENTS_TOLERANCE * abs(moments[2])
    axes = columns.T
    if same.all():
        return moments, np.eye(3)
    if same[0]:
        axes = np.array([*_perpendicular_axes(axes[2]), axes[2]])
    elif same[1]:
        axes = np.array([axes[0], *_perpendicular_axes(axes[0])])
    # of each axis or its opposite the one whose largest component is positive
    first, second = (a if a[np.argmax(np.abs(a).round(9))] > 0.0 else -a for a in axes[:2])
    return moments, np.array([first, second, vectors.cross(first, second)])


def _perpendicular_axes(axis: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors across an axis, the first as near to a file axis as can be."""
    nearest = np.eye(3)[np.argmin(np.abs(axis).round(9))]
    first = vectors.unit(nearest - vectors.dot(nearest, axis) * axis)
    return first, vectors.cross(axis, first)


@dataclass(frozen=True, eq=False)
class MassBalance:
    """Spread of a part's mass and shape; None where a part card is silent."""

    inertia_at_origin: Floats  # (3, 3) [kg m2] along the file's axes
    moments: Floats  # (3,) [kg m2] principal, about the centre of mass, ascending
    axes: Floats  # (3, 3) [1] principal axes, one a row, right-handed
    hull_volume: float | None  # [m3]
    corner: Floats | None  # (3,) [m] of the bounding box, the lowest
    extents: Floats | None  # (3,) [m] of the bounding box


def mass_balance(part: Part) -> MassBalance:
    """Return the mass properties of a part that ``Part`` does not hold itself.

    Parameters
    ----------
    part : Part

    Returns
    -------
    MassBalance
        Without the fields of the surface for a part card.
    """
    moments, axes = principal_inertia(part.inertia)
    at_origin = shift_inertia(part.inertia, part.mass, part.centre_of_mass)
    if part.vertices is None:
        return MassBalance(at_origin, moments, axes, None, None, None)
    corner, extents = part.vertices.min(axis=0), np.ptp(part.vertices, axis=0)
    hull_volume = None if part.hull is None else part.hull.volume
    return MassBalance(at_origin, moments, axes, hull_volume, corner, extents)


MOMENT_ORDER = 6
HALF_ORDER_MONOMIALS = [
    powers for powers in product(range(4), repeat=3) if sum(powers) <= MOMENT_ORDER // 2
]  # 20 monomials
MONOMIAL_FACTORS = [  # of each but the first: the earlier monomial that makes it with one more factor; which
    (HALF_ORDER_MONOMIALS.index(tuple(power - (k == axis) for k, power in enumerate(powers))), axis)
    for powers in HALF_ORDER_MONOMIALS[1:]
    for axis in [max(k for k in range(3) if powers[k])]
]
MONOMIAL_PRODUCTS = {  # powers up to the order: two of those monomials that make them
    tuple(int(power) for power in np.add(p, q)): (i, j)
    for (i, p), (j, q) in product(enumerate(HALF_ORDER_MONOMIALS), repeat=2)
}
MOMENT_POWERS = np.array(
    sorted((p for p in product(range(MOMENT_ORDER + 1), repeat=3) if 1 <= sum(p) <= MOMENT_ORDER), key=sum)
).T
MULTINOMIAL_COEFFICIENTS = np.array(
    [factorial(sum(p)) // (factorial(p[0]) * factorial(p[1]) * factorial(p[2])) for p in MOMENT_POWERS.T]
)
MIDDLE_FACET_SIZE, SMALL_FACET_SIZE = 0.5, 0.16  # of the part: below it a rule of order four, or two
QUADRATURE_BLOCK = 1 << 13  # points at a time: what a processor's cache holds
HALF_SPHERE_DIRECTIONS = 24  # spread over half the sphere


class Moments:
    """Moments of a solid about its centre of mass, blind to how its surface is cut into triangles.

    The d-th directional moment, the integral of (x . u)^d over the solid, is a polynomial in u. A rotation
    is a symmetry of the solid only if it leaves all of them alone; up to order six they tell any features
    apart but those repeated seven times or more about one axis.
    """

    def __init__(self, vertices: Floats, faces: Ints, centre: Floats) -> None:
        """Moments about the centre of mass (3,) [m] of a closed surface, integrated when first asked for.

        ``vertices`` (V, 3) [m]; ``faces`` (F, 3) int: counter-clockwise seen from outside.
        """
        self._surface = np.asarray(vertices) - centre, np.asarray(faces)
        self.error = 1e-4  # [1] of the quadrature, of float32 files and of uneven tessellation

    @cached_property
    def _integrals(self) -> tuple[Floats, float]:
        """(7, 7, 7) integrals of x^a y^b z^c over the solid by its volume, scaled by its size; its size.

        From surface integrals of x^a y^b z^c (x . n): by Euler's theorem they are (a + b + c + 3) times the
        solid's.
        """
        points, faces = self._surface
        scale = vectors.norm(points).mean()
        points, facets = np.ascontiguousarray(points.T) / scale, faces.T
        # nodes (3, N) of the surface, the weight (N,) of each times the distance of its facet's plane
        a, b, c = (points[:, corner] for corner in facets)
        ab, bc, ca = b - a, c - b, a - c
        flux = 0.5 * vectors.dot_columns(a, vectors.cross_columns(ca, ab))
        extent = np.abs([ab, bc, ca]).max(axis=(0, 1))
        large, small = extent >= MIDDLE_FACET_SIZE, extent < SMALL_FACET_SIZE
        nodes, shares = [], []
        for some, (barycentric, parts) in zip((large, ~(large | small)), _rules()):  # inside each facet
            if some.any():
                i, j, k = barycentric.T[:, :, None]
                p, q, r = (corner[:, some][:, None] for corner in (a, b, c))
                nodes.append((i * p + j * q + k * r).reshape(3, -1))
                shares.append((parts[:, None] * flux[some]).ravel())
        if small.any():  # exact to order two: three quarters at the centroid, the rest at the corners
            few, flux = facets[:, small], flux[small]
            p, q, r = (points[:, corner] for corner in few)
            shared = np.bincount(few.ravel(), np.tile(flux / 12.0, 3))
            used = np.flatnonzero(shared)
            nodes += [(p + q + r) / 3.0, points[:, used]]
            shares += [0.75 * flux, shared[used]]
        places, weights = np.concatenate(nodes, axis=1), np.concatenate(shares)
        table = np.zeros((MOMENT_ORDER + 1, MOMENT_ORDER + 1, MOMENT_ORDER + 1))
        for start in range(0, len(weights), QUADRATURE_BLOCK):
            # products of coordinates up to half the order
            some = places[:, start : start + QUADRATURE_BLOCK]
            half = np.ones((len(HALF_ORDER_MONOMIALS), some.shape[1]))
            for row, (before, axis) in zip(half[1:], MONOMIAL_FACTORS):
                np.multiply(half[before], some[axis], out=row)
            weighted = half * weights[start : start + QUADRATURE_BLOCK]
            for powers, (i, j) in MONOMIAL_PRODUCTS.items():
                table[powers] += np.einsum("n,n->", weighted[i], half[j])
        volume, second = table[0, 0, 0] / 3.0, (table[2, 0, 0] + table[0, 2, 0] + table[0, 0, 2]) / 5.0
        size = np.sqrt(abs(second / volume))  # facets that overlap may leave either negative
        order = np.indices(table.shape).sum(axis=0)
        return table / (order + 3.0) / size**order / volume, scale * size

    @property
    def size(self) -> float:
        """Return the root mean square distance from the centre of mass [m], the unit of the moments."""
        return self._integrals[1]

    def directional(self, directions: Floats) -> Floats:
        """Return the directional moments of orders 1 to 6: integrals of (x . u)^d over the solid.

        Parameters
        ----------
        directions : (..., 3) float [1]
            Unit vectors u.

        Returns
        -------
        (..., 6) float [size ** order]
        """
        moments, _ = self._integrals
        a, b, c = MOMENT_POWERS
        power = np.ones((*directions.shape[:-1], MOMENT_ORDER + 1, 3))
        power[..., 1:, :] = directions[..., None, :]
        power = np.cumprod(power, axis=-2)
        terms = MULTINOMIAL_COEFFICIENTS * moments[a, b, c] * power[..., a, 0] * power[..., b, 1]
        terms = terms * power[..., c, 2]
        orders = np.searchsorted(MOMENT_POWERS.sum(axis=0), np.arange(1, MOMENT_ORDER + 1))
        return np.add.reduceat(terms, orders, axis=-1)

    def mismatch(self, rotations: Floats) -> Floats:
        """Return how far rotations are from being symmetries of the solid.

        It is the largest change of a directional moment divided by its order, over ``HALF_SPHERE_DIRECTIONS``
        directions. A feature of 1e-3 of the volume, as far out as the size, that finds no counterpart gives
        about 1e-3; compare with ``error``.

        Parameters
        ----------
        rotations : (N, 3, 3) float [1]

        Returns
        -------
        (N,) float [1]
        """
        k = np.arange(HALF_SPHERE_DIRECTIONS) + 0.5
        z, turn = k / HALF_SPHERE_DIRECTIONS, np.pi * (1.0 + np.sqrt(5.0)) * k
        r = np.sqrt(1.0 - z * z)
        directions = np.column_stack([r * np.cos(turn), r * np.sin(turn), z])
        turned = np.einsum("nij,kj->nki", np.asarray(rotations), directions)
        change = np.abs(self.directional(turned) - self.directional(directions))
        return (change / np.arange(1, MOMENT_ORDER + 1)).max(axis=(1, 2))


@cache
def _rules() -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
    """Nodes (N, 3), barycentric, and weights (N,) of orders six and four.

    Gauss's rule on the square, folded to triangles; the six nodes of G. R. Cowper, "Gaussian quadrature
    formulas for triangles", Int. J. Numer. Methods Eng. 7(3), 1973.
    """
    x, w = np.polynomial.legendre.leggauss(4)
    u, v = (g.ravel() for g in np.meshgrid(0.5 * (x + 1.0), 0.5 * (x + 1.0), indexing="ij"))
    folded = np.column_stack([u, v * (1.0 - u), (1.0 - u) * (1.0 - v)])
    root, sign = np.sqrt(10.0), np.array([1.0, -1.0])
    near = (8.0 - root + sign * np.sqrt(38.0 - 44.0 * np.sqrt(0.4))) / 18.0
    shares = (620.0 + sign * np.sqrt(213125.0 - 53320.0 * root)) / 3720.0
    six = near[:, None, None] + (1.0 - 3.0 * near[:, None, None]) * np.eye(3)
    return (folded, 0.5 * np.outer(w, w).ravel() * (1.0 - u)), (six.reshape(-1, 3), np.repeat(shares, 3))
