"""A part as it lies on the track of a bowl, along its wall."""

import numpy as np

SPACED = 1.3  # of its length: from part to part
FIRST = 0.12  # of the track: where the first of them is


def laid(plan, one, vertices, s):
    """Return a part on the track of a bowl.

    Parameters
    ----------
    plan : BowlPlan
    one : Orientation
        The part's, on the track of that bowl.
    vertices : (V, 3) float [m]
        Of the part, in its file's axes, about its centre of mass.
    s : float [m]
        Length along the wall at which its centre of mass is.

    Returns
    -------
    (V, 3) float [m]
        In the bowl's axes as its files have them.
    """
    ahead, inward, up = frame(plan, s, one.distance)
    points = np.einsum("vi,ki->vk", vertices, one.axes)
    foot = plan.way.places(s, one.distance)
    turned = points[:, :1] * ahead + points[:, 1:2] * inward + (points[:, 2:] + one.posture.height) * up
    return as_filed(plan, turned + foot)


def frame(plan, s, y):
    """Return the track's axes at a place, outlet at the angle 0: ahead, inwards and off its surface."""
    way, d = plan.way, 1e-5
    ahead = way.places(s + d, y) - way.places(s - d, y)
    inward = way.places(s, y + d) - way.places(s, y - d)
    up = np.cross(ahead, inward)
    ahead, up = ahead / np.sqrt((ahead**2).sum()), up / np.sqrt((up**2).sum())
    return ahead, np.cross(up, ahead), up


def as_filed(plan, points):
    """Return points (N, 3) [m], outlet at the angle 0 and right-handed, as the bowl's files have them."""
    x, y, z = np.asarray(points).T
    c, s = np.cos(plan.turned), np.sin(plan.turned)
    y = -y if plan.left else y
    return np.column_stack([c * x - s * y, s * x + c * y, z])


def riders(plan, one, hung):
    """Return parts along the track of a bowl, one behind the other.

    Parameters
    ----------
    plan : BowlPlan
    one : Orientation
        In which they come along.
    hung : Orientation or None
        In which they hang from the last rails on; None where there are none.

    Returns
    -------
    list of (Orientation, float [m])
        With the length along the wall of each centre of mass.
    """
    step = SPACED * one.length
    last = plan.first if plan.stretch is not None else plan.way.end - one.length
    found = [(one, s) for s in np.arange(FIRST * plan.way.end, last, step)]
    behind = one if hung is None else hung
    start = last if plan.stretch is None else plan.first + plan.stretch.length
    end = plan.way.end + plan.outlet - 0.5 * behind.length
    return found + [(behind, s) for s in np.arange(start, end, SPACED * behind.length)]
