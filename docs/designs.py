"""Bring docs/design.md up to date: the table of what `feeder design` makes of real parts.

Example: python docs/designs.py                                  (writes the table from docs/designs.csv)
         python docs/designs.py --check                          (status 1 if it is out of date)
         python docs/designs.py parts/washer_m6.stl some/nut.stl (designs these anew at first, one job each)
         python docs/designs.py some/nut.stl --target 40/min --more "--up A,B"
         python docs/designs.py --results runs/nut.json          (takes runs that were made before)
         python docs/designs.py --again parts some --keep runs   (each line anew, its part from these folders)

A part is a line of docs/designs.csv for each rate and each list of further options. A minute or four each.
With --keep each result is a file of a folder, and what is there is not run again: a run that was stopped
goes on where it was.
A result is what `feeder design --format json` printed, with the CPU seconds of the command as `cpu_s`, and
its further options, where it had any, as the text `more`.
"""

import argparse
import csv
import json
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import generated

FOLDER = Path(__file__).resolve().parent
PAGE, TABLE = FOLDER / "design.md", FOLDER / "designs.csv"
BEGIN, END = "<!-- designs -->\n", "<!-- end of designs -->"
MOST_SECONDS = 5400.0  # of one design
CONDITIONAL = 3  # exit status of one that holds under a condition only
KEYS = ("part", "asked", "more")  # by which a line is found
FIGURES = (
    "status", "class", "wanted", "chain", "rate", "low", "purity", "jams", "held", "draws", "queue_s",
    "trials", "cpu_s",
)  # fmt: skip
HEAD = (
    "Part", "Answer", "Class", "Leaves as", "Chain", "Rate", "Purity", "Jams", "Queue [s]", "Draws", "Trials",
    "CPU [s]",
)  # fmt: skip


def run_design(path: str, target: str, more: str, keep: str = "") -> dict[str, str]:
    """Design one part as a user does, and return its line; a result that is kept is not made again."""
    stem = Path(path).stem
    name = f"{stem}-{target}{more}".translate(dict.fromkeys(map(ord, " /,"), "_")) + ".json"
    kept = Path(keep) / name if keep else None
    if kept is not None and kept.exists():
        result = json.loads(kept.read_text(encoding="utf-8"))
        return line_of(result, stem, target, more, result["cpu_s"])
    feeder = Path(sys.executable).parent / "feeder"
    with tempfile.TemporaryDirectory() as folder:
        options = ["design", path, "--target", target, "--jobs", "1", "--format", "json", "-o", folder]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        finished = subprocess.run(
            [feeder, *options, *shlex.split(more)], capture_output=True, text=True, timeout=MOST_SECONDS
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        bowl_file = next(Path(folder).rglob("design.yaml"), None)
        tried = None if bowl_file is None else bowl_file.read_text(encoding="utf-8")
    if finished.returncode not in (0, CONDITIONAL):
        raise RuntimeError(f"{path}: {finished.stderr.strip()[-300:]}")
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    result = json.loads(finished.stdout)
    if kept is not None:
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(result | {"cpu_s": seconds, "more": more}), encoding="utf-8")
        if tried is not None:  # to confirm it by other seeds
            kept.with_suffix(".yaml").write_text(tried, encoding="utf-8")
    return line_of(result, stem, target, more, seconds)


def run_again(folders: list[str], keep: str) -> None:
    """Design each line of the table anew, its part from the first of some folders that has it."""
    for row in read_table():
        places = [Path(folder) / f"{row['part']}.stl" for folder in folders]
        path = next((place for place in places if place.exists()), None)
        if path is None:
            print(f"{row['part']}: no such file in {', '.join(folders)}", file=sys.stderr)
            continue
        try:
            put_line(run_design(str(path), row["asked"], row["more"], keep))
        except (RuntimeError, subprocess.TimeoutExpired) as fault:  # the others go on; its line stays
            print(f"{row['part']}: {fault}", file=sys.stderr)


def line_of(result: dict, part: str, target: str, more: str, seconds: float) -> dict[str, str]:
    """Return the line of a part from what `feeder design` printed, which took some CPU seconds."""
    chain = (f"{device['device']} {device['value']}".strip() for device in result["chain"])
    names = [f"{device['device']}: {device['value']}" for device in result["chain"]]
    # what is nearest may be of no class that is listed: then the cheapest of its status
    same = [row["class"] for row in result["alternatives"] if row["chain"] == names]
    held = same or [row["class"] for row in result["alternatives"] if row["status"] == result["status"]]
    return {
        "part": part,
        "asked": target,
        "more": more,
        "status": result["status"],
        "class": str(min(held, default="")),
        "wanted": result["wanted"] or "",
        "chain": ", ".join(chain) or "none",
        "rate": f"{result['delivered_per_minute']:.3g}",
        "low": f"{result['delivered_low']:.3g}",
        "purity": "" if result["purity"] is None else f"{100.0 * result['purity']:.1f}",
        "jams": str(result["jams"]),
        "held": str(result["robust"]["held"]),
        "draws": str(result["robust"]["draws"]),
        "queue_s": f"{result['queue_seconds']:.0f}",
        "trials": str(len(result["attempts"])),
        "cpu_s": f"{seconds:.0f}",
    }


def read_table() -> list[dict[str, str]]:
    """Return the lines of docs/designs.csv."""
    if not TABLE.exists():
        return []
    with TABLE.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def put_line(line: dict[str, str]) -> None:
    """Write a line into docs/designs.csv, in the place of the one of the same part, rate and options."""
    lines = [row for row in read_table() if any(row[name] != line[name] for name in KEYS)]
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        out = csv.DictWriter(file, (*KEYS, *FIGURES), lineterminator="\n")
        out.writeheader()
        out.writerows(sorted([*lines, line], key=lambda row: [row[name] for name in KEYS]))


def page_row(line: dict[str, str]) -> str:
    """Return a line of the page's table."""
    name = line["part"] + (f", `{line['more']}`" if line["more"] else "")
    rate, draws = f"{line['rate']} ({line['low']})", f"{line['held']} of {line['draws']}"
    purity = f"{line['purity']} %" if line["purity"] else "-"
    cells = (
        name, line["status"], line["class"], line["wanted"], line["chain"], rate, purity,
        line["jams"], line["queue_s"], draws, line["trials"], line["cpu_s"],
    )  # fmt: skip
    return f"| {' | '.join(cells)} |\n"


def with_table(page: str) -> str:
    """Return the page with the table that docs/designs.csv makes."""
    head = f"| {' | '.join(HEAD)} |\n|{'---|' * len(HEAD)}\n"
    before, _, rest = page.partition(BEGIN)
    return before + BEGIN + head + "".join(map(page_row, read_table())) + END + rest.partition(END)[2]


def main() -> int:
    """Design, write or check; the exit status."""
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="*")
    parser.add_argument("--target", default="30/min")
    parser.add_argument("--more", default="", help="further options of feeder design")
    parser.add_argument("--results", nargs="+", default=[], help="runs that were made before, JSON")
    parser.add_argument("--again", nargs="+", default=[], help="each line anew, its part from these folders")
    parser.add_argument("--keep", default="", help="folder in which each result is kept")
    parser.add_argument("--check", action="store_true")
    asked = parser.parse_args()
    for path in asked.parts:
        put_line(run_design(path, asked.target, asked.more, asked.keep))
    if asked.again:
        run_again(asked.again, asked.keep)
    for path in asked.results:
        result = json.loads(Path(path).read_text(encoding="utf-8"))
        more = result.get("more", "")
        put_line(line_of(result, Path(path).stem.partition("-")[0], asked.target, more, result["cpu_s"]))
    return generated.bring_up(PAGE, with_table(PAGE.read_text(encoding="utf-8")), asked.check)


if __name__ == "__main__":
    sys.exit(main())
