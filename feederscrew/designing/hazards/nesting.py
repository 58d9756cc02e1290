"""Parts that nest: one goes into the next, shifted and not turned, and friction holds it there."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.designing.hazards.pulling import WAYS
from feederscrew.geometry import vectors
from feederscrew.geometry.lattice import chords
from feederscrew.part.record import Part
from feederscrew.trial.shape import solid_of

LINES, NEAR, NESTED = 60, 0.02, 0.3  # lines through a part; of their longest; of a part that is in another
ROUND = 0.5  # mean of the sides' normals: what touches on one side only slides off


@dataclass(frozen=True, eq=False)
class Stack:
    """A part in another of its kind, shifted and not turned."""

    place: np.ndarray  # (3,) [m] of the second part from the first, in the file's axes
    height: float  # [m] of one of them along that direction
    side: float  # [rad] between that direction and the sides on which they touch

    @property
    def depth(self) -> float:
        """How far the one is in the other [m]."""
        return self.height - float(vectors.norm(self.place))


def stack(part: Part, friction: float) -> Stack | None:
    """Return how a part sits in another, shifted and not turned, where friction holds it; else None.

    Two such parts touch where the upright chord of the one is longest, its hollows counted in: that is how
    far apart they are. Where their sides all round are steeper there than friction holds, they stay so.

    Source: own; docs/design.md, "7. Risks between parts".

    Parameters
    ----------
    part : Part
        From a mesh.
    friction : float [1]
        Of part on part.

    Returns
    -------
    Stack or None
        Of all directions the one in which it goes in deepest.
    """
    solid, length, principal = solid_of(part)
    found = []
    for way in WAYS[len(WAYS) // 2 :]:
        axes = _upright(way)
        corners = vectors.product(solid.vertices, axes.T)
        chord, low, high = chords(corners, solid.triangles, LINES)
        whole = float(np.ptp(corners[:, 2]))
        touching = chord > (1.0 - NEAR) * chord.max()
        sides = [vectors.product(solid.normals[own[touching]], axes.T) for own in (low, high)]
        steep = [np.arctan2(np.abs(one[:, 2]), np.hypot(one[:, 0], one[:, 1])) for one in sides]
        side = float(np.median(np.maximum(*steep)))
        lean = np.hypot(*sides[1][:, :2].mean(axis=0))  # 0 where they touch all round
        deep = 1.0 - float(chord.max()) / whole
        if deep > NESTED and side < np.arctan(friction) and lean < ROUND:
            place = length * float(chord.max()) * vectors.product(principal, way)
            found.append(Stack(check.frozen(place), length * whole, side))
    return min(found, key=lambda one: vectors.norm(one.place) / one.height, default=None)


def _upright(way: np.ndarray) -> np.ndarray:
    """Axes (3, 3) as rows, of which the third is a direction (3,)."""
    aside = np.cross(way, np.eye(3)[int(np.argmin(np.abs(way)))])
    aside = vectors.unit(aside)
    return np.array([aside, np.cross(way, aside), way])
