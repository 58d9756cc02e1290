"""What the static rule says of every orientation, beside what its trials did: the table of docs/trial.md.

Example: python benchmarks/trial_agreement.py 20            (trials of each orientation; all eight parts)
         python benchmarks/trial_agreement.py 20 dowel_6x20
         python benchmarks/trial_agreement.py 6 made        (parts on which no rule was found)
         python benchmarks/trial_agreement.py 4 drawn:100-119   (parts of a generator, by seeds)
         python benchmarks/trial_agreement.py 6 some/part.stl

For each part the chain that ``feeder tooling`` finds for the most frequent orientation that needs one, in the
bowl of the defaults. Shares are those of the centroid solid angle, so that no drop test is needed.
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

RULE, VERDICTS = "csa", 3000  # whose shares; of a search for holes
PARTS = Path(__file__).parent.parent / "parts"
NAMES = (
    "key_a_d12x20", "washer_m6", "dowel_6x20", "hexbolt_m8x25", "cap_14x10", "squarenut_m5",
    "shcs_m3x8_simple", "lbracket_30x20x15",
)  # fmt: skip


def chain(part, folder):
    """A bowl with the chain for the most frequent orientation that needs one, and which that is.

    Where none can be isolated, the chain that comes nearest for the most frequent one.
    """
    bowl, nearest, own = bowls.read(None, []), None, {"rule": RULE, "verdicts": VERDICTS}
    first = tooling.tooling(part, bowl, rule=RULE, verdicts=1, seconds=1e-3)
    for k in np.argsort(-first.shares, kind="stable"):
        one = first.orientations[k]
        found = tooling.tooling(
            part, bowl, one.aspect, heading=one.heading, known=first.aspects, **own
        ).design
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
    if name.startswith("drawn_"):
        return trial_parts.drawn(int(name.removeprefix("drawn_")))
    return load(name if name.endswith(".stl") else str(PARTS / f"{name}.stl"))


def kept(run):
    """(M,) bool, whether the parts of each orientation ended as the static rule says, fate for fate."""
    fates = {"returned": ("returned", "rolled_back"), "stopped": ("stopped", "stuck", "hanging")}
    said = ["passed" if passes else fate for passes, fate in zip(run.predicted, run.known.fates)]
    rows = [fates.get(one, (one,)) for one in said]
    held = [sum(counts[course.FATES.index(fate)] for fate in some) for counts, some in zip(run.counts, rows)]
    return np.array(held) >= result.HELD * run.tried


def names_of(words):
    """The parts that are meant."""
    for word in words or NAMES:
        if word == "made":
            yield from trial_parts.NAMES
        elif word.startswith("drawn:"):
            first, last = map(int, word.removeprefix("drawn:").split("-"))
            yield from (f"drawn_{seed}" for seed in range(first, last + 1))
        else:
            yield word


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 6
    total = held = asked = 0
    for name in names_of(sys.argv[2:]):
        part = part_of(name)
        with tempfile.TemporaryDirectory() as folder:
            bowl, wanted = chain(part, folder)
            known = trial.arriving(part, bowl, rule=RULE)
            every = len(trial.stream.orientations(part, known.aspects, bowl.track).lying)
            run = trial.trial(part, [bowl], rule=RULE, parts=count * every, jobs=1, known=known).runs[0]
        devices = ", ".join(f"{device.kind} {device.text}" for device in bowl.devices)
        print(f"{name}: {devices}; wanted {wanted}")
        print("\n".join(rows(run)), flush=True)
        margin = np.abs(np.nan_to_num(run.margin, nan=0.0))
        clear = run.sure & (margin > result.CLEAR)
        total, asked = total + every, asked + int(clear.sum())
        held += int((clear & kept(run)).sum())
        print(f"so far {total} orientations, {asked} clear, {held} of them as the rule says", flush=True)
    print(f"{total} orientations, {asked} with a margin beyond 0.25 mm, {held} of them as the rule says")


if __name__ == "__main__":
    main()
