"""What the program says, in the words of the trade."""

import re

import click
import pytest
from click.testing import CliRunner
from command_lines import NUT

from feederscrew_cli import grouped, talk
from feederscrew_cli.main import feeder


def words(text):
    return " ".join(text.split())


def test_a_remark_is_folded_for_a_terminal_and_one_line_for_a_program():
    text = "Warning: tried, canyon: 18.85 mm: the static rule lets 4.52 % leave, of 26 parts 4.86 % do"
    lines = talk.fold_text(text, 40).split("\n")
    assert max(map(len, lines)) <= 40 and words(" ".join(lines)) == text
    assert all(line.startswith("  ") for line in lines[1:]) and len(lines) == 3
    assert talk.fold_text(text, None) == text and talk.fold_text(text, 200) == text


@pytest.mark.parametrize("name", list(feeder.commands))
def test_the_help_of_a_command_fits_a_screen_names_each_option_and_has_short_sentences(run, name):
    """All of it in groups on demand, each option once; lists of choices after a colon are no sentence."""
    command = feeder.commands[name]
    is_grouped = isinstance(command, grouped.Grouped)
    short, whole = (run(name, f"--help{more}").stdout for more in ("", "-all" * is_grouped))
    listed = whole.partition("\nOptions:\n")[2]
    assert "docs/glossary.md" in short and "docs/glossary.md" in whole
    assert len(short.splitlines()) <= 60 and words(short.partition("\n")[2]).startswith("Example: feeder")
    for each in [command, *getattr(command, "commands", {}).values()]:
        assert each.help.startswith(f"Example: feeder {name}") and each.short_help, each.name
    for option in (option for option in command.params if isinstance(option, click.Option)):
        longest = max(getattr(option, "present", option.opts), key=len)
        assert re.search(rf"(?<![\w-]){longest}(?![\w-])", short), longest
        assert len(re.findall(rf"^  (?:-\w, )?{longest}(?=[ \n])", listed, re.MULTILINE)) == 1, longest
    assert "None" not in whole, "of a bound that there is not"
    assert "\n  PART" not in listed and "\n  [PART]" not in listed, "an argument is no option"
    assert "\nOutput:\n" in listed or "--format" not in listed or not is_grouped
    texts = [command.help or "", *(getattr(option, "help", None) or "" for option in command.params)]
    paragraphs = [words(paragraph) for text in texts for paragraph in re.split(r"\n\s*\n", text)]
    sentences = [each for text in paragraphs for each in re.split(r"(?<=[.!?])\s+(?=[A-Za-z`(-])", text)]
    long = [each for each in sentences if len(re.findall(r"\S*\w\S*", each.split(": ")[0])) > 30]
    assert sentences and long == []


def test_a_former_name_of_an_option_is_taken_and_not_shown(run):
    call = ("aspects", NUT, "--format", "csv", "-q")
    present, former = (run(*call, option, "0").stdout for option in ("--drops", "--drop"))
    assert present == former != ""
    said = run("aspects", "--help").stdout
    assert re.search(r"^  --drops ", said, re.MULTILINE) and not re.search(r"--drop[ ,](?!.*once)", said)


def test_an_argument_goes_by_its_option_where_the_command_has_one():
    for command, text, as_option in (
        ("aspects", "pass `allow_open` to compute", "pass --allow-open to compute"),
        ("batch", "pass `allow_open` to compute", "pass allow_open to compute"),
        ("config", "or pass `replace`", "or pass --force"),
        ("slide", "another folder to `directory`", "another folder to -o"),
    ):
        assert talk.translate(text, talk.options_by_argument(feeder.commands[command])) == as_option


@pytest.mark.parametrize(
    "typed, values",
    {
        "slide --set drive.am": ["drive.amplitude="], "convey --vary track.b": ["track.bank="],
        "rate --rule c": ["csa", "crsa", "closed"], "slide --set nothing": [],
        "aspects --density stainl": ["stainless_steel", "stainless_steel_1.4401"],
    }.items(),
)  # fmt: skip
def test_values_are_completed(typed, values):
    own = {"COMP_WORDS": f"feeder {typed}", "COMP_CWORD": "3", "_FEEDER_COMPLETE": "bash_complete"}
    done = CliRunner().invoke(feeder, [], prog_name="feeder", env=own)
    assert [line.partition(",")[2] for line in done.stdout.splitlines() if line] == values
