"""The track as a body: a plate along its way, the sides of its outlet, yokes, and a groove's other face."""

import itertools
from typing import Any

import numpy as np

from feederscrew.solidbowl.plan import CONICAL, DIP, FULL_TURN_RAD

TRACK_PIECE_OVERLAP_M = 1e-3  # [m] by which one piece reaches into another
ARC = 6  # facets of a fillet
YOKE_RADIUS_RATIO = (
    1.05  # its radius over its distance from the wall: it crosses the wall, and does not touch it
)
YOKE = 6e-3  # [m] thickness of what carries the inner rail from below
MAX_FACE_ANGLE_RAD = 0.5 * np.pi  # [rad] of a curved face: a longer one takes long to cut
PLATE_OVERLAP_M = (
    3e-5  # [m] by which a ledge, and the outlet's side, reach into the plate: no face lies on another
)
TWISTED = 4  # facets where the bank changes in place of one
TRACK_CURVE_STEP_RAD = 0.1  # [rad] of a curve between two places that it is led through


def fillet(plan):
    """Return the radius [m] of the fillet below the track, where it meets the wall."""
    return min(plan.material.plate, 0.5 * plan.across)


def slab(plan, kit):
    """Return the track with its outlet, its devices not yet cut.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the body is made with.

    Returns
    -------
    body of that kit [mm]
    """
    runs, path = [], plan.path
    borders = [
        path.rises(plan.width) - DIP * path.radius,
        *(at for at, _ in path.drops),
        path.end + plan.outlet,
    ]
    for start, end in itertools.pairwise(borders):
        turned = path.at(-MAX_FACE_ANGLE_RAD * np.arange(1.0, 100.0)) if kit.HAS_EXACT_CURVES else ()
        changes = *(at for at, _ in path.bends), *(at for lean in path.leans for at in lean[:2])
        breaks = sorted(at for at in {*changes, path.end, *turned} if start < at < end)
        legs = [start, *breaks, end]
        runs.append(kit.swept([_leg(plan, kit, leg, (start, end)) for leg in itertools.pairwise(legs)]))
    joined = runs[:1]
    for (at, drop), run in zip(path.drops, runs[1:]):
        joined += [_riser(plan, kit, at, drop), run]  # in this order: what is apart cannot be united exactly
    whole = kit.united(joined) if len(runs) > 1 else runs[0]
    return kit.above(whole, plan.underside + 0.5 * TRACK_PIECE_OVERLAP_M)


def _leg(plan, kit, leg, run) -> tuple[Any, ...]:
    """Sections and frames of a piece of a run, which goes on past its ends at the same height."""
    s = steps(plan, kit, *leg)
    inside = np.clip(s, run[0] + 1e-9, run[1] - 1e-9)
    strips = 1 if kit.HAS_EXACT_CURVES else _strips(plan)
    return _sections(plan, s, plan.path.height(inside), strips), frames(plan, s)


def steps(plan, kit, start, end):
    """Return the lengths (M,) [m] along the wall at which a piece of track has its sections."""
    return _smooth_steps(plan, start, end) if kit.HAS_EXACT_CURVES else _steps(plan, start, end)


def _smooth_steps(plan, start, end) -> np.ndarray:
    """Lengths along the wall through which a curve is led; the two ends of what is straight."""
    count = (
        2
        if start >= plan.path.end
        else max(int((end - start) / plan.path.radius / TRACK_CURVE_STEP_RAD), 3) + 1
    )
    return np.linspace(start, end, count)


def frames(plan, s) -> np.ndarray:
    """Return place and outward direction (M, 2, 2) of the wall's foot at lengths s, seen from above."""
    theta = plan.path.angle(s)
    outward = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    return np.stack([plan.path.plan(s, 0.0), outward], axis=1)


def _steps(plan, start, end):
    """Lengths along the wall from facet to facet: those of the wall's own facets, and both ends."""
    path, step = plan.path, plan.path.radius * 2.0 * np.pi / plan.segments
    first = np.ceil(float(path.angle(start)) / (2.0 * np.pi / plan.segments))
    inner = path.at(2.0 * np.pi / plan.segments * np.arange(first, 1.0))
    inner = inner[(inner > start + 0.01 * step) & (inner < end - 0.01 * step)]
    unique = np.unique(np.concatenate([[start], inner, [path.end] if start < path.end < end else [], [end]]))
    if not any(low < 0.5 * (start + end) < high for low, high, _ in path.leans):
        return unique
    places = np.arange(TWISTED * (len(unique) - 1) + 1) / TWISTED
    return np.interp(places, np.arange(len(unique)), unique)


def _strips(plan):
    """Into how many strips the track is divided across, so that its twist stays within the chord."""
    path, inner = plan.path, plan.path.radius - plan.across
    steepest = max(abs(climb) for climb in (path.climb, *(climb for _, climb in path.bends)))
    twist = path.radius * np.tan(steepest) * np.pi / plan.segments * plan.across / (path.radius + inner)
    banks = [path.bank, *(bank for _, _, bank in path.leans)]
    fastest = max(
        [0.0, *(abs(b - a) / (lean[1] - lean[0]) for a, b, lean in zip(banks, banks[1:], path.leans))]
    )
    step = FULL_TURN_RAD * path.radius / plan.segments / TWISTED
    twist = max(twist, 0.25 * fastest * step * plan.across)
    return int(np.ceil(twist / (0.3 * plan.chord))) + 1


def _sections(plan, s, heights, strips):
    """Sections (M, K, 2) of the plate with a fillet below it, by the wall."""
    plate, bank = plan.material.plate, plan.path.bank_at(s)
    r = fillet(plan)
    inward = np.arange(strips + 1) / strips * np.ones((len(s), 1)) * (plan.width * np.cos(bank))[:, None]
    edge = inward[:, -1:].copy()
    inward[:, 0] = -TRACK_PIECE_OVERLAP_M  # no edge lies on the wall
    turn, own = 0.5 * np.pi * np.arange(ARC + 1) / ARC, YOKE_RADIUS_RATIO * r  # the arc goes on into the wall
    arc = np.column_stack([-r + own * np.sin(turn), -plate - own + own * np.cos(turn)])
    arc = arc if plan.material.supported else arc[[0, -1]]
    level = np.ones((len(s), 1))
    out = np.hstack([-inward, -edge, arc[:, 0] * level, TRACK_PIECE_OVERLAP_M * level])
    below = np.hstack([0.0 * inward, -plate * level, arc[:, 1] * level, (-plate - own) * level])
    slanted = np.hstack([out[:, :-1], 0.0 * level])  # all but the corner deep in the wall
    sections = np.stack([out, below - slanted * np.tan(bank)[:, None]], axis=-1)
    sections = _within_wall(plan, sections, strips + 1)
    sections[..., 1] += heights[:, None]
    return sections


def _within_wall(plan, sections, above):
    """Sections (M, K, 2), what is below the track kept within a wall that leans in below it."""
    if plan.stairs is None or plan.stairs.shape != CONICAL:
        return sections
    under = sections[0, above:]  # no device changes the bank of a conical bowl
    most = TRACK_PIECE_OVERLAP_M + under[:, 1] / np.tan(plan.stairs.slope)
    last = int(np.argmax(under[:, 0] > most))  # the first corner that is deep enough in the wall
    within_wall = sections[:, : above + last + 1].copy()
    within_wall[:, -1, 0] = most[last]
    return within_wall


def _riser(plan, kit, at, drop):
    """The face below a step down, a plate thick."""
    plate = plan.material.plate
    s = np.array([at - plate, at + 1e-4])
    ring = np.array(
        [
            [s[0], -TRACK_PIECE_OVERLAP_M],
            [s[1], -TRACK_PIECE_OVERLAP_M],
            [s[1], plan.width],
            [s[0], plan.width],
        ]
    )
    low = float(plan.path.height(at))
    return kit.over(plan.path, ring, low - plate, low + drop - 0.5 * plate, plan.chord)


def ledges(plan, kit) -> list[Any]:
    """Return the ledges along the wall that stand on the track which goes on lower beside them.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    return [_ledge(plan, kit, item) for item in (() if plan.stretch is None else plan.stretch.ledges)]


def _ledge(plan, kit, ledge):
    """A ledge; it begins within the plate before it, a little lower, and ends within the plate below it."""
    at, half = plan.first + ledge.start, 0.5 * plan.material.plate
    end = plan.first + ledge.end
    breaks = [at - half, at, end, end + ledge.ramp * (1.0 + 0.8 * half / ledge.drop)]
    turned = plan.path.at(-MAX_FACE_ANGLE_RAD * np.arange(1.0, 100.0)) if kit.HAS_EXACT_CURVES else ()
    legs = sorted({*breaks, *(item for item in turned if breaks[0] < item < breaks[-1])})
    return kit.swept([_ledge_leg(plan, kit, ledge, leg) for leg in itertools.pairwise(legs)])


def _ledge_leg(plan, kit, ledge, leg) -> tuple[Any, ...]:
    """Sections and frames of a piece of a ledge."""
    path, half = plan.path, 0.5 * plan.material.plate
    at, end = plan.first + ledge.start, plan.first + ledge.end
    s = steps(plan, kit, *leg)
    low = path.height(s) - ledge.drop * (s < at)
    high = low + ledge.drop * (1.0 - np.maximum((s - end) / ledge.ramp, 0.0)) - PLATE_OVERLAP_M
    strips = 1 if kit.HAS_EXACT_CURVES else _strips(plan)
    inward = ledge.width * np.cos(path.bank_at(s))[:, None] * np.arange(strips + 1) / strips
    inward[:, 0] = -TRACK_PIECE_OVERLAP_M
    rise = inward * np.tan(path.bank_at(s))[:, None]
    top = np.stack([-inward, high[:, None] + rise], axis=-1)
    under = np.stack([-inward, low[:, None] - half + rise], axis=-1)[:, [-1, 0]]
    return np.concatenate([top, under], axis=1), frames(plan, s)


def sides(plan, kit):
    """Return the walls of the outlet: one carries on the bowl's wall, one keeps parts on the outlet."""
    path, wall = plan.path, plan.material.wall
    end = path.end + plan.outlet
    height = plan.outlet_height
    low, top = height - plan.material.plate - fillet(plan), height + plan.headroom
    lift = plan.width * np.sin(path.bank_at(path.end))
    outer = np.array([[path.end + 2e-3, -wall], [end, -wall], [end, 0.0], [path.end + 2e-3, 0.0]])
    y = plan.width - PLATE_OVERLAP_M
    inner = np.array([[path.end, y], [end, y], [end, y + wall], [path.end, y + wall]])
    inside = kit.drum(
        float(path.wall_radius(path.at(-2.0 * np.pi)) if plan.stairs else path.radius) + 0.4 * wall,
        low + lift - TRACK_PIECE_OVERLAP_M,
        top + lift + TRACK_PIECE_OVERLAP_M,
        plan.segments,
    )
    open_there = plan.stretch is not None and any(np.isinf(groove[1]) for groove in plan.stretch.grooves)
    solid = [] if open_there else [kit.over(path, outer, low, max(top, height + plan.headroom), plan.chord)]
    solid.append(kit.without(kit.over(path, inner, low + lift, top + lift, plan.chord), [inside]))
    return solid


def _rails(plan) -> tuple[Any, ...]:
    return () if plan.stretch is None else tuple(cut for cut in plan.stretch.cuts if cut.hangs)


def slots(plan, kit):
    """Return what is cut out for parts that hang: from their device to the end of the outlet, open there.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    solid = []
    for cut in _rails(plan):
        ring = cut.ring + [plan.first, 0.0]
        ring[cut.ring[:, 0] >= cut.span[1] - 1e-9, 0] = plan.path.end + plan.outlet + 5e-3
        heights = plan.path.height(ring[:, 0], ring[:, 1])
        deep = heights.min() - plan.material.plate - plan.hanging
        solid.append(kit.over(plan.path, ring, deep, heights.max() + TRACK_PIECE_OVERLAP_M, 0.2 * plan.chord))
    return solid


def yokes(plan, kit) -> list[Any]:
    """Return the brackets that carry the inner rail from below, behind the stretch that sorts.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    return [_yoke(plan, kit, s) for s in yoke_places(plan)]


def yoke_places(plan) -> tuple[float, ...]:
    """Return where along the way each yoke begins [m], YOKE thick; none without rails."""
    if not _rails(plan):
        return ()
    behind = plan.first + max(cut.span[1] for cut in _rails(plan))
    return behind, plan.path.end + plan.outlet - YOKE


def _yoke(plan, kit, s):
    """A bracket below the track, deep enough that parts hang free over it."""
    ends, plate = np.array([s, s + YOKE]), plan.material.plate
    foot, bank = plan.path.height(ends), plan.path.bank_at(ends)
    across, low = plan.width * np.cos(bank), foot[0] - plate - plan.hanging - YOKE
    out = np.stack(
        [
            -across,
            [TRACK_PIECE_OVERLAP_M, TRACK_PIECE_OVERLAP_M],
            [TRACK_PIECE_OVERLAP_M, TRACK_PIECE_OVERLAP_M],
            -across,
        ],
        axis=-1,
    )
    up = foot[:, None] - 0.5 * plate - out[:, 2:] * np.tan(bank)[:, None]
    sections = np.stack([out, np.hstack([np.full((2, 2), low), up])], axis=-1)
    return kit.swept([(sections, frames(plan, ends))])


MIN_GROOVE_WALL_LEAN_RAD = np.radians(3.0)  # by which it leans at once: no face lies on the bowl's wall
GROOVE_WALL_FOOT_M = 5e-4  # [m] by which its face goes on into the track
GROOVE_WALL_CUT_DEPTH_M = (
    0.8 * GROOVE_WALL_FOOT_M
)  # by which the wall is cut lower: three faces that meet in one line cut badly
GROOVE_CUT_MARGIN_M = 5e-3  # [m] beyond what is cut away
BEYOND_WALL_M = 1.0  # [m] beyond everything
GROOVE_WALL_MARGIN_M = 5e-3  # [m] of the face beyond the tallest part
OPENING = 24  # sections of a stretch over which the wall opens
STRIPS = 8  # of the face upwards: its facets are about as wide as high where it turns fast
MAX_GROOVE_WALL_RAD = 0.85 * FULL_TURN_RAD  # [rad] before the outlet: above it the bowl's wall is open


def groove_wall_cuts(plan, kit) -> list[Any]:
    """Return what grooves take from the bowl's wall.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    return [_swept(plan, kit, groove, _cut) for groove in groove_spans(plan)]


def groove_faces(plan, kit) -> list[Any]:
    """Return the walls of grooves.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    return [_swept(plan, kit, groove, _face) for groove in groove_spans(plan)]


def groove_spans(plan) -> list[Any]:
    """Return the grooves of a bowl: (from, to, lean, opens), lengths [m] along the wall, an angle [rad].

    They lie in the last turn: above them there is no other.
    """
    earliest, last = float(plan.path.at(-MAX_GROOVE_WALL_RAD)), plan.path.end + plan.outlet
    grooves = () if plan.stretch is None else plan.stretch.grooves
    return [
        (max(plan.first + start, earliest, GROOVE_CUT_MARGIN_M), min(plan.first + end, last), lean, opens)
        for start, end, lean, opens in grooves
    ]


def lean_at(groove, s):
    """Return by how much [rad] the wall of a groove leans back from upright at lengths s."""
    start, end, lean, opens = groove
    share = np.clip((s - start) / opens, 0.0, 1.0) * (1.0 - np.clip((s - end) / opens, 0.0, 1.0))
    return np.maximum(lean * share, MIN_GROOVE_WALL_LEAN_RAD)


def _swept(plan, kit, groove, section):
    """A body along a groove, of sections that its lean makes."""
    path, last = plan.path, plan.path.end + plan.outlet
    start, end, _, opens = groove
    stop = min(end + opens, last)
    turned = path.at(-MAX_FACE_ANGLE_RAD * np.arange(1.0, 100.0)) if kit.HAS_EXACT_CURVES else ()
    inner = {start + opens, end, path.end, *turned}
    legs = [start, *sorted(item for item in inner if start < item < stop), stop]
    solid = []
    for low, high in itertools.pairwise(legs):
        s = steps(plan, kit, low, high)
        if min(start + opens, high) > low or low >= end:
            s = np.linspace(low, high, max(len(s), int(np.ceil(OPENING * (high - low) / opens)) + 1))
        solid.append(
            (
                section(plan, lean_at(groove, s), 1 if kit.HAS_EXACT_CURVES else STRIPS)
                + path.height(s)[:, None, None] * [0.0, 1.0],
                frames(plan, s),
            )
        )
    return kit.swept(solid)


def _sloping(plan, lean) -> tuple[Any, ...]:
    """Unit vectors (M, 2) up the face and off its back; its width [m]."""
    c, s = np.cos(lean), np.sin(lean)
    return np.stack([s, c], axis=-1), np.stack([c, -s], axis=-1), plan.headroom + GROOVE_WALL_MARGIN_M


def _face(plan, lean, strips) -> np.ndarray:
    """Sections (M, K, 2) of the wall: outwards and up from the track's foot."""
    up, rearward, wide = _sloping(plan, lean)
    along = np.linspace(-GROOVE_WALL_FOOT_M, wide, strips + 1)[:, None]
    outer = plan.material.wall * rearward[:, None] + along * up[:, None]
    return np.concatenate([outer, along[::-1] * up[:, None]], axis=1)


def _cut(plan, lean, strips) -> np.ndarray:
    """Sections (M, K, 2) of what is above it, out of the wall: its border is hidden in face and track."""
    up, _, wide = _sloping(plan, lean)
    along = np.linspace(-GROOVE_CUT_MARGIN_M, wide, strips + 1)[:, None]
    sloping = along * up[:, None] - [0.0, GROOVE_WALL_CUT_DEPTH_M]
    foot, top = sloping[:, 0], sloping[:, -1]
    out = plan.material.wall + GROOVE_CUT_MARGIN_M
    far = np.full(len(lean), BEYOND_WALL_M)
    corners = [
        (top[:, 0] + out, top[:, 1]), (top[:, 0] + out, far), (foot[:, 0], far),
    ]  # fmt: skip
    return np.concatenate(
        [sloping, np.stack([np.column_stack(corner) for corner in corners], axis=1)], axis=1
    )
