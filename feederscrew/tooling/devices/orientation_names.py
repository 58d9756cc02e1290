"""The orientation that a text such as A@90 names."""

import re
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.errors import ConfigError, FeederError

HEADING_TOLERANCE_RAD = np.radians(3.0)  # so near to a heading that the part can have, a named one is that
HEADING = re.compile(r"@(\d+\.\d+)")  # [deg] with decimals


def place(aspects, headings, aspect, heading, where, named="", kind=FeederError):
    """Return the place of an orientation by its aspect and heading: the one nearest in heading.

    Parameters
    ----------
    aspects : sequence of str
        Of the M orientations, their names.
    headings : sequence of float [rad]
        Of them.
    aspect : str
        In capitals or not.
    heading : float [rad]
    where, named : str
        For the fault: where it is written, and what names it ('profile names').
    kind : type of FeederError
        Of the fault.

    Returns
    -------
    int

    Raises
    ------
    FeederError
        If the part has no such orientation.
    """
    rows_of_aspect = _places(aspects, aspect)
    nearest_place = nearest(aspects, headings, aspect, heading) if rows_of_aspect else None
    if nearest_place is not None and abs(_turn(headings[nearest_place] - heading)) <= HEADING_TOLERANCE_RAD:
        return nearest_place
    if named:
        some = rows_of_aspect or range(len(aspects))
        listed = ", ".join(f"{aspects[k]}@{round(np.degrees(headings[k])) % 360}" for k in some)
        what = f"{named} orientation {aspect}@{np.degrees(heading):.4g}, which the part does not have"
        raise kind(where, what, f"known are {listed}")
    rows(aspects, aspect, where, kind)
    listed = ", ".join(f"{np.degrees(headings[k]):.4g}" for k in rows_of_aspect)
    what = f"aspect {aspects[rows_of_aspect[0]]} has no stable heading {np.degrees(heading):.4g} deg"
    raise kind(where, what, f"choose one of {listed} deg")


def nearest(aspects, headings, aspect, heading):
    """Return the place of an orientation that is known from another track: its headings are others there."""
    return min(_places(aspects, aspect), key=lambda k: abs(_turn(headings[k] - heading)))


def rows(aspects, aspect, where, kind=FeederError):
    """Return the places (list of int) of an aspect's orientations; a FeederError where there is none."""
    rows_of_aspect = _places(aspects, aspect)
    if not rows_of_aspect:
        raise kind(where, f"there is no aspect {aspect[:20]!r}", f"choose one of {_once(aspects)}")
    return rows_of_aspect


def _places(aspects, aspect) -> list[Any]:
    return [k for k, name in enumerate(aspects) if name.casefold() == aspect.strip().casefold()]


def place_of(orientations, aspect, heading, where, named="", kind=ConfigError):
    """Return the same among orientations (M,)."""
    return place(
        [orientation.aspect for orientation in orientations],
        [orientation.heading for orientation in orientations],
        aspect,
        heading,
        where,
        named,
        kind,
    )


def written(aspect, heading):
    """Return an orientation by its aspect and heading [rad] as a bowl file names it: 'A@90'."""
    return units.quoted(f"{aspect}@{np.degrees(heading):.9g}")


def whole_degrees(text):
    """Return a text such as '{of: A@90.4021}' with its headings in whole degrees, as people read them."""
    return HEADING.sub(lambda degrees: f"@{round(float(degrees[1])) % 360}", text)


def _turn(angle):
    return np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi


def _once(names) -> str:
    return ", ".join(dict.fromkeys(names))
