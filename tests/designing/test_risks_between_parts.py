"""What may go wrong between parts, against angles that are drawn."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
import trimesh

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
    return feet[0], feet[1]


def lathe(outline):
    """A part of revolution from radii and heights [mm]."""
    return shapes.part(trimesh.creation.revolve(np.array(outline), sections=64))


def wedge_of(part, kind="flat"):
    """[deg] of the part's lowest orientation of a kind."""
    some = [one for one in orientations(part, find(part), LEVEL) if one.kind == kind]
    return np.degrees(risks.wedge(min(some, key=lambda one: one.height)))


def test_a_foot_under_sides_that_rise_wedges_by_the_flatter_one_whichever_leads(keel):
    for one in keel:
        assert np.degrees(risks.wedge(one)) == pytest.approx(20.0, abs=1e-6)
        (said,) = risks.risks(one, 0.6, ())
        assert said == (
            f"{one.name} may shingle: where one lies 0.25 mm higher than the next it is pushed up a side of "
            "20 deg, and friction holds it up to 31 deg"
        )
        assert risks.risks(one, np.tan(np.radians(19.0)), ()) == ()


def test_a_thin_disc_slides_onto_the_next_and_a_thicker_one_does_not():
    thin, thick = (lathe([(0.0, 0.0), (6.0, 0.0), (6.0, t), (0.0, t)]) for t in (0.2, 0.5))
    assert wedge_of(thin) == 0.0 and wedge_of(thick) == pytest.approx(90.0, abs=1e-6)
    (lying,) = [one for one in orientations(thin, find(thin), LEVEL) if one.kind == "flat"]
    (said,) = risks.risks(lying, 0.1, ())
    assert said.endswith("higher than the next it slides onto it")


def test_a_chamfer_does_no_harm_where_enough_of_the_rim_stands_upright():
    """Once the flattest side over the track counted, however short: 30 deg here."""
    c, s = 0.6, 0.6 * np.tan(np.radians(30.0))
    ring = [(3.2, 0.0), (6.0 - c, 0.0), (6.0, s), (6.0, 1.6 - s), (6.0 - c, 1.6), (3.2, 1.6)]
    assert wedge_of(lathe([*ring, ring[0]])) == pytest.approx(90.0, abs=1e-6)


def test_a_taper_wedges_on_its_large_face_and_on_its_small_one():
    """On the large one its rim climbs the next one's side: once its front, that leans back, was no risk."""
    for low, high in ((6.0, 3.0), (3.0, 6.0)):
        rise = 3.0 * np.tan(np.radians(25.0))
        taper = lathe([(0.0, 0.0), (low, 0.0), (high, rise), (0.0, rise)])
        ways = [one for one in orientations(taper, find(taper), LEVEL) if one.kind == "flat"]
        assert len(ways) >= 1
        assert all(np.degrees(risks.wedge(one)) == pytest.approx(25.0, abs=0.2) for one in ways)


def test_round_sides_meet_half_way_up_whatever_their_facets():
    """Once the lowest facet counted: 11 deg of 32, 5 of 72."""
    for sections in (24, 90):
        pin = shapes.part(shapes.cylinder(3.0, 20.0, sections))
        across = [one for one in orientations(pin, find(pin), LEVEL) if one.kind == "rolling"]
        shortest = min(across, key=lambda one: one.length)
        exact = 90.0 - np.degrees(np.arcsin(risks.LIFT / 6e-3))
        assert np.degrees(risks.wedge(shortest)) == pytest.approx(exact, abs=180.0 / sections)


def test_what_climbed_in_the_queue_is_said(keel):
    seen = FilledQueue("normal", 12, 30.0, 29.0, 20.0, 20, 20, 0, 0, 3)
    (said,) = risks.risks(keel[0], 0.3, (seen, replace(seen, climbs=0)))
    assert said == "parts climbed on others 3 times in 60 s of queue"
