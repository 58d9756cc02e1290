"""The gate: from triangles as a file has them to one closed solid, or a line that says why not."""

from dataclasses import dataclass

import numpy as np

from feederscrew.errors import MeshError, SeveralBodiesError
from feederscrew.geometry import vectors
from feederscrew.part import mass
from feederscrew.part.repair import bodies, cracks, crossings, mend, shells, sight, weld
from feederscrew.part.repair.edges import table
from feederscrew.part.repair.holes import caps, holes
from feederscrew.part.repair.mend import SOLID

FLAT = 1e-6  # [1] of the size: thinner is not a solid
JOINED = 1e-6  # [1] of the size: corners closer than that are one
LOST, BLURRED = 1e-2, 1e-5  # [1] of the size: steps of single precision that spoil, or dull, the shape
MOST_OPEN = 100_000  # edges: with more it is not a surface with holes
FARTHEST = 1e30  # [unit of the file]
EMPTY = 1e-10  # [1] of the size cubed: less volume is rounding
OVERLAP_SHARE = 1e-6  # [1] of the hull's volume: more than the hull by so much is rounding
LEAST_SHARE, OPEN_LEAST_SHARE = 1e-5, 1e-3  # [1] of the hull's volume that a part fills, closed or not
LOOSE_SHARE = 1e-3  # [1] of the area: so much may lie back to back where holes are filled
ROUNDING = 1e-9  # [1] of the largest: what rounding does to moments
SHALLOW, DEEP = 1e-4, 2e-2  # [1] of the size: how far facets may pass through others, unsaid and at all
INVERTED = "all facets pointed inwards; reversed"
CLOSE = "close it in CAD, or pass `allow_open` to compute from what there is"
SEW = "join (sew, stitch) its faces in CAD and export one solid"
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
    tolerance = JOINED * size + 2.0 * step
    loose = vertices, faces
    vertices, faces, edges, mended = mend.mended(vertices, faces, tolerance, where)
    joined = None if edges.closed else cracks.join_cracks(vertices, faces, tolerance, size, where, allow_open)
    if not edges.closed and (joined is None or not joined.edges.closed):
        # Cracks about as wide as the tolerance are half joined: the rest then closes from the start only.
        corners, sides, _, said = mend.mended(*loose, tolerance, where, corners=False)
        whole = cracks.join_cracks(corners, sides, tolerance, size, where)
        joined, mended = (joined, mended) if whole is None else (whole, said)
    if joined is not None:
        vertices, faces, edges = joined.vertices, joined.faces, joined.edges
        mended, tolerance = (*mended, _joined(joined, unit)), max(tolerance, joined.width)
    if edges.closed:
        surface, unseen = _closed(vertices, faces, edges, where, unit, allow_open)
    else:
        surface, unseen = _opened(vertices, faces, edges, size, where, unit, allow_open), ()
    vertices, faces, solid, is_open, said = surface
    is_open = is_open or (joined is not None and joined.width > cracks.JOIN_SHARE * size)
    if solid.volume < 0.0:
        faces, solid, said = faces[:, ::-1], solid.reversed, (*said, INVERTED)
    if solid.volume <= EMPTY * size**3:
        raise MeshError(where, "encloses no volume", SOLID)
    if len(unseen):
        said += _crossed(vertices, faces[unseen], tolerance, size, where, unit, allow_open)
    _refuse_impossible(solid, vertices, where, unit)
    return CheckedSurface(vertices, faces, solid, is_open, slivers + blurred + mended + said)


def check_hull(surface, hull_volume, where, unit):
    """Refuse a surface that encloses more than its convex hull does, or less of it than any part.

    Parameters
    ----------
    surface : CheckedSurface
    hull_volume : float [cubed unit of the file]
    where, unit : str
        The file and its unit, for the line.

    Raises
    ------
    MeshError
        A wire of 0.3 mm along three edges of a cube of 100 mm fills 1.3e-4 of its hull; a surface whose
        facets hang together nowhere fills what rounding leaves.
    """
    volume = surface.solid.volume
    if volume > hull_volume * (1.0 + OVERLAP_SHARE):
        what = f"its volume, {volume:.4g} {unit}3, is more than its convex hull's, {hull_volume:.4g}"
        raise MeshError(where, f"{what}: facets overlap", "unite the overlapping bodies in CAD")
    if volume < (OPEN_LEAST_SHARE if surface.open_surface else LEAST_SHARE) * hull_volume:
        what = (
            f"encloses {volume:.3g} {unit}3, {volume / hull_volume:.1g} of its convex hull: that is no solid"
        )
        raise MeshError(where, what, SEW)


def _refuse_impossible(solid, vertices, where, unit):
    """Refuse second moments that no mass within the part's corners has: facets are missing or overlap."""
    moments, _ = mass.principal(solid.inertia)
    spreads = vectors.eigen(0.5 * np.trace(solid.inertia) * np.eye(3) - solid.inertia)[0] / solid.volume
    reach = np.square(vertices - solid.centre).sum(axis=1).max()  # no mass is further off than a corner
    if spreads[0] >= -ROUNDING * spreads[2] and spreads.sum() <= (1.0 + ROUNDING) * reach:
        return
    text = ", ".join(f"{moment:.3g}" for moment in moments)
    what = f"no body has the principal moments {text} {unit}5 (at density 1): facets are missing or overlap"
    raise MeshError(where, what, SOLID)


def _joined(joined, unit):
    """What to say of cracks that were joined."""
    pieces = [_many(joined.corners, "corner")] if joined.corners else []
    pieces += [_many(joined.seams, "edge")] if joined.seams else []
    return f"cracks up to {joined.width:.2g} {unit} wide between facets: {' and '.join(pieces)} joined"


def _crossed(vertices, faces, tolerance, size, where, unit, allow_open):
    """What to say of a surface that passes through itself; refused where it does so deeply."""
    found = crossings.crossings(vertices, faces, tolerance)
    deepest = float(found.depths.max(initial=0.0))
    if deepest <= SHALLOW * size:
        return ()
    place = _place(found.points[np.argmax(found.depths)])
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


def _opened(vertices, faces, edges, size, where, unit, allow_open):
    """What an open surface encloses with its holes filled in."""
    open_edges = int(np.abs(edges.net).sum())
    if open_edges > MOST_OPEN:
        raise MeshError(where, f"the surface is open: {open_edges} edges without a neighbour", SOLID)
    hole = holes(vertices, edges)
    if not allow_open:
        raise MeshError(where, *_gaps(vertices, edges, hole, open_edges, size, unit))
    said = (
        f"the surface is open: {_many(len(hole.rims), 'hole')} filled in for these numbers (`allow_open`)",
    )
    capped = np.concatenate([vertices[faces], caps(vertices, hole.rims)])
    filled, facets = weld.welded(capped.reshape(-1, 3), np.arange(3 * len(capped)).reshape(-1, 3))
    if not len(facets):
        raise MeshError(where, "encloses no volume", SOLID)
    closed = table(facets, len(filled))
    gaps = cracks.measure_gaps(vertices, edges, size)
    if gaps.cracks and cracks.folded_share(filled, facets, closed) > LOOSE_SHARE:
        what = (
            f"its facets hang loose: {gaps.cracks} open edges run along cracks up to {gaps.width:.2g} {unit} "
            "wide, which cannot be joined without loss of what is as thin"
        )
        raise MeshError(where, what, SEW)
    number, shell = shells.shells(closed, facets)
    if number == 1:
        return vertices, faces, mass.solid(capped), True, said
    several = _as_bodies(filled, facets, shell, where, unit, allow_open)
    if several is None:
        return vertices, faces, mass.solid(capped), True, said
    solid = mass.solid(several.vertices[several.faces])
    return several.vertices, several.faces, solid, True, (*said, *several.warnings)


def _as_bodies(vertices, faces, shell, where, unit, allow_open):
    """Several closed surfaces as bodies taken together; None where they are one body and its cavities."""
    volume = np.bincount(shell, mass.tetrahedra(vertices[faces])).astype(float)
    empty = np.abs(volume) <= EMPTY * np.abs(volume).max()
    if empty.any():  # a loose facet and its own cap
        shell = np.where(empty, -1, np.cumsum(~empty) - 1)[shell]
        faces, shell, volume = faces[shell >= 0], shell[shell >= 0], volume[~empty]
    if len(volume) < 2:
        return None
    outwards = np.sign(volume[np.argmax(np.abs(volume))])
    fault = shells.fault(vertices, faces[:, :: int(outwards) or 1], shell, outwards * volume, unit)
    if fault is None:
        return None
    if not allow_open:
        several = fault[1] in (shells.SPLIT, shells.INNER)
        raise (SeveralBodiesError if several else MeshError)(where, *fault)
    return bodies.take_together(vertices, faces, shell, volume, where, unit)


def _gaps(vertices, edges, hole, open_edges, size, unit):
    """What to say of open edges and how to mend them: how wide the cracks between them are, or the holes."""
    edges_text = f"the surface is open: {_many(open_edges, 'edge')} without a neighbour"
    gaps = cracks.measure_gaps(vertices, edges, size)
    crack = f"cracks up to {gaps.width:.2g} {unit} wide, the widest at ({_place(gaps.place)})"
    if not gaps.others:
        limits = f"up to {cracks.JOIN_SHARE * size:.2g} {unit} they are joined where no wall is as thin"
        mend = f"{SEW}, or pass `allow_open` to join up to {cracks.OPEN_JOIN_SHARE * size:.2g} {unit}"
        return f"{edges_text} along {crack}; {limits}", mend
    if gaps.cracks:
        return f"{edges_text}, {gaps.cracks} of them along {crack}, the others round holes", CLOSE
    holes_text = f"round {_many(len(hole.rims), 'hole')}, the widest {hole.width:.3g} {unit} across"
    return f"{edges_text} {holes_text} at ({_place(hole.middle)})", CLOSE


def _place(point):
    return ", ".join(f"{x:.4g}" for x in np.asarray(point) + 0.0)


def _closed(vertices, faces, edges, where, unit, allow_open):
    """A closed surface and what it encloses, cavities taken off; and which of its facets may cut others.

    A surface that an axis sees whole is one shell.
    """
    solid = mass.solid(vertices[faces])
    unseen = sight.unseen(
        vertices, *((faces[:, ::-1], solid.reversed) if solid.volume < 0.0 else (faces, solid))
    )
    single = (vertices, faces, solid, False, ())
    if not len(unseen):
        return single, unseen
    number, shell = shells.shells(edges, faces)
    if number == 1:
        return single, unseen
    several = _as_bodies(vertices, faces, shell, where, unit, allow_open)
    if several is None:
        return single, unseen
    solid = mass.solid(several.vertices[several.faces])
    unseen = np.arange(len(several.faces))
    return (several.vertices, several.faces, solid, True, several.warnings), unseen


def _many(count, noun):
    return f"{count} {noun}{'s' if count != 1 else ''}"
