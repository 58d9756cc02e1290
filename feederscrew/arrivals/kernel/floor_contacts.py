"""Compiled contacts of one body with the floor: points that touch, and the impulses of all together.

Points are corners, and points of rims. A contact is a record of `FLOOR_CONTACT`. Along each floor axis, ahead
(x), aside (y) and up (z), it holds the lever p x e in body axes, from point p, and the rates that one unit of
impulse gives, lever / inertia. Where impulses are swept for it has effective masses. Then come the upward
speed wanted after the impulse, the impulse, what that was a sweep ago, and what the sweep before changed of
it.

Of one or two contacts that press and slip a few steps suffice where sweeps take many. While the directions of
the slips are known, so is the friction of each contact as a share of what presses it, and the latter solves
linear equations. A step on the floor changes a slip by little beside itself: the directions settle at once.
There ``last`` of a contact holds its impulse (x, y, z) for a unit of what presses it, and ``change`` the
rates that this gives. Impulses and speeds are in sqrt(g L). Source: own; docs/resting.md, "The drop test".
"""

import math
from typing import NamedTuple

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel.body import Moves, W, energy, keep, moves_of, rim_level, set_moves
from feederscrew.arrivals.rounded_hull import RoundedHull
from feederscrew.base.arrays import Bools, Floats, Ints, Points, Row, Rows, Triple, Vector
from feederscrew.base.geometry.compiled import compiled, outlined, record_type

MAX_CONTACTS = 12  # solved together; of more, the lowest and those furthest out in the other directions
FLAT_RIM_POINTS = 4  # points of a rim that lies flat
CORNER_OWNER = -1  # owner of a point that is a corner of the body; else its rim
LEVEL_RIM_SINE = 1e-9  # [1] sine of the tilt below which a rim has no lowest point
FLOOR_AXES = ("ahead", "aside", "up")
FLOOR_CONTACT = record_type(
    *(f"{axis}_{what}_{e}" for what in ("lever", "rate") for axis in FLOOR_AXES for e in "xyz"),
    "floor_mass",
    "up_mass",
    "wanted",
    *(f"{axis}_{what}" for what in ("impulse", "last", "change") for axis in FLOOR_AXES),
)
MAX_DIRECTION_CHANGES = 6  # after which the sweeps take over
SWEEPS_PER_LEAP = 6  # sweeps from one leap to the next
STRAIGHT_COSINE2 = 0.95**2  # squared cosine between two changes that lead the same way
MAX_LEAP = 1000.0  # a leap, in changes of a sweep


class Scratch(NamedTuple):
    """Arrays the kernel writes to: one set for each thread."""

    state: Floats  # (STATE,)
    saved: Floats  # (STATE,)
    ahead: Floats  # (STATE,)
    turn: Floats  # (9,)
    later: Floats  # (9,)
    visited: Bools  # (V,) bool, corners of the flood
    queue: Ints  # (V,) int, corners in the order of the flood
    spots: Floats  # (V + QUARTERS R, 3) points that touch the floor, in body axes
    owners: Ints  # (V + QUARTERS R,) int: rim of each of them, CORNER for none
    contacts: Rows  # (MAX_CONTACTS,) FLOOR_CONTACT
    pressed: Floats  # (2,) points of the last step if it was on the floor, else 0; how long it was
    trace: Floats  # (N, 14) time and state at the start of each step, until it is full
    rows: Ints  # (1,) int: how many rows of it are filled


class Steps(NamedTuple):
    """Step sizes and tolerances of a drop, dimensionless."""

    flight: float = 0.01  # shortest step in the air
    turn: float = 0.3  # [rad] largest turn in a step in the air
    contact: float = 0.01  # longest step on the floor
    swing: float = 0.06  # [rad] largest turn in a step on the floor
    tolerance: float = 3e-4  # points this near the floor touch it
    threshold: float = 0.05  # approach speed from which a contact rebounds
    sweeps: int = 1000  # of the contact solver, at most
    converged: float = 1e-6  # what a whole sweep may still change of the impulses
    margin: float = 2e-3  # energy below the lowest saddle at which the face is decided
    rolling: float = 0.02  # rolling resistance of a rim: lever of the normal force
    pivot: float = 2e-3  # ... of a corner or an edge
    longest: float = 400.0  # time after which a drop counts as unsettled
    most: int = 100_000  # steps after which it does: of 100,000 drops none took half of them
    early: bool = True  # stop as soon as the face is decided, not at rest


class Pairing(NamedTuple):
    """How the materials of a body and of the floor meet."""

    restitution: float  # of a point that strikes it
    friction: float


@compiled
def touching(solid: RoundedHull, work: Scratch, height: float, corner: int, reach: float) -> int:
    """Find the points within ``reach`` of the floor: fills ``work.spots`` and returns how many.

    Corners are found by flooding the hull's edges from the lowest one, through corners that rims replace.
    Where none of these rims is as low as their lowest corner, that is the point.
    """
    count = _flooded(solid, work, height, corner, reach) if solid.corners else 0
    for k in range(len(solid.rims)):
        if height + rim_level(solid.rims, k, work.turn) <= reach:
            count = _on_rim(solid.rims, k, work, height, reach, count)
    if count == 0:
        for i in range(3):
            work.spots[0, i] = solid.vertices[corner, i]
        work.owners[0] = CORNER_OWNER
        return 1
    return thin_out(work.spots, work.owners, work.turn, count) if count > MAX_CONTACTS else count


@compiled
def _flooded(solid: RoundedHull, work: Scratch, height: float, corner: int, reach: float) -> int:
    """Write touching corners to ``work.spots``; ``work.visited`` (V,) is all False before and after."""
    points, links, visited, queue = solid.vertices, solid.links, work.visited, work.queue
    a, b, c = work.turn[6], work.turn[7], work.turn[8]
    queue[0], visited[corner] = corner, True
    count, done, spots = 1, 0, 0
    while done < count:
        here = queue[done]
        done += 1
        for k in range(links[here], links[here + 1]):
            other = links[k]
            level = a * points[other, 0] + b * points[other, 1] + c * points[other, 2]
            if not visited[other] and height + level <= reach + solid.sag:
                queue[count], visited[other] = other, True
                count += 1
    for k in range(count):
        p = points[queue[k]]
        visited[queue[k]] = False
        if not solid.inner[queue[k]] and height + a * p[0] + b * p[1] + c * p[2] <= reach:
            for i in range(3):
                work.spots[spots, i] = p[i]
            work.owners[spots] = CORNER_OWNER
            spots += 1
    return spots


@compiled
def _on_rim(rims: Floats, k: int, work: Scratch, height: float, reach: float, count: int) -> int:
    """Write a rim's lowest point to ``work.spots``, and FLAT_RIM_POINTS around it where all touches."""
    r, turn, spots = rims[k], work.turn, work.spots
    x, y, z, steep = _lowest_on(rims, k, turn)
    u, v, w = r[4] * z - r[5] * y, r[5] * x - r[3] * z, r[3] * y - r[4] * x  # a quarter of a turn on
    level = turn[6] * r[0] + turn[7] * r[1] + turn[8] * r[2]
    flat = height + level + r[6] * steep <= reach
    cos, sin = 1.0, 0.0
    for _ in range(FLAT_RIM_POINTS if flat else 1):
        px, py, pz = cos * x + sin * u, cos * y + sin * v, cos * z + sin * w
        cos, sin = -sin, cos
        if r[10] > -1.0 and px * r[7] + py * r[8] + pz * r[9] < r[10]:
            continue
        spots[count, 0], spots[count, 1] = r[0] + r[6] * px, r[1] + r[6] * py
        spots[count, 2] = r[2] + r[6] * pz
        work.owners[count] = CORNER_OWNER if flat else k
        count += 1
    return count


@compiled
def _lowest_on(rims: Floats, k: int, turn: Floats) -> tuple[float, float, float, float]:
    """The unit vector (3,) from a rim's centre to its lowest point, and how steep it is."""
    r = rims[k]
    along = turn[6] * r[3] + turn[7] * r[4] + turn[8] * r[5]
    x, y, z = along * r[3] - turn[6], along * r[4] - turn[7], along * r[5] - turn[8]
    steep = math.sqrt(x * x + y * y + z * z)
    if steep < LEVEL_RIM_SINE:
        return r[7], r[8], r[9], steep
    return x / steep, y / steep, z / steep, steep


@compiled
def thin_out(spots: Points, owners: Ints, turn: Floats, count: int) -> int:
    """Keep of many touching spots (N, 3) [L] the lowest and those furthest out around it, in front."""
    best, first = math.inf, 0
    for k in range(count):
        level = turn[6] * spots[k, 0] + turn[7] * spots[k, 1] + turn[8] * spots[k, 2]
        if level < best:
            best, first = level, k
    _swap(spots, owners, 0, first)
    chosen = 1
    for m in range(1, MAX_CONTACTS):
        angle = 2.0 * math.pi * m / (MAX_CONTACTS - 1)
        cos, sin, best, furthest = math.cos(angle), math.sin(angle), -math.inf, 0
        for k in range(count):
            p = spots[k]
            x = turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
            y = turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
            if cos * x + sin * y > best:
                best, furthest = cos * x + sin * y, k
        if furthest >= chosen:
            _swap(spots, owners, chosen, furthest)
            chosen += 1
    return chosen


@compiled
def _swap(spots: Points, owners: Ints, i: int, j: int) -> None:
    owners[i], owners[j] = owners[j], owners[i]
    for e in range(3):
        spots[i, e], spots[j, e] = spots[j, e], spots[i, e]


@compiled
def levers(inertia: Floats, work: Scratch, count: int) -> None:
    """Fill the records of ``work.contacts`` (N,) for the points found; inertia (3,) [L2] over mass."""
    arms(work, count)
    for n in range(count):
        _rates(inertia, work.contacts[n])


@compiled
def levers_ahead(solid: RoundedHull, work: Scratch, count: int, dt: float) -> None:
    """Fill the records for a step ``dt`` [sqrt(L/g)]: impulses act half of it ahead, speeds are of its end.

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
                x, y, z, _ = _lowest_on(solid.rims, k, work.later)
                rim = solid.rims[k]
                if rim[10] < -1.0 or x * rim[7] + y * rim[8] + z * rim[9] >= rim[10]:
                    spot[0], spot[1] = rim[0] + rim[6] * x, rim[1] + rim[6] * y
                    spot[2] = rim[2] + rim[6] * z
            _arm(work.later, spot, work.contacts[n])
            if half == 0:
                _rates(solid.inertia, work.contacts[n])


@compiled
def arms(work: Scratch, count: int) -> None:
    """Fill the levers [L] of ``work.contacts`` (N,) for the points found: their speeds follow."""
    for n in range(count):
        _arm(work.turn, work.spots[n], work.contacts[n])


@compiled
def strike(
    inertia: Floats,
    state: Floats,
    saved: Floats,
    contacts: Rows,
    count: int,
    pairing: Pairing,
    steps: Steps,
) -> None:
    """Do an impact: contacts (N,) that approach faster than the threshold [sqrt(g L)] rebound."""
    before = energy(state, inertia)
    keep(state, saved)
    for trial in range(4):
        # less where friction would make Newton's rule win energy
        bounce = pairing.restitution * (1.0 - trial / 3.0)
        for n in range(count):
            row = contacts[n]
            fall = _up_speed(state, row)
            row.wanted = -bounce * fall if fall < -steps.threshold else 0.0
            row.ahead_impulse = row.aside_impulse = row.up_impulse = 0.0
        _solve(state, contacts, count, pairing.friction, steps.sweeps, steps.converged)
        if energy(state, inertia) <= before + 1e-12:
            return
        keep(saved, state)


@compiled
def steepest(state: Floats, contacts: Rows, count: int) -> float:
    """Return the upward speed [sqrt(g L)] of that of the contacts (N,) which falls fastest."""
    fall = math.inf
    for n in range(count):
        fall = min(fall, _up_speed(state, contacts[n]))
    return fall


@compiled
def hold(state: Floats, contacts: Rows, count: int, friction: float, steps: Steps, share: float) -> None:
    """Give contacts (N,) impulses [sqrt(g L)] that let nothing fall further, without rebound."""
    for n in range(count):
        row = contacts[n]
        row.wanted = 0.0
        row.ahead_impulse *= share
        row.aside_impulse *= share
        row.up_impulse *= share
        row.ahead_last = row.aside_last = row.up_last = 0.0
        row.ahead_change = row.aside_change = row.up_change = 0.0
    _solve(state, contacts, count, friction, steps.sweeps, steps.converged)


@outlined
def _solve(state: Floats, contacts: Rows, count: int, friction: float, sweeps: int, converged: float) -> None:
    """Give contacts (N,) impulses [sqrt(g L)] with Coulomb friction: they leave as wanted or faster.

    One or two contacts directly where that goes; else swept from the impulses that the contacts hold, until
    a whole sweep changes the body's velocities by no more than ``converged`` of what presses it: between many
    contacts impulses may creep on for long.
    """
    if count == 1 and _stick(state, contacts[0], friction):
        return
    if count > 2 or not _slide(state, contacts, count, friction, converged):
        _sweep(state, contacts, count, friction, sweeps, converged)


@compiled
def _slide(state: Floats, contacts: Rows, count: int, friction: float, converged: float) -> bool:
    """Give impulses to one or two contacts that press and slip; say if they settle."""
    first, last = contacts[0], contacts[count - 1]
    for n in range(count):
        ahead, aside, _ = _speeds(state, contacts[n])
        _aim(contacts[n], friction, ahead, aside)
    for _ in range(MAX_DIRECTION_CHANGES):
        press, other_press = _presses(state, first, last, count)
        if not (press >= 0.0 and other_press >= 0.0):
            return False
        change = 0.0
        for n in range(count):  # aim each along the slip that the impulses of both leave
            row, by = contacts[n], press if n == 0 else other_press
            ahead, aside, _ = _speeds(state, row)
            x, y, _ = _levers(row)
            rates = _unit_rates(first)
            ahead += press * _point_speed(first.ahead_last, x, rates)
            aside += press * _point_speed(first.aside_last, y, rates)
            rates = _unit_rates(last)
            ahead += other_press * _point_speed(last.ahead_last, x, rates)
            aside += other_press * _point_speed(last.aside_last, y, rates)
            change += by * _aim(row, friction, ahead, aside)
        if change <= converged * (press + other_press):
            for n in range(count):
                row, by = contacts[n], press if n == 0 else other_press
                _push(state, row, by * row.ahead_last, by * row.aside_last, by * row.up_last)
            return True
    return False


@compiled
def _aim(row: Row, friction: float, ahead: float, aside: float) -> float:
    """Note the impulse of a contact that slips with a velocity; return how far it turned."""
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
def _presses(state: Floats, first: Row, last: Row, count: int) -> tuple[float, float]:
    """The impulse that makes each contact leave as wanted; 0 where there is no second."""
    lever, rates = _levers(first)[2], _unit_rates(first)
    a = _point_speed(first.up_last, lever, rates)
    here = first.wanted - _up_speed(state, first)
    if count == 1:
        return here / a, 0.0
    other_lever, other_rates = _levers(last)[2], _unit_rates(last)
    b = _point_speed(last.up_last, lever, other_rates)
    c = _point_speed(first.up_last, other_lever, rates)
    d = _point_speed(last.up_last, other_lever, other_rates)
    there = last.wanted - _up_speed(state, last)
    whole = a * d - b * c
    return (d * here - b * there) / whole, (a * there - c * here) / whole


@compiled
def _unit_rates(row: Row) -> Triple:
    return row.ahead_change, row.aside_change, row.up_change


@compiled
def _stick(state: Floats, row: Row, friction: float) -> bool:
    """Hold one contact still by an impulse; return whether friction can."""
    ahead, aside, rise = _speeds(state, row)
    u, v, w = -ahead, -aside, row.wanted - rise
    x, y, z = _levers(row)
    p, q, r = _responses(row)
    xx, yy, zz = 1.0 + _coupling(x, p), 1.0 + _coupling(y, q), 1.0 + _coupling(z, r)
    xy, xz, yz = _coupling(x, q), _coupling(x, r), _coupling(y, r)
    yx, zx, zy = _coupling(y, p), _coupling(z, p), _coupling(z, q)
    a, b, c = yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx
    whole = xx * a + xy * b + xz * c
    along = (a * u + (xz * zy - xy * zz) * v + (xy * yz - xz * yy) * w) / whole
    across = (b * u + (xx * zz - xz * zx) * v + (xz * yx - xx * yz) * w) / whole
    up = (c * u + (xy * zx - xx * zy) * v + (xx * yy - xy * yx) * w) / whole
    most = friction * up
    holds = up >= 0.0 and along * along + across * across <= most * most
    if holds:
        _push(state, row, along, across, up)
    return holds


@compiled
def _sweep(state: Floats, contacts: Rows, count: int, friction: float, sweeps: int, converged: float) -> None:
    """Give impulses by projected Gauss-Seidel sweeps, from what the contacts hold."""
    for n in range(count):
        row = contacts[n]
        # effective masses, along the floor the smaller that serves both axes
        x, y, z = _levers(row)
        spin_x, spin_y, spin_z = _responses(row)
        xx, yy = 1.0 + _coupling(x, spin_x), 1.0 + _coupling(y, spin_y)
        lean, mean, cross = 0.5 * (xx - yy), 0.5 * (xx + yy), _coupling(x, spin_y)
        row.floor_mass = 1.0 / (mean + math.sqrt(lean * lean + cross * cross))
        row.up_mass = 1.0 / (1.0 + _coupling(z, spin_z))
        _push(state, row, row.ahead_impulse, row.aside_impulse, row.up_impulse)
    u, v, w, p, q, r = moves_of(state)
    for turn in range(sweeps):
        if turn % SWEEPS_PER_LEAP >= SWEEPS_PER_LEAP - 2:
            for n in range(count):
                row = contacts[n]
                row.ahead_change = row.ahead_impulse - row.ahead_last
                row.aside_change = row.aside_impulse - row.aside_last
                row.up_change = row.up_impulse - row.up_last
                row.ahead_last, row.aside_last = row.ahead_impulse, row.aside_impulse
                row.up_last = row.up_impulse
        a, b, c, d, e, f = u, v, w, p, q, r
        size = 0.0
        for n in range(count):
            u, v, w, p, q, r = _relax(contacts[n], friction, (u, v, w, p, q, r))
            size += contacts[n].up_impulse
        change = abs(u - a) + abs(v - b) + abs(w - c)
        change += abs(p - d) + abs(q - e) + abs(r - f)
        if change <= converged * size:
            break
        if turn % SWEEPS_PER_LEAP == SWEEPS_PER_LEAP - 1:
            on = _leap(contacts, count)
            for n in range(count):
                row = contacts[n]
                row.ahead_impulse += on * (row.ahead_impulse - row.ahead_last)
                row.aside_impulse += on * (row.aside_impulse - row.aside_last)
                row.up_impulse += on * (row.up_impulse - row.up_last)
            u, v, w = u + on * (u - a), v + on * (v - b), w + on * (w - c)
            p, q, r = p + on * (p - d), q + on * (q - e), r + on * (r - f)
    set_moves(state, (u, v, w, p, q, r))


@compiled
def _relax(row: Row, friction: float, moves: Moves) -> Moves:
    """One projected Gauss-Seidel step on a contact; the velocities and rates (6,) after it."""
    u, v, w, p, q, r = moves
    levers, responses = _levers(row), _responses(row)
    x, y, z = row.ahead_impulse, row.aside_impulse, row.up_impulse
    up = max(z + row.up_mass * (row.wanted - _point_speed(w, levers[2], (p, q, r))), 0.0)
    w += up - z
    p, q, r = _spun((p, q, r), responses[2], up - z)
    ahead = x - row.floor_mass * _point_speed(u, levers[0], (p, q, r))
    aside = y - row.floor_mass * _point_speed(v, levers[1], (p, q, r))
    size, most = ahead * ahead + aside * aside, friction * up
    if size > most * most:
        scale = most / math.sqrt(size)
        ahead, aside = scale * ahead, scale * aside
    u += ahead - x
    p, q, r = _spun((p, q, r), responses[0], ahead - x)
    v += aside - y
    p, q, r = _spun((p, q, r), responses[1], aside - y)
    row.ahead_impulse, row.aside_impulse, row.up_impulse = ahead, aside, up
    return u, v, w, p, q, r


@compiled
def _leap(contacts: Rows, count: int) -> float:
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


@compiled
def _arm(turn: Floats, spot: Vector, row: Row) -> None:
    """Fill the levers [L] of a contact at a spot (3,) [L] in body axes."""
    row.ahead_lever_x, row.ahead_lever_y, row.ahead_lever_z = _lever(spot, turn[0], turn[1], turn[2])
    row.aside_lever_x, row.aside_lever_y, row.aside_lever_z = _lever(spot, turn[3], turn[4], turn[5])
    row.up_lever_x, row.up_lever_y, row.up_lever_z = _lever(spot, turn[6], turn[7], turn[8])


@compiled
def _lever(spot: Vector, x: float, y: float, z: float) -> Triple:
    return spot[1] * z - spot[2] * y, spot[2] * x - spot[0] * z, spot[0] * y - spot[1] * x


@compiled
def _rates(inertia: Floats, row: Row) -> None:
    """Fill the rates [1/L] of a contact from its levers."""
    i, j, k = inertia[0], inertia[1], inertia[2]
    row.ahead_rate_x, row.ahead_rate_y = row.ahead_lever_x / i, row.ahead_lever_y / j
    row.aside_rate_x, row.aside_rate_y = row.aside_lever_x / i, row.aside_lever_y / j
    row.up_rate_x, row.up_rate_y = row.up_lever_x / i, row.up_lever_y / j
    row.ahead_rate_z, row.aside_rate_z = row.ahead_lever_z / k, row.aside_lever_z / k
    row.up_rate_z = row.up_lever_z / k


@compiled
def _levers(row: Row) -> tuple[Triple, Triple, Triple]:
    return (
        (row.ahead_lever_x, row.ahead_lever_y, row.ahead_lever_z),
        (row.aside_lever_x, row.aside_lever_y, row.aside_lever_z),
        (row.up_lever_x, row.up_lever_y, row.up_lever_z),
    )


@compiled
def _responses(row: Row) -> tuple[Triple, Triple, Triple]:
    return (
        (row.ahead_rate_x, row.ahead_rate_y, row.ahead_rate_z),
        (row.aside_rate_x, row.aside_rate_y, row.aside_rate_z),
        (row.up_rate_x, row.up_rate_y, row.up_rate_z),
    )


@compiled
def _coupling(lever: Triple, rate: Triple) -> float:
    """The velocity along a lever's axis for a unit of impulse that gives these rates: I w = r x p."""
    return lever[0] * rate[0] + lever[1] * rate[1] + lever[2] * rate[2]


@compiled
def _point_speed(speed: float, lever: Triple, rates: Triple) -> float:
    """The velocity of a contact along an axis: v + w x r, of the centre and of the body's rates (3,)."""
    return speed + lever[0] * rates[0] + lever[1] * rates[1] + lever[2] * rates[2]


@compiled
def _speeds(state: Floats, row: Row) -> Triple:
    u, v, w, p, q, r = moves_of(state)
    x, y, z = _levers(row)
    rates = p, q, r
    return _point_speed(u, x, rates), _point_speed(v, y, rates), _point_speed(w, z, rates)


@compiled
def _up_speed(state: Floats, row: Row) -> float:
    _, _, w, p, q, r = moves_of(state)
    return _point_speed(w, _levers(row)[2], (p, q, r))


@compiled
def _spun(rates: Triple, response: Triple, impulse: float) -> Triple:
    """The rates (3,) after an impulse that gives ``response`` a unit."""
    return (
        rates[0] + response[0] * impulse,
        rates[1] + response[1] * impulse,
        rates[2] + response[2] * impulse,
    )


@compiled
def _push(state: Floats, row: Row, ahead: float, aside: float, up: float) -> None:
    """Give the body the impulses of a contact along the floor's axes."""
    u, v, w, p, q, r = moves_of(state)
    x, y, z = _responses(row)
    rates = _spun((p, q, r), x, ahead)
    rates = _spun(rates, y, aside)
    p, q, r = _spun(rates, z, up)
    set_moves(state, (u + ahead, v + aside, w + up, p, q, r))
    row.ahead_impulse, row.aside_impulse, row.up_impulse = ahead, aside, up
