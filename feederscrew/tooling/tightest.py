"""Orientations at the place of a device where their margin is least."""

from dataclasses import dataclass
from functools import reduce

import numpy as np
import shapely

from feederscrew.tooling import foot as feet
from feederscrew.tooling.devices.base import Device, Verdict
from feederscrew.tooling.devices.hole_shapes import through_the_wall
from feederscrew.tooling.fates import astride
from feederscrew.tooling.hanging import hung
from feederscrew.tooling.orientations import Orientation
from feederscrew.tooling.strip import bent
from feederscrew.tooling.verdicts import Meeting, verdict

PASSAGE_CHORD_M = 1e-7  # [m] by which an arc may be seen too flat
EDGE_OFFSET_RAD = 3e-6  # [rad] to either side of a place where an edge of the hole meets a corner of the foot
SHOWN_HOLE_LENGTHS = 3.0  # lengths of the part: how far a device that goes on along the track is shown


@dataclass(frozen=True, eq=False)
class Passage:
    """One orientation at the worst place of one device; lengths ahead and distances from the wall."""

    device: Device
    orientation: Orientation
    verdict: Verdict
    fate: str  # what becomes of what it does not let pass: 'returned' or 'stopped'
    after: Orientation  # that most parts go on in
    picture: str  # 'above', 'ahead', 'side', 'turned' or '': from where it is seen
    outline: np.ndarray  # (J, 2) [m] of the part from above
    foot: shapely.Geometry  # [m] what touches the whole track
    hole: shapely.Geometry | None  # [m] what is cut away
    supported: np.ndarray  # (K, 2) [m] hull of what still touches
    weight: tuple[float, float]  # [m] where the weight meets the track
    opening: shapely.Geometry | None  # [m] of a gate, in distances from the wall and heights

    def angle(self, station):
        """Return where the part then is on a track section [rad]: from the wall's tangent at its start.

        Parameters
        ----------
        station : Station
            Of this device.
        """
        one, radius = self.orientation, self.orientation.track.radius
        if station.blade is not None and self.verdict.passes <= 0.0:
            ahead, from_wall = self.outline.T
            blade = station.blade[:, 0].min() / radius
            return blade - np.arctan2(ahead, radius - from_wall).max()  # it touches it
        if self.device.hole_on(one.track) is not None:
            return station.start / radius - _shift(self.device, one)
        return (station.start + 0.5 * station.length) / radius


def passage(device, one, every, known=()):
    """Return an orientation at the place of a device where its margin is least.

    Parameters
    ----------
    device : Device
    one : Orientation
    every : sequence of Orientation
        Of the part, which a profile may name.
    known : sequence of Hanging
        What hangs already.

    Returns
    -------
    Passage
    """
    found = verdict(device, one, every)
    touching, weight = foot(one), (0.0, one.distance - one.shift)
    holes = [_hole(device, one, by) for by in (0.0, -EDGE_OFFSET_RAD, EDGE_OFFSET_RAD)]
    hulls = [(touching if cut is None else touching.difference(cut)).convex_hull for cut in holes]
    worst = int(np.argmin([_within(hull, weight) for hull in hulls]))
    return Passage(
        device=device,
        orientation=one,
        verdict=found,
        fate=device.fate(Meeting(one, every)),
        after=_after(device, one, found, every, known),
        picture=device.picture,
        outline=np.add(one.outline, [0.0, one.distance]),
        foot=touching,
        hole=holes[worst],
        supported=shapely.get_coordinates(hulls[worst]),
        weight=weight,
        opening=device.opening(every, one.track.width),
    )


def foot(one):
    """Return what of an orientation touches the track, as a shapely geometry from the wall [m]."""
    up = [0.0, one.distance]
    areas = [shapely.Polygon(ring + up) for ring in one.foot.rings]
    parts = [reduce(shapely.symmetric_difference, areas)] if areas else []
    parts += [shapely.LineString(edge + up) for edge in one.foot.edges]
    parts += [shapely.Point(point + up) for point in one.foot.points]
    return shapely.union_all(parts)


def _within(hull, weight):
    """How far [m] a point lies inside a hull, negative: outside."""
    point = shapely.Point(weight)
    return hull.boundary.distance(point) if hull.contains(point) else -hull.distance(point)


def fate(one, met):
    """Return in words what becomes of an orientation at the end of its passages.

    Parameters
    ----------
    one : Orientation
        As it comes.
    met : sequence of Passage
        None of which returned it.

    Returns
    -------
    str
    """
    last = met[-1].after if met else one
    if last.returned:
        return "falls off the track" if last.falls_off else "tips over on the track"
    if last.kind == "hanging":
        return f"leaves {last.name}"
    return "leaves" if last.name == one.name else f"leaves as {last.name}"


def _after(device, one, found, every, known):
    """The orientation in which most parts go on from a device."""
    if found.onto:
        return device.onward(every[max(found.onto, key=lambda place: place[1])[0]])
    if found.hangs:
        return hung(one, device.span, known)
    return astride(one, device.span) if device.hangs and found.passes > 0.0 else device.onward(one)


def until_returned(devices, one, every):
    """Return the passages of an orientation, as most parts go on, up to the device that returns it.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    one : Orientation
    every : sequence of Orientation

    Returns
    -------
    list of Passage
        None of one that the bare track does not carry.
    """
    found = []
    for device in () if one.returned else devices:
        found.append(passage(device, one, every))
        one = found[-1].after
        if found[-1].verdict.passes <= 0.0 or one.returned:
            break
    return found


def _shift(device, one):
    """By how much [rad] a hole with an edge across the track is ahead of the part where it bears least."""
    hole = device.hole_on(one.track)
    return None if hole is None else feet.least(one.standing, hole)[1]


def _hole(device, one, by):
    """What a device cuts away where the margin is least, about the radial line of the foot."""
    track, length = one.track, SHOWN_HOLE_LENGTHS * one.length
    ring, shift = device.outline_on(track, length), _shift(device, one)
    if ring is None:
        return None
    shift = -0.5 * length / track.radius if shift is None else shift + by
    ring = bent(np.array(through_the_wall(ring.tolist())), track.radius, shift, PASSAGE_CHORD_M)
    return shapely.make_valid(shapely.Polygon(ring))
