"""The rule that a part on its round side rolls back down the climb, against the trial of the bare track.

Run: .venv/bin/python benchmarks/rolling_back.py [parts of each orientation]

35 turned and headed parts on which no rule was fitted: cylinders, tapered pins, headed pins, discs on stems,
spools and balls on pins, at three banks and two drives. A row each that lies on its round side: what the rule
says, and of how many parts of the trial rolled back, went on, or did neither.
"""

import csv
import itertools
import sys

import numpy as np
import trimesh

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.base.running import RunSettings
from feederscrew.feeding import stream
from feederscrew.resting.aspects import find
from feederscrew.trials.long_ride import LEFT, ride_of_track

BANKS_DEG = (0.0, 3.0, 8.0)
DRIVES = (  # of throw numbers 2.2 and 0.89: in the second nothing hops
    {"amplitude": "0.16 mm", "frequency": "100 Hz", "vibration_angle": "20 deg", "phase": "0 deg"},
    {"amplitude": "0.21 mm", "frequency": "50 Hz", "vibration_angle": "25 deg", "phase": "0 deg"},
)
SECTIONS = 40
WAY_M = 0.2  # that a part has to go on to be carried


def profiles():
    """Yield names and half outlines [mm] of the parts."""
    for radius, length in ((3.0, 14.0), (4.0, 9.0), (6.0, 7.0), (2.5, 25.0), (8.0, 6.0)):
        yield f"cylinder {2 * radius:g} x {length:g}", [(0, 0), (radius, 0), (radius, length), (0, length)]
    for radius, end, length in (
        (4, 3.8, 16),
        (4, 3.4, 16),
        (5, 4, 10),
        (5, 2.5, 12),
        (6, 3, 20),
        (3, 2.8, 30),
    ):
        yield (
            f"taper {2 * radius:g} to {2 * end:g} x {length:g}",
            [(0, 0), (radius, 0), (end, length), (0, length)],
        )
    heads = itertools.product((3.0, 5.0), (1.0, 3.0), (8.0, 16.0))
    for shank, step, length in heads:
        head = shank + step
        yield f"pin {2 * shank:g} x {length:g}, head {2 * head:g}", [
            (0, 0), (head, 0), (head, 2.0), (shank, 2.0), (shank, 2.0 + length), (0, 2.0 + length),
        ]  # fmt: skip
    for disc, stem, length in ((8, 2, 6), (9, 4, 12), (7, 1.5, 20), (10, 5, 5), (6, 4.5, 9)):
        yield f"disc {2 * disc:g} on a stem of {2 * stem:g} x {length:g}", [
            (0, 0), (disc, 0), (disc, 1.5), (stem, 1.5), (stem, 1.5 + length), (0, 1.5 + length),
        ]  # fmt: skip
    for first, last, length in ((5, 5, 12), (5, 4.8, 12), (6, 5, 10), (7, 4, 14), (4, 4, 20)):
        yield f"spool {2 * first:g} and {2 * last:g} x {length:g}", [
            (0, 0), (first, 0), (first, 2), (2, 2),
            (2, length - 2), (last, length - 2), (last, length), (0, length),
        ]  # fmt: skip
    angles = np.linspace(-0.5 * np.pi, 0.42 * np.pi, 18)
    for radius, length in ((4.0, 10.0), (5.0, 6.0), (3.0, 15.0)):
        ball = [(radius * np.cos(a), radius * np.sin(a)) for a in angles]
        stem = ball[-1][0]
        yield (
            f"ball {2 * radius:g} on a pin x {length:g}",
            [(0, -radius), *ball[1:], (stem, radius + length), (0, radius + length)],
        )
    for top, neck, length in ((6, 3, 8), (8, 4, 12), (5, 4, 6), (9, 6, 10)):
        yield f"countersunk {2 * top:g}, {2 * neck:g} x {length:g}", [
            (0, 0), (top, 0), (neck, top - neck), (neck, top - neck + length), (0, top - neck + length),
        ]  # fmt: skip


def rows(count):
    """Yield a row for each orientation on a round side, at each bank and drive."""
    for name, outline in profiles():
        mesh = trimesh.creation.revolve(np.array(outline, float), sections=SECTIONS)
        part = parts.load((1e-3 * mesh.vertices, mesh.faces), density="steel")
        aspects = find(part)
        for drive, bank in itertools.product(DRIVES, BANKS_DEG):
            lines = [
                *(f"drive.{key}={value}" for key, value in drive.items()),
                *("track.climb=3 deg", f"track.bank={bank} deg", "track.radius=150 mm", "track.width=40 mm"),
            ]
            bowl = bowls.read(None, lines)
            lying = stream.follow_orientations(part, aspects, bowl.track, bowl=bowl).lying
            chosen = [k for k, one in enumerate(lying) if one.kind == "rolling" and not one.returned]
            if not chosen:
                continue
            run = RunSettings(1, jobs=1)
            ride = ride_of_track(part, bowl, lying, chosen, repeats=count, distance=WAY_M, run=run)
            for k in chosen:
                own = ride.entry_rows == k
                ways, left = ride.distances[own], ride.end_rows[own] == LEFT
                yield {
                    "part": name,
                    "hz": drive["frequency"],
                    "bank": bank,
                    "orientation": lying[k].name,
                    "circle_mm": round(1e3 * lying[k].posture.rolling_circle, 2),
                    "rule_back": int(lying[k].may_roll_back),
                    "unsure": int(lying[k].may_turn),
                    "back": int((ways < 0.0).sum()),
                    "off": int((left & (ways >= 0.0)).sum()),
                    "carried": int((ways >= 0.9 * WAY_M).sum()),
                    "parts": count,
                    "way_mm": round(1e3 * float(np.median(ways)), 1),
                }


def main():
    """Write the rows, and how often the rule is right."""
    table = None
    wrong = {"back": 0, "carried": 0}
    total = dict(wrong)
    for row in rows(int(sys.argv[1]) if len(sys.argv) > 1 else 4):
        if table is None:
            table = csv.DictWriter(sys.stdout, row)
            table.writeheader()
        table.writerow(row)
        sys.stdout.flush()
        went_back, carried = 2 * row["back"] > row["parts"], 2 * row["carried"] > row["parts"]
        if row["rule_back"]:
            total["back"] += 1
            wrong["back"] += carried
        else:
            total["carried"] += 1
            wrong["carried"] += went_back
    for verdict, count in total.items():
        print(f"# rule says {verdict}: {count} rows, the trial differs in {wrong[verdict]}")


if __name__ == "__main__":
    main()
