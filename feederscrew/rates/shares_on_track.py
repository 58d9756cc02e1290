"""What of the queue on the track stays there and leaves as it is wanted."""

import numpy as np

from feederscrew.rates.stream import Orientations
from feederscrew.tooling.orientations import Orientation

RECOMMENDED_RULE = "recommended"  # the rule that has an interval of its own


def mean_length(found: Orientations, rule: str) -> float:
    """Return the mean length along the track of the parts that stay on it [m]; NaN where none does.

    What falls off at the entry, or is turned over on the track, goes back at once: it is in nobody's way.

    Source: docs/conveying.md, "Commands".
    """
    chance, enters = entering(found, rule)
    weights = chance * found.stays
    return float((weights * found.lengths).sum() / enters) if enters > 0.0 else np.nan


def entering(found: Orientations, rule: str) -> tuple[np.ndarray, float]:
    """Return the chance (M,) [1] of each orientation by a rule, and the share [1] that stays on the track.

    Source: docs/conveying.md, "Commands".
    """
    chance = np.nan_to_num(found.rules[rule])
    return chance, float((chance * found.stays).sum())


def queued(found: Orientations, row: int, rule: str, gap: float, fill: float) -> float:
    """Return parts on a length of track before the devices [1/m]: all that stay on it.

    They come end to end, or as far apart as the devices need.

    Source: docs/conveying.md, "Commands"; the gap is that of docs/tooling.md, "1. The method".
    """
    length = mean_length(found, rule)
    return float(fill / ((found.lengths[row] if np.isnan(length) else length) + max(gap, found.gap)))


def efficiency(found: Orientations, row: int, rule: str) -> float:
    """Return the share of the parts offered, which are on the track, that leave in the orientation of a row.

    Source: docs/conveying.md, "Commands".

    Parameters
    ----------
    found : Orientations
    row : int
    rule : str

    Returns
    -------
    float [1]
    """
    chance, enters = entering(found, rule)
    return float((chance * fed_share(found, row)).sum() / enters) if enters > 0.0 else 0.0


def efficiency_ends(found: Orientations, row: int, rule: str) -> tuple[float, ...]:
    """Return the least and the greatest efficiency [1], by the rule's own interval or over all rules."""
    fed, (_, enters) = fed_share(found, row), entering(found, rule)
    if not enters > 0.0:
        return 0.0, 0.0
    if rule == RECOMMENDED_RULE and not np.isnan(found.interval).any():
        return tuple(min(float((end * fed).sum()) / enters, 1.0) for end in found.interval.T)
    all_rules = [efficiency(found, row, one) for one in found.rules]
    return min(all_rules), max(all_rules)


def fed(found: Orientations, row: int) -> Orientation:
    """Return the Orientation in which parts wanted as a row leave: as they lie, or hanging."""
    return found.states[found.leaves_as[row]]


def fed_share(found: Orientations, row: int) -> np.ndarray:
    """Return the share (M,) [1] of each orientation that leaves in the state of a wanted row.

    Source: docs/conveying.md, "Commands".
    """
    return np.where(found.rolls_back, 0.0, found.leaving[:, found.leaves_as[row]])
