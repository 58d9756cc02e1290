"""What steps and ledges turn in trials, beside what the static rule is sure of: the figures of docs/trial.md.

Example: python benchmarks/trial_turning.py                  (four blocks, minutes)
         python benchmarks/trial_turning.py some/part.stl

Counted by aspect, for which the rule answers; whether a part has come to lie along the wall again within two
lengths as well is told beside.
"""

import sys
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.part import load
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import made
from feederscrew.trial import course, looks, runs

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
import shapes

OWN = (
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=2 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
)  # fmt: skip
BLOCKS = ((20, 12, 5), (25, 10, 8), (15, 9, 6), (14, 13, 4))  # [mm]
DEVICES = (("step", 4), ("step", 8), ("step", 12), ("tip", 3), ("tip", 6), ("tip", 10))  # [mm]
TRIED, CLEAR = 4, 2.5e-4  # trials of an orientation; [m] margin from which a verdict is clear


def counted(part, kind, limit):
    """Clear verdicts tried, those on the aspect said, those that left as said, and parts without one."""
    bowl, aspects = bowls.read(None, OWN), find(part)
    device = made(kind, "here", limit=1e-3 * limit, text=f"{limit} mm")
    ways = stream.orientations(part, aspects, bowl.track, (device,), bowl=bowl)
    every, below = range(len(ways.lying)), looks.AspectsBelow(part, aspects)
    own = {"poses": ways.states, "leaves": course.rightly(ways.leaving), "run": RunSettings(5, 2)}
    sent = course.Sending(every, TRIED * len(every))
    seen = course.course(part, bowl, ways.lying, sent, (device,), **own)
    if len(seen.rides) < 2:
        return np.zeros(4, int)
    ride, riders = seen.rides[-1], seen.riders[-1]
    entered, names = seen.entered[riders], np.array([*aspects.names, ""])
    clear = (ways.sure & (ways.margin > CLEAR))[entered]
    lies = names[below.of(ride.states)]
    said = [{ways.states[m].aspect for m in np.flatnonzero(ways.leaving[k])} for k in entered]
    right = (ride.outcomes == runs.PASSED) & [one in told for one, told in zip(lies, said)]
    as_said = seen.fates[riders] == course.PASSED
    return np.array([clear.sum(), (clear & right).sum(), (clear & as_said).sum(), (~clear).sum()])


def main(files):
    parts = [load(name) for name in files] or [shapes.part(shapes.box(*sides)) for sides in BLOCKS]
    whole = {"step": np.zeros(4, int), "tip": np.zeros(4, int)}
    for part in parts:
        for kind, limit in DEVICES:
            found = counted(part, kind, limit)
            whole[kind] += found
            print(f"{part.name} {kind} {limit} mm: clear {found[0]}, on the aspect said {found[1]}, "
                  f"leave as said {found[2]}; no clear verdict {found[3]}", flush=True)  # fmt: skip
    for kind, (clear, right, as_said, others) in whole.items():
        met = "met" if right >= 0.95 * clear else "MISSED"
        print(f"{kind}: {right} of {clear} clear verdicts on the aspect said (95 % asked): {met}; "
              f"{as_said} leave as said; {others} parts without a clear verdict")  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1:])
