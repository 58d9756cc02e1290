"""Risks that are said before steel is cut: parts that shingle, hook, nest, wedge, or climbed in the queue."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.designing.hazards import nesting, tangling, wedging
from feederscrew.geometry import vectors
from feederscrew.geometry.polygons import turned
from feederscrew.part.record import Part
from feederscrew.tooling.isolating.chain import in_mm
from feederscrew.tooling.orientations import Orientation
from feederscrew.units import counted

LIFT = (
    0.25e-3  # [m] by which one part may lie higher than the next: play, burrs and dirt, as a design's margin
)
CLEARS = 2  # status of a linear programme without a solution: so much higher nothing meets
SHINGLES, CLIMBS, HOOKS, NESTS, WEDGES = "shingles", "climbs", "hooks", "nests", "wedges"


@dataclass(frozen=True, eq=False)
class Pair:
    """A part and another of its kind, or the walls that it stands between, as it is drawn."""

    axes: np.ndarray  # (3, 3) [1] of the picture as rows, in the file's axes: along, across, up
    turn: np.ndarray | None = None  # (3, 3) [1] of the second part, in the file's axes
    place: np.ndarray | None = None  # (3,) [m] of its centre of mass from that of the first, in those axes
    walls: float = np.nan  # [m] apart, square to what is across; NaN of two parts


@dataclass(frozen=True, eq=False)
class Risk:
    """What may go wrong between parts."""

    kind: str  # 'shingles', 'climbs', 'hooks', 'nests', 'wedges'
    text: str
    pair: Pair | None = None  # what is drawn of it


class QueueSeen(Protocol):
    """A queue that was followed, as far as it tells of risks."""

    @property
    def climbs(self) -> int:
        """How often a part climbed on another."""

    @property
    def seconds(self) -> float:
        """How long it was followed [s]."""


def wedge(one: Orientation, lift: float = LIFT) -> float:
    """Return the angle [rad] at which a part is pushed up on another where it lies a little higher.

    Two parts of one orientation follow each other along the track, one of them higher by ``lift``. They come
    together until their hulls touch, L apart. Pushed on, the higher one rises as the plane does in which they
    touch: by -dL/d(lift) along the track for each unit upwards.

    Source: own; docs/design.md, "7. Risks between parts".

    Parameters
    ----------
    one : Orientation
    lift : float [m]

    Returns
    -------
    float
        The smaller angle above the track of the two: either the part behind is higher or the one before. A
        quarter of a turn where upright sides meet, more where the plane pushes the higher one down, 0 where
        one clears the other.
    """
    return min(_rise(one, sign, lift)[0] for sign in (1.0, -1.0))


def _rise(one: Orientation, sign: float, lift: float) -> tuple[float, float]:
    """The angle where the part behind is higher (+1) or the part before (-1), and how far apart they are.

    L is the largest q_x - p_x of points q of the part behind and p of the part before that meet: a linear
    programme in the shares of the corners, whose multiplier of the height is dL/d(lift).
    """
    from scipy.optimize import linprog

    points = one.posture.surface
    x, y = turned(points[:, :2], one.heading).T
    z, count = points[:, 2], len(points)
    whole, none = np.ones(count), np.zeros(count)
    rows = [np.append(whole, none), np.append(none, whole), np.append(y, -y), np.append(-z, z)]
    right = [1.0, 1.0, 0.0, sign * lift]  # shares of q, of p; beside each other; p_z - q_z
    found = linprog(np.append(-x, x), A_eq=rows, b_eq=right, method="highs")
    if found.status == CLEARS:
        return 0.0, 0.5 * float(np.ptp(x))
    return math.atan2(1.0, sign * found.eqlin.marginals[3]), -float(found.fun)


def risks(
    one: Orientation,
    bowl: Bowl,
    queues: Sequence[QueueSeen],
    *,
    every: Sequence[Orientation] = (),
    seed: int = 1,
) -> tuple[Risk, ...]:
    """Say what may go wrong between parts.

    Parameters
    ----------
    one : Orientation
        That is wanted, of a part from a mesh.
    bowl : Bowl
        Its friction is also that of part on part.
    queues : sequence of FilledQueue
        What was seen.
    every : sequence of Orientation
        All that come often enough to matter.
    seed : int

    Returns
    -------
    tuple of Risk
    """
    part = one.posture.solid
    found = [*_shingling(one, bowl.friction.kinetic), *_climbing(queues)]
    if part is not None:
        found += [*_nesting(part, bowl), *_tangling(part, bowl, seed)]
    return (*found, *_wedging(every or (one,), bowl))


def _shingling(one: Orientation, friction: float) -> Iterator[Risk]:
    held = math.atan(friction)
    angle, apart, sign = min((*_rise(one, sign, LIFT), sign) for sign in (1.0, -1.0))
    higher = f"where one lies {1e3 * LIFT:.3g} mm higher than the next it"
    if angle >= held:
        return
    if angle <= 0.0:
        text = f"{one.name} may shingle: {higher} slides onto it"
    else:
        text = (
            f"{one.name} may shingle: {higher} is pushed up a side of {math.degrees(angle):.3g} deg, and "
            f"friction holds it up to {math.degrees(held):.3g} deg"
        )
    before = vectors.product(np.array([apart, 0.0, -sign * LIFT]), one.axes)
    yield Risk(SHINGLES, text, Pair(one.axes, np.eye(3), check.frozen(before)))


def _climbing(queues: Sequence[QueueSeen]) -> Iterator[Risk]:
    climbs = sum(seen.climbs for seen in queues)
    if climbs:
        seconds = sum(seen.seconds for seen in queues)
        yield Risk(CLIMBS, f"parts climbed on others {counted(climbs, 'time')} in {seconds:.3g} s of queue")


def _nesting(part: Part, bowl: Bowl) -> Iterator[Risk]:
    found = nesting.stack(part, bowl.friction.static)
    if found is not None:
        held, side = math.degrees(math.atan(bowl.friction.static)), math.degrees(found.side)
        text = (
            f"parts may nest: one goes {in_mm(found.depth)} of {in_mm(found.height)} into the "
            f"next; its sides are {side:.3g} deg off that way, and friction holds it up to {held:.3g} deg"
        )
        yield Risk(NESTS, text, Pair(np.eye(3), np.eye(3), found.place))


def _tangling(part: Part, bowl: Bowl, seed: int) -> Iterator[Risk]:
    found = tangling.tangle(part, (bowl.friction.static, bowl.friction.kinetic), seed)
    if found is None:
        return
    pulls = f"{found.held} of {found.pulls} pulls do not part two of them"
    pair = Pair(np.eye(3), found.turn, found.place)
    if np.isfinite(found.opening):
        text = (
            f"parts may hook into each other: {pulls}; {in_mm(found.section)} of them come through a "
            f"mouth of {in_mm(found.opening)}"
        )
        yield Risk(HOOKS, text, pair)
    else:
        yield Risk(HOOKS, f"parts may catch in each other: {pulls}", pair)


def _wedging(every: Sequence[Orientation], bowl: Bowl) -> Iterator[Risk]:
    """Those that come between the wall and what stands at the free edge, such as the chute's other wall."""
    wall, width = bowl.friction.wall, bowl.track.width
    for one in every:
        between = wedging.walls_between(one, wall)
        if between is None or not between[0] < width < between[1]:
            continue
        text = (
            f"{one.name} may wedge across a chute as wide as the track, {in_mm(width)}: friction holds "
            f"it between walls {in_mm(between[0])} to {in_mm(between[1])} apart"
        )
        c, s = math.cos(wedging.strut(one, width)), math.sin(wedging.strut(one, width))
        x, y, z = one.axes
        yield Risk(WEDGES, text, Pair(np.array([c * x - s * y, s * x + c * y, z]), walls=width))
        return
