"""Screws across the seams of a bowl in segments: through both halves of lugs outside the wall."""

import functools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
import trimesh
from solids import CONICAL, PLAIN, STEEP, STEPPED, TRACK, built, closed
from test_drawing import study

from feederscrew.base.errors import FeederError
from feederscrew.cad import facets, segments
from feederscrew.cad.closed_body import screwed
from feederscrew.cad.plan import SolidOptions
from feederscrew.output import bowl_sheet, solidbowl
from feederscrew.part import mass

BED, LOW = (0.22, 0.22, 0.25), (0.22, 0.22, 0.06)
SHAPES = {
    "cylinder": ("gap", TRACK, SolidOptions(left=True, outlet_angle=0.4), BED),
    "low bed": ("gap", TRACK, PLAIN, LOW),
    "stepped": ("gap", STEEP, STEPPED, BED),
    "conical": ("none", STEEP, CONICAL, LOW),
}


@functools.cache
def cut(name):
    chain, track, asked, bed = SHAPES[name]
    solid = built(chain, track, asked, "pla")
    return solid, segments.segments(solid, bed, segments.SCREWS), bed


def joined_mesh(cut_bowl):
    return facets.placed(SimpleNamespace(vertices=cut_bowl.joined[0], faces=cut_bowl.joined[1]))


@pytest.mark.parametrize(("half", "count"), [(16.0, 2), (19.0, 4)])
def test_lugs_of_seams_that_cross_stand_two_screws_apart(half, count):
    """Screws stand 6 mm off the walls of a square: 31.1 and 35.4 mm from the next, a screw is 16 mm long."""
    box = trimesh.creation.box((2.0 * half, 2.0 * half, 60.0))
    block = facets.placed(SimpleNamespace(vertices=box.vertices / 1e3, faces=box.faces))
    extents = np.array([[-half, half], [-half, half], [-30.0, -4.0]]) / 1e3
    lugs, bare, ends = segments.place_lugs(block, [(0, 0.0), (1, 0.0)], shapely.Point(9.0, 9.0), extents)
    assert (len(lugs), bare, ends) == (count, 4 - count, 4)


@pytest.mark.parametrize("name", SHAPES)
def test_a_screw_goes_through_both_halves_of_its_lug(name):
    solid, pieces, bed = cut(name)
    whole, bare = joined_mesh(pieces), facets.placed(solid)
    assert len(pieces.screws) >= 4
    for one, along, out in pieces.lugs:
        side = np.cross(along, out)
        towards = np.array([out, side, -out, -side])
        head, nut = (sign * 0.5 * segments.SCREW_LENGTH_M * along for sign in (1.0, -1.0))
        assert facets.first_met(whole, one + 1.5 * head, one + 1.5 * nut) == []  # the hole is free
        holes = [(at, segments.HOLE) for at in (0.0, 6e-3, -4e-3)]
        for at, free in (*holes, (-7e-3, 5.7e-3)):
            start = one + at * along
            around = [facets.first_met(whole, start, start + 0.015 * w) for w in towards]
            for hits in (around[0], around[1], around[3]):  # metal round it, then air
                assert 0.5 * free - 2e-5 < hits[0] < 0.62 * free and len(hits) == 2
                assert hits[1] - hits[0] > 1.2e-3
        for at, free in ((1.02 * head, 3.2e-3), (1.02 * nut, 2.8e-3)):  # room for the head and for the nut
            for way in towards:
                assert facets.first_met(whole, one + at, one + at + free * way) == []
        assert facets.first_met(bare, one, one + 0.3 * out) == []  # it lies outside the wall
    for one in pieces.pieces:
        assert all(np.array(one.size) <= np.array(bed) + 1e-6)
        closed(one, near=1e-5)


@pytest.mark.parametrize("name", SHAPES)
def test_lugs_stand_outside_the_wall_and_off_devices_and_ends_without_a_screw_are_said(name):
    solid, pieces, _ = cut(name)
    plan, old, whole = solid.plan, facets.placed(solid), joined_mesh(pieces)
    assert facets.without(whole, [old]).volume() > 1e4
    for one, along, out in pieces.lugs:  # seen from within, the wall is as it was
        for off in np.linspace(-30e-3, 30e-3, 13):
            for side in np.linspace(-20e-3, 20e-3, 7):
                place = one + off * along + side * np.cross(along, out)
                ends = place - 0.05 * out, place + 0.03 * out
                now, before = (facets.first_met(each, *ends)[:1] for each in (whole, old))
                assert now == pytest.approx(before, abs=1e-7) or now[0] > 0.043
    if plan.stretch is not None:
        s = np.linspace(plan.first, plan.path.end + plan.outlet, 200)
        line = shapely.LineString(plan.path.plan(s, -plan.material.wall))
        there = facets.as_planned(plan, pieces.screws)[:, :2]
        assert line.distance(shapely.points(there)).min() > 0.012
    # Ends of seams without a screw are said.
    c, s = np.cos(pieces.turned), np.sin(pieces.turned)
    seams = np.einsum("ij,nkj->nki", [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]], pieces.lugs)
    screwed_ends = set()
    for one, along, out in seams:  # in the axes of the seams: the axis and place of the one it crosses
        axis = int(np.argmax(np.abs(along)))
        screwed_ends.add((axis, round(float(one[axis]), 6), *(np.round(out, 3) if axis < 2 else ())))
    bare, ends = pieces.ends
    assert len(screwed_ends) == ends - bare
    whole = replace(solid, segments=pieces)
    entry = solidbowl.document(whole)
    assert (entry["seam_ends"], entry["seam_ends_without_screw"]) == (ends, bare)
    words = f"join: {bare} of {ends} ends of seams"
    assert bool(bare) == any(line.startswith(words) for line in whole.remarks)


def test_a_bowl_weighs_what_it_does_with_its_lugs_and_screws_which_are_on_its_papers():
    solid, pieces, _ = cut("cylinder")
    whole = replace(solid, segments=pieces)
    heavy, density = screwed(whole, segments.WEIGHT), solid.plan.material.density
    joined, at = mass.integrate_solid(pieces.joined[0][pieces.joined[1]]), pieces.screws
    bare = joined.volume * density
    total = bare + 1.5e-3 * len(at)
    assert heavy.mass == pytest.approx(total, rel=1e-12) and heavy.mass > 1.01 * solid.mass
    np.testing.assert_allclose(heavy.centre, (bare * joined.centre + 1.5e-3 * at.sum(axis=0)) / total)
    turning = mass.shift_inertia(joined.inertia * density, bare, joined.centre)[2, 2]
    about = turning + 1.5e-3 * (at[:, :2] ** 2).sum()
    assert heavy.inertia == pytest.approx(about, rel=1e-9) and heavy.volume == solid.volume
    plain = replace(solid, segments=segments.segments(solid, BED))
    assert screwed(plain, 1.0).mass == pytest.approx(solid.mass, abs=0)
    entry, none = solidbowl.document(whole), solidbowl.document(plain)
    assert entry["screws"] == len(at) > 0 and entry["screw"] == "M3 x 16"
    assert none["screws"] == 0 and none["screw"] is None
    words = bowl_sheet.draw_sheets(study(whole)).texts(0)
    assert "screws ISO 4762 M3 x 16 with nuts ISO 4032, in lugs of the segments; floor: dowels" in words
    assert any(f"{1e9 * joined.volume:.6g} mm³" in one for one in words)
    assert joined.volume > 1.005 * solid.volume


def test_a_bowl_that_fits_whole_has_no_lugs_and_a_wall_without_room_is_said(monkeypatch):
    pieces = segments.segments(built(), (1.0, 1.0, 1.0), segments.SCREWS)
    assert len(pieces.pieces) == 1 and len(pieces.screws) == 0 and pieces.joined is None
    monkeypatch.setattr(segments, "LUG_CLEARANCE_M", 1.0)
    with pytest.raises(FeederError) as fault:
        segments.segments(built(), (0.2, 0.2, 0.2), segments.SCREWS)
    assert str(fault.value) == "join: no lug for a screw has room at the seams - take dowels"
