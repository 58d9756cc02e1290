"""Bring the README and the worked pages up to what the program says: its outputs and its commands.

Example: python docs/readme.py          (writes README.md and the pages of WORKED)
         python docs/readme.py --check  (status 1, and the differences, if it is out of date)
"""

import contextlib
import os
import re
import shlex
import sys
from pathlib import Path

import generated
from click.testing import CliRunner

from feederscrew_cli.main import feeder

WORKED = (
    "docs/examples.md",
    "docs/bowl.md",
    "docs/tooling.md",
)  # pages whose console examples are outputs as well
TUTORIAL = "docs/tutorial.md"  # written with them; a test of its own runs it
ROOT = Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"```console( sampled)?\n\$ (feeder .*)\n((?:(?!```).*\n)*)```")
CUT = "...\n"
FEW = ("--drops", "10")  # in place of those the example asks for
CHECKED = contextlib.nullcontext  # round a sampled command that is checked: a test takes fewer parts there


def filled(text):
    """The README with every output and command as it is now."""
    return _between(BLOCK.sub(_block, text), "commands", _commands())


def _block(match):
    """A command line with its output; one that ended in '...' keeps its length.

    Of one that is sampled only the headings are checked, by a few drops: a sine whose last digit another
    library rounds differently may end a drop on another side.
    """
    sampled, line, shown = match.groups()
    words, check = shlex.split(line)[1:], sampled and "--check" in sys.argv
    if check and "--drops" in words:
        words += FEW
    if "--check" in sys.argv and words[0] == "tooling" and "--static" not in words:
        words.append("--static")  # what a trial says goes to stderr
    with CHECKED() if check else contextlib.nullcontext():
        output = CliRunner().invoke(feeder, words, catch_exceptions=False).stdout
    if shown.endswith(CUT):
        length = shown.count("\n") - 1
        output = "".join(output.splitlines(keepends=True)[:length]) + CUT
    if check and _headings(output) == _headings(shown):
        output = shown
    return f"```console{sampled or ''}\n$ {line}\n{output}```"


def _headings(output):
    """Words of the first line."""
    return output.partition("\n")[0].split()


def _commands():
    rows = "".join(
        f"| `feeder {name}` | {command.short_help} |\n" for name, command in feeder.commands.items()
    )
    return f"| Command | What it answers |\n|---|---|\n{rows}"


def _between(text, name, content):
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    if text.count(begin) != 1 or text.count(end) != 1:
        raise SystemExit(f"README.md: the marks {begin.strip()} and {end} must stand there once each")
    before, _, rest = text.partition(begin)
    return before + begin + content + end + rest.partition(end)[2]


def main():
    """Write or check; the exit status."""
    check = generated.is_checking(__doc__)
    os.chdir(ROOT)
    worked = WORKED if check else (*WORKED, TUTORIAL)
    pages = {"README.md": filled, **{page: lambda text: BLOCK.sub(_block, text) for page in worked}}
    texts = ((Path(page), fill) for page, fill in pages.items())
    return max(
        [generated.bring_up(path, fill(path.read_text(encoding="utf-8")), check) for path, fill in texts]
    )


if __name__ == "__main__":
    sys.exit(main())
