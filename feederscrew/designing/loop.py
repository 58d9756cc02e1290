"""The loop: an orientation and its chain, a short trial, what the trial denies changed, and the proof."""

from dataclasses import replace

import numpy as np

from feederscrew.designing import beside, calm_drive, nearest, proposals, queues, risks, trying
from feederscrew.designing.record import RATE_KEPT, Attempt, DesignStudy
from feederscrew.designing.robust import denied, robust_run
from feederscrew.designing.searching import Candidate, Search
from feederscrew.rates import arrivals
from feederscrew.studies.rate import shares

EACH = 3  # parts of each orientation in a short trial
MENDED = 2  # times that one proposal is mended
PROVED = 2  # designs that go through draws and queue
LEAST_USE = 0.25  # of the best static rate: an orientation that promises less is not tried


def design(part, plain, given, request, *, known=None, told=None, before=None):
    """Design a bowl that brings a part at a rate, and try it.

    Parameters
    ----------
    part : Part
        From a mesh.
    plain : Bowl
        What the user gave, completed by the defaults; its devices are kept.
    given : collection of str
        Names of the keys the user gave.
    request : DesignRequest
    known : Shares, optional
        What arrives, where the user says so; else what lies on the moving floor of the designed bowl.
    told : callable, optional
        Called with what is being tried, a sentence.
    before : callable, optional
        Called before anything is compiled.

    Returns
    -------
    DesignStudy

    Raises
    ------
    FeederError
        If the part has no surface, fits no bowl, or has no such aspect.
    """
    search = Search(part, request, plain, frozenset(given), told or (lambda text: None), known, before=before)
    best, proofs = None, []
    try:
        _explore(search)
        for candidate in _ranked(search)[:PROVED]:
            study = _proved(search, candidate)
            proofs.append(study)
            best = max(proofs, key=_merit)
            if study.status == "holds" or study.partial:
                break
            if nearest.only_slow(study) and len(proofs) < PROVED:
                proofs += _faster(search, candidate, study)
                best = max(proofs, key=_merit)
                break
    except KeyboardInterrupt:
        return replace(best or _without(search), partial=True)
    best = best or _without(search)
    return replace(best, attempts=tuple(search.attempts), nearest=nearest.nearest(best, search))


def _faster(search, candidate, study):
    """The same design proved at a faster drive, where that is calm; none where it is not to be had."""
    short = RATE_KEPT * search.request.target / study.delivered[1]
    search.reserve *= 1.1 * short
    made = calm_drive.PlainBowl(replace(candidate.bowl, devices=()), search.given, None)
    other = _attempt(search, made, candidate.proposal, candidate.weights)
    faster = other.bowl.drive != candidate.bowl.drive and other.attempt.clean
    return [_proved(search, other)] if faster else []


def _merit(study):
    """What is better: holds, then clean, then the most parts."""
    return study.status == "holds", study.jams == 0, study.robust.share, study.delivered[1]


def _ranked(search):
    """Candidates to be proved: clean ones first, the one that delivers most first."""
    order = [sorted(some, key=lambda one: -one.attempt.rate) for some in (search.passed, search.failed)]
    return [*order[0], *order[1][:1]]


def _explore(search):
    """Try proposals until one is clean and brings the target, or the budget is used up."""
    for bank in _banks(search):
        own = {"diameter": search.request.diameter, "bank": bank}
        made = calm_drive.section(search.part, _aspects(search), search.plain, search.given, **own)
        start = calm_drive.driven(made, 0.0 if made.given & {"drive.amplitude"} else np.inf)
        start = replace(start, devices=search.plain.devices)
        if search.known is None:
            search.known = shares(search.part, start, rule=search.request.rule, jobs=search.request.jobs)
        ways, weights = _offered(search, start)
        for proposal in _proposals(search, start, ways, weights):
            if search.spent:
                return
            if _tried_out(search, made, start, proposal, ways, weights):
                return


def _banks(search):
    """Banks of the track that are tried, in turn."""
    given = search.plain.track.bank
    return (given,) if "track.bank" in search.given else (calm_drive.BANK, 0.0)


def _aspects(search):
    if search.known is not None:
        return search.known.aspects
    from feederscrew.studies.aspects import answered

    return answered(search.part)


def _offered(search, bowl):
    """What comes along a track, and in which shares."""
    ways = proposals.known_through(search.part, search.known.aspects, bowl)
    ways = arrivals.oriented(ways, search.known.measured)
    weights = np.nan_to_num(ways.rules[search.request.rule])
    total = weights.sum()
    return ways, weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))


def _proposals(search, bowl, ways, weights):
    """Chains, the most promising first: no device at all, then by the share in which an orientation comes."""
    alone = proposals.bare(ways, weights, search.request, search.plain.devices)
    if alone is not None:
        yield alone
    promise, best = [], 0.0
    for row in proposals.promising(ways, weights, search.request):
        for margin in proposals.MARGINS:
            found = proposals.proposed(
                search.part, bowl, search.known.aspects, row, ways, search.request, margin
            )
            if found is None:
                continue
            through = proposals.known_through(
                search.part, search.known.aspects, replace(bowl, devices=found.devices)
            )
            gain = float((weights * through.leaving[:, through.leaves_as[row]]).sum())
            best = max(best, gain)
            promise.append((gain, -len(found.cuts), -len(promise), found))
            break
        if len(promise) >= 6 or weights[row] < LEAST_USE * best / 2.0:
            break
    seen = set()
    for gain, _, _, found in sorted(promise, key=lambda one: one[:3], reverse=True):
        if gain >= LEAST_USE * best and found.chain not in seen:
            seen.add(found.chain)
            yield found


def _tried_out(search, made, start, proposal, ways, weights):
    """Try a proposal and what mends it; whether one is clean and fast enough."""
    for _ in range(MENDED + 1):
        candidate = _attempt(search, made, proposal, weights)
        clean = candidate.attempt.clean
        (search.passed if clean else search.failed).append(candidate)
        if clean:
            return _fast_enough(search, made, candidate)
        seen = candidate.tried, candidate.ways.lying
        proposal = proposals.mended(proposal, *seen) or proposals.guarded(proposal, *seen)
        if proposal is None or search.spent:
            return False
    return False


def _fast_enough(search, made, candidate):
    """Whether a clean candidate brings the target, calmly or, where its trial stays clean, hopping."""
    if candidate.attempt.rate >= search.request.target or search.spent or not candidate.proposal.devices:
        return candidate.attempt.rate >= search.request.target
    step = f"{candidate.proposal.step}, faster: parts hop"
    other = _attempt(search, made, replace(candidate.proposal, step=step), candidate.weights, hops=True)
    if other.attempt.clean:
        search.passed.append(other)
    return other.attempt.clean and other.attempt.rate >= search.request.target


def _attempt(search, made, proposal, weights, hops=False):
    """One short trial at the drive that the target asks for."""
    request, part = search.request, search.part
    ways = proposals.known_through(part, search.known.aspects, replace(made.bowl, devices=proposal.devices))
    gain = float((weights * ways.leaving[:, ways.leaves_as[proposal.row]]).sum())
    pitch = trying.GAP * float((weights * ways.lengths).sum())
    asked = search.reserve * request.target * pitch / max(gain, 1e-3)
    bowl = replace(
        calm_drive.driven(made, asked, hops=hops or not proposal.devices), devices=proposal.devices
    )
    ways = arrivals.oriented(proposals.known_through(part, search.known.aspects, bowl), search.known.measured)
    name = ways.lying[proposal.row].name
    search.told(f"trial {len(search.attempts) + 1}: {name}, {proposal.step}")
    rows = trying.often(weights, (proposal.row,))
    tried = trying.single(
        part, bowl, ways, weights, proposal.row, rows=rows, each=EACH, seed=request.seed, jobs=request.jobs,
        before=search.before,
    )  # fmt: skip
    attempt = Attempt(
        wanted=ways.states[tried.state].name,
        chain=proposal.chain,
        step=proposal.step,
        bank=bowl.track.bank,
        velocity=tried.velocity,
        parts=int(tried.parts.sum()),
        efficiency=tried.efficiency,
        purity=tried.purity,
        stopped=tried.stopped,
        rate=tried.rate,
        faults=tuple(denied(tried)),
    )
    search.attempts.append(attempt)
    return Candidate(proposal, bowl, ways, weights, tried, attempt)


def _proved(search, candidate):
    """The design with its draws and its queue."""
    request, part = search.request, search.part
    bowl, ways, weights, row = candidate.bowl, candidate.ways, candidate.weights, candidate.proposal.row
    search.told(f"queue: {candidate.attempt.wanted}, {', '.join(candidate.proposal.chain) or 'no device'}")
    study = DesignStudy(
        part=part,
        request=request,
        bowl=bowl,
        wanted=candidate.attempt.wanted,
        turn=row,
        cuts=candidate.proposal.cuts,
        before=candidate.proposal.before,
        attempts=tuple(search.attempts),
        source=search.known.aspects.source(request.rule),
        static_rate=_static(search, candidate),
        tooling=beside.tooled(
            part,
            bowl,
            search.known.aspects,
            ways,
            weights,
            candidate.proposal,
            request.rule,
            proposals.MARGINS[-1],
        ),
    )
    found = queues.filled(
        part, bowl, search.known.aspects, ways, weights, candidate.tried.state, seed=request.seed
    )
    said = risks.risks(ways.lying[row], bowl.friction.kinetic, found)
    study = replace(study, queues=found, risks=said, partial=len(found) < len(queues.FILLS))
    if study.partial:
        return study
    search.told(f"draws: {candidate.attempt.wanted}, {request.draws} of part, friction, drive and cuts")
    tested = robust_run(
        part, bowl, ways, weights, row, draws=request.draws, tolerance=request.tolerance, seed=request.seed,
        jobs=request.jobs,
    )  # fmt: skip
    return replace(study, robust=tested, partial=tested.partial)


def _static(search, candidate):
    """Wanted parts [1/s] that the static rule promises."""
    ways, weights = candidate.ways, candidate.weights
    gain = float((weights * ways.leaving[:, candidate.tried.state]).sum())
    return calm_drive.speed(candidate.bowl) * gain / float((weights * ways.lengths).sum())


def _without(search):
    """What is said where nothing was proved."""
    source = "" if search.known is None else search.known.aspects.source(search.request.rule)
    return DesignStudy(
        search.part, search.request, None, None, None, attempts=tuple(search.attempts), source=source
    )
