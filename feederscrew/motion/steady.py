"""The steady motion: where a motion settles, its period and averages, and one cycle of it drawn out.

A motion repeats after some periods, or slides on and never does; one setting may have several.
Source: own; docs/conveying.md, "How it is computed".
"""

import enum
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints
from feederscrew.motion import limits
from feederscrew.motion import point_motion as motion
from feederscrew.motion.operating_point import (
    FLIGHT,
    FORWARD,
    STICK,
    Law,
    OperatingPoint,
    contact,
    law,
    throw_number,
)
from feederscrew.motion.point_motion import State, at_rest, step, turn
from feederscrew.motion.waves import PERIOD_RAD, Harmonic, Wave, harmonic, onward, peak, travel, value


class MotionStatus(enum.StrEnum):
    """Degree to which a motion is known; files print the word."""

    PERIODIC = "periodic"
    AVERAGED = "averaged"  # it does not repeat: an average
    NO_STEADY_STATE = "no steady state"


LONGEST_PERIOD = 32
TRANSIENT = 400  # periods followed before a motion is hastened, or counts as not periodic
EQUAL_STATES_GAP = 1e-12  # difference of two states at which the motion counts as repeating
JOINING_STATES_GAP = 1e-9  # of two states: from here a motion goes over into a known one
RESTING = -1.0  # in place of the height of a part on the plate
FIRST_LEAP = 4  # period
LEAST_LEAP = 1e-11  # [A w] change in a period below which no leap is worth its trial
LONGEST_LEAP = 10.0  # [A w] of a series that hardly falls the rest is all rounding
JOINS = -2  # in place of a period: the motion has become one that is known
RUNS = -1  # in place of a period: the part slides on without stopping and does not slow down
LEAPS = 200  # of a motion that closes in slowly
SPEED_BRACKET = 1e-13  # [A w] width of the bracket of its speed at which it is found
MAX_RUNAWAY_SPEED = 1e6  # [A w] no bracket is sought beyond
STATUSES = tuple(MotionStatus)  # a status code is a place in this list
PERIODIC = STATUSES.index(MotionStatus.PERIODIC)
AVERAGED = STATUSES.index(MotionStatus.AVERAGED)
NO_STEADY_STATE = STATUSES.index(MotionStatus.NO_STEADY_STATE)
# places in a row of results
STATUS = 0
PERIOD = 1
VELOCITY = 2  # [A w]
LOW = 3  # [A w] least velocity over the starts
HIGH = 4  # [A w]
FRACTIONS = 5  # of the time, in each of the four phases
FLIGHT_TIME = 9  # [periods] longest flight
IMPACT = 10  # [A w] hardest impact
HOPS = 11  # flights a period
SLOWEST = 12  # [A w] velocity in the slowest period of the drive
FASTEST = 13  # [A w]
THROW = 14  # throw number
REGIME = 15  # place in ``limits.POINT_REGIMES``
RUNAWAY = 16  # 1 where a part that slides fast enough runs away
COLUMNS = 17  # numbers in a row
AVERAGED_PERIODS = 32  # periods of a lot, where there is no period
AVERAGED_LOTS = 8  # lots averaged
BRIEF_PERIODS = 64  # periods followed where the first start has no period
BRIEF_LOTS = 4  # lots averaged then
MAX_NOTED_STATES = 64  # states of steady motions that are noted, for further starts to join
RUNAWAY_LOTS = 16  # averages taken of a part that would run away once it slid all the time, until it does
ALTERNATING_STATES_GAP = 1e-8  # of two states: what closes in from alternate sides repeats doubly first
DROP_FLIGHTS = (1.5,)  # flights [periods] of the drops among the starts
MAX_BOUNCE_PERIODS = 3  # periods of the longest regular bounce among the starts
BOUNCE_SPEED_FACTOR = 1.001  # such starts are too fast by this: exactly on it an unstable bounce would last
MAX_TRACED_PERIODS = 4
TRACE_SAMPLES = 240  # a period; every phase has at least a few


class Memory(NamedTuple):
    """Arrays that following a part takes, filled anew by each."""

    tally: Floats  # (11,) as ``turn`` adds to it
    history: Floats  # (33, 3) states at the starts of the last periods; read no further back than written
    streak: Floats  # (33,) how often in a row the state came back after so many periods
    states: Floats  # (64, 3) ``noted`` of steady motions, the first of them
    row: Floats  # (17,) results of a further start


def memory() -> Memory:
    """Return the arrays, empty, that following a part takes."""
    size = LONGEST_PERIOD + 1
    return Memory(
        np.zeros(motion.TALLY),
        np.zeros((size, 3)),
        np.zeros(size),
        np.zeros((MAX_NOTED_STATES, 3)),
        np.zeros(COLUMNS),
    )


def settle(rules: Law, state: State) -> tuple[State, int]:
    """Follow a part until its state repeats every q periods of the drive, twice in a row.

    The motion along the normal does not depend on the speed along the track. If it repeats every q periods,
    and the part has slid through q periods without stopping or turning round and is no slower after them, the
    next q periods add as much: the part slides on and never settles.

    Parameters
    ----------
    rules : Law
    state : State

    Returns
    -------
    State
        At the start of a period.
    int
        q, ``RUNS``, or 0 where none up to ``LONGEST_PERIOD`` was found.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    return follow(rules, state, memory(), 0, TRANSIENT)


def follow(rules: Law, state: State, arrays: Memory, noticed: int, patience: int) -> tuple[State, int]:
    """Follow a part as ``settle`` does, or to where it joins a known motion.

    Parameters
    ----------
    rules : Law
    state : State
    arrays : Memory
    noticed : int
        Number of states of known motions in ``arrays``.
    patience : int
        Periods followed before the motion is hastened, or counts as not periodic.

    Returns
    -------
    State
    int
        As in ``settle``, or ``JOINS``.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    tally, history, streak = arrays.tally, arrays.history, arrays.streak
    _clear(tally)
    _clear(streak)
    sliding, sense, size = 0, 0.0, LONGEST_PERIOD + 1
    # Whether friction is the same at the onset of a slip as during it, both ways, and not zero. Then two
    # parts whose motions along the normal are the same never get farther apart in speed along the track, and
    # one motion along the normal has one velocity.
    even = rules.onset.level == rules.slip.level and rules.onset_back.level == rules.slip_back.level
    even = even and min(rules.kinetic, rules.kinetic_back) > 0.0
    for count in range(patience):
        state = _on(rules, state, 1, tally)
        # for how many periods in a row it has slid without stopping or turning round, and which way
        up, down = tally[motion.UPWARD] > 0.0, tally[motion.DOWNWARD] > 0.0
        now = 1.0 if up else (-1.0 if down else 0.0)
        if tally[motion.STOPS] > 0.0 or (up and down):
            sliding, sense = 0, 0.0
        elif now * sense < 0.0:
            sliding, sense = 1, now
        else:
            sliding, sense = sliding + 1, sense if now == 0.0 else now
        # the periods after which the state came back for the second time running
        for q in range(1, min(count, LONGEST_PERIOD) + 1):
            distance = abs(state.speed - history[(count - q) % size, 0])
            if distance <= EQUAL_STATES_GAP:
                distance = _normal_apart(history, (count - q) % size, state)
            streak[q] = streak[q] + 1.0 if distance <= EQUAL_STATES_GAP else 0.0
            if streak[q] == 2.0:
                return state, RUNS if sliding >= q and sense != 0.0 else q
        row = count % size
        history[row, 0], history[row, 1], history[row, 2] = state.speed, state.height, state.rising
        for q in range(1, min(count, sliding, LONGEST_PERIOD) + 1 if sense != 0.0 else 0):
            # it has slid for some periods and comes back along the normal, but maybe faster
            then = (count - q) % size
            if _normal_apart(history, then, state) <= EQUAL_STATES_GAP:
                if sense * (state.speed - history[then, 0]) > EQUAL_STATES_GAP:
                    return state, RUNS
                break
        # one of a known motion; with even friction the motion along the normal tells
        height, rising, speed = noted(state)
        for k in range(noticed):
            distance = max(abs(arrays.states[k, 0] - height), abs(arrays.states[k, 1] - rising))
            joins = even or abs(arrays.states[k, 2] - speed) <= JOINING_STATES_GAP
            if distance <= JOINING_STATES_GAP and joins:
                return state, JOINS
        if even and count >= FIRST_LEAP:
            before, state = state.speed, _leap(rules, history, count, state, tally)
            if state.speed != before:
                sliding, sense = 0, 0.0  # what it slid before the leap says nothing
                history[row, 0] = state.speed
    return _hasten(rules, state, history, patience - 1, tally)


def noted(state: State) -> tuple[float, float, float]:
    """Return a state at the start of a period: height [A], velocity along the normal [A w], speed [A w]."""
    return (state.height if state.phase == FLIGHT else RESTING), state.rising, state.speed


def _clear(numbers: Floats) -> None:
    for k in range(len(numbers)):
        numbers[k] = 0.0


def _leap(rules: Law, history: Floats, count: int, state: State, tally: Floats) -> State:
    """Return the state, or where its speed tends to while the motion along the normal repeats every period.

    Three speeds in a row tell (Aitken). The leap is kept where the speed then changes less than before it: a
    period is followed to see.
    """
    newest, before = (count - 1) % (LONGEST_PERIOD + 1), (count - 2) % (LONGEST_PERIOD + 1)
    if (
        _normal_apart(history, newest, state) > EQUAL_STATES_GAP
        or _normal_apart(history, before, state) > EQUAL_STATES_GAP
    ):
        return state
    first, second = history[newest, 0] - history[before, 0], state.speed - history[newest, 0]
    if not (0.0 < second * first < first * first and abs(second) > LEAST_LEAP):
        return state
    beyond = second * second / (first - second)  # the rest of a geometric series
    if abs(beyond) > LONGEST_LEAP:
        return state
    leap = _at_speed(rules, state, state.speed + beyond)
    change = _on(rules, leap, 1, tally).speed - leap.speed
    return leap if abs(change) < abs(second) else state


def _normal_apart(history: Floats, row: int, state: State) -> float:
    """Return how far the motion along the normal is from a former one [A and A w]."""
    return max(abs(state.height - history[row, 1]), abs(state.rising - history[row, 2]))


def _hasten(rules: Law, state: State, history: Floats, count: int, tally: Floats) -> tuple[State, int]:
    """Find the steady motion of a part whose motion along the normal repeats, but whose speed changes slowly.

    Over whole periods the speed is carried on by a function of one number that keeps the order of speeds, so
    it tends to the first fixed point in its way: that is bracketed by doubling the step, then closed in on
    by the secant rule in its Illinois form. Its period is that along the normal, 0 for none.
    """
    period, size = 0, LONGEST_PERIOD + 1
    for q in range(1, LONGEST_PERIOD):
        distance = 0.0
        for cycle in range(2):  # twice in a row
            now, then = (count - cycle) % size, (count - cycle - q) % size
            distance = max(distance, abs(history[now, 1] - history[then, 1]))
            distance = max(distance, abs(history[now, 2] - history[then, 2]))
        if distance <= EQUAL_STATES_GAP:
            period = q
            break
    step = _on(rules, state, period, tally).speed - state.speed
    if step == 0.0:
        return state, period
    near, rise, far, fall = state.speed, step, state.speed, step
    while fall * rise > 0.0:
        near, rise = far, fall
        far = near + step
        fall = _on(rules, _at_speed(rules, state, far), period, tally).speed - far
        if (_runs(tally) and fall * rise > 0.0 and fall * far > 0.0) or abs(step) > MAX_RUNAWAY_SPEED:
            return state, RUNS
        step *= 2.0
    side = 0
    for _ in range(LEAPS):
        if abs(far - near) <= SPEED_BRACKET or fall == 0.0:
            break
        middle = far - fall * (far - near) / (fall - rise)
        gained = _on(rules, _at_speed(rules, state, middle), period, tally).speed - middle
        if gained * rise > 0.0:
            near, rise = middle, gained
            fall = 0.5 * fall if side == 1 else fall
            side = 1
        else:
            far, fall = middle, gained
            rise = 0.5 * rise if side == -1 else rise
            side = -1
    return _at_speed(rules, state, far), period


def _at_speed(rules: Law, state: State, speed: float) -> State:
    """Return the state at another speed along the track."""
    phase = FLIGHT if state.phase == FLIGHT else contact(rules, state.angle, speed)
    return State(state.angle, phase, speed, state.height, state.rising, state.aloft)


def _on(rules: Law, state: State, periods: int, tally: Floats) -> State:
    """Return the state after some periods, stops and contacts counted."""
    tally[motion.STOPS], tally[motion.UPWARD], tally[motion.DOWNWARD] = 0.0, 0.0, 0.0
    for _ in range(periods):
        state = turn(rules, state, tally)
    return state


def _runs(tally: Floats) -> bool:
    """Return whether a part slid one way whenever it touched the plate."""
    return tally[motion.STOPS] == 0.0 and (tally[motion.UPWARD] > 0.0) != (tally[motion.DOWNWARD] > 0.0)


def steady(rules: Law, state: State, out: Floats, arrays: Memory, count: int, patience: int) -> int:
    """Fill in the steady motion reached from one start.

    Parameters
    ----------
    rules : Law
    state : State
        The start.
    out : (17,) float [1, periods, A w]
        Filled up to ``FASTEST``, but not where the motion is known already.
    arrays : Memory
    count : int
        Number of states of known motions in ``arrays``.
    patience : int
        As in ``follow``.

    Returns
    -------
    int
        Number of states of known motions now.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    tally, states = arrays.tally, arrays.states
    state, repeat = follow(rules, state, arrays, count, patience)
    if repeat == RUNS:
        _nothing(out)
    elif repeat > 0:  # averages over the periods after which it repeats; the least of them is its period
        start, period = state, repeat
        _clear(tally)
        out[SLOWEST], out[FASTEST] = math.inf, -math.inf
        for k in range(1, repeat + 1):
            state = _noted_turn(rules, state, tally, out)
            if count < MAX_NOTED_STATES:
                states[count, 0], states[count, 1], states[count, 2] = noted(state)
                count += 1
            if k < period and repeat % k == 0:
                distance = max(abs(state.speed - start.speed), abs(state.height - start.height))
                if max(distance, abs(state.rising - start.rising)) <= ALTERNATING_STATES_GAP:
                    period = k
        out[STATUS], out[PERIOD] = PERIODIC, period
        _averages(out, tally, float(repeat))
        out[LOW] = out[HIGH] = out[VELOCITY]
        if period == 1:
            out[SLOWEST] = out[FASTEST] = out[VELOCITY]
    elif repeat == 0:  # over lots of periods, unless the part slides through them all and gets faster
        lots = AVERAGED_LOTS if patience == TRANSIENT else BRIEF_LOTS
        for _ in range(RUNAWAY_LOTS):
            _clear(tally)
            travelled, first = 0.0, state.speed
            low, high = math.inf, -math.inf
            out[SLOWEST], out[FASTEST] = math.inf, -math.inf
            for _ in range(lots):
                for _ in range(AVERAGED_PERIODS):
                    state = _noted_turn(rules, state, tally, out)
                velocity = (tally[motion.TRAVEL] - travelled) / (AVERAGED_PERIODS * PERIOD_RAD)
                travelled, low, high = tally[motion.TRAVEL], min(low, velocity), max(high, velocity)
            out[STATUS], out[PERIOD], out[LOW], out[HIGH] = AVERAGED, 0.0, low, high
            _averages(out, tally, float(AVERAGED_PERIODS * lots))
            runs_away = _runs(tally) and (state.speed - first) * state.speed > 0.0
            if runs_away:
                _nothing(out)
            if runs_away or _escape(rules) <= 0.0:
                break
    return count


def _noted_turn(rules: Law, state: State, tally: Floats, out: Floats) -> State:
    """Return the state a period later; the range of velocities in single periods grows by its own."""
    travelled = tally[motion.TRAVEL]
    state = turn(rules, state, tally)
    velocity = (tally[motion.TRAVEL] - travelled) / PERIOD_RAD
    out[SLOWEST], out[FASTEST] = min(out[SLOWEST], velocity), max(out[FASTEST], velocity)
    return state


def _escape(rules: Law) -> float:
    """Return how fast a part that slides all the time gains speed [A w a radian], the greater of both ways.

    Positive where a part that once slides fast enough gets faster without end, 0 where it keeps its speed.
    Impacts pass on what the weight would have in the time of the flight, so flight does not matter.
    """
    return max(rules.slip.level, rules.slip_back.level)


def keeps_speed(rules: Law) -> bool:
    """Return whether no force along the track acts on a part: without friction, on the level.

    It keeps whatever speed it arrives with, so that no velocity is the steady one.
    """
    return rules.onset.level == 0.0 and rules.onset_back.level == 0.0


def _averages(out: Floats, tally: Floats, periods: float) -> None:
    out[VELOCITY] = tally[motion.TRAVEL] / (periods * PERIOD_RAD)
    for phase in range(4):
        out[FRACTIONS + phase] = tally[motion.TIMES + phase] / (periods * PERIOD_RAD)
    out[FLIGHT_TIME], out[IMPACT] = tally[motion.LONGEST] / PERIOD_RAD, tally[motion.HARDEST]
    out[HOPS] = tally[motion.FLIGHTS] / periods


def _nothing(out: Floats) -> None:
    for place in range(THROW):
        out[place] = np.nan
    out[STATUS], out[PERIOD] = NO_STEADY_STATE, 0.0


def survey(setting: OperatingPoint, out: Floats, arrays: Memory) -> None:
    """Fill a row: the steady motion from rest, and the range of velocity over further starts.

    Where impacts rebound, several steady motions may exist at one setting. Parts are then thrown near regular
    bounces and dropped as well, and what they settle into widens the range.

    Parameters
    ----------
    setting : OperatingPoint
    out : (17,) float [1, periods, A w]
        Filled: as in ``steady`` from rest, NaN without a steady state; the throw number; the regime of a part
        held by static friction within a cycle; whether a part that slides fast enough runs away, 1 or 0.
    arrays : Memory

    Returns
    -------
    None

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    rules = law(setting)
    out[THROW] = throw_number(rules)
    if out[THROW] >= 1.0 - limits.HOP_ROUNDING:
        out[REGIME] = limits.HOP
    else:
        forward = limits.FORWARD if peak(rules.onset) > 0.0 else limits.RIDE
        out[REGIME] = forward + (limits.BACKWARD if peak(rules.onset_back) > 0.0 else limits.RIDE)
    if keeps_speed(rules):
        _nothing(out)
        out[RUNAWAY] = 1.0
        return
    count = steady(rules, at_rest(rules), out, arrays, 0, TRANSIENT)
    if out[STATUS] == NO_STEADY_STATE:
        out[RUNAWAY] = 1.0
        return
    out[RUNAWAY] = 1.0 if _escape(rules) >= 0.0 else 0.0
    if setting.restitution == 0.0:
        return
    # Further starts: what they lead to widens the range of the velocity.
    other = arrays.row
    _clear(other)
    patience = TRANSIENT if out[STATUS] == PERIODIC else BRIEF_PERIODS
    for start in range(2 * MAX_BOUNCE_PERIODS + len(DROP_FLIGHTS)):
        state = thrown(rules, start)
        if state.rising > 0.0:
            other[STATUS], other[LOW], other[HIGH] = PERIODIC, out[LOW], out[HIGH]
            count = steady(rules, state, other, arrays, count, patience)
            if other[STATUS] == NO_STEADY_STATE:
                out[RUNAWAY] = 1.0
            else:
                out[LOW], out[HIGH] = min(out[LOW], other[LOW]), max(out[HIGH], other[HIGH])


def thrown(rules: Law, start: int) -> State:
    """Return start number ``start``: near a regular bounce, or dropped onto the plate at mid stroke.

    A regular bounce of n periods keeps its speed at impact if the plate then moves up
    with pi n (g / w) (1 - e) / (1 + e).

    Parameters
    ----------
    rules : Law
    start : int
        0 and 1 are a bounce of one period, at either place where the plate slows down through that speed (a
        plain drive has one); 2 to 5 are bounces of two and three periods; 6 is the drop.

    Returns
    -------
    State
        In flight; ``rising`` [A w] is zero where there is no such bounce.

    References
    ----------
    Own; docs/conveying.md, "How it is computed".
    """
    weight = -rules.lift.level
    if start < 2 * MAX_BOUNCE_PERIODS:
        flight = start // 2 + 1.0
        needed = math.pi * flight * weight * (1.0 - rules.restitution) / (1.0 + rules.restitution)
        falls = _plate_speed(rules.lift, needed).falls
        angle = falls[0] if start % 2 == 0 else falls[1]
        if angle == math.inf:
            return State(0.0, FLIGHT, 0.0, 0.0, 0.0, 0.0)
    else:
        flight, angle = DROP_FLIGHTS[start - 2 * MAX_BOUNCE_PERIODS], math.pi
    rising = math.pi * flight * weight - value(_plate_speed(rules.lift, 0.0), angle)
    return State(angle, FLIGHT, 0.0, 0.0, BOUNCE_SPEED_FACTOR * rising, 0.0)


def _plate_speed(lift: Harmonic, less: float) -> Harmonic:
    """Return the velocity of the plate along its normal, less a constant [A w], as a harmonic."""
    once, twice, half = lift.phase, lift.second_phase, 0.5 * lift.second
    sine, cosine = -lift.swing * math.sin(once), lift.swing * math.cos(once)
    return harmonic(Wave(-less, sine, cosine, -half * math.sin(twice), half * math.cos(twice)))


@dataclass(frozen=True, eq=False)
class CycleTrace:
    """Plate and part over a cycle; ways in units of the amplitude."""

    time: Floats  # (N,) [periods]
    phase: Ints  # (N,) places in ``operating_point.PHASES``
    plate_along: Floats  # (N,) along the track
    part_along: Floats
    plate_normal: Floats  # (N,) along its normal
    part_normal: Floats


def trace(setting: OperatingPoint) -> CycleTrace:
    """Return the steady cycle a part falls into from rest, of four periods at most.

    Of a motion without a period they are the last ones followed.
    """
    rules = law(setting)
    state, period = settle(rules, at_rest(rules))
    pieces, tally = [], np.zeros(motion.TALLY)
    for count in range(min(period, MAX_TRACED_PERIODS) if period > 0 else MAX_TRACED_PERIODS):
        while state.angle < PERIOD_RAD:
            before = tally[motion.TRAVEL]
            after = step(rules, state, tally)
            # Time, phase, way relative to the plate and height in one phase, sampled to both of its ends.
            span = after.angle - state.angle
            samples = np.linspace(0.0, span, max(2, round(TRACE_SAMPLES * span / PERIOD_RAD)))
            sign = 1.0 if state.phase in (FORWARD, FLIGHT) else -1.0
            growth = {STICK: None, FORWARD: rules.slip, FLIGHT: rules.free}.get(state.phase, rules.slip_back)
            slip, height = np.full_like(samples, before), np.zeros_like(samples)
            if growth is not None:
                arc = onward(growth, state.angle)
                slip += [state.speed * x + sign * travel(arc, x) for x in samples]
            if state.phase == FLIGHT:
                arc = onward(rules.lift, state.angle)
                height += [state.height + state.rising * x + travel(arc, x) for x in samples]
            time = count + (state.angle + samples) / PERIOD_RAD
            pieces.append(np.stack([time, np.full_like(samples, state.phase), slip, height]))
            state = after
        state = state._replace(angle=0.0)
    time, phase, slip, height = np.concatenate(pieces, axis=1)
    # The plate, along and square to the track: two harmonics, each in a direction of its own.
    first, second = setting.angle, setting.angle + setting.second_turn
    ways = []
    for cosine, lead in ((np.cos, setting.lead), (np.sin, 0.0)):
        angle = PERIOD_RAD * time + lead
        overtone = setting.second * np.sin(2.0 * angle + setting.second_phase)
        ways.append(cosine(first) * np.sin(angle) + cosine(second) * overtone)
    along, normal = ways
    columns = (time, phase.astype(int), along, along + slip, normal, normal + height)
    return CycleTrace(*(check.frozen(array) for array in columns))
