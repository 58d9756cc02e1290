"""Each device along the track as the trial takes it."""

from typing import Any

from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.fates import leading
from feederscrew.trial import staging

BARE_TRACK = Device("")


def station(device, track, orientations, start=0.0, slopes=(), slot=()):
    """Return one device with enough track before and behind it, a Stage.

    Parameters
    ----------
    device : Device
        A measured yield is bare track.
    track : Track
    orientations : sequence of Orientation
        Of the part, the longest of which sets how long a device is that goes on along the track.
    start : float [m]
        Where the cut begins.
    slopes : sequence of Slope
        Of the devices before it, which go on.
    slot : (float [m], float [m]) or ()
        Between the rails before it, in which parts hang from there on.
    """
    return staging.stage(
        device, device.standing(track, orientations), track, orientations, start, slopes, slot
    )


def at_entry(devices, track, orientations) -> tuple[Any, ...]:
    """Return the slopes of the devices that come first and lean the track: they begin at its entry."""
    return tuple(
        slope for device in leading(devices) for slope in device.standing(track, orientations).slopes
    )


def plain(track, orientations, length, slopes=()):
    """Return a stretch of the bare track, from 0 to ``length`` [m], a Stage; slopes as for ``station``."""
    return staging.plain(BARE_TRACK, track, orientations, length, slopes)
