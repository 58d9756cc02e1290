"""Figures that come out as the same bytes every time: their size, their look, the colours of the methods."""

from typing import Any

from feederscrew.heavy import heavy
from feederscrew.output import DPI
from feederscrew.resting.rules import registry

canvas = heavy("feederscrew.output.canvas")

INK = "#22303c"  # text and axes
FAINT = "#d5dbe1"  # grids and frames
ANSWER = "#8fa5b5"  # the recommended answer
ACCENT = "#d55e00"  # what a picture is about: the contact polygon, the operating point
PNG_LEVEL = 50  # letters that stand side by side under an axis
SPARE_COLOURS = ("#f0e442", "#882255", "#7a5c3e", "#a3b18a")


def figure(width: float = 6.4, height: float = 4.0) -> Any:
    """Return a white figure [in] that lays out its axes by itself, without any global state.

    A PNG has ``DPI`` pixels an inch.
    """
    drawn = canvas.ShownFigure(figsize=(width, height), dpi=DPI, layout=canvas.layout(), facecolor="white")
    canvas.Canvas(drawn)
    return drawn


def page(width: float, height: float) -> Any:
    """Return a white figure of so many pixels whose axes are placed by hand."""
    drawn = canvas.ShownFigure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="white")
    canvas.Canvas(drawn)
    return drawn


def pixels(image: Any) -> Any:
    """Return a figure of the pixels of an image (rows, columns, 3) uint8 and of nothing else."""
    rows, columns, _ = image.shape
    drawn = page(columns, rows)
    canvas.PixelCanvas(drawn).image = image
    return drawn


def tidy(axes: Any, *, title: str = "", x: str = "", y: str = "", grid: str = "both") -> Any:
    """Give one Axes the house look and return it: labels, a faint grid behind the data, no box.

    ``title``, ``x`` and ``y`` have units in square brackets; ``grid`` is 'x', 'y', 'both' or 'none'.
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


def named_ticks(axes: Any, places: Any, names: Any) -> None:
    """Write names under an x axis, slanting where they would touch each other."""
    slanting = len(names) * max(map(len, names), default=0) > PNG_LEVEL
    look = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slanting else {}
    axes.set_xticks(places, names, **look)


def method(name: str, place: int = 0) -> tuple[str, str]:
    """Return label and colour of a rule or profile; ``place`` picks a spare colour for an unknown one."""
    rule = registry.RULE_OF.get(name)
    if rule is not None:
        return rule.label, rule.colour
    return name.replace("_", " "), SPARE_COLOURS[place % len(SPARE_COLOURS)]


def png(figure: Any) -> bytes:
    """Return the figure as PNG bytes without a time or a version: the same figure gives the same bytes."""
    return figure.png()


def halo() -> Any:
    """Return the path effects of letters over hatching or colours."""
    return canvas.HALO


def rim() -> Any:
    """Return the path effects of white letters over light colours."""
    return canvas.LETTER_RIM
