"""Convex hull of a part, seen from its centre of mass."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints, Points, Triangles, Vector
from feederscrew.base.errors import MeshError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.vectors import solid_angles
from feederscrew.base.heavy import heavy

spatial = heavy("scipy.spatial")

STRAIGHT_ANGLE_RAD = 3e-4  # a corner at which edges or facets turn by less is one of the file's rounding
CONE_TIP_EDGES = 24  # edges at a corner from which it is the tip of a cone, and never on a straight edge
HULL_VOLUME_TOLERANCE = 1e-5  # [1] of the volume: what leaving such corners out may change


@dataclass(frozen=True, eq=False)
class Hull:
    """Triangulated convex hull about the centre of mass; T triangles, V corners."""

    vertices: Points  # (V, 3) [m] minus the centre of mass
    triangles: Triangles  # (T, 3) indices, counter-clockwise seen from outside
    neighbours: Ints  # (T, 3) the triangle across the edge opposite corner k
    normals: Floats  # (T, 3) outward unit normals
    heights: Floats  # (T,) [m] of the centre of mass over each triangle's plane
    areas: Floats  # (T,) [m2]
    volume: float  # [m3]
    volume_of_all: float  # [m3] of the hull of all corners, those left out for rounding too
    radius: float  # [m] largest distance from the centre of mass to a corner

    @property
    def corners(self) -> Floats:
        """(T, 3, 3) [m] corners by triangle."""
        return self.vertices[self.triangles]

    @cached_property
    def solid_angles(self) -> Floats:
        """(T,) [sr] of each triangle, seen from the centre of mass."""
        return check.frozen(solid_angles(np.zeros(3), self.corners))


class CentreOutsideError(MeshError):
    """A centre of mass that is on or outside the part's convex hull."""


def convex_hull(points: Points, centre: Vector, where: str = "part", centre_given: bool = True) -> Hull:
    """Return the convex hull of a point set about a centre of mass inside it.

    Corners on a straight edge or in a plane, but for what the file was rounded to, are left out: a surface
    that was split has the hull of the surface that was not.

    Parameters
    ----------
    points : (V, 3) float [m]
        Corners of the part's surface.
    centre : (3,) float [m]
        Centre of mass, in the same axes.
    where : str, optional
        The file, for the error line.
    centre_given : bool, optional
        Whether the user gave the centre of mass; else it is that of the surface. The error line says how to
        mend it accordingly.

    Returns
    -------
    Hull

    Raises
    ------
    MeshError
        If the points span no volume.
    CentreOutsideError
        If the centre of mass is on or outside the hull.

    References
    ----------
    C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The quickhull algorithm for convex hulls", ACM Trans. Math.
    Softw. 22(4), 469-483, 1996.
    """
    centre = check.shaped("centre", centre, (3,))
    points = check.shaped("points", points, (-1, 3)) - centre
    try:
        qhull = spatial.ConvexHull(points)
        volume_of_all = float(qhull.volume)
        triangles, neighbours, areas = _orient_triangles(points, qhull)
        # corners of the hull at which it turns, by more than rounding
        origins, targets = triangles[:, [1, 2, 0]].ravel(), triangles[:, [2, 0, 1]].ravel()
        degrees = np.bincount(origins, minlength=len(points))
        some = np.flatnonzero(degrees[origins] < CONE_TIP_EDGES)
        some = some[np.argsort(origins[some], kind="stable")]
        origins, directions = origins[some], vectors.unit(points[targets[some]] - points[origins[some]])
        real = degrees > 0
        for shift in range(1, CONE_TIP_EDGES - 1):  # pairs of edges of a corner, so many apart in its list
            pairs = np.flatnonzero(origins[shift:] == origins[:-shift])
            bent = vectors.norm(directions[pairs] + directions[pairs + shift])
            real[origins[pairs[bent < STRAIGHT_ANGLE_RAD]]] = False
        # corners whose triangles all lie in one plane, but for rounding
        a, b, c = (points[corner] for corner in triangles.T)
        corners, tiny = triangles.ravel(), np.finfo(float).tiny
        each = np.repeat(vectors.cross(b - a, c - a), 3, axis=0)
        mean = np.stack([np.bincount(corners, column, len(points)) for column in each.T], axis=1)
        each, mean = (some / np.maximum(vectors.norm(some), tiny)[:, None] for some in (each, mean))
        off = np.zeros(len(points))
        np.maximum.at(off, corners, vectors.norm(each - mean[corners]))
        real &= off >= STRAIGHT_ANGLE_RAD
        if not real[triangles].all():
            fewer = spatial.ConvexHull(points[real])
            if abs(fewer.volume - qhull.volume) < HULL_VOLUME_TOLERANCE * qhull.volume:
                points, qhull = points[real], fewer
                triangles, neighbours, areas = _orient_triangles(points, qhull)
    except (spatial.QhullError, ValueError) as error:
        raise MeshError(where, "the part has no volume", "export it as a closed solid") from error
    used = np.zeros(len(points), dtype=bool)  # Qhull lists points in the middle of a facet among its vertices
    used[triangles] = True
    vertices = points[used]
    radius = float(vectors.norm(vertices).max())
    heights = -qhull.equations[:, 3]
    if heights.min() <= 1e-9 * radius:
        raise CentreOutsideError(
            where,
            "the centre of mass is not inside the part's convex hull",
            "check `centre_of_mass` and its units" if centre_given else "export it as a closed solid",
        )
    return Hull(
        vertices=check.frozen(vertices),
        triangles=check.frozen((np.cumsum(used) - 1)[triangles]),
        neighbours=check.frozen(neighbours),
        normals=check.frozen(qhull.equations[:, :3].copy()),
        heights=check.frozen(heights),
        areas=check.frozen(areas),
        volume=float(qhull.volume),
        volume_of_all=volume_of_all,
        radius=radius,
    )


def _orient_triangles(points: Points, qhull: Any) -> tuple[Ints, Ints, Floats]:
    """Triangles turned counter-clockwise seen from outside, their neighbours with them; and their areas."""
    a, b, c = (points[corner] for corner in qhull.simplices.T)
    cross = vectors.cross(b - a, c - a)
    inward = np.einsum("ti,ti->t", cross, qhull.equations[:, :3]) < 0.0
    triangles, neighbours = (
        np.column_stack([k, np.where(inward, m, j), np.where(inward, j, m)])
        for k, j, m in (qhull.simplices.T, qhull.neighbors.T)
    )
    return triangles, neighbours, 0.5 * vectors.norm(cross)
