"""Compiled pushes over a step: by gravity and the drive, and what each contact shall do and did."""

import math

from feederscrew.dropping.kernel import floor_motion as floors
from feederscrew.dropping.kernel.body import X, Y
from feederscrew.dropping.kernel.floor_contacts import IMPULSE, WANTED
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel import contact, jets
from feederscrew.trial.kernel.contact import AHEAD, BACK, GAP, NORMAL, RUB
from feederscrew.trial.kernel.crowd_records import LEAN

STILL = 1e-5  # speed along a contact below which it sticks while static friction holds


@compiled
def give(surface, solid, floor, crowd, n, time, dt):
    """Write the changes (6,) [sqrt(g L), sqrt(g/L)] of velocity and rates by gravity, drive and jets."""
    given, state, turn = crowd.given[n], crowd.before[n], crowd.turns[n]
    c, s = crowd.tangents[n, 0], crowd.tangents[n, 1]
    x, y = state[X], surface.radius - state[Y]
    forth, rise = floors.quickening(floor, time, dt)
    leans = crowd.leans[n]
    lean, up = leans[LEAN], leans[LEAN + 1]
    along = dt * leans[0] - forth * math.sqrt(x * x + y * y) / surface.radius
    across = dt * leans[1] - rise * lean
    given[0] = c * along - s * across
    given[1] = s * along + c * across
    given[2] = dt * leans[2] - rise * up
    spin = forth / surface.radius
    for k in range(3):
        given[3 + k] = -spin * (lean * (c * turn[3 + k] - s * turn[k]) + up * turn[6 + k])
    if len(surface.jets):
        jets.blow(surface, solid, floor, crowd, n, time, dt)


@compiled
def wanted(surface, crowd, n, dt):
    """Say how each contact of a part shall leave a step, with which friction.

    Returns
    -------
    depth of the deepest, whether one strikes, share of the step after which the first of them does
    """
    deepest, strikes, share = 0.0, False, 1.0
    saved = crowd.before[n]
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        gap, fall = row[GAP], contact.speed(saved, row, NORMAL)
        deepest = min(deepest, gap)
        row[WANTED] = -max(gap, 0.0) / dt - max(fall, 0.0)
        if fall < -surface.threshold and gap + fall * dt < 0.0:
            strikes = True
            share = min(share, max(gap, 0.0) / (-fall * dt))
            given = contact.speed(crowd.states[n], row, NORMAL) - fall
            row[WANTED] = max(given - surface.restitution * fall, 0.0)
        if math.isnan(row[RUB]):
            slides = math.hypot(contact.speed(saved, row, 0), contact.speed(saved, row, 1)) > STILL
            row[AHEAD] = surface.friction[int(slides)]
            row[BACK] = surface.friction[2 + int(slides)]
        else:
            row[AHEAD] = row[BACK] = row[RUB]
    return deepest, strikes, share


@compiled
def wanted_of_pairs(surface, crowd, dt):
    """Say with which speed [sqrt(g L)] each contact of two parts shall leave a step; as ``wanted``."""
    deepest, strikes, share = 0.0, False, 1.0
    for k in range(0, crowd.paired[0], 2):
        row = crowd.pairs[k]
        gap, fall = row[GAP], contact.apart_by(crowd.before, crowd, k, NORMAL)
        deepest = min(deepest, gap)
        row[WANTED] = -max(gap, 0.0) / dt
        if fall < -surface.threshold and gap + fall * dt < 0.0:
            strikes = True
            share = min(share, max(gap, 0.0) / (-fall * dt))
            given = contact.apart_by(crowd.states, crowd, k, NORMAL) - fall
            row[WANTED] = max(given - surface.restitution * fall, 0.0)
        along = contact.apart_by(crowd.before, crowd, k, 0)
        aside = contact.apart_by(crowd.before, crowd, k, 1)
        row[AHEAD] = surface.friction[int(math.hypot(along, aside) > STILL)]
    return deepest, strikes, share


@compiled
def reversal(crowd, n):
    """Return the share [1] of a step after which sliding comes to a stand, if it does; else 1.

    Of the contact that slides fastest. What friction did less than its most against the sliding is what it
    did after the stand: without that the contact would have gone on to slide back so much faster.
    """
    first, before = -1, STILL
    saved = crowd.before[n]
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        if row[IMPULSE + 2] > 0.0:
            quick = math.hypot(contact.speed(saved, row, 0), contact.speed(saved, row, 1))
            if quick > before:
                first, before = m, quick
    if first < 0:
        return 1.0
    row = crowd.rows[n, first]
    a, b = contact.speed(saved, row, 0) / before, contact.speed(saved, row, 1) / before
    after = a * contact.speed(crowd.states[n], row, 0) + b * contact.speed(crowd.states[n], row, 1)
    if after > STILL:
        return 1.0
    spared = 0.0
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        most = row[BACK] if a < 0.0 else row[AHEAD]
        spared += most * row[IMPULSE + 2] + a * row[IMPULSE] + b * row[IMPULSE + 1]
    return before / (before - after + max(spared, 0.0))
