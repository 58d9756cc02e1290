"""The study of ``feeder trial``: parts of true shape on the vibrating, tooled track, one and many."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from feederscrew.bowl.devices import strangers
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.documents import hint
from feederscrew.dropping.ensemble import wilson
from feederscrew.dropping.plate.drive import throw_number
from feederscrew.errors import ArgumentError, FeederError
from feederscrew.part.record import Part
from feederscrew.rates import stream
from feederscrew.resting.aspects import Aspects, find
from feederscrew.trial import course, row, runs
from feederscrew.trial.shape import solid_of

ENGINE = "feeder's own kernel"
CLEAR = 2.5e-4  # [m] margin from which a static verdict should hold
HELD = 0.95  # [1] of the trials in which it should
PARTS, FEW = 200, 60  # parts one at a time; fewer where they only tell what a queue meets
HOPS = (
    "throw number {:.3g}: parts hop over the tooling - the static verdicts stand below 1, at an amplitude "
    "of {:.3g} mm"
)
ODD = "{}: {} of {} do what the static verdict says ({}, margin {:.2f} mm)"


@dataclass(frozen=True, eq=False)
class TrialRun:
    """What parts did in one bowl; M orientations, S stations."""

    bowl: Bowl
    throw_number: float  # [1]
    known: stream.Orientations  # and what the static rule says of each
    shares: np.ndarray  # (M,) [1] in which they are offered: of those tried, sums to 1
    course: course.Course
    queue: row.PushedRow | None  # None where it was not asked for

    @cached_property
    def counts(self):
        """(M, 4) int, parts by the orientation laid down and by fate, columns as ``course.FATES``."""
        found = np.zeros((len(self.shares), len(course.FATES)), int)
        np.add.at(found, (self.course.entered, self.course.fates), 1)
        return found

    @property
    def tried(self):
        """(M,) int."""
        return self.counts.sum(axis=1)

    @property
    def ends(self):
        """(M, 2) [1] Wilson intervals of the share that passes; 0 to 1 where none was tried."""
        rows = zip(self.counts[:, course.PASSED], self.tried)
        return np.array([[float(end[0]) for end in wilson([one], total)] for one, total in rows])

    @cached_property
    def matrix(self):
        """(M, M + 1) int, from orientation in to orientation out; the last column is none of the known."""
        found = np.zeros((len(self.shares), len(self.shares) + 1), int)
        out = self.course.orientations[-1]
        whole = self.course.fates == course.PASSED
        np.add.at(found, (self.course.entered[whole], out[whole]), 1)  # OTHER is the last
        return found

    @property
    def leaving(self):
        """(M + 1,) [1] share of the parts offered that leaves in each orientation."""
        tried = np.maximum(self.tried, 1)[:, None]
        return (self.shares[:, None] * self.matrix / tried).sum(axis=0)

    @property
    def wanted(self):
        """The orientation in which most leave; None where none does."""
        leaving = self.leaving
        return int(np.argmax(leaving)) if leaving.any() else None

    @property
    def efficiency(self):
        """Share of the parts offered that leaves in the orientation in which most do [1]."""
        return float(self.leaving.max())

    @property
    def purity(self):
        """Share of that orientation in what leaves [1]; NaN where nothing does."""
        total = self.leaving.sum()
        return float(self.leaving.max() / total) if total > 0.0 else np.nan

    @property
    def velocity(self):
        """Mean velocity on the bare track [m/s], each orientation by its share; NaN where none travels."""
        found, weights = (
            self.course.velocities,
            (self.shares / np.maximum(self.tried, 1))[self.course.entered],
        )
        travels = np.isfinite(found)
        weight = weights[travels].sum()
        return float((weights * found)[travels].sum() / weight) if weight > 0.0 else np.nan

    @property
    def parts(self):
        """Delivered parts [1/s]: counted in the queue, else what the velocity offers times the efficiency."""
        if self.queue is not None:
            return self.queue.delivered / self.queue.seconds
        if self.wanted is None or not self.velocity > 0.0:
            return 0.0
        offered = self.velocity / float((self.shares * self.known.lengths).sum())
        most = self.velocity / self.known.lengths[min(self.wanted, len(self.shares) - 1)]
        return float(min(offered * self.efficiency, most))

    @property
    def jams(self):
        """Parts that neither passed nor were returned; in a queue, those that had to be taken out."""
        if self.queue is not None:
            return self.queue.jams
        return int(self.counts[:, [course.HANGING, course.STUCK]].sum())

    @property
    def predicted(self):
        """(M,) bool, whether the static rule lets an orientation pass."""
        return self.known.through > 0.5

    @cached_property
    def holding(self):
        """(M,) int, of the parts tried those that did what the static rule says."""
        passed = self.counts[:, course.PASSED]
        return np.where(self.predicted, passed, self.tried - passed)

    @property
    def odd(self):
        """(M,) bool, where fewer than ``HELD`` did what a verdict of a clear margin says."""
        margin = np.abs(np.nan_to_num(self.known.margin, nan=np.inf))
        return (self.tried > 0) & (margin > CLEAR) & (self.holding < HELD * self.tried)

    @property
    def sorts(self):
        """Whether the tooling still does what it is made for: every clear verdict holds."""
        return not self.odd.any()

    @property
    def remarks(self):
        """What a user must not overlook, a sentence each."""
        drive = self.bowl.drive
        if self.throw_number > 1.0:
            yield HOPS.format(self.throw_number, 1e3 * drive.amplitude / self.throw_number)
        for k in np.flatnonzero(self.odd):
            said = "passes" if self.predicted[k] else "is returned"
            margin = 1e3 * self.known.margin[k]
            yield ODD.format(self.known.lying[k].name, self.holding[k], self.tried[k], said, margin)
        if not self.velocity > 0.0:
            yield "the part does not travel up the track: see feeder convey"


@dataclass(frozen=True, eq=False)
class TrialStudy:
    """Parts of one kind on the tracks of one bowl at one or several amplitudes."""

    part: Part
    aspects: Aspects
    rule: str  # whose probabilities are taken
    seed: int
    runs: tuple[TrialRun, ...]  # one an amplitude; fewer after an interrupt

    @property
    def partial(self):
        """Whether the user stopped it before all parts were done."""
        return any(run.course.partial for run in self.runs)

    @property
    def highest(self):
        """The greatest amplitude tried [m] at which the tooling still sorts; NaN where it does at none."""
        return max((run.bowl.drive.amplitude for run in self.runs if run.sorts), default=np.nan)

    @property
    def warnings(self):
        """What a user must not overlook, a sentence each."""
        first = self.runs[0]
        told = [*strangers(first.bowl.devices, self.aspects.names), *self.aspects.warnings]
        several = len(self.runs) > 1
        for run in self.runs:
            lead = f"amplitude {1e3 * run.bowl.drive.amplitude:.4g} mm: " if several else ""
            told += [lead + one for one in run.remarks]
        return tuple(told)


def trial(
    part: Part,
    bowls: Sequence[Bowl],
    aspect: str | None = None,
    *,
    rule: str = "recommended",
    parts: int | None = None,
    queue: int | None = None,
    seconds: float = 10.0,
    seed: int = 1,
    jobs: int = 1,
    progress: Callable[[int, int], None] | None = None,
    before: Callable[[], None] | None = None,
) -> TrialStudy:
    """Send parts of true shape along the tooled track of a bowl, at one or several amplitudes.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : sequence of Bowl
        The same but for the drive.
    aspect : str, optional
        Only its orientations are tried; every orientation without it.
    rule : str
        Whose probabilities say in which shares orientations are offered.
    parts : int, optional
        One at a time, the orientations in turn; 200 without it, 60 with a queue.
    queue : int, optional
        So many parts in a row that push each other, as well.
    seconds : float [s]
        The queue is followed.
    seed : int
    jobs : int
        Cores to use; the outcome does not depend on it.
    progress : callable, optional
        Told how many are done of how many.
    before : callable, optional
        Called before anything is compiled.

    Returns
    -------
    TrialStudy

    Raises
    ------
    FeederError
        If the part has no shape, no such aspect or rule, or the bowl cannot convey.
    KeyboardInterrupt
        If nothing was finished.
    """
    found = find(part)
    if rule not in found.chances:
        raise ArgumentError(
            f"rule {rule}", "has no probabilities of this part", hint(rule, list(found.chances))
        )
    count = parts or (FEW if queue else PARTS)
    solid_of(part)  # refuses a part without a surface before anything else
    made = []
    for bowl in bowls:
        answer.answer(bowl)  # refuses a drive that cannot convey
        known = stream.orientations(part, found, bowl.track, bowl.devices)
        tried = _tried(part, found, known, aspect)
        own = {"parts": max(count, len(tried)), "seed": seed, "jobs": jobs, "before": before}
        told = _after(len(made), progress, len(bowls))
        seen = course.course(part, bowl, known.lying, tried, bowl.devices, **own, progress=told)
        shares = _shares(known, rule, tried)
        line = None
        if queue and not seen.partial:
            line = _queue(part, bowl, known.lying, shares, seen, queue, seconds, seed)
        made.append(TrialRun(bowl, throw_number(bowl), known, shares, seen, line))
        if seen.partial:
            break
    return TrialStudy(part, found, rule, seed, tuple(made))


def _after(before, progress, bowls):
    """``progress`` of one bowl of several, after those before it; each has as many stations."""
    return progress and (lambda done, total: progress(before * total + done, bowls * total))


def _tried(part, found, known, aspect):
    """Rows of the orientations that are laid down."""
    if aspect is None:
        return list(range(len(known.lying)))
    rows = [k for k, one in enumerate(known.lying) if one.aspect.casefold() == aspect.strip().casefold()]
    if not rows:
        names = ", ".join(found.names)
        raise FeederError(part.source, f"there is no aspect {aspect[:20]!r}", f"choose one of {names}")
    return rows


def _shares(known, rule, tried):
    """(M,) shares of the orientations tried; evenly where the rule gives none of them a chance."""
    chances = np.zeros(len(known.lying))
    chances[tried] = np.nan_to_num(known.rules[rule])[tried]
    if not chances.sum() > 0.0:
        chances[tried] = 1.0
    return chances / chances.sum()


def _queue(part, bowl, every, shares, seen, parts, seconds, seed):
    """A row of parts through the same devices."""
    solid, length, _ = solid_of(part)
    known = runs.setting(solid, length, bowl)
    apart = 1.3 * max(one.length for one in every)
    places = apart * (1.0 + np.arange(len(seen.stations) - 1))
    return row.row_of(known, part.mass, every, shares, seen, places, parts=parts, seconds=seconds, seed=seed)
