"""What of some parts is isolated by drops, by what clears itself and by a sorter, and what a queue does.

Example: python benchmarks/isolated.py parts/dowel_6x20.stl parts/washer_m6.stl
         python benchmarks/isolated.py --verdicts 300 --seconds 60 some/part.stl

For each part the orientations that one part in twenty or more comes in, in the bowl of the defaults with a
track of 40 mm. A line a part: how many are isolated by what drops parts alone, with
what clears itself, and with a sorter; of the one that isolates most, its chain, the share of the parts that
leaves by the static rule, and what a queue of twelve does with it. Shares are by the centroid solid angle.
"""

import argparse
from dataclasses import replace

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.part import load
from feederscrew.studies.rate import shares
from feederscrew.studies.tooling import tooling
from feederscrew.studies.trial import trial

RULE, OFTEN, PARTS, TRIED = "csa", 0.05, 12, 8  # whose shares; of a part's; in a queue; one at a time
OWN = ("track.width=40 mm",)
WAYS = (("drops", "wiper,jet,sorter"), ("clearing", "sorter"), ("sorter", ""))  # what may not be used


def designs(part, bowl, known, verdicts):
    """Designs by way, a list of each, of the orientations that come often."""
    first = tooling(part, bowl, rule=RULE, known=known, verdicts=1, seconds=1e-3)
    often = [one for one, share in zip(first.orientations, first.shares) if share >= OFTEN]
    own = {"rule": RULE, "known": known, "verdicts": verdicts}
    return len(often), {
        way: [
            tooling(part, bowl, one.aspect, heading=one.heading, without=left_out, **own).design
            for one in often
        ]
        for way, left_out in WAYS
    }


def line(path, verdicts, seconds):
    """The line of one part."""
    part, bowl = load(path), bowls.read(None, OWN)
    known = shares(part, bowl, rule=RULE)
    count, found = designs(part, bowl, known.aspects, verdicts)
    cells = [sum(one.isolated for one in found[way]) for way, _ in WAYS]
    good = [one for way, _ in WAYS for one in found[way] if one.isolated]
    if not good:
        return row(part.name, count, *cells, "none", "-", "-", "-", "-")
    best = max(good, key=lambda one: round(one.efficiency, 6))  # the first of equals: by drops
    there = replace(bowl, devices=best.devices)
    run = trial(part, [there], rule=RULE, known=known, parts=TRIED, queue=PARTS, seconds=seconds).runs[0]
    queue, name = run.queue, run.known.lying[best.wanted].name
    chain = ", ".join(f"{device.kind} {device.short}".strip() for device in best.devices) or "none needed"
    right, left = int(queue.leaving[run.known.leaves_as[best.wanted]]), int(np.sum(queue.leaving))
    said = f"{name}: {chain}", f"{100.0 * best.efficiency:.3g}", f"{60.0 * queue.rate:.3g}"
    return row(part.name, count, *cells, *said, f"{right} of {left}", queue.jams)


def row(*cells):
    """A line of the table."""
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def main():
    """Print the table, a line as soon as it is known."""
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="+")
    parser.add_argument("--verdicts", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=60.0)
    asked = parser.parse_args()
    print(
        row("Part", "Often", "Drops", "Clearing", "Sorter", "Best", "Efficiency", "A minute", "Right", "Jams")
    )
    print(row(*("---" for _ in range(10))))
    for path in asked.parts:
        print(line(path, asked.verdicts, asked.seconds), flush=True)


if __name__ == "__main__":
    main()
