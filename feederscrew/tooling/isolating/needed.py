"""A chain without the devices that change none of its numbers."""

import numpy as np

from feederscrew.tooling.isolating.chain import margin_at
from feederscrew.tooling.isolating.proposal import told

SAME = 1e-4  # [1] shares that differ by less are printed alike


def told_needed(given, cuts, returned, same=None, late=False):
    """Return the record of a chain as ``told`` does, without the devices that change nothing of it.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    given : DesignTask
    cuts : sequence of Cut
    returned : (M,) bool
        Which are returned by the margin: by the track and the devices of the bowl too.
    same : (M,) bool, optional
        Which leave like the wanted one, hanging.
    late : bool

    Returns
    -------
    Design
        Of as many of the cuts as it takes to keep what is isolated, efficiency and purity.

    Notes
    -----
    The last ones are left out first: what drops parts stands before what has to clear itself or to see. Rails
    are what parts leave in, and stay.
    """
    cuts, found = list(cuts), told(given, cuts, returned, same, late)
    gone = returned & ~np.any([_returns(given, cut) for cut in cuts], axis=0) if cuts else returned
    for cut in [cut for cut in reversed(cuts) if not cut.device.hangs]:
        rest = [other for other in cuts if other is not cut]
        by_rest = np.any([gone, *(_returns(given, other) for other in rest)], axis=0)
        other = told(given, rest, by_rest, same, late)
        if _alike(other, found):
            cuts, found = rest, other
    return found


def _returns(given, cut):
    """(M,) bool, which orientations a cut returns by the margin that is asked for."""
    margins = [margin_at(cut.device, one, given.every) for one in given.every]
    return np.array([margin <= -given.margin for margin in margins], dtype=bool)


def _alike(one, other):
    """Whether a design says the same of what leaves as another, and no more stands in it."""
    first, second = (
        np.nan_to_num([k.efficiency, k.purity, -1.0 if k.hopeful is None else k.hopeful], nan=-1.0)
        for k in (one, other)
    )
    stands = [{name for cut in design.cuts for name in cut.stops} for design in (one, other)]
    return (
        one.isolated >= other.isolated
        and bool((np.abs(first - second) < SAME).all())
        and stands[0] <= stands[1]
    )
