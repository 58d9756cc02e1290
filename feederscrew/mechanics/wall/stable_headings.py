"""How a part lies along the bowl wall: its stable headings, how often each comes, whether it stays on.

Axes of the track: X ahead, Y from the wall towards the bowl's axis, Z up from the surface; the bowl climbs
counter-clockwise seen from above. For a bowl that climbs clockwise take the mirror image of the part.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.errors import FeederError
from feederscrew.geometry.polygons import sides, turned
from feederscrew.mechanics.wall import sameness, support
from feederscrew.mechanics.wall.outline import rests
from feederscrew.records import ReadableRecord

OUTLINE_TOLERANCE = 1e-5  # of the outline's size: outlines that differ by less are the same
NO_TURN = 1e-5  # [rad] files in single precision turn a part by a hundredth of it
SHARE_TIE = 1e-4  # shares that differ by less of themselves are equal but for rounding


@dataclass(frozen=True, eq=False)
class Headings(ReadableRecord):
    """Every stable heading of one posture on one track, the most frequent first, equals from 0 on; M rows."""

    aspect: str
    headings: (
        np.ndarray
    )  # (M,) [rad] of the body's own direction, from the track's, counter-clockwise, 0 to 2 pi
    shares: np.ndarray  # (M,) [1] of all directions of laying down
    turns: np.ndarray  # (M,) int, how many turns about the vertical lay the part down the same way
    ranges: (
        np.ndarray
    )  # (N, 2) [rad] where each range of headings begins that settle in a row, how wide it is
    settles: np.ndarray  # (N,) int, the row they settle in
    straight_shares: (
        np.ndarray
    )  # (M,) [1] of the corresponding heading at a straight wall; NaN for a round outline
    lengths: np.ndarray  # (M,) [m] along the track
    widths: np.ndarray  # (M,) [m] of the track it covers
    distances: np.ndarray  # (M,) [m] from the foot of the centre of mass to the wall
    overhangs: np.ndarray  # (M,) [m] beyond the track's free edge
    falls_off: np.ndarray  # (M,) bool
    touching: np.ndarray  # (M, 2, 2) [m] corners at the wall, trailing one first, in track axes from the foot
    half_turns: np.ndarray  # (M,) int, the row with the same outline turned by half; -1 where there is none
    mirrors: np.ndarray  # (M,) int, the row with the mirror image of the outline; -1 for none but itself
    rounded: bool  # round in plan: it takes any heading


def headings(posture, track) -> Headings:
    """Return the stable headings of a part against the wall.

    Parameters
    ----------
    posture : Posture
        Of a part with an outline.
    track : Track
        Radius, width, bank and climb are used.

    Returns
    -------
    Headings

    Raises
    ------
    FeederError
        If the bowl is smaller than the part, or the part is a card without an outline.
    """
    _check_fits(posture, track)
    curved, straight = rests(posture.outline, track.radius), rests(posture.outline, np.inf)
    order, first, shares = _distinct(posture, curved)
    turn = _heading(curved.outward[order])
    halves = _angle_between(turn[:, None] + np.pi, turn) + np.pi * np.eye(
        len(turn)
    )  # a row is not its own half turn
    mirrored = _angle_between(np.pi - turn[:, None], turn)  # as the body's own axes are mirrored
    shapes = [turned(posture.outline, angle) for angle in turn]
    distances = curved.distance[order]
    widths = np.array([_width(shape, d, track.radius) for shape, d in zip(shapes, distances)])
    nothing = np.zeros(len(turn))
    geometry = Headings(
        aspect=posture.name,
        headings=check.frozen(turn),
        shares=check.frozen(shares[order]),
        turns=check.frozen(np.bincount(first, minlength=len(shares))[order]),
        ranges=check.frozen(_ranges(curved)),
        settles=check.frozen(np.array([np.flatnonzero(order == place)[0] for place in first])),
        straight_shares=check.frozen(_summed(_at_straight(curved.outward, straight), first)[order]),
        lengths=check.frozen(np.array([np.ptp(shape[:, 0]) for shape in shapes])),
        widths=check.frozen(widths),
        distances=check.frozen(distances),
        overhangs=check.frozen(nothing),
        falls_off=check.frozen(nothing > 0.0),
        touching=check.frozen(turned(curved.touching[order], turn[:, None])),
        half_turns=check.frozen(_partners(shapes, lambda shape: -shape, halves)),
        mirrors=check.frozen(_partners(shapes, lambda shape: shape * [-1.0, 1.0], mirrored)),
        rounded=curved.rounded,
    )
    return on_track(geometry, posture, track)


def on_track(headings, posture, track, reaches=None) -> Headings:
    """Return the same headings on a track of other width, climb or bank, but of the same radius.

    Source: own; docs/mechanics.md, "Headings".

    Parameters
    ----------
    headings : Headings
    posture : Posture
    track : Track
    reaches : list of (K, 2) float [m], optional
        What `support.reaches` gives for that width, where it is known already.

    Returns
    -------
    Headings
        With its own overhangs and falls.
    """
    reaches = support.reaches(headings, posture, track) if reaches is None else reaches
    falls = np.array([support.falls(posture, reach, track) for reach in reaches])
    overhangs = np.maximum(headings.widths - track.width, 0.0)
    return replace(headings, overhangs=check.frozen(overhangs), falls_off=check.frozen(falls))


def stable_row(headings, heading=None) -> int:
    """Return the row of the heading that a part ends in, laid on the track and pushed to the wall.

    Source: own; docs/mechanics.md, "Headings".

    Parameters
    ----------
    headings : Headings
    heading : float [rad], optional
        As laid down; without one, the most frequent heading that stays on the track.

    Returns
    -------
    int

    Raises
    ------
    FeederError
        If the part falls off the track in that heading, or in every one.
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


def settled(headings, heading) -> int:
    """Return the row whose range of headings [rad] holds one; on a border the one nearer in heading."""
    lowest, width = headings.ranges.T
    beyond = np.mod(heading - lowest, 2.0 * np.pi) - width
    middle = _angle_between(lowest + 0.5 * width, heading)
    return int(headings.settles[np.lexsort((middle, beyond > 1e-9))[0]])


def _distinct(posture, headings) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Places of the rests that are each other's like under no turn, ranked; of each rest the like that
    stands for it; the shares of all its likes together, at its place."""
    order = _ranked(headings.share, headings.outward)
    like = sameness.firsts(posture, _heading(headings.outward[order]))
    first = np.empty(len(order), dtype=int)
    first[order] = order[like]
    shares = _summed(headings.share, first)
    rows = np.unique(first)
    return rows[_ranked(shares[rows], headings.outward[rows])], first, shares


def _summed(shares, first) -> NDArray[Any]:
    """Shares of all rests that one stands for, at its place."""
    return np.bincount(first, shares, minlength=len(shares))


def _ranges(headings) -> NDArray[np.float64]:
    """(N, 2) [rad] where the range of headings of each rest begins, and how wide it is."""
    width = 2.0 * np.pi * headings.share
    return np.column_stack([_heading(headings.start + width), width])


def _ranked(share, outward) -> NDArray[np.int64]:
    """Places of rests, the most frequent first; those of equal shares by their headings."""
    order = np.argsort(-share)
    ordered = share[order]
    rank = np.zeros(len(order), dtype=int)
    rank[order[1:]] = np.cumsum(ordered[:-1] - ordered[1:] > SHARE_TIE * ordered[:-1])
    return np.lexsort((_heading(outward), rank))


def _angle_between(first, second) -> NDArray[np.float64]:
    """Angle between headings, 0 to pi."""
    return np.abs(np.mod(first - second + np.pi, 2.0 * np.pi) - np.pi)


def _check_fits(posture, track) -> None:
    if len(posture.outline) == 0:
        what = f"the card of aspect {posture.name} has no outline"
        raise FeederError("part card", what, "give the part as a mesh")
    across = np.linalg.norm(posture.outline[:, None] - posture.outline, axis=-1).max()
    if np.min(track.radius) < across:
        what = f"{1e3 * np.min(track.radius):.4g} mm is less than the part's {1e3 * across:.4g} mm across"
        raise FeederError("track.radius", what, "give the radius of a bowl that holds the part")


def _heading(outward) -> NDArray[np.float64]:
    """Turn that brings a body direction to the wall, at -Y; 0 to 2 pi, without the rounding of 0."""
    turn = np.mod(-0.5 * np.pi - outward, 2.0 * np.pi)
    return np.where(np.minimum(turn, 2.0 * np.pi - turn) < NO_TURN, 0.0, turn)


def _at_straight(outward, straight) -> NDArray[np.float64]:
    """Shares at a straight wall of the rests whose range holds these directions; NaN of a round outline."""
    if straight.rounded:
        return np.full(len(outward), np.nan)
    into = np.mod(outward[:, None] - straight.start, 2.0 * np.pi)
    return straight.share[(into / (2.0 * np.pi * straight.share)).argmin(axis=1)]


def _width(shape, to_wall, radius) -> float:
    """Radial extent from the wall to the innermost point of an outline in track axes."""
    if np.isinf(radius):
        return to_wall + shape[:, 1].max()
    centre = np.array([0.0, radius - to_wall])
    along = sides(shape)
    part = np.clip(((centre - shape) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    nearest = shape + part[:, None] * along - centre
    return float(radius - np.hypot(*nearest.T).min())


def _partners(shapes, image, astray) -> NDArray[np.int64]:
    """For each outline the row that is its image, of several the least astray; -1 for none but itself."""
    partner = np.full(len(shapes), -1)
    for i, shape in enumerate(shapes):
        like = [j for j, s in enumerate(shapes) if _same_corners(image(shape), s)]
        partner[i] = min(like, key=lambda j: round(astray[i, j], 3), default=-1)
    return np.where(partner == np.arange(len(shapes)), -1, partner)


def _same_corners(first, second) -> bool:
    """Whether two outlines have the same corners."""
    if len(first) != len(second):
        return False
    gap = np.linalg.norm(first[:, None] - second, axis=-1).min(axis=1).max()
    return gap < OUTLINE_TOLERANCE * np.abs(second).max()
