"""From a path or standard input, and the options of a user, to a ``Part``."""

import hashlib
import re
import struct
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base import check, documents
from feederscrew.base.arrays import Bools, Floats, Ints, Points, Triangles
from feederscrew.base.errors import ArgumentError, MeshError, SeveralBodiesError, printable
from feederscrew.base.geometry import graphs
from feederscrew.base.heavy import heavy
from feederscrew.base.signatures import with_shown_signature
from feederscrew.base.units import Quantity, QuantityError, factor, from_quantity, quantity, quantity_text
from feederscrew.part import card, formats, gate, given, glb, mass, mesh_formats, step, threemf, topology
from feederscrew.part.cad_faces import refuse_wrong_sides
from feederscrew.part.density import HEAVIEST_SOLID_KG_M3, LIGHTEST_SOLID_KG_M3, find_density
from feederscrew.part.formats import CARD_FORMAT, MAX_MESH_BYTES, MESH_FORMATS, PartFile, Soup
from feederscrew.part.hull import CentreOutsideError, convex_hull
from feederscrew.part.record import AspectNames, Part

spatial = heavy("scipy.spatial")

EXPORT_AGAIN = "export the part again"
EXPORT_FEWER = "export it with fewer facets"
TEXT_READERS = {"obj": mesh_formats.read_obj, "off": mesh_formats.read_off}
READERS: dict[str, Callable[[Any, str, str], Soup]] = {  # by format: of its bytes, the format and the file
    "stl": mesh_formats.read_stl,
    "stl-ascii": mesh_formats.read_stl,
    "ply": lambda data, kind, where: mesh_formats.read_ply(data),
    "3mf": lambda data, kind, where: threemf.read_3mf(data, where),
    "glb": lambda data, kind, where: glb.read_glb(data, where),
    "step": lambda data, kind, where: step.read_step(data, where),
}
DAMAGE_REASONS: tuple[tuple[tuple[type[Exception], ...], str], ...] = (
    # what readers raise on damaged bytes, no bugs: their own words are for programmers
    (formats.DAMAGED_ARCHIVE_ERRORS, "its archive is damaged"),
    ((UnicodeError,), "its text cannot be read"),
    ((EOFError, struct.error), "it is cut short"),
    ((RecursionError,), "it is nested too deep"),
    ((ArithmeticError,), "a number is out of range"),
    ((LookupError,), "something in it is missing"),
    ((ValueError, DeprecationWarning), "a value in it cannot be read"),
)


def read_file(source: str | PathLike[str], stdin: IO[bytes] | None = None) -> PartFile:
    """Read the bytes of a part file.

    Parameters
    ----------
    source : str or path
        '-' is standard input.
    stdin : binary file, optional
        Read in place of standard input and of the file.

    Returns
    -------
    PartFile

    Raises
    ------
    MeshError
        If there is no such file, it cannot be read, is empty or is larger than ``MAX_MESH_BYTES``.
    """
    source = str(source)
    where = "standard input" if source == "-" else source
    if source != "-" and stdin is None:
        data = documents.content(source, MAX_MESH_BYTES, "a part file", MeshError)
    else:
        try:
            source_file: Any = stdin or sys.stdin.buffer
            data = bytes(documents.upto(source_file, MAX_MESH_BYTES))
        except (OSError, ValueError) as error:
            raise MeshError(where, f"cannot be read ({error})", "check what it comes from") from None
    if not data:
        raise MeshError(where, "is empty", EXPORT_AGAIN)
    if len(data) > MAX_MESH_BYTES:
        raise MeshError(where, f"is larger than {MAX_MESH_BYTES >> 20} MB", EXPORT_FEWER)
    path = Path("stdin" if source == "-" else source)
    digest = hashlib.sha256(data).hexdigest()
    return PartFile(source, where, printable(path.stem), path.suffix.lower().removeprefix("."), data, digest)


def read_soup(file: PartFile) -> Soup:
    """Return the triangles of a mesh file.

    Parameters
    ----------
    file : PartFile
        Its bytes decide the format, not its name.

    Returns
    -------
    Soup
        With a warning where the suffix stands for another format.

    Raises
    ------
    MeshError
        If the file is of no known format, cut short, damaged, too large, or has no facets.
    """
    kind, alien = formats.detect_format(file.data, file.suffix)
    if kind is None or kind == CARD_FORMAT:
        mends = {
            **dict.fromkeys(formats.WIDE_TEXT_FAULTS, "save it as ASCII or UTF-8 text"),
            documents.POINTER: documents.PULL,
        }
        *most, last = formats.MESH_NAMES
        mend = mends.get(alien or "", f"export the part as {', '.join(most)} or {last}")
        raise MeshError(file.where, alien or "is a part card, not a mesh", mend)
    title, data, where = MESH_FORMATS[kind].title, file.data, file.where
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):  # what is not finite, the gate names
            warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
            if kind in TEXT_READERS:
                formats.refuse_text_size(data)
                read = TEXT_READERS[kind](bytes(data).removeprefix(b"\xef\xbb\xbf"))
            else:
                read = READERS[kind](data, kind, where)
    except formats.CommaError as error:
        raise MeshError(where, f"has {error}", "write numbers with a decimal point") from None
    except (formats.TooManyFacetsError, formats.BombError) as error:
        raise MeshError(where, f"is too large: it {error}", EXPORT_FEWER) from None
    except MemoryError:
        raise MeshError(where, "needs more memory than there is", EXPORT_FEWER) from None
    except tuple(kind for kinds, _ in DAMAGE_REASONS for kind in kinds) as error:
        reason = next(text for kinds, text in DAMAGE_REASONS if isinstance(error, kinds))
        if isinstance(error, formats.DamageError):  # our own words
            words = " ".join(str(error).split())
            reason = words if len(words) <= 60 else words[:57] + "..."
        raise MeshError(where, f"is a damaged {title} ({reason})", EXPORT_AGAIN) from None
    if not len(read.faces):
        left_out = "".join(f"; {text}" for text in read.warnings) if kind == "3mf" else ""
        raise MeshError(where, f"has no facets{left_out}", "export the part again as a solid")
    suffix_warnings: tuple[str, ...] = ()
    suffixes = {suffix for format in MESH_FORMATS.values() for suffix in format.suffixes}
    if file.suffix in suffixes and file.suffix not in MESH_FORMATS[kind].suffixes:
        suffix_warnings = (f"named .{file.suffix} but its content is {title}: read as that",)
    return replace(read, format=kind, warnings=suffix_warnings + read.warnings)


CRACK_SHARE = 1e-4  # [1] of the size: open surfaces whose rims are closer are of one body
MAX_RIM_CORNERS = 200_000  # corners of open rims that are looked at
MAX_NESTED_SURFACES = 1_000  # closed surfaces that are looked at for cavities of others
NESTING_PROBES = 5  # corners of a surface that say whether it lies within another
LISTED_FILE_BODIES = 12  # bodies that a refusal lists
GIVE_BODY = "give the number or the name of one, or largest"


@dataclass(frozen=True, eq=False)
class FileBody:
    """One body of a file, its cavities with it."""

    number: int  # from 1, in the order of the file
    name: str  # that the file gives it, '' for none
    volume: float  # [cubed unit of the file]
    size: tuple[float, float, float]  # [unit of the file] along the file's axes
    facets: Ints  # indices into the facets of the file

    def text(self, unit: str) -> str:
        """Return the body as a person reads it in a list: '2 'pin' (64 mm3, 4 x 4 x 4 mm)'.

        Parameters
        ----------
        unit : str
            Of the file.

        Returns
        -------
        str
        """
        name = f" {quantity_text(self.name)}" if self.name else ""
        size = " x ".join(f"{length:.4g}" for length in self.size)
        return f"{self.number}{name} ({self.volume:.4g} {unit}3, {size} {unit})"


def list_bodies(soup: Soup) -> tuple[FileBody, ...]:
    """Return the bodies of a file, in the order of their first facets.

    What touches along edges is one body, unless the file has it as closed objects. A closed surface within a
    body that faces the other way is its cavity. Open surfaces that nearly meet are one body.

    Parameters
    ----------
    soup : Soup

    Returns
    -------
    tuple of FileBody
        Empty where no facet has three different corners.
    """
    points = np.nan_to_num(soup.vertices, posinf=0.0, neginf=0.0)
    points[np.abs(points) > gate.FARTHEST_CORNER] = 0.0  # what is not finite, the gate names
    first, group = topology.distinct_points(points)
    points, faces = points[first], group[soup.faces]
    a, b, c = faces.T
    facets = np.flatnonzero((a != b) & (b != c) & (c != a))
    if not len(facets):
        return ()
    faces = faces[facets]
    objects = None if soup.objects is None else soup.objects[facets]
    number, shell, is_open = _file_surfaces(points, faces, objects)
    volume = np.bincount(shell, mass.tetrahedron_volumes(points[faces]), minlength=number)
    low, high = topology.shell_boxes(points, faces, shell, number)
    of_body = _assign_cavities(points, faces, shell, np.where(is_open, 0.0, volume), low, high)
    bodies: list[FileBody] = []
    for number_of_body in dict.fromkeys(of_body[shell].tolist()):
        own = np.flatnonzero(of_body == number_of_body)
        mine = facets[np.isin(shell, own)]
        size = tuple((high[own].max(axis=0) - low[own].min(axis=0)).tolist())
        name = ""  # of the object that most of the body's facets are of
        if soup.objects is not None and soup.names:
            name = soup.names[int(np.argmax(np.bincount(soup.objects[mine], minlength=1)))]
        bodies.append(FileBody(len(bodies) + 1, name, abs(float(volume[own].sum())), size, mine))
    return tuple(bodies)


def take_body(soup: Soup, body: str, where: str, unit: str) -> tuple[Soup, FileBody | None]:
    """Return the facets of one body of a file, and the body.

    Parameters
    ----------
    soup : Soup
    body : str
        Its number from 1, its name, or 'largest'.
    where, unit : str
        The file and its unit, for error lines.

    Returns
    -------
    soup : Soup
        Of that body alone, with a warning that names what is left out.
    chosen : FileBody or None
        None where the file holds no other body.

    Raises
    ------
    ArgumentError
        If there is no such body, or several have the name; the line lists those there are.
    """
    bodies, body = list_bodies(soup), body.strip()
    if not bodies:
        return soup, None
    if not body:
        raise ArgumentError("body", "is empty", GIVE_BODY)
    if body.lower() == "largest":
        fitting = [max(bodies, key=lambda candidate: candidate.volume)]
    elif re.fullmatch("[0-9]{1,9}", body):
        fitting = [candidate for candidate in bodies if candidate.number == int(body)]
    else:
        plain = body.lower()
        fitting = [candidate for candidate in bodies if candidate.name == body]
        fitting = fitting or [candidate for candidate in bodies if candidate.name.strip().lower() == plain]
    if not fitting:
        what = f"there is no body {quantity_text(body)}: {where} holds {_bodies_text(bodies, unit)}"
        raise ArgumentError("body", what, GIVE_BODY)
    if len(fitting) > 1:
        numbers = " and ".join(str(candidate.number) for candidate in fitting)
        what = f"{quantity_text(body)} is the name of bodies {numbers}"
        raise ArgumentError("body", what, "give its number")
    if len(bodies) == 1:
        return soup, None
    chosen = fitting[0]
    rest = "the other one is" if len(bodies) == 2 else f"the {len(bodies) - 1} others are"
    warning = f"body {chosen.text(unit)} of {len(bodies)} is taken: {rest} left out"
    used, own = np.unique(soup.faces[chosen.facets], return_inverse=True)
    alone = replace(
        soup,
        vertices=soup.vertices[used],
        faces=own.reshape(-1, 3),
        objects=None if soup.objects is None else soup.objects[chosen.facets],
        cad_faces=None if soup.cad_faces is None else soup.cad_faces.of_body(chosen.facets),
        warnings=(*soup.warnings, warning),
    )
    return alone, chosen


def _bodies_text(bodies: tuple[FileBody, ...], unit: str) -> str:
    more = f", and {len(bodies) - LISTED_FILE_BODIES} more" if len(bodies) > LISTED_FILE_BODIES else ""
    return ", ".join(body.text(unit) for body in bodies[:LISTED_FILE_BODIES]) + more


def _file_surfaces(points: Points, faces: Triangles, objects: Ints | None) -> tuple[int, Ints, Bools]:
    """Return the number of surfaces that hang together, the one of each facet, and whether each is open."""
    keys = faces
    if objects is not None and objects.max(initial=0) > 0:
        of_object = faces * (int(objects.max()) + 1) + objects[:, None]
        _, keys = np.unique(of_object, return_inverse=True)
        keys = keys.reshape(-1, 3)
        if not topology.edge_table(keys, int(keys.max()) + 1).is_closed:
            keys = faces  # objects that close only together
    edges = topology.edge_table(keys, int(keys.max()) + 1)
    number, shell = topology.split_shells(edges, keys)
    rim = np.repeat(edges.net != 0, edges.count)
    is_open = np.zeros(number, dtype=bool)
    is_open[shell[edges.order[rim] // 3]] = True
    if is_open.sum() < 2:
        return number, shell, is_open
    sides = edges.order[rim]
    corners, of_shell = faces.ravel()[sides], shell[sides // 3]
    if len(corners) > MAX_RIM_CORNERS:
        return number, shell, is_open
    used = np.unique(faces)
    reach = CRACK_SHARE * float(np.ptp(points[used], axis=0).max())
    ends = np.concatenate([corners, np.roll(faces, -1, axis=1).ravel()[sides]])
    tree = spatial.cKDTree(points[ends])
    if tree.count_neighbors(tree, reach) > topology.MAX_NEAR_PAIRS:
        return number, shell, is_open
    i, j = tree.query_pairs(reach, output_type="ndarray").T
    both = np.concatenate([of_shell, of_shell])
    count, group = graphs.components(both[i], both[j], number)
    merged = np.zeros(count, dtype=bool)
    merged[group[is_open]] = True
    return count, group[shell], merged


def _assign_cavities(
    points: Points,
    faces: Triangles,
    shell: Ints,
    volume: Floats,
    low: Points,
    high: Points,
) -> Ints:
    """(N,) the surface that stands for the body of each: itself, or what it is a cavity of."""
    number = len(volume)
    of_body = np.arange(number)
    if not 1 < number <= MAX_NESTED_SURFACES:
        return of_body
    around: list[list[int]] = []
    for k in range(number):
        boxed = (low <= low[k]).all(axis=1) & (high >= high[k]).all(axis=1) & (volume != 0.0)
        boxed[k] = False
        around.append([])
        for j in np.flatnonzero(boxed).tolist():
            turns = np.abs(topology.turns_around(points, faces, shell, k, j, NESTING_PROBES))
            if np.mean(turns > 0.5) > 0.5:
                around[k].append(j)
    is_cavity = np.zeros(number, dtype=bool)
    for k in sorted(range(number), key=lambda k: len(around[k])):
        if not around[k] or volume[k] == 0.0:
            continue
        parent = max(around[k], key=lambda j: len(around[j]))
        if not is_cavity[parent] and volume[parent] * volume[k] < 0.0:
            is_cavity[k], of_body[k] = True, parent
    return of_body


def _solid_file(source: object) -> PartFile:
    """The STL of a solid of build123d or cadquery, named as it is."""
    name, data = given.solid_in_file(source)
    return PartFile(name, name, name, "stl", data, hashlib.sha256(data).hexdigest())


FILE_UNITS = {"mm": "millimetres", "in": "inches", "cm": "centimetres", "m": "metres", "um": "micrometres"}
FED_PART_SIZE_M = (0.5e-3, 0.3)  # [m] largest dimension of what bowls feed
USUAL_PART_SIZE_M = 2e-3  # [m] below it, an inch file read in mm is likelier than a part so small


@with_shown_signature
def load(
    source: str | PathLike[str] | given.TriangleMesh | tuple[ArrayLike, ArrayLike],
    *,
    units: str | None = None,
    density: Quantity | None = None,
    centre_of_mass: str | Sequence[float] | None = None,
    names: str | PathLike[str] | AspectNames | None = None,
    body: str | int | None = None,
    allow_open: bool = False,
    stdin: IO[bytes] | None = None,
) -> Part:
    """Read a part from a mesh file or a part card, or take a mesh or a solid from memory.

    Parameters
    ----------
    source : str, Path, mesh, (vertices, faces) or solid
        STL, OBJ, PLY, OFF, GLB, 3MF, STEP or YAML; '-' reads standard input. Or a ``trimesh.Trimesh``,
        corners (V, 3) with facets (F, 3), or a solid of build123d or cadquery, which is taken by its STL.
    units : str, optional
        'mm', 'cm', 'm', 'um' or 'in'; without it what a file's format states (GLB: m; 3MF and STEP: their
        own), else mm. A mesh from memory is in metres, as all numbers of this library, unless it says
        otherwise (``mesh.units``); a solid of build123d or cadquery is in mm.
    density : str, float [kg/m3] or quantity of pint, optional
        A material or a value, '7.85 g/cm3'; steel without it.
    centre_of_mass : str or (3,) float, optional
        'x,y,z' in the file's axes and units, or with units, if the part is not homogeneous. The inertia
        kept is that of the homogeneous solid about its own centroid, moved along; a warning says so.
    names : str, Path or AspectNames, optional
        File of names of its aspects, as ``write_names`` writes it; letters without it.
    body : str or int, optional
        Which of several bodies in the file: its number from 1, its name, or 'largest'.
    allow_open : bool
        Compute from an open surface or several bodies, and say so.
    stdin : binary file, optional
        Read in place of the file or of the process's own standard input.

    Returns
    -------
    Part

    Raises
    ------
    FeederError
        If the file is damaged or bounds no single solid, or an argument or a part card cannot be used.
    """
    if not given.is_given(source):
        check.kind("source", source, (str, PathLike), given.MEND)
    try:
        density = cast("str | float | None", from_quantity(density, "density"))
    except QuantityError as fault:
        raise ArgumentError("density", fault.what, fault.mend) from None
    if density is not None and not isinstance(density, str):
        weight = check.argument("density", density)
        if not LIGHTEST_SOLID_KG_M3 <= weight <= HEAVIEST_SOLID_KG_M3:
            mend = "give kg/m3, 7850 for steel, or a text, '7.85 g/cm3'"
            raise ArgumentError("density", f"is {weight:g} kg/m3", mend)
        density = f"{weight!r} kg/m3"
    if centre_of_mass is not None and not isinstance(centre_of_mass, str):
        mend = "give 'x,y,z', or three numbers in the file's unit"
        point = check.kind("centre_of_mass", centre_of_mass, (tuple, list, np.ndarray), mend)
        centre_of_mass = ",".join(repr(check.argument("centre_of_mass", number)) for number in point)
    if body is not None and not isinstance(body, str):
        body = str(
            int(check.kind("body", body, (int, np.integer), "give its number, its name, or 'largest'"))
        )
    if units not in (None, *FILE_UNITS):
        mend = documents.hint(str(units), FILE_UNITS)
        raise ArgumentError("units", f"'{units}' is not a unit of a part file", mend)
    value, material = find_density(density)
    if given.is_given(source) and not given.cad_library(source):
        file, soup = given.read_mesh(source)
    else:
        file = _solid_file(source) if given.is_given(source) else read_file(cast(str, source), stdin)
        soup = None
    is_card = file.suffix in MESH_FORMATS[CARD_FORMAT].suffixes
    # of standard input its first bytes say so
    if soup is None and (is_card or formats.detect_format(file.data, file.suffix)[0] == CARD_FORMAT):
        if body is not None:
            raise ArgumentError("body", "a part card is of one body", "leave it out")
        options = {"units": units, "density": density, "centre_of_mass": centre_of_mass, "names": names}
        for name, option in options.items():
            if option is not None:
                raise ArgumentError(name, "a part card has its own", "leave it out")
        return card.read_card(file)
    if names is not None and not isinstance(names, AspectNames):
        names = card.read_aspect_names(check.path("names", names))
    unit_warnings: tuple[str, ...] = ()
    if soup is None:
        soup = read_soup(file)
        unit, unit_warnings = _choose_unit(soup, units)
    else:
        unit = units or soup.unit or "m"
    soup, chosen = (soup, None) if body is None else take_body(soup, body, file.where, unit)
    try:
        surface = gate.check_surface(soup.vertices, soup.faces, file.where, unit, allow_open)
    except SeveralBodiesError as fault:  # with a list of them, and how to take one
        bodies = list_bodies(soup)
        what = f"holds {len(bodies)} bodies" if fault.what.startswith("holds ") else fault.what
        mend = f"take one with `body` (its number, its name, or largest), {fault.mend}"
        listed = MeshError(fault.where, f"{what}: {_bodies_text(bodies, unit)}", mend)
        raise (listed if len(bodies) > 1 else fault) from None
    except MeshError as fault:  # a face on the wrong side may be its cause
        cuts = fault.crossings if isinstance(fault, gate.SelfCutError) else gate.NO_CROSSINGS
        refuse_wrong_sides(soup, cuts, file.where, unit, allow_open)
        raise
    side_warnings = refuse_wrong_sides(soup, surface.crossings, file.where, unit, allow_open)
    scale = factor(unit, "length")
    vertices, solid = surface.vertices * scale, surface.solid.scale(scale)
    centre, shifted = _read_centre(centre_of_mass, unit, solid.centre)
    try:
        hull = convex_hull(vertices, centre, file.where, centre_given=centre_of_mass is not None)
    except CentreOutsideError as fault:
        if centre_of_mass is None:
            raise
        raise ArgumentError("centre_of_mass", fault.what, fault.mend) from None
    gate.check_hull(surface, hull.volume_of_all / scale**3, file.where, unit)
    name, digest = file.name, file.sha256
    if chosen is not None:  # one of several bodies of a file: no trial of another is its own
        name, of_body = f"{name}-{chosen.number}", f"{digest} body {chosen.number}"
        digest = hashlib.sha256(of_body.encode()).hexdigest()
    return Part(
        name=name,
        source=file.source,
        sha256=digest,
        file_sha256=file.sha256,
        units=unit,
        material=material,
        density=value,
        volume=solid.volume,
        mass=value * solid.volume,
        centre_of_mass=check.frozen(centre),
        inertia=check.frozen(value * solid.inertia),
        vertices=check.frozen(vertices),
        faces=check.frozen(surface.faces),
        hull=hull,
        names=names,
        open_surface=surface.open_surface,
        warnings=(
            *soup.warnings,
            *unit_warnings,
            *_size_warnings(vertices, unit, units),
            *surface.warnings,
            *side_warnings,
            *shifted,
        ),
    )


def _choose_unit(soup: Soup, wanted_unit: str | None) -> tuple[str, tuple[str, ...]]:
    """The unit of the file's numbers; what to say where it is not the wanted one."""
    stated, title = soup.unit, MESH_FORMATS[soup.format].title
    if stated is None or wanted_unit is None or wanted_unit == stated:
        return wanted_unit or stated or "mm", ()
    if soup.format == "glb":
        return wanted_unit, (f"GLB is in m by its specification; read in {wanted_unit} as asked for",)
    what = f"{title} files state their unit, here {stated}: the units asked for, {wanted_unit}, are not used"
    return stated, (what,)


def _size_warnings(vertices: Floats, unit: str, wanted_unit: str | None) -> tuple[str, ...]:
    """A warning where the size cannot be that of a fed part."""
    size = float(np.ptp(vertices, axis=0).max())
    low, high = FED_PART_SIZE_M[0] if wanted_unit else USUAL_PART_SIZE_M, FED_PART_SIZE_M[1]
    if low <= size <= high:
        return ()
    sizes = {u: size / factor(unit, "length") * factor(u, "length") for u in FILE_UNITS if u != unit}
    likely = [u for u in sizes if USUAL_PART_SIZE_M <= sizes[u] <= high]
    names = " or ".join(FILE_UNITS[u] for u in likely)
    kind = "small" if size < low else "large"
    mend = f"if the file is in {names}, pass `units` {likely[0]}" if likely else "check its scale"
    return (f"the largest dimension, {size * 1e3:.3g} mm, is {kind} for a fed part: {mend}",)


def _read_centre(text: str | None, unit: str, homogeneous: Floats) -> tuple[Floats, tuple[str, ...]]:
    """(3,) [m] the centre of mass asked for, or that of the homogeneous solid."""
    if text is None:
        return homogeneous, ()
    pieces = text.strip().removeprefix("(").removesuffix(")").split(",")
    if len(pieces) != 3:
        what = f"{quantity_text(text)} is not three numbers"
        raise ArgumentError("centre_of_mass", what, "write x,y,z with points and commas, as in 1.5,0,-2")
    try:
        centre = np.array([quantity(piece, "length", bare=unit) for piece in pieces])
    except QuantityError as error:
        raise ArgumentError("centre_of_mass", error.what, error.mend) from None
    warning = "the centre of mass is as given and how the mass is spread is not known: "
    return centre, (f"{warning}the inertia is that of the homogeneous solid about its own centroid",)
