"""Compiled jets of air: what of a part is in one takes its share of the thrust."""

import math

from feederscrew.dropping.kernel.body import X
from feederscrew.geometry.compiled import apart, compiled

MOUTH, TOWARDS, RADIUS, SPREAD, THRUST, REACH, BEGIN, END = 0, 3, 6, 7, 8, 9, 10, 11  # columns of a jet
AGAIN = 6  # column of what is blown: when a part is looked at again
RAYS = 24  # of a jet, each of one share of its thrust
OFTEN = 8.0  # times a period of the drive a part is looked at
GOLDEN = math.pi * (3.0 - math.sqrt(5.0))  # [rad] from one ray to the next
EDGE_ON = 1e-12  # twice the area across a ray: a facet seen edge on is not met


@compiled
def ray(k):
    """Return the place of the k-th ray in the round section of a jet, over its radius [1]: evenly spread."""
    off = math.sqrt((k + 0.5) / RAYS)
    return off * math.cos(GOLDEN * k), off * math.sin(GOLDEN * k)


@compiled
def blow(surface, solid, floor, crowd, n, time, dt):
    """Add what jets change of velocity and rates [sqrt(g L), sqrt(g/L)] over a step to ``crowd.given``."""
    blown = crowd.blown[n]
    often = 2.0 * math.pi / floor.rate / OFTEN if floor.rate > 0.0 else dt
    if not blown[AGAIN] - often <= time < blown[AGAIN]:
        for k in range(6):
            blown[k] = 0.0
        blown[AGAIN] = time + often
        for j in range(len(surface.jets)):
            if surface.jets[j, BEGIN] <= time < surface.jets[j, END]:
                _in_jet(surface.jets[j], solid, crowd.before[n], crowd.turns[n], blown)
    for k in range(3):
        crowd.given[n, k] += dt * blown[k]
        crowd.given[n, 3 + k] += dt * blown[3 + k] / solid.inertia[k]


@apart
def _in_jet(jet, solid, state, turn, blown):
    """Add force, and torque about the body's axes, of one jet to ``blown``.

    A ray loses what of its momentum goes into the facet, and flows off along it.
    """
    a, b, c = jet[TOWARDS], jet[TOWARDS + 1], jet[TOWARDS + 2]
    x, y, z = state[X] - jet[0], state[X + 1] - jet[1], state[X + 2] - jet[2]
    ahead = a * x + b * y + c * z
    far = solid.radius
    if not -far < ahead < jet[REACH] + far:
        return
    wide = jet[RADIUS] + jet[SPREAD] * max(ahead + far, 0.0)
    if x * x + y * y + z * z - ahead * ahead > (wide + far) * (wide + far):
        return
    u = _across(a, b, c)  # two directions across it
    v = (b * u[2] - c * u[1], c * u[0] - a * u[2], a * u[1] - b * u[0])
    for k in range(RAYS):
        p, q = ray(k)
        p, q = p * jet[RADIUS], q * jet[RADIUS]
        wider = jet[SPREAD] / jet[RADIUS]
        spot = (p * u[0] + q * v[0] - x, p * u[1] + q * v[1] - y, p * u[2] + q * v[2] - z)
        way = (
            a + wider * (p * u[0] + q * v[0]), b + wider * (p * u[1] + q * v[1]),
            c + wider * (p * u[2] + q * v[2]),
        )  # fmt: skip
        spot, way = _turned(turn, spot), _turned(turn, way)
        met, facet = _first(solid, spot, way)
        if 0.0 <= met < jet[REACH]:
            n = solid.normals[facet]
            into = way[0] * n[0] + way[1] * n[1] + way[2] * n[2]
            size = math.sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2])
            push = jet[THRUST] / RAYS * into / size  # below 0: against the facet
            h = (spot[0] + met * way[0], spot[1] + met * way[1], spot[2] + met * way[2])
            force = (n[0], n[1], n[2])
            for e in range(3):
                blown[e] += push * (turn[3 * e] * n[0] + turn[3 * e + 1] * n[1] + turn[3 * e + 2] * n[2])
            blown[3] += push * (h[1] * force[2] - h[2] * force[1])
            blown[4] += push * (h[2] * force[0] - h[0] * force[2])
            blown[5] += push * (h[0] * force[1] - h[1] * force[0])


@compiled
def _across(a, b, c):
    """A unit vector across a direction."""
    if abs(c) < 0.9:
        size = math.sqrt(a * a + b * b)
        return -b / size, a / size, 0.0
    size = math.sqrt(b * b + c * c)
    return 0.0, -c / size, b / size


@compiled
def _turned(turn, p):
    """A vector of the bowl in the body's axes."""
    return (
        turn[0] * p[0] + turn[3] * p[1] + turn[6] * p[2],
        turn[1] * p[0] + turn[4] * p[1] + turn[7] * p[2],
        turn[2] * p[0] + turn[5] * p[1] + turn[8] * p[2],
    )


@compiled
def _first(solid, spot, way):
    """How far along a ray it meets the body first, infinite where it does not, and which facet."""
    best, facet = math.inf, 0
    for f in range(len(solid.triangles)):
        n = solid.normals[f]
        slope = way[0] * n[0] + way[1] * n[1] + way[2] * n[2]
        if slope >= 0.0:  # seen from behind
            continue
        a = solid.vertices[solid.triangles[f, 0]]
        fall = (a[0] - spot[0]) * n[0] + (a[1] - spot[1]) * n[1] + (a[2] - spot[2]) * n[2]
        if fall > 0.0 or fall <= best * slope:  # behind the mouth, or farther than another
            continue
        if _through(solid, f, a, spot, way):
            best, facet = fall / slope, f
    return best, facet


@compiled
def _through(solid, f, a, spot, way):
    """Whether a ray goes through a facet, whose first corner is ``a`` (Moeller and Trumbore)."""
    b, c = solid.vertices[solid.triangles[f, 1]], solid.vertices[solid.triangles[f, 2]]
    d, e, g = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    h, i, j = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    p = (way[1] * j - way[2] * i, way[2] * h - way[0] * j, way[0] * i - way[1] * h)
    flat = d * p[0] + e * p[1] + g * p[2]
    if abs(flat) < EDGE_ON:
        return False
    x, y, z = spot[0] - a[0], spot[1] - a[1], spot[2] - a[2]
    u = (x * p[0] + y * p[1] + z * p[2]) / flat
    if u < 0.0 or u > 1.0:
        return False
    v = (way[0] * (y * g - z * e) + way[1] * (z * d - x * g) + way[2] * (x * e - y * d)) / flat
    return v >= 0.0 and u + v <= 1.0
