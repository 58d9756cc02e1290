"""On which aspects parts leave a queue, beside what somebody measured at the outlet of a bowl."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.dropping.ensemble import wilson
from feederscrew.resting import deviation
from feederscrew.resting.profiles import AspectProfile


@dataclass(frozen=True, eq=False)
class Outlet:
    """Parts that left a queue, by aspect; A aspects."""

    aspects: tuple[str, ...]
    offered: np.ndarray  # (A,) [1] shares in which parts come, 0 of an aspect that is not tried
    counts: np.ndarray  # (A,) int, whole parts that left, against the wall or away from it
    other: int  # further ones: hanging, or on no aspect
    columns: tuple[AspectProfile, ...]  # what was measured, over the same aspects

    @property
    def shares(self):
        """Return (A,) [1] of the parts that left on an aspect; NaN where none did."""
        total = self.counts.sum()
        return self.counts / total if total else np.full(len(self.counts), np.nan)

    @property
    def ends(self) -> np.ndarray:
        """Return (2, A) [1] Wilson interval of each share."""
        return np.array(wilson(self.counts, self.counts.sum()))

    @property
    def distances(self) -> dict[Any, Any]:
        """Return the root mean square difference and total variation [1] from each column, by its name."""
        own = self.shares
        return {
            profile.name: (deviation.deviation(own, mine), deviation.total_variation(own, mine))
            for profile in self.columns
            if np.isfinite(own).all()
            for mine in [profile.fractions / profile.fractions.sum()]
        }


def outlet(queue, lying, shares, aspects, columns=()) -> Outlet:
    """Return what left a queue by aspect.

    Parameters
    ----------
    queue : QueuedParts
    lying : sequence of Orientation
        M of them, in which its parts come.
    shares : (M,) float [1]
    aspects : sequence of str
        Names, A of them.
    columns : sequence of AspectProfile
        Over those aspects.

    Returns
    -------
    Outlet
    """
    offered = np.zeros(len(aspects))
    np.add.at(offered, [aspects.index(orientation.aspect) for orientation in lying], shares)
    return Outlet(
        aspects=tuple(aspects),
        offered=check.frozen(offered),
        counts=queue.aspects[:-1],
        other=int(queue.aspects[-1]),
        columns=tuple(columns),
    )
