"""Compiled choice among many contacts that push one way: the deepest, and those furthest out around it.

What lies on a surface by many corners, edges and faces is carried as well by a few of them. A row of
``levels`` is one such contact: where it is along the surface, its gap, where it is in body axes, and its key.
"""

import math

from feederscrew.geometry.compiled import apart, compiled

PLACE, GAP, SPOT, KEY, COLUMNS = 0, 2, 3, 6, 7
WAYS, FALL = 6, 100.0  # contacts are kept in so many directions, a lower one rather than one further out
COSINES = tuple(math.cos(2.0 * math.pi * m / WAYS) for m in range(WAYS // 2))
SINES = tuple(math.sin(2.0 * math.pi * m / WAYS) for m in range(WAYS // 2))
ONE = 0.02  # so near to each other two are one: it is the lower
LEVEL = 1.0 - 1e-5  # [1] of a normal against a surface's: less than it looks around parts tilt so


@compiled
def add(levels, count, place, gap, spot, key):
    """Note a contact at a place (2,) [L] along the surface, a spot (3,) [L] in body axes; return how many."""
    if count == len(levels):
        return count
    row = levels[count]
    row[PLACE], row[PLACE + 1], row[GAP] = place[0], place[1], gap
    row[SPOT], row[SPOT + 1], row[SPOT + 2], row[KEY] = spot[0], spot[1], spot[2], key
    return count + 1


@apart
def outermost(levels, best, count):
    """Move the levels (L, 7) [L] that are kept, the lowest and those furthest out, to the front; how many.

    ``best`` has WAYS + 1 rows in which it works.
    """
    if count <= WAYS + 1:
        for m in range(count):
            best[m, 1] = m
        return _moved(levels, best, _spread(levels, best, count))
    half = WAYS // 2
    for m in range(WAYS + 1):
        best[m, 0] = -math.inf
    for n in range(count):
        x, y, fall = levels[n, PLACE], levels[n, PLACE + 1], FALL * levels[n, GAP]
        _better(best[WAYS], -fall, n)
        for m in range(half):
            off = COSINES[m] * x + SINES[m] * y
            _better(best[m], off - fall, n)
            _better(best[half + m], -off - fall, n)
    return _moved(levels, best, _spread(levels, best, _each_once(best)))


@compiled
def _better(row, score, n):
    if score > row[0]:
        row[0], row[1] = score, n


@compiled
def _spread(levels, best, kept):
    """Leave out of the rows in ``best`` what is as near as ONE to a lower one; how many there are then."""
    count = 0
    for m in range(kept):
        row, own = levels[int(best[m, 1])], True
        for e in range(kept):
            other = levels[int(best[e, 1])]
            x, y = row[PLACE] - other[PLACE], row[PLACE + 1] - other[PLACE + 1]
            if x * x + y * y < ONE * ONE and e != m:
                own = own and (row[GAP] < other[GAP] or (row[GAP] == other[GAP] and m < e))
        if own:
            best[WAYS - count, 0] = best[m, 1]
            count += 1
    for m in range(count):
        best[m, 1] = best[WAYS - m, 0]
    return count


@compiled
def _each_once(best):
    """Leave out of the rows in ``best`` what is there already; how many there are then."""
    kept = 0
    for m in range(WAYS + 1):
        first, own = int(best[m, 1]), True
        for e in range(m):
            own = own and int(best[e, 1]) != first
        if own:
            best[kept, 1] = first
            kept += 1
    return kept


@compiled
def _moved(levels, best, kept):
    """Move the rows named in ``best`` before the others; how many."""
    for m in range(kept):  # the smallest first: none is moved before its turn
        least = m
        for e in range(m + 1, kept):
            if best[e, 1] < best[least, 1]:
                least = e
        best[m, 1], best[least, 1] = best[least, 1], best[m, 1]
        first = int(best[m, 1])
        if first != m:
            for e in range(COLUMNS):
                levels[m, e] = levels[first, e]
    return kept
