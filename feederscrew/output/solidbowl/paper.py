"""A sheet of paper in millimetres: lines, texts, dimensions, tables, hatched sections; vector PDF."""

import io

import numpy as np
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from feederscrew.output import style

A3 = 420.0, 297.0  # [mm]
INCH = 25.4  # [mm]
THICK, THIN = 0.5 * 72.0 / INCH, 0.18 * 72.0 / INCH  # [pt] of half a millimetre and of 0.18
LETTERS = 2.5  # [mm] height of letters
POINT = 72.0 / INCH / 0.72  # [pt] of a font whose letters are one millimetre high
ARROW = {"arrowstyle": "<|-|>,head_length=0.28,head_width=0.07", "color": style.INK, "linewidth": THIN,
         "shrinkA": 0, "shrinkB": 0}  # fmt: skip


class Paper:
    """An A3 sheet; all places in millimetres from its lower left corner."""

    def __init__(self):
        self.figure = Figure(figsize=(A3[0] / INCH, A3[1] / INCH), facecolor="white")
        self.axes = self.figure.add_axes((0, 0, 1, 1))
        self.axes.set(xlim=(0, A3[0]), ylim=(0, A3[1]))
        self.axes.set_axis_off()

    def lines(self, pieces, width=THIN, **look):
        """Draw pieces (N, 2, 2)."""
        self.axes.add_collection(LineCollection(pieces, colors=style.INK, linewidths=width, **look))

    def box(self, left, low, right, high, width=THIN):
        """Draw a rectangle."""
        self.axes.plot([left, right, right, left, left], [low, low, high, high, low],
                       color=style.INK, linewidth=width)  # fmt: skip

    def text(self, x, y, words, size=LETTERS, **look):
        """Write words, one line or several."""
        look = {"ha": "left", "va": "baseline", "color": style.INK} | look
        return self.axes.text(x, y, words.replace("$", r"\$"), fontsize=size * POINT, **look)

    def hatched(self, rings):
        """Draw the cut face of closed outlines, holes among them."""
        corners = np.concatenate([np.vstack([ring, ring[:1]]) for ring in rings])
        codes = np.concatenate(
            [[Outline.MOVETO, *[Outline.LINETO] * (len(ring) - 1), Outline.CLOSEPOLY] for ring in rings]
        )
        face = Outline(corners, codes)
        look = {"facecolor": "#dfe6ec", "edgecolor": style.INK, "linewidth": THICK}
        self.axes.add_patch(PathPatch(face, **look, zorder=3))

    def dimension(self, one, other, text, off=(0.0, 0.0), size=LETTERS):
        """Draw a dimension between two places, its line moved off by a vector, with helping lines."""
        one, other, off = (np.asarray(p, float) for p in (one, other, off))
        self.lines([[p, p + off * (1.0 + 1.5 / max(np.hypot(*off), 1e-9))] for p in (one, other)])
        a, b = one + off, other + off
        self.axes.annotate("", a, b, arrowprops=ARROW)
        along = b - a
        turn = np.degrees(np.arctan2(along[1], along[0]))
        turn = (turn + 90.0) % 180.0 - 90.0
        turn = 90.0 if abs(turn + 90.0) < 1e-6 else turn
        up = np.array([-np.sin(np.radians(turn)), np.cos(np.radians(turn))])
        x, y = 0.5 * (a + b) + 0.8 * up
        self.text(x, y, text, size=size, ha="center", va="bottom", rotation=turn, rotation_mode="anchor")

    def table(self, left, top, widths, rows, size=2.2, line=4.6):
        """Draw a table whose first row is its head; return the height of its lower border."""
        right, low = left + sum(widths), top - line * len(rows)
        borders = [[(left, top - line * k), (right, top - line * k)] for k in range(len(rows) + 1)]
        edges = left + np.concatenate([[0.0], np.cumsum(widths)])
        self.lines([*borders, *([(x, top), (x, low)] for x in edges)])
        for k, row in enumerate(rows):
            for x, words in zip(edges, row):
                weight = "bold" if k == 0 else "normal"
                self.text(x + 1.0, top - line * (k + 1) + 1.2, words, size=size, fontweight=weight)
        return low

    def pdf(self, title):
        """Return the sheet as a PDF without a date."""
        file = io.BytesIO()
        FigureCanvasPdf(self.figure).print_pdf(file, metadata={"Title": title, "CreationDate": None})
        return file.getvalue()
