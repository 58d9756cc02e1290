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
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.errors import DAMAGE, MeshError
from feederscrew.heavy import heavy
from feederscrew.part.formats import MESH_FORMATS, DamageError, Soup, open_archive, refuse_size, unpack_pieces

trimesh = heavy("trimesh")

TESSELLATION_MM, TESSELLATION_RAD = 0.01, 0.1  # between a curved face and its facets, and from facet to facet
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
STEP_UNIT_PATTERNS = (  # the first that a file has; millimetres where there is none
    (rb"CONVERSION_BASED_UNIT\s*\(\s*'INCH", "in"),
    (rb"\.CENTI\.\s*,\s*\.METRE\.", "cm"),
    (rb"SI_UNIT\s*\(\s*\$\s*,\s*\.METRE\.", "m"),
)
MAX_SCENE_BYTES = 1 << 24  # [bytes] of the JSON of a GLB: names of nodes and buffers, not their numbers
COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}  # [bytes] by type: glTF 2.0, 3.6.2.2
MAX_SCENE_NODES, MAX_NODE_DEPTH = 20_000, 50  # instances; nodes within nodes
COMPONENTS_BY_TYPE = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
JSON_NUMBER = (int, float)  # as JSON writes one
logging.getLogger("trimesh").addHandler(logging.NullHandler())  # it would log to stderr


def read_scene(data: bytes, kind: str, where: str) -> Soup:
    """Return the triangles of a GLB or STEP file; ``kind`` is 'glb' or 'step'.

    Raises MeshError at ``where`` if it is damaged, claims more than it holds, or an extra is not installed.
    """
    format = MESH_FORMATS[kind]
    if not all(importlib.util.find_spec(module) for module in format.needs):
        what = f"{format.title} needs {' and '.join(format.needs)}, not installed"
        raise MeshError(where, what, f'pip install "feederscrew[{format.extra}]"')
    unit = "m"
    if kind == "step":
        if data.startswith(b"PK"):  # zipped (.stpz)
            with open_archive(data) as archive:
                names = archive.namelist()
                members = [name for name in names if re.search(r"(?i)\.ste?p$", PurePosixPath(name).name)]
                if len(members) != 1:
                    raise DamageError(f"an archive of {len(members)} STEP files")
                data = b"".join(unpack_pieces(archive, members[0]))
        unit = next((name for pattern, name in STEP_UNIT_PATTERNS if re.search(pattern, data)), "mm")
        # as GLB, in metres; made by OpenCASCADE in a process of its own
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder, "part.step"), Path(folder, "part.glb")
            source.write_bytes(data)
            arguments = [str(each) for each in (source, target, TESSELLATION_MM, TESSELLATION_RAD)]
            call = [sys.executable, "-c", CONVERT_STEP_SCRIPT, *arguments]
            try:
                done = subprocess.run(call, capture_output=True, timeout=STEP_TIMEOUT_S, check=False)
            except subprocess.TimeoutExpired:
                raise DamageError(f"not converted within {STEP_TIMEOUT_S} s") from None
            if done.returncode != 0 or not target.exists():
                raise DamageError("OpenCASCADE cannot convert it")
            data = target.read_bytes()
    _refuse_claims(data, where)
    names, points, faces, sizes, count = [], [np.empty((0, 3))], [np.empty((0, 3), dtype=int)], [], 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
        try:
            scene = trimesh.load_scene(io.BytesIO(data), file_type="glb", process=False, skip_materials=True)
            for node in scene.graph.nodes_geometry:
                transform, name = scene.graph[node]
                mesh = scene.geometry[name]
                if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
                    continue
                mesh = mesh.copy()
                mesh.apply_transform(transform)
                names.append(str(node))
                points.append(np.asarray(mesh.vertices))
                faces.append(np.asarray(mesh.faces))
        except MemoryError:
            raise
        except DAMAGE:  # trimesh's, of any class
            raise DamageError("its scene does not fit what it holds") from None
        for k, own in enumerate(faces[1:], 1):
            if own.min() < 0 or own.max() >= len(points[k]):
                raise DamageError("a facet names a corner that is not there")
            faces[k] = own + count
            sizes.append(len(own))
            count += len(points[k])
        vertices = np.concatenate(points)
        if unit != "m":  # through GLB: in metres, whatever the file was drawn in
            vertices = vertices / units.factor(unit, "length")
    objects = np.repeat(np.arange(len(names)), sizes)
    return Soup(vertices, np.concatenate(faces), kind, unit, names=tuple(names), objects=objects)


def _refuse_claims(data: bytes, where: str) -> None:
    """Refuse a GLB whose scene names more numbers, instances or facets than it holds or than are read."""
    too_much = MeshError(where, "is a damaged GLB: it announces more than it holds", "export the part again")
    _, _, length, chunk = struct.unpack("<4I", data[:16])
    if max(length, 20 + chunk) > len(data):
        raise too_much
    if chunk > MAX_SCENE_BYTES:
        raise DamageError(f"a scene of more than {MAX_SCENE_BYTES >> 20} MB")
    try:
        scene = _require(dict, json.loads(data[20 : 20 + chunk]))
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise DamageError("its scene is no JSON") from None
    for name in _list_of(scene, "extensionsRequired", object):
        if name in ("KHR_draco_mesh_compression", "EXT_meshopt_compression"):
            raise MeshError(where, f"is a GLB packed by {name}, which is not read", "export it unpacked")
    # numbers that the accessors announce, and the bytes behind them
    accessors, total = _list_of(scene, "accessors"), 0
    for accessor in accessors:
        each = COMPONENTS_BY_TYPE[_require(str, accessor["type"])]
        count = int(_require(JSON_NUMBER, accessor["count"])) * each
        least = count * COMPONENT_BYTES[_require(int, accessor["componentType"])]
        view, held = accessor.get("bufferView"), 0
        if view is not None:
            buffer = _require(dict, _list_of(scene, "bufferViews", object)[_require(int, view)])
            held = int(_require(JSON_NUMBER, buffer["byteLength"]))
        if count < 0 or held > len(data) or (least > held and "sparse" not in accessor):
            raise too_much
        total += count
    refuse_size(0, total // 30)  # texture coordinates and normals counted in
    # nodes that are no trees, or deep ones
    nodes = _list_of(scene, "nodes")
    if len(nodes) > MAX_SCENE_NODES:
        raise DamageError(f"more than {MAX_SCENE_NODES} nodes")
    pairs = [
        (_require(int, child), k)
        for k, node in enumerate(nodes)
        for child in _list_of(node, "children", object)
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
    # corners and facets of all instances
    corners = facets = 0
    for node in nodes:
        if "mesh" not in node:
            continue
        mesh = _require(dict, _list_of(scene, "meshes", object)[_require(int, node["mesh"])])
        for primitive in _list_of(mesh, "primitives"):
            at = _require(int, _require(dict, primitive["attributes"])["POSITION"])
            around = _require(int, primitive.get("indices", at))
            corners += int(_require(JSON_NUMBER, accessors[at]["count"]))
            of_facets = int(_require(JSON_NUMBER, accessors[around]["count"]))
            facets += of_facets // (3 if primitive.get("mode", 4) == 4 else 1)
            refuse_size(corners, facets)


def _require(kind: type | tuple[type, ...], value: object) -> Any:
    """A value of the scene, which must be of a kind."""
    if not isinstance(value, kind):
        raise DamageError(f"its scene has {json.dumps(value):.30} out of place")
    return value


def _list_of(holder: dict[str, Any], name: str, kind: type = dict) -> list[Any]:
    """A list of the scene, each of a kind; empty where there is none."""
    return [_require(kind, value) for value in _require(list, holder.get(name, []))]
