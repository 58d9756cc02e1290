"""`feeder sample`: files to begin with, and the examples of the commands run with them."""

import re
import shlex

import click
import pytest
from command_lines import PARTS, names, rows

from feederscrew.bowl import read
from feederscrew.jobs.samples import catalogue
from feederscrew_cli.main import feeder

FILE = re.compile(r"[\w./-]+\.(?:stl|step|yaml|csv)")


def helped():
    """Each command and sub-command with its words: 'config init'."""
    for name, command in feeder.commands.items():
        yield name, command
        yield from ((f"{name} {word}", inner) for word, inner in getattr(command, "commands", {}).items())


def test_without_a_name_it_lists_what_it_writes_and_each_call_does(run, tmp_path):
    listed = rows(run("sample", "--format", "csv").stdout)
    assert {row["file"] for row in listed} >= {f"{path.name}" for path in PARTS.glob("*.stl")}
    for row in listed:
        done = run("sample", *row["call"].split())
        assert done.exit_code == 0 and (tmp_path / row["file"]).exists(), done.output
    assert {path for path in names(tmp_path) if path.startswith(".")} == set()


def test_a_file_of_another_content_is_kept(run, tmp_path):
    path = tmp_path / "washer_m6.stl"
    assert run("sample", "washer_m6").exit_code == 0 and path.read_bytes() == (PARTS / path.name).read_bytes()
    assert run("sample", "washer_m6").exit_code == 0  # the same: nothing to lose
    path.write_text("mine")
    refused = run("sample", "--all")
    assert refused.exit_code == 1 and refused.stderr.startswith("Error: washer_m6.stl: exists already")
    assert names(tmp_path) == {path.name} and path.read_text() == "mine"  # all of them or none
    assert run("sample", "washer_m6", "--force").exit_code == 0 and path.read_text(errors="replace") != "mine"


@pytest.mark.parametrize(
    ("words", "start"),
    [
        ("washr_m6", "Error: name: 'washr_m6' is no sample - did you mean washer_m6?"),
        (
            "hex-bolt M8x26",
            "Error: size: M8 of ISO 4017 comes 16 to 80 mm long, not 26 - write M8x25 or M8x30",
        ),
        ("washer_m6 M6", "Error: size: washer_m6 is one file, of one size - leave it out, or name one of"),
        ("washer_m6 --step", "Error: --step: there is none of washer_m6 here - leave it out"),
        ("cap 14x10 --ratio 2", "Error: --ratio: cap has none - leave it out: it is for t-shape"),
        ("washer_m6 --all", "Error: --all writes every file"),
    ],
)
def test_a_wrong_call_is_one_line(run, tmp_path, words, start):
    done = run("sample", *words.split())
    assert (done.exit_code, done.stdout) == (2, "") and done.stderr.startswith(start)
    assert done.stderr.count("\n") == 1 and names(tmp_path) == set()


def test_the_files_of_every_example_are_samples(run, tmp_path):
    """They named `parts/...`, which a wheel does not have."""
    written = set(catalogue.all_files())
    for name, command in helped():
        example = (command.help or "").partition("\n")[0].removeprefix("Example: ")
        assert example.startswith("feeder "), name
        asked = set(FILE.findall(example))
        assert asked <= written, name
    assert run("sample", "--all").exit_code == 0 and names(tmp_path) == written
    assert read(tmp_path / "tooling.yaml").devices and not read(tmp_path / "bowl.yaml").devices
    for call in ("config init bowl.yaml", "inertia hexbolt_m8x25.stl --density brass", "calibrate "
                 "lbracket_30x20x15.stl --with counts.csv"):  # fmt: skip
        done = run(*call.split())
        assert done.exit_code == 0, done.output


def test_the_words_of_every_example_are_taken():
    """As click reads them, without the work."""
    for name, command in helped():
        words = shlex.split((command.help or "").partition("\n")[0].removeprefix("Example: feeder"))
        depth = len(name.split()) if words[: len(name.split())] == name.split() else 1
        inner, chosen = words[depth:], command
        if isinstance(command, click.Group) and words[1:]:  # its example is that of one of its own
            chosen, inner = command.commands[words[1]], words[2:]
        chosen.make_context(name, list(inner), parent=click.Context(feeder))
