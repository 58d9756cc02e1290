"""Which devices let one orientation leave and return all the others."""

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.tooling import chain, cutting, rails
from feederscrew.tooling.result import LEAST_SHARE, told, weights, without

MARGIN = 2.5e-4  # [m] to either side
MOST_HOLES = 3  # cut-outs in one chain


def design(every, shares, wanted, *, margin=MARGIN, search=None, holes=True, purity=1.0):
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
    purity : float [1]
        Of what leaves, that is enough; the chain is not made longer for more.

    Returns
    -------
    Design
    """
    search = search or cutting.Search()
    found = _plain(every, shares, wanted, margin, search, holes, purity)
    hung = rails.design(every, shares, wanted, margin)
    if hung is None or (hung.isolated, hung.efficiency) <= (found.isolated, found.efficiency):
        return found
    return hung


def _plain(every, shares, wanted, margin, search, holes, purity):
    """The chain of devices that return the others and leave the wanted one lying."""
    if every[wanted].falls_off or not every[wanted].margin > 0.0:
        return without(every, shares, wanted, "falls off the bare track")
    weight, stays = weights(every, shares), np.array([not one.falls_off for one in every])
    weight[wanted] = 0.0
    found = chain.candidates(every, wanted, margin)
    allowed = shares[wanted] * (1.0 / purity - 1.0)
    counted = np.where(weight > 0.0, shares, 0.0) if purity < 1.0 else weight
    devices = chain.fewest(found, counted, margin, allowed)
    must = chain.shared_out(found, devices, margin)
    cuts = chain.placed(every, wanted, devices, must)
    returned = np.any([~stays, *must], axis=0)
    if holes:
        cuts, returned = _with_holes(every, shares, wanted, cuts, returned, margin, search, allowed)
    return told(every, shares, wanted, cuts, returned, margin, allowed=allowed)


def _with_holes(every, shares, wanted, cuts, returned, margin, search, allowed):
    """Add cut-outs for those that are left, as long as one returns any."""
    returned = returned.copy()
    for _ in range(MOST_HOLES):
        left = [k for k in np.flatnonzero(~returned) if k != wanted and shares[k] >= LEAST_SHARE]
        if shares[left].sum() <= allowed:
            break
        made = cutting.cut_out(every, wanted, left, margin, search) if left else None
        if made is None:
            break
        cuts, returned[made[1]] = (*cuts, made[0]), True
    return cuts, returned


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
