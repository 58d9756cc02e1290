"""How fast a batch goes, what memory it takes, and that a kill costs nothing but time.

Example: python benchmarks/batch.py              (parts per second for 1 and 2 jobs and Dask)
         python benchmarks/batch.py memory 1000  (memory while so many parts are computed)
         python benchmarks/batch.py kill 300     (killed ten times at random and resumed, byte for byte)
"""

import os
import random
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CALL = [sys.executable, "-c", "from feederscrew_cli.main import feeder; feeder()", "batch"]
FEW, KILLS = 24, 10
SEED = 20260101


def main():
    """One of the three, in a folder that is gone afterwards."""
    what, count = (sys.argv[1:] + ["speed", str(FEW)][len(sys.argv) - 1 :])[:2]
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        generate(work / "in", int(count))
        {"speed": speed, "memory": memory, "kill": kill}[what](work, int(count))


def generate(folder, count):
    """L-shaped brackets of random sizes as binary STL."""
    folder.mkdir()
    chance = random.Random(SEED)
    for number in range(count):
        a, b, c, t = (
            chance.uniform(15, 30),
            chance.uniform(10, 25),
            chance.uniform(5, 20),
            chance.uniform(1, 4),
        )
        profile = [(0, 0), (a, 0), (a, t), (t, t), (t, b), (0, b)]
        (folder / f"bracket_{number:04}.stl").write_bytes(extruded(profile, c))


def extruded(profile, depth):
    """An L profile along z as a closed surface."""
    caps = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    facets = [[(*profile[k], depth) for k in cap] for cap in caps]
    facets += [[(*profile[k], 0.0) for k in reversed(cap)] for cap in caps]
    for p, q in zip(profile, [*profile[1:], profile[0]]):
        facets += [[(*p, 0.0), (*q, 0.0), (*q, depth)], [(*p, 0.0), (*q, depth), (*p, depth)]]
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *sum(map(tuple, facet), ()), 0) for facet in facets)
    return bytes(80) + struct.pack("<I", len(facets)) + rows


def speed(work, count):
    """Parts a second, tables only and with pictures."""
    crews = {"1 job": ["--jobs", "1"], "2 jobs": ["--jobs", "2"]}
    with cluster(work) as address:
        if address:
            crews["Dask, 2 workers"] = ["--scheduler", address]
        for pictures in ([], ["--no-pictures"]):
            for crew, options in crews.items():
                start = time.perf_counter()
                batch(work / "in", work / f"{crew}{len(pictures)}", *options, *pictures)
                rate = count / (time.perf_counter() - start)
                print(f"{crew:16} {'tables only' if pictures else 'pictures   '}  {rate:6.2f} parts/s")


class cluster:
    """A Dask scheduler and two workers, where distributed is installed; else None."""

    def __init__(self, work):
        self.work, self.running = work, []

    def __enter__(self):
        try:
            import distributed
        except ImportError:
            print("Dask: not installed, left out")
            return None
        place = ["--scheduler-file", str(self.work / "scheduler.json"), "--no-dashboard"]
        for kind, more in (
            ("scheduler", ["--port", "0"]),
            *[("worker", ["--nthreads", "1", "--no-nanny"])] * 2,
        ):
            call = [sys.executable, "-m", f"distributed.cli.dask_{kind}", *place, *more]
            quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
            self.running.append(subprocess.Popen(call, cwd=self.work, env=environment(), **quiet))
        with distributed.Client(scheduler_file=place[1], timeout=60, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
            return client.scheduler.address

    def __exit__(self, *fault):
        for process in self.running:
            process.kill()
            process.wait()


def memory(work, count):
    """Memory of the whole family of processes at each tenth of a long batch."""
    out = work / "out"
    call = [*CALL, str(work / "in"), "-o", str(out), "--jobs", "2", "-q", "--no-pictures"]
    child = subprocess.Popen(call, env=environment(), stdout=subprocess.DEVNULL, start_new_session=True)
    goal = count // 10
    while child.poll() is None:
        done = finished(out)
        if done >= goal:
            each = family(child.pid)
            print(f"{done:5} parts: main {each[0]:4.0f} MB, all {sum(each):5.0f} MB", flush=True)
            goal += count // 10
        time.sleep(0.05)


def family(leader):
    """Memory of each process of a session [MB], its leader's first; pages shared are counted once each."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if os.getsid(int(entry.name)) == leader:
                lines = (entry / "smaps_rollup").read_text().splitlines()
                kilobytes = next(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
                found.append((entry.name != str(leader), kilobytes / 1024))
        except OSError:
            continue
    return [megabytes for _, megabytes in sorted(found)] or [0.0]


def kill(work, count):
    """Killed at random points and resumed, against an undisturbed run."""
    whole, cut, chance = work / "whole", work / "cut", random.Random(SEED)
    batch(work / "in", whole, "--jobs", "2", "--no-pictures")
    call = [*CALL, str(work / "in"), "-o", str(cut), "--jobs", "2", "--no-pictures", "-q", "--resume"]
    for _ in range(KILLS):
        child = subprocess.Popen(call, env=environment(), stdout=subprocess.DEVNULL, start_new_session=True)
        goal = finished(cut) + chance.randint(1, count // KILLS)
        while finished(cut) < min(goal, count) and child.poll() is None:
            time.sleep(0.005)
        time.sleep(chance.uniform(0.0, 0.2))
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        print(f"killed with {finished(cut)} of {count} parts", flush=True)
    batch(work / "in", cut, "--jobs", "2", "--no-pictures", "--resume")
    same = subprocess.run(["diff", "-r", str(whole), str(cut)], capture_output=True)
    print("the same bytes" if same.returncode == 0 else same.stdout.decode())


def finished(out):
    """How many parts have their folder."""
    return sum(1 for _ in (out / "parts").glob("*")) if out.exists() else 0


def batch(source, out, *options):
    """One batch from start to end."""
    subprocess.run(
        [*CALL, str(source), "-o", str(out), "-q", *options],
        check=True,
        env=environment(),
        stdout=subprocess.DEVNULL,
    )


def environment():
    """This program on the path of every process."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}


if __name__ == "__main__":
    main()
