"""From event to event: ride, slide, fly, land; and a whole period of the drive.

Where a phase ends, every root is bracketed where the sought function is monotone or of one curvature.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from feederscrew.base.arrays import Floats
from feederscrew.motion.operating_point import BACKWARD, FLIGHT, FORWARD, STICK, Law, contact
from feederscrew.motion.waves import (
    PERIOD_RAD,
    Harmonic,
    above,
    after,
    gain,
    onward,
    reached,
    travel,
    value,
)

EVENT_TIE_RAD = 1e-12  # [rad] an event this little in the past is happening now
NEWTON_TOLERANCE = 1e-14  # relative size of a last Newton step
MAX_NEWTON_STEPS = 80
LATE_NEWTON_STEPS = 10
LAST_BOUNCE_RAD = 1e-6  # a bounce that would last twice this ends endless bouncing: an error of second order
MAX_EVENTS_A_PERIOD = 100_000
# places in a tally
TRAVEL = 0  # [A] way made
TIMES = 1  # [rad] time in each of the four phases
LONGEST = 5  # [rad] longest flight
HARDEST = 6  # [A w] hardest impact
FLIGHTS = 7  # number of flights
STOPS = 8  # how often the part came to rest on the plate
UPWARD = 9  # how often it slid or landed up the track
DOWNWARD = 10  # the same down the track
TALLY = 11  # numbers in a tally


def later(zeros: Sequence[float], now: float) -> float:
    """Return the first of two angles that is still to come in this period.

    Parameters
    ----------
    zeros : (2,) float [rad]
        Ascending.
    now : float [rad]

    Returns
    -------
    float [rad]
        ``now`` for an angle that rounding has put a little into the past; inf if none is to come.
    """
    if zeros[0] >= now - EVENT_TIE_RAD:
        return max(zeros[0], now)
    return max(zeros[1], now) if zeros[1] >= now - EVENT_TIE_RAD else math.inf


def slip_end(a: Harmonic, angle: float, speed: float) -> float:
    """Return the first angle of this period at which a slip ends.

    A slip from rest gets faster first, and ends only after that. Where the speed falls steepest its curvature
    changes sign: from there Newton's method approaches from one side. With a second harmonic it may change
    sign again, so late steps that are not half the last give way to halving.

    Parameters
    ----------
    a : Harmonic
        Growth of the speed [A w^2].
    angle : float [rad]
        Where the slip is now.
    speed : float [A w]
        There; not negative.

    Returns
    -------
    float [rad]
        inf where the slip lasts beyond the period.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    closing = speed > 0.0 and value(a, angle) < 0.0
    start, arc = angle if closing else later(a.falls, angle), onward(a, angle)
    while start < PERIOD_RAD:
        end = min(after(a.rises, start), PERIOD_RAD)
        if speed + gain(arc, end - angle) > 0.0:
            start = later(a.falls, end)
            continue
        low, high, last = start - angle, end - angle, math.inf
        x = min(max((1.5 * math.pi - a.phase - angle) % PERIOD_RAD, low), high)
        for count in range(MAX_NEWTON_STEPS):
            left, slope = speed + gain(arc, x), reached(arc, x)
            if abs(left) <= -slope * NEWTON_TOLERANCE * x:
                return angle + (x - left / slope)
            if left > 0.0:
                low = x
            else:
                high = x
            new = x - left / slope if slope < 0.0 else low
            if not low < new < high or (count > LATE_NEWTON_STEPS and abs(new - x) > 0.5 * last):
                new = 0.5 * (low + high)
            x, last = new, abs(new - x)
        return angle + x
    return math.inf


def landing(lift: Harmonic, angle: float, height: float, speed: float) -> float:
    """Return the first angle of this period at which a flight ends.

    Newton's method never passes the landing: it comes from beyond it on a stretch curved downwards, from
    before it on one curved upwards.

    Parameters
    ----------
    lift : Harmonic
        Acceleration along the normal, relative to the plate [A w^2].
    angle : float [rad]
        Where the flight is now.
    height : float [A]
        Over the plate, zero at a take-off.
    speed : float [A w]
        Along the normal, not negative at a take-off.

    Returns
    -------
    float [rad]
        inf where the flight lasts beyond the period.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    start, arc = angle, onward(lift, angle)
    while start < PERIOD_RAD:
        hollow = above(lift, start)
        end = min(after(lift.falls if hollow else lift.rises, start), PERIOD_RAD)
        x, most = start - angle, end - angle
        lands = hollow or height + speed * most + travel(arc, most) <= 0.0
        if lands and not hollow:
            x = most
            if height == 0.0 and speed > 0.0:
                # A span just beyond a bounce, from its parabola: bounces may be a millionth of the stretch.
                x = 2.0 * speed / max(-reached(arc, 0.0), speed)
                while x < most and speed * x + travel(arc, x) > 0.0:
                    x *= 2.0
                x = min(x, most)
        for _ in range(MAX_NEWTON_STEPS if lands else 0):
            sinking = speed + gain(arc, x)
            if hollow and sinking >= 0.0:
                lands = False
                break
            step = (height + speed * x + travel(arc, x)) / sinking
            x -= step
            if hollow and x > most:
                lands = False
                break
            if abs(step) <= NEWTON_TOLERANCE * x:
                break
        if lands:
            return angle + x
        start = end
    return math.inf


class State(NamedTuple):
    """Part relative to plate."""

    angle: float  # [rad] of the drive, from 0 to 2 pi
    phase: int
    speed: float  # [A w] along the track
    height: float  # [A] over the plate
    rising: float  # [A w] along the normal
    aloft: float  # [rad] since take-off


def at_rest(rules: Law) -> State:
    """Return a part lying on the plate at mid stroke."""
    return State(0.0, contact(rules, 0.0, 0.0), 0.0, 0.0, 0.0, 0.0)


def turn(rules: Law, state: State, tally: Floats) -> State:
    """Follow the part to the end of this period of the drive.

    Parameters
    ----------
    rules : Law
    state : State
    tally : (11,) float [A, rad, A w, 1]
        Added to in place, for the compiled loops: places ``TRAVEL`` to ``DOWNWARD``.

    Returns
    -------
    State
        The clock set back by one period.

    References
    ----------
    docs/conveying.md, "How it is computed".
    """
    for _ in range(MAX_EVENTS_A_PERIOD):
        if state.angle >= PERIOD_RAD:
            break
        state = step(rules, state, tally)
    return State(0.0, state.phase, state.speed, state.height, state.rising, state.aloft)


def step(rules: Law, state: State, tally: Floats) -> State:
    """Follow the part to its next event, or to the end of this period.

    Parameters
    ----------
    rules : Law
    state : State
    tally : (11,) float [A, rad, A w, 1]
        Added to in place.

    Returns
    -------
    State

    References
    ----------
    docs/conveying.md, "How it is computed".
    """
    now = state.angle
    # It sticks until the plate falls away, or the drive pulls it loose up or down the track.
    if state.phase == STICK:
        lift, ahead = later(rules.lift.rises, now), later(rules.onset.rises, now)
        onset = later(rules.onset_back.rises, now)
        end = min(lift, ahead, onset, PERIOD_RAD)
        phase = STICK
        if lift == end:
            phase = FLIGHT
        elif ahead == end:
            phase = FORWARD
        elif onset == end:
            phase = BACKWARD
        tally[TIMES + STICK] += end - now
        tally[STOPS] += 1.0
        return State(end, phase, 0.0, 0.0, 0.0, 0.0)
    # It slips until the plate falls away, or its speed is zero.
    if state.phase != FLIGHT:
        sign = 1.0 if state.phase == FORWARD else -1.0
        growth = rules.slip if state.phase == FORWARD else rules.slip_back
        lift, stop = later(rules.lift.rises, now), slip_end(growth, now, abs(state.speed))
        end = min(lift, stop, PERIOD_RAD)
        span, arc = end - now, onward(growth, now)
        tally[TRAVEL] += state.speed * span + sign * travel(arc, span)
        tally[TIMES + state.phase] += span
        tally[UPWARD if state.phase == FORWARD else DOWNWARD] += 1.0
        speed = state.speed + sign * gain(arc, span)
        if lift == end:
            return State(end, FLIGHT, speed, 0.0, 0.0, 0.0)
        if stop == end:
            tally[STOPS] += 1.0
            return State(end, contact(rules, end, 0.0), 0.0, 0.0, 0.0, 0.0)
        return State(end, state.phase, speed, 0.0, 0.0, 0.0)
    # It flies until it lands.
    down = landing(rules.lift, now, state.height, state.rising)
    end = min(down, PERIOD_RAD)
    span, along, normal = end - now, onward(rules.free, now), onward(rules.lift, now)
    tally[TRAVEL] += state.speed * span + travel(along, span)
    tally[TIMES + FLIGHT] += span
    speed, rising = state.speed + gain(along, span), state.rising + gain(normal, span)
    aloft = state.aloft + span
    if down > PERIOD_RAD:
        height = state.height + state.rising * span + travel(normal, span)
        return State(end, FLIGHT, speed, height, rising, aloft)
    tally[LONGEST] = max(tally[LONGEST], aloft)
    tally[HARDEST] = max(tally[HARDEST], -rising)
    tally[FLIGHTS] += 1.0
    landed = land(rules, end, speed, -rising)
    tally[STOPS if landed.speed == 0.0 else (UPWARD if landed.speed > 0.0 else DOWNWARD)] += 1.0
    return landed


def land(rules: Law, angle: float, speed: float, impact: float) -> State:
    """Return the state after an impact: restitution (Newton) across the track, Coulomb's bound along it.

        v_n+ = e v_n-,   |change of v_t| <= mu (1 + e) v_n-

    Parameters
    ----------
    rules : Law
    angle : float [rad]
    speed : float [A w]
        Along the track, just before.
    impact : float [A w]
        v_n-, towards the plate, just before.

    Returns
    -------
    State

    References
    ----------
    docs/conveying.md, "The model".
    """
    friction = rules.kinetic if speed > 0.0 else rules.kinetic_back
    rebound = rules.restitution * impact
    if rebound <= LAST_BOUNCE_RAD * max(0.0, -value(rules.lift, angle)):
        rebound = 0.0  # the bounces left out pass on the impulse of a plastic impact and of their time
    loss = min(abs(speed), friction * (impact + rebound))
    speed -= math.copysign(loss, speed)
    phase = FLIGHT if rebound > 0.0 else contact(rules, angle, speed)
    return State(angle, phase, speed, 0.0, rebound, 0.0)
