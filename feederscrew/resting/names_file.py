"""A part's aspects as a file of names, which a user changes and gives back."""

from os import PathLike
from pathlib import Path

import numpy as np

from feederscrew.errors import ArgumentError, FeederError
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.units import one_line


def text(part, aspects) -> str:
    """Return the names of a part's stable aspects as the text of the file that ``aspect_names.read`` takes.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    """
    rows = np.flatnonzero(aspects.stable)
    return "\n".join(
        [
            f"# Aspects of {one_line(part.name)}: which direction of its file is down on each.",
            "# Change a name and leave its direction, then give this file as the names of the part.",
            "aspects:",
            *(
                f"  {aspects.names[row]}: [{', '.join(f'{x:.7g}' for x in aspects.normals[row])}]"
                for row in rows
            ),
            "",
        ]
    )


def write_names(part: Part, aspects: Aspects, path: str | PathLike[str]) -> None:
    """Write the names of a part's aspects to a file that ``load`` takes as ``names``.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    path : str or Path
        Of the file, written anew: change a name there and leave its direction.

    Raises
    ------
    FeederError
        If the part is a card, which has its own names, or the file cannot be written.
    """
    if part.vertices is None:
        raise ArgumentError("part", "a part card has its own names", "give a mesh")
    try:
        Path(path).write_text(text(part, aspects), encoding="utf-8")
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
        raise FeederError(path, what, "give another path") from None
