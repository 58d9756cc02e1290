"""OBJ, PLY, OFF, GLB, 3MF and STEP, through trimesh's scenes: instances placed, then joined."""

import importlib.util
import io
import json
import logging
import re
import struct
import warnings
import zipfile
import zlib
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.errors import DAMAGE, MeshError
from feederscrew.part.reading import step, threemf
from feederscrew.part.reading.formats import FORMATS, plain
from feederscrew.part.reading.soup import LARGEST, Soup

MOST = 20_000_000  # facets, instances counted
ARCHIVES = (zipfile.BadZipFile, zlib.error)  # what damaged archives raise
REFUSED: tuple[type[Exception], ...] = (*DAMAGE, *ARCHIVES, DeprecationWarning)
THREEMF_UNITS = {  # the units of the specification, and one of ours with how many of it they are
    "micron": ("mm", 1e-3),
    "centimeter": ("cm", 1.0),
    "inch": ("in", 1.0),
    "foot": ("in", 12.0),
    "meter": ("m", 1.0),
}
AGAIN = "export the part again"
logging.getLogger("trimesh").addHandler(logging.NullHandler())  # it would log to stderr


def soup(data, kind, where):
    """Return the triangles of a mesh file that trimesh reads as a scene.

    Parameters
    ----------
    data : bytes
    kind : str
        A key of ``FORMATS`` that names a loader.
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
    try:
        if _claims(data, kind) > len(data):
            raise MeshError(where, f"is a damaged {format.title}: it announces more than it holds", AGAIN)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
            meshes, unit = _meshes(data, kind, where)
            return _joined(meshes, unit, data, kind)
    except REFUSED as error:
        raise MeshError(where, f"is a damaged {format.title} ({_reason(error)})", AGAIN) from None


def _meshes(data, kind, where):
    """Every mesh of the scene where its instances stand, and the scene's unit."""
    import trimesh

    loader = FORMATS[kind].loader
    options: dict[str, Any] = {"skip_materials": True} if kind == "obj" else {}
    if kind == "step":
        data = step.glb(data)
    if kind == "3mf":
        threemf.refuse_bombs(data)
    if kind in ("obj", "off", "ply"):
        text, mark, rest = data.partition(b"end_header") if kind == "ply" else (data, b"", b"")
        data = plain(text) + mark + rest
    scene = trimesh.load_scene(io.BytesIO(data), file_type=loader, process=False, **options)
    surfaces = {name: len(mesh.faces) for name, mesh in scene.geometry.items() if hasattr(mesh, "faces")}
    count = sum(surfaces.get(scene.graph[node][1], 0) for node in scene.graph.nodes_geometry)
    if count > MOST:
        raise MeshError(where, f"has {count} facets", "export it with fewer facets")
    meshes = [mesh for mesh in scene.dump() if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces)]
    return meshes, scene.units


def _joined(meshes, unit, data, kind):
    for mesh in meshes:
        if mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices):
            raise ValueError("a facet names a corner that is not there")
    sizes = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    vertices = np.concatenate([np.empty((0, 3)), *(mesh.vertices for mesh in meshes)])
    moved = [mesh.faces + start for mesh, start in zip(meshes, sizes)]
    faces = np.concatenate([np.empty((0, 3), dtype=int), *moved])
    if kind == "step":  # through GLB: in metres, whatever the file was drawn in
        unit = step.unit(data)
        vertices = vertices / units.factor(unit, "length")
    if kind == "3mf":
        unit, factor = THREEMF_UNITS.get((unit or "").rstrip("s"), ("mm", 1.0))
        vertices = vertices * factor
    stated = {"glb": "m", "step": unit, "3mf": unit}.get(kind)
    return Soup(vertices, faces, kind, stated)


def _claims(data, kind):
    """How many elements a file announces; each takes a byte at least."""
    if kind == "ply":
        header = data.partition(b"end_header")[0]
        return sum(int(count) for count in re.findall(rb"(?m)^\s*element\s+\S+\s+(\d+)", header))
    if kind == "glb":
        _, _, length, chunk = struct.unpack("<4I", data[:16])
        if length > len(data):
            return length
        document = json.loads(data[20 : 20 + chunk])
        return max([0, *(int(accessor["count"]) for accessor in document.get("accessors", ()))])
    if kind == "3mf":
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            packed_out = sum(member.file_size for member in archive.infolist())
        return packed_out if packed_out > LARGEST else 0
    return 0


def _reason(error):
    words = " ".join(str(error).split()) or type(error).__name__
    return words if len(words) <= 60 else words[:57] + "..."
