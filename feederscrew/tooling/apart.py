"""Why two orientations cannot be told apart, and what change of the part would help."""

import numpy as np
import shapely

from feederscrew.mechanics.wall import sameness
from feederscrew.tooling.chain import LOWER, UPPER, limits

FEATURES = {  # what a device of one number measures of a part, in the part's own terms
    "wiper": "height",
    "narrowed_track": "distance from the wall to the centre of mass",
    "pressure_break": "width",
    "canyon": "distance from the wall to the centre of mass",
    "gap": "reach of the foot ahead of and behind the centre of mass",
}


def reason(wanted, other, margin):
    """Return in one sentence why a chain leaves another orientation, and the smallest change that helps.

    Parameters
    ----------
    wanted, other : Orientation
    margin : float [m]
        Asked for on either side.

    Returns
    -------
    str
    """
    apart = difference(wanted, other)
    kind, step = _nearest(wanted, other)
    need = f"{1e3 * max(2.0 * margin - step, 0.0):.2g} mm more in {FEATURES[kind]} would part them"
    if wanted.mirror == other.name:
        return (
            f"{wanted.name} and {other.name} are mirror images fore and aft: no device of one number parts "
            f"them and no hole was found; a feature on one side only would, of {2e3 * margin:.2g} mm or more"
        )
    if apart < 4.0 * margin:
        return (
            f"{wanted.name} and {other.name} differ by {1e3 * apart:.2g} mm at most, as by a chamfer; {need}"
        )
    if carries_more(other, wanted, margin):
        return (
            f"whatever carries {wanted.name} carries {other.name}, which stands on a larger foot and is no "
            f"higher or wider: only turning it over helps; {need}"
        )
    return (
        f"{wanted.name} and {other.name} differ by {1e3 * step:.2g} mm in {FEATURES[kind]} and nowhere else "
        f"that a hole or gate can reach, as the open and closed end of a cup: needs an inner feature; {need}"
    )


def carries_more(one, other, margin):
    """Return whether one orientation stands on all that another stands on, and is no higher or wider."""
    foot, within = (shapely.MultiPoint(k.foot.corners).convex_hull for k in (one, other))
    return (
        foot.buffer(margin).covers(within)
        and abs(one.distance - other.distance) < 2.0 * margin
        and one.height <= other.height + margin
        and one.width <= other.width + 2.0 * margin
    )


def difference(wanted, other):
    """Return the greatest distance [m] between the hulls of two orientations as they lie on the track."""
    (first, _), (second, _) = (sameness.looks(one.posture, [one.heading]) for one in (wanted, other))
    sizes = [np.ptp(one.posture.corners, axis=0).max() for one in (wanted, other)]
    return float(np.abs(first[0, 0] * sizes[0] - second[0, 0] * sizes[1]).max())


def _nearest(wanted, other):
    """The device of one number at which two orientations are farthest apart, and by how much [m]."""
    found = []
    for kind in (*UPPER, *LOWER):
        first, second = limits(kind, (wanted, other))
        step = second - first if kind in UPPER else first - second
        found.append((float(step) if np.isfinite(step) else -np.inf, kind))
    step, kind = max(found)
    return kind, max(step, 0.0)
