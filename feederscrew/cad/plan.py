"""The measures of a bowl as a solid, decided before a facet is made: material, track, wall, bolts, drains.

A stepped or conical wall steps outwards with the track: each turn lies beside the one before, and not above
it. What falls through a cut meets a slope that leads it to the turn before, or to the floor: so there may be
more than one turn of track. Seen in a section the wall of a turn stands upright, leads outwards as a slope,
and stands upright again below the next turn.
"""

import itertools
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base.arrays import Floats, Values, Vector
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.features import Blade
from feederscrew.bowl.record import Sizing, Track
from feederscrew.bowl.size import MIN_WALL_ABOVE_PART_M, Size
from feederscrew.sorting.tooled_track import TooledTrack, changed_at

Extents = Floats | tuple[float, ...]  # (3,) [m] of a part along its axes
STEEL_NAME = "steel"
# the third shape is stepped
CYLINDER = "cylinder"
CONICAL = "conical"
FULL_TURN_RAD = 2.0 * np.pi
TURN_CLEARANCE_M = 1e-3  # [m] by which the next turn stands further out than the track is wide
SLOPE = np.radians(40.0)  # [rad] least slope
SURE = np.radians(5.0)  # [rad] how much steeper than parts hold still on
UNSUPPORTED_SLOPE_RAD = np.radians(45.5)  # a slope that needs no support
MIN_FLOOR_RADIUS_SHARE = 0.5  # of the bowl's radius: no floor is smaller


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


def material(name: str, rules: Sizing) -> BowlMaterial:
    """Return a material of a bowl by its name.

    Parameters
    ----------
    name : str
        Of ``MATERIAL_NAMES``.
    rules : Sizing
        'steel' is the sheet that they state.

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


def _bolt_circle(
    track: Track, options: "SolidOptions", extents: Extents, radius: float
) -> tuple[float, float]:
    """Diameter [m] of the circle of bolts, by the rule as far as there is room; radius [m] of the hub.

    ``radius`` [m] is that of the floor, out to the wall. Raises the fault of holes under the track, into each
    other, or drains that parts fall through.
    """
    most = 2.0 * (radius - track.width - 2.0 * BOLT_CLEARANCE_M - 2.0 * options.bolt)
    ruled = options.bolt_share * 2.0 * track.radius
    across = options.bolt_circle or (min(ruled, most) if most > 0.0 else ruled)
    if across > most + 2e-9:
        what = f"{1e3 * across:.4g} mm lies under the track of a bowl this small"
        mend = f"give at most {1e3 * most:.4g} mm, or smaller bolts"
        if most <= 0.0:
            mend = "give a smaller machine.bolt_hole, or a larger bowl"
        raise FeederError("machine.bolt_circle", what, mend)
    # least distance between the middles of two holes, one of them that in the middle
    count, gap = options.bolts, 0.5 * across
    if count > 1:
        gap *= min(1.0, 2.0 * np.sin(np.pi / count))
    if count and gap < (1.0 + WEB) * options.bolt - 1e-9:
        what = f"{count} and one in the middle, of {1e3 * options.bolt:.4g} mm,"
        what += f" leave no metal between them on a circle of {1e3 * across:.4g} mm"
        raise FeederError("machine.bolts", what, "take fewer, a smaller machine.bolt_hole, or a larger bowl")
    least = float(min(extents))
    if options.drains and options.drain >= least:
        what = f"{1e3 * options.drain:.4g} mm may let parts through that are {1e3 * least:.4g} mm thick"
        raise FeederError("sizing.drain_hole", what, f"give less than {1e3 * least:.4g} mm")
    return across, 0.5 * across + 2.0 * options.bolt


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

    def wall_radius(self, s: Values) -> Values:
        """Return the radius of the wall's inner face at some lengths.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        float or (...) float [m]
        """
        return self.radius + self.flare * (np.minimum(s, self.end) - self.end)

    def at(self, theta: Values) -> Values:
        """Return the lengths at some angles about the axis.

        Parameters
        ----------
        theta : float or (...) float [rad]
            At most 0, the outlet.

        Returns
        -------
        (...) float [m]
        """
        theta = np.asarray(theta, float)
        if self.flare == 0.0:
            return self.end + self.radius * theta
        return self.end + self.radius * np.expm1(self.flare * theta) / self.flare

    def angle(self, s: Values) -> Values:
        """Return the angle about the axis at some lengths; it stays at 0 along the outlet.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        float or (...) float [rad]
        """
        before = (np.minimum(s, self.end) - self.end) / self.radius
        return before if self.flare == 0.0 else np.log1p(self.flare * before) / self.flare

    def bank_at(self, s: Values) -> Values:
        """Return the bank at some lengths: linear over each twist.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [rad]
        """
        return changed_at(s, float(self.bank), self.leans)

    @property
    def least_bank(self) -> float:
        """The least bank [rad] anywhere: there the track is widest, seen from above."""
        return min([self.bank, *(bank for _, _, bank in self.leans)])

    def rises(self, width: float) -> float:
        """Return the length at which a track first comes out of the floor: -width sin(bank) / tan(climb).

        Its free edge is the first on a banked track, and does so before the wall's side.

        Parameters
        ----------
        width : float [m]
            Of the track.

        Returns
        -------
        float [m]
            At most 0.
        """
        return -width * np.sin(self.bank) / np.tan(self.climb)

    def plan(self, s: Values, y: Values) -> Floats:
        """Return places of the track from above.

        Parameters
        ----------
        s : float or (...) float [m]
            Along the wall.
        y : float or (...) float [m]
            From the wall.

        Returns
        -------
        (..., 2) float [m]
        """
        s, y = np.broadcast_arrays(np.asarray(s, float), np.asarray(y, float))
        theta, straight = self.angle(s), np.maximum(s - self.end, 0.0)
        r, c, sn = self.wall_radius(s) - y * np.cos(self.bank_at(s)), np.cos(theta), np.sin(theta)
        return np.stack([r * c - straight * sn, r * sn + straight * c], axis=-1)

    def height(self, s: Values, y: Values = 0.0) -> Values:
        """Return the height of the track's surface over the floor's edge.

        Parameters
        ----------
        s : float or (...) float [m]
            Along the wall.
        y : float or (...) float [m], optional
            From the wall.

        Returns
        -------
        (...) float [m]
        """
        s = np.asarray(s, float)
        fallen = sum((np.where(s >= at, drop, 0.0) for at, drop in self.drops), np.zeros(s.shape))
        return self.risen(np.minimum(s, self.end)) - fallen + np.sin(self.bank_at(s)) * np.asarray(y)

    def risen(self, s: Values) -> Values:
        """Return by how much the track climbs up to some lengths, its steps down left out.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [m]
        """
        s, climbs = np.asarray(s, float), [self.climb, *(climb for _, climb in self.bends)]
        risen = np.tan(self.climb) * s
        for (at, climb), before in zip(self.bends, climbs):
            risen = risen + (np.tan(climb) - np.tan(before)) * np.maximum(s - at, 0.0)
        return risen

    def normal(self, s: float) -> Vector:
        """Return the unit vector square to the track's surface, by the wall.

        Parameters
        ----------
        s : float [m]

        Returns
        -------
        (3,) float [1]
        """
        theta, bank = float(self.angle(s)), float(self.bank_at(s))
        rise = float(self.risen(s + CLIMB_STEP_M) - self.risen(s - CLIMB_STEP_M)) / (2.0 * CLIMB_STEP_M)
        rise = rise if s < self.end else 0.0
        ahead = np.array([-np.sin(theta), np.cos(theta), rise])
        inwards = np.array([-np.cos(bank) * np.cos(theta), -np.cos(bank) * np.sin(theta), np.sin(bank)])
        upright = np.cross(ahead, inwards)
        return upright / np.sqrt((upright**2).sum())

    def blade_frame(self, blade: Blade, begin: float) -> tuple[Floats, Vector]:
        """Return the axes of a blade of a device that begins at a length s [m], and its foot.

        Its face stands square to the track at the wall, a straight line along it keeps its height over the
        track at both ends, and so does its back. Between the ends the track is nearer: ``rise_along``.

        Parameters
        ----------
        blade : Blade
        begin : float [m]
            S of the origin of its device.

        Returns
        -------
        (3, 3) float [1]
            Columns: along its face, upwards, behind its face.
        (3,) float [m]
            Where its face begins at the wall.
        """
        s, y = begin + blade.foot[0], blade.foot[1]
        radius, foot = float(self.wall_radius(s)), self.places(s, y)

        def on_track(ahead: float, inwards: float) -> Floats:
            near = radius - y - inwards
            return self.places(s + radius * np.arctan2(ahead, near), radius - np.hypot(ahead, near))

        long = float(blade.solid.bounds[2])
        face, back = blade.axes
        along = (on_track(*(long * face)) - foot) / long
        behind = (on_track(*(blade.thickness * back)) - foot) / blade.thickness
        return np.column_stack([along, self.normal(s), behind]), foot

    def rise_along(self, axes: Floats, foot: Vector, begin: float, along: Values) -> Values:
        """Return by how much the track's surface lies over a straight line along the face of a blade.

        A banked track is a cone: a chord of it that reaches ahead along the wall lies below it between its
        ends, by x^2 sin(bank) / 8 R in the middle of a chord that goes x ahead.

        Parameters
        ----------
        axes : (3, 3) float [1]
            Of the blade, as ``blade_frame`` returns them.
        foot : (3,) float [m]
        begin : float [m]
            S of the foot.
        along : (...) float [m]
            From the foot.

        Returns
        -------
        (...) float [m]
            Along the second axis, upwards.
        """
        along = np.asarray(along, float)
        x, y, z = np.moveaxis(foot + along[..., None] * axes[:, 0], -1, 0)
        theta = np.arctan2(y, x)  # of the turn in which the blade stands
        theta = theta + FULL_TURN_RAD * np.round((float(self.angle(begin)) - theta) / FULL_TURN_RAD)
        s = self.at(theta)
        off = (self.wall_radius(s) - np.hypot(x, y)) / np.cos(self.bank_at(s))
        return (self.height(s, off) - z) * axes[2, 1]

    def bore(self, s: float, z: float, before: float, angle: float = 0.5 * np.pi) -> tuple[Vector, Vector]:
        """Return where a bore for a nozzle begins, and its direction, outwards along the track's surface.

        Parameters
        ----------
        s : float [m]
            Length along the wall.
        z : float [m]
            Height of its axis over the track, square to it.
        before : float [m]
            By how much it begins before the wall.
        angle : float [rad], optional
            Of its way into the bowl to the direction of travel; square to the wall without it.

        Returns
        -------
        (3,) float [m]
        (3,) float [1]
        """
        inwards = self.places(s, 1e-3) - self.places(s, 0.0)
        inwards = inwards / np.sqrt((inwards**2).sum())
        if angle != 0.5 * np.pi:
            ahead = self.places(s + 5e-4, 0.0) - self.places(s - 5e-4, 0.0)
            ahead = ahead / np.sqrt((ahead**2).sum())
            inwards = np.cos(angle) * ahead + np.sin(angle) * inwards
        way = (before + z * np.tan(float(self.bank_at(s)))) / np.sin(angle)
        return self.places(s, 0.0) + z * self.normal(s) + way * inwards, -inwards

    def places(self, s: Values, y: Values) -> Floats:
        """Return points of the track's surface.

        Parameters
        ----------
        s : float or (...) float [m]
            Along the wall.
        y : float or (...) float [m]
            From the wall.

        Returns
        -------
        (..., 3) float [m]
        """
        flat = self.plan(s, y)
        z = np.broadcast_to(self.height(s, y), flat.shape[:-1])
        return np.concatenate([flat, z[..., None]], axis=-1)


CLIMB_STEP_M = 1e-6  # [m] to either side of a place whose climb is taken
ARC_CHORD_M = 5e-5  # [m] by which an arc may be seen too flat
DOME = np.radians(3.0)  # slope of the floor outwards
WALL_ABOVE_PART_M = 5e-3  # [m] of the wall over the tallest part on the track's end
OUTLET = 15e-3  # [m] by which the outlet stands out of the wall
OUTLET_LEAD_M = 10e-3  # [m] of track between the last device and the outlet
DIP = 0.06  # [rad] the track begins so far below the floor: no edge where it grows from it
RAIL_CLEARANCE_M = 2e-3  # [m] more than a part needs, below rails
MAX_TRACK_WIDTH_RATIO = 0.75  # of the radius: no track is wider
MIN_TRACK_HEIGHT_M = 10e-3  # [m] over the floor of a track that goes down
BANK_DROP_FACTOR = 1.5  # of the tangent of a bank: beside the chord a twist takes some of the height
MIN_CLEAR_TRACK_RAD = 0.25 * FULL_TURN_RAD  # of track at least, over floor and dome: there it is measured
SHORTEST = 0.999  # of it: what is told has four digits
# where the free edge is measured
SEEN = 0.3  # of the plate
CLEARED = 3e-4  # [m] over the dome


@dataclass(frozen=True)
class Stairs:
    """Section of the wall between the last turn of the track and the one before; lengths [m]."""

    shape: str
    step: float  # outwards
    flare: float  # [1] by which the wall's radius grows over the length of the track
    slope: float  # [rad] of what leads back inwards
    upright: float  # of the wall over the turn before
    below: float  # of upright wall below the last turn, at least
    most: float  # length of track that the bowl has room for

    @property
    def needed(self) -> float:
        """Least rise of a turn [m]: upright wall over the turn before, slope, upright wall below."""
        return self.upright + self.step * float(np.tan(self.slope)) + self.below

    def sections(self, path: TrackPath, theta: Values, low: float) -> Floats:
        """Return the corners of the wall's inner side: radius and height, from below upwards.

        Parameters
        ----------
        path : TrackPath
        theta : (M,) float [rad]
            From a turn before the outlet to the outlet.
        low : float [m]
            Below this height no wall is needed.

        Returns
        -------
        (M, K, 2) float [m]
        """
        last = path.at(-FULL_TURN_RAD * np.arange(1, 100))
        turns = int(np.argmax(path.risen(last) < low)) + 1
        lengths = [path.at(np.asarray(theta) - FULL_TURN_RAD * k) for k in range(turns, -1, -1)]
        rows = [np.column_stack([path.wall_radius(s), path.risen(s)]) for s in lengths]
        corners = []
        for foot, above in itertools.pairwise(rows):
            step, pitch = (above - foot).T
            slide = step * np.tan(self.slope)
            high = np.clip(pitch - slide - self.below, 0.0, self.upright)
            slide = np.minimum(slide, pitch - high)
            corners += [
                foot,
                foot + np.column_stack([0.0 * high, high]),
                np.column_stack([above[:, 0], foot[:, 1] + high + slide]),
            ]
        return np.stack([*corners, rows[-1]], axis=1)


class TrackTooLow(FeederError):
    """A device leads the track down too far: a steeper climb leaves more room below it."""

    climb: float | None = None  # [rad] that mends it; None where none is known


@dataclass(frozen=True, eq=False)
class BowlPlan:
    """A bowl in lengths [m] and angles [rad]; heights over the floor's edge."""

    path: TrackPath
    width: float  # of the track, along its surface
    material: BowlMaterial
    stretch: TooledTrack | None  # None without devices
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
    is_section: bool = False  # a stretch alone, to print: its plate goes through the wall, without a fillet

    @property
    def across(self) -> float:
        """Width of the track, seen from above, where it is widest."""
        return self.width * float(np.cos(self.path.least_bank))

    @property
    def segments(self) -> int:
        """Return how many facets a full turn has; where the track is steep across, more."""
        banks = self.path.bank, *(bank for _, _, bank in self.path.leans)
        chord = self.chord / max(1.0, *(BANK_DROP_FACTOR * float(np.tan(bank)) for bank in banks))
        return int(np.ceil(FULL_TURN_RAD / (2.0 * np.arccos(1.0 - chord / self.path.radius)) / 4.0)) * 4

    @property
    def outlet_height(self) -> float:
        """Height of the outlet's surface by the wall."""
        return float(self.path.height(self.path.end))

    @property
    def turns(self) -> float:
        """Turns of the track from the floor to the outlet."""
        return -float(self.path.angle(0.0)) / FULL_TURN_RAD

    @property
    def ring(self) -> float:
        """Radius up to which the floor is level, a little more than the track covers; the dome is within."""
        lowest = self.path.rises(self.width) - DIP * self.path.radius if self.stairs else 0.0
        covered = self.width * float(np.cos(self.path.bank))
        return float(self.path.wall_radius(lowest)) - covered - BOLT_CLEARANCE_M

    @property
    def dome(self) -> float:
        """Rise of the floor from its edge to the middle."""
        return self.ring * float(np.tan(DOME))

    @property
    def underside(self) -> float:
        """Height of the face that stands on the drive."""
        return -self.material.floor

    def floor(self, r: Values) -> Values:
        """Return the height of the floor at some radii.

        Parameters
        ----------
        r : float or (...) float [m]

        Returns
        -------
        (...) float [m]
        """
        return np.maximum(self.ring - np.asarray(r, float), 0.0) * np.tan(DOME)


@dataclass(frozen=True)
class SolidOptions:
    """Wishes for the solid beside the sizes of the sheet."""

    chord: float = ARC_CHORD_M
    material: str = "steel"
    outlet_height: float = 0.0  # [m] 0: as the track's turns make it
    outlet_angle: float = 0.0  # [rad]
    left: bool = False
    shape: str = CYLINDER  # of the wall: cylinder, stepped or conical
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


def plan(
    size: Size,
    track: Track,
    made_of: BowlMaterial,
    tooled: TooledTrack | None,
    options: SolidOptions,
    *,
    extents: Extents,
) -> BowlPlan:
    """Return the measures of a bowl as a solid, decided before a facet is made.

    The outlet is so long that the track's free edge leaves the wall: sqrt((R + t)^2 - (R - w cos(bank))^2)
    and ``OUTLET`` more, with the wall's thickness t and the track's width w.

    Parameters
    ----------
    size : Size
    track : Track
        Of that size.
    made_of : BowlMaterial
    tooled : TooledTrack or None
    options : SolidOptions
    extents : (3,) float [m]
        Of the part along its axes.

    Returns
    -------
    BowlPlan

    Raises
    ------
    FeederError
        If the track is too wide for the bowl, does not rise, or is too short for the devices. Also if
        something that falls through them would not reach the floor, or the bolts and drains have no room.
    """
    widest = MAX_TRACK_WIDTH_RATIO * track.radius
    if track.width > widest:
        what = f"{1e3 * track.width:.4g} mm is too wide for a bowl of {1e3 * size.diameter:.4g} mm"
        mend = f"give at most {1e3 * widest:.4g} mm, or a larger track.radius"
        raise FeederError("track.width", what, mend)
    if track.climb <= 0.0:
        what = f"{np.degrees(track.climb):.3g} deg does not lead a track out of the bowl"
        raise FeederError("track.climb", what, "give a climb, as 3.5 deg, or leave it out")
    stepped = _stairs(track, made_of, tooled, options, extents)
    path, first = _track_path(size, track, made_of, tooled, options, stepped)
    bolt_circle, hub = _bolt_circle(track, options, extents, float(path.wall_radius(0.0)))
    across = track.width * np.cos(path.least_bank)
    outlet = np.sqrt((track.radius + made_of.wall) ** 2 - (track.radius - across) ** 2) + OUTLET
    greatest = float(max(extents))
    tallest = greatest if tooled is None else tooled.tallest
    gates = [tooled.top] if tooled else []
    hangs = tooled is not None and tooled.hangs
    return BowlPlan(
        path=path,
        width=track.width,
        material=made_of,
        stretch=tooled,
        first=first,
        outlet=float(outlet),
        hanging=greatest + RAIL_CLEARANCE_M if hangs else 0.0,
        headroom=tallest,
        top=float(path.risen([*(at for at, _ in path.bends), path.end]).max())
        + max([tallest + WALL_ABOVE_PART_M, *gates]),
        hub=hub,
        bolts=options.bolts,
        bolt=options.bolt,
        bolt_circle=bolt_circle,
        drains=options.drains,
        drain=options.drain,
        turned=options.outlet_angle,
        left=options.left,
        chord=options.chord,
        stairs=stepped,
    )


def _stairs(
    track: Track, made_of: BowlMaterial, tooled: TooledTrack | None, options: SolidOptions, extents: Extents
) -> Stairs | None:
    """Return the steps of a wall, None of a cylinder.

    Raises the fault of a track that does not rise enough for them, or of devices on a wall that leans.
    """
    if options.shape == CYLINDER:
        return None
    if options.shape == CONICAL and tooled is not None:
        what = "conical leans outwards, and devices are computed by an upright wall"
        raise FeederError("sizing.shape", what, "take stepped")
    least = min([track.bank, *(bank for _, _, bank in tooled.banks)]) if tooled else track.bank
    step = track.width * np.cos(least) + TURN_CLEARANCE_M
    flare = -np.log1p(-step / track.radius) / FULL_TURN_RAD
    tallest = float(max(extents)) if tooled is None else tooled.tallest
    hangs = tooled is not None and tooled.hangs
    slope = SLOPE if made_of.supported else UNSUPPORTED_SLOPE_RAD
    slope = max(slope, float(np.arctan(options.friction)) + SURE)
    pitch = np.tan(track.climb) * step / flare
    below = 3.0 * made_of.plate + (float(max(extents)) + MIN_WALL_ABOVE_PART_M if hangs else 0.0)
    upright = tallest + MIN_WALL_ABOVE_PART_M
    if options.shape == CONICAL:
        slope, below, upright = float(np.arctan2(pitch, step)), 0.0, 0.0
    elif pitch < (needed := upright + step * np.tan(slope) + below):
        least = np.ceil(10.0 * np.degrees(np.arctan(needed / (step / flare)))) / 10.0
        what = f"a turn rises {1e3 * pitch:.4g} mm, and a stepped wall needs {1e3 * needed:.4g} mm"
        raise FeederError("track.climb", what, f"give {least:.4g} deg, or sizing.shape: cylinder")
    most = float((1.0 - MIN_FLOOR_RADIUS_SHARE) * track.radius / flare)
    return Stairs(options.shape, float(step), float(flare), slope, upright, below, most)


def _track_path(
    size: Size,
    track: Track,
    made_of: BowlMaterial,
    tooled: TooledTrack | None,
    options: SolidOptions,
    stepped: Stairs | None,
) -> tuple[TrackPath, float]:
    """The way of the track, and where on it the tooled stretch begins."""
    height, flare = options.outlet_height, 0.0 if stepped is None else stepped.flare
    needed = 0.0 if tooled is None else tooled.length + OUTLET_LEAD_M
    rise = np.tan(track.climb)
    gained = 0.0  # by which the track's end lies over the begin of the tooled stretch
    if tooled is not None:
        stretch = TrackPath(track.radius, track.climb, track.bank, needed, tooled.drops, tooled.climbs)
        gained = float(stretch.height(needed))
    # how long it may be: what falls through a cut of a cylinder must not meet a turn below
    # `free` [m]: how much of the track has no turn below it, from where it rises
    free = FULL_TURN_RAD * track.radius - track.width * np.sin(track.bank) / rise
    falls = None if tooled is None or stepped is not None else tooled.falls
    most = np.inf if falls is None else free + needed - falls
    end = min(size.depth / rise, most, np.inf if stepped is None else stepped.most)
    if height > 0.0:
        end = needed + (height - gained) / rise
        if end > most:
            highest = rise * (most - needed) + gained
            what = f"{1e3 * height:.4g} mm puts a turn of the track below the cuts: what falls stays on it"
            raise FeederError("sizing.outlet_height", what, f"give at most {1e3 * highest:.4g} mm")
        if stepped is not None and end > stepped.most:
            what = "leaves too small a floor: the wall steps outwards with the track"
            mend = f"give at most {1e3 * stepped.most * rise:.4g} mm, or a larger bowl"
            raise FeederError("sizing.outlet_height", what, mend)
    # how long it must be: for the devices, and for a quarter turn over the dome, where its width is measured
    over = SEEN * made_of.plate + track.width * np.tan(DOME) + CLEARED
    turn = MIN_CLEAR_TRACK_RAD if flare == 0.0 else -float(np.expm1(-flare * MIN_CLEAR_TRACK_RAD)) / flare
    first, quarter = end - needed, track.radius * turn + over / rise
    if first < 0.0:
        if height <= 0.0:
            what = f"they take {1e3 * needed:.4g} mm of track, and it has {1e3 * end:.4g} mm"
            raise FeederError("devices", what, "take fewer, a larger sizing.depth, or a larger bowl")
        what = f"{1e3 * height:.4g} mm leaves {1e3 * end:.4g} mm of track"
        what += f", and the devices take {1e3 * needed:.4g} mm"
        least = gained + rise * max(quarter - needed, 0.0)
        raise FeederError("sizing.outlet_height", what, f"give at least {1e3 * least:.4g} mm")
    if end < quarter * SHORTEST:
        what = f"{1e3 * end:.4g} mm of track, less than a quarter turn"
        if height > 0.0:
            mend = f"give at least {1e3 * (rise * quarter + (gained - rise * needed)):.4g} mm"
            raise FeederError("sizing.outlet_height", f"{1e3 * height:.4g} mm leaves {what}", mend)
        raise FeederError("sizing.depth", f"it leaves {what}", "give a larger one, or a smaller track.climb")
    path = TrackPath(track.radius, track.climb, track.bank, float(end), flare=flare)
    if tooled is not None:
        path = replace(
            path,
            drops=tuple((first + at, drop) for at, drop in tooled.drops),
            bends=tuple((first + at, climb) for at, climb in tooled.climbs),
            leans=tuple((first + a, first + b, bank) for a, b, bank in tooled.banks),
        )
        if path.bends or path.drops:
            _check_lowest(path, stepped, tooled.tallest)
    return path, float(first)


def _check_lowest(path: TrackPath, stepped: Stairs | None, tallest: float) -> None:
    """Raise the fault of a track that goes down too near to the floor, or to the turn before."""
    ends = [*(at for at, _ in path.bends), *(at for at, _ in path.drops), path.end]
    lowest = float(path.height(ends).min())
    if lowest < MIN_TRACK_HEIGHT_M:
        what = f"a device leads the track down to {1e3 * lowest:.3g} mm over the floor"
        least = 1e3 * (float(path.height(path.end)) + MIN_TRACK_HEIGHT_M - lowest)
        raise TrackTooLow("devices", what, f"give a sizing.outlet_height of at least {least:.4g} mm")
    if not path.bends:  # a drop takes little of the height that a turn gains
        return
    if stepped is None:
        round_once = FULL_TURN_RAD * path.radius
        free = lowest - float(path.risen(path.end - round_once))
        if path.end > round_once and free < tallest + WALL_ABOVE_PART_M:
            what = f"a device leads the track down to {1e3 * free:.3g} mm over the turn below"
            raise TrackTooLow("devices", what, "give a lower sizing.outlet_height")
        return
    last = np.array([*(at for at, _ in path.bends), path.end])
    free = float((path.risen(last) - path.risen(path.at(path.angle(last) - FULL_TURN_RAD))).min())
    if free < stepped.needed:
        what = f"a device leads the track down to {1e3 * free:.4g} mm over the turn before"
        mend = (
            f"{1e3 * stepped.needed:.4g} mm are needed: give a steeper track.climb, or sizing.shape: cylinder"
        )
        raise TrackTooLow("devices", what, mend)
