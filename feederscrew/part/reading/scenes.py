"""GLB and, through it, STEP: instances placed by trimesh's scenes, once the claims of the file add up."""

import importlib.util
import io
import json
import logging
import re
import struct
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

from feederscrew import units
from feederscrew.errors import DAMAGE, MeshError
from feederscrew.heavy import heavy
from feederscrew.part.reading import formats
from feederscrew.part.reading.formats import MESH_FORMATS
from feederscrew.part.reading.soup import DamageError, Soup, refuse_size

trimesh = heavy("trimesh")

TESSELLATION_MM, TESSELLATION_RAD = (
    0.01,
    0.1,
)  # [mm, rad] between a curved face and its facets, and from facet to facet
STEP_TIMEOUT_S = 60  # [s]
STEP_MEMORY_BYTES = 3 << 30  # [bytes]
CONVERT_STEP_SCRIPT = """
import ctypes, signal, sys
if sys.platform == "linux":
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # it ends when its parent does, however that ends
if hasattr(signal, "alarm"):
    signal.alarm(PATIENCE + 5)  # and after its time in any case
try:
    import resource  # what it needs beyond that is no fed part
    least = min(bytes for bytes in (MOST_MEMORY, *resource.getrlimit(resource.RLIMIT_AS)) if bytes > 0)
    resource.setrlimit(resource.RLIMIT_AS, (least, least))
except (ImportError, ValueError, OSError):
    pass
import cascadio
source, target, *tolerances = sys.argv[1:]
sys.exit(cascadio.step_to_glb(source, target, *map(float, tolerances), use_parallel=False))
""".replace("PATIENCE", str(STEP_TIMEOUT_S)).replace("MOST_MEMORY", str(STEP_MEMORY_BYTES))
STEP_UNIT_PATTERNS = ((rb"CONVERSION_BASED_UNIT\s*\(\s*'INCH", "in"), (rb"\.CENTI\.\s*,\s*\.METRE\.", "cm"))
STEP_METRE_PATTERN = rb"SI_UNIT\s*\(\s*\$\s*,\s*\.METRE\."


def convert_step(data) -> bytes:
    """Convert a STEP file to GLB, in metres.

    Parameters
    ----------
    data : bytes

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        If it cannot be converted.
    """
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "part.step"), Path(folder, "part.glb")
        source.write_bytes(data)
        call = [
            sys.executable,
            "-c",
            CONVERT_STEP_SCRIPT,
            str(source),
            str(target),
            str(TESSELLATION_MM),
            str(TESSELLATION_RAD),
        ]
        try:
            done = subprocess.run(call, capture_output=True, timeout=STEP_TIMEOUT_S, check=False)
        except subprocess.TimeoutExpired:
            raise DamageError(f"not converted within {STEP_TIMEOUT_S} s") from None
        if done.returncode != 0 or not target.exists():
            raise DamageError("OpenCASCADE cannot convert it")
        return target.read_bytes()


def read_step_unit(data) -> str:
    """Return the length unit a STEP file is drawn in; millimetres where it does not tell."""
    for pattern, name in STEP_UNIT_PATTERNS:
        if re.search(pattern, data):
            return name
    return "m" if re.search(STEP_METRE_PATTERN, data) else "mm"


EXPORT_AGAIN = "export the part again"
MAX_SCENE_BYTES = (
    1 << 24
)  # [bytes] of the JSON of a GLB: it names nodes and buffers, the numbers are elsewhere
COMPONENT_BYTES = {
    5120: 1,
    5121: 1,
    5122: 2,
    5123: 2,
    5125: 4,
    5126: 4,
}  # [bytes] by component type: glTF 2.0, 3.6.2.2
MAX_SCENE_NODES, MAX_NODE_DEPTH = 20_000, 50  # instances; nodes within nodes
COMPONENTS_BY_TYPE = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
JSON_NUMBER = (int, float)  # as JSON writes one
PACKED_EXTENSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
logging.getLogger("trimesh").addHandler(logging.NullHandler())  # it would log to stderr


def read_scene(data, kind, where) -> Soup:
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
    format = MESH_FORMATS[kind]
    if not all(importlib.util.find_spec(module) for module in format.needs):
        what = f"{format.title} needs {' and '.join(format.needs)}, not installed"
        raise MeshError(where, what, f'pip install "feederscrew[{format.extra}]"')
    unit = "m"
    if kind == "step":
        text = formats.unpack_step(data) if data.startswith(b"PK") else data
        unit, data = read_step_unit(text), convert_step(text)
    _refuse_claims(data, where)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
        try:
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
        except MemoryError:
            raise
        except DAMAGE:  # trimesh's, of any class
            raise DamageError("its scene does not fit what it holds") from None
        joined = _join_meshes(pieces, kind, unit)
    return joined


def _join_meshes(pieces, kind, unit) -> Soup:
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


def _refuse_claims(data, where) -> None:
    """Refuse a GLB whose scene names more numbers, instances or facets than it holds or than are read."""
    _, _, length, chunk = struct.unpack("<4I", data[:16])
    if max(length, 20 + chunk) > len(data):
        raise MeshError(where, "is a damaged GLB: it announces more than it holds", EXPORT_AGAIN)
    if chunk > MAX_SCENE_BYTES:
        raise DamageError(f"a scene of more than {MAX_SCENE_BYTES >> 20} MB")
    try:
        scene = _require_kind(dict, json.loads(data[20 : 20 + chunk]))
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise DamageError("its scene is no JSON") from None
    needed = [name for name in _scene_list(scene, "extensionsRequired") if name in PACKED_EXTENSIONS]
    if needed:
        raise MeshError(where, f"is a GLB packed by {needed[0]}, which is not read", "export it unpacked")
    accessors = [_require_kind(dict, accessor) for accessor in _scene_list(scene, "accessors")]
    numbers = [_announced_numbers(accessor, scene, len(data), where) for accessor in accessors]
    refuse_size(0, sum(numbers) // 30)  # texture coordinates and normals counted in
    nodes = [_require_kind(dict, node) for node in _scene_list(scene, "nodes")]
    _refuse_nests(nodes)
    corners = facets = 0
    for node in nodes:
        mesh = (
            _require_kind(dict, _scene_list(scene, "meshes")[_require_kind(int, node["mesh"])])
            if "mesh" in node
            else {}
        )
        for primitive in _scene_list(mesh, "primitives"):
            at = _require_kind(
                int, _require_kind(dict, _require_kind(dict, primitive)["attributes"])["POSITION"]
            )
            around = _require_kind(int, primitive.get("indices", at))
            corners += int(_require_kind(JSON_NUMBER, accessors[at]["count"]))
            around_count = int(_require_kind(JSON_NUMBER, accessors[around]["count"]))
            facets += around_count // (3 if primitive.get("mode", 4) == 4 else 1)
            refuse_size(corners, facets)


def _require_kind(kind, value):
    """A value of the scene, which must be of a kind."""
    if not isinstance(value, kind):
        raise DamageError(f"its scene has {json.dumps(value):.30} out of place")
    return value


def _scene_list(holder, name):
    return _require_kind(list, holder.get(name, []))


def _refuse_nests(nodes) -> None:
    """Refuse nodes that are no trees, or deep ones."""
    if len(nodes) > MAX_SCENE_NODES:
        raise DamageError(f"more than {MAX_SCENE_NODES} nodes")
    pairs = [
        (_require_kind(int, child), parent)
        for parent, node in enumerate(nodes)
        for child in _scene_list(node, "children")
    ]
    parents = dict(pairs)
    if len(parents) != len(pairs):
        raise DamageError("a node within two others")
    for node in parents:
        depth = 0
        while node in parents:
            node, depth = parents[node], depth + 1
            if depth > MAX_NODE_DEPTH:
                raise DamageError(f"nodes within nodes more than {MAX_NODE_DEPTH} deep")


def _announced_numbers(accessor, scene, size, where) -> int:
    """How many numbers an accessor announces; refused where its bytes are not there."""
    count = (
        int(_require_kind(JSON_NUMBER, accessor["count"]))
        * COMPONENTS_BY_TYPE[_require_kind(str, accessor["type"])]
    )
    least = count * COMPONENT_BYTES[_require_kind(int, accessor["componentType"])]
    view = accessor.get("bufferView")
    buffer = (
        {}
        if view is None
        else _require_kind(dict, _scene_list(scene, "bufferViews")[_require_kind(int, view)])
    )
    held = 0 if view is None else int(_require_kind(JSON_NUMBER, buffer["byteLength"]))
    if count < 0 or held > size or (least > held and "sparse" not in accessor):
        raise MeshError(where, "is a damaged GLB: it announces more than it holds", EXPORT_AGAIN)
    return count
