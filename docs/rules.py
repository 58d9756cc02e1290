"""Bring the table of rules in docs/resting.md up to the registry of rules.

Example: python docs/rules.py          (writes docs/resting.md)
         python docs/rules.py --check  (status 1, and the differences, if it is out of date)
"""

import difflib
import sys
from pathlib import Path

from feederscrew.resting.rules.registry import RULES

PAGE = Path(__file__).resolve().parent / "resting.md"
BEGIN, END = "<!-- rules -->\n", "<!-- end of rules -->"
HEAD = "| Column | What it is | When to trust it | Source |\n|---|---|---|---|\n"
ANSWERS = (
    "| `p_drop` | a simulated drop test | parts thrown or fed onto a hard surface | own: see below |\n"
    "| `p_recommended`, `_low`, `_high` | `p_drop` where there is one, else `p_surface`; how far it may be "
    "off | one answer; not for part cards | own: see below |\n"
)


def filled(text):
    """Return the page with the table as the registry has it."""
    rows = [f"| `{rule.column}` | {rule.meaning} | {rule.use} | {rule.reference} |\n" for rule in RULES]
    before, _, rest = text.partition(BEGIN)
    return before + BEGIN + HEAD + "".join(rows) + ANSWERS + END + rest.partition(END)[2]


def main():
    """Write or check; the exit status."""
    old = PAGE.read_text(encoding="utf-8")
    new = filled(old)
    if "--check" in sys.argv:
        sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), "page", "now"))
        return int(old != new)
    PAGE.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
