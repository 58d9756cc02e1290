"""What the library reads and writes first: parts, bowls, postures and names of aspects."""

from collections.abc import Sequence
from typing import IO, Unpack

import numpy as np

from feederscrew import bowl as bowls
from feederscrew import check
from feederscrew import part as parts
from feederscrew.bowl import Bowl
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.part.density import HEAVIEST_SOLID_KG_M3, LIGHTEST_SOLID_KG_M3
from feederscrew.resting import aspects as aspect_rows
from feederscrew.resting import posture as postures
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture
from feederscrew.studies import arguments
from feederscrew.studies.arguments import BowlSettings, Overrides, Path, override_texts, with_settings


def load(
    source: Path,
    *,
    units: str | None = None,
    density: str | float | None = None,
    centre_of_mass: str | Sequence[float] | None = None,
    names: Path | None = None,
    body: str | int | None = None,
    allow_open: bool = False,
    stdin: IO[bytes] | None = None,
) -> Part:
    """Read a part from a mesh file or a part card.

    Parameters
    ----------
    source : str or Path
        STL, OBJ, PLY, OFF, GLB, 3MF, STEP or YAML.
    units : str, optional
        'mm', 'cm', 'm', 'um' or 'in', of a file that does not state it.
    density : str or float [kg/m3], optional
        A material or a value, '7.85 g/cm3'; steel without it.
    centre_of_mass : str or (3,) float, optional
        'x,y,z' in the file's axes and units, if the part is not homogeneous.
    names : str or Path, optional
        File of names of its aspects, as ``write_names`` writes it; letters without it.
    body : str or int, optional
        Which of several bodies in the file: its number from 1, its name, or 'largest'.
    allow_open : bool
        Compute from an open surface.
    stdin : binary file, optional
        Read in place of the file.

    Returns
    -------
    Part

    Raises
    ------
    FeederError
        If the file is damaged, or an argument cannot be used.
    """
    return parts.load(
        arguments.a_file("source", source),
        units=units,
        density=_density(density),
        centre_of_mass=_point(centre_of_mass),
        names=None if names is None else arguments.a_file("names", names),
        body=_body(body),
        allow_open=allow_open,
        stdin=stdin,
    )


@with_settings
def read_bowl(path: Path | None = None, overrides: Overrides = (), **settings: Unpack[BowlSettings]) -> Bowl:
    """Read a bowl from its file, from settings, or take the defaults.

    Parameters
    ----------
    path : str or Path, optional
        Bowl file (YAML).
    overrides : dict, str or sequence of str
        {'drive.frequency': '50 Hz'} or 'drive.frequency=50 Hz'; the last of one key holds.
    **settings : str or float [SI]
        Keys of a bowl file by their last word, amplitude='0.3 mm'. They go over the overrides, and these
        over the file.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the file and of the overrides.
    """
    texts = override_texts(overrides, settings)
    return bowls.read(None if path is None else arguments.a_file("path", path), texts)


def posture(part: Part, aspects: Aspects, aspect: str) -> Posture:
    """Return how a part stands on one aspect: its contact, its outline and the height of its centre of mass.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    aspect : str
        Its name.

    Returns
    -------
    Posture
    """
    return postures.posture(arguments.a_part(part), arguments.the_aspects(aspects), aspect)


def write_names(part: Part, aspects: Aspects, path: Path) -> None:
    """Write the names of a part's aspects to a file that ``load`` takes as ``names``.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    path : str or Path
        Of the file, written anew: change a name there and leave its direction.

    Raises
    ------
    FeederError
        If the part is a card, which has its own names, or the file cannot be written.
    """
    aspect_rows.write_names(
        arguments.a_part(part), arguments.the_aspects(aspects), arguments.a_file("path", path)
    )


def _point(point: str | Sequence[float] | None) -> str | None:
    """A point as the text of one, 'x,y,z'."""
    if point is None or isinstance(point, str):
        return point
    mend = "give 'x,y,z', or three numbers in the file's unit"
    check.kind("centre_of_mass", point, (tuple, list, np.ndarray), mend)
    return ",".join(repr(check.argument("centre_of_mass", coordinate)) for coordinate in point)


def _body(body: str | int | None) -> str | None:
    """A name, 'largest', or a number as the text of one."""
    if body is None or isinstance(body, str):
        return body
    check.kind("body", body, (int, np.integer), "give its number, its name, or 'largest'")
    return str(int(body))


def _density(density: str | float | None) -> str | None:
    """A material, a value with its unit, or a number in kg/m3 as the text of one."""
    if density is None or isinstance(density, str):
        return density
    value = check.argument("density", density)
    if not LIGHTEST_SOLID_KG_M3 <= value <= HEAVIEST_SOLID_KG_M3:
        what = f"is {value:g} kg/m3"
        raise ArgumentError("density", what, "give kg/m3, 7850 for steel, or a text, '7.85 g/cm3'")
    return f"{value!r} kg/m3"
