"""Where the bolts and the drain holes of a bowl have room in its floor."""

import numpy as np

from feederscrew.errors import FeederError

BOLT_CLEARANCE_M = 1e-3  # [m] of level floor beside the track
WEB = 0.5  # of a hole's diameter: metal between two of them, at least


def circle(track, asked, radius):
    """Return the diameter [m] of the circle of bolts: as given, or by the rule as far as there is room.

    Parameters
    ----------
    track : Track
    asked : Asked
    radius : float [m]
        Of the floor, out to the wall.
    """
    most = 2.0 * (_room(track, radius) - 2.0 * asked.bolt)
    ruled = asked.bolt_share * 2.0 * track.radius
    return asked.bolt_circle or (min(ruled, most) if most > 0.0 else ruled)


def _room(track, radius):
    """Radius within which nothing of the track lies."""
    return radius - track.width - 2.0 * BOLT_CLEARANCE_M


def hub(track, asked, radius):
    """Return the radius [m] of the hub below the floor."""
    return 0.5 * circle(track, asked, radius) + 2.0 * asked.bolt


def check(track, asked, extents, radius):
    """Raise the fault of holes that the floor has no room for.

    Parameters
    ----------
    track : Track
    asked : Asked
    extents : (3,) float [m]
        Of the part along its axes.
    radius : float [m]
        Of the floor, out to the wall.

    Raises
    ------
    FeederError
        If the bolts lie under the track or run into each other, or parts fall through a drain hole.
    """
    room, across = _room(track, radius), circle(track, asked, radius)
    if hub(track, asked, radius) > room + 1e-9:
        what = f"{1e3 * across:.4g} mm lies under the track of a bowl this small"
        most = 2e3 * (room - 2.0 * asked.bolt)
        mend = f"give at most {most:.4g} mm, or smaller bolts"
        if most <= 0.0:
            mend = "give a smaller machine.bolt_hole, or a larger bowl"
        raise FeederError("machine.bolt_circle", what, mend)
    if _apart(asked.bolts, 0.5 * across) < (1.0 + WEB) * asked.bolt - 1e-9:
        what = f"{asked.bolts} and one in the middle, of {1e3 * asked.bolt:.4g} mm,"
        what += f" leave no metal between them on a circle of {1e3 * across:.4g} mm"
        raise FeederError("machine.bolts", what, "take fewer, a smaller machine.bolt_hole, or a larger bowl")
    least = float(min(extents))
    if asked.drains and asked.drain >= least:
        what = f"{1e3 * asked.drain:.4g} mm may let parts through that are {1e3 * least:.4g} mm thick"
        raise FeederError("sizing.drain_hole", what, f"give less than {1e3 * least:.4g} mm")


def _apart(bolts, radius):
    """Least distance [m] between the middles of two holes, one of them that in the middle."""
    if bolts == 0:
        return np.inf
    return radius * min(1.0, 2.0 * np.sin(np.pi / bolts) if bolts > 1 else 1.0)
