"""Barriers between resting faces: how high a part must be lifted to tip, and into what it tips."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.arrays import Floats, Ints, Points
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import fitting
from feederscrew.geometry.vectors import solid_angles
from feederscrew.heavy import heavy
from feederscrew.resting import landscape

sparse = heavy("scipy.sparse")

UNNAMED = landscape.NAMELESS  # label of a hull triangle or a sink that belongs to no face
SPHERE = 4.0 * np.pi  # [sr]
SADDLE_TIE = 1e-6  # of the highest saddle: what rounding in a file leaves between the saddles of mirror twins


@dataclass(frozen=True, eq=False)
class Tumbling:
    """Basins of the flow down the height of the centre of mass; S sinks, E saddles, M maxima.

    Directions are "down" in the part's axes. A sink is a stable facet, a saddle an edge and a maximum
    a corner over which the part can be balanced.
    """

    sinks: Ints  # (S,) a hull triangle of each sink
    normals: Floats  # (S, 3) outward unit normal
    heights: Floats  # (S,) [m] of the centre of mass
    areas: Floats  # (S,) [sr] directions from which the part ends there
    pairs: Ints  # (E, 2) sinks on both sides of each saddle
    saddle_heights: Floats  # (E,) [m]
    saddle_axes: Floats  # (E, 3) unit, along the edge
    maxima: Ints  # (M,) hull corners
    doubts: tuple[str, ...]  # self-checks that failed; empty for a result to trust

    @property
    def shares(self) -> Floats:
        """(S,) [1] probability of each sink when every direction is equally likely."""
        return self.areas / SPHERE


@dataclass(frozen=True, eq=False)
class Tipping:
    """Exact tumbling gathered by face: F faces, B ways between two of them, the lowest of each pair."""

    shares: Floats  # (F,) [1] probability when every direction is equally likely
    heights: Floats  # (F,) [m] of the centre of mass, lowest sink of the face; NaN without a sink
    pairs: Ints  # (B, 2) faces on both sides, the smaller index first
    tops: Floats  # (B,) [m] height of the centre of mass on the way's saddle
    axes: Floats  # (B, 3) unit vector along the edge the part tips over
    doubts: tuple[str, ...]  # of the tumbling


def gather_tipping(tumbling: Tumbling, labels: Ints) -> Tipping:
    """Return basins and saddles of exact tumbling, gathered by face.

    ``labels`` (T,) int: face of each hull triangle; UNNAMED for triangles of none. A sink of no face (a facet
    that noise or tessellation left) joins the face behind the lowest saddle around it, or the faces behind
    saddles as low as each other, in equal parts. Raises ValueError if no sink carries a label.
    """
    labels = np.asarray(labels)
    basins = adopted_shares(tumbling, labels[tumbling.sinks], labels.max() + 1)
    heights = np.full(basins.shape[1], np.inf)
    sinks = np.repeat(np.arange(basins.shape[0]), np.diff(basins.indptr))
    np.minimum.at(heights, basins.indices, tumbling.heights[sinks])
    # each way from a face to a face: its saddle and the faces on both sides, smaller first
    many = np.diff(basins.indptr)[tumbling.pairs]
    paths = many[:, 0] * many[:, 1]
    saddles = np.repeat(np.arange(len(tumbling.pairs)), paths)
    step = np.arange(len(saddles)) - np.repeat(np.cumsum(paths) - paths, paths)
    turn = np.column_stack(np.divmod(step, many[saddles, 1]))
    first, other = basins.indices[basins.indptr[tumbling.pairs[saddles]] + turn].T
    faces = np.column_stack([np.minimum(first, other), np.maximum(first, other)])
    order = np.flatnonzero(faces[:, 0] != faces[:, 1])
    order = order[np.lexsort((tumbling.saddle_heights[saddles[order]], *faces[order, ::-1].T))]
    pairs = faces[order]
    first = np.append(True, (pairs[1:] != pairs[:-1]).any(axis=1))[: len(pairs)]
    pairs, lowest = pairs[first], saddles[order[first]]
    return Tipping(
        shares=check.frozen(np.bincount(basins.indices, tumbling.shares[sinks] * basins.data, len(heights))),
        heights=check.frozen(np.where(np.isfinite(heights), heights, np.nan)),
        pairs=check.frozen(pairs),
        tops=check.frozen(tumbling.saddle_heights[lowest]),
        axes=check.frozen(tumbling.saddle_axes[lowest]),
        doubts=tumbling.doubts,
    )


def rises(tips: Tipping) -> Floats:
    """Return the lift (B, 2) [m] of the centre of mass on the way from the first face and from the second.

    Source: docs/resting.md, "Barriers and the tipping graph".
    """
    return np.maximum(tips.tops[:, None] - tips.heights[tips.pairs], 0.0)


def barriers(tips: Tipping) -> Floats:
    """Return the lowest lift (F,) [m] that tips each face into another; infinite where nothing does."""
    lowest = np.full(len(tips.shares), np.inf)
    np.minimum.at(lowest, tips.pairs.ravel(), rises(tips).ravel())
    return lowest


def tip_angles(polygons: Sequence[Points], heights: Floats | Sequence[float]) -> Floats:
    """Return the tilt (F,) [rad] of the floor at which a part that does not slide tips over its contact.

    It is negative where the part does not even stand on a level floor. ``polygons`` (K, 3) [m]: corners about
    the centre of mass, counter-clockwise seen from outside; F polygons; ``heights`` (F,) [m]: of the centre
    of mass over them.
    Source: docs/resting.md, "Barriers and the tipping graph".
    """
    _, across, first, counts = _edge_levers(polygons)
    return np.minimum.reduceat(np.arctan2(across, np.repeat(heights, counts)), first)


def critical_solid_angles(polygons: Sequence[Points], heights: Floats) -> Floats:
    """Return the share of each face's solid angle left when the mean critical one is taken off: (F,) [1].

    ``polygons`` and ``heights``: as in `tip_angles`. It is (Q - mean over the edges of Q_crit) / Q; 0 where Q
    is. Q_crit of an edge is the solid angle of the polygon seen from the centre of mass lifted, upright, to
    its distance from that edge: where it passes when the part tips. The rule's weight is this times Q / h.
    Source: B. K. A. Ngoi, S. W. Lye, J. Chen, "Analysing the natural resting aspect of a component for
    automated assembly", Int. J. Adv. Manuf. Technol. 11, 406-412, 1996, doi 10.1007/BF01178966: read in a
    restatement only, the paper itself was not at hand.
    """
    normals, across, first, counts = _edge_levers(polygons)
    heights, corners = np.repeat(heights, counts), np.concatenate(polygons)
    lifts, shares = np.hypot(across, heights) - heights, np.empty(len(polygons))
    for size in np.unique(counts):
        same_size = np.flatnonzero(counts == size)
        edges = first[same_size, None] + np.arange(size)
        # solid angles of the polygons from the centre of mass as it is and from each lift of it
        own = corners[edges]
        apex, middle, end = own[:, :1], own[:, 1:-1], own[:, 2:]
        fan = np.stack([np.broadcast_to(apex, middle.shape), middle, end], axis=2)
        down = np.insert(lifts[edges], 0, 0.0, axis=1)[..., None] * normals[same_size][:, None]
        triangles = fan[:, None] + down[:, :, None, None]
        angles = solid_angles(np.zeros(3), triangles.reshape(-1, 3, 3))
        angles = angles.reshape(triangles.shape[:3]).sum(axis=-1)
        critical, whole = angles[:, 1:].mean(axis=1), angles[:, 0]
        shares[same_size] = 1.0 - np.divide(critical, whole, out=np.ones(len(whole)), where=whole > 0.0)
    return shares


def balance(tips: Tipping) -> Floats:
    """Return the shares (F,) [1] that stay the same when every face keeps tipping into its neighbours.

    They are the stationary shares of a chain in which a face tips into each neighbour at a rate inverse to
    the lift which that takes. Zero for faces without a sink. Boothroyd and
    Redford balance the transitions between two aspects of prisms and cylinders, N_a / N_b = E_a / E_b with E
    the energy to leave each; their book was not at hand. This is that balance on any number of faces, with
    the saddle between two basins as the height the part must be lifted to.
    Source: G. Boothroyd, A. H. Redford, "Mechanized Assembly", McGraw-Hill, 1968.

    States are taken out one by one and their traffic led past them; no difference is taken, so that rates
    many orders of magnitude apart do no harm: W. K. Grassmann, M. I. Taksar, D. P. Heyman, "Regenerative
    analysis and steady state distributions for Markov chains", Oper. Res. 33(5), 1107-1116, 1985.
    """
    count = len(tips.shares)
    rates = np.zeros((count, count))
    lift = np.maximum(rises(tips), 1e-12 * np.nanmax(tips.heights))
    for k in (0, 1):
        rates[tips.pairs[:, k], tips.pairs[:, 1 - k]] = 1.0 / lift[:, k]
    present = np.flatnonzero(np.isfinite(tips.heights))
    rates, shares = rates[np.ix_(present, present)], np.ones(len(present))
    for last in range(len(rates) - 1, 0, -1):
        rates[:last, last] /= rates[last, :last].sum() or np.inf
        rates[:last, :last] += rates[:last, last, None] * rates[last, :last]
    for k in range(1, len(rates)):
        if rates[:k, k].any():
            shares[k] = (shares[:k] * rates[:k, k]).sum()
    of_faces = np.zeros(count)
    of_faces[present] = shares / shares.sum()
    return of_faces


def _edge_levers(polygons: Sequence[Points]) -> tuple[Floats, Floats, Ints, Ints]:
    """(F, 3) normals of polygons, (N,) [m] how far inside each edge the foot is; (F,) first edges, counts."""
    counts = np.array([len(polygon) for polygon in polygons])
    first = np.cumsum(counts) - counts
    corners, after = np.concatenate(polygons), np.arange(1, counts.sum() + 1)
    after[first + counts - 1] = first
    ahead = corners[after]
    normals = vectors.unit(np.add.reduceat(vectors.cross(corners, ahead), first))
    edges = ahead - corners
    outward = vectors.cross(edges, np.repeat(normals, counts, axis=0))
    return normals, np.einsum("ki,ki->k", corners, outward) / vectors.norm(edges), first, counts


def adopted_shares(tumbling: Tumbling, labels: Ints, count: int) -> Any:
    """Parts of every sink's basin that belong to each face.

    ``labels`` (S,) int: face of each sink; UNNAMED for a facet that noise or tessellation left; ``count``:
    faces, with or without a sink. Returns (S, F) sparse float [1]: rows sum to 1. An unnamed sink joins the
    face behind the lowest saddle around it; where several saddles are as low, as around a sink on a mirror
    plane, it is shared out among the faces behind them. Raises ValueError if no sink carries a label.
    """
    labels = np.asarray(labels)
    own = np.flatnonzero(labels != UNNAMED)
    if not len(own):
        raise ValueError("no sink of the tumbling carries a label")
    if len(own) == len(labels):
        return _links(own, labels, (len(labels), count))
    # the sink that stands for each, with which it is claimed; claimed and claiming ones
    order = np.argsort(tumbling.saddle_heights, kind="stable")
    pairs, tops = tumbling.pairs[order], tumbling.saddle_heights[order]
    parent, claims = np.arange(len(labels)), np.empty_like(pairs)
    adopt = fitting(landscape.adopt_tree, len(order))
    done = adopt(pairs, tops, SADDLE_TIE * tops.max(initial=0.0), labels.copy(), parent, claims)
    claimed, by = claims[:done].T
    claimed, by = np.divmod(np.unique(claimed * len(labels) + by), len(labels))
    members = landscape.find_roots(parent)
    goes = _links(np.append(own, claimed), np.append(own, by), (len(labels), len(labels)))
    while (labels[goes.indices] == UNNAMED).any():
        goes = goes @ goes  # twice as far along the chain of claims
    faces = type(goes)((goes.data, labels[goes.indices], goes.indptr), shape=(len(labels), count))
    faces.sum_duplicates()
    return faces[members]


def _links(start: Ints, end: Ints, shape: tuple[int, int]) -> Any:
    """Sparse matrix of equal parts, rows summing to 1, from each start to its ends."""
    return sparse.csr_array((1.0 / np.bincount(start)[start], (start, end)), shape=shape)
