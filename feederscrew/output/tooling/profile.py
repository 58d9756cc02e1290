"""An orientation seen along the track, with what of wall and track carries it: upright, or a groove's V."""

import numpy as np
import shapely
from shapely import affinity

from feederscrew.output.tooling import ink
from feederscrew.units import MM

BESIDE = 1.0  # [mm] from the left end of what is drawn


def along(one, top, right):
    """Return what is seen of an orientation [mm], and the line (K, 2) [mm] of wall and track below it.

    Parameters
    ----------
    one : Orientation
    top, right : float [mm]
        How far wall and track are drawn.
    """
    shown = ink.mm(one.view_ahead)
    if not one.groove:
        return shown, np.array([[0.0, top], [0.0, 0.0], [right, 0.0]])
    angle, lean = one.groove, 2.0 * one.groove - 0.5 * np.pi
    y, z = np.concatenate([np.asarray(ring) for ring in one.silhouette]).T / MM
    shift = -float((y - z * np.tan(lean)).min())  # the other face begins at the wall's foot
    shown = affinity.rotate(affinity.translate(shown, shift), angle, origin=(0.0, 0.0), use_radians=True)
    c, s = np.cos(angle), np.sin(angle)
    left = max(BESIDE - shown.bounds[0], 0.0)
    faces = np.array([[-left, left * s / c], [0.0, 0.0], [right * c, right * s]])
    return affinity.translate(shown, left), faces + [left, 0.0]


def sunk(track, radius):
    """Return the track [mm] between the curved wall and its inner edge."""
    left, _, right, high = track.bounds
    x = np.linspace(left, right, 41)
    wall = radius - np.sqrt(radius**2 - x**2)
    inner = radius - high
    far = radius - np.sqrt(np.maximum(inner**2 - x**2, 0.0)) if inner > abs(left) else np.full(41, 1e3)
    return shapely.Polygon(np.vstack([np.column_stack([x, wall]), np.column_stack([x, far])[::-1]]))


def turned_into(found):
    """Say what a stretch that leans the track turns an orientation into, where statics tells."""
    if found.after.name == found.orientation.name:
        return "may turn, not sure"
    return f"turns into {found.after.name}, not sure"
