"""Stable headings of a part along the bowl wall, how often each comes, whether it stays on the track.

Axes of the track: X ahead, Y from the wall towards the bowl's axis, Z up from the surface; the bowl climbs
counter-clockwise seen from above. For a bowl that climbs clockwise take the mirror image of the part.

A convex outline is pushed against the inside of the wall. Seen from the part, the bowl's axis O may lie
anywhere within the wall's radius of every corner. Pushed outward, the part moves until O is as far from the
centre of mass's foot G as that allows: on a corner of this region, where two corners of the outline touch
the wall. The radius may be infinite: a straight wall.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Array, Bools, Floats, Ints, Points, Reals
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import cross, inset, sides, turned
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import Keywords
from feederscrew.bowl.record import Track
from feederscrew.motion import sameness
from feederscrew.resting.posture import Posture

SAME_TOP_SHARE = 0.1  # of that depth: tops of a curved end that differ by less are one, and halved
MIN_DIP_SHARE = 1e-2  # of the outline's size: dips between headings shallower than this are facets of a curve
PLACE_TOLERANCE_M = 1e-12  # [m] places along the track nearer than this are one
EDGE_TOLERANCE = 1e-6  # of the outline's size: nearer than this to the edge is on it
OUTLINE_TOLERANCE = 1e-5  # of the outline's size: outlines that differ by less are the same
NO_TURN = 1e-5  # [rad] files in single precision turn a part by a hundredth of it
SHARE_TIE = 1e-4  # shares that differ by less of themselves are equal but for rounding


@dataclass(frozen=True, eq=False)
class Rests:
    """Every way an outline lies against the wall, M of them, by angle of the outward direction."""

    outward: Floats  # (M,) [rad] of the direction to the wall through the foot, in body axes, -pi to pi
    touching: Floats  # (M, 2, 2) [m] the two corners at the wall, the trailing one first
    distance: Floats  # (M,) [m] from the foot to the wall along that direction
    share: Floats  # (M,) [1] of the circle of directions that end there when pushed
    start: Floats  # (M,) [rad] where that range of directions begins, counter-clockwise
    rounded: bool = False  # the outline is round as far as is known: every direction is as good


@dataclass(frozen=True, eq=False)
class Headings(ReadableRecord):
    """Every stable heading of one posture on one track, the most frequent first, equals from 0 on; M rows."""

    aspect: str
    headings: Floats  # (M,) [rad] from the track's direction to the body's own, 0 to 2 pi
    shares: Floats  # (M,) [1] of all directions of laying down
    turns: Ints  # (M,) int, how many turns about the vertical lay the part down the same way
    ranges: Floats  # (N, 2) [rad] begin and width of each range of headings that settles in a row
    settles: Ints  # (N,) int, the row they settle in
    straight_shares: Floats  # (M,) [1] of such a heading at a straight wall; NaN: a round outline
    lengths: Floats  # (M,) [m] along the track
    widths: Floats  # (M,) [m] of the track it covers
    distances: Floats  # (M,) [m] from the foot of the centre of mass to the wall
    overhangs: Floats  # (M,) [m] beyond the track's free edge
    falls_off: Bools  # (M,) bool
    touching: Floats  # (M, 2, 2) [m] corners at the wall, trailing one first, in track axes from the foot
    half_turns: Ints  # (M,) int, the row with the same outline turned by half; -1 where there is none
    mirrors: Ints  # (M,) int, the row with the mirror image of the outline; -1 for none but itself
    rounded: bool  # round in plan: it takes any heading


def rests(outline: Points, radius: float, merge: float = MIN_DIP_SHARE) -> Rests:
    """Return every way in which an outline can lie against a wall.

    Seen from the part, the bowl's axis O may lie anywhere within the wall's radius of every corner. A part
    that is pushed outward moves until O is as far from the foot G of the centre of mass as that allows, and
    turns to the rest in whose range of directions it was laid down: the plane's counterpart of quasi-static
    tumbling.

    Parameters
    ----------
    outline : (J, 2) float [m]
        Convex, counter-clockwise seen from above, from the foot of the centre of mass.
    radius : float [m]
        Of the wall, not below the outline's greatest extent; infinite for a straight wall.
    merge : float [1]
        Headings divided by a lesser rise of the centre of mass's distance, over the outline's size, count as
        one: the facets of a tessellated curve.

    Returns
    -------
    Rests
        M rows by angle; their shares sum to 1.

    Raises
    ------
    ValueError
        If the outline is not an array of corners, or the foot is not inside it.

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    outline = check.shaped("outline", outline, (-1, 2))
    if not inset(outline, np.zeros(2)) > 0.0:
        raise ValueError("the outline does not hold the foot of the centre of mass")
    # Keep the corners that can reach the wall. Two neighbours on a curved wall bridge the corner between them
    # where it lies farther from the wall's arc than zero; the farthest is taken out first.
    corners = outline
    while len(corners) > 2 and np.isfinite(radius):
        middle, inward, half = _chord(np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0))
        depth = radius - np.sqrt(radius**2 - half**2)  # of the wall behind the chord
        sideways, behind = cross(inward, corners - middle), -np.einsum("ki,ki->k", inward, corners - middle)
        gap = depth - behind - (radius - np.sqrt(radius**2 - sideways**2))
        if gap.max() < 0.0:
            break
        corners = np.delete(corners, np.argmax(gap), axis=0)
    # direction to the wall through the foot, and the foot's distance from it, two corners touching
    after = np.roll(corners, -1, axis=0)
    middle, inward, half = _chord(corners, after)
    in_line = np.einsum("ki,ki->k", middle, inward)
    if np.isinf(radius):
        outward, distance = np.arctan2(-inward[:, 1], -inward[:, 0]), -in_line
    else:
        reach = np.sqrt(radius**2 - half**2)
        centre = middle + reach[:, None] * inward
        rise = half**2 - np.einsum("ki,ki->k", middle, middle) - 2.0 * reach * in_line  # R^2 - far^2, exactly
        outward, distance = np.arctan2(-centre[:, 1], -centre[:, 0]), rise / (radius + np.hypot(*centre.T))
    # A pair of corners is a stable rest where the outward direction passes between them. A corner alone
    # balances where it passes through that corner: the top between two rests.
    towards = np.arctan2(corners[:, 1], corners[:, 0])
    stable = (_angle_between(towards, outward) > 0.0) & (_angle_between(outward, np.roll(towards, -1)) > 0.0)
    balanced = (_angle_between(np.roll(outward, 1), towards) > 0.0) & (_angle_between(towards, outward) > 0.0)
    lowest, highest = np.flatnonzero(stable), np.flatnonzero(balanced)
    tops = highest[np.searchsorted(highest, lowest, side="right") - 1]  # the corner it tips over backwards
    # Dips join their neighbour over borders that rise less than ``least`` above them. Of each: its depth, the
    # height of the border before it and where that border lies.
    lows, heights, borders = distance[lowest], np.hypot(*corners[tops].T), towards[tops]
    dips, edges, starts = list(range(len(lows))), dict(enumerate(heights)), []
    least = merge * np.hypot(*corners.T).max()
    while len(dips) > 1:
        rises = [min(edges[k], edges[dips[(i + 1) % len(dips)]]) - lows[k] for i, k in enumerate(dips)]
        i = int(np.argmin(rises))
        if rises[i] >= least:
            break
        # dip i goes to the neighbour behind the lower of its two borders
        here, following = dips[i], dips[(i + 1) % len(dips)]
        edges[following] = max(edges[here], edges[following])
        dips.pop(i)
    for i, dip in enumerate(dips):
        # the middle of the highest tops between two dips that are left: an even end is shared evenly
        before = dips[i - 1]
        between = (before + 1 + np.arange((dip - before - 1) % len(heights) + 1)) % len(heights)
        level = heights[between].max() - SAME_TOP_SHARE * least
        highest = borders[between[heights[between] >= level]]
        starts.append(highest[0] + 0.5 * np.mod(highest[-1] - highest[0], 2.0 * np.pi))
    start, chosen = np.array(starts), lowest[np.array(dips)]
    share = np.mod(np.roll(start, -1) - start, 2.0 * np.pi) / (2.0 * np.pi)
    return Rests(
        outward=check.frozen(outward[chosen]),
        touching=check.frozen(np.stack([corners[chosen], after[chosen]], axis=1)),
        distance=check.frozen(distance[chosen]),
        share=check.frozen(np.where(share > 0.0, share, 1.0)),
        start=check.frozen(start),
        rounded=bool(max(heights) - min(lows) < 2.0 * least),
    )


def _chord(first: Points, second: Points) -> tuple[Floats, Floats, Floats]:
    """Return the middle of two corners, the unit vector into the outline, and half their distance."""
    along = second - first
    length = np.hypot(along[..., 0], along[..., 1])
    inward = np.stack([-along[..., 1], along[..., 0]], axis=-1) / length[..., None]
    return 0.5 * (first + second), inward, 0.5 * length


def _angle_between(start: Reals, end: Reals) -> Floats:
    """Return the angle from one direction on to another, -pi to pi."""
    return np.mod(end - start + np.pi, 2.0 * np.pi) - np.pi


def supported_reaches(headings: Headings, posture: Posture, track: Track) -> list[Floats]:
    """Return how far from the wall a track supports a part in each of its Headings.

    The support is the hull of the part's foot as far as it lies over the track. Only the side of that hull
    away from the wall matters for falling off, so that side alone is returned.

    Parameters
    ----------
    headings : Headings
    posture : Posture
        Its ``feet`` are the edges that touch the track.
    track : Track
        Its radius and width.

    Returns
    -------
    list of (K, 2) float [m]
        One array a heading: places along the track and how far the support reaches there, as seen from the
        centre of mass. No rows where the track supports nothing.

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    reaches, edge = [], track.radius - track.width
    for angle, wall in zip(headings.headings, headings.distances):
        edges = turned(posture.feet, angle)
        points = edges.reshape(-1, 2)
        if edge > 0.0:  # the ends of what lies over the track
            centre = np.array([0.0, track.radius - wall])
            on = points[np.hypot(*(points - centre).T) >= edge]
            # with the points where sides cross the track's edge, a circle
            first, way = edges[:, 0] - centre, edges[:, 1] - centre - (edges[:, 0] - centre)
            a, b, c = vectors.dot(way, way), vectors.dot(first, way), vectors.dot(first, first) - edge**2
            meets = (b * b - a * c > 0.0) & (a > 0.0)
            first, way, a, b, c = first[meets], way[meets], a[meets], b[meets], c[meets]
            shares = (-b + np.sqrt(b * b - a * c) * np.array([[-1.0], [1.0]])) / a
            root, row = np.nonzero((shares >= 0.0) & (shares <= 1.0))
            points = np.concatenate([on, centre + (first[row] + shares[root, row][:, None] * way[row])])
        # The side of their hull that is away from the wall: the upper chain of a convex hull (Andrew). Places
        # are rounded, so that points above one another sort by their distance and not by rounding.
        along = PLACE_TOLERANCE_M * np.round(points[:, 0] / PLACE_TOLERANCE_M)
        places = np.column_stack([along, points[:, 1]])
        chain: list[Floats] = []
        for point in places[np.lexsort((-places[:, 1], places[:, 0]))]:
            if chain and point[0] == chain[-1][0]:
                continue  # nearer to the wall than the one before
            while len(chain) > 1 and cross(chain[-1] - chain[-2], point - chain[-1]) >= 0.0:
                chain.pop()
            chain.append(point)
        reaches.append(np.array(chain).reshape(-1, 2))
    return reaches


def falls_off(posture: Posture, reach: Points, track: Track) -> bool:
    """Return whether the part tips over the track's free edge.

    It does where the line of its weight meets the surface beyond what the track supports, on the side of the
    free edge. Towards the wall the part leans on the wall; ahead or behind it tips without leaving the track.
    A part that rolls touches along a line through its foot: it falls where the track ends before that line,
    however wide the strip of its file is.

    Parameters
    ----------
    posture : Posture
    reach : (K, 2) float [m]
        Of one heading, from ``supported_reaches``.
    track : Track
        Its climb and bank.

    Returns
    -------
    bool

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    if len(reach) == 0:
        return True
    # the line of the weight from the centre of mass, h above the surface, in track axes
    slope = np.array([np.sin(track.climb), np.cos(track.climb) * np.sin(track.bank)])
    ahead, inward = -posture.height * slope / (np.cos(track.climb) * np.cos(track.bank))
    least, most = EDGE_TOLERANCE * np.ptp(posture.outline, axis=0).max(), reach[:, 1].max()
    if posture.kind == "rolling":
        return bool(inward > most + least)
    along, off = reach.T
    return bool(inward > np.interp(ahead, along, off, left=most, right=most) + least)


def headings(posture: Posture, track: Track) -> Headings:
    """Return the stable headings of a part with an outline against the wall of a Track.

    Rests that look the same are one heading: its share is theirs together.

    Parameters
    ----------
    posture : Posture
    track : Track

    Returns
    -------
    Headings
        M rows, the most frequent first.

    Raises
    ------
    FeederError
        If the bowl is smaller than the part, or the part is a card without an outline.

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    if len(posture.outline) == 0:
        what = f"the card of aspect {posture.name} has no outline"
        raise FeederError("part card", what, "give the part as a mesh")
    across = np.linalg.norm(posture.outline[:, None] - posture.outline, axis=-1).max()
    if np.min(track.radius) < across:
        what = f"{1e3 * np.min(track.radius):.4g} mm is less than the part's {1e3 * across:.4g} mm across"
        raise FeederError("track.radius", what, "give the radius of a bowl that holds the part")
    curved, straight = rests(posture.outline, track.radius), rests(posture.outline, np.inf)
    # Rests are ranked, so that the first of each kind is its most frequent one. ``first`` names for each rest
    # the first of its kind; the shares of a kind are added at that place.
    order = _rank_rests(curved.share, curved.outward)
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[sameness.first_alike(posture, _heading(curved.outward[order]))]
    shares, rows = np.bincount(first, curved.share, minlength=len(curved.share)), np.unique(first)
    order = rows[_rank_rests(shares[rows], curved.outward[rows])]
    turn, distances = _heading(curved.outward[order]), curved.distance[order]
    # how far each pair of headings is from being turned by half, and from being mirrored; a row is not its
    # own half turn
    halves = np.abs(_angle_between(turn, turn[:, None] + np.pi)) + np.pi * np.eye(len(turn))
    mirrored = np.abs(_angle_between(turn, np.pi - turn[:, None]))
    shapes, widths = [turned(posture.outline, angle) for angle in turn], []
    for shape, to_wall in zip(shapes, distances):  # from the wall to the innermost point
        if np.isinf(track.radius):
            widths.append(to_wall + shape[:, 1].max())
            continue
        centre, along = np.array([0.0, track.radius - to_wall]), sides(shape)
        part = np.clip(((centre - shape) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        nearest = shape + part[:, None] * along - centre
        widths.append(float(track.radius - np.hypot(*nearest.T).min()))
    width, nothing = 2.0 * np.pi * curved.share, np.zeros(len(turn))
    # shares at a straight wall of the rests whose range holds these directions
    into = np.mod(curved.outward[:, None] - straight.start, 2.0 * np.pi)
    at_straight = straight.share[(into / (2.0 * np.pi * straight.share)).argmin(axis=1)]
    at_straight = np.full(len(at_straight), np.nan) if straight.rounded else at_straight
    arrays = {
        "headings": turn,
        "shares": shares[order],
        "turns": np.bincount(first, minlength=len(shares))[order],
        "ranges": np.column_stack([_heading(curved.start + width), width]),
        "settles": np.array([np.flatnonzero(order == place)[0] for place in first]),
        "straight_shares": np.bincount(first, at_straight, minlength=len(at_straight))[order],
        "lengths": np.array([np.ptp(shape[:, 0]) for shape in shapes]),
        "widths": np.array(widths),
        "distances": distances,
        "overhangs": nothing,
        "falls_off": nothing > 0.0,
        "touching": turned(curved.touching[order], turn[:, None]),
        "half_turns": _partners(shapes, lambda shape: -shape, halves),
        "mirrors": _partners(shapes, lambda shape: shape * [-1.0, 1.0], mirrored),
    }
    frozen: Keywords = {name: check.frozen(array) for name, array in arrays.items()}
    return on_track(Headings(aspect=posture.name, rounded=curved.rounded, **frozen), posture, track)


def on_track(
    headings: Headings, posture: Posture, track: Track, reaches: Sequence[Points] | None = None
) -> Headings:
    """Return the same Headings on a track of another width, climb or bank, but of the same radius.

    Parameters
    ----------
    headings : Headings
    posture : Posture
    track : Track
    reaches : sequence of (K, 2) float [m], or None
        Result of ``supported_reaches`` for that width, where it is known already.

    Returns
    -------
    Headings
        With overhangs [m] and ``falls_off`` of this track.

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    reaches = supported_reaches(headings, posture, track) if reaches is None else reaches
    falls = np.array([falls_off(posture, reach, track) for reach in reaches])
    overhangs = np.maximum(headings.widths - track.width, 0.0)
    return replace(headings, overhangs=check.frozen(overhangs), falls_off=check.frozen(falls))


def stable_row(headings: Headings, heading: float | None = None) -> int:
    """Return the row of the heading that a part ends in, laid on the track and pushed to the wall.

    Parameters
    ----------
    headings : Headings
    heading : float [rad] or None
        As laid down; None takes the most frequent heading that stays on the track.

    Returns
    -------
    int

    Raises
    ------
    FeederError
        If the part falls off the track in that heading, or in every one.

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    if heading is None:
        if headings.falls_off.all():
            what = "the part falls off the track in every heading"
            raise FeederError(f"aspect {headings.aspect}", what, "give a wider track, or another aspect")
        return int(np.argmin(headings.falls_off))
    row = settled(headings, heading)
    if headings.falls_off[row]:
        what = f"the part needs {1e3 * headings.widths[row]:.4g} mm of track and falls off"
        where = f"aspect {headings.aspect}, heading {np.degrees(headings.headings[row]):.4g} deg"
        raise FeederError(where, what, "give a wider track, or another heading")
    return row


def settled(headings: Headings, heading: float) -> int:
    """Return the row in whose range of headings a part is laid down; on a border the one nearer in heading.

    Parameters
    ----------
    headings : Headings
    heading : float [rad]

    Returns
    -------
    int

    References
    ----------
    ``rests``.
    """
    # ranges are half open in exact numbers; rounding may leave a heading on a border beyond both
    lowest, width = headings.ranges.T
    beyond = np.mod(heading - lowest, 2.0 * np.pi) - width
    middle = np.abs(_angle_between(heading, lowest + 0.5 * width))
    return int(headings.settles[np.lexsort((middle, beyond > 1e-9))[0]])


def _rank_rests(share: Array, outward: Floats) -> Ints:
    """Return the places of rests, the most frequent first; those of equal shares by their headings."""
    order = np.argsort(-share)
    ordered = share[order]
    rank = np.zeros(len(order), dtype=int)
    rank[order[1:]] = np.cumsum(ordered[:-1] - ordered[1:] > SHARE_TIE * ordered[:-1])
    return np.lexsort((_heading(outward), rank))


def _heading(outward: Floats) -> Floats:
    """Return the turn that brings a body direction to the wall, at -Y; 0 to 2 pi, rounding of 0 removed."""
    turn = np.mod(-0.5 * np.pi - outward, 2.0 * np.pi)
    return np.where(np.minimum(turn, 2.0 * np.pi - turn) < NO_TURN, 0.0, turn)


def _partners(shapes: Sequence[Points], image: Callable[[Points], Points], astray: Floats) -> Ints:
    """Return for each outline the row that is its image, the least astray of several; -1 for none."""
    partner = np.full(len(shapes), -1)
    for i, shape in enumerate(shapes):
        like, mirrored = [], image(shape)
        for j, other in enumerate(shapes):
            if len(mirrored) == len(other):
                gap = np.linalg.norm(mirrored[:, None] - other, axis=-1).min(axis=1).max()
                like += [j] if gap < OUTLINE_TOLERANCE * np.abs(other).max() else []
        partner[i] = min(like, key=lambda j: round(astray[i, j], 3), default=-1)
    return np.where(partner == np.arange(len(shapes)), -1, partner)
