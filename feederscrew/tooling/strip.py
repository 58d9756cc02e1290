"""A stretch of track with a chain of devices on it, one after the other, as it is drawn and made."""

from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.bowl.devices import Device
from feederscrew.bowl.record import Track
from feederscrew.tooling.design import place
from feederscrew.tooling.verdicts import JUDGES, seen

ROOM = 1.3  # a device has so many lengths of the longest part to itself
BESIDE = 5e-3  # [m] of track beyond what parts and cuts need, where the whole track is not drawn
DRAWN = 0.9  # of the radius: a wider track is not drawn whole
BLADE = 1.5e-3  # [m] thickness of a gate
FRAME = 5e-3  # [m] of a gate above its opening
EDGE = 2e-4  # [m] the width with which an edge over which parts turn is drawn
STEPS = 33  # points along the edge of a gap that is parallel to a radial one
CHORD = 1e-5  # [m] by which an arc may be seen too flat
OVERHEAD = ("wiper", "height_bar", "hold_down")


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

    @property
    def label(self):
        """'gap 9 mm': kind and value, the latter where it is one number."""
        return (
            f"{self.device.kind} {self.device.text}" if np.isfinite(self.device.limit) else self.device.kind
        )


@dataclass(frozen=True, eq=False)
class TrackSection:
    """The stretch of track, unrolled: X ahead along the wall, Y from the wall."""

    track: Track
    length: float  # [m] along the wall
    width: float  # [m] of it that is drawn
    tallest: float  # [m] of all orientations
    stations: tuple[Station, ...]

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
    made = [device for device in devices if device.kind != "yield"]
    room = ROOM * max(one.length for one in every)
    width = _width(track, made, every)
    tallest = max(one.height for one in every)
    stations, start = [], lead * room
    for device in made:
        length = room + max((x for x, _ in device.corners), default=0.0) * (device.kind == "cut_out")
        stations.append(_station(device, start, length, width, tallest, every))
        start += length + 0.5 * room
    return TrackSection(track=track, length=start, width=width, tallest=tallest, stations=tuple(stations))


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


def hole(device, radius, length, width):
    """Return what a device cuts out of the track, unrolled from its own start.

    Parameters
    ----------
    device : Device
    radius : float [m]
        Of the wall.
    length : float [m]
        Of a device that goes on along the track.
    width : float [m]
        Of the track.

    Returns
    -------
    (K, 2) float [m] or None
        None for a device that cuts nothing.
    """
    if device.kind == "cut_out":
        return np.array(device.corners)
    if device.kind == "gap":
        across = np.linspace(width, 0.0, STEPS)
        met = radius * np.arcsin(np.minimum(device.limit / (radius - across), 1.0))
        return np.vstack([[0.0, width], [0.0, 0.0], np.column_stack([met, across])[::-1]])
    between = {"canyon": (0.0, device.limit), "narrowed_track": (device.limit, width)}
    between["pressure_break"] = between["tip"] = between["narrowed_track"]
    low, high = device.span or between.get(device.kind, (0.0, 0.0))
    if not high > low:
        return None
    return np.array([[0.0, low], [length, low], [length, high], [0.0, high]])


def opening(device, every, width):
    """Return the opening of a gate over the track, in distances from the wall and heights [m].

    Parameters
    ----------
    device : Device
    every : sequence of Orientation
        Of the part, which a profile may name.
    width : float [m]
        Of the track.

    Returns
    -------
    shapely geometry or None
        None for a device that is no gate.
    """
    if device.kind in OVERHEAD:
        return shapely.box(0.0, 0.0, width, device.limit)
    if device.kind != "profile":
        return None
    if not device.like:
        return shapely.Polygon(device.corners)
    aspect, heading, play = device.like
    free = seen(every[place(every, aspect, heading, device.where)]).buffer(play)
    return free.intersection(shapely.box(0.0, 0.0, width, 1.0))


def _width(track, devices, every):
    """The track's own width, or as much of a very wide one as parts and cuts need."""
    if track.width < DRAWN * track.radius:
        return track.width
    needed = [one.width for one in every]
    needed += [y for device in devices for _, y in device.corners if JUDGES[device.kind].cut]
    needed += [last for device in devices for last in device.span]
    needed += [device.limit for device in devices if np.isfinite(device.limit)]
    return min(max(needed) + BESIDE, DRAWN * track.radius)


def _station(device, start, length, width, tallest, every):
    """A device at its start; a gate stands in the middle of its length."""
    cut = hole(device, every[0].track.radius, length, width)
    gate = opening(device, every, width)
    middle = start + 0.5 * length
    blade, edge = None, None
    if device.kind == "step":
        edge = np.array([[middle, 0.0], [middle + EDGE, 0.0], [middle + EDGE, width], [middle, width]])
    elif device.kind == "tip":
        low = device.limit
        edge = np.array(
            [[start, low], [start + length, low], [start + length, low + EDGE], [start, low + EDGE]]
        )
    if gate is not None:
        blade = np.array([[0.0, 0.0], [BLADE, 0.0], [BLADE, width], [0.0, width]])
        blade += np.array([middle, 0.0])
    return Station(
        device=device,
        start=start,
        length=length,
        hole=None if cut is None else np.add(cut, [start, 0.0]),
        blade=blade,
        openings=() if gate is None else _rings(gate),
        top=0.0 if gate is None else max(tallest, gate.bounds[3]) + FRAME,
        drop=device.limit if device.kind == "step" else 0.0,
        edge=edge,
    )


def _rings(area):
    """The outer borders of an area, without the last corner that repeats the first."""
    parts = [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]
    return tuple(np.asarray(part.exterior.coords)[:-1] for part in parts)
