"""How time and memory grow with facets, with the parts of a batch and with the parts of a queue.

Run: python benchmarks/scale.py          (prints the table; --write puts it into docs/method/speed.md)
     FEEDER_LARGEST=10000 python benchmarks/scale.py   (batches of up to so many parts; 1,000 otherwise)

Each call is a process of its own. An exponent is the slope of the logarithm over the two largest sizes.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import waits
from processes import spent

FACETS = (1_000, 10_000, 100_000, 1_000_000)
FOLLOWED = (1_000, 5_000, 20_000)  # what is sent along a track has 20,000 facets at most
QUEUE = (2, 20, 200)
LARGEST = int(os.environ.get("FEEDER_LARGEST", "1000"))
OF_A_FILE = {
    "aspects": (FACETS, ()),
    "tooling": (FOLLOWED, ("--aspect", "A", "--static")),
    "trial": (FOLLOWED, ("--aspect", "A", "--parts", "2")),
}
HERE = Path(__file__).parent
MAKE = "import aspects, sys; aspects.screw(int(sys.argv[1])).export(sys.argv[2])"
SOLID = 60.0  # [s] at most, with its files


def scale(call, folder):
    """Every row: a call at one size, its time, its memory, and the exponents of both."""
    for name, (sizes, options) in OF_A_FILE.items():
        spent(*call, name, waits.BRACKET, "-q", *options)  # compiles
        runs = by_facets(call, folder, sizes, name, options)
        yield from grown(f"`feeder {name}` of a screw, facets", runs)
    yield from grown("`feeder batch`, no pictures, parts", by_parts(call, folder))
    queue = (
        (n, spent(*call, "trial", waits.BRACKET, "--parts", "1", "--queue", str(n), "--seconds", "2", "-q"))
        for n in QUEUE
    )
    yield from grown("`feeder trial --queue`, two seconds, parts", queue)
    for shape in ("cylinder", "stepped", "conical"):
        solid = (
            "bowl",
            waits.BRACKET,
            "--target",
            "20/min",
            "--solid",
            "--set",
            f"sizing.shape={shape}",
            "-q",
        )
        run = spent(*call, *solid, "-o", f"{folder}/{shape}")
        yield waits.Row(f"`feeder bowl --solid`, {shape}", SOLID, run.cpu, "s", waits.clock([run]))


def by_facets(call, folder, sizes, name, options):
    """What a call takes of a ribbed screw of some numbers of facets."""
    for facets in sizes:
        path = Path(folder) / f"{facets}.stl"
        if not path.exists():  # in a process of its own: the memory of this one would count as the call's
            subprocess.run([sys.executable, "-c", MAKE, str(facets), str(path)], check=True, cwd=HERE)
        yield facets, spent(*call, name, str(path), "-q", *options)


def by_parts(call, folder):
    """What a batch takes of 10 parts and more, all of one file under other names."""
    for count in (n for n in (10, 100, 1_000, 10_000) if n <= LARGEST):
        place = Path(tempfile.mkdtemp(dir=folder))
        for number in range(count):
            shutil.copy(waits.RIVET, place / f"{number:05}.stl")
        batch = (*call, "batch", str(place), "-o", f"{place}/out", "--no-pictures", "-q")
        yield count, spent(*batch)


def grown(what, runs):
    """A row for each size, with the exponents since the one before it."""
    before = None
    for size, run in runs:
        beside = f"{run.wall:.1f} s by the clock, {run.memory:.0f} MiB"
        if before:
            steps = [np.log(getattr(run, of) / getattr(before[1], of)) for of in ("cpu", "memory")]
            time, memory = np.array(steps) / np.log(size / before[0])
            beside += f"; exponents {time:.2f} of time, {memory:.2f} of memory"
        yield waits.Row(f"{what}: {size:,}", None, run.cpu, "s", beside)
        before = size, run


if __name__ == "__main__":
    waits.main("scale", __doc__, scale, page=waits.PAGE.parent / "method/speed.md")
