"""The bowl that a part needs: diameter, width and climb of the track, turns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import BALANCED, Sizing, Track, Unbalance
from feederscrew.errors import FeederError
from feederscrew.geometry.polygons import turned
from feederscrew.mechanics.wall.stable_headings import headings
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import posture
from feederscrew.tooling.devices.orientation_names import nearest

STRAIGHT_TRACK = Track(climb=0.0, bank=0.0, radius=1e3, width=1.0)  # [m] a wall without a bend
MAX_SIZING_ITERATIONS = 200  # of a search that halves its error in each
DIAMETER_TOLERANCE_M = 1e-12  # [m]
MIN_WALL_ABOVE_PART_M = (
    5e-3  # [m] of upright wall over a part on a track or below its rails, at least, where it steps out
)
MAX_WALL_SLOPE = 0.9  # slope, a little over 40 deg, of a wall between two turns that lie beside each other


@dataclass(frozen=True)
class Lying:
    """A part on its stable aspects along a straight wall."""

    longest: float  # [m] along the wall, of every stable orientation
    tallest: float  # [m]
    length: float  # [m] along the wall, of the longest orientation that is wanted
    width: float  # [m] from the wall, of the widest orientation that is wanted
    hanging: float = 0.0  # [m] greatest length of a part that leaves hanging; 0 where none does


@dataclass(frozen=True)
class Size:
    """Bowl and track."""

    diameter: float  # [m]
    least: dict[str, float]  # [m] diameter that each rule asks for
    track_width: float  # [m]
    clearance: float  # [m] play of the part across the track
    bend: float  # [m] l^2 / (4 R): its sagitta on both sides
    climb: float  # [rad]
    depth: float  # [m] rise of the track
    turns: float
    pitch: float  # [m] rise of one turn
    mass: float | None = None  # [kg] of the bowl, where it is known from its solid
    inertia: float | None = None  # [kg m2] of the same about its axis
    unbalance: Unbalance = BALANCED  # of the same
    room: float | None = None  # [m] radius of its inside at the bottom, where its solid steps outwards


@dataclass(frozen=True, eq=False)
class SizedShape:
    """One part against the wall, seen from above; x ahead, y inwards, from its centre of mass."""

    outline: np.ndarray  # (J, 2) [m]
    to_wall: float  # [m] from the foot of the centre of mass
    length: float  # [m] along the wall


def lying(part: Part, aspects: Aspects, wanted: tuple[str, float] | None = None) -> Lying:
    """Compute the room a part takes along a wall.

    Source: docs/bowl.md, "1. The part, and the rate".

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    wanted : (str, float [rad]), optional
        Aspect and heading that shall leave the bowl; without it, every stable orientation.

    Returns
    -------
    Lying

    Raises
    ------
    FeederError
        If the part is a card without an outline.
    """
    stood = [posture(part, aspects, aspects.names[row]) for row in np.flatnonzero(aspects.stable)]
    found = [headings(one, STRAIGHT_TRACK) for one in stood]
    rows = [(one.aspect, *row) for one in found for row in zip(one.headings, one.lengths, one.widths)]
    counted = rows if wanted is None else [rows[_place([row[:2] for row in rows], wanted)]]
    return Lying(
        longest=float(max(row[2] for row in rows)),
        tallest=float(max(np.max(one.corners[:, 2]) for one in stood)),
        length=float(max(row[2] for row in counted)),
        width=float(max(row[3] for row in counted)),
    )


def shape(part: Part, aspects: Aspects, track: Track, wanted: tuple[str, float] | None = None) -> SizedShape:
    """Return the wanted orientation on a track, or else the most frequent heading of the first aspect."""
    name = aspects.names[int(np.flatnonzero(aspects.stable)[0])] if wanted is None else wanted[0]
    stood = posture(part, aspects, name)
    found = headings(stood, track)
    row = 0 if wanted is None else _place([(name, heading) for heading in found.headings], wanted)
    outline = check.frozen(turned(stood.outline, found.headings[row]))
    return SizedShape(outline, float(found.distances[row]), float(found.lengths[row]))


def size(
    part: Lying,
    given: str,
    rules: Sizing,
    *,
    sorts: bool,
    diameter: float | None = None,
    width: float | None = None,
    climb: float | None = None,
) -> Size:
    """Compute the bowl that holds and carries a part.

    Source: a published bowl generator and the keys of ``sizing``;
    docs/bowl.md, "1. The part, and the rate".

    Parameters
    ----------
    part : Lying
    given : str
        What a fault names: the part's file.
    rules : Sizing
    sorts : bool
        Whether a given width may be too little for some orientations, which then fall off it.
    diameter, width : float [m], optional
        Those of a bowl that exists.
    climb : float [rad], optional

    Returns
    -------
    Size

    Raises
    ------
    FeederError
        If it takes a bowl that nobody builds, or the given one is smaller than the part.
    """
    play = float(np.clip(rules.clearance * part.width, rules.least_clearance, rules.greatest_clearance))
    least = _diameters(part, play, rules, width, sorts)
    across = _rounded_up(max(least.values()), rules.diameter_step) if diameter is None else diameter
    _check_diameter(across, part, given, rules, fixed=diameter is not None)
    bend = part.length**2 / (2.0 * across)
    wide = part.width + play + bend if width is None else width
    depth = rules.outlet_height if rules.outlet_height > 0.0 else rules.depth * across
    angle = _climb(part, across, wide, rules) if climb is None else climb
    pitch = np.pi * across * np.tan(angle)
    turns = depth / pitch if pitch > 0.0 else np.nan
    return Size(across, least, wide, play, bend, float(angle), depth, float(turns), float(pitch))


def _climb(part: Lying, across: float, wide: float, rules: Sizing) -> float:
    """The least climb [rad]: parts pass below the next turn, or below the slope that leads to it."""
    rise, way = rules.headroom * part.tallest + rules.sheet, np.pi * across
    if rules.shape != "cylinder":
        free = [
            max(rules.headroom * one, one + MIN_WALL_ABOVE_PART_M)
            for one in (part.tallest, part.hanging)
            if one > 0.0
        ]
        rise = sum(free) + MAX_WALL_SLOPE * wide + 4.0 * rules.sheet
        way = np.pi * (across - wide)
    return max(rules.least_climb, np.arctan(rise / way))


def _diameters(part: Lying, play: float, rules: Sizing, width: float | None, sorts: bool) -> dict[str, float]:
    """The diameter that each rule asks for [m]; width and bend of the track hang on each other."""
    least = {
        "no bowl is smaller": rules.least_diameter,
        "length of the part": rules.diameter_per_length * part.longest,
    }
    if width is not None:
        room = width - part.width - play
        least["width of the track"] = rules.diameter_per_width * width
        if sorts and room <= 0.0:
            return least
        least["bend on this track"] = part.length**2 / (2.0 * room) if room > 0.0 else np.inf
        return least
    across = max(least.values())
    for _ in range(MAX_SIZING_ITERATIONS):
        before = across
        wide = part.width + play + part.length**2 / (2.0 * across)
        across = max(*least.values(), rules.diameter_per_width * wide)
        if abs(across - before) < DIAMETER_TOLERANCE_M:
            break
    return least | {"width of the track": rules.diameter_per_width * wide}


def _check_diameter(across: float, part: Lying, given: str, rules: Sizing, *, fixed: bool) -> None:
    if np.isinf(across):
        what = f"needs {1e3 * part.width:.4g} mm of track and its play, more than track.width"
        raise FeederError(given, what, "widen the track, or leave track.width out")
    if across > rules.greatest_diameter:
        what = f"needs a bowl of {1e3 * across:.4g} mm, and none is larger than"
        mend = "feed it from a step or belt feeder, or raise sizing.greatest_diameter"
        raise FeederError(given, f"{what} {1e3 * rules.greatest_diameter:.4g} mm", mend)
    if fixed and across < 2.0 * part.longest:
        what = f"{500.0 * across:.4g} mm is too small for a part {1e3 * part.longest:.4g} mm long"
        raise FeederError("track.radius", what, "leave it out, to have the bowl sized")


def _place(known: Sequence[tuple[str, float]], wanted: tuple[str, float]) -> int:
    """Which of some aspects and headings [rad] is the wanted one, known from a straight track."""
    aspects, headings = zip(*known)
    return nearest(aspects, headings, *wanted)


def _rounded_up(value: float, step: float) -> float:
    return float(np.ceil(value / step - 1e-9) * step)
