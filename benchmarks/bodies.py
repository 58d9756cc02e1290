"""Bodies for ``accuracy.py``: those that were measured, real parts, and those made at random."""

import json
import sys
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import trimesh

from feederscrew.arrivals import drop_test, launch_conditions
from feederscrew.base.running import RunSettings
from feederscrew.resting.aspects import find, require_ground
from feederscrew.resting.rules.formulas import surface_weights

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests/support"))
import shapes  # noqa: E402 - the parts with closed forms

MADE, ROUND = 2013, 1909  # seeds
SIDES = 64  # sections of a round body
EXPONENTS = (0.0, 0.5, 1.0, 1.5, 2.0)  # of the surface-weighted rule


class Body:
    """A part with everything the rules need; a drop test is made once and kept in a folder."""

    def __init__(self, name, part, drops, keep=None, jobs=1):
        self.name, self.part, self.aspects = name, part, find(part)
        self.ground = require_ground(part, self.aspects)
        self.tips, self.radius = self.ground.tips, self.ground.hull.radius
        self.drops, self.tallies, self.jobs, self.answers = drops, {}, jobs, {}
        self.file = None if keep is None else keep / f"{name}.json"
        if self.file and self.file.exists():
            kept = json.loads(self.file.read_text())
            self.tallies = {k: _tally({n: np.array(v) for n, v in t.items()}) for k, t in kept.items()}

    @property
    def rolling(self):
        """Whether one of the classes it rests on rolls."""
        return "rolling" in np.array(self.aspects.kinds)[self.aspects.stable]

    def by_class(self, weights):
        """Share of each class from a weight of each face."""
        sums = np.bincount(self.ground.rows, weights, minlength=len(self.aspects.names))
        return sums / sums.sum()

    def surfaces(self):
        """The surface-weighted rule's shares by class, by exponent."""
        heights, shares = self.tips.heights, self.tips.shares
        weights = {x: surface_weights(shares, heights, self.radius, x) for x in EXPONENTS}
        return {f"surface, {x:g}": self.by_class(weight) for x, weight in weights.items()}

    @cached_property
    def rules(self):
        found = {rule: p for rule, p in self.aspects.probabilities.items() if rule != "surface"}
        return found | self.surfaces()

    def tally(self, launch):
        if launch not in self.tallies:
            own, run = dict.fromkeys(launch_conditions.CONDITION_KEYS), RunSettings(jobs=self.jobs)
            tested = drop_test.test(self.part, self.aspects, launch, own, drops=self.drops, run=run)
            self.tallies[launch] = tested.tally
            self._keep()
        return self.tallies[launch]

    def drop(self, launch):
        counts = self.tally(launch).counts
        return counts / max(counts.sum(), 1)

    def closed(self, launch):
        if launch not in self.answers:
            self.answers[launch] = find(self.part, launch=launch).recommended
        return self.answers[launch]

    def answer(self, launch):
        return self.dropped(launch)

    def dropped(self, launch):
        return self.tally(launch).answer(launch)

    def _keep(self):
        if self.file:
            told = {
                launch: {name: np.asarray(getattr(one, name)).tolist() for name in KEPT}
                for launch, one in self.tallies.items()
            }
            self.file.write_text(json.dumps(told))


KEPT = ("counts", "unsettled", "p", "low", "high", "gentle", "violent")


def _tally(columns):
    return SimpleNamespace(**columns)


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


def rounds(count, rng):
    """Meshes of cylinders, headed shanks, frusta and rings at random, in turn."""
    for k in range(count):
        if k % 4 == 0:
            yield shapes.cylinder(rng.uniform(3.0, 10.0), rng.uniform(2.0, 20.0), SIDES)
        elif k % 4 == 1:
            head, shank = rng.uniform(5.0, 10.0), rng.uniform(2.0, 4.5)
            high, end = np.cumsum([rng.uniform(2.0, 8.0), rng.uniform(4.0, 20.0)])
            profile = [(0, 0), (head, 0), (head, high), (shank, high), (shank, end), (0, end)]
            yield trimesh.creation.revolve(profile, sections=SIDES)
        elif k % 4 == 2:
            wide, narrow, end = rng.uniform(5.0, 10.0), rng.uniform(2.0, 5.0), rng.uniform(3.0, 20.0)
            yield trimesh.creation.revolve([(0, 0), (wide, 0), (narrow, end), (0, end)], sections=SIDES)
        else:
            outer = rng.uniform(5.0, 10.0)
            inner, end = outer * rng.uniform(0.3, 0.8), rng.uniform(2.0, 14.0)
            profile = [(inner, 0), (outer, 0), (outer, end), (inner, end), (inner, 0)]
            yield trimesh.creation.revolve(profile, sections=SIDES)
