"""Designs as documents and tables, in the units of the shop."""

import textwrap

import numpy as np

from feederscrew import units
from feederscrew.conveying.answer import answer, throw_number
from feederscrew.conveying.hop import hop
from feederscrew.designing import record
from feederscrew.machine.drive_sizing import LEAF_SPRING, TWO_AXIS, TWO_MAGNETS, is_two_axis
from feederscrew.output import columns, tables
from feederscrew.units import DEG, MM, MM_S, PER_MINUTE

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
WIDTH = 62  # letters of a value that is printed beside its name


def document(study):
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
        "chain": [{"device": one.kind, "value": one.text} for one in study.devices],
        "alternatives": [alternative(one) for one in study.alternatives],
        "why": study.why,
        "cause": study.cause or None,
        "nearest": nearest(study),
        "left_instead": dict(study.left_instead),
        "risks": [one.text for one in study.risks],
        "findings": [risk(one) for one in study.risks],
        "trial_parts": study.trial_parts,
        "answer": study.source,
        "seed": study.request.seed,
        "partial": study.partial,
        "proved_so_far": [] if proved else list(study.proved_so_far),
        "machine": machine(study),
        "bowl": bowl(study),
        "long_ride": [] if study.long_ride is None else study.long_ride.rows(),
        "queues": [queue(one) for one in study.queues],
        "attempts": attempts(study).rows(),
    }


NEEDS = {1: (), 2: ("compressed air",), 3: ("a sensor", "a valve", "compressed air")}  # of a cost class
CLASS_WORDS = ("steel alone", "steady air", "a sensor with a valve")


def alternative(one):
    """Return an Alternative as a dict: null where nothing was counted."""
    value, low, _ = one.delivered or (None, None, None)
    return {
        "class": one.cost_class,
        "status": one.status,
        "delivered_per_minute": None if value is None else value / PER_MINUTE,
        "delivered_low": None if low is None else low / PER_MINUTE,
        "purity": one.purity,
        "yield": one.efficiency,
        "chain": list(one.chain),
        "needs": _needs(one),
        "why": one.why or None,
    }


def _needs(one):
    """What a chain needs beside steel, its cameras by what they see."""
    cameras = [CAMERAS[view] for view in one.sees]
    return [*cameras, *NEEDS[3][1:]] if cameras else list(NEEDS[one.cost_class])


def alternatives(study):
    """Return the best of each cost class, one a row."""
    rows = []
    for one in study.alternatives:
        d = alternative(one)
        rows.append(
            d | {"chain": ", ".join(d["chain"]) or "none", "needs": ", ".join(d["needs"]) or "nothing more"}
        )
    names = (
        "class", "status", "delivered_per_minute", "delivered_low", "purity", "yield", "chain", "needs",
        "why",
    )  # fmt: skip
    return tables.frame({name: [row[name] for row in rows] for name in names})


def alternative_text(one):
    """Return an Alternative as one sentence."""
    figures = ""
    if one.delivered is not None and one.purity is not None:
        figures = (
            f", {one.delivered[0] / PER_MINUTE:.3g}/min, purity {100.0 * one.purity:.3g} %, "
            f"yield {100.0 * one.efficiency:.3g} %"
        )
    chain = "; ".join(one.chain_words or one.chain)
    needs = f"needs {units.listed(_needs(one))}" if chain and _needs(one) else ""
    more = [text for text in (chain, needs, one.why) if text]
    return f"{one.status}{figures}" + "".join(f"; {text}" for text in more)


PROOF = (  # what a design has shown: none of it of one that is not proved
    "delivered_per_minute", "delivered_low", "delivered_high", "worst_friction_per_minute", "purity",
    "purity_low", "jams", "jams_per_hour_high",
)  # fmt: skip


def _proof(study):
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
    others = [", ".join(f"{name}: {count}" for name, count in row["becomes"].items()) or "-" for row in rows]
    percent = {
        f"{name} [%]": [round(100.0 * row[f"share_{name}"], 1) for row in rows]
        for name in ("entering", "arriving")
    }
    counts = {name: [row[name] for row in rows] for name in ("orientation", "parts", "stays")}
    return tables.frame({**counts, "becomes": others, "left": [row["left"] for row in rows], **percent})


def nearest(study):
    """Return the nearest that holds as a dict, ``tried`` what was run for it; None of what holds."""
    one = study.nearest
    if one is None:
        return None
    return {
        "rate_per_minute": None if one.rate is None else _digits(one.rate / PER_MINUTE),
        "change": one.change or None,
        "wanted": one.wanted,
        "chain": list(one.chain),
        "frequency_hz": one.frequency,
        "peak_to_peak_mm": None if one.peak_to_peak is None else one.peak_to_peak / MM,
        "throw_number": one.throw_number,
        "tried": {
            "short_trials": one.trials,
            "proofs": one.proofs,
            "draws": one.draws,
            "draws_held": one.draws_held,
            "queue_seconds": one.queue_seconds,
            "parts_left": one.parts_left,
            "parts_right": one.parts_right,
            "denied": list(one.denied),
        },
        "helps": list(one.helps),
        "text": one.text,
    }


def _digits(value):
    """A number without the digits that dividing by a unit has left."""
    return float(f"{value:.12g}")


def bowl(study):
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


def machine(study):
    """Return the machine that a design asks for as a dict; None where there is no bowl."""
    if study.bowl is None:
        return None
    drive, two_axis = study.bowl.drive, is_two_axis(study.bowl.drive)
    velocity = answer(study.bowl).velocity
    seen, leap = [one for one in study.devices if one.senses], hop(study.bowl)
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
        "cameras": len(seen),
        "cameras_see": [one.sees for one in seen],
        "valves": len(seen),  # one for the pulses of each
        "air": any(hasattr(one, "jet") for one in study.devices),
    }


def machine_text(told):
    """Return the dict of ``machine`` as one sentence."""
    travels = "" if told["velocity_mm_s"] is None else f", {told['velocity_mm_s']:.3g} mm/s"
    return (
        f"{_drive_kind(told)}; {told['frequency_hz']:.4g} Hz, {_angles(told)}, stroke "
        f"{told['stroke_peak_to_peak_mm']:.3g} mm peak to peak, throw number {told['throw_number']:.3g}"
        f"{travels}{_hops(told)}; {_served_by(told)}"
    )


def _angles(told):
    """The direction of the vibration at the springs, where they are drawn, and at the track."""
    at_springs, at_track = (told[f"vibration_angle_at_the_{place}_deg"] for place in ("springs", "track"))
    drawn = (
        "" if at_springs is None or told["drive"] == TWO_AXIS else f"{at_springs:.3g} deg at the springs, "
    )
    return f"{drawn}{at_track:.3g} deg to the track"


def _hops(told):
    """How a part hops, in words; '' where it does not."""
    return f", parts hop {told['hop']}" if told["hop_height_mm"] > 0.0 else ""


def _drive_kind(told):
    led = f", phase {told['phase_deg']:.4g} deg" if told["drive"] == TWO_AXIS else ""
    return f"{told['drive']}{led}: {told['drive_needs']}"


def _served_by(told):
    """Cameras, valves and air, in words."""
    seen = f" ({', '.join(CAMERAS[one] for one in told['cameras_see'])})" if told["cameras"] else ""
    counts = [
        units.counted(told[name], name.removesuffix("s")) if told[name] else f"no {name.removesuffix('s')}"
        for name in ("cameras", "valves")
    ]
    return f"{counts[0]}{seen}, {counts[1]}, {'compressed air' if told['air'] else 'no air'}"


def _machine(told):
    """Rows of the dict of ``machine``."""
    if told is None:
        return
    yield "drive", _drive_kind(told)
    yield "frequency [Hz]", f"{told['frequency_hz']:.4g}"
    yield "stroke, peak to peak [mm]", f"{told['stroke_peak_to_peak_mm']:.4g}"
    yield "vibration angle", _angles(told)
    yield "throw number", f"{told['throw_number']:.4g}"
    if told["hop_height_mm"] > 0.0:
        yield "a part hops", told["hop"]
    if told["velocity_mm_s"] is not None:
        yield "velocity [mm/s]", f"{told['velocity_mm_s']:.4g}"
    yield "cameras, valves, air", _served_by(told)


def risk(one):
    """Return a Risk as a dict: of two parts how the second lies to the first, in the axes of the file."""
    pair: dict | None = None if one.pair is None else {}
    if pair is not None and one.pair.turn is not None:
        pair = {"turn": one.pair.turn.tolist(), "place_mm": (one.pair.place / MM).tolist()}
    elif pair is not None:
        pair = {"walls_mm": one.pair.walls / MM}
    return {"kind": one.kind, "text": one.text, "pair": pair}


def queue(one):
    """Return a FilledQueue as a dict."""
    return {
        "fill": one.fill,
        "free_way": one.gaps,
        "parts": one.parts,
        "seconds": one.seconds,
        "delivered_per_minute": None if one.partial else one.rate / PER_MINUTE,
        "left": one.left,
        "right": one.right,
        "returned": one.returned,
        "jams": one.jams,
        "climbs": one.climbs,
        "left_instead": ", ".join(f"{name}: {count} of {one.left}" for name, count in one.left_instead),
        "partial": one.partial,
    }


def attempts(study):
    """Return the history of the loop: one short trial a row."""
    rows = [
        {
            "trial": place,
            "wanted": one.wanted,
            "chain": ", ".join(one.chain) or "none",
            "why": one.step,
            "bank_deg": one.bank / DEG,
            "velocity_mm_s": one.velocity / MM_S,
            "parts": one.parts,
            "efficiency": one.efficiency,
            "purity": one.purity,
            "stopped": one.stopped,
            "peak_to_peak_mm": one.peak_to_peak / MM,
            "throw_number": one.throw_number,
            "rate_per_minute": one.rate / PER_MINUTE,
            "denied": "; ".join(one.faults),
            "cause": one.cause,
        }
        for place, one in enumerate(study.attempts, start=1)
    ]
    names = (
        "trial", "wanted", "chain", "why", "bank_deg", "velocity_mm_s", "parts", "efficiency", "purity",
        "stopped", "peak_to_peak_mm", "throw_number", "rate_per_minute", "denied", "cause",
    )  # fmt: skip
    return tables.frame({name: [row[name] for row in rows] for name in names})


def short_attempts(study):
    """Return the history as a page has room for it: of each device its kind, and one number if it has one."""
    history = attempts(study)
    chains = [", ".join(map(_brief, one.chain)) or "none" for one in study.attempts]
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
    rows = [first, *why, *rows, *dimensions(d), *(("risk", one) for one in d["risks"])]
    for one in study.alternatives:
        rows.append((f"with {CLASS_WORDS[one.cost_class - 1]}", alternative_text(one)))
    rows.append(("trials, parts", f"{len(d['attempts'])}, {d['trial_parts']}"))
    return two_columns([line for row in rows for line in folded(*row)])


def two_columns(rows):
    """Return rows of a name and a value as a frame."""
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def folded(name, value):
    """Return rows of a name and the lines of a long value."""
    lines = textwrap.wrap(value, WIDTH, break_long_words=False, break_on_hyphens=False) or [""]
    return [(name, lines[0]), *(("", line) for line in lines[1:])]


def outcome(d, devices):
    """Return rows of the answer of a design's document, and of its devices as the trade names them."""
    head = [
        ("status", d["status"]),
        *_machine(d.get("machine")),
        *_drive(d.get("bowl") or {}),
        ("leaves as", _leaves_as(d)),
        ("asked for [1/min]", f"{d['target_per_minute']:.4g}"),
    ]
    proved = _shown(d) if d["status"] != record.NOT_PROVED else []
    chain = [f"{one.full_name}: {one.value_words}" for one in devices] or ["none"]
    return [*head, *proved, *((f"device {k}", one) for k, one in enumerate(chain, start=1))]


def _leaves_as(d):
    """The orientation that leaves, and which aspects count at any heading."""
    up = f", counting {', '.join(d['up'])} at any heading" if d.get("up") else ""
    return (d["wanted"] or "-") + up


def _shown(d):
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


def dimensions(d):
    """Return rows of what a design's document says of the bowl and its drive."""
    bowl = {name: value for name, value in (d["bowl"] or {}).items() if name not in SAID_FIRST}
    named_values = [(" ".join(tables.heading(name)).strip(), value) for name, value in bowl.items()]
    return [(name, f"{value:.4g}") for name, value in named_values if value is not None]


def _drive(bowl):
    """The drive that the drawn springs make, where it is another one."""
    if bowl.get("drive_of_the_springs"):
        yield "its drawn springs make", bowl["drive_of_the_springs"]


def _hourly(d):
    high = d["jams_per_hour_high"]
    return "" if high is None else f", at most {high:.3g} an hour"


def acceptance(study):
    """Return the acceptance sheet: what a buyer measures, the computed values beside empty cells."""
    rows = [*_sheet(study)]
    names = ("quantity", "fill", "computed", "low", "high", "unit", "measured", "sample")
    return tables.frame({name: [row[k] for row in rows] for k, name in enumerate(names)})


def _sheet(study):
    for one in study.queues:
        low, high = one.ends
        values = (f"{end / PER_MINUTE:.4g}" for end in (one.rate, low, high))
        yield ("good parts at the discharge", one.fill, *values, "1/min", "", "")
        yield ("yield, good of what leaves", one.fill, _share(one.right, one.left), "", "", "%", "", "")
        yield (
            "jams",
            one.fill,
            f"{one.jams}",
            "",
            f"{3600.0 * (one.jams + 3) / one.seconds:.3g}",
            "1/h",
            "",
            "",
        )
    known = bowl(study)
    if known is None:
        return
    drive = study.bowl.drive
    peak = (2.0 * np.pi * drive.frequency) ** 2 * drive.amplitude
    yield ("stroke on the sticker, peak to peak", "", f"{known['peak_to_peak_mm']:.4g}", "", "", "mm", "", "")
    yield ("acceleration, peak", "", f"{peak:.4g}", "", "", "m/s2", "", "")
    yield ("frequency of the drive", "", f"{drive.frequency:.4g}", "", "", "Hz", "", "")
    yield ("vibration angle", "", f"{known['vibration_angle_deg']:.4g}", "", "", "deg", "", "")
    if known["vibration_angle_at_the_springs_deg"] is not None:
        at_springs = f"{known['vibration_angle_at_the_springs_deg']:.4g}"
        yield ("vibration angle at the springs", "", at_springs, "", "", "deg", "", "")
    if known["phase_deg"]:
        yield ("phase of the drive", "", f"{known['phase_deg']:.4g}", "", "", "deg", "", "")
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


def _share(part, whole):
    return f"{100.0 * part / whole:.4g}" if whole else ""
