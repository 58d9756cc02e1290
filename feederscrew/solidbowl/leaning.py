"""How the track of a solid leans and drops along its devices, and how much longer it is for that."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.tooling.devices.base import room_of
from feederscrew.tooling.fates import leading

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


def banked(track, devices, every):
    """Return the track with the bank that the first devices give it from its entry on.

    Parameters
    ----------
    track : Track
    devices : sequence of Device
    every : sequence of Orientation
        Of the part on that track.

    Returns
    -------
    Track
    """
    for device in at_entry(devices):
        for slope in device.standing(track, every).slopes:
            track = track if slope.bank is None else replace(track, bank=slope.bank)
    return track


def at_entry(devices):
    """Return those devices that stand at the track's entry: before what does more than lean it."""
    return leading([device for device in devices if device.placed])


def laid_out(track, stations, every):
    """Return stations along a solid's track, with room for what leans and drops it.

    Parameters
    ----------
    track : Track
        With the bank of its entry.
    stations : sequence of Station
    every : sequence of Orientation

    Returns
    -------
    stations : list of Station
    leans : tuple of (float [m], float [m], float [rad])
        From and to which length the track twists to which bank.
    ledges : tuple of TrackLedge
    grooves : tuple of (float [m], float [m], float [rad], float [m])
        From and to which length the wall leans back, by how much, and over how long it opens.
    more : float [m]
        By which the stretch is longer.
    """
    entry = len(at_entry([one.device for one in stations]))
    moved, leans, ledges, more, bank = [], [], [], 0.0, track.bank
    for place, one in enumerate(stations):
        one = _moved(one, more)
        moved.append(one)
        end = one.start + one.length
        for slope in one.device.standing(track, every).slopes if place >= entry else ():
            if slope.bank is not None and slope.bank != bank:
                begin = one.start + slope.begin
                leans.append((begin, begin + _twist(track, bank, slope.bank, every), slope.bank))
                bank, more = slope.bank, more + max(leans[-1][1] - end, 0.0)
        ledge = _ledge(one, every)
        if ledge is not None:
            ledges.append(ledge)
            more += ledge.ramp
    return moved, tuple(leans), tuple(ledges), _grooves(moved, entry, track, every), more


def _grooves(stations, entry, track, every):
    """Where the wall leans back; a groove at the entry is there from the first of the track on."""
    found: list[tuple[float, ...]] = []
    opens = max(one.length for one in every)
    for place, one in enumerate(stations):
        for slope in one.device.standing(track, every).slopes:
            at = -np.inf if place < entry else one.start + slope.begin
            if slope.wall is not None and found and np.isinf(found[-1][1]):
                found[-1] = found[-1][0], at, *found[-1][2:]
            if slope.wall:
                found.append((at, np.inf, slope.wall, opens))
    return tuple(one for one in found if one[1] > one[0])


def _moved(station, by):
    """A station further on along the track."""
    rings = {
        name: getattr(station, name) + np.array([by, 0.0])
        for name in ("hole", "blade")
        if getattr(station, name) is not None
    }
    return replace(station, start=station.start + by, **rings)


def _twist(track, before, after, every):
    """Length [m] over which one bank becomes another: the free edge rises or falls gently."""
    edge = track.width * abs(np.sin(after) - np.sin(before))
    return float(max(TWIST * room_of(every), edge / np.tan(MAX_EDGE_SLOPE_RAD)))


def _ledge(station, every):
    """The ledge of a station, None without one."""
    drop, aside = station.device.lower(every) or (0.0, 0.0)
    if aside <= 0.0:
        return None
    ramp = float(drop / np.tan(RAMP))
    return TrackLedge(
        station.label, station.start, station.start + station.length, float(aside), float(drop), ramp
    )
