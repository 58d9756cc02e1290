"""The thesis's three parts, put through the same stages as a user's file, and Tables 3-1 to 3-13 by them.

The drawing of the T shape, Figure 3-3, is lost; its dimensions follow from Table 3-8.
"""

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.base.units import MM, factor
from feederscrew.part import mass
from feederscrew.part.record import CardAspect, Part
from feederscrew.resting.aspects import find
from feederscrew.resting.deviation import deviation
from feederscrew.resting.rules import formulas
from feederscrew.thesis.tables import TOTAL, Cell, PrintedTable, chapter_4, is_number, last_digit, table

TABLES_OF = {  # of each part that is known by its tables only
    "arc_chute": {"csa": "3-2", "stability": "3-3", "experiment": "3-4", "pmi": "3-10", "deviation": "3-12"},
    "magnet": {"csa": "3-5", "stability": "3-6", "experiment": "3-7", "pmi": "3-11", "deviation": "3-13"},
}
G_MM2 = factor("g mm2", "inertia")  # [kg m2]
MM2 = factor("mm2", "area")  # [m2]
G = factor("g", "mass")  # [kg]

T_WIDTH = 25.0e-3  # [m] over the head
T_HEIGHT = 25.0e-3  # [m]
T_HEAD_HEIGHT = 13.0e-3  # [m]
T_STEM_WIDTH = 11.0e-3  # [m]
T_DENSITY = 1000.0  # [kg/m3] 1.000e-3 g/mm3: gives Table 3-8
T_DENSITY_IN_TEXT = 999.0  # [kg/m3] "9.99 E-4 grams per cubic meter", read as g/mm3: does not give it
T_RATIOS = ("0.4", "0.6", "0.8", "1.0", "1.2", "1.4")  # thickness / width, as printed
T_NORMALS = np.array(
    [  # (5, 3) of the side that aspects A to E lie on, outward; of two equal sides, one
        (0.0, -1.0, 0.0),  # A: on the end of the stem
        (1.0, 0.0, 0.0),  # B: on a side of the head
        (0.0, 1.0, 0.0),  # C: upside down, on the head
        vectors.unit(
            np.array([T_HEIGHT - T_HEAD_HEIGHT, -0.5 * (T_WIDTH - T_STEM_WIDTH), 0.0])
        ),  # D: leaning
        (0.0, 0.0, 1.0),  # E: flat, on the T
    ]
)
THINNER_RATIO = 0.4  # aspect ratio whose CSA profile Table 3-1 prints under 0.6
INPUT_DECIMALS = 2  # the thesis rounds I [g mm2] and h [mm] before it divides them
IMPLIED_ROW = "sum, not printed"
CSA_TOLERANCE_POINTS = 1.0  # [percentage points] between Table 3-1's CSA column, without decimals, and ours


@dataclass(frozen=True, eq=False)
class TShape:
    """The T shape's aspects A to E, one row each."""

    heights: Floats  # (5,) [m]
    moments: Floats  # (5,) [kg m2]
    faces: Ints  # (5,)
    pmi: Floats  # (5,) [1] each class counted once, as Tables 3-8 and 3-9 do
    csa: Floats  # (5,) [1]


@functools.cache
def t_aspects(ratio: float) -> TShape:
    """Return aspects of the T shape of a thickness over width [1], of the density that gives Table 3-8."""
    aspects = find(t_part(ratio), as_published=True)
    x, y, z = aspects.normals.T
    rows = vectors.product(T_NORMALS, np.stack([np.abs(x), y, np.abs(z)])).argmax(axis=1)
    pmi, csa = (aspects.probabilities[rule] for rule in ("pmi", "csa"))
    columns = (aspects.heights, aspects.polar_inertias, aspects.faces, pmi, csa)
    return TShape(*(check.frozen(column[rows]) for column in columns))


def t_part(ratio: float) -> Part:
    """Return the T shape of a thickness over width [1] as a part, of the density that gives Table 3-8."""
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


def t_solid(ratio: float) -> tuple[Floats, Ints]:
    """Return the surface of the T shape of a thickness over width [1].

    Returns ``vertices`` (16, 3) [m]: x across the head, y from stem to head, z through the thickness; the
    middle of the stem's end is the origin; ``faces`` (28, 3): counter-clockwise seen from outside.
    """
    half = 0.5 * T_WIDTH * check.positive("ratio", ratio)
    s, w, shoulder, height = 0.5 * T_STEM_WIDTH, 0.5 * T_WIDTH, T_HEIGHT - T_HEAD_HEIGHT, T_HEIGHT
    right = [(s, 0), (s, shoulder), (w, shoulder), (w, height)]
    outline = [(-s, 0), *right, (-w, height), (-w, shoulder), (-s, shoulder)]
    top = [(0, 1, 2), (0, 2, 7), (2, 3, 4), (2, 4, 5), (2, 5, 7), (5, 6, 7)]
    bottom = [(a + 8, c + 8, b + 8) for a, b, c in top]
    edges = [(k, (k + 1) % 8) for k in range(8)]
    sides = [face for a, b in edges for face in ((a, a + 8, b), (b, a + 8, b + 8))]
    vertices = np.array([(x, y, z) for z in (half, -half) for x, y in outline])
    return vertices, np.array(top + bottom + sides)


@functools.cache
def card(name: str) -> Part:
    """Return the part of a key of ``TABLES_OF``, from its tables and chapter 4."""
    numbers, value = TABLES_OF[name], chapter_4(name)
    pmi, csa, stability = (table(numbers[key]) for key in ("pmi", "csa", "stability"))
    columns = {
        "height": pmi.numbers("h") * MM,
        "polar_inertia": pmi.numbers("I") * G_MM2,
        "contact_area": stability.numbers("A") * MM2,
        "solid_angle": csa.numbers("Q"),
        "csa_height": csa.numbers("h") * MM,
        "stability_height": stability.numbers("h") * MM,
    }
    rows = (dict(zip(columns, cells)) for cells in zip(*columns.values(), strict=True))
    aspects = tuple(
        CardAspect(aspect, solid_angle_in_sr=False, **row) for aspect, row in zip(pmi.names, rows)
    )
    # chapter 4's geometry of the part on the floor and on the track, on the aspect that it stands on
    floor = {
        "aspect": pmi.names[-1],
        "drive_offset": value["drive_offset"] * MM,
        "centroid_height": value["centroid_height"] * MM,
        "polar_inertia": value["I_xx"] * G_MM2,
    }
    wall = {key: value[key] * MM for key in ("wall_lever", "wall_y", "wall_friction_y")} | {
        "wall_lever_angle": np.radians(value["wall_lever_angle"]),
        "wall_x": (value["wall_x_1"] * MM, value["wall_x_2"] * MM),
    }
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
        inertia=check.frozen(np.array([[value[f"I_{a}{b}"] for b in "xyz"] for a in "xyz"]) * G_MM2),
        aspects=aspects,
        printed={"floor": floor, "track": floor | wall},
    )


def _rule(name: str, key: str) -> Floats:
    """Probabilities (A,) [1] by 'csa', 'stability' or 'pmi', in the order of the rule's table."""
    aspects = find(card(name))
    rows = [aspects.names.index(aspect) for aspect in table(TABLES_OF[name][key]).names]
    return aspects.probabilities[key][rows]


def profiles(name: str) -> dict[str, Floats]:
    """Return every profile (A,) [1] that Tables 3-12 and 3-13 compare, by the name it has there."""
    measured = table(TABLES_OF[name]["experiment"])
    rules = {key.upper(): _rule(name, key) for key in ("csa", "stability", "pmi")}
    return {column: measured.numbers(column) for column in measured.columns} | rules


def mixed_heights() -> Floats:
    """Return the Magnet's CSA profile with Table 3-5's Q over Table 3-11's heights, (3,) [1]."""
    weights = table("3-5").numbers("Q") / table("3-11").numbers("h")
    return weights / weights.sum()


def cells(number: str) -> tuple[Cell, ...]:
    """Return printed and recomputed value of each cell of a table '3-9', row by row.

    What print only implies comes last.
    """
    printed = table(number)
    computed = {(cell.row, cell.column): cell for cell in RECIPES[number](printed)}
    order = [(row, column) for row in printed.rows for column in printed.columns if printed.text(row, column)]
    listed = [computed.pop(key, printed.cell(*key)) for key in order]
    return (*listed, *computed.values())


def rounded_shares(ratio: float) -> tuple[Floats, Floats, Floats]:
    """Return moments [g mm2], heights [mm] and PMI probabilities [1] of the T shape, (5,) each.

    All with the thesis's roundings.
    """
    aspects = t_aspects(ratio)
    moments = np.round(aspects.moments / G_MM2, INPUT_DECIMALS)
    heights = np.round(aspects.heights / MM, INPUT_DECIMALS)
    ones = np.ones(len(heights))
    return moments, heights, formulas.normalise(formulas.pmi(ones, moments, heights), ones > 0)


def _table_3_1(table: PrintedTable) -> Iterator[Cell]:
    """CSA at the printed ratio, explained by that of a thinner prism."""
    ours, thinner = (100.0 * t_aspects(ratio).csa for ratio in (0.6, THINNER_RATIO))
    for row, value, other in zip(table.names, ours, thinner, strict=True):
        explanation = {"finding": "csa-ratio", "explaining": other, "tolerance": CSA_TOLERANCE_POINTS}
        yield table.cell(row, "csa", value, **explanation)
    yield _sum(table, "csa")
    yield replace(_sum(table, "experiment", finding="experiment-total"), explaining=100.0)


def _table_3_8(table: PrintedTable) -> Iterator[Cell]:
    """PMI of the T shape, from its solid."""
    aspects = t_aspects(0.6)
    moments, heights, shares = rounded_shares(0.6)
    for k, row in enumerate(table.names):
        yield table.cell(row, "I", aspects.moments[k] / G_MM2)
        yield table.cell(row, "h", aspects.heights[k] / MM)
        yield _ratio(table, row, "I_over_h", moments[k] / heights[k], cut=True)
        yield table.cell(row, "probability", shares[k])
    yield _total(table, "I_over_h", (moments / heights).sum(), "cut-ratios")
    yield _total(table, "probability", 1.0, "sum-of-rounded")


def _table_3_9(table: PrintedTable) -> Iterator[Cell]:
    """PMI of the T shape, from the six solids."""
    for ratio in T_RATIOS:
        shares = 100.0 * rounded_shares(float(ratio))[2]
        for row, share in zip(table.names, shares, strict=True):
            yield table.cell(row, ratio, share, finding="t-shape-rounded")
        yield table.cell(TOTAL, ratio, shares.sum())


def _quotients(weight: str, part: str, rule: str, table: PrintedTable) -> Iterator[Cell]:
    """A table of weight, height, their quotient and its share, and what else of it the thesis leads to."""
    column, cut, heights = f"{weight}_over_h", table.number == "3-10", table.numbers("h")
    quotient = table.numbers(weight) / heights
    for row, value, share in zip(table.names, quotient, _rule(part, rule), strict=True):
        yield _ratio(table, row, column, value, cut)
        yield table.cell(row, "probability", share)
    if "h_total_over_h" in table.columns:  # one height for a column
        implied = (heights * table.numbers("h_total_over_h")).mean()
        for row, height in zip(table.names, heights, strict=True):
            yield table.cell(row, "h_total_over_h", implied / height)
    # chapter 4's matrix
    inertia, centre = card(part).inertia / G_MM2, card(part).centre_of_mass / MM
    if table.number == "3-10":  # 2, 3 and 5 lie along its axes; 5 once x and z are exchanged
        for row in ("2", "3"):
            yield table.cell(row, "I", inertia[1, 1])
        yield table.cell("5", "I", inertia[0, 0], finding="axes-swapped", explaining=inertia[2, 2])
        yield table.cell("5", "h", centre[0])
    elif table.number == "3-11":  # 2 and 3 lie along y and x of its axes
        yield table.cell("2", "I", inertia[1, 1])
        yield table.cell("2", "h", centre[1])
        near = {"explaining": centre[0], "tolerance": 1.01 * last_digit(table.text("3", "h"))}
        yield table.cell("3", "h", centre[0], finding="magnet-height", **near)
    last = table.rows[TOTAL]
    if last[weight]:
        yield _sum(table, weight, finding="q-total" if table.number == "3-2" else "rounded-inputs")
    if last[column] and cut:
        yield _total(table, column, quotient.sum(), "cut-ratios")
    elif last[column]:
        finding = "" if is_number(last[column]) else "magnet-total"
        yield table.cell(TOTAL, column, quotient.sum(), finding=finding)
    if cut:
        yield _total(table, "probability", 1.0, "sum-of-rounded")
    elif table.number == "3-11":
        step = last_digit(last["probability"])
        yield _sum(table, "probability", finding="magnet-probability-total", tolerance=1.01 * step)
    else:
        yield _sum(table, "probability")


def _deviations(part: str, table: PrintedTable) -> Iterator[Cell]:
    """Deviation between any two profiles; those with the Magnet's CSA follow from mixed heights."""
    plain = profiles(part)
    mixed = plain | {"CSA": mixed_heights()} if part == "magnet" else plain
    for row in table.rows:
        first, second = row.split(" - ")
        value, other = deviation(plain[first], plain[second]), deviation(mixed[first], mixed[second])
        finding = "magnet-csa-mixed" if part == "magnet" and "CSA" in row else "cut-deviations"
        yield table.cell(row, "deviation", value, cut=True, finding=finding, explaining=other)


def _column_sums(table: PrintedTable) -> Iterator[Cell]:
    """An experiment's table: nothing leads to its entries, but each column is a whole."""
    for column in table.columns:
        yield Cell(IMPLIED_ROW, column, "1", table.numbers(column).sum())


def _ratio(table: PrintedTable, row: str, column: str, value: float, cut: bool = False) -> Cell:
    """A quotient's cell; the rounding of its two printed terms is what may explain a last digit."""
    terms = [table.text(row, name) for name in (column.partition("_")[0], "h")]
    spread = value * sum(0.5 * last_digit(term) / float(term) for term in terms)
    near = {"explaining": value, "tolerance": spread + 0.5 * last_digit(table.text(row, column))}
    return table.cell(row, column, value, cut=cut, finding="cut-ratios" if cut else "rounded-inputs", **near)


def _sum(table: PrintedTable, column: str, finding: str = "", tolerance: float = 0.0) -> Cell:
    """A column's total, from the printed entries."""
    values = table.numbers(column)
    explaining = values[1:].sum() if finding == "q-total" else values.sum()
    if finding == "rounded-inputs":
        tolerance = sum(0.5 * last_digit(table.text(row, column)) for row in (*table.names, TOTAL))
    near = {"explaining": explaining, "tolerance": tolerance}
    return table.cell(TOTAL, column, values.sum(), finding=finding, **near)


def _total(table: PrintedTable, column: str, total: float, finding: str) -> Cell:
    """A total of entries that were cut off or rounded before they were added."""
    return table.cell(TOTAL, column, total, finding=finding, explaining=table.numbers(column).sum())


RECIPES: dict[str, Callable[[PrintedTable], Iterator[Cell]]] = {
    "3-1": _table_3_1,
    "3-4": _column_sums,
    "3-7": _column_sums,
    "3-8": _table_3_8,
    "3-9": _table_3_9,
}
for _part, _numbers in TABLES_OF.items():
    for _weight, _key in (("Q", "csa"), ("A", "stability"), ("I", "pmi")):
        RECIPES[_numbers[_key]] = functools.partial(_quotients, _weight, _part, _key)
    RECIPES[_numbers["deviation"]] = functools.partial(_deviations, _part)
