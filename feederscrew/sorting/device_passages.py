"""Parts where their margin at a device is least, as pictures show them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import cast

import numpy as np
import shapely

from feederscrew.base.arrays import Points
from feederscrew.bowl.devices.base import Device, Verdict, opening_at
from feederscrew.bowl.devices.features import TrackOpening
from feederscrew.bowl.devices.openings import hole_edges, through_the_wall
from feederscrew.bowl.devices.trade import Action
from feederscrew.sorting import footprints
from feederscrew.sorting.fates import stand_astride
from feederscrew.sorting.orientations import Orientation, hang
from feederscrew.sorting.tooled_track import PlacedDevice, bend_ring
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

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
    outline: Points  # (J, 2) [m] of the part from above
    foot: shapely.Geometry  # [m] what touches the whole track
    hole: shapely.Geometry | None  # [m] what is cut away
    supported: Points  # (K, 2) [m] hull of what still touches
    weight: tuple[float, float]  # [m] where the weight meets the track
    plate: shapely.Geometry | None  # [m] of blades and gates, in distances from the wall and heights

    def angle(self, placed: PlacedDevice) -> float:
        """Return where the part is on a tooled track, from the tangent at its datum.

        Parameters
        ----------
        placed : PlacedDevice
            Of the passage's device.

        Returns
        -------
        float [rad]
            At a gate that it does not pass, where it touches the gate.
        """
        orientation, radius = self.orientation, self.orientation.track.radius
        if placed.footprints and self.verdict.passes <= 0.0:
            ahead, from_wall = self.outline.T
            blade = min(float(ring[:, 0].min()) for ring in placed.footprints) / radius
            return blade - np.arctan2(ahead, radius - from_wall).max()  # it touches it
        shift = _hole_shift(next(iter(placed.features.openings), None), orientation)
        if shift is not None:
            return placed.begin / radius - shift
        return (placed.start + 0.5 * placed.length) / radius


def worst_passage(device: Device, orientation: Orientation, orientations: Sequence[Orientation]) -> Passage:
    """Return an orientation at the place of a device where its margin is least.

    Parameters
    ----------
    device : Device
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part: a device may name any.

    Returns
    -------
    Passage
    """
    outcome = verdict(device, orientation, orientations)
    touching, weight = foot_area(orientation), (0.0, orientation.distance - orientation.shift)
    features = device.features(orientation.track, orientations)
    opening = opening_at(device, orientation)
    holes = [_hole(opening, orientation, turn) for turn in (0.0, -EDGE_OFFSET_RAD, EDGE_OFFSET_RAD)]
    hulls = [(touching if cut is None else touching.difference(cut)).convex_hull for cut in holes]
    point = shapely.Point(weight)
    within = [h.boundary.distance(point) if h.contains(point) else -h.distance(point) for h in hulls]
    worst = int(np.argmin(within))
    if outcome.onto:  # most parts go on so
        after = device.onward(orientations[max(outcome.onto, key=lambda place: place[1])[0]])
    elif outcome.lands is not None:
        after = device.onward(cast(Orientation, outcome.lands))
    elif outcome.hangs:
        after = hang(orientation, device.span)
    else:
        rails = device.action is Action.HANG and outcome.passes > 0.0
        after = stand_astride(orientation, device.span) if rails else device.onward(orientation)
    plates = [blade.view_ahead for blade in features.blades]
    return Passage(
        device=device,
        orientation=orientation,
        verdict=outcome,
        fate=device.fate(DeviceEncounter(orientation, orientations)),
        after=after,
        picture=features.seen_from,
        outline=np.add(orientation.outline, [0.0, orientation.distance]),
        foot=touching,
        hole=holes[worst],
        supported=shapely.get_coordinates(hulls[worst]),
        weight=weight,
        plate=shapely.union_all(plates) if plates else None,
    )


def foot_area(orientation: Orientation) -> shapely.Geometry:
    """Return the footprint of an orientation as an area with lines and points, from the wall.

    Parameters
    ----------
    orientation : Orientation

    Returns
    -------
    shapely geometry [m]
    """
    up = [0.0, orientation.distance]
    areas = [shapely.Polygon(ring + up) for ring in orientation.foot.rings]
    parts = [reduce(shapely.symmetric_difference, areas)] if areas else []
    parts += [shapely.LineString(edge + up) for edge in orientation.foot.edges]
    parts += [shapely.Point(point + up) for point in orientation.foot.points]
    return shapely.union_all(parts)


def passage_fate(orientation: Orientation, passages: Sequence[Passage]) -> str:
    """Return in words what becomes of an orientation at the end of its passages.

    Parameters
    ----------
    orientation : Orientation
        As it came.
    passages : sequence of Passage
        None of which returned it.

    Returns
    -------
    str
        'leaves', 'leaves as B@90', 'tips over on the track'.
    """
    last = passages[-1].after if passages else orientation
    if last.returned:
        return "falls off the track" if last.falls_off else "tips over on the track"
    if last.kind == "hanging":
        return f"leaves {last.name}"
    return "leaves" if last.name == orientation.name else f"leaves as {last.name}"


def until_returned(
    devices: Sequence[Device], orientation: Orientation, orientations: Sequence[Orientation]
) -> list[Passage]:
    """Return the passages of an orientation, as most parts go on, up to the device that returns it.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part.

    Returns
    -------
    list of Passage
        Empty for an orientation that the bare track does not carry.
    """
    passages = []
    for device in () if orientation.returned else devices:
        passages.append(worst_passage(device, orientation, orientations))
        orientation = passages[-1].after
        if passages[-1].verdict.passes <= 0.0 or orientation.returned:
            break
    return passages


def _hole_shift(opening: TrackOpening | None, orientation: Orientation) -> float | None:
    """By how much [rad] a hole with an edge across the track is ahead of the part, where least holds it."""
    hole = hole_edges(opening, orientation.track)
    return None if hole is None else footprints.least(orientation.axial_foot, hole)[1]


def _hole(opening: TrackOpening | None, orientation: Orientation, turn: float) -> shapely.Geometry | None:
    """Return the hole of a device where the margin is least, about the radial line of the foot."""
    if opening is None:
        return None
    track, length = orientation.track, SHOWN_HOLE_LENGTHS * orientation.length
    ring, shift = opening.lasting(length).ring, _hole_shift(opening, orientation)
    shift = -0.5 * length / track.radius if shift is None else shift + turn
    ring = bend_ring(np.array(through_the_wall(ring.tolist())), track.radius, shift, PASSAGE_CHORD_M)
    return shapely.make_valid(shapely.Polygon(ring))
