"""From event to event: ride, slide, fly, land; and a whole period of the drive."""

import math
from typing import NamedTuple

from feederscrew.conveying.events import landing, later, slip_end
from feederscrew.conveying.harmonic import gain, onward, travel, value
from feederscrew.conveying.law import contact
from feederscrew.conveying.setting import BACKWARD, FLIGHT, FORWARD, STICK, TURN

TRAVEL, TIMES, LONGEST, HARDEST, FLIGHTS = 0, 1, 5, 6, 7  # places in a tally; TIMES holds one per phase
STOPS, UPWARD, DOWNWARD = 8, 9, 10  # how often it came to rest on the plate, and slid or landed each way
TALLY = 11
SETTLED = 1e-6  # [rad] a bounce that would last twice this ends endless bouncing: an error of second order
EVENTS = 100_000  # in one period


class State(NamedTuple):
    """Part relative to plate."""

    angle: float  # [rad] of the drive, from 0 to 2 pi
    phase: int
    speed: float  # [A w] along the track
    height: float  # [A] over the plate
    rising: float  # [A w] along the normal
    aloft: float  # [rad] since take-off


def at_rest(rules):
    """Return a part lying on the plate at mid stroke."""
    return State(0.0, contact(rules, 0.0, 0.0), 0.0, 0.0, 0.0, 0.0)


def turn(rules, state, tally):
    """Follow the part to the end of this period of the drive.

    Source: docs/conveying.md, "How it is computed".

    Parameters
    ----------
    rules : Law
    state : State
    tally : (11,) float [as follows]
        Way made [A], time in each phase [rad], longest flight [rad], hardest impact [A w], number of flights,
        of times at rest on the plate, of slips and landings up the track and of those down; the one array
        that is added to in place, because the loops over it are compiled.

    Returns
    -------
    State
        With its clock set back by one period.
    """
    for _ in range(EVENTS):
        if state.angle >= TURN:
            break
        state = step(rules, state, tally)
    return State(0.0, state.phase, state.speed, state.height, state.rising, state.aloft)


def step(rules, state, tally):
    """Follow the part to its next event, or to the end of this period; adds to ``tally`` (11,)."""
    if state.phase == FLIGHT:
        return _fly(rules, state, tally)
    if state.phase == STICK:
        return _ride(rules, state, tally)
    return _slide(rules, state, tally)


def _ride(rules, state, tally):
    now = state.angle
    lift, ahead = later(rules.lift.rises, now), later(rules.onset.rises, now)
    back = later(rules.onset_back.rises, now)
    end = min(lift, ahead, back, TURN)
    phase = STICK
    if lift == end:
        phase = FLIGHT
    elif ahead == end:
        phase = FORWARD
    elif back == end:
        phase = BACKWARD
    tally[TIMES + STICK] += end - now
    tally[STOPS] += 1.0
    return State(end, phase, 0.0, 0.0, 0.0, 0.0)


def _slide(rules, state, tally):
    now = state.angle
    sign = 1.0 if state.phase == FORWARD else -1.0
    growth = rules.slip if state.phase == FORWARD else rules.slip_back
    lift, stop = later(rules.lift.rises, now), slip_end(growth, now, abs(state.speed))
    end = min(lift, stop, TURN)
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


def _fly(rules, state, tally):
    now = state.angle
    down = landing(rules.lift, now, state.height, state.rising)
    end = min(down, TURN)
    span, along, normal = end - now, onward(rules.free, now), onward(rules.lift, now)
    tally[TRAVEL] += state.speed * span + travel(along, span)
    tally[TIMES + FLIGHT] += span
    speed = state.speed + gain(along, span)
    rising = state.rising + gain(normal, span)
    aloft = state.aloft + span
    if down > TURN:
        height = state.height + state.rising * span + travel(normal, span)
        return State(end, FLIGHT, speed, height, rising, aloft)
    tally[LONGEST] = max(tally[LONGEST], aloft)
    tally[HARDEST] = max(tally[HARDEST], -rising)
    tally[FLIGHTS] += 1.0
    landed = land(rules, end, speed, -rising)
    tally[STOPS if landed.speed == 0.0 else (UPWARD if landed.speed > 0.0 else DOWNWARD)] += 1.0
    return landed


def land(rules, angle, speed, impact):
    """Return the state after an impact: restitution (Newton) across the track, Coulomb's bound along it.

    Source: Newton's restitution, Coulomb's law for the impulses; docs/conveying.md, "The model".

    Parameters
    ----------
    rules : Law
    angle : float [rad]
    speed, impact : float [A w]
        Along the track and towards the plate, just before.

    Returns
    -------
    State
    """
    friction = rules.kinetic if speed > 0.0 else rules.kinetic_back
    rebound = rules.restitution * impact
    if rebound <= SETTLED * max(0.0, -value(rules.lift, angle)):
        rebound = (
            0.0  # the endless bounces left out pass on the impulse of a plastic impact and of their time
        )
    loss = min(abs(speed), friction * (impact + rebound))
    speed -= math.copysign(loss, speed)
    phase = FLIGHT if rebound > 0.0 else contact(rules, angle, speed)
    return State(angle, phase, speed, 0.0, rebound, 0.0)
