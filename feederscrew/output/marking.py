"""The mark on every drawing and solid of a bowl whose trial falls short."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from feederscrew.bowl.verified import FALLS_SHORT
from feederscrew.output import offers

MARK = "FALLS SHORT - not for manufacture"
MARK_COLOUR, STRENGTH = "#d40000", 0.45  # of the letters, and how much they hide [1]
DIAGONAL_SHARE, SIDE_SHARE = 0.75, 0.88  # [1] of the diagonal and the longer side that a mark takes at most
STEP_HEAD = re.compile(rb"(FILE_DESCRIPTION\(\('[^']*)'")
STEP_PRODUCT = re.compile(rb"(PRODUCT\('[^']*)','([^']*)'")  # its number and its name


@dataclass(frozen=True)
class SheetFields:
    """Fields of the title block that the user gives; '' stays empty: the same input gives the same bytes."""

    date: str = ""
    revision: str = ""


def of_trial(tried: Any, mark: str | None = None) -> str:
    """Return the mark of a bowl whose trial falls short, or the one given in its place; '' of any other."""
    if mark is not None:
        return mark
    return MARK if tried is not None and tried.status == FALLS_SHORT else ""


def marked_title(text: str, mark: str) -> str:
    """Return the name of a body or the title of a file with a mark: 'bowl - FALLS SHORT - ...'."""
    return f"{text} - {mark}" if mark else text


def file_name(name: str, mark: str) -> str:
    """Return the name of a solid's file, 'bowl_falls_short.stl' with a mark: all that a slicer shows."""
    path = PurePosixPath(name)
    return f"{path.stem}_falls_short{path.suffix}" if mark else name


def mark_step(data: bytes, mark: str) -> bytes:
    """Return a STEP file whose head and products bear a mark, in letters of ASCII without an apostrophe."""
    if not mark:
        return data
    end = f" - {mark}'".encode("ascii")
    data = STEP_HEAD.sub(rb"\1" + end, data)
    return STEP_PRODUCT.sub(rb"\1" + end + rb",'\2" + end, data)


def diagonal(sheet: Any, mark: str) -> tuple[float, float]:
    """Return the size of a mark's letters, in the unit of a sheet (width, height), and its turn [rad]."""
    length = min(DIAGONAL_SHARE * float(np.hypot(*sheet)), SIDE_SHARE * max(sheet))
    width = 0.62  # of a bold letter over its size, in the mean
    return length / (width * len(mark)), float(np.arctan2(sheet[1], sheet[0]))


def across(figure: Any, mark: str) -> Any:
    """Write a mark from corner to corner of a figure or of None, and return it; '' leaves it as it is."""
    if figure is None or not mark:
        return figure
    image = getattr(figure.canvas, "image", None)
    if image is None:
        _write(figure, mark)
        return figure
    from feederscrew.output import style  # matplotlib, where a picture is drawn anyway

    rows, columns, _ = image.shape  # a picture of pixels alone: the letters are laid over them
    letters = style.page(columns, rows)
    letters.patch.set_alpha(0.0)
    _write(letters, mark)
    letters.canvas.draw()
    drawn = np.asarray(letters.canvas.buffer_rgba())
    hidden = drawn[..., 3:] / 255.0
    mixed = image * (1.0 - hidden) + drawn[..., :3] * hidden
    figure.canvas.image = np.rint(mixed).astype(np.uint8)
    return figure


def _write(figure: Any, mark: str) -> None:
    size, turn = diagonal(figure.get_size_inches(), mark)
    figure.text(
        0.5, 0.5, mark, fontsize=72.0 * size, rotation=np.degrees(turn), ha="center", va="center",
        rotation_mode="anchor", fontweight="bold", color=MARK_COLOUR, alpha=STRENGTH, zorder=100,
    ).set_in_layout(False)  # fmt: skip


def pictures(offered: Iterable[Any], mark: str) -> list[Any]:
    """Return offers whose pictures bear a mark; the others as they are."""

    def marked(offer: Any) -> Any:
        return offers.picture(offer.name, f"{offer.alt} ({mark})", lambda: across(offer.view(), mark))

    return [marked(offer) if mark and offer.is_picture else offer for offer in offered]
