"""Files as programs write them: facets of any size, texts with and without their ends, pointers, units."""

import io
import json
import struct
import zipfile
from pathlib import Path

import part_files as files
import pytest

from feederscrew import bowl
from feederscrew.errors import FeederError
from feederscrew.part import load

# An L of 10 x 6 x 4 mm, its section concave: 156 mm3. Sides are given as a CAD program has them.
SECTION = [(0, 0), (10, 0), (10, 3), (3, 3), (3, 6), (0, 6)]
CORNERS = [(x, y, z) for z in (0, 4) for x, y in SECTION]
SIDES = [
    (5, 4, 3, 2, 1, 0),
    (6, 7, 8, 9, 10, 11),
    *((k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)),
]
FAN = [(side[0], side[k], side[k + 1]) for side in SIDES[2:] for k in (1, 2)]
CAPS = [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 5, 4)]
FACETS = FAN + CAPS + [(6 + c, 6 + b, 6 + a) for a, b, c in CAPS]
VOLUME = 156.0  # [mm3]


def loaded(data, **options):
    """The part of a file's bytes."""
    return load("-", stdin=io.BytesIO(data if isinstance(data, bytes) else data.encode()), **options)


def mm3(part):
    return part.volume * 1e9


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
    shown = [[k - 12 if minus else k + begins for k in side] for side in SIDES]
    return "\n".join([*lines, *("f " + " ".join(f"{k}//1" for k in side) for side in shown)]) + "\n"


def text_stl(sides=FACETS, name="L", end="\n", comma=False, last=True):
    """A text STL of the L."""
    lines = [f"solid {name}"]
    for side in sides:
        corners = ["vertex {:.3f} {:.3f} {:.3f}".format(*CORNERS[k]) for k in side]
        corners = [line.replace(".", ",") for line in corners] if comma else corners
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    return end.join([*lines, *([f"endsolid {name}"] if last else [])]) + "\n"


@pytest.mark.parametrize(
    "data",
    [
        ply("binary_little_endian"),
        ply("binary_big_endian", ">"),
        ply("ascii"),
        ply("binary_little_endian", extra="element edge 0\nproperty int vertex1\n"),
        off(),
        off("OFF 12 8 0\n"),
        off("COFF\n# with colours\n12 8 0\n", colour=" 3 255 0 0"),
        off("NOFF\n12 8 0\n", normal=" 0 0 1"),
        off("OFF 12 8 0 ", " "),
        obj(1),
        obj(1, minus=True),
        obj(1).replace("v 10 0 0", "v 10 \\\n0 0"),
    ],
    ids=["little", "big", "text", "edges", "off", "one head", "colours", "normals", "one line",
         "obj", "relative", "continued"],
)  # fmt: skip
def test_facets_of_several_sizes_keep_their_outline(data):
    """The section is concave: a fan from its first corner would enclose 156 mm3 of other shape or none."""
    part = loaded(data)
    assert mm3(part) == pytest.approx(VOLUME)
    assert part.hull.volume * 1e9 == pytest.approx(198.0)
    assert part.warnings == ()


def test_a_concave_quadrilateral_is_split_within_its_outline():
    arrow = [(0, 0), (8, 4), (0, 8), (3, 4)]  # the last corner points inwards; area 20
    corners = [(x, y, z) for z in (0, 5) for x, y in arrow]
    sides = [(3, 2, 1, 0), (4, 5, 6, 7), *((k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4))]
    for turn in range(4):
        turned = [side[turn:] + side[:turn] for side in sides]
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        text += "".join("f " + " ".join(str(k + 1) for k in side) + "\n" for side in turned)
        assert mm3(loaded(text)) == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("data", "word"),
    [
        (text_stl(last=False), "endsolid"),
        (text_stl(end=" "), None),
        (text_stl(end=" ", name="bolt #3"), None),
        (text_stl(end=" ", last=False), "endsolid"),
        ("# made by hand\n" + text_stl(), None),
        (text_stl().replace("outer loop\n", "outer loop  # a facet\n; and a line\n", 3), None),
        (text_stl(comma=True), "comma"),
        (text_stl(SIDES[2:] + CAPS + FACETS[-4:]), "four corners"),
        (text_stl(SIDES), "more than three corners"),
        (text_stl(FACETS[:9]) + text_stl(FACETS[9:]), None),
        (text_stl(FACETS[:9], last=False) + text_stl(FACETS[9:], "two"), None),
        (text_stl(FACETS[:9], end=" ")[:-1] + " " + text_stl(FACETS[9:], end=" "), None),
    ],
    ids=["no end", "one line", "hash", "one line, no end", "comment", "comments", "commas", "quads", "n-gons",
         "two", "two, one end", "two in a line"],
)  # fmt: skip
def test_text_stl_as_people_have_it(data, word):
    part = loaded(data)
    assert mm3(part) == pytest.approx(VOLUME)
    assert len(part.warnings) == (word is not None)
    assert word is None or word in part.warnings[0]


@pytest.mark.parametrize("cut", [-60, -40, -16])
def test_text_stl_cut_within_a_facet_is_refused(tmp_path, cut):
    assert "cut short" in files.refused(files.written(tmp_path, text_stl(last=False)[:cut].encode()))


@pytest.mark.parametrize(
    "data",
    [
        text_stl().replace("10.000", "1,000.0"),
        text_stl().replace("10.000", "10,0", 1),
        text_stl().replace(".000", "").replace("vertex 10 ", "vertex 1,000 "),
    ],
)
def test_commas_that_may_be_no_points_are_refused(tmp_path, data):
    assert "comma" in files.refused(files.written(tmp_path, data.encode()))


@pytest.mark.parametrize("kind", ["obj", "off", "ply"])
def test_decimal_commas_in_other_texts(kind):
    text = {"obj": obj(1), "off": off(), "ply": ply("ascii")}[kind]
    assert mm3(loaded(text.replace("10 ", "10,0 ", 1).replace("10,0 0 0", "10,0 0 0"))) == pytest.approx(
        VOLUME
    )


def test_obj_that_counts_from_zero():
    part = loaded(obj(0))
    assert mm3(part) == pytest.approx(VOLUME)
    assert "from 0" in part.warnings[0]


def test_obj_with_a_corner_zero_that_does_not_count_from_zero(tmp_path):
    path = files.written(tmp_path, obj(1).replace("f 1//1", "f 0//1", 1).encode(), "l.obj")
    assert "from 1" in files.refused(path)


POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:%s\nsize 120484\n" % (b"0" * 64)


@pytest.mark.parametrize("name", ["l.stl", "l.step", "l.3mf", "l.glb", "l.obj", "card.yaml"])
def test_a_pointer_of_git_lfs_is_named(tmp_path, name):
    line = files.refused(files.written(tmp_path, POINTER, name))
    assert "git LFS" in line and "git lfs pull" in line


def test_a_pointer_in_place_of_a_bowl_file(tmp_path):
    with pytest.raises(FeederError, match="git LFS"):
        bowl.read(files.written(tmp_path, POINTER, "bowl.yaml"))


def test_a_zipped_step_file(tmp_path):
    pytest.importorskip("cascadio")
    source = Path(__file__).parents[2] / "parts/hexbolt_m8x25.step"
    path = tmp_path / "bolt.stpz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(source, "bolt.stp")
    assert mm3(load(path)) == pytest.approx(1677.2, rel=1e-3)


# What a header claims costs nothing.
def glb(scene, binary=b""):
    """A GLB of a scene."""
    text = json.dumps({"asset": {"version": "2.0"}} | scene).encode()
    text += b" " * (-len(text) % 4)
    chunks = (
        struct.pack("<2I", len(text), 0x4E4F534A)
        + text
        + struct.pack("<2I", len(binary), 0x004E4942)
        + binary
    )
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


def scene(count, nodes, **accessor):
    """A scene of one mesh of so many corners, by nodes."""
    return {
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": count, "type": "VEC3", **accessor}],
        "bufferViews": [{"buffer": 0, "byteLength": 1200}],
        "buffers": [{"byteLength": 1200}],
    }


ONE = [{"mesh": 0}]
CHAIN = [{"mesh": 0, "children": [k + 1]} for k in range(5000)] + ONE
PLY = "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"
HEAD = PLY + XYZ + "element face {}\nproperty list uchar int vertex_indices\nend_header\n"


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("noview.glb", glb(scene(10**9, ONE))),
        ("view.glb", glb(scene(10**12, ONE, bufferView=0), bytes(1200))),
        ("less.glb", glb(scene(-5, ONE, bufferView=0), bytes(1200))),
        ("sparse.glb", glb(scene(10**9, ONE, sparse={"count": 1}), bytes(1200))),
        ("chain.glb", glb(scene(99, CHAIN, bufferView=0), bytes(1200))),
        ("loop.glb", glb(scene(99, [{"mesh": 0, "children": [0]}], bufferView=0), bytes(1200))),
        ("many.glb", glb(scene(99, ONE * 30_000, bufferView=0), bytes(1200))),
        ("a.ply", HEAD.format(10**20, 1).encode()),
        ("b.ply", HEAD.format(3, 9_000_000).encode() + bytes(9_000_036)),
        ("a.off", b"OFF\n99999999999999999999 1 0\n0 0 0\n"),
        ("b.off", b"OFF\n-5 5 0\n0 0 0\n"),
    ],
)
def test_claims_of_a_header_are_refused_in_a_line(tmp_path, name, data):
    files.refused(files.written(tmp_path, data, name))


def test_texts_of_a_file_are_printable(tmp_path):
    """Escapes in names, numbers and metadata reach no terminal."""
    data = obj(1).replace("v 10 0 0", "v 10 \x1b[31m0 0", 1)
    with pytest.raises(FeederError) as caught:
        load(files.written(tmp_path, data.encode(), "red\x1b[31m.obj"))
    assert str(caught.value).isprintable()
    part = load(files.written(tmp_path, obj(1).encode(), "red\x1b[31m.obj"))
    assert part.name.isprintable()
