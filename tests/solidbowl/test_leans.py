"""A solid's track that leans otherwise further on, and one that goes on lower beside a ledge."""

from dataclasses import replace

import numpy as np
import pytest
from test_solid import GAP, NEAR, RAILS, TRACK, One, closed, planned
from test_stepped import STEPPED

from feederscrew.solidbowl import cuts, facets, track
from feederscrew.solidbowl.closed_body import body, pieces
from feederscrew.solidbowl.exact import exact_body
from feederscrew.solidbowl.measuring import measures, track_heights, track_width, ways_down
from feederscrew.solidbowl.plan import SolidOptions
from feederscrew.tooling.devices.kinds import make_device as device_of

STEEP = replace(TRACK, climb=np.radians(6.5))
TIP = device_of("tip", "b", limit=6e-3, text="6 mm")
SHAPES = {"cylinder": (TRACK, SolidOptions()), "stepped": (STEEP, replace(STEPPED, left=True))}


def bank(degrees):
    return device_of("bank", "b", angle=np.radians(degrees), text=f"{degrees} deg")


@pytest.mark.parametrize("shape", SHAPES)
def test_a_bank_further_on_twists_the_track(shape, rng):
    own, asked = SHAPES[shape]
    solid = body(planned((GAP, bank(20.0)), track=own, asked=asked))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    plan, whole = solid.plan, facets.unplaced(solid)
    ((start, end, angle),) = plan.path.leans
    assert angle == np.radians(20.0) and plan.first < start < end < plan.path.end
    edge = TRACK.width * np.sin(angle) / (end - start)
    assert edge == pytest.approx(np.tan(np.radians(10.0)), rel=1e-9)  # its free edge rises gently
    for s, y in zip(rng.uniform(start - 2e-3, plan.path.end, 120), rng.uniform(2e-4, 19.7e-3, 120)):
        tilt = np.radians(20.0) * min(max((s - start) / (end - start), 0.0), 1.0)
        place = plan.path.wall_radius(s) - y * np.cos(tilt), plan.path.angle(s)
        flat = place[0] * np.array([np.cos(place[1]), np.sin(place[1])])
        np.testing.assert_allclose(plan.path.plan(s, y), flat, rtol=0, atol=1e-12)
        formula = np.tan(own.climb) * s + y * np.sin(tilt)
        assert track_heights(plan, whole, s, y) == pytest.approx(formula, abs=NEAR)
    for s in (start - 1e-3, *(start + (end - start) * np.array([0.3, 0.7])), end + 2e-3):
        assert track_width(plan, whole, s) == pytest.approx(TRACK.width, abs=NEAR)
    assert measures(solid).outlet_height == pytest.approx(plan.outlet_height, abs=NEAR)
    assert list(ways_down(solid)) == ["gap "]


@pytest.mark.parametrize("degrees", [30.0, 12.0])
def test_the_outlet_is_whole_up_to_its_side(degrees, rng):
    """A surface that was made simpler had lost a wedge of it, 490 mm3, where side and track only touched."""
    own, asked = SHAPES["cylinder"]
    plan = planned((GAP, bank(degrees)), track=own, asked=asked)
    made_of, (whole, _) = body(plan), pieces(plan)
    assert made_of.volume * 1e9 == pytest.approx(whole.volume(), rel=1e-6)
    assert facets.unplaced(made_of).volume() == pytest.approx(whole.volume(), rel=1e-6)
    for s in rng.uniform(plan.path.end + 1e-3, plan.path.end + plan.outlet - 1e-3, 40):
        y = rng.uniform(16e-3, plan.width - 1e-4)
        met = track_heights(plan, facets.unplaced(made_of), s, y)
        assert met == pytest.approx(float(plan.path.height(s, y)), abs=NEAR)


def test_banks_listed_first_are_those_of_the_whole_track():
    one = One(length=18e-3, height=12e-3, width=14e-3, track=TRACK)
    assert cuts.banked_height(TRACK, (bank(3.0), bank(6.0), GAP, bank(9.0)), [one]).bank == np.radians(6.0)
    chain = (bank(6.0), GAP, bank(6.0))
    own = cuts.banked_height(TRACK, chain, [one])
    assert planned(chain, track=own).path.leans == ()
    ((start, end, angle),) = planned((bank(3.0), GAP, bank(0.0)), track=replace(own, bank=0.05)).path.leans
    assert angle == 0.0 and end - start == pytest.approx(0.65 * 18e-3)  # half a room, and gentle enough


@pytest.mark.parametrize("shape", SHAPES)
def test_a_tip_is_a_ledge_beside_a_lower_track(shape):
    own, asked = SHAPES[shape]
    solid = body(planned((TIP, GAP), track=own, asked=asked))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    plan, whole = solid.plan, facets.unplaced(solid)
    (ledge,) = plan.stretch.ledges
    start, end = plan.first + ledge.start, plan.first + ledge.end
    assert (ledge.width, ledge.drop) == (6e-3, 9e-3) and end - start == pytest.approx(1.3 * 18e-3)
    ramp = 9e-3 / np.tan(np.radians(15.0))

    def found(s, y):
        place = [*plan.path.plan(s, y), np.tan(own.climb) * s + 4e-3]
        return facets.below(whole, place) - np.tan(own.climb) * s

    for s in np.linspace(start - 8e-3, end + ramp + 5e-3, 60):
        on = 0.0 if s < end else max(-9e-3, -9e-3 * (s - end) / ramp)
        for y in (1e-3, 5.9e-3):
            assert found(s, y) == pytest.approx(on, abs=NEAR)
        for y in (6.1e-3, 19e-3):
            assert found(s, y) == pytest.approx(0.0 if s < start else -9e-3, abs=NEAR)
    gap = plan.stretch.cuts[0]
    assert [one.label for one in plan.stretch.cuts] == ["gap "] and gap.span[0] > ledge.end + ramp
    assert plan.path.drops == ((start, 9e-3),)
    ways_down(solid)


@pytest.mark.needs("OCP")
def test_a_step_higher_than_the_plate_is_one_exact_body():
    """Two runs of track that do not meet were united before what joins them: one of them was lost."""
    plan = planned((TIP,))
    exact, flat = (track.slab(plan, kit) for kit in (exact_body, facets))
    assert exact_body.volume(exact) == pytest.approx(flat.volume(), rel=3e-3)


def test_a_yoke_of_banked_rails_lies_below_their_surface():
    solid = body(planned((RAILS,), track=replace(TRACK, bank=np.radians(15.0), climb=np.radians(4.0))))
    plan, whole = solid.plan, facets.unplaced(solid)
    behind = plan.first + plan.stretch.cuts[0].span[1]
    for s in behind + np.array([1e-3, 3e-3, 5e-3]):
        for y in (5e-4, 2.5e-3, 8e-3, 19e-3):
            formula = np.tan(np.radians(4.0)) * s + y * np.sin(np.radians(15.0))
            assert track_heights(plan, whole, s, y) == pytest.approx(formula, abs=NEAR)
    assert len(facets.placed(solid).decompose()) == 1


def test_the_inner_side_of_the_outlet_hangs_on_a_track_that_leans():
    """At 43 deg both ended in one plane, and rounding left a gap between them."""
    own, asked = SHAPES["stepped"]
    solid = body(planned((GAP, bank(43.0)), track=own, asked=asked))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    plan = solid.plan
    whole, lift = facets.unplaced(solid), plan.width * np.sin(np.radians(43.0))
    place = plan.path.places(plan.path.end + 0.5 * plan.outlet, plan.width + 0.5e-3)  # on the side's top
    met = facets.below(whole, [*place[:2], 1.0])
    assert met == pytest.approx(plan.outlet_height + lift + plan.headroom, abs=NEAR)
