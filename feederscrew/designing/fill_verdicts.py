"""Verdict on the queue at one fill: it holds, is refused, or is open; and how fills differ.

A design promises what its worst fill brings. So each fill is judged by its own parts alone: nothing that a
cleaner fill does improves the figure.
"""

import enum
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from feederscrew.base.columns import Column
from feederscrew.base.heavy import heavy
from feederscrew.bowl.verified import PURE, RATE_KEPT, SHOWN_PURITY
from feederscrew.designing import evidence
from feederscrew.trials.fills import BARE_TRACK, FilledQueue, LeavingPose, PoseKind

stats = heavy("scipy.stats")

FIRST_LOOK_S = 15.0  # [s] of a fill before anything is said to hold, and in which the track has filled
SLOW_AFTER_S = 20.0  # [s] of a fill before it is said to be too slow: few parts have come until then
REFUSED_CONFIDENCE = 0.99  # [1] one-sided, that a fill is less pure than is asked for
GOOD_PURITY = 0.99  # [1] of a fill that shall hold; one of SHOWN_PURITY shall not
HOLDS_IN_ERROR = 0.15  # [1] chance, at most, that a fill of SHOWN_PURITY or less is ever said to hold
REFUSED_IN_ERROR = 0.02  # [1] chance, at most, that one of GOOD_PURITY or more is refused for it
SETTLING_PARTS = 300  # good parts of the target in which a fill is settled, or is not at all
SHORTEST_LIMIT_S, LONGEST_LIMIT_S = 120.0, 3600.0  # [s] between which that time is
LONGER_BY = 1.5  # [1] of its time so far, that a fill takes which is pure already, and still open
DIFFERENCE_RISK = 0.01  # [1] chance at which fills that are alike would differ as much


class FillState(enum.Enum):
    """Verdict on a fill."""

    OPEN = enum.auto()  # more of its parts decide it
    HOLDS = enum.auto()
    REFUSED = enum.auto()


class FillLack(enum.Enum):
    """Criterion that a fill does not meet; one that holds meets all of them."""

    JAM = enum.auto()
    OVERLAP = enum.auto()  # parts stood deeper in something than ``MAX_QUEUE_DEPTH_M``: no evidence of a jam
    RATE = enum.auto()  # the low end of the rate is too low
    PURITY = enum.auto()  # too little of what left is wanted
    PURITY_NOT_SHOWN = enum.auto()  # too few parts left to show that it is pure
    PURITY_REFUSED = enum.auto()  # by the sequential test
    PURITY_OPEN = enum.auto()  # the sequential test has not decided
    FOLLOWED_BRIEFLY = enum.auto()  # for less than ``FIRST_LOOK_S``, and nothing else is lacking


def longest_time(target: float) -> float:
    """Return for how long a fill is followed at the most: until it brings ``SETTLING_PARTS`` at the target.

    It is 10 min at 30 a minute, ``SHORTEST_LIMIT_S`` at least and ``LONGEST_LIMIT_S`` at most.

    Parameters
    ----------
    target : float [1/s]

    Returns
    -------
    float [s]
    """
    return min(max(SETTLING_PARTS / target, SHORTEST_LIMIT_S), LONGEST_LIMIT_S)


def shows_rate(queue: FilledQueue, least_rate: float) -> bool:
    """Tell whether the lower end of the rate's 95 % interval is a rate or more.

    Parameters
    ----------
    queue : FilledQueue
    least_rate : float [1/s]

    Returns
    -------
    bool
    """
    return queue.ends[0] >= least_rate


def shows_purity(queue: FilledQueue) -> bool:
    """Tell whether ``PURE`` was seen at a fill, and a purity above ``SHOWN_PURITY`` is shown.

    Parameters
    ----------
    queue : FilledQueue

    Returns
    -------
    bool
    """
    return _is_pure(queue.right, queue.left)


def _is_pure(right: int, left: int) -> bool:
    return right > 0 and right >= PURE * left and evidence.share_at_least(right, left) > SHOWN_PURITY


def sequential_test(queue: FilledQueue) -> FillState:
    """Return what the sequential test says of the purity of a fill.

    It compares GOOD_PURITY p with SHOWN_PURITY q by the logarithm of their likelihood ratio,
    L = r ln(p / q) + w ln((1 - p) / (1 - q)), of r right parts and w wrong ones. A fill holds at
    L >= ln(1 / HOLDS_IN_ERROR), and is refused at L <= -ln(1 / REFUSED_IN_ERROR).

    Parameters
    ----------
    queue : FilledQueue

    Returns
    -------
    FillState
        Open between the two.

    References
    ----------
    A. Wald, "Sequential tests of statistical hypotheses", Ann. Math. Statist. 16, 117-186, 1945, eq. (3.26)
    and sec. 5.2.
    """
    likelier = evidence.log_likelihood_ratio(queue.right, queue.left, GOOD_PURITY, SHOWN_PURITY)
    if likelier <= math.log(REFUSED_IN_ERROR):
        return FillState.REFUSED
    return FillState.OPEN if likelier < -math.log(HOLDS_IN_ERROR) else FillState.HOLDS


def lacks_of_fill(queue: FilledQueue, least_rate: float) -> tuple[FillLack, ...]:
    """Return the criteria that a fill does not meet, whether or not more of its parts may meet them.

    Parameters
    ----------
    queue : FilledQueue
    least_rate : float [1/s]
        Wanted parts below which a fill does not hold.

    Returns
    -------
    tuple of FillLack
        () of a fill that holds.
    """
    lacks = list[FillLack]()
    if queue.jams:
        lacks.append(FillLack.JAM)
    if queue.overlaps:
        lacks.append(FillLack.OVERLAP)
    if not shows_rate(queue, least_rate):
        lacks.append(FillLack.RATE)
    test = sequential_test(queue)
    if queue.left and queue.right < PURE * queue.left:
        lacks.append(FillLack.PURITY)
    elif not shows_purity(queue):
        lacks.append(FillLack.PURITY_NOT_SHOWN)
    elif test is not FillState.HOLDS:
        lacks.append(FillLack.PURITY_REFUSED if test is FillState.REFUSED else FillLack.PURITY_OPEN)
    if not lacks and queue.seconds < 0.99 * FIRST_LOOK_S:
        lacks.append(FillLack.FOLLOWED_BRIEFLY)
    return tuple(lacks)


def judge_fill(queue: FilledQueue, least_rate: float, longest: float) -> FillState:
    """Return what the queue at a fill has shown.

    It holds where it meets every criterion of ``lacks_of_fill``: nothing has jammed, nothing stood while it
    was too deep in something, the lower end of its rate is the least that is asked for, at least ``PURE`` of
    what left is right, the lower bound of that share (one-sided, 95 %) is above ``SHOWN_PURITY``, and the
    sequential test says so too. It is refused where more parts cannot meet one any more: where a part has
    jammed; where the upper end of the rate is less; where the upper bound of the purity (one-sided,
    ``REFUSED_CONFIDENCE``) is below ``PURE``; where the sequential test refuses it; and where so many parts
    were wrong that it would not hold even if all others until the end were right. A fill with parts that
    stood too deep is open: the trial's fault neither refuses a device nor shows that it works.

    Parameters
    ----------
    queue : FilledQueue
    least_rate : float [1/s]
        Wanted parts below which a fill does not hold.
    longest : float [s]
        For which it may be followed.

    Returns
    -------
    FillState
        However often a fill is looked at, one that is 97 % pure or less holds in 15 % of the runs at most
        (in 13 % of exact counts, one that is 96 % pure in 3 %), and the sequential test refuses one that is
        99 % pure or more in 2 % at most. This is so of parts that are wrong by chance, each by itself: where
        one wrong part brings others, their runs are longer than that. The rate's ends are those of one look.

    References
    ----------
    A. Wald, "Sequential tests of statistical hypotheses", Ann. Math. Statist. 16, 117-186, 1945, eq. (3.26)
    and sec. 5.2. Each limit is that of one error, by Ville's inequality, as in G. Lorden, "2-SPRT's and the
    modified Kiefer-Weiss problem", Ann. Statist. 4, 281-291, 1976.
    """
    if queue.jams:
        return FillState.REFUSED
    if queue.seconds > 0.99 * SLOW_AFTER_S and queue.ends[1] < least_rate:
        return FillState.REFUSED
    wrong = queue.left - queue.right
    if queue.left and evidence.share_at_most(queue.right, queue.left, REFUSED_CONFIDENCE) < PURE:
        return FillState.REFUSED
    if sequential_test(queue) is FillState.REFUSED:
        return FillState.REFUSED
    coming = int(queue.left * max(longest / max(queue.seconds, 1e-300) - 1.0, 0.0))
    if wrong and not _is_pure(queue.right + coming, queue.left + coming):
        return FillState.REFUSED
    return FillState.OPEN if lacks_of_fill(queue, least_rate) else FillState.HOLDS


def time_to_settle(queue: FilledQueue, longest: float) -> float:
    """Return a guess of the time from its begin at which a fill is settled, if no more parts are wrong.

    It holds by its purity as soon as so many right parts have left, which come at the rate so far. Where that
    was reached already, something else keeps it open, and the guess is that it takes half as long again.

    Parameters
    ----------
    queue : FilledQueue
        As far as it was followed.
    longest : float [s]
        For which it may be followed.

    Returns
    -------
    float [s]
        At least the time for which it was followed; ``longest`` where nothing right has left.
    """
    if queue.right == 0:
        return longest
    wrong = queue.left - queue.right
    odds = math.log((1.0 - SHOWN_PURITY) / (1.0 - GOOD_PURITY))
    needed = math.ceil((wrong * odds - math.log(HOLDS_IN_ERROR)) / math.log(GOOD_PURITY / SHOWN_PURITY))
    while not _is_pure(needed, needed + wrong):
        needed += 1
    lacking = needed / queue.right if needed > queue.right else LONGER_BY
    return min(max(queue.seconds * lacking, queue.seconds), longest)


def least_of(target: float) -> float:
    """Return the rate that a fill must show: ``RATE_KEPT`` of the target.

    Parameters
    ----------
    target : float [1/s]

    Returns
    -------
    float [1/s]
    """
    return RATE_KEPT * target


# --- How fills differ ---


class DifferenceKind(enum.StrEnum):
    """In what a fill is worse than the others; files print the word."""

    PURITY = "purity"  # of what leaves, less is right
    YIELD = "yield"  # of what is offered, less leaves as wanted


@dataclass(frozen=True)
class FillDifference:
    """A fill that is worse than the others by more than chance."""

    fill: str
    kind: DifferenceKind
    right: int
    total: int  # parts that left, or were offered
    right_elsewhere: int  # at the other fills
    total_elsewhere: int
    chance: float  # [1] of such counts, or others as unlikely, if the fills were alike (Fisher, exact)
    pose: LeavingPose | None = None  # in which most parts leave wrong there
    count: int = 0  # of these parts; or of those that came as wanted and fell back at the device
    device: str = ""  # name of the one that they pass, or at which they fall back; '' the bare track


DIFFERENCE_COLUMNS: tuple[Column[FillDifference], ...] = (
    Column("fill", lambda item: item.fill),
    Column("kind", lambda item: item.kind),
    Column("right", lambda item: item.right),
    Column("of", lambda item: item.total),
    Column("right_elsewhere", lambda item: item.right_elsewhere),
    Column("of_elsewhere", lambda item: item.total_elsewhere),
    Column("chance", lambda item: item.chance),
    Column("leaves_instead", lambda item: None if item.pose is None else item.pose.text),
    Column("parts", lambda item: item.count),
    Column("device", lambda item: item.device),
)


def differing_fills(queues: Sequence[FilledQueue], cuts: Iterable = ()) -> tuple[FillDifference, ...]:
    """Return the fills that are worse than the others, with what goes wrong there.

    Parameters
    ----------
    queues : sequence of FilledQueue
        Of the fills.
    cuts : iterable of Cut
        The chain, which says what each device shall return.

    Returns
    -------
    tuple of FillDifference
        Of purity and of yield, where Fisher's exact test gives ``DIFFERENCE_RISK`` or less.

    References
    ----------
    R. A. Fisher, "Statistical methods for research workers", 5th ed., 1934, sec. 21.02.
    """
    cuts = tuple(cuts)
    differences = []
    for queue in queues:
        others = [other for other in queues if other is not queue]
        for kind, name in ((DifferenceKind.PURITY, "left"), (DifferenceKind.YIELD, "offered")):
            right, total = queue.right, getattr(queue, name)
            elsewhere = sum(other.right for other in others), sum(getattr(other, name) for other in others)
            if not total or not elsewhere[1] or right * elsewhere[1] >= elsewhere[0] * total:
                continue
            table = [[right, total - right], [elsewhere[0], elsewhere[1] - elsewhere[0]]]
            chance = float(stats.fisher_exact(table).pvalue)
            if chance > DIFFERENCE_RISK:
                continue
            if kind is DifferenceKind.PURITY:
                pose, count = next(iter(queue.left_instead), (None, 0))
                device = _passed_device(pose, cuts)
            else:
                pose, (device, count) = None, _worst_place(queue, others)
            differences.append(
                FillDifference(queue.fill, kind, right, total, *elsewhere, chance, pose, count, device)
            )
    return tuple(differences)


def _passed_device(pose: LeavingPose | None, cuts: tuple) -> str:
    """The name of the device that should return a pose: the last that does so, or the last of the chain."""
    if pose is not None and pose.kind is PoseKind.ORIENTATION:
        for cut in reversed(cuts):
            if pose.name in cut.returns:
                return cut.device.kind
    return cuts[-1].device.kind if cuts else BARE_TRACK


def _worst_place(queue: FilledQueue, others: Sequence[FilledQueue]) -> tuple[str, int]:
    """Where parts that came as wanted fall back more often, of those offered, than at other fills."""
    offered = sum(other.offered for other in others)

    def excess(place: tuple[str, int]) -> float:
        name, count = place
        elsewhere = sum(dict(other.wanted_returned_at).get(name, 0) for other in others)
        return count / queue.offered - elsewhere / max(offered, 1)

    return max(queue.wanted_returned_at, key=excess, default=(BARE_TRACK, 0))
