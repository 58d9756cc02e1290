"""The event integration against a general solver that shares no code with it."""

import numpy as np
import pytest
from conveying_agreement import agreed
from conveying_reference import Reference, random_settings

from feederscrew.conveying.operating_point import OperatingPoint, plain
from feederscrew.mechanics.limits import effective


@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_random_settings(restitution):
    results = []
    for ratio, angle, climb, friction in random_settings(20, np.random.default_rng(2)):
        setting = plain(ratio, angle, climb, friction, restitution)
        results.append(agreed(setting, Reference(ratio, angle, climb, friction, friction, restitution)))
    assert results.count(True) >= 14
    assert results.count(False) == 0


def test_every_other_parameter():
    rng, results = np.random.default_rng(3), []
    for ratio, angle, climb, kinetic in random_settings(12, rng):
        more, bank, wall, lead, bristles = rng.uniform((0, 0, 0, -1, 1), (0.3, 0.3, 0.3, 1, 2))
        pair, back = (kinetic + more, kinetic), (bristles * kinetic + more, bristles * kinetic)
        level = [float(effective(mu, wall, bank)) for mu in (*pair, *back)]
        setting = OperatingPoint(ratio, angle, climb, *level, 0.0, lead)
        reference = Reference(setting.ratio, angle, climb, *pair, 0.0, bank, wall, lead, back)
        results.append(agreed(setting, reference))
    assert results.count(True) >= 8
    assert results.count(False) == 0
