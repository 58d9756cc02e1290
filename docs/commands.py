"""Write docs/commands.md, the reference of every command, from the commands themselves.

Example: python docs/commands.py          (writes docs/commands.md)
         python docs/commands.py --check  (status 1, and the differences, if it is out of date)
"""

import difflib
import sys
from pathlib import Path

import click

from feederscrew_cli.main import feeder

PAGE = Path(__file__).resolve().parent / "commands.md"
HEAD = "# Commands\n\nWritten by `docs/commands.py` from the commands themselves.\n"


def reference():
    """The whole page."""
    root = click.Context(feeder, info_name="feeder")
    return HEAD + "".join(
        _section(command, click.Context(command, info_name=name, parent=root))
        for name, command in feeder.commands.items()
    )


def _section(command, context, level="##"):
    """Usage, help and options of a command, then of the commands below it."""
    usage = " ".join(command.collect_usage_pieces(context))
    example, _, prose = command.help.partition("\n")
    text = f"\n{level} `{context.command_path}`\n\n{command.short_help}\n\n"
    text += f"```sh\n{context.command_path} {usage}\n{example.removeprefix('Example:').strip()}\n```\n\n"
    text += _prose(prose) + _options(command, context)
    for name, below in getattr(command, "commands", {}).items():
        text += _section(below, click.Context(below, info_name=name, parent=context), f"{level}#")
    return text


def _prose(text):
    paragraphs = (" ".join(block.split()) for block in text.replace("\b", "").split("\n\n"))
    return "".join(f"{escaped(block)}\n\n" for block in paragraphs if block)


def _options(command, context):
    records = [option.get_help_record(context) for option in command.get_params(context)]
    rows = [f"| `{_piped(names)}` | {escaped(text)} |\n" for names, text in filter(None, records) if text]
    return "| Option | Meaning |\n|---|---|\n" + "".join(rows)


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
    new = reference()
    if "--check" not in sys.argv:
        PAGE.write_text(new, encoding="utf-8")
        return 0
    old = PAGE.read_text(encoding="utf-8")
    sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), PAGE.name, "now"))
    return int(old != new)


if __name__ == "__main__":
    sys.exit(main())
