"""A groove in the bowl as a solid: two faces that meet at the foot of its wall."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from test_leans import STEEP, bank
from test_solid import GAP, NEAR, TRACK, One, closed, planned
from test_stepped import STEPPED

from feederscrew.solidbowl import cuts, facets, riding, track
from feederscrew.solidbowl.closed_body import _wall, body
from feederscrew.solidbowl.exact import exact_body
from feederscrew.solidbowl.measuring import measures, track_heights, ways_down
from feederscrew.solidbowl.plan import SolidOptions
from feederscrew.tooling.devices.kinds import make_device as device_of

LEFT = replace(STEPPED, left=True)
CYLINDER = replace(TRACK, climb=np.radians(4.5))


def groove(degrees):
    return device_of("groove", "b", angle=np.radians(degrees), text=f"{{angle: {degrees} deg}}")


CASES = {
    "at the end": ((GAP, groove(30.0)), CYLINDER, SolidOptions(), 30.0),
    "before a bank": ((GAP, groove(40.0), bank(0.0)), STEEP, LEFT, 40.0),
    "from the entry": ((groove(25.0),), CYLINDER, SolidOptions(), 25.0),
    "from the entry to a bank": ((groove(55.0), bank(5.0), GAP), STEEP, LEFT, 55.0),
}


def grooved(name):
    chain, own, asked, angle = CASES[name]
    own = cuts.banked_height(own, chain, [One(length=18e-3, height=12e-3, width=14e-3, track=own)])
    return body(planned(chain, track=own, asked=asked)), np.radians(angle)


@pytest.mark.parametrize("name", CASES)
def test_both_faces_rise_from_the_foot_by_its_angle(name, rng):
    solid, angle = grooved(name)
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    assert len(facets.placed(solid).decompose()) == 1
    plan, whole = solid.plan, facets.unplaced(solid)
    ((start, end, lean, opens),) = track.groove_spans(plan)
    assert lean == pytest.approx(0.5 * np.pi - angle) and opens == 18e-3
    twisted = max([start, *(stop for _, stop, tilt in plan.path.leans if tilt == angle)])
    for s in rng.uniform(
        max(start + opens, twisted) + 1e-3, min(end, plan.path.end + plan.outlet) - 1e-3, 40
    ):
        theta, foot = float(plan.path.angle(s)), plan.path.places(s, 0.0)
        out = np.array([np.cos(theta), np.sin(theta), 0.0])
        for along in (1e-3, 9e-3, 16e-3):  # up the wall's face, 17 mm wide
            place = foot + along * (np.cos(angle) * out + [0.0, 0.0, np.sin(angle)])
            assert facets.below(whole, place + [0.0, 0.0, 8e-3]) == pytest.approx(place[2], abs=NEAR)
        assert facets.below(whole, place + 5e-3 * out, 8e-3) is None  # beyond it there is nothing
        y = rng.uniform(3e-4, 19.6e-3)
        assert track_heights(plan, whole, s, y) == pytest.approx(foot[2] + y * np.sin(angle), abs=NEAR)
    found = measures(solid)
    assert found.outlet_height == pytest.approx(plan.outlet_height, abs=NEAR)
    assert found.diameter == pytest.approx(0.3, abs=3.0 * NEAR)  # of chords
    ways_down(solid)


def test_it_begins_where_it_is_listed_and_ends_at_a_bank():
    plan = grooved("before a bank")[0].plan
    ((start, end, _, opens),) = track.groove_spans(plan)
    first, last = (station.start for station in plan.stretch.stations[1:])
    assert (start, end) == pytest.approx((plan.first + first, plan.first + last))
    lean = track.lean_at(track.groove_spans(plan)[0], np.array([start, start + 0.5 * opens, end]))
    assert np.degrees(lean) == pytest.approx([3.0, 25.0, 50.0])  # it opens over the length of a part
    assert track.lean_at((start, end, 0.8, opens), end + opens) == track.MIN_GROOVE_WALL_LEAN_RAD
    early = grooved("from the entry")[0].plan
    assert early.path.angle(track.groove_spans(early)[0][0]) == pytest.approx(-0.85 * 2.0 * np.pi)


@pytest.mark.needs("OCP")
def test_the_wall_of_a_cylinder_is_cut_exactly():
    """A corner of the cut on the wall itself was not cut at all."""
    plan, volumes = grooved("from the entry")[0].plan, []
    for kit, measured in ((facets, lambda one: one.volume()), (exact_body, exact_body.volume)):
        whole = _wall(plan, kit)
        volumes.append((measured(whole), measured(kit.without(whole, track.groove_wall_cuts(plan, kit)))))
    (bare, cut), exact = volumes
    assert cut < 0.99 * bare and exact == pytest.approx((bare, cut), rel=1e-3)


@pytest.mark.parametrize(("name", "degrees"), [("at the end", 30.0), ("before a bank", 40.0)])
def test_a_part_lies_in_the_groove_at_both_faces(name, degrees):
    """A box of 14 x 8 x 6 mm on the track's face: its side touches the face of the wall, as rays meet it."""
    solid, angle = grooved(name)
    plan, whole, half = solid.plan, facets.unplaced(solid), np.array([7e-3, 4e-3, 3e-3])
    corners = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    box = SimpleNamespace(axes=np.eye(3), distance=5e-3, posture=SimpleNamespace(height=half[2]))
    start, end, _, opens = track.groove_spans(plan)[0]
    assert angle == np.radians(degrees)
    for s in np.linspace(start + opens + 8e-3, min(end, plan.path.end) - 8e-3, 5):
        off = []
        for one in facets.as_planned(plan, riding.place_rider(plan, box, corners, s)):
            out = np.array([*one[:2], 0.0]) / np.hypot(*one[:2])
            start = one - 3e-4 * out + [0.0, 0.0, 3e-4]  # not along the track
            met = facets.first_met(whole, start, start + 0.1 * out)  # nothing above the face
            off += [met[0] - 3e-4] if met else []
        assert min(off) == pytest.approx(3e-4 / np.tan(angle), abs=1.2e-4)
        assert track_heights(plan, whole, s, 8e-3) == pytest.approx(
            float(plan.path.height(s, 8e-3)), abs=NEAR
        )
