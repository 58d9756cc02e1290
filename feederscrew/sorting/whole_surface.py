"""The surface of a body in single precision: closed, no facet without an area, no two corners at one place.

Each edge has two facets by the places of its ends alone, as readers of STL see it. Where two sheets of a
surface touch, in a corner or along an edge, their corners are moved apart, each into its own sheet.
"""

import contextlib
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints, Points, Triangles
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.graphs import components
from feederscrew.base.units import MM

SIMPLER = 0.0, 1e-5, 2e-4, 2e-3  # [mm] corners nearer than this become one: the first that closes
MIN_VOID_VOLUME_MM3 = 1.0  # [mm3] a film of air that closes in itself, or a piece, smaller is left out
VOLUME_ROUNDING = 1e-6  # of a volume: by that and a crumb at most may rounding change it
MERGE_DISTANCE_MM = 2e-4  # [mm] corners nearer are at one place; readers of STL unite what lies within 1e-5
SEPARATION_MM = 1e-3  # [mm] by which corners that meet are moved apart
MAX_MERGE_ROUNDS = 60


def mesh(body: Any) -> tuple[Points, Triangles]:
    """Return the surface of a Manifold, the same however it was made.

    Parameters
    ----------
    body : manifold3d.Manifold [mm]

    Returns
    -------
    vertices : (V, 3) float [m]
        Numbers that single precision holds in millimetres, no two nearer than 2e-4 mm.
    faces : (F, 3) int
        Counter-clockwise seen from outside.

    Raises
    ------
    FeederError
        If sheets of the surface that touch cannot be told apart.
    """
    for simpler in SIMPLER[:-1]:
        with contextlib.suppress(FeederError):
            return _surface(body, simpler)
    return _surface(body, SIMPLER[-1])


def _surface(body: Any, simpler: float) -> tuple[Points, Triangles]:
    """The surface of a body, corners nearer than a length [mm] made one; the fault where that changes it.

    The library's own simplifying takes whole wedges off some bodies, whatever the length.
    """
    surface = (body.simplify(simpler) if simpler else body).to_mesh64()
    points = _round_to_single(np.asarray(surface.vert_properties)[:, :3])
    faces = np.asarray(surface.tri_verts).astype(int)
    # without shells of next to no volume, but for the largest
    i, j = np.concatenate([faces[:, :2], faces[:, 1:]]).T
    count, shells = components(i, j, len(points))
    own = shells[faces[:, 0]]
    volumes = np.abs(np.bincount(own, _volumes(points, faces), count))
    faces = faces[(volumes[own] > MIN_VOID_VOLUME_MM3) | (own == np.argmax(volumes))]
    points, faces = close_surface(points, faces)
    change = abs(float(_volumes(points, faces).sum()) - body.volume())
    if change > MIN_VOID_VOLUME_MM3 + VOLUME_ROUNDING * body.volume():
        raise FeederError("the body", "its surface closes another volume", "take other sizes")
    used, faces = np.unique(faces, return_inverse=True)
    points, places = np.unique(points[used], axis=0, return_inverse=True)
    faces = places.ravel()[faces.reshape(-1, 3)]
    faces = np.take_along_axis(faces, (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    return check.frozen(points * MM), check.frozen(faces[np.lexsort(faces.T[::-1])])


def close_surface(points: Points, faces: Triangles) -> tuple[Points, Triangles]:
    """Return a surface that is closed by the places of its corners alone.

    Parameters
    ----------
    points : (V, 3) float [mm]
        In single precision; several may lie at one place.
    faces : (F, 3) int
        Each edge has one facet in either direction.

    Returns
    -------
    points : (V, 3) float [mm]
        No two in use are at one place.
    faces : (F', 3) int
        None is without an area.

    Raises
    ------
    FeederError
        If ``MAX_MERGE_ROUNDS`` rounds do not do it.
    """
    points = np.array(points, float)
    for _ in range(MAX_MERGE_ROUNDS):
        faces, stuck = _drop_flat_facets(points, _collapse_edges(points, faces))
        used = np.unique(faces)  # of them those that lie at the place of another
        shared = used[np.unique(cKDTree(points[used]).query_pairs(MERGE_DISTANCE_MM, output_type="ndarray"))]
        coincident = np.union1d(shared, stuck).astype(int)
        if not len(coincident):
            return points, faces
        moved = points.copy()  # towards the middle of their neighbours
        for corner in coincident:
            near = np.unique(faces[(faces == corner).any(axis=1)])
            offsets = points[near] - points[corner]
            sizes = np.sqrt((offsets**2).sum(axis=1, keepdims=True))
            direction = np.divide(offsets, sizes, out=np.zeros_like(offsets), where=sizes > 0.0).sum(axis=0)
            size = np.sqrt((direction**2).sum())
            moved[corner] = _round_to_single(points[corner] + SEPARATION_MM * direction / max(size, 1e-3))
        points = moved
    what = f"{len(coincident)} corners of its surface lie on others"
    raise FeederError("the body", what, "move its cuts apart, or take other sizes")


def _round_to_single(points: Points) -> Points:
    return np.asarray(points).astype(np.float32).astype(float) + 0.0  # no -0


def _volumes(points: Points, faces: Triangles) -> Floats:
    """(F,) the signed volumes of the pyramids from the origin to each facet."""
    a, b, c = points[faces].transpose(1, 0, 2)
    return (a * np.cross(b, c)).sum(axis=1) / 6.0


def _collapse_edges(points: Points, faces: Triangles) -> Triangles:
    """The faces, each edge of next to no length taken away where that does not join two sheets."""
    faces, before = np.array(faces), np.inf
    while len(faces) < before:
        before = len(faces)
        ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        short = ends[((points[ends[:, 0]] - points[ends[:, 1]]) ** 2).sum(axis=1) < MERGE_DISTANCE_MM**2]
        for corner, gone in short[short[:, 0] < short[:, 1]]:
            with_corner, with_gone = (faces == corner).any(axis=1), (faces == gone).any(axis=1)
            both = with_corner & with_gone
            common = np.setdiff1d(np.intersect1d(faces[with_corner], faces[with_gone]), (corner, gone))
            if both.sum() == 2 and len(common) == 2:
                faces = np.where(faces == gone, corner, faces)[~both]
    return faces


def _drop_flat_facets(points: Points, faces: Triangles) -> tuple[Triangles, Ints]:
    """The facets without those that rounding left no area, and the corners where that cannot be."""
    stuck = set()
    for _ in range(MAX_MERGE_ROUNDS * MAX_MERGE_ROUNDS):
        flat = [row for row in _find_flat_facets(points, faces) if row[2] not in stuck]
        if not flat:
            break
        faces, turned = _turn_edge(faces, *flat[0])
        stuck |= set() if turned else {flat[0][2]}
    return faces, np.array(sorted(stuck), int)


def _find_flat_facets(points: Points, faces: Triangles) -> list[tuple[int, int, int]]:
    """The facets whose three places lie on a line, as (one end, other end, corner between)."""
    a, b, c = points[faces].transpose(1, 0, 2)
    slivers = []
    for orientation in faces[~np.cross(b - a, c - a).any(axis=1)]:
        sides = ((points[orientation] - points[np.roll(orientation, 1)]) ** 2).sum(axis=1)
        k = int(np.argmax(sides))
        if sides.min() > MERGE_DISTANCE_MM**2:
            slivers.append((int(orientation[k - 1]), int(orientation[k]), int(orientation[k - 2])))
    return slivers


def _turn_edge(faces: Triangles, a: int, b: int, c: int) -> tuple[Triangles, bool]:
    """The faces without the flat one (a, b, c), and whether that could be."""
    following = np.roll(faces, -1, axis=1)
    own = (faces == a) & (following == b)
    across = (faces == b) & (following == a)
    row = int(np.flatnonzero(across.any(axis=1))[0])
    d = int(faces[row][(int(np.argmax(across[row])) + 2) % 3])
    unturned = faces[~(own | across).any(axis=1)]
    if d == c:
        return unturned, True
    if ((unturned == c).any(axis=1) & (unturned == d).any(axis=1)).any():
        return faces, False
    return np.concatenate([unturned, [(b, c, d), (c, a, d)]]), True
