"""What the bowl does with the part: slip, velocity, the track, the rate; the drive as knobs."""

from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Bowl
from feederscrew.errors import FeederError
from feederscrew.mechanics.floor_balance import HOP
from feederscrew.output import convey as convey_output
from feederscrew.output import floor as floor_output
from feederscrew.output import headings as headings_output
from feederscrew.output import proof, tables
from feederscrew.output import rate as rate_output
from feederscrew.output import slide as slide_output
from feederscrew.output import track as track_output
from feederscrew.output.convey import CONVEY_COLOURS
from feederscrew.output.page.blocks import Chapter, Knob, Knobs, Notes, Picture, Table, Text, Tile
from feederscrew.output.page.numbers import NOTHING, SHORT, number, percent
from feederscrew.output.words import REGIME_WORDS, regime_words
from feederscrew.rates import tipping
from feederscrew.rates.well_oriented import Rate, fed
from feederscrew.studies.report import STROKE_RANGE, ReportStudy
from feederscrew.units import DEG, MM, MM_S

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
        (cycle,) = _taken(convey_output.offers(study), "convey")
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
    study = case.floor
    document = floor_output.document(study)
    result = floor_output.map_remarks(study)
    offered = floor_output.offers(study)
    pictures = _taken(offered, "floor_plan", "floor_frequency_amplitude", "floor_beta_friction")
    lead = Text(
        f"Aspect {study.posture.name}, heading {np.degrees(study.heading):.4g} deg, at the upper reversal of "
        "the drive; the maps show the same instant for other drives and other friction."
    )
    lines = _notes(result + floor_output.remarks(study))
    return Chapter((lead, *lines, Table(floor_output.summary(document)), *pictures))


def headings(case) -> Chapter:
    """How the part lies along the wall."""
    study = case.headings
    result = headings_output.frame(study)
    frame = tables.frame({title: result[name] for name, title in HEADINGS.items()})
    lead = Text(
        "The directions in which the part is stable when pushed against the wall, the share of all "
        "directions of laying down that ends in each, and the room it takes."
    )
    own = headings_output.offers(study.only(case.aspect))
    pictures = _taken(own, "headings")
    return Chapter((lead, Table(frame), *pictures), warnings=tuple(headings_output.remarks(study)))


def track(case) -> Chapter:
    """Reactions on the track, against the wall."""
    study = case.track
    grid = study.over(case.settings)
    document = track_output.document(study)
    offered = track_output.offers(study, grid)
    pictures = _taken(offered, "track_part", "track_map", "track_cycle")
    lines = _notes(track_output.remarks(study) + track_output.map_remarks(grid))
    return Chapter(
        (Text(on_track(case, WORDS)), *lines, Table(track_output.summary(document)), *pictures),
        tiles=_heading_tiles(study),
    )


def rate(case) -> Chapter:
    """Well-oriented parts a minute."""
    study = case.rate
    tried = bowls.verified(case.path)
    own = case.part, case.bowl, study.rate.orientations.lying[study.rate.row].name
    document = proof.with_trial(rate_output.document(study), tried, *own)
    lead = Text(
        "The chain from velocity to rate. The range in brackets is over all starts, friction a fifth off, "
        "restitution where the part hops, and the interval of the shares. The second table has what the "
        "track and each device do with each orientation."
    )
    return Chapter(
        (lead, Table(rate_output.summary(document)), Table(_passing(study, document["orientations"]))),
        tiles=(_rate_tile(document),),
        warnings=(*rate_output.remarks(study), *study.warnings, *proof.warnings(tried, *own)),
    )


def _passing(study, frame):
    """The orientations with what each station lets pass as a share, which people read in percent.

    Their sizes stand in the chapter before.
    """
    stations = study.rate.orientations.names
    empty = () if np.isfinite(frame["margin_mm"]).any() else ("margin_mm",)
    frame = frame.without(("length_mm", "width_mm", *empty))
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


def _heading_tiles(study) -> tuple[Any, ...]:
    if study.headings is None:
        return ()
    length, width = study.headings.lengths[study.row] / MM, study.headings.widths[study.row] / MM
    note = f"{length:.3g} mm long, covers {width:.3g} of the track's {study.bowl.track.width / MM:.3g} mm"
    return (Tile("lies along the wall at", f"{np.degrees(study.seat.heading):.3g} deg", note),)


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
        Picture(picture.name, picture.make(), picture.alt)
        for start in starts
        for picture in offered
        if picture.is_picture and picture.name.startswith(start)
    ]


def _notes(lines) -> tuple[Any, ...]:
    return (Notes(tuple(lines)),) if lines else ()


SLIDES_DOWN = "On this track the part slides down continuously: it does not travel."
THROWN = "It is thrown: the reactions below are those of the contact; conveying follows its flights."
VERDICT_WORDS = {  # what the rate has it do
    tipping.STAYS: "It stays on its aspect through the stroke.",
    tipping.THROWN: THROWN,
    tipping.OVER: "The drive turns it over: it goes back into the bowl, and the rate is 0.",
    tipping.BACK: "It lies on its round side and rolls back down the climb, so the rate is 0.",
    tipping.ROCKS: (
        "It rocks: at an instant the line of action leaves the contact, a stroke tilts it by {:.2g} deg, and"
        " only from {:.3g} deg on would it turn over."
    ),
}


def on_track(case, words):
    """Return what a part does on the track, in the reader's words.

    Parameters
    ----------
    case : ReportStudy
    words : dict of str to str
        Of each regime.
    """
    answer, stands = case.convey.answer, case.track.stands
    if answer.status == "no steady state":
        return SLIDES_DOWN
    speed = number(answer.velocity / MM_S, SHORT)
    regime = words.get(answer.regime, answer.regime)
    sentences = [
        f"On this track the part travels at {speed} mm/s and {regime}: the rate is computed with that."
    ]
    if HOP in case.track.cycle.state and stands and stands.verdict != tipping.THROWN:
        sentences.append(THROWN)
    sentences += (
        [VERDICT_WORDS[stands.verdict].format(*np.degrees((stands.tilt, stands.lean)))] if stands else []
    )
    return " ".join(sentences)


LEAST_TOP_MM = 1.0  # to which the slider of the amplitude goes at least
KNOBS_LEAD = (
    "Turn the drive and see at once what a part does. Friction turns all coefficients by the same factor. "
    "The rate keeps the mix of orientations and the verdicts that the devices have at the bowl file's own "
    "drive, so it is a guide; feeder rate and feeder trial compute it."
)
TWO_WAVES = "The drive has a second harmonic, which the knobs do not know: feeder convey computes it."


def knobs(case: ReportStudy, rate: Rate | None) -> list[Text | Knobs]:
    """Return a lead and the knobs of the bowl of a report.

    Parameters
    ----------
    case : ReportStudy
    rate : Rate or None
        Without one the rate is left out.

    Returns
    -------
    list of Text and Knobs
        One sentence alone where the drive has a second harmonic.
    """
    if case.bowl.drive.second_harmonic:
        return [Text(TWO_WAVES, quiet=True)]
    drive, friction, climb = case.bowl.drive, case.bowl.friction.static, case.bowl.track.climb
    top = max(STROKE_RANGE * drive.amplitude / MM, LEAST_TOP_MM)
    sliders = (
        Knob("amplitude", "amplitude", "mm", 0.01, top, drive.amplitude / MM),
        _knob("frequency", "frequency", "Hz", 20.0, 150.0, drive.frequency),
        _knob("angle", "vibration angle", "deg", 2.0, 60.0, drive.vibration_angle / DEG),
        _knob("phase", "phase", "deg", -180.0, 180.0, drive.phase / DEG),
        _knob("friction", "static friction", "", 0.05, 1.2, friction),
        _knob("climb", "climb", "deg", 0.0, 12.0, climb / DEG),
    )
    values = {
        "bowl": bowl_values(case.bowl),
        "rate": None if rate is None else rate_values(rate),
        "regimes": [[name, colour, regime_words(name)] for name, colour in CONVEY_COLOURS.items()],
        "top": top,
    }
    return [Text(KNOBS_LEAD, quiet=True, printed=False), Knobs(sliders, values)]


def _knob(name: str, label: str, unit: str, low: float, high: float, own: float) -> Knob:
    """A slider whose ends include the bowl's own value."""
    return Knob(name, label, unit, min(low, own), max(high, own), own)


def bowl_values(bowl: Bowl) -> dict[str, float]:
    """Return a bowl as the script computes with it, in SI units: one setting, no arrays."""
    friction = bowl.friction
    static_back, kinetic_back = friction.backward
    values = {
        "amplitude": bowl.drive.amplitude, "frequency": bowl.drive.frequency,
        "angle": bowl.drive.vibration_angle, "phase": bowl.drive.phase, "climb": bowl.track.climb,
        "bank": bowl.track.bank, "static": friction.static, "kinetic": friction.kinetic,
        "staticBack": static_back, "kineticBack": kinetic_back, "wall": friction.wall,
        "restitution": bowl.restitution, "gravity": bowl.gravity,
    }  # fmt: skip
    return {name: float(value) for name, value in values.items()}


def rate_values(rate: Rate) -> dict[str, float]:
    """Return the factors of a rate that do not depend on the velocity.

    Returns
    -------
    dict of str to float
        ``density`` [1/m] of the queue before the devices, ``blocked`` [s] for which a part blocks the track
        in the mean, ``efficiency`` [1], ``length`` [m] that a part takes behind the devices.
    """
    density = rate.fill / rate.pitch
    freely = rate.velocity.value * density
    moves = freely > 0.0 and rate.offered.value > 0.0
    return {
        "density": float(density),
        "blocked": max(0.0, float(1.0 / rate.offered.value - 1.0 / freely)) if moves else 0.0,
        "efficiency": float(rate.efficiency),
        "length": float(fed(rate.orientations, rate.row).length),
    }
