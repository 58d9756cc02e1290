"""Where a phase ends: every root is bracketed where the sought function is monotone or of one curvature."""

import math

from feederscrew.conveying.harmonic import above, after, gain, onward, reached, travel, value
from feederscrew.conveying.setting import TURN

TIE = 1e-12  # [rad] an event this little in the past is happening now
CLOSE = 1e-14  # relative size of a last Newton step
STEPS = 80
LATE = 10  # steps


def later(zeros, now):
    """Return the first of two angles [rad], ascending, still to come in this period; inf otherwise."""
    if zeros[0] >= now - TIE:
        return max(zeros[0], now)
    return max(zeros[1], now) if zeros[1] >= now - TIE else math.inf


def slip_end(a, angle, speed):
    """Return the first angle of this period at which a slip ends.

    Source: own; docs/conveying.md, "How it is computed".

    Parameters
    ----------
    a : Harmonic
        Growth of the speed.
    angle : float [rad]
        Now. A slip that starts from rest grows first, and ends only after that.
    speed : float [A w]
        Size of the relative velocity.

    Returns
    -------
    float [rad]
        inf where it lasts beyond the period.
    """
    closing = speed > 0.0 and value(a, angle) < 0.0
    start, arc = angle if closing else later(a.falls, angle), onward(a, angle)
    while start < TURN:
        end = min(after(a.rises, start), TURN)
        if speed + gain(arc, end - angle) <= 0.0:
            steepest = (1.5 * math.pi - a.phase - angle) % TURN
            return angle + _stop(arc, speed, start - angle, end - angle, steepest)
        start = later(a.falls, end)
    return math.inf


def _stop(arc, speed, low, high, steepest):
    """Span after which a speed that only falls from ``low`` to ``high`` is zero.

    Where it falls steepest its curvature changes sign: from there Newton approaches from one side. With a
    second harmonic it may change sign again, so late steps that are not half the last give way to halving.
    """
    x, last = min(max(steepest, low), high), math.inf
    for count in range(STEPS):
        left, slope = speed + gain(arc, x), reached(arc, x)
        if abs(left) <= -slope * CLOSE * x:
            return x - left / slope
        if left > 0.0:
            low = x
        else:
            high = x
        new = x - left / slope if slope < 0.0 else low
        if not low < new < high or (count > LATE and abs(new - x) > 0.5 * last):
            new = 0.5 * (low + high)
        x, last = new, abs(new - x)
    return x


def landing(lift, angle, height, speed):
    """Return the first angle of this period at which a flight ends.

    Source: own; docs/conveying.md, "How it is computed".

    Parameters
    ----------
    lift : Harmonic
        Relative acceleration along the normal.
    angle : float [rad]
        Now.
    height : float [A]
        Over the plate; zero at a take-off.
    speed : float [A w]
        Relative velocity along the normal; not negative at a take-off.

    Returns
    -------
    float [rad]
        inf where the flight lasts beyond the period.
    """
    start, arc = angle, onward(lift, angle)
    while start < TURN:
        hollow = above(lift, start)
        end = min(after(lift.falls if hollow else lift.rises, start), TURN)
        if hollow:
            down = _dip(arc, height, speed, start - angle, end - angle)
        else:
            down = _descent(arc, height, speed, end - angle)
        if down < math.inf:
            return angle + down
        start = end
    return math.inf


def _descent(arc, height, speed, end):
    """Span to the landing on a stretch curved downwards: Newton from beyond it never passes it."""
    if height + speed * end + travel(arc, end) > 0.0:
        return math.inf
    x = end
    if height == 0.0 and speed > 0.0:
        x = _beyond_bounce(arc, speed, end)
    for _ in range(STEPS):
        step = (height + speed * x + travel(arc, x)) / (speed + gain(arc, x))
        x -= step
        if abs(step) <= CLOSE * x:
            break
    return x


def _beyond_bounce(arc, speed, end):
    """A span just beyond a bounce, from its parabola: bounces may be a millionth of the stretch."""
    x = 2.0 * speed / max(-reached(arc, 0.0), speed)
    while x < end and speed * x + travel(arc, x) > 0.0:
        x *= 2.0
    return min(x, end)


def _dip(arc, height, speed, start, end):
    """Span to the landing on a stretch curved upwards: Newton from before it never passes it."""
    x = start
    for _ in range(STEPS):
        sinking = speed + gain(arc, x)
        if sinking >= 0.0:
            return math.inf
        step = (height + speed * x + travel(arc, x)) / sinking
        x -= step
        if x > end:
            return math.inf
        if abs(step) <= CLOSE * x:
            break
    return x
