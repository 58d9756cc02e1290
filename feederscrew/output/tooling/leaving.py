"""How a part leaves the last device, seen along the track; and bars that tell the scale of pictures."""

import shapely
from matplotlib.lines import Line2D

from feederscrew.output import style
from feederscrew.output.tooling import ink, profile
from feederscrew.tooling.orientations import Hanging
from feederscrew.units import MM

SHEET, DEEP = "#c3ccd4", 2.0  # [mm] of a rail as drawn
PART = "#9fb3c4"
BAR = 120  # pixels: at most as long is a bar
STEPS = (1.0, 2.0, 5.0)
ALIKE = 1.02  # scales that differ by less are one


def bar(size):
    """Return the length [mm] of a scale bar, 1, 2 or 5 times a power of ten, at ``size`` mm a pixel."""
    return max(step * 10.0**k for k in range(-3, 5) for step in STEPS if step * 10.0**k <= BAR * size)


def bar_on_page(page, right, y, size):
    """Draw a scale bar that ends ``right`` pixels from the left edge, ``y`` from the upper one."""
    wide, high = page.get_size_inches() * style.DPI
    length = bar(size)
    left = right - length / size
    ends = [left / wide, right / wide], [1.0 - y / high] * 2
    page.add_artist(Line2D(*ends, color=style.INK, lw=2.0, solid_capstyle="butt"))
    ink.text(page, left, y - 10, f"{length:g} mm", size=8)


def column(page, box, one, size, colour):
    """Draw an orientation as it leaves in a box of pixels, ``size`` mm a pixel or, if need be, more."""
    left, top, wide, high = box
    low, up = min(one.seen.bounds[1], 0.0) / MM, one.seen.bounds[3] / MM
    across = max(one.seen.bounds[2], *one.span) / MM if _hangs(one) else one.seen.bounds[2] / MM
    own = max(size, 1.05 * (across + _hangs(one) * DEEP) / wide, 1.05 * (up - low) / high)
    page_wide, page_high = page.get_size_inches() * style.DPI
    place = left / page_wide, 1.0 - (top + high) / page_high, wide / page_wide, high / page_high
    axes = page.add_axes(place)
    begin = min(low, -3.0 * own)
    axes.set(xlim=(-4.0 * own, (wide - 4.0) * own), ylim=(begin - 2.0 * own, begin + (high - 2.0) * own))
    axes.axis("off")
    draw(axes, one, colour)
    if own > ALIKE * size:
        bar_on_page(page, left + wide - 4.0, top + high + 24.0, own)


def _hangs(one):
    return isinstance(one, Hanging)


def draw(axes, one, colour):
    """Draw an orientation [mm] as it leaves: the wall at the left, the track below it, rails cut across."""
    shown, (_, top), (_, right) = ink.mm(one.seen), axes.get_ylim(), axes.get_xlim()
    if _hangs(one):
        first, last = (end / MM for end in one.span)
        for low, high in ((0.0, first), (last, right)):
            ink.fill(axes, shapely.box(low, -DEEP, high, 0.0), SHEET, style.INK, 3)
        axes.plot([0.0, 0.0], [min(shown.bounds[1], -DEEP), top], color=style.INK, lw=1.5, zorder=6)
    else:
        shown, line = profile.along(one, top, right)
        axes.plot(*line.T, color=style.INK, lw=1.5, zorder=6)
    ink.fill(axes, shown, f"{PART}b0", colour, 5, width=1.6)
