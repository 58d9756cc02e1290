"""A machine as it was found, beside what it should do: on one screen."""

import math

from feederscrew.output import tables
from feederscrew.units import MM, MM_S


def summary(one):
    """Return what was measured beside what should be, and the likely cause, as a table."""
    rows = [("parts in the bowl [%]", f"{100.0 * one.fill:.3g}", "")]
    pairs = (
        ("stroke, peak to peak [mm]", one.should["stroke"] / MM, one.stroke and one.stroke / MM),
        ("acceleration, peak [m/s2]", one.should["acceleration"], one.acceleration),
        ("frequency [Hz]", one.should["frequency"], one.frequency),
        ("velocity of a part [mm/s]", one.velocity_should / MM_S, one.velocity / MM_S),
    )
    rows += [(name, f"{should:.4g}", _text(now)) for name, should, now in pairs]
    rows.append(("natural frequency, as drawn [Hz]", f"{one.natural_frequency:.4g}", ""))
    rows += [("likely cause" if k == 0 else "", cause, "") for k, cause in enumerate(one.causes)]
    return tables.frame(dict(zip(("quantity", "should be", "measured"), zip(*rows))))


def _text(value):
    return "-" if value is None or math.isnan(value) else f"{value:.4g}"


def document(one):
    """Return a MeasuredMachine as the JSON document."""
    now = {"stroke_mm": one.stroke and one.stroke / MM, "acceleration_m_s2": one.acceleration}
    return {
        "fill_percent": 100.0 * one.fill,
        "measured": now | {"frequency_hz": one.frequency, "velocity_mm_s": _known(one.velocity)},
        "should": {
            "stroke_mm": one.should["stroke"] / MM,
            "acceleration_m_s2": one.should["acceleration"],
            "frequency_hz": one.should["frequency"],
            "velocity_mm_s": _known(one.velocity_should),
        },
        "natural_frequency_hz": one.natural_frequency,
        "causes": list(one.causes),
    }


def _known(velocity):
    return velocity / MM_S if math.isfinite(velocity) else None
