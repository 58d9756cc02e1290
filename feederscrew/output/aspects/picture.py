"""The sheet of aspects: the part as it rests on each, one panel a class, all in one scale."""

from dataclasses import dataclass

import numpy as np

from feederscrew.output import style
from feederscrew.output.solid import marks, render, shading
from feederscrew.output.solid.shading import Shot
from feederscrew.output.solid.stance import outermost, stance

MOST_ACROSS = 4  # panels in a row
PANEL, ALONE = 400, 720  # [px] width of one panel, and of one that is alone
LETTER = 22  # [px] width of a letter of the name
TALLEST = 1.15  # height of a panel over its width
LINE, SMALL = 24, 17  # [px] of text, and of the rules' smaller text
SCALE = 200  # [px] of the head that the scale bar takes
BAR, BARS = 94, 140  # [px] length of a bar for a probability of 1, and where it starts
RIGHT = 370  # [px] where the numbers beside the bars end
HEAD, FOOT = 92, 76  # [px] above and below the panels
ROOM = 1.1  # of a panel over the largest part in it


@dataclass(frozen=True, eq=False)
class Sheet:
    """Where everything goes, in pixels from the lower left corner."""

    columns: int
    rows: int
    image: tuple[int, int]  # width and height of a panel's image
    caption: int  # height of the text under it
    pixel: float  # [size] edge of one pixel, the same in every panel

    @property
    def page(self):
        """Width and height of the whole sheet."""
        width, height = self.image
        return self.columns * width, self.rows * (height + self.caption) + HEAD + FOOT

    def place(self, panel):
        """Return the lower left corner of a panel's image."""
        row, column = divmod(panel, self.columns)
        width, height = self.image
        top = self.page[1] - HEAD - row * (height + self.caption)
        return column * width, top - height


def aspects(part, found, rows, answer=None):
    """Draw the part on each of its aspects.

    Parameters
    ----------
    part : Part
        With a mesh.
    found : Aspects
        Its classes.
    rows : sequence of int
        Which of them are drawn, in this order.
    answer : Recommended, optional
        Told first, with its interval.

    Returns
    -------
    Figure
    """
    solid = render.Rays(part.vertices, part.faces, part.centre_of_mass)
    points = outermost(solid.points)
    stances = [stance(points, found.normals[row], found.heights[row] / solid.size) for row in rows]
    sheet = _sheet(stances, len(found.probabilities), answer is not None)
    figure = style.page(*sheet.page)
    for panel, (row, standing) in enumerate(zip(rows, stances)):
        frame = _frame(sheet, standing)
        colour = shading.STEEL if found.stable[row] else shading.PALE
        axes = _axes(figure, sheet, panel)
        axes.imshow(
            shading.picture(solid, standing, frame, colour), extent=frame.extent, interpolation="nearest"
        )
        marks.contact(axes, solid, standing, found.polygons[row] / solid.size)
        marks.rolling_axis(axes, solid, standing, found.axes[row])
        marks.centre_of_mass(axes, 11.0 * sheet.pixel)
        _caption(figure, sheet, panel, found, row, answer)
    page = _head_and_foot(figure, sheet, part, solid)
    marks.legend(page, 30, 30, rolling=bool(np.isfinite(found.axes[list(rows)]).any()))
    return figure


def _sheet(stances, rules, answered):
    """The layout in which the largest part just fits its panel."""
    count = len(stances)
    columns = count if count <= MOST_ACROSS else 3 if count in (5, 6, 9) else MOST_ACROSS
    widths, heights = np.max([s.framed[1] - s.framed[0] for s in stances], axis=0) * ROOM
    width = PANEL if count > 1 else ALONE
    pixel = max(widths / width, heights / (TALLEST * PANEL))
    image = (width, max(int(np.ceil(heights / pixel)), PANEL // 3))
    caption = LINE * (2 + answered) + SMALL * rules
    return Sheet(columns, -(-count // columns), image, caption, pixel)


def _frame(sheet, standing):
    """The part in the middle of its panel, a little above the lower edge."""
    width, height = sheet.image
    lowest, highest = standing.framed
    left = 0.5 * (lowest[0] + highest[0]) - 0.5 * width * sheet.pixel
    bottom = 0.5 * (lowest[1] + highest[1]) - 0.5 * height * sheet.pixel
    return Shot(left, bottom, sheet.pixel, width, height)


def _axes(figure, sheet, panel):
    axes = figure.add_axes(_share(sheet, *sheet.place(panel), *sheet.image))
    axes.set_axis_off()
    return axes


def _share(sheet, left, bottom, width, height):
    page = sheet.page
    return left / page[0], bottom / page[1], width / page[0], height / page[1]


def _caption(figure, sheet, panel, found, row, answer):
    """Name, kind and count of a class; the recommended answer with its interval, then every rule, smaller."""
    left, bottom = sheet.place(panel)
    axes = figure.add_axes(_share(sheet, left, bottom - sheet.caption, sheet.image[0], sheet.caption))
    axes.set_axis_off()
    axes.set(xlim=(0, sheet.image[0]), ylim=(-sheet.caption, 0))
    what = f"{found.kinds[row]} ×{found.faces[row]}" if found.stable[row] else "not stable"
    look = {"color": style.INK, "va": "center"}
    name = axes.text(30, -0.6 * LINE, found.names[row], fontsize=11, fontweight="bold", **look)
    beside = {"xycoords": name, "xytext": (6, 0), "textcoords": "offset points"}
    axes.annotate(what, (1.0, 0.5), fontsize=8, **beside, **look)
    if not found.stable[row]:
        return
    top = -1.55 * LINE
    if answer is not None:
        _answer(axes, top, *(float(ends[row]) for ends in (answer.p, answer.low, answer.high)))
        top -= LINE
    for place, (rule, values) in enumerate(found.probabilities.items()):
        label, colour = style.method(rule, place)
        y = top - place * SMALL
        axes.text(30, y, label, fontsize=6, color=style.INK, va="center")
        axes.barh(y, BAR, height=5, left=BARS, color=style.FAINT, alpha=0.5)
        axes.barh(y, BAR * values[row], height=5, left=BARS, color=colour)
        _number(axes, y, f"{100.0 * values[row]:.1f} %", fontsize=6)


def _answer(axes, y, share, low, high):
    """The recommended probability as a broad bar, its interval as a line through it and in words."""
    axes.text(30, y, "recommended", fontsize=6, color=style.INK, va="center")
    axes.barh(y, BAR, height=13, left=BARS, color=style.FAINT, alpha=0.5)
    axes.barh(y, BAR * share, height=13, left=BARS, color=style.ANSWER)
    ends = [BARS + BAR * low, BARS + BAR * high]
    axes.plot(ends, [y, y], "|-", color=style.INK, linewidth=1.2, markersize=4)
    sentence = f"{100.0 * share:.0f} % ({100.0 * low:.0f}–{100.0 * high:.0f})"
    _number(axes, y, sentence, fontsize=6.5, fontweight="bold")


def _number(axes, y, text, **look):
    axes.text(RIGHT, y, text, color=style.INK, va="center", ha="right", **look)


def _head_and_foot(figure, sheet, part, solid):
    """What is drawn and its scale; the Axes over the whole page, in pixels."""
    width, height = sheet.page
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(0, width), ylim=(0, height))
    longest = (width - SCALE) // LETTER
    name = part.name if len(part.name) <= longest else f"{part.name[: longest - 3]}..."
    axes.text(30, height - 34, name, fontsize=13, fontweight="bold", color=style.INK, va="center")
    facts = f"{part.material}, {1e3 * part.mass:.4g} g" + ", open surface" * part.open_surface
    colour = style.ACCENT if part.open_surface else style.INK
    axes.text(30, height - 66, facts, fontsize=8, color=colour, va="center")
    marks.scale_bar(axes, width - 30, height - 66, sheet.pixel * solid.size)
    return axes
