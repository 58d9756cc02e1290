"""Bring docs/resting.md up to date: the table of rules, and that of rules against measured sets.

Example: python docs/rules.py          (writes docs/resting.md)
         python docs/rules.py --check  (status 1, and the differences, if its table of rules is out of date)

The measured sets are not checked: drop tests are among their answers.
"""

import sys
from pathlib import Path

import generated

from feederscrew.feeding.compare import compare_sets
from feederscrew.resting.rules.registry import RULES

PAGE = Path(__file__).resolve().parent / "resting.md"
BEGIN, END = "<!-- rules -->\n", "<!-- end of rules -->"
SETS, END_OF_SETS = "<!-- measured sets -->\n", "<!-- end of measured sets -->"
MEASURED = PAGE.parent / "measured"
HEAD = "| Column | What it is | When to trust it | Source |\n|---|---|---|---|\n"
ANSWERS = (
    "| `p_drop` | a simulated drop test | any launch onto a hard surface | own: see below |\n"
    "| `p_recommended`, `_low`, `_high` | the answer for `--launch`: `p_drop`; with `--rule closed` "
    "the closed form nearest to it | one answer; not for part cards | own: see below |\n"
)


def ruled(text):
    """Return the page with its table of rules as the program has it."""
    rows = [f"| `{rule.column}` | {rule.meaning} | {rule.use} | {rule.reference} |\n" for rule in RULES]
    return between(text, BEGIN, HEAD + "".join(rows) + ANSWERS, END)


def between(text, begin, content, end):
    """Return the text with the content between two marks; a page without them stays as it is."""
    if begin not in text or end not in text:
        return text
    before, _, rest = text.partition(begin)
    return before + begin + content + end + rest.partition(end)[2]


def measured_sets():
    """Return the mean total variation of each series of measured sets from each answer, as a table."""
    study = compare_sets(sorted(MEASURED.glob("*.csv")))
    lines = [["series", "launch", "sets", *(name.lower() for name in study.answers)]]
    for name, sets in study.series.items():
        apart = [one.distances for one in sets]
        known = [[away[answer] for away in apart if answer in away] for answer in study.answers]
        means = [f"{sum(some) / len(some):.3f}" if some else "" for some in known]
        lines.append([name, sets[0].measured.head.launch, str(len(sets)), *means])
    lines.insert(1, ["---"] * len(lines[0]))
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def main():
    """Write or check; the exit status."""
    check = generated.is_checking(__doc__)
    new = ruled(PAGE.read_text(encoding="utf-8"))
    if not check:
        new = between(new, SETS, measured_sets(), END_OF_SETS)
    return generated.bring_up(PAGE, new, check)


if __name__ == "__main__":
    sys.exit(main())
