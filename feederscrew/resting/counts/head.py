"""The head of a file of counts: what was launched how, by whom and when."""

import re
from dataclasses import dataclass, fields
from typing import Any

from feederscrew.documents import hint
from feederscrew.errors import FeederError
from feederscrew.resting.rules.recommended import LAUNCH_NAMES
from feederscrew.units import quantity_text

HEAD_LINE = re.compile(r"#\s*([A-Za-z_ -]{1,30}?)\s*:\s*(.*)")
DIGEST = re.compile(r"(?:sha256:)?([0-9a-f]{8,64})", re.IGNORECASE)
MAX_VALUE_LETTERS = 500  # letters of a value


@dataclass(frozen=True)
class Head:
    """What the lines '# key: value' of a file of counts say; empty where they are silent."""

    part: str = ""  # path of the part file, from the folder of the counts
    mesh: str = ""  # sha256 of the part file, or how it begins
    units: str = ""  # how the part file is read: as --units, --density, --centre-of-mass
    density: str = ""
    centre_of_mass: str = ""
    body: str = ""  # which of several bodies in the part file: as --body
    names: str = ""  # path of the file that names the aspects, from the folder of the counts
    config: str = ""  # path of the bowl file, from the folder of the counts
    launch: str = ""  # what was done to the part: a name of ``recommended.LAUNCH_NAMES``
    surface: str = ""  # it landed on
    series: str = ""  # files of one series are summed up in one line
    who: str = ""
    when: str = ""
    source: str = ""  # where it was published
    note: str = ""

    @property
    def reading(self) -> dict[Any, Any]:
        """What the part file is read with, as keywords of ``feederscrew.part.load``."""
        values = {name: getattr(self, name) for name in ("units", "density", "centre_of_mass", "body")}
        return {name: value for name, value in values.items() if value}


NO_HEAD = Head()
HEAD_KEYS = tuple(field.name for field in fields(Head))


def parse(lines, where) -> tuple[Any, ...]:
    """Read the head from the comment lines above a table.

    Parameters
    ----------
    lines : sequence of (int, str)
        Number and text of each line that begins with '#'. What is not '# key: value' with a key of ``Head``
        is a comment.
    where : str
        The file, for the fault lines.

    Returns
    -------
    Head
    faults : list of FeederError
        A key given twice or without a value, a launch or a digest that is none.
    """
    values: dict[str, str] = {}
    faults = []
    for number, line in lines:
        match = HEAD_LINE.match(line.strip())
        if match is None:
            continue
        key = match[1].lower().replace(" ", "_").replace("-", "_")
        if key not in HEAD_KEYS:
            continue
        fault = _fault(f"{where}:{number}", key, match[2], values)
        if fault:
            faults.append(fault)
        else:
            values[key] = _cleaned(key, match[2])
    return Head(**values), faults


def _cleaned(key, value) -> str:
    digest = DIGEST.fullmatch(value) if key == "mesh" else None
    return value if digest is None else digest[1].lower()


def _fault(where, key, value, choices) -> FeederError | None:
    """What is wrong with one line of the head, or None."""
    if key in choices:
        return FeederError(where, f"{key} is given twice", "keep one of them")
    if not value:
        return FeederError(where, f"{key} has no value", "give one, or remove the line")
    if len(value) > MAX_VALUE_LETTERS:
        return FeederError(where, f"{key} is longer than {MAX_VALUE_LETTERS} letters", "say it shorter")
    if key == "launch" and value not in LAUNCH_NAMES:
        return FeederError(
            where, f"there is no launch {quantity_text(value)}", hint(value, list(LAUNCH_NAMES))
        )
    if key == "mesh" and not DIGEST.fullmatch(value):
        what = f"mesh: {quantity_text(value)} is not a sha256"
        return FeederError(where, what, "give its hexadecimal digits, at least 8, as in run.json")
    return None
