"""Chasles: every rigid displacement is one finite twist, and every finite twist is a displacement."""

import numpy as np

from feederscrew.screw.point import ORIGIN, dot, length, skew
from feederscrew.screw.rigid import Displacement
from feederscrew.screw.screws import Twist

SERIES_BELOW = 0.1  # [rad] under this the power series, cut after four terms, are exact to rounding


def displacement(twist):
    """Return the displacement that a finite twist produces: the exponential map.

    Parameters
    ----------
    twist : Twist of shape (...,)
        Angle times axis [rad] and the moment part [m]: a velocity twist times its duration. An angle above
        a half turn is taken as it is.

    Returns
    -------
    Displacement of shape (...,)

    References
    ----------
    R. M. Murray, Z. Li, S. S. Sastry, "A Mathematical Introduction to Robotic Manipulation", CRC Press, 1994,
    section 2.3.
    """
    twist = twist.at(ORIGIN)
    angle, spin = length(twist.resultant), skew(twist.resultant)
    first, second, third = (c[..., None, None] for c in _coefficients(angle))
    rotation = np.eye(3) + first * spin + second * spin @ spin
    mean = np.eye(3) + second * spin + third * spin @ spin
    return Displacement(rotation, np.einsum("...ij,...j->...i", mean, twist.moment))


def finite_twist(moved, reference=ORIGIN):
    """Return the twist, of at most a half turn, that produces a displacement (Chasles's theorem).

    Its axis is the line the body turns about and slides along; ``norm`` is the angle plus eps times the
    slide. A pure translation is a twist of infinite pitch, the identity the zero twist.

    Parameters
    ----------
    moved : Displacement of shape (...,)
        Any rigid displacement.
    reference : Point
        Where the twist is to be expressed.

    Returns
    -------
    Twist of shape (...,)
        resultant: axis times angle [rad], angle from 0 to pi; moment [m].

    Notes
    -----
    At a half turn both senses of the axis are right; an exactly symmetric rotation matrix gives the one whose
    largest component is positive.

    References
    ----------
    M. Chasles, "Note sur les proprietes generales du systeme de deux corps semblables entr'eux",
    Bulletin des Sciences Mathematiques 14, 321-326, 1830.
    S. W. Shepperd, "Quaternion from rotation matrix", J. Guidance and Control 1(3), 223-224, 1978.
    """
    half = _quaternion(moved.rotation)
    sine, cosine = length(half[..., 1:]), half[..., 0]
    angle = 2.0 * np.arctan2(sine, cosine)
    stretch = np.divide(angle, sine, out=np.full(angle.shape, 2.0), where=sine > 0.0)
    turn = stretch[..., None] * half[..., 1:]
    return Twist(turn, _unmixed(turn, angle, moved.translation)).at(reference)


def _coefficients(angle):
    """sin a / a, (1 - cos a) / a^2 and (a - sin a) / a^3, accurate down to a = 0."""
    small = angle < SERIES_BELOW
    square, safe = angle**2, np.where(small, 1.0, angle)
    series = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))) / 6.0
    third = np.where(small, series, (safe - np.sin(safe)) / safe**3)
    return np.sinc(angle / np.pi), 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2, third


def _unmixed(turn, angle, translation):
    """The moment part of a finite twist about the origin, from where the origin goes.

    Inverse of the mean rotation: v = t - w x t / 2 + D w x (w x t), D = (1 - (a/2) cot(a/2)) / a^2.
    """
    small = angle < SERIES_BELOW
    square, safe = angle**2, np.where(small, 1.0, angle)
    series = 1.0 / 12.0 + square / 720.0 * (1.0 + square / 42.0 * (1.0 + square / 40.0))
    exact = (1.0 - 0.5 * safe * np.cos(0.5 * safe) / np.sin(0.5 * safe)) / safe**2
    across = np.cross(turn, translation)
    return translation - 0.5 * across + np.where(small, series, exact)[..., None] * np.cross(turn, across)


def _quaternion(rotation):
    """Unit quaternion (w, x, y, z), w >= 0, (..., 4): the largest column of 4 q q^T, so nothing cancels."""
    trace = np.trace(rotation, axis1=-2, axis2=-1)
    outer = np.empty((*rotation.shape[:-2], 4, 4))
    outer[..., 0, 0] = 1.0 + trace
    outer[..., 1:, 1:] = rotation + np.swapaxes(rotation, -1, -2) + (1.0 - trace)[..., None, None] * np.eye(3)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        outer[..., 0, 1 + i] = outer[..., 1 + i, 0] = rotation[..., k, j] - rotation[..., j, k]
    diagonal = np.diagonal(outer, axis1=-2, axis2=-1)
    best = np.argmax(diagonal, axis=-1)[..., None, None]
    column = np.take_along_axis(outer, np.broadcast_to(best, (*outer.shape[:-1], 1)), axis=-1)[..., 0]
    unit = column / np.sqrt(dot(column, column))[..., None]
    return np.where(unit[..., :1] < 0.0, -unit, unit)
