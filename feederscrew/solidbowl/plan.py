"""The measures of a bowl as a solid, decided before a facet is made: material, track, bolts, drains."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from feederscrew.errors import FeederError
from feederscrew.solidbowl.cuts import Stretch
from feederscrew.solidbowl.stairs import CYLINDER, Stairs, stairs

STEEL_NAME = "steel"


@dataclass(frozen=True)
class BowlMaterial:
    """Thicknesses and density of one way to make a bowl."""

    name: str
    wall: float  # [m]
    floor: float  # [m]
    plate: float  # [m] of the track
    density: float  # [kg/m3]
    supported: bool  # every face may hang free: welded, or held up by the powder around it
    flat: bool  # the underside of the floor is flat, to stand on a printer's bed


PRINTED_MATERIALS = (
    BowlMaterial("pla", 4e-3, 5e-3, 4e-3, 1240.0, supported=False, flat=True),
    BowlMaterial("pa12", 3e-3, 4e-3, 3e-3, 1010.0, supported=True, flat=False),
)
MATERIAL_NAMES = (*(item.name for item in PRINTED_MATERIALS), STEEL_NAME)


def material(name, rules):
    """Return a material by name.

    Parameters
    ----------
    name : str
        Of ``MATERIAL_NAMES``; 'steel' is the sheet of the bowl file.
    rules : Sizing
        Its thickness and density of the sheet.

    Returns
    -------
    BowlMaterial
    """
    if name == STEEL_NAME:
        sheet = rules.sheet
        return BowlMaterial(STEEL_NAME, sheet, sheet, sheet, rules.sheet_density, supported=True, flat=False)
    return next(item for item in PRINTED_MATERIALS if item.name == name)


BOLT_CLEARANCE_M = 1e-3  # [m] of level floor beside the track
WEB = 0.5  # of a hole's diameter: metal between two of them, at least


def bolt_circle(track, options, radius):
    """Return the diameter [m] of the circle of bolts: as given, or by the rule as far as there is room.

    Parameters
    ----------
    track : Track
    options : SolidOptions
    radius : float [m]
        Of the floor, out to the wall.
    """
    most = 2.0 * (_room(track, radius) - 2.0 * options.bolt)
    ruled = options.bolt_share * 2.0 * track.radius
    return options.bolt_circle or (min(ruled, most) if most > 0.0 else ruled)


def _room(track, radius):
    """Radius within which nothing of the track lies."""
    return radius - track.width - 2.0 * BOLT_CLEARANCE_M


def bolt_hub(track, options, radius):
    """Return the radius [m] of the hub below the floor."""
    return 0.5 * bolt_circle(track, options, radius) + 2.0 * options.bolt


def check_bolts(track, options, extents, radius) -> None:
    """Raise the fault of holes that the floor has no room for.

    Parameters
    ----------
    track : Track
    options : SolidOptions
    extents : (3,) float [m]
        Of the part along its axes.
    radius : float [m]
        Of the floor, out to the wall.

    Raises
    ------
    FeederError
        If the bolts lie under the track or run into each other, or parts fall through a drain hole.
    """
    room, across = _room(track, radius), bolt_circle(track, options, radius)
    if bolt_hub(track, options, radius) > room + 1e-9:
        what = f"{1e3 * across:.4g} mm lies under the track of a bowl this small"
        most = 2e3 * (room - 2.0 * options.bolt)
        mend = f"give at most {most:.4g} mm, or smaller bolts"
        if most <= 0.0:
            mend = "give a smaller machine.bolt_hole, or a larger bowl"
        raise FeederError("machine.bolt_circle", what, mend)
    if _too_near(options.bolts, 0.5 * across) < (1.0 + WEB) * options.bolt - 1e-9:
        what = f"{options.bolts} and one in the middle, of {1e3 * options.bolt:.4g} mm,"
        what += f" leave no metal between them on a circle of {1e3 * across:.4g} mm"
        raise FeederError("machine.bolts", what, "take fewer, a smaller machine.bolt_hole, or a larger bowl")
    least = float(min(extents))
    if options.drains and options.drain >= least:
        what = f"{1e3 * options.drain:.4g} mm may let parts through that are {1e3 * least:.4g} mm thick"
        raise FeederError("sizing.drain_hole", what, f"give less than {1e3 * least:.4g} mm")


def _too_near(bolts, radius):
    """Least distance [m] between the middles of two holes, one of them that in the middle."""
    if bolts == 0:
        return np.inf
    return radius * min(1.0, 2.0 * np.sin(np.pi / bolts) if bolts > 1 else 1.0)


@dataclass(frozen=True, eq=False)
class TrackPath:
    """The foot of the wall as a line in space, and the track inwards of it.

    Lengths s [m] run along the wall from where the track leaves the floor, distances y [m] from the wall
    along the track's surface. Seen from above parts travel counter-clockwise about the Z axis and leave
    where the outlet begins, at the angle 0.
    """

    radius: float  # [m] of the wall's inner face where the outlet begins
    climb: float  # [rad]
    bank: float  # [rad] down towards the wall, where it begins
    end: float  # [m] s where the outlet begins: from there on the way is straight and level
    drops: tuple[tuple[float, float], ...] = ()  # s of each step of the track and its height [m]
    bends: tuple[tuple[float, float], ...] = ()  # s from which the track climbs otherwise, and how [rad]
    flare: float = 0.0  # [1] by which the wall's radius grows over s
    leans: tuple[tuple[float, float, float], ...] = ()  # from and to s it twists to another bank [rad]

    def wall_radius(self, s):
        """Return the radius [m] of the wall's inner face at lengths s."""
        return self.radius + self.flare * (np.minimum(s, self.end) - self.end)

    def at(self, theta):
        """Return the lengths s at angles about the axis, at most 0."""
        theta = np.asarray(theta, float)
        if self.flare == 0.0:
            return self.end + self.radius * theta
        return self.end + self.radius * np.expm1(self.flare * theta) / self.flare

    def angle(self, s):
        """Return the angle [rad] about the axis at lengths s; it stays at 0 along the outlet."""
        before = (np.minimum(s, self.end) - self.end) / self.radius
        return before if self.flare == 0.0 else np.log1p(self.flare * before) / self.flare

    def bank_at(self, s):
        """Return the bank [rad] at lengths s."""
        banks = [self.bank, *(bank for _, _, bank in self.leans)]
        bank_at = np.full(np.shape(s), float(self.bank))
        for (start, end, bank), before in zip(self.leans, banks):
            bank_at = bank_at + (bank - before) * np.clip((s - start) / (end - start), 0.0, 1.0)
        return bank_at

    @property
    def least_bank(self):
        """The least bank [rad] anywhere: there the track is widest, seen from above."""
        return min([self.bank, *(bank for _, _, bank in self.leans)])

    def rises(self, width):
        """Return the length s [m], at most 0, at which a track of a width first comes out of the floor.

        Its free edge is the first on a banked track, and does so before the wall's side.
        """
        return -width * np.sin(self.bank) / np.tan(self.climb)

    def plan(self, s, y) -> np.ndarray:
        """Return the places (..., 2) [m] from above at lengths s and distances y."""
        s, y = np.broadcast_arrays(np.asarray(s, float), np.asarray(y, float))
        theta, straight = self.angle(s), np.maximum(s - self.end, 0.0)
        r, c, sn = self.wall_radius(s) - y * np.cos(self.bank_at(s)), np.cos(theta), np.sin(theta)
        return np.stack([r * c - straight * sn, r * sn + straight * c], axis=-1)

    def height(self, s, y=0.0):
        """Return the height [m] of the track's surface over the floor's edge at lengths s, distances y."""
        s = np.asarray(s, float)
        fallen = sum((np.where(s >= at, drop, 0.0) for at, drop in self.drops), np.zeros(s.shape))
        return self.risen(np.minimum(s, self.end)) - fallen + np.sin(self.bank_at(s)) * np.asarray(y)

    def risen(self, s):
        """Return by how much [m] the track climbs up to lengths s, its steps down left out."""
        climbs = [self.climb, *(climb for _, climb in self.bends)]
        risen = np.tan(self.climb) * s
        for (at, climb), before in zip(self.bends, climbs):
            risen = risen + (np.tan(climb) - np.tan(before)) * np.maximum(s - at, 0.0)
        return risen

    @property
    def highest(self) -> float:
        """Greatest height [m] of the track by the wall, its steps down left out."""
        return float(max(self.risen(at) for at in (*(at for at, _ in self.bends), self.end)))

    @property
    def lowest(self) -> float:
        """Least height [m] from the first other climb on."""
        ends = [*(at for at, _ in self.bends), *(at for at, _ in self.drops), self.end]
        return float(min(self.height(at) for at in ends))

    def places(self, s, y) -> np.ndarray:
        """Return points (..., 3) [m] of the track's surface."""
        flat = self.plan(s, y)
        z = np.broadcast_to(self.height(s, y), flat.shape[:-1])
        return np.concatenate([flat, z[..., None]], axis=-1)

    def ring_in_bowl(self, ring, chord):
        """Return a ring (K, 2) [m] of lengths and distances as a polygon seen from above.

        Parameters
        ----------
        ring : (K, 2) float [m]
        chord : float [m]
            By which an arc may be seen too flat.

        Returns
        -------
        shapely geometry [m]
        """
        border = shapely.linestrings(np.vstack([ring, ring[:1]]))
        fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(4.0 * self.radius * chord)))[:-1]
        return shapely.make_valid(shapely.Polygon(self.plan(fine[:, 0], fine[:, 1])))


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
FULL_TURN_RAD = 2.0 * np.pi
MIN_CLEAR_TRACK_RAD = (
    0.25 * FULL_TURN_RAD
)  # of track at least, over floor and dome: there its width is measured
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

    path: TrackPath
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
        return self.width * float(np.cos(self.path.least_bank))

    @property
    def segments(self):
        """How many facets a full turn has; where the track is steep across, more."""
        banks = self.path.bank, *(bank for _, _, bank in self.path.leans)
        chord = self.chord / max(1.0, *(BANK_DROP_FACTOR * float(np.tan(bank)) for bank in banks))
        return int(np.ceil(FULL_TURN_RAD / (2.0 * np.arccos(1.0 - chord / self.path.radius)) / 4.0)) * 4

    @property
    def outlet_height(self) -> float:
        """Height of the outlet's surface by the wall."""
        return float(self.path.height(self.path.end))

    @property
    def turns(self):
        """Turns of the track from the floor to the outlet."""
        return -float(self.path.angle(0.0)) / FULL_TURN_RAD

    @property
    def room(self) -> float:
        """Radius of a cylinder that holds as much as the lowest third of the bowl's rise."""
        return float(self.path.wall_radius(self.path.end / 6.0))

    @property
    def ring(self):
        """Radius up to which the floor is level, a little more than the track covers; the dome is within."""
        lowest = self.path.rises(self.width) - DIP * self.path.radius if self.stairs else 0.0
        return (
            float(self.path.wall_radius(lowest))
            - self.width * float(np.cos(self.path.bank))
            - BOLT_CLEARANCE_M
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
class SolidOptions:
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


def plan(size, track, made_of, tooled, options, *, extents) -> BowlPlan:
    """Return the measures of a bowl as a solid.

    Parameters
    ----------
    size : machine.sizing.Size
    track : Track
        Of that size.
    made_of : BowlMaterial
    tooled : Stretch or None
    options : SolidOptions
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
    stepped = stairs(track, made_of, tooled, options, extents)
    path, first = _track_path(size, track, made_of, tooled, options, stepped)
    lowest = float(path.wall_radius(0.0))
    check_bolts(track, options, extents, lowest)
    across = track.width * np.cos(path.least_bank)
    outer = track.radius + made_of.wall
    outlet = np.sqrt(outer**2 - (track.radius - across) ** 2) + OUTLET
    greatest = float(max(extents))
    tallest = greatest if tooled is None else tooled.tallest
    gates = [blade.area.bounds[3] for blade in tooled.blades] if tooled else []
    hangs = tooled is not None and any(cut.hangs for cut in tooled.cuts)
    return BowlPlan(
        path=path,
        width=track.width,
        material=made_of,
        stretch=tooled,
        first=first,
        outlet=float(outlet),
        hanging=greatest + RAIL_CLEARANCE_M if hangs else 0.0,
        headroom=tallest,
        top=path.highest + max([tallest + WALL_ABOVE_PART_M, *gates]),
        hub=bolt_hub(track, options, lowest),
        bolts=options.bolts,
        bolt=options.bolt,
        bolt_circle=bolt_circle(track, options, lowest),
        drains=options.drains,
        drain=options.drain,
        turned=options.outlet_angle,
        left=options.left,
        chord=options.chord,
        stairs=stepped,
    )


def _check(size, track) -> None:
    widest = MAX_TRACK_WIDTH_RATIO * track.radius
    if track.width > widest:
        what = f"{1e3 * track.width:.4g} mm is too wide for a bowl of {1e3 * size.diameter:.4g} mm"
        raise FeederError(
            "track.width", what, f"give at most {1e3 * widest:.4g} mm, or a larger track.radius"
        )
    if track.climb <= 0.0:
        what = f"{np.degrees(track.climb):.3g} deg does not lead a track out of the bowl"
        raise FeederError("track.climb", what, "give a climb, as 3.5 deg, or leave it out")


def _track_path(size, track, made_of, tooled, options, stepped) -> tuple[Any, ...]:
    """The way of the track, and where on it the tooled stretch begins."""
    needed = 0.0 if tooled is None else tooled.length + OUTLET_LEAD_M
    drops = () if tooled is None else tooled.drops
    rise, gained = np.tan(track.climb), _gained(track, tooled, needed)
    round_once = FULL_TURN_RAD * track.radius
    free = round_once - track.width * np.sin(track.bank) / rise  # of track below, from where it rises
    falls = None if tooled is None or stepped is not None else tooled.falls
    most = np.inf if falls is None else free + needed - falls
    end = min(size.depth / rise, most, np.inf if stepped is None else stepped.most)
    if options.outlet_height > 0.0:
        end = needed + (options.outlet_height - gained) / rise
        _check_height(options.outlet_height, end, most, rise * (most - needed) + gained)
        _check_floor(end, stepped, rise)
    over = SEEN * made_of.plate + track.width * np.tan(DOME) + CLEARED
    first, quarter = end - needed, track.radius * _quarter(stepped) + over / rise
    if first < 0.0:
        raise _too_short(options.outlet_height, end, needed, gained + rise * max(quarter - needed, 0.0))
    _check_long(options.outlet_height, end, quarter, gained - rise * needed, rise)
    path = TrackPath(
        radius=track.radius, climb=track.climb, bank=track.bank, end=float(end),
        drops=tuple((first + at, drop) for at, drop in drops),
        bends=() if tooled is None else tuple((first + at, climb) for at, climb in tooled.bends),
        flare=0.0 if stepped is None else stepped.flare,
        leans=() if tooled is None else tuple((first + a, first + b, bank) for a, b, bank in tooled.leans),
    )  # fmt: skip
    _check_bends(path, stepped, round_once, 0.0 if tooled is None else tooled.tallest)
    return path, float(first)


def _quarter(stepped):
    """Length of a quarter turn, over the wall's radius at its end."""
    flare = 0.0 if stepped is None else stepped.flare
    return MIN_CLEAR_TRACK_RAD if flare == 0.0 else -float(np.expm1(-flare * MIN_CLEAR_TRACK_RAD)) / flare


def _check_long(height, end, least, gained, rise) -> None:
    if end >= least * SHORTEST:
        return
    what = f"{1e3 * end:.4g} mm of track, less than a quarter turn"
    if height > 0.0:
        mend = f"give at least {1e3 * (rise * least + gained):.4g} mm"
        raise FeederError("sizing.outlet_height", f"{1e3 * height:.4g} mm leaves {what}", mend)
    raise FeederError("sizing.depth", f"it leaves {what}", "give a larger one, or a smaller track.climb")


def _gained(track, tooled, needed) -> float:
    """Height [m] by which the track's end lies over the begin of the tooled stretch."""
    if tooled is None:
        return 0.0
    stretch = TrackPath(track.radius, track.climb, track.bank, needed, tooled.drops, tooled.bends)
    return float(stretch.height(needed))


def _check_bends(path, stepped, round_once, tallest) -> None:
    if path.bends and path.lowest < MIN_TRACK_HEIGHT_M:
        what = f"a device leads the track down to {1e3 * path.lowest:.3g} mm over the floor"
        least = 1e3 * (float(path.height(path.end)) + MIN_TRACK_HEIGHT_M - path.lowest)
        raise TrackTooLow("devices", what, f"give a sizing.outlet_height of at least {least:.4g} mm")
    if path.bends and stepped is not None:
        _check_beside(path, stepped)
        return
    free = path.lowest - float(path.risen(path.end - round_once))
    if path.bends and path.end > round_once and free < tallest + WALL_ABOVE_PART_M:
        what = f"a device leads the track down to {1e3 * free:.3g} mm over the turn below"
        raise TrackTooLow("devices", what, "give a lower sizing.outlet_height")


def _check_beside(path, stepped) -> None:
    """Raise the fault of a track that goes down too near to the turn before, beside which it lies."""
    last = np.array([*(at for at, _ in path.bends), path.end])
    free = float((path.risen(last) - path.risen(path.at(path.angle(last) - FULL_TURN_RAD))).min())
    if free < stepped.needed:
        what = f"a device leads the track down to {1e3 * free:.4g} mm over the turn before"
        mend = (
            f"{1e3 * stepped.needed:.4g} mm are needed: give a steeper track.climb, or sizing.shape: cylinder"
        )
        raise TrackTooLow("devices", what, mend)


def _check_floor(end, stepped, rise) -> None:
    if stepped is not None and end > stepped.most:
        what = "leaves too small a floor: the wall steps outwards with the track"
        mend = f"give at most {1e3 * stepped.most * rise:.4g} mm, or a larger bowl"
        raise FeederError("sizing.outlet_height", what, mend)


def _too_short(height, end, needed, least) -> FeederError:
    if height > 0.0:
        what = f"{1e3 * height:.4g} mm leaves {1e3 * end:.4g} mm of track"
        what += f", and the devices take {1e3 * needed:.4g} mm"
        return FeederError("sizing.outlet_height", what, f"give at least {1e3 * least:.4g} mm")
    what = f"they take {1e3 * needed:.4g} mm of track, and it has {1e3 * end:.4g} mm"
    return FeederError("devices", what, "take fewer, a larger sizing.depth, or a larger bowl")


def _check_height(height, end, most, highest) -> None:
    if end > most:
        what = f"{1e3 * height:.4g} mm puts a turn of the track below the cuts: what falls stays on it"
        raise FeederError("sizing.outlet_height", what, f"give at most {1e3 * highest:.4g} mm")
