"""The loop: an orientation and its chain, a short trial, what the trial denies changed, and the proof."""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.conveying.hop import hop
from feederscrew.designing import (
    calm_drive,
    exploring,
    hazards,
    nearest,
    proposals,
    queues,
    short_trials,
)
from feederscrew.designing.exploring import Candidate, Progress, Search
from feederscrew.designing.long_rides import LongRide, long_ride
from feederscrew.designing.proposals import COST_CLASSES
from feederscrew.designing.record import (
    DRAWS_HELD,
    HOLDS,
    NONE,
    NOT_TRIED,
    RATE_KEPT,
    Alternative,
    Attempt,
    DesignRequest,
    DesignStudy,
    FilledQueue,
    NearestDesign,
    RobustRun,
)
from feederscrew.designing.robust import robust_run
from feederscrew.dropping.plate_test import throw_number
from feederscrew.errors import ArgumentError
from feederscrew.geometry import vectors
from feederscrew.part.record import Part, refuse_many_facets
from feederscrew.rates.stream import Orientations
from feederscrew.resting.aspects import Aspects, find
from feederscrew.studies.rate import Shares
from feederscrew.studies.tooling import ToolingStudy, may_be_left_out, may_be_up
from feederscrew.tooling.devices.kinds import cost_class as cost_class_of
from feederscrew.tooling.devices.orientation_names import rows
from feederscrew.tooling.isolating import proposal as static
from feederscrew.tooling.isolating.chain import DesignConstraints
from feederscrew.tooling.isolating.design import place
from feederscrew.tooling.orientations import orientations
from feederscrew.trial.result import TrialRun

ANY_RATE = 1e-6  # [1/s] a target below any rate
PROVED, DRAWN = 2, 4  # designs of a cost class that go through queues, and through draws
CHANGES = 2  # of one design, each by what its proof denied
LIVELY_HOP_M = 1.2e-4  # hop from which jams ask for a device, not for a livelier drive
FASTER = 1.3  # times as fast, where draws lose what is wanted: what creeps over a slot falls in late
Proofs = list[tuple[DesignStudy, Candidate]]


def design(
    part: Part,
    plain: Bowl,
    kept_keys: Collection[str],
    request: DesignRequest,
    *,
    shares: Shares | None = None,
    tell: Callable[[str], None] | None = None,
    before: Callable[[], None] | None = None,
    progress: Progress | None = None,
    with_nearest: bool = True,
) -> DesignStudy:
    """Design a bowl that brings a part at a rate, and try it.

    Parameters
    ----------
    part : Part
        From a mesh.
    plain : Bowl
        What the user gave, completed by the defaults; its devices are kept.
    kept_keys : collection of str
        Names of the keys the user gave.
    request : DesignRequest
    shares : Shares, optional
        What arrives, where the user says so; else what lies on the moving floor of the designed bowl.
    tell : callable, optional
        Called with what is being tried, a sentence.
    before : callable, optional
        Called before anything is compiled, and before the first trial is told.
    progress : callable, optional
        Called with what is done ('trial', 'draws', 'queue'), how many of how many, the seconds gone and a
        guess of those to go.
    with_nearest : bool
        Whether the nearest that holds is looked for where it does not.

    Returns
    -------
    DesignStudy

    Raises
    ------
    FeederError
        If the part has no surface or very many facets, fits no bowl, or has no such aspect.
    """
    _check_named(part, plain, request, shares)
    search = Search(
        part, request, plain, frozenset(kept_keys), tell or (lambda text: None), shares, before=before,
        progress=progress,
    )  # fmt: skip
    search.shares_given = shares is not None
    proofs: Proofs = []
    searched: list[int] = []
    try:
        for cost_class in proposals.COST_CLASSES:
            searched.append(cost_class)
            _search_class(search, cost_class, proofs)
            if _answered(search, proofs):
                break
        near, nearby = _nearest(search, proofs) if with_nearest else (None, None)
        if nearby is None:
            _make_whole(search, proofs)
    except KeyboardInterrupt:
        return replace(_listed(search, proofs, searched, _best(search, proofs)), partial=True)
    best = _listed(search, proofs, searched, nearby or _best(search, proofs))
    if any(study.partial for study, _ in proofs):  # which of them it is
        return replace(best, partial=True)
    return best if best.status == HOLDS else replace(best, nearest=near)


def _listed(search: Search, proofs: Proofs, searched: list[int], best: DesignStudy) -> DesignStudy:
    """The design with every short trial, and beside the best of each cost class."""
    studies = [study for study, _ in proofs] + ([best] if best.queues else [])
    rows = alternatives(studies, search.attempts, searched)
    return replace(best, attempts=tuple(search.attempts), alternatives=rows)


def _nearest(search: Search, proofs: Proofs) -> tuple[NearestDesign | None, DesignStudy | None]:
    """The nearest that holds, and its design where that leaves what was asked for.

    None where a design holds, or was stopped.
    """
    if any(study.status == HOLDS or study.partial for study, _ in proofs):
        return None, None
    slow = [proof for proof in proofs if nearest.only_slow(proof[0]) and not nearest.whole(proof[0])]
    if slow:  # its queue ended as soon as it was too slow
        study, candidate = max(slow, key=lambda one: merit(one[0]))
        proofs[:] = [proof for proof in proofs if proof[1] is not candidate]
        proofs.append((proved(search, candidate, whole=True, drawn=study.robust), candidate))
        if proofs[-1][0].partial:
            return None, None
    return nearest.nearest(_best(search, proofs), search, proofs, _proved_at_any_rate)


def _proved_at_any_rate(search: Search, candidate: Candidate) -> DesignStudy:
    """The design with its draws and its queue, which ends where it is impure or jams, however slow it is."""
    request = replace(search.request, target=ANY_RATE)
    study = proved(replace(search, request=request), candidate, whole=False)
    return replace(study, request=search.request)


def _best(search: Search, proofs: Proofs) -> DesignStudy:
    """The cheapest design that holds, or the best so far as far as it was proved; else the best attempt."""
    if proofs:
        return max((study for study, _ in proofs), key=_cheapest)
    candidate = _likeliest(search)
    if candidate is None or search.shares is None:
        return _without(search)
    return _unproved(search, candidate, search.shares)


def _cheapest(study: DesignStudy) -> tuple[float, tuple[bool, bool, float, float]]:
    """What of two designs is the better one: of those that hold the one of the cheaper cost class."""
    return -cost_class_of(study.devices) if study.status == HOLDS else -math.inf, merit(study)


def _likeliest(search: Search) -> Candidate | None:
    """The best of the attempts that deliver anything: clean, then of fewer faults, then faster."""
    order = [candidate for candidate in (*search.passed, *search.failed) if candidate.attempt.rate > 0.0]
    return max(
        order,
        key=lambda one: (one.attempt.clean, -len(one.attempt.faults), one.attempt.rate),
        default=None,
    )


def _check_named(part: Part, plain: Bowl, request: DesignRequest, shares: Shares | None) -> None:
    """Raise FeederError for what is asked for and is not there: an aspect, its heading, a kind of device."""
    refuse_many_facets(part)
    may_be_left_out(request.without)
    if part.vertices is None:
        return
    aspects = find(part) if shares is None else shares.aspects
    may_be_up(part, aspects, request.up)
    if request.aspect is None:
        return
    rows(aspects.names, request.aspect, f"aspect of {part.source}", ArgumentError)
    if request.heading is None:
        return
    wide = max(plain.track.radius, float(vectors.length(np.ptp(part.vertices, axis=0))))  # one that it fits
    track = replace(plain.track, radius=wide)
    all_orientations = orientations(part, aspects, track)
    place(all_orientations, request.aspect, request.heading, part.source)


def _search_class(search: Search, cost_class: int, proofs: Proofs) -> None:
    """Prove the best chains of a cost class, until one holds or enough of them do not."""
    own: Proofs = []
    for candidate in exploring.candidates(search, cost_class):
        before = len(proofs)
        _prove(search, candidate, proofs)
        own += proofs[before:]
        queued = sum(bool(study.queues) for study, _ in own)
        if own[-1][0].status == HOLDS or own[-1][0].partial or queued >= PROVED or len(own) >= DRAWN:
            break


def _answered(search: Search, proofs: Proofs) -> bool:
    """Whether no dearer cost class is searched: one was stopped, or one holds and no alternative is asked."""
    if any(study.partial for study, _ in proofs):
        return True
    return any(study.status == HOLDS for study, _ in proofs) and not search.request.alternatives


def _prove(search: Search, candidate: Candidate, proofs: Proofs) -> None:
    """Prove a design as far as it holds; then, ``CHANGES`` times, one with what denied it changed."""
    for _ in range(CHANGES + 1):
        study = proved(search, candidate, whole=False)
        proofs.append((study, candidate))
        if study.status == HOLDS or study.partial or search.spent:
            return
        other = _changed(search, study, candidate)
        if other is None or not other.attempt.clean:
            return
        candidate = other


def _changed(search: Search, study: DesignStudy, candidate: Candidate) -> Candidate | None:
    """A design at another drive, with another value or one device more, by what its proof denied.

    None where there is nothing to change.
    """
    plain_bowl = calm_drive.PlainBowl(
        replace(candidate.bowl, devices=()), search.kept_keys, None, search.request.drive
    )
    weights, worst = candidate.weights, (study.robust.worst,)
    if study.jams:
        lively = (
            exploring.livened(search, plain_bowl, candidate, weights) if _is_calm(candidate.bowl) else None
        )
        if lively is not None and lively.attempt.clean:
            return lively
        return _with_change(search, plain_bowl, candidate, proposals.relieved(candidate))
    if nearest.only_slow(study):
        search.reserve *= 1.1 * RATE_KEPT * search.request.target / study.delivered[1]
        return _faster(search, plain_bowl, candidate)
    if study.robust.share < DRAWS_HELD:
        if nearest.only_lost(study):
            search.least = FASTER * calm_drive.speed(candidate.bowl)
            other = _faster(search, plain_bowl, candidate)
            search.least = 0.0
            if other is not None:
                return other
        if exploring.stays_at_steel(candidate.proposal, worst):
            return exploring.livened(search, plain_bowl, candidate, weights)
        tried, lying = candidate.tried, candidate.orientations.lying
        changed = proposals.better(candidate.proposal, tried, lying, study.robust)
        return _with_change(search, plain_bowl, candidate, changed)
    return _with_change(search, plain_bowl, candidate, proposals.purer(candidate, study.left_instead))


def _is_calm(bowl: Bowl) -> bool:
    """Whether parts hop so low that a livelier drive may clear what jams."""
    return hop(bowl).height < LIVELY_HOP_M


def _faster(search: Search, plain_bowl: calm_drive.PlainBowl, candidate: Candidate) -> Candidate | None:
    """The same chain at the drive that is now asked for; None where that is the one it was proved at."""
    bowl = exploring.driven_for(search, plain_bowl, candidate.proposal, candidate.weights)
    if bowl.drive == candidate.bowl.drive:
        return None
    return exploring.attempted(search, plain_bowl, candidate.proposal, candidate.weights, bowl)


def _with_change(
    search: Search,
    plain_bowl: calm_drive.PlainBowl,
    candidate: Candidate,
    proposal: proposals.Proposal | None,
) -> Candidate | None:
    """A changed chain at the drive of the one it was made of; None without a change."""
    if proposal is None:
        return None
    return exploring.attempted(search, plain_bowl, proposal, candidate.weights, candidate.bowl)


def _make_whole(search: Search, proofs: Proofs) -> None:
    """Prove the best design to the end, though it does not hold; the best attempt where none was proved."""
    if any(study.status == "holds" or study.partial for study, _ in proofs):
        return
    if proofs:
        study, candidate = max(proofs, key=lambda one: merit(one[0]))
        drawn = study.robust
        if nearest.whole(study):
            return
    else:
        drawn, likeliest = None, _likeliest(search)
        if likeliest is None:
            return
        candidate = likeliest
    proofs[:] = [proof for proof in proofs if proof[1] is not candidate]
    proofs.append((proved(search, candidate, whole=True, drawn=drawn), candidate))


def proved(
    search: Search, candidate: Candidate, *, whole: bool, drawn: RobustRun | None = None
) -> DesignStudy:
    """Return the design with its draws and its queue; unless ``whole``, only as far as it holds.

    Parameters
    ----------
    search : Search
    candidate : Candidate
    whole : bool
    drawn : RobustRun, optional
        All draws of that candidate, where they were made: they would come out the same.
    """
    shares, candidate = exploring.at_its_drive(search, candidate)
    ride, candidate = _at_the_tooling(search, candidate)
    bowl, oriented, row = candidate.bowl, candidate.orientations, candidate.proposal.row
    study = replace(_unproved(search, candidate, shares), long_ride=ride)
    if drawn is None or drawn.draws < search.request.draws:
        drawn = _drawn(search, candidate, ride.either, whole=whole)
    study = replace(study, robust=drawn, partial=drawn.partial)
    if drawn.partial or not (whole or drawn.share >= DRAWS_HELD):
        return study
    try:
        study = _in_queues(search, study, candidate, shares, ride.entering, whole=whole)
    except KeyboardInterrupt:
        return replace(study, partial=True)
    frequent = [oriented.lying[k] for k in short_trials.often(candidate.weights)]
    named_risks = hazards.risks(
        oriented.lying[row], bowl, study.queues, orientations=frequent, seed=search.request.seed
    )
    return replace(study, risks=named_risks)


def _at_the_tooling(search: Search, candidate: Candidate) -> tuple[LongRide, Candidate]:
    """A ride along the track to the tooling, and the candidate with the mix that arrives there."""
    search.tell(f"ride along the track: {candidate.attempt.wanted}")
    oriented, weights = candidate.orientations, candidate.weights
    wanted = short_trials.wanted_rows(oriented, candidate.tried.states)
    ride = long_ride(search.part, candidate.bowl, oriented.lying, weights, wanted, search.request.run)
    return ride, replace(candidate, weights=ride.arriving)


def _drawn(search: Search, candidate: Candidate, shares: np.ndarray, *, whole: bool) -> RobustRun:
    """The draws of a design, of parts that come in some shares (M,) [1]; unless whole, while it may hold."""
    request = search.request
    text = f"{request.draws} of part, friction, drive and cuts"
    search.begin_proof(f"draws: {candidate.attempt.wanted}, {text}")
    return robust_run(
        search.part, candidate.bowl, candidate.orientations, shares, candidate.proposal.rows,
        draws=request.draws, tolerance=request.tolerance, run=search.run("draws"),
        any_heading=candidate.proposal.any_heading, spared=short_trials.spared_rows(candidate.tried),
        enough=search.enough(candidate.attempt),
        allowed=None if whole else math.floor((1.0 - DRAWS_HELD) * request.draws + 1e-9),
    )  # fmt: skip


def _in_queues(
    search: Search,
    study: DesignStudy,
    candidate: Candidate,
    shares: Shares,
    entering: np.ndarray,
    *,
    whole: bool,
) -> DesignStudy:
    """The design with its queues, as far as it holds unless ``whole``, and with the slowest for longer.

    Parts that touch on their way come as they enter the track, in shares (M,) [1]: they ride otherwise than
    alone.
    """
    search.tell(f"queue: {candidate.attempt.wanted}, {candidate.proposal.sentence}")
    line = queues.FollowedRow(
        search.part, candidate.bowl, shares.aspects, candidate.orientations, candidate.weights,
        candidate.tried.states, search.request.seed, search.tell, RATE_KEPT * search.request.target,
        candidate.proposal.any_heading, search.run("queue").progress, entering, search.request.jobs,
    )  # fmt: skip
    study = _queued(study, queues.filled(line, whole=whole))
    return _queued(study, queues.longer(line, study))


def _queued(study: DesignStudy, queues_seen: tuple[FilledQueue, ...]) -> DesignStudy:
    return replace(study, queues=queues_seen, partial=any(queue.partial for queue in queues_seen))


def _unproved(search: Search, candidate: Candidate, shares: Shares) -> DesignStudy:
    """The design before anything of it is proved."""
    bowl, oriented, weights = candidate.bowl, candidate.orientations, candidate.weights
    request, margin = search.request, proposals.MARGINS[-1]
    return DesignStudy(
        part=search.part,
        request=request,
        bowl=bowl,
        wanted=_counting(candidate.attempt.wanted, request),
        turn=candidate.proposal.row,
        cuts=candidate.proposal.cuts,
        before=candidate.proposal.before,
        attempts=tuple(search.attempts),
        source=shares.aspects.source(request.rule),
        static_rate=_static(search, candidate),
        slowed=calm_drive.velocity_kept(bowl),
        trials=tuple(
            TrialRun(bowl, throw_number(bowl), oriented, weights, course)
            for course in candidate.tried.courses
        ),
        tooling=tooled(
            search.part, bowl, shares.aspects, oriented, weights, candidate.proposal, request, margin
        ),
    )


def tooled(
    part: Part,
    bowl: Bowl,
    aspects: Aspects,
    oriented: Orientations,
    weights: np.ndarray,
    proposal: proposals.Proposal,
    request: DesignRequest,
    margin: float,
) -> ToolingStudy | None:
    """Return a chain as `feeder tooling` would have found it; None without one.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    aspects : Aspects
    oriented : Orientations
        Through the devices; M of them.
    weights : (M,) float [1]
        In which they come.
    proposal : Proposal
    request : DesignRequest
    margin : float [m]

    Returns
    -------
    ToolingStudy or None
    """
    if not proposal.cuts:
        return None
    task = static.design_task(
        oriented.lying,
        weights,
        proposal.row,
        margin,
        1.0,
        proposal.before,
        constraints=DesignConstraints(up=request.up),
    )
    same = np.isin(oriented.leaves_as, proposal.states(oriented))
    static_design = static.propose(task, proposal.cuts, oriented.through < 0.5, same)
    designs = tuple(static_design if k == proposal.row else None for k in range(len(weights)))
    return ToolingStudy(
        part, bowl, aspects, request.rule, margin, oriented.lying, weights, designs, proposal.row, request.up
    )


def _counting(name: str, request: DesignRequest) -> str:
    """The name of what leaves, with the aspects that count as it."""
    names = [aspect for aspect in request.up if aspect.casefold() != name.partition("@")[0].casefold()]
    return " or ".join((name, *names))


def _static(search: Search, candidate: Candidate) -> float:
    """Wanted parts [1/s] that the static rule promises."""
    oriented, weights = candidate.orientations, candidate.weights
    gain = short_trials.gain(oriented, weights, candidate.tried.states)
    return calm_drive.speed(candidate.bowl) * gain / float((weights * oriented.lengths).sum())


def _without(search: Search) -> DesignStudy:
    """What is said where nothing was proved."""
    source = "" if search.shares is None else search.shares.aspects.source(search.request.rule)
    return DesignStudy(
        search.part, search.request, None, None, None, attempts=tuple(search.attempts), source=source
    )


def merit(study: DesignStudy) -> tuple[bool, bool, float, float]:
    """Return what of two designs is the better one: holds, then clean, then the most parts."""
    return study.status == HOLDS, study.jams == 0, study.robust.share, study.delivered[1]


def alternatives(
    studies: Sequence[DesignStudy], attempts: Sequence[Attempt], searched: Collection[int]
) -> tuple[Alternative, ...]:
    """Return the best of each cost class, the cheapest class first.

    Parameters
    ----------
    studies : sequence of DesignStudy
        That were proved, as far as they were.
    attempts : sequence of Attempt
        Every short trial.
    searched : collection of int
        Cost classes of which chains were looked for.
    """
    best_of: list[Alternative] = []
    holds = any(study.status == HOLDS for study in studies)
    for number in COST_CLASSES:
        own = [
            study for study in studies if study.bowl is not None and cost_class_of(study.devices) == number
        ]
        tried = [attempt for attempt in attempts if attempt.cost_class == number]
        if own:
            best_of.append(of_study(max(own, key=merit)))
        elif tried:
            best = max(tried, key=lambda one: (one.clean, one.efficiency, one.rate))
            faults = ", ".join(best.faults[:2]) or "too slow in its short trial"
            best_of.append(Alternative(number, NONE, chain=best.chain, why=f"{best.wanted}: {faults}"))
        elif number in searched:
            best_of.append(
                Alternative(number, NONE, why="no chain of this class tells what is wanted from the rest")
            )
        else:
            why = "a cheaper one holds: --alternatives proves this class too" if holds else "it was stopped"
            best_of.append(Alternative(number, NOT_TRIED, why=why))
    return tuple(best_of)


def of_study(study: DesignStudy) -> Alternative:
    """Return a design as the alternative of its cost class."""
    purity, share = study.purity[0], study.efficiency
    counts = bool(study.queues) and not study.partial  # what was stopped is no evidence
    sensors: list[Any] = [device for device in study.devices if device.senses]
    return Alternative(
        cost_class=cost_class_of(study.devices),
        status=study.status,
        delivered=study.delivered if counts else None,
        purity=None if np.isnan(purity) or not counts else purity,
        efficiency=None if np.isnan(share) or not counts else share,
        chain=tuple(f"{device.kind}: {device.text}" for device in study.devices),
        chain_words=tuple(f"{device.full_name}: {device.value_words}" for device in study.devices),
        sees=tuple(device.sees for device in sensors),
        why="; ".join(study.shortfalls) if study.status != HOLDS else "",
    )
