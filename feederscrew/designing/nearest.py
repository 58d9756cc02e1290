"""The nearest design that holds where one does not: what is changed for it is tried, and proved as any."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.designing import calm_drive, exploring, proposals, queues, short_trials
from feederscrew.designing.exploring import Candidate, Search
from feederscrew.designing.record import (
    DRAWS_HELD,
    HEADING_OFF,
    HOLDS,
    PURE,
    RATE_KEPT,
    DesignRequest,
    DesignStudy,
    NearestDesign,
)
from feederscrew.dropping.plate_test import throw_number

MINUTE = 60.0
PROOFS = 3  # designs beside those of the search that go through draws and queues
TRIALS = 4  # short trials beside those of the search, of calmer drives and of one device more
FREE_TRIALS = 6  # of other ways up, where only some were asked for
SLIGHT = 1e-9  # of rounding
FREE_CALMED = 2  # of them at a calmer drive
RATE_DIGITS = 2  # of a rate that holds: it is rounded down
Prove = Callable[[Search, Candidate], DesignStudy]
Proofs = list[tuple[DesignStudy, Candidate]]


@dataclass(frozen=True, eq=False)
class Variant:
    """A design near one that does not hold, clean in its short trial."""

    change: str  # what is changed for it
    candidate: Candidate
    search: Search  # what it was tried for: of another way up than the one asked for another one
    as_requested: bool = True  # it leaves what was asked for


def only_slow(study: DesignStudy) -> bool:
    """Return whether a design lacks nothing but parts per minute."""
    low, (purity, _) = study.delivered[1], study.purity
    sorts = study.robust.share >= DRAWS_HELD and purity >= PURE and not study.jams and not study.partial
    return sorts and 0.0 < low < RATE_KEPT * study.request.target


def only_lost(study: DesignStudy) -> bool:
    """Return whether draws have denied a design by what is wanted and gets stuck: a drive may be too slow."""
    return not study.partial and study.robust.share < DRAWS_HELD and " is lost (stopped" in study.robust.worst


def rate_that_holds(study: DesignStudy) -> float:
    """Return the rate [1/s] at which a design holds, as it was proved; 0 where it holds at none.

    Parameters
    ----------
    study : DesignStudy
        With its draws, and a queue at each fill.

    Returns
    -------
    float [1/s]
        Rounded down to two digits a minute: what its queues surely deliver, over the share of a target that
        is enough.
    """
    if study.partial or not study.queues:
        return 0.0
    least = min(study.delivered[1], *(queue.ends[1] for queue in study.queues))
    rate = _rounded_down(MINUTE * least / RATE_KEPT) / MINUTE
    if not rate > 0.0:
        return 0.0
    slower = replace(study, request=replace(study.request, target=min(rate, study.request.target)))
    return slower.request.target if slower.status == HOLDS else 0.0


def _rounded_down(value: float) -> float:
    """A number above 0 rounded down to ``RATE_DIGITS`` digits."""
    if not value > 0.0:
        return 0.0
    step = 10.0 ** (np.floor(np.log10(value)) - RATE_DIGITS + 1)
    return float(np.floor(value / step + SLIGHT) * step)


def nearest(
    best: DesignStudy, search: Search, proofs: Proofs, prove: Prove
) -> tuple[NearestDesign, DesignStudy | None]:
    """Return the nearest that holds where a design does not, and that design itself.

    The cheapest change comes first: a lower rate for a design that was proved, a calmer drive for its chain,
    a design that was clean but slow in the search, another heading, one device more, another way up. Each is
    proved as any design is, until one holds: ``PROOFS`` of them, with ``TRIALS`` short trials, at most.

    Parameters
    ----------
    best : DesignStudy
        That does not hold.
    search : Search
        As it ended.
    proofs : list of (DesignStudy, Candidate)
        What was proved, and does not hold.
    prove : callable
        Given a Search and a Candidate, returns its design with draws and queues, followed as long as they
        are pure, however slow.

    Returns
    -------
    (NearestDesign, DesignStudy or None)
        The design with the request it was proved for; None where nothing holds, or it leaves another
        orientation than one that was asked for.
    """
    search.further = len(search.attempts) + TRIALS
    denied: list[str] = []
    own = [(rate_that_holds(study), n) for n, (study, _) in enumerate(proofs) if whole(study)]
    if own and max(own)[0] > 0.0:
        rate, n = max(own)
        study, candidate = proofs[n]
        variant = Variant(_slower(candidate), candidate, search)
        return _holding(search, rate, variant, study, denied, len(proofs)), study
    done, pending = 0, [variants(search, proofs)]
    for variant in _in_turn(pending):
        search.tell(f"nearest that holds: {variant.candidate.attempt.wanted}, {variant.change}")
        study, done = prove(variant.search, variant.candidate), done + 1
        if study.partial:
            raise KeyboardInterrupt
        rate = rate_that_holds(study)
        if rate > 0.0:
            near = _holding(search, rate, variant, study, denied, len(proofs) + done)
            return near, study if variant.as_requested else None
        denied.append(f"{variant.change} ({variant.candidate.attempt.wanted}): {_lacks(study)}")
        if done >= PROOFS:
            break
        pending.append(_calmer_variants(variant, study))
    none = NearestDesign(
        None, "", trials=len(search.attempts), proofs=len(proofs) + done, denied=tuple(denied),
        helps=tuple(_helps(search, best, None)),
    )  # fmt: skip
    return none, None


def whole(study: DesignStudy) -> bool:
    """Return whether a design was proved to the end, holding or not: all draws, a queue at each fill."""
    return study.robust.draws >= study.request.draws and queues.is_complete(study.queues)


def tried_nearest(
    study: DesignStudy, rate: float, change: str, *, trials: int = 0, proofs: int = 1
) -> NearestDesign:
    """Return the nearest that holds as a design showed it that was proved.

    Parameters
    ----------
    study : DesignStudy
        With a bowl, its draws and its queues.
    rate : float [1/s]
        At which it holds.
    change : str
        What is changed for it.
    trials, proofs : int
        How many were made to find it.
    """
    bowl = study.bowl
    return NearestDesign(
        rate=rate,
        change=change,
        wanted=study.wanted,
        chain=tuple(f"{device.kind}: {device.text}" for device in study.devices),
        frequency=None if bowl is None else bowl.drive.frequency,
        peak_to_peak=None if bowl is None else 2.0 * bowl.drive.amplitude,
        throw_number=None if bowl is None else float(throw_number(bowl)),
        trials=trials,
        proofs=proofs,
        draws=study.robust.draws,
        draws_held=study.robust.held,
        queue_seconds=study.queue_seconds,
        parts_right=sum(queue.right for queue in study.queues),
        parts_left=sum(queue.left for queue in study.queues),
    )


def _holding(
    search: Search, rate: float, variant: Variant, study: DesignStudy, denied: list[str], proofs: int
) -> NearestDesign:
    """The nearest that holds, with what else was tried and what else helps."""
    near = tried_nearest(study, rate, variant.change, trials=len(search.attempts), proofs=proofs)
    helps = [*_helps(search, study, variant.candidate)]
    bowls = math.ceil(search.request.target / rate - SLIGHT)
    if bowls > 1:
        helps.append(f"{bowls} such bowls bring the {MINUTE * search.request.target:.4g}/min asked for")
    return replace(near, denied=tuple(denied), helps=tuple(helps))


def _slower(candidate: Candidate) -> str:
    return f"a lower rate, the same bowl at {_drive(candidate.bowl)}"


def _drive(bowl: Bowl) -> str:
    return f"{2e3 * bowl.drive.amplitude:.3g} mm peak to peak, throw number {throw_number(bowl):.2g}"


def _lacks(study: DesignStudy) -> str:
    """What a design lacks beside parts a minute, in few words."""
    slow = replace(study, request=replace(study.request, target=1e-9))
    return next(iter(slow.shortfalls), "nothing is delivered")


def variants(search: Search, proofs: Proofs) -> Iterator[Variant]:
    """Yield designs near those that do not hold, the cheapest change first, each clean in its short trial.

    Parameters
    ----------
    search : Search
    proofs : list of (DesignStudy, Candidate)
    """
    left, proved = TRIALS, {id(candidate) for _, candidate in proofs}
    for study, candidate in proofs:
        if _by_motion(study) and left:
            other = _calmer(search, candidate)
            left -= other is not None
            if other is not None and other.attempt.clean:
                yield Variant(f"a calmer drive, {_drive(other.bowl)}", other, search)
    clean = [candidate for candidate in search.passed if id(candidate) not in proved]
    for candidate in sorted(clean, key=lambda candidate: -candidate.attempt.rate):
        calm = candidate.proposal.step.startswith("calmer drive")
        change = f"a calmer drive, {_drive(candidate.bowl)}" if calm else _slower(candidate)
        wanted = [candidate.attempt.wanted for _, candidate in proofs]
        if wanted and candidate.attempt.wanted not in wanted:
            change = _other_way(candidate)
        yield Variant(change, candidate, search)
    yield from _any_heading(search, proofs)
    for study, candidate in proofs:
        if left and study.queues and not study.purity[0] >= PURE:
            other = _one_device_more(search, study, candidate)
            left -= other is not None
            if other is not None and other.attempt.clean:
                yield Variant(f"one device more, {other.proposal.step}", other, search)
    for other in _calmed(search, left):
        yield Variant(f"a calmer drive, {_drive(other.bowl)}", other, search)
    yield from _other_ways_up(search)


def _by_motion(study: DesignStudy) -> bool:
    """Whether a calmer drive may mend a design: it is not slow alone, and no device let others through."""
    impure = bool(study.queues) and (bool(study.jams) or not study.purity[0] >= PURE)
    return impure or "is lost (" in study.robust.worst


def _in_turn(pending: list[Iterator[Variant]]) -> Iterator[Variant]:
    """Yield from the last of several iterators; others may be added behind it meanwhile."""
    while pending:
        variant = next(pending[-1], None)
        if variant is None:
            pending.pop()
        else:
            yield variant


def _calmer_variants(variant: Variant, study: DesignStudy) -> Iterator[Variant]:
    """A variant at a calmer drive, where its proof was denied by motion and the calmer one is clean."""
    other = _calmer(variant.search, variant.candidate) if _by_motion(study) else None
    if other is not None and other.attempt.clean:
        yield replace(variant, change=f"a calmer drive, {_drive(other.bowl)}", candidate=other)


def _calmer(search: Search, candidate: Candidate) -> Candidate | None:
    plain_bowl = _plain_bowl(search, candidate)
    bowl = calm_drive.calmer(plain_bowl, candidate.bowl)
    if bowl is None or _tried_at(search, candidate, bowl):
        return None
    return exploring.calmer(search, plain_bowl, candidate, candidate.weights)


def _tried_at(search: Search, candidate: Candidate, bowl: Bowl) -> bool:
    """Whether a chain was tried at the drive of a bowl."""
    return any(
        attempt.chain == candidate.attempt.chain and attempt.peak_to_peak == 2.0 * bowl.drive.amplitude
        and abs(attempt.throw_number - throw_number(bowl)) < 1e-6
        for attempt in search.attempts
    )  # fmt: skip


def _plain_bowl(search: Search, candidate: Candidate) -> calm_drive.PlainBowl:
    return calm_drive.PlainBowl(
        replace(candidate.bowl, devices=()), search.kept_keys, None, search.request.drive
    )


def _any_heading(search: Search, proofs: Proofs) -> Iterator[Variant]:
    """Designs whose aspect left a queue at other headings: any heading of it counted."""
    if search.request.heading is not None:
        return
    for study, candidate in proofs:
        aspect = (study.wanted or "").partition("@")[0]
        if aspect + HEADING_OFF not in dict(study.left_instead) or aspect in candidate.proposal.any_heading:
            continue
        request = replace(search.request, aspect=None, up=tuple(dict.fromkeys((*search.request.up, aspect))))
        lying = candidate.orientations.lying
        proposal = replace(
            candidate.proposal,
            same=proposals.equivalent_rows(lying, candidate.proposal.row, request.up),
            any_heading=proposals.free_headings(lying, candidate.proposal.row, request),
        )
        states = short_trials.wanted_states(candidate.orientations, proposal.rows)
        other = replace(
            candidate, proposal=proposal, tried=replace(candidate.tried, state=states[0], states=states)
        )
        free = _other_search(search, request)
        yield Variant(f"any heading of {aspect} counted, --up {','.join(request.up)}", other, free, False)


def _one_device_more(search: Search, study: DesignStudy, candidate: Candidate) -> Candidate | None:
    """The chain with a drop before it for what left a queue instead of what is wanted; None without one."""
    names = {name.partition("@")[0].removesuffix(HEADING_OFF) for name, _ in study.left_instead}
    orientations, proposal = candidate.orientations, candidate.proposal
    wanted = short_trials.wanted_rows(orientations, candidate.tried.states)
    rows = [
        k
        for k, orientation in enumerate(orientations.lying)
        if orientation.aspect in names and k not in wanted
    ]
    changed = proposals.dropped_before(proposal, rows, wanted, orientations.lying)
    if changed is None:
        return None
    return exploring.attempted(
        search, _plain_bowl(search, candidate), changed, candidate.weights, candidate.bowl
    )


def _other_search(search: Search, request: DesignRequest) -> Search:
    """A search for another request that tells and counts as the first one does."""
    return replace(
        search, request=request, passed=[], failed=[], avoided={}, most=np.inf, further=None,
        first=len(search.attempts), tracks=[], proposed={}, chains=set(), lost_behind=[], reach=np.inf,
    )  # fmt: skip


def _other_ways_up(search: Search) -> Iterator[Variant]:
    """Ways up that are clean in a trial, of all where only some were asked for: fast ones first."""
    first_request = search.request
    if first_request.aspect is None and not first_request.up and first_request.outcome == "any":
        return
    request = replace(first_request, aspect=None, heading=None, up=(), outcome="any")
    free = _other_search(search, replace(request, budget=len(search.attempts) + FREE_TRIALS))
    yielded = set()
    for candidate in exploring.candidates(free):
        yielded.add(id(candidate))
        yield Variant(_other_way(candidate), candidate, free, False)
    for candidate in sorted(free.passed, key=lambda candidate: -candidate.attempt.rate):
        if id(candidate) not in yielded:
            yield Variant(_other_way(candidate), candidate, free, False)
    for candidate in _calmed(free, FREE_CALMED):
        yield Variant(_other_way(candidate), candidate, free, False)


def _calmed(search: Search, most: int) -> Iterator[Candidate]:
    """Chains that failed, clean at a calmer drive: those of which most left first; so many trials at most."""
    left = most
    for candidate in sorted(
        search.failed, key=lambda candidate: (-candidate.attempt.efficiency, len(candidate.attempt.faults))
    ):
        if not left:
            break
        if (
            not candidate.attempt.efficiency > 0.0
            and candidate.attempt.throw_number <= calm_drive.CALM_THROW_NUMBER + 1e-3
        ):
            continue
        other = _calmer(search, candidate)
        left -= other is not None
        if other is not None and other.attempt.clean:
            yield other


def _other_way(candidate: Candidate) -> str:
    return f"another way up, {candidate.attempt.wanted}, at {_drive(candidate.bowl)}"


def _helps(search: Search, study: DesignStudy, chosen: Candidate | None) -> Iterator[str]:
    """What else was clean in a short trial, or would count more parts."""
    named = {study.wanted}
    for candidate in sorted(search.passed, key=lambda candidate: -candidate.attempt.rate):
        if candidate is not chosen and candidate.attempt.wanted not in named:
            named.add(candidate.attempt.wanted)
            rate = MINUTE * candidate.attempt.rate
            yield f"{candidate.attempt.wanted} got through its short trial at {rate:.3g}/min"
    off = [name.removesuffix(HEADING_OFF) for name, _ in study.left_instead if name.endswith(HEADING_OFF)]
    own = (study.wanted or "").partition("@")[0]
    if own and own in off and own not in search.request.up:
        yield f"--up {own} counts {own} at any heading"
