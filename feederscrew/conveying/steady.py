"""The steady motion: its period, its averages, and how many of them one setting has."""

import math

import numpy as np

from feederscrew.conveying.harmonic import harmonic, peak, value
from feederscrew.conveying.law import law, throw_number
from feederscrew.conveying.motion import FLIGHTS, HARDEST, LONGEST, TALLY, TIMES, TRAVEL, State, at_rest, turn
from feederscrew.conveying.setting import FLIGHT, TURN
from feederscrew.conveying.waves import Wave
from feederscrew.mechanics import limits

PERIODIC, AVERAGED, NO_STEADY_STATE = range(3)
STATUSES = ("periodic", "averaged", "no steady state")
STATUS, PERIOD, VELOCITY, LOW, HIGH, FRACTIONS = range(6)  # places in a row of results
FLIGHT_TIME, IMPACT, HOPS, THROW, REGIME, COLUMNS = range(FRACTIONS + 4, FRACTIONS + 10)
LONGEST_PERIOD = 32
TRANSIENT = 400  # periods allowed before a motion counts as not periodic
BLOCK, BLOCKS = 32, 8  # periods averaged then, and in how many lots their spread is taken
SAME = 1e-12  # difference of two states at which the motion counts as repeating
ALIKE = (
    1e-8  # the same for a shorter period: a motion that closes in from alternate sides repeats doubly first
)
RUNAWAY = 20.0  # [A w] no steady motion is this fast: a part above it slides for ever
DROPS = (1.5,)  # flights [periods] of the drops among the starts
BOUNCES = 3  # periods of the longest regular bounce among the starts
OFF = 1.001  # such starts are this much too fast: exactly on it, even an unstable bounce would last


def settle(rules, state):
    """Follow a part until its state repeats every q periods of the drive, twice in a row.

    Parameters
    ----------
    rules : Law
    state : State

    Returns
    -------
    (State, int)
        State at the start of a period of the drive; q, or 0 where none up to 32 was found.
    """
    tally = np.zeros(TALLY)
    history = np.full((LONGEST_PERIOD + 1, 3), np.inf)
    streak = np.zeros(LONGEST_PERIOD + 1, dtype=np.int64)
    for count in range(TRANSIENT):
        state = turn(rules, state, tally)
        period = _repeats(history, streak, count, state)
        if period:
            return state, period
    return state, 0


def _repeats(history, streak, count, state):
    """Periods after which the state came back for the second time running, or 0; notes the state."""
    for q in range(1, min(count, LONGEST_PERIOD) + 1):
        then = (count - q) % (LONGEST_PERIOD + 1)
        apart = abs(state.speed - history[then, 0])
        if apart <= SAME:
            apart = max(abs(state.height - history[then, 1]), abs(state.rising - history[then, 2]))
        streak[q] = streak[q] + 1 if apart <= SAME else 0
        if streak[q] == 2:
            return q
    row = count % (LONGEST_PERIOD + 1)
    history[row, 0], history[row, 1], history[row, 2] = state.speed, state.height, state.rising
    return 0


def steady(rules, state, out):
    """Steady motion reached from one start.

    Parameters
    ----------
    rules : Law
    state : State
    out : (14,) float
        Filled with status, period, velocity and its spread [A w], fraction of the time in each phase,
        longest flight [periods], hardest impact [A w], flights a period.
    """
    state, repeat = settle(rules, state)
    start, period = state, repeat
    tally, way = np.zeros(TALLY), 0.0
    length = repeat if repeat else BLOCK * BLOCKS
    block = repeat if repeat else BLOCK
    low, high = math.inf, -math.inf
    for count in range(1, length + 1):
        state = turn(rules, state, tally)
        if count < period and repeat % count == 0 and _apart(state, start) <= ALIKE:
            period = count
        if count % block == 0:
            velocity = (tally[TRAVEL] - way) / (block * TURN)
            way, low, high = tally[TRAVEL], min(low, velocity), max(high, velocity)
    runaway = not repeat and abs(state.speed) > RUNAWAY
    out[STATUS] = PERIODIC if repeat else (NO_STEADY_STATE if runaway else AVERAGED)
    out[PERIOD], out[LOW], out[HIGH] = period, low, high
    _averages(out, tally, float(length))


def _apart(one, other):
    return max(abs(one.speed - other.speed), abs(one.height - other.height), abs(one.rising - other.rising))


def _averages(out, tally, periods):
    out[VELOCITY] = tally[TRAVEL] / (periods * TURN)
    for phase in range(4):
        out[FRACTIONS + phase] = tally[TIMES + phase] / (periods * TURN)
    out[FLIGHT_TIME], out[IMPACT] = tally[LONGEST] / TURN, tally[HARDEST]
    out[HOPS] = tally[FLIGHTS] / periods


def survey(setting, out):
    """Steady motion from rest and, where impacts rebound, from several throws; the range of their velocities.

    Parameters
    ----------
    setting : Setting
    out : (14,) float
        As ``steady`` fills it from rest, its spread widened to all starts; NaN without a steady state.
        Then the throw number and the regime.
    """
    rules = law(setting)
    out[THROW], out[REGIME] = throw_number(rules), regime(rules)
    if rules.slip.level >= 0.0 or rules.slip_back.level >= 0.0:
        _nothing(out)
        return
    steady(rules, at_rest(rules), out)
    if out[STATUS] == NO_STEADY_STATE:
        _nothing(out)
    elif setting.restitution > 0.0:
        _widen(rules, out)


def _nothing(out):
    out[:THROW] = np.nan
    out[STATUS], out[PERIOD] = NO_STEADY_STATE, 0.0


def regime(rules):
    """What a part that is held by static friction does within a cycle, a place in ``limits.REGIMES``."""
    if throw_number(rules) >= 1.0 - limits.ROUNDING:
        return limits.HOP
    forward = limits.FORWARD if peak(rules.onset) > 0.0 else limits.RIDE
    return forward + (limits.BACKWARD if peak(rules.onset_back) > 0.0 else limits.RIDE)


def _widen(rules, out):
    other = np.empty(COLUMNS)
    for start in range(2 * BOUNCES + len(DROPS)):
        state = thrown(rules, start)
        if state.rising > 0.0:
            steady(rules, state, other)
            out[LOW], out[HIGH] = min(out[LOW], other[LOW]), max(out[HIGH], other[HIGH])


def thrown(rules, start):
    """Start number ``start``: near a regular bounce, or dropped onto the plate at mid stroke.

    Parameters
    ----------
    rules : Law
    start : int
        0 and 1 for a bounce of one period, at either place where the plate slows down through the speed that
        keeps it up (a plain drive has one); 2 to 5 for two and three periods; 6 for the drop.

    Returns
    -------
    State
        In flight; with ``rising`` zero where there is no such bounce.
    """
    weight = -rules.lift.level
    if start < 2 * BOUNCES:
        flight = start // 2 + 1.0
        needed = math.pi * flight * weight * (1.0 - rules.restitution) / (1.0 + rules.restitution)
        falls = plate_speed(rules.lift, needed).falls
        angle = falls[0] if start % 2 == 0 else falls[1]
        if angle == math.inf:
            return State(0.0, FLIGHT, 0.0, 0.0, 0.0, 0.0)
    else:
        flight, angle = DROPS[start - 2 * BOUNCES], math.pi
    rising = math.pi * flight * weight - value(plate_speed(rules.lift, 0.0), angle)
    return State(angle, FLIGHT, 0.0, 0.0, OFF * rising, 0.0)


def plate_speed(lift, less):
    """Velocity of the plate along its normal, less a constant [A w], as a harmonic."""
    once, twice, half = lift.phase, lift.second_phase, 0.5 * lift.second
    sine, cosine = -lift.swing * math.sin(once), lift.swing * math.cos(once)
    return harmonic(Wave(-less, sine, cosine, -half * math.sin(twice), half * math.cos(twice)))
