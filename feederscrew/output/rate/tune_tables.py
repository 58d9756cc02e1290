"""Settings that reach a target as tables and documents."""

import numpy as np

from feederscrew import units
from feederscrew.conveying import answer, sensitivity
from feederscrew.output import tables
from feederscrew.rates.tune import turned

PER_MINUTE, MM_S = units.factor("/min", "rate"), units.factor("mm/s", "velocity")
SEVERAL = ", several"  # velocities, depending on how the part arrives


def settings(found, bowl, parts_per_metre):
    """The solutions as a frame, the recommended one first.

    Parameters
    ----------
    found : list of Solution
    bowl : Bowl
    parts_per_metre : float [1/m]
        Well-oriented parts per length of track.
    """
    rows = [_row(one, bowl, parts_per_metre) for one in found]
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})


def write(folder, document):
    """Write the document and its table, where there is a folder."""
    if folder:
        folder.write("tune.json", tables.json_text(document))
        folder.write("tune.csv", tables.text(document["settings"], "csv"))


def summary(frame):
    """The solutions as a frame for people: no more than a terminal holds.

    Parameters
    ----------
    frame : DataFrame
        Of ``settings``.
    """
    rows = frame.to_dict("records")
    return tables.frame(
        {
            "setting": [f"{row['key']} {row['value']:.4g} {row['unit']}" for row in rows],
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


def _between(row):
    return f"{row['parts_per_minute_low']:.4g} to {row['parts_per_minute_high']:.4g}"


def _row(one, bowl, parts_per_metre):
    found, key = one.answer, one.key
    doubt = sensitivity.friction_doubt(turned(bowl, key, one.value))
    slowest, fastest = (
        np.nanmin([found.low, doubt.less, doubt.more]),
        np.nanmax([found.high, doubt.less, doubt.more]),
    )
    per_minute = parts_per_metre / PER_MINUTE
    return {
        "key": key.name,
        "value": one.value / units.factor(key.unit, key.dimension),
        "unit": key.unit,
        "parts_per_minute": found.velocity * per_minute,
        "parts_per_minute_low": max(slowest, 0.0) * per_minute,
        "parts_per_minute_high": max(fastest, 0.0) * per_minute,
        "velocity_mm_s": found.velocity / MM_S,
        "regime": found.regime,
        "throw_number": found.throw_number,
        "hardest_impact_mm_s": found.hardest_impact / MM_S,
        "margin_forward": found.margins["forward"],
        "margin_backward": found.margins["backward"],
        "margin_hop": found.margins["hop"],
        "several": bool(found.high - found.low > answer.COEXIST * found.speed),
    }
