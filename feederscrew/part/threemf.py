"""3MF files by their meaning: parts are taken, negative parts cut out, supports and modifiers left out.

3MF Core Specification 1.3 and the Production Extension 1.2; what slicers add in files of their own.
"""

import posixpath
import re
import zipfile
from array import array
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any
from urllib.parse import unquote
from xml.parsers import expat

import numpy as np

from feederscrew.base.arrays import Floats, Points, Triangles
from feederscrew.base.errors import MeshError
from feederscrew.base.geometry import vectors
from feederscrew.base.heavy import heavy
from feederscrew.base.units import counted, listed, quantity_text
from feederscrew.part import formats, topology
from feederscrew.part.formats import MAX_MESH_BYTES, MAX_READ_FACETS, DamageError, Soup, refuse_size

manifold3d = heavy("manifold3d")

MAX_INSTANCES, MAX_COMPONENT_DEPTH = 5_000, 50  # instances; components within components
MAX_PLACED_OBJECTS = 100_000  # objects, or items and components
MAX_ELEMENT_NAMES = 1_000  # of elements: a dozen, and those of extensions
MAX_CONFIG_BYTES = 1 << 24  # [bytes] of what a slicer adds
UNITS_3MF = {  # of the specification: one of ours, and how many of it they are
    "micron": ("um", 1.0),
    "millimeter": ("mm", 1.0),
    "centimeter": ("cm", 1.0),
    "inch": ("in", 1.0),
    "foot": ("in", 12.0),
    "meter": ("m", 1.0),
}
PART_ROLE = "part"
NEGATIVE_ROLE = "negative"
MODIFIER_ROLE = "modifier"
SURFACE_ROLE = "surface"  # a part if it is closed: FreeCAD 0.20 and 0.21 call every object that
UNDECIDED_ROLES = (PART_ROLE, SURFACE_ROLE)  # a slicer may say otherwise
SUPPORT_ROLE, UNPRINTED_ROLE = "support", "unprintable"
ROLES_BY_TYPE = {"model": PART_ROLE, "": PART_ROLE, "surface": SURFACE_ROLE}  # all others are supports
ROLE_PATTERNS = (  # pattern of what slicers call a volume, and what it is
    (re.compile(r"(?i)negative"), NEGATIVE_ROLE),
    (re.compile(r"(?i)modifier|infill_mesh|cutting_mesh"), MODIFIER_ROLE),
    (re.compile(r"(?i)support|anti_overhang"), SUPPORT_ROLE),
)
LEFT_OUT_ROLES = {  # role: noun, what is done
    SUPPORT_ROLE: ("support or helper object", "left out"),
    MODIFIER_ROLE: ("modifier", "ignored"),
    SURFACE_ROLE: ("open surface object", "left out"),
    UNPRINTED_ROLE: ("object marked as not printable", "left out"),
}
UNREAD_EXTENSIONS = re.compile(r"(?i)beamlattice|boolean|securecontent|displacement|implicit|volumetric")


@dataclass
class Model3MF:
    """One model file of the package."""

    unit: str = "millimeter"
    objects: dict[str, "Object3MF"] = field(default_factory=dict)
    items: list[dict[str, str]] = field(default_factory=list)  # attributes of each item of the build


@dataclass
class Object3MF:
    """One object: a mesh, or components."""

    name: str = ""
    role: str = PART_ROLE
    corners: array = field(default_factory=lambda: array("d"))
    facets: array = field(default_factory=lambda: array("q"))
    components: list[dict[str, str]] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class Piece3MF:
    """One mesh where it stands in the build."""

    name: str
    role: str
    item: int  # of the build
    vertices: Points  # (V, 3) [unit of the file]
    faces: Triangles  # (F, 3) int


def read_3mf(data: bytes, where: str) -> Soup:
    """Return the parts of a 3MF file, as its build places them.

    Negative parts are cut out of the parts of their item; supports and modifiers are left out, with a
    warning.

    Parameters
    ----------
    data : bytes
        The whole file, a ZIP archive.
    where : str
        The file, for error lines.

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If it is in an extension that is not read, or a negative part cannot be subtracted.
    ValueError
        If it is damaged, or stands for too much.
    """
    with formats.open_archive(data) as archive:
        package = _Package(archive, where)
        package.place_build()
    pieces = [_as_part(piece) if piece.role == SURFACE_ROLE else piece for piece in package.pieces]
    name = package.root.unit.strip().lower().rstrip("s").replace("metre", "meter") or "millimeter"
    if name not in UNITS_3MF:
        what = f"its unit is {quantity_text(package.root.unit)}"
        raise MeshError(where, what, f"write {' or '.join(UNITS_3MF)} there")
    unit, factor = UNITS_3MF[name]
    warnings = []
    closed = sum(a is not b for a, b in zip(pieces, package.pieces))
    if closed:
        number = counted(closed, "object of type surface is closed", "objects of type surface are closed")
        warnings.append(f"{number}: read as a part" if closed == 1 else f"{number}: read as parts")
    left_out = package.left_out + Counter(piece.role for piece in pieces if piece.role in LEFT_OUT_ROLES)
    for role, (noun, done) in LEFT_OUT_ROLES.items():
        names = dict.fromkeys(piece.name for piece in pieces if piece.role == role and piece.name)
        if left_out[role]:
            title = f" ({listed([quantity_text(name) for name in list(names)[:3]])})" if names else ""
            warnings.append(f"{counted(left_out[role], noun)}{title}: {done}")
    solids: list[Piece3MF] = []  # the parts, negative ones cut out of those of the same item
    for item in dict.fromkeys(piece.item for piece in pieces):
        parts, tools = (
            [piece for piece in pieces if piece.item == item and piece.role == role]
            for role in (PART_ROLE, NEGATIVE_ROLE)
        )
        solids += [_cut(part, tools, where) for part in parts] if tools else parts
        if tools:
            number = counted(len(tools), "negative part")
            warnings.append(f"{number}: subtracted" if parts else f"{number} of no part: left out")
    solids = [piece for piece in solids if len(piece.faces)]
    sizes = np.cumsum([0, *(len(piece.vertices) for piece in solids)])
    vertices = np.concatenate([np.empty((0, 3)), *(piece.vertices for piece in solids)]) * factor
    faces = np.concatenate([np.empty((0, 3), np.int64), *(p.faces + k for p, k in zip(solids, sizes))])
    objects = np.repeat(np.arange(len(solids)), [len(piece.faces) for piece in solids])
    titles = tuple(piece.name for piece in solids)
    return Soup(vertices, faces, "3mf", unit, tuple(warnings), titles, objects)


class _Package:
    """The files of one 3MF, read as they are asked for, and what slicers add in files of their own."""

    def __init__(self, archive: zipfile.ZipFile, where: str) -> None:
        self.archive, self.where = archive, where
        self.files = {unquote(name).lstrip("/").lower(): name for name in archive.namelist()}
        self.models: dict[str, Model3MF] = {}
        self.size = Counter[str]()  # elements read, by kind
        self.left_out = Counter[str]()
        self.pieces: list[Piece3MF] = []
        self.instances = self.facets = self.corners = 0
        self.roles: dict[tuple[str, str], str] = {}  # by object, and part or first facet
        self.names: dict[tuple[str, str], str] = {}
        self.ranges: dict[str, list[tuple[int, int]]] = {}  # of facets, by object
        for name in ("model_settings", "slic3r_pe_model", "slic3r_model"):  # of slicers
            if member := self.files.get(f"metadata/{name}.config"):
                self._parse(member, self._notes_handler(), MAX_CONFIG_BYTES)
        self.path = self._root_path()
        self.root = self._model(self.path)

    def place_build(self) -> None:
        """Add every mesh that the build places; counts what it marks as not printable."""
        items = self.root.items
        if not items:  # a build of nothing: what no component names
            inner = {part["objectid"] for whole in self.root.objects.values() for part in whole.components}
            items = [{"objectid": name} for name in self.root.objects if name not in inner]
        for number, item in enumerate(items):
            if item.get("printable", "1").strip().lower() in ("0", "false"):
                self.left_out[UNPRINTED_ROLE] += 1
                continue
            path, name = item.get("path", self.path).lstrip("/"), item.get("partnumber", "")
            self._place(path, item["objectid"], _read_transform(item), number, name, ())

    def _place(
        self, path: str, name: str, transform: Floats, item: int, title: str,
        parents: tuple[str, ...], role: str = PART_ROLE,
    ) -> None:  # fmt: skip
        """Add the meshes of one object, and of its components."""
        self.instances += 1
        if self.instances > MAX_INSTANCES:
            raise DamageError(f"its components stand for more than {MAX_INSTANCES} bodies")
        if len(parents) > MAX_COMPONENT_DEPTH:
            raise DamageError(f"components within components more than {MAX_COMPONENT_DEPTH} deep")
        here = self._model(path).objects[name]
        role = here.role if role == PART_ROLE else role
        title = here.name or self.names.get((name, ""), title)
        for parent in parents[-1:]:
            title = self.names.get((parent, name), title)
            role = self.roles.get((parent, name), role) if role in UNDECIDED_ROLES else role
        for component in here.components:
            # the inner transform within the outer one
            inner = _read_transform(component)
            axes = _transform_points(inner[:3], np.vstack([transform[:3], np.zeros(3)]))
            matrix = np.vstack([axes, _transform_points(inner[3:], transform)])
            inside, further = component.get("path", path).lstrip("/"), (*parents, name)
            self._place(inside, component["objectid"], matrix, item, title, further, role)
        if not here.facets:
            return
        self.facets += len(here.facets) // 3
        refuse_size(0, self.facets)
        self.corners += len(here.corners) // 3
        refuse_size(self.corners, self.facets)
        vertices = _transform_points(np.frombuffer(here.corners, dtype=float).reshape(-1, 3), transform)
        faces = np.frombuffer(here.facets, dtype=np.int64).reshape(-1, 3)
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise DamageError("a facet names a corner that is not there")
        if vectors.determinant(transform[:3]) < 0.0:
            faces = faces[:, ::-1]
        # several meshes, where the slicer parts all of its facets into ranges
        ranges = [] if parents else self.ranges.get(name, [])
        ordered = sorted(ranges)
        ends = [-1, *(last for _, last in ordered)]
        follow = all(first == end + 1 and last >= first for (first, last), end in zip(ordered, ends))
        if not ranges or ends[-1] != len(faces) - 1 or not follow:
            self.pieces.append(Piece3MF(title, role, item, vertices, faces))
            return
        for first, last in ranges:
            key = (name, str(first))
            kind = self.roles.get(key, role) if role in UNDECIDED_ROLES else role
            corners, own = np.unique(faces[first : last + 1], return_inverse=True)
            named = self.names.get(key, title)
            self.pieces.append(Piece3MF(named, kind, item, vertices[corners], own.reshape(-1, 3)))

    def _root_path(self) -> str:
        """The model that the package's relations name, or what looks like it."""
        targets: list[str] = []

        def begin(name: str, attributes: dict[str, str]) -> None:
            of_model = re.search(r"(?i)/3dmodel$", attributes.get("Type", ""))
            if name.rpartition("}")[2] == "Relationship" and of_model:
                targets.append(posixpath.normpath(unquote(attributes.get("Target", ""))).lstrip("/"))

        if "_rels/.rels" in self.files:
            self._parse(self.files["_rels/.rels"], begin, MAX_CONFIG_BYTES)
        models = [name for name in self.files if name.endswith(".model")]
        guesses = sorted(models, key=lambda name: ("3d/3dmodel.model" not in name, name.count("/"), name))
        for target in [*targets, *guesses]:
            if target.lower() in self.files:
                return target
        raise DamageError("it holds no model")

    def _model(self, path: str) -> Model3MF:
        if path not in self.models:
            if path.lower() not in self.files:
                raise DamageError("a component is in a file that is not there")
            self.models[path] = model = Model3MF()
            reader = ModelReader(model, self.size, self.where)
            self._parse(self.files[path.lower()], reader.begin, reader=reader)
        return self.models[path]

    def _parse(
        self,
        member: str,
        begin: Callable[[str, dict[str, str]], None],
        most: int = MAX_MESH_BYTES,
        reader: "ModelReader | None" = None,
    ) -> None:
        """Read an XML file piece by piece; a document type, and with it every entity, is refused."""

        def refuse_doctype(*_: object) -> None:
            raise DamageError("its XML declares a document type")

        parser = expat.ParserCreate(namespace_separator="}")
        parser.StartElementHandler, parser.StartDoctypeDeclHandler = begin, refuse_doctype
        if reader is not None:
            reader.parser = parser
        try:
            for piece in formats.unpack_pieces(self.archive, member, most):
                parser.Parse(piece, False)
            parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise DamageError(f"its XML: {error}") from None

    def _notes_handler(self) -> Callable[[str, dict[str, str]], None]:
        """Return the handler of elements of a slicer's file: Bambu Studio, Orca, PrusaSlicer, Slic3r."""
        owner, part = "", None

        def begin(name: str, attributes: dict[str, str]) -> None:
            nonlocal owner, part
            if name in ("object", "plate", "assemble"):
                owner, part = attributes.get("id", "") if name == "object" else "", None
            elif name == "part":
                part = (owner, attributes.get("id", ""))
                self.roles[part] = _role(attributes.get("subtype", ""))
            elif name == "volume":
                first, last = int(attributes["firstid"]), int(attributes["lastid"])
                part = (owner, str(first))
                self.ranges.setdefault(owner, []).append((first, last))
            elif name == "metadata":
                key, value = attributes.get("key", ""), attributes.get("value", "")
                if key == "name":
                    self.names[part or (owner, "")] = value
                elif part and (key == "volume_type" or (key == "modifier" and value == "1")):
                    role = _role(value) if key == "volume_type" else MODIFIER_ROLE
                    if self.roles.get(part, PART_ROLE) == PART_ROLE:
                        self.roles[part] = role

        return begin


class ModelReader:
    """Fills a model from the elements of its file."""

    def __init__(self, model: Model3MF, size: Counter[str], where: str) -> None:
        self.model, self.size, self.where = model, size, where
        self.here = Object3MF()
        self.locals: dict[str, str] = {}
        self.parser: Any = None
        self.mark = ""

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        """Take one element of the XML.

        Parameters
        ----------
        name : str
            Of the element, with its namespace in front.
        attributes : dict of str to str

        Raises
        ------
        MeshError
            If it is of an extension that changes the shape and is not read.
        KeyError, ValueError
            If an attribute is missing, or not a number.
        """
        if self.mark:
            self.mark, self.parser.CharacterDataHandler = "", None
        local = self.locals.get(name)
        if local is None:
            local = self.locals[name] = name.rpartition("}")[2]
            if len(self.locals) > MAX_ELEMENT_NAMES:
                raise DamageError(f"its XML has more than {MAX_ELEMENT_NAMES} kinds of elements")
            extension = UNREAD_EXTENSIONS.search(name)
            if extension:
                what = f"is a 3MF in the extension {extension[0].lower()}, which is not read"
                raise MeshError(self.where, what, "export it as plain triangles")
        if local == "vertex":
            try:
                corner = float(attributes["x"]), float(attributes["y"]), float(attributes["z"])
            except ValueError:
                if any("," in attributes[axis] for axis in "xyz"):
                    raise formats.CommaError("a comma in a number") from None
                raise
            self.here.corners.extend(corner)
            self._count("corners")
        elif local == "triangle":
            self.here.facets.extend((int(attributes["v1"]), int(attributes["v2"]), int(attributes["v3"])))
            self._count("facets")
        elif local == "object":
            role = ROLES_BY_TYPE.get(attributes.get("type", "").strip().lower(), SUPPORT_ROLE)
            self.here = Object3MF(attributes.get("name") or attributes.get("partnumber", ""), role)
            self.model.objects[attributes["id"]] = self.here
            self._count("objects", MAX_PLACED_OBJECTS)
        elif local in ("component", "item"):
            reference = {key.rpartition("}")[2]: value for key, value in attributes.items()}
            (self.here.components if local == "component" else self.model.items).append(reference)
            self._count("placed", MAX_PLACED_OBJECTS)
        elif local == "metadata" and "mesh" in attributes.get("name", "") and self.parser is not None:
            self.mark = attributes["name"]  # as Cura marks helpers: its text says whether it is one
            self.parser.CharacterDataHandler = self._take_mark
        elif local == "model":
            self.model.unit = attributes.get("unit", "millimeter")

    def _take_mark(self, text: str) -> None:
        if text.strip().lower() in ("true", "1") and self.here.role in UNDECIDED_ROLES:
            self.here.role = _role(self.mark)

    def _count(self, what: str, most: int | None = None) -> None:
        most = most or MAX_READ_FACETS
        self.size[what] += 1
        if self.size[what] > most:
            raise formats.BombError(f"has more than {most} {what}")


def _as_part(surface: Piece3MF) -> Piece3MF:
    """An object of type surface as a part where it is closed, else as it is."""
    vertices, faces = topology.weld_corners(surface.vertices, surface.faces)
    is_part = len(faces) > 0 and topology.edge_table(faces, len(vertices)).is_closed
    return replace(surface, role=PART_ROLE) if is_part else surface


def _role(text: str) -> str:
    """Return the role that a slicer's word for a volume stands for."""
    return next((role for pattern, role in ROLE_PATTERNS if pattern.search(text)), PART_ROLE)


def _cut(part: Piece3MF, tools: list[Piece3MF], where: str) -> Piece3MF:
    """A part without what its negative parts fill."""
    bodies = []
    for piece in (part, *tools):
        vertices, faces = topology.weld_corners(*topology.drop_unused_corners(piece.vertices, piece.faces))
        corners = np.ascontiguousarray(faces).astype(np.uint64)
        body = manifold3d.Manifold(manifold3d.Mesh64(np.ascontiguousarray(vertices), corners))
        if body.status() != manifold3d.Error.NoError or not body.volume() > 0.0:
            name = f" {quantity_text(piece.name)}" if piece.name else ""
            kind = "part with a negative part" if piece is part else "negative part"
            what = f"has a {kind}{name} that is not one closed solid: not subtracted"
            raise MeshError(where, what, "subtract it in CAD and export the part again")
        bodies.append(body)
    whole, *rest = bodies
    for body in rest:
        whole -= body
    mesh = whole.to_mesh64()
    vertices = np.array(mesh.vert_properties, dtype=float)[:, :3]
    return Piece3MF(part.name, PART_ROLE, part.item, vertices, np.array(mesh.tri_verts, dtype=np.int64))


def _read_transform(attributes: dict[str, str]) -> Floats:
    """(4, 3) of a component or an item: rows are the images of the axes, and of the origin."""
    text = attributes.get("transform")
    if text is None:
        return np.vstack([np.eye(3), np.zeros(3)])
    numbers = [float(word) for word in text.split()]
    if len(numbers) != 12:
        raise DamageError(f"a transform of {len(numbers)} numbers, not of 12")
    return np.array(numbers).reshape(4, 3)


def _transform_points(points: Points, transform: Floats) -> Floats:
    """(V, 3) points (V, 3) in the axes of what holds them."""
    x, y, z = (points[:, k, None] for k in range(3))
    return x * transform[0] + y * transform[1] + z * transform[2] + transform[3]
