"""What the drop kernel needs of a part, without dimensions: its hull, and the round rims of it.

Rims are the circles and arcs that corners stand for. Source: Newton and Euler for a rigid body;
docs/resting.md, "The drop test".
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.resting import barriers
from feederscrew.resting.exact_tumbling import tumble
from feederscrew.resting.half_edges import Edges, half_edges, saddles, sinks
from feederscrew.resting.landscape import SMOOTH_ANGLE

CENTRE, AXIS, RADIUS, MIDDLE, OPENING, RIM = slice(0, 3), slice(3, 6), 6, slice(7, 10), 10, 11
MIN_ARC_EDGES = 4  # edges of an arc
STRAIGHT_CORNER_RAD = np.radians(0.2)  # a corner that turns less is a point on an edge
RIM_PLANE_SHARE = 1e-5  # of the radius of the hull: how far corners of one rim may lie off its plane
EVEN_EDGES_SHARE = 0.05  # by which edges and turns of one rim may differ; more and they are meant
RIM_CIRCLE_SHARE = 1e-3  # of its radius: how far corners may lie off their circle
CENTRED_RIM_SHARE = 1e-6  # of the radius of the hull: a rim whose axis passes the centre of mass


class Rims(NamedTuple):
    """Circles and arcs of a hull; R rims, V corners of the hull."""

    table: np.ndarray  # (R, RIM) centre, unit axis, radius, direction of the middle, cosine of half its angle
    members: np.ndarray  # (R, V) bool: corners on each rim
    inner: np.ndarray  # (V,) bool: corners the rims replace; an arc's two ends stay corners


def rims_of(edges, radius, axes=()) -> Rims:
    """Find the circles and arcs that corners of a hull are points of.

    Parameters
    ----------
    edges : Edges
    radius : float [m]
        Of the hull.
    axes : sequence of (3,) float [1], optional
        Unit axes to look along beside the normals of flat facets: those of rolling faces.

    Returns
    -------
    Rims

    Notes
    -----
    A rim is a run of coplanar corners at equal distances and turns of less than SMOOTH_ANGLE, the limit
    that parts a bar of flats from a round one elsewhere. A full turn is a circle.
    """
    count = len(edges.vertices)
    rims = []
    for axis in _axes(edges, axes):
        for corners in _planes(edges.vertices, axis, RIM_PLANE_SHARE * radius):
            rims += [(corners, rim) for rim in _runs(edges.vertices, corners, axis)]
    table = np.array([row for _, (row, *_) in rims]).reshape(-1, RIM)
    members = np.zeros((len(rims), count), bool)
    inner = np.zeros(count, bool)
    ends = np.zeros(count, bool)
    for k, (plane, (row, corners, closed)) in enumerate(rims):
        members[k, corners] = True
        inner[plane[_under(row, edges.vertices[plane])]] = True
        ends[[] if closed else corners[[0, -1]]] = True
    inner &= ~ends
    return Rims(check.frozen(table), check.frozen(members), check.frozen(inner))


def _under(row, points) -> NDArray[np.bool_]:
    """(K,) bool: which of (K, 3) points in the plane of a rim lie on it, or on the chords it replaces."""
    away = points - row[CENTRE]
    size = np.sqrt((away**2).sum(axis=1))
    near = np.abs(size / row[RADIUS] - 1.0) < 1.0 - np.cos(0.5 * SMOOTH_ANGLE)
    return near & (
        np.einsum("ki,i->k", away, row[MIDDLE]) >= size * row[OPENING] - RIM_CIRCLE_SHARE * row[RADIUS]
    )


def _axes(edges, more):
    """Unit axes worth looking along, one of each pair of opposite ones."""
    borders = np.bincount(edges.facets[np.flatnonzero(edges.borders) // 3], minlength=len(edges.normals))
    axes: list[np.ndarray] = []
    for axis in (*edges.normals[borders > MIN_ARC_EDGES], *more):
        if np.isfinite(axis).all() and all(np.abs(np.cross(axis, other)).max() > 1e-4 for other in axes):
            axes.append(np.asarray(axis))
    return axes


def _planes(vertices, axis, tolerance) -> list[NDArray[np.int64]]:
    """Corners of each plane across an axis that holds enough of them."""
    levels = np.einsum("vi,i->v", vertices, axis)
    order = np.argsort(levels, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(levels[order]) > tolerance) + 1)
    return [part for part in parts if len(part) > MIN_ARC_EDGES]


def _runs(vertices, corners, axis) -> list[Any]:
    """Row, corners and whether it is closed, of each rim of the corners in one plane."""
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.sqrt((first**2).sum())
    plane = np.stack([first, np.cross(axis, first)], axis=1)
    points = np.einsum("vi,ij->vj", vertices[corners], plane)
    middle = points.mean(axis=0)
    order = np.argsort(np.arctan2(*(points - middle).T[::-1]), kind="stable")
    corners, points = corners[order], points[order]
    bent = _turns(points) > STRAIGHT_CORNER_RAD
    corners, points = corners[bent], points[bent]
    steps = np.roll(points, -1, axis=0) - points
    if len(points) <= MIN_ARC_EDGES:
        return []
    lengths = np.hypot(*steps.T)
    rims = [_rim(vertices, corners[run], axis, closed) for run, closed in _even(lengths, _turns(points))]
    return [rim for rim in rims if rim is not None]


def _turns(points) -> NDArray[np.float64]:
    """(K,) by how much a polygon turns at each of its (K, 2) corners."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    return np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))


def _even(lengths, turns) -> list[Any]:
    """Runs of corners of a polygon between even edges, and whether each goes all around.

    ``lengths`` (K,) of the edge from each corner to the next, ``turns`` (K,) at each corner.
    """
    before = np.roll(lengths, 1)
    smooth = (
        (np.abs(turns) < SMOOTH_ANGLE)
        & (turns > 0.0)
        & (np.abs(before - lengths) < EVEN_EDGES_SHARE * lengths)
    )
    count = len(lengths)
    if smooth.all():
        return [(np.arange(count), True)]
    start = int(np.argmin(smooth))  # a corner that ends a run
    runs, run = [], list[int]()
    for k in range(1, count + 1):
        corner = (start + k) % count
        if smooth[corner] and (
            not run or abs(turns[corner] - turns[run[0]]) < EVEN_EDGES_SHARE * turns[run[0]]
        ):
            run.append(corner)
            continue
        runs.append(run)
        run = [corner] if smooth[corner] else []
    return [
        (np.array([(run[0] - 1) % count, *run, (run[-1] + 1) % count]), False)
        for run in runs
        if len(run) + 1 >= MIN_ARC_EDGES
    ]


def _rim(vertices, corners, axis, closed) -> Any:
    """Row, corners and whether it is closed; None where they are on no circle."""
    points = vertices[corners]
    third = len(corners) // 3
    a, b, c = points[[0, third, 2 * third]] if closed else points[[0, len(corners) // 2, -1]]
    centre, radius = _circle(a, b, c)
    away = points - centre
    off = np.abs(np.sqrt((away**2).sum(axis=1)) - radius).max()
    if off > RIM_CIRCLE_SHARE * radius:
        return None
    middle = away[0] if closed else away[[0, -1]].sum(axis=0)
    middle, opening = (away[0], -2.0) if closed else _open(away)
    middle = middle / np.sqrt((middle**2).sum())
    return np.concatenate([centre, axis, [radius], middle, [opening]]), corners, closed


def _open(away) -> tuple[NDArray[np.float64], float]:
    """Direction of an arc's middle, and the cosine of half its angle, from (K, 3) radii."""
    half = len(away) // 2
    middle = away[half] if len(away) % 2 else away[half - 1] + away[half]
    size = np.sqrt((middle**2).sum() * (away[0] ** 2).sum())
    return middle, float((away[0] * middle).sum() / size)


def _circle(a, b, c) -> tuple[NDArray[np.float64], float]:
    """Centre and radius of the circle through three points."""
    u, v = b - a, c - a
    normal = np.cross(u, v)
    size = (normal**2).sum()
    arm = ((u**2).sum() * np.cross(v, normal) + (v**2).sum() * np.cross(normal, u)) / (2.0 * size)
    return a + arm, float(np.sqrt((arm**2).sum()))


def true_heights(rims, edges, sinks, heights, radius) -> NDArray[np.float64]:
    """Return heights of the centre of mass on sinks, strips between rims as the round side they stand for.

    Source: own; docs/resting.md, "The drop test".

    Parameters
    ----------
    rims : Rims
    edges : Edges
    sinks : (S,) int
        Facets.
    heights : (S,) float [m]
        On the hull as it is.
    radius : float [m]
        Of the hull.

    Returns
    -------
    (S,) float [m]
    """
    corrected = np.array(heights)
    triangles = np.split(np.argsort(edges.facets, kind="stable"), np.cumsum(np.bincount(edges.facets))[:-1])
    for k, facet in enumerate(sinks if len(rims.table) else ()):
        halves = (3 * triangles[facet][:, None] + np.arange(3)).ravel()
        corners = np.unique(edges.origins[halves[edges.borders[halves]]])
        side = _side(rims, edges.vertices, corners, radius)
        if side is not None:
            corrected[k] = _tangent_height(side[0], side[1], radius)
    return corrected


def _side(rims, vertices, corners, radius) -> Any:
    """(2, 2) place along the axis and radius of the rims a strip joins, and their offset from it; or None."""
    on = np.flatnonzero(rims.members[:, corners].sum(axis=1) == 2)
    ends = [rims.table[k] for k in on]
    left = corners[~rims.members[on][:, corners].any(axis=0)] if len(on) else corners
    if len(ends) == 1 and len(left) == 1:  # a cone's tip
        ends.append(np.concatenate([vertices[left[0]], ends[0][AXIS], [0.0], ends[0][MIDDLE], [-2.0]]))
        left = left[1:]
    if len(ends) != 2 or len(left):
        return None
    axis = ends[0][AXIS]
    along = [(end[CENTRE] * axis).sum() for end in ends]
    offsets = [end[CENTRE] - level * axis for end, level in zip(ends, along)]
    if np.abs(offsets[0] - offsets[1]).max() > RIM_CIRCLE_SHARE * radius:
        return None
    if not all(_reaches(end, -offsets[0], radius) for end in ends):
        return None
    return np.array([[level, end[RADIUS]] for end, level in zip(ends, along)]), _size(offsets[0])


def _size(vector) -> float:
    return float(np.sqrt((vector**2).sum()))


def _reaches(rim, direction, radius) -> bool:
    """Whether an arc has a point in a direction from its axis; a direction of no length is any."""
    size = _size(direction)
    return size < CENTRED_RIM_SHARE * radius or (direction * rim[MIDDLE]).sum() >= size * rim[OPENING]


def _tangent_height(ends, offset, radius) -> float:
    """Height of the centre of mass over the plane that touches two rims, the least of all around the axis."""
    (s, r), (t, q) = ends
    length = np.hypot(t - s, q - r)
    across, along = abs(t - s) / length, (r - q) * np.sign(t - s) / length  # of the plane's normal
    return along * s + across * (r - offset)


def true_tops(rims, edges, saddles, tops, radius) -> NDArray[np.float64]:
    """Return heights of the centre of mass over saddles, chords of a rim as the circle they stand for.

    Source: own; docs/resting.md, "The drop test".

    Parameters
    ----------
    rims : Rims
    edges : Edges
    saddles : (E,) int
        Half-edges.
    tops : (E,) float [m]
        On the hull as it is.
    radius : float [m]
        Of the hull.

    Returns
    -------
    (E,) float [m]
    """
    corrected = np.array(tops)
    for rim, members in zip(rims.table, rims.members):
        chords = members[edges.origins[saddles]] & members[edges.targets[saddles]]
        level = (rim[CENTRE] * rim[AXIS]).sum()
        offset = rim[CENTRE] - level * rim[AXIS]
        if chords.any() and _size(offset) < rim[RADIUS] and _reaches(rim, -offset, radius):
            corrected[chords] = np.hypot(level, rim[RADIUS] - _size(offset))
    return corrected


def lowest_on(shape, up) -> Any:
    """Return the lowest point of each rim.

    Parameters
    ----------
    shape : Shape
    up : (N, 3) float [1]
        Unit directions in body axes.

    Returns
    -------
    (N, R, 3) float [L]
        Of an arc that does not reach so low, the point in its middle.
    """
    rims = shape.solid.rims
    along = np.einsum("ni,ri->nr", up, rims[:, AXIS])
    down = along[:, :, None] * rims[:, AXIS] - up[:, None]
    steep = np.sqrt((down**2).sum(axis=2))[:, :, None]
    down = np.where(steep > 1e-9, down / np.maximum(steep, 1e-9), rims[:, MIDDLE])
    inside = (down * rims[:, MIDDLE]).sum(axis=2) >= rims[:, OPENING]
    down = np.where(inside[:, :, None], down, rims[:, MIDDLE])
    return rims[:, CENTRE] + rims[:, RADIUS, None] * down


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
    def vertices(self) -> NDArray[np.float64]:
        """Return the (V, 3) corners."""
        return self.solid.vertices

    @property
    def inertia(self) -> NDArray[np.float64]:
        """Return the (3,) principal moments at mass 1."""
        return self.solid.inertia


def shape_of(hull, labels, mass, inertia, axes=None) -> tuple[Shape, float]:
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


def _solid(hull, edges, rims, inertia, principal, length) -> RoundedHull:
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


def _greatest(edges, areas) -> NDArray[np.float64]:
    """(3,) normal of the greatest facet; of several as great the first."""
    sizes = np.bincount(edges.facets, areas)
    return edges.normals[np.argmax(sizes > (1.0 - 1e-6) * sizes.max())].copy()


def shape_of_part(part, faces) -> tuple[Shape, float]:
    """Return the shape of a part and its length [m], from its faces.

    Parameters
    ----------
    part : Part
    faces : Ground

    Returns
    -------
    shape, length
        As `shape_of`.
    """
    axes = np.array([face.axis for face in faces.faces])
    return shape_of(faces.hull, faces.labels, part.mass, part.inertia, axes)


def principal_axes(inertia) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the principal moments (3,) [any], ascending, and their axes, columns of a rotation (3, 3).

    Source: the eigenvectors of the inertia matrix.
    """
    moments, principal = vectors.eigen(inertia)
    return moments, principal * np.sign(vectors.determinant(principal))


def _turned(edges, principal, length) -> Edges:
    """Half-edges in principal axes and units of the length."""
    scaled = {
        "vertices": vectors.product(edges.vertices, principal) / length,
        "normals": vectors.product(edges.normals, principal),
        "slopes": edges.slopes / length**2,
        "sides": edges.sides / length**2,
    }
    return edges._replace(**{name: check.frozen(array) for name, array in scaled.items()})


def _links(hull) -> NDArray[np.int64]:
    """Corners joined to each corner by an edge of a triangle: where each list starts, then the lists."""
    origins, targets = hull.triangles[:, [1, 2, 0]].ravel(), hull.triangles[:, [2, 0, 1]].ravel()
    order = np.argsort(origins, kind="stable")
    count = len(hull.vertices) + 1
    starts = np.searchsorted(origins[order], np.arange(count))
    return np.concatenate([starts + count, targets[order]]).astype(int)


def _faces(edges, tumbling, labels) -> NDArray[np.int64]:
    faces = np.full(len(edges.normals), barriers.UNNAMED)
    faces[sinks(edges)] = barriers.named(tumbling, np.asarray(labels)[tumbling.sinks])
    return faces


def _margins(edges, tumbling, labels, count) -> NDArray[np.float64]:
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
