"""What the static rules say passes each device, from the shares of the aspects: for feeding tests."""

from collections.abc import Sequence

import numpy as np

from feederscrew import check
from feederscrew.documents import hint
from feederscrew.errors import FeederError
from feederscrew.rates.stream import Orientations
from feederscrew.resting.counts.passed import DeviceCounts


def places(known: Orientations, counts: DeviceCounts) -> np.ndarray:
    """Return the stations of a chain that were counted.

    Source: docs/counts.md, "A feeding test, device by device".

    Parameters
    ----------
    known : Orientations
    counts : DeviceCounts
        Its devices are named as the stations are, 'gap_2', or by a kind that is there once.

    Returns
    -------
    (D,) int [1]

    Raises
    ------
    FeederError
        If one is not there, or is counted twice.
    """
    stations = {name: place for place, name in enumerate(known.names)}
    once = {kind: known.stations.index(kind) for kind in known.stations if known.stations.count(kind) == 1}
    found: list[int] = []
    for line, name in zip(counts.lines, counts.names):
        place, where = (once | stations).get(name), f"{counts.source}:{line}"
        if place is None:
            what = f"the bowl has no device {name[:30]!r}"
            raise FeederError(where, what, hint(name, list(stations)))
        if place in found:
            what = f"device {name!r} is that of line {counts.lines[found.index(place)]}"
            raise FeederError(where, what, "keep one of them")
        found.append(place)
    return np.array(found)


def ways(known: Orientations, names: Sequence[str]) -> np.ndarray:
    """Return which share of each aspect's parts comes to each station, and which goes on from it.

    Source: own; docs/counts.md, "A feeding test, device by device".

    Parameters
    ----------
    known : Orientations
    names : sequence of str
        Of the A aspects.

    Returns
    -------
    (2, stations, A) float [1]
    """
    on = np.cumprod(known.passes, axis=1)
    came = np.column_stack([np.ones(len(on)), on[:, :-1]])
    of = np.zeros((len(on), len(names)))
    of[np.arange(len(on)), [names.index(name) for name in known.aspects]] = known.heading_shares
    return check.frozen(np.einsum("kms,ma->ksa", np.stack([came, on]), of))


def passing(flow: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Return the share that passes of the parts that come, (D,) [1]; NaN where none comes.

    Source: own; docs/counts.md, "A feeding test, device by device".

    Parameters
    ----------
    flow : (2, D, A) float [1]
        From ``ways``.
    shares : (A,) float [1]
        Of the aspects.
    """
    came, on = np.einsum("kda,a->kd", flow, np.nan_to_num(shares))
    return np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), np.nan)


def passing_ends(flow: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the least and the greatest share that passes if every aspect's share lies within its ends.

    Source: a linear programme over a simplex with bounds; docs/conveying.md, "Commands".

    Parameters
    ----------
    flow : (2, D, A) float [1]
        From ``ways``.
    low, high : (A,) float [1]
        Of the shares of the aspects; that they sum to 1 is not used.

    Returns
    -------
    low, high : (D,) float [1]
        NaN where no part can come.

    Notes
    -----
    A ratio of two linear functions on a box is greatest where the aspects of which most passes have their
    greatest share and the others their least; each place for the cut between them is tried.
    """
    ends = [_extremes(came, on, np.nan_to_num(low), np.nan_to_num(high)) for came, on in zip(*flow)]
    return tuple(np.array(ends).T)


def _extremes(came: np.ndarray, on: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[float, float]:
    each = np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), 0.0)
    order = np.argsort(each, kind="stable")
    came, on, low, high = came[order], on[order], low[order], high[order]
    above = np.tri(len(came) + 1, len(came), -1, dtype=bool)  # row c: the first c aspects
    found = []
    for shares in (np.where(above, high, low), np.where(above, low, high)):
        total = (shares * came).sum(axis=1)
        found.append(
            np.where(total > 0.0, (shares * on).sum(axis=1) / np.where(total > 0.0, total, 1.0), np.nan)
        )
    if np.isnan(found).all():
        return np.nan, np.nan
    return float(np.nanmin(found[0])), float(np.nanmax(found[1]))
