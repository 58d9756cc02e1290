"""Places 0.03 mm to either side of every edge that a feature has, and whether they are solid there.

They are made of the features alone, by formulas of their own: no consumer is asked where anything lies. A
place is s along the wall, y from it and z over the track, square to it, at a level that fell upright.
"""

import itertools
from dataclasses import dataclass

import numpy as np
import shapely

ASIDE = 3e-5  # [m] of an edge
UNDER = 1e-4  # [m] below a surface: there its edge is looked at
CLEAR = 2e-4  # [m] of other edges
SHORT = 1e-3  # [m] a side of a curved edge: its middle is looked at
ON_RAMP = 2e-6  # [m] over a ramp, as the trial has it
OVER_RAMP = 13e-6  # [m] over one that is made: 0.05 mm along the wall
UNDER_RAMP = 2e-5  # [m] below it: bodies have it 0.01 mm lower, so that no face lies on a face
SURE = 1e-5  # [m] by which a flat plate that reaches ahead may lean otherwise than the track below its end
SURE_HEIGHT = (
    3e-4  # [m] the same, of its upper and lower edges: they are looked at in the middle of the plate
)
IN_WALL = 5e-4  # [m] behind the wall's face
SHARES = (0.17, 0.55, 0.83)  # of a side, of a width
ABOVE = 4e-3  # [m] over the track, where a wall is met


@dataclass(frozen=True)
class Probe:
    """A place and whether something is solid there."""

    what: str  # 'gap opening'
    s: float  # [m] along the wall
    y: float  # [m] from it
    level: float  # [m] upright, of the track there
    z: float  # [m] over that, square to it
    solid: bool


def probes(tooled):
    """Return the probes of a tooled track, device by device: a list for each."""
    return [_of_device(tooled, placed) for placed in tooled.devices]


def _of_device(tooled, placed):
    kind, width = placed.device.kind, tooled.width
    return [
        Probe(f"{kind} {what}", float(s), float(y), float(level), float(z), solid)
        for what, s, y, level, z, solid in (
            *_openings(placed, width),
            *_surface(tooled, placed, width),
            *_drops(placed, width),
            *_ramps(placed),
            *_blades(tooled, placed),
            *_bores(placed),
            *_wall(tooled, placed),
            *_free_edge(placed, width),
        )
    ]


def _openings(placed, width):
    """Below the surface, beside each side of an opening; an edge of a slot that goes on is none."""
    track = shapely.box(-10.0, 0.0, 10.0, width)
    holes = [shapely.Polygon(opening.ring) for opening in placed.openings]
    for opening in placed.openings:
        ring = opening.ring
        inner = float(np.sign(_area(ring)))
        for start, stop in zip(ring, np.roll(ring, -1, axis=0)):
            along = stop - start
            size = np.hypot(*along)
            if size < CLEAR or (opening.hangs and min(start[0], stop[0]) >= opening.end - 1e-9):
                continue
            inwards = inner * np.array([-along[1], along[0]]) / size
            for share, off in itertools.product(SHARES if size > SHORT else (0.5,), (ASIDE, -ASIDE)):
                place = shapely.Point(start + share * along + off * inwards)
                if track.exterior.distance(place) > CLEAR and track.contains(place):
                    is_open = any(hole.contains(place) for hole in holes)
                    assert is_open == (off > 0.0)
                    yield "opening", place.x, place.y, placed.level, -UNDER, not is_open


def _area(ring):
    x, y = ring.T
    return 0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum()


def _surface(tooled, placed, width):
    """Over and below the surface of the bare track before a device, up to where its features begin."""
    clear = [ledge.foot for ledge in tooled.ledges if ledge.begin < placed.begin - ASIDE]
    begin, end = max([placed.start, *clear]), placed.begin
    holes = shapely.union_all([shapely.Polygon(opening.ring) for _, opening in tooled.openings])
    for s in (*np.linspace(begin, end, 4)[1:3], end - 6e-4, end - ASIDE):
        for y in np.array(SHARES) * width:
            if not holes.contains(shapely.Point(s, y)):
                for z, solid in ((ASIDE, False), (-ASIDE, True)):
                    yield "surface", s, y, placed.level, z, solid


def _drops(placed, width):
    """To either side of the edge of a step or a ledge, and of the surface below it."""
    drop, begin = placed.drop, placed.begin
    if drop is None:
        return
    is_ledge = drop.aside > 0.0
    far = begin + (drop.length if is_ledge else 4e-3)
    ways = np.linspace(begin + 1e-3, far - 1e-3, 3)
    across = drop.aside + np.array(SHARES) * (width - drop.aside)
    # the face of a step is whole from the wall to the free edge, and from the upper track to the lower
    sides = () if is_ledge else (3e-4, *np.array(SHARES) * width, width - CLEAR)
    for y, share in itertools.product(sides, (*SHARES, 0.97)):
        yield "face", begin - ASIDE, y, placed.level - share * drop.height, 0.0, True
        if y > 3e-4 and share < 0.97:
            yield "face", begin + ASIDE, y, placed.level - share * drop.height, 0.0, False
    for s in ways if is_ledge else ():  # all of it, down to the lower track
        for y, share in itertools.product(np.array(SHARES) * drop.aside, (0.5, 0.9)):
            yield "ledge", s, y, placed.level - share * drop.height, 0.0, True
    for y in across:
        yield "edge", begin - ASIDE, y, placed.level, -UNDER, True
        yield "edge", begin + ASIDE, y, placed.level, -UNDER, False
        for s in ways:
            yield "lower track", s, y, placed.level - drop.height, -ASIDE, True
            yield "lower track", s, y, placed.level - drop.height, ASIDE, False
    for s in ways if is_ledge else ():
        yield "ledge", s, drop.aside - ASIDE, placed.level, -UNDER, True
        yield "ledge", s, drop.aside + ASIDE, placed.level, -UNDER, False


def _ramps(placed):
    """Above, below and beside the ramp on which a ledge comes down: a plane bent down at the ledge's end."""
    drop = placed.drop
    if drop is None or drop.aside <= 0.0:
        return
    inner = placed.radius - drop.aside
    turn = np.arcsin(drop.height / np.tan(drop.ramp) / inner)
    for share in (0.2, 0.5, 0.8, 0.95):
        s = placed.begin + drop.length + placed.radius * share * turn
        slope = np.tan(drop.ramp) * np.sin(share * turn)  # of its height over the distance from the axis
        for y in np.array(SHARES) * drop.aside:
            surface = placed.level - slope * (placed.radius - y)
            if surface - UNDER < placed.level - drop.height:  # it is down to the lower track there
                continue
            over = OVER_RAMP if share < 0.9 else UNDER_RAMP  # exact faces bend a little at their end
            yield "ramp", s, y, surface + over, 0.0, False
            yield "ramp as tried", s, y, surface + ON_RAMP, 0.0, False
            yield "ramp", s, y, surface - UNDER_RAMP, 0.0, True
            yield "ramp as tried", s, y, surface - ON_RAMP, 0.0, True
        if share < 0.8:  # the lower track is far enough below
            for off in (ASIDE, -ASIDE):
                yield "ramp", s, drop.aside + off, placed.level - slope * inner - UNDER, 0.0, off < 0.0


def _blades(tooled, placed):
    """Beside each side of a blade's face, half its thickness behind it, and beside its face and its back.

    A flat plate that reaches ahead along a banked or climbing track cannot stand square to all of it: where
    that is more than ``SURE`` its heights alone are looked at, and beyond ``SURE_HEIGHT`` nothing. Nor is
    anything where two plates of a device meet.
    """
    lean = float(tooled.bank_at(placed.begin)) + float(tooled.climb_at(placed.begin))
    prints = [shapely.Polygon(ring) for ring in placed.footprints]
    for blade, own in zip(placed.features.blades, prints):
        others = shapely.union_all([ring for ring in prints if ring is not own])
        for x, z, behind, solid, sure in _of_plate(blade):
            (c, s), (ahead, inwards) = blade.axes
            far, off = x * c + behind * ahead, blade.foot[1] + x * s + behind * inwards
            y = placed.radius - np.hypot(far, placed.radius - off)
            at = placed.begin + blade.foot[0] + placed.radius * np.arctan2(far, placed.radius - off)
            leans = z * abs(np.sin(lean)) * abs(far) / placed.radius
            is_alone = not prints[1:] or others.distance(shapely.Point(at, y)) > CLEAR
            is_over = CLEAR + z * abs(np.tan(lean)) < y < tooled.width - CLEAR and z > CLEAR
            if is_over and is_alone and leans < sure:
                yield "blade", at, y, placed.level, z, solid


def _of_plate(blade):
    """Yield places of a plate: along its face, up, behind it; if solid there, and how far it may lean."""
    for part in (one for one in shapely.get_parts(blade.solid) if one.geom_type == "Polygon"):
        for ring in (part.exterior, *part.interiors):
            for start, stop in itertools.pairwise(shapely.get_coordinates(ring)):
                along = stop - start
                size = np.hypot(*along)
                across = np.array([-along[1], along[0]]) / size
                for share, off in itertools.product(SHARES if size > SHORT else (), (ASIDE, -ASIDE)):
                    x, z = start + share * along + off * across
                    is_solid = bool(blade.solid.contains(shapely.Point(x, z)))
                    yield x, z, 0.5 * blade.thickness, is_solid, SURE_HEIGHT if along[1] == 0.0 else SURE
        x, z = shapely.get_coordinates(part.representative_point())[0]
        for behind in (ASIDE, blade.thickness - ASIDE, -ASIDE, blade.thickness + ASIDE):
            yield x, z, behind, 0.0 < behind < blade.thickness, SURE


def _bores(placed):
    """To either side of the rim of a bore, within the wall."""
    for bore in placed.features.bores:
        for turn, off in itertools.product(np.radians([10.0, 100.0, 190.0, 280.0]), (ASIDE, -ASIDE)):
            r = 0.5 * bore.diameter + off
            askew = -IN_WALL / np.tan(bore.angle) + r * np.cos(turn) / np.sin(bore.angle)
            s = placed.begin + bore.place + askew
            yield "bore", s, -IN_WALL, placed.level, bore.height + r * np.sin(turn), off > 0.0


def through_bores(placed, wall):
    """Return probes along the axis of each bore, from before the wall to behind it: all of it is open."""
    return [
        Probe("bore", placed.begin + bore.place, -deep, placed.level, bore.height, False)
        for bore in placed.features.bores
        for deep in np.linspace(-CLEAR, wall + CLEAR, 9)
    ]


def through_openings(placed, width, plate):
    """Return the probes of openings again, upright below: they go through all of the plate as they begin."""
    return [
        Probe("opening", float(s), float(y), level - deep, 0.0, solid)
        for _, s, y, level, _, solid in _openings(placed, width)
        for deep in (0.5 * plate, 0.95 * plate)
    ]


def gate_in_notch(placed, play, wall):
    """Return probes of the notch of each gate in the wall, beside its plate and below it, and of the plate.

    The wall is open to ``play`` [m] around the plate. A list for the bowl, and one for the gate.
    """
    bowl, gate = [], []
    for blade in (blade for blade in placed.features.blades if blade.is_gate):
        middle, thick = 0.5 * blade.thickness, blade.thickness
        sides = ((-play, -1.0), (thick + play, 1.0)), ((0.0, -1.0), (thick, 1.0))
        for own, edges in zip((bowl, gate), sides):
            for (edge, way), off in itertools.product(edges, (ASIDE, -ASIDE)):
                s = placed.begin + blade.foot[0] + edge + way * off
                is_open = (off < 0.0) == (own is bowl)
                own.append(Probe("notch", s, -0.9 * wall, placed.level, 0.04 * blade.top, not is_open))
        for own, edge in ((bowl, -play), (gate, 0.0)):
            for off in (ASIDE, -ASIDE):
                is_open = (off > 0.0) == (own is bowl)
                s = placed.begin + blade.foot[0] + middle
                own.append(Probe("notch", s, -0.9 * wall, placed.level, edge + off, not is_open))
    return bowl, gate


def _wall(tooled, placed):
    """Before and behind the wall over the bare track before a device; in a groove it leans."""
    s = 0.5 * (placed.start + placed.begin)
    bank, lean = float(tooled.bank_at(s)), float(tooled.wall_lean_at(s))
    if 0.0 < lean < np.radians(3.5):  # as it opens it is made to lean so much at once
        return
    # over the track, off the wall: it leans over a banked track, and back from it in a groove
    high, foot = ABOVE * np.cos(lean - bank), -ABOVE * np.sin(lean - bank)
    for off in (ASIDE, -ASIDE):
        y, z = foot + off * np.cos(lean - bank), high + off * np.sin(lean - bank)
        yield "wall", s, y, placed.level, z, off < 0.0


def _free_edge(placed, width):
    """Within and beyond the free edge of the bare track before a device, just below its surface."""
    for share, off in itertools.product(SHARES, (ASIDE, -ASIDE)):
        s = placed.start + share * (placed.begin - placed.start)
        yield "free edge", s, width + off, placed.level, -0.5 * ASIDE, off < 0.0


def in_section(tooled, probe):
    """Return where a probe is in the printed section: (3,) [m], the wall tangent to X at the origin."""
    bank, theta = float(tooled.bank_at(probe.s)), probe.s / tooled.track.radius
    r = tooled.track.radius - probe.y * np.cos(bank) + probe.z * np.sin(bank)
    up = probe.level + probe.y * np.sin(bank) + probe.z * np.cos(bank)
    return np.array([r * np.sin(theta), tooled.track.radius - r * np.cos(theta), up])


def in_trial(tooled, placed, probe):
    """Return where a probe is in the stage of its device alone: (3,) [m], the plane of the track level."""
    bank, level = float(tooled.bank_at(placed.begin)), probe.level - placed.level
    return _in_plane(tooled, probe, probe.s - placed.begin, level * np.cos(bank), level * np.sin(bank))


def in_queue(tooled, placed, probe):
    """Return where a probe is on the track of a queue, which has every device: (3,) [m]."""
    falls = [(-height, float(tooled.bank_at(s))) for s, height in tooled.drops if s < placed.begin - ASIDE]
    falls.append((probe.level - placed.level, float(tooled.bank_at(placed.begin))))
    low, out = (sum(fall * turn(bank) for fall, bank in falls) for turn in (np.cos, np.sin))
    return _in_plane(tooled, probe, probe.s, low, out)


def on_ramp(tooled, placed, probe, begin, in_frame):
    """Return where a probe of a ramp is in the trial: (3,) [m]. It falls upright, and the track leans.

    The ramp goes straight on from where its ledge ends, which a consumer has ``in_frame``; ``begin`` [m] is
    its length along the wall there.
    """
    bank, climb = float(tooled.bank_at(placed.begin)), float(tooled.climb_at(placed.begin))
    end = placed.begin + placed.drop.length
    foot = in_frame(tooled, placed, Probe(probe.what, end, 0.0, placed.level, 0.0, True))
    theta, turn = (begin + placed.drop.length) / placed.radius, (probe.s - end) / placed.radius
    ahead, inwards = [np.cos(theta), np.sin(theta), 0.0], [-np.sin(theta), np.cos(theta), 0.0]
    r = placed.radius - probe.y
    # lengths along the wall are level ones: what lies along the slope is shorter by the cosine
    upright = np.sin(climb) * np.cos(climb), np.cos(climb) * np.sin(bank), np.cos(climb) * np.cos(bank)
    way = np.array([r * np.sin(turn), placed.radius - r * np.cos(turn), 0.0])
    way = way + (probe.level - placed.level) * np.array(upright)
    return foot + way[0] * np.array(ahead) + way[1] * np.array(inwards) + [0.0, 0.0, way[2]]


def _in_plane(tooled, probe, s, low, out):
    """Where a probe is whose track is so low and so far out: what falls upright does so on a bank."""
    radius = tooled.track.radius
    r, theta = radius - probe.y - out, s / radius
    return np.array([r * np.sin(theta), radius - r * np.cos(theta), low + probe.z])


def in_bowl(tooled, plan, probe):
    """Return where a probe is in a bowl: (3,) [m], its outlet at the angle 0, right-handed."""
    radius, outlet = tooled.track.radius, plan.path.end - plan.first
    bank, climb = float(tooled.bank_at(probe.s)), float(tooled.climb_at(probe.s))
    # the climb from the probe to the outlet: between its changes it is constant
    ends = sorted({probe.s, outlet, *(at for at, _ in tooled.climbs if probe.s < at < outlet)})
    rise = sum((b - a) * np.tan(float(tooled.climb_at(0.5 * (a + b)))) for a, b in itertools.pairwise(ends))
    foot = plan.outlet_height + tooled.fallen - rise
    theta = (probe.s - outlet) / radius
    outward, ahead = (
        np.array([np.cos(theta), np.sin(theta), 0.0]),
        np.array([-np.sin(theta), np.cos(theta), 0.0]),
    )
    up = np.array([0.0, 0.0, 1.0])
    inwards = -np.cos(bank) * outward + np.sin(bank) * up
    square = np.cross(ahead + np.tan(climb) * up, inwards)
    square = square / np.sqrt((square**2).sum())
    return radius * outward + (foot + probe.level) * up + probe.y * inwards + probe.z * square
