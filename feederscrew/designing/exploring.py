"""Short trials of chains: an orientation at its own drive, what the trial denies changed, and again."""

from dataclasses import replace

import numpy as np

from feederscrew.bowl.devices import check_written
from feederscrew.designing import calm_drive, proposals, trying
from feederscrew.designing.record import DEVICE, DRIVE, PART, Attempt
from feederscrew.designing.robust import denied, robust_run
from feederscrew.designing.searching import Candidate
from feederscrew.dropping.plate.drive import throw_number
from feederscrew.rates import arrivals, spacing
from feederscrew.rates.tipping import FLAT
from feederscrew.studies import solidbowl
from feederscrew.studies.rate import shares
from feederscrew.tooling.hanging import neck

EACH = 2  # parts of each orientation in a short trial
MENDED = 3  # times that one proposal is mended
LOST = 2  # trials of it in which nothing leaves as wanted, and it is given up
CALMER_TRIALS = 2  # calmer drives that one chain is tried at, where the drive loses what is wanted
LEAST_USE = 0.5  # of the best clean rate: an orientation that promises less is not tried
SHORT = 5  # short trials where no orientation comes often enough for the target at any calm drive
SCREENED = 6  # draws before a clean chain is proved
ROLLS = 0.3  # of the parts that lie on a round side: then the bank is steep
SLOWER = 1.2  # a chain that gains so many times what was taken for it is proposed again, at its own drive


def candidates(search):
    """Try proposals, and yield each Candidate that is clean and brings the target, within the budget.

    Parameters
    ----------
    search : Search
        Its ``passed`` and ``failed`` are filled.
    """
    for bank in _banks(search, _aspects(search)):
        made = calm_drive.section(
            search.part,
            _aspects(search),
            search.plain,
            search.given,
            diameter=search.request.diameter,
            bank=bank,
            drive=search.request.drive,
        )
        start = replace(calm_drive.driven(made, 0.0), devices=search.plain.devices)
        if search.known is None:
            search.known = arriving(search, start)
        ways, weights = offered(search, start)
        yield from _searched(search, made, ways, weights)


def _searched(search, made, ways, weights):
    """Candidates on one track: no device at all, then each kind of chain for each orientation."""
    alone = proposals.bare(ways, weights, search.request, search.plain.devices)
    if alone is not None:
        yield from _tried_out(search, made, alone, weights)
    seen = {one.chain for one in search.attempts[: search.first]}
    rows = proposals.promising(ways, weights, search.request)[: proposals.ROWS]
    if not any(_promise(search, made, ways, weights, row) >= search.request.target for row in rows):
        search.most = search.first + SHORT
    for how in proposals.HOWS:
        for row in rows:
            if search.spent:
                return
            if _promise(search, made, ways, weights, row, how[2]) < _least(search):
                continue
            avoided = None
            while avoided != search.avoided.get(row, ()) and not search.spent:
                avoided = search.avoided.get(row, ())
                proposal = _proposed(search, made, ways, weights, row, _without(how, avoided))
                if proposal is not None and proposal.chain not in seen:
                    seen.add(proposal.chain)
                    yield from _tried_out(search, made, proposal, weights)


def _without(how, kinds):
    """The same way of proposing, without kinds of devices at which the wanted orientation was lost."""
    margin, left_out, outcome = how
    return margin, (*left_out, *kinds), outcome


def _least(search):
    """Parts [1/s] that an orientation has to promise, if it is to be tried beside what is clean already."""
    best, target = search.best_rate, search.request.target
    return target if 0.0 < best < target else LEAST_USE * best


def _promise(search, made, ways, weights, row, outcome="any"):
    """Parts [1/s] that an orientation brings at the fastest drive, were all others returned."""
    if "lying" not in (outcome, search.request.outcome) and neck(ways.lying[row]) is not None:
        return np.inf  # what hangs comes from several headings
    pitch = trying.GAP * float((weights * ways.lengths).sum())
    fastest = calm_drive.speed(calm_drive.driven(made, np.inf, hops=True))
    return _share(search, ways, weights, row) * fastest / pitch


def _share(search, ways, weights, row):
    """Share [1] in which an orientation comes, with those that count as it."""
    return float(weights[[row, *proposals.alike(ways.lying, row, search.request.up)]].sum())


def _proposed(search, made, ways, weights, row, how):
    """A chain for one orientation at the drive that its share asks for; None where there is none."""
    gain = _share(search, ways, weights, row)
    found = _at(search, made, ways, weights, row, how, gain)
    more = 0.0 if found is None else _gain(search, made, found, weights)
    if more > SLOWER * gain:
        return _at(search, made, ways, weights, row, how, more) or found
    return found


def _at(search, made, ways, weights, row, how, gain):
    """The chain for a drive that a share [1] asks for."""
    bowl = calm_drive.driven(made, asked(search, ways, weights, gain), hops=proposals.meets_nothing(how))
    bowl = replace(bowl, devices=search.plain.devices)
    return proposals.proposed(search.part, bowl, search.known.aspects, row, ways, search.request, how)


def _gain(search, made, proposal, weights):
    """Share of the parts that leaves as wanted, as the static rule says [1]."""
    bowl = replace(made.bowl, devices=proposal.devices)
    ways = proposals.known_through(search.part, search.known.aspects, bowl)
    return trying.gain(ways, weights, proposal.states(ways))


def asked(search, ways, weights, gain, apart=0.0):
    """Return the velocity [m/s] that brings the target, with a reserve, at a share that leaves as wanted.

    Parts come in a row, ``apart`` [m] farther than they do by themselves where devices need that.
    """
    pitch = trying.GAP * float((weights * ways.lengths).sum()) + apart
    return search.reserve * search.request.target * pitch / max(gain, 1e-3)


def _banks(search, aspects):
    """Banks of the track that are tried, in turn: steeper first where the part rolls."""
    if "track.bank" in search.given:
        return (search.plain.track.bank,)
    chances = np.nan_to_num(aspects.chances[search.request.rule])
    rolling = float(chances[[kind != FLAT for kind in aspects.kinds]].sum())
    return calm_drive.STEEP_BANKS if rolling > ROLLS * chances.sum() else calm_drive.BANKS


def _aspects(search):
    if search.known is not None:
        return search.known.aspects
    from feederscrew.studies.aspects import answered

    return answered(search.part)


def arriving(search, bowl):
    """Return what lies at the entry of the track of a bowl, a Shares."""
    bare = replace(bowl, devices=())
    return shares(search.part, bare, rule=search.request.rule, jobs=search.request.jobs)


def at_its_drive(search, candidate):
    """Return a Candidate with what arrives on the floor of its own bowl, and those Shares.

    The search itself takes them from one drive; what the user says of them is kept.
    """
    if search.shares_given:
        return search.known, candidate
    known, bowl = arriving(search, candidate.bowl), candidate.bowl
    ways = arrivals.oriented(proposals.known_through(search.part, known.aspects, bowl), known.measured)
    if [one.name for one in ways.lying] != [one.name for one in candidate.ways.lying]:
        return search.known, candidate  # the same orientations, or its rows are others
    weights = np.nan_to_num(ways.rules[search.request.rule])
    return known, replace(candidate, ways=ways, weights=weights / weights.sum())


def offered(search, bowl):
    """Return what comes along a track, Orientations, and in which shares (M,) [1]."""
    ways = proposals.known_through(search.part, search.known.aspects, bowl)
    ways = arrivals.oriented(ways, search.known.measured)
    weights = np.nan_to_num(ways.rules[search.request.rule])
    total = weights.sum()
    return ways, weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))


def _tried_out(search, made, proposal, weights):
    """Try a proposal and what mends it; the Candidate where one is clean and fast enough."""
    lost = 0
    for _ in range(MENDED + 1):
        candidate = _screened(search, attempted(search, made, proposal, weights))
        calmed = _calmed(search, made, candidate, weights)
        if calmed.attempt.clean:
            search.passed.append(calmed)
        if calmed.attempt.clean and calmed.attempt.rate >= search.request.target:
            yield calmed
            return
        if candidate.attempt.clean:
            return
        search.failed.append(candidate)
        if not candidate.attempt.efficiency > 0.0 and not candidate.proposal.hangs:
            lost += 1
        if lost == LOST:
            break
        changed = proposals.better(proposal, candidate.tried, candidate.ways.lying, candidate.drawn)
        if changed is None or search.spent:
            break
        proposal = changed
    search.avoid(proposal, candidate.tried)


def _calmed(search, made, candidate, weights):
    """The candidate at a calmer drive that is clean, where the one it had turns or loses what is wanted."""
    first = candidate
    for _ in range(CALMER_TRIALS):
        if candidate.attempt.clean or search.spent or not _moved_out(candidate):
            break
        other = calmer(search, made, candidate, weights)
        if other is None:
            break
        search.most += 1  # no other chain is left out for it
        candidate = _screened(search, other)
    return candidate if candidate.attempt.clean else first


def _moved_out(candidate):
    """Whether the drive loses what is wanted: in a trial on the track, or in draws by turning it."""
    drawn = candidate.drawn
    return bool(trying.lost_by_motion(candidate.tried)) or (
        drawn is not None and "is lost (" in drawn.worst and "on the track" in drawn.worst
    )


def calmer(search, made, candidate, weights):
    """Return a Candidate: the same chain tried at a calmer drive; None where there is none.

    Parameters
    ----------
    search : Search
    made : PlainBowl
        The bowl without devices.
    candidate : Candidate
        At the drive that turned or lost what is wanted.
    weights : (M,) float [1]
    """
    bowl = calm_drive.calmer(made, candidate.bowl)
    if bowl is None:
        return None
    step = f"calmer drive, {2e3 * bowl.drive.amplitude:.3g} mm peak to peak"
    return attempted(search, made, replace(candidate.proposal, step=step), weights, bowl)


def _screened(search, candidate):
    """A clean candidate after some draws of part, friction, drive and cuts; denied where one fails."""
    if not candidate.attempt.clean or candidate.attempt.rate < search.request.target:
        return candidate
    request = search.request
    drawn = robust_run(
        search.part, candidate.bowl, candidate.ways, candidate.weights, candidate.proposal.rows,
        draws=min(SCREENED, request.draws), tolerance=request.tolerance, run=request.run,
        any_heading=candidate.proposal.any_heading,
    )  # fmt: skip
    if drawn.partial:
        raise KeyboardInterrupt
    if drawn.held == drawn.draws:
        return candidate
    attempt = replace(candidate.attempt, faults=(f"in draws {drawn.worst}",))
    search.attempts[-1] = attempt
    return replace(candidate, attempt=attempt, drawn=drawn)


def attempted(search, made, proposal, weights, driven=None):
    """Return a Candidate: one short trial at the drive that the target asks for, or at that of a bowl.

    Parameters
    ----------
    search : Search
    made : PlainBowl
    proposal : Proposal
    weights : (M,) float [1]
    driven : Bowl, optional
        Whose drive is taken.
    """
    part = search.part
    check_written(proposal.devices, "design.yaml")
    made = _drawable(search, made, proposal)
    bowl = replace(made.bowl, devices=proposal.devices)
    ways = proposals.known_through(part, search.known.aspects, bowl)
    gain = trying.gain(ways, weights, proposal.states(ways))
    own = _at_velocity(search, made, proposal, ways, weights, gain) if driven is None else driven
    bowl = replace(own, track=made.bowl.track, devices=proposal.devices)
    ways = arrivals.oriented(proposals.known_through(part, search.known.aspects, bowl), search.known.measured)
    name = ways.lying[proposal.row].name
    search.begin_trial(f"{name}, {proposal.step}")
    tried = _short(search, bowl, ways, weights, proposal)
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
        cause=_cause(tried, proposal),
        peak_to_peak=2.0 * bowl.drive.amplitude,
        throw_number=float(throw_number(bowl)),
    )
    search.attempts.append(attempt)
    search.end_trial()
    return Candidate(proposal, bowl, ways, weights, tried, attempt)


def _drawable(search, made, proposal):
    """The bowl, its track as steep as a spacing section that leads down needs it: else it has no solid."""
    if "track.climb" in search.given or not any(one.leans for one in proposal.devices):
        return made
    bowl = replace(made.bowl, devices=proposal.devices)
    ways = proposals.known_through(search.part, search.known.aspects, bowl)
    track = replace(bowl.track, climb=solidbowl.drawable_climb(bowl, search.part, ways))
    return replace(made, bowl=replace(made.bowl, track=track))


def _cause(tried, proposal):
    """Which of CAUSES a trial shows: what loses the wanted orientation first, then what lets others leave."""
    if not list(denied(tried)):
        return ""
    right = set(trying.wanted_rows(tried.known, tried.states))
    if trying.lost_by_motion(tried) or not tried.velocity > 0.0:
        return DRIVE
    lost = any(k in right and tried.right[n] < tried.parts[n] for n, k in enumerate(tried.rows))
    return DEVICE if lost or proposal.devices else PART


def _at_velocity(search, made, proposal, ways, weights, gain):
    """The bowl at the drive that brings the target, with the gaps that its devices need at that drive."""
    apart = 0.0
    for _ in range(2):
        velocity = max(asked(search, ways, weights, gain, apart), search.least)
        bowl = calm_drive.driven(made, velocity, hops=proposal.may_hop)
        apart = spacing.needed(proposal.devices, ways.lying, bowl)
        if not apart > 0.0:
            break
    return bowl


def _short(search, bowl, ways, weights, proposal):
    """The short trial: what is wanted first; where none of it leaves, the others are not tried."""
    request, rows = search.request, trying.often(weights, (proposal.row,))
    own = {"run": request.run}
    own |= {"aspects": search.known.aspects, "any_heading": proposal.any_heading}
    right = set(trying.wanted_rows(ways, proposal.states(ways)))
    first = [k for k in rows if k in right] or [proposal.row]
    tried = trying.single(search.part, bowl, ways, weights, proposal.rows, rows=first, each=EACH, **own)
    others = [k for k in rows if k not in first]
    if not tried.efficiency > 0.0 or not others:
        return tried
    each = EACH if len(others) <= trying.FEW else 1
    return tried.joined(
        trying.single(search.part, bowl, ways, weights, proposal.rows, rows=others, each=each, **own)
    )
