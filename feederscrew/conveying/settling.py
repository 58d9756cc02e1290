"""Where a motion settles: after how many periods it repeats, or that it slides on and never does."""

import numpy as np

from feederscrew.conveying.law import contact
from feederscrew.conveying.point_motion import DOWNWARD, STOPS, TALLY, UPWARD, State, turn
from feederscrew.conveying.setting import FLIGHT

LONGEST_PERIOD = 32
TRANSIENT = 400  # periods followed before a motion is hastened, or counts as not periodic
SAME = 1e-12  # difference of two states at which the motion counts as repeating
NEAR = 1e-9  # of two states: from here a motion goes over into a known one
RESTING = -1.0  # in place of the height of a part on the plate
FIRST_LEAP = 4  # period
LEAST_LEAP = 1e-11  # [A w] change in a period below which no leap is worth its trial
LONGEST_LEAP = 10.0  # [A w] of a series that hardly falls the rest is all rounding
JOINS = -2  # in place of a period: the motion has become one that is known
RUNS = -1  # in place of a period: the part slides on without stopping and does not slow down
LEAPS = 200  # of a motion that closes in slowly
CLOSE = 1e-13  # [A w] width of the bracket of its speed at which it is found
FASTEST = 1e6  # [A w] no bracket is sought beyond


def settle(rules, state):
    """Follow a part until its state repeats every q periods of the drive, twice in a row.

    Parameters
    ----------
    rules : Law
    state : State

    Returns
    -------
    (State, int)
        State at the start of a period of the drive; q, ``RUNS``, or 0 where none up to 32 was found.

    Notes
    -----
    What a part does along the normal does not depend on its speed along the track. Once the former repeats
    every q periods, and the part has slid through q periods without stopping or turning round and is no
    slower after them, the next q periods add as much: it slides on and never settles.
    """
    return follow(rules, state, np.empty((0, 3)), TRANSIENT)


def follow(rules, state, known, patience):
    """Follow a part as ``settle`` does, or to where it joins a motion that is known.

    Source: own; docs/conveying.md, "How it is computed".

    Parameters
    ----------
    rules : Law
    state : State
    known : (N, 3) float [A, A w, A w]
        Of ``noted``: states of steady motions at the start of a period.
    patience : int
        Periods followed before the motion is hastened, or counts as not periodic.

    Returns
    -------
    (State, int)
        The number is ``JOINS`` where the motion has become one that is known.
    """
    tally = np.zeros(TALLY)
    history = np.empty((LONGEST_PERIOD + 1, 3))  # read no further back than it is written
    streak = np.zeros(LONGEST_PERIOD + 1)
    sliding, sense, even = 0, 0.0, evenly(rules)
    for count in range(patience):
        state = _on(rules, state, 1, tally)
        sliding, sense = _slid(tally, sliding, sense)
        period = _repeats(history, streak, count, state)
        if period:
            return state, RUNS if sliding >= period and sense != 0.0 else period
        if sense != 0.0 and _grows(history, count, state, sliding, sense):
            return state, RUNS
        if _joins(known, state, even):
            return state, JOINS
        if even and count >= FIRST_LEAP:
            before, state = state.speed, _leap(rules, history, count, state, tally)
            if state.speed != before:
                sliding, sense = 0, 0.0  # what it slid before the leap says nothing
                history[count % (LONGEST_PERIOD + 1), 0] = state.speed
    return _hasten(rules, state, _period_of_normal(history, patience - 1), tally)


def noted(state):
    """Return a state at the start of a period: height [A], velocity along the normal [A w], speed [A w]."""
    return (state.height if state.phase == FLIGHT else RESTING), state.rising, state.speed


def evenly(rules):
    """Tell whether friction is the same at the onset of a slip as during it, both ways, and not zero.

    Then two parts whose motions along the normal are the same never get farther apart in speed along the
    track, and one motion along the normal has one velocity.
    """
    same = rules.onset.level == rules.slip.level and rules.onset_back.level == rules.slip_back.level
    return same and min(rules.kinetic, rules.kinetic_back) > 0.0


def _joins(known, state, even):
    """Whether a state is one of a known motion; with even friction the motion along the normal tells."""
    height, rising, speed = noted(state)
    for k in range(len(known)):
        apart = max(abs(known[k, 0] - height), abs(known[k, 1] - rising))
        if apart <= NEAR and (even or abs(known[k, 2] - speed) <= NEAR):
            return True
    return False


def _leap(rules, history, count, state, tally):
    """The state, or where its speed tends to while the motion along the normal repeats every period.

    Three speeds in a row tell (Aitken). The leap is kept where the speed then changes less than before it:
    a period is followed to see.
    """
    one, two = (count - 1) % (LONGEST_PERIOD + 1), (count - 2) % (LONGEST_PERIOD + 1)
    if _normal_apart(history, one, state) > SAME or _normal_apart(history, two, state) > SAME:
        return state
    first, second = history[one, 0] - history[two, 0], state.speed - history[one, 0]
    if not (0.0 < second * first < first * first and abs(second) > LEAST_LEAP):
        return state
    beyond = second * second / (first - second)  # the rest of a geometric series
    if abs(beyond) > LONGEST_LEAP:
        return state
    leap = _at_speed(rules, state, state.speed + beyond)
    change = _on(rules, leap, 1, tally).speed - leap.speed
    return leap if abs(change) < abs(second) else state


def _slid(tally, sliding, sense):
    """Periods for which a part has now slid without stopping or turning round, and which way."""
    up, down = tally[UPWARD] > 0.0, tally[DOWNWARD] > 0.0
    if tally[STOPS] > 0.0 or (up and down):
        return 0, 0.0
    now = 1.0 if up else (-1.0 if down else 0.0)
    if now * sense < 0.0:
        return 1, now
    return sliding + 1, sense if now == 0.0 else now


def _repeats(history, streak, count, state):
    """Periods after which the state came back for the second time running, or 0; notes the state."""
    for q in range(1, min(count, LONGEST_PERIOD) + 1):
        then = (count - q) % (LONGEST_PERIOD + 1)
        apart = abs(state.speed - history[then, 0])
        if apart <= SAME:
            apart = _normal_apart(history, then, state)
        streak[q] = streak[q] + 1.0 if apart <= SAME else 0.0
        if streak[q] == 2.0:
            return q
    row = count % (LONGEST_PERIOD + 1)
    history[row, 0], history[row, 1], history[row, 2] = state.speed, state.height, state.rising
    return 0


def _normal_apart(history, row, state):
    """How far the motion along the normal is from what it was."""
    return max(abs(state.height - history[row, 1]), abs(state.rising - history[row, 2]))


def _grows(history, count, state, sliding, sense):
    """Whether a part that has slid for some periods comes back along the normal, but faster."""
    for q in range(1, min(count, sliding, LONGEST_PERIOD) + 1):
        then = (count - q) % (LONGEST_PERIOD + 1)
        if _normal_apart(history, then, state) <= SAME:
            return sense * (state.speed - history[then, 0]) > SAME
    return False


def _period_of_normal(history, count):
    """Periods after which the motion along the normal repeats, twice in a row; 0 where it does not."""
    size = LONGEST_PERIOD + 1
    for q in range(1, LONGEST_PERIOD):
        apart = 0.0
        for back in range(2):
            now, then = (count - back) % size, (count - back - q) % size
            apart = max(apart, abs(history[now, 1] - history[then, 1]))
            apart = max(apart, abs(history[now, 2] - history[then, 2]))
        if apart <= SAME:
            return q
    return 0


def _hasten(rules, state, period, tally):
    """Find the steady motion of a part whose motion along the normal repeats, but whose speed changes slowly.

    Parameters
    ----------
    rules : Law
    state : State
    period : int
        Of the motion along the normal; 0 for none.
    tally : (11,) float
        To count with.

    Returns
    -------
    (State, int)
        As ``settle`` returns them.

    Notes
    -----
    Over whole periods the speed is carried on by a function of one number that keeps the order of speeds, so
    it tends to the first fixed point in its way: that is bracketed by doubling the step, then closed in on
    by the secant rule in its Illinois form.
    """
    step = _on(rules, state, period, tally).speed - state.speed
    if step == 0.0:
        return state, period
    near, rise, far, fall = state.speed, step, state.speed, step
    while fall * rise > 0.0:
        near, rise = far, fall
        far = near + step
        fall = _on(rules, _at_speed(rules, state, far), period, tally).speed - far
        if (_runs(tally) and fall * rise > 0.0 and fall * far > 0.0) or abs(step) > FASTEST:
            return state, RUNS
        step *= 2.0
    far = _closed_in(rules, state, period, (near, rise, far, fall), tally)
    return _at_speed(rules, state, far), period


def _closed_in(rules, state, period, bracket, tally):
    """The speed that a period does not change, between two of which one grows and the other does not."""
    near, rise, far, fall = bracket
    side = 0
    for _ in range(LEAPS):
        if abs(far - near) <= CLOSE or fall == 0.0:
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
    return far


def _at_speed(rules, state, speed):
    """The state at another speed along the track."""
    phase = FLIGHT if state.phase == FLIGHT else contact(rules, state.angle, speed)
    return State(state.angle, phase, speed, state.height, state.rising, state.aloft)


def _on(rules, state, periods, tally):
    """The state after some periods, stops and contacts counted."""
    tally[STOPS], tally[UPWARD], tally[DOWNWARD] = 0.0, 0.0, 0.0
    for _ in range(periods):
        state = turn(rules, state, tally)
    return state


def _runs(tally):
    """Whether a part slid all the time, and one way."""
    return tally[STOPS] == 0.0 and (tally[UPWARD] > 0.0) != (tally[DOWNWARD] > 0.0)
