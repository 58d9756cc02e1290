"""Search for the devices, and the track, that let one orientation leave and return all the others."""

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, TypedDict, Unpack

import numpy as np

from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.errors import ArgumentError
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.blades import PROPOSED_SWEEP_RAD, Wiper
from feederscrew.bowl.devices.kinds import KINDS, leaning, names, shaped
from feederscrew.bowl.devices.leans import Lean
from feederscrew.bowl.devices.ledges import Rails
from feederscrew.bowl.devices.orientation_names import place_of, rows
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.sorting.fates import at_entry, course
from feederscrew.sorting.isolating import chain, hole_search, rails
from feederscrew.sorting.isolating.chain import (
    DESIGN_KEY,
    Cut,
    Design,
    DesignConstraints,
    DesignTask,
    OutcomeKind,
)
from feederscrew.sorting.isolating.hole_search import HoleSearch
from feederscrew.sorting.orientations import Orientation
from feederscrew.sorting.orientations import place as placed
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

DESIGN_MARGIN_M = 1.5e-4  # [m] to either side, beside ...
PLAY_M, TOLERANCE_M = 5e-5, 5e-5  # [m] ... what parts come off the wall, and what their size is off
TOTAL_MARGIN_M = DESIGN_MARGIN_M + PLAY_M + TOLERANCE_M  # [m]
MOST_HOLES = 3  # cut-outs in one chain
PURITY_GAIN = 1e-2  # [1] purity by which a chain of varied devices is better
GAIN = 1.25  # turning devices are taken where they bring so many times the parts, if no efficiency is asked
VARIED_SWEEPS_DEG = (20.0, 45.0, 55.0)  # [deg] beside the 30 deg of the first design
# drops first, then what clears itself, then what sees
Stage = dict[str, bool]
STAGES: tuple[Stage, ...] = ({"clearing": False}, {}, {"air": True}, {"sensed": True})
TURNER_STEP_M = 1e-4  # [m] to which a height or width is rounded
TURNER_GAIN = 1.05  # a chain is tried if it brings so many times what the best shorter one does
TRIED = 4  # chains of each length
MAX_STEP_SHARE = 0.5  # of the part's greatest length: over a higher step it tumbles freely
TRACK_REMARK = (
    "quasi-static: at the bowl's speed a part may be carried over a cut that returns it, laid over by a "
    "blade or wedged between rails - see feeder trial"
)
ROCKS = (
    "{} may rock on what these cuts leave below it, and no safer value lies between the limits - try it "
    "with feeder trial"
)
# [rad] of a groove in which what rolls across it turns along it first. In trials of a dowel 4 of 4 did at 55
# and 60 deg, 2 of 4 at 50; at 15 and 30 deg 12 of 12 rolled back
MAX_GROOVE_FACE_RAD = math.radians(55.0)
LEAN_GAIN = 1.05  # times the efficiency for which a track leans that need not
BESIDE, WHOLE = 1e-3, 1e-3  # [m] that a track is wider than what lies on it, and the step of its width

# whether the drive leaves orientations lying on what devices in a bowl leave of their feet, by a margin [m]
Steady = Callable[[Sequence[Device], Sequence[Orientation], Bowl, float], Bools]


class ChainOptions(TypedDict):
    """Keywords of ``design``, as the design of a track hands them on."""

    margin: float  # [m]
    search: HoleSearch
    purity: float  # [1]
    efficiency: float  # [1]
    before: Sequence[Device]
    constraints: DesignConstraints


Stretch = Sequence[Lean]  # devices in order, each of which leans the track


def design(
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted: int,
    *,
    margin: float = TOTAL_MARGIN_M,
    search: HoleSearch | None = None,
    purity: float = 1.0,
    efficiency: float = 0.0,
    before: Sequence[Device] = (),
    constraints: DesignConstraints | None = None,
) -> Design:
    """Return the chain of fewest devices that isolates an orientation.

    Parameters
    ----------
    orientations : sequence of Orientation
        The M of the part on the track.
    shares : (M,) float [1]
        The probability of each.
    wanted : int
        The place of one.
    margin : float [m], optional
        To either side.
    search : HoleSearch, optional
        Seed and limits of the search for holes.
    purity : float [1], optional
        Of what leaves: the chain is not made longer for more.
    efficiency : float [1], optional
        Of what is offered: ways on are tried as long as it is missed.
    before : sequence of Device, optional
        Of the bowl itself; the design is found behind them.
    constraints : DesignConstraints, optional

    Returns
    -------
    Design

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    search = search or hole_search.HoleSearch()
    task = chain.design_task(orientations, shares, wanted, margin, purity, before, constraints=constraints)
    proposal = _design_returning(task, search.start())
    may_turn = task.constraints.turn and _is_open(before)
    if may_turn and not (proposal.isolated and proposal.efficiency >= efficiency > 0.0):
        # turning devices before all others, where that delivers enough more
        enough = GAIN if efficiency <= 0.0 else 1.0
        for cuts in turning_chains(task):
            behind_turners = chain.design_task(
                task.orientations, task.shares, wanted, margin, purity, before, cuts, task.constraints
            )
            other = _design_returning(behind_turners, search.start())
            more = other.efficiency > enough * proposal.efficiency + 1e-12
            if other.isolated and (more or not proposal.isolated):
                proposal = other
            if efficiency > 0.0 and proposal.isolated and proposal.efficiency >= efficiency:
                break
    # by how much what was asked for is missed, and why
    reasons = []
    if proposal.efficiency < efficiency:
        comes = task.shares[wanted] / task.shares.sum()
        why = (
            f"{100.0 * comes:.3g} % of the parts come as {task.orientations[wanted].name}, and devices that "
            "return parts add none; `turn` allows devices that turn parts over"
        )
        if task.constraints.turn:
            why = "no step or ledge, nor two of them, turns more parts into it that can then be isolated"
        miss = 100.0 * (efficiency - proposal.efficiency)
        reasons.append(f"the efficiency asked for is missed by {miss:.3g} % of the parts: {why}")
    if task.purity < 1.0 and proposal.purity < task.purity - 1e-12:
        miss = 100.0 * (task.purity - proposal.purity)
        reasons.append(f"the purity asked for is missed by {miss:.3g} % of what leaves")
    return replace(proposal, remarks=(*proposal.remarks, *reasons)) if reasons else proposal


def _is_open(devices: Sequence[Device]) -> bool:
    """Whether others may stand behind devices: parts neither hang behind them nor are on their side."""
    return not any(device.action is Action.HANG or device.on_side for device in devices)


def _design_returning(task: DesignTask, search: HoleSearch) -> Design:
    """The best chain of devices that only return parts: they leave lying, or hanging."""
    if not _is_open(task.before):  # it is judged by what leaves of it
        is_twisted = any(device.on_side for device in task.before)
        return chain.propose(task, (), np.full(len(task.orientations), is_twisted))
    outcome = task.constraints.outcome
    hung = (
        design_rails(task)
        if outcome != OutcomeKind.LYING
        and task.constraints.allows(*names(lambda kind: kind.action is Action.HANG))
        else None
    )
    if outcome == OutcomeKind.HANGING:
        return chain.propose_nothing(task, "does not hang between rails") if hung is None else hung
    lying = _design_lying(task, search)
    if hung is None or (hung.isolated, hung.efficiency) <= (lying.isolated, lying.efficiency):
        return lying
    return hung


def _design_lying(task: DesignTask, search: HoleSearch) -> Design:
    """The chain of devices that return the others and leave the wanted one lying."""
    wanted, own = task.wanted, task.orientations[task.wanted]
    why = {
        "can tip over on the track at this drive": own.turns_over,
        "lies on its round side, not along the track, and can roll back": own.may_roll_back,
        "falls off the bare track": own.falls_off or not own.margin > 0.0,
        "is returned by the devices of the bowl file": not task.coming[wanted] > 0.0
        and task.shares[wanted] > 0.0,
    }
    for reason, holds in why.items():
        if holds:
            return chain.propose_nothing(task, reason)
    weight = chain.weights(task)
    weight[task.same] = 0.0
    counted = np.where(weight > 0.0, task.coming, 0.0) if task.purity < 1.0 else weight
    gone = ~task.stays | ((task.coming <= 0.0) & (task.shares > 0.0))
    least = task.margin if task.constraints.gentle else np.inf
    problem = task.same & task.often, counted, gone, task.allowed, least
    for stage in STAGES[: 2 if task.constraints.clearing else 1]:
        cuts, is_returned = _choose_cuts(task, stage, *problem)
        left = ~is_returned & task.often & ~task.same
        if not task.coming[left].sum() > task.allowed:
            break
    proposal = chain.propose_needed(task, cuts, is_returned)
    sensed = {"sensed": task.constraints.sensed}
    for stage in ({"air": task.constraints.air}, sensed, sensed | {"varied": task.constraints.vary}):
        if proposal.isolated or not any(stage.values()):
            continue
        other = chain.propose_needed(task, *_choose_cuts(task, stage, *problem))
        purer = stage.get("varied") and other.purity > proposal.purity + PURITY_GAIN
        proposal = other if other.isolated or purer else proposal
    # holes are for one orientation alone, and by far the longest search: only where nothing simpler isolates
    if task.constraints.allows(*shaped()) and task.same.sum() == 1 and not proposal.isolated:
        more = chain.propose_needed(task, *_add_holes(task, cuts, is_returned, search))
        purer = np.nan_to_num(proposal.purity) > np.nan_to_num(more.purity) + PURITY_GAIN
        if more.isolated or (not more.stands and (proposal.stands or not purer)):
            proposal = more
    return replace(proposal, late=search.late)


def _choose_cuts(
    task: DesignTask, stage: Stage, equals: Bools, weight: Floats, gone: Bools, enough: float, least: float
) -> tuple[tuple[Cut, ...], Bools]:
    """Cuts of the fewest devices of a stage, and which orientations are returned, those that are gone too."""
    orientations, wanted, margin, constraints = task.orientations, task.wanted, task.margin, task.constraints
    same = np.flatnonzero(equals).tolist()
    options = {name: value for name, value in stage.items() if name != "varied"}
    margins = chain.candidates(orientations, wanted, margin, constraints, same=same, **options)
    if stage.get("varied", False):
        margins |= varied_devices(orientations, wanted, margin, constraints, same)
        margins = dict(sorted(margins.items(), key=lambda item: bool(item[0].like)))  # what sees comes last
    margins = {device: some for device, some in margins.items() if (some[equals] >= margin).all()}
    devices = chain.fewest(margins, weight, margin, enough)
    left, must = ~gone, []  # each device has to return those that none before it does
    for device in devices:
        must.append(left & (margins[device] <= -margin))
        left = left & ~must[-1]
    cuts = chain.place_devices(orientations, wanted, devices, must, least, constraints.step, same)
    return cuts, np.any([gone, *must], axis=0)


def varied_devices(
    orientations: Sequence[Orientation],
    wanted: int,
    margin: float,
    constraints: DesignConstraints,
    same: Sequence[int] = (),
) -> dict[Device, Floats]:
    """Return blades of sweeps that are not tried first, with the margins at them.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    wanted : int
    margin : float [m]
    constraints : DesignConstraints
    same : sequence of int, optional
        As for ``chain.candidates``.

    Returns
    -------
    dict of Device to (M,) float [m]

    References
    ----------
    docs/tooling.md, "What a design takes".
    """
    margins: dict[Device, Floats] = {}
    for kind in (
        kind
        for kind in chain.numeric_kinds()
        if kind.action is Action.OVERHEAD and constraints.allows(kind.kind)
    ):
        highest = orientations[chain.pivot(kind, orientations, wanted, same)].height
        proposal: Any = kind.proposal(
            DESIGN_KEY, chain.snap_to_shop_step(highest + margin, constraints.step, up=True)
        )
        for degrees in VARIED_SWEEPS_DEG:
            device = replace(proposal, sweep=math.radians(degrees))
            if device.clear_of(orientations[wanted].grip):
                margins[device] = chain.margins_at(device, tuple(orientations))
    return margins


def _add_holes(
    task: DesignTask, cuts: tuple[Cut, ...], is_returned: Bools, search: HoleSearch
) -> tuple[tuple[Cut, ...], Bools]:
    """Add cut-outs for those that are left, as long as one returns any."""
    is_returned, own = is_returned.copy(), task.orientations[task.wanted]
    for _ in range(MOST_HOLES):
        left = [k for k in np.flatnonzero(~is_returned).tolist() if k != task.wanted and task.often[k]]
        if task.coming[left].sum() <= task.allowed:
            break
        unreachable = [k for k in left if chain.stands_on_all(task.orientations[k], own, task.margin)]
        if task.constraints.isolating and task.coming[unreachable].sum() > task.allowed:
            break  # no hole returns these, whatever it does with the others
        left = [k for k in left if k not in unreachable]
        play = task.margin + own.flight  # a hole so much shorter may be jumped
        hole = hole_search.cut_out(task.orientations, task.wanted, left, play, search) if left else None
        if hole is not None and task.constraints.cutter > 0.0:
            hole = hole_search.round_corners(task, hole, task.constraints.cutter)
        if hole is None:
            break
        cuts, is_returned[hole[1]] = (*cuts, hole[0]), True
    return cuts, is_returned


def place(orientations: Sequence[Orientation], aspect: str, heading: float | None, source: str) -> int:
    """Return the place of an orientation of the part of a file.

    Parameters
    ----------
    orientations : sequence of Orientation
    aspect : str
    heading : float [rad] or None
        None: the aspect's most frequent heading that stays on the track.
    source : str
        The file, for the fault.

    Returns
    -------
    int

    Raises
    ------
    ArgumentError
        If the part has no such orientation.
    """
    aspects = [orientation.aspect for orientation in orientations]
    aspect_rows = rows(aspects, aspect, f"aspect of {source}", ArgumentError)
    if heading is not None:
        return place_of(orientations, aspect, heading, f"heading of {source}", kind=ArgumentError)
    return max(aspect_rows, key=lambda k: (not orientations[k].returned, orientations[k].heading_share, -k))


# -- rails


def design_rails(task: DesignTask) -> Design | None:
    """Return the chain with rails in which the wanted orientation of a task hangs, as the static rule says.

    Parameters
    ----------
    task : DesignTask
        Of M orientations; the wanted one has to hang by its margin [m].

    Returns
    -------
    Design or None
        None where the part has no head, lies elsewhere than over the slot, or others are left over.

    Notes
    -----
    Source: own; docs/tooling.md, "Rails".
    """
    orientations, wanted, margin, step = task.orientations, task.wanted, task.margin, task.constraints.step
    own, head = orientations[wanted], rails.find_head(orientations[wanted])
    if head is None or head.head - head.shank < 2.0 * margin or own.returned:
        return None
    # the first setting at which it hangs by the margin, as the static rule says
    for setting in rails.SETTINGS:
        device = rails.place_rails(own, head, rails.slot_width(head, margin), step, setting)
        if device is None:
            continue
        outcomes = [verdict(device, orientation, orientations) for orientation in orientations]
        same = np.array([outcome.hangs and outcome.margin >= margin for outcome in outcomes])
        if same[wanted]:
            break
    else:
        return None
    at_rails = chain.margins_at(device, orientations)  # NaN of what stands there
    gone = (at_rails <= -margin) | ~task.stays | (task.coming <= 0.0)
    stands = np.isnan(at_rails)
    designs = [
        design_around_rails(task, device, same, gone, stands, sweep=sweep)
        for sweep in (None, *((PROPOSED_SWEEP_RAD,) if task.constraints.allows(Wiper.kind) else ()))
    ]

    def better(design: Design) -> tuple[bool, float, int]:
        return design.isolated, round(design.efficiency, 6), -len(design.cuts)

    return max((design for design in designs if design is not None), key=better, default=None)


def design_around_rails(
    task: DesignTask,
    device: Rails,
    same: Bools,
    gone: Bools,
    stands: Bools,
    *,
    sweep: float | None = None,
    unswept: Bools | None = None,
    partly: bool = False,
    raised: float = 0.0,
) -> Design | None:
    """Return the fewest cuts before rails, and a blade behind them, that return what does not hang.

    Parameters
    ----------
    task : DesignTask
        Of M orientations.
    device : Rails
    same : (M,) bool
        Which of them come to hang.
    gone : (M,) bool
        Which the track or the rails return.
    stands : (M,) bool
        Which come to stand at the rails, unless they are returned before.
    sweep : float [rad], optional
        Of a wiper behind the rails, which sweeps off what lies over the slot; none without it.
    unswept : (M,) bool, optional
        Which of the others stand at that wiper, as a trial has shown: they are returned before, if they can.
    partly : bool
        Whether a chain that leaves some over is returned too: a trial decides on it.
    raised : float [m]
        By which the wiper stands higher than usual.

    Returns
    -------
    Design or None
        None where others are left over, or no blade has anything to sweep.

    Notes
    -----
    Source: own; docs/tooling.md, "Rails".
    """
    orientations, wanted, step = task.orientations, task.wanted, task.constraints.step
    behind: tuple[Cut, ...] = ()
    passed = gone | same
    if sweep is not None:
        others = ~passed & ~stands
        blade = rails.blade_behind(
            device, orientations, same, others, task.margin, sweep, step, sure=not partly, raised=raised
        )
        if blade is None:
            return None
        behind, swept = (blade,), [orientation.name in blade.returns for orientation in orientations]
        passed = passed | (np.array(swept) if unswept is None else np.array(swept) & ~unswept)
    cuts: tuple[Cut, ...] = ()
    is_returned = passed
    for stage in STAGES:  # before the rails, of what they neither let hang nor return
        if all(getattr(task.constraints, name) for name in ("air", "sensed") if stage.get(name)):
            weight = np.where(passed, 0.0, chain.weights(task))
            cuts, is_returned = _choose_cuts(task, stage, same & task.often, weight, passed, 0.0, np.inf)
        left = ~is_returned & task.often
        jams = (left & stands).any()  # however seldom it comes, it blocks the rails
        if not jams and task.coming[left].sum() <= task.allowed_beside(same):
            break
    else:
        if not partly:
            return None
    outcomes = [verdict(device, orientation, orientations) for orientation in orientations]
    must = np.array([outcome.margin for outcome in outcomes]) <= -task.margin
    own, head = orientations[wanted], rails.find_head(orientations[wanted])
    ends: list[Device] = [device, device]
    if head is not None:
        ends = [rails.place_rails(own, head, width, step) or device for width in (head.shank, head.head)]
    last = chain.judge_cut(orientations, wanted, device, must, *ends)
    every = (*cuts, last, *behind)
    if partly:
        return chain.propose(task, every, (is_returned & ~same) | gone, same)
    return chain.propose_needed(task, every, (is_returned & ~same) | gone, same)


# -- turning devices


def turning_chains(task: DesignTask) -> list[tuple[Cut, ...]]:
    """Return the chains that bring most parts into the wanted orientation: single devices, then pairs.

    Parameters
    ----------
    task : DesignTask

    Returns
    -------
    list of tuple of Cut
    """
    orientations = task.orientations
    own, often = orientations[task.wanted], np.array(task.often & task.stays)
    frequent = [orientation for orientation, some in zip(orientations, often) if some]
    longest = max((max(orientation.length, orientation.height) for orientation in frequent), default=0.0)
    # steps and ledges, one between each two values at which what they do changes, and one above them all
    encounters = [DeviceEncounter(orientation, orientations) for orientation in frequent]
    kinds: list[Any] = [
        kind for kind in KINDS.values() if kind.action.turns and task.constraints.allows(kind.kind)
    ]
    changes = {kind: kind.changes(encounters) for kind in kinds}
    matrices = {}  # of each device, with what momentum may decide counted as lost
    for kind in kinds:
        heights = changes[kind]
        middles = [0.5 * (low + high) for low, high in itertools.pairwise(heights)]
        middles += [1.1 * heights[-1]] if heights else []
        values = {
            round(round(x / TURNER_STEP_M) * TURNER_STEP_M, 9) for x in middles if x > 2.0 * TURNER_STEP_M
        }
        for value in sorted(values):
            device = kind(DESIGN_KEY).valued(float(value))
            if device.action is Action.PITCH and device.limit > MAX_STEP_SHARE * longest:
                continue
            if verdict(device, own, orientations).margin >= task.margin:
                sure = [verdict(device, one, orientations).margin >= task.margin for one in orientations]
                matrices[device] = np.array(course((device,), orientations).matrices[0])
                matrices[device][~np.array(sure)] = 0.0
    start, chains = task.coming[task.wanted], []
    for count in (1, 2):
        some = []
        for chosen in itertools.permutations(matrices, count):
            share = task.coming
            for device in chosen:
                share = np.einsum("i,ij->j", share, matrices[device])
            some.append((float(share[task.wanted]), chosen))
        best = [row for row in some if row[0] > TURNER_GAIN * start]
        best = sorted(best, key=lambda row: -round(row[0], 9))
        chains += [chosen for _, chosen in best[:TRIED]]
        start = max([start, *(share for share, _ in best)])
    return [_turning_cuts(task, chosen, changes) for chosen in chains]


def _turning_cuts(
    task: DesignTask, devices: Sequence[Device], changes: dict[type[Device], list[float]]
) -> tuple[Cut, ...]:
    """Turning devices as cuts of a design, the second with what the first brings to it."""
    cuts, coming, orientations = [], task.coming, task.orientations
    for device in devices:
        outcomes = [verdict(device, orientation, orientations) for orientation in orientations]
        moved = [
            (orientations[k].name, orientations[onto].name, float(share))
            for k, outcome in enumerate(outcomes)
            for onto, share in outcome.onto
            if onto != k and coming[k] >= chain.LEAST_SHARE
        ]
        often = [outcome.margin for outcome, share in zip(outcomes, coming) if share >= chain.LEAST_SHARE]
        # the values nearest to its own at which what it does changes; itself where there is none
        kind, heights = type(device), changes[type(device)]
        below = max((height for height in heights if height <= device.limit), default=device.limit)
        above = min((height for height in heights if height >= device.limit), default=device.limit)
        cuts.append(
            Cut(
                device=device,
                margin_pass=float(min((x for x in often if x >= task.margin), default=np.nan)),
                margin_reject=np.nan,
                smallest=kind(DESIGN_KEY).valued(float(below)),
                largest=kind(DESIGN_KEY).valued(float(above)),
                returns=(),
                turns=tuple(moved),
            )
        )
        coming = np.einsum("i,ij->j", coming, course((device,), orientations).matrices[0])
    return tuple(cuts)


# -- the track: level, banked or a groove that holds what rolls, and how wide


def design_with_track(
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted: int,
    bowl: Bowl,
    *,
    steady: Steady,
    cache: dict[Any, Sequence[Orientation]] | None = None,
    **options: Unpack[ChainOptions],
) -> Design:
    """Return the design of an orientation, on the track as it is or as it leans best.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them, on the track as it is.
    shares : (M,) float [1]
    wanted : int
    bowl : Bowl
    steady : callable
        Of devices, orientations, a bowl and a margin [m]: says whether the drive leaves them lying.
    cache : dict, optional
        Orientations on tracks that lean, for other designs of the same part.
    **options : object
        Of ``design``: margin, search, purity, efficiency, before and constraints.

    Returns
    -------
    Design

    References
    ----------
    docs/tooling.md, "What a design takes".
    """
    cache, constraints = {} if cache is None else cache, options["constraints"]

    def orientations_behind(stretch: Stretch) -> Sequence[Orientation]:
        """Orientations behind some stretches of track."""
        key = tuple((device.kind, device.angle) for device in stretch)
        if key not in cache:
            onward = orientations
            for device in stretch:
                onward = tuple(device.onward(orientation) for orientation in onward)
            cache[key] = onward
        return cache[key]

    def design_on(stretch: Stretch, find: Callable[[Sequence[Orientation], Floats], Design]) -> Design | None:
        """The design on a track that leans, by what comes on so."""
        come = coming_shares(orientations, shares, stretch)
        if not come[wanted] > 0.0:
            return None
        proposal = find(orientations_behind(stretch), come)
        proposal = replace(proposal, efficiency=proposal.efficiency * float(come.sum() / shares.sum()))
        return _with_stretches(proposal, stretch if proposal.cuts else stretch[:1])

    # what rolls on the level comes on a bank or out of a groove
    best = None
    holding = holding_stretches(orientations[wanted], bowl.friction.wall, options["before"], constraints)
    if holding:
        proposal = _on_this_track(orientations_behind(holding), shares, wanted, bowl, steady, options)
        best = _with_stretches(proposal, holding) if proposal.isolated or proposal.cuts else None
    best = best or _on_this_track(orientations, shares, wanted, bowl, steady, options)
    if not constraints.vary or options["before"] or orientations[wanted].returned:
        return best
    # other tracks that lean: quickly, without what is by far the longest search; in full where that gains
    quick = replace(constraints, turn=False, without=(*constraints.without, *shaped()))
    brief = options | {"constraints": quick}
    for stretch in other_stretches(orientations[wanted], best, constraints):
        other = design_on(stretch, lambda lying, come: design(lying, come, wanted, **brief))
        if gains(other, best):
            other = design_on(
                stretch, lambda lying, come: _on_this_track(lying, come, wanted, bowl, steady, brief)
            )
            best = other if other is not None and gains(other, best) and other.steady >= best.steady else best
    return best


def holding_stretches(
    orientation: Orientation, wall_friction: float, before: Sequence[Device], constraints: DesignConstraints
) -> Stretch:
    """Return the stretches of track that hold an orientation which rolls on the level.

    They are a bank; where it would have to be steep, a groove and a low bank behind it.

    Parameters
    ----------
    orientation : Orientation
    wall_friction : float [1]
    before : sequence of Device
        Of the bowl.
    constraints : DesignConstraints

    Returns
    -------
    tuple of Lean
        Devices in order; empty where the orientation holds as it comes, or a device before leans the track.

    References
    ----------
    docs/tooling.md, "What a design takes".
    """
    leans = orientation.track.bank > 0.0 or any(device.action.leans for device in before)
    if orientation.kind != "rolling" or leans:
        return ()
    stretches = (kind.holding(orientation, wall_friction, DESIGN_KEY) for kind in leaning())
    return min(_keep_allowed(stretches, constraints), key=len, default=())


def other_stretches(
    orientation: Orientation, proposal: Design, constraints: DesignConstraints
) -> list[Stretch]:
    """Return other stretches of track that may give an orientation more than a design.

    Where that isolates, only what may turn more parts into the orientation is worth another track.

    Parameters
    ----------
    orientation : Orientation
    proposal : Design
    constraints : DesignConstraints

    Returns
    -------
    list of tuple of Lean
        Devices in order each, the fewest first.

    References
    ----------
    docs/tooling.md, "What a design takes".
    """
    if orientation.track.bank > 0.0:
        return []
    present = {(cut.device.kind, cut.device.text) for cut in proposal.cuts}
    stretches = _keep_allowed(
        (stretch for kind in leaning() for stretch in kind.leanings(orientation, DESIGN_KEY)), constraints
    )
    stretches = [stretch for stretch in stretches if (stretch[0].kind, stretch[0].text) not in present]
    return sorted(
        (stretch for stretch in stretches if stretch[0].action is Action.GROOVE or not proposal.isolated),
        key=len,
    )


def _keep_allowed(stretches: Iterable[Stretch], constraints: DesignConstraints) -> list[Stretch]:
    """Those that are any, and whose kinds of devices may be used."""
    return [one for one in stretches if one and constraints.allows(*(device.kind for device in one))]


def _with_stretches(proposal: Design, stretch: Stretch) -> Design:
    return replace(proposal, cuts=(*map(chain.plain_cut, stretch), *proposal.cuts))


def coming_shares(orientations: Sequence[Orientation], shares: Floats, stretch: Stretch) -> Floats:
    """Return the share of the parts that comes in each orientation behind stretches of track.

    What rolls back in a groove before it turns does not come.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        Before the stretches.
    stretch : tuple of Lean
        Devices in order.

    Returns
    -------
    (M,) float [1]
    """
    there = at_entry(orientations, stretch)
    flow, flat = (
        course(stretch, there),
        stretch[0].action is Action.GROOVE and stretch[0].angle < MAX_GROOVE_FACE_RAD - 1e-9,
    )
    comes = np.array([0.0 if flat and orientation.may_roll_back else 1.0 for orientation in there])
    return (comes[:, None] * np.asarray(shares)[:, None] * flow.leaving).sum(axis=0)[: len(orientations)]


def gains(other: Design | None, best: Design) -> bool:
    """Tell whether a design gives more than another: it isolates, is purer, or more efficient.

    Parameters
    ----------
    other : Design or None
    best : Design
        So far.

    Returns
    -------
    bool
    """
    if other is None or other.isolated != best.isolated:
        return other is not None and other.isolated
    pure, before = (np.nan_to_num(proposal.purity) for proposal in (other, best))
    if abs(pure - before) > PURITY_GAIN:
        return bool(pure > before)
    return other.efficiency > LEAN_GAIN * best.efficiency


def isolates_more(other: Design, best: Design) -> bool:
    """Return whether a dearer design is worth it beside the best so far.

    Parameters
    ----------
    other : Design
        Of a dearer class.
    best : Design
        That does not isolate, or leaves less than is asked for.

    Returns
    -------
    bool
        Whether it alone isolates; of two that both do, whether more parts leave; of two that do not, whether
        what leaves is purer by ``PURITY_GAIN``.
    """
    ranks = [(design.surely_isolates, design.isolated) for design in (other, best)]
    if ranks[0] != ranks[1]:
        return ranks[0] > ranks[1]
    if other.isolated:
        return other.efficiency > best.efficiency
    pure, before = (np.nan_to_num(design.purity) for design in (other, best))
    return bool(pure > before + PURITY_GAIN)


def widths(orientations: Sequence[Orientation], shares: Floats, wanted: int, margin: float) -> list[float]:
    """Return other widths of the track that may give the wanted one more.

    They are wide enough for an orientation that falls off; so narrow that the pulse of a vision reject
    carries off it what stays on a wider one.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
    wanted : int
    margin : float [m]

    Returns
    -------
    list of float [m]
        The wider one first.

    References
    ----------
    docs/tooling.md, "What a design takes".
    """
    own, widths = orientations[wanted], []
    if own.falls_off:
        widths.append(WHOLE * math.ceil((own.width + BESIDE) / WHOLE))
    sensors = [
        kind(DESIGN_KEY, like=(own.aspect, own.heading, float(margin))) for kind in chain.sensing_kinds()
    ]
    competitors = [k for k, share in enumerate(shares) if share >= chain.LEAST_SHARE and k != wanted]
    others = [orientations[k] for k in competitors if not orientations[k].returned]
    narrow = math.inf  # how far from the wall the pulse of each sensor's nozzles carries each of the others
    for sensor in sensors:
        for other in others:
            out, down = sensor.jet.push(other, orientations)
            blown = DeviceEncounter(other, orientations).blown(out, down, sensor.time)
            narrow = min(narrow, other.track.width + blown)
    narrow = WHOLE * math.floor(narrow / WHOLE) if narrow < math.inf else narrow
    least = max(own.width, own.balcony) + BESIDE
    if np.isfinite(own.balcony) and least <= narrow < own.track.width:
        widths.append(narrow)
    return widths


def _on_this_track(
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted: int,
    bowl: Bowl,
    steady: Steady,
    options: ChainOptions,
) -> Design:
    """The design of an orientation that the drive leaves lying on what is cut; if there is none, said so."""

    def stays(proposal: Design) -> bool:
        lying = [orientations[proposal.wanted]]
        return not proposal.cuts or bool(steady(proposal.devices, lying, bowl, options["margin"])[0])

    proposal = _isolate(orientations, shares, wanted, options)
    if stays(proposal):
        return proposal
    gentle = proposal
    if not any(cut.device.corners for cut in proposal.cuts):
        eased = options | {"constraints": replace(options["constraints"], gentle=True)}
        gentle = _isolate(orientations, shares, wanted, eased)
    first, second = ((one.isolated, one.efficiency, one.purity) for one in (gentle, proposal))
    if first == second and stays(gentle):
        return gentle
    reason = ROCKS.format(orientations[wanted].name)
    return replace(proposal, steady=False, remarks=(*proposal.remarks, reason))


def _isolate(
    orientations: Sequence[Orientation], shares: Floats, wanted: int, options: ChainOptions
) -> Design:
    """The design for parts that travel; where none isolates, one for parts that are placed, and said so."""
    proposal = design(orientations, shares, wanted, **options)
    travels = any(orientation.carry > 0.0 for orientation in orientations)
    if proposal.isolated or not travels or not options["constraints"].at_rest:
        return proposal
    options = options | {"constraints": replace(options["constraints"], vary=False, isolating=True)}
    still = design(placed(tuple(orientations)), shares, wanted, **options)
    return replace(still, remarks=(*still.remarks, TRACK_REMARK)) if still.isolated else proposal
