"""Compiled choice among many contacts that push one way: the deepest, and those furthest out around it.

What lies on a surface by many corners, edges and faces is carried as well by a few of them. A row of
``levels`` is one such contact: where it is along the surface, its gap, where it is in body axes, and its key.
"""

import math

from feederscrew.geometry.compiled import apart, compiled

PLACE, GAP, SPOT, KEY, COLUMNS = 0, 2, 3, 6, 7
WAYS, FALL = 6, 20.0  # contacts are kept in so many directions, a lower one rather than one further out
LEVEL = 1.0 - 1e-5  # [1] of a normal against a surface's: less than it looks around parts tilt so


@compiled
def add(levels, count, place, gap, spot, key):
    """Note a contact at a place along the surface and a spot in body axes; how many there are now."""
    if count == len(levels):
        return count
    row = levels[count]
    row[PLACE], row[PLACE + 1], row[GAP] = place[0], place[1], gap
    row[SPOT], row[SPOT + 1], row[SPOT + 2], row[KEY] = spot[0], spot[1], spot[2], key
    return count + 1


@apart
def outermost(levels, count):
    """Move the contacts that are kept, the lowest and those furthest out, before the others; how many."""
    if count <= WAYS + 1:
        return count
    kept = 0
    for m in range(WAYS + 1):
        c, s = math.cos(2.0 * math.pi * m / WAYS), math.sin(2.0 * math.pi * m / WAYS)
        if m == WAYS:
            c = s = 0.0
        best, first = -math.inf, 0
        for n in range(count):
            score = c * levels[n, PLACE] + s * levels[n, PLACE + 1] - FALL * levels[n, GAP]
            if score > best:
                best, first = score, n
        if first >= kept:
            for e in range(COLUMNS):
                levels[kept, e], levels[first, e] = levels[first, e], levels[kept, e]
            kept += 1
    return kept
