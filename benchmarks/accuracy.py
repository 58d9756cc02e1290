"""Rules and drop tests against measured tosses, and the rules against the drop test on many parts.

Examples: python benchmarks/accuracy.py --drops 4000
          python benchmarks/accuracy.py --parts ~/cad/screws

Measured: steel square cuboids tossed by hand (root-mean-square error of the share on the square faces; also
weighted by tosses, and what is left of it once the sampling of the tosses is taken off) and the experiment
column of the thesis's Table 3-1, whose aspect ratio is printed as 0.6 and fits 0.4 (total variation at both).
Against the drop test: real parts, and boxes, hulls and prisms made at random. Nothing was chosen on the made
ones; the cascade of hops was, on the real ones among others: docs/resting.md. Then how often the recommended
interval holds what was measured and what the drop tests give, and PMI with its products of inertia on the two
published cards.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
import trimesh
from closed_forms import TRIED

from feederscrew.dropping import conditions, runs
from feederscrew.dropping.launches import PRESETS
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.counts.deviation import deviation, total_variation
from feederscrew.resting.rules import recommended
from feederscrew.resting.rules.surface import EXPONENTS
from feederscrew.resting.tumbling.by_class import exact, ground

ROOT = Path(__file__).parent.parent
DATA = ROOT / "feederscrew/thesis/data"
sys.path.insert(0, str(ROOT / "tests"))
import shapes  # noqa: E402 - the parts with closed forms

RATIOS = (0.4, 0.6, 0.8, 1.0, 1.2, 1.4)
T_HEIGHTS = (14.8895, 12.5, 10.1105, 12.2532)  # [mm] of aspects A to D; E is the flat side
CARDS = {"arc_chute": "table_3_04", "magnet": "table_3_07"}  # and the tables of their measured fractions


def rows(path):
    """Rows of a CSV with # lines."""
    return list(csv.DictReader(line for line in path.read_text().splitlines() if line[0] != "#"))


class Body:
    """A part with everything the rules need; drop tests are made once."""

    def __init__(self, part, drops):
        self.part, self.aspects = part, find(part)
        self.ground = ground(part, self.aspects)
        self.tips, self.radius = self.ground.tips, self.ground.hull.radius
        self.drops, self.tallies = drops, {}

    def by_class(self, weights):
        """Share of each class from a weight of each face."""
        sums = np.bincount(self.ground.rows, weights, minlength=len(self.aspects.names))
        return sums / sums.sum()

    def rules(self):
        """Every rule's shares by class."""
        found = {rule: p for rule, p in self.aspects.probabilities.items() if rule != "surface"}
        for name, exponent in EXPONENTS.items():
            more = exact(self.ground, self.part, self.aspects, exponent).probabilities
            found[f"surface, {name}"] = more["surface"]
        return found | {name: self.by_class(weigh(self)) for name, weigh in TRIED.items()}

    def tally(self, preset):
        """Counts of a drop test."""
        if preset not in self.tallies:
            own = dict.fromkeys(conditions.KEYS)
            tested = runs.test(self.part, self.aspects, preset, own, drops=self.drops)
            self.tallies[preset] = tested.tally
        return self.tallies[preset]

    def drop(self, preset):
        """Shares by class in a drop test."""
        counts = self.tally(preset).counts
        return counts / max(counts.sum(), 1)

    def answers(self):
        """Shares by class of every rule and every preset."""
        return self.rules() | {f"drop, {name}": self.drop(name) for name in PRESETS}

    def intervals(self):
        """The recommended interval without and with a drop test."""
        return {
            "closed form": self.aspects.recommended,
            "drop test": recommended.dropped(self.tally(recommended.LAUNCH), self.aspects.stable),
        }


def square_share(body, x, shares):
    """Share on the square faces of a cuboid x : 1 : 1."""
    at = np.abs(1e3 * body.aspects.heights - 5.0 * x) < 1e-6
    return shares[at].sum()


def t_shares(body, shares):
    """Shares of A, B, C, D, E of the T shape."""
    flat = np.abs(body.aspects.normals[:, 2]) > 0.5
    heights = 1e3 * body.aspects.heights
    at = [(np.abs(heights - h) < 0.02) & ~flat for h in T_HEIGHTS]
    return np.array([shares[one].sum() for one in (*at, flat)])


def experiment():
    """Measured shares of A to E of the T shape."""
    table = {row["aspect"]: row["experiment"] for row in rows(DATA / "table_3_01.csv")}
    column = np.array([float(table[aspect]) for aspect in "ABCDE"])
    return column / column.sum()


def measured(cuboids, shown):
    """Print the errors on the measured sets."""
    share, tosses = (np.array([float(row[key]) for row, _ in cuboids]) for key in ("p_square", "n"))
    noise = share * (1.0 - share) / tosses
    found = [(float(row["x_over_y"]), body, body.answers()) for row, body in cuboids]
    by_ratio = {ratio: body.answers() for ratio, body in shown.items()}
    print(f"Square cuboids; the sampling of the tosses alone gives {np.sqrt(noise.mean()):.4f}. T shape")
    print(f"{'':28}     RMSE weighted    net  TV at ratio " + "".join(f"{ratio:7.1f}" for ratio in RATIOS))
    for name in found[0][2]:
        missed = np.array([square_share(body, x, p[name]) for x, body, p in found]) - share
        weighted, net = np.average(missed**2, weights=tosses), max(np.mean(missed**2 - noise), 0.0)
        errors = "".join(f"{np.sqrt(e):9.4f}" for e in (np.mean(missed**2), weighted, net))
        away = [total_variation(t_shares(shown[r], by_ratio[r][name]), experiment()) for r in RATIOS]
        print(f"{name:28}{errors}            " + "".join(f"{a:7.3f}" for a in away))


def launched(drops):
    """Print each launch on the sets that name theirs: a coin on its edge, a cube with one side shorter."""
    sets = {row["what"].split()[0]: float(row["value"]) for row in rows(ROOT / "tests/data/launches.csv")}
    coin = Body(shapes.part(shapes.cylinder(10.0, 7.08, 64)), drops)
    short = Body(shapes.part(shapes.box(10.0, 10.0, 9.3)), drops)
    print(f"\nCoin on its edge, flipped: {sets['coin']:.3f}")
    print(f"Slope of a shortened cube's pair, dropped: {sets['cube']:.1f}")
    for name in PRESETS:
        edge = coin.drop(name)[np.argmax(coin.aspects.heights)]
        pair = short.drop(name)[np.argmin(short.aspects.heights)]
        print(f"{f'drop, {name}':28}{edge:9.4f}{(3.0 * pair - 1.0) / 0.07:9.2f}")


def against_drops(groups):
    """Print how far each rule is from the drop tests, on the mean of each group of bodies."""
    for preset in ("feed", "drop"):
        print(f"\nMean total variation from the drop test ({preset})")
        print(f"{'':28}" + "".join(f"{f'{name} ({len(bodies)})':>18}" for name, bodies in groups.items()))
        away = {
            group: [
                {rule: total_variation(p, body.drop(preset)) for rule, p in body.rules().items()}
                for body in bodies
            ]
            for group, bodies in groups.items()
        }
        for rule in away[next(iter(groups))][0]:
            means = [np.mean([one[rule] for one in values]) for values in away.values()]
            print(f"{rule:28}" + "".join(f"{mean:18.3f}" for mean in means))


def coverage(cuboids, t_shape, groups):
    """Print how often the recommended interval holds what was measured and what drop tests give."""
    print("\nRecommended interval: share that falls inside, mean width")
    for kind in ("closed form", "drop test"):
        found = {"measured": tossed(cuboids, t_shape, kind)}
        for preset in ("feed", "drop"):
            for group, bodies in groups.items():
                found[f"drop test ({preset}), {group}"] = [
                    entry for body in bodies for entry in ends(body, kind, body.drop(preset))
                ]
        for name, entries in found.items():
            print(f"{f'{kind}, {name}':44}" + inside(entries))
        real = [entry for name, entries in found.items() if "made" not in name for entry in entries]
        print(f"{f'{kind}, measured and real':44}" + inside(real))


def tossed(cuboids, t_shape, kind):
    """(low, truth, high) of the measured sets."""
    found = t_shape.intervals()[kind]
    entries = list(zip(t_shares(t_shape, found.low), experiment(), t_shares(t_shape, found.high)))
    for row, body in cuboids:
        found, x = body.intervals()[kind], float(row["x_over_y"])
        low, high = (square_share(body, x, end) for end in (found.low, found.high))
        entries.append((low, float(row["p_square"]), high))
    return entries


def ends(body, kind, truth):
    """(low, truth, high) of each class."""
    found = body.intervals()[kind]
    return zip(found.low, truth, found.high)


def inside(entries):
    """Share of (low, truth, high) that hold, and the mean width."""
    low, truth, high = np.array(list(entries)).T
    return (
        f"{np.mean((low <= truth) & (truth <= high)):6.1%} of {len(low):3d}, {np.mean(high - low):.3f} wide"
    )


def cards():
    """Print PMI with and without products of inertia on the published cards.

    A normal n lies along the principal axis that has no product, or across it; across, n J^-1 n = (trace - n
    J n) / determinant of the other two axes' 2 x 2 matrix (Cayley and Hamilton): the printed moment n J n of
    an aspect fixes its free moment, whatever its normal.
    """
    print("\nPMI on the published cards, deviation as in Tables 3-12 and 3-13")
    for name, table in CARDS.items():
        part = load(str(ROOT / f"parts/{name}.yaml"))
        alone = next(k for k in range(3) if not np.delete(part.inertia[k], k).any())
        block = np.delete(np.delete(part.inertia, alone, 0), alone, 1)
        moments = np.array([aspect.polar_inertia for aspect in part.aspects])
        heights = np.array([aspect.height for aspect in part.aspects])
        free = np.linalg.det(block) / (np.trace(block) - moments)
        free = np.where(np.isclose(moments, part.inertia[alone, alone]), moments, free)
        columns = [key for key in rows(DATA / f"{table}.csv")[0] if key != "aspect"]
        print(f"{name:28}" + "".join(f"{column:>9}" for column in columns))
        for rule, moment in (("PMI", moments), ("PMI, other rotations free", free)):
            p = moment / heights / (moment / heights).sum()
            against = [np.array([float(row[c]) for row in rows(DATA / f"{table}.csv")]) for c in columns]
            print(f"  {rule:26}" + "".join(f"{deviation(p, q):9.4f}" for q in against))


def made(count, rng):
    """Meshes of boxes, hulls and prisms at random, in turn."""
    for k in range(count):
        if k % 3 == 0:
            yield shapes.box(*rng.uniform(3.0, 12.0, 3))
        elif k % 3 == 1:
            points = rng.normal(size=(rng.integers(5, 16), 3)) * rng.uniform(4.0, 10.0, 3)
            yield trimesh.convex.convex_hull(points)
        else:
            turn = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(3, 7)))
            ring = np.column_stack([np.cos(turn), np.sin(turn)]) * rng.uniform(4.0, 10.0, (len(turn), 1))
            half = rng.uniform(1.5, 12.5)
            ends = [np.column_stack([ring, np.full(len(ring), z)]) for z in (-half, half)]
            yield trimesh.convex.convex_hull(np.vstack(ends))


def main(chosen):
    """Everything, in the order of the module's text."""
    cuboids = [
        (row, Body(shapes.part(shapes.box(10.0 * float(row["x_over_y"]), 10.0, 10.0)), chosen.drops))
        for row in rows(ROOT / "tests/data/square_cuboids.csv")
    ]
    shown = {r: Body(shapes.part(shapes.prism(shapes.T_OUTLINE, 25.0 * r)), chosen.drops) for r in RATIOS}
    meshes = list(made(chosen.made, np.random.default_rng(2013)))
    bodies = [Body(shapes.part(mesh), chosen.drops) for mesh in meshes]
    files = sorted(chosen.parts.glob("*.stl"))
    real = [Body(load(str(path), allow_open=True), chosen.drops) for path in files]
    groups = {"real": real, "made": bodies}
    measured(cuboids, shown)
    launched(chosen.drops)
    against_drops(groups)
    coverage(cuboids, shown[RATIOS[0]], groups)
    cards()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--drops", type=int, default=4000)
    parser.add_argument("--parts", type=Path, default=ROOT / "parts", help="folder of STL files")
    parser.add_argument("--made", type=int, default=60, help="bodies made at random")
    main(parser.parse_args())
