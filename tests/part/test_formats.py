"""Part files as programs write them, and damaged ones: each one line in words for the user, at no cost."""

import io
import json
import re
import struct
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import trimesh
from readings import AGAIN, BOX, archived, exported, loaded, mm3, refused, zipped

from feederscrew import bowl
from feederscrew.base.errors import FeederError, MeshError
from feederscrew.part import formats, load, loading, step
from feederscrew.part.formats import detect_format
from feederscrew_cli.aspects import aspects as aspects_command
from feederscrew_cli.aspects import inertia as inertia_command

BOLT = Path(__file__).parents[2] / "parts/hexbolt_m8x25.step"
NEEDS_3MF, NEEDS_STEP = pytest.mark.needs("lxml", "networkx"), pytest.mark.needs("cascadio")

# An L of 10 x 6 x 4 mm, its section concave: 156 mm3. Sides are given as a CAD program has them.
SECTION = [(0, 0), (10, 0), (10, 3), (3, 3), (3, 6), (0, 6)]
CORNERS = [(x, y, z) for z in (0, 4) for x, y in SECTION]
AROUND = [(k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
SIDES = [(5, 4, 3, 2, 1, 0), (6, 7, 8, 9, 10, 11), *AROUND]
FAN = [(side[0], side[k], side[k + 1]) for side in AROUND for k in (1, 2)]
CAPS = [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 5, 4)]
FACETS = FAN + CAPS + [(6 + c, 6 + b, 6 + a) for a, b, c in CAPS]
VOLUME = 156.0  # [mm3]
SMALL, LARGE = "{} mm, is small for a fed part: if the file is in", "{} mm, is large for a fed part: "
INCHES = " inches or centimetres, pass `units` in"
ALL = "the file has 12: all of them are read"
TEXT = files.ascii_stl(BOX)


def ply(order, rows="<", extra=""):
    """A PLY of the L with its sides as they are; vertices have a colour, facets a flag."""
    head = (
        f"ply\nformat {order} 1.0\ncomment as scanners write it\nelement vertex 12\nproperty float x\n"
        "property uchar red\nproperty double y\nproperty float z\nelement face 8\n"
        f"property list uchar int vertex_indices\nproperty uchar flag\n{extra}end_header\n"
    )
    if order == "ascii":
        lines = [f"{x} 255 {y} {z}" for x, y, z in CORNERS]
        return head + "\n".join([*lines, *(f"{len(s)} {' '.join(map(str, s))} 7" for s in SIDES)]) + "\n"
    body = b"".join(struct.pack(f"{rows}fBdf", x, 255, y, z) for x, y, z in CORNERS)
    return head.encode() + body + b"".join(struct.pack(f"{rows}B{len(s)}iB", len(s), *s, 7) for s in SIDES)


def off(head="OFF\n12 8 0\n", between="\n", colour="", normal=""):
    corners = [f"{x} {y} {z}{normal}" for x, y, z in CORNERS]
    sides = [f"{len(s)} {' '.join(map(str, s))}{colour}" for s in SIDES]
    return head + between.join([*corners, *sides]) + "\n"


def obj(begins, minus=False):
    """An OBJ of the L with its sides as they are; ``begins`` is the first index."""
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS]
    sides = [[k - 12 if minus else k + begins for k in side] for side in SIDES]
    return "\n".join([*lines, *("f " + " ".join(f"{k}//1" for k in side) for side in sides)]) + "\n"


def text_stl(sides=FACETS, name="L", end="\n", comma=False, last=True):
    lines = [f"solid {name}"]
    for side in sides:
        corners = ["vertex {:.3f} {:.3f} {:.3f}".format(*CORNERS[k]) for k in side]
        corners = [line.replace(".", ",") for line in corners] if comma else corners
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    return end.join([*lines, *([f"endsolid {name}"] if last else [])]) + "\n"


@pytest.mark.parametrize(
    ("format", "other", "title"),
    [
        ("stl", "obj", "binary STL"), ("stl_ascii", "ply", "ASCII STL"), ("obj", "stl", "OBJ"),
        ("ply", "stl", "PLY"), ("off", "step", "OFF"), ("glb", "stl", "GLB"),
        pytest.param("3mf", "stl", "3MF", marks=NEEDS_3MF),
    ],
)  # fmt: skip
def test_every_format_gives_the_same_box_and_content_goes_before_the_name(tmp_path, format, other, title):
    data, own = exported(format), format.removesuffix("_ascii")
    unit = ("GLB is in m by its specification; read in mm as asked for",) if format == "glb" else ()
    misnamed = f"named .{other} but its content is {title}: read as that"
    for suffix, warned in ((own, unit), (other, (misnamed, *unit)), ("", unit)):
        path = files.written(tmp_path, data, f"box.{suffix}") if suffix else "-"
        part = load(path, units="mm", stdin=None if suffix else io.BytesIO(data))
        assert mm3(part) == pytest.approx(6000.0, rel=1e-6)
        assert (part.name, part.source, part.units) == ("box" if suffix else "stdin", str(path), "mm")
        assert (len(part.faces), len(part.vertices), part.warnings) == (12, 8, warned)


@NEEDS_STEP
def test_step_is_read_in_the_unit_it_was_drawn_in(tmp_path):
    """2019.2529 mm3 is the exact B-rep's."""
    path = tmp_path / "bolt.stpz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(BOLT, "bolt.stp")
    ignored = "STEP files state their unit, here mm: the units asked for, in, are not used"
    for part, warned in ((load(path), ()), (load(BOLT, units="in"), (ignored,))):
        assert (part.units, part.warnings) == ("mm", warned)
        assert mm3(part) == pytest.approx(2019.2529, rel=5e-4)
    larger = loaded(BOLT.read_bytes().replace(b"SI_UNIT(.MILLI.,.METRE.)", b"SI_UNIT(.CENTI.,.METRE.)"))
    assert (larger.units, larger.volume) == ("cm", pytest.approx(2019.2529e-6, rel=5e-4))


@NEEDS_3MF
@pytest.mark.parametrize(
    ("unit", "millimetres", "ours"),
    [("inch", 25.4, "in"), ("micron", 1e-3, "um"), ("meter", 1e3, "m"), ("foot", 304.8, "in")],
)
def test_3mf_states_its_unit(unit, millimetres, ours):
    with zipfile.ZipFile(io.BytesIO(exported("3mf", BOX / millimetres))) as source:
        members = {name: source.read(name) for name in source.namelist()}
    own = {k: text.replace(b'unit="millimeter"', f'unit="{unit}"'.encode()) for k, text in members.items()}
    part = loaded(zipped(own))
    assert (part.units, mm3(part)) == (ours, pytest.approx(6000.0, rel=1e-5))


def test_instances_are_placed_and_bodies_counted():
    scene, mesh = trimesh.Scene(), trimesh.creation.box((0.01, 0.02, 0.03))
    scene.add_geometry(mesh)
    assert mm3(loaded(scene.export(file_type="glb"))) == pytest.approx(6000.0, rel=1e-5)
    scene.add_geometry(mesh, transform=trimesh.transformations.translation_matrix([0.05, 0, 0]))
    line = refused(scene.export(file_type="glb"))
    assert line.startswith("holds 2 bodies: 1 '")
    assert line.count("(6e-06 m3, 0.01 x 0.02 x 0.03 m)") == 2


@pytest.mark.parametrize(
    ("scale", "units", "warning"),
    [
        *((1e-3 / metres, unit, None) for unit, metres in
          {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "um": 1e-6, "in": 0.0254}.items()),
        (1 / 25.4, None, SMALL.format("1.18") + INCHES),
        (1e-3, None, SMALL.format("0.03") + " metres, pass `units` m"),
        (1.0, "m", LARGE.format("3e+04") + "if the file is in millimetres or centimetres, pass `units` mm"),
        (1e6, None, LARGE.format("3e+07") + "check its scale"),
        (1 / 25.4, "mm", None),
        (0.01, "mm", SMALL.format("0.3") + INCHES),
    ],
)  # fmt: skip
def test_units_scale_the_part_and_an_unlikely_size_is_warned_of(scale, units, warning):
    part = loaded(files.binary_stl(BOX * scale), units=units)
    assert part.units == (units or "mm")
    assert part.warnings == ((f"the largest dimension, {warning}",) if warning else ())
    metres = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "um": 1e-6, "in": 0.0254}[part.units]
    assert part.volume == pytest.approx(6000.0 * (scale * metres) ** 3, rel=1e-6)


@pytest.mark.parametrize(
    ("data", "warnings"),
    [
        (files.binary_stl(BOX, b"solid part facet normal"), ()),
        *((files.binary_stl(BOX, count=count), (f"the header says {count} facets, {ALL}",))
          for count in (0, 7, 0xFFFFFFFF)),
        (files.binary_stl(BOX) + b"\r\n", ("2 bytes after the last facet are left out",)),
        (files.ascii_stl(BOX, end="\r\n"), ()),
        (files.ascii_stl(BOX, end="\r"), ()),
        (files.ascii_stl(BOX, name="solid vertex facet endsolid"), ()),
        (b"\xef\xbb\xbf" + TEXT, ()),
        *((TEXT + bytes(count), (f"{count} NUL bytes after the text are left out",))
          for count in (600, 70_000)),
        (TEXT.upper(), ()),
        (TEXT.replace(b"solid part", "solid größe".encode("latin-1")), ()),
    ],
)  # fmt: skip
def test_stl_that_can_be_used(data, warnings):
    part = loaded(data)
    assert mm3(part) == pytest.approx(6000.0)
    assert part.warnings == warnings


FACETS_OF_ANY_SIZE = {
    "little": ply("binary_little_endian"), "big": ply("binary_big_endian", ">"), "text": ply("ascii"),
    "edges": ply("binary_little_endian", extra="element edge 0\nproperty int vertex1\n"),
    "off": off(), "one head": off("OFF 12 8 0\n"), "one line": off("OFF 12 8 0 ", " "),
    "colours": off("COFF\n# with colours\n12 8 0\n", colour=" 3 255 0 0"),
    "normals": off("NOFF\n12 8 0\n", normal=" 0 0 1"),
    "obj": obj(1), "relative": obj(1, minus=True), "continued": obj(1).replace("v 10 0 0", "v 10 \\\n0 0"),
}  # fmt: skip


@pytest.mark.parametrize("name", FACETS_OF_ANY_SIZE)
def test_facets_of_several_sizes_keep_their_outline(name):
    """The section is concave: a fan from its first corner would enclose 156 mm3 of other shape or none."""
    part = loaded(FACETS_OF_ANY_SIZE[name])
    assert (mm3(part), part.hull.volume * 1e9) == pytest.approx((VOLUME, 198.0))
    assert part.warnings == ()


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_strips_of_ply(order):
    """Strips, each begun by -1 or a row of its own; each other triangle runs the other way round."""
    # a box of 10 x 6 x 4: round its walls, and each cap
    corners = [(x, y, z) for z in (0.0, 4.0) for x, y in ((0, 0), (10, 0), (10, 6), (0, 6))]
    walls, caps = [4, 0, 5, 1, 6, 2, 7, 3, 4, 0], [0, 3, 1, 2, -1, 4, 5, 7, 6]
    head = (
        f"ply\nformat {order} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
    )
    rows = [len(walls), *walls, len(caps), *caps]
    if order == "ascii":
        data = (head + " ".join(map(str, (*(c for row in corners for c in row), *rows)))).encode()
    else:
        end = "<" if "little" in order else ">"
        data = head.encode() + np.array(corners, end + "f4").tobytes() + np.array(rows, end + "i4").tobytes()
    part = loaded(data)
    assert (mm3(part), len(part.faces), part.warnings) == (pytest.approx(240.0), 12, ())


def test_a_concave_quadrilateral_is_split_within_its_outline():
    arrow = [(0, 0), (8, 4), (0, 8), (3, 4)]  # the last corner points inwards; area 20
    corners = [(x, y, z) for z in (0, 5) for x, y in arrow]
    sides = [(3, 2, 1, 0), (4, 5, 6, 7), *((k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4))]
    for turn in range(4):
        rows = [side[turn:] + side[:turn] for side in sides]
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        text += "".join("f " + " ".join(str(k + 1) for k in side) + "\n" for side in rows)
        assert mm3(loaded(text)) == pytest.approx(100.0)


TEXTS = {
    "no end": (text_stl(last=False), "endsolid"),
    "one line": (text_stl(end=" "), None),
    "hash": (text_stl(end=" ", name="bolt #3"), None),
    "one line, no end": (text_stl(end=" ", last=False), "endsolid"),
    "comment": ("# made by hand\n" + text_stl(), None),
    "comments": (text_stl().replace("outer loop\n", "outer loop  # a facet\n; and a line\n", 3), None),
    "commas": (text_stl(comma=True), "comma"),
    "quads": (text_stl(AROUND + CAPS + FACETS[-4:]), "four corners"),
    "n-gons": (text_stl(SIDES), "more than three corners"),
    "two": (text_stl(FACETS[:9]) + text_stl(FACETS[9:]), None),
    "two, one end": (text_stl(FACETS[:9], last=False) + text_stl(FACETS[9:], "two"), None),
    "two in a line": (text_stl(FACETS[:9], end=" ")[:-1] + " " + text_stl(FACETS[9:], end=" "), None),
    "obj, commas": (obj(1).replace("v 10 0 0", "v 10,0 0 0"), "comma"),
    "off, commas": (off().replace("10 0 0", "10,0 0 0", 1), "comma"),
    "ply, commas": (ply("ascii").replace("10 255", "10,0 255", 1), "comma"),
    "obj from 0": (obj(0), "from 0"),
    "fortran": (text_stl().replace("10.000", "1.0D+01").replace("6.000", "0.6d1"), "exponents of D"),
    "obj, fortran": (obj(1).replace("v 10 0 0", "v 1D1 0 0"), "exponents of D"),
}


@pytest.mark.parametrize("name", TEXTS)
def test_texts_as_people_have_them(name):
    data, word = TEXTS[name]
    part = loaded(data)
    assert mm3(part) == pytest.approx(VOLUME)
    assert len(part.warnings) == (word is not None)
    assert word is None or word in part.warnings[0]


@pytest.mark.parametrize(
    ("data", "word"),
    [
        *((text_stl(last=False)[:cut], "cut short") for cut in (-60, -40, -16)),
        (text_stl().replace("10.000", "1,000.0"), "comma"),
        (text_stl().replace("10.000", "10,0", 1), "comma"),
        (text_stl().replace(".000", "").replace("vertex 10 ", "vertex 1,000 "), "comma"),
        (obj(1).replace("f 1//1", "f 0//1", 1), "from 1"),
    ],
)
def test_texts_that_could_be_read_in_two_ways_are_refused(data, word):
    assert word in refused(data)


def test_texts_of_a_file_are_printable(tmp_path):
    """Escapes in names, numbers and metadata reach no terminal."""
    data = obj(1).replace("v 10 0 0", "v 10 \x1b[31m0 0", 1)
    with pytest.raises(FeederError) as caught:
        load(files.written(tmp_path, data.encode(), "red\x1b[31m.obj"))
    assert str(caught.value).isprintable()
    assert load(files.written(tmp_path, obj(1).encode(), "red\x1b[31m.obj")).name.isprintable()


PARTS = Path(__file__).parents[2] / "parts"
WHOLE = f"{AGAIN}, or copy the whole file"
NO_MESH = "export the part as STL, OBJ, PLY, OFF, GLB, 3MF or STEP"
STL, ASCII = files.binary_stl(BOX), files.ascii_stl(BOX)
GLB, PLY = exported("glb", BOX / 1000), exported("ply")
AS_UTF8 = "is text in UTF-16 - save it as ASCII or UTF-8 text"
OF_CAD = (  # heads of files that are no mesh, and what they are
    (b"DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\n", "a BREP file"),
    (b"\nOpen CASCADE Topology V3 (c)\n\0\1", "a BREP file"),
    (b"part".ljust(72) + b"S      1\n1H,,1H;,4Hpart".ljust(75) + b"G      1\n", "an IGES file"),
    (b"**ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz****\n", "a Parasolid file"),
    (b"400 0 1 0\n16 Autodesk AutoCAD 19 ASM 221 0 24 Mon\n", "an ACIS file (SAT)"),
    (b"Version 9.5 JT  DM 6.0.0.0".ljust(80) + bytes(20), "a JT file"),
    (b"#VRML V2.0 utf8\nShape{}\n", "a VRML file"),
)
UTF16 = ("utf-16", "utf-16-le", "utf-16-be")  # the first opens with a mark
SHORT, NO_FACETS = "is cut short:", "has no facets - export the part again as a solid"
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:%s\nsize 120484\n" % (b"0" * 64)
UNREADABLE, MISSING = "a value in it cannot be read", "something in it is missing"
MESH = [{"mesh": 0}]
CHAIN = [{"mesh": 0, "children": [k + 1]} for k in range(5000)] + MESH
HEAD = (
    "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
    "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n"
)


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (b"", f"is empty - {AGAIN}"),
        (b"abc", f"{SHORT} 3 bytes, less than an STL header - {WHOLE}"),
        (STL[:84], f"{SHORT} 12 facets announced, 0 are there - {WHOLE}"),
        (STL[:300], f"{SHORT} 12 facets announced, 4 are there - {WHOLE}"),
        (files.binary_stl(BOX, count=10**9), f"{SHORT} {10**9} facets announced, 12 are there - {WHOLE}"),
        (files.binary_stl(BOX[:0]), NO_FACETS),
        (b"solid x\nendsolid x\n", NO_FACETS),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", NO_FACETS),
        (ASCII[:1000], f"{SHORT} the text does not end with 'endsolid' - {WHOLE}"),
        (ASCII.replace(b"vertex 10 0 0", b"vertex 1,000.5 0 0", 1),
         "has a comma in a number - write numbers with a decimal point"),
        (ASCII.replace(b"vertex 10 0 0", b"vertex 10 0", 1),
         f"has a 'vertex' line that is not three numbers - {AGAIN}"),
        (ASCII.replace(b"vertex 10 0 0", b"vertex 10 nan 0", 1),
         f"facet 3 of 12 has a corner that is not a finite number - {AGAIN}"),
        (b"<!DOCTYPE html><html></html>", f"is an HTML page, not a part - {NO_MESH}"),
        (b"\x89PNG\r\n\x1a\n" + bytes(200), f"is a picture, not a part - {NO_MESH}"),
        *((ASCII.decode().encode(code), AS_UTF8) for code in UTF16),
        (files.obj(BOX).decode().encode("utf-16"), AS_UTF8),
        *((ASCII.decode().encode(code), AS_UTF8.replace("16", "32")) for code in ("utf-32", "utf-32-be")),
        *((head, f"is {kind}, which is not read - {NO_MESH}") for head, kind in OF_CAD),
        (b"  0\nSECTION\n  2\nENTITIES\n", f"is a DXF file, a drawing and not a part - {NO_MESH}"),
        (ASCII[:1000] + bytes(100) + ASCII[1100:], f"is ASCII STL with NUL bytes in the middle - {NO_MESH}"),
        (b"%PDF-1.7\n" + bytes(200), f"is a PDF document, not a part - {NO_MESH}"),
        (b"PK\x03\x04" + bytes(200), f"is a ZIP archive without a 3MF model - {NO_MESH}"),
        (b"\xd0\xcf\x11\xe0" + bytes(200), f"is a native CAD or Office file, which is not read - {NO_MESH}"),
        (b'{"asset": {}}', f"is a JSON file (glTF is read as .glb only) - {NO_MESH}"),
        (GLB[:200], f"is a damaged GLB (it announces more than it holds) - {AGAIN}"),
        (PLY.replace(b"element vertex 8", b"element vertex 4000000000"),
         f"is a damaged PLY (it announces more than it holds) - {AGAIN}"),
        (exported("off").replace(b"8 12 0", b"4000000000 12 0"), None),
        (files.obj(BOX).replace(b"f 1 2 3", b"f 1 2 300"), None),
    ],
)  # fmt: skip
def test_file_that_is_refused(tmp_path, data, line):
    text = files.refused(files.written(tmp_path, data))
    assert text == line if line else text.startswith("is a damaged ")


def test_every_format_is_named_where_a_part_is_asked_for():
    """In the line of a file that is none, in the help of commands and library, in the README."""
    helps = [command.help for command in (aspects_command, inertia_command)]
    readme = (PARTS.parent / "README.md").read_text()
    (line,) = (line for line in readme.splitlines() if line.startswith("- **Part:**"))
    for text in (NO_MESH, *helps, load.__doc__, line):
        assert [name for name in formats.MESH_NAMES if not re.search(rf"\b{name}\b", text)] == []


def test_paths_without_a_part(tmp_path):
    assert files.refused(tmp_path / "none.stl") == "no such file - check the path"
    assert files.refused(tmp_path) == "is a folder - name a part file in it"
    line = f"is not a mesh: it has the marks of no known format - {NO_MESH}"
    assert files.refused(files.written(tmp_path, b"hello\n", "a.txt")) == line
    unit = "units: 'inch' is not a unit of a part file - did you mean in?"
    for own, line in ((("", None), "'': is an empty path - name a part file"), (("part.stl", "inch"), unit)):
        with pytest.raises(FeederError) as error:
            load(own[0], units=own[1])
        assert str(error.value) == line


def test_missing_extra_is_named(tmp_path, monkeypatch):
    find = step.importlib.util.find_spec
    monkeypatch.setattr(step.importlib.util, "find_spec", lambda m: None if m == "cascadio" else find(m))
    line = 'STEP needs cascadio, not installed - pip install "feederscrew[step]"'
    assert refused((PARTS / "hexbolt_m8x25.step").read_bytes()) == line


@NEEDS_3MF
def test_damaged_file_writes_nothing_to_stderr(capfd):
    for format in ("stl", "stl_ascii", "obj", "ply", "off", "glb", "3mf"):
        data = exported(format)
        refused(data[: len(data) // 2])
    assert capfd.readouterr() == ("", "")


def test_comments_cannot_slow_down_the_detection():
    start = time.perf_counter()
    for text in (b"/*a*/" * 10_000, b"#a\n" * 20_000, b"<!-- -->" * 8_000, b" " * 60_000):
        detect_format(text + b"x", "stl")
    assert time.perf_counter() - start < 1.0


@pytest.mark.parametrize("name", ["l.stl", "l.step", "l.3mf", "l.glb", "l.obj", "card.yaml", "bowl.yaml"])
def test_a_pointer_of_git_lfs_is_named(tmp_path, name):
    with pytest.raises(FeederError, match=r"git LFS.*git lfs pull"):
        (bowl.read if name == "bowl.yaml" else load)(files.written(tmp_path, POINTER, name))


def boxed(scene, binary=None):
    text = scene if isinstance(scene, bytes) else json.dumps({"asset": {"version": "2.0"}} | scene).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text
    if binary is not None:
        chunks += struct.pack("<2I", len(binary), 0x004E4942) + binary
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


def triangle(vertex='x="1" y="0" z="0"', item='objectid="1"'):
    return archived(
        '<model><resources><object id="1"><mesh><vertices>'
        f'<vertex x="0" y="0" z="0"/><vertex {vertex}/><vertex x="0" y="1" z="0"/></vertices><triangles>'
        '<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>'
        f"<build><item {item}/></build></model>"
    )


def locked(data):
    """An archive whose members say that a password locks them."""
    version = b"PK\x01\x02\x14\x03\x14\x00"
    return data.replace(version + b"\x00\x00", version + b"\x01\x00")


@pytest.mark.parametrize(
    ("title", "data", "reason"),
    [
        ("3MF", triangle('x="one" y="0" z="0"'), UNREADABLE),
        ("3MF", triangle('x="1" y="0"'), MISSING),
        ("3MF", triangle(item='objectid="7"'), MISSING),
        ("3MF", triangle(item='objectid="1" transform="1 0 0"'), "a transform of 3 numbers, not of 12"),
        ("3MF", triangle()[:-30], "its archive is damaged"),
        ("3MF", locked(triangle()), "its archive is locked by a password"),
        ("GLB", boxed(b"{,}"), "its scene is no JSON"),
        ("GLB", boxed(b'{"nodes": [null]}'), "its scene has null out of place"),
        ("GLB", boxed(b'{"nodes": [{"mesh": 3}]}'), MISSING),
        ("PLY", PLY.replace(b"property float x", b"property real x"), MISSING),
        ("OFF", exported("off").replace(b"8 12 0", b"8 o2 0"), UNREADABLE),
    ],
)  # fmt: skip
def test_a_damaged_file_is_refused_in_words_for_its_user(title, data, reason):
    assert refused(data) == f"is a damaged {title} ({reason}) - {AGAIN}"


@pytest.mark.parametrize("fault", [AttributeError, NameError, TypeError, ImportError, AssertionError])
@pytest.mark.parametrize("format", ["obj", "off", "glb"])
def test_a_bug_of_ours_is_not_told_as_a_damaged_file(monkeypatch, format, fault):
    """It was: 'is a damaged OBJ (module ... has no attribute ...)', which sends the user to his CAD."""

    def broken(*_):
        raise fault("module 'x' has no attribute 'y'")

    monkeypatch.setattr("feederscrew.part.mesh_formats.split_facets", broken)
    monkeypatch.setattr("feederscrew.part.glb.refuse_size", broken)
    with pytest.raises(fault, match="has no attribute"):
        load("-", stdin=io.BytesIO(exported(format)))


def scene(count, nodes, binary=bytes(1200), **accessor):
    parts = {
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": count, "type": "VEC3", **accessor}],
        "bufferViews": [{"buffer": 0, "byteLength": 1200}], "buffers": [{"byteLength": 1200}],
    }  # fmt: skip
    return boxed(parts, binary)


@pytest.mark.parametrize(
    "data",
    [
        scene(10**9, MESH, b""), scene(10**12, MESH, bufferView=0), scene(-5, MESH, bufferView=0),
        scene(10**9, MESH, sparse={"count": 1}), scene(99, CHAIN, bufferView=0),
        scene(99, [{"mesh": 0, "children": [0]}], bufferView=0),
        scene(99, MESH * 30_000, bufferView=0), HEAD.format(10**20, 1).encode(),
        HEAD.format(3, 9_000_000).encode() + bytes(9_000_036), b"OFF\n99999999999999999999 1 0\n0 0 0\n",
        b"OFF\n-5 5 0\n0 0 0\n",
    ],
    ids=["no view", "view", "less", "sparse", "chain", "loop", "many", "ply", "facets", "off", "minus"],
)  # fmt: skip
def test_claims_of_a_header_are_refused_in_a_line(data):
    refused(data)


@pytest.mark.needs("cascadio")
def test_a_step_file_that_takes_too_long_is_refused(monkeypatch):
    monkeypatch.setattr(step, "STEP_TIMEOUT_S", 1)
    monkeypatch.setattr(step, "CONVERT_STEP_SCRIPT", "import time; time.sleep(30)")
    assert refused(b"ISO-10303-21;") == f"is a damaged STEP (not converted within 1 s) - {AGAIN}"


def test_a_stream_without_end_is_given_up_at_half_a_gigabyte(monkeypatch):
    """It was read up to 1 GB, which took 1.09 GB."""

    class Endless(io.RawIOBase):
        given = 0

        def read(self, count):
            self.given += count
            return bytes(count)

    assert loading.MAX_MESH_BYTES == 512 << 20
    monkeypatch.setattr(loading, "MAX_MESH_BYTES", 3 << 20)
    stream = Endless()
    with pytest.raises(MeshError, match="standard input: is larger than 3 MB - export it with fewer facets"):
        load("-", stdin=stream)
    assert stream.given == (3 << 20) + 1


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for it")
def test_the_converter_of_step_ends_with_its_parent():
    waits = step.CONVERT_STEP_SCRIPT.partition("import cascadio")[0]
    waits += "print(1, flush=True); import time; time.sleep(50)"
    parent = (
        "import subprocess, sys, time;"
        "child = subprocess.Popen([sys.executable, '-c', sys.argv[1]], stdout=subprocess.PIPE);"
        "child.stdout.readline(); print(child.pid, flush=True); time.sleep(50)"
    )
    call = [sys.executable, "-c", parent, waits]
    with subprocess.Popen(call, stdout=subprocess.PIPE, text=True) as process:
        stat = Path(f"/proc/{int(process.stdout.readline())}/stat")
        process.kill()
    for _ in range(50):  # within five seconds; a process that nobody waited for counts as ended
        if not stat.exists() or stat.read_text().rsplit(")", 1)[1].split()[0] == "Z":
            return
        time.sleep(0.1)
    pytest.fail("the converter goes on")
