"""How far apart parts have to come for devices that look at one part at a time."""

from collections.abc import Sequence

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.rates import stretches
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import Orientation, travel_speed


def needed(chain: Sequence[Device], lying: Sequence[Orientation], bowl: Bowl) -> float:
    """Return the free way [m] between parts at the track's entry that the devices need.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    chain : sequence of Device
    lying : sequence of Orientation
        Of the part.
    bowl : Bowl

    Returns
    -------
    float [m]
        0 where they need none. Behind a stretch on which parts travel r times as fast, their pitch is r times
        as large.
    """
    here, gap = lying[0], 0.0
    first = travel_speed(stretches.queueing(bowl, lying))
    shortest = min(one.length for one in lying)
    for device in chain:
        here = device.onward(here)
        now = travel_speed(stretches.on_stretch(bowl, here))
        free = max(device.gap(one, now) for one in lying)
        if free > 0.0:
            ratio = now / first if first > 0.0 else np.inf
            gap = max(gap, (free + shortest) / ratio - shortest if ratio > 0.0 else np.inf)
    return float(gap)
