"""The one answer we stand for: it names its rule and its launch, and has an interval."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.columns import Column
from feederscrew.base.errors import ArgumentError
from feederscrew.base.records import ReadableRecord
from feederscrew.resting.rules import registry

LAUNCH_NAMES = ("place", "drop", "flip", "roll", "feed")
LAUNCH = "feed"  # what is taken where nobody says how the parts are launched
FORMER = {"tumble": "roll"}  # what launches were called before
HOP_SHARES = {"place": 0.0, "drop": 0.4, "flip": 1.0, "roll": 1.0, "feed": 0.5}
"""[1] By launch, how far parts come from where they fall dead (0) to where hops leave them (1); chosen on
drop tests of made bodies, and for drop and feed with measured sets in view: docs/resting.md."""
ROLLING_RULES = {"drop": "csa"}  # the closed form nearest to drop tests of parts with a rolling class
ROLL = "quasistatic"  # ... under the other launches
SHARE_WIDTHS = {
    ("place", False): 0.15,
    ("place", True): 0.14,
    ("drop", False): 0.12,
    ("drop", True): 0.26,
    ("flip", False): 0.09,
    ("flip", True): 0.26,
    ("roll", False): 0.10,
    ("roll", True): 0.54,
    ("feed", False): 0.10,
    ("feed", True): 0.21,
}
"""[1] Half the 95 % interval of the closed form on a share of a half, by launch and whether the part has a
rolling class: such that it holds 95 % of the shares in drop tests of made bodies and real parts
(``benchmarks/accuracy.py`` prints it, with its coverage of bodies and sets left out)."""
LAUNCH_WIDTH = 0.11  # [1]
"""... of a drop test beside its sampling: what a new share, measured under a launch of that name, keeps
within of what is simulated (from 16 shares of four series; the same benchmark)."""
LAUNCH_WORDS = {  # what is done to the part, by launch
    "place": "set down by hand", "drop": "let fall", "flip": "spun as a coin", "roll": "cast or poured",
    "feed": "from a hopper into a bowl",
}  # fmt: skip
WIDTH_FLOOR = 0.1  # [1] of that width that does not fall towards shares of 0 and 1


@dataclass(frozen=True, eq=False)
class Recommended(ReadableRecord):
    """Probability of each class by the recommended rule, for one launch; A rows."""

    rule: str  # 'CSA, launch drop', 'drop test, launch flip'
    launch: str  # a key of ``launch_conditions.PRESETS``
    p: Floats  # (A,) [1]
    low: Floats  # (A,) [1]
    high: Floats  # (A,) [1]

    @property
    def words(self) -> str:
        """The rule with its launch in words: 'drop test, launch feed (from a hopper into a bowl)'."""
        launch = f"launch {self.launch}"
        return self.rule.replace(launch, f"{launch} ({LAUNCH_WORDS.get(self.launch, 'as given')})")


RECOMMENDED_COLUMNS: tuple[Column[Recommended], ...] = (
    Column("rule", lambda answer: answer.rule),
    Column("low", lambda answer: answer.low),
    Column("high", lambda answer: answer.high),
)


def launch_of_name(name: str) -> str:
    """Return the launch of a name, or of a former one.

    Parameters
    ----------
    name : str

    Returns
    -------
    str
        One of ``LAUNCH_NAMES``.

    Raises
    ------
    ArgumentError
        If there is no such launch.
    """
    launch = FORMER.get(name, name)
    if launch not in LAUNCH_NAMES:
        raise ArgumentError("launch", f"is {name!r:.30}", f"give one of {', '.join(LAUNCH_NAMES)}")
    return launch


def closed_form(
    chances: dict[str, Floats], stable: Bools, kinds: Sequence[str], launch: str, surface: str | None = None
) -> Recommended:
    """Return the answer of the closed form nearest to drop tests of a launch, with its calibrated interval.

    Parameters
    ----------
    chances : dict of str to (A,) float [1]
        By every rule.
    stable : (A,) bool
    kinds : sequence of A str
        'rolling' among them, where the part has a rolling class.
    launch : str
        One of ``LAUNCH_NAMES``.
    surface : str or None
        The user's own, such as 'soft'. With it the surface-weighted rule is the answer whatever the launch.

    Returns
    -------
    Recommended
        Shares with the ends of their interval, A rows.

    References
    ----------
    Own; docs/resting.md, "The recommended answer".
    """
    rolling = bool((np.array(kinds)[stable] == "rolling").any())
    if surface:
        label, p = f"surface, {surface}", chances["surface"]
    elif rolling:
        rule = ROLLING_RULES.get(launch, ROLL)
        label, p = registry.RULE_OF[rule].label, chances[rule]
    else:
        label, p = temper_shares(chances, HOP_SHARES[launch])
    # ends so far out, within 0 and 1; nothing is in doubt where only one class can be
    several = np.count_nonzero(stable) > 1
    half = np.where(stable & several, SHARE_WIDTHS[launch, rolling] * shape(p), 0.0)
    low, high = (check.frozen(np.clip(end, 0.0, 1.0)) for end in (p - half, p + half))
    return Recommended(f"{label}, launch {launch}", launch, check.frozen(p), low, high)


def temper_shares(chances: dict[str, Floats], share: float) -> tuple[str, Floats]:
    """Return exact tumbling and the cascade of hops together: their weighted geometric mean.

        p_i = q_i^(1 - w) c_i^w / sum over j of q_j^(1 - w) c_j^w

    Drop tests of gentle launches lie between the two, and their logarithms about as far from either on every
    face. A mean of the shares themselves is nearly as good.

    Parameters
    ----------
    chances : dict of str to (A,) float [1]
        By every rule: q is 'quasistatic', c is 'hops'.
    share : float [1]
        w, weight of the hops: 0 for parts that fall dead, 1 for parts that bounce until they can hop no more.

    Returns
    -------
    str
        Name of the answer.
    (A,) float [1]
        Shares, which sum to 1.

    References
    ----------
    Own; docs/resting.md, "The recommended answer".
    """
    if share in (0.0, 1.0):
        rule = "hops" if share else "quasistatic"
        return registry.RULE_OF[rule].label, chances[rule]
    weights = chances["quasistatic"] ** (1.0 - share) * chances["hops"] ** share
    return "tempered hops", weights / weights.sum()


def widen_for_launch(p: Floats, low: Floats, high: Floats, possible: Bools) -> tuple[Floats, Floats]:
    """Return the ends of an interval of simulated shares with the doubt that the name of a launch leaves.

    Both errors are taken as independent, so their squares add.

    Parameters
    ----------
    p : (A,) float [1]
    low : (A,) float [1]
        Lower end of the interval of the simulation: its sampling and its numerical error.
    high : (A,) float [1]
    possible : (A,) bool
        Classes that a part can rest on. If there is a single one, nothing is in doubt.

    Returns
    -------
    (A,) float [1]
        Lower ends, at least 0.
    (A,) float [1]
        Upper ends, at most 1.

    References
    ----------
    Own; docs/resting.md, "The recommended answer".
    """
    open_ = np.where(possible & (np.count_nonzero(possible) > 1), LAUNCH_WIDTH * shape(p), 0.0)
    return np.clip(p - np.hypot(open_, p - low), 0.0, 1.0), np.clip(p + np.hypot(open_, high - p), 0.0, 1.0)


def shape(p: Floats) -> Floats:
    """Return how wide intervals are at some shares, relative to a share of a half.

    It falls as the scatter of a count does, 2 sqrt(p (1 - p)), but for WIDTH_FLOOR.

    Parameters
    ----------
    p : (A,) float [1]

    Returns
    -------
    (A,) float [1]

    References
    ----------
    docs/resting.md, "The recommended answer".
    """
    return (2.0 * np.sqrt(np.clip(p * (1.0 - p), 0.0, None)) + WIDTH_FLOOR) / (1.0 + WIDTH_FLOOR)
