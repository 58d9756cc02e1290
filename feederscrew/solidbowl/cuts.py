"""What devices take from the track and set on it, unrolled, and how the track leans and drops."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely import affinity

from feederscrew.arrays import Points
from feederscrew.bowl.record import Track
from feederscrew.tooling.devices.base import Device, room_of
from feederscrew.tooling.devices.openings import beyond_borders
from feederscrew.tooling.fates import leading_devices
from feederscrew.tooling.orientations import Orientation
from feederscrew.tooling.track_sections import Station, build_section

MAX_EDGE_SLOPE_RAD = np.radians(10.0)  # slope along the track of its free edge, where the bank changes
RAMP = np.radians(15.0)  # slope on which a ledge comes down to the track beside it
TWIST = 0.5  # of the room that a part has to itself: over so much the bank changes at least


@dataclass(frozen=True)
class TrackLedge:
    """A ledge along the wall, above the track that goes on lower; s from where the stretch begins."""

    label: str  # 'tip 6 mm'
    start: float  # [m] s where the track beside it goes on lower
    end: float  # [m] s where it begins to come down
    width: float  # [m]
    drop: float  # [m] of the track beside it
    ramp: float  # [m] over which it comes down


def banked_height(track: Track, devices: Sequence[Device], orientations: Sequence[Orientation]) -> Track:
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
    for device in lean_at_entry(devices):
        for slope in device.standing(track, orientations).slopes:
            track = track if slope.bank is None else replace(track, bank=slope.bank)
    return track


def lean_at_entry(devices: Sequence[Device]) -> tuple[Device, ...]:
    """Return those devices that stand at the track's entry: before what does more than lean it."""
    return leading_devices([device for device in devices if device.placed])


def laid_out(
    track: Track, stations: Sequence[Station], orientations: Sequence[Orientation]
) -> tuple[list[Station], tuple, tuple[TrackLedge, ...], tuple, float]:
    """Return stations along a solid's track, with room for what leans and drops it.

    Where the bank changes, the free edge rises or falls by at most ``MAX_EDGE_SLOPE_RAD``. Where a part drops
    beside a cut, a ramp leads back to the track. Both make the stretch longer, and all stations after them
    move on.

    Parameters
    ----------
    track : Track
        With the bank of its entry.
    stations : sequence of Station
        As drawn, without that room.
    orientations : sequence of Orientation
        Of the part on the track.

    Returns
    -------
    list of Station
    tuple of (float [m], float [m], float [rad])
        Leans: from and to where the track twists, and the bank after it.
    tuple of TrackLedge
    tuple of (float [m], float [m], float [rad], float [m])
        Grooves: from and to where, the lean of the wall, and over which length it opens. Empty grooves are
        left out.
    float [m]
        By how much the stretch is longer.
    """
    entry = len(lean_at_entry([station.device for station in stations]))
    moved: list[Station] = []
    leans: list[tuple[float, float, float]] = []
    ledges: list[TrackLedge] = []
    grooves: list[tuple[float, ...]] = []
    opens = max(orientation.length for orientation in orientations)
    more, bank = 0.0, track.bank
    for place, station in enumerate(stations):
        shift = np.array([more, 0.0])
        rings = {name: getattr(station, name) for name in ("hole", "blade")}
        further = {name: ring + shift for name, ring in rings.items() if ring is not None}
        station = replace(station, start=station.start + more, **further)
        moved.append(station)
        end = station.start + station.length
        for slope in station.device.standing(track, orientations).slopes:
            # the wall leans back from there on, at the entry from the first of the track
            at = -np.inf if place < entry else station.start + slope.begin
            if slope.wall is not None and grooves and np.isinf(grooves[-1][1]):
                grooves[-1] = grooves[-1][0], at, *grooves[-1][2:]
            if slope.wall:
                grooves.append((at, np.inf, slope.wall, opens))
            if place >= entry and slope.bank is not None and slope.bank != bank:
                # the free edge of the track rises or falls gently from one bank to the other
                edge = track.width * abs(np.sin(slope.bank) - np.sin(bank))
                twist = max(TWIST * room_of(orientations), edge / np.tan(MAX_EDGE_SLOPE_RAD))
                leans.append((at, at + float(twist), slope.bank))
                bank, more = slope.bank, more + max(leans[-1][1] - end, 0.0)
        drop, aside = station.device.lower(orientations)
        if aside > 0.0:
            ramp = float(drop / np.tan(RAMP))
            ledges.append(TrackLedge(station.label, station.start, end, float(aside), float(drop), ramp))
            more += ramp
    real_grooves = tuple(groove for groove in grooves if groove[1] > groove[0])
    return moved, tuple(leans), tuple(ledges), real_grooves, more


CUT_OVERRUN_M = 2e-3  # [m] by which what reaches an edge of the track is cut over it


@dataclass(frozen=True, eq=False)
class TrackHole:
    """A hole in the track; s along the wall from where the stretch begins."""

    label: str  # 'gap 9 mm'
    ring: Points  # (K, 2) [m] s and distance from the wall
    hangs: bool  # parts hang in it from there on: it goes on to the end of the track

    @property
    def span(self) -> tuple[float, float]:
        """From and to [m] along the wall."""
        return float(self.ring[:, 0].min()), float(self.ring[:, 0].max())


@dataclass(frozen=True, eq=False)
class TrackBlade:
    """A plate across the track."""

    label: str  # 'wiper 8 mm'
    start: float  # [m] s
    thickness: float  # [m] along the wall
    lean: float  # [1] ahead over inwards: a swept blade
    area: shapely.Geometry  # [m] distance from the wall, height over the track
    alone: bool  # a gate that is a part of its own, and stands in a notch of the wall


@dataclass(frozen=True)
class WallBore:
    """A hole through the wall, square to it: a nozzle blows from there."""

    place: float  # [m] s of its middle
    height: float  # [m] of its middle over the track by the wall
    size: float  # [m] diameter


@dataclass(frozen=True, eq=False)
class Stretch:
    """The tooled stretch of the track."""

    length: float  # [m] along the wall
    tallest: float  # [m] of all orientations
    longest: float  # [m] of all orientations, along the track
    cuts: tuple[TrackHole, ...]
    blades: tuple[TrackBlade, ...]
    drops: tuple[tuple[float, float], ...]  # s and height [m] of each step down
    bends: tuple[tuple[float, float], ...]  # s [m] from which the track climbs otherwise, and how [rad]
    bores: tuple[WallBore, ...] = ()
    leans: tuple[tuple[float, float, float], ...] = ()  # from and to s [m] it twists to another bank [rad]
    ledges: tuple[TrackLedge, ...] = ()
    grooves: tuple[tuple[float, float, float, float], ...] = ()  # from, to s [m], lean of the wall, opens
    stations: tuple[Station, ...] = ()  # of the devices, in the order parts meet them

    @property
    def falls(self) -> float | None:
        """Where the last part that a cut returns goes down [m]; None without cuts."""
        return max((cut.span[1] for cut in self.cuts), default=None)


def stretch(track: Track, devices: Sequence[Device], orientations: Sequence[Orientation]) -> Stretch:
    """Return the tooled stretch of a track: cuts, plates, bores, steps, leans and grooves.

    Cuts are carried a little over the edge that they reach, and into the wall: faces that meet in one plane
    cut badly.

    Parameters
    ----------
    track : Track
    devices : sequence of Device
        In the order parts meet them.
    orientations : sequence of Orientation
        Of the part on the track.

    Returns
    -------
    Stretch
        Lengths [m] from its own begin.
    """
    section = build_section(track, devices, orientations)
    stations, leans, ledges, grooves, more = laid_out(track, section.stations, orientations)
    standing = [station.device.standing(track, orientations) for station in stations]
    steps = [(s.start + 0.5 * s.length, s.drop) for s in stations if s.drop > 0.0]
    aside, cuts, blades = {ledge.start for ledge in ledges}, [], []
    for station in stations:
        if station.hole is not None and station.start not in aside:
            # carried a little over the edge of the track that it reaches, and into the wall
            s, y = station.hole.T
            corners, drawn = np.column_stack([s, np.where(y <= 1e-9, 0.0, y)]), section.width
            over = max(track.width - drawn, 0.0) + CUT_OVERRUN_M
            ring = np.array(beyond_borders(corners.tolist(), drawn - 1e-9, over))
            cuts.append(TrackHole(station.label, ring, station.device.hangs))
        if station.blade is not None:
            # the plate of a gate without its opening; it reaches into the wall
            free = shapely.union_all([shapely.Polygon(ring) for ring in station.openings])
            paths = ((0.0, 0.0), (-2.0 * CUT_OVERRUN_M, 0.0), (0.0, -2.0 * CUT_OVERRUN_M))
            free = shapely.union_all([affinity.translate(free, *by) for by in paths])
            frame = shapely.box(-CUT_OVERRUN_M, 0.0, track.width, station.top)
            place, ahead, far = map(float, station.blade[[0, 1, 3], 0])
            area, lean = frame.difference(free), (far - place) / track.width
            alone = not station.device.overhead
            blades.append(TrackBlade(station.label, place, ahead - place, lean, area, alone))
    return Stretch(
        length=section.length + more,
        tallest=section.tallest,
        longest=max(orientation.length for orientation in orientations),
        cuts=tuple(cuts),
        blades=tuple(blades),
        drops=tuple(sorted([*steps, *((ledge.start, ledge.drop) for ledge in ledges)])),
        bends=tuple(
            (station.start + slope.begin, slope.climb)
            for station, own in zip(stations, standing)
            for slope in own.slopes
            if slope.climb is not None
        ),
        bores=tuple(
            WallBore(station.start + jet.at[0], jet.at[2], 2.0 * jet.radius)
            for station, own in zip(stations, standing)
            for jet in own.jets
        ),
        leans=leans,
        ledges=ledges,
        grooves=grooves,
        stations=tuple(stations),
    )
