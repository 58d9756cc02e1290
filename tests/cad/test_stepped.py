"""A wall that steps outwards with the track: each turn beside the one before, and what falls comes back."""

from dataclasses import replace

import numpy as np
import pytest
from solids import (
    CHAINS,
    CONICAL,
    NEAR,
    STEEP,
    STEPPED,
    TRACK,
    built,
    closed,
    is_one_body,
    outward,
    planned,
    slanted,
)

from feederscrew.base.errors import FeederError
from feederscrew.cad import facets
from feederscrew.cad.closed_body import body
from feederscrew.cad.measuring import measures, track_heights, track_width, ways_down
from feederscrew.cad.segments import overhangs
from feederscrew.cad.track import fillet

TURN_BEFORE = {"the turn of the track before"}


@pytest.fixture(scope="module")
def stepped():
    return built("narrowed and rails", STEEP, STEPPED, turns=1.8)


def to_wall(plan, whole, s):
    """Distance [m] from a place 5 mm off the wall's foot and 2 mm over the track to the wall of the mesh."""
    place = plan.path.places(s, 5e-3) + [0.0, 0.0, 2e-3]
    return facets.first_met(whole, place, place + 0.1 * outward(plan.path.angle(s)))[0]


def test_one_closed_body_of_its_measures_where_what_falls_comes_back_to_the_turn_before(stepped, rng):
    assert set(is_one_body(stepped).values()) == TURN_BEFORE
    sizes, own = measures(stepped), stepped.plan
    wanted = 0.3, own.material.wall, own.material.floor, own.outlet_height
    measured = sizes.diameter, sizes.wall, sizes.floor, sizes.outlet_height
    assert measured == pytest.approx(wanted, abs=NEAR) and own.turns > 1.5
    short = built("gap", STEEP, replace(STEPPED, outlet_height=0.03))
    assert ways_down(short) == {"gap ": "the floor"}
    assert short.vertices[:, 2].min() == pytest.approx(short.plan.underside, abs=1e-9)
    rough = replace(stepped.plan.stairs, slope=np.radians(60.0))  # parts hold still on it
    with pytest.raises(FeederError, match="meets the track at"):
        ways_down(replace(stepped, plan=replace(stepped.plan, stairs=rough)))
    # On a helix of one climb whose foot runs on a cone: r = R + flare (s - end), z = s tan(climb).
    own, whole = stepped.plan, facets.unplaced(stepped)
    s, y = rng.uniform(0.05, own.first, 80), rng.uniform(3e-4, TRACK.width - 3e-4, 80)
    heights = np.array([track_heights(own, whole, *one) for one in zip(s, y)])
    np.testing.assert_allclose(heights, np.tan(STEEP.climb) * s, rtol=0, atol=NEAR)
    for one in s[:20]:
        assert track_width(own, whole, one) == pytest.approx(TRACK.width, abs=NEAR)
        assert to_wall(own, whole, one) == pytest.approx(5e-3, abs=NEAR)


@pytest.mark.parametrize(
    ("climb", "bank", "width"), [(4.5, 0.0, 20e-3), (3.0, 8.0, 28e-3), (6.5, 15.0, 16e-3)]
)
def test_a_cone_is_closed_and_its_track_that_of_the_formula(climb, bank, width, rng):
    """At 100 places, with a ray that does not meet the leaning wall over the track for its foot."""
    track = replace(TRACK, climb=np.radians(climb), bank=np.radians(bank), width=width)
    solid = built(track=track, asked=CONICAL, turns=1.8)
    assert closed(solid) > 0.0
    own, whole = solid.plan, facets.unplaced(solid)
    s, y = rng.uniform(0.1, own.path.end - 0.01, 100), rng.uniform(3e-4, width - 3e-4, 100)
    heights = np.array([track_heights(own, whole, *one) for one in zip(s, y)])
    formula = np.tan(track.climb) * s + y * np.sin(track.bank)
    np.testing.assert_allclose(heights, formula, rtol=0, atol=NEAR)
    widths = np.array([track_width(own, whole, one) for one in s])
    np.testing.assert_allclose(widths, width, rtol=0, atol=NEAR)


@pytest.mark.parametrize("name", ["steel", "pla"])
def test_nothing_of_the_track_stands_out_of_a_leaning_wall(name):
    """Met from outside, where the fillet is: the wall's outer face, a wall from its inner one."""
    track = replace(TRACK, climb=np.radians(3.0), width=28e-3)
    solid = built(track=track, asked=CONICAL, turns=1.4, name=name)
    own, whole = solid.plan, facets.unplaced(solid)
    lean = np.tan(0.5 * np.pi - own.stairs.slope)
    for s in np.linspace(0.5, 0.9, 12) * own.path.end:
        foot, out = own.path.places(s, 0.0), outward(own.path.angle(s))
        for deep in np.linspace(0.5, 3.0, 12) * own.material.plate:
            start = foot + 0.05 * out - [0.0, 0.0, deep]
            met = 0.05 - facets.first_met(whole, start, start - 0.1 * out)[0]
            assert met == pytest.approx(own.material.wall - lean * deep, abs=NEAR)


def down(angle):
    return (slanted("spacing section", angle, "{{climb: {} deg}}"), *CHAINS["gap"])


def test_the_wall_goes_down_with_the_track_behind_a_separation():
    solid = body(planned(down(-4.0), replace(TRACK, climb=np.radians(5.5)), STEPPED, turns=1.8))
    assert set(is_one_body(solid).values()) == TURN_BEFORE
    plan, whole = solid.plan, facets.unplaced(solid)
    ((bend, _),) = plan.path.bends
    for s in np.linspace(bend - 0.05, plan.first + plan.stretch.openings[0][1].begin - 1e-3, 30):
        after = max(s - bend, 0.0)
        formula = np.tan(np.radians(5.5)) * (s - after) - np.tan(np.radians(4.0)) * after
        assert track_heights(plan, whole, s, 5e-3) == pytest.approx(formula, abs=NEAR)
        assert to_wall(plan, whole, s) == pytest.approx(5e-3, abs=NEAR)
        foot = plan.stairs.sections(plan.path, [plan.path.angle(s)], plan.underside)[0, -1]
        assert foot == pytest.approx([plan.path.wall_radius(s), formula], abs=1e-9)
    line = r"^devices: a device leads the track down to .* over the turn before - 43.62 mm are needed: give"
    with pytest.raises(FeederError, match=line):
        planned(down(-20.0), STEEP, STEPPED, turns=1.8)


def test_the_track_hangs_over_from_its_chamfer_to_its_edge():
    solid = built(name="pla")
    plan, way = solid.plan, solid.plan.path
    inner, outer = way.radius - plan.across, way.radius - fillet(plan)
    from_floor = way.end - plan.material.plate / np.tan(way.climb)  # before, its underside is in the floor
    area = 0.5 * (outer**2 - inner**2) * from_floor / way.radius
    assert overhangs(solid)["track"] == pytest.approx(area, rel=0.02)
