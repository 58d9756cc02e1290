"""Names of the rows of aspects: letters by rank, or those a user has given, found again by direction."""

import itertools
from os import PathLike
from pathlib import Path
from string import ascii_uppercase
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.errors import ArgumentError, ConfigError, FeederError
from feederscrew.geometry import vectors
from feederscrew.part.record import Part
from feederscrew.resting.basins.landscape import angle
from feederscrew.units import one_line

if TYPE_CHECKING:
    from feederscrew.resting.aspects import Aspects

REACH = {"flat": np.radians(3.0), "rolling": np.radians(15.0)}  # off its direction an aspect is the one named
EXACT = np.radians(0.05)  # a direction closer than this to an aspect means that one


def named(groups, normals, hull, given):
    """Name the classes of aspects.

    Parameters
    ----------
    groups : sequence of lists of Face
        The faces of each class, classes in the order of the rows.
    normals : (A, 3) float
        What is down when the part rests on each.
    hull : Hull
    given : AspectNames or None
        Names with the direction that is down on each; what has none takes the first letter that is free.

    Returns
    -------
    names : tuple of str
        One a class.
    said : tuple of str
        Names that fit no aspect, and aspects that got none of the names; a sentence each.

    Raises
    ------
    ConfigError
        If a name fits two aspects and is of neither.
    """
    if given is None:
        return tuple(letters(k) for k in range(len(groups))), ()
    apart = np.column_stack([_apart(faces, hull, given) for faces in groups])
    place = _matched(apart)
    _refuse_doubtful(given, apart, place)
    names = {row: given.names[k] for k, row in place.items()}
    taken = {name.casefold() for name in given.names}
    free = (name for name in map(letters, itertools.count()) if name.casefold() not in taken)
    every = tuple(names[row] if row in names else next(free) for row in range(len(groups)))
    fresh = [row for row, faces in enumerate(groups) if row not in names and faces[0].stable]
    said = [_unmatched(given, apart, place, k) for k in range(len(given.names)) if k not in place]
    said += [
        f"{given.source} has no name for the aspect with {_told(normals[row])} down: it is called "
        f"{every[row]}"
        for row in fresh
    ]
    return every, tuple(said)


def text(part, found):
    """Return the names of a part's stable aspects as the text of the file that ``aspect_names.read`` takes.

    Parameters
    ----------
    part : Part
        From a mesh.
    found : Aspects
        Of that part.
    """
    rows = np.flatnonzero(found.stable)
    return "\n".join(
        [
            f"# Aspects of {one_line(part.name)}: which direction of its file is down on each.",
            "# Change a name and leave its direction, then give this file as the names of the part.",
            "aspects:",
            *(f"  {found.names[row]}: [{', '.join(f'{x:.7g}' for x in found.normals[row])}]" for row in rows),
            "",
        ]
    )


def write_names(part: Part, found: "Aspects", path: str | PathLike[str]) -> None:
    """Write the names of a part's aspects to a file that ``load`` takes as ``names``.

    Parameters
    ----------
    part : Part
        From a mesh.
    found : Aspects
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
        Path(path).write_text(text(part, found), encoding="utf-8")
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
        raise FeederError(path, what, "give another path") from None


def letters(k):
    """Return A, B ... Z, AA, AB ... for 0, 1 ..."""
    name = ""
    while k >= 0:
        name = ascii_uppercase[k % 26] + name
        k = k // 26 - 1
    return name


def _apart(faces, hull, given):
    """(names,) [rad] from each direction given to the nearest of a class; infinite out of reach."""
    down = np.array([direction for _, direction in given.directions])
    own = [hull.normals[face.triangles] if face.kind == "rolling" else face.normal[None] for face in faces]
    nearest = angle(down[:, None], np.concatenate(own)[None]).min(axis=1)
    within = faces[0].stable & (nearest <= REACH[faces[0].kind])
    return np.where(within, nearest, np.inf)


def _matched(apart):
    """Class by name: the nearest two first, each once."""
    place = {}
    for k, row in zip(*np.unravel_index(np.argsort(apart, axis=None, kind="stable"), apart.shape)):
        if np.isfinite(apart[k, row]) and k not in place and row not in place.values():
            place[int(k)] = int(row)
    return place


def _unmatched(given, apart, place, k):
    """What to say of a name that fits no aspect of its own."""
    name, down = given.directions[k]
    row = int(np.argmin(apart[k]))
    if not np.isfinite(apart[k, row]):
        return f"{given.source}: the part rests on no aspect {name!r} ({_told(down)} down)"
    other = next(given.names[m] for m, at in place.items() if at == row)
    return f"{given.source}: {name!r} is one aspect with {other!r} and goes by that name"


def _refuse_doubtful(given, apart, place):
    """Refuse a name that is off its own aspect while another is within reach: either may be meant."""
    for k, row in place.items():
        rest = np.delete(apart[k], row)
        if apart[k, row] >= EXACT and np.isfinite(rest).any():
            off = " and ".join(f"{np.degrees(one):.2g}" for one in (apart[k, row], rest.min()))
            what = f"the direction of {given.names[k]!r} is {off} deg off two aspects of the part"
            raise ConfigError(given.source, what, "write the direction of the one that is meant")


def _told(direction):
    return ", ".join(f"{x + 0.0:.3g}" for x in vectors.unit(np.asarray(direction)).round(4))
