"""Each device along the track as the trial takes it: plates with borders in the bowl's own frame."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from feederscrew.geometry.compiled import frozen_rows
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.openings import beyond_borders
from feederscrew.tooling.fates import leading
from feederscrew.tooling.orientations import CUT_BORDER_RADIUS_M
from feederscrew.tooling.track_sections import bend_ring
from feederscrew.trial import air
from feederscrew.trial.air import Air
from feederscrew.trial.kernel.workspace import BORDER, PLATE_RECORD

DRAWN_BEHIND_WALL = 0.5  # of the part's size: how far the track is drawn behind the wall
MAX_SAGITTA_M = 5e-6  # [m] by which an arc may be seen too flat
SMOOTHING_M = 2e-6  # [m] corners of a border that stand out by less are left out
CORNER_ANGLE = 1e-4  # [rad] a border that turns by less has no corner
SPARE_WAY = 0.1  # of the part's size: how far before a device parts begin, and behind it they end
DRAWN_BEFORE, DRAWN_AFTER = (
    1.2,
    0.8,
)  # of the part's size: track before where parts begin and behind where they end
BEYOND_OPENINGS_M = 10.0  # [m] beyond any opening
TRACK_DEPTH_M = 4e-3  # [m] of the track: deeper down its sides hold nothing
TRACK_FRICTION = np.nan  # friction of a plate that has that of the track

BARE_TRACK = Device("")


@dataclass(frozen=True, eq=False)
class Stage:
    """One device, or a stretch of the bare track, as solid geometry in the bowl's frame."""

    device: object  # tooling.devices.base.Device
    plates: np.recarray  # (P,) `trial.kernel.workspace.PLATE` [m], [1]
    borders: np.recarray  # (B,) `trial.kernel.workspace.BORDER` [m], [1]
    begin: float  # [m] along the wall, where the part's centre of mass starts
    exit: float  # [m] where it has passed
    cut: tuple[float, float] = (np.inf, -np.inf)  # [m] along the wall, where the device begins and ends
    drop: float = 0.0  # [m] by which the track lies lower there
    aside: float = 0.0  # [m] from the wall, where a track that lies lower begins
    below: bool = False  # whether parts leave hanging, their centres of mass below the track
    air: Air = air.STILL_AIR  # what blows there, and how the track leans
    size: float = 0.0  # [m] of the part, the greatest length of its orientations
    width: float = np.inf  # [m] of the track


def size_of(orientations):
    """Return the greatest length [m] of orientations, in the plane of the track or across it."""
    return max(
        np.hypot(orientation.length, max(orientation.width, orientation.height))
        for orientation in orientations
    )


def stage(device, track, orientations, start=0.0, slopes=(), slot=()) -> Stage:
    """Return one device with enough track before and behind it.

    Parameters
    ----------
    device : Device
        A measured yield is bare track.
    track : Track
    orientations : sequence of Orientation
        Of the part, the longest of which sets how long a device is that goes on along the track.
    start : float [m]
        Where the device begins.
    slopes : sequence of Slope
        Of the devices before it, which go on.
    slot : (float [m], float [m]) or ()
        Between the rails before it, from the wall: what hangs there goes on hanging up to other rails.

    Returns
    -------
    Stage
    """
    standing, size = device.standing(track, orientations), size_of(orientations)
    blows = air.along([(standing, start, 0.0)], track, orientations)
    blows = replace(blows, slopes=(*before(slopes), *blows.slopes))
    begin, beyond = start - (0.5 + SPARE_WAY) * size, passed(standing, start, size)
    ends = begin - DRAWN_BEFORE * size, beyond + DRAWN_AFTER * size
    return Stage(
        device, *built([(standing, start, ends[1])], track, size, ends, slot), begin=begin, exit=beyond,
        cut=(start, start + standing.length), drop=standing.drop, aside=standing.aside,
        below=standing.hangs or bool(slot),
        air=blows, size=size, width=track.extent,
    )  # fmt: skip


def plain(track, orientations, length, slopes=()) -> Stage:
    """Return a stretch of the bare track, from 0 to ``length`` [m]; slopes as for ``stage``."""
    size = size_of(orientations)
    bare = built((), track, size, (-DRAWN_BEFORE * size, length + DRAWN_AFTER * size))
    blows = replace(air.STILL_AIR, slopes=before(slopes))
    return Stage(BARE_TRACK, *bare, begin=0.0, exit=length, size=size, width=track.extent, air=blows)


def at_entry(devices, track, orientations) -> tuple[Any, ...]:
    """Return the slopes of the devices that come first and lean the track: they begin at its entry."""
    return tuple(
        slope for device in leading(devices) for slope in device.standing(track, orientations).slopes
    )


def before(slopes) -> tuple[Any, ...]:
    """Return slopes as they are where they began before what is drawn."""
    return tuple((-BEYOND_OPENINGS_M, slope.climb, slope.bank, slope.wall) for slope in slopes)


def passed(standing, start, size):
    """Return where [m] along the wall a centre of mass has passed a device that begins at ``start``."""
    return start + standing.length + (standing.settles + 0.5 + SPARE_WAY) * size


def built(placed, track, size, ends, slot=()) -> tuple[np.recarray, np.recarray]:
    """Return plates (P,) and borders (B,) of a stretch of track with devices along it.

    Parameters
    ----------
    placed : sequence of (Standing, float [m], float [m])
        In the order parts meet them: where each begins, and where the track above its drop ends.
    track : Track
    size : float [m]
        Of the part.
    ends : (float [m], float [m])
        Along the wall.
    slot : (float [m], float [m]) or ()
        Between rails that come before them, from the wall.
    """
    level, first, holes, plates, blades = 0.0, ends[0], [], [], []
    slots = _slots(placed, size, ends, slot)
    for k, (standing, start, last) in enumerate(placed):
        holes += [(outline, start) for outline in _up_to_rails(placed, k)]
        blades += [_blade(blade, track, start, size, level) for blade in standing.blades]
        if standing.drop > 0.0:
            cuts, depth = [*holes, *slots], standing.drop + TRACK_DEPTH_M
            plates.append(_floor(cuts, track, size, ends, (first, last), level, depth))
            level, first, holes = level - standing.drop, start - TRACK_DEPTH_M, []
    plates.append(_floor([*holes, *slots], track, size, ends, (first, ends[1]), level))
    return stacked([*plates, *blades])


def _slots(placed, size, ends, slot):
    """Slots between rails (outline, start) that go on to the next rails, or to the end of what is drawn.

    Those of ``placed`` are cut themselves; one of rails before them begins where the drawing does.
    """
    slots, begin = [], ends[0] - DRAWN_BEHIND_WALL * size
    for standing, start, _ in placed:
        if standing.slot:
            slots += [_rectangle(begin, start + SMOOTHING_M, slot)] if slot else []
            begin = start + max(hole.outline[:, 0].max() for hole in standing.holes) - SMOOTHING_M
            slot = standing.slot
    return (
        [*slots, _rectangle(begin, ends[1] + DRAWN_BEHIND_WALL * size, slot)]
        if slot and begin < ends[1]
        else slots
    )


def _rectangle(begin, end, span) -> tuple[Any, ...]:
    """A hole between two places along the wall and two distances from it: its outline, from the place 0."""
    low, high = span
    return np.array([[begin, low], [end, low], [end, high], [begin, high]]), 0.0


def _up_to_rails(placed, k) -> Iterator[Any]:
    """Outlines (K, 2) [m] of the holes of the k-th device; its slot ends where other rails begin."""
    standing, start, _ = placed[k]
    ends = [begin for other, begin, _ in placed[k + 1 :] if other.slot] if standing.slot else []
    far = ends[0] - start + SMOOTHING_M if ends else np.inf
    for hole in standing.holes:
        yield np.column_stack([np.minimum(hole.outline[:, 0], far), hole.outline[:, 1]])


def _floor(holes, track, size, ends, own, level, depth=TRACK_DEPTH_M) -> tuple[Any, ...]:
    """A level surface: a sector about the bowl's axis between two places, without the holes."""
    behind, width = DRAWN_BEHIND_WALL * size, track.extent
    first, last = own
    length = last - first
    coarse = np.linspace(first, last, max(int(length / behind), 2) + 1)  # nothing comes there
    fine = np.linspace(first, last, int(length / np.sqrt(8.0 * track.radius * MAX_SAGITTA_M)) + 2)[::-1]
    ring = np.vstack([_arc(coarse, -behind, track.radius), _arc(fine, width, track.radius)])
    area = shapely.Polygon(ring)
    for outline, start in holes:
        taken = np.array(outline, float)
        taken[:, 0] = np.minimum(taken[:, 0] + start, last + behind)
        taken = np.array(beyond_borders(taken.tolist(), width - 1e-9, 2.0 * behind))
        area = area.difference(
            shapely.make_valid(shapely.Polygon(bend_ring(taken, track.radius, chord=MAX_SAGITTA_M)))
        )
    frame = np.array([[0.0, 0.0, level], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    return frame, depth, TRACK_FRICTION, rings(area, lambda a, b: drawn_end(a, b, track.radius, ends))


def _arc(places, across, radius) -> np.ndarray:
    """Points (K, 2) [m] at lengths along the wall and one distance from it, in the bowl's frame."""
    theta, off = places / radius, radius - across
    return np.column_stack([off * np.sin(theta), radius - off * np.cos(theta)])


def drawn_end(a, b, radius, ends):
    """Return whether a border from a (2,) to b (2,) [m] ends the drawing: behind the wall, or at an end."""
    near = 1e-6 * radius
    off = [np.hypot(x, radius - y) for x, y in (a, b)]
    place = [radius * np.arctan2(x, radius - y) for x, y in (a, b)]
    return min(off) > radius + near or max(place) < ends[0] + near or min(place) > ends[1] - near


def _blade(blade, track, start, size, level) -> tuple[Any, ...]:
    """A blade as a plate seen by the part that arrives: along its face from the foot, and upwards.

    It goes on into wall and track where it reaches them: a corner that touches either does not slip past it.
    """
    behind = DRAWN_BEHIND_WALL * size
    at_wall = blade.foot[1] <= 0.0
    solid = _onwards(blade.solid, behind, at_wall)
    theta = (start + blade.foot[0]) / track.radius
    ahead = np.array([np.cos(theta), np.sin(theta), 0.0])
    inwards = np.array([-ahead[1], ahead[0], 0.0])
    origin = np.array([0.0, track.radius, level]) - (track.radius - blade.foot[1]) * inwards
    along = np.cos(blade.heading) * ahead + np.sin(blade.heading) * inwards
    front = np.array([-along[1], along[0], 0.0])  # against the part that arrives
    frame = np.array([origin, along, [0.0, 0.0, 1.0], front])
    own = TRACK_FRICTION if blade.friction is None else blade.friction
    near = 0.0 if at_wall else -np.inf
    borders = rings(solid, lambda a, b: max(a[0], b[0]) <= near or max(a[1], b[1]) <= 0.0)
    return frame, blade.thickness, own, borders


def _onwards(solid, behind, at_wall):
    """What is solid of a blade, going on into the wall and into the track where it reaches them."""
    areas = [solid]
    if at_wall:
        at_edge = shapely.get_parts(
            solid.intersection(shapely.box(0.0, -BEYOND_OPENINGS_M, SMOOTHING_M, BEYOND_OPENINGS_M))
        )
        areas += [shapely.box(-behind, low, SMOOTHING_M, high) for _, low, _, high in shapely.bounds(at_edge)]
        solid = shapely.union_all(areas)
    under = shapely.get_parts(
        solid.intersection(shapely.box(-BEYOND_OPENINGS_M, 0.0, BEYOND_OPENINGS_M, SMOOTHING_M))
    )
    areas += [shapely.box(near, -behind, far, SMOOTHING_M) for near, _, far, _ in shapely.bounds(under)]
    return shapely.union_all(areas)


def rings(area, is_end):
    """Return borders (B, 10) [m] of a solid area, columns as the fields of BORDER but for the last two.

    Parameters
    ----------
    area : shapely geometry
    is_end : function
        Of both ends (2,) of a border: whether what is drawn ends there, not what is solid.
    """
    borders: list[Any] = []
    for polygon in shapely.get_parts(shapely.simplify(area, SMOOTHING_M)):
        if polygon.geom_type != "Polygon" or polygon.area <= 0.0:
            continue
        polygon = shapely.geometry.polygon.orient(polygon)  # the solid on the left
        for ring in (polygon.exterior, *polygon.interiors):
            points = np.asarray(ring.coords)[:-1, :2]
            borders += _ring(points, is_end)
    return np.array(borders).reshape(-1, 10)


def _ring(points, is_end) -> Iterator[Any]:
    after, before = np.roll(points, -1, axis=0), np.roll(points, 1, axis=0)
    for p, q, o in zip(points, after, before):
        along, came = q - p, p - o
        size = np.hypot(*along)
        bend = np.arctan2(came[0] * along[1] - came[1] * along[0], came[0] * along[0] + came[1] * along[1])
        end = is_end(p, q)
        corner = bend > CORNER_ANGLE and not end and not is_end(o, p)
        before = np.array([came[1], -came[0]]) / np.hypot(*came)
        yield [*p, *q, along[1] / size, -along[0] / size, float(corner), float(end), *before]


def stacked(plates) -> tuple[np.recarray, np.recarray]:
    """Return plates (P,) as records with boxes around their borders, and all of these (B,) in a row."""
    rows, first = [], 0
    for frame, depth, friction, borders in plates:
        last = first + len(borders)
        box = [end for k in (0, 1) for end in (borders[:, k:4:2].min(), borders[:, k:4:2].max())]
        rows.append((*frame.ravel(), depth, CUT_BORDER_RADIUS_M, first, last, friction, *box))
        first = last
    return frozen_rows(rows, PLATE_RECORD), frozen_rows(
        [(*row, 0.0, 0.0) for *_, borders in plates for row in borders], BORDER
    )
