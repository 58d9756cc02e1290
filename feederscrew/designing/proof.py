"""Proof of a design: draws of part, friction, drive and cuts, and queues at its fills, with what they bring.

Source of the bounds: ``evidence``.
"""

from dataclasses import dataclass, field

import numpy as np

from feederscrew.base.columns import Column
from feederscrew.base.units import HOUR
from feederscrew.designing import texts
from feederscrew.designing.evidence import rate_at_most, share_at_least
from feederscrew.designing.findings import Fault
from feederscrew.trials.fills import (
    FedRow,
    FilledQueue,
    LeavingCounts,
    PoseKind,
    join_leaving_counts,
)
from feederscrew.trials.long_ride import LongRide


@dataclass(frozen=True)
class RobustRun:
    """Draws of part, friction, drive and cuts; each tried with some parts."""

    draws: int
    held: int
    main_fault: Fault | None = None  # what went wrong most often; None where nothing did
    slowest: float = 0.0  # [m/s] velocity of the slowest draw; 0 of none
    partial: bool = False

    @property
    def main_fault_text(self) -> str:
        """Return the most frequent fault in words, and in how many draws it came; '' without any."""
        return "" if self.main_fault is None else texts.counted_fault_text(self.main_fault)

    @property
    def share(self) -> float:
        """Return the share of the draws that sort [1]; 0 without draws."""
        return self.held / self.draws if self.draws else 0.0


ROBUST_COLUMNS: tuple[Column[RobustRun], ...] = (
    Column("draws", lambda robust: robust.draws),
    Column("held", lambda robust: robust.held),
    Column("worst", lambda robust: robust.main_fault_text),
)


@dataclass(frozen=True, eq=False)
class Proof:
    """Draws and queues of a design with their figures; empty if the design was not proved.

    A fill is how full the bowl is kept; each has a queue. Rate, purity and efficiency are each the least of
    all fills, and may come from different ones: what a cleaner fill does improves none of them.
    """

    robust: RobustRun = field(default_factory=lambda: RobustRun(0, 0))
    queues: tuple[FilledQueue, ...] = ()  # one a fill
    slowed: float = 1.0  # [1] fraction of its velocity that the drive keeps at the worst friction
    row: FedRow | None = None  # how parts were fed into its queues; None of what was not followed
    long_ride: LongRide | None = None  # from the track's entry to the tooling; None of what was not proved

    @property
    def worst_fill(self) -> FilledQueue | None:
        """The queue of the fill that brings least; None without one."""
        return min(self.queues, key=lambda queue: queue.rate, default=None)

    @property
    def delivered(self) -> tuple[float, float, float]:
        """Wanted parts [1/s] of the worst fill: value, low and high end of the 95 % interval.

        Each is the least of all fills, so that nothing a cleaner fill does improves it.
        """
        if not self.queues:
            return 0.0, 0.0, 0.0
        lows, highs = zip(*(queue.ends for queue in self.queues), strict=True)
        return min(queue.rate for queue in self.queues), min(lows), min(highs)

    @property
    def delivered_at_worst_friction(self) -> float:
        """Wanted parts [1/s] of the worst fill at the worst friction: its rate goes as the velocity."""
        return self.delivered[0] * self.slowed

    @property
    def purity(self) -> tuple[float, float]:
        """Share [1] of what left that is wanted, and its lower bound, of the worst fill; NaN of nothing.

        The bound is one-sided, for 95 % confidence (``evidence.share_at_least``). Each is the least of all
        fills.
        """
        shares = [queue.right / queue.left for queue in self.queues if queue.left]
        lows = (share_at_least(queue.right, queue.left) for queue in self.queues)
        return min(shares, default=np.nan), min(lows, default=0.0)

    @property
    def efficiency(self) -> float:
        """Return the share [1] of offered parts that left as wanted, of the worst fill; NaN without."""
        shares = (queue.right / queue.offered for queue in self.queues if queue.offered)
        return min(shares, default=np.nan)

    @property
    def jams(self) -> int:
        """Parts that had to be taken out of the queues."""
        return sum(queue.jams for queue in self.queues)

    @property
    def queue_seconds(self) -> float:
        """Time that queues were followed [s]."""
        return float(sum(queue.seconds for queue in self.queues))

    @property
    def jams_per_hour_high(self) -> float:
        """Upper bound of the jams an hour of the worst fill, one-sided for 95 % confidence.

        It is 3 / T of a fill that was followed for T hours without one. Jams may come at a rate of their own
        in each fill, so its hours alone count. Infinite without a queue.
        """
        bounds = (HOUR * rate_at_most(queue.jams, queue.seconds) for queue in self.queues)
        return max(bounds, default=np.inf)

    @property
    def left_instead(self) -> LeavingCounts:
        """In which poses parts left all queues otherwise than wanted, and how many, the most first."""
        return join_leaving_counts(*(queue.left_instead for queue in self.queues))

    @property
    def aspects_heading_off(self) -> tuple[str, ...]:
        """Aspects on which parts left all queues at a heading that is none of the listed."""
        return tuple(pose.aspect for pose, _ in self.left_instead if pose.kind is PoseKind.HEADING_OFF)
