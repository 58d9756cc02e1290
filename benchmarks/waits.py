"""What people wait for at the command line, each wait beside its target.

Run: python benchmarks/waits.py            (prints the table)
     python benchmarks/waits.py --write    (puts it into docs/speed.md as well)

Where there is a bare floor, both are paired. Every call is a process of its own. Its processor time, with
that of its children, is told beside the time by the clock: where they are far apart, the machine was busy.
Ratios are of runs in turn, A B A B.
"""

import argparse
import os
import platform
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/speed.md"
PART = str(ROOT / "parts/lbracket_30x20x15.stl")
BARE = (sys.executable, "-c", "import numpy, scipy.spatial")
CALL = (sys.executable, "-c", "from feederscrew_cli.main import feeder; feeder()")
PRINTED = {
    "floor": ("floor", PART),
    "track": ("track", PART),
    "headings": ("headings", PART),
    "rate": ("rate", PART, "--aspect", "A"),
    "tune": ("tune", PART, "--aspect", "A", "--target", "5/min"),
}
MIB = 1024.0  # KiB
REPEATS = 3
BATCH = 8  # parts: those of parts/


@dataclass(frozen=True)
class Spent:
    """What one process took."""

    cpu: float  # [s] with its children
    wall: float  # [s]
    memory: float  # [MiB] most at a time, of the largest process


@dataclass(frozen=True)
class Row:
    """One wait of the table."""

    what: str
    target: float
    figure: float
    unit: str
    beside: str = ""  # clock, memory

    more: bool = False  # whether more is better

    @property
    def verdict(self):
        """Whether the target holds."""
        held = self.figure >= self.target if self.more else self.figure <= self.target
        return "holds" if held else "missed"


def spent(*command, **environment):
    """Run one process to its end; what it took."""
    start = time.perf_counter()
    with Path(os.devnull).open("wb") as nothing:
        actions = [(os.POSIX_SPAWN_DUP2, nothing.fileno(), 1), (os.POSIX_SPAWN_DUP2, nothing.fileno(), 2)]
        child = os.posix_spawn(command[0], command, os.environ | environment, file_actions=actions)
        _, status, used = os.wait4(child, 0)
    if status:
        raise SystemExit(f"failed: {' '.join(command)}")
    return Spent(used.ru_utime + used.ru_stime, time.perf_counter() - start, used.ru_maxrss / MIB)


def median(runs, name):
    """The median of one of their numbers."""
    return statistics.median(getattr(run, name) for run in runs)


def printed():
    """The smallest answer beside its bare imports, and the other printed ones."""
    spent(*CALL, "aspects", PART, "-q")
    pairs = [(spent(*CALL, "aspects", PART, "-q"), spent(*BARE)) for _ in range(2 * REPEATS)]
    ratio = statistics.median(ours.cpu / bare.cpu for ours, bare in pairs)
    ours = [one for one, _ in pairs]
    beside = f"{median(ours, 'cpu'):.2f} s CPU, {median(ours, 'memory'):.0f} MiB"
    yield Row("`feeder aspects -q`, beside `import numpy, scipy.spatial`", 1.6, ratio, "x", beside)
    for name, arguments in PRINTED.items():
        spent(*CALL, *arguments, "-q")
        runs = [spent(*CALL, *arguments, "-q") for _ in range(REPEATS)]
        yield Row(f"`feeder {name}`, printed", 1.5, median(runs, "cpu"), "s CPU", clock(runs))


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


def batches(folder):
    """A batch with pictures: what a part takes, and what a second job gives."""
    parts = sorted(str(path) for path in (ROOT / "parts").glob("*.stl"))[:BATCH]
    took = {1: [], 2: []}
    for turn in range(REPEATS):
        for jobs in took:
            place = f"{folder}/batch{turn}{jobs}"
            took[jobs].append(spent(*CALL, "batch", *parts, "-o", place, "--jobs", str(jobs), "-q"))
    a_part = statistics.median(one.wall for one in took[1]) / len(parts)
    yield Row(f"`feeder batch` with pictures, a part of {len(parts)}", 2.0, a_part, "s", clock(took[1]))
    gain = statistics.median(one.wall / two.wall for one, two in zip(*took.values()))
    yield Row("its two jobs beside one", 1.8, gain, "x as fast", more=True)


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
        f"| {r.what} | {r.target:,g} {r.unit} | {shown(r.figure)} {r.unit} | {r.verdict} | {r.beside} |"
        for r in rows
    ]
    return "\n".join(lines) + "\n"


def busy():
    """How much else ran beside it."""
    load = os.getloadavg()[1] if hasattr(os, "getloadavg") else 0.0
    return f"{load:.0f} processes at work on the machine at a time, this one included"


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
    yield from printed()
    yield from reports(folder)
    yield from batches(folder)
    yield from first_use(folder)


def told(rows):
    """The rows, each printed as it is known."""
    for row in rows:
        figures = f"{row.figure:8.4g} {row.unit:12} {row.target:8g}  {row.verdict:7} {row.beside}"
        print(f"{row.what:60}{figures}", flush=True)
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
    parser.add_argument("--write", action="store_true", help="put the table into docs/speed.md")
    wanted = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = table(list(told(rows(folder))))
    if wanted.write:
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(begin)
        PAGE.write_text(before + begin + text + end + rest.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main("waits", __doc__, waits)
