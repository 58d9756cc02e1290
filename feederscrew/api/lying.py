"""A part, its mass and how it comes to rest."""

from collections.abc import Sequence
from typing import IO

import numpy as np

from feederscrew import check
from feederscrew import part as parts
from feederscrew.api import asked
from feederscrew.api.asked import Path
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.part.density import HEAVIEST, LIGHTEST
from feederscrew.resting import names_file
from feederscrew.resting import posture as postures
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture
from feederscrew.studies import aspects as resting
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.studies.calibrate import CalibrateStudy
from feederscrew.studies.compare import CompareStudy
from feederscrew.studies.inertia import InertiaStudy
from feederscrew.studies.passages import FeedingStudy


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
        asked.a_file("source", source),
        units=units,
        density=_density(density),
        centre_of_mass=_point(centre_of_mass),
        names=None if names is None else asked.a_file("names", names),
        body=_body(body),
        allow_open=allow_open,
        stdin=stdin,
    )


def aspects(
    part: Part,
    *,
    unstable: bool = False,
    as_published: bool = False,
    surface: str | float | None = None,
    launch: str | None = None,
    drops: int | None = None,
) -> AspectsStudy:
    """Find the resting aspects of a part and how often it lands on each, as ``feeder aspects``.

    Parameters
    ----------
    part : Part
    unstable : bool
        List the facets that it rolls off too.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    surface : str or float, optional
        'hard', 'medium', 'soft' or an exponent of the surface-weighted rule.
    launch : str, optional
        What is done to the part; 'feed' without it.
    drops : int, optional
        Of the drop test, where no closed form answers; 0 for closed forms alone.

    Returns
    -------
    AspectsStudy
        Its ``aspects`` are the record of arrays, in SI units; ``to_frame()`` is ``aspects.csv``.
    """
    own = {"surface": asked.surface(surface), "drops": drops} | ({} if launch is None else {"launch": launch})
    part = asked.a_part(part)
    return resting.aspects(part, unstable=unstable, as_published=as_published, **own)  # type: ignore[arg-type]


def find_aspects(part: Part, *, unstable: bool = False, as_published: bool = False) -> Aspects:
    """Return the resting aspects of a part as a record of arrays, in SI units.

    Parameters
    ----------
    part : Part
    unstable, as_published : bool
        As for ``aspects``.

    Returns
    -------
    Aspects
    """
    return aspects(part, unstable=unstable, as_published=as_published).aspects


def inertia(part: Part) -> InertiaStudy:
    """Return the mass properties of a part, as ``feeder inertia``.

    Parameters
    ----------
    part : Part

    Returns
    -------
    InertiaStudy
    """
    from feederscrew.studies.inertia import inertia as study

    return study(asked.a_part(part))


def compare(
    part: Part, counts: Path, *, launch: str | None = None, as_published: bool = False
) -> CompareStudy | FeedingStudy:
    """Set the rules' probabilities beside counts of a test, as ``feeder compare PART --with COUNTS``.

    Parameters
    ----------
    part : Part
    counts : str or Path
        File of counts or shares (CSV).
    launch : str, optional
        What was done to the part.
    as_published : bool
        As for ``aspects``.

    Returns
    -------
    CompareStudy or FeedingStudy
        The second of a file that counts by device.
    """
    from feederscrew.studies.compare import compare as study

    counts = asked.a_file("counts", counts)
    return study(asked.a_part(part), counts, launch=launch, as_published=as_published)


def calibrate(part: Part, counts: Path) -> CalibrateStudy:
    """Fit the exponent of a surface to counts of a test, as ``feeder calibrate``.

    Parameters
    ----------
    part : Part
    counts : str or Path
        File of counts (CSV).

    Returns
    -------
    CalibrateStudy
    """
    from feederscrew.studies.calibrate import calibrate as study

    return study(asked.a_part(part), asked.a_file("counts", counts))


def posture(part: Part, found: Aspects, aspect: str) -> Posture:
    """Return how a part stands on one aspect: its contact, its outline and the height of its centre of mass.

    Parameters
    ----------
    part : Part
    found : Aspects
        Of that part.
    aspect : str
        Its name.

    Returns
    -------
    Posture
    """
    return postures.posture(asked.a_part(part), asked.the_aspects(found), aspect)


def write_names(part: Part, found: Aspects, path: Path) -> None:
    """Write the names of a part's aspects to a file that ``load`` takes as ``names``.

    Parameters
    ----------
    part : Part
        From a mesh.
    found : Aspects
        Of that part.
    path : str or Path
        Of the file, written anew: change a name there and leave its direction.

    Raises
    ------
    FeederError
        If the part is a card, which has its own names, or the file cannot be written.
    """
    names_file.write_names(asked.a_part(part), asked.the_aspects(found), asked.a_file("path", path))


def _point(given: str | Sequence[float] | None) -> str | None:
    """A point as the text of one, 'x,y,z'."""
    if given is None or isinstance(given, str):
        return given
    mend = "give 'x,y,z', or three numbers in the file's unit"
    check.kind("centre_of_mass", given, (tuple, list, np.ndarray), mend)
    return ",".join(repr(check.argument("centre_of_mass", one)) for one in given)


def _body(given: str | int | None) -> str | None:
    """A name, 'largest', or a number as the text of one."""
    if given is None or isinstance(given, str):
        return given
    check.kind("body", given, (int, np.integer), "give its number, its name, or 'largest'")
    return str(int(given))


def _density(given: str | float | None) -> str | None:
    """A material, a value with its unit, or a number in kg/m3 as the text of one."""
    if given is None or isinstance(given, str):
        return given
    value = check.argument("density", given)
    if not LIGHTEST <= value <= HEAVIEST:
        what = f"is {value:g} kg/m3"
        raise ArgumentError("density", what, "give kg/m3, 7850 for steel, or a text, '7.85 g/cm3'")
    return f"{value!r} kg/m3"
