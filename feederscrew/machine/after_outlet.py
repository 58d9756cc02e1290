"""What comes behind the outlet: the gap, a stub of the inline track, and the sensors of its level."""

from dataclasses import dataclass

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.machine.springs import stroke
from feederscrew.sorting.orientations import HANGING, Hanging, Orientation

GAP_CLEARANCE_M, STEP_CLEARANCE_M = 0.5e-3, 0.2e-3  # beyond what the bowl moves by (assumption)
BUFFER_PARTS, FULL_PARTS, LOW_PARTS = (
    10,
    8,
    3,
)  # of the stub; before the sensor 'full'; before 'low' (assumption)
COVER_PLAY = 0.2  # [1] of the part's height: below the cover parts do not climb onto each other (assumption)
PULL = 1.3  # [1] speed of the inline track over that of parts at the outlet, so that they part (assumption)
DWELL_PARTS = 2.0  # times that a part takes past the sensor: so long covered means full
BRIDGED_SHARE = 0.5  # [1] of the greatest gap that a part passes, that it may have to pass here


@dataclass(frozen=True)
class InlineTrack:
    """The straight track behind the outlet, as a stub; lengths from where the bowl's outlet ends."""

    gap: float  # [m] along the way, at rest
    bridged: float  # [m] greatest gap that the part passes as it leaves; infinite of what hangs
    step: float  # [m] by which its surface lies lower than the outlet's, at rest
    height: float  # [m] of its surface over the floor's edge; NaN where no solid says where the outlet is
    width: float  # [m] between its sides, or of its slot where parts hang
    hangs: bool
    cover: float  # [m] of its cover over its surface
    length: float  # [m] of the stub
    full_at: float  # [m] of the level sensor that stops the bowl
    low_at: float  # [m] of the one that starts it
    dwell: float  # [s] covered so long, the track is full there
    speed: float  # [m/s] of the inline track, at least
    lacks: str  # what is wrong with the gap; '' where all is well


def plan_inline_track(bowl: Bowl, leaving: Orientation, speed: float, outlet_height: float) -> InlineTrack:
    """Return the inline track behind a bowl's outlet.

    The bowl moves to and fro by A cos(psi) and up and down by A sin(psi), A half its stroke and psi the angle
    of its motion to the horizontal. So the gap is that and ``GAP_CLEARANCE_M``, and the inline track lies
    that and ``STEP_CLEARANCE_M`` lower: a part never meets an edge. The gap must be less than
    ``BRIDGED_SHARE`` of the gap that the part passes.

    Parameters
    ----------
    bowl : Bowl
        With its drive, and the rules of its play.
    leaving : Orientation
        In which parts leave.
    speed : float [m/s]
        Of parts at the outlet.
    outlet_height : float [m]
        Over the floor's edge; NaN where it is not known.

    Returns
    -------
    InlineTrack

    References
    ----------
    Own; docs/bowl.md, "Behind the outlet".
    """
    moved, rules = stroke(bowl), bowl.sizing
    half = 0.5 * moved.peak_to_peak
    gap = float(half * np.cos(moved.angle) + GAP_CLEARANCE_M)
    step = float(half * np.sin(moved.angle) + STEP_CLEARANCE_M)
    hangs = isinstance(leaving, Hanging) or leaving.kind == HANGING
    bridged = np.inf if hangs else float(leaving.gap)
    wide = float(np.ptp(leaving.outline[:, 1]))
    play = float(np.clip(rules.clearance * wide, rules.least_clearance, rules.greatest_clearance))
    span = getattr(leaving, "span", ())
    lacks = ""
    if gap > BRIDGED_SHARE * bridged:
        lacks = (
            f"a part that leaves bridges {1e3 * bridged:.3g} mm: lead a tongue of the inline track below "
            f"the outlet instead of a gap of {1e3 * gap:.3g} mm"
        )
    passing = leaving.length / speed if speed > 0.0 else np.inf
    return InlineTrack(
        gap=gap,
        bridged=bridged,
        step=step,
        height=outlet_height - step,
        width=float(span[1] - span[0]) if span else wide + play,
        hangs=hangs,
        cover=(1.0 + COVER_PLAY) * leaving.height,
        length=gap + BUFFER_PARTS * leaving.length,
        full_at=gap + FULL_PARTS * leaving.length,
        low_at=gap + LOW_PARTS * leaving.length,
        dwell=float(DWELL_PARTS * passing),
        speed=PULL * speed,
        lacks=lacks,
    )
