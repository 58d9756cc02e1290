"""A search of a design: what it is asked, what it knows so far, how far it is, by which policy it goes on."""

import functools
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field, replace

import numpy as np

from feederscrew.arrivals.entry import Shares
from feederscrew.base.arrays import Floats
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.base import ComparedValue
from feederscrew.bowl.record import Bowl, Track
from feederscrew.bowl.verified import RATE_KEPT
from feederscrew.designing import calm_drive, proposals, short_trials
from feederscrew.designing.findings import Fault
from feederscrew.designing.policy import USUAL_POLICY, SearchPolicy
from feederscrew.designing.progress import SearchProgress, SearchStage, TrialBudget
from feederscrew.designing.proof import RobustRun
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import Attempt, DesignRequest
from feederscrew.designing.short_trials import LEAST_SHARE_LEAVING
from feederscrew.feeding import stream
from feederscrew.feeding.stream import Orientations
from feederscrew.part.record import Part
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER
from feederscrew.trials.fills import FillLevel
from feederscrew.trials.queue import PartsQueue
from feederscrew.trials.wanted import leaves_hanging

Place = tuple[float, int]  # bank [rad] of a track, and row of an orientation on it
RowKey = tuple[tuple[str, str], ...]  # all that decides a row of parts
KEPT_ROWS = 4  # of which queues are kept in memory
ChainKey = tuple[Track, str, tuple[tuple[str, tuple[ComparedValue, ...]], ...]]


@dataclass(frozen=True, eq=False)
class TrackAtBank:
    """A bank of the track: the bowl without devices, and what comes along it."""

    plain_bowl: calm_drive.PlainBowl
    orientations: Orientations
    weights: Floats  # (M,)
    rows: list[int]  # those worth a try
    rank: float  # [1] how likely the bank is to do

    @functools.cached_property
    def fastest(self) -> float:
        """Velocity [m/s] at the fastest drive."""
        return calm_drive.speed(calm_drive.drive_at(self.plain_bowl, np.inf, hops=True))


@dataclass(eq=False)
class SearchState:
    """State of a search: its findings so far; each of its steps reads and changes it."""

    reserve: float  # [1] of the target, for which a bowl is driven
    shares: Shares | None = None  # what arrives; None before the tracks are known
    attempts: list[Attempt] = field(default_factory=list)  # short trials, those of searches beside it too
    clean: list["Candidate"] = field(default_factory=list)  # of clean attempts
    failures: list["Candidate"] = field(default_factory=list)  # of others that deliver
    min_speed: float = 0.0  # [m/s] through tooling, where what is wanted was lost at a slower drive
    tracks: list[TrackAtBank] = field(default_factory=list)  # of each bank what comes along it
    # what was proposed, by bank, row and way
    proposed: dict[tuple[float, int, proposals.Recipe], Proposal | None] = field(default_factory=dict)
    chains: set[ChainKey] = field(default_factory=set)  # tried on their tracks, whatever the drive
    # kinds of devices at which a row was lost, by bank and row
    avoided_kinds: dict[Place, tuple[str, ...]] = field(default_factory=dict)
    # bank and row, and the first devices that lost all of it
    lost_behind: list[tuple[Place, tuple[str, ...]]] = field(default_factory=list)
    start: int = 0  # trials that were made before this search began
    reach: float = np.inf  # trials, those made included, after which the next cost class has its turn
    most_trials: float = np.inf  # short trials that are worth it
    beyond: int = 0  # trials of air for what stood at steel, which come on top of those that are allowed
    cost_class: int = 1  # that is searched
    tried: Counter[str] = field(default_factory=Counter)  # short trials of this search, by orientation
    looked_at: set[str] = field(default_factory=set)  # orientations that had their turn before the others
    waiting: list["Candidate"] = field(default_factory=list)  # clean, of a dearer class than is searched
    # chains with rails, and the rows that came to stand at them, in a trial or a queue
    stood: list[tuple["Candidate", tuple[int, ...]]] = field(default_factory=list)
    # chains with a swept blade, and the rows that came to stand at them
    stood_at_blade: list[tuple["Candidate", tuple[int, ...]]] = field(default_factory=list)
    proposals_left: float = np.inf  # chains that may still be looked for
    denied: float = 0.0  # [s] bowl time of the queues of designs that did not hold
    nearest_limit: int | None = None  # trials at most, where the nearest that holds is looked for
    # queues of the designs that were proved last, those of searches beside it too, by all that decides them
    queues: dict[RowKey, dict[FillLevel, PartsQueue]] = field(default_factory=dict)

    def queues_of(self, key: RowKey) -> dict[FillLevel, PartsQueue]:
        """Return the queues of a row that were followed, by their fills; those of other rows are forgotten.

        Parameters
        ----------
        key : tuple
            All that decides the row.

        Returns
        -------
        dict
            That it shall be filled in. ``KEPT_ROWS`` are kept, those asked for last.
        """
        running = self.queues[key] = self.queues.pop(key, {})
        while len(self.queues) > KEPT_ROWS:
            del self.queues[next(iter(self.queues))]
        return running

    @property
    def best_rate(self) -> float:
        """The most that a clean attempt would deliver [1/s]."""
        return max((candidate.attempt.rate for candidate in self.clean), default=0.0)


@dataclass(frozen=True, eq=False)
class Search:
    """A search for a bowl: what it is asked, and by which policy it goes on."""

    part: Part
    request: DesignRequest
    plain: Bowl  # as given
    kept_keys: frozenset[str]  # names of the keys that the user gave
    given_shares: Shares | None  # what arrives, where the user says so
    progress: SearchProgress
    policy: SearchPolicy
    state: SearchState

    @classmethod
    def begin(
        cls,
        part: Part,
        request: DesignRequest,
        plain: Bowl,
        kept_keys: Collection[str] = (),
        *,
        shares: Shares | None = None,
        progress: SearchProgress | None = None,
        policy: SearchPolicy = USUAL_POLICY,
    ) -> "Search":
        """Return a search that has found nothing so far.

        Parameters
        ----------
        part : Part
        request : DesignRequest
        plain : Bowl
            As given, completed by the defaults.
        kept_keys : collection of str
            Names of the keys of the bowl file that the user gave.
        shares : Shares, optional
            What arrives, where the user says so.
        progress : SearchProgress, optional
            Whom it tells how far it is; nobody without one.
        policy : SearchPolicy

        Returns
        -------
        Search
        """
        state = SearchState(policy.rate_reserve, shares)
        said = progress or SearchProgress()
        return cls(part, request, plain, frozenset(kept_keys), shares, said, policy, state)

    def beside(self, request: DesignRequest) -> "Search":
        """Return a search for another request that tells and counts as this one does, and begins anew.

        Its trials are added to those of this one, and queues that were followed are shared; chains that this
        one tried may be tried again.

        Parameters
        ----------
        request : DesignRequest

        Returns
        -------
        Search
        """
        state = self.state
        new = SearchState(
            state.reserve, state.shares, state.attempts, min_speed=state.min_speed, start=len(state.attempts),
            queues=state.queues,
        )  # fmt: skip
        return replace(self, request=request, state=new)

    def keeps(self, key: str) -> bool:
        """Tell whether the user gave a key of the bowl file.

        Parameters
        ----------
        key : str
            Its name, 'drive.amplitude'.

        Returns
        -------
        bool
        """
        return key in self.kept_keys

    @property
    def limit(self) -> int:
        """Short trials at most."""
        most = min(self.request.budget, self.state.most_trials) + self.state.beyond
        return int(self.state.nearest_limit or most)

    @property
    def is_spent(self) -> bool:
        """Tell whether the budget of trials is used up."""
        state = self.state
        most = min(self.request.budget, state.most_trials) + state.beyond
        return len(state.attempts) >= min(most, state.reach)

    def leave_no_other_out(self) -> None:
        """Allow one more trial, for air where parts stood at steel: no other chain is left out for it."""
        self.state.beyond += 1
        self.state.reach += 1

    @property
    def arrivals(self) -> Shares:
        """Return the mix of aspects that arrives."""
        if self.state.shares is None:
            raise ValueError("what arrives is not known before the tracks are")
        return self.state.shares

    @property
    def aspect_shares(self) -> tuple[tuple[str, float], ...]:
        """The aspects that come along its first track, and their shares [1]: the most frequent first."""
        shares: Counter[str] = Counter()
        for track in self.state.tracks[:1]:
            for orientation, weight in zip(track.orientations.lying, track.weights.tolist(), strict=True):
                shares[orientation.aspect] += weight
        return tuple(shares.most_common())

    def through(self, bowl: Bowl) -> Orientations:
        """Return what becomes of each orientation on the track and through the devices of a bowl.

        Parameters
        ----------
        bowl : Bowl

        Returns
        -------
        Orientations

        Raises
        ------
        ValueError
            If what arrives is not known yet.
        """
        return proposals.follow_orientations(self.part, self.arrivals.aspects, bowl)

    def orientations_along(self, bowl: Bowl, shares: Shares | None = None) -> Orientations:
        """Return the same with what was counted of what arrives, where it was.

        Parameters
        ----------
        bowl : Bowl
        shares : Shares, optional
            What arrives; by default as the search knows it.

        Returns
        -------
        Orientations
        """
        own = self.arrivals if shares is None else shares
        ways = proposals.follow_orientations(self.part, own.aspects, bowl)
        return stream.oriented(ways, own.measured)

    def highest_shares(self, orientations: Orientations) -> Floats:
        """Return the upper ends (M,) [1] of the shares in which orientations come.

        Parameters
        ----------
        orientations : Orientations
            M of them, with the shares as they are known.

        Returns
        -------
        (M,) array [1]
            Of the 95 % interval by the recommended rule; the shares themselves by another rule, or without
            an interval.
        """
        shares = np.nan_to_num(orientations.rules[self.request.rule])
        if self.request.rule == RECOMMENDED_ANSWER:
            shares = np.fmax(shares, orientations.interval[:, 1])
        return shares

    @property
    def budget(self) -> TrialBudget:
        """Return the trials that it has made and may make."""
        return TrialBudget(self.state.attempts, self.limit, self.request.draws)

    def tell(self, text: str) -> None:
        """Tell the user a sentence.

        Parameters
        ----------
        text : str
        """
        self.progress.tell(text)

    def begin_trial(self, text: str) -> None:
        """Tell which trial begins.

        Parameters
        ----------
        text : str
            What is tried.
        """
        self.progress.begin_trial(text, self.budget)

    def begin_proof(self, text: str) -> None:
        """Tell that draws begin.

        Parameters
        ----------
        text : str
            What is proved.
        """
        self.progress.begin_proof(text, self.budget)

    def run(self, stage: SearchStage) -> RunSettings:
        """Return how draws or queues run: as was asked, and progress is told.

        Parameters
        ----------
        stage : SearchStage

        Returns
        -------
        RunSettings
        """
        return self.progress.watch(self.request.run, stage, self.budget)

    def share_needed(self, attempt: Attempt) -> float:
        """Return the share of what is wanted that has to leave in a draw, for the target to be kept.

        Parameters
        ----------
        attempt : Attempt
            Short trial that says what the chain would deliver.

        Returns
        -------
        float [1]
            ``RATE_KEPT`` times the target over the rate of the attempt, between ``LEAST_SHARE_LEAVING`` and
            1.
        """
        need = RATE_KEPT * self.request.target / max(attempt.rate, 1e-300)
        return float(np.clip(need, LEAST_SHARE_LEAVING, 1.0))


@dataclass(frozen=True, eq=False)
class Candidate:
    """A chain on its bowl, as it was tried."""

    proposal: Proposal
    bowl: Bowl
    orientations: Orientations
    weights: Floats  # (M,)
    trial: short_trials.ShortTrial
    attempt: Attempt
    robust: RobustRun | None = None  # some draws that it did not all hold

    def plain_bowl(self, search: Search) -> calm_drive.PlainBowl:
        """Return its bowl without devices, with the keys that the user gave.

        Parameters
        ----------
        search : Search

        Returns
        -------
        PlainBowl
        """
        bare = replace(self.bowl, devices=())
        return calm_drive.PlainBowl(bare, search.kept_keys, search.request.drive)

    @property
    def shown(self) -> tuple[int, ...] | None:
        """The rows that its trial has shown to leave, where parts leave hanging; else None."""
        hanging = leaves_hanging(self.orientations, self.trial.states)
        return tuple(self.trial.wanted) if hanging else None

    @property
    def worst(self) -> Fault | None:
        """The fault that some draws show most often; None where it was not drawn, or all of them held."""
        return None if self.robust is None else self.robust.main_fault

    def is_nearly_robust(self, policy: SearchPolicy) -> bool:
        """Tell whether all draws of its screening but one held.

        Parameters
        ----------
        policy : SearchPolicy
            That says how many draws a screening has.

        Returns
        -------
        bool
        """
        robust = self.robust
        return robust is not None and robust.held == robust.draws - 1 >= policy.screening_draws - 1
