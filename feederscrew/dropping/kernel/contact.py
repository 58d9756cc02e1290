"""Compiled contact of one body with the floor: which points touch, and the impulses they give.

A contact is a row of WIDTH numbers. Along floor axis e (x, y, z in turn) it holds the lever p x e in body
axes, from point p; the rates one unit of impulse along e gives, lever / inertia; its effective mass, of
both axes in the plane the smaller that serves both; then the upward speed wanted after the impulse; then
the impulse itself, (x, y, z).
"""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VZ, W, energy, keep, rim_level
from feederscrew.geometry.compiled import compiled

MOST = 12  # contacts solved together; of more, the lowest and those furthest out in the other directions
QUARTERS = 4  # points of a rim that lies flat
CORNER = -1  # owner of a point that is a corner of the body; else its rim
LEVEL = 1e-9  # [1] sine of the tilt below which a rim has no lowest point
LEVER, RATE, MASS, WANTED, IMPULSE, WIDTH = 0, 9, 18, 21, 22, 25


@compiled
def touching(solid, work, height, corner, reach):
    """Points within ``reach`` of the floor: fills ``work.spots`` and returns how many.

    Corners are found by flooding the hull's edges from the lowest one, through corners that rims replace.
    """
    count = flooded(solid, work, height, corner, reach)
    for k in range(len(solid.rims)):
        if height + rim_level(solid.rims, k, work.turn) <= reach:
            count = on_rim(solid.rims, k, work, height, reach, count)
    return thin_out(work.spots, work.owners, work.turn, count) if count > MOST else count


@compiled
def flooded(solid, work, height, corner, reach):
    """Touching corners, written to ``work.spots``; ``work.seen`` (V,) is all False before and after."""
    points, links, seen, found = solid.vertices, solid.links, work.seen, work.found
    a, b, c = work.turn[6], work.turn[7], work.turn[8]
    found[0], seen[corner] = corner, True
    count, done, spots = 1, 0, 0
    while done < count:
        here = found[done]
        done += 1
        for k in range(links[here], links[here + 1]):
            other = links[k]
            level = a * points[other, 0] + b * points[other, 1] + c * points[other, 2]
            if not seen[other] and height + level <= reach + solid.sag:
                found[count], seen[other] = other, True
                count += 1
    for k in range(count):
        p = points[found[k]]
        seen[found[k]] = False
        if not solid.inner[found[k]] and height + a * p[0] + b * p[1] + c * p[2] <= reach:
            for i in range(3):
                work.spots[spots, i] = p[i]
            work.owners[spots] = CORNER
            spots += 1
    return spots


@compiled
def lowest_on(rims, k, turn):
    """Unit vector from the centre of a rim to its lowest point, in body axes, and how steep the rim is."""
    r = rims[k]
    along = turn[6] * r[3] + turn[7] * r[4] + turn[8] * r[5]
    x, y, z = along * r[3] - turn[6], along * r[4] - turn[7], along * r[5] - turn[8]
    steep = math.sqrt(x * x + y * y + z * z)
    if steep < LEVEL:
        return r[7], r[8], r[9], steep
    return x / steep, y / steep, z / steep, steep


@compiled
def on_rim(rims, k, work, height, reach, count):
    """Write the lowest point of a rim to ``work.spots``, and QUARTERS around it where all of it touches."""
    r, turn, spots = rims[k], work.turn, work.spots
    x, y, z, steep = lowest_on(rims, k, turn)
    u, v, w = r[4] * z - r[5] * y, r[5] * x - r[3] * z, r[3] * y - r[4] * x  # a quarter of a turn on
    level = turn[6] * r[0] + turn[7] * r[1] + turn[8] * r[2]
    flat = height + level + r[6] * steep <= reach
    cos, sin = 1.0, 0.0
    for _ in range(QUARTERS if flat else 1):
        px, py, pz = cos * x + sin * u, cos * y + sin * v, cos * z + sin * w
        cos, sin = -sin, cos
        if r[10] > -1.0 and px * r[7] + py * r[8] + pz * r[9] < r[10]:
            continue
        spots[count, 0], spots[count, 1] = r[0] + r[6] * px, r[1] + r[6] * py
        spots[count, 2] = r[2] + r[6] * pz
        work.owners[count] = CORNER if flat else k
        count += 1
    return count


@compiled
def thin_out(spots, owners, turn, count):
    """Keep of many touching points the lowest and those furthest out around it, in front of the others."""
    best, first = math.inf, 0
    for k in range(count):
        level = turn[6] * spots[k, 0] + turn[7] * spots[k, 1] + turn[8] * spots[k, 2]
        if level < best:
            best, first = level, k
    swap(spots, owners, 0, first)
    kept = 1
    for m in range(1, MOST):
        angle = 2.0 * math.pi * m / (MOST - 1)
        k = furthest(spots, turn, count, math.cos(angle), math.sin(angle))
        if k >= kept:
            swap(spots, owners, kept, k)
            kept += 1
    return kept


@compiled
def furthest(spots, turn, count, cos, sin):
    """Index of the point furthest along a direction of the floor."""
    best, first = -math.inf, 0
    for k in range(count):
        p = spots[k]
        x = turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
        y = turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
        if cos * x + sin * y > best:
            best, first = cos * x + sin * y, k
    return first


@compiled
def swap(spots, owners, i, j):
    """Exchange two points."""
    owners[i], owners[j] = owners[j], owners[i]
    for e in range(3):
        spots[i, e], spots[j, e] = spots[j, e], spots[i, e]


@compiled
def levers(inertia, work, count):
    """Fill the rows of ``work.contacts`` for the points found, where they are."""
    for n in range(count):
        arm(work.turn, work.spots[n], work.contacts[n])
        rates(inertia, work.contacts[n])
        masses(work.contacts[n])


@compiled
def levers_ahead(solid, work, count, dt):
    """Fill the rows for a step: impulses act half of it ahead, and speeds are wanted at its end.

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
            else:
                masses(work.contacts[n])


@compiled
def arm(turn, spot, row):
    """Fill the levers of a contact."""
    for e in range(3):
        x, y, z = turn[3 * e], turn[3 * e + 1], turn[3 * e + 2]
        k = LEVER + 3 * e
        row[k], row[k + 1] = spot[1] * z - spot[2] * y, spot[2] * x - spot[0] * z
        row[k + 2] = spot[0] * y - spot[1] * x


@compiled
def rates(inertia, row):
    """Fill the rates of a contact from its levers."""
    for k in range(9):
        row[RATE + k] = row[LEVER + k] / inertia[k % 3]


@compiled
def masses(row):
    """Fill the effective masses of a contact from its levers and rates."""
    xx, yy, zz = 1.0 + coupling(row, 0, 0), 1.0 + coupling(row, 1, 1), 1.0 + coupling(row, 2, 2)
    lean, mean, cross = 0.5 * (xx - yy), 0.5 * (xx + yy), coupling(row, 0, 1)
    row[MASS] = row[MASS + 1] = 1.0 / (mean + math.sqrt(lean * lean + cross * cross))
    row[MASS + 2] = 1.0 / zz


@compiled
def speed(state, row, e):
    """Velocity of a contact along floor axis e."""
    k = LEVER + 3 * e
    return state[VX + e] + row[k] * state[W] + row[k + 1] * state[W + 1] + row[k + 2] * state[W + 2]


@compiled
def push(state, row, e, impulse):
    """Add an impulse to a contact along floor axis e."""
    k = RATE + 3 * e
    state[VX + e] += impulse
    state[W] += row[k] * impulse
    state[W + 1] += row[k + 1] * impulse
    state[W + 2] += row[k + 2] * impulse
    row[IMPULSE + e] += impulse


@compiled
def coupling(row, d, e):
    """Velocity along floor axis d that one unit of impulse along e gives, of the rotation alone."""
    i, j = LEVER + 3 * d, RATE + 3 * e
    return row[i] * row[j] + row[i + 1] * row[j + 1] + row[i + 2] * row[j + 2]


@compiled
def stick(state, row, friction):
    """Impulse that holds a single contact still, if friction can; returns whether it was given."""
    u, v, w = -speed(state, row, 0), -speed(state, row, 1), row[WANTED] - speed(state, row, 2)
    xx, yy, zz = 1.0 + coupling(row, 0, 0), 1.0 + coupling(row, 1, 1), 1.0 + coupling(row, 2, 2)
    xy, xz, yz = coupling(row, 0, 1), coupling(row, 0, 2), coupling(row, 1, 2)
    yx, zx, zy = coupling(row, 1, 0), coupling(row, 2, 0), coupling(row, 2, 1)
    a, b, c = yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx
    whole = xx * a + xy * b + xz * c
    along = (a * u + (xz * zy - xy * zz) * v + (xy * yz - xz * yy) * w) / whole
    across = (b * u + (xx * zz - xz * zx) * v + (xz * yx - xx * yz) * w) / whole
    up = (c * u + (xy * zx - xx * zy) * v + (xx * yy - xy * yx) * w) / whole
    holds = up >= 0.0 and along * along + across * across <= (friction * up) ** 2
    if holds:
        push(state, row, 0, along)
        push(state, row, 1, across)
        push(state, row, 2, up)
    return holds


@compiled
def along(c, n, k, v, p, q, r):
    """Velocity of contact n along one axis: of the centre there, and of the rates on the lever at k."""
    return v + c[n, k] * p + c[n, k + 1] * q + c[n, k + 2] * r


@compiled
def spun(c, n, k, impulse, p, q, r):
    """Rates after an impulse along the axis whose RATE column is k."""
    return p + c[n, k] * impulse, q + c[n, k + 1] * impulse, r + c[n, k + 2] * impulse


@compiled
def relax(c, n, friction, u, v, w, p, q, r):
    """One projected Gauss-Seidel step on contact n: velocities, rates and the change of its impulse."""
    x, y, z = c[n, IMPULSE], c[n, IMPULSE + 1], c[n, IMPULSE + 2]
    up = max(z + c[n, MASS + 2] * (c[n, WANTED] - along(c, n, LEVER + 6, w, p, q, r)), 0.0)
    w += up - z
    p, q, r = spun(c, n, RATE + 6, up - z, p, q, r)
    ahead = x - c[n, MASS] * along(c, n, LEVER, u, p, q, r)
    aside = y - c[n, MASS + 1] * along(c, n, LEVER + 3, v, p, q, r)
    size, most = ahead * ahead + aside * aside, friction * up
    if size > most * most:
        scale = most / math.sqrt(size)
        ahead, aside = scale * ahead, scale * aside
    u += ahead - x
    p, q, r = spun(c, n, RATE, ahead - x, p, q, r)
    v += aside - y
    p, q, r = spun(c, n, RATE + 3, aside - y, p, q, r)
    c[n, IMPULSE], c[n, IMPULSE + 1], c[n, IMPULSE + 2] = ahead, aside, up
    return u, v, w, p, q, r, abs(up - z) + abs(ahead - x) + abs(aside - y)


@compiled
def solve(state, contacts, count, friction, steps):
    """Contact impulses with Coulomb friction: each contact leaves at its wanted speed or faster.

    Swept until a whole sweep changes the impulses by no more than ``steps.converged`` of their sum.
    """
    if count == 1 and stick(state, contacts[0], friction):
        return
    u, v, w = state[VX], state[VX + 1], state[VZ]
    p, q, r = state[W], state[W + 1], state[W + 2]
    for _ in range(steps.sweeps):
        change = size = 0.0
        for n in range(count):
            u, v, w, p, q, r, more = relax(contacts, n, friction, u, v, w, p, q, r)
            change += more
            size += contacts[n, IMPULSE + 2]
        if change <= steps.converged * size:
            break
    state[VX], state[VX + 1], state[VZ] = u, v, w
    state[W], state[W + 1], state[W + 2] = p, q, r


@compiled
def strike(inertia, state, saved, contacts, count, restitution, friction, steps):
    """Impact: corners that approach faster than the threshold rebound; energy is never won."""
    before = energy(state, inertia)
    keep(state, saved)
    for trial in range(4):
        bounce = restitution * (1.0 - trial / 3.0)  # less where friction would make Newton's rule win energy
        for n in range(count):
            row = contacts[n]
            fall = speed(state, row, 2)
            row[WANTED] = -bounce * fall if fall < -steps.threshold else 0.0
            row[IMPULSE] = row[IMPULSE + 1] = row[IMPULSE + 2] = 0.0
        solve(state, contacts, count, friction, steps)
        if energy(state, inertia) <= before + 1e-12:
            return
        keep(saved, state)


@compiled
def steepest(state, contacts, count):
    """Upward speed of the contact that falls fastest."""
    fall = math.inf
    for n in range(count):
        fall = min(fall, speed(state, contacts[n], 2))
    return fall


@compiled
def hold(state, contacts, count, friction, steps):
    """Contact impulses that let nothing fall further, without rebound."""
    for n in range(count):
        for k in range(WANTED, WIDTH):
            contacts[n, k] = 0.0
    solve(state, contacts, count, friction, steps)
