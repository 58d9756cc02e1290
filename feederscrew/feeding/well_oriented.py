"""From velocity to well-oriented parts: pitch, probability of the orientation, devices, fill."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.base.documents import hint
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.record import Bowl, Track
from feederscrew.feeding import stream
from feederscrew.feeding.stream import Orientations
from feederscrew.motion import conveying as answer
from feederscrew.motion.headings import headings, stable_row
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import posture
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER
from feederscrew.sorting.orientations import Orientation


def entering(queue: Orientations, rule: str) -> tuple[Floats, float]:
    """Return the chance of each orientation by a rule, and the share that stays on the track.

    Parameters
    ----------
    queue : Orientations
    rule : str
        A key of ``queue.rules``.

    Returns
    -------
    (M,) float [1]
        Chances; 0 where the rule has none.
    float [1]
        Share that stays.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    chance = np.nan_to_num(queue.rules[rule])
    return chance, float((chance * queue.stays).sum())


def mean_length(queue: Orientations, rule: str) -> float:
    """Return the mean length along the track of the parts that stay on it.

    What falls off at the entry, or is turned over on the track, goes back at once: it is in nobody's way.

    Parameters
    ----------
    queue : Orientations
    rule : str
        A key of ``queue.rules``.

    Returns
    -------
    float [m]
        NaN where no part stays.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    chance, enters = entering(queue, rule)
    weights = chance * queue.stays
    return float((weights * queue.lengths).sum() / enters) if enters > 0.0 else np.nan


def _of_entering(queue: Orientations, rule: str, values: Floats) -> float:
    """Return the mean of ``values`` (M,) over all that enters the track; 0 where nothing enters."""
    chance, enters = entering(queue, rule)
    return float((chance * values).sum() / enters) if enters > 0.0 else 0.0


def _queued(queue: Orientations, row: int, rule: str, gap: float, fill: float) -> float:
    """Return the parts on a length of track before the devices [1/m]: all that stay on it.

    They come end to end, or as far apart as the devices need: fill / (mean length + gap). Source:
    docs/tooling.md, "1. The method".
    """
    length = mean_length(queue, rule)
    return float(fill / ((queue.lengths[row] if np.isnan(length) else length) + max(gap, queue.gap)))


def efficiency(queue: Orientations, row: int, rule: str) -> float:
    """Return the share of the parts offered, which are on the track, that leave in the state of a row.

    Parameters
    ----------
    queue : Orientations
    row : int
        Of the wanted orientation.
    rule : str
        A key of ``queue.rules``.

    Returns
    -------
    float [1]
        0 where no part enters the track.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    return _of_entering(queue, rule, _fed_share(queue, row))


def fed(queue: Orientations, row: int) -> Orientation:
    """Return the orientation in which parts wanted as a row leave: as they lie, or hanging.

    Parameters
    ----------
    queue : Orientations
    row : int

    Returns
    -------
    Orientation
    """
    return queue.states[queue.leaves_as[row]]


def _fed_share(queue: Orientations, row: int) -> Floats:
    """Return the share (M,) [1] of each orientation that leaves in the state of a wanted row."""
    return np.where(queue.rolls_back, 0.0, queue.leaving[:, queue.leaves_as[row]])


ROLLS_BACK_REMARK = "lies on its round side and rolls back down the climb"
HOLD_ADVICE = "bank the track, so that friction.wall tan(bank) is above tan(climb), or take another aspect"


@dataclass(frozen=True)
class Range:
    """A number and what it may be."""

    value: float
    low: float
    high: float

    @property
    def ends(self) -> tuple[float, float]:
        """Return the lowest and the highest."""
        return self.low, self.high

    @property
    def all(self) -> tuple[float, float, float]:
        """Return value, lowest, highest."""
        return self.value, self.low, self.high

    def __mul__(self, factor: "Range | float") -> "Range":
        other = factor if isinstance(factor, Range) else Range(factor, factor, factor)
        return Range(self.value * other.value, self.low * other.low, self.high * other.high)


@dataclass(frozen=True, eq=False)
class Rate(ReadableRecord, view="record_lines.RATE_VIEW"):
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


def wanted(
    part: Part,
    aspects: Aspects,
    track: Track,
    name: str,
    heading: float | None = None,
    devices: Sequence[Device] = (),
) -> tuple[str, float]:
    """Return aspect and heading [rad] that a part shall leave the bowl in.

    Without a heading it is the one of the aspect that most of its parts leave the devices in. Where none
    leaves, or there are no devices, it is the most frequent one that stays on the track.

    Parameters
    ----------
    part : Part
        From a mesh, or a card if there are no devices.
    aspects : Aspects
        Of the part.
    track : Track
        On which the part lies.
    name : str
        Of an aspect; upper or lower case.
    heading : float [rad], optional
        Of a stable orientation.
    devices : sequence of Device
        Along the track, in the order parts meet them.

    Returns
    -------
    str
        Name of the aspect, as the part has it.
    float [rad]
        The heading.

    Raises
    ------
    FeederError
        If there is no such aspect, or none of its headings is stable.

    References
    ----------
    docs/mechanics.md, "Headings".
    """
    lying = posture(part, aspects, name)
    stable = headings(lying, track)
    if heading is None and devices:
        queue = stream.follow_orientations(part, aspects, track, devices)
        own = np.array([aspect == lying.name for aspect in queue.aspects])
        leaving = ((queue.heading_shares * own)[:, None] * queue.leaving).sum(axis=0)
        leaves_so = np.where(own, leaving[queue.leaves_as], 0.0)
        if leaves_so.any():
            return lying.name, float(queue.headings[int(np.argmax(leaves_so))])
    return lying.name, float(stable.headings[stable_row(stable, heading)])


def velocity(bowl: Bowl) -> Range:
    """Return the conveying velocity with what it may be; a part that travels back counts as 0.

    The range is over all starts, for the bowl itself, for friction a fifth lower and higher and, where parts
    hop, over the spread of restitution: ``answer.surfaces``.

    Parameters
    ----------
    bowl : Bowl
        Single values.

    Returns
    -------
    Range [m/s]

    Raises
    ------
    FeederError
        If there is no steady state.
    """
    here = answer.answer(bowl)
    if here.unsteady == answer.UnsteadyMotion.KEEPS_SPEED:
        what = "is 0 on a level track: the part keeps whatever speed it has, no velocity is steady"
        raise FeederError("friction.static", what, "raise friction.static and friction.kinetic")
    if here.unsteady:
        what = "is steeper than friction holds: the part slides down continuously"
        raise FeederError("track.climb", what, "lower the climb or raise the friction")
    surfaces = answer.surfaces(bowl, here.throw_number > 1.0)[1:]
    around = [here, *map(answer.answer, surfaces)]
    low = min(0.0 if np.isnan(orientation.low) else orientation.low for orientation in around)
    high = max(0.0 if np.isnan(orientation.high) else orientation.high for orientation in around)
    return Range(*(max(0.0, number) for number in (here.velocity, low, high)))


def rate(
    queue: Orientations,
    speed: Range,
    target: tuple[str, float],
    rule: str,
    *,
    gap: float = 0.0,
    fill: float = 1.0,
) -> Rate:
    """Return well-oriented parts leaving a bowl.

        offered = 1 / (1 / (velocity density) + blocked)
        parts = min(offered efficiency, velocity / length of the part as it leaves)

    The density is that of the queue before the devices, ``blocked`` the mean time for which an offered part
    blocks the track on its way off it. What lies on its round side across the track rolls back and is not
    offered; in the highest rate it is carried like what slides, since a drive that throws it or a wall may do
    so.

    Parameters
    ----------
    queue : Orientations
    speed : Range [m/s]
        Of ``velocity``.
    target : (str, float [rad])
        Aspect and heading of ``wanted``.
    rule : str
        A key of ``queue.rules``.
    gap : float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.

    Returns
    -------
    Rate

    Raises
    ------
    FeederError
        If no such rule has probabilities of this part.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    row = _row(queue, target)
    _check_rule(queue, rule)
    density = _queued(queue, row, rule, gap, fill)
    blocked, swept = _blocked(queue, rule)
    offered = Range(*(_offered(velocity * density, blocked) for velocity in speed.all))
    # least and greatest efficiency and probability: by the rule's own interval, or over all rules
    from_interval = rule == RECOMMENDED_ANSWER
    share, fed_share = efficiency(queue, row, rule), _fed_share(queue, row)
    _, enters = entering(queue, rule)
    if not enters > 0.0:
        efficiencies = [0.0]
    elif from_interval and not np.isnan(queue.interval).any():
        efficiencies = [min(float((end * fed_share).sum()) / enters, 1.0) for end in queue.interval.T]
    else:
        efficiencies = [efficiency(queue, row, other) for other in queue.rules]
    if from_interval and not np.isnan(queue.interval[row]).any():
        low, high = (float(end) for end in queue.interval[row])
    else:
        chances = [chance[row] for chance in queue.rules.values() if not np.isnan(chance[row])]
        low, high = float(min(chances)), float(max(chances))
    delivered = offered * Range(share, min(efficiencies), max(efficiencies))
    most = speed * (1.0 / fed(queue, row).length)
    parts = Range(*(min(parts, cap) for parts, cap in zip(delivered.all, most.all)))
    if queue.rolls_back.any():
        highest = rate(queue.carried, speed, target, rule, gap=gap, fill=fill).parts.high
        parts = replace(parts, high=max(parts.high, highest))
    own = np.arange(len(queue.lying)) == row
    leaving = _of_entering(queue, rule, np.where(own, queue.leaves, queue.may_leave))
    return Rate(
        parts=parts,
        offered=offered,
        efficiency=share,
        velocity=speed,
        pitch=fill / density,
        gap=max(gap, queue.gap),
        probability=Range(float(queue.rules[rule][row]), low, high),
        through=float(queue.through[row]),
        fill=fill,
        purity=share / leaving if leaving else np.nan,
        row=row,
        orientations=queue,
        jams=offered.value * _of_entering(queue, rule, queue.stops.sum(axis=1)),
        clearing=swept,
    )


def _offered(freely: float, blocked: float) -> float:
    """Return the parts a second that come to the devices, if each blocks the track for a mean time [s]."""
    return 1.0 / (1.0 / freely + blocked) if freely > 0.0 else 0.0


def _blocked(queue: Orientations, rule: str) -> tuple[float, float]:
    """Return the mean time [s] for which an offered part blocks the track, and the mean of those that do."""
    chance, enters = entering(queue, rule)
    does = chance * (queue.clearing > 0.0)
    times = float((chance * queue.clearing).sum())
    return (times / enters, times / float(does.sum())) if does.sum() > 0.0 else (0.0, 0.0)


def parts_per_metre(
    queue: Orientations, target: tuple[str, float], rule: str, *, gap: float = 0.0, fill: float = 1.0
) -> float:
    """Return well-oriented parts on a length of track, which velocity turns into a rate.

    Parameters
    ----------
    queue : Orientations
    target : (str, float [rad])
        Aspect and heading.
    rule : str
        A key of ``queue.rules``.
    gap : float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.

    Returns
    -------
    float [1/m]
        Above 0.

    Raises
    ------
    FeederError
        If there are none: the probability is zero, or the track or a device returns them all.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    parts = leaving_per_metre(queue, target, rule, gap=gap, fill=fill)
    if not parts > 0.0:
        holds(queue, target)
        raise FeederError(_where(target), "never leaves the bowl", "see the devices in feeder rate")
    return parts


def holds(queue: Orientations, target: tuple[str, float]) -> None:
    """Raise a FeederError where a wanted orientation rolls back down the climb.

    Parameters
    ----------
    queue : Orientations
    target : (str, float [rad])
        Aspect and heading.

    Returns
    -------
    None

    Raises
    ------
    FeederError
        If it rolls back; the line says how to hold it.
    """
    if queue.rolls_back[_row(queue, target)]:
        raise FeederError(_where(target), ROLLS_BACK_REMARK, HOLD_ADVICE)


def _where(target: tuple[str, float]) -> str:
    return f"aspect {target[0]}, heading {np.degrees(target[1]):.4g} deg"


def leaving_per_metre(
    queue: Orientations, target: tuple[str, float], rule: str, *, gap: float = 0.0, fill: float = 1.0
) -> float:
    """Return well-oriented parts on a length of track, 0 where no part leaves so.

    They are efficiency times the density of the queue, at most one behind the other as they leave. What
    blocks the track thins the queue: ``_offered`` at the speed of the wanted orientation.

    Parameters
    ----------
    queue : Orientations
    target : (str, float [rad])
        Aspect and heading.
    rule : str
        A key of ``queue.rules``.
    gap : float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.

    Returns
    -------
    float [1/m]

    Raises
    ------
    FeederError
        If no such rule has probabilities of this part.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    _check_rule(queue, rule)
    row = _row(queue, target)
    share, density = efficiency(queue, row, rule), _queued(queue, row, rule, gap, fill)
    speed, (blocked, _) = queue.lying[row].speed, _blocked(queue, rule)
    density = _offered(speed * density, blocked) / speed if blocked > 0.0 and speed > 0.0 else density
    return min(share * density, 1.0 / float(fed(queue, row).length))


def _check_rule(queue: Orientations, rule: str) -> None:
    if rule not in queue.rules:
        mend = hint(rule, list(queue.rules))
        raise ArgumentError(f"rule {rule}", "has no probabilities of this part", mend)


def _row(queue: Orientations, target: tuple[str, float]) -> int:
    return list(zip(queue.aspects, queue.headings)).index(target)
