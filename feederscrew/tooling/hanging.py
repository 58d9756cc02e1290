"""Headed parts: a slot between rails lets the shank down and holds the head."""

import numpy as np

from feederscrew.geometry.polygons import cross, sides, turned

SLICES = 80  # along the part
STEEP = np.radians(45.0)  # a part that stands or lies across the track does not go down by its shank


def neck(one):
    """Return the widths of a part's shank and head, as it lies.

    Parameters
    ----------
    one : Orientation

    Returns
    -------
    (float, float) [m] or None
        Greatest width of the stretch that holds the foot of the centre of mass and reaches to one end, and of
        the head at the other end, both across the part's own long axis; None where no end is wider than the
        rest of the part, or that axis does not lie along the track.
    """
    turn = _long_axis(one.outline)
    tilt = _tilt(one.posture.inertia, one.heading - turn)
    if abs(tilt) > STEEP or abs(np.sin(turn)) > np.sin(STEEP):
        return None
    places, widths = _widths(one, turn, tilt)
    found = []
    for along, across in ((places, widths), (-places[::-1], widths[::-1])):
        for k in range(1, len(across)):
            if along[k] > 0.0:  # the head must end before the centre of mass
                break
            head, shank = across[:k].max(), across[k:].max()
            found.append((head - shank, shank, head))
    step, shank, head = max(found, default=(0.0, 0.0, 0.0))
    return (float(shank), float(head)) if step > 0.0 else None


def hanging_margin(one, width):
    """Return by how much [m] a slot of some width lets the shank down and holds the head; negative if not."""
    found = neck(one)
    return -np.inf if found is None else min(width - found[0], found[1] - width)


def _widths(one, turn, tilt):
    """Places along the long axis from the foot (N,) [m], and the part's width there (N,) [m]."""
    points, faces = one.posture.surface, one.posture.solid.faces
    plan = turned(points[:, :2], one.heading - turn)
    along = np.cos(tilt) * plan[:, 0] + np.sin(tilt) * (points[:, 2] - one.posture.height)
    plan = np.column_stack([along, plan[:, 1]])
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    ends = np.unique(ends, axis=0)
    a, b = plan[ends[:, 0]], plan[ends[:, 1]]
    low, high = plan[:, 0].min(), plan[:, 0].max()
    places = low + (np.arange(SLICES) + 0.5) / SLICES * (high - low)
    rise = b[:, 0] - a[:, 0]
    crossed = (a[:, 0] > places[:, None]) != (b[:, 0] > places[:, None])
    share = (places[:, None] - a[:, 0]) / np.where(rise == 0.0, 1.0, rise)
    y = a[:, 1] + share * (b[:, 1] - a[:, 1])
    top, bottom = np.where(crossed, y, -np.inf).max(axis=1), np.where(crossed, y, np.inf).min(axis=1)
    return places, np.maximum(top - bottom, 0.0)


def _tilt(inertia, turn):
    """How far the long axis rises [rad], from the inertia in the vertical plane along it."""
    c, s = np.cos(turn), np.sin(turn)
    along = c * c * inertia[0, 0] - 2.0 * c * s * inertia[0, 1] + s * s * inertia[1, 1]
    mixed = c * inertia[0, 2] - s * inertia[1, 2]
    return 0.5 * float(np.arctan2(-2.0 * mixed, inertia[2, 2] - along))


def _long_axis(outline):
    """Direction [rad] across which a convex outline is narrowest."""
    along = sides(outline)
    along = along / np.hypot(*along.T)[:, None]
    extents = [np.ptp(cross(unit, outline)) for unit in along]
    best = along[int(np.argmin(extents))]
    return float(np.arctan2(best[1], best[0]))
