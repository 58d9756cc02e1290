"""The JSON Schema of a bowl file agrees with the checks: what one takes, the other takes."""

from pathlib import Path

import pytest
import yaml

from feederscrew.base import units
from feederscrew.base.errors import Faults, FeederError
from feederscrew.bowl import documentation, settings
from feederscrew.bowl.schema import BOWL_KEYS, BOWL_SECTIONS

jsonschema = pytest.importorskip("jsonschema")
VALIDATOR = jsonschema.Draft7Validator(documentation.json_schema())


def accepted(text):
    return not list(VALIDATOR.iter_errors(yaml.safe_load(text)))


def line(key, value):
    return f"{key.section}:\n  {key.word}: {value}\n" if key.section else f"{key.word}: {value}\n"


def test_it_has_every_section_key_and_device_with_its_meaning():
    properties = documentation.json_schema()["properties"]
    assert {"devices", *BOWL_SECTIONS} <= set(properties)
    for key in BOWL_KEYS:
        entry = properties[key.section]["properties"][key.word] if key.section else properties[key.word]
        assert key.meaning in entry["description"] and key.lowest in entry["description"]
        assert entry["x-highest"] == key.highest and entry["x-dimension"] == key.dimension
        assert accepted(line(key, key.lowest)) and accepted(line(key, key.highest)), key.name
    kinds = properties["devices"]["items"]["properties"]
    # the name of the trade, and the key of files of before
    assert {
        n: kind.trade.meaning
        for kind in documentation.KINDS.values()
        for n in (kind.kind, kind.trade.old_name)
        if n
    } == {name: entry["description"].split(". Example: ")[0] for name, entry in kinds.items()}
    assert all("type" in entry or "anyOf" in entry for entry in kinds.values()), "a dimension is unknown here"
    for name, kind in documentation.KINDS.items():
        assert accepted(f"devices:\n  - {name}: {kind.trade.example}\n"), name
    # Bowl files that are right are accepted.
    paths = list((Path(__file__).parents[2] / "configs").glob("*.yaml"))
    assert paths and all(accepted(path.read_text()) for path in paths)
    # Every unit and spelling that the checks read is accepted.
    for dimension in {key.dimension for key in BOWL_KEYS if not key.choices}:
        key = next(key for key in BOWL_KEYS if key.dimension == dimension)
        own = units.UNITS_BY_DIMENSION[dimension]
        for unit in [*own, *(name for name, unit in units.SPELLINGS.items() if unit in own)]:
            assert accepted(line(key, f"'1.5 {unit}'")), (key.name, unit)


@pytest.mark.parametrize(
    ("text", "right"),
    [
        *((f"gravity: {value}\n", True) for value in ("9.81 m/s²", "9.81 m/s^2", "9.81m/s2")),
        *((text, False) for text in (
            "drive:\n  amplitud: 0.5 mm\n", "drve:\n  amplitude: 0.5 mm\n", "drive:\n  amplitude: 0.5\n",
            "drive:\n  amplitude: 0.5 Hz\n",
            "drive:\n  amplitude: 0.2 mm\n  peak_to_peak: 0.4 mm\n",
            "friction:\n  static: 11\n", "friction:\n  static: -0.1\n", "friction:\n  static: rough\n",
            "restitution: 1\n", "devices:\n  - wipe: 6 mm\n", "devices:\n  - wiper: 6\n",
            "devices:\n  - wiper: 6 mm\n    gap: 9 mm\n", "devices:\n  - slot: {from: 2 mm}\n",
            "devices:\n  - cut_out: [[0 mm, 0 mm], [9 mm, 0 mm]]\n",
            "devices:\n  - profile: {of: A, play: 0.2 mm}\n", "devices:\n  - yield: {A: 1.2}\n",
            "devices:\n  wiper: 6 mm\n",
        )),
    ],
)  # fmt: skip
def test_what_the_checks_refuse_is_marked_in_an_editor(text, right, tmp_path):
    (tmp_path / "bowl.yaml").write_text(text)
    try:
        taken = bool(settings(tmp_path / "bowl.yaml"))
    except (Faults, FeederError):
        taken = False
    assert taken == accepted(text) == right
