"""Why two orientations cannot be told apart, and what change of the part would help."""

from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.mechanics.wall import sameness
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.isolating.chain import limits, numbered
from feederscrew.tooling.verdicts import opening_margin

HULL_FIT_ROUNDS = 4  # of the fit of one hull over the other
SIDE_NAMES = (("ahead", "behind"), ("on the inner side", "at the wall"), ("on top", "at the bottom"))


@dataclass(frozen=True)
class Difference:
    """How two orientations differ as they lie on the track."""

    shape: float  # [m] greatest distance between their hulls, laid over each other as well as can be
    side: str  # where that is
    shift: tuple[float, float, float]  # [m] of the centre of mass within the hull: ahead, inwards, up


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
    names = f"{wanted.name} and {other.name}"
    if wanted.mirror == other.name:
        return (
            f"{names} are mirror images fore and aft: no device of one number parts "
            f"them and no hole was found; a feature on one side only would, of {2e3 * margin:.2g} mm or more"
        )
    apart, need = difference(wanted, other), smallest_change(wanted, other, margin)
    if apart.shape < min(margin, 0.5 * max(map(abs, apart.shift))):
        same = f"have the same outside to {1e3 * max(apart.shape, 1e-5):.2f} mm"
        return f"{names} {same}, {_inside(apart)}; {need}"
    if apart.shape < 4.0 * margin:
        return (
            f"{names} differ by {1e3 * apart.shape:.2g} mm at most, {apart.side}, as by a chamfer or a "
            f"rounding; {need}"
        )
    if carries_more(other, wanted, margin):
        return (
            f"whatever carries {wanted.name} carries {other.name}, which stands on a larger foot and is no "
            f"higher or wider: only turning it over helps; {need}"
        )
    return (
        f"{names} differ by {1e3 * apart.shape:.2g} mm {apart.side}, which no device of one number, gate or "
        f"hole that was tried can use; {need}"
    )


def _inside(apart):
    """What differs of two orientations with the same outside."""
    ahead, inwards, up = (1e3 * abs(by) for by in apart.shift)
    return (
        f"only the inside differs, as by a bore off the middle or a closed end: the centre of mass lies "
        f"elsewhere by {ahead:.2f} mm along the track, {inwards:.2f} mm across it and {up:.2f} mm in height; "
        "needs a feature on the outside"
    )


def smallest_change(wanted, other, margin):
    """Return in words the least [m] that has to be added to what some device measures of a part."""
    feature, step = _nearest(wanted, other)
    if step >= 2.0 * margin:
        return f"{feature} differs by {1e3 * step:.2g} mm, but no chain that was tried can use it"
    return f"{1e3 * (2.0 * margin - step):.2g} mm more in {feature} would part them"


def carries_more(one, other, margin):
    """Return whether one orientation stands on all that another stands on, and is no higher or wider."""
    lower = one.height <= other.height + margin and one.width <= other.width + 2.0 * margin
    return lower and stands_on_all(one, other, margin)


def stands_on_all(one, other, margin):
    """Return whether one orientation stands on all that another stands on: no hole lets it fall alone."""
    foot, within = (shapely.MultiPoint(k.foot.corners).convex_hull for k in (one, other))
    near = abs(one.distance - other.distance) < 2.0 * margin
    return bool(near and foot.buffer(margin).covers(within))


def difference(wanted, other):
    """Return how two orientations differ as they lie on the track: a Difference.

    Parameters
    ----------
    wanted, other : Orientation
    """
    (first, _), (second, _) = (sameness.looks(one.posture, [one.heading]) for one in (wanted, other))
    sizes = [np.ptp(one.posture.corners, axis=0).max() for one in (wanted, other)]
    away, there = first[0, 0] * sizes[0] - second[0, 0] * sizes[1], sameness.directions()
    shift = np.zeros(3)
    for _ in range(HULL_FIT_ROUNDS):  # least squares: the directions are spread evenly
        left = away - (there * shift).sum(axis=1)
        shift = shift + 3.0 * (there * left[:, None]).mean(axis=0)
    left = np.abs(away - (there * shift).sum(axis=1))
    where = there[int(np.argmax(np.round(left, 9)))]
    axis = int(np.argmax(np.abs(where)))
    x, y, z = map(float, shift)
    return Difference(float(left.max()), SIDE_NAMES[axis][int(where[axis] < 0.0)], (x, y, z))


def _nearest(wanted, other):
    """What some device measures in which two orientations are farthest apart, and by how much [m]."""
    found = [
        (-opening_margin(wanted.seen, other), kind.kind, kind.feature)
        for kind in KINDS.values()
        if hasattr(kind, "free")
    ]
    for kind in numbered():
        first, second = limits(kind, (wanted, other))
        step = second - first if kind.bound == "upper" else first - second
        found.append((float(step) if np.isfinite(step) else -np.inf, kind.kind, kind.feature))
    step, _, feature = max(found)
    return feature, max(step, 0.0)
