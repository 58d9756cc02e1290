"""SVG and PDF show what the DXF file has, and what the DXF file has is the tooled track: to 0.02 mm."""

import io
import re
import xml.etree.ElementTree as ElementTree
import zlib
from collections import Counter

import ezdxf
import numpy as np
import pytest
import shapely
import test_one_track as chains
from ezdxf import disassemble
from ezdxf.path import make_path
from test_edges import CASES, laid_out

from feederscrew.output import bowl_sheet, tooling_drawing
from feederscrew.output.drafting import A3, SHEET_GAP_MM, Drawing

NEAR_MM = 0.02
POINT_MM = 25.4 / 72.0  # of paper
CHORD_MM = 0.002  # by which an arc of the DXF file is taken too flat
SVG = "{http://www.w3.org/2000/svg}"
MM = 1e-3


def opened(data):
    """The model space of a DXF file."""
    return ezdxf.read(io.StringIO(data.decode())).modelspace()


def drawn_lines(space):
    """Lines (K, 2) [mm] of a DXF file by layer, those of dimensions among them, and its texts with places."""
    lines, texts = {}, []
    for entity in space:
        for simple in disassemble.recursive_decompose([entity]):
            kind, layer = simple.dxftype(), entity.dxf.layer
            if kind in ("TEXT", "MTEXT"):
                words, is_aligned = simple.plain_text(), kind == "TEXT" and simple.dxf.halign
                place = simple.dxf.align_point if is_aligned else simple.dxf.insert
                texts += [(words, (place.x, place.y))] if words else []
            elif kind in ("SOLID", "HATCH"):
                rings = [simple.vertices()] if kind == "SOLID" else [path.vertices for path in simple.paths]
                for ring in rings:
                    points = np.array([(place[0], place[1]) for place in ring])
                    lines.setdefault(layer, []).append(np.vstack([points, points[:1]]))
            elif kind != "POINT":
                places = make_path(simple).flattening(CHORD_MM)
                lines.setdefault(layer, []).append(np.array([(place.x, place.y) for place in places]))
    return lines, texts


def svg_lines(text):
    """Lines (K, 2) [mm] of an SVG file by the id of their group, and its texts, from its lower left."""
    root = ElementTree.fromstring(text)
    high = float(root.get("viewBox").split()[3])
    assert root.get("width") == f"{root.get('viewBox').split()[2]}pt"  # of its true size

    def on_paper(places):
        x, y = np.array(places, float).reshape(-1, 2).T
        return np.column_stack([x, high - y]) * POINT_MM

    lines, texts = {}, []
    (axes,) = (group for group in root.iter(f"{SVG}g") if group.get("id") == "axes_1")
    for group in axes:
        for path in group.iter(f"{SVG}path"):
            assert path.get("transform") is None and not re.search("[^-MLz0-9. \n]", path.get("d"))
            for piece in path.get("d").split("M")[1:]:
                points = on_paper(re.findall(r"-?[0-9.]+", piece))
                points = np.vstack([points, points[:1]]) if "z" in piece else points
                lines.setdefault(group.get("id"), []).append(points)
        for written in group.iter(f"{SVG}text"):
            texts.append((written.text, on_paper([written.get("x"), written.get("y")])[0]))
    return lines, texts


def pdf_pages(data):
    """Lines (K, 2) [mm] of each page of a PDF of matplotlib, from its lower left corner."""
    pages = []
    for packed in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.S):
        try:
            content = zlib.decompress(packed).decode("latin-1")
        except zlib.error:
            continue
        if not re.search(r"[0-9] l\n", content) or " d1\n" in content:  # no page, or a letter
            continue
        content = re.sub(r"BT\n.*?ET\n", "", content, flags=re.S)
        content = re.sub(r"[-0-9. ]+ cm\nQ\n", "", content)  # of letters
        assert not re.search(r" (cm|c|v|y|re)\n", re.sub(r"[-0-9. ]+ re\nW\n", "", content))
        lines, points = [], []
        for x, y, way in re.findall(r"(-?[0-9.]+) (-?[0-9.]+) ([ml])\n", content):
            if way == "m":
                points = []
                lines.append(points)
            points.append((float(x) * POINT_MM, float(y) * POINT_MM))
        pages.append([np.array(one) for one in lines if len(one) > 1])
    return pages


def apart(one, other):
    """How far [mm] two sets of lines are apart, either way."""
    sets = []
    for lines in (one, other):
        kept = [line for line in lines if np.ptp(line, axis=0).max() > 1e-9]
        sets.append(shapely.multilinestrings([shapely.linestrings(line) for line in kept]))
    return max(farthest(*sets), farthest(*sets[::-1]))


def farthest(one, other):
    """How far [mm] the farthest corner of some lines is from others."""
    shapely.prepare(other)
    return float(shapely.distance(shapely.points(shapely.get_coordinates(one)), other).max())


@pytest.mark.parametrize("case", CASES)
def test_the_svg_file_shows_what_the_dxf_file_has(case):
    _, every, _, tooled = laid_out(case)
    one = every[0]
    drawn = tooled, [(one.outline + [0.0, one.distance], 0.6 * one.length)]
    inked, written = drawn_lines(opened(tooling_drawing.dxf(*drawn)))
    shown, read = svg_lines(tooling_drawing.svg(*drawn))
    assert set(shown) - {"patch_1"} >= set(inked) and set(shown) - {"TEXT"} == set(inked) - {"TEXT"}
    # both from the corner of the track
    shift = np.min([ring.min(axis=0) for ring in shown["TRACK"]], axis=0)
    assert np.min([ring.min(axis=0) for ring in inked["TRACK"]], axis=0) == pytest.approx([0.0, 0.0])
    off = {layer: apart([line - shift for line in shown[layer]], lines) for layer, lines in inked.items()}
    assert {layer: round(size, 4) for layer, size in off.items() if size > NEAR_MM} == {}
    assert Counter(words for words, _ in read) == Counter(words for words, _ in written)
    for words, place in written:
        near = min(np.hypot(*(at - shift - place)) for other, at in read if other == words)
        assert near < 3.0, words  # on paper: numbers are centred on their lines


@pytest.mark.parametrize("case", CASES[::3])
def test_the_pdf_of_the_sheet_of_devices_shows_what_the_dxf_file_has(case):
    _, every, _, tooled = laid_out(case)
    plan, _ = chains.bowl_of(tooled, every)
    sheets = Drawing(tooling_drawing.DEVICE_PENS)
    bowl_sheet.draw_devices(sheets, plan, tooled, "part", None, "2 of 3")
    inked, _ = drawn_lines(opened(sheets.dxf()))
    pages = pdf_pages(sheets.pdf("devices"))
    for number, page in enumerate(pages):
        left = number * (A3[0] + SHEET_GAP_MM)
        here = [line - [left, 0.0] for lines in inked.values() for line in lines
                if left - 1.0 < line[:, 0].min() < left + A3[0]]  # fmt: skip
        page = [line for line in page if np.ptp(line[:, 0]) < A3[0] - 1.0]  # but for the paper
        if here:
            assert apart(page, here) < NEAR_MM
    assert pages


def unbent(points, radius):
    """Lengths along the wall and distances from it [mm] of places (K, 2) [mm], the wall tangent to X at 0."""
    x, y = points.T
    return np.column_stack([radius * np.arctan2(x, radius - y), radius - np.hypot(x, radius - y)])


@pytest.mark.parametrize("case", CASES)
def test_what_is_drawn_as_bent_is_the_unrolled_track_bent(case):
    """Each line of a layer BENT_ unbent by the radius of the wall, and its angles from the datum."""
    *_, tooled = laid_out(case)
    space, radius = opened(tooling_drawing.dxf(tooled)), tooled.track.radius / MM
    lines, _ = drawn_lines(space)
    bent = {layer.removeprefix("BENT_"): own for layer, own in lines.items() if layer.startswith("BENT_")}
    others = ("TEXT", "DIMENSION", "TABLE", "OPENING", "BORE", "OUTLINE", "CENTRE")
    flat = {layer: own for layer, own in lines.items() if not layer.startswith(("BENT_", *others))}
    assert set(bent) == set(flat)
    corner = np.min([ring.min(axis=0) for ring in bent["TRACK"]], axis=0)  # the wall, where the track begins
    for layer, own in bent.items():
        laid = [unbent(line - corner, radius) for line in own]
        wanted = [ring for ring in flat[layer] if layer != "SENSOR" or len(ring) > 2]  # but for its cross
        assert apart(laid, [fine(ring) for ring in wanted]) < NEAR_MM, layer
    spans = sorted({placed.span[0] / tooled.track.radius for placed in tooled.devices})
    angles = [one for one in space.query("DIMENSION") if one.dimtype == 5]
    measured = sorted(one.get_measurement() for one in angles)
    assert measured == pytest.approx(np.degrees([span for span in spans if span > 2e-4]), abs=0.005)
    for one in (one.dxf for one in angles):  # about the bowl's axis, from the datum
        assert np.hypot(one.defpoint4.x - corner[0], one.defpoint4.y - corner[1] - radius) < NEAR_MM
        assert abs(one.defpoint2.x - corner[0]) < NEAR_MM and one.defpoint2.y < one.defpoint4.y


def fine(line):
    """A line (K, 2) [mm] with places every tenth of a millimetre."""
    return shapely.get_coordinates(shapely.segmentize(shapely.linestrings(line), 0.1))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_the_cross_of_a_sensor_is_where_it_looks(case, scale):
    _, every, _, tooled = laid_out(case)
    if scale == 1.0:
        lines, _ = drawn_lines(opened(tooling_drawing.dxf(tooled)))
    else:
        plan, _ = chains.bowl_of(tooled, every)
        sheets = Drawing(tooling_drawing.DEVICE_PENS)
        bowl_sheet.draw_devices(sheets, plan, tooled, "part", None, "2 of 3")
        lines, _ = drawn_lines(opened(sheets.dxf()))
    low, high = (end(np.concatenate(lines["TRACK"]), axis=0) for end in (np.min, np.max))
    paper = (high - low)[1] / tooled.width  # [mm/m]
    crosses = [line for line in lines.get("SENSOR", ()) if len(line) == 2]
    middles = [
        0.5 * (one.mean(axis=0) + other.mean(axis=0)) for one, other in zip(crosses[::2], crosses[1::2])
    ]
    looked = [placed for placed in tooled.devices if placed.features.sensor is not None]
    assert len(middles) == len(looked) and all(np.ptp(line, axis=0).min() < 1e-9 for line in crosses)
    for middle, placed in zip(middles, looked):
        wanted = [placed.begin + placed.features.sensor.at, 0.5 * tooled.width]
        assert (middle - low) / paper / MM == pytest.approx(np.array(wanted) / MM, abs=NEAR_MM)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_lengths_are_measured_between_corners_of_what_is_cut(case, scale):
    """Dimensions of lengths, and not from the datum: between corners of cuts."""
    _, every, _, tooled = laid_out(case)
    if scale == 1.0:
        space = opened(tooling_drawing.dxf(tooled))
    else:
        plan, _ = chains.bowl_of(tooled, every)
        sheets = Drawing(tooling_drawing.DEVICE_PENS)
        bowl_sheet.draw_devices(sheets, plan, tooled, "part", None, "2 of 3")
        space = opened(sheets.dxf())
    lines, _ = drawn_lines(space)
    low, high = (end(np.concatenate(lines["TRACK"]), axis=0) for end in (np.min, np.max))
    paper, width = (high - low)[1] / tooled.width, tooled.width  # [mm/m]
    # corners (s, y) [m] that the track has, and cuts have within it
    end = float((high - low)[0]) / paper  # to which slots go on that are open at the outlet
    corners = [np.array([[end, 0.0], [0.0, 0.0], [0.0, width]])]
    track = shapely.box(-1.0, 0.0, end, width)
    for placed in tooled.devices:
        rings = [shapely.Polygon(own.ring).intersection(track) for own in placed.openings]
        drop = placed.drop
        if drop is not None and drop.aside > 0.0:
            ends = placed.begin, placed.begin + drop.length
            rings.append(shapely.box(ends[0], drop.aside, ends[1], width))
        corners += [shapely.get_coordinates(ring) for ring in rings]
    known, seen = np.concatenate(corners), 0
    for one in space.query("DIMENSION"):
        if one.dimtype != 0:
            continue
        across = abs(one.dxf.angle % 180.0 - 90.0) < 1e-6
        ends = np.array([(end.x, end.y) for end in (one.dxf.defpoint2, one.dxf.defpoint3)])
        ends = ((ends - low) / paper)[:, int(across)]
        off = np.abs(known[:, int(across), None] - ends).min(axis=0)
        assert off.max() / MM < NEAR_MM, one.get_measurement()
        number = one.get_measurement() * one.get_dim_style().dxf.dimlfac
        assert number == pytest.approx(np.ptp(ends) / MM, abs=NEAR_MM)
        seen += 1
    cuts = [own for placed in tooled.devices for own in placed.openings]
    assert seen >= len(cuts)
