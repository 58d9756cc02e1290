"""Compiled contacts of circles of a part, as circles: with a plate's surface and with the wall.

Of a circle touch the lowest point and, where it lies nearly flat, those furthest out, as `supports` chooses
among corners. The furthest point of a circle in a direction is its centre and a radius along what of the
direction is in its plane.
"""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel import supports
from feederscrew.trial.kernel.contact import KINDS
from feederscrew.trial.kernel.crowd_records import DEPTH, FIRST, LAST, RIMS, ROUND, ROUNDED, WALL
from feederscrew.trial.kernel.plate_views import DEEP, beside, crossed, in_body, off_wall, placed
from feederscrew.trial.kernel.supports import COSINES, FALL, SINES, WAYS

AXIS, RADIUS = 3, 6  # columns of a circle, behind its centre
TILTED = 0.25  # [1] sine of the tilt from which on it touches at its lowest point only
FLAT = 1e-6  # [1] a circle that is not tilted by more has no lowest point
OWN = 5e5  # contacts of circles are counted from here, those of corners from 0


@compiled
def lowest(frame, rim):
    """Return the height [L] of a circle's lowest point as a plate sees it, and the sine of its tilt [1]."""
    middle = frame[6] * rim[0] + frame[7] * rim[1] + frame[8] * rim[2] + frame[11]
    up = frame[6] * rim[AXIS] + frame[7] * rim[AXIS + 1] + frame[8] * rim[AXIS + 2]
    tilt = math.sqrt(max(1.0 - up * up, 0.0))
    return middle - rim[RADIUS] * tilt, tilt


@compiled
def _furthest(rim, a, b, c):
    """The furthest point of a circle in a direction, all in body axes."""
    u, v, w = rim[AXIS], rim[AXIS + 1], rim[AXIS + 2]
    along = a * u + b * v + c * w
    a, b, c = a - along * u, b - along * v, c - along * w
    size = rim[RADIUS] / math.sqrt(a * a + b * b + c * c)
    return rim[0] + a * size, rim[1] + b * size, rim[2] + c * size


@compiled
def _way(m):
    """The m-th direction along a surface; none after the last."""
    half = WAYS // 2
    if m < half:
        return COSINES[m], SINES[m]
    if m < WAYS:
        return -COSINES[m - half], -SINES[m - half]
    return 0.0, 0.0


@apart
def rims_on(surface, solid, crowd, n, k, reach, lying):
    """Add what of circles lies within ``reach`` [L] on a plate's surface; return how many carry it."""
    frame = crowd.frame
    first = crowd.ends[n, k - 1, RIMS] if k else 0
    for m in range(first, crowd.ends[n, k, RIMS]):
        rim = solid.rims[crowd.rims[n, m, 0]]
        low, tilt = lowest(frame, rim)
        if low > reach:
            continue
        for e in range(WAYS if tilt > TILTED else 0, WAYS + 1 if tilt > FLAT else WAYS):
            x, y = _way(e)
            p = in_body(frame, x, y, -FALL)
            p = _furthest(rim, p[0], p[1], p[2])
            a, b, c = placed(frame, p)
            if -DEEP < c < reach and (crowd.rims[n, m, 1] or _on_top(surface, crowd, n, k, (a, b, c))):
                key = KINDS * (OWN + 8 * crowd.rims[n, m, 0] + e + 1e6 * k)
                lying = supports.add(crowd.levels, lying, (a, b), c, p, key)
    return lying


@compiled
def _on_top(surface, crowd, n, k, place):
    """Whether a point lies on a plate's surface: over what is solid, and not at a side."""
    plate, (a, b, c), odd = surface.plates[k], place, False
    for e in range(crowd.ends[n, k - 1, ROUND] if k else 0, crowd.ends[n, k, ROUND]):
        odd = odd != crossed(surface.borders[crowd.rounds[n, e]], a, b)
    if not odd:
        return False
    if c > -plate[ROUNDED]:
        return True
    for e in range(int(plate[FIRST]), int(plate[LAST])):
        if abs(beside(surface.borders[e], a, b)) < -c:
            return False
    return c > -0.5 * plate[DEPTH]


@apart
def rims_on_wall(surface, solid, crowd, n, reach, lows):
    """Add what of circles is within ``reach`` [L] of the wall; return how many contacts there are."""
    state, turn, leans = crowd.states[n], crowd.turns[n], crowd.leans[n]
    for m in range(1, crowd.rims_walled[n, 0] + 1):
        k = crowd.rims_walled[n, m]
        rim = solid.rims[k]
        far, tilt = deepest(surface, state, turn, leans, rim)
        if far > reach:
            continue
        for e in range(WAYS if tilt > TILTED else 0, WAYS + 1 if tilt > FLAT else WAYS):
            x, y = _way(e)
            p = _towards_wall(surface, crowd, n, rim, x, y)
            x = turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
            y = turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
            z = turn[6] * p[0] + turn[7] * p[1] + turn[8] * p[2]
            gap = off_wall(surface, leans, state[X] + x, state[Y] + y, state[Z] + z)
            if gap < reach:
                place = crowd.tangents[n, 0] * x + crowd.tangents[n, 1] * y, z
                lows = supports.add(crowd.levels, lows, place, gap, p, -KINDS * (1 + OWN + 8 * k + e))
    return lows


@compiled
def deepest(surface, state, turn, leans, rim):
    """Return how near [L] a circle comes to the wall, or a little less, and the sine of its tilt to it."""
    p = _turned(turn, rim[0], rim[1], rim[2])
    x, y, z = p[0] + state[X], p[1] + state[Y] - surface.radius, p[2]
    off = math.sqrt(x * x + y * y)
    a, b, c = leans[WALL + 1] * x / off, leans[WALL + 1] * y / off, leans[WALL]
    n = _turned(turn, rim[AXIS], rim[AXIS + 1], rim[AXIS + 2])
    along = a * n[0] + b * n[1] + c * n[2]
    tilt = math.sqrt(max(a * a + b * b + c * c - along * along, 0.0))
    bent = 0.5 * rim[RADIUS] ** 2 / surface.radius  # by which the wall comes nearer to either side
    gap = off_wall(surface, leans, x, y + surface.radius, z + state[Z])
    return gap - rim[RADIUS] * tilt - bent, tilt


@compiled
def _turned(turn, a, b, c):
    """A vector of the body in the bowl's frame."""
    return (
        turn[0] * a + turn[1] * b + turn[2] * c,
        turn[3] * a + turn[4] * b + turn[5] * c,
        turn[6] * a + turn[7] * b + turn[8] * c,
    )


@compiled
def _towards_wall(surface, crowd, n, rim, ahead, up):
    """The point of a circle furthest towards the wall, and ahead or up as well, in body axes."""
    state, turn, leans = crowd.states[n], crowd.turns[n], crowd.leans[n]
    s, t = crowd.tangents[n, 0], crowd.tangents[n, 1]
    p = rim[0], rim[1], rim[2]
    for _ in range(2):  # the wall is curved: once more from where that is
        q = _turned(turn, p[0], p[1], p[2])
        x, y = q[0] + state[X], q[1] + state[Y] - surface.radius
        size = FALL * leans[WALL + 1] / math.sqrt(x * x + y * y)
        a, b, c = x * size + ahead * s, y * size + ahead * t, FALL * leans[WALL] + up
        p = _furthest(
            rim,
            turn[0] * a + turn[3] * b + turn[6] * c,
            turn[1] * a + turn[4] * b + turn[7] * c,
            turn[2] * a + turn[5] * b + turn[8] * c,
        )
    return p
