"""What the gate mends, saying so: repeated facets, mixed winding, corners that nearly meet, T-junctions."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from feederscrew.errors import MeshError
from feederscrew.geometry import graphs, vectors
from feederscrew.part.repair import edges as gate_edges
from feederscrew.part.repair import weld

SOLID = "export it as a closed solid"
MOST_SEAMS = 5000  # open edges: with more than that the surface has worse than T-junctions


@dataclass(frozen=True)
class Seams:
    """Edges that were joined with several shorter ones of their neighbours."""

    count: int
    width: float  # [unit of the file] largest distance of a corner from such an edge


def mended(vertices, faces, tolerance, where, corners=True):
    """Triangles after every repair that leaves the shape alone.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    tolerance : float [unit of the file]
        Corners closer than this are one.
    where : str
        The file, for error lines.
    corners : bool
        Join corners and seams too; else leave them where they are, for the search for cracks.

    Returns
    -------
    vertices, faces : as above
    edges : MeshEdges
        Closed if the repairs were enough.
    said : tuple of str
        What was done, a sentence each.

    Raises
    ------
    MeshError
        If the facets cannot be turned one way round, or cancel out.
    """
    edges = gate_edges.table(faces, len(vertices))
    vertices, faces, said = leave_out_strays(vertices, faces, edges, tolerance)
    steps = (_without_repeats, _near_corners_joined, turn_one_way_round, _seams_closed)
    for step in steps if corners else (_without_repeats, turn_one_way_round):
        edges = gate_edges.table(faces, len(vertices))
        if edges.paired:
            return vertices, faces, edges, said
        vertices, faces, shown = step(vertices, faces, edges, tolerance, where)
        said += shown
        if not len(faces):
            raise MeshError(where, "encloses no volume", SOLID)
    edges = gate_edges.table(faces, len(vertices))
    crowded = int((edges.count > 2).sum())
    if edges.closed and crowded:
        joins = _many(crowded, "edge joins", "edges join")
        said += (f"{joins} more than two facets: the solid touches itself there",)
    return vertices, faces, edges, said


def leave_out_strays(vertices, faces, edges, tolerance):
    """Leave out facets whose corners lie on a line and that close nothing: with them more edges are open.

    Facets without area that share edges stand and fall together. One that joins two facets, as the filler of
    a T-junction does, stays.
    """
    flat = np.flatnonzero(_heights(vertices, faces) <= tolerance)
    if not len(flat):
        return vertices, faces, ()
    edge_of_side = np.empty(edges.order.shape, dtype=int)
    edge_of_side[edges.order] = np.repeat(np.arange(len(edges.count)), edges.count)
    sides = edge_of_side.reshape(-1, 3)[flat]
    number, node = graphs.components(
        np.repeat(np.arange(len(flat)), 3), len(flat) + sides.ravel(), len(flat) + len(edges.count)
    )
    group = np.repeat(node[: len(flat)], 3)
    pairs, count = np.unique(np.column_stack([group, sides.ravel()]), axis=0, return_counts=True)
    of_group, edge = pairs.T
    opens = np.where(count % 2 == 1, np.where(edges.count[edge] % 2 == 1, -1, 1), 0)
    change = np.bincount(of_group, opens, number)
    alone = np.bincount(of_group, count != edges.count[edge], number) == 0  # touches no other facet
    stray = flat[(change < 0)[group[::3]] | alone[group[::3]]]
    if not len(stray) or len(stray) == len(faces):
        return vertices, faces, ()
    kept = np.ones(len(faces), dtype=bool)
    kept[stray] = False
    text = f"{_many(len(stray), 'stray facet', 'stray facets')} without area left out: corners on a line"
    return *weld.compacted(vertices, faces[kept]), (text,)


def _heights(vertices, faces):
    """(F,) [unit of the file] height of each facet over its longest side."""
    a, b, c = (vertices[corner] for corner in faces.T)
    longest = np.maximum(np.maximum(vectors.norm(b - a), vectors.norm(c - b)), vectors.norm(a - c))
    return vectors.norm(vectors.cross(b - a, c - a)) / np.maximum(longest, np.finfo(float).tiny)


def _without_repeats(vertices, faces, edges, tolerance, where):
    """Each facet once; pairs that lie back to back, as the walls between glued solids do, not at all."""
    if edges.count.max() < 3:
        return vertices, faces, ()
    _, group = weld.distinct(np.sort(faces, axis=1))
    ahead = np.sum(faces < np.roll(faces, -1, axis=1), axis=1) == 2
    net = np.bincount(group, np.where(ahead, 1, -1)).astype(int)
    runs = np.where(ahead, 1, -1) == np.sign(net)[group]
    _, kept = np.unique(np.where(runs, group, -1), return_index=True)
    kept = np.sort(kept[runs[kept]])
    back_to_back = (np.bincount(group) - np.abs(net)).sum() // 2
    repeated = len(faces) - len(kept) - 2 * back_to_back
    said: tuple[str, ...] = ()
    if repeated:
        said += (f"{_many(repeated, 'duplicate facet', 'duplicate facets')} removed",)
    if back_to_back:
        said += (f"{_many(back_to_back, 'pair', 'pairs')} of facets back to back (inner walls) removed",)
    return *weld.compacted(vertices, faces[kept]), said


def _near_corners_joined(vertices, faces, edges, tolerance, where):
    odd = edges.count % 2 == 1
    if not odd.any():
        return vertices, faces, ()
    candidates = np.unique([edges.low[odd], edges.high[odd]])
    target = weld.near(vertices, candidates, tolerance)
    moved = int((target != np.arange(len(target))).sum())
    if not moved:
        return vertices, faces, ()
    text = f"joined {_many(moved, 'corner', 'corners')} that nearly met others"
    return *weld.compacted(vertices, target[faces]), (text,)


def turn_one_way_round(vertices, faces, edges, tolerance, where):
    """Facets turned until neighbours agree, as few in each shell as can be."""
    two = np.flatnonzero(edges.count == 2)
    askew = edges.net[two] != 0
    if not askew.any():
        return vertices, faces, ()
    odd, shell = _parity(edges.mates(two), askew, len(faces), where)
    turned = np.bincount(shell, odd) > 0.5 * np.bincount(shell)
    odd = odd != turned[shell]
    faces = np.where(odd[:, None], faces[:, ::-1], faces)
    return (
        vertices,
        faces,
        (f"{odd.sum()} of {len(faces)} facets pointed the other way than the rest; reversed",),
    )


def _parity(mates, askew, count, where):
    """Which facets differ from their shell's first one, and the shell of each.

    Every facet stands for two nodes, itself and its reverse; agreeing neighbours link like with like.
    """
    f, g = mates.T
    g = g + count * askew
    i, j = np.concatenate([f, f + count]), np.concatenate([g, (g + count) % (2 * count)])
    _, node = graphs.components(i, j, 2 * count)
    as_is, reverse = node[:count], node[count:]
    if (as_is == reverse).any():
        raise MeshError(where, "has one side only, like a Moebius strip", SOLID)
    _, shell = np.unique(np.minimum(as_is, reverse), return_inverse=True)
    return as_is > reverse, shell


def _seams_closed(vertices, faces, edges, tolerance, where):
    *surface, said, _ = close_seams(vertices, faces, edges, tolerance)
    return *surface, said


def close_seams(vertices, faces, edges, tolerance):
    """Join edges that meet corners of their neighbours half way by facets without area.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of the faces.
    tolerance : float [unit of the file]
        Corners closer than this to an edge are on it.

    Returns
    -------
    vertices, faces : as above
        The facets that join them come last.
    said : tuple of str
    seams : Seams
    """
    tails, heads = edges.rim()
    if not 0 < len(tails) <= MOST_SEAMS:
        return vertices, faces, (), Seams(0, 0.0)
    rim = np.unique([tails, heads])
    fans, width = _fans(vertices, rim, tails, heads, tolerance)
    joined = np.concatenate([faces, *fans])
    after = gate_edges.table(joined, len(vertices))
    if len(joined) == len(faces) or np.abs(after.net).sum() >= len(tails):
        return vertices, faces, (), Seams(0, 0.0)
    count = len(fans)
    text = f"{_many(count, 'edge meets', 'edges meet')} neighbours half way (T-junctions): joined"
    return vertices, joined, (text,), Seams(count, width)


def _fans(vertices, rim, tails, heads, tolerance):
    """Facets (N, 3) between each edge and the rim corners on it, where there are any; the furthest off it."""
    from scipy.spatial import cKDTree

    along = vertices[heads] - vertices[tails]
    length = vectors.norm(along)
    middles = vertices[tails] + 0.5 * along
    near = cKDTree(vertices[rim]).query_ball_point(middles, 0.5 * length + tolerance, return_sorted=True)
    edge = np.repeat(np.arange(len(tails)), [len(corners) for corners in near])
    corner = rim[np.concatenate([np.asarray(corners, dtype=int) for corners in near])]
    offset = vertices[corner] - vertices[tails[edge]]
    t = np.einsum("nx,nx->n", offset, along[edge]) / length[edge] ** 2
    off_line = vectors.norm(offset - t[:, None] * along[edge])
    on = (off_line <= tolerance) & (t > 0.0) & (t < 1.0) & (corner != tails[edge]) & (corner != heads[edge])
    edge, corner, t = edge[on], corner[on], t[on]
    order = np.lexsort((t, edge))
    fans = []
    for places in np.split(order, np.flatnonzero(np.diff(edge[order])) + 1) if len(order) else ():
        place = edge[places[0]]
        chain = [int(tails[place]), *corner[places].tolist()]
        fans.append(np.array([(int(heads[place]), a, b) for a, b in pairwise(chain)], dtype=int))
    return fans, float(off_line[on].max(initial=0.0))


def _many(count, one, more):
    return f"{count} {one if count == 1 else more}"
