"""Speed and depth of the trial: every real part on six chains of devices, a table for docs/method/trial.md.

Example: python benchmarks/trial_depths.py ../shared/real_parts --parts pan_m4x10 washer_m6
         python benchmarks/trial_depths.py ../shared/real_parts --write

Chains are of the kinds that `feeder tooling` proposes; each of 24 parts travels alone. With ``--keep FILE``
the table can be made in slices: parts that stand there are not run again.
"""

import argparse
import json
import time
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.base.running import RunSettings
from feederscrew.feeding import stream
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.trials import course

PAGE = Path(__file__).parent.parent / "docs/method/trial.md"
BEGIN, END = "<!-- depths -->\n", "<!-- end of depths -->"
CHAINS = {
    "canyon 6, gap 9": ("canyon: 6 mm", "gap: 9 mm"),
    "narrowed 6.5, gap 5": ("narrowed_track: 6.5 mm", "gap: 5 mm"),
    "slot 4 to 9": ("slot: {from: 4 mm, to: 9 mm}",),
    "height bar 6": ("height_bar: 6 mm",),
    "rails 3.5 to 7.5": ("rails: {from: 3.5 mm, to: 7.5 mm}",),
    "step 4, gap 7": ("step: 4 mm", "gap: 7 mm"),
}
TRIED, SEED = 24, 1
HEAD = (
    "| Part | facets | part-s a CPU s | deepest [mm] | on | energy won [um] |\n"
    "|---|---:|---:|---:|---|---:|\n"
)


def bowl_with(lines):
    """Return the bowl of the defaults with a chain of devices, each as a bowl file writes it."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bowl.yaml"
        path.write_text("devices:\n" + "".join(f"  - {line}\n" for line in lines))
        return bowls.read(path)


def ridden(part, lines):
    """Return part-seconds, processor time [s], depth [mm] and energy won [um] of a part on one chain."""
    bowl = bowl_with(lines)
    ways = stream.follow_orientations(part, find(part), bowl.track, bowl.devices, bowl=bowl)
    sent = course.SentParts(range(len(ways.lying)), TRIED)
    begun = time.process_time()
    seen = course.course(part, bowl, ways.lying, sent, bowl.devices, run=RunSettings(SEED))
    spent = time.process_time() - begun
    return seen.seconds.sum(), spent, 1e3 * seen.depths.max(), 1e6 * seen.gains.max()


def row(path):
    try:
        part = load(path)
        found = {name: ridden(part, lines) for name, lines in CHAINS.items()}
    except FeederError:
        return ""
    seconds, spent, depths, gains = np.array(list(found.values())).T
    where = list(found)[int(np.argmax(depths))]
    return (
        f"| {path.stem} | {len(part.faces):,} | {seconds.sum() / spent.sum():.1f} "
        f"| {depths.max():.3f} | {where} | {gains.max():.2f} |\n"
    )


def main():
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("folder", type=Path)
    asked.add_argument("--parts", nargs="*")
    asked.add_argument("--keep", type=Path)
    asked.add_argument("--write", action="store_true")
    given = asked.parse_args()
    kept = json.loads(given.keep.read_text()) if given.keep and given.keep.exists() else {}
    every = sorted(given.folder.glob("*.stl"))
    ridden(load(every[0]), CHAINS["height bar 6"])  # compiled here
    for path in every:
        if path.stem not in kept and (not given.parts or path.stem in given.parts):
            kept[path.stem] = row(path)
            print(kept[path.stem], end="", flush=True)
            if given.keep:
                given.keep.write_text(json.dumps(kept))
    if given.write:
        text = PAGE.read_text()
        before, after = text.split(BEGIN)[0], text.split(END)[1]
        PAGE.write_text(before + BEGIN + HEAD + "".join(kept[name] for name in sorted(kept)) + END + after)


if __name__ == "__main__":
    main()
