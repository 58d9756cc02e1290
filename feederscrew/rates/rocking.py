"""Rocking of a part on the vibrating track, followed from stroke to stroke."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.geometry.polygons import cross, sides
from feederscrew.mechanics.cycle import phases
from feederscrew.mechanics.track import balance
from feederscrew.mechanics.track.frame import Seat

ROCKING_STEPS = 48  # of one period
SETTLES, FOLLOWED = 12, 60  # periods until the sliding repeats itself, and that the rocking is followed
REST_ANGULAR_SPEED = 1e-4  # [rad/s] a part that comes down slower lies still
SENSES = (0.0, 1.0, -1.0)  # at rest, sliding ahead, sliding back


@dataclass(frozen=True)
class Rocker:
    """A part that may tip over either of two opposite sides."""

    near: float  # [m] from the foot of the centre of mass to the side that the drive tips it over most
    far: float  # [m] to the side opposite
    height: float  # [m] of the centre of mass
    spread: float  # [m2] square of its radius of gyration about the direction of the sides
    force: np.ndarray  # (INSTANTS,) [m/s2] of the track, over the mass
    offset: np.ndarray  # (INSTANTS,) [m] of that force towards the near side, with the part lying
    growth: float = 0.0  # [m/s] of the distance to the near side, from where it is at the start


def rocker(place: Seat, gyration: Callable[[float], float], bowl: Bowl) -> Rocker:
    """Return a part on the track of a bowl as what rocks over its weakest side.

    Parameters
    ----------
    place : Seat
    gyration : callable
        Of an angle from the track [rad]: the square of its radius of gyration about that direction [m2].
    bowl : Bowl
        Single values.

    Returns
    -------
    Rocker
        With the force of the track as it is while the part lies and slides as it then does.
    """
    force, offset = over_period(place, bowl)
    along = sides(place.contact)
    along = along / np.hypot(*along.T)[:, None]
    inside = cross(along, offset[:, None, :] - place.contact)
    (x, y) = along[np.argmin((force[:, None] * inside).min(axis=0))]
    reach = y * place.contact[:, 0] - x * place.contact[:, 1]
    return Rocker(
        near=float(reach.max()),
        far=float(-reach.min()),
        height=place.height,
        spread=gyration(math.atan2(y, x)),
        force=force,
        offset=y * offset[:, 0] - x * offset[:, 1],
    )


def goes_over(rocker: Rocker, period: float, start: int = 0) -> bool:
    """Return whether rocking brings the centre of mass of a part over one of its sides.

    Parameters
    ----------
    rocker : Rocker
    period : float [s]
        Of the drive.
    start : int
        Instant of the period from which it is followed.

    Returns
    -------
    bool

    Notes
    -----
    A part tilted by a small angle over a side at distance r turns by N (o - r + h angle) / (k^2 + r^2 + h^2),
    N the force of the track over its mass and o its offset with the part lying. When it comes down on the
    opposite side at distance s it keeps (k^2 + h^2 - r s) / (k^2 + h^2 + s^2) of its rate.

    References
    ----------
    G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bulletin of the
    Seismological Society of America 53(2), 403-417, 1963.
    """
    step, angle, rate = period / ROCKING_STEPS, 0.0, 0.0
    for k in range(start, start + FOLLOWED * ROCKING_STEPS):
        near = rocker.near + rocker.growth * step * (k - start)
        force, offset = rocker.force[k % ROCKING_STEPS], rocker.offset[k % ROCKING_STEPS]
        side = math.copysign(1.0, angle or rate or offset)
        beside, other = (near, rocker.far) if side > 0.0 else (rocker.far, near)
        still = rocker.spread + rocker.height**2
        turning = force * (offset - side * beside + rocker.height * angle) / (still + beside**2)
        if angle == rate == 0.0 and turning * side <= 0.0:
            continue
        rate += step * turning
        after = angle + step * rate
        if after * side <= 0.0:  # it comes down
            rate *= max((still - beside * other) / (still + other**2), 0.0)
            rate, after = (rate if abs(rate) > REST_ANGULAR_SPEED else 0.0), 0.0
        angle = after
        if abs(angle) >= math.atan2(near if angle > 0.0 else rocker.far, rocker.height):
            return True
    return False


def over_period(place: Seat, bowl: Bowl) -> tuple[np.ndarray, np.ndarray]:
    """Return what the track does to a part over a settled period.

    Source: Housner 1963, the rocking block; docs/trial.md, "What other parts said of the rules".

    Parameters
    ----------
    place : Seat
    bowl : Bowl
        Single values.

    Returns
    -------
    tuple of (INSTANTS,) float [m/s2], (INSTANTS, 2) float [m]
        Force of the track over the mass, and where it acts from the foot of the centre of mass.
    """
    phase = phases(ROCKING_STEPS)
    motions = [balance.motion(place, bowl, phase, np.full(ROCKING_STEPS, sense)) for sense in SENSES]
    senses = _senses(motions, 1.0 / bowl.drive.frequency / ROCKING_STEPS)
    rows = np.arange(ROCKING_STEPS)
    force = np.array([motion.normal_force for motion in motions])[senses, rows] / place.mass
    return force, np.nan_to_num(np.array([motion.offset for motion in motions])[senses, rows])


def _senses(motions: list[balance.TrackMotion], step: float) -> np.ndarray:
    """How the part slides at each instant of a settled period, (INSTANTS,) int: places in ``SENSES``."""
    gains = [step * motion.acceleration[:, 0] for motion in motions]
    loose, speed = motions[0].slides, 0.0
    found = np.zeros(ROCKING_STEPS, dtype=int)
    for k in range(SETTLES * ROCKING_STEPS):
        row = k % ROCKING_STEPS
        if speed == 0.0:
            speed = gains[0][row] if loose[row] else 0.0
        else:
            after = speed + gains[1 if speed > 0.0 else 2][row]
            speed = after if after * speed > 0.0 else 0.0
        found[row] = 0 if speed == 0.0 else 1 if speed > 0.0 else 2
    return found
