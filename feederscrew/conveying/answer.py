"""From a bowl to its conveying velocity and back: SI units on both sides of the unitless kernel."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.record import Friction
from feederscrew.conveying import law, onset, steady
from feederscrew.conveying.setting import PHASES, OperatingPoint
from feederscrew.errors import ConfigError
from feederscrew.mechanics import limits, wedge
from feederscrew.records import ReadableRecord

STILL = 1e-9  # [1] least acceleration ratio computed with: a bowl at rest carries nothing
REGIMES = (*limits.REGIMES, "no steady state")  # a regime code of a map is a place in this list
COEXIST = 0.01  # [A w] velocities this far apart are several
POINT_MASS = "point mass: fairly good where the part slides, larger deviations where it is thrown"
SOURCE = "Sloot and Kruyt 1996"


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


def settings(bowl):
    """Return what the kernel needs of a bowl.

    Source: docs/conveying.md, "The model"; the bank is reckoned as friction by ``wedge.level``.

    Parameters
    ----------
    bowl : Bowl
        Its fields may be arrays that broadcast together.

    Returns
    -------
    (..., 11) float [1 and rad, as OperatingPoint]
        An ``OperatingPoint`` along the last axis; the acceleration ratio of a bowl at rest is ``STILL``.
    """
    here = wedge.level(bowl)
    drive, friction = here.drive, here.friction
    ratio = np.maximum(limits.acceleration_ratio(drive.amplitude, drive.frequency, bowl.gravity), STILL)
    surface = (friction.static, friction.kinetic, *friction.backward)
    fields = (ratio, drive.vibration_angle, here.track.climb, *surface, bowl.restitution)
    second = (drive.second_harmonic, drive.second_harmonic_phase)
    rows = np.broadcast_arrays(*fields, -np.asarray(drive.phase), *second)
    return np.stack(rows, axis=-1).astype(float)


def answer(bowl):
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
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    return _answer(bowl, setting, out)


def throw_number(bowl):
    """Return the plate's greatest downward acceleration over gravity, along the normal [1]; one setting."""
    return law.throw_number(law.law(OperatingPoint(*settings(bowl).tolist())))


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


def cells(bowl):
    """Compute how a part travels over a map.

    Parameters
    ----------
    bowl : Bowl
        Its fields are arrays that broadcast together.

    Returns
    -------
    dict of str to array
        velocity, low, high [m/s] over the starts; several, whether they differ by more than
        ``COEXIST``; regime, a place in ``REGIMES``; throw_number [1]; status, a place in
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
        "several": out[..., steady.HIGH] - out[..., steady.LOW] > COEXIST,
        "regime": np.where(
            status == steady.NO_STEADY_STATE, len(REGIMES) - 1, out[..., steady.REGIME].astype(int)
        ),
        "throw_number": np.where(speed > 0.0, out[..., steady.THROW], 0.0),  # not that of ``STILL``
        "status": status,
    }


def greatest_speed(bowl):
    """Return A w [m/s], of the first harmonic.

    Source: the derivative of the motion; docs/conveying.md, "The model".
    """
    return bowl.drive.amplitude * 2.0 * np.pi * bowl.drive.frequency


def validity(found, bowl):
    """Say what an answer leaves out, in one sentence."""
    said = (
        f"{POINT_MASS} ({SOURCE})"
        if found.throw_number > 1.0
        else "point mass: tipping and turning are left out"
    )
    most = greatest_speed(bowl) * (1.0 + 2.0 * bowl.drive.second_harmonic)
    share = most**2 / (bowl.track.radius * bowl.gravity)
    return f"{said}; the centripetal force, up to {100.0 * share:.2g} % of the weight, is left out"


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


def _answer(bowl, setting, out):
    speed = float(greatest_speed(bowl))
    status = int(out[steady.STATUS])
    mu, throw, limit = bowl.friction, float(out[steady.THROW]), onset.limits_of_slip(setting)
    forward, backward = (float(wedge.of_floor(one, mu.wall, bowl.track.bank)) for one in limit)
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
        regime=REGIMES[-1] if status == steady.NO_STEADY_STATE else REGIMES[int(out[steady.REGIME])],
        runs_away=bool(out[steady.RUNAWAY]),
    )
