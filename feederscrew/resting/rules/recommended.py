"""The one answer we stand for, with an interval that says how far it may be off."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check

MODEL = 0.06  # [1]
"""What any of our methods may be off beside launch and sampling: twice 0.03, the root-mean-square error
left on measured cuboids by the best of them (``benchmarks/accuracy.py``)."""
LAUNCH = "feed"  # preset of the drop test that is recommended over every closed form


@dataclass(frozen=True, eq=False)
class Recommended:
    """Probability of each class by the recommended rule; A rows."""

    rule: str  # 'surface, hard', 'drop, feed'
    p: np.ndarray  # (A,) [1]
    low: np.ndarray  # (A,) [1]
    high: np.ndarray  # (A,) [1]


def closed_form(rule, p, others, stable):
    """Return the surface-weighted rule between the other answers one could have given.

    Parameters
    ----------
    rule : str
    p : (A,) float [1]
        Its probabilities.
    others : sequence of (A,) float [1]
        Those for other surfaces, and of other rules of the same worth.
    stable : (A,) bool

    Returns
    -------
    Recommended
        From the least to the greatest of all, MODEL wider on either side.
    """
    spread = np.array([p, *others])
    return _widened(rule, p, spread.min(axis=0), spread.max(axis=0), stable)


def dropped(tally, stable):
    """Return a drop test between its gentle and its violent launches, with its sampling interval.

    Parameters
    ----------
    tally : Tally
        Of LAUNCH.
    stable : (A,) bool

    Returns
    -------
    Recommended
        From the least to the greatest of these, MODEL wider on either side.
    """
    low = np.minimum.reduce([tally.low, tally.gentle, tally.violent])
    high = np.maximum.reduce([tally.high, tally.gentle, tally.violent])
    return _widened(f"drop, {LAUNCH}", tally.p, low, high, stable)


def _widened(rule, p, low, high, stable):
    """Ends MODEL further out, within 0 and 1; nothing is in doubt where only one class can be."""
    margin = np.where(stable, MODEL if np.count_nonzero(stable) > 1 else 0.0, 0.0)
    return Recommended(
        rule=rule,
        p=check.frozen(p),
        low=check.frozen(np.clip(low - margin, 0.0, p)),
        high=check.frozen(np.clip(np.where(stable, high, 0.0) + margin, p, 1.0)),
    )
