"""Settings that reach a target as tables and documents."""

from feederscrew import units
from feederscrew.output import columns, tables
from feederscrew.rates.drive_settings import WITHIN

PER_MINUTE, MM_S = units.factor("/min", "rate"), units.factor("mm/s", "velocity")
SEVERAL = ", several"  # velocities, depending on how the part arrives
MET = {False: "at this friction", True: "at the worst friction"}


def document(study):
    """Return a TuneStudy as the JSON document."""
    return columns.part(study.part, study.aspects.warnings) | {
        "target_per_minute": study.target / PER_MINUTE,
        "target_met": MET[study.worst],
        "settings": settings(study),
    }


def settings(study):
    """Return the settings of a TuneStudy as a frame, the recommended one first."""
    rows = [_row(one, one.solution.parts_per_metre / PER_MINUTE) for one in study.settings]
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})


def shown(study, format):
    """Return what a format prints: every column as CSV, for people no more than a terminal holds."""
    return settings(study) if format == "csv" else summary(study)


def summary(study):
    """Return the settings as a frame for people: no more than a terminal holds."""
    frame = settings(study)
    rows = frame.rows()
    return tables.frame(
        {
            f"{study.target / PER_MINUTE:.6g}/min {MET[study.worst]}": [
                f"{row['key']} {row['value']:.6g} {row['unit']}" for row in rows
            ],
            "per min": frame["parts_per_minute"],
            "mu +-20 %": [_between(row) for row in rows],
            "velocity_mm_s": frame["velocity_mm_s"],
            "impact_mm_s": frame["hardest_impact_mm_s"],
            "regime": [row["regime"] + (SEVERAL if row["several"] else "") for row in rows],
            "to fwd": frame["margin_forward"],
            "to back": frame["margin_backward"],
            "to hop": frame["margin_hop"],
        }
    )


def remarks(study):
    """Return what a reader must not overlook: parts that are turned over, and targets that are passed."""
    tipping = [_told(one) for one in study.settings if one.over]
    said = [f"{line} can tip over on the track and count as returned" for line in tipping]
    if any(one.solution.rate > (1.0 + WITHIN) * study.target for one in study.settings):
        said.append("no setting gives that rate: the velocity jumps over it, and these give more")
    return said


def _told(one):
    key = one.solution.key
    return f"at {key.name} {one.solution.shown:.6g} {key.unit}, {units.listed(one.over)}"


def _between(row):
    return f"{row['parts_per_minute_low']:.4g} to {row['parts_per_minute_high']:.4g}"


def _row(one, per_minute):
    """Return one Tuned setting by column; ``per_minute`` are parts/min for each m/s of velocity."""
    found, key = one.solution.answer, one.solution.key
    return {
        "key": key.name,
        "value": one.solution.shown,
        "unit": key.unit,
        "parts_per_minute": one.velocity.value * per_minute,
        "parts_per_minute_low": one.velocity.low * per_minute,
        "parts_per_minute_high": one.velocity.high * per_minute,
        "velocity_mm_s": found.velocity / MM_S,
        "regime": found.regime,
        "throw_number": found.throw_number,
        "hardest_impact_mm_s": found.hardest_impact / MM_S,
        "margin_forward": found.margins["forward"],
        "margin_backward": found.margins["backward"],
        "margin_hop": found.margins["hop"],
        "several": one.several,
        "tips_over": " ".join(one.over) or None,
    }
