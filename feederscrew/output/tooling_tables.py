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
SPARE = (  # left out of a table for people that is too wide, the first ones first
    ("smallest_cut", "largest_cut"),
    ("mirror", "wall_distance_mm", "balcony_mm", "canyon_mm", "gap_mm"),
    ("height_mm", "track_width_mm"), ("length_mm", "width_mm"), ("steady",), ("status",), ("purity",),
    ("left_over",),
)  # fmt: skip
CHAIN = (
    "device", "value", "margin_pass_mm", "margin_reject_mm", "smallest_cut", "largest_cut", "returns",
)  # fmt: skip
WORDS = {"margin_pass_mm": "passes_by_mm", "margin_reject_mm": "others_fail_by_mm"}  # for people
WIDE = 34  # letters of a text in a table for people
QUASI_STATIC = "quasi-static, until a trial confirms it"
TRACK, WIDTH = "track", "track.width"


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
    one = study.orientations[study.wanted]
    return values | {
        "aspect": one.aspect,
        "heading_deg": one.heading / DEG,
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
    return [_row(one, share) | _designed(study, k, found) for k, (one, share, found) in enumerate(rows)]


def leaving(study, place) -> dict[Any, Any]:
    """Return efficiency and purity [1] of an orientation's design, by the names of ``LEAVING``.

    Of its trial where one was made, with the 95 % interval. Else the least by the static rule: without what
    may roll or rock on its way, and with what no verdict is sure to return counted as leaving.
    """
    found, tried = study.designs[place], study.trial_of(place)
    if tried is not None:
        pure = (None, None) if np.isnan(tried.purity) else (tried.purity, tried.purity_ends[0])
        values = (tried.efficiency, *tried.efficiency_ends, *pure)
    else:
        values = (found.least, found.least, found.efficiency, found.purity, found.purity)
    return dict(zip(LEAVING, (*values, found.efficiency, found.purity), strict=True))


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
        for row, found in zip(rows, study.designs):
            row["devices"] = row["devices"] and [cut.device.name for cut in found.cuts]
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
    names: tuple[str, ...] = CHAIN
    if format == "table":
        rows = [_for_people(row, cut, _returned(study, cut)) for row, cut in zip(rows, study.design.cuts)]
        names = tuple(WORDS.get(name, name) for name in CHAIN)
    return tables.frame({name: [row[name] for row in rows] for name in names})


def _for_people(row, cut, returned):
    """A device's row as the trade names it, its value in words, and headings that say whose margin it is."""
    shown = {WORDS.get(name, name): value for name, value in row.items()}
    returns = _few(returned, WIDE) if returned else row["returns"]
    return shown | {"device": cut.device.full_name, "value": cut.device.value_words, "returns": returns}


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
    for one in study.orientations:
        names.setdefault(one.aspect, set()).add(one.name)
    whole = [aspect for aspect, all_of in names.items() if all_of <= set(cut.returns)]
    single = " ".join(name for name in cut.returns if not any(name in names[aspect] for aspect in whole))
    return ", ".join(shown for shown in (single, f"all of {', '.join(whole)}" if whole else "") if shown)


def remarks(study, efficiency=0.0) -> list[Any]:
    """Return what a reader should know: what cannot be told apart, and why."""
    found = study.design
    if found is None:
        return [isolation_words(study, efficiency)]
    return [_lead(study, found), *found.reasons]


def _lead(study, found) -> str:
    """What becomes of the orientation asked for: what the trial says first."""
    one, tried = study.orientations[study.wanted], study.trial_of(study.wanted)
    shares = (
        "at least " * (found.least < found.efficiency), 100.0 * found.least,
        "at least " * bool(found.purity_is_least), 100.0 * found.purity,
    )  # fmt: skip
    leave = "{}{:.3g} % of the parts offered leave so, {}{:.4g} % of what leaves".format(*shares)
    if not found.efficiency > 0.0:
        leave = "none of the parts offered leaves so"
    if tried is not None and tried.faults:
        return f"{one.name} is not isolated: {tried.sentence.partition(': ')[2]}"
    if tried is None:
        return f"{one.name} is {'' if study.isolates(study.wanted) else 'not '}isolated: {leave}"
    return (
        f"{one.name} is {'' if found.isolated else 'not '}isolated: of {tried.parts} parts tried "
        f"{tried.figures}; by the static rule {100.0 * found.efficiency:.3g} % of those offered leave so, "
        f"and {tried.verdict}"
    )


def trials(study) -> tuple[Any, ...]:
    """Return what the trials of other chains, or of a table's best, said: two lists, denied and confirmed."""
    told = [one for k, one in enumerate(study.trials) if study.design is None or k]
    if study.design is None:
        said = [(one.faults, one.sentence) for one in told]
    else:
        said = [
            (one.faults, f"tried as well, {'; '.join(one.devices_words or one.devices)}: {one.sentence}")
            for one in told
        ]
    return [text for faults, text in said if faults], [text for faults, text in said if not faults]


def isolation_words(study, efficiency=0.0) -> str:
    """Say how many of the orientations that come often enough to matter can be isolated."""
    often = np.flatnonzero(study.shares >= LEAST_SHARE)
    designed = [k for k in often if study.designs[k] is not None]
    good = [study.isolates(k) and study.designs[k].efficiency >= efficiency for k in designed]
    asked = f" with an efficiency of {100.0 * efficiency:.3g} % or more" if efficiency > 0.0 else ""
    rarer = len(study.designs) - len(often)
    left_out = f" ({rarer} rarer not counted)" if rarer else ""
    come = f"in which {100.0 * LEAST_SHARE:g} % or more of the parts come"
    return f"{sum(good)} of {len(good)} orientations {come} can be isolated{asked}{left_out}"


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
    named = {"orientation": [one.name for one, _ in rows], "p_of all parts": study.shares}
    for place, device in enumerate(study.devices):
        margins = [_margin(met[place].verdict) if place < len(met) else None for _, met in rows]
        named[f"{device.name} {place + 1}_mm"] = margins
    return tables.frame(named | {"outcome": [_outcome(one, met) for one, met in rows]})


def _margin(verdict):
    return verdict.margin / MM if verdict.sure else None


def _outcome(one, met):
    if met and met[-1].verdict.passes <= 0.0:
        doubt = "" if met[-1].verdict.sure else ", not sure"
        return f"{met[-1].fate} by the {met[-1].device.name}{doubt}"
    return track_sections.passage_fate(one, met)


def _row(one, share) -> dict[Any, Any]:
    return {
        "aspect": one.aspect,
        "heading_deg": one.heading / DEG,
        "share": float(share),
        "length_mm": one.length / MM,
        "width_mm": one.width / MM,
        "height_mm": one.height / MM,
        "wall_distance_mm": one.distance / MM,
        "balcony_mm": _finite(one.balcony / MM),
        "canyon_mm": one.canyon / MM,
        "gap_mm": one.gap / MM,
        "mirror": one.mirror or None,
    }


def _designed(study, place, found):
    if found is None:
        names = "isolated status devices track_width_mm margin_mm steady"
        return dict.fromkeys([*names.split(), *LEAVING, "left_over", "reasons"])
    return {
        "isolated": study.isolates(place),
        "status": status(study, place),
        "devices": [cut.device.kind for cut in found.cuts],
        "track_width_mm": None if found.width is None else found.width / MM,
        "margin_mm": found.margin / MM,
        "steady": found.steady if found.cuts else None,
        **leaving(study, place),
        "left_over": list(found.left_over),
        "reasons": list(found.reasons),
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
    given = [s for s in settings if s.is_own and s.key.field != DEVICES_SECTION]
    given = [s for s in given if width is None or s.key.name != WIDTH]
    lines = [*_file_head(study), *(f"{s.key.word}: {s.text}" for s in given if not s.key.section)]
    for section in dict.fromkeys(s.key.section for s in given if s.key.section):
        lines += [f"{section}:"]
        lines += [f"  {s.key.word}: {s.text}" for s in given if s.key.section == section]
        lines += [_wide(width)] if width is not None and section == TRACK else []
    if width is not None and not any(s.key.section == TRACK for s in given):
        lines += [f"{TRACK}:", _wide(width)]
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
    one, found = study.orientations[study.wanted], study.design
    return [
        f"# Tooling that lets aspect {one.aspect} at heading {one.name.partition('@')[2]} deg leave.",
        f"# By the static rule: efficiency {'at least ' * (found.least < found.efficiency)}"
        f"{100.0 * found.least:.4g} %, purity {'at least ' * bool(found.purity_is_least)}"
        f"{100.0 * found.purity:.4g} %, by {study.answer}.",
        *_tried(study.trial_of(study.wanted)),
    ]


def _tried(trial) -> list[Any]:
    """What the trial said, the first thing to know of a design that it denies."""
    if trial is None:
        return ["# By the static rule, not tried: see feeder trial."]
    if trial.faults:
        return [f"# DENIED by its trial: {'; '.join(trial.faults)}."]
    return [f"# Of {trial.parts} parts tried {trial.figures}."]
