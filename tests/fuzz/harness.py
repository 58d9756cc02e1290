"""Damaged files given to the program, in a process that may be watched and killed."""

import contextlib
import functools
import json
import multiprocessing
import resource
import signal
import tempfile
import traceback
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from fuzz import mutate, readers, together, valid

ROOT = Path(__file__).parent.parent.parent
PATIENCE = 10.0  # [s] of computing for one input
STUCK = 60.0  # [s] on the clock without computing, for one that waits without end
MEMORY = 768 << 10  # [kB] for a file under 1 MB; the program itself takes the rest of a gigabyte
CARD, NUT = (str(ROOT / "parts" / name) for name in ("magnet.yaml", "squarenut_m5.stl"))
STL = "parts/lbracket_30x20x15.stl parts/squarenut_m5.stl parts/key_a_d12x20.stl"
COUNTED = "feederscrew/thesis/data/table_3_07.csv feederscrew/thesis/data/table_3_08.csv"
OUT = "--no-pictures -o out"
PLAN = {  # seeds, how the damaged file is called, and what reads it
    "stl": (STL, "part.stl", f"aspects FILE {OUT}", "inertia FILE --allow-open -o out",
            f"aspects FILE --all --allow-open {OUT}", f"headings FILE --aspect A {OUT}",
            "rate FILE --aspect A -o out"),
    "bowl": ("configs/bowl.yaml configs/thesis.yaml", "bowl.yaml", "config show --config FILE",
             f"convey --config FILE {OUT}", f"rate {NUT} --aspect A --config FILE -o out"),
    "card": ("parts/magnet.yaml parts/arc_chute.yaml", "card.yaml", f"aspects FILE {OUT}",
             "inertia FILE -o out"),
    "counts": (COUNTED, "counts.csv", f"compare {CARD} --with FILE {OUT}"),
    "names": ("tests/fuzz/names.yaml", "names.yaml", f"aspects {NUT} --names FILE {OUT}"),
    "list": ("tests/fuzz/list.csv", "list.csv", "gather FILE"),
    "batch": ("tests/fuzz/list.csv", "list.csv", f"batch FILE --rule csa --jobs 1 {OUT}"),
    "dxf": ("tests/fuzz/hole.dxf", "hole.dxf", "config show --config bowl.yaml"),
}  # fmt: skip
PARTS_OF_LIST = {"nut.stl": "parts/squarenut_m5.stl", "bracket.stl": "parts/key_a_d12x20.stl"}
BESIDE = {  # files that lie beside the damaged one, whole
    "batch": PARTS_OF_LIST | {"bowl.yaml": "configs/bowl.yaml"},
    "dxf": {"bowl.yaml": "tests/fuzz/hole.yaml"},
}
PARTLY = ("batch",)  # commands that keep what went well beside what failed
TOGETHER = "together"  # the kind of case in which a part, a bowl and the options are damaged at once
DAMAGED = {f"odd {name.removeprefix('valid ')}": name for name in valid.MAKERS}  # valid files, damaged
KINDS = (*PLAN, *readers.READERS, *valid.MAKERS, *DAMAGED, TOGETHER)
ROUND = 50  # inputs of one kind at a time
QUICK = {  # of readers, so that each takes some seconds
    "read stl": 1500, "read open stl": 1500, "read bowl": 300, "read verified": 300,
    "read card": 300, "read names": 300, "read cache": 2000, "read obj": 500, "read ply": 500,
    "read off": 500, "read glb": 200, "read 3mf": 500, "read 3mf model": 500,
    **dict.fromkeys(valid.MAKERS, 300), **dict.fromkeys(DAMAGED, 300),
    "read counts": 4000, "read list": 2000, "read launches": 4000, "read dxf": 1000,
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """One damaged file and the command that reads it; the seed makes it again."""

    kind: str
    seed: int

    def build(self):
        """The bytes of each file by its name, and the arguments."""
        rng = np.random.default_rng(self.seed)
        if self.kind == TOGETHER:
            return together.job(ROOT, rng)
        if self.kind in valid.MAKERS:
            file = valid.make(self.kind, rng)
            return {file.name: file.data, **file.beside}, ["valid", file.name]
        if self.kind in DAMAGED:
            first, second = (valid.make(DAMAGED[self.kind], rng) for _ in range(2))
            return {first.name: mutate.mutated(first.data, second.data, rng), **first.beside}, [
                "odd",
                first.name,
            ]
        if self.kind in readers.READERS:
            seeds, name, _ = readers.READERS[self.kind]
            calls = ["read FILE"]
        else:
            seeds, name, *calls = PLAN[self.kind]
            seeds = seeds.split()
        first, second = ((ROOT / mutate.pick(seeds, rng)).read_bytes() for _ in range(2))
        call = mutate.pick(calls, rng)
        whole = {beside: (ROOT / path).read_bytes() for beside, path in BESIDE.get(self.kind, {}).items()}
        damaged = {name: mutate.mutated(first, second, rng)}
        return whole | damaged, [name if word == "FILE" else word for word in call.split()]


def run(cases):
    """What is wrong, as (case, arguments, fault); a hung or dead process is one fault and goes on."""
    context, faults, child = multiprocessing.get_context("fork"), [], None
    _warm()
    for case in cases:
        process, line = child = child or _child(context)
        line.send(case)
        try:
            fault = answer(process.pid, line)
        except EOFError:
            process.join()
            hung = process.exitcode == -signal.SIGPROF
            fault = f"computed for {PATIENCE:g} s" if hung else f"the process died ({process.exitcode})"
        if fault:
            faults.append((case, " ".join(case.build()[1]), fault))
        if fault and not fault.startswith("Traceback"):
            process.kill()
            process.join()
            child = None
    if child:
        child[1].close()
        child[0].join()
    return faults


def answer(pid, line):
    """What a process says of its case; a fault where it has stood still, however slow a busy machine is."""
    before = None
    while not line.poll(STUCK):
        computed = computed_ticks(pid)
        if computed == before:
            return f"no answer in {STUCK:g} s"
        before = computed
    return line.recv()


def computed_ticks(pid):
    """Ticks that a process has computed for, of itself and for the system; None where nobody says."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    return int(fields[11]) + int(fields[12])


@functools.cache
def _warm():
    """Import before the first process is forked what every one needs; drop and feed few parts."""
    from feederscrew.arrivals import arrival
    from feederscrew.arrivals import aspects_study as aspects

    aspects.MAX_DROPS = arrival.FIRST_PARTS = arrival.MAX_ARRIVALS = arrival.LONGER_TIME_PARTS = 20
    for kind in (*PLAN, *readers.READERS, *valid.MAKERS):
        fault(Case(kind, 0))


def _child(context):
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, ours))  # which may have children itself
    process.start()
    theirs.close()
    return process, ours


def _serve(line, other):
    other.close()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with contextlib.suppress(EOFError):
        while True:
            case = line.recv()
            signal.setitimer(signal.ITIMER_PROF, PATIENCE)
            told = fault(case)
            signal.setitimer(signal.ITIMER_PROF, 0)
            used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
            if not told and used > MEMORY:
                told = f"took {used >> 10} MB"
            line.send(told)


def fault(case):
    """What is wrong with how one case ends; '' if nothing is."""
    files, (command, *rest) = case.build()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for name, data in files.items():
            Path(name).write_bytes(data)
        if command == "valid":
            file = valid.make(case.kind, np.random.default_rng(case.seed))
            return readers.outcome(valid.fault, file)
        if command == "odd":
            return readers.outcome(valid.read, *rest)
        if command in ("read", "gather"):
            return readers.fault(case.kind if command == "read" else "read list", *rest)
        return _called([command, *rest])


def _called(arguments):
    from click.testing import CliRunner

    from feederscrew_cli.main import feeder

    with warnings.catch_warnings(record=True) as noise:
        warnings.simplefilter("always")
        done = CliRunner().invoke(feeder, arguments)
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        return "".join(traceback.format_exception(*done.exc_info))
    if done.exit_code not in (0, 1, 2):
        return f"exit status {done.exit_code}"
    if done.exit_code and not (done.stderr.strip() and "Error: " in done.stderr):
        return f"status {done.exit_code} without a reason: {done.stderr}"
    if noise:
        return f"Python warns: {noise[0].message} ({noise[0].filename}:{noise[0].lineno})"
    return "" if arguments[0] in PARTLY else _half_written(Path("out"), done.exit_code)


def _half_written(out, status):
    """Results are there whole with their record, or not at all."""
    files = [p for p in out.rglob("*") if p.is_file()] if out.exists() else []
    if status:
        return f"failed, but wrote {files[0]}" if files else ""
    for record in out.rglob("run.json"):
        listed = {f for entry in json.loads(record.read_text()).values() for f in entry["files"]}
        there = {p.relative_to(record.parent).as_posix() for p in record.parent.rglob("*") if p.is_file()}
        if listed | {"run.json"} != there:
            return f"wrote {sorted(there)}, recorded {sorted(listed)}"
    return "a temporary file is left" if any(p.name.startswith(".") for p in files) else ""
