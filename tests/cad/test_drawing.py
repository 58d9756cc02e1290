"""The drawing sheets: their dimensions are those of the solid, and nothing lies beyond its frame."""

import io
import itertools
import re
import zlib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest
import shapes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from solids import RULES, STEEP, STEPPED, TRACK, built, device, planned

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.bowl.size import Size
from feederscrew.cad.closed_body import body
from feederscrew.cad.plan import SolidOptions, material, plan
from feederscrew.feeding import stream
from feederscrew.output import bowl_sheet, outlet_poses, pose_sheet
from feederscrew.output.drafting import A3, FRAME, SHEET_GAP_MM, Drawing
from feederscrew.output.marking import SheetFields
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.pose_words import describe_pose
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.sorting.verdicts import verdict

CASES = {
    "cylinder": ("narrowed and rails", TRACK, SolidOptions()),
    "tall and left": ("none", TRACK, SolidOptions(outlet_height=0.15, left=True)),
    "stepped": ("gap", STEEP, STEPPED),
}


def study(solid):
    part = SimpleNamespace(name="pin", source="parts/pin.stl", material="steel")
    return SimpleNamespace(
        order=SimpleNamespace(part=part, target=1.0, wanted=None, hopper=0.01, on_track=None),
        bowl=bowls.default(), solid=solid, force=100.0, fill=SimpleNamespace(mass=1.0),
        stroke=SimpleNamespace(frequency=100.0, peak_to_peak=4e-4),
        springs=SimpleNamespace(natural_frequency=105.0), mismatch=None, turns=1.8,
    )  # fmt: skip


@pytest.fixture(scope="module")
def posed():
    """A sheet of a bowl with a part on its track: a wiper returns what stands, a gap what is short."""
    part = shapes.part(shapes.box(20.0, 12.0, 5.0), "block")
    devices = (device("wiper", limit=8e-3), device("gap", limit=7e-3))
    on_track = stream.follow_orientations(part, find(part), TRACK, devices)
    sheet = study(body(planned(devices, turns=1.8)))
    sheet.bowl = replace(sheet.bowl, devices=devices, track=TRACK)
    sheet.answer = SimpleNamespace(velocity=0.05)
    sheet.order.part, sheet.order.on_track, sheet.order.rule = part, on_track, "hops"
    return sheet


def test_the_part_stands_at_the_outlet_as_it_leaves_and_beside_each_device(posed):
    drawing, coming = bowl_sheet.draw_sheets(posed), posed.order.on_track
    leaves = coming.lying[int(np.argmax(coming.rules["hops"] * coming.through))]
    first, of_poses = drawing.texts(0), drawing.texts(2)
    assert any(text.startswith("part at the outlet") for text in first)
    assert " ".join(first).count(f"leaves {leaves.name}: {describe_pose(leaves).partition(',')[0]}") == 1
    assert {shortest(leaves.length), shortest(leaves.height)} <= {text.removesuffix(".0") for text in first}
    passed = {text.split(" ")[1].strip(",") for text in of_poses if text.startswith("passes ")}
    gone = {text.split(" ")[1].strip(",") for text in of_poses if re.match("(returns|stops) ", text)}
    assert leaves.name in passed - gone
    fates = dict(zip((one.name for one in coming.lying), coming.through))
    assert gone and all(fates[name] < 0.5 for name in gone)
    for number, sheet in enumerate(drawing.sheets):
        assert not overlapping(drawing.figure(number)) and sheet
    assert f"A3, 3 of {len(drawing.sheets)}" in " ".join(of_poses)
    # what a trial has counted goes before what leaves most often
    other = next(one for one in coming.lying if one.name != leaves.name and not one.returned)
    posed_as = outlet_poses.find_outlet_poses(posed, SimpleNamespace(wanted=f"{other.name} or X@1"))
    assert posed_as.leaving is other


PARTS = Path(__file__).parents[2] / "parts"
TWIST = device("twisted track", angle=np.radians(80.0), length=0.12)


def seen_from_ahead(pose):
    """The boxes (2, 2) [mm] of part, wall and track that the sheet of an outlet shows from ahead; its texts.

    Least and most, across and up from the foot of the wall, in the part's size.
    """
    drawing = Drawing()
    pose_sheet.draw_outlet_views(drawing, pose, (0.0, 0.0, 300.0, 200.0))
    lines = {}
    for layer, kind, points, _ in drawing.sheets[0]:
        if kind == "line":
            lines.setdefault(layer, []).append(np.asarray(points))
    _, wall, track = lines["OUTLINE"]  # the first is the wall from above
    beside = max(line[:, 0].max() for line in lines["CENTRE"])  # where the views to the left of it end
    part = np.concatenate([line for line in lines["EDGE"] if line[:, 0].min() > beside])
    (title,) = (words for words in drawing.texts(0) if words.startswith("part at the outlet"))
    paper, real = title.split(" ")[-1].split(":")
    boxes = (np.array([points.min(axis=0), points.max(axis=0)]) - wall[0] for points in (part, wall, track))
    return [box * float(real) / float(paper) for box in boxes], drawing.texts(0)


@pytest.mark.parametrize("own", [False, True])
def test_behind_a_twist_the_wall_of_the_sheet_is_the_floor_that_stood_up(own):
    """A part turns with its track by a right angle: what was over the floor is off the wall, outwards.

    It leaves in a pose that the level track has too, or in one of its own.
    """
    ring = [(0, 0), (30, 0), (30, 4), (12, 4), (12, 15), (0, 15)]
    bracket = shapes.part(shapes.prism(ring, 10.0), "bracket")
    part = parts.load(PARTS / "lbracket_30x20x15.stl") if own else bracket
    every, seen = orientations(part, find(part), TRACK), 0
    devices = (device("gap", limit=9e-3), TWIST) if own else (TWIST,)
    sheet = study(None)
    sheet.bowl = replace(sheet.bowl, devices=devices, track=TRACK)
    sheet.order.part, sheet.order.rule = part, "hops"
    sheet.order.on_track = stream.along(every, find(part), devices)
    for row, one in enumerate(every):
        outcome = verdict(TWIST, one, every)
        is_asked = not own or sheet.order.on_track.leaves_as[row] != row  # no other leaves by its name
        if one.returned or not outcome.margin > 0.0 or bool(outcome.onto) == own or not is_asked:
            continue
        asked = one if own else every[outcome.onto[0][0]]
        sheet.order.wanted = asked.aspect, asked.heading
        _, pose = outlet_poses.find_leaving(sheet)
        (drawn, wall, track), words = seen_from_ahead(pose)
        turned, near = [[-1e3 * one.height, 0.0], [0.0, 1e3 * one.width]], 0.05 * 30.0  # of its size
        np.testing.assert_allclose(drawn, turned, atol=near)
        assert wall[0, 0] == wall[1, 0] == 0.0 and track[0, 0] < drawn[0, 0] and track[1, 0] == 0.0
        assert "from above, wall above" in words and "from the free edge" in words
        seen += 1
        # and on the level as ever
        (drawn, wall, track), words = seen_from_ahead(one)
        assert drawn[0, 0] > -0.1 and track[0, 0] == 0.0 and track[1, 0] > drawn[1, 0]
        assert "from above, wall below" in words
    assert seen


def shortest(length):
    """A length [m] in millimetres with two digits at most."""
    return f"{1e3 * length:.2f}".rstrip("0").rstrip(".")


@pytest.mark.parametrize("name", CASES)
def test_dimensions_are_those_of_the_solid_and_all_is_within_the_frame(name):
    solid = built(*CASES[name], turns=1.8)
    drawing = bowl_sheet.draw_sheets(study(solid))
    words, heights = drawing.texts(0), solid.vertices[:, 2]
    assert {shortest(np.ptp(heights)), shortest(solid.plan.outlet_height), "track 20"} <= set(words)
    assert ("R150 at the outlet" if name == "stepped" else "Ø300") in words
    assert f"{solid.mass:.4g} kg, {1e9 * solid.volume:.6g} mm³" in words
    left, bottom, right, top = FRAME
    for number in range(len(drawing.sheets)):
        figure = drawing.figure(number)
        (axes,) = figure.axes
        drawn = [path.vertices for some in axes.collections for path in some.get_paths()]
        places = np.concatenate([*drawn, *(patch.get_path().vertices for patch in axes.patches)])
        assert (places >= np.array([left, bottom]) - 0.1).all(), number
        assert (places <= np.array([right, top]) + 0.1).all(), number
        assert not overlapping(figure)  # no letters of a sheet lie on others


def lengths_of_a_sheet(drawing):
    """Lengths [mm] and angles [deg] that dimensions of the first sheet of the DXF file measure."""
    lengths, angles = [], []
    for one in ezdxf.read(io.StringIO(drawing.dxf().decode())).modelspace().query("DIMENSION"):
        if one.dimtype != 6 and one.dxf.defpoint.x < A3[0]:
            size = one.get_measurement()
            if one.dimtype == 5:
                angles.append(size)
            else:
                lengths.append(size * one.get_dim_style().dxf.dimlfac)
    return sorted(lengths), sorted(angles)


@pytest.mark.parametrize("name", CASES)
def test_dimensions_of_the_first_sheet_are_those_of_the_bowl_and_its_springs(name):
    solid = built(*CASES[name], turns=1.8)
    sheet, own = study(solid), solid.plan
    lengths, angles = lengths_of_a_sheet(bowl_sheet.draw_sheets(sheet))
    machine, banks = sheet.bowl.machine, int(sheet.bowl.sizing.banks)
    radius = own.path.radius
    heights = float(np.ptp(solid.vertices[:, 2])), float(own.path.height(own.path.end))
    inner, outer = 2.0 * radius, 2.0 * (radius + own.material.wall)
    if own.stairs is not None:
        inner, outer = radius, float(np.ptp(solid.vertices[:, 0]))
    leaves = -(-int(machine.leaves) // banks)  # of the largest bank, with spacers of their thickness between
    stack = (2 * leaves - 1) * machine.leaf_thickness
    wanted = [*heights, inner, outer, 2.0 * machine.spring_radius, machine.leaf_length, stack]
    np.testing.assert_allclose(lengths, sorted(1e3 * size for size in wanted), rtol=0.0, atol=0.02)
    to_first = (90.0 - np.degrees(own.turned)) % 360.0  # from the outlet to the first bank
    tilts = sorted([360.0 / banks, np.degrees(machine.spring_angle), *([to_first] if to_first else [])])
    np.testing.assert_allclose(angles, tilts, rtol=0.0, atol=0.01)


def test_heights_of_the_track_on_the_last_sheet_are_those_of_its_helix():
    """Climbs up to a spacing section and from there on, less the step: at each change, and at the outlet."""
    down, up = (device("spacing section", angle=np.radians(angle)).rewritten() for angle in (-4.0, 5.5))
    solid = body(
        planned((down, device("step", limit=4e-3), up), replace(TRACK, climb=np.radians(5.5)), turns=1.5)
    )
    plan, drawing = solid.plan, bowl_sheet.draw_sheets(study(solid))
    (bend, back), ((step, drop),) = (at for at, _ in plan.path.bends), plan.path.drops
    left, levels, places = (len(drawing.sheets) - 1) * (A3[0] + SHEET_GAP_MM), set(), set()
    for one in ezdxf.read(io.StringIO(drawing.dxf().decode())).modelspace().query("DIMENSION"):
        if one.dimtype == 6 and one.dxf.defpoint.x > left:
            value, factor = one.get_measurement(), one.get_dim_style().dxf.dimlfac
            is_along = bool(one.dxf.dimtype & 64)
            (places if is_along else levels).add(factor * (value.x if is_along else value.y))
    rise, fall = np.tan(np.radians([5.5, 4.0]))
    top = rise * bend
    wanted = [top, top - fall * (step - bend) - drop, top - fall * (back - bend) - drop]
    wanted.append(wanted[-1] + rise * (plan.path.end - back))
    np.testing.assert_allclose(sorted(levels), sorted(1e3 * z for z in wanted), rtol=0.0, atol=0.02)
    stops = [0.0, bend, step, back, plan.path.end]
    np.testing.assert_allclose(sorted(places), [1e3 * s for s in stops], rtol=0.0, atol=0.02)


def overlapping(figure):
    """Pairs of texts whose boxes overlap by more than a tenth of a millimetre, and texts off the page."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    texts = [text for text in figure.findobj(Text) if text.get_text()]
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in texts]
    slack, (wide, high) = 0.1 * figure.dpi / 25.4, figure.canvas.get_width_height()
    bad = [word for word, box in boxes if box.x0 < 0 or box.y0 < 0 or box.x1 > wide or box.y1 > high]
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        if min(a.x1, b.x1) - max(a.x0, b.x0) > slack and min(a.y1, b.y1) - max(a.y0, b.y0) > slack:
            bad.append((one, other))
    return bad


RAILS = """\
track: {radius: 150 mm, width: 20 mm, climb: 4 deg}
devices:
  - rails: {from: 4.4 mm, to: 11.45 mm, lead_in: {from: 2.9 mm, to: 12.7 mm, length: 47.7 mm, taper: 31.8 mm}}
"""


def test_the_rails_are_read_back_from_dxf_and_pdf_as_the_bowl_file_has_them(tmp_path):
    (tmp_path / "bowl.yaml").write_text(RAILS)
    bowl = bowls.read(tmp_path / "bowl.yaml")
    solid = body(planned(bowl.devices, track=bowl.track, turns=1.2))
    drawing = bowl_sheet.draw_sheets(study(solid), fields=SheetFields("2026-11-26", "rev C"))
    (rails,) = bowl.devices
    near, far, long, taper = (1e3 * size for size in rails.lead)
    across = {near, far, *(1e3 * end for end in rails.span)}
    measured = {"x": set(), "y": set(), "along": set()}
    for one in ezdxf.read(io.StringIO(drawing.dxf().decode())).modelspace().query("DIMENSION"):
        factor, value = one.get_dim_style().dxf.dimlfac, one.get_measurement()
        if one.dimtype == 6:  # an ordinate, from the wall or from the datum
            upright = not one.dxf.dimtype & 64
            measured["y" if upright else "x"].add(round(factor * (value.y if upright else value.x), 6))
        elif one.dimtype in (0, 1):
            measured["along"].add(round(factor * value, 6))
    assert across <= measured["y"] and {long, taper} <= measured["along"]
    start = min(x for x in measured["x"] if x > 0.0)
    assert {round(start + long, 6), round(start + long + taper, 6)} <= measured["x"]
    words = pdf_words(drawing.pdf("rails"))
    assert {f"{size:g}" for size in (*across, long, taper)} <= set(words)
    assert {"2026-11-26", "rev C", "date", "rev"} <= set(words) and any("1:2" in word for word in words)


def pdf_words(data):
    """The texts of a PDF of matplotlib, in its order."""
    words = []
    for packed in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.S):
        try:
            content = zlib.decompress(packed)
        except zlib.error:
            continue
        for written in re.findall(rb"BT\n(.*?)ET", content, re.S):
            pieces = re.findall(rb"\(((?:\\.|[^\\()])*)\)", written)
            words.append(b"".join(pieces).decode("latin-1"))
    return words


def test_sheets_of_two_vision_rejects_have_their_texts_apart_and_within_the_frame():
    """Eight columns of holes in the wall: their texts ran over the head of the sheet and beyond its frame."""
    part = shapes.part(shapes.prism(shapes.l_profile(), 15.0), "bracket")
    track = replace(TRACK, width=0.03, radius=0.2, climb=np.radians(4.5))
    lying = orientations(part, find(part), track)
    longest = max(lying, key=lambda one: one.length)
    like = longest.aspect, longest.heading, 2e-3
    devices = (
        device("spacing section", angle=np.radians(-4.0)).rewritten(),
        device("vision reject", like=like, sees="outline").rewritten(),
        device("vision reject", like=like, sees="height").rewritten(),
    )
    coming = stream.follow_orientations(part, find(part), track, devices)
    pitch = 2.0 * np.pi * track.radius * np.tan(track.climb)
    size = Size(2.0 * track.radius, {}, track.width, 0.0, 0.0, track.climb, 1.5 * pitch, 1.5, pitch)
    extents = (30e-3, 20e-3, 15e-3)
    tooled = lay_out(track, devices, coming.lying)
    made = body(plan(size, track, material("steel", RULES), tooled, SolidOptions(), extents=extents))
    sheet = study(made)
    sheet.bowl, sheet.answer = (
        replace(sheet.bowl, devices=devices, track=track),
        SimpleNamespace(velocity=0.05),
    )
    sheet.order.part, sheet.order.on_track, sheet.order.rule = part, coming, "hops"
    drawing = bowl_sheet.draw_sheets(sheet)
    for number in range(len(drawing.sheets)):
        assert not overlapping(drawing.figure(number))
    for number in (2, 3):
        assert any(
            f"vision reject, device {number}" in " ".join(drawing.texts(k))
            for k in range(len(drawing.sheets))
        )
    holes = [text for text in drawing.texts(1) if "through the wall" in text]
    assert len(holes) == 8 and sum("nozzle: 4" in text for text in holes) == 2
