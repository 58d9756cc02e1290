"""The study of ``feeder trial``: parts of true shape on the vibrating, tooled track, one and many."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import Any

import numpy as np

from feederscrew.arrivals.entry import Shares, check_wanted, the_shares
from feederscrew.arrivals.entry import shares as arriving
from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column
from feederscrew.base.errors import ArgumentError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import RunSettings
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.device_list import shank_remarks, unknown_aspects
from feederscrew.bowl.devices.orientation_names import place, rows, split_name
from feederscrew.bowl.record import Bowl
from feederscrew.feeding import stream
from feederscrew.motion import conveying as answer
from feederscrew.part.record import Part, small_part_remarks
from feederscrew.resting import profiles
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import LAUNCH
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER
from feederscrew.sorting.tooling import listed
from feederscrew.trials import course, result
from feederscrew.trials.fills import FedRow, FillLevel
from feederscrew.trials.long_ride import long_ride
from feederscrew.trials.part_poses import MAX_START_PLAY_M
from feederscrew.trials.queue import queue_of
from feederscrew.trials.result import Outlet, TrialRun
from feederscrew.trials.shape import solid_of
from feederscrew.trials.supply import MEAN_GAP_SHARE, QueuePlan
from feederscrew.trials.wanted import states_of_name, wanted_rows

ENGINE = "feeder's own kernel"
QUEUE_SECONDS = 10.0  # [s] for which a queue is followed
PARTS = 200  # parts one at a time
FEW = 60  # ... where they only tell what a queue meets


@dataclass(frozen=True)
class TrialQueue:
    """The queue of a design at one fill, run again: parts as far apart, in the mix that a ride leaves."""

    fill: str  # 'low', 'normal' or 'high'
    parts: int | None = None  # so many at once; None for as many as the design has
    wanted: str = (
        ""  # what counts as good, as a bowl file has it: 'A@188', 'hanging'; '' for what leaves most
    )
    up: str | Sequence[str] = ()  # aspects that count as it, whatever their heading: 'A,B'


@dataclass(frozen=True, eq=False)
class TrialStudy(ReadableRecord, view="trial.tables.TRIAL_VIEW"):
    """Parts of one kind on the tracks of one bowl at one or several amplitudes."""

    part: Part
    aspects: Aspects
    rule: str  # whose probabilities are taken
    seed: int
    runs: tuple[TrialRun, ...]  # one an amplitude; fewer after an interrupt
    stopped: bool = False  # by the user, before the next of them was done
    measured: profiles.CountFile | None = None  # at the outlet of a bowl, to be set beside a queue's profile

    @property
    def answer(self) -> str:
        """Say whose shares parts arrive in: 'hops, launch feed', 'csa'."""
        recommended = self.aspects.recommended
        return recommended.rule if self.rule == RECOMMENDED_ANSWER and recommended is not None else self.rule

    @property
    def launch(self) -> str | None:
        """Return what is done to the parts: 'feed', 'drop'; None where a rule knows no launch."""
        recommended = self.aspects.recommended
        return recommended.launch if self.rule == RECOMMENDED_ANSWER and recommended is not None else None

    def outlet(self, run: TrialRun) -> Outlet | None:
        """Return what left one run's queue by aspect, an Outlet; None without a queue."""
        if run.queue is None:
            return None
        columns = () if self.measured is None else self.measured.profiles
        return result.outlet(run.queue, run.orientations.lying, run.shares, self.aspects.names, columns)

    @property
    def partial(self) -> bool:
        """Return whether the user stopped it before all parts were done."""
        return self.stopped or any(run.partial for run in self.runs)

    @property
    def highest(self) -> float:
        """The greatest amplitude tried [m] at which the tooling still sorts; NaN where it does at none."""
        return max((run.bowl.drive.amplitude for run in self.runs if run.sorts), default=np.nan)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what a user must not overlook, a sentence each."""
        first = self.runs[0]
        devices = first.bowl.devices
        listed = [*unknown_aspects(devices, self.aspects.names), *shank_remarks(devices)]
        listed += self.aspects.warnings
        play = {"play at the wall": MAX_START_PLAY_M}
        listed += small_part_remarks(self.part, play, first.bowl.track.width)
        listed += () if self.measured is None else self.measured.warnings(self.part)
        several = len(self.runs) > 1
        for run in self.runs:
            lead = f"amplitude {1e3 * run.bowl.drive.amplitude:.4g} mm: " if several else ""
            listed += [lead + remark for remark in run.remarks]
        if self.partial:
            parts = sum(len(run.course.entry_rows) for run in self.runs)
            listed.append(f"partial: stopped after {parts} parts")
        return tuple(listed)


TRIAL_COLUMNS: tuple[Column[TrialStudy], ...] = (  # of the whole trial
    Column("rule", lambda study: study.rule),
    Column("answer", lambda study: study.answer),
    Column("launch", lambda study: study.launch),
    Column("seed", lambda study: study.seed),
    Column("partial", lambda study: study.partial),
)


@former_keywords("bowls")
def trial(
    part: Part,
    bowls: Bowl | Sequence[Bowl],
    aspect: str | None = None,
    *,
    parts: int | None = None,
    landing: int | None = None,
    queue: int | TrialQueue | None = None,
    poured: bool = False,
    seconds: Quantity = QUEUE_SECONDS,
    frames: int = 0,
    rule: str = RECOMMENDED_ANSWER,
    aspect_shares: Shares | None = None,
    measured: profiles.CountFile | None = None,
    seed: int = 1,
    jobs: int = 1,
    progress: Callable[[int, int], None] | None = None,
    before: Callable[[], None] | None = None,
) -> TrialStudy:
    """Send parts along the vibrating, tooled track of one or several bowls, as ``feeder trial``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : Bowl or sequence of Bowl
        With their devices.
    aspect : str, optional
        Only its orientations.
    parts : int, optional
        One at a time; 200 without it, 60 beside a queue.
    landing : int, optional
        So many fall onto the moving track as well.
    queue : int or TrialQueue, optional
        So many at once, which push each other; or the queue of a design again.
    poured : bool, optional
        Whether these fall onto the track in any attitude; in a row without it.
    seconds : str or float [s], optional
        For which the queue is followed.
    frames : int, optional
        Poses of all parts of the queue that are noted for a film, evenly over the time.
    rule : str, optional
        Whose probabilities say in which shares orientations come.
    aspect_shares : Shares, optional
        Of ``shares``.
    measured : CountFile, optional
        What left a bowl, beside the profile of the queue: ``at_outlet`` reads it.
    seed : int, optional
        Of play and phase.
    jobs : int, optional
        Cores to use; nothing else depends on it.
    progress : callable, optional
        Called with how many parts are done, and of how many.
    before : callable, optional
        Called before anything is compiled.

    Returns
    -------
    TrialStudy
        With a run for each bowl.

    Raises
    ------
    FeederError
        If the part has no shape, no such aspect or rule, or the bowl cannot convey.
    KeyboardInterrupt
        If nothing was finished.
    """
    part, aspect = arguments.a_part(part), arguments.an_aspect(aspect)
    driven = arguments.some_bowls(bowls)
    aspect_shares = the_shares(aspect_shares)
    again = queue if isinstance(queue, TrialQueue) else None
    asked = queue.parts if isinstance(queue, TrialQueue) else queue
    counts = {"parts": parts, "landing": landing, "queue": asked}
    parts, landing, queued = (arguments.count(name, value) for name, value in counts.items())
    followed = arguments.amount("seconds", seconds, "time", 0.0)
    seed, jobs = arguments.whole("seed", seed, 0), arguments.whole("jobs", jobs)
    solid_of(part)  # refuses a part without a surface before anything else
    if aspect_shares is None:
        check_wanted(part, aspect)
        aspect_shares = arriving(part, driven[0], rule=rule)
    aspects = aspect_shares.aspects
    arguments.a_rule(rule, aspects)
    count = parts or (PARTS if queue is None else FEW)
    launch = LAUNCH if aspects.recommended is None else aspects.recommended.launch
    level = None if again is None else check.choice("queue.fill", again.fill, FillLevel)
    if level is not None and poured:
        raise ArgumentError("poured", "goes with no fill", "leave one of them out")
    crowd = (
        None if queued is None else QueuePlan(queued, followed, None if poured else MEAN_GAP_SHARE, frames)
    )
    run = RunSettings(seed, jobs, progress)
    runs: list[TrialRun] = []
    stopped = False
    for bowl in driven:
        answer.answer(bowl)  # refuses a drive that cannot convey
        oriented = stream.follow_orientations(part, aspects, bowl.track, bowl.devices, bowl=bowl)
        oriented = stream.oriented(oriented, aspect_shares.measured)
        lying = oriented.lying
        tried = list(range(len(lying)))  # rows of the orientations that are laid down
        if aspect is not None:
            name, heading = split_name(aspect)
            tried = rows(oriented.aspects, name, f"aspect of {part.source}", ArgumentError)
            if heading is not None:
                where = f"aspect of {part.source}"
                tried = [place(oriented.aspects, oriented.headings, name, heading, where, kind=ArgumentError)]
        shares = np.zeros(len(lying))  # evenly where the rule gives none of them a chance
        shares[tried] = np.nan_to_num(oriented.rules[rule])[tried]
        if not shares.sum() > 0.0:
            shares[tried] = 1.0
        shares = shares / shares.sum()
        before_it = len(runs)  # bowls, each of which has as many stations

        def progress_here(done: int, total: int, before_it: int = before_it) -> None:
            run.tell(before_it * total + done, len(driven) * total)

        here = replace(run, progress=progress_here, before=before)
        sent = course.SentParts(tried, max(count, len(tried)))
        try:
            single_parts = course.course(
                part,
                bowl,
                lying,
                sent,
                bowl.devices,
                poses=oriented.states,
                may_leave=course.leaves_by_rule(oriented.leaving),
                run=here,
            )
        except KeyboardInterrupt:
            if not runs:
                raise
            stopped = True
            break
        more: dict[str, Any] = {}
        if not single_parts.partial:  # parts that fall onto the track and a queue, as far as asked for
            own = part, bowl, aspects, lying, oriented.states
            try:
                if landing is not None:
                    more["landing"] = course.landing(*own, launch=launch, parts=landing, run=run)
                if any(result.partial for result in more.values()):
                    pass
                elif again is not None and level is not None:
                    plan = _FillPlan(level, queued, followed, frames, again.wanted, listed(again.up))
                    more |= _follow_fill(part, bowl, aspects, oriented, shares, single_parts, plan, run)
                elif crowd is not None:
                    more["queue"] = queue_of(*own, shares, crowd, run)
            except KeyboardInterrupt:
                stopped = True
        runs.append(TrialRun(bowl, throw_number(bowl), oriented, shares, single_parts, **more))
        if stopped or runs[-1].partial:
            break
    return TrialStudy(part, aspects, rule, seed, tuple(runs), stopped, measured)


@dataclass(frozen=True)
class _FillPlan:
    """Plan of a queue at a fill."""

    level: FillLevel
    parts: int | None
    seconds: float  # [s]
    frames: int
    wanted: str
    up: tuple[str, ...]


def _follow_fill(
    part: Part,
    bowl: Bowl,
    aspects: Aspects,
    oriented: stream.Orientations,
    shares: Floats,
    single_parts: course.Course,
    plan: _FillPlan,
    run: RunSettings,
) -> dict[str, Any]:
    """Follow the queue of a fill as ``feeder design`` does: what it did, and how much of it was wanted.

    Raises ArgumentError if no orientation of the wanted name can leave, KeyboardInterrupt if the user stops
    it before the first period is done.
    """
    name = plan.wanted
    if not name:  # the orientation in which most of the single parts have left
        alone = TrialRun(bowl, throw_number(bowl), oriented, shares, single_parts)
        by_rule = int(np.argmax((shares[:, None] * oriented.leaving).sum(axis=0)))
        row = by_rule if alone.main_row is None else alone.main_row
        name = oriented.states[row].name
    try:
        states, any_heading = states_of_name(oriented, shares, name, plan.up)
    except ValueError as error:
        mend = "name one of those in the table of feeder trial without a fill"
        raise ArgumentError("queue.wanted", str(error), mend) from error
    ride = long_ride(part, bowl, oriented.lying, shares, wanted_rows(oriented, states), run)
    row_of_parts = FedRow(part, bowl, aspects, oriented, ride.arriving, states, any_heading, ride.entering)
    queue = row_of_parts.queue(plan.level, plan.seconds, run.seed, parts=plan.parts, frames=plan.frames)
    try:
        queue.follow(plan.seconds, run.tell)
    except KeyboardInterrupt:
        if not queue.periods:
            raise
    outcome = queue.result(partial=queue.periods < queue.periods_in(plan.seconds))
    filled = row_of_parts.count(plan.level, outcome)
    return {"queue": outcome, "filled": filled, "filled_wanted": name}


def at_outlet(counts: str | PathLike[str], part: Part) -> profiles.CountFile:
    """Read what was measured of parts that left a bowl.

    Parameters
    ----------
    counts : str or path
        File of counts or shares, by aspect or orientation.
    part : Part
        Whose aspects it names.

    Returns
    -------
    CountFile

    Raises
    ------
    Faults
        Every fault of the file, each with its line.
    """
    return profiles.read_profile(counts, list(find(part).names))
