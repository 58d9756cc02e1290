"""GLB files: what the specification allows is read, what is not read is refused by its name."""

import base64
import json
import struct

import numpy as np
import pytest
from readings import AGAIN, loaded, mm3, refused

# An L of 10 x 6 x 4 mm: 156 mm3; its section is concave.
SECTION = [(0, 0), (10, 0), (10, 3), (3, 3), (3, 6), (0, 6)]
CORNERS = np.array([(x, y, z) for z in (0, 4) for x, y in SECTION], dtype=float)
WALLS = [(k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
CAPS = [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 5, 4)]
TRIANGLES = np.array(
    [(side[0], side[k], side[k + 1]) for side in WALLS for k in (1, 2)]
    + [*CAPS, *((6 + c, 6 + b, 6 + a) for a, b, c in CAPS)]
)
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
SCALE = [1e-3] * 3  # [m] of a millimetre


class Scene:
    """A scene of one mesh, in millimetres, as it is written."""

    def __init__(self):
        self.binary = b""
        self.primitive = {}
        self.text = {
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "scale": SCALE}],
            "meshes": [{"primitives": [self.primitive]}], "bufferViews": [], "accessors": [],
        }  # fmt: skip

    def view(self, numbers, kind, **own):
        """The number of a buffer view of them."""
        data = np.ascontiguousarray(numbers, dtype="<" + kind).tobytes()
        own |= {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        self.text["bufferViews"].append(own)
        self.binary += data + bytes(-len(data) % 4)
        return len(self.text["bufferViews"]) - 1

    def accessor(self, numbers, kind, **own):
        """The number of an accessor of them; ``own`` goes before what follows from them."""
        numbers = np.asarray(numbers)
        entry = {"componentType": COMPONENTS[kind], "count": len(numbers)}
        entry["type"] = "VEC3" if numbers.ndim == 2 else "SCALAR"
        if "sparse" not in own:
            entry["bufferView"] = self.view(numbers, kind)
        self.text["accessors"].append(entry | own)
        return len(self.text["accessors"]) - 1

    def data(self, *, buffer=None, version=2):
        """The bytes of the file."""
        text = self.text | {"buffers": [{"byteLength": len(self.binary)} | (buffer or {})]}
        whole = json.dumps(text).encode()
        whole += b" " * (-len(whole) % 4)
        chunks = struct.pack("<2I", len(whole), 0x4E4F534A) + whole
        if buffer is None:
            chunks += struct.pack("<2I", len(self.binary), 0x004E4942) + self.binary
        return struct.pack("<3I", 0x46546C67, version, 12 + len(chunks)) + chunks


@pytest.fixture
def bracket():
    """The L as a list of triangles."""
    scene = Scene()
    position = scene.accessor(CORNERS, "f4")
    scene.primitive.update(attributes={"POSITION": position}, indices=scene.accessor(TRIANGLES.ravel(), "u1"))
    return scene


def volume(scene, **own):
    return mm3(loaded(scene.data(), **own))


def test_sparse_numbers_replace_those_of_their_base_or_zeros(bracket):
    """Six corners are elsewhere in the base: it was 78 mm3."""
    wrong = CORNERS.copy()
    wrong[6:, 2] = 2.0
    for base in (wrong, None):
        some = np.arange(6, 12) if base is not None else np.flatnonzero(CORNERS.any(axis=1))
        sparse = {
            "count": len(some),
            "indices": {"bufferView": bracket.view(some, "u2"), "componentType": COMPONENTS["u2"]},
            "values": {"bufferView": bracket.view(CORNERS[some], "f4")},
        }
        own = (
            {"sparse": sparse} if base is None else {"sparse": sparse, "bufferView": bracket.view(base, "f4")}
        )
        bracket.primitive["attributes"]["POSITION"] = bracket.accessor(CORNERS, "f4", **own)
        assert volume(bracket) == pytest.approx(156.0, rel=1e-6)


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2"])
@pytest.mark.parametrize("normalized", [False, True])
def test_corners_as_integers_are_numbers_or_shares_of_one(bracket, kind, normalized):
    """c / 127 for signed ones of 8 bits (glTF 2.0, 3.6.2.2): it was 8e16 mm3."""
    position = bracket.accessor(CORNERS, kind, normalized=normalized)
    bracket.primitive["attributes"]["POSITION"] = position
    bracket.text["extensionsRequired"] = ["KHR_mesh_quantization"]
    if normalized:
        bracket.text["nodes"][0]["scale"] = [1e-3 * float(np.iinfo(kind).max)] * 3
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)


def test_the_least_signed_integer_stands_for_minus_one(bracket):
    """max(c / 127, -1): -128 and -127 are one place."""
    position = bracket.accessor(np.where(CORNERS == 0.0, -128.0, 127.0), "i1", normalized=True)
    bracket.primitive["attributes"]["POSITION"] = position
    bracket.primitive["indices"] = bracket.accessor([0, 2, 1, 0, 1, 8, 0, 8, 2, 1, 2, 8], "u1")
    bracket.text["nodes"][0]["scale"] = [1e-2] * 3  # corners at -1 and 1, those of a tetrahedron
    assert volume(bracket) == pytest.approx(20.0**3 / 6, rel=1e-6)


def test_numbers_between_others(bracket):
    """Corners, each followed by a normal of three floats."""
    between = np.hstack([CORNERS, np.full((12, 3), 9.0)])
    number = bracket.view(between, "f4", byteStride=24)
    bracket.text["accessors"][0] |= {"bufferView": number, "byteOffset": 0}
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)
    bracket.text["bufferViews"][number]["byteOffset"] -= 12
    bracket.text["accessors"][0]["byteOffset"] = 12
    bracket.text["bufferViews"][number]["byteLength"] += 12
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)
    bracket.text["bufferViews"][number]["byteLength"] -= 16  # the last normal may be missing, no more
    assert "announces more than it holds" in refused(bracket.data())


def test_strips_fans_and_lists_without_indices(bracket):
    attributes = bracket.primitive["attributes"]
    # Zigzag over the walls: 0 6 1 7 ..., back to its first edge; then fans of the caps.
    zigzag = np.array([[6 + k, k] for k in (0, 1, 2, 3, 4, 5, 0)]).ravel()
    caps = [[0, *range(5, 0, -1)], [6, *range(7, 12)]]
    bracket.text["meshes"][0]["primitives"] = [
        {"attributes": attributes, "mode": 5, "indices": bracket.accessor(zigzag, "u1")},
        *({"attributes": attributes, "mode": 6, "indices": bracket.accessor(cap, "u2")} for cap in caps),
        {
            "attributes": attributes,
            "mode": 1,
            "indices": bracket.accessor([0, 1], "u1"),
        },  # an edge to be drawn
    ]
    # The section is concave, seen whole from its corner 0: the caps are fans of it.
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)
    soup = {"attributes": {"POSITION": bracket.accessor(CORNERS[TRIANGLES].reshape(-1, 3), "f4")}}
    bracket.text["meshes"][0]["primitives"] = [soup]
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)


def turned(angle):
    return [0.0, 0.0, float(np.sin(angle / 2)), float(np.cos(angle / 2))]


def test_nodes_place_turn_stretch_and_mirror_what_they_hold(bracket):
    bracket.text["nodes"] += [
        {"children": [0], "rotation": turned(0.5), "scale": [1.0, -2.0, 1.0], "translation": [1.0, 0, 0]},
        {"children": [1], "matrix": [0, 3, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1]},
    ]
    bracket.text["scenes"][0]["nodes"] = [2]
    part = loaded(bracket.data())
    assert mm3(part) == pytest.approx(156.0 * 6, rel=1e-5)
    # Of corner (10, 0, 0) mm: turned by 0.5 rad and moved, then x and y changed, y stretched.
    x, y = 1.0 + 0.01 * np.cos(0.5), 0.01 * np.sin(0.5)
    place = np.array([0.1 - y, 0.2 + 3 * x, 0.3])
    assert np.abs(part.vertices - place).sum(axis=1).min() < 1e-6
    assert not [text for text in part.warnings if "inwards" in text]


def test_instances_and_what_the_scene_does_not_show(bracket):
    bracket.text["nodes"] += [{"mesh": 0, "scale": SCALE, "translation": [0.1, 0, 0], "name": "aside"}]
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)
    bracket.text["scenes"].append({"nodes": [0, 1]})
    part = loaded(bracket.data())
    assert "holds 2 scenes: the one it opens with is read" in part.warnings[0]
    bracket.text["scene"] = 1
    assert refused(bracket.data()).startswith("holds 2 bodies")
    assert volume(bracket, allow_open=True) == pytest.approx(312.0, rel=1e-6)
    assert volume(bracket, body="aside") == pytest.approx(156.0, rel=1e-6)
    del bracket.text["scenes"], bracket.text["scene"]  # a library of meshes
    assert refused(bracket.data()).startswith("holds 2 bodies")


def test_numbers_in_the_scene_itself_or_in_another_file(bracket):
    inline = "data:application/octet-stream;base64," + base64.b64encode(bracket.binary).decode()
    assert mm3(loaded(bracket.data(buffer={"uri": inline}))) == pytest.approx(156.0, rel=1e-6)
    line = refused(bracket.data(buffer={"uri": "bracket.bin"}))
    assert line == "keeps its corners in 'bracket.bin', which is not read - export it as one GLB file"


def with_morph(scene):
    scene.primitive["targets"] = [{"POSITION": 0}]
    scene.text["meshes"][0]["weights"] = [0.5]


def with_instances(scene):
    moved = scene.accessor([[0.0, 0, 0], [1, 0, 0]], "f4")
    scene.text["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": moved}}}


def with_hidden(scene):
    scene.text["nodes"].append({"children": [0], "extensions": {"KHR_node_visibility": {"visible": False}}})
    scene.text["scenes"][0]["nodes"] = [1]


def with_packed_view(scene):
    scene.text["bufferViews"][0] |= {"buffer": 1, "extensions": {"EXT_meshopt_compression": {}}}


def requiring(name):
    return lambda scene: scene.text.update(extensionsRequired=[name])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (with_morph, "morph targets"),
        (lambda scene: scene.text["nodes"][0].update(skin=0), "a skin"),
        (with_instances, "EXT_mesh_gpu_instancing"),
        (with_hidden, "hidden"),
        (requiring("EXT_mesh_gpu_instancing"), "EXT_mesh_gpu_instancing"),
        (requiring("KHR_draco_mesh_compression"), "packed by KHR_draco_mesh_compression"),
        (requiring("EXT_meshopt_compression"), "packed by EXT_meshopt_compression"),
        (requiring("CESIUM_RTC"), "the extension 'CESIUM_RTC', which is not read"),
        (requiring("VND_new\x1b[31m"), "which is not read"),
    ],
)
def test_what_is_not_read_is_refused_by_its_name(bracket, change, words):
    """They were ignored: the instances gave 99 mm3 for 198, the morph target 95.8 for 766.7."""
    change(bracket)
    line = refused(bracket.data())
    assert words in line
    assert line.isprintable()


def test_extensions_that_change_no_shape_may_be_required(bracket):
    bracket.text["extensionsRequired"] = [
        "KHR_materials_unlit",
        "KHR_texture_transform",
        "KHR_lights_punctual",
    ]
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)
    with_morph(bracket)
    bracket.text["nodes"][0]["weights"] = [0.0]  # of the instance, before that of the mesh
    assert volume(bracket) == pytest.approx(156.0, rel=1e-6)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda s: s.text["nodes"][0].update(matrix=[1.0] * 16), "a node with a matrix beside its shift"),
        (lambda s: s.text["nodes"][0].update(rotation=[0, 0, 0, 0]), "a node whose turn is no unit"),
        (lambda s: s.text["nodes"][0].update(scale=[1, 1]), "a scale of 2 numbers, not of 3"),
        (lambda s: s.text["nodes"][0].update(mesh=True), "its scene has true out of place"),
        (lambda s: s.text["nodes"][0].update(mesh=-1), "its scene has -1 out of place"),
        (lambda s: s.primitive.update(mode=7), "primitives of mode 7"),
        (lambda s: s.primitive.update(indices=s.accessor([0, 1, 12], "u1")),
         "a facet names a corner that is not there"),
        (lambda s: s.primitive.update(indices=s.accessor([0.0, 1, 2], "f4")),
         "a corner's number that is no whole number"),
        (lambda s: s.primitive.update(indices=s.accessor([0, 1, 2, 3], "u1")), "triangles that"),
        (lambda s: s.text["accessors"][0].update(count=10**6), "it announces more than it holds"),
        (lambda s: s.text["bufferViews"][0].update(byteStride=4), "it announces more than it holds"),
        (lambda s: s.text["scenes"][0].update(nodes=[0, 0]), "a node within two others"),
    ],
)  # fmt: skip
def test_a_scene_that_does_not_add_up_is_refused_in_a_line(bracket, change, reason):
    change(bracket)
    line = refused(bracket.data())
    assert line.startswith(f"is a damaged GLB ({reason}")
    assert line.endswith(f" - {AGAIN}")


def test_the_first_version_of_the_format_is_named(bracket):
    line = "is a GLB of version 1, which is not read - export it as glTF 2.0"
    assert refused(bracket.data(version=1)) == line
