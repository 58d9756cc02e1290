"""Conveying answers and maps as tables and documents."""

import numpy as np

from feederscrew.conveying import answer, sensitivity, steady
from feederscrew.output import tables
from feederscrew.output.motion_words import PHASE_WORDS, regime_words
from feederscrew.units import MM_S

VELOCITIES = {"velocity": "velocity_mm_s", "low": "velocity_low_mm_s", "high": "velocity_high_mm_s"}
NO_STEADY_STATE = (
    "no steady state: the part slides down the track without stopping, and no velocity is steady"
)
RUNS_AWAY = (
    "this velocity is reached from rest; a part that once slides down fast enough does not stop again: "
    "the climb is steeper than kinetic friction"
)
LIMITS = {"forward": "slip up the track", "backward": "slip down the track"}


def document(study):
    """Return a ConveyStudy as the JSON document, without the bowl's values."""
    found, change = study.answer, sensitivity.CHANGE
    return {
        "status": found.status,
        "period": found.period,
        **{column: getattr(found, name) / MM_S for name, column in VELOCITIES.items()},
        "velocity_slowest_period_mm_s": found.slowest / MM_S,
        "velocity_fastest_period_mm_s": found.fastest / MM_S,
        "regime": found.regime,
        "runs_away": found.runs_away,
        "acceleration_ratio": found.setting.ratio,
        "throw_number": found.throw_number,
        "mu_effective": found.setting.static,
        "mu_effective_kinetic": found.setting.kinetic,
        "mu_forward": found.mu_forward,
        "mu_backward": found.mu_backward,
        "margins": found.margins,
        "fractions": found.fractions,
        "longest_flight_periods": found.longest_flight,
        "hardest_impact_mm_s": found.hardest_impact / MM_S,
        "flights_per_period": found.flights,
        "sensitivity": {name: _changed(found, pair, change) for name, pair in study.nearby.items()},
        "friction_doubt": _changed(found, study.doubt, sensitivity.FRICTION_DOUBT),
        "restitution_doubt": rebound(study.bowl, study.rebound),
        "validity": study.validity,
    }


def summary(document):
    """Return the document of one operating point as a frame for people."""
    rows = [
        ("velocity [mm/s]", number(document["velocity_mm_s"])),
        ("lowest to highest [mm/s]", between(document["velocity_low_mm_s"], document["velocity_high_mm_s"])),
        *_single_periods(document),
        ("status", document["status"] + _of_periods(document["period"])),
        ("regime", regime_words(document["regime"])),
        ("acceleration ratio A w2/g", number(document["acceleration_ratio"])),
        ("throw number", _margin(document["throw_number"], document["margins"]["hop"])),
    ]
    for way, meaning in LIMITS.items():
        limit, margin = document[f"mu_{way}"], document["margins"][way]
        rows.append((f"friction that stops {meaning}", _margin(limit, margin)))
    times = document["fractions"].items()
    rows += [(f"time it {PHASE_WORDS[name]} [%]", number(100.0 * share)) for name, share in times]
    rows += [
        ("longest flight [periods]", number(document["longest_flight_periods"])),
        ("hardest impact [mm/s]", number(document["hardest_impact_mm_s"])),
        *(_change(name, pair) for name, pair in document["sensitivity"].items()),
        _change("friction", document["friction_doubt"]),
        *_bounced(document["restitution_doubt"]),
        ("validity", document["validity"]),
    ]
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def remarks(document):
    """Return what a reader of one operating point must not overlook.

    Parameters
    ----------
    document : dict

    Returns
    -------
    list of str
    """
    said = []
    low, high = document["velocity_low_mm_s"], document["velocity_high_mm_s"]
    if document["status"] == "no steady state":
        return [NO_STEADY_STATE]
    if document["runs_away"]:
        said.append(RUNS_AWAY)
    if document["status"] == "averaged":
        said.append(
            f"not periodic: an average; means over {steady.BLOCK} periods span {between(low, high)} mm/s, "
            f"single periods {_slowest_to_fastest(document)}"
        )
    elif high - low > answer.COEXIST * abs(high):
        said.append(
            f"several steady velocities, {between(low, high)} mm/s, depending on how the part arrives"
        )
    return said


def cells(study):
    """Return the cells of a ConveyMap as a frame."""
    columns = _in_mm_s(study.grid.columns())
    for name in ("status", "several"):
        columns.pop(name)
    regime, throw_number = columns.pop("regime"), columns.pop("throw_number")
    last = {"regime": regime, "throw_number": throw_number, "status": study.statuses.ravel()}
    return tables.frame(columns | last)


def points(study):
    """Return the points of a ConveyCurve as a frame."""
    found = _in_mm_s(study.cells)
    return tables.frame(
        {
            **{axis.column: axis.shown for axis in study.axes},
            **{column: found[column] for column in VELOCITIES.values()},
            "regime": np.asarray(answer.REGIMES)[found["regime"]],
            "throw_number": found["throw_number"],
            "status": study.statuses,
        }
    )


def map_remarks(study):
    """Return how many cells of a ConveyMap have no steady velocity, no period or several velocities."""
    return _remarks(study.statuses, study.grid.values["several"])


def curve_remarks(study):
    """Return the same of a ConveyCurve."""
    return _remarks(study.statuses, study.several)


def _remarks(status, several):
    counts = {
        "no steady state": (status == "no steady state").sum(),
        "no period (averaged)": (status == "averaged").sum(),
        "several velocities": several.sum(),
    }
    return [f"{count} of {status.size} cells: {what}" for what, count in counts.items() if count]


def _in_mm_s(found):
    return {VELOCITIES.get(name, name): a / MM_S if name in VELOCITIES else a for name, a in found.items()}


def _changed(found, pair, change):
    return {
        "change_percent": 100.0 * change,
        "velocity_less_mm_s": pair.less / MM_S,
        "velocity_more_mm_s": pair.more / MM_S,
        "percent_per_percent": pair.elasticity(found.velocity, change),
    }


def rebound(bowl, found):
    """Return a document's entry on the spread of restitution.

    Parameters
    ----------
    bowl : Bowl
    found : Neighbours or None
        From ``sensitivity.restitution_doubt``; None where nothing is thrown up.

    Returns
    -------
    dict or None
    """
    if found is None:
        return None
    low, high = sensitivity.rebounds(bowl)
    return {
        "restitution_low": low,
        "restitution_high": high,
        "velocity_less_mm_s": found.less / MM_S,
        "velocity_more_mm_s": found.more / MM_S,
    }


def _bounced(found):
    """A row of what the spread of restitution does, where the document has one."""
    if found is None:
        return []
    ends = (number(found[f"restitution_{end}"]) for end in ("low", "high"))
    speeds = (number(found[f"velocity_{end}_mm_s"]) for end in ("less", "more"))
    return [(f"velocity for restitution {' / '.join(ends)} [mm/s]", " / ".join(speeds))]


def _change(name, pair):
    less, more = number(pair["velocity_less_mm_s"]), number(pair["velocity_more_mm_s"])
    return f"velocity for {name} -/+ {pair['change_percent']:g} % [mm/s]", f"{less} / {more}"


def _margin(limit, margin):
    return "never holds" if np.isnan(limit) else f"{number(limit)} (margin {number(margin)})"


def _single_periods(document):
    """A row with the range over single periods, where they are not all alike."""
    if document["period"] == 1 or document["status"] == "no steady state":
        return []
    return [("slowest to fastest period [mm/s]", _slowest_to_fastest(document))]


def _slowest_to_fastest(document):
    return between(*(document[f"velocity_{which}_period_mm_s"] for which in ("slowest", "fastest")))


def _of_periods(period):
    return f", every {period} periods" if period > 1 else ""


def between(low, high):
    """Return two numbers as a range for people."""
    return f"{number(low)} to {number(high)}"


def number(value):
    """Return a number for people; NaN is none."""
    return "none" if np.isnan(value) else f"{value:.4g}"
