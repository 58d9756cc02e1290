"""Compiled search for the points of a body that touch the floor: corners, and points of its rims."""

import math

from feederscrew.dropping.kernel.body import rim_level
from feederscrew.geometry.compiled import compiled

MAX_CONTACTS = 12  # solved together; of more, the lowest and those furthest out in the other directions
FLAT_RIM_POINTS = 4  # points of a rim that lies flat
CORNER_OWNER = -1  # owner of a point that is a corner of the body; else its rim
LEVEL_RIM_SINE = 1e-9  # [1] sine of the tilt below which a rim has no lowest point


@compiled
def touching(solid, work, height, corner, reach):
    """Find the points within ``reach`` of the floor: fills ``work.spots`` and returns how many.

    Corners are found by flooding the hull's edges from the lowest one, through corners that rims replace.
    Where none of these rims is as low as their lowest corner, that is the point.
    """
    count = flooded(solid, work, height, corner, reach) if solid.corners else 0
    for k in range(len(solid.rims)):
        if height + rim_level(solid.rims, k, work.turn) <= reach:
            count = on_rim(solid.rims, k, work, height, reach, count)
    if count == 0:
        for i in range(3):
            work.spots[0, i] = solid.vertices[corner, i]
        work.owners[0] = CORNER_OWNER
        return 1
    return thin_out(work.spots, work.owners, work.turn, count) if count > MAX_CONTACTS else count


@compiled
def flooded(solid, work, height, corner, reach):
    """Write touching corners to ``work.spots``; ``work.visited`` (V,) is all False before and after."""
    points, links, visited, queue = solid.vertices, solid.links, work.visited, work.queue
    a, b, c = work.turn[6], work.turn[7], work.turn[8]
    queue[0], visited[corner] = corner, True
    count, done, spots = 1, 0, 0
    while done < count:
        here = queue[done]
        done += 1
        for k in range(links[here], links[here + 1]):
            other = links[k]
            level = a * points[other, 0] + b * points[other, 1] + c * points[other, 2]
            if not visited[other] and height + level <= reach + solid.sag:
                queue[count], visited[other] = other, True
                count += 1
    for k in range(count):
        p = points[queue[k]]
        visited[queue[k]] = False
        if not solid.inner[queue[k]] and height + a * p[0] + b * p[1] + c * p[2] <= reach:
            for i in range(3):
                work.spots[spots, i] = p[i]
            work.owners[spots] = CORNER_OWNER
            spots += 1
    return spots


@compiled
def lowest_on(rims, k, turn):
    """Return the unit vector (3,) [1] from a rim's centre to its lowest point, and how steep it is [1].

    Source: a circle is lowest where the vertical, seen in its plane, points down.
    """
    r = rims[k]
    along = turn[6] * r[3] + turn[7] * r[4] + turn[8] * r[5]
    x, y, z = along * r[3] - turn[6], along * r[4] - turn[7], along * r[5] - turn[8]
    steep = math.sqrt(x * x + y * y + z * z)
    if steep < LEVEL_RIM_SINE:
        return r[7], r[8], r[9], steep
    return x / steep, y / steep, z / steep, steep


@compiled
def on_rim(rims, k, work, height, reach, count):
    """Write a rim's lowest point to ``work.spots`` (N, 3) [L], and QUARTERS around it where all touches."""
    r, turn, spots = rims[k], work.turn, work.spots
    x, y, z, steep = lowest_on(rims, k, turn)
    u, v, w = r[4] * z - r[5] * y, r[5] * x - r[3] * z, r[3] * y - r[4] * x  # a quarter of a turn on
    level = turn[6] * r[0] + turn[7] * r[1] + turn[8] * r[2]
    flat = height + level + r[6] * steep <= reach
    cos, sin = 1.0, 0.0
    for _ in range(FLAT_RIM_POINTS if flat else 1):
        px, py, pz = cos * x + sin * u, cos * y + sin * v, cos * z + sin * w
        cos, sin = -sin, cos
        if r[10] > -1.0 and px * r[7] + py * r[8] + pz * r[9] < r[10]:
            continue
        spots[count, 0], spots[count, 1] = r[0] + r[6] * px, r[1] + r[6] * py
        spots[count, 2] = r[2] + r[6] * pz
        work.owners[count] = CORNER_OWNER if flat else k
        count += 1
    return count


@compiled
def thin_out(spots, owners, turn, count):
    """Keep of many touching spots (N, 3) [L] the lowest and those furthest out around it, in front."""
    best, first = math.inf, 0
    for k in range(count):
        level = turn[6] * spots[k, 0] + turn[7] * spots[k, 1] + turn[8] * spots[k, 2]
        if level < best:
            best, first = level, k
    swap(spots, owners, 0, first)
    chosen = 1
    for m in range(1, MAX_CONTACTS):
        angle = 2.0 * math.pi * m / (MAX_CONTACTS - 1)
        k = furthest(spots, turn, count, math.cos(angle), math.sin(angle))
        if k >= chosen:
            swap(spots, owners, chosen, k)
            chosen += 1
    return chosen


@compiled
def furthest(spots, turn, count, cos, sin):
    """Return the index of that of the spots (N, 3) [L] which is furthest along a direction of the floor."""
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
    """Exchange two of the spots (N, 3) [L], with their owners (N,)."""
    owners[i], owners[j] = owners[j], owners[i]
    for e in range(3):
        spots[i, e], spots[j, e] = spots[j, e], spots[i, e]
