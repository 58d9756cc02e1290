"""Velocity of a part that sticks and slips on a surface shaken along one line, over one settled period."""

from dataclasses import dataclass

import numpy as np

SAMPLES = 360  # of one period
MOST_PERIODS = 200
SETTLED = 1e-9  # of the greatest speed: a period that changes less has settled


@dataclass(frozen=True, eq=False)
class Cycle:
    """One period, N samples from phase 0."""

    velocity: np.ndarray  # (N, ...) [m/s] relative to the surface
    settled: bool  # whether the period repeats itself


def phases(samples=SAMPLES):
    """Phases w t of one period, (samples,) [rad]; the upper reversal is at a quarter."""
    return 2.0 * np.pi * np.arange(samples) / samples


def settle(forward, backward, starts_forward, starts_backward, period):
    """Follow a part from rest until its velocity repeats every period.

    Parameters
    ----------
    forward, backward : (N, ...) float [m/s2]
        Relative acceleration while it slips forward and backward, at ``phases(N)``.
    starts_forward, starts_backward : (N, ...) bool
        Whether a part at rest breaks loose.
    period : float [s]

    Returns
    -------
    Cycle

    Notes
    -----
    Trapezoidal steps; a slip that ends within a step ends at rest. The mean velocity converges with the
    square of the step.
    """
    step = period / len(forward)
    gain = step * 0.5 * (forward + np.roll(forward, -1, axis=0))
    loss = step * 0.5 * (backward + np.roll(backward, -1, axis=0))
    velocity = np.zeros(forward.shape)
    now = np.zeros(forward.shape[1:])
    for _ in range(MOST_PERIODS):
        before = now
        for k in range(len(forward)):
            velocity[k] = now
            now = _stepped(now, gain[k], loss[k], starts_forward[k], starts_backward[k])
        settled = np.abs(now - before).max() <= SETTLED * np.abs(velocity).max()
        if settled:
            break
    velocity.setflags(write=False)
    return Cycle(velocity, bool(settled))


def swing(acceleration, period):
    """Velocity of a part that nothing brings to rest, as one that rolls: its swing about no net motion.

    Parameters
    ----------
    acceleration : (N, ...) float [m/s2]
        At ``phases(N)``.
    period : float [s]

    Returns
    -------
    Cycle
        Whatever velocity it began with comes on top.
    """
    gain = period / len(acceleration) * 0.5 * (acceleration + np.roll(acceleration, -1, axis=0))
    velocity = np.cumsum(gain - np.mean(gain, axis=0), axis=0)
    velocity = np.roll(velocity, 1, axis=0)
    return Cycle(velocity - np.mean(velocity, axis=0), True)


def mean(values):
    """Mean over one period of samples along axis 0; exact for the trapezoidal rule."""
    return np.mean(values, axis=0)


def _stepped(now, gain, loss, starts_forward, starts_backward):
    """Velocity one step on."""
    onward = (now > 0.0) | ((now == 0.0) & starts_forward)
    back = ~onward & ((now < 0.0) | ((now == 0.0) & starts_backward))
    slipped = np.where(onward, np.maximum(now + gain, 0.0), np.minimum(now + loss, 0.0))
    return np.where(onward | back, slipped, 0.0)
