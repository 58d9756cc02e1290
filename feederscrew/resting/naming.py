"""Names of the rows of aspects: letters by rank, or those a user has given, found again by direction."""

import itertools
from string import ascii_uppercase

import numpy as np

from feederscrew.errors import ConfigError
from feederscrew.geometry import vectors
from feederscrew.resting.basins.landscape import angle

REACH = {"flat": np.radians(3.0), "rolling": np.radians(15.0)}  # off its direction an aspect is the one named
EXACT = np.radians(0.05)  # a direction closer than this to an aspect means that one


def named(groups, normals, hull, given):
    """Name the classes of aspects.

    Source: own; docs/resting.md, "Names that stay".

    Parameters
    ----------
    groups : sequence of lists of Face
        The faces of each class, classes in the order of the rows.
    normals : (A, 3) float [1]
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
    place: dict[int, int] = {}
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
