"""Files of ``feeder tune``."""

import math
from typing import Any

from feederscrew import units
from feederscrew.conveying.hop import hop
from feederscrew.output import columns, tables
from feederscrew.output import offers as offer
from feederscrew.rates.drive_settings import ACCEPTED_RATE_ERROR
from feederscrew.units import MM, MM_S, PER_MINUTE

SEVERAL = ", several"  # velocities, depending on how the part arrives
TARGET_FRICTION = {False: "at this friction", True: "at the worst friction"}


def document(study):
    """Return a TuneStudy as the JSON document."""
    return columns.part(study.part, study.aspects.warnings) | {
        "target_per_minute": study.target / PER_MINUTE,
        "target_met": TARGET_FRICTION[study.worst],
        "settings": settings(study),
    }


def settings(study):
    """Return the settings of a TuneStudy as a frame, the recommended one first."""
    rows = [_row(tuned, tuned.solution.parts_per_metre / PER_MINUTE) for tuned in study.settings]
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})


def printed(study, format):
    """Return what a format prints: every column as CSV, for people no more than a terminal holds."""
    return settings(study) if format == "csv" else summary(study)


def summary(study):
    """Return the settings as a frame for people: no more than a terminal holds."""
    frame = settings(study)
    rows = frame.rows()
    return tables.frame(
        {
            f"{study.target / PER_MINUTE:.6g}/min {TARGET_FRICTION[study.worst].replace(' the ', ' ')}": [
                f"{row['key']} {row['value']:.6g} {row['unit']}" for row in rows
            ],
            "per min": frame["parts_per_minute"],
            "mu +-20 %": [_between(row) for row in rows],
            "velocity_mm_s": frame["velocity_mm_s"],
            "impact_mm_s": frame["hardest_impact_mm_s"],
            "regime": [
                row["regime"].replace("backward", "slips back") + (SEVERAL if row["several"] else "")
                for row in rows
            ],
            **{
                f"to {short}": [_margin(value, len(short)) for value in frame[f"margin_{name}"]]
                for short, name in (("fwd", "forward"), ("back", "backward"), ("hop", "hop"))
            },
        }
    )


def remarks(study):
    """Return what a reader must not overlook: parts that are turned over, and targets that are passed."""
    tipping = [_solution_words(tuned) for tuned in study.settings if tuned.over]
    lines = [f"{line} can tip over on the track and count as returned" for line in tipping]
    if any(tuned.solution.rate > (1.0 + ACCEPTED_RATE_ERROR) * study.target for tuned in study.settings):
        lines.append("no setting gives that rate: the velocity jumps over it, and these give more")
    return lines


def _solution_words(tuned) -> str:
    key = tuned.solution.key
    return f"at {key.name} {tuned.solution.number:.6g} {key.unit}, {units.listed(tuned.over)}"


def _margin(value, letters):
    """A margin as a cell that stands right under its heading, 'to' and so many letters."""
    text = "-" if math.isnan(value) else f"{value:.2f}"
    return text.rjust(len("to ") + letters)


def _between(row) -> str:
    """The range of a rate as a cell, to three digits."""
    ends = (row["parts_per_minute_low"], row["parts_per_minute_high"])
    return " to ".join(f"{end:.3g}" if end < 999.5 else f"{end:.0f}" for end in ends)


def _row(tuned, per_minute) -> dict[Any, Any]:
    """Return one Tuned setting by column; ``per_minute`` are parts/min for each m/s of velocity."""
    answer, key = tuned.solution.answer, tuned.solution.key
    leap = hop(tuned.driven)
    return {
        "key": key.name,
        "value": tuned.solution.number,
        "unit": key.unit,
        "parts_per_minute": tuned.velocity.value * per_minute,
        "parts_per_minute_low": tuned.velocity.low * per_minute,
        "parts_per_minute_high": tuned.velocity.high * per_minute,
        "velocity_mm_s": answer.velocity / MM_S,
        "regime": answer.regime,
        "throw_number": answer.throw_number,
        "hop_height_mm": leap.height / MM,
        "hop_flight_mm": leap.flight / MM,
        "hardest_impact_mm_s": answer.hardest_impact / MM_S,
        "margin_forward": answer.margins["forward"],
        "margin_backward": answer.margins["backward"],
        "margin_hop": answer.margins["hop"],
        "several": tuned.several,
        "tips_over": " ".join(tuned.over) or None,
    }


def offers(study) -> list[Any]:
    """Offer the files of a TuneStudy, as a list of Offer."""
    return [
        offer.document("tune.json", document, study),
        offer.table("tune.csv", settings, study),
    ]
