"""The gate: from triangles as a file has them to one closed solid, or a line that says why not."""

from dataclasses import dataclass

import numpy as np

from feederscrew.errors import MeshError, SeveralBodiesError
from feederscrew.geometry import vectors
from feederscrew.part import mass
from feederscrew.part.repair import crossings, mend, shells, sight, weld
from feederscrew.part.repair.holes import caps, holes
from feederscrew.part.repair.mend import SOLID

FLAT = 1e-6  # [1] of the size: thinner is not a solid
JOINED = 1e-6  # [1] of the size: corners closer than that are one
LOST, BLURRED = 1e-2, 1e-5  # [1] of the size: steps of single precision that spoil, or dull, the shape
MOST_OPEN = 100_000  # edges: with more it is not a surface with holes
FARTHEST = 1e30  # [unit of the file]
EMPTY = 1e-10  # [1] of the size cubed: less volume is rounding
SHALLOW, DEEP = 1e-4, 2e-2  # [1] of the size: how far facets may pass through others, unsaid and at all
INVERTED = "all facets pointed inwards; reversed"
CLOSE = "close it in CAD, or pass `allow_open` to compute from what there is"
UNITE = "unite what overlaps in CAD, or pass `allow_open` to compute from what there is"
NEARER = "export it near the origin"


@dataclass(frozen=True, eq=False)
class CheckedSurface:
    """One solid's surface, facing outwards, and what it encloses."""

    vertices: np.ndarray  # (V, 3) [unit of the file]
    faces: np.ndarray  # (F, 3) counter-clockwise seen from outside
    solid: mass.Solid  # [powers of the unit of the file]
    open_surface: bool  # or several bodies, with allow_open
    warnings: tuple[str, ...]


def surface(vertices, faces, where, unit, allow_open=False):
    """One solid from loose triangles.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    where : str
        The file, for error lines.
    unit : str
        Of the file, for messages.
    allow_open : bool
        Take an open surface or several bodies as they are, and say so.

    Returns
    -------
    CheckedSurface

    Raises
    ------
    MeshError
        If the triangles bound no volume, do not close, or bound more than one body.
    """
    vertices, faces = _finite(vertices, faces, where, unit)
    facets = len(faces)
    vertices, faces = weld.welded(vertices, faces)
    slivers = _without_area(facets - len(faces))
    size = _size(vertices, faces, where)
    step, blurred = _precision(vertices, size, where, unit)
    vertices, faces, edges, mended = mend.mended(vertices, faces, JOINED * size + 2.0 * step, where)
    arranged = _closed if edges.closed else _opened
    solid, is_open, unseen, said = arranged(vertices, faces, edges, where, unit, allow_open)
    if solid.volume < 0.0:
        faces, solid, said = faces[:, ::-1], solid.reversed, (*said, INVERTED)
    if solid.volume <= EMPTY * size**3:
        raise MeshError(where, "encloses no volume", SOLID)
    if not is_open and len(unseen):
        said += _crossed(vertices, faces[unseen], JOINED * size + 2.0 * step, size, where, unit, allow_open)
    return CheckedSurface(vertices, faces, solid, is_open, slivers + blurred + mended + said)


def _crossed(vertices, faces, tolerance, size, where, unit, allow_open):
    """What to say of a surface that passes through itself; refused where it does so deeply."""
    found = crossings.crossings(vertices, faces, tolerance)
    deepest = float(found.depths.max(initial=0.0))
    if deepest <= SHALLOW * size:
        return ()
    place = ", ".join(f"{x:.4g}" for x in found.points[np.argmax(found.depths)] + 0.0)
    what = (
        f"the surface passes through itself: {_many(len(found.pairs), 'pair')} of facets cut each other, "
        f"the deepest by {deepest:.2g} {unit} at ({place})"
    )
    if deepest > DEEP * size and not allow_open:
        raise MeshError(where, what, UNITE)
    return (f"{what}: what lies inside twice counts twice",)


def _without_area(count):
    """What to say of facets left out because two of their corners are one."""
    return (f"{_many(count, 'facet')} without area removed: two corners in one place",) if count else ()


def _finite(vertices, faces, where, unit):
    """Triangles whose corners are numbers, and not so large that their cubes are none."""
    reach = np.abs(vertices).max(initial=0.0)
    if np.isfinite(reach):
        if reach > FARTHEST:
            raise MeshError(where, f"reaches {reach:.3g} {unit} from the origin", "check its scale")
        return vertices, faces
    bad = ~np.isfinite(vertices).all(axis=1)
    hit = bad[faces].any(axis=1)
    if hit.any():
        what = f"facet {np.argmax(hit) + 1} of {len(faces)} has a corner that is not a finite number"
        raise MeshError(where, what, "export the part again")
    return _finite(*weld.compacted(vertices, faces), where, unit)


def _size(vertices, faces, where):
    """Largest extent; refuses what is all in one plane, line or point."""
    if not len(faces):
        raise MeshError(where, "is a line or a point: no facet has an area", SOLID)
    size = float(np.ptp(np.ascontiguousarray(vertices.T), axis=1).max())
    offsets = (vertices - vertices.mean(axis=0)) / size
    _, axes = vectors.eigen(vectors.product(offsets.T, offsets))
    if np.ptp(vectors.product(offsets, axes[:, 0])) <= FLAT:
        raise MeshError(where, "is flat: all its corners lie in one plane", SOLID)
    return size


def _precision(vertices, size, where, unit):
    """Step between neighbouring numbers of single precision at the part; what to say of it."""
    reach = float(np.abs(vertices).max())
    step = float(np.spacing(np.float32(min(reach, 1e38))))
    if step <= BLURRED * size or not np.array_equal(vertices.astype(np.float32), vertices):
        return min(step, BLURRED * size), ()
    text = f"lies {reach:.4g} {unit} from the origin, where single precision keeps {step:.2g} {unit}"
    if step > LOST * size:
        raise MeshError(where, f"{text}: its shape is lost", NEARER)
    return step, (f"{text}: {NEARER}",)


def _opened(vertices, faces, edges, where, unit, allow_open):
    """What an open surface encloses with its holes filled in."""
    open_edges = int(np.abs(edges.net).sum())
    if open_edges > MOST_OPEN:
        raise MeshError(where, f"the surface is open: {open_edges} edges without a neighbour", SOLID)
    hole = holes(vertices, edges)
    if not allow_open:
        place = ", ".join(f"{x:.4g}" for x in hole.middle + 0.0)
        what = (
            f"the surface is open: {_many(open_edges, 'edge')} without a neighbour round "
            f"{_many(len(hole.rims), 'hole')}, the widest {hole.width:.3g} {unit} across at ({place})"
        )
        raise MeshError(where, what, CLOSE)
    text = f"the surface is open: {_many(len(hole.rims), 'hole')} filled in for these numbers (`allow_open`)"
    solid = mass.solid(np.concatenate([vertices[faces], caps(vertices, hole.rims)]))
    return solid, True, (), (text,)


def _closed(vertices, faces, edges, where, unit, allow_open):
    """What a closed surface encloses, cavities taken off; and which of its facets may cut others.

    A surface that an axis sees whole is one shell.
    """
    solid = mass.solid(vertices[faces])
    unseen = sight.unseen(
        vertices, *((faces[:, ::-1], solid.reversed) if solid.volume < 0.0 else (faces, solid))
    )
    if not len(unseen):
        return solid, False, unseen, ()
    number, shell = shells.shells(edges, faces)
    if number == 1:
        return solid, False, unseen, ()
    volume = np.bincount(shell, mass.tetrahedra(vertices[faces]))
    outwards = np.sign(volume[np.argmax(np.abs(volume))])
    fault = shells.fault(vertices, faces[:, :: int(outwards) or 1], shell, outwards * volume, unit)
    if fault is None:
        return solid, False, unseen, ()
    if not allow_open:
        several = fault[1] in (shells.SPLIT, shells.INNER)
        raise (SeveralBodiesError if several else MeshError)(where, *fault)
    return solid, True, unseen, (f"{fault[0]}: taken together as one part (`allow_open`)",)


def _many(count, noun):
    return f"{count} {noun}{'s' if count != 1 else ''}"
