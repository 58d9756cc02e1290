"""The track as a body: a plate along its way, the sides of its outlet, yokes, and a groove's other face."""

import itertools
from collections.abc import Iterable, Iterator
from types import ModuleType

import numpy as np
import shapely

from feederscrew.base.arrays import Floats, Points, Values
from feederscrew.bowl.devices.features import BEYOND_TRACK_M, TrackOpening
from feederscrew.cad.facets import Body
from feederscrew.cad.plan import CONICAL, DIP, FULL_TURN_RAD, BowlPlan
from feederscrew.sorting.tooled_track import GrooveStretch

SECTION_WALL_M = 3e-3  # [m] by which the plate of a section to print goes on below its wall
TRACK_PIECE_OVERLAP_M = 1e-3  # [m] by which one piece reaches into another
ARC = 6  # facets of a fillet
YOKE_RADIUS_RATIO = 1.05  # its radius over its distance from the wall: it crosses the wall
CUT_OVERRUN_M = 2e-3  # [m] by which what reaches an edge of the track is cut over it
OUTLET_OVERRUN_M = 5e-3  # [m] by which a slot that is open at the outlet is cut beyond its end
YOKE = 6e-3  # [m] thickness of what carries the inner rail from below
MAX_FACE_ANGLE_RAD = 0.5 * np.pi  # [rad] of a curved face: a longer one takes long to cut
STEP_OVERLAP_M = 1e-5  # [m] by which the face below a step reaches into the lower plate: no face on a face
LEDGE_SINK_M = 1e-5  # [m] by which a ledge lies lower than the plate before it: no face on a face
PLATE_OVERLAP_M = 3e-5  # [m] by which the side of the outlet reaches into the plate: no face on a face
TWISTED = 4  # facets where the bank changes in place of one
STEEP_BANK_RAD = np.radians(60.5)  # [rad] steeper than any groove: the track stands on edge
# [rad] of bank, on the way there, from which on the fillet below the plate becomes a gusset, to where
GUSSET_BANKS_RAD = np.radians(8.0), np.radians(40.0)
TRACK_CURVE_STEP_RAD = 0.1  # [rad] of a curve between two places that it is led through
EXACT_TWIST_STEP_RAD = np.radians(4.0)  # [rad] of bank between two such places


def fillet(plan: BowlPlan) -> float:
    """Return the radius of the fillet below the track, where it meets the wall; 0 of a section alone.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    float [m]
    """
    return 0.0 if plan.is_section else min(plan.material.plate, 0.5 * plan.across)


def slab(plan: BowlPlan, kit: ModuleType) -> Body:
    """Return the track with its outlet, its devices not yet cut.

    The track is swept in runs between its steps. Below a step the upright face comes first, because pieces
    that only touch cannot be united exactly.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    Body [mm]
    """
    runs, path = [], plan.path
    begin = 0.0 if plan.is_section else path.rises(plan.width) - DIP * path.radius
    changes = *(at for at, _ in path.bends), *(at for lean in path.leans for at in lean[:2]), path.end
    for start, end in itertools.pairwise([begin, *(at for at, _ in path.drops), path.end + plan.outlet]):
        legs = []
        for leg in _legs(plan, kit, [start, end], changes):
            s = steps(plan, kit, *leg)
            heights = path.height(np.clip(s, start + 1e-9, end - 1e-9))  # past its ends a run goes on level
            legs.append((_sections(plan, s, heights, _strips(plan, kit)), frames(plan, s)))
        runs.append(kit.swept(legs))
    joined = runs[:1]
    for (at, drop), run in zip(path.drops, runs[1:]):
        # the face below a step down comes first: what is apart cannot be united exactly
        joined += [_step_face(plan, kit, at, drop, changes), run]
    whole = kit.united(joined) if len(runs) > 1 else runs[0]
    return kit.above(whole, plan.underside + 0.5 * TRACK_PIECE_OVERLAP_M)


def _step_face(plan: BowlPlan, kit: ModuleType, at: float, drop: float, changes: Iterable[float]) -> Body:
    """The upright face below a step, a plate thick: from below the lower track into the upper plate.

    It leans across as the track is banked: a level one leaves a slit by the free edge between the two plates.
    """
    path, plate, legs = plan.path, plan.material.plate, []
    for leg in _legs(plan, kit, [at - plate, at + STEP_OVERLAP_M], changes):
        s = steps(plan, kit, *leg)
        bank, low = path.bank_at(s), path.height(s) - drop * (s < at)
        y = np.array([-TRACK_PIECE_OVERLAP_M, plan.width])
        across, rise = (y * turn(bank)[:, None] for turn in (np.cos, np.sin))
        under = np.stack([-across, low[:, None] - plate + rise], axis=-1)
        over = np.stack([-across, low[:, None] + drop - 0.5 * plate + rise], axis=-1)
        legs.append((np.concatenate([over, under[:, ::-1]], axis=1), frames(plan, s)))
    return kit.swept(legs)


def _legs(
    plan: BowlPlan, kit: ModuleType, ends: list[float], changes: Iterable[float]
) -> Iterator[tuple[float, float]]:
    """From and to [m] of each piece between ends, changes within them, and turns too long for one face."""
    turned = plan.path.at(-MAX_FACE_ANGLE_RAD * np.arange(1.0, 100.0)) if kit.HAS_EXACT_CURVES else ()
    return itertools.pairwise(sorted({*ends, *(at for at in (*changes, *turned) if ends[0] < at < ends[-1])}))


def steps(plan: BowlPlan, kit: ModuleType, start: float, end: float) -> Floats:
    """Return the lengths along the wall at which a piece of track has its sections.

    Facets have them where the wall's own facets meet, and at both ends; a twisted piece has ``TWISTED`` times
    as many, or as its free edge needs. Exact faces have the places that a curve is led through, or the two
    ends of a straight piece.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.
    start, end : float [m]
        Of the piece.

    Returns
    -------
    (M,) float [m]
        Ascending.
    """
    path = plan.path
    turned = float(np.abs(np.diff(path.bank_at(np.array([start, end]))))[0])
    if kit.HAS_EXACT_CURVES:
        curved = max(int((end - start) / path.radius / TRACK_CURVE_STEP_RAD), 3) + 1
        curved = max(curved, int(np.ceil(turned / EXACT_TWIST_STEP_RAD)) + 1)
        return np.linspace(start, end, 2 if start >= path.end else curved)
    step = path.radius * 2.0 * np.pi / plan.segments
    first = np.ceil(float(path.angle(start)) / (2.0 * np.pi / plan.segments))
    inner = path.at(2.0 * np.pi / plan.segments * np.arange(first, 1.0))
    inner = inner[(inner > start + 0.01 * step) & (inner < end - 0.01 * step)]
    unique = np.unique(np.concatenate([[start], inner, [path.end] if start < path.end < end else [], [end]]))
    if not any(low < 0.5 * (start + end) < high for low, high, _ in path.leans):
        return unique
    # the free edge goes round an arc of the track's width, which may be seen too flat by the chord
    edge = int(np.ceil(turned * np.sqrt(plan.width / (8.0 * plan.chord))))
    count = max(TWISTED, int(np.ceil(edge / max(len(unique) - 1, 1))))
    places = np.arange(count * (len(unique) - 1) + 1) / count
    return np.interp(places, np.arange(len(unique)), unique)


def frames(plan: BowlPlan, s: Floats) -> Floats:
    """Return the frames of sections along the wall, seen from above.

    Parameters
    ----------
    plan : BowlPlan
    s : (M,) float [m]
        Lengths along the wall.

    Returns
    -------
    (M, 2, 2) float
        Place [m] of the wall's foot, and the outward unit vector [1].
    """
    theta = plan.path.angle(s)
    outward = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    return np.stack([plan.path.plan(s, 0.0), outward], axis=1)


def _strips(plan: BowlPlan, kit: ModuleType) -> int:
    """Into how many strips the track is divided across, so that its twist stays within the chord."""
    if kit.HAS_EXACT_CURVES:
        return 1
    path, inner = plan.path, plan.path.radius - plan.across
    steepest = max(abs(climb) for climb in (path.climb, *(climb for _, climb in path.bends)))
    twist = path.radius * np.tan(steepest) * np.pi / plan.segments * plan.across / (path.radius + inner)
    banks = [path.bank, *(bank for _, _, bank in path.leans)]
    rates = (abs(b - a) / (lean[1] - lean[0]) for a, b, lean in zip(banks, banks[1:], path.leans))
    step = FULL_TURN_RAD * path.radius / plan.segments / TWISTED
    twist = max(twist, 0.25 * max([0.0, *rates]) * step * plan.across)
    return int(np.ceil(twist / (0.3 * plan.chord))) + 1


def _sections(plan: BowlPlan, s: Floats, heights: Floats, strips: int) -> Floats:
    """Sections (M, K, 2) of the plate with a fillet below it, by the wall."""
    plate, bank, r = plan.material.plate, plan.path.bank_at(s), fillet(plan)
    inward = np.arange(strips + 1) / strips * np.ones((len(s), 1)) * (plan.width * np.cos(bank))[:, None]
    square = float(stands_on_edge(plan))  # the plate is as thick square to its surface, else upright
    slope, turned = np.tan(np.minimum(bank, STEEP_BANK_RAD)), square * _gusset_share(bank)
    past = SECTION_WALL_M if plan.is_section else TRACK_PIECE_OVERLAP_M  # no edge lies on the wall
    along = (
        turned * np.cos(bank) + 1.0 - turned
    )  # of what goes on into the wall: level, or along a steep plate
    ends = np.column_stack([past * along, -past * along * np.tan(bank)])
    surface = np.stack([-inward, inward * np.tan(bank)[:, None]], axis=-1)
    surface[:, 0] = ends
    deep = plate * np.column_stack([square * np.sin(bank), 1.0 + square * (np.cos(bank) - 1.0)])
    edge = surface[:, -1:] - deep[:, None]
    if plan.is_section:
        below = ends[:, None] - deep[:, None]
        sections = np.concatenate([surface, edge, below], axis=1)
    else:
        turn, own = 0.5 * np.pi * np.arange(ARC + 1) / ARC, YOKE_RADIUS_RATIO * r  # on into the wall
        arc = np.column_stack([-r + own * np.sin(turn), -plate - own + own * np.cos(turn)])
        arc = arc if plan.material.supported else arc[[0, -1]]
        level = np.ones((len(s), 1))
        curved = np.stack([arc[:, 0] * level, arc[:, 1] - arc[:, 0] * slope[:, None]], axis=-1)
        deepest = np.array([TRACK_PIECE_OVERLAP_M, -plate - own]) * np.ones((len(s), 1, 1))
        # below a plate on edge a straight gusset from its inner face to the wall
        share = np.linspace(0.0, 1.0, len(arc))[:, None]
        inner = r * np.column_stack([-np.cos(bank), np.sin(bank)]) - deep
        gusset = (1.0 - share) * inner[:, None] + share * [0.0, -plate - own]
        curved = curved + turned[:, None, None] * (gusset - curved)
        sections = np.concatenate([surface, edge, curved, deepest], axis=1)
    if plan.stairs is not None and plan.stairs.shape == CONICAL:
        # what is below the track is kept within the wall, which leans in below it; no device changes its bank
        under = sections[0, strips + 1 :]
        most = TRACK_PIECE_OVERLAP_M + under[:, 1] / np.tan(plan.stairs.slope)
        last = int(np.argmax(under[:, 0] > most))  # the first corner that is deep enough in the wall
        sections = sections[:, : strips + last + 2].copy()
        sections[:, -1, 0] = most[last]
    sections[..., 1] += heights[:, None]
    return sections


def stands_on_edge(plan: BowlPlan) -> bool:
    """Tell whether the track is twisted until it stands on edge.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    bool
    """
    return any(bank > STEEP_BANK_RAD for _, _, bank in plan.path.leans)


def _gusset_share(bank: Floats) -> Floats:
    """How far (M,) [1] the fillet below the plate has become a gusset at a bank (M,) [rad]."""
    first, last = GUSSET_BANKS_RAD
    share = np.clip((bank - first) / (last - first), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def ledges(plan: BowlPlan, kit: ModuleType) -> list[Body]:
    """Return the ledges along the wall that stand on the track which goes on lower beside them.

    A ledge begins within the plate before it, a little lower, and ends within the plate below it: so no two
    faces lie in one plane.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    list of Body [mm]
    """
    path, half, strips, bodies = plan.path, 0.5 * plan.material.plate, _strips(plan, kit), []
    for ledge in () if plan.stretch is None else plan.stretch.ledges:
        at, end = plan.first + ledge.begin, plan.first + ledge.end
        lower, aside = ledge.drop.height, ledge.drop.aside
        ends, legs = [at - half, plan.first + ledge.sunk(0.2 * half)], []
        for leg in _legs(plan, kit, ends, (at, end)):
            s = steps(plan, kit, *leg)
            low = path.height(s) - lower * (s < at)
            inward = aside * np.cos(path.bank_at(s))[:, None] * np.arange(strips + 1) / strips
            inward[:, 0] = -TRACK_PIECE_OVERLAP_M
            rise = inward * np.tan(path.bank_at(s))[:, None]
            down = ledge.level_at(s[:, None] - plan.first, inward / np.cos(path.bank_at(s))[:, None])
            # held within the plate; a curve through a place that is held there would swing about the ramp
            high = low[:, None] + lower + np.maximum(down, -lower - 0.95 * half) - LEDGE_SINK_M
            top = np.stack([-inward, high + rise], axis=-1)
            under = np.stack([-inward, low[:, None] - half + rise], axis=-1)[:, [-1, 0]]
            legs.append((np.concatenate([top, under], axis=1), frames(plan, s)))
        bodies.append(kit.swept(legs))
    return bodies


def drum(plan: BowlPlan, kit: ModuleType, radius: float, low: float, high: float) -> Body:
    """Return a cylinder about the axis, its facets those of the wall.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.
    radius : float [m]
    low, high : float [m]
        Heights of its ends.

    Returns
    -------
    Body [mm]
    """
    return kit.turned([(0.0, low), (radius, low), (radius, high), (0.0, high)], plan.segments)


def sides(plan: BowlPlan, kit: ModuleType) -> list[Body]:
    """Return the walls of the outlet: one carries on the bowl's wall, one keeps parts on the outlet.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    list of Body [mm]
        Without the former where a groove is open to the end; none where the track stands on edge there.
    """
    path, wall, height = plan.path, plan.material.wall, plan.outlet_height
    if stands_on_edge(plan):
        return []
    end = path.end + plan.outlet
    low, top = height - plan.material.plate - fillet(plan), height + plan.headroom
    lift = plan.width * np.sin(path.bank_at(path.end))
    outer = np.array([[path.end + 2e-3, -wall], [end, -wall], [end, 0.0], [path.end + 2e-3, 0.0]])
    y = plan.width - PLATE_OVERLAP_M
    inner = np.array([[path.end, y], [end, y], [end, y + wall], [path.end, y + wall]])
    r = float(path.wall_radius(path.at(-2.0 * np.pi)) if plan.stairs else path.radius) + 0.4 * wall
    ends = low + lift - TRACK_PIECE_OVERLAP_M, top + lift + TRACK_PIECE_OVERLAP_M
    inside = drum(plan, kit, r, *ends)
    open_there = plan.stretch is not None and any(np.isinf(groove.end) for groove in plan.stretch.grooves)
    solid = [] if open_there else [kit.over(path, outer, low, top, plan.chord)]
    solid.append(kit.without(kit.over(path, inner, low + lift, top + lift, plan.chord), [inside]))
    return solid


def _openings(plan: BowlPlan, hang: bool) -> list[TrackOpening]:
    """The openings of the stretch; of those in which parts hang the last is open at the end of the outlet."""
    if plan.stretch is None:
        return []
    opened = plan.stretch.opened_to(plan.path.end + plan.outlet + OUTLET_OVERRUN_M - plan.first)
    return [opening for _, opening in opened.openings if opening.hangs == hang]


def holes(plan: BowlPlan, kit: ModuleType, *, hang: bool) -> list[Body]:
    """Return the bodies that cuts take out of the track.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.
    hang : bool
        Take the cuts in which parts hang, the last of which goes on from its device to the end of the outlet
        and is open there; else the others.

    Returns
    -------
    list of Body [mm]
    """
    solid, plate = [], plan.material.plate
    for opening in _openings(plan, hang):
        for outline in opening.carried_over(plan.width, CUT_OVERRUN_M):
            ring = outline + [plan.first, 0.0]
            heights = plan.path.height(ring[:, 0], ring[:, 1])
            deep = plan.hanging if hang else fillet(plan) + TRACK_PIECE_OVERLAP_M
            low, high = heights.min() - plate - deep, heights.max() + TRACK_PIECE_OVERLAP_M
            solid.append(kit.over(plan.path, ring, low, high, 0.2 * plan.chord))
    return solid


def yokes(plan: BowlPlan, kit: ModuleType) -> list[Body]:
    """Return the brackets that carry the inner rail from below, behind the stretch that sorts.

    They lie so deep that parts hang free over them.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    list of Body [mm]
    """
    solid = []
    for s in yoke_places(plan):
        ends = np.array([s, s + YOKE])
        solid.append(kit.swept([(_yoke_sections(plan, ends), frames(plan, ends))]))
    return solid


def _yoke_sections(plan: BowlPlan, s: Floats) -> Floats:
    """Sections (M, 4, 2) [m] of a yoke: outwards from the wall's face, and height; one foot for all."""
    wall, plate = np.full(len(s), TRACK_PIECE_OVERLAP_M), plan.material.plate
    foot, bank = plan.path.height(s), plan.path.bank_at(s)
    across, low = plan.width * np.cos(bank), foot[0] - plate - plan.hanging - YOKE
    out = np.stack([-across, wall, wall, -across], axis=-1)
    up = foot[:, None] - 0.5 * plate - out[:, 2:] * np.tan(bank)[:, None]
    return np.stack([out, np.hstack([np.full((len(s), 2), low), up])], axis=-1)


def yoke_outline(plan: BowlPlan, s: float) -> Points:
    """Return a yoke seen along the track, where a slot that parts hang in is at a place.

    Parameters
    ----------
    plan : BowlPlan
    s : float [m]
        Length along the wall.

    Returns
    -------
    (K, 2) float [m]
        Outwards from the wall's face, and height over the floor's edge; empty where there is no slot.
    """
    here = [slot for slot in _openings(plan, hang=True) if slot.begin <= s - plan.first <= slot.end]
    if not here or here[-1].span is None:
        return np.empty((0, 2))
    near, far = np.array(here[-1].span) * np.cos(plan.path.bank_at(s))
    deep = float(plan.path.height(s)) - plan.material.plate - plan.hanging
    free = shapely.box(-far, deep, -near, deep + BEYOND_TRACK_M)
    yoke = shapely.Polygon(_yoke_sections(plan, np.array([s]))[0])
    return shapely.get_coordinates(yoke.difference(free).exterior)[:-1]


def yoke_places(plan: BowlPlan) -> tuple[float, ...]:
    """Return where along the way each yoke begins, YOKE thick.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    tuple of float [m]
        Empty without rails.
    """
    if plan.stretch is None or not plan.stretch.hangs:
        return ()
    return plan.first + plan.stretch.length, plan.path.end + plan.outlet - YOKE


MIN_GROOVE_WALL_LEAN_RAD = np.radians(3.0)  # by which it leans at once: no face lies on the bowl's wall
GROOVE_WALL_FOOT_M = 5e-4  # [m] by which its face goes on into the track
GROOVE_CUT_MARGIN_M = 5e-3  # [m] beyond what is cut away
GROOVE_WALL_MARGIN_M = 5e-3  # [m] of the face beyond the tallest part
OPENING = 24  # sections of a stretch over which the wall opens
STRIPS = 8  # of the face upwards: its facets are about as wide as high where it turns fast
MAX_GROOVE_WALL_RAD = 0.85 * FULL_TURN_RAD  # [rad] before the outlet: above it the bowl's wall is open


def groove_walls(plan: BowlPlan, kit: ModuleType) -> tuple[list[Body], list[Body]]:
    """Return the cuts that grooves make in the bowl's wall, and their own walls.

    A cut goes a little lower than the wall in it, as three faces in one line cut badly.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    list of Body [mm]
        Cuts.
    list of Body [mm]
        Walls.
    """
    path, wide = plan.path, plan.headroom + GROOVE_WALL_MARGIN_M
    strips = 1 if kit.HAS_EXACT_CURVES else STRIPS
    far = plan.material.wall + GROOVE_CUT_MARGIN_M
    cuts, walls = [], []
    for groove in groove_spans(plan):
        changes = groove.leans
        ends = [groove.begin, min(groove.closed, path.end + plan.outlet)]
        cut_legs, wall_legs = [], []
        for low, high in _legs(plan, kit, ends, (*(at for change in changes for at in change[:2]), path.end)):
            s = steps(plan, kit, low, high)
            # where it turns, so finely
            turns = next((b - a for a, b, _ in changes if a < 0.5 * (low + high) < b), np.inf)
            s = s if np.isinf(turns) else _finer(s, int(np.ceil(OPENING * (high - low) / turns)) + 1)
            c, sn = np.cos(lean_at(groove, s)), np.sin(lean_at(groove, s))
            up, rearward = np.stack([sn, c], axis=-1)[:, None], np.stack([c, -sn], axis=-1)[:, None]
            heights = path.height(s)[:, None, None] * [0.0, 1.0]
            # the wall: outwards and up from the track's foot
            along = np.linspace(-GROOVE_WALL_FOOT_M, wide, strips + 1)[:, None]
            outer = plan.material.wall * rearward + along * up
            wall_legs.append((np.concatenate([outer, along[::-1] * up], axis=1) + heights, frames(plan, s)))
            # what is above it, up to a metre: cut lower, as three faces in one line cut badly
            along = np.linspace(-GROOVE_CUT_MARGIN_M, wide, strips + 1)[:, None]
            face = along * up - [0.0, 0.8 * GROOVE_WALL_FOOT_M]
            outside = face[:, [-1, -1, 0]] + [[far, 0.0], [far, 0.0], [0.0, 0.0]]
            outside[:, 1:, 1] = 1.0
            cut_legs.append((np.concatenate([face, outside], axis=1) + heights, frames(plan, s)))
        cuts.append(kit.swept(cut_legs))
        walls.append(kit.swept(wall_legs))
    return cuts, walls


def _finer(s: Floats, count: int) -> Floats:
    """Return lengths from the first to the last of some, evenly, ``count`` of them where they are fewer."""
    return np.linspace(s[0], s[-1], max(len(s), count))


def groove_spans(plan: BowlPlan) -> list[GrooveStretch]:
    """Return the grooves of a bowl, along its wall.

    They lie in the last turn: above them there is no other. One that is open from the entry on opens where it
    begins, over the length of the longest part.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    list of GrooveStretch
    """
    if plan.stretch is None:
        return []
    first = max(float(plan.path.at(-MAX_GROOVE_WALL_RAD)), GROOVE_CUT_MARGIN_M)

    def along_bowl(start: float, end: float, lean: float) -> tuple[float, float, float]:
        """Return a change of the wall's lean as the bowl has it."""
        begin, over = max(plan.first + start, first), end - start
        return begin, begin + (over if np.isfinite(over) else longest), lean

    longest = plan.stretch.longest
    return [GrooveStretch(tuple(along_bowl(*change) for change in own.leans)) for own in plan.stretch.grooves]


def lean_at(groove: GrooveStretch, s: Values) -> Values:
    """Return by how much the wall of a groove leans back from upright, as it is made.

    The least is ``MIN_GROOVE_WALL_LEAN_RAD``: a face in the plane of the bowl's wall cuts badly.

    Parameters
    ----------
    groove : GrooveStretch
        Along the bowl's wall.
    s : float or array [m]
        Lengths along the wall.

    Returns
    -------
    float or array [rad]
    """
    return np.maximum(groove.lean_at(s), MIN_GROOVE_WALL_LEAN_RAD)
