"""Write docs/commands.md, the reference of every command, from the commands themselves.

Example: python docs/commands.py          (writes docs/commands.md)
         python docs/commands.py --check  (status 1, and the differences, if it is out of date)
"""

import sys
from collections import Counter
from pathlib import Path

import click
import generated

from feederscrew_cli.main import feeder

PAGE = Path(__file__).resolve().parent / "commands.md"
HEAD = "# Commands\n\nWritten by `docs/commands.py` from the commands themselves.\n"
COMMON = "\n## Options of several commands\n\nThe section of each command names those that it takes.\n\n"
MANY = 4  # commands that share an option, by its names and its text: the page says it once
COLUMNS = "| {} | Meaning |\n|---|---|\n"
SHARED = "[of several commands](#options-of-several-commands)"


def reference():
    """The whole page."""
    root = click.Context(feeder, info_name="feeder")
    commands = {
        command: click.Context(command, info_name=n, parent=root) for n, command in feeder.commands.items()
    }
    counts = Counter(row for command, context in commands.items() for row in _rows(command, context))
    shared = [row for row, count in counts.items() if count >= MANY]
    common = COMMON + COLUMNS.format("Option") + "".join(_line(*row) for row in shared)
    return HEAD + common + "".join(_section(*one, shared) for one in commands.items())


def _section(command, context, shared, level="##"):
    """Example, help, usage and options of a command, then of the commands below it."""
    usage = " ".join([context.command_path, *command.collect_usage_pieces(context)])
    example, _, prose = command.help.partition("\n")
    text = f"\n{level} `{context.command_path}`: {_within(command.short_help)}\n\n"
    text += f"Example: `{example.removeprefix('Example:').strip()}`\n\n"
    text += _prose(prose) + _options(usage, _rows(command, context), shared)
    for name, below in getattr(command, "commands", {}).items():
        text += _section(below, click.Context(below, info_name=name, parent=context), shared, f"{level}#")
    return text


def _within(sentence):
    """A sentence as it goes on in a heading: a small letter first, no stop."""
    return sentence[:1].lower() + sentence[1:].removesuffix(".")


def _prose(text):
    paragraphs = (" ".join(block.split()) for block in text.replace("\b", "").split("\n\n"))
    return "".join(f"{escaped(block)}\n\n" for block in paragraphs if block)


def _rows(command, context):
    """Names and text of each option that has a text."""
    records = [option.get_help_record(context) for option in command.get_params(context)]
    return [(names, text) for names, text in filter(None, records) if text]


def _options(usage, rows, shared):
    """The options of one command as a table below its usage, and the names of the shared ones."""
    own, others = [row for row in rows if row not in shared], [row for row in rows if row in shared]
    names = ", ".join(f"`{names.split(', ')[-1].split()[0]}`" for names, _ in others)
    if not own:
        return f"`{usage}`; options {SHARED}: {names}\n"
    also = f"| {SHARED} | {names} |\n" if others else ""
    return COLUMNS.format(f"`{_piped(usage)}`") + "".join(_line(*row) for row in own) + also


def _line(names, text):
    """A row of a table of options."""
    return f"| `{_piped(names)}` | {escaped(text)} |\n"


def _piped(names):
    """Names as code in a table, where only '|' needs a mark."""
    return names.replace("|", "\\|")


def escaped(text):
    """Text as Markdown shows it unchanged in a table."""
    for letter in "|<>*":
        text = text.replace(letter, f"\\{letter}")
    return " ".join(text.split())


def main():
    """Write or check; the exit status."""
    check = generated.is_checking(__doc__)
    return generated.bring_up(PAGE, reference(), check)


if __name__ == "__main__":
    sys.exit(main())
