"""What the program says, in the words of the trade."""

import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from feederscrew_cli import grouped, talk
from feederscrew_cli.main import feeder

PARTS = Path(__file__).parents[3] / "parts"
NUT = PARTS / "squarenut_m5.stl"


def words(text):
    return " ".join(text.split())


def test_a_remark_is_folded_for_a_terminal_and_one_line_for_a_program():
    text = (
        "Warning: tried as well, canyon: 18.85 mm: the static rule lets 4.52 % leave, of 26 parts 4.86 % do"
    )
    lines = talk.folded(text, 40).split("\n")
    assert max(map(len, lines)) <= 40 and words(" ".join(lines)) == text
    assert all(line.startswith("  ") for line in lines[1:]) and len(lines) == 3
    assert talk.folded(text, None) == text and talk.folded(text, 200) == text


@pytest.mark.parametrize("name", list(feeder.commands))
def test_the_whole_help_of_a_command_lists_each_option_once_in_groups(run, name):
    command = feeder.commands[name]
    grouped_help = isinstance(command, grouped.Grouped)
    said = run(name, "--help-all" if grouped_help else "--help").stdout.partition("\nOptions:\n")[2]
    for option in (option for option in command.params if isinstance(option, click.Option)):
        longest = max(getattr(option, "present", option.opts), key=len)
        assert len(re.findall(rf"^  (?:-\w, )?{longest}(?=[ \n])", said, re.MULTILINE)) == 1, longest
    assert "\n  PART" not in said and "\n  [PART]" not in said, "an argument is no option"
    assert "\nOutput:\n" in said or "--format" not in said or not grouped_help


@pytest.mark.parametrize("name", list(feeder.commands))
def test_the_help_of_a_command_fits_a_screen_and_names_every_option(run, name):
    said = run(name, "--help").stdout
    assert len(said.splitlines()) <= 60
    for option in (option for option in feeder.commands[name].params if isinstance(option, click.Option)):
        longest = max(getattr(option, "present", option.opts), key=len)
        assert re.search(rf"(?<![\w-]){longest}(?![\w-])", said), longest


def test_a_former_name_of_an_option_is_taken_and_not_shown(run):
    present, former = (
        run("aspects", NUT, option, "0", "--format", "csv", "-q").stdout for option in ("--drops", "--drop")
    )
    assert present == former != ""
    said = run("aspects", "--help").stdout
    assert re.search(r"^  --drops ", said, re.MULTILINE) and not re.search(r"--drop[ ,](?!.*once)", said)


@pytest.mark.parametrize("name", list(feeder.commands))
def test_a_help_text_has_sentences_of_thirty_words_at_most(name):
    """Lists of choices aside, which stand after a colon."""
    command = feeder.commands[name]
    texts = [command.help or "", *(getattr(option, "help", None) or "" for option in command.params)]
    paragraphs = [words(one) for text in texts for one in re.split(r"\n\s*\n", text)]
    sentences = [one for text in paragraphs for one in re.split(r"(?<=[.!?])\s+(?=[A-Za-z`(-])", text)]
    long = [one for one in sentences if len(re.findall(r"\S*\w\S*", one.split(": ")[0])) > 30]
    assert sentences and long == []


@pytest.mark.parametrize(
    ("command", "text", "told"),
    [
        ("aspects", "pass `allow_open` to compute", "pass --allow-open to compute"),
        ("batch", "pass `allow_open` to compute", "pass allow_open to compute"),
        ("batch", "start again with `resume`", "start again with --resume"),
        ("config", "or pass `replace`", "or pass --force"),
        ("slide", "another folder to `directory`", "another folder to -o"),
    ],
)
def test_an_argument_goes_by_its_option_where_the_command_has_one(command, text, told):
    assert talk.translated(text, talk.options_by_argument(feeder.commands[command])) == told


def completed(*words):
    """What the last of these words is completed to."""
    asked = {"_FEEDER_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": len(words) - 1}
    done = CliRunner().invoke(feeder, [], prog_name="feeder", env={k: str(v) for k, v in asked.items()})
    return [line.partition(",")[2] for line in done.stdout.splitlines() if line]


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["slide", "--set", "drive.am"], ["drive.amplitude="]),
        (["batch", "--set", "grav"], ["gravity="]),
        (["convey", "--vary", "track.b"], ["track.bank="]),
        (["track", "--vary", "friction.wa"], ["friction.wall="]),
        (["rate", "--rule", "c"], ["csa", "crsa", "closed"]),
        (["batch", "--rule", "q"], ["quasistatic"]),
        (["aspects", "--density", "stainl"], ["stainless_steel", "stainless_steel_1.4401"]),
        (["slide", "--set", "nothing"], []),
    ],
    ids=str,
)
def test_values_are_completed(words, found):
    assert completed("feeder", *words) == found
