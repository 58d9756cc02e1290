"""The features of a device on the track: openings, blades, drops, slopes, jets of air and a sensor.

Coordinates of a device: x along the wall from where the device begins, y from the wall inwards, z over the
track and square to it. SI, frozen, of no kind by name. The trial, the drawings, the printed section and the
bowl's solid are made of them, and verdicts read the same openings; none of these adds a rule of its own.
"""

import enum
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base.arrays import Points
from feederscrew.base.heavy import heavy
from feederscrew.bowl.devices.asked import LyingPart
from feederscrew.bowl.devices.values import Corner

if TYPE_CHECKING:
    import shapely
else:
    shapely = heavy("shapely")  # a bowl without devices needs none of it

BLADE = 1.5e-3  # [m] thickness of a blade
BEYOND_BLADES_M = 10.0  # [m] beyond any blade
BEYOND_TRACK_M = 10.0  # [m] beyond any track
WALL_OVERCUT_M = 1e-3  # [m] a hole that reaches the wall is cut on into it
LONGEST_RAMP_SINE = 0.9  # [1] of the angle about the bowl's axis over which a ramp comes down at most
FOOTPRINT_STEP_M = 1e-3  # [m] between places of a plate that are unrolled
FOOTPRINT_CHORD_M = 1e-6  # [m] by which its unrolled sides may be seen too flat
SAME_PLACE_M = 1e-9  # [m] nearer places are one


class ShopWork(enum.StrEnum):
    """Work of the shop on a cut beside cutting its outline; papers print the words."""

    OPEN_AT_OUTLET = "open at the outlet: saw the web out, parts hang in it to the end"
    RUNS_INTO_NEXT = "runs into the slot of the next rails: no web between them"
    YOKE_BELOW = "inner rail carried by yokes below, clear of what hangs"
    OPEN_AT_EDGE = "open at the free edge"
    OPEN_AT_WALL = "cut to the wall"

    @property
    def short(self) -> str:
        """Its first words: 'open at the outlet'."""
        return self.value.partition(":")[0].partition(",")[0]


@dataclass(frozen=True, eq=False)
class TrackOpening:
    """A cut through the track."""

    # (K, 2) [m] x, y of its outline; open into the wall where y <= 0, at the free edge where y >= width
    ring: Points
    span: tuple[float, float] | None = None  # [m] off the wall, of one that goes on along the track
    gap: float = 0.0  # [m] of one across the track whose edges are parallel, the one that is left radial
    hangs: bool = False  # parts hang in it: it goes on to the next rails, or open to the outlet
    runs_on: bool = False  # placed on a track: it ends at the slot of the next rails
    depth: float = math.inf  # [m] from the surface down; infinite: through the plate

    @property
    def begin(self) -> float:
        """Return where it begins [m] along the wall."""
        return float(self.ring[:, 0].min())

    @property
    def end(self) -> float:
        """Return where it ends [m] along the wall."""
        return float(self.ring[:, 0].max())

    def extended(self, end: float) -> "TrackOpening":
        """Return the opening with its far end at another place along the wall.

        Parameters
        ----------
        end : float [m]

        Returns
        -------
        TrackOpening
        """
        ring = self.ring.copy()
        ring[ring[:, 0] >= self.end - SAME_PLACE_M, 0] = end
        return replace(self, ring=ring)

    def lasting(self, length: float) -> "TrackOpening":
        """Return the opening of a device that lasts a length along the track.

        Parameters
        ----------
        length : float [m]

        Returns
        -------
        TrackOpening
            Itself of a fixed shape.
        """
        return self if self.span is None else self.extended(max(length, self.tapered + 0.5 * length))

    @property
    def tapered(self) -> float:
        """Return how far [m] a lead-in goes, up to where the cut is as wide as its span; 0 without."""
        inner = self.ring[self.ring[:, 0] < self.end - SAME_PLACE_M, 0]
        return float(inner.max()) if len(inner) and inner.max() > self.begin else 0.0

    def shifted(self, along: float) -> "TrackOpening":
        """Return the opening further along the wall.

        Parameters
        ----------
        along : float [m]

        Returns
        -------
        TrackOpening
        """
        return replace(self, ring=self.ring + [along, 0.0])

    def on_track(self, width: float = BEYOND_TRACK_M) -> list[Points]:
        """Return the outlines of what it takes of the track: a side that ends in the wall does not turn.

        Parameters
        ----------
        width : float [m], optional
            Of the track; else all that lies off the wall.

        Returns
        -------
        list of (K, 2) float [m]
            One of most openings.
        """
        y = self.ring[:, 1]
        if y.min() >= 0.0 and y.max() <= width:
            return [self.ring]
        track = shapely.box(-BEYOND_TRACK_M, 0.0, BEYOND_TRACK_M, width)
        taken = shapely.get_parts(shapely.Polygon(self.ring).intersection(track))
        return [shapely.get_coordinates(part)[:-1] for part in taken if part.geom_type == "Polygon"]

    def carried_over(self, width: float, far: float) -> list[Points]:
        """Return its outlines with each side along the wall or the free edge carried beyond it.

        Sides that only end there keep their direction: what lies beside them in a corner carries parts.

        Parameters
        ----------
        width : float [m]
            Of the track.
        far : float [m]
            By which such a side is moved out.

        Returns
        -------
        list of (K, 2) float [m]
        """
        carried = []
        for s, y in (ring.T for ring in self.on_track()):
            corners = np.column_stack([s, np.where(y <= SAME_PLACE_M, 0.0, y)]).tolist()
            carried.append(np.array(_beyond_borders(corners, width - SAME_PLACE_M, far)))
        return carried

    def shop_work(self, width: float) -> tuple[ShopWork, ...]:
        """Return what the shop must do to it, beside cutting its outline.

        Parameters
        ----------
        width : float [m]
            Of the track.

        Returns
        -------
        tuple of ShopWork
        """
        end = ShopWork.RUNS_INTO_NEXT if self.runs_on else ShopWork.OPEN_AT_OUTLET
        work = [end, ShopWork.YOKE_BELOW] if self.hangs else []
        y = self.ring[:, 1]
        work += [ShopWork.OPEN_AT_WALL] if y.min() <= SAME_PLACE_M else []
        work += [ShopWork.OPEN_AT_EDGE] if y.max() >= width - SAME_PLACE_M else []
        return tuple(work)


@dataclass(frozen=True, eq=False)
class Drop:
    """A place from which the track goes on lower: a step across it, or beside a ledge along the wall."""

    height: float  # [m]
    aside: float = 0.0  # [m] off the wall, where the lower track begins: the ledge's width, 0 of a step
    reach: float = 0.0  # [m] along the wall, over which a ledge is tried: as good as endless
    length: float = 0.0  # [m] of a ledge, before it comes down to the lower track
    ramp: float = 0.0  # [rad] slope of the flat ramp on which a ledge comes down

    def ramp_length(self, radius: float) -> float:
        """Return how far a ledge's ramp reaches along the wall, to where all of it is down.

        The ramp is bent down about a line square to the wall: at the ledge's edge it comes down last.

        Parameters
        ----------
        radius : float [m]
            Of the wall.

        Returns
        -------
        float [m]
            0 of a step.
        """
        if self.aside <= 0.0 or self.ramp <= 0.0:
            return 0.0
        ahead = self.height / math.tan(self.ramp) / (radius - self.aside)
        return radius * math.asin(min(ahead, LONGEST_RAMP_SINE))

    def beside(self, width: float, *, made: bool = False) -> TrackOpening:
        """Return what is missing of the upper track, as an opening of it.

        Parameters
        ----------
        width : float [m]
            Of the track.
        made : bool, optional
            Up to where a ledge comes down, as it is made; else as far as it is tried.

        Returns
        -------
        TrackOpening
        """
        far = self.length if made else self.reach
        return TrackOpening(box_ring(0.0, far, self.aside, width), (self.aside, width))


@dataclass(frozen=True, eq=False)
class Blade:
    """An upright plate on or over the track, at any angle to it."""

    solid: "shapely.Geometry"  # of its face [m], along the face from its foot, height over the track
    foot: tuple[float, float] = (0.0, 0.0)  # [m] x, y where the face begins
    heading: float = 0.5 * np.pi  # [rad] from the track's direction; less than a right angle is swept back
    thickness: float = BLADE  # [m] behind the face
    friction: float | None = None  # [1] static and kinetic, both ways; None is the track's
    is_gate: bool = False  # a part of its own that stands in a notch of the wall; else part of the track

    @property
    def top(self) -> float:
        """Height [m] of its upper edge."""
        return float(self.solid.bounds[3])

    @property
    def axes(self) -> Points:
        """Directions (2, 2) [1] along its face and behind it, each ahead along the wall and inwards."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        return np.array([[c, s], [s, -c]])

    def carried_into(self, wall: float, track: float, reach: float) -> "shapely.Geometry":
        """Return its face carried on into wall and track where it reaches them.

        No corner is left within a straight side: it would lie on the wall's or the track's own face.

        Parameters
        ----------
        wall, track : float [m]
            How far behind the wall's face, and below the track's.
        reach : float [m]
            What is as near to them reaches them.

        Returns
        -------
        shapely geometry [m]
            As ``solid``.
        """
        solid = self.solid
        if self.foot[1] <= 0.0:
            strip = shapely.box(0.0, -BEYOND_BLADES_M, reach, BEYOND_BLADES_M)
            bounds = shapely.bounds(shapely.get_parts(solid.intersection(strip)))
            solid = shapely.union_all(
                [solid, *(shapely.box(-wall, low, reach, high) for _, low, _, high in bounds)]
            )
        strip = shapely.box(-BEYOND_BLADES_M, 0.0, BEYOND_BLADES_M, reach)
        bounds = shapely.bounds(shapely.get_parts(solid.intersection(strip)))
        whole = shapely.union_all(
            [solid, *(shapely.box(near, -track, far, reach) for near, _, far, _ in bounds)]
        )
        return shapely.simplify(whole, SAME_PLACE_M)

    def footprint(self, radius: float) -> Points:
        """Return the plate seen from above, unrolled along the wall.

        It is a flat plate: in the unrolled track its sides bend.

        Parameters
        ----------
        radius : float [m]
            Of the wall.

        Returns
        -------
        (K, 2) float [m]
            The first corner is that where its face begins: at the wall, or at its foot on the track.
        """
        near, _, far, _ = self.solid.bounds
        flat = shapely.box(near, 0.0, far, self.thickness, ccw=False).exterior  # from where its face begins
        places = shapely.get_coordinates(shapely.segmentize(flat, FOOTPRINT_STEP_M))[:-1]
        x, y = (places[:, :1] * self.axes[0] + places[:, 1:] * self.axes[1]).T
        y = y + self.foot[1]
        s, off = self.foot[0] + radius * np.arctan2(x, radius - y), radius - np.hypot(x, radius - y)
        on_track = shapely.box(s.min() - 1.0, 0.0, s.max() + 1.0, radius)
        ring = shapely.Polygon(np.column_stack([s, off])).intersection(on_track).simplify(FOOTPRINT_CHORD_M)
        corners = shapely.get_coordinates(shapely.geometry.polygon.orient(ring))[:-1]
        if self.foot[1] > FOOTPRINT_CHORD_M:
            first = np.argmin(((corners - [s[0], off[0]]) ** 2).sum(axis=1))
        else:
            first = np.lexsort((corners[:, 0], corners[:, 1] > FOOTPRINT_CHORD_M))[0]
        return np.roll(corners, -int(first), axis=0)

    def opening(self) -> list[Points]:
        """Return the outlines (K, 2) [m] of what is free below and within it: off the wall, upwards."""
        near, _, far, top = self.solid.bounds
        free = shapely.box(max(near, 0.0), 0.0, far, top).difference(self.solid)
        parts = [part for part in shapely.get_parts(free) if part.geom_type == "Polygon"]
        return [self._seen_ahead(shapely.get_coordinates(part.exterior)[:-1]) for part in parts]

    @property
    def view_ahead(self) -> "shapely.Geometry":
        """The plate as seen along the track [m]: off the wall, upwards."""
        return shapely.transform(self.solid, self._seen_ahead)

    def _seen_ahead(self, points: Points) -> Points:
        """Points (K, 2) [m] of its face, as seen along the track."""
        return points * [math.sin(self.heading), 1.0] + [self.foot[1], 0.0]


@dataclass(frozen=True, eq=False)
class Slope:
    """Another lean of the track, from a place on: to the end of what is tried, or to the next slope."""

    begin: float  # [m] x
    climb: float | None = None  # [rad] rise along the track; None is as before
    bank: float | None = None  # [rad] by which the free edge is higher than the wall; None is as before
    wall: float | None = None  # [rad] by which the wall leans back from upright; None is as before
    length: float = 0.0  # [m] along the wall, over which it comes to lean so; 0: as far as that needs


@dataclass(frozen=True, eq=False)
class Jet:
    """A round jet of air that pushes what of a part is in it."""

    at: tuple[float, float, float]  # [m] x, y, z of its mouth; y below 0 of one askew, within the wall
    towards: tuple[float, float, float]  # [1] along the wall, inwards, up
    radius: float  # [m]
    spread: float  # [1] growth of the radius along its way
    thrust: float  # [N] on what takes all of it
    reach: float  # [m] from the mouth
    seconds: float = np.inf  # [s] of a pulse that a sensor sets off; infinite of a steady one

    @property
    def angle(self) -> float:
        """Angle [rad] of its axis to the direction of travel, seen from above."""
        return math.atan2(self.towards[1], self.towards[0])

    @property
    def place(self) -> float:
        """Place [m] along the wall at which its axis comes out of it."""
        return self.at[0] - self.at[1] * math.cos(self.angle) / math.sin(self.angle)

    def outline(self, width: float) -> Points:
        """Return the jet seen from above, up to a width of track.

        Parameters
        ----------
        width : float [m]

        Returns
        -------
        (4, 2) float [m]
            Corners: along the wall, and from it.
        """
        c, s = math.cos(self.angle), math.sin(self.angle)
        ahead, left = np.array([c, s]), np.array([-s, c])
        mouth = np.array([self.place, 0.0])
        end = mouth + ahead * width / s
        near, far = self.radius * left, (self.radius + self.spread * width / s) * left
        return np.array([mouth + near, mouth - near, end - far, end + far])


@dataclass(frozen=True, eq=False)
class Bore:
    """A round hole through the wall: of a nozzle, for a bracket's screw or for a fibre."""

    what: str  # that it is for: 'nozzle'
    place: float  # [m] x
    height: float  # [m] z
    diameter: float  # [m] to drill
    thread: str = ""  # 'M4'; '' of a plain hole
    angle: float = (
        0.5 * np.pi
    )  # [rad] of its way into the bowl to the direction of travel; square to the wall


@dataclass(frozen=True, eq=False)
class Sensor:
    """A sensor that looks at each part as its centre of mass comes to a place, and sets off pulsed jets."""

    at: float  # [m] x
    sees: str  # 'outline' from above, 'side' from the bowl's axis, 'height' or 'relief'
    wanted: tuple[LyingPart, ...]  # what is like any of them passes
    play: float  # [m] what is seen to differ by less passes
    resolution: float  # [m] to which it sees


@dataclass(frozen=True, eq=False)
class Features:
    """All that one device cuts out of the track, sets on it and changes of its way."""

    length: float = 0.0  # [m] along the wall, in which it acts
    openings: tuple[TrackOpening, ...] = ()
    blades: tuple[Blade, ...] = ()
    slopes: tuple[Slope, ...] = ()
    drop: Drop | None = None
    jets: tuple[Jet, ...] = ()
    mounts: tuple[Bore, ...] = ()  # holes for what is screwed to the wall beside the nozzles
    sensor: Sensor | None = None
    settles: float = 0.0  # of the part's size: how far behind the device parts go on until they are looked at

    @property
    def bores(self) -> tuple[Bore, ...]:
        """Return every hole through the wall: of its nozzles, and those for what is mounted there."""
        nozzles = (
            Bore("nozzle", jet.place, jet.at[2], 2.0 * jet.radius, angle=jet.angle) for jet in self.jets
        )
        return (*nozzles, *self.mounts)

    @property
    def hangs(self) -> bool:
        """Tell whether parts leave hanging, their centres of mass below the track."""
        return any(opening.hangs for opening in self.openings)

    @property
    def seen_from(self) -> str:
        """Return from where a picture shows a part at it: 'turned', 'ahead', 'side', 'above' or ''."""
        if self.drop is not None:
            return "turned"
        if self.blades:
            return "ahead" if any(blade.is_gate for blade in self.blades) else "side"
        return "above" if self.openings or self.jets else ""

    @property
    def slot(self) -> tuple[float, ...]:
        """The rails [m] off the wall between which what hangs goes on behind it; () of others."""
        return next((opening.span or () for opening in self.openings if opening.hangs), ())


NO_FEATURES = Features()


def box_ring(x0: float, x1: float, y0: float, y1: float) -> Points:
    """Return the corners of what lies between two places along the track and two across it.

    Parameters
    ----------
    x0, x1 : float [m]
        Along the wall.
    y0, y1 : float [m]
        From the wall.

    Returns
    -------
    (4, 2) float [m]
    """
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def through_the_wall(corners: Sequence[Corner]) -> list[Corner]:
    """Return the corners of a hole with every edge along the wall moved behind it.

    Parameters
    ----------
    corners : sequence of (float, float) [m]
        Along the wall, and from it.

    Returns
    -------
    list of (float, float) [m]
    """
    return _moved_out(corners, math.inf, WALL_OVERCUT_M)


def _beyond_borders(corners: Sequence[Corner], width: float, far: float) -> list[Corner]:
    """The corners of a hole with edges along the wall, and along the free edge from ``width`` on, moved."""
    out = _moved_out(corners, width, far)
    sides = zip((out[-1], *out[:-1]), out, (*out[1:], out[0]))
    return [here for before, here, after in sides if not before[0] == here[0] == after[0]]


def _moved_out(corners: Sequence[Corner], width: float, far: float) -> list[Corner]:
    """As ``_beyond_borders``, with the corners between what is moved and straight sides to it."""
    out = []
    for (s0, y0), (s1, y1) in zip(corners, (*corners[1:], corners[0])):
        out.append((s0, y0))
        if y0 <= 0.0 and y1 <= 0.0:
            out += [(s0, min(y0, y1) - far), (s1, min(y0, y1) - far)]
        elif y0 >= width and y1 >= width:
            out += [(s0, max(y0, y1) + far), (s1, max(y0, y1) + far)]
    return out
