"""What the static rule says of every orientation, beside what its trials did: the table of docs/trial.md.

Example: python benchmarks/trial_agreement.py 20            (trials of each orientation; all eight parts)
         python benchmarks/trial_agreement.py 20 dowel_6x20
         python benchmarks/trial_agreement.py 6 made        (parts on which no rule was found)
         python benchmarks/trial_agreement.py 6 some/part.stl

For each part of ``parts/`` the chain that ``feeder tooling`` finds for the most frequent orientation that
needs one, in the bowl of the defaults.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.part import load
from feederscrew.studies import tooling, trial
from feederscrew.trial import course, result

sys.path.insert(0, str(Path(__file__).parent))
import trial_parts

PARTS = Path(__file__).parent.parent / "parts"
NAMES = (
    "key_a_d12x20", "washer_m6", "dowel_6x20", "hexbolt_m8x25", "cap_14x10", "squarenut_m5",
    "shcs_m3x8_simple", "lbracket_30x20x15",
)  # fmt: skip


def chain(part, folder):
    """A bowl with the chain for the most frequent orientation that needs one, and which that is.

    Where none can be isolated, the chain that comes nearest for the most frequent one.
    """
    bowl, nearest = bowls.read(None, []), None
    first = tooling.tooling(part, bowl, verdicts=1, seconds=1e-3)
    for k in np.argsort(-first.shares, kind="stable"):
        one = first.orientations[k]
        found = tooling.tooling(part, bowl, one.aspect, heading=one.heading, known=first.aspects).design
        nearest = nearest or (found.cuts and (found, f"{one.name}, not isolated"))
        if found.isolated and found.cuts and tooling.CARRIED not in found.reasons:
            nearest = found, one.name
            break
    lines = [f"  - {cut.device.kind}: {cut.device.text}\n" for cut in nearest[0].cuts]
    path = Path(folder) / f"{part.name}.yaml"
    path.write_text("devices:\n" + "".join(lines))
    return bowls.read(path, []), nearest[1]


def rows(run):
    """One line an orientation: what is said, by which margin, and what became of its parts."""
    for k, one in enumerate(run.known.lying):
        said = "passes" if run.predicted[k] else "goes"
        margin = 1e3 * run.margin[k]
        sure = "track" if one.returned else "clear" if run.sure[k] and abs(margin) > 0.25 else "unsure"
        fates = ", ".join(f"{n} {fate}" for fate, n in zip(course.FATES, run.counts[k]) if n)
        mark = " <-" if run.odd[k] else ""
        yield f"  {one.name:7s} {said:6s} {margin:8.3f} {sure:6s} {run.holding[k]:3d} hold: {fates}{mark}"


def part_of(name):
    """A part of ``parts/``, one that is made here, or one of a file."""
    if name in trial_parts.NAMES:
        return trial_parts.made(name)
    return load(name if name.endswith(".stl") else str(PARTS / f"{name}.stl"))


def main():
    count, names = int(sys.argv[1]) if len(sys.argv) > 1 else 6, sys.argv[2:] or NAMES
    total = held = asked = 0
    for name in trial_parts.NAMES if list(names) == ["made"] else names:
        part = part_of(name)
        with tempfile.TemporaryDirectory() as folder:
            bowl, wanted = chain(part, folder)
            known = trial.arriving(part, bowl)
            every = len(trial.stream.orientations(part, known.aspects, bowl.track).lying)
            run = trial.trial(part, [bowl], parts=count * every, jobs=2, known=known).runs[0]
        devices = ", ".join(f"{device.kind} {device.text}" for device in bowl.devices)
        print(f"{name}: {devices}; wanted {wanted}")
        print("\n".join(rows(run)), flush=True)
        margin = np.abs(np.nan_to_num(run.margin, nan=0.0))
        clear = run.sure & (margin > result.CLEAR)
        total, asked = total + every, asked + int(clear.sum())
        held += int((clear & ~run.odd).sum())
    print(f"{total} orientations, {asked} with a margin beyond 0.25 mm, {held} of them as the rule says")


if __name__ == "__main__":
    main()
