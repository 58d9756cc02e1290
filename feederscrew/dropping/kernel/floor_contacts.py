"""Compiled contacts of one body with the floor: what an impulse at each point that touches does to it.

A contact is a row of WIDTH numbers. Along floor axis e (x, y, z in turn) it holds the lever p x e in body
axes, from point p; the rates one unit of impulse along e gives, lever / inertia; its effective mass, of
both axes in the plane the smaller that serves both, where impulses are swept for; then the upward speed
wanted after the impulse; then the impulse itself, (x, y, z), what it was a sweep ago, and what the sweep
before that changed of it.
"""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, W
from feederscrew.dropping.kernel.touch import CORNER, lowest_on
from feederscrew.geometry.compiled import compiled

LEVER, RATE, MASS, WANTED, IMPULSE, LAST, CHANGE, WIDTH = 0, 9, 18, 21, 22, 25, 28, 31


@compiled
def arms(work, count):
    """Fill the levers [L] of ``work.contacts`` (N, WIDTH) for the points found: their speeds follow."""
    for n in range(count):
        arm(work.turn, work.spots[n], work.contacts[n])


@compiled
def levers(inertia, work, count):
    """Fill the rows of ``work.contacts`` (N, WIDTH) for the points found; inertia (3,) [L2] over mass."""
    arms(work, count)
    for n in range(count):
        rates(inertia, work.contacts[n])


@compiled
def levers_ahead(solid, work, count, dt):
    """Fill the rows for a step dt [sqrt(L/g)]: impulses act half of it ahead, speeds are wanted at its end.

    A rim's lowest point travels around it meanwhile.
    """
    body.keep(work.state, work.ahead)
    for half in range(2):
        p, q, r = work.ahead[W], work.ahead[W + 1], work.ahead[W + 2]
        body.rotate(work.ahead, p, q, r, 0.5 * dt)
        body.rotation(work.ahead, work.later)
        for n in range(count):
            spot, k = work.spots[n], work.owners[n]
            if k != CORNER:
                x, y, z, _ = lowest_on(solid.rims, k, work.later)
                rim = solid.rims[k]
                if rim[10] < -1.0 or x * rim[7] + y * rim[8] + z * rim[9] >= rim[10]:
                    spot[0], spot[1] = rim[0] + rim[6] * x, rim[1] + rim[6] * y
                    spot[2] = rim[2] + rim[6] * z
            arm(work.later, spot, work.contacts[n])
            if half == 0:
                rates(solid.inertia, work.contacts[n])


@compiled
def arm(turn, spot, row):
    """Fill the levers [L] of a contact, a row (WIDTH,), at a spot (3,) [L] in body axes."""
    for e in range(3):
        x, y, z = turn[3 * e], turn[3 * e + 1], turn[3 * e + 2]
        k = LEVER + 3 * e
        row[k], row[k + 1] = spot[1] * z - spot[2] * y, spot[2] * x - spot[0] * z
        row[k + 2] = spot[0] * y - spot[1] * x


@compiled
def rates(inertia, row):
    """Fill the rates [1/L] of a contact, a row (WIDTH,), from its levers [L] and the inertia (3,) [L2]."""
    for k in range(9):
        row[RATE + k] = row[LEVER + k] / inertia[k % 3]


@compiled
def masses(row):
    """Fill the effective masses [1] of a contact, a row (WIDTH,), from its levers and rates."""
    xx, yy, zz = 1.0 + coupling(row, 0, 0), 1.0 + coupling(row, 1, 1), 1.0 + coupling(row, 2, 2)
    lean, mean, cross = 0.5 * (xx - yy), 0.5 * (xx + yy), coupling(row, 0, 1)
    row[MASS] = row[MASS + 1] = 1.0 / (mean + math.sqrt(lean * lean + cross * cross))
    row[MASS + 2] = 1.0 / zz


@compiled
def speed(state, row, e):
    """Return the velocity [sqrt(g L)] of a contact, a row (WIDTH,), along floor axis e.

    Source: v + w x r of a rigid body.
    """
    k = LEVER + 3 * e
    return state[VX + e] + row[k] * state[W] + row[k + 1] * state[W + 1] + row[k + 2] * state[W + 2]


@compiled
def push(state, row, e, impulse):
    """Give the body of a state (13,) the impulse [sqrt(g L)] of a contact along floor axis e."""
    k = RATE + 3 * e
    state[VX + e] += impulse
    state[W] += row[k] * impulse
    state[W + 1] += row[k + 1] * impulse
    state[W + 2] += row[k + 2] * impulse
    row[IMPULSE + e] = impulse


@compiled
def coupling(row, d, e):
    """Return the velocity [1] along floor axis d for a unit of impulse along e, of the rotation alone.

    Source: I w = r x p of a rigid body; docs/resting.md, "The drop test".
    """
    i, j = LEVER + 3 * d, RATE + 3 * e
    return row[i] * row[j] + row[i + 1] * row[j + 1] + row[i + 2] * row[j + 2]
