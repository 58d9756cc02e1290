"""What people wait for at the command line, each wait beside its target.

Run: python benchmarks/waits.py            (prints the table)
     python benchmarks/waits.py --write    (puts it into docs/method/speed.md as well)

Where there is a bare floor, both are paired. Every call is a process of its own, with its modules compiled to
bytecode as an installation leaves them. Its processor time, with that of all it started, is told beside the
time by the clock: where they are far apart, the machine was busy. Ratios are of runs in turn, A B A B.
"""

import argparse
import os
import platform
import shutil
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from processes import adopt, at_once, finished, spent, together

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/method/speed.md"
PART = str(ROOT / "parts/lbracket_30x20x15.stl")
STARTED = time.perf_counter()
BARE = (sys.executable, "-c", "import numpy, scipy.spatial")
QUIET = {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}  # as the program asks for it
CALL = (sys.executable, "-c", "from feederscrew_cli.main import feeder; feeder()")
PRINTED = {
    "floor": ("floor", PART),
    "track": ("track", PART),
    "headings": ("headings", PART),
    "rate": ("rate", PART, "--aspect", "A"),
    "tune": ("tune", PART, "--aspect", "A", "--target", "5/min"),
}
STARTS = {  # what needs no part to be read
    "feeder --help": ("--help",),
    "feeder --version": ("--version",),
    "feeder batch --help": ("batch", "--help"),
    "feeder trial --help": ("trial", "--help"),
    "feeder aspcts": ("aspcts",),
}
START = 0.15  # [s]
ASKED = {  # calls without a target
    "drop": ("drop", PART),
    "slide": ("slide",),
    "convey": ("convey",),
    "bowl": ("bowl", PART, "--target", "20/min"),
    "trial": ("trial", PART),
}
REPEATS = 3
PAIRS = 2  # of batches
BATCH = 16  # parts: those of parts/, twice
BEFORE = {1: 676, 2: 921}  # [MiB] that such a batch took at 552f2b8, by its jobs, on a quiet machine


@dataclass(frozen=True)
class Row:
    """One wait of the table."""

    what: str
    target: float | None  # None: for information
    figure: float
    unit: str
    beside: str = ""  # clock, memory

    more: bool = False  # whether more is better

    @property
    def wanted(self):
        """The target as text."""
        return "" if self.target is None else f"{self.target:,g} {self.unit}"

    @property
    def verdict(self):
        """Whether the target holds."""
        if self.target is None:
            return "no target"
        return verdict(self.figure >= self.target if self.more else self.figure <= self.target)


def verdict(held):
    """Of a target, in a word."""
    return "holds" if held else "missed"


def median(runs, name):
    """The median of one of their numbers."""
    return statistics.median(getattr(run, name) for run in runs)


def printed():
    """The smallest answer beside its bare imports, and the other printed ones."""
    spent(*CALL, "aspects", PART, "-q")
    pairs = [(spent(*CALL, "aspects", PART, "-q"), spent(*BARE, **QUIET)) for _ in range(2 * REPEATS)]
    ratio = statistics.median(ours.cpu / bare.cpu for ours, bare in pairs)
    ours = [one for one, _ in pairs]
    beside = f"{median(ours, 'cpu'):.2f} s CPU, {median(ours, 'memory'):.0f} MiB"
    yield Row("`feeder aspects -q`, beside `import numpy, scipy.spatial`", 1.6, ratio, "x", beside)
    for name, arguments in PRINTED.items():
        spent(*CALL, *arguments, "-q")
        runs = [spent(*CALL, *arguments, "-q") for _ in range(REPEATS)]
        yield Row(f"`feeder {name}`, printed", 1.5, median(runs, "cpu"), "s CPU", clock(runs))


def starts():
    """What the shortest calls take: help, a version, a command that is not there."""
    for name, arguments in STARTS.items():
        runs = [spent(*CALL, *arguments, fails=True) for _ in range(2 * REPEATS)][1:]
        yield Row(f"`{name}`", START, median(runs, "cpu"), "s CPU", clock(runs))


def asked():
    """Other commands of one part, as they come, once everything is compiled."""
    for name, arguments in ASKED.items():
        _, *runs = [spent(*CALL, *arguments, "-q") for _ in range(2)]
        yield Row(f"`feeder {name}`, printed", None, median(runs, "cpu"), "s CPU", clock(runs))


def clock(runs):
    """Their time by the clock and their memory."""
    return f"{median(runs, 'wall'):.2f} s by the clock, {median(runs, 'memory'):.0f} MiB"


def reports(folder):
    """A report of a bracket, once everything is compiled."""
    call = (*CALL, "report", PART, "-o", f"{folder}/report", "-q")
    spent(*call)
    runs = [spent(*call) for _ in range(REPEATS)]
    yield Row("`feeder report` of a bracket, warm", 6.0, median(runs, "cpu"), "s CPU", clock(runs))
    yield Row("its memory", 300.0, median(runs, "memory"), "MiB")


def designs():
    """Designs for every orientation of a bracket, most of it the search for cut-outs."""
    _, run = [spent(*CALL, "tooling", PART, "-q") for _ in range(2)]
    yield Row("`feeder tooling` of a bracket, all orientations", 20.0, run.cpu, "s CPU", clock([run]))


def batches(folder):
    """A batch with pictures: what a part takes, what a second job gives, and what the machine could give.

    That is told by two batches of one job side by side, each with half of the parts.
    """
    parts, alone, shared, apart = _parts(folder), [], [], []
    for turn in range(PAIRS):
        alone.append(spent(*_batch(f"{folder}/one{turn}", 1, parts)))
        shared.append(spent(*_batch(f"{folder}/two{turn}", 2, parts)))
        halves = enumerate((parts[::2], parts[1::2]))
        apart.append(at_once([_batch(f"{folder}/half{turn}{k}", 1, half) for k, half in halves]))
    a_part, each = median(alone, "wall") / BATCH, [median(runs, "cpu") / BATCH for runs in (alone, shared)]
    told = f"{each[0]:.2f} s CPU, {each[1]:.2f} s with two jobs; {median(alone, 'memory'):.0f} MiB"
    yield Row(f"`feeder batch` with pictures, a part of {BATCH}", 2.0, a_part, "s", told)
    gain, most = (
        statistics.median(one.wall / two.wall for one, two in zip(alone, runs)) for runs in (shared, apart)
    )
    told = f"{most:.2f} x by two batches of half the parts side by side"
    yield Row("its two jobs beside one", 1.8, gain, "x as fast", told, more=True)


def memory(folder):
    """Memory of all processes of a batch, pages that they share counted once, by its halves."""
    parts = _parts(folder)
    for jobs, before in BEFORE.items():
        place = f"{folder}/memory{jobs}"
        halves = together(_batch(place, jobs, parts), lambda: finished(Path(place)) > BATCH // 2)  # noqa: B023
        told = f"{halves[0]:.0f} in its first half, {halves[1]:.0f} in the second; {before} as first measured"
        yield Row(
            f"memory of a batch, all processes of {jobs} job{'s'[: jobs - 1]}",
            before / 2,
            max(halves),
            "MiB",
            told,
        )


def _parts(folder):
    """The parts of parts/ as often as it takes, under names of their own."""
    found = sorted((ROOT / "parts").glob("*.stl"))
    for number in range(BATCH):
        one = found[number % len(found)]
        shutil.copy(one, f"{folder}/{number:02}_{one.name}")
    return sorted(str(path) for path in Path(folder).glob("*.stl"))


def _batch(place, jobs, parts):
    """The call for a batch into a folder of its own."""
    return (*CALL, "batch", *parts, "-o", place, "--jobs", str(jobs), "-q")


def first_use(folder):
    """What is compiled at the first call after an installation."""
    for name, arguments in {
        "drop": ("drop", PART, "--drops", "10", "-q"),
        "report": ("report", PART, "-o", f"{folder}/first", "-q"),
    }.items():
        with tempfile.TemporaryDirectory() as empty:
            first = spent(*CALL, *arguments, NUMBA_CACHE_DIR=empty)
            again = spent(*CALL, *arguments, NUMBA_CACHE_DIR=empty)
        what = f"compiling at the first `feeder {name}`"
        yield Row(what, 8.0, first.cpu - again.cpu, "s CPU", f"{first.wall:.0f} s by the clock in all")


def table(rows):
    """The rows as Markdown, the machine above them."""
    lines = [
        f"On {os.cpu_count()} cores of {processor()}, Python {platform.python_version()}; {busy()}.",
        "",
        "| What | Target | Here | | Beside |",
        "| --- | ---: | ---: | --- | --- |",
    ]
    lines += [
        f"| {r.what} | {r.wanted} | {shown(r.figure)} {r.unit} | {r.verdict} | {r.beside} |" for r in rows
    ]
    return "\n".join(lines) + "\n"


def busy():
    """How much else ran beside it, and what the script took so far."""
    load = os.getloadavg()[1] if hasattr(os, "getloadavg") else 0.0
    took = f"{sum(os.times()[:4]):.0f} s CPU in {time.perf_counter() - STARTED:.0f} s by the clock"
    return f"a load of {load:.0f}, this script included; {took}"


def shown(figure):
    """A figure in three digits, thousands with commas."""
    return f"{round(figure, -2):,.0f}" if figure >= 1000.0 else f"{figure:.3g}"


def processor():
    """What the machine's processor calls itself."""
    told = Path("/proc/cpuinfo")
    names = [line for line in told.read_text().splitlines() if "model name" in line] if told.exists() else []
    return names[0].partition(":")[2].strip() if names else platform.processor() or platform.machine()


def waits(folder):
    """Every wait."""
    yield from starts()
    yield from printed()
    yield from asked()
    yield from reports(folder)
    yield from designs()
    yield from batches(folder)
    yield from memory(folder)
    yield from first_use(folder)


def told(rows):
    """The rows, each printed as it is known."""
    for row in rows:
        figures = f"{row.figure:8.4g} {row.unit:12} {row.wanted:>20}  {row.verdict:7} {row.beside}"
        print(f"{row.what:68}{figures}", flush=True)
        yield row


def main(name, description, rows):
    """Print a table; write it between its marks of the page where that is asked for.

    Parameters
    ----------
    name : str
        Of the marks.
    description : str
    rows : function
        Of a folder to write to; gives the Rows as they are known.
    """
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="put the table into docs/method/speed.md")
    wanted = parser.parse_args()
    adopt()
    with tempfile.TemporaryDirectory() as folder:
        text = table(list(told(rows(folder))))
    if wanted.write:
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(begin)
        PAGE.write_text(before + begin + text + end + rest.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main("waits", __doc__, waits)
