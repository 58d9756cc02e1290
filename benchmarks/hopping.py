"""Velocities of hopping bodies, beside an independent rigid-body code: a table of docs/method/validation.md.

Example: python benchmarks/hopping.py 20 > rows.md      (parts of each setting; five minutes of one core)
"""

import csv
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests/support"))
import shapes

from feederscrew import bowl as bowls
from feederscrew.base.running import RunSettings
from feederscrew.motion import conveying as answer
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.trials import long_ride

REFERENCE = Path(__file__).parent.parent / "docs/measured/held_out/hopping.csv"
RUN_UP, WAY, SEED = 0.02, 0.04, 3  # [m] the run up is left out
BODIES = {  # mesh, length and height as it travels [mm]
    "block": (shapes.box(20, 12, 6), 20.0, 6.0),
    "tall": (shapes.box(8, 8, 20), 8.0, 20.0),
    "cyl": (shapes.cylinder(5, 14, 64), 10.0, 14.0),
    "cube": (shapes.box(12, 12, 12), 12.0, 12.0),
}
OFFSET = np.array([2.5e-3, 0.0, 0.0])  # [m] of the cube's mass, which lies behind its middle at heading 0
TRACK = (
    "drive.frequency=60 Hz", "drive.vibration_angle=25 deg", "track.climb=3 deg", "track.bank=0 deg",
    "track.radius=20 m", "track.width=80 mm",
)  # fmt: skip
long_ride.OFF_LEVEL = np.radians(0.05)  # as the reference starts


def velocity(row, count):
    """Return our mean velocity [mm/s], its standard error, that of a point, and the share that turned."""
    mesh, length, height = BODIES[row["body"]]
    part = shapes.part(mesh, row["body"])
    if row["body"] == "cube":
        part = replace(part, centre_of_mass=part.centre_of_mass + OFFSET)
    stroke, friction = 0.16332583 * float(row["throw_number"]), f"friction.static={row['mu']}"
    own = (f"drive.amplitude={stroke} mm", friction, f"restitution={row['restitution']}")
    bowl = bowls.read(None, (*TRACK, *own))
    every = orientations(part, find(part), bowl.track)
    sizes = [abs(1e3 * one.length - length) + abs(1e3 * one.height - height) for one in every]
    start = int(np.argmin([round(size, 1) + 0.01 * one.heading for size, one in zip(sizes, every)]))
    first, ride = (
        long_ride.ride_of_track(
            part, bowl, every, [start], repeats=count, distance=way, run=RunSettings(SEED)
        )
        for way in (RUN_UP, WAY)
    )
    ways, seconds = ride.distances - first.distances, ride.seconds - first.seconds
    speeds = 1e3 * ways[seconds > 0.0] / seconds[seconds > 0.0]
    error = speeds.std(ddof=1) / len(speeds) ** 0.5
    return speeds.mean(), error, 1e3 * answer.answer(bowl).velocity, (ride.end_rows != start).mean()


def main(count):
    lines = [line for line in REFERENCE.read_text().splitlines() if not line.startswith("#")]
    print("| body | throw | friction | restitution | other [mm/s] | ours [mm/s] | point [mm/s] | | turned |")
    print("| --- " * 9 + "|")
    gaps, sure = [], []
    for row in csv.DictReader(lines):
        ours, error, point, turned = velocity(row, count)
        other, theirs = float(row["velocity_mm_s"]), float(row["standard_error"])
        gaps.append(abs(ours / other - 1.0))
        sure.append(abs(ours - other) > 2.0 * np.hypot(error, theirs))
        setting = " | ".join(row[name] for name in ("body", "throw_number", "mu", "restitution"))
        turns = f"{float(row['turned']):.2f} and {turned:.2f}"
        speeds = f"{other:.1f} ({theirs:.1f}) | {ours:.1f} ({error:.1f}) | {point:.1f}"
        print(f"| {setting} | {speeds} | {100 * (ours / other - 1.0):+.0f} % | {turns} |", flush=True)
    far = np.array(gaps) >= 0.1
    print(f"\nmedian difference {100 * np.median(gaps):.1f} %; {np.sum(~far)} of {len(far)} within 10 %;")
    print(f"{np.sum(far & sure)} beyond 10 % and twice the standard errors")


if __name__ == "__main__":
    main(int(sys.argv[1]))
