"""What would hold where a design does not: a lower rate, a larger bowl, another way up, another part."""

from collections.abc import Iterator

from feederscrew.designing.record import DRAWS_HELD, HOLDS, PURE, RATE_KEPT, DesignStudy
from feederscrew.designing.searching import Search

MINUTE = 60.0


def only_slow(study: DesignStudy) -> bool:
    """Return whether a design lacks nothing but parts per minute."""
    low, (purity, _) = study.delivered[1], study.purity
    sorts = study.robust.share >= DRAWS_HELD and purity >= PURE and not study.jams and not study.partial
    return sorts and 0.0 < low < RATE_KEPT * study.request.target


def only_lost(study: DesignStudy) -> bool:
    """Return whether draws have denied a design by what is wanted and gets stuck: a drive may be too slow."""
    return not study.partial and study.robust.share < DRAWS_HELD and " is lost (stopped" in study.robust.worst


def nearest(study: DesignStudy, search: Search) -> tuple[str, ...]:
    """Return the nearest that would hold, a sentence each.

    Parameters
    ----------
    study : DesignStudy
    search : loop.Search

    Returns
    -------
    tuple of str
        None of a design that holds.
    """
    return () if study.status == HOLDS else tuple(_sentences(study, search))


def _sentences(study: DesignStudy, search: Search) -> Iterator[str]:
    low, (purity, _) = study.delivered[1], study.purity
    if study.bowl is not None and low > 0.0 and purity >= PURE and not study.jams:
        yield f"{MINUTE * low / RATE_KEPT:.3g}/min would hold with this bowl"
    others = {one.attempt.wanted: one.attempt for one in search.passed}
    for name, attempt in others.items():
        if name != study.wanted:
            yield f"{name} got through its trial at {MINUTE * attempt.rate:.3g}/min"
    if study.bowl is None and search.attempts:
        best = max(search.attempts, key=lambda one: one.efficiency)
        yield f"nearest came {best.wanted}: {', '.join(best.faults[:2]) or 'too slow'}"
    elif study.bowl is None:
        yield "no chain isolates an orientation that was asked for: see feeder tooling"
