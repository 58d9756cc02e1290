"""Whether the event integration and the general solver agree on one velocity."""

import numpy as np
import pytest

from feederscrew.motion import steady
from feederscrew.motion.operating_point import law
from feederscrew.motion.point_motion import TALLY, at_rest, turn

LONGEST = 40  # periods the general solver is asked to follow


def agreed(setting, reference):
    """Whether both give one velocity; None where the steady state comes too late for the general solver."""
    rules = law(setting)
    state, period = steady.settle(rules, at_rest(rules))
    lead_in = _periods_to(rules, state)
    if not period or lead_in is None:
        return None
    out = np.empty(steady.COLUMNS)
    steady.steady(rules, at_rest(rules), out, steady.memory(), 0, steady.TRANSIENT)
    velocity = reference.velocity(lead_in + period, period)
    return velocity == pytest.approx(out[steady.VELOCITY], rel=0, abs=1e-7)


def _periods_to(rules, settled):
    state = at_rest(rules)
    for count in range(LONGEST):
        if abs(state.speed - settled.speed) + abs(state.height - settled.height) < 1e-9 and count > 1:
            return count
        state = turn(rules, state, np.zeros(TALLY))
    return None
