"""The parts that come to a queue: in which orientation and pose, and how far behind the part before."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.base.arrays import Floats, Points
from feederscrew.sorting.orientations import Orientation
from feederscrew.trials import part_poses, runs
from feederscrew.trials.part_poses import State

MEAN_GAP_SHARE = 0.2  # of a part's length: mean free way between parts as they come in a row
PARTS_IN_SHARES = 40  # parts that come in exact shares
POURED_SPACING = 1.05  # of the part's radius: off the wall, and over the track at least, of poured parts


@dataclass(frozen=True)
class QueuePlan:
    """Plan of a queue: its number of parts, how they come, and how long they are followed."""

    parts: int
    seconds: float  # [s] at most
    # [1] mean free way between parts as they come in a row, over their length, beside the room that devices
    # need; 0 where they come touching. None: they fall onto the track in any attitude, not in a row
    gaps: float | None = MEAN_GAP_SHARE
    frames: int = 0  # poses of all parts that are noted for a film
    is_balanced: bool = False  # orientations in exact shares, in random order; else each is drawn by itself
    is_ridden: bool = False  # they come as a ride up the bowl leaves them: where devices need room between
    # parts, these do not push each other, and a short bare track does


class NextPart(NamedTuple):
    """A part to come; lengths in units of the part's."""

    row: int  # of its orientation
    state: State  # (13,) at the place 0
    gap: float  # [L] free way to the part ahead of it
    rear: float  # [L] along the wall, from the place 0
    front: float


class PartSupply:
    """Parts without end, drawn one by one; the same seed and number of parts give the same ones.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    orientations : sequence of Orientation
        The M in which parts come.
    shares : (M,) float [1]
        In which they come; the sum is 1.
    principal : (3, 3) float [1]
        Principal axes of the part, as rows, in the axes of its file.
    plan : QueuePlan
    spacing : float [L]
        Room that the devices need between two parts, in units of the part's length.
    seed : int
        Of play, gaps, tilt and the order of the orientations.
    """

    def __init__(
        self,
        part_in_bowl: runs.BowlOfPart,
        orientations: Sequence[Orientation],
        shares: Floats,
        principal: Points,
        plan: QueuePlan,
        spacing: float,
        seed: int,
    ) -> None:
        self.part_in_bowl, self.orientations, self.plan = part_in_bowl, orientations, plan
        self.principal, self.spacing = principal, spacing
        self.hull = part_in_bowl.solid.corners[part_in_bowl.solid.outer]
        self.chances = np.cumsum(shares)
        count = plan.parts
        self.rng, self.tilts = (np.random.default_rng(key) for key in ((seed, count), (seed, count, 1)))
        self.drawn_rows: list[int] = []  # orientations of the parts to come
        self.waiting: NextPart | None = None  # drawn, and not taken yet

    def see_next(self) -> NextPart:
        """Return the part that comes next, the same one until it is taken.

        Were another drawn for a part that finds no room, short ones would come more often than they do.
        """
        self.waiting = self.waiting or self._draw_part()
        return self.waiting

    def take_next(self) -> NextPart:
        """Return the part that comes next; behind it another one comes."""
        part, self.waiting = self.see_next(), None
        return part

    def _draw_part(self) -> NextPart:
        row = self._draw_orientation()
        orientation, solid, length = self.orientations[row], self.part_in_bowl.solid, self.part_in_bowl.length
        if self.plan.gaps is not None:
            track, play = orientation.track, part_poses.MAX_START_PLAY_M * self.rng.random()
            state = part_poses.pose_on_track(orientation, self.principal, length, track, place=0.0)
            state = part_poses.tilt_state(state, solid.corners, self.tilts)
            state = part_poses.set_play(state, solid, track, length, play, orientation.wall_leans)
            gap = self.spacing + 2.0 * self.plan.gaps * self.rng.random() * orientation.length / length
        else:
            state, turn, gap = np.zeros(body.STATE), self.rng.standard_normal(4), 0.0
            over = solid.radius * POURED_SPACING
            state[:3] = 0.0, over, over * (1.0 + self.rng.random())
            state[body.Q : body.Q + 4] = turn / np.sqrt((turn**2).sum())
        rear, front, _ = part_poses.reaches(state[None], self.hull, self.part_in_bowl.radius)[0]
        return NextPart(row, state, gap, rear, front)

    def _draw_orientation(self) -> int:
        """The row of the orientation in which the next part comes.

        Balanced, PARTS_IN_SHARES parts come in their shares as nearly as whole parts can, in random order: a
        systematic sample (W. G. Cochran, "Sampling techniques", 3rd ed., 1977, ch. 8).
        """
        last, most = len(self.orientations) - 1, self.chances[-1]
        if not self.plan.is_balanced:
            return min(int(np.searchsorted(self.chances, self.rng.random() * most)), last)
        if not self.drawn_rows:
            points = (np.arange(PARTS_IN_SHARES) + self.rng.random()) / PARTS_IN_SHARES * most
            rows = np.minimum(np.searchsorted(self.chances, points), last)
            self.drawn_rows = self.rng.permutation(rows).tolist()
        return self.drawn_rows.pop()
