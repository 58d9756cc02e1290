"""What people wait for at the command line, each wait beside its target.

Run: python benchmarks/waits.py                  (prints the table)
     python benchmarks/waits.py --write          (puts it into docs/speed.md as well)
     python benchmarks/waits.py --before FOLDER  (beside the same calls of another checkout with a .venv)

Every call is a process of its own, with its modules compiled to bytecode as an installation leaves them, and
nothing kept on disk. Times are processor time with that of all it started. One import is that of numpy and
scipy.spatial in the same run.
"""

import argparse
import functools
import os
import platform
import shutil
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

from processes import adopt, at_once, finished, spent, together

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/speed.md"
BRACKET, RIVET = f"{ROOT}/parts/lbracket_30x20x15.stl", f"{ROOT}/benchmarks/rivet_body.stl"
BOWL = ("--config", f"{ROOT}/configs/bowl.yaml")
STARTED = time.perf_counter()
IMPORT = (sys.executable, "-c", "import numpy, scipy.spatial")
QUIET = {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}  # as the program asks for it
STARTS = (("--help",), ("--version",), ("batch", "--help"), ("trial", "--help"), ("aspcts",))
LONGEST_START_S = 0.15
IN_IMPORTS = {  # further words of the call of a bracket, and its target in imports
    "aspects": ((), 2.0),
    "rate": (BOWL, 2.5),
    "track": ((), 2.5),
    "floor": ((), 2.5),
    "headings": ((), 2.5),
    "tune": (("--aspect", "A", "--target", "10/min", *BOWL), 6.0),
}
REPORT, REPORT_MIB, TOOLING, DESIGN, FIRST_TRIAL = 12.0, 250.0, 40.0, 90.0, 60.0  # targets
REPEATS = 3
PAIRS = 2  # of batches
BATCH = 16  # parts: those of parts/, twice
BEFORE_MIB = {1: 676, 2: 921}  # that such a batch took at 552f2b8, by its jobs, on a quiet machine


@dataclass(frozen=True)
class Row:
    """One wait of the table."""

    what: str
    target: float | None  # None: for information
    figure: float
    unit: str
    beside: str = ""  # clock, memory
    more: bool = False  # whether more is better
    before: float | None = None  # of another checkout

    @property
    def cells(self):
        """The row as text: what, target, figure, verdict, the other checkout's, what stands beside."""
        target = "" if self.target is None else f"{self.target:,g} {self.unit}"
        word = "no target"
        if self.target is not None:
            word = verdict(self.figure >= self.target if self.more else self.figure <= self.target)
        before = "" if self.before is None else digits(self.before)
        return self.what, target, f"{digits(self.figure)} {self.unit}", word, before, self.beside


def verdict(holds):
    """Of a target, in a word."""
    return "holds" if holds else "missed"


def median(runs, name):
    return statistics.median(getattr(run, name) for run in runs)


def clock(runs):
    """Their time by the clock and their memory."""
    return f"{median(runs, 'wall'):.2f} s by the clock, {median(runs, 'memory'):.0f} MiB"


def digits(figure):
    """A figure in three digits, in four from 100 on, thousands with commas."""
    return f"{round(figure, -2):,.0f}" if figure >= 1000.0 else f"{figure:.{4 if figure >= 100.0 else 3}g}"


@functools.cache
def one_import():
    """Processor time [s] of an import of numpy and scipy.spatial."""
    return median([spent(*IMPORT, **QUIET) for _ in range(2 * REPEATS + 1)], "cpu")


def waits(call, folder):
    yield from starts(call)
    yield from in_imports(call, folder)
    yield from designs(call, folder)
    yield from first_trial(call)
    yield from batches(call, folder)
    yield from memory(call, folder)


def starts(call):
    """What the shortest calls take: help, a version, a command that is not there."""
    for arguments in STARTS:
        runs = [spent(*call, *arguments, fails=True) for _ in range(2 * REPEATS)][1:]
        yield Row(f"`feeder {' '.join(arguments)}`", LONGEST_START_S, median(runs, "cpu"), "s", clock(runs))


def in_imports(call, folder):
    """What is printed of a bracket, a report of it, and devices for all its orientations."""
    for name, (options, target) in IN_IMPORTS.items():
        _, *runs = [spent(*call, name, BRACKET, "-q", *options) for _ in range(REPEATS + 1)]
        yield Row(f"`feeder {name}`", target, median(runs, "cpu") / one_import(), "imports", clock(runs))
    report = (*call, "report", BRACKET, "-q", *BOWL, "-o", f"{folder}/report")
    _, *runs = [spent(*report) for _ in range(REPEATS + 1)]
    yield Row("`feeder report`, warm", REPORT, median(runs, "cpu") / one_import(), "imports", clock(runs))
    yield Row("its memory", REPORT_MIB, median(runs, "memory"), "MiB")
    run = spent(*call, "tooling", BRACKET, "-q")
    yield Row("`feeder tooling`, all orientations", TOOLING, run.cpu / one_import(), "imports", clock([run]))


def designs(call, folder):
    """Designs at 30 a minute with all their files, by one job, and one of them by two."""
    runs = {}
    for part in (RIVET, BRACKET):
        name = Path(part).stem
        design = (*call, "design", part, "--target", "30/min", "-q", "-o", f"{folder}/{name}", "--jobs")
        runs[part] = run = spent(*design, "1", fails=True)
        yield Row(f"`feeder design` of {name}", DESIGN, run.cpu / one_import(), "imports", clock([run]))
    design = (*call, "design", RIVET, "--target", "30/min", "-q", "-o", f"{folder}/two", "--jobs", "2")
    two = spent(*design, fails=True)
    gain = runs[RIVET].wall / two.wall
    yield Row("the rivet's by two jobs beside one, by the clock", 1.5, gain, "x as fast", clock([two]), True)


def first_trial(call):
    """What is compiled at the first trial after an installation."""
    with tempfile.TemporaryDirectory() as empty:
        trial = (*call, "trial", BRACKET, "--parts", "2", *BOWL)
        first, again = (spent(*trial, NUMBA_CACHE_DIR=empty) for _ in range(2))
    compiling = (first.cpu - again.cpu) / one_import()
    yield Row("compiling at the first `feeder trial`", FIRST_TRIAL, compiling, "imports", clock([first]))


def batches(call, folder):
    """A batch with pictures: what a part takes, what a second job gives, and what the machine could give.

    That is seen by two batches of one job side by side, each with half of the parts.
    """
    parts, alone, shared, halved = copies(folder), [], [], []
    for turn in range(PAIRS):
        alone.append(spent(*batch(call, f"{folder}/one{turn}", 1, parts)))
        shared.append(spent(*batch(call, f"{folder}/two{turn}", 2, parts)))
        halves = enumerate((parts[::2], parts[1::2]))
        halved.append(at_once([batch(call, f"{folder}/half{turn}{k}", 1, half) for k, half in halves]))
    cpu = [median(runs, "cpu") / BATCH for runs in (alone, shared)]
    beside = f"{cpu[0]:.2f} s CPU, {cpu[1]:.2f} s with two jobs; {median(alone, 'memory'):.0f} MiB"
    yield Row(
        f"`feeder batch` with pictures, a part of {BATCH}", 2.0, median(alone, "wall") / BATCH, "s", beside
    )
    gain, most = (
        statistics.median(one.wall / two.wall for one, two in zip(alone, runs)) for runs in (shared, halved)
    )
    beside = f"{most:.2f} x by two batches of half the parts side by side"
    yield Row("its two jobs beside one, by the clock", 1.8, gain, "x as fast", beside, more=True)


def memory(call, folder):
    """Memory of all processes of a batch, pages that they share counted once, by its halves."""
    parts = copies(folder)
    for jobs, before in BEFORE_MIB.items():
        place = f"{folder}/memory{jobs}"
        halves = together(batch(call, place, jobs, parts), lambda: finished(Path(place)) > BATCH // 2)  # noqa: B023
        beside = (
            f"{halves[0]:.0f} in its first half, {halves[1]:.0f} in the second; {before} as first measured"
        )
        what = f"memory of a batch, all processes of {jobs} job{'s'[: jobs - 1]}"
        yield Row(what, before / 2, max(halves), "MiB", beside)


def is_half_done(place):
    return finished(place) > BATCH // 2


def copies(folder):
    """The parts of parts/ as often as it takes, under names of their own."""
    parts = sorted((ROOT / "parts").glob("*.stl"))
    for number in range(BATCH):
        part = parts[number % len(parts)]
        shutil.copy(part, f"{folder}/{number:02}_{part.name}")
    return sorted(str(path) for path in Path(folder).glob("*.stl"))


def batch(call, place, jobs, parts):
    return (*call, "batch", *parts, "-o", place, "--jobs", str(jobs), "-q")


def table(rows):
    """The rows as Markdown, the machine above them."""
    lines = [
        f"On {os.cpu_count()} cores of {processor()}, Python {platform.python_version()}; {busy()}.",
        "",
        "| What | Target | Here | | Before | Beside |",
        "| --- | ---: | ---: | --- | ---: | --- |",
        *(f"| {' | '.join(row.cells)} |" for row in rows),
    ]
    return "\n".join(lines) + "\n"


def busy():
    """How much else ran beside it, and what the script took so far."""
    load = os.getloadavg()[1] if hasattr(os, "getloadavg") else 0.0
    took = f"{sum(os.times()[:4]):.0f} s CPU in {time.perf_counter() - STARTED:.0f} s by the clock"
    return f"a load of {load:.0f}, this script included; {took}"


def processor():
    """What the machine's processor calls itself."""
    info = Path("/proc/cpuinfo")
    names = [line for line in info.read_text().splitlines() if "model name" in line] if info.exists() else []
    return names[0].partition(":")[2].strip() if names else platform.processor() or platform.machine()


def printed(rows):
    """The rows, each printed as it is known."""
    for row in rows:
        what, target, figure, verdict, before, beside = row.cells
        print(f"{what:58}{figure:>16} {target:>16}  {verdict:9} {before:>8} {beside}", flush=True)
        yield row


def main(name, description, rows, *, page=PAGE):
    """Print a table; write it between its marks of a page where that is asked for.

    Parameters
    ----------
    name : str
        Of the marks.
    description : str
    rows : function
        Of the start of a command and a folder to write to; gives the Rows as they are known.
    page : Path
    """
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    parser.add_argument("--before", metavar="FOLDER", help="another checkout, whose figures stand beside")
    options = parser.parse_args()
    adopt()
    os.environ["FEEDER_CACHE"] = ""
    ours = list(printed(rows((f"{ROOT}/.venv/bin/feeder",), scratch())))
    if options.before:
        theirs = {
            row.what: row.figure for row in printed(rows((f"{options.before}/.venv/bin/feeder",), scratch()))
        }
        ours = [replace(row, before=theirs.get(row.what)) for row in ours]
    if options.write:
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        head, _, rest = page.read_text(encoding="utf-8").partition(begin)
        page.write_text(head + begin + table(ours) + end + rest.partition(end)[2], encoding="utf-8")


def scratch():
    return tempfile.mkdtemp(prefix="feeder-waits-")


if __name__ == "__main__":
    main("waits", __doc__, waits)
