"""Conveying answers and maps as tables and documents."""

import numpy as np

from feederscrew import units
from feederscrew.conveying import answer, sensitivity
from feederscrew.conveying.steady import STATUSES
from feederscrew.output import tables
from feederscrew.studies import maps

MM_S = units.factor("mm/s", "velocity")
VELOCITIES = {"velocity": "velocity_mm_s", "low": "velocity_low_mm_s", "high": "velocity_high_mm_s"}
NO_STEADY_STATE = (
    "no steady state: the part slides down the track without stopping, and no velocity is steady"
)
RUNS_AWAY = (
    "this velocity is reached from rest; a part that once slides down fast enough does not stop again: "
    "the climb is steeper than kinetic friction"
)
LIMITS = {"forward": "slip up the track", "backward": "slip down the track"}


def document(bowl, found, nearby, doubt):
    """One operating point as the JSON document.

    Parameters
    ----------
    bowl : Bowl
    found : Answer
    nearby : dict of str to Neighbours
        From ``sensitivity.sensitivity``.
    doubt : Neighbours
        From ``sensitivity.friction_doubt``.

    Returns
    -------
    dict
    """
    return {
        "status": found.status,
        "period": found.period,
        **{column: getattr(found, name) / MM_S for name, column in VELOCITIES.items()},
        "regime": found.regime,
        "runs_away": found.runs_away,
        "acceleration_ratio": found.setting.ratio,
        "throw_number": found.throw_number,
        "mu_forward": found.mu_forward,
        "mu_backward": found.mu_backward,
        "margins": found.margins,
        "fractions": found.fractions,
        "longest_flight_periods": found.longest_flight,
        "hardest_impact_mm_s": found.hardest_impact / MM_S,
        "flights_per_period": found.flights,
        "sensitivity": {name: _changed(found, pair, sensitivity.CHANGE) for name, pair in nearby.items()},
        "friction_doubt": _changed(found, doubt, sensitivity.FRICTION_DOUBT),
        "validity": answer.validity(found, bowl),
    }


def summary(document):
    """The document of one operating point as a frame for people."""
    rows = [
        ("velocity [mm/s]", _number(document["velocity_mm_s"])),
        ("lowest to highest [mm/s]", _range(document["velocity_low_mm_s"], document["velocity_high_mm_s"])),
        ("status", document["status"] + _of_periods(document["period"])),
        ("regime", document["regime"]),
        ("acceleration ratio A w2/g", _number(document["acceleration_ratio"])),
        ("throw number", _margin(document["throw_number"], document["margins"]["hop"])),
    ]
    for way, meaning in LIMITS.items():
        limit, margin = document[f"mu_{way}"], document["margins"][way]
        rows.append((f"friction that stops {meaning}", _margin(limit, margin)))
    rows += [(f"time in {name} [%]", _number(100.0 * share)) for name, share in document["fractions"].items()]
    rows += [
        ("longest flight [periods]", _number(document["longest_flight_periods"])),
        ("hardest impact [mm/s]", _number(document["hardest_impact_mm_s"])),
        *(_change(name, pair) for name, pair in document["sensitivity"].items()),
        _change("friction", document["friction_doubt"]),
        ("validity", document["validity"]),
    ]
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def remarks(document):
    """What a reader of one operating point must not overlook.

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
        said.append(f"not periodic: an average; its spread is {_range(low, high)} mm/s")
    elif high - low > answer.COEXIST * abs(high):
        said.append(f"several steady velocities, {_range(low, high)} mm/s, depending on how the part arrives")
    return said


def cells(grid):
    """The cells of a map as a frame.

    Parameters
    ----------
    grid : Grid
        Of ``map_columns``.
    """
    columns = grid.columns()
    status = np.asarray(STATUSES)[columns.pop("status").astype(int)]
    columns.pop("several")
    regime = columns.pop("regime")
    throw_number = columns.pop("throw_number")
    return tables.frame(columns | {"regime": regime, "throw_number": throw_number, "status": status})


def grid(spans, bowl_at):
    """Map of a bowl over two of its keys.

    Parameters
    ----------
    spans : two Range
    bowl_at : callable
        The Bowl for a dict of key name to array.

    Returns
    -------
    Grid
        Velocities in mm/s.
    """
    first, second = spans

    def evaluate(one, other):
        return _in_mm_s(answer.cells(bowl_at({first.key.name: one, second.key.name: other})))

    return maps.evaluate(maps.axis(first), maps.axis(second), evaluate, answer.REGIMES)


def map_remarks(grid):
    """How many cells of a map have no steady velocity, no period or several velocities."""
    return _remarks(np.asarray(STATUSES)[grid.values["status"].astype(int)], grid.values["several"])


def curve_remarks(frame):
    """The same of a curve, from its frame; it has several velocities where its range is not one point."""
    low, high = frame["velocity_low_mm_s"], frame["velocity_high_mm_s"]
    several = (frame["status"] == "periodic") & (high - low > answer.COEXIST * high.abs())
    return _remarks(frame["status"].to_numpy(), several)


def _remarks(status, several):
    counts = {
        "no steady state": (status == "no steady state").sum(),
        "no period (averaged)": (status == "averaged").sum(),
        "several velocities": several.sum(),
    }
    return [f"{count} of {status.size} cells: {what}" for what, count in counts.items() if count]


def along_radius(bowl):
    """What a part does at each radius, as a frame.

    Parameters
    ----------
    bowl : Bowl
        Of ``radius.at_radius``.
    """
    mm = units.factor("mm", "length")
    where = {
        "radius_mm": bowl.track.radius / mm,
        "vibration_angle_deg": np.degrees(bowl.drive.vibration_angle),
        "amplitude_mm": bowl.drive.amplitude / mm,
    }
    return _along(where, bowl)


def along_key(span, bowl):
    """What a part does over one key of the bowl, as a frame.

    Parameters
    ----------
    span : Range
    bowl : Bowl
        With that key varied.
    """
    axis = maps.axis(span)
    return _along({axis.column: axis.shown}, bowl)


def values(span):
    """The values of a range by its key's name, as ``bowl.swept`` takes them."""
    return {span.key.name: np.array(span.values)}


def title(span):
    """What a curve over a range is called."""
    return f"Velocity over {span.key.name}"


def _along(where, bowl):
    found = _in_mm_s(answer.cells(bowl))
    return tables.frame(
        {
            **where,
            **{column: found[column] for column in VELOCITIES.values()},
            "regime": np.asarray(answer.REGIMES)[found["regime"]],
            "throw_number": found["throw_number"],
            "status": np.asarray(STATUSES)[found["status"]],
        }
    )


def _in_mm_s(found):
    return {VELOCITIES.get(name, name): a / MM_S if name in VELOCITIES else a for name, a in found.items()}


def _changed(found, pair, change):
    return {
        "change_percent": 100.0 * change,
        "velocity_less_mm_s": pair.less / MM_S,
        "velocity_more_mm_s": pair.more / MM_S,
        "percent_per_percent": pair.elasticity(found.velocity, change),
    }


def _change(name, pair):
    less, more = _number(pair["velocity_less_mm_s"]), _number(pair["velocity_more_mm_s"])
    return f"velocity for {name} -/+ {pair['change_percent']:g} % [mm/s]", f"{less} / {more}"


def _margin(limit, margin):
    return "never holds" if np.isnan(limit) else f"{_number(limit)} (margin {_number(margin)})"


def _of_periods(period):
    return f", every {period} periods" if period > 1 else ""


def _range(low, high):
    return f"{_number(low)} to {_number(high)}"


def _number(value):
    return "none" if np.isnan(value) else f"{value:.4g}"
