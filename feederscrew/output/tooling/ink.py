"""A sheet of pictures in rows: lines of text in pixels, geometry in millimetres."""

import numpy as np
import shapely
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from feederscrew.output import style
from feederscrew.units import MM

SHRINK = 0.82  # of a size in points


def fill(axes, area, face, edge, order, width=0.8):
    """Draw a shapely geometry [mm]: areas with their holes, lines and points."""
    for part in shapely.get_parts(area):
        if part.geom_type == "Polygon":
            rings = [np.asarray(ring.coords) for ring in (part.exterior, *part.interiors)]
            path = Path.make_compound_path(*(Path(ring, closed=True) for ring in rings))
            axes.add_patch(PathPatch(path, fc=face, ec=edge, lw=width, zorder=order))
        elif part.geom_type == "LineString":
            axes.plot(*np.asarray(part.coords).T, color=edge, lw=2.0, zorder=order)
        elif part.geom_type == "Point":
            axes.plot(part.x, part.y, "s", color=edge, ms=3.0, zorder=order)


def mm(area):
    """Return a shapely geometry [m] in millimetres."""
    return shapely.transform(area, lambda points: points / MM)


def margin(verdict):
    """Return the margin of a verdict in words; a device that only sets parts apart has none."""
    if np.isnan(verdict.margin):
        return "no margin"
    return f"margin {verdict.margin / MM:+.2f} mm" if verdict.sure else "not sure"


def rule(page, top):
    """Draw a line across a page, ``top`` pixels from its upper edge."""
    wide, high = page.get_size_inches() * style.DPI
    y = 1.0 - top / high
    page.add_artist(Line2D([16.0 / wide, 1.0 - 16.0 / wide], [y, y], color=style.FAINT, lw=0.8))


def text(page, x, y, text, *, size=9, colour=style.INK, weight="normal"):
    """Write a line of text on a page, in pixels from its upper left corner."""
    wide, high = page.get_size_inches() * style.DPI
    page.text(
        x / wide, 1.0 - y / high, text, fontsize=SHRINK * size, color=colour, fontweight=weight, va="center"
    )
