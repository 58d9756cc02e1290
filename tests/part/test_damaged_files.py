"""Part files that do not add up or claim too much: each one line in words for the user, at no cost."""

import io
import json
import struct
import subprocess
import sys
import time
from pathlib import Path

import part_files as files
import pytest
from readings import AGAIN, BOX, archived, exported, refused

from feederscrew import bowl
from feederscrew.errors import FeederError, MeshError
from feederscrew.part import load, loading, scenes
from feederscrew.part.formats import detect_format

PARTS = Path(__file__).parents[2] / "parts"
WHOLE = f"{AGAIN}, or copy the whole file"
NO_MESH = "export the part as STL, OBJ, PLY, OFF, GLB, 3MF or STEP"
NEEDS_3MF = pytest.mark.needs("lxml", "networkx")
STL, TEXT = files.binary_stl(BOX), files.ascii_stl(BOX)
GLB, PLY = exported("glb", BOX / 1000), exported("ply")
AS_UTF8 = "is text in UTF-16 - save it as ASCII or UTF-8 text"
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
        (TEXT[:1000], f"{SHORT} the text does not end with 'endsolid' - {WHOLE}"),
        (TEXT.replace(b"vertex 10 0 0", b"vertex 1,000.5 0 0", 1),
         "has a comma in a number - write numbers with a decimal point"),
        (TEXT.replace(b"vertex 10 0 0", b"vertex 10 0", 1),
         f"has a 'vertex' line that is not three numbers - {AGAIN}"),
        (TEXT.replace(b"vertex 10 0 0", b"vertex 10 nan 0", 1),
         f"facet 3 of 12 has a corner that is not a finite number - {AGAIN}"),
        (b"<!DOCTYPE html><html></html>", f"is an HTML page, not a part - {NO_MESH}"),
        (b"\x89PNG\r\n\x1a\n" + bytes(200), f"is a picture, not a part - {NO_MESH}"),
        *((TEXT.decode().encode(code), AS_UTF8) for code in UTF16),
        (files.obj(BOX).decode().encode("utf-16"), AS_UTF8),
        (TEXT[:1000] + bytes(100) + TEXT[1100:], f"is ASCII STL with NUL bytes in the middle - {NO_MESH}"),
        (b"%PDF-1.7\n" + bytes(200), f"is a PDF document, not a part - {NO_MESH}"),
        (b"PK\x03\x04" + bytes(200), f"is a ZIP archive without a 3MF model - {NO_MESH}"),
        (b"\xd0\xcf\x11\xe0" + bytes(200), f"is a native CAD or Office file, which is not read - {NO_MESH}"),
        (b'{"asset": {}}', f"is a JSON file (glTF is read as .glb only) - {NO_MESH}"),
        (GLB[:200], f"is a damaged GLB: it announces more than it holds - {AGAIN}"),
        (PLY.replace(b"element vertex 8", b"element vertex 4000000000"),
         f"is a damaged PLY (it announces more than it holds) - {AGAIN}"),
        (exported("off").replace(b"8 12 0", b"4000000000 12 0"), None),
        (files.obj(BOX).replace(b"f 1 2 3", b"f 1 2 300"), None),
    ],
)  # fmt: skip
def test_file_that_is_refused(tmp_path, data, line):
    text = files.refused(files.written(tmp_path, data))
    assert text == line if line else text.startswith("is a damaged ")


def test_paths_without_a_part(tmp_path):
    assert files.refused(tmp_path / "none.stl") == "no such file - check the path"
    assert files.refused(tmp_path) == "is a folder - name a part file in it"
    line = f"is not a mesh: it has the marks of no known format - {NO_MESH}"
    assert files.refused(files.written(tmp_path, b"hello\n", "a.txt")) == line
    with pytest.raises(FeederError) as error:
        load("")
    assert str(error.value) == "'': is an empty path - name a part file"


def test_missing_extra_is_named(tmp_path, monkeypatch):
    find = scenes.importlib.util.find_spec
    monkeypatch.setattr(scenes.importlib.util, "find_spec", lambda m: None if m == "cascadio" else find(m))
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
    """A GLB of a scene, with bytes or alone."""
    text = scene if isinstance(scene, bytes) else json.dumps({"asset": {"version": "2.0"}} | scene).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text
    if binary is not None:
        chunks += struct.pack("<2I", len(binary), 0x004E4942) + binary
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


def triangle(vertex='x="1" y="0" z="0"', item='objectid="1"'):
    """A 3MF of one triangle."""
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
def test_a_scene_of_other_kinds_of_values_is_a_line(scene):
    assert refused(boxed(scene)).startswith("is a damaged GLB (")


@pytest.mark.parametrize("fault", [AttributeError, NameError, TypeError, ImportError, AssertionError])
@pytest.mark.parametrize("format", ["obj", "off", "glb"])
def test_a_bug_of_ours_is_not_told_as_a_damaged_file(monkeypatch, format, fault):
    """It was: 'is a damaged OBJ (module ... has no attribute ...)', which sends the user to his CAD."""

    def broken(*_):
        raise fault("module 'x' has no attribute 'y'")

    monkeypatch.setattr("feederscrew.part.mesh_formats.split_facets", broken)
    monkeypatch.setattr("feederscrew.part.scenes.refuse_size", broken)
    with pytest.raises(fault, match="has no attribute"):
        load("-", stdin=io.BytesIO(exported(format)))


def test_what_trimesh_raises_of_any_class_is_a_damaged_file(monkeypatch):
    def broken(*_, **__):
        raise AttributeError("'NoneType' object has no attribute 'faces'")

    monkeypatch.setattr("trimesh.load_scene", broken)
    assert refused(GLB) == f"is a damaged GLB (its scene does not fit what it holds) - {AGAIN}"


# What a header claims costs nothing.
def scene(count, nodes, binary=bytes(1200), **accessor):
    """A GLB of one mesh of so many corners, by nodes."""
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
        scene(10**9, MESH, b""),
        scene(10**12, MESH, bufferView=0),
        scene(-5, MESH, bufferView=0),
        scene(10**9, MESH, sparse={"count": 1}),
        scene(99, CHAIN, bufferView=0),
        scene(99, [{"mesh": 0, "children": [0]}], bufferView=0),
        scene(99, MESH * 30_000, bufferView=0),
        HEAD.format(10**20, 1).encode(),
        HEAD.format(3, 9_000_000).encode() + bytes(9_000_036),
        b"OFF\n99999999999999999999 1 0\n0 0 0\n",
        b"OFF\n-5 5 0\n0 0 0\n",
    ],
    ids=["no view", "view", "less", "sparse", "chain", "loop", "many", "ply", "facets", "off", "minus"],
)
def test_claims_of_a_header_are_refused_in_a_line(data):
    refused(data)


@pytest.mark.needs("cascadio")
def test_a_step_file_that_takes_too_long_is_refused(monkeypatch):
    monkeypatch.setattr(scenes, "STEP_TIMEOUT_S", 1)
    monkeypatch.setattr(scenes, "CONVERT_STEP_SCRIPT", "import time; time.sleep(30)")
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
    waits = scenes.CONVERT_STEP_SCRIPT.partition("import cascadio")[0]
    waits += "print(1, flush=True); import time; time.sleep(50)"
    parent = (
        "import subprocess, sys, time;"
        "child = subprocess.Popen([sys.executable, '-c', sys.argv[1]], stdout=subprocess.PIPE);"
        "child.stdout.readline(); print(child.pid, flush=True); time.sleep(50)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", parent, waits], stdout=subprocess.PIPE, text=True
    ) as process:
        stat = Path(f"/proc/{int(process.stdout.readline())}/stat")
        process.kill()
    for _ in range(50):  # within five seconds; a process that nobody waited for counts as ended
        if not stat.exists() or stat.read_text().rsplit(")", 1)[1].split()[0] == "Z":
            return
        time.sleep(0.1)
    pytest.fail("the converter goes on")
