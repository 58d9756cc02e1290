"""Compiled contact of one body with the floor: which corners touch, and the impulses they give.

A contact is a row of WIDTH numbers. Along floor axis e (x, y, z in turn) it holds the lever p x e in body
axes, from corner p; the rates one unit of impulse along e gives, lever / inertia; its effective mass; then
the upward speed wanted after the impulse; then the impulse itself, (x, y, z).
"""

import math

from feederscrew.dropping.kernel.body import VX, VZ, W, energy, keep
from feederscrew.geometry.compiled import compiled

MOST = 12  # contacts solved together; of more, the lowest and those furthest out in the other directions
LEVER, RATE, MASS, WANTED, IMPULSE, WIDTH = 0, 9, 18, 21, 22, 25
CONVERGED = 1e-3  # of the relative velocity, in a whole sweep


@compiled
def touching(points, links, turn, height, corner, reach, seen, found):
    """Corners within ``reach`` of the floor, by flooding the hull's edges from the lowest one.

    ``seen`` is scratch (V,), all False before and after; fills ``found`` (V + MOST,) and returns how many.
    """
    a, b, c = turn[6], turn[7], turn[8]
    found[0], seen[corner] = corner, True
    count, done = 1, 0
    while done < count:
        here = found[done]
        done += 1
        for k in range(links[here], links[here + 1]):
            other = links[k]
            level = a * points[other, 0] + b * points[other, 1] + c * points[other, 2]
            if not seen[other] and height + level <= reach:
                found[count], seen[other] = other, True
                count += 1
    for k in range(count):
        seen[found[k]] = False
    return thin_out(points, turn, found, count) if count > MOST else count


@compiled
def thin_out(points, turn, found, count):
    """Keep of many touching corners the lowest, which is the first, and those furthest out around it."""
    kept = found[len(points) :]
    kept[0] = found[0]
    for m in range(1, MOST):
        turn_to = 2.0 * math.pi * m / (MOST - 1)
        cos, sin = math.cos(turn_to), math.sin(turn_to)
        best = -math.inf
        for k in range(count):
            p = points[found[k]]
            x = turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
            y = turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
            if cos * x + sin * y > best:
                best, kept[m] = cos * x + sin * y, found[k]
    number = 0
    for m in range(MOST):
        fresh = True
        for k in range(number):
            fresh = fresh and found[k] != kept[m]
        if fresh:
            found[number] = kept[m]
            number += 1
    return number


@compiled
def levers(points, inertia, turn, found, count, contacts):
    """Fill the rows of ``contacts`` for the corners found."""
    for n in range(count):
        row, p = contacts[n], points[found[n]]
        for e in range(3):
            x, y, z = turn[3 * e], turn[3 * e + 1], turn[3 * e + 2]
            k = LEVER + 3 * e
            row[k], row[k + 1], row[k + 2] = p[1] * z - p[2] * y, p[2] * x - p[0] * z, p[0] * y - p[1] * x
            turned = 0.0
            for i in range(3):
                row[RATE + 3 * e + i] = row[k + i] / inertia[i]
                turned += row[k + i] * row[RATE + 3 * e + i]
            row[MASS + e] = 1.0 / (1.0 + turned)
            row[IMPULSE + e] = 0.0


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
def stick(state, row, friction):
    """Impulse that holds a single contact still, if friction can; returns whether it was given."""
    u, v, w = -speed(state, row, 0), -speed(state, row, 1), row[WANTED] - speed(state, row, 2)
    xx, yy, zz = 1.0 / row[MASS], 1.0 / row[MASS + 1], 1.0 / row[MASS + 2]
    xy = xz = yz = 0.0
    for i in range(3):
        xy += row[LEVER + i] * row[RATE + 3 + i]
        xz += row[LEVER + i] * row[RATE + 6 + i]
        yz += row[LEVER + 3 + i] * row[RATE + 6 + i]
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    whole = xx * a + xy * b + xz * c
    along = (a * u + b * v + c * w) / whole
    across = (b * u + (xx * zz - xz * xz) * v + (xy * xz - xx * yz) * w) / whole
    up = (c * u + (xy * xz - xx * yz) * v + (xx * yy - xy * xy) * w) / whole
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
def solve(state, contacts, count, friction, sweeps):
    """Contact impulses with Coulomb friction: each contact leaves at its wanted speed or faster."""
    if count == 1 and stick(state, contacts[0], friction):
        return
    u, v, w = state[VX], state[VX + 1], state[VZ]
    p, q, r = state[W], state[W + 1], state[W + 2]
    for _ in range(sweeps):
        change = size = 0.0
        for n in range(count):
            u, v, w, p, q, r, more = relax(contacts, n, friction, u, v, w, p, q, r)
            change += more
            size += contacts[n, IMPULSE + 2]
        if change <= CONVERGED * size:
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
        solve(state, contacts, count, friction, steps.sweeps)
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
def hold(state, contacts, count, friction, sweeps):
    """Contact impulses that let nothing fall further, without rebound."""
    for n in range(count):
        for k in range(WANTED, WIDTH):
            contacts[n, k] = 0.0
    solve(state, contacts, count, friction, sweeps)
