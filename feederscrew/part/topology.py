"""Corners that coincide, the facets at each edge, and the closed surfaces that they make."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from feederscrew.base.arrays import Array, Floats, Ints, Points, Triangles
from feederscrew.base.geometry import graphs, vectors
from feederscrew.base.heavy import heavy

spatial = heavy("scipy.spatial")

HASH_MIX = tuple(
    np.uint64(odd) for odd in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB, 0xD6E8FEB86659FD93)
)
MAX_NEAR_PAIRS = 10_000_000  # near pairs: what a few hundred MB hold


def weld_corners(vertices: Points, faces: Triangles) -> tuple[Points, Triangles]:
    """Return triangles with each distinct corner once and no corner without a facet.

    Facets that have collapsed to an edge or a point are left out: their sides cancel.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
        Finite.
    faces : (F, 3) int

    Returns
    -------
    vertices : (V', 3) float [unit of the file]
    faces : (F', 3) int
    """
    first, group = distinct_points(vertices)
    return drop_unused_corners(vertices[first], group[faces])


def drop_unused_corners(vertices: Points, faces: Triangles) -> tuple[Points, Triangles]:
    """Return the same triangles without collapsed facets and without corners that no facet uses.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int

    Returns
    -------
    vertices : (V', 3) float [unit of the file]
    faces : (F', 3) int
    """
    a, b, c = faces.T
    collapsed = (a == b) | (b == c) | (c == a)
    if collapsed.any():
        faces = faces[~collapsed]
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    if used.all():
        return vertices, faces
    return vertices[used], (np.cumsum(used) - 1)[faces]


def distinct_points(rows: Array) -> tuple[Ints, Ints]:
    """Find rows that are the same, by a hash of their bits.

    Parameters
    ----------
    rows : (N, K) float [any]
        K up to 4; finite; minus zero counts as zero.

    Returns
    -------
    first : (M,) int
        One row of each of the M kinds.
    group : (N,) int
        The kind of each row.
    """
    rows = np.ascontiguousarray(rows, dtype=float) + 0.0
    keys = np.zeros(len(rows), dtype=np.uint64)  # a hash of each row; wraps round on purpose
    for column, odd in zip(rows.view(np.uint64).T, HASH_MIX):
        keys += column
        keys *= odd
        keys ^= keys >> np.uint64(31)
    order = np.argsort(keys)
    ordered = keys[order]
    new = np.ones(len(keys), dtype=bool)
    np.not_equal(ordered[1:], ordered[:-1], out=new[1:])
    group = np.empty(len(keys), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    first = order[new]
    if not np.array_equal(rows[first[group]], rows):  # two kinds share a hash: one in 1e6 files of 1e6 facets
        _, first, group = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return first, group.reshape(-1)


def near_pairs(vertices: Points, candidates: Ints, tolerance: float) -> Ints:
    """Join candidates that are closer than a tolerance, directly or by others between them.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    candidates : (N,) int
        Corners that may be joined.
    tolerance : float [unit of the file]

    Returns
    -------
    (V,) int
        The corner that each is joined with; itself where there is none, and for all of them where more than
        ``MAX_NEAR_PAIRS`` pairs are that close.
    """
    target = np.arange(len(vertices))
    tree = spatial.cKDTree(vertices[candidates])
    if tree.count_neighbors(tree, tolerance) > MAX_NEAR_PAIRS:
        return target
    i, j = tree.query_pairs(tolerance, output_type="ndarray").T
    _, cluster = graphs.components(i, j, len(candidates))
    _, first = np.unique(cluster, return_index=True)
    target[candidates] = candidates[first[cluster]]
    return target


@dataclass(frozen=True, eq=False)
class MeshEdges:
    """The E edges of F facets; each facet has three sides, side s being one of facet s // 3."""

    corners: int  # how many there are: V
    keys: Ints  # (E,) low corner times V plus high corner
    order: Ints  # (3F,) sides, edge by edge
    start: Ints  # (E,) where in ``order`` an edge's sides begin
    count: Ints  # (E,) sides at each edge
    net: Ints  # (E,) sides from the low to the high corner, less those back

    @cached_property
    def is_closed(self) -> bool:
        """Tell whether every side has one that runs back along it."""
        return not self.net.any()

    @cached_property
    def is_paired(self) -> bool:
        """Tell whether every edge joins exactly two facets, wound the same way round."""
        return self.is_closed and bool((self.count == 2).all())

    @property
    def low(self) -> Ints:
        """(E,) lower corner of each edge."""
        return self.keys // self.corners

    @property
    def high(self) -> Ints:
        """(E,) higher corner of each edge."""
        return self.keys % self.corners

    def mates(self, edges: Array) -> Ints:
        """Return the two facets at each of some edges that have two.

        Parameters
        ----------
        edges : (E,) bool or (N,) int
            A mask of all edges, or indices.

        Returns
        -------
        (N, 2) int
        """
        start = self.start[edges]
        return np.column_stack([self.order[start], self.order[start + 1]]) // 3

    def rim(self) -> tuple[Ints, Ints]:
        """Open sides from corner to corner, as (N,) and (N,), each as often as it is open."""
        times = np.abs(self.net)
        at = np.repeat(np.arange(len(times)), times)
        forward = self.net[at] > 0
        return np.where(forward, self.low[at], self.high[at]), np.where(forward, self.high[at], self.low[at])


def edge_table(faces: Triangles, corners: int) -> MeshEdges:
    """Return the edges of facets.

    Parameters
    ----------
    faces : (F, 3) int
        None has a corner twice.
    corners : int
        The number of corners of the mesh, V.

    Returns
    -------
    MeshEdges
    """
    tails, heads = faces, faces[:, [1, 2, 0]]
    keys = np.minimum(tails, heads) * corners + np.maximum(tails, heads)
    keys = (2 * keys + (tails > heads)).ravel()
    order = np.argsort(keys)
    keys = keys[order]
    reversed_side, keys = keys & 1, keys >> 1
    start = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
    count = np.diff(start, append=len(keys))
    net = count - 2 * np.add.reduceat(reversed_side, start)
    return MeshEdges(corners, keys[start], order, start, count, net)


SHELL_SOLID_ANGLES, MAX_SOLID_ANGLES = 4_000_000, 400_000_000  # for one shell, half a second, and for all
LISTED_SHELLS = 3  # bodies named with their volume
SAVE_SHELLS = (
    "save each body as a file of its own, or unite them in CAD if they are one part;"
    " or pass `allow_open` to take them as one part"
)
REVERSE_INNER = "reverse the inner surface if it is a cavity, else save each body as a file of its own"
MOVE_CAVITY = "move the cavity inside the material in CAD"


def split_shells(edges: MeshEdges, faces: Triangles) -> tuple[int, Ints]:
    """Split a mesh into shells: facets joined across edges.

    Where more than two facets meet, shells touch; they are one only if they do not close without each other.

    Parameters
    ----------
    edges : MeshEdges
    faces : (F, 3) int

    Returns
    -------
    number : int
        The number of shells.
    shell : (F,) int
        The shell that each facet belongs to.
    """
    first, second = edges.mates(edges.count == 2).T
    number, shell = graphs.components(first, second, len(faces))
    crowded = edges.count > 2
    if not crowded.any():
        return number, shell
    facets, edge = edges.order // 3, np.repeat(np.arange(len(crowded)), edges.count)
    at = crowded[edge]
    runs = np.where(faces < np.roll(faces, -1, axis=1), 1, -1).ravel()[edges.order[at]]
    pairs, which = np.unique(edge[at] * number + shell[facets[at]], return_inverse=True)
    unclosed = pairs[np.bincount(which, runs) != 0]
    at_edge, of_shell = np.divmod(unclosed, number)
    same = at_edge[1:] == at_edge[:-1]
    count, group = graphs.components(of_shell[:-1][same], of_shell[1:][same], number)
    return count, group[shell]


def shell_fault(
    vertices: Points, faces: Triangles, shell: Ints, volume: Floats, unit: str
) -> tuple[str, str] | None:
    """Say why closed shells are not one outer surface and its cavities.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    shell : (F,) int
        The shell of each facet.
    volume : (S,) float [cubed unit of the file]
        Of each shell, the largest positive.
    unit : str
        Of the file.

    Returns
    -------
    (str, str) or None
        What is wrong and how to mend it; None if they are.
    """
    by_size = np.argsort(-np.abs(volume), kind="stable")
    bodies = by_size[volume[by_size] > 0.0]
    if len(bodies) > 1:
        turns = turns_around(vertices, faces, shell, bodies[1])
        what = f"a body of {volume[bodies[1]]:.4g} {unit}3 lies inside another, both facing outwards"
        return (what, REVERSE_INNER) if (turns > 0.5).all() else _several(volume[bodies], unit)
    if len(volume) * len(faces) > MAX_SOLID_ANGLES:
        return f"holds {len(volume)} closed surfaces", SAVE_SHELLS
    for cavity in by_size[1:]:
        turns = turns_around(vertices, faces, shell, cavity)
        if (turns < 0.5).all():
            return _several(np.abs(volume[[*bodies, cavity]]), unit)
        if (np.abs(turns - 1.0) > 0.1).any():
            return f"a cavity of {-volume[cavity]:.4g} {unit}3 crosses another surface", MOVE_CAVITY
    return None


def _several(volume: Floats, unit: str) -> tuple[str, str]:
    return f"holds {len(volume)} bodies, of {list_volumes(volume)} {unit}3", SAVE_SHELLS


def list_volumes(volume: Floats) -> str:
    """Return the first volumes of some in a sentence: '64, 8, 1, ...'.

    Parameters
    ----------
    volume : (S,) float [cubed unit of the file]

    Returns
    -------
    str
        ``LISTED_SHELLS`` of them at most, without a unit.
    """
    return ", ".join([*(f"{v:.4g}" for v in volume[:LISTED_SHELLS]), *["..."][: len(volume) > LISTED_SHELLS]])


def shell_boxes(vertices: Points, faces: Triangles, shell: Ints, number: int) -> tuple[Points, Points]:
    """Return the lowest and highest corner of each shell's box along the file's axes.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    shell : (F,) int
        The shell of each facet.
    number : int
        Of shells, S.

    Returns
    -------
    low, high : (S, 3) float [unit of the file]
        Infinite, low above high, for a shell without facets.
    """
    low, high = np.full((number, 3), np.inf), np.full((number, 3), -np.inf)
    for corner in faces.T:
        np.minimum.at(low, shell, vertices[corner])
        np.maximum.at(high, shell, vertices[corner])
    return low, high


def turns_around(
    vertices: Points, faces: Triangles, shell: Ints, inner: int, outer: int | None = None,
    probes: int = 64,
) -> Floats:  # fmt: skip
    """Return how often one shell, or all the others, go round some corners of a shell.

    It is the sum of the solid angles of their facets, seen from the corner, divided by 4 pi.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    shell : (F,) int
        The shell of each facet.
    inner : int
        The shell whose corners are looked at.
    outer : int, optional
        The shell that may go round them; all but ``inner`` without it.
    probes : int, optional
        The number of corners to look at, about; fewer of a large mesh.

    Returns
    -------
    (N,) float [1]
        1 inside the outer one, 0 outside; negative where it faces inwards.
    """
    corners = np.unique(faces[shell == inner])
    around = vertices[faces[shell != inner if outer is None else shell == outer]]
    most = SHELL_SOLID_ANGLES // len(faces if outer is None else around)
    step = -(-len(corners) // max(1, min(probes, most)))
    return np.array([vectors.solid_angles(x, around).sum() for x in vertices[corners[::step]]]) / (
        4.0 * np.pi
    )
