"""What the drop kernel needs to know of a part, without dimensions.

Source: Newton and Euler for a rigid body; docs/resting.md, "The drop test".
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from feederscrew import check
from feederscrew.dropping.rims import AXIS, CENTRE, MIDDLE, RADIUS, rims_of, true_heights, true_tops
from feederscrew.geometry import vectors
from feederscrew.resting.basins import barriers
from feederscrew.resting.basins.landscape import SMOOTH_ANGLE
from feederscrew.resting.tumbling.exact import tumble
from feederscrew.resting.tumbling.half_edges import Edges, half_edges, saddles, sinks


class RoundedHull(NamedTuple):
    """A convex body about its centre of mass, along its principal axes; V corners, R rims.

    A named tuple, so that compiled code can read it.
    """

    vertices: np.ndarray  # (V, 3)
    links: np.ndarray  # (V + 1 + 2 E,) where each corner's neighbours start in this array; neighbours
    inertia: np.ndarray  # (3,) principal moments at mass 1
    radius: float  # largest distance of a point
    rims: np.ndarray  # (R, RIM) circles and arcs, as ``Rims.table``
    inner: np.ndarray  # (V,) bool: corners that rims replace
    corners: int  # how many are left
    sag: float  # how far a rim bulges over its corners' edges


class Shape(NamedTuple):
    """What the drop kernel knows of a part, in units of its own length; F faces, M facets."""

    solid: RoundedHull
    edges: Edges
    faces: np.ndarray  # (M,) face of each facet the part rests on, -1 for the others
    heights: np.ndarray  # (F,) of the centre of mass
    barriers: np.ndarray  # (F,) lowest lift that tips the part off the face
    margins: np.ndarray  # (F,) from the foot of the centre of mass to the nearest edge; 0 for a rolling face
    rolls: np.ndarray  # (F,) bool
    axes: np.ndarray  # (F, 3) axis of a rolling face
    ceiling: float  # energy over which no face is decided
    flat: np.ndarray  # (3,) normal of the greatest facet

    @property
    def vertices(self):
        """Return the (V, 3) corners."""
        return self.solid.vertices

    @property
    def inertia(self):
        """Return the (3,) principal moments at mass 1."""
        return self.solid.inertia


def shape_of(hull, labels, mass, inertia, axes=None):
    """Return the shape of a hull, and the length that makes it dimensionless.

    Source: docs/resting.md, "The drop test".

    Parameters
    ----------
    hull : Hull
    labels : (T,) int
        Face of each hull triangle, -1 for none.
    mass : float [kg]
    inertia : (3, 3) float [kg m2]
        About the centre of mass, in the hull's axes.
    axes : (F, 3) float [1], optional
        Unit axis of each rolling face, NaN for flat ones; none rolls by default.

    Returns
    -------
    shape : Shape
    length : float [m]
        Cube root of the hull's volume.
    """
    length, mass = float(np.cbrt(hull.volume)), check.positive("mass", mass)
    moments, principal = principal_axes(check.shaped("inertia", inertia, (3, 3)))
    edges = half_edges(hull)
    rims = rims_of(edges, hull.radius, () if axes is None else axes)
    tumbling = _rounded(tumble(hull), edges, rims, hull.radius)
    tips = barriers.tipping(tumbling, labels)
    lifts = barriers.barriers(tips) / length
    heights = np.nan_to_num(tips.heights / length)
    count = len(heights)
    axes = np.full((count, 3), np.nan) if axes is None else np.array(axes, float)
    rolls = np.isfinite(axes).all(axis=1)
    edges = _turned(edges, principal, length)
    shape = Shape(
        solid=_solid(hull, edges, rims, moments / (mass * length**2), principal, length),
        edges=edges,
        faces=check.frozen(_faces(edges, tumbling, labels)),
        heights=check.frozen(heights),
        barriers=check.frozen(lifts),
        margins=check.frozen(np.where(rolls, 0.0, _margins(edges, tumbling, labels, count))),
        rolls=check.frozen(rolls),
        axes=check.frozen(vectors.product(np.nan_to_num(axes), principal)),
        ceiling=float((heights + lifts).max()),
        flat=check.frozen(_greatest(edges, hull.areas)),
    )
    return shape, length


def _rounded(tumbling, edges, rims, radius):
    """The tumbling with the heights of round sides and rims, not of the corners that stand for them."""
    facets = edges.facets[tumbling.sinks]
    return replace(
        tumbling,
        heights=true_heights(rims, edges, facets, tumbling.heights, radius),
        saddle_heights=true_tops(rims, edges, saddles(edges), tumbling.saddle_heights, radius),
    )


def _solid(hull, edges, rims, inertia, principal, length):
    """The body itself, in principal axes and units of the length."""
    table = np.array(rims.table)
    for vector in (CENTRE, AXIS, MIDDLE):
        table[:, vector] = vectors.product(rims.table[:, vector], principal)
    table[:, CENTRE] /= length
    table[:, RADIUS] /= length
    return RoundedHull(
        vertices=edges.vertices,
        links=check.frozen(_links(hull)),
        inertia=check.frozen(inertia),
        radius=hull.radius / length,
        rims=check.frozen(table),
        inner=rims.inner,
        corners=int((~rims.inner).sum()),
        sag=float(table[:, RADIUS].max() * (1.0 - np.cos(SMOOTH_ANGLE / 2))) if len(table) else 0.0,
    )


def _greatest(edges, areas):
    """(3,) normal of the greatest facet; of several as great the first."""
    sizes = np.bincount(edges.facets, areas)
    return edges.normals[np.argmax(sizes > (1.0 - 1e-6) * sizes.max())].copy()


def shape_of_part(part, found):
    """Return the shape of a part and its length [m], from its faces.

    Parameters
    ----------
    part : Part
    found : Ground

    Returns
    -------
    shape, length
        As `shape_of`.
    """
    axes = np.array([face.axis for face in found.faces])
    return shape_of(found.hull, found.labels, part.mass, part.inertia, axes)


def principal_axes(inertia):
    """Return the principal moments (3,) [any], ascending, and their axes, columns of a rotation (3, 3).

    Source: the eigenvectors of the inertia matrix.
    """
    moments, principal = vectors.eigen(inertia)
    return moments, principal * np.sign(vectors.determinant(principal))


def _turned(edges, principal, length):
    """Half-edges in principal axes and units of the length."""
    scaled = {
        "vertices": vectors.product(edges.vertices, principal) / length,
        "normals": vectors.product(edges.normals, principal),
        "slopes": edges.slopes / length**2,
        "sides": edges.sides / length**2,
    }
    return edges._replace(**{name: check.frozen(array) for name, array in scaled.items()})


def _links(hull):
    """Corners joined to each corner by an edge of a triangle: where each list starts, then the lists."""
    origins, targets = hull.triangles[:, [1, 2, 0]].ravel(), hull.triangles[:, [2, 0, 1]].ravel()
    order = np.argsort(origins, kind="stable")
    count = len(hull.vertices) + 1
    starts = np.searchsorted(origins[order], np.arange(count))
    return np.concatenate([starts + count, targets[order]]).astype(int)


def _faces(edges, tumbling, labels):
    faces = np.full(len(edges.normals), barriers.UNNAMED)
    faces[sinks(edges)] = barriers.named(tumbling, np.asarray(labels)[tumbling.sinks])
    return faces


def _margins(edges, tumbling, labels, count):
    """(F,) distance from the foot to the nearest edge, over the sinks of each face."""
    u, w = edges.vertices[edges.origins], edges.vertices[edges.targets]
    levers = edges.sides / np.linalg.norm(w - u, axis=1)
    by_facet = np.full(len(edges.normals), np.inf)
    owners = np.repeat(edges.facets, 3)
    np.minimum.at(by_facet, owners[edges.borders], levers[edges.borders])
    margins = np.full(count, np.inf)
    faces = _faces(edges, tumbling, labels)
    np.minimum.at(margins, faces[faces >= 0], by_facet[faces >= 0])
    return np.where(np.isfinite(margins), margins, 0.0)
