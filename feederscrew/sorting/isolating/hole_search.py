"""Holes of three to six corners that separate orientations which devices of one number cannot.

Their corners are round, as a cutter or a laser leaves them. Source: own; docs/tooling.md, "1. The method".
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.base.arrays import Points
from feederscrew.bowl.devices import openings
from feederscrew.bowl.devices.base import Device, carried
from feederscrew.bowl.devices.openings import CutOut, HoleEdges
from feederscrew.bowl.devices.values import crossed
from feederscrew.sorting import footprints
from feederscrew.sorting.isolating.chain import DESIGN_KEY, SHOP_ROUNDING_M, Cut, DesignTask, judge_cut
from feederscrew.sorting.orientations import Orientation
from feederscrew.sorting.verdicts import verdict

if TYPE_CHECKING:
    from feederscrew.sorting.kernel import Buffers, Foot

STARTS = 220  # random holes tried
IMPROVED_HOLES = 6  # the best of them are improved
CHANGES_PER_CORNER = 100  # changes tried of each
HOLE_REACH_FACTOR = 1.3  # holes reach so far beyond the foot
CORNER_STEP_M = 5e-5  # [m] to which a corner is rounded
ENOUGH_MARGINS = 500.0  # of a score: a hole passes the wanted one and returns any other
SCORE_TOLERANCE_M = 1e-12  # [m] of a score
MAX_HOLE_VERDICTS = 30000  # in the search for the holes of one orientation
ARC = 6  # chords of a quarter of a round corner
BEYOND_HOLE_M = 1.0  # [m] beyond any hole

Hole = tuple[Cut, list[int]]  # and the places of the orientations it returns
ScoredHole = tuple[Points, list[float]]  # corners, and the margins [m] of the orientations to be returned


@dataclass
class HoleSearch:
    """Limits of the search for holes: by a count of verdicts, the same on every machine."""

    seed: int = 1
    verdicts: int = MAX_HOLE_VERDICTS  # for one orientation; then the best so far is taken
    until: float = math.inf  # [s] of time.monotonic(): the last resort
    late: bool = False  # whether that was reached
    spent: int = 0  # verdicts so far
    memo: dict = field(default_factory=dict)  # what whole searches gave, and the verdicts each took

    def start(self) -> "HoleSearch":
        """Return the same search for another orientation."""
        return replace(self, spent=0, late=False)

    def over(self) -> bool:
        """Tell whether one of the limits is reached."""
        if self.spent >= self.verdicts:
            return True
        self.late = self.late or time.monotonic() > self.until
        return self.late


def cut_out(
    orientations: Sequence[Orientation],
    wanted: int,
    competitors: Sequence[int],
    margin: float,
    search: HoleSearch,
) -> Hole | None:
    """Return the hole that the wanted orientation passes and that returns the most others.

    Parameters
    ----------
    orientations : sequence of Orientation
    wanted : int
        The place of the wanted one.
    competitors : sequence of int
        The places of others.
    margin : float [m]
        To either side.
    search : HoleSearch
        It counts what is spent.

    Returns
    -------
    Hole or None
        A Cut, and the places of those of the competitors that it returns by the margin.
    """
    judge = _Judge(orientations, wanted, competitors, margin, search)
    best = judge.find_best()
    if best is None and any(orientations[k].name == orientations[wanted].mirror for k in competitors):
        # a hole that parts the mirror images, fore and aft, mirrored parts these
        places = {orientation.name: k for k, orientation in enumerate(orientations)}
        image = [places.get(orientation.mirror, k) for k, orientation in enumerate(orientations)]
        mirrored = sorted(image[k] for k in competitors)
        best = _Judge(orientations, image[wanted], mirrored, margin, search).find_best()
        if best is not None:
            corners = best[0] * [-1.0, 1.0]
            corners[:, 0] -= corners[:, 0].min()
            score, margins = judge.score(corners)
            best = (corners, margins) if margins is not None and score >= ENOUGH_MARGINS * margin else None
    if best is None:
        return None
    corners, margins = best
    held = [k for k, reached in zip(competitors, margins) if reached <= -margin]
    must, middle = np.isin(np.arange(len(orientations)), held), corners.mean(axis=0)

    def scale(share: float) -> Points:
        shape = middle + share * (corners - middle)
        shape[:, 1] = np.maximum(shape[:, 1], 0.0)
        return shape

    def passes(share: float) -> bool:
        hole = openings.polygon(scale(share), orientations[wanted].track.radius)
        return footprints.least(orientations[wanted].axial_foot, hole)[0] >= 0.0

    def returns(share: float) -> bool:
        device = device_of(scale(share))
        return all(verdict(device, orientations[k], orientations).margin < 0.0 for k in held)

    ends = (device_of(scale(_border(*task))) for task in ((returns, 0.0), (passes, 2.0)))
    return judge_cut(orientations, wanted, device_of(corners), must, *ends), held


def _border(holds: Callable[[float], bool], outside: float) -> float:
    """The last share of a hole, from 1 on, for which something holds."""
    inside = 1.0
    if outside > 0.0 and holds(outside):
        return outside
    for _ in range(24):
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if middle > 0.0 and holds(middle) else (inside, middle)
    return inside


class _Judge:
    """Scores of holes: whole margins gained, others returned first."""

    def __init__(
        self,
        orientations: Sequence[Orientation],
        wanted: int,
        competitors: Sequence[int],
        margin: float,
        search: HoleSearch,
    ) -> None:
        self.search, self.radius, self.margin = search, orientations[wanted].track.radius, margin
        self.places = wanted, *competitors
        self.orientations = wanted_orientation, *self.others = [orientations[k] for k in self.places]
        self.foot = wanted_orientation.axial_foot
        self.length = HOLE_REACH_FACTOR * max(orientation.length for orientation in self.orientations)
        self.width = max(orientation.width for orientation in self.orientations)
        self.scratch: dict[tuple[int, int], Buffers] = {}
        self.order = list(range(len(competitors)))  # those that spoiled a hole last come first

    def find_best(self) -> ScoredHole | None:
        """The best hole, as (corners, margins of the others), or None.

        A whole search is made once, and so is one that the count of verdicts ends, for the same count.
        """
        search = self.search
        feet = ((one.foot, one.distance, one.shift, one.track.radius, one.carry) for one in self.orientations)
        key = (*self.places, self.margin, *feet)
        before, left = search.spent, search.verdicts - search.spent
        best, spent = search.memo.get((key, left)) or search.memo.get((key, None), (None, math.inf))
        if spent < left or (key, left) in search.memo:
            search.spent += spent
            return best
        best = self._search(np.random.default_rng((search.seed, *self.places)))
        if not search.late:
            search.memo[key, left if search.over() else None] = best, search.spent - before
        return best

    def score(self, corners: Points, least_score: float = -math.inf) -> tuple[float, list[float] | None]:
        """(score, margins of the others); (-infinity, None) where it does not pass or is not better."""
        hole = openings.polygon(corners, self.radius)
        self.search.spent += 1
        pass_margin = self._least(self.foot, hole, -self.margin, 2.0 * self.margin)[0]
        if pass_margin < -self.margin:
            return -math.inf, None
        self.search.spent += len(self.others)  # also of those that need not be asked for
        margins = [-2.0 * self.margin] * len(self.others)
        if self._worth(pass_margin, margins) <= least_score:
            return -math.inf, None
        for place, k in enumerate(self.order):
            # from which margin on the hole is not better, whatever the rest may add
            spoilt = math.inf
            if least_score > -math.inf:
                nearly = [*margins[:k], math.nextafter(-self.margin, 0.0), *margins[k + 1 :]]
                better = max(self._worth(pass_margin, nearly) - least_score, 0.0)
                spoilt = -self.margin + better + SCORE_TOLERANCE_M
            # of one that travels; what fails by too little anyway is left as it is placed
            orientation, enough = self.others[k], 2.0 * self.margin
            margins[k], work = self._least(orientation.axial_foot, hole, -enough, spoilt)
            if margins[k] <= -self.margin and orientation.carry > 0.0:
                unheld = footprints.unheld(orientation.axial_foot, hole, work, orientation.carry + enough)
                margins[k] = carried(margins[k], unheld, orientation.carry)
            if margins[k] > -2.0 * self.margin and self._worth(pass_margin, margins) <= least_score:
                self.order.insert(0, self.order.pop(place))
                return -math.inf, None
        return self._worth(pass_margin, margins), margins

    def _worth(self, pass_margin: float, margins: Sequence[float]) -> float:
        """The score of a hole: the worse of passing and of returning, at most the margin twice."""
        returned = sum(margin <= -self.margin for margin in margins)
        ready = pass_margin >= self.margin
        total = sum(min(-margin, 2.0 * self.margin) for margin in margins)
        gain = min(pass_margin, 2.0 * self.margin) * max(len(margins), 1) + total
        nearest = min(pass_margin - self.margin, max(-margin for margin in margins) - self.margin)
        return (returned if ready else 0) * 1e3 * self.margin + 3.0 * min(nearest, 0.0) + gain

    def _search(self, rng: np.random.Generator) -> ScoredHole | None:
        """The best hole, as (corners, margins), if it passes the wanted one and returns any other."""
        holes: list[tuple] = []  # (score, margins, corners), the best first
        for _ in range(STARTS):
            if self.search.over():
                break
            # about a random place, corners in order of angle
            count = int(rng.integers(3, 7))
            turn = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
            far = np.array([self.length, self.width]) * rng.uniform(0.1, 0.9, (count, 1))
            middle = np.array([0.0, rng.uniform(0.0, self.width)])
            corners = self._tidy(middle + 0.5 * far * np.column_stack([np.cos(turn), np.sin(turn)]))
            if corners is not None:
                least_score = holes[-1][0] if len(holes) == IMPROVED_HOLES else -math.inf
                holes.append((*self.score(corners, least_score), corners))
                holes = sorted(holes, key=lambda hole: -hole[0])[:IMPROVED_HOLES]
        climbed = []
        for score, margins, corners in holes:  # improved by moving a corner, or all of it, at random
            size = 0.15 * self.width
            for _ in range(CHANGES_PER_CORNER):
                if self.search.over() or margins is None:
                    break
                moved = corners.copy()
                if rng.random() < 0.25:
                    moved += rng.normal(0.0, size, 2)
                else:
                    moved[rng.integers(len(moved))] += rng.normal(0.0, size, 2)
                moved = self._tidy(moved)
                if moved is None:
                    continue
                better, gained = self.score(moved, score)
                if better > score:
                    score, margins, corners = better, gained, moved
                else:
                    size = max(0.93 * size, 2.0 * self.margin)
            climbed.append((score, margins, corners))
        best = max(climbed, key=lambda hole: hole[0], default=None)
        return (best[2], best[1]) if best and best[0] >= ENOUGH_MARGINS * self.margin else None

    def _tidy(self, corners: Points) -> Points | None:
        """The corners on the grid and over the track; None where they cross or leave no area."""
        corners = corners.copy()
        corners[:, 1] = np.clip(corners[:, 1], 0.0, min(1.2 * self.width, 0.9 * self.radius))
        corners[:, 0] -= corners[:, 0].min()
        corners = np.round(corners / CORNER_STEP_M) * CORNER_STEP_M
        pairs = [tuple(corner) for corner in corners.tolist()]
        sides = zip(pairs, (*pairs[1:], pairs[0]))
        area = 0.5 * abs(sum(x0 * y1 - y0 * x1 for (x0, y0), (x1, y1) in sides))
        return None if area < (4.0 * self.margin) ** 2 or crossed(pairs) else corners

    def _least(self, foot: "Foot", hole: HoleEdges, low: float, high: float) -> tuple[float, "Buffers"]:
        """Least margin as far as it lies between two values, and the arrays for holes of that size."""
        key = edges, nodes = 8 * (1 + len(hole.edges) // 8), 64 * (1 + len(hole.nodes) // 64)
        if key not in self.scratch:
            feet = (self.foot, *(orientation.axial_foot for orientation in self.others))
            self.scratch[key] = footprints.scratch(*feet, edges=edges, nodes=nodes)
        return footprints.least(foot, hole, self.scratch[key], low, high)[0], self.scratch[key]


def device_of(corners: Points) -> Device:
    """Return the hole of some corners as a device.

    Parameters
    ----------
    corners : (K, 2) float [m]
        Along the wall, and from it.

    Returns
    -------
    CutOut
    """
    return CutOut(DESIGN_KEY, corners=tuple((float(x), float(y)) for x, y in corners)).rewritten()


def round_corners(task: DesignTask, hole: Hole, radius: float) -> Hole | None:
    """Return a hole with round corners, as a cutter leaves them.

    Parameters
    ----------
    task : DesignTask
    hole : Hole
        From ``cut_out``.
    radius : float [m]

    Returns
    -------
    Hole or None
        None where it then does not do by the margin of the task.
    """
    cut, held = hole
    open_ = [(x, y if y > 0.0 else -BEYOND_HOLE_M) for x, y in cut.device.corners]  # it goes on into the wall
    round_ = shapely.Polygon(open_).buffer(-radius).buffer(radius, quad_segs=ARC)
    round_ = round_.intersection(shapely.box(-BEYOND_HOLE_M, 0.0, BEYOND_HOLE_M, BEYOND_HOLE_M))
    if round_.geom_type != "Polygon" or round_.is_empty:
        return None
    corners = np.round(shapely.get_coordinates(round_.exterior)[:-1] / SHOP_ROUNDING_M) * SHOP_ROUNDING_M
    must, ends = np.isin(np.arange(len(task.orientations)), held), (cut.smallest, cut.largest)
    rounded = judge_cut(task.orientations, task.wanted, device_of(corners), must, *ends)
    return (rounded, held) if min(rounded.margin_pass, rounded.margin_reject) >= task.margin else None
