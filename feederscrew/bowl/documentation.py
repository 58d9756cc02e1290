"""The schema for people: a commented bowl file."""

from pathlib import Path

from feederscrew.bowl.devices import DEVICES_SECTION
from feederscrew.bowl.key import Key
from feederscrew.bowl.schema import BOWL_KEYS, BY_NAME, OPTIONAL, rival
from feederscrew.bowl.settings import OF_THE_MACHINE, default
from feederscrew.errors import FeederError
from feederscrew.tooling.devices.kinds import KINDS

SCHEMA_FILE = "feeder.schema.json"  # what the JSON Schema is called beside a bowl file
EDITORS = f"# yaml-language-server: $schema={SCHEMA_FILE}"  # the line by which editors find it
WHY = """\
The defaults are a typical bowl: steel on a dry steel track that climbs 3 deg, driven at the 50 Hz of a
half-wave supply with 0.42 mm from end to end. Parts travel at 25 mm/s, the speed behind the handbook's
estimate of 1500 parts a minute over the part's length in mm; bowls run 20 to 120 mm/s. The part slides
without hopping, whether its friction is a fifth lower or half as high again, so that its forces on floor
and track can be followed; drives that throw it run faster (100 Hz, 0.15 mm and 20 deg: 56 mm/s).
Measure your own: tilt the track until the part slides, and write the tangent of that angle as static
friction; there are no tables of friction on coatings to rely on.
"""


def template() -> str:
    """Return a bowl file of all defaults, commented: what ``feeder config init`` writes."""
    lines = [
        EDITORS,
        "# A bowl feeder: its drive, its surface and its track. Write a unit after every dimensional value.",
    ]
    lines += [f"# {line}" for line in WHY.splitlines()]
    section = ""
    for key in BOWL_KEYS:
        if key.section != section:
            section = key.section
            lines += ["", *_opening(section)] if section else [""]
        lines.append(_template_line(key))
    lines += ["", f"# {DEVICES_SECTION}:  # along the track, in the order parts meet them"]
    lines += [f"#   - {kind}: {one.example}  # {one.meaning}" for kind, one in KINDS.items()]
    return "\n".join(lines) + "\n"


def write_new(path: str | Path, text: str, *, replace: bool = False) -> None:
    """Write a text to a file; FeederError if it exists, unless ``replace``, or cannot be made."""
    if Path(path).is_dir():
        raise FeederError(path, "is a folder", f"name a file in it, such as {Path(path) / 'bowl.yaml'}")
    try:
        with Path(path).open("w" if replace else "x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise FeederError(
            path, "exists already", "name another file, or pass `replace` to replace it"
        ) from None
    except OSError as error:
        raise FeederError(
            path, f"cannot be written ({error.strerror})", "name a file in a folder of yours"
        ) from None


def _opening(section: str) -> list[str]:
    """The line that opens a section; an optional one stands behind comment signs."""
    if section not in OPTIONAL:
        return [f"{section}:"]
    return ["# Take the '# ' away from these lines to describe your own drive unit.", f"# {section}:"]


def _template_line(key: Key) -> str:
    """'amplitude: 0.05 mm  # ...'; a key that follows another stands behind a comment sign."""
    indent, follows = "  " if key.section else "", key.default in BY_NAME or key.name in OF_THE_MACHINE
    behind = "# " if follows or key.section in OPTIONAL else ""
    before, after = (behind, indent) if key.section in OPTIONAL else (indent, behind)
    text = f"{before}{after}{key.word}: {default(key).text}"
    left_out = f" (left out: {_default_for_people(key)})" if follows else ""
    return f"{text:<25}  # {key.meaning}{left_out}"


def _default_for_people(key: Key) -> str:
    if key.name in OF_THE_MACHINE:
        return f"{key.default}, or from machine"
    if key.default not in BY_NAME:
        return key.default
    return f"as {key.default}" if rival(key) is None else f"from {key.default}"
