"""Every way a part can lie on the track, and what a device sees of it."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
import shapely
import shapely.affinity

from feederscrew.bowl.record import Track
from feederscrew.conveying import answer
from feederscrew.conveying.hop import STAYS, hop
from feederscrew.errors import ConfigError
from feederscrew.geometry.polygons import turned
from feederscrew.mechanics.wall.stable_headings import headings
from feederscrew.resting.posture import Posture, posture
from feederscrew.tooling import foot as feet
from feederscrew.tooling import touching
from feederscrew.tooling.sensor_views import area
from feederscrew.tooling.touching import silhouette
from feederscrew.units import GRAVITY

CUT_BORDER_RADIUS_M = 5e-5  # [m] by which the borders of a cut are rounded: less depth does not catch
FALLEN = 2.0  # time constants after which a part that tips is lost


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
    touching: np.ndarray | None = None  # of its corners, where it touches the wall; None where not known
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

    @property
    def name(self):
        """Return 'D@179': aspect and heading in whole degrees, from 0 to 359."""
        return f"{self.aspect}@{round(np.degrees(self.heading)) % 360}"

    @property
    def returned(self):
        """Whether the track itself does not carry it."""
        return self.falls_off or self.turns_over

    @property
    def may_turn(self):
        """Whether a drive that throws it may bring it into another orientation on the bare track."""
        return self.may_tip or self.may_yaw

    @property
    def shift(self):
        """By how much the weight meets a banked track nearer to the wall [m]."""
        return self.posture.height * np.tan(self.track.bank)

    @property
    def rolls_along(self):
        """Whether the axis about which it rolls lies more along the track than across it."""
        axis = self.posture.axis
        along, across = (0.0, 1.0) if axis is None else np.abs(turned(axis, self.heading))
        return bool(along >= across)

    @property
    def along_a_bank(self):
        """Whether it rolls along a banked track, which does not bring it to the wall: it does not slip."""
        return self.kind == "rolling" and self.track.bank > 0.0 and not (self.rolls_along or self.groove)

    @property
    def wall_leans(self):
        """How far the wall leans back from upright [rad]: it is the other face of a groove."""
        return 0.5 * np.pi - self.groove if self.groove else 0.0

    @cached_property
    def axes(self):
        """(3, 3) [1] the track's axes as rows, in the file's axes."""
        c, s, (x, y, z) = np.cos(self.heading), np.sin(self.heading), cast(np.ndarray, self.posture.axes)
        return np.array([c * x - s * y, s * x + c * y, z])

    @cached_property
    def foot(self):
        """What of it touches the track: a Footprint."""
        whole = touching.footprint(self.posture, self.heading)
        return touching.within(whole, self.distance, self.track.radius, self.track.width)

    @cached_property
    def foot_reach(self):
        """How far its foot reaches from its weight towards the free edge [m]."""
        return float(self.foot.corners[:, 1].max()) + self.shift

    @cached_property
    def standing(self):
        """Its foot as the compiled verdict takes it."""
        return feet.standing(self.foot, self.distance, self.track.radius, self.shift)

    @cached_property
    def margin(self):
        """How far the foot of the centre of mass lies inside the supported hull on the whole track [m]."""
        return feet.over_ring(self.standing, 0.0, 0.0)

    @cached_property
    def outline(self):
        """(J, 2) [m] convex outline from above, counter-clockwise."""
        return turned(self.posture.outline, self.heading)

    @cached_property
    def silhouette(self):
        """Outline seen along the track: rings (K, 2) [m] of distance from the wall and height."""
        return silhouette(self.posture, self.heading, self.distance, self.track.radius)

    @cached_property
    def seen(self):
        """Its silhouette as a shapely geometry."""
        return shapely.union_all([shapely.Polygon(ring) for ring in self.silhouette])

    @cached_property
    def aside(self):
        """Its outline seen from the bowl's axis: distances ahead of its weight and heights, shapely."""
        points = self.posture.surface
        plan = turned(points[:, :2], self.heading)
        seen = area(np.column_stack([plan, points[:, 2]]), self.posture.facets, "side")
        return shapely.affinity.translate(seen, plan[:, 0].max())

    @cached_property
    def balcony(self):
        """Least width of track that carries it [m]; infinite where none does."""
        return feet.balcony(self.standing, self.track.radius)

    @cached_property
    def canyon(self):
        """Greatest width of a strip removed along the wall that it passes [m]; 0 for none."""
        return feet.canyon(self.standing, self.track.radius)

    @cached_property
    def gap(self):
        """Greatest gap across the track that it passes [m]; 0 for none."""
        return feet.longest_gap(self.standing, self.track.radius)


def placed(found):
    """Return orientations as they are where nothing carries them on; what is known of them stays."""
    return tuple(_placed(one) for one in found)


def _placed(one):
    other = replace(
        one, carry=0.0, carry_ahead=0.0, grip=0.0, speed=0.0, swing=0.0, climbs=0.0, hop=0.0, flight=0.0
    )
    known = {name for name, value in vars(Orientation).items() if isinstance(value, cached_property)}
    vars(other).update({name: value for name, value in vars(one).items() if name in known})
    return other


def orientations(part, aspects, track):
    """Return every stable aspect and heading of a part on a track.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    track : Track

    Returns
    -------
    tuple of Orientation
        In the order of the aspects, the most frequent heading first; those that a turn of the part maps onto
        each other are one.

    Raises
    ------
    FeederError
        If the part is a card without an outline, or larger than the bowl.
    """
    found = []
    for row in np.flatnonzero(aspects.stable):
        lying = posture(part, aspects, aspects.names[row])
        chances = {rule: float(chance[row]) for rule, chance in aspects.chances.items()}
        known = headings(lying, track)
        found += [at(lying, known, k, chances, track) for k in range(len(known.headings))]
    return tuple(found)


def travelling(found, bowl):
    """Return orientations that know how a bowl carries them on: over an edge, by friction, and rolling back.

    Parameters
    ----------
    found : sequence of Orientation
    bowl : Bowl
        Its velocity is that of the point mass; one that does not convey carries nothing.

    Returns
    -------
    tuple of Orientation

    Notes
    -----
    A part without support leaves its place as an inverted pendulum does, by cosh(t / T) - 1 with
    T = sqrt((k^2 + h^2) / (g h)), h the height of the centre of mass and k the radius of gyration about the
    edge's direction, where that is not known the greatest about a level axis. After ``FALLEN`` times T it is
    taken to be lost; one that finds support again sooner comes back upright. A part on its round side across
    the track rolls down the climb, since friction of the floor turns it as much as it moves it: without the
    wall by g sin(climb) / (1 + k^2 / r^2) in the mean, whatever the drive. Friction of the wall may hold it,
    or even carry it on as it does what slides.
    """
    along, track = speed(bowl), bowl.track
    thrown = hop(bowl) if along > 0.0 else STAYS
    fastest = 2.0 * np.pi * bowl.drive.frequency * bowl.drive.amplitude
    swing = fastest * np.cos(bowl.drive.vibration_angle)
    held = np.tan(track.climb) <= bowl.friction.wall * np.tan(track.bank)
    return tuple(
        replace(
            one,
            carry=FALLEN * along * _tipping_time(one, _greatest(one), bowl.gravity),
            carry_ahead=FALLEN * along * _tipping_time(one, gyration(one, 0.5 * np.pi), bowl.gravity),
            grip=float(bowl.friction.static),
            speed=along,
            hop=thrown.height,
            flight=thrown.flight,
            swing=swing,
            gravity=float(bowl.gravity),
            wall_grip=float(bowl.friction.wall),
            climbs=float(CUT_BORDER_RADIUS_M + fastest**2 / (2.0 * bowl.gravity)),
            may_roll_back=bool(not held and rolls_across(one)),
        )
        for one in found
    )


def rolls_across(one):
    """Return whether it rolls along the track: about an axis across it, round in a circle, or as a ball."""
    return one.kind == "rolling" and bool(np.isfinite(one.posture.rolling_circle) or not one.rolls_along)


def speed(bowl):
    """Return the velocity up the track [m/s]; 0 of a bowl that does not convey, if its gravity can be."""
    try:
        found = answer.answer(bowl).velocity
    except ConfigError as fault:
        if fault.where == "gravity":
            raise
        return 0.0
    return max(float(found), 0.0) if np.isfinite(found) else 0.0


def _tipping_time(one, spread, gravity):
    """Time constant [s] of tipping over an edge below the centre of mass; ``spread`` as from ``gyration``."""
    height = one.posture.height
    return float(np.sqrt((spread + height**2) / (gravity * height)))


def _greatest(one):
    """Square of the greatest radius of gyration about a level axis [m2]."""
    inertia = one.posture.inertia
    mean, lean = 0.5 * (inertia[0, 0] + inertia[1, 1]), 0.5 * (inertia[0, 0] - inertia[1, 1])
    return (mean + np.hypot(lean, inertia[0, 1])) / one.posture.mass


def gyration(one, angle):
    """Return the square of the radius of gyration [m2] about a level axis at an angle [rad] to the track.

    Source: Steiner's theorem about a level axis.
    """
    inertia, turn = one.posture.inertia, angle - one.heading
    c, s = np.cos(turn), np.sin(turn)
    moment = c * c * inertia[0, 0] + s * s * inertia[1, 1] + 2.0 * s * c * inertia[0, 1]
    return float(moment / one.posture.mass)


def at(lying, known, row, chances, track):
    """Return a Posture at row ``row`` of its Headings, with the chances of its aspect by rule."""
    share = float(known.shares[row])
    return Orientation(
        posture=lying,
        track=track,
        aspect=lying.name,
        heading=float(known.headings[row]),
        heading_share=share,
        chances={rule: chance * share for rule, chance in chances.items()},
        length=float(known.lengths[row]),
        width=float(known.widths[row]),
        height=float(lying.corners[:, 2].max()),
        distance=float(known.distances[row]),
        falls_off=bool(known.falls_off[row] and known.overhangs[row] > 0.0),  # one that rolls stays on
        kind=lying.kind,
        touching=known.touching[row],
    )
