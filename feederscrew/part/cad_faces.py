"""Faces of a STEP file that the kernel meshes on the wrong side of their edges: found and named."""

import re
from typing import Any

import numpy as np

from feederscrew.base import units
from feederscrew.base.arrays import Floats, Vector
from feederscrew.base.errors import MeshError
from feederscrew.base.geometry import vectors
from feederscrew.base.heavy import heavy
from feederscrew.base.units import counted
from feederscrew.part import glb, topology
from feederscrew.part.formats import CadFaces, Soup
from feederscrew.part.gate import Crossings

spatial = heavy("scipy.spatial")

RULED_FACES = ("plane", "cylinder", "cone")  # they lie within the box of their own edges
LEAVING_SHARE = 0.02  # [1] of the box of all edges: facets of such a face leave their own box by less
FREE_LEAVING_SHARE = 0.6  # [1] of the same: a face of any surface leaves it by less; half a ball does by 0.5
CUT_FACETS_SHARE = 0.01  # [1] pairs of facets that cut each other, of all facets: more is no rounding
EXPORT_MESH = "export it from CAD as STL or 3MF"
STEP_TEXT = re.compile(rb"'(?:[^']|'')*'")
STEP_ENTITY = re.compile(rb"#(\d+)\s*=\s*([A-Z0-9_]+)\s*\(([^;]*)\)\s*;")
STEP_ARGUMENT = re.compile(rb"#(\d+)|\.([TF])\.|[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
UNSURE_SENSE = re.compile(rb"\b(?:OPEN_SHELL|ORIENTED_FACE|FACE_SURFACE)\b")  # a face may be turned elsewhere
ROUND_SURFACES = {
    b"SPHERICAL_SURFACE": "sphere", b"TOROIDAL_SURFACE": "torus", b"CYLINDRICAL_SURFACE": "cylinder",
}  # fmt: skip
PLACED = (*ROUND_SURFACES, b"PLANE", b"AXIS2_PLACEMENT_3D", b"CARTESIAN_POINT", b"DIRECTION")
Signature = tuple[str, ...]  # kind of a surface, and its sizes [m] as text
Entities = dict[bytes, tuple[bytes, list[Any]]]  # name and arguments by number: numbers of others are bytes


def find_cad_faces(document: glb.Document, pieces: list[glb.Piece], data: bytes, unit: str) -> CadFaces:
    """Compare the facets of each face of a STEP file with its edges and with what the file says.

    Parameters
    ----------
    document : Document
        The scene that OpenCASCADE made of the file, with the face of each facet.
    pieces : list of Piece
        Its instances [m].
    data : bytes
        The STEP file.
    unit : str
        In which it was drawn.

    Returns
    -------
    CadFaces

    Notes
    -----
    OpenCASCADE meshes some faces on the wrong side of their edges, most of them on spheres. Of a plane, a
    cylinder or a cone such facets leave the box of the face's own edges. Of any surface they face the other
    way than the file says: along its normal where ``same_sense`` is true (ISO 10303-42, face_surface). A
    whole shell may be turned, so a face counts as turned where it disagrees and most of its solid agree. A
    file that is wrong there itself is mended by the kernel: such a face is wrong only if it also leaves the
    box of all edges.
    """
    size = units.factor(unit, "length")
    senses = _read_senses(data, size)
    of_facet, titles = [np.empty(0, dtype=np.int64)], list[str]()
    leaving, turned, wrong = list[float](), list[bool](), list[bool]()
    for piece in pieces:
        entry = piece.extensions.get(glb.BREP_FACES)
        face, surfaces = np.zeros(len(piece.faces), dtype=np.int64), dict[int, dict[str, Any]]()
        if entry is not None:
            face = np.asarray(document.numbers(int(entry["faceIndices"])), dtype=np.int64)
            surfaces = {int(surface["face_index"]): surface for surface in entry["faces"]}
        count = int(face.max(initial=0)) + 1
        of_facet.append(face + len(titles))
        # edges of faces are sides of one facet only: each face has corners of its own
        edges = topology.edge_table(piece.faces, len(piece.vertices))
        rim = np.flatnonzero(edges.net)
        ends = piece.vertices[np.stack([edges.low[rim], edges.high[rim]], axis=1)]
        of_rim = face[edges.order[edges.start[rim]] // 3]
        low, high = _box(ends)
        reach = float((high - low).max())
        corners = piece.vertices[piece.faces]
        # how far each face leaves its box; 1 where it is as the file says, -1 where not, 0 where nobody knows
        leaves, agrees, is_ruled = np.zeros(count), np.zeros(count), np.zeros(count, dtype=bool)
        for k in range(count):
            mine, surface = corners[face == k], surfaces.get(k, {"type": ""})
            titles.append(f"face {k + 1} of {count}{_surface_title(surface, unit)}")
            if not len(mine):
                continue
            is_ruled[k] = surface["type"] in RULED_FACES
            inner, outer = _box(ends[of_rim == k]) if is_ruled[k] else (low, high)
            first, last = _box(mine)
            leaves[k] = np.maximum(inner - first, last - outer).max()
            if said := senses.get(_signature(surface), 0):
                agrees[k] = said * _outwards(mine, surface, piece.matrix)
        is_turned = agrees * np.sign(agrees.sum()) < 0.0
        most = np.where(is_ruled | is_turned, LEAVING_SHARE, FREE_LEAVING_SHARE) * reach
        if agrees.any() and not agrees.sum():  # as many of one as of the other: any may be turned
            is_turned = agrees != 0.0
        leaving += leaves.tolist()
        turned += (is_turned & ~is_ruled).tolist()  # a ruled face that is turned keeps its place
        wrong += (leaves > most).tolist()
    return CadFaces(
        of_facet=np.concatenate(of_facet),
        titles=tuple(titles),
        leaving=np.array(leaving) / size,
        is_turned=np.array(turned, dtype=bool),
        is_wrong=np.array(wrong, dtype=bool),
    )


def refuse_wrong_sides(
    soup: Soup, crossings: Crossings, where: str, unit: str, allow_open: bool
) -> tuple[str, ...]:
    """Refuse a mesh of a kernel whose faces are on the wrong side of their edges, or cut each other often.

    Parameters
    ----------
    soup : Soup
    crossings : Crossings
        Facets that cut each other, in the unit of the file.
    where, unit : str
        Of the file, for the error line.
    allow_open : bool
        Whether cuts alone are let pass.

    Returns
    -------
    tuple of str
        What to warn of: faces that face the other way than the file says, and are in their place.

    Raises
    ------
    MeshError
        Naming the face that leaves its edges furthest, or that most cuts are on.
    """
    faces = soup.cad_faces
    if faces is None:
        return ()
    pairs = len(crossings.pairs)
    cuts = f"{counted(pairs, 'pair')} of facets cut each other"
    if faces.is_wrong.any():
        worst = int(np.argmax(np.where(faces.is_wrong, faces.leaving, -1.0)))
        what = (
            f"{faces.titles[worst]}, is meshed on the wrong side: its facets leave the box of its edges by "
        )
        what += f"{faces.leaving[worst]:.3g} {unit}" + (f", and {cuts}" if pairs else "")
        raise MeshError(where, what, EXPORT_MESH)
    if pairs > CUT_FACETS_SHARE * len(soup.faces) and not allow_open:
        centres = soup.vertices[soup.faces].mean(axis=1)
        _, nearest = spatial.cKDTree(centres).query(crossings.points)
        most = int(np.argmax(np.bincount(faces.of_facet[nearest])))
        what = f"the kernel's mesh passes through itself: {cuts}, most of them on {faces.titles[most]}"
        raise MeshError(where, what, f"{EXPORT_MESH}, or pass `allow_open` to compute from what there is")
    if not faces.is_turned.any():
        return ()
    first = faces.titles[int(np.argmax(faces.is_turned))]
    number = int(faces.is_turned.sum())
    more = f" and {counted(number - 1, 'other')}" if number > 1 else ""
    return (f"{first},{more} faces the other way than the file says: check the volume",)


def _box(points: Floats) -> tuple[Vector, Vector]:
    """Return least and largest coordinates of points (..., 3); without points a box that nothing leaves."""
    points = points.reshape(-1, 3)
    if not len(points):
        return np.full(3, -np.inf), np.full(3, np.inf)
    return points.min(axis=0), points.max(axis=0)


def _surface_title(surface: dict[str, Any], unit: str) -> str:
    """Return the surface that a face lies on, for people: ', a sphere of radius 60 mm'."""
    radius = surface.get("radius", surface.get("minor_radius"))
    if radius is None:
        return f", a {surface['type']}" if surface["type"] else ""
    return f", a {surface['type']} of radius {radius / units.factor(unit, 'length'):.4g} {unit}"


def _read_senses(data: bytes, size: float) -> dict[Signature, int]:
    """Which way faces of a STEP file face: 1 along the normal of their surface, -1 against it, 0 both.

    A plane's normal is turned to the side of the first coordinate that it has. ``size`` [m] is that of the
    file's unit. Empty for a file in which something else may turn a face.
    """
    plain = STEP_TEXT.sub(b"", data)
    if UNSURE_SENSE.search(plain):
        return {}
    entities: Entities = {}
    faces, shells, against = list[tuple[bytes, bytes, int]](), dict[bytes, list[bytes]](), set[bytes]()
    for number, name, text in STEP_ENTITY.findall(plain):
        arguments = list(STEP_ARGUMENT.finditer(text))
        if name == b"ADVANCED_FACE" and len(arguments) > 1:
            reference, flag = arguments[-2:]
            faces.append((number, reference[1] or b"", 1 if flag[2] == b"T" else -1))
        elif name == b"CLOSED_SHELL":
            shells[number] = [match[1] for match in arguments]
        elif name == b"ORIENTED_CLOSED_SHELL" and arguments and arguments[-1][2] == b"F":
            against.add(arguments[0][1])
        elif name in PLACED:
            entities[number] = name, [match[1] or float(match[0]) for match in arguments if not match[2]]
    reversed_faces = {face for shell in against for face in shells.get(shell, ())}
    senses: dict[Signature, int] = {}
    for number, surface_number, sense in faces:
        try:
            surface = _surface(entities[surface_number], entities, size)
        except (LookupError, TypeError, ValueError):  # of a file that the kernel mends, or does not read
            continue
        own = sense * surface.pop("side", 1) * (-1 if number in reversed_faces else 1)
        signature = _signature(surface)
        senses[signature] = own if senses.get(signature, own) == own else 0
    return senses


def _surface(entity: tuple[bytes, list[Any]], entities: Entities, size: float) -> dict[str, Any]:
    """A surface of a STEP file as the kernel names it, in metres; LookupError where it is of another kind."""
    name, (placement, *sizes) = entity
    if name == b"TOROIDAL_SURFACE":
        return {"type": "torus", "major_radius": sizes[0] * size, "minor_radius": sizes[1] * size}
    if name in ROUND_SURFACES:
        return {"type": ROUND_SURFACES[name], "radius": sizes[0] * size}
    if name != b"PLANE":
        raise LookupError
    place, *axes = (entities[number][1] for number in entities[placement][1])
    normal = vectors.unit(np.array(axes[0], dtype=float)) if axes else np.array([0.0, 0.0, 1.0])
    return {
        "type": "plane",
        "normal": normal,
        "origin": np.array(place, dtype=float) * size,
        "side": _side(normal),
    }


def _side(normal: Vector) -> int:
    """1 where the first coordinate of a normal that is not about 0 is positive, else -1."""
    return 1 if normal[int(np.argmax(np.abs(normal) > 1e-6))] > 0.0 else -1


def _signature(surface: dict[str, Any]) -> Signature:
    """Return what tells a surface from the others of its part, alike from the file and from the kernel."""
    kind = surface["type"]
    if kind == "plane":
        normal = np.array(surface["normal"], dtype=float) + 0.0
        normal *= _side(normal)
        height = float(vectors.dot(normal, np.asarray(surface["origin"], dtype=float)))
        return kind, *(f"{number:.4f}" for number in normal + 0.0), f"{height + 0.0:.7f}"
    return kind, *(
        f"{surface[name]:.5e}" for name in ("radius", "major_radius", "minor_radius") if name in surface
    )


def _outwards(triangles: Floats, surface: dict[str, Any], matrix: Floats) -> float:
    """1 where triangles (F, 3, 3) [m] face along the normal of their surface, else -1.

    ``matrix`` (4, 4) takes the surface to the axes of the triangles. The normal of a plane is that of
    ``_side``; those of round surfaces point away from their middle: point, axis or circle.
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = vectors.cross(b - a, c - a)

    def turned(name: str) -> Vector:
        return vectors.dot(matrix[:3, :3], np.asarray(surface[name], dtype=float))

    if surface["type"] == "plane":
        own = np.array(surface["normal"], dtype=float)
        return float(np.sign((normals * turned("normal")).sum() * _side(own)))
    middle = turned("center" if "center" in surface else "origin") + matrix[:3, 3]
    away = (a + b + c) / 3.0 - middle
    if surface["type"] != "sphere":
        axis = vectors.unit(turned("axis"))
        flat = away - np.einsum("fx,x->f", away, axis)[:, None] * axis
        away = flat if surface["type"] == "cylinder" else away - surface["major_radius"] * vectors.unit(flat)
    return float(np.sign((normals * away).sum()))
