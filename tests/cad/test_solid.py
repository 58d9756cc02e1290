"""The bowl as a solid: closed, one body, of its plan's sizes, with its tooling in it."""

import io
import shutil
import subprocess
import zipfile
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from manifold3d import Manifold
from solids import (
    CHAINS,
    CONICAL,
    NEAR,
    PLAIN,
    RAILS,
    STEEP,
    STEPPED,
    TRACK,
    built,
    closed,
    cuboid,
    device,
    is_one_body,
    outward,
    planned,
    rider,
    slanted,
)

from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.air_assist import AirAssist
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.cad import facets, riding, segments
from feederscrew.cad.closed_body import body
from feederscrew.cad.measuring import measures, track_heights, track_width, ways_down
from feederscrew.cad.plan import SolidOptions
from feederscrew.output import solid_files
from feederscrew.sorting import whole_surface


@pytest.mark.parametrize(
    ("chain", "name"), [*((one, "steel") for one in CHAINS), ("gap", "pla"), ("gap", "pa12")]
)
def test_one_closed_body_of_its_material(chain, name):
    solid = built(chain, name=name)
    is_one_body(solid)
    sizes, own = measures(solid), solid.plan.material
    assert (sizes.wall, sizes.floor) == pytest.approx((own.wall, own.floor), abs=NEAR)
    assert solid.mass == pytest.approx(solid.volume * own.density) or solid.gates  # they add to it


@pytest.mark.parametrize("bank", [0.0, 20.0])
def test_height_and_width_of_the_track_are_those_of_the_formula(bank, rng):
    solid = built(track=replace(TRACK, bank=np.radians(bank), climb=np.radians(4.0)))
    plan, whole = solid.plan, facets.unplaced(solid)
    s, y = rng.uniform(0.02, plan.path.end, 200), rng.uniform(2e-4, TRACK.width - 3e-4, 200)
    heights = np.array([track_heights(plan, whole, *one) for one in zip(s, y)])
    formula = np.tan(plan.path.climb) * s + y * np.sin(plan.path.bank)
    np.testing.assert_allclose(heights, formula, rtol=0, atol=NEAR)
    np.testing.assert_allclose(plan.path.height(s, y), formula, rtol=0, atol=1e-12)
    widths = [track_width(plan, whole, one) for one in s[(s > 0.1) & (s < plan.path.end - 0.05)]]
    np.testing.assert_allclose(widths, TRACK.width, rtol=0, atol=NEAR)


def test_a_separation_leads_the_track_down_from_its_place_on():
    chain = (slanted("spacing section", -5.0, "{{climb: {} deg}}"), *CHAINS["gap"])
    solid = body(planned(chain))
    is_one_body(solid)
    plan, whole = solid.plan, facets.unplaced(solid)
    ((bend, climb),) = plan.path.bends
    top = np.tan(TRACK.climb) * bend
    assert plan.first < bend < plan.path.end and climb == np.radians(-5.0)
    for s in np.linspace(0.3 * bend, plan.path.end - 2e-3, 60):
        formula = np.tan(TRACK.climb) * s if s < bend else top - np.tan(np.radians(5.0)) * (s - bend)
        cuts = [cut for _, cut in plan.stretch.openings]
        in_gap = any(cut.begin - 1e-3 < s - plan.first < cut.end + 1e-3 for cut in cuts)
        assert in_gap or track_heights(plan, whole, s, 15e-3) == pytest.approx(formula, abs=NEAR)
    assert measures(solid).outlet_height == pytest.approx(plan.outlet_height, abs=NEAR)
    assert plan.top > top + 12e-3 and plan.outlet_height < top
    low = planned(chain, asked=SolidOptions(outlet_height=0.04))
    assert low.outlet_height == pytest.approx(0.04, abs=1e-9)
    with pytest.raises(FeederError, match=r"^devices: a device leads the track down to .* over the floor"):
        planned(chain, asked=SolidOptions(outlet_height=0.005))


def test_a_drop_leads_no_track_below_the_floor():
    """A track that rises little: behind a ledge of 10 mm the outlet of such a bowl lay below its floor."""
    chain = (make_device("tipping ledge", "ledge 7 mm", limit=7e-3),)
    with pytest.raises(FeederError, match=r"^devices: a device leads the track down to .* over the floor"):
        planned(chain, replace(TRACK, climb=np.radians(0.5)))
    assert planned(chain).outlet_height > 0.02


def test_a_cut_is_as_large_as_its_device_says_and_rails_are_open_at_their_end():
    solid = built("canyon, slot")
    plan, whole = solid.plan, facets.unplaced(solid)
    for (_, cut), (low, high) in zip(plan.stretch.openings, ((-1.0, 6e-3), (8e-3, 12e-3))):
        s = plan.first + 0.5 * (cut.begin + cut.end)
        for y in np.linspace(3e-4, TRACK.width - 3e-4, 60):
            if min(abs(y - low), abs(y - high)) > NEAR:
                on_track = track_heights(plan, whole, s, y) > plan.path.height(s, y) - 1e-3
                assert on_track == (not low < y < high)
    plan = planned((RAILS,))
    whole = facets.unplaced(body(plan))
    for s in np.linspace(
        plan.first + plan.stretch.openings[0][1].begin + 1e-3, plan.path.end + plan.outlet, 40
    ):
        place = plan.path.places(s, 5e-3)
        met = facets.below(whole, place)
        assert met is None or met < place[2] - plan.material.plate - plan.hanging + 1e-9


def test_a_left_hand_is_the_mirror_image_and_a_weight_balances_it():
    right, left = (built("gap", asked=SolidOptions(left=hand)) for hand in (False, True))
    assert closed(left) == pytest.approx(closed(right), rel=1e-6)  # corners within 2e-3 mm become one
    np.testing.assert_allclose(left.centre * [1, -1, 1], right.centre, rtol=0, atol=1e-8)
    # The weight that balances it brings its centre over the axis.
    weight, angle = right.balance
    moment = right.mass * right.centre[:2] + weight * right.balanced_at * outward(angle)[:2]
    np.testing.assert_allclose(moment, 0.0, rtol=0, atol=1e-12)
    assert 0.01 < weight / right.mass < 0.1


@pytest.mark.parametrize(
    ("sweep", "y", "near"), [(None, 5e-3, 0.1e-3), (50.0, 2e-3, 0.25e-3), (50.0, 18e-3, 0.25e-3)]
)
def test_a_blade_keeps_its_clearance_and_leans_ahead_where_it_is_swept(sweep, y, near):
    own = {} if sweep is None else {"sweep": np.radians(sweep)}
    plan = planned((device("wiper", limit=6e-3, **own),))
    solid, (ring,) = body(plan), plan.stretch.devices[0].footprints
    assert closed(solid) > 0.0
    # from the axis: its face, 1 / tan(sweep) ahead over inwards, seen in the bowl
    theta = (ring[0, 0] - plan.stretch.devices[0].begin) / 0.15
    assert theta == pytest.approx(0.5 * 1.3 * 18e-3 / 0.15)
    across = shapely.Polygon(ring).intersection(shapely.LineString([(-1.0, y), (1.0, y)]))
    at = plan.path.places(plan.first + across.centroid.x, y)
    hits = facets.first_met(facets.unplaced(solid), at + [0, 0, 1e-3], at + [0, 0, 0.05])
    assert hits[0] + 1e-3 == pytest.approx(6e-3, abs=near)


@pytest.mark.parametrize("asked", [replace(PLAIN, left=True), replace(STEPPED, left=True)])
def test_a_nozzle_is_a_hole_through_the_wall(asked):
    solid = built("jets", STEEP, asked)
    plan, whole = solid.plan, facets.unplaced(solid)
    bores = [
        (item.begin + jet.at[0], jet.at[2]) for item in plan.stretch.devices for jet in item.features.jets
    ]
    assert [height for _, height in bores] == [1e-3, 8e-3]
    # square to the track: on a climb a higher one lies further back
    s = plan.first + bores[1][0] - 8e-3 * np.sin(plan.path.climb)
    theta = float(plan.path.angle(s))
    out, ahead = outward(theta), outward(theta + 0.5 * np.pi)
    for off, walls in ((0.9e-3, 0), (1.1e-3, 2)):
        for turn in np.linspace(0.1, 2.0 * np.pi, 12):
            beside = off * (np.cos(turn) * ahead + [0.0, 0.0, np.sin(turn)])
            start = plan.path.places(s, 2e-3) + [0.0, 0.0, 8e-3 / np.cos(plan.path.climb)] + beside
            assert len(facets.first_met(whole, start, start + 0.02 * out)) == walls


def test_a_nozzle_at_a_blade_is_drilled_askew_along_its_face():
    """From the bowl along the jet's axis nothing is met to beyond the wall; beside it the wall is."""
    air = AirAssist(2e-3, 3e4, 9e-3)
    plan = planned((device("wiper", limit=6e-3, sweep=np.radians(30.0), air=air),))
    (placed,) = plan.stretch.devices
    (jet,) = placed.features.jets
    whole, s = facets.unplaced(body(plan)), plan.first + placed.begin + jet.place
    assert np.degrees(jet.angle) == pytest.approx(41.0)
    height = 9e-3 * np.sin(plan.path.climb)  # square to the track: on a climb it lies further back
    theta = float(plan.path.angle(s - height))
    rise = [0.0, 0.0, np.tan(plan.path.climb)]
    ahead, inwards = (outward(theta + 0.5 * np.pi) + rise) * np.cos(plan.path.climb), -outward(theta)
    into = np.cos(jet.angle) * ahead + np.sin(jet.angle) * inwards
    across = np.cross(into, [0.0, 0.0, 1.0])
    mouth = plan.path.places(s - height, 0.0) + [0.0, 0.0, 9e-3 / np.cos(plan.path.climb)]
    for off, walls in ((0.85e-3, 0), (1.15e-3, 2)):
        for turn in np.linspace(0.1, 2.0 * np.pi, 12):
            beside = off * (np.cos(turn) * across + [0.0, 0.0, np.sin(turn)])
            start = mouth + 1.5e-3 * into + beside
            assert len(facets.first_met(whole, start, start - 0.02 * into)) == walls


def test_a_part_on_the_track_has_its_foot_on_it_and_its_side_on_the_wall(rng):
    """A box of 14 x 8 x 6 mm: its ends touch the wall, 0.16 mm of sagitta before its middle."""
    plan, whole = built().plan, facets.unplaced(built())
    middle = TRACK.radius - np.sqrt(TRACK.radius**2 - 7e-3**2) + 4e-3
    for s in rng.uniform(0.05, plan.path.end - 0.02, 50):
        points = riding.place_rider(plan, rider(middle, 3e-3), cuboid([7e-3, 4e-3, 3e-3]), s)
        to_wall = TRACK.radius - np.hypot(*points[:, :2].T)
        assert -6e-5 < to_wall.min() < 1.2e-4
        feet = points[points[:, 2].argsort()[:4]] * [0.998, 0.998, 1.0]  # not into the wall
        gaps = [one[2] - facets.below(whole, one + [0, 0, 4e-3]) for one in feet]
        assert max(np.abs(gaps)) < 6e-5
    # One that hangs stays where its rails hold it.
    plan = planned((RAILS,))
    s = plan.path.end - 0.03
    (middle,) = riding.place_rider(plan, rider(5e-3, -4e-3), np.zeros((1, 3)), s)
    off = middle - plan.path.places(s, 5e-3)
    assert np.hypot(*off[:2]) < 4e-4 and off[2] == pytest.approx(-4e-3, abs=2e-5)


TURNS = np.linspace(0.0, 2.0 * np.pi, 49)[:-1]
ROD = 5e-3 * np.array([[x, np.cos(t), np.sin(t)] for x in (-1.4, 1.4) for t in TURNS])


@pytest.mark.parametrize(
    ("bank", "shape", "corners"),
    [
        (12.0, STEPPED, cuboid([7e-3, 4e-3, 5e-3])),
        (0.0, CONICAL, ROD),  # the wall touches it above its foot
    ],
)
def test_a_part_touches_the_wall_where_the_track_is_banked_or_the_wall_leans(bank, shape, corners, rng):
    """It lay 1.9 mm in the wall: its distance is that of the track seen from above."""
    asked = replace(shape, left=True, outlet_angle=0.3)
    solid = built(track=replace(STEEP, bank=np.radians(bank)), asked=asked, turns=1.9)
    plan, whole = solid.plan, facets.unplaced(solid)
    for s in rng.uniform(0.06, plan.path.end - 0.02, 12):
        off = []
        for one in facets.as_planned(plan, riding.place_rider(plan, rider(4.1e-3, 5e-3), corners, s)):
            out = outward(one)
            start = one - 5e-4 * out + [0.0, 0.0, 3e-4]  # not along the track
            off.append(facets.first_met(whole, start, start + 0.1 * out)[0] - 5e-4)
        lifted = 3e-4 * float(riding.leaning(plan, s))
        assert min(off) == pytest.approx(0.5 * lifted, abs=6e-5 + 0.6 * lifted)


def test_gates_are_parts_of_their_own():
    solid = built("gate")
    ((name, vertices, faces),) = solid.gates
    assert name == "gate_1"
    gate = facets.placed(SimpleNamespace(vertices=vertices, faces=faces))
    assert (gate ^ facets.placed(solid)).volume() < 20.0  # [mm3] it stands on the track and in its notch
    archive = zipfile.ZipFile(io.BytesIO(solid_files.bowl_3mf(solid, "bowl")))
    assert b"gate_1" in archive.read("3D/3dmodel.model")


@pytest.mark.needs("prusa-slicer")
def test_a_slicer_takes_it_without_repair(tmp_path):
    solid = built("narrowed and rails", name="pla")
    files = {"bowl.stl": solid_files.bowl_stl(solid), "bowl.3mf": solid_files.bowl_3mf(solid, "bowl")}
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
        call = [shutil.which("prusa-slicer"), "--info", name]
        text = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True).stdout
        values = dict(line.split(" = ") for line in text.splitlines() if " = " in line)
        assert values["manifold"].strip() == "yes" and values["number_of_parts"].strip() == "1"
        assert "repaired" not in text
        assert float(values["volume"]) == pytest.approx(solid.volume * 1e9, rel=1e-4)


@pytest.mark.parametrize(
    ("bed", "least"), [("220x220x250mm", 4), ("220 mm x 220 mm x 60 mm", 8), ("1x1x1m", 1)]
)
def test_segments_fit_the_bed_and_make_up_the_bowl(bed, least):
    solid, size = built("gap", asked=SolidOptions(left=True, outlet_angle=0.4), name="pla"), segments.bed(bed)
    cut = segments.segments(solid, size)
    assert len(cut.pieces) >= least and (cut.dowels > 0) == (least > 1)
    for one in cut.pieces:
        assert all(np.array(one.size) <= np.array(size) + 1e-6)
        assert closed(one, near=1e-5) == pytest.approx(one.volume * 1e9, rel=1e-4)
    drilled = cut.dowels * np.pi * (0.5 * cut.dowel) ** 2 * cut.dowel_length
    assert sum(one.volume for one in cut.pieces) == pytest.approx(solid.volume - drilled, rel=1e-4)


def test_no_dowel_lies_below_a_cut():
    solid = built("gap", name="pla")
    pieces, plan = segments.segments(solid, (0.09, 0.09, 0.25)), solid.plan
    ring = shapely.LinearRing(np.array(plan.stretch.openings[0][1].ring) + [plan.first, 0.0])
    cut = shapely.Polygon(plan.path.plan(*shapely.get_coordinates(ring.segmentize(1e-3)).T))
    c, s = np.cos(pieces.turned), np.sin(pieces.turned)
    there = shapely.points(pieces.places[:, :2] @ np.array([[c, s], [-s, c]]))
    assert pieces.dowels > 50 and cut.distance(there).min() > pieces.dowel


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("220x220mm", "bed: '220x220mm' is not three lengths - write 220x220x250mm"),
        ("0x220x250mm", "bed: '0x220x250mm' has a side of 0 or less - write 220x220x250mm"),
        ("220x220x250", "bed: '220' has no unit - write 220 mm"),
        ("40x200x200mm", "bed: 40 x 200 x 200 mm takes more than 6 segments in one direction"),
    ],
)
def test_beds_that_are_none(text, line):
    with pytest.raises(FeederError) as fault:
        segments.segments(built(), segments.bed(text))
    assert str(fault.value).startswith(line)


# In closed form: a bowl of 300 mm, a track of 20 mm that climbs at 3.5 deg, a gap of 9 mm between parallel
# edges, and a part of which 18 x 14 mm set its size. Room for 0.6 of that to either side of a device; 10 mm
# behind.
RISE, ROUND, SIZE = np.tan(np.radians(3.5)), 2.0 * np.pi * 150.0, np.hypot(18.0, 14.0)  # [1], [mm]
GAP_LENGTH = 150.0 * np.arcsin(9.0 / 130.0)  # at the wall, of 9 mm at the free edge
NEEDED = 1.2 * SIZE + GAP_LENGTH + 10.0
HIGHEST = RISE * (
    ROUND + NEEDED - (0.6 * SIZE + GAP_LENGTH)
)  # the turn below begins where the last part fell
# a quarter turn over the dome of 3 deg: its plate of 3 mm seen by 0.3, and 0.3 mm more
LOWEST = 0.25 * ROUND * RISE + 0.3 * 3.0 + 20.0 * np.tan(np.radians(3.0)) + 0.3
# A stepped wall: its radius shrinks by 21 mm a turn, along a spiral of s / flare
FLARE = -np.log(1.0 - 21.0 / 150.0) / (2.0 * np.pi)
PITCH = 21.0 / FLARE  # [mm] of a turn along the wall
# the part on end, 5 mm, a slope of 40 deg, three plates
STEPPED_NEEDS = 18.0 + 5.0 + 21.0 * np.tan(np.radians(40.0)) + 3.0 * 3.0
LEAST_STEPPED = np.ceil(10.0 * np.degrees(np.arctan(STEPPED_NEEDS / PITCH))) / 10.0
SMALLEST_FLOOR = 0.5 * 150.0 / FLARE * np.tan(np.radians(4.5))  # half the radius is left to the floor
# along a spiral the quarter turn is shorter
LOWEST_STEPPED = (
    150.0 / FLARE * (1.0 - np.exp(-FLARE * 0.5 * np.pi)) * np.tan(np.radians(4.5))
    + 0.3 * 3.0 + 20.0 * np.tan(np.radians(3.0)) + 0.3
)  # fmt: skip


@pytest.mark.parametrize(
    ("track", "asked", "chain", "line"),
    [
        ({"width": 0.14}, {}, "none", "track.width: 140 mm is too wide for a bowl of 300 mm - give at most "
         "112.5 mm, or a larger track.radius"),
        ({"climb": 0.0}, {}, "none", "track.climb: 0 deg does not lead a track out of the bowl - give a "
         "climb, as 3.5 deg, or leave it out"),
        ({}, {"bolt_circle": 0.25}, "none", "machine.bolt_circle: 250 mm lies under the track of a bowl "
         "this small - give at most 220 mm, or smaller bolts"),
        ({"width": 0.1}, {"bolt": 25e-3}, "none", "machine.bolt_circle: 120 mm lies under the track of a "
         "bowl this small - give a smaller machine.bolt_hole, or a larger bowl"),
        ({}, {"bolts": 12, "bolt_circle": 0.04}, "none", "machine.bolts: 12 and one in the middle, of 9 "
         "mm, leave no metal between them on a circle of 40 mm - take fewer, a smaller machine.bolt_hole, "
         "or a larger bowl"),
        ({}, {"drains": 8, "drain": 12e-3}, "none", "sizing.drain_hole: 12 mm may let parts through that "
         "are 12 mm thick - give less than 12 mm"),
        ({}, {"outlet_height": 0.09}, "gap", "sizing.outlet_height: 90 mm puts a turn of the track below "
         f"the cuts: what falls stays on it - give at most {HIGHEST:.4g} mm"),
        ({}, {"outlet_height": 0.0025}, "gap", f"sizing.outlet_height: 2.5 mm leaves {2.5 / RISE:.4g} mm of "
         f"track, and the devices take {NEEDED:.4g} mm - give at least {LOWEST:.4g} mm"),
        ({}, {"outlet_height": 0.01}, "gap", f"sizing.outlet_height: 10 mm leaves {10.0 / RISE:.4g} mm of "
         f"track, less than a quarter turn - give at least {LOWEST:.4g} mm"),
        ({"climb": np.radians(2.5)}, {"shape": "stepped"}, "none", "track.climb: a turn rises "
         f"{PITCH * np.tan(np.radians(2.5)):.4g} mm, and a stepped wall needs {STEPPED_NEEDS:.4g} mm - give "
         f"{LEAST_STEPPED:.4g} deg, or sizing.shape: cylinder"),
        ({}, {"shape": "conical"}, "gap", "sizing.shape: conical leans outwards, and devices are computed "
         "by an upright wall - take stepped"),
        ({"climb": np.radians(4.5)}, {"shape": "stepped", "outlet_height": 0.4}, "none", ""
         "sizing.outlet_height: leaves too small a floor: the wall steps outwards with the track - give at "
         f"most {SMALLEST_FLOOR:.4g} mm, or a larger bowl"),
    ],
)  # fmt: skip
def test_faults(track, asked, chain, line):
    with pytest.raises(FeederError) as fault:
        planned(CHAINS[chain], track=replace(TRACK, **track), asked=SolidOptions(**asked))
    assert str(fault.value) == line


@pytest.mark.parametrize(
    ("shape", "climb", "least"),
    # as the message rounds it up
    [(PLAIN, 3.5, round(LOWEST + 5e-3, 2) * 1e-3), (STEPPED, 4.5, round(LOWEST_STEPPED + 5e-3, 2) * 1e-3)],
)
def test_the_lowest_outlet_that_is_named_has_a_width_to_measure(shape, climb, least):
    own = replace(TRACK, climb=np.radians(climb))
    sizes = measures(built(track=own, asked=replace(shape, outlet_height=least)))
    assert (sizes.track_width, sizes.outlet_height) == pytest.approx((0.02, least), abs=NEAR)
    with pytest.raises(FeederError, match=r"^sizing\.depth: it leaves .* less than a quarter turn - give a"):
        planned(track=own, asked=shape, turns=0.2)


def test_a_turn_below_a_cut_is_found_and_a_track_that_was_shortened_says_so():
    plan = planned(CHAINS["gap"])
    longer = replace(plan, path=replace(plan.path, end=plan.path.end + 0.3), first=plan.first + 0.3)
    with pytest.raises(FeederError, match="meets the track at"):
        ways_down(body(longer))
    (line,) = replace(built("gap"), turns_of_sheet=1.5).remarks
    assert line.startswith("sizing.outlet_height: 1.03 turns in place of 1.5, or what falls through a cut")
    assert built().remarks == ()
    # What a blade behind rails sweeps off crosses their slot: no turn of the track lies below it either.
    rails, swept = (planned(CHAINS[chain]).stretch for chain in ("narrowed and rails", "rails and wiper"))
    (blade,) = (placed for placed in swept.devices if placed.features.blades)
    assert swept.falls == pytest.approx(blade.begin + blade.features.length)
    assert rails.falls < rails.length and swept.falls < swept.length
    assert ways_down(built("rails and wiper")) == {"rails": "the floor"}
    # what hangs only goes on past a device without a blade
    jet = device("air jet", nozzle=2e-3, pressure=2e4, height=8e-3)
    blown = planned((*CHAINS["narrowed and rails"], jet)).stretch
    assert blown.falls == pytest.approx(rails.falls) and blown.length > rails.length
    # The outlet lies where it is wanted.
    plan = planned(asked=SolidOptions(outlet_height=0.04, outlet_angle=0.7))
    turned, straight = body(plan), body(replace(plan, turned=0.0))
    assert measures(turned).outlet_height == pytest.approx(0.04, abs=NEAR)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(turned.centre, turn @ straight.centre, rtol=0, atol=1e-8)
    for chord in (2e-4, 5e-5, 1e-5):  # arcs keep within the chord
        plan = planned(asked=SolidOptions(chord=chord))
        assert plan.path.radius * (1.0 - np.cos(np.pi / plan.segments)) <= chord


def cube(*at):
    return Manifold.cube((10.0, 10.0, 10.0)).translate(at)


@pytest.mark.parametrize(
    ("place", "volume", "corners"),
    [
        ((10.0, 10.0, 0.0), 2000.0, None),  # in an edge
        ((10.0, 10.0, 5.0), 2000.0, None),  # in half an edge
        ((10.0, 10.0, 10.0), 2000.0, None),  # in a corner
        ((10.00005, 10.00005, 0.0), 2000.0, None),  # almost
        ((10.0, 0.0, 0.0), 2000.0, None),  # in a face: one body
        ((5.0, 1.5e-8, 5.0), 750.0, None),  # cut off it: single precision tells 1e-8 mm from 0
        ((5.0, 5.0, 5.0), 1000.0, 8),  # a film of air is filled
    ],
)
def test_bodies_that_touch_share_no_edge(place, volume, corners):
    whole, other = cube(0.0, 0.0, 0.0), cube(*place)
    if corners == 8:
        other = Manifold.cube((1.0, 1.0, 1e-2)).translate(place)
    vertices, faces = whole_surface.mesh(whole + other if volume > 1000.0 else whole - other)
    surface = SimpleNamespace(vertices=vertices, faces=faces)
    assert closed(surface) == pytest.approx(volume, rel=1e-3)
    assert corners is None or len(surface.vertices) == corners


def test_tips_in_one_place_part_each_into_its_own_body():
    upper = np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 9.0], [0.0, 9.0, 9.0], [-9.0, -9.0, 9.0]])
    points = np.concatenate([upper, -upper]) + [5.0, 5.0, -20.0]
    faces = np.array([(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)])
    parted, _ = whole_surface.close_surface(points, np.concatenate([faces, faces[:, ::-1] + 4]))
    assert parted[[0, 4], 2] - points[[0, 4], 2] == pytest.approx([1e-3, -1e-3], rel=0.01)


@pytest.mark.parametrize("seed", range(2))
def test_rails_behind_a_narrowed_track_of_the_same_edge(seed):
    """The narrowed track ends where the slot does: their faces meet in an edge of the outlet's side."""
    rng = np.random.default_rng(seed)
    radius, width = float(rng.uniform(0.13, 0.17)), round(float(rng.uniform(24e-3, 28e-3)), 4)
    limit, left = round(0.4 * width, 4), bool(rng.integers(2))
    rails = device("rails", span=(round(0.1 * width, 4), limit))
    chain, track = (device("narrowed track", limit=limit, text="x"), rails), replace(TRACK, radius=radius)
    assert closed(body(planned(chain, replace(track, width=width), SolidOptions(left=left)))) > 0.0
