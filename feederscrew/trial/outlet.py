"""On which aspects parts leave a queue, beside what somebody measured at the outlet of a bowl."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.dropping.ensemble import wilson
from feederscrew.resting.counts import deviation
from feederscrew.resting.counts.profiles import Profile


@dataclass(frozen=True, eq=False)
class Outlet:
    """Parts that left a queue, by aspect; A aspects."""

    aspects: tuple[str, ...]
    offered: np.ndarray  # (A,) [1] shares in which parts come, 0 of an aspect that is not tried
    counts: np.ndarray  # (A,) int, whole parts that left
    other: int  # further ones, on no aspect that is known: away from the wall, or hanging
    columns: tuple[Profile, ...]  # what was measured, over the same aspects

    @property
    def shares(self):
        """(A,) [1] of the parts that left on an aspect; NaN where none did."""
        total = self.counts.sum()
        return self.counts / total if total else np.full(len(self.counts), np.nan)

    @property
    def ends(self):
        """(2, A) [1] Wilson interval of each share."""
        return np.array(wilson(self.counts, self.counts.sum()))

    @property
    def apart(self):
        """Root mean square difference and total variation [1] from each column, by its name."""
        own = self.shares
        return {
            one.name: (deviation.deviation(own, mine), deviation.total_variation(own, mine))
            for one in self.columns
            if np.isfinite(own).all()
            for mine in [one.fractions / one.fractions.sum()]
        }


def outlet(queue, states, lying, shares, aspects, columns=()):
    """Return what left a queue by aspect.

    Parameters
    ----------
    queue : QueuedParts
    states : sequence of Orientation
        S of them, in which its parts may leave.
    lying : sequence of Orientation
        M of them, in which they come.
    shares : (M,) float [1]
    aspects : sequence of str
    columns : sequence of Profile
        Over those aspects.

    Returns
    -------
    Outlet
    """
    counts, offered = np.zeros(len(aspects), int), np.zeros(len(aspects))
    rows = [aspects.index(one.aspect) if one.aspect in aspects else -1 for one in states]
    for row, count in zip(rows, queue.leaving):
        counts[row] += count if row >= 0 else 0
    for one, share in zip(lying, shares):
        offered[aspects.index(one.aspect)] += share
    other = int(queue.leaving.sum() - counts.sum())
    return Outlet(tuple(aspects), check.frozen(offered), check.frozen(counts), other, tuple(columns))
