"""What each kind of device does with a block; shares under play."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapely
import shapes
from scipy.special import ndtr

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Track
from feederscrew.errors import FeederError
from feederscrew.resting.aspects import find
from feederscrew.tooling import footprints
from feederscrew.tooling.devices import openings
from feederscrew.tooling.devices.base import share
from feederscrew.tooling.devices.kinds import KINDS, make_device
from feederscrew.tooling.orientations import orientations, place
from feederscrew.tooling.verdicts import verdict

TRACK = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)


@pytest.fixture(scope="module")
def block():
    part = shapes.part(shapes.box(20, 12, 5))
    return orientations(part, find(part), TRACK)


@pytest.fixture
def device(tmp_path):
    def read(line):
        path = tmp_path / "bowl.yaml"
        path.write_text(f"track: {{radius: 100 m, width: 200 mm}}\ndevices:\n  - {line}\n")
        return bowls.read(path).devices[0]

    return read


def along(block):
    return next(one for one in block if one.height < 6e-3 and one.length > 0.015)


def across(block):
    return next(one for one in block if one.height < 6e-3 and one.length < 0.015)


@pytest.mark.parametrize(
    ("line", "lengthwise", "crosswise"),
    [  # margins in mm
        ("wiper: 6 mm", 1.0, 1.0),
        ("height_bar: 4 mm", -1.0, -1.0),
        ("hold_down: 5.5 mm", 0.5, 0.5),
        ("pressure_break: 8 mm", 2.0, -2.0),
        ("narrowed_track: 8 mm", 2.0, -2.0),
        ("canyon: 8 mm", -2.0, 2.0),
        ("gap: 9 mm", 1.0, -3.0),
        ("slot: {from: 5 mm, to: 7 mm}", 6.0, 6.0),
        ("slot: {from: 0 mm, to: 8 mm}", -2.0, 2.0),
        ("cut_out: [[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 100 mm], [0 mm, 100 mm]]", 1.0, -3.0),
        ("profile: [[0 mm, 0 mm], [12.5 mm, 0 mm], [12.5 mm, 5.5 mm], [0 mm, 5.5 mm]]", 0.5, -7.5),
    ],
)
def test_signed_margins_of_a_block(block, device, line, lengthwise, crosswise):
    made = device(line)
    for one, wanted in ((along(block), lengthwise), (across(block), crosswise)):
        found = verdict(made, one, block)
        assert 1e3 * found.margin == pytest.approx(wanted, abs=5e-3)
        assert found.passes == float(wanted > 0.0)


def test_a_gate_of_an_orientation_passes_it_by_its_play(block, device):
    one = along(block)
    made = device(f"profile: {{of: {one.aspect}@{np.degrees(one.heading):.6g}, play: 0.2 mm}}")
    assert verdict(made, one, block).margin == pytest.approx(2e-4, abs=1e-6)
    assert verdict(made, across(block), block).margin < -7e-3


def test_a_share_passes_by_margin_over_deviation(block, device):
    found = verdict(device("gap: 9.9 mm"), along(block), block, sigma=2e-4)
    assert found.passes == pytest.approx(ndtr(0.5), rel=1e-3)
    assert share(0.0, 1e-4) == 0.5
    assert share(-1e-3, 0.0) == 0.0


def test_every_kind_has_a_verdict_and_an_example_that_reads(tmp_path):
    lines = "".join(f"  - {kind}: {one.example}\n" for kind, one in KINDS.items())
    path = tmp_path / "bowl.yaml"
    path.write_text("devices:\n" + lines)
    chain = bowls.read(path).devices
    assert [one.kind for one in chain] == list(KINDS)
    assert all(one.text == KINDS[one.kind].example for one in chain)
    settings = {s.key.name: s for s in bowls.settings(path)}
    assert settings["devices.1"].text == "wiper: 6 mm"
    assert settings["devices.1"].origin == f"{path}:2"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("gap: -1 mm", "2:10: gap is -1 mm - give more than 0 mm"),
        ("gapp: 3 mm", "2:5: unknown device 'gapp' - did you mean gap?"),
        ("slot: {from: 5 mm, to: 2 mm}", "slot runs from 5 mm to 2 mm"),
        ("slot: {from: 0 mm, to: 25 mm}", "slot leaves no track: the track is 25 mm wide"),
        ("slot: {from: 2 mm, too: 3 mm}", "unknown key 'too' - known are from, to"),
        ("rails: {from: 30 mm, to: 40 mm}", "rails lies beside the track"),
        ("canyon: 25 mm", "canyon leaves no track: the track is 25 mm wide"),
        ("cut_out: [[0 mm, 0 mm], [1 mm, 1 mm]]", "cut_out has 2 corners"),
        ("cut_out: [[0 mm, 0 mm], [9 mm, 9 mm], [9 mm, 0 mm], [0 mm, 9 mm]]", "cut_out crosses itself"),
        ("cut_out: [[0 mm, 0 mm], [1 mm, 0 mm], [2 mm, 0 mm]]", "cut_out has no area"),
        ("cut_out: [[0 mm, 30 mm], [9 mm, 30 mm], [9 mm, 40 mm]]", "cut_out lies beside the track"),
        ("cut_out: {dxf: none.dxf, layer: CUT}", "none.dxf: no such file - check the path"),
        ("jet: {nozzle: 2 mm}", "jet has no pressure - write {nozzle: 2 mm, pressure: 3 bar}"),
        ("jet: {nozzle: 2 mm, pressure: 30 bar, height: 1 mm}", "pressure is 30 bar - give 0.01 to 10 bar"),
        ("bank: 60 deg", "bank is 60 deg - give 0 to 45 deg"),
        ("separation: {}", "separation has no climb - write {climb: -4 deg}"),
        (
            "rails: {from: 2 mm, to: 9 mm, lead_in: {from: 3 mm, to: 9 mm, length: 9 mm, taper: 9 mm}}",
            "lead_in is narrower than the slot - let it reach as far",
        ),
        ("profile: {of: A90, play: 0 mm}", "'A90' is not an orientation - write aspect@heading, as A@90"),
    ],
)
def test_faults_have_their_place(tmp_path, line, told):
    path = tmp_path / "bowl.yaml"
    path.write_text(f"devices:\n  - {line}\n")
    with pytest.raises(FeederError) as caught:
        bowls.read(path)
    (one,) = caught.value.lines
    assert one.startswith(f"{path}:2:")
    assert told in one


def test_a_cut_out_of_a_drawing(tmp_path, block):
    import ezdxf

    drawing = ezdxf.new("R2010", units=4)
    corners = [(0, 0), (9, 0), (9, 100), (0, 100)]
    drawing.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": "CUT"})
    drawing.saveas(tmp_path / "holes.dxf")
    path = tmp_path / "bowl.yaml"
    path.write_text(
        "track: {radius: 100 m, width: 200 mm}\ndevices:\n  - cut_out: {dxf: holes.dxf, layer: CUT}\n"
    )
    made = bowls.read(path).devices[0]
    assert np.array(made.corners) == pytest.approx(1e-3 * np.array(corners, dtype=float))
    assert verdict(made, along(block), block).margin == pytest.approx(1e-3, abs=5e-6)
    with pytest.raises(FeederError, match="no closed outline on layer 'GATE'"):
        path.write_text("devices:\n  - cut_out: {dxf: holes.dxf, layer: GATE}\n")
        bowls.read(path)


def test_what_travels_is_carried_over_what_it_is_unsupported_for(block, device):
    one = replace(along(block), carry=2e-3, carry_ahead=2e-3)
    assert verdict(device("gap: 9 mm"), one).margin == pytest.approx(1e-3, rel=1e-3)
    over = verdict(device("gap: 11 mm"), one)  # sooner over it than it has tipped
    assert over.passes == 0.0 and -1e-8 < over.margin < 0.0
    assert verdict(device("gap: 14 mm"), one).margin == pytest.approx(-2e-3, rel=1e-3)
    hole = openings.gap(14e-3, TRACK.radius, 0.02)
    assert footprints.unheld(one.standing, hole) == pytest.approx(4e-3, rel=1e-3)
    cut = device("cut_out: [[0 mm, 0 mm], [14 mm, 0 mm], [14 mm, 15 mm], [0 mm, 15 mm]]")
    assert verdict(cut, one).margin == pytest.approx(-2e-3, rel=2e-2)


def test_what_is_beyond_the_free_edge_meets_no_gate(block, device):
    gate = device("profile: [[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 6 mm], [0 mm, 6 mm]]")
    one = along(block)
    assert verdict(gate, one).margin == pytest.approx(-3e-3, rel=1e-2)
    narrow = replace(one, track=replace(TRACK, width=8e-3))
    assert verdict(gate, narrow).margin == pytest.approx(1e-3, rel=1e-2)


def beyond(one, low, high):
    """How far [m] its weight lies inside what a track between two distances off the wall carries of it.

    The hull of what of its foot is left between two circles about the axis of the bowl.
    """
    radius, axis = one.track.radius, shapely.Point(0.0, one.track.radius - one.distance)
    ring = axis.buffer(radius - low, quad_segs=500).difference(axis.buffer(radius - high, quad_segs=500))
    foot = shapely.union_all([shapely.Polygon(corners) for corners in one.foot.rings])
    left = foot.intersection(ring).convex_hull
    weight = shapely.Point(0.0, -one.posture.height * np.tan(one.track.bank))
    inside = left.contains(weight)
    return left.boundary.distance(weight) if inside else -left.distance(weight)


def test_beside_a_round_edge_a_skew_foot_is_carried_by_what_a_circle_leaves_of_it():
    """Banked by 3 deg its weight lies nearer to the wall than its foot's own middle."""
    judged = 0
    for one in place(awkward.lying()):
        if one.kind != "flat" or one.falls_off or not one.foot.rings or len(one.foot.edges):
            continue
        assert beyond(one, 0.0, 0.99 * one.balcony) < 0.0 < beyond(one, 0.0, 1.01 * one.balcony)
        for part in (0.7, 1.2):
            strip = part * one.canyon
            found = verdict(make_device("slot", "test", span=(0.0, strip)), one).margin
            assert found == pytest.approx(beyond(one, strip, one.track.width), abs=2e-6)
            assert (found > 0.0) == (part < 1.0)
        judged += 1
    assert judged > 3
