"""Volume, mass, centre of mass and inertia of a solid from its surface."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors

SAME = 1e-6  # [1] principal moments closer than this, by the largest, count as equal


@dataclass(frozen=True, eq=False)
class Solid:
    """What the volume integrals of a surface give, for unit density."""

    volume: float  # [m3] negative where the surface faces inwards
    centre: np.ndarray  # (3,) [m] centroid
    inertia: np.ndarray  # (3, 3) [m5] about the centroid; times the density, [kg m2]

    @property
    def reversed(self):
        """The same solid with its surface turned inside out."""
        return Solid(-self.volume, self.centre, -self.inertia)

    def scaled(self, factor):
        """Return the same solid measured in a unit of ``factor`` metres."""
        return Solid(self.volume * factor**3, self.centre * factor, self.inertia * factor**5)


def solid(corners):
    """Return volume, centroid and inertia enclosed by triangles.

    Parameters
    ----------
    corners : (F, 3, 3) float [m]
        Corners by triangle, counter-clockwise seen from outside; together they close.

    Returns
    -------
    Solid

    Raises
    ------
    ValueError
        If the shape is wrong or an entry is not finite.

    Notes
    -----
    Sums over the tetrahedra between the triangles and a point near them: exact for a polyhedron, and
    free of cancellation however far from the origin the part lies.

    References
    ----------
    A. M. Messner, G. Q. Taylor, "Algorithm 550: Solid polyhedron measures", ACM Trans. Math. Softw.
    6(1), 121-130, 1980.
    """
    corners = check.shaped("corners", corners, (-1, 3, 3))

    near, (a, b, c), six = _spanned(corners)
    volume = float(six.sum()) / 6.0
    total = a + b + c
    first = vectors.product(six, total) / 24.0
    parts = [vectors.product((p * six[:, None]).T, p) for p in (a, b, c, total)]
    second = sum(parts) / 120.0  # integral of x x^T
    offset = first / volume if volume else np.zeros(3)
    second = second - volume * np.outer(offset, offset)
    return Solid(volume, near + offset, np.trace(second) * np.eye(3) - second)


def tetrahedra(corners):
    """Return the signed volume between each triangle and the middle of them all.

    Parameters
    ----------
    corners : (F, 3, 3) float [m]

    Returns
    -------
    (F,) float [m3]
        The sum over a closed surface is its volume.
    """
    return _spanned(corners)[2] / 6.0


def _spanned(corners):
    """A point in the midst of triangles, their corners from there, six times the volumes between."""
    near = np.array([0.5 * (corners[..., k].min() + corners[..., k].max()) for k in range(3)])
    a, b, c = (corners[:, k] - near for k in range(3))
    return near, (a, b, c), np.einsum("fi,fi->f", a, vectors.cross(b, c))


def shifted(inertia, mass, offset):
    """Return the inertia about a point other than the centre of mass.

    Parameters
    ----------
    inertia : (3, 3) float [kg m2]
        About the centre of mass.
    mass : float [kg]
    offset : (3,) float [m]
        From one point to the other, either way.

    Returns
    -------
    (3, 3) float [kg m2]
        By the parallel-axis theorem.
    """
    offset = check.shaped("offset", offset, (3,))
    return check.shaped("inertia", inertia, (3, 3)) + mass * (
        vectors.dot(offset, offset) * np.eye(3) - np.outer(offset, offset)
    )


def principal(inertia):
    """Return principal moments and axes.

    Parameters
    ----------
    inertia : (3, 3) float [kg m2]
        Symmetric.

    Returns
    -------
    moments : (3,) float [kg m2]
        Ascending.
    axes : (3, 3) float [1]
        One axis a row, right-handed. The largest component of the first two is positive; where moments
        are equal, and any axes would do, those nearest to the file's.
    """
    moments, columns = vectors.eigen(check.shaped("inertia", inertia, (3, 3)))
    same = np.diff(moments) <= SAME * abs(moments[2])
    axes = columns.T
    if same.all():
        return moments, np.eye(3)
    if same[0]:
        axes = np.array([*_across(axes[2]), axes[2]])
    elif same[1]:
        axes = np.array([axes[0], *_across(axes[0])])
    first, second = (_pointing(axis) for axis in axes[:2])
    return moments, np.array([first, second, vectors.cross(first, second)])


def _across(axis):
    """Two unit vectors across an axis, the first as near to a file axis as can be."""
    nearest = np.eye(3)[np.argmin(np.abs(axis).round(9))]
    first = vectors.unit(nearest - vectors.dot(nearest, axis) * axis)
    return first, vectors.cross(axis, first)


def _pointing(axis):
    """The axis or its opposite: the one whose largest component is positive."""
    largest = np.argmax(np.abs(axis).round(9))
    return axis if axis[largest] > 0.0 else -axis
