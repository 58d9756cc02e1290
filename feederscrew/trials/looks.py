"""In which orientation a part lies or hangs, by how far it reaches; on which aspect at any heading."""

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from feederscrew.arrivals.kernel.one_drop import UNSETTLED, face_below
from feederscrew.arrivals.rounded_hull import shape_of_part
from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.part.hull import convex_hull
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, require_ground
from feederscrew.resting.half_edges import Edges, half_edges
from feederscrew.resting.walks import LOST_WALK, roll_from_corner, roll_from_facet
from feederscrew.sorting.on_side import HEADING_OFFSETS
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.trials import part_poses
from feederscrew.trials.kernel.workspace import TrueSolid
from feederscrew.trials.part_poses import State

SAME_REACH_SHARE = 0.05  # of the part's size: one whose outline is off by more lies in no known orientation
OUTLINE_DIRECTIONS = 160
ALL_HEADINGS = np.radians(np.arange(0.0, 360.0, 2.0))  # the same where any heading of its aspect will do
HANGING_COSINE = np.cos(np.radians(40.0))  # a part below the track that is no further from upright hangs
OTHER = -1  # orientation: none of the known
# (3, 3) [1] axes of a twisted track from those of the track before it, both ahead, inwards and up: its floor
# stands as the wall at the inner side, its wall lies as the floor
ON_SIDE = check.frozen(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]))


class Looks:
    """Tells in which orientation a part lies, or next comes to lie, by how far it reaches in many directions.

    One that is in the air, or rocks, is named by the face on which it comes to lie if it is let go as it is:
    its tilt is then below the angle at which it tips over an edge of that face. Where it is along the track
    and how it is turned about the vertical stay as they are.

    One that lies turned by up to 10 deg, as a part that has just left a device may, is in the nearest. Where
    any heading of an aspect counts, one on that aspect is in the nearest of its orientations.
    Parts that hang swing and turn about the vertical: they are known by what of them is up.

    Parameters
    ----------
    orientations : sequence of Orientation
        In which a part may be.
    solid : TrueSolid
        The part, as ``solid_of`` returns it with its unit of length and its principal axes.
    length : float [m]
        The unit of length L.
    principal : (3, 3) float [1]
    radius : float [m]
        Of the wall.
    on_side : float [rad], optional
        By which the track is twisted where they are looked at, its wall with it; 0 where it is not.
    """

    def __init__(
        self,
        orientations: Sequence[Orientation],
        solid: TrueSolid,
        length: float,
        principal: Floats,
        radius: float,
        on_side: float = 0.0,
    ) -> None:
        self.directions, self.corners = vectors.spiral(OUTLINE_DIRECTIONS), solid.corners[solid.outer]
        postures: list[Any] = [orientation.posture for orientation in orientations]
        hanging = [k for k, orientation in enumerate(orientations) if isinstance(orientation, Hanging)]
        self.ups = {k: vectors.product(principal.T, postures[k].axes[2]) for k in hanging}
        self.half_height = 0.5 * min(p.height for k, p in enumerate(postures) if k not in self.ups) / length
        self.radius, self.same_reach = radius / length, SAME_REACH_SHARE * solid.radius
        # Gravity along the wall, inwards and up, on a track that climbs and is banked.
        track = orientations[0].track
        c, s = np.cos(track.climb), np.sin(track.climb)
        bank = on_side or track.bank
        self.gravity = np.array([-s, -c * np.sin(bank), -c * np.cos(bank)])
        self.turned = ON_SIDE if on_side else np.eye(3)
        self.gravity = vectors.product(self.turned, self.gravity)

        def reaches(orientation: Orientation, angles: Iterable[float]) -> Floats:
            """Return how far it reaches in each direction, lying at angles from its heading."""
            posture: Any = orientation.posture
            corners = posture.corners - np.array([0.0, 0.0, posture.height])
            rows = []
            for angle in angles:
                c, s = np.cos(orientation.heading + angle), np.sin(orientation.heading + angle)
                turned = vectors.product(corners, np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))
                rows.append(vectors.product(turned / length, self.directions.T).max(axis=0))
            return np.array(rows)

        self.reaches = np.array([reaches(orientation, HEADING_OFFSETS) for orientation in orientations])
        free = [k for k, orientation in enumerate(orientations) if orientation.any_heading]
        self.heading_reaches = {k: reaches(orientations[k], ALL_HEADINGS) for k in free}

    def find_orientations(self, states: Iterable[State]) -> Ints:
        """Return the orientation in which each part lies, hangs, or comes to lie.

        Parameters
        ----------
        states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]

        Returns
        -------
        (N,) int
            Rows of the orientations; OTHER where it is none of them.
        """
        rows = []
        for state in states:
            turn = self._attitude(state)
            if self.ups and state[2] < self.half_height:
                up = {k: float(vectors.dot(turn[2], direction)) for k, direction in self.ups.items()}
                hanging = [k for k in up if up[k] > HANGING_COSINE]
                rows.append(max(hanging, key=up.__getitem__, default=OTHER))
                continue
            row = self._match(self._reach(turn))
            if row == OTHER and (rest := self._settle(turn)) is not None:
                row = self._match(self._reach(rest))
            rows.append(row)
        return np.array(rows, int)

    def find_nearest(self, states: Iterable[State]) -> Ints:
        """Return the orientation that is nearest as each part comes to lie, however far off it is.

        Parameters
        ----------
        states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]

        Returns
        -------
        (N,) int
            Rows of the orientations.
        """
        rows = []
        for state in states:
            turn = self._attitude(state)
            rest = self._settle(turn)
            reach = self._reach(turn if rest is None else rest)
            rows.append(int(np.argmin(np.abs(self.reaches - reach).max(axis=2).min(axis=1))))
        return np.array(rows, int)

    def _attitude(self, state: State) -> Floats:
        """The attitude of a part, as it were at the place 0 along the wall."""
        place = np.arctan2(state[0], self.radius - state[1])
        back = part_poses.move_along_wall(state[None], -place * self.radius, self.radius)[0]
        return vectors.product(self.turned, part_poses.matrix(back))

    def _reach(self, turn: Floats) -> Floats:
        """Return how far a part reaches in each direction."""
        corners = vectors.product(self.corners, turn.T)
        return vectors.product(corners, self.directions.T).max(axis=0)

    def _match(self, reach: Floats) -> int:
        """The orientation of a part that reaches so far, or that it is turned from the least; else OTHER."""
        off = np.abs(self.reaches - reach).max(axis=2).min(axis=1)
        best = int(np.argmin(off))
        if off[best] < self.same_reach:
            return best
        away = np.minimum(ALL_HEADINGS, 2.0 * np.pi - ALL_HEADINGS)
        gaps = {k: np.abs(reaches - reach).max(axis=1) for k, reaches in self.heading_reaches.items()}
        by = {k: float(away[gap < self.same_reach].min(initial=np.inf)) for k, gap in gaps.items()}
        return min((k for k in by if np.isfinite(by[k])), key=by.__getitem__, default=OTHER)

    def _settle(self, turn: Floats) -> Floats | None:
        """The attitude of a part as it comes to lie if let go, its heading kept; None where on no face."""
        down = vectors.product(turn.T, self.gravity)
        corner = int(np.argmax(vectors.product(self._edges.vertices, down)))
        facet = roll_from_facet(self._edges, roll_from_corner(self._edges, tuple(down), corner))
        if facet == LOST_WALK:
            return None
        # The rotation by the shortest way of the face's normal straight down.
        x, y, z = vectors.product(turn, self._edges.normals[facet])
        if z > 1.0 - 1e-9:  # from straight up any way is as short
            return vectors.product(np.diag([1.0, -1.0, -1.0]), turn)
        spin = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])
        return vectors.product(np.eye(3) + spin + vectors.product(spin, spin) / (1.0 - z), turn)

    @cached_property
    def _edges(self) -> Edges:
        return half_edges(convex_hull(self.corners, np.zeros(3)))


class AspectsBelow:
    """Tells on which aspect a part lies, or would come to lie if let go as it is, whatever its heading.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    twisted_radius : float [L], optional
        Of the wall, where they are looked at on a twisted track; 0 on one that is not.
    """

    def __init__(self, part: Part, aspects: Aspects, twisted_radius: float = 0.0) -> None:
        self.twisted_radius = twisted_radius
        faces = require_ground(part, aspects)
        self.shape, _ = shape_of_part(part, faces)
        self.rows = faces.rows

    def find_aspects(self, states: Iterable[State]) -> Ints:
        """Return the aspect on which each part lies or would come to lie.

        Parameters
        ----------
        states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]

        Returns
        -------
        (N,) int
            Rows of the aspects; OTHER where it would come to lie on none.
        """
        rows = []
        for state in states:
            turn = part_poses.matrix(state)
            if self.twisted_radius:
                theta = np.arctan2(state[0], self.twisted_radius - state[1])
                c, s = np.cos(theta), np.sin(theta)
                at_start = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
                turn = vectors.product(ON_SIDE, vectors.product(at_start, turn))
            lowest = int(np.argmin(vectors.product(self.shape.solid.vertices, turn[2])))
            face = face_below(self.shape, turn.ravel(), lowest)
            rows.append(OTHER if face == UNSETTLED else self.rows[face])
        return np.array(rows, int)
