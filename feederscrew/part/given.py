"""A part in memory: a mesh of trimesh, corners with facets, or a solid of build123d or cadquery."""

import hashlib
import tempfile
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.errors import ArgumentError, printable
from feederscrew.base.records import ReadableRecord
from feederscrew.part.formats import PartFile, Soup

CAD_UNIT = "mm"  # both CAD libraries model in it, and write it without saying so
CAD_TOLERANCE_MM = 5e-3  # of a facet from the curved surface that it stands for
CAD_ANGLE_RAD = 0.1  # between one facet of a curved surface and the next
CAD_LIBRARIES = ("build123d", "cadquery")
NAME = "part"  # of one that has no name of its own
UNIT_NAMES = {
    **dict.fromkeys(("mm", "millimeter", "millimeters", "millimetre", "millimetres"), "mm"),
    **dict.fromkeys(("cm", "centimeter", "centimeters", "centimetre", "centimetres"), "cm"),
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("um", "micron", "microns", "micrometer", "micrometers"), "um"),
    **dict.fromkeys(("in", "inch", "inches"), "in"),
}
MEND = "give the path of a file, a mesh, (vertices, faces), or a solid of build123d or cadquery"


@runtime_checkable
class TriangleMesh(Protocol):
    """A mesh of trimesh, or what has corners and facets as it has."""

    @property
    def vertices(self) -> Any:
        """(V, 3) corners."""

    @property
    def faces(self) -> Any:
        """(F, 3) indices, counter-clockwise seen from outside."""


Given: TypeAlias = TriangleMesh | tuple[ArrayLike, ArrayLike]


def cad_library(source: object) -> str | None:
    """Return the library that a solid or a workplane is of.

    Parameters
    ----------
    source : object

    Returns
    -------
    str or None
        'build123d' or 'cadquery'; None for anything else.
    """
    modules = (kind.__module__.partition(".")[0] for kind in type(source).__mro__)
    return next((name for name in modules if name in CAD_LIBRARIES), None)


def is_given(source: object) -> bool:
    """Tell whether a part is an object in memory: a mesh, corners with facets, or a solid of CAD.

    Parameters
    ----------
    source : object

    Returns
    -------
    bool
        False for a path, and for a ``Part``, which has been loaded already.
    """
    is_mesh = isinstance(source, (tuple, list, TriangleMesh)) and not isinstance(source, ReadableRecord)
    return is_mesh or cad_library(source) is not None  # a Part has been loaded


def read_mesh(source: Any) -> tuple[PartFile, Soup]:
    """Return the triangles of a mesh or of (vertices, faces), and what to call them.

    Parameters
    ----------
    source : TriangleMesh or (vertices, faces)
        Corners (V, 3) in metres, unless the mesh says its unit (``mesh.units`` of trimesh), and facets (F,
        3).

    Returns
    -------
    file : PartFile
        A name and a digest of corners and facets; no bytes.
    soup : Soup

    Raises
    ------
    ArgumentError
        If corners or facets are not (N, 3) numbers, or a facet has a corner that is not there.
    """
    pair = isinstance(source, (tuple, list))
    if pair and len(source) != 2:
        raise ArgumentError("source", f"has {len(source)} entries", MEND)
    given = source if pair else (source.vertices, source.faces)
    try:
        vertices, faces = np.asarray(given[0], dtype=float), np.asarray(given[1])
    except (TypeError, ValueError):
        raise ArgumentError("source", "has corners that are not numbers", MEND) from None
    for name, array in (("vertices", vertices), ("faces", faces)):
        if array.ndim != 2 or array.shape[1] != 3 or not len(array):
            raise ArgumentError("source", f"{name} have the shape {array.shape}, not (N, 3)", MEND)
    if faces.dtype.kind not in "iu" or faces.min() < 0 or faces.max() >= len(vertices):
        raise ArgumentError("source", "faces are not indices of corners", "give whole numbers from 0")
    metadata = getattr(source, "metadata", None) or {}
    stem = Path(str(metadata.get("file_name") or metadata.get("name") or NAME)).stem
    corners, facets = np.ascontiguousarray(vertices, "<f8"), np.ascontiguousarray(faces, "<i8")
    unit = UNIT_NAMES.get(str(getattr(source, "units", None) or "m").lower(), "m")
    digest = hashlib.sha256(corners.tobytes() + facets.tobytes()).hexdigest()
    name = printable(stem)
    return PartFile(name, name, name, "", b"", digest), Soup(corners, facets, "mesh", unit)


def export_solid(source: Any, folder: Path) -> Path:
    """Write a solid of build123d or cadquery as STL into a folder, by its library, and return the file.

    Parameters
    ----------
    source : object
        A solid, a builder, a workplane or an assembly of one of ``CAD_LIBRARIES``.
    folder : Path

    Returns
    -------
    Path
        Named after the label of the solid, or 'part.stl'; lengths in mm, facets within ``CAD_TOLERANCE_MM``.

    Raises
    ------
    ArgumentError
        If its library cannot write it.
    """
    library = str(cad_library(source))
    stem = printable(str(getattr(source, "label", "") or NAME)).replace("/", "_")
    path = folder / f"{stem}.stl"
    try:
        if library == "build123d":
            writer = import_module(library).export_stl
            solid = getattr(source, "part", None) or source  # of a builder
            writer(solid, str(path), tolerance=CAD_TOLERANCE_MM, angular_tolerance=CAD_ANGLE_RAD)
        else:
            writer = import_module(library).exporters.export
            solid = source.toCompound() if hasattr(source, "toCompound") else source  # of an assembly
            writer(solid, str(path), tolerance=CAD_TOLERANCE_MM, angularTolerance=CAD_ANGLE_RAD)
    except (TypeError, ValueError, AttributeError, RuntimeError, OSError) as error:
        reason = " ".join(str(error).split())[:80]
        raise ArgumentError(
            "source", f"{library} cannot write it as STL ({reason})", "give a solid"
        ) from None
    if not path.exists():
        raise ArgumentError("source", f"{library} has written nothing of it", "give a solid")
    return path


def solid_in_file(source: Any) -> tuple[str, bytes]:
    """Return the name of a solid of CAD and its STL.

    Parameters
    ----------
    source : object
        As ``export_solid`` takes it.

    Returns
    -------
    name : str
    stl : bytes

    Raises
    ------
    ArgumentError
        If its library cannot write it.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = export_solid(source, Path(folder))
        return path.stem, path.read_bytes()
