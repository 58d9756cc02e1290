"""Files of ``feeder design``: tables, the bowl file, the acceptance sheet and pictures."""

import datetime
import textwrap
from collections.abc import Iterator
from typing import Any

import numpy as np

from feederscrew import __version__, units
from feederscrew import bowl as bowls
from feederscrew.bowl import devices, reading, schema
from feederscrew.bowl.devices import DEVICES_SECTION
from feederscrew.bowl.verified import NOTHING_LEFT, Verified, body_fingerprint, fingerprint
from feederscrew.conveying.answer import answer, throw_number
from feederscrew.conveying.hop import hop
from feederscrew.designing import record
from feederscrew.designing.record import NOT_PROVED
from feederscrew.errors import FeederError
from feederscrew.geometry import vectors
from feederscrew.heavy import heavy
from feederscrew.machine.drive_sizing import LEAF_SPRING, TWO_AXIS, TWO_MAGNETS, is_two_axis
from feederscrew.output import columns, style, tables
from feederscrew.units import DEG, MM, MM_S, PER_MINUTE

shading = heavy("feederscrew.output.shading")

SAID_FIRST = {  # or elsewhere
    "drive_kind", "drive_needs", "drive_of_the_springs", "vibration_angle_deg", "phase_deg", "frequency_hz",
    "peak_to_peak_mm", "throw_number",
}  # fmt: skip
ONE_SET = "one set of leaf springs makes it"
OTHER_SET = "the leaf springs that are drawn make another one"
CAMERAS = {  # by what a sensor sees
    "outline": "camera from above",
    "side": "camera from the side",
    "height": "height sensor",
    "relief": "laser line",
}
TEXT_WIDTH = 62  # letters of a value that is printed beside its name


def document(study) -> dict[Any, Any]:
    """Return a DesignStudy as the JSON document."""
    proved = study.status != record.NOT_PROVED
    return {
        **columns.part(study.part, study.warnings),
        "status": study.status,
        "wanted": study.wanted,
        "up": list(study.request.up),
        "outcome": study.outcome,
        "drive_asked_for": study.request.drive,
        "target_per_minute": study.request.target / PER_MINUTE,
        **(_proof(study) if proved else dict.fromkeys(PROOF)),
        "static_per_minute": study.static_rate / PER_MINUTE,
        "queue_seconds": study.queue_seconds,
        "robust": {
            "draws": study.robust.draws,
            "held": study.robust.held,
            "worst": study.robust.worst,
            "tolerance_mm": study.request.tolerance / MM,
        },
        "chain": [{"device": item.kind, "value": item.text} for item in study.devices],
        "alternatives": [alternative(item) for item in study.alternatives],
        "why": study.why,
        "cause": study.cause or None,
        "nearest": nearest(study),
        "left_instead": dict(study.left_instead),
        "risks": [item.text for item in study.risks],
        "findings": [risk(item) for item in study.risks],
        "trial_parts": study.trial_parts,
        "answer": study.source,
        "seed": study.request.seed,
        "partial": study.partial,
        "proved_so_far": [] if proved else list(study.proved_so_far),
        "machine": machine_facts(study),
        "bowl": bowl(study),
        "long_ride": [] if study.long_ride is None else study.long_ride.rows(),
        "queues": [queue(item) for item in study.queues],
        "attempts": attempts(study).rows(),
    }


NEEDS = {1: (), 2: ("compressed air",), 3: ("a sensor", "a valve", "compressed air")}  # of a cost class
CLASS_WORDS = ("steel alone", "steady air", "a sensor with a valve")


def alternative(option) -> dict[Any, Any]:
    """Return an Alternative as a dict: null where nothing was counted."""
    value, low, _ = option.delivered or (None, None, None)
    return {
        "class": option.cost_class,
        "status": option.status,
        "delivered_per_minute": None if value is None else value / PER_MINUTE,
        "delivered_low": None if low is None else low / PER_MINUTE,
        "purity": option.purity,
        "yield": option.efficiency,
        "chain": list(option.chain),
        "needs": _needs(option),
        "why": option.why or None,
    }


def _needs(option) -> list[Any]:
    """What a chain needs beside steel, its cameras by what they see."""
    cameras = [CAMERAS[view] for view in option.sees]
    return [*cameras, *NEEDS[3][1:]] if cameras else list(NEEDS[option.cost_class])


def alternatives(study):
    """Return the best of each cost class, one a row."""
    rows = []
    for option in study.alternatives:
        d = alternative(option)
        rows.append(
            d | {"chain": ", ".join(d["chain"]) or "none", "needs": ", ".join(d["needs"]) or "nothing more"}
        )
    names = (
        "class", "status", "delivered_per_minute", "delivered_low", "purity", "yield", "chain", "needs",
        "why",
    )  # fmt: skip
    return tables.frame({name: [row[name] for row in rows] for name in names})


def alternative_text(option) -> str:
    """Return an Alternative as one sentence."""
    figures = ""
    if option.delivered is not None and option.purity is not None:
        figures = (
            f", {option.delivered[0] / PER_MINUTE:.3g}/min, purity {100.0 * option.purity:.3g} %, "
            f"yield {100.0 * option.efficiency:.3g} %"
        )
    chain = "; ".join(option.chain_words or option.chain)
    needs = f"needs {units.listed(_needs(option))}" if chain and _needs(option) else ""
    more = [text for text in (chain, needs, option.why) if text]
    return f"{option.status}{figures}" + "".join(f"; {text}" for text in more)


PROOF = (  # what a design has shown: none of it of one that is not proved
    "delivered_per_minute", "delivered_low", "delivered_high", "worst_friction_per_minute", "purity",
    "purity_low", "jams", "jams_per_hour_high",
)  # fmt: skip


def _proof(study) -> dict[Any, Any]:
    """The figures of a design that its queues have shown, by the names of ``PROOF``."""
    purity, purity_low = study.purity
    high = study.jams_per_hour_high
    rates = (end / PER_MINUTE for end in (*study.delivered, study.worst))
    values = (*rates, None if np.isnan(purity) else purity, purity_low, study.jams)
    return dict(zip(PROOF, (*values, high if np.isfinite(high) else None), strict=True))


def long_ride(rows):
    """Return the rows of a long ride as a table."""
    if not rows:
        return None
    becomes = [", ".join(f"{name}: {count}" for name, count in row["becomes"].items()) or "-" for row in rows]
    percent = {
        f"{name} [%]": [round(100.0 * row[f"share_{name}"], 1) for row in rows]
        for name in ("entering", "arriving")
    }
    counts = {name: [row[name] for row in rows] for name in ("orientation", "parts", "stays")}
    return tables.frame({**counts, "becomes": becomes, "left": [row["left"] for row in rows], **percent})


def nearest(study) -> dict[Any, Any] | None:
    """Return the nearest that holds as a dict, ``tried`` what was run for it; None of what holds."""
    near = study.nearest
    if near is None:
        return None
    return {
        "rate_per_minute": None if near.rate is None else _digits(near.rate / PER_MINUTE),
        "change": near.change or None,
        "wanted": near.wanted,
        "chain": list(near.chain),
        "frequency_hz": near.frequency,
        "peak_to_peak_mm": None if near.peak_to_peak is None else near.peak_to_peak / MM,
        "throw_number": near.throw_number,
        "tried": {
            "short_trials": near.trials,
            "proofs": near.proofs,
            "draws": near.draws,
            "draws_held": near.draws_held,
            "queue_seconds": near.queue_seconds,
            "parts_left": near.parts_left,
            "parts_right": near.parts_right,
            "denied": list(near.denied),
        },
        "helps": list(near.helps),
        "text": near.text,
    }


def _digits(value) -> float:
    """A number without the digits that dividing by a unit has left."""
    return float(f"{value:.12g}")


def bowl(study) -> dict[Any, Any] | None:
    """Return the bowl of a design as a dict; None where there is none."""
    if study.bowl is None:
        return None
    drive, track = study.bowl.drive, study.bowl.track
    two_axis, other = is_two_axis(drive), study.drive_mismatch
    return {
        "drive_kind": TWO_AXIS if two_axis else LEAF_SPRING,
        "drive_needs": TWO_MAGNETS if two_axis else None,
        "drive_of_the_springs": None if other is None else other.machine.text,
        "phase_deg": drive.phase / DEG,
        "diameter_mm": 2.0 * track.radius / MM,
        "track_width_mm": track.width / MM,
        "bank_deg": track.bank / DEG,
        "climb_deg": track.climb / DEG,
        "frequency_hz": drive.frequency,
        "peak_to_peak_mm": 2.0 * drive.amplitude / MM,
        "vibration_angle_deg": drive.vibration_angle / DEG,
        "vibration_angle_at_the_track_deg": drive.vibration_angle / DEG,
        "vibration_angle_at_the_springs_deg": (
            study.bowl.machine.spring_angle / DEG if study.machine_drawn else None
        ),
        "throw_number": float(throw_number(study.bowl)),
    }


def machine_facts(study) -> dict[Any, Any] | None:
    """Return the machine that a design asks for as a dict; None where there is no bowl."""
    if study.bowl is None:
        return None
    drive, two_axis = study.bowl.drive, is_two_axis(study.bowl.drive)
    velocity = answer(study.bowl).velocity
    sensing, leap = [device for device in study.devices if device.senses], hop(study.bowl)
    return {
        "drive": TWO_AXIS if two_axis else LEAF_SPRING,
        "drive_needs": TWO_MAGNETS if two_axis else ONE_SET if study.drive_mismatch is None else OTHER_SET,
        "phase_deg": drive.phase / DEG,
        "frequency_hz": drive.frequency,
        "stroke_peak_to_peak_mm": 2.0 * drive.amplitude / MM,
        "vibration_angle_at_the_track_deg": drive.vibration_angle / DEG,
        "vibration_angle_at_the_springs_deg": (
            study.bowl.machine.spring_angle / DEG if study.machine_drawn else None
        ),
        "throw_number": float(throw_number(study.bowl)),
        "hop_height_mm": leap.height / MM,
        "hop_flight_mm": leap.flight / MM,
        "hop": leap.text,
        "velocity_mm_s": float(velocity) / MM_S if np.isfinite(velocity) else None,
        "cameras": len(sensing),
        "cameras_see": [device.sees for device in sensing],
        "valves": len(sensing),  # one for the pulses of each
        "air": any(hasattr(device, "jet") for device in study.devices),
    }


def machine_text(facts) -> str:
    """Return the dict of ``machine`` as one sentence."""
    travels = "" if facts["velocity_mm_s"] is None else f", {facts['velocity_mm_s']:.3g} mm/s"
    return (
        f"{_drive_kind(facts)}; {facts['frequency_hz']:.4g} Hz, {_angles(facts)}, stroke "
        f"{facts['stroke_peak_to_peak_mm']:.3g} mm peak to peak, throw number {facts['throw_number']:.3g}"
        f"{travels}{_hops(facts)}; {_served_by(facts)}"
    )


def _angles(facts) -> str:
    """The direction of the vibration at the springs, where they are drawn, and at the track."""
    at_springs, at_track = (facts[f"vibration_angle_at_the_{place}_deg"] for place in ("springs", "track"))
    drawn = (
        "" if at_springs is None or facts["drive"] == TWO_AXIS else f"{at_springs:.3g} deg at the springs, "
    )
    return f"{drawn}{at_track:.3g} deg to the track"


def _hops(facts) -> str:
    """How a part hops, in words; '' where it does not."""
    return f", parts hop {facts['hop']}" if facts["hop_height_mm"] > 0.0 else ""


def _drive_kind(facts) -> str:
    led = f", phase {facts['phase_deg']:.4g} deg" if facts["drive"] == TWO_AXIS else ""
    return f"{facts['drive']}{led}: {facts['drive_needs']}"


def _served_by(facts) -> str:
    """Cameras, valves and air, in words."""
    cameras = f" ({', '.join(CAMERAS[view] for view in facts['cameras_see'])})" if facts["cameras"] else ""
    counts = [
        units.counted(facts[name], name.removesuffix("s")) if facts[name] else f"no {name.removesuffix('s')}"
        for name in ("cameras", "valves")
    ]
    return f"{counts[0]}{cameras}, {counts[1]}, {'compressed air' if facts['air'] else 'no air'}"


def _machine(facts) -> Iterator[Any]:
    """Rows of the dict of ``machine``."""
    if facts is None:
        return
    yield "drive", _drive_kind(facts)
    yield "frequency [Hz]", f"{facts['frequency_hz']:.4g}"
    yield "stroke, peak to peak [mm]", f"{facts['stroke_peak_to_peak_mm']:.4g}"
    yield "vibration angle", _angles(facts)
    yield "throw number", f"{facts['throw_number']:.4g}"
    if facts["hop_height_mm"] > 0.0:
        yield "a part hops", facts["hop"]
    if facts["velocity_mm_s"] is not None:
        yield "velocity [mm/s]", f"{facts['velocity_mm_s']:.4g}"
    yield "cameras, valves, air", _served_by(facts)


def risk(pair_risk) -> dict[Any, Any]:
    """Return a Risk as a dict: of two parts how the second lies to the first, in the axes of the file."""
    pair: dict | None = None if pair_risk.pair is None else {}
    if pair is not None and pair_risk.pair.turn is not None:
        pair = {"turn": pair_risk.pair.turn.tolist(), "place_mm": (pair_risk.pair.place / MM).tolist()}
    elif pair is not None:
        pair = {"walls_mm": pair_risk.pair.walls / MM}
    return {"kind": pair_risk.kind, "text": pair_risk.text, "pair": pair}


def queue(filled) -> dict[Any, Any]:
    """Return a FilledQueue as a dict."""
    return {
        "fill": filled.fill,
        "free_way": filled.gaps,
        "parts": filled.parts,
        "seconds": filled.seconds,
        "delivered_per_minute": None if filled.partial else filled.rate / PER_MINUTE,
        "left": filled.left,
        "right": filled.right,
        "returned": filled.returned,
        "jams": filled.jams,
        "climbs": filled.climbs,
        "left_instead": ", ".join(f"{name}: {count} of {filled.left}" for name, count in filled.left_instead),
        "partial": filled.partial,
    }


def attempts(study):
    """Return the history of the loop: one short trial a row."""
    rows = [
        {
            "trial": place,
            "wanted": attempt.wanted,
            "chain": ", ".join(attempt.chain) or "none",
            "why": attempt.step,
            "bank_deg": attempt.bank / DEG,
            "velocity_mm_s": attempt.velocity / MM_S,
            "parts": attempt.parts,
            "efficiency": attempt.efficiency,
            "purity": attempt.purity,
            "stopped": attempt.stopped,
            "peak_to_peak_mm": attempt.peak_to_peak / MM,
            "throw_number": attempt.throw_number,
            "rate_per_minute": attempt.rate / PER_MINUTE,
            "denied": "; ".join(attempt.faults),
            "cause": attempt.cause,
        }
        for place, attempt in enumerate(study.attempts, start=1)
    ]
    names = (
        "trial", "wanted", "chain", "why", "bank_deg", "velocity_mm_s", "parts", "efficiency", "purity",
        "stopped", "peak_to_peak_mm", "throw_number", "rate_per_minute", "denied", "cause",
    )  # fmt: skip
    return tables.frame({name: [row[name] for row in rows] for name in names})


def short_attempts(study):
    """Return the history as a page has room for it: of each device its kind, and one number if it has one."""
    history = attempts(study)
    chains = [", ".join(map(_brief, attempt.chain)) or "none" for attempt in study.attempts]
    names = [name for name in history if name != "peak_to_peak_mm"]  # the throw number says as much
    return tables.frame({name: chains if name == "chain" else history[name] for name in names})


def _brief(device):
    kind, _, value = device.partition(": ")
    return kind if value.startswith(("{", "[")) else f"{kind} {value}"


def summary(study):
    """Return what is printed: the answer first, then what it stands on; long lines go on in the next row."""
    d = document(study)
    why = [("why", study.reasons or d["why"])] if d["why"] else []
    if study.nearest is not None:
        why.append(("nearest that holds", study.nearest.text.removeprefix("nearest that holds: ")))
    first, *rows = outcome(d, study.devices)
    rows = [first, *why, *rows, *dimensions(d), *(("risk", text) for text in d["risks"])]
    for option in study.alternatives:
        rows.append((f"with {CLASS_WORDS[option.cost_class - 1]}", alternative_text(option)))
    rows.append(("trials, parts", f"{len(d['attempts'])}, {d['trial_parts']}"))
    return two_columns([line for row in rows for line in folded(*row)])


def two_columns(rows):
    """Return rows of a name and a value as a frame."""
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def folded(name, value) -> list[Any]:
    """Return rows of a name and the lines of a long value."""
    lines = textwrap.wrap(value, TEXT_WIDTH, break_long_words=False, break_on_hyphens=False) or [""]
    return [(name, lines[0]), *(("", line) for line in lines[1:])]


def outcome(d, devices) -> list[Any]:
    """Return rows of the answer of a design's document, and of its devices as the trade names them."""
    head = [
        ("status", d["status"]),
        *_machine(d.get("machine")),
        *_drive(d.get("bowl") or {}),
        ("leaves as", _leaves_as(d)),
        ("asked for [1/min]", f"{d['target_per_minute']:.4g}"),
    ]
    proved = _result_rows(d) if d["status"] != record.NOT_PROVED else []
    chain = [f"{item.full_name}: {item.value_words}" for item in devices] or ["none"]
    return [*head, *proved, *((f"device {k}", item) for k, item in enumerate(chain, start=1))]


def _leaves_as(d):
    """The orientation that leaves, and which aspects count at any heading."""
    up = f", counting {', '.join(d['up'])} at any heading" if d.get("up") else ""
    return (d["wanted"] or "-") + up


def _result_rows(d) -> list[Any]:
    """Rows of what a design has shown."""
    return [
        (
            "delivered at the lowest fill [1/min]",
            f"{d['delivered_per_minute']:.4g} ({d['delivered_low']:.4g} to {d['delivered_high']:.4g})",
        ),
        ("the same at the worst friction [1/min]", f"{d['worst_friction_per_minute']:.4g}"),
        ("promised by the static rule [1/min]", f"{d['static_per_minute']:.4g}"),
        (
            "purity [%]",
            "-"
            if d["purity"] is None
            else f"{100.0 * d['purity']:.4g} (at least {100.0 * d['purity_low']:.4g})",
        ),
        ("jams", f"{d['jams']} in {d['queue_seconds']:.4g} s of queue" + _hourly(d)),
        ("draws that sort", f"{d['robust']['held']} of {d['robust']['draws']}"),
    ]


def dimensions(d) -> list[Any]:
    """Return rows of what a design's document says of the bowl and its drive."""
    bowl = {name: value for name, value in (d["bowl"] or {}).items() if name not in SAID_FIRST}
    named_values = [(" ".join(tables.heading(name)).strip(), value) for name, value in bowl.items()]
    return [(name, f"{value:.4g}") for name, value in named_values if value is not None]


def _drive(bowl) -> Iterator[Any]:
    """The drive that the drawn springs make, where it is another one."""
    if bowl.get("drive_of_the_springs"):
        yield "its drawn springs make", bowl["drive_of_the_springs"]


def _hourly(d) -> str:
    high = d["jams_per_hour_high"]
    return "" if high is None else f", at most {high:.3g} an hour"


def acceptance(study):
    """Return the acceptance sheet: what a buyer measures, the computed values beside empty cells."""
    rows = [*_sheet(study)]
    names = ("quantity", "fill", "computed", "low", "high", "unit", "measured", "sample")
    return tables.frame({name: [row[k] for row in rows] for k, name in enumerate(names)})


def _sheet(study) -> Iterator[Any]:
    for filled in study.queues:
        low, high = filled.ends
        values = (f"{end / PER_MINUTE:.4g}" for end in (filled.rate, low, high))
        yield ("good parts at the discharge", filled.fill, *values, "1/min", "", "")
        yield (
            "yield, good of what leaves",
            filled.fill,
            _share(filled.right, filled.left),
            "",
            "",
            "%",
            "",
            "",
        )
        yield (
            "jams",
            filled.fill,
            f"{filled.jams}",
            "",
            f"{3600.0 * (filled.jams + 3) / filled.seconds:.3g}",
            "1/h",
            "",
            "",
        )
    sizes = bowl(study)
    if sizes is None:
        return
    drive = study.bowl.drive
    peak = (2.0 * np.pi * drive.frequency) ** 2 * drive.amplitude
    yield ("stroke on the sticker, peak to peak", "", f"{sizes['peak_to_peak_mm']:.4g}", "", "", "mm", "", "")
    yield ("acceleration, peak", "", f"{peak:.4g}", "", "", "m/s2", "", "")
    yield ("frequency of the drive", "", f"{drive.frequency:.4g}", "", "", "Hz", "", "")
    yield ("vibration angle", "", f"{sizes['vibration_angle_deg']:.4g}", "", "", "deg", "", "")
    if sizes["vibration_angle_at_the_springs_deg"] is not None:
        at_springs = f"{sizes['vibration_angle_at_the_springs_deg']:.4g}"
        yield ("vibration angle at the springs", "", at_springs, "", "", "deg", "", "")
    if sizes["phase_deg"]:
        yield ("phase of the drive", "", f"{sizes['phase_deg']:.4g}", "", "", "deg", "", "")
    yield ("drive setting", "", f"{100.0 * study.bowl.sizing.controller:.4g}", "", "", "%", "", "")
    yield (
        "reserve of the drive",
        "",
        f"{100.0 * (1.0 / study.bowl.sizing.controller - 1.0):.3g}",
        "",
        "",
        "%",
        "",
        "",
    )
    friction = np.degrees(np.arctan(study.bowl.friction.static))
    yield ("angle at which a part slides down a tilted strip", "", f"{friction:.3g}", "", "", "deg", "", "")


def _share(part, whole) -> str:
    return f"{100.0 * part / whole:.4g}" if whole else ""


DRIVE = (
    ("amplitude", "mm", "length"), ("frequency", "Hz", "frequency"), ("vibration_angle", "deg", "angle"),
    ("phase", "deg", "angle"),
)  # fmt: skip
TRACK = (
    ("climb", "deg", "angle"),
    ("bank", "deg", "angle"),
    ("radius", "mm", "length"),
    ("width", "mm", "length"),
)
MACHINE = (
    ("bowl_mass", "kg", "mass"), ("bowl_inertia", "kg m2", "inertia"), ("base_mass", "kg", "mass"),
    ("base_inertia", "kg m2", "inertia"), ("spring_radius", "mm", "length"), ("spring_angle", "deg", "angle"),
    ("leaf_width", "mm", "length"), ("leaf_thickness", "mm", "length"), ("leaf_length", "mm", "length"),
    ("leaves", "", "count"),
)  # fmt: skip
SIZING = (("fill_density", "g/cm3", "density"), ("outlet_height", "mm", "length"))
OWN = {"drive": DRIVE, "track": TRACK, "machine": MACHINE, "sizing": SIZING}


def bowl_file(study, settings, sheet=None) -> str:
    """Return the design as a bowl file.

    Parameters
    ----------
    study : DesignStudy
        With a bowl.
    settings : sequence of Setting
        As given: what the design does not set is kept.
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
    own = {"drive": study.bowl.drive, "track": study.bowl.track}
    own |= {} if sheet is None else {"machine": sheet.bowl.machine, "sizing": sheet.bowl.sizing}
    set_here = {f"{section}.{row[0]}" for section in own for row in OWN[section]} | {"drive.peak_to_peak"}
    set_here |= {f"machine.{word}" for word in schema.UNBALANCE_NAMES if "machine" in own}
    own_settings = [
        s for s in settings if s.is_own and s.key.field != DEVICES_SECTION and s.key.name not in set_here
    ]
    lines = [f"# {study.status}: {study.wanted} of {study.part.name}, from feeder design."]
    if study.drive_mismatch is not None:
        lines += [f"# Its drive: {study.drive_mismatch.text}."]
    lines += [f"{s.key.word}: {s.text}" for s in own_settings if not s.key.section]
    for section in dict.fromkeys((*own, *(s.key.section for s in own_settings if s.key.section))):
        lines += [f"{section}:"]
        lines += [f"  {s.key.word}: {s.text}" for s in own_settings if s.key.section == section]
        if section in own:
            lines += [f"  {word}: {_text(own[section], word, *unit)}" for word, *unit in OWN[section]]
        if section == "machine" and section in own:
            lines += [f"  {word}: {text}" for word, text in _unbalance(own[section])]
    if study.bowl.devices:
        lines += [f"{DEVICES_SECTION}:  # along the track, in the order parts meet them"]
        lines += [f"  - {item.kind}: {devices.value_text(item)}" for item in study.bowl.devices]
    bowl = _read_back(lines, study, own)
    if study.status == NOT_PROVED:
        lines += ["# Nothing is verified: it was stopped before all was tried."]
    elif any(item.left for item in study.queues):
        lines += ["verified:  # void as soon as part, bowl or version is another"]
        lines += [f"  {word}: {value}" for word, value in _verified(study, bowl)]
    else:
        lines += ["# Nothing is verified: no part has left a queue."]
    return "\n".join(lines) + "\n"


def _read_back(lines, study, own):
    """The Bowl that commands read from these lines, which is the one that was tried in every value."""
    name, bowl = "design.yaml", study.bowl
    devices.check_written(bowl.devices, name)
    bowl_read = bowls.record(reading.settings_of_text("\n".join(lines) + "\n", name))
    wrong = [
        f"{section}: {text}"
        for section, record in {"friction": bowl.friction, **own}.items()
        for text in devices.differences(record, getattr(bowl_read, section))
    ]
    wrong += devices.differences(
        bowl, bowl_read, ("drive", "friction", "track", "machine", "sizing", "devices")
    )
    if wrong:
        mend = "this is a fault of feeder: report it with the command you gave"
        raise FeederError(name, f"is not the bowl that was tried: {'; '.join(wrong)}", mend)
    return bowl_read


def _unbalance(machine) -> Iterator[Any]:
    for word, value in schema.unbalance_values(machine).items():
        length = word in schema.CENTRE
        yield word, f"{value / MM:.9g} mm" if length else f"{value:.9g} kg m2"


def _text(record, word, unit, dimension) -> str:
    scale = units.factor(unit, dimension) if unit else 1.0
    return f"{getattr(record, word) / scale:.9g} {unit}".strip()


def trial_of(study) -> Verified | None:
    """Return what a design has shown, as its bowl file says it; None where nothing has left a queue.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Verified or None
    """
    if study.bowl is None or study.status == NOT_PROVED or not any(filled.left for filled in study.queues):
        return None
    value, low, high = study.delivered
    purity = study.purity[0]
    return Verified(
        study.status, study.wanted, study.request.target, value, low, high, purity, study.jams,
        study.queue_seconds, study.robust.draws, study.robust.held, __version__, study.part.sha256[:16],
        fingerprint(study.bowl), ", ".join(study.request.up), body_fingerprint(study.part), study.outcome,
    )  # fmt: skip


def _verified(study, bowl) -> Iterator[Any]:
    value, low, high = (f"{rate / PER_MINUTE:.4g}/min" for rate in study.delivered)
    yield "status", study.status
    yield "wanted", study.wanted
    if study.request.up:
        yield "up", f'"{", ".join(study.request.up)}"'
    yield "outcome", study.outcome
    yield "target", f"{study.request.target / PER_MINUTE:.6g}/min"
    yield "delivered", value
    yield "delivered_low", low
    yield "delivered_high", high
    purity = study.purity[0]
    yield "purity", f"{purity:.4g}" if purity == purity else NOTHING_LEFT
    yield "jams", study.jams
    yield "queue_seconds", f"{study.queue_seconds:.6g} s"
    if study.trial_parts:
        yield "trial_parts", study.trial_parts
    yield "draws", study.robust.draws
    yield "draws_held", study.robust.held
    yield "seed", study.request.seed
    yield "version", f'"{__version__}"'
    yield "tried", f'"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}"'
    yield "part", f'"{study.part.sha256[:16]}"'
    yield "body", f'"{body_fingerprint(study.part)}"'
    yield "bowl", f'"{fingerprint(bowl)}"'


WORDS = {True: "agrees", False: "does not", None: "not measured"}


def accepted_summary(lines):
    """Return one row a line of the sheet."""
    rows = [
        {
            "quantity": line.quantity,
            "fill": line.fill,
            "computed": f"{line.computed:.4g}",
            "from": f"{line.ends[0]:.4g}",
            "to": f"{line.ends[1]:.4g}",
            "measured": "" if line.measured is None else f"{line.measured:.4g}",
            "unit": line.unit,
            "verdict": WORDS[line.agrees],
        }
        for line in lines
    ]
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})


def accepted_document(lines) -> dict[Any, Any]:
    """Return the sheet as the JSON document."""
    listed = [line.agrees for line in lines if line.agrees is not None]
    return {
        "accepted": all(listed),
        "measured": len(listed),
        "lines": [
            {
                "quantity": line.quantity,
                "fill": line.fill,
                "unit": line.unit,
                "computed": line.computed,
                "low": line.ends[0],
                "high": line.ends[1] if line.ends[1] < float("inf") else None,
                "measured": line.measured,
                "sample": line.sample,
                "agrees": line.agrees,
            }
            for line in lines
        ],
    }


FEWEST = 8  # trials there is room for: a single one is a bar, not a block
CLEAN, DENIED = "#009e73", style.ACCENT


def history_figure(study):
    """Return the figure of every short trial: the rate it would deliver, and what it lost.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Figure
    """
    figure = style.figure(7.0, 3.0)
    axes = figure.add_subplot()
    places = np.arange(1, len(study.attempts) + 1)
    rates = [attempt.rate / PER_MINUTE for attempt in study.attempts]
    clean = [attempt.clean for attempt in study.attempts]
    colours = [CLEAN if good else DENIED for good in clean]
    style.tidy(axes, x="trial", y="parts per minute", grid="y")
    bars = axes.bar(
        places, rates, color=colours, edgecolor="white", hatch=["" if good else "//" for good in clean]
    )
    target = study.request.target / PER_MINUTE
    line = axes.axhline(target, color=style.INK, linewidth=1.2, linestyle="--", label="asked for")
    for place, rate, attempt in zip(places, rates, study.attempts):
        axes.text(
            place, rate, attempt.wanted, ha="center", va="bottom", fontsize=7 if len(rates) < 12 else 5.5
        )
    axes.set_xticks(places)
    axes.set_xlim(0.4, max(len(places), FEWEST) + 0.6)
    axes.set_ylim(0.0, 1.12 * max([target, *rates]))
    named = {True: "only what is wanted leaves, and nothing stays", False: "denied"}
    handles = [bars[clean.index(good)] for good in named if good in clean]
    labels = [named[good] for good in named if good in clean]
    axes.legend(
        [line, *handles], ["asked for", *labels], frameon=False, fontsize=8, labelcolor=style.INK,
        loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3,
    )  # fmt: skip
    return figure


RISK_PICTURE_PX, HEIGHT, CAPTION, EDGE = 460, 300, 34, 12  # pixels
ROOM = 1.15  # times what is drawn reaches
THIN, OVER = 0.05, 0.3  # of a part's size: how thick walls are drawn; how far they go on
VIEWS = {"shingles": (-0.25, -1.0, 0.25), "wedges": (-0.45, -0.35, 1.0)}  # from where, along, across and up
VIEW = -0.6, -0.7, 0.5
BOX = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
     (0, 6, 4), (1, 5, 7), (1, 7, 3)]
)  # fmt: skip


def risk_picture(part, risk):
    """Draw the pair of a risk.

    Parameters
    ----------
    part : Part
        From a mesh.
    risk : Risk
        With a pair.

    Returns
    -------
    Figure
    """
    first, second = bodies(part, risk.pair)
    everything = np.vstack([first[0], second[0]])
    centre = 0.5 * (everything.min(axis=0) + everything.max(axis=0))
    camera = camera_from(np.array(VIEWS.get(risk.kind, VIEW)))
    reach = np.abs(camera.project(everything - centre)).max(axis=0)
    half = ROOM * max(reach[0], reach[1] * RISK_PICTURE_PX / HEIGHT)
    image, _, _ = shading.pair_picture(second, first, centre, camera, half, RISK_PICTURE_PX, HEIGHT)
    figure = style.page(RISK_PICTURE_PX + 2 * EDGE, HEIGHT + CAPTION + 2 * EDGE)
    high, wide = HEIGHT + CAPTION + 2.0 * EDGE, RISK_PICTURE_PX + 2.0 * EDGE
    axes = figure.add_axes(
        (EDGE / wide, EDGE / high, RISK_PICTURE_PX / wide, HEIGHT / high), xticks=[], yticks=[]
    )
    axes.spines[:].set_color(style.FAINT)
    axes.imshow(image, interpolation="nearest")
    place = EDGE / wide, 1.0 - (EDGE + 16.0) / high
    figure.text(*place, f"{risk.kind}: {part.name}", fontsize=9, fontweight="bold", color=style.INK)
    return figure


def bodies(part, pair) -> tuple[Any, ...]:
    """Return the part and what it may be caught by, each as ((V, 3) float [m], (F, 3) int), in its axes."""
    points = part.vertices - part.centre_of_mass
    first = vectors.product(points, pair.axes.T)
    if pair.turn is not None:
        moved = vectors.product(points, pair.turn.T) + pair.place
        return (first, part.faces), (vectors.product(moved, pair.axes.T), part.faces)
    least, most = first.min(axis=0), first.max(axis=0)
    size = (most - least).max()
    middle, low = 0.5 * (least + most), least - OVER * size
    long = np.array([most[0] - least[0] + 2.0 * OVER * size, THIN * size, 0.6 * (most[2] - least[2])])
    walls = []
    for y in (middle[1] - 0.5 * pair.walls - THIN * size, middle[1] + 0.5 * pair.walls):
        walls.append(BOX * long + np.array([low[0], y, least[2]]))
    return (first, part.faces), (np.vstack(walls), np.vstack([SIDES, SIDES + len(BOX)]))


def camera_from(place):
    """Return the view from a place (3,) [1] of which the third number is up."""
    towards_viewer = vectors.unit(place)
    right = vectors.unit(np.cross((0.0, 0.0, 1.0), towards_viewer))
    return shading.Camera(right=right, up=np.cross(towards_viewer, right), back=towards_viewer)
