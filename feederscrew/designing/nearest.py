"""The nearest design that holds where one does not: what is changed for it is tried, and proved as any."""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base.units import MINUTE, rounded_down
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import DRAWS_HELD, HELD, PURE, RATE_KEPT
from feederscrew.designing import calm_drive, exploring, proposals, queues, texts
from feederscrew.designing.fill_verdicts import longest_time
from feederscrew.designing.findings import FaultKind, Move, MoveKind
from feederscrew.designing.record import DesignStudy, NearestDesign
from feederscrew.designing.search import Candidate, Search
from feederscrew.motion.hop import hop
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.trials.wanted import wanted_states

SLIGHT = 1e-9  # of rounding
SAME_DRIVE = 0.05  # [1] by which drives differ that are one: half of what a draw changes
Prove = Callable[[Search, Candidate], DesignStudy]
Complete = Callable[[DesignStudy], DesignStudy]
Proofs = list[tuple[DesignStudy, Candidate]]


@dataclass(frozen=True, eq=False)
class Variant:
    """A design near one that does not hold, clean in its short trial."""

    change: str  # what is changed for it
    candidate: Candidate
    search: Search  # what it was tried for: of another way up than the one asked for another one
    as_requested: bool = True  # it leaves what was asked for


def only_slow(study: DesignStudy) -> bool:
    """Tell whether a design lacks nothing but parts per minute.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    bool
    """
    low, (purity, _) = study.proof.delivered[1], study.proof.purity
    sorts = (
        study.proof.robust.share >= DRAWS_HELD
        and purity >= PURE
        and not study.proof.jams
        and not study.partial
    )
    return sorts and 0.0 < low < RATE_KEPT * study.request.target


def whole(study: DesignStudy) -> bool:
    """Tell whether a design was proved to the end, holding or not: all draws, a queue at each fill.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    bool
    """
    return study.proof.robust.draws >= study.request.draws and queues.is_complete(
        study.proof.queues, longest_time(study.request.target)
    )


def rate_that_holds(study: DesignStudy) -> float:
    """Return the rate at which a design holds, as it was proved.

    It is what its queues surely deliver, over the share of a target that is enough, rounded down to two
    digits a minute.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    float [1/s]
        0 where it holds at none.
    """
    if study.partial or not study.proof.queues:
        return 0.0
    rate = min(rounded_down(MINUTE * study.proof.delivered[1] / RATE_KEPT) / MINUTE, study.request.target)
    slower = replace(study, request=replace(study.request, target=rate))
    return rate if rate > 0.0 and slower.status in HELD else 0.0


def nearest(
    best: DesignStudy, search: Search, proofs: Proofs, prove: Prove
) -> tuple[NearestDesign, DesignStudy | None]:
    """Return the nearest that holds where a design does not, and that design itself.

    The cheapest change comes first: a lower rate for a design that was proved, a calmer drive for its chain,
    a design that was clean but slow in the search, another heading, one device more, another way up. Each is
    proved as any design is, until one holds: ``near_proofs`` of the policy at most, with ``near_trials``
    short trials. Then bowls are sought for a lower rate: the chains that its drive makes possible are others.

    Parameters
    ----------
    best : DesignStudy
        That does not hold, nor does what was proved.
    search : Search
        As it ended.
    proofs : list of (DesignStudy, Candidate)
        That were made.
    prove : callable
        Returns the design of a candidate with draws and queues, followed as long as they are pure, however
        slow.

    Returns
    -------
    nearest : NearestDesign
    study : DesignStudy or None
        With the request it was proved for; None where nothing holds, or it leaves another orientation than
        one that was asked for.
    """
    state, policy = search.state, search.policy
    state.nearest_limit = len(state.attempts) + policy.near_trials
    denials: list[str] = []
    own = [(rate_that_holds(study), n) for n, (study, _) in enumerate(proofs) if whole(study)]
    if own and max(own)[0] > 0.0:
        rate, n = max(own)
        study, candidate = proofs[n]
        change = f"a lower rate, the same bowl at {_drive(candidate.bowl)}"
        variant = Variant(change, candidate, search)
        return _describe_nearest(search, rate, variant, study, denials, len(proofs)), study
    done, pending = 0, [variants(search, proofs)]
    proved = [candidate for _, candidate in proofs]
    lower = itertools.islice(_at_a_lower_rate(search), policy.lower_rate_proofs)
    near_by = (
        variant for variant in _in_turn(pending) if not _is_denied(variant, proved, policy.near_drives)
    )
    most = state.denied + policy.denied_near
    coming = itertools.chain(itertools.islice(near_by, policy.near_proofs), lower)
    while state.denied < most:  # what queues have denied so long, no change nearby mends
        near_one = next(coming, None)
        if near_one is None:
            break
        variant = near_one
        if _is_denied(variant, proved):
            continue
        proved.append(variant.candidate)
        search.tell(f"nearest that holds: {variant.candidate.attempt.wanted}, {variant.change}")
        study, done = prove(variant.search, variant.candidate), done + 1
        if study.partial:
            raise KeyboardInterrupt
        if variant.as_requested:
            study = replace(study, request=search.request)
        rate = rate_that_holds(study)
        if rate > 0.0:
            near = _describe_nearest(search, rate, variant, study, denials, len(proofs) + done)
            return near, study if variant.as_requested else None
        state.denied += study.proof.queue_seconds
        slow = replace(study, request=replace(study.request, target=1e-9))  # what it lacks beside its rate
        lacks = next(iter(slow.shortfalls), "nothing is delivered")
        denials.append(f"{variant.change} ({variant.candidate.attempt.wanted}): {lacks}")
        if done < policy.near_proofs:
            pending.append(_calmer_variants(variant, study))
    none = NearestDesign(
        None,
        "",
        trials=len(state.attempts),
        proofs=len(proofs) + done,
        denied=tuple(denials),
        helps=tuple(_helps(search, best, None)),
    )
    return none, None


def _is_denied(variant: Variant, proved: Sequence[Candidate], drives: float = math.inf) -> bool:
    """Tell whether a variant's chain was proved at so many drives, or at one that is nearly its own."""
    own = variant.candidate.attempt
    alike = [
        one.attempt for one in proved if (one.attempt.wanted, one.attempt.chain) == (own.wanted, own.chain)
    ]
    near = (
        abs(own.peak_to_peak - other.peak_to_peak) < SAME_DRIVE * other.peak_to_peak
        and abs(own.throw_number - other.throw_number) < SAME_DRIVE * other.throw_number
        for other in alike
    )
    # where more of what leaves counts, it is another proof
    return variant.as_requested and (len(alike) >= drives or any(near))


def flatter_drive(
    best: DesignStudy, search: Search, candidate: Candidate, prove: Prove, complete: Complete
) -> NearestDesign | None:
    """Return a design at a flatter vibration angle, where no leaf springs make the angle of one that holds.

    Its chain is tried at drives of ``calm_drive.find_flatter``, ``flatter_drives`` of the policy at most. One
    that is clean in a short trial is proved by draws and queues, and its machine is sized.

    Parameters
    ----------
    best : DesignStudy
        Whose tooling holds.
    search : Search
        As it ended.
    candidate : Candidate
        Of that design.
    prove : callable
        Returns the design of a candidate with its draws and queues.
    complete : callable
        Returns a design with its machine.

    Returns
    -------
    NearestDesign or None
        The first that holds with its machine, or what came of those that were tried; None where no flatter
        drive can be made.

    Raises
    ------
    KeyboardInterrupt
        If the user stops it.
    """
    proofs, denials = 0, list[str]()
    steep = math.degrees(candidate.bowl.drive.vibration_angle)
    flatter = calm_drive.find_flatter(candidate.plain_bowl(search), candidate.bowl)
    for bowl in itertools.islice(flatter, search.policy.flatter_drives):
        search.state.nearest_limit = len(search.state.attempts) + 1
        angle = f"{math.degrees(bowl.drive.vibration_angle):.3g} deg"
        change = f"a drive at a flatter angle, {angle} in place of {steep:.3g} deg, {_drive(bowl)}"
        move = Move(MoveKind.FLATTER_DRIVE, 2.0 * bowl.drive.amplitude)
        other = exploring.try_again(search, candidate, replace(candidate.proposal, move=move), bowl)
        if not other.attempt.clean:
            denials.append(f"{change}: {', '.join(texts.fault_texts(other.attempt.faults, 2))}")
            continue
        study = prove(search, other)
        if study.partial:
            raise KeyboardInterrupt
        proofs, made = proofs + 1, complete(study)
        if made.status in HELD:
            near = nearest_from_study(
                made, search.request.target, change, trials=len(search.state.attempts), proofs=proofs
            )
            stroke = f"{1e3 * bowl.drive.amplitude:.4g} mm"
            settings = ("drive.vibration_angle", angle), ("drive.amplitude", stroke)
            return replace(near, denied=tuple(denials), settings=settings)
        denials.append(f"{change}: {next(iter(made.shortfalls), made.status)}")
    if not denials:
        return None
    trials = len(search.state.attempts)
    return NearestDesign(None, "", trials=trials, proofs=proofs, denied=tuple(denials))


def nearest_from_study(
    study: DesignStudy, rate: float, change: str, *, trials: int = 0, proofs: int = 1
) -> NearestDesign:
    """Return the nearest that holds at a rate, as a design showed it that was proved.

    Parameters
    ----------
    study : DesignStudy
        With a bowl, its draws and its queues.
    rate : float [1/s]
    change : str
        In words, from what was asked for.
    trials, proofs : int, optional
        That were made to find it.

    Returns
    -------
    NearestDesign
    """
    bowl = study.bowl
    return NearestDesign(
        rate=rate,
        change=change,
        request=study.request,
        wanted=study.wanted,
        chain=tuple(f"{device.kind}: {device.text}" for device in study.devices),
        frequency=None if bowl is None else bowl.drive.frequency,
        peak_to_peak=None if bowl is None else 2.0 * bowl.drive.amplitude,
        throw_number=None if bowl is None else float(throw_number(bowl)),
        trials=trials,
        proofs=proofs,
        draws=study.proof.robust.draws,
        draws_held=study.proof.robust.held,
        queue_seconds=study.proof.queue_seconds,
        parts_right=sum(queue.right for queue in study.proof.queues),
        parts_left=sum(queue.left for queue in study.proof.queues),
    )


def _describe_nearest(
    search: Search, rate: float, variant: Variant, study: DesignStudy, denials: list[str], proofs: int
) -> NearestDesign:
    """The nearest that holds, with what else was tried and what else helps."""
    near = nearest_from_study(study, rate, variant.change, trials=len(search.state.attempts), proofs=proofs)
    helps = [*_helps(search, study, variant.candidate)]
    bowls = math.ceil(search.request.target / rate - SLIGHT)
    if bowls > 1:
        helps.append(f"{bowls} such bowls bring the {MINUTE * search.request.target:.4g}/min asked for")
    return replace(near, denied=tuple(denials), helps=tuple(helps))


def _drive(bowl: Bowl) -> str:
    return f"{2e3 * bowl.drive.amplitude:.3g} mm peak to peak, throw number {throw_number(bowl):.2g}"


def variants(search: Search, proofs: Proofs) -> Iterator[Variant]:
    """Yield designs near those that do not hold, the cheapest change first, each clean in its short trial.

    Parameters
    ----------
    search : Search
    proofs : list of (DesignStudy, Candidate)

    Yields
    ------
    Variant
    """
    budget, proved = search.policy.near_trials, {id(candidate) for _, candidate in proofs}
    for study, candidate in proofs:
        if _by_motion(study) and budget:
            other = _calmer(search, candidate)
            budget -= other is not None
            if other is not None and other.attempt.clean:
                yield Variant(f"a calmer drive, {_drive(other.bowl)}", other, search)
    unproved = (candidate for candidate in search.state.clean if id(candidate) not in proved)
    for candidate in _fastest_first(unproved):
        calm = candidate.proposal.move.kind is MoveKind.CALMER_DRIVE
        change = "a calmer drive, " if calm else "a lower rate, the same bowl at "
        change += _drive(candidate.bowl)
        names_proved = [candidate.attempt.wanted for _, candidate in proofs]
        if names_proved and candidate.attempt.wanted not in names_proved:
            change = _other_way(candidate)
        yield Variant(change, candidate, search)
    yield from _any_heading(search, proofs)
    for study, candidate in proofs:
        if budget and study.proof.queues and not study.proof.purity[0] >= PURE:
            # a drop before the chain for what left a queue instead of what is wanted
            names = {pose.aspect for pose, _ in study.proof.left_instead}
            lying = candidate.orientations.lying
            wanted = candidate.trial.wanted
            rows = [k for k, one in enumerate(lying) if one.aspect in names and k not in wanted]
            changed = proposals.add_drop(candidate.proposal, rows, wanted, lying)
            if changed is None:
                continue
            other, budget = (exploring.try_again(search, candidate, changed, candidate.bowl), budget - 1)
            if other.attempt.clean:
                yield Variant(f"one device more, {texts.move_text(changed.move)}", other, search)
    for other in _try_calmer_drives(search, budget):
        yield Variant(f"a calmer drive, {_drive(other.bowl)}", other, search)
    yield from _other_ways_up(search)


def _fastest_first(candidates: Iterable[Candidate]) -> list[Candidate]:
    return sorted(candidates, key=lambda candidate: -candidate.attempt.rate)


def _by_motion(study: DesignStudy) -> bool:
    """Tell whether a calmer drive may mend it: it jams, is impure, or draws lose or let through what hops."""
    impure = bool(study.proof.queues) and (bool(study.proof.jams) or not study.proof.purity[0] >= PURE)
    hops = study.bowl is not None and hop(study.bowl).height > 0.0
    denied = study.proof.robust.share < DRAWS_HELD and hops
    worst = study.proof.robust.main_fault
    return impure or denied or (worst is not None and worst.kind is FaultKind.LOST)


def _in_turn(iterators: list[Iterator[Variant]]) -> Iterator[Variant]:
    """Yield from the last of several iterators; others may be added behind it meanwhile."""
    while iterators:
        variant = next(iterators[-1], None)
        if variant is None:
            iterators.pop()
        else:
            yield variant


def _calmer_variants(variant: Variant, study: DesignStudy) -> Iterator[Variant]:
    """A variant at a calmer drive, where its proof was denied by motion and the calmer one is clean."""
    other = _calmer(variant.search, variant.candidate) if _by_motion(study) else None
    if other is not None and other.attempt.clean:
        yield replace(variant, change=f"a calmer drive, {_drive(other.bowl)}", candidate=other)


def _calmer(search: Search, candidate: Candidate) -> Candidate | None:
    """The chain of a candidate tried at a calmer drive; None without one, or where that was tried before."""
    bowl = calm_drive.find_calmer(candidate.plain_bowl(search), candidate.bowl)
    if bowl is None or any(
        attempt.chain == candidate.attempt.chain
        and attempt.peak_to_peak == 2.0 * bowl.drive.amplitude
        and abs(attempt.throw_number - throw_number(bowl)) < 1e-6
        for attempt in search.state.attempts
    ):
        return None
    return exploring.try_calmer(search, candidate)


def _any_heading(search: Search, proofs: Proofs) -> Iterator[Variant]:
    """Designs whose aspect left a queue at other headings: any heading of it counted."""
    if search.request.heading is not None:
        return
    for study, candidate in proofs:
        aspect = study.wanted_aspect
        if aspect not in study.proof.aspects_heading_off or aspect in candidate.proposal.any_heading:
            continue
        request = replace(search.request, aspect=None, up=tuple(dict.fromkeys((*search.request.up, aspect))))
        lying, row = candidate.orientations.lying, candidate.proposal.row
        equivalents, free_headings = proposals.find_equivalents(lying, row, request)
        proposal = replace(candidate.proposal, equivalents=equivalents, any_heading=free_headings)
        states = wanted_states(candidate.orientations, proposal.rows)
        trial = replace(candidate.trial, states=states)
        attempt = replace(candidate.attempt, wanted=proposal.wanted_name(candidate.orientations))
        other = replace(candidate, proposal=proposal, trial=trial, attempt=attempt)
        free = search.beside(request)
        yield Variant(f"any heading of {aspect} counted, --up {','.join(request.up)}", other, free, False)


def _at_a_lower_rate(search: Search) -> Iterator[Variant]:
    """Designs of a search for a share of the rate that short trials promise: calmer drives, other chains."""
    state, policy = search.state, search.policy
    target = search.request.target
    promised = min(state.best_rate or target, target)
    lower = rounded_down(MINUTE * policy.lower_rate_share * promised) / MINUTE
    request = replace(search.request, target=lower, budget=len(state.attempts) + policy.lower_rate_trials)
    free = search.beside(request)
    for candidate in exploring.candidates(free):
        yield Variant(f"a lower rate, a bowl at {_drive(candidate.bowl)}", candidate, free)


def _other_ways_up(search: Search) -> Iterator[Variant]:
    """Ways up that are clean in a trial, of all where only some were asked for: fast ones first."""
    policy = search.policy
    first_request = search.request
    if first_request.aspect is None and not first_request.up and first_request.outcome == OutcomeKind.ANY:
        return
    request = replace(first_request, aspect=None, heading=None, up=(), outcome=OutcomeKind.ANY)
    search.tell("nothing that was asked for holds: other ways up are tried, lying and hanging, to be named")
    free = search.beside(replace(request, budget=len(search.state.attempts) + policy.other_way_trials))
    yielded = set()
    for candidate in exploring.candidates(free):
        yielded.add(id(candidate))
        yield Variant(_other_way(candidate), candidate, free, False)
    others = _fastest_first(candidate for candidate in free.state.clean if id(candidate) not in yielded)
    for candidate in itertools.chain(others, _try_calmer_drives(free, policy.other_way_calmer_trials)):
        yield Variant(_other_way(candidate), candidate, free, False)


def _try_calmer_drives(search: Search, budget: int) -> Iterator[Candidate]:
    """Chains that failed, clean at a calmer drive: those of which most left first; so many trials at most."""
    failed = sorted(search.state.failures, key=lambda one: (-one.attempt.efficiency, len(one.attempt.faults)))
    for candidate in failed:
        attempt = candidate.attempt
        if not budget:
            break
        if not attempt.efficiency > 0.0 and attempt.throw_number <= calm_drive.CALM_THROW_NUMBER + 1e-3:
            continue
        other = _calmer(search, candidate)
        budget -= other is not None
        if other is not None and other.attempt.clean:
            yield other


def _other_way(candidate: Candidate) -> str:
    return f"another way up, {candidate.attempt.wanted}, at {_drive(candidate.bowl)}"


def _helps(search: Search, study: DesignStudy, chosen: Candidate | None) -> Iterator[str]:
    """Return what else was clean in a short trial, or would count more parts."""
    named = {study.wanted}
    for candidate in _fastest_first(search.state.clean):
        if candidate is not chosen and candidate.attempt.wanted not in named:
            named.add(candidate.attempt.wanted)
            rate = MINUTE * candidate.attempt.rate
            yield f"{candidate.attempt.wanted} got through its short trial at {rate:.3g}/min"
    own = study.wanted_aspect
    if own in study.proof.aspects_heading_off and own not in search.request.up:
        yield f"--up {own} counts {own} at any heading"
