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
STAGES: tuple[dict[str, bool], ...] = ({"clearing": False}, {}, {"sensed": True})
RAIL = 1e-3  # [m] least width of a rail, and of the sheet it is cut from
# a part that lies along the wall is askew: its shank's tip lies nearer to the wall than its weight, and has
# to be over the slot. The lead-in reaches so far under it, in radii of the shank, and so much at least
SINKS, WIDER = 0.5, 3e-4  # [1], [m]
LEAD_IN_MARGIN_M = 4e-4  # [m] by which the lead-in is narrower than the head at least
CONE = 0.5  # a head whose underside rises by more is one
STRAIGHT, TAPER = 1.5, 1.0  # lengths of the part in which it goes down, and in which the slot narrows


def design_rails(given):
    """Return the chain that ends in rails in which an orientation hangs.

    Parameters
    ----------
    given : DesignTask
        The slot is wider than the shank and narrower than the head by its margin at least.

    Returns
    -------
    Design or None
        None where the part has no head, lies elsewhere than over the slot, or others are left over.
    """
    every, wanted, margin = given.every, given.wanted, given.margin
    device = _slot_between(every[wanted], margin, given.constraints.step)
    if device is None or every[wanted].returned:
        return None
    found = [verdict(device, one, every) for one in every]
    same = np.array([one.hangs and one.margin >= margin for one in found])
    if not same[wanted]:
        return None
    margins = np.array([one.margin for one in found])
    at_rails = np.array([chain.margin_at(device, one, every) for one in every])  # NaN of what stands there
    gone = (at_rails <= -margin) | ~given.stays | (given.coming <= 0.0)
    passed = gone | same
    for stage in STAGES:
        if not stage.get("sensed") or given.constraints.sensed:
            cuts, returned = _before(given, passed, same, stage)
        left = ~returned & ~passed & given.often
        jams = (left & np.isnan(at_rails)).any()  # however seldom it comes, it blocks the rails
        if not jams and given.coming[left].sum() <= given.allowed_beside(same):
            break
    else:
        return None
    returned |= gone
    last = chain.judge_cut(
        every, wanted, device, margins <= -margin, *_ends(every[wanted], device, given.constraints.step)
    )
    return propose_needed(given, (*cuts, last), returned, same)


def _before(given, passed, same, stage):
    """Cuts before the rails that return what they neither let hang nor return, and which those return."""
    alike = np.flatnonzero(same & given.often)
    found = chain.candidates(given.every, given.wanted, given.margin, given.constraints, same=alike, **stage)
    found = {
        device: some for device, some in found.items() if (some[same & given.often] >= given.margin).all()
    }
    devices = chain.fewest(found, np.where(passed, 0.0, weights(given)), given.margin)
    if not devices:
        return (), passed & ~same
    must = [some & ~passed for some in chain.shared_out(found, devices, given.margin)]
    cuts = chain.place_devices(
        given.every, given.wanted, devices, must, step=given.constraints.step, same=alike
    )
    return cuts, np.any([np.zeros(len(passed), bool), *must], axis=0)


def _slot_between(one, margin, step):
    """Rails about the foot of the centre of mass, as practice has them; None without a head.

    The slot is a little wider than the shank, the head clear of the wall, and the rail at the wall at least
    as wide as its sheet is thick. None where that leaves the weight beside the slot, or no rail at the free
    edge of the track.
    """
    found = neck(one)
    if found is None or found.head - found.shank < 2.0 * margin:
        return None
    play = min(max(PLAY, margin), 0.5 * (found.head - found.shank), MOST)
    return _rails(one, found, found.shank + play, step)


def _ends(one, device, step):
    found = neck(one)
    return tuple(_rails(one, found, width, step) or device for width in (found.shank, found.head))


def _rails(one, found, width, step):
    width = snap_to_shop_step(width, step, up=True)
    middle = max(one.distance - one.shift, 0.5 * found.widest + HEAD_WALL_CLEARANCE_M, 0.5 * width + RAIL)
    first = snap_to_shop_step(middle - 0.5 * width, step, up=True)
    span = round_finely(first), round_finely(first + width)
    lead = _lead(one, found, span, step)
    if lead[1] >= one.track.width - RAIL or not lead[0] < one.distance - one.shift < lead[1]:
        return None
    return Rails(chain.DESIGN_KEY, span=span, lead=lead).rewritten()


def _lead(one, found, span, step):
    """Lead-in [m] of a slot: from under the tip of a shank that lies askew to as far beyond its middle.

    It is so narrow that a head with a flat underside rests on both rails wherever the shank stands in it:
    with its shank at one rail and none under its head at the other it hangs askew and stays; a cone does not.
    """
    tip = one.distance - one.shift + found.tip - SINKS * 0.5 * found.shank
    near = max(min(tip, span[0] - WIDER), RAIL)
    near = min(snap_to_shop_step(near, step, up=True), span[0])
    far = max(
        span[1] + WIDER, found.widest + 2.0 * HEAD_WALL_CLEARANCE_M - near
    )  # its middle as clear of the wall
    held = 0.2 if found.rise > CONE else 0.5
    far = min(far, near + found.head - max(LEAD_IN_MARGIN_M, held * (found.head - found.shank)))
    far = max(snap_to_shop_step(far, step, up=False), span[1])
    sizes = (snap_to_shop_step(share * one.length, step, up=True) for share in (STRAIGHT, TAPER))
    return tuple(round_finely(size) for size in (near, far, *sizes))


TURNER_STEP_M = 1e-4  # [m] to which a height or width is rounded
TURNER_GAIN = 1.05  # a chain is tried if it brings so many times what the best shorter one does
TRIED = 4  # chains of each length
MAX_STEP_SHARE = 0.5  # of the part's greatest length: over a higher step it tumbles freely


def turning_chains(given):
    """Return the chains worth a design behind them: those that bring most parts into the wanted orientation.

    Parameters
    ----------
    given : DesignTask

    Returns
    -------
    list of tuple of Cut
        Single devices first, then pairs; their order matters.
    """
    devices = [device for device in _devices(given) if _sure(given, device)]
    matrices = {device: _counted(given, device) for device in devices}
    start, found = given.coming[given.wanted], []
    for count in (1, 2):
        some = [
            (_share_after(given, [matrices[device] for device in chosen]), chosen)
            for chosen in itertools.permutations(devices, count)
        ]
        best = sorted(
            (one for one in some if one[0] > TURNER_GAIN * start), key=lambda one: -round(one[0], 9)
        )
        found += [chosen for _, chosen in best[:TRIED]]
        start = max([start, *(brought for brought, _ in best)])
    return [_cuts(given, chosen) for chosen in found]


def _devices(given):
    """Steps and ledges, one between each two values at which what they do changes."""
    every = given.every
    often = [one for one, some in zip(every, given.often & given.stays) if some]
    longest = max((max(one.length, one.height) for one in often), default=0.0)
    kinds = [kind for kind in KINDS.values() if kind.turns]
    made = [_device(kind, one) for kind in kinds for one in _heights_between(_changes(given, kind))]
    return [one for one in made if one.inwards or one.limit <= MAX_STEP_SHARE * longest]


def _changes(given, kind):
    """Values [m] at which a device changes what it does with an orientation that comes often, ascending."""
    often = [one for one, some in zip(given.every, given.often & given.stays) if some]
    return kind.changes([DeviceEncounter(one, given.every) for one in often])


def _heights_between(known):
    """Rounded middles between ascending values, and one above them all."""
    middles = [0.5 * (low + high) for low, high in itertools.pairwise(known)]
    middles += [1.1 * known[-1]] if known else []
    return sorted(
        {round(round(one / TURNER_STEP_M) * TURNER_STEP_M, 9) for one in middles if one > 2.0 * TURNER_STEP_M}
    )


def _device(kind, limit):
    return kind(DESIGN_KEY).valued(float(limit))


def _sure(given, device):
    """Whether a device does by the margin with the wanted orientation what it does."""
    return verdict(device, given.every[given.wanted], given.every).margin >= given.margin


def _matrix(given, device):
    return course((device,), given.every).matrices[0]


def _counted(given, device):
    """Matrix of a device in which what momentum may decide counts as lost."""
    matrix = np.array(_matrix(given, device))
    some = [verdict(device, one, given.every).margin >= given.margin for one in given.every]
    matrix[~np.array(some)] = 0.0
    return matrix


def _share_after(given, matrices):
    """Share of the parts that is in the wanted orientation behind some devices."""
    share = given.coming
    for matrix in matrices:
        share = np.einsum("i,ij->j", share, matrix)
    return float(share[given.wanted])


def _around(known, limit):
    """The values nearest to a limit at which what its device does changes; itself where there is none."""
    below = [one for one in known if one <= limit]
    above = [one for one in known if one >= limit]
    return max(below, default=limit), min(above, default=limit)


def _cuts(given, devices):
    """Turning devices as cuts of a design, the second with what the first brings to it."""
    cuts, coming = [], given.coming
    for device in devices:
        listed = [verdict(device, one, given.every) for one in given.every]
        moved = [
            (given.every[k].name, given.every[onto].name, float(share))
            for k, one in enumerate(listed)
            for onto, share in one.onto
            if onto != k and coming[k] >= LEAST_SHARE
        ]
        often = [one.margin for one, share in zip(listed, coming) if share >= LEAST_SHARE]
        below, above = _around(_changes(given, type(device)), device.limit)
        cuts.append(
            Cut(
                device=device,
                margin_pass=float(min((one for one in often if one >= given.margin), default=np.nan)),
                margin_reject=np.nan,
                smallest=_device(type(device), below),
                largest=_device(type(device), above),
                returns=(),
                turns=tuple(moved),
            )
        )
        coming = np.einsum("i,ij->j", coming, _matrix(given, device))
    return tuple(cuts)


VARIED_SWEEPS_DEG = (20.0, 45.0, 55.0)  # [deg] beside the 30 deg of the first design


def varied_devices(every, wanted, margin, constraints, same=()):
    """Return blades of sweeps that are not tried first, with the margin of each orientation at them.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    every : sequence of Orientation
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
    found: dict[Device, np.ndarray] = {}
    for kind in (kind for kind in chain.numbered() if kind.overhead and constraints.allows(kind.kind)):
        highest = every[chain.pivot(kind, every, wanted, same)].height
        limit = snap_to_shop_step(highest + margin, constraints.step, up=True)
        swept = [
            replace(kind.proposal(chain.DESIGN_KEY, limit), sweep=math.radians(sweep))
            for sweep in VARIED_SWEEPS_DEG
        ]
        found |= {one: _margins(one, every) for one in swept if one.clear_of(every[wanted].grip)}
    return found


def _margins(device, every):
    return np.array([chain.margin_at(device, one, every) for one in every])


MARGIN_M = 1.5e-4  # [m] to either side, beside ...
PLAY_M, TOLERANCE_M = 5e-5, 5e-5  # [m] ... what parts come off the wall, and what their size is off
TOTAL_MARGIN_M = MARGIN_M + PLAY_M + TOLERANCE_M  # [m]
MOST_HOLES = 3  # cut-outs in one chain
PURITY_GAIN = 1e-2  # [1] purity by which a chain of varied devices is better
GAIN = 1.25  # turning devices are taken where they bring so many times the parts, if no efficiency is asked


def design(
    every, shares, wanted, *, margin=TOTAL_MARGIN_M, search=None, goal=ALL, before=(), constraints=None
):
    """Return the chain of fewest devices that isolates an orientation.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    every : sequence of Orientation
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
    given = asked_for(every, shares, wanted, margin, goal.purity, before, constraints=constraints)
    found = _returning(given, search.started())
    if given.constraints.turn and not (found.isolated and found.efficiency >= goal.efficiency > 0.0):
        found = _with_turning(given, found, search, goal.efficiency)
    short = _short(given, found, goal.efficiency)
    return replace(found, reasons=(*found.reasons, *short)) if short else found


def _returning(given, search):
    """The best chain of devices that only return parts: they leave lying, or hanging."""
    if any(device.hangs for device in given.before):
        return propose(given, (), np.zeros(len(given.every), dtype=bool))
    outcome = given.constraints.outcome
    hung = (
        design_rails(given) if outcome != "lying" and given.constraints.allows(*names(hangs=True)) else None
    )
    if outcome == "hanging":
        return without_device(given, "does not hang between rails") if hung is None else hung
    found = _plain(given, search)
    if hung is None or (hung.isolated, hung.efficiency) <= (found.isolated, found.efficiency):
        return found
    return hung


def _with_turning(given, found, search, efficiency):
    """The design with turning devices before all others, where it delivers enough more."""
    enough = GAIN if efficiency <= 0.0 else 1.0
    for cuts in turning_chains(given):
        behind = asked_for(
            given.every, given.shares, given.wanted, given.margin, given.purity, given.before,
            cuts, given.constraints,
        )  # fmt: skip
        other = _returning(behind, search.started())
        more = other.efficiency > enough * found.efficiency + 1e-12
        if other.isolated and (more or not found.isolated):
            found = other
        if efficiency > 0.0 and found.isolated and found.efficiency >= efficiency:
            break
    return found


def _short(given, found, efficiency):
    """By how much what was asked for is missed, and why, a sentence each."""
    one, said = given.every[given.wanted], []
    if found.efficiency < efficiency:
        comes = given.shares[given.wanted] / given.shares.sum()
        why = (
            f"{100.0 * comes:.3g} % of the parts come as {one.name}, and devices that return parts add none; "
            "`turn` allows devices that turn parts over"
        )
        if given.constraints.turn:
            why = "no step or ledge, nor two of them, turns more parts into it that can then be isolated"
        miss = 100.0 * (efficiency - found.efficiency)
        said.append(f"the efficiency asked for is missed by {miss:.3g} % of the parts: {why}")
    if given.purity < 1.0 and found.purity < given.purity - 1e-12:
        miss = 100.0 * (given.purity - found.purity)
        said.append(f"the purity asked for is missed by {miss:.3g} % of what leaves")
    return said


def _plain(given, search):
    """The chain of devices that return the others and leave the wanted one lying."""
    every, wanted = given.every, given.wanted
    if every[wanted].turns_over:
        return without_device(given, "can tip over on the track at this drive")
    if every[wanted].may_roll_back:
        return without_device(given, "lies on its round side, not along the track, and can roll back")
    if every[wanted].falls_off or not every[wanted].margin > 0.0:
        return without_device(given, "falls off the bare track")
    if not given.coming[wanted] > 0.0 and given.shares[wanted] > 0.0:
        return without_device(given, "is returned by the devices of the bowl file")
    weight = weights(given)
    weight[given.same] = 0.0
    holes = (
        given.constraints.allows(*names(searched=True)) and given.same.sum() == 1
    )  # for one orientation alone
    stages = ({"clearing": False}, {}) if given.constraints.clearing else ({"clearing": False},)
    for stage in stages:
        cuts, returned = _chosen(given, weight, stage)
        if not _left(given, returned):
            break
    found = propose_needed(given, cuts, returned)
    sensed = {"sensed": given.constraints.sensed}
    for stage in (sensed, sensed | {"varied": given.constraints.vary}):
        if found.isolated or not any(stage.values()):
            continue
        other = propose_needed(given, *_chosen(given, weight, stage))
        purer = stage.get("varied") and other.purity > found.purity + PURITY_GAIN
        found = other if other.isolated or purer else found
    if holes and not found.isolated:  # by far the longest search: only where nothing simpler isolates
        more = propose_needed(given, *_with_holes(given, cuts, returned, search))
        if more.isolated or (not more.stands and (found.stands or not _purer(found, more))):
            found = more
    return replace(found, late=search.late)


def _purer(found, other):
    """Whether a design leaves purer parts than another one."""
    return bool(np.nan_to_num(found.purity) > np.nan_to_num(other.purity) + PURITY_GAIN)


def _chosen(given, weight, stage) -> tuple[Any, np.ndarray]:
    """Cuts of the fewest devices of a stage, and which orientations are returned."""
    every, wanted = given.every, given.wanted
    same = np.flatnonzero(given.same & given.often)
    alike, more = given.same & given.often, stage.get("varied", False)
    asked = {name: value for name, value in stage.items() if name != "varied"}
    found = chain.candidates(every, wanted, given.margin, given.constraints, same=same, **asked)
    if more:
        found |= varied_devices(every, wanted, given.margin, given.constraints, same)
        found = dict(sorted(found.items(), key=lambda item: bool(item[0].like)))  # what sees comes last
    found = {device: some for device, some in found.items() if (some[alike] >= given.margin).all()}
    counted = np.where(weight > 0.0, given.coming, 0.0) if given.purity < 1.0 else weight
    devices = chain.fewest(found, counted, given.margin, given.allowed)
    gone = ~given.stays | ((given.coming <= 0.0) & (given.shares > 0.0))
    must = [some & ~gone for some in chain.shared_out(found, devices, given.margin)] if devices else []
    least = given.margin if given.constraints.gentle else np.inf
    cuts = chain.place_devices(every, wanted, devices, must, least, given.constraints.step, same)
    return cuts, np.any([gone, *must], axis=0)


def _left(given, returned):
    """Whether others that come often enough are left over."""
    left = ~returned & given.often & ~given.same
    return bool(given.coming[left].sum() > given.allowed) if left.any() else False


def _with_holes(given, cuts, returned, search):
    """Add cut-outs for those that are left, as long as one returns any."""
    returned = returned.copy()
    for _ in range(MOST_HOLES):
        left = [k for k in np.flatnonzero(~returned) if k != given.wanted and given.often[k]]
        if given.coming[left].sum() <= given.allowed:
            break
        left = [k for k in left if not stands_on_all(given.every[k], given.every[given.wanted], given.margin)]
        play = given.margin + given.every[given.wanted].flight  # a hole so much shorter may be jumped
        made = hole_search.cut_out(given.every, given.wanted, left, play, search) if left else None
        if made is not None and given.constraints.cutter > 0.0:
            made = hole_search.round_corners(given, made, given.constraints.cutter)
        if made is None:
            break
        cuts, returned[made[1]] = (*cuts, made[0]), True
    return cuts, returned


def place(every, aspect, heading, source):
    """Return the place of an orientation of the part of a file by its aspect and, where given, heading [rad].

    Raises
    ------
    ArgumentError
        If the part has no such orientation.
    """
    known = rows([one.aspect for one in every], aspect, f"aspect of {source}", ArgumentError)
    if heading is not None:
        return place_of(every, aspect, heading, f"heading of {source}", kind=ArgumentError)
    return max(known, key=lambda k: (not every[k].returned, every[k].heading_share, -k))
