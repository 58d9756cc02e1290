"""Bring docs/design.md up to date: the table of what `feeder design` makes of real parts.

Example: python docs/designs.py                                  (writes the table from docs/designs.csv)
         python docs/designs.py --check                          (status 1 if it is out of date)
         python docs/designs.py parts/washer_m6.stl some/nut.stl (designs these anew at first, one job each)
         python docs/designs.py some/nut.stl --target 40/min --more "--up A,B"

A part is a line of docs/designs.csv for each rate and each list of further options. A minute or four each.
"""

import argparse
import csv
import difflib
import json
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PAGE, TABLE = FOLDER / "design.md", FOLDER / "designs.csv"
BEGIN, END = "<!-- designs -->\n", "<!-- end of designs -->"
OWN = ("part", "asked", "more")  # what a line is found by
COUNTED = (
    "status", "wanted", "chain", "rate", "low", "purity", "jams", "held", "draws", "queue_s", "trials",
    "cpu_s",
)  # fmt: skip
HEAD = (
    "Part", "Asked", "Answer", "Leaves as", "Chain", "Rate", "Purity", "Jams", "Queue [s]", "Draws", "Trials",
    "CPU [s]",
)  # fmt: skip


def designed(path, target, more):
    """Design one part as a user does, and return its line."""
    feeder = Path(sys.executable).parent / "feeder"
    with tempfile.TemporaryDirectory() as folder:
        asked = ["design", path, "--target", target, "--jobs", "1", "--format", "json", "-o", folder]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            [feeder, *asked, *shlex.split(more)], capture_output=True, text=True, check=True, timeout=1800
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"part": Path(path).stem, "asked": target, "more": more} | told(json.loads(done.stdout), used)


def told(found, seconds):
    """What a line says of the answer of `feeder design`, which took some seconds."""
    chain = (f"{one['device']} {one['value']}".strip() for one in found["chain"])
    return {
        "status": found["status"],
        "wanted": found["wanted"] or "",
        "chain": ", ".join(chain) or "none",
        "rate": f"{found['delivered_per_minute']:.3g}",
        "low": f"{found['delivered_low']:.3g}",
        "purity": "" if found["purity"] is None else f"{100.0 * found['purity']:.1f}",
        "jams": str(found["jams"]),
        "held": str(found["robust"]["held"]),
        "draws": str(found["robust"]["draws"]),
        "queue_s": f"{found['queue_seconds']:.0f}",
        "trials": str(len(found["attempts"])),
        "cpu_s": f"{seconds:.0f}",
    }


def known():
    """The lines of docs/designs.csv."""
    if not TABLE.exists():
        return []
    with TABLE.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def kept(line):
    """Write a line into docs/designs.csv, in the place of the one of the same part, rate and options."""
    lines = [one for one in known() if any(one[name] != line[name] for name in OWN)]
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        out = csv.DictWriter(file, (*OWN, *COUNTED), lineterminator="\n")
        out.writeheader()
        out.writerows(sorted([*lines, line], key=lambda one: [one[name] for name in OWN]))


def row(one):
    """A line of the page's table."""
    name = one["part"] + (f", `{one['more']}`" if one["more"] else "")
    rate, draws = f"{one['rate']} ({one['low']})", f"{one['held']} of {one['draws']}"
    purity = f"{one['purity']} %" if one["purity"] else "-"
    cells = (
        name, one["asked"].partition("/")[0], one["status"], one["wanted"], one["chain"], rate, purity,
        one["jams"], one["queue_s"], draws, one["trials"], one["cpu_s"],
    )  # fmt: skip
    return f"| {' | '.join(cells)} |\n"


def table():
    """The page's table."""
    return f"| {' | '.join(HEAD)} |\n|{'---|' * len(HEAD)}\n" + "".join(map(row, known()))


def paged(text):
    """The page with the table that docs/designs.csv makes."""
    before, _, rest = text.partition(BEGIN)
    return before + BEGIN + table() + END + rest.partition(END)[2]


def main():
    """Design, write or check; the exit status."""
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="*")
    parser.add_argument("--target", default="30/min")
    parser.add_argument("--more", default="", help="further options of feeder design")
    parser.add_argument("--check", action="store_true")
    asked = parser.parse_args()
    for path in asked.parts:
        kept(designed(path, asked.target, asked.more))
    old = PAGE.read_text(encoding="utf-8")
    new = paged(old)
    if asked.check:
        sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), "page", "now"))
        return int(old != new)
    PAGE.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
