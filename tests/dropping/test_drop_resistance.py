"""Rolling resistance of the drop test against the work it takes."""

import numpy as np
import pytest
import shapes

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.one_drop import Steps, scratch, settle
from feederscrew.dropping.rounded_hull import shape_of_part
from feederscrew.resting.aspects import find


def rolled(resistance):
    """Way in lengths that a round disc rolls on, and its energy at the start over its weight."""
    part = shapes.part(shapes.cylinder(4.0, 30.0, 96))
    shape, length = shape_of_part(part, find(part).ground)
    radius, rate = 4e-3 / length, 0.8
    assert np.argmin(shape.inertia) == 0  # its axis is level as it is drawn
    work = scratch(shape, 40000)
    state = np.zeros(body.STATE)
    state[body.Q], state[body.Z] = 1.0, radius
    state[body.W], state[body.VY] = rate, -rate * radius
    work.state[:] = state
    _, _, used = settle(shape, work, 0.0, 0.5, Steps(early=False, rolling=resistance, longest=300.0))
    trace = work.trace[:used]
    energy = 0.5 * shape.inertia[0] * rate**2 + 0.5 * (rate * radius) ** 2
    return abs(trace[-1, 1 + body.Y] - trace[0, 1 + body.Y]), energy, radius


@pytest.mark.parametrize("resistance", [0.01, 0.02, 0.04])
def test_a_cylinder_rolls_until_its_energy_is_the_work_of_the_lever_of_its_weight(resistance):
    """Rolled by an angle the weight at a lever takes lever times angle: way = energy radius / lever."""
    way, energy, radius = rolled(resistance)
    assert way == pytest.approx(energy * radius / resistance, rel=0.05)
