"""The orientation that a text such as A@90 names."""

import re
from collections.abc import Sequence

import numpy as np

from feederscrew.base import units
from feederscrew.base.arrays import Floats, Values
from feederscrew.base.errors import ConfigError, FeederError
from feederscrew.bowl.devices.asked import LyingPart

HEADING_TOLERANCE_RAD = np.radians(3.0)  # so near to a heading that the part can have, a named one is that
NAMED = re.compile(r"(?P<aspect>[^@\s]+)@(?P<degrees>\d{1,3}(\.\d+)?)(?P<hangs> +hanging( \d+)?)?")
HEADING = re.compile(r"@(\d+\.\d+)")  # [deg] with decimals


def split_name(name: str) -> tuple[str, float | None]:
    """Return the aspect and the heading that a name names, as tables and drawings print it.

    Parameters
    ----------
    name : str
        'A@354', 'C@174 hanging', 'A'.

    Returns
    -------
    aspect : str
    heading : float [rad] or None
        None of the name of an aspect alone.
    """
    if named := NAMED.fullmatch(name.strip()):
        return named["aspect"], float(np.radians(float(named["degrees"])))
    return name, None


def place(
    aspects: Sequence[str],
    headings: Sequence[float] | Floats,
    aspect: str,
    heading: float,
    where: str,
    named: str = "",
    kind: type[FeederError] = FeederError,
) -> int:
    """Return the place of an orientation by its aspect and heading: the one nearest in heading.

    Parameters
    ----------
    aspects : sequence of str
        Of the M orientations.
    headings : sequence of float [rad]
        Of the same.
    aspect : str
        In capitals or not.
    heading : float [rad]
    where : str
        Where it is written, for the fault.
    named : str, optional
        What names it: 'profile gate names'.
    kind : class, optional
        Of the fault.

    Returns
    -------
    int

    Raises
    ------
    FeederError
        Of the ``kind``, if no orientation of the aspect is within ``HEADING_TOLERANCE_RAD``.
    """
    aspect_rows = _places(aspects, aspect)
    if aspect_rows:
        best = nearest(aspects, headings, aspect, heading)
        if abs(_turn(headings[best] - heading)) <= HEADING_TOLERANCE_RAD:
            return best
    if named:
        some = aspect_rows or range(len(aspects))
        listed = ", ".join(f"{aspects[k]}@{round(np.degrees(headings[k])) % 360}" for k in some)
        what = f"{named} orientation {aspect}@{np.degrees(heading):.4g}, which the part does not have"
        raise kind(where, what, f"known are {listed}")
    rows(aspects, aspect, where, kind)
    listed = ", ".join(f"{np.degrees(headings[k]):.4g}" for k in aspect_rows)
    what = f"aspect {aspects[aspect_rows[0]]} has no stable heading {np.degrees(heading):.4g} deg"
    raise kind(where, what, f"choose one of {listed} deg")


def place_of(
    orientations: Sequence[LyingPart],
    aspect: str,
    heading: float,
    where: str,
    named: str = "",
    kind: type[FeederError] = ConfigError,
) -> int:
    """Return the place of an orientation among others, as ``place`` does.

    Parameters
    ----------
    orientations : sequence of LyingPart
    aspect : str
    heading : float [rad]
    where : str
    named : str, optional
    kind : class, optional

    Returns
    -------
    int

    Raises
    ------
    FeederError
        Of the ``kind``, if there is no such orientation.
    """
    names = [orientation.aspect for orientation in orientations]
    turns = [orientation.heading for orientation in orientations]
    return place(names, turns, aspect, heading, where, named, kind)


def nearest(aspects: Sequence[str], headings: Sequence[float] | Floats, aspect: str, heading: float) -> int:
    """Return the place of an orientation that is known from another track: its headings are others there.

    Parameters
    ----------
    aspects : sequence of str
    headings : sequence of float [rad]
    aspect : str
        One of them.
    heading : float [rad]

    Returns
    -------
    int
    """
    return min(_places(aspects, aspect), key=lambda k: abs(_turn(headings[k] - heading)))


def rows(aspects: Sequence[str], aspect: str, where: str, kind: type[FeederError] = FeederError) -> list[int]:
    """Return the places of an aspect's orientations.

    Parameters
    ----------
    aspects : sequence of str
        Of the M orientations.
    aspect : str
    where : str
        Where it is written, for the fault.
    kind : class, optional
        Of the fault.

    Returns
    -------
    list of int

    Raises
    ------
    FeederError
        Of the ``kind``, if there is none.
    """
    aspect_rows = _places(aspects, aspect)
    if not aspect_rows:
        listed = ", ".join(dict.fromkeys(aspects))
        raise kind(where, f"there is no aspect {aspect[:20]!r}", f"choose one of {listed}")
    return aspect_rows


def _places(aspects: Sequence[str], aspect: str) -> list[int]:
    return [k for k, name in enumerate(aspects) if name.casefold() == aspect.strip().casefold()]


def _turn(angle: Values) -> float:
    return np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi


def written(aspect: str, heading: float) -> str:
    """Return an orientation as a bowl file names it: 'A@90'.

    Parameters
    ----------
    aspect : str
    heading : float [rad]

    Returns
    -------
    str
    """
    return units.quoted(f"{aspect}@{np.degrees(heading):.9g}")


def whole_degrees(text: str) -> str:
    """Return a text with its headings in whole degrees, as people read them.

    Parameters
    ----------
    text : str
        '{of: A@90.4021}'

    Returns
    -------
    str
    """
    return HEADING.sub(lambda degrees: f"@{round(float(degrees[1])) % 360}", text)
