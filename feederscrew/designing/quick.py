"""A design for a quotation: a bound on the rate and a first chain after a few short trials, not proved."""

from dataclasses import replace

from feederscrew.designing import exploring, proposals
from feederscrew.designing.record import DesignStudy, QuickAnswer
from feederscrew.designing.search import Candidate, Search

QUICK_TRIALS = 8  # short trials at most, each of about a second
# of them so many of the rails of one head on one track, and none at livelier drives: a bushing took all eight
# trials for rails, of 60 parts each, and nothing else was tried
QUICK_RAILS = 2
QUICK_PROPOSALS = 24  # chains that are looked for by the static rule at most, of each cost class


def first_chain(search: Search) -> Candidate | None:
    """Return the first chain that is clean and fast enough in its short trial, or the best of the few tried.

    The cheapest cost class comes first, as in any design. No draw and no queue is run.

    Parameters
    ----------
    search : Search
        Of a request that is ``quick``.

    Returns
    -------
    Candidate or None
        None where no chain got anything through its short trial.
    """
    state = search.state
    # few trials: each side has one first
    policy = replace(search.policy, tries_before_others=1, livelier_trials=0)
    policy = replace(policy, rails_trials=QUICK_RAILS, rails_given_up=QUICK_RAILS)
    limited = replace(search, request=replace(search.request, budget=QUICK_TRIALS), policy=policy)
    for cost_class in proposals.COST_CLASSES:
        state.proposals_left = QUICK_PROPOSALS
        for candidate in exploring.candidates(limited, cost_class):
            return candidate
    tried = [candidate for candidate in (*state.clean, *state.failures) if candidate.attempt.rate > 0.0]
    return max(tried, key=lambda one: (one.attempt.clean, one.attempt.rate), default=None)


def answer(search: Search, candidate: Candidate | None) -> QuickAnswer:
    """Return the bound on the rate, with what a short trial showed.

    No chain that returns the rest delivers more of an orientation than comes of it when parts touch, at the
    fastest drive: ``exploring.rate_at_most``.

    Parameters
    ----------
    search : Search
        Whose tracks are known.
    candidate : Candidate or None
        Of ``first_chain``.

    Returns
    -------
    QuickAnswer
        Of the orientation of the chain; without one, of that which may bring most.

    Raises
    ------
    ValueError
        If no orientation is worth a try.
    """
    rows = [(track, row) for track in search.state.tracks for row in track.rows]
    if not rows:
        raise ValueError("no orientation is worth a try")
    attempt = None if candidate is None else candidate.attempt
    if candidate is not None:
        name = candidate.orientations.lying[candidate.proposal.row].name
        rows = [(track, row) for track, row in rows if track.orientations.lying[row].name == name] or rows
    shares = [exploring.share_of(search, track, row) for track, row in rows]
    if candidate is not None and (candidate.proposal.hangs or candidate.attempt.efficiency > max(shares)):
        shares = [1.0] * len(rows)  # others hang, or are turned into it
    bounds = [exploring.rate_at_most(track, share) for (track, _), share in zip(rows, shares, strict=True)]
    best = bounds.index(max(bounds))
    track, row = rows[best]
    return QuickAnswer(
        wanted=track.orientations.lying[row].name if attempt is None else attempt.wanted,
        share=shares[best],
        fastest=track.fastest,
        rate_at_most=bounds[best],
        short_trial=None if attempt is None else attempt.rate,
        clean=attempt is not None and attempt.clean,
    )


def completed(study: DesignStudy, search: Search, candidate: Candidate | None) -> DesignStudy:
    """Return a design that is not proved with its bound on the rate.

    Parameters
    ----------
    study : DesignStudy
    search : Search
    candidate : Candidate or None
        Its chain.

    Returns
    -------
    DesignStudy
    """
    has_rows = any(track.rows for track in search.state.tracks)
    return replace(study, quick=answer(search, candidate) if has_rows else None)
