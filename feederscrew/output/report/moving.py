"""What the bowl does with the part: slip, velocity, the track, the rate."""

from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.errors import FeederError
from feederscrew.output import convey as convey_output
from feederscrew.output import floor as floor_output
from feederscrew.output import headings as headings_output
from feederscrew.output import proof, tables
from feederscrew.output import rate as rate_output
from feederscrew.output import slide as slide_output
from feederscrew.output import track as track_output
from feederscrew.output.page.blocks import Chapter, Notes, Picture, Table, Text, Tile
from feederscrew.output.page.numbers import NOTHING, SHORT, number, percent
from feederscrew.output.report.knobs import knobs
from feederscrew.output.report.on_the_track import on_track
from feederscrew.output.words import REGIME_WORDS
from feederscrew.units import MM

HEADINGS = {  # columns of the table, and their names here
    "aspect": "aspect",
    "heading_deg": "heading_deg",
    "share": "p_of this aspect",
    "aspect_share": "p_of all drops",
    "length_mm": "length_mm",
    "width_mm": "width_mm",
    "overhang_mm": "overhang_mm",
    "falls_off": "falls off",
}
WORDS = REGIME_WORDS | {"stick": "sticks, does not travel"}  # of a regime, for a tile


def slide(case) -> Chapter:
    """When a part slips, over its heading and the drive."""
    study = case.slide
    pictures = _taken(slide_output.offers(study), "slide_regimes", "slide_contours")
    return Chapter((*_notes(slide_output.remarks(study)), Table(slide_output.summary(study.maps)), *pictures))


def convey(case) -> Chapter:
    """Operating point and velocity."""
    study = case.convey
    document = convey_output.document(study)
    blocks = [Table(convey_output.summary(document))]
    if study.answer.status != "no steady state":
        (cycle,) = _taken(convey_output.offers(study, bowls.texts(case.settings)), "convey")
        title = convey_output.cycle_title(study.trace(), study.answer)
        blocks.append(replace(cycle, alt=f"Plate and part: {title}"))
    blocks += [*_knobs(case), _velocity_map(case)]
    return Chapter(
        tuple(blocks),
        tiles=(_velocity_tile(document),),
        warnings=(*bowls.remarks(case.settings), *convey_output.remarks(document), *study.warnings),
    )


def floor(case) -> Chapter:
    """Forces and regimes on the bowl's floor."""
    found, settings = case.floor, bowls.texts(case.settings)
    document = floor_output.document(found, settings)
    result = floor_output.map_remarks(found)
    offered = floor_output.offers(found, settings)
    pictures = _taken(offered, "floor_plan", "floor_frequency_amplitude", "floor_beta_friction")
    lead = Text(
        f"Aspect {found.posture.name}, heading {np.degrees(found.heading):.4g} deg, at the upper reversal of "
        "the drive; the maps show the same instant for other drives and other friction."
    )
    lines = _notes(result + floor_output.remarks(found))
    return Chapter((lead, *lines, Table(floor_output.summary(document)), *pictures))


def headings(case) -> Chapter:
    """How the part lies along the wall."""
    study = case.headings
    result = headings_output.frame(study)
    frame = tables.frame({shown: result[name] for name, shown in HEADINGS.items()})
    lead = Text(
        "The directions in which the part is stable when pushed against the wall, the share of all "
        "directions of laying down that ends in each, and the room it takes."
    )
    own = headings_output.offers(study.only(case.aspect), bowls.texts(case.settings))
    pictures = _taken(own, "headings")
    return Chapter((lead, Table(frame), *pictures), warnings=tuple(headings_output.remarks(study)))


def track(case) -> Chapter:
    """Reactions on the track, against the wall."""
    found = case.track
    settings, grid = bowls.texts(case.settings), found.over(case.settings)
    document = track_output.document(found, settings)
    offered = track_output.offers(found, settings, grid)
    pictures = _taken(offered, "track_part", "track_map", "track_cycle")
    lines = _notes(track_output.remarks(found) + track_output.map_remarks(grid))
    return Chapter(
        (Text(on_track(case, WORDS)), *lines, Table(track_output.summary(document)), *pictures),
        tiles=_heading_tiles(found),
    )


def rate(case) -> Chapter:
    """Well-oriented parts a minute."""
    found = case.rate
    tried = bowls.verified(case.path)
    own = case.part, case.bowl, found.rate.orientations.lying[found.rate.row].name
    document = proof.with_trial(rate_output.document(found), tried, *own)
    lead = Text(
        "The chain from velocity to rate. The range in brackets is over all starts, friction a fifth off, "
        "restitution where the part hops, and the interval of the shares. The second table has what the "
        "track and each device do with each orientation."
    )
    return Chapter(
        (lead, Table(rate_output.summary(document)), Table(_passing(found, document["orientations"]))),
        tiles=(_rate_tile(document),),
        warnings=(*rate_output.remarks(found), *found.warnings, *proof.warnings(tried, *own)),
    )


def _passing(found, frame):
    """The orientations with what each station lets pass as a share, which people read in percent."""
    stations = found.rate.orientations.names
    return tables.frame({f"p_{name}" if name in stations else name: column for name, column in frame.items()})


def _velocity_map(case):
    """Velocity and regimes over vibration angle and stroke, with the bowl's own point."""
    study = case.velocity_map
    if not np.isfinite(study.grid.values["velocity"]).any():
        return Text("No drive of 5 to 60 deg and up to 2.5 times this stroke has a steady velocity here.")
    return _taken(convey_output.map_offers(study), "convey_map")[0]


def _knobs(case):
    """The knobs; without a rate where there is none."""
    try:
        rate = case.rate.rate
    except FeederError:  # the chapter on the rate says why
        rate = None
    return knobs(case, rate)


def _velocity_tile(document) -> Tile:
    if np.isnan(document["velocity_mm_s"]):
        return Tile("travels", NOTHING, document["status"])
    doubt = document["friction_doubt"]
    around = [document["velocity_mm_s"], doubt["velocity_less_mm_s"], doubt["velocity_more_mm_s"]]
    low, high = (number(limit(around), SHORT) for limit in (np.nanmin, np.nanmax))
    regime = WORDS.get(document["regime"], document["regime"])
    note = f"{regime}; {low} to {high} mm/s for friction {doubt['change_percent']:g} % off"
    return Tile("travels", f"{number(document['velocity_mm_s'], SHORT)} mm/s", note)


def _heading_tiles(found) -> tuple[Any, ...]:
    if found.headings is None:
        return ()
    length, width = found.headings.lengths[found.row] / MM, found.headings.widths[found.row] / MM
    note = f"{length:.3g} mm long, covers {width:.3g} of the track's {found.bowl.track.width / MM:.3g} mm"
    return (Tile("lies along the wall at", f"{np.degrees(found.seat.heading):.3g} deg", note),)


def _rate_tile(document) -> Tile:
    low, high = (number(document[f"parts_per_minute_{end}"], SHORT) for end in ("low", "high"))
    share = f"{percent(document['p_orientation'])} % of drops"
    what = f"{document['aspect']} at {document['heading_deg']:.3g} deg, {share}"
    if proof.leads(document):
        what = (
            f"as its trial showed; the rule says {number(document['parts_per_minute_static'], SHORT)}; {what}"
        )
    return Tile(
        "leaves correctly oriented",
        f"{number(document['parts_per_minute'], SHORT)} a minute",
        f"{low} to {high}; {what} ({document['answer']})",
    )


def _taken(offered, *starts) -> list[Any]:
    """Make the pictures whose files begin so, in that order."""
    return [
        Picture(one.name, one.make(), one.alt)
        for start in starts
        for one in offered
        if one.is_picture and one.name.startswith(start)
    ]


def _notes(lines) -> tuple[Any, ...]:
    return (Notes(tuple(lines)),) if lines else ()
