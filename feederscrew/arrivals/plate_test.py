"""A virtual dynamic bowl test of one part: many, one at a time, on plates that vibrate, on several cores.

What is seen of them becomes shares, rates and velocities, each with its interval.
Source: docs/resting.md, "On the vibrating plate"; the bowl tests of the thesis (MDBT).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from scipy.special import gammaincinv  # half a quantile of chi-square; scipy.stats takes a third of a second

from feederscrew.arrivals import launch_conditions
from feederscrew.arrivals.ensemble import NORMAL_95, Aim, wilson
from feederscrew.arrivals.kernel import falling
from feederscrew.arrivals.kernel import ride as shaken
from feederscrew.arrivals.kernel.falling import Steps
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.arrivals.kernel.one_drop import UNSETTLED
from feederscrew.arrivals.launch_conditions import Launch, Starts, sample
from feederscrew.arrivals.pool import in_batches
from feederscrew.arrivals.rounded_hull import Shape, shape_of_part
from feederscrew.base import check
from feederscrew.base.arrays import Array, Bools, Floats, Ints
from feederscrew.base.errors import ArgumentError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import on_disk
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import USUAL_RUN, RunSettings
from feederscrew.bowl.record import Bowl
from feederscrew.motion import conveying as answer
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, require_ground

# Of a period, at least: eight times as many change a flat part's velocity by 2 % at most.
STEPS_A_PERIOD = 200
# ... of steps on the floor: ``floor.step`` does not limit them where those in the air are longer. With 200,
# faces of 1,200 each of brackets, caps, bolts, keys and nuts at 70 and 100 Hz are no nearer to those of fine
# steps, and take up to a quarter longer.
CONTACTS_A_PERIOD = 100
PLATE_STEP_REFINEMENT = 2.0  # than the steps of a drop
# [1] of what presses a part: what a sweep of impulses may still change where shares alone are wanted. Shares
# of 1,200 each of seven kinds at two drives differ from those by 1e-6 by 0.011 at most, of nuts that roll.
SHARES_CONVERGED = 1e-3
SLOW_CONTACT_SHARE = 0.1  # of the plate's greatest speed upwards: slower contacts do not rebound
PARTS_A_BATCH = 40  # parts a core takes at a time
DEFAULT_PLATE_PARTS = 400  # parts, where the user names no number
PARTS_A_LOOK = 400  # parts between two looks at the intervals
MAX_PLATE_STEPS = 20_000_000  # for one part: a minute of computing; 10 mm for ten minutes take 4,000,000
# looks at a part, one a period or one in so many
MIN_LOOKS = 8
MAX_LOOKS = 600
RATE_DRAWS = 400  # of the rates, for the interval of where they lead
MISSED_TRANSITIONS = 0.5  # transition out of each class that may have been missed, shared by the ways out
MIN_TRANSITIONS = 5  # transitions: with fewer nothing is said of where they lead
BALANCE_DOUBLINGS = 48  # of the time to which the balance of the rates is followed
MIN_SHARE_CHANGE = 0.005  # smallest change of a share that is called one
SURE_ERRORS = 3.0  # standard errors by which it must stand out
DERIVED_FIELDS = ("plate_low", "plate_high", "rates", "rates_low", "rates_high")  # from other fields
SHARE_SUM_ROUNDING = 1e-9  # [1] by which shares may add up to more than 1


@dataclass(frozen=True, eq=False)
class Rides:
    """Faces on which each of N parts lay, at each of K looks."""

    faces: Ints  # (N, K) face it lies on, UNSETTLED while it may be tipping over
    places: Floats  # (N, K, 2) of its centre of mass, in units of L
    lost: int  # further parts, left out: their motion took far more steps than it should
    partial: bool  # stopped by the user before all were done


@dataclass(frozen=True)
class PlatePace:
    """Steps and times by which a part is followed before it counts, and the number of parts."""

    seconds: float = 5.0  # [s] each part is followed once it counts
    coarse: float = 1.0  # [1] by how much steps are longer than those that velocities need
    flight: float = 1.0  # [1] ... by how much those in the air, which end where the part meets the floor
    settling: float = 30.0  # [sqrt(L / g)] before the count begins: the launch has died away
    kick: float = np.inf  # [1] times the floor's own energy: a part that this does not tip stays
    width: float | None = None  # [1] of the widest 95 % interval to either side: then enough parts are known
    keep: bool = False  # the rides themselves, for a run of more parts
    done: Rides | None = None  # those of the first parts, where they were kept
    scatters: bool = False  # one value of restitution as that of single impacts, where parts are thrown up


EXACT_PACE = PlatePace(scatters=True)


@dataclass(frozen=True, eq=False)
class Occupancy:
    """Aspects of N parts on a plate; A classes. Intervals are of 95 %, over the parts."""

    start: Floats  # (A,) [1] share of the parts by what they lay on at the first look that shows it
    plate: Floats  # (A,) [1] share of the time, in the second half
    plate_low: Floats  # (A,) [1]
    plate_high: Floats
    error: Floats  # (A,) [1] standard error of that share, from part to part
    limit: Floats  # (A,) [1] share to which the rates lead in the end; NaN where too little was seen
    limit_low: Floats  # (A,) [1]
    limit_high: Floats
    changing: Bools  # (A,) bool: the share still changed from the third quarter to the last
    counts: Ints  # (A, A) int, from row to column; the diagonal, onto an equal face
    times: Floats  # (A,) [s] spent in each class, of all parts together
    rates: Floats  # (A, A) [1/s]; NaN where no time was spent
    rates_low: Floats  # (A, A) [1/s]
    rates_high: Floats
    velocity: Floats  # (3,) [m/s] mean along the drive, over all; low, high
    velocities: Floats  # (A, 3) [m/s] while in a class; NaN where nothing was seen, ends NaN of one part
    course: Floats  # (K, A) [1] share of the parts at each look


@dataclass(frozen=True, eq=False)
class PlateResult(ReadableRecord):
    """Outcome of the parts on one plate."""

    bowl: Bowl
    launch: dict  # name and ranges sampled, in the units of the shop
    throw_number: float  # [1]
    parts: int
    seconds: float  # [s] counted for each part
    occupancy: Occupancy
    lost: int  # parts left out: their motion took far more steps than it should
    partial: bool  # stopped by the user before all parts were done
    rides: Rides | None = None  # of each part, where they are kept

    @property
    def transitions(self) -> int:
        """Return how many were seen between classes."""
        counts = self.occupancy.counts
        return int(counts.sum() - np.trace(counts))

    @property
    def unsettled(self) -> int:
        """Return how many parts have not lain on any face yet."""
        return round(self.parts * (1.0 - float(self.occupancy.course[-1].sum())))


def test(
    part: Part,
    aspects: Aspects,
    bowls: Sequence[Bowl],
    preset: str,
    own: Mapping[str, str | None],
    *,
    drops: int | None = None,
    pace: PlatePace = EXACT_PACE,
    run: RunSettings = USUAL_RUN,
) -> list[PlateResult]:
    """Put parts on a vibrating plate, one at a time, and follow what they lie on; one result a bowl.

    Of each bowl the drive, the restitution and the kinetic friction are used.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    bowls : sequence of Bowl
    preset : str
        A key of ``launch_conditions.PRESETS``.
    own : mapping of str to str or None
        Ranges that replace the preset's, and the bowl's restitution and friction.
    drops : int, optional
        Parts on each plate, with the same launches on all; None takes ``DEFAULT_PLATE_PARTS``.
    pace : PlatePace
        How long each is followed, and how finely.
    run : RunSettings
        Its progress is called after every batch with the parts done, on all plates together, and how many
        there will be.

    Returns
    -------
    list of PlateResult
        After an interrupt from the keyboard fewer than bowls, the last of them partial.

    Raises
    ------
    FeederError
        If the part has no shape, or an option is no such quantity or out of range.
    KeyboardInterrupt
        If nothing was finished.
    """
    faces = require_ground(part, aspects)
    shape, length = shape_of_part(part, faces)
    count, classes = DEFAULT_PLATE_PARTS if drops is None else drops, len(aspects.names)
    launches = [launch_on(bowl, preset, length, own, pace) for bowl in bowls]
    run.begin()
    results: list[PlateResult] = []
    for k, (bowl, launch) in enumerate(zip(bowls, launches)):
        floor, unit = floor_of(bowl, length, pace.flight), np.sqrt(length / bowl.gravity)
        # looks are whole periods of the drive apart, so that the plate stands alike
        frequency = bowl.drive.frequency
        period = max(int(np.ceil(pace.seconds * frequency / MAX_LOOKS)), 1) / frequency
        number = max(round(pace.seconds / period), MIN_LOOKS)
        looks = (np.ceil(pace.settling * unit / period) + np.arange(number + 1)) * period / unit
        steps = steps_of(floor, pace.coarse)
        needed = looks[-1] / min(steps.contact, floor.step)
        if needed > MAX_PLATE_STEPS:
            what = f"a part so small takes {needed:.2g} steps at this drive for so long"
            raise ArgumentError("seconds", what, "follow it for less, or check the part's unit")
        starts = sample(launch, shape, count, np.random.default_rng(run.seed))
        # the kick is so many times the energy of a point at the floor's quickest motion
        first, second = math.hypot(floor.along, floor.up), math.hypot(floor.second_along, floor.second_up)
        kick = pace.kick * 0.5 * (floor.rate * (first + 2.0 * second)) ** 2
        follow = partial(ride, shape, floor, looks=looks, steps=steps, kick=kick, jobs=run.jobs)
        aim = Aim(pace.width or 0.0, faces.rows, classes)
        try:
            rides = _follow_enough(follow, starts, pace, aim, run.progress, k * count, len(bowls) * count)
        except KeyboardInterrupt:
            if not results:
                raise
            results[-1] = replace(results[-1], partial=True)
            break
        rng = np.random.default_rng((run.seed, len(rides.faces)))
        outcome = occupancy(rides.faces, length * rides.places[:, :, 0], faces.rows, classes, period, rng)
        result = result_of(bowl, launch, length, outcome, len(rides.faces), rides.lost, number * period)
        results.append(replace(result, partial=rides.partial, rides=rides if pace.keep else None))
        if rides.partial:
            break
    return results


def launch_on(
    bowl: Bowl, preset: str, length: float, own: Mapping[str, str | None], pace: PlatePace
) -> Launch:
    """Return a launch with the bowl's restitution and friction where the user gave none.

    Parameters
    ----------
    bowl : Bowl
    preset : str
        A key of ``launch_conditions.PRESETS``.
    length : float [m]
        Of the part: cube root of its hull's volume.
    own : mapping of str to str or None
        The user's ranges.
    pace : PlatePace

    Returns
    -------
    Launch
    """
    launch = launch_conditions.launch_of(preset, length, own, bowl.gravity)
    surface = {"restitution": bowl.restitution, "friction": bowl.friction.kinetic}
    ranges: Any = {key: (value, value) for key, value in surface.items() if own.get(key) is None}
    launch, restitution = replace(launch, **ranges), own.get("restitution")
    single = restitution is None or launch_conditions.single(restitution) is not None
    return launch.scattering() if pace.scatters and single and throw_number(bowl) > 1.0 else launch


def _follow_enough(
    follow: Callable[..., Rides],
    starts: Starts,
    pace: PlatePace,
    aim: Aim,
    progress: Callable[[int, int], None] | None,
    before: int,
    total: int,
) -> Rides:
    """Return the rides of all parts or, with a width, of as many as make no share's interval wider."""
    count, done = len(starts.energies), [] if pace.done is None else [pace.done]
    size = count if pace.width is None else PARTS_A_LOOK
    first = sum(len(rides.faces) + rides.lost for rides in done)

    def tell(parts: int) -> None:
        if progress:
            progress(before + first + parts, total)

    while first < count:
        if pace.width and done:
            last = np.concatenate([lasting(rides.faces)[:, -1] for rides in done])
            if aim.widest(last) <= pace.width:
                break
        try:
            done.append(follow(starts.some(slice(first, first + size)), progress=tell))
        except KeyboardInterrupt:
            if not done:
                raise
            done[-1] = replace(done[-1], partial=True)
            break
        if done[-1].partial:
            break
        first += size
    return Rides(
        faces=check.frozen(np.concatenate([own.faces for own in done])),
        places=check.frozen(np.concatenate([own.places for own in done])),
        lost=sum(own.lost for own in done),
        partial=any(own.partial for own in done),
    )


def result_of(
    bowl: Bowl, launch: Launch, length: float, occupancy: Occupancy, parts: int, lost: int, seconds: float
) -> PlateResult:
    """Return what parts did on one plate in a run that was not stopped.

    Parameters
    ----------
    bowl : Bowl
    launch : Launch
    length : float [m]
        Of the part: cube root of its hull's volume.
    occupancy : Occupancy
    parts : int
    lost : int
        Further parts, left out.
    seconds : float [s]
        Counted for each.

    Returns
    -------
    PlateResult
    """
    launched, number = launch_conditions.described(launch, length, bowl.gravity), throw_number(bowl)
    return PlateResult(bowl, launched, number, parts, seconds, occupancy, lost, partial=False)


def ride(
    shape: Shape,
    floor: Floor,
    starts: Starts,
    looks: Floats,
    steps: Steps,
    *,
    kick: float = math.inf,
    jobs: int = 1,
    progress: Callable[[int], None] | None = None,
) -> Rides:
    """Follow parts on a plate from their starts relative to it.

    The outcome does not depend on ``jobs``. After an interrupt from the keyboard come the batches that were
    finished, up to the first that was not: a run of so many parts gives the same.

    Parameters
    ----------
    shape : Shape
    floor : Floor
    starts : Starts
    looks : (K,) float [sqrt(L/g)]
        Times, ascending.
    steps : Steps
    kick : float [m g L]
        Energy that the floor gives a part at most: one whose face it does not tip it off is followed no
        further. Infinite, all parts are followed to the end.
    jobs : int
        Threads.
    progress : callable, optional
        Called after every batch with how many parts are done.

    Returns
    -------
    Rides

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.

    References
    ----------
    docs/resting.md, "On the vibrating plate".
    """

    def batch(part: slice) -> tuple[Array, ...]:
        launched = starts.launched(part)
        record = shaken.empty_looks(len(launched.states), looks)
        shaken.ride_all(shape, falling.scratch(shape), floor, launched, steps, record, kick)
        return record.faces, record.places, record.taken == len(looks)

    batch(slice(0, 0))  # compiled here, if need be
    columns, stopped = in_batches(batch, len(starts.energies), PARTS_A_BATCH, jobs, progress)
    faces, places, whole = columns
    return Rides(check.frozen(faces[whole]), check.frozen(places[whole]), int((~whole).sum()), stopped)


def compiled() -> bool:
    """Return whether the kernel of the plate is on disk already."""
    return on_disk(shaken.ride_all)


def floor_of(bowl: Bowl, length: float, flight: float = 1.0) -> Floor:
    """Return the plate that moves as the bowl's floor does; level, its x axis along the drive.

    Parameters
    ----------
    bowl : Bowl
    length : float [m]
        Of the part: cube root of its hull's volume, the unit L.
    flight : float [1]
        By how much the longest steps are longer than those that velocities need.

    Returns
    -------
    Floor
        Lengths in L, rates in sqrt(g / L).
    """
    drive, time = bowl.drive, math.sqrt(length / bowl.gravity)
    rate = 2.0 * math.pi * drive.frequency * time
    second_angle = drive.vibration_angle + drive.second_harmonic_turn
    second = drive.amplitude * drive.second_harmonic / length
    return Floor(
        rate=rate,
        along=drive.amplitude * math.cos(drive.vibration_angle) / length,
        up=drive.amplitude * math.sin(drive.vibration_angle) / length,
        lead=-drive.phase,
        second_along=second * math.cos(second_angle),
        second_up=second * math.sin(second_angle),
        second_phase=drive.second_harmonic_phase,
        step=flight * 2.0 * math.pi / rate / STEPS_A_PERIOD,
    )


def steps_of(floor: Floor, coarse: float = 1.0) -> Steps:
    """Return steps for a plate: finer than a drop's unless coarse, and rebounds as slow as its own.

    Parameters
    ----------
    floor : Floor
    coarse : float [1]
        By how much steps are longer than those that velocities need.

    Returns
    -------
    Steps
    """
    usual, once = Steps(), min(coarse, PLATE_STEP_REFINEMENT)
    contact = min(usual.contact / PLATE_STEP_REFINEMENT**2, 2.0 * math.pi / floor.rate / CONTACTS_A_PERIOD)
    slow = SLOW_CONTACT_SHARE * (floor.up + 2.0 * floor.second_up) * floor.rate
    return usual._replace(
        flight=coarse * usual.flight / PLATE_STEP_REFINEMENT,
        contact=coarse * contact,
        swing=once * usual.swing / PLATE_STEP_REFINEMENT,
        tolerance=once * usual.tolerance / PLATE_STEP_REFINEMENT,
        threshold=min(usual.threshold, max(slow, 1e-4)),
        converged=SHARES_CONVERGED if coarse > 1.0 else usual.converged,
    )


def throw_number(bowl: Bowl) -> float:
    """Return the level floor's greatest downward acceleration over gravity, as of a track.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [1]

    References
    ----------
    The normal force of eq. [4.14] at the upper reversal; docs/conveying.md, "The model".
    """
    if bowl.drive.amplitude == 0.0:
        return 0.0
    return float(answer.throw_number(replace(bowl, track=replace(bowl.track, climb=0.0, bank=0.0))))


def occupancy(
    faces: Ints,
    places: Floats,
    rows: Ints,
    count: int,
    period: float,
    rng: np.random.Generator,
) -> Occupancy:
    """Return shares, rates and velocities of N parts at K looks.

    A rate is the number of transitions over the time spent; its interval is that of a Poisson count. The
    interval of a share of time is Wilson's for so many parts, which is too wide where a part changes often:
    ``error`` knows of that. ``limit`` is the mean over ``RATE_DRAWS`` of all rates, each from a Gamma
    distribution of its count (with ``MISSED_TRANSITIONS``) and time, of where they lead from the last look
    on; a class in which no time was spent is left out, as nothing is known of how it is left.

    Parameters
    ----------
    faces : (N, K) int
        Face each part lies on at each look, ``UNSETTLED`` where that is open: such a part still counts for
        the face it lay on before.
    places : (N, K) float [m]
        How far it has come along the drive.
    rows : (F,) int
        Class of each face.
    count : int
        Classes, A.
    period : float [s]
        Between two looks.
    rng : Generator
        For ``limit`` and its interval.

    Returns
    -------
    Occupancy

    References
    ----------
    F. Garwood, "Fiducial limits for the Poisson distribution", Biometrika 28, 437-442, 1936; docs/resting.md,
    "On the vibrating plate".
    """
    held = lasting(faces)
    classes = np.where(held == UNSETTLED, count, np.asarray(rows)[held])  # one more for parts not yet down
    inside = classes[:, :, None] == np.arange(count)
    looks = inside.shape[1]
    # The class each lay on first; transitions from row to column.
    first = classes[np.arange(len(classes)), np.argmax(classes < count, axis=1)]
    before, after = classes[:, :-1], classes[:, 1:]
    moved = (held[:, 1:] != held[:, :-1]) & (before < count)
    counts, times = np.zeros((count, count), int), period * inside[:, :-1].sum(axis=(0, 1))
    np.add.at(counts, (before[moved], after[moved]), 1)
    each = inside[:, looks // 2 :].mean(axis=1)
    half = each.mean(axis=0)
    low, high = wilson(half * len(held), len(held))
    # Where the rates lead, and the ends of its interval.
    limit, ends = np.full(count, np.nan), np.full((2, count), np.nan)
    if counts.sum() - np.trace(counts) >= MIN_TRANSITIONS:
        spent = times > 0.0
        shape = (counts + MISSED_TRANSITIONS / max(spent.sum() - 1, 1))[np.ix_(spent, spent)]
        rates = rng.gamma(shape, size=(RATE_DRAWS, *shape.shape)) / times[spent, None]
        drawn = np.full((RATE_DRAWS, count), np.nan)
        drawn[:, spent] = limit_of(rates, inside[:, -1].mean(axis=0)[spent])
        limit, ends = drawn.mean(axis=0), np.percentile(drawn, (2.5, 97.5), axis=0)
    # Whether a share changed from the third quarter to the last by more than chance.
    third, last = (inside[:, k * looks // 4 : (k + 1) * looks // 4] for k in (2, 3))
    change = last.mean(axis=1) - third.mean(axis=1)
    error = change.std(axis=0) / np.sqrt(len(change))
    # Mean velocity over the second half, and while in each class.
    middle = places.shape[1] // 2
    whole = (places[:, -1] - places[:, middle]) / (period * (places.shape[1] - 1 - middle))
    within = inside[:, middle:-1]
    distances = np.einsum("nk,nka->na", np.diff(places[:, middle:], axis=1), within)
    arrays = {
        "start": np.bincount(first, minlength=count + 1)[:count] / len(classes),
        "plate": half,
        "plate_low": low,
        "plate_high": high,
        "error": each.std(axis=0) / np.sqrt(len(each)),
        "limit": limit,
        "limit_low": ends[0],
        "limit_high": ends[1],
        "changing": np.abs(change.mean(axis=0)) > np.maximum(SURE_ERRORS * error, MIN_SHARE_CHANGE),
        "counts": counts,
        "times": times,
        "course": inside.mean(axis=0),
        **_rates(counts, times),
        "velocity": _ratio(whole[:, None], np.ones((len(whole), 1)))[0],
        "velocities": _ratio(distances, period * within.sum(axis=1)),
    }
    return Occupancy(**{name: check.frozen(np.asarray(value)) for name, value in arrays.items()})


def lasting(faces: Ints) -> Ints:
    """Return the face that each part lies on or lay on last.

    Parameters
    ----------
    faces : (N, K) int
        Of N parts at K times, UNSETTLED between faces.

    Returns
    -------
    (N, K) int [index]
        UNSETTLED before the first.

    References
    ----------
    docs/resting.md, "On the vibrating plate".
    """
    at = np.where(faces == UNSETTLED, 0, np.arange(faces.shape[1]))
    return np.take_along_axis(faces, np.maximum.accumulate(at, axis=1), axis=1)


def _rates(counts: Ints, times: Floats) -> dict[str, Floats]:
    """Return the rates (A, A) [1/s] of transitions, counts over times, and both ends of their intervals.

    The ends are those of a Poisson count (Garwood 1936): quantiles of chi-square with 2 n and 2 n + 2
    degrees.
    """
    spent = np.where(times > 0.0, times, np.nan)[:, None]
    with np.errstate(invalid="ignore"):
        low = np.where(counts > 0, gammaincinv(np.maximum(counts, 1), 0.025), 0.0)
    high = gammaincinv(counts + 1, 0.975)
    return {"rates": counts / spent, "rates_low": low / spent, "rates_high": high / spent}


def limit_of(rates: Floats, start: Floats) -> Floats:
    """Return the shares to which transitions lead in the end.

    The step I + Q / (2 q), Q the matrix of the rates and q the quickest way out, is squared
    ``BALANCE_DOUBLINGS`` times.

    Parameters
    ----------
    rates : (..., A, A) float [1/s]
        From row to column; the diagonal does not matter.
    start : (..., A) float [1]

    Returns
    -------
    (..., A) float [1]
        ``start`` where there is no transition.

    References
    ----------
    The stationary distribution of a Markov chain.
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


def _ratio(distances: Floats, times: Floats) -> Floats:
    """Return (A, 3) sum of (N, A) ways over sum of (N, A) times, and its interval over the parts: NaN of one.

    The interval is that of a ratio estimate, whose error is that of way less mean times time.
    """
    total = np.where(times.sum(axis=0) > 0.0, times.sum(axis=0), np.nan)
    mean = distances.sum(axis=0) / total
    parts = (times > 0.0).sum(axis=0)
    wider = np.sqrt(parts / np.where(parts > 1, parts - 1.0, np.nan))  # as the mean is of the same parts
    error = NORMAL_95 * wider * np.sqrt(((distances - mean * times) ** 2).sum(axis=0)) / total
    return np.stack([mean, mean - error, mean + error], axis=-1)


def occupancy_from(arrays: Mapping[str, Array], count: int, parts: int) -> Occupancy:
    """Return an Occupancy of some classes and parts from plain arrays, if every number can be one of it.

    Intervals and rates, the ``DERIVED_FIELDS``, follow from the other numbers, and are computed again.

    Parameters
    ----------
    arrays : mapping of str to array
    count : int
        Classes.
    parts : int

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

    def read(name: str, *bounds: Any, **kind: Any) -> Any:
        return check.ranged(name, arrays[name], *bounds, **kind)

    row, square = (count,), (count, count)
    start, plate = read("start", row, 0.0, 1.0), read("plate", row, 0.0, 1.0)
    counts, times = read("counts", square, 0, np.inf, whole=True), read("times", row, 0.0)
    course, changing = read("course", (-1, count), 0.0, 1.0), arrays["changing"]
    if changing.shape != row or changing.dtype.kind != "b":
        raise ValueError("changing is not one answer a class")
    most = 1.0 + SHARE_SUM_ROUNDING
    if len(course) < 1 or any((shares.sum(axis=-1) > most).any() for shares in (start, plate, course)):
        raise ValueError("shares add up to more than 1, or there are none")
    low, high = wilson(plate * parts, parts)
    fields = {
        "start": start,
        "plate": plate,
        "plate_low": low,
        "plate_high": high,
        "error": read("error", row, 0.0, 1.0),
        **{name: read(name, row, 0.0, most, gaps=True) for name in ("limit", "limit_low", "limit_high")},
        "changing": changing,
        "counts": counts,
        "times": times,
        "course": course,
        **_rates(counts, times),
        "velocity": read("velocity", (3,), gaps=True),
        "velocities": read("velocities", (count, 3), gaps=True),
    }
    return Occupancy(**{name: check.frozen(np.asarray(value)) for name, value in fields.items()})
