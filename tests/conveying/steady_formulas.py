"""Steady motions that have a formula: what the event integration is tested against."""

import math

from feederscrew.mechanics import limits

PRECISION = 1e-15


def two_burst_velocity(ratio, angle, climb, friction):
    """Return the mean velocity of a part that slips forward once, back once, and sticks in between.

    Parameters
    ----------
    ratio : float [1]
        A w^2 / g.
    angle, climb : float [rad]
        Vibration angle to the track; climb of the track, unbanked.
    friction : float [1]
        Static and kinetic.

    Returns
    -------
    float [A w]
        NaN where the part hops, or one slip runs into the other.

    Notes
    -----
    With p = onset ratio / ratio of each slip, a slip of relative acceleration sin t - p starts at
    asin p and ends at its t2; the coefficients are its accelerations' amplitudes.
    """
    forward = float(limits.forward_ratio(friction, angle, climb=climb)) / ratio
    backward = float(limits.backward_ratio(friction, angle, climb=climb)) / ratio
    (start, end), (start_back, end_back) = _burst(forward), _burst(backward)
    overlap = end > math.pi + start_back or math.pi + end_back > 2.0 * math.pi + start
    if overlap or limits.hops(ratio, angle, climb):
        return math.nan
    push, lift = math.cos(angle), friction * math.sin(angle)
    return (push + lift) * _way(forward, start, end) - (push - lift) * _way(backward, start_back, end_back)


def grazing_flight(throw):
    """Return the length [periods] of the flight just above throw number 1; the error is of higher order."""
    return 4.0 * math.sqrt(2.0 * (throw - 1.0)) / (2.0 * math.pi)


def ideal_throw_velocity(periods, angle, climb, frequency, gravity):
    """Return the velocity of a part that grips on landing, does not rebound and is thrown once a period.

    Parameters
    ----------
    periods : float
        Length of the flight, at most 1.
    angle, climb : float [rad]
    frequency : float [Hz]
    gravity : float [m/s2]

    Returns
    -------
    float [m/s]
    """
    return 0.5 * gravity * periods**2 / frequency * math.cos(angle + climb) / math.sin(angle)


def bounce_window(periods, restitution):
    """Return the throw numbers between which a part can go on bouncing with the same flight each time.

    Parameters
    ----------
    periods : int
        Length of that flight.
    restitution : float [1]

    Returns
    -------
    (float, float) [1]
        Where the bounce appears, and where it gives way to others.
    """
    e = restitution
    least = math.pi * periods * (1.0 - e) / (1.0 + e)
    return least, math.hypot(least, 2.0 * (1.0 + e * e) / (1.0 + e) ** 2)


def elliptical_velocity(throw, steepness=0.0):
    """Compute the velocity of an elliptical drive with a quarter period between its motions.

    Parameters
    ----------
    throw : float [1]
        Throw number k, at most 1.
    steepness : float [1]
        tan(climb) over friction.

    Returns
    -------
    float
        Over A w cos(angle), in the limit of small friction times tan(angle), the motion along the track ahead
        of the one along the normal: cos a with a + k sin a = (pi/2)(1 + steepness).
    """
    wanted = 0.5 * math.pi * (1.0 + steepness)
    low, high = 0.0, math.pi
    while low < 0.5 * (low + high) < high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle + throw * math.sin(middle) < wanted else (low, middle)
    return math.cos(low)


def _burst(p):
    """Start and end [rad] of a slip of relative acceleration sin t - p; nothing for p above 1."""
    if p >= 1.0:
        return math.inf, -math.inf
    start = math.asin(p)
    low, high = math.pi - start, start + 2.0 * math.pi
    while high - low > PRECISION * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        moving = math.cos(start) - math.cos(middle) > p * (middle - start)
        low, high = (middle, high) if moving else (low, middle)
    return start, low


def _way(p, start, end):
    """Way made in a slip over the 2 pi of a period."""
    if end < start:
        return 0.0
    span = end - start
    way = math.sin(start) - math.sin(end) + math.cos(start) * span - 0.5 * p * span * span
    return way / (2.0 * math.pi)
