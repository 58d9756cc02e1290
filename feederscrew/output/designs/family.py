"""Several parts in one bowl: what each delivers, and what is changed from one to the next."""

from itertools import zip_longest

from feederscrew import units
from feederscrew.output.designs import tables

DRIVE = (
    ("amplitude", units.MM, "mm"),
    ("frequency", 1.0, "Hz"),
    ("vibration_angle", units.DEG, "deg"),
    ("phase", units.DEG, "deg"),
)
TRACK = (
    ("radius", units.MM, "mm"),
    ("width", units.MM, "mm"),
    ("bank", units.DEG, "deg"),
    ("climb", units.DEG, "deg"),
)
SET, TAUGHT, SWAPPED = "set", "taught", "swapped"  # at the controller, at the sensor, by hand
NOTHING = "-"


def document(study):
    """Return a FamilyStudy as the JSON document."""
    return {
        "status": study.status,
        "shared": study.shared,
        "partial": study.partial,
        "parts": [tables.document(one) for one in study.members],
        "changeover": [
            {"what": what, "how": how, "values": dict(zip(_names(study), values))}
            for what, how, values in changes(study)
        ],
    }


def _names(study):
    return [one.part.name for one in study.members]


def changes(study):
    """Return what differs between the parts: rows of what, how it is changed, and a text for each part."""
    bowls = [one.bowl for one in study.members]
    if any(bowl is None for bowl in bowls):
        return []
    rows = [(f"track.{name}", SWAPPED, _values(bowls, "track", name, *how)) for name, *how in TRACK]
    rows += _devices(study)
    rows += [(f"drive.{name}", SET, _values(bowls, "drive", name, *how)) for name, *how in DRIVE]
    return [row for row in rows if len(set(row[2])) > 1]


def _values(bowls, section, name, unit, text):
    return tuple(f"{getattr(getattr(bowl, section), name) / unit:.6g} {text}" for bowl in bowls)


def _devices(study):
    """A row for each place of each kind: the first gap of all parts, the second, ..."""
    kinds = dict.fromkeys(one.kind for member in study.members for one in member.devices)
    for kind in kinds:
        own = [[one for one in member.devices if one.kind == kind] for member in study.members]
        for place, row in enumerate(zip_longest(*own), start=1):
            values = tuple(NOTHING if one is None else one.text for one in row)
            seen = row[0] is not None and row[0].senses and len({one and one.sees for one in row}) == 1
            yield f"{kind} {place}", TAUGHT if seen else SWAPPED, values


def changeover(study):
    """Return the list for the shop: a row for what is changed, a column for each part."""
    rows = changes(study)
    columns = {"what": [what for what, _, _ in rows], "how": [how for _, how, _ in rows]}
    columns |= {name: [values[k] for _, _, values in rows] for k, name in enumerate(_names(study))}
    return columns


def summary(study):
    """Return what is printed: a row for each part, then what is changed."""
    minute = units.PER_MINUTE
    rows = [("status", study.status), ("one bowl for all", "yes" if study.shared else "no")]
    for one in study.members:
        rate, low, _ = (value / minute for value in one.delivered)
        text = f"{one.status}, {one.wanted or NOTHING}"
        text += "" if one.partial else f", {rate:.4g} a minute (at least {low:.4g})"
        rows.append((one.part.name, text + (f": {one.why}" if one.why else "")))
        told = tables.machine(one)
        if told is not None:
            rows.append((f"machine of {one.part.name}", tables.machine_text(told)))
    for what, how, values in changes(study):
        rows.append((f"{how}: {what}", "; ".join(values)))
    return tables.two_columns([line for row in rows for line in tables.folded(*row)])
