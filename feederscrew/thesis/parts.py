"""The thesis's three parts, put through the same stages as a user's file.

The drawing of the T shape, Figure 3-3, is lost; its dimensions follow from Table 3-8.
"""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.part import mass
from feederscrew.part.record import CardAspect, Part
from feederscrew.resting.aspects import find
from feederscrew.thesis.tables import chapter_4, table
from feederscrew.units import MM, factor

TABLES_OF = {  # of each part that is known by its tables only
    "arc_chute": {"csa": "3-2", "stability": "3-3", "experiment": "3-4", "pmi": "3-10", "deviation": "3-12"},
    "magnet": {"csa": "3-5", "stability": "3-6", "experiment": "3-7", "pmi": "3-11", "deviation": "3-13"},
}
G_MM2 = factor("g mm2", "inertia")
MM2 = factor("mm2", "area")
G = factor("g", "mass")

T_WIDTH = 25.0e-3  # [m] over the head
T_HEIGHT = 25.0e-3  # [m]
T_HEAD_HEIGHT = 13.0e-3  # [m]
T_STEM_WIDTH = 11.0e-3  # [m]
T_DENSITY = 1000.0  # [kg/m3] 1.000e-3 g/mm3: gives Table 3-8
T_DENSITY_IN_TEXT = 999.0  # [kg/m3] "9.99 E-4 grams per cubic meter", read as g/mm3: does not give it
T_RATIOS = ("0.4", "0.6", "0.8", "1.0", "1.2", "1.4")  # thickness / width, as printed
T_NORMALS = np.array([  # (5, 3) of the side that aspects A to E lie on, outward; of two equal sides, one
    (0.0, -1.0, 0.0),  # A: on the end of the stem
    (1.0, 0.0, 0.0),  # B: on a side of the head
    (0.0, 1.0, 0.0),  # C: upside down, on the head
    vectors.unit(np.array([T_HEIGHT - T_HEAD_HEIGHT, -0.5 * (T_WIDTH - T_STEM_WIDTH), 0.0])),  # D: leaning
    (0.0, 0.0, 1.0),  # E: flat, on the T
])  # fmt: skip


@dataclass(frozen=True, eq=False)
class TShape:
    """The T shape's aspects A to E, one row each."""

    heights: np.ndarray  # (5,) [m]
    moments: np.ndarray  # (5,) [kg m2]
    faces: np.ndarray  # (5,) int
    pmi: np.ndarray  # (5,) [1] each class counted once, as Tables 3-8 and 3-9 do
    csa: np.ndarray  # (5,) [1]


@functools.cache
def t_aspects(ratio: float) -> TShape:
    """Return aspects of the T shape, searched on its surface.

    Parameters
    ----------
    ratio : float [1]
        Thickness over width.

    Returns
    -------
    TShape
    """
    aspects = find(t_part(ratio), as_published=True)
    x, y, z = aspects.normals.T
    rows = vectors.product(T_NORMALS, np.stack([np.abs(x), y, np.abs(z)])).argmax(axis=1)
    pmi, csa = (aspects.probabilities[rule] for rule in ("pmi", "csa"))
    columns = (aspects.heights, aspects.polar_inertias, aspects.faces, pmi, csa)
    return TShape(*(check.frozen(column[rows]) for column in columns))


def t_part(ratio: float) -> Part:
    """Return the T shape as a part of the density that gives Table 3-8."""
    vertices, faces = t_solid(ratio)
    solid = mass.integrate_solid(vertices[faces])
    return Part(
        name=f"t_shape_{ratio}",
        source="Table 3-8",
        sha256="",
        units="mm",
        material="as printed",
        density=T_DENSITY,
        volume=solid.volume,
        mass=T_DENSITY * solid.volume,
        centre_of_mass=check.frozen(solid.centre),
        inertia=check.frozen(T_DENSITY * solid.inertia),
        vertices=check.frozen(vertices),
        faces=check.frozen(faces),
    )


def t_solid(ratio: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the surface of the T shape.

    Parameters
    ----------
    ratio : float [1]
        Thickness over width.

    Returns
    -------
    vertices : (16, 3) float [m]
        x across the head, y from stem to head, z through the thickness; the middle of the stem's end
        is the origin.
    faces : (28, 3) int
        Counter-clockwise seen from outside.
    """
    half = 0.5 * T_WIDTH * check.positive("ratio", ratio)
    s, w, shoulder, height = 0.5 * T_STEM_WIDTH, 0.5 * T_WIDTH, T_HEIGHT - T_HEAD_HEIGHT, T_HEIGHT
    right = [(s, 0), (s, shoulder), (w, shoulder), (w, height)]
    left = [(-w, height), (-w, shoulder), (-s, shoulder)]
    outline = [(-s, 0), *right, *left]
    top = [(0, 1, 2), (0, 2, 7), (2, 3, 4), (2, 4, 5), (2, 5, 7), (5, 6, 7)]
    bottom = [(a + 8, c + 8, b + 8) for a, b, c in top]
    edges = [(k, (k + 1) % 8) for k in range(8)]
    sides = [face for a, b in edges for face in ((a, a + 8, b), (b, a + 8, b + 8))]
    vertices = np.array([(x, y, z) for z in (half, -half) for x, y in outline])
    return vertices, np.array(top + bottom + sides)


@functools.cache
def card(name: str) -> Part:
    """Return the Arc Chute or the Magnet, from its tables.

    Parameters
    ----------
    name : str
        A key of ``TABLES_OF``.

    Returns
    -------
    Part
    """
    numbers, value = TABLES_OF[name], chapter_4(name)
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


def rule(name: str, key: str) -> NDArray[np.float64]:
    """Return probabilities of one rule for the Arc Chute or the Magnet, by aspect.

    Parameters
    ----------
    name : str
        A key of ``TABLES_OF``.
    key : str
        'csa', 'stability' or 'pmi'.

    Returns
    -------
    (A,) float [1]
    """
    aspects = find(card(name))
    rows = [aspects.names.index(aspect) for aspect in table(TABLES_OF[name][key]).names]
    return aspects.probabilities[key][rows]


def profiles(name: str) -> dict[str, NDArray[np.float64]]:
    """Return every profile that Tables 3-12 and 3-13 compare, by the name they have there.

    Parameters
    ----------
    name : str
        A key of ``TABLES_OF``.

    Returns
    -------
    dict of str to (A,) float [1]
    """
    measured = table(TABLES_OF[name]["experiment"])
    rules = {key.upper(): rule(name, key) for key in ("csa", "stability", "pmi")}
    return {column: measured.numbers(column) for column in measured.columns} | rules


def mixed_heights() -> NDArray[np.float64]:
    """Return the Magnet's CSA profile with Table 3-5's Q over Table 3-11's heights, (3,) [1]."""
    weights = table("3-5").numbers("Q") / table("3-11").numbers("h")
    return weights / weights.sum()


def _levers(value: dict[str, float], aspect: str) -> dict[str, dict]:
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


def _card_aspects(numbers: dict[str, str]) -> tuple[CardAspect, ...]:
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
            name,
            height,
            polar_inertia=moment,
            contact_area=area,
            solid_angle=angle,
            solid_angle_in_sr=False,
            csa_height=csa_height,
            stability_height=stability_height,
        )
        for name, height, moment, area, angle, csa_height, stability_height in columns
    )
