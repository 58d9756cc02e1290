"""What a part meets at each device, as plates with borders in the bowl's own frame."""

from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew import check
from feederscrew.bowl.devices import KINDS, Device
from feederscrew.tooling import turning
from feederscrew.tooling.orientations import ROUNDED
from feederscrew.tooling.strip import BLADE, FRAME, bent, hole, opening
from feederscrew.trial.kernel import search

BEHIND = 0.5  # of the part's size: how far the track is drawn behind the wall
CHORD = 5e-6  # [m] by which an arc may be seen too flat
SMOOTH = 2e-6  # [m] corners of a border that stand out by less are left out
CORNER = 1e-4  # [rad] a border that turns by less has no corner
SETTLES = 2.0  # of the part's size: how far behind a turning device parts end
SPARE = 0.1  # of the part's size: how far before a device parts begin, and behind it they end
FAR = 10.0  # [m] beyond any opening
THICK = 4e-3  # [m] of the track: deeper down its sides hold nothing
BARE = Device("track", "")


@dataclass(frozen=True, eq=False)
class Stage:
    """One device, or a stretch of the bare track, as solid geometry in the bowl's frame."""

    device: Device
    plates: np.ndarray  # (P, 16) [m], [1] as `trial.kernel.search` names the columns
    borders: np.ndarray  # (B, 10) [m], [1]
    begin: float  # [m] along the wall, where the part's centre of mass starts
    exit: float  # [m] where it has passed
    drop: float = 0.0  # [m] by which the track lies lower there
    aside: float = 0.0  # [m] from the wall, where a track that lies lower begins
    below: bool = False  # whether parts leave hanging, their centres of mass below the track


def station(device, track, every, start=0.0):
    """Return one device with enough track before and behind it.

    Parameters
    ----------
    device : Device
        A measured yield is bare track.
    track : Track
    every : sequence of Orientation
        Of the part, the longest of which sets how long a device is that goes on along the track.
    start : float [m]
        Where the cut begins.

    Returns
    -------
    Stage
    """
    if KINDS[device.kind].turns:
        return _turning(device, track, every, start)
    size = max(np.hypot(one.length, max(one.width, one.height)) for one in every)
    room = 1.3 * max(one.length for one in every)
    width = min(track.width, 0.95 * track.radius)
    cut = None if device.kind == "yield" else hole(device, track.radius, room, width)
    last = start + (room if cut is None else float(cut[:, 0].max()))
    hangs = device.kind == "rails"
    if hangs:  # those that hang are led on, they do not come back onto the track
        cut = hole(device, track.radius, room + 2.0 * size, width)
    begin, beyond = start - (0.5 + SPARE) * size, last + (0.5 + SPARE) * size
    ends = begin - 1.2 * size, beyond + 0.8 * size
    plates = [_track_plate(cut, track, width, size, ends, start)]
    gate = None if device.kind == "yield" else opening(device, every, width)
    if gate is not None:
        middle = start + 0.5 * room
        plates.append(_gate_plate(gate, track, width, every, middle, BEHIND * size))
        beyond = middle + (0.5 + SPARE) * size
    return Stage(device, *_stacked(plates), begin=begin, exit=beyond, below=hangs)


def _turning(device, track, every, start):
    """A step, or a ledge over a second track that lies half the part's greatest length lower.

    Parts that were turned have twice their size behind it to come to lie against the wall.
    """
    size = max(np.hypot(one.length, max(one.width, one.height)) for one in every)
    width = min(track.width, 0.95 * track.radius)
    begin, beyond = start - (0.5 + SPARE) * size, start + (SETTLES + 0.5 + SPARE) * size
    ends = begin - 1.2 * size, beyond + 0.8 * size
    if device.kind == "step":
        drop, aside = device.limit, 0.0
        cut = [[start, 0.0], [ends[1], 0.0], [ends[1], width], [start, width]]
    else:
        drop, aside = turning.below_ledge(every), device.limit
        cut = [[start, aside], [ends[1], aside], [ends[1], width], [start, width]]
    upper = _track_plate(np.array(cut), track, width, size, ends, 0.0, depth=drop + THICK)
    lower = _track_plate(None, track, width, size, (start - THICK, ends[1]), 0.0, level=-drop)
    return Stage(device, *_stacked([upper, lower]), begin=begin, exit=beyond, drop=drop, aside=aside)


def plain(track, every, length):
    """Return a stretch of the bare track, from 0 to ``length`` [m]."""
    size = max(np.hypot(one.length, max(one.width, one.height)) for one in every)
    width = min(track.width, 0.95 * track.radius)
    plate = _track_plate(None, track, width, size, (-1.2 * size, length + 0.8 * size), 0.0)
    return Stage(BARE, *_stacked([plate]), begin=0.0, exit=length)


def _track_plate(cut, track, width, size, ends, start, level=0.0, depth=THICK):
    """The track's surface at a level: a sector about the bowl's axis without the hole."""
    behind = BEHIND * size
    coarse = np.linspace(*ends, max(int((ends[1] - ends[0]) / behind), 2) + 1)  # nothing comes there
    fine = np.linspace(*ends, int((ends[1] - ends[0]) / np.sqrt(8.0 * track.radius * CHORD)) + 2)[::-1]
    ring = np.vstack([_arc(coarse, -behind, track.radius), _arc(fine, width, track.radius)])
    area = shapely.Polygon(ring)
    if cut is not None:
        taken = np.array(cut, float)
        taken[:, 0] += start
        taken[:, 1] = np.where(taken[:, 1] <= 0.0, -2.0 * behind, taken[:, 1])
        taken[:, 1] = np.where(taken[:, 1] >= width - 1e-9, width + behind, taken[:, 1])
        area = area.difference(shapely.make_valid(shapely.Polygon(bent(taken, track.radius, chord=CHORD))))
    frame = np.array([[0.0, 0.0, level], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    return frame, depth, _rings(area, lambda a, b: _drawn_end(a, b, track.radius, ends))


def _arc(places, across, radius):
    """Points (K, 2) [m] at lengths along the wall and one distance from it, in the bowl's frame."""
    theta, off = places / radius, radius - across
    return np.column_stack([off * np.sin(theta), radius - off * np.cos(theta)])


def _drawn_end(a, b, radius, ends):
    """Whether a border is where the drawing ends: behind the wall, or at either end of the stretch."""
    near = 1e-6 * radius
    off = [np.hypot(x, radius - y) for x, y in (a, b)]
    place = [radius * np.arctan2(x, radius - y) for x, y in (a, b)]
    return min(off) > radius + near or max(place) < ends[0] + near or min(place) > ends[1] - near


def _gate_plate(gate, track, width, every, middle, behind):
    """A gate across the track as wide as that, seen by the part that arrives: from the wall, and upwards.

    It goes on into wall and track: a corner that touches either does not slip past the gate's end.
    """
    tall = 2.0 * max(max(one.height for one in every), gate.bounds[3]) + FRAME
    solid = shapely.box(-behind, -behind, width, tall).difference(_onwards(gate, behind))
    theta = middle / track.radius
    c, s = np.cos(theta), np.sin(theta)
    origin = [track.radius * s, track.radius * (1.0 - c), 0.0]
    frame = np.array([origin, [-s, c, 0.0], [0.0, 0.0, 1.0], [-c, -s, 0.0]])
    return frame, BLADE, _rings(solid, lambda a, b: max(a[0], b[0]) <= 0.0 or max(a[1], b[1]) <= 0.0)


def _onwards(gate, behind):
    """An opening that goes on into the wall and into the track where it reaches them."""
    beside = shapely.bounds(shapely.get_parts(gate.intersection(shapely.box(0.0, 0.0, SMOOTH, FAR))))
    gate = shapely.union_all([gate, *(shapely.box(-behind, low, SMOOTH, high) for _, low, _, high in beside)])
    under = shapely.bounds(shapely.get_parts(gate.intersection(shapely.box(-behind, 0.0, FAR, SMOOTH))))
    return shapely.union_all([gate, *(shapely.box(near, -behind, far, SMOOTH) for near, _, far, _ in under)])


def _rings(area, is_end):
    """Borders (B, 10) of a solid area: start, end, normal away, corner, end of drawing, normal before it."""
    found = []
    for one in shapely.get_parts(shapely.simplify(area, SMOOTH)):
        if one.geom_type != "Polygon" or one.area <= 0.0:
            continue
        one = shapely.geometry.polygon.orient(one)  # the solid on the left
        for ring in (one.exterior, *one.interiors):
            points = np.asarray(ring.coords)[:-1, :2]
            found += _ring(points, is_end)
    return np.array(found).reshape(-1, 10)


def _ring(points, is_end):
    after, before = np.roll(points, -1, axis=0), np.roll(points, 1, axis=0)
    for p, q, o in zip(points, after, before):
        along, came = q - p, p - o
        size = np.hypot(*along)
        bend = np.arctan2(came[0] * along[1] - came[1] * along[0], came[0] * along[0] + came[1] * along[1])
        end = is_end(p, q)
        corner = bend > CORNER and not end and not is_end(o, p)
        before = np.array([came[1], -came[0]]) / np.hypot(*came)
        yield [*p, *q, along[1] / size, -along[0] / size, float(corner), float(end), *before]


def with_backs(plates):
    """Return rows (2 P, 17) of plates (P, 16), each with that of its back, seen from behind, after it."""
    backs = np.array(plates)
    front = backs[:, search.FRONT : search.DEPTH]
    backs[:, search.ORIGIN : search.ACROSS] -= backs[:, [search.DEPTH]] * front
    front *= -1.0
    both = np.stack([plates, backs], axis=1).reshape(-1, plates.shape[1])
    return np.column_stack([both, np.resize([0.0, 1.0], len(both))])


def _stacked(plates):
    """Plates as rows, and all borders one below the other."""
    rows, first = [], 0
    for frame, depth, borders in plates:
        last = first + len(borders)
        rows.append([*frame.ravel(), depth, ROUNDED, first, last])
        first = last
    borders = np.concatenate([borders for _, _, borders in plates])
    return check.frozen(np.array(rows, float)), check.frozen(borders)
