"""A stretch of track with a chain of devices on it, one after the other, as it is drawn and made."""

import itertools
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from feederscrew.bowl.record import Track
from feederscrew.tooling.devices.base import Device, room_of
from feederscrew.tooling.devices.pieces import BLADE, FRAME, Standing
from feederscrew.tooling.fates import leading

BESIDE = 5e-3  # [m] of track beyond what parts and cuts need, where the whole track is not drawn
CHORD = 1e-5  # [m] by which an arc may be seen too flat


@dataclass(frozen=True, eq=False)
class Station:
    """One device at its place along the track."""

    device: Device
    start: float  # [m] along the wall
    length: float  # [m]
    hole: np.ndarray | None  # (K, 2) [m] what is cut away, unrolled: length along the wall, distance from it
    blade: np.ndarray | None  # (4, 2) [m] where a gate stands, unrolled
    openings: tuple[np.ndarray, ...]  # (K, 2) [m] of a gate: distance from the wall, height
    top: float  # [m] height of a gate
    drop: float = 0.0  # [m] by which the track goes on lower, from the middle of its length
    edge: np.ndarray | None = None  # (4, 2) [m] where parts turn over, unrolled: a step's or a ledge's edge
    wall: float | None = (
        None  # [rad] by which the wall leans back over the track from there on; None: as before
    )
    standing: Standing = field(default_factory=Standing)  # nozzles, a sensor, slopes, from its start on

    @property
    def label(self):
        """'gap 9 mm': kind and value, the latter where it is one number."""
        return self.device.label


@dataclass(frozen=True, eq=False)
class TrackSection:
    """The stretch of track, unrolled: X ahead along the wall, Y from the wall."""

    track: Track
    length: float  # [m] along the wall
    width: float  # [m] of it that is drawn
    tallest: float  # [m] of all orientations
    stations: tuple[Station, ...]

    @property
    def walls(self):
        """Stretches of the wall, (from, to, lean) [m, m, rad]; a groove listed first begins at the entry."""
        first = leading([station.device for station in self.stations])
        turns = [
            (0.0 if place < len(first) else station.start, station.wall)
            for place, station in enumerate(self.stations)
            if station.wall is not None
        ]
        ends = [(0.0, 0.0), *turns, (self.length, 0.0)]
        return [(begin, end, lean) for (begin, lean), (end, _) in itertools.pairwise(ends) if end > begin]

    def bent(self, ring):
        """Return a ring (K, 2) [m] unrolled as it lies in the bowl, its corners joined by short chords.

        The wall is tangent to the X axis at the origin and the bowl's axis is at (0, radius).
        """
        return bent(ring, self.track.radius)

    def laid(self, outline, place):
        """Return an outline (K, 2) [m] from the wall as it lies in the bowl at a length along it."""
        c, s = np.cos(place / self.track.radius), np.sin(place / self.track.radius)
        x, up = outline[:, 0], self.track.radius - outline[:, 1]
        return np.column_stack([c * x + s * up, self.track.radius + s * x - c * up])


def strip(track, devices, every, lead=0.5):
    """Return the stretch of track that holds a chain of devices.

    Parameters
    ----------
    track : Track
    devices : sequence of Device
        In the order parts meet them; measured yields need no place.
    every : sequence of Orientation
        Of the part.
    lead : float [1]
        Rooms, of a device each, before the first one.

    Returns
    -------
    TrackSection
    """
    made = [device for device in devices if device.placed]
    room = room_of(every)
    tallest = max(one.height for one in every)
    bare = TrackSection(track, 0.0, _width(track, made, every), tallest, ())
    stations, start = [], lead * room
    for device in made:
        length = room + device.goes_on(bare.width)
        stations.append(_station(device, start, length, bare, every))
        start += length + 0.5 * room
    return replace(bare, length=start, stations=tuple(stations))


def bent(ring, radius, shift=0.0, chord=CHORD):
    """Return a ring (K, 2) [m] of lengths along the wall and distances from it as it lies in the bowl.

    Parameters
    ----------
    ring : (K, 2) float [m]
    radius : float [m]
        Of the wall.
    shift : float [rad]
        By which it is turned ahead.
    chord : float [m]
        By which an arc may be seen too flat.

    Returns
    -------
    (N, 2) float [m]
        From the point where the wall is tangent to X, the bowl's axis at (0, radius).
    """
    border = shapely.linestrings(np.vstack([ring, ring[:1]]))
    fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(8.0 * radius * chord)))[:-1]
    theta, r = fine[:, 0] / radius + shift, radius - fine[:, 1]
    return np.column_stack([r * np.sin(theta), radius - r * np.cos(theta)])


def _width(track, devices, every):
    """The track's own width, or as much of a very wide one as parts and cuts need."""
    if track.width <= track.extent:
        return track.width
    needed = [one.width for one in every] + [device.across for device in devices]
    return min(max(needed) + BESIDE, track.extent)


def _station(device, start, length, section, every):
    """A device at its start; a gate stands in the middle of its length."""
    cut = device.outline_on(replace(section.track, width=section.width), length)
    gate = device.opening(every, section.width)
    lower = device.lower(every)
    middle, blade = start + 0.5 * length, None
    if gate is not None:
        middle -= 0.5 * device.goes_on(section.width)
        blade = device.footprint(middle, section.width, BLADE)
    return Station(
        device=device,
        start=start,
        length=length,
        hole=None if cut is None else np.add(cut, [start, 0.0]),
        blade=blade,
        openings=() if gate is None else _rings(gate),
        top=0.0 if gate is None else max(section.tallest, gate.bounds[3]) + FRAME,
        drop=lower[0] if lower is not None and lower[1] <= 0.0 else 0.0,
        edge=device.edge(start, length, section.width),
        wall=_wall(device, section.track, every),
        standing=device.standing(section.track, every),
    )


def _wall(device, track, every):
    """By how much [rad] the wall leans back from square to the track from a device on; None: as before."""
    slopes = [one for one in device.standing(track, every).slopes if one.wall is not None]
    return (slopes[-1].wall - slopes[-1].bank if slopes[-1].wall else 0.0) if slopes else None


def _rings(area):
    """The outer borders of an area, without the last corner that repeats the first."""
    parts = [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]
    return tuple(np.asarray(part.exterior.coords)[:-1] for part in parts)
