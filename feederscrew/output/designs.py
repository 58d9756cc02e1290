"""Files of ``feeder design``: tables, the bowl file, the acceptance sheet and pictures."""

import datetime
import textwrap
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np

from feederscrew import __version__
from feederscrew import bowl as bowls
from feederscrew.base import units
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.columns import ColumnHead, Document, Frame, heads, of_records, values
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.heavy import heavy
from feederscrew.base.units import DEG, MM, MM_S, PER_MINUTE
from feederscrew.bowl import device_list as devices
from feederscrew.bowl import reading, schema
from feederscrew.bowl.device_list import DEVICES_SECTION
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.reading import Setting
from feederscrew.bowl.record import (
    DRIVE_PHASE_COLUMNS,
    TRACK_SIZE_COLUMNS,
    Bowl,
    Drive,
    Machine,
    Sizing,
    Track,
)
from feederscrew.bowl.verified import NOTHING_LEFT, Status, Verified, body_fingerprint, fingerprint
from feederscrew.designing import acceptance_sheet, texts, verdict_texts
from feederscrew.designing.acceptance_sheet import SheetLine
from feederscrew.designing.fill_verdicts import DIFFERENCE_COLUMNS
from feederscrew.designing.findings import HOOKING_COLUMNS, SELDOM_COLUMNS
from feederscrew.designing.record import (
    ALTERNATIVE_COLUMNS,
    ATTEMPT_COLUMNS,
    DESIGN_PROOF_COLUMNS,
    DESIGN_RUN_COLUMNS,
    DESIGN_STATUS_COLUMNS,
    NEAREST_COLUMNS,
    NEAREST_TRIED_COLUMNS,
    QUICK_COLUMNS,
    Alternative,
    DesignStudy,
    Pair,
    Risk,
)
from feederscrew.machine.drive_sizing import LEAF_SPRING, TWO_AXIS, TWO_MAGNETS, is_two_axis
from feederscrew.machine.sheet import MachineSheet
from feederscrew.motion.conveying import answer, throw_number
from feederscrew.motion.hop import HOP_COLUMNS, hop
from feederscrew.output import next_tries, part_facts, style, tables
from feederscrew.output.tooling import comment, settings_lines
from feederscrew.output.trial.tables import filled_entry
from feederscrew.part.record import Part
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.sorting.tooled_track import TooledTrack, lay_out
from feederscrew.trials.long_ride import LONG_RIDE_COLUMNS, RiddenOrientation

shading = heavy("feederscrew.output.shading")
tooling_drawing = heavy("feederscrew.output.tooling_drawing")

SAID_FIRST = {  # or elsewhere
    "drive_kind",
    "drive_needs",
    "drive_of_the_springs",
    "vibration_angle_deg",
    "phase_deg",
    "frequency_hz",
    "peak_to_peak_mm",
    "throw_number",
}
CAMERAS = {  # by what a sensor sees: one, and several
    "outline": ("camera from above", "cameras from above"),
    "side": ("camera from the side", "cameras from the side"),
    "height": ("height sensor", "height sensors"),
    "relief": ("laser line", "laser lines"),
}
PROOF = (  # what a design has shown: none of it of one that is not proved
    "delivered_per_minute",
    "delivered_low",
    "delivered_high",
    "worst_friction_per_minute",
    "purity",
    "purity_low",
    "jams",
    "jams_per_hour_high",
)
BOWL_UNITS = {  # of the entry ``bowl`` of the document
    "phase_deg": "deg",
    "diameter_mm": "mm",
    "track_width_mm": "mm",
    "bank_deg": "deg",
    "climb_deg": "deg",
    "frequency_hz": "Hz",
    "peak_to_peak_mm": "mm",
    "vibration_angle_deg": "deg",
    "vibration_angle_at_the_track_deg": "deg",
    "vibration_angle_at_the_springs_deg": "deg",
}
LOWER_BOUND, UPPER_BOUND = (f"{side} bound (95 %, one-sided)" for side in ("lower", "upper"))
NEEDS = {1: (), 2: ("compressed air",), 3: ("a sensor", "a valve", "compressed air")}  # of a cost class


def document(study: DesignStudy) -> Document:
    """Return a design as the JSON document, ``design.json``.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    dict
        Units stand in the names of its keys, 'delivered_per_minute'. What was not proved is None.
    """
    is_proved, proof = study.status != Status.NOT_PROVED, dict.fromkeys(PROOF)
    ridden = () if study.proof.long_ride is None else study.proof.long_ride.rows()
    if is_proved:  # the figures that its queues have shown
        (purity, purity_low), high = study.proof.purity, study.proof.jams_per_hour_high
        ends = (*study.proof.delivered, study.proof.delivered_at_worst_friction)
        rates = (end / PER_MINUTE for end in ends)
        figures = (*rates, None if np.isnan(purity) else purity, purity_low, study.proof.jams)
        proof = dict(zip(PROOF, (*figures, high if np.isfinite(high) else None), strict=True))
    facts = machine_facts(study)
    findings = []  # of two parts how the second lies to the first, in the axes of the file
    for risk in study.risks:
        pair: Document | None = None
        if risk.pair is not None and risk.pair.turn is not None and risk.pair.place is not None:
            pair = {"turn": risk.pair.turn.tolist(), "place_mm": (risk.pair.place / MM).tolist()}
        elif risk.pair is not None:
            pair = {"walls_mm": risk.pair.walls / MM}
        seldom = None if risk.seldom is None else values(SELDOM_COLUMNS, risk.seldom)
        findings.append({"kind": risk.kind, "text": risk.text, "pair": pair, "seldom": seldom})
    bowl = None
    if study.bowl is not None and facts is not None:
        track, other = study.bowl.track, study.drive_mismatch
        bowl = {
            "drive_kind": facts["drive"],
            "drive_needs": TWO_MAGNETS if facts["drive"] == TWO_AXIS else None,
            "drive_of_the_springs": None if other is None else other.machine.text,
            "phase_deg": facts["phase_deg"],
            "diameter_mm": 2.0 * track.radius / MM,
            **values(TRACK_SIZE_COLUMNS, track),
            "frequency_hz": facts["frequency_hz"],
            "peak_to_peak_mm": facts["stroke_peak_to_peak_mm"],
            "vibration_angle_deg": facts["vibration_angle_at_the_track_deg"],
            **{name: facts[name] for name in facts if name.startswith("vibration_angle_at")},
            "throw_number": facts["throw_number"],
        }
    return {
        **part_facts.part(study.part, study.warnings),
        **values(DESIGN_STATUS_COLUMNS, study),
        **proof,
        **values(DESIGN_PROOF_COLUMNS, study),
        "alternatives": [_alternative(item) for item in study.alternatives],
        "why": study.why,
        "condition": _condition(study),
        "cause": study.cause or None,
        "nearest": nearest(study),
        "next": next_tries.entries(study),
        "quick": _quick(study),
        "left_instead": texts.leaving_texts(study.proof.left_instead),
        "differences": [
            {**values(DIFFERENCE_COLUMNS, item), "text": texts.difference_text(item)}
            for item in study.differences
        ],
        "risks": [item.text for item in study.risks],
        "findings": findings,
        **values(DESIGN_RUN_COLUMNS, study),
        "proved_so_far": [] if is_proved else list(verdict_texts.proved_so_far(study)),
        "machine": facts,
        "bowl": bowl,
        "long_ride": [values(LONG_RIDE_COLUMNS, row) for row in ridden],
        "worst_fill": None
        if study.proof.worst_fill is None or not is_proved
        else study.proof.worst_fill.fill,
        "queues": [filled_entry(filled) for filled in study.proof.queues],
        "attempts": attempts(study).rows(),
    }


def _quick(study: DesignStudy) -> Document | None:
    """Return what a quick look says of the rate as a dict; None of a design that was to be proved."""
    if study.quick is None:
        return None
    return values(QUICK_COLUMNS, study.quick)


def _quick_rows(quick: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return rows of what a quick look says of the rate."""
    came = f"{quick['wanted']}, {100.0 * quick['share']:.3g} % of the parts, at the fastest drive"
    rows = [("at most [1/min]", f"{quick['at_most_per_minute']:.3g} ({came})")]
    if quick["short_trial_per_minute"] is not None:
        word = "clean" if quick["clean"] else "not clean"
        rows.append(("its short trial [1/min]", f"{quick['short_trial_per_minute']:.3g}, {word}"))
    return rows


def _condition(study: DesignStudy) -> Document | None:
    """Return the condition under which a design holds as a dict; None of one that holds without."""
    if not study.condition or study.verdict.hooking is None:
        return None
    return {
        **values(HOOKING_COLUMNS, study.verdict.hooking),
        "separate_by": list(texts.SEPARATORS),
        "change_the_part": texts.change_text(study.verdict.hooking),
        "text": study.condition,
    }


def _alternative(option: Alternative) -> Document:
    needs = [*NEEDS[option.cost_class]]  # beside steel
    if option.sees:
        needs = [_cameras(option.sees), units.counted(len(option.sees), "valve"), *NEEDS[3][2:]]
    return {
        **values(ALTERNATIVE_COLUMNS, option),
        "needs": needs,
        "why": option.why or None,
    }


def _cameras(views: Sequence[str]) -> str:
    """Cameras and sensors by what they see, each kind with its number: '2 cameras from above'."""
    return ", ".join(units.counted(number, *CAMERAS[view]) for view, number in Counter(views).items())


def alternatives(study: DesignStudy) -> Frame:
    """Return the best of each cost class, one a row.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Frame
    """
    rows = []
    for d in map(_alternative, study.alternatives):
        chain, needs = ", ".join(d["chain"]) or "none", ", ".join(d["needs"]) or "nothing more"
        rows.append(d | {"chain": chain, "needs": needs})
    above = heads(ALTERNATIVE_COLUMNS)
    return Frame.of_rows(rows, (*above, "needs", "why")).headed(above)


def short_alternatives(study: DesignStudy) -> Frame:
    """Return the best of each cost class for a page: its devices are in words.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Frame
    """
    chains = ["; ".join(option.chain_words or option.chain) or "none" for option in study.alternatives]
    return alternatives(study).taking({"chain": chains})


def long_ride(rows: Sequence[RiddenOrientation]) -> Frame:
    """Return the rows of a long ride as a table.

    Parameters
    ----------
    rows : sequence of RiddenOrientation

    Returns
    -------
    Frame
        Shares in %.
    """
    becomes = [", ".join(f"{name}: {count}" for name, count in row.becomes.items()) or "-" for row in rows]
    return Frame.of(
        {
            "orientation": [row.orientation for row in rows],
            "parts": [row.parts for row in rows],
            "stays": [row.stays for row in rows],
            "becomes": becomes,
            "left": [row.left for row in rows],
            "entering [%]": [round(100.0 * row.share_entering, 1) for row in rows],
            "arriving [%]": [round(100.0 * row.share_arriving, 1) for row in rows],
        }
    )


def nearest(study: DesignStudy) -> Document | None:
    """Return the nearest that holds as a dict.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    dict or None
        ``tried`` says what was run for it. None where it was not looked for, as of a design that holds.
    """
    near = study.nearest
    if near is None:
        return None
    tried = values(NEAREST_TRIED_COLUMNS, near)
    return {
        # without the digits that dividing by a unit has left
        "rate_per_minute": None if near.rate is None else float(f"{near.rate / PER_MINUTE:.12g}"),
        "change": near.change or None,
        "wanted": near.wanted,
        "chain": list(near.chain),
        **values(NEAREST_COLUMNS, near),
        "settings": dict(near.settings),
        "tried": tried | {"denied": list(near.denied)},
        "helps": list(near.helps),
        "text": near.text,
    }


def machine_facts(study: DesignStudy) -> Document | None:
    """Return the machine that a design asks for as a dict.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    dict or None
        Its drive, stroke, throw number, cameras, valves and air, with units in the names of the keys. None
        where there is no bowl.
    """
    if study.bowl is None:
        return None
    drive, two_axis = study.bowl.drive, is_two_axis(study.bowl.drive)
    velocity, leap = answer(study.bowl).velocity, hop(study.bowl)
    sensing = [device for device in list[Any](study.devices) if device.action is Action.SENSE]
    one_set = "one set of leaf springs makes it"
    needs = one_set if study.drive_mismatch is None else "the leaf springs that are drawn make another one"
    return {
        "drive": TWO_AXIS if two_axis else LEAF_SPRING,
        "drive_needs": TWO_MAGNETS if two_axis else needs,
        **values(DRIVE_PHASE_COLUMNS, drive),
        "stroke_peak_to_peak_mm": 2.0 * drive.amplitude / MM,
        "vibration_angle_at_the_track_deg": drive.vibration_angle / DEG,
        "vibration_angle_at_the_springs_deg": (
            study.bowl.machine.spring_angle / DEG if study.machine_drawn else None
        ),
        "throw_number": float(throw_number(study.bowl)),
        **values(HOP_COLUMNS, leap),
        "velocity_mm_s": float(velocity) / MM_S if np.isfinite(velocity) else None,
        "cameras": len(sensing),
        "cameras_see": [device.sees for device in sensing],
        "valves": len(sensing),  # one for the pulses of each
        "air": any(device.takes_air for device in study.devices),
    }


def machine_text(facts: Mapping[str, Any]) -> str:
    """Return the machine as one sentence.

    Parameters
    ----------
    facts : mapping
        Of ``machine_facts``.

    Returns
    -------
    str
    """
    kind, angles, served_by = _machine_words(facts)
    travels = "" if facts["velocity_mm_s"] is None else f", {facts['velocity_mm_s']:.3g} mm/s"
    hops = f", parts hop {facts['hop']}" if facts["hop_height_mm"] > 0.0 else ""
    return (
        f"{kind}; {facts['frequency_hz']:.4g} Hz, {angles}, stroke "
        f"{facts['stroke_peak_to_peak_mm']:.3g} mm peak to peak, throw number {facts['throw_number']:.3g}"
        f"{travels}{hops}; {served_by}"
    )


def _machine_words(facts: Mapping[str, Any]) -> tuple[str, str, str]:
    """Kind of drive; direction of the vibration at drawn springs and at the track; what serves it."""
    two_axis = facts["drive"] == TWO_AXIS
    led = f", phase {facts['phase_deg']:.4g} deg" if two_axis else ""
    at_springs, at_track = (facts[f"vibration_angle_at_the_{place}_deg"] for place in ("springs", "track"))
    drawn = "" if at_springs is None or two_axis else f"{at_springs:.3g} deg at the springs, "
    cameras = _cameras(facts["cameras_see"]) or "no camera"
    valves = units.counted(facts["valves"], "valve") if facts["valves"] else "no valve"
    return (
        f"{facts['drive']}{led}: {facts['drive_needs']}",
        f"{drawn}{at_track:.3g} deg to the track",
        f"{cameras}, {valves}, {'compressed air' if facts['air'] else 'no air'}",
    )


def attempts(study: DesignStudy) -> Frame:
    """Return the history of the loop: one short trial a row."""
    return of_records(ATTEMPT_COLUMNS, enumerate(study.attempts, start=1))


def short_attempts(study: DesignStudy) -> Frame:
    """Return the history as a page has room for it: of each device its kind, and one number if it has one.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Frame
    """
    chains = [", ".join(attempt.chain_brief) or "none" for attempt in study.attempts]
    history = attempts(study).without(["peak_to_peak_mm"])  # the throw number says as much
    named = {"why": "what is new", "denied": "what goes wrong", "velocity_mm_s": "velocity in the trial"}
    return history.taking({"chain": chains}).with_headings(named)


def summary(study: DesignStudy) -> Frame:
    """Return what is printed: the answer first, what it stands on, then what to try where it does not hold.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Frame
        Long lines go on in the next row; a command stands in one line.
    """
    d = document(study)
    first, *rest = outcome(d, study.devices)
    lines = verdict_texts.reason_lines(study) or ([d["why"]] if d["why"] else [])
    rows = [first, *(("why" if place == 0 else "and", line) for place, line in enumerate(lines))]
    if study.nearest is not None:
        rows.append(("nearest that holds", study.nearest.sentence))
    rows += [*rest, *dimensions(d), *(("risk", text) for text in d["risks"])]
    said = {*lines}  # what was said above is not said again of a class
    for option, entry in zip(study.alternatives, d["alternatives"]):
        words = [str(option.status)]
        if option.delivered and option.purity is not None and option.efficiency is not None:
            words[0] += f", {option.delivered[0] / PER_MINUTE:.3g}/min, purity {100.0 * option.purity:.3g} %"
            words[0] += f", yield {100.0 * option.efficiency:.3g} %"
        chain = "; ".join(option.chain_words or option.chain)
        needs = f"needs {units.listed(entry['needs'])}" if chain and entry["needs"] else ""
        own = [line for line in option.reasons if line not in said]
        said |= {*own}
        words += [text for text in (chain, needs, *own) if text]
        kind = ("steel alone", "steady air", "a sensor with a valve")[option.cost_class - 1]
        rows.append((f"with {kind}", "; ".join(words)))
    rows.append(("trials, parts", f"{len(study.attempts)}, {d['trial_parts']}"))
    wrapped = [line for row in rows for line in wrap_row(*row)]
    for entry in d["next"]:
        # a command stands in one line
        wrapped += [(entry["label"], entry["command"]), *wrap_row("", entry["why"])]
    return tables.quantities(wrapped)


def wrap_row(name: str, value: str) -> list[tuple[str, str]]:
    """Return rows of a name and the lines of a long value.

    Parameters
    ----------
    name, value : str

    Returns
    -------
    list of (str, str)
    """
    lines = textwrap.wrap(value, 62, break_long_words=False, break_on_hyphens=False) or [""]
    return [(name, lines[0]), *(("", line) for line in lines[1:])]


def outcome(d: Mapping[str, Any], devices: Sequence[Device]) -> list[tuple[str, str]]:
    """Return rows of the answer of a design, and of its devices as the trade names them.

    Parameters
    ----------
    d : mapping
        Of ``document``.
    devices : sequence of Device

    Returns
    -------
    list of (str, str)
    """
    rows = [("status", d["status"])]
    if facts := d.get("machine"):
        kind, angles, served_by = _machine_words(facts)
        rows += [
            ("drive", kind),
            ("frequency [Hz]", f"{facts['frequency_hz']:.4g}"),
            ("stroke, peak to peak [mm]", f"{facts['stroke_peak_to_peak_mm']:.4g}"),
            ("vibration angle", angles),
            ("throw number", f"{facts['throw_number']:.4g}"),
        ]
        rows += [("a part hops", facts["hop"])] if facts["hop_height_mm"] > 0.0 else []
        velocity = facts["velocity_mm_s"]
        rows += [] if velocity is None else [("velocity, computed [mm/s]", f"{velocity:.4g}")]
        rows.append(("cameras, valves, air", served_by))
    if drive := (d.get("bowl") or {}).get("drive_of_the_springs"):
        rows.append(("its drawn springs make", drive))
    up = f", counting {', '.join(d['up'])} at any heading" if d.get("up") else ""
    if not up and d["wanted"] and d["outcome"] == OutcomeKind.LYING and "@" not in d["wanted"]:
        up = ", at any heading"
    rows.append(("leaves as", (d["wanted"] or "-") + up))
    rows.append(("asked for [1/min]", f"{d['target_per_minute']:.4g}"))
    rows += _quick_rows(d["quick"]) if d.get("quick") else []
    if d["status"] not in (Status.NOT_PROVED, Status.NONE):  # else there are no figures of a queue
        value, low, high = (d[f"delivered_{end}"] for end in ("per_minute", "low", "high"))
        purity, purity_low, hourly = (d[name] for name in ("purity", "purity_low", "jams_per_hour_high"))
        shares = ("-" if share is None else f"{100.0 * share:.4g}" for share in (purity, purity_low))
        rows += [
            ("the worst fill", d["worst_fill"] or "-"),
            ("delivered at the worst fill [1/min]", f"{value:.4g} (95 % interval {low:.4g} to {high:.4g})"),
            ("the same at the worst friction [1/min]", f"{d['worst_friction_per_minute']:.4g}"),
            ("promised by the static rule [1/min]", f"{d['static_per_minute']:.4g}"),
            *zip(("purity of the worst fill, seen [%]", f"purity, {LOWER_BOUND} [%]"), shares, strict=True),
            ("jams that were seen", f"{d['jams']} in {d['queue_seconds']:.4g} s of queue"),
            (f"jams an hour, {UPPER_BOUND}", "-" if hourly is None else units.digits_text(hourly)),
            ("draws that sort", f"{d['robust']['held']} of {d['robust']['draws']}"),
            *(("a fill that differs", item["text"]) for item in d["differences"]),
        ]
    chain = [f"{item.full_name}: {item.value_words}" for item in devices] or ["none"]
    return [*rows, *((f"device {k}", item) for k, item in enumerate(chain, start=1))]


def dimensions(d: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return rows of what a design says of the bowl and its drive.

    Parameters
    ----------
    d : mapping
        Of ``document``.

    Returns
    -------
    list of (str, str)
        Of values that its answer does not give yet; empty where there is no bowl.
    """
    return [
        (ColumnHead.of_name(name, BOWL_UNITS.get(name, "")).title, f"{value:.4g}")
        for name, value in (d["bowl"] or {}).items()
        if name not in SAID_FIRST and value is not None
    ]


def acceptance(study: DesignStudy) -> Frame:
    """Return the acceptance sheet: demand, plan and computed values of each line beside empty cells.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Frame
        A row for each line of ``acceptance_sheet``.
    """
    request = study.request
    lines: list[SheetLine] = []
    for filled in study.proof.queues:
        lines += acceptance_sheet.lines_of_fill(filled, request.target, request.agreed_jams)
    if study.verdict.hooking is not None:  # else the feeder is judged by parts that hang together
        lines = [replace(line, plan=f"parts that arrive single: {line.plan}") for line in lines]
    if study.bowl is not None:
        facts: Any = machine_facts(study)
        drive, controller = study.bowl.drive, study.bowl.sizing.controller
        single = [
            ("stroke at the rim, peak to peak", facts["stroke_peak_to_peak_mm"], "mm"),
            ("acceleration, peak", (2.0 * np.pi * drive.frequency) ** 2 * drive.amplitude, "m/s2"),
            ("frequency of the drive", drive.frequency, "Hz"),
            ("vibration angle", facts["vibration_angle_at_the_track_deg"], "deg"),
            ("vibration angle at the springs", facts["vibration_angle_at_the_springs_deg"], "deg"),
            ("phase of the drive", facts["phase_deg"] or None, "deg"),
            ("drive setting", 100.0 * controller, "%"),
            ("reserve of the drive", 100.0 * (1.0 / controller - 1.0), "%"),
            (
                "angle at which a part slides down a tilted strip",
                np.degrees(np.arctan(study.bowl.friction.static)),
                "deg",
            ),
        ]
        for name, value, unit in single:
            if value is not None:
                line = SheetLine(name, "", unit, None, None, float(value))
                lines.append(replace(line, low=line.demand[0], high=line.demand[1]))
    strip = _tooled(study)
    chain, width = ((), 0.0) if strip is None else (strip.devices, strip.width)
    for number, placed in enumerate(chain, start=1):
        if placed.features.hangs:  # one millimetre of web stops every part
            plan = "; ".join(placed.shop_work(width))
            web = f"web left across the slot of {number} {placed.device.kind}"
            lines.append(SheetLine(web, "", "mm", None, 0.0, 0.0, plan=plan))
    cells = ([_cell(getattr(line, name)) for name in acceptance_sheet.SHEET_COLUMNS] for line in lines)
    return Frame.of_cells(acceptance_sheet.SHEET_COLUMNS, cells)


def _tooled(study: DesignStudy) -> TooledTrack | None:
    """The track of a design's bowl with its devices; None without devices."""
    if study.bowl is None or study.tooling is None or not study.bowl.devices:
        return None
    return lay_out(study.bowl.track, study.bowl.devices, study.tooling.orientations)


def _cell(value: str | float | None) -> str:
    """Return a cell of the sheet."""
    return "" if value is None else value if isinstance(value, str) else f"{value:.5g}"


SET_KEYS = {  # keys of the bowl file that a design sets, by section
    "drive": ("amplitude", "frequency", "vibration_angle", "phase"),
    "track": ("climb", "bank", "radius", "width"),
    "machine": (
        "bowl_mass",
        "bowl_inertia",
        "base_mass",
        "base_inertia",
        "spring_radius",
        "spring_angle",
        "leaf_width",
        "leaf_thickness",
        "leaf_length",
        "leaves",
    ),
    "sizing": ("fill_density", "outlet_height"),
}


def value_text(record: Drive | Track | Machine | Sizing, name: str, digits: int) -> str:
    """Return a value of a section of the bowl in the unit of its key: '0.35 mm'.

    Parameters
    ----------
    record : Drive, Track, Machine or Sizing
        The section.
    name : str
        Of the key, 'drive.amplitude'.
    digits : int
        That are significant.

    Returns
    -------
    str
    """
    key = schema.BY_NAME[name]
    scale = units.factor(key.unit, key.dimension) if key.unit else 1.0
    return f"{getattr(record, key.word) / scale:.{digits}g} {key.unit}".rstrip()


def unbalance_texts(machine: Machine) -> dict[str, str]:
    """Return what a bowl file says of where a machine has its mass.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    dict of str to str
        Values with their units, by key; empty of a balanced one.
    """
    return {
        word: f"{value / MM:.9g} mm" if word in schema.CENTRE else f"{value:.9g} kg m2"
        for word, value in schema.unbalance_values(machine).items()
    }


def bowl_file(study: DesignStudy, settings: Sequence[Setting], sheet: MachineSheet | None = None) -> str:
    """Return a design with a bowl as a bowl file.

    Parameters
    ----------
    study : DesignStudy
    settings : sequence of Setting
        Those that it does not set are kept as given.
    sheet : MachineSheet, optional
        Of the machine below the bowl.

    Returns
    -------
    str

    Raises
    ------
    FeederError
        If a command that reads it back would have another bowl than was tried.
    """
    name, bowl = "design.yaml", cast(Bowl, study.bowl)
    parts: dict[str, Drive | Track | Machine | Sizing] = {"drive": bowl.drive, "track": bowl.track}
    parts |= {} if sheet is None else {"machine": sheet.bowl.machine, "sizing": sheet.bowl.sizing}
    own_lines = {
        section: [f"  {word}: {value_text(part, f'{section}.{word}', 9)}" for word in SET_KEYS[section]]
        for section, part in parts.items()
    }
    set_here = {"drive.peak_to_peak", *(f"{name}.{word}" for name in parts for word in SET_KEYS[name])}
    if sheet is not None:  # and where the bowl has its mass, unless it is balanced
        set_here |= {f"machine.{word}" for word in schema.UNBALANCE_NAMES}
        texts = unbalance_texts(sheet.bowl.machine)
        own_lines["machine"] += [f"  {word}: {text}" for word, text in texts.items()]
    lines = [f"# {study.status}: {study.wanted} of {study.part.name}, from feeder design."]
    lines += [f"# {line}" for line in textwrap.wrap(study.condition, 100)]
    if study.drive_mismatch is not None:
        lines += [f"# Its drive: {study.drive_mismatch.text}."]
    set_here |= {s.key.name for s in settings if s.key.field == DEVICES_SECTION}
    lines += settings_lines([s for s in settings if s.is_own and s.key.name not in set_here], own_lines)
    if bowl.devices:
        lines += [f"{DEVICES_SECTION}:  # along the track, in the order parts meet them"]
        strip = _tooled(study)
        none = [""] * len(bowl.devices)
        shop = none if strip is None else tooling_drawing.shop_comments(strip, bowl.devices)
        lines += [
            f"  - {item.kind}: {devices.value_text(item)}{comment(words)}"
            for item, words in zip(bowl.devices, shop)
        ]
    # what commands read from these lines is the bowl that was tried, in every value
    devices.check_written(bowl.devices, name)
    bowl_read = bowls.record(reading.settings_of_text("\n".join(lines) + "\n", name))
    wrong = [
        f"{section}: {text}"
        for section, part in {"friction": bowl.friction, **parts}.items()
        for text in devices.differences(part, getattr(bowl_read, section))
    ]
    sections = ("drive", "friction", "track", "machine", "sizing", "devices")
    wrong += devices.differences(bowl, bowl_read, sections)
    if wrong:
        mend = "this is a fault of feeder: report it with the command you gave"
        raise FeederError(name, f"is not the bowl that was tried: {'; '.join(wrong)}", mend)
    if study.status == Status.NOT_PROVED:
        why = "a quick look runs no draw and no queue" if study.request.quick else "it was stopped"
        lines += [f"# Nothing is verified: {why}."]
    elif (tried := trial_of(study)) is None:
        lines += ["# Nothing is verified: no part has left a queue."]
    else:
        value, low, high = (f"{rate / PER_MINUTE:.4g}/min" for rate in study.proof.delivered)
        verified = {
            "status": tried.status,
            "condition": f'"{study.condition}"' if study.condition else None,
            "wanted": tried.wanted,
            "up": f'"{tried.up}"' if tried.up else None,
            "outcome": tried.outcome,
            "target": f"{tried.target / PER_MINUTE:.6g}/min",
            "fill": tried.fill or None,
            "delivered": value,
            "delivered_low": low,
            "delivered_high": high,
            "purity": NOTHING_LEFT if np.isnan(study.proof.purity[0]) else f"{study.proof.purity[0]:.4g}",
            "purity_low": f"{study.proof.purity[1]:.4g}",
            "jams": tried.jams,
            "queue_seconds": f"{tried.queue_seconds:.6g} s",
            "trial_parts": study.trial_parts or None,
            "draws": tried.draws,
            "draws_held": tried.held,
            "seed": study.request.seed,
            "version": f'"{tried.version}"',
            "tried": f'"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}"',
            "part": f'"{tried.part}"',
            "body": f'"{tried.body}"',
            "bowl": f'"{fingerprint(bowl_read)}"',
        }
        lines += ["verified:  # void as soon as part, bowl or version is another"]
        lines += [f"  {word}: {value}" for word, value in verified.items() if value is not None]
    return "\n".join(lines) + "\n"


def trial_of(study: DesignStudy) -> Verified | None:
    """Return what a design has shown, as its bowl file says it.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Verified or None
        None where nothing has left a queue, or nothing was proved.
    """
    has_left = study.status != Status.NOT_PROVED and any(filled.left for filled in study.proof.queues)
    if study.bowl is None or study.wanted is None or not has_left:
        return None
    value, low, high = study.proof.delivered
    return Verified(
        study.verdict.tooling_status,  # what was tried: a machine that cannot be made denies no trial
        study.wanted,
        study.request.target,
        value,
        low,
        high,
        study.proof.purity[0],
        study.proof.jams,
        study.proof.queue_seconds,
        study.proof.robust.draws,
        study.proof.robust.held,
        __version__,
        study.part.sha256[:16],
        fingerprint(study.bowl),
        ", ".join(study.request.up),
        body_fingerprint(study.part),
        study.outcome,
        "" if study.proof.worst_fill is None else study.proof.worst_fill.fill,
        study.condition,
        study.proof.purity[1],
    )


def accepted_summary(lines: Sequence[SheetLine]) -> Frame:
    """Return the sheet as it is printed: the demand, what was measured, and what that says.

    Parameters
    ----------
    lines : sequence of SheetLine

    Returns
    -------
    Frame
        A row for each line.
    """
    names = ("quantity", "fill", "from", "to", "unit", "measured", "sample", "computed", "verdict", "why")
    rows = []
    for line in lines:
        verdict, why = line.judged
        ends = (end if np.isfinite(end) else None for end in line.demand)
        low, high, *others = map(_cell, (*ends, line.measured, line.sample, line.computed))
        rows.append((line.quantity, line.fill, low, high, line.unit, *others, verdict.value, why))
    return Frame.of_cells(names, rows)


def accepted_document(lines: Sequence[SheetLine]) -> Document:
    """Return the sheet as the JSON document.

    Parameters
    ----------
    lines : sequence of SheetLine

    Returns
    -------
    dict
        ``accepted`` where every demand that was measured is shown.
    """
    judged = [line.agrees for line in lines if line.agrees is not None]
    rows = []
    for line in lines:
        verdict, why = line.judged
        low, high = (float(end) if np.isfinite(end) else None for end in line.demand)
        rows.append(
            {
                "quantity": line.quantity,
                "fill": line.fill,
                "unit": line.unit,
                "computed": line.computed,
                "computed_low": line.computed_low,
                "computed_high": line.computed_high,
                "low": low,
                "high": high,
                "measured": line.measured,
                "sample": line.sample,
                "agrees": line.agrees,
                "verdict": verdict.value,
                "why": why or None,
            }
        )
    return {"accepted": all(judged), "measured": len(judged), "lines": rows}


def history_figure(study: DesignStudy, ax: "style.Axes | None" = None) -> "style.Figure":
    """Draw every short trial of a design: the rate it would deliver, and what it lost.

    Parameters
    ----------
    study : DesignStudy
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.chart(7.0, 3.0, ax=ax, x="trial", y="parts per minute", grid="y")
    places = np.arange(1, len(study.attempts) + 1)
    rates = [attempt.rate / PER_MINUTE for attempt in study.attempts]
    clean = [attempt.clean for attempt in study.attempts]
    looks = {"color": ["#009e73" if good else style.ACCENT for good in clean], "edgecolor": "white"}
    bars = axes.bar(places, rates, hatch=["" if good else "//" for good in clean], **looks)
    target = study.request.target / PER_MINUTE
    handles = [axes.axhline(target, color=style.INK, linewidth=1.2, linestyle="--", label="asked for")]
    labels, words = (
        ["asked for"],
        {
            True: "only what is wanted leaves, and nothing stays",
            False: "something else leaves, or parts stay",
        },
    )
    for good in words:
        if good in clean:
            handles.append(bars[clean.index(good)])
            labels.append(words[good])
    letters = {"ha": "center", "va": "bottom", "fontsize": 7 if len(rates) < 12 else 5.5}
    highest = max([target, *rates])
    for place, rate, attempt in zip(places, rates, study.attempts):
        # over a bar that is none there is room for a word that stands upright, and for no other
        low = rate < LOW_BAR * highest and len(rates) > 1
        axes.text(place, rate, attempt.wanted, **(letters | ({"rotation": 90} if low else {})))
    axes.set_xticks(places)
    axes.set_xlim(0.4, max(len(places), 8) + 0.6)  # a single one is a bar, not a block
    axes.set_ylim(0.0, 1.12 * highest)
    axes.legend(handles, labels, ncols=2, **(style.LEGEND | {"loc": "lower left", "bbox_to_anchor": (0, 1)}))
    return figure


LOW_BAR = 0.06  # [1] of the highest: neighbours' labels would stand on one line
# pixels
RISK_PICTURE_PX = 460
HEIGHT = 300
CAPTION = 34
EDGE = 12
THIN, OVER = 0.05, 0.3  # of a part's size: how thick walls are drawn; how far they go on
VIEWS = {"shingles": (-0.25, -1.0, 0.25), "wedges": (-0.45, -0.35, 1.0)}  # from where, along, across and up
Body = tuple[Floats, Ints]  # corners (V, 3) [m] and faces (F, 3)


def risk_picture(part: Part, risk: Risk) -> "style.Figure":
    """Draw the pair of a risk.

    Parameters
    ----------
    part : Part
        From a mesh.
    risk : Risk

    Returns
    -------
    matplotlib.figure.Figure
    """
    first, second = bodies(part, cast(Pair, risk.pair))
    everything = np.vstack([first[0], second[0]])
    centre = 0.5 * (everything.min(axis=0) + everything.max(axis=0))
    towards_viewer = vectors.unit(np.array(VIEWS.get(risk.kind, (-0.6, -0.7, 0.5))))
    right = vectors.unit(np.cross((0.0, 0.0, 1.0), towards_viewer))
    up = np.cross(towards_viewer, right)
    camera = shading.Camera(right=right, up=up, towards_viewer=towards_viewer)
    reach = np.abs(camera.project(everything - centre)).max(axis=0)
    half = 1.15 * max(reach[0], reach[1] * RISK_PICTURE_PX / HEIGHT)
    image, _, _ = shading.pair_picture(second, first, centre, camera, half, RISK_PICTURE_PX, HEIGHT)
    figure, page = style.sheet(RISK_PICTURE_PX + 2 * EDGE, HEIGHT + CAPTION + 2 * EDGE)
    axes = style.inset(figure, page, (EDGE, EDGE, RISK_PICTURE_PX, HEIGHT), xticks=[], yticks=[])
    axes.spines[:].set_color(style.FAINT)
    axes.imshow(image, interpolation="nearest")
    look = {"fontsize": 9, "fontweight": "bold", "color": style.INK}
    page.text(EDGE, HEIGHT + CAPTION + EDGE - 16, f"{risk.kind}: {part.name}", **look)
    return figure


def bodies(part: Part, pair: Pair) -> tuple[Body, Body]:
    """Return the part and what it may be caught by, in the axes of the pair.

    Parameters
    ----------
    part : Part
        From a mesh.
    pair : Pair
        Another such part as it lies to the first, or two walls.

    Returns
    -------
    two of ((V, 3) float [m], (F, 3) int)
        Corners and faces of each.
    """
    points, faces = part.corners, cast(Ints, part.faces)
    first = vectors.product(points, pair.axes.T)
    if pair.turn is not None and pair.place is not None:
        moved = vectors.product(points, pair.turn.T) + pair.place
        return (first, faces), (vectors.product(moved, pair.axes.T), faces)
    least, most = first.min(axis=0), first.max(axis=0)
    size = (most - least).max()
    middle, low = 0.5 * (least + most), least - OVER * size
    long = np.array([most[0] - least[0] + 2.0 * OVER * size, THIN * size, 0.6 * (most[2] - least[2])])
    sides = (middle[1] - 0.5 * pair.walls - THIN * size, middle[1] + 0.5 * pair.walls)
    starts = [np.array([low[0], y, least[2]]) for y in sides]
    walls = [shading.box_mesh(start, start + long) for start in starts]
    return (first, faces), shading.join_meshes(walls)
