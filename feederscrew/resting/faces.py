"""Hull triangles gathered into faces a part can rest on: flats, and curved sides it rolls on."""

from dataclasses import dataclass

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.geometry.graphs import components
from feederscrew.resting import contacts, rounds
from feederscrew.resting.basins.landscape import GENTLE, RIPPLE_OF_RADIUS, SMOOTH, angle, edges, gentle

COARSE = 1.0 / np.cos(0.5 * SMOOTH) - 1.0  # the ripple a smooth edge leaves at most, as a share of the height
CURVED = np.sinc(np.radians(15.0) / np.pi)  # mean resultant of normals over an arc of 30 deg; below: no plane
FLATNESS = 1e-2  # of the radius: how deep a corner may lie under the plane of its face
TIGHTEST_FIRST = (1e-6, 1e-5, 1e-4, 1e-3, FLATNESS)
EQUAL = 5e-3  # of the height: strips of one curve about the centre of mass are as high as each other
STRAIGHT = (
    1e-2  # of their variance along the curve: how far normals of a rocker may leave their plane or cone
)
DOUBLE = 2e-3  # of the same: normals off their plane or cone by more belong to a side curved both ways
FEWEST_OF_A_BALL = 24  # facets that show a side curved both ways: a ball, or a cap of one
ALIKE = np.radians(1.0)  # strips that lean by less apart are of one cone
SLIVERS = 1e-2  # of their area: what a file's noise leaves between them
FEWEST = 6  # strips that show a curve whose middle is not the centre of mass
TINY = np.finfo(float).tiny
ARC = np.radians(60.0)  # coarse strips that turn less may be meant as flats


@dataclass(frozen=True, eq=False)
class Face:
    """One place on the hull to rest on (or, unstable, to roll off from)."""

    kind: str  # 'flat' or 'rolling'
    stable: bool
    normal: np.ndarray  # (3,) outward; of a rolling face, of its lowest strip
    axis: np.ndarray  # (3,) of a rolling face, NaN where it is a flat or a ball
    height: float  # [m] of the centre of mass
    area: float  # [m2] of contact; of a rolling face, of the whole curved side
    solid_angle: float  # [sr]
    polygon: np.ndarray  # (K, 3) [m] corners of contact, counter-clockwise seen from outside
    triangles: np.ndarray  # indices into the hull
    roughness: float  # [m] mean depth of the contact's corners off its plane: the file's noise


def stable_faces(hull, basins):
    """Faces the part rests on.

    Parameters
    ----------
    hull : Hull
    basins : Landscape

    Returns
    -------
    list of Face
        One for each basin; the strips of a coarsely tessellated curve make one.
    """
    order = np.argsort(basins.basins, kind="stable")
    starts = np.searchsorted(basins.basins[order], basins.sinks)
    members = np.split(order, starts[1:])
    group = _coarse_curves(hull, basins, members)
    sides = _smooth_sides(hull, basins, group)
    together = [np.flatnonzero(group == label) for label in np.unique(group)]
    return [_face(hull, basins.sinks[some], [members[k] for k in some], sides) for some in together]


def unstable_faces(hull, taken):
    """Faces made of the triangles no stable face has taken: the part rolls off them.

    Parameters
    ----------
    hull : Hull
    taken : list of Face

    Returns
    -------
    list of Face
    """
    free = np.ones(len(hull.triangles), dtype=bool)
    for face in taken:
        free[face.triangles] = False
    pairs, _ = edges(hull)
    pairs = pairs[free[pairs].all(axis=1)]
    bend = angle(*(hull.normals[pairs[:, k]] for k in (0, 1)))
    step = np.abs(np.diff(hull.heights[pairs], axis=1))[:, 0]
    joined = (bend < np.radians(0.2)) | ((bend < SMOOTH) & (step < RIPPLE_OF_RADIUS * hull.radius))
    labels = components(*pairs[joined].T, len(free))[1]
    order = np.flatnonzero(free)[np.argsort(labels[free], kind="stable")]
    parts = np.split(order, np.flatnonzero(np.diff(labels[order])) + 1) if len(order) else []
    return [_describe(hull, part, part[np.argmax(hull.areas[part])], stable=False) for part in parts]


def _coarse_curves(hull, basins, members):
    """(B,) label of each sink; strips of one coarsely tessellated curve share it."""
    place, sinks = np.searchsorted(basins.sinks, basins.ripples), basins.ripples
    step = np.abs(np.diff(hull.heights[sinks], axis=1))[:, 0] / hull.heights[sinks[:, 0]]
    strips = (basins.rises < COARSE) & (basins.bends < SMOOTH) & (step < EQUAL + basins.bends**2)
    level = step < EQUAL
    labels = components(*place[level & strips].T, len(basins.sinks))[1]
    for label in np.flatnonzero(np.bincount(labels) > 1):
        group = np.flatnonzero(labels == label)
        if _spread(hull.normals[basins.sinks[group]]) < ARC:
            labels[group] = labels.max() + 1 + np.arange(len(group))
    around = components(*place[strips].T, len(basins.sinks))[1]
    several = np.flatnonzero(np.bincount(around) > 1)
    sides = _smooth_sides(hull, basins, around) if len(several) else None
    for label in several:
        group = np.flatnonzero(around == label)
        if _one_round(hull, basins.sinks[group], [members[k] for k in group], sides):
            labels[group] = labels.max() + 1
    return labels


def _one_round(hull, sinks, members, sides):
    """Whether the sinks lie on one round side: on many of its strips, or on a few of a rocker's."""
    if len(sinks) >= FEWEST and _spread(hull.normals[sinks]) >= ARC and _round(hull, sinks):
        return True
    lowest, every = sinks[np.argmin(hull.heights[sinks])], np.concatenate(members)
    return _rocks(hull, every[sides[every] == sides[lowest]], lowest)


def _face(hull, sinks, members, sides):
    """One face from the basins of its sinks (one, or the strips of a curve)."""
    lowest, every = sinks[np.argmin(hull.heights[sinks])], np.concatenate(members)
    level = [part[hull.heights[part] <= hull.heights[sink] * (1.0 + 1e-9) + FLATNESS * hull.radius / 2]
             for sink, part in zip(sinks, members)]  # fmt: skip
    strip, side = np.concatenate(level), every[sides[every] == sides[lowest]]
    if _rocks(hull, side, lowest):
        strip = side
    elif not _curved(hull, strip):
        strip = _plane(hull, lowest, every)
    return _describe(hull, strip, lowest, stable=True)


def _smooth_sides(hull, basins, group):
    """(T,) label of each triangle; gentle bends within its group lead to all others of the same.

    Where no group has the triangles of a curved side, each has a label of its own.
    """
    owner = group[np.searchsorted(basins.sinks, basins.basins)]
    if np.bincount(owner).max() < FEWEST:
        return np.arange(len(owner))
    first, second = basins.pairs.T
    joined = (owner[first] == owner[second]) & gentle(hull.normals, basins.pairs)
    return np.zeros_like(owner) if joined.all() else components(first[joined], second[joined], len(owner))[1]


def _rocks(hull, side, sink):
    """Whether these triangles are strips of a curved side whose axis may lie off the centre of mass."""
    if len(side) < FEWEST or not _curved(hull, side):
        return False
    normals, share = hull.normals[side], hull.areas[side] / hull.areas[side].sum()
    leans = angle(normals, hull.normals[sink])
    if share[leans < 0.5 * SMOOTH].sum() > 0.5 or _ring(leans, share):
        return False
    across = vectors.eigen(vectors.covariance(normals, share))[0]
    fewest = FEWEST if across[0] < STRAIGHT * across[1] else FEWEST_OF_A_BALL
    return _even(normals, share) > fewest - 0.5 and _round(hull, side)


def _even(normals, share):
    """Effective number of strips, of (N, 3) normals and (N,) shares: 1 over the sum of squared shares."""
    places = vectors.product(np.round(100.0 * normals), np.array([1.0, 1e3, 1e6]))  # one number a direction
    order = np.argsort(places, kind="stable")
    strips = np.flatnonzero(np.diff(places[order], prepend=np.nan))
    return 1.0 / (np.add.reduceat(share[order], strips) ** 2).sum()


def _ring(leans, share):
    """Whether the strips of a curved side that lean do so alike: a cone about a flat touches a ball, too."""
    leaning = leans > ALIKE
    lean = np.average(leans[leaning], weights=share[leaning])
    return bool(share[np.abs(leans - lean) < ALIKE].sum() > (1.0 - SLIVERS) * share[leaning].sum())


def _round(hull, triangles):
    """Whether triangles touch one cylinder, cone or ball, wherever its middle is."""
    weights, height = np.sqrt(hull.areas[triangles]), hull.heights[triangles]
    around = np.column_stack([np.ones(len(triangles)), hull.normals[triangles]])
    off = vectors.misfit(around * weights[:, None], height * weights)
    return bool(vectors.length(off) < EQUAL * height.mean() * vectors.length(weights))


def _plane(hull, sink, members, of_a_curve=False):
    """Members in the plane about the sink, and with them what lies in the sink's own.

    The tightest plane that holds most of what noise allows, and that a looser one would hardly add to:
    in a clean file the face itself without the shallow bevels beside it, in a noisy one all of it. Of a
    curve one strip is wanted, though the halves of the strips beside it may lie as shallow.
    """
    members = np.sort(members)
    depth = _depth(hull, sink, members)
    shallow = (depth < FLATNESS * hull.radius) & (
        vectors.product(hull.normals[members], hull.normals[sink]) > GENTLE
    )
    near, tight = members[shallow], depth[shallow] < TIGHTEST_FIRST[0] * hull.radius
    if tight.all():
        return near
    own = near[tight] if of_a_curve else near
    largest = own[np.argmax(hull.areas[own])]
    depth, areas = _depth(hull, largest, near), hull.areas[near]
    inside = depth <= hull.radius * np.array(TIGHTEST_FIRST)[:, None]
    held = vectors.product(inside, areas)
    shared = held / areas.sum() - 0.1 * (inside.sum(axis=1) < 2)  # one triangle is a plane by itself
    enough = shared >= 0.5
    if of_a_curve:
        enough |= inside.sum(axis=1) >= (1 if _fan(hull, members) else 2)  # triangles of a strip
    good = enough[:-1] & (held[1:] <= 1.02 * held[:-1])
    inside = inside[np.argmax(good)] if good.any() else np.ones(len(near), dtype=bool)
    return near[inside | tight]


def _fan(hull, members):
    """Whether most triangles meet at one corner, as the strips of a cone do at its tip."""
    return np.bincount(hull.triangles[members].ravel()).max() > 0.5 * len(members)


def _depth(hull, plane, members):
    """How far the corners of each member lie off the plane of one triangle [m]."""
    corners = hull.triangles[members].T
    each = corners.size > len(hull.vertices)  # sooner of every corner of the hull once
    places = hull.vertices if each else hull.vertices[corners.ravel()]
    depth = np.abs(vectors.product(places, hull.normals[plane]) - hull.heights[plane])
    a, b, c = depth[corners] if each else depth.reshape(3, -1)
    return np.maximum(np.maximum(a, b), c)


def _off_plane(hull, members, normal):
    depth = vectors.product(hull.vertices[hull.triangles[members]], normal)
    return np.abs(depth - depth.mean()).max(axis=1)


def _describe(hull, triangles, lowest, stable):
    """The record of a face made of these triangles."""
    normals, areas = hull.normals[triangles], hull.areas[triangles]
    curved = _curved(hull, triangles)
    foot = _plane(hull, lowest, triangles, of_a_curve=True) if curved else triangles
    weights = np.maximum(hull.areas[foot], TINY)
    normal = vectors.unit(vectors.product(weights, hull.normals[foot]))
    height, roughness = (
        float((depths * weights).sum() / weights.sum())
        for depths in (hull.heights[foot], _off_plane(hull, foot, normal))
    )
    axis = _axis(normals, areas, normal) if curved else np.full(3, np.nan)
    polygon = contacts.outline(hull.vertices[np.unique(hull.triangles[foot])], normal)
    return Face(
        kind="rolling" if curved else "flat",
        stable=stable,
        normal=normal,
        axis=axis,
        height=rounds.height(polygon, axis, height),
        area=float(areas.sum()),
        solid_angle=float(hull.solid_angles[triangles].sum()),
        polygon=polygon,
        triangles=triangles,
        roughness=roughness,
    )


def _axis(normals, weights, lowest):
    """Axis of the cylinder or cone with these normals: all make one angle with it; NaN for a ball.

    A cap of a ball has normals in two dimensions about the ``lowest`` one, which is no axis to roll about.
    """
    spread = vectors.covariance(normals, np.maximum(weights, weights.max() * 1e-12))
    values, axes = vectors.eigen(spread)
    if values[0] > 0.2 * values[1]:
        return np.full(3, np.nan)
    axis = axes[:, 0]
    if values[0] > DOUBLE * values[1] and abs(vectors.dot(axis, lowest)) > 0.5:
        return np.full(3, np.nan)
    return axis * np.sign(axis[np.argmax(np.abs(axis))])


def _curved(hull, triangles):
    areas = hull.areas[triangles]
    return (
        len(areas) > 1
        and vectors.length(vectors.product(areas, hull.normals[triangles])) < CURVED * areas.sum()
    )


def _spread(normals):
    """Angle across a set of directions [rad], from its end to the end furthest from it."""
    end = normals[np.argmax(angle(normals, normals[0]))]
    return angle(normals, end).max()
