"""Every zero and turning point of a constant and two harmonics, each bracketed where there is one only.

A wave is monotone between its turning points, which are the zeros of its slope; the slope is monotone
between its own turning points; and so on, until one of the two harmonics outweighs the other so far
that its own extremes bracket every zero.
"""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.conveying.setting import TURN

MOST = 4  # zeros in a period
OUTWEIGHS = math.sqrt(5.0)  # then the slope keeps its sign between the first harmonic's zeros and this one's
PRECISION = 4e-16  # [rad]
STEPS = 200


class Wave(NamedTuple):
    """level + sine sin(angle) + cosine cos(angle) + sine_2 sin(2 angle) + cosine_2 cos(2 angle)."""

    level: float
    sine: float
    cosine: float
    sine_2: float
    cosine_2: float


def height(wave, angle):
    """Return the wave at an angle [rad], in its own unit.

    Source: the double angles of sine and cosine.
    """
    s, c = math.sin(angle), math.cos(angle)
    once = wave.sine * s + wave.cosine * c
    return wave.level + once + 2.0 * wave.sine_2 * s * c + wave.cosine_2 * (c - s) * (c + s)


def slope(wave):
    """Return its derivative, a wave again, in its own unit over [rad]."""
    return Wave(0.0, -wave.cosine, wave.sine, -2.0 * wave.cosine_2, 2.0 * wave.sine_2)


def bends(wave):
    """Find where a wave turns.

    Source: own; docs/conveying.md, "How it is computed", and the Notes.

    Parameters
    ----------
    wave : Wave

    Returns
    -------
    (4,) float [rad]
        From 0 to 2 pi, ascending, then inf.

    Notes
    -----
    With S and T the harmonics of the slope, its own slope at a zero has |cos| <= T/S of the first harmonic,
    so S^2 > 5 T^2 keeps its sign: one zero between the extremes of the first. Otherwise two derivatives
    later the second is 4 T / S > 1 of the first: one zero between the extremes of the second.
    """
    rate = slope(wave)
    if math.hypot(rate.sine, rate.cosine) > OUTWEIGHS * math.hypot(rate.sine_2, rate.cosine_2):
        top = math.atan2(rate.sine, rate.cosine)
        return crossings(rate, _knots(top, math.pi, 2), 0)
    second = slope(rate)
    third = slope(second)
    top = 0.5 * math.atan2(third.sine_2, third.cosine_2)
    knots = _knots(top, 0.5 * math.pi, MOST)
    return crossings(rate, crossings(second, crossings(third, knots, 0), 0), 0)


def _knots(first, apart, count):
    """(4,) float [rad]: so many angles, this far apart, then inf."""
    angles = np.empty(MOST)
    for k in range(MOST):
        angles[k] = first + apart * k if k < count else math.inf
    return angles


def crest(wave):
    """Return the angle [rad] of its greatest value; the wave has a harmonic."""
    best, found = -math.inf, 0.0
    angles = bends(wave)
    for k in range(MOST):
        if angles[k] < math.inf and height(wave, angles[k]) > best:
            best, found = height(wave, angles[k]), angles[k]
    return found


def crossings(wave, knots, sense):
    """Find the zeros of a wave that has at most one between neighbouring knots.

    Source: own; docs/conveying.md, "How it is computed".

    Parameters
    ----------
    wave : Wave
    knots : (4,) float [rad]
        Ascending within one period, then inf.
    sense : int
        +1 for the zeros where it rises, -1 where it falls, 0 for both; a wave that only touches zero
        from below does neither.

    Returns
    -------
    (4,) float [rad]
        From 0 to 2 pi, ascending, then inf.
    """
    found = _knots(0.0, 0.0, 0)
    for k in range(MOST):
        if knots[k] == math.inf:
            break
        low, high = knots[k], knots[0] + TURN
        if k + 1 < MOST and knots[k + 1] < math.inf:
            high = knots[k + 1]
        before, after = height(wave, low) > 0.0, height(wave, high) > 0.0
        if (after and not before and sense >= 0) or (before and not after and sense <= 0):
            _insert(found, _zero(wave, low, high, after) % TURN % TURN)
    return found


def _insert(ascending, number):
    """Put a number into its place; the last of them, an inf, gives way."""
    place = len(ascending) - 1
    while place > 0 and ascending[place - 1] > number:
        ascending[place] = ascending[place - 1]
        place -= 1
    ascending[place] = number


def _zero(wave, low, high, rises):
    """The zero between two angles: Newton, halving where that leaves the bracket or is slow."""
    rate = slope(wave)
    x, last = 0.5 * (low + high), high - low
    for _ in range(STEPS):
        left, steep = height(wave, x), height(rate, x)
        if (left > 0.0) == rises:
            high = x
        else:
            low = x
        new = x - left / steep if steep != 0.0 else low
        if not low < new < high or abs(new - x) > 0.5 * last:
            new = 0.5 * (low + high)
        last = abs(new - x)
        x = new
        if last <= PRECISION:
            break
    return x
