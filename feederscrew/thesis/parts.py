"""The thesis's three parts, put through the same stages as a user's file."""

import functools
from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.part import mass
from feederscrew.part.record import CardAspect, Part
from feederscrew.resting.aspects import find
from feederscrew.thesis import t_shape
from feederscrew.thesis.printed_tables import table
from feederscrew.units import factor

TABLES = {  # of each part that is known by its tables only
    "arc_chute": {"csa": "3-2", "stability": "3-3", "experiment": "3-4", "pmi": "3-10", "deviation": "3-12"},
    "magnet": {"csa": "3-5", "stability": "3-6", "experiment": "3-7", "pmi": "3-11", "deviation": "3-13"},
}
G_MM2 = factor("g mm2", "inertia")
MM2 = factor("mm2", "area")
MM = factor("mm", "length")
G = factor("g", "mass")


@dataclass(frozen=True, eq=False)
class TShape:
    """The T shape's aspects A to E, one row each."""

    heights: np.ndarray  # (5,) [m]
    moments: np.ndarray  # (5,) [kg m2]
    faces: np.ndarray  # (5,) int
    pmi: np.ndarray  # (5,) [1] each class counted once, as Tables 3-8 and 3-9 do
    csa: np.ndarray  # (5,) [1]


@functools.cache
def t_aspects(ratio):
    """Return aspects of the T shape, found from its surface.

    Parameters
    ----------
    ratio : float [1]
        Thickness over width.

    Returns
    -------
    TShape
    """
    found = find(t_part(ratio), as_published=True)
    wanted = np.array(list(t_shape.ASPECTS.values()))
    folded = np.column_stack([np.abs(found.normals[:, 0]), found.normals[:, 1], np.abs(found.normals[:, 2])])
    rows = (vectors.product(wanted, folded.T)).argmax(axis=1)
    columns = (
        found.heights,
        found.polar_inertias,
        found.faces,
        found.probabilities["pmi"],
        found.probabilities["csa"],
    )
    return TShape(*(check.frozen(column[rows]) for column in columns))


def t_part(ratio):
    """Return the T shape as a part of the density that gives Table 3-8."""
    vertices, faces = t_shape.solid(ratio)
    solid = mass.solid(vertices[faces])
    return Part(
        name=f"t_shape_{ratio}",
        source="Table 3-8",
        sha256="",
        units="mm",
        material="as printed",
        density=t_shape.DENSITY,
        volume=solid.volume,
        mass=t_shape.DENSITY * solid.volume,
        centre_of_mass=check.frozen(solid.centre),
        inertia=check.frozen(t_shape.DENSITY * solid.inertia),
        vertices=check.frozen(vertices),
        faces=check.frozen(faces),
    )


@functools.cache
def card(name):
    """Return the Arc Chute or the Magnet, from its tables.

    Parameters
    ----------
    name : str
        A key of ``TABLES``.

    Returns
    -------
    Part
    """
    numbers, printed = TABLES[name], table("chapter 4")
    value = {row: float(cells[name]) for row, cells in printed.rows.items() if cells[name]}
    matrix = np.array([[value[f"I_{a}{b}"] for b in "xyz"] for a in "xyz"])
    return Part(
        name=name,
        source=f"Tables {', '.join(numbers.values())}",
        sha256="",
        units="mm",
        material="as printed",
        density=None,
        volume=None,
        mass=value["mass"] * G,
        centre_of_mass=check.frozen(np.array([value[a] for a in "xyz"]) * MM),
        inertia=check.frozen(matrix * G_MM2),
        aspects=_card_aspects(numbers),
        printed=_levers(value, table(numbers["pmi"]).names[-1]),
    )


def rule(name, key):
    """Return probabilities of one rule for the Arc Chute or the Magnet, by aspect.

    Parameters
    ----------
    name : str
        A key of ``TABLES``.
    key : str
        'csa', 'stability' or 'pmi'.

    Returns
    -------
    (A,) float [1]
    """
    found = find(card(name))
    return found.probabilities[key][[found.names.index(aspect) for aspect in table(TABLES[name][key]).names]]


def profiles(name):
    """Return every profile that Tables 3-12 and 3-13 compare, by the name they have there.

    Parameters
    ----------
    name : str
        A key of ``TABLES``.

    Returns
    -------
    dict of str to (A,) float [1]
    """
    measured = table(TABLES[name]["experiment"])
    rules = {key.upper(): rule(name, key) for key in ("csa", "stability", "pmi")}
    return {column: measured.numbers(column) for column in measured.columns} | rules


def mixed_heights():
    """Return the Magnet's CSA profile with Table 3-5's Q over Table 3-11's heights, (3,) [1]."""
    weights = table("3-5").numbers("Q") / table("3-11").numbers("h")
    return weights / weights.sum()


def _levers(value, aspect):
    """Chapter 4's geometry of the part on the floor and on the track, of the aspect it stands on."""
    floor = {
        "aspect": aspect,
        "drive_offset": value["drive_offset"] * MM,
        "centroid_height": value["centroid_height"] * MM,
        "polar_inertia": value["I_xx"] * G_MM2,
    }
    wall = {
        "wall_lever": value["wall_lever"] * MM,
        "wall_lever_angle": np.radians(value["wall_lever_angle"]),
        "wall_x": (value["wall_x_1"] * MM, value["wall_x_2"] * MM),
        "wall_y": value["wall_y"] * MM,
        "wall_friction_y": value["wall_friction_y"] * MM,
    }
    return {"floor": floor, "track": floor | wall}


def _card_aspects(numbers):
    pmi, csa, stability = (table(numbers[key]) for key in ("pmi", "csa", "stability"))
    columns = zip(
        pmi.names,
        pmi.numbers("h") * MM,
        pmi.numbers("I") * G_MM2,
        stability.numbers("A") * MM2,
        csa.numbers("Q"),
        csa.numbers("h") * MM,
        stability.numbers("h") * MM,
        strict=True,
    )
    return tuple(
        CardAspect(
            row,
            height,
            polar_inertia=moment,
            contact_area=area,
            solid_angle=angle,
            solid_angle_in_sr=False,
            csa_height=csa_height,
            stability_height=stability_height,
        )
        for row, height, moment, area, angle, csa_height, stability_height in columns
    )
