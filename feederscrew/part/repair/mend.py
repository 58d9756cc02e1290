"""What the gate mends, saying so: repeated facets, mixed winding, corners that nearly meet, T-junctions."""

from itertools import pairwise

import numpy as np

from feederscrew.errors import MeshError
from feederscrew.geometry import graphs, vectors
from feederscrew.part.repair import edges as gate_edges
from feederscrew.part.repair import weld

SOLID = "export it as a closed solid"
MOST_SEAMS = 5000  # open edges: with more than that the surface has worse than T-junctions


def mended(vertices, faces, tolerance, where):
    """Triangles after every repair that leaves the shape alone.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    tolerance : float [unit of the file]
        Corners closer than this are one.
    where : str
        The file, for error lines.

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
    said: tuple[str, ...] = ()
    for step in (_without_repeats, _near_corners_joined, _one_way_round, _seams_closed):
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


def _one_way_round(vertices, faces, edges, tolerance, where):
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
    """Edges that meet corners of their neighbours half way, joined there by facets without area."""
    tails, heads = edges.rim()
    if not 0 < len(tails) <= MOST_SEAMS:
        return vertices, faces, ()
    rim = np.unique([tails, heads])
    fans = [_fan(vertices, rim, tail, head, tolerance) for tail, head in zip(tails.tolist(), heads.tolist())]
    joined = np.concatenate([faces, *fans])
    after = gate_edges.table(joined, len(vertices))
    if len(joined) == len(faces) or np.abs(after.net).sum() >= len(tails):
        return vertices, faces, ()
    count = sum(len(fan) > 0 for fan in fans)
    return (
        vertices,
        joined,
        (f"{_many(count, 'edge meets', 'edges meet')} neighbours half way (T-junctions): joined",),
    )


def _fan(vertices, rim, tail, head, tolerance):
    """(N, 3) facets between an edge and the rim corners on it; none where there are none."""
    along = vertices[head] - vertices[tail]
    offset = vertices[rim] - vertices[tail]
    t = vectors.product(offset, along) / vectors.dot(along, along)
    off_line = vectors.norm(offset - t[:, None] * along)
    on = np.flatnonzero((off_line <= tolerance) & (t > 0.0) & (t < 1.0) & (rim != tail) & (rim != head))
    chain = [tail, *rim[on[np.argsort(t[on])]].tolist(), head]
    return np.array([(head, a, b) for a, b in pairwise(chain[:-1])], dtype=int).reshape(-1, 3)


def _many(count, one, more):
    return f"{count} {one if count == 1 else more}"
