"""What of some parts is isolated by drops, by what clears itself and by a sorter, and what a queue does.

Example: python benchmarks/isolated.py parts/dowel_6x20.stl parts/washer_m6.stl
         python benchmarks/isolated.py --verdicts 300 --seconds 60 some/part.stl
         python benchmarks/isolated.py --into docs/tooling.md some/part.stl   (its row there, or a new one)

For each part the orientations that one part in twenty or more comes in, in the bowl of the defaults with a
track of 40 mm. A line a part: how many are isolated by what drops parts alone, with what clears itself, and
with a sorter. The best of them that a trial of two parts of each orientation does not deny: its chain, the
share of the parts that leaves so by the static rule, and what a queue of twelve does with it. Shares are by
the centroid solid angle.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.designing import own_trial
from feederscrew.part import load
from feederscrew.studies.rate import shares
from feederscrew.studies.tooling import tooling
from feederscrew.studies.trial import trial

RULE, OFTEN, PARTS, TRIED = "csa", 0.05, 12, 2  # whose shares; of a part's; in a queue; one at a time
OWN = ("track.width=40 mm",)
WAYS = (("drops", "wiper,jet,sorter"), ("clearing", "sorter"), ("sorter", ""))  # what may not be used
MOST = 4  # chains of a part that are tried
HEAD = (
    *("Part", "Often", "Drops", "Clearing", "Sorter", "Best that a trial confirms", "Comes"),
    *("Leaves", "A minute", "Right", "Jams"),
)


def designs(part, bowl, known, verdicts):
    """Studies by way, a list of each, of the orientations that come often."""
    first = tooling(part, bowl, rule=RULE, known=known, verdicts=1, seconds=1e-3, vary=False)
    often = [one for one, share in zip(first.orientations, first.shares) if share >= OFTEN]
    own = {"rule": RULE, "known": known, "verdicts": verdicts}
    return len(often), {
        way: [tooling(part, bowl, one.aspect, heading=one.heading, without=left_out, **own) for one in often]
        for way, left_out in WAYS
    }


def confirmed(found):
    """The study whose design leaves most, that a trial does not deny; the first of equals: by drops."""
    good = [one for way, _ in WAYS for one in found[way] if one.design.isolated and one.design.cuts]
    chains = {tuple(device.text for device in one.design.devices): one for one in reversed(good)}
    for one in sorted(chains.values(), key=lambda one: -round(one.design.efficiency, 6))[:MOST]:
        if not own_trial.own_trials(one).trials[0].faults:
            return one
    return None


def line(path, verdicts, seconds):
    """The cells of one part's row."""
    part, bowl = load(path), bowls.read(None, OWN)
    known = shares(part, bowl, rule=RULE)
    count, found = designs(part, bowl, known.aspects, verdicts)
    cells = [part.name, count, *(sum(one.design.isolated for one in found[way]) for way, _ in WAYS)]
    best = confirmed(found)
    if best is None:
        return [*cells, "none", "-", "-", "-", "-", "-"]
    there = replace(best.bowl, devices=best.design.devices)
    run = trial(part, [there], rule=RULE, known=known, parts=TRIED, queue=PARTS, seconds=seconds).runs[0]
    queue, name = run.queue, best.orientations[best.wanted].name
    chain = ", ".join(f"{device.kind} {device.short}".strip() for device in best.design.devices)
    chain += "" if best.design.width is None else f", track {1e3 * best.design.width:g} mm wide"
    right, left = int(queue.leaving[run.known.leaves_as[best.wanted]]), int(np.sum(queue.leaving))
    come = best.shares[best.wanted] / best.shares.sum()
    said = f"{name}: {chain}", f"{100.0 * come:.3g}", f"{100.0 * best.design.efficiency:.3g}"
    return [*cells, *said, f"{60.0 * queue.rate:.3g}", f"{right} of {left}", queue.jams]


def row(cells):
    """A line of the table."""
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def put(page, cells):
    """Write a row into the table of a page: in place of the one of that part, or as its last."""
    lines = page.read_text().split("\n")
    first = lines.index(row(HEAD)) + 2
    last = next(k for k in range(first, len(lines)) if not lines[k].startswith("|"))
    there = [k for k in range(first, last) if lines[k].startswith(f"| {cells[0]} |")]
    lines[slice(there[0], there[0] + 1) if there else slice(last, last)] = [row(cells)]
    page.write_text("\n".join(lines))


def main():
    """Print the table, a line as soon as it is known, or write it into a page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="+")
    parser.add_argument("--verdicts", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--into", type=Path)
    asked = parser.parse_args()
    print(row(HEAD))
    print(row("---" for _ in HEAD))
    for path in asked.parts:
        cells = line(path, asked.verdicts, asked.seconds)
        print(row(cells), flush=True)
        if asked.into is not None:
            put(asked.into, cells)


if __name__ == "__main__":
    main()
