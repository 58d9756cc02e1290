"""Results of a trial in one bowl: by orientation, beside what the static rule says of each.

And on which aspects parts leave a queue, beside what somebody measured at the outlet of a bowl.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from feederscrew.arrivals.ensemble import wilson
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.columns import Column
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.feeding import stream
from feederscrew.motion import conveying as answer
from feederscrew.motion.hop import hop
from feederscrew.resting import deviation
from feederscrew.resting.profiles import AspectProfile
from feederscrew.sorting.falling import too_near
from feederscrew.sorting.orientations import Orientation, neck
from feederscrew.sorting.tipping import is_surely_gone, steady
from feederscrew.trials import course
from feederscrew.trials.course import Landing
from feederscrew.trials.fills import FilledQueue
from feederscrew.trials.queue_counts import MAX_QUEUE_DEPTH_M, QueuedParts

CLEAR_MARGIN_M = 2.5e-4  # [m] margin from which a static verdict should hold
VERDICT_SHARE = 0.95  # [1] of the trials in which it should


@dataclass(frozen=True, eq=False)
class TrialRun:
    """Outcomes of parts in one bowl; M orientations, S stations."""

    bowl: Bowl
    throw_number: float  # [1]
    orientations: stream.Orientations  # and what the static rule says of each
    shares: Floats  # (M,) [1] in which they are offered: of those tried, sums to 1
    course: course.Course
    queue: QueuedParts | None = None  # None where it was not asked for
    landing: Landing | None = None  # the same
    filled_wanted: str = ""  # name of the orientation that counts as good there
    filled: FilledQueue | None = None  # what the queue did at a fill of ``feeder design``; None of others

    @property
    def partial(self) -> bool:
        """Tell whether the user stopped it before all was done."""
        return any(run.partial for run in (self.course, self.landing, self.queue) if run is not None)

    @cached_property
    def counts(self) -> Ints:
        """Return (M, 7) int, parts by the orientation laid down and by fate, columns as ``course.FATES``."""
        counts = np.zeros((len(self.shares), len(course.FATES)), int)
        np.add.at(counts, (self.course.entry_rows, self.course.fates), 1)
        return counts

    @property
    def tried_counts(self) -> Ints:
        """Return how many of each orientation were tried, (M,) int."""
        return self.counts.sum(axis=1)

    @property
    def ends(self) -> Floats:
        """Return (M, 2) [1] Wilson intervals of the share that passes; 0 to 1 where none was tried."""
        rows = zip(self.counts[:, course.PASSED], self.tried_counts)
        return np.array([[float(end[0]) for end in wilson([passes], total)] for passes, total in rows])

    @cached_property
    def matrix(self) -> Ints:
        """Return (M, S + 1) int, from orientation in to orientation out; the last column is unknown ones."""
        counts = np.zeros((len(self.shares), len(self.orientations.states) + 1), int)
        out = self.course.orientations[-1]
        whole = np.isin(self.course.fates, (course.PASSED, course.TURNED))
        np.add.at(counts, (self.course.entry_rows[whole], out[whole]), 1)  # OTHER is the last
        return counts

    @property
    def leaving_shares(self) -> Floats:
        """Return (S + 1,) [1] share of the parts offered that leaves in each orientation."""
        counts = np.maximum(self.tried_counts, 1)[:, None]
        return (self.shares[:, None] * self.matrix / counts).sum(axis=0)

    @property
    def main_row(self) -> int | None:
        """Return the known orientation in which most leave, the unknown left out; None where none does."""
        shares = self.leaving_shares[:-1]
        return int(np.argmax(shares)) if shares.any() else None

    @property
    def efficiency(self) -> float:
        """Return the share of the parts offered that leaves in that orientation [1]."""
        return float(self.leaving_shares[:-1].max())

    @property
    def purity(self) -> float:
        """Return the share of that orientation in what leaves [1]; NaN where nothing does."""
        total = self.leaving_shares.sum()
        return self.efficiency / float(total) if total > 0.0 else np.nan

    @property
    def velocity(self) -> float:
        """Return the mean velocity [m/s] on the bare track of parts that travel up it, by the shares.

        Where none does, of those that roll back; NaN where none moves.
        """
        up = self._mean(self.course.velocities > 0.0)
        return up if np.isfinite(up) else self.roll_back_velocity

    @property
    def roll_back_velocity(self) -> float:
        """Return the mean velocity on the bare track [m/s] of parts that roll back; NaN where none does."""
        return self._mean(self.course.velocities < 0.0)

    def _mean(self, which: Bools) -> float:
        """Mean velocity of some of the parts that do not stick on the bare track, by the shares."""
        ran = self.course
        which = which & ~((ran.end_stations == 0) & np.isin(ran.fates, (course.STOPPED, course.STUCK)))
        weights = (self.shares / np.maximum(self.tried_counts, 1))[ran.entry_rows][which]
        total = weights.sum()
        return float((weights * ran.velocities[which]).sum() / total) if total > 0.0 else np.nan

    @cached_property
    def rebound(self) -> answer.Neighbours | None:
        """Return the velocities of a point at both ends of the spread of restitution; None if none hops."""
        return answer.restitution_doubt(self.bowl) if self.throw_number > 1.0 else None

    @property
    def parts(self) -> float:
        """Return delivered parts [1/s]: counted in the queue, else what is offered times the efficiency.

        Parts are offered as far apart as the devices need, as in ``feeder rate``.
        """
        if self.queue is not None:
            return self.queue.rate
        if self.main_row is None or not self.velocity > 0.0:
            return 0.0
        gap = stream.needed_spacing(self.bowl.devices, self.orientations.lying, self.bowl)
        offered = self.velocity / (float((self.shares * self.orientations.lengths).sum()) + gap)
        most = self.velocity / self.orientations.states[self.main_row].length
        return float(min(offered * self.efficiency, most))

    @property
    def jams(self) -> int:
        """Count parts that neither passed nor were returned; in a queue, those that had to be taken out."""
        if self.queue is not None:
            return self.queue.jams
        return int(self.counts[:, [course.HANGING, course.STOPPED, course.STUCK]].sum())

    @property
    def passes_by_rule(self) -> Bools:
        """Return (M,) bool, whether the static rule lets an orientation pass."""
        return self.orientations.through > 0.5

    @cached_property
    def agreeing_counts(self) -> Ints:
        """Return (M,) int, of the parts tried those that did what the static rule says.

        A part that shall not pass may be returned or held; one that leaves turned has not been.
        """
        passed, turned = self.counts[:, course.PASSED], self.counts[:, course.TURNED]
        return np.where(self.passes_by_rule, passed, self.tried_counts - passed - turned)

    @property
    def margin(self) -> Floats:
        """Return (M,) [m] of the static verdict; NaN without one.

        It has none where nothing was met, the orientation was lost before, or the rule is not sure.
        """
        lost = np.array([orientation.returned for orientation in self.orientations.lying])
        return np.where(lost | ~self.is_sure, np.nan, self.orientations.margin)

    @cached_property
    def is_sure(self) -> Bools:
        """Return (M,) bool, whether the static rule is sure of an orientation that comes alone.

        What passes may rock where a device leaves little of its foot; what a hole does not carry may rest
        in it.
        """
        lying, is_sure = self.orientations.lying, self.orientations.sure.copy()
        rows = np.flatnonzero(is_sure & self.passes_by_rule)
        is_sure[rows] = steady(self.bowl.devices, [lying[k] for k in rows], self.bowl, CLEAR_MARGIN_M)
        return is_sure & is_surely_gone(self.bowl.devices, lying, self.orientations.passes)

    @property
    def differs(self) -> Bools:
        """Return (M,) bool, where fewer than VERDICT_SHARE did what the static verdict says, sure or not."""
        return (self.tried_counts > 0) & (self.agreeing_counts < VERDICT_SHARE * self.tried_counts)

    @property
    def is_odd(self) -> Bools:
        """Return (M,) bool, where fewer than ``VERDICT_SHARE`` did what a verdict of a clear margin says."""
        margin = np.abs(np.nan_to_num(self.margin, nan=np.inf))
        return self.differs & (margin > CLEAR_MARGIN_M) & self.is_sure

    @property
    def sorts(self) -> bool:
        """Tell whether what shall pass leaves, nothing else does, and nothing stops: sure of it or not."""
        passed = self.counts[:, course.PASSED]
        lost = self.passes_by_rule & (passed < VERDICT_SHARE * self.tried_counts)
        stays = ~self.passes_by_rule & (self.tried_counts - passed < VERDICT_SHARE * self.tried_counts)
        return not (lost.any() or stays.any() or self.jams)

    @cached_property
    def wedge_depths(self) -> Floats:
        """Return (M,) [m], by how much too near to the wall the rails are between which each hung; else 0."""
        spans = [device.span for device in self.bowl.devices if device.action is Action.HANG]
        hung = self.counts[:, [course.TURNED, course.HANGING]].sum(axis=1) > 0
        necks = [neck(lying) if own else None for lying, own in zip(self.orientations.lying, hung)]
        gaps = [max((too_near(own, span) for span in spans if own), default=0.0) for own in necks]
        return np.array(gaps, float)

    @property
    def depths(self) -> Floats:
        """Return the deepest that a part of each orientation was in anything, (M,) [m]."""
        deepest = np.zeros(len(self.shares))
        np.maximum.at(deepest, self.course.entry_rows, self.course.depths)
        return deepest

    @property
    def remarks(self) -> Iterator[str]:
        """Say what a user must not overlook, a sentence each."""
        if self.throw_number > 1.0:
            hops, (low, high) = hop(self.bowl), answer.rebounds(self.bowl)
            yield (
                f"throw number {self.throw_number:.3g}: parts hop {1e3 * hops.height:.2g} mm high and fly "
                f"{1e3 * hops.flight:.2g} mm - margins of static verdicts are less that"
            )
            if self.rebound is not None:
                yield (
                    f"restitution of single impacts spreads from {low:.3g} to {high:.3g}: a point would "
                    f"travel at {1e3 * self.rebound.less:.4g} to {1e3 * self.rebound.more:.4g} mm/s - "
                    "velocities and rates here are of the value between"
                )
        names = [lying.name for lying in self.orientations.lying]
        for k in np.flatnonzero(self.is_odd):
            verdict = "passes" if self.passes_by_rule[k] else "is returned"
            if np.isfinite(self.margin[k]):  # the bare track gives none
                verdict += f", margin {1e3 * self.margin[k]:.2f} mm"
            did = f"{self.agreeing_counts[k]} of {self.tried_counts[k]}"
            yield f"{names[k]}: {did} do what the static verdict says ({verdict})"
        for k in np.flatnonzero(self.wedge_depths):
            yield (
                f"{names[k]}: hangs with its head at the wall and its shank at a rail, and may wedge there, "
                "which rigid parts of a trial do not - put the rails "
                f"{1e3 * self.wedge_depths[k]:.2g} mm farther from the wall"
            )
        for k in np.flatnonzero(self.depths > CLEAR_MARGIN_M):
            yield (
                f"{names[k]}: up to {1e3 * self.depths[k]:.2g} mm deep in the track or a device, where "
                "corners and edges slipped past each other's contacts: do not go by this row"
            )
        if self.queue is not None and self.queue.depth > MAX_QUEUE_DEPTH_M:
            yield (
                f"queue: parts were up to {1e3 * self.queue.depth_in_part:.2g} mm deep in each other and "
                f"{1e3 * self.queue.depth_in_track:.2g} mm in the track or a device, "
                f"{1e3 * MAX_QUEUE_DEPTH_M:g} mm at most are asked for: do not go by what stood there"
            )
        if not self.velocity > 0.0:
            yield "the part does not travel up the track: see feeder convey"


RUN_DRIVE_COLUMNS: tuple[Column[TrialRun], ...] = (
    Column("amplitude_mm", lambda run: run.bowl.drive.amplitude, "mm"),
    Column("throw_number", lambda run: run.throw_number),
    Column("velocity_mm_s", lambda run: run.velocity, "mm/s"),
)
RUN_COLUMNS: tuple[Column[TrialRun], ...] = (
    Column("rolls_back_mm_s", lambda run: run.roll_back_velocity, "mm/s"),
    Column("parts_per_minute", lambda run: run.parts, "1/min"),
    Column("efficiency", lambda run: run.efficiency, "share"),
    Column("purity", lambda run: run.purity, "share"),
    Column("jams", lambda run: run.jams),
)


@dataclass(frozen=True, eq=False)
class Outlet:
    """Parts that left a queue, by aspect; A aspects."""

    aspects: tuple[str, ...]
    offered: Floats  # (A,) [1] shares in which parts come, 0 of an aspect that is not tried
    counts: Ints  # (A,) whole parts that left, against the wall or away from it
    other_count: int  # further ones: hanging, or on no aspect
    columns: tuple[AspectProfile, ...]  # what was measured, over the same aspects

    @property
    def shares(self) -> Floats:
        """Return (A,) [1] of the parts that left on an aspect; NaN where none did."""
        total = self.counts.sum()
        return self.counts / total if total else np.full(len(self.counts), np.nan)

    @property
    def ends(self) -> Floats:
        """Return (2, A) [1] Wilson interval of each share."""
        return np.array(wilson(self.counts, self.counts.sum()))

    @property
    def distances(self) -> dict[str, tuple[float, float]]:
        """Return the root mean square difference and total variation [1] from each column, by its name."""
        own = self.shares
        return {
            profile.name: (deviation.deviation(own, mine), deviation.total_variation(own, mine))
            for profile in self.columns
            if np.isfinite(own).all()
            for mine in [profile.fractions / profile.fractions.sum()]
        }


OUTLET_COLUMNS: tuple[Column[Outlet], ...] = (
    Column("aspect", lambda outlet: outlet.aspects),
    Column("offered", lambda outlet: outlet.offered),
    Column("parts", lambda outlet: outlet.counts),
    Column("share", lambda outlet: outlet.shares, "share"),
    Column("low", lambda outlet: outlet.ends[0], "share"),
    Column("high", lambda outlet: outlet.ends[1], "share"),
)


def outlet(
    queue: QueuedParts,
    orientations: Sequence[Orientation],
    shares: Floats,
    aspects: Sequence[str],
    columns: Sequence[AspectProfile] = (),
) -> Outlet:
    """Return the parts that left a queue by aspect, beside what was measured.

    Parameters
    ----------
    queue : QueuedParts
    orientations : sequence of Orientation
        The M in which its parts come.
    shares : (M,) float [1]
        In which they come.
    aspects : sequence of str
        Names of the A aspects, as the queue counts them.
    columns : sequence of AspectProfile, optional
        Measured shares over the same aspects.

    Returns
    -------
    Outlet
    """
    offered = np.zeros(len(aspects))
    np.add.at(offered, [aspects.index(orientation.aspect) for orientation in orientations], shares)
    counts, other = queue.aspects[:-1], int(queue.aspects[-1])
    return Outlet(tuple(aspects), check.frozen(offered), counts, other, tuple(columns))
