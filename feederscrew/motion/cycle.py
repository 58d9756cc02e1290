"""Velocity of a part that sticks and slips on a surface shaken along one line, over one settled period.

A slip is followed from the phase at which it breaks loose to the one at which it stops, each found as a root;
between them the velocity is integrated by steps of fourth order, halved wherever the acceleration has a kink.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats

PERIOD_SAMPLES = 360  # of one period
PERIOD_PHASE = 2.0 * math.pi
PERIODS_FOLLOWED = 4  # periods followed before the settled one is sought by its velocity at phase 0
MAX_STEP_DOUBLINGS = 40  # of the step that brackets it
VELOCITY_TOLERANCE = 1e-12  # of the greatest speed gained in a period: a velocity this near is found
KINK = 1e-11  # the same: halves of a step that differ by more are halved again
ONSET_HALVINGS = 14
MAX_BRACKETING_STEPS = 60
Acceleration = Callable[[float, float, float], float]  # [m/s2] of phase [rad], velocity [m/s] and sense
Window = tuple[float, float, float]  # phases [rad] from which and to which a part breaks loose, and its sense
Step = tuple[float, float]  # velocity [m/s] after a span of phase, and way


@dataclass(frozen=True, eq=False)
class Cycle:
    """One period, N samples from phase 0."""

    velocity: Floats  # (N, ...) [m/s] relative to the surface
    mean: float  # [m/s] of the whole period, not of the samples
    settled: bool  # whether the period repeats itself


def phases(samples: int = PERIOD_SAMPLES) -> Floats:
    """Return the phases w t of one period; the upper reversal is at a quarter of it.

    Parameters
    ----------
    samples : int

    Returns
    -------
    (samples,) float [rad]
        From 0, without 2 pi.

    References
    ----------
    docs/mechanics.md, "Frames and signs".
    """
    return PERIOD_PHASE * np.arange(samples) / samples


def settle(
    acceleration: Acceleration, windows: Sequence[Window], period: float, samples: int = PERIOD_SAMPLES
) -> Cycle:
    """Follow a part from rest until its velocity repeats every period.

    The velocity after a period is a function of the velocity before it, and this function keeps their order.
    So from rest the velocity tends to the first one that a period leaves as it is. A few periods are
    followed; if the velocity has not settled by then, that fixed point is found as a root.

    Parameters
    ----------
    acceleration : function of phase [rad], velocity [m/s] and sense of sliding
        Acceleration relative to the surface [m/s2]; the sense is +1 or -1.
    windows : sequence of (float, float, float) [rad, rad, 1]
        Phases [rad] from which and to which a part at rest breaks loose, from 0 to 2 pi, ascending, and the
        sense in which it then slides.
    period : float [s]
    samples : int
        Samples in the period.

    Returns
    -------
    Cycle
        Velocity at the samples [m/s] and the mean of the whole period; not settled where the part gets faster
        with every period.

    References
    ----------
    docs/mechanics.md, "The floor". The mean agrees with the two-burst velocity of docs/conveying.md.
    """
    ride = _Ride(acceleration, tuple(windows), period / PERIOD_PHASE, samples)
    speed, scale = 0.0, 0.0
    for _ in range(PERIODS_FOLLOWED):
        velocity, mean = ride.over(speed)
        scale = max(scale, float(np.ptp(velocity)))
        if abs(velocity[-1] - speed) <= VELOCITY_TOLERANCE * scale:
            return Cycle(check.frozen(velocity[:-1]), mean, True)
        speed = float(velocity[-1])

    def gained(before: float) -> float:
        """Return the change of velocity [m/s] in one period."""
        return float(ride.over(before)[0][-1]) - before

    # The settled velocity is the root of ``gained``. A step that doubles brackets it; if none does, the part
    # gets faster with every period.
    near, rise = speed, gained(speed)
    step, far, fall = rise, near, rise
    for _ in range(MAX_STEP_DOUBLINGS):
        if fall * rise <= 0.0:
            break
        near, rise = far, fall
        far, step = far + step, 2.0 * step
        fall = gained(far)
    settled, side = fall * rise <= 0.0, 0
    far = far if settled else speed
    # The secant rule in its Illinois form: the value at an end that stays twice is halved, or the bracket
    # would shrink from one side only.
    for _ in range(MAX_BRACKETING_STEPS if settled else 0):
        if abs(far - near) <= VELOCITY_TOLERANCE * scale or fall == 0.0:
            break
        middle = far - fall * (far - near) / (fall - rise)
        gain = gained(middle)
        if gain * rise > 0.0:
            near, rise, fall, side = middle, gain, 0.5 * fall if side == 1 else fall, 1
        else:
            far, fall, rise, side = middle, gain, 0.5 * rise if side == -1 else rise, -1
    velocity, mean = ride.over(far)
    return Cycle(check.frozen(velocity[:-1]), mean, settled)


def swing(acceleration: Floats, period: float) -> Cycle:
    """Return the velocity of a part that nothing brings to rest, as one that rolls: a swing about zero.

    The velocity is the integral of the acceleration by the trapezoidal rule, less its mean. The velocity with
    which the part began would come on top; it is not known, and friction does not end it.

    Parameters
    ----------
    acceleration : (N, ...) float [m/s2]
        At the phases ``phases(N)``.
    period : float [s]

    Returns
    -------
    Cycle
        (N, ...) float [m/s], settled, of mean 0.

    References
    ----------
    The integral of a harmonic acceleration; docs/mechanics.md, "The floor".
    """
    gain = period / len(acceleration) * 0.5 * (acceleration + np.roll(acceleration, -1, axis=0))
    velocity = np.roll(np.cumsum(gain - np.mean(gain, axis=0), axis=0), 1, axis=0)
    return Cycle(velocity - np.mean(velocity, axis=0), 0.0, True)


class _Ride:
    """Periods, one after another, of a part under a given acceleration."""

    def __init__(
        self, acceleration: Acceleration, windows: Sequence[Window], pace: float, samples: int
    ) -> None:
        self.windows, self.samples = windows, samples
        self.gain = lambda phase, speed, sense: pace * acceleration(phase, speed, sense)  # a radian
        self.kink = KINK * pace * max(abs(acceleration(0.25 * PERIOD_PHASE * k, 0.0, 1.0)) for k in range(4))

    def over(self, speed: float) -> tuple[Floats, float]:
        """Return the velocities (samples + 1,) [m/s] of a period that begins with a speed, and their mean."""
        grid = [PERIOD_PHASE * k / self.samples for k in range(self.samples + 1)]
        speeds, travel = [speed], 0.0
        for now, end in itertools.pairwise(grid):
            more = 0.0
            while now < end:
                until, sense = now, math.copysign(1.0, speed)
                if speed == 0.0:  # where it breaks loose, how long it is loose there, and which way
                    loose = ((s, e, way) for s, e, way in self.windows if now < e and s < end)
                    start, stop, sense = next(loose, (end, end, 0.0))
                    now, until = max(now, start), min(stop, end)
                if now >= end:
                    break
                speed, way, now = self._slip(speed, now, end, until, sense)
                more += way
            travel += more
            speeds.append(speed)
        return np.array(speeds), travel / PERIOD_PHASE

    def _slip(
        self, speed: float, now: float, end: float, until: float, sense: float
    ) -> tuple[float, float, float]:
        """Return velocity, way and phase where a slip stops or the stretch ends.

        The slip does not stop before the phase ``until``: the end of the window in which a part at rest
        breaks loose, the present phase of one that slides already.
        """
        span = end - now
        after, travel = self._step(now, span, speed, sense)
        low = until - now
        if sense * after > 0.0:
            low = span
            slows = speed != 0.0 and sense * self.gain(now, speed, sense) < 0.0
            if slows and sense * self.gain(now + span, speed, sense) > 0.0:
                first = 0.0  # a slip that slows down and then gets faster is slowest here
                for _ in range(MAX_BRACKETING_STEPS):
                    middle = 0.5 * (first + low)
                    slows = sense * self.gain(now + middle, speed, sense) < 0.0
                    first, low = (middle, low) if slows else (first, middle)
            if low >= span or sense * self._step(now, low, speed, sense)[0] > 0.0:
                return after, travel, end
            low, span = 0.0, low
        elif speed == 0.0 and sense * self._step(now, low, 0.0, sense)[0] <= 0.0:
            return 0.0, 0.0, end  # it breaks loose another way than along the line
        high = span  # between one after which it slides and one after which it would not
        for _ in range(MAX_BRACKETING_STEPS):
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            slides = sense * self._step(now, middle, speed, sense)[0] > 0.0
            low, high = (middle, high) if slides else (low, middle)
        return 0.0, self._step(now, low, speed, sense)[1], now + low

    def _step(
        self, now: float, span: float, speed: float, sense: float, whole: Step | None = None, depth: int = 0
    ) -> Step:
        """Return velocity and way after a span: of one step, or of two halves where these differ from it.

        They differ where the acceleration has a kink, as where contact is lost.
        """
        half, begun = 0.5 * span, self.gain(now, speed, sense)
        whole = whole or self._once(now, span, speed, sense, begun)
        first = self._once(now, half, speed, sense, begun)
        last = self._once(now + half, half, first[0], sense)
        if abs(last[0] - whole[0]) > self.kink * span and depth < ONSET_HALVINGS:
            first = self._step(now, half, speed, sense, first, depth + 1)
            last = self._step(now + half, half, first[0], sense, None, depth + 1)
        return last[0], first[1] + last[1]

    def _once(self, now: float, span: float, speed: float, sense: float, begun: float | None = None) -> Step:
        """Return velocity and way after one step of the classical Runge-Kutta rule."""
        half = 0.5 * span
        a = self.gain(now, speed, sense) if begun is None else begun
        b = self.gain(now + half, speed + half * a, sense)
        c = self.gain(now + half, speed + half * b, sense)
        d = self.gain(now + span, speed + span * c, sense)
        return speed + span / 6.0 * (a + 2.0 * (b + c) + d), span * (speed + span / 6.0 * (a + b + c))
