"""Every zero and turning point of a constant and two harmonics, each bracketed where there is one only.

A wave is monotone between its turning points, which are the zeros of its slope; the slope is monotone
between its own turning points; and so on, until one of the two harmonics outweighs the other so far
that its own extremes bracket every zero.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

PERIOD_RAD = 2.0 * math.pi  # one period of the drive
MAX_ZEROS = 4  # zeros in a period
OUTWEIGHS = math.sqrt(5.0)  # then the slope keeps its sign between the first harmonic's zeros and this one's
ZERO_PRECISION_RAD = 4e-16
SERIES = 0.5  # [rad] below it the integrals use their series: the differences would lose digits
GRAZE = 1e-14  # of the swing: a level passed by less is not passed; its two zeros would round to one
INF = math.inf
Zeros = tuple[float, float, float, float]


class Wave(NamedTuple):
    """level + sine sin(angle) + cosine cos(angle) + sine_2 sin(2 angle) + cosine_2 cos(2 angle)."""

    level: float
    sine: float
    cosine: float
    sine_2: float
    cosine_2: float


def height(wave: Wave, angle: float) -> float:
    """Return the wave at an angle, in its own unit.

    Parameters
    ----------
    wave : Wave
    angle : float [rad]

    Returns
    -------
    float [any]

    References
    ----------
    The double angles of sine and cosine.
    """
    s, c = math.sin(angle), math.cos(angle)
    once = wave.sine * s + wave.cosine * c
    return wave.level + once + 2.0 * wave.sine_2 * s * c + wave.cosine_2 * (c - s) * (c + s)


def size(a: float, b: float) -> float:
    """Return sqrt(a^2 + b^2); ``math.hypot`` has other last bits where it is compiled.

    Parameters
    ----------
    a : float [any]
    b : float [any]

    Returns
    -------
    float [any]

    References
    ----------
    Its definition.
    """
    return math.sqrt(a * a + b * b)


def slope(wave: Wave) -> Wave:
    """Return the derivative of a wave, a wave again.

    Parameters
    ----------
    wave : Wave [any]

    Returns
    -------
    Wave [any/rad]
    """
    return Wave(0.0, -wave.cosine, wave.sine, -2.0 * wave.cosine_2, 2.0 * wave.sine_2)


def find_bends(wave: Wave) -> Zeros:
    """Find where a wave turns.

    With S and T the harmonics of the slope, its own slope at a zero has |cos| <= T/S of the first harmonic,
    so S^2 > 5 T^2 keeps its sign: one zero between the extremes of the first. Otherwise two derivatives
    later the second is 4 T / S > 1 of the first: one zero between the extremes of the second.

    Parameters
    ----------
    wave : Wave [any]

    Returns
    -------
    Zeros [rad]
        From 0 to 2 pi, ascending, then inf.

    References
    ----------
    docs/conveying.md, "How it is computed".
    """
    rate = slope(wave)
    if size(rate.sine, rate.cosine) > OUTWEIGHS * size(rate.sine_2, rate.cosine_2):
        return crossings(rate, _knots(math.atan2(rate.sine, rate.cosine), math.pi, 2), 0)
    second = slope(rate)
    third = slope(second)
    knots = _knots(0.5 * math.atan2(third.sine_2, third.cosine_2), 0.5 * math.pi, MAX_ZEROS)
    return crossings(rate, crossings(second, crossings(third, knots, 0), 0), 0)


def _knots(first: float, spacing: float, count: int) -> Zeros:
    """Return so many angles [rad], this far apart, then inf."""
    return (
        first if count > 0 else INF,
        first + spacing if count > 1 else INF,
        first + spacing * 2 if count > 2 else INF,
        first + spacing * 3 if count > 3 else INF,
    )


def crest(wave: Wave) -> float:
    """Return the angle of the greatest value of a wave.

    Parameters
    ----------
    wave : Wave [any]
        With a harmonic.

    Returns
    -------
    float [rad]
    """
    best, angle, angles = -math.inf, 0.0, find_bends(wave)
    for k in range(MAX_ZEROS):
        if angles[k] < math.inf and height(wave, angles[k]) > best:
            best, angle = height(wave, angles[k]), angles[k]
    return angle


def crossings(wave: Wave, knots: Zeros, sense: int) -> Zeros:
    """Return the zeros of a wave that has at most one between neighbouring knots.

    A wave that only touches zero from below neither rises nor falls through it.

    Parameters
    ----------
    wave : Wave
    knots : (4,) float [rad]
        Ascending within one period, then inf.
    sense : int
        +1 for the zeros where it rises, -1 where it falls, 0 for both.

    Returns
    -------
    (4,) float [rad]
        From 0 to 2 pi, ascending, then inf.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    zeros, rate = _knots(0.0, 0.0, 0), slope(wave)
    for k in range(MAX_ZEROS):
        if knots[k] == math.inf:
            break
        low, high = knots[k], knots[0] + PERIOD_RAD
        if k + 1 < MAX_ZEROS and knots[k + 1] < math.inf:
            high = knots[k + 1]
        before, after = height(wave, low) > 0.0, height(wave, high) > 0.0
        if (after and not before and sense >= 0) or (before and not after and sense <= 0):
            x, last = 0.5 * (low + high), high - low
            for _ in range(200):  # Newton, halving where that leaves the bracket or is slow
                left, steep = height(wave, x), height(rate, x)
                if (left > 0.0) == after:
                    high = x
                else:
                    low = x
                new = x - left / steep if steep != 0.0 else low
                if not low < new < high or abs(new - x) > 0.5 * last:
                    new = 0.5 * (low + high)
                last = abs(new - x)
                x = new
                if last <= ZERO_PRECISION_RAD:
                    break
            zero = x % PERIOD_RAD % PERIOD_RAD
            # into its place among the others; the last, an inf, gives way
            one, two, three, _ = zeros
            if one > zero:
                zeros = zero, one, two, three
            elif two > zero:
                zeros = one, zero, two, three
            elif three > zero:
                zeros = one, two, zero, three
            else:
                zeros = one, two, three, zero
    return zeros


class Harmonic(NamedTuple):
    """level + swing sin(angle + phase) + second sin(2 angle + second_phase)."""

    level: float
    swing: float
    phase: float  # [rad]
    second: float
    second_phase: float  # [rad]
    rises: tuple[float, float]  # [rad] where it rises through zero, from 0 to 2 pi, ascending; then inf
    falls: tuple[float, float]  # [rad] where it falls through zero


def harmonic(wave: Wave) -> Harmonic:
    """Return a wave by its amplitudes and phases, with its zeros.

    Parameters
    ----------
    wave : Wave [any]

    Returns
    -------
    Harmonic [any]
    """
    level = wave.level
    swing, phase = size(wave.sine, wave.cosine), math.atan2(wave.cosine, wave.sine)
    second, twice = size(wave.sine_2, wave.cosine_2), math.atan2(wave.cosine_2, wave.sine_2)
    if second > 0.0:
        bends = find_bends(wave)
        up, down = crossings(wave, bends, 1), crossings(wave, bends, -1)
        return Harmonic(level, swing, phase, second, twice, (up[0], up[1]), (down[0], down[1]))
    if abs(level) >= swing * (1.0 - GRAZE):
        return Harmonic(level, swing, phase, 0.0, 0.0, (INF, INF), (INF, INF))
    crossing = math.asin(-level / swing)
    rise, fall = (crossing - phase) % PERIOD_RAD, (math.pi - crossing - phase) % PERIOD_RAD
    return Harmonic(level, swing, phase, 0.0, 0.0, (rise, INF), (fall, INF))


def peak(a: Harmonic) -> float:
    """Return the greatest value of a harmonic.

    Parameters
    ----------
    a : Harmonic [A w2]

    Returns
    -------
    float [A w2]

    References
    ----------
    docs/conveying.md, "Elliptical drives".
    """
    if a.second == 0.0:
        return a.level + a.swing
    sine, cosine = a.swing * math.cos(a.phase), a.swing * math.sin(a.phase)
    sine_2, cosine_2 = a.second * math.cos(a.second_phase), a.second * math.sin(a.second_phase)
    return value(a, crest(Wave(a.level, sine, cosine, sine_2, cosine_2)))


def value(a: Harmonic, angle: float) -> float:
    """Return the harmonic at an angle, in its own unit.

    Parameters
    ----------
    a : Harmonic
    angle : float [rad]

    Returns
    -------
    float [any]

    References
    ----------
    docs/conveying.md, "The model".
    """
    once = a.level + a.swing * math.sin(angle + a.phase)
    return once if a.second == 0.0 else once + a.second * math.sin(2.0 * angle + a.second_phase)


def after(zeros: Sequence[float], angle: float) -> float:
    """Return the first of two angles beyond another.

    Parameters
    ----------
    zeros : (2,) float [rad]
        Ascending.
    angle : float [rad]

    Returns
    -------
    float [rad]
        inf where neither is beyond.
    """
    if zeros[0] > angle:
        return zeros[0]
    return zeros[1] if zeros[1] > angle else INF


def above(a: Harmonic, angle: float) -> bool:
    """Return whether the harmonic is positive from an angle on.

    Its zeros decide: at a zero the value itself is only rounding.

    Parameters
    ----------
    a : Harmonic
    angle : float [rad]

    Returns
    -------
    bool
    """
    rise, fall = after(a.rises, angle), after(a.falls, angle)
    if rise == fall:  # neither is to come in this period
        rise, fall = a.rises[0], a.falls[0]
    return fall < rise


class Arc(NamedTuple):
    """A harmonic as it goes on from one angle, by the sines and cosines of the span and of twice the span."""

    level: float
    sine: float  # times cos(span)
    cosine: float  # times sin(span)
    second: float
    sine_2: float
    cosine_2: float


def onward(a: Harmonic, start: float) -> Arc:
    """Return the harmonic from an angle on, as a function of the span from there.

    Parameters
    ----------
    a : Harmonic
    start : float [rad]

    Returns
    -------
    Arc

    References
    ----------
    The addition theorems of sine and cosine.
    """
    sine, cosine = a.swing * math.sin(start + a.phase), a.swing * math.cos(start + a.phase)
    if a.second == 0.0:
        return Arc(a.level, sine, cosine, 0.0, 0.0, 0.0)
    angle = 2.0 * start + a.second_phase
    return Arc(a.level, sine, cosine, a.second, a.second * math.sin(angle), a.second * math.cos(angle))


def reached(arc: Arc, span: float) -> float:
    """Return the harmonic after a span.

    Parameters
    ----------
    arc : Arc
    span : float [rad]

    Returns
    -------
    float [any]
        In the unit of the harmonic.

    References
    ----------
    The addition theorems, as products of the half span.
    """
    s, c = math.sin(0.5 * span), math.cos(0.5 * span)
    once = arc.level + arc.sine + 2.0 * s * (arc.cosine * c - arc.sine * s)
    if arc.second == 0.0:
        return once
    s, c = math.sin(span), math.cos(span)
    return once + arc.sine_2 + 2.0 * s * (arc.cosine_2 * c - arc.sine_2 * s)


def gain(arc: Arc, span: float) -> float:
    """Return the velocity gained over a span: the integral of the acceleration.

    Parameters
    ----------
    arc : Arc
        Acceleration [A w^2].
    span : float [rad]

    Returns
    -------
    float [A w]

    References
    ----------
    The integral of ``value``.
    """
    s, c = math.sin(0.5 * span), math.cos(0.5 * span)  # as a product, short spans keep their digits
    once = arc.level * span + 2.0 * s * (arc.sine * c + arc.cosine * s)
    if arc.second == 0.0:
        return once
    s, c = math.sin(span), math.cos(span)
    return once + s * (arc.sine_2 * c + arc.cosine_2 * s)


def travel(arc: Arc, span: float) -> float:
    """Return the way made from rest over a span: the integral of the velocity gained.

    Parameters
    ----------
    arc : Arc
        Acceleration [A w^2].
    span : float [rad]

    Returns
    -------
    float [A]

    References
    ----------
    The integral of ``gain``.
    """
    curved = arc.cosine * _beyond_sine(span) - arc.sine * _beyond_cosine(span)
    once = 0.5 * (arc.level + arc.sine) * span * span + curved
    if arc.second == 0.0:
        return once
    x = 2.0 * span
    curved = arc.cosine_2 * _beyond_sine(x) - arc.sine_2 * _beyond_cosine(x)
    return once + 0.5 * arc.sine_2 * span * span + 0.25 * curved


def _beyond_sine(x: float) -> float:
    """Return x - sin x; by its series where the difference would lose digits."""
    if abs(x) > SERIES:
        return x - 2.0 * math.sin(0.5 * x) * math.cos(0.5 * x)
    y = x * x
    tail = 1.0 - y / 72.0 * (1.0 - y / 110.0 * (1.0 - y / 156.0))
    return x * y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * tail))


def _beyond_cosine(x: float) -> float:
    """Return x^2 / 2 - 1 + cos x; by its series where the difference would lose digits."""
    if abs(x) > SERIES:
        half = math.sin(0.5 * x)
        return 0.5 * x * x - 2.0 * half * half  # a power of 2 has other last bits where it is compiled
    y = x * x
    tail = 1.0 - y / 90.0 * (1.0 - y / 132.0 * (1.0 - y / 182.0))
    return y * y / 24.0 * (1.0 - y / 30.0 * (1.0 - y / 56.0 * tail))
