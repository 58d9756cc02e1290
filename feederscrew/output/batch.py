"""The contact sheet of ``feeder batch``: each part as it rests most often."""

import io
import textwrap
from typing import Any

from feederscrew.heavy import heavy
from feederscrew.output import style
from feederscrew.part.record import Part

mpl_image = heavy("matplotlib.image")
shading = heavy("feederscrew.output.shading")

SHEET_NAME = "contact_sheet{}.png"  # as many as the parts need: nothing, then _2, _3 ...
ACROSS, DOWN = 5, 8  # thumbnails on a sheet
WIDTH, HEIGHT = 240, 180  # [px] of a thumbnail
TEXT, EDGE = 72, 20  # [px] under each thumbnail, round the sheet
NAME_LETTERS = 26  # of a line of text
LINES, BELOW = 8, 3  # of the reason why a part failed, and of what stands below a picture


def thumbnail(part: Part, record, aspect=None) -> bytes:
    """Draw a part with a mesh on one of its aspects, without a name on the likeliest.

    Returns a PNG of ``WIDTH`` by ``HEIGHT`` pixels, the same for the same part.
    """
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    row = record.names.index(aspect or record.likeliest)
    pixels = shading.thumbnail(solid, record, row, (WIDTH, HEIGHT))
    buffer, metadata = io.BytesIO(), dict[str, Any](Software=None)  # None: no such entry
    mpl_image.imsave(buffer, pixels, format="png", metadata=metadata)
    return buffer.getvalue()


def sheet(tiles) -> bytes:
    """Draw a contact sheet of parts, ``ACROSS`` in a row, as a PNG.

    A tile is a thumbnail, or None where the part failed, its name, and its rate or the reason.
    """
    return style.png(_sheet(tiles))


def _sheet(tiles):
    columns, rows = min(ACROSS, len(tiles)), -(-len(tiles) // ACROSS)
    width, height = 2 * EDGE + columns * WIDTH, 2 * EDGE + rows * (HEIGHT + TEXT)
    figure = style.page(width, height)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(0, width), ylim=(0, height))
    for place, tile in enumerate(tiles):
        row, column = divmod(place, ACROSS)
        _tile(figure, axes, EDGE + column * WIDTH, height - EDGE - (row + 1) * (HEIGHT + TEXT), tile)
    return figure


def _tile(figure, axes, left, bottom, tile) -> None:
    """One thumbnail and its text, ``bottom`` being that of the text."""
    picture, name, lines = tile
    if picture is not None:
        figure.figimage(mpl_image.imread(io.BytesIO(picture)), left, bottom + TEXT)
    failed = picture is None
    middle, colour = left + WIDTH / 2, style.ACCENT if failed else style.INK
    look = {"fontsize": 7, "color": colour, "ha": "center"}
    axes.text(
        middle, bottom + TEXT - 14, _shortened(name, NAME_LETTERS), fontweight="bold", va="center", **look
    )
    if failed:  # the reason has the place of the picture
        axes.text(middle, bottom + TEXT + HEIGHT / 2, _wrapped(lines, LINES), va="center", **look)
    else:
        axes.text(middle, bottom + TEXT - 24, _wrapped(lines, BELOW), va="top", **look)


def _wrapped(text, most) -> str:
    """The text in as many lines as there is room for."""
    lines = textwrap.wrap(text, NAME_LETTERS + 2)
    if len(lines) > most:
        lines = [*lines[: most - 1], _shortened(lines[most - 1] + " ...", NAME_LETTERS)]
    return "\n".join(lines)


def _shortened(text, most):
    return text if len(text) <= most else f"{text[: most - 3]}..."
