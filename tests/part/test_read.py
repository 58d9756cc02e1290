"""Reading part files: every format, its unit, and files whose bytes do not add up."""

import io
import struct
import time
import zipfile
from pathlib import Path

import part_files as files
import pytest
import trimesh

from feederscrew.errors import FeederError
from feederscrew.part import load, scenes
from feederscrew.part.formats import detect_format

PARTS = Path(__file__).parents[2] / "parts"
BOX = files.box()
VOLUME = 6000.0  # [mm3]
AGAIN = "export the part again"
WHOLE = f"{AGAIN}, or copy the whole file"
NO_MESH = "export the part as STL, OBJ, PLY, OFF, GLB, 3MF or STEP"
FORMATS = ("stl", "stl_ascii", "obj", "ply", "off", "glb", "3mf")
NEEDS_3MF, NEEDS_STEP = pytest.mark.needs("lxml", "networkx"), pytest.mark.needs("cascadio")
EVERY_FORMAT = [pytest.param(name, marks=NEEDS_3MF if name == "3mf" else ()) for name in FORMATS]


def exported(format, triangles=BOX):
    """Bytes of a part as trimesh writes it."""
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles))
    data = mesh.export(file_type=format)
    return data if isinstance(data, bytes) else data.encode()


def mm3(part):
    return part.volume * 1e9


def suffix(format):
    return format.removesuffix("_ascii")


@pytest.mark.parametrize("format", EVERY_FORMAT)
def test_every_format_gives_the_same_box(tmp_path, format):
    path = files.written(tmp_path, exported(format), f"box.{suffix(format)}")
    part = load(path, units="mm")
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-6)
    assert (part.name, part.source, part.units) == ("box", str(path), "mm")
    assert len(part.faces) == 12
    assert len(part.vertices) == 8
    warned = ("GLB is in m by its specification; read in mm as asked for",)
    assert part.warnings == (warned if format == "glb" else ())


@pytest.mark.parametrize("format", EVERY_FORMAT)
def test_standard_input_tells_its_format_by_its_bytes(format):
    part = load("-", units="mm", stdin=io.BytesIO(exported(format)))
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-6)
    assert (part.name, part.source) == ("stdin", "-")


@pytest.mark.parametrize(
    ("format", "name", "title"),
    [
        ("stl", "box.obj", "binary STL"),
        ("stl_ascii", "box.ply", "ASCII STL"),
        ("obj", "box.stl", "OBJ"),
        ("ply", "box.stl", "PLY"),
        ("off", "box.step", "OFF"),
        pytest.param("3mf", "box.stl", "3MF", marks=NEEDS_3MF),
    ],
)
def test_content_goes_before_the_name(tmp_path, format, name, title):
    part = load(files.written(tmp_path, exported(format), name))
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-6)
    assert part.warnings == (f"named {Path(name).suffix} but its content is {title}: read as that",)


@NEEDS_STEP
def test_step_is_read_in_the_unit_it_was_drawn_in():
    part = load(PARTS / "hexbolt_m8x25.step")
    assert part.units == "mm"
    assert mm3(part) == pytest.approx(1677.1986, rel=5e-4)  # the exact B-rep's
    assert part.warnings == ()
    given = load(PARTS / "hexbolt_m8x25.step", units="in")
    assert mm3(given) == mm3(part)
    assert given.warnings == ("STEP files state their unit, here mm: the units asked for, in, are not used",)


@NEEDS_STEP
def test_step_in_inches(tmp_path):
    text = (PARTS / "hexbolt_m8x25.step").read_bytes()
    inches = text.replace(b"SI_UNIT(.MILLI.,.METRE.)", b"SI_UNIT(.CENTI.,.METRE.)")
    part = load(files.written(tmp_path, inches, "bolt.step"))
    assert part.units == "cm"
    assert part.volume == pytest.approx(1677.1986e-6, rel=5e-4)


@NEEDS_3MF
@pytest.mark.parametrize(
    ("unit", "millimetres", "ours"),
    [("inch", 25.4, "in"), ("micron", 1e-3, "um"), ("meter", 1e3, "m"), ("foot", 304.8, "in")],
)
def test_3mf_states_its_unit(tmp_path, unit, millimetres, ours):
    data = rezipped(exported("3mf", BOX / millimetres), b'unit="millimeter"', f'unit="{unit}"'.encode())
    part = load(files.written(tmp_path, data, "box.3mf"))
    assert part.units == ours
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-5)


def rezipped(data, old, new):
    """A ZIP archive with words of its members replaced."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as source, zipfile.ZipFile(out, "w") as target:
        for name in source.namelist():
            target.writestr(name, source.read(name).replace(old, new))
    return out.getvalue()


def test_instances_are_placed_and_bodies_counted(tmp_path):
    scene = trimesh.Scene()
    mesh = trimesh.creation.box((0.01, 0.02, 0.03))
    scene.add_geometry(mesh)
    one = load(files.written(tmp_path, scene.export(file_type="glb"), "one.glb"))
    assert mm3(one) == pytest.approx(VOLUME, rel=1e-5)
    turn = trimesh.transformations.translation_matrix([0.05, 0, 0])
    scene.add_geometry(mesh, transform=turn)
    path = files.written(tmp_path, scene.export(file_type="glb"), "two.glb")
    assert files.refused(path).startswith("holds 2 bodies: 1 '")
    assert files.refused(path).count("(6e-06 m3, 0.01 x 0.02 x 0.03 m)") == 2


@pytest.mark.parametrize("unit", ["mm", "cm", "m", "um", "in"])
def test_units_scale_the_part(tmp_path, unit):
    factor = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "um": 1e-6, "in": 0.0254}[unit]
    part = load(files.written(tmp_path, BOX * (1e-3 / factor)), units=unit)
    assert part.units == unit
    assert part.warnings == ()
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-6)


@pytest.mark.parametrize(
    ("scale", "units", "warning"),
    [
        (1 / 25.4, None, "the largest dimension, 1.18 mm, is small for a fed part: if the file is in inches "
         "or centimetres, pass `units` in"),
        (1e-3, None, "the largest dimension, 0.03 mm, is small for a fed part: if the file is in metres, "
         "pass `units` m"),
        (1.0, "m", "the largest dimension, 3e+04 mm, is large for a fed part: if the file is in "
         "millimetres or centimetres, pass `units` mm"),
        (1e6, None, "the largest dimension, 3e+07 mm, is large for a fed part: check its scale"),
        (1 / 25.4, "mm", None),
        (0.01, "mm", "the largest dimension, 0.3 mm, is small for a fed part: if the file is in inches or "
         "centimetres, pass `units` in"),
    ],
)  # fmt: skip
def test_unlikely_size_is_warned_of(tmp_path, scale, units, warning):
    part = load(files.written(tmp_path, BOX * scale), units=units)
    assert part.warnings == ((warning,) if warning else ())


def test_unknown_unit():
    with pytest.raises(FeederError) as error:
        load("part.stl", units="inch")
    assert str(error.value) == "units: 'inch' is not a unit of a part file - did you mean in?"


ALL = "the file has 12: all of them are read"
STL = files.binary_stl(BOX)
TEXT = files.ascii_stl(BOX)


@pytest.mark.parametrize(
    ("data", "warnings"),
    [
        (files.binary_stl(BOX, b"solid part facet normal"), ()),
        (files.binary_stl(BOX, count=0), (f"the header says 0 facets, {ALL}",)),
        (files.binary_stl(BOX, count=7), (f"the header says 7 facets, {ALL}",)),
        (files.binary_stl(BOX, count=0xFFFFFFFF), (f"the header says 4294967295 facets, {ALL}",)),
        (STL + b"\r\n", ("2 bytes after the last facet are left out",)),
        (files.ascii_stl(BOX, end="\r\n"), ()),
        (files.ascii_stl(BOX, end="\r"), ()),
        (files.ascii_stl(BOX, name="solid vertex facet endsolid"), ()),
        (b"\xef\xbb\xbf" + TEXT, ()),
        (TEXT + bytes(600), ("600 NUL bytes after the text are left out",)),
        (TEXT + bytes(70_000), ("70000 NUL bytes after the text are left out",)),
        (TEXT.upper(), ()),
        (TEXT.replace(b"solid part", "solid größe".encode("latin-1")), ()),
        (files.ascii_stl(BOX[:5], "first") + files.ascii_stl(BOX[5:], "second"), ()),
    ],
)
def test_stl_that_can_be_used(tmp_path, data, warnings):
    part = load(files.written(tmp_path, data))
    assert mm3(part) == pytest.approx(VOLUME)
    assert part.warnings == warnings


AS_UTF8 = "save it as ASCII or UTF-8 text"
UTF16 = ("utf-16", "utf-16-le", "utf-16-be")  # the first opens with a mark
GLB = exported("glb", BOX / 1000)
PLY = exported("ply")


@pytest.mark.parametrize(
    ("name", "data", "line"),
    [
        ("a.stl", b"", f"is empty - {AGAIN}"),
        ("a.stl", b"abc", f"is cut short: 3 bytes, less than an STL header - {WHOLE}"),
        ("a.stl", STL[:84], f"is cut short: 12 facets announced, 0 are there - {WHOLE}"),
        ("a.stl", STL[:300], f"is cut short: 12 facets announced, 4 are there - {WHOLE}"),
        ("a.stl", files.binary_stl(BOX, count=4_000_000_000),
         f"is cut short: 4000000000 facets announced, 12 are there - {WHOLE}"),
        ("a.stl", files.binary_stl(BOX[:0]), "has no facets - export the part again as a solid"),
        ("a.stl", b"solid x\nendsolid x\n", "has no facets - export the part again as a solid"),
        ("a.stl", TEXT[:1000], f"is cut short: the text does not end with 'endsolid' - {WHOLE}"),
        ("a.stl", TEXT.replace(b"vertex 10 0 0", b"vertex 1,000.5 0 0", 1),
         "has a comma in a number - write numbers with a decimal point"),
        ("a.stl", TEXT.replace(b"vertex 10 0 0", b"vertex 10 0", 1),
         f"has a 'vertex' line that is not three numbers - {AGAIN}"),
        ("a.stl", TEXT.replace(b"vertex 10 0 0", b"vertex 10 nan 0", 1),
         f"facet 3 of 12 has a corner that is not a finite number - {AGAIN}"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "has no facets - export the part again as a solid"),
        ("a.stl", b"<!DOCTYPE html><html></html>", f"is an HTML page, not a part - {NO_MESH}"),
        ("a.stl", b"\x89PNG\r\n\x1a\n" + bytes(200), f"is a picture, not a part - {NO_MESH}"),
        *(("a.stl", TEXT.decode().encode(code), f"is text in UTF-16 - {AS_UTF8}") for code in UTF16),
        ("a.obj", files.obj(BOX).decode().encode("utf-16"), f"is text in UTF-16 - {AS_UTF8}"),
        ("a.stl", TEXT[:1000] + bytes(100) + TEXT[1100:],
         f"is ASCII STL with NUL bytes in the middle - {NO_MESH}"),
        ("a.stl", b"%PDF-1.7\n" + bytes(200), f"is a PDF document, not a part - {NO_MESH}"),
        ("a.3mf", b"PK\x03\x04" + bytes(200), f"is a ZIP archive without a 3MF model - {NO_MESH}"),
        ("a.sldprt", b"\xd0\xcf\x11\xe0" + bytes(200),
         f"is a native CAD or Office file, which is not read - {NO_MESH}"),
        ("a.gltf", b'{"asset": {}}', f"is a JSON file (glTF is read as .glb only) - {NO_MESH}"),
        ("a.txt", b"hello\n", f"is not a mesh: it has the marks of no known format - {NO_MESH}"),
        ("a.glb", GLB[:200], f"is a damaged GLB: it announces more than it holds - {AGAIN}"),
        ("a.ply", PLY.replace(b"element vertex 8", b"element vertex 4000000000"),
         f"is a damaged PLY (it announces more than it holds) - {AGAIN}"),
        ("a.off", exported("off").replace(b"8 12 0", b"4000000000 12 0"), None),
        ("a.obj", files.obj(BOX).replace(b"f 1 2 3", b"f 1 2 300"), None),
    ],
)  # fmt: skip
def test_file_that_is_refused(tmp_path, name, data, line):
    said = files.refused(files.written(tmp_path, data, name))
    assert said == line if line else said.startswith("is a damaged ")


def test_missing_file_and_folder(tmp_path):
    assert files.refused(tmp_path / "none.stl") == "no such file - check the path"
    assert files.refused(tmp_path) == "is a folder - name a part file in it"


def test_empty_path():
    with pytest.raises(FeederError) as error:
        load("")
    assert str(error.value) == "'': is an empty path - name a part file"


@pytest.mark.parametrize(
    ("data", "name", "module", "line"),
    [
        ((PARTS / "hexbolt_m8x25.step").read_bytes(), "a.step", "cascadio",
         'STEP needs cascadio, not installed - pip install "feederscrew[step]"'),
    ],
)  # fmt: skip
def test_missing_extra_is_named(tmp_path, monkeypatch, data, name, module, line):
    found = scenes.importlib.util.find_spec
    monkeypatch.setattr(scenes.importlib.util, "find_spec", lambda m: None if m == module else found(m))
    assert files.refused(files.written(tmp_path, data, name)) == line


@NEEDS_3MF
def test_damaged_file_writes_nothing_to_stderr(tmp_path, capfd):
    for format in FORMATS:
        data = exported(format)
        files.refused(files.written(tmp_path, data[: len(data) // 2], f"a.{suffix(format)}"))
    assert capfd.readouterr() == ("", "")


def test_comments_cannot_slow_down_the_detection():
    start = time.perf_counter()
    for text in (b"/*a*/" * 10_000, b"#a\n" * 20_000, b"<!-- -->" * 8_000, b" " * 60_000):
        detect_format(text + b"x", "stl")
    assert time.perf_counter() - start < 1.0


@pytest.mark.parametrize("fault", [AttributeError, NameError, TypeError, ImportError, AssertionError])
@pytest.mark.parametrize("name", ["a.obj", "a.off", "a.glb"])
def test_a_bug_of_ours_is_not_told_as_a_damaged_file(tmp_path, monkeypatch, name, fault):
    """It was: 'is a damaged OBJ (module ... has no attribute ...)', which sends the user to his CAD."""

    def broken(*_):
        raise fault("module 'x' has no attribute 'y'")

    monkeypatch.setattr("feederscrew.part.mesh_formats.split_facets", broken)
    monkeypatch.setattr("feederscrew.part.scenes.refuse_size", broken)
    path = files.written(tmp_path, exported(name[2:]), name)
    with pytest.raises(fault, match="has no attribute"):
        load(path)


@pytest.mark.parametrize(
    "scene",
    [
        b"[]", b'{"accessors": 1}', b'{"accessors": [3]}', b'{"nodes": {"a": 1}}', b'{"nodes": [7]}',
        b'{"accessors": [{"count": [], "type": "VEC3", "componentType": 5126}]}',
        b'{"accessors": [{"count": 1, "type": [], "componentType": 5126}]}',
        b'{"nodes": [{"mesh": "a"}], "meshes": [{}]}', b'{"nodes": [{"mesh": 0}], "meshes": [3]}',
        b'{"nodes": [{"children": [[]]}]}', b'{"extensionsRequired": 1}',
    ],
)  # fmt: skip
def test_a_scene_of_other_kinds_of_values_is_a_line(tmp_path, scene):
    scene += b" " * (-len(scene) % 4)
    data = b"glTF" + struct.pack("<4I", 2, 20 + len(scene), len(scene), 0x4E4F534A) + scene
    assert files.refused(files.written(tmp_path, data, "a.glb")).startswith("is a damaged GLB (")


def test_what_trimesh_raises_of_any_class_is_a_damaged_file(tmp_path, monkeypatch):
    def broken(*_, **__):
        raise AttributeError("'NoneType' object has no attribute 'faces'")

    monkeypatch.setattr("trimesh.load_scene", broken)
    line = f"is a damaged GLB (its scene does not fit what it holds) - {AGAIN}"
    assert files.refused(files.written(tmp_path, GLB, "a.glb")) == line
