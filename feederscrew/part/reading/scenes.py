"""GLB and, through it, STEP: instances placed, by trimesh's scenes, once the file's claims add up."""

import importlib.util
import io
import json
import logging
import struct
import warnings

import numpy as np

from feederscrew import units
from feederscrew.errors import DAMAGE, MeshError
from feederscrew.part.reading import archives, step
from feederscrew.part.reading.formats import FORMATS
from feederscrew.part.reading.soup import DamageError, Soup, refuse_crowds

AGAIN = "export the part again"
LARGEST_SCENE = 1 << 24  # [bytes] of the JSON of a GLB: it names nodes and buffers, the numbers are elsewhere
WIDTHS = {
    5120: 1,
    5121: 1,
    5122: 2,
    5123: 2,
    5125: 4,
    5126: 4,
}  # [bytes] by component type: glTF 2.0, 3.6.2.2
MOST_NODES, DEEPEST = 20_000, 50  # instances; nodes within nodes
NUMBERS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
NUMBER = (int, float)  # as JSON writes one
PACKED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
logging.getLogger("trimesh").addHandler(logging.NullHandler())  # it would log to stderr


def soup(data, kind, where):
    """Return the triangles of a GLB or STEP file.

    Parameters
    ----------
    data : bytes
    kind : str
        'glb' or 'step'.
    where : str
        The file, for error lines.

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If the file is damaged, claims more than it holds, or an extra is not installed.
    """
    format = FORMATS[kind]
    if not all(importlib.util.find_spec(module) for module in format.needs):
        what = f"{format.title} needs {' and '.join(format.needs)}, not installed"
        raise MeshError(where, what, f'pip install "feederscrew[{format.extra}]"')
    unit = "m"
    if kind == "step":
        text = archives.step(data) if data.startswith(b"PK") else data
        unit, data = step.unit(text), step.glb(text)
    _refuse_claims(data, where)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
        try:
            pieces = _pieces(data)
        except MemoryError:
            raise
        except DAMAGE:  # trimesh's, of any class
            raise DamageError("its scene does not fit what it holds") from None
        found = _joined(pieces, kind, unit)
    return found


def _pieces(data):
    """Name, corners and facets of every mesh of the scene where its instances stand, all by trimesh."""
    import trimesh

    scene = trimesh.load_scene(io.BytesIO(data), file_type="glb", process=False, skip_materials=True)
    pieces = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
            continue
        mesh = mesh.copy()
        mesh.apply_transform(transform)
        pieces.append((str(node), np.asarray(mesh.vertices), np.asarray(mesh.faces)))
    return pieces


def _joined(pieces, kind, unit):
    names, points, faces, sizes, count = [], [np.empty((0, 3))], [np.empty((0, 3), dtype=int)], [], 0
    for name, vertices, own in pieces:
        if own.min() < 0 or own.max() >= len(vertices):
            raise DamageError("a facet names a corner that is not there")
        names.append(name)
        points.append(vertices)
        faces.append(own + count)
        sizes.append(len(own))
        count += len(vertices)
    vertices = np.concatenate(points)
    if unit != "m":  # through GLB: in metres, whatever the file was drawn in
        vertices = vertices / units.factor(unit, "length")
    objects = np.repeat(np.arange(len(names)), sizes)
    return Soup(vertices, np.concatenate(faces), kind, unit, names=tuple(names), objects=objects)


def _refuse_claims(data, where):
    """Refuse a GLB whose scene names more numbers, instances or facets than it holds or than are read."""
    _, _, length, chunk = struct.unpack("<4I", data[:16])
    if max(length, 20 + chunk) > len(data):
        raise MeshError(where, "is a damaged GLB: it announces more than it holds", AGAIN)
    if chunk > LARGEST_SCENE:
        raise DamageError(f"a scene of more than {LARGEST_SCENE >> 20} MB")
    try:
        scene = _of(dict, json.loads(data[20 : 20 + chunk]))
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise DamageError("its scene is no JSON") from None
    needed = [name for name in _listed(scene, "extensionsRequired") if name in PACKED]
    if needed:
        raise MeshError(where, f"is a GLB packed by {needed[0]}, which is not read", "export it unpacked")
    accessors = [_of(dict, accessor) for accessor in _listed(scene, "accessors")]
    numbers = [_announced(accessor, scene, len(data), where) for accessor in accessors]
    refuse_crowds(0, sum(numbers) // 30)  # texture coordinates and normals counted in
    nodes = [_of(dict, node) for node in _listed(scene, "nodes")]
    _refuse_nests(nodes)
    corners = facets = 0
    for node in nodes:
        mesh = _of(dict, _listed(scene, "meshes")[_of(int, node["mesh"])]) if "mesh" in node else {}
        for primitive in _listed(mesh, "primitives"):
            at = _of(int, _of(dict, _of(dict, primitive)["attributes"])["POSITION"])
            around = _of(int, primitive.get("indices", at))
            corners += int(_of(NUMBER, accessors[at]["count"]))
            around_count = int(_of(NUMBER, accessors[around]["count"]))
            facets += around_count // (3 if primitive.get("mode", 4) == 4 else 1)
            refuse_crowds(corners, facets)


def _of(kind, value):
    """A value of the scene, which must be of a kind."""
    if not isinstance(value, kind):
        raise DamageError(f"its scene has {json.dumps(value):.30} out of place")
    return value


def _listed(holder, name):
    return _of(list, holder.get(name, []))


def _refuse_nests(nodes):
    """Refuse nodes that are no trees, or deep ones."""
    if len(nodes) > MOST_NODES:
        raise DamageError(f"more than {MOST_NODES} nodes")
    pairs = [
        (_of(int, child), parent) for parent, node in enumerate(nodes) for child in _listed(node, "children")
    ]
    parents = dict(pairs)
    if len(parents) != len(pairs):
        raise DamageError("a node within two others")
    for node in parents:
        depth = 0
        while node in parents:
            node, depth = parents[node], depth + 1
            if depth > DEEPEST:
                raise DamageError(f"nodes within nodes more than {DEEPEST} deep")


def _announced(accessor, scene, size, where):
    """How many numbers an accessor announces; refused where its bytes are not there."""
    count = int(_of(NUMBER, accessor["count"])) * NUMBERS[_of(str, accessor["type"])]
    least = count * WIDTHS[_of(int, accessor["componentType"])]
    view = accessor.get("bufferView")
    buffer = {} if view is None else _of(dict, _listed(scene, "bufferViews")[_of(int, view)])
    held = 0 if view is None else int(_of(NUMBER, buffer["byteLength"]))
    if count < 0 or held > size or (least > held and "sparse" not in accessor):
        raise MeshError(where, "is a damaged GLB: it announces more than it holds", AGAIN)
    return count
