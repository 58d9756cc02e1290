"""What the tests of commands share: where the parts lie, and how a table is read back."""

import csv
from dataclasses import fields
from pathlib import Path

from click.testing import CliRunner

from feederscrew.designing.record import DesignRequest
from feederscrew_cli.design import design as design_command
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


def asked_by(words):
    """The request that a call of feeder design asks for, as the command reads it."""
    assert words[:2] == ["feeder", "design"]
    params = design_command.make_context("design", words[2:]).params
    names = {field.name for field in fields(DesignRequest)} & {*params}
    return DesignRequest(**{name: params[name] for name in names - {"jobs"}})
