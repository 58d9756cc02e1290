"""The drop test by its own kernel and by the trial's, in turn in one run: shares, and drops a CPU second.

Example: python benchmarks/two_kernels.py lbracket_30x20x15 hexbolt_m8x25 --drops 600

The same launch, one restitution and one friction, onto a level floor at rest. A share counts as the same
where the two lie within twice the width of their intervals.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.dropping.ensemble import counted, drop, wilson
from feederscrew.dropping.launches import named
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import landing, runs
from feederscrew.trial.looks import OTHER, AspectsBelow

PARTS = Path(__file__).parent.parent / "parts"
BOUNCE, RUBS = 0.3, 0.4
LEVEL = (
    "track.radius=20 m", "track.width=1 m", "track.climb=0 deg", "track.bank=0 deg",
    f"restitution={BOUNCE}", f"friction.static={RUBS}", f"friction.kinetic={RUBS}",
)  # fmt: skip


def by_drops(below, launch, count):
    """Faces on which parts come to rest by the kernel of the drop test, and processor time [s]."""
    begun = time.process_time()
    faces = drop(below.shape, launch, np.random.default_rng(1), count=count).faces
    spent = time.process_time() - begun
    return below.rows[faces[faces >= 0]], spent


def by_trial(part, below, launch, count):
    """The same by the kernel of the trial, on a track as good as endless."""
    bowl = bowls.read(None, LEVEL)
    bowl = replace(bowl, drive=replace(bowl.drive, amplitude=0.0))
    every = orientations(part, find(part), bowl.track)
    begun = time.process_time()
    ride, _ = landing._fallen(part, bowl, every, below.shape, launch, count, RunSettings(1))
    spent = time.process_time() - begun
    rows = below.of(ride.states[ride.outcomes == runs.RUNNING])
    return rows[rows != OTHER], spent


def main():
    """Print a row a part."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("parts", nargs="+")
    asked.add_argument("--drops", type=int, default=600)
    chosen = asked.parse_args()
    launch = replace(named("drop"), restitution=(BOUNCE, BOUNCE), friction=(RUBS, RUBS))
    for name in chosen.parts:
        part = load(PARTS / f"{name}.stl")
        aspects = find(part)
        below = AspectsBelow(part, aspects)
        by_drops(below, launch, 2), by_trial(part, below, launch, 2)  # compiled
        told = [by_drops(below, launch, chosen.drops), by_trial(part, below, launch, chosen.drops)]
        shares, widths = [], []
        for rows, _ in told:
            counts = counted(rows, np.arange(len(aspects.names)), len(aspects.names))
            low, high = wilson(counts, len(rows))
            shares.append(counts / len(rows))
            widths.append(0.5 * (high - low))
        rates = [chosen.drops / spent for _, spent in told]
        apart = np.abs(shares[0] - shares[1])
        same = bool((apart <= 2.0 * np.hypot(*widths)).all())
        print(
            f"{name}: {rates[0]:.0f} and {rates[1]:.0f} drops a CPU second ({rates[0] / rates[1]:.1f} x), "
            f"largest difference of a share {apart.max():.3f}, {'the same' if same else 'NOT the same'} "
            f"within {2.0 * np.hypot(*widths).max():.3f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
