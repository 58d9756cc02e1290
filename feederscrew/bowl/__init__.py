"""The bowl: its record, its schema and its YAML.

Source of its keys, bounds and rules of thumb: docs/bowl_file.md.
"""

import hashlib
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from feederscrew.bowl.reading import (
    adjust,
    assumptions,
    at_strokes,
    bowl_names,
    effective,
    friction_remarks,
    key_ranges,
    record,
    remarks,
    settings,
    swept,
    texts,
    with_part_material,
)
from feederscrew.bowl.record import Bowl, Drive, Friction, Track
from feederscrew.bowl.verified import verified

__all__ = [
    "Bowl",
    "Drive",
    "Friction",
    "Track",
    "adjust",
    "assumptions",
    "at_strokes",
    "bowl_names",
    "default",
    "friction_remarks",
    "identity",
    "key_ranges",
    "name",
    "read",
    "record",
    "remarks",
    "settings",
    "swept",
    "texts",
    "verified",
    "with_part_material",
]


def read(path: str | PathLike[str] | None = None, overrides: Iterable[str] = ()) -> Bowl:
    """Return the bowl of a file, or of the defaults, with overrides.

    Parameters
    ----------
    path : str or path, optional
        Of a bowl file; without it the defaults.
    overrides : iterable of str
        'drive.frequency=50 Hz'; of one key the last holds.

    Returns
    -------
    Bowl
        It remembers its settings and its file.

    Raises
    ------
    Faults
        Every fault of the file and of the overrides, one a line.
    """
    bowl = record(settings(path, overrides))
    object.__setattr__(bowl, "source", None if path is None else str(path))
    return bowl


def default() -> Bowl:
    """Return the bowl of the documented defaults.

    Returns
    -------
    Bowl
    """
    return record(effective({}))


def name(path: str | PathLike[str] | None = None) -> str:
    """Return what a bowl's results are filed under.

    Parameters
    ----------
    path : str or path, optional
        Of its file.

    Returns
    -------
    str
        The file's stem; 'defaults' without one.
    """
    return "defaults" if path is None else Path(path).stem


def identity(path: str | PathLike[str] | None = None) -> dict[str, str]:
    """Return the sha256 of a bowl file by its path.

    Parameters
    ----------
    path : str or path, optional

    Returns
    -------
    dict of str to str
        Empty for the defaults.
    """
    return {} if path is None else {str(path): hashlib.sha256(Path(path).read_bytes()).hexdigest()}
