"""The JSON Schema of a bowl file agrees with the checks: what one takes, the other takes."""

from pathlib import Path

import pytest
import yaml

from feederscrew import units
from feederscrew.bowl import documentation, settings
from feederscrew.bowl.schema import BOWL_KEYS, BOWL_SECTIONS
from feederscrew.errors import Faults, FeederError

jsonschema = pytest.importorskip("jsonschema")
ROOT = Path(__file__).parents[2]
VALIDATOR = jsonschema.Draft7Validator(documentation.json_schema())


def accepted(text):
    return not list(VALIDATOR.iter_errors(yaml.safe_load(text)))


def read(text, tmp_path):
    """Whether the checks take a bowl file."""
    (tmp_path / "bowl.yaml").write_text(text)
    try:
        settings(tmp_path / "bowl.yaml")
    except (Faults, FeederError):
        return False
    return True


def line(key, value):
    return f"{key.section}:\n  {key.word}: {value}\n" if key.section else f"{key.word}: {value}\n"


def test_it_has_every_section_key_and_device_with_its_meaning():
    made = documentation.json_schema()["properties"]
    assert {"devices", *BOWL_SECTIONS} <= set(made)
    for key in BOWL_KEYS:
        told = made[key.section]["properties"][key.word] if key.section else made[key.word]
        assert key.meaning in told["description"] and key.lowest in told["description"]
        assert told["x-highest"] == key.highest and told["x-dimension"] == key.dimension
    kinds = made["devices"]["items"]["properties"]
    assert {name: one.meaning for name, one in documentation.KINDS.items()} == {
        name: told["description"].split(". Example: ")[0] for name, told in kinds.items()
    }
    assert all("type" in told or "anyOf" in told for told in kinds.values()), "a dimension is unknown here"


@pytest.mark.parametrize("path", sorted((ROOT / "configs").glob("*.yaml")), ids=lambda path: path.name)
def test_bowl_files_that_are_right_are_accepted(path):
    assert accepted(path.read_text())


def test_every_default_and_bound_is_accepted():
    for key in BOWL_KEYS:
        for value in (key.lowest, key.highest):
            assert accepted(line(key, value)), (key.name, value)


def test_every_unit_and_spelling_that_the_checks_read_is_accepted(tmp_path):
    for dimension in {key.dimension for key in BOWL_KEYS if not key.choices}:
        key = next(key for key in BOWL_KEYS if key.dimension == dimension)
        spelt = [
            name for name, unit in units.SPELLINGS.items() if unit in units.UNITS_BY_DIMENSION[dimension]
        ]
        for unit in [*units.UNITS_BY_DIMENSION[dimension], *spelt]:
            assert accepted(line(key, f"'1.5 {unit}'")), (key.name, unit)
    for value in ("9.81 m/s²", "9.81 m/s^2", "9.81m/s2"):
        assert accepted(f"gravity: {value}\n") and read(f"gravity: {value}\n", tmp_path)


@pytest.mark.parametrize("kind", list(documentation.KINDS))
def test_every_device_is_accepted_as_its_example_has_it(kind):
    assert accepted(f"devices:\n  - {kind}: {documentation.KINDS[kind].example}\n")


WRONG = [
    "drive:\n  amplitud: 0.5 mm\n",
    "drve:\n  amplitude: 0.5 mm\n",
    "drive:\n  amplitude: 0.5\n",
    "drive:\n  amplitude: 0.5 Hz\n",
    "drive:\n  amplitude: 0.2 mm\n  peak_to_peak: 0.4 mm\n",
    "friction:\n  static: 11\n",
    "friction:\n  static: -0.1\n",
    "friction:\n  static: rough\n",
    "restitution: 1\n",
    "devices:\n  - wipe: 6 mm\n",
    "devices:\n  - wiper: 6\n",
    "devices:\n  - wiper: 6 mm\n    gap: 9 mm\n",
    "devices:\n  - slot: {from: 2 mm}\n",
    "devices:\n  - cut_out: [[0 mm, 0 mm], [9 mm, 0 mm]]\n",
    "devices:\n  - profile: {of: A, play: 0.2 mm}\n",
    "devices:\n  - yield: {A: 1.2}\n",
    "devices:\n  wiper: 6 mm\n",
]


@pytest.mark.parametrize("text", WRONG)
def test_what_the_checks_refuse_is_marked_in_an_editor(text, tmp_path):
    assert not read(text, tmp_path) and not accepted(text)
