"""A design as a bowl file that every command reads back, with what its trial showed."""

import datetime

from feederscrew import __version__, units
from feederscrew import bowl as bowls
from feederscrew.bowl import devices, reading, schema
from feederscrew.bowl.devices import DEVICES_SECTION
from feederscrew.bowl.verified import NOTHING_LEFT, Verified, body_fingerprint, fingerprint
from feederscrew.designing.record import NOT_PROVED
from feederscrew.errors import FeederError
from feederscrew.units import MM, PER_MINUTE

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


def bowl_file(study, settings, sheet=None):
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
    given = [
        s for s in settings if s.is_own and s.key.field != DEVICES_SECTION and s.key.name not in set_here
    ]
    lines = [f"# {study.status}: {study.wanted} of {study.part.name}, from feeder design."]
    if study.drive_mismatch is not None:
        lines += [f"# Its drive: {study.drive_mismatch.text}."]
    lines += [f"{s.key.word}: {s.text}" for s in given if not s.key.section]
    for section in dict.fromkeys((*own, *(s.key.section for s in given if s.key.section))):
        lines += [f"{section}:"]
        lines += [f"  {s.key.word}: {s.text}" for s in given if s.key.section == section]
        if section in own:
            lines += [f"  {word}: {_text(own[section], word, *unit)}" for word, *unit in OWN[section]]
        if section == "machine" and section in own:
            lines += [f"  {word}: {text}" for word, text in _unbalance(own[section])]
    if study.bowl.devices:
        lines += [f"{DEVICES_SECTION}:  # along the track, in the order parts meet them"]
        lines += [f"  - {one.kind}: {devices.value_text(one)}" for one in study.bowl.devices]
    bowl = _read_back(lines, study, own)
    if study.status == NOT_PROVED:
        lines += ["# Nothing is verified: it was stopped before all was tried."]
    elif any(one.left for one in study.queues):
        lines += ["verified:  # void as soon as part, bowl or version is another"]
        lines += [f"  {word}: {value}" for word, value in _verified(study, bowl)]
    else:
        lines += ["# Nothing is verified: no part has left a queue."]
    return "\n".join(lines) + "\n"


def _read_back(lines, study, own):
    """The Bowl that commands read from these lines, which is the one that was tried in every value."""
    name, bowl = "design.yaml", study.bowl
    devices.check_written(bowl.devices, name)
    found = bowls.record(reading.settings_of_text("\n".join(lines) + "\n", name))
    wrong = [
        f"{section}: {text}"
        for section, record in {"friction": bowl.friction, **own}.items()
        for text in devices.differences(record, getattr(found, section))
    ]
    wrong += devices.differences(bowl, found, ("drive", "friction", "track", "machine", "sizing", "devices"))
    if wrong:
        mend = "this is a fault of feeder: report it with the command you gave"
        raise FeederError(name, f"is not the bowl that was tried: {'; '.join(wrong)}", mend)
    return found


def _unbalance(machine):
    for word, value in schema.unbalance_values(machine).items():
        length = word in schema.CENTRE
        yield word, f"{value / MM:.9g} mm" if length else f"{value:.9g} kg m2"


def _text(record, word, unit, dimension):
    scale = units.factor(unit, dimension) if unit else 1.0
    return f"{getattr(record, word) / scale:.9g} {unit}".strip()


def trial(study):
    """Return what a design has shown, as its bowl file says it; None where nothing has left a queue.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Verified or None
    """
    if study.bowl is None or study.status == NOT_PROVED or not any(one.left for one in study.queues):
        return None
    value, low, high = study.delivered
    purity = study.purity[0]
    return Verified(
        study.status, study.wanted, study.request.target, value, low, high, purity, study.jams,
        study.queue_seconds, study.robust.draws, study.robust.held, __version__, study.part.sha256[:16],
        fingerprint(study.bowl), ", ".join(study.request.up), body_fingerprint(study.part), study.outcome,
    )  # fmt: skip


def _verified(study, bowl):
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
