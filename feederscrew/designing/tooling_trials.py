"""The trial of what is proposed for ``feeder tooling``: both verdicts side by side, the cheapest class first.

Beside the chain of the static rule, chains of each class come from the search that ``feeder design`` makes:
``exploring.candidates``, on the bowl as it is.
"""

import functools
import math
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from feederscrew.arrivals.ensemble import wilson
from feederscrew.arrivals.entry import Shares
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.columns import Column
from feederscrew.base.errors import FeederError
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.kinds import CostClass, names
from feederscrew.bowl.devices.kinds import cost_class as cost_class_of
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing import calm_drive, exploring, hanging, proposals, short_trials, texts
from feederscrew.designing.findings import Fault, FaultKind
from feederscrew.designing.policy import USUAL_POLICY
from feederscrew.designing.progress import SearchProgress
from feederscrew.designing.proposals import equivalent_rows
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.search import Candidate, Search, TrackAtBank
from feederscrew.designing.short_trials import SELDOM_SHARE, find_denials
from feederscrew.feeding import stream
from feederscrew.sorting.isolating import chain as static
from feederscrew.sorting.isolating.chain import Design, DesignConstraints, OutcomeKind
from feederscrew.sorting.tooling import ToolingStudy
from feederscrew.trials.fills import require_room
from feederscrew.trials.wanted import aspects_at_any_heading

PARTS_OF_EACH = 2  # parts of each orientation
MORE_PARTS = 20  # parts beside those where the trial denies nothing, by the shares of the orientations
BEST = 3  # designs of a table that are tried
TRIES = 5  # designs of one orientation that are tried where the first ones are denied
SEARCHES = 8  # designs that are looked for after a denied one
# stretches that reject nothing: to leave them out makes no other chain
KEPT = names(lambda kind: kind.action in (Action.CLIMB, Action.BANK))
RARE_SHARE = 1e-3  # [1] of the wanted share: what comes less often than that changes no purity
FURTHER = 8  # orientations that come less often than that and may leave, and are tried as well
SLIGHT = 1e-9  # [1] of rounding
ANY_RATE = 1e-6  # [1/s] below any: the bowl and its drive are given, whatever they bring
SEARCH_TRIALS = 25  # short trials at most: 10 of steel, as many as the rails of one head take
POLICY = replace(USUAL_POLICY, budget_shares=(0.4, 0.6, 1.0))  # of them, after which each class had its turn
# what of the bowl is kept: all but its bank, which is tried as ``feeder design`` does where it was not given
OWN_KEYS = (
    "track.climb",
    "track.radius",
    "track.width",
    "track.bank",
    "drive.amplitude",
    "drive.frequency",
    "drive.vibration_angle",
    "drive.phase",
    "machine.leaves",
)
# returns a study without more kinds of devices, of a class
Propose: TypeAlias = Callable[[tuple[str, ...], CostClass | None], ToolingStudy]


@dataclass(frozen=True)
class TriedDesign:
    """A chain of ``feeder tooling``, tried with a few parts of each orientation that comes often."""

    name: str  # of the orientation wanted
    wanted: int  # its place among the orientations
    devices: tuple[str, ...]  # of the chain, as a bowl file has them
    static_efficiency: float  # [1]
    efficiency: float  # [1] of all that is offered
    purity: float  # [1] NaN where nothing leaves
    parts: int
    faults: tuple[Fault, ...]  # what the trial denies
    efficiency_ends: tuple[float, float] = (0.0, 1.0)  # [1] 95 % interval
    purity_ends: tuple[float, float] = (0.0, 1.0)  # [1]
    devices_words: tuple[str, ...] = ()  # of the chain, as the trade names them
    left: tuple[str, ...] = ()  # names of the orientations, as they came, of which a part left

    @property
    def agrees(self) -> bool:
        """Tell whether the trial denies nothing and the rule's efficiency lies in its interval."""
        low, high = self.efficiency_ends
        return not self.faults and low - SLIGHT <= self.static_efficiency <= high + SLIGHT

    @property
    def verdict(self) -> str:
        """Return the verdict of the trial on the rule."""
        if self.faults:
            return "the trial denies it: " + "; ".join(texts.fault_texts(self.faults))
        return (
            "the trial agrees" if self.agrees else "the trial sorts too, but the rule's efficiency is not its"
        )

    @property
    def figures(self) -> str:
        """Return the shares that leave, with their intervals."""
        purity = "nothing leaves"
        if not np.isnan(self.purity):
            purity = f"{texts.percent(self.purity, self.purity_ends)} of what leaves"
        return f"{texts.percent(self.efficiency, self.efficiency_ends)} do, {purity}"

    @property
    def verdicts(self) -> str:
        """Return the verdicts of the static rule and of the trial."""
        return (
            f"the static rule lets {100.0 * self.static_efficiency:.3g} % leave, of {self.parts} parts tried "
            f"{self.figures}; {self.verdict}"
        )

    @property
    def sentence(self) -> str:
        """Both verdicts on the orientation."""
        return f"{self.name}: {self.verdicts}"


def try_designs(
    study: ToolingStudy,
    propose: Propose | None = None,
    *,
    seed: int = 1,
    jobs: int = 1,
    cost_class: str | None = None,
    efficiency: float = 0.0,
    kept_keys: Collection[str] = (),
    without: Sequence[str] = (),
    outcome: str = OutcomeKind.ANY,
    heading_given: bool = False,
    before: Callable[[], None] | None = None,
    until: float = math.inf,
) -> ToolingStudy:
    """Try the chain of the orientation that was asked for, or the best three of a table.

    Of a table, the search of ``feeder design`` then looks for a chain of its best one in the classes that are
    cheaper than what the trial confirms, in all where it confirms none. Of an orientation that was asked for,
    classes are tried in the order of cost, until the trial confirms a chain: that of the static rule, what
    the search of ``feeder design`` finds, and what the static rule has without some kinds of devices. Chains
    of the static rule that isolate nothing are not tried.

    Parameters
    ----------
    study : ToolingStudy
    propose : callable, optional
        Returns the same study without some kinds of devices, of a class; without it nothing else is tried.
    seed, jobs : int
        Of the trials.
    cost_class : str, optional
        The one class that is asked for.
    efficiency : float [1]
        That is asked for: dearer classes are tried until a chain has it.
    kept_keys : collection of str
        Keys of the bowl file that the user gave: another bank is tried where 'track.bank' is none of them.
    without : sequence of str
        Kinds of devices that are not used.
    outcome : str
        How parts leave.
    heading_given : bool
        Whether the user asks for one heading: else parts of the aspect may hang by a head from any.
    before : callable, optional
        Called before anything is compiled.
    until : float [s]
        Of ``time.monotonic()``: no trial begins after it; one that has begun ends.

    Returns
    -------
    ToolingStudy
        With its ``trials``: first that of a chain that the trial confirms where one is found. After an
        interrupt from the keyboard it is ``partial``, with the trials that ended.
    """
    run = RunSettings(seed, jobs, before=before)
    classes = tuple(CostClass) if cost_class is None else (CostClass(cost_class),)
    may_use = tuple(without), OutcomeKind(outcome), heading_given
    if study.wanted is None:
        tried = _try_table(study, run, until)
        if propose is None or tried.partial or not tried.trials:
            return tried
        confirmed = (tried.class_of(trial.wanted) for trial in tried.trials)
        cheapest = min((one.number for one in confirmed if one is not None), default=math.inf)
        cheaper = [one for one in classes if one.number < cheapest]
        return _look_further(tried, cheaper, run, until, frozenset(kept_keys), may_use)
    if propose is None:
        return _try_table(study, run, until)
    asked = AskedOrientation(study, propose, run, until, frozenset(kept_keys), *may_use)
    for one in classes:
        asked.try_class(one)
        if asked.is_over or any(share >= efficiency for share in asked.confirmed):
            break
    return asked.answer(efficiency)


def _look_further(
    study: ToolingStudy,
    classes: Sequence[CostClass],
    run: RunSettings,
    until: float,
    kept_keys: frozenset[str],
    may_use: tuple[tuple[str, ...], OutcomeKind, bool],
) -> ToolingStudy:
    """A table with the chain that the search finds for its best orientation in some classes, the first first.

    The search is the one that follows the static rule where that orientation is asked for by its aspect. Of a
    chain in which parts hang, other headings of the aspect that left in its trial have it as well.
    """
    place = study.trials[0].wanted
    asked = AskedOrientation(replace(study, wanted=place), None, run, until, kept_keys, *may_use)
    for one in classes:
        asked.try_class(one)
        if asked.is_over or asked.confirmed:
            break
    if not asked.confirmed:
        return replace(study, partial=asked.is_stopped)
    found = asked.answer(0.0)
    design, first = found.design, found.trials[0]
    if design is None:
        return study
    places, designs = [place], list(study.designs)
    if any(device.action is Action.HANG for device in design.devices):
        aspect = study.orientations[place].aspect
        same = (k for k, one in enumerate(study.orientations) if one.aspect == aspect and k != place)
        places += [k for k in same if study.orientations[k].name in first.left]
    for k in places:
        designs[k] = replace(design, wanted=k)
    others = tuple(trial for trial in study.trials if trial.wanted not in places)
    trials = tuple(replace(first, name=study.orientations[k].name, wanted=k) for k in places)
    return replace(study, designs=tuple(designs), trials=(*trials, *others))


def _try_table(study: ToolingStudy, run: RunSettings, until: float) -> ToolingStudy:
    """The study with the trials of its best designs."""
    candidates = [
        design
        for design in study.designs
        if design is not None and design.devices and design.efficiency > 0.0
    ]
    best = sorted(candidates, key=lambda design: (-design.isolated, -design.efficiency, design.wanted))
    trials: tuple[TriedDesign, ...] = ()
    try:
        for proposed in best[:BEST]:
            if time.monotonic() > until:
                break
            trials = (*trials, _try_design(study, proposed, run))
    except KeyboardInterrupt:
        return replace(study, trials=trials, partial=True)
    return replace(study, trials=trials)


class AskedOrientation:
    """The trials of chains for one orientation, class by class."""

    def __init__(
        self,
        study: ToolingStudy,
        propose: Propose | None,
        run: RunSettings,
        until: float,
        kept_keys: frozenset[str],
        without: tuple[str, ...],
        outcome: OutcomeKind,
        heading_given: bool,
    ) -> None:
        self.study, self.propose, self.run, self.until = study, propose, run, until
        self.kept_keys, self.without = kept_keys, without
        self.outcome, self.heading_given = outcome, heading_given
        self.tried: list[tuple[ToolingStudy, TriedDesign]] = []
        self.in_vain: list[tuple[CostClass, int]] = []  # classes in which no chain held, and short trials
        self.is_stopped = False
        self._found: list[Search] = []

    def searches(self, cost_class: CostClass) -> Iterator[Search]:
        """Yield the searches of a design on this bowl, begun once for all classes.

        That of the orientation itself; of steel then that of parts that hang from other headings.

        Parameters
        ----------
        cost_class : CostClass
            For which they are asked.

        Yields
        ------
        Search
        """
        if not self._found:
            self._found.append(_search_on(self))
        yield self._found[0]
        if self.heading_given or cost_class is not CostClass.STEEL or self.outcome is OutcomeKind.LYING:
            return
        hanging_too = _search_on(self, only_hanging=True)
        if any(track.rows for track in hanging_too.state.tracks):
            self._found.append(hanging_too)
            yield hanging_too

    @property
    def count(self) -> int:
        """How many trials were made."""
        return len(self.tried) + sum(len(search.state.attempts) for search in self._found)

    @property
    def confirmed(self) -> list[float]:
        """The static efficiencies [1] of the chains that the trial confirms, in the order tried."""
        return [tried.static_efficiency for _, tried in self.tried if not tried.faults]

    @property
    def is_over(self) -> bool:
        """Tell whether nothing more is to be tried."""
        return self.is_stopped or time.monotonic() > self.until

    def try_class(self, cost_class: CostClass) -> None:
        """Try chains of a class until one is confirmed.

        An interrupt from the keyboard ends it: ``is_stopped`` is set.

        Parameters
        ----------
        cost_class : CostClass
        """
        begun, before = len(self.tried), self.count
        try:
            self._try_class(cost_class)
        except KeyboardInterrupt:
            self.is_stopped = True
            return
        if all(tried.faults for _, tried in self.tried[begun:]) and not self.is_over:
            self.in_vain.append((cost_class, self.count - before))

    def _try_class(self, cost_class: CostClass) -> None:
        design, first = self.study.design, self.study
        own = CostClass.of(design.devices) if design is not None else cost_class
        is_twisted = any(device.on_side for device in self.study.bowl.devices)
        if is_twisted and own is not cost_class:  # nothing stands behind a twist: the file has one chain
            return
        if self.propose is not None and own is not cost_class and own.number < cost_class.number:
            first = self.propose((), cost_class)
            design = first.design
        # a table has tried its static design already, and proposes no other
        may_be_static = self.propose is not None and own.number <= cost_class.number
        is_static = may_be_static and _may_isolate(design, cost_class)
        if is_static and design is not None and not self._try(first, design).faults:
            return
        if is_twisted:
            return
        for found in search_chains(self, cost_class):
            if found.design is not None and not self._try(found, found.design).faults:
                return
            if self.is_over:
                return
        if is_static and design is not None and self.propose is not None:
            self._try_ways_on(cost_class, design, self.propose)

    def _try(self, study: ToolingStudy, design: Design) -> TriedDesign:
        tried = _try_design(study, design, self.run)
        self.tried.append((study, tried))
        return tried

    def _try_ways_on(self, cost_class: CostClass, design: Design, propose: Propose) -> None:
        """Try chains without one or more kinds of devices of one that the trial denies."""
        pending, searched, begun = _ways_on((), design), 0, len(self.tried)
        while pending and searched < SEARCHES and len(self.tried) - begun < TRIES - 1 and not self.is_over:
            kinds, searched = pending.pop(0), searched + 1
            other = propose(kinds, cost_class)
            if other.partial:
                raise KeyboardInterrupt
            changed = other.design
            if changed is None or not _may_isolate(changed, cost_class):
                continue
            if _devices(changed) in [tried.devices for _, tried in self.tried]:
                continue
            tried = self._try(other, changed)
            if not tried.faults and changed.efficiency >= design.efficiency:
                break
            pending += _ways_on(kinds, changed) if tried.faults else []

    def answer(self, efficiency: float) -> ToolingStudy:
        """Return the study of the cheapest chain that is confirmed; else the first, as it is denied.

        Parameters
        ----------
        efficiency : float [1]
            That is asked for.

        Returns
        -------
        ToolingStudy
        """
        partial = self.is_stopped or self.study.partial
        if not self.tried:
            return replace(self.study, in_vain=tuple(self.in_vain), partial=partial)
        holds = [k for k, (_, tried) in enumerate(self.tried) if not tried.faults]

        def merit(k: int) -> tuple[bool, int, float]:
            study, tried = self.tried[k]
            cost = cost_class_of(study.design.devices) if study.design is not None else 0
            return tried.static_efficiency >= efficiency, -cost, tried.static_efficiency

        taken = max(holds, key=merit, default=0)
        study, first = self.tried[taken]
        others = [tried for k, (_, tried) in enumerate(self.tried) if k != taken]
        return replace(
            study,
            trials=(first, *others),
            in_vain=tuple(self.in_vain),
            partial=partial,
            left_in_trial=first.left,
        )


def search_chains(asked: AskedOrientation, cost_class: CostClass) -> Iterator[ToolingStudy]:
    """Yield the studies with chains of a class that the search of a design finds clean in short trials.

    Parameters
    ----------
    asked : AskedOrientation
    cost_class : CostClass

    Yields
    ------
    ToolingStudy
        None where the bowl does not convey, or the part does not fit.
    """
    try:
        for search in asked.searches(cost_class):
            for candidate in exploring.candidates(search, cost_class.number):
                found = _study_of(asked.study, candidate)
                if found is not None and found.design is not None and has_margin(found, found.design):
                    yield found
    except FeederError:  # the static rule has said so
        return


def has_margin(study: ToolingStudy, design: Design) -> bool:
    """Tell whether a chain that the trial finds clean has the margin that a study asks for.

    The usual one is what the search of a design begins with: by how much a trial has then moved a value, the
    margins of the cuts say. More than that is asked of the static rule as well.

    Parameters
    ----------
    study : ToolingStudy
    design : Design

    Returns
    -------
    bool
    """
    usual = study.margin <= min(proposals.MARGINS) + SLIGHT
    return usual or not design.margin < study.margin - SLIGHT


def _may_isolate(design: Design | None, cost_class: CostClass) -> bool:
    """Whether the static rule has a chain of a class, or a cheaper one, that is worth a trial."""
    if design is None or not design.devices or not design.efficiency > 0.0:
        return False
    return design.isolated and cost_class_of(design.devices) <= cost_class.number


def _search_on(asked: AskedOrientation, *, only_hanging: bool = False) -> Search:
    """The search of a design on the bowl of a study, for the orientation that is asked for.

    Or for parts of its aspect that hang from other headings.
    """
    study = asked.study
    own = study.orientations[study.wanted or 0]
    request = DesignRequest(
        target=ANY_RATE,
        aspect=own.aspect,
        heading=None if only_hanging else own.heading,
        up=study.up,
        outcome=OutcomeKind.HANGING if only_hanging else asked.outcome,
        without=(*asked.without, *names(lambda kind: kind.action.turns)),
        rule=study.rule,
        budget=SEARCH_TRIALS,
        draws=0,
        seed=asked.run.seed,
        jobs=asked.run.jobs,
    )

    def tell(_: str) -> None:
        if time.monotonic() > asked.until:
            search.state.most_trials = 0

    search = Search.begin(
        study.part,
        request,
        study.bowl,
        OWN_KEYS,
        shares=Shares(study.aspects),
        progress=SearchProgress(before=asked.run.before, tell=tell),
        policy=POLICY,
    )
    banks: tuple[float, ...] = (study.bowl.track.bank,)
    if not (banks[0] > 0.0 or "track.bank" in asked.kept_keys or study.bowl.devices):
        likely = exploring.likely_banks(study.aspects, study.rule, POLICY)
        banks = tuple(dict.fromkeys((*likely, *banks)))
    for number, bank in enumerate(banks):
        bare = replace(study.bowl, track=replace(study.bowl.track, bank=bank), devices=())
        plain_bowl = calm_drive.PlainBowl(bare, frozenset(OWN_KEYS))
        start = replace(bare, devices=study.bowl.devices)
        orientations, weights = exploring.weigh_orientations(search, start)
        rows = proposals.promising_rows(orientations, weights, request)
        if only_hanging:
            lying = orientations.lying
            rows = [k for k in hanging.head_rows(lying, weights, rows) if lying[k].name != own.name]
        rank = search.policy.bank_rank**number
        search.state.tracks.append(TrackAtBank(plain_bowl, orientations, weights, rows, rank))
    return search


def _study_of(study: ToolingStudy, candidate: Candidate) -> ToolingStudy | None:
    """The study with the chain of a candidate on its own bank; None where the orientation is none there."""
    bank = candidate.bowl.track.bank
    on_bank = study.on_bank(bank)
    name = candidate.orientations.lying[candidate.proposal.row].name
    places = [k for k, one in enumerate(on_bank.orientations) if one.name == name]
    if not places:
        return None
    task = static.design_task(
        on_bank.orientations,
        on_bank.shares,
        places[0],
        study.margin,
        1.0,
        study.bowl.devices,
        constraints=DesignConstraints(up=study.up),
    )
    cuts, trial = candidate.proposal.cuts, candidate.trial
    rejecting = [static.margins_at(cut.device, on_bank.orientations) <= -study.margin for cut in cuts]
    is_returned = np.any([~task.stays, *rejecting], axis=0)
    rows = {one.name: k for k, one in enumerate(on_bank.orientations)}
    shown = {candidate.orientations.lying[k].name: n for n, k in enumerate(trial.rows.tolist())}
    same = task.same.copy()
    for name, n in shown.items():  # what the trial shows stands above the rule
        if name not in rows:
            continue
        is_returned[rows[name]] = not (trial.right[n] or trial.wrong[n] or trial.held[n])
        same[rows[name]] |= candidate.proposal.hangs and 2 * trial.right[n] > trial.parts[n]
    design = static.propose(task, cuts, is_returned, same)
    if bank != study.bowl.track.bank:
        design = replace(design, bank=bank)
    designs: list[Design | None] = [None] * len(on_bank.orientations)
    designs[places[0]] = design
    return replace(on_bank, designs=tuple(designs), wanted=places[0])


def _ways_on(excluded_kinds: tuple[str, ...], design: Design) -> list[tuple[str, ...]]:
    """Kinds of devices to do without as well: each of a chain alone, the last one first, then all of them."""
    kinds = list(dict.fromkeys(cut.device.kind for cut in reversed(design.cuts)))
    kinds = [kind for kind in kinds if kind not in KEPT]
    choices = [(kind,) for kind in kinds] + ([tuple(kinds)] if len(kinds) > 1 else [])
    return [(*excluded_kinds, *more) for more in choices]


def _devices(design: Design) -> tuple[str, ...]:
    return tuple(f"{device.kind}: {device.text}" for device in design.devices)


def _try_design(study: ToolingStudy, design: Design, run: RunSettings) -> TriedDesign:
    """One design with parts of its own, on a track of its own width."""
    study = study.on_its_width(design.wanted)
    bowl = replace(study.bowl, devices=design.devices)
    oriented = stream.along(study.orientations, study.aspects, bowl.devices, bowl=bowl)
    name, total = oriented.lying[design.wanted].name, study.shares.sum()
    shares = study.shares / total if total > 0.0 else np.full(len(study.shares), 1.0 / len(study.shares))
    # those that come often, and of the others those that may leave
    order = np.argsort(-shares, kind="stable")
    often = [k for k in order if shares[k] >= SELDOM_SHARE or k == design.wanted]
    may = (oriented.may_leave > 0.0) & (shares >= RARE_SHARE * shares[design.wanted]) & (shares > 0.0)
    seldom = [k for k in order if may[k] and k not in often]
    rows = [int(k) for k in (*often, *seldom[:FURTHER])]
    wanted = (design.wanted, *equivalent_rows(oriented.lying, design.wanted, study.up))
    free = aspects_at_any_heading(oriented.lying, design.wanted, study.up)
    single = functools.partial(
        short_trials.try_parts,
        study.part,
        bowl,
        oriented,
        shares,
        wanted,
        aspects=study.aspects,
        any_heading=free,
    )
    try:
        require_room(bowl, oriented.lying)  # its queues have to follow
        trial = single(rows=rows, count=PARTS_OF_EACH, run=run)
        further = further_parts(shares[rows])
        if not list(find_denials(trial)) and further.any():
            further_run = replace(run, seed=run.seed + 1, before=None)
            more = [row for row, count in zip(rows, further) if count]
            trial = trial.join(single(rows=more, count=further[further > 0], run=further_run))
    except FeederError as fault:  # the bowl does not convey, or is too small
        return TriedDesign(
            name,
            design.wanted,
            _devices(design),
            design.efficiency,
            0.0,
            np.nan,
            0,
            (Fault(FaultKind.NOT_RUN, reason=fault.what),),
        )
    efficiency, (value, low, high) = shares_leaving(trial)
    faults = [*find_denials(trial)]
    if value < design.least_purity:
        faults.append(Fault(FaultKind.IMPURE, shares=(value, low, high, design.least_purity)))
    return TriedDesign(
        name=name,
        wanted=design.wanted,
        devices=_devices(design),
        static_efficiency=design.efficiency,
        efficiency=efficiency[0],
        purity=value,
        parts=int(trial.parts.sum()),
        faults=tuple(faults),
        efficiency_ends=efficiency[1:],
        purity_ends=(low, high),
        devices_words=tuple(f"{device.full_name}: {device.value_words}" for device in design.devices),
        left=trial.left,
    )


def further_parts(shares: Floats) -> Ints:
    """Return how many of MORE_PARTS are of each orientation, as the interval of a sum of shares asks for.

    Its width is the root of the sum of the squares of share times proportion's interval, which is least where
    parts go with the shares, for even spreads.

    Parameters
    ----------
    shares : (R,) float [1]

    Returns
    -------
    (R,) int

    References
    ----------
    J. Neyman, J. R. Statist. Soc. 97, 558-625, 1934.
    """
    total = float(shares.sum())
    return (
        np.floor(MORE_PARTS * shares / total + 0.5).astype(int) if total > 0.0 else np.zeros(len(shares), int)
    )


def shares_leaving(
    trial: short_trials.ShortTrial,
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return efficiency and purity of a short trial, shares of all parts offered, with 95 % intervals.

    What was not tried counts as the static rule says; what that is not sure to return, as wrong at the lower
    end.

    Parameters
    ----------
    trial : ShortTrial

    Returns
    -------
    efficiency, purity : (float, float, float) [1]
        Value, low and high end; the purity is NaN where nothing leaves.

    References
    ----------
    G. Y. Zou, A. Donner, Statist. Med. 27, 1693-1702, 2008, for the sums of shares.
    """
    orientations, shares = trial.orientations, trial.shares / max(trial.shares.sum(), 1e-300)
    rest = np.setdiff1d(np.arange(len(shares)), trial.rows)
    as_ruled = orientations.leaving[rest][:, list(trial.states)].sum(axis=1) * (
        orientations.leaves[rest] > 0.0
    )
    right = _sum_shares(shares[trial.rows], trial.right, trial.parts)
    wrong = _sum_shares(shares[trial.rows], trial.wrong, trial.parts)
    more = float((shares[rest] * as_ruled).sum())
    other = float((shares[rest] * np.maximum(orientations.leaves[rest] - as_ruled, 0.0)).sum())
    doubt = float((shares[rest] * np.maximum(orientations.may_leave[rest] - as_ruled, 0.0)).sum())
    efficiency = right[0] + more, right[1], min(right[2] + more, 1.0)
    against = wrong[0] + other, wrong[1], wrong[2] + doubt
    if not efficiency[0] + against[0] > 0.0:
        return efficiency, (np.nan, 0.0, 1.0)
    pure = [a / (a + b) if a > 0.0 else 0.0 for a, b in zip(efficiency, (against[0], against[2], against[1]))]
    return efficiency, (pure[0], pure[1], pure[2])


def _sum_shares(shares: Floats, counts: Ints, parts: Ints) -> tuple[float, float, float]:
    """The sum of shares [1] times proportions, with its 95 % interval."""
    ends = [wilson([count], total) for count, total in zip(counts, parts, strict=True)]
    low, high = (np.array([float(end[k][0]) for end in ends]) for k in range(2))
    value = counts / np.maximum(parts, 1)
    total = float((shares * value).sum())
    down, up = (float(np.sqrt(((shares * off) ** 2).sum())) for off in (value - low, high - value))
    return total, max(total - down, 0.0), min(total + up, 1.0)


TRIED_COLUMNS: tuple[Column[TriedDesign], ...] = (  # of the document: a row a design that was tried
    Column("orientation", lambda design: design.name),
    Column("devices", lambda design: list(design.devices)),
    Column("efficiency_static", lambda design: design.static_efficiency, "share"),
    Column("efficiency_tried", lambda design: design.efficiency, "share"),
    Column("efficiency_low", lambda design: design.efficiency_ends[0], "share"),
    Column("efficiency_high", lambda design: design.efficiency_ends[1], "share"),
    Column("purity_tried", lambda design: None if np.isnan(design.purity) else design.purity, "share"),
    Column("purity_low", lambda design: design.purity_ends[0], "share"),
    Column("purity_high", lambda design: design.purity_ends[1], "share"),
    Column("parts", lambda design: design.parts),
    Column("sorts", lambda design: not design.faults),
    Column("agrees", lambda design: design.agrees),
    Column("denied", lambda design: texts.fault_texts(design.faults)),
)
