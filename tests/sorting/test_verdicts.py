"""What each kind of device does with a part, against sums done by hand; its names, values and faults."""

from dataclasses import replace

import awkward
import ezdxf
import numpy as np
import pytest
import shapely
import shapes
from on_track import LEVEL, block, coming, device, lying, pick, read
from scipy.special import ndtr

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices import openings
from feederscrew.bowl.devices.base import UNSURE, room_of, share
from feederscrew.bowl.devices.blades import SQUARE_FACE_RAD
from feederscrew.bowl.devices.kinds import KINDS, find_kind
from feederscrew.bowl.devices.trade import Action
from feederscrew.sorting import footprints
from feederscrew.sorting.orientations import place
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

TRACK = "{radius: 100 m, width: 200 mm}"
BOWL = bowls.read(None, ["track.radius=100 m", "track.bank=0 deg", "track.width=40 mm"])
GRAVITY, STEEL = 9.80665, 7850.0
EVERY = lying(block())
ALONG, ACROSS = pick(EVERY, 20, 5), pick(EVERY, 12, 5)


@pytest.fixture
def written(tmp_path):
    """A device as a line of a bowl file has it."""
    return lambda line: read(tmp_path, line, track=TRACK).devices[0]


@pytest.mark.parametrize(
    ("line", "lengthwise", "crosswise"),
    [  # margins in mm
        ("wiper: 6 mm", 1.0, 1.0), ("height_bar: 4 mm", -1.0, -1.0), ("hold_down: 5.5 mm", 0.5, 0.5),
        ("pressure_break: 8 mm", 2.0, -2.0), ("narrowed_track: 8 mm", 2.0, -2.0), ("canyon: 8 mm", -2.0, 2.0),
        ("gap: 9 mm", 1.0, -3.0), ("slot: {from: 5 mm, to: 7 mm}", 6.0, 6.0),
        ("slot: {from: 0 mm, to: 8 mm}", -2.0, 2.0),
        ("cut_out: [[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 100 mm], [0 mm, 100 mm]]", 1.0, -3.0),
        ("profile: [[0 mm, 0 mm], [12.5 mm, 0 mm], [12.5 mm, 5.5 mm], [0 mm, 5.5 mm]]", 0.5, -7.5),
        (f"profile: {{of: {ALONG.aspect}@{np.degrees(ALONG.heading):.6g}, play: 0.2 mm}}", 0.2, -7.8),
    ],
)  # fmt: skip
def test_signed_margins_of_a_block(written, line, lengthwise, crosswise):
    for one, margin in ((ALONG, lengthwise), (ACROSS, crosswise)):
        judged = verdict(written(line), one, EVERY)
        assert 1e3 * judged.margin == pytest.approx(margin, abs=5e-3)
        assert judged.passes == float(margin > 0.0)


def test_every_kind_has_a_verdict_and_an_example_that_reads(tmp_path, written):
    ends = [kind for kind, one in KINDS.items() if one.action is Action.TWIST]  # rails end a chain as well
    kinds = [kind for kind in KINDS if kind not in ends]
    chain = read(tmp_path, *(f"{kind}: {KINDS[kind].trade.example}" for kind in kinds)).devices
    assert [one.kind for one in chain] == kinds
    chain += read(tmp_path, *(f"{kind}: {KINDS[kind].trade.example}" for kind in ends)).devices
    assert all(one.text == KINDS[one.kind].trade.example for one in chain)
    read(tmp_path, "wiper: 6 mm")
    settings = {one.key.name: one for one in bowls.settings(tmp_path / "bowl.yaml")}
    first = settings["devices.1"]
    assert (first.text, first.origin) == ("wiper: 6 mm", f"{tmp_path / 'bowl.yaml'}:2")
    # A cut out of a drawing.
    drawing, corners = ezdxf.new("R2010", units=4), [(0, 0), (9, 0), (9, 100), (0, 100)]
    drawing.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": "CUT"})
    drawing.saveas(tmp_path / "holes.dxf")
    cut = written("cut_out: {dxf: holes.dxf, layer: CUT}")
    assert np.array(cut.corners) == pytest.approx(1e-3 * np.array(corners, dtype=float))
    assert verdict(cut, ALONG, EVERY).margin == pytest.approx(1e-3, abs=5e-6)
    with pytest.raises(FeederError, match="no closed outline on layer 'GATE'"):
        written("cut_out: {dxf: holes.dxf, layer: GATE}")


LEAD_IN = "lead_in: {from: 3 mm, to: 9 mm, length: 9 mm, taper: 9 mm}"


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("gap: -1 mm", "2:10: gap is -1 mm - give more than 0 mm"),
        ("gapp: 3 mm", "2:5: unknown device 'gapp' - did you mean gap?"),
        ("slot: {from: 5 mm, to: 2 mm}", "slot runs from 5 mm to 2 mm"),
        ("slot: {from: 0 mm, to: 25 mm}", "slot leaves no track: the track is 25 mm wide"),
        ("slot: {from: 2 mm, too: 3 mm}", "unknown key 'too' - known are from, to"),
        ("rails: {from: 30 mm, to: 40 mm}", "rails lies beside the track"),
        ("cut_out: [[0 mm, 0 mm], [1 mm, 1 mm]]", "cut-out has 2 corners"),
        ("cut_out: [[0 mm, 0 mm], [9 mm, 9 mm], [9 mm, 0 mm], [0 mm, 9 mm]]", "cut-out crosses itself"),
        ("cut_out: [[0 mm, 0 mm], [1 mm, 0 mm], [2 mm, 0 mm]]", "cut-out has no area"),
        ("cut_out: [[0 mm, 30 mm], [9 mm, 30 mm], [9 mm, 40 mm]]", "cut-out lies beside the track"),
        ("cut_out: {dxf: none.dxf, layer: CUT}", "none.dxf: no such file - check the path"),
        ("jet: {nozzle: 2 mm}", "air jet has no pressure - write {nozzle: 2 mm, pressure: 3 bar}"),
        ("jet: {nozzle: 2 mm, pressure: 30 bar, height: 1 mm}", "pressure is 30 bar - give 0.01 to 10 bar"),
        ("bank: 60 deg", "banked track is 60 deg - give 0 to 45 deg"),
        ("separation: {}", "spacing section has no climb - write {climb: -4 deg}"),
        (f"rails: {{from: 2 mm, to: 9 mm, {LEAD_IN}}}", "lead_in is narrower than the slot - let it reach"),
        ("profile: {of: A90, play: 0 mm}", "'A90' is not an orientation - write aspect@heading, as A@90"),
    ],
)  # fmt: skip
def test_faults_have_their_place(tmp_path, line, words):
    with pytest.raises(FeederError) as caught:
        read(tmp_path, line)
    (fault,) = caught.value.lines
    assert fault.startswith(f"{tmp_path / 'bowl.yaml'}:2:") and words in fault


def test_what_travels_is_carried_and_what_is_beyond_the_free_edge_meets_no_gate(written):
    one = replace(ALONG, carry=2e-3, carry_ahead=2e-3)
    assert verdict(written("gap: 9 mm"), one).margin == pytest.approx(1e-3, rel=1e-3)
    over = verdict(written("gap: 11 mm"), one)  # sooner over it than it has tipped
    assert over.passes == 0.0 and -1e-8 < over.margin < 0.0
    assert verdict(written("gap: 14 mm"), one).margin == pytest.approx(-2e-3, rel=1e-3)
    hole = openings.gap(14e-3, LEVEL.radius, 0.02)
    assert footprints.unheld(one.axial_foot, hole) == pytest.approx(4e-3, rel=1e-3)
    cut = written("cut_out: [[0 mm, 0 mm], [14 mm, 0 mm], [14 mm, 15 mm], [0 mm, 15 mm]]")
    assert verdict(cut, one).margin == pytest.approx(-2e-3, rel=2e-2)
    # What is beyond the free edge meets no gate.
    gate = written("profile: [[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 6 mm], [0 mm, 6 mm]]")
    for width, margin in ((0.2, -3e-3), (8e-3, 1e-3)):
        one = replace(ALONG, track=replace(LEVEL, width=width))
        assert verdict(gate, one).margin == pytest.approx(margin, rel=1e-2)
    # A share passes by margin over deviation.
    judged = verdict(written("gap: 9.9 mm"), ALONG, EVERY, sigma=2e-4)
    assert judged.passes == pytest.approx(ndtr(0.5), rel=1e-3)
    assert (share(0.0, 1e-4), share(-1e-3, 0.0)) == (0.5, 0.0)


def beyond(one, low, high):
    """How far [m] its weight lies inside what a track between two distances off the wall carries of it. The
    hull of what of its foot is left between two circles about the axis of the bowl."""
    radius, axis = one.track.radius, shapely.Point(0.0, one.track.radius - one.distance)
    ring = axis.buffer(radius - low, quad_segs=500).difference(axis.buffer(radius - high, quad_segs=500))
    foot = shapely.union_all([shapely.Polygon(corners) for corners in one.foot.rings])
    left = foot.intersection(ring).convex_hull
    weight = shapely.Point(0.0, -one.posture.height * np.tan(one.track.bank))
    return left.boundary.distance(weight) if left.contains(weight) else -left.distance(weight)


def test_beside_a_round_edge_a_skew_foot_is_carried_by_what_a_circle_leaves_of_it():
    """Banked by 3 deg its weight lies nearer to the wall than its foot's own middle."""
    judged = 0
    for one in place(awkward.lying()):
        if one.kind != "flat" or one.falls_off or not one.foot.rings or len(one.foot.edges):
            continue
        assert beyond(one, 0.0, 0.99 * one.balcony) < 0.0 < beyond(one, 0.0, 1.01 * one.balcony)
        for part in (0.7, 1.2):
            strip = part * one.canyon
            margin = verdict(device("slot", span=(0.0, strip)), one).margin
            assert margin == pytest.approx(beyond(one, strip, one.track.width), abs=2e-6)
            assert (margin > 0.0) == (part < 1.0)
        judged += 1
    assert judged > 3
    # From the gap that it passes as placed, up to so much more, nothing is sure; beyond that it falls.
    judged = 0
    for one in awkward.lying():
        if one.falls_off or one.gap <= 0.0:
            continue
        more = device("gap", limit=one.gap).more(DeviceEncounter(one))
        within, over = (verdict(device("gap", limit=one.gap + more + step), one) for step in (-1e-6, 1e-6))
        assert not within.sure and over.sure and over.margin == pytest.approx(-1e-6, rel=1e-3)
        judged += abs(one.carry - one.carry_ahead) > 1e-5
    assert judged > 3
    # A block 12 x 5 mm and 20 high at a bank of 30 deg: 10 tan 30 = 5.8 mm is beyond its foot's 2.5 mm.
    tall = pick(lying(block(), BOWL.track), 12, 20)
    banked = replace(tall, track=replace(BOWL.track, bank=np.radians(30.0)))
    judged = verdict(device("narrowed track", limit=11e-3), banked)
    reach = np.hypot(6.0, 2.5 + 10.0 * np.tan(np.radians(30.0)))
    assert judged.passes == 0.0 and judged.margin == pytest.approx(-1e-3 * reach, rel=1e-3)


@pytest.mark.parametrize(
    ("sweep", "along", "ahead"),
    [(30.0, 2.0, 1.732051), (50.0, 1.305407, 0.839100), (90.0, 1.0, 0.0)],  # 1 / sin and 1 / tan
)
def test_a_swept_blade_leans_ahead_from_the_wall_to_the_free_edge(sweep, along, ahead):
    """Its face is 20 mm / sin(sweep) long and ends 20 mm / tan(sweep) farther ahead than it begins."""
    wiper = device("wiper", limit=6e-3, sweep=np.radians(sweep), contour=((0.0, 6e-3), (9e-3, 4e-3)))
    every = awkward.lying()
    features = wiper.features(replace(BOWL.track, width=20e-3), every)
    (blade,) = features.blades
    ring = shapely.get_coordinates(blade.solid)[:-1]
    lower, tall = ring[ring[:, 1] < 7e-3], ring[ring[:, 1] > 7e-3]
    edge = np.array([(0.0, 6e-3), (9e-3 * along, 4e-3), (20e-3 * along, 4e-3)])
    np.testing.assert_allclose(lower[np.argsort(lower[:, 0])], edge, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(sorted(tall[:, 0]), [0.0, 20e-3 * along], rtol=1e-6, atol=1e-12)
    assert tall[:, 1].min() > max(one.height for one in every)
    (x, y), way = blade.foot, np.array([np.cos(blade.heading), np.sin(blade.heading)])
    end = np.array([x, y]) + 20e-3 * along * way
    np.testing.assert_allclose(end - [x, 0.0], [20e-3 * ahead, 20e-3], rtol=1e-6, atol=1e-9)
    assert y == 0.0 and features.length == pytest.approx(end[0])
    assert features.length == pytest.approx(0.5 * room_of(every) + 20e-3 * ahead, rel=1e-6, abs=1e-12)


@pytest.fixture(scope="module")
def rod():
    """A rod along the wall, of R = 3 mm and 20 mm long: over a slot w wide it sinks R - sqrt(R2 - w2 / 4)."""
    every = coming(shapes.cylinder(3.0, 20.0, 256), BOWL)
    return next(one for one in every if one.kind == "rolling" and one.rolls_along)


@pytest.mark.parametrize(("wide", "rides"), [(2.75, True), (2.87, False)])
def test_over_a_shorter_hole_a_rod_only_dips(rod, wide, rides):
    """By a sixth, of a hole of 12 mm under 10 mm ahead; but what an edge is rounded by costs nothing. (s -
    0.05 mm) / 6 = 0.1 mm - 0.05 mm, so s = 0.35 mm and w = 2 sqrt(9 - 2.65^2) = 2.81 mm. Placed it falls 2 mm
    over the edge, of which it travels 1 mm."""
    low, high = rod.distance - 0.5e-3 * wide, rod.distance + 0.5e-3 * wide
    hole = device("cut-out", corners=((0.0, low), (12e-3, low), (12e-3, high), (0.0, high)))
    judged = verdict(hole, replace(rod, climbs=0.1e-3, carry=1e-3))
    assert judged.passes == 0.0 and judged.margin == pytest.approx(-UNSURE if rides else -1e-3, rel=1e-2)
    assert hole.features(rod.track, [rod]).length == 12e-3


@pytest.mark.parametrize(
    ("sweep", "own", "fate"),
    [
        (30.0, None, "returned"), (58.0, None, "returned"), (60.0, None, "stopped"),
        (60.0, 0.5, "returned"), (64.0, 0.5, "stopped"), (90.0, 0.0, "stopped"),
    ],
)  # fmt: skip
def test_a_face_sweeps_off_below_a_right_angle_less_its_angle_of_friction(rod, sweep, own, fate):
    """atan 0.6 = 31 deg of the track, atan 0.5 = 27 deg of the face; one straight across stops all."""
    angle = np.radians(sweep) if sweep < 90.0 else SQUARE_FACE_RAD
    wiper = device("wiper", limit=1e-3, sweep=angle, friction=own)
    assert wiper.fate(DeviceEncounter(replace(rod, grip=0.6))) == fate


def still(mesh, height):
    """Orientations of that height [mm] on a track that does not shake: friction alone holds them, 0.6."""
    every = [one for one in coming(mesh, BOWL) if one.height == pytest.approx(1e-3 * height, rel=1e-6)]
    return [replace(one, swing=0.0, speed=0.05, grip=0.6) for one in every]


STEPPED = [(0, 0), (16, 0), (16, 4), (4, 4)]  # [mm] a tall end behind or ahead


@pytest.mark.parametrize(
    ("pressure", "least", "most"), [(9e3, 0.2, 0.5), (3e4, 0.5, 4.5), (2e5, 4.5, 9.0), (5e5, 9.0, 30.0)]
)
def test_a_jet_is_felt_as_long_as_it_meets_the_tall_end_of_a_part(pressure, least, most):
    """Of nine places along 16 mm two lie in the tall 4 mm; over the rest it blows at nothing. The part weighs
    128 mm2 x 8 mm of steel and tips over a foot 4 mm wide about an edge 12 mm below the jet. Half the force
    at any place moves nothing, and twice in the mean all of it the 36 mm to the free edge."""
    tall_end = still(shapes.prism([*STEPPED, (4, 20), (0, 20)], 8.0), 20)
    ends = [one for one in tall_end if one.length > 15.9e-3 and one.width < 9e-3]
    jet = device("air jet", nozzle=0.8e-3, pressure=pressure, height=12e-3)
    share = jet.jet.thrust / (1024e-9 * STEEL * GRAVITY * 4.0 / 12.0)
    assert len(ends) == 2 and least < share < most  # the tall end ahead, or behind
    margin = {0.2: 36e-3 * (1.0 - share), 0.5: 0.0, 4.5: -UNSURE, 9.0: -36e-3}[least]
    for one in ends:
        assert jet.most(DeviceEncounter(one)) == pytest.approx(share, rel=0.015)  # rays to 11 deg askew
        assert jet.factor(DeviceEncounter(one)) == pytest.approx(2.0 / 9.0 * share, rel=0.015)
        assert verdict(jet, one).margin == pytest.approx(margin, rel=0.01, abs=0.0)


def test_a_jet_meets_the_end_of_a_part_that_is_higher_than_its_middle():
    every = coming(shapes.prism([*STEPPED, (4, 9), (0, 9)], 8.0), bowls.read(None, []))
    one = max((k for k in every if k.height < 9.5e-3 and k.length > 15e-3), key=lambda k: k.height)
    jet, met = device("air jet", nozzle=2e-3, pressure=5e4, height=7e-3), DeviceEncounter(one, every)
    assert jet.jet.push(one, every)[0] == 0.0 and jet.most(met) > 2.0 * jet.factor(met) > 0.0
    jets = [replace(jet, pressure=float(pressure)) for pressure in np.geomspace(1e2, 1e5, 60)]
    some, weak = (next(k for k in jets if low < k.most(met) < high) for low, high in ((0.6, 1.8), (0.2, 0.5)))
    assert not some.judged(met).sure and weak.judged(met).sure and weak.judged(met).passes == 1.0
    # A face that rises at 60 deg takes T sin2 of a level jet outwards and T sin cos down: friction holds it.
    slope = np.radians(60.0)
    rise = 10.0 * np.tan(slope)
    area = 16.0 * 2.0 + 0.5 * 10.0 * rise + 6.0 * rise
    middle = (16.0 * 2.0 * 8.0 + 0.5 * 10.0 * rise * 20.0 / 3.0 + 6.0 * rise * 13.0) / area
    outline = [(0, 0), (16, 0), (16, 2 + rise), (10, 2 + rise), (0, 2)]
    along = [one for one in still(shapes.prism(outline, 60.0), 2.0 + rise) if one.length > 59e-3]
    (one,) = [one for one in along if one.distance == pytest.approx(1e-3 * middle, rel=1e-3)]
    side = (16.0 - middle) / 10.0  # of its weight, at 10 mm: less than what friction holds
    jet = device("air jet", nozzle=0.5e-3, pressure=2e4, height=10e-3)
    taken = np.sin(slope) ** 2 - 0.6 * np.sin(slope) * np.cos(slope)
    force = area * 60e-9 * STEEL * GRAVITY * min(0.6, side)
    assert jet.factor(DeviceEncounter(one)) == pytest.approx(taken * jet.jet.thrust / force, rel=0.03)


CORNERS = ((0.0, 0.0), (12e-3, 3e-3), (14e-3, 9e-3))
SENSORS = {
    "outline": ("vision reject (camera from above)", "outlines"),
    "side": ("vision reject (camera from the side)", "side views"),
    "height": ("vision reject (fibre sensor)", "heights"),
    "relief": ("vision reject (laser along the middle)", "height profiles"),
}


@pytest.mark.parametrize(
    ("kind", "values", "name", "words"),
    [
        ("separation", {"angle": np.radians(-6.0)}, "spacing section", "goes down at 6 deg"),
        ("jet", {"height": 8e-3}, "air jet", "nozzle of 2 mm at 0.2 bar, 8 mm over the track"),
        ("cut_out", {"corners": CORNERS}, "cut-out", "polygon of 3 corners"),
        ("narrowed_track", {"limit": 9e-3}, "narrowed track", "9 mm"),
        ("pressure_break", {"limit": 9.25e-3}, "pressure break", "9.25 mm"),
        ("height_bar", {"limit": 6e-3}, "height bar", "6 mm over the track"),
        ("wiper", {"limit": 6e-3, "sweep": 0.5236}, "wiper", "6 mm over the track, swept back 30 deg"),
        ("slot", {"span": (2e-3, 5e-3)}, "slot", "from 2 to 5 mm off the wall"),
        ("rails", {"span": (4.5e-3, 8.5e-3)}, "rails", "slot from 4.5 to 8.5 mm off the wall"),
        ("bank", {"angle": np.radians(6.0)}, "banked track", "6 deg towards the wall"),
        ("groove", {"angle": np.radians(30.0)}, "V groove", "both faces rise at 30 deg"),
        ("yield", {"shares": (("A", 0.9), ("B", 0.1))}, "measured yield", "passes 90 % of A, 10 % of B"),
    ],
)  # fmt: skip
def test_a_device_has_a_name_of_the_trade_and_a_value_in_words(kind, values, name, words):
    one = device(kind, **values).rewritten()
    assert (one.kind, one.full_name, one.value_words) == (name, name, words)
    written_so = {
        name,
        name.title(),
        name.replace(" ", "_"),
        name.replace("-", " "),
        f" {name} (of steel)",
        kind,
    }
    assert {find_kind(word) for word in written_so} == {type(one)}


@pytest.mark.parametrize("sees", SENSORS)
def test_a_vision_reject_says_what_sees_what_it_keeps_and_what_it_rejects(sees):
    like, also = ("A", np.radians(187.672), 8.35e-3), (("A", np.radians(353.592)), ("B", np.radians(359.8)))
    one, (name, what) = device("vision reject", like=like, also=also, sees=sees).rewritten(), SENSORS[sees]
    words = f"keeps A@188, A@354 and B@0, rejects {what} that differ by more "
    words += "than "
    assert (one.full_name, one.value_words) == (name, f"{words}8.35 mm")
    assert one.with_pulse(0.02).value_words == f"{words}8.35 mm, air for 20 ms"
