"""Which orientations last on a ride along bare track: the table of docs/trial.md.

Example: python benchmarks/long_ride.py pan_m4x10.stl      (a screw, hopping; each orientation ten times)

50 Hz, 20 deg, throw number 1.79, track of 150 mm radius, climb and bank 3 deg, friction 0.6; 450 mm.
"""

import sys

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base.running import RunSettings
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.trials.long_ride import LEFT, ride_of_track

BOWL = (
    "drive.amplitude=0.5186 mm", "drive.frequency=50 Hz", "drive.vibration_angle=20 deg",
    "friction.static=0.6", "track.radius=150 mm", "track.width=30 mm", "track.climb=3 deg",
    "track.bank=3 deg",
)  # fmt: skip
SETTINGS = ((0.0, 0.6), (0.3, 0.6), (0.3, 0.4), (0.3, 0.3), (0.3, 0.0))  # restitution, friction of the wall
PARTS, DISTANCE, SEED = 10, 0.45, 3


def main(path):
    part = load(path)
    print("| Restitution | Friction of the wall | Begins | Velocity [mm/s] | Stays | Becomes | Left |")
    for restitution, wall in SETTINGS:
        bowl = bowls.read(None, (*BOWL, f"restitution={restitution}", f"friction.wall={wall}"))
        every = orientations(part, find(part), bowl.track)
        run = RunSettings(SEED)
        ride = ride_of_track(part, bowl, every, range(len(every)), repeats=PARTS, distance=DISTANCE, run=run)
        for row in ride.rows:
            own = ride.entry_rows == row
            stays = own & (ride.end_rows == row)
            speeds = 1e3 * ride.distances[stays] / ride.seconds[stays]
            ends = sorted({every[k].name for k in ride.end_rows[own] if k not in (row, LEFT)})
            print(
                f"| {restitution:g} | {wall:g} | {every[row].name} |"
                f" {np.median(speeds) if len(speeds) else np.nan:.0f} | {stays.sum()} of {own.sum()} |"
                f" {', '.join(ends) or '-'} | {(ride.end_rows[own] == LEFT).sum()} |"
            )


if __name__ == "__main__":
    main(sys.argv[1])
