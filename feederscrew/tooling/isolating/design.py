"""Which devices let one orientation leave and return all the others."""

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.errors import ArgumentError
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.kinds import KINDS, names
from feederscrew.tooling.devices.ledges import Rails
from feederscrew.tooling.devices.orientation_names import place_of, rows
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating import chain, hole_search
from feederscrew.tooling.isolating.chain import (
    DESIGN_KEY,
    Cut,
    round_finely,
    snap_to_shop_step,
    stands_on_all,
)
from feederscrew.tooling.isolating.proposal import (
    ALL,
    LEAST_SHARE,
    propose,
    propose_needed,
    weights,
    without_device,
)
from feederscrew.tooling.isolating.proposal import design_task as asked_for
from feederscrew.tooling.orientations import neck
from feederscrew.tooling.verdicts import DeviceEncounter, verdict

PLAY, MOST = 4e-4, 6e-4  # [m] by which a slot is wider than the shank: 0.2 to 0.6 mm
HEAD_WALL_CLEARANCE_M = 4e-4  # [m] between a hanging head and the wall, wherever the shank stands in its slot
# drops first, then what clears itself, then what sees
STAGES: tuple[dict[str, bool], ...] = ({"clearing": False}, {}, {"air": True}, {"sensed": True})
RAIL = 1e-3  # [m] least width of a rail, and of the sheet it is cut from
# a part that lies along the wall is askew: its shank's tip lies nearer to the wall than its weight, and has
# to be over the slot. The lead-in reaches so far under it, in radii of the shank, and so much at least
SINKS, WIDER = 0.5, 3e-4  # [1], [m]
LEAD_IN_MARGIN_M = 4e-4  # [m] by which the lead-in is narrower than the head at least
CONE = 0.5  # a head whose underside rises by more is one
STRAIGHT, TAPER = 1.5, 1.0  # lengths of the part in which it goes down, and in which the slot narrows


def design_rails(task):
    """Return the chain that ends in rails in which an orientation hangs.

    Parameters
    ----------
    task : DesignTask
        The slot is wider than the shank and narrower than the head by its margin at least.

    Returns
    -------
    Design or None
        None where the part has no head, lies elsewhere than over the slot, or others are left over.
    """
    orientations, wanted, margin = task.orientations, task.wanted, task.margin
    device = _slot_between(orientations[wanted], margin, task.constraints.step)
    if device is None or orientations[wanted].returned:
        return None
    outcomes = [verdict(device, orientation, orientations) for orientation in orientations]
    same = np.array([outcome.hangs and outcome.margin >= margin for outcome in outcomes])
    if not same[wanted]:
        return None
    margins = np.array([outcome.margin for outcome in outcomes])
    at_rails = np.array(
        [chain.margin_at(device, orientation, orientations) for orientation in orientations]
    )  # NaN of what stands there
    gone = (at_rails <= -margin) | ~task.stays | (task.coming <= 0.0)
    passed = gone | same
    for stage in STAGES:
        if all(getattr(task.constraints, name) for name in ("air", "sensed") if stage.get(name)):
            cuts, returned = _before(task, passed, same, stage)
        left = ~returned & ~passed & task.often
        jams = (left & np.isnan(at_rails)).any()  # however seldom it comes, it blocks the rails
        if not jams and task.coming[left].sum() <= task.allowed_beside(same):
            break
    else:
        return None
    returned |= gone
    last = chain.judge_cut(
        orientations,
        wanted,
        device,
        margins <= -margin,
        *_ends(orientations[wanted], device, task.constraints.step),
    )
    return propose_needed(task, (*cuts, last), returned, same)


def _before(task, passed, same, stage) -> tuple[Any, ...]:
    """Cuts before the rails that return what they neither let hang nor return, and which those return."""
    equals = np.flatnonzero(same & task.often)
    margins = chain.candidates(
        task.orientations, task.wanted, task.margin, task.constraints, same=equals, **stage
    )
    margins = {
        device: some for device, some in margins.items() if (some[same & task.often] >= task.margin).all()
    }
    devices = chain.fewest(margins, np.where(passed, 0.0, weights(task)), task.margin)
    if not devices:
        return (), passed & ~same
    must = [some & ~passed for some in chain.shared_out(margins, devices, task.margin)]
    cuts = chain.place_devices(
        task.orientations, task.wanted, devices, must, step=task.constraints.step, same=equals
    )
    return cuts, np.any([np.zeros(len(passed), bool), *must], axis=0)


def _slot_between(orientation, margin, step):
    """Rails about the foot of the centre of mass, as practice has them; None without a head.

    The slot is a little wider than the shank, the head clear of the wall, and the rail at the wall at least
    as wide as its sheet is thick. None where that leaves the weight beside the slot, or no rail at the free
    edge of the track.
    """
    headed = neck(orientation)
    if headed is None or headed.head - headed.shank < 2.0 * margin:
        return None
    play = min(max(PLAY, margin), 0.5 * (headed.head - headed.shank), MOST)
    return _rails(orientation, headed, headed.shank + play, step)


def _ends(orientation, device, step) -> tuple[Any, ...]:
    headed = neck(orientation)
    return tuple(_rails(orientation, headed, width, step) or device for width in (headed.shank, headed.head))


def _rails(orientation, headed, width, step):
    width = snap_to_shop_step(width, step, up=True)
    middle = max(
        orientation.distance - orientation.shift,
        0.5 * headed.widest + HEAD_WALL_CLEARANCE_M,
        0.5 * width + RAIL,
    )
    first = snap_to_shop_step(middle - 0.5 * width, step, up=True)
    span = round_finely(first), round_finely(first + width)
    lead = _lead(orientation, headed, span, step)
    if (
        lead[1] >= orientation.track.width - RAIL
        or not lead[0] < orientation.distance - orientation.shift < lead[1]
    ):
        return None
    return Rails(chain.DESIGN_KEY, span=span, lead=lead).rewritten()


def _lead(orientation, headed, span, step) -> tuple[Any, ...]:
    """Lead-in [m] of a slot: from under the tip of a shank that lies askew to as far beyond its middle.

    It is so narrow that a head with a flat underside rests on both rails wherever the shank stands in it:
    with its shank at one rail and none under its head at the other it hangs askew and stays; a cone does not.
    """
    tip = orientation.distance - orientation.shift + headed.tip - SINKS * 0.5 * headed.shank
    near = max(min(tip, span[0] - WIDER), RAIL)
    near = min(snap_to_shop_step(near, step, up=True), span[0])
    far = max(
        span[1] + WIDER, headed.widest + 2.0 * HEAD_WALL_CLEARANCE_M - near
    )  # its middle as clear of the wall
    held = 0.2 if headed.rise > CONE else 0.5
    far = min(far, near + headed.head - max(LEAD_IN_MARGIN_M, held * (headed.head - headed.shank)))
    far = max(snap_to_shop_step(far, step, up=False), span[1])
    sizes = (snap_to_shop_step(share * orientation.length, step, up=True) for share in (STRAIGHT, TAPER))
    return tuple(round_finely(size) for size in (near, far, *sizes))


TURNER_STEP_M = 1e-4  # [m] to which a height or width is rounded
TURNER_GAIN = 1.05  # a chain is tried if it brings so many times what the best shorter one does
TRIED = 4  # chains of each length
MAX_STEP_SHARE = 0.5  # of the part's greatest length: over a higher step it tumbles freely


def turning_chains(task) -> list[Any]:
    """Return the chains worth a design behind them: those that bring most parts into the wanted orientation.

    Parameters
    ----------
    task : DesignTask

    Returns
    -------
    list of tuple of Cut
        Single devices first, then pairs; their order matters.
    """
    devices = [device for device in _devices(task) if _sure(task, device)]
    matrices = {device: _counted(task, device) for device in devices}
    start, chains = task.coming[task.wanted], []
    for count in (1, 2):
        some = [
            (_share_after(task, [matrices[device] for device in chosen]), chosen)
            for chosen in itertools.permutations(devices, count)
        ]
        best = sorted(
            (orientation for orientation in some if orientation[0] > TURNER_GAIN * start),
            key=lambda orientation: -round(orientation[0], 9),
        )
        chains += [chosen for _, chosen in best[:TRIED]]
        start = max([start, *(share for share, _ in best)])
    return [_cuts(task, chosen) for chosen in chains]


def _devices(task) -> list[Any]:
    """Steps and ledges, one between each two values at which what they do changes."""
    orientations = task.orientations
    often = [orientation for orientation, some in zip(orientations, task.often & task.stays) if some]
    longest = max((max(orientation.length, orientation.height) for orientation in often), default=0.0)
    kinds = [kind for kind in KINDS.values() if kind.turns]
    turners = [
        _device(kind, orientation) for kind in kinds for orientation in _heights_between(_changes(task, kind))
    ]
    return [turner for turner in turners if turner.inwards or turner.limit <= MAX_STEP_SHARE * longest]


def _changes(task, kind):
    """Values [m] at which a device changes what it does with an orientation that comes often, ascending."""
    often = [orientation for orientation, some in zip(task.orientations, task.often & task.stays) if some]
    return kind.changes([DeviceEncounter(orientation, task.orientations) for orientation in often])


def _heights_between(heights) -> list[Any]:
    """Rounded middles between ascending values, and one above them all."""
    middles = [0.5 * (low + high) for low, high in itertools.pairwise(heights)]
    middles += [1.1 * heights[-1]] if heights else []
    return sorted(
        {
            round(round(middle / TURNER_STEP_M) * TURNER_STEP_M, 9)
            for middle in middles
            if middle > 2.0 * TURNER_STEP_M
        }
    )


def _device(kind, limit):
    return kind(DESIGN_KEY).valued(float(limit))


def _sure(task, device):
    """Whether a device does by the margin with the wanted orientation what it does."""
    return verdict(device, task.orientations[task.wanted], task.orientations).margin >= task.margin


def _matrix(task, device):
    return course((device,), task.orientations).matrices[0]


def _counted(task, device):
    """Matrix of a device in which what momentum may decide counts as lost."""
    matrix = np.array(_matrix(task, device))
    some = [
        verdict(device, orientation, task.orientations).margin >= task.margin
        for orientation in task.orientations
    ]
    matrix[~np.array(some)] = 0.0
    return matrix


def _share_after(task, matrices) -> float:
    """Share of the parts that is in the wanted orientation behind some devices."""
    share = task.coming
    for matrix in matrices:
        share = np.einsum("i,ij->j", share, matrix)
    return float(share[task.wanted])


def _around(heights, limit) -> tuple[Any, ...]:
    """The values nearest to a limit at which what its device does changes; itself where there is none."""
    below = [height for height in heights if height <= limit]
    above = [height for height in heights if height >= limit]
    return max(below, default=limit), min(above, default=limit)


def _cuts(task, devices) -> tuple[Any, ...]:
    """Turning devices as cuts of a design, the second with what the first brings to it."""
    cuts, coming = [], task.coming
    for device in devices:
        listed = [verdict(device, orientation, task.orientations) for orientation in task.orientations]
        moved = [
            (task.orientations[k].name, task.orientations[onto].name, float(share))
            for k, orientation in enumerate(listed)
            for onto, share in orientation.onto
            if onto != k and coming[k] >= LEAST_SHARE
        ]
        often = [orientation.margin for orientation, share in zip(listed, coming) if share >= LEAST_SHARE]
        below, above = _around(_changes(task, type(device)), device.limit)
        cuts.append(
            Cut(
                device=device,
                margin_pass=float(
                    min((orientation for orientation in often if orientation >= task.margin), default=np.nan)
                ),
                margin_reject=np.nan,
                smallest=_device(type(device), below),
                largest=_device(type(device), above),
                returns=(),
                turns=tuple(moved),
            )
        )
        coming = np.einsum("i,ij->j", coming, _matrix(task, device))
    return tuple(cuts)


VARIED_SWEEPS_DEG = (20.0, 45.0, 55.0)  # [deg] beside the 30 deg of the first design


def varied_devices(orientations, wanted, margin, constraints, same=()):
    """Return blades of sweeps that are not tried first, with the margin of each orientation at them.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    orientations : sequence of Orientation
    wanted : int
    margin : float [m]
    constraints : DesignConstraints
    same : sequence of int
        Those that count as the wanted one.

    Returns
    -------
    dict of Device to (M,) float [m]
        As from ``chain.candidates``.
    """
    margins: dict[Device, np.ndarray] = {}
    for kind in (kind for kind in chain.numbered() if kind.overhead and constraints.allows(kind.kind)):
        highest = orientations[chain.pivot(kind, orientations, wanted, same)].height
        limit = snap_to_shop_step(highest + margin, constraints.step, up=True)
        swept = [
            replace(kind.proposal(chain.DESIGN_KEY, limit), sweep=math.radians(sweep))
            for sweep in VARIED_SWEEPS_DEG
        ]
        margins |= {
            orientation: _margins(orientation, orientations)
            for orientation in swept
            if orientation.clear_of(orientations[wanted].grip)
        }
    return margins


def _margins(device, orientations) -> np.ndarray:
    return np.array([chain.margin_at(device, orientation, orientations) for orientation in orientations])


DESIGN_MARGIN_M = 1.5e-4  # [m] to either side, beside ...
PLAY_M, TOLERANCE_M = 5e-5, 5e-5  # [m] ... what parts come off the wall, and what their size is off
TOTAL_MARGIN_M = DESIGN_MARGIN_M + PLAY_M + TOLERANCE_M  # [m]
MOST_HOLES = 3  # cut-outs in one chain
PURITY_GAIN = 1e-2  # [1] purity by which a chain of varied devices is better
GAIN = 1.25  # turning devices are taken where they bring so many times the parts, if no efficiency is asked


def design(
    orientations, shares, wanted, *, margin=TOTAL_MARGIN_M, search=None, goal=ALL, before=(), constraints=None
):
    """Return the chain of fewest devices that isolates an orientation.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    orientations : sequence of Orientation
        Of the part on the track.
    shares : (M,) float [1]
        Probability of each.
    wanted : int
        Which one.
    margin : float [m]
        To either side.
    search : hole_search.HoleSearch, optional
        Seed and limits of the search for holes.
    goal : proposal.Goal
        Purity and efficiency that are enough.
    before : sequence of Device
        Of the bowl itself: the design is found behind them.
    constraints : DesignConstraints, optional
        How parts leave, which devices may be used, holes of several corners ('cut_out') and those that turn
        parts over among them, the step of values, and whether cuts leave as much of the wanted orientation's
        foot as returning the others allows.

    Returns
    -------
    Design
    """
    search = search or hole_search.HoleSearch()
    task = asked_for(orientations, shares, wanted, margin, goal.purity, before, constraints=constraints)
    proposal = _returning(task, search.started())
    if task.constraints.turn and not (proposal.isolated and proposal.efficiency >= goal.efficiency > 0.0):
        proposal = _with_turning(task, proposal, search, goal.efficiency)
    short = _short(task, proposal, goal.efficiency)
    return replace(proposal, remarks=(*proposal.remarks, *short)) if short else proposal


def _returning(task, search):
    """The best chain of devices that only return parts: they leave lying, or hanging."""
    if any(device.hangs for device in task.before):
        return propose(task, (), np.zeros(len(task.orientations), dtype=bool))
    outcome = task.constraints.outcome
    hung = design_rails(task) if outcome != "lying" and task.constraints.allows(*names(hangs=True)) else None
    if outcome == "hanging":
        return without_device(task, "does not hang between rails") if hung is None else hung
    lying = _plain(task, search)
    if hung is None or (hung.isolated, hung.efficiency) <= (lying.isolated, lying.efficiency):
        return lying
    return hung


def _with_turning(task, proposal, search, efficiency):
    """The design with turning devices before all others, where it delivers enough more."""
    enough = GAIN if efficiency <= 0.0 else 1.0
    for cuts in turning_chains(task):
        behind = asked_for(
            task.orientations, task.shares, task.wanted, task.margin, task.purity, task.before,
            cuts, task.constraints,
        )  # fmt: skip
        other = _returning(behind, search.started())
        more = other.efficiency > enough * proposal.efficiency + 1e-12
        if other.isolated and (more or not proposal.isolated):
            proposal = other
        if efficiency > 0.0 and proposal.isolated and proposal.efficiency >= efficiency:
            break
    return proposal


def _short(task, proposal, efficiency):
    """By how much what was asked for is missed, and why, a sentence each."""
    orientation, reasons = task.orientations[task.wanted], []
    if proposal.efficiency < efficiency:
        comes = task.shares[task.wanted] / task.shares.sum()
        why = (
            f"{100.0 * comes:.3g} % of the parts come as {orientation.name}, and devices that return parts "
            "add none; `turn` allows devices that turn parts over"
        )
        if task.constraints.turn:
            why = "no step or ledge, nor two of them, turns more parts into it that can then be isolated"
        miss = 100.0 * (efficiency - proposal.efficiency)
        reasons.append(f"the efficiency asked for is missed by {miss:.3g} % of the parts: {why}")
    if task.purity < 1.0 and proposal.purity < task.purity - 1e-12:
        miss = 100.0 * (task.purity - proposal.purity)
        reasons.append(f"the purity asked for is missed by {miss:.3g} % of what leaves")
    return reasons


def _plain(task, search):
    """The chain of devices that return the others and leave the wanted one lying."""
    orientations, wanted = task.orientations, task.wanted
    if orientations[wanted].turns_over:
        return without_device(task, "can tip over on the track at this drive")
    if orientations[wanted].may_roll_back:
        return without_device(task, "lies on its round side, not along the track, and can roll back")
    if orientations[wanted].falls_off or not orientations[wanted].margin > 0.0:
        return without_device(task, "falls off the bare track")
    if not task.coming[wanted] > 0.0 and task.shares[wanted] > 0.0:
        return without_device(task, "is returned by the devices of the bowl file")
    weight = weights(task)
    weight[task.same] = 0.0
    holes = (
        task.constraints.allows(*names(searched=True)) and task.same.sum() == 1
    )  # for one orientation alone
    stages = ({"clearing": False}, {}) if task.constraints.clearing else ({"clearing": False},)
    for stage in stages:
        cuts, returned = _chosen(task, weight, stage)
        if not _left(task, returned):
            break
    proposal = propose_needed(task, cuts, returned)
    air, sensed = {"air": task.constraints.air}, {"sensed": task.constraints.sensed}
    for stage in (air, sensed, sensed | {"varied": task.constraints.vary}):
        if proposal.isolated or not any(stage.values()):
            continue
        other = propose_needed(task, *_chosen(task, weight, stage))
        purer = stage.get("varied") and other.purity > proposal.purity + PURITY_GAIN
        proposal = other if other.isolated or purer else proposal
    if holes and not proposal.isolated:  # by far the longest search: only where nothing simpler isolates
        more = propose_needed(task, *_with_holes(task, cuts, returned, search))
        if more.isolated or (not more.stands and (proposal.stands or not _purer(proposal, more))):
            proposal = more
    return replace(proposal, late=search.late)


def _purer(proposal, other) -> bool:
    """Whether a design leaves purer parts than another one."""
    return bool(np.nan_to_num(proposal.purity) > np.nan_to_num(other.purity) + PURITY_GAIN)


def _chosen(task, weight, stage) -> tuple[Any, np.ndarray]:
    """Cuts of the fewest devices of a stage, and which orientations are returned."""
    orientations, wanted = task.orientations, task.wanted
    same = np.flatnonzero(task.same & task.often)
    equals, more = task.same & task.often, stage.get("varied", False)
    stage_options = {name: value for name, value in stage.items() if name != "varied"}
    margins = chain.candidates(
        orientations, wanted, task.margin, task.constraints, same=same, **stage_options
    )
    if more:
        margins |= varied_devices(orientations, wanted, task.margin, task.constraints, same)
        margins = dict(sorted(margins.items(), key=lambda item: bool(item[0].like)))  # what sees comes last
    margins = {device: some for device, some in margins.items() if (some[equals] >= task.margin).all()}
    counted = np.where(weight > 0.0, task.coming, 0.0) if task.purity < 1.0 else weight
    devices = chain.fewest(margins, counted, task.margin, task.allowed)
    gone = ~task.stays | ((task.coming <= 0.0) & (task.shares > 0.0))
    must = [some & ~gone for some in chain.shared_out(margins, devices, task.margin)] if devices else []
    least = task.margin if task.constraints.gentle else np.inf
    cuts = chain.place_devices(orientations, wanted, devices, must, least, task.constraints.step, same)
    return cuts, np.any([gone, *must], axis=0)


def _left(task, returned) -> bool:
    """Whether others that come often enough are left over."""
    left = ~returned & task.often & ~task.same
    return bool(task.coming[left].sum() > task.allowed) if left.any() else False


def _with_holes(task, cuts, returned, search) -> tuple[Any, ...]:
    """Add cut-outs for those that are left, as long as one returns any."""
    returned = returned.copy()
    for _ in range(MOST_HOLES):
        left = [k for k in np.flatnonzero(~returned) if k != task.wanted and task.often[k]]
        if task.coming[left].sum() <= task.allowed:
            break
        left = [
            k
            for k in left
            if not stands_on_all(task.orientations[k], task.orientations[task.wanted], task.margin)
        ]
        play = task.margin + task.orientations[task.wanted].flight  # a hole so much shorter may be jumped
        hole = hole_search.cut_out(task.orientations, task.wanted, left, play, search) if left else None
        if hole is not None and task.constraints.cutter > 0.0:
            hole = hole_search.round_corners(task, hole, task.constraints.cutter)
        if hole is None:
            break
        cuts, returned[hole[1]] = (*cuts, hole[0]), True
    return cuts, returned


def place(orientations, aspect, heading, source):
    """Return the place of an orientation of the part of a file by its aspect and, where given, heading [rad].

    Raises
    ------
    ArgumentError
        If the part has no such orientation.
    """
    aspect_rows = rows(
        [orientation.aspect for orientation in orientations], aspect, f"aspect of {source}", ArgumentError
    )
    if heading is not None:
        return place_of(orientations, aspect, heading, f"heading of {source}", kind=ArgumentError)
    return max(aspect_rows, key=lambda k: (not orientations[k].returned, orientations[k].heading_share, -k))
