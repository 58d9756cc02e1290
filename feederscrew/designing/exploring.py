"""Short trials of chains: an orientation at its own drive, what the trial denies changed, and again."""

import functools
import heapq
import itertools
import math
import re
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from feederscrew.arrays import Floats
from feederscrew.bowl.devices import check_written
from feederscrew.bowl.record import Bowl, Track
from feederscrew.designing import calm_drive, proposals, short_trials, texts
from feederscrew.designing.findings import Cause, End, Fault, FaultKind, Move, MoveKind
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import RATE_KEPT, Attempt, DesignRequest, RobustRun
from feederscrew.designing.short_trials import LEAST_SHARE_LEAVING, find_denials, robust_run
from feederscrew.dropping.plate_test import throw_number
from feederscrew.part.record import Part
from feederscrew.rates import stream
from feederscrew.rates.stream import Orientations
from feederscrew.rates.tipping import FLAT_KIND
from feederscrew.running import RunSettings
from feederscrew.studies import solidbowl
from feederscrew.studies.aspects import find_aspects
from feederscrew.studies.rate import Shares, shares
from feederscrew.tooling.devices.kinds import cost_class as cost_class_of
from feederscrew.tooling.isolating.chain import OutcomeKind
from feederscrew.tooling.orientations import Hanging, Orientation, neck
from feederscrew.trial import runs

SHORT_TRIAL_PARTS = 2  # parts of each orientation in a short trial
MENDED = 3  # times that one proposal is mended
LOST_TRIALS = 2  # trials of it in which nothing leaves as wanted, and it is given up
LIVELIER_TRIALS = 2  # livelier drives that one chain is tried at, where parts stay at a blade
CALMER_TRIALS = 2  # calmer drives that one chain is tried at, where the drive loses what is wanted
LEAST_USE = 0.5  # of the best clean rate: an orientation that promises less is not tried
TRIALS_OF_RARE = 5  # short trials where no orientation comes often enough for the target at any calm drive
SCREENED = 6  # draws before a clean chain is proved
ROLLS = 0.3  # of the parts that lie on a round side: then the bank is steep
HOPELESS = 0.3  # [1] purity by the static rule, below which a chain is not tried
# how promising an idea is beside another one: of its bank, of a turning device, of a hole of several corners,
# with one device left out, for each device, and with one at which the same orientation was lost
BANK_RANK, TURNED, HOLED, AGAIN, EACH_DEVICE, LOST_BEFORE = 0.93, 0.6, 0.5, 0.8, 0.98, 0.7
LEAST_OF_MARGIN = 0.7  # of no margin at all
OFTENER = 0.25  # power of the share: what comes oftener is tried first, all else alike
BUDGETS = (0.5, 0.7, 1.0)  # of the trials that are allowed, after which each cost class has had its turn
NUMBER = re.compile(r"(?<![A-Za-z_])-?[0-9]+(?:\.[0-9]+)?")
LITTLE, LITTLE_SHARE = 0.1, 0.03  # [mm or deg], [1] of a value: chains that differ by less are alike
AVOIDED = 2  # times that a device is left out at which what is wanted was lost
HANGS_BELOW = np.radians(5.0)  # bank above which a part askew comes to rails beside its slot
ASKED_STEP = 1.2  # between the velocities at which chains are looked for
SLOWER = 1.2  # a chain that gains so many times what was taken for it is proposed again, at its own drive
LYING = proposals.Recipe(1, proposals.MARGINS[0], OutcomeKind.ANY, ())  # of what a part may do at best
Progress = Callable[[str, int, int, float, float], None]
Place = tuple[float, int]  # bank [rad] of a track, and row of an orientation on it
ChainKey = tuple[Track, str, tuple[tuple[str, str], ...]]
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
    kept_keys: frozenset[str]
    tell: Callable[[str], None]  # of a sentence
    shares: Shares | None = None
    attempts: list[Attempt] = field(default_factory=list)
    clean: list["Candidate"] = field(default_factory=list)  # of clean attempts
    failures: list["Candidate"] = field(default_factory=list)  # of others that deliver
    before: Callable[[], None] | None = None
    reserve: float = RESERVE
    min_speed: float = 0.0  # [m/s] through tooling, where what is wanted was lost at a slower drive
    # kinds of devices at which a row was lost, by bank and row
    avoided_kinds: dict[Place, tuple[str, ...]] = field(default_factory=dict)
    tracks: list["_BankedTrack"] = field(default_factory=list)  # of each bank what comes along it
    # by bank, row and way
    cache: dict[tuple[float, int, proposals.Recipe], Proposal | None] = field(default_factory=dict)
    chains: set[ChainKey] = field(default_factory=set)  # tried on their tracks, whatever the drive
    # bank and row, and the first devices that lost all of it
    lost_behind: list[tuple[Place, tuple[str, ...]]] = field(default_factory=list)
    reach: float = np.inf  # trials, those made included, after which the next cost class has its turn
    most_trials: float = np.inf  # short trials that are worth it
    start: int = 0  # trials that were made before this search began
    shares_given: bool = False  # the user says what arrives
    progress: Progress | None = None  # told what is done, how many of how many, seconds gone and to go
    nearest_limit: int | None = None  # trials at most, where the nearest that holds is looked for
    clock: "Clock" = field(default_factory=lambda: Clock())

    def keeps(self, key: str) -> bool:
        """Return whether the user gave a key of the bowl file, by its name."""
        return key in self.kept_keys

    @property
    def limit(self) -> int:
        """Short trials at most."""
        return int(self.nearest_limit or min(self.request.budget, self.most_trials))

    @property
    def is_spent(self) -> bool:
        """Whether the budget of trials is used up."""
        return len(self.attempts) >= min(self.request.budget, self.most_trials, self.reach)

    @property
    def best_rate(self) -> float:
        """The most that a clean attempt would deliver [1/s]."""
        return max((candidate.attempt.rate for candidate in self.clean), default=0.0)

    @property
    def arrivals(self) -> Shares:
        """What arrives."""
        if self.shares is None:
            raise ValueError("what arrives is not known before the tracks are")
        return self.shares

    def through(self, bowl: Bowl) -> Orientations:
        """Return what becomes of each orientation on the track and through the devices of a bowl."""
        return proposals.follow_orientations(self.part, self.arrivals.aspects, bowl)

    def orientations_along(self, bowl: Bowl) -> Orientations:
        """Return the same with what was counted of what arrives, where it was."""
        return stream.oriented(self.through(bowl), None if self.shares is None else self.shares.measured)

    def begin_trial(self, text: str) -> None:
        """Tell which trial begins, of how many, what came of the last one, the time gone and to go."""
        if self.before and not self.attempts:  # what has to be compiled is told before the first trial
            self.before()
        number = len(self.attempts) + 1
        self.clock.begin("trial", counts=runs.is_compiled())
        most = max(self.limit, number)
        self.tell(f"trial {number} of at most {most}: {text}{self._so_far()}")
        self._tell_progress("trial", number - 1, most)

    def begin_proof(self, text: str) -> None:
        """Tell that draws begin, what came of the last trial, the time gone and to go."""
        self.clock.begin("draws")
        self.tell(f"{text}{self._so_far()}")

    def run(self, stage: str) -> RunSettings:
        """Return how 'draws' or a 'queue' run: as was asked, and progress is told."""

        def tell_progress(done: int, total: int) -> None:
            if self.clock.reach(stage, done, total):
                self._tell_progress(stage, done, total)

        return replace(self.request.run, progress=tell_progress)

    def _rest(self) -> float:
        return self.clock.rest(len(self.attempts), self.limit, self.request.draws)

    def _tell_progress(self, stage: str, done: int, total: int) -> None:
        if self.progress:
            self.progress(stage, done, total, self.clock.seconds, self._rest())

    def _so_far(self) -> str:
        text = ""
        if self.attempts:
            last = self.attempts[-1]
            clean = f"clean, {60.0 * last.rate:.3g}/min" if last.clean else "nothing leaves"
            text = f"; trial {len(self.attempts)}: {', '.join(texts.fault_texts(last.faults, 2)) or clean}"
        if not self.clock.durations:
            return text
        rest = self._rest()  # on steps of 10 s above 20 s
        rest = max(round(rest / 10.0) * 10.0, 10.0) if rest > 20.0 else max(rest, 1.0)
        return f"{text}; {self.clock.seconds:.0f} s gone, about {rest:.0f} s to go"

    def share_needed(self, attempt: Attempt) -> float:
        """Return the share [1] of what is wanted that has to leave in a draw, for the target to be kept."""
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
        """Return its bowl without devices, with the keys that the user gave."""
        bare = replace(self.bowl, devices=())
        return calm_drive.PlainBowl(bare, search.kept_keys, search.request.drive)

    @property
    def worst(self) -> Fault | None:
        """The fault that some draws show most often; None where it was not drawn, or all of them held."""
        return None if self.robust is None else self.robust.worst

    @property
    def is_nearly_robust(self) -> bool:
        """Whether all draws of its screening but one held."""
        robust = self.robust
        return robust is not None and robust.held == robust.draws - 1 >= SCREENED - 1


class Clock:
    """How long the stages of a design take, and a guess of what is still to come."""

    def __init__(self) -> None:
        self.begun = self.last = self.since = time.monotonic()
        self.stage, self.done, self.total, self.counts = "", 0, 0, True
        self.durations: dict[str, tuple[float, float]] = {}  # of each stage seconds, and how many they were

    @property
    def seconds(self) -> float:
        """Seconds since it began."""
        return time.monotonic() - self.begun

    @property
    def _count_done(self) -> float:
        """Draws that are done, or how much of the queues at all fills."""
        return float(self.done) if self.stage == "draws" else self.done / max(self.total, 1)

    def begin(self, stage: str, *, counts: bool = True) -> None:
        """Begin a stage, 'trial', 'draws' or 'queue'; one that waits for the compiler does not count."""
        self.end()
        self.stage, self.done, self.total, self.counts = stage, 0, 1, counts
        self.since = time.monotonic()

    def end(self) -> None:
        """End the stage that runs, and note how long it took."""
        count = 1.0 if self.stage == "trial" else self._count_done
        if self.stage and self.counts and count > 0.0:
            seconds, number = self.durations.get(self.stage, (0.0, 0.0))
            self.durations[self.stage] = seconds + time.monotonic() - self.since, number + count
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

    def each(self, stage: str) -> float:
        """Return how long [s] one of a stage takes: as it did, or as usual on so fast a machine."""
        if stage in self.durations:
            seconds, number = self.durations[stage]
            return seconds / number
        # one quick trial is no fast machine
        seconds = USUAL_SLOWNESS_S + sum(duration for duration, _ in self.durations.values())
        usual = USUAL_SLOWNESS_S + sum(number * USUAL_S[name] for name, (_, number) in self.durations.items())
        return USUAL_S[stage] * seconds / usual

    def rest(self, trials: int, limit: int, draws: int) -> float:
        """Return a guess of the seconds to go: as if a usual number of trials led to one proof."""
        if self.stage == "draws":
            return max(draws - self._count_done, 0.0) * self.each("draws") + self.each("queue")
        if self.stage == "queue":
            return max(1.0 - self._count_done, 0.1) * self.each("queue")
        left = min(max(USUAL_TRIALS - trials, 1), max(limit - trials, 1))
        return left * self.each("trial") + draws * self.each("draws") + self.each("queue")


@dataclass(frozen=True, eq=False)
class _BankedTrack:
    """A bank of the track: the bowl without devices, and what comes along it."""

    plain_bowl: calm_drive.PlainBowl
    orientations: stream.Orientations
    weights: Floats  # (M,)
    rows: list[int]  # those worth a try
    rank: float  # [1] how likely the bank is to do

    @functools.cached_property
    def fastest(self) -> float:
        """Velocity [m/s] at the fastest drive."""
        return calm_drive.speed(calm_drive.drive_at(self.plain_bowl, np.inf, hops=True))


@dataclass(frozen=True, eq=False)
class _Idea:
    """An orientation on a track, and a way of proposing a chain for it."""

    track: _BankedTrack
    row: int
    recipe: proposals.Recipe
    proposal: Proposal | None = None  # once it was looked for
    left_out: int = 0  # times that a device was left out at which it was lost

    @property
    def place(self) -> Place:
        """Bank of its track, and its row."""
        return self.track.plain_bowl.bowl.track.bank, self.row


def candidates(search: Search, cost_class: int | None = None) -> Iterator[Candidate]:
    """Try proposals, and yield each Candidate that is clean and brings the target, within the budget.

    They are of one cost class, or else of all, the cheapest first: in each no device at all, then the most
    promising chain of all banks, and so on. The ``passed`` and ``failed`` of the search are filled.
    """
    own_devices = search.plain.devices
    own_class = cost_class_of(own_devices)
    for number in proposals.COST_CLASSES if cost_class is None else (cost_class,):
        if own_class > number:  # the user's own devices are dearer
            continue
        share = BUDGETS[proposals.COST_CLASSES.index(number)]
        search.reach = search.start + math.ceil(share * (search.request.budget - search.start))
        tracks = _tracks(search)
        for track in tracks if number == max(1, own_class) else ():
            bare = proposals.propose_no_device(track.orientations, track.weights, search.request, own_devices)
            if bare is not None and not _was_tried(search, track, bare) and not search.is_spent:
                yield from _try_and_mend(search, track.plain_bowl, bare, track.weights)
        yield from _chains(search, tracks, number)


def _chains(search: Search, tracks: list[_BankedTrack], cost_class: int) -> Iterator[Candidate]:
    """Candidates with chains of a cost class, the most promising first.

    A chain is looked for where its bound is the highest.
    """
    # what is not rare needs nothing that turns others into it
    ideas = [
        _Idea(track, row, recipe)
        for track in tracks
        for row in track.rows
        for recipe in proposals.recipes_of(cost_class, search.request)
        if not recipe.turns or _share(search, track, row) < proposals.RARE_ORIENTATION
    ]
    order = itertools.count()  # of equal ones the first
    heap = [(-_bound(search, idea), next(order), idea) for idea in ideas]
    heapq.heapify(heap)
    while heap and not search.is_spent:
        _, _, idea = heapq.heappop(heap)
        # what it has to promise [1/s], to be tried beside what is clean already
        best, target = search.best_rate, search.request.target
        least = target if 0.0 < best < target else LEAST_USE * best
        if _promise(search, idea.track, idea.row, idea.recipe) < least:
            continue
        proposal = idea.proposal or _proposal(search, idea)
        if proposal is None or _was_tried(search, idea.track, proposal):
            continue
        avoided = search.avoided_kinds.get(idea.place, ())
        if idea.proposal is None:  # rate, purity, margin and number of devices, and what was lost before
            loss = LOST_BEFORE if {cut.device.kind for cut in proposal.cuts} & set(avoided) else 1.0
            score = _bound(search, idea) * proposal.purity * EACH_DEVICE ** len(proposal.cuts) * loss
            heapq.heappush(heap, (-score, next(order), replace(idea, proposal=proposal)))
            continue
        # what is wanted was lost whole at a device of one that begins so
        heads = [head for own, head in search.lost_behind if own == idea.place]
        if proposal.purity < HOPELESS or any(proposal.chain[: len(head)] == head for head in heads):
            continue
        yield from _try_and_mend(search, idea.track.plain_bowl, proposal, idea.track.weights)
        excluded = idea.recipe.excluded_kinds
        more = tuple(kind for kind in search.avoided_kinds.get(idea.place, ()) if kind not in excluded)
        if more and idea.left_out < AVOIDED:
            recipe = replace(idea.recipe, excluded_kinds=(*excluded, *more))
            other = _Idea(idea.track, idea.row, recipe, left_out=idea.left_out + 1)
            heapq.heappush(heap, (-_bound(search, other), next(order), other))


def _proposal(search: Search, idea: _Idea) -> Proposal | None:
    """The chain of an idea; None where none is, or there is none with less asked for.

    A smaller margin asks for less, and so do chains without turning devices: where even those isolate
    nothing, the longer search is left out.
    """
    recipe = idea.recipe
    plain, least = replace(recipe, turns=False), min(proposals.MARGINS)
    easier = dict.fromkeys((replace(plain, margin=least), plain, replace(recipe, margin=least), recipe))
    for other in easier:
        key = (*idea.place, other)
        if key not in search.cache:
            search.cache[key] = _propose(search, idea.track, idea.row, other)
        if search.cache[key] is None:
            return None
    return search.cache[(*idea.place, recipe)]


def _tracks(search: Search) -> list[_BankedTrack]:
    """The tracks that are tried, of each bank: once for all cost classes."""
    if search.tracks:
        return search.tracks
    aspects = find_aspects(search.part) if search.shares is None else search.shares.aspects
    # the steeper bank first where the part rolls
    chances = np.nan_to_num(aspects.chances[search.request.rule])
    rolling = float(chances[[kind != FLAT_KIND for kind in aspects.kinds]].sum())
    banks = calm_drive.STEEP_BANKS if rolling > ROLLS * chances.sum() else calm_drive.BANKS
    if search.keeps("track.bank"):
        banks = (search.plain.track.bank,)
    for number, bank in enumerate(banks):
        plain_bowl = calm_drive.section(
            search.part, aspects, search.plain, search.kept_keys, diameter=search.request.diameter,
            bank=bank, drive=search.request.drive,
        )  # fmt: skip
        start = replace(calm_drive.drive_at(plain_bowl, 0.0), devices=search.plain.devices)
        if search.shares is None:
            search.shares = entry_shares(search, start)
        orientations, weights = weigh_orientations(search, start)
        rows = proposals.promising_rows(orientations, weights, search.request)[: proposals.PROPOSED_ROWS]
        search.tracks.append(_BankedTrack(plain_bowl, orientations, weights, rows, BANK_RANK**number))
    # also of what may hang: infinite
    placed = [(track, row) for track in search.tracks for row in track.rows]
    enough = any(_promise(search, track, row, LYING) >= search.request.target for track, row in placed)
    turns = any(_share(search, track, row) < proposals.RARE_ORIENTATION for track, row in placed)
    if not enough and not turns:
        search.most_trials = search.start + TRIALS_OF_RARE
    return search.tracks


def _bound(search: Search, idea: _Idea) -> float:
    """How promising [1] the chain of an idea can be at best."""
    recipe, track = idea.recipe, idea.track
    rate = min(_promise(search, track, idea.row, recipe) / (search.reserve * search.request.target), 1.0)
    flat = track.plain_bowl.bowl.track.bank <= HANGS_BELOW
    rank = track.rank if recipe.outcome == OutcomeKind.LYING else 1.0 if flat else BANK_RANK**2
    simplicity = (TURNED if recipe.turns else 1.0) * (HOLED if recipe.holes else 1.0)
    share = _share(search, track, idea.row) ** OFTENER
    margin = LEAST_OF_MARGIN + (1.0 - LEAST_OF_MARGIN) * min(recipe.margin / proposals.MARGINS[0], 1.0)
    return rate * rank * simplicity * share * margin * AGAIN**idea.left_out


def chain_key(track: Track, proposal: Proposal, orientations: Sequence[Orientation]) -> ChainKey:
    """Return what names a chain on a track and what shall leave it, whatever the drive.

    The order of what a sensor lets pass makes no difference.
    """
    wanted = "hanging" if proposal.hangs else orientations[proposal.row].name
    return track, wanted, tuple((device.kind, device.canonical_text) for device in proposal.devices)


def _was_tried(search: Search, track: _BankedTrack, proposal: Proposal) -> bool:
    """Whether a chain was tried on that track, or one whose values differ by less than makes a difference."""
    key = chain_key(track.plain_bowl.bowl.track, proposal, track.orientations.lying)
    return key in search.chains or any(_is_alike(key, other) for other in search.chains)


def _is_alike(key: ChainKey, other: ChainKey) -> bool:
    """Whether two chains for the same track and orientation differ by little in each of their numbers."""
    if key[:2] != other[:2] or len(key[2]) != len(other[2]):
        return False
    texts, other_texts = (" ".join(" ".join(device) for device in chain[2]) for chain in (key, other))
    if NUMBER.sub("#", texts) != NUMBER.sub("#", other_texts):
        return False
    pairs = zip(NUMBER.findall(texts), NUMBER.findall(other_texts), strict=True)
    values = ((float(a), float(b)) for a, b in pairs)
    return all(abs(a - b) <= max(LITTLE, LITTLE_SHARE * abs(a)) for a, b in values)


def _promise(search: Search, track: _BankedTrack, row: int, recipe: proposals.Recipe) -> float:
    """Parts [1/s] that an orientation brings at the fastest drive, were all others returned."""
    if recipe.outcome != OutcomeKind.LYING and neck(track.orientations.lying[row]) is not None:
        return np.inf  # what hangs comes from several headings
    pitch = short_trials.GAP * float((track.weights * track.orientations.lengths).sum())
    share = 1.0 if recipe.turns else _share(search, track, row)
    return share * track.fastest / pitch


def _share(search: Search, track: _BankedTrack, row: int) -> float:
    """Share [1] in which an orientation comes, with those that count as it."""
    equivalent = proposals.equivalent_rows(track.orientations.lying, row, search.request.up)
    return float(track.weights[[row, *equivalent]].sum())


def _propose(search: Search, track: _BankedTrack, row: int, recipe: proposals.Recipe) -> Proposal | None:
    """A chain for one orientation at the drive that its share asks for; None where there is none."""

    def at_drive_for(gain: float) -> Proposal | None:
        velocity = required_velocity(search, track.orientations, track.weights, gain)
        step = math.ceil(math.log(velocity, ASKED_STEP) - 1e-9)  # the same drive for shares that are alike
        bowl = calm_drive.drive_at(track.plain_bowl, ASKED_STEP**step)
        return proposals.propose_chain(
            search.part, replace(bowl, devices=search.plain.devices), search.arrivals.aspects, row,
            track.orientations, search.request, recipe,
        )  # fmt: skip

    share = _share(search, track, row)
    proposal = at_drive_for(share)
    if proposal is None:
        return None
    # the share that leaves as wanted, as the static rule says
    through = search.through(replace(track.plain_bowl.bowl, devices=proposal.devices))
    gain = short_trials.gain(through, track.weights, proposal.states(through))
    return (at_drive_for(gain) if gain > SLOWER * share else None) or proposal


def required_velocity(
    search: Search, orientations: Orientations, weights: Floats, gain: float, spacing: float = 0.0
) -> float:
    """Return the velocity [m/s] that brings the target, with a reserve, at a share that leaves as wanted.

    Parts come in a row, ``spacing`` [m] farther than they do by themselves where devices need that.
    """
    pitch = short_trials.GAP * float((weights * orientations.lengths).sum()) + spacing
    return search.reserve * search.request.target * pitch / max(gain, 1e-3)


def entry_shares(search: Search, bowl: Bowl) -> Shares:
    """Return what lies at the entry of the track of a bowl."""
    bare = replace(bowl, devices=())
    return shares(search.part, bare, rule=search.request.rule, jobs=search.request.jobs)


def weigh_orientations(search: Search, bowl: Bowl) -> tuple[Orientations, Floats]:
    """Return what comes along a track, and in which shares (M,) [1]."""
    orientations = search.orientations_along(bowl)
    weights = np.nan_to_num(orientations.rules[search.request.rule])
    total = weights.sum()
    return orientations, weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))


def _try_and_mend(
    search: Search, plain_bowl: calm_drive.PlainBowl, proposal: Proposal, weights: Floats
) -> Iterator[Candidate]:
    """Try a proposal and what mends it; the Candidate where one is clean and fast enough.

    One that one draw alone denies is taken where nothing mends it: the draws of its proof are more.
    """
    lost, before, nearly = 0, None, None
    for _ in range(MENDED + 1):
        candidate = _screen(search, try_proposal(search, plain_bowl, proposal, weights))
        calmed = _find_calmer(search, candidate)
        if calmed.attempt.clean:
            search.clean.append(calmed)
            if calmed.attempt.rate >= search.request.target:
                yield calmed
                return
        if candidate.attempt.clean:
            return
        search.failures.append(candidate)
        nearly = nearly or (candidate if candidate.is_nearly_robust else None)
        if not candidate.attempt.efficiency > 0.0 and not candidate.proposal.hangs:
            lost += 1
        attempt, lying = candidate.attempt, candidate.orientations.lying
        after = attempt.faults, attempt.efficiency, attempt.stopped
        if after == before or lost == LOST_TRIALS or search.is_spent:  # what was changed made no difference
            break
        before = after
        changed = proposals.mend_proposal(proposal, candidate.trial, lying, candidate.worst)
        if changed is None or chain_key(plain_bowl.bowl.track, changed, lying) in search.chains:
            break
        proposal = changed
    chosen = _find_livelier(search, candidate) or nearly
    if chosen is not None:
        yield chosen
        return
    # at which devices what is wanted was lost; rails are the only way to hang
    place, trial = (plain_bowl.bowl.track.bank, proposal.row), candidate.trial
    lost_at = {cut.device.kind for cut in proposal.cuts if not cut.device.hangs}
    kinds = sorted(kind for kind in lost_at if proposals.lost_at(trial, kind))
    search.avoided_kinds[place] = tuple(dict.fromkeys((*search.avoided_kinds.get(place, ()), *kinds)))
    # where all of it ended at one of them: another chain that begins so does no better
    ends = {end for n, k in enumerate(trial.rows) if k == proposal.row for end in trial.ends[n]}
    if not trial.efficiency > 0.0 and len(ends) == 1:
        count = devices_to(ends.pop(), proposal)
        if count:
            search.lost_behind.append((place, proposal.chain[:count]))


def devices_to(end: End, proposal: Proposal) -> int:
    """Return how many devices of a chain stand along the track up to an end; 0 on the bare track."""
    placed = [k for k, device in enumerate(proposal.devices) if device.placed]
    return 0 if end.on_bare_track else placed[end.station - 1] + 1


def _find_livelier(search: Search, candidate: Candidate) -> Candidate | None:
    """The candidate at a livelier drive, where parts stay at a blade or at rails; None where none is clean.

    Where one draw alone denies that, it is taken as well.
    """
    for _ in range(LIVELIER_TRIALS):
        if search.is_spent or not stays_at_steel(candidate.proposal, candidate.attempt.faults):
            return None
        other = try_livelier(search, candidate)
        if other is None:
            return None
        candidate = other
        if candidate.attempt.clean:
            search.clean.append(candidate)
            return candidate if candidate.attempt.rate >= search.request.target else None
        if candidate.is_nearly_robust:
            return candidate
    return None


def try_livelier(search: Search, candidate: Candidate) -> Candidate | None:
    """Return the same chain screened at a livelier drive than that at which parts stay; None without one."""
    bowl = calm_drive.find_livelier(candidate.plain_bowl(search), candidate.bowl)
    other = _at_drive(search, candidate, bowl, MoveKind.LIVELIER_DRIVE)
    return None if other is None else _screen(search, other)


def _at_drive(search: Search, candidate: Candidate, bowl: Bowl | None, kind: MoveKind) -> Candidate | None:
    """The chain of a candidate tried at the drive of a bowl; None without one."""
    if bowl is None:
        return None
    move = Move(kind, 2.0 * bowl.drive.amplitude)
    return try_again(search, candidate, replace(candidate.proposal, move=move), bowl)


def stays_at_steel(proposal: Proposal, faults: Iterable[Fault]) -> bool:
    """Return whether parts stay at a blade or at rails of a chain, as faults of a trial or of draws show."""
    steel = {cut.device.kind for cut in proposal.cuts if cut.device.overhead or cut.device.hangs}
    return any(fault.stops_at(steel) for fault in faults)


def _find_calmer(search: Search, first: Candidate) -> Candidate:
    """The candidate at a calmer drive that is clean, where the one it had turns or loses what is wanted."""
    candidate = first
    for _ in range(CALMER_TRIALS):
        worst = candidate.worst  # in a trial on the track, or in draws by turning it
        turned = worst is not None and worst.kind is FaultKind.LOST and worst.is_on_bare_track
        moved_out = turned or bool(short_trials.lost_by_motion(candidate.trial))
        if candidate.attempt.clean or search.is_spent or not moved_out:
            break
        other = try_calmer(search, candidate)
        if other is None:
            break
        search.most_trials += 1  # no other chain is left out for it
        candidate = _screen(search, other)
    return candidate if candidate.attempt.clean else first


def try_calmer(search: Search, candidate: Candidate) -> Candidate | None:
    """Return the same chain tried at a calmer drive than that which lost parts; None without one."""
    bowl = calm_drive.find_calmer(candidate.plain_bowl(search), candidate.bowl)
    return _at_drive(search, candidate, bowl, MoveKind.CALMER_DRIVE)


def _screen(search: Search, candidate: Candidate) -> Candidate:
    """A clean candidate after some draws of part, friction, drive and cuts; denied where one fails."""
    if not candidate.attempt.clean or candidate.attempt.rate < search.request.target:
        return candidate
    request = search.request
    robust = robust_run(
        search.part, candidate.bowl, candidate.orientations, candidate.weights, candidate.proposal.rows,
        draws=min(SCREENED, request.draws), tolerance=request.tolerance, run=request.run,
        any_heading=candidate.proposal.any_heading, enough=search.share_needed(candidate.attempt),
        returnable=short_trials.find_returnable_rows(candidate.trial), max_failures=1,
    )  # fmt: skip
    if robust.partial:
        raise KeyboardInterrupt
    if robust.held == robust.draws:
        return candidate
    attempt = replace(candidate.attempt, faults=() if robust.worst is None else (robust.worst,))
    search.attempts[-1] = attempt
    return replace(candidate, attempt=attempt, robust=robust)


def try_proposal(
    search: Search,
    plain_bowl: calm_drive.PlainBowl,
    proposal: Proposal,
    weights: Floats,
    driven: Bowl | None = None,
) -> Candidate:
    """Return one short trial at the drive that the target asks for, or at that of a bowl.

    Weights are shares (M,) [1] of the orientations.
    """
    check_written(proposal.devices, "design.yaml")
    if not search.keeps("track.climb") and any(device.leans for device in proposal.devices):
        # as steep as a spacing section that leads down needs the track: else it has no solid
        bowl = replace(plain_bowl.bowl, devices=proposal.devices)
        climb = solidbowl.drawable_climb(bowl, search.part, search.through(bowl))
        plain_bowl = replace(
            plain_bowl, bowl=replace(plain_bowl.bowl, track=replace(bowl.track, climb=climb))
        )
    own = drive_for_target(search, plain_bowl, proposal, weights) if driven is None else driven
    bowl = replace(own, track=plain_bowl.bowl.track, devices=proposal.devices)
    orientations = search.orientations_along(bowl)
    search.chains.add(chain_key(bowl.track, proposal, orientations.lying))
    search.begin_trial(f"{orientations.lying[proposal.row].name}, {texts.move_text(proposal.move)}")
    trial = _short(search, bowl, orientations, weights, proposal)
    faults = tuple(find_denials(trial))
    # which fault it shows: what loses the wanted orientation first, then what lets others leave
    cause = Cause.UNKNOWN
    if faults and (short_trials.lost_by_motion(trial) or not trial.velocity > 0.0):
        cause = Cause.DRIVE
    elif faults:
        cause = Cause.DEVICE if trial.loses_wanted or proposal.devices else Cause.PART
    state = orientations.states[trial.states[0]]
    attempt = Attempt(
        wanted=state.name,
        aspect="" if isinstance(state, Hanging) else state.aspect,
        chain=proposal.chain,
        move=proposal.move,
        bank=bowl.track.bank,
        velocity=trial.velocity,
        parts=int(trial.parts.sum()),
        efficiency=trial.efficiency,
        purity=trial.purity,
        stopped=trial.stopped,
        rate=trial.rate,
        faults=faults,
        cause=cause,
        peak_to_peak=2.0 * bowl.drive.amplitude,
        throw_number=float(throw_number(bowl)),
        cost_class=proposal.cost_class,
    )
    search.attempts.append(attempt)
    search.clock.end()
    return Candidate(proposal, bowl, orientations, weights, trial, attempt)


def try_again(search: Search, candidate: Candidate, proposal: Proposal, bowl: Bowl) -> Candidate:
    """Return a candidate tried with another proposal at the drive of a bowl."""
    return try_proposal(search, candidate.plain_bowl(search), proposal, candidate.weights, bowl)


def drive_for_target(
    search: Search, plain_bowl: calm_drive.PlainBowl, proposal: Proposal, weights: Floats
) -> Bowl:
    """Return the bowl at the drive that brings the target, with the gaps that its devices need there.

    Weights are shares (M,) [1] of the orientations.
    """
    orientations = search.through(replace(plain_bowl.bowl, devices=proposal.devices))
    gain, spacing = short_trials.gain(orientations, weights, proposal.states(orientations)), 0.0
    for _ in range(2):
        velocity = max(required_velocity(search, orientations, weights, gain, spacing), search.min_speed)
        bowl = calm_drive.drive_at(plain_bowl, velocity, hops=not proposal.devices)
        spacing = stream.needed_spacing(proposal.devices, orientations.lying, bowl)
        if not spacing > 0.0:
            break
    return bowl


def _short(
    search: Search, bowl: Bowl, orientations: Orientations, weights: Floats, proposal: Proposal
) -> short_trials.ShortTrial:
    """The short trial: what is wanted first; where none of it leaves, the others are not tried."""
    single = functools.partial(
        short_trials.try_parts, search.part, bowl, orientations, weights, proposal.rows,
        run=search.request.run, aspects=search.arrivals.aspects, any_heading=proposal.any_heading,
    )  # fmt: skip
    rows = short_trials.frequent_rows(weights, (proposal.row,))
    right = set(short_trials.wanted_rows(orientations, proposal.states(orientations)))
    first = [k for k in rows if k in right] or [proposal.row]
    others = [k for k in rows if k not in first]
    trial = single(rows=first, count=SHORT_TRIAL_PARTS)
    if not trial.efficiency > 0.0 or not others:
        return trial
    each = SHORT_TRIAL_PARTS if len(others) <= short_trials.FEW_OTHERS else 1
    return trial.join(single(rows=others, count=each))
