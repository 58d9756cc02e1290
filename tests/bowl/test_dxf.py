"""Drawings of holes: read back as written, and damaged ones refused in a line."""

import itertools
import os
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import shapely
import shapely.affinity

from feederscrew import bowl as bowls
from feederscrew.base import dxf
from feederscrew.base.errors import ConfigError
from feederscrew.base.units import MM

RING = [(0.0, 0.0), (0.01, 0.0), (0.01, 0.004), (0.002, 0.006)]
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:%s\nsize 120484\n" % (b"0" * 64)
UNREADABLE = "cannot be read as DXF - save it as ASCII DXF R2000 or later"
SLOT_CORNERS = [(0.0, 0.0, 0.0), (8.5, 0.0, 1.0), (8.5, 3.5, 0.0), (0.0, 3.5, 1.0)]
SLOT = 8.5 * 3.5 + np.pi * 1.75**2  # [mm2] 12 by 3.5 mm in all, with round ends
# One unit in millimetres: BIPM, SI Brochure, and NIST SP 811, table B.8
IN_MM = {
    1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1e3, 8: 25.4e-6, 9: 0.0254, 10: 914.4, 12: 1e-6, 13: 1e-3, 14: 1e2,
    21: 304.8006096, 22: 25.4000508,
}  # fmt: skip
MANY = [(np.cos(t), np.sin(t)) for t in np.linspace(0.0, 6.28, 1500)]


def ring_file(layer="HOLE", unit=None):
    """A drawing of RING as the text of a file, its unit by its code."""
    document = dxf.new_document()
    document.modelspace().add_lwpolyline(np.array(RING) / MM, close=True, dxfattribs={"layer": layer})
    lines = dxf.document_bytes(document).decode().split("\n")
    if unit is not None:
        lines[lines.index("$INSUNITS") + 2] = str(unit)
    return "\n".join(lines)


@pytest.fixture
def rings(tmp_path):

    def call(data, layer="HOLE"):
        (tmp_path / "hole.dxf").write_bytes(data if isinstance(data, bytes) else data.encode())
        return dxf.outlines(tmp_path / "hole.dxf", layer, "bowl.yaml:3").rings

    return call


@pytest.fixture
def drawn(tmp_path):
    """What is read of a layer of a drawing that a function draws."""

    def call(draw, insunits=4):
        document = ezdxf.new("R2010", units=insunits)
        document.layers.add("HOLE")
        draw(document.modelspace(), {"layer": "HOLE"})
        document.saveas(tmp_path / "drawn.dxf")
        return dxf.outlines(tmp_path / "drawn.dxf", "HOLE", "bowl.yaml:3").rings

    return call


def test_rings_come_back_as_they_were_written(rings, caplog):
    (ring,) = rings(ring_file())
    np.testing.assert_allclose(ring, RING, rtol=1e-12, atol=1e-15)
    # Its own lines stood on stderr beside the answer: 'Found non-unique entity handle'.
    few = (Path(__file__).parents[1] / "fuzz/few.dxf").read_text()
    start, end = few.index("0\nLWPOLYLINE"), few.rindex("0\nENDSEC")
    assert len(rings(few[:end] + few[start:end] + few[end:], "CUT")) == 1
    assert caplog.records == []


UNITS = {code: ring_file(unit=code) for code in (17, 18, 20, 25, 99, -1)}


@pytest.mark.parametrize(
    ("data", "line"),
    [
        # It was a StopIteration in the reader.
        *((ring_file()[:cut], UNREADABLE) for cut in (12, 300, 3000)),
        # It was said to be no DXF: saving it as one would not help.
        (POINTER, r"is a pointer.* git LFS.*git lfs pull"),
        *((ring_file().replace("\n10.0\n", f"\n{place}\n"), "") for place in ("nan", "inf", "1e12")),
        *((text, "unit") for text in UNITS.values()),
    ],
    ids=["cut 12", "cut 300", "cut 3000", "pointer", "nan", "inf", "1e12", *map(str, UNITS)],
)
def test_a_file_that_is_refused(rings, data, line):
    with pytest.raises(ConfigError, match=rf"^bowl\.yaml:3: .*{line}"):
        rings(data)


def area(ring):
    return 1e6 * shapely.Polygon(ring).area


def slot(space, look):
    space.add_lwpolyline(SLOT_CORNERS, format="xyb", close=True, dxfattribs=look)


def slot_of_lines(space, look):
    """The same of two lines and two arcs, in no order and direction."""
    space.add_arc((8.5, 1.75), 1.75, 270, 90, dxfattribs=look)
    space.add_line((8.5, 3.5), (0.0, 3.5), dxfattribs=look)
    space.add_line((8.5, 0.0), (0.0, 0.0), dxfattribs=look)
    space.add_arc((0.0, 1.75), 1.75, 90, 270, dxfattribs=look)
    space.add_text("a slot", dxfattribs=look)


def slot_of_old_lines(space, look):
    corners = [(x, y, 0.0, 0.0, bulge) for x, y, bulge in SLOT_CORNERS]
    space.add_polyline2d(corners, format="xyseb", close=True, dxfattribs=look)


def slot_in_a_block(space, look):
    """Drawn at half the size on layer 0 of a block that a block holds; inserted at twice the size, turned."""
    inner, outer = (space.doc.blocks.new(name) for name in ("INNER", "OUTER"))
    inner.add_lwpolyline([(0.5 * x, 0.5 * y, b) for x, y, b in SLOT_CORNERS], format="xyb", close=True)
    outer.add_blockref("INNER", (1.0, 2.0), dxfattribs={"xscale": 2.0, "yscale": 2.0, "rotation": 30.0})
    space.add_blockref("OUTER", (5.0, 5.0), dxfattribs=look)


@pytest.mark.parametrize("draw", [slot, slot_of_lines, slot_of_old_lines, slot_in_a_block])
def test_round_ends_are_read_as_round(drawn, draw):
    """Read as chords without a word a slot let pass 105.5 parts a minute that it rejects."""
    (ring,) = drawn(draw)
    assert area(ring) == pytest.approx(SLOT, rel=3e-4) and area(ring) < SLOT
    round_outline = shapely.LineString([(0.0, 1.75e-3), (8.5e-3, 1.75e-3)]).buffer(1.75e-3, quad_segs=400)
    if draw is not slot_in_a_block:
        assert shapely.Polygon(ring).hausdorff_distance(round_outline) < 2.0 * dxf.CHORD_ERROR_M


def half_moon(space, look):
    """Bulges to either side: a semicircle out, a quarter in."""
    quarter = np.tan(np.pi / 8.0)
    corners = [(0.0, 0.0, 1.0), (4.0, 0.0, 0.0), (4.0, 2.0, -quarter), (2.0, 4.0, 0.0), (0.0, 4.0, 0.0)]
    space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=look)


def circle(radius, **more):
    return lambda space, look: space.add_circle((3, 4), radius, dxfattribs=look | more)


def ellipse(space, look):
    space.add_ellipse((1, 2), (4, 3), 0.5, dxfattribs=look)


@pytest.mark.parametrize(
    ("draw", "exact", "error"),
    [
        (half_moon, 16.0 + 0.5 * np.pi * 4.0 - np.pi, 6e-4), (circle(2.5), np.pi * 6.25, 6e-4),
        (circle(90), np.pi * 8100.0, 6e-4), (circle(0.01), np.pi * 1e-4, 1.2e-2),
        (ellipse, np.pi * 5.0 * 2.5, 6e-4),
        (circle(2.5, extrusion=(0, 0, -1)), np.pi * 6.25, 6e-4),
    ],
    ids=["bulges", "circle", "large", "small", "ellipse", "mirrored"],
)  # fmt: skip
def test_curves_have_the_area_of_their_closed_form(drawn, draw, exact, error):
    (ring,) = drawn(draw)
    assert area(ring) == pytest.approx(exact, rel=error)


def test_a_spline_is_read_as_it_runs(drawn):
    """A closed uniform cubic, against its basis functions: Piegl and Tiller, "The NURBS Book", ch. 2."""
    places = np.array([(0.0, 0.0), (10.0, 0.0), (12.0, 9.0), (0.0, 10.0)])
    corners = [(x, y, 0.0) for x, y in places]
    (ring,) = drawn(lambda space, look: space.add_spline(dxfattribs=look).set_closed(corners))
    t = np.linspace(0.0, 1.0, 500, endpoint=False)[:, None]
    basis = ((1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3)
    sides = [sum(b / 6.0 * places[(k + j) % 4] for j, b in enumerate(basis)) for k in range(4)]
    fine = shapely.Polygon(np.concatenate(sides))
    assert area(ring) == pytest.approx(fine.area, rel=1e-3)
    in_mm = shapely.affinity.scale(shapely.Polygon(ring), 1e3, 1e3, origin=(0, 0))
    assert fine.hausdorff_distance(in_mm) < 1e3 * dxf.CHORD_ERROR_M


@pytest.mark.parametrize("code", IN_MM)
def test_a_drawing_is_read_in_its_unit(drawn, code):
    """12 feet became 12 mm."""
    side = 12.0 / IN_MM[code]
    corners = [(0, 0), (side, 0), (side, side)]
    (ring,) = drawn(lambda space, look: space.add_lwpolyline(corners, close=True, dxfattribs=look), code)
    assert area(ring) == pytest.approx(72.0, rel=1e-6)


def nested(space, look):
    for k in range(12):
        block = space.doc.blocks.new(f"B{k}")
        for _ in range(10):
            if k:
                block.add_blockref(f"B{k - 1}", (0, 0))
            else:
                block.add_line((0, 0), (1, 1))
    space.add_blockref("B11", (0, 0), dxfattribs=look)


def line(*points):
    def draw(space, look):
        for a, b in itertools.pairwise(points):
            space.add_line(a, b, dxfattribs=look)

    return draw


def fitted(space, look):
    space.add_polyline2d([(0, 0), (5, 0), (5, 5)], close=True, dxfattribs=look | {"flags": 1 | 4})


REFUSED = {
    "open": (line((0, 0), (4, 0), (4, 4)), "open"),
    "gap": (line((0, 0), (4, 0), (4, 4), (0, 0.03)), "open"),
    "branches": (line((0, 0), (4, 0), (4, 4), (4, 0), (9, 9)), "branches"),
    "a tail": (line((0, 0), (4, 0), (4, 4), (0, 0), (-1, -1)), "open"),
    "not flat": (line((0, 0, 0), (4, 0, 0), (4, 4, 1), (0, 0, 0)), "not flat"),
    "hatch": (lambda space, look: space.add_hatch(dxfattribs=look), "HATCH"),
    "face": (lambda space, look: space.add_3dface([(0, 0), (1, 0), (1, 1)], dxfattribs=look), "3DFACE"),
    "ray": (lambda space, look: space.add_ray((0, 0), (1, 0), dxfattribs=look), "RAY"),
    "fitted": (fitted, "POLYLINE"),
    "bomb": (nested, "blocks"),
    "corners": (lambda space, look: space.add_lwpolyline(MANY, close=True, dxfattribs=look), "corners"),
    "giant": (circle(1e5), "chords"),
    "nowhere": (lambda space, look: space.add_circle((1e300, 0), 1, dxfattribs=look), "finite"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_what_is_no_flat_closed_outline_is_refused_by_name(drawn, kind):
    draw, word = REFUSED[kind]
    with pytest.raises(ConfigError, match=word) as fault:
        drawn(draw)
    assert str(fault.value).startswith("bowl.yaml:3: ") and str(fault.value).isprintable()


def test_several_outlines_and_corners_on_a_straight_side(drawn):
    def draw(space, look):
        space.add_circle((0, 0), 2, dxfattribs=look)
        space.add_lwpolyline([(0, 0), (1, 0), (2, 0), (3, 0), (3, 3), (3, 3), (0, 0)], dxfattribs=look)

    _, corner = drawn(draw)
    assert len(corner) == 3 and area(corner) == pytest.approx(4.5)


def slot_twice(space, look):
    """A slot of lines and arcs, each drawn twice, once the other way."""
    for _ in range(2):
        slot_of_lines(space, look)
    space.add_line((8.5, 0), (0, 0), dxfattribs=look)


def slot_with_gaps(space, look):
    """A slot whose arcs end 5 um before its lines."""
    for start, end in (((0.005, 0), (8.495, 0)), ((8.495, 3.5), (0.005, 3.5))):
        space.add_line(start, end, dxfattribs=look)
    space.add_arc((8.5, 1.75), 1.75, -90, 90, dxfattribs=look)
    space.add_arc((0, 1.75), 1.75, 90, 270, dxfattribs=look)


def slot_outlined_twice(space, look):
    """A slot as a polyline, and as lines and arcs that begin elsewhere."""
    slot(space, look)
    slot_of_lines(space, look)


@pytest.mark.parametrize(
    ("draw", "doubled", "gap"),
    [(slot_of_lines, 0, 0.0), (slot_twice, 5, 0.0), (slot_outlined_twice, 1, 0.0), (slot_with_gaps, 0, 5e-6)],
)
def test_what_is_drawn_twice_or_with_small_gaps_is_read(drawn, tmp_path, draw, doubled, gap):
    (ring,) = drawn(draw)
    assert area(ring) == pytest.approx(SLOT, abs=0.03)
    read = dxf.outlines(tmp_path / "drawn.dxf", "HOLE", "bowl.yaml:3")
    assert (read.doubled, read.gap) == (doubled, pytest.approx(gap, rel=1e-6))
    path = tmp_path / "bowl.yaml"
    text = "track: {width: 400 mm, radius: 500 mm}\ndevices:\n  - cut_out: {dxf: drawn.dxf, layer: HOLE}\n"
    path.write_text(text)
    said = "".join(bowls.remarks(bowls.settings(path)))
    assert ("drawn twice" in said) is (doubled > 0) and ("gaps up to 0.005 mm" in said) is (gap > 0.0)


def test_a_drawing_without_a_header_is_in_millimetres(rings):
    """As OpenSCAD 2021.01 writes it; the library that reads it supplies metres."""
    corners = [(10, 5), (20, 5), (20, 10), (10, 10)]
    sides = zip(corners, corners[1:] + corners[:1])
    lines = "".join(f"0\nLINE\n8\nHOLE\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for (a, b), (c, d) in sides)
    (ring,) = rings(f"0\nSECTION\n2\nENTITIES\n{lines}0\nENDSEC\n0\nEOF\n")
    assert area(ring) == pytest.approx(50.0)


def test_only_a_file_of_some_size_is_read(tmp_path):
    (tmp_path / "big.dxf").touch()
    os.truncate(tmp_path / "big.dxf", 1 << 40)
    os.mkfifo(tmp_path / "pipe.dxf")
    (tmp_path / "zero.dxf").symlink_to("/dev/zero")
    for name, word in (("big", "MB"), ("pipe", "regular"), ("zero", "regular")):
        with pytest.raises(ConfigError, match=word):
            dxf.outlines(tmp_path / f"{name}.dxf", "HOLE", "bowl.yaml:3")


@pytest.mark.parametrize(("code", "size"), [(0, 1.0), (4, 1.0), (1, 25.4)])
def test_a_drawing_that_names_no_unit_is_read_in_millimetres_and_that_is_said(run, tmp_path, code, size):
    """A drawing in inches without $INSUNITS was a hole of 9 mm, and nothing was said."""
    (tmp_path / "hole.dxf").write_text(ring_file("CUT", code))
    path = tmp_path / "bowl.yaml"
    text = "track: {width: 400 mm, radius: 500 mm}\ndevices:\n  - cut_out: {dxf: hole.dxf, layer: CUT}\n"
    path.write_text(text)
    settings = bowls.settings(path)
    text = f"{path}:3:20: hole.dxf names no unit ($INSUNITS), read in mm - save it in millimetres"
    assert bowls.remarks(settings) == bowls.assumptions(settings) == ((text,) if code == 0 else ())
    answer = run("slide", "--config", path, "--format", "json")
    assert answer.exit_code == 0 and ("names no unit" in answer.stderr) is (code == 0)
    (device,) = bowls.record(settings).devices
    assert np.ptp(np.array(device.corners), axis=0) == pytest.approx(size * np.ptp(np.array(RING), axis=0))
