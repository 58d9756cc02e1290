"""Heights over the true circles that a tessellated round side stands for."""

import numpy as np

from feederscrew.geometry import vectors

CENTRED = 1e-3  # of the height: how far the axis may pass the centre of mass
WITHIN = 1e-6  # of the line of contact: how near its end a corner belongs to it


def height(polygon, axis, flat):
    """Return the height of the centre of mass over the line on which a round side rolls.

    Source: docs/resting.md, "Exact tumbling".

    Parameters
    ----------
    polygon : (K, 3) float [m]
        Corners of the lowest strip, from the centre of mass.
    axis : (3,) float [1]
        Unit axis of the side; NaN for a ball.
    flat : float [m]
        Height over the strip.

    Returns
    -------
    float [m]
        The corners lie on circles about the axis, and the line of contact touches the two at the strip's
        ends; ``flat`` where the axis passes the centre of mass by, or there is none.
    """
    if np.isnan(axis).any() or not len(polygon):
        return flat
    along = vectors.product(polygon, axis)
    radii = np.sqrt(((polygon - along[:, None] * axis) ** 2).sum(axis=1))
    low, high, near = along.min(), along.max(), WITHIN * max(np.ptp(along), np.finfo(float).tiny)
    ends = [radii[along <= low + near], radii[along >= high - near]]
    if high - low <= near or not all(_on_one_circle(end, CENTRED * flat) for end in ends):
        return flat
    first, last = (end.max() for end in ends)
    return float((first * high - last * low) / np.hypot(high - low, last - first))


def _on_one_circle(radii, near):
    """Whether corners at (K,) radii show a circle: two and more of one radius, or a point on the axis."""
    return np.ptp(radii) <= near and (len(radii) > 1 or radii[0] <= near)
