"""Several bodies in one file: counted in their order, named as the file names them, and one of them taken."""

import re
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from feederscrew.errors import ArgumentError, MeshError
from feederscrew.geometry import graphs
from feederscrew.part import mass
from feederscrew.part.reading.soup import Soup
from feederscrew.part.repair import edges as repair_edges
from feederscrew.part.repair import shells, weld
from feederscrew.part.repair.gate import FARTHEST
from feederscrew.units import quantity_text

CRACK_SHARE = 1e-4  # [1] of the size: open surfaces whose rims are closer are of one body
MOST_RIM = 200_000  # corners of open rims that are looked at
MOST_NESTED = 1_000  # closed surfaces that are looked at for cavities of others
PROBES = 5  # corners of a surface that say whether it lies within another
LISTED = 12  # bodies that a refusal lists
LARGEST = "largest"
NUMBER = re.compile(r"[0-9]{1,9}")
GIVE = "give the number or the name of one, or largest"
TAKE = "take one with `body` (its number, its name, or largest)"


@dataclass(frozen=True, eq=False)
class FileBody:
    """One body of a file, its cavities with it."""

    number: int  # from 1, in the order of the file
    name: str  # that the file gives it, '' for none
    volume: float  # [cubed unit of the file]
    size: tuple[float, float, float]  # [unit of the file] along the file's axes
    facets: NDArray[np.int64]  # indices into the facets of the file

    def text(self, unit: str) -> str:
        """Return the body as a person reads it in a list: '2 'pin' (64 mm3, 4 x 4 x 4 mm)'."""
        name = f" {quantity_text(self.name)}" if self.name else ""
        size = " x ".join(f"{length:.4g}" for length in self.size)
        return f"{self.number}{name} ({self.volume:.4g} {unit}3, {size} {unit})"


def bodies(soup: Soup) -> tuple[FileBody, ...]:
    """Return the bodies of a file, in the order of their first facets.

    Parameters
    ----------
    soup : Soup

    Returns
    -------
    tuple of FileBody
        What touches along edges is one body, unless the file has it as closed objects. A closed surface
        within a body that faces the other way is its cavity. Open surfaces that nearly meet are one body.
    """
    points = np.nan_to_num(soup.vertices, posinf=0.0, neginf=0.0)
    points[np.abs(points) > FARTHEST] = 0.0  # what is not finite, the gate names
    first, group = weld.distinct(points)
    points, faces = points[first], group[soup.faces]
    a, b, c = faces.T
    facets = np.flatnonzero((a != b) & (b != c) & (c != a))
    if not len(facets):
        return ()
    faces = faces[facets]
    number, shell, is_open = _shells(points, faces, None if soup.objects is None else soup.objects[facets])
    volume = np.bincount(shell, mass.tetrahedra(points[faces]), minlength=number)
    low, high = _boxes(points, faces, shell, number)
    of_body = _with_cavities(points, faces, shell, np.where(is_open, 0.0, volume), low, high)
    found: list[FileBody] = []
    for one in dict.fromkeys(of_body[shell].tolist()):
        own = np.flatnonzero(of_body == one)
        mine = np.flatnonzero(np.isin(shell, own))
        size = high[own].max(axis=0) - low[own].min(axis=0)
        found.append(
            FileBody(
                len(found) + 1,
                _name(soup, facets[mine]),
                abs(float(volume[own].sum())),
                tuple(size.tolist()),
                facets[mine],
            )
        )
    return tuple(found)


def taken(soup: Soup, body: str, where: str, unit: str) -> tuple[Soup, FileBody | None]:
    """Take one body of a file.

    Parameters
    ----------
    soup : Soup
    body : str
        Its number from 1, its name, or 'largest'.
    where : str
        The file, for error lines.
    unit : str
        Of the file.

    Returns
    -------
    soup : Soup
        The facets of that body.
    body : FileBody or None
        None where the file holds no other.

    Raises
    ------
    ArgumentError
        If there is no such body; the line lists those there are.
    """
    known = bodies(soup)
    if not known:
        return soup, None
    one = _chosen(known, body.strip(), where, unit)
    if len(known) == 1:
        return soup, None
    rest = "the other one is" if len(known) == 2 else f"the {len(known) - 1} others are"
    warning = f"body {one.text(unit)} of {len(known)} is taken: {rest} left out"
    objects = None if soup.objects is None else soup.objects[one.facets]
    faces = soup.faces[one.facets]
    used, own = np.unique(faces, return_inverse=True)
    return (
        replace(
            soup,
            vertices=soup.vertices[used],
            faces=own.reshape(-1, 3),
            objects=objects,
            warnings=(*soup.warnings, warning),
        ),
        one,
    )


def refusal(fault: MeshError, soup: Soup, unit: str) -> MeshError:
    """Return the fault of a file of several bodies with a list of them, and how to take one."""
    known = bodies(soup)
    if len(known) < 2:
        return fault
    what = fault.what.partition(", of ")[0] if fault.what.startswith("holds ") else fault.what
    what = f"holds {len(known)} bodies" if fault.what.startswith("holds ") else what
    return MeshError(fault.where, f"{what}: {_list(known, unit)}", f"{TAKE}, {fault.mend}")


def _list(known, unit):
    more = f", and {len(known) - LISTED} more" if len(known) > LISTED else ""
    return ", ".join(body.text(unit) for body in known[:LISTED]) + more


def _chosen(known, body, where, unit):
    """The body that is meant."""
    if not body:
        raise ArgumentError("body", "is empty", GIVE)
    if body.lower() == LARGEST:
        return max(known, key=lambda one: one.volume)
    if NUMBER.fullmatch(body):
        if 1 <= int(body) <= len(known):
            return known[int(body) - 1]
        named = []
    else:
        named = [one for one in known if one.name == body]
        named = named or [one for one in known if one.name.strip().lower() == body.lower() and body]
    if len(named) == 1:
        return named[0]
    if named:
        numbers = " and ".join(str(one.number) for one in named)
        raise ArgumentError(
            "body", f"{quantity_text(body)} is the name of bodies {numbers}", "give its number"
        )
    raise ArgumentError(
        "body", f"there is no body {quantity_text(body)}: {where} holds {_list(known, unit)}", GIVE
    )


def _shells(points, faces, objects):
    """How many surfaces hang together, the one of each facet, and whether each is open."""
    keys = faces
    if objects is not None and objects.max(initial=0) > 0:
        apart = faces * (int(objects.max()) + 1) + objects[:, None]
        _, keys = np.unique(apart, return_inverse=True)
        keys = keys.reshape(-1, 3)
        if not repair_edges.table(keys, int(keys.max()) + 1).closed:
            keys = faces  # objects that close only together
    edges = repair_edges.table(keys, int(keys.max()) + 1)
    number, shell = shells.shells(edges, keys)
    rim = np.repeat(edges.net != 0, edges.count)
    is_open = np.zeros(number, dtype=bool)
    is_open[shell[edges.order[rim] // 3]] = True
    if is_open.sum() < 2:
        return number, shell, is_open
    sides = edges.order[rim]
    corners, of_shell = faces.ravel()[sides], shell[sides // 3]
    if len(corners) > MOST_RIM:
        return number, shell, is_open
    from scipy.spatial import cKDTree

    used = np.unique(faces)
    reach = CRACK_SHARE * float(np.ptp(points[used], axis=0).max())
    ends = np.concatenate([corners, np.roll(faces, -1, axis=1).ravel()[sides]])
    tree = cKDTree(points[ends])
    if tree.count_neighbors(tree, reach) > weld.MOST_PAIRS:
        return number, shell, is_open
    i, j = tree.query_pairs(reach, output_type="ndarray").T
    both = np.concatenate([of_shell, of_shell])
    count, group = graphs.components(both[i], both[j], number)
    merged = np.zeros(count, dtype=bool)
    merged[group[is_open]] = True
    return count, group[shell], merged


def _boxes(points, faces, shell, number):
    """(N, 3) lowest and highest corner of each surface."""
    low, high = np.full((number, 3), np.inf), np.full((number, 3), -np.inf)
    for corner in range(3):
        np.minimum.at(low, shell, points[faces[:, corner]])
        np.maximum.at(high, shell, points[faces[:, corner]])
    return low, high


def _with_cavities(points, faces, shell, volume, low, high):
    """(N,) the surface that stands for the body of each: itself, or what it is a cavity of."""
    number = len(volume)
    of_body = np.arange(number)
    if not 1 < number <= MOST_NESTED:
        return of_body
    around: list[list[int]] = []
    for k in range(number):
        boxed = (low <= low[k]).all(axis=1) & (high >= high[k]).all(axis=1) & (volume != 0.0)
        boxed[k] = False
        own = np.unique(faces[shell == k])
        probes = points[own[:: -(-len(own) // PROBES)]]
        around.append(
            [j for j in np.flatnonzero(boxed).tolist() if _within(probes, points[faces[shell == j]])]
        )
    is_cavity = np.zeros(number, dtype=bool)
    for k in sorted(range(number), key=lambda k: len(around[k])):
        if not around[k] or volume[k] == 0.0:
            continue
        parent = max(around[k], key=lambda j: len(around[j]))
        if not is_cavity[parent] and volume[parent] * volume[k] < 0.0:
            is_cavity[k], of_body[k] = True, parent
    return of_body


def _within(probes, triangles):
    turns = [abs(shells.winding(point, triangles)) for point in probes]
    return sum(turn > 0.5 for turn in turns) * 2 > len(turns)


def _name(soup, facets):
    """The name of the object that most of a body's facets are of."""
    if soup.objects is None or not soup.names:
        return ""
    return soup.names[int(np.argmax(np.bincount(soup.objects[facets], minlength=1)))]
