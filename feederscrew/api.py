"""The library's front door: what a script needs, by plain names; ``feederscrew`` itself hands them on.

Every function returns the record or the table that the command of its name is made from.
"""

from collections.abc import Iterable, Sequence
from os import PathLike
from typing import IO, TYPE_CHECKING

from feederscrew import bowl as _bowls
from feederscrew import part as _parts
from feederscrew.bowl import Bowl
from feederscrew.conveying.answer import Answer
from feederscrew.errors import ConfigError, Faults, FeederError, MeshError
from feederscrew.output.aspects import tables as _tables
from feederscrew.output.tables import data_frame as _data_frame
from feederscrew.part import Part
from feederscrew.rates.well_oriented import Rate
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.names_file import write_names
from feederscrew.resting.posture import Posture, posture
from feederscrew.studies import aspects as _aspects
from feederscrew.studies import convey as _convey
from feederscrew.studies import rate as _rate
from feederscrew.tooling.devices.base import Device

if TYPE_CHECKING:
    from feederscrew.dropping.drop_test import Result
    from feederscrew.dropping.plate.bowl_test import Shaken
    from feederscrew.output.tables import pd

__all__ = [
    "Answer", "Aspects", "Bowl", "ConfigError", "Faults", "FeederError", "MeshError", "Part", "Posture",
    "Rate", "aspects", "convey", "drop", "find_aspects", "load", "posture", "rate", "read_bowl", "shake",
    "write_names",
]  # fmt: skip


def load(
    source: str | PathLike[str],
    *,
    units: str | None = None,
    density: str | None = None,
    centre_of_mass: str | None = None,
    names: str | PathLike[str] | None = None,
    allow_open: bool = False,
    stdin: IO[bytes] | None = None,
) -> Part:
    """Read a part from a mesh file or a part card.

    Parameters
    ----------
    source : str or Path
        STL, OBJ, PLY, OFF, GLB, 3MF, STEP or YAML.
    units : str, optional
        'mm', 'cm', 'm' or 'in', of a file that does not state it.
    density : str, optional
        A material or a value, '7.85 g/cm3'; steel without it.
    centre_of_mass : str, optional
        'x,y,z' in the file's axes and units, if the part is not homogeneous.
    names : str or Path, optional
        File of names of its aspects, as ``write_names`` writes it; letters without it.
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
        If the file is damaged, or an option cannot be used.
    """
    return _parts.load(
        source,
        units=units,
        density=density,
        centre_of_mass=centre_of_mass,
        names=names,
        allow_open=allow_open,
        stdin=stdin,
    )


def find_aspects(part: Part, *, unstable: bool = False, as_published: bool = False) -> Aspects:
    """Return the resting aspects of a part as a record of arrays, in SI units.

    Parameters
    ----------
    part : Part
    unstable : bool
        List the facets it rolls off as well.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.

    Returns
    -------
    Aspects
    """
    return _aspects.aspects(part, unstable=unstable, as_published=as_published).aspects


def aspects(part: Part, *, unstable: bool = False, as_published: bool = False) -> "pd.DataFrame":
    """Return the resting aspects of a part as the table that ``feeder aspects`` writes.

    Parameters
    ----------
    part : Part
    unstable, as_published : bool
        As for ``find_aspects``.

    Returns
    -------
    DataFrame
        The columns of ``aspects.csv``: mm, g, sr.
    """
    found = _aspects.aspects(part, unstable=unstable, as_published=as_published)
    return _data_frame(_tables.aspects(found))


def drop(
    part: Part,
    *,
    launch: str = "feed",
    drops: int | None = None,
    seed: int = 1,
    jobs: int = 1,
    **conditions: str,
) -> "Result":
    """Run a virtual drop test on a hard plane.

    Parameters
    ----------
    part : Part
        From a mesh.
    launch : str
        'place', 'drop', 'flip', 'roll' or 'feed': what was done to the part.
    drops : int, optional
        How many; 10,000 without it.
    seed : int
        Of the random launches.
    jobs : int
        Cores to use; the counts do not depend on it.
    **conditions : str
        Ranges that replace the launch's: fall='20 mm:50 mm', spin, speed, restitution, friction.

    Returns
    -------
    Result
        Its ``tally`` has counts, shares and intervals by class, in the order of ``find_aspects``.

    Raises
    ------
    FeederError
        If the part has no shape, or a condition is of the wrong kind or out of range.
    """
    from feederscrew.studies.drop import drop as study

    return study(part, launch, conditions, drops=drops, seed=seed, jobs=jobs).result


def shake(
    part: Part,
    bowls: Sequence[Bowl],
    *,
    launch: str = "feed",
    drops: int | None = None,
    seconds: float | None = None,
    seed: int = 1,
    jobs: int = 1,
    **conditions: str,
) -> "list[Shaken]":
    """Run a virtual dynamic bowl test: parts on a plate that vibrates with each bowl's drive.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : sequence of Bowl
    launch : str
        As for ``drop``.
    drops : int, optional
        Parts on each plate; 400 without it.
    seconds : float, optional [s]
        How long each is followed; 5 without it.
    seed, jobs, **conditions
        As for ``drop``; restitution and friction are each bowl's unless given.

    Returns
    -------
    list of Shaken
        One a bowl; its ``occupancy`` has shares, transition rates and velocities with their intervals.

    Raises
    ------
    FeederError
        As for ``drop``.
    """
    from feederscrew.studies.plate import plate as study

    found = study(part, bowls, launch, conditions, drops=drops, seconds=seconds, seed=seed, jobs=jobs)
    return list(found.plates)


def read_bowl(path: str | PathLike[str] | None = None, overrides: Iterable[str] = ()) -> Bowl:
    """Read a bowl from its file, from 'drive.frequency=50 Hz', or take the defaults.

    Parameters
    ----------
    path : str or Path, optional
        Bowl file (YAML).
    overrides : iterable of str
        Such as 'drive.frequency=50 Hz'; the last of one key holds.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the file and of the overrides.
    """
    return _bowls.read(path, tuple(overrides))


def convey(bowl: Bowl) -> Answer:
    """Compute how a part travels on the bowl's track.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Answer
        Its velocity in m/s, status, regime and margins.
    """
    return _convey.convey(bowl).answer


def rate(
    part: Part,
    bowl: Bowl,
    aspect: str,
    *,
    heading: float | None = None,
    rule: str = "recommended",
    devices: Sequence[Device] | None = None,
    gap: float = 0.0,
    fill: float = 1.0,
    launch: str | None = None,
    probabilities: str | PathLike[str] | None = None,
    fed: bool = False,
) -> Rate:
    """Compute the well-oriented parts per second, with each factor.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str
        The one wanted, as ``aspects`` names it.
    heading : float [rad], optional
        Without one, the most frequent that stays on the track.
    rule : str
        Whose probabilities are taken.
    devices : sequence of Device
        From ``feederscrew.bowl.devices``; those of the bowl without it.
    gap : float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.
    launch : str, optional
        What is done to the part: 'place', 'drop', 'flip', 'roll' or 'feed', which is usual.
    probabilities : str or Path, optional
        File of counts whose shares are taken.
    fed : bool
        Take what arrives at the track's entry from the moving floor of the bowl.

    Returns
    -------
    Rate
    """
    known = _rate.shares(part, bowl, launch=launch, probabilities=probabilities, fed=fed)
    own = {"heading": heading, "rule": rule, "devices": devices, "gap": gap, "fill": fill}
    return _rate.rate(part, bowl, aspect, known=known, **own).rate
