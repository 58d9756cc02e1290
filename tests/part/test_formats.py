"""Part files as programs write them: each format, its unit, facets of any size, texts without ends."""

import io
import struct
import zipfile
from pathlib import Path

import part_files as files
import pytest
import trimesh
from readings import BOX, exported, loaded, mm3, refused, zipped

from feederscrew.errors import FeederError
from feederscrew.part import load

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
    """An OFF of the L with its sides as they are."""
    corners = [f"{x} {y} {z}{normal}" for x, y, z in CORNERS]
    sides = [f"{len(s)} {' '.join(map(str, s))}{colour}" for s in SIDES]
    return head + between.join([*corners, *sides]) + "\n"


def obj(begins, minus=False):
    """An OBJ of the L with its sides as they are; ``begins`` is the first index."""
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS]
    sides = [[k - 12 if minus else k + begins for k in side] for side in SIDES]
    return "\n".join([*lines, *("f " + " ".join(f"{k}//1" for k in side) for side in sides)]) + "\n"


def text_stl(sides=FACETS, name="L", end="\n", comma=False, last=True):
    """A text STL of the L."""
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
    """1677.1986 mm3 is the exact B-rep's."""
    path = tmp_path / "bolt.stpz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(BOLT, "bolt.stp")
    ignored = "STEP files state their unit, here mm: the units asked for, in, are not used"
    for part, warned in ((load(path), ()), (load(BOLT, units="in"), (ignored,))):
        assert (part.units, part.warnings) == ("mm", warned)
        assert mm3(part) == pytest.approx(1677.1986, rel=5e-4)
    larger = loaded(BOLT.read_bytes().replace(b"SI_UNIT(.MILLI.,.METRE.)", b"SI_UNIT(.CENTI.,.METRE.)"))
    assert (larger.units, larger.volume) == ("cm", pytest.approx(1677.1986e-6, rel=5e-4))


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


def test_unknown_unit():
    with pytest.raises(FeederError) as error:
        load("part.stl", units="inch")
    assert str(error.value) == "units: 'inch' is not a unit of a part file - did you mean in?"


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
