"""Cracks: corners of neighbouring facets that differ, joined where that closes the surface and no more."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.errors import MeshError
from feederscrew.geometry import vectors
from feederscrew.part.repair import weld
from feederscrew.part.repair.edges import MeshEdges, table
from feederscrew.part.repair.mend import close_seams, turn_one_way_round

JOIN_SHARE, OPEN_JOIN_SHARE = 1e-4, 1e-2  # [1] of the size: cracks joined unasked, and with ``allow_open``
THIN_SHARE, OPEN_THIN_SHARE = 0.05, 0.2  # [1] of the volume: the same, of a layer as thick as the crack
STEPS = 3  # widths tried for each power of ten, the least first
FOLD_COSINE = -0.9998  # between normals: such facets lie back to back
SLIVER_WIDTHS = 4.0  # facets lower than so many crack widths have no normal that says anything
MAX_COMPARISONS = 3_000_000  # of open edges with each other: half a second
COMPARED_AT_ONCE = 500_000  # what some ten MB hold
CRACK_ALONG = 0.9  # [1] cosine between both sides of a crack, at least
GAP_SHARE = 0.02  # [1] of the size: what is wider is a hole, not a crack


@dataclass(frozen=True, eq=False)
class JoinedSurface:
    """A surface whose cracks are joined."""

    vertices: NDArray[np.float64]  # (V, 3) [unit of the file]
    faces: NDArray[np.int64]  # (F, 3)
    edges: MeshEdges
    width: float  # [unit of the file] of the widest crack joined
    corners: int  # how many were joined with others
    seams: int  # edges joined with several shorter ones


@dataclass(frozen=True)
class OpenGaps:
    """What lies between the open edges of a surface."""

    cracks: int  # open edges that run along another, near it
    width: float  # [unit of the file] largest distance across them
    place: tuple[float, float, float]  # [unit of the file] where
    others: int  # open edges that lie round holes


def join_cracks(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int64],
    least: float,
    size: float,
    where: str,
    allow_open: bool = False,
) -> JoinedSurface | None:
    """Join corners and edges across cracks by the least width that closes the surface.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
        Not closed.
    least : float [unit of the file]
        Corners closer than this are one already.
    size : float [unit of the file]
        Largest extent of the part.
    where : str
        The file, for error lines.
    allow_open : bool
        Join wider cracks too, and take what leaves the fewest edges open if nothing closes the surface.

    Returns
    -------
    JoinedSurface or None
        None where no width does it. Nothing is joined that would let a facet vanish, fold facets onto each
        other, make more than two facets meet at an edge where two met, or move walls by a share of their
        thickness: a thin wall stays, or the surface stays open.
    """
    largest, thin = (OPEN_JOIN_SHARE, OPEN_THIN_SHARE) if allow_open else (JOIN_SHARE, THIN_SHARE)
    edges = table(faces, len(vertices))
    fewest, best = int(np.abs(edges.net).sum()), None
    crowded = int((edges.count > 2).sum())
    gaps = _gaps(*_open_edges(vertices, edges))
    nearest = float(gaps.min() if allow_open else gaps.max())  # unasked, all must close
    for width in _widths(max(least, 0.5 * nearest), largest * size):
        joined = _join_within(vertices, faces, edges, width, where)
        if joined is None or int((joined.edges.count > 2).sum()) > crowded:
            continue
        still_open = int(np.abs(joined.edges.net).sum())
        if not still_open:
            return joined if _is_thin(joined, thin) else None
        if still_open < fewest:
            fewest, best = still_open, joined
    return best if allow_open else None


def measure_gaps(vertices: NDArray[np.float64], edges: MeshEdges, size: float) -> OpenGaps:
    """Measure how far the open edges of a surface are from the next open edge that runs along them.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    edges : MeshEdges
        Not closed.
    size : float [unit of the file]
        Largest extent of the part.

    Returns
    -------
    OpenGaps
        Of very many open edges some, evenly drawn, stand for all.
    """
    chosen, tail, head, facet = _open_edges(vertices, edges)
    gaps = _gaps(chosen, tail, head, facet)
    along = gaps <= GAP_SHARE * size
    cracks = round(float(along.mean()) * len(tail))
    widest = int(np.argmax(np.where(along, gaps, -1.0)))
    x, y, z = 0.5 * (tail[chosen[widest]] + head[chosen[widest]]) + 0.0
    width = float(gaps[widest]) if cracks else 0.0
    return OpenGaps(cracks, width, (float(x), float(y), float(z)), len(tail) - cracks)


def folded_share(vertices: NDArray[np.float64], faces: NDArray[np.int64], edges: MeshEdges) -> float:
    """Return the share of the area in facets that lie back to back with a neighbour.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of the faces.

    Returns
    -------
    float [1]
        0 for a solid; 1 for loose facets, each closed by itself.
    """
    area, pairs = _back_to_back(vertices, faces, edges)
    return float(area[np.unique(pairs)].sum()) / float(area.sum())


def _widths(least, largest):
    """Widths from the least to the largest, each some steps of a power of ten."""
    if largest <= least:
        return ()
    steps = max(1, int(np.ceil(STEPS * np.log10(largest / least))))
    return least * (largest / least) ** (np.arange(1, steps + 1) / steps)


def _join_within(vertices, faces, before, width, where):
    """The surface with corners within a width joined, and what is open then; None where that harms it."""
    odd = before.count % 2 == 1
    candidates = np.unique([before.low[odd], before.high[odd]])
    target = weld.near(vertices, candidates, width)
    moved = target != np.arange(len(target))
    ends = target[faces]
    if (ends == ends[:, [1, 2, 0]]).any():  # a facet would vanish: it is a feature, not a crack
        return None
    # A chain of corners, each near the next, is no crack: all must be near the one they are joined with.
    opened = float(vectors.norm(vertices[moved] - vertices[target[moved]]).max(initial=0.0))
    if opened > width:
        return None
    points, joined = weld.compacted(vertices, ends)
    edges = table(joined, len(points))
    try:
        points, joined, _ = turn_one_way_round(points, joined, edges, width, where)
    except MeshError:  # one side only: too much was joined
        return None
    edges = table(joined, len(points))
    facets = len(joined)
    points, joined, _, across = close_seams(points, joined, edges, width)
    edges = table(joined, len(points))
    if _folds(points, joined[:facets], edges, width):
        return None
    return JoinedSurface(points, joined, edges, max(opened, across.width), int(moved.sum()), across.count)


def _folds(vertices, faces, edges, width):
    """Whether facets that now share an edge lie back to back."""
    area, pairs = _back_to_back(vertices, faces, edges)
    sides = vertices[faces] - vertices[faces[:, [1, 2, 0]]]
    solid = area > SLIVER_WIDTHS * width * vectors.norm(sides).max(axis=1)
    return bool(solid[pairs].all(axis=1).any())


def _back_to_back(vertices, faces, edges):
    """(F,) twice the area of each facet, (N, 2) neighbours across an edge of two that face each other."""
    pairs = edges.mates(edges.count == 2)
    i, j = pairs[(pairs < len(faces)).all(axis=1)].T
    a, b, c = (vertices[corner] for corner in faces.T)
    across = vectors.cross(b - a, c - a)
    area = vectors.norm(across)
    back = np.einsum("nx,nx->n", across[i], across[j]) < FOLD_COSINE * area[i] * area[j]
    return area, np.column_stack([i[back], j[back]])


def _is_thin(joined, share):
    """Whether a layer as thick as the widest crack holds no more than a share of the volume."""
    a, b, c = (joined.vertices[corner] - joined.vertices[0] for corner in joined.faces.T)
    across = vectors.cross(b - a, c - a)
    volume = abs(float(np.einsum("fx,fx->", a, across))) / 6.0
    return joined.width * 0.5 * float(vectors.norm(across).sum()) <= share * volume


def _open_edges(vertices, edges):
    """Which open edges stand for all; (N, 3) and (N, 3) the ends of all; (N,) a facet of each."""
    open_edges = np.flatnonzero(edges.net)
    step = -(-(len(open_edges) ** 2) // MAX_COMPARISONS)
    ends = vertices[edges.low[open_edges]], vertices[edges.high[open_edges]]
    return np.arange(0, len(open_edges), step), *ends, edges.order[edges.start[open_edges]] // 3


def _gaps(chosen, tails, heads, facet):
    """How far open edges are from the nearest of other facets that run along them; infinite without one."""
    ways = heads - tails
    squares = np.maximum(np.einsum("nx,nx->n", ways, ways), np.finfo(float).tiny)
    widest = []
    rows = max(1, COMPARED_AT_ONCE // len(tails))
    for edge in np.array_split(chosen, -(-len(chosen) // rows)):
        cosine = np.abs(np.einsum("ex,nx->en", ways[edge], ways)) / np.sqrt(squares[edge, None] * squares)
        beside = (cosine > CRACK_ALONG) & (facet[edge, None] != facet)
        gap = np.zeros(len(edge))
        for share in (0.0, 0.5, 1.0):
            offset = (tails[edge] + share * ways[edge])[:, None] - tails
            t = np.clip(np.einsum("enx,nx->en", offset, ways) / squares, 0.0, 1.0)
            distance = vectors.norm(offset - t[..., None] * ways)
            gap = np.maximum(gap, np.where(beside, distance, np.inf).min(axis=1))
        widest.append(gap)
    return np.concatenate(widest)
