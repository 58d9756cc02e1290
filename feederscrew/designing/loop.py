"""The loop: an orientation and its chain, a short trial, what the trial denies changed, and the proof."""

import itertools
import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from feederscrew.arrivals.entry import Shares
from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base.errors import ArgumentError
from feederscrew.base.geometry import vectors
from feederscrew.bowl.devices.kinds import cost_class as cost_class_of
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import DRAWS_HELD, HELD, RATE_KEPT, Status
from feederscrew.designing import (
    calm_drive,
    exploring,
    hazards,
    long_proof,
    nearest,
    proposals,
    queues,
    quick,
    short_trials,
    texts,
    verdict_texts,
)
from feederscrew.designing.fill_verdicts import longest_time
from feederscrew.designing.findings import FaultKind
from feederscrew.designing.progress import Progress, SearchProgress, SearchStage, TrialBudget
from feederscrew.designing.proof import Proof, RobustRun
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import (
    Alternative,
    Attempt,
    DesignRequest,
    DesignStudy,
    NearestDesign,
    ProofKind,
)
from feederscrew.designing.search import Candidate, Search
from feederscrew.designing.short_trials import robust_run
from feederscrew.machine.drive_sizing import drive_shortfall, is_two_axis
from feederscrew.motion.hop import hop
from feederscrew.part.record import Part, refuse_many_facets
from feederscrew.sorting.isolating import chain as static
from feederscrew.sorting.isolating.chain import DesignConstraints
from feederscrew.sorting.tooling import ToolingStudy, check_named
from feederscrew.trials.fills import FedRow, FilledQueue, FillLevel, JammedParts, PoseKind
from feederscrew.trials.long_ride import long_ride
from feederscrew.trials.result import TrialRun

ANY_RATE = 1e-6  # [1/s] a target below any rate
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
    complete: Callable[[DesignStudy], DesignStudy] | None = None,
) -> DesignStudy:
    """Design a bowl that brings a part at a rate, and try it.

    A request that is ``quick`` ends with the first chain, which is not proved.

    Parameters
    ----------
    part : Part
        From a mesh.
    plain : Bowl
        As the user gave it, completed by the defaults: its devices are kept.
    kept_keys : collection of str
        Names of keys that are kept of it.
    request : DesignRequest
    shares : Shares, optional
        Arriving parts where the user says so, else those on the moving floor of the designed bowl.
    tell : callable, optional
        Called with what is being tried, a sentence.
    before : callable, optional
        Called before anything is compiled, and before the first trial is told.
    progress : callable, optional
        Called with what is done ('trial', 'draws', 'queue'), how many of how many, the seconds gone and a
        guess of those to go if what is tried holds.
    with_nearest : bool, optional
        Whether the nearest that holds is looked for where the design does not.
    complete : callable, optional
        Returns a design with its machine. Where no springs make the drive of a design that holds, its chain
        is tried and proved at a flatter vibration angle; without it, it is not.

    Returns
    -------
    DesignStudy
        ``partial`` where it was stopped.

    Raises
    ------
    FeederError
        If the part has no surface or very many facets, fits no bowl, or has no such aspect.
    """
    check_request(part, plain, request, shares)
    said = SearchProgress(before=before, report=progress)
    if tell is not None:
        said.tell = tell
    search = Search.begin(part, request, plain, kept_keys, shares=shares, progress=said)
    policy = search.policy
    proofs: Proofs = []
    classes: list[int] = []
    try:
        if request.quick:
            first_one = quick.first_chain(search)
            bare = (
                _best(search, proofs) if first_one is None else _study_of(search, first_one, search.arrivals)
            )
            return quick.completed(bare, search, first_one)
        for cost_class in proposals.COST_CLASSES:
            classes.append(cost_class)
            first = len(proofs)  # the best chains of a class, until one holds or enough of them do not
            most = search.state.denied + policy.denied_in_class[proposals.COST_CLASSES.index(cost_class)]
            for candidate in exploring.candidates(search, cost_class):
                _prove(search, candidate, proofs, most)
                own, last = proofs[first:], proofs[-1][0]
                queued = sum(bool(study.proof.queues) for study, _ in own)
                enough = queued >= policy.queued_designs or len(own) >= policy.drawn_designs
                enough = enough or search.state.denied >= most
                if last.status in HELD or last.partial or enough:
                    break
            if any(study.partial for study, _ in proofs):
                break
            if any(study.status in HELD for study, _ in proofs) and not request.alternatives:
                break  # no dearer one is searched
        near, nearby = _nearest(search, proofs) if with_nearest else (None, None)
        # the best design is proved to the end, though it does not hold
        if nearby is None and not any(study.status in HELD or study.partial for study, _ in proofs):
            if proofs:
                study, candidate = max(proofs, key=lambda proof: merit(proof[0]))
                if not nearest.whole(study):
                    _prove_whole(search, proofs, candidate, study.proof.robust)
            elif (likeliest := _likeliest(search)) is not None:
                _prove_whole(search, proofs, likeliest, None)
    except KeyboardInterrupt:
        return replace(_list_alternatives(search, proofs, classes, _best(search, proofs)), partial=True)
    chosen = nearby or _best(search, proofs)
    if chosen.status in HELD and not any(study.partial for study, _ in proofs):
        shown = prove_long(chosen, said)
        proofs[:] = [(shown if study is chosen else study, candidate) for study, candidate in proofs]
        chosen = shown
    best = _list_alternatives(search, proofs, classes, chosen)
    if best.partial or any(study.partial for study, _ in proofs):  # which of them it is
        return replace(best, partial=True)
    if best.status not in HELD:
        return replace(best, nearest=near)
    holding = next((one for study, one in proofs if study is chosen), None)
    if complete is None or not with_nearest or holding is None or not _lacks_springs(search, holding):
        return best
    try:
        return _with_flatter_drive(search, holding, best, complete)
    except KeyboardInterrupt:
        return replace(best, partial=True)


def _lacks_springs(search: Search, candidate: Candidate) -> bool:
    """Tell whether the machine of a track does not make the leaf-spring drive of a candidate."""
    bare = replace(candidate.bowl, devices=())
    return not is_two_axis(bare.drive) and bool(drive_shortfall(bare, search.kept_keys))


def _with_flatter_drive(
    search: Search, candidate: Candidate, best: DesignStudy, complete: Callable[[DesignStudy], DesignStudy]
) -> DesignStudy:
    """The design with the nearest drive at a flatter angle, where no springs on any circle make its own."""
    made = complete(best)
    if made.status is not Status.NO_MACHINE or made.nearest is not None:
        return best
    search.tell(f"no leaf springs make the drive of {candidate.attempt.wanted}: flatter angles are tried")

    def prove(other: Search, flatter: Candidate) -> DesignStudy:
        return prove_design(other, flatter, whole=False)

    near = nearest.flatter_drive(best, search, candidate, prove, complete)
    return replace(best, attempts=tuple(search.state.attempts), nearest=near)


def _list_alternatives(search: Search, proofs: Proofs, classes: list[int], best: DesignStudy) -> DesignStudy:
    """The design with every short trial, and beside the best of each cost class."""
    state = search.state
    studies = [study for study, _ in proofs] + ([best] if best.proof.queues else [])
    rows = alternatives(studies, state.attempts, classes, best)
    return replace(best, attempts=tuple(state.attempts), alternatives=rows)


def _nearest(search: Search, proofs: Proofs) -> tuple[NearestDesign | None, DesignStudy | None]:
    """The nearest that holds, and its design where that leaves what was asked for.

    None where a design holds, or was stopped.
    """
    if any(study.status in HELD or study.partial for study, _ in proofs):
        return None, None
    slow = [proof for proof in proofs if nearest.only_slow(proof[0]) and not nearest.whole(proof[0])]
    if slow:  # its queue ended as soon as it was too slow
        study, candidate = max(slow, key=lambda proof: merit(proof[0]))
        _prove_whole(search, proofs, candidate, study.proof.robust)
        if proofs[-1][0].partial:
            return None, None

    def prove(other: Search, candidate: Candidate) -> DesignStudy:
        # its queue ends where it is impure or jams, however slow it is
        at_any_rate = replace(other, request=replace(other.request, target=ANY_RATE))
        longest = longest_time(other.request.target)
        study = prove_design(at_any_rate, candidate, whole=False, longest=longest)
        return replace(study, request=other.request)

    return nearest.nearest(_best(search, proofs), search, proofs, prove)


def _prove_whole(search: Search, proofs: Proofs, candidate: Candidate, robust: RobustRun | None) -> None:
    """Prove a design to the end, in place of what was proved of it."""
    proofs[:] = [proof for proof in proofs if proof[1] is not candidate]
    proofs.append((prove_design(search, candidate, whole=True, robust=robust), candidate))


def _best(search: Search, proofs: Proofs) -> DesignStudy:
    """The cheapest design that holds, or the best so far as far as it was proved; else the best attempt."""
    state = search.state

    def cheapest(study: DesignStudy) -> tuple[float, tuple[bool, bool, float, float]]:
        return -cost_class_of(study.devices) if study.status in HELD else -math.inf, merit(study)

    if proofs:
        return max((study for study, _ in proofs), key=cheapest)
    candidate = _likeliest(search)
    if candidate is not None and state.shares is not None:
        return _study_of(search, candidate, state.shares)
    source = "" if state.shares is None else state.shares.aspects.source(search.request.rule)
    return DesignStudy(
        search.part,
        search.request,
        None,
        None,
        None,
        attempts=tuple(state.attempts),
        source=source,
        arrivals=search.aspect_shares,
    )


def _likeliest(search: Search) -> Candidate | None:
    """The best of the attempts that deliver anything: clean, then of fewer faults, then faster."""
    state = search.state

    def likelihood(candidate: Candidate) -> tuple[bool, int, float]:
        attempt = candidate.attempt
        return attempt.clean, -len(attempt.faults), attempt.rate

    delivering = (candidate for candidate in (*state.clean, *state.failures) if candidate.attempt.rate > 0.0)
    return max(delivering, key=likelihood, default=None)


def check_request(part: Part, plain: Bowl, request: DesignRequest, shares: Shares | None = None) -> None:
    """Refuse what is asked for and is not there: an aspect, its heading, a kind of device.

    Parameters
    ----------
    part : Part
    plain : Bowl
    request : DesignRequest
    shares : Shares, optional
        As for ``design``.

    Raises
    ------
    FeederError
    """
    refuse_many_facets(part)
    wide, aspects = plain.track.radius, None if shares is None else shares.aspects
    if part.vertices is not None:
        thin = min(short_trials.principal_sizes(part))
        if not request.tolerance < thin:  # a part that is drawn so much smaller is none
            what = f"{1e3 * request.tolerance:.4g} mm is not less than the part's {1e3 * thin:.4g} mm"
            raise ArgumentError("tolerance", what, f"give less, as {100.0 * thin:.2g} mm")
        wide = max(wide, float(vectors.length(np.ptp(part.vertices, axis=0))))  # one that it fits
    track, names = replace(plain.track, radius=wide), {"up": request.up, "without": request.without}
    check_named(part, track, request.aspect, request.heading, aspects=aspects, **names)


def _prove(search: Search, candidate: Candidate, proofs: Proofs, most: float = math.inf) -> None:
    """Prove a design as far as it holds; then, a few times, one with what denied it changed.

    None is changed after queues that denied designs were followed for ``most`` [s] altogether.
    """
    for _ in range(search.policy.proof_changes + 1):
        study = prove_design(search, candidate, whole=False)
        proofs.append((study, candidate))
        if study.status in HELD or study.partial:
            return
        if lacks := verdict_texts.shortfall_texts(study):  # else nobody knows why the search goes on
            search.tell(f"{study.wanted} does not hold: {'; '.join(lacks)}")
        search.state.denied += study.proof.queue_seconds
        _note_jams(search, study, candidate)
        if search.is_spent or search.state.denied >= most:
            return
        proved = [one for _, one in proofs]
        other = _change_by_proof(search, study, candidate, proved)
        if other is None or not other.attempt.clean or _is_proved(other, proved):
            return
        candidate = other


def _jammed(study: DesignStudy) -> tuple[JammedParts, ...]:
    """What stood in the queues of a design, and where."""
    return tuple(stood for queue in study.proof.queues for stood in queue.jammed)


def _note_jams(search: Search, study: DesignStudy, candidate: Candidate) -> None:
    """Keep what stood in its queues at rails: a dearer class may take that off."""
    names = [one.name for one in candidate.orientations.lying]
    rows = (names.index(stood.name) for stood in _jammed(study) if stood.name in names)
    exploring.note_standing(search, candidate, rows)


def _is_proved(candidate: Candidate, proved: Iterable[Candidate]) -> bool:
    """Tell whether the chain of a candidate was proved at its drive: it would come out the same."""
    own = candidate.proposal.chain, candidate.bowl.drive
    return any((other.proposal.chain, other.bowl.drive) == own for other in proved)


def _change_by_proof(
    search: Search, study: DesignStudy, candidate: Candidate, proved: Sequence[Candidate] = ()
) -> Candidate | None:
    """A design at another drive, with another value or one device more, by what its proof denied.

    None where there is nothing to change but what was proved at this drive before.
    """
    state, policy = search.state, search.policy
    proposal, lying = candidate.proposal, candidate.orientations.lying
    if study.proof.jams:
        # what stood there, and where, says what to change
        jammed = _jammed(study)
        mends = exploring.mends_of_jams(search, candidate, jammed)
        for tried in _try_mends(search, candidate, mends, proved, policy.jam_mends):
            if tried.attempt.clean:
                return tried
        calm = hop(candidate.bowl).height < policy.lively_hop  # a livelier drive may clear what jams
        lively = exploring.try_livelier(search, candidate) if calm else None
        if lively is not None and lively.attempt.clean:
            return lively
        changed = proposals.add_pressure_break(candidate)
    elif nearest.only_slow(study):
        lacking = policy.slow_reserve * search.request.target / study.proof.delivered[0]
        state.reserve *= min(lacking, policy.slow_reserve_limit)
        return _faster(search, candidate)
    elif study.proof.robust.share < DRAWS_HELD:
        worst = study.proof.robust.main_fault
        if worst is not None and worst.kind is FaultKind.LOST and worst.is_stopped:
            # what is wanted gets stuck: a drive may be too slow
            state.min_speed = policy.faster * calm_drive.speed(candidate.bowl)
            other = _faster(search, candidate)
            state.min_speed = 0.0
            if other is not None:
                return other
        if exploring.stays_at_steel(proposal, () if worst is None else (worst,)):
            return exploring.try_livelier(search, candidate)
        changed = proposals.mend_proposal(proposal, candidate.trial, lying, worst)
    else:
        if _leaves_over_slot(study, candidate):
            # a livelier drive shakes down what may hang, and at a calmer one it comes over the slot slower
            for at_other_drive in (exploring.try_livelier, exploring.try_calmer):
                other = None if search.is_spent else at_other_drive(search, candidate)
                if other is not None and other.attempt.clean and other.attempt.rate >= search.request.target:
                    return other
        # what a full track lets past a sensor meets a second one; past steel, parts come apart
        ways = (
            proposals.add_second_sensor(candidate),
            *proposals.purify(candidate, study.proof.left_instead),
            proposals.spread_apart(candidate, search.request.without),
        )
        mends, losing = (mended for mended in ways if mended is not None), None
        for tried in _try_mends(search, candidate, mends, proved, policy.purity_mends):
            if tried.attempt.clean:
                return tried
            losing = losing or (tried if tried.trial.loses_wanted else None)
        if losing is None or search.is_spent:
            return None
        # parts that hop may be lost at one more device: a calmer drive may carry them past both
        return exploring.try_calmer(search, losing)
    if changed is None:
        return None
    tried = exploring.try_again(search, candidate, changed, candidate.bowl)
    if tried.attempt.clean or search.is_spent or not tried.trial.loses_wanted:
        return tried
    # parts that hop may be lost at one more device: a calmer drive may carry them past both
    return exploring.try_calmer(search, tried) or tried


def _try_mends(
    search: Search, candidate: Candidate, mends: Iterable[Proposal], proved: Sequence[Candidate], most: int
) -> Iterator[Candidate]:
    """Try changed chains at the drive of a candidate, so many at most; those proved there are left out."""
    known = {other.proposal.chain for other in proved if other.bowl.drive == candidate.bowl.drive}
    fresh = (mended for mended in mends if mended.chain not in known)
    for mended in itertools.islice(fresh, most):
        if mended.cost_class == proposals.AIR:
            search.leave_no_other_out()
        if search.is_spent:
            return
        yield exploring.try_again(search, candidate, mended, candidate.bowl)


def _leaves_over_slot(study: DesignStudy, candidate: Candidate) -> bool:
    """Tell whether what leaves lying, most of it, is an orientation of which parts hang in the trial."""
    rows = {candidate.orientations.lying[k].name for k in candidate.shown or ()}
    named = [pose for pose, _ in study.proof.left_instead if pose.kind is PoseKind.ORIENTATION]
    return bool(named) and named[0].name in rows


def _faster(search: Search, candidate: Candidate) -> Candidate | None:
    """The same chain at the drive that is now asked for; None where that is the one it was proved at."""
    plain_bowl = candidate.plain_bowl(search)
    bowl = exploring.drive_for_target(search, plain_bowl, candidate.proposal, candidate.weights)
    same = bowl.drive == candidate.bowl.drive
    return None if same else exploring.try_again(search, candidate, candidate.proposal, bowl)


def prove_design(
    search: Search,
    candidate: Candidate,
    *,
    whole: bool,
    robust: RobustRun | None = None,
    longest: float | None = None,
) -> DesignStudy:
    """Return the design with its draws and its queue.

    Parameters
    ----------
    search : Search
    candidate : Candidate
    whole : bool
        Whether it is proved to the end; else only as far as it holds.
    robust : RobustRun, optional
        All draws of that candidate, where they were made: they would come out the same.
    longest : float [s], optional
        Time of each fill at the most; that of the target without it.

    Returns
    -------
    DesignStudy
    """
    request, name, shares = search.request, candidate.attempt.wanted, search.arrivals
    if search.given_shares is None:  # the search took what arrives from one drive: here from the bowl's own
        own = exploring.entry_shares(search, candidate.bowl)
        oriented = search.orientations_along(candidate.bowl, own)
        names = [[lying.name for lying in each.lying] for each in (oriented, candidate.orientations)]
        if names[0] == names[1]:  # else its rows are others
            weights = np.nan_to_num(oriented.rules[request.rule])
            candidate = replace(candidate, orientations=oriented, weights=weights / weights.sum())
            shares = own
    # what may come more often than is known passes by the devices, or does not
    known = replace(candidate.trial, orientations=candidate.orientations, shares=candidate.weights)
    tried = exploring.try_untried(search, candidate.bowl, known, candidate.weights, candidate.proposal)
    candidate = replace(candidate, trial=tried)
    # a ride along the track to the tooling, where another mix arrives
    search.tell(f"{name}: a few parts of each orientation on the bare track, up to the tooling")
    oriented, proposal = candidate.orientations, candidate.proposal
    wanted = candidate.trial.wanted
    ride = long_ride(search.part, candidate.bowl, oriented.lying, candidate.weights, wanted, request.run)
    candidate = replace(candidate, weights=ride.arriving)
    study = _study_of(search, candidate, shares).proved_by(long_ride=ride)
    # draws; unless whole, while it may hold
    if robust is None or robust.draws < request.draws:
        search.begin_proof(f"draws: {name}, {request.draws} of part, friction, drive and cuts")
        robust = robust_run(
            search.part,
            candidate.bowl,
            oriented,
            0.5 * (ride.entering + ride.arriving),
            proposal.rows,
            draws=request.draws,
            tolerance=request.tolerance,
            run=search.run(SearchStage.DRAWS),
            any_heading=proposal.any_heading,
            returnable=short_trials.find_returnable_rows(candidate.trial),
            enough=search.share_needed(candidate.attempt),
            shown=candidate.shown,
            max_failures=None if whole else math.floor((1.0 - DRAWS_HELD) * request.draws + 1e-9),
        )
    study = replace(study.proved_by(robust=robust), partial=robust.partial)
    if robust.partial or not (whole or robust.share >= DRAWS_HELD):
        return study
    # queues; parts that touch on their way come as they enter the track
    row = FedRow(
        search.part,
        candidate.bowl,
        shares.aspects,
        oriented,
        candidate.weights,
        candidate.trial.states,
        proposal.any_heading,
        ride.entering,
    )
    study = study.proved_by(row=row)
    line = queues.FollowedRow(
        *(getattr(row, each.name) for each in fields(row)),
        seed=request.seed,
        tell=search.tell,
        least=RATE_KEPT * request.target,
        longest=longest_time(request.target) if longest is None else longest,
        progress=search.run(SearchStage.QUEUE).progress,
        jobs=request.jobs,
    )
    try:
        search.tell(f"queue: {name}, {proposal.sentence}")
        # a row that was followed before goes on where it was
        decides = long_proof.run_key(row, long_proof.Run(FillLevel.HIGH, request.seed, 0.0))
        running = search.state.queues_of(tuple(sorted(decides.items())))
        study = _with_queues(study, queues.follow_fills(line, whole=whole, running=running))
    except KeyboardInterrupt:
        return replace(study, partial=True)
    frequent = [oriented.lying[k] for k in short_trials.frequent_rows(candidate.weights)]
    wanted_orientation = oriented.lying[proposal.row]
    risks = hazards.risks(
        wanted_orientation, candidate.bowl, study.proof.queues, orientations=frequent, seed=request.seed
    )
    seldom = hazards.seldom_risks(candidate.trial, search.highest_shares(oriented), study.proof.queues)
    return replace(study, risks=(*risks, *seldom))


def prove_long(study: DesignStudy, said: SearchProgress) -> DesignStudy:
    """Return a design that holds with the queues of a long proof, where one is asked for.

    Parameters
    ----------
    study : DesignStudy
        That holds, with the row of parts that was fed into its queues.
    said : SearchProgress
        Whom it tells how far it is.

    Returns
    -------
    DesignStudy
        Its queues are those of the long proof: it may fall short by them. It is as it was where no long proof
        is asked for, and partial where the user stopped it.

    Raises
    ------
    FeederError
        If a process ends over a run.
    """
    request = study.request
    if request.proof is not ProofKind.LONG or study.proof.row is None:
        return study
    budget = TrialBudget([*study.attempts], request.budget, request.draws)
    run = said.watch(request.run, SearchStage.LONG_PROOF, budget)
    plan = long_proof.LongPlan.to_show(request.agreed_jams)
    try:
        fills = long_proof.follow_long(study.proof.row, plan, request.agreed_jams, run, said.tell)
    except KeyboardInterrupt:
        return replace(study, partial=True)
    return _with_queues(study, fills)


def _with_queues(study: DesignStudy, fills: tuple[FilledQueue, ...]) -> DesignStudy:
    return replace(study.proved_by(queues=fills), partial=any(queue.partial for queue in fills))


def _study_of(search: Search, candidate: Candidate, shares: Shares) -> DesignStudy:
    """The design before anything of it is proved."""
    bowl, oriented, weights = candidate.bowl, candidate.orientations, candidate.weights
    request, proposal, name = search.request, candidate.proposal, candidate.attempt.wanted
    own = candidate.attempt.aspect.casefold()
    wanted = " or ".join((name, *(aspect for aspect in request.up if aspect.casefold() != own)))
    gain = short_trials.gain(oriented, weights, candidate.trial.states)
    pitch = float((weights * oriented.lengths).sum()) + candidate.trial.spacing
    tooling = None
    if proposal.cuts:  # its chain as `feeder tooling` would have found it
        row, margin = proposal.row, proposals.MARGINS[-1]
        limits = DesignConstraints(up=request.up)
        task = static.design_task(
            oriented.lying, weights, row, margin, 1.0, proposal.before, constraints=limits
        )
        same = np.isin(oriented.leaves_as, proposal.states(oriented))
        static_design = static.propose(task, proposal.cuts, oriented.through < 0.5, same)
        tooling = ToolingStudy(
            search.part,
            bowl,
            shares.aspects,
            request.rule,
            margin,
            oriented.lying,
            weights,
            tuple(static_design if k == row else None for k in range(len(weights))),
            row,
            request.up,
            state=wanted,
            left_in_trial=candidate.trial.left,
        )
    return DesignStudy(
        part=search.part,
        request=request,
        bowl=bowl,
        wanted=wanted,
        wanted_aspect=candidate.attempt.aspect,
        turn=proposal.row,
        cuts=proposal.cuts,
        before=proposal.before,
        attempts=tuple(search.state.attempts),
        arrivals=search.aspect_shares,
        source=shares.aspects.source(request.rule),
        static_rate=calm_drive.speed(bowl) * gain / pitch,
        proof=Proof(slowed=calm_drive.velocity_kept(bowl)),
        trials=tuple(
            TrialRun(bowl, throw_number(bowl), oriented, weights, course)
            for course in candidate.trial.courses
        ),
        tooling=tooling,
    )


def merit(study: DesignStudy) -> tuple[bool, bool, float, float]:
    """Return a key by which the better one of two designs is greater: holds, then clean, then the most parts.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    (bool, bool, float [1], float [1/s])
    """
    return study.status in HELD, study.proof.jams == 0, study.proof.robust.share, study.proof.delivered[1]


def alternatives(
    studies: Sequence[DesignStudy],
    attempts: Sequence[Attempt],
    classes: Collection[int],
    chosen: DesignStudy | None = None,
) -> tuple[Alternative, ...]:
    """Return the best of each cost class, the cheapest class first.

    Parameters
    ----------
    studies : sequence of DesignStudy
        That were proved, as far as they were.
    attempts : sequence of Attempt
        Every short trial.
    classes : collection of int
        Cost classes of which chains were looked for.
    chosen : DesignStudy, optional
        The answer: it stands for its class, whatever another of that class brings.

    Returns
    -------
    tuple of Alternative
    """
    holds = any(study.status in HELD for study in studies)
    best_of: list[Alternative] = []
    for number in proposals.COST_CLASSES:
        own = [one for one in studies if one.bowl is not None and cost_class_of(one.devices) == number]
        tried = [attempt for attempt in attempts if attempt.cost_class == number]
        if own:
            study = next((one for one in own if one is chosen), None) or max(own, key=merit)
            purity, share = study.proof.purity[0], study.proof.efficiency
            counts = bool(study.proof.queues) and not study.partial  # what was stopped is no evidence
            sensors: list[Any] = [device for device in study.devices if device.action is Action.SENSE]
            words = tuple(f"{device.full_name}: {device.value_words}" for device in study.devices)
            best_of.append(
                Alternative(
                    cost_class=number,
                    status=study.status,
                    delivered=study.proof.delivered if counts else None,
                    purity=None if np.isnan(purity) or not counts else purity,
                    efficiency=None if np.isnan(share) or not counts else share,
                    chain=tuple(f"{device.kind}: {device.text}" for device in study.devices),
                    chain_words=words,
                    sees=tuple(device.sees for device in sensors),
                    reasons=study.shortfalls if study.status not in HELD else (),
                )
            )
        elif tried:
            best = max(tried, key=lambda one: (one.clean, one.efficiency, one.rate))
            faults = ", ".join(texts.fault_texts(best.faults, 2)) or "too slow in its short trial"
            why = (f"{best.wanted}: {faults}",)
            best_of.append(Alternative(number, Status.NONE, chain=best.chain, reasons=why))
        elif number in classes:
            why = ("no chain of this class tells what is wanted from the rest",)
            best_of.append(Alternative(number, Status.NONE, reasons=why))
        else:
            why = (
                "a cheaper one holds: --alternatives proves this class too" if holds else "it was stopped",
            )
            best_of.append(Alternative(number, Status.NOT_TRIED, reasons=why))
    return tuple(best_of)
