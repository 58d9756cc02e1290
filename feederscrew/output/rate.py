"""Files of ``feeder rate`` and ``feeder tune``: parts a minute, and the drives that reach them."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from feederscrew.base import units
from feederscrew.base.columns import Cells, ColumnHead, Document, Frame, quantities, values
from feederscrew.base.units import MM, PER_MINUTE
from feederscrew.bowl.devices.leans import SpacingSection
from feederscrew.feeding.drive_settings import ACCEPTED_RATE_ERROR
from feederscrew.feeding.rate import RATE_COLUMNS, RateStudy
from feederscrew.feeding.tune import TuneStudy
from feederscrew.feeding.well_oriented import entering
from feederscrew.output import offers as offer
from feederscrew.output import part_facts, tables
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import rate_text, tune_text
from feederscrew.sorting.tipping import remark

TOLD = {  # columns that stand in rows of the printed table with words of their own
    "parts_per_minute",
    "aspect",
    "heading_deg",
    "velocity_mm_s",
    "offered_per_minute",
    "efficiency",
    "purity",
    "length_mm",
    "gap_mm",
    "pitch_mm",
    "p_orientation",
    "answer",
    "passes_devices",
    "fill",
    "jams_per_hour",
    "clearing_s",
}
SCARCE = 0.25  # share of the parts at the entry that stay on the track, below which it is said


def document(study: RateStudy) -> Document:
    """Return a rate as the JSON document: the part, the rate and every factor of its chain.

    Parameters
    ----------
    study : RateStudy

    Returns
    -------
    dict
    """
    warnings = (*study.aspects.warnings, *study.of_size, *_jam_remarks(study), *_spacing_remarks(study))
    return {
        **part_facts.part(study.part, warnings),
        **values(RATE_COLUMNS, study),
        "orientations": study.orientations_table(),
    }


def summary(document: Mapping[str, Any]) -> Frame:
    """Return the document as a frame for people: the chain from velocity to rate.

    Parameters
    ----------
    document : mapping
        Of ``document``, with a block ``verified`` where a trial leads.

    Returns
    -------
    Frame
    """
    d, tried = document, document.get("verified")

    def ends(d: Mapping[str, Any], name: str, scale: float = 1.0) -> str:
        value, low, high = (scale * d[key] for key in (name, f"{name}_low", f"{name}_high"))
        return f"{value:.4g} ({low:.4g} to {high:.4g})"

    rows = [("correctly oriented parts per minute", ends(d, "parts_per_minute"))]
    if tried:  # a trial that holds leads
        rows.append(("of these as its trial showed", ends(tried, "parts_per_minute")))
        rows.append(("of these as the rule says", f"{d['parts_per_minute_static']:.4g}"))
    purity = "none" if np.isnan(d["purity"]) else f"{100.0 * d['purity']:.4g}"
    rows += [
        ("orientation", f"{d['aspect']}@{round(d['heading_deg']) % 360}"),
        ("velocity [mm/s]", ends(d, "velocity_mm_s")),
        ("parts offered per minute", ends(d, "offered_per_minute")),
        ("efficiency, correctly oriented of what is offered [%]", f"{100.0 * d['efficiency']:.4g}"),
        ("purity, correctly oriented of what leaves [%]", purity),
        ("mean pitch [mm]", f"{d['pitch_mm']:.4g} (wanted part {d['length_mm']:.4g}, gap {d['gap_mm']:.4g})"),
        ("probability of the orientation [%]", ends(d, "p_orientation", 100.0)),
        ("whose probabilities", d["answer"]),
        ("share that passes the devices [%]", f"{100.0 * d['passes_devices']:.4g}"),
        ("fill of the track [%]", f"{100.0 * d['fill']:.4g}"),
    ]
    if d["jams_per_hour"] > 0.0:
        rows.append(("jams an hour", units.digits_text(d["jams_per_hour"], 4)))
    if d["clearing_s"]:
        rows.append(("time a part swept off blocks the track [s]", f"{d['clearing_s']:.3g}"))
    rows += [
        tables.row_for_people(column, d)
        for column in RATE_COLUMNS
        if not column.hidden and column.name not in TOLD
    ]
    return quantities(rows)


def remarks(study: RateStudy) -> list[str]:
    """Return what a reader of a rate must not overlook, a sentence each.

    Parameters
    ----------
    study : RateStudy

    Returns
    -------
    list of str
    """
    chain, orientations = study.rate, study.rate.orientations
    if chain.velocity.value <= 0.0:
        return ["the part does not travel up the track: see feeder convey"]
    lines = [*_jam_remarks(study), *_spacing_remarks(study)]
    wanted, tipping = orientations.lying[chain.row], orientations.tipping
    # what tips or rocks
    if tipping is not None:
        lost = "; rate is 0" if wanted.turns_over else ""
        lines += [f"{line}{lost}" for line in remark(orientations.lying)]
        if (tipping.tips & ~tipping.over)[chain.row]:
            tilt, lean = (np.degrees(angle[chain.row]) for angle in (tipping.tilt, tipping.balance))
            lines.append(
                f"{wanted.name} rocks on the track: a stroke tilts it by {tilt:.2g} deg at "
                f"most, and from {lean:.3g} deg it would tip over"
            )
    # what rolls
    if rolls_back := [orientation.name for orientation in orientations.lying if orientation.may_roll_back]:
        verbs = ("lies", "rolls", "counts") if len(rolls_back) == 1 else ("lie", "roll", "count")
        where = f"{verbs[0]} on the round side, not along the track, and {verbs[1]} back down the climb"
        lost = "; rate is 0" if wanted.may_roll_back else ""
        lines.append(
            f"{units.listed(rolls_back)} {where}: {verbs[2]} as returned, but as carried in the highest rate"
            f"{lost}; see feeder trial"
        )
    if along := [orientation.name for orientation in orientations.lying if orientation.along_a_bank]:
        lines.append(
            f"{units.listed(along)}: no bank brings to the wall what rolls along the track: no verdict on it "
            "is sure, and the purity counts it as leaving where the track carries it; see feeder trial"
        )
    # few stay on the track
    share, offered = entering(orientations, study.rule)[1], chain.offered.value
    if 0.0 < share < SCARCE and offered > 0.0:
        none = ", and is 0 if none stays" if chain.parts.low == 0.0 < chain.velocity.low else ""
        lines.append(
            f"{100.0 * share:.2g} % of the parts at the entry stay on the track: this rate "
            f"needs {offered / share / PER_MINUTE:,.0f} parts a minute there{none}"
        )
    # what turns parts, or lets nothing through
    if turning := [device.kind for device in study.devices if device.action.turns]:
        lines.append(f"{', '.join(turning)}: quasi-static, until a trial confirms it")
    if wanted.turns_over or chain.through != 0.0:
        return lines
    if chain.efficiency > 0.0:
        turned = "what lands in the wanted orientation is turned or returned; what leaves in it was turned"
        return [*lines, turned]
    devices = (
        f"{device.kind} ({device.text})" if np.isfinite(device.limit) else device.kind
        for device in study.devices
    )
    stations = zip(("the track", *devices), orientations.passes[chain.row])
    names = [name for name, share in stations if share == 0.0]
    verb = "reject" if len(names) > 1 else "rejects"
    return [f"{' and '.join(names)} {verb} the orientation you want; rate is 0"]


def _jam_remarks(study: RateStudy) -> list[str]:
    orientations, lines = study.rate.orientations, []
    for place, name in enumerate(("the track", *(f"the {device.kind}" for device in study.devices))):
        shares = orientations.stops[:, place]
        stands = [item.name for item, share in zip(orientations.lying, shares) if share > 0.0]
        if stands and study.rate.jams > 0.0:
            verb = "stops" if len(stands) == 1 else "stop"
            lines.append(
                f"{units.listed(stands)} {verb} before {name} and nothing behind gets through: a jam; "
                "efficiency and rate hold between jams only"
            )
    return lines


def _spacing_remarks(study: RateStudy) -> list[str]:
    orientations = study.rate.orientations
    if study.rate.gap > orientations.gap or not orientations.gap > 0.0:
        return []
    lying = orientations.lying[0]
    places = [k for k, device in enumerate(study.devices) if device.gap(lying, 0.0) > 0.0]
    kinds = dict.fromkeys(study.devices[k].kind for k in places)
    each = "each " * (len(places) > len(kinds))
    line = (
        f"{each}{units.listed(list(kinds))} looks at one part at a time: the rate is that of parts that come "
        f"{orientations.gap / MM:.3g} mm apart"
    )
    if not any(device.kind == SpacingSection.kind for device in study.devices[: places[0]]):
        line += f" - a {SpacingSection.kind} before it makes that less"
    return [line]


def offers(study: RateStudy) -> list[offer.Offer]:
    """Offer the files of a rate.

    Parameters
    ----------
    study : RateStudy

    Returns
    -------
    list of Offer
    """
    return [
        offer.document("rate.json", document, study),
        offer.table("orientations.csv", study.orientations_table),
    ]


# --- feeder tune ---

TARGET_FRICTION = {False: "at this friction", True: "at the worst friction"}


def tune_document(study: TuneStudy) -> Document:
    """Return the settings that give a rate as the JSON document.

    Parameters
    ----------
    study : TuneStudy

    Returns
    -------
    dict
    """
    return part_facts.part(study.part, study.aspects.warnings) | {
        "target_per_minute": study.target / PER_MINUTE,
        "target_met": TARGET_FRICTION[study.worst],
        "settings": study.table(),
    }


def tune_printed(study: TuneStudy, format: str) -> Frame:
    """Return what a format prints: every column as CSV, for people no more than a terminal holds.

    Parameters
    ----------
    study : TuneStudy
    format : str
        'csv' or 'table'.

    Returns
    -------
    Frame
    """
    frame = study.table()
    if format == "csv":
        return frame
    target = f"{study.target / PER_MINUTE:.6g}/min {TARGET_FRICTION[study.worst].replace(' the ', ' ')}"
    table: Cells = {target: [], "per min": frame["parts_per_minute"], "mu +-20 %": []}
    table |= {"velocity": frame["velocity_mm_s"], "impact": frame["hardest_impact_mm_s"]}
    table["regime"] = []
    for row in frame.rows():
        ends = (row["parts_per_minute_low"], row["parts_per_minute_high"])
        table[target].append(f"{row['key']} {row['value']:.6g} {row['unit']}")
        table["mu +-20 %"].append(" to ".join(f"{end:.3g}" if end < 999.5 else f"{end:.0f}" for end in ends))
        several = ", several" if row["several"] else ""  # velocities, depending on how the part arrives
        table["regime"].append(row["regime"].replace("backward", "slips back") + several)
    for short, name in (("fwd", "forward"), ("back", "backward"), ("hop", "hop")):
        texts = ("-" if math.isnan(value) else f"{value:.2f}" for value in frame[f"margin_{name}"])
        table[f"to {short}"] = [text.rjust(len(f"to {short}")) for text in texts]  # right under its heading
    return Frame.of(table, {name: ColumnHead(name, "mm/s") for name in ("velocity", "impact")})


def tune_remarks(study: TuneStudy) -> list[str]:
    """Return what a reader must not overlook: parts that are turned over, and targets that are passed.

    Parameters
    ----------
    study : TuneStudy

    Returns
    -------
    list of str
    """
    lines = []
    for solution, over in ((tuned.solution, tuned.over) for tuned in study.settings if tuned.over):
        at = f"at {solution.key.name} {solution.number:.6g} {solution.key.unit}"
        lines.append(f"{at}, {units.listed(over)} can tip over on the track and count as returned")
    if any(tuned.solution.rate > (1.0 + ACCEPTED_RATE_ERROR) * study.target for tuned in study.settings):
        lines.append("no setting gives that rate: the velocity jumps over it, and these give more")
    if study.skipped:
        more = f"{study.skipped} more setting{'s' if study.skipped > 1 else ''} of about that velocity"
        lines.append(f"{more} may give the rate as well: the parts that arrive there were not simulated")
    return lines


def tune_offers(study: TuneStudy) -> list[offer.Offer]:
    """Offer the files of the settings that give a rate.

    Parameters
    ----------
    study : TuneStudy

    Returns
    -------
    list of Offer
    """
    return [
        offer.document("tune.json", tune_document, study),
        offer.table("tune.csv", study.table),
    ]


RATE_VIEW = RecordView(lambda study: f"{study.part.name} {rate_text(study.rate)}", offers, "rate")
TUNE_VIEW = RecordView(tune_text, tune_offers, "tune")
