"""The mark on every drawing and solid of a bowl whose trial falls short, or holds under a condition."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.base.arrays import Vector
from feederscrew.bowl.verified import Status, Verified
from feederscrew.output import offers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARK = "FALLS SHORT - not for manufacture"
CONDITION_MARK = Status.HOLDS_SINGLE.upper()  # of what may be built, and holds under a condition only
MARK_COLOUR, STRENGTH = "#d40000", 0.45  # of the letters, and how much they hide [1]
DIAGONAL_SHARE, SIDE_SHARE = 0.75, 0.88  # [1] of the diagonal and the longer side that a mark takes at most
STEP_HEAD = re.compile(rb"(FILE_DESCRIPTION\(\('[^']*)'")
STEP_PRODUCT = re.compile(rb"(PRODUCT\('[^']*)','([^']*)'")  # its number and its name


@dataclass(frozen=True)
class SheetFields:
    """Fields of the title block that the user gives; '' stays empty: the same input gives the same bytes."""

    date: str = ""
    revision: str = ""


def of_trial(trial: Verified | None, mark: str | None = None) -> str:
    """Return the mark of a bowl whose trial falls short or holds under a condition.

    Parameters
    ----------
    trial : Verified or None
    mark : str, optional
        Stands in its place.

    Returns
    -------
    str
        '' of any other.
    """
    if mark is not None or trial is None:
        return mark or ""
    return {Status.FALLS_SHORT: MARK, Status.HOLDS_SINGLE: CONDITION_MARK}.get(Status(trial.status), "")


def marked_title(text: str, mark: str) -> str:
    """Return the name of a body or the title of a file with a mark: 'bowl - FALLS SHORT - ...'.

    Parameters
    ----------
    text, mark : str

    Returns
    -------
    str
    """
    return f"{text} - {mark}" if mark else text


def file_name(name: str, mark: str) -> str:
    """Return the name of a solid's file: 'bowl_falls_short.stl' of what falls short.

    That is all that a slicer shows. What holds under a condition keeps its name: it may be built.

    Parameters
    ----------
    name, mark : str

    Returns
    -------
    str
    """
    path = PurePosixPath(name)
    return name if mark in ("", CONDITION_MARK) else f"{path.stem}_falls_short{path.suffix}"


def mark_step(data: bytes, *words: str) -> bytes:
    """Return a STEP file whose head and products bear words, in letters of ASCII without an apostrophe.

    Parameters
    ----------
    data : bytes
    *words : str
        A mark; what the shop must do. Empty ones are left out.

    Returns
    -------
    bytes
    """
    said = [each for each in words if each]
    if not said:
        return data
    end = f" - {' - '.join(said)}'".encode("ascii")
    data = STEP_HEAD.sub(rb"\1" + end, data)
    return STEP_PRODUCT.sub(rb"\1" + end + rb",'\2" + end, data)


def diagonal(sheet: Sequence[float] | Vector, mark: str) -> tuple[float, float]:
    """Return how a mark stands from corner to corner of a sheet.

    Parameters
    ----------
    sheet : (float, float) [any length]
        Width and height.
    mark : str

    Returns
    -------
    size : float [any length]
        Of its letters.
    turn : float [rad]
    """
    length = min(DIAGONAL_SHARE * float(np.hypot(*sheet)), SIDE_SHARE * max(sheet))
    width = 0.62  # of a bold letter over its size, in the mean
    return length / (width * len(mark)), float(np.arctan2(sheet[1], sheet[0]))


def mark_figure(figure: "Figure | None", mark: str) -> "Figure | None":
    """Write a mark from corner to corner of a figure, and return it.

    Parameters
    ----------
    figure : matplotlib.figure.Figure or None
    mark : str
        '' leaves it as it is.

    Returns
    -------
    matplotlib.figure.Figure or None
        The figure given.
    """
    if figure is None or not mark:
        return figure
    canvas: Any = figure.canvas
    image = getattr(canvas, "image", None)
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
    canvas.image = np.rint(mixed).astype(np.uint8)
    return figure


def _write(figure: "Figure", mark: str) -> None:
    size, turn = diagonal(figure.get_size_inches(), mark)
    figure.text(
        0.5,
        0.5,
        mark,
        fontsize=72.0 * size,
        rotation=np.degrees(turn),
        ha="center",
        va="center",
        rotation_mode="anchor",
        fontweight="bold",
        color=MARK_COLOUR,
        alpha=STRENGTH,
        zorder=100,
    ).set_in_layout(False)


def pictures(files: Iterable[offers.Offer], mark: str) -> list[offers.Offer]:
    """Return offers whose pictures bear a mark; the others as they are.

    Parameters
    ----------
    files : iterable of Offer
    mark : str

    Returns
    -------
    list of Offer
    """

    def mark_picture(offer: offers.Offer) -> offers.Offer:
        return offers.picture(
            offer.name, f"{offer.alt} ({mark})", lambda: mark_figure(offer.view and offer.view(), mark)
        )

    return [mark_picture(offer) if mark and offer.is_picture else offer for offer in files]
