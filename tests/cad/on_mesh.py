"""The tooled track as the trial takes it, measured on the mesh of the finished bowl and not by its plan.

The mesh is unrolled: lengths along the wall, distances from it, heights over the track. Sections of that are
the holes and the blades that parts meet.
"""

from dataclasses import replace

import numpy as np
import shapely
from shapely import affinity

from feederscrew.cad import facets, measuring
from feederscrew.sorting.fates import leading_devices

MM = facets.MM
UNDER = 3e-4  # [m] below the track's surface, where its plate is cut to see its holes
CRUMB = 5e-5  # [m] what is narrower is a chord beside its arc
PLACES = 20  # at which radius and climb are measured
OVER = 1e-3  # [m] over the wall's foot, where the wall is met
BEFORE = 20e-3  # [m] of track before the devices that is unrolled


class OnMesh:
    """A device whose holes and blades are those of the mesh; everything else is its own."""

    def __init__(self, device, features):
        self._device, self._features = device, features

    def __getattr__(self, name):
        return getattr(self._device, name)

    def features(self, track, every):
        """Return its features as they were measured."""
        return self._features


def ridden(made, bowl, every):
    """The bowl of a solid, its track as measured, and its devices, as orientations of a part meet them."""
    plan, body = made.plan, facets.unplaced(made)
    track = _track(plan, body, bowl.track)
    if leading_devices(
        [one for one in bowl.devices if one.action.has_place]
    ):  # its bank stands in their slopes
        track = replace(track, bank=bowl.track.bank)
    if plan.stretch is None:
        return replace(bowl, track=track, devices=()), []
    flat, devices = _unrolled(plan, body), []
    for placed in plan.stretch.devices:
        own, device = placed.features, placed.device
        if own.slopes:
            own = replace(own, slopes=tuple(_slope(plan, body, device, one) for one in own.slopes))
        if own.drop is not None:
            drop, aside = _lower(plan, flat, body, own.drop)
            own = replace(own, drop=replace(own.drop, height=drop, aside=aside))
        elif own.openings:
            rings = _holes(plan, flat, plan.first + placed.begin, own, track.width)
            own = replace(own, openings=tuple(replace(own.openings[0], ring=ring) for ring in rings))
        if own.blades:
            own = replace(own, blades=tuple(_blade(plan, flat, placed, one) for one in own.blades))
        devices.append(OnMesh(device, own))
    return replace(bowl, track=track, devices=tuple(devices)), devices


def _slope(plan, body, device, slope):
    """A slope as the mesh has it, where the track has come to lean so."""
    s = _leaning(plan, device)
    bank, climb = _tilt(plan, body, s)
    wall = _wall_lean(plan, body, s[len(s) // 2]) if slope.wall else slope.wall
    measured = {"bank": bank, "climb": climb, "wall": wall}
    return replace(slope, **{k: v for k, v in measured.items() if getattr(slope, k) is not None})


def _leaning(plan, device):
    """Lengths (M,) [m] along the wall where the track leans as a device says, or its groove is open."""
    way, stretch = plan.path, plan.stretch
    if device.kind == "spacing section":
        starts = [at for at, climb in way.bends if climb == device.angle]
    else:
        starts = [end for _, end, bank in way.leans if bank == device.angle] or [0.6 * plan.first]
    opened = [plan.first + one.leans[0][1] for one in stretch.grooves if device.kind == "V groove"]
    start = max(min(starts), *opened) if opened else min(starts)
    later = [*(a for a, _, _ in way.leans), *(at for at, _ in way.bends)]
    end = min([way.end, *(at for at in later if at > start + 1e-4)])
    return np.linspace(start + 1e-4, end - 1e-4, PLACES)


def _tilt(plan, body, s):
    """Bank and climb [rad] of the mesh at lengths along the wall, where there is metal."""
    y = np.array([0.25, 0.75]) * plan.width
    seen = np.array([[measuring.track_heights(plan, body, one, at) or np.nan for at in y] for one in s])
    there = np.abs(seen - plan.path.height(s[:, None], y)).max(axis=1) < 1e-3
    s, seen = s[there], seen[there]
    bank = np.arcsin(np.mean(seen[:, 1] - seen[:, 0]) / (y[1] - y[0]))
    return float(bank), float(np.arctan(np.polyfit(s, seen[:, 0], 1)[0]))


def _wall_lean(plan, body, s):
    """By how much [rad] the wall of the mesh leans back beside the track."""
    low, high = (_to_wall(plan, body, s, over) for over in (8e-4, 2.2e-3))
    return float(np.arctan((high - low) / 1.4e-3))


def _lower(plan, flat, body, own):
    """How much lower [m] the track goes on at a step or beside a ledge, and how wide the ledge is."""
    at = next(at for at, drop in plan.path.drops if abs(drop - own.height) < 1e-9)
    y = 0.5 * (own.aside + plan.width)
    before, behind = (measuring.track_heights(plan, body, s, y) for s in (at - 3e-4, at + 3e-4))
    drop = float(before - behind + np.tan(plan.path.climb) * 6e-4)
    if own.aside == 0.0:
        return drop, 0.0
    room = shapely.box(at + 2e-3, 1e-4, at + 1e-2, plan.width)
    return drop, float(facets.cut_face(flat, 2, 0.5 * drop).intersection(room).bounds[3])


def _track(plan, body, track):
    """The track with width, radius, climb and bank as measured before the devices."""
    s = np.linspace(0.6, 0.98, PLACES) * plan.first
    widths = [measuring.track_width(plan, body, one) for one in s]
    y = 0.2 * plan.width, 0.8 * plan.width
    heights = np.array([[measuring.track_heights(plan, body, one, at) for at in y] for one in s])
    from_middle = s - s.mean()
    slope = (from_middle * heights[:, 0]).sum() / (from_middle**2).sum()  # least squares
    bank = np.arcsin(float(np.mean(heights[:, 1] - heights[:, 0])) / (0.6 * plan.width))
    low, high = (_to_wall(plan, body, s[-1], over) for over in (OVER, 2.0 * OVER))
    climb, radius = float(np.arctan(slope)), 2.0 * low - high  # of the wall's foot, should it lean
    return replace(track, width=float(np.mean(widths)), radius=radius, climb=climb, bank=float(bank))


def _to_wall(plan, body, s, over):
    """Distance [m] of the wall from the axis at a height over its foot, met from above the track."""
    theta, z = float(plan.path.angle(s)), float(plan.path.height(s)) + over
    start = float(plan.path.wall_radius(s)) - 1e-3
    towards = np.array([np.cos(theta), np.sin(theta), 0.0])
    place = start * towards + [0.0, 0.0, z]
    return start + facets.first_met(body, place, place + 0.1 * towards)[0]


def _unrolled(plan, body):
    """The tooled stretch of the mesh as a Manifold [mm] of lengths along the wall, distances, heights."""
    way, wall = plan.path, plan.material.wall
    ends = max(plan.first - BEFORE, 0.0), way.end + plan.outlet - 1e-3
    ring = [[ends[0], -0.5 * wall], [ends[1], -0.5 * wall], [ends[1], 1.2 * plan.width],
            [ends[0], 1.2 * plan.width]]  # fmt: skip
    low = min(float(way.height(at)) for at in ends) - 2.0 * plan.material.plate
    piece = body ^ facets.over(way, np.array(ring), low, plan.top + 1.0, 0.2 * plan.chord)

    def laid(points):
        x, y, z = np.asarray(points).T * MM
        theta = np.arctan2(y, x)
        straight = (y > 0.0) & (theta < 0.5 * np.pi) & (x > 0.0)
        s = np.where(straight, way.end + y, way.at(np.where(theta > 0.0, theta - 2.0 * np.pi, theta)))
        off = np.where(straight, way.radius - x, way.wall_radius(s) - np.hypot(x, y)) / np.cos(way.bank)
        return np.column_stack([s, off, z - way.height(s, off)]) / MM

    return piece.warp_batch(laid)


def _holes(plan, flat, start, own, width):
    """The holes of a device: what is not there of the plate, as far as the device goes."""
    far = min(own.openings[0].end, plan.path.end + plan.outlet - 2e-3 - start)
    near = own.openings[0].begin
    room = shapely.box(start + near - CRUMB, 0.0, start + far + CRUMB, width)
    missing = room.difference(facets.cut_face(flat, 2, -UNDER).buffer(0.5 * CRUMB, join_style="mitre"))
    missing = missing.buffer(-CRUMB, join_style="mitre").buffer(1.5 * CRUMB, join_style="mitre")
    parts = shapely.get_parts(affinity.translate(missing.intersection(room), -start, 0.0))
    parts = [one for one in parts if one.geom_type == "Polygon" and one.area > CRUMB * plan.width]
    rings = [np.array(shapely.simplify(one, 0.2 * CRUMB).exterior.coords)[:-1] for one in parts]
    # Corners within a chord's height of the wall are at it.
    return tuple(np.where(ring <= [-np.inf, 1.5 * CRUMB], ring * [1, 0], ring) for ring in rings)


def _blade(plan, flat, placed, blade):
    """A blade with the face that the mesh has in the middle of its thickness."""
    s = plan.first + placed.begin + blade.foot[0] + 0.5 * blade.thickness
    face = facets.cut_face(flat.translate((-s / MM, 0.0, 0.0)), 0, 0.0)  # of a blade straight across
    low, _, high, top = blade.solid.bounds
    face = face.intersection(shapely.box(max(low, 0.0), CRUMB, high, top))
    face = face.buffer(-CRUMB, join_style="mitre").buffer(CRUMB, join_style="mitre")
    return replace(blade, solid=shapely.simplify(face, 0.2 * CRUMB))
