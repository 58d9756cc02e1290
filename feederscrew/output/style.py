"""Figures that come out as the same bytes every time: their size, their look, the colours of the methods."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Array, Floats
from feederscrew.base.heavy import heavy
from feederscrew.output import DPI
from feederscrew.resting.rules import registry

if TYPE_CHECKING:  # other modules name them in their annotations: "style.Axes"
    from matplotlib.axes import Axes as Axes
    from matplotlib.figure import Figure as Figure
    from matplotlib.patheffects import AbstractPathEffect
    from matplotlib.text import Annotation

canvas = heavy("feederscrew.output.canvas")
layout_engine = heavy("matplotlib.layout_engine")

INK = "#22303c"  # text and axes
FAINT = "#d5dbe1"  # grids and frames
ANSWER = "#8fa5b5"  # the recommended answer
ACCENT = "#d55e00"  # what a picture is about: the contact polygon, the operating point
Look = dict[str, Any]  # keywords of what matplotlib draws
LEGEND: Look = {"fontsize": 8, "frameon": False, "labelcolor": INK}
BESIDE: Look = LEGEND | {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}  # of its Axes
Grid = Literal["x", "y", "both", "none"]  # lines behind the data
Place = Sequence[float] | Floats  # across and up
SPARE_COLOURS = ("#f0e442", "#882255", "#7a5c3e", "#a3b18a")


def figure(width: float = 6.4, height: float = 4.0) -> Any:
    """Return a white figure that lays out its axes by itself, of ``DPI`` pixels an inch.

    Parameters
    ----------
    width, height : float [in], optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    layout = layout_engine.ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.08)
    drawn = canvas.ShownFigure(figsize=(width, height), dpi=DPI, layout=layout, facecolor="white")
    canvas.Canvas(drawn)
    return drawn


def chart(
    width: float = 6.4, height: float = 4.0, *, ax: "Axes | None" = None, **labels: Any
) -> tuple[Any, Any]:
    """Return a figure and its only Axes, or a user's own Axes and its figure.

    Parameters
    ----------
    width, height : float [in], optional
    ax : matplotlib.axes.Axes, optional
        The user's own.
    **labels : object
        As ``tidy`` takes them.

    Returns
    -------
    figure : matplotlib.figure.Figure
    axes : matplotlib.axes.Axes
    """
    if ax is not None:
        return ax.figure, tidy(ax, **labels)
    drawn = figure(width, height)
    return drawn, tidy(drawn.add_subplot(), **labels)


def page(width: float, height: float) -> Any:
    """Return a white figure whose axes are placed by hand.

    Parameters
    ----------
    width, height : float [pixel]

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = canvas.ShownFigure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="white")
    canvas.Canvas(drawn)
    return drawn


def sheet(width: float, height: float) -> tuple[Any, Any]:
    """Return a page, and Axes over the whole of it in pixels from its lower left corner.

    Parameters
    ----------
    width, height : float [pixel]

    Returns
    -------
    figure : matplotlib.figure.Figure
    axes : matplotlib.axes.Axes
    """
    drawn = page(width, height)
    axes = drawn.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(0, width), ylim=(0, height))
    return drawn, axes


@dataclass(frozen=True)
class Panels:
    """Pictures in rows on a sheet, each with its caption below: lengths in pixels."""

    across: int  # pictures in a row
    width: int  # of each
    heights: Sequence[int]  # of those of each row
    caption: int
    head: int  # above the first row
    foot: int  # below the last caption
    edge: int = 0  # at the left and at the right
    gap: int = 0  # from one picture to the next

    @property
    def page(self) -> tuple[int, int]:
        """Width and height of the whole sheet."""
        wide = 2 * self.edge + self.across * (self.width + self.gap) - self.gap
        return wide, self.head + sum(self.heights) + len(self.heights) * self.caption + self.foot

    def place(self, panel: int) -> tuple[int, int, int, int]:
        """Return where a picture stands on the sheet.

        Parameters
        ----------
        panel : int
            Its number, row by row from the top.

        Returns
        -------
        (int, int, int, int)
            Left, bottom, width and height in pixels, from the lower left corner.
        """
        row, column = divmod(panel, self.across)
        above = self.head + sum(self.heights[: row + 1]) + row * self.caption
        left = self.edge + column * (self.width + self.gap)
        return left, self.page[1] - above, self.width, self.heights[row]


def inset(page: "Figure", sheet_axes: "Axes", box: Sequence[float], **look: Any) -> Any:
    """Return Axes in a box of a sheet.

    Parameters
    ----------
    page : matplotlib.figure.Figure
    sheet_axes : matplotlib.axes.Axes
        As ``sheet`` returns them.
    box : sequence of float [pixel]
        Left, bottom, width, height.
    **look : object
        As of ``Figure.add_axes``.

    Returns
    -------
    matplotlib.axes.Axes
    """
    (_, width), (_, height) = sheet_axes.get_xlim(), sheet_axes.get_ylim()
    return page.add_axes((box[0] / width, box[1] / height, box[2] / width, box[3] / height), **look)


def pixels(image: Array) -> Any:
    """Return a figure of the pixels of an image and of nothing else.

    Parameters
    ----------
    image : (R, C, 3) array of uint8

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows, columns, _ = image.shape
    drawn = page(columns, rows)
    canvas.PixelCanvas(drawn).image = image
    return drawn


def tidy(axes: "Axes", *, title: str = "", x: str = "", y: str = "", grid: Grid = "both") -> Any:
    """Give Axes the house look and return them: labels, a faint grid behind the data, no box.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    title, x, y : str, optional
        With units in square brackets.
    grid : str, optional
        'x', 'y', 'both' or 'none'.

    Returns
    -------
    matplotlib.axes.Axes
    """
    axes.set_title(title, loc="left", fontsize=10, color=INK, fontweight="bold")
    axes.set_xlabel(x, fontsize=9, color=INK)
    axes.set_ylabel(y, fontsize=9, color=INK)
    axes.tick_params(labelsize=8, colors=INK, length=3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(INK)
    axes.set_axisbelow(True)
    if grid != "none":
        axes.grid(axis=grid, color=FAINT, linewidth=0.6)
    return axes


def named_ticks(axes: "Axes", places: ArrayLike, names: Sequence[str], length: float = 0.0) -> None:
    """Write names under an x axis, slanting where they would touch each other.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    places : (N,) float [data unit]
    names : sequence of str
    length : float [pt], optional
        Of the ticks.
    """
    slanting = len(names) * max(map(len, names), default=0) > 50  # letters that stand side by side
    look: Look = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slanting else {}
    axes.set_xticks(places, names, **look)
    axes.tick_params(axis="x", length=length)


def numbers(
    axes: "Axes",
    x: Iterable[float],
    heights: Iterable[float],
    texts: Iterable[float],
    upright: bool = False,
    **look: Any,
) -> None:
    """Write numbers with one decimal over the ends of bars.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x, heights : iterable of float [data unit]
    texts : iterable of float [any]
        The numbers; none is written where it is NaN.
    upright : bool, optional
        Whether they are turned upright.
    **look : object
        As of ``note``.
    """
    look = {"ha": "center", "va": "bottom", "fontsize": 6.5, "rotation": 90 if upright else 0} | look
    for at, height, value in zip(x, heights, texts):
        if np.isfinite(value):
            note(axes, f"{value:.1f}", (at, height), (0, 2), **look)


def own_point(axes: "Axes", place: Place, text: str, shift: Place, **look: Any) -> None:
    """Mark the point of the user's own bowl on a map, and write beside it.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    place : (float, float) [data unit]
    text : str
    shift : (float, float) [pt]
        By which the text is moved.
    **look : object
        As of ``Axes.annotate``.
    """
    axes.plot(*place, "o", markersize=7, color=ACCENT, markeredgecolor="white", zorder=6)
    box = {"facecolor": "white", "alpha": 0.8, "linewidth": 0, "pad": 1.0}
    look = {"color": ACCENT, "fontweight": "bold", "zorder": 6, "bbox": box} | look
    note(axes, text, place, shift, **look)


def note(axes: "Axes", text: str, place: Place, shift: Place = (0, 0), **look: Any) -> "Annotation":
    """Write a text at a place of the data, and return it.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    text : str
    place : (float, float) [data unit]
    shift : (float, float) [pt], optional
        By which it is moved.
    **look : object
        As of ``Axes.annotate``.

    Returns
    -------
    matplotlib.text.Annotation
    """
    usual: Look = {"fontsize": 8, "color": INK, "textcoords": "offset points"}
    (x, y), (right, up) = place, shift
    return axes.annotate(text, (x, y), (right, up), **usual | look)


def legend(figure: "Figure", where: str = "lower center", ax: "Axes | None" = None, **look: Any) -> None:
    """Write the legend of a figure outside of its Axes, without a frame; into a user's own Axes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    where : str, optional
    ax : matplotlib.axes.Axes, optional
        The user's own.
    **look : object
        As of ``Figure.legend``.
    """
    if ax is not None:  # what else stands in that figure is not known
        ax.legend(**({"frameon": False, "fontsize": 7} | look | {"ncols": 1}))
        return
    figure.legend(**({"loc": f"outside {where}", "frameon": False, "fontsize": 8} | look))


def round_length(most: float) -> float:
    """Return the greatest of 1, 2, 5, 10, 20 ... that is at most a length, in its unit.

    Parameters
    ----------
    most : float
        Above 0, in any unit.

    Returns
    -------
    float
    """
    decade = 10.0 ** np.floor(np.log10(most))
    return float(max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= most * (1.0 + 1e-9)))


def method(name: str, place: int = 0) -> tuple[str, str]:
    """Return label and colour of a rule or profile.

    Parameters
    ----------
    name : str
    place : int, optional
        Picks a spare colour for an unknown one.

    Returns
    -------
    label, colour : str
    """
    rule = registry.RULE_OF.get(name)
    if rule is not None:
        return rule.label, rule.colour
    return name.replace("_", " "), SPARE_COLOURS[place % len(SPARE_COLOURS)]


def png(figure: Any) -> bytes:
    """Return the figure as PNG bytes without a time or a version: the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure

    Returns
    -------
    bytes
    """
    return figure.png()


def halo() -> list["AbstractPathEffect"]:
    """Return the path effects of letters over hatching or colours."""
    return canvas.HALO


def rim() -> list["AbstractPathEffect"]:
    """Return the path effects of white letters over light colours."""
    return canvas.LETTER_RIM
