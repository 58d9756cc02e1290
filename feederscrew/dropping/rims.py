"""Round rims of a hull: the circles and arcs that its corners stand for."""

from typing import NamedTuple

import numpy as np

from feederscrew import check
from feederscrew.resting.basins.landscape import SMOOTH_ANGLE

CENTRE, AXIS, RADIUS, MIDDLE, OPENING, RIM = slice(0, 3), slice(3, 6), 6, slice(7, 10), 10, 11
FEWEST = 4  # edges of an arc
STRAIGHT = np.radians(0.2)  # a corner that turns less is a point on an edge
FLAT = 1e-5  # of the radius of the hull: how far corners of one rim may lie off its plane
EVEN = 0.05  # by which edges and turns of one rim may differ; more and they are meant
ROUND = 1e-3  # of its radius: how far corners may lie off their circle
CENTRED = 1e-6  # of the radius of the hull: a rim whose axis passes the centre of mass


class Rims(NamedTuple):
    """Circles and arcs of a hull; R rims, V corners of the hull."""

    table: np.ndarray  # (R, RIM) centre, unit axis, radius, direction of the middle, cosine of half its angle
    members: np.ndarray  # (R, V) bool: corners on each rim
    inner: np.ndarray  # (V,) bool: corners the rims replace; an arc's two ends stay corners


def rims_of(edges, radius, axes=()):
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
    A rim is a run of coplanar corners at equal distances and turns of less than SMOOTH, the limit that parts
    a bar of flats from a round one elsewhere. A full turn is a circle.
    """
    count = len(edges.vertices)
    found = []
    for axis in _axes(edges, axes):
        for corners in _planes(edges.vertices, axis, FLAT * radius):
            found += [(corners, rim) for rim in _runs(edges.vertices, corners, axis)]
    table = np.array([row for _, (row, *_) in found]).reshape(-1, RIM)
    members = np.zeros((len(found), count), bool)
    inner = np.zeros(count, bool)
    ends = np.zeros(count, bool)
    for k, (plane, (row, corners, closed)) in enumerate(found):
        members[k, corners] = True
        inner[plane[_under(row, edges.vertices[plane])]] = True
        ends[[] if closed else corners[[0, -1]]] = True
    inner &= ~ends
    return Rims(check.frozen(table), check.frozen(members), check.frozen(inner))


def _under(row, points):
    """(K,) bool: which of (K, 3) points in the plane of a rim lie on it, or on the chords it replaces."""
    away = points - row[CENTRE]
    size = np.sqrt((away**2).sum(axis=1))
    near = np.abs(size / row[RADIUS] - 1.0) < 1.0 - np.cos(0.5 * SMOOTH_ANGLE)
    return near & (np.einsum("ki,i->k", away, row[MIDDLE]) >= size * row[OPENING] - ROUND * row[RADIUS])


def _axes(edges, more):
    """Unit axes worth looking along, one of each pair of opposite ones."""
    borders = np.bincount(edges.facets[np.flatnonzero(edges.borders) // 3], minlength=len(edges.normals))
    found: list[np.ndarray] = []
    for axis in (*edges.normals[borders > FEWEST], *more):
        if np.isfinite(axis).all() and all(np.abs(np.cross(axis, other)).max() > 1e-4 for other in found):
            found.append(np.asarray(axis))
    return found


def _planes(vertices, axis, tolerance):
    """Corners of each plane across an axis that holds enough of them."""
    levels = np.einsum("vi,i->v", vertices, axis)
    order = np.argsort(levels, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(levels[order]) > tolerance) + 1)
    return [part for part in parts if len(part) > FEWEST]


def _runs(vertices, corners, axis):
    """Row, corners and whether it is closed, of each rim of the corners in one plane."""
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.sqrt((first**2).sum())
    plane = np.stack([first, np.cross(axis, first)], axis=1)
    points = np.einsum("vi,ij->vj", vertices[corners], plane)
    middle = points.mean(axis=0)
    order = np.argsort(np.arctan2(*(points - middle).T[::-1]), kind="stable")
    corners, points = corners[order], points[order]
    bent = _turns(points) > STRAIGHT
    corners, points = corners[bent], points[bent]
    steps = np.roll(points, -1, axis=0) - points
    if len(points) <= FEWEST:
        return []
    lengths = np.hypot(*steps.T)
    found = [_rim(vertices, corners[run], axis, closed) for run, closed in _even(lengths, _turns(points))]
    return [rim for rim in found if rim is not None]


def _turns(points):
    """(K,) by how much a polygon turns at each of its (K, 2) corners."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    return np.arctan2(_cross(before, after), (before * after).sum(axis=1))


def _cross(u, v):
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def _even(lengths, turns):
    """Runs of corners of a polygon between even edges, and whether each goes all around.

    ``lengths`` (K,) of the edge from each corner to the next, ``turns`` (K,) at each corner.
    """
    before = np.roll(lengths, 1)
    smooth = (np.abs(turns) < SMOOTH_ANGLE) & (turns > 0.0) & (np.abs(before - lengths) < EVEN * lengths)
    count = len(lengths)
    if smooth.all():
        return [(np.arange(count), True)]
    start = int(np.argmin(smooth))  # a corner that ends a run
    found, run = [], list[int]()
    for k in range(1, count + 1):
        corner = (start + k) % count
        if smooth[corner] and (not run or abs(turns[corner] - turns[run[0]]) < EVEN * turns[run[0]]):
            run.append(corner)
            continue
        found.append(run)
        run = [corner] if smooth[corner] else []
    return [
        (np.array([(run[0] - 1) % count, *run, (run[-1] + 1) % count]), False)
        for run in found
        if len(run) + 1 >= FEWEST
    ]


def _rim(vertices, corners, axis, closed):
    """Row, corners and whether it is closed; None where they are on no circle."""
    points = vertices[corners]
    third = len(corners) // 3
    a, b, c = points[[0, third, 2 * third]] if closed else points[[0, len(corners) // 2, -1]]
    centre, radius = _circle(a, b, c)
    away = points - centre
    off = np.abs(np.sqrt((away**2).sum(axis=1)) - radius).max()
    if off > ROUND * radius:
        return None
    middle = away[0] if closed else away[[0, -1]].sum(axis=0)
    middle, opening = (away[0], -2.0) if closed else _open(away)
    middle = middle / np.sqrt((middle**2).sum())
    return np.concatenate([centre, axis, [radius], middle, [opening]]), corners, closed


def _open(away):
    """Direction of an arc's middle, and the cosine of half its angle, from (K, 3) radii."""
    half = len(away) // 2
    middle = away[half] if len(away) % 2 else away[half - 1] + away[half]
    size = np.sqrt((middle**2).sum() * (away[0] ** 2).sum())
    return middle, float((away[0] * middle).sum() / size)


def _circle(a, b, c):
    """Centre and radius of the circle through three points."""
    u, v = b - a, c - a
    normal = np.cross(u, v)
    size = (normal**2).sum()
    arm = ((u**2).sum() * np.cross(v, normal) + (v**2).sum() * np.cross(normal, u)) / (2.0 * size)
    return a + arm, float(np.sqrt((arm**2).sum()))


def true_heights(rims, edges, sinks, heights, radius):
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
    found = np.array(heights)
    triangles = np.split(np.argsort(edges.facets, kind="stable"), np.cumsum(np.bincount(edges.facets))[:-1])
    for k, facet in enumerate(sinks if len(rims.table) else ()):
        halves = (3 * triangles[facet][:, None] + np.arange(3)).ravel()
        corners = np.unique(edges.origins[halves[edges.borders[halves]]])
        side = _side(rims, edges.vertices, corners, radius)
        if side is not None:
            found[k] = _tangent_height(side[0], side[1], radius)
    return found


def _side(rims, vertices, corners, radius):
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
    if np.abs(offsets[0] - offsets[1]).max() > ROUND * radius:
        return None
    if not all(_reaches(end, -offsets[0], radius) for end in ends):
        return None
    return np.array([[level, end[RADIUS]] for end, level in zip(ends, along)]), _size(offsets[0])


def _size(vector):
    return float(np.sqrt((vector**2).sum()))


def _reaches(rim, direction, radius):
    """Whether an arc has a point in a direction from its axis; a direction of no length is any."""
    size = _size(direction)
    return size < CENTRED * radius or (direction * rim[MIDDLE]).sum() >= size * rim[OPENING]


def _tangent_height(ends, offset, radius):
    """Height of the centre of mass over the plane that touches two rims, the least of all around the axis."""
    (s, r), (t, q) = ends
    length = np.hypot(t - s, q - r)
    across, along = abs(t - s) / length, (r - q) * np.sign(t - s) / length  # of the plane's normal
    return along * s + across * (r - offset)


def true_tops(rims, edges, saddles, tops, radius):
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
    found = np.array(tops)
    for rim, members in zip(rims.table, rims.members):
        chords = members[edges.origins[saddles]] & members[edges.targets[saddles]]
        level = (rim[CENTRE] * rim[AXIS]).sum()
        offset = rim[CENTRE] - level * rim[AXIS]
        if chords.any() and _size(offset) < rim[RADIUS] and _reaches(rim, -offset, radius):
            found[chords] = np.hypot(level, rim[RADIUS] - _size(offset))
    return found


def lowest_on(shape, up):
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
