"""What every reader of a mesh shares: triangles as the file has them, numbers, facets of many corners."""

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry import vectors
from feederscrew.heavy import heavy
from feederscrew.units import counted

manifold3d = heavy("manifold3d")

MAX_MESH_BYTES = 1 << 29  # [bytes] of a file, or of what an archive unpacks to
MAX_TEXT_BYTES = 1 << 27  # [bytes] of a mesh in text: six hundred thousand facets of an ASCII STL
MAX_READ_FACETS = 2_000_000  # a hundred times what a fed part needs; checked in less than 3 GB
MAX_READ_CORNERS = 3 * MAX_READ_FACETS  # of facets that share none


@dataclass(frozen=True, eq=False)
class Soup:
    """Triangles as a file has them; corners that coincide are not yet joined."""

    vertices: np.ndarray  # (V, 3) [unit of the file] maybe not finite
    faces: np.ndarray  # (F, 3) int
    format: str  # a key of formats.MESH_FORMATS
    unit: str | None = None  # that the file or its format states
    warnings: tuple[str, ...] = ()
    names: tuple[str, ...] = ()  # of the objects, groups or solids that the file distinguishes; '' for none
    objects: np.ndarray | None = None  # (F,) int, which of ``names`` each facet belongs to


class DamageError(ValueError):
    """What is wrong with damaged bytes, in words for the user."""


class TooManyFacetsError(ValueError):
    """A mesh of more corners or facets than are read."""


def refuse_size(corners: int, facets: int) -> None:
    """Refuse numbers of corners or facets, announced or counted so far, that no fed part needs.

    Raises
    ------
    TooManyFacetsError
        Above ``MAX_READ_CORNERS`` or ``MAX_READ_FACETS``.
    """
    for count, most, noun in ((facets, MAX_READ_FACETS, "facets"), (corners, MAX_READ_CORNERS, "corners")):
        if count > most:
            raise TooManyFacetsError(f"has more than {most} {noun}")


COMMA_NUMBERS = re.compile(rb"(?:[-+]?(?:\d+(?:,\d*)?|,\d+)(?:[eE][-+]?\d+)?\s*)*")
THOUSANDS = re.compile(rb"[-+]?\d{1,3}(?:,\d{3})+")  # thousands, or three decimals
COMMA_WARNING = "its numbers have decimal commas: read as decimal points"


class CommaError(ValueError):
    """Commas that may not stand for decimal points."""


class Decimals:
    """Reads the numbers of one file, and remembers whether they have points or commas."""

    def __init__(self) -> None:
        self.points = self.commas = self.whole = False  # whether there are such, and numbers with neither
        self.grouped = True  # whether every comma has three digits behind it

    def read(self, words: list[bytes]) -> NDArray[np.float64]:
        """Return words as (N,) numbers [unit of the file].

        Raises
        ------
        CommaError
            If there are commas in other places than that of a decimal point, or points in other numbers.
        ValueError
            If a word is not a number.
        """
        text = b" ".join(words)
        if b"_" in text:
            raise DamageError("an underscore in a number")
        self.points = self.points or b"." in text
        if b"," in text:
            self.commas = True
            if not COMMA_NUMBERS.fullmatch(text):
                raise CommaError("a comma in a number")
            self.grouped = self.grouped and all(THOUSANDS.fullmatch(word) for word in words if b"," in word)
            self.whole = self.whole or any(b"," not in word for word in words)
            words = text.replace(b",", b".").split()
        elif words and not self.points:
            self.whole = True
        if self.points and self.commas:
            raise CommaError("numbers with a comma and numbers with a point")
        if self.commas and self.whole and self.grouped:
            raise CommaError("commas that may part thousands or decimals")
        return np.array(words, dtype=float)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to say of the numbers that were read."""
        return (COMMA_WARNING,) if self.commas else ()


POINT_FACET_SIZE = 1e-300  # [unit of the file] a facet smaller than that is a point
STRAIGHT_CORNER_SHARE = 1e-9  # [1] of the facet's area: a corner that turns by less does not make a fan
MAX_FACET_CORNERS = 20_000  # of one facet


def split_facets(
    vertices: NDArray[np.float64], sizes: NDArray[np.int64], corners: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Split facets into triangles, concave ones within their outline.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    sizes : (N,) int
        Corners of each facet.
    corners : (sum of sizes,) int
        Indices into ``vertices``, facet after facet.

    Returns
    -------
    faces : (F, 3) int
        In the order of the facets; those of fewer than three corners give none.
    facet : (F,) int
        The facet that each is from.

    Raises
    ------
    ValueError
        If a facet names a corner that is not there, has too many corners, or its outline crosses itself.
    """
    if len(corners) and (corners.min() < 0 or corners.max() >= len(vertices)):
        raise DamageError("a facet names a corner that is not there")
    if len(sizes) and sizes.max() > MAX_FACET_CORNERS:
        raise DamageError(f"a facet of more than {MAX_FACET_CORNERS} corners")
    start = np.cumsum(sizes) - sizes
    faces, facet = [np.empty((0, 3), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for size in np.unique(sizes[sizes >= 3]).tolist():
        chosen = np.flatnonzero(sizes == size)
        rings = corners[start[chosen][:, None] + np.arange(size)]
        faces.append(_split(vertices, rings).reshape(-1, 3))
        facet.append(np.repeat(chosen, size - 2))
    order = np.argsort(np.concatenate(facet), kind="stable")
    return np.concatenate(faces)[order], np.concatenate(facet)[order]


def split_warning(sizes: NDArray[np.int64], noun: str = "facet") -> tuple[str, ...]:
    """Return what to say where a format of triangles has facets of more corners."""
    more = int((sizes > 3).sum())
    if not more:
        return ()
    kind = "four corners" if set(sizes[sizes > 3].tolist()) == {4} else "more than three corners"
    return (f"{counted(more, noun)} with {kind}: split into triangles",)


def _split(vertices, rings) -> NDArray[np.int64]:
    """(N, S - 2, 3) triangles of N facets of S corners."""
    size = rings.shape[1]
    fan = np.stack([np.zeros(size - 2, dtype=int), np.arange(1, size - 1), np.arange(2, size)], axis=1)
    faces = rings[:, fan]
    if size == 3:
        return faces
    points = np.nan_to_num(vertices[rings], posinf=0.0, neginf=0.0)
    points = points / np.maximum(np.abs(points).max(axis=(1, 2), keepdims=True), POINT_FACET_SIZE)
    points = points - points[:, :1]
    following = np.roll(points, -1, axis=1)
    normals = vectors.cross(points, following).sum(axis=1)  # Newell's: twice the area
    along = following - points
    turns = vectors.cross(np.roll(along, 1, axis=1), along)
    area = vectors.norm(normals)
    rising = np.einsum("nsi,ni->ns", turns, normals)
    concave = ~(rising > STRAIGHT_CORNER_SHARE * area[:, None] ** 2).all(axis=1)
    for ring in np.flatnonzero(concave & (area > 0.0)).tolist():
        faces[ring] = rings[ring][_ears(points[ring], normals[ring] / area[ring])]
    return faces


def _ears(points, normal) -> NDArray[np.int64]:
    """(S - 2, 3) corners of the triangles of one concave facet (S, 3)."""
    across = np.eye(3)[np.argmin(np.abs(normal))]
    first = vectors.cross(normal, across)
    first = first / vectors.norm(first)
    second = vectors.cross(normal, first)
    flat = np.stack([np.einsum("si,i->s", points, axis) for axis in (first, second)], axis=1)
    flat = flat / np.abs(flat).max()  # of a facet with an area
    ears = np.asarray(manifold3d.triangulate([flat]), dtype=np.int64).reshape(-1, 3)
    if len(ears) != len(points) - 2:
        raise DamageError(f"the outline of a facet of {len(points)} corners crosses itself")
    return ears
