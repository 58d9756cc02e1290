"""The tooled track: the features of devices, placed along a track once, for all who draw, print and cut it.

A path along the wall, with climb, bank, lean of the wall and level as functions of the length s, and the
features of each device placed on it, built from a bowl's track, the devices and the part's orientations.
Dimensions, DXF, SVG, sheets, the printed section, the bowl's solid and its STEP file read it and add nothing;
the trial takes the same features and the same rule for slots that go on (``continue_slots``).
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from feederscrew.arrays import Floats, Points, Values
from feederscrew.bowl.record import Track
from feederscrew.sorting.devices.base import Device, room_of
from feederscrew.sorting.devices.features import Features, ShopWork, TrackOpening
from feederscrew.sorting.fates import leading_devices
from feederscrew.sorting.orientations import Orientation

DRAWN_TRACK_MARGIN_M = 5e-3  # [m] of track beyond what parts and cuts need, where not all of it is drawn
SLOT_OVERLAP_M = 2e-6  # [m] by which a slot reaches into that of the next rails: no web is left between them
MAX_EDGE_SLOPE_RAD = np.radians(10.0)  # slope along the track of its free edge, where the bank changes
RAMP = np.radians(15.0)  # slope on which a ledge comes down to the track beside it
TWIST = 0.5  # of the room that a part has to itself: over so much the bank changes at least
DRAWN_CHORD_M = 1e-5  # [m] by which an arc may be seen too flat
BETWEEN = 0.5  # rooms of a device between two of them


@dataclass(frozen=True, eq=False)
class PlacedDevice:
    """One device at its place along the track."""

    device: Device
    start: float  # [m] s where the track begins that it is given
    length: float  # [m] of that
    begin: float  # [m] s of the origin of its features
    level: float  # [m] of the track where it begins: steps before it are below 0
    features: Features  # from ``begin`` on
    openings: tuple[TrackOpening, ...]  # s and distance from the wall [m]: slots go on as they are made
    radius: float  # [m] of the wall

    @property
    def label(self) -> str:
        """Return 'gap 9 mm': kind and value, the latter where it is one number."""
        return self.device.label

    @property
    def end(self) -> float:
        """S [m] where the track ends that it is given."""
        return self.start + self.length

    @property
    def footprints(self) -> list[Points]:
        """Each blade (K, 2) [m] seen from above, unrolled: s and distance from the wall."""
        return [blade.footprint(self.radius) + [self.begin, 0.0] for blade in self.features.blades]

    @property
    def span(self) -> tuple[float, float]:
        """From and to s [m]: of a cut or a blade its own, else of the track that it is given."""
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


@dataclass(frozen=True)
class Ledge:
    """A ledge along the wall, above the track that goes on lower beside it."""

    label: str  # 'tipping ledge 6 mm'
    start: float  # [m] s where the track beside it goes on lower
    end: float  # [m] s where it begins to come down
    width: float  # [m]
    drop: float  # [m] of the track beside it
    ramp: float  # [m] over which it comes down


@dataclass(frozen=True)
class GrooveStretch:
    """A stretch in which the wall leans back, as the other face of a V."""

    start: float  # [m] s; -inf: from the track's entry on
    end: float  # [m] s; inf: to the outlet
    lean: float  # [rad] of the wall from upright
    opens: float  # [m] over which it opens, and closes


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
    drops: tuple[tuple[float, float], ...] = ()  # s and height [m] of each step down
    ledges: tuple[Ledge, ...] = ()
    grooves: tuple[GrooveStretch, ...] = ()

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
        bank = np.full(np.shape(s), float(self.track.bank))
        before = self.track.bank
        for start, end, after in self.banks:
            bank = bank + (after - before) * np.clip((np.asarray(s) - start) / (end - start), 0.0, 1.0)
            before = after
        return bank

    def wall_lean_at(self, s: Values) -> Floats:
        """Return the lean of the wall from upright at some lengths; it opens and closes linearly.

        Parameters
        ----------
        s : float or (...) float [m]

        Returns
        -------
        (...) float [rad]
        """
        lean = np.zeros(np.shape(s))
        for groove in self.grooves:
            opened = np.clip((np.asarray(s) - groove.start) / groove.opens, 0.0, 1.0)
            closed = np.clip((np.asarray(s) - groove.end) / groove.opens, 0.0, 1.0)
            lean = np.maximum(lean, groove.lean * opened * (1.0 - closed))
        return lean

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
        """S [m] where the last part that a cut returns goes down; None without cuts."""
        return max((opening.end for _, opening in self.openings), default=None)

    @property
    def hangs(self) -> bool:
        """Tell whether parts leave hanging between rails."""
        return any(placed.features.hangs for placed in self.devices)

    @property
    def top(self) -> float:
        """Height [m] over the track of the highest blade; 0 without."""
        return max((b.top for placed in self.devices for b in placed.features.blades), default=0.0)


def lay_out(
    track: Track, devices: Sequence[Device], orientations: Sequence[Orientation], lead: float = 0.5
) -> TooledTrack:
    """Return the stretch of track that holds a chain of devices, in the order parts meet them.

    Where the bank changes, the free edge rises or falls by at most ``MAX_EDGE_SLOPE_RAD``. Where a part drops
    beside a ledge, a ramp of ``RAMP`` leads down from that. Both make the stretch longer.

    Parameters
    ----------
    track : Track
        As the bowl has it.
    devices : sequence of Device
        Measured yields need no place.
    orientations : sequence of Orientation
        Of the part.
    lead : float [1]
        Rooms, of a device each, before the first one.

    Returns
    -------
    TooledTrack

    Raises
    ------
    ConfigError
        A device names an orientation that the part does not have.
    """
    chain = [device for device in devices if device.action.has_place]
    room, entry = room_of(orientations), len(leading_devices(chain))
    track = track_at_entry(track, chain, orientations)
    drawn, own = _drawn_width(track, chain, orientations)
    placed: list[PlacedDevice] = []
    climbs: list[tuple[float, float]] = []
    banks: list[tuple[float, float, float]] = []
    drops: list[tuple[float, float]] = []
    ledges: list[Ledge] = []
    grooves: list[GrooveStretch] = []
    start, level, bank = lead * room, 0.0, track.bank
    longest = max(orientation.length for orientation in orientations)
    for number, (device, features) in enumerate(zip(chain, own)):
        length, begin, more = features.takes or room, start + features.before, 0.0
        openings = tuple(opening.shifted(begin) for opening in features.openings)
        item = PlacedDevice(device, start, length, begin, level, features, openings, track.radius)
        placed.append(item)
        for slope in features.slopes:
            # the wall leans back from there on, at the entry from the first of the track
            at = -np.inf if number < entry else begin + slope.begin
            if slope.climb is not None:
                climbs.append((begin + slope.begin, slope.climb))
            if slope.wall is not None and grooves and np.isinf(grooves[-1].end):
                grooves[-1] = replace(grooves[-1], end=at)
            if slope.wall:
                grooves.append(GrooveStretch(at, np.inf, slope.wall, longest))
            if number >= entry and slope.bank is not None and slope.bank != bank:
                # the free edge of the track rises or falls gently from one bank to the other
                edge = track.width * abs(np.sin(slope.bank) - np.sin(bank))
                twist = max(TWIST * room, edge / np.tan(MAX_EDGE_SLOPE_RAD))
                banks.append((at, at + float(twist), slope.bank))
                bank, more = slope.bank, more + max(banks[-1][1] - item.end, 0.0)
        if features.drop is not None and features.drop.height > 0.0:
            drop = features.drop
            drops.append((begin, drop.height))
            level -= drop.height
            if drop.aside > 0.0:
                ramp = float(drop.height / np.tan(RAMP))
                ends = begin, begin + drop.length
                ledges.append(Ledge(item.label, *ends, float(drop.aside), float(drop.height), ramp))
                more += ramp
        start += length + more + BETWEEN * room
    slots = continue_slots([item.openings for item in placed], start, SLOT_OVERLAP_M)
    return TooledTrack(
        track=track,
        length=start,
        width=drawn,
        tallest=max(orientation.height for orientation in orientations),
        longest=longest,
        devices=tuple(replace(item, openings=own) for item, own in zip(placed, slots)),
        climbs=tuple(climbs),
        banks=tuple(banks),
        drops=tuple(drops),
        ledges=tuple(ledges),
        grooves=tuple(groove for groove in grooves if groove.end > groove.start),
    )


def _drawn_width(
    track: Track, devices: Sequence[Device], orientations: Sequence[Orientation]
) -> tuple[float, list[Features]]:
    """Return the width [m] of a track that is drawn, and the features on it: of a very wide one not all."""
    own = [device.features(track, orientations) for device in devices]
    if track.width <= track.extent:
        return track.width, own
    needed = [orientation.width for orientation in orientations]
    for features in own:
        ends = np.concatenate([[0.0], *(opening.ring[:, 1] for opening in features.openings)])
        needed.append(float(ends[ends < track.extent].max()))
        needed.append(0.0 if features.drop is None else features.drop.aside)
    width = min(max(needed) + DRAWN_TRACK_MARGIN_M, track.extent)
    return width, [device.features(replace(track, width=width), orientations) for device in devices]


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


def bend_ring(ring: Points, radius: float, shift: float = 0.0, chord: float = DRAWN_CHORD_M) -> Points:
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
    chord : float [m], optional
        By which an arc may be seen too flat.

    Returns
    -------
    (N, 2) float [m]
    """
    border = shapely.linestrings(np.vstack([ring, ring[:1]]))
    fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(8.0 * radius * chord)))[:-1]
    theta, r = fine[:, 0] / radius + shift, radius - fine[:, 1]
    return np.column_stack([r * np.sin(theta), radius - r * np.cos(theta)])


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


def walls_of(tooled: TooledTrack) -> list[tuple[float, float, float]]:
    """Return stretches of the wall as the track's own plane has it.

    It leans back by a groove's lean from upright, less the bank of the track: beside a banked track an
    upright wall stands over it.

    Parameters
    ----------
    tooled : TooledTrack

    Returns
    -------
    list of (float [m], float [m], float [rad])
        From, to and lean.
    """
    length = tooled.length
    changes = {0.0, length}
    for groove in tooled.grooves:
        changes |= {at for at in (groove.start, groove.end) if 0.0 < at < length}
    changes |= {at for at, _, _ in tooled.banks if at < length}
    walls = []
    for begin, end in itertools.pairwise(sorted(changes)):
        middle = 0.5 * (begin + end)
        wall = sum(groove.lean for groove in tooled.grooves if groove.start < middle < groove.end)
        bank = [tooled.track.bank, *(bank for at, _, bank in tooled.banks if at < middle)][-1]
        walls.append((begin, end, float(wall - bank)))
    return walls
