"""Valid files of known volume, with every feature of every format, and files that are refused by a name.

A reader that ignores a feature reads another body: of 1,167 such GLB files 353 were read wrongly.
"""

import base64
import json
import re
import struct
from dataclasses import dataclass, field

import numpy as np
from fuzz.mutate import pick


@dataclass(frozen=True)
class ValidFile:
    """A file, and what a reader must make of it."""

    name: str
    data: bytes
    volume: float  # [mm3]
    refusal: str = ""  # pattern of the line that refuses it; '' where it must be read
    relative: float = 1e-4  # tolerance [1] of the volume
    features: tuple[str, ...] = ()  # for people who look at a fault
    options: tuple[tuple[str, object], ...] = ()  # of ``load``
    beside: dict[str, bytes] = field(default_factory=dict)  # files that lie beside it


@dataclass(frozen=True)
class Prism:
    """A prism of whole-numbered corners whose outline, mostly concave, is seen whole from the z axis."""

    outline: np.ndarray  # (N, 2) int, counter-clockwise
    height: int

    @property
    def volume(self):
        """Its volume, exactly."""
        x, y = self.outline.T
        return abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())) / 2.0 * self.height

    @property
    def corners(self):
        """(2 N + 2, 3) int: below, above, and the middle of both."""
        flat = np.vstack([self.outline, [[0, 0]]])
        low, high = (np.column_stack([flat, np.full(len(flat), z)]) for z in (0, self.height))
        return np.vstack([low[:-1], high[:-1], low[-1:], high[-1:]])

    @property
    def sides(self):
        """Corner numbers of each side as a CAD program has them, seen from outside counter-clockwise."""
        n = len(self.outline)
        around = [(k, (k + 1) % n, n + (k + 1) % n, n + k) for k in range(n)]
        return [tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n)), *around]

    @property
    def triangles(self):
        """(4 N, 3) corner numbers; caps go round their middles."""
        n = len(self.outline)
        own, after = np.arange(n), (np.arange(n) + 1) % n
        walls = [[own, after, n + after], [own, n + after, n + own]]
        caps = [[after, own, np.full(n, 2 * n)], [n + own, n + after, np.full(n, 2 * n + 1)]]
        return np.concatenate([np.column_stack(each) for each in walls + caps])


def prism(rng, most=100):
    """A prism whose corners are at most ``most`` from the origin along each axis."""
    while True:
        count = int(rng.integers(3, 9))
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
        radii = rng.uniform(0.3, 1.0, count) * most
        outline = np.round(np.column_stack([np.cos(angles), np.sin(angles)]) * radii[:, None]).astype(int)
        x, y = outline.T
        turn = x * np.roll(y, -1) - np.roll(x, -1) * y
        if (turn > 0.02 * most**2).all():
            return Prism(outline, int(rng.integers(most // 10, most + 1)))


def chance(rng, share=0.5):
    """Whether something is so, by chance."""
    return bool(rng.random() < share)


# -- GLB

COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
UNREAD = {  # what is refused by name: the name, what a scene has of it, and the pattern of the line
    "skin": "skin",
    "morph": "morph",
    "EXT_mesh_gpu_instancing": "EXT_mesh_gpu_instancing",
    "KHR_draco_mesh_compression": "KHR_draco_mesh_compression",
    "EXT_meshopt_compression": "EXT_meshopt_compression",
    "VND_new_shape": "VND_new_shape",
    "KHR_node_visibility": "hidden",
    "part.bin": "part.bin",
}


class Glb:
    """A scene as it is written."""

    def __init__(self, rng):
        self.rng, self.binary = rng, bytearray()
        self.views, self.accessors = [], []
        self.features = []

    def view(self, data, stride=None):
        """A buffer view of some bytes, at any place."""
        self.binary += bytes(int(pick((0, 4, 12), self.rng)) + -len(self.binary) % 4)
        own = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if stride:
            own["byteStride"] = stride
        if not own["byteOffset"] and chance(self.rng):
            del own["byteOffset"]
        self.binary += data
        self.views.append(own)
        return len(self.views) - 1

    def accessor(self, values, kind, *, normalized=False, strided=True):
        """An accessor of (N,) or (N, 3) numbers that can be in a buffer, spread, or sparse."""
        rng, values = self.rng, np.asarray(values).astype("<" + kind)
        rows = values.reshape(len(values), -1)
        own = {"componentType": COMPONENTS[kind], "count": len(values),
               "type": "SCALAR" if values.ndim == 1 else f"VEC{rows.shape[1]}"}  # fmt: skip
        if normalized:
            own["normalized"] = True
        sparse, base = np.zeros(0, dtype=int), rows
        if chance(rng, 0.4):  # some values, over others or over zeros
            is_bare = chance(rng, 0.3)
            some = (rows != 0).any(axis=1) if is_bare else rng.random(len(rows)) < 0.4
            sparse = np.flatnonzero(some)
            base = rows.copy()
            base[sparse] = 0
            if is_bare and len(sparse):
                base = None
                self.features.append("sparse over nothing")
            elif len(sparse):
                base[sparse] = rng.integers(0, 2, (len(sparse), rows.shape[1]))
                self.features.append("sparse over a base")
        if base is not None:
            size = base.dtype.itemsize * base.shape[1]
            least = size + -size % 4
            stride = int(pick((least, least + 4, least + 12), rng)) if strided and chance(rng) else None
            if stride is None and strided and size % 4:
                stride = least
            offset = int(pick((0, 4, 8), rng)) if chance(rng) else 0
            block = np.full((len(base), stride or size), 0xA5, dtype=np.uint8)
            block[:, :size] = np.ascontiguousarray(base).view(np.uint8).reshape(len(base), size)
            own["bufferView"] = self.view(bytes(offset) + block.tobytes(), stride)
            if offset or chance(rng):
                own["byteOffset"] = offset
            if stride:
                self.features.append(f"stride {stride}")
        if len(sparse):
            at = str(pick(["u1", "u2", "u4"], rng)) if len(values) < 256 else "u4"
            places = {"bufferView": self.view(sparse.astype("<" + at).tobytes()),
                      "componentType": COMPONENTS[at]}  # fmt: skip
            filled = {"bufferView": self.view(np.ascontiguousarray(rows[sparse]).tobytes())}
            own["sparse"] = {"count": len(sparse), "indices": places, "values": filled}
        self.accessors.append(own)
        return len(self.accessors) - 1

    def primitive(self, points, triangles, kind, normalized):
        """Attributes, indices and mode of some triangles."""
        rng = self.rng
        style = pick(("list", "list", "soup", "strip", "fan"), rng)
        self.features += [style, kind + (" normalised" if normalized else "")]
        own = {"extras": {"made": "by chance"}} if chance(rng, 0.1) else {}
        if style == "soup":
            own["attributes"] = {
                "POSITION": self.accessor(points[triangles].reshape(-1, 3), kind, normalized=normalized)
            }
            if chance(rng):
                own["mode"] = 4
            return [own]
        own["attributes"] = {"POSITION": self.accessor(points, kind, normalized=normalized)}
        whole = str(pick(["u1", "u2", "u4"], rng))
        if style == "list":
            own["indices"] = self.accessor(triangles.ravel(), whole, strided=False)
            return [own]
        if style == "strip":  # strips of one triangle each, joined by those without area
            row = []
            for a, b, c in triangles.tolist():
                lead = [row[-1], a] if row else []
                lead += [a] if (len(row) + len(lead)) % 2 else []
                row += [*lead, a, b, c]
            return [own | {"mode": 5, "indices": self.accessor(np.array(row), whole, strided=False)}]
        fans = []  # a fan of each corner that is first of some triangles: here of one triangle or two
        for a, b, c in triangles.tolist():
            if fans and fans[-1][0] == a and fans[-1][-1] == b:
                fans[-1].append(c)
            else:
                fans.append([a, b, c])
        return [
            own | {"mode": 6, "indices": self.accessor(np.array(fan), whole, strided=False)} for fan in fans
        ]


def glb(rng):
    """A GLB of one prism whose scene is made of any of the features of glTF 2.0."""
    body, made = prism(rng), Glb(rng)
    kind, normalized = pick((("f4", False), ("i1", False), ("i2", False), ("u1", False), ("u2", False),
                             ("i1", True), ("i2", True), ("u1", True), ("u2", True)), rng)  # fmt: skip
    # what is stored: metres, or whole numbers of millimetres, none below zero where there are no such
    points, shift, size = body.corners.astype(float), np.zeros(3), 1e-3
    if kind[0] == "u":
        shift = np.array([100.0, 100.0, 0.0])
    elif kind == "f4" and chance(rng):
        points, size = points * 1e-3, 1.0
    stored = points + shift
    if normalized:
        size *= float(np.iinfo(kind).max)
    triangles = body.triangles.copy()
    parts = np.split(triangles, [int(rng.integers(len(triangles)))]) if chance(rng, 0.3) else [triangles]
    primitives = [p for part in parts if len(part) for p in made.primitive(stored, part, kind, normalized)]
    if chance(rng, 0.2):  # edges to be drawn
        line = made.accessor(np.arange(2), "u1", strided=False)
        primitives.append({"mode": 1, "attributes": primitives[0]["attributes"], "indices": line})
        made.features.append("lines")
    # nodes: back from what is stored to millimetres, and on by turns, shifts, mirrors and unequal scales
    mesh, inner = {"primitives": primitives}, {"mesh": 0}
    if shift.any():
        inner["translation"] = (-1e-3 * shift).tolist()
    if size != 1.0:
        inner["scale"] = [size] * 3
    factor, nodes = 1.0, [inner]
    for _ in range(int(rng.integers(0, 4))):
        matrix, own = np.eye(4), {"children": [len(nodes) - 1]}
        stretch = np.round(rng.uniform(0.5, 2.0, 3), 3) * np.where(rng.random(3) < 0.25, -1.0, 1.0)
        turn = rng.normal(size=4)
        turn /= np.sqrt(turn @ turn)
        move = np.round(rng.uniform(-0.1, 0.1, 3), 4)
        if chance(rng, 0.4):
            x, y, z, w = turn
            spin = np.array([
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ])  # fmt: skip
            matrix[:3, :3], matrix[:3, 3] = spin * stretch, move
            own["matrix"] = matrix.T.ravel().tolist()
            factor *= float(np.prod(stretch))
            made.features.append("matrix")
        else:
            if chance(rng):
                own["scale"] = stretch.tolist()
                factor *= float(np.prod(stretch))
            if chance(rng):
                own["rotation"] = turn.tolist()
            if chance(rng):
                own["translation"] = move.tolist()
        nodes.append(own)
    if factor < 0.0:
        made.features.append("mirrored")
    if chance(rng, 0.2):  # a shape it may take, but does not
        mesh["weights"] = [float(chance(rng))]
        inner["weights"] = [0.0]
        for primitive in primitives:
            primitive["targets"] = [{"POSITION": primitive["attributes"]["POSITION"]}]
        made.features.append("a morph target without weight")
    volume, options = body.volume * abs(factor), ()
    if chance(rng, 0.15):  # the mesh twice
        away = (0.5 + rng.random(3)).tolist()
        nodes += [{"children": [0] if len(nodes) == 1 else [len(nodes) - 1]}, {**inner, "translation": away}]
        nodes.append({"children": [len(nodes) - 2, len(nodes) - 1]})
        volume, options = volume + body.volume, (("allow_open", True),)
        made.features.append("twice")
    top = len(nodes) - 1
    scene = {
        "asset": {"version": "2.0", "generator": "fuzz"}, "meshes": [mesh], "nodes": nodes,
        "scenes": [{"nodes": [top]}],
    }  # fmt: skip
    if kind != "f4":
        scene |= {
            "extensionsUsed": ["KHR_mesh_quantization"],
            "extensionsRequired": ["KHR_mesh_quantization"],
        }
    if chance(rng, 0.3):  # a mesh that no scene shows, and nodes of other things
        scene["meshes"].append({"primitives": [{"attributes": {"POSITION": 0}}], "name": "not shown"})
        nodes += [{"mesh": 1, "name": "not in the scene"}, {"camera": 0}]
        scene["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]
        made.features.append("a node that no scene shows")
    if chance(rng, 0.2):
        scene["scenes"].insert(0, {"nodes": [top], "name": "first"})
        scene["scene"] = 1
    elif chance(rng, 0.6):
        scene["scene"] = 0
    elif chance(rng, 0.2) and len(nodes) == top + 1:
        del scene["scenes"]
    if chance(rng, 0.3):
        scene["extensionsUsed"] = [*scene.get("extensionsUsed", []), "KHR_materials_unlit"]
        scene["extensionsRequired"] = [*scene.get("extensionsRequired", []), "KHR_materials_unlit"]
    refusal = ""
    if chance(rng, 0.15):
        refusal = _unread(pick(sorted(UNREAD), rng), scene, made)
    buffer = {"byteLength": len(made.binary)}
    binary = bytes(made.binary) + bytes(int(rng.integers(0, 4)))
    if refusal == UNREAD["part.bin"]:
        buffer["uri"] = "part.bin"
    elif chance(rng, 0.15):
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
        binary = None
        made.features.append("data in the scene")
    scene |= {"buffers": [buffer], "bufferViews": made.views, "accessors": made.accessors}
    features = tuple(dict.fromkeys(made.features))
    return ValidFile("part.glb", packed_glb(scene, binary, rng), volume, refusal, 3e-4, features, options)


def _unread(name, scene, made):
    """Give the scene what is not read; the pattern of the line that says so."""
    made.features.append(name)
    node, mesh = scene["nodes"][0], scene["meshes"][0]
    if name == "skin":
        node["skin"] = 0
        scene["skins"] = [{"joints": [0]}]
    elif name == "morph":
        node.pop("weights", None)
        (node if chance(made.rng) else mesh)["weights"] = [0.5]
        for primitive in mesh["primitives"]:
            primitive["targets"] = [{"POSITION": primitive["attributes"]["POSITION"]}]
    elif name == "KHR_node_visibility":
        pick(
            scene["nodes"][: scene["scenes"][-1]["nodes"][0] + 1] if "scenes" in scene else [node], made.rng
        )["extensions"] = {name: {"visible": False}}
    elif name != "part.bin":
        scene["extensionsUsed"] = [*scene.get("extensionsUsed", []), name]
        if name == "EXT_mesh_gpu_instancing":
            moved = made.accessor(np.array([[0.0, 0, 0], [1, 0, 0]]), "f4")
            node["extensions"] = {name: {"attributes": {"TRANSLATION": moved}}}
        if name != "EXT_mesh_gpu_instancing" or chance(made.rng):
            scene["extensionsRequired"] = [*scene.get("extensionsRequired", []), name]
    return UNREAD[name]


def packed_glb(scene, binary, rng):
    """The bytes of a GLB; ``binary`` None has no such chunk."""
    text = json.dumps(scene, indent=pick((None, 1), rng)).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text
    if binary is not None:
        binary += bytes(-len(binary) % 4)
        chunks += struct.pack("<2I", len(binary), 0x004E4942) + binary
        if chance(rng, 0.1):  # of an extension
            chunks += struct.pack("<2I", 8, 0x12345678) + bytes(8)
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


MAKERS = {"valid glb": glb}


def make(kind, rng):
    """A file of one kind, by chance."""
    return MAKERS[kind](rng)


def read(name):
    """Read a part that may be damaged: one that is accepted has a mass."""
    from feederscrew.part import load

    assert load(name).mass > 0


def fault(file):
    """What is wrong with how a file is read; '' if nothing is."""
    from feederscrew.base.errors import FeederError
    from feederscrew.part import load

    try:
        volume = load(file.name, **dict(file.options)).volume * 1e9
    except FeederError as told:
        if file.refusal and re.search(file.refusal, str(told)):
            return ""
        return f"refused: {told} {file.features}"
    if file.refusal:
        return f"read as {volume:.6g} mm3, not refused for its {file.refusal} {file.features}"
    if not abs(volume - file.volume) <= file.relative * file.volume:
        return f"read as {volume:.6g} mm3, it is {file.volume:.6g} {file.features}"
    return ""
