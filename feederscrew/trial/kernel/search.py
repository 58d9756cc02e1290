"""Compiled search for contacts of a part with the bowl's wall and with plates.

A plate is a flat surface with borders: the track, seen from above with its free edge and its holes, or a
gate, seen by the part that arrives. Its solid lies behind the surface, its sides go straight back from the
borders. What can touch: a corner of the part the surface or a side, an edge of the part a border, a convex
corner of the border a face of the part. The solid ends at a depth with the same borders once more: its back
is a row of its own behind the plate's, seen from the other side, of which only the borders are touched.
"""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.contact import add

SLANT = 0.02  # [1] by which a contact's normal may lie beyond the faces it is between
PARALLEL = 0.03  # [1] sine of the angle below which two edges do not cross: their ends touch instead
SUNK = 0.2  # [1] of a border's round: a corner that deep, of a part that reaches deeper, meets the side
LEVEL = 0.7  # [1] of a normal against a plate's front: one that lies flatter stops a part
DEEP = 0.03  # how far behind a surface an edge may be found, in units of the part's length
WAYS, FALL = 6, 20.0  # corners are sought in so many directions, a lower one rather than one further out
ORIGIN, ACROSS, ALONG, FRONT, DEPTH, ROUNDED, FIRST, LAST = 0, 3, 6, 9, 12, 13, 14, 15  # of a plate's row
RUBS = 16  # its own friction; NaN: that of the track
BACK = 17  # of a row: the back of the plate before it


@compiled
def front(plate, inertia, turn, tangent, x, y, z, u, v, w, gap, contacts, count):
    """Add a contact whose normal is given in a plate's coordinates."""
    nx = u * plate[ACROSS] + v * plate[ALONG] + w * plate[FRONT]
    ny = u * plate[ACROSS + 1] + v * plate[ALONG + 1] + w * plate[FRONT + 1]
    nz = u * plate[ACROSS + 2] + v * plate[ALONG + 2] + w * plate[FRONT + 2]
    return add(contacts, count, turn, inertia, tangent, x, y, z, nx, ny, nz, gap, 0.0)


@compiled
def placed(vertices, turn, spots):
    """Write the corners of a part (V, 3), turned into the bowl's frame, from the centre of mass."""
    for k in range(len(vertices)):
        a, b, c = vertices[k, 0], vertices[k, 1], vertices[k, 2]
        spots[k, 0] = turn[0] * a + turn[1] * b + turn[2] * c
        spots[k, 1] = turn[3] * a + turn[4] * b + turn[5] * c
        spots[k, 2] = turn[6] * a + turn[7] * b + turn[8] * c


@compiled
def inside(borders, first, last, a, b):
    """Say whether a point of a plate's surface is solid: it is within its borders, holes left out."""
    odd = False
    for k in range(first, last):
        p, q, r, s = borders[k, 0], borders[k, 1], borders[k, 2], borders[k, 3]
        if (q > b) != (s > b) and a < p + (b - q) / (s - q) * (r - p):
            odd = not odd
    return odd


@compiled
def _beside(borders, first, last, a, b):
    """Nearest border of a point, and how far the point is from it, negative where it is solid."""
    best, nearest = math.inf, first
    for k in range(first, last):
        if borders[k, 7] > 0.5:  # the end of what is drawn, no border
            continue
        p, q, u, v = borders[k, 0], borders[k, 1], borders[k, 2], borders[k, 3]
        u, v = u - p, v - q
        share = min(max(((a - p) * u + (b - q) * v) / (u * u + v * v), 0.0), 1.0)
        off = math.hypot(a - p - share * u, b - q - share * v)
        if off < best:
            best, nearest = off, k
    return nearest, best


@compiled
def seen(plate, state, spots, shown):
    """Write corners in a plate's own coordinates (V, 3), the height over its surface last; the least."""
    least = math.inf
    x, y, z = state[X] - plate[0], state[Y] - plate[1], state[Z] - plate[2]
    for e in range(3):
        u, v, w = plate[ACROSS + 3 * e], plate[ACROSS + 3 * e + 1], plate[ACROSS + 3 * e + 2]
        start = u * x + v * y + w * z
        for k in range(len(spots)):
            shown[k, e] = start + u * spots[k, 0] + v * spots[k, 1] + w * spots[k, 2]
    for k in range(len(spots)):
        least = min(least, shown[k, 2])
    return least


@compiled
def points_to(solid, shown, k, u, v, w):
    """Say whether a corner of the part is its foremost against a direction, as far as its neighbours tell."""
    for n in range(solid.firsts[k], solid.firsts[k + 1]):
        m = solid.beside[n]
        x, y, z = shown[m, 0] - shown[k, 0], shown[m, 1] - shown[k, 1], shown[m, 2] - shown[k, 2]
        ahead = u * x + v * y + w * z
        if ahead < 0.0 and ahead * ahead > SLANT * SLANT * (x * x + y * y + z * z):
            return False
    return True


@compiled
def sides_on(plate, borders, shown, spots, turn, solid, tangent, reach, low, contacts, count):
    """Add contacts of the part's corners with a plate's sides; writes which corners lie on its surface.

    Returns
    -------
    contacts so far, corners on the surface
    """
    first, last, lows = int(plate[FIRST]), int(plate[LAST]), 0
    for k in range(len(shown)):
        height = shown[k, 2]
        if height > reach or height < -plate[DEPTH]:
            continue
        covered = inside(borders, first, last, shown[k, 0], shown[k, 1])
        lowest = covered and points_to(solid, shown, k, 0.0, 0.0, 1.0)
        if height < -(plate[ROUNDED] if lowest or not covered else SUNK * plate[ROUNDED]):
            n, off = _beside(borders, first, last, shown[k, 0], shown[k, 1])
            behind = plate[DEPTH] + height
            deepest = min(-height, behind) if lowest else behind
            if off < (deepest if covered else reach):
                u, v, w, gap = borders[n, 4], borders[n, 5], 0.0, (-off if covered else off)
            elif covered and behind < -height:  # it came in from behind
                u, v, w, gap = 0.0, 0.0, -1.0, -behind
            else:
                u, v, w, gap = 0.0, 0.0, 0.0, 0.0
            if u != 0.0 or v != 0.0 or w != 0.0:
                lowest = False
                if points_to(solid, shown, k, u, v, w):
                    count = front(
                        plate, solid.inertia, turn, tangent, spots[k, 0], spots[k, 1], spots[k, 2],
                        u, v, w, gap, contacts, count,
                    )  # fmt: skip
        if lowest:
            low[lows] = k
            lows += 1
    return count, lows


@compiled
def all_low(plate, borders, shown, reach, low):
    """Write which corners lie on a plate's surface where no border is near them; how many."""
    lows = 0
    for k in range(len(shown)):
        if shown[k, 2] <= reach and shown[k, 2] >= -DEEP:
            low[lows] = k
            lows += 1
    if lows and not inside(borders, int(plate[FIRST]), int(plate[LAST]), shown[low[0], 0], shown[low[0], 1]):
        return 0  # all of them are over one hole
    return lows


@compiled
def _outermost(shown, low, count):
    """Keep of many corners the lowest and those furthest out around it, in front of the others; how many."""
    kept = 0
    for m in range(WAYS + 1):
        c, s = math.cos(2.0 * math.pi * m / WAYS), math.sin(2.0 * math.pi * m / WAYS)
        if m == WAYS:
            c = s = 0.0
        best, first = -math.inf, 0
        for n in range(count):
            k = low[n]
            score = c * shown[k, 0] + s * shown[k, 1] - FALL * shown[k, 2]
            if score > best:
                best, first = score, n
        if first >= kept:
            low[kept], low[first] = low[first], low[kept]
            kept += 1
    return kept


@compiled
def on_wall(shown, spots, state, turn, inertia, surface, tangent, reach, low, contacts, count):
    """Add contacts with the wall, which stands upright about the bowl's axis, a part inside of it.

    Square to the track only where that has no bank: in the track's frame it is a cone.
    """
    radius, lean, up = surface.radius, surface.upright[0], surface.upright[1]
    lows = 0
    for k in range(len(spots)):
        x, y = state[X] + spots[k, 0], state[Y] + spots[k, 1] - radius
        gap = up * (radius - math.sqrt(x * x + y * y)) - lean * (state[Z] + spots[k, 2])
        if gap < reach:
            shown[k, 0], shown[k, 1] = tangent[0] * spots[k, 0] + tangent[1] * spots[k, 1], spots[k, 2]
            shown[k, 2] = gap
            low[lows] = k
            lows += 1
    if lows > WAYS + 1:
        lows = _outermost(shown, low, lows)
    for m in range(lows):
        k = low[m]
        x, y = state[X] + spots[k, 0], state[Y] + spots[k, 1] - radius
        far = math.sqrt(x * x + y * y)
        count = add(
            contacts, count, turn, inertia, tangent, spots[k, 0], spots[k, 1], spots[k, 2],
            -up * x / far, -up * y / far, -lean, shown[k, 2], 1.0,
        )  # fmt: skip
    return count


@compiled
def corners_on(plate, borders, shown, spots, turn, solid, tangent, reach, nears, low, contacts, count):
    """Add contacts of the part's corners with a plate: its surface, and its sides behind rounded borders."""
    if nears:
        count, lows = sides_on(
            plate, borders, shown, spots, turn, solid, tangent, reach, low, contacts, count
        )
    else:
        lows = all_low(plate, borders, shown, reach, low)
    if lows > WAYS + 1:
        lows = _outermost(shown, low, lows)
    for m in range(lows):
        k = low[m]
        count = add(
            contacts, count, turn, solid.inertia, tangent, spots[k, 0], spots[k, 1], spots[k, 2],
            plate[FRONT], plate[FRONT + 1], plate[FRONT + 2], shown[k, 2], 0.0,
        )  # fmt: skip
    return count


@compiled
def crossing(p, q, border, wedge, reach):
    """Where an edge from p to q touches a border, in the plate's coordinates.

    Returns
    -------
    share of the edge, normal (3), gap; the gap is infinite where they do not touch
    """
    a, b, c = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    u, v = border[2] - border[0], border[3] - border[1]
    nx, ny, nz = -c * v, c * u, a * v - b * u  # edge x border
    size, whole = math.sqrt(nx * nx + ny * ny + nz * nz), math.sqrt((a * a + b * b + c * c) * (u * u + v * v))
    if size <= PARALLEL * whole:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    if nz + nx * border[4] + ny * border[5] < 0.0:
        size = -size
    nx, ny, nz = nx / size, ny / size, nz / size
    if nz < -SLANT or nx * border[4] + ny * border[5] < -SLANT:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    x, y, z = p[0] - border[0], p[1] - border[1], p[2]
    gap = nx * x + ny * y + nz * z
    if gap > reach or gap < -DEEP:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    x, y, z = x - gap * nx, y - gap * ny, z - gap * nz
    # in the plane of both: share of the edge where it meets the border's line, then of the border
    mx, my, mz = -v * nz, u * nz, v * nx - u * ny  # normal x border
    slope = a * mx + b * my + c * mz
    share = -(x * mx + y * my + z * mz) / slope
    place = ((x + share * a) * u + (y + share * b) * v) / (u * u + v * v)
    if share < 0.0 or share > 1.0 or place < 0.0 or place > 1.0:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    for k in range(2):
        if nx * wedge[k, 0] + ny * wedge[k, 1] + nz * wedge[k, 2] < -SLANT:
            return 0.0, 0.0, 0.0, 0.0, math.inf
    return share, nx, ny, nz, gap
