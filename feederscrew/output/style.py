"""Figures that come out as the same bytes every time: their size, their look, the colours of the methods."""

import io
import re

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont, get_font
from matplotlib.image import imsave
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patheffects import withStroke

from feederscrew.output import DPI
from feederscrew.resting.rules import registry

MARGIN = 0.08  # [in] round the axes
INK = "#22303c"  # text and axes
FAINT = "#d5dbe1"  # grids and frames
ANSWER = "#8fa5b5"  # the recommended answer
ACCENT = "#d55e00"  # what a picture is about: the contact polygon, the operating point
PAGE = 0.95  # [1] of it that one line may take
LONG_WORD = re.compile(r"(\S{24})\S{24,}(\S{20})")  # a name of more than 67 letters, its middle left out
LEVEL = 50  # letters that stand side by side under an axis
SPARE = ("#f0e442", "#882255", "#7a5c3e", "#a3b18a")
HALO = [withStroke(linewidth=2.5, foreground="white")]  # of letters over hatching or colours
RIM = [withStroke(linewidth=1.1, foreground="#22303c")]  # of white letters over light colours


class _Writer(RendererAgg):
    """Measures and draws every text as it stands: no formula, no letter without a glyph, not off the page."""

    def __init__(self, *size):
        super().__init__(*size)
        self._known = {}  # texts and fonts: as they can be drawn, and width, height, descent

    def draw_text(self, gc, x, y, s, prop, *angle, **more):
        more["ismath"] = False  # a name with a dollar sign is no formula
        super().draw_text(gc, x, y, self._drawable(s, prop)[0], prop, *angle, **more)

    def get_text_width_height_descent(self, s, prop, ismath):
        return self._drawable(s, prop)[1]

    def _drawable(self, text, prop):
        key = text, hash(prop)
        if key not in self._known:
            self._known[key] = self._fitted(text, prop)
        return self._known[key]

    def _fitted(self, text, prop):
        font, measured = get_font(findfont(prop)), super().get_text_width_height_descent
        sentence = "".join(letter if font.get_char_index(ord(letter)) else _escape(letter) for letter in text)
        sentence = LONG_WORD.sub(r"\1…\2", sentence)
        size, page = (
            measured(sentence, prop, False),
            PAGE * max(self.width, self.height),
        )  # text may stand upright
        if size[0] <= page:
            return sentence, size
        sentence = sentence[: int(len(sentence) * page / size[0]) - 1] + "…"
        return sentence, measured(sentence, prop, False)


def _escape(letter):
    return letter.encode("unicode_escape").decode()


class _Canvas(FigureCanvasAgg):
    """What figures are drawn on; names of users enter them in many places, and are made harmless here."""

    def get_renderer(self):
        size = (*self.figure.bbox.size, self.figure.dpi)
        if getattr(self, "_size", None) != size:
            self.renderer, self._size = _Writer(*size), size
        return self.renderer


class _Pixels(_Canvas):
    """What a picture is that was drawn already: its file has its pixels; axes would take 130 MB for them."""

    image: np.ndarray  # (rows, columns, 3) uint8

    def print_png(self, filename_or_obj, *, metadata=None, **_):
        imsave(filename_or_obj, self.image, format="png", dpi=DPI, metadata=metadata)


class ShownFigure(Figure):
    """A figure that a notebook shows as the last line of a cell, without pyplot."""

    def _repr_png_(self):
        return png(self)


def figure(width=6.4, height=4.0):
    """Return a white figure that lays out its axes by itself, without any global state.

    Parameters
    ----------
    width, height : float [in]
        Of the page; a PNG has ``DPI`` pixels an inch.
    """
    layout = ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=MARGIN)
    made = ShownFigure(figsize=(width, height), dpi=DPI, layout=layout, facecolor="white")
    _Canvas(made)
    return made


def page(width, height):
    """Return a white figure of so many pixels whose axes are placed by hand."""
    made = ShownFigure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="white")
    _Canvas(made)
    return made


def pixels(image):
    """Return a figure of the pixels of an image (rows, columns, 3) uint8 and of nothing else."""
    rows, columns, _ = image.shape
    made = page(columns, rows)
    _Pixels(made).image = image
    return made


def tidy(axes, *, title="", x="", y="", grid="both"):
    """Give one Axes the house look: labels, a faint grid behind the data, no box.

    Parameters
    ----------
    axes : Axes
        To dress; returned.
    title, x, y : str
        Texts, units in square brackets.
    grid : str
        'x', 'y', 'both' or 'none'.
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


def named_ticks(axes, places, names):
    """Write names under an x axis, slanting where they would touch each other."""
    slanting = len(names) * max(map(len, names), default=0) > LEVEL
    look = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slanting else {}
    axes.set_xticks(places, names, **look)


def method(name, place=0):
    """Return label and colour of a rule or profile; ``place`` picks a spare colour for an unknown one."""
    rule = registry.RULE_OF.get(name)
    return (rule.label, rule.colour) if rule else (name.replace("_", " "), SPARE[place % len(SPARE)])


def png(figure):
    """Return the figure as PNG bytes without a time or a version: the same figure gives the same bytes."""
    buffer = io.BytesIO()
    figure.canvas.print_png(buffer, metadata={"Software": None})  # savefig would draw it twice
    return buffer.getvalue()
