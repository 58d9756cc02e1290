"""Fuzzing by hand: for so many seconds, every kind of file in turn.

Example: PYTHONPATH=tests python -m fuzz 600
         PYTHONPATH=tests python -m fuzz stl 123456   (one case again, told in full)
"""

import sys
import time

from fuzz import harness

FIRST = 40  # inputs that are not counted
ROUND = 50  # inputs of one kind at a time


def main():
    """The exit status: 1 if anything is wrong."""
    if len(sys.argv) == 3:
        told = harness.fault(harness.Case(sys.argv[1], int(sys.argv[2])))
        print(told or "nothing is wrong")
        return int(bool(told))
    end, first, count, bad = time.monotonic() + float(sys.argv[1] if sys.argv[1:] else 600), 0, 0, 0
    first = int(time.time()) * 1000
    for seed in range(FIRST):  # compiles what these cases need, before their seconds are counted
        harness.fault(harness.Case(harness.TOGETHER, seed))
    while time.monotonic() < end:
        for kind in harness.KINDS:
            cases = [harness.Case(kind, first + k) for k in range(ROUND)]
            for case, call, fault in harness.run(cases):
                bad += 1
                print(f"{case.kind} {case.seed}: {call}: {fault.strip().splitlines()[-1]}", flush=True)
            count += ROUND
        first += ROUND
    print(f"{count} inputs, {bad} faults")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
