"""From a bowl to its conveying velocity and back: SI units on both sides of the unitless kernel.

With it maps of many settings, compiled and on every core; what becomes of an answer when the bowl is not
quite what the file says; points at other radii; and the best elliptical phase.
"""

import functools
import inspect
import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, cast, overload

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Reals
from feederscrew.base.columns import Column
from feederscrew.base.errors import ConfigError
from feederscrew.base.geometry.compiled import compiled, entry, on_disk, outlined
from feederscrew.base.records import ReadableRecord
from feederscrew.base.units import MM_S
from feederscrew.bowl.record import Bowl, BowlGrid, Friction, Number, Sizing
from feederscrew.motion import limits, operating_point, point_motion, steady, waves
from feederscrew.motion.limits import Regime
from feederscrew.motion.operating_point import PHASES, OperatingPoint
from feederscrew.motion.steady import MotionStatus

LEAST_ACCELERATION_RATIO = 1e-9  # [1] least acceleration ratio computed with: a bowl at rest carries nothing
SWEEP_REGIMES = tuple(Regime)  # a regime code of a map is a place in this list
COEXISTING_VELOCITY_GAP = 0.01  # [A w] velocities this far apart are several
COMPILED_FROM = 8  # settings one by one in a process, as a design asks for them: then the kernel is loaded
SETTINGS_A_LOT = 256  # settings handed to a core at a time: their costs differ a hundredfold
SENSITIVITY_CHANGE = 0.1  # of stroke, friction and angle, each by itself
FRICTION_DOUBT = 0.2  # what a coefficient of friction is seldom known better than
RESTITUTION_DOUBT = 0.16
"""[1] Relative standard deviation of the restitution of single impacts of one body on one surface. 1,718
filmed impacts have the quartiles 0.53, 0.60, 0.66, and half of that width is 0.67 standard deviations."""
MAX_RESTITUTION = 0.99  # [1] restitution: at 1 a part never comes to rest on the track
SENSITIVE_QUANTITIES = ("amplitude", "friction", "angle")
INNER_RADIUS_SHARE = 0.5  # of the track's radius, where the curve starts
RADIUS_STEPS = 26
PHASE_STEP_RAD = np.radians(2.0)  # between the phases tried
FINE_PHASES = 20  # phases to each side of the best one, within a step
NEAR_BEST_SHARE = 0.9  # of the best velocity
FRICTION_FACTORS = (0.5, 0.8, 1.0, 1.2, 1.5)  # of the bowl's coefficients


class UnsteadyMotion(StrEnum):
    """Why a part has no steady velocity."""

    SLIDES_DOWN = "slides down"  # the track is steeper than friction holds
    KEEPS_SPEED = "keeps its speed"  # on the level nothing acts along the track: there is no friction


@dataclass(frozen=True, eq=False)
class Answer(ReadableRecord, view="record_lines.ANSWER_VIEW"):
    """Motion of a part at one operating point."""

    setting: OperatingPoint
    speed: float  # [m/s] A w, of the first harmonic
    status: MotionStatus
    period: int  # of the motion, in periods of the drive; 0 where there is none
    velocity: float  # [m/s] up the track, from rest; NaN where there is no steady state
    low: float  # [m/s] least over the starts
    high: float  # [m/s]
    slowest: float  # [m/s] in one period of the drive, out of those after which the motion repeats
    fastest: float  # [m/s] the same; where nothing repeats, out of those followed
    fractions: dict[str, float]  # of the time, by phase
    longest_flight: float  # [periods]
    hardest_impact: float  # [m/s] along the normal
    flights: float  # a period of the drive
    throw_number: float
    mu_forward: float  # least static friction of the floor without slip up the track; NaN past the hop
    mu_backward: float
    margins: dict[str, float]  # static friction above each limit of slip, throw number below the hop [1]
    regime: Regime
    runs_away: bool  # a part that once slides down the track fast enough does not stop again

    @property
    def unsteady(self) -> UnsteadyMotion | None:
        """Return why there is no steady velocity; None where there is one."""
        if self.status is not MotionStatus.NO_STEADY_STATE:
            return None
        keeps = steady.keeps_speed(operating_point.law(self.setting))
        return UnsteadyMotion.KEEPS_SPEED if keeps else UnsteadyMotion.SLIDES_DOWN


ANSWER_COLUMNS: tuple[Column[Answer], ...] = (
    Column("status", lambda answer: answer.status),
    Column("period", lambda answer: answer.period),
    Column("velocity_mm_s", lambda answer: answer.velocity, "mm/s"),
    Column("velocity_low_mm_s", lambda answer: answer.low, "mm/s"),
    Column("velocity_high_mm_s", lambda answer: answer.high, "mm/s"),
    Column("velocity_slowest_period_mm_s", lambda answer: answer.slowest, "mm/s"),
    Column("velocity_fastest_period_mm_s", lambda answer: answer.fastest, "mm/s"),
    Column("regime", lambda answer: answer.regime),
    Column("runs_away", lambda answer: answer.runs_away),
    Column("unsteady", lambda answer: answer.unsteady),
    Column("acceleration_ratio", lambda answer: answer.setting.ratio),
    Column("throw_number", lambda answer: answer.throw_number),
    Column("mu_effective", lambda answer: answer.setting.static),
    Column("mu_effective_kinetic", lambda answer: answer.setting.kinetic),
    Column("mu_forward", lambda answer: answer.mu_forward),
    Column("mu_backward", lambda answer: answer.mu_backward),
    Column("margins", lambda answer: answer.margins),
    Column("fractions", lambda answer: answer.fractions),
    Column("longest_flight_periods", lambda answer: answer.longest_flight),
    Column("hardest_impact_mm_s", lambda answer: answer.hardest_impact, "mm/s"),
    Column("flights_per_period", lambda answer: answer.flights),
)


def answer(bowl: Bowl) -> Answer:
    """Return how a part travels in a bowl, without compiling anything; the same bits if compiled before.

    Parameters
    ----------
    bowl : Bowl
        Single values.

    Returns
    -------
    Answer

    Raises
    ------
    ConfigError
        If nothing moves, or the drive does not point along the track.
    """
    conveying(bowl)
    setting = OperatingPoint(*settings(bowl).tolist())
    out = _surveyed(setting)
    speed, mu, throw = float(greatest_speed(bowl)), bowl.friction, float(out[steady.THROW])
    forward, backward = (
        float(limits.of_floor(limit, mu.wall, bowl.track.bank)) for limit in limits_of_slip(setting)
    )
    velocities = {
        "velocity": steady.VELOCITY,
        "low": steady.LOW,
        "high": steady.HIGH,
        "slowest": steady.SLOWEST,
        "fastest": steady.FASTEST,
        "hardest_impact": steady.IMPACT,
    }
    status = int(out[steady.STATUS])
    return Answer(
        setting=setting,
        speed=speed,
        status=steady.STATUSES[status],
        period=int(out[steady.PERIOD]),
        **{name: float(out[place]) * speed for name, place in velocities.items()},
        fractions={name: float(out[steady.FRACTIONS + k]) for k, name in enumerate(PHASES)},
        longest_flight=float(out[steady.FLIGHT_TIME]),
        flights=float(out[steady.HOPS]),
        throw_number=throw,
        mu_forward=forward,
        mu_backward=backward,
        margins={"forward": mu.static - forward, "backward": mu.backward[0] - backward, "hop": 1.0 - throw},
        regime=SWEEP_REGIMES[-1 if status == steady.NO_STEADY_STATE else int(out[steady.REGIME])],
        runs_away=bool(out[steady.RUNAWAY]),
    )


@functools.lru_cache(maxsize=64)  # a drive is asked for its velocity, its hop and its hardest landing
def _surveyed(setting: OperatingPoint) -> Floats:
    is_loaded = _loaded_loop.cache_info().currsize > 0
    if is_loaded or (_surveyed.cache_info().misses > COMPILED_FROM and sweep_compiled()):
        return check.frozen(sweep(np.array([setting]))[0])
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out, steady.memory())
    return check.frozen(out)


def conveying(bowl: Bowl[Number]) -> Bowl[Number]:
    """Return the bowl itself if it can convey.

    Parameters
    ----------
    bowl : Bowl
        Its fields may be arrays.

    Returns
    -------
    Bowl

    Raises
    ------
    ConfigError
        If gravity is not above 0, the drive does not point along the track, nothing moves, or kinetic
        friction is above static friction.
    """
    if not np.all(bowl.gravity > 0.0):
        raise ConfigError("gravity", "is not above 0", "give m/s2, 9.81 on earth")
    if np.any(bowl.drive.direction != 0.0):
        what = "is not 0 deg, but a track can only convey along itself"
        raise ConfigError("drive.direction", what, "leave it out: it is for the floor (feeder floor)")
    if np.size(bowl.drive.amplitude) and np.max(bowl.drive.amplitude) <= 0.0:
        raise ConfigError("drive.amplitude", "is 0 mm, so nothing moves", "give more than 0 mm")
    pairs = zip(("", "_backward"), ((bowl.friction.static, bowl.friction.kinetic), bowl.friction.backward))
    for suffix, (static, kinetic) in pairs:
        if np.any(np.greater(kinetic, static)):
            what, mend = f"is above friction.static{suffix}", f"lower it or raise friction.static{suffix}"
            raise ConfigError(f"friction.kinetic{suffix}", what, mend)
    return bowl


def settings(bowl: BowlGrid) -> Floats:
    """Return the ``OperatingPoint`` of a bowl, its fields along the last axis.

    The bank is reckoned as friction (``limits.level``). A bowl at rest gets the acceleration ratio
    ``LEAST_ACCELERATION_RATIO``.

    Parameters
    ----------
    bowl : BowlGrid
        Its fields may be arrays that broadcast together.

    Returns
    -------
    (..., 12) float [1 and rad]

    References
    ----------
    docs/conveying.md, "The model".
    """
    here = limits.level(bowl)
    drive, friction = here.drive, here.friction
    ratio = limits.acceleration_ratio(drive.amplitude, drive.frequency, bowl.gravity)
    rows = np.broadcast_arrays(  # in the order of ``OperatingPoint``
        np.maximum(ratio, LEAST_ACCELERATION_RATIO),
        drive.vibration_angle,
        here.track.climb,
        friction.static,
        friction.kinetic,
        *friction.backward,
        bowl.restitution,
        -np.asarray(drive.phase),
        drive.second_harmonic,
        drive.second_harmonic_phase,
        drive.second_harmonic_turn,
    )
    return np.stack(rows, axis=-1).astype(float)


def limits_of_slip(setting: OperatingPoint) -> tuple[float, float]:
    """Return the least static friction against slip up and down the track, whatever the setting's own.

    Under an elliptical drive pull and normal force are greatest at different phases. Then the ratio of both
    is taken where their difference is greatest, that ratio is the next guess, and so on until it does not
    change.

    Parameters
    ----------
    setting : OperatingPoint

    Returns
    -------
    up, down : float [1]
        Zero or less where the part slips on no surface; NaN past the hop, where it slips on every one.

    References
    ----------
    W. Dinkelbach, "On nonlinear fractional programming", Management Science 13(7), 492-498, 1967.
    """
    if setting.lead == 0.0 and setting.second == 0.0:
        where = (setting.ratio, setting.angle, 0.0, setting.climb)
        return float(limits.forward_limit(*where)), float(limits.backward_limit(*where))
    if operating_point.throw_number(operating_point.law(setting)) >= 1.0 - limits.HOP_ROUNDING:
        return math.nan, math.nan
    least, press = [], operating_point.lift_wave(setting)
    for direction in (1.0, -1.0):
        pull = operating_point.pull_wave(setting, direction, 0.0)
        mu = waves.height(pull, 0.0) / -waves.height(press, 0.0)
        for _ in range(50):
            angle = waves.crest(operating_point.pull_wave(setting, direction, mu))
            before, mu = mu, waves.height(pull, angle) / -waves.height(press, angle)
            if abs(mu - before) <= 1e-15 * abs(mu):
                break
        least.append(mu)
    return least[0], least[1]


def throw_number(bowl: Bowl) -> float:
    """Return the plate's greatest downward acceleration over gravity, along the normal.

    Parameters
    ----------
    bowl : Bowl
        Of one setting.

    Returns
    -------
    float [1]
    """
    return operating_point.throw_number(operating_point.law(OperatingPoint(*settings(bowl).tolist())))


def throw_of_flight(periods: float) -> float:
    """Return the throw number at which a part that does not rebound flies for a time.

        k = sqrt(1 + q^2),   q = (x^2 / 2 - 1 + cos x) / (x - sin x),   x = 2 pi times the periods

    Parameters
    ----------
    periods : float [periods]
        Of the flight, above 0.

    Returns
    -------
    float [1]
        sqrt(1 + pi^2) for one period.

    References
    ----------
    Sloot and Kruyt 1996, by the parabola between two impacts.
    """
    turn = 2.0 * math.pi * check.positive("periods", periods)
    return math.hypot(1.0, (0.5 * turn * turn - 1.0 + math.cos(turn)) / (turn - math.sin(turn)))


def greatest_speed(bowl: Bowl[Number]) -> Number:
    """Return the greatest speed of the plate: A w, of the first harmonic.

    Parameters
    ----------
    bowl : Bowl
        Its fields may be arrays.

    Returns
    -------
    float or array of float [m/s]

    References
    ----------
    The derivative of the motion A sin(w t).
    """
    amplitude: Any = bowl.drive.amplitude
    return cast("Number", amplitude * 2.0 * np.pi * bowl.drive.frequency)


def validity(run: Answer, bowl: Bowl) -> str:
    """Return a sentence that says what an answer leaves out.

    Parameters
    ----------
    run : Answer
    bowl : Bowl
        Of that answer.

    Returns
    -------
    str
    """
    remarks = "point mass: tipping and turning are left out"
    if run.throw_number > 1.0:
        remarks = "point mass: fairly good where the part slides, larger deviations where it is thrown"
        remarks += " (Sloot and Kruyt 1996)"
    most = greatest_speed(bowl) * (1.0 + 2.0 * bowl.drive.second_harmonic)
    share = most**2 / (bowl.track.radius * bowl.gravity)
    return f"{remarks}; the centripetal force, up to {100.0 * share:.2g} % of the weight, is left out"


def cells(bowl: BowlGrid) -> dict[str, Array]:
    """Return how a part travels over a map.

    Parameters
    ----------
    bowl : BowlGrid
        Its fields are arrays that broadcast together.

    Returns
    -------
    dict of str to array
        velocity, low and high [m/s] over the starts; several, whether these differ by more than
        ``COEXISTING_VELOCITY_GAP``; regime, a place in ``SWEEP_REGIMES``; throw_number [1]; status, a place
        in ``steady.STATUSES``.

    Raises
    ------
    ConfigError
        As ``answer``.
    """
    rows = settings(conveying(bowl))
    out = sweep(rows.reshape(-1, rows.shape[-1])).reshape(*rows.shape[:-1], steady.COLUMNS)
    status, speed = out[..., steady.STATUS].astype(int), np.asarray(greatest_speed(bowl))
    regime, last = out[..., steady.REGIME].astype(int), len(SWEEP_REGIMES) - 1
    return {
        "velocity": out[..., steady.VELOCITY] * speed,
        "low": out[..., steady.LOW] * speed,
        "high": out[..., steady.HIGH] * speed,
        "several": out[..., steady.HIGH] - out[..., steady.LOW] > COEXISTING_VELOCITY_GAP,
        "regime": np.where(status == steady.NO_STEADY_STATE, last, regime),
        "throw_number": np.where(speed > 0.0, out[..., steady.THROW], 0.0),  # a bowl at rest has none
        "status": status,
    }


def sweep(rows: Floats, workers: int | None = None) -> Floats:
    """Return the steady motion of many settings, compiled, as ``steady.survey`` fills it in for one.

    The first call on a machine compiles for some seconds and keeps the result on disk: ``sweep_compiled``.

    Parameters
    ----------
    rows : (N, 12) float [1 and rad]
        An ``OperatingPoint`` each.
    workers : int or None
        Threads; None takes as many as there are cores.

    Returns
    -------
    (N, 17) float [1, periods, A w]
        Columns of ``steady``.

    Raises
    ------
    ValueError
        If a shape is wrong, an entry is not finite, or a row is not a track.

    References
    ----------
    docs/conveying.md, "How it is computed".
    """
    rows = check.shaped("settings", rows, (-1, len(OperatingPoint._fields)))
    operating_point.checked(OperatingPoint(*rows.T))
    out, run = np.empty((len(rows), steady.COLUMNS)), _loaded_loop()
    if len(rows) <= SETTINGS_A_LOT:
        run(rows, out, steady.memory())
        return out
    lots = [slice(k, k + SETTINGS_A_LOT) for k in range(0, len(rows), SETTINGS_A_LOT)]
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        list(pool.map(lambda lot: run(rows[lot], out[lot], steady.memory()), lots))
    return out


def sweep_compiled() -> bool:
    """Tell whether the compiled functions are already on disk, or numba is set not to compile.

    Returns
    -------
    bool
    """
    return on_disk(_compiled_loop())


@functools.cache
def _compiled_loop() -> Callable[..., None]:
    """Return the loop over settings, compiled, with every function it reaches.

    The functions of a period are compiled into one piece; the others stay functions of their own, which keeps
    the compiled code small.
    """
    a_period = {
        *(waves.value, waves.after, waves.above, waves.onward, waves.reached, waves.gain),
        *(waves._beyond_sine, waves._beyond_cosine, operating_point.contact),
        *(function for _, function in inspect.getmembers(point_motion, inspect.isfunction)),
    } - {point_motion.turn, point_motion.at_rest}
    for module in (waves, operating_point, point_motion, steady):
        for _, function in inspect.getmembers(module, inspect.isfunction):
            if function.__module__ == module.__name__:
                (compiled if function in a_period else outlined)(function)
    return entry(_loop)


@functools.cache
def _loaded_loop() -> Callable[..., None]:
    """Return the same loop once it has run over no setting; once loaded it serves single settings too."""
    run = _compiled_loop()
    run(np.empty((0, len(OperatingPoint._fields))), np.empty((0, steady.COLUMNS)), steady.memory())
    return run


def _loop(rows: Floats, out: Floats, arrays: steady.Memory) -> None:
    for k in range(len(rows)):
        s = rows[k]
        drive = s[8], s[9], s[10], s[11]
        point = OperatingPoint(s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], *drive)
        steady.survey(point, out[k], arrays)


@overload
def scaled(
    bowl: Bowl[Number], *, amplitude: float = ..., friction: float = ..., angle: float = ...
) -> Bowl[Number]: ...
@overload
def scaled(
    bowl: BowlGrid, *, amplitude: Reals = ..., friction: Reals = ..., angle: Reals = ...
) -> BowlGrid: ...
def scaled(bowl: BowlGrid, *, amplitude: Reals = 1.0, friction: Reals = 1.0, angle: Reals = 1.0) -> BowlGrid:
    """Return the bowl with its stroke, every coefficient of friction or its vibration angle multiplied.

    Parameters
    ----------
    bowl : BowlGrid
    amplitude : float or (...) float [1]
        Factor of the stroke.
    friction : float or (...) float [1]
        Factor of every coefficient.
    angle : float or (...) float [1]
        Factor of the vibration angle, which stays at most a right angle.

    Returns
    -------
    BowlGrid
    """
    steep, mu = np.minimum(bowl.drive.vibration_angle * angle, np.pi / 2), bowl.friction
    drive = replace(bowl.drive, amplitude=bowl.drive.amplitude * amplitude, vibration_angle=steep)
    surfaces = Friction(*(value * friction for value in (mu.static, mu.kinetic, mu.wall, *mu.backward)))
    return replace(bowl, drive=drive, friction=surfaces)


@dataclass(frozen=True)
class Neighbours:
    """Velocities on both sides of an operating point."""

    less: float  # [m/s] NaN where there is no steady state
    more: float  # [m/s]

    def elasticity(self, velocity: float, change: float = SENSITIVITY_CHANGE) -> float:
        """Return per cent of velocity for one per cent of the quantity: (more - less) / (2 change velocity).

        Parameters
        ----------
        velocity : float [m/s]
            Between both.
        change : float [1], optional
            By which the quantity is lower and higher.

        Returns
        -------
        float [1]
            NaN where the part stands.
        """
        return (self.more - self.less) / (2.0 * change * velocity) if velocity else math.nan


NEIGHBOUR_COLUMNS: tuple[Column[Neighbours], ...] = (
    Column("velocity_less_mm_s", lambda pair: pair.less, "mm/s"),
    Column("velocity_more_mm_s", lambda pair: pair.more, "mm/s"),
)


def sensitivity(bowl: Bowl) -> dict[str, Neighbours]:
    """Return the velocities with a quantity a tenth lower and higher.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    dict of str to Neighbours
        Of 'amplitude', 'friction' (all of it) and 'angle'.
    """
    ends = 1.0 - SENSITIVITY_CHANGE, 1.0 + SENSITIVITY_CHANGE
    return {
        name: Neighbours(*(answer(scaled(bowl, **{name: factor})).velocity for factor in ends))
        for name in SENSITIVE_QUANTITIES
    }


def friction_doubt(bowl: Bowl) -> Neighbours:
    """Return the velocities for friction a fifth lower and higher.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Neighbours
    """
    return Neighbours(*(answer(there).velocity for there in surfaces(bowl, hops=False)[1:]))


def restitution_doubt(bowl: Bowl) -> Neighbours:
    """Return the velocities for both ends of the spread of restitution.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Neighbours
    """
    return Neighbours(*(answer(replace(bowl, restitution=end)).velocity for end in rebounds(bowl)))


def surfaces(bowl: Bowl[Number], hops: bool) -> list[Bowl[Number]]:
    """Return the bowl on the surfaces that may be there, its own first.

    They are the bowl as it is, with friction ``FRICTION_DOUBT`` [1] lower and higher, and with both ends of
    ``even_range``.

    Parameters
    ----------
    bowl : Bowl
        Fields may be arrays.
    hops : bool
        Parts may leave the track. Otherwise restitution decides nothing, and its two ends are left out.

    Returns
    -------
    list of Bowl

    References
    ----------
    docs/validation.md, "Restitution is a spread".
    """
    bowls = [bowl, *(scaled(bowl, friction=1.0 + sign * FRICTION_DOUBT) for sign in (-1.0, 1.0))]
    return bowls + (
        [replace(bowl, restitution=cast("Number", end)) for end in rebounds(bowl)] if hops else []
    )


def rebounds(bowl: BowlGrid) -> tuple[float, ...]:
    """Return both ends of the spread of a bowl's restitution.

    Parameters
    ----------
    bowl : BowlGrid
        Its restitution is one number; other fields may be arrays.

    Returns
    -------
    tuple of float [1]
        Not above ``MAX_RESTITUTION``.
    """
    return tuple(min(end, MAX_RESTITUTION) for end in even_range(float(bowl.restitution)))


def even_range(restitution: float) -> tuple[float, float]:
    """Return both ends of the even range round a restitution with ``RESTITUTION_DOUBT`` as deviation.

    The half width of a uniform range is sqrt(3) times its standard deviation. The range ends at 0 and 1.

    Parameters
    ----------
    restitution : float [1]

    Returns
    -------
    low, high : float [1]

    References
    ----------
    A uniform range has 1 / sqrt(12) of its width as its standard deviation.
    """
    half = min(math.sqrt(3.0) * RESTITUTION_DOUBT * restitution, 1.0 - restitution)
    return restitution - half, restitution + half


def inwards(bowl: Bowl) -> BowlGrid:
    """Return the bowl at radii from ``INNER_RADIUS_SHARE`` of the track's to its own, evenly spaced.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    BowlGrid
        Its fields are arrays over the radii.
    """
    return at_radius(bowl, bowl.track.radius * np.linspace(INNER_RADIUS_SHARE, 1.0, RADIUS_STEPS))


def at_radius(bowl: BowlGrid, radius: Reals) -> BowlGrid:
    """Return the bowl as a part feels it nearer to its axis.

    All points rise by the same amplitude and turn by the same angle. So the tangent of the angle to the
    horizontal, vibration angle plus climb, is inversely proportional to the radius.

    Parameters
    ----------
    bowl : BowlGrid
    radius : float or (...) float [m]

    Returns
    -------
    BowlGrid
        Its fields are arrays where the radius is one.

    Raises
    ------
    ConfigError
        If the drive is elliptical.

    References
    ----------
    A bowl that moves as a screw; docs/bowl.md, "How it is computed".
    """
    if np.any(bowl.drive.phase != 0.0):
        what = "is not 0 deg, an elliptical drive is not a screw motion to follow inwards"
        raise ConfigError("drive.phase", what, "leave out `curve`, or the phase")
    rise = np.sin(bowl.drive.vibration_angle + bowl.track.climb) * bowl.drive.amplitude
    turn = np.cos(bowl.drive.vibration_angle + bowl.track.climb) * bowl.drive.amplitude / bowl.track.radius
    reach = turn * radius
    angle = np.arctan2(rise, reach) - bowl.track.climb
    drive = replace(bowl.drive, amplitude=np.hypot(rise, reach), vibration_angle=angle)
    return replace(bowl, drive=drive, track=replace(bowl.track, radius=radius))


@dataclass(frozen=True, eq=False)
class BestPhase:
    """Velocities of one bowl over the phase of its drive."""

    phases: Floats  # (P,) [rad] tried, from -180 deg
    cells: dict[str, Array]  # (P,) what the part does there, as ``answer.cells`` names it
    phase: float  # [rad] by which the motion along the normal leads, where the part is fastest up the track
    velocity: float  # [m/s] there
    straight: float  # [m/s] of a straight drive, phase 0
    lowest: float  # [rad] of the phases round the best that give nearly its velocity
    highest: float  # [rad] which may lie beyond half a turn
    frictions: Floats  # (K,) [1] friction tried, over the bowl's
    best_over_friction: Floats  # (K,) [m/s] at the best phase
    straight_over_friction: Floats  # (K,) [m/s]


BEST_PHASE_COLUMNS: tuple[Column[BestPhase], ...] = (
    Column("phase_deg", lambda best: best.phase, "deg"),
    Column("velocity_mm_s", lambda best: best.velocity, "mm/s"),
    Column("straight_mm_s", lambda best: best.straight, "mm/s"),
    Column("gain", lambda best: best.velocity / best.straight if best.straight > 0.0 else np.nan),
    Column("nine_tenths_from_deg", lambda best: best.lowest, "deg"),
    Column("nine_tenths_to_deg", lambda best: best.highest, "deg"),
)
OVER_FRICTION_COLUMNS: tuple[Column[BestPhase], ...] = (  # a row a friction
    Column("friction", lambda best: best.frictions),
    Column("velocity_mm_s", lambda best: best.best_over_friction, "mm/s"),
    Column("straight_mm_s", lambda best: best.straight_over_friction, "mm/s"),
)


def best_phase(bowl: Bowl) -> BestPhase:
    """Find the phase of the drive at which a part travels fastest up the track.

    Parameters
    ----------
    bowl : Bowl
        Its own phase does not matter.

    Returns
    -------
    BestPhase

    Raises
    ------
    ConfigError
        If nothing moves, the drive does not point along the track, or no phase has a steady velocity.
    """
    phases = -np.pi + PHASE_STEP_RAD * np.arange(round(2.0 * np.pi / PHASE_STEP_RAD))
    around = cells(with_phase(bowl, phases))
    velocities = around["velocity"]
    if np.isnan(velocities).all():
        if answer(bowl).unsteady == UnsteadyMotion.KEEPS_SPEED:
            what = "has no steady velocity at any value: without friction a part keeps its speed"
            raise ConfigError("drive.phase", what, "raise friction.static and friction.kinetic")
        what = "has no steady velocity at any value: the part slides down the track without stopping"
        raise ConfigError("drive.phase", what, "lower track.climb, or raise the friction")
    count, peak = len(phases), int(np.nanargmax(velocities))
    near = phases[peak] + PHASE_STEP_RAD * np.linspace(-1.0, 1.0, 2 * FINE_PHASES + 1)
    near_velocities = cells(with_phase(bowl, near))["velocity"]
    fine = int(np.nanargmax(near_velocities))
    phase, velocity = float(near[fine]), float(near_velocities[fine])
    # first and last phase of those on both sides of the best that give nearly its velocity
    good = velocities >= NEAR_BEST_SHARE * velocity if velocity > 0.0 else velocities == velocities[peak]
    below, above = (
        next((k for k in range(count) if not good[(peak + side * (k + 1)) % count]), count - 1)
        for side in (-1, 1)
    )
    frictions = np.array(FRICTION_FACTORS)
    surfaces_tried = scaled(bowl, friction=frictions)
    at_best, straight = (cells(with_phase(surfaces_tried, here))["velocity"] for here in (phase, 0.0))
    return BestPhase(
        phases=check.frozen(phases),
        cells=around,
        phase=phase,
        velocity=velocity,
        straight=float(straight[FRICTION_FACTORS.index(1.0)]),
        lowest=float(phases[peak] - PHASE_STEP_RAD * below),
        highest=float(phases[peak] + PHASE_STEP_RAD * above),
        frictions=check.frozen(frictions),
        best_over_friction=check.frozen(at_best),
        straight_over_friction=check.frozen(straight),
    )


def with_phase(bowl: BowlGrid, phase: Reals) -> BowlGrid:
    """Return the bowl with another phase of its drive.

    Parameters
    ----------
    bowl : BowlGrid
    phase : float or (...) float [rad]

    Returns
    -------
    BowlGrid
    """
    return replace(bowl, drive=replace(bowl.drive, phase=phase))


def speed_remark(velocity: float, rules: Sizing | None) -> list[str]:
    """Return what is odd about a conveying velocity: a line, or none.

    Parameters
    ----------
    velocity : float [m/s]
        NaN where there is no steady one.
    rules : Sizing or None
        The slowest and the fastest usual speed; a bowl made by hand has no rules.

    Returns
    -------
    list of str
        Empty where the speed is usual, not known or without rules.

    References
    ----------
    Trade; the keys ``sizing.slowest`` and ``sizing.fastest``.
    """
    if rules is None or np.isnan(velocity) or rules.slowest <= velocity <= rules.fastest:
        return []
    between = f"{rules.slowest / MM_S:.4g} to {rules.fastest / MM_S:.4g} mm/s"
    side = "slower" if velocity < rules.slowest else "faster"
    return [
        f"{velocity / MM_S:.3g} mm/s is {side} than bowls run ({between}): check stroke, angle and friction"
    ]
