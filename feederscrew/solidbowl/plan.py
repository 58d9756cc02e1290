"""The measures of a bowl as a solid, decided before a facet is made."""

from dataclasses import dataclass

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.solidbowl import bolting
from feederscrew.solidbowl.bolting import BOLT_CLEARANCE_M
from feederscrew.solidbowl.cuts import Stretch
from feederscrew.solidbowl.materials import BowlMaterial
from feederscrew.solidbowl.stairs import CYLINDER, Stairs, stairs
from feederscrew.solidbowl.way import Way

ARC_CHORD_M = 5e-5  # [m] by which an arc may be seen too flat
DOME = np.radians(3.0)  # slope of the floor outwards
WALL_ABOVE_PART_M = 5e-3  # [m] of the wall over the tallest part on the track's end
OUTLET = 15e-3  # [m] by which the outlet stands out of the wall
OUTLET_LEAD_M = 10e-3  # [m] of track between the last device and the outlet
DIP = 0.06  # [rad] the track begins so far below the floor: no edge where it grows from it
RAIL_CLEARANCE_M = 2e-3  # [m] more than a part needs, below rails
MAX_TRACK_WIDTH_RATIO = 0.75  # of the radius: no track is wider
MIN_TRACK_HEIGHT_M = 10e-3  # [m] over the floor of a track that goes down
BANK_DROP_FACTOR = (
    1.5  # of the tangent of a bank: beside the chord of an arc a twist takes some of the height
)
FULL_TURN = 2.0 * np.pi
MIN_CLEAR_TRACK_RAD = 0.25 * FULL_TURN  # of track at least, over floor and dome: there its width is measured
SHORTEST = 0.999  # of it: what is told has four digits
SEEN, CLEARED = 0.3, 3e-4  # of the plate, and [m] over the dome: there the free edge is measured


class TrackTooLow(FeederError):
    """A device leads the track down too far: a steeper climb leaves more room below it."""

    def needing(self, climb):
        """Return the same fault with the least climb [rad] that mends it."""
        mend = f"give a track.climb of at least {np.degrees(climb):.4g} deg"
        fault = TrackTooLow(self.where, self.what, f"{mend}, else {self.mend}")
        fault.climb = climb
        return fault

    climb: float | None = None  # [rad] that mends it; None where none is known


@dataclass(frozen=True, eq=False)
class BowlPlan:
    """A bowl in lengths [m] and angles [rad]; heights over the floor's edge."""

    way: Way
    width: float  # of the track, along its surface
    material: BowlMaterial
    stretch: Stretch | None  # None without devices
    first: float  # s where the stretch begins
    outlet: float  # length of the outlet
    hanging: float  # depth that parts hang below rails
    headroom: float  # free height that parts need above the track
    top: float  # of the wall
    hub: float  # radius of the hub below the floor
    bolts: int
    bolt: float  # diameter of their holes
    bolt_circle: float  # diameter
    drains: int
    drain: float  # diameter of a drain hole
    turned: float  # angle of the outlet's begin, seen from above
    left: bool  # mirrored: parts travel clockwise, seen from above
    chord: float
    stairs: Stairs | None = None  # where the wall steps outwards with the track

    @property
    def across(self):
        """Width of the track, seen from above, where it is widest."""
        return self.width * float(np.cos(self.way.least_bank))

    @property
    def segments(self):
        """How many facets a full turn has; where the track is steep across, more."""
        banks = self.way.bank, *(bank for _, _, bank in self.way.leans)
        chord = self.chord / max(1.0, *(BANK_DROP_FACTOR * float(np.tan(bank)) for bank in banks))
        return int(np.ceil(FULL_TURN / (2.0 * np.arccos(1.0 - chord / self.way.radius)) / 4.0)) * 4

    @property
    def outlet_height(self):
        """Height of the outlet's surface by the wall."""
        return float(self.way.height(self.way.end))

    @property
    def turns(self):
        """Turns of the track from the floor to the outlet."""
        return -float(self.way.angle(0.0)) / FULL_TURN

    @property
    def room(self):
        """Radius of a cylinder that holds as much as the lowest third of the bowl's rise."""
        return float(self.way.wall_radius(self.way.end / 6.0))

    @property
    def ring(self):
        """Radius up to which the floor is level, a little more than the track covers; the dome is within."""
        lowest = self.way.rises(self.width) - DIP * self.way.radius if self.stairs else 0.0
        return (
            float(self.way.wall_radius(lowest)) - self.width * float(np.cos(self.way.bank)) - BOLT_CLEARANCE_M
        )

    @property
    def dome(self):
        """Rise of the floor from its edge to the middle."""
        return self.ring * float(np.tan(DOME))

    @property
    def underside(self):
        """Height of the face that stands on the drive."""
        return -self.material.floor

    def floor(self, r):
        """Return the height [m] of the floor at radii."""
        return np.maximum(self.ring - np.asarray(r, float), 0.0) * np.tan(DOME)


@dataclass(frozen=True)
class Asked:
    """What is asked of the solid beside the sizes of the sheet."""

    chord: float = ARC_CHORD_M
    material: str = "steel"
    outlet_height: float = 0.0  # [m] 0: as the track's turns make it
    outlet_angle: float = 0.0  # [rad]
    left: bool = False
    shape: str = CYLINDER  # of the wall, of ``stairs.SHAPES``
    friction: float = 0.4  # [1] static, of parts on the bowl
    bolts: int = 6
    bolt: float = 9e-3  # [m] diameter of their holes
    bolt_circle: float = 0.0  # [m] 0: by the rule
    bolt_share: float = 0.4  # [1] the rule: of the bowl's diameter
    drains: int = 0
    drain: float = 4e-3  # [m]
    step: bool = False  # a file with exact faces as well
    bed: tuple[float, ...] | None = None  # (x, y, z) [m] of the printer; None leaves the bowl whole
    joint: str = "dowels"  # of ``segments.JOINTS``: what holds its segments together


def plan(size, track, made_of, tooled, asked, *, extents):
    """Return the measures of a bowl as a solid.

    Parameters
    ----------
    size : machine.sizing.Size
    track : Track
        Of that size.
    made_of : BowlMaterial
    tooled : Stretch or None
    asked : Asked
    extents : (3,) float [m]
        Of the part along its axes.

    Returns
    -------
    BowlPlan

    Raises
    ------
    FeederError
        If the track is too wide for the bowl, does not rise, is too short for the devices, or what falls
        through them would not reach the floor.
    """
    _check(size, track)
    stepped = stairs(track, made_of, tooled, asked, extents)
    way, first = _way(size, track, made_of, tooled, asked, stepped)
    lowest = float(way.wall_radius(0.0))
    bolting.check(track, asked, extents, lowest)
    across = track.width * np.cos(way.least_bank)
    outer = track.radius + made_of.wall
    outlet = np.sqrt(outer**2 - (track.radius - across) ** 2) + OUTLET
    greatest = float(max(extents))
    tallest = greatest if tooled is None else tooled.tallest
    gates = [one.area.bounds[3] for one in tooled.blades] if tooled else []
    hangs = tooled is not None and any(cut.hangs for cut in tooled.cuts)
    return BowlPlan(
        way=way,
        width=track.width,
        material=made_of,
        stretch=tooled,
        first=first,
        outlet=float(outlet),
        hanging=greatest + RAIL_CLEARANCE_M if hangs else 0.0,
        headroom=tallest,
        top=way.highest + max([tallest + WALL_ABOVE_PART_M, *gates]),
        hub=bolting.hub(track, asked, lowest),
        bolts=asked.bolts,
        bolt=asked.bolt,
        bolt_circle=bolting.circle(track, asked, lowest),
        drains=asked.drains,
        drain=asked.drain,
        turned=asked.outlet_angle,
        left=asked.left,
        chord=asked.chord,
        stairs=stepped,
    )


def _check(size, track):
    widest = MAX_TRACK_WIDTH_RATIO * track.radius
    if track.width > widest:
        what = f"{1e3 * track.width:.4g} mm is too wide for a bowl of {1e3 * size.diameter:.4g} mm"
        raise FeederError(
            "track.width", what, f"give at most {1e3 * widest:.4g} mm, or a larger track.radius"
        )
    if track.climb <= 0.0:
        what = f"{np.degrees(track.climb):.3g} deg does not lead a track out of the bowl"
        raise FeederError("track.climb", what, "give a climb, as 3.5 deg, or leave it out")


def _way(size, track, made_of, tooled, asked, stepped):
    """The way of the track, and where on it the tooled stretch begins."""
    needed = 0.0 if tooled is None else tooled.length + OUTLET_LEAD_M
    drops = () if tooled is None else tooled.drops
    rise, gained = np.tan(track.climb), _gained(track, tooled, needed)
    round_once = FULL_TURN * track.radius
    free = round_once - track.width * np.sin(track.bank) / rise  # of track below, from where it rises
    falls = None if tooled is None or stepped is not None else tooled.falls
    most = np.inf if falls is None else free + needed - falls
    end = min(size.depth / rise, most, np.inf if stepped is None else stepped.most)
    if asked.outlet_height > 0.0:
        end = needed + (asked.outlet_height - gained) / rise
        _check_height(asked.outlet_height, end, most, rise * (most - needed) + gained)
        _check_floor(end, stepped, rise)
    over = SEEN * made_of.plate + track.width * np.tan(DOME) + CLEARED
    first, quarter = end - needed, track.radius * _quarter(stepped) + over / rise
    if first < 0.0:
        raise _too_short(asked.outlet_height, end, needed, gained + rise * max(quarter - needed, 0.0))
    _check_long(asked.outlet_height, end, quarter, gained - rise * needed, rise)
    way = Way(
        radius=track.radius, climb=track.climb, bank=track.bank, end=float(end),
        drops=tuple((first + at, drop) for at, drop in drops),
        bends=() if tooled is None else tuple((first + at, climb) for at, climb in tooled.bends),
        flare=0.0 if stepped is None else stepped.flare,
        leans=() if tooled is None else tuple((first + a, first + b, bank) for a, b, bank in tooled.leans),
    )  # fmt: skip
    _check_bends(way, stepped, round_once, 0.0 if tooled is None else tooled.tallest)
    return way, float(first)


def _quarter(stepped):
    """Length of a quarter turn, over the wall's radius at its end."""
    flare = 0.0 if stepped is None else stepped.flare
    return MIN_CLEAR_TRACK_RAD if flare == 0.0 else -float(np.expm1(-flare * MIN_CLEAR_TRACK_RAD)) / flare


def _check_long(height, end, least, gained, rise):
    if end >= least * SHORTEST:
        return
    what = f"{1e3 * end:.4g} mm of track, less than a quarter turn"
    if height > 0.0:
        mend = f"give at least {1e3 * (rise * least + gained):.4g} mm"
        raise FeederError("sizing.outlet_height", f"{1e3 * height:.4g} mm leaves {what}", mend)
    raise FeederError("sizing.depth", f"it leaves {what}", "give a larger one, or a smaller track.climb")


def _gained(track, tooled, needed):
    """Height [m] by which the track's end lies over the begin of the tooled stretch."""
    if tooled is None:
        return 0.0
    stretch = Way(track.radius, track.climb, track.bank, needed, tooled.drops, tooled.bends)
    return float(stretch.height(needed))


def _check_bends(way, stepped, round_once, tallest):
    if way.bends and way.lowest < MIN_TRACK_HEIGHT_M:
        what = f"a device leads the track down to {1e3 * way.lowest:.3g} mm over the floor"
        least = 1e3 * (float(way.height(way.end)) + MIN_TRACK_HEIGHT_M - way.lowest)
        raise TrackTooLow("devices", what, f"give a sizing.outlet_height of at least {least:.4g} mm")
    if way.bends and stepped is not None:
        _check_beside(way, stepped)
        return
    free = way.lowest - float(way.risen(way.end - round_once))
    if way.bends and way.end > round_once and free < tallest + WALL_ABOVE_PART_M:
        what = f"a device leads the track down to {1e3 * free:.3g} mm over the turn below"
        raise TrackTooLow("devices", what, "give a lower sizing.outlet_height")


def _check_beside(way, stepped):
    """Raise the fault of a track that goes down too near to the turn before, beside which it lies."""
    last = np.array([*(at for at, _ in way.bends), way.end])
    free = float((way.risen(last) - way.risen(way.at(way.angle(last) - FULL_TURN))).min())
    if free < stepped.needed:
        what = f"a device leads the track down to {1e3 * free:.4g} mm over the turn before"
        mend = (
            f"{1e3 * stepped.needed:.4g} mm are needed: give a steeper track.climb, or sizing.shape: cylinder"
        )
        raise TrackTooLow("devices", what, mend)


def _check_floor(end, stepped, rise):
    if stepped is not None and end > stepped.most:
        what = "leaves too small a floor: the wall steps outwards with the track"
        mend = f"give at most {1e3 * stepped.most * rise:.4g} mm, or a larger bowl"
        raise FeederError("sizing.outlet_height", what, mend)


def _too_short(height, end, needed, least):
    if height > 0.0:
        what = f"{1e3 * height:.4g} mm leaves {1e3 * end:.4g} mm of track"
        what += f", and the devices take {1e3 * needed:.4g} mm"
        return FeederError("sizing.outlet_height", what, f"give at least {1e3 * least:.4g} mm")
    what = f"they take {1e3 * needed:.4g} mm of track, and it has {1e3 * end:.4g} mm"
    return FeederError("devices", what, "take fewer, a larger sizing.depth, or a larger bowl")


def _check_height(height, end, most, highest):
    if end > most:
        what = f"{1e3 * height:.4g} mm puts a turn of the track below the cuts: what falls stays on it"
        raise FeederError("sizing.outlet_height", what, f"give at most {1e3 * highest:.4g} mm")
