"""Compiled impulses of one or two contacts that press and slip: a few steps where sweeps take many.

While the directions of the slips are known, so is the friction of each contact as a share of what presses
it, and the latter solves linear equations. A step on the floor changes a slip by little beside itself: the
directions settle at once. In a contact's row LAST holds its impulse (x, y, z) for a unit of what presses it,
and CHANGE the rates that this gives.
"""

import math

from feederscrew.dropping.kernel.floor_contacts import CHANGE, LAST, LEVER, RATE, WANTED, push, speed
from feederscrew.geometry.compiled import compiled

TURNS = 6  # changes of the directions after which the sweeps take over


@compiled
def slide(state, contacts, count, friction, converged):
    """Give impulses [sqrt(g L)] to one or two contacts (N, WIDTH) that press and slip; say if found."""
    first, last = contacts[0], contacts[count - 1]
    for n in range(count):
        aim(contacts[n], friction, speed(state, contacts[n], 0), speed(state, contacts[n], 1))
    for _ in range(TURNS):
        one, other = pressed(state, first, last, count)
        if not (one >= 0.0 and other >= 0.0):
            return False
        change = 0.0
        for n in range(count):
            by = one if n == 0 else other
            change += by * turned(state, contacts[n], first, last, one, other, friction)
        if change <= converged * (one + other):
            for n in range(count):
                for e in range(3):
                    push(state, contacts[n], e, (one if n == 0 else other) * contacts[n, LAST + e])
            return True
    return False


@compiled
def aim(row, friction, ahead, aside):
    """Note the impulse of a contact that slips with a velocity [sqrt(g L)]; return how far it turned [1]."""
    size = math.sqrt(ahead * ahead + aside * aside)
    if size == 0.0:
        return math.inf
    x, y = -friction * ahead / size, -friction * aside / size
    change = abs(x - row[LAST]) + abs(y - row[LAST + 1])
    row[LAST], row[LAST + 1], row[LAST + 2] = x, y, 1.0
    for k in range(3):
        row[CHANGE + k] = x * row[RATE + k] + y * row[RATE + 3 + k] + row[RATE + 6 + k]
    return change


@compiled
def given(row, e, by):
    """Return the velocity [1] of a contact along floor axis e for a unit of what presses another.

    Source: own; docs/resting.md, "The drop test".
    """
    k = LEVER + 3 * e
    return by[LAST + e] + row[k] * by[CHANGE] + row[k + 1] * by[CHANGE + 1] + row[k + 2] * by[CHANGE + 2]


@compiled
def pressed(state, first, last, count):
    """Return the impulse [sqrt(g L)] that makes each contact leave as wanted; 0 where there is no second.

    Source: own; docs/resting.md, "The drop test".
    """
    a, here = given(first, 2, first), first[WANTED] - speed(state, first, 2)
    if count == 1:
        return here / a, 0.0
    b, c, d = given(first, 2, last), given(last, 2, first), given(last, 2, last)
    there = last[WANTED] - speed(state, last, 2)
    whole = a * d - b * c
    return (d * here - b * there) / whole, (a * there - c * here) / whole


@compiled
def turned(state, row, first, last, one, other, friction):
    """Aim a contact, a row (WIDTH,), along the slip that impulses leave; return how far it turned [1]."""
    ahead = speed(state, row, 0) + one * given(row, 0, first) + other * given(row, 0, last)
    aside = speed(state, row, 1) + one * given(row, 1, first) + other * given(row, 1, last)
    return aim(row, friction, ahead, aside)
