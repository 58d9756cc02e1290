"""A wall that steps outwards with the track: each turn beside the one before, and what falls comes back."""

from dataclasses import replace

import numpy as np
import pytest
from test_solid import CHAINS, NEAR, TRACK, closed, planned

from feederscrew.errors import FeederError
from feederscrew.solidbowl import facets
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.measuring import measures, track_heights, track_width, ways_down
from feederscrew.solidbowl.plan import SolidOptions
from feederscrew.solidbowl.segments import overhangs
from feederscrew.solidbowl.track import fillet
from feederscrew.tooling.devices.kinds import make_device

STEEP = replace(TRACK, climb=np.radians(4.5))
STEPPED = SolidOptions(shape="stepped")


@pytest.fixture(scope="module")
def stepped():
    return body(planned(CHAINS["narrowed and rails"], track=STEEP, asked=STEPPED, turns=1.8))


def test_one_closed_body_of_its_measures(stepped):
    assert closed(stepped) == pytest.approx(stepped.volume * 1e9, rel=1e-6)
    assert len(facets.placed(stepped).decompose()) == 1
    found, own = measures(stepped), stepped.plan
    assert found.diameter == pytest.approx(0.3, abs=NEAR)
    assert found.wall == pytest.approx(own.material.wall, abs=NEAR)
    assert found.floor == pytest.approx(own.material.floor, abs=NEAR)
    assert found.outlet_height == pytest.approx(own.outlet_height, abs=NEAR)
    assert own.turns > 1.5


def test_height_width_and_wall_are_those_of_the_formula(stepped, rng):
    """On a helix of one climb whose foot runs on a cone: r = R + flare (s - end), z = s tan(climb)."""
    own, whole = stepped.plan, facets.unplaced(stepped)
    s, y = rng.uniform(0.05, own.first, 80), rng.uniform(3e-4, TRACK.width - 3e-4, 80)
    found = np.array([track_heights(own, whole, *one) for one in zip(s, y)])
    np.testing.assert_allclose(found, np.tan(STEEP.climb) * s, rtol=0, atol=NEAR)
    for one in s[:20]:
        assert track_width(own, whole, one) == pytest.approx(TRACK.width, abs=NEAR)
        place = own.path.places(one, 5e-3) + [0.0, 0.0, 2e-3]
        theta = own.path.angle(one)
        met = facets.first_met(whole, place, place + 0.1 * np.array([np.cos(theta), np.sin(theta), 0.0]))
        assert met[0] == pytest.approx(5e-3, abs=NEAR)


def test_what_falls_comes_back_to_the_turn_before(stepped):
    assert set(ways_down(stepped).values()) == {"the turn of the track before"}
    short = planned(CHAINS["gap"], track=STEEP, asked=replace(STEPPED, outlet_height=0.03))
    made_short = body(short)
    assert ways_down(made_short) == {"gap ": "the floor"}
    assert made_short.vertices[:, 2].min() == pytest.approx(short.underside, abs=1e-9)


def test_a_slope_on_which_parts_hold_still_is_refused(stepped):
    rough = replace(stepped.plan.stairs, slope=np.radians(60.0))
    with pytest.raises(FeederError, match="meets the track at"):
        ways_down(replace(stepped, plan=replace(stepped.plan, stairs=rough)))


@pytest.mark.parametrize(
    ("climb", "bank", "width"), [(4.5, 0.0, 20e-3), (3.0, 8.0, 28e-3), (6.5, 15.0, 16e-3)]
)
def test_a_cone_is_closed_and_its_track_that_of_the_formula(climb, bank, width, rng):
    """At 200 places, with a ray that does not meet the leaning wall over the track for its foot."""
    track = replace(TRACK, climb=np.radians(climb), bank=np.radians(bank), width=width)
    solid = body(planned(track=track, asked=SolidOptions(shape="conical"), turns=1.8))
    assert closed(solid) > 0.0
    own, whole = solid.plan, facets.unplaced(solid)
    s, y = rng.uniform(0.1, own.path.end - 0.01, 200), rng.uniform(3e-4, width - 3e-4, 200)
    found = np.array([track_heights(own, whole, *one) for one in zip(s, y)])
    formula = np.tan(track.climb) * s + y * np.sin(track.bank)
    np.testing.assert_allclose(found, formula, rtol=0, atol=NEAR)
    widths = np.array([track_width(own, whole, one) for one in s])
    np.testing.assert_allclose(widths, width, rtol=0, atol=NEAR)


@pytest.mark.parametrize("name", ["steel", "pla"])
def test_nothing_of_the_track_stands_out_of_a_leaning_wall(name):
    """Met from outside, where the fillet is: the wall's outer face, a wall from its inner one."""
    track = replace(TRACK, climb=np.radians(3.0), width=28e-3)
    solid = body(planned(track=track, asked=SolidOptions(shape="conical"), turns=1.4, name=name))
    own, whole = solid.plan, facets.unplaced(solid)
    lean = np.tan(0.5 * np.pi - own.stairs.slope)
    for s in np.linspace(0.5, 0.9, 12) * own.path.end:
        theta, foot = own.path.angle(s), own.path.places(s, 0.0)
        out = np.array([np.cos(theta), np.sin(theta), 0.0])
        for deep in np.linspace(0.5, 3.0, 12) * own.material.plate:
            start = foot + 0.05 * out - [0.0, 0.0, deep]
            met = 0.05 - facets.first_met(whole, start, start - 0.1 * out)[0]
            assert met == pytest.approx(own.material.wall - lean * deep, abs=NEAR)


@pytest.mark.parametrize(
    ("track", "asked", "devices", "line"),
    [
        (
            replace(TRACK, climb=np.radians(2.5)), STEPPED, (),
            "track.climb: a turn rises 38.2 mm, and a stepped wall needs 49.62 mm - give 3.3 deg, or "
            "sizing.shape: cylinder",
        ),
        (
            TRACK, SolidOptions(shape="conical"), CHAINS["gap"],
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


def down(angle):
    return (
        make_device("separation", "b", angle=np.radians(angle), text=f"{{climb: {angle} deg}}"),
        *CHAINS["gap"],
    )


def test_the_wall_goes_down_with_the_track_behind_a_separation():
    solid = body(planned(down(-4.0), track=replace(TRACK, climb=np.radians(5.5)), asked=STEPPED, turns=1.8))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    plan, whole = solid.plan, facets.unplaced(solid)
    ((bend, _),) = plan.path.bends
    for s in np.linspace(bend - 0.05, plan.first + plan.stretch.cuts[0].span[0] - 1e-3, 30):
        after = max(s - bend, 0.0)
        formula = np.tan(np.radians(5.5)) * (s - after) - np.tan(np.radians(4.0)) * after
        assert track_heights(plan, whole, s, 5e-3) == pytest.approx(formula, abs=NEAR)
        place, theta = plan.path.places(s, 5e-3) + [0.0, 0.0, 2e-3], plan.path.angle(s)
        met = facets.first_met(whole, place, place + 0.1 * np.array([np.cos(theta), np.sin(theta), 0.0]))
        assert met[0] == pytest.approx(5e-3, abs=NEAR)
        foot = plan.stairs.sections(plan.path, [theta], plan.underside)[0, -1]
        assert foot == pytest.approx([plan.path.wall_radius(s), formula], abs=1e-9)
    assert set(ways_down(solid).values()) == {"the turn of the track before"}


def test_a_separation_that_leaves_no_room_for_the_slope():
    line = (
        r"^devices: a device leads the track down to .* mm over the turn before - 43.62 mm are needed: give"
    )
    with pytest.raises(FeederError, match=line):
        planned(down(-20.0), track=STEEP, asked=STEPPED, turns=1.8)


def test_the_track_hangs_over_from_its_chamfer_to_its_edge():
    solid = body(planned(name="pla"))
    plan, way = solid.plan, solid.plan.path
    inner, outer = way.radius - plan.across, way.radius - fillet(plan)
    from_floor = way.end - plan.material.plate / np.tan(way.climb)  # before, its underside is in the floor
    area = 0.5 * (outer**2 - inner**2) * from_floor / way.radius
    assert overhangs(solid)["track"] == pytest.approx(area, rel=0.02)
