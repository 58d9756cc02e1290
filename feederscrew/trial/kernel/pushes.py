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
CLOSE = 2e-5  # [1] of the unit of length: what is further off takes no part in an impact
ROUNDING = 1e-9  # speed that is rounding


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
    """Say how each contact of a part shall leave a step in which none strikes, with which friction.

    Returns
    -------
    depth of the deepest, share of the step after which the first of them strikes; infinite where none does
    """
    deepest, share = 0.0, math.inf
    saved = crowd.before[n]
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        gap, fall = row[GAP], contact.speed(saved, row, NORMAL)
        deepest = min(deepest, gap)
        row[WANTED] = -max(gap, 0.0) / dt - max(fall, 0.0)
        share = min(share, _strikes_after(surface, gap, fall, dt))
        if math.isnan(row[RUB]):
            slides = math.hypot(contact.speed(saved, row, 0), contact.speed(saved, row, 1)) > STILL
            row[AHEAD] = surface.friction[int(slides)]
            row[BACK] = surface.friction[2 + int(slides)]
        else:
            row[AHEAD] = row[BACK] = row[RUB]
    return deepest, share


@compiled
def wanted_of_pairs(surface, crowd, dt):
    """Say with which speed [sqrt(g L)] each contact of two parts shall leave a step; as ``wanted``."""
    deepest, share = 0.0, math.inf
    for k in range(0, crowd.paired[0], 2):
        row = crowd.pairs[k]
        gap, fall = row[GAP], contact.apart_by(crowd.before, crowd, k, NORMAL)
        deepest = min(deepest, gap)
        row[WANTED] = -max(gap, 0.0) / dt
        share = min(share, _strikes_after(surface, gap, fall, dt))
        along = contact.apart_by(crowd.before, crowd, k, 0)
        aside = contact.apart_by(crowd.before, crowd, k, 1)
        row[AHEAD] = surface.friction[int(math.hypot(along, aside) > STILL)]
    return deepest, share


@compiled
def _strikes_after(surface, gap, fall, dt):
    """Share of a step after which a contact strikes; infinite where it does not."""
    if fall < -surface.threshold and gap + fall * dt < -ROUNDING * dt:
        return max(gap, 0.0) / (-fall * dt)
    return math.inf


@compiled
def rebounds(surface, crowd, n, dt, once):
    """Say how contacts of a part shall leave an impact that begins a step: those that strike at once rebound.

    What is further off than CLOSE, and strikes later than a share ``once`` of the step or not at all, takes
    no part in the impact. The corners of a part that comes down a little out of level so strike one after
    the other, each with the speed that the one before has left it, and the part goes on rocking.
    """
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        fall = contact.speed(crowd.before[n], row, NORMAL)
        if _strikes_after(surface, row[GAP], fall, dt) <= once:
            given = contact.speed(crowd.states[n], row, NORMAL) - fall
            row[WANTED] = max(given - surface.restitution * fall, 0.0)
        elif row[GAP] > CLOSE:
            row[WANTED] = -math.inf


@compiled
def rebounds_of_pairs(surface, crowd, dt):
    """Say how contacts of two parts shall leave an impact: all that strike in the step rebound together.

    Parts of a row meet face to face; what is nearer by a micrometre shall not turn them.
    """
    for k in range(0, crowd.paired[0], 2):
        row = crowd.pairs[k]
        fall = contact.apart_by(crowd.before, crowd, k, NORMAL)
        if _strikes_after(surface, row[GAP], fall, dt) <= 1.0:
            given = contact.apart_by(crowd.states, crowd, k, NORMAL) - fall
            row[WANTED] = max(given - surface.restitution * fall, 0.0)


@compiled
def next_strike(crowd, n, dt):
    """Return the share [1] of a step after which what took no part in an impact touches; 1 if none does."""
    share = 1.0
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        if row[WANTED] == -math.inf:
            way = -dt * contact.speed(crowd.states[n], row, NORMAL)
            share = row[GAP] / way if way * share > row[GAP] else share
    return share


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
