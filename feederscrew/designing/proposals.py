"""Chains to be tried for an orientation, and how a value is moved that a trial denies."""

import functools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.geometry import vectors
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.kinds import KINDS, CostClass, cost_class, dearer, leaning, names, shaped
from feederscrew.bowl.devices.orientation_names import nearest
from feederscrew.bowl.devices.orientation_names import rows as rows_of
from feederscrew.bowl.devices.pneumatics import PULSE
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.designing import short_trials
from feederscrew.designing.findings import Fault, FaultKind, Move, MoveKind
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.short_trials import ShortTrial
from feederscrew.feeding import stream
from feederscrew.feeding.stream import Orientations
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.isolating.chain import (
    DESIGN_KEY,
    Cut,
    OutcomeKind,
    judge_cut,
    limits,
    numeric_kinds,
    plain_cut,
)
from feederscrew.sorting.isolating.rails import RAIL, RailSetting, find_head
from feederscrew.sorting.orientations import SAME_HEAD_COSINE, Hanging, Orientation, neck
from feederscrew.sorting.tooling import ToolingSearch, tooling
from feederscrew.sorting.verdicts import DeviceEncounter
from feederscrew.trials.fills import LeavingCounts, PoseKind
from feederscrew.trials.wanted import aspects_at_any_heading, equivalent_rows, wanted_rows, wanted_states

PROPOSED_ROWS = 6  # orientations for which chains are proposed, the most frequent first
# holes of several corners, which a shop's tolerance soon spoils
HOLES = shaped()
# a sensor and air are left out
TOUCHING_KINDS = tuple(
    sorted(names(lambda kind: kind.search.is_proposed and kind.action is not Action.SENSE))
)
CLASSES = tuple(CostClass)
COST_CLASSES = tuple(one.number for one in CLASSES)  # steel alone, steady air, a sensor with a valve
AIR, SENSED = COST_CLASSES[1:]
MARGINS = (5e-4, 2.5e-4)  # [m] to either side
SWEEPS = (35, 20, 45, 30, 55)  # [deg] of a blade's face, in the order in which they are tried
RARE_ORIENTATION = 0.2  # [1] share below which an orientation is worth a device that turns others into it
ENOUGH_PURITY = 0.985  # purity at which a chain is not made longer
# a bank is the bowl's own, and tried by the loop
ON_THE_TRACK = names(lambda kind: kind.action is Action.BANK)
VERDICTS = 3000  # of the search for holes: values that a shop's tolerance does not lose are found early
LEAST_WINDOW = 1e-3  # [m] between what passes such a drop and what it rejects
VALUE_STEP_M = 5e-5  # [m] to which a shop makes a value
SLOT_WIDENING, WIDEST_SLOT = 0.35, 0.8  # of head less slot; of the head, that a slot may be
PULSE_STEP_S, SHORTEST_PULSE_STEPS = 5e-3, 4  # [s] to which a pulse is set; steps of the shortest one
PULSE_RESERVE = 6.0  # times what blows off a part before the nozzles: they do not blow at its middle
STEEPER_SPACING = 5.0 / 3.0  # times as steep, a spacing section on which a full track lets others pass
LONGER_PULSE = 2.0  # times, where something is carried through all the same


@dataclass(frozen=True)
class Recipe:
    """A way of proposing a chain for an orientation."""

    cost_class: int
    margin: float  # [m] to either side
    outcome: OutcomeKind  # how parts leave
    excluded_kinds: tuple[str, ...]  # kinds of devices that are left out
    turns: bool = False  # whether a device that turns others into the orientation may come first

    @property
    def holes(self) -> bool:
        """Tell whether holes of several corners may be used."""
        return not set(HOLES) <= set(self.excluded_kinds)


def recipes_of(cost_class: int, request: DesignRequest) -> list[Recipe]:
    """Return the ways of proposing chains of a cost class, the most robust first.

    Parameters
    ----------
    cost_class : int
    request : DesignRequest

    Returns
    -------
    list of Recipe
        Of a sensor alone, and of one with devices that parts meet; empty for a class of which no kind of
        device may be used.
    """
    left_out = (*dearer(cost_class), *request.without)

    def is_tried(kind: type[Device]) -> bool:
        return kind.search.is_proposed and kind.trade.cost_class == cost_class

    if not set(names(is_tried)) - set(left_out):
        return []
    both = (OutcomeKind.HANGING, OutcomeKind.LYING)
    outcomes = both if request.outcome is OutcomeKind.ANY else (request.outcome,)
    kinds = [(*left_out, *HOLES), *([(*left_out, *TOUCHING_KINDS, *HOLES)] if cost_class == SENSED else [])]
    recipes = [
        Recipe(cost_class, margin, outcome, some)
        for margin in MARGINS
        for outcome in outcomes
        for some in kinds
    ]
    if OutcomeKind.LYING in outcomes:
        lying = [
            recipe
            for recipe in recipes
            if recipe.outcome == OutcomeKind.LYING and recipe.excluded_kinds == kinds[0]
        ]
        recipes += [replace(recipe, turns=True) for recipe in lying]
        if cost_class == COST_CLASSES[0]:
            recipes.append(Recipe(cost_class, MARGINS[-1], OutcomeKind.LYING, left_out))
    return recipes


@dataclass(frozen=True, eq=False)
class Proposal:
    """An orientation with a chain that isolates it, as the static rule says."""

    row: int
    cuts: tuple[Cut, ...]
    before: tuple[Device, ...]
    move: Move  # why it is tried
    equivalents: tuple[int, ...] = ()  # rows that count as it
    any_heading: tuple[str, ...] = ()  # names of aspects that count as it, whatever the heading
    purity: float = 1.0  # [1] by the static rule, midway between what is sure and what may be
    margin: float = np.inf  # [m] the least, of passing and of returning
    sweeps: tuple[int, ...] = ()  # [deg] of a blade, those that were tried
    rails: RailSetting | None = None  # values of its rails, where trials search them
    shown_gain: float | None = None  # [1] share that left as wanted in a trial of rails like these

    @property
    def cost_class(self) -> int:
        """Return its cost class: 1 steel alone, 2 steady air, 3 a sensor with a valve."""
        return cost_class(self.devices)

    @property
    def devices(self) -> tuple[Device, ...]:
        """Every device along the track."""
        return (*self.before, *(cut.device for cut in self.cuts))

    @property
    def rows(self) -> tuple[int, ...]:
        """The wanted row, and those that count as it."""
        return (self.row, *self.equivalents)

    def states(self, orientations: Orientations) -> tuple[int, ...]:
        """Return the states in which what is wanted leaves, its own first.

        Parameters
        ----------
        orientations : Orientations

        Returns
        -------
        tuple of int
        """
        return wanted_states(orientations, self.rows)

    def wanted_name(self, orientations: Orientations) -> str:
        """Return what leaves by name: 'A@188'; 'A' of an aspect that counts at any heading; 'hanging'.

        Parameters
        ----------
        orientations : Orientations

        Returns
        -------
        str
        """
        state = orientations.states[orientations.leaves_as[self.row]]
        free = not isinstance(state, Hanging) and state.aspect in self.any_heading
        return state.aspect if free else state.name

    @property
    def hangs(self) -> bool:
        """Tell whether parts leave hanging."""
        return any(cut.device.action is Action.HANG for cut in self.cuts)

    @property
    def chain(self) -> tuple[str, ...]:
        """The devices as a bowl file has them."""
        return tuple(f"{device.kind}: {device.text}" for device in self.devices)

    @property
    def sentence(self) -> str:
        """The devices in a sentence, headings in whole degrees."""
        return ", ".join(f"{device.kind}: {device.short}" for device in self.devices) or "no device"

    def with_cut(self, place: int, cut: Cut, move: Move) -> "Proposal":
        """Return the proposal with another cut at a place of its chain.

        Parameters
        ----------
        place : int
            In the chain, from 0.
        cut : Cut
        move : Move
            What is changed by it.

        Returns
        -------
        Proposal
        """
        return replace(self, cuts=(*self.cuts[:place], cut, *self.cuts[place + 1 :]), move=move)


def find_equivalents(
    orientations: Sequence[Orientation], row: int, request: DesignRequest
) -> tuple[tuple[int, ...], tuple[str, ...]]:
    """Return the rows that count as a wanted one beside it, and the aspects that do so at any heading.

    Parameters
    ----------
    orientations : sequence of Orientation
    row : int
        The wanted one.
    request : DesignRequest

    Returns
    -------
    rows : tuple of int
    aspects : tuple of str
    """
    one_heading = request.heading is not None
    free = aspects_at_any_heading(orientations, row, request.up, heading_given=one_heading)
    return equivalent_rows(orientations, row, request.up), free


def _fold_case(texts: Iterable[str]) -> set[str]:
    return {name.strip().casefold() for name in texts}


def promising_rows(orientations: Orientations, shares: Floats, request: DesignRequest) -> list[int]:
    """Return rows of the orientations worth a try: those asked for, the most frequent first.

    Parameters
    ----------
    orientations : Orientations
        M of them.
    shares : (M,) float [1]
        In which they come.
    request : DesignRequest

    Returns
    -------
    list of int
    """
    rows = [k for k in short_trials.frequent_rows(shares) if not orientations.lying[k].returned]
    named = _fold_case([request.aspect] if request.aspect is not None else request.up)
    if named:
        requested = [k for k, one in enumerate(orientations.lying) if one.aspect.casefold() in named]
        rows = [k for k in rows if k in requested] or (requested if request.aspect is not None else [])
    if request.heading is None or request.aspect is None:
        return rows
    solid = orientations.lying[0].posture.solid
    rows_of(orientations.aspects, request.aspect, "" if solid is None else solid.source)
    return [nearest(orientations.aspects, orientations.headings, request.aspect, request.heading)]


def propose_no_device(
    orientations: Orientations, shares: Floats, request: DesignRequest, devices: Iterable[Device]
) -> Proposal | None:
    """Return the proposal of no further device, where nearly all that comes is one way up.

    Parameters
    ----------
    orientations : Orientations
        M of them.
    shares : (M,) float [1]
        In which they come.
    request : DesignRequest
    devices : iterable of Device
        Of the user.

    Returns
    -------
    Proposal or None
        None elsewhere.
    """
    rows = promising_rows(orientations, shares, request)
    if not rows or request.outcome == OutcomeKind.HANGING:
        return None
    leaving = (shares[:, None] * orientations.leaving).sum(axis=0)
    best = max(rows, key=lambda k: leaving[orientations.leaves_as[k]])
    own = find_equivalents(orientations.lying, best, request)
    proposal = Proposal(best, (), tuple(devices), Move(MoveKind.NO_DEVICE), *own)
    pure = short_trials.gain(orientations, shares, proposal.states(orientations)) / max(leaving.sum(), 1e-300)
    return proposal if pure >= ENOUGH_PURITY else None


def propose_chain(
    part: Part,
    bowl: Bowl,
    aspects: Aspects,
    row: int,
    orientations: Orientations,
    request: DesignRequest,
    recipe: Recipe,
) -> Proposal | None:
    """Return the static rule's chain for a row. What would stand at a device is returned before it by a drop.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With the devices of the user.
    aspects : Aspects
    row : int
        Of the orientations, the wanted one.
    orientations : Orientations
    request : DesignRequest
    recipe : Recipe

    Returns
    -------
    Proposal or None
        None where it isolates nothing or is not what was asked.
    """
    lying = orientations.lying
    without = tuple(dict.fromkeys((*request.without, *recipe.excluded_kinds, *ON_THE_TRACK)))
    static_design = tooling(
        part,
        bowl,
        lying[row].aspect,
        heading=lying[row].heading,
        margin=recipe.margin,
        aspect_shares=aspects,
        outcome=recipe.outcome,
        without=without,
        cost_class=CLASSES[recipe.cost_class - 1],
        purity=ENOUGH_PURITY,
        up=request.up,
        play=0.0,
        tolerance=0.0,  # draws and the loop have them
        search=ToolingSearch(
            rule=request.rule, turn=recipe.turns, vary=False, seed=request.seed, verdicts=VERDICTS
        ),
    ).design
    if static_design is None or not static_design.efficiency > 0.0:
        return None
    hopeful = static_design.hopeful or 0.0
    if (not static_design.isolated and hopeful < ENOUGH_PURITY) or not static_design.devices:
        return None
    cuts = tuple(shorten_pulse(round_cut(cut, lying, row), lying) for cut in static_design.cuts)
    pure = 0.5 * (float(np.nan_to_num(static_design.purity)) + hopeful)
    proposal = Proposal(
        row,
        cuts,
        tuple(static_design.before),
        Move(MoveKind.PROPOSED, recipe.margin),
        *find_equivalents(lying, row, request),
        pure,
        static_design.margin,
    )
    if static_design.isolated:
        return proposal
    # a drop before what stops some orientations; none where no drop tells them
    through = follow_orientations(part, aspects, replace(bowl, devices=proposal.devices))
    often = np.nan_to_num(through.rules[request.rule]) >= short_trials.SELDOM_SHARE
    stops = (through.stops.sum(axis=1) > 0.0) & often
    if not stops.any():
        return proposal
    wanted = wanted_rows(through, proposal.states(through))
    return add_drop(proposal, list(np.flatnonzero(stops)), wanted, through.lying)


def round_cut(cut: Cut, orientations: Sequence[Orientation], row: int) -> Cut:
    """Return a cut whose value a shop can make, where that keeps what it returns.

    Parameters
    ----------
    cut : Cut
    orientations : sequence of Orientation
    row : int
        The wanted one.

    Returns
    -------
    Cut
    """
    return move_cut(cut, cut.device.limit, orientations, row) if np.isfinite(cut.device.limit) else cut


def move_cut(cut: Cut, limit: float, orientations: Sequence[Orientation], row: int) -> Cut:
    """Return a cut of one number at another value, in steps of a shop, with its margins there.

    Parameters
    ----------
    cut : Cut
    limit : float [m]
    orientations : sequence of Orientation
    row : int
        The wanted one.

    Returns
    -------
    Cut
    """
    device = cut.device.valued(float(np.round(limit / VALUE_STEP_M) * VALUE_STEP_M))
    return _judge(cut, device, orientations, row)


def _judge(cut: Cut, device: Device, orientations: Sequence[Orientation], row: int, ends: Any = None) -> Cut:
    """A cut with another device that shall return the same orientations."""
    must = np.array([orientation.name in cut.returns for orientation in orientations])
    return judge_cut(orientations, row, device, must, *(ends or (cut.smallest, cut.largest)))


def _mend_cut(proposal: Proposal, trial: ShortTrial, orientations: Sequence[Orientation]) -> Proposal | None:
    """The proposal with the value moved that its trial denies; None where none can be moved.

    What is lost though wanted moves its device towards the least cut; what leaves though rejected moves the
    device that should have returned it towards the greatest.
    """
    for place, cut in enumerate(proposal.cuts):
        lost = lost_at(trial, cut.device.kind)
        if lost == _slips(cut, trial, orientations):
            continue
        if not cut.device.search.bound:
            eased = -0.25 * (cut.margin_reject - MARGINS[-1])
            by = eased if lost else 0.5 * (cut.margin_pass - MARGINS[-1])
            moved = _moved_by(proposal, place, by, orientations)
            if moved is not None:
                return moved
            continue
        limit = 0.5 * (cut.device.limit + (cut.smallest if lost else cut.largest).limit)
        if not np.isfinite(limit) or abs(limit - cut.device.limit) < VALUE_STEP_M:
            continue
        other = move_cut(cut, limit, orientations, proposal.row)
        if other.device.limit != cut.device.limit and other.margin_pass > 0.0:
            return proposal.with_cut(place, other, _move_of(MoveKind.VALUE, other.device))
    return None


def ease_cut(proposal: Proposal, place: int, orientations: Sequence[Orientation]) -> Proposal | None:
    """Return the proposal with a device at which what is wanted stands moved half the way to its least cut.

    Parameters
    ----------
    proposal : Proposal
    place : int
        Of the device along what stands on the track, from 1.
    orientations : sequence of Orientation

    Returns
    -------
    Proposal or None
        None where another made the device, its value cannot be moved, or it would return no less.
    """
    found = _own_cut(proposal, place)
    if found is None:
        return None
    number, cut = found
    if not cut.device.search.bound:
        return _moved_by(proposal, number, -0.25 * (cut.margin_reject - MARGINS[-1]), orientations)
    limit = 0.5 * (cut.device.limit + cut.smallest.limit)
    if not np.isfinite(limit) or abs(limit - cut.device.limit) < VALUE_STEP_M:
        return None
    other = move_cut(cut, limit, orientations, proposal.row)
    if other.device.limit == cut.device.limit:
        return None
    return proposal.with_cut(number, other, _move_of(MoveKind.VALUE, other.device))


def relax_device(
    proposal: Proposal, place: int, trial: ShortTrial, orientations: Sequence[Orientation]
) -> Proposal | None:
    """Return the proposal with one device changed so that it returns fewer wanted parts.

    A cut moves half the way to its least one. A pressure break leaves more of the track, by the least margin.

    Parameters
    ----------
    proposal : Proposal
    place : int
        Of the device along what stands on the track, from 1; 0 of the bare track.
    trial : ShortTrial
        Of the proposal: its wanted orientations have to reach over a pressure break.
    orientations : sequence of Orientation

    Returns
    -------
    Proposal or None
        None where another made the device, or it cannot return fewer.
    """
    found = _own_cut(proposal, place)
    if found is None:
        return None
    number, cut = found
    if cut.device.action is not Action.RELIEVE:
        return ease_cut(proposal, place, orientations)
    other = cut.device.valued(cut.device.limit + MARGINS[-1]).rewritten()
    # what backs up leaves where it reaches over the ledge
    if other.limit > min((orientations[k].width for k in trial.wanted), default=0.0) - MARGINS[-1]:
        return None
    changed = judge_cut(orientations, proposal.row, other, np.zeros(len(orientations), bool), other, other)
    return proposal.with_cut(number, changed, _move_of(MoveKind.VALUE, other))


def _own_cut(proposal: Proposal, place: int) -> tuple[int, Cut] | None:
    """The number and the cut of a proposal at a place along what stands on the track; None of another's."""
    placed = [device for device in proposal.devices if device.action.has_place]
    if not 0 < place <= len(placed):
        return None
    return next(((n, cut) for n, cut in enumerate(proposal.cuts) if cut.device is placed[place - 1]), None)


def _slips(cut: Cut, trial: ShortTrial, orientations: Sequence[Orientation]) -> bool:
    """Tell whether something left otherwise that a cut should have returned."""
    return any(trial.wrong[n] and orientations[k].name in cut.returns for n, k in enumerate(trial.rows))


def sweep_blade(
    proposal: Proposal, trial: ShortTrial, orientations: Sequence[Orientation]
) -> Proposal | None:
    """Return the proposal with another sweep of a blade at which parts stay.

    Parameters
    ----------
    proposal : Proposal
    trial : ShortTrial
        Of the proposal.
    orientations : sequence of Orientation

    Returns
    -------
    Proposal or None
        None where none is left.
    """
    stays_at = {end.kind for n in range(len(trial.rows)) if trial.held[n] for end in trial.ends[n]}
    for place, cut in enumerate(proposal.cuts):
        device: Any = cut.device  # a blade, where it is overhead
        is_blade = device.action in (Action.OVERHEAD, Action.PUSH)
        if not is_blade or not device.face or device.kind not in stays_at:
            continue
        used = proposal.sweeps or (round(np.degrees(device.sweep)),)
        grip = orientations[proposal.row].grip
        angles = [angle for angle in SWEEPS if angle not in used]
        blades = [replace(device, sweep=np.radians(angle)).rewritten() for angle in angles]
        other = next((blade for blade in blades if blade.clear_of(grip)), None)
        if other is None:
            continue
        both: list[Any] = [cut.smallest, cut.largest]
        ends = [replace(end, sweep=other.sweep).rewritten() for end in both]
        changed = _judge(cut, other, orientations, proposal.row, ends)
        swept_proposal = proposal.with_cut(place, changed, _move_of(MoveKind.SWEEP, device, other.sweep))
        return replace(swept_proposal, sweeps=(*used, round(np.degrees(other.sweep))))
    return None


def mend_proposal(
    proposal: Proposal,
    trial: ShortTrial,
    orientations: Sequence[Orientation],
    worst: Fault | None = None,
) -> Proposal | None:
    """Return the proposal changed where its trial, or draws, deny it.

    Parameters
    ----------
    proposal : Proposal
    trial : ShortTrial
        Of the proposal.
    orientations : sequence of Orientation
    worst : Fault, optional
        That draws show most often, and that deny what the trial itself does not.

    Returns
    -------
    Proposal or None
        None where nothing is left to change.
    """
    if worst is not None:
        match worst.kind:
            case FaultKind.LOST:
                returned_at = dict.fromkeys(end.station for end in worst.ends if end.came_back)
                eased = (relax_device(proposal, place, trial, orientations) for place in returned_at)
                return next(filter(None, eased), None) or _widen_slot(proposal, orientations)
            case FaultKind.CARRIED:
                return _cut_more(proposal, trial, worst.row, orientations)
        return None
    changed = _widen_slot(proposal, orientations) if trial.loses_wanted else None
    changed = (
        changed or sweep_blade(proposal, trial, orientations) or _mend_cut(proposal, trial, orientations)
    )
    changed = changed or lengthen_pulse(proposal, trial, orientations)
    if changed is not None:
        return changed
    # devices through which what they reject falls: a queue hardly notices them
    wanted = trial.wanted
    wrong = [k for n, k in enumerate(trial.rows) if (trial.wrong[n] or trial.held[n]) and k not in wanted]
    return add_drop(proposal, wrong, wanted, orientations)


def _move_of(kind: MoveKind, device: Device, value: float = 0.0) -> Move:
    """A move by which a device has changed, or is added."""
    return Move(kind, value, device.kind, device.text)


def _cut_more(
    proposal: Proposal, trial: ShortTrial, row: int, orientations: Sequence[Orientation]
) -> Proposal | None:
    """The proposal that cuts more of an orientation that is carried through; None where nothing does."""
    name = orientations[row].name
    for place, cut in enumerate(proposal.cuts):
        if name in cut.returns and not cut.device.search.bound:
            moved = _moved_by(proposal, place, 0.5 * (cut.margin_pass - MARGINS[-1]), orientations)
            if moved is not None:
                return moved
        if not cut.device.search.bound or name not in cut.returns or not np.isfinite(cut.largest.limit):
            continue
        other = move_cut(cut, 0.5 * (cut.device.limit + cut.largest.limit), orientations, proposal.row)
        if abs(other.device.limit - cut.device.limit) >= VALUE_STEP_M and other.margin_pass > 0.0:
            return proposal.with_cut(place, other, _move_of(MoveKind.VALUE, other.device))
    wanted = trial.wanted
    return add_drop(proposal, [row] if row not in wanted else [], wanted, orientations)


def _moved_by(
    proposal: Proposal, place: int, by: float, orientations: Sequence[Orientation]
) -> Proposal | None:
    """The proposal with a device of several values moved by a length [m]: to return more, below 0 less."""
    cut = proposal.cuts[place]
    other = cut.device.cutting_more(by) if abs(by) >= VALUE_STEP_M else None
    if other is None:  # of a kind that is not moved so, or by nothing
        return None
    changed = _judge(cut, other, orientations, proposal.row, (other, other))
    if not changed.margin_pass > 0.0:
        return None
    return proposal.with_cut(place, changed, _move_of(MoveKind.VALUE, other))


def purify(candidate: Any, left_instead: LeavingCounts) -> Iterator[Proposal]:
    """Yield proposals of a candidate that cut more of what left queues instead of what is wanted.

    Parameters
    ----------
    candidate : Candidate
    left_instead : LeavingCounts
        Poses in which parts left, the most frequent first.

    Yields
    ------
    Proposal
        What does for the most frequent one comes first, then drops of each other kind before the chain: one
        that drops one part may stop another.
    """
    proposal, trial, lying = candidate.proposal, candidate.trial, candidate.orientations.lying
    rows = {orientation.name: row for row, orientation in enumerate(lying)}
    names_left = [pose.name for pose, _ in left_instead if pose.kind is PoseKind.ORIENTATION]
    wrong = [rows[name] for name in names_left if name in rows and rows[name] not in trial.wanted]
    kinds: list[str] = []  # of drops that came
    for row in wrong:
        changed = _cut_more(proposal, trial, row, lying)
        if changed is None:
            continue
        if len(changed.cuts) > len(proposal.cuts):
            if changed.cuts[0].device.kind in kinds:
                continue
            kinds.append(changed.cuts[0].device.kind)
        yield changed
    while (dropped := add_drop(proposal, wrong, trial.wanted, lying, kinds)) is not None:
        kinds.append(dropped.cuts[0].device.kind)
        yield dropped


def add_pressure_break(candidate: Any) -> Proposal | None:
    """Return the proposal of a candidate with a pressure break before its devices, where parts back up.

    Parameters
    ----------
    candidate : Candidate

    Returns
    -------
    Proposal or None
        None where it has one, or a wanted orientation does not reach over any.
    """
    proposal, lying = candidate.proposal, candidate.orientations.lying
    if any(device.action is Action.RELIEVE for device in proposal.devices):
        return None
    wanted = [lying[k] for k in candidate.trial.wanted]
    makers = [KINDS[kind] for kind in names(lambda kind: kind.action is Action.RELIEVE)]
    breaks = [kind.relieving(wanted, MARGINS[-1], DESIGN_KEY) for kind in makers] if wanted else []
    device = next((device for device in breaks if device is not None), None)
    if device is None:
        return None
    cut = judge_cut(lying, proposal.row, device, np.zeros(len(lying), bool), device, device)
    return replace(proposal, cuts=(cut, *proposal.cuts), move=_move_of(MoveKind.PRESSURE_BREAK, device))


def add_second_sensor(candidate: Any) -> Proposal | None:
    """Return the proposal of a candidate whose sensor and valve stand there twice, one behind the other.

    Where few of the parts are wanted, a few in a thousand that a full track lets past one sensor are several
    in a hundred of what leaves. Past two they are as many in a million, if the second sensor misses
    independently of the first: parts in an attitude that neither tells apart pass both.

    Parameters
    ----------
    candidate : Candidate

    Returns
    -------
    Proposal or None
        None without a sensor of the design, and where it has two.
    """
    proposal: Proposal = candidate.proposal
    places = [place for place, cut in enumerate(proposal.cuts) if cut.device.action is Action.SENSE]
    if len(places) != 1:
        return None
    place = places[0] + 1
    second = proposal.cuts[places[0]]
    cuts = (*proposal.cuts[:place], second, *proposal.cuts[place:])
    return replace(proposal, cuts=cuts, move=_move_of(MoveKind.SECOND_SENSOR, second.device))


def spread_apart(candidate: Any, without: Sequence[str] = ()) -> Proposal | None:
    """Return the proposal of a candidate whose parts come farther apart, where a full track lets others pass.

    A chain without a spacing section gets one before its first device; one that leads down is made steeper,
    once. Behind it the parts are as many times as far apart as they travel faster.

    Parameters
    ----------
    candidate : Candidate
    without : sequence of str
        Kinds of devices that are not used.

    Returns
    -------
    Proposal or None
        None of a chain with rails, before which the track has to climb and parts close up again; of one
        without devices; and where the section is as steep as one is proposed.
    """
    proposal: Proposal = candidate.proposal
    if proposal.hangs or not proposal.cuts or any(device.action.leans for device in proposal.before):
        return None
    makers = [kind.parting(DESIGN_KEY) for kind in leaning() if kind.kind not in without]
    usual: Any = next((device for device in makers if device is not None), None)
    if usual is None:
        return None
    place = next((n for n, cut in enumerate(proposal.cuts) if cut.device.kind == usual.kind), None)
    if place is None:
        cuts = (plain_cut(usual), *proposal.cuts)
        return replace(proposal, cuts=cuts, move=_move_of(MoveKind.SPACING, usual))
    own: Any = proposal.cuts[place].device
    steeper = replace(own, angle=STEEPER_SPACING * usual.angle).rewritten()
    if not own.angle < 0.0 or own.angle <= steeper.angle:
        return None
    return proposal.with_cut(place, plain_cut(steeper), _move_of(MoveKind.SPACING, steeper))


def add_drop(
    proposal: Proposal,
    reject_rows: Sequence[int],
    wanted_rows: Sequence[int],
    orientations: Sequence[Orientation],
    excluded_kinds: Sequence[str] = (),
) -> Proposal | None:
    """Return the proposal with a drop before it, the one that tells most others from what is wanted.

    Parameters
    ----------
    proposal : Proposal
    reject_rows, wanted_rows : sequence of int
        Orientations to be dropped, and those that are to stay.
    orientations : sequence of Orientation
    excluded_kinds : sequence of str
        Kinds of drops that are not taken.

    Returns
    -------
    Proposal or None
        None where no drop tells any of them; what no drop tells is left to the trial.
    """
    if not reject_rows or not wanted_rows:
        return None
    best, chosen, own = (0, 0.0), None, {*excluded_kinds, *(cut.device.kind for cut in proposal.cuts)}
    for kind in (kind for kind in numeric_kinds() if kind.action.carries):
        sign = 1.0 if kind.search.bound == "lower" else -1.0
        # what no width of the track carries falls off as well from one that is as wide as the track
        values = sign * np.minimum(limits(kind, orientations), orientations[0].track.width)
        least = values[wanted_rows].min()
        listed = [k for k in reject_rows if least - values[k] > LEAST_WINDOW]
        room = least - max((values[k] for k in listed), default=np.inf)
        if listed and np.isfinite(room) and (len(listed), room) > best and kind.kind not in own:
            best, chosen = (len(listed), room), (kind, sign * (least - 0.5 * room), listed)
    if chosen is None:
        return None
    (kind, middle, listed), room = chosen, best[1]
    sign = 1.0 if kind.search.bound == "lower" else -1.0
    limit = float(np.round(middle / VALUE_STEP_M) * VALUE_STEP_M)
    device = kind.proposal(DESIGN_KEY, limit).rewritten()
    must = np.array([k in listed for k in range(len(orientations))])
    # the least cut that returns them first: of a narrowed track that is the widest one
    ends = [device.valued(limit + sign * half) for half in (-0.5 * room, 0.5 * room)]
    cut = judge_cut(orientations, proposal.row, device, must, *ends)
    return replace(proposal, cuts=(cut, *proposal.cuts), move=_move_of(MoveKind.DROP_BEFORE, device))


def replace_drop(
    proposal: Proposal,
    trial: ShortTrial,
    orientations: Sequence[Orientation],
    excluded_kinds: Sequence[str] = (),
) -> Proposal | None:
    """Return the proposal with a drop of another kind in place of its first one, which made no difference.

    Parameters
    ----------
    proposal : Proposal
        Whose first device was added as a drop before the others.
    trial : ShortTrial
        That shows what leaves or stays all the same.
    orientations : sequence of Orientation
    excluded_kinds : sequence of str
        Kinds of drops that made no difference before, beside the one that the proposal has.

    Returns
    -------
    Proposal or None
        None where no other drop tells what is left.
    """
    if proposal.move.kind is not MoveKind.DROP_BEFORE or not proposal.cuts:
        return None
    first, wanted = proposal.cuts[0].device.kind, trial.wanted
    left = [k for n, k in enumerate(trial.rows) if (trial.wrong[n] or trial.held[n]) and k not in wanted]
    without = replace(proposal, cuts=proposal.cuts[1:])
    return add_drop(without, left, wanted, orientations, (*excluded_kinds, first))


def lost_at(trial: ShortTrial, kind: str) -> bool:
    """Tell whether the wanted orientation ends at a device of a kind.

    Parameters
    ----------
    trial : ShortTrial
    kind : str

    Returns
    -------
    bool
    """
    return any(end.kind == kind for n in trial.wanted_places for end in trial.ends[n])


@functools.lru_cache(maxsize=16)
def follow_orientations(part: Part, aspects: Aspects, bowl: Bowl) -> Orientations:
    """Return what becomes of every orientation on the track and through the devices of a bowl.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    bowl : Bowl

    Returns
    -------
    Orientations
        Behind rails each that has the head of one that hangs is wanted hanging, also where the static rule
        says that it leaves lying over the slot.
    """
    ways = stream.follow_orientations(part, aspects, bowl.track, bowl.devices, bowl=bowl)
    hanging = [(k, state) for k, state in enumerate(ways.states) if isinstance(state, Hanging)]
    if not hanging:
        return ways
    leaves_as = ways.leaves_as.tolist()
    for row, orientation in enumerate(ways.lying):
        head = None if leaves_as[row] >= len(ways.lying) else find_head(orientation)
        if head is None:
            continue
        alike = (k for k, state in hanging if vectors.dot(head.down, state.neck.down) > SAME_HEAD_COSINE)
        leaves_as[row] = next(alike, leaves_as[row])
    return replace(ways, leaves_as=check.frozen(np.array(leaves_as)))


def shorten_pulse(cut: Cut, orientations: Sequence[Orientation]) -> Cut:
    """Return a cut whose pulse is the shortest that blows off what it returns, with a reserve.

    Parameters
    ----------
    cut : Cut
    orientations : sequence of Orientation

    Returns
    -------
    Cut
        The one given where its pulse is as short, or it has none.

    References
    ----------
    docs/design.md, "The loop".
    """
    device: Any = cut.device  # a vision reject, where it senses
    if device.action is not Action.SENSE:
        return cut
    encounters = [
        DeviceEncounter(orientation, orientations)
        for orientation in orientations
        if orientation.name in cut.returns
    ]
    pushes = [device.jet.push(encounter.orientation, orientations) for encounter in encounters]
    for steps in range(SHORTEST_PULSE_STEPS, round(device.time / PULSE_STEP_S)):
        time = steps * PULSE_STEP_S
        if all(
            encounter.blown(out, down, time / PULSE_RESERVE) > 0.0
            for encounter, (out, down) in zip(encounters, pushes)
        ):
            return replace(cut, device=device.with_pulse(time))
    return cut


def lengthen_pulse(
    proposal: Proposal, trial: ShortTrial, orientations: Sequence[Orientation]
) -> Proposal | None:
    """Return a proposal with a longer pulse where something is carried through that it should blow off.

    Parameters
    ----------
    proposal : Proposal
    trial : ShortTrial
        Of the proposal.
    orientations : sequence of Orientation

    Returns
    -------
    Proposal or None
        None where nothing is, or the pulse is as long as it was proposed.
    """
    for place, cut in enumerate(proposal.cuts):
        device: Any = cut.device
        if device.action is Action.SENSE and _slips(cut, trial, orientations) and device.time < PULSE:
            other = device.with_pulse(min(LONGER_PULSE * device.time, PULSE))
            move = _move_of(MoveKind.LONGER_PULSE, other, other.time)
            return proposal.with_cut(place, replace(cut, device=other), move)
    return None


def _widen_slot(proposal: Proposal, orientations: Sequence[Orientation]) -> Proposal | None:
    """The proposal with a wider slot between its rails; None without rails that can be wider.

    A part lies askew along the wall: it comes to rails narrowed to its shank beside them, and slides on. The
    slot grows towards the head, about its middle, as long as the head is held by the rails.
    """
    for place, cut in enumerate(proposal.cuts):
        shank = neck(orientations[proposal.row]) if cut.device.action is Action.HANG else None
        if shank is None:
            continue
        device: Any = cut.device
        first, last = device.span
        half = 0.5 * SLOT_WIDENING * (shank.head - (last - first))
        more = float(np.round(half / VALUE_STEP_M) * VALUE_STEP_M)
        span = max(first - more, RAIL), last + more
        if more < VALUE_STEP_M or span == device.span or last - first > WIDEST_SLOT * shank.head:
            continue
        other = _judge(cut, device.with_span(span), orientations, proposal.row)
        return proposal.with_cut(place, other, _move_of(MoveKind.WIDER_SLOT, other.device, span[1] - span[0]))
    return None
