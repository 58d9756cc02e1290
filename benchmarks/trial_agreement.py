"""What the static rule says of every orientation, beside what its trials did: the table of docs/trial.md.

Example: python benchmarks/trial_agreement.py 20            (trials of each orientation; all eight parts)
         python benchmarks/trial_agreement.py 20 dowel_6x20
         python benchmarks/trial_agreement.py 6 made        (parts on which no rule was found)
         python benchmarks/trial_agreement.py 4 drawn:100-119   (parts of a generator, by seeds)
         python benchmarks/trial_agreement.py 3 each:100-111    (the same parts, one device of each kind)
         python benchmarks/trial_agreement.py 6 some/part.stl
         python benchmarks/trial_agreement.py 3 each:620-623 throw:1.8 hertz:50 kinds:2  (parts that hop)

For each part the chain that ``feeder tooling`` finds for the most frequent orientation that needs one, in the
bowl of the defaults. With ``each`` one device of each kind instead, at a value between those that two
orientations need, by the seed; with ``kinds`` so many of the kinds, by the seed. With ``throw`` and ``hertz``
the bowl has leaf springs instead: 20 deg, bank 3 deg, restitution 0.3. Shares are those of the centroid solid
angle, so that no drop test is needed.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.motion import conveying as answer
from feederscrew.part import load
from feederscrew.sorting import tooling as tooling_study
from feederscrew.sorting.isolating.chain import limits
from feederscrew.sorting.isolating.design import TRACK_REMARK
from feederscrew.trials import course, result, trial

sys.path.insert(0, str(Path(__file__).parent))
import trial_parts

SINGLE = ("gap", "canyon", "narrowed_track", "wiper", "cut_out")
LEAF_SPRINGS = [
    "drive.vibration_angle=20 deg", "track.bank=3 deg", "friction.static=0.6", "restitution=0.3",
]  # fmt: skip
RULE, VERDICTS = "csa", 3000  # whose shares; of a search for holes
PARTS = Path(__file__).parent.parent / "parts"
NAMES = (
    "key_a_d12x20", "washer_m6", "dowel_6x20", "hexbolt_m8x25", "cap_14x10", "squarenut_m5",
    "shcs_m3x8_simple", "lbracket_30x20x15",
)  # fmt: skip


def drive_of(words):
    """What of a bowl file is other than the defaults, by words such as throw:1.8 and hertz:50."""
    asked = dict(word.split(":") for word in words if word.startswith(("throw:", "hertz:")))
    if not asked:
        return []
    own = [*LEAF_SPRINGS, f"drive.frequency={asked['hertz']} Hz"]
    once = bowls.read(None, own)
    amplitude = once.drive.amplitude * float(asked["throw"]) / answer.throw_number(once)
    return [*own, f"drive.amplitude={1e3 * amplitude:.6g} mm"]


def chain(part, folder, drive):
    """A bowl with the chain for the most frequent orientation that needs one, and which that is.

    Where none can be isolated, the chain that comes nearest for the most frequent one.
    """
    bowl, nearest, own = (
        bowls.read(None, drive),
        None,
        {"search": tooling_study.ToolingSearch(rule=RULE, verdicts=VERDICTS)},
    )
    first = tooling_study.tooling(
        part, bowl, search=tooling_study.ToolingSearch(rule=RULE, verdicts=1, seconds=0.001)
    )
    for k in np.argsort(-first.shares, kind="stable"):
        one = first.orientations[k]
        study = tooling_study.tooling(
            part, bowl, one.aspect, heading=one.heading, aspect_shares=first.aspects, **own
        )
        found = study.design
        nearest = nearest or (found.cuts and (study, f"{one.name}, not isolated"))
        if found.isolated and found.cuts and TRACK_REMARK not in found.reasons:
            nearest = study, one.name
            break
    width = [f"track.width={1e3 * nearest[0].bowl.track.width:.6g} mm"]
    lines = [f"  - {cut.device.kind}: {cut.device.text}\n" for cut in nearest[0].design.cuts]
    path = Path(folder) / f"{part.name}.yaml"
    path.write_text("devices:\n" + "".join(lines))
    return bowls.read(path, [*drive, *width]), nearest[1]


def single(part, seed, folder, drive, kinds):
    """One bowl for each kind of device that drops parts or sweeps them off, and what it is."""
    bowl = bowls.read(None, drive)
    aspects = trial.arriving(part, bowl, rule=RULE).aspects
    every = trial.stream.follow_orientations(part, aspects, bowl.track, bowl=bowl).lying
    every = [one for one in every if not one.returned]
    rng, path = np.random.default_rng((24, 1, seed)), Path(folder) / f"{part.name}.yaml"
    for kind in SINGLE if kinds >= len(SINGLE) else rng.choice(SINGLE, kinds, replace=False):
        text = _hole(every, rng) if kind == "cut_out" else _between(kind, every, rng)
        if text:
            path.write_text(f"devices:\n  - {kind}: {text}\n")
            yield bowls.read(path, drive), "none"


def _between(kind, every, rng):
    """A value midway between those that two orientations just pass; none where all need the same."""
    values = np.unique(np.round(limits(KINDS[kind], every), 5))
    values = values[np.isfinite(values) & (values > 0.0)]
    if len(values) < 2:
        return ""
    k = rng.integers(len(values) - 1)
    text = f"{1e3 * values[k : k + 2].mean():.2f} mm"
    return text if kind != "wiper" else f"{{clearance: {text}, sweep: 30 deg}}"


def _hole(every, rng):
    length, width = 1e3 * max(one.length for one in every), 1e3 * max(one.width for one in every)
    high = width * rng.uniform(0.4, 1.1)
    low = max(0.0, high - width * rng.uniform(0.3, 1.1))
    long, lean = length * rng.uniform(0.4, 1.3), length * rng.uniform(0.0, 0.3)
    corners = [(0.0, low), (long, low), (long - min(lean, 0.5 * long), high), (0.0, high)]
    return "[" + ", ".join(f"[{x:.2f} mm, {y:.2f} mm]" for x, y in corners) + "]"


def bowls_of(part, name, each, drive, kinds):
    """Bowls in which a part is tried, and the orientation each is for."""
    with tempfile.TemporaryDirectory() as folder:
        if each:
            yield from single(part, int(name.removeprefix("drawn_")), folder, drive, kinds)
        else:
            yield chain(part, folder, drive)


def rows(run):
    """One line an orientation: what is said, by which margin, and what became of its parts."""
    for k, one in enumerate(run.orientations.lying):
        said = "passes" if run.passes_by_rule[k] else "goes"
        margin = 1e3 * run.margin[k]
        sure = "track" if one.returned else "clear" if run.is_sure[k] and abs(margin) > 0.25 else "unsure"
        fates = ", ".join(f"{n} {fate}" for fate, n in zip(course.FATES, run.counts[k]) if n)
        names = [*(state.name for state in run.orientations.states), "other"]
        onto = [f"{n} as {names[m]}" for m, n in enumerate(run.matrix[k]) if n and m != k]
        mark = f" ({', '.join(onto)})" if onto else ""
        mark += " <-" if run.is_odd[k] else ""
        held = run.agreeing_counts[k]
        yield f"  {one.name:7s} {said:6s} {margin:8.3f} {sure:6s} {held:3d} hold: {fates}{mark}"


def part_of(name):
    if name in trial_parts.NAMES:
        return trial_parts.made(name)
    if name.startswith("drawn_"):
        return trial_parts.drawn(int(name.removeprefix("drawn_")))
    return load(name if name.endswith(".stl") else str(PARTS / f"{name}.stl"))


def kept(run):
    """(M,) bool, whether the parts of each orientation ended as the static rule says, fate for fate."""
    fates = {"returned": ("returned", "rolled_back"), "stopped": ("stopped", "stuck", "hanging")}
    fates["carried"] = fates["returned"]  # by the devices, but it rolls back before them
    said = ["passed" if passes else fate for passes, fate in zip(run.passes_by_rule, run.orientations.fates)]
    rows = [fates.get(one, (one,)) for one in said]
    held = [sum(counts[course.FATES.index(fate)] for fate in some) for counts, some in zip(run.counts, rows)]
    return np.array(held) >= result.VERDICT_SHARE * run.tried_counts


def names_of(words):
    for word in words or NAMES:
        if word == "made":
            yield from trial_parts.NAMES
        elif word.startswith(("drawn:", "each:")):
            first, last = map(int, word.partition(":")[2].split("-"))
            yield from (f"drawn_{seed}" for seed in range(first, last + 1))
        else:
            yield word


def tried(part, bowl, count):
    known = trial.arriving(part, bowl, rule=RULE)
    every = len(trial.stream.follow_orientations(part, known.aspects, bowl.track).lying)
    return trial.trial(part, [bowl], rule=RULE, parts=count * every, jobs=1, aspect_shares=known).runs[0]


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 6
    total = held = asked = 0
    each = any(word.startswith("each:") for word in sys.argv[2:])
    drive = drive_of(sys.argv[2:])
    kinds = next((int(word[6:]) for word in sys.argv[2:] if word.startswith("kinds:")), len(SINGLE))
    parts = [word for word in sys.argv[2:] if not word.startswith(("throw:", "hertz:", "kinds:"))]
    for name in names_of(parts):
        part = part_of(name)
        for bowl, wanted in bowls_of(part, name, each, drive, kinds):
            run = tried(part, bowl, count)
            devices = ", ".join(f"{device.kind} {device.text}" for device in bowl.devices)
            print(f"{name}: {devices}; wanted {wanted}")
            print("\n".join(rows(run)), flush=True)
            margin = np.abs(np.nan_to_num(run.margin, nan=0.0))
            clear = run.is_sure & (margin > result.CLEAR_MARGIN_M)
            total, asked = total + len(clear), asked + int(clear.sum())
            held += int((clear & kept(run)).sum())
            print(f"so far {total} orientations, {asked} clear, {held} of them as the rule says", flush=True)
    print(f"{total} orientations, {asked} with a margin beyond 0.25 mm, {held} of them as the rule says")
    print(f"{time.process_time():.0f} s of processor")


if __name__ == "__main__":
    main()
