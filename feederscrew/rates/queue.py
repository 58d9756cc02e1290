"""From velocity to well-oriented parts: pitch, probability of the orientation, devices, fill."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.conveying import answer, sensitivity
from feederscrew.documents import hint
from feederscrew.errors import FeederError
from feederscrew.geometry.polygons import turned
from feederscrew.mechanics.wall.headings import headings, laid
from feederscrew.rates import devices as tooling
from feederscrew.resting.posture import posture

SAME = 1e-3  # of the part's size: hulls whose corners differ by less are the same


@dataclass(frozen=True, eq=False)
class Orientations:
    """Every way a part can lie on the track, an aspect and a heading a row; M rows."""

    aspects: tuple[str, ...]
    headings: np.ndarray  # (M,) [rad]
    heading_shares: (
        np.ndarray
    )  # (M,) of the parts on that aspect; headings equal under a turn of the part are one
    lengths: np.ndarray  # (M,) [m] along the track
    widths: np.ndarray  # (M,) [m]
    stations: tuple[str, ...]  # the track itself, then each device
    passes: np.ndarray  # (M, stations) share each station lets pass; the rest goes back into the bowl
    rules: dict[str, np.ndarray]  # (M,) probability of aspect and heading by each rule

    @property
    def through(self):
        """(M,) share that passes every station."""
        return self.passes.prod(axis=1)


@dataclass(frozen=True)
class Range:
    """A number and what it may be."""

    value: float
    low: float
    high: float

    def __mul__(self, factor):
        other = factor if isinstance(factor, Range) else Range(factor, factor, factor)
        return Range(self.value * other.value, self.low * other.low, self.high * other.high)


@dataclass(frozen=True, eq=False)
class Rate:
    """Well-oriented parts leaving the bowl, and each factor of the chain."""

    parts: Range  # [1/s]
    velocity: Range  # [m/s] over the starts and for friction a fifth lower and higher; not below 0
    pitch: float  # [m]
    probability: Range  # of the aspect and the heading; the range is over all rules
    through: float  # share of them that passes every station
    fill: float  # share of the track that is occupied
    purity: float  # share of what leaves the bowl that is well oriented; NaN where nothing leaves
    row: int  # of the wanted orientation
    orientations: Orientations


def orientations(part, aspects, track, chain=()):
    """Every stable aspect and heading of a part, and what becomes of it at each device.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    track : Track
    chain : sequence of Device

    Returns
    -------
    Orientations
    """
    rows, lying, found, first, shares = [], [], [], [], []
    for row in np.flatnonzero(aspects.stable):
        lying.append(posture(part, aspects, aspects.names[row]))
        found.append(headings(lying[-1], track))
        alike = _alike(lying[-1], found[-1])
        first.append(np.unique(alike))
        shares.append(np.bincount(alike, found[-1].shares)[first[-1]])
        rows += [row] * len(first[-1])
    joined = check.frozen(np.concatenate(shares))
    passes = [_passes(one, k, track, chain)[keep] for one, k, keep in zip(lying, found, first)]
    return Orientations(
        aspects=tuple(aspects.names[row] for row in rows),
        headings=_joined(found, first, "headings"),
        heading_shares=joined,
        lengths=_joined(found, first, "lengths"),
        widths=_joined(found, first, "widths"),
        stations=("track", *(device.kind for device in chain)),
        passes=check.frozen(np.concatenate(passes)),
        rules={name: check.frozen(chance[rows] * joined) for name, chance in aspects.chances.items()},
    )


def wanted(part, aspects, track, name, heading=None):
    """Aspect and heading that a part shall leave the bowl in.

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
    return lying.name, float(found.headings[_alike(lying, found)[laid(found, heading)]])


def velocity(bowl):
    """Conveying velocity with what it may be.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Range [m/s]
        Over all starts, here and for friction a fifth lower and higher; a part that travels back counts as 0.

    Raises
    ------
    FeederError
        If there is no steady state.
    """
    here = answer.answer(bowl)
    if here.status == "no steady state":
        what = "is steeper than friction holds: the part slides back for ever"
        raise FeederError("track.climb", what, "lower the climb or raise the friction")
    doubt = sensitivity.FRICTION_DOUBT
    around = [here, *(answer.answer(answer.scaled(bowl, friction=1.0 + s * doubt)) for s in (-1.0, 1.0))]
    low = min(0.0 if np.isnan(one.low) else one.low for one in around)
    high = max(0.0 if np.isnan(one.high) else one.high for one in around)
    return Range(*(max(0.0, number) for number in (here.velocity, low, high)))


def rate(found, speed, target, rule, *, gap=0.0, fill=1.0):
    """Well-oriented parts leaving a bowl.

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

    Raises
    ------
    FeederError
        If no such rule has probabilities of this part.
    """
    row, pitch = _row(found, target), _pitch(found, target, gap)
    _check_rule(found, rule)
    chances = [chance[row] for chance in found.rules.values() if not np.isnan(chance[row])]
    probability = Range(float(found.rules[rule][row]), float(min(chances)), float(max(chances)))
    through = float(found.through[row])
    leaving = float(np.nansum(found.rules[rule] * found.through))
    return Rate(
        parts=speed * (1.0 / pitch) * probability * (through * fill),
        velocity=speed,
        pitch=pitch,
        probability=probability,
        through=through,
        fill=fill,
        purity=probability.value * through / leaving if leaving else np.nan,
        row=row,
        orientations=found,
    )


def parts_per_metre(found, target, rule, *, gap=0.0, fill=1.0):
    """Well-oriented parts on a length of track, which velocity turns into a rate.

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
    _check_rule(found, rule)
    row = _row(found, target)
    share = float(found.rules[rule][row] * found.through[row] * fill)
    if not share > 0.0:
        where = f"aspect {target[0]}, heading {np.degrees(target[1]):.4g} deg"
        raise FeederError(where, "never leaves the bowl", "see the devices in feeder rate")
    return share / _pitch(found, target, gap)


def _check_rule(found, rule):
    if rule not in found.rules:
        raise FeederError(
            f"--rule {rule}", "has no probabilities of this part", hint(rule, list(found.rules))
        )


def _row(found, target):
    name, heading = target
    return next(k for k, known in enumerate(found.aspects) if (known, found.headings[k]) == (name, heading))


def _pitch(found, target, gap):
    return float(found.lengths[_row(found, target)] + gap)


def _alike(lying, found):
    """For each heading the first that is the same orientation: a turn maps the part's hull to itself."""
    from scipy.spatial import cKDTree

    corners, first = lying.corners, np.arange(len(found.headings))
    tree, size = cKDTree(corners), np.ptp(corners, axis=0).max()
    for row, heading in enumerate(found.headings):
        for known in np.unique(first[:row]):
            plan = turned(corners[:, :2], heading - found.headings[known])
            gap = tree.query(np.column_stack([plan, corners[:, 2]]))[0].max()
            if gap < SAME * size:
                first[row] = known
                break
    return first


def _joined(found, kept, name):
    return check.frozen(np.concatenate([getattr(one, name)[keep] for one, keep in zip(found, kept)]))


def _passes(lying, found, track, chain):
    stays = 1.0 - found.falls_off.astype(float)
    return np.column_stack([stays, *(tooling.passed(device, lying, found, track) for device in chain)])
