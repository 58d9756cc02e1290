"""The one answer we stand for: it names its rule and its launch, and has an interval."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.resting.rules import registry

LAUNCHES = ("place", "drop", "flip", "roll", "feed")
LAUNCH = "feed"  # what is taken where nobody says how the parts are launched
FORMER = {"tumble": "roll"}  # what launches were called before
MODEL = 0.06  # [1]
"""What any of our methods may be off beside launch and sampling: twice 0.03, the root-mean-square error
left on measured cuboids by the best of them (``benchmarks/accuracy.py``)."""
CLOSED = {"place": "quasistatic", "drop": "csa", "roll": "surface", "feed": "hops"}
"""By launch, the closed form that is good enough for parts without a rolling class."""
ANYTHING = "hops"  # the closed form to have where none is good enough


@dataclass(frozen=True, eq=False)
class Recommended:
    """Probability of each class by the recommended rule, for one launch; A rows."""

    rule: str  # 'CSA, launch drop', 'drop test, launch flip'
    launch: str  # one of LAUNCHES
    p: np.ndarray  # (A,) [1]
    low: np.ndarray  # (A,) [1]
    high: np.ndarray  # (A,) [1]
    wants_drops: bool = False  # whether no closed form is good enough: drop the part


def launch_named(name):
    """Return the launch of a name, or of a former one.

    Raises
    ------
    ValueError
        If there is no such launch.
    """
    launch = FORMER.get(name, name)
    if launch not in LAUNCHES:
        raise ValueError(f"launch is {name!r}, not one of {', '.join(LAUNCHES)}")
    return launch


def good_enough(launch, rolling):
    """Return the closed form that is good enough for a launch, or None: a drop test is needed.

    Parameters
    ----------
    launch : str
        One of LAUNCHES.
    rolling : bool
        Whether the part has a rolling class.

    Returns
    -------
    str or None
        Name of a rule of the registry.
    """
    return None if rolling else CLOSED.get(launch)


def closed_form(chances, stable, kinds, launch, own=None):
    """Return the answer of the closed form for a launch.

    Parameters
    ----------
    chances : dict of str to (A,) float [1]
        By every rule.
    stable : (A,) bool
    kinds : sequence of str
        'rolling' among them, where the part has a rolling class.
    launch : str
        One of LAUNCHES.
    own : str, optional
        The user's own surface, 'soft': then the surface-weighted rule is the answer whatever the launch.

    Returns
    -------
    Recommended
        Where no closed form is good enough, that of ANYTHING, and ``wants_drops`` is true.
    """
    rule = "surface" if own else good_enough(launch, "rolling" in np.array(kinds)[stable])
    taken = rule or ANYTHING
    label = registry.BY_NAME[taken].label + (f", {own or 'hard'}" if taken == "surface" else "")
    p = chances[taken]
    ends = np.array([p, chances["hops"], chances["surface"]])
    return _widened(label, launch, p, ends.min(axis=0), ends.max(axis=0), stable, rule is None)


def dropped(tally, stable, launch):
    """Return a drop test between its gentle and its violent launches, with its sampling interval.

    Parameters
    ----------
    tally : Tally
        Of that launch.
    stable : (A,) bool
    launch : str
        One of LAUNCHES.

    Returns
    -------
    Recommended
        From the least to the greatest of these, MODEL wider on either side.
    """
    low = np.minimum.reduce([tally.low, tally.gentle, tally.violent])
    high = np.maximum.reduce([tally.high, tally.gentle, tally.violent])
    return _widened("drop test", launch, tally.p, low, high, stable)


def _widened(label, launch, p, low, high, stable, wants_drops=False):
    """Ends MODEL further out, within 0 and 1; nothing is in doubt where only one class can be."""
    several = np.count_nonzero(stable) > 1
    margin = np.where(stable, MODEL if several else 0.0, 0.0)
    return Recommended(
        rule=f"{label}, launch {launch}",
        launch=launch,
        p=check.frozen(p),
        low=check.frozen(np.clip(low - margin, 0.0, p)),
        high=check.frozen(np.clip(np.where(stable, high, 0.0) + margin, p, 1.0)),
        wants_drops=wants_drops and several,
    )
