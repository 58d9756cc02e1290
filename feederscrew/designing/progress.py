"""Progress of a search: sentences and counts for the user, and a guess of the time to go."""

import enum
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from feederscrew.base.running import RunSettings
from feederscrew.designing import texts
from feederscrew.designing.record import Attempt
from feederscrew.trials import runs

Progress = Callable[[str, int, int, float, float], None]
USUAL_SLOWNESS_S = 10.0  # [s] of stages that count as having taken as long as usual
USUAL_TRIALS = 5  # of a design: the mean of those of docs/design.md is 5.4
TELL_EVERY_S = 0.5  # [s] between two calls of progress in a queue


class SearchStage(enum.StrEnum):
    """Stage of a search; programs that show its progress are told the word."""

    TRIAL = "trial"
    DRAWS = "draws"
    QUEUE = "queue"
    LONG_PROOF = "long proof"


# [s] a trial, all draws of a design, all its queues, all runs of a long proof, before any was timed
USUAL_S = {
    SearchStage.TRIAL: 2.0,
    SearchStage.DRAWS: 5.0,
    SearchStage.QUEUE: 50.0,
    SearchStage.LONG_PROOF: 7200.0,
}
# [1] of a stage that is done, from which its own pace is what counts: the fill that is followed first is the
# slowest by far, so that queues show theirs late
OWN_PACE_SHARE = {SearchStage.DRAWS: 0.1, SearchStage.QUEUE: 0.1, SearchStage.LONG_PROOF: 0.0}
# part-seconds of all queues of a design that holds, as ``queues.cost`` counts them: 662 to 6,276 of eleven of
# docs/designs.csv, 1,730 in the median. What denied queues say of a whole one counts from OWN_PACE_SHARE of
# it on: two wrong parts among the first four ask for hours
USUAL_QUEUE_WORK = 1700
# [s] of a machine of usual speed, from the last queue to the last file: the median of ten designs, 2.8 to 19
WRITING_S = 10.0
LONGER_SHARE = 0.25  # [1] of the time gone, that a stage which takes longer than usual goes on


def _silent(text: str) -> None:
    """Tell nobody."""


@dataclass(frozen=True)
class TrialBudget:
    """Trials that a search has made, and may make."""

    attempts: list[Attempt]  # short trials that were made
    limit: int  # short trials at most
    draws: int  # of a proof


class Clock:
    """How long the stages of a design take, and a guess of what is still to come."""

    def __init__(self) -> None:
        self.begun = self.last = self.since = time.monotonic()
        self.stage: SearchStage | None = None
        self.done, self.total, self.counts = 0, 0, True
        self.found = 0  # done before the stage began: runs that were kept
        self.durations: dict[SearchStage, tuple[float, int]] = {}  # of each stage seconds, and how many
        self.queued, self.queue_total = 0, 0  # part-seconds of all queues; of a whole one as it looks by now

    @property
    def seconds(self) -> float:
        """Seconds since it began."""
        return time.monotonic() - self.begun

    def begin(self, stage: SearchStage, *, counts: bool = True) -> None:
        """Begin a stage.

        Parameters
        ----------
        stage : SearchStage
        counts : bool
            Whether its time is the one of such stages; one that waits for the compiler does not count.
        """
        self.end()
        self.stage, self.done, self.total, self.counts = stage, 0, 1, counts
        self.found, self.since = 0, time.monotonic()

    def end(self) -> None:
        """End the stage that runs, and note how long it took, however far it came."""
        if self.stage is not None and self.counts and (self.stage is SearchStage.TRIAL or self.done > 0):
            seconds, number = self.durations.get(self.stage, (0.0, 0))
            self.durations[self.stage] = seconds + time.monotonic() - self.since, number + 1
            if self.stage is SearchStage.QUEUE:
                self.queued, self.queue_total = self.queued + self.done - self.found, self.total
        self.stage = None

    def reach(self, stage: SearchStage, done: int, total: int) -> bool:
        """Note how many of a stage are done; return whether it is time to tell so.

        Parameters
        ----------
        stage : SearchStage
        done, total : int
            Draws, periods of queues, or runs.

        Returns
        -------
        bool
        """
        if stage is not self.stage or done < self.done:
            self.begin(stage)
            self.found = done
        self.done, self.total = done, total
        if done < total and time.monotonic() - self.last < TELL_EVERY_S:
            return False
        self.last = time.monotonic()
        return True

    def each(self, stage: SearchStage) -> float:
        """Return how long [s] one of a stage takes: as it did, or as usual on so fast a machine.

        Queues that were denied ended early: the next one counts to its end, at their pace; to that of a usual
        one, where they ended too early to tell.

        Parameters
        ----------
        stage : SearchStage

        Returns
        -------
        float [s]
        """
        if stage in self.durations:
            seconds, number = self.durations[stage]
            if stage is not SearchStage.QUEUE or not self.queued:
                return seconds / number
            is_known = self.queued >= OWN_PACE_SHARE[stage] * self.queue_total
            return seconds * (self.queue_total if is_known else USUAL_QUEUE_WORK) / self.queued
        return USUAL_S[stage] * self.slowness

    @property
    def slowness(self) -> float:
        """How many times [1] as long as usual the stages took that are done."""
        # one quick trial is no fast machine
        seconds = USUAL_SLOWNESS_S + sum(duration for duration, _ in self.durations.values())
        usual = USUAL_SLOWNESS_S + sum(number * USUAL_S[name] for name, (_, number) in self.durations.items())
        return seconds / usual

    def rest_of_stage(self, stage: SearchStage) -> float:
        """Return a guess of the seconds to go of a stage that runs: at its own pace as soon as it has one.

        Parameters
        ----------
        stage : SearchStage

        Returns
        -------
        float [s]
            What is left of it at its own pace; until ``OWN_PACE_SHARE`` of it is done, what such a stage
            takes less the time gone, or ``LONGER_SHARE`` of that.
        """
        gone, made, left = time.monotonic() - self.since, self.done - self.found, self.total - self.done
        if made > 0 and made >= OWN_PACE_SHARE[stage] * self.total:
            return left * gone / made
        return max(self.each(stage) - gone, LONGER_SHARE * gone)

    def rest(self, trials: int, limit: int) -> float:
        """Return a guess of the seconds to go if the design that is proved, or that is proved next, holds.

        Whether it does is not known beforehand. Where it does not, trials and a proof follow that may take as
        long again. So the guess is of this case, and texts say so: 'if it holds'.

        Parameters
        ----------
        trials, limit : int
            Short trials that were made, and those allowed.

        Returns
        -------
        float [s]
        """
        if self.stage is SearchStage.LONG_PROOF:
            return self.rest_of_stage(SearchStage.LONG_PROOF)
        rest = WRITING_S * self.slowness
        if self.stage is SearchStage.QUEUE:
            return rest + self.rest_of_stage(SearchStage.QUEUE)
        rest += self.each(SearchStage.QUEUE)
        if self.stage is SearchStage.DRAWS:
            return rest + self.rest_of_stage(SearchStage.DRAWS)
        left = min(max(USUAL_TRIALS - trials, 1), max(limit - trials, 1))
        return rest + self.each(SearchStage.DRAWS) + left * self.each(SearchStage.TRIAL)


@dataclass(eq=False)
class SearchProgress:
    """Whom a search tells how far it is."""

    tell: Callable[[str], None] = _silent  # of a sentence
    before: Callable[[], None] | None = None  # called before the first trial, which may have to be compiled
    report: Progress | None = None  # told what is done, how many of how many, seconds gone and to go
    clock: Clock = field(default_factory=Clock)

    def begin_trial(self, text: str, budget: TrialBudget) -> None:
        """Tell which trial begins, of how many, what came of the last one, the time gone and to go."""
        if self.before and not budget.attempts:
            self.before()
        number = len(budget.attempts) + 1
        self.clock.begin(SearchStage.TRIAL, counts=runs.is_compiled())
        most = max(budget.limit, number)  # of the search that runs: others may follow, so it is no bound
        self.tell(f"trial {number}: {text}{self._so_far(budget)}")
        self._report(SearchStage.TRIAL, number - 1, most, budget)

    def begin_proof(self, text: str, budget: TrialBudget) -> None:
        """Tell that draws begin, what came of the last trial, the time gone and to go."""
        self.clock.begin(SearchStage.DRAWS)
        self.tell(f"{text}{self._so_far(budget)}")

    def watch(self, run: RunSettings, stage: SearchStage, budget: TrialBudget) -> RunSettings:
        """Return how a stage runs, with its progress reported.

        Parameters
        ----------
        run : RunSettings
            As was asked.
        stage : SearchStage
        budget : TrialBudget
            Of the search at its begin.

        Returns
        -------
        RunSettings
            A total that grows, as a queue takes longer than it looked, is told as soon as the share that is
            done has come back to what was told before: what is done is not undone.
        """
        told, before = 0.0, 0  # share, and count, that were told

        def reach(done: int, total: int) -> None:
            nonlocal told, before
            if self.clock.reach(stage, done, total):
                told = max(told if done >= before else 0.0, done / max(total, 1))
                before = done
                self._report(stage, done, min(total, round(done / told)) if told > 0.0 else total, budget)

        return replace(run, progress=reach)

    def _rest(self, budget: TrialBudget) -> float:
        return self.clock.rest(len(budget.attempts), budget.limit)

    def _report(self, stage: SearchStage, done: int, total: int, budget: TrialBudget) -> None:
        if self.report:
            self.report(stage, done, total, self.clock.seconds, self._rest(budget))

    def _so_far(self, budget: TrialBudget) -> str:
        text = ""
        if budget.attempts:
            last = budget.attempts[-1]
            clean = f"clean, {60.0 * last.rate:.3g}/min" if last.clean else "nothing leaves"
            faults = ", ".join(texts.fault_texts(last.faults, 2))
            text = f"; trial {len(budget.attempts)}: {faults or clean}"
        if not self.clock.durations:
            return text
        rest = self._rest(budget)  # on steps of 10 s above 20 s
        rest = max(round(rest / 10.0) * 10.0, 10.0) if rest > 20.0 else max(rest, 1.0)
        return f"{text}; {self.clock.seconds:.0f} s gone, about {rest:.0f} s to go if it holds"
