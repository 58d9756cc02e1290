"""Compiled contacts of one body with the floor: what an impulse at each point that touches does to it.

A contact is a record of `FLOOR_CONTACT`. Along each floor axis, ahead (x), aside (y) and up (z), it holds the
lever p x e in body axes, from point p, and the rates that one unit of impulse gives, lever / inertia. Where
impulses are swept for it has effective masses, along the floor the smaller that serves both axes. Then come
the upward speed wanted after the impulse, the impulse, what that was a sweep ago, and what the sweep before
changed of it.
"""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import W, moves_of, set_moves
from feederscrew.dropping.kernel.touch import CORNER_OWNER, lowest_on
from feederscrew.geometry.compiled import compiled, record_type

FLOOR_AXES = ("ahead", "aside", "up")
FLOOR_CONTACT = record_type(
    *(f"{axis}_{what}_{e}" for what in ("lever", "rate") for axis in FLOOR_AXES for e in "xyz"),
    "floor_mass", "up_mass", "wanted",
    *(f"{axis}_{what}" for what in ("impulse", "last", "change") for axis in FLOOR_AXES),
)  # fmt: skip


@compiled
def arms(work, count):
    """Fill the levers [L] of ``work.contacts`` (N,) for the points found: their speeds follow."""
    for n in range(count):
        arm(work.turn, work.spots[n], work.contacts[n])


@compiled
def levers(inertia, work, count):
    """Fill the records of ``work.contacts`` (N,) for the points found; inertia (3,) [L2] over mass."""
    arms(work, count)
    for n in range(count):
        rates(inertia, work.contacts[n])


@compiled
def levers_ahead(solid, work, count, dt):
    """Fill the records for a step dt [sqrt(L/g)]: impulses act half of it ahead, speeds are of its end.

    A rim's lowest point travels around it meanwhile.
    """
    body.keep(work.state, work.ahead)
    for half in range(2):
        p, q, r = work.ahead[W], work.ahead[W + 1], work.ahead[W + 2]
        body.rotate(work.ahead, p, q, r, 0.5 * dt)
        body.rotation(work.ahead, work.later)
        for n in range(count):
            spot, k = work.spots[n], work.owners[n]
            if k != CORNER_OWNER:
                x, y, z, _ = lowest_on(solid.rims, k, work.later)
                rim = solid.rims[k]
                if rim[10] < -1.0 or x * rim[7] + y * rim[8] + z * rim[9] >= rim[10]:
                    spot[0], spot[1] = rim[0] + rim[6] * x, rim[1] + rim[6] * y
                    spot[2] = rim[2] + rim[6] * z
            arm(work.later, spot, work.contacts[n])
            if half == 0:
                rates(solid.inertia, work.contacts[n])


@compiled
def _lever(spot, x, y, z):
    return spot[1] * z - spot[2] * y, spot[2] * x - spot[0] * z, spot[0] * y - spot[1] * x


@compiled
def arm(turn, spot, row):
    """Fill the levers [L] of a contact at a spot (3,) [L] in body axes."""
    row.ahead_lever_x, row.ahead_lever_y, row.ahead_lever_z = _lever(spot, turn[0], turn[1], turn[2])
    row.aside_lever_x, row.aside_lever_y, row.aside_lever_z = _lever(spot, turn[3], turn[4], turn[5])
    row.up_lever_x, row.up_lever_y, row.up_lever_z = _lever(spot, turn[6], turn[7], turn[8])


@compiled
def rates(inertia, row):
    """Fill the rates [1/L] of a contact from its levers [L] and the inertia (3,) [L2]."""
    i, j, k = inertia[0], inertia[1], inertia[2]
    row.ahead_rate_x, row.ahead_rate_y = row.ahead_lever_x / i, row.ahead_lever_y / j
    row.aside_rate_x, row.aside_rate_y = row.aside_lever_x / i, row.aside_lever_y / j
    row.up_rate_x, row.up_rate_y = row.up_lever_x / i, row.up_lever_y / j
    row.ahead_rate_z, row.aside_rate_z = row.ahead_lever_z / k, row.aside_lever_z / k
    row.up_rate_z = row.up_lever_z / k


@compiled
def ahead_lever(row):
    """Return the lever (3,) [L] of a contact along the floor's x."""
    return row.ahead_lever_x, row.ahead_lever_y, row.ahead_lever_z


@compiled
def aside_lever(row):
    """Return the lever (3,) [L] of a contact along the floor's y."""
    return row.aside_lever_x, row.aside_lever_y, row.aside_lever_z


@compiled
def up_lever(row):
    """Return the lever (3,) [L] of a contact along the floor's normal."""
    return row.up_lever_x, row.up_lever_y, row.up_lever_z


@compiled
def ahead_rate(row):
    """Return the rates (3,) [1/L] that a unit of impulse of a contact gives along the floor's x."""
    return row.ahead_rate_x, row.ahead_rate_y, row.ahead_rate_z


@compiled
def aside_rate(row):
    """Return the rates (3,) [1/L] that a unit of impulse of a contact gives along the floor's y."""
    return row.aside_rate_x, row.aside_rate_y, row.aside_rate_z


@compiled
def up_rate(row):
    """Return the rates (3,) [1/L] that a unit of impulse of a contact gives along the floor's normal."""
    return row.up_rate_x, row.up_rate_y, row.up_rate_z


@compiled
def masses(row):
    """Fill the effective masses [1] of a contact from its levers and rates."""
    xx = 1.0 + coupling(ahead_lever(row), ahead_rate(row))
    yy = 1.0 + coupling(aside_lever(row), aside_rate(row))
    zz = 1.0 + coupling(up_lever(row), up_rate(row))
    lean, mean, cross = 0.5 * (xx - yy), 0.5 * (xx + yy), coupling(ahead_lever(row), aside_rate(row))
    row.floor_mass = 1.0 / (mean + math.sqrt(lean * lean + cross * cross))
    row.up_mass = 1.0 / zz


@compiled
def coupling(lever, rate):
    """Return the velocity [1] along the axis of a lever (3,) [L] for a unit of impulse that gives rates (3,).

    Source: I w = r x p of a rigid body, the rotation alone; docs/resting.md, "The drop test".
    """
    return lever[0] * rate[0] + lever[1] * rate[1] + lever[2] * rate[2]


@compiled
def point_speed(speed, lever, rates):
    """Return the velocity [sqrt(g L)] of a contact along an axis: of the centre, and of the rates (3,).

    Source: v + w x r of a rigid body.
    """
    return speed + lever[0] * rates[0] + lever[1] * rates[1] + lever[2] * rates[2]


@compiled
def speeds(state, row):
    """Return the velocity (3,) [sqrt(g L)] of a contact along the floor's axes, of a body's state (13,).

    Source: v + w x r of a rigid body.
    """
    u, v, w, p, q, r = moves_of(state)
    return (
        point_speed(u, ahead_lever(row), (p, q, r)),
        point_speed(v, aside_lever(row), (p, q, r)),
        point_speed(w, up_lever(row), (p, q, r)),
    )


@compiled
def up_speed(state, row):
    """Return the upward velocity [sqrt(g L)] of a contact of a body in a state (13,).

    Source: v + w x r of a rigid body.
    """
    _, _, w, p, q, r = moves_of(state)
    return point_speed(w, up_lever(row), (p, q, r))


@compiled
def spun(rates, response, impulse):
    """Return the rates (3,) [sqrt(g/L)] after an impulse [sqrt(g L)] that gives ``response`` a unit.

    Source: I w = r x p of a rigid body.
    """
    return (
        rates[0] + response[0] * impulse,
        rates[1] + response[1] * impulse,
        rates[2] + response[2] * impulse,
    )


@compiled
def push(state, row, ahead, aside, up):
    """Give the body of a state (13,) the impulses [sqrt(g L)] of a contact along the floor's axes."""
    u, v, w, p, q, r = moves_of(state)
    rates = spun((p, q, r), ahead_rate(row), ahead)
    rates = spun(rates, aside_rate(row), aside)
    p, q, r = spun(rates, up_rate(row), up)
    set_moves(state, (u + ahead, v + aside, w + up, p, q, r))
    row.ahead_impulse, row.aside_impulse, row.up_impulse = ahead, aside, up
