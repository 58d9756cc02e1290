"""The operating points of one bowl at different radii: it moves as a screw, so its angle falls outwards."""

from dataclasses import replace

import numpy as np

from feederscrew.errors import ConfigError

INNER = 0.5  # of the track's radius, where the curve starts
STEPS = 26


def inwards(bowl):
    """Return the bowl at radii [m] from half the track's to the track's own, evenly spaced."""
    return at_radius(bowl, bowl.track.radius * np.linspace(INNER, 1.0, STEPS))


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
