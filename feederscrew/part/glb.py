"""GLB, the binary form of glTF 2.0: the triangles of its scene, each instance in its place.

Source: Khronos Group, "glTF 2.0 Specification", version 2.0.1, 2021; numbers in comments are its chapters. A
scene that asks for what is not read (skins, morph targets, extensions) is refused by that name: trimesh 5.2
ignores sparse and normalised numbers, morph targets and required extensions, and gives another body.
"""

import base64
import binascii
import json
import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.base.arrays import Floats, Ints, Points, Triangles
from feederscrew.base.errors import MeshError
from feederscrew.base.geometry import vectors
from feederscrew.base.units import counted, quantity_text
from feederscrew.part.formats import ANNOUNCES_MORE, MAX_READ_CORNERS, DamageError, Soup, refuse_size

GltfObject = dict[str, Any]  # a node, a mesh, an accessor ... of a file of others, not yet checked
MAX_SCENE_BYTES = 1 << 24  # [bytes] of the JSON of a GLB: names of nodes and buffers, not their numbers
MAX_SCENE_NODES, MAX_NODE_DEPTH = 20_000, 50  # instances; nodes within nodes
MAX_PRIMITIVES = 200_000  # of all instances
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942  # 4.4.3
COMPONENT_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}  # 3.6.2.2
COMPONENTS_BY_TYPE = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# modes of a primitive, 3.7.2.1
POINTS_AND_LINES = range(4)
TRIANGLES = 4
STRIP = 5
FAN = 6
INSTANCING, VISIBILITY = "EXT_mesh_gpu_instancing", "KHR_node_visibility"
PACKINGS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
QUANTIZATION, BREP_FACES = "KHR_mesh_quantization", "TM_brep_faces"  # corners as integers; of cascadio
READ_EXTENSIONS = {  # may be required: read, or no matter of shape
    QUANTIZATION, BREP_FACES, "KHR_lights_punctual", "KHR_texture_basisu", "KHR_texture_transform", "KHR_xmp",
    "KHR_xmp_json_ld", "KHR_animation_pointer", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds",
    "EXT_lights_image_based", "EXT_lights_ies", "EXT_mesh_features", "EXT_structural_metadata",
    "EXT_feature_metadata", "KHR_techniques_webgl",
}  # fmt: skip
MATERIAL_EXTENSION = re.compile(r"[A-Z]+_materials_\w+")  # how a surface looks
EXPORT_UNPACKED = "export it unpacked"
EXPORT_AS_SHOWN = "apply it in the program that made it, and export plain meshes"
DATA_URI = re.compile(r"data:[^,;]*;base64,", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Piece:
    """One primitive of one instance of a mesh, in the axes of the scene."""

    node: str  # name of the node that places it, '' for none
    mesh: str  # name of the mesh
    instance: int  # which placed mesh it is of, from 0
    vertices: Points  # (V, 3) [m]
    faces: Triangles  # (F, 3) int, as many as the primitive has, in its order
    extensions: GltfObject  # of the primitive
    matrix: Floats  # (4, 4) from the axes of the mesh to those of the scene


def read_glb(data: bytes, where: str) -> Soup:
    """Return the triangles of a GLB file, in metres; objects are the instances of its meshes.

    Parameters
    ----------
    data : bytes
        The whole file.
    where : str
        The file, for error lines.

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If the shape depends on what is not read: a required extension, a skin, a morph target with a weight,
        numbers in another file, instances of an extension, nodes that are hidden.
    ValueError
        If it is damaged, or stands for too much.
    """
    document = Document(data, where)
    pieces = list(document.pieces())
    names: dict[int, str] = {piece.instance: piece.node or piece.mesh for piece in pieces}
    return merge(pieces, tuple(names.values()), "glb", "m", document.warnings)


def merge(
    pieces: list[Piece], names: tuple[str, ...], kind: str, unit: str, warnings: tuple[str, ...] = ()
) -> Soup:
    """Put the pieces of a scene into one soup, an object for each instance.

    Parameters
    ----------
    pieces : list of Piece
        With corners in metres.
    names : tuple of str
        Of the instances, in the order in which the pieces name them.
    kind : str
        The format, a key of ``MESH_FORMATS``.
    unit : str
        That the soup states of its corners.
    warnings : tuple of str, optional

    Returns
    -------
    Soup
        Its corners are those of the pieces, [m] whatever the unit says.
    """
    sizes = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
    vertices = np.concatenate([np.empty((0, 3)), *(piece.vertices for piece in pieces)])
    moved = [piece.faces + first for piece, first in zip(pieces, sizes)]
    faces = np.concatenate([np.empty((0, 3), dtype=np.int64), *moved])
    order = {instance: k for k, instance in enumerate(dict.fromkeys(piece.instance for piece in pieces))}
    objects = np.repeat([order[piece.instance] for piece in pieces], [len(piece.faces) for piece in pieces])
    return Soup(vertices, faces, kind, unit, warnings, names, objects.astype(np.int64))


class Document:
    """The scene of a GLB and the numbers behind it.

    Raises MeshError or ValueError as ``read_glb`` does.
    """

    def __init__(self, data: bytes, where: str) -> None:
        self.where = where
        self.scene, self.binary = _chunks(data, where)
        lists = (_list_of(self.scene, name) for name in ("accessors", "bufferViews", "buffers"))
        self.accessors, self.views, self.buffers = lists
        self._numbers: dict[int, Any] = {}  # accessors that were read
        self._buffers: dict[int, bytes] = {}
        self.warnings: tuple[str, ...] = ()
        self.corners = self.facets = self.primitives = 0  # of all instances
        for name in _list_of(self.scene, "extensionsRequired", str):
            if name in PACKINGS:
                self._refuse(f"is a GLB packed by {name}, which is not read", EXPORT_UNPACKED)
            if name == INSTANCING:
                self._refuse(f"places its instances by {name}, which is not read", EXPORT_AS_SHOWN)
            if name not in READ_EXTENSIONS and not MATERIAL_EXTENSION.fullmatch(name):
                what = f"requires the extension {quantity_text(name)}, which is not read"
                self._refuse(what, "export it without that extension")

    def pieces(self) -> Iterator[Piece]:
        """Yield the primitives of each instance that the scene shows, as triangles in the scene's axes."""
        nodes, meshes = _list_of(self.scene, "nodes"), _list_of(self.scene, "meshes")
        roots = self._roots(nodes)
        instance = 0
        stack = [(root, np.eye(4), 0, True) for root in reversed(roots)]
        while stack:
            number, outer, depth, is_shown = stack.pop()
            node = nodes[number]
            if depth > MAX_NODE_DEPTH:
                raise DamageError(f"nodes within nodes more than {MAX_NODE_DEPTH} deep")
            matrix = vectors.product(outer, _placement(node))
            children = _list_of(node, "children", (int, float))
            visibility = _require(dict, _extensions(node).get(VISIBILITY, {}))
            is_shown = is_shown and visibility.get("visible") is not False
            stack += [(_whole(child), matrix, depth + 1, is_shown) for child in reversed(children)]
            if "mesh" not in node:
                continue
            mesh = meshes[_whole(node["mesh"])]
            names = [str(holder.get("name", "")) for holder in (node, mesh)]
            self._refuse_deformed(node, mesh, names, is_shown)
            for primitive in _list_of(mesh, "primitives"):
                self.primitives += 1
                if self.primitives > MAX_PRIMITIVES:
                    raise DamageError(f"its scene shows more than {MAX_PRIMITIVES} primitives")
                placed = self._place(primitive, matrix)
                if placed is not None:
                    yield Piece(names[0], names[1], instance, *placed, _extensions(primitive), matrix)
            instance += 1

    def numbers(self, number: int) -> Any:
        """Return the numbers of an accessor; they are read once.

        Integers that stand for shares of one are such shares, as floats (3.6.2.2); sparse values are put in
        place of those of the base, or of zeros without one (3.6.2.3).

        Parameters
        ----------
        number : int
            Of the accessor, from 0.

        Returns
        -------
        (count, components) or (count,) array
            One-dimensional for scalars.

        Raises
        ------
        DamageError
            If the accessor announces more than the file holds, or stands for matrices.
        """
        if number not in self._numbers:
            accessor = self.accessors[number]
            self._numbers[number] = self._read(accessor)
        return self._numbers[number]

    def _read(self, accessor: GltfObject) -> Any:
        each = COMPONENTS_BY_TYPE[_require(str, accessor["type"])]
        component = np.dtype(COMPONENT_TYPES[_whole(accessor["componentType"])])
        count = _whole(accessor["count"])
        if each > 4:
            raise DamageError("a matrix in place of corners")
        if count * each > 3 * MAX_READ_CORNERS:
            refuse_size(MAX_READ_CORNERS + 1, 0)
        offset, sparse = _whole(accessor.get("byteOffset", 0)), accessor.get("sparse")
        if accessor.get("bufferView") is not None:
            values = self._view(_whole(accessor["bufferView"]), component, count, each, offset)
        elif sparse is not None:
            values = np.zeros((count, each), dtype=component)
        else:
            raise DamageError(ANNOUNCES_MORE)  # zeros by 3.6.2.1: a point
        if sparse is not None:
            sparse = _require(dict, sparse)
            places, own = _require(dict, sparse["indices"]), _require(dict, sparse["values"])
            some, type = _whole(sparse["count"]), COMPONENT_TYPES[_whole(places["componentType"])]
            if np.dtype(type).kind != "u":
                raise DamageError("a sparse index that is no whole number")
            at = self._view(
                _whole(places["bufferView"]), np.dtype(type), some, 1, _whole(places.get("byteOffset", 0))
            )[:, 0].astype(np.int64)
            if len(at) and (at[-1] >= count or (np.diff(at) <= 0).any()):
                raise DamageError("sparse values that do not fit their base")
            values = values.copy()
            values[at] = self._view(
                _whole(own["bufferView"]), component, some, each, _whole(own.get("byteOffset", 0))
            )
        if accessor.get("normalized") is True and component.kind in "iu":
            if component.itemsize > 2:
                raise DamageError("normalised integers of 32 bits")
            largest = float(np.iinfo(component).max)
            values = np.maximum(values.astype(float) / largest, -1.0)
        return values[:, 0] if each == 1 else values

    def _view(self, number: int, component: np.dtype[Any], count: int, each: int, offset: int) -> Any:
        """(count, each) numbers from a place of a buffer view; DamageError where it holds fewer."""
        view = self.views[number]
        packing = next((name for name in PACKINGS if name in _extensions(view)), "")
        buffer = self._buffer(_whole(view["buffer"]), packing)
        start, length = _whole(view.get("byteOffset", 0)), _whole(view["byteLength"])
        size = component.itemsize * each
        stride = _whole(view.get("byteStride") or size)
        last = offset + stride * (count - 1) + size if count else 0
        if start + length > len(buffer) or last > length or stride < size:
            raise DamageError(ANNOUNCES_MORE)
        if not count:
            return np.empty((0, each), dtype=component)
        return np.ndarray((count, each), component, buffer, start + offset, (stride, component.itemsize))

    def _buffer(self, number: int, packing: str) -> bytes:
        if number in self._buffers:
            return self._buffers[number]
        buffer = self.buffers[number]
        address, length = buffer.get("uri"), _whole(buffer["byteLength"])
        if address is None and number == 0 and self.binary is not None:
            data = self.binary
        elif address is None:  # a buffer of nothing, for readers that unpack
            if packing:
                self._refuse(f"is a GLB packed by {packing}, which is not read", EXPORT_UNPACKED)
            raise DamageError(ANNOUNCES_MORE)
        elif inline := DATA_URI.match(_require(str, address)):
            try:
                data = base64.b64decode(address[inline.end() :], validate=True)
            except binascii.Error:
                raise DamageError("a buffer in its scene is no base64") from None
        else:
            text = "in its scene" if address.startswith("data:") else f"in {quantity_text(address)}"
            self._refuse(f"keeps its corners {text}, which is not read", "export it as one GLB file")
        if length > len(data):
            raise DamageError(ANNOUNCES_MORE)
        return self._buffers.setdefault(number, data)

    def _roots(self, nodes: list[Any]) -> list[int]:
        """Nodes at the top of the scene that is shown; a node within two others, or itself, is refused."""
        if len(nodes) > MAX_SCENE_NODES:
            raise DamageError(f"more than {MAX_SCENE_NODES} nodes")
        parents: dict[int, int] = {}
        for number, node in enumerate(nodes):
            for child in _list_of(node, "children", (int, float)):
                if parents.setdefault(_whole(child), number) != number:
                    raise DamageError("a node within two others")
        scenes = _list_of(self.scene, "scenes")
        if not scenes:  # a library of meshes
            return [number for number in range(len(nodes)) if number not in parents]
        shown = scenes[_whole(self.scene.get("scene", 0))]
        roots = [_whole(root) for root in _list_of(shown, "nodes", (int, float))]
        if len(set(roots)) < len(roots) or any(root in parents for root in roots):
            raise DamageError("a node within two others")
        if len(scenes) > 1:
            left = counted(len(scenes) - 1, "other scene is", "other scenes are")
            self.warnings = (f"holds {len(scenes)} scenes: the one it opens with is read, {left} left out",)
        return roots

    def _refuse_deformed(self, node: GltfObject, mesh: GltfObject, names: list[str], is_shown: bool) -> None:
        """Refuse an instance that is hidden, or whose corners are moved by more than its nodes."""
        name = next(filter(None, names), "")
        title = f" of {quantity_text(name)}" if name else ""
        if "skin" in node:
            self._refuse(f"has a skin{title}, whose bones move the corners: not read", EXPORT_AS_SHOWN)
        targets = any(_list_of(primitive, "targets") for primitive in _list_of(mesh, "primitives"))
        weights = _list_of(node if "weights" in node else mesh, "weights", (int, float))
        if targets and any(weight != 0.0 for weight in weights):
            self._refuse(f"has morph targets{title} with weights, which are not read", EXPORT_AS_SHOWN)
        if INSTANCING in _extensions(node):
            what = f"places its instances by {INSTANCING}, which is not read"
            self._refuse(what, EXPORT_AS_SHOWN)
        if not is_shown:
            self._refuse(
                f"has a hidden mesh{title} ({VISIBILITY})", "show it or leave it out, and export again"
            )

    def _place(self, primitive: GltfObject, matrix: Floats) -> tuple[Points, Triangles] | None:
        """Corners of a primitive in the axes of the scene, and its triangles; None for points and lines."""
        mode, attributes = _whole(primitive.get("mode", TRIANGLES)), _require(dict, primitive["attributes"])
        if mode in POINTS_AND_LINES or "POSITION" not in attributes:
            return None
        if mode not in (TRIANGLES, STRIP, FAN):
            raise DamageError(f"primitives of mode {mode}")
        positions = self.accessors[_whole(attributes["POSITION"])]
        packing = next((name for name in PACKINGS if name in _extensions(primitive)), None)
        if packing and positions.get("bufferView") is None and "sparse" not in positions:
            self._refuse(f"is a GLB packed by {packing}, which is not read", EXPORT_UNPACKED)
        corners = self.numbers(_whole(attributes["POSITION"]))
        if corners.ndim != 2 or corners.shape[1] != 3:
            raise DamageError("corners of other than three numbers")
        indices = np.arange(len(corners))
        if primitive.get("indices") is not None:
            indices = self.numbers(_whole(primitive["indices"]))
            if indices.ndim != 1 or indices.dtype.kind != "u":
                raise DamageError("a corner's number that is no whole number")
            indices = indices.astype(np.int64)
            if len(indices) and indices.max() >= len(corners):
                raise DamageError("a facet names a corner that is not there")
        self.corners += len(corners)
        self.facets += len(indices) // 3 if mode == TRIANGLES else max(len(indices) - 2, 0)
        refuse_size(self.corners, self.facets)
        if mode == TRIANGLES:
            if len(indices) % 3:
                raise DamageError("triangles that are not whole")
            faces = indices.reshape(-1, 3)
        elif mode == STRIP:
            faces = strip_triangles(indices)
        else:
            faces = np.column_stack(
                [indices[1:-1], indices[2:], np.full(max(len(indices) - 2, 0), indices[:1])]
            )
        points = vectors.product(corners.astype(float), matrix[:3, :3].T) + matrix[:3, 3]
        if vectors.determinant(matrix[:3, :3]) < 0.0:  # mirrored: 3.7.4
            faces = faces[:, ::-1]
        return points, faces

    def _refuse(self, what: str, mend: str) -> None:
        raise MeshError(self.where, what, mend)


def strip_triangles(corners: Ints) -> Triangles:
    """Return the triangles of a strip; every second one is turned, so that all face one way (3.7.2.1).

    Parameters
    ----------
    corners : (N,) int
        Of the strip, in order.

    Returns
    -------
    (N - 2, 3) int
        Those that name a corner twice have no area: they lead from one strip to the next.
    """
    count = max(len(corners) - 2, 0)
    odd = np.arange(count) % 2
    first = np.arange(count)
    return np.column_stack([corners[first], corners[first + 1 + odd], corners[first + 2 - odd]])


def _chunks(data: bytes, where: str) -> tuple[GltfObject, bytes | None]:
    """The scene of a GLB, and the bytes behind it; None where it has none (4.4)."""
    _, version, length = struct.unpack("<3I", data[:12])
    if version != 2:
        what = f"is a GLB of version {version}, which is not read"
        raise MeshError(where, what, "export it as glTF 2.0")
    if length > len(data):
        raise DamageError(ANNOUNCES_MORE)
    at, chunks = 12, list[tuple[int, bytes]]()
    while at + 8 <= length and len(chunks) < 2:
        size, kind = struct.unpack("<2I", data[at : at + 8])
        if at + 8 + size > length:
            raise DamageError(ANNOUNCES_MORE)
        chunks.append((kind, data[at + 8 : at + 8 + size]))
        at += 8 + size
    if not chunks or chunks[0][0] != JSON_CHUNK:
        raise DamageError("it does not begin with a scene")
    if len(chunks[0][1]) > MAX_SCENE_BYTES:
        raise DamageError(f"a scene of more than {MAX_SCENE_BYTES >> 20} MB")
    try:
        scene = _require(dict, json.loads(chunks[0][1]))
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise DamageError("its scene is no JSON") from None
    return scene, chunks[1][1] if len(chunks) > 1 and chunks[1][0] == BINARY_CHUNK else None


def _placement(node: GltfObject) -> Floats:
    """(4, 4) from the axes of a node to those of what holds it (3.5.2)."""
    matrix = np.eye(4)
    if "matrix" in node:
        matrix = _floats(node, "matrix", 16).reshape(4, 4).T  # column by column
        if {"translation", "rotation", "scale"} & node.keys():
            raise DamageError("a node with a matrix beside its shift, turn or scale")
        if not np.allclose(matrix[3], (0.0, 0.0, 0.0, 1.0)):
            raise DamageError("a node whose matrix is of no placement")
        return matrix
    if "rotation" in node:
        x, y, z, w = turn = _floats(node, "rotation", 4)
        size = float(np.sqrt(np.square(turn).sum()))
        if not 0.9 < size < 1.1:
            raise DamageError("a node whose turn is no unit quaternion")
        x, y, z, w = turn / size
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    if "scale" in node:
        matrix[:3, :3] *= _floats(node, "scale", 3)
    if "translation" in node:
        matrix[:3, 3] = _floats(node, "translation", 3)
    return matrix


def _floats(holder: GltfObject, name: str, count: int) -> Floats:
    numbers = _list_of(holder, name, (int, float))
    if len(numbers) != count:
        raise DamageError(f"a {name} of {len(numbers)} numbers, not of {count}")
    values = np.array(numbers, dtype=float)
    if not np.isfinite(values).all():
        raise DamageError(f"a {name} that is not finite")
    return values


def _extensions(holder: GltfObject) -> GltfObject:
    """Return the entries of the extensions of a node, a primitive or a buffer view, by their names."""
    return _require(dict, holder.get("extensions", {}))


def _require(kind: type | tuple[type, ...], value: object) -> Any:
    """A value of the scene, which must be of a kind; true and false are no numbers."""
    if not isinstance(value, kind) or isinstance(value, bool):
        raise DamageError(f"its scene has {json.dumps(value):.30} out of place")
    return value


def _whole(value: object) -> int:
    """A number of the scene that counts things or says which."""
    number = _require((int, float), value)
    if number != number or number < 0 or number > 1e15 or number != int(number):
        raise DamageError(f"its scene has {json.dumps(value):.30} out of place")
    return int(number)


def _list_of(holder: GltfObject, name: str, kind: type | tuple[type, ...] = dict) -> list[Any]:
    """A list of the scene, each of a kind; empty where there is none."""
    return [_require(kind, value) for value in _require(list, holder.get(name, []))]
