"""Compiled jets of air: what of a part is in one takes its share of the thrust."""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import compiled, outlined
from feederscrew.trial.kernel.plate_views import BLOCK, turned_back

RAYS = 24  # of a jet, each of one share of its thrust
LOOKS_PER_PERIOD = 8.0  # of the drive: so often it is looked at what a jet meets
GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))  # [rad] from one ray to the next
BALL_SLACK = 1e-6  # [1] of the square of the unit of length: rays that pass a ball by less are followed
EDGE_ON = 1e-12  # twice the area across a ray: a facet seen edge on is not met


@compiled
def ray(k):
    """Return the place of the k-th ray in the round section of a jet, over its radius [1]: evenly spread."""
    off = math.sqrt((k + 0.5) / RAYS)
    return off * math.cos(GOLDEN_ANGLE * k), off * math.sin(GOLDEN_ANGLE * k)


@compiled
def blow(surface, solid, floor, work, n, time, dt):
    """Add what jets change of velocity and rates [sqrt(g L), sqrt(g/L)] over a step to ``work.changes``."""
    blown, until = work.blown[n], work.blown_until[n]
    often = 2.0 * math.pi / floor.rate / LOOKS_PER_PERIOD if floor.rate > 0.0 else dt
    if not until - often <= time < until:
        for k in range(6):
            blown[k] = 0.0
        work.blown_until[n] = time + often
        for j in range(len(surface.jets)):
            jet = surface.jets[j]
            if jet.begin <= time < jet.end:
                _add_jet(jet, solid, work.before[n], work.turns[n], blown)
    for k in range(3):
        work.changes[n, k] += dt * blown[k]
        work.changes[n, 3 + k] += dt * blown[3 + k] / solid.inertia[k]


@outlined
def _add_jet(jet, solid, state, turn, blown):
    """Add force, and torque about the body's axes, of one jet to ``blown``.

    A ray loses what of its momentum goes into the facet, and flows off along it.
    """
    a, b, c = jet.towards_x, jet.towards_y, jet.towards_z
    x, y, z = state[X] - jet.mouth_x, state[Y] - jet.mouth_y, state[Z] - jet.mouth_z
    ahead = a * x + b * y + c * z
    far = solid.radius
    if not -far < ahead < jet.reach + far:
        return
    wide = jet.radius + jet.spread * max(ahead + far, 0.0)
    if x * x + y * y + z * z - ahead * ahead > (wide + far) * (wide + far):
        return
    u = _across(a, b, c)  # two directions across it
    v = (b * u[2] - c * u[1], c * u[0] - a * u[2], a * u[1] - b * u[0])
    for k in range(RAYS):
        p, q = ray(k)
        p, q = p * jet.radius, q * jet.radius
        wider = jet.spread / jet.radius
        spot = (p * u[0] + q * v[0] - x, p * u[1] + q * v[1] - y, p * u[2] + q * v[2] - z)
        direction = (
            a + wider * (p * u[0] + q * v[0]), b + wider * (p * u[1] + q * v[1]),
            c + wider * (p * u[2] + q * v[2]),
        )  # fmt: skip
        spot, direction = turned_back(turn, spot), turned_back(turn, direction)
        distance, facet = _first_facet(solid, spot, direction)
        if 0.0 <= distance < jet.reach:
            n = solid.normals[facet]
            into = direction[0] * n[0] + direction[1] * n[1] + direction[2] * n[2]
            size = math.sqrt(
                direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]
            )
            push = jet.thrust / RAYS * into / size  # below 0: against the facet
            h = (
                spot[0] + distance * direction[0],
                spot[1] + distance * direction[1],
                spot[2] + distance * direction[2],
            )
            for e in range(3):
                blown[e] += push * (turn[3 * e] * n[0] + turn[3 * e + 1] * n[1] + turn[3 * e + 2] * n[2])
            blown[3] += push * (h[1] * n[2] - h[2] * n[1])
            blown[4] += push * (h[2] * n[0] - h[0] * n[2])
            blown[5] += push * (h[0] * n[1] - h[1] * n[0])


@compiled
def _across(a, b, c):
    """A unit vector across a direction."""
    if abs(c) < 0.9:
        size = math.sqrt(a * a + b * b)
        return -b / size, a / size, 0.0
    size = math.sqrt(b * b + c * c)
    return 0.0, -c / size, b / size


@compiled
def _first_facet(solid, spot, direction):
    """How far along a ray it meets the body first, infinite where it does not, and which facet."""
    best, facet = math.inf, 0
    for block in range(len(solid.face_blocks)):
        if _passes_by(solid.face_blocks[block], spot, direction):
            continue
        for f in range(BLOCK * block, min(BLOCK * (block + 1), len(solid.triangles))):
            n = solid.normals[f]
            slope = direction[0] * n[0] + direction[1] * n[1] + direction[2] * n[2]
            if slope >= 0.0:  # seen from behind
                continue
            a = solid.vertices[solid.triangles[f, 0]]
            fall = (a[0] - spot[0]) * n[0] + (a[1] - spot[1]) * n[1] + (a[2] - spot[2]) * n[2]
            if fall > 0.0 or fall <= best * slope:  # behind the mouth, or farther than another
                continue
            if _goes_through(solid, f, a, spot, direction):
                best, facet = fall / slope, f
    return best, facet


@compiled
def _passes_by(box, spot, direction):
    """Whether the line of a ray surely misses the ball around a box (6,)."""
    size = ahead = square = ball = 0.0
    for e in range(3):
        off = 0.5 * (box[e] + box[3 + e]) - spot[e]
        square += off * off
        ahead += off * direction[e]
        size += direction[e] * direction[e]
        ball += 0.25 * (box[3 + e] - box[e]) ** 2
    return square * size - ahead * ahead > (ball + BALL_SLACK) * size


@compiled
def _goes_through(solid, f, a, spot, direction):
    """Whether a ray goes through a facet, whose first corner is ``a`` (Moeller and Trumbore)."""
    b, c = solid.vertices[solid.triangles[f, 1]], solid.vertices[solid.triangles[f, 2]]
    d, e, g = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    h, i, j = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    p = (
        direction[1] * j - direction[2] * i,
        direction[2] * h - direction[0] * j,
        direction[0] * i - direction[1] * h,
    )
    flat = d * p[0] + e * p[1] + g * p[2]
    if abs(flat) < EDGE_ON:
        return False
    x, y, z = spot[0] - a[0], spot[1] - a[1], spot[2] - a[2]
    u = (x * p[0] + y * p[1] + z * p[2]) / flat
    if u < 0.0 or u > 1.0:
        return False
    v = (
        direction[0] * (y * g - z * e) + direction[1] * (z * d - x * g) + direction[2] * (x * e - y * d)
    ) / flat
    return v >= 0.0 and u + v <= 1.0
