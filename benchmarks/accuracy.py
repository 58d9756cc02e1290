"""Rules and drop tests against measured tosses, and the rules against the drop test on real parts.

Example: python benchmarks/accuracy.py --drops 4000

Measured: steel square cuboids tossed by hand (root-mean-square error of the share on the square faces) and
the experiment column of the thesis's Table 3-1, whose aspect ratio is printed as 0.6 and fits 0.4 (total
variation at both). Closed forms that were tried and not adopted stand below the rules.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

from feederscrew.part import load
from feederscrew.resting import barriers
from feederscrew.resting.aspects import find
from feederscrew.resting.drop import conditions, report
from feederscrew.resting.drop.launch import PRESETS
from feederscrew.resting.surface import EXPONENTS
from feederscrew.resting.tumbling_aspects import exact, ground

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests"))
import shapes  # noqa: E402 - the parts with closed forms

RATIOS = (0.4, 0.6, 0.8, 1.0, 1.2, 1.4)
T_OUTLINE = [(-5.5, 0), (5.5, 0), (5.5, 12), (12.5, 12), (12.5, 25), (-12.5, 25), (-12.5, 12), (-5.5, 12)]
T_HEIGHTS = (14.8895, 12.5, 10.1105, 12.2532)  # [mm] of aspects A to D; E is the flat side


def rows(path):
    """Rows of a CSV with # lines."""
    return list(csv.DictReader(line for line in path.read_text().splitlines() if line[0] != "#"))


class Body:
    """A part with everything the rules need."""

    def __init__(self, part):
        self.part, self.aspects = part, find(part)
        self.ground = ground(part, self.aspects)
        self.tips, self.radius = self.ground.tips, self.ground.hull.radius

    def by_class(self, weights):
        """Share of each class from a weight of each face."""
        sums = np.bincount(self.ground.rows, weights, minlength=len(self.aspects.names))
        return sums / sums.sum()

    def rules(self):
        """Every rule's shares by class."""
        found = dict(self.aspects.probabilities)
        for name, exponent in EXPONENTS.items():
            more = exact(self.ground, self.part, self.aspects, exponent).probabilities
            found |= {rule: p for rule, p in more.items() if rule != "surface"}
            found[f"surface, {name}"] = more["surface"]
        return found | {name: self.by_class(weigh(self)) for name, weigh in TRIED.items()}

    def drop(self, preset, drops):
        """Shares by class in a drop test."""
        own = dict.fromkeys(conditions.KEYS)
        tally = report.test(self.part, self.aspects, preset, own, drops=drops).tally
        return tally.counts / max(tally.counts.sum(), 1)


def depth(body):
    """How far each face lies under the highest way to stand, over that height."""
    return 1.0 - np.nan_to_num(body.tips.heights) / body.radius


def free_moment(body):
    """Moment about each face's normal with the other two rotations left free, over the height."""
    normals = np.array([face.normal for face in body.ground.faces])
    heights = np.array([face.height for face in body.ground.faces])
    inverse = np.linalg.inv(body.part.inertia)
    return 1.0 / np.einsum("fi,ij,fj->f", normals, inverse, normals) / heights


def finite_barriers(body):
    """Lowest lift off each face; the radius where nothing tips it."""
    lifts = barriers.barriers(body.tips)
    return np.where(np.isfinite(lifts), lifts, body.radius)


TRIED = {
    "pmi, other rotations free": free_moment,
    "basin x lowest barrier": lambda body: body.tips.shares * finite_barriers(body),
    "basin x exp(-5 h / R)": lambda body: body.tips.shares * np.exp(5.0 * (depth(body) - 1.0)),
    "basin x (R - h) / h": lambda body: (
        body.tips.shares * depth(body) / (1.0 - np.minimum(depth(body), 0.99))
    ),
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


def answers(body, drops):
    """Shares by class of every rule and every preset."""
    return body.rules() | {f"drop, {name}": body.drop(name, drops) for name in PRESETS}


def measured(drops):
    """Print the errors on the measured sets."""
    tosses = rows(ROOT / "tests/data/square_cuboids.csv")
    errors = {}
    for row in tosses:
        x = float(row["x_over_y"])
        body = Body(shapes.part(shapes.box(10.0 * x, 10.0, 10.0)))
        for name, p in answers(body, drops).items():
            errors.setdefault(name, []).append(square_share(body, x, p) - float(row["p_square"]))
    table = {
        row["aspect"]: row["experiment"] for row in rows(ROOT / "feederscrew/thesis/data/table_3_01.csv")
    }
    column = np.array([float(table[aspect]) for aspect in "ABCDE"])
    column /= column.sum()
    shown = {ratio: Body(shapes.part(shapes.prism(T_OUTLINE, 25.0 * ratio))) for ratio in RATIOS}
    by_ratio = {ratio: answers(body, drops) for ratio, body in shown.items()}
    print(f"{'':28}  cuboids    T shape, total variation from the experiment at ratio")
    print(f"{'':28}     RMSE " + "".join(f"{ratio:8.1f}" for ratio in RATIOS))
    for name, missed in errors.items():
        away = [0.5 * np.abs(t_shares(shown[r], by_ratio[r][name]) - column).sum() for r in RATIOS]
        print(f"{name:28} {np.sqrt(np.mean(np.square(missed))):8.4f} " + "".join(f"{a:8.3f}" for a in away))


def real(drops):
    """Print how far each rule is from the drop test on the parts of the repository."""
    away = {}
    for path in sorted((ROOT / "parts").glob("*.stl")):
        body = Body(load(str(path)))
        truth = body.drop("tumble", drops)
        for name, p in body.rules().items():
            away.setdefault(name, []).append(0.5 * np.abs(p - truth).sum())
    print(f"\nTotal variation from the drop test (tumble) on {len(away['pmi'])} real parts")
    print(f"{'':28}     mean    worst")
    for name, values in away.items():
        print(f"{name:28} {np.mean(values):8.3f} {np.max(values):8.3f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--drops", type=int, default=4000)
    chosen = parser.parse_args()
    measured(chosen.drops)
    real(chosen.drops)
