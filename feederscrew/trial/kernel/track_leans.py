"""Compiled lean of the track where a part is: gravity, the bowl's axis and the wall, in the track's frame."""

import math

from feederscrew.dropping.kernel.body import X
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.crowd_records import LEAN, REACHES, WALL

UPRIGHT = 1e-9  # [1] a wall that leans by more from the bowl's axis is the other face of a groove
COLUMNS = 7


@compiled
def lean_here(surface, crowd, n):
    """Write how the track leans where part n is; what is near a wall that turns is looked at anew."""
    slopes, last = surface.slopes, len(surface.slopes) - 1
    state, leans = crowd.states[n], crowd.leans[n]
    place = surface.radius * math.atan2(state[X], surface.radius - state[X + 1]) if last else 0.0
    m, before = 0, leans[WALL]
    while m < last and place > slopes[m, 0]:
        m += 1
    between = m > 0 and place <= slopes[m, 0]
    share = (place - slopes[m - 1, 0]) / (slopes[m, 0] - slopes[m - 1, 0]) if between else 0.0
    for k in range(COLUMNS):
        leans[k] = slopes[m, 1 + k]
        if between:
            leans[k] = slopes[m - 1, 1 + k] + share * (slopes[m, 1 + k] - slopes[m - 1, 1 + k])
    if leans[WALL] != before:
        crowd.made[n, REACHES] = -1.0


@compiled
def wall_friction(surface, leans):
    """Return the friction [1] of the wall; NaN, that of the track, where it is the other face of a groove."""
    leaning = leans[WALL] * leans[LEAN + 1] - leans[WALL + 1] * leans[LEAN]
    return math.nan if math.fabs(leaning) > UPRIGHT else surface.friction[4]
