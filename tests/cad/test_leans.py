"""A solid's track that leans otherwise further on, goes on lower beside a ledge, or lies in a groove."""

import functools
from dataclasses import replace

import numpy as np
import pytest
import shapes
from solids import (
    GAP,
    NEAR,
    PLAIN,
    RAILS,
    STEEP,
    STEPPED,
    TRACK,
    One,
    closed,
    cuboid,
    device,
    is_one_body,
    outward,
    planned,
    rider,
    slanted,
)

from feederscrew.cad import facets, riding, track
from feederscrew.cad.closed_body import body, pieces, walls
from feederscrew.cad.exact import exact_body
from feederscrew.cad.measuring import measures, track_heights, track_width
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooled_track import lay_out, track_at_entry

LEFT = replace(STEPPED, left=True)
STEEPER = replace(TRACK, climb=np.radians(6.5))
TIP = device("tipping ledge", limit=6e-3, text="6 mm")
SHAPES = {"cylinder": (TRACK, PLAIN), "stepped": (STEEPER, LEFT)}


def bank(degrees):
    return slanted("banked track", degrees)


def groove(degrees):
    return slanted("V groove", degrees, "{{angle: {} deg}}")


@pytest.mark.parametrize("shape", SHAPES)
def test_a_bank_further_on_twists_the_track(shape, rng):
    own, asked = SHAPES[shape]
    solid = body(planned((GAP, bank(20.0)), own, asked))
    assert list(is_one_body(solid)) == ["gap "]
    plan, whole = solid.plan, facets.unplaced(solid)
    ((start, end, angle),) = plan.path.leans
    assert angle == np.radians(20.0) and plan.first < start < end < plan.path.end
    rise = TRACK.width * np.sin(angle) / (end - start)
    assert rise == pytest.approx(np.tan(np.radians(10.0)), rel=1e-9)  # its free edge rises gently
    for s, y in zip(rng.uniform(start - 2e-3, plan.path.end, 120), rng.uniform(2e-4, 19.7e-3, 120)):
        tilt = np.radians(20.0) * min(max((s - start) / (end - start), 0.0), 1.0)
        level = (plan.path.wall_radius(s) - y * np.cos(tilt)) * outward(plan.path.angle(s))[:2]
        np.testing.assert_allclose(plan.path.plan(s, y), level, rtol=0, atol=1e-12)
        formula = np.tan(own.climb) * s + y * np.sin(tilt)
        assert track_heights(plan, whole, s, y) == pytest.approx(formula, abs=NEAR)
    for s in (start - 1e-3, *(start + (end - start) * np.array([0.3, 0.7])), end + 2e-3):
        assert track_width(plan, whole, s) == pytest.approx(TRACK.width, abs=NEAR)
    assert measures(solid).outlet_height == pytest.approx(plan.outlet_height, abs=NEAR)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_twisted_track_stands_on_edge_with_its_wall_as_its_floor(shape, rng):
    """Floor and wall by rays along their normals: square to each other, and as thick as anywhere."""
    own, asked = SHAPES[shape]
    twist = replace(slanted("twisted track", 80.0, "{{angle: {} deg, length: 120 mm}}"), length=0.12)
    solid = body(planned((GAP, twist), own, asked))
    assert list(is_one_body(solid)) == ["gap "]
    plan, whole = solid.plan, facets.unplaced(solid)
    ((start, end, angle),) = plan.path.leans
    assert angle == np.radians(80.0) and end - start == pytest.approx(0.12)
    assert not track.sides(plan, facets)  # the track itself is the outlet's side
    for s in (*rng.uniform(start + 0.5 * (end - start), end, 10), *rng.uniform(end, plan.path.end, 5)):
        bank = float(plan.path.bank_at(s))
        outwards = np.array([*outward(plan.path.angle(s))[:2], 0.0])
        foot, up = plan.path.places(s, 0.0), np.array([0.0, 0.0, 1.0])
        inwards = np.sin(bank) * up - np.cos(bank) * outwards  # along the floor that stands as a wall
        normal = np.sin(bank) * outwards + np.cos(bank) * up  # along the wall that lies as the floor
        off, thick = rng.uniform(4e-3, 15e-3), plan.material.plate
        over, above = foot + off * inwards, foot + off * normal
        near, far = facets.first_met(whole, over + 2e-3 * normal, over - 0.01 * normal)
        assert near == pytest.approx(2e-3, abs=NEAR) and far - near == pytest.approx(thick, abs=NEAR)
        near, far = facets.first_met(whole, above + 2e-3 * inwards, above - 0.01 * inwards)
        assert near == pytest.approx(2e-3, abs=NEAR)
        assert far - near == pytest.approx(plan.material.wall, abs=NEAR)
    one = rider(distance=4e-3, height=2e-3)
    assert np.isfinite(riding.place_rider(plan, one, np.eye(3) * 1e-3, plan.path.end - 5e-3)).all()
    assert measures(solid).outlet_height == pytest.approx(plan.outlet_height, abs=10.0 * NEAR)


@pytest.mark.parametrize("sweep", [30.0, 55.0])
def test_a_blade_that_reaches_ahead_keeps_its_clearance_all_along_a_banked_track(sweep):
    """A straight edge lay x^2 sin(bank) / 8 R nearer to the track between its ends: 0.25 mm at 30 deg."""
    blade = device("wiper", limit=5e-3, sweep=np.radians(sweep))
    solid = body(planned((bank(8.0), blade), STEEPER))
    plan, whole = solid.plan, facets.unplaced(solid)
    first = plan.first + plan.stretch.devices[1].begin
    (own,) = plan.stretch.devices[1].features.blades
    long, radius, met = 20e-3 / np.sin(own.heading), plan.path.radius, []
    for x in np.linspace(0.1, 0.9, 9) * long * np.cos(own.heading):  # in the middle of its thickness
        y = x * np.tan(own.heading) - 0.5 * own.thickness / np.cos(own.heading)
        s, off = first + own.foot[0] + radius * np.arctan2(x, radius - y), radius - np.hypot(x, radius - y)
        if off > 1.5e-3:  # the wall leans over what is nearer
            place, up = plan.path.places(s, off), plan.path.normal(s)
            met.append(facets.first_met(whole, place + 1e-4 * up, place + 15e-3 * up)[0] + 1e-4)
    assert len(met) > 6 and met == pytest.approx([5e-3] * len(met), abs=4e-5)


@pytest.mark.parametrize("degrees", [30.0, 12.0])
def test_the_outlet_is_whole_up_to_its_side(degrees, rng):
    """A surface that was made simpler had lost a wedge of it, 490 mm3, where side and track only touched."""
    plan = planned((GAP, bank(degrees)))
    solid, (whole, _) = body(plan), pieces(plan)
    mesh = facets.unplaced(solid)
    assert [solid.volume * 1e9, mesh.volume()] == pytest.approx([whole.volume()] * 2, rel=1e-6)
    for s in rng.uniform(plan.path.end + 1e-3, plan.path.end + plan.outlet - 1e-3, 40):
        y = rng.uniform(16e-3, plan.width - 1e-4)
        assert track_heights(plan, mesh, s, y) == pytest.approx(float(plan.path.height(s, y)), abs=NEAR)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_tip_is_a_ledge_beside_a_lower_track(shape):
    own, asked = SHAPES[shape]
    solid = body(planned((TIP, GAP), own, asked))
    is_one_body(solid)
    plan, whole = solid.plan, facets.unplaced(solid)
    (ledge,), ((placed, gap),) = plan.stretch.ledges, plan.stretch.openings
    start, end = plan.first + ledge.begin, plan.first + ledge.end
    assert (ledge.drop.aside, ledge.drop.height) == (6e-3, 9e-3) and end - start == pytest.approx(1.3 * 18e-3)
    # bent down along a line square to the wall, it is flat: it falls by the way ahead of that line
    ramp = plan.path.radius * np.arcsin(9e-3 / np.tan(np.radians(15.0)) / (plan.path.radius - 6e-3))
    assert ledge.foot == pytest.approx(ledge.end + ramp, rel=1e-9)
    for s in np.linspace(start - 8e-3, end + ramp + 5e-3, 60):
        turn, low = max((s - end) / plan.path.radius, 0.0), 0.0 if s < start else -9e-3
        on = [
            max(-9e-3, -np.tan(np.radians(15.0)) * (plan.path.radius - y) * np.sin(turn))
            for y in (1e-3, 5.9e-3)
        ]
        for y, formula in ((1e-3, on[0]), (5.9e-3, on[1]), (6.1e-3, low), (19e-3, low)):
            place = [*plan.path.plan(s, y), np.tan(own.climb) * s + 4e-3]
            assert facets.below(whole, place) - np.tan(own.climb) * s == pytest.approx(formula, abs=NEAR)
    assert placed.label == "gap " and gap.begin > ledge.foot
    assert plan.path.drops == ((start, 9e-3),)


@pytest.mark.needs("OCP")
def test_a_step_higher_than_the_plate_is_one_exact_body():
    """Two runs of track that do not meet were united before what joins them: one of them was lost."""
    plan = planned((TIP,))
    exact, flat = (track.slab(plan, kit) for kit in (exact_body, facets))
    assert exact_body.volume(exact) == pytest.approx(flat.volume(), rel=3e-3)


def test_a_yoke_of_banked_rails_lies_below_them_and_the_outlet_hangs_on_a_track_that_leans():
    solid = body(planned((RAILS,), replace(TRACK, bank=np.radians(15.0), climb=np.radians(4.0))))
    is_one_body(solid)
    plan, whole = solid.plan, facets.unplaced(solid)
    for s in plan.first + plan.stretch.openings[0][1].end + np.array([1e-3, 3e-3, 5e-3]):
        for y in (5e-4, 2.5e-3, 8e-3, 19e-3):
            formula = np.tan(np.radians(4.0)) * s + y * np.sin(np.radians(15.0))
            assert track_heights(plan, whole, s, y) == pytest.approx(formula, abs=NEAR)
    # The outlet's inner side hangs on it: at 43 deg both ended in one plane, and rounding left a gap between.
    solid = body(planned((GAP, bank(43.0)), STEEPER, LEFT))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    plan, lift = solid.plan, solid.plan.width * np.sin(np.radians(43.0))
    place = plan.path.places(plan.path.end + 0.5 * plan.outlet, plan.width + 0.5e-3)  # on the side's top
    met = facets.below(facets.unplaced(solid), [*place[:2], 1.0])
    assert met == pytest.approx(plan.outlet_height + lift + plan.headroom, abs=NEAR)


GROOVES = {
    "at the end": ((GAP, groove(30.0)), STEEP, PLAIN, 30.0),
    "before a bank": ((GAP, groove(40.0), bank(0.0)), STEEPER, LEFT, 40.0),
    "from the entry": ((groove(25.0),), STEEP, PLAIN, 25.0),
    "from the entry to a bank": ((groove(55.0), bank(5.0), GAP), STEEPER, LEFT, 55.0),
}


@functools.cache
def grooved(name):
    chain, own, asked, angle = GROOVES[name]
    return body(planned(chain, own, asked)), np.radians(angle)


@pytest.mark.parametrize("name", GROOVES)
def test_both_faces_rise_from_the_foot_by_its_angle(name, rng):
    solid, angle = grooved(name)
    is_one_body(solid)
    plan, whole = solid.plan, facets.unplaced(solid)
    (span,) = track.groove_spans(plan)
    opened, end = span.leans[0][1], span.end
    assert span.lean == pytest.approx(0.5 * np.pi - angle)
    first, last = opened + 1e-3, min(end, plan.path.end + plan.outlet) - 1e-3
    for s in rng.uniform(first, last, 40):
        foot, out = plan.path.places(s, 0.0), outward(float(plan.path.angle(s)))
        for along in (1e-3, 9e-3, 16e-3):  # up the wall's face, 17 mm wide
            place = foot + along * (np.cos(angle) * out + [0.0, 0.0, np.sin(angle)])
            assert facets.below(whole, place + [0.0, 0.0, 8e-3]) == pytest.approx(place[2], abs=NEAR)
        assert facets.below(whole, place + 5e-3 * out, 8e-3) is None  # beyond it there is nothing
        y = rng.uniform(3e-4, 19.6e-3)
        assert track_heights(plan, whole, s, y) == pytest.approx(foot[2] + y * np.sin(angle), abs=NEAR)
    sizes = measures(solid)
    assert sizes.outlet_height == pytest.approx(plan.outlet_height, abs=NEAR)
    assert sizes.diameter == pytest.approx(0.3, abs=3.0 * NEAR)  # of chords


def test_a_groove_begins_where_it_is_listed_and_ends_at_a_bank():
    plan = grooved("before a bank")[0].plan
    (span,) = track.groove_spans(plan)
    start, end = span.begin, span.end
    first, last = (placed.begin for placed in plan.stretch.devices[1:])
    assert (start, end) == pytest.approx((plan.first + first, plan.first + last))
    # it opens as the track twists: its free edge rises by 10 deg at most
    opens = plan.width * np.sin(np.radians(40.0)) / np.tan(np.radians(10.0))
    lean = track.lean_at(span, np.array([start, start + 0.5 * opens, start + opens, end]))
    assert np.degrees(lean) == pytest.approx([3.0, 25.0, 50.0, 50.0])
    banks = plan.path.bank_at(np.array([start, start + 0.5 * opens, start + opens, end, end + opens]))
    assert np.degrees(banks) == pytest.approx([0.0, 20.0, 40.0, 40.0, 0.0], abs=1e-9)
    assert track.lean_at(span, end + opens) == track.MIN_GROOVE_WALL_LEAN_RAD
    early = grooved("from the entry")[0].plan
    assert early.path.angle(track.groove_spans(early)[0].begin) == pytest.approx(-0.85 * 2.0 * np.pi)
    # A bank that is listed first is that of the track from its entry on; the next begins at its own place.
    chain = (bank(3.0), bank(6.0), GAP, bank(9.0))
    assert track_at_entry(TRACK, chain, [One(TRACK)]).bank == np.radians(3.0)


def test_grooves_that_adjoin_are_one_and_their_wall_goes_from_lean_to_lean():
    """The first closed while the second opened: between them the wall stood half upright."""
    chain = (groove(30.0), groove(50.0), bank(0.0))
    solid = body(planned(chain, STEEPER, LEFT))
    is_one_body(solid)
    plan, whole = solid.plan, facets.unplaced(solid)
    (span,) = track.groove_spans(plan)
    begin, end = span.leans[1][:2]
    middle = 0.5 * (begin + end)
    assert np.degrees(track.lean_at(span, np.array([begin, middle, end]))) == pytest.approx(
        [60.0, 50.0, 40.0]
    )
    rise = np.radians(40.0)  # of the wall's face at the middle
    foot, out = plan.path.places(middle, 0.0), outward(float(plan.path.angle(middle)))
    for along in (2e-3, 9e-3, 16e-3):
        place = foot + along * (np.cos(rise) * out + [0.0, 0.0, np.sin(rise)])
        assert facets.below(whole, place + [0.0, 0.0, 8e-3]) == pytest.approx(place[2], abs=NEAR)
    chain = (bank(6.0), GAP, bank(6.0))
    assert planned(chain).path.leans == ()
    ((start, end, angle),) = planned((bank(3.0), GAP, bank(0.0))).path.leans
    assert angle == 0.0 and end - start == pytest.approx(0.65 * 18e-3)  # half a room, and gentle enough


@pytest.mark.needs("OCP")
def test_the_wall_of_a_cylinder_is_cut_exactly():
    """A corner of the cut on the wall itself was not cut at all."""
    plan, volumes = grooved("from the entry")[0].plan, []
    for kit, measured in ((facets, lambda one: one.volume()), (exact_body, exact_body.volume)):
        whole = walls(plan, kit)[0]
        volumes.append((measured(whole), measured(kit.without(whole, track.groove_walls(plan, kit)[0]))))
    (bare, cut), exact = volumes
    assert cut < 0.99 * bare and exact == pytest.approx((bare, cut), rel=1e-3)


@pytest.mark.parametrize("name", ["at the end", "before a bank"])
def test_a_part_lies_in_the_groove_at_both_faces(name):
    """A box of 14 x 8 x 6 mm on the track's face: its side touches the face of the wall, as rays meet it."""
    solid, angle = grooved(name)
    plan, whole = solid.plan, facets.unplaced(solid)
    (span,) = track.groove_spans(plan)
    opened, end = span.leans[0][1], span.end
    for s in np.linspace(opened + 8e-3, min(end, plan.path.end) - 8e-3, 5):
        off = []
        points = riding.place_rider(plan, rider(5e-3, 3e-3), cuboid([7e-3, 4e-3, 3e-3]), s)
        for one in facets.as_planned(plan, points):
            out = outward(one)
            begin = one - 3e-4 * out + [0.0, 0.0, 3e-4]  # not along the track
            met = facets.first_met(whole, begin, begin + 0.1 * out)  # nothing above the face
            off += [met[0] - 3e-4] if met else []
        assert min(off) == pytest.approx(3e-4 / np.tan(angle), abs=1.2e-4)
        formula = float(plan.path.height(s, 8e-3))
        assert track_heights(plan, whole, s, 8e-3) == pytest.approx(formula, abs=NEAR)


def test_a_ledge_comes_all_the_way_down_in_a_small_bowl():
    """At 15 deg a drop of 30 mm takes 112 mm, in a bowl of 80 mm: it ended 18 mm down, at nine tenths."""
    part = shapes.part(shapes.box(60, 12, 5))
    small = replace(TRACK, radius=80e-3)
    tooled = lay_out(small, (TIP,), orientations(part, find(part), small))
    (ledge,) = tooled.ledges
    assert ledge.drop.height == pytest.approx(30e-3) and np.degrees(ledge.drop.ramp) > 15.0
    assert ledge.level_at(ledge.foot, ledge.drop.aside) == pytest.approx(-30e-3, abs=1e-9)
    assert ledge.foot < ledge.end + 0.25 * 2.0 * np.pi * 80e-3  # within a quarter turn
