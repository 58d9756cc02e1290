"""What is drawn over a picture of a part: centre of mass, contact polygon, rolling axis, scale."""

from typing import Any

import numpy as np
from matplotlib.patches import Circle, Polygon, Wedge

from feederscrew.output import style

STEPS = 60  # pieces an edge of the contact polygon is cut into, to see which are hidden
LINE = {"color": style.ACCENT, "linewidth": 1.3, "solid_capstyle": "round"}
HIDDEN = {"color": style.ACCENT, "linewidth": 0.8, "linestyle": (0, (3, 2)), "alpha": 0.8}
BEYOND = 0.08  # [size] how far a rolling axis sticks out at both ends
AXIS: dict[str, Any] = {"color": "#0072b2", "linewidth": 0.9, "linestyle": (0, (9, 2.5, 2, 2.5))}
ROUND_LENGTHS = np.array([1.0, 2.0, 5.0])


def centre_of_mass(axes, radius, place=(0.0, 0.0)):
    """Draw the quartered circle through whatever is in front of it.

    Parameters
    ----------
    axes : Axes
        Over the picture.
    radius : float
        Of the circle, in data units.
    place : (2,) float
        The projected centre of mass.
    """
    axes.add_patch(Circle(place, radius, facecolor="white", edgecolor="black", linewidth=0.8, zorder=5))
    for start in (0.0, 180.0):
        axes.add_patch(Wedge(place, radius, start, start + 90.0, color="black", linewidth=0, zorder=6))


def contact(axes, solid, standing, polygon):
    """Draw the contact polygon: whole where it is seen, dashed where the part hides it.

    Parameters
    ----------
    axes : Axes
        Over the picture.
    solid : Rays
        What hides it.
    standing : Stance
        How the solid stands and from where it is seen.
    polygon : (K, 3) float [size]
        Its corners about the centre of mass, in order.
    """
    camera = standing.camera
    axes.add_patch(
        Polygon(camera.project(polygon), closed=True, facecolor=style.ACCENT, alpha=0.16, zorder=2)
    )
    pieces = _pieces(polygon)
    ends = camera.project(pieces.reshape(-1, 3)).reshape(-1, 2, 2)
    seen = camera.sees(solid, pieces.mean(axis=1))
    for shown, look in ((seen, LINE), (~seen, HIDDEN)):
        for run in _runs(shown):
            chain = np.vstack([ends[run, 0], ends[run[-1], 1]])
            axes.plot(chain[:, 0], chain[:, 1], zorder=3, **look)


def rolling_axis(axes, solid, standing, direction):
    """Draw the axis a part rolls about, through its centre of mass; nothing where there is none.

    Parameters
    ----------
    axes : Axes
        Over the picture.
    solid : Rays
        What rolls; the line is a little longer.
    standing : Stance
        How it stands.
    direction : (3,) float
        Unit vector, NaN for none.
    """
    if not np.isfinite(direction).all():
        return
    along = solid.points @ direction
    ends = standing.camera.project(np.outer([along.min() - BEYOND, along.max() + BEYOND], direction))
    axes.plot(*ends.T, zorder=4, scalex=False, scaley=False, **AXIS)


def scale_bar(axes, right, y, pixel):
    """Draw a bar of a round number of millimetres that ends at ``right``; ``pixel`` [m] is one data unit."""
    wanted = 110.0 * pixel * 1e3
    decade = 10.0 ** np.floor(np.log10(wanted))
    length = float(max(ROUND_LENGTHS[decade * ROUND_LENGTHS <= wanted * (1.0 + 1e-9)]) * decade)
    left = right - length * 1e-3 / pixel
    axes.plot([left, right], [y, y], color=style.INK, linewidth=1.6, solid_capstyle="butt")
    for end in (left, right):
        axes.plot([end, end], [y - 5, y + 5], color=style.INK, linewidth=1.0)
    axes.text(
        0.5 * (left + right), y + 9, f"{length:g} mm", fontsize=7.5, color=style.INK, ha="center", va="bottom"
    )


def legend(axes, left, y, *, rolling):
    """Draw what the marks mean, in one line of text from ``left`` on; the axis only if one is drawn."""
    centre_of_mass(axes, 9.0, (left + 9.0, y))
    axes.text(left + 26, y, "centre of mass", fontsize=7, color=style.INK, va="center")
    axes.plot([left + 170, left + 198], [y, y], **LINE)
    axes.text(left + 208, y, "contact, dashed where hidden", fontsize=7, color=style.INK, va="center")
    if rolling:
        axes.plot([left + 460, left + 500], [y, y], **AXIS)
        axes.text(left + 510, y, "axis it rolls about", fontsize=7, color=style.INK, va="center")


def _pieces(polygon):
    """Every edge of a closed polygon cut up: (K * STEPS, 2, 3) ends of the pieces."""
    share = np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    chains = [(1.0 - share) * a + share * b for a, b in zip(polygon, np.roll(polygon, -1, axis=0))]
    return np.concatenate([np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains])


def _runs(flags):
    """Index arrays of the runs of true entries."""
    indices = np.flatnonzero(flags)
    return [run for run in np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1) if len(run)]
