"""What each kind of device has standing along the track."""

import numpy as np
import shapely

from feederscrew.bowl.devices import KINDS, Device
from feederscrew.tooling import turning
from feederscrew.tooling.strip import FRAME, hole, opening
from feederscrew.trial import staging
from feederscrew.trial.geometry import Blade, Hole, Standing

ROOM = 1.3  # of the greatest length: a device that goes on along the track has so much
SETTLES = 2.0  # of the part's size: how far behind a turning device parts end
BARE = Device("track", "")


def station(device, track, every, start=0.0):
    """Return one device with enough track before and behind it, a Stage.

    Parameters
    ----------
    device : Device
        A measured yield is bare track.
    track : Track
    every : sequence of Orientation
        Of the part, the longest of which sets how long a device is that goes on along the track.
    start : float [m]
        Where the cut begins.
    """
    return staging.stage(device, standing(device, track, every), track, every, start)


def plain(track, every, length):
    """Return a stretch of the bare track, from 0 to ``length`` [m], a Stage."""
    return staging.plain(BARE, track, every, length)


def standing(device, track, every):
    """Return what a device has standing along the track, a Standing; parameters as of ``station``."""
    room, width = ROOM * max(one.length for one in every), staging.width_of(track)
    if device.kind == "yield":
        return Standing(room)
    if KINDS[device.kind].turns:
        return _turning(device, every, width)
    gate = opening(device, every, width)
    if gate is not None:
        return Standing(0.5 * room, blades=(_gate(gate, width, every, 0.5 * room),))
    cut = hole(device, track.radius, room, width)
    if cut is None:
        return Standing(room)
    if device.kind != "rails":
        return Standing(float(cut[:, 0].max()), holes=(Hole(cut),))
    # those that hang are led on, they do not come back onto the track
    longer = hole(device, track.radius, room + 2.0 * staging.size_of(every), width)
    return Standing(room, holes=(Hole(longer),), hangs=True)


def _turning(device, every, width):
    """A step, or a ledge over a second track that lies half the part's greatest length lower."""
    step = device.kind == "step"
    drop, aside = (device.limit, 0.0) if step else (turning.below_ledge(every), device.limit)
    far = 10.0 * staging.size_of(every)
    cut = Hole(np.array([[0.0, aside], [far, aside], [far, width], [0.0, width]]))
    return Standing(holes=(cut,), drop=drop, aside=aside, settles=SETTLES)


def _gate(gate, width, every, place):
    """A gate across the track as wide as that."""
    tall = 2.0 * max(max(one.height for one in every), gate.bounds[3]) + FRAME
    return Blade(shapely.box(0.0, 0.0, width, tall).difference(gate), foot=(place, 0.0))
