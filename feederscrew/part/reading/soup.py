"""What every reader of a mesh hands on: triangles as the file has them, and how many it may have."""

from dataclasses import dataclass

import numpy as np

LARGEST = 1 << 29  # [bytes] of a file, or of what an archive unpacks to
LARGEST_TEXT = 1 << 27  # [bytes] of a mesh in text: six hundred thousand facets of an ASCII STL
MOST_FACETS = 2_000_000  # a hundred times what a fed part needs; checked in less than 3 GB
MOST_CORNERS = 3 * MOST_FACETS  # of facets that share none


@dataclass(frozen=True, eq=False)
class Soup:
    """Triangles as a file has them; corners that coincide are not yet joined."""

    vertices: np.ndarray  # (V, 3) [unit of the file] maybe not finite
    faces: np.ndarray  # (F, 3) int
    format: str  # a key of read_format.FORMATS
    unit: str | None = None  # that the file or its format states
    warnings: tuple[str, ...] = ()
    names: tuple[str, ...] = ()  # of the objects, groups or solids that the file distinguishes; '' for none
    objects: np.ndarray | None = None  # (F,) int, which of ``names`` each facet belongs to


class DamageError(ValueError):
    """What is wrong with damaged bytes, in words for the user."""


class TooManyFacetsError(ValueError):
    """A mesh of more corners or facets than are read."""


def refuse_crowds(corners: int, facets: int) -> None:
    """Refuse numbers of corners or facets, announced or counted so far, that no fed part needs.

    Raises
    ------
    TooManyFacetsError
        Above ``MOST_CORNERS`` or ``MOST_FACETS``.
    """
    for count, most, noun in ((facets, MOST_FACETS, "facets"), (corners, MOST_CORNERS, "corners")):
        if count > most:
            raise TooManyFacetsError(f"has more than {most} {noun}")
