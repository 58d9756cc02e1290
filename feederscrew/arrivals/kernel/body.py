"""Compiled motion of one rigid body; arrays are changed in place, for speed.

A state holds position x y z, velocity, quaternion w x y z (body to floor) and the rates along the body's
principal axes: 13 numbers. ``turn`` is the rotation matrix row by row, 9 numbers; the floor is z = 0.
"""

import math

from feederscrew.arrivals.rounded_hull import RoundedHull
from feederscrew.base.arrays import Floats, Ints, Points, Triple
from feederscrew.base.geometry.compiled import compiled

# places in a state; of a vector, that of its first number
X = 0  # [L] of the centre of mass
Y = 1
Z = 2
VX = 3  # [sqrt(g L)] of the centre of mass
VY = 4
VZ = 5
Q = 6  # attitude, a unit quaternion w x y z
W = 10  # [sqrt(g / L)] angular velocity along the body's axes
STATE = 13  # numbers in a state
Moves = tuple[float, float, float, float, float, float]  # velocity and rates of a body


@compiled
def keep(source: Floats, target: Floats) -> None:
    """Copy one state (13,) [L, sqrt(g L), 1, sqrt(g/L)] into another; a loop is quicker here than a slice."""
    for k in range(STATE):
        target[k] = source[k]


@compiled
def velocity(state: Floats) -> Triple:
    """Return the velocity (3,) [sqrt(g L)] of a state (13,)."""
    return state[VX], state[VY], state[VZ]


@compiled
def set_velocity(state: Floats, u: float, v: float, w: float) -> None:
    """Write the velocity [sqrt(g L)] of a state (13,)."""
    state[VX], state[VY], state[VZ] = u, v, w


@compiled
def moves_of(state: Floats) -> Moves:
    """Return the velocity [sqrt(g L)] and the rates [sqrt(g/L)] of a state (13,), (6,)."""
    return state[VX], state[VY], state[VZ], state[W], state[W + 1], state[W + 2]


@compiled
def set_moves(state: Floats, moves: Moves) -> None:
    """Write the velocity [sqrt(g L)] and the rates [sqrt(g/L)] (6,) of a state (13,)."""
    state[VX], state[VY], state[VZ], state[W], state[W + 1], state[W + 2] = moves


@compiled
def rotation(state: Floats, turn: Floats) -> None:
    """Fill ``turn`` (9,) [1] with the rotation matrix of a state (13,), row by row."""
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
def spin_energy(state: Floats, inertia: Floats) -> float:
    """Return the rotational energy over mass [g L] of a state (13,), from the inertia (3,) over mass [L2].

    Source: Newton and Euler for a rigid body.
    """
    p, q, r = state[W], state[W + 1], state[W + 2]
    return 0.5 * (inertia[0] * p * p + inertia[1] * q * q + inertia[2] * r * r)


@compiled
def rate(state: Floats) -> float:
    """Return how fast the body of a state (13,) turns [sqrt(g/L)].

    Source: Newton and Euler for a rigid body.
    """
    p, q, r = state[W], state[W + 1], state[W + 2]
    return math.sqrt(p * p + q * q + r * r)


@compiled
def moving_energy(state: Floats, inertia: Floats) -> float:
    """Return the kinetic energy over mass [g L] of a state (13,).

    Source: Newton and Euler for a rigid body.
    """
    u, v, w = velocity(state)
    return spin_energy(state, inertia) + 0.5 * (u * u + v * v + w * w)


@compiled
def energy(state: Floats, inertia: Floats) -> float:
    """Return kinetic energy and height of a state (13,): the total energy over mass [g L].

    Source: Newton and Euler for a rigid body.
    """
    return moving_energy(state, inertia) + state[Z]


@compiled
def rotate(state: Floats, p: float, q: float, r: float, dt: float) -> None:
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
def turn_freely(state: Floats, inertia: Floats, dt: float) -> None:
    """Rotate a state (13,) freely over ``dt`` [sqrt(L/g)] on the floor: by the midpoint rule, energy kept."""
    i, j, k = inertia[0], inertia[1], inertia[2]
    a, b, c = (j - k) / i, (k - i) / j, (i - j) / k  # Euler's equations
    p, q, r = state[W], state[W + 1], state[W + 2]
    before = i * p * p + j * q * q + k * r * r
    pm, qm, rm = p + 0.5 * dt * a * q * r, q + 0.5 * dt * b * r * p, r + 0.5 * dt * c * p * q
    p, q, r = p + dt * a * qm * rm, q + dt * b * rm * pm, r + dt * c * pm * qm
    after = i * p * p + j * q * q + k * r * r
    scale = math.sqrt(before / after) if after > 0.0 else 1.0
    state[W], state[W + 1], state[W + 2] = scale * p, scale * q, scale * r


@compiled
def tumble(state: Floats, inertia: Floats, dt: float) -> None:
    """Rotate a state (13,) freely over ``dt`` [sqrt(L/g)], to fourth order.

    The rates follow Euler's equations by the rule of Runge and Kutta, then no energy is won or lost. The turn
    is the first terms of Magnus' series, h / 2 (w + w') + h^2 / 12 (dw - dw' + w x w'): the rates are a cubic
    between both ends, w and w', where they change as fast as dw and dw'.

    Source: S. Blanes, F. Casas, J. A. Oteo, J. Ros, "The Magnus expansion and some of its applications",
    Physics Reports 470, 151-238, 2009.
    """
    i, j, k = inertia[0], inertia[1], inertia[2]
    a, b, c, half = (j - k) / i, (k - i) / j, (i - j) / k, 0.5 * dt
    p, q, r = state[W], state[W + 1], state[W + 2]
    p1, q1, r1 = a * q * r, b * r * p, c * p * q
    x, y, z = p + half * p1, q + half * q1, r + half * r1
    p2, q2, r2 = a * y * z, b * z * x, c * x * y
    x, y, z = p + half * p2, q + half * q2, r + half * r2
    p3, q3, r3 = a * y * z, b * z * x, c * x * y
    x, y, z = p + dt * p3, q + dt * q3, r + dt * r3
    u = p + dt / 6.0 * (p1 + 2.0 * (p2 + p3) + a * y * z)
    v = q + dt / 6.0 * (q1 + 2.0 * (q2 + q3) + b * z * x)
    w = r + dt / 6.0 * (r1 + 2.0 * (r2 + r3) + c * x * y)
    after = i * u * u + j * v * v + k * w * w
    scale = math.sqrt((i * p * p + j * q * q + k * r * r) / after) if after > 0.0 else 1.0
    u, v, w = scale * u, scale * v, scale * w
    state[W], state[W + 1], state[W + 2] = u, v, w
    bend = dt * dt / 12.0
    x = half * (p + u) + bend * (p1 - a * v * w + q * w - r * v)
    y = half * (q + v) + bend * (q1 - b * w * u + r * u - p * w)
    z = half * (r + w) + bend * (r1 - c * u * v + p * v - q * u)
    square = 0.25 * (x * x + y * y + z * z)
    tangent = 1.0 + square * (1.0 / 3.0 + square * (2.0 / 15.0 + square * (17.0 / 315.0)))  # of half the turn
    rotate(state, tangent * x, tangent * y, tangent * z, 1.0)


@compiled
def fly(state: Floats, inertia: Floats, dt: float) -> None:
    """Fly a state (13,) over ``dt`` [sqrt(L/g)]."""
    u, v, w = velocity(state)
    state[X] += dt * u
    state[Y] += dt * v
    state[Z] += dt * (w - 0.5 * dt)
    set_velocity(state, u, v, w - dt)
    tumble(state, inertia, dt)


@compiled
def lowest(points: Points, links: Ints, turn: Floats, corner: int) -> tuple[int, float]:
    """Find the lowest of the points (V, 3) [L], down the hull's edges; return it and its height [L]."""
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
def rim_level(rims: Floats, k: int, turn: Floats) -> float:
    """Return the height [L] of a rim's lowest point over the centre; infinite where an arc has none.

    Source: a circle is lowest where the vertical, seen in its plane, points down.
    """
    a, b, c = turn[6], turn[7], turn[8]
    along = a * rims[k, 3] + b * rims[k, 4] + c * rims[k, 5]
    x, y, z = a - along * rims[k, 3], b - along * rims[k, 4], c - along * rims[k, 5]
    size = math.sqrt(x * x + y * y + z * z)
    if rims[k, 10] > -1.0 and -(x * rims[k, 7] + y * rims[k, 8] + z * rims[k, 9]) < size * rims[k, 10]:
        return math.inf
    return a * rims[k, 0] + b * rims[k, 1] + c * rims[k, 2] - rims[k, 6] * size


@compiled
def bottom(solid: RoundedHull, turn: Floats, corner: int) -> tuple[int, float]:
    """Return the corner from which to look on, and the height [L] of the body's lowest point over its centre.

    A corner that a rim replaces counts, too: beyond an arc's end, and by rounding, its rim is not lower.
    """
    corner, level = lowest(solid.vertices, solid.links, turn, corner)
    for k in range(len(solid.rims)):
        level = min(level, rim_level(solid.rims, k, turn))
    return corner, level
