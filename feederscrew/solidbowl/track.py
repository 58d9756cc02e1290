"""The track as a body: a plate along its way, the sides of its outlet, and the yokes that carry rails."""

import itertools

import numpy as np
import shapely

from feederscrew.solidbowl import facets
from feederscrew.solidbowl.plan import DIP

INTO = 1e-3  # [m] by which one piece reaches into another
ARC = 6  # facets of a fillet
YOKE = 6e-3  # [m] thickness of what carries the inner rail from below
FAR = 1.0  # [m] beyond everything


def fillet(plan):
    """Return the radius [m] of the fillet below the track, where it meets the wall."""
    return min(plan.material.plate, 0.5 * plan.across)


def slab(plan):
    """Return the track with its outlet, its devices not yet cut.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    Manifold [mm]
    """
    runs, way = [], plan.way
    borders = [way.rises(plan.width) - DIP * way.radius, *(at for at, _ in way.drops), way.end + plan.outlet]
    for start, end in itertools.pairwise(borders):
        s = _steps(plan, start, end)
        inside = np.clip(s, start + 1e-9, end - 1e-9)
        runs.append(_swept(plan, s, plan.way.height(inside)))
    risers = [_riser(plan, at, drop) for at, drop in way.drops]
    whole = facets.united([*runs, *risers]) if len(runs) > 1 else runs[0]
    return facets.above(whole, plan.underside + 0.5 * INTO)


def frames(plan, s):
    """Return place and outward direction (M, 2, 2) of the wall's foot at lengths s, seen from above."""
    theta = plan.way.angle(s)
    outward = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    return np.stack([plan.way.plan(s, 0.0), outward], axis=1)


def _steps(plan, start, end):
    """Lengths along the wall from facet to facet: those of the wall's own facets, and both ends."""
    way, step = plan.way, plan.way.radius * 2.0 * np.pi / plan.segments
    first = np.ceil((start - way.end) / step)
    inner = way.end + step * np.arange(first, 1.0)
    inner = inner[(inner > start + 0.01 * step) & (inner < end - 0.01 * step)]
    return np.unique(np.concatenate([[start], inner, [way.end] if start < way.end < end else [], [end]]))


def _swept(plan, s, heights):
    return facets.swept(_sections(plan, s, heights), frames(plan, s))


def _strips(plan):
    """Into how many strips the track is divided across, so that its twist stays within the chord."""
    way, inner = plan.way, plan.way.radius - plan.across
    twist = way.radius * np.tan(way.climb) * np.pi / plan.segments * plan.across / (way.radius + inner)
    return int(np.ceil(twist / (0.3 * plan.chord))) + 1


def _sections(plan, s, heights):
    """Sections (M, K, 2) of the plate with a fillet below it, by the wall."""
    plate, slope = plan.material.plate, np.tan(plan.way.bank)
    r = fillet(plan)
    inward = plan.across * np.arange(_strips(plan) + 1) / _strips(plan)
    top = np.column_stack([np.concatenate([[INTO], -inward]), np.concatenate([[0.0], inward * slope])])
    turn = 0.5 * np.pi * np.arange(ARC + 1) / ARC
    arc = np.column_stack([-r + r * np.sin(turn), -plate - r + r * np.cos(turn)])
    arc[:, 1] -= arc[:, 0] * slope
    under = [[-plan.across, plan.across * slope - plate], *arc, [INTO, -plate - r]]
    if not plan.material.supported:
        under = [[-plan.across, plan.across * slope - plate], arc[0], arc[-1], [INTO, -plate - r]]
    outline = np.concatenate([top, np.array(under)])
    sections = np.broadcast_to(outline, (len(s), *outline.shape)).copy()
    sections[..., 1] += heights[:, None]
    return sections


def _riser(plan, at, drop):
    """The face below a step down, a plate thick."""
    plate = plan.material.plate
    s = np.array([at - plate, at + 1e-4])
    area = plan.way.laid(
        np.array([[s[0], -INTO], [s[1], -INTO], [s[1], plan.width], [s[0], plan.width]]), plan.chord
    )
    low = float(plan.way.height(at))
    return facets.prism(area, low - plate, low + drop - 0.5 * plate)


def sides(plan):
    """Return the walls of the outlet: one carries on the bowl's wall, one keeps parts on the outlet."""
    way, wall = plan.way, plan.material.wall
    end = way.end + plan.outlet
    height = plan.outlet_height
    low, top = height - plan.material.plate - fillet(plan), height + plan.headroom
    lift = plan.width * np.sin(way.bank)
    outer = np.array([[way.end + 2e-3, -wall], [end, -wall], [end, 0.0], [way.end + 2e-3, 0.0]])
    y = plan.width
    inner = np.array([[way.end, y], [end, y], [end, y + wall], [way.end, y + wall]])
    inside = shapely.Point(0.0, 0.0).buffer(way.radius + 0.4 * wall, quad_segs=90)
    made = [facets.prism(way.laid(outer, plan.chord), low, max(top, height + plan.headroom))]
    made.append(facets.prism(way.laid(inner, plan.chord).difference(inside), low + lift, top + lift))
    return made


def _rails(plan):
    return () if plan.stretch is None else tuple(cut for cut in plan.stretch.cuts if cut.hangs)


def slots(plan):
    """Return what is cut out for parts that hang: from their device to the end of the outlet, open there.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    list of Manifold [mm]
    """
    made = []
    for cut in _rails(plan):
        (low, high), start = (cut.ring[:, 1].min(), cut.ring[:, 1].max()), plan.first + cut.span[0]
        end = plan.way.end + plan.outlet + 5e-3
        ring = np.array([[start, low], [end, low], [end, high], [start, high]])
        heights = plan.way.height(ring[:, 0], ring[:, 1])
        deep = heights.min() - plan.material.plate - plan.hanging
        made.append(facets.prism(plan.way.laid(ring, 0.2 * plan.chord), deep, heights.max() + INTO))
    return made


def yokes(plan):
    """Return the brackets that carry the inner rail from below, behind the stretch that sorts.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    list of Manifold [mm]
    """
    if not _rails(plan):
        return []
    behind = plan.first + max(cut.span[1] for cut in _rails(plan))
    end = plan.way.end + plan.outlet
    return [_yoke(plan, s) for s in (behind, end - YOKE)]


def _yoke(plan, s):
    """A bracket below the track, deep enough that parts hang free over it."""
    ring = np.array([[s, -INTO], [s + YOKE, -INTO], [s + YOKE, plan.width], [s, plan.width]])
    height = float(plan.way.height(s, 0.5 * plan.width))
    plate = plan.material.plate
    low = float(plan.way.height(s)) - plate - plan.hanging - YOKE
    return facets.prism(plan.way.laid(ring, plan.chord), low, height - 0.5 * plate)
