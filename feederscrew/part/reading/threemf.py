"""3MF files by their meaning: parts are taken, negative parts cut out, supports and modifiers left out.

3MF Core Specification 1.3 and the Production Extension 1.2; what slicers add in files of their own.
"""

import posixpath
import re
from array import array
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import unquote
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from feederscrew.errors import MeshError
from feederscrew.heavy import heavy
from feederscrew.part.reading import formats
from feederscrew.part.reading.soup import MAX_MESH_BYTES, MAX_READ_FACETS, DamageError, Soup, refuse_size
from feederscrew.part.repair import topology
from feederscrew.units import counted, listed, quantity_text

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
PART_ROLE, NEGATIVE_ROLE, MODIFIER_ROLE, SUPPORT_ROLE, UNPRINTED_ROLE = (
    "part",
    "negative",
    "modifier",
    "support",
    "unprintable",
)
ROLES_BY_TYPE = {
    "model": PART_ROLE,
    "": PART_ROLE,
    "support": SUPPORT_ROLE,
    "solidsupport": SUPPORT_ROLE,
    "surface": SUPPORT_ROLE,
    "other": SUPPORT_ROLE,
}
ROLE_PATTERNS = (  # pattern of what slicers call a volume, and what it is
    (re.compile(r"(?i)negative"), NEGATIVE_ROLE),
    (re.compile(r"(?i)modifier|infill_mesh|cutting_mesh"), MODIFIER_ROLE),
    (re.compile(r"(?i)support|anti_overhang"), SUPPORT_ROLE),
)
LEFT_OUT_ROLES = {  # role: noun, what is done
    SUPPORT_ROLE: ("support or helper object", "left out"),
    MODIFIER_ROLE: ("modifier", "ignored"),
    UNPRINTED_ROLE: ("object marked as not printable", "left out"),
}
UNREAD_EXTENSIONS = re.compile(r"(?i)beamlattice|boolean|securecontent|displacement|implicit|volumetric")
MODEL_RELATION = re.compile(r"(?i)/3dmodel$")
SLICER_CONFIGS = (
    "Metadata/model_settings.config",
    "Metadata/Slic3r_PE_model.config",
    "Metadata/Slic3r_model.config",
)
SUBTRACT_IN_CAD = "subtract it in CAD and export the part again"


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
    vertices: np.ndarray  # (V, 3) [unit of the file]
    faces: np.ndarray  # (F, 3) int


@dataclass
class SlicerNotes:
    """What a slicer says of parts, in files of its own."""

    roles: dict[tuple[str, str], str] = field(default_factory=dict)  # by object, and part or first facet
    names: dict[tuple[str, str], str] = field(default_factory=dict)
    ranges: dict[str, list[tuple[int, int]]] = field(default_factory=dict)  # of facets, by object


def read_3mf(data: bytes, where: str) -> Soup:
    """Return the parts of a 3MF file, as its build places them.

    Parameters
    ----------
    data : bytes
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
        package = Package3MF(archive, where)
        pieces = package.pieces()
    name = package.root.unit.strip().lower().rstrip("s").replace("metre", "meter") or "millimeter"
    if name not in UNITS_3MF:
        listed_units = " or ".join(UNITS_3MF)
        raise MeshError(
            where, f"its unit is {quantity_text(package.root.unit)}", f"write {listed_units} there"
        )
    unit, factor = UNITS_3MF[name]
    solids, warnings = _by_role(pieces, package.left_out, where)
    names = tuple(piece.name for piece in solids)
    sizes = np.cumsum([0, *(len(piece.vertices) for piece in solids)])
    vertices = np.concatenate([np.empty((0, 3)), *(piece.vertices for piece in solids)]) * factor
    faces = np.concatenate([np.empty((0, 3), np.int64), *(p.faces + k for p, k in zip(solids, sizes))])
    objects = np.repeat(np.arange(len(solids)), [len(piece.faces) for piece in solids])
    return Soup(vertices, faces, "3mf", unit, warnings, names, objects)


class Package3MF:
    """The files of one 3MF, read as they are asked for."""

    def __init__(self, archive: Any, where: str) -> None:
        self.archive, self.where = archive, where
        self.files = {unquote(name).lstrip("/").lower(): name for name in archive.namelist()}
        self.models: dict[str, Model3MF] = {}
        self.size = Counter[str]()  # corners and facets read
        self.left_out = Counter[str]()
        self.instances = self.facets = self.corners = 0
        self.notes = self._notes()
        self.path = self._root_path()
        self.root = self._model(self.path)

    def pieces(self) -> list[Piece3MF]:
        """Return every mesh that the build places; counts what it marks as not printable."""
        pieces: list[Piece3MF] = []
        items = self.root.items
        if not items:  # a build of nothing: what no component names
            inner = {
                c["objectid"] for inner_object in self.root.objects.values() for c in inner_object.components
            }
            items = [{"objectid": name} for name in self.root.objects if name not in inner]
        for number, item in enumerate(items):
            if item.get("printable", "1").strip().lower() in ("0", "false"):
                self.left_out[UNPRINTED_ROLE] += 1
                continue
            path = self._path(item, self.path)
            name = item.get("partnumber", "")
            self._place(path, item["objectid"], _transform(item), number, name, (), pieces)
        return pieces

    def _place(self, path, name, transform, item, title, parents, pieces, role=PART_ROLE) -> None:
        """Add the meshes of one object, and of its components."""
        self.instances += 1
        if self.instances > MAX_INSTANCES:
            raise DamageError(f"its components stand for more than {MAX_INSTANCES} bodies")
        if len(parents) > MAX_COMPONENT_DEPTH:
            raise DamageError(f"components within components more than {MAX_COMPONENT_DEPTH} deep")
        here = self._model(path).objects[name]
        role = here.role if role == PART_ROLE else role
        title = here.name or self.notes.names.get((name, ""), title)
        for parent in parents[-1:]:
            title = self.notes.names.get((parent, name), title)
            role = self.notes.roles.get((parent, name), role) if role == PART_ROLE else role
        for component in here.components:
            matrix = _combined(_transform(component), transform)
            inner = self._path(component, path)
            self._place(inner, component["objectid"], matrix, item, title, (*parents, name), pieces, role)
        if here.facets:
            self.facets += len(here.facets) // 3
            refuse_size(0, self.facets)
            pieces += self._meshes(here, name, transform, item, title, role, bool(parents))

    def _meshes(self, here, name, transform, item, title, role, inner) -> Iterator[Any]:
        """The mesh of an object; several, where the slicer tells ranges of its facets apart."""
        self.corners += len(here.corners) // 3
        refuse_size(self.corners, self.facets)
        vertices = _moved(np.frombuffer(here.corners, dtype=float).reshape(-1, 3), transform)
        faces = np.frombuffer(here.facets, dtype=np.int64).reshape(-1, 3)
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise DamageError("a facet names a corner that is not there")
        if _mirrors(transform):
            faces = faces[:, ::-1]
        ranges = self.notes.ranges.get(name, []) if not inner else []
        if not _covers(ranges, len(faces)):
            yield Piece3MF(title, role, item, vertices, faces)
            return
        for first, last in ranges:
            key = (name, str(first))
            kind = self.notes.roles.get(key, role) if role == PART_ROLE else role
            corners, own = np.unique(faces[first : last + 1], return_inverse=True)
            yield Piece3MF(
                self.notes.names.get(key, title), kind, item, vertices[corners], own.reshape(-1, 3)
            )

    def _path(self, attributes, path) -> str:
        return attributes["path"].lstrip("/") if "path" in attributes else path

    def _root_path(self) -> str:
        """The model that the package's relations name, or what looks like it."""
        targets: list[str] = []

        def begin(name, attributes) -> None:
            if name.rpartition("}")[2] == "Relationship" and MODEL_RELATION.search(
                attributes.get("Type", "")
            ):
                targets.append(posixpath.normpath(unquote(attributes.get("Target", ""))).lstrip("/"))

        if "_rels/.rels" in self.files:
            self._parse(self.files["_rels/.rels"], begin, MAX_CONFIG_BYTES)
        models = [name for name in self.files if name.endswith(".model")]
        guesses = sorted(models, key=lambda name: ("3d/3dmodel.model" not in name, name.count("/"), name))
        for target in [*targets, *guesses]:
            if target.lower() in self.files:
                return target
        raise DamageError("it holds no model")

    def _model(self, path) -> Any:
        if path not in self.models:
            if path.lower() not in self.files:
                raise DamageError("a component is in a file that is not there")
            self.models[path] = model = Model3MF()
            reader = ModelReader(model, self.size, self.where)
            self._parse(self.files[path.lower()], reader.begin, reader=reader)
        return self.models[path]

    def _notes(self) -> SlicerNotes:
        """What slicers say of parts; nothing where they add no file."""
        notes = SlicerNotes()
        for name in SLICER_CONFIGS:
            if name.lower() in self.files:
                self._parse(self.files[name.lower()], NotesReader(notes).begin, MAX_CONFIG_BYTES)
        return notes

    def _parse(self, member, begin, most=MAX_MESH_BYTES, reader=None) -> None:
        """Read an XML file piece by piece; a document type, and with it every entity, is refused."""
        parser = expat.ParserCreate(namespace_separator="}")
        parser.StartElementHandler = begin
        parser.StartDoctypeDeclHandler = _refuse_doctype
        if reader is not None:
            reader.parser = parser
        try:
            for piece in formats.unpack_pieces(self.archive, member, most):
                parser.Parse(piece, False)
            parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise DamageError(f"its XML: {error}") from None


class ModelReader:
    """Fills a model from the elements of its file."""

    def __init__(self, model: Model3MF, size: Counter[str], where: str) -> None:
        self.model, self.size, self.where = model, size, where
        self.here = Object3MF()
        self.locals: dict[str, str] = {}
        self.parser: Any = None
        self.mark = ""

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        """Take one element.

        Raises
        ------
        MeshError
            If it is of an extension that changes the shape and is not read.
        KeyError, ValueError
            If an attribute is missing, or is no number.
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
            self.here.corners.extend((float(attributes["x"]), float(attributes["y"]), float(attributes["z"])))
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
            self.parser.CharacterDataHandler = self._marked
        elif local == "model":
            self.model.unit = attributes.get("unit", "millimeter")

    def _marked(self, text) -> None:
        if text.strip().lower() in ("true", "1") and self.here.role == PART_ROLE:
            self.here.role = _role(self.mark)

    def _count(self, what, most=None) -> None:
        most = most or MAX_READ_FACETS
        self.size[what] += 1
        if self.size[what] > most:
            raise formats.BombError(f"has more than {most} {what}")


class NotesReader:
    """Fills the notes from a file of a slicer: Bambu Studio and Orca, PrusaSlicer and Slic3r."""

    def __init__(self, notes: SlicerNotes) -> None:
        self.notes = notes
        self.object = ""
        self.part: tuple[str, str] | None = None

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        """Take one element."""
        if name == "object":
            self.object, self.part = attributes.get("id", ""), None
        elif name in ("plate", "assemble"):
            self.object, self.part = "", None
        elif name == "part":
            self.part = (self.object, attributes.get("id", ""))
            self.notes.roles[self.part] = _role(attributes.get("subtype", ""))
        elif name == "volume":
            first, last = int(attributes["firstid"]), int(attributes["lastid"])
            self.part = (self.object, str(first))
            self.notes.ranges.setdefault(self.object, []).append((first, last))
        elif name == "metadata":
            key, value = attributes.get("key", ""), attributes.get("value", "")
            if self.part is None:
                if key == "name":
                    self.notes.names[self.object, ""] = value
            elif key == "name":
                self.notes.names[self.part] = value
            elif key == "volume_type" or (key == "modifier" and value == "1"):
                role = _role(value) if key == "volume_type" else MODIFIER_ROLE
                if self.notes.roles.get(self.part, PART_ROLE) == PART_ROLE:
                    self.notes.roles[self.part] = role


def _covers(ranges, count) -> bool:
    """Whether ranges of facets, first and last, are all of so many, each once."""
    ordered = sorted(ranges)
    ends = [-1, *(last for _, last in ordered)]
    return (
        bool(ranges)
        and ends[-1] == count - 1
        and all(first == end + 1 and last >= first for (first, last), end in zip(ordered, ends))
    )


def _role(text) -> Any:
    """What a slicer's word for a volume stands for."""
    return next((role for pattern, role in ROLE_PATTERNS if pattern.search(text)), PART_ROLE)


def _refuse_doctype(*_) -> None:
    raise DamageError("its XML declares a document type")


def _by_role(pieces, left_out, where) -> tuple[Any, ...]:
    """The parts, negative ones cut out of those of the same item, and what to say."""
    warnings = []
    left_out = left_out + Counter(piece.role for piece in pieces if piece.role in LEFT_OUT_ROLES)
    for role, (noun, done) in LEFT_OUT_ROLES.items():
        names = dict.fromkeys(piece.name for piece in pieces if piece.role == role and piece.name)
        if left_out[role]:
            title = f" ({listed([quantity_text(name) for name in list(names)[:3]])})" if names else ""
            warnings.append(f"{counted(left_out[role], noun)}{title}: {done}")
    solids: list[Piece3MF] = []
    for item in dict.fromkeys(piece.item for piece in pieces):
        parts = [piece for piece in pieces if piece.item == item and piece.role == PART_ROLE]
        tools = [piece for piece in pieces if piece.item == item and piece.role == NEGATIVE_ROLE]
        if parts and tools:
            solids += (_cut(part, tools, where) for part in parts)
            warnings.append(f"{counted(len(tools), 'negative part')}: subtracted")
        else:
            solids += parts
            if tools:
                warnings.append(f"{counted(len(tools), 'negative part')} of no part: left out")
    return [piece for piece in solids if len(piece.faces)], tuple(warnings)


def _cut(part, tools, where) -> Any:
    """A part without what its negative parts fill."""
    body = _manifold(part, where)
    for tool in tools:
        body -= _manifold(tool, where)
    mesh = body.to_mesh64()
    vertices = np.array(mesh.vert_properties, dtype=float)[:, :3]
    return Piece3MF(part.name, PART_ROLE, part.item, vertices, np.array(mesh.tri_verts, dtype=np.int64))


def _manifold(piece, where):
    vertices, faces = topology.weld_corners(*topology.drop_unused_corners(piece.vertices, piece.faces))
    mesh = manifold3d.Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(faces).astype(np.uint64))
    body = manifold3d.Manifold(mesh)
    if body.status() != manifold3d.Error.NoError or not body.volume() > 0.0:
        name = f" {quantity_text(piece.name)}" if piece.name else ""
        kind = "negative part" if piece.role == NEGATIVE_ROLE else "part with a negative part"
        raise MeshError(
            where, f"has a {kind}{name} that is not one closed solid: not subtracted", SUBTRACT_IN_CAD
        )
    return body


def _transform(attributes) -> NDArray[np.float64]:
    """(4, 3) of a component or an item: rows are the images of the axes, and of the origin."""
    text = attributes.get("transform")
    if text is None:
        return np.vstack([np.eye(3), np.zeros(3)])
    numbers = [float(word) for word in text.split()]
    if len(numbers) != 12:
        raise DamageError(f"a transform of {len(numbers)} numbers, not of 12")
    return np.array(numbers).reshape(4, 3)


def _moved(points, transform) -> NDArray[np.float64]:
    """(V, 3) points (V, 3) in the axes of what holds them."""
    x, y, z = (points[:, k, None] for k in range(3))
    return x * transform[0] + y * transform[1] + z * transform[2] + transform[3]


def _combined(inner, outer) -> NDArray[np.float64]:
    """(4, 3) of an inner transform within an outer one."""
    axes = _moved(inner[:3], np.vstack([outer[:3], np.zeros(3)]))
    return np.vstack([axes, _moved(inner[3:], outer)])


def _mirrors(transform) -> bool:
    a, b, c = transform[:3].tolist()
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    ) < 0.0
