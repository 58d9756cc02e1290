"""What stands along the track as solid plates with borders in the bowl's own frame."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from feederscrew import check
from feederscrew.tooling.devices.openings import beyond_borders
from feederscrew.tooling.orientations import CUT_BORDER_RADIUS_M
from feederscrew.tooling.track_sections import bend_ring
from feederscrew.trial import air
from feederscrew.trial.air import Air

BEHIND = 0.5  # of the part's size: how far the track is drawn behind the wall
CHORD = 5e-6  # [m] by which an arc may be seen too flat
SMOOTH = 2e-6  # [m] corners of a border that stand out by less are left out
CORNER = 1e-4  # [rad] a border that turns by less has no corner
SPARE = 0.1  # of the part's size: how far before a device parts begin, and behind it they end
BEFORE, AFTER = 1.2, 0.8  # of the part's size: track before where parts begin and behind where they end
FAR = 10.0  # [m] beyond any opening
THICK = 4e-3  # [m] of the track: deeper down its sides hold nothing
OWN = np.nan  # friction of a plate that has that of the track


@dataclass(frozen=True, eq=False)
class Stage:
    """One device, or a stretch of the bare track, as solid geometry in the bowl's frame."""

    device: object  # tooling.devices.base.Device
    plates: np.ndarray  # (P, 17) [m], [1] as `trial.kernel.crowd_records` names the columns
    borders: np.ndarray  # (B, 10) [m], [1]
    begin: float  # [m] along the wall, where the part's centre of mass starts
    exit: float  # [m] where it has passed
    cut: tuple[float, float] = (np.inf, -np.inf)  # [m] along the wall, where the device begins and ends
    drop: float = 0.0  # [m] by which the track lies lower there
    aside: float = 0.0  # [m] from the wall, where a track that lies lower begins
    below: bool = False  # whether parts leave hanging, their centres of mass below the track
    air: Air = air.STILL  # what blows there, and how the track leans
    size: float = 0.0  # [m] of the part, the greatest length of its orientations
    width: float = np.inf  # [m] of the track


def size_of(every):
    """Return the greatest length [m] of orientations, in the plane of the track or across it."""
    return max(np.hypot(one.length, max(one.width, one.height)) for one in every)


def stage(device, standing, track, every, start=0.0, slopes=(), slot=()) -> Stage:
    """Return one device with enough track before and behind it.

    Parameters
    ----------
    device : Device
    standing : Standing
        What it has along the track.
    track : Track
    every : sequence of Orientation
        Of the part.
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
    size = size_of(every)
    blows = air.along([(standing, start, 0.0)], track, every)
    blows = replace(blows, slopes=(*before(slopes), *blows.slopes))
    begin, beyond = start - (0.5 + SPARE) * size, passed(standing, start, size)
    ends = begin - BEFORE * size, beyond + AFTER * size
    return Stage(
        device, *built([(standing, start, ends[1])], track, size, ends, slot), begin=begin, exit=beyond,
        cut=(start, start + standing.length), drop=standing.drop, aside=standing.aside,
        below=standing.hangs or bool(slot),
        air=blows, size=size, width=track.extent,
    )  # fmt: skip


def plain(device, track, every, length, slopes=()) -> Stage:
    """Return a stretch of the bare track, from 0 to ``length`` [m]."""
    size = size_of(every)
    bare = built((), track, size, (-BEFORE * size, length + AFTER * size))
    blows = replace(air.STILL, slopes=before(slopes))
    return Stage(device, *bare, begin=0.0, exit=length, size=size, width=track.extent, air=blows)


def before(slopes) -> tuple[Any, ...]:
    """Return slopes as they are where they began before what is drawn."""
    return tuple((-FAR, one.climb, one.bank, one.wall) for one in slopes)


def passed(standing, start, size):
    """Return where [m] along the wall a centre of mass has passed a device that begins at ``start``."""
    return start + standing.length + (standing.settles + 0.5 + SPARE) * size


def built(placed, track, size, ends, slot=()) -> tuple[np.ndarray, np.ndarray]:
    """Return plates (P, 17) and borders (B, 10) of a stretch of track with devices along it.

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
            cuts, depth = [*holes, *slots], standing.drop + THICK
            plates.append(_floor(cuts, track, size, ends, (first, last), level, depth))
            level, first, holes = level - standing.drop, start - THICK, []
    plates.append(_floor([*holes, *slots], track, size, ends, (first, ends[1]), level))
    return stacked([*plates, *blades])


def _slots(placed, size, ends, slot):
    """Slots between rails (outline, start) that go on to the next rails, or to the end of what is drawn.

    Those of ``placed`` are cut themselves; one of rails before them begins where the drawing does.
    """
    made, begin = [], ends[0] - BEHIND * size
    for standing, start, _ in placed:
        if standing.slot:
            made += [_rectangle(begin, start + SMOOTH, slot)] if slot else []
            begin = start + max(hole.outline[:, 0].max() for hole in standing.holes) - SMOOTH
            slot = standing.slot
    return [*made, _rectangle(begin, ends[1] + BEHIND * size, slot)] if slot and begin < ends[1] else made


def _rectangle(begin, end, span) -> tuple[Any, ...]:
    """A hole between two places along the wall and two distances from it: its outline, from the place 0."""
    low, high = span
    return np.array([[begin, low], [end, low], [end, high], [begin, high]]), 0.0


def _up_to_rails(placed, k) -> Iterator[Any]:
    """Outlines (K, 2) [m] of the holes of the k-th device; its slot ends where other rails begin."""
    standing, start, _ = placed[k]
    ends = [begin for other, begin, _ in placed[k + 1 :] if other.slot] if standing.slot else []
    far = ends[0] - start + SMOOTH if ends else np.inf
    for hole in standing.holes:
        yield np.column_stack([np.minimum(hole.outline[:, 0], far), hole.outline[:, 1]])


def _floor(holes, track, size, ends, own, level, depth=THICK) -> tuple[Any, ...]:
    """A level surface: a sector about the bowl's axis between two places, without the holes."""
    behind, width = BEHIND * size, track.extent
    first, last = own
    length = last - first
    coarse = np.linspace(first, last, max(int(length / behind), 2) + 1)  # nothing comes there
    fine = np.linspace(first, last, int(length / np.sqrt(8.0 * track.radius * CHORD)) + 2)[::-1]
    ring = np.vstack([_arc(coarse, -behind, track.radius), _arc(fine, width, track.radius)])
    area = shapely.Polygon(ring)
    for outline, start in holes:
        taken = np.array(outline, float)
        taken[:, 0] = np.minimum(taken[:, 0] + start, last + behind)
        taken = np.array(beyond_borders(taken.tolist(), width - 1e-9, 2.0 * behind))
        area = area.difference(
            shapely.make_valid(shapely.Polygon(bend_ring(taken, track.radius, chord=CHORD)))
        )
    frame = np.array([[0.0, 0.0, level], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    return frame, depth, OWN, rings(area, lambda a, b: drawn_end(a, b, track.radius, ends))


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
    behind = BEHIND * size
    at_wall = blade.foot[1] <= 0.0
    solid = _onwards(blade.solid, behind, at_wall)
    theta = (start + blade.foot[0]) / track.radius
    ahead = np.array([np.cos(theta), np.sin(theta), 0.0])
    inwards = np.array([-ahead[1], ahead[0], 0.0])
    origin = np.array([0.0, track.radius, level]) - (track.radius - blade.foot[1]) * inwards
    along = np.cos(blade.heading) * ahead + np.sin(blade.heading) * inwards
    front = np.array([-along[1], along[0], 0.0])  # against the part that arrives
    frame = np.array([origin, along, [0.0, 0.0, 1.0], front])
    own = OWN if blade.friction is None else blade.friction
    near = 0.0 if at_wall else -np.inf
    borders = rings(solid, lambda a, b: max(a[0], b[0]) <= near or max(a[1], b[1]) <= 0.0)
    return frame, blade.thickness, own, borders


def _onwards(solid, behind, at_wall):
    """What is solid of a blade, going on into the wall and into the track where it reaches them."""
    made = [solid]
    if at_wall:
        beside = shapely.get_parts(solid.intersection(shapely.box(0.0, -FAR, SMOOTH, FAR)))
        made += [shapely.box(-behind, low, SMOOTH, high) for _, low, _, high in shapely.bounds(beside)]
        solid = shapely.union_all(made)
    under = shapely.get_parts(solid.intersection(shapely.box(-FAR, 0.0, FAR, SMOOTH)))
    made += [shapely.box(near, -behind, far, SMOOTH) for near, _, far, _ in shapely.bounds(under)]
    return shapely.union_all(made)


def rings(area, is_end):
    """Return borders (B, 10) [m] of a solid area.

    Start, end, normal away, corner, end of drawing, normal before.

    Parameters
    ----------
    area : shapely geometry
    is_end : function
        Of both ends (2,) of a border: whether what is drawn ends there, not what is solid.
    """
    found: list[Any] = []
    for one in shapely.get_parts(shapely.simplify(area, SMOOTH)):
        if one.geom_type != "Polygon" or one.area <= 0.0:
            continue
        one = shapely.geometry.polygon.orient(one)  # the solid on the left
        for ring in (one.exterior, *one.interiors):
            points = np.asarray(ring.coords)[:-1, :2]
            found += _ring(points, is_end)
    return np.array(found).reshape(-1, 10)


def _ring(points, is_end) -> Iterator[Any]:
    after, before = np.roll(points, -1, axis=0), np.roll(points, 1, axis=0)
    for p, q, o in zip(points, after, before):
        along, came = q - p, p - o
        size = np.hypot(*along)
        bend = np.arctan2(came[0] * along[1] - came[1] * along[0], came[0] * along[0] + came[1] * along[1])
        end = is_end(p, q)
        corner = bend > CORNER and not end and not is_end(o, p)
        before = np.array([came[1], -came[0]]) / np.hypot(*came)
        yield [*p, *q, along[1] / size, -along[0] / size, float(corner), float(end), *before]


def stacked(plates) -> tuple[Any, ...]:
    """Return plates as rows (P, 17), and all borders (B, 10) one below the other."""
    rows, first = [], 0
    for frame, depth, friction, borders in plates:
        last = first + len(borders)
        rows.append([*frame.ravel(), depth, CUT_BORDER_RADIUS_M, first, last, friction])
        first = last
    borders = np.concatenate([borders for *_, borders in plates])
    return check.frozen(np.array(rows, float)), check.frozen(borders)
