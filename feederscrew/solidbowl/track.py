"""The track as a body: a plate along its way, the sides of its outlet, and the yokes that carry rails."""

import itertools

import numpy as np

from feederscrew.solidbowl.plan import DIP
from feederscrew.solidbowl.stairs import CONICAL

INTO = 1e-3  # [m] by which one piece reaches into another
ARC = 6  # facets of a fillet
THROUGH = 1.05  # its radius over its distance from the wall: it crosses the wall, and does not touch it
YOKE = 6e-3  # [m] thickness of what carries the inner rail from below
QUARTER = 0.5 * np.pi  # [rad] of a curved face: a longer one takes long to cut
SPAN = 0.1  # [rad] of a curve between two places that it is led through


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
    runs, way = [], plan.way
    borders = [way.rises(plan.width) - DIP * way.radius, *(at for at, _ in way.drops), way.end + plan.outlet]
    for start, end in itertools.pairwise(borders):
        turned = way.at(-QUARTER * np.arange(1.0, 100.0)) if kit.SMOOTH else ()
        breaks = sorted(at for at in (*(at for at, _ in way.bends), way.end, *turned) if start < at < end)
        legs = [start, *breaks, end]
        runs.append(kit.swept([_leg(plan, kit, leg, (start, end)) for leg in itertools.pairwise(legs)]))
    risers = [_riser(plan, kit, at, drop) for at, drop in way.drops]
    whole = kit.united([*runs, *risers]) if len(runs) > 1 else runs[0]
    return kit.above(whole, plan.underside + 0.5 * INTO)


def _leg(plan, kit, leg, run):
    """Sections and frames of a piece of a run, which goes on past its ends at the same height."""
    s = _smooth_steps(plan, *leg) if kit.SMOOTH else _steps(plan, *leg)
    inside = np.clip(s, run[0] + 1e-9, run[1] - 1e-9)
    strips = 1 if kit.SMOOTH else _strips(plan)
    return _sections(plan, s, plan.way.height(inside), strips), frames(plan, s)


def _smooth_steps(plan, start, end):
    """Lengths along the wall through which a curve is led; the two ends of what is straight."""
    count = 2 if start >= plan.way.end else max(int((end - start) / plan.way.radius / SPAN), 3) + 1
    return np.linspace(start, end, count)


def frames(plan, s):
    """Return place and outward direction (M, 2, 2) of the wall's foot at lengths s, seen from above."""
    theta = plan.way.angle(s)
    outward = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    return np.stack([plan.way.plan(s, 0.0), outward], axis=1)


def _steps(plan, start, end):
    """Lengths along the wall from facet to facet: those of the wall's own facets, and both ends."""
    way, step = plan.way, plan.way.radius * 2.0 * np.pi / plan.segments
    first = np.ceil(float(way.angle(start)) / (2.0 * np.pi / plan.segments))
    inner = way.at(2.0 * np.pi / plan.segments * np.arange(first, 1.0))
    inner = inner[(inner > start + 0.01 * step) & (inner < end - 0.01 * step)]
    return np.unique(np.concatenate([[start], inner, [way.end] if start < way.end < end else [], [end]]))


def _strips(plan):
    """Into how many strips the track is divided across, so that its twist stays within the chord."""
    way, inner = plan.way, plan.way.radius - plan.across
    steepest = max(abs(climb) for climb in (way.climb, *(climb for _, climb in way.bends)))
    twist = way.radius * np.tan(steepest) * np.pi / plan.segments * plan.across / (way.radius + inner)
    return int(np.ceil(twist / (0.3 * plan.chord))) + 1


def _sections(plan, s, heights, strips):
    """Sections (M, K, 2) of the plate with a fillet below it, by the wall."""
    plate, slope = plan.material.plate, np.tan(plan.way.bank)
    r = fillet(plan)
    inward = plan.across * np.arange(strips + 1) / strips
    inward[0] = -INTO  # no edge lies on the wall
    top = np.column_stack([-inward, inward * slope])
    turn, own = 0.5 * np.pi * np.arange(ARC + 1) / ARC, THROUGH * r  # the arc goes on into the wall
    arc = np.column_stack([-r + own * np.sin(turn), -plate - own + own * np.cos(turn)])
    arc[:, 1] -= arc[:, 0] * slope
    under = [[-plan.across, plan.across * slope - plate], *arc, [INTO, -plate - own]]
    if not plan.material.supported:
        under = [[-plan.across, plan.across * slope - plate], arc[0], arc[-1], [INTO, -plate - own]]
    outline = np.concatenate([top, _within_wall(plan, np.array(under))])
    sections = np.broadcast_to(outline, (len(s), *outline.shape)).copy()
    sections[..., 1] += heights[:, None]
    return sections


def _within_wall(plan, under):
    """Corners (K, 2) below the track, kept within a wall that leans in below it."""
    if plan.stairs is None or plan.stairs.shape != CONICAL:
        return under
    most = INTO + under[:, 1] / np.tan(plan.stairs.slope)
    last = int(np.argmax(under[:, 0] > most))  # the first corner that is deep enough in the wall
    return np.vstack([under[:last], [most[last], under[last, 1]]])


def _riser(plan, kit, at, drop):
    """The face below a step down, a plate thick."""
    plate = plan.material.plate
    s = np.array([at - plate, at + 1e-4])
    ring = np.array([[s[0], -INTO], [s[1], -INTO], [s[1], plan.width], [s[0], plan.width]])
    low = float(plan.way.height(at))
    return kit.over(plan.way, ring, low - plate, low + drop - 0.5 * plate, plan.chord)


def sides(plan, kit):
    """Return the walls of the outlet: one carries on the bowl's wall, one keeps parts on the outlet."""
    way, wall = plan.way, plan.material.wall
    end = way.end + plan.outlet
    height = plan.outlet_height
    low, top = height - plan.material.plate - fillet(plan), height + plan.headroom
    lift = plan.width * np.sin(way.bank)
    outer = np.array([[way.end + 2e-3, -wall], [end, -wall], [end, 0.0], [way.end + 2e-3, 0.0]])
    y = plan.width
    inner = np.array([[way.end, y], [end, y], [end, y + wall], [way.end, y + wall]])
    inside = kit.drum(
        float(way.wall_radius(way.at(-2.0 * np.pi)) if plan.stairs else way.radius) + 0.4 * wall,
        low + lift - INTO,
        top + lift + INTO,
        plan.segments,
    )
    made = [kit.over(way, outer, low, max(top, height + plan.headroom), plan.chord)]
    made.append(kit.without(kit.over(way, inner, low + lift, top + lift, plan.chord), [inside]))
    return made


def _rails(plan):
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
    made = []
    for cut in _rails(plan):
        ring = cut.ring + [plan.first, 0.0]
        ring[cut.ring[:, 0] >= cut.span[1] - 1e-9, 0] = plan.way.end + plan.outlet + 5e-3
        heights = plan.way.height(ring[:, 0], ring[:, 1])
        deep = heights.min() - plan.material.plate - plan.hanging
        made.append(kit.over(plan.way, ring, deep, heights.max() + INTO, 0.2 * plan.chord))
    return made


def yokes(plan, kit):
    """Return the brackets that carry the inner rail from below, behind the stretch that sorts.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    if not _rails(plan):
        return []
    behind = plan.first + max(cut.span[1] for cut in _rails(plan))
    end = plan.way.end + plan.outlet
    return [_yoke(plan, kit, s) for s in (behind, end - YOKE)]


def _yoke(plan, kit, s):
    """A bracket below the track, deep enough that parts hang free over it."""
    ring = np.array([[s, -INTO], [s + YOKE, -INTO], [s + YOKE, plan.width], [s, plan.width]])
    height = float(plan.way.height(s, 0.5 * plan.width))
    plate = plan.material.plate
    low = float(plan.way.height(s)) - plate - plan.hanging - YOKE
    return kit.over(plan.way, ring, low, height - 0.5 * plate, plan.chord)
