"""Pages that matplotlib draws as the same bytes every time, whatever texts users gave."""

import io
import re
from typing import Any, BinaryIO

from matplotlib.backend_bases import GraphicsContextBase
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.image import imsave
from matplotlib.patheffects import withStroke

from feederscrew.base.arrays import Array

LONG_WORD = re.compile(r"(\S{24})\S{24,}(\S{20})")  # a name of more than 67 letters, its middle left out
HALO = [withStroke(linewidth=2.5, foreground="white")]  # of letters over hatching or colours
LETTER_RIM = [withStroke(linewidth=1.1, foreground="#22303c")]  # of white letters over light colours


Size = tuple[float, float, float]  # of a text: width, height, descent


class _Writer(RendererAgg):
    """Measures and draws every text as it stands: no formula, no letter without a glyph, not off the page."""

    def __init__(self, *size: float) -> None:
        super().__init__(*size)
        self._texts: dict[Any, tuple[str, Size]] = {}  # by text and font: as it can be drawn

    def draw_text(
        self,
        gc: GraphicsContextBase,
        x: float,
        y: float,
        s: str,
        prop: FontProperties,
        *angle: Any,
        **more: Any,
    ) -> None:
        more["ismath"] = False  # a name with a dollar sign is no formula
        super().draw_text(gc, x, y, self._drawable(s, prop)[0], prop, *angle, **more)

    def get_text_width_height_descent(self, s: str, prop: FontProperties, ismath: Any) -> Size:
        return self._drawable(s, prop)[1]

    def _drawable(self, text: str, prop: FontProperties) -> tuple[str, Size]:
        key = text, hash(prop)
        if key not in self._texts:
            font, measured = get_font(findfont(prop)), super().get_text_width_height_descent
            letters = [
                letter if font.get_char_index(ord(letter)) else letter.encode("unicode_escape").decode()
                for letter in text
            ]
            sentence = LONG_WORD.sub(r"\1…\2", "".join(letters))
            size, page = measured(sentence, prop, False), 0.95 * max(self.width, self.height)
            if size[0] > page:  # a text may stand upright
                sentence = sentence[: int(len(sentence) * page / size[0]) - 1] + "…"
                size = measured(sentence, prop, False)
            self._texts[key] = sentence, size
        return self._texts[key]


class Canvas(FigureCanvasAgg):
    """Canvas of figures; names of users enter them in many places, and are made harmless here."""

    def get_renderer(self) -> RendererAgg:
        """Return the writer of this size, one for all texts of a figure."""
        size = (*self.figure.bbox.size, self.figure.dpi)
        if getattr(self, "_size", None) != size:
            self.renderer, self._size = _Writer(*size), size
        return self.renderer


class PixelCanvas(Canvas):
    """Picture that was drawn already: its file has its pixels; axes would take 130 MB for them."""

    image: Array  # (rows, columns, 3) uint8

    def print_png(self, filename_or_obj: BinaryIO, *, metadata: Any = None, **_: Any) -> None:
        """Write the pixels of the image.

        Parameters
        ----------
        filename_or_obj : file-like
            Open for bytes.
        metadata : dict, optional
            Entries of the PNG.
        **_ :
            What matplotlib hands to other canvases; not looked at.
        """
        imsave(filename_or_obj, self.image, format="png", dpi=self.figure.dpi, metadata=metadata)


class ShownFigure(Figure):
    """A figure that a notebook shows as the last line of a cell, without pyplot."""

    def png(self) -> bytes:
        """Return its bytes without a time or a version: the same figure gives the same bytes."""
        buffer = io.BytesIO()
        canvas: Any = self.canvas
        canvas.print_png(buffer, metadata={"Software": None})  # savefig would draw it twice
        return buffer.getvalue()

    def _repr_png_(self) -> bytes:
        return self.png()
