"""Compiled impulses between two parts: how a contact shall leave a step, and what it gives to either."""

import math

from feederscrew.dropping.kernel.body import VX, W
from feederscrew.dropping.kernel.floor_contacts import IMPULSE, MASS, RATE, WANTED
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel import contact, motion
from feederscrew.trial.kernel.contact import AHEAD, AXES, GAP, NORMAL


@compiled
def _apart(crowd, k, e):
    """Velocity of the first part of a contact against the second, along one of its axes."""
    first, second = crowd.states[crowd.owners[k]], crowd.states[crowd.owners[k + 1]]
    return contact.speed(first, crowd.pairs[k], e) - contact.speed(second, crowd.pairs[k + 1], e)


@compiled
def _against(crowd, k, e):
    """Velocity of the first part of a contact against the second as the step began, along one of its axes."""
    first, second = crowd.before[crowd.owners[k]], crowd.before[crowd.owners[k + 1]]
    return contact.speed(first, crowd.pairs[k], e) - contact.speed(second, crowd.pairs[k + 1], e)


@compiled
def wanted(surface, crowd, pairs, dt):
    """Say how each contact of two parts shall leave a step, with which friction; the deepest of them."""
    deepest = 0.0
    for k in range(0, pairs, 2):
        row = crowd.pairs[k]
        gap, fall = row[GAP], _against(crowd, k, NORMAL)
        deepest = min(deepest, gap)
        strikes = fall < -surface.threshold and gap + fall * dt < 0.0
        row[WANTED] = -surface.restitution * fall if strikes else -max(gap, 0.0) / dt
        slides = math.hypot(_against(crowd, k, 0), _against(crowd, k, 1)) > motion.STILL
        row[AHEAD] = surface.friction[int(slides)]
    return deepest


@compiled
def _given(state, row, e, impulse):
    for k in range(3):
        state[VX + k] += impulse * row[AXES + 3 * e + k]
        state[W + k] += impulse * row[RATE + 3 * e + k]


@compiled
def _both(crowd, k, e, impulse):
    _given(crowd.states[crowd.owners[k]], crowd.pairs[k], e, impulse)
    _given(crowd.states[crowd.owners[k + 1]], crowd.pairs[k + 1], e, -impulse)


@compiled
def relax(crowd, k):
    """Take one projected Gauss-Seidel step on a contact of two parts; the change of its impulse."""
    row = crowd.pairs[k]
    x, y, z = row[IMPULSE], row[IMPULSE + 1], row[IMPULSE + 2]
    up = max(z + row[MASS + 2] * (row[WANTED] - _apart(crowd, k, NORMAL)), 0.0)
    _both(crowd, k, NORMAL, up - z)
    row[IMPULSE + 2] = up
    if up == 0.0 and z == 0.0:
        return 0.0
    ahead, aside = x - row[MASS] * _apart(crowd, k, 0), y - row[MASS + 1] * _apart(crowd, k, 1)
    ahead, aside = contact.rubbing(ahead, aside, row[AHEAD] * up)
    _both(crowd, k, 0, ahead - x)
    _both(crowd, k, 1, aside - y)
    row[IMPULSE], row[IMPULSE + 1] = ahead, aside
    return abs(up - z) + abs(ahead - x) + abs(aside - y)
