"""The bowl as a solid: closed, one body, of its plan's sizes, with its tooling in it."""

import shutil
import subprocess
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from scipy.spatial import cKDTree

from feederscrew import bowl as bowls
from feederscrew.bowl.reading import effective, record
from feederscrew.bowl.record import Track
from feederscrew.errors import FeederError
from feederscrew.machine.drive_sizing import machine_for
from feederscrew.machine.sizing import Size
from feederscrew.machine.springs import analyse_springs, centred_mass, rocking
from feederscrew.output import solid_files
from feederscrew.solidbowl import cuts, facets, riding, segments
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.measuring import measures, track_heights, track_width, ways_down
from feederscrew.solidbowl.plan import SolidOptions, material, plan
from feederscrew.tooling.devices.kinds import make_device as device_of

RULES = record(effective({})).sizing
TRACK = Track(climb=np.radians(3.5), bank=0.0, radius=0.15, width=0.02)
NEAR = 5e-5  # [m]
RAILS = device_of("rails", "b", span=(3e-3, 7e-3))
GAP = device_of("gap", "b", limit=9e-3)
CHAINS = {
    "none": (),
    "narrowed and rails": (device_of("narrowed_track", "b", limit=9e-3, text="9 mm"), RAILS),
    "gap": (GAP,),
    "canyon, slot": (device_of("canyon", "b", limit=6e-3), device_of("slot", "b", span=(8e-3, 12e-3))),
    "cut out": (device_of("cut_out", "b", corners=((0.0, 0.0), (9e-3, 0.0), (9e-3, 8e-3))),),
    "blades": (device_of("wiper", "b", limit=6e-3), device_of("hold_down", "b", limit=8e-3)),
    "gate": (device_of("profile", "b", corners=((0.0, 0.0), (9e-3, 0.0), (9e-3, 5e-3), (0.0, 7e-3))),),
    "jets": (*(device_of("jet", "b", nozzle=2e-3, pressure=2e4, height=z) for z in (1e-3, 8e-3)), GAP),
    "step": (device_of("step", "b", limit=4e-3), device_of("gap", "b", limit=5e-3)),
}


class One(SimpleNamespace):
    __hash__ = object.__hash__  # what devices compute of an orientation is kept


def planned(devices=(), track=TRACK, asked=None, name="steel", turns=1.5):
    asked = SolidOptions() if asked is None else asked
    one = One(length=18e-3, height=12e-3, width=14e-3, track=track, size=np.hypot(18e-3, 14e-3))
    pitch = 2.0 * np.pi * track.radius * np.tan(track.climb)
    size = Size(2.0 * track.radius, {}, track.width, 0.0, 0.0, track.climb, turns * pitch, turns, pitch)
    tooled = cuts.stretch(track, devices, [one]) if devices else None
    return plan(size, track, material(name, RULES), tooled, asked, extents=(18e-3, 14e-3, 12e-3))


def closed(solid, near=1e-4):
    """The volume of a surface in which each edge has two facets that run opposite ways, and one piece."""
    faces = solid.faces
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert set(map(tuple, sides)) == set(map(tuple, sides[:, ::-1]))
    corners = (solid.vertices * 1e3).astype(np.float32).astype(float)[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert across.any(axis=1).all()
    points = np.unique((solid.vertices * 1e3).astype(np.float32), axis=0)
    assert not cKDTree(points).query_pairs(near)  # [mm] readers unite what lies nearer than 1e-5
    return float((corners[:, 0] * across).sum()) / 6.0


@pytest.mark.parametrize("name", CHAINS)
def test_one_closed_body(name):
    solid = body(planned(CHAINS[name]))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    assert facets.placed(solid).decompose().__len__() == 1
    ways_down(solid)


@pytest.mark.parametrize("name", ["pla", "pa12"])
def test_of_other_material(name):
    solid = body(planned(CHAINS["gap"], name=name))
    assert closed(solid) > 0.0
    found = measures(solid)
    assert found.wall == pytest.approx(solid.plan.material.wall, abs=NEAR)
    assert found.floor == pytest.approx(solid.plan.material.floor, abs=NEAR)
    assert solid.mass == pytest.approx(solid.volume * solid.plan.material.density)


@pytest.mark.parametrize("bank", [0.0, 20.0])
def test_height_and_width_of_the_track_are_those_of_the_formula(bank, rng):
    solid = body(planned(track=replace(TRACK, bank=np.radians(bank), climb=np.radians(4.0))))
    made, whole = solid.plan, facets.unplaced(solid)
    s = rng.uniform(0.02, made.path.end, 200)
    y = rng.uniform(2e-4, TRACK.width - 3e-4, 200)
    found = np.array([track_heights(made, whole, *one) for one in zip(s, y)])
    formula = np.tan(made.path.climb) * s + y * np.sin(made.path.bank)
    np.testing.assert_allclose(found, formula, rtol=0, atol=NEAR)
    np.testing.assert_allclose(made.path.height(s, y), formula, rtol=0, atol=1e-12)
    within = s[(s > 0.1) & (s < made.path.end - 0.05)]
    widths = np.array([track_width(made, whole, one) for one in within])
    np.testing.assert_allclose(widths, TRACK.width, rtol=0, atol=NEAR)


def test_a_separation_leads_the_track_down_from_its_place_on():
    chain = (device_of("separation", "b", angle=np.radians(-5.0), text="{climb: -5 deg}"), *CHAINS["gap"])
    solid = body(planned(chain))
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    plan, whole = solid.plan, facets.unplaced(solid)
    ((bend, climb),) = plan.path.bends
    top = np.tan(TRACK.climb) * bend
    assert plan.first < bend < plan.path.end and climb == np.radians(-5.0)
    for s in np.linspace(0.3 * bend, plan.path.end - 2e-3, 60):
        formula = np.tan(TRACK.climb) * s if s < bend else top - np.tan(np.radians(5.0)) * (s - bend)
        found = track_heights(plan, whole, s, 15e-3)
        in_gap = any(a - 1e-3 < s - plan.first < b + 1e-3 for a, b in (cut.span for cut in plan.stretch.cuts))
        assert in_gap or found == pytest.approx(formula, abs=NEAR)
    assert measures(solid).outlet_height == pytest.approx(plan.outlet_height, abs=NEAR)
    assert plan.top > top + 12e-3 and plan.outlet_height < top
    asked = planned(chain, asked=SolidOptions(outlet_height=0.04))
    assert asked.outlet_height == pytest.approx(0.04, abs=1e-9)
    with pytest.raises(FeederError, match=r"^devices: a device leads the track down to .* over the floor"):
        planned(chain, asked=SolidOptions(outlet_height=0.005))


def test_arcs_keep_within_the_chord():
    for chord in (2e-4, 5e-5, 1e-5):
        made = planned(asked=SolidOptions(chord=chord))
        assert made.path.radius * (1.0 - np.cos(np.pi / made.segments)) <= chord


def test_a_cut_is_as_large_as_its_device_says():
    whole = facets.unplaced(body(made := planned(CHAINS["canyon, slot"])))
    for cut, (low, high) in zip(made.stretch.cuts, ((-1.0, 6e-3), (8e-3, 12e-3))):
        s = made.first + 0.5 * sum(cut.span)
        for y in np.linspace(3e-4, TRACK.width - 3e-4, 60):
            if min(abs(y - low), abs(y - high)) > NEAR:
                on_track = track_heights(made, whole, s, y) > made.path.height(s, y) - 1e-3
                assert on_track == (not low < y < high)


def test_the_weight_that_balances_it_brings_its_centre_over_the_axis():
    solid = body(planned(CHAINS["gap"]))
    weight, angle = solid.balance
    at = solid.balanced_at * np.array([np.cos(angle), np.sin(angle)])
    np.testing.assert_allclose(solid.mass * solid.centre[:2] + weight * at, 0.0, rtol=0, atol=1e-12)
    assert 0.01 < weight / solid.mass < 0.1


@pytest.mark.parametrize("left", [False, True])
def test_the_springs_know_where_its_mass_lies(left, rng):
    """Against moments of points in the body; a left hand rocks as its mirror image does."""
    solid = body(planned(CHAINS["gap"], asked=SolidOptions(left=left)))
    size = Size(
        0.3, {}, 0.02, 0.0, 0.0, 0.06, 0.05, 1.5, 0.05,
        mass=solid.mass, inertia=solid.inertia, unbalance=solid.unbalance,
    )  # fmt: skip
    bowl = bowls.read(None, ())
    under = machine_for(bowl, size, set())
    assert under.unbalance == solid.unbalance and under.unbalance.turns == (-1.0 if left else 1.0)
    corners = solid.vertices[solid.faces] - [0.0, 0.0, solid.plan.underside]
    weights = np.linalg.det(corners) / 6.0 * solid.plan.material.density
    at = corners.sum(axis=1) / 4.0
    np.testing.assert_allclose(under.unbalance.moment, weights @ at, rtol=1e-9)
    second = np.einsum("t,tki,tkj->ij", weights, corners, corners)
    second = (
        second + np.einsum("t,ti,tj->ij", weights, 4.0 * at, 4.0 * at)
    ) / 20.0  # of tetrahedra from there
    yz, xz, xy = under.unbalance.products
    np.testing.assert_allclose([yz, xz, xy], [second[1, 2], second[0, 2], second[0, 1]], rtol=1e-6)
    about = np.trace(second) - np.diag(second)
    np.testing.assert_allclose([*under.unbalance.upright, solid.inertia], about, rtol=1e-9)
    assert analyse_springs(under).effective_mass < centred_mass(under)
    heavier = machine_for(replace(bowl, machine=replace(bowl.machine, bowl_mass=9.0)), size, {"bowl_mass"})
    np.testing.assert_allclose(heavier.unbalance.moment, 9.0 / solid.mass * (weights @ at), rtol=1e-9)
    as_is, balanced = rocking(under, 0.15, 0.05), rocking(under, 0.15, 0.05, solid.weight)
    assert 1.001 < balanced.greatest < as_is.greatest < 1.02
    mirrored = replace(
        under.unbalance,
        moment=tuple(np.multiply(under.unbalance.moment, [1, -1, 1])),
        products=tuple(np.multiply(under.unbalance.products, [-1, 1, -1])),
        turns=-under.unbalance.turns,
    )
    other = rocking(replace(under, unbalance=mirrored), 0.15, 0.05)
    assert other.angle == pytest.approx(2.0 * np.pi - as_is.angle)
    assert other.greatest == pytest.approx(as_is.greatest, rel=1e-12)


def test_a_left_hand_is_the_mirror_image():
    right, left = (body(planned(CHAINS["gap"], asked=SolidOptions(left=hand))) for hand in (False, True))
    assert closed(left) == pytest.approx(closed(right), rel=1e-6)  # corners within 2e-3 mm become one
    np.testing.assert_allclose(left.centre * [1, -1, 1], right.centre, rtol=0, atol=1e-8)


def test_a_swept_blade_leans_ahead_and_keeps_its_clearance():
    made = planned((device_of("wiper", "b", limit=6e-3, sweep=np.radians(50.0)),))
    solid, blade = body(made), made.stretch.blades[0]
    assert closed(solid) > 0.0
    assert blade.lean == pytest.approx(1.0 / np.tan(np.radians(50.0)), rel=1e-6)
    for y in (2e-3, 18e-3):
        at = made.path.places(made.first + blade.start + blade.lean * y + 0.5 * blade.thickness, y)
        hits = facets.first_met(facets.unplaced(solid), at + [0, 0, 1e-3], at + [0, 0, 0.05])
        assert hits[0] + 1e-3 == pytest.approx(6e-3, abs=0.25e-3)


@pytest.mark.parametrize("shape", ["cylinder", "stepped"])
def test_a_nozzle_is_a_hole_through_the_wall(shape):
    track, asked = replace(TRACK, climb=np.radians(4.5)), SolidOptions(shape=shape, left=True)
    solid = body(planned(CHAINS["jets"], track=track, asked=asked))
    plan, whole = solid.plan, facets.unplaced(solid)
    assert [bore.height for bore in plan.stretch.bores] == [1e-3, 8e-3]
    s = plan.first + plan.stretch.bores[1].place
    theta, turns = float(plan.path.angle(s)), np.linspace(0.1, 2.0 * np.pi, 12)
    out, ahead = np.array([np.cos(theta), np.sin(theta), 0.0]), np.array([-np.sin(theta), np.cos(theta), 0.0])
    for off, walls in ((0.9e-3, 0), (1.1e-3, 2)):
        for turn in turns:
            beside = off * (np.cos(turn) * ahead + [0.0, 0.0, np.sin(turn)])
            start = plan.path.places(s, 2e-3) + [0.0, 0.0, 8e-3] + beside
            assert len(facets.first_met(whole, start, start + 0.02 * out)) == walls


def test_a_part_on_the_track_has_its_foot_on_it_and_its_side_on_the_wall(rng):
    """A box of 14 x 8 x 6 mm: its ends touch the wall, 0.16 mm of sagitta before its middle."""
    made = planned()
    whole, half = facets.unplaced(body(made)), np.array([7e-3, 4e-3, 3e-3])
    corners = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    middle = TRACK.radius - np.sqrt(TRACK.radius**2 - half[0] ** 2) + half[1]
    box = SimpleNamespace(axes=np.eye(3), distance=middle, posture=SimpleNamespace(height=half[2]))
    for s in rng.uniform(0.05, made.path.end - 0.02, 50):
        points = riding.place_rider(made, box, corners, s)
        to_wall = TRACK.radius - np.hypot(*points[:, :2].T)
        assert -6e-5 < to_wall.min() < 1.2e-4
        feet = points[points[:, 2].argsort()[:4]] * [0.998, 0.998, 1.0]  # not into the wall
        gaps = [one[2] - facets.below(whole, one + [0, 0, 4e-3]) for one in feet]
        assert max(np.abs(gaps)) < 6e-5


@pytest.mark.parametrize(("bank", "shape"), [(12.0, "stepped"), (0.0, "conical")])
def test_a_part_touches_the_wall_where_the_track_is_banked_or_the_wall_leans(bank, shape, rng):
    """It lay 1.9 mm in the wall: its distance is that of the track seen from above."""
    own = replace(TRACK, bank=np.radians(bank), climb=np.radians(4.5))
    made = planned(track=own, asked=SolidOptions(shape=shape, left=True, outlet_angle=0.3), turns=1.9)
    solid, half = body(made), np.array([7e-3, 4e-3, 5e-3])
    whole = facets.unplaced(solid)
    corners = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    if shape == "conical":  # a rod: the wall touches it above its foot
        turn = np.linspace(0.0, 2.0 * np.pi, 49)[:-1]
        corners = 5e-3 * np.array([[x, np.cos(t), np.sin(t)] for x in (-1.4, 1.4) for t in turn])
    box = SimpleNamespace(axes=np.eye(3), distance=4.1e-3, posture=SimpleNamespace(height=half[2]))
    for s in rng.uniform(0.06, made.path.end - 0.02, 12):
        off = []
        for one in facets.as_planned(made, riding.place_rider(made, box, corners, s)):
            out = np.array([*one[:2], 0.0]) / np.hypot(*one[:2])
            start = one - 5e-4 * out + [0.0, 0.0, 3e-4]  # not along the track
            off.append(facets.first_met(whole, start, start + 0.1 * out)[0] - 5e-4)
        lifted = 3e-4 * float(riding.leaning(made, s))
        assert min(off) == pytest.approx(0.5 * lifted, abs=6e-5 + 0.6 * lifted)


def test_a_part_that_hangs_stays_where_its_rails_hold_it():
    made, half = planned((RAILS,)), np.array([3e-3, 2e-3, 9e-3])
    box = SimpleNamespace(axes=np.eye(3), distance=5e-3, posture=SimpleNamespace(height=-4e-3))
    s = made.path.end - 0.03
    (middle,) = riding.place_rider(made, box, np.zeros((1, 3)), s)
    foot = made.path.places(s, 5e-3)
    assert np.hypot(*(middle - foot)[:2]) < 4e-4 and half[0] > 0.0
    assert middle[2] - foot[2] == pytest.approx(-4e-3, abs=2e-5)


def test_gates_are_parts_of_their_own():
    solid = body(planned(CHAINS["gate"]))
    assert [name for name, _, _ in solid.gates] == ["gate_1"]
    gate = facets.placed(SimpleNamespace(vertices=solid.gates[0][1], faces=solid.gates[0][2]))
    assert (gate ^ facets.placed(solid)).volume() < 20.0  # [mm3] it stands on the track and in its notch
    assert b"gate_1" in model_of(solid_files.bowl_3mf(solid, "bowl"))


@pytest.mark.parametrize(
    ("bed", "least"), [("220x220x250mm", 4), ("220 mm x 220 mm x 60 mm", 8), ("1x1x1m", 1)]
)
def test_segments_fit_the_bed_and_make_up_the_bowl(bed, least):
    solid = body(planned(CHAINS["gap"], asked=SolidOptions(left=True, outlet_angle=0.4), name="pla"))
    size, found = segments.bed(bed), segments.segments(solid, segments.bed(bed))
    assert len(found.pieces) >= least
    for one in found.pieces:
        assert all(np.array(one.size) <= np.array(size) + 1e-6)
        assert closed(one, near=1e-5) == pytest.approx(one.volume * 1e9, rel=1e-4)
    drilled = found.dowels * np.pi * (0.5 * found.dowel) ** 2 * found.dowel_length
    whole = sum(one.volume for one in found.pieces)
    assert whole == pytest.approx(solid.volume - drilled, rel=1e-4)
    assert (found.dowels > 0) == (least > 1)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("220x220mm", "bed: '220x220mm' is not three lengths - write 220x220x250mm"),
        ("0x220x250mm", "bed: '0x220x250mm' has a side of 0 or less - write 220x220x250mm"),
        ("220x220x250", "bed: '220' has no unit - write 220 mm"),
    ],
)
def test_beds_that_are_none(text, line):
    with pytest.raises(FeederError) as fault:
        segments.bed(text)
    assert str(fault.value) == line


def test_a_bed_that_is_too_small():
    with pytest.raises(FeederError) as fault:
        segments.segments(body(planned()), (0.04, 0.2, 0.2))
    assert str(fault.value).startswith("bed: 40 x 200 x 200 mm takes more than 6 segments in one direction")


def model_of(data):
    import io
    import zipfile

    return zipfile.ZipFile(io.BytesIO(data)).read("3D/3dmodel.model")


@pytest.mark.parametrize(
    ("track", "asked", "devices", "line"),
    [
        (
            replace(TRACK, width=0.14), SolidOptions(), (),
            "track.width: 140 mm is too wide for a bowl of 300 mm - give at most 112.5 mm, or a larger "
            "track.radius",
        ),
        (
            replace(TRACK, climb=0.0), SolidOptions(), (),
            "track.climb: 0 deg does not lead a track out of the bowl - give a climb, as 3.5 deg, or leave "
            "it out",
        ),
        (
            TRACK, SolidOptions(bolt_circle=0.25), (),
            "machine.bolt_circle: 250 mm lies under the track of a bowl this small - give at most 220 mm, or "
            "smaller bolts",
        ),
        (
            replace(TRACK, width=0.1), SolidOptions(bolt=25e-3), (),
            "machine.bolt_circle: 120 mm lies under the track of a bowl this small - give a smaller "
            "machine.bolt_hole, or a larger bowl",
        ),
        (
            TRACK, SolidOptions(bolts=12, bolt_circle=0.04), (),
            "machine.bolts: 12 and one in the middle, of 9 mm, leave no metal between them on a circle of "
            "40 mm - take fewer, a smaller machine.bolt_hole, or a larger bowl",
        ),
        (
            TRACK, SolidOptions(bolts=1, bolt_circle=0.026), (),
            "machine.bolts: 1 and one in the middle, of 9 mm, leave no metal between them on a circle of "
            "26 mm - take fewer, a smaller machine.bolt_hole, or a larger bowl",
        ),
        (
            TRACK, SolidOptions(drains=8, drain=12e-3), (),
            "sizing.drain_hole: 12 mm may let parts through that are 12 mm thick - give less than 12 mm",
        ),
        (
            TRACK, SolidOptions(outlet_height=0.09), CHAINS["gap"],
            "sizing.outlet_height: 90 mm puts a turn of the track below the cuts: what falls stays on it - "
            "give at most 59.77 mm",
        ),
        (
            TRACK, SolidOptions(outlet_height=0.003), CHAINS["gap"],
            "sizing.outlet_height: 3 mm leaves 49.05 mm of track, and the devices take 56.8 mm - give at "
            "least 16.66 mm",
        ),
        (
            TRACK, SolidOptions(outlet_height=0.01), CHAINS["gap"],
            "sizing.outlet_height: 10 mm leaves 163.5 mm of track, less than a quarter turn - give at least "
            "16.66 mm",
        ),
        (
            TRACK, SolidOptions(outlet_height=1e-4), (),
            "sizing.outlet_height: 0.1 mm leaves 1.635 mm of track, less than a quarter turn - give at "
            "least 16.66 mm",
        ),
    ],
)  # fmt: skip
def test_faults(track, asked, devices, line):
    with pytest.raises(FeederError) as fault:
        planned(devices, track=track, asked=asked)
    assert str(fault.value) == line


@pytest.mark.parametrize(
    ("shape", "climb", "least"), [("cylinder", 3.5, 16.66e-3), ("stepped", 4.5, 20.45e-3)]
)
def test_the_lowest_outlet_that_is_told_has_a_width_to_measure(shape, climb, least):
    own, asked = replace(TRACK, climb=np.radians(climb)), SolidOptions(shape=shape, outlet_height=least)
    found = measures(body(planned(track=own, asked=asked)))
    assert found.track_width == pytest.approx(0.02, abs=NEAR)
    assert found.outlet_height == pytest.approx(least, abs=NEAR)
    with pytest.raises(FeederError, match=r"^sizing\.depth: it leaves .* less than a quarter turn - give a"):
        planned(track=own, asked=SolidOptions(shape=shape), turns=0.2)


def test_a_turn_below_a_cut_is_found():
    made = planned(CHAINS["gap"])
    longer = replace(made, path=replace(made.path, end=made.path.end + 0.3), first=made.first + 0.3)
    with pytest.raises(FeederError, match="meets the track at"):
        ways_down(body(longer))


def test_a_track_that_was_shortened_says_so():
    short = replace(body(planned(CHAINS["gap"], turns=1.5)), turns_of_sheet=1.5)
    assert short.remarks == (
        "sizing.outlet_height: 1.04 turns in place of 1.5, or what falls through a cut would stay on the "
        "turn below - sizing.shape: stepped has room for more",
    )
    assert body(planned()).remarks == ()


SLICER = shutil.which("prusa-slicer")


@pytest.mark.needs("prusa-slicer")
def test_a_slicer_takes_it_without_repair(tmp_path):
    solid = body(planned(CHAINS["narrowed and rails"], name="pla"))
    files = {"bowl.stl": solid_files.bowl_stl(solid), "bowl.3mf": solid_files.bowl_3mf(solid, "bowl")}
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
        told = subprocess.run([SLICER, "--info", name], cwd=tmp_path, capture_output=True, text=True).stdout
        found = dict(line.split(" = ") for line in told.splitlines() if " = " in line)
        assert found["manifold"].strip() == "yes" and found["number_of_parts"].strip() == "1"
        assert "repaired" not in told
        assert float(found["volume"]) == pytest.approx(solid.volume * 1e9, rel=1e-4)


def test_the_outlet_lies_where_it_is_asked():
    made = planned(asked=SolidOptions(outlet_height=0.04, outlet_angle=0.7))
    found = body(made)
    assert measures(found).outlet_height == pytest.approx(0.04, abs=NEAR)
    straight = body(replace(made, turned=0.0))
    c, s = np.cos(0.7), np.sin(0.7)
    x, y, z = straight.centre
    np.testing.assert_allclose(found.centre, [c * x - s * y, s * x + c * y, z], rtol=0, atol=1e-8)


def test_blades_leave_the_clearance_free():
    made = planned((device_of("wiper", "b", limit=6e-3),))
    whole, blade = facets.unplaced(body(made)), made.stretch.blades[0]
    s = made.first + blade.start + 0.5 * blade.thickness
    at = made.path.places(s, 5e-3)
    hits = facets.first_met(whole, at + [0, 0, 1e-3], at + [0, 0, 0.05])
    assert hits[0] + 1e-3 == pytest.approx(6e-3, abs=0.1e-3)


def test_rails_are_open_at_their_end():
    made = planned((RAILS,))
    whole = facets.unplaced(body(made))
    for s in np.linspace(made.first + made.stretch.cuts[0].span[0] + 1e-3, made.path.end + made.outlet, 40):
        place = made.path.places(s, 5e-3)
        met = facets.below(whole, place)
        assert met is None or met < place[2] - made.material.plate - made.hanging + 1e-9


def test_no_dowel_lies_below_a_cut():
    solid = body(planned(CHAINS["gap"], name="pla"))
    found, made = segments.segments(solid, (0.09, 0.09, 0.25)), solid.plan
    ring = np.array(made.stretch.cuts[0].ring) + [made.first, 0.0]
    cut = made.path.ring_in_bowl(ring, made.chord)
    c, s = np.cos(found.turned), np.sin(found.turned)
    x, y = found.places[:, 0], found.places[:, 1]
    there = shapely.points(np.column_stack([c * x - s * y, s * x + c * y]))
    assert found.dowels > 50 and cut.distance(there).min() > found.dowel
