"""What the devices of a chain take from the track and set on it, unrolled: the door to tooling's strip."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import affinity

from feederscrew.solidbowl import leaning
from feederscrew.solidbowl.leaning import TrackLedge
from feederscrew.tooling.devices.hole_shapes import beyond_borders
from feederscrew.tooling.strip import Station, strip

BEYOND = 2e-3  # [m] by which what reaches an edge of the track is cut over it


@dataclass(frozen=True, eq=False)
class TrackHole:
    """A hole in the track; s along the wall from where the stretch begins."""

    label: str  # 'gap 9 mm'
    kind: str
    ring: np.ndarray  # (K, 2) [m] s and distance from the wall
    hangs: bool  # parts hang in it from there on: it goes on to the end of the track

    @property
    def span(self):
        """From and to [m] along the wall."""
        return float(self.ring[:, 0].min()), float(self.ring[:, 0].max())


@dataclass(frozen=True, eq=False)
class TrackBlade:
    """A plate across the track."""

    label: str
    kind: str
    start: float  # [m] s
    thickness: float  # [m] along the wall
    lean: float  # [1] ahead over inwards: a swept blade
    area: object  # shapely geometry [m]: distance from the wall, height over the track
    alone: bool  # a gate that is a part of its own, and stands in a notch of the wall


@dataclass(frozen=True)
class WallBore:
    """A hole through the wall, square to it: a nozzle blows from there."""

    label: str
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
    labels: tuple[tuple[float, float, str], ...]  # from, to [m] and label of each device
    bores: tuple[WallBore, ...] = ()
    leans: tuple[tuple[float, float, float], ...] = ()  # from and to s [m] it twists to another bank [rad]
    ledges: tuple[TrackLedge, ...] = ()
    grooves: tuple[
        tuple[float, float, float, float], ...
    ] = ()  # from and to s [m], lean of the wall, opens [m]
    stations: tuple[Station, ...] = ()  # of the devices, in the order parts meet them

    @property
    def falls(self):
        """Where the last part that a cut returns goes down [m]; None without cuts."""
        return max((cut.span[1] for cut in self.cuts), default=None)


def stretch(track, devices, every):
    """Return the tooled stretch of a track.

    Parameters
    ----------
    track : Track
    devices : sequence of Device
    every : sequence of Orientation
        Of the part on that track.

    Returns
    -------
    Stretch
    """
    section = strip(track, devices, every)
    stations, leans, ledges, grooves, more = leaning.laid_out(track, section.stations, every)
    beside = {ledge.start for ledge in ledges}
    cut = [one for one in stations if one.hole is not None and one.start not in beside]
    drops = [(one.start + 0.5 * one.length, one.drop) for one in stations if one.drop > 0.0]
    drops += [(ledge.start, ledge.drop) for ledge in ledges]
    return Stretch(
        length=section.length + more,
        tallest=section.tallest,
        longest=max(one.length for one in every),
        cuts=tuple(_cut(one, section.width, track.width) for one in cut),
        blades=tuple(_blade(one, track.width) for one in stations if one.blade is not None),
        drops=tuple(sorted(drops)),
        bends=tuple(
            (one.start + slope.begin, slope.climb)
            for one in stations
            for slope in one.device.standing(track, every).slopes
            if slope.climb is not None
        ),
        labels=tuple((one.start, one.start + one.length, one.label) for one in stations),
        bores=tuple(
            WallBore(one.label, one.start + jet.at[0], jet.at[2], 2.0 * jet.radius)
            for one in stations
            for jet in one.device.standing(track, every).jets
        ),
        leans=leans,
        ledges=ledges,
        grooves=grooves,
        stations=tuple(stations),
    )


def _cut(station, drawn, width):
    """A hole, carried a little over the edge of the track that it reaches, and into the wall."""
    s, y = station.hole.T
    corners = np.column_stack([s, np.where(y <= 1e-9, 0.0, y)])
    ring = beyond_borders(corners.tolist(), drawn - 1e-9, max(width - drawn, 0.0) + BEYOND)
    return TrackHole(station.label, station.device.kind, np.array(ring), station.device.hangs)


def _blade(station, width):
    """The plate of a gate without its opening; it reaches into the wall."""
    free = shapely.union_all([shapely.Polygon(ring) for ring in station.openings])
    ways = ((0.0, 0.0), (-2.0 * BEYOND, 0.0), (0.0, -2.0 * BEYOND))
    free = shapely.union_all([affinity.translate(free, *by) for by in ways])
    frame = shapely.box(-BEYOND, 0.0, width, station.top)
    return TrackBlade(
        label=station.label,
        kind=station.device.kind,
        start=float(station.blade[0, 0]),
        thickness=float(station.blade[1, 0] - station.blade[0, 0]),
        lean=float(station.blade[3, 0] - station.blade[0, 0]) / width,
        area=frame.difference(free),
        alone=not station.device.overhead,
    )
