"""Every rule and every launch against what was measured, and the closed forms against drop tests.

Examples: python benchmarks/accuracy.py --drops 4000 --keep /tmp/kept --jobs 2
          python benchmarks/accuracy.py --parts ~/cad/screws --measured ~/tosses

Measured: files of counts (docs/counts.md), each of which names its part and its launch. Feeding tests among
them are set beside the static rules, device by device. A table of the errors
of every rule and of the drop tests of every launch by series, where `recommended` is the answer for the
launch that was used: the root of the mean square of the total variation, which for parts with two classes is
the error of the share. Measured sets get MORE drops. Then total variation from the drop tests of every
launch, on real parts, on boxes, hulls and prisms made at random, and on round bodies made at random; the
widths of the intervals (``intervals.py``).
"""

import argparse
from pathlib import Path

import intervals
import numpy as np
from bodies import MADE, ROOT, ROUND, Body, made, rounds, shapes

from feederscrew.feeding.compare import compare_sets
from feederscrew.part import load
from feederscrew.resting.deviation import total_variation
from feederscrew.resting.rules.recommended import LAUNCH_NAMES

MORE = 10  # times the drops, on measured sets


class Measured:
    """One measured set and the body it is of."""

    def __init__(self, study, drops, **known):
        head, self.profile = study.measured.head, study.profile
        self.series, self.launch = head.series, head.launch
        self.body = Body(Path(study.measured.source).stem, study.part, MORE * drops, **known)
        stable = self.body.aspects.stable
        self.shares = np.zeros(len(stable))
        self.shares[stable] = self.profile.fractions / self.profile.fractions.sum()
        self.count = self.profile.values.sum() if self.profile.has_counts else np.nan

    def error(self, p):
        """Total variation of shares by class from what was measured."""
        return total_variation(p, self.shares)

    @property
    def noise(self):
        """Mean square of the error from the sampling of the tosses; 0 where their number is not known."""
        first = self.shares[0]
        return np.nan_to_num(first * (1.0 - first) / self.count)


def tossed(sets, **known):
    """The measured sets that are of parts with a shape and name their launch, by series."""
    found = {}
    for study in sets:
        if study.part.vertices is not None and study.measured.head.launch:
            one = Measured(study, **known)
            found.setdefault(one.series, []).append(one)
    return found


def measured(series):
    print("Measured sets: root of the mean square of the total variation")
    print(f"{'':28}" + "".join(f"{name:>16}" for name in series))
    print(f"{'launch, sets':28}" + "".join(f"{f'{s[0].launch}, {len(s)}':>16}" for s in series.values()))
    noise = [np.sqrt(np.mean([one.noise for one in sets])) for sets in series.values()]
    print(f"{'sampling of the tosses':28}" + "".join(f"{error:16.4f}" for error in noise))
    first = next(iter(series.values()))[0].body
    told = {rule: lambda one, rule=rule: one.body.rules[rule] for rule in first.rules}
    told |= {f"drop, {launch}": lambda one, launch=launch: one.body.drop(launch) for launch in LAUNCH_NAMES}
    told["drop, its own launch"] = lambda one: one.body.drop(one.launch)
    told["closed form"] = lambda one: one.body.closed(one.launch).p
    told["recommended"] = lambda one: one.body.answer(one.launch).p
    for name, of in told.items():
        errors = [np.sqrt(np.mean([one.error(of(one)) ** 2 for one in sets])) for sets in series.values()]
        print(f"{name:28}" + "".join(f"{error:16.4f}" for error in errors))


def fed(feedings):
    print("\nFeeding tests: share that passed, predicted, its interval, and whether it agrees")
    for one in feedings:
        ends = zip(one.measured.shares, one.answers["recommended"], one.low, one.high, one.agrees)
        for device, (share, said, low, high, agrees) in zip(one.stations, ends):
            told = f"{share:8.3f}{said:8.3f}   {low:.3f} to {high:.3f}   {'yes' if agrees else 'no'}"
            print(f"  {one.measured.source:40}{device:18}{told}")
    if feedings:
        off = [one.answers["recommended"] - one.measured.shares for one in feedings]
        agreed = np.concatenate([one.agrees for one in feedings])
        error = np.sqrt(np.nanmean(np.concatenate(off) ** 2))
        print(f"  root of the mean square {error:.3f}; {agreed.sum()} of {len(agreed)} agree")


def against_drops(groups):
    for group, bodies in groups.items():
        print(f"\nMean total variation from drop tests: {group}, {len(bodies)} bodies")
        print(f"{'':28}" + "".join(f"{launch:>8}" for launch in LAUNCH_NAMES))
        known = [body.rules for body in bodies]
        for rule in known[0] if known else ():
            away = [
                np.mean([total_variation(one[rule], body.drop(launch)) for one, body in zip(known, bodies)])
                for launch in LAUNCH_NAMES
            ]
            print(f"{rule:28}" + "".join(f"{mean:8.3f}" for mean in away))


def main(chosen):
    known = {"drops": chosen.drops, "keep": chosen.keep, "jobs": chosen.jobs}
    if chosen.keep:
        chosen.keep.mkdir(exist_ok=True)
    files = compare_sets(sorted(chosen.measured.glob("*.csv")))
    series = tossed(files.sets, **known)
    kinds = {"made": (made, chosen.made, MADE), "round": (rounds, chosen.round, ROUND)}
    bodies = [
        Body(f"{name}_{k:02d}", shapes.part(mesh), **known)
        for name, (make, count, seed) in kinds.items()
        for k, mesh in enumerate(make(count, np.random.default_rng(seed)))
    ]
    stl = sorted(chosen.parts.glob("*.stl"))
    real = [Body(f"part_{path.stem}", load(str(path), allow_open=True), **known) for path in stl]
    measured(series)
    fed(files.feedings)
    against_drops(
        {
            f"{name}, {'with a' if rolling else 'no'} rolling class": [
                b for b in some if b.rolling == rolling
            ]
            for rolling in (False, True)
            for name, some in (("made", bodies), ("real", real))
        }
    )
    intervals.weights_of_hops(bodies, series)
    intervals.closed_forms(bodies + real)
    intervals.measured(series)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--drops", type=int, default=4000)
    parser.add_argument("--measured", type=Path, default=ROOT / "docs/measured", help="folder of counts")
    parser.add_argument("--parts", type=Path, default=ROOT / "parts", help="folder of STL files")
    parser.add_argument("--made", type=int, default=60, help="bodies without round sides, made at random")
    parser.add_argument("--round", type=int, default=40, help="round bodies made at random")
    parser.add_argument("--keep", type=Path, help="folder that keeps the drop tests from run to run")
    parser.add_argument("--jobs", type=int, default=1)
    main(parser.parse_args())
