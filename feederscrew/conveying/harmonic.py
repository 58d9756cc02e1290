"""A constant and one or two sines: the acceleration in every phase, its integrals and its zeros."""

import math
from typing import NamedTuple

from feederscrew.conveying import waves
from feederscrew.conveying.setting import TURN

SERIES = 0.5  # [rad] below it the integrals use their series: the differences would lose digits
GRAZE = 1e-14  # of the swing: a level passed by less is not passed; its two zeros would round to one
INF = math.inf


class Harmonic(NamedTuple):
    """level + swing sin(angle + phase) + second sin(2 angle + second_phase)."""

    level: float
    swing: float
    phase: float  # [rad]
    second: float
    second_phase: float  # [rad]
    rises: tuple[float, float]  # [rad] where it rises through zero, from 0 to 2 pi, ascending; then inf
    falls: tuple[float, float]  # [rad] where it falls through zero


def harmonic(wave):
    """Return a wave by its amplitudes and phases, with its zeros."""
    level = wave.level
    swing, phase = math.hypot(wave.sine, wave.cosine), math.atan2(wave.cosine, wave.sine)
    second, twice = math.hypot(wave.sine_2, wave.cosine_2), math.atan2(wave.cosine_2, wave.sine_2)
    if second > 0.0:
        bends = waves.bends(wave)
        up, down = waves.crossings(wave, bends, 1), waves.crossings(wave, bends, -1)
        return Harmonic(level, swing, phase, second, twice, (up[0], up[1]), (down[0], down[1]))
    if abs(level) >= swing * (1.0 - GRAZE):
        return Harmonic(level, swing, phase, 0.0, 0.0, (INF, INF), (INF, INF))
    crossing = math.asin(-level / swing)
    rise, fall = (crossing - phase) % TURN, (math.pi - crossing - phase) % TURN
    return Harmonic(level, swing, phase, 0.0, 0.0, (rise, INF), (fall, INF))


def peak(a):
    """Return the greatest value of a harmonic, in its own unit: here accelerations [A w2].

    Source: own; docs/conveying.md, "Elliptical drives".
    """
    if a.second == 0.0:
        return a.level + a.swing
    once, twice = a.phase, a.second_phase
    sines = a.swing * math.cos(once), a.swing * math.sin(once)
    twofold = a.second * math.cos(twice), a.second * math.sin(twice)
    return value(a, waves.crest(waves.Wave(a.level, sines[0], sines[1], twofold[0], twofold[1])))


def value(a, angle):
    """Return the harmonic at an angle [rad], in its own unit.

    Source: docs/conveying.md, "Elliptical drives".
    """
    once = a.level + a.swing * math.sin(angle + a.phase)
    return once if a.second == 0.0 else once + a.second * math.sin(2.0 * angle + a.second_phase)


def after(zeros, angle):
    """Return the first of two angles [rad], ascending, beyond another; inf where neither is."""
    if zeros[0] > angle:
        return zeros[0]
    return zeros[1] if zeros[1] > angle else INF


def above(a, angle):
    """Tell by its zeros whether it is positive from an angle [rad] on: at one, its value is only rounding."""
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


def onward(a, start):
    """Return the harmonic from ``start`` [rad] on."""
    sine, cosine = a.swing * math.sin(start + a.phase), a.swing * math.cos(start + a.phase)
    if a.second == 0.0:
        return Arc(a.level, sine, cosine, 0.0, 0.0, 0.0)
    angle = 2.0 * start + a.second_phase
    return Arc(a.level, sine, cosine, a.second, a.second * math.sin(angle), a.second * math.cos(angle))


def reached(arc, span):
    """Return the harmonic after a span [rad], in its own unit.

    Source: the addition theorems, as products of the half span.
    """
    s, c = math.sin(0.5 * span), math.cos(0.5 * span)
    once = arc.level + arc.sine + 2.0 * s * (arc.cosine * c - arc.sine * s)
    if arc.second == 0.0:
        return once
    s, c = math.sin(span), math.cos(span)
    return once + arc.sine_2 + 2.0 * s * (arc.cosine_2 * c - arc.sine_2 * s)


def gain(arc, span):
    """Integrate over a span [rad]: the velocity gained [A w]. As a product, short spans keep their digits.

    Source: the integral of ``value``; docs/conveying.md, "How it is computed".
    """
    s, c = math.sin(0.5 * span), math.cos(0.5 * span)
    once = arc.level * span + 2.0 * s * (arc.sine * c + arc.cosine * s)
    if arc.second == 0.0:
        return once
    s, c = math.sin(span), math.cos(span)
    return once + s * (arc.sine_2 * c + arc.cosine_2 * s)


def travel(arc, span):
    """Integrate twice over a span [rad]: the way made from rest [A].

    Source: the integral of ``gain``; docs/conveying.md, "How it is computed".
    """
    curved = arc.cosine * _beyond_sine(span) - arc.sine * _beyond_cosine(span)
    once = 0.5 * (arc.level + arc.sine) * span * span + curved
    if arc.second == 0.0:
        return once
    x = 2.0 * span
    curved = arc.cosine_2 * _beyond_sine(x) - arc.sine_2 * _beyond_cosine(x)
    return once + 0.5 * arc.sine_2 * span * span + 0.25 * curved


def _beyond_sine(x):
    """x - sin x."""
    if abs(x) > SERIES:
        return x - 2.0 * math.sin(0.5 * x) * math.cos(0.5 * x)
    y = x * x
    tail = 1.0 - y / 72.0 * (1.0 - y / 110.0 * (1.0 - y / 156.0))
    return x * y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * tail))


def _beyond_cosine(x):
    """x^2 / 2 - 1 + cos x."""
    if abs(x) > SERIES:
        return 0.5 * x * x - 2.0 * math.sin(0.5 * x) ** 2
    y = x * x
    tail = 1.0 - y / 90.0 * (1.0 - y / 132.0 * (1.0 - y / 182.0))
    return y * y / 24.0 * (1.0 - y / 30.0 * (1.0 - y / 56.0 * tail))
