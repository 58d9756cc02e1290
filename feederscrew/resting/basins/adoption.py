"""Sinks that belong to no face of their own, and the faces that take them in."""

import numpy as np

from feederscrew.geometry.compiled import fitting
from feederscrew.resting.basins import forest

UNNAMED = forest.NAMELESS  # label of a hull triangle or a sink that belongs to no face
TIE = 1e-6  # of the highest saddle: what rounding in a file leaves between the saddles of mirror twins


def adopted(tumbling, labels, count):
    """Parts of every sink's basin that belong to each face.

    Parameters
    ----------
    tumbling : Tumbling
    labels : (S,) int
        Face of each sink; UNNAMED for a facet that noise or tessellation left.
    count : int
        Faces, with or without a sink.

    Returns
    -------
    (S, F) sparse float [1]
        Rows sum to 1. An unnamed sink joins the face behind the lowest saddle around it; where several
        saddles are as low, as around a sink on a mirror plane, it is shared out among the faces behind them.

    Raises
    ------
    ValueError
        If no sink carries a label.
    """
    labels = np.asarray(labels)
    own = np.flatnonzero(labels != UNNAMED)
    if not len(own):
        raise ValueError("no sink of the tumbling carries a label")
    if len(own) == len(labels):
        return _links(own, labels, (len(labels), count))
    members, claims = _claims(tumbling, labels)
    claimed, by = claims.T
    if (np.diff(claimed) > 0).all():  # each by one
        taken = np.arange(len(labels))
        taken[claimed] = by
        return _links(np.arange(len(labels)), labels[forest.roots(taken)[members]], (len(labels), count))
    goes = _links(np.append(own, claimed), np.append(own, by), (len(labels), len(labels)))
    while (labels[goes.indices] == UNNAMED).any():
        goes = goes @ goes  # twice as far along the chain of claims
    faces = type(goes)((goes.data, labels[goes.indices], goes.indptr), shape=(len(labels), count))
    faces.sum_duplicates()
    return faces[members]


def _claims(tumbling, labels):
    """(S,) the sink that stands for each, with which it is claimed; (C, 2) claimed and claiming ones."""
    order = np.argsort(tumbling.saddle_heights, kind="stable")
    pairs, tops = tumbling.pairs[order], tumbling.saddle_heights[order]
    parent, claims = np.arange(len(labels)), np.empty_like(pairs)
    adopt = fitting(forest.adopt, len(order))
    made = adopt(pairs, tops, TIE * tops.max(initial=0.0), labels.copy(), parent, claims)
    claimed, by = claims[:made].T
    pairs = np.divmod(np.unique(claimed * len(labels) + by), len(labels))
    return forest.roots(parent), np.column_stack(pairs)


def _links(start, end, shape):
    """Sparse matrix of equal parts, rows summing to 1, from each start to its ends."""
    from scipy.sparse import csr_array  # the names of rules, of which this room is a part, need no SciPy

    return csr_array((1.0 / np.bincount(start)[start], (start, end)), shape=shape)
