"""Risks that are said before steel is cut: parts that shingle, and parts that climbed in the queue."""

import math

import numpy as np

from feederscrew.geometry.polygons import outline, turned

LOW = 0.01  # of the part's height: corners so little above the lowest lie on the track


def leading_wedge(one):
    """Return the angle [rad] between the track and the side of a part that comes first, above the track.

    Parameters
    ----------
    one : Orientation

    Returns
    -------
    float
        A quarter of a turn and more of one whose front stands upright or leans back.
    """
    points = one.posture.surface
    ahead = turned(points[:, :2], one.heading)[:, 0]
    ring = outline(np.column_stack([ahead, points[:, 2]]))  # counter-clockwise: forward along the track
    low = ring[:, 1] <= ring[:, 1].min() + LOW * one.height  # no corner of a round side is quite down
    first = int(np.argmax(np.where(low, ring[:, 0], -np.inf)))
    run, rise = ring[(first + 1) % len(ring)] - ring[first]
    return math.atan2(rise, run)


def risks(one, friction, queues):
    """Say what may go wrong between parts, a sentence each.

    Parameters
    ----------
    one : Orientation
        That is wanted.
    friction : float [1]
        Of part on part.
    queues : sequence of FilledQueue
        What was seen.
    """
    found, held = [], math.atan(friction)
    wedge = leading_wedge(one)
    if wedge < held:
        found.append(
            f"{one.name} may shingle: its leading side rises from the track by {math.degrees(wedge):.3g} deg "
            f"only, and friction holds up to {math.degrees(held):.3g} deg"
        )
    climbs = sum(seen.climbs for seen in queues)
    if climbs:
        seconds = sum(seen.seconds for seen in queues)
        found.append(f"parts climbed on others {climbs} times in {seconds:.3g} s of queue")
    return tuple(found)
