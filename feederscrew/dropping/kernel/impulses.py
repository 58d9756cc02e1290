"""Compiled impulses of all contacts together: at impacts, and in steps on the floor.

Of one or two contacts that press and slip a few steps suffice where sweeps take many. While the directions of
the slips are known, so is the friction of each contact as a share of what presses it, and the latter solves
linear equations. A step on the floor changes a slip by little beside itself: the directions settle at once.
There ``last`` of a contact holds its impulse (x, y, z) for a unit of what presses it, and ``change`` the
rates that this gives; where impulses are swept for, its impulse a sweep ago and what the one before changed.
"""

import math

from feederscrew.dropping.kernel.body import energy, keep, moves_of, set_moves
from feederscrew.dropping.kernel.floor_contacts import (
    ahead_lever,
    ahead_rate,
    aside_lever,
    aside_rate,
    coupling,
    masses,
    point_speed,
    push,
    speeds,
    spun,
    up_lever,
    up_rate,
    up_speed,
)
from feederscrew.geometry.compiled import compiled, outlined

MAX_DIRECTION_CHANGES = 6  # after which the sweeps take over
SWEEPS_PER_LEAP = 6  # sweeps from one leap to the next
STRAIGHT_COSINE2 = 0.95**2  # squared cosine between two changes that lead the same way
MAX_LEAP = 1000.0  # a leap, in changes of a sweep


@compiled
def stick(state, row, friction):
    """Hold one contact still by an impulse [sqrt(g L)]; return whether friction can."""
    ahead, aside, rise = speeds(state, row)
    u, v, w = -ahead, -aside, row.wanted - rise
    x, y, z = ahead_lever(row), aside_lever(row), up_lever(row)
    p, q, r = ahead_rate(row), aside_rate(row), up_rate(row)
    xx, yy, zz = 1.0 + coupling(x, p), 1.0 + coupling(y, q), 1.0 + coupling(z, r)
    xy, xz, yz = coupling(x, q), coupling(x, r), coupling(y, r)
    yx, zx, zy = coupling(y, p), coupling(z, p), coupling(z, q)
    a, b, c = yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx
    whole = xx * a + xy * b + xz * c
    along = (a * u + (xz * zy - xy * zz) * v + (xy * yz - xz * yy) * w) / whole
    across = (b * u + (xx * zz - xz * zx) * v + (xz * yx - xx * yz) * w) / whole
    up = (c * u + (xy * zx - xx * zy) * v + (xx * yy - xy * yx) * w) / whole
    most = friction * up
    holds = up >= 0.0 and along * along + across * across <= most * most
    if holds:
        push(state, row, along, across, up)
    return holds


@compiled
def relax(row, friction, moves):
    """Do one projected Gauss-Seidel step on a contact; return velocities [sqrt(g L)] and rates (6,)."""
    u, v, w, p, q, r = moves
    x, y, z = row.ahead_impulse, row.aside_impulse, row.up_impulse
    up = max(z + row.up_mass * (row.wanted - point_speed(w, up_lever(row), (p, q, r))), 0.0)
    w += up - z
    p, q, r = spun((p, q, r), up_rate(row), up - z)
    ahead = x - row.floor_mass * point_speed(u, ahead_lever(row), (p, q, r))
    aside = y - row.floor_mass * point_speed(v, aside_lever(row), (p, q, r))
    size, most = ahead * ahead + aside * aside, friction * up
    if size > most * most:
        scale = most / math.sqrt(size)
        ahead, aside = scale * ahead, scale * aside
    u += ahead - x
    p, q, r = spun((p, q, r), ahead_rate(row), ahead - x)
    v += aside - y
    p, q, r = spun((p, q, r), aside_rate(row), aside - y)
    row.ahead_impulse, row.aside_impulse, row.up_impulse = ahead, aside, up
    return u, v, w, p, q, r


@compiled
def note_change(contacts, count):
    """Keep what the last sweep changed of the impulses [sqrt(g L)] of contacts (N,), and the impulses."""
    for n in range(count):
        row = contacts[n]
        row.ahead_change = row.ahead_impulse - row.ahead_last
        row.aside_change = row.aside_impulse - row.aside_last
        row.up_change = row.up_impulse - row.up_last
        row.ahead_last, row.aside_last, row.up_last = row.ahead_impulse, row.aside_impulse, row.up_impulse


@compiled
def leap(contacts, count):
    """Return how often [1] the last sweep's change may be repeated before a contact pulls; 0 for never.

    Two sweeps that change the impulses the same way tell the rest of the geometric series (Aitken). Of two
    corners side by side the impulse creeps from one to the other, by as much in every sweep.
    """
    both = before = now = 0.0
    most = MAX_LEAP
    for n in range(count):
        row = contacts[n]
        a, b = row.ahead_impulse - row.ahead_last, row.aside_impulse - row.aside_last
        c = row.up_impulse - row.up_last
        both = both + a * row.ahead_change + b * row.aside_change + c * row.up_change
        before = before + row.ahead_change * row.ahead_change + row.aside_change * row.aside_change
        before += row.up_change * row.up_change
        now = now + a * a + b * b + c * c
        if c < 0.0:
            most = min(most, -row.up_impulse / c)
    if both <= 0.0 or both * both < STRAIGHT_COSINE2 * before * now:
        return 0.0
    return min(most, both / (before - both)) if both < before else most


@outlined
def solve(state, contacts, count, friction, sweeps, converged):
    """Give contacts (N,) impulses [sqrt(g L)] with Coulomb friction: they leave as wanted or faster.

    One or two contacts directly where that goes; else swept from the impulses that the contacts hold, until
    a whole sweep changes the body's velocities by no more than ``converged`` of what presses it: between many
    contacts impulses may creep on for long.
    """
    if count == 1 and stick(state, contacts[0], friction):
        return
    if count > 2 or not slide(state, contacts, count, friction, converged):
        sweep(state, contacts, count, friction, sweeps, converged)


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


@compiled
def sweep(state, contacts, count, friction, sweeps, converged):
    """Give contacts (N,) impulses [sqrt(g L)] by projected Gauss-Seidel sweeps, from what they hold."""
    for n in range(count):
        row = contacts[n]
        masses(row)
        push(state, row, row.ahead_impulse, row.aside_impulse, row.up_impulse)
    u, v, w, p, q, r = moves_of(state)
    for turn in range(sweeps):
        if turn % SWEEPS_PER_LEAP >= SWEEPS_PER_LEAP - 2:
            note_change(contacts, count)
        a, b, c, d, e, f = u, v, w, p, q, r
        size = 0.0
        for n in range(count):
            u, v, w, p, q, r = relax(contacts[n], friction, (u, v, w, p, q, r))
            size += contacts[n].up_impulse
        change = abs(u - a) + abs(v - b) + abs(w - c)
        change += abs(p - d) + abs(q - e) + abs(r - f)
        if change <= converged * size:
            break
        if turn % SWEEPS_PER_LEAP == SWEEPS_PER_LEAP - 1:
            on = leap(contacts, count)
            for n in range(count):
                row = contacts[n]
                row.ahead_impulse += on * (row.ahead_impulse - row.ahead_last)
                row.aside_impulse += on * (row.aside_impulse - row.aside_last)
                row.up_impulse += on * (row.up_impulse - row.up_last)
            u, v, w = u + on * (u - a), v + on * (v - b), w + on * (w - c)
            p, q, r = p + on * (p - d), q + on * (q - e), r + on * (r - f)
    set_moves(state, (u, v, w, p, q, r))


@compiled
def strike(inertia, state, saved, contacts, count, restitution, friction, steps):
    """Do an impact: contacts (N,) that approach faster than the threshold [sqrt(g L)] rebound."""
    before = energy(state, inertia)
    keep(state, saved)
    for trial in range(4):
        bounce = restitution * (1.0 - trial / 3.0)  # less where friction would make Newton's rule win energy
        for n in range(count):
            row = contacts[n]
            fall = up_speed(state, row)
            row.wanted = -bounce * fall if fall < -steps.threshold else 0.0
            row.ahead_impulse = row.aside_impulse = row.up_impulse = 0.0
        solve(state, contacts, count, friction, steps.sweeps, steps.converged)
        if energy(state, inertia) <= before + 1e-12:
            return
        keep(saved, state)


@compiled
def steepest(state, contacts, count):
    """Return the upward speed [sqrt(g L)] of that of the contacts (N,) which falls fastest."""
    fall = math.inf
    for n in range(count):
        fall = min(fall, up_speed(state, contacts[n]))
    return fall


@compiled
def hold(state, contacts, count, friction, steps, share):
    """Give contacts (N,) impulses [sqrt(g L)] that let nothing fall further, without rebound."""
    for n in range(count):
        row = contacts[n]
        row.wanted = 0.0
        row.ahead_impulse *= share
        row.aside_impulse *= share
        row.up_impulse *= share
        row.ahead_last = row.aside_last = row.up_last = 0.0
        row.ahead_change = row.aside_change = row.up_change = 0.0
    solve(state, contacts, count, friction, steps.sweeps, steps.converged)
