"""The other face of a groove: a wall that leans back, in place of the bowl's own along that stretch."""

import itertools

import numpy as np

from feederscrew.solidbowl.plan import FULL_TURN
from feederscrew.solidbowl.track import MAX_FACE_ANGLE_RAD, frames, steps

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
MAX_GROOVE_WALL_RAD = 0.85 * FULL_TURN  # [rad] before the outlet: above it the bowl's wall is open


def cuts(plan, kit):
    """Return what grooves take from the bowl's wall.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    return [_swept(plan, kit, groove, _cut) for groove in spans(plan)]


def faces(plan, kit):
    """Return the walls of grooves.

    Parameters
    ----------
    plan : BowlPlan
    kit : module

    Returns
    -------
    list of bodies [mm]
    """
    return [_swept(plan, kit, groove, _face) for groove in spans(plan)]


def spans(plan):
    """Return the grooves of a bowl: (from, to, lean, opens), lengths [m] along the wall, an angle [rad].

    They lie in the last turn: above them there is no other.
    """
    earliest, last = float(plan.way.at(-MAX_GROOVE_WALL_RAD)), plan.way.end + plan.outlet
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
    way, last = plan.way, plan.way.end + plan.outlet
    start, end, _, opens = groove
    stop = min(end + opens, last)
    turned = way.at(-MAX_FACE_ANGLE_RAD * np.arange(1.0, 100.0)) if kit.HAS_EXACT_CURVES else ()
    inner = {start + opens, end, way.end, *turned}
    legs = [start, *sorted(one for one in inner if start < one < stop), stop]
    made = []
    for low, high in itertools.pairwise(legs):
        s = steps(plan, kit, low, high)
        if min(start + opens, high) > low or low >= end:
            s = np.linspace(low, high, max(len(s), int(np.ceil(OPENING * (high - low) / opens)) + 1))
        made.append(
            (
                section(plan, lean_at(groove, s), 1 if kit.HAS_EXACT_CURVES else STRIPS)
                + way.height(s)[:, None, None] * [0.0, 1.0],
                frames(plan, s),
            )
        )
    return kit.swept(made)


def _sloping(plan, lean):
    """Unit vectors (M, 2) up the face and off its back; its width [m]."""
    c, s = np.cos(lean), np.sin(lean)
    return np.stack([s, c], axis=-1), np.stack([c, -s], axis=-1), plan.headroom + GROOVE_WALL_MARGIN_M


def _face(plan, lean, strips):
    """Sections (M, K, 2) of the wall: outwards and up from the track's foot."""
    up, back, wide = _sloping(plan, lean)
    along = np.linspace(-GROOVE_WALL_FOOT_M, wide, strips + 1)[:, None]
    outer = plan.material.wall * back[:, None] + along * up[:, None]
    return np.concatenate([outer, along[::-1] * up[:, None]], axis=1)


def _cut(plan, lean, strips):
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
    return np.concatenate([sloping, np.stack([np.column_stack(one) for one in corners], axis=1)], axis=1)
