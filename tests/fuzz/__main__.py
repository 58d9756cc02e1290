"""Fuzzing by hand: for so many seconds, every kind of file in turn, each input another than all before.

Example: PYTHONPATH=tests:tests/support python -m fuzz 600
         PYTHONPATH=tests:tests/support python -m fuzz stl 123456   (one case again, told in full)

What was tried is kept in ``runs.csv``: of each run and kind the first seed, how many, and the seeds that were
at fault. The next run goes on behind the last seed of each kind.
"""

import csv
import sys
import time
from pathlib import Path

from fuzz import harness

FIRST = 40  # inputs that are not counted
KEPT = Path(__file__).with_name("runs.csv")
COLUMNS = ("kind", "first_seed", "inputs", "faults", "seeds_at_fault")


def main():
    """The exit status: 1 if anything is wrong."""
    if len(sys.argv) == 3:
        told = harness.fault(harness.Case(sys.argv[1], int(sys.argv[2])))
        print(told or "nothing is wrong")
        return int(bool(told))
    end = time.monotonic() + float(sys.argv[1] if sys.argv[1:] else 600)
    for seed in range(FIRST):  # compiles what these cases need, before their seconds are counted
        harness.fault(harness.Case(harness.TOGETHER, seed))
    first, before = next_seeds(KEPT)
    tried = dict.fromkeys(harness.KINDS, 0)
    bad = {kind: [] for kind in harness.KINDS}
    while time.monotonic() < end:
        for kind in harness.KINDS:
            start = first[kind] + tried[kind]
            count = harness.QUICK.get(kind, harness.ROUND)
            for case, call, fault in harness.run(harness.Case(kind, start + k) for k in range(count)):
                bad[kind].append(case.seed)
                print(f"{case.kind} {case.seed}: {call}: {fault.strip().splitlines()[-1]}", flush=True)
            tried[kind] += count
    keep(KEPT, first, tried, bad)
    count, faults = sum(tried.values()), sum(map(len, bad.values()))
    print(f"{count} inputs, {faults} faults; {before + count} inputs in all runs")
    return int(faults > 0)


def next_seeds(path):
    """The first seed of each kind that no run has tried, and how many inputs all have."""
    first, count = dict.fromkeys(harness.KINDS, 0), 0
    if path.exists():
        with path.open(newline="") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                begin, inputs = int(row["first_seed"]), int(row["inputs"])
                first[row["kind"]] = max(first.get(row["kind"], 0), begin + inputs)
                count += inputs
    return first, count


def keep(path, first, tried, bad):
    """Add what a run tried, a row a kind."""
    head = [] if path.exists() else [COLUMNS]
    with path.open("a", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerows(head)
        for kind, count in tried.items():
            rows.writerow([kind, first[kind], count, len(bad[kind]), " ".join(map(str, bad[kind]))])


if __name__ == "__main__":
    sys.exit(main())
