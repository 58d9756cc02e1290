"""Round bodies by the thousand: none may crash, and every answer must hold its invariants.

Example: PYTHONPATH=tests:tests/support python -m fuzz.rounds 2000        (bodies, from a seed of the clock's)
         PYTHONPATH=tests:tests/support python -m fuzz.rounds 2000 17     (from seed 17)
"""

import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path

import part_files
import round_bodies

MAY_MISS = 1e-9  # [1] what the probabilities of a rule may miss 1 by


def fault(triangles):
    """What is wrong with the resting aspects of a body (F, 3, 3) [mm], read from a file; '' if nothing."""
    from feederscrew.part import load
    from feederscrew.resting import aspects

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "body.stl")
        path.write_bytes(part_files.binary_stl(triangles))
        try:
            found = aspects.find(load(path))
        except Exception:  # noqa: BLE001 - any fault at all is what the search is for
            return traceback.format_exc().strip()
    sums = {rule: p.sum() for rule, p in found.chances.items()}
    wrong = [f"{rule} sums to {p}" for rule, p in sums.items() if abs(p - 1.0) > MAY_MISS]
    return "; ".join(wrong + list(found.ground.tips.doubts))


def main():
    """The exit status: 1 if anything is wrong."""
    count = int(sys.argv[1]) if sys.argv[1:] else 2000
    first = int(sys.argv[2]) if sys.argv[2:] else int(time.time())
    warnings.simplefilter("ignore")
    bad = 0
    for seed in range(first, first + count):
        if told := fault(round_bodies.body(seed)):
            bad += 1
            print(f"round body {seed}: {told.splitlines()[-1]}", flush=True)
    print(f"{count} round bodies from seed {first}, {bad} faults")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
