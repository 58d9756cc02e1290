"""Pictures of a part in each stable heading against the wall, from above."""

import numpy as np
from matplotlib.patches import Polygon
from matplotlib.ticker import MaxNLocator

from feederscrew.geometry.polygons import turned
from feederscrew.output import style as plots
from feederscrew.output.floor.figures import CONTACT, PART
from feederscrew.output.solid import marks
from feederscrew.units import MM

COLUMNS = 4
MOST = 16  # headings of one picture, the most frequent
WALL, FALLS = "#5d6b78", "#b5482a"
SIDE = 2.5  # [in] of one picture
NARROWEST = 0.4  # half a picture's width, over its height above the foot
TICKS = 4  # steps of an axis, at most: their numbers stand apart in it


def headings(posture, found, track, title):
    """Draw the part in each stable heading, the wall below, the track's free edge dashed.

    Parameters
    ----------
    posture : Posture
    found : Headings
        Of that posture.
    track : Track
    title : str

    Returns
    -------
    Figure
    """
    count = min(len(found.headings), MOST)
    columns = min(COLUMNS, count)
    lines = -(-count // columns)
    figure = plots.figure(max(columns * SIDE, 2 * SIDE), lines * SIDE + 0.6)
    every = figure.subplots(lines, columns, squeeze=False, sharex=True, sharey=True).ravel()
    figure.suptitle(title, x=0.01, ha="left", fontsize=10.5, color=plots.INK, fontweight="bold")
    size = np.linalg.norm(posture.outline, axis=1).max()
    for row, axes in enumerate(every[:count]):
        _one(axes, posture, found, row, track, size)
    for axes in every[count:]:
        axes.set_visible(False)
    figure.supxlabel("along the track [mm]", fontsize=9, color=plots.INK)
    figure.supylabel("away from the wall [mm]", fontsize=9, color=plots.INK)
    return figure


def _one(axes, posture, found, row, track, size):
    heading, falls = found.headings[row], found.falls_off[row]
    plots.tidy(axes, grid="none")
    axes.set_title(_caption(found, row), fontsize=8, color=FALLS if falls else plots.INK, loc="center")
    _track(axes, found.distances[row], track, size)
    outline, contact = turned(posture.outline, heading) / MM, turned(posture.contact, heading) / MM
    edge = FALLS if falls else plots.INK
    axes.add_patch(Polygon(outline, closed=True, facecolor=PART, edgecolor=edge, linewidth=1.4, zorder=2))
    axes.add_patch(Polygon(contact, closed=True, facecolor=CONTACT, edgecolor=CONTACT, alpha=0.25, zorder=3))
    axes.plot(*(found.touching[row] / MM).T, "o", color=plots.ACCENT, markersize=5, zorder=5)
    end = 0.6 * size / MM * np.array([np.cos(heading), np.sin(heading)])
    axes.annotate(
        "",
        end,
        (0, 0),
        arrowprops={"arrowstyle": "-|>", "color": plots.INK, "linewidth": 1.0, "shrinkA": 0},
        zorder=4,
    )
    marks.centre_of_mass(axes, 0.05 * size / MM)
    reach = 1.15 * size / MM
    top = max(reach, (track.width - size) / MM * 1.05)
    wide = max(reach, NARROWEST * top)  # beside a wide track a small part has few numbers below it
    axes.set(xlim=(-wide, wide), ylim=(-1.3 * size / MM, top))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(TICKS))
    axes.set_aspect("equal")


def _caption(found, row):
    text = f"{np.degrees(found.headings[row]):.4g}°   {100.0 * found.shares[row]:.1f} %"
    size = f"{found.lengths[row] / MM:.4g} long, {found.widths[row] / MM:.4g} wide [mm]"
    note = "falls off" if found.falls_off[row] else "overhangs" if found.overhangs[row] > 0.0 else "stays on"
    return f"{text}\n{size}\n{note}"


def _track(axes, distance, track, size):
    """The wall and the free edge, concentric."""
    reach = np.linspace(-1.2, 1.2, 81) * max(size, NARROWEST * track.width) / track.radius
    for radius, style in ((track.radius, "-"), (track.radius - track.width, (0, (5, 3)))):
        x, y = radius * np.sin(reach), track.radius - distance - radius * np.cos(reach)
        axes.plot(
            x / MM, y / MM, color=WALL, linewidth=2.2 if style == "-" else 1.0, linestyle=style, zorder=1
        )
        if style == "-":
            axes.fill_between(x / MM, y / MM, y / MM - 0.12 * size / MM, color=WALL, alpha=0.35, linewidth=0)
