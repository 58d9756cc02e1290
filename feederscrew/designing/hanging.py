"""Chains with rails, by what trials show: which parts hang, and what is changed where some do not.

The static rule ranks: it says where rails lie and which cuts come before them. It refuses none of them: a
short flanged part rolls by the rule, and hangs in a trial.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.geometry import vectors
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.blades import Wiper
from feederscrew.bowl.devices.kinds import KINDS, dearer
from feederscrew.bowl.devices.ledges import Rails
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing import proposals
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.proposals import MARGINS, Proposal
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.short_trials import SELDOM_SHARE, ShortTrial
from feederscrew.feeding.stream import Orientations
from feederscrew.sorting.isolating import chain, rails
from feederscrew.sorting.isolating.chain import (
    DESIGN_KEY,
    Cut,
    Design,
    DesignConstraints,
    DesignTask,
    judge_cut,
    limits,
    margins_at,
)
from feederscrew.sorting.isolating.design import design_around_rails
from feederscrew.sorting.isolating.rails import USUAL_RAILS, RailSetting, find_head
from feederscrew.sorting.orientations import SAME_HEAD_COSINE, Neck, Orientation
from feederscrew.sorting.verdicts import DeviceEncounter
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import JammedParts

# what is varied, one after the other, from the best chain so far: chosen on an eyelet, a cup with a flange, a
# T-nut and a push button, for which one of these decides
OFFSETS_M = (5e-4, -3e-4, 1e-3)  # of the slot, farther off the wall
PLAYS_M = (3e-4, 6e-4)  # by which the slot is wider
BLADES_M = (1e-3, -5e-4)  # by which the blade stands higher
LEADS = (1.7, 0.6)  # times the length of the lead-in
SWEEPS_DEG = (25.0, 45.0, 20.0, 55.0)  # of the blade behind the rails, beside the first
FIRST_SWEEP_DEG = 30.0
HELD_FATES = frozenset({Fate.STOPPED, Fate.HANGING, Fate.STUCK})
MAY_HANG = 0.6  # of the parts whose head could hang, that are taken to do so before a trial has said it


def expected_gain(orientations: Orientations, shares: Floats, row: int) -> float:
    """Return the share [1] of what comes that may hang by the same head, before any trial.

    Parameters
    ----------
    orientations : Orientations
        M, through a chain with rails.
    shares : (M,) float [1]
        In which they come.
    row : int
        The wanted one.

    Returns
    -------
    float [1]
        ``MAY_HANG`` of the share that has the head of the wanted row.
    """
    own = find_head(orientations.lying[row])
    if own is None:
        return 0.0
    return MAY_HANG * float(
        sum(share for share, has in zip(shares, same_head(orientations.lying, own)) if has)
    )


def same_head(orientations: Sequence[Orientation], own: Neck) -> Bools:
    """Return which orientations could hang by the same head of the part.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    own : Neck
        With that head.

    Returns
    -------
    (M,) bool
    """
    heads = [find_head(orientation) for orientation in orientations]
    return np.array(
        [head is not None and vectors.dot(head.down, own.down) > SAME_HEAD_COSINE for head in heads]
    )


def head_rows(orientations: Sequence[Orientation], shares: Floats, rows: Sequence[int]) -> list[int]:
    """Return the most frequent of some rows with each head of a part, the most frequent head first.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they come.
    rows : sequence of int

    Returns
    -------
    list of int
    """
    chosen: list[int] = []
    left = [k for k in rows if find_head(orientations[k]) is not None]
    while left:
        own = find_head(orientations[left[0]])
        if own is None:
            break
        alike = same_head(orientations, own)
        chosen.append(max((k for k in left if alike[k]), key=lambda k: (shares[k], -k)))
        left = [k for k in left if not alike[k]]
    return chosen


@dataclass(frozen=True)
class Shown:
    """Findings of a trial on M orientations at rails."""

    hangs: Bools  # (M,) which leave hanging, most of their parts at least
    gone: Bools  # (M,) which the bare track or the rails return
    stands: Bools  # (M,) which stand at the rails, or before them
    unswept: Bools  # (M,) which stand at a blade behind the rails, or pass it otherwise than hanging
    held_hanging: bool = False  # whether a part of those that hang stood at such a blade

    @classmethod
    def before_trial(cls, hangs: Bools) -> "Shown":
        """Return what is taken before any trial: what has the head hangs, the rest needs a device.

        Parameters
        ----------
        hangs : (M,) array of bool
            Orientations that have the head.

        Returns
        -------
        Shown
        """
        return cls(hangs, *np.zeros((3, len(hangs)), bool))


@dataclass(frozen=True)
class RailsTry:
    """A chain with rails that is to be tried."""

    proposal: Proposal
    setting: RailSetting
    is_livelier: bool = False  # at a livelier drive than the best chain so far


class RailsSearch:
    """The rails of one head on one track, and what is tried of them from one trial to the next."""

    def __init__(
        self,
        lying: Sequence[Orientation],
        shares: Floats,
        row: int,
        before: tuple[Device, ...],
        request: DesignRequest,
        cost_class: int,
    ) -> None:
        self.row, self.before, self.shares, self.request = row, before, shares, request
        kinds = (*dearer(cost_class), *request.without)
        self.constraints = DesignConstraints(without=tuple(dict.fromkeys(kinds)), up=request.up)
        self.lying = tuple(lying)
        self.seen: set[tuple[str, ...]] = set()  # chains that were proposed

    def start(self) -> Iterator[RailsTry]:
        """Yield chains before any trial: what has the head is taken to hang, the rest to need a device."""
        head = find_head(self.lying[self.row])
        if head is None or not self.constraints.allows(Rails.kind):
            return
        hangs = same_head(self.lying, head)
        for sweep in (FIRST_SWEEP_DEG, None):
            shown = Shown.before_trial(hangs)
            for proposal in self._build(Move(MoveKind.RAILS), USUAL_RAILS, sweep, shown):
                yield RailsTry(proposal, USUAL_RAILS)

    def moves(self, tried: RailsTry, trial: ShortTrial) -> Iterator[RailsTry]:
        """Yield what changes a chain where a trial shows it to fail, the likeliest first.

        Parameters
        ----------
        tried : RailsTry
        trial : ShortTrial
            Of that chain.

        Yields
        ------
        RailsTry
        """
        proposal, setting = tried.proposal, tried.setting
        shown = shown_by(trial, proposal, len(self.lying))
        sweep = _sweep_of(proposal)

        def build(
            kind: MoveKind, value: float, setting: RailSetting, sweep: float | None
        ) -> Iterator[RailsTry]:
            for built in self._build(Move(kind, value), setting, sweep, shown):
                yield RailsTry(built, setting)

        stays_at_blade = sweep is not None and bool(shown.unswept.any() or shown.held_hanging)
        if stays_at_blade:
            yield replace(tried, is_livelier=True)
        if shown.hangs.any() and (stays_at_blade or shown.stands.any() or trial.wrong.any()):
            # what the trial shows to be left over is returned before the rails, or swept off behind them
            yield from build(MoveKind.CUTS_BEFORE, 0.0, setting, sweep)
            if sweep is None:
                yield from build(MoveKind.BLADE_BEHIND, 0.0, setting, FIRST_SWEEP_DEG)
        for degrees in SWEEPS_DEG if stays_at_blade else ():
            yield from build(MoveKind.SWEEP, math.radians(degrees), setting, degrees)
        higher = [(MoveKind.BLADE_HEIGHT, x, replace(setting, blade=setting.blade + x)) for x in BLADES_M]
        places = [
            *(higher if stays_at_blade else ()),
            *((MoveKind.SLOT_PLACE, x, replace(setting, offset=setting.offset + x)) for x in OFFSETS_M),
            *((MoveKind.WIDER_SLOT, x, replace(setting, play=setting.play + x)) for x in PLAYS_M),
            *((MoveKind.LEAD_IN, x, replace(setting, lead=setting.lead * x)) for x in LEADS),
        ]
        for kind, value, other in places:
            yield from build(kind, value, other, sweep)

    def mends_of_jams(
        self, proposal: Proposal, trial: ShortTrial, jammed: Sequence[JammedParts]
    ) -> Iterator[Proposal]:
        """Yield what changes a chain whose queue jams, by what stood there and at which device.

        Another orientation is returned before the rails. Where one that hangs stands at a cut before them,
        that cuts less, or another kind of cut takes its place. At the rails it gets a wider slot and a longer
        lead-in; at the blade a higher blade, and where that stands higher already, both of these at once.

        Parameters
        ----------
        proposal : Proposal
        trial : ShortTrial
            Of that chain.
        jammed : sequence of JammedParts

        Yields
        ------
        Proposal
        """
        setting = proposal.rails or USUAL_RAILS
        shown, sweep = shown_by(trial, proposal, len(self.lying)), _sweep_of(proposal)
        rows = {orientation.name: row for row, orientation in enumerate(self.lying)}
        placed = [device for device in proposal.devices if device.action.has_place]
        station = next((n for n, device in enumerate(placed, start=1) if device.action is Action.HANG), -1)
        jets = {cut.device.kind for cut in proposal.cuts if cut.device.action is Action.BLOW}
        for n, row in enumerate(trial.rows.tolist()):  # what cuts before the rails return needs them
            ends = trial.ends[n]
            is_before = bool(ends) and all(0 < end.station < station for end in ends)
            is_blown = is_before and all(end.kind in jets for end in ends)  # the jets stay as they are
            shown.stands[row] |= is_before and not is_blown
            shown.gone[row] |= is_blown
        at_rails = at_blade = False
        stands_at_cut = others_stand = False  # what hangs, at a cut; what does not, anywhere
        for stood in jammed:
            row, place = rows.get(stood.name, -1), stood.place
            if row < 0 or shown.hangs[row]:
                at_rails, at_blade = at_rails or place == station, at_blade or place > station
                if place >= station:
                    continue
                eased = proposals.ease_cut(proposal, place, self.lying)
                if eased is not None:
                    yield eased
                stands_at_cut = True
                continue
            others_stand = True
            if place <= station:
                shown.stands[row] = True
            else:
                shown.unswept[row] = True
        wider = [(MoveKind.WIDER_SLOT, x, replace(setting, play=setting.play + x)) for x in PLAYS_M]
        longer = [(MoveKind.LEAD_IN, x, replace(setting, lead=setting.lead * x)) for x in LEADS[:1]]
        higher = [(MoveKind.BLADE_HEIGHT, x, replace(setting, blade=setting.blade + x)) for x in BLADES_M]
        cuts_before = [(MoveKind.CUTS_BEFORE, 0.0, setting), (MoveKind.OTHER_CUTS, 0.0, setting)]
        is_raised = setting.blade > 0.0
        room = replace(setting, play=setting.play + PLAYS_M[-1], lead=setting.lead * LEADS[0])
        sinks = [(MoveKind.WIDER_SLOT, PLAYS_M[-1], room)]
        tries = [
            *(reversed(cuts_before) if stands_at_cut else cuts_before if others_stand else ()),
            *(higher if at_blade and not is_raised else ()),
            # below a blade that stands high, what hangs stands where it has not sunk all the way
            *(sinks if at_blade and is_raised else ()),
            *((*wider, *longer) if at_rails else ()),
        ]
        self.seen.add(proposal.chain)
        own_cuts = {cut.device.kind: cut for cut in proposal.cuts if cut.device.action.carries}
        for kind, value, other in tries:
            # another kind does before the rails what those of the chain do
            without = tuple(own_cuts) if kind is MoveKind.OTHER_CUTS else ()
            for built in self._build(Move(kind, value), other, sweep, shown, without):
                cuts = built.cuts
                if kind is MoveKind.OTHER_CUTS and cuts[0].device.action is Action.HANG:
                    continue  # no other kind returns any of it
                if kind not in (MoveKind.CUTS_BEFORE, MoveKind.OTHER_CUTS):  # as they were changed before
                    cuts = tuple(own_cuts.get(cut.device.kind, cut) for cut in cuts)
                changed = replace(built, cuts=_with_jets(cuts, proposal.cuts))
                if changed.chain != proposal.chain:
                    yield changed

    def _build(
        self,
        move: Move,
        setting: RailSetting,
        sweep: float | None,
        shown: Shown,
        without: Sequence[str] = (),
    ) -> Iterator[Proposal]:
        """Yield the chain of a setting without some kinds of devices, if it is a new one."""
        device, task, hangs = self._rails(setting), self._task(without), shown.hangs
        if device is None or not hangs.any():
            return
        wanted = self.row if hangs[self.row] else int(np.flatnonzero(hangs)[0])
        task = replace(task, wanted=wanted)
        angle = None if sweep is None else math.radians(sweep)
        if angle is not None and not self.constraints.allows(Wiper.kind):
            return
        design = design_around_rails(
            task,
            device,
            hangs,
            shown.gone | ~task.stays,
            shown.stands,
            sweep=angle,
            unswept=shown.unswept,
            partly=True,
            raised=setting.blade,
        )
        if design is None:  # the blade has nothing to sweep
            return
        proposal = replace(self._proposal(design, move), rails=setting)
        if proposal.chain not in self.seen:
            self.seen.add(proposal.chain)
            yield proposal

    def _proposal(self, design: Design, move: Move) -> Proposal:
        cuts = design.cuts
        changed = next((cut.device for cut in reversed(cuts) if cut.device.action is Action.OVERHEAD), None)
        if move.kind in (MoveKind.BLADE_BEHIND, MoveKind.SWEEP) and changed is not None:
            move = replace(move, device=changed.kind, device_text=changed.text)
        if move.kind is MoveKind.WIDER_SLOT:
            slot = next(cut.device.span for cut in cuts if cut.device.action is Action.HANG)
            move = replace(move, value=slot[1] - slot[0])
        return Proposal(self.row, cuts, self.before, move, margin=MARGINS[-1])

    def _task(self, without: Sequence[str] = ()) -> DesignTask:
        kinds = dict.fromkeys((*self.constraints.without, *without))
        return chain.design_task(
            self.lying,
            self.shares,
            self.row,
            MARGINS[-1],
            1.0 - SELDOM_SHARE,
            self.before,
            constraints=replace(self.constraints, without=tuple(kinds)),
        )

    def _rails(self, setting: RailSetting) -> Rails | None:
        own = self.lying[self.row]
        head = find_head(own)
        if head is None:
            return None
        width = rails.slot_width(head, MARGINS[-1])
        if width + setting.play >= head.head - rails.LEAD_IN_MARGIN_M:
            return None
        return rails.place_rails(own, head, width, self.constraints.step, setting)


def blow_off(
    proposal: Proposal, trial: ShortTrial, stands: Sequence[int], orientations: Sequence[Orientation]
) -> Proposal | None:
    """Return a chain that begins with a steady air jet against the parts that stand at its rails.

    The jet blows off orientations that stood at the rails and are not wanted. Of all jets that
    leave the wanted orientations, the one that blows off most of those that stood is taken. Cuts and blades
    do not always do this: a queue pushes parts past a cut from which a single part falls, and a part may
    lean on a blade without being swept off.

    The jet stands first, where the track is whole: further on a part may already lean on the edge of a cut.
    A cut that now has fewer orientations to return is made smaller, see ``_leave_to``.

    Parameters
    ----------
    proposal : Proposal
        A chain with rails.
    trial : ShortTrial
        Its trial, which says the wanted orientations: the jet leaves these on the track.
    stands : sequence of int
        Rows of the orientations that stood still, in a queue or in the trial. If they are all wanted, the
        jet blows off what a cut before the rails returns: a queue pushes such parts past the cut, and they
        block the others.
    orientations : sequence of Orientation
        All of the part.

    Returns
    -------
    Proposal or None
        None if the chain has no rails or has a jet already, if there is nothing to blow off, or if each jet
        that is sure to blow off one of these orientations blows off a wanted one too. A jet is sure to blow
        an orientation off where that fails by ``MARGINS[-1]`` or more.
    """
    wanted, placed = trial.wanted, [cut.device.action for cut in proposal.cuts]
    if not wanted or Action.BLOW in placed or Action.HANG not in placed:
        return None
    before = placed.index(Action.HANG)
    # a queue may also push past a cut what a single part falls from there: the jet shall blow that off too
    leaks = [
        row
        for row, orientation in enumerate(orientations)
        if row not in wanted and any(orientation.name in cut.returns for cut in proposal.cuts[:before])
    ]
    rejected = [row for row in stands if row not in wanted] or leaks
    if not rejected:
        return None
    encounters = [DeviceEncounter(orientation, orientations) for orientation in orientations]
    own, others = ([encounters[row] for row in rows] for rows in (wanted, {*rejected, *leaks}))
    kinds: list[Any] = [
        kind for kind in KINDS.values() if kind.action is Action.BLOW and kind.search.is_proposed
    ]
    jets = [jet for kind in kinds for jet in kind.proposals(own, others, orientations, DESIGN_KEY)]
    blown = {jet: margins_at(jet, tuple(orientations)) <= -MARGINS[-1] for jet in jets}
    jets = [jet for jet in jets if blown[jet][rejected].any() and not blown[jet][wanted].any()]
    if not jets:
        return None
    jet = max(jets, key=lambda one: (int(blown[one][rejected].sum()), int(blown[one].sum())))
    cut = judge_cut(orientations, proposal.row, jet, blown[jet], jet, jet)
    cuts = [_leave_to(cut, blown[jet], wanted, orientations) for cut in proposal.cuts]
    move = Move(MoveKind.JET_BEFORE, 0.0, jet.kind, jet.text)
    return replace(proposal, cuts=(cut, *cuts), move=move)


def _leave_to(cut: Cut, gone: Bools, wanted: Sequence[int], orientations: Sequence[Orientation]) -> Cut:
    """Return a cut with a new value, where another device already blows off a part of what it returned.

    The value lies in the middle between the orientations that pass the cut and those that it alone returns.
    The cut stays as it is if the other device blows off none or all of its orientations, or if less than
    ``LEAST_WINDOW`` lies between the two. ``gone`` (M,) tells which orientations are blown off.
    """
    kind = type(cut.device)
    returned = [row for row, one in enumerate(orientations) if one.name in cut.returns]
    left = [row for row in returned if not gone[row] and row not in wanted]
    if not kind.search.bound or not cut.device.action.carries or not left or len(left) == len(returned):
        return cut
    values = limits(kind, orientations)
    is_lower = kind.search.bound == "lower"
    passed = values[list(wanted)].min() if is_lower else values[list(wanted)].max()
    nearest = values[left].max() if is_lower else values[left].min()
    if (passed - nearest if is_lower else nearest - passed) < proposals.LEAST_WINDOW:
        return cut
    return proposals.move_cut(cut, 0.5 * (passed + nearest), orientations, wanted[0])


def shown_by(trial: ShortTrial, proposal: Proposal, count: int) -> Shown:
    """Return what a trial shows of the orientations at rails.

    What a cut before the rails returns, or a blade behind them sweeps off, needs that device: it is neither
    gone nor does it stand, as what was not tried.

    Parameters
    ----------
    trial : ShortTrial
    proposal : Proposal
        That was tried.
    count : int
        Of orientations, M.

    Returns
    -------
    Shown
    """
    placed = [device for device in proposal.devices if device.action.has_place]
    station = next((n for n, device in enumerate(placed, start=1) if device.action is Action.HANG), -1)
    hangs, gone, stands, unswept = np.zeros((4, count), bool)
    held_hanging = False
    for n, row in enumerate(trial.rows.tolist()):
        hangs[row] = 2 * trial.right[n] > trial.parts[n]
        left = trial.right[n] or trial.wrong[n] or trial.held[n]
        gone[row] = not left and all(end.station in (0, station) for end in trial.ends[n])
        at = [end.station for end in trial.ends[n] if end.fate in HELD_FATES]
        stands[row] = not hangs[row] and any(place <= station for place in at)
        unswept[row] = not hangs[row] and not stands[row] and bool(at or trial.wrong[n])
        held_hanging = held_hanging or bool(hangs[row] and at)
    return Shown(hangs, gone, stands, unswept, held_hanging)


def _with_jets(cuts: Sequence[Cut], own: Sequence[Cut]) -> tuple[Cut, ...]:
    """Cuts, and before these the jets of a chain, where there are none among them."""
    if any(cut.device.action is Action.BLOW for cut in cuts):
        return tuple(cuts)
    return (*(cut for cut in own if cut.device.action is Action.BLOW), *cuts)


def _sweep_of(proposal: Proposal) -> float | None:
    """The sweep [deg] of the blade behind the rails; None without one."""
    behind = False
    for cut in proposal.cuts:
        behind = behind or cut.device.action is Action.HANG
        if behind and isinstance(cut.device, Wiper):
            return round(math.degrees(cut.device.sweep), 6)
    return None


def score(trial: ShortTrial) -> float:
    """Return how good a chain is: efficiency less three times the share that stands or leaves wrongly.

    A share that stands or leaves wrongly counts three times: it stops a bowl. What comes back only slows it.

    Parameters
    ----------
    trial : ShortTrial

    Returns
    -------
    float [1]
    """
    return trial.efficiency - 3.0 * (trial.stopped + trial.wrong_share)
