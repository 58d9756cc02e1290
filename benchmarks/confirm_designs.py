"""Designs that hold, confirmed at their worst fill by other seeds and by other friction: a table.

Example: python docs/designs.py parts/washer_m6.stl --keep runs
         python benchmarks/confirm_designs.py runs parts        (the parts are looked for in `parts`)

Each bowl file of the folder whose design holds is followed again at its worst fill: by two other seeds, and
by its own seed at 0.7 and 1.3 times its friction. A run is confirmed where nothing jams, the rate is at least
nine tenths of the target, and 97 % of what leaves is as wanted. With ``--csv FILE`` each run is a line there,
and what stands in it is not run again.
"""

import argparse
import csv
import json
import re
import shlex
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import feederscrew as fs
from feederscrew import bowl as bowls
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import HELD, RATE_KEPT, SHOWN_PURITY
from feederscrew.designing.calm_drive import scale_friction
from feederscrew.trials.fills import FilledQueue

SEED, SEEDS = 1, (2, 3)  # of the designs, and others
FRICTION_SHARES = (0.7, 1.3)  # [1] of the design's friction
SECONDS = 60.0  # [s] of each queue
PARTS = 2  # of each orientation, one at a time, beside the queue
MINUTE = 60.0  # [s]
HEAD = ("part", "wanted", "fill", "seed", "friction", "rate", "right", "left", "jams", "confirmed", "cpu_s")


@dataclass(frozen=True)
class KeptDesign:
    """A design of a folder, with its part."""

    name: str
    result: dict[str, Any]  # ``design.json``
    bowl: Bowl
    part: fs.Part

    def follow(self, seed: int, friction: float) -> FilledQueue:
        """Return its worst fill, followed by a seed at a share [1] of its friction."""
        wanted, up = self.result["wanted"], tuple(self.result.get("up") or ())
        fill = fs.TrialQueue(self.result["worst_fill"], wanted=wanted, up=up)
        bowl = scale_friction(self.bowl, friction)
        study = fs.trial(self.part, bowl, parts=PARTS, queue=fill, seconds=SECONDS, seed=seed)
        filled = study.runs[0].filled
        if filled is None:
            raise RuntimeError(f"{self.name}: its queue was not followed")
        return filled

    def is_confirmed(self, filled: FilledQueue) -> bool:
        """Tell whether a queue does what the design promises."""
        least = RATE_KEPT * self.result["target_per_minute"] / MINUTE
        is_pure = filled.right > 0 and filled.right >= SHOWN_PURITY * filled.left
        return not filled.jams and filled.rate >= least and is_pure


def read_designs(runs: Path, folders: list[Path]) -> Iterator[KeptDesign]:
    """Yield each design of a folder that holds, with its part from the first of some folders that has it."""
    for path in sorted(runs.glob("*.yaml")):
        result = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
        if result["status"] not in HELD:
            continue
        stem = re.sub(r"-[\d.]+_min.*", "", path.stem)
        places = [folder / f"{stem}.stl" for folder in folders]
        file = next((place for place in places if place.exists()), None)
        if file is None:
            print(f"{stem}: no such file in {', '.join(map(str, folders))}", file=sys.stderr)
            continue
        words = shlex.split(result.get("more", ""))
        density = words[words.index("--density") + 1] if "--density" in words else None
        part = fs.load(file) if density is None else fs.load(file, density=density)
        yield KeptDesign(stem, result, bowls.read(path), part)


def main() -> int:
    """Follow each design anew; the exit status is 1 where one is not confirmed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("runs", type=Path)
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--csv", type=Path)
    asked = parser.parse_args()
    rows: list[dict[str, str]] = []
    if asked.csv is not None and asked.csv.exists():
        with asked.csv.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    done = {(row["part"], row["seed"], row["friction"]) for row in rows}
    for design in read_designs(asked.runs, asked.folders):
        runs = [*((seed, 1.0) for seed in SEEDS), *((SEED, share) for share in FRICTION_SHARES)]
        for seed, friction in runs:
            if (design.name, str(seed), str(friction)) in done:
                continue
            begun = time.process_time()
            filled = design.follow(seed, friction)
            values = (
                design.name, design.result["wanted"], filled.fill, seed, friction,
                f"{MINUTE * filled.rate:.3g}", filled.right, filled.left, filled.jams,
                design.is_confirmed(filled), f"{time.process_time() - begun:.0f}",
            )  # fmt: skip
            rows.append(dict(zip(HEAD, map(str, values), strict=True)))
            print(" ".join(rows[-1].values()), flush=True)
            if asked.csv is not None:
                with asked.csv.open("w", encoding="utf-8", newline="") as file:
                    out = csv.DictWriter(file, HEAD, lineterminator="\n")
                    out.writeheader()
                    out.writerows(rows)
    confirmed = sum(row["confirmed"] == "True" for row in rows)
    print(f"{confirmed} of {len(rows)} runs confirmed")
    return int(confirmed < len(rows))


if __name__ == "__main__":
    sys.exit(main())
