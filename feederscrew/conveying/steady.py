"""The steady motion: its period, its averages, and how many of them one setting has."""

import math

import numpy as np

from feederscrew.conveying.harmonic import harmonic, peak, value
from feederscrew.conveying.law import law, throw_number
from feederscrew.conveying.point_motion import (
    DOWNWARD,
    FLIGHTS,
    HARDEST,
    LONGEST,
    STOPS,
    TALLY,
    TIMES,
    TRAVEL,
    UPWARD,
    State,
    at_rest,
    turn,
)
from feederscrew.conveying.setting import FLIGHT, TURN
from feederscrew.conveying.settling import RUNS, TRANSIENT, follow, noted
from feederscrew.conveying.waves import Wave
from feederscrew.mechanics import limits

PERIODIC, AVERAGED, NO_STEADY_STATE = range(3)
STATUSES = ("periodic", "averaged", "no steady state")
STATUS, PERIOD, VELOCITY, LOW, HIGH, FRACTIONS = range(6)  # places in a row of results
FLIGHT_TIME, IMPACT, HOPS, SLOWEST, FASTEST = range(FRACTIONS + 4, FRACTIONS + 9)
THROW, REGIME, RUNAWAY, COLUMNS = range(FASTEST + 1, FASTEST + 5)
BLOCK, BLOCKS = 32, 8  # periods averaged where there is no period, and in how many lots their spread is taken
BRIEF, FEW = 64, 4  # periods followed, and lots averaged, of further starts where the first has no period
KNOWN = 64  # states of steady motions that are noted, for further starts to join
LOTS = 16  # averages taken of a part that would run away once it slid all the time, until it does
ALIKE = 1e-8  # of two states: a motion that closes in from alternate sides repeats doubly first
DROPS = (1.5,)  # flights [periods] of the drops among the starts
BOUNCES = 3  # periods of the longest regular bounce among the starts
OFF = 1.001  # such starts are this much too fast: exactly on it, even an unstable bounce would last


def steady(rules, state, out):
    """Return the steady motion reached from one start.

    Source: own; docs/conveying.md, "How it is computed".

    Parameters
    ----------
    rules : Law
    state : State
    out : (17,) float [each as named]
        Filled with status, period, velocity and its spread [A w], fraction of the time in each phase,
        longest flight [periods], hardest impact [A w], flights a period, velocity in the slowest and in the
        fastest period of the drive [A w].
    """
    _steady(rules, state, out, np.empty((KNOWN, 3)), 0, TRANSIENT)


def _steady(rules, state, out, known, count, patience):
    """The same, noting the states of a steady motion; their number with it, unchanged where it was known."""
    state, repeat = follow(rules, state, known[:count], patience)
    if repeat == RUNS:
        _nothing(out)
    elif repeat > 0:
        return _cycle(rules, state, repeat, out, known, count)
    elif repeat == 0:
        _long_run(rules, state, out, BLOCKS if patience == TRANSIENT else FEW)
    return count


def _cycle(rules, state, repeat, out, known, noticed):
    """Averages over the periods after which the motion repeats; the least of them is its period."""
    tally, start, period = np.zeros(TALLY), state, repeat
    out[SLOWEST], out[FASTEST] = math.inf, -math.inf
    for count in range(1, repeat + 1):
        state = _noted_turn(rules, state, tally, out)
        if noticed < KNOWN:
            known[noticed, 0], known[noticed, 1], known[noticed, 2] = noted(state)
            noticed += 1
        if count < period and repeat % count == 0 and _apart(state, start) <= ALIKE:
            period = count
    out[STATUS], out[PERIOD] = PERIODIC, period
    _averages(out, tally, float(repeat))
    out[LOW] = out[HIGH] = out[VELOCITY]
    if period == 1:
        out[SLOWEST] = out[FASTEST] = out[VELOCITY]
    return noticed


def _long_run(rules, state, out, blocks):
    """Averages over lots of periods, unless the part slides through them all and gets faster."""
    for _ in range(LOTS):
        tally, way, first = np.zeros(TALLY), 0.0, state.speed
        low, high = math.inf, -math.inf
        out[SLOWEST], out[FASTEST] = math.inf, -math.inf
        for _ in range(blocks):
            for _ in range(BLOCK):
                state = _noted_turn(rules, state, tally, out)
            velocity = (tally[TRAVEL] - way) / (BLOCK * TURN)
            way, low, high = tally[TRAVEL], min(low, velocity), max(high, velocity)
        out[STATUS], out[PERIOD], out[LOW], out[HIGH] = AVERAGED, 0.0, low, high
        _averages(out, tally, float(BLOCK * blocks))
        if _slid(tally) and (state.speed - first) * state.speed > 0.0:
            _nothing(out)
            break
        if escape(rules) <= 0.0:
            break


def _noted_turn(rules, state, tally, out):
    """The state a period of the drive on; the range of the velocities in single periods grows by its own."""
    way = tally[TRAVEL]
    state = turn(rules, state, tally)
    velocity = (tally[TRAVEL] - way) / TURN
    out[SLOWEST], out[FASTEST] = min(out[SLOWEST], velocity), max(out[FASTEST], velocity)
    return state


def _slid(tally):
    """Whether the part slid one way whenever it touched the plate."""
    return tally[STOPS] == 0.0 and (tally[UPWARD] == 0.0) != (tally[DOWNWARD] == 0.0)


def escape(rules):
    """Return the greatest growth of the speed of a part that slides all the time, up or down the track.

    Source: own; docs/conveying.md, "How it is computed": what a period of sliding adds.

    Parameters
    ----------
    rules : Law

    Returns
    -------
    float [A w a radian of the drive]
        Positive where a part that once slides fast enough gets faster without end. Impacts pass on what the
        weight would have in the time of the flight, so flight does not matter.
    """
    return max(rules.slip.level, rules.slip_back.level)


def _apart(one, other):
    return max(abs(one.speed - other.speed), abs(one.height - other.height), abs(one.rising - other.rising))


def _averages(out, tally, periods):
    out[VELOCITY] = tally[TRAVEL] / (periods * TURN)
    for phase in range(4):
        out[FRACTIONS + phase] = tally[TIMES + phase] / (periods * TURN)
    out[FLIGHT_TIME], out[IMPACT] = tally[LONGEST] / TURN, tally[HARDEST]
    out[HOPS] = tally[FLIGHTS] / periods


def survey(setting, out):
    """Fill a row: steady motion from rest and, where impacts rebound, from throws; their range of velocity.

    Source: own; docs/conveying.md, "How it is computed".

    Parameters
    ----------
    setting : OperatingPoint
    out : (17,) float [as of ``steady``]
        As ``steady`` fills it from rest, its spread widened to all starts; NaN without a steady state.
        Then the throw number, the regime, and whether a part that slides fast enough runs away: 1 or 0.
    """
    rules = law(setting)
    out[THROW], out[REGIME] = throw_number(rules), regime(rules)
    known = np.empty((KNOWN, 3))
    count = _steady(rules, at_rest(rules), out, known, 0, TRANSIENT)
    if out[STATUS] == NO_STEADY_STATE:
        out[RUNAWAY] = 1.0
        return
    out[RUNAWAY] = 1.0 if escape(rules) > 0.0 else 0.0
    if setting.restitution > 0.0:
        _widen(rules, out, known, count)


def _nothing(out):
    for place in range(THROW):
        out[place] = np.nan
    out[STATUS], out[PERIOD] = NO_STEADY_STATE, 0.0


def regime(rules):
    """Return what a part held by static friction does within a cycle, a place [1] in ``limits.REGIMES``.

    Source: Coulomb's law before the first slip; docs/conveying.md, "The model".
    """
    if throw_number(rules) >= 1.0 - limits.ROUNDING:
        return limits.HOP
    forward = limits.FORWARD if peak(rules.onset) > 0.0 else limits.RIDE
    return forward + (limits.BACKWARD if peak(rules.onset_back) > 0.0 else limits.RIDE)


def _widen(rules, out, known, count):
    other = np.zeros(COLUMNS)
    patience = TRANSIENT if out[STATUS] == PERIODIC else BRIEF
    for start in range(2 * BOUNCES + len(DROPS)):
        state = thrown(rules, start)
        if state.rising > 0.0:
            other[STATUS], other[LOW], other[HIGH] = PERIODIC, out[LOW], out[HIGH]
            count = _steady(rules, state, other, known, count, patience)
            if other[STATUS] == NO_STEADY_STATE:
                out[RUNAWAY] = 1.0
            else:
                out[LOW], out[HIGH] = min(out[LOW], other[LOW]), max(out[HIGH], other[HIGH])


def thrown(rules, start):
    """Return start number ``start``: near a regular bounce, or dropped onto the plate at mid stroke.

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
    """Return the velocity of the plate along its normal, less a constant [A w], as a harmonic."""
    once, twice, half = lift.phase, lift.second_phase, 0.5 * lift.second
    sine, cosine = -lift.swing * math.sin(once), lift.swing * math.cos(once)
    return harmonic(Wave(-less, sine, cosine, -half * math.sin(twice), half * math.cos(twice)))
