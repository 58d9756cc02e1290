"""The part, and how it comes to rest."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew import units
from feederscrew.output import aspects as aspects_output
from feederscrew.output import inertia, shading, style, tables, tipping_graph
from feederscrew.output.offers import by_name
from feederscrew.output.page.blocks import (
    Chapter,
    CsvSheet,
    Notes,
    Picture,
    ShareBar,
    Table,
    Text,
    Tile,
    Views,
)
from feederscrew.output.page.numbers import percent
from feederscrew.output.shading import outermost, short, stance
from feederscrew.part.record import Part
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.units import MM

MOST_VIEWS = aspects_output.MOST_DRAWN_ASPECTS
CARD = "A part card is published data without a shape: there is nothing to draw or to turn."
SHOWN = (
    "density_g_cm3", "mass_g", "volume_mm3", "bounding_box_x_mm", "bounding_box_y_mm", "bounding_box_z_mm",
    "centre_of_mass_x_mm", "centre_of_mass_y_mm", "centre_of_mass_z_mm",
    "principal_moment_1_g_mm2", "principal_moment_2_g_mm2", "principal_moment_3_g_mm2",
)  # fmt: skip
UJ = units.factor("uJ", "energy")


def the_part(case) -> Chapter:
    """Mass properties and warnings."""
    part = case.part
    result = inertia.rows(case.inertia)
    rows = [row for row in result.rows() if row["quantity"] in SHOWN]
    names = [" ".join(tables.heading(row["quantity"])).strip() for row in rows]
    facts = tables.frame({"quantity": names, "value": [row["value"] for row in rows]})
    facets = "a part card: published data, no shape" if part.vertices is None else f"{len(part.faces)} facets"
    lead = Text(f"{part.source}: {facets}, lengths in {part.units}. Material: {part.material}.")
    return Chapter((lead, Table(facts)), warnings=tuple(part.warnings))


def aspects(case):
    """Views, tables and chart of the aspects: one table of shapes and heights, one of probabilities."""
    part, study = case.part, case.resting
    sides = study.aspects
    table, remarks = aspects_output.aspects(study), aspects_output.remarks(study)
    offered = by_name(aspects_output.offers(study))
    views: tuple[Any, ...] = tuple(aspect_views(part, study))
    if part.vertices is not None:
        views = (*views[:1], _picture(offered["aspects.png"], printed=True), *views[1:])
    lines = (Notes(tuple(remarks)),) if remarks and part.vertices is not None else ()
    straight = () if np.isfinite(table["rolling_circle_mm"]).any() else ("rolling_circle_mm",)
    columns = table.without((*aspects_output.NORMALS, *straight))
    chances = [name for name in columns if name.startswith("p_")]
    shapes = Table(columns.without(chances))
    return Chapter(
        (*views, *lines, shapes, Table(columns.only(["aspect", *chances]))),
        tiles=(_tile(case),),
        warnings=tuple(sides.warnings),
    )


def tips(case) -> Chapter:
    """The tipping graph, from exact tumbling."""
    transitions, sides = case.resting.transitions, case.resting.aspects
    rows = np.flatnonzero(sides.stable)[: tipping_graph.MOST_GRAPH_ASPECTS]
    shares = np.where(sides.stable, sides.probabilities["quasistatic"], np.nan)
    drawn = tipping_graph.of_part(case.resting, transitions, shares)
    table = tables.frame(
        {
            "aspect": [sides.names[row] for row in rows],
            "p_quasistatic": shares[rows],
            "lowest_lift_mm": sides.barriers[rows] / MM,
            "energy_uJ": sides.barrier_energies[rows] / UJ,
            "tilts_over_at_deg": np.degrees(sides.tip_angles[rows]),
        }
    )
    lead = Text(
        "How firmly each aspect holds: the least height by which its centre of mass must be lifted "
        "before the part tips over an edge, into an equal face too, what energy that is, and the tilt "
        "of the floor that does it without sliding. Quasistatic is the share of all orientations from "
        "which the part, let go without speed, ends there."
    )
    picture = Picture(
        "tipping.png", style.png(drawn), "Tipping graph: which aspect tips into which, and the lift it takes"
    )
    return Chapter((lead, Table(table), picture), warnings=tuple(sides.ground.tips.doubts))


def numbers(case) -> CsvSheet:
    """The table of aspects cell by cell, as ``aspects.csv`` has it."""
    return CsvSheet("aspects.csv", tables.text(aspects_output.aspects(case.resting), "csv"))


def aspect_views(part: Part, study: AspectsStudy) -> Iterator[Views | Text]:
    """Yield the views of a part on each aspect, to be turned, and what is simplified of its surface."""
    if part.vertices is None:
        yield Text(CARD, quiet=True)
        return
    rows = range(min(len(study.aspects.names), MOST_VIEWS))
    drawn = scene(part, study.aspects, rows)
    yield Views(drawn, tuple(_caption(study.aspects, row) for row in rows))
    if drawn["facets"] < drawn["all"]:
        yield Text(
            f"The views show a coarser surface of {drawn['facets']} facets; "
            f"every number is of all {drawn['all']}.",
            quiet=True,
        )


def _picture(offer, **keywords) -> Picture:
    return Picture(offer.name, offer.make(), offer.alt, **keywords)


def _caption(resting_aspects, row) -> tuple[Any, ...]:
    kind = (
        f"{resting_aspects.forms[row]} ×{resting_aspects.faces[row]}"
        if resting_aspects.stable[row]
        else "not stable"
    )
    return (
        resting_aspects.names[row],
        kind,
        tuple(_bars(resting_aspects, row)) if resting_aspects.stable[row] else (),
    )


def _bars(resting_aspects, row) -> Iterator[Any]:
    """The recommended answer with its interval; without one, every rule. The table has all of them."""
    answer = resting_aspects.recommended
    if answer is not None:
        share, low, high = (float(ends[row]) for ends in (answer.p, answer.low, answer.high))
        yield ShareBar("recommended", style.ANSWER, share, (low, high))
        return
    for place, (rule, values) in enumerate(resting_aspects.probabilities.items()):
        label, colour = style.method(rule, place)
        yield ShareBar(label, colour, float(values[row]))


def _tile(case) -> Tile:
    """Which aspect, and how likely."""
    first = case.aspect == case.likeliest
    return Tile("rests most often on" if first else "wanted", f"aspect {case.aspect}", _how_likely(case))


def _how_likely(case) -> str:
    """The recommended answer with its interval; for a card, what its rules span."""
    answer = case.resting.aspects.recommended
    if answer is not None:
        share, low, high = (percent(ends[case.row]) for ends in (answer.p, answer.low, answer.high))
        return f"{share} % of drops ({low} to {high} %), {answer.rule}"
    chances = {rule: values[case.row] for rule, values in case.resting.aspects.probabilities.items()}
    shares = {rule: share for rule, share in chances.items() if np.isfinite(share)}
    if not shares:
        return "no rule says how often"
    low, high = percent(min(shares.values())), percent(max(shares.values()))
    return f"{low} to {high} % of drops, by {len(shares)} rules"


def scene(part, resting_aspects, rows):
    """What the viewer draws.

    Parameters
    ----------
    part : Part
        With a mesh.
    resting_aspects : Aspects
    rows : sequence of int
        Which aspects.

    Returns
    -------
    dict
        As ``meshes.viewed``, for JSON, and ``poses``.
    """
    points = (part.vertices - part.centre_of_mass) / MM
    radius = float(np.sqrt((points**2).sum(axis=1).max()))
    near = outermost(points / radius)
    stances = [
        stance(near, resting_aspects.normals[row], resting_aspects.heights[row] / MM / radius) for row in rows
    ]
    towards_viewer = stances[0].floor_axes @ stances[0].camera.back
    return shading.viewed(part, towards_viewer) | {
        "poses": [_pose(resting_aspects, row, standing) for row, standing in zip(rows, stances)],
    }


def _pose(resting_aspects, row, standing) -> dict[Any, Any]:
    """Name, rotation (x, y, z, w) from the file's axes to the floor's, height and contact polygon."""
    return {
        "name": resting_aspects.names[row],
        "quaternion": [
            short(q) for q in Rotation.from_matrix(np.array(standing.floor_axes)).as_quat(canonical=True)
        ],
        "height": short(resting_aspects.heights[row] / MM),
        "contact": [short(x) for x in resting_aspects.polygons[row].ravel() / MM],
    }
