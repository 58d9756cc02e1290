"""Hull triangles gathered into faces a part can rest on: flats, and curved sides it rolls on."""

from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Bools, Floats, Ints, Points
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.graphs import (
    component_of,
    components,
    group_starts,
    group_sums,
    join_groups,
    split_groups,
)
from feederscrew.base.heavy import heavy
from feederscrew.part.hull import Hull
from feederscrew.resting.landscape import (
    GENTLE_COSINE,
    RIPPLE_OF_RADIUS,
    SMOOTH_ANGLE,
    Landscape,
    angle,
    gentle,
)

spatial = heavy("scipy.spatial")

ONE_PLANE = np.radians(0.2)  # between triangles of one facet
LARGER = 1.5  # times the bend round most of a side: a facet between sharper bends was not cut by chance
LONE_BEND_FACTOR = 1.2  # times the bend that 95 % of a side do not exceed: such a facet is alone
MAJORITY_SHARE = 0.95  # of a side, by area


def _intended_flats(hull: Hull, basins: Landscape) -> Bools:
    """Return which sinks (B,) lie on facets much wider than the others of their smooth side.

    Even the gentlest bend round such a facet is ``LARGER`` than that round half of the side, by area, or
    ``LONE_BEND_FACTOR`` of that round ``MAJORITY_SHARE`` of it. A flat cut into a ball or cylinder passes
    this; a facet of its tessellation does not.
    """
    first, second = basins.pairs.T
    bends = angle(hull.normals[first], hull.normals[second])
    facets = component_of(basins.pairs[bends < ONE_PLANE], len(hull.triangles))
    gentlest = np.full(facets.max() + 1, np.inf)
    border = facets[first] != facets[second]
    for side in (first, second):
        np.minimum.at(gentlest, facets[side[border]], bends[border])
    sides = component_of(basins.pairs[bends < SMOOTH_ANGLE], len(hull.triangles))
    about = gentlest[facets]
    # quantiles by area, of each side
    order = np.lexsort((about, sides))
    mass = np.cumsum(hull.areas[order])
    whole = mass[np.flatnonzero(np.append(np.diff(sides[order]) != 0, True))]
    begun = np.concatenate([[0.0], whole[:-1]])
    half, most = (
        about[order][np.searchsorted(mass, begun + share * (whole - begun))]
        for share in (0.5, MAJORITY_SHARE)
    )
    limit = np.minimum(LARGER * half, LONE_BEND_FACTOR * most)
    return (about > limit[sides])[basins.sinks] & np.isfinite(about[basins.sinks])


MAX_RIPPLE_SHARE = 1.0 / np.cos(0.5 * SMOOTH_ANGLE) - 1.0  # of the height, that a smooth edge leaves at most
CURVED = np.sinc(np.radians(15.0) / np.pi)  # mean resultant of normals over an arc of 30 deg; below: no plane
EQUAL_HEIGHT_SHARE = 5e-3  # of the height: strips of one curve about the centre of mass are as high
MAX_CONE_VARIANCE = 1e-2  # of that along the curve: how far normals of a rocker leave their plane or cone
DOUBLE = 2e-3  # of the same: normals off their plane or cone by more belong to a side curved both ways
FEWEST_OF_A_BALL = 24  # facets that show a side curved both ways: a ball, or a cap of one
CONE_LEAN_TOLERANCE = np.radians(1.0)  # strips that lean by less apart are of one cone
SLIVERS = 1e-2  # of their area: what a file's noise leaves between them
MAX_BEND_STRIPS = 2.5  # strips, by their effective number: two planes that meet are a bend and no curve
MIN_ROCKER_STRIPS = 6  # strips that show a curve whose middle is not the centre of mass
SMALLEST_NORMAL = np.finfo(float).tiny
MOST_PAIRED = 1000  # directions of which every pair is looked at
MIN_CURVE_ARC = np.radians(60.0)  # coarse strips that turn less may be meant as flats
FLATNESS = 1e-2  # of the radius: how deep a corner may lie under the plane of its face
TIGHTEST_FIRST = np.array([1e-6, 1e-5, 1e-4, 1e-3, FLATNESS])
ON_A_LINE = 1e-6  # of the contact's size: a corner off the line between its neighbours by less is none
CIRCLE_TOLERANCE = 1e-3  # of the height: how far the axis may pass the centre of mass
LINE_END_TOLERANCE = 1e-6  # of the line of contact: how near its end a corner belongs to it


@dataclass(frozen=True, eq=False)
class Face:
    """One place on the hull to rest on (or, unstable, to roll off from)."""

    kind: str  # 'flat' or 'rolling'
    stable: bool
    normal: Floats  # (3,) outward; of a rolling face, of its lowest strip
    axis: Floats  # (3,) of a rolling face, NaN where it is a flat or a ball
    middle: Floats  # (3,) [1] mean of its outward normals: of a flat its normal, of a whole cylinder 0
    height: float  # [m] of the centre of mass
    area: float  # [m2] of contact; of a rolling face, of the whole curved side
    solid_angle: float  # [sr]
    polygon: Points  # (K, 3) [m] corners of contact, counter-clockwise seen from outside
    triangles: Ints  # indices into the hull
    roughness: float  # [m] mean depth of the contact's corners off its plane: the file's noise


def stable_faces(hull: Hull, basins: Landscape) -> list[Face]:
    """Return the faces the part rests on, one for each basin; strips of one coarse curve make one.

    Parameters
    ----------
    hull : Hull
    basins : Landscape
        Of that hull.

    Returns
    -------
    list of Face
    """
    labels = _coarse_curves(hull, basins)
    sides = _smooth_sides(hull, basins, labels)
    lowest, strips = _strips(hull, basins, np.unique(labels, return_inverse=True)[1], sides)
    return _describe_faces(hull, strips, lowest, stable=True)


def unstable_faces(hull: Hull, basins: Landscape, stable: list[Face]) -> list[Face]:
    """Return the faces made of the triangles that no stable face has taken: the part rolls off them.

    Parameters
    ----------
    hull : Hull
    basins : Landscape
    stable : list of Face

    Returns
    -------
    list of Face
    """
    free = np.ones(len(hull.triangles), dtype=bool)
    for face in stable:
        free[face.triangles] = False
    pairs = basins.pairs[free[basins.pairs].all(axis=1)]
    bend = angle(*(hull.normals[pairs[:, k]] for k in (0, 1)))
    step = np.abs(np.diff(hull.heights[pairs], axis=1))[:, 0]
    joined = (bend < ONE_PLANE) | ((bend < SMOOTH_ANGLE) & (step < RIPPLE_OF_RADIUS * hull.radius))
    labels = component_of(pairs[joined], len(free))
    order = np.flatnonzero(free)[np.argsort(labels[free], kind="stable")]
    parts = np.split(order, np.flatnonzero(np.diff(labels[order])) + 1) if len(order) else []
    largest = np.array([part[np.argmax(hull.areas[part])] for part in parts], dtype=int)
    return _describe_faces(hull, parts, largest, stable=False)


def _coarse_curves(hull: Hull, basins: Landscape) -> Ints:
    """Return a label of each sink (B,); strips of one coarsely tessellated curve share it."""
    place, sinks = np.searchsorted(basins.sinks, basins.ripples), basins.ripples
    levels = hull.heights[sinks]
    step = np.abs(np.diff(levels, axis=1))[:, 0] / levels.max(axis=1, initial=0.0)  # whichever comes first
    strips = (
        ~_intended_flats(hull, basins)[place].any(axis=1)
        & (basins.rises < MAX_RIPPLE_SHARE)
        & (basins.bends < SMOOTH_ANGLE)
        & (step < EQUAL_HEIGHT_SHARE + basins.bends**2)
    )
    labels = component_of(place[strips & (step < EQUAL_HEIGHT_SHARE)], len(basins.sinks))
    for label in np.flatnonzero(np.bincount(labels) > 1):
        group = np.flatnonzero(labels == label)
        if _spread(hull.normals[basins.sinks[group]]) < MIN_CURVE_ARC:
            labels[group] = labels.max() + 1 + np.arange(len(group))
    around = component_of(place[strips], len(basins.sinks))
    several = np.flatnonzero(np.bincount(around) > 1)
    sides = _smooth_sides(hull, basins, around)
    for label in several:
        group = np.flatnonzero(around == label)
        # on one round side: on many of its strips, or on a few of a rocker's
        sinks = basins.sinks[group]
        strips_turn = len(sinks) >= MIN_ROCKER_STRIPS and _spread(hull.normals[sinks]) >= MIN_CURVE_ARC
        if not (strips_turn and _is_round(hull, sinks)):
            lowest = sinks[np.argmin(hull.heights[sinks])]
            side = np.flatnonzero(np.isin(basins.basins, sinks) & (sides == sides[lowest]))
            if not (_may_roll(hull, [side])[0] and _is_rocker(hull, side, lowest)):
                continue
        labels[group] = labels.max() + 1
    return labels


def _strips(hull: Hull, basins: Landscape, group: Ints, sides: Ints) -> tuple[Ints, list[Ints]]:
    """Return the lowest sink (F,) and the triangles of each face, from the face (B,) of every sink."""
    count, sinks = group.max() + 1, basins.sinks
    at = np.searchsorted(sinks, basins.basins)
    triangles = np.lexsort((at, group[at]))
    owners, heights = group[at][triangles], hull.heights
    lowest = sinks[np.lexsort((heights[sinks], group))[group_starts(np.sort(group), count)]]
    level = (
        heights[triangles] <= heights[basins.basins[triangles]] * (1.0 + 1e-9) + FLATNESS * hull.radius / 2
    )
    on_side = sides[triangles] == sides[lowest][owners]
    strips = split_groups(triangles[level], owners[level], count)
    aside = split_groups(triangles[on_side], owners[on_side], count)
    rocking, own = _may_roll(hull, aside), split_groups(triangles, owners, count)
    for k in np.flatnonzero(rocking):
        rocking[k] = _is_rocker(hull, aside[k], lowest[k])
        strips[k] = aside[k] if rocking[k] else strips[k]
    still = np.flatnonzero(~rocking)
    flat = still[~_are_curved(hull, [strips[k] for k in still])]
    for k, plane in zip(flat, _planes(hull, lowest[flat], [own[k] for k in flat])):
        strips[k] = plane
    return lowest, strips


def _may_roll(hull: Hull, triangles: list[Ints]) -> Bools:
    """Return which faces (F,), each an array of triangles, have enough unlike triangles for a curve."""
    return _are_curved(hull, triangles) & (np.array(list(map(len, triangles))) >= MIN_ROCKER_STRIPS)


def _smooth_sides(hull: Hull, basins: Landscape, group: Ints) -> Ints:
    """Return a label of each triangle (T,); gentle bends within its group lead to all others of the same."""
    owner = group[np.searchsorted(basins.sinks, basins.basins)]
    first, second = basins.pairs.T
    joined = (owner[first] == owner[second]) & gentle(hull.normals, basins.pairs)
    return components(first[joined], second[joined], len(owner))[1]


def _is_rocker(hull: Hull, side: Ints, sink: int) -> bool:
    """Return whether a side that may roll is a curve in strips; its axis may pass by the centre of mass."""
    normals, share = hull.normals[side], hull.areas[side] / hull.areas[side].sum()
    leans = angle(normals, hull.normals[sink])
    if share[leans < 0.5 * SMOOTH_ANGLE].sum() > 0.5:
        return False
    # strips that lean do so alike: a cone about a flat touches a ball, too
    leaning = leans > CONE_LEAN_TOLERANCE
    lean = np.average(leans[leaning], weights=share[leaning])
    alike = share[np.abs(leans - lean) < CONE_LEAN_TOLERANCE].sum()
    if alike > (1.0 - SLIVERS) * share[leaning].sum():
        return False
    across = vectors.eigen(vectors.covariance(normals, share))[0]
    fewest = MIN_ROCKER_STRIPS if across[0] < MAX_CONE_VARIANCE * across[1] else FEWEST_OF_A_BALL
    return _effective_strips(normals, share) > fewest - 0.5 and _is_round(hull, side)


def _effective_strips(normals: Floats, share: Floats) -> float:
    """Return the effective number of strips of normals (N, 3): 1 over the sum of squared shares (N,)."""
    places = vectors.product(np.round(100.0 * normals), np.array([1.0, 1e3, 1e6]))  # one number a direction
    strips = np.unique(places, return_inverse=True)[1]
    weights = np.bincount(strips, share)
    return weights.sum() ** 2 / (weights**2).sum()


def _is_round(hull: Hull, triangles: Ints) -> bool:
    """Return whether triangles touch one cylinder, cone or ball, wherever its middle is.

    The height of a tangent plane over the centre of mass is linear in its normal there: h = r + n . m with
    the radius r and the middle m.
    """
    weights, height = np.sqrt(hull.areas[triangles]), hull.heights[triangles]
    around = np.column_stack([np.ones(len(triangles)), hull.normals[triangles]])
    off = vectors.misfit(around * weights[:, None], height * weights)
    return bool(vectors.length(off) < EQUAL_HEIGHT_SHARE * height.mean() * vectors.length(weights))


def _describe_faces(hull: Hull, triangles: list[Ints], lowest: Ints, stable: bool) -> list[Face]:
    """Return records of the faces made of triangles, a list of F arrays, from the lowest (F,) of each."""
    if not len(triangles):
        return []
    curved, feet, count = _are_curved(hull, triangles), list(triangles), len(triangles)
    some = np.flatnonzero(curved)
    for k, foot in zip(some, _planes(hull, lowest[some], [triangles[k] for k in some], of_curves=True)):
        feet[k] = foot
    standing, owners = join_groups(feet)
    # normals, heights and roughness of what each face stands on
    weights = np.maximum(hull.areas[standing], SMALLEST_NORMAL)
    whole = group_sums(weights, owners, count)
    normals = vectors.unit(group_sums(weights * hull.normals[standing].T, owners, count))
    above = vectors.dot(hull.vertices[hull.triangles[standing]], normals[owners][:, None])
    middle = group_sums(above.sum(axis=1), owners, count) / (3 * np.bincount(owners, minlength=count))
    off = np.abs(above - middle[owners][:, None]).max(axis=1)
    heights, roughness = (
        group_sums(depths * weights, owners, count) / whole for depths in (hull.heights[standing], off)
    )
    # corners of its triangles, each once
    corners = np.unique(owners[:, None] * len(hull.vertices) + hull.triangles[standing])
    owners, corners = np.divmod(corners, len(hull.vertices))
    polygons = contact_outlines(hull.vertices, corners, owners, normals)
    members, owners = join_groups(triangles)
    middles = group_sums(
        hull.areas[members] * np.ascontiguousarray(hull.normals.T)[:, members], owners, count
    )
    areas, angles = (group_sums(of[members], owners, count) for of in (hull.areas, hull.solid_angles))
    axes = np.full((count, 3), np.nan)
    for k in some:
        axes[k] = _axis(hull.normals[triangles[k]], hull.areas[triangles[k]], normals[k])
        heights[k] = _rolling_height(polygons[k], axes[k], heights[k])
    return [
        Face(
            kind="rolling" if curved[k] else "flat",
            stable=stable,
            normal=normals[k],
            axis=axes[k],
            middle=middles[k] / max(float(areas[k]), SMALLEST_NORMAL) if curved[k] else normals[k],
            height=float(heights[k]),
            area=float(areas[k]),
            solid_angle=float(angles[k]),
            polygon=polygons[k],
            triangles=triangles[k],
            roughness=float(roughness[k]),
        )
        for k in range(count)
    ]


def _axis(normals: Floats, weights: Floats, lowest: Floats) -> Floats:
    """Return the axis of the cylinder or cone with these normals: all make one angle with it; NaN for a ball.

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


def _are_curved(hull: Hull, triangles: list[Ints]) -> Bools:
    """Return which faces (F,), each an array of triangles, are strips of a curve and not a plane."""
    if not len(triangles):
        return np.empty(0, dtype=bool)
    (members, owners), count = join_groups(triangles), len(triangles)
    areas = hull.areas[members]
    mean = group_sums(areas * np.ascontiguousarray(hull.normals.T)[:, members], owners, count)
    several = np.bincount(owners, minlength=count) > 2
    bent = several & (vectors.norm(mean) < CURVED * group_sums(areas, owners, count))
    for k in np.flatnonzero(bent):
        bent[k] = _effective_strips(hull.normals[triangles[k]], hull.areas[triangles[k]]) > MAX_BEND_STRIPS
    return bent


def _spread(normals: Floats) -> float:
    """Return the angle [rad] across a set of directions, between the two furthest apart."""
    if len(normals) > MOST_PAIRED:  # from the one furthest from their mean
        end = normals[np.argmax(angle(normals, normals.mean(axis=0)))]
        return float(angle(normals, end).max())
    first, second = np.divmod(np.argmin(vectors.product(normals, normals.T)), len(normals))
    return float(angle(normals[first], normals[second]))


def _planes(hull: Hull, sinks: Ints, members: list[Ints], of_curves: bool = False) -> list[Ints]:
    """Return the members about each sink (F,) that lie in the plane there and in the sink's own; ascending.

    It is the tightest plane that holds most of what noise allows, and that a looser one would hardly add to:
    in a clean file the face itself without the shallow bevels beside it, in a noisy one all of it. Of a curve
    one strip is wanted, though the halves of the strips beside it may lie as shallow.
    """
    if not len(sinks):
        return []
    fewest = np.full(len(members), 2)  # triangles of a strip; 1 where most meet at the tip of a cone
    for k, each in enumerate(members if of_curves else ()):
        if np.bincount(hull.triangles[each].ravel()).max() > 0.5 * len(each):
            fewest[k] = 1
    triangles, owners = join_groups([np.sort(each) for each in members])
    depth = _plane_depth(hull, sinks, triangles, owners)
    lean = vectors.dot(hull.normals[triangles], hull.normals[sinks][owners])
    near = (depth < FLATNESS * hull.radius) & (lean > GENTLE_COSINE)
    triangles, owners, tight = triangles[near], owners[near], depth[near] < TIGHTEST_FIRST[0] * hull.radius
    if tight.all():
        return split_groups(triangles, owners, len(sinks))
    # about the largest triangle of each, the tightest plane that holds enough
    first, areas = group_starts(owners, len(fewest)), hull.areas[triangles]
    own = np.where(tight, areas, -1.0) if of_curves else areas
    largest = triangles[np.lexsort((-own, owners))[first]]
    inside = _plane_depth(hull, largest, triangles, owners) <= hull.radius * TIGHTEST_FIRST[:, None]
    held = np.add.reduceat(inside * areas, first, axis=1)
    count = np.add.reduceat(inside, first, axis=1, dtype=int)
    shared = held / np.add.reduceat(areas, first) - 0.1 * (count < 2)  # one triangle is a plane by itself
    enough = shared >= 0.5
    if of_curves:
        enough |= count >= fewest
    good = enough[:-1] & (held[1:] <= 1.02 * held[:-1])
    chosen = np.where(good.any(axis=0), good.argmax(axis=0), len(TIGHTEST_FIRST))
    inside = np.concatenate([inside, np.ones((1, len(triangles)), dtype=bool)])
    in_plane = tight | inside[chosen[owners], np.arange(len(triangles))]
    return split_groups(triangles[in_plane], owners[in_plane], len(sinks))


def _plane_depth(hull: Hull, planes: Ints, members: Ints, owners: Ints) -> Floats:
    """Return how far (N,) [m] the corners of each member lie off the plane of its owner's triangle."""
    corners = hull.triangles[members].T
    above = vectors.dot(hull.vertices[corners], hull.normals[planes][owners])
    return np.abs(above - hull.heights[planes][owners]).max(axis=0)


def contact_outlines(vertices: Floats, corners: Ints, owners: Ints, normals: Floats) -> list[Floats]:
    """Return the convex outlines of points about planes, counter-clockwise against the normal.

    Parameters
    ----------
    vertices : (V, 3) float [m]
    corners : (N,) int
        Points of the outlines, by their rows in ``vertices``.
    owners : (N,) int
        Outline to which each point belongs, ascending.
    normals : (F, 3) float [1]
        Of the planes, outward.

    Returns
    -------
    list of F (K, 3) float [m]
        No corner is on a line between its neighbours. Where all points lie on one line they are returned as
        they are.

    References
    ----------
    Own; docs/resting.md, "Barriers and the tipping graph".
    """
    points, count = vertices[corners], len(normals)
    x, y = (vectors.dot(points, axes[owners]) for axes in vectors.plane_axes(normals))
    u, v = (along - (group_sums(along, owners, count) / np.bincount(owners))[owners] for along in (x, y))
    around = np.lexsort((np.arctan2(v, u), owners))
    # Sorted by angle about their mean, most outlines are convex already: they turn left at every corner.
    # Only the others need a hull algorithm.
    x, y, first = x[around], y[around], group_starts(owners, count)
    before = np.arange(len(x)) - 1
    before[first] = np.append(first[1:], len(x)) - 1
    u, v = x - x[before], y - y[before]
    p, q = u[before], v[before]
    off = (p * v - q * u) / np.maximum(np.hypot(p + u, q + v), SMALLEST_NORMAL)
    width, depth = (np.maximum.reduceat(at, first) - np.minimum.reduceat(at, first) for at in (x, y))
    convex = np.logical_and.reduceat(off > ON_A_LINE * np.hypot(width, depth)[owners], first)
    turned, as_given = (split_groups(of, owners, count) for of in (points[around], points))
    return [
        polygon if sound else _of_extreme_points(own, normal)
        for polygon, sound, own, normal in zip(turned, convex, as_given, normals)
    ]


def _of_extreme_points(points: Floats, normal: Floats) -> Floats:
    """Return the outline where some of the points lie within it or straight between others."""
    plane = vectors.product(points, np.column_stack(vectors.plane_axes(normal)))
    try:
        corners = points[spatial.ConvexHull(plane).vertices]
    except spatial.QhullError:  # a contact line: a sliver of the hull
        return points
    # A finer triangulation brings corners on a line between their neighbours; rules that average over the
    # edges of a contact would count its edges twice.
    size = vectors.length(np.ptp(corners, axis=0))
    while len(corners) > 3:
        before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
        twice = vectors.length(vectors.cross(corners - before, after - corners))
        off = twice / np.maximum(vectors.length(after - before), SMALLEST_NORMAL)
        straight = int(np.argmin(off))
        if off[straight] > ON_A_LINE * size:
            break
        corners = np.delete(corners, straight, axis=0)
    return corners


def _rolling_height(polygon: Floats, axis: Floats, flat: float) -> float:
    """Return the height [m] of the centre of mass over the line on which a round side rolls.

    The strip's corners (K, 3) [m] lie on circles about the axis, and the line of contact touches the two at
    the strip's ends. Where the axis passes the centre of mass by, or there is none, it is the height
    ``flat``.
    """
    if np.isnan(axis).any() or not len(polygon):
        return flat
    along = vectors.product(polygon, axis)
    radii = np.sqrt(((polygon - along[:, None] * axis) ** 2).sum(axis=1))
    low, high, near = along.min(), along.max(), LINE_END_TOLERANCE * max(np.ptp(along), np.finfo(float).tiny)
    ends = [radii[along <= low + near], radii[along >= high - near]]
    for end in ends:  # two corners and more of one radius, or a point on the axis
        alike = np.ptp(end) <= CIRCLE_TOLERANCE * flat
        if high - low <= near or not alike or not (len(end) > 1 or end[0] <= CIRCLE_TOLERANCE * flat):
            return flat
    first, last = (end.max() for end in ends)
    return float((first * high - last * low) / np.hypot(high - low, last - first))
