"""Each device along the track as the trial takes it: plates with borders in the bowl's own frame.

With them the jets of air and the lean of the track, as the kernel takes them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import shapely

from feederscrew.base.arrays import Floats
from feederscrew.base.geometry.compiled import frozen_rows
from feederscrew.base.geometry.polygons import cross
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.features import (
    LONGEST_RAMP_SINE,
    Blade,
    Drop,
    Features,
    Sensor,
    Slope,
    TrackOpening,
    box_ring,
)
from feederscrew.bowl.record import Track
from feederscrew.sorting.fates import leading_devices
from feederscrew.sorting.orientations import CUT_BORDER_RADIUS_M, Orientation
from feederscrew.sorting.tooled_track import (
    CLEAR_SIZES,
    PlacedDevice,
    TooledTrack,
    along_wall,
    bend_ring,
    clear_behind,
    lay_out,
    size_of_part,
)
from feederscrew.trials.kernel.workspace import BORDER, JET, PLATE_RECORD, Rows

DRAWN_BEHIND_WALL = 0.5  # of the part's size: how far the track is drawn behind the wall
MAX_SAGITTA_M = 5e-6  # by which an arc may be seen too flat
SMOOTHING_M = 2e-6  # corners of a border that stand out by less are left out
CORNER_ANGLE = 1e-4  # [rad] a border that turns by less has no corner
# of the part's size
DRAWN_BEFORE = 1.2  # track before where they begin
DRAWN_AFTER = 0.8  # track behind their end
BEYOND_OPENINGS_M = 10.0  # beyond any opening
FLOOR_REACH = 3.0  # times a bucket's radius: how far its floor goes on behind the wall
TRACK_DEPTH_M = 4e-3  # of the track: deeper down its sides hold nothing
TRACK_FRICTION = np.nan  # friction of a plate that has that of the track
# of the part's size
BLEND = 0.25  # way over which a climb, or a bank of the entry, becomes the next
OPENS = 1.0  # way over which a lean of wall becomes the next
MAX_LEAN_STEP_RAD = np.radians(2.0)  # [rad] between two places of a twist: between them sines are linear

# A plate: frame (4, 3), depth [m], friction [1], and borders (B, 10).
Plate = tuple[Floats, float, float, Floats]

BARE_TRACK = Device("")


class PlacedSlope(NamedTuple):
    """A slope where it begins; None where it leaves something as it was."""

    place: float  # [m]
    climb: float | None = None  # [rad]
    bank: float | None = None  # [rad]
    wall: float | None = None  # [rad] lean of the wall
    over: float | None = None  # [m] along the wall, over which it comes to lean so; None: by the part's size


@dataclass(frozen=True, eq=False)
class Placement:
    """A device on the track that is tried, in the plane of the track before all drops."""

    features: Features
    openings: tuple[TrackOpening, ...]  # placed along the wall, slots that go on as they are made
    begin: float  # [m] along the wall
    last: float  # [m] where the track above its step is drawn to, at most
    bank: float = 0.0  # [rad] of the track there
    climb: float = 0.0  # [rad]
    over: tuple[float | None, ...] = ()  # [m] of each of its slopes, over which the track comes to lean so

    @property
    def lower(self) -> tuple[float, float]:
        """By how much [m] the track goes down at it, and outwards: a drop is upright, the plane is not."""
        drop = self.features.drop
        height = 0.0 if drop is None else drop.height
        return height * float(np.cos(self.bank)), height * float(np.sin(self.bank))


@dataclass(frozen=True, eq=False)
class Watch:
    """A sensor at its place, and which jets it sets off."""

    place: float  # [m] along the wall
    nozzles: float  # [m] where those jets are
    sensor: Sensor
    jets: slice  # rows of the stage's jets
    seconds: float  # [s] for which those blow


class Pulses:
    """Pulses of some jets that are set off, each for one part: they blow one after the other."""

    def __init__(self) -> None:
        self.log: list[tuple[float, float]] = []  # (begin, end) of all

    def set_off(self, begin: float, seconds: float) -> None:
        """Let the jets blow from a time on, for so long.

        Parameters
        ----------
        begin, seconds : float [s]
            Any unit of time, the same in all calls.
        """
        self.log.append((begin, begin + seconds))

    def next(self, now: float) -> tuple[float, float]:
        """Return when the jets next blow, or blow now; pulses that overlap are one.

        Parameters
        ----------
        now : float [s]
            In the unit of ``set_off``.

        Returns
        -------
        begin, end : float [s]
            Infinite, both, where no pulse is left.
        """
        spans = sorted(span for span in self.log if span[1] > now)
        if not spans:
            return np.inf, np.inf
        begin, end = spans[0]
        for other in spans[1:]:
            if other[0] <= end:
                end = max(end, other[1])
        return begin, end


@dataclass(frozen=True, eq=False)
class Air:
    """Jets, sensors and slopes along a stretch of track."""

    jets: Rows  # (J,) `trials.kernel.workspace.JET` [m], [1], [m/s2], [s]
    watches: tuple[Watch, ...]
    slopes: tuple[PlacedSlope, ...]


STILL_AIR = Air(frozen_rows([], JET), (), ())


@dataclass(frozen=True, eq=False)
class Stage:
    """One device, or a stretch of the bare track, as solid geometry in the bowl's frame."""

    device: Device
    plates: Rows  # (P,) `trials.kernel.workspace.PLATE_RECORD` [m], [1]
    borders: Rows  # (B,) `trials.kernel.workspace.BORDER` [m], [1]
    begin: float  # [m] along the wall, where the part's centre of mass starts
    exit: float  # [m] where it has passed
    cut: tuple[float, float] = (np.inf, -np.inf)  # [m] along the wall, where the device begins and ends
    drop: float = 0.0  # [m] by which the track lies lower there
    aside: float = 0.0  # [m] by which that lies further out as well
    leaves_hanging: bool = False  # whether parts leave hanging, their centres of mass below the track
    air: Air = STILL_AIR  # what blows there, and how the track leans
    size: float = 0.0  # [m] of the part, the greatest length of its orientations
    width: float = np.inf  # [m] of the track
    on_side: float = 0.0  # [rad] by which parts that leave are on their side, as the track is twisted
    middle: float = 0.0  # [m] of the track that is drawn: a way along the wall is within half a turn of it


def stage_device(
    device: Device,
    track: Track,
    orientations: Sequence[Orientation],
    slopes: Sequence[PlacedSlope] = (),
    slot: tuple[float, ...] = (),
) -> Stage:
    """Return one device alone on a track, with enough track before and behind it.

    Parameters
    ----------
    device : Device
        One that has a place.
    track : Track
    orientations : sequence of Orientation
        The longest sets how long a device is that goes on along the track.
    slopes, slot : optional
        As of ``stage_placed``.

    Returns
    -------
    Stage
    """
    tooled = lay_out(track, [device], orientations, whole=True)
    return stage_placed(tooled, 0, track, orientations, slopes, slot)


def stage_placed(
    tooled: TooledTrack,
    number: int,
    track: Track,
    orientations: Sequence[Orientation],
    slopes: Sequence[PlacedSlope] = (),
    slot: tuple[float, ...] = (),
) -> Stage:
    """Return one device of a tooled track by itself, its features from the place 0 on.

    Parameters
    ----------
    tooled : TooledTrack
        Of the whole width.
    number : int
        Of the device, from 0.
    track : Track
    orientations : sequence of Orientation
    slopes : sequence of PlacedSlope, optional
        Of the devices before it: they go on.
    slot : tuple of float [m], optional
        Of the rails before it: two distances from the wall. What hangs there goes on hanging up to other
        rails.

    Returns
    -------
    Stage
    """
    placed, size = tooled.devices[number], size_of_part(orientations)
    features, over = placed.features, lean_lengths(tooled, placed)
    begin = -CLEAR_SIZES * size
    beyond = max([clear_behind(0.0, features, size), *(way for way in over if way is not None)])
    ends = begin - DRAWN_BEFORE * size, beyond + DRAWN_AFTER * size
    far = ends[1] + DRAWN_BEHIND_WALL * size
    openings = tuple(
        opening.extended(far) if opening.hangs and opening.end < ends[1] else opening
        for opening in features.openings
    )
    bank = float(tooled.bank_at(placed.begin))
    here = Placement(features, openings, 0.0, ends[1], bank, float(tooled.climb_at(placed.begin)), over)
    blows = place_air([here], track, orientations)
    blows = replace(blows, slopes=(*slopes, *blows.slopes))
    return Stage(
        placed.device,
        *build_track([here], track, size, ends, slot),
        begin=begin,
        exit=beyond,
        cut=(0.0, features.length),
        drop=here.lower[0],
        aside=here.lower[1],
        leaves_hanging=features.hangs or bool(slot),
        air=blows,
        size=size,
        width=track.extent,
        on_side=on_side([item.device for item in tooled.devices[: number + 1]]),
        middle=0.5 * sum(ends),
    )


def on_side(devices: Sequence[Device]) -> float:
    """Return the angle by which parts are on their side behind some devices.

    Parameters
    ----------
    devices : sequence of Device

    Returns
    -------
    float [rad]
        0 where none of them twists the track.
    """
    return max((device.on_side for device in devices), default=0.0)


def place_all(tooled: TooledTrack, end: float, size: float) -> list[Placement]:
    """Return every device of a tooled track as parts meet them one after the other.

    Parameters
    ----------
    tooled : TooledTrack
        Of the whole width.
    end : float [m]
        To which the track goes on, with the slot that is open at its end.
    size : float [m]
        Of the part, as ``size_of_part`` returns it.

    Returns
    -------
    list of Placement
    """
    opened = tooled.opened_to(end + DRAWN_BEHIND_WALL * size)

    def as_tried(placed: PlacedDevice) -> tuple[TrackOpening, ...]:
        """Return openings; the last slot as rails alone have it, where that reaches beyond what is drawn."""
        alone = (opening.shifted(placed.begin) for opening in placed.features.openings)
        return tuple(
            own if own.hangs and not opening.runs_on and own.end >= end else opening
            for own, opening in zip(alone, placed.openings)
        )

    return [
        Placement(
            placed.features,
            as_tried(placed),
            placed.begin,
            end if placed.end == tooled.length else placed.end,
            float(tooled.bank_at(placed.begin)),
            float(tooled.climb_at(placed.begin)),
            lean_lengths(tooled, placed),
        )
        for placed in opened.devices
    ]


def lean_lengths(tooled: TooledTrack, placed: PlacedDevice) -> tuple[float | None, ...]:
    """Return over which length of the wall the track comes to lean as each slope of a device says.

    Parameters
    ----------
    tooled : TooledTrack
    placed : PlacedDevice

    Returns
    -------
    tuple of float [m] or None
        None where it leaves bank and wall as they are, or begins at the track's entry.
    """
    twists = {start: end - start for start, end, _ in (*tooled.banks, *tooled.walls)}
    return tuple(twists.get(placed.begin + slope.begin) for slope in placed.features.slopes)


def stage_bare_track(
    track: Track, orientations: Sequence[Orientation], length: float, slopes: Sequence[PlacedSlope] = ()
) -> Stage:
    """Return a stretch of the bare track, from the place 0 on.

    Parameters
    ----------
    track : Track
    orientations : sequence of Orientation
        The longest sets how much track is drawn before and behind.
    length : float [m]
        Of the stretch.
    slopes : sequence of PlacedSlope, optional
        As for ``stage_placed``.

    Returns
    -------
    Stage
    """
    size = size_of_part(orientations)
    ends = -DRAWN_BEFORE * size, length + DRAWN_AFTER * size
    return Stage(
        BARE_TRACK,
        *build_track((), track, size, ends),
        begin=0.0,
        exit=length,
        size=size,
        width=track.extent,
        air=replace(STILL_AIR, slopes=tuple(slopes)),
        middle=0.5 * sum(ends),
    )


def entry_slopes(
    devices: Sequence[Device], track: Track, orientations: Sequence[Orientation]
) -> tuple[Slope, ...]:
    """Return the slopes of the devices that come first and lean the track: they begin at its entry.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    track : Track
    orientations : sequence of Orientation

    Returns
    -------
    tuple of Slope
    """
    return tuple(
        slope for device in leading_devices(devices) for slope in device.features(track, orientations).slopes
    )


def slopes_before(slopes: Sequence[Slope]) -> tuple[PlacedSlope, ...]:
    """Return slopes placed far before what is drawn, where they began.

    Parameters
    ----------
    slopes : sequence of Slope

    Returns
    -------
    tuple of PlacedSlope
    """
    return tuple(PlacedSlope(-BEYOND_OPENINGS_M, slope.climb, slope.bank, slope.wall) for slope in slopes)


def build_track(
    placements: Sequence[Placement],
    track: Track,
    size: float,
    ends: tuple[float, float],
    slot: tuple[float, ...] = (),
) -> tuple[Rows, Rows]:
    """Return plates and borders of a stretch of track with its devices.

    A drop is upright: on a banked track what is lower lies further out as well, as the wall does there.

    Parameters
    ----------
    placements : sequence of Placement
        The devices in the order parts meet them.
    track : Track
    size : float [m]
        Of the part, as ``size_of_part`` returns it.
    ends : (float, float) [m]
        The stretch, along the wall.
    slot : tuple of float [m], optional
        Of rails before the devices: two distances from the wall.

    Returns
    -------
    plates : (P,) record
        ``trials.kernel.workspace.PLATE_RECORD`` [m], [1].
    borders : (B,) record
        ``trials.kernel.workspace.BORDER`` [m], [1].
    """
    level, aside, first = 0.0, 0.0, ends[0]
    holes: list[TrackOpening] = []
    plates: list[Plate] = []
    raised: list[Plate] = []  # blades and ramps
    behind = DRAWN_BEHIND_WALL * size
    slots = [opening for item in placements for opening in item.openings if opening.hangs]
    if slot:  # between the rails before them, up to the first of their own
        until = min((own.begin + SMOOTHING_M for own in slots), default=ends[1] + behind)
        slots.append(TrackOpening(box_ring(ends[0] - behind, until, *slot)))
    for item in placements:
        holes += [opening for opening in item.openings if not opening.hangs]
        raised += [_blade(blade, track, item.begin, size, level, aside) for blade in item.features.blades]
        drop = item.features.drop
        if drop is not None and drop.height > 0.0:
            holes.append(drop.beside(track.extent).shifted(item.begin))
            last = item.last if drop.aside <= 0.0 else item.begin + drop.length
            depth = drop.height + TRACK_DEPTH_M
            plates.append(_floor([*holes, *slots], track, size, ends, (first, last), (level, aside), depth))
            if drop.aside > 0.0:
                raised.append(_ramp(drop, (item.bank, item.climb), track, size, last, level, aside))
            level, aside = level - item.lower[0], aside - item.lower[1]
            first, holes = item.begin - TRACK_DEPTH_M, []
    plates.append(_floor([*holes, *slots], track, size, ends, (first, ends[1]), (level, aside)))
    return _as_rows([*plates, *raised])


def stage_level_floor(radius: float) -> Stage:
    """Return a level floor without an end inside a round wall.

    Parameters
    ----------
    radius : float [m]
        Of the wall.

    Returns
    -------
    Stage
    """
    frame = np.array([[0.0, radius, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    reach = FLOOR_REACH * radius
    borders = _borders(shapely.box(-reach, -reach, reach, reach), lambda start, end: True)
    plates, rows = _as_rows([(frame, reach, TRACK_FRICTION, borders)])
    return Stage(BARE_TRACK, plates, rows, begin=0.0, exit=np.inf, size=radius)


def _as_rows(plates: Sequence[Plate]) -> tuple[Rows, Rows]:
    """All plates as records with boxes around their borders, and those borders."""
    rows, borders, count = [], [], 0
    for frame, depth, friction, own in plates:
        box = [end for k in (0, 1) for end in (own[:, k:4:2].min(), own[:, k:4:2].max())]
        rows.append((*frame.ravel(), depth, CUT_BORDER_RADIUS_M, count, count + len(own), friction, *box))
        borders += [(*row, 0.0, 0.0) for row in own]
        count += len(own)
    return frozen_rows(rows, PLATE_RECORD), frozen_rows(borders, BORDER)


def _floor(
    holes: Sequence[TrackOpening],
    track: Track,
    size: float,
    ends: tuple[float, float],
    span: tuple[float, float],
    lies: tuple[float, float],
    depth: float = TRACK_DEPTH_M,
) -> Plate:
    """A level surface: a sector about the bowl's axis between two places, without the holes.

    ``lies`` [m] is its level, and where the wall is there: distances from the wall count from that.
    """
    behind, width, radius = DRAWN_BEHIND_WALL * size, track.extent, track.radius
    level, aside = lies
    first, last = span
    length = last - first
    # At lengths along the wall and two distances from it; nothing comes behind the wall.
    coarse = np.linspace(first, last, max(int(length / behind), 2) + 1)
    fine = np.linspace(first, last, int(length / np.sqrt(8.0 * radius * MAX_SAGITTA_M)) + 2)[::-1]
    ring = [
        np.column_stack([off * np.sin(places / radius), radius - off * np.cos(places / radius)])
        for places, off in ((coarse, radius + behind - aside), (fine, radius - width - aside))
    ]
    area = shapely.Polygon(np.vstack(ring))
    for hole in holes:
        if hole.begin >= last + behind:  # of a device further on, on a lower track
            continue
        taken = replace(hole, ring=np.minimum(hole.ring, [last + behind, np.inf]))
        for outline in taken.carried_over(width, 2.0 * behind):
            bent = bend_ring(outline + [0.0, aside], radius, sagitta=MAX_SAGITTA_M)
            area = area.difference(shapely.make_valid(shapely.Polygon(bent)))
    frame = np.array([[0.0, 0.0, level], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    near = 1e-6 * radius

    def ends_drawing(a: Floats, b: Floats) -> bool:
        """Tell whether a border from a (2,) to b (2,) [m] ends the drawing: behind the wall, or at an end."""
        off = [np.hypot(x, radius - y) for x, y in (a, b)]
        place = along_wall(np.array([a, b]), radius, 0.5 * sum(ends))
        is_behind = min(off) > radius - aside + near
        return bool(is_behind or max(place) < ends[0] + near or min(place) > ends[1] - near)

    return frame, depth, TRACK_FRICTION, _borders(area, ends_drawing)


def _ramp(
    drop: Drop,
    leans: tuple[float, float],
    track: Track,
    size: float,
    begin: float,
    level: float,
    aside: float,
) -> Plate:
    """The flat ramp on which a ledge comes down from a place on; ``leans`` [rad] are bank and climb there."""
    behind, radius = DRAWN_BEHIND_WALL * size, track.radius - aside
    theta, inner = begin / track.radius, radius - drop.aside
    # as the track's plane sees it: in the bowl it falls upright
    fall, (bank, climb) = np.tan(drop.ramp), leans
    slope = np.arctan2(fall * np.cos(bank) * np.cos(climb), 1.0 - fall * np.sin(climb) * np.cos(climb))
    far = drop.height * np.cos(bank) / np.tan(slope)
    ahead = np.array([np.cos(theta), np.sin(theta), 0.0])
    inwards = np.array([-ahead[1], ahead[0], 0.0])
    up = np.array([0.0, 0.0, 1.0])
    c, s = np.cos(slope), np.sin(slope)
    origin = np.array([0.0, track.radius, level]) - radius * inwards
    frame = np.array([origin, c * ahead - s * up, inwards, s * ahead + c * up])
    # seen from above, ahead and inwards: between the wall and the ledge's edge
    turn = np.arcsin(min(far / inner, LONGEST_RAMP_SINE)) + 2.0 * behind / inner
    turns = np.linspace(-2.0 * behind / inner, turn, int(turn / np.sqrt(8.0 * MAX_SAGITTA_M / radius)) + 3)
    rings = [
        np.column_stack([r * np.sin(some), radius - r * np.cos(some)])
        for r, some in ((radius + behind, turns), (inner, turns[::-1]))
    ]
    area = shapely.Polygon(np.vstack(rings)).intersection(shapely.box(0.0, -1.0, far, 1.0))
    solid = shapely.transform(area, lambda points: points / [c, 1.0])
    ends, near = (0.0, far / c), 1e-6 * radius

    def ends_drawing(a: Floats, b: Floats) -> bool:
        """Tell whether a border from a (2,) to b (2,) [m] joins another plate, or lies behind the wall."""
        along = any(max(abs(a[0] - end), abs(b[0] - end)) < near for end in ends)
        off = [np.hypot(c * x, radius - y) for x, y in (a, b)]
        return bool(along or min(off) > radius + near)

    return frame, TRACK_DEPTH_M, TRACK_FRICTION, _borders(solid, ends_drawing)


def _blade(blade: Blade, track: Track, start: float, size: float, level: float, aside: float = 0.0) -> Plate:
    """A blade as a plate seen by the part that arrives: along its face from the foot, and upwards.

    It goes on into wall and track where it reaches them: a corner that touches either does not slip past it.
    """
    behind, at_wall = DRAWN_BEHIND_WALL * size, blade.foot[1] <= 0.0
    solid = blade.carried_into(behind, behind, SMOOTHING_M)
    theta = (start + blade.foot[0]) / track.radius
    ahead = np.array([np.cos(theta), np.sin(theta), 0.0])
    inwards = np.array([-ahead[1], ahead[0], 0.0])
    origin = np.array([0.0, track.radius, level]) - (track.radius - blade.foot[1] - aside) * inwards
    along = np.cos(blade.heading) * ahead + np.sin(blade.heading) * inwards
    front = np.array([-along[1], along[0], 0.0])  # against the part that arrives
    frame = np.array([origin, along, [0.0, 0.0, 1.0], front])
    own = TRACK_FRICTION if blade.friction is None else blade.friction
    near = 0.0 if at_wall else -np.inf
    borders = _borders(solid, lambda a, b: max(a[0], b[0]) <= near or max(a[1], b[1]) <= 0.0)
    return frame, blade.thickness, own, borders


def _borders(area: Any, is_end: Callable[..., bool]) -> Floats:
    """Borders (B, 10) [m] of a solid area, columns as the fields of BORDER but for the last two.

    ``is_end`` tells of both ends (2,) of a border whether what is drawn ends there, not what is solid.
    """
    borders: list[list[float]] = []
    polygons = [part for part in shapely.get_parts(shapely.simplify(area, SMOOTHING_M)) if part.area > 0.0]
    for polygon in map(shapely.geometry.polygon.orient, polygons):  # the solid on the left
        for ring in (polygon.exterior, *polygon.interiors):
            points = np.asarray(ring.coords)[:-1, :2]
            for o, p, q in zip(np.roll(points, 1, axis=0), points, np.roll(points, -1, axis=0)):
                along, came = q - p, p - o
                size = np.hypot(*along)
                bend = np.arctan2(cross(came, along), came[0] * along[0] + came[1] * along[1])
                end = is_end(p, q)
                corner = bend > CORNER_ANGLE and not end and not is_end(o, p)
                before = np.array([came[1], -came[0]]) / np.hypot(*came)
                normal = along[1] / size, -along[0] / size
                borders.append([*p, *q, *normal, float(corner), float(end), *before])
    return np.array(borders).reshape(-1, 10)


def place_air(placements: Sequence[Placement], track: Track, orientations: Sequence[Orientation]) -> Air:
    """Return the jets, sensors and slopes of devices along a track, in the bowl's frame.

    Parameters
    ----------
    placements : sequence of Placement
        The devices in the order parts meet them.
    track : Track
    orientations : sequence of Orientation
        Of one part: its mass makes an acceleration of a jet's thrust.

    Returns
    -------
    Air
        Jets that a sensor sets off do not blow yet.
    """
    rows: list[list[float]] = []
    watches: list[Watch] = []
    slopes: list[PlacedSlope] = []
    mass = orientations[0].posture.mass
    level, aside = 0.0, 0.0
    for item in placements:
        features, start, first = item.features, item.begin, len(rows)
        for jet in features.jets:  # in the bowl's frame; one that a sensor sets off does not blow
            x, y, z = jet.at
            theta, off = (start + x) / track.radius, track.radius - y - aside
            c, s, (a, b, up) = np.cos(theta), np.sin(theta), jet.towards
            size = np.sqrt(a * a + b * b + up * up)
            towards = (a * c - b * s) / size, (a * s + b * c) / size, up / size
            mouth = off * s, track.radius - off * c, z + level
            times = (0.0, np.inf) if np.isinf(jet.seconds) else (np.inf, np.inf)
            rows.append([*mouth, *towards, jet.radius, jet.spread, jet.thrust / mass, jet.reach, *times])
        if features.sensor is not None:
            seconds = max((jet.seconds for jet in features.jets), default=0.0)
            place, nozzles = start + features.sensor.at, start + features.jets[0].at[0]
            watches.append(Watch(place, nozzles, features.sensor, slice(first, len(rows)), seconds))
        for slope, over in zip(features.slopes, item.over or (None,) * len(features.slopes)):
            slopes.append(PlacedSlope(start + slope.begin, slope.climb, slope.bank, slope.wall, over))
        level, aside = level - item.lower[0], aside - item.lower[1]
    return Air(frozen_rows(rows, JET), tuple(watches), tuple(slopes))


def scale_jets(rows: Rows, length: float, unit: float) -> Rows:
    """Return jets without dimensions.

    Parameters
    ----------
    rows : (J,) record
        ``trials.kernel.workspace.JET`` [m], [1], [m/s2], [s].
    length : float [m]
        The unit of length.
    unit : float [s]
        The unit of time.

    Returns
    -------
    (J,) record
    """
    out = rows.copy()
    for name in ("mouth_x", "mouth_y", "mouth_z", "radius", "reach"):
        out[name] /= length
    out["thrust"] *= unit**2 / length
    for name in ("begin", "end"):
        out[name] /= unit
    return out


def tabulate_leans(
    slopes: Sequence[PlacedSlope], climb: float, bank: float, size: float, length: float
) -> Floats:
    """Return how gravity, the bowl's axis and the wall lie in the track's frame, along the wall.

    Parameters
    ----------
    slopes : sequence of PlacedSlope
        In any order.
    climb, bank : float [rad]
        Before the slopes.
    size : float [m]
        Of the part: over a share of it one lean becomes the next, ``BLEND``, or ``OPENS`` where the wall
        leans, where a slope does not say over which length.
    length : float [m]
        The unit of length L.

    Returns
    -------
    (K, 8) float [L] and [1]
        Place; gravity along, inwards and up; the bowl's axis and the wall's upright, each inwards and up.
        Between places it is linear.
    """
    here: Any = (climb, bank, 0.0)
    rows = [] if slopes else [(0.0, *here)]
    for slope in sorted(slopes, key=lambda slope: slope.place):
        rows.append((slope.place / length, *here))
        new = slope.climb, slope.bank, slope.wall
        before, here = here, tuple(old if value is None else value for old, value in zip(here, new))
        over = (BLEND if here[-1] == before[-1] else OPENS) * size if slope.over is None else slope.over
        most = max(abs(new - old) for old, new in zip(before, here))
        count = max(int(np.ceil(most / MAX_LEAN_STEP_RAD)), 1)
        for share in np.arange(1, count + 1) / count:  # angles are linear over a twist
            between = (old + share * (new - old) for old, new in zip(before, here))
            rows.append(((slope.place + share * over) / length, *between))
    leans = []
    for place, rise, tilt, wall in rows:
        c, s, off = np.cos(rise), np.sin(rise), tilt - wall
        axis, upright = [np.sin(tilt), np.cos(tilt)], [np.sin(off), np.cos(off)]
        leans.append([place, -s, -c * np.sin(tilt), -c * np.cos(tilt), *axis, *upright])
    return np.array(leans)
