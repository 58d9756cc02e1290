"""Which devices let one orientation leave and return all the others."""

from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.errors import ArgumentError
from feederscrew.tooling.devices.kinds import names
from feederscrew.tooling.devices.named import place_of, rows
from feederscrew.tooling.isolating import chain, hole_search, rails, round_corners, turners, varied
from feederscrew.tooling.isolating.apart import stands_on_all
from feederscrew.tooling.isolating.needed import told_needed
from feederscrew.tooling.isolating.proposal import ALL, told, weights, without
from feederscrew.tooling.isolating.proposal import task as asked_for

MARGIN = 1.5e-4  # [m] to either side, beside ...
PLAY, TOLERANCE = 5e-5, 5e-5  # [m] ... what parts come off the wall, and what their size is off
WHOLE = MARGIN + PLAY + TOLERANCE  # [m]
MOST_HOLES = 3  # cut-outs in one chain
MORE = 1e-2  # [1] purity by which a chain of varied devices is better
GAIN = 1.25  # turning devices are taken where they bring so many times the parts, if no efficiency is asked


def design(every, shares, wanted, *, margin=WHOLE, search=None, goal=ALL, before=(), wishes=None):
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
    wishes : chain.Wishes, optional
        How parts leave, which devices may be used, holes of several corners ('cut_out') and those that turn
        parts over among them, the step of values, and whether cuts leave as much of the wanted orientation's
        foot as returning the others allows.

    Returns
    -------
    Design
    """
    search = search or hole_search.HoleSearch()
    given = asked_for(every, shares, wanted, margin, goal.purity, before, wishes=wishes)
    found = _returning(given, search.started())
    if given.wishes.turn and not (found.isolated and found.efficiency >= goal.efficiency > 0.0):
        found = _with_turning(given, found, search, goal.efficiency)
    short = _short(given, found, goal.efficiency)
    return replace(found, reasons=(*found.reasons, *short)) if short else found


def _returning(given, search):
    """The best chain of devices that only return parts: they leave lying, or hanging."""
    if any(device.hangs for device in given.before):
        return told(given, (), np.zeros(len(given.every), dtype=bool))
    outcome = given.wishes.outcome
    hung = rails.design(given) if outcome != "lying" and given.wishes.allows(*names(hangs=True)) else None
    if outcome == "hanging":
        return without(given, "does not hang between rails") if hung is None else hung
    found = _plain(given, search)
    if hung is None or (hung.isolated, hung.efficiency) <= (found.isolated, found.efficiency):
        return found
    return hung


def _with_turning(given, found, search, efficiency):
    """The design with turning devices before all others, where it delivers enough more."""
    enough = GAIN if efficiency <= 0.0 else 1.0
    for cuts in turners.chains(given):
        behind = asked_for(
            given.every, given.shares, given.wanted, given.margin, given.purity, given.before,
            cuts, given.wishes,
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
        if given.wishes.turn:
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
        return without(given, "can tip over on the track at this drive")
    if every[wanted].may_roll_back:
        return without(given, "lies on its round side, not along the track, and can roll back")
    if every[wanted].falls_off or not every[wanted].margin > 0.0:
        return without(given, "falls off the bare track")
    if not given.coming[wanted] > 0.0 and given.shares[wanted] > 0.0:
        return without(given, "is returned by the devices of the bowl file")
    weight = weights(given)
    weight[given.same] = 0.0
    holes = given.wishes.allows(*names(searched=True)) and given.same.sum() == 1  # for one orientation alone
    stages = ({"clearing": False}, {}) if given.wishes.clearing else ({"clearing": False},)
    for stage in stages:
        cuts, returned = _chosen(given, weight, stage)
        if not _left(given, returned):
            break
    found = told_needed(given, cuts, returned)
    air, sensed = {"air": given.wishes.air}, {"sensed": given.wishes.sensed}
    for stage in (air, sensed, sensed | {"varied": given.wishes.vary}):
        if found.isolated or not any(stage.values()):
            continue
        other = told_needed(given, *_chosen(given, weight, stage))
        purer = stage.get("varied") and other.purity > found.purity + MORE
        found = other if other.isolated or purer else found
    if holes and not found.isolated:  # by far the longest search: only where nothing simpler isolates
        more = told_needed(given, *_with_holes(given, cuts, returned, search))
        if more.isolated or (not more.stands and (found.stands or not _purer(found, more))):
            found = more
    return replace(found, late=search.late)


def _purer(found, other):
    """Whether a design leaves purer parts than another one."""
    return bool(np.nan_to_num(found.purity) > np.nan_to_num(other.purity) + MORE)


def _chosen(given, weight, stage) -> tuple[Any, np.ndarray]:
    """Cuts of the fewest devices of a stage, and which orientations are returned."""
    every, wanted = given.every, given.wanted
    same = np.flatnonzero(given.same & given.often)
    alike, more = given.same & given.often, stage.get("varied", False)
    asked = {name: value for name, value in stage.items() if name != "varied"}
    found = chain.candidates(every, wanted, given.margin, given.wishes, same=same, **asked)
    if more:
        found |= varied.varied(every, wanted, given.margin, given.wishes, same)
        found = dict(sorted(found.items(), key=lambda item: bool(item[0].like)))  # what sees comes last
    found = {device: some for device, some in found.items() if (some[alike] >= given.margin).all()}
    counted = np.where(weight > 0.0, given.coming, 0.0) if given.purity < 1.0 else weight
    devices = chain.fewest(found, counted, given.margin, given.allowed)
    gone = ~given.stays | ((given.coming <= 0.0) & (given.shares > 0.0))
    must = [some & ~gone for some in chain.shared_out(found, devices, given.margin)] if devices else []
    least = given.margin if given.wishes.gentle else np.inf
    cuts = chain.placed(every, wanted, devices, must, least, given.wishes.step, same)
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
        if made is not None and given.wishes.cutter > 0.0:
            made = round_corners.with_corners(given, made, given.wishes.cutter)
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
