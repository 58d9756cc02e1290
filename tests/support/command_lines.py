"""What the tests of commands share: where the parts lie, and how a table is read back."""

import csv
from pathlib import Path

from click.testing import CliRunner

from feederscrew_cli.main import feeder

ROOT = Path(__file__).parents[2]
PARTS = ROOT / "parts"
BRACKET, NUT, CARD = PARTS / "lbracket_30x20x15.stl", PARTS / "squarenut_m5.stl", PARTS / "arc_chute.yaml"


def rows(table):
    """The rows of a CSV, of a text or a file, without its comments."""
    text = table.read_text() if isinstance(table, Path) else table
    return list(csv.DictReader(line for line in text.splitlines() if line[:1] != "#"))


def called(*words):
    """The result of one command line, which has to end well."""
    done = CliRunner().invoke(feeder, [str(word) for word in words])
    assert done.exit_code == 0, done.output
    return done


def names(folder):
    """The names of the files of a folder."""
    return {path.name for path in folder.iterdir()}
