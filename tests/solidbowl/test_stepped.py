"""A wall that steps outwards with the track: each turn beside the one before, and what falls comes back."""

from dataclasses import replace

import numpy as np
import pytest
from test_solid import CHAINS, NEAR, TRACK, closed, planned

from feederscrew.errors import FeederError
from feederscrew.solidbowl import facets
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.measuring import heights, measures, track_width
from feederscrew.solidbowl.plan import Asked
from feederscrew.solidbowl.ways_down import ways_down

STEEP = replace(TRACK, climb=np.radians(4.5))
STEPPED = Asked(shape="stepped")


@pytest.fixture(scope="module")
def stepped():
    return body(planned(CHAINS["narrowed and rails"], track=STEEP, asked=STEPPED, turns=1.8))


def test_one_closed_body_of_its_measures(stepped):
    assert closed(stepped) == pytest.approx(stepped.volume * 1e9, rel=1e-6)
    assert len(facets.placed(stepped).decompose()) == 1
    found, made = measures(stepped), stepped.plan
    assert found.diameter == pytest.approx(0.3, abs=NEAR)
    assert found.wall == pytest.approx(made.material.wall, abs=NEAR)
    assert found.floor == pytest.approx(made.material.floor, abs=NEAR)
    assert found.outlet_height == pytest.approx(made.outlet_height, abs=NEAR)
    assert made.turns > 1.5


def test_height_width_and_wall_are_those_of_the_formula(stepped, rng):
    """On a helix of one climb whose foot runs on a cone: r = R + flare (s - end), z = s tan(climb)."""
    made, whole = stepped.plan, facets.unplaced(stepped)
    s, y = rng.uniform(0.05, made.first, 80), rng.uniform(3e-4, TRACK.width - 3e-4, 80)
    found = np.array([heights(made, whole, *one) for one in zip(s, y)])
    np.testing.assert_allclose(found, np.tan(STEEP.climb) * s, rtol=0, atol=NEAR)
    for one in s[:20]:
        assert track_width(made, whole, one) == pytest.approx(TRACK.width, abs=NEAR)
        place = made.way.places(one, 5e-3) + [0.0, 0.0, 2e-3]
        theta = made.way.angle(one)
        met = facets.first_met(whole, place, place + 0.1 * np.array([np.cos(theta), np.sin(theta), 0.0]))
        assert met[0] == pytest.approx(5e-3, abs=NEAR)


def test_each_turn_lies_beside_the_one_before(stepped):
    way = stepped.plan.way
    for theta in (0.0, -0.5, -1.0):
        inner, outer = (float(way.wall_radius(way.at(theta - turn))) for turn in (2.0 * np.pi, 0.0))
        assert outer - TRACK.width * np.exp(way.flare * theta) > inner


def test_what_falls_comes_back_to_the_turn_before(stepped):
    assert set(ways_down(stepped).values()) == {"the turn of the track before"}
    short = planned(CHAINS["gap"], track=STEEP, asked=replace(STEPPED, outlet_height=0.05))
    assert ways_down(body(short)) == {"gap ": "the floor"}


def test_a_slope_on_which_parts_hold_still_is_refused(stepped):
    rough = replace(stepped.plan.stairs, slope=np.radians(60.0))
    with pytest.raises(FeederError, match="meets the track at"):
        ways_down(replace(stepped, plan=replace(stepped.plan, stairs=rough)))


def test_a_cone_is_closed_and_its_track_that_of_the_formula():
    solid = body(planned(track=STEEP, asked=Asked(shape="conical"), turns=1.8))
    assert closed(solid) > 0.0
    made, whole = solid.plan, facets.unplaced(solid)
    for s in (0.2, 0.7, 1.2):
        assert heights(made, whole, s, 8e-3) == pytest.approx(np.tan(STEEP.climb) * s, abs=NEAR)
        assert track_width(made, whole, s) == pytest.approx(TRACK.width, abs=1e-3)


@pytest.mark.parametrize(
    ("track", "asked", "devices", "line"),
    [
        (
            replace(TRACK, climb=np.radians(2.5)), STEPPED, (),
            "track.climb: a turn rises 38.2 mm, and a stepped wall needs 49.62 mm - give 3.3 deg, or "
            "sizing.shape: cylinder",
        ),
        (
            TRACK, Asked(shape="conical"), CHAINS["gap"],
            "sizing.shape: conical leans outwards, and devices are computed by an upright wall - take "
            "stepped",
        ),
        (
            STEEP, replace(STEPPED, outlet_height=0.4), (),
            "sizing.outlet_height: leaves too small a floor: the wall steps outwards with the track - give "
            "at most 245.9 mm, or a larger bowl",
        ),
    ],
)  # fmt: skip
def test_faults(track, asked, devices, line):
    with pytest.raises(FeederError) as fault:
        planned(devices, track=track, asked=asked)
    assert str(fault.value) == line
