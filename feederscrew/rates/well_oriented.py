"""From velocity to well-oriented parts: pitch, probability of the orientation, devices, fill."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.conveying import answer, sensitivity
from feederscrew.documents import hint
from feederscrew.errors import ArgumentError, FeederError
from feederscrew.mechanics.wall.stable_headings import headings, stable_row
from feederscrew.rates.stream import Orientations
from feederscrew.records import Shown
from feederscrew.resting.posture import posture
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


__all__ = [
    "Orientations", "Range", "Rate", "efficiency", "fed", "mean_length",
    "parts_per_metre", "rate", "velocity", "wanted",
]  # fmt: skip
ROLLS_BACK_REMARK = "lies on its round side and rolls back down the climb"
HOLD_ADVICE = "bank the track, so that friction.wall tan(bank) is above tan(climb), or take another aspect"


@dataclass(frozen=True)
class Range:
    """A number and what it may be."""

    value: float
    low: float
    high: float

    @property
    def ends(self):
        """Its lowest and its highest."""
        return self.low, self.high

    @property
    def all(self):
        """Value, lowest, highest."""
        return self.value, self.low, self.high

    def __mul__(self, factor):
        other = factor if isinstance(factor, Range) else Range(factor, factor, factor)
        return Range(self.value * other.value, self.low * other.low, self.high * other.high)


@dataclass(frozen=True, eq=False)
class Rate(Shown):
    """Well-oriented parts leaving the bowl, and each factor of the chain."""

    parts: Range  # [1/s] delivered: offered times efficiency, at most what fits behind the devices
    offered: Range  # [1/s] parts that arrive at the first device, in every orientation
    efficiency: float  # [1] share of the parts offered that leave well oriented
    velocity: Range  # [m/s] over the starts and surfaces of ``velocity``; not below 0
    pitch: float  # [m] mean of the queue before the devices
    gap: float  # [m] between one part and the next
    probability: Range  # of the aspect and the heading; the range is the rule's own, or over all rules
    through: float  # share of them that passes every station
    fill: float  # share of the track that is occupied
    purity: float  # of what leaves, or is not sure to be returned, well oriented; NaN where nothing leaves
    row: int  # of the wanted orientation
    orientations: Orientations
    jams: float = 0.0  # [1/s] parts that come to stand before a device; the rate holds between jams only
    clearing: float = 0.0  # [s] in the mean, of those that a blade sweeps off the track


def wanted(part, aspects, track, name, heading=None):
    """Return aspect and heading that a part shall leave the bowl in.

    Source: docs/mechanics.md, "Headings".

    Parameters
    ----------
    part : Part
    aspects : Aspects
    track : Track
    name : str
        Of the aspect.
    heading : float [rad], optional
        Without one, the most frequent heading that stays on the track.

    Returns
    -------
    (str, float [rad])
    """
    lying = posture(part, aspects, name)
    found = headings(lying, track)
    return lying.name, float(found.headings[stable_row(found, heading)])


def velocity(bowl):
    """Return conveying velocity with what it may be.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Range [m/s]
        Over all starts, here, for friction a fifth lower and higher and, where it hops, over the spread of
        restitution; a part that travels back counts as 0.

    Raises
    ------
    FeederError
        If there is no steady state.
    """
    here = answer.answer(bowl)
    if here.status == "no steady state":
        what = "is steeper than friction holds: the part slides down continuously"
        raise FeederError("track.climb", what, "lower the climb or raise the friction")
    others = sensitivity.surfaces(bowl, here.throw_number > 1.0)[1:]
    around = [here, *map(answer.answer, others)]
    low = min(0.0 if np.isnan(one.low) else one.low for one in around)
    high = max(0.0 if np.isnan(one.high) else one.high for one in around)
    return Range(*(max(0.0, number) for number in (here.velocity, low, high)))


def rate(found, speed, target, rule, *, gap=0.0, fill=1.0):
    """Return well-oriented parts leaving a bowl.

    Source: docs/conveying.md, "Commands".

    Parameters
    ----------
    found : Orientations
    speed : Range [m/s]
        From ``velocity``.
    target : (str, float [rad])
        From ``wanted``.
    rule : str
        Whose probability is taken.
    gap : float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.

    Returns
    -------
    Rate
        What lies on its round side across the track rolls back and is not offered; in the highest rate it is
        carried as what slides, since a drive that throws it or a wall may do so.

    Raises
    ------
    FeederError
        If no such rule has probabilities of this part.
    """
    made = _rate(found, speed, target, rule, gap, fill)
    if not found.rolls_back.any():
        return made
    most = _rate(found.carried, speed, target, rule, gap, fill).parts
    parts = Range(made.parts.value, made.parts.low, max(made.parts.high, most.high))
    return replace(made, parts=parts)


def _rate(found, speed, target, rule, gap, fill):
    """The rate of what does not roll back."""
    row = _row(found, target)
    _check_rule(found, rule)
    density, share = queued(found, row, rule, gap, fill), efficiency(found, row, rule)
    probability = _probability(found, row, rule)
    blocked, swept = _blocked(found, rule)
    offered = Range(*(_offered(one * density, blocked) for one in speed.all))
    most = speed * (1.0 / fed(found, row).length)
    made = offered * Range(share, *efficiency_ends(found, row, rule))
    chance, enters = entering(found, rule)
    alike = np.arange(len(chance)) == row
    leaves = np.where(alike, found.leaves, found.may_leave)
    leaving = float((chance * leaves).sum() / enters) if enters > 0.0 else 0.0
    through = float(found.through[row])
    return Rate(
        parts=Range(*(min(one, cap) for one, cap in zip(made.all, most.all))),
        offered=offered,
        efficiency=share,
        velocity=speed,
        pitch=fill / density,
        gap=max(gap, found.gap),
        probability=probability,
        through=through,
        fill=fill,
        purity=share / leaving if leaving else np.nan,
        row=row,
        orientations=found,
        jams=offered.value * _standing(found, rule),
        clearing=swept,
    )


def _offered(freely, blocked):
    """Parts a second that come to the devices, each of which blocks the track for a time [s] in the mean."""
    return 1.0 / (1.0 / freely + blocked) if freely > 0.0 else 0.0


def _standing(found, rule):
    """Share of the parts offered that come to stand before a device."""
    chance, enters = entering(found, rule)
    return float((chance * found.stops.sum(axis=1)).sum() / enters) if enters > 0.0 else 0.0


def _blocked(found, rule):
    """Mean time [s] for which a part that is offered blocks the track, and the same of those that do."""
    chance, enters = entering(found, rule)
    does = chance * (found.clearing > 0.0)
    times = float((chance * found.clearing).sum())
    return (times / enters, times / float(does.sum())) if does.sum() > 0.0 else (0.0, 0.0)


def _probability(found, row, rule):
    """Probability of a row by a rule, within that rule's own interval or the range of all rules."""
    value = float(found.rules[rule][row])
    if rule == RECOMMENDED_RULE and not np.isnan(found.interval[row]).any():
        return Range(value, *(float(end) for end in found.interval[row]))
    chances = [chance[row] for chance in found.rules.values() if not np.isnan(chance[row])]
    return Range(value, float(min(chances)), float(max(chances)))


def parts_per_metre(found, target, rule, *, gap=0.0, fill=1.0):
    """Return well-oriented parts on a length of track, which velocity turns into a rate.

    Source: docs/conveying.md, "Commands".

    Parameters
    ----------
    found, target, rule, gap, fill
        As for ``rate``.

    Returns
    -------
    float [1/m]

    Raises
    ------
    FeederError
        If there are none: the probability is zero, or the track or a device returns them all.
    """
    parts = leaving_per_metre(found, target, rule, gap=gap, fill=fill)
    if not parts > 0.0:
        holds(found, target)
        raise FeederError(_where(target), "never leaves the bowl", "see the devices in feeder rate")
    return parts


def holds(found, target):
    """Raise a FeederError where a wanted orientation rolls back down the climb."""
    if found.rolls_back[_row(found, target)]:
        raise FeederError(_where(target), ROLLS_BACK_REMARK, HOLD_ADVICE)


def _where(target):
    return f"aspect {target[0]}, heading {np.degrees(target[1]):.4g} deg"


def leaving_per_metre(found, target, rule, *, gap=0.0, fill=1.0):
    """Return the same [1/m], 0 where no part leaves so."""
    _check_rule(found, rule)
    row = _row(found, target)
    share, density = efficiency(found, row, rule), queued(found, row, rule, gap, fill)
    speed, (blocked, _) = found.lying[row].speed, _blocked(found, rule)
    density = _offered(speed * density, blocked) / speed if blocked > 0.0 and speed > 0.0 else density
    return min(share * density, 1.0 / float(fed(found, row).length))


def _check_rule(found, rule):
    if rule not in found.rules:
        mend = hint(rule, list(found.rules))
        raise ArgumentError(f"rule {rule}", "has no probabilities of this part", mend)


def _row(found, target):
    name, heading = target
    return next(k for k, known in enumerate(found.aspects) if (known, found.headings[k]) == (name, heading))
