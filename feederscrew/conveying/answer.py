"""From a bowl to its conveying velocity and back: SI units on both sides of the unitless kernel.

With it the friction that keeps a part from slipping, points at other radii, and the best elliptical phase.
"""

import functools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.bowl.record import Friction
from feederscrew.conveying import operating_point, steady, waves
from feederscrew.conveying.operating_point import PHASES, OperatingPoint
from feederscrew.errors import ConfigError
from feederscrew.mechanics import limits
from feederscrew.records import ReadableRecord

MAX_ONSET_STEPS = 50
ONSET_TOLERANCE = 1e-15  # relative


def limits_of_slip(setting) -> tuple[float, float]:
    """Return the least static friction against slip up and down the track.

    Source: ``limits.forward_limit`` and ``limits.backward_limit``; an elliptical drive by Dinkelbach's
    method.

    Parameters
    ----------
    setting : OperatingPoint
        Its own friction does not matter.

    Returns
    -------
    (float, float) [1]
        Zero or less where no slip comes on any surface; NaN past the hop where it comes on every one.
    """
    if setting.lead == 0.0 and setting.second == 0.0:
        where = (setting.ratio, setting.angle, 0.0, setting.climb)
        return float(limits.forward_limit(*where)), float(limits.backward_limit(*where))
    if operating_point.throw_number(operating_point.law(setting)) >= 1.0 - limits.HOP_ROUNDING:
        return math.nan, math.nan
    return _least(setting, 1.0), _least(setting, -1.0)


def _least(setting, direction) -> float:
    """Greatest over the cycle of pull over normal force.

    References
    ----------
    W. Dinkelbach, "On nonlinear fractional programming", Management Science 13(7), 492-498, 1967: the
    ratio where the difference is greatest is the next estimate.
    """
    pull = operating_point.pull_wave(setting, direction, 0.0)
    press = operating_point.lift_wave(setting)
    mu = waves.height(pull, 0.0) / -waves.height(press, 0.0)
    for _ in range(MAX_ONSET_STEPS):
        angle = waves.crest(operating_point.pull_wave(setting, direction, mu))
        new = waves.height(pull, angle) / -waves.height(press, angle)
        if abs(new - mu) <= ONSET_TOLERANCE * abs(new):
            break
        mu = new
    return new


def throw_of_flight(periods) -> float:
    """Return the throw number at which a part that does not rebound flies for a given time.

    Source: Sloot and Kruyt 1996, by the parabola between two impacts; docs/conveying.md, "The model".

    Parameters
    ----------
    periods : float [1 period]
        Length of the flight, above 0; of one that starts from contact.

    Returns
    -------
    float [1]
        sqrt(1 + pi^2) for one period.
    """
    turn = 2.0 * math.pi * check.positive("periods", periods)
    return math.hypot(1.0, (0.5 * turn * turn - 1.0 + math.cos(turn)) / (turn - math.sin(turn)))


LEAST_ACCELERATION_RATIO = 1e-9  # [1] least acceleration ratio computed with: a bowl at rest carries nothing
SWEEP_REGIMES = (*limits.POINT_REGIMES, "no steady state")  # a regime code of a map is a place in this list
COEXISTING_VELOCITY_GAP = 0.01  # [A w] velocities this far apart are several
POINT_MASS_REMARK = "point mass: fairly good where the part slides, larger deviations where it is thrown"
VALIDITY_SOURCE = "Sloot and Kruyt 1996"


@dataclass(frozen=True, eq=False)
class Answer(ReadableRecord):
    """How a part travels at one operating point."""

    setting: OperatingPoint
    speed: float  # [m/s] A w, of the first harmonic
    status: str  # of ``steady.STATUSES``
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
    regime: str
    runs_away: bool  # a part that once slides down the track fast enough does not stop again


def settings(bowl) -> NDArray[np.float64]:
    """Return what the kernel needs of a bowl.

    Source: docs/conveying.md, "The model"; the bank is reckoned as friction by ``wedge.level``.

    Parameters
    ----------
    bowl : Bowl
        Its fields may be arrays that broadcast together.

    Returns
    -------
    (..., 12) float [1 and rad, as OperatingPoint]
        An ``OperatingPoint`` along the last axis; the acceleration ratio of a bowl at rest is ``STILL``.
    """
    here = limits.level(bowl)
    drive, friction = here.drive, here.friction
    ratio = np.maximum(
        limits.acceleration_ratio(drive.amplitude, drive.frequency, bowl.gravity), LEAST_ACCELERATION_RATIO
    )
    surface = (friction.static, friction.kinetic, *friction.backward)
    fields = (ratio, drive.vibration_angle, here.track.climb, *surface, bowl.restitution)
    second = (drive.second_harmonic, drive.second_harmonic_phase, drive.second_harmonic_turn)
    rows = np.broadcast_arrays(*fields, -np.asarray(drive.phase), *second)
    return np.stack(rows, axis=-1).astype(float)


def answer(bowl) -> Any:
    """Compute how a part travels in a bowl, without compiling anything.

    Parameters
    ----------
    bowl : Bowl

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
    return _answer(bowl, setting, np.array(_surveyed(setting)))


@functools.lru_cache(maxsize=64)  # a drive is asked for its velocity, its hop and its hardest landing
def _surveyed(setting: OperatingPoint) -> tuple[float, ...]:
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    return tuple(out.tolist())


def throw_number(bowl) -> float:
    """Return the plate's greatest downward acceleration over gravity, along the normal [1]; one setting."""
    return operating_point.throw_number(operating_point.law(OperatingPoint(*settings(bowl).tolist())))


def conveying(bowl):
    """Return the bowl itself, once it can convey; raise ConfigError otherwise."""
    if not np.all(bowl.gravity > 0.0):
        raise ConfigError("gravity", "is not above 0", "give m/s2, 9.81 on earth")
    if np.any(bowl.drive.direction != 0.0):
        what = "is not 0 deg, but a track can only convey along itself"
        raise ConfigError("drive.direction", what, "leave it out: it is for the floor (feeder floor)")
    if np.size(bowl.drive.amplitude) and np.max(bowl.drive.amplitude) <= 0.0:
        raise ConfigError("drive.amplitude", "is 0 mm, so nothing moves", "give more than 0 mm")
    pairs = zip(("", "_backward"), ((bowl.friction.static, bowl.friction.kinetic), bowl.friction.backward))
    for suffix, (static, kinetic) in pairs:
        if np.any(kinetic > static):
            what, mend = f"is above friction.static{suffix}", f"lower it or raise friction.static{suffix}"
            raise ConfigError(f"friction.kinetic{suffix}", what, mend)
    return bowl


def cells(bowl) -> Any:
    """Compute how a part travels over a map.

    Parameters
    ----------
    bowl : Bowl
        Its fields are arrays that broadcast together.

    Returns
    -------
    dict of str to array
        velocity, low, high [m/s] over the starts; several, whether they differ by more than
        ``COEXISTING_VELOCITY_GAP``; regime, a place in ``REGIMES``; throw_number [1]; status, a place in
        ``steady.STATUSES``.

    Raises
    ------
    ConfigError
        As ``answer`` does.
    """
    from feederscrew.conveying.sweep import sweep

    rows = settings(conveying(bowl))
    out = sweep(rows.reshape(-1, rows.shape[-1])).reshape(*rows.shape[:-1], steady.COLUMNS)
    status, speed = out[..., steady.STATUS].astype(int), np.asarray(greatest_speed(bowl))
    return {
        "velocity": out[..., steady.VELOCITY] * speed,
        "low": out[..., steady.LOW] * speed,
        "high": out[..., steady.HIGH] * speed,
        "several": out[..., steady.HIGH] - out[..., steady.LOW] > COEXISTING_VELOCITY_GAP,
        "regime": np.where(
            status == steady.NO_STEADY_STATE, len(SWEEP_REGIMES) - 1, out[..., steady.REGIME].astype(int)
        ),
        "throw_number": np.where(speed > 0.0, out[..., steady.THROW], 0.0),  # not that of ``STILL``
        "status": status,
    }


def greatest_speed(bowl) -> Any:
    """Return A w [m/s], of the first harmonic.

    Source: the derivative of the motion; docs/conveying.md, "The model".
    """
    return bowl.drive.amplitude * 2.0 * np.pi * bowl.drive.frequency


def validity(run, bowl) -> str:
    """Say what an answer leaves out, in one sentence."""
    remarks = (
        f"{POINT_MASS_REMARK} ({VALIDITY_SOURCE})"
        if run.throw_number > 1.0
        else "point mass: tipping and turning are left out"
    )
    most = greatest_speed(bowl) * (1.0 + 2.0 * bowl.drive.second_harmonic)
    share = most**2 / (bowl.track.radius * bowl.gravity)
    return f"{remarks}; the centripetal force, up to {100.0 * share:.2g} % of the weight, is left out"


def scaled(bowl, *, amplitude=1.0, friction=1.0, angle=1.0):
    """Return the bowl with its stroke, every coefficient of friction or its vibration angle multiplied."""
    drive = replace(
        bowl.drive,
        amplitude=bowl.drive.amplitude * amplitude,
        vibration_angle=np.minimum(bowl.drive.vibration_angle * angle, np.pi / 2),
    )
    mu = bowl.friction
    values = (mu.static, mu.kinetic, mu.wall, *mu.backward)
    surfaces = Friction(*(value * friction for value in values))
    return replace(bowl, drive=drive, friction=surfaces)


def _answer(bowl, setting, out) -> Answer:
    speed = float(greatest_speed(bowl))
    status = int(out[steady.STATUS])
    mu, throw, limit = bowl.friction, float(out[steady.THROW]), limits_of_slip(setting)
    forward, backward = (
        float(limits.of_floor(floor_limit, mu.wall, bowl.track.bank)) for floor_limit in limit
    )
    return Answer(
        setting=setting,
        speed=speed,
        status=steady.STATUSES[status],
        period=int(out[steady.PERIOD]),
        velocity=float(out[steady.VELOCITY]) * speed,
        low=float(out[steady.LOW]) * speed,
        high=float(out[steady.HIGH]) * speed,
        slowest=float(out[steady.SLOWEST]) * speed,
        fastest=float(out[steady.FASTEST]) * speed,
        fractions={name: float(out[steady.FRACTIONS + k]) for k, name in enumerate(PHASES)},
        longest_flight=float(out[steady.FLIGHT_TIME]),
        hardest_impact=float(out[steady.IMPACT]) * speed,
        flights=float(out[steady.HOPS]),
        throw_number=throw,
        mu_forward=forward,
        mu_backward=backward,
        margins={
            "forward": mu.static - forward,
            "backward": mu.backward[0] - backward,
            "hop": 1.0 - throw,
        },
        regime=SWEEP_REGIMES[-1]
        if status == steady.NO_STEADY_STATE
        else SWEEP_REGIMES[int(out[steady.REGIME])],
        runs_away=bool(out[steady.RUNAWAY]),
    )


INNER_RADIUS_SHARE = 0.5  # of the track's radius, where the curve starts
RADIUS_STEPS = 26


def inwards(bowl) -> Any:
    """Return the bowl at radii [m] from half the track's to the track's own, evenly spaced."""
    return at_radius(bowl, bowl.track.radius * np.linspace(INNER_RADIUS_SHARE, 1.0, RADIUS_STEPS))


def at_radius(bowl, radius):
    """Return the bowl as a part feels it nearer to its axis.

    Source: a bowl that moves as a screw, tan(angle) r = const; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    bowl : Bowl
        Its drive is that at ``bowl.track.radius``.
    radius : array_like [m]

    Returns
    -------
    Bowl
        Its amplitude, vibration angle and radius are arrays where ``radius`` is one.

    Raises
    ------
    ConfigError
        If the drive is elliptical.

    Notes
    -----
    All points rise by the same amplitude and turn by the same angle, so the tangent of the angle to
    the horizontal, vibration angle plus climb, is inversely proportional to the radius.
    """
    if np.any(bowl.drive.phase != 0.0):
        what = "is not 0 deg, an elliptical drive is not a screw motion to follow inwards"
        raise ConfigError("drive.phase", what, "leave out `curve`, or the phase")
    rise = np.sin(bowl.drive.vibration_angle + bowl.track.climb) * bowl.drive.amplitude
    turn = np.cos(bowl.drive.vibration_angle + bowl.track.climb) * bowl.drive.amplitude / bowl.track.radius
    reach = turn * np.asarray(radius)
    angle = np.arctan2(rise, reach) - bowl.track.climb
    drive = replace(bowl.drive, amplitude=np.hypot(rise, reach), vibration_angle=angle)
    return replace(bowl, drive=drive, track=replace(bowl.track, radius=np.asarray(radius)))


PHASE_STEP_RAD = np.radians(2.0)  # between the phases tried
FINE_PHASES = 20  # phases to each side of the best one, within a step
NEAR_BEST_SHARE = 0.9  # of the best velocity
FRICTION_FACTORS = (0.5, 0.8, 1.0, 1.2, 1.5)  # of the bowl's coefficients


@dataclass(frozen=True, eq=False)
class BestPhase:
    """Velocities of one bowl over the phase of its drive."""

    phases: np.ndarray  # (P,) [rad] tried, from -180 deg
    cells: dict[str, np.ndarray]  # (P,) what the part does there, as ``answer.cells`` names it
    phase: float  # [rad] by which the motion along the normal leads, where the part is fastest up the track
    velocity: float  # [m/s] there
    straight: float  # [m/s] of a straight drive, phase 0
    lowest: float  # [rad] of the phases round the best that give nearly its velocity
    highest: float  # [rad] which may lie beyond half a turn
    frictions: np.ndarray  # (K,) [1] friction tried, over the bowl's
    best_over_friction: np.ndarray  # (K,) [m/s] at the best phase
    straight_over_friction: np.ndarray  # (K,) [m/s]


def best_phase(bowl) -> Any:
    """Find the phase of the drive at which a part travels fastest up the track.

    Parameters
    ----------
    bowl : Bowl
        Single values; its own phase does not matter.

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
        what = "has no steady velocity at any value: the part slides down the track without stopping"
        raise ConfigError("drive.phase", what, "lower track.climb, or raise the friction")
    near = phases[np.nanargmax(velocities)] + PHASE_STEP_RAD * np.linspace(-1.0, 1.0, 2 * FINE_PHASES + 1)
    near_velocities = cells(with_phase(bowl, near))["velocity"]
    best = int(np.nanargmax(near_velocities))
    phase, velocity = float(near[best]), float(near_velocities[best])
    low, high = _range(phases, velocities, velocity)
    frictions = np.array(FRICTION_FACTORS)
    return BestPhase(
        phases=check.frozen(phases),
        cells=around,
        phase=phase,
        velocity=velocity,
        straight=_velocity(bowl, 0.0),
        lowest=low,
        highest=high,
        frictions=check.frozen(frictions),
        best_over_friction=check.frozen(_over_friction(bowl, phase, frictions)),
        straight_over_friction=check.frozen(_over_friction(bowl, 0.0, frictions)),
    )


def with_phase(bowl, phase):
    """Return the bowl with another phase of its drive [rad], one or many."""
    return replace(bowl, drive=replace(bowl.drive, phase=phase))


def _range(phases, velocities, best) -> tuple[float, float]:
    """First and last phase of those on both sides of the best that give nearly its velocity."""
    count, peak = len(phases), int(np.nanargmax(velocities))
    good = velocities >= NEAR_BEST_SHARE * best if best > 0.0 else velocities == velocities[peak]
    lower = next((k for k in range(count) if not good[(peak - k - 1) % count]), count - 1)
    on = next((k for k in range(count) if not good[(peak + k + 1) % count]), count - 1)
    return float(phases[peak] - PHASE_STEP_RAD * lower), float(phases[peak] + PHASE_STEP_RAD * on)


def _velocity(bowl, phase) -> float:
    return float(cells(with_phase(bowl, np.array([phase])))["velocity"][0])


def _over_friction(bowl, phase, shares) -> NDArray[np.float64]:
    return np.array([_velocity(scaled(bowl, friction=share), phase) for share in shares])
