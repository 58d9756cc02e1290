"""Short trials of chains: an orientation at its own drive, what the trial denies changed, and again."""

import functools
import heapq
import itertools
import math
from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.arrivals.aspects_study import find_aspects
from feederscrew.arrivals.entry import Shares, shares
from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base.arrays import Floats
from feederscrew.bowl.device_list import check_written
from feederscrew.bowl.devices.base import ComparedValue
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.kinds import cost_class as cost_class_of
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl, Track
from feederscrew.cad import solid as solidbowl
from feederscrew.designing import assisting, calm_drive, hanging, proposals, short_trials, texts
from feederscrew.designing.findings import Cause, End, Fault, FaultKind, Move, MoveKind
from feederscrew.designing.policy import SearchPolicy
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import Attempt
from feederscrew.designing.search import Candidate, ChainKey, Place, Search, TrackAtBank
from feederscrew.designing.short_trials import find_denials, robust_run
from feederscrew.feeding import stream
from feederscrew.feeding.stream import Orientations
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.sorting.isolating.rails import find_head
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.sorting.tipping import FLAT_KIND
from feederscrew.trials.fills import JammedParts, LeavingPose, PoseKind
from feederscrew.trials.wanted import equivalent_rows, leaves_hanging, wanted_rows

LYING = proposals.Recipe(1, proposals.MARGINS[0], OutcomeKind.ANY, ())  # of what a part may do at best


@dataclass(frozen=True, eq=False)
class _Idea:
    """An orientation on a track, and a way of proposing a chain for it."""

    track: TrackAtBank
    row: int
    recipe: proposals.Recipe
    proposal: Proposal | None = None  # once it was looked for
    left_out: int = 0  # times that a device was left out at which it was lost
    by_trials: bool = False  # rails, whatever the static rule says of what hangs

    @property
    def place(self) -> Place:
        """Bank of its track, and its row."""
        return self.track.plain_bowl.bowl.track.bank, self.row


def candidates(search: Search, cost_class: int | None = None) -> Iterator[Candidate]:
    """Try proposals, and yield each candidate that is clean and brings the target, within the budget.

    In each cost class no device at all comes first, then the most promising chain of all banks, and so on.
    The ``clean`` and ``failures`` of the search's state are filled.

    Parameters
    ----------
    search : Search
    cost_class : int, optional
        Of the proposals; all without it, the cheapest first.

    Yields
    ------
    Candidate
    """
    state = search.state
    own_devices = search.plain.devices
    own_class = cost_class_of(own_devices)
    for number in proposals.COST_CLASSES if cost_class is None else (cost_class,):
        if own_class > number:  # the user's own devices are dearer
            continue
        share = search.policy.budget_shares[proposals.COST_CLASSES.index(number)]
        state.cost_class = number
        state.reach = state.start + math.ceil(share * (search.request.budget - state.start)) + state.beyond
        tracks = _tracks(search)
        for candidate in [other for other in state.waiting if other.attempt.cost_class == number]:
            state.waiting.remove(candidate)
            yield candidate
        for track in tracks if number == max(1, own_class) else ():
            bare = proposals.propose_no_device(track.orientations, track.weights, search.request, own_devices)
            if bare is not None and not _was_tried(search, track, bare) and not search.is_spent:
                yield from _try_and_mend(search, track, bare)
        if number == proposals.AIR:
            yield from _assisted(search)
            yield from _blown_off(search)
        yield from _chains(search, tracks, number)


def _chains(search: Search, tracks: list[TrackAtBank], cost_class: int) -> Iterator[Candidate]:
    """Candidates with chains of a cost class, the most promising first.

    A chain is looked for where its bound is the highest.
    """
    state, policy = search.state, search.policy
    # what is not rare needs nothing that turns others into it
    ideas = [
        _Idea(track, row, recipe)
        for track in tracks
        for row in track.rows
        for recipe in proposals.recipes_of(cost_class, search.request)
        if not recipe.turns or share_of(search, track, row) < proposals.RARE_ORIENTATION
    ]
    ideas += [idea for track in tracks for idea in _rails_ideas(search, track, cost_class)]
    order = itertools.count()  # of equal ones the first
    heap = [(-_bound(search, idea), next(order), idea) for idea in ideas]
    heapq.heapify(heap)
    while heap and not search.is_spent:
        _, _, idea = heapq.heappop(heap)
        # what it has to promise [1/s], to be tried beside what is clean already
        best, target = state.best_rate, search.request.target
        least = target if 0.0 < best < target else policy.rate_share * best
        if _promise(search, idea.track, idea.row, idea.recipe) < least:
            continue
        if idea.by_trials:
            yield from _rails_by_trials(search, idea, cost_class)
            continue
        proposal = idea.proposal or _proposal(search, idea)
        if proposal is None or _was_tried(search, idea.track, proposal):
            continue
        avoided = state.avoided_kinds.get(idea.place, ())
        if idea.proposal is None:  # rate, purity, margin and number of devices, and what was lost before
            loss = policy.lost_rank if {cut.device.kind for cut in proposal.cuts} & set(avoided) else 1.0
            score = _bound(search, idea) * proposal.purity * policy.device_rank ** len(proposal.cuts) * loss
            heapq.heappush(heap, (-score, next(order), replace(idea, proposal=proposal)))
            continue
        # what is wanted was lost whole at a device of one that begins so
        heads = [head for own, head in state.lost_behind if own == idea.place]
        if proposal.purity < policy.purity or any(proposal.chain[: len(head)] == head for head in heads):
            continue
        yield from _try_and_mend(search, idea.track, proposal)
        excluded = idea.recipe.excluded_kinds
        more = tuple(kind for kind in state.avoided_kinds.get(idea.place, ()) if kind not in excluded)
        if more and idea.left_out < policy.left_out:
            recipe = replace(idea.recipe, excluded_kinds=(*excluded, *more))
            other = _Idea(idea.track, idea.row, recipe, left_out=idea.left_out + 1)
            heapq.heappush(heap, (-_bound(search, other), next(order), other))
    # rails of each head are tried, though what the static rule proposed has used up the trials
    late: dict[int, _Idea] = {}
    for _, _, idea in sorted(heap, key=lambda item: item[:2]):
        if idea.by_trials:
            late.setdefault(idea.row, idea)
    for idea in late.values():
        state.reach += policy.rails_given_up
        yield from _rails_by_trials(search, idea, cost_class)


def _has_no_steady_air(search: Search) -> bool:
    """Tell whether the user leaves out what blows all the time."""
    return any(kind.action is Action.BLOW for name, kind in KINDS.items() if name in search.request.without)


def _assisted(search: Search) -> Iterator[Candidate]:
    """Candidates with air along a blade's face, for what came to stand there; the most promising first.

    Where air changes nothing no other pressure is tried. Where none is clean the best gets a jet before its
    rails as well.
    """
    state, policy = search.state, search.policy
    if _has_no_steady_air(search):
        return
    by_promise = sorted(
        state.stood_at_blade, key=lambda item: -assisting.score(item[0].trial, item[0].proposal)
    )
    for candidate, stands in by_promise[: policy.assisted]:
        lying, best = candidate.orientations.lying, candidate
        for changed in assisting.assist(candidate.proposal, candidate.trial, stands, lying):
            if chain_key(candidate.bowl.track, changed, lying) in state.chains:
                continue
            search.leave_no_other_out()
            if search.is_spent:
                return
            tried = _screen(search, try_again(search, candidate, changed, candidate.bowl))
            if tried.attempt.clean:
                best = tried
                state.clean.append(tried)
                if tried.attempt.rate >= search.request.target:
                    yield tried
                break
            state.failures.append(tried)
            if hanging.score(tried.trial) > hanging.score(best.trial):
                best = tried
            elif best is candidate:
                break
        if best is not candidate and not best.attempt.clean:
            yield from _try_jet_before(search, best, _rows_that_stay(best))


def _rows_that_stay(candidate: Candidate) -> list[int]:
    """Rows of which its trial or its draws show that parts stay at a device."""
    return [fault.row for fault in candidate.attempt.faults if fault.kind is FaultKind.STAYS]


def _blown_off(search: Search) -> Iterator[Candidate]:
    """Yield candidates with a steady air jet before their rails, which blows off what stood at the rails.

    They are made of the chains whose parts stood at rails in a trial or a queue, the latest first, at most
    ``air_trials`` of them. Each has a short trial of its own; a chain that was tried already is left out.
    """
    state = search.state
    if _has_no_steady_air(search):
        return
    for candidate, stands in reversed(state.stood[-search.policy.air_trials :]):
        if search.is_spent:
            return
        yield from _try_jet_before(search, candidate, stands)


def _try_jet_before(search: Search, candidate: Candidate, stands: Sequence[int]) -> Iterator[Candidate]:
    """The candidate with a jet before its rails for what stands at them, where that is clean and fast."""
    state, lying = search.state, candidate.orientations.lying
    changed = hanging.blow_off(candidate.proposal, candidate.trial, stands, lying)
    if changed is None or chain_key(candidate.bowl.track, changed, lying) in state.chains:
        return
    search.leave_no_other_out()
    if search.is_spent:
        return
    tried = _screen(search, try_again(search, candidate, changed, candidate.bowl))
    if not tried.attempt.clean:
        state.failures.append(tried)
        return
    state.clean.append(tried)
    if tried.attempt.rate >= search.request.target:
        yield tried


def note_standing(search: Search, candidate: Candidate, rows: Iterable[int]) -> None:
    """Keep which orientations came to stand at a chain with rails or a blade: dearer ones take them off.

    Parameters
    ----------
    search : Search
    candidate : Candidate
    rows : iterable of int
        Those that hang are left out, where others stood as well: they stand behind those.
    """
    stood = tuple(dict.fromkeys(rows))
    stands = tuple(row for row in stood if row not in candidate.trial.wanted)
    if not stood or not candidate.attempt.efficiency > 0.0:
        return
    if candidate.proposal.hangs:
        search.state.stood.append((candidate, stands))
    _note_at_blade(search, candidate, stands)


def _note_at_blade(search: Search, candidate: Candidate, stands: Sequence[int]) -> None:
    """Keep a chain with a blade that has a face and no air, and all that stood at it, on whatever drive."""
    blade = assisting.blade_of(candidate.proposal)
    if not stands or blade is None or blade.air is not None or not candidate.attempt.efficiency > 0.0:
        return
    kept, chain = search.state.stood_at_blade, candidate.proposal.chain
    before = [row for other, rows in kept if other.proposal.chain == chain for row in rows]
    kept[:] = [item for item in kept if item[0].proposal.chain != chain]
    kept.append((candidate, tuple(dict.fromkeys((*before, *stands)))))


def _rails_by_trials(search: Search, idea: _Idea, cost_class: int) -> Iterator[Candidate]:
    """Candidates with rails for the head of an idea's row, by trials alone."""
    track, before = idea.track, search.plain.devices
    start = replace(calm_drive.drive_at(track.plain_bowl, 0.0), devices=before)
    lying = search.through(start).lying
    rails = hanging.RailsSearch(lying, track.weights, idea.row, before, search.request, cost_class)
    yield from _try_rails(search, track, rails)


def _others_first(search: Search, name: str) -> Iterator[Candidate]:
    """Try each orientation that comes often once, before one that was tried some times is tried again.

    Yields those that are clean and fast enough, of the cost class that is searched or a cheaper one; what is
    dearer waits for its class. One of which nothing was clean, and one that no chain tells from the rest, is
    looked at once.
    """
    state, policy = search.state, search.policy
    if state.tried[name] < policy.tries_before_others:
        return
    for track, row in _often(search):
        other = track.orientations.lying[row].name
        if other in state.looked_at or state.tried[other] or search.is_spent:
            continue
        state.looked_at.add(other)
        idea = _first_idea(search, track, row)
        if idea is None or idea.proposal is None:
            continue
        state.reach += 1  # no other chain is left out for it
        state.most_trials += 1
        tried = try_proposal(search, track.plain_bowl, idea.proposal, track.weights)
        candidate = _screen(search, tried)
        if not candidate.attempt.clean:
            state.failures.append(candidate)
            continue
        state.clean.append(candidate)
        if candidate.attempt.rate < search.request.target:
            continue
        if candidate.attempt.cost_class > state.cost_class:
            state.waiting.append(candidate)
        else:
            yield candidate


def _often(search: Search) -> list[tuple[TrackAtBank, int]]:
    """Rows that come often enough to be tried once, with the track of the first bank, most frequent first."""
    least = search.policy.often_share
    return [
        (track, row)
        for track in search.state.tracks[:1]
        for row in track.rows
        if share_of(search, track, row) >= least
    ]


def _first_idea(search: Search, track: TrackAtBank, row: int) -> _Idea | None:
    """The cheapest chain that isolates a row and was not tried; None without one."""
    for cost_class in proposals.COST_CLASSES:
        recipes = proposals.recipes_of(cost_class, search.request)
        ideas = [_Idea(track, row, recipe) for recipe in recipes if not recipe.turns]
        for idea in sorted(ideas, key=lambda idea: -_bound(search, idea)):
            proposal = _proposal(search, idea)
            if proposal is None or proposal.purity < search.policy.purity:
                continue
            if not _was_tried(search, track, proposal):
                return replace(idea, proposal=proposal)
    return None


def _rails_ideas(search: Search, track: TrackAtBank, cost_class: int) -> list[_Idea]:
    """Ideas of rails that trials decide on, one for each head: of steel, after what the static rule says."""
    request = search.request
    if cost_class != proposals.COST_CLASSES[0] or request.outcome == OutcomeKind.LYING:
        return []
    recipe = proposals.Recipe(cost_class, min(proposals.MARGINS), OutcomeKind.HANGING, ())
    rows = hanging.head_rows(track.orientations.lying, track.weights, track.rows)
    return [_Idea(track, row, recipe, by_trials=True) for row in rows]


def _proposal(search: Search, idea: _Idea) -> Proposal | None:
    """The chain of an idea; None where none is, or there is none with less asked for.

    A smaller margin asks for less, and so do chains without turning devices: where even those isolate
    nothing, the longer search is left out.
    """
    state = search.state
    recipe = idea.recipe
    plain, least = replace(recipe, turns=False), min(proposals.MARGINS)
    easier = dict.fromkeys((replace(plain, margin=least), plain, replace(recipe, margin=least), recipe))
    for other in easier:
        key = (*idea.place, other)
        if key not in state.proposed:
            if state.proposals_left <= 0:  # of a quick look
                return None
            state.proposals_left -= 1
            state.proposed[key] = _propose(search, idea.track, idea.row, other)
        if state.proposed[key] is None:
            return None
    return state.proposed[(*idea.place, recipe)]


def _tracks(search: Search) -> list[TrackAtBank]:
    """The tracks that are tried, of each bank: once for all cost classes."""
    state, policy = search.state, search.policy
    if state.tracks:
        return state.tracks
    aspects = find_aspects(search.part) if state.shares is None else state.shares.aspects
    banks = likely_banks(aspects, search.request.rule, policy)
    if search.keeps("track.bank"):
        banks = (search.plain.track.bank,)
    for number, bank in enumerate(banks):
        plain_bowl = calm_drive.section(
            search.part,
            aspects,
            search.plain,
            search.kept_keys,
            diameter=search.request.diameter,
            bank=bank,
            drive=search.request.drive,
        )
        start = replace(calm_drive.drive_at(plain_bowl, 0.0), devices=search.plain.devices)
        if state.shares is None:
            state.shares = entry_shares(search, start)
        orientations, weights = weigh_orientations(search, start)
        rows = _rows_to_try(orientations, weights, search)
        state.tracks.append(TrackAtBank(plain_bowl, orientations, weights, rows, policy.bank_rank**number))
    # also of what may hang: infinite
    placed = [(track, row) for track in state.tracks for row in track.rows]
    enough = any(_promise(search, track, row, LYING) >= search.request.target for track, row in placed)
    turns = any(share_of(search, track, row) < proposals.RARE_ORIENTATION for track, row in placed)
    if not enough and not turns:
        state.most_trials = state.start + policy.rare_trials
    return state.tracks


def _rows_to_try(orientations: Orientations, weights: Floats, search: Search) -> list[int]:
    """The rows for which chains are proposed: the most frequent, and one of each aspect that comes often.

    Else headings of one aspect would leave out the side that comes next.
    """
    rows = proposals.promising_rows(orientations, weights, search.request)
    aspects = [one.aspect for one in orientations.lying]
    chosen = rows[: proposals.PROPOSED_ROWS]
    for row in rows[proposals.PROPOSED_ROWS :]:
        share = sum(w for w, aspect in zip(weights.tolist(), aspects, strict=True) if aspect == aspects[row])
        if aspects[row] not in {aspects[k] for k in chosen} and share >= search.policy.often_share:
            chosen.append(row)
    return chosen


def likely_banks(aspects: Aspects, rule: str, policy: SearchPolicy) -> tuple[float, ...]:
    """Return the banks [rad] of the track that are tried for a part, the likeliest first.

    Parameters
    ----------
    aspects : Aspects
    rule : str
        Whose probabilities are taken.
    policy : SearchPolicy

    Returns
    -------
    tuple of float [rad]
        The steeper ones where the part rolls.
    """
    chances = np.nan_to_num(aspects.chances[rule])
    rolling = float(chances[[kind != FLAT_KIND for kind in aspects.kinds]].sum())
    return calm_drive.STEEP_BANKS if rolling > policy.rolling_share * chances.sum() else calm_drive.BANKS


def _bound(search: Search, idea: _Idea) -> float:
    """Return how promising [1] the chain of an idea can be at best."""
    policy = search.policy
    recipe, track = idea.recipe, idea.track
    asked = search.state.reserve * search.request.target
    rate = min(_promise(search, track, idea.row, recipe) / asked, 1.0)
    flat = track.plain_bowl.bowl.track.bank <= policy.hanging_bank
    rank = track.rank if recipe.outcome == OutcomeKind.LYING else 1.0 if flat else policy.bank_rank**2
    simplicity = (policy.turning_rank if recipe.turns else 1.0) * (policy.hole_rank if recipe.holes else 1.0)
    share = share_of(search, track, idea.row) ** policy.share_power
    least, part_of_margin = policy.no_margin_rank, min(recipe.margin / proposals.MARGINS[0], 1.0)
    margin = least + (1.0 - least) * part_of_margin
    return rate * rank * simplicity * share * margin * policy.left_out_rank**idea.left_out


def chain_key(track: Track, proposal: Proposal, orientations: Sequence[Orientation]) -> ChainKey:
    """Return what names a chain on a track and what shall leave it, whatever the drive.

    Parameters
    ----------
    track : Track
    proposal : Proposal
    orientations : sequence of Orientation
        Of which the proposal names rows.

    Returns
    -------
    ChainKey
        Track, name of what leaves, and kind and values of each device; the order of what a sensor lets pass
        makes no difference.
    """
    wanted = "hanging" if proposal.hangs else orientations[proposal.row].name
    return track, wanted, tuple((device.kind, device.compared_values) for device in proposal.devices)


def _was_tried(search: Search, track: TrackAtBank, proposal: Proposal) -> bool:
    """Tell whether a chain was tried on that track, or one whose values differ by too little."""
    state = search.state
    key = chain_key(track.plain_bowl.bowl.track, proposal, track.orientations.lying)
    return key in state.chains or any(_is_alike(key, other, search.policy) for other in state.chains)


def _is_alike(key: ChainKey, other: ChainKey, policy: SearchPolicy) -> bool:
    """Tell whether two chains for one track and orientation differ by little in each number."""
    if key[:2] != other[:2] or [kind for kind, _ in key[2]] != [kind for kind, _ in other[2]]:
        return False
    devices = zip(key[2], other[2], strict=True)
    return all(
        len(values) == len(others)
        and all(_is_alike_value(a, b, policy) for a, b in zip(values, others, strict=True))
        for (_, values), (_, others) in devices
    )


def _is_alike_value(first: ComparedValue, second: ComparedValue, policy: SearchPolicy) -> bool:
    """Tell whether two values of devices are the same word, or numbers that differ by little."""
    a, b = first.value, second.value
    if a == b or not isinstance(a, float) or not isinstance(b, float):
        return a == b
    little = policy.alike_angle if first.is_angle else policy.alike_length
    return abs(a - b) <= max(little, policy.alike_share * abs(a))


def _promise(search: Search, track: TrackAtBank, row: int, recipe: proposals.Recipe) -> float:
    """Parts [1/s] that an orientation brings at the fastest drive, were all others returned."""
    if recipe.outcome != OutcomeKind.LYING and find_head(track.orientations.lying[row]) is not None:
        return np.inf  # what hangs comes from several headings
    pitch = short_trials.GAP * float((track.weights * track.orientations.lengths).sum())
    share = 1.0 if recipe.turns else share_of(search, track, row)
    return share * track.fastest / pitch


def rate_at_most(track: TrackAtBank, share: float) -> float:
    """Return the rate [1/s] that no chain exceeds: parts that touch, at the fastest drive.

    Parameters
    ----------
    track : TrackAtBank
        Of its orientations lengths l and weights w are taken: a part takes sum(w l) of the track.
    share : float [1]
        Of the parts that may leave as wanted.

    Returns
    -------
    float [1/s]
        share v / sum(w l), with the velocity v of the fastest drive.
    """
    return share * track.fastest / float((track.weights * track.orientations.lengths).sum())


def share_of(search: Search, track: TrackAtBank, row: int) -> float:
    """Return the share [1] in which an orientation comes, with those that count as it.

    Parameters
    ----------
    search : Search
    track : TrackAtBank
    row : int

    Returns
    -------
    float [1]
    """
    equivalent = equivalent_rows(track.orientations.lying, row, search.request.up)
    return float(track.weights[[row, *equivalent]].sum())


def _propose(search: Search, track: TrackAtBank, row: int, recipe: proposals.Recipe) -> Proposal | None:
    """A chain for one orientation at the drive that its share asks for; None where there is none."""
    policy = search.policy

    def at_drive_for(gain: float) -> Proposal | None:
        velocity = required_velocity(search, track.orientations, track.weights, gain)
        # the same drive for shares that are alike
        step = math.ceil(math.log(velocity, policy.velocity_step) - 1e-9)
        bowl = calm_drive.drive_at(track.plain_bowl, policy.velocity_step**step)
        return proposals.propose_chain(
            search.part,
            replace(bowl, devices=search.plain.devices),
            search.arrivals.aspects,
            row,
            track.orientations,
            search.request,
            recipe,
        )

    share = share_of(search, track, row)
    proposal = at_drive_for(share)
    if proposal is None:
        return None
    # the share that leaves as wanted, as the static rule says
    through = search.through(replace(track.plain_bowl.bowl, devices=proposal.devices))
    gain = short_trials.gain(through, track.weights, proposal.states(through))
    return (at_drive_for(gain) if gain > policy.slower * share else None) or proposal


def required_velocity(
    search: Search, orientations: Orientations, weights: Floats, gain: float, spacing: float = 0.0
) -> float:
    """Return the velocity that brings the target, with a reserve, at a share that leaves as wanted.

    Parts come in a row: v = reserve target (gap mean length + spacing) / gain.

    Parameters
    ----------
    search : Search
        With target and reserve.
    orientations : Orientations
    weights : (M,) float [1]
        Shares in which the orientations come.
    gain : float [1]
        Share of the parts that leaves as wanted.
    spacing : float [m], optional
        By which parts come farther than they do by themselves where devices need that.

    Returns
    -------
    float [m/s]
    """
    pitch = short_trials.GAP * float((weights * orientations.lengths).sum()) + spacing
    return search.state.reserve * search.request.target * pitch / max(gain, 1e-3)


def entry_shares(search: Search, bowl: Bowl) -> Shares:
    """Return the mix of aspects that enters the track of a bowl.

    Parameters
    ----------
    search : Search
    bowl : Bowl
        Its devices are not looked at.

    Returns
    -------
    Shares
    """
    bare = replace(bowl, devices=())
    return shares(search.part, bare, rule=search.request.rule, jobs=search.request.jobs)


def weigh_orientations(search: Search, bowl: Bowl) -> tuple[Orientations, Floats]:
    """Return the orientations that come along a track, and in which shares.

    Parameters
    ----------
    search : Search
    bowl : Bowl

    Returns
    -------
    orientations : Orientations
    weights : (M,) float [1]
        Their sum is 1; all alike where none is known.
    """
    orientations = search.orientations_along(bowl)
    weights = np.nan_to_num(orientations.rules[search.request.rule])
    total = weights.sum()
    return orientations, weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))


def _try_and_mend(search: Search, track: TrackAtBank, proposal: Proposal) -> Iterator[Candidate]:
    """Try a proposal and what mends it; the Candidate where one is clean and fast enough.

    One that one draw alone denies is taken where nothing mends it: the draws of its proof are more.
    """
    state, policy = search.state, search.policy
    plain_bowl, weights = track.plain_bowl, track.weights
    lost, before, nearly = 0, None, None
    useless: tuple[str, ...] = ()  # kinds of drops that made no difference
    for _ in range(policy.mends + 1):
        yield from _others_first(search, track.orientations.lying[proposal.row].name)
        if search.is_spent:
            return
        candidate = _screen(search, try_proposal(search, plain_bowl, proposal, weights))
        calmed = yield from _find_calmer(search, candidate)
        if calmed.attempt.clean:
            state.clean.append(calmed)
            if calmed.attempt.rate >= search.request.target:
                yield calmed
                return
        if candidate.attempt.clean:
            return
        state.failures.append(candidate)
        nearly = nearly or (candidate if candidate.is_nearly_robust(policy) else None)
        if not candidate.attempt.efficiency > 0.0 and not candidate.proposal.hangs:
            lost += 1
        attempt, lying = candidate.attempt, candidate.orientations.lying
        after = attempt.faults, attempt.efficiency, attempt.stopped
        if lost == policy.lost_trials or search.is_spent:  # nothing leaves
            break
        if after == before:  # what was changed made no difference
            changed = proposals.replace_drop(proposal, candidate.trial, lying, useless)
            useless = (*useless, proposal.move.device)
        else:
            changed = proposals.mend_proposal(proposal, candidate.trial, lying, candidate.worst)
        before = after
        if changed is None or chain_key(plain_bowl.bowl.track, changed, lying) in state.chains:
            break
        proposal = changed
    chosen = (yield from _find_livelier(search, candidate)) or nearly
    if chosen is not None:
        yield chosen
        return
    note_standing(search, candidate, _rows_that_stay(candidate))
    # at which devices what is wanted was lost; rails are the only way to hang
    place, trial = (plain_bowl.bowl.track.bank, proposal.row), candidate.trial
    lost_at = {cut.device.kind for cut in proposal.cuts if cut.device.action is not Action.HANG}
    kinds = sorted(kind for kind in lost_at if proposals.lost_at(trial, kind))
    state.avoided_kinds[place] = tuple(dict.fromkeys((*state.avoided_kinds.get(place, ()), *kinds)))
    # where all of it ended at one of them: another chain that begins so does no better
    ends = {end for n, k in enumerate(trial.rows) if k == proposal.row for end in trial.ends[n]}
    if not trial.efficiency > 0.0 and len(ends) == 1:
        count = devices_to(ends.pop(), proposal)
        if count:
            state.lost_behind.append((place, proposal.chain[:count]))


def _try_rails(search: Search, track: TrackAtBank, rails: hanging.RailsSearch) -> Iterator[Candidate]:
    """Try rails for a head and what changes them, from the best so far; each Candidate that is clean.

    The short trial decides on each; the static rule says only in which order. A chain that is clean and too
    slow is tried once more at the drive that its share of hanging parts asks for.
    """
    state, policy = search.state, search.policy
    plain_bowl, weights = track.plain_bowl, track.weights
    best: Candidate | None = None
    drive: Bowl | None = None  # that of the best so far, where it is livelier than the target asks for
    pending, count = rails.start(), 0
    while count < policy.rails_trials and not search.is_spent:
        tried = next(pending, None)
        if tried is None:
            break
        proposal, own_drive = tried.proposal, drive
        if best is not None:
            proposal = replace(proposal, shown_gain=best.attempt.efficiency or None)
            if tried.is_livelier:
                own_drive = calm_drive.find_livelier(plain_bowl, best.bowl, calm_drive.NEXT_LIVELIER_HOP, 0.0)
                if own_drive is None:
                    continue
                proposal = replace(
                    proposal, move=Move(MoveKind.LIVELIER_DRIVE, 2.0 * own_drive.drive.amplitude)
                )
        ways = search.through(replace(plain_bowl.bowl, devices=proposal.devices))
        if not leaves_hanging(ways, proposal.states(ways)):  # nothing of it can hang in such a slot
            continue
        candidate, count = try_proposal(search, plain_bowl, proposal, weights, own_drive), count + 1
        if candidate.attempt.clean and candidate.attempt.rate < search.request.target:
            proposal = replace(proposal, shown_gain=candidate.attempt.efficiency)
            candidate, count = try_proposal(search, plain_bowl, proposal, weights), count + 1
        candidate = _screen(search, candidate)
        if candidate.attempt.clean:
            state.clean.append(candidate)
            if candidate.attempt.rate >= search.request.target:
                yield candidate
                return
        else:
            state.failures.append(candidate)
            _note_at_blade(search, candidate, _rows_that_stay(candidate))
        if best is None or hanging.score(candidate.trial) > hanging.score(best.trial):
            state.reach += best is not None  # what gets better leaves no other chain out
            best, drive = candidate, own_drive
            pending = itertools.chain(
                rails.moves(replace(tried, proposal=proposal), candidate.trial), pending
            )
        elif count >= policy.rails_given_up and not best.attempt.efficiency > 0.0:
            return
    if best is None:
        return
    chosen = yield from _find_livelier(search, best)
    if chosen is not None:
        yield chosen
        return
    note_standing(search, best, _rows_that_stay(best))


def mends_of_jams(search: Search, candidate: Candidate, jammed: Sequence[JammedParts]) -> Iterator[Proposal]:
    """Yield what changes a chain whose queue jams, by what stood there and at which device.

    Parameters
    ----------
    search : Search
    candidate : Candidate
        That was proved.
    jammed : sequence of JammedParts

    Yields
    ------
    Proposal
    """
    if not jammed:
        return
    proposal = candidate.proposal
    blade = assisting.blade_of(proposal)
    kept = {candidate.orientations.lying[row].name for row in candidate.trial.wanted}
    placed = [device for device in proposal.devices if device.action.has_place]
    if any(
        placed[stood.place - 1] == blade and stood.name not in kept for stood in jammed if stood.place > 0
    ):
        more = assisting.stronger(proposal)
        yield from (changed for changed in (more,) if changed is not None)
    if not proposal.hangs:
        poses = ((LeavingPose(PoseKind.ORIENTATION, name=stood.name), stood.parts) for stood in jammed)
        wanted = {candidate.orientations.lying[row].name for row in candidate.trial.wanted}
        lying = candidate.orientations.lying
        eased = (proposals.ease_cut(proposal, stood.place, lying) for stood in jammed if stood.name in wanted)
        yield from (changed for changed in (*eased, *proposals.purify(candidate, tuple(poses))) if changed)
        return
    start = replace(calm_drive.drive_at(candidate.plain_bowl(search), 0.0), devices=search.plain.devices)
    before, cost_class = search.plain.devices, proposal.cost_class
    lying = search.through(start).lying
    rails = hanging.RailsSearch(lying, candidate.weights, proposal.row, before, search.request, cost_class)
    mends = rails.mends_of_jams(proposal, candidate.trial, jammed)
    yield from (assisting.keep_air(proposal, changed) for changed in mends)


def devices_to(end: End, proposal: Proposal) -> int:
    """Return how many devices of a chain stand along the track up to an end.

    Parameters
    ----------
    end : End
    proposal : Proposal

    Returns
    -------
    int
        0 on the bare track.
    """
    placed = [k for k, device in enumerate(proposal.devices) if device.action.has_place]
    return 0 if end.on_bare_track else placed[end.station - 1] + 1


def _find_livelier(search: Search, candidate: Candidate) -> Generator[Candidate, None, Candidate | None]:
    """The candidate at a livelier drive, where parts stay at a blade or at rails; None where none is clean.

    Where one draw alone denies that, it is taken as well.
    """
    for _ in range(search.policy.livelier_trials):
        if stays_at_steel(candidate.proposal, candidate.attempt.faults):
            yield from _others_first(search, candidate.orientations.lying[candidate.proposal.row].name)
        if search.is_spent or not stays_at_steel(candidate.proposal, candidate.attempt.faults):
            return None
        other = try_livelier(search, candidate)
        if other is None:
            return None
        candidate = other
        if candidate.attempt.clean:
            search.state.clean.append(candidate)
            return candidate if candidate.attempt.rate >= search.request.target else None
        if candidate.is_nearly_robust(search.policy):
            return candidate
    return None


def try_livelier(search: Search, candidate: Candidate) -> Candidate | None:
    """Return the same chain screened at a livelier drive than that at which parts stay.

    Parameters
    ----------
    search : Search
    candidate : Candidate

    Returns
    -------
    Candidate or None
        None without a livelier drive.
    """
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
    """Tell whether parts stay at a blade or at rails of a chain.

    Parameters
    ----------
    proposal : Proposal
    faults : iterable of Fault
        Of a trial or of draws.

    Returns
    -------
    bool
    """
    steel = {cut.device.kind for cut in proposal.cuts if cut.device.action in (Action.OVERHEAD, Action.HANG)}
    return any(fault.stops_at(steel) for fault in faults)


def _find_calmer(search: Search, first: Candidate) -> Generator[Candidate, None, Candidate]:
    """The candidate at a calmer drive that is clean, where the one it had turns or loses what is wanted."""
    candidate = first
    for _ in range(search.policy.calmer_trials):
        worst = candidate.worst  # in a trial on the track, or in draws by turning it
        turned = worst is not None and worst.kind is FaultKind.LOST and worst.is_on_bare_track
        moved_out = turned or bool(short_trials.lost_by_motion(candidate.trial))
        if candidate.attempt.clean or search.is_spent or not moved_out:
            break
        yield from _others_first(search, candidate.orientations.lying[candidate.proposal.row].name)
        other = None if search.is_spent else try_calmer(search, candidate)
        if other is None:
            break
        search.state.most_trials += 1  # no other chain is left out for it
        candidate = _screen(search, other)
    return candidate if candidate.attempt.clean else first


def try_calmer(search: Search, candidate: Candidate) -> Candidate | None:
    """Return the same chain tried at a calmer drive than that which lost parts.

    Parameters
    ----------
    search : Search
    candidate : Candidate

    Returns
    -------
    Candidate or None
        None without a calmer drive.
    """
    bowl = calm_drive.find_calmer(candidate.plain_bowl(search), candidate.bowl)
    return _at_drive(search, candidate, bowl, MoveKind.CALMER_DRIVE)


def _screen(search: Search, candidate: Candidate) -> Candidate:
    """A clean candidate after some draws of part, friction, drive and cuts; denied where one fails."""
    request = search.request
    if not candidate.attempt.clean or candidate.attempt.rate < request.target or request.quick:
        return candidate
    robust = robust_run(
        search.part,
        candidate.bowl,
        candidate.orientations,
        candidate.weights,
        candidate.proposal.rows,
        draws=min(search.policy.screening_draws, request.draws),
        tolerance=request.tolerance,
        run=request.run,
        any_heading=candidate.proposal.any_heading,
        enough=search.share_needed(candidate.attempt),
        returnable=short_trials.find_returnable_rows(candidate.trial),
        shown=candidate.shown,
        max_failures=1,
    )
    if robust.partial:
        raise KeyboardInterrupt
    if robust.held == robust.draws:
        return candidate
    attempt = replace(candidate.attempt, faults=() if robust.main_fault is None else (robust.main_fault,))
    search.state.attempts[-1] = attempt
    return replace(candidate, attempt=attempt, robust=robust)


def try_proposal(
    search: Search,
    plain_bowl: calm_drive.PlainBowl,
    proposal: Proposal,
    weights: Floats,
    driven: Bowl | None = None,
) -> Candidate:
    """Return a proposal with one short trial, at the drive that the target asks for.

    Parameters
    ----------
    search : Search
    plain_bowl : PlainBowl
    proposal : Proposal
    weights : (M,) float [1]
        Shares in which the orientations come.
    driven : Bowl, optional
        Its drive is taken in place of that of the target.

    Returns
    -------
    Candidate
    """
    check_written(proposal.devices, "design.yaml")
    if not search.keeps("track.climb") and any(device.action.leans for device in proposal.devices):
        # as steep as a spacing section that leads down needs the track: else it has no solid
        bowl = replace(plain_bowl.bowl, devices=proposal.devices)
        climb = solidbowl.drawable_climb(bowl, search.part, search.through(bowl))
        plain_bowl = replace(
            plain_bowl, bowl=replace(plain_bowl.bowl, track=replace(bowl.track, climb=climb))
        )
    own = drive_for_target(search, plain_bowl, proposal, weights) if driven is None else driven
    bowl = replace(own, track=plain_bowl.bowl.track, devices=proposal.devices)
    orientations = search.orientations_along(bowl)
    search.state.chains.add(chain_key(bowl.track, proposal, orientations.lying))
    if not proposal.hangs:  # rails are tried with every orientation at once
        search.state.tried[orientations.lying[proposal.row].name] += 1
    wanted = proposal.wanted_name(orientations)
    name = f"{wanted}, {orientations.lying[proposal.row].name} first" if proposal.hangs else wanted
    search.begin_trial(f"{name}, {texts.move_text(proposal.move)}")
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
        wanted=wanted,
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
        chain_brief=tuple(device.brief for device in proposal.devices),
    )
    search.state.attempts.append(attempt)
    search.progress.clock.end()
    return Candidate(proposal, bowl, orientations, weights, trial, attempt)


def try_again(search: Search, candidate: Candidate, proposal: Proposal, bowl: Bowl) -> Candidate:
    """Return a candidate tried with another proposal at the drive of a bowl.

    Parameters
    ----------
    search : Search
    candidate : Candidate
    proposal : Proposal
    bowl : Bowl

    Returns
    -------
    Candidate
    """
    return try_proposal(search, candidate.plain_bowl(search), proposal, candidate.weights, bowl)


def drive_for_target(
    search: Search, plain_bowl: calm_drive.PlainBowl, proposal: Proposal, weights: Floats
) -> Bowl:
    """Return the bowl at the drive that brings the target, with the gaps that its devices need there.

    Parameters
    ----------
    search : Search
    plain_bowl : PlainBowl
    proposal : Proposal
    weights : (M,) float [1]
        Shares in which the orientations come.

    Returns
    -------
    Bowl
    """
    orientations = search.through(replace(plain_bowl.bowl, devices=proposal.devices))
    gain, spacing = short_trials.gain(orientations, weights, proposal.states(orientations)), 0.0
    if proposal.hangs:  # the trial decides on what hangs: what it showed, or what may
        gain = proposal.shown_gain or max(gain, hanging.expected_gain(orientations, weights, proposal.row))
    for _ in range(2):
        required = required_velocity(search, orientations, weights, gain, spacing)
        velocity = max(required, search.state.min_speed)
        bowl = calm_drive.drive_at(plain_bowl, velocity, hops=not proposal.devices)
        spacing = stream.needed_spacing(proposal.devices, orientations.lying, bowl)
        if not spacing > 0.0:
            break
    return bowl


def _short(
    search: Search, bowl: Bowl, orientations: Orientations, weights: Floats, proposal: Proposal
) -> short_trials.ShortTrial:
    """The short trial: what is wanted first; where none of it leaves, the others are not tried."""
    policy = search.policy
    single = functools.partial(
        short_trials.try_parts,
        search.part,
        bowl,
        orientations,
        weights,
        proposal.rows,
        run=search.request.run,
        aspects=search.arrivals.aspects,
        any_heading=proposal.any_heading,
    )
    rows = short_trials.frequent_rows(weights, (proposal.row,))
    if proposal.hangs:  # which rows hang is what the trial shows
        count = min(policy.rails_parts // len(rows), policy.rails_parts_each)
        return single(rows=rows, count=max(policy.trial_parts, count))
    right = set(wanted_rows(orientations, proposal.states(orientations)))
    first = [k for k in rows if k in right] or [proposal.row]
    others = [k for k in rows if k not in first]
    trial = single(rows=first, count=policy.trial_parts)
    if not trial.efficiency > 0.0:
        return trial
    if others:
        each = policy.trial_parts if len(others) <= short_trials.FEW_OTHERS else 1
        trial = trial.join(single(rows=others, count=each))
    return trial if any(find_denials(trial)) else try_untried(search, bowl, trial, weights, proposal)


def try_untried(
    search: Search, bowl: Bowl, trial: short_trials.ShortTrial, weights: Floats, proposal: Proposal
) -> short_trials.ShortTrial:
    """Return a short trial with every orientation that may come often enough to matter.

    Parameters
    ----------
    search : Search
    bowl : Bowl
        With the devices of the trial.
    trial : ShortTrial
        In which what is wanted leaves.
    weights : (M,) array [1]
        Shares of its orientations.
    proposal : Proposal
        The chain that was tried.

    Returns
    -------
    ShortTrial
        Its velocity is that of the orientations that come often.
    """
    ways = trial.orientations
    right = {*wanted_rows(ways, trial.states), proposal.row, *trial.rows.tolist()}
    possible = short_trials.possible_rows(weights, search.highest_shares(ways))
    rows = [k for k in possible if k not in right]
    if not rows:
        return trial
    more = short_trials.try_parts(
        search.part,
        bowl,
        ways,
        trial.shares,
        proposal.rows,
        rows=rows,
        count=search.policy.trial_parts,
        run=search.request.run,
        aspects=search.arrivals.aspects,
        any_heading=proposal.any_heading,
    )
    return replace(trial.join(more), velocity=trial.velocity)
