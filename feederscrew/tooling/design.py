"""Which devices let one orientation leave and return all the others."""

from dataclasses import dataclass

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.tooling import apart, chain, cutting
from feederscrew.tooling.chain import Cut

LEAST_SHARE = 5e-3  # [1] orientations that come less often need not be returned
MARGIN = 2.5e-4  # [m] to either side
MOST_HOLES = 3  # cut-outs in one chain


@dataclass(frozen=True, eq=False)
class Design:
    """What isolates one orientation, and what it does not."""

    wanted: int  # its place among the orientations
    isolated: bool  # all others that come often enough are returned, to either side by the margin
    cuts: tuple[Cut, ...]  # in the order parts meet them
    margin: float  # [m] the least, of passing and of returning; NaN without any device
    efficiency: float  # [1] share of the parts offered that leave in this orientation
    purity: float  # [1] share of what leaves that is in this orientation
    left_over: tuple[str, ...]  # orientations that leave as well
    reasons: tuple[str, ...]  # why, a sentence each


def design(every, shares, wanted, *, margin=MARGIN, search=None, holes=True):
    """Return the chain of fewest devices that isolates an orientation.

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
    search : cutting.Search, optional
        Seed and time limit of the search for holes.
    holes : bool
        Whether holes of several corners may be cut.

    Returns
    -------
    Design
    """
    search = search or cutting.Search()
    if every[wanted].falls_off or not every[wanted].margin > 0.0:
        return _without(every, shares, wanted, "falls off the bare track")
    stays = np.array([not one.falls_off for one in every])
    weight = np.where(stays, np.where(shares >= LEAST_SHARE, 1.0 + shares, 1e-3 * shares), 0.0)
    weight[wanted] = 0.0
    found = chain.candidates(every, wanted, margin)
    devices = chain.fewest(found, weight, margin)
    must = chain.shared_out(found, devices, margin)
    cuts = chain.placed(every, wanted, devices, must)
    returned = np.any([~stays, *must], axis=0)
    if holes:
        cuts, returned = _with_holes(every, shares, wanted, cuts, returned, margin, search)
    return _told(every, shares, wanted, cuts, returned, margin)


def _with_holes(every, shares, wanted, cuts, returned, margin, search):
    """Add cut-outs for those that are left, as long as one returns any."""
    returned = returned.copy()
    for _ in range(MOST_HOLES):
        left = [k for k in np.flatnonzero(~returned) if k != wanted and shares[k] >= LEAST_SHARE]
        made = cutting.cut_out(every, wanted, left, margin, search) if left else None
        if made is None:
            break
        cuts, returned[made[1]] = (*cuts, made[0]), True
    return cuts, returned


def _told(every, shares, wanted, cuts, returned, margin):
    """The record, its purity from the true verdicts of every cut."""
    names = [one.name for one in every]
    gone = np.array([any(name in cut.returns for cut in cuts) for name in names])
    gone |= np.array([one.falls_off for one in every])
    gone[wanted] = False
    total, leaving = shares.sum(), shares[~gone].sum()
    left = [k for k in np.flatnonzero(~returned) if k != wanted and shares[k] >= LEAST_SHARE]
    margins = [end for cut in cuts for end in (cut.margin_pass, cut.margin_reject) if np.isfinite(end)]
    return Design(
        wanted=wanted,
        isolated=not left,
        cuts=cuts,
        margin=float(min(margins, default=np.nan)),
        efficiency=float(shares[wanted] / total) if total > 0.0 else 0.0,
        purity=float(shares[wanted] / leaving) if leaving > 0.0 else np.nan,
        left_over=tuple(names[k] for k in np.flatnonzero(~gone) if k != wanted),
        reasons=tuple(apart.reason(every[wanted], every[k], margin) for k in left),
    )


def _without(every, shares, wanted, why):
    return Design(
        wanted=wanted,
        isolated=False,
        cuts=(),
        margin=np.nan,
        efficiency=0.0,
        purity=np.nan,
        left_over=(),
        reasons=(f"{every[wanted].name} {why}",),
    )


def place(every, aspect, heading, where):
    """Return the place of an orientation by its aspect and, where given, its heading [rad].

    Raises
    ------
    FeederError
        If the part has no such orientation.
    """
    known = [k for k, one in enumerate(every) if one.aspect.casefold() == aspect.strip().casefold()]
    if not known:
        names = ", ".join(dict.fromkeys(one.aspect for one in every))
        raise FeederError(where, f"there is no aspect {aspect[:20]!r}", f"choose one of {names}")
    if heading is None:
        return max(known, key=lambda k: (not every[k].falls_off, every[k].heading_share, -k))
    away = [abs(np.remainder(every[k].heading - heading + np.pi, 2.0 * np.pi) - np.pi) for k in known]
    if min(away) > np.radians(1.0):
        names = ", ".join(f"{np.degrees(every[k].heading):.4g}" for k in known)
        what = f"aspect {every[known[0]].aspect} has no stable heading {np.degrees(heading):.4g} deg"
        raise FeederError(where, what, f"choose one of {names} deg")
    return known[int(np.argmin(away))]
