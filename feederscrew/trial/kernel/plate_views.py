"""Compiled views: how a plate sees a body, and how far points are from borders, faces and the wall."""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.crowd_records import ACROSS, ALONG, BEFORE, FRONT, NORMAL, WALL

DEEP = 0.04  # how far behind a surface anything may be found, in units of the part's length
SLANT = 0.02  # [1] by which a contact's normal may lie beyond the faces it is between
PARALLEL = 1e-3  # [1] sine of the angle below which two edges do not cross: their ends touch instead
INSIDE = 1.0 - 1e-9  # a border's end counts for the next border's start


@compiled
def seen_by(plate, state, turn, frame):
    """Write how a plate (21,) sees a body to ``frame`` (12,): rotation [1], row by row, and place [L]."""
    x, y, z = state[X] - plate[0], state[Y] - plate[1], state[Z] - plate[2]
    for e in range(3):
        u, v, w = plate[ACROSS + 3 * e], plate[ACROSS + 3 * e + 1], plate[ACROSS + 3 * e + 2]
        for k in range(3):
            frame[3 * e + k] = u * turn[k] + v * turn[3 + k] + w * turn[6 + k]
        frame[9 + e] = u * x + v * y + w * z


@compiled
def placed(frame, p):
    """Return where a point (3,) [L] of the body is, as a plate sees it [L]; frame (12,) of ``seen_by``."""
    return (
        frame[0] * p[0] + frame[1] * p[1] + frame[2] * p[2] + frame[9],
        frame[3] * p[0] + frame[4] * p[1] + frame[5] * p[2] + frame[10],
        frame[6] * p[0] + frame[7] * p[1] + frame[8] * p[2] + frame[11],
    )


@compiled
def level(frame, block):
    """Return the least and the greatest height [L] over a plate of what is in a box (6,) [L]."""
    middle, half = frame[11], 0.0
    for e in range(3):
        middle += 0.5 * frame[6 + e] * (block[e] + block[3 + e])
        half += 0.5 * abs(frame[6 + e]) * (block[3 + e] - block[e])
    return middle - half, middle + half


@compiled
def in_body(frame, x, y, z):
    """Return a vector that a plate sees, in the body's axes and its own unit [any]."""
    return (
        frame[0] * x + frame[3] * y + frame[6] * z,
        frame[1] * x + frame[4] * y + frame[7] * z,
        frame[2] * x + frame[5] * y + frame[8] * z,
    )


@compiled
def in_bowl(plate, x, y, z):
    """Return a vector that a plate sees, in the bowl's frame and its own unit [any]; ``plate`` (21,)."""
    return (
        x * plate[ACROSS] + y * plate[ALONG] + z * plate[FRONT],
        x * plate[ACROSS + 1] + y * plate[ALONG + 1] + z * plate[FRONT + 1],
        x * plate[ACROSS + 2] + y * plate[ALONG + 2] + z * plate[FRONT + 2],
    )


@compiled
def off_wall(surface, leans, x, y, z):
    """Return how far a point is from the wall [L], which stands upright also where the track is banked.

    Beside a groove it leans back: it is the other face of the V.
    """
    y -= surface.radius
    return leans[WALL + 1] * (surface.radius - math.sqrt(x * x + y * y)) - leans[WALL] * z


@compiled
def inside(borders, first, last, a, b):
    """Say whether a point (a, b) [L] of a plate is solid: within its borders (B, 12), holes left out."""
    odd = False
    for k in range(first, last):
        odd = odd != crossed(borders[k], a, b)
    return odd


@compiled
def crossed(border, a, b):
    """Say whether a line from a point (a, b) [L] of a plate along its first axis crosses a border (12,)."""
    p, q, r, s = border[0], border[1], border[2], border[3]
    return (q > b) != (s > b) and a < p + (b - q) / (s - q) * (r - p)


@compiled
def beside(border, a, b):
    """Return how far a point is from a border (12,) [L], negative where it is solid; infinite at its end."""
    u, v = border[2] - border[0], border[3] - border[1]
    x, y = a - border[0], b - border[1]
    share = (x * u + y * v) / (u * u + v * v)
    if share >= INSIDE:
        share = 1.0
    share = min(max(share, 0.0), 1.0)
    x, y = x - share * u, y - share * v
    off = math.sqrt(x * x + y * y)
    nx, ny = border[NORMAL], border[NORMAL + 1]
    if share == 0.0:
        nx, ny = nx + border[BEFORE], ny + border[BEFORE + 1]
    elif share == 1.0:
        off += 1e-12 + 1e-9 * off  # the next border tells
    return -off if nx * x + ny * y < 0.0 else off


@compiled
def within(solid, k, x, y, z, wide):
    """Say whether a point [L] lies over triangle k, or no further than ``wide`` [L] outside it."""
    n = solid.normals[k]
    for i in range(3):
        p, q = solid.vertices[solid.triangles[k, i]], solid.vertices[solid.triangles[k, (i + 1) % 3]]
        u, v, w = q[0] - p[0], q[1] - p[1], q[2] - p[2]
        a, b, c = x - p[0], y - p[1], z - p[2]
        side = n[0] * (v * c - w * b) + n[1] * (w * a - u * c) + n[2] * (u * b - v * a)
        if side < -wide * math.sqrt(u * u + v * v + w * w):
            return False
    return True
