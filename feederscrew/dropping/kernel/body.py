"""Compiled motion of one rigid body; arrays are changed in place, for speed.

A state holds position x y z, velocity, quaternion w x y z (body to floor) and the rates along the body's
principal axes: 13 numbers. ``turn`` is the rotation matrix row by row, 9 numbers; the floor is z = 0.
"""

import math

from feederscrew.geometry.compiled import compiled

X, Y, Z, VX, VY, VZ, Q, W = 0, 1, 2, 3, 4, 5, 6, 10
STATE = 13


@compiled
def keep(source, target):
    """Copy one state into another; a loop is quicker here than a slice."""
    for k in range(STATE):
        target[k] = source[k]


@compiled
def rotation(state, turn):
    """Fill ``turn`` with the rotation matrix of a state."""
    a, b, c, d = state[Q], state[Q + 1], state[Q + 2], state[Q + 3]
    turn[0] = 1.0 - 2.0 * (c * c + d * d)
    turn[1] = 2.0 * (b * c - a * d)
    turn[2] = 2.0 * (b * d + a * c)
    turn[3] = 2.0 * (b * c + a * d)
    turn[4] = 1.0 - 2.0 * (b * b + d * d)
    turn[5] = 2.0 * (c * d - a * b)
    turn[6] = 2.0 * (b * d - a * c)
    turn[7] = 2.0 * (c * d + a * b)
    turn[8] = 1.0 - 2.0 * (b * b + c * c)


@compiled
def spin_energy(state, inertia):
    """Rotational energy."""
    p, q, r = state[W], state[W + 1], state[W + 2]
    return 0.5 * (inertia[0] * p * p + inertia[1] * q * q + inertia[2] * r * r)


@compiled
def rate(state):
    """How fast the body turns."""
    p, q, r = state[W], state[W + 1], state[W + 2]
    return math.sqrt(p * p + q * q + r * r)


@compiled
def moving_energy(state, inertia):
    """Kinetic energy at mass 1."""
    u, v, w = state[VX], state[VY], state[VZ]
    return spin_energy(state, inertia) + 0.5 * (u * u + v * v + w * w)


@compiled
def energy(state, inertia):
    """Kinetic energy and height: the total energy at mass 1 and gravity 1."""
    return moving_energy(state, inertia) + state[Z]


@compiled
def rotate(state, p, q, r, dt):
    """Turn the quaternion by body rates p, q, r over dt (Cayley map, second order)."""
    p, q, r = 0.5 * dt * p, 0.5 * dt * q, 0.5 * dt * r
    a, b, c, d = state[Q], state[Q + 1], state[Q + 2], state[Q + 3]
    e = a - b * p - c * q - d * r
    f = b + a * p + c * r - d * q
    g = c + a * q + d * p - b * r
    h = d + a * r + b * q - c * p
    n = 1.0 / math.sqrt(e * e + f * f + g * g + h * h)
    state[Q], state[Q + 1], state[Q + 2], state[Q + 3] = n * e, n * f, n * g, n * h


@compiled
def spin(state, inertia, dt):
    """Free rotation over dt: midpoint rule, then rates scaled so that no energy is won or lost."""
    i, j, k = inertia[0], inertia[1], inertia[2]
    a, b, c = (j - k) / i, (k - i) / j, (i - j) / k  # Euler's equations
    p, q, r = state[W], state[W + 1], state[W + 2]
    before = i * p * p + j * q * q + k * r * r
    pm, qm, rm = p + 0.5 * dt * a * q * r, q + 0.5 * dt * b * r * p, r + 0.5 * dt * c * p * q
    p, q, r = p + dt * a * qm * rm, q + dt * b * rm * pm, r + dt * c * pm * qm
    after = i * p * p + j * q * q + k * r * r
    scale = math.sqrt(before / after) if after > 0.0 else 1.0
    state[W], state[W + 1], state[W + 2] = scale * p, scale * q, scale * r
    rotate(state, pm, qm, rm, dt)


@compiled
def fly(state, inertia, dt):
    """Ballistic flight over dt."""
    state[X] += dt * state[VX]
    state[Y] += dt * state[VY]
    state[Z] += dt * (state[VZ] - 0.5 * dt)
    state[VZ] -= dt
    spin(state, inertia, dt)


@compiled
def lowest(points, links, turn, corner):
    """Lowest corner, going down the hull's edges from ``corner``; and its height over the body's centre."""
    a, b, c = turn[6], turn[7], turn[8]
    best = a * points[corner, 0] + b * points[corner, 1] + c * points[corner, 2]
    while True:
        here = corner
        for k in range(links[here], links[here + 1]):
            other = links[k]
            level = a * points[other, 0] + b * points[other, 1] + c * points[other, 2]
            if level < best:
                best, corner = level, other
        if corner == here:
            return corner, best


@compiled
def rim_level(rims, k, turn):
    """Height of the lowest point of a rim over the body's centre; infinite where an arc does not reach it."""
    a, b, c = turn[6], turn[7], turn[8]
    along = a * rims[k, 3] + b * rims[k, 4] + c * rims[k, 5]
    x, y, z = a - along * rims[k, 3], b - along * rims[k, 4], c - along * rims[k, 5]
    size = math.sqrt(x * x + y * y + z * z)
    if rims[k, 10] > -1.0 and -(x * rims[k, 7] + y * rims[k, 8] + z * rims[k, 9]) < size * rims[k, 10]:
        return math.inf
    return a * rims[k, 0] + b * rims[k, 1] + c * rims[k, 2] - rims[k, 6] * size


@compiled
def bottom(solid, turn, corner):
    """Corner from which to look on, and the height of the body's lowest point over its centre."""
    corner, level = lowest(solid.vertices, solid.links, turn, corner)
    if solid.inner[corner]:  # its rim is lower, but for rounding
        level = math.inf
    for k in range(len(solid.rims)):
        level = min(level, rim_level(solid.rims, k, turn))
    return corner, level


@compiled
def slow_down(state, inertia, limit):
    """Scale velocities so that the kinetic energy is at most ``limit``; those along the floor last."""
    moving = moving_energy(state, inertia)
    along = 0.5 * (state[VX] * state[VX] + state[VY] * state[VY])
    if moving <= limit:
        return
    if along > limit:
        scale = math.sqrt(max(limit, 0.0) / along)
        state[VX] *= scale
        state[VY] *= scale
    left = max(limit - along, 0.0)
    scale = math.sqrt(left / (moving - along)) if moving > along else 0.0
    state[VZ] *= scale
    for k in range(3):
        state[W + k] *= scale
