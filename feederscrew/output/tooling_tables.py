"""Tables, documents and the bowl file of ``feeder tooling``."""

from typing import Any

import numpy as np

from feederscrew.bowl.devices import DEVICES_SECTION, check_written, value_text
from feederscrew.output import columns, tables
from feederscrew.tooling import track_sections
from feederscrew.tooling.isolating.chain import in_mm
from feederscrew.tooling.isolating.proposal import LEAST_SHARE
from feederscrew.units import DEG, MM

LEAVING = (  # efficiency and purity, of the trial where there is one
    "efficiency", "efficiency_low", "efficiency_high", "purity", "purity_low", "efficiency_static",
    "purity_static",
)  # fmt: skip
HIDDEN = ("reasons", *(name for name in LEAVING if "_" in name))  # the sentences of the trial have them
TABLE_SPARE_COLUMNS = (  # left out of a table for people that is too wide, the first ones first
    ("smallest_cut", "largest_cut"),
    ("mirror", "wall_distance_mm", "balcony_mm", "canyon_mm", "gap_mm"),
    ("height_mm", "track_width_mm"), ("length_mm", "width_mm"), ("steady",), ("status",), ("purity",),
    ("left_over",),
)  # fmt: skip
CHAIN_COLUMNS = (
    "device", "value", "margin_pass_mm", "margin_reject_mm", "smallest_cut", "largest_cut", "returns",
)  # fmt: skip
HEADINGS_FOR_PEOPLE = {
    "margin_pass_mm": "passes_by_mm",
    "margin_reject_mm": "others_fail_by_mm",
}  # for people
PEOPLE_TEXT_LETTERS = 34  # letters of a text in a table for people
QUASI_STATIC = "quasi-static, until a trial confirms it"
TRACK_SECTION, TRACK_WIDTH_KEY = "track", "track.width"


def document(study):
    """Return a ToolingStudy as the JSON document."""
    values = {
        **columns.part(study.part, (*study.aspects.warnings, *study.of_size)),
        "rule": study.rule,
        "margin_asked_mm": study.margin / MM,
        "orientations": orientations(study),
    }
    if study.design is None:
        return values
    orientation = study.orientations[study.wanted]
    return values | {
        "aspect": orientation.aspect,
        "heading_deg": orientation.heading / DEG,
        "isolated": study.isolates(study.wanted),
        "status": status(study, study.wanted),
        "isolated_static": study.design.isolated,
        "steady": study.design.steady,
        "track_width_mm": study.bowl.track.width / MM,
        **leaving(study, study.wanted),
        "before": [f"{device.kind}: {device.text}" for device in study.design.before],
        "chain": [_cut(cut) for cut in study.design.cuts],
        "quasi_static": [cut.device.kind for cut in study.design.cuts if cut.device.turns],
        "reasons": list(study.design.reasons),
    }


def orientations(study) -> list[Any]:
    """Return one row an orientation: what it measures, its limits and what isolates it.

    Parameters
    ----------
    study : ToolingStudy

    Returns
    -------
    list of dict
    """
    rows = zip(study.orientations, study.shares, study.designs)
    return [
        _row(orientation, share) | _designed(study, k, design)
        for k, (orientation, share, design) in enumerate(rows)
    ]


def leaving(study, place) -> dict[Any, Any]:
    """Return efficiency and purity [1] of an orientation's design, by the names of ``LEAVING``.

    Of its trial where one was made, with the 95 % interval. Else the least by the static rule: without what
    may roll or rock on its way, and with what no verdict is sure to return counted as leaving.
    """
    design, tried = study.designs[place], study.trial_of(place)
    if tried is not None:
        pure = (None, None) if np.isnan(tried.purity) else (tried.purity, tried.purity_ends[0])
        values = (tried.efficiency, *tried.efficiency_ends, *pure)
    else:
        values = (design.least, design.least, design.efficiency, design.purity, design.purity)
    return dict(zip(LEAVING, (*values, design.efficiency, design.purity), strict=True))


def status(study, place) -> str:
    """Return what is known of an orientation's design, in one word.

    'confirmed' or 'denied' by its trial; 'static' where none was made; 'none' where nothing isolates it.
    """
    tried = study.trial_of(place)
    if tried is not None and tried.faults:
        return "denied"
    if not study.isolates(place):
        return "none"
    return "static" if tried is None else "confirmed"


def frame(study, *, people=False):
    """Return the rows as a table; for people with devices as the trade names them."""
    rows = orientations(study)
    if people:
        for row, design in zip(rows, study.designs):
            row["devices"] = row["devices"] and [cut.device.name for cut in design.cuts]
    listed = {"devices": ", ", "left_over": " ", "reasons": "; "}
    for row in rows:
        for name, between in listed.items():
            row[name] = between.join(row[name] or ())
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})


def summary(study, format="csv"):
    """Return what is printed: every orientation, or the chain that isolates the one asked for.

    Parameters
    ----------
    study : ToolingStudy
    format : str
        Of what is printed. A table names devices as the trade does, has values in words, and the first names
        of many that are returned.
    """
    if study.design is None:
        return frame(study, people=format == "table")
    rows = [
        {
            "device": cut.device.kind,
            "value": cut.device.short,
            "margin_pass_mm": cut.margin_pass / MM,
            "margin_reject_mm": cut.margin_reject / MM,
            "smallest_cut": cut.smallest.text,
            "largest_cut": cut.largest.text,
            "returns": _returned(study, cut) or _turns(cut),
        }
        for cut in study.design.cuts
    ]
    names: tuple[str, ...] = CHAIN_COLUMNS
    if format == "table":
        rows = [_for_people(row, cut, _returned(study, cut)) for row, cut in zip(rows, study.design.cuts)]
        names = tuple(HEADINGS_FOR_PEOPLE.get(name, name) for name in CHAIN_COLUMNS)
    return tables.frame({name: [row[name] for row in rows] for name in names})


def _for_people(row, cut, returned):
    """A device's row as the trade names it, its value in words, and headings that say whose margin it is."""
    cells = {HEADINGS_FOR_PEOPLE.get(name, name): value for name, value in row.items()}
    returns = _few(returned, PEOPLE_TEXT_LETTERS) if returned else row["returns"]
    return cells | {"device": cut.device.full_name, "value": cut.device.value_words, "returns": returns}


def _few(text, most) -> str:
    """As many of some names as have room, and how many more there are."""
    names = text.split(" ")
    while len(names) > 1 and len(" ".join(names)) > most:
        names.pop()
    more = len(text.split(" ")) - len(names)
    return " ".join(names) + (f" and {more} more" if more else "")


def _returned(study, cut) -> str:
    """'A@2 A@90, all of B, C': what a device returns, aspects of which it returns every orientation last."""
    names: dict[str, set[str]] = {}
    for orientation in study.orientations:
        names.setdefault(orientation.aspect, set()).add(orientation.name)
    whole = [aspect for aspect, all_of in names.items() if all_of <= set(cut.returns)]
    single = " ".join(name for name in cut.returns if not any(name in names[aspect] for aspect in whole))
    return ", ".join(words for words in (single, f"all of {', '.join(whole)}" if whole else "") if words)


def remarks(study, efficiency=0.0) -> list[Any]:
    """Return what a reader should know: what cannot be told apart, and why."""
    design = study.design
    if design is None:
        return [isolation_words(study, efficiency)]
    return [_lead(study, design), *design.reasons]


def _lead(study, design) -> str:
    """What becomes of the orientation asked for: what the trial says first."""
    orientation, tried = study.orientations[study.wanted], study.trial_of(study.wanted)
    shares = (
        "at least " * (design.least < design.efficiency), 100.0 * design.least,
        "at least " * bool(design.purity_is_least), 100.0 * design.purity,
    )  # fmt: skip
    leave = "{}{:.3g} % of the parts offered leave so, {}{:.4g} % of what leaves".format(*shares)
    if not design.efficiency > 0.0:
        leave = "none of the parts offered leaves so"
    if tried is not None and tried.faults:
        return f"{orientation.name} is not isolated: {tried.sentence.partition(': ')[2]}"
    if tried is None:
        return f"{orientation.name} is {'' if study.isolates(study.wanted) else 'not '}isolated: {leave}"
    return (
        f"{orientation.name} is {'' if design.isolated else 'not '}isolated: of {tried.parts} parts tried "
        f"{tried.figures}; by the static rule {100.0 * design.efficiency:.3g} % of those offered leave so, "
        f"and {tried.verdict}"
    )


def trials(study) -> tuple[Any, ...]:
    """Return what the trials of other chains, or of a table's best, said: two lists, denied and confirmed."""
    other_trials = [trial for k, trial in enumerate(study.trials) if study.design is None or k]
    if study.design is None:
        sentences = [(trial.faults, trial.sentence) for trial in other_trials]
    else:
        sentences = [
            (
                trial.faults,
                f"tried as well, {'; '.join(trial.devices_words or trial.devices)}: {trial.sentence}",
            )
            for trial in other_trials
        ]
    return [text for faults, text in sentences if faults], [text for faults, text in sentences if not faults]


def isolation_words(study, efficiency=0.0) -> str:
    """Say how many of the orientations that come often enough to matter can be isolated."""
    often = np.flatnonzero(study.shares >= LEAST_SHARE)
    designed = [k for k in often if study.designs[k] is not None]
    good = [study.isolates(k) and study.designs[k].efficiency >= efficiency for k in designed]
    least = f" with an efficiency of {100.0 * efficiency:.3g} % or more" if efficiency > 0.0 else ""
    rarer = len(study.designs) - len(often)
    left_out = f" ({rarer} rarer not counted)" if rarer else ""
    come = f"in which {100.0 * LEAST_SHARE:g} % or more of the parts come"
    return f"{sum(good)} of {len(good)} orientations {come} can be isolated{least}{left_out}"


def passages(study):
    """Return one row an orientation: its margin at each device that it meets, and what becomes of it.

    Parameters
    ----------
    study : PassagesStudy

    Returns
    -------
    Frame
    """
    rows = list(zip(study.orientations, study.passages))
    named = {"orientation": [orientation.name for orientation, _ in rows], "p_of all parts": study.shares}
    for place, device in enumerate(study.devices):
        margins = [
            _margin(passages_of[place].verdict) if place < len(passages_of) else None
            for _, passages_of in rows
        ]
        named[f"{device.name} {place + 1}_mm"] = margins
    return tables.frame(
        named | {"outcome": [_outcome(orientation, passages_of) for orientation, passages_of in rows]}
    )


def _margin(verdict):
    return verdict.margin / MM if verdict.sure else None


def _outcome(orientation, ridden):
    if ridden and ridden[-1].verdict.passes <= 0.0:
        doubt = "" if ridden[-1].verdict.sure else ", not sure"
        return f"{ridden[-1].fate} by the {ridden[-1].device.name}{doubt}"
    return track_sections.passage_fate(orientation, ridden)


def _row(orientation, share) -> dict[Any, Any]:
    return {
        "aspect": orientation.aspect,
        "heading_deg": orientation.heading / DEG,
        "share": float(share),
        "length_mm": orientation.length / MM,
        "width_mm": orientation.width / MM,
        "height_mm": orientation.height / MM,
        "wall_distance_mm": orientation.distance / MM,
        "balcony_mm": _finite(orientation.balcony / MM),
        "canyon_mm": orientation.canyon / MM,
        "gap_mm": orientation.gap / MM,
        "mirror": orientation.mirror or None,
    }


def _designed(study, place, design):
    if design is None:
        names = "isolated status devices track_width_mm margin_mm steady"
        return dict.fromkeys([*names.split(), *LEAVING, "left_over", "reasons"])
    return {
        "isolated": study.isolates(place),
        "status": status(study, place),
        "devices": [cut.device.kind for cut in design.cuts],
        "track_width_mm": None if design.width is None else design.width / MM,
        "margin_mm": design.margin / MM,
        "steady": design.steady if design.cuts else None,
        **leaving(study, place),
        "left_over": list(design.left_over),
        "reasons": list(design.reasons),
    }


def _cut(cut) -> dict[Any, Any]:
    return {
        "device": cut.device.kind,
        **cut.device.document_values(),
        "margin_pass_mm": cut.margin_pass / MM,
        "margin_reject_mm": cut.margin_reject / MM,
        "smallest": cut.smallest.document_values(),
        "largest": cut.largest.document_values(),
        "returns": [name for name in cut.returns if name not in cut.stops],
        "stops": list(cut.stops),
        "text": cut.device.text,
        "serves": cut.device.serves or None,
        **_turned(cut),
    }


def _turned(cut) -> dict[Any, Any]:
    """What a turning device does, and how sure that is; nothing of any other."""
    if not cut.device.turns:
        return {}
    return {
        "turns": [{"from": start, "to": end, "share": share} for start, end, share in cut.turns],
        "basis": QUASI_STATIC,
    }


def _turns(cut):
    """'turns A@0 to C@90 (80 %)': what a turning device does, for people; or what it is for."""
    lines = [f"{a} to {b}" + ("" if x > 0.9995 else f" ({100.0 * x:.3g} %)") for a, b, x in cut.turns]
    serves = f"({cut.device.serves})" if cut.device.serves else ""
    return f"turns {', '.join(lines)}; {QUASI_STATIC}" if lines else serves


def _finite(value) -> float | None:
    return float(value) if np.isfinite(value) else None


def bowl_file(study, settings) -> str:
    """Return a bowl file: what the user gave, and the devices that isolate the orientation asked for.

    Parameters
    ----------
    study : ToolingStudy
        Of one orientation.
    settings : sequence of Setting
        Of its bowl.

    Returns
    -------
    str
    """
    check_written(study.design.devices, "tooling.yaml")
    width = study.design.width
    settings_of_user = [s for s in settings if s.is_own and s.key.field != DEVICES_SECTION]
    settings_of_user = [s for s in settings_of_user if width is None or s.key.name != TRACK_WIDTH_KEY]
    lines = [*_file_head(study), *(f"{s.key.word}: {s.text}" for s in settings_of_user if not s.key.section)]
    for section in dict.fromkeys(s.key.section for s in settings_of_user if s.key.section):
        lines += [f"{section}:"]
        lines += [f"  {s.key.word}: {s.text}" for s in settings_of_user if s.key.section == section]
        lines += [_wide(width)] if width is not None and section == TRACK_SECTION else []
    if width is not None and not any(s.key.section == TRACK_SECTION for s in settings_of_user):
        lines += [f"{TRACK_SECTION}:", _wide(width)]
    lines += [f"{DEVICES_SECTION}:  # along the track, in the order parts meet them"]
    lines += [f"  - {device.kind}: {value_text(device)}" for device in study.design.before]
    lines += [f"  - {cut.device.kind}: {value_text(cut.device)}{_mark(cut)}" for cut in study.design.cuts]
    return "\n".join(lines) + "\n"


def _wide(width) -> str:
    return f"  width: {in_mm(width)}  # as the design asks for"


def _mark(cut) -> str:
    """What is not certain of a device."""
    return "  # quasi-static, until a trial confirms it" if cut.device.turns else ""


def _file_head(study) -> list[Any]:
    orientation, design = study.orientations[study.wanted], study.design
    return [
        f"# Tooling that lets aspect {orientation.aspect} at heading "
        f"{orientation.name.partition('@')[2]} deg leave.",
        f"# By the static rule: efficiency {'at least ' * (design.least < design.efficiency)}"
        f"{100.0 * design.least:.4g} %, purity {'at least ' * bool(design.purity_is_least)}"
        f"{100.0 * design.purity:.4g} %, by {study.answer}.",
        *_tried(study.trial_of(study.wanted)),
    ]


def _tried(trial) -> list[Any]:
    """What the trial said, the first thing to know of a design that it denies."""
    if trial is None:
        return ["# By the static rule, not tried: see feeder trial."]
    if trial.faults:
        return [f"# DENIED by its trial: {'; '.join(trial.faults)}."]
    return [f"# Of {trial.parts} parts tried {trial.figures}."]
