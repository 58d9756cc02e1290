"""The tooled track: the features of devices, placed along a track once, for all who try, draw and cut it.

A path along the wall, with climb, bank, lean of the wall and level as functions of the length s, and the
features of each device placed on it, built from a bowl's track, the devices and the part's orientations.
The trial, dimensions, DXF, SVG, sheets, the printed section, the bowl's solid and its STEP file read it.

Words: the *size* of a part is the root of its length squared plus the square of its width or its height,
whichever is larger, in the orientation where that is greatest. The *way* of a device is the stretch of track
from ``start`` to ``end`` that it is given; ``begin`` lies within it and is the origin of its features. The
*entry* of a track is its begin in the bowl, far before the stretch: devices that come first and lean the
track lean it from there.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from feederscrew.base.arrays import Floats, Points, Reals, Values
from feederscrew.bowl.devices.base import Device, room_of, size_of
from feederscrew.bowl.devices.features import Drop, Features, ShopWork, TrackOpening
from feederscrew.bowl.record import Track
from feederscrew.sorting.fates import leading_devices
from feederscrew.sorting.orientations import Orientation

DRAWN_TRACK_MARGIN_M = 5e-3  # [m] of track beyond what parts and cuts need, where not all of it is drawn
SLOT_OVERLAP_M = 2e-6  # [m] by which a slot reaches into that of the next rails: no web is left between them
MAX_EDGE_SLOPE_RAD = np.radians(10.0)  # [rad] of the track's free edge along it, where the bank changes
MIN_TWIST_ROOMS = 0.5  # [1] of ``room_of`` the orientations: least length of a twist
BORE_RIM = 1.5  # [1] of a bore's diameter: wall over its middle
DRAWN_SAGITTA_M = 1e-5  # [m] by which an arc may be seen too flat
SPARE_SIZES = 0.1  # [1] of the part's size: free way beyond half of it, before and behind a device
CLEAR_SIZES = 0.5 + SPARE_SIZES  # [1] of the part's size: its centre of mass to a device it is clear of


@dataclass(frozen=True, eq=False)
class PlacedDevice:
    """One device at its place along the track."""

    device: Device
    start: float  # [m] s where its way begins
    end: float  # [m] s where that ends: a part is clear of it there, and has settled
    begin: float  # [m] s of the origin of its features
    level: float  # [m] of the track where it begins; below 0 behind steps down
    features: Features  # from ``begin`` on
    openings: tuple[TrackOpening, ...]  # s and distance from the wall [m]: slots go on as they are made
    radius: float  # [m] of the wall

    @property
    def label(self) -> str:
        """Return 'gap 9 mm': kind and value, the latter where it is one number."""
        return self.device.label

    @property
    def length(self) -> float:
        """Length [m] of its way."""
        return self.end - self.start

    @property
    def drop(self) -> Drop | None:
        """The drop at it; None where it has none, or one of no height."""
        drop = self.features.drop
        return None if drop is None or drop.height <= 0.0 else drop

    @property
    def footprints(self) -> list[Points]:
        """Each blade (K, 2) [m] seen from above, unrolled: s and distance from the wall."""
        return [blade.footprint(self.radius) + [self.begin, 0.0] for blade in self.features.blades]

    @property
    def span(self) -> tuple[float, float]:
        """From and to s [m]: of a cut or a blade its own, else of its way."""
        rings = [opening.ring for opening in self.openings] or self.footprints
        if not rings:
            return self.start, self.end
        along = np.concatenate([ring[:, 0] for ring in rings])
        return float(along.min()), float(along.max())

    def shop_work(self, width: float) -> tuple[ShopWork, ...]:
        """Return what the shop must do to its cuts, beside cutting outlines.

        Parameters
        ----------
        width : float [m]
            Of the track.

        Returns
        -------
        tuple of ShopWork
            Each once.
        """
        work = [job for opening in self.openings for job in opening.shop_work(width)]
        return tuple(dict.fromkeys(work))


@dataclass(frozen=True, eq=False)
class Ledge:
    """A ledge along the wall, above the track that goes on lower beside it, and the ramp at its end."""

    label: str  # 'tipping ledge 6 mm'
    begin: float  # [m] s where the track beside it goes on lower
    end: float  # [m] s where it begins to come down
    drop: Drop
    radius: float  # [m] of the wall

    @property
    def foot(self) -> float:
        """S [m] where all of its ramp has come down to the lower track."""
        return self.end + self.drop.ramp_length(self.radius)

    def sunk(self, depth: float) -> float:
        """Return where all of its ramp, made longer, lies below the surface of the lower track.

        Parameters
        ----------
        depth : float [m]
            So far below it.

        Returns
        -------
        float [m]
            S along the wall.
        """
        return self.end + replace(self.drop, height=self.drop.height + depth).ramp_length(self.radius)

    def level_at(self, s: Values, y: Values) -> Floats:
        """Return the level of its surface over that of the ledge; its ramp goes on below the lower track.

        The ramp is flat: it is bent down about the line square to the wall where the ledge ends.

        Parameters
        ----------
        s : float or (...) float [m]
        y : float or (...) float [m]
            From the wall.

        Returns
        -------
        (...) float [m]
            At most 0.
        """
        turn = np.maximum((np.asarray(s) - self.end) / self.radius, 0.0)
        return -np.tan(self.drop.ramp) * (self.radius - np.asarray(y)) * np.sin(turn)


@dataclass(frozen=True)
class GrooveStretch:
    """A stretch in which the wall leans back, as the other face of a V: from upright to upright."""

    leans: tuple[tuple[float, float, float], ...]  # from and to s [m] the wall comes to a lean [rad]; last 0

    @property
    def begin(self) -> float:
        """S [m] from which it opens; -inf where it is open from the track's entry on."""
        return self.leans[0][0]

    @property
    def end(self) -> float:
        """S [m] from which it closes; inf where it goes on to the outlet."""
        return self.leans[-1][0]

    @property
    def closed(self) -> float:
        """S [m] from which the wall is upright again."""
        return self.leans[-1][1]

    @property
    def lean(self) -> float:
        """The most [rad] by which the wall leans back from upright."""
        return max(lean for _, _, lean in self.leans)

    def lean_at(self, s: Values) -> Floats:
        """Return the lean of the wall from upright at some lengths: linear over each change.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [rad]
        """
        return changed_at(s, 0.0, self.leans)


@dataclass(frozen=True, eq=False)
class TooledTrack:
    """The stretch of track with its devices: lengths s along the wall from the datum D, where it begins."""

    track: Track  # as it comes to the stretch: with the bank that the first devices give it from its entry
    length: float  # [m] along the wall
    width: float  # [m] of it that is drawn
    tallest: float  # [m] of all orientations
    longest: float  # [m] of all orientations, along the track
    devices: tuple[PlacedDevice, ...]  # in the order parts meet them
    climbs: tuple[tuple[float, float], ...] = ()  # s [m] from which it climbs otherwise, and how [rad]
    banks: tuple[tuple[float, float, float], ...] = ()  # from and to s [m] it twists to another bank [rad]
    walls: tuple[tuple[float, float, float], ...] = ()  # from and to s [m] the wall comes to a lean [rad]
    drops: tuple[tuple[float, float], ...] = ()  # s and height [m] of each step down
    ledges: tuple[Ledge, ...] = ()

    def climb_at(self, s: Values) -> Floats:
        """Return the climb at some lengths: constant between its changes.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [rad]
        """
        places = np.array([at for at, _ in self.climbs])
        climbs = np.array([self.track.climb, *(climb for _, climb in self.climbs)])
        return climbs[np.searchsorted(places, s, side="right")]

    def bank_at(self, s: Values) -> Floats:
        """Return the bank at some lengths: linear over each twist.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [rad]
        """
        return changed_at(s, float(self.track.bank), self.banks)

    def wall_lean_at(self, s: Values) -> Floats:
        """Return the lean of the wall from upright at some lengths: linear over each change.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [rad]
        """
        return changed_at(s, 0.0, self.walls)

    @property
    def grooves(self) -> tuple[GrooveStretch, ...]:
        """The stretches in which the wall leans back; grooves that adjoin are one stretch."""
        stretches: list[GrooveStretch] = []
        leans: list[tuple[float, float, float]] = []
        for change in self.walls:
            leans.append(change)
            if change[2] == 0.0:
                stretches.append(GrooveStretch(tuple(leans)))
                leans = []
        if leans:
            stretches.append(GrooveStretch((*leans, (np.inf, np.inf, 0.0))))
        return tuple(stretches)

    def level_at(self, s: Values) -> Floats:
        """Return the level of the track at some lengths, its climb left out: it falls at each step.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [m]
        """
        fallen = [np.where(np.asarray(s) >= at, drop, 0.0) for at, drop in self.drops]
        return -np.sum(fallen, axis=0) if fallen else np.zeros(np.shape(s))

    @property
    def fallen(self) -> float:
        """By how much [m] the track has gone down by its steps where it ends."""
        return float(sum(drop for _, drop in self.drops))

    @property
    def openings(self) -> tuple[tuple[PlacedDevice, TrackOpening], ...]:
        """Every opening with its device."""
        return tuple((placed, opening) for placed in self.devices for opening in placed.openings)

    def opened_to(self, s: float) -> "TooledTrack":
        """Return the track with the slots that are open at its end up to another length.

        Parameters
        ----------
        s : float [m]

        Returns
        -------
        TooledTrack
        """
        devices = tuple(
            replace(
                item,
                openings=tuple(o.extended(s) if o.hangs and not o.runs_on else o for o in item.openings),
            )
            for item in self.devices
        )
        return replace(self, devices=devices)

    @property
    def falls(self) -> float | None:
        """S [m] where the last part that a cut returns goes down; None without cuts.

        What falls through rails does so in them, or in the slot that goes on below a blade: what the blade
        sweeps off crosses the slot. Behind the last blade what is there hangs.
        """
        ends = (
            max(device.begin + device.features.length for device in (placed, *self._blades_over(opening)))
            if opening.hangs
            else opening.end
            for placed, opening in self.openings
        )
        return max(ends, default=None)

    def _blades_over(self, slot: TrackOpening) -> tuple[PlacedDevice, ...]:
        """The devices whose blades stand over a slot."""
        return tuple(
            placed
            for placed in self.devices
            if placed.features.blades and slot.ring[:, 0].min() < placed.begin < slot.end
        )

    @property
    def hangs(self) -> bool:
        """Tell whether parts leave hanging between rails."""
        return any(placed.features.hangs for placed in self.devices)

    @property
    def top(self) -> float:
        """Height [m] over the track to which the wall must reach for blades and bores; 0 without."""
        own = [placed.features for placed in self.devices]
        blades = (blade.top for features in own for blade in features.blades)
        bores = (bore.height + BORE_RIM * bore.diameter for features in own for bore in features.bores)
        return max((*blades, *bores), default=0.0)


def lay_out(
    track: Track,
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    *,
    lead: float = 0.0,
    whole: bool = False,
) -> TooledTrack:
    """Return the stretch of track that holds a chain of devices, in the order parts meet them.

    Before and behind each device a part has room to be clear of it: ``CLEAR_SIZES`` of its size to either
    side of its centre of mass. Behind a drop it has as much more as it needs to settle. A bank changes so
    slowly that the free edge rises or falls by at most ``MAX_EDGE_SLOPE_RAD``.

    Parameters
    ----------
    track : Track
        As the bowl has it.
    devices : sequence of Device
        Measured yields need no place.
    orientations : sequence of Orientation
        Of the part.
    lead : float [m], optional
        Of bare track before the way that the first device is given.
    whole : bool, optional
        Take a very wide track as wide as it is; else as wide as parts and cuts need.

    Returns
    -------
    TooledTrack

    Raises
    ------
    ConfigError
        A device names an orientation that the part does not have.
    """
    chain = [device for device in devices if device.action.has_place]
    track, entry = track_at_entry(track, chain, orientations), len(leading_devices(chain))
    longest = max(orientation.length for orientation in orientations)
    width = track.extent if whole else _drawn_width(track, chain, orientations)
    shown = track if track.width <= track.extent else replace(track, width=width)
    features = _features_along(shown, chain, orientations)
    twists = _twists(track, features, entry, MIN_TWIST_ROOMS * room_of(orientations), longest)
    placed = _placed_devices(chain, features, twists, lead, size_of_part(orientations), track.radius)
    length = placed[-1].end if placed else lead
    slots = continue_slots([item.openings for item in placed], length, SLOT_OVERLAP_M)
    begins = [item.begin for item in placed]
    return TooledTrack(
        track=track,
        length=length,
        width=width,
        tallest=max(orientation.height for orientation in orientations),
        longest=longest,
        devices=tuple(replace(item, openings=own) for item, own in zip(placed, slots)),
        climbs=tuple(
            (item.begin + slope.begin, slope.climb)
            for item in placed
            for slope in item.features.slopes
            if slope.climb is not None
        ),
        banks=tuple(
            (begin + own.begin, begin + own.begin + own.length, own.bank)
            for begin, some in zip(begins, twists)
            for own in some
            if own.bank is not None
        ),
        walls=_walls(placed, twists, entry),
        drops=tuple((item.begin, item.drop.height) for item in placed if item.drop is not None),
        ledges=_ledges(placed),
    )


@dataclass(frozen=True)
class _Twist:
    """Where a track comes to lean otherwise, from the origin of the device that leans it."""

    begin: float  # [m]
    length: float  # [m]
    bank: float | None  # [rad] behind it; None where that is as before
    wall: float | None  # [rad] of the wall behind it; None where that is as before


def _drawn_width(track: Track, devices: Sequence[Device], orientations: Sequence[Orientation]) -> float:
    """Return the width [m] of a track that is drawn: of a very wide one not all."""
    if track.width <= track.extent:
        return track.width
    needed = [orientation.width for orientation in orientations]
    for features in _features_along(track, devices, orientations):
        ends = np.concatenate([[0.0], *(opening.ring[:, 1] for opening in features.openings)])
        needed.append(float(ends[ends < track.extent].max()))
        needed.append(0.0 if features.drop is None else features.drop.aside)
    return min(max(needed) + DRAWN_TRACK_MARGIN_M, track.extent)


def _features_along(
    track: Track, devices: Sequence[Device], orientations: Sequence[Orientation]
) -> list[Features]:
    """Return the features of each device on the track as the devices before it leave it."""
    along = []
    for device in devices:
        own = device.features(track, orientations)
        for slope in own.slopes:
            track = track if slope.bank is None else replace(track, bank=slope.bank)
            track = track if slope.climb is None else replace(track, climb=slope.climb)
        along.append(own)
    return along


def _twists(
    track: Track, features: Sequence[Features], entry: int, shortest: float, opens: float
) -> list[tuple[_Twist, ...]]:
    """Return the twists of each device; those of the entry lean the track before it begins.

    A groove's wall leans over the same length as its bank twists: so the V opens and closes evenly.

    ``entry`` counts the devices that come first and lean the track from its entry on; ``shortest`` [m] is a
    twist at least, ``opens`` [m] one in which the wall leans.
    """
    bank, wall, twists = track.bank, 0.0, []
    for number, own in enumerate(features):
        here = []
        for slope in own.slopes:
            new_bank = bank if slope.bank is None else slope.bank
            new_wall = wall if slope.wall is None else slope.wall
            if number >= entry and (new_bank, new_wall) != (bank, wall):
                # by how much the free edge rises or falls
                edge = track.extent * abs(np.sin(new_bank) - np.sin(bank))
                least = shortest if new_wall == wall else max(shortest, opens)
                length = slope.length or float(max(least, edge / np.tan(MAX_EDGE_SLOPE_RAD)))
                changed = new_bank if new_bank != bank else None, new_wall if new_wall != wall else None
                here.append(_Twist(slope.begin, length, *changed))
            bank, wall = new_bank, new_wall
        twists.append(tuple(here))
    return twists


def _placed_devices(
    chain: Sequence[Device],
    features: Sequence[Features],
    twists: Sequence[tuple[_Twist, ...]],
    start: float,
    size: float,
    radius: float,
) -> list[PlacedDevice]:
    """Return the devices one behind the other, each with its way; openings as the device alone has them."""
    placed, level = [], 0.0
    for device, own, some in zip(chain, features, twists):
        begin = start + CLEAR_SIZES * size
        end = max([clear_behind(begin, own, size), *(begin + twist.begin + twist.length for twist in some)])
        openings = tuple(opening.shifted(begin) for opening in own.openings)
        placed.append(PlacedDevice(device, start, end, begin, level, own, openings, radius))
        level -= 0.0 if placed[-1].drop is None else placed[-1].drop.height
        start = end
    return placed


def _ledges(placed: Sequence[PlacedDevice]) -> tuple[Ledge, ...]:
    """Return the ledges along the wall."""
    return tuple(
        Ledge(item.label, item.begin, item.begin + item.drop.length, item.drop, item.radius)
        for item in placed
        if item.drop is not None and item.drop.aside > 0.0
    )


def _walls(
    placed: Sequence[PlacedDevice], twists: Sequence[tuple[_Twist, ...]], entry: int
) -> tuple[tuple[float, float, float], ...]:
    """Return where the wall comes to lean; at the entry before the first of the track."""
    leading = (slope.wall for item in placed[:entry] for slope in item.features.slopes)
    first = [(-np.inf, -np.inf, lean) for lean in leading if lean]
    return (
        *first,
        *(
            (item.begin + own.begin, item.begin + own.begin + own.length, own.wall)
            for item, some in zip(placed, twists)
            for own in some
            if own.wall is not None
        ),
    )


def continue_slots(
    openings: Sequence[Sequence[TrackOpening]], end: float, overlap: float, enough: float = np.inf
) -> list[tuple[TrackOpening, ...]]:
    """Return openings with slots that parts hang in up to the next rails, and of the last ones to the end.

    A part hangs from its rails to the end of the track: a web across the slot would stop it.

    Parameters
    ----------
    openings : sequence of sequence of TrackOpening
        Of each device, placed along the track.
    end : float [m]
        S where the track ends: the last slot is open there.
    overlap : float [m]
        By which a slot reaches into that of the next rails.
    enough : float [m]
        S up to which the last slot must go: one that goes so far stays as it is.

    Returns
    -------
    list of tuple of TrackOpening
    """
    continued: list[tuple[TrackOpening, ...]] = []
    last = True
    for own in reversed(openings):
        goes_on = [opening.hangs and not (last and opening.end >= enough) for opening in own]
        here = tuple(replace(o.extended(end), runs_on=not last) if on else o for o, on in zip(own, goes_on))
        slots = [opening for opening in here if opening.hangs]
        if slots:
            end, last = slots[0].begin + overlap, False
        continued.append(here)
    return continued[::-1]


def changed_at(s: Values, first: float, changes: Sequence[tuple[float, float, float]]) -> Floats:
    """Return a value along a track at some lengths: linear over each of its changes.

    Parameters
    ----------
    s : float or (...) float [m]
    first : float [rad]
        Before all changes.
    changes : sequence of (float [m], float [m], float [rad])
        From and to which length it comes to another value; from -inf of one that holds from the entry on.

    Returns
    -------
    (...) float [rad]
    """
    value, before = np.full(np.shape(s), first), first
    for start, end, after in changes:
        is_sudden = not np.isfinite(start) or end <= start
        share = (
            (np.asarray(s) >= start) if is_sudden else np.clip((np.asarray(s) - start) / (end - start), 0, 1)
        )
        value = value + (after - before) * share
        before = after
    return value


def clear_behind(begin: float, features: Features, size: float) -> float:
    """Return where a part is clear of a device behind it, and has settled where that drops it.

    Parameters
    ----------
    begin : float [m]
        Where its features begin.
    features : Features
    size : float [m]
        Of the part, as ``size_of_part`` returns it.

    Returns
    -------
    float [m]
    """
    return begin + features.length + (features.settles + CLEAR_SIZES) * size


def size_of_part(orientations: Sequence[Orientation]) -> float:
    """Return the size of a part: the greatest ``size_of`` its orientations.

    Parameters
    ----------
    orientations : sequence of Orientation

    Returns
    -------
    float [m]
    """
    return max(size_of(orientation) for orientation in orientations)


def bend_ring(ring: Points, radius: float, shift: float = 0.0, sagitta: float = DRAWN_SAGITTA_M) -> Points:
    """Return a ring as it lies in the bowl, its sides along the wall bent to arcs.

    It is measured from the point where the wall is tangent to X, the bowl's axis at (0, radius).

    Parameters
    ----------
    ring : (K, 2) float [m]
        Along the wall, and from it.
    radius : float [m]
        Of the wall.
    shift : float [rad], optional
        By which it is turned ahead.
    sagitta : float [m], optional
        By which an arc may be seen too flat.

    Returns
    -------
    (N, 2) float [m]
    """
    border = shapely.linestrings(np.vstack([ring, ring[:1]]))
    fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(8.0 * radius * sagitta)))[:-1]
    theta, r = fine[:, 0] / radius + shift, radius - fine[:, 1]
    return np.column_stack([r * np.sin(theta), radius - r * np.cos(theta)])


def along_wall(places: Floats, radius: float, middle: Reals = 0.0) -> Floats:
    """Return how far along the wall places of the bowl are: the inverse of ``bend_ring``.

    A place alone does not say how often a track has gone round before it comes there.

    Parameters
    ----------
    places : (..., 2) float [m]
        From the point where the wall is tangent to X, the bowl's axis at (0, radius).
    radius : float [m]
        Of the wall.
    middle : float or (...) float [m], optional
        Of the stretch of track that is meant: a turn long, half of it to either side.

    Returns
    -------
    (...) float [m]
        Within half a turn of ``middle``. All lengths may be in another unit.
    """
    turn = 2.0 * np.pi * radius
    along = radius * np.arctan2(places[..., 0], radius - places[..., 1])
    return along - turn * np.round((along - middle) / turn)


def track_at_entry(track: Track, devices: Sequence[Device], orientations: Sequence[Orientation]) -> Track:
    """Return the track with the bank that the first devices give it from its entry on.

    Parameters
    ----------
    track : Track
    devices : sequence of Device
        In the order parts meet them.
    orientations : sequence of Orientation
        Of the part on the track.

    Returns
    -------
    Track
    """
    for device in leading_devices([device for device in devices if device.action.has_place]):
        for slope in device.features(track, orientations).slopes:
            track = track if slope.bank is None else replace(track, bank=slope.bank)
    return track
