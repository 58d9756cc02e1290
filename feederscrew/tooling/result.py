"""What a design of tooling says, from the true verdicts of its cuts."""

from dataclasses import dataclass

import numpy as np

from feederscrew.tooling import apart
from feederscrew.tooling.chain import Cut

LEAST_SHARE = 5e-3  # [1] orientations that come less often need not be returned


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


def weights(every, shares):
    """Return how much it matters to return each orientation (M,): those that come often enough first."""
    stays = np.array([not one.falls_off for one in every])
    return np.where(stays, np.where(shares >= LEAST_SHARE, 1.0 + shares, 1e-3 * shares), 0.0)


def told(every, shares, wanted, cuts, returned, margin, same=None, allowed=0.0):
    """Return the record of a chain, its purity from the true verdicts of every cut.

    Parameters
    ----------
    every : sequence of Orientation
    shares : (M,) float [1]
    wanted : int
    cuts : sequence of Cut
    returned : (M,) bool
        Which are returned by the margin.
    margin : float [m]
    same : (M,) bool, optional
        Which leave like the wanted one, hanging; only itself without it.
    allowed : float [1]
        Share of others that may leave as well.

    Returns
    -------
    Design
    """
    same = np.arange(len(every)) == wanted if same is None else same
    names = [one.name for one in every]
    gone = np.array([any(name in cut.returns for cut in cuts) for name in names])
    gone |= np.array([one.falls_off for one in every])
    gone[wanted] = False
    total, leaving, good = shares.sum(), shares[~gone].sum(), shares[same & ~gone].sum()
    left = [k for k in np.flatnonzero(~returned & ~same) if shares[k] >= LEAST_SHARE]
    margins = [end for cut in cuts for end in (cut.margin_pass, cut.margin_reject) if np.isfinite(end)]
    return Design(
        wanted=wanted,
        isolated=not left or bool(shares[left].sum() <= allowed),
        cuts=cuts,
        margin=float(min(margins, default=np.nan)),
        efficiency=float(good / total) if total > 0.0 else 0.0,
        purity=float(good / leaving) if leaving > 0.0 else np.nan,
        left_over=tuple(names[k] for k in np.flatnonzero(~gone & ~same)),
        reasons=tuple(apart.reason(every[wanted], every[k], margin) for k in left),
    )


def without(every, shares, wanted, why):
    """Return the record of an orientation that nothing isolates, and why."""
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
