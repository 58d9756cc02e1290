"""What the loop knows while it runs."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.designing import proposals, trying
from feederscrew.designing.record import RATE_KEPT, Attempt, DesignRequest, RobustRun
from feederscrew.designing.robust import HALF
from feederscrew.part.record import Part
from feederscrew.rates.stream import Orientations
from feederscrew.running import RunSettings
from feederscrew.studies.rate import Shares
from feederscrew.trial import runs

Progress = Callable[[str, int, int, float, float], None]
USUAL_S = {"trial": 4.0, "draws": 1.0, "queue": 60.0}  # [s] a trial, a draw, all queues, before any was timed
USUAL_SLOWNESS_S = 10.0  # [s] of stages that count as having taken as long as usual
USUAL_TRIALS = 5  # of a design: the mean of those of docs/design.md is 5.4
TELL_EVERY_S = 0.5  # [s] between two calls of progress in a queue
RESERVE = 1.6  # of the target, for which a bowl is driven: queues bring less than rows, counts scatter


@dataclass(eq=False)
class Search:
    """What the loop knows while it runs."""

    part: Part
    request: DesignRequest
    plain: Bowl  # as given
    given: frozenset[str]
    told: Callable[[str], None]  # of a sentence
    known: Shares | None = None
    attempts: list = field(default_factory=list)
    passed: list = field(default_factory=list)  # (rate, Candidate) of clean attempts
    failed: list = field(default_factory=list)  # the same of others that deliver
    before: Callable[[], None] | None = None
    reserve: float = RESERVE
    least: float = 0.0  # [m/s] through tooling, where what is wanted was lost at a slower drive
    avoided: dict = field(default_factory=dict)  # kinds of devices at which a row was lost, by bank and row
    tracks: list = field(default_factory=list)  # of each bank what comes along it
    proposed: dict = field(default_factory=dict)  # proposals or None, by bank, row and way
    chains: set = field(default_factory=set)  # tracks and chains that were tried, whatever the drive
    lost_behind: list = field(default_factory=list)  # (bank and row, first devices) that lost all of it
    reach: float = np.inf  # trials, those made included, after which the next cost class has its turn
    most: float = np.inf  # short trials that are worth it
    first: int = 0  # trials that were made before this search began
    shares_given: bool = False  # the user says what arrives
    progress: Progress | None = None  # told what is done, how many of how many, seconds gone and to go
    further: int | None = None  # trials at most, where the nearest that holds is looked for
    clock: "Clock" = field(default_factory=lambda: Clock())

    @property
    def limit(self) -> int:
        """Short trials at most."""
        return int(self.further or min(self.request.budget, self.most))

    def begin_trial(self, text: str) -> None:
        """Tell which trial begins, of how many, what came of the last one, the time gone and to go."""
        if self.before and not self.attempts:  # what has to be compiled is told before the first trial
            self.before()
        number = len(self.attempts) + 1
        last = f"; trial {number - 1}: {outcome(self.attempts[-1])}" if self.attempts else ""
        self.clock.begin("trial", counts=runs.compiled())
        self.told(f"trial {number} of at most {max(self.limit, number)}: {text}{last}{self._times()}")
        self._progressed("trial", number - 1, max(self.limit, number))

    def end_trial(self) -> None:
        """Note how long a trial took."""
        self.clock.end()

    def begin_proof(self, text: str) -> None:
        """Tell that draws begin, what came of the last trial, the time gone and to go."""
        last = f"; trial {len(self.attempts)}: {outcome(self.attempts[-1])}" if self.attempts else ""
        self.clock.begin("draws")
        self.told(f"{text}{last}{self._times()}")

    def run(self, stage: str) -> RunSettings:
        """Return how draws or a queue run: as was asked, and progress is told.

        Parameters
        ----------
        stage : str
            'draws' or 'queue'.
        """

        def told(done: int, total: int) -> None:
            if self.clock.reach(stage, done, total):
                self._progressed(stage, done, total)

        return replace(self.request.run, progress=told)

    def _progressed(self, stage: str, done: int, total: int) -> None:
        if self.progress:
            gone, rest = self.clock.gone, self.clock.rest(len(self.attempts), self.limit, self.request.draws)
            self.progress(stage, done, total, gone, rest)

    def _times(self) -> str:
        if not self.clock.timed:
            return ""
        rest = self.clock.rest(len(self.attempts), self.limit, self.request.draws)
        return f"; {self.clock.gone:.0f} s gone, about {_about(rest):.0f} s to go"

    @property
    def spent(self) -> bool:
        """Whether the budget of trials is used up."""
        return len(self.attempts) >= min(self.request.budget, self.most, self.reach)

    def enough(self, attempt: Attempt) -> float:
        """Return the share [1] of what is wanted that has to leave in a draw, for the target to be kept."""
        need = RATE_KEPT * self.request.target / max(attempt.rate, 1e-300)
        return float(np.clip(need, HALF, 1.0))

    def avoid(self, place: tuple[float, int], proposal: proposals.Proposal, tried: trying.Tried) -> None:
        """Note the devices of a chain at which what is wanted is lost; rails are the only way to hang.

        Parameters
        ----------
        place : (float [rad], int)
            Bank of the track, and row of the orientation.
        proposal : Proposal
        tried : Tried
        """
        lost = {cut.device.kind for cut in proposal.cuts if not cut.device.hangs}
        kinds = sorted(kind for kind in lost if proposals.lost_at(tried, kind))
        known = self.avoided.get(place, ())
        self.avoided[place] = tuple(dict.fromkeys((*known, *kinds)))

    def note_lost(self, place: tuple[float, int], proposal: proposals.Proposal, tried: trying.Tried) -> None:
        """Note the first devices of a chain, where nothing wanted comes past the last of them.

        Another chain that begins with them does no better on that track: parameters as for ``avoid``.
        """
        ends = {end for n, k in enumerate(tried.rows) if k == proposal.row for end in tried.places[n]}
        if tried.efficiency > 0.0 or len(ends) != 1:
            return
        (end,) = ends
        names = [f" at {device.name}" for device in proposal.devices]
        heads = [k for k, name in enumerate(names) if end.endswith(name)]
        if len(heads) == 1:
            self.lost_behind.append((place, proposal.chain[: heads[0] + 1]))

    @property
    def best_rate(self) -> float:
        """The most that a clean attempt would deliver [1/s]."""
        return max((one.attempt.rate for one in self.passed), default=0.0)


@dataclass(frozen=True, eq=False)
class Candidate:
    """A chain on its bowl, as it was tried."""

    proposal: proposals.Proposal
    bowl: Bowl
    ways: Orientations
    weights: np.ndarray  # (M,)
    tried: trying.Tried
    attempt: Attempt
    drawn: RobustRun | None = None  # some draws that it did not all hold


def outcome(attempt: Attempt) -> str:
    """Return what came of a short trial, in few words."""
    if attempt.faults:
        return ", ".join(attempt.faults[:2])
    return f"clean, {60.0 * attempt.rate:.3g}/min" if attempt.clean else "nothing leaves"


def _about(seconds: float) -> float:
    """Seconds as a guess says them: on steps of 10 s above 20 s."""
    return max(round(seconds / 10.0) * 10.0, 10.0) if seconds > 20.0 else max(seconds, 1.0)


class Clock:
    """How long the stages of a design take, and a guess of what is still to come."""

    def __init__(self) -> None:
        self.begun = self.last = self.since = time.monotonic()
        self.stage, self.done, self.total, self.counts = "", 0, 0, True
        self.spent: dict[str, tuple[float, float]] = {}  # of each stage seconds, and how many they were

    @property
    def gone(self) -> float:
        """Seconds since it began."""
        return time.monotonic() - self.begun

    @property
    def timed(self) -> bool:
        """Whether anything was timed."""
        return bool(self.spent)

    def begin(self, stage: str, *, counts: bool = True) -> None:
        """Begin a stage, 'trial', 'draws' or 'queue'; one that waits for the compiler does not count."""
        self.end()
        self.counts = counts
        self.stage, self.done, self.total, self.since = stage, 0, 1, time.monotonic()

    def end(self) -> None:
        """End the stage that runs, and note how long it took."""
        if self.stage and self.counts:
            count = 1.0 if self.stage == "trial" else self._units(self.stage, self.done, self.total)
            if count > 0.0:
                seconds, number = self.spent.get(self.stage, (0.0, 0.0))
                self.spent[self.stage] = seconds + time.monotonic() - self.since, number + count
        self.stage = ""

    def reach(self, stage: str, done: int, total: int) -> bool:
        """So many of a stage are done; returns whether it is time to tell so."""
        if stage != self.stage or done < self.done:
            self.begin(stage)
        self.done, self.total = done, total
        if done < total and time.monotonic() - self.last < TELL_EVERY_S:
            return False
        self.last = time.monotonic()
        return True

    @staticmethod
    def _units(stage: str, done: int, total: int) -> float:
        """Draws that are done, or how much of the queues at all fills."""
        return float(done) if stage == "draws" else done / max(total, 1)

    def each(self, stage: str) -> float:
        """Return how long [s] one of a stage takes: as it did, or as usual on so fast a machine."""
        if stage in self.spent:
            seconds, number = self.spent[stage]
            return seconds / number
        seconds = sum(one for one, _ in self.spent.values())
        usual = sum(number * USUAL_S[name] for name, (_, number) in self.spent.items())
        slower = (seconds + USUAL_SLOWNESS_S) / (
            usual + USUAL_SLOWNESS_S
        )  # one quick trial is no fast machine
        return USUAL_S[stage] * slower

    def rest(self, trials: int, limit: int, draws: int) -> float:
        """Return a guess of the seconds to go: as if a usual number of trials led to one proof."""
        running = self._units(self.stage, self.done, self.total) if self.stage else 0.0
        proof = draws * self.each("draws") + self.each("queue")
        if self.stage == "draws":
            return max(draws - running, 0.0) * self.each("draws") + self.each("queue")
        if self.stage == "queue":
            return max(1.0 - running, 0.1) * self.each("queue")
        left = min(max(USUAL_TRIALS - trials, 1), max(limit - trials, 1))
        return left * self.each("trial") + proof
