"""Part as the drop kernel takes it, without dimensions: its hull, and the round rims of it.

Rims are the circles and arcs that corners stand for. Source: Newton and Euler for a rigid body;
docs/resting.md, "The drop test".
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.part.hull import Hull
from feederscrew.part.record import Part
from feederscrew.resting import barriers
from feederscrew.resting.exact_tumbling import Ground, tumble
from feederscrew.resting.half_edges import Edges, half_edges, saddles, sinks
from feederscrew.resting.landscape import SMOOTH_ANGLE

CENTRE = slice(0, 3)
AXIS = slice(3, 6)
RADIUS = 6
MIDDLE = slice(7, 10)
OPENING = 10
RIM = 11
MIN_ARC_EDGES = 4  # edges of an arc
STRAIGHT_CORNER_RAD = np.radians(0.2)  # a corner that turns less is a point on an edge
RIM_PLANE_SHARE = 1e-5  # of the radius of the hull: how far corners of one rim may lie off its plane
EVEN_EDGES_SHARE = 0.05  # by which edges and turns of one rim may differ; more and they are meant
RIM_CIRCLE_SHARE = 1e-3  # of its radius: how far corners may lie off their circle
CENTRED_RIM_SHARE = 1e-6  # of the radius of the hull: a rim whose axis passes the centre of mass


class Rims(NamedTuple):
    """Circles and arcs of a hull; R rims, V corners of the hull."""

    table: Floats  # (R, RIM) centre, unit axis, radius, direction of the middle, cosine of half its angle
    members: Bools  # (R, V) bool: corners on each rim
    inner: Bools  # (V,) bool: corners the rims replace; an arc's two ends stay corners


def rims_of(edges: Edges, radius: float, axes: Sequence[Floats] = ()) -> Rims:
    """Return the circles and arcs that corners of a hull are points of.

    A rim is a run of coplanar corners at equal distances and turns of less than ``SMOOTH_ANGLE``, the limit
    that parts a bar of flats from a round one elsewhere. A full turn is a circle. Rims are looked for along
    the normals of flat facets and along ``axes``.

    Parameters
    ----------
    edges : Edges
    radius : float [m]
        Of the hull.
    axes : sequence of (3,) float [1]
        Axes of rolling faces.

    Returns
    -------
    Rims

    References
    ----------
    Own; docs/resting.md, "The drop test".
    """
    vertices, tolerance = edges.vertices, RIM_PLANE_SHARE * radius
    # Unit axes worth looking along, one of each pair of opposite ones.
    borders = np.bincount(edges.facets[np.flatnonzero(edges.borders) // 3], minlength=len(edges.normals))
    along: list[Floats] = []
    for axis in (*edges.normals[borders > MIN_ARC_EDGES], *axes):
        if np.isfinite(axis).all() and all(np.abs(np.cross(axis, other)).max() > 1e-4 for other in along):
            along.append(np.asarray(axis))
    runs = []  # axis, corners in a plane across it, those of one run, whether it is closed
    for axis in along:
        levels = np.einsum("vi,i->v", vertices, axis)
        order = np.argsort(levels, kind="stable")
        planes = np.split(order, np.flatnonzero(np.diff(levels[order]) > tolerance) + 1)
        runs += [(axis, plane, *run) for plane in planes for run in _even_runs(vertices, plane, axis)]
    table, members = [], []
    inner, ends = np.zeros((2, len(vertices)), bool)
    for axis, plane, corners, closed in runs:
        row = _circle_row(vertices[corners], axis, closed)
        if row is None:
            continue
        table.append(row)
        members.append(np.isin(np.arange(len(vertices)), corners))
        # Of the corners in its plane it replaces those on it, or on the chords it stands for.
        away = vertices[plane] - row[CENTRE]
        size = np.sqrt((away**2).sum(axis=1))
        near = np.abs(size / row[RADIUS] - 1.0) < 1.0 - np.cos(0.5 * SMOOTH_ANGLE)
        cosine = np.einsum("ki,i->k", away, row[MIDDLE])
        inner[plane[near & (cosine >= size * row[OPENING] - RIM_CIRCLE_SHARE * row[RADIUS])]] = True
        ends[[] if closed else corners[[0, -1]]] = True
    return Rims(
        check.frozen(np.array(table).reshape(-1, RIM)),
        check.frozen(np.array(members, bool).reshape(-1, len(vertices))),
        check.frozen(inner & ~ends),
    )


def _even_runs(vertices: Floats, corners: Ints, axis: Floats) -> list[tuple[Ints, bool]]:
    """Return runs of corners in a plane between even edges, in order around it; whether each is closed."""
    if len(corners) <= MIN_ARC_EDGES:
        return []
    points = vectors.product(vertices[corners], np.column_stack(vectors.plane_axes(axis)))
    order = np.argsort(np.arctan2(*(points - points.mean(axis=0)).T[::-1]), kind="stable")
    corners, points = corners[order], points[order]
    bent = _turns(points) > STRAIGHT_CORNER_RAD
    corners, points = corners[bent], points[bent]
    count = len(points)
    if count <= MIN_ARC_EDGES:
        return []
    turns, lengths = _turns(points), np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    uneven = np.abs(np.roll(lengths, 1) - lengths)
    smooth = (np.abs(turns) < SMOOTH_ANGLE) & (turns > 0.0) & (uneven < EVEN_EDGES_SHARE * lengths)
    if smooth.all():
        return [(corners, True)]
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
        (corners[[(run[0] - 1) % count, *run, (run[-1] + 1) % count]], False)
        for run in runs
        if len(run) + 1 >= MIN_ARC_EDGES
    ]


def _turns(points: Floats) -> Floats:
    """Return by how much [rad] a polygon turns at each of its (K, 2) corners."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    return np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))


def _circle_row(points: Floats, axis: Floats, closed: bool) -> Any:
    """Return the row (RIM,) of the circle or arc through points (K, 3); None where they are on no circle.

    The centre is the circumcentre of three of them, u and v the sides from one: a + (u^2 v x n + v^2 n x u) /
    (2 n^2), n = u x v.
    """
    # Through three of them.
    third, half = len(points) // 3, len(points) // 2
    a, b, c = points[[0, third, 2 * third]] if closed else points[[0, half, -1]]
    u, v = b - a, c - a
    normal = np.cross(u, v)
    size = (normal**2).sum()
    arm = ((u**2).sum() * np.cross(v, normal) + (v**2).sum() * np.cross(normal, u)) / (2.0 * size)
    centre, radius = a + arm, float(np.sqrt((arm**2).sum()))
    away = points - centre
    if np.abs(np.sqrt((away**2).sum(axis=1)) - radius).max() > RIM_CIRCLE_SHARE * radius:
        return None
    middle, opening = away[0], -2.0
    if not closed:
        middle = away[half] if len(away) % 2 else away[half - 1] + away[half]
        size = np.sqrt((middle**2).sum() * (away[0] ** 2).sum())
        opening = float((away[0] * middle).sum() / size)
    middle = middle / np.sqrt((middle**2).sum())
    return np.concatenate([centre, axis, [radius], middle, [opening]])


def _round_heights(rims: Rims, edges: Edges, facets: Ints, heights: Floats, radius: float) -> Floats:
    """Return the heights (S,) [m] of the centre of mass on facets.

    A strip between two rims counts as the round side that it stands for.
    """
    corrected = np.array(heights)
    triangles = np.split(np.argsort(edges.facets, kind="stable"), np.cumsum(np.bincount(edges.facets))[:-1])
    for k, facet in enumerate(facets if len(rims.table) else ()):
        halves = (3 * triangles[facet][:, None] + np.arange(3)).ravel()
        corners = np.unique(edges.origins[halves[edges.borders[halves]]])
        on = np.flatnonzero(rims.members[:, corners].sum(axis=1) == 2)
        ends = [rims.table[row] for row in on]
        left = corners[~rims.members[on][:, corners].any(axis=0)] if len(on) else corners
        if len(ends) == 1 and len(left) == 1:  # a cone's tip
            tip = edges.vertices[left[0]]
            ends.append(np.concatenate([tip, ends[0][AXIS], [0.0], ends[0][MIDDLE], [-2.0]]))
            left = left[1:]
        if len(ends) != 2 or len(left):
            continue
        # The strip joins two rims about one axis: the plane that touches both, the lowest of all around it.
        axis = ends[0][AXIS]
        s, t = ((end[CENTRE] * axis).sum() for end in ends)
        offsets = [end[CENTRE] - level * axis for end, level in zip(ends, (s, t))]
        same = np.abs(offsets[0] - offsets[1]).max() <= RIM_CIRCLE_SHARE * radius
        if same and all(_reaches(end, -offsets[0], radius) for end in ends):
            r, q = (end[RADIUS] for end in ends)
            length = np.hypot(t - s, q - r)
            across, up = abs(t - s) / length, (r - q) * np.sign(t - s) / length  # of the plane's normal
            corrected[k] = up * s + across * (r - _size(offsets[0]))
    return corrected


def _round_tops(rims: Rims, edges: Edges, tops: Floats, radius: float) -> Floats:
    """Return the heights (E,) [m] of the centre of mass over saddles, chords of a rim as their circle."""
    corrected, half = np.array(tops), saddles(edges)
    for rim, members in zip(rims.table, rims.members):
        chords = members[edges.origins[half]] & members[edges.targets[half]]
        level = (rim[CENTRE] * rim[AXIS]).sum()
        offset = rim[CENTRE] - level * rim[AXIS]
        if chords.any() and _size(offset) < rim[RADIUS] and _reaches(rim, -offset, radius):
            corrected[chords] = np.hypot(level, rim[RADIUS] - _size(offset))
    return corrected


def _size(vector: Floats) -> float:
    return float(np.sqrt((vector**2).sum()))


def _reaches(rim: Floats, direction: Floats, radius: float) -> bool:
    """Return whether an arc has a point in a direction from its axis; True for a direction of no length."""
    size = _size(direction)
    return size < CENTRED_RIM_SHARE * radius or (direction * rim[MIDDLE]).sum() >= size * rim[OPENING]


def lowest_on(shape: "Shape", up: Floats) -> Floats:
    """Return the lowest point of each rim.

    It lies from the centre by the radius along the direction (axis . up) axis - up, the vertical seen in the
    plane of the rim.

    Parameters
    ----------
    shape : Shape
    up : (N, 3) float [1]
        Unit vectors in body axes.

    Returns
    -------
    (N, R, 3) float [L]
        Of an arc that does not reach so low, the point in its middle.

    References
    ----------
    A circle is lowest where the vertical, seen in its plane, points down.
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

    vertices: Floats  # (V, 3)
    links: Ints  # (V + 1 + 2 E,) where each corner's neighbours start in this array; neighbours
    inertia: Floats  # (3,) principal moments at mass 1
    radius: float  # largest distance of a point
    rims: Floats  # (R, RIM) circles and arcs, as ``Rims.table``
    inner: Bools  # (V,) bool: corners that rims replace
    corners: int  # how many are left
    sag: float  # how far a rim bulges over its corners' edges


class Shape(NamedTuple):
    """Shape of a part as the drop kernel takes it, in units of its own length; F faces, M facets."""

    solid: RoundedHull
    edges: Edges
    faces: Ints  # (M,) face of each facet the part rests on, -1 for the others
    heights: Floats  # (F,) of the centre of mass
    barriers: Floats  # (F,) lowest lift that tips the part off the face
    margins: Floats  # (F,) from the foot of the centre of mass to the nearest edge; 0 for a rolling face
    rolls: Bools  # (F,) bool
    axes: Floats  # (F, 3) axis of a rolling face
    ceiling: float  # energy over which no face is decided
    flat: Floats  # (3,) normal of the greatest facet


def shape_of(
    hull: Hull,
    labels: Ints,
    mass: float,
    inertia: Floats,
    axes: Floats | None = None,
) -> tuple[Shape, float]:
    """Return the shape of a hull, and its unit of length, the cube root of its volume.

    Parameters
    ----------
    hull : Hull
    labels : (T,) int
        Face of each hull triangle, -1 for none.
    mass : float [kg]
    inertia : (3, 3) float [kg m2]
        About the centre of mass, in the hull's axes.
    axes : (F, 3) float [1], optional
        Unit axis of each rolling face, NaN for flat ones; None if no face rolls.

    Returns
    -------
    Shape
        In principal axes and units of the length.
    float [m]
        The length L.

    Raises
    ------
    ValueError
        If the mass is not positive, or the inertia has another shape.

    References
    ----------
    docs/resting.md, "The drop test".
    """
    length, mass = float(np.cbrt(hull.volume)), check.positive("mass", mass)
    moments, principal = principal_axes(check.shaped("inertia", inertia, (3, 3)))
    edges = half_edges(hull)
    rims = rims_of(edges, hull.radius, () if axes is None else list(axes))
    # The heights of round sides and rims, not of the corners that stand for them.
    tumbling = tumble(hull)
    facets = edges.facets[tumbling.sinks]
    tumbling = replace(
        tumbling,
        heights=_round_heights(rims, edges, facets, tumbling.heights, hull.radius),
        saddle_heights=_round_tops(rims, edges, tumbling.saddle_heights, hull.radius),
    )
    tips = barriers.gather_tipping(tumbling, labels)
    lifts = barriers.barriers(tips) / length
    heights = np.nan_to_num(tips.heights / length)
    axes = np.full((len(heights), 3), np.nan) if axes is None else np.array(axes, float)
    rolls = np.isfinite(axes).all(axis=1)
    # All in principal axes and units of the length.
    scaled = {
        "vertices": vectors.product(edges.vertices, principal) / length,
        "normals": vectors.product(edges.normals, principal),
        "slopes": edges.slopes / length**2,
        "sides": edges.sides / length**2,
    }
    edges = edges._replace(**{name: check.frozen(array) for name, array in scaled.items()})
    table = np.array(rims.table)
    for vector in (CENTRE, AXIS, MIDDLE):
        table[:, vector] = vectors.product(rims.table[:, vector], principal)
    table[:, CENTRE] /= length
    table[:, RADIUS] /= length
    # Corners joined to each corner by an edge of a triangle: where each list starts, then the lists.
    origins, targets = hull.triangles[:, [1, 2, 0]].ravel(), hull.triangles[:, [2, 0, 1]].ravel()
    order, count = np.argsort(origins, kind="stable"), len(hull.vertices) + 1
    starts = np.searchsorted(origins[order], np.arange(count))
    # Margins: from the foot to the nearest edge, over the sinks of each face.
    faces = np.full(len(edges.normals), barriers.UNNAMED)
    own = np.asarray(labels)[tumbling.sinks]
    faces[sinks(edges)] = barriers.adopted_shares(tumbling, own, own.max() + 1).argmax(axis=1)
    sides = edges.vertices[edges.targets] - edges.vertices[edges.origins]
    levers, owners = edges.sides / np.linalg.norm(sides, axis=1), np.repeat(edges.facets, 3)
    by_facet, margins = np.full(len(edges.normals), np.inf), np.full(len(heights), np.inf)
    np.minimum.at(by_facet, owners[edges.borders], levers[edges.borders])
    np.minimum.at(margins, faces[faces >= 0], by_facet[faces >= 0])
    sizes = np.bincount(edges.facets, hull.areas)
    solid = RoundedHull(
        vertices=edges.vertices,
        links=check.frozen(np.concatenate([starts + count, targets[order]]).astype(int)),
        inertia=check.frozen(moments / (mass * length**2)),
        radius=hull.radius / length,
        rims=check.frozen(table),
        inner=rims.inner,
        corners=int((~rims.inner).sum()),
        sag=float(table[:, RADIUS].max() * (1.0 - np.cos(SMOOTH_ANGLE / 2))) if len(table) else 0.0,
    )
    shape = Shape(
        solid=solid,
        edges=edges,
        faces=check.frozen(faces),
        heights=check.frozen(heights),
        barriers=check.frozen(lifts),
        margins=check.frozen(np.where(rolls | ~np.isfinite(margins), 0.0, margins)),
        rolls=check.frozen(rolls),
        axes=check.frozen(vectors.product(np.nan_to_num(axes), principal)),
        ceiling=float((heights + lifts).max()),
        flat=check.frozen(edges.normals[np.argmax(sizes > (1.0 - 1e-6) * sizes.max())].copy()),
    )
    return shape, length


def shape_of_part(part: Part, faces: Ground) -> tuple[Shape, float]:
    """Return the shape of a part and its length, from its faces.

    Parameters
    ----------
    part : Part
    faces : Ground

    Returns
    -------
    Shape
    float [m]
        As in ``shape_of``.
    """
    axes = np.array([face.axis for face in faces.faces])
    return shape_of(faces.hull, faces.labels, part.mass, part.inertia, axes)


def principal_axes(inertia: Floats) -> tuple[Floats, Floats]:
    """Return the principal moments, ascending, and their axes.

    Parameters
    ----------
    inertia : (3, 3) float [any]

    Returns
    -------
    (3,) float [any]
        Moments.
    (3, 3) float [1]
        A rotation; its columns are the axes.

    References
    ----------
    The eigenvectors of the inertia matrix.
    """
    moments, principal = vectors.eigen(inertia)
    return moments, principal * np.sign(vectors.determinant(principal))
