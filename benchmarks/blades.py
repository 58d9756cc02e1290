"""How fast swept blades clear parts off the track, beside the formula: a table of docs/method/tooling.md.

Example: python benchmarks/blades.py parts OTHER_FOLDER      (five minutes of one core for 23 parts)
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.base.running import RunSettings
from feederscrew.base.units import GRAVITY
from feederscrew.bowl.devices.base import RETURNED
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.resting.aspects import find
from feederscrew.sorting.falling import along_blade
from feederscrew.sorting.orientations import add_travel, orientations
from feederscrew.sorting.verdicts import DeviceEncounter, verdict
from feederscrew.trials import course
from feederscrew.trials.course import Fate

DRIVES = ((50, 25, 0.95), (50, 25, 1.3), (50, 20, 1.8), (100, 20, 2.2))  # [Hz], [deg], throw number
BLADES = ((20, 0.6), (30, 0.6), (30, 0.3), (45, 0.6))  # sweep [deg] and friction [1] of the face
COUNT, SEED, ROWS, SHARE = 2, 3, 3, 0.03  # parts, seed, orientations of a part, each at least so frequent
HEIGHT, SPARE = 0.6, 1.5e-3  # of the part, where the blade's edge is; [m] of track beside what lies on it
BEGINS = 7e-4  # [m] nearer to the free edge than it came: then it slides along the blade
RADIUS = 0.15  # [m]


def setting(drive, width):
    """Return a bowl with a drive of DRIVES and a track of a width [m]."""
    hertz, degrees, throw = drive
    rises = throw * GRAVITY / (2.0 * np.pi * hertz) ** 2
    return bowls.read(None, (
        f"drive.amplitude={1e3 * rises / np.sin(np.radians(degrees)):.5f} mm", f"drive.frequency={hertz} Hz",
        f"drive.vibration_angle={degrees} deg", "drive.phase=0 deg", "track.climb=3 deg", "track.bank=3 deg",
        f"track.radius={1e3 * RADIUS} mm", f"track.width={1e3 * width:.1f} mm",
    ))  # fmt: skip


def swept(part, aspects, drive):
    """Yield each blade, and of each part that slid off along it the ratio of its speed to the formula's.

    NaN of a part that stood there.
    """
    wide = setting(drive, 1.1 * float(np.ptp(part.vertices, axis=0).max()))
    every = orientations(part, aspects, wide.track)
    chances = np.array([max(np.nan_to_num(list(one.chances.values()))) for one in every])
    rows = [k for k in np.argsort(-chances) if chances[k] > SHARE and not every[k].returned]
    for row in rows[:ROWS]:
        bowl = replace(wide, track=replace(wide.track, width=round(every[row].width + SPARE, 4)))
        here = add_travel(orientations(part, aspects, bowl.track), bowl)
        for degrees, friction in BLADES:
            limit, sweep = round(HEIGHT * here[row].height, 5), np.radians(degrees)
            blade = make_device("wiper", "here", limit=limit, sweep=sweep, friction=friction)
            fate = blade.fate(DeviceEncounter(here[row], here))
            if verdict(blade, here[row], here).passes > 0.0 or fate != RETURNED:
                continue
            formula = along_blade(bowl, sweep, friction)
            sent = course.SentParts([int(row)], COUNT)
            followed = course.course(part, bowl, here, sent, (blade,), run=RunSettings(SEED))
            for n, rider in enumerate(followed.riders[1] if len(followed.riders) > 1 else ()):
                path = followed.rides[1].paths[n]
                path = path[np.isfinite(path[:, 0])]
                off = RADIUS - np.hypot(path[:, 1], RADIUS - path[:, 2])
                moved = np.flatnonzero(off > np.median(off[:5]) + BEGINS)
                if followed.fates[rider] == Fate.RETURNED and len(moved):
                    time = path[0, 0] + followed.rides[1].seconds[n] - path[moved[0], 0]
                    way = bowl.track.width - np.median(off[:5]) - BEGINS
                    yield (degrees, friction), way / time / formula if formula > 0.0 else np.inf
                elif followed.fates[rider] == Fate.STOPPED:
                    yield (degrees, friction), np.nan


def main():
    """Print the table."""
    files = [path for folder in sys.argv[1:] or ["parts"] for path in sorted(Path(folder).glob("*.stl"))]
    table = {}
    for path in files:
        part = parts.load(path)
        aspects = find(part)
        for drive in DRIVES:
            for blade, ratio in swept(part, aspects, drive):
                table.setdefault((drive, blade), []).append(ratio)
    print("| drive | blade | swept off | stand | speed over the formula's: 10 %, median, 90 % |")
    print("|---|---|---|---|---|")
    for ((hertz, degrees, throw), (sweep, friction)), ratios in sorted(table.items()):
        off = np.array(ratios)[np.isfinite(ratios)]
        ends = " ".join(f"{x:.2f}" for x in np.percentile(off, (10, 50, 90))) if len(off) else "-"
        drive, blade = f"{hertz} Hz, {degrees} deg, {throw}", f"{sweep} deg, {friction}"
        print(f"| {drive} | {blade} | {len(off)} | {int(np.isnan(ratios).sum())} | {ends} |")


if __name__ == "__main__":
    main()
