"""Compiled jets of air: what of a part is in one takes its share of the thrust."""

import math

from feederscrew.arrivals.kernel.body import X, Y, Z
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.base.arrays import Floats, Row
from feederscrew.base.geometry.compiled import compiled, outlined
from feederscrew.trials.kernel.plate_views import (
    BLOCK,
    cross,
    dot,
    point_along,
    rotate,
    rotate_back,
    subtract,
)
from feederscrew.trials.kernel.workspace import Surface, TrueSolid, Vec3, Workspace

RAYS = 24  # of a jet, each of one share of its thrust
LOOKS_PER_PERIOD = 8.0  # of the drive: so often it is looked at what a jet meets
GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))  # [rad] from one ray to the next
BALL_SLACK = 1e-6  # [1] of the square of the unit of length: rays that pass a ball by less are followed
EDGE_ON = 1e-12  # twice the area across a ray: a facet seen edge on is not met


@compiled
def ray(k: int) -> tuple[float, float]:
    """Return the place of the k-th ray in the round section of a jet, over its radius [1]: evenly spread."""
    off = math.sqrt((k + 0.5) / RAYS)
    return off * math.cos(GOLDEN_ANGLE * k), off * math.sin(GOLDEN_ANGLE * k)


@compiled
def blow(
    surface: Surface, solid: TrueSolid, floor: Floor, work: Workspace, n: int, time: float, dt: float
) -> None:
    """Add what jets change of velocity and rates [sqrt(g L), sqrt(g/L)] over a step to ``work.changes``."""
    loads, until = work.jet_loads[n], work.jets_until[n]
    often = 2.0 * math.pi / floor.rate / LOOKS_PER_PERIOD if floor.rate > 0.0 else dt
    if not until - often <= time < until:
        for k in range(6):
            loads[k] = 0.0
        work.jets_until[n] = time + often
        for j in range(len(surface.jets)):
            jet = surface.jets[j]
            if jet.begin <= time < jet.end:
                _add_jet(jet, solid, work.starts[n], work.turns[n], loads)
    for k in range(3):
        work.changes[n, k] += dt * loads[k]
        work.changes[n, 3 + k] += dt * loads[3 + k] / solid.inertia[k]


@outlined
def _add_jet(jet: Row, solid: TrueSolid, state: Floats, turn: Floats, loads: Floats) -> None:
    """Add force, and torque about the body's axes, of one jet to ``loads``.

    A ray loses what of its momentum goes into the facet, and flows off along it.
    """
    a, b, c = jet.towards_x, jet.towards_y, jet.towards_z
    x, y, z = state[X] - jet.mouth_x, state[Y] - jet.mouth_y, state[Z] - jet.mouth_z
    ahead, far = a * x + b * y + c * z, solid.radius
    if not -far < ahead < jet.reach + far:
        return
    wide = jet.radius + jet.spread * max(ahead + far, 0.0)
    if x * x + y * y + z * z - ahead * ahead > (wide + far) * (wide + far):
        return
    # two directions across it
    if abs(c) < 0.9:
        size = math.sqrt(a * a + b * b)
        u = (-b / size, a / size, 0.0)
    else:
        size = math.sqrt(b * b + c * c)
        u = (0.0, -c / size, b / size)
    v = cross((a, b, c), u)
    for k in range(RAYS):
        p, q = ray(k)
        p, q, wider = p * jet.radius, q * jet.radius, jet.spread / jet.radius
        off = (p * u[0] + q * v[0], p * u[1] + q * v[1], p * u[2] + q * v[2])
        spot = rotate_back(turn, subtract(off, (x, y, z)))
        direction = rotate_back(turn, (a + wider * off[0], b + wider * off[1], c + wider * off[2]))
        distance, facet = _first_facet(solid, spot, direction)
        if 0.0 <= distance < jet.reach:
            n = solid.normals[facet]
            # below 0: against the facet
            push = jet.thrust / RAYS * dot(direction, n) / math.sqrt(dot(direction, direction))
            force, torque = rotate(turn, n), cross(point_along(spot, distance, direction), n)
            for e in range(3):
                loads[e] += push * force[e]
                loads[3 + e] += push * torque[e]


@compiled
def _first_facet(solid: TrueSolid, spot: Vec3, direction: Vec3) -> tuple[float, int]:
    """Return how far along a ray it meets the body first, infinite where not, and which facet."""
    best, facet, size = math.inf, 0, dot(direction, direction)
    for block in range(len(solid.face_blocks)):
        ahead = square = ball = 0.0
        for e in range(3):
            off = 0.5 * (solid.face_blocks[block, e] + solid.face_blocks[block, 3 + e]) - spot[e]
            square += off * off
            ahead += off * direction[e]
            ball += 0.25 * (solid.face_blocks[block, 3 + e] - solid.face_blocks[block, e]) ** 2
        if square * size - ahead * ahead > (ball + BALL_SLACK) * size:  # it misses the ball around the box
            continue
        for f in range(BLOCK * block, min(BLOCK * (block + 1), len(solid.triangles))):
            slope = dot(direction, solid.normals[f])
            if slope >= 0.0:  # seen from behind
                continue
            a = solid.vertices[solid.triangles[f, 0]]
            fall = dot(subtract(a, spot), solid.normals[f])
            if fall > 0.0 or fall <= best * slope:  # behind the mouth, or farther than another
                continue
            # whether it goes through (Moeller and Trumbore)
            first = subtract(solid.vertices[solid.triangles[f, 1]], a)
            second = subtract(solid.vertices[solid.triangles[f, 2]], a)
            p, way = cross(direction, second), subtract(spot, a)
            flat = dot(first, p)
            if abs(flat) < EDGE_ON:
                continue
            u, v = dot(way, p) / flat, dot(direction, cross(way, first)) / flat
            if 0.0 <= u <= 1.0 and v >= 0.0 and u + v <= 1.0:
                best, facet = fall / slope, f
    return best, facet
