"""Progress of a search: sentences and counts for the user, and a guess of the time to go."""

import enum
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from feederscrew.designing import texts
from feederscrew.designing.record import Attempt
from feederscrew.running import RunSettings
from feederscrew.trial import runs

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


# [s] a trial, a draw, all queues, all runs of a long proof, before any was timed
USUAL_S = {
    SearchStage.TRIAL: 4.0,
    SearchStage.DRAWS: 1.0,
    SearchStage.QUEUE: 60.0,
    SearchStage.LONG_PROOF: 7200.0,
}


def _silent(text: str) -> None:
    """Tell nobody."""


@dataclass(frozen=True)
class TrialBudget:
    """Trials that a search has made, and may make."""

    attempts: list[Attempt]  # short trials that were made
    limit: int  # short trials at most
    draws: int  # of a proof


class Clock:
    """Time that the stages of a design take, and a guess of the time still to come."""

    def __init__(self) -> None:
        self.begun = self.last = self.since = time.monotonic()
        self.stage: SearchStage | None = None
        self.done, self.total, self.counts = 0, 0, True
        self.found = 0  # done before the stage began: runs that were kept
        self.durations: dict[
            SearchStage, tuple[float, float]
        ] = {}  # of each stage seconds, and how many they were

    @property
    def seconds(self) -> float:
        """Seconds since it began."""
        return time.monotonic() - self.begun

    @property
    def _count_done(self) -> float:
        """Draws that are done, or how much of the queues at all fills."""
        return float(self.done) if self.stage is SearchStage.DRAWS else self.done / max(self.total, 1)

    def begin(self, stage: SearchStage, *, counts: bool = True) -> None:
        """Begin a stage; one that waits for the compiler does not count."""
        self.end()
        self.stage, self.done, self.total, self.counts = stage, 0, 1, counts
        self.since = time.monotonic()

    def end(self) -> None:
        """End the stage that runs, and note how long it took."""
        count = 1.0 if self.stage is SearchStage.TRIAL else self._count_done
        if self.stage is not None and self.counts and count > 0.0:
            seconds, number = self.durations.get(self.stage, (0.0, 0.0))
            self.durations[self.stage] = seconds + time.monotonic() - self.since, number + count
        self.stage = None

    def reach(self, stage: SearchStage, done: int, total: int) -> bool:
        """Note how many of a stage are done; return whether it is time to tell so."""
        if stage is not self.stage or done < self.done:
            self.begin(stage)
            self.found = done
        self.done, self.total = done, total
        if done < total and time.monotonic() - self.last < TELL_EVERY_S:
            return False
        self.last = time.monotonic()
        return True

    def each(self, stage: SearchStage) -> float:
        """Return how long [s] one of a stage takes: as it did, or as usual on so fast a machine."""
        if stage in self.durations:
            seconds, number = self.durations[stage]
            return seconds / number
        # one quick trial is no fast machine
        seconds = USUAL_SLOWNESS_S + sum(duration for duration, _ in self.durations.values())
        usual = USUAL_SLOWNESS_S + sum(number * USUAL_S[name] for name, (_, number) in self.durations.items())
        return USUAL_S[stage] * seconds / usual

    def rest(self, trials: int, limit: int, draws: int) -> float:
        """Return a guess of the seconds to go: as if a usual number of trials led to one proof.

        Parameters
        ----------
        trials, limit : int
            Short trials that were made, and those allowed.
        draws : int
            Draws of a proof.

        Returns
        -------
        float [s]
        """
        if self.stage is SearchStage.DRAWS:
            return max(draws - self._count_done, 0.0) * self.each(SearchStage.DRAWS) + self.each(
                SearchStage.QUEUE
            )
        if self.stage is SearchStage.LONG_PROOF:
            made = self.done - self.found
            gone = time.monotonic() - self.since
            return (self.total - self.done) * gone / made if made else USUAL_S[SearchStage.LONG_PROOF]
        if self.stage is SearchStage.QUEUE:
            return max(1.0 - self._count_done, 0.1) * self.each(SearchStage.QUEUE)
        left = min(max(USUAL_TRIALS - trials, 1), max(limit - trials, 1))
        return (
            left * self.each(SearchStage.TRIAL)
            + draws * self.each(SearchStage.DRAWS)
            + self.each(SearchStage.QUEUE)
        )


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
        most = max(budget.limit, number)
        self.tell(f"trial {number} of at most {most}: {text}{self._so_far(budget)}")
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
        """

        def reach(done: int, total: int) -> None:
            if self.clock.reach(stage, done, total):
                self._report(stage, done, total, budget)

        return replace(run, progress=reach)

    def _rest(self, budget: TrialBudget) -> float:
        return self.clock.rest(len(budget.attempts), budget.limit, budget.draws)

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
        return f"{text}; {self.clock.seconds:.0f} s gone, about {rest:.0f} s to go"
