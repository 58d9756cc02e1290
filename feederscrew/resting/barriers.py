"""Barriers between resting faces: how high a part must be lifted to tip, and into what it tips."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints, Points
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import fitting
from feederscrew.base.geometry.vectors import solid_angles
from feederscrew.base.heavy import heavy
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

    A sink without a face is a facet that noise or tessellation left. It joins the face behind the lowest
    saddle around it, or in equal parts the faces behind saddles as low as each other.

    Parameters
    ----------
    tumbling : Tumbling
    labels : (T,) int
        Face of each hull triangle; UNNAMED for a triangle without a face.

    Returns
    -------
    Tipping
        F faces and B ways, the lowest between each two faces.

    Raises
    ------
    ValueError
        If no sink carries a label.

    References
    ----------
    docs/resting.md, "Barriers and the tipping graph".
    """
    labels = np.asarray(labels)
    basins = adopted_shares(tumbling, labels[tumbling.sinks], labels.max() + 1)
    heights = np.full(basins.shape[1], np.inf)
    sinks = np.repeat(np.arange(basins.shape[0]), np.diff(basins.indptr))
    np.minimum.at(heights, basins.indices, tumbling.heights[sinks])
    # A sink that is shared out belongs to several faces, so a saddle between two such sinks is a way between
    # each face of one and each face of the other. ``turn`` counts through these pairs, saddle by saddle.
    many = np.diff(basins.indptr)[tumbling.pairs]
    paths = many[:, 0] * many[:, 1]
    saddles = np.repeat(np.arange(len(tumbling.pairs)), paths)
    step = np.arange(len(saddles)) - np.repeat(np.cumsum(paths) - paths, paths)
    turn = np.column_stack(np.divmod(step, many[saddles, 1]))
    first, other = basins.indices[basins.indptr[tumbling.pairs[saddles]] + turn].T
    # of all ways between two faces the lowest, the face of the smaller index first
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
    """Return the lift of the centre of mass on the way from the first face and from the second.

    Parameters
    ----------
    tips : Tipping

    Returns
    -------
    (B, 2) float [m]

    References
    ----------
    docs/resting.md, "Barriers and the tipping graph".
    """
    return np.maximum(tips.tops[:, None] - tips.heights[tips.pairs], 0.0)


def barriers(tips: Tipping) -> Floats:
    """Return the lowest lift that tips each face into another.

    Parameters
    ----------
    tips : Tipping

    Returns
    -------
    (F,) float [m]
        Infinite where nothing tips the part.

    References
    ----------
    docs/resting.md, "Barriers and the tipping graph".
    """
    lowest = np.full(len(tips.shares), np.inf)
    np.minimum.at(lowest, tips.pairs.ravel(), rises(tips).ravel())
    return lowest


def tip_angles(polygons: Sequence[Points], heights: Floats | Sequence[float]) -> Floats:
    """Return the tilt of the floor at which a part that does not slide tips over its contact.

        tan(angle) = (distance from the foot of the centre of mass to the nearest edge) / height

    Parameters
    ----------
    polygons : sequence of F (K, 3) float [m]
        Corners about the centre of mass, counter-clockwise seen from outside.
    heights : (F,) float [m]
        Of the centre of mass over them.

    Returns
    -------
    (F,) float [rad]
        Negative where the part does not even stand on a level floor.

    References
    ----------
    docs/resting.md, "Barriers and the tipping graph".
    """
    _, across, first, counts = _edge_levers(polygons)
    return np.minimum.reduceat(np.arctan2(across, np.repeat(heights, counts)), first)


def critical_solid_angles(polygons: Sequence[Points], heights: Floats) -> Floats:
    """Return the share of each face's solid angle that is left when the mean critical one is taken off.

        share = (Q - mean over the edges of Q_crit) / Q

    Q is the solid angle of the contact polygon seen from the centre of mass. Q_crit of an edge is that angle
    seen from the centre of mass lifted, upright, to its distance from that edge: as high as it passes when
    the part tips there. The rule's weight is this share times Q / h.

    Parameters
    ----------
    polygons : sequence of F (K, 3) float [m]
        As in ``tip_angles``.
    heights : (F,) float [m]

    Returns
    -------
    (F,) float [1]
        0 where Q is 0.

    References
    ----------
    B. K. A. Ngoi, S. W. Lye, J. Chen, "Analysing the natural resting aspect of a component for automated
    assembly", Int. J. Adv. Manuf. Technol. 11, 406-412, 1996, doi 10.1007/BF01178966. It was read in a
    restatement only; the paper itself was not at hand.
    """
    normals, across, first, counts = _edge_levers(polygons)
    heights, corners = np.repeat(heights, counts), np.concatenate(polygons)
    lifts, shares = np.hypot(across, heights) - heights, np.empty(len(polygons))
    # polygons with equally many corners make one array
    # polygons with equally many corners make one array
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
    """Return the shares that stay the same when every face keeps tipping into its neighbours.

    They are the stationary shares of a chain in which a face tips into each neighbour at a rate inverse to
    the lift which that takes. Boothroyd and Redford balance the transitions between two aspects of prisms and
    cylinders, N_a / N_b = E_a / E_b with E the energy to leave each; their book was not at hand. This is that
    balance on any number of faces, with the saddle between two basins as the height to which the part must be
    lifted.

    States are taken out one by one and their traffic is led past them. No difference is taken, so rates that
    are many orders of magnitude apart do no harm.

    Parameters
    ----------
    tips : Tipping

    Returns
    -------
    (F,) float [1]
        They sum to 1; zero for faces without a sink.

    References
    ----------
    G. Boothroyd, A. H. Redford, "Mechanized Assembly", McGraw-Hill, 1968. W. K. Grassmann, M. I. Taksar, D.
    P. Heyman, "Regenerative analysis and steady state distributions for Markov chains", Oper. Res. 33(5),
    1107-1116, 1985 (the elimination).
    """
    count = len(tips.shares)
    rates = np.zeros((count, count))
    lift = np.maximum(rises(tips), 1e-12 * np.nanmax(tips.heights))
    for k in (0, 1):
        rates[tips.pairs[:, k], tips.pairs[:, 1 - k]] = 1.0 / lift[:, k]
    present = np.flatnonzero(np.isfinite(tips.heights))
    rates, shares = rates[np.ix_(present, present)], np.ones(len(present))
    # elimination from the last state to the first, then the shares from the first to the last
    # elimination from the last state to the first, then the shares from the first to the last
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
    """Return normals (F, 3), the foot's depth inside each edge (N,) [m], first edges and counts (F,)."""
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
    """Return the part of every sink's basin that belongs to each face.

    A sink without a face joins the face behind the lowest saddle around it. Where several saddles are as low,
    as around a sink on a mirror plane, it is shared out among the faces behind them.

    Parameters
    ----------
    tumbling : Tumbling
    labels : (S,) int
        Face of each sink; UNNAMED for a facet that noise or tessellation left.
    count : int
        Number of faces, with or without a sink.

    Returns
    -------
    (S, F) sparse array of float [1]
        Rows sum to 1.

    Raises
    ------
    ValueError
        If no sink carries a label.

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    labels = np.asarray(labels)
    own = np.flatnonzero(labels != UNNAMED)
    if not len(own):
        raise ValueError("no sink of the tumbling carries a label")
    if len(own) == len(labels):
        return _links(own, labels, (len(labels), count))
    # Unnamed sinks that lower saddles join form one tree, and the whole tree is claimed at once: ``members``
    # names its root for each sink, ``claimed`` and ``by`` are the roots and the sinks that claim them.
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
    """Return a sparse matrix of equal parts, rows summing to 1, from each start to its ends."""
    return sparse.csr_array((1.0 / np.bincount(start)[start], (start, end)), shape=shape)
