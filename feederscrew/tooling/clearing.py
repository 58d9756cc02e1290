"""How a blade clears itself: what stands before it slides along its face off the free edge.

Source: docs/tooling.md, "What becomes of a part that does not pass".
"""

import functools
import math
from typing import Any

from feederscrew.errors import FeederError

PERIODS, SETTLED = 60, 20  # of the drive, in all and until the motion is taken
CLEARING_STEPS = 240  # of one period
REST_SPEED = 1e-6  # [m/s] what slides more slowly does not leave


def limit(friction):
    """Return the sweep [rad] below which a face of some friction clears itself.

    Source: 90 deg less the angle of friction; docs/tooling.md, "1. The method".

    Parameters
    ----------
    friction : float [1]

    Notes
    -----
    In the mean over strokes the track drags a part along with T; the face answers with R normal to it and at
    most ``friction`` R along it: the part slides while T cos(sweep) > friction T sin(sweep).
    """
    return 0.5 * math.pi - math.atan(friction)


def seconds(device, orientation, bowl):
    """Return how long [s] an orientation that a device returns blocks the track; 0 of what drops at once.

    Source: docs/tooling.md, "1. The method".

    Parameters
    ----------
    device : Device
    orientation : Orientation
    bowl : Bowl
        Single values.
    """
    if device.face is None:
        return 0.0
    sweep, friction = device.face
    friction = bowl.friction.static if friction is None else friction
    speed = along_blade(bowl, sweep, friction)
    distance = max(orientation.track.width - orientation.distance, 0.0)
    return distance / speed if speed > REST_SPEED else math.inf


@functools.lru_cache(maxsize=64)
def along_blade(bowl, sweep, friction):
    """Return the mean velocity [m/s] towards the free edge of a point mass before a swept face.

    Source: docs/tooling.md, "1. The method".

    Parameters
    ----------
    bowl : Bowl
        Its drive, which throws nothing, the friction of its track and its climb; the bank leans the track
        towards the wall.
    sweep : float [rad]
        Of the face to the direction of travel.
    friction : float [1]
        Of the face.

    Returns
    -------
    float [m/s]
        A lower bound: what comes behind pushes. 0 where it does not slide.

    Notes
    -----
    Followed in steps of a part of the period in which the track's friction takes at most mu N dt of the
    relative velocity; the face takes what goes into it and at most friction times that along it.
    """
    if sweep >= limit(friction):
        return 0.0
    drive, grip, g = bowl.drive, bowl.friction, bowl.gravity
    w, dt = 2.0 * math.pi * drive.frequency, 1.0 / drive.frequency / CLEARING_STEPS
    fore = drive.amplitude * w * math.cos(drive.vibration_angle)
    lift = drive.amplitude * w * w * math.sin(drive.vibration_angle)
    pull = -g * math.sin(bowl.track.climb), -g * math.sin(bowl.track.bank)
    normal = g * math.cos(bowl.track.climb) * math.cos(bowl.track.bank)
    c, s = math.cos(sweep), math.sin(sweep)
    x = y = u = v = start = 0.0
    for step in range(PERIODS * CLEARING_STEPS):
        if step == SETTLED * CLEARING_STEPS:
            start = y
        phase = w * dt * step
        press = max(normal - lift * math.sin(phase + drive.phase), 0.0)
        u, v = u + pull[0] * dt, v + pull[1] * dt
        u, v = _rubbed(u, v, fore * math.cos(phase), grip.kinetic * press * dt)
        into = u * s - v * c
        if x * s - y * c >= 0.0 and into > 0.0:  # at the face, and into it
            along = u * c + v * s
            along -= math.copysign(min(abs(along), friction * into), along)
            u, v = along * c, along * s
        x, y = x + u * dt, y + v * dt
        if x * s - y * c > 0.0:
            over = x * s - y * c
            x, y = x - over * s, y + over * c
    mean_velocity = (y - start) / ((PERIODS - SETTLED) / drive.frequency)
    if not math.isfinite(mean_velocity):
        raise FeederError("devices", "the motion along a blade has no end", "lower the drive")
    return max(mean_velocity, 0.0)


def _rubbed(u, v, track, most) -> tuple[Any, ...]:
    """Velocity (2) [m/s] of a part after the track has taken at most so much of what is relative to it."""
    du, dv = u - track, v
    slip = math.hypot(du, dv)
    left = max(1.0 - most / slip, 0.0) if slip > 0.0 else 0.0
    return track + du * left, dv * left
