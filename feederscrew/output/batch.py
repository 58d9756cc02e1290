"""The contact sheet of ``feeder batch``: each part as it rests most often."""

import io
import textwrap
from collections.abc import Sequence

from feederscrew.base.arrays import Array
from feederscrew.base.heavy import heavy
from feederscrew.base.signatures import Keywords
from feederscrew.output import style
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects

mpl_image = heavy("matplotlib.image")
shading = heavy("feederscrew.output.shading")

SHEET_NAME = "contact_sheet{}.png"  # as many as the parts need: nothing, then _2, _3 ...
ACROSS, DOWN = 5, 8  # thumbnails on a sheet
WIDTH, HEIGHT = 240, 180  # [px] of a thumbnail
TEXT, EDGE = 72, 20  # [px] under each thumbnail, round the sheet
NAME_LETTERS = 26  # of a line of text
LINES, BELOW = 8, 3  # of the reason why a part failed, and of what stands below a picture


def thumbnail(part: Part, record: Aspects, aspect: str | None = None) -> bytes:
    """Draw a part on one of its aspects as a PNG.

    Parameters
    ----------
    part : Part
        From a mesh.
    record : Aspects
        Of that part.
    aspect : str, optional
        The likeliest without it.

    Returns
    -------
    bytes
    """
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    row = record.names.index(aspect or record.likeliest)
    return png_of_pixels(shading.thumbnail(solid, record, row, (WIDTH, HEIGHT)))


def png_of_pixels(pixels: Array) -> bytes:
    """Return an image as the bytes of a PNG, the same for the same image.

    Parameters
    ----------
    pixels : (R, C, 3) array
        From 0 to 1.

    Returns
    -------
    bytes
    """
    buffer, metadata = io.BytesIO(), Keywords(Software=None)  # None: no such entry
    mpl_image.imsave(buffer, pixels, format="png", metadata=metadata)
    return buffer.getvalue()


def sheet(tiles: Sequence[tuple[bytes | None, str, str]]) -> bytes:
    """Draw a contact sheet of parts, ``ACROSS`` in a row, as a PNG.

    Parameters
    ----------
    tiles : sequence of (bytes or None, str, str)
        A thumbnail, or None where the part failed, its name, and its rate or the reason.

    Returns
    -------
    bytes
    """
    return style.png(_sheet(tiles))


def _sheet(tiles: Sequence[tuple[bytes | None, str, str]]) -> "style.Figure":
    columns, rows = min(ACROSS, len(tiles)), -(-len(tiles) // ACROSS)
    panels = style.Panels(columns, WIDTH, [HEIGHT] * rows, TEXT, EDGE, EDGE, EDGE)
    figure, axes = style.sheet(*panels.page)
    for place, (picture, name, text) in enumerate(tiles):
        left, bottom, _, _ = panels.place(place)
        middle = left + WIDTH / 2
        look = {"fontsize": 7, "color": style.ACCENT if picture is None else style.INK, "ha": "center"}
        title = _shorten(name, NAME_LETTERS)
        axes.text(middle, bottom - 14, title, fontweight="bold", va="center", **look)
        if picture is None:  # the reason has the place of the picture
            axes.text(middle, bottom + HEIGHT / 2, _wrap(text, LINES), va="center", **look)
        else:
            figure.figimage(mpl_image.imread(io.BytesIO(picture)), left, bottom)
            axes.text(middle, bottom - 24, _wrap(text, BELOW), va="top", **look)
    return figure


def _wrap(text: str, most: int) -> str:
    lines = textwrap.wrap(text, NAME_LETTERS + 2)
    if len(lines) > most:
        lines = [*lines[: most - 1], _shorten(lines[most - 1] + " ...", NAME_LETTERS)]
    return "\n".join(lines)


def _shorten(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 3]}..."
