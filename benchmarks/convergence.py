"""How far steps, tolerances and tessellation move the answers of the drop kernel.

Example: python benchmarks/convergence.py --drops 4000

First one motion without impacts, a coin that leans and rolls on its rim: the error of its attitude falls
with the step, and its order is printed. Then shares of drops, the same launches for every row: of a coin on
its edge (flip), of a square nut's second face and of a T shape's flat side (feed), against each setting
alone, coarser and finer than what the kernel uses; and the coin against the sections of its file. A row's
difference from the row above, over its standard error of sampling, says whether the setting still matters.
Last all settings at once, with ten times the drops: how far the kernel's own are from the finest is the
numerical error that the intervals carry (``ensemble.NUMERICAL_SHARE_ERROR``), said for a share of a half.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import trimesh

from feederscrew.arrivals import ensemble
from feederscrew.arrivals.kernel import body, falling
from feederscrew.arrivals.kernel.falling import Steps
from feederscrew.arrivals.kernel.floor_motion import at_rest
from feederscrew.arrivals.launch_conditions import PRESETS
from feederscrew.arrivals.rounded_hull import shape_of_part
from feederscrew.base.geometry.compiled import entry
from feederscrew.part import load
from feederscrew.resting.aspects import find

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests/support"))
import shapes  # noqa: E402 - the parts with closed forms

COIN = 0.354  # thickness over diameter
SECTIONS = (24, 48, 96, 192, 384)
FINER = (4.0, 2.0, 1.0, 0.5, 0.25)  # times the kernel's own setting
SETTINGS = {
    "contact tolerance": ("tolerance",),
    "solver's tolerance": ("converged",),
    "step on the floor": ("contact", "swing"),
    "step in the air": ("flight", "turn"),
    "rebound threshold": ("threshold",),
}


class Case:
    """One part, its launch, and the class whose share is looked at."""

    def __init__(self, name, part, launch, height):
        self.name, self.launch, self.aspects = name, PRESETS[launch], find(part)
        self.shape, _ = shape_of_part(part, self.aspects.ground)
        self.row = int(np.argmin(np.abs(1e3 * self.aspects.heights - height)))

    def share(self, drops, steps):
        """Share of the settled drops, and how many did not settle."""
        done = ensemble.drop(
            self.shape, self.launch, np.random.default_rng(5), count=drops, jobs=2, steps=steps
        )
        counted = ensemble.tally(done, self.aspects.ground.rows, len(self.aspects.names))
        return counted.p[self.row], counted.unsettled


def coin(sections):
    """The measured coin, as a file of so many sections."""
    mesh = trimesh.creation.cylinder(10.0, 20.0 * COIN, sections=sections)
    return Case(f"coin, {sections}", shapes.part(mesh), "flip", 10.0)


def cases():
    t_shape = shapes.part(shapes.prism(shapes.T_OUTLINE, 10.0))
    nut = load(str(ROOT / "parts/squarenut_m5.stl"))
    second = np.sort(1e3 * find(nut).heights[find(nut).stable])[1]
    return coin(64), Case("square nut", nut, "feed", second), Case("T shape", t_shape, "feed", 5.0)


@entry
def follow(solid, work, corner, until, steps):
    """Follow a body that sticks to a floor at rest."""
    floor, time, gap, pairing = at_rest(), 0.0, 0.0, falling.Pairing(0.0, 5.0)
    while time < until:
        corner, gap, dt, _, _ = falling.advance(solid, work, floor, time, corner, gap, pairing, steps)
        time += dt


def rolled(shape, step):
    """Attitude of a coin that leans and rolls on its rim for two units of time."""
    work, steps = falling.scratch(shape), Steps(contact=step, swing=1e9, rolling=0.0, tolerance=1e-5)
    lean = 0.25
    axis = int(np.argmax(np.abs(shape.solid.rims[0, 3:6])))
    spin, other = np.eye(3)[axis], np.eye(3)[(axis + 1) % 3]
    third = np.cross(spin, other)  # stands upright, then leans about ``other``
    frame = np.stack([spin, other, third], axis=1)  # columns: body axes that become x, y, z
    tilt = np.array([[np.cos(lean), 0, np.sin(lean)], [0, 1, 0], [-np.sin(lean), 0, np.cos(lean)]])
    turn = np.einsum("ij,kj->ik", tilt, frame)
    work.state[body.Q : body.Q + 4] = np.roll(_quaternion(turn), 1)
    work.state[body.W : body.W + 3] = 3.0 * spin
    corner, gap = falling.start(shape.solid, work)
    work.state[body.Z] -= gap
    contact_point = _lowest(shape, work.turn.reshape(3, 3))
    rates = np.einsum("ij,j->i", work.turn.reshape(3, 3), work.state[body.W : body.W + 3])
    work.state[body.VX : body.VX + 3] = -np.cross(rates, contact_point)
    follow(shape.solid, work, corner, 1.0 - 1e-9, steps)
    return work.state[body.Z], work.turn.copy()


def _quaternion(matrix):
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(matrix).as_quat()


def _lowest(shape, turn):
    """Lowest point of the rims, in floor axes from the centre."""
    points = [rim[:3] for rim in shape.solid.rims]
    lows = []
    for rim, centre in zip(shape.solid.rims, points):
        down = -turn[2]
        flat = down - (down * rim[3:6]).sum() * rim[3:6]
        lows.append(np.einsum("ij,j->i", turn, centre + rim[6] * flat / np.sqrt((flat**2).sum())))
    return min(lows, key=lambda point: point[2])


def order(shape):
    print("A leaning coin that rolls without resistance: error of its attitude after one unit of time")
    finest = rolled(shape, 1.25e-4)[1]
    before = None
    for step in (0.02, 0.01, 0.005, 0.0025, 0.00125):
        error = np.abs(rolled(shape, step)[1] - finest).max()
        told = "" if before is None else f"   order {np.log2(before / error):5.2f}"
        print(f"  step {step:8.5f}   {error:.2e}{told}")
        before = error


def shares(case, drops):
    usual = Steps()
    print(f"\n{case.name}: share, difference from the row above in standard errors, unsettled")
    for name, fields in SETTINGS.items():
        before = None
        for factor in FINER:
            values = {field: factor * getattr(usual, field) for field in fields}
            share, unsettled = case.share(drops, usual._replace(**values))
            error = np.sqrt(2.0 * share * (1.0 - share) / drops)
            told = "" if before is None else f"{(share - before) / max(error, 1e-9):6.1f}"
            shown = ", ".join(f"{value:.3g}" for value in values.values())
            print(f"  {name:20} {shown:16} {share:.4f} {told:>6} {unsettled:5d}", flush=True)
            before = share


def sections(drops):
    print("\ncoin on its edge against the sections of its file")
    before = None
    for count in SECTIONS:
        share, unsettled = coin(count).share(drops, Steps())
        error = np.sqrt(2.0 * share * (1.0 - share) / drops)
        told = "" if before is None else f"{(share - before) / error:6.1f}"
        print(f"  {count:5d} {share:.4f} {told:>6} {unsettled:5d}", flush=True)
        before = share


def together(looked_at, drops):
    print("\nall settings at once: share, and how far the kernel's own are from it, for a share of a half")
    away = []
    for case in looked_at:
        own, _ = case.share(drops, Steps())
        print(f"  {case.name:12} {1.0:5g} {own:.4f}", flush=True)
        for factor in (0.5, 0.25):
            share, _ = case.share(drops, finer(factor))
            half = 4.0 * share * (1.0 - share)
            error = np.sqrt(2.0 * share * (1.0 - share) / drops) / half
            away.append(((own - share) / half, error))
            print(f"  {'':12} {factor:5g} {share:.4f} {away[-1][0]:8.4f} +- {error:.4f}", flush=True)
    differences, errors = np.array(away).T
    print(f"  root of the mean square {np.sqrt((differences**2).mean()):.4f}, of which sampling")
    print(f"  explains {np.sqrt((errors**2).mean()):.4f}; the greatest {np.abs(differences).max():.4f}")


def finer(factor):
    usual, fields = Steps(), [field for names in SETTINGS.values() for field in names]
    return usual._replace(**{field: factor * getattr(usual, field) for field in fields})


def main(chosen):
    looked_at = cases()
    order(looked_at[0].shape)
    sections(chosen.drops)
    for case in looked_at:
        shares(case, chosen.drops)
    together(looked_at, 10 * chosen.drops)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--drops", type=int, default=4000)
    main(parser.parse_args())
