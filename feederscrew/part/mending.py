"""Repairs of the gate: repeated facets, mixed winding, cracks, T-junctions, holes with ``allow_open``.

Lengths are in the unit of the file.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain, combinations, pairwise

import numpy as np

from feederscrew.base.arrays import Floats, Ints, Points, Triangles, Vector
from feederscrew.base.errors import MeshError
from feederscrew.base.geometry import graphs, vectors
from feederscrew.base.heavy import heavy
from feederscrew.base.units import counted
from feederscrew.part import mass, topology
from feederscrew.part.topology import MeshEdges, edge_table

spatial = heavy("scipy.spatial")

EXPORT_SOLID = "export it as a closed solid"
MAX_SEAM_EDGES = 5000  # open edges: with more than that the surface has worse than T-junctions
MAX_PATCHES = (
    1000  # parts of a surface between edges of more than two facets: with more no sheet is looked for
)
MAX_SHEETS, MAX_ODD_PATCHES = (
    3,
    8,
)  # sheets that meet the skin all round, and patches they are looked for among
EQUAL_VOLUME_SHARE = 1e-9  # [1] by which volumes are equal
MAX_SHEET_PROBES = 64  # facets of a sheet that say whether it lies within the body
Notes = tuple[str, ...]  # what was done, a sentence each
Step = tuple[Points, Triangles, Notes]  # a surface after one repair


def mend_facets(
    vertices: Points, faces: Triangles, tolerance: float, where: str, corners: bool = True
) -> tuple[Points, Triangles, MeshEdges, Notes]:
    """Apply every repair that leaves the shape alone, until the surface is closed.

    They are, in this order: leave out stray facets without area, drop repeated facets, join corners that
    nearly meet, turn facets one way round, close T-junctions.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    tolerance : float [unit of the file]
        Corners that are closer are one.
    where : str
        The file, for error lines.
    corners : bool, optional
        Without it corners and seams stay where they are, for the search for cracks.

    Returns
    -------
    vertices : (V', 3) float [unit of the file]
    faces : (F', 3) int
    edges : MeshEdges
        Of those faces; closed if that was enough.
    notes : tuple of str
        A sentence for everything that was done.

    Raises
    ------
    MeshError
        If the facets cannot be turned one way round, or cancel out.
    """
    vertices, faces, notes = leave_out_strays(vertices, faces, edge_table(faces, len(vertices)), tolerance)
    steps: list[Callable[[Points, Triangles, MeshEdges], Step]] = [_drop_repeats]
    if corners:
        steps.append(lambda v, f, edges: _join_near_corners(v, f, edges, tolerance))
    steps.append(lambda v, f, edges: turn_one_way_round(v, f, edges, where))
    if corners:
        steps.append(lambda v, f, edges: close_seams(v, f, edges, tolerance)[:3])
    for step in steps:
        edges = edge_table(faces, len(vertices))
        if edges.is_paired:
            return vertices, faces, edges, notes
        vertices, faces, more = step(vertices, faces, edges)
        notes += more
        if not len(faces):
            raise MeshError(where, "encloses no volume", EXPORT_SOLID)
    edges = edge_table(faces, len(vertices))
    crowded = int((edges.count > 2).sum())
    if edges.is_closed and crowded:
        joins = counted(crowded, "edge joins", "edges join")
        notes += (f"{joins} more than two facets: the solid touches itself there",)
    return vertices, faces, edges, notes


def leave_out_strays(vertices: Points, faces: Triangles, edges: MeshEdges, tolerance: float) -> Step:
    """Leave out facets whose corners lie on a line and that close nothing: with them more edges are open.

    Facets without area that share edges stand and fall together. One that joins two facets, as the filler of
    a T-junction does, stays.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of those faces.
    tolerance : float [unit of the file]
        A facet no higher than that over its longest side has no area.

    Returns
    -------
    vertices : (V', 3) float [unit of the file]
    faces : (F', 3) int
    notes : tuple of str
        Empty where nothing was left out.
    """
    # by their height over the longest side
    a, b, c = (vertices[corner] for corner in faces.T)
    longest = np.maximum(np.maximum(vectors.norm(b - a), vectors.norm(c - b)), vectors.norm(a - c))
    heights = vectors.norm(vectors.cross(b - a, c - a)) / np.maximum(longest, np.finfo(float).tiny)
    flat = np.flatnonzero(heights <= tolerance)
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
    text = f"{counted(len(stray), 'stray facet')} without area left out: corners on a line"
    return *topology.drop_unused_corners(vertices, np.delete(faces, stray, axis=0)), (text,)


@dataclass(frozen=True, eq=False)
class Sheets:
    """Facets that bound nothing beside a closed surface, and that surface without them."""

    vertices: Points  # (V, 3) [unit of the file] of the closed surface
    faces: Triangles  # (F, 3) int
    edges: MeshEdges
    notes: Notes  # of its repair
    facets: int  # how many are in the sheets
    place: Vector  # (3,) [unit of the file] the centre of one
    is_inside: bool  # whether all of them lie within the closed surface
    is_flat: bool  # whether each sheet is; else it may be a cavity or a body that lacks facets


def find_sheets(
    vertices: Points, faces: Triangles, edges: MeshEdges, tolerance: float, where: str
) -> Sheets | None:
    """Find the sheets without which an open surface is closed: walls within a body, or what sticks out.

    A sheet ends in free edges, or where it meets the body's skin: there three facets share an edge. Of the
    patches that such edges part, those with a free edge are taken away; else those, up to
    ``MAX_SHEETS``, that leave each edge an even number of facets and the most enclosed.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of those faces; the surface is open.
    tolerance : float [unit of the file]
        Corners that are closer are one.
    where : str
        The file, for the lines of faults.

    Returns
    -------
    Sheets or None
        None where no sheets can be told from the rest.
    """
    mates = edges.mates(edges.count == 2)
    number, patch = graphs.components(mates[:, 0], mates[:, 1], len(faces))
    if not 1 < number <= MAX_PATCHES:
        return None
    crowded = np.flatnonzero(edges.count != 2)
    meets = np.zeros((len(crowded), number), dtype=int)  # facets of each patch at each such edge
    for row, edge in enumerate(crowded.tolist()):
        at = edges.start[edge] + np.arange(edges.count[edge])
        np.add.at(meets[row], patch[edges.order[at] // 3], 1)
    free = np.flatnonzero(meets[meets.sum(axis=1) == 1].any(axis=0)).tolist()
    odd = np.flatnonzero((meets % 2 == 1).any(axis=0)).tolist()[:MAX_ODD_PATCHES]
    choices = [tuple(free)] if free else list(chain.from_iterable(
        combinations(odd, size) for size in range(1, MAX_SHEETS + 1)))  # fmt: skip
    best, most = None, 0.0
    for chosen in choices:
        left = meets.sum(axis=1) - meets[:, list(chosen)].sum(axis=1)
        if (left % 2).any() or len(chosen) == number:
            continue
        is_sheet = np.isin(patch, chosen)
        rest = topology.drop_unused_corners(vertices, faces[~is_sheet])
        try:
            corners, skin, table, notes = mend_facets(*rest, tolerance, where)
        except MeshError:
            continue
        volume = abs(mass.integrate_solid(corners[skin]).volume)
        if table.is_closed and volume > most * (1.0 + EQUAL_VOLUME_SHARE):
            best, most = (corners, skin, table, notes, is_sheet), volume
    if best is None:
        return None
    corners, skin, table, notes, is_sheet = best
    centres = vertices[faces[is_sheet]].mean(axis=1)
    probes = centres[:: -(-len(centres) // MAX_SHEET_PROBES)]
    around = corners[skin]
    turns = [vectors.solid_angles(place, around).sum() / (4.0 * np.pi) for place in probes]
    is_inside = bool((np.abs(turns) > 0.5).all())
    is_flat = all(_is_flat(vertices[np.unique(faces[patch == k])], tolerance) for k in set(patch[is_sheet]))
    return Sheets(corners, skin, table, notes, len(centres), centres[0], is_inside, is_flat)


def _is_flat(points: Points, tolerance: float) -> bool:
    """Tell whether points (N, 3) lie in one plane."""
    offsets = points - points.mean(axis=0)
    _, axes = vectors.eigen(vectors.product(offsets.T, offsets))
    return float(np.ptp(vectors.product(offsets, axes[:, 0]))) <= tolerance


def _drop_repeats(vertices: Points, faces: Triangles, edges: MeshEdges) -> Step:
    """Each facet once; pairs that lie back to back, as the walls between glued solids do, not at all."""
    if edges.count.max() < 3:
        return vertices, faces, ()
    _, group = topology.distinct_points(np.sort(faces, axis=1))
    ahead = np.sum(faces < np.roll(faces, -1, axis=1), axis=1) == 2
    net = np.bincount(group, np.where(ahead, 1, -1)).astype(int)
    runs = np.where(ahead, 1, -1) == np.sign(net)[group]
    _, first_facets = np.unique(np.where(runs, group, -1), return_index=True)
    first_facets = np.sort(first_facets[runs[first_facets]])
    back_to_back = (np.bincount(group) - np.abs(net)).sum() // 2
    repeated = len(faces) - len(first_facets) - 2 * back_to_back
    notes: Notes = (f"{counted(repeated, 'duplicate facet')} removed",) if repeated else ()
    if back_to_back:
        notes += (f"{counted(back_to_back, 'pair')} of facets back to back (inner walls) removed",)
    return *topology.drop_unused_corners(vertices, faces[first_facets]), notes


def _join_near_corners(vertices: Points, faces: Triangles, edges: MeshEdges, tolerance: float) -> Step:
    odd = edges.count % 2 == 1
    if not odd.any():
        return vertices, faces, ()
    target = topology.near_pairs(vertices, np.unique([edges.low[odd], edges.high[odd]]), tolerance)
    moved = int((target != np.arange(len(target))).sum())
    if not moved:
        return vertices, faces, ()
    text = f"joined {counted(moved, 'corner')} that nearly met others"
    return *topology.drop_unused_corners(vertices, target[faces]), (text,)


def turn_one_way_round(vertices: Points, faces: Triangles, edges: MeshEdges, where: str) -> Step:
    """Turn facets until neighbours agree, as few in each shell as can be.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of those faces; those of exactly two facets count.
    where : str
        The file, for the error line.

    Returns
    -------
    vertices : (V, 3) float [unit of the file]
        As given.
    faces : (F, 3) int
    notes : tuple of str
        Empty where all agreed.

    Raises
    ------
    MeshError
        If no turning makes neighbours agree: the surface has one side only.
    """
    two = np.flatnonzero(edges.count == 2)
    askew = edges.net[two] != 0
    if not askew.any():
        return vertices, faces, ()
    # Every facet stands for two nodes, itself and its reverse; agreeing neighbours link like with like.
    count = len(faces)
    f, g = edges.mates(two).T
    g = g + count * askew
    i, j = np.concatenate([f, f + count]), np.concatenate([g, (g + count) % (2 * count)])
    _, node = graphs.components(i, j, 2 * count)
    as_is, reverse = node[:count], node[count:]
    if (as_is == reverse).any():
        raise MeshError(where, "has one side only, like a Moebius strip", EXPORT_SOLID)
    _, shell = np.unique(np.minimum(as_is, reverse), return_inverse=True)
    odd = as_is > reverse  # differs from the first facet of its shell
    turned = np.bincount(shell, odd) > 0.5 * np.bincount(shell)
    odd = odd != turned[shell]
    note = f"{odd.sum()} of {len(faces)} facets pointed the other way than the rest; reversed"
    return vertices, np.where(odd[:, None], faces[:, ::-1], faces), (note,)


def close_seams(
    vertices: Points, faces: Triangles, edges: MeshEdges, tolerance: float
) -> tuple[Points, Triangles, Notes, int, float]:
    """Join edges that meet corners of their neighbours half way (T-junctions) by facets without area.

    Nothing is changed where there are more than ``MAX_SEAM_EDGES`` open edges, or where fewer would not be
    left.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of those faces.
    tolerance : float [unit of the file]
        Corners closer than that to an edge are on it.

    Returns
    -------
    vertices : (V, 3) float [unit of the file]
    faces : (F', 3) int
        The new facets come last.
    notes : tuple of str
    joined : int
        The number of edges that were joined.
    width : float [unit of the file]
        The largest distance of a corner from such an edge.
    """
    tails, heads = edges.rim()
    if not 0 < len(tails) <= MAX_SEAM_EDGES:
        return vertices, faces, (), 0, 0.0
    # rim corners on each edge
    rim = np.unique([tails, heads])
    along = vertices[heads] - vertices[tails]
    length, middles = vectors.norm(along), vertices[tails] + 0.5 * along
    tree = spatial.cKDTree(vertices[rim])
    near = tree.query_ball_point(middles, 0.5 * length + tolerance, return_sorted=True)
    edge = np.repeat(np.arange(len(tails)), [len(corners) for corners in near])
    corner = rim[np.concatenate([np.asarray(corners, dtype=int) for corners in near])]
    offset = vertices[corner] - vertices[tails[edge]]
    t = np.einsum("nx,nx->n", offset, along[edge]) / length[edge] ** 2
    off_line = vectors.norm(offset - t[:, None] * along[edge])
    on = (off_line <= tolerance) & (t > 0.0) & (t < 1.0) & (corner != tails[edge]) & (corner != heads[edge])
    edge, corner, t = edge[on], corner[on], t[on]
    order = np.lexsort((t, edge))
    # a fan of facets between each edge and those corners
    fans = []
    for places in np.split(order, np.flatnonzero(np.diff(edge[order])) + 1) if len(order) else ():
        place = edge[places[0]]
        chain = [int(tails[place]), *corner[places].tolist()]
        fans.append(np.array([(int(heads[place]), a, b) for a, b in pairwise(chain)], dtype=int))
    joined = np.concatenate([faces, *fans])
    after = edge_table(joined, len(vertices))
    if len(joined) == len(faces) or np.abs(after.net).sum() >= len(tails):
        return vertices, faces, (), 0, 0.0
    text = counted(len(fans), "edge meets", "edges meet") + " neighbours half way (T-junctions): joined"
    return vertices, joined, (text,), len(fans), float(off_line[on].max(initial=0.0))


JOIN_SHARE, OPEN_JOIN_SHARE = 1e-4, 1e-2  # [1] of the size: cracks joined unasked, and with ``allow_open``
THIN_SHARE, OPEN_THIN_SHARE = 0.05, 0.2  # [1] of the volume: the same, of a layer as thick as the crack
CRACK_WIDTHS_A_DECADE = 3  # widths tried for each power of ten, the least first
FOLD_COSINE = -0.9998  # between normals: such facets lie back to back
SLIVER_WIDTHS = 4.0  # facets lower than so many crack widths have no normal that says anything
MAX_COMPARISONS = 3_000_000  # of open edges with each other: half a second
COMPARED_AT_ONCE = 500_000  # what some ten MB hold
CRACK_ALONG = 0.9  # [1] cosine between both sides of a crack, at least
GAP_SHARE = 0.02  # [1] of the size: what is wider is a hole, not a crack


@dataclass(frozen=True, eq=False)
class JoinedSurface:
    """A surface whose cracks are joined."""

    vertices: Points
    faces: Triangles
    edges: MeshEdges
    width: float  # [unit of the file] of the widest crack joined
    corners: int  # how many were joined with others
    seams: int  # edges joined with several shorter ones


def join_cracks(
    vertices: Points, faces: Triangles, least: float, size: float, where: str, allow_open: bool = False
) -> JoinedSurface | None:
    """Join corners and edges across cracks by the least width that closes the surface.

    Nothing is joined that would let a facet vanish, fold facets onto each other, make more than two
    facets meet at an edge where two met, or move walls by a share of their thickness: a thin wall stays, or
    the surface stays open.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    least : float [unit of the file]
        Corners that are closer are one already.
    size : float [unit of the file]
        The part's largest extent.
    where : str
        The file, for error lines.
    allow_open : bool, optional
        Whether wider cracks are joined too, up to ``OPEN_JOIN_SHARE`` of the size in place of ``JOIN_SHARE``.
        What leaves the fewest edges open is taken then if nothing closes the surface.

    Returns
    -------
    JoinedSurface or None
        None if no width closes the surface, or with ``allow_open`` if none makes fewer edges open.
    """
    largest, thin = (OPEN_JOIN_SHARE, OPEN_THIN_SHARE) if allow_open else (JOIN_SHARE, THIN_SHARE)
    edges = edge_table(faces, len(vertices))
    fewest, best = int(np.abs(edges.net).sum()), None
    crowded = int((edges.count > 2).sum())
    gaps, _ = _open_gaps(vertices, edges)
    nearest = float(gaps.min() if allow_open else gaps.max())  # unasked, all must close
    low, high = max(least, 0.5 * nearest), largest * size
    steps = max(1, int(np.ceil(CRACK_WIDTHS_A_DECADE * np.log10(high / low)))) if high > low else 0
    for width in low * (high / low) ** (np.arange(1, steps + 1) / steps) if steps else ():
        joined = _join_within(vertices, faces, edges, width, where)
        if joined is None or int((joined.edges.count > 2).sum()) > crowded:
            continue
        still_open = int(np.abs(joined.edges.net).sum())
        if not still_open:
            # a layer as thick as the widest crack must hold no more than a share of the volume
            a, b, c = (joined.vertices[corner] - joined.vertices[0] for corner in joined.faces.T)
            across = vectors.cross(b - a, c - a)
            volume = abs(float(np.einsum("fx,fx->", a, across))) / 6.0
            layer = joined.width * 0.5 * float(vectors.norm(across).sum())
            return joined if layer <= thin * volume else None
        if still_open < fewest:
            fewest, best = still_open, joined
    return best if allow_open else None


def measure_gaps(vertices: Points, edges: MeshEdges, size: float) -> tuple[int, int, float, Points]:
    """Count open edges that run along others near them and those round holes; measure the widest crack.

    Of very many open edges some, evenly drawn, stand for all.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    edges : MeshEdges
        Of an open surface.
    size : float [unit of the file]
        The part's largest extent; a gap wider than ``GAP_SHARE`` of it is a hole.

    Returns
    -------
    cracks, rim_edges : int
        Numbers of open edges.
    width : float [unit of the file]
        Of the widest crack; 0 without one.
    place : (3,) float [unit of the file]
        Where the widest is.
    """
    gaps, middles = _open_gaps(vertices, edges)
    along, count = gaps <= GAP_SHARE * size, int(np.count_nonzero(edges.net))
    cracks = round(float(along.mean()) * count)
    widest = int(np.argmax(np.where(along, gaps, -1.0)))
    return cracks, count - cracks, float(gaps[widest]) if cracks else 0.0, middles[widest]


def folded_share(vertices: Points, faces: Triangles, edges: MeshEdges) -> float:
    """Return the share of the area in facets that lie back to back with a neighbour: 0 for a solid.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    edges : MeshEdges
        Of those faces.

    Returns
    -------
    float [1]
    """
    area, pairs = _back_to_back(vertices, faces, edges)
    return float(area[np.unique(pairs)].sum()) / float(area.sum())


def _join_within(
    vertices: Points, faces: Triangles, before: MeshEdges, width: float, where: str
) -> JoinedSurface | None:
    """The surface with corners within a width joined, and what is open then; None where that harms it."""
    odd = before.count % 2 == 1
    target = topology.near_pairs(vertices, np.unique([before.low[odd], before.high[odd]]), width)
    moved = target != np.arange(len(target))
    ends = target[faces]
    if (ends == ends[:, [1, 2, 0]]).any():  # a facet would vanish: it is a feature, not a crack
        return None
    # A chain of corners, each near the next, is no crack: all must be near the one they are joined with.
    opened = float(vectors.norm(vertices[moved] - vertices[target[moved]]).max(initial=0.0))
    if opened > width:
        return None
    points, joined = topology.drop_unused_corners(vertices, ends)
    try:
        points, joined, _ = turn_one_way_round(points, joined, edge_table(joined, len(points)), where)
    except MeshError:  # one side only: too much was joined
        return None
    facets = len(joined)
    points, joined, _, seams, across = close_seams(points, joined, edge_table(joined, len(points)), width)
    edges = edge_table(joined, len(points))
    # facets that now share an edge must not lie back to back
    whole = joined[:facets]
    area, pairs = _back_to_back(points, whole, edges)
    sides = points[whole] - points[whole[:, [1, 2, 0]]]
    solid = area > SLIVER_WIDTHS * width * vectors.norm(sides).max(axis=1)
    if solid[pairs].all(axis=1).any():
        return None
    return JoinedSurface(points, joined, edges, max(opened, across), int(moved.sum()), seams)


def _back_to_back(vertices: Points, faces: Triangles, edges: MeshEdges) -> tuple[Floats, Ints]:
    """(F,) twice the area of each facet, (N, 2) neighbours across an edge of two that face each other."""
    pairs = edges.mates(edges.count == 2)
    i, j = pairs[(pairs < len(faces)).all(axis=1)].T
    a, b, c = (vertices[corner] for corner in faces.T)
    across = vectors.cross(b - a, c - a)
    area = vectors.norm(across)
    opposed = np.einsum("nx,nx->n", across[i], across[j]) < FOLD_COSINE * area[i] * area[j]
    return area, np.column_stack([i[opposed], j[opposed]])


def _open_gaps(vertices: Points, edges: MeshEdges) -> tuple[Floats, Points]:
    """Return how far open edges, evenly drawn, are from the nearest along them; their middles.

    Infinite without one.
    """
    open_edges = np.flatnonzero(edges.net)
    chosen = np.arange(0, len(open_edges), -(-(len(open_edges) ** 2) // MAX_COMPARISONS))
    tails, heads = vertices[edges.low[open_edges]], vertices[edges.high[open_edges]]
    facet, directions = edges.order[edges.start[open_edges]] // 3, heads - tails
    squares = np.maximum(np.einsum("nx,nx->n", directions, directions), np.finfo(float).tiny)
    widest = []
    rows = max(1, COMPARED_AT_ONCE // len(tails))
    for edge in np.array_split(chosen, -(-len(chosen) // rows)):
        cosine = np.abs(np.einsum("ex,nx->en", directions[edge], directions)) / np.sqrt(
            squares[edge, None] * squares
        )
        parallel = (cosine > CRACK_ALONG) & (facet[edge, None] != facet)
        gap = np.zeros(len(edge))
        for share in (0.0, 0.5, 1.0):
            offset = (tails[edge] + share * directions[edge])[:, None] - tails
            t = np.clip(np.einsum("enx,nx->en", offset, directions) / squares, 0.0, 1.0)
            distance = vectors.norm(offset - t[..., None] * directions)
            gap = np.maximum(gap, np.where(parallel, distance, np.inf).min(axis=1))
        widest.append(gap)
    return np.concatenate(widest), 0.5 * (tails[chosen] + heads[chosen])


FAN_RIM_CORNERS = 60  # corners: rims with more are closed by a fan


def find_holes(vertices: Points, edges: MeshEdges) -> tuple[list[list[int]], float, Points]:
    """Find the rim of each hole of an open surface, and the widest hole.

    Open sides are strung together to closed rims that pass no corner twice.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    edges : MeshEdges
        Of an open surface.

    Returns
    -------
    rims : list of list of int
        Corners of each rim, against the sense of the facets beside it.
    width : float [unit of the file]
        Of the widest hole: twice the largest distance of its corners from their middle.
    middle : (3,) float [unit of the file]
        Of that hole's corners.
    """
    heads, tails = edges.rim()
    onward: dict[int, list[int]] = {}
    for tail, head in zip(tails.tolist(), heads.tolist()):
        onward.setdefault(tail, []).append(head)
    rims = []
    for start in list(onward):
        path, place = [start], {start: 0}
        while onward[path[-1]]:
            corner = onward[path[-1]].pop()
            if corner in place:
                rim, path = path[place[corner] :], path[: place[corner] + 1]
                rims.append(rim)
                for passed in rim[1:]:
                    del place[passed]
            else:
                place[corner] = len(path)
                path.append(corner)
    hole = np.repeat(np.arange(len(rims)), [len(rim) for rim in rims])
    corners = vertices[np.concatenate(rims)]
    sums = np.column_stack([np.bincount(hole, column) for column in corners.T])
    middles = sums / np.bincount(hole)[:, None]
    radii = np.zeros(len(rims))
    np.maximum.at(radii, hole, np.linalg.norm(corners - middles[hole], axis=1))
    widest = int(np.argmax(radii))
    return rims, 2.0 * float(radii[widest]), middles[widest]


def cap_holes(vertices: Points, rims: list[list[int]]) -> Floats:
    """Return triangles that close holes: of least area in all, or a fan from the middle of a long rim.

    Either is exact where the rim is flat.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    rims : list of list of int
        As ``find_holes`` returns them; one of more than ``FAN_RIM_CORNERS`` corners is long.

    Returns
    -------
    (N, 3, 3) float [unit of the file]
        Corners by triangle.
    """
    caps = []
    for rim in (vertices[rim] for rim in rims):
        middle = np.broadcast_to(rim.mean(axis=0), rim.shape)
        fan = len(rim) > FAN_RIM_CORNERS
        caps.append(np.stack([rim, np.roll(rim, -1, axis=0), middle], axis=1) if fan else _patch(rim))
    return np.concatenate(caps)


def _patch(rim: Points) -> Floats:
    """(K - 2, 3, 3) triangles of least area over a closed polygon of K corners in space.

    Dynamic programming over its chords (G. Barequet, M. Sharir, "Filling gaps in the boundary of a
    polyhedron", Comput. Aided Geom. Des. 12(2), 207-229, 1995).
    """
    count = len(rim)
    least, apex = np.zeros((count, count)), np.zeros((count, count), dtype=int)
    for step in range(2, count):
        for i in range(count - step):
            j, k = i + step, np.arange(i + 1, i + step)
            areas = 0.5 * vectors.norm(vectors.cross(rim[k] - rim[i], rim[j] - rim[i]))
            total = least[i, k] + least[k, j] + areas
            apex[i, j] = k[np.argmin(total)]
            least[i, j] = total.min()
    chords, triangles = [(0, count - 1)], []
    while chords:
        i, j = chords.pop()
        if j - i > 1:
            triangles.append((i, apex[i, j], j))
            chords += [(i, apex[i, j]), (apex[i, j], j)]
    return rim[np.array(triangles, dtype=int).reshape(-1, 3)]
