"""Every rule and every launch against what was measured, and the closed forms against drop tests.

Examples: python benchmarks/accuracy.py --drops 4000 --keep /tmp/kept --jobs 2
          python benchmarks/accuracy.py --parts ~/cad/screws

Measured: steel square cuboids tossed by hand (root-mean-square error of the share on the square faces, and
what is left of it once the sampling of the tosses is taken off), the experiment column of the thesis's
Table 3-1, whose aspect ratio is printed as 0.6 and fits 0.4 (total variation), a thick coin that was flipped
(error of its share on edge), cubes with one side shortened that were dropped (error of the slope). JUDGED
says which launch each was; they get MORE drops. Then total variation from the drop tests of every launch, on
real parts, on boxes, hulls and prisms made at random, and on round bodies made at random; the widths of the
intervals (``intervals.py``); and PMI with its products of inertia on the two published cards.
"""

import argparse
from pathlib import Path

import intervals
import numpy as np
from bodies import MADE, ROOT, ROUND, Body, made, rounds, rows, shapes

from feederscrew.dropping.ensemble import NORMAL
from feederscrew.part import load
from feederscrew.resting.counts.deviation import deviation, total_variation
from feederscrew.resting.rules.recommended import LAUNCHES

DATA = ROOT / "feederscrew/thesis/data"
T_HEIGHTS = (14.8895, 12.5, 10.1105, 12.2532)  # [mm] of aspects A to D; E is the flat side
T_TOSSES = 1000  # a guess: the experiment's number is not printed
COIN_TOSSES, CUBE_DROPS = 1000, 36000
JUDGED = {"cuboids": "roll", "T shape": "drop", "coin": "flip", "shortened cube": "drop"}
MORE, MOST = (
    10,
    50,
)  # times the drops: of the measured sets, and of the cube, whose slope is a small difference
CARDS = {"arc_chute": "table_3_04", "magnet": "table_3_07"}  # and the tables of their measured fractions


class Measured:
    """The measured sets, with their bodies."""

    def __init__(self, drops, **known):
        sets = {row["what"].split()[0]: float(row["value"]) for row in rows(ROOT / "tests/data/launches.csv")}
        cuboids = rows(ROOT / "tests/data/square_cuboids.csv")
        self.ratios, self.squares, self.tosses = (
            np.array([float(row[key]) for row in cuboids]) for key in ("x_over_y", "p_square", "n")
        )
        known["drops"] = MORE * drops
        self.cuboids = [
            Body(f"cuboid_{x:g}", shapes.part(shapes.box(10.0 * x, 10.0, 10.0)), **known) for x in self.ratios
        ]
        self.t_shape = Body("t_shape", shapes.part(shapes.prism(shapes.T_OUTLINE, 10.0)), **known)
        self.coin = Body("coin", shapes.part(shapes.cylinder(10.0, 7.08, 64)), **known)
        self.short = Body(
            "short", shapes.part(shapes.box(10.0, 10.0, 9.3)), **known | {"drops": MOST * drops}
        )
        self.edge, self.slope = sets["coin"], sets["cube"]

    def bodies(self):
        """All of them."""
        return [*self.cuboids, self.t_shape, self.coin, self.short]

    def shares(self, of):
        """Shares to hold against what was measured, from a function of a body and its launch."""
        roll, drop, flip = JUDGED["cuboids"], JUDGED["T shape"], JUDGED["coin"]
        squares = [square_share(b, x, of(b, roll)) for x, b in zip(self.ratios, self.cuboids)]
        edge = of(self.coin, flip)[np.argmax(self.coin.aspects.heights)]
        pair = of(self.short, JUDGED["shortened cube"])[np.argmin(self.short.aspects.heights)]
        return np.array(squares), t_shares(self.t_shape, of(self.t_shape, drop)), edge, pair

    def errors(self, of):
        """RMSE on the cuboids and net, total variation on the T, error on the coin's edge, of the slope."""
        squares, t_shape, edge, pair = self.shares(of)
        missed, noise = (squares - self.squares) ** 2, self.squares * (1.0 - self.squares) / self.tosses
        net = np.sqrt(max(np.mean(missed - noise), 0.0))
        away = total_variation(t_shape, experiment())
        return np.sqrt(missed.mean()), net, away, edge - self.edge, (3.0 * pair - 1.0) / 0.07 - self.slope

    def entries(self):
        """(set, measured, half its sampling, simulated, half its sampling) of every share."""
        truths = (self.squares, experiment(), [self.edge], [(1.0 + 0.07 * self.slope) / 3.0])
        tosses = (self.tosses, T_TOSSES, COIN_TOSSES, CUBE_DROPS)
        drops = [
            b.tally(JUDGED["cuboids"]).counts.sum()
            for b in (self.cuboids[0], self.t_shape, self.coin, self.short)
        ]
        for name, truth, simulated, n, m in zip(JUDGED, truths, self.shares(Body.drop), tosses, drops):
            for q, p, k in np.broadcast(truth, simulated, n):
                yield name, q, NORMAL * np.sqrt(q * (1.0 - q) / k), p, NORMAL * np.sqrt(p * (1.0 - p) / m)


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


def measured(sets):
    """Print the errors of every rule and launch on every measured set."""
    noise = np.sqrt((sets.squares * (1.0 - sets.squares) / sets.tosses).mean())
    print(f"Measured sets. The sampling of the tosses alone gives {noise:.4f} on the cuboids.")
    print(f"{'':28} cuboids      net  T shape     coin    slope")
    known = {body.name: body.rules() for body in sets.bodies()}
    told = {rule: lambda body, _, rule=rule: known[body.name][rule] for rule in known["coin"]}
    told |= {f"drop, {launch}": lambda body, _, one=launch: body.drop(one) for launch in LAUNCHES}
    told["closed form of the launch"] = lambda body, launch: body.closed(launch).p
    told["recommended for the launch"] = lambda body, launch: body.answer(launch).p
    for name, of in told.items():
        print(f"{name:28}" + "".join(f"{error:9.4f}" for error in sets.errors(of)))


def against_drops(groups):
    """Print how far each rule is from the drop tests of every launch, on the mean of each group of bodies."""
    for group, bodies in groups.items():
        print(f"\nMean total variation from drop tests: {group}, {len(bodies)} bodies")
        print(f"{'':28}" + "".join(f"{launch:>8}" for launch in LAUNCHES))
        known = [body.rules() for body in bodies]
        for rule in known[0] if known else ():
            away = [
                np.mean([total_variation(one[rule], body.drop(launch)) for one, body in zip(known, bodies)])
                for launch in LAUNCHES
            ]
            print(f"{rule:28}" + "".join(f"{mean:8.3f}" for mean in away))


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


def main(chosen):
    """Everything, in the order of the module's text."""
    known = {"drops": chosen.drops, "keep": chosen.keep, "jobs": chosen.jobs}
    if chosen.keep:
        chosen.keep.mkdir(exist_ok=True)
    sets = Measured(**known)
    kinds = {"made": (made, chosen.made, MADE), "round": (rounds, chosen.round, ROUND)}
    bodies = [
        Body(f"{name}_{k:02d}", shapes.part(mesh), **known)
        for name, (make, count, seed) in kinds.items()
        for k, mesh in enumerate(make(count, np.random.default_rng(seed)))
    ]
    files = sorted(chosen.parts.glob("*.stl"))
    real = [Body(f"part_{path.stem}", load(str(path), allow_open=True), **known) for path in files]
    measured(sets)
    against_drops(
        {
            f"{name}, {'with a' if rolling else 'no'} rolling class": [
                b for b in some if b.rolling == rolling
            ]
            for rolling in (False, True)
            for name, some in (("made", bodies), ("real", real))
        }
    )
    intervals.closed_forms(bodies + real)
    intervals.drop_tests(list(sets.entries()))
    cards()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--drops", type=int, default=4000)
    parser.add_argument("--parts", type=Path, default=ROOT / "parts", help="folder of STL files")
    parser.add_argument("--made", type=int, default=60, help="bodies without round sides, made at random")
    parser.add_argument("--round", type=int, default=40, help="round bodies made at random")
    parser.add_argument("--keep", type=Path, help="folder that keeps the drop tests from run to run")
    parser.add_argument("--jobs", type=int, default=1)
    main(parser.parse_args())
