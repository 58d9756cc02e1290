"""Compiled impulses of one or two contacts that press and slip: a few steps where sweeps take many.

While the directions of the slips are known, so is the friction of each contact as a share of what presses
it, and the latter solves linear equations. A step on the floor changes a slip by little beside itself: the
directions settle at once. In a contact ``last`` holds its impulse (x, y, z) for a unit of what presses
it, and ``change`` the rates that this gives.
"""

import math

from feederscrew.dropping.kernel.floor_contacts import (
    ahead_lever,
    aside_lever,
    point_speed,
    push,
    speeds,
    up_lever,
    up_speed,
)
from feederscrew.geometry.compiled import compiled

MAX_DIRECTION_CHANGES = 6  # after which the sweeps take over


@compiled
def slide(state, contacts, count, friction, converged):
    """Give impulses [sqrt(g L)] to one or two contacts (N,) that press and slip; say if they settle."""
    first, last = contacts[0], contacts[count - 1]
    for n in range(count):
        ahead, aside, _ = speeds(state, contacts[n])
        aim(contacts[n], friction, ahead, aside)
    for _ in range(MAX_DIRECTION_CHANGES):
        press, other_press = presses(state, first, last, count)
        if not (press >= 0.0 and other_press >= 0.0):
            return False
        change = 0.0
        for n in range(count):
            by = press if n == 0 else other_press
            change += by * aim_again(state, contacts[n], first, last, press, other_press, friction)
        if change <= converged * (press + other_press):
            for n in range(count):
                row, by = contacts[n], press if n == 0 else other_press
                push(state, row, by * row.ahead_last, by * row.aside_last, by * row.up_last)
            return True
    return False


@compiled
def aim(row, friction, ahead, aside):
    """Note the impulse of a contact that slips with a velocity [sqrt(g L)]; return how far it turned [1]."""
    size = math.sqrt(ahead * ahead + aside * aside)
    if size == 0.0:
        return math.inf
    x, y = -friction * ahead / size, -friction * aside / size
    change = abs(x - row.ahead_last) + abs(y - row.aside_last)
    row.ahead_last, row.aside_last, row.up_last = x, y, 1.0
    row.ahead_change = x * row.ahead_rate_x + y * row.aside_rate_x + row.up_rate_x
    row.aside_change = x * row.ahead_rate_y + y * row.aside_rate_y + row.up_rate_y
    row.up_change = x * row.ahead_rate_z + y * row.aside_rate_z + row.up_rate_z
    return change


@compiled
def unit_rates(row):
    """Return the rates (3,) [1/L] that a unit of what presses a contact gives, with its friction."""
    return row.ahead_change, row.aside_change, row.up_change


@compiled
def presses(state, first, last, count):
    """Return the impulse [sqrt(g L)] that makes each contact leave as wanted; 0 where there is no second.

    Source: own; docs/resting.md, "The drop test".
    """
    a = point_speed(first.up_last, up_lever(first), unit_rates(first))
    here = first.wanted - up_speed(state, first)
    if count == 1:
        return here / a, 0.0
    b = point_speed(last.up_last, up_lever(first), unit_rates(last))
    c = point_speed(first.up_last, up_lever(last), unit_rates(first))
    d = point_speed(last.up_last, up_lever(last), unit_rates(last))
    there = last.wanted - up_speed(state, last)
    whole = a * d - b * c
    return (d * here - b * there) / whole, (a * there - c * here) / whole


@compiled
def aim_again(state, row, first, last, press, other_press, friction):
    """Aim a contact along the slip that the impulses of both leave; return how far it turned [1].

    Source: own; docs/resting.md, "The drop test".
    """
    ahead, aside, _ = speeds(state, row)
    x, y, rates = ahead_lever(row), aside_lever(row), unit_rates(first)
    ahead += press * point_speed(first.ahead_last, x, rates)
    aside += press * point_speed(first.aside_last, y, rates)
    rates = unit_rates(last)
    ahead += other_press * point_speed(last.ahead_last, x, rates)
    aside += other_press * point_speed(last.aside_last, y, rates)
    return aim(row, friction, ahead, aside)
