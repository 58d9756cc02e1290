"""Compiled lists of which corners and circles of a part are near the wall."""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel import circles_met
from feederscrew.trial.kernel.crowd_records import WALL
from feederscrew.trial.kernel.near_borders import BLOCK
from feederscrew.trial.kernel.plate_views import off_wall


@compiled
def near_wall(surface, solid, crowd, n, margin):
    """List what of a part is within a margin [L] of the wall: corners of its hull, and circles."""
    state, count = crowd.states[n], 0
    x, y = state[X], surface.radius - state[Y]
    if math.sqrt(x * x + y * y) + solid.radius > (surface.radius - margin) * crowd.leans[n, WALL + 1]:
        for j in range(len(solid.single_blocks)):
            block = solid.single_blocks[j]
            p = 0.5 * (block[0] + block[3]), 0.5 * (block[1] + block[4]), 0.5 * (block[2] + block[5])
            x, y, z = block[3] - p[0], block[4] - p[1], block[5] - p[2]
            if _off_wall(surface, crowd, n, p) > margin + math.sqrt(x * x + y * y + z * z):
                continue
            for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.singles))):
                k = solid.singles[m]
                p = solid.corners[k, 0], solid.corners[k, 1], solid.corners[k, 2]
                gap = _off_wall(surface, crowd, n, p)
                if gap < margin:
                    count += 1
                    crowd.walled[n, count], crowd.wall_gaps[n, count] = k, gap
    crowd.walled[n, 0] = count
    count = 0
    for k in range(len(solid.rims)):
        if circles_met.deepest(surface, state, crowd.turns[n], crowd.leans[n], solid.rims[k])[0] < margin:
            count += 1
            crowd.rims_walled[n, count] = k
    crowd.rims_walled[n, 0] = count


@compiled
def _off_wall(surface, crowd, n, p):
    """How far a point of a body is from the wall."""
    state, turn = crowd.states[n], crowd.turns[n]
    x = state[X] + turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
    y = state[Y] + turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
    z = state[Z] + turn[6] * p[0] + turn[7] * p[1] + turn[8] * p[2]
    return off_wall(surface, crowd.leans[n], x, y, z)
