"""From looks at parts on a plate to shares, rates and velocities, each with its interval."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaincinv  # half a quantile of chi-square; scipy.stats takes a third of a second

from feederscrew import check
from feederscrew.dropping.ensemble import NORMAL_95, wilson
from feederscrew.dropping.kernel.one_drop import UNSETTLED
from feederscrew.geometry import vectors

RATE_DRAWS = 400  # of the rates, for the interval of where they lead
MISSED_TRANSITIONS = 0.5  # transition out of each class that may have been missed, shared by the ways out
MIN_TRANSITIONS = 5  # transitions: with fewer nothing is said of where they lead
BALANCE_DOUBLINGS = 48  # of the time to which the balance of the rates is followed
MIN_SHARE_CHANGE = 0.005  # smallest change of a share that is called one
SURE_ERRORS = 3.0  # standard errors by which it must stand out
DERIVED_FIELDS = ("plate_low", "plate_high", "rates", "rates_low", "rates_high")  # from other fields
SHARE_SUM_ROUNDING = 1e-9  # [1] by which shares may add up to more than 1


@dataclass(frozen=True, eq=False)
class Occupancy:
    """What N parts did on a plate; A classes. Intervals are of 95 %, over the parts."""

    start: np.ndarray  # (A,) [1] share of the parts by what they lay on at the first look that shows it
    plate: np.ndarray  # (A,) [1] share of the time, in the second half
    plate_low: np.ndarray  # (A,) [1]
    plate_high: np.ndarray
    error: np.ndarray  # (A,) [1] standard error of that share, from part to part
    limit: np.ndarray  # (A,) [1] share to which the rates lead in the end; NaN where too little was seen
    limit_low: np.ndarray  # (A,) [1]
    limit_high: np.ndarray
    changing: np.ndarray  # (A,) bool: the share still changed from the third quarter to the last
    counts: np.ndarray  # (A, A) int, from row to column; the diagonal, onto an equal face
    times: np.ndarray  # (A,) [s] spent in each class, of all parts together
    rates: np.ndarray  # (A, A) [1/s]; NaN where no time was spent
    rates_low: np.ndarray  # (A, A) [1/s]
    rates_high: np.ndarray
    velocity: np.ndarray  # (3,) [m/s] mean along the drive, over all; low, high
    velocities: np.ndarray  # (A, 3) [m/s] while in a class; NaN where nothing was seen, ends NaN of one part
    course: np.ndarray  # (K, A) [1] share of the parts at each look


def occupancy(faces, places, rows, count, period, rng) -> Occupancy:
    """Return shares, rates and velocities.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    faces : (N, K) int
        Face each part lies on at each look, UNSETTLED where that is open: such a part
        still counts for the face it lay on before.
    places : (N, K) float [m]
        How far it has come along the drive.
    rows : (F,) int
        Class of each face.
    count : int
        Classes.
    period : float [s]
        Between two looks.
    rng : numpy.random.Generator
        For ``limit`` and its interval.

    Returns
    -------
    Occupancy

    Notes
    -----
    A rate is the number of transitions over the time spent; its interval is that of a Poisson count
    (F. Garwood, Biometrika 28, 437-442, 1936). The interval of a share of time is Wilson's for so many
    parts, which is too wide where a part changes often: ``error`` knows of that. ``limit`` is the mean over
    RATE_DRAWS of all rates, each from a Gamma distribution of its count (with
    MISSED_TRANSITIONS) and time, of where they lead
    from the last look on; a class in which no time was spent is left out, as nothing is known of how it is
    left.
    """
    held = lasting(faces)
    classes = np.where(held == UNSETTLED, count, np.asarray(rows)[held])  # one more for parts not yet down
    inside = classes[:, :, None] == np.arange(count)
    counts, times = _moves(held, classes, count), period * inside[:, :-1].sum(axis=(0, 1))
    each = inside[:, inside.shape[1] // 2 :].mean(axis=1)
    half = each.mean(axis=0)
    low, high = wilson(half * len(held), len(held))
    limit, ends = _limits(counts, times, inside[:, -1].mean(axis=0), rng)
    arrays = {
        "start": _first(classes, count), "plate": half, "plate_low": low, "plate_high": high,
        "error": each.std(axis=0) / np.sqrt(len(each)),
        "limit": limit, "limit_low": ends[0], "limit_high": ends[1], "changing": _changing(inside),
        "counts": counts, "times": times, "course": inside.mean(axis=0),
        **_rates(counts, times), **_velocities(places, inside, period),
    }  # fmt: skip
    return Occupancy(**{name: check.frozen(np.asarray(value)) for name, value in arrays.items()})


def to_arrays(looks) -> Any:
    """Return an Occupancy as plain arrays, without those that follow from others.

    Source: own.
    """
    return {name: value for name, value in vars(looks).items() if name not in DERIVED_FIELDS}


def from_arrays(arrays, count, parts) -> Occupancy:
    """Return an Occupancy from plain arrays, once every number in them is one that it can have.

    Source: own. Intervals and rates follow from the other numbers, and are computed again.

    Parameters
    ----------
    arrays : dict of str to array
        As of ``to_arrays``.
    count : int
        Classes.
    parts : int
        Above 0.

    Returns
    -------
    Occupancy

    Raises
    ------
    ValueError
        If a number or a shape cannot be of so many parts.
    KeyError
        If an array is missing.
    """
    row, square = (count,), (count, count)
    read = partial(_ranged, arrays)
    start, plate = read("start", row, 0.0, 1.0), read("plate", row, 0.0, 1.0)
    counts, times = read("counts", square, 0, np.inf, whole=True), read("times", row, 0.0)
    course = read("course", (-1, count), 0.0, 1.0)
    changing = arrays["changing"]
    if changing.shape != row or changing.dtype.kind != "b":
        raise ValueError("changing is not one answer a class")
    most = 1.0 + SHARE_SUM_ROUNDING
    if len(course) < 1 or any((shares.sum(axis=-1) > most).any() for shares in (start, plate, course)):
        raise ValueError("shares add up to more than 1, or there are none")
    low, high = wilson(plate * parts, parts)
    fields = {
        "start": start, "plate": plate, "plate_low": low, "plate_high": high,
        "error": read("error", row, 0.0, 1.0),
        **{name: read(name, row, 0.0, most, gaps=True) for name in ("limit", "limit_low", "limit_high")},
        "changing": changing, "counts": counts, "times": times, "course": course, **_rates(counts, times),
        "velocity": read("velocity", (3,), gaps=True),
        "velocities": read("velocities", (count, 3), gaps=True),
    }  # fmt: skip
    return Occupancy(**{name: check.frozen(np.asarray(value)) for name, value in fields.items()})


def _ranged(arrays, name, *bounds, **kind):
    return check.ranged(name, arrays[name], *bounds, **kind)


def lasting(faces) -> NDArray[np.int64]:
    """Return the face (N, K) [1] each part lies on or lay on last; UNSETTLED before the first.

    Source: docs/resting.md, "On the vibrating plate".
    """
    at = np.where(faces == UNSETTLED, 0, np.arange(faces.shape[1]))
    return np.take_along_axis(faces, np.maximum.accumulate(at, axis=1), axis=1)


def limit_of(rates, start) -> NDArray[np.float64]:
    """Return the shares to which transitions lead in the end.

    Source: the stationary distribution of a Markov chain; docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    rates : (..., A, A) float [1/s]
        From row to column; the diagonal does not matter.
    start : (..., A) float [1]

    Returns
    -------
    (..., A) float [1]
        ``start`` where there is no transition.
    """
    rates = rates * (1.0 - np.eye(rates.shape[-1]))
    leaving = rates.sum(axis=-1)
    quickest = np.maximum(leaving.max(axis=-1), np.finfo(float).tiny)[..., None, None]
    step = 0.5 * rates / quickest
    step += np.eye(rates.shape[-1]) * (1.0 - step.sum(axis=-1))[..., None]
    for _ in range(BALANCE_DOUBLINGS):
        step = vectors.product(step, step)
        step /= step.sum(axis=-1, keepdims=True)
    return np.einsum("...i,...ij->...j", start, step)


def _first(classes, count) -> NDArray[np.float64]:
    """(A,) share of the parts by the class each lay on first."""
    first = classes[np.arange(len(classes)), np.argmax(classes < count, axis=1)]
    return np.bincount(first, minlength=count + 1)[:count] / len(classes)


def _moves(held, classes, count) -> NDArray[np.int64]:
    """(A, A) transitions, from row to column."""
    before, after = classes[:, :-1], classes[:, 1:]
    moved = (held[:, 1:] != held[:, :-1]) & (before < count)
    moves = np.zeros((count, count), int)
    np.add.at(moves, (before[moved], after[moved]), 1)
    return moves


def _rates(counts, times) -> dict[str, NDArray[np.float64]]:
    spent = np.where(times > 0.0, times, np.nan)[:, None]
    with np.errstate(invalid="ignore"):
        low = np.where(counts > 0, gammaincinv(np.maximum(counts, 1), 0.025), 0.0)
    high = gammaincinv(counts + 1, 0.975)
    return {"rates": counts / spent, "rates_low": low / spent, "rates_high": high / spent}


def _limits(counts, times, last, rng) -> Any:
    """Where the rates lead, and the ends of its interval."""
    moves = counts.sum() - np.trace(counts)
    if moves < MIN_TRANSITIONS:
        nothing = np.full(len(last), np.nan)
        return nothing, (nothing, nothing)
    spent = times > 0.0
    prior = MISSED_TRANSITIONS / max(spent.sum() - 1, 1)
    shape = (counts + prior)[np.ix_(spent, spent)]
    rates = rng.gamma(shape, size=(RATE_DRAWS, *shape.shape)) / times[spent, None]
    drawn = np.full((RATE_DRAWS, len(last)), np.nan)
    drawn[:, spent] = limit_of(rates, last[spent])
    return drawn.mean(axis=0), np.percentile(drawn, (2.5, 97.5), axis=0)


def _changing(inside) -> NDArray[np.bool_]:
    """Whether a class's share changed from the third quarter to the last by more than chance."""
    third, last = (inside[:, k * inside.shape[1] // 4 : (k + 1) * inside.shape[1] // 4] for k in (2, 3))
    change = last.mean(axis=1) - third.mean(axis=1)
    error = change.std(axis=0) / np.sqrt(len(change))
    return np.abs(change.mean(axis=0)) > np.maximum(SURE_ERRORS * error, MIN_SHARE_CHANGE)


def _velocities(places, inside, period) -> Any:
    """Mean velocity over the second half, and while in each class."""
    half = places.shape[1] // 2
    whole = (places[:, -1] - places[:, half]) / (period * (places.shape[1] - 1 - half))
    within = inside[:, half:-1]
    distances = np.einsum("nk,nka->na", np.diff(places[:, half:], axis=1), within)
    return {
        "velocity": _ratio(whole[:, None], np.ones((len(whole), 1)))[0],
        "velocities": _ratio(distances, period * within.sum(axis=1)),
    }


def _ratio(distances, times) -> NDArray[np.float64]:
    """(A, 3) sum of (N, A) ways over sum of (N, A) times, and its interval over the parts: NaN of one."""
    total = np.where(times.sum(axis=0) > 0.0, times.sum(axis=0), np.nan)
    mean = distances.sum(axis=0) / total
    parts = (times > 0.0).sum(axis=0)
    wider = np.sqrt(parts / np.where(parts > 1, parts - 1.0, np.nan))  # as the mean is of the same parts
    error = NORMAL_95 * wider * np.sqrt(((distances - mean * times) ** 2).sum(axis=0)) / total
    return np.stack([mean, mean - error, mean + error], axis=-1)
