"""From a file and the options of the command line to a ``Part``."""

import hashlib
from dataclasses import replace

import numpy as np

from feederscrew import check, documents
from feederscrew.errors import ArgumentError, SeveralBodiesError
from feederscrew.part import aspect_names, card
from feederscrew.part.density import density as density_of
from feederscrew.part.hull import CentreOutsideError, convex_hull
from feederscrew.part.reading import bodies
from feederscrew.part.reading import source as read
from feederscrew.part.reading.formats import FORMATS
from feederscrew.part.record import Part
from feederscrew.part.repair import gate
from feederscrew.units import QuantityError, factor, quantity, quantity_text

UNITS = {"mm": "millimetres", "in": "inches", "cm": "centimetres", "m": "metres", "um": "micrometres"}
FED = (0.5e-3, 0.3)  # [m] largest dimension of what bowls feed
USUAL = 2e-3  # [m] below it, an inch file read in mm is likelier than a part so small
GIVEN_CENTRE = (
    "the centre of mass is as given and how the mass is spread is not known: "
    "the inertia is that of the homogeneous solid about its own centroid"
)


def load(
    source,
    *,
    units=None,
    density=None,
    centre_of_mass=None,
    names=None,
    body=None,
    allow_open=False,
    stdin=None,
):
    """Read a part from a mesh file or a part card.

    Parameters
    ----------
    source : str or Path
        STL, OBJ, PLY, OFF, GLB, 3MF, STEP or YAML; '-' reads standard input.
    units : str, optional
        'mm', 'cm', 'm', 'um' or 'in'; without it what the format states (GLB: m; 3MF and STEP: their own),
        else mm.
    density : str, optional
        A material or a value, '7.85 g/cm3'; steel without it.
    centre_of_mass : str, optional
        'x,y,z' in the file's axes and units, or with units: where it is, if the part is not homogeneous.
    names : str or Path or AspectNames, optional
        File of names of the aspects, or what ``naming.read`` made of it; letters without it.
    body : str, optional
        Which of several bodies in the file is the part: its number from 1, its name, or 'largest'.
    allow_open : bool
        Compute from an open surface or several bodies, and say so.
    stdin : binary file, optional
        Read in place of the file or of the process's own standard input.

    Returns
    -------
    Part

    Raises
    ------
    MeshError
        If the file is damaged or bounds no single solid.
    ConfigError, Faults
        If an option or a part card cannot be used.

    Notes
    -----
    With ``centre_of_mass`` how the mass is spread is not known. The inertia kept is that of the homogeneous
    solid about its own centroid, moved along unchanged; a warning says so.
    """
    if units not in (None, *UNITS):
        raise ArgumentError(
            "units", f"'{units}' is not a unit of a part file", documents.hint(str(units), UNITS)
        )
    value, material = density_of(density)
    file = read.file(source, stdin)
    if read.is_card(file):
        if body is not None:
            raise ArgumentError("body", "a part card is of one body", "leave it out")
        _refuse_beside_card(units=units, density=density, centre_of_mass=centre_of_mass, names=names)
        return card.part(file)
    known = (
        names if names is None or isinstance(names, aspect_names.AspectNames) else aspect_names.read(names)
    )
    solid = _solid(file, read.soup(file), units, (value, material), centre_of_mass, body, allow_open)
    return replace(solid, names=known)


def _solid(file, soup, wanted, stuff, centre_text, body, allow_open):
    unit, said = _unit(soup, wanted)
    soup, one = (soup, None) if body is None else bodies.taken(soup, body, file.where, unit)
    try:
        surface = gate.surface(soup.vertices, soup.faces, file.where, unit, allow_open)
    except SeveralBodiesError as fault:
        raise bodies.refusal(fault, soup, unit) from None
    scale = factor(unit, "length")
    vertices, solid = surface.vertices * scale, surface.solid.scaled(scale)
    centre, shifted = _centre(centre_text, unit, solid.centre)
    try:
        hull = convex_hull(vertices, centre, file.where, given=centre_text is not None)
    except CentreOutsideError as fault:
        if centre_text is None:
            raise
        raise ArgumentError("centre_of_mass", fault.what, fault.mend) from None
    gate.check_hull(surface, hull.volume / scale**3, file.where, unit)
    density, material = stuff
    return Part(
        name=file.name if one is None else f"{file.name}-{one.number}",
        source=file.source,
        sha256=file.sha256 if one is None else _digest(file.sha256, one.number),
        file_sha256=file.sha256,
        units=unit,
        material=material,
        density=density,
        volume=solid.volume,
        mass=density * solid.volume,
        centre_of_mass=check.frozen(centre),
        inertia=check.frozen(density * solid.inertia),
        vertices=check.frozen(vertices),
        faces=check.frozen(surface.faces),
        hull=hull,
        open_surface=surface.open_surface,
        warnings=(*soup.warnings, *said, *_unlikely(vertices, unit, wanted), *surface.warnings, *shifted),
    )


def _digest(sha256, body):
    """The sha256 that stands for one of several bodies of a file: no trial of another is its own."""
    return hashlib.sha256(f"{sha256} body {body}".encode()).hexdigest()


def _refuse_beside_card(**options):
    for name, value in options.items():
        if value is not None:
            raise ArgumentError(name, "a part card has its own", "leave it out")


def _unit(soup, wanted):
    """The unit of the file's numbers; what to say where it is not the wanted one."""
    stated, title = soup.unit, FORMATS[soup.format].title
    if stated is None or wanted in (None, stated):
        return wanted or stated or "mm", ()
    if soup.format == "glb":
        return wanted, (f"GLB is in m by its specification; read in {wanted} as asked for",)
    return stated, (
        f"{title} files state their unit, here {stated}: the units asked for, {wanted}, are not used",
    )


def _unlikely(vertices, unit, wanted):
    """A warning where the size cannot be that of a fed part."""
    size = float(np.ptp(vertices, axis=0).max())
    low, high = FED[0] if wanted else USUAL, FED[1]
    if low <= size <= high:
        return ()
    numbers = size / factor(unit, "length")
    likely = [u for u in UNITS if u != unit and USUAL <= numbers * factor(u, "length") <= high]
    names = " or ".join(UNITS[u] for u in likely)
    kind = "small" if size < low else "large"
    mend = f"if the file is in {names}, pass `units` {likely[0]}" if likely else "check its scale"
    return (f"the largest dimension, {size * 1e3:.3g} mm, is {kind} for a fed part: {mend}",)


def _centre(text, unit, homogeneous):
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
    return centre, (GIVEN_CENTRE,)
