"""Every way a part can lie on the track or hang between rails, and what a device sees of it.

Source, where no other is named: own; docs/tooling.md, "1. The method".
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np
import shapely
import shapely.affinity

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints, Points, Vector
from feederscrew.base.columns import Column
from feederscrew.base.errors import ConfigError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import convex, cross, outline, sides, turned
from feederscrew.base.signatures import Keywords
from feederscrew.base.units import GRAVITY
from feederscrew.bowl.devices.ledges import NarrowedTrack
from feederscrew.bowl.record import Bowl, Track
from feederscrew.motion import conveying as answer
from feederscrew.motion import sameness
from feederscrew.motion.headings import Headings, headings
from feederscrew.motion.hop import Hop, hop
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture, posture
from feederscrew.sorting import footprints
from feederscrew.sorting.footprints import Footprint, silhouette, visible_area

if TYPE_CHECKING:
    from feederscrew.sorting.kernel import Foot

CUT_BORDER_RADIUS_M = 5e-5  # [m] by which the borders of a cut are rounded: less depth does not catch
# [1] of its height, by which the nose of a part slips on as it tips over an edge: in trials of bars 5 to 15
# mm high, their weight 12 to 21 mm from the nose, friction 0.3 to 0.9, all of 432 fell with 2/9 and more; of
# those 8 mm and higher 52 of 90 with 1/6 and less
SLIP_SHARE = 0.25
FALLEN = 2.0  # time constants after which a part that tips is lost
SLICES = 80  # along the part
MAX_SHANK_ANGLE_RAD = np.radians(45.0)  # what stands or lies across the track does not go down by its shank
HEAD_STEP_M = 1e-3  # [m] by which a head across the part's shorter axis is wider than its shank at least
SAME_HEAD_COSINE = np.cos(np.radians(5.0))  # parts that hang by the same head hang alike
HANGING = "hanging"  # what the hanging pose is called, in place of an aspect
BARE, FULL = 1.05, 0.9  # of the shank's and of its own width: where the underside of a head begins and ends
SEATED = 0.1  # of the head's height: how much of a cone's underside counts as resting on the rails


@dataclass(frozen=True, eq=False)
class Orientation:
    """One aspect at one heading against the wall, in track axes from the foot of the centre of mass."""

    posture: Posture  # the part on that aspect, not yet turned
    track: Track
    aspect: str
    heading: float  # [rad]
    heading_share: float  # [1] of the parts on that aspect
    chances: dict[str, float]  # [1] probability by rule
    length: float  # [m] along the track
    width: float  # [m] of track it covers
    height: float  # [m]
    distance: float  # [m] from the wall to the foot of the centre of mass
    falls_off: bool  # the bare track does not carry it
    kind: str  # 'flat', 'rolling' or 'hanging'
    mirror: str = ""  # name of its mirror image, fore and aft; '' where there is none
    touching: Points | None = None  # of its corners, where it touches the wall; None where not known
    turns_over: bool = False  # the drive tips it over on the track
    may_tip: bool = False  # the drive throws it, and a landing may tip it over
    may_yaw: bool = False  # the drive throws it or a bank presses it on, and the wall may turn its heading
    may_roll_back: bool = False  # on its round side, not along a climbing track: no verdict is sure
    carry: float = 0.0  # [m] it travels on unsupported before it has tipped: 0 of one that is only placed
    carry_ahead: float = 0.0  # [m] the same over an edge across the track
    grip: float = 0.0  # [1] friction of the track it travels on: 0 of one that is only placed
    speed: float = 0.0  # [m/s] at which it travels
    hop: float = 0.0  # [m] by which it is over the track at most, where the drive throws it
    flight: float = 0.0  # [m] along the track, of its longest flight
    swing: float = 0.0  # [m/s] amplitude of the track's velocity along it
    gravity: float = GRAVITY  # [m/s2] of the bowl it travels in: standard gravity of one only placed
    wall_grip: float = 0.0  # [1] friction of the wall
    climbs: float = 0.0  # [m] height of an edge that the speed of the drive lifts it over
    groove: float = 0.0  # [rad] of both faces of the groove that it lies in; 0 on a track with a wall
    any_heading: bool = False  # on that aspect it is known however it is turned
    at_inner_wall: bool = False  # behind a twist: the wall is the floor that stands at the inner side

    @property
    def name(self) -> str:
        """Return 'D@179': aspect and heading in whole degrees, from 0 to 359."""
        return f"{self.aspect}@{round(np.degrees(self.heading)) % 360}"

    def on_track(self, track: Track, **changes: Any) -> Self:
        """Return it on another stretch of track, with changes of its own fields.

        Parameters
        ----------
        track : Track
        **changes : any
            Of fields: ``groove=0.0``.

        Returns
        -------
        Orientation
        """
        return replace(self, track=track, **changes)

    def against_inner_wall(self) -> Self:
        """Return it as it lies behind a twist: its wall is the floor that stands at the inner side.

        Returns
        -------
        Orientation
            Its ``distance`` is from that wall, outwards; where it touches it is not known.
        """
        inwards = float(self.outline[:, 1].max())
        return replace(self, distance=inwards, touching=None, at_inner_wall=True)

    @property
    def solid(self) -> Part:
        """Return the part that lies so."""
        return cast(Part, self.posture.solid)

    @property
    def returned(self) -> bool:
        """Tell whether the bare track returns it: it does not carry it, or the drive tips it over."""
        return self.falls_off or self.turns_over

    @property
    def may_turn(self) -> bool:
        """Tell whether a drive that throws it may bring it into another orientation on the bare track."""
        return self.may_tip or self.may_yaw

    @property
    def shift(self) -> float:
        """Return by how much the weight meets a banked track nearer to the wall [m]: h tan(bank)."""
        return self.posture.height * np.tan(self.track.bank)

    @property
    def rolls_along(self) -> bool:
        """Tell whether the axis about which it rolls lies more along the track than across it."""
        axis = self.posture.axis
        along, across = (0.0, 1.0) if axis is None else np.abs(turned(axis, self.heading))
        return bool(along >= across)

    @property
    def rolls_across(self) -> bool:
        """Tell whether it rolls along the track: about an axis across it, round in a circle, or as a ball."""
        is_round = bool(np.isfinite(self.posture.rolling_circle))
        return self.kind == "rolling" and (is_round or not self.rolls_along)

    @property
    def along_a_bank(self) -> bool:
        """Tell whether it rolls along a banked track, which does not bring it to the wall without slip."""
        return self.kind == "rolling" and self.track.bank > 0.0 and not (self.rolls_along or self.groove)

    @property
    def wall_leans(self) -> float:
        """Return how far the wall leans back from upright [rad]: it is the other face of a groove."""
        return 0.5 * np.pi - self.groove if self.groove else 0.0

    @cached_property
    def axes(self) -> Floats:
        """Return the track's axes as rows (3, 3) [1], in the file's axes."""
        c, s, (x, y, z) = np.cos(self.heading), np.sin(self.heading), cast(Floats, self.posture.axes)
        return np.array([c * x - s * y, s * x + c * y, z])

    @cached_property
    def foot(self) -> Footprint:
        """Return the footprint: where the part touches the track."""
        whole = footprints.find_footprint(self.posture, self.heading)
        return footprints.clip_to_track(whole, self.distance, self.track.radius, self.track.width)

    @cached_property
    def axial_foot(self) -> "Foot":
        """Return its foot as the compiled verdict takes it."""
        return footprints.axial_foot(self.foot, self.distance, self.track.radius, self.shift)

    @cached_property
    def ahead(self) -> float:
        """Return how far its foot reaches ahead of its weight [m]; 0 without a foot."""
        return float(self.foot.corners[:, 0].max(initial=0.0))

    @cached_property
    def behind(self) -> float:
        """Return how far its foot reaches behind its weight [m]; 0 without a foot."""
        return -float(self.foot.corners[:, 0].min(initial=0.0))

    @property
    def nose_swing(self) -> float:
        """Return how far from an edge across the track the top of its nose swings [m].

        It tips over the edge once its weight is beyond it by ``carry_ahead`` c. With the way a ahead of its
        weight and its height H the top of its nose swings sqrt((a + c)^2 + H^2), and it slips on meanwhile.
        """
        return float(np.hypot(self.ahead + self.carry_ahead, self.height)) + SLIP_SHARE * self.height

    @cached_property
    def margin(self) -> float:
        """Return how far inside the supported hull the weight meets the whole track [m]."""
        return footprints.over_ring(self.axial_foot, 0.0, 0.0)

    @cached_property
    def outline(self) -> Points:
        """Return its convex outline from above (J, 2) [m], counter-clockwise."""
        return turned(self.posture.outline, self.heading)

    @cached_property
    def silhouette(self) -> tuple[Points, ...]:
        """Return its outline seen along the track: rings (K, 2) [m] of distance from the wall and height."""
        return silhouette(self.posture, self.heading, self.distance, self.track.radius)

    @cached_property
    def view_ahead(self) -> shapely.Geometry:
        """Return its silhouette as a shapely geometry."""
        return shapely.union_all([shapely.Polygon(ring) for ring in self.silhouette])

    @cached_property
    def aside(self) -> shapely.Geometry:
        """Return its outline seen from the bowl's axis, shapely: ahead of its weight, and heights [m]."""
        points = self.posture.surface
        plan = turned(points[:, :2], self.heading)
        side_view = visible_area(np.column_stack([plan, points[:, 2]]), self.posture.facets, "side")
        return shapely.affinity.translate(side_view, plan[:, 0].max())

    @cached_property
    def balcony(self) -> float:
        """Return the least width of track that carries it [m]; infinite where none does."""
        return footprints.balcony(self.axial_foot, self.track.radius)

    @cached_property
    def canyon(self) -> float:
        """Return the greatest width of a strip removed along the wall that it passes [m]; 0 for none."""
        return footprints.canyon(self.axial_foot, self.track.radius)

    @cached_property
    def gap(self) -> float:
        """Return the greatest gap across the track that it passes [m]; 0 for none."""
        return _longest_gap(self.foot, self.distance, self.track.radius, self.shift)


ORIENTATION_NAME_COLUMNS: tuple[Column[Orientation], ...] = (  # which it is
    Column("aspect", lambda orientation: orientation.aspect),
    Column("heading_deg", lambda orientation: orientation.heading, "deg"),
)
ORIENTATION_SIZE_COLUMNS: tuple[Column[Orientation], ...] = (
    Column("length_mm", lambda orientation: orientation.length, "mm"),
    Column("width_mm", lambda orientation: orientation.width, "mm"),
    Column("height_mm", lambda orientation: orientation.height, "mm"),
    Column("wall_distance_mm", lambda orientation: orientation.distance, "mm"),
    Column(
        "balcony_mm",
        lambda orientation: float(orientation.balcony) if np.isfinite(orientation.balcony) else None,
        "mm",
        heading=NarrowedTrack.kind,  # files keep the word of the theory
    ),
    Column("canyon_mm", lambda orientation: orientation.canyon, "mm"),
    Column("gap_mm", lambda orientation: orientation.gap, "mm"),
    Column("mirror", lambda orientation: orientation.mirror or None),
)
ORIENTATION_TRIED_COLUMNS: tuple[Column[Orientation], ...] = (  # of a trial
    Column("aspect", lambda orientation: orientation.aspect),
    Column("heading_deg", lambda orientation: orientation.heading, "deg"),
    Column("length_mm", lambda orientation: orientation.length, "mm"),
)


@lru_cache(maxsize=512)
def _longest_gap(foot: Footprint, distance: float, radius: float, shift: float) -> float:
    return footprints.longest_gap(footprints.axial_foot(foot, distance, radius, shift), radius)


STILL: Keywords = dict.fromkeys(
    ("carry", "carry_ahead", "grip", "speed", "swing", "climbs", "hop", "flight"), 0.0
)
CACHED = {name for name, value in vars(Orientation).items() if isinstance(value, cached_property)}


@lru_cache(maxsize=64)
def place(orientations: tuple[Orientation, ...]) -> tuple[Orientation, ...]:
    """Return orientations as they lie where nothing carries them on: no speed, no hop, no friction.

    Whatever was computed of their shape stays. The same tuple gives the same records, so that their verdicts
    are remembered.

    Parameters
    ----------
    orientations : tuple of Orientation

    Returns
    -------
    tuple of Orientation
    """
    placed = []
    for orientation in orientations:
        placed.append(replace(orientation, **STILL))
        vars(placed[-1]).update({name: value for name, value in vars(orientation).items() if name in CACHED})
    return tuple(placed)


@lru_cache(maxsize=8)
def orientations(part: Part, aspects: Aspects, track: Track) -> tuple[Orientation, ...]:
    """Return every stable aspect and heading of a part on a track.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    track : Track

    Returns
    -------
    tuple of Orientation
        In the order of its Aspects, the most frequent heading first; those that a turn of the part maps onto
        each other are one.

    Raises
    ------
    FeederError
        If the part is a card without an outline, or larger than the bowl.
    """
    orientations: list[Orientation] = []
    for row in np.flatnonzero(aspects.stable):
        resting = posture(part, aspects, aspects.names[row])
        chances = {rule: float(chance[row]) for rule, chance in aspects.chances.items()}
        stable = headings(resting, track)
        rows = range(len(stable.headings))
        orientations += (orientation_at(resting, stable, k, chances, track) for k in rows)
    return tuple(orientations)


def orientation_at(
    posture: Posture, headings: Headings, row: int, chances: dict[str, float], track: Track
) -> Orientation:
    """Return the orientation of a Posture at one of its headings.

    Parameters
    ----------
    posture : Posture
    headings : Headings
        Of that posture on the track.
    row : int
        Of the headings.
    chances : dict of str to float [1]
        Of the aspect, by rule.
    track : Track

    Returns
    -------
    Orientation
        Its chances are those of the aspect times the heading's share.
    """
    share = float(headings.shares[row])
    return Orientation(
        posture=posture,
        track=track,
        aspect=posture.name,
        heading=float(headings.headings[row]),
        heading_share=share,
        chances={rule: chance * share for rule, chance in chances.items()},
        length=float(headings.lengths[row]),
        width=float(headings.widths[row]),
        height=float(cast(Points, posture.corners)[:, 2].max()),
        distance=float(headings.distances[row]),
        falls_off=bool(headings.falls_off[row] and headings.overhangs[row] > 0.0),  # what rolls stays
        kind=posture.kind,
        touching=headings.touching[row],
    )


def add_travel(orientations: Sequence[Orientation], bowl: Bowl) -> tuple[Orientation, ...]:
    """Return orientations that know how a bowl carries them on: over an edge, by friction, and rolling back.

    A part without support is lost after ``FALLEN`` times sqrt((k^2 + h^2) / (g h)) [s], h the height of the
    centre of mass and k the radius of gyration about the edge's direction, where that is not known the
    greatest about a level axis.

    Parameters
    ----------
    orientations : sequence of Orientation
    bowl : Bowl
        Its velocity is that of the point mass; a bowl that does not convey carries nothing.

    Returns
    -------
    tuple of Orientation

    Raises
    ------
    ConfigError
        If the bowl's gravity cannot be.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    along, track, gravity = travel_speed(bowl), bowl.track, float(bowl.gravity)
    thrown = hop(bowl) if along > 0.0 else Hop(0.0, 0.0, 0.0)
    fastest = 2.0 * np.pi * bowl.drive.frequency * bowl.drive.amplitude
    held = np.tan(track.climb) <= bowl.friction.wall * np.tan(track.bank)

    def greatest(inertia: Floats) -> float:  # about a level axis
        mean, lean = 0.5 * (inertia[0, 0] + inertia[1, 1]), 0.5 * (inertia[0, 0] - inertia[1, 1])
        return mean + np.hypot(lean, inertia[0, 1])

    def carry(orientation: Orientation, spread: float) -> float:
        height = orientation.posture.height
        return FALLEN * along * float(np.sqrt((spread + height**2) / (bowl.gravity * height)))

    return tuple(
        replace(
            o,
            carry=carry(o, greatest(o.posture.inertia) / o.posture.mass),
            carry_ahead=carry(o, gyration(o, 0.5 * np.pi)),
            grip=float(bowl.friction.static),
            speed=along,
            hop=thrown.height,
            flight=thrown.flight,
            swing=fastest * np.cos(bowl.drive.vibration_angle),
            gravity=gravity,
            wall_grip=float(bowl.friction.wall),
            climbs=float(CUT_BORDER_RADIUS_M + fastest**2 / (2.0 * bowl.gravity)),
            # a cone, a disc on a stem: along a banked track it rolls in a circle into the wall
            may_roll_back=not held and o.rolls_across and not (track.bank > 0.0 and o.rolls_along),
        )
        for o in orientations
    )


def travel_speed(bowl: Bowl) -> float:
    """Return the velocity of a point mass up the track.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [m/s]
        0 of a bowl that does not convey.

    Raises
    ------
    ConfigError
        If the bowl's gravity cannot be.
    """
    try:
        velocity = answer.answer(bowl).velocity
    except ConfigError as fault:
        if fault.where == "gravity":
            raise
        return 0.0
    return max(float(velocity), 0.0) if np.isfinite(velocity) else 0.0


def gyration(orientation: Orientation, angle: float) -> float:
    """Return the square of the radius of gyration about a level axis: k^2 = a^T I a / m.

    Parameters
    ----------
    orientation : Orientation
    angle : float [rad]
        Of the axis a to the track, 0 along it.

    Returns
    -------
    float [m2]

    References
    ----------
    The moment of inertia about an axis through the centre of mass, by the tensor I.
    """
    inertia, turn = orientation.posture.inertia, angle - orientation.heading
    c, s = np.cos(turn), np.sin(turn)
    moment = c * c * inertia[0, 0] + s * s * inertia[1, 1] + 2.0 * s * c * inertia[0, 1]
    return float(moment / orientation.posture.mass)


def name_mirror_images(orientations: Sequence[Orientation]) -> tuple[Orientation, ...]:
    """Return orientations with the names of their mirror images, fore and aft.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.

    Returns
    -------
    tuple of Orientation
        ``mirror`` is '' where none is the image.
    """
    looks = []
    for orientation in orientations:
        supports, moments = sameness.looks(orientation.posture, [orientation.heading])
        looks.append((supports[0], None if moments is None else moments[0]))
    pairs = {}
    for i, first in enumerate(orientations):
        for j, second in enumerate(orientations):
            near = abs(first.length - second.length) < 1e-2 * first.length
            if i != j and near and sameness.looks_alike(looks[i], looks[j], mirrored=True):
                pairs[i] = second.name
    return tuple(replace(orientation, mirror=pairs.get(k, "")) for k, orientation in enumerate(orientations))


# -- parts with a head, or with shoulders, between rails


@dataclass(frozen=True, eq=False)
class Neck:
    """Shank and head of a part, across its own long axis."""

    shank: float  # [m] greatest width of the stretch that holds the centre of mass and reaches to one end
    head: float  # [m] of the other end, in the way it is narrowest
    widest: float  # [m] of that end, in any way it turns about the long axis
    tip: float  # [m] from the foot of the centre of mass, inwards: the long axis at the shank's end
    rise: float  # [1] of the head's underside from the shank outwards: 0 of a flat one, 1 of a cone of 90 deg
    lever: float  # [m] from the head's end to the centre of mass, along the long axis
    down: Vector  # (3,) [1] from head to shank, in the file's axes


@dataclass(frozen=True, eq=False)
class Shoulders:
    """Shoulders of a part as it lies: its stem goes down into a slot, and they hold it on both sides."""

    stem: float  # [m] width across the track of what goes down
    nearest: float  # [m] from the foot of the centre of mass, inwards: what of it comes nearest to the wall
    middle: float  # [m] of it, from the foot of the centre of mass
    drop: float  # [m] by which it goes down
    spare: float  # [m] from the foot to the border of what holds it: by how much it stands upright there


@dataclass(frozen=True, eq=False)
class Hanging(Orientation):
    """A part that hangs by its head between rails: its foot is what of the head rests on them."""

    neck: Neck = field(kw_only=True)
    span: tuple[float, ...] = ()  # [m] of the slot, from the wall
    lies_on: tuple[float, ...] = ()  # [m] shank's and head's middle from the foot of the centre of mass

    @property
    def name(self) -> str:
        """Return 'hanging'; of a part with two heads also 'hanging 2'."""
        return self.aspect

    @property
    def shift(self) -> float:
        """Return 0: a hanging part's weight pulls through its own slot, however the track is banked."""
        return 0.0

    @cached_property
    def foot(self) -> Footprint:
        """Return the footprint of the head on the rails."""
        corners, points = cast(Points, self.posture.corners), self.posture.surface
        size = np.ptp(corners, axis=0).max()
        reach = 2.0 * np.hypot(*corners[:, :2].T).max()
        slot = footprints.ring(self.span, self.distance, self.track.radius, reach)
        for depth in (footprints.TOUCHING_SHARE * size, SEATED * self.height):
            low = footprints.area_below(points[:, :2], points[:, 2], self.posture.facets, depth, True)
            rings = footprints.rings(low.difference(slot), footprints.SLIVER * size**2)
            if len(rings) > 1 or depth > footprints.TOUCHING_SHARE * size:
                break
        return Footprint(rings=rings)

    def over(self, span: tuple[float, ...]) -> float:
        """Return the margin by which shank and head fit rails at another distance.

        Parameters
        ----------
        span : tuple of float [m]
            Of their slot: from and to, off the wall.

        Returns
        -------
        float [m]
            Negative where they do not.
        """
        first, last = (end - self.distance for end in span)
        (shank, head), wide = self.lies_on, self.neck
        free = min(shank - 0.5 * wide.shank - first, last - shank - 0.5 * wide.shank)
        return float(min(free, first - head + 0.5 * wide.head, head + 0.5 * wide.head - last))


def _about_centre(orientation: Orientation, axes: Floats) -> Floats:
    """Corners (V, 3) [m] of the solid from its centre of mass, along some axes (3, 3) in the file's."""
    return vectors.product(orientation.solid.corners, axes.T)


class _Pose:
    """An orientation, equal to any other of the same solid that is turned alike, on whatever track."""

    def __init__(self, orientation: Orientation) -> None:
        self.orientation, self.key = orientation, (id(orientation.posture.solid), orientation.axes.tobytes())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Pose) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


@lru_cache(maxsize=512)
def neck(orientation: Orientation) -> "Neck | None":
    """Return the shank and the head of a part as it lies.

    Parameters
    ----------
    orientation : Orientation

    Returns
    -------
    Neck or None
        None where no end is wider than the rest of the part, or its shank does not lie along the track.
    """
    return _neck(_Pose(orientation))


@lru_cache(maxsize=512)
def _neck(pose: _Pose) -> Neck | None:
    orientation = pose.orientation
    # the part's own long axis first: the principal one nearest to that of its outline. A short part with a
    # wide head, an eyelet, is longest across its head: then another principal axis, if that has a head
    units, extents = _extents(orientation.outline)
    narrow = units[int(np.argmin(extents))]
    turn = float(np.arctan2(narrow[1], narrow[0]))
    near = np.array([np.cos(turn), np.sin(turn), 0.0])
    _, principal = vectors.eigen(orientation.solid.inertia)
    principal = vectors.product(principal.T, orientation.axes.T)
    longest = int(np.argmax(np.round(np.abs(vectors.product(principal, near)), 9)))
    others = sorted((k for k in range(3) if k != longest), key=lambda k: -abs(round(principal[k, 0], 9)))
    found = _neck_along(orientation, principal[longest])
    for k in others:
        found = found or _neck_along(orientation, principal[k], HEAD_STEP_M)
    return found


def _neck_along(orientation: Orientation, axis: Vector, least_step: float = 0.0) -> Neck | None:
    """Return the neck of a part whose shank lies along an axis (3,) [1] of the track.

    None without a head that is wider than the shank, by ``least_step`` [m] at least.
    """
    axis = axis if axis[0] > 0.0 else -axis
    steep, level = np.sin(MAX_SHANK_ANGLE_RAD), np.hypot(axis[0], axis[1])
    if abs(axis[2]) > steep or abs(axis[1]) > steep * level:
        return None
    # from either end, the head is what is wider than all behind it; it must end before the centre of mass
    points = _about_centre(orientation, orientation.axes)
    along = vectors.product(points, axis)
    level = vectors.product(points, vectors.unit(np.array([-axis[1], axis[0], 0.0])))
    ends = footprints.edges_of(orientation.posture)
    a, b = along[ends[:, 0]], along[ends[:, 1]]
    places = along.min() + (np.arange(SLICES) + 0.5) / SLICES * np.ptp(along)
    crossed = (a > places[:, None]) != (b > places[:, None])
    share = (places[:, None] - a) / np.where(b == a, 1.0, b - a)
    y = level[ends[:, 0]] + share * (level[ends[:, 1]] - level[ends[:, 0]])
    top, bottom = np.where(crossed, y, -np.inf).max(axis=1), np.where(crossed, y, np.inf).min(axis=1)
    widths, steps = np.maximum(top - bottom, 0.0), []  # level widths at the places
    for sign, along, across in ((1.0, places, widths), (-1.0, -places[::-1], widths[::-1])):
        for k in range(1, len(across)):
            if along[k] > 0.0:
                break
            head, shank = across[:k].max(), across[k:].max()
            steps.append((head - shank, shank, head, sign, float(along[k])))
    step, shank, head, sign, end = max(steps, default=(0.0, 0.0, 0.0, 1.0, 0.0))
    # a head that is flat turns about its axis edge on; one that ends in an edge is as narrow as that
    towards = sign * axis
    points = points[vectors.product(points, towards) <= end]
    across = vectors.unit(np.array([-towards[1], towards[0], 0.0]))
    flat = np.column_stack([vectors.product(points, v) for v in (across, np.cross(towards, across))])
    least, widest = 0.0, 0.0
    if len(convex(flat)) >= 3:
        ring = outline(flat)
        least, widest = min(map(float, _extents(ring)[1])), 2.0 * float(np.hypot(*ring.T).max())
    head = min(head, least)
    if not step > 0.0 or not head - shank > least_step:
        return None
    down, tip = np.einsum("ij,i->j", orientation.axes, towards), sign * axis[1] * max(sign * places)
    between = (sign * places <= end) & (widths > BARE * shank) & (widths < FULL * head)
    rise = float(between.sum() * np.ptp(places) / SLICES / (0.5 * step))
    lever = max(-row[4] for row in steps if row[3] == sign and row[0] > 0.95 * step)
    return Neck(float(shank), float(head), widest, float(tip), rise, lever, check.frozen(down))


def _extents(ring: Points) -> tuple[Floats, list[float]]:
    """Directions (K, 2) of the sides of a convex outline, and how wide it is across each."""
    along = sides(ring)
    along = along / np.hypot(*along.T)[:, None]
    return along, [np.ptp(cross(unit, ring)) for unit in along]


def head_first(orientation: Orientation) -> bool:
    """Tell whether a part with a head that lies along the track comes with its head ahead of its shank.

    Parameters
    ----------
    orientation : Orientation

    Returns
    -------
    bool
        False of a part without a head.
    """
    own_neck = neck(orientation)
    return own_neck is not None and bool(vectors.dot(orientation.axes[0], own_neck.down) < 0.0)


@lru_cache(maxsize=512)
def shoulders(orientation: Orientation, width: float) -> Shoulders | None:
    """Return how a part goes down into a slot along the track as it lies and is held: a T-nut, stem down.

    Its stem is taken to lie in the middle of the slot.

    Parameters
    ----------
    orientation : Orientation
    width : float [m]
        Of the slot.

    Returns
    -------
    Shoulders or None
        None where nothing goes down, or what rests on both sides then does not hold the centre of mass; also
        of a part that has a head and a shank along the track, hangs already, or rolls.
    """
    if isinstance(orientation, Hanging) or orientation.kind == "rolling" or neck(orientation) is not None:
        return None
    pose, radius = _Pose(orientation), orientation.track.radius
    return _shoulders(pose, orientation.posture.height, radius, orientation.distance, width)


@lru_cache(maxsize=512)
def _shoulders(pose: _Pose, height: float, radius: float, distance: float, width: float) -> Shoulders | None:
    orientation, faces = pose.orientation, pose.orientation.posture.facets
    points = _about_centre(orientation, orientation.axes) + [0.0, 0.0, height]
    size, half = float(np.ptp(points, axis=0).max()), 0.5 * width
    flat = footprints.TOUCHING_SHARE * size
    # facets that lie in one plane but for rounding are one aspect: the lowest corner may lie over its plane
    foot = points[points[:, 2] < max(float(points[:, 2].min()), 0.0) + flat]
    stem, middle = float(np.ptp(foot[:, 1])), float(0.5 * (foot[:, 1].min() + foot[:, 1].max()))
    if stem >= width or np.abs(points[:, 1] - middle).max() < half:
        return None
    drop = _underside(points, footprints.edges_of(orientation.posture), middle, half)
    if not flat < drop <= np.ptp(foot[:, 0]):
        return None
    area = footprints.area_below(points[:, :2], points[:, 2] - drop, faces, flat, True)
    resting = area.difference(shapely.box(-2.0 * size, middle - half, 2.0 * size, middle + half))
    hull, weight = resting.convex_hull, shapely.Point(0.0, 0.0)
    if resting.area <= footprints.SLIVER * size**2 or not hull.contains(weight):
        return None
    centre = radius - distance
    nearest = centre - np.hypot(foot[:, 0], centre - foot[:, 1]).max()  # the wall is curved
    return Shoulders(stem, float(nearest), middle, drop, float(hull.exterior.distance(weight)))


def shoulder_margin(orientation: Orientation, span: tuple[float, ...]) -> float:
    """Return by how much shoulders hold a part in a slot.

    Parameters
    ----------
    orientation : Orientation
    span : tuple of float [m]
        The slot: from and to, off the wall.

    Returns
    -------
    float [m]
        0 where it has to move across the track before its stem goes down; -inf where none hold it.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    stemmed = shoulders(orientation, span[1] - span[0])
    if stemmed is None:
        return -np.inf
    inner = orientation.distance + stemmed.nearest - span[0]
    outer = span[1] - orientation.distance - stemmed.middle - 0.5 * stemmed.stem
    return float(max(min(inner, outer, stemmed.spare), 0.0))


def _underside(points: Points, ends: Ints, middle: float, half: float) -> float:
    """Height [m] of the lowest place of a surface beyond half a slot's width to either side of its middle."""
    a, b = points[ends[:, 0]], points[ends[:, 1]]
    heights = [points[np.abs(points[:, 1] - middle) >= half, 2]]
    for side in (middle - half, middle + half):
        crosses = (a[:, 1] > side) != (b[:, 1] > side)
        share = (side - a[crosses, 1]) / (b[crosses, 1] - a[crosses, 1])
        heights.append(a[crosses, 2] + share * (b[crosses, 2] - a[crosses, 2]))
    return float(np.concatenate(heights).min())


def _neck_of(orientation: Orientation, stemmed: Shoulders) -> Neck:
    """Stem and shoulders of a part as it lies, as shank and head: its shoulders hold it as it lies."""
    corners = _about_centre(orientation, orientation.axes)
    rail = stemmed.drop - orientation.posture.height
    top = corners[corners[:, 2] > rail - footprints.TOUCHING_SHARE * np.ptp(corners, axis=0).max()]
    wide, lever = float(np.ptp(top[:, 1])), float(corners[:, 2].max())
    down = check.frozen(np.einsum("ij,i->j", orientation.axes, [0.0, 0.0, -1.0]))
    return Neck(stemmed.stem, wide, wide, stemmed.middle, 0.0, lever, down)


def shouldered_neck(orientation: Orientation, play: float) -> Neck | None:
    """Return the neck of a part that stands on its stem, with shoulders over a slot.

    Parameters
    ----------
    orientation : Orientation
    play : float [m]
        By which the slot is wider than the stem.

    Returns
    -------
    Neck or None
        None where nothing of it goes down into such a slot, or its shoulders do not hold it.
    """
    if isinstance(orientation, Hanging) or not len(orientation.foot.corners):
        return None
    stemmed = shoulders(orientation, float(np.ptp(orientation.foot.corners[:, 1])) + play)
    return None if stemmed is None else _neck_of(orientation, stemmed)


def may_hang(orientation: Orientation, span: tuple[float, ...]) -> bool:
    """Tell whether a slot between rails is as wide as a part's neck and narrower than its head.

    Whether the part comes to hang in it, as it lies, is another question.

    Parameters
    ----------
    orientation : Orientation
    span : tuple of float [m]
        The slot: from and to, off the wall.

    Returns
    -------
    bool
        False of a part that hangs already.
    """
    width = span[1] - span[0]
    if isinstance(orientation, Hanging):
        return False  # it hangs already
    if shoulders(orientation, width) is not None:
        return True
    own_neck = neck(orientation)
    return own_neck is not None and own_neck.shank <= width < own_neck.head


def hang(orientation: Orientation, span: tuple[float, ...], hanging: Sequence[Hanging] = ()) -> Hanging:
    """Return a part hanging between rails that it came to lying: it goes down by its shank.

    Parameters
    ----------
    orientation : Orientation
        As it came; with a neck or shoulders for this slot.
    span : tuple of float [m]
        The slot: from and to, off the wall.
    hanging : sequence of Hanging, optional
        Those that hang in the slot already. Parts that hang by the same head as one of them are that
        orientation, however they lay before and however they are turned about the vertical.

    Returns
    -------
    Hanging
    """
    stemmed, half = shoulders(orientation, span[1] - span[0]), 0.5 * (span[1] - span[0])
    corners = _about_centre(orientation, orientation.axes)
    if stemmed is None:
        own_neck = cast(Neck, neck(orientation))
    else:
        own_neck, rail = _neck_of(orientation, stemmed), stemmed.drop - orientation.posture.height
    for other in hanging:
        if vectors.dot(own_neck.down, other.neck.down) > SAME_HEAD_COSINE:
            return other
    if stemmed is not None:
        axes, points, shank = orientation.axes, corners, stemmed.middle
    else:  # its shank turns down
        up = -own_neck.down
        across = vectors.unit(orientation.axes[1] - up * vectors.dot(orientation.axes[1], up))
        axes = np.array([np.cross(across, up), across, up])
        points = _about_centre(orientation, axes)
        below = points[:, 2] < 0.0
        shank = float(0.5 * (points[below, 1].min() + points[below, 1].max()))
        rail = _underside(points, footprints.edges_of(orientation.posture), shank, half)
    points = points - [0.0, 0.0, rail]
    head = points[points[:, 2] > 0.0, 1]
    plan, distance = check.frozen(outline(points[:, :2])), 0.5 * sum(span) - shank
    inertia = vectors.product(vectors.product(axes, orientation.solid.inertia), axes.T)
    posture = replace(
        orientation.posture,
        name=HANGING,
        kind=HANGING,
        height=float(-rail),
        inertia=check.frozen(inertia),
        contact=plan,
        outline=plan,
        corners=check.frozen(points),
        axes=check.frozen(axes),
    )
    return Hanging(
        posture=posture,
        track=orientation.track,
        aspect=HANGING if not hanging else f"{HANGING} {len(hanging) + 1}",
        heading=0.0,
        heading_share=1.0,
        chances={},
        length=float(np.ptp(points[:, 0])),
        width=float(distance + points[:, 1].max()),
        height=float(points[:, 2].max()),
        distance=float(distance),
        falls_off=False,
        kind=HANGING,
        neck=own_neck,
        span=tuple(span),
        lies_on=(shank, float(0.5 * (head.min() + head.max()))),
    )
