"""A part that a twisted track stands on its side: whether it stays on both faces, and how it then lies.

A twisted track turns floor and wall together about the corner between them. The floor stands up as a wall at
the inner side, the wall lies down as the floor, and the part goes on on the side that was at the wall.

Axes turn with the track, from the part's centre of mass: x ahead, y from the wall inwards, z off the floor.
The *foot* is where the part touches the floor, the *side* where it touches the wall.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import cast

import numpy as np
import shapely

from feederscrew.base.arrays import Floats, Points
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import turned
from feederscrew.motion import sameness
from feederscrew.motion.track_balance import seat
from feederscrew.part.hull import convex_hull
from feederscrew.resting.posture import Posture
from feederscrew.sorting.orientations import Orientation

# [rad] turns about the heading of an orientation, within which a part that lies so is known as that one
HEADING_OFFSETS = np.radians(np.linspace(-10.0, 10.0, 11))
REACH_DIRECTIONS, REACH_TOLERANCE = 160, 0.05  # reaches that are compared; of the part's size, how alike
HEIGHT_SHARE = 0.3  # of the part's size: an aspect whose reach upwards or downwards is off by more is another
SIDE_COSINE = np.cos(
    np.radians(6.0)
)  # a flat side of the hull that is turned from the wall by less lies at it
SIDE_EDGE_M = 1e-8  # [m] within an end of it, where that is met
SIDE_DEPTH_SHARE = 1e-4  # of the part's size: corners that near to its plane are of it
SIDE_HEADINGS = np.radians(np.arange(360.0))  # at which a part may lie on its side


@dataclass(frozen=True)
class SideLevers:
    """Levers of the weight of a part on both faces of a twisted track [m], moments over weight.

    Where ``out``, ``back`` or ``along`` is negative the part turns.
    """

    out: float  # against tipping away from the floor that has become a wall
    back: float  # against its top tipping onto that floor while its lower end slides away from the corner
    along: float  # against tipping ahead or back over an end of the side
    height: float  # of the centre of mass over the wall that has become the floor

    @property
    def least(self) -> float:
        """Return the least of ``out``, ``back`` and ``along`` [m]."""
        return min(self.out, self.back, self.along)


def side_levers(orientation: Orientation, angle: float) -> SideLevers:
    """Return by how much its weight keeps a part on both faces of a track that is twisted by an angle.

    Floor and wall stand square to each other, and the floor has risen by the angle. Friction counts as none:
    contacts of a vibrating track slip. So the floor presses with W cos(angle), W the weight, at a distance y
    within the foot, and the wall with W sin(angle) at a height z within the side. Both do so in the plane
    x = 0, and moments about x balance where y cos(angle) = z sin(angle). With y from ``near`` to ``far`` and
    z from ``bottom`` to ``top`` such a place exists where both of these are 0 or more:

        out = top sin(angle) - near cos(angle),  back = far cos(angle) - bottom sin(angle).

    They are the level distances of the centre of mass from the points (near, top) and (far, bottom), in which
    the forces at these ends meet. ``along`` is the x of the side's nearer end times sin(angle), at the height
    of the centre of mass: that of a side which is not as high there is taken at its nearest edge. That the
    part turns on the wall is left out: then it goes on askew and does not fall. 0 is the limit of a part at
    rest; nothing is taken off for vibration.

    Parameters
    ----------
    orientation : Orientation
        As it lies against the wall.
    angle : float [rad]
        Of the floor from level, 0 to a right angle.

    Returns
    -------
    SideLevers
        All but ``height`` are NaN of a part of which it is not known where it touches the wall.

    References
    ----------
    Statics of a rigid body on two faces without friction; docs/tooling.md, "A twisted track".
    """
    if orientation.touching is None:
        return SideLevers(math.nan, math.nan, math.nan, orientation.distance)
    side, foot = _side_at_wall(orientation), turned(orientation.posture.contact, orientation.heading)
    (bottom, top), (near, far), (rear, ahead) = _across(side), _across(foot), _across(side[:, ::-1])
    c, s = math.cos(angle), math.sin(angle)
    return SideLevers(s * top - c * near, c * far - s * bottom, s * min(ahead, -rear), orientation.distance)


def _side_at_wall(orientation: Orientation) -> Points:
    """Corners (K, 2) [m] of the side, x and z.

    The bowl's wall is curved, and touches two edges of a flat side only. Twisted it lies flat below the part,
    which comes to lie on all of that side: that is the hull's face within ``SIDE_COSINE`` of the wall.
    """
    solid = orientation.solid
    hull = convex_hull(cast(Points, solid.vertices), solid.centre_of_mass, solid.source)
    points, normals = (vectors.product(rows, orientation.axes.T) for rows in (hull.vertices, hull.normals))
    nearest = normals[int(np.argmin(np.round(normals[:, 1], 9)))]
    if -nearest[1] > SIDE_COSINE:
        beyond = vectors.product(points, nearest)
        flat = points[beyond > beyond.max() - SIDE_DEPTH_SHARE * np.ptp(points, axis=0).max()]
        return flat[:, [0, 2]]
    lying = orientation.posture, orientation.heading, cast(Points, orientation.touching)
    return np.concatenate([seat(*lying, lean).walls[:, [0, 2]] for lean in (1.0, -1.0)])


def _across(corners: Points) -> tuple[float, float]:
    """From and to [m] along the second axis, of the hull of some corners (K, 2) [m], where the first is 0.

    Of a hull beside that axis, where it comes nearest to it.
    """
    hull, first = shapely.MultiPoint(corners).convex_hull, corners[:, 0]
    place = min(max(0.0, float(first.min()) + SIDE_EDGE_M), float(first.max()) - SIDE_EDGE_M)
    met = hull.intersection(shapely.LineString([(place, -1.0), (place, 1.0)]))
    if met.is_empty:  # it is a line along the second axis
        met = hull
    _, low, _, high = met.bounds
    return float(low), float(high)


def find_on_side(orientations: Sequence[Orientation], axes: Floats) -> Orientation | None:
    """Return the orientation of a part that has turned over, by how far it reaches in many directions.

    It may lie at a heading at which it would not lie against the bowl's own wall, as the wall of a twisted
    track is at its other side. Then it is an orientation of its own, to a whole degree.

    Parameters
    ----------
    orientations : sequence of Orientation
        All of the part.
    axes : (3, 3) float [1]
        The track's axes as rows, ahead, inwards and up, in the file's axes.

    Returns
    -------
    Orientation or None
        One of the given, one of its own, or None where it lies on no aspect of the part.
    """
    return _find_on_side(tuple(orientations), tuple(np.ravel(axes).tolist()))


@lru_cache(maxsize=512)
def _find_on_side(orientations: tuple[Orientation, ...], axes: tuple[float, ...]) -> Orientation | None:
    first = orientations[0]
    corners = cast(Points, first.posture.corners) - [0.0, 0.0, first.posture.height]
    in_file = vectors.product(corners, cast(Floats, first.posture.axes))
    reach = reach_of(vectors.product(in_file, np.reshape(axes, (3, 3)).T))
    tolerance = REACH_TOLERANCE * float(reach.max())
    off = [np.abs(reaches(one.posture, one.heading) - reach).max(axis=1).min() for one in orientations]
    best = int(np.argmin(np.round(off, 9)))
    if off[best] < tolerance:
        return orientations[best]
    beside = [(*_nearest_heading(one.posture, reach), one) for one in _one_of_each_aspect(orientations)]
    miss, heading, alike = min(beside, key=lambda row: round(row[0], 9))
    if miss >= tolerance:
        return None
    c, s = math.cos(heading), math.sin(heading)
    plan = vectors.product(cast(Points, alike.posture.corners)[:, :2], np.array([[c, s], [-s, c]]))
    length, width = np.ptp(plan, axis=0)
    on_side = replace(
        alike,
        heading=heading,
        heading_share=0.0,
        chances=dict.fromkeys(alike.chances, 0.0),
        length=float(length),
        width=float(width),
        mirror="",
        falls_off=False,
        turns_over=False,
        may_tip=False,
        may_yaw=False,
    )
    return on_side.against_inner_wall()


def _one_of_each_aspect(orientations: Sequence[Orientation]) -> Iterator[Orientation]:
    names = set[str]()
    for one in orientations:
        if one.aspect not in names:
            names.add(one.aspect)
            yield one


def _nearest_heading(posture: Posture, reach: Floats) -> tuple[float, float]:
    """By how much [m] an aspect at its nearest heading is off a reach (REACH_DIRECTIONS,) [m]; that [rad].

    Infinite where it is of another height.
    """
    corners = cast(Points, posture.corners) - [0.0, 0.0, posture.height]
    upright = _directions()[:, 2]
    for k in (int(np.argmax(upright)), int(np.argmin(upright))):  # all but straight up, and down
        own = float(vectors.product(corners, _directions()[k]).max())
        if abs(own - reach[k]) > HEIGHT_SHARE * reach.max():
            return math.inf, 0.0
    off = [float(np.abs(reach_of(corners_from_centre(posture, by)) - reach).max()) for by in SIDE_HEADINGS]
    best = int(np.argmin(np.round(off, 9)))
    return off[best], float(SIDE_HEADINGS[best])


@lru_cache(maxsize=2048)
def reaches(posture: Posture, heading: float) -> Floats:
    """Return how far an orientation reaches (N, REACH_DIRECTIONS) [m], turned a little either way."""
    return np.array([reach_of(corners_from_centre(posture, heading + by)) for by in HEADING_OFFSETS])


def corners_from_centre(posture: Posture, heading: float) -> Floats:
    """Return the corners of a part (V, 3) [m] from its centre of mass, on the track at a heading [rad]."""
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return vectors.product(cast(Points, posture.corners) - [0.0, 0.0, posture.height], turn)


def reach_of(points: Points) -> Floats:
    """Return how far points (V, 3) [m] reach (REACH_DIRECTIONS,) [m] in directions spread over the sphere."""
    return vectors.product(points, _directions().T).max(axis=-2)


@lru_cache(maxsize=1)
def _directions() -> Floats:
    sample = sameness.directions()
    return sample[:: len(sample) // REACH_DIRECTIONS][:REACH_DIRECTIONS]
