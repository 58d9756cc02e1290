"""What may go wrong between parts, against angles that are drawn."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew.bowl.record import Track
from feederscrew.designing import risks
from feederscrew.designing.record import FilledQueue
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import orientations

LEVEL = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)


@pytest.fixture(scope="module")
def keel():
    """A bar whose ends rise from a narrower foot by 20 and by 60 degrees, lying on that foot."""
    a, b = 5.0 / np.tan(np.radians(20.0)), 5.0 / np.tan(np.radians(60.0))
    part = shapes.part(shapes.prism([(-10, 0), (10, 0), (10 + a, 5), (-10 - b, 5)], 12))
    found = find(part)
    every = [one for one in orientations(part, found, LEVEL) if one.kind == "flat" and one.height < 5.1e-3]
    feet = [one for one in every if np.ptp(one.foot.corners[:, 0]) == pytest.approx(20e-3, rel=1e-3)]
    return {round(np.degrees(risks.leading_wedge(one))): one for one in feet}


def test_the_leading_side_is_the_one_ahead(keel):
    assert set(keel) == {20, 60}


def test_it_may_shingle_where_friction_holds_on_the_leading_side(keel):
    assert risks.risks(keel[60], 0.6, ()) == ()
    (said,) = risks.risks(keel[20], 0.6, ())
    assert "may shingle: its leading side rises from the track by 20 deg only" in said
    assert risks.risks(keel[20], np.tan(np.radians(19.0)), ()) == ()


def test_a_part_no_corner_of_which_is_quite_down_has_a_leading_side_all_the_same():
    """As of a screw on its two circles, whose corners lie 3 um over the track."""
    corners = np.array([[x, y, z] for x in (-4e-3, 4e-3) for y in (-1e-3, 1e-3) for z in (0.0, 6e-3)])
    one = SimpleNamespace(
        posture=SimpleNamespace(surface=corners + [0.0, 0.0, 3.2e-6]), heading=0.0, height=6e-3
    )
    assert risks.leading_wedge(one) == pytest.approx(0.5 * np.pi)


def test_what_climbed_in_the_queue_is_said(keel):
    seen = FilledQueue("normal", 12, 30.0, 29.0, 20.0, 20, 20, 0, 0, 3)
    (said,) = risks.risks(keel[60], 0.3, (seen, replace(seen, climbs=0)))
    assert said == "parts climbed on others 3 times in 60 s of queue"
