"""A stretch of track with devices on it, as it is drawn and made, and parts where their margin is least."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import reduce

import numpy as np
import shapely

from feederscrew.arrays import Points
from feederscrew.bowl.record import Track
from feederscrew.tooling import footprints
from feederscrew.tooling.devices.base import BLADE, GATE_FRAME_M, Device, Standing, Verdict, room_of
from feederscrew.tooling.devices.openings import through_the_wall
from feederscrew.tooling.fates import leading_devices, stand_astride
from feederscrew.tooling.orientations import Orientation, hang
from feederscrew.tooling.verdicts import DeviceEncounter, verdict

DRAWN_TRACK_MARGIN_M = 5e-3  # [m] of track beyond what parts and cuts need, where not all of it is drawn
DRAWN_CHORD_M, PASSAGE_CHORD_M = 1e-5, 1e-7  # [m] by which an arc may be seen too flat
EDGE_OFFSET_RAD = 3e-6  # [rad] to either side of a place where an edge of the hole meets a corner of the foot
SLOT_OVERLAP_M = 2e-6  # [m] by which a slot reaches into that of the next rails: no web is left between them
SHOWN_HOLE_LENGTHS = 3.0  # lengths of the part: how far a device that goes on along the track is shown


@dataclass(frozen=True, eq=False)
class Station:
    """One device at its place along the track."""

    device: Device
    start: float  # [m] along the wall
    length: float  # [m]
    # (K, 2) [m] the cut, unrolled: length along the wall, distance from it. A slot in which parts hang goes
    # on to the next rails or, open at the outlet, to the end of the section.
    hole: Points | None
    blade: Points | None  # (4, 2) [m] where a gate stands, unrolled
    openings: tuple[Points, ...]  # (K, 2) [m] of a gate: distance from the wall, height
    top: float  # [m] height of a gate
    drop: float = 0.0  # [m] by which the track goes on lower, from the middle of its length
    edge: Points | None = None  # (4, 2) [m] where parts turn over, unrolled: a step's or a ledge's edge
    wall: float | None = None  # [rad] by which the wall leans back from there on; None: as before
    standing: Standing = field(default_factory=Standing)  # nozzles, a sensor, slopes, from its start on

    @property
    def label(self) -> str:
        """'gap 9 mm': kind and value, the latter where it is one number."""
        return self.device.label


@dataclass(frozen=True, eq=False)
class TrackSection:
    """The stretch of track, unrolled: X ahead along the wall, Y from the wall."""

    track: Track
    length: float  # [m] along the wall
    width: float  # [m] of it that is drawn
    tallest: float  # [m] of all orientations
    stations: tuple[Station, ...]

    @property
    def walls(self) -> list[tuple[float, float, float]]:
        """Stretches of the wall, (from, to, lean) [m, m, rad]; a groove listed first begins at the entry."""
        first = leading_devices([station.device for station in self.stations])
        turns = [
            (0.0 if place < len(first) else station.start, station.wall)
            for place, station in enumerate(self.stations)
            if station.wall is not None
        ]
        ends = [(0.0, 0.0), *turns, (self.length, 0.0)]
        return [(begin, end, lean) for (begin, lean), (end, _) in itertools.pairwise(ends) if end > begin]

    def bent(self, ring: Points) -> Points:
        """Return a ring (K, 2) [m] as it lies in the bowl, as ``bend_ring`` does."""
        return bend_ring(ring, self.track.radius)

    def outline_in_bowl(self, outline: Points, place: float) -> Points:
        """Return an outline (K, 2) [m] from the wall as it lies in the bowl at a length along it."""
        c, s = np.cos(place / self.track.radius), np.sin(place / self.track.radius)
        x, up = outline[:, 0], self.track.radius - outline[:, 1]
        return np.column_stack([c * x + s * up, self.track.radius + s * x - c * up])


def build_section(
    track: Track, devices: Sequence[Device], orientations: Sequence[Orientation], lead: float = 0.5
) -> TrackSection:
    """Return the stretch of track that holds a chain of devices, in the order parts meet them.

    Measured yields need no place; ``lead`` [1] are rooms, of a device each, before the first one.
    """
    placed = [device for device in devices if device.placed]
    room, width = room_of(orientations), track.width
    tallest = max(orientation.height for orientation in orientations)
    if width > track.extent:  # of a very wide one, as much as parts and cuts need
        needed = [orientation.width for orientation in orientations] + [device.across for device in placed]
        width = min(max(needed) + DRAWN_TRACK_MARGIN_M, track.extent)
    stations, start = [], lead * room
    for device in placed:
        length, blade = room + device.goes_on(width), None
        cut = device.outline_on(replace(track, width=width), length)
        lower, standing = device.lower(orientations), device.standing(track, orientations)
        slopes = [slope for slope in standing.slopes if slope.wall is not None]
        lean = (slopes[-1].wall - (slopes[-1].bank or 0.0) if slopes[-1].wall else 0.0) if slopes else None
        gate = device.opening(orientations, width)
        parts = [] if gate is None else shapely.get_parts(gate)
        if gate is not None:  # it stands in the middle of its length
            middle = start + 0.5 * length - 0.5 * device.goes_on(width)
            blade = device.footprint(middle, width, BLADE)
        rings = [np.asarray(part.exterior.coords)[:-1] for part in parts if part.geom_type == "Polygon"]
        station = Station(
            device=device,
            start=start,
            length=length,
            hole=None if cut is None else np.add(cut, [start, 0.0]),
            blade=blade,
            openings=tuple(rings),
            top=0.0 if gate is None else max(tallest, gate.bounds[3]) + GATE_FRAME_M,
            drop=lower[0] if lower[1] <= 0.0 else 0.0,
            edge=device.edge(start, length, width),
            wall=lean,
            standing=standing,
        )
        stations.append(station)
        start += length + 0.5 * room
    return TrackSection(track, start, width, tallest, tuple(_continue_slots(stations, start)))


def extend_slot(ring: Points, end: float) -> Points:
    """Return a slot (K, 2) [m] whose far end lies at another length [m] along the wall."""
    ring = ring.copy()
    ring[ring[:, 0] >= ring[:, 0].max() - 1e-9, 0] = end
    return ring


def _continue_slots(stations: Sequence[Station], length: float) -> list[Station]:
    """Stations with slots that parts hang in up to the next rails, and of the last ones to the outlet.

    A part hangs from its rails to the end of the track: a web across the slot would stop it.
    """
    continued, end = [], length
    for station in reversed(stations):
        if station.device.hangs and station.hole is not None:
            continued.append(replace(station, hole=extend_slot(station.hole, end)))
            end = float(station.hole[:, 0].min()) + SLOT_OVERLAP_M
        else:
            continued.append(station)
    return continued[::-1]


def bend_ring(ring: Points, radius: float, shift: float = 0.0, chord: float = DRAWN_CHORD_M) -> Points:
    """Return a ring (K, 2) [m], along the wall and from it, as it lies in the bowl, (N, 2) [m].

    From the point where the wall of a ``radius`` [m] is tangent to X, the bowl's axis at (0, radius); turned
    ahead by ``shift`` [rad], joined by chords by which an arc may be seen too flat by ``chord`` [m].
    """
    border = shapely.linestrings(np.vstack([ring, ring[:1]]))
    fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(8.0 * radius * chord)))[:-1]
    theta, r = fine[:, 0] / radius + shift, radius - fine[:, 1]
    return np.column_stack([r * np.sin(theta), radius - r * np.cos(theta)])


@dataclass(frozen=True, eq=False)
class Passage:
    """One orientation at the worst place of one device; lengths ahead and distances from the wall."""

    device: Device
    orientation: Orientation
    verdict: Verdict
    fate: str  # what becomes of what it does not let pass: 'returned' or 'stopped'
    after: Orientation  # that most parts go on in
    picture: str  # 'above', 'ahead', 'side', 'turned' or '': from where it is seen
    outline: Points  # (J, 2) [m] of the part from above
    foot: shapely.Geometry  # [m] what touches the whole track
    hole: shapely.Geometry | None  # [m] what is cut away
    supported: Points  # (K, 2) [m] hull of what still touches
    weight: tuple[float, float]  # [m] where the weight meets the track
    opening: shapely.Geometry | None  # [m] of a gate, in distances from the wall and heights

    def angle(self, station: Station) -> float:
        """Return where the part is on a track section [rad]: from the tangent at the start of its Station."""
        orientation, radius = self.orientation, self.orientation.track.radius
        if station.blade is not None and self.verdict.passes <= 0.0:
            ahead, from_wall = self.outline.T
            blade = station.blade[:, 0].min() / radius
            return blade - np.arctan2(ahead, radius - from_wall).max()  # it touches it
        shift = _hole_shift(self.device, orientation)
        if shift is not None:
            return station.start / radius - shift
        return (station.start + 0.5 * station.length) / radius


def worst_passage(device: Device, orientation: Orientation, orientations: Sequence[Orientation]) -> Passage:
    """Return an orientation at the place of a device where its margin is least."""
    outcome = verdict(device, orientation, orientations)
    touching, weight = foot_area(orientation), (0.0, orientation.distance - orientation.shift)
    holes = [_hole(device, orientation, turn) for turn in (0.0, -EDGE_OFFSET_RAD, EDGE_OFFSET_RAD)]
    hulls = [(touching if cut is None else touching.difference(cut)).convex_hull for cut in holes]
    point = shapely.Point(weight)
    within = [h.boundary.distance(point) if h.contains(point) else -h.distance(point) for h in hulls]
    worst = int(np.argmin(within))
    if outcome.onto:  # most parts go on so
        after = device.onward(orientations[max(outcome.onto, key=lambda place: place[1])[0]])
    elif outcome.hangs:
        after = hang(orientation, device.span)
    else:
        rails = device.hangs and outcome.passes > 0.0
        after = stand_astride(orientation, device.span) if rails else device.onward(orientation)
    return Passage(
        device=device,
        orientation=orientation,
        verdict=outcome,
        fate=device.fate(DeviceEncounter(orientation, orientations)),
        after=after,
        picture=device.picture,
        outline=np.add(orientation.outline, [0.0, orientation.distance]),
        foot=touching,
        hole=holes[worst],
        supported=shapely.get_coordinates(hulls[worst]),
        weight=weight,
        opening=device.opening(orientations, orientation.track.width),
    )


def foot_area(orientation: Orientation) -> shapely.Geometry:
    """Return what of an orientation touches the track, as a shapely geometry from the wall [m]."""
    up = [0.0, orientation.distance]
    areas = [shapely.Polygon(ring + up) for ring in orientation.foot.rings]
    parts = [reduce(shapely.symmetric_difference, areas)] if areas else []
    parts += [shapely.LineString(edge + up) for edge in orientation.foot.edges]
    parts += [shapely.Point(point + up) for point in orientation.foot.points]
    return shapely.union_all(parts)


def passage_fate(orientation: Orientation, passages: Sequence[Passage]) -> str:
    """Return in words what becomes of an orientation at the end of Passages, none of which returned it."""
    last = passages[-1].after if passages else orientation
    if last.returned:
        return "falls off the track" if last.falls_off else "tips over on the track"
    if last.kind == "hanging":
        return f"leaves {last.name}"
    return "leaves" if last.name == orientation.name else f"leaves as {last.name}"


def until_returned(
    devices: Sequence[Device], orientation: Orientation, orientations: Sequence[Orientation]
) -> list[Passage]:
    """Return the Passages of an orientation, as most parts go on, up to the device that returns it.

    None of one that the bare track does not carry.
    """
    passages = []
    for device in () if orientation.returned else devices:
        passages.append(worst_passage(device, orientation, orientations))
        orientation = passages[-1].after
        if passages[-1].verdict.passes <= 0.0 or orientation.returned:
            break
    return passages


def _hole_shift(device: Device, orientation: Orientation) -> float | None:
    """By how much [rad] a hole with an edge across the track is ahead of the part, where least holds it."""
    hole = device.hole_on(orientation.track)
    return None if hole is None else footprints.least(orientation.axial_foot, hole)[1]


def _hole(device: Device, orientation: Orientation, turn: float) -> shapely.Geometry | None:
    """What a device cuts away where the margin is least, about the radial line of the foot."""
    track, length = orientation.track, SHOWN_HOLE_LENGTHS * orientation.length
    ring, shift = device.outline_on(track, length), _hole_shift(device, orientation)
    if ring is None:
        return None
    shift = -0.5 * length / track.radius if shift is None else shift + turn
    ring = bend_ring(np.array(through_the_wall(ring.tolist())), track.radius, shift, PASSAGE_CHORD_M)
    return shapely.make_valid(shapely.Polygon(ring))
