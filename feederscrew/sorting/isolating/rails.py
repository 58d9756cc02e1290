"""Rails for parts with a head: where the slot lies, how wide it is, and the blade behind it.

Source: own; docs/tooling.md, "Rails".
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base.arrays import Bools
from feederscrew.bowl.devices.base import RETURNED
from feederscrew.bowl.devices.blades import Wiper
from feederscrew.bowl.devices.ledges import SHOP_STEP_M, Rails
from feederscrew.sorting.isolating.chain import (
    DESIGN_KEY,
    Cut,
    round_finely,
    snap_to_shop_step,
)
from feederscrew.sorting.orientations import Neck, Orientation, hang, may_hang, neck, shouldered_neck
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

PLAY, MOST = 4e-4, 6e-4  # [m] by which a slot is wider than the shank: 0.2 to 0.6 mm
HEAD_WALL_CLEARANCE_M = 4e-4  # [m] between a hanging head and the wall, wherever the shank stands in its slot
RAIL = 1e-3  # [m] least width of a rail, and of the sheet it is cut from
# a part that lies along the wall is askew: its shank's tip lies nearer to the wall than its weight, and has
# to be over the slot. The lead-in reaches so far under it, in radii of the shank, and so much at least
SINKS, WIDER = 0.5, 3e-4  # [1], [m]
LEAD_IN_MARGIN_M = 4e-4  # [m] by which the lead-in is narrower than the head at least
CONE = 0.5  # a head whose underside rises by more is one
STRAIGHT, TAPER = 1.5, 1.0  # lengths of the part in which it goes down, and in which the slot narrows
LEAST_STEP_M = 1e-3  # [m] by which a head is wider than its neck at least
LOWEST_BLADE_M = 1e-3  # [m] of a blade behind rails over the heads that hang
HIGHEST_BLADE_M = 4e-3  # [m] of the same: what is swept by its foot is not laid over


@dataclass(frozen=True)
class RailSetting:
    """Values of rails that are searched, beside what the part gives."""

    offset: float = 0.0  # [m] of the slot, farther off the wall than usual
    play: float = 0.0  # [m] by which the slot is wider than usual
    lead: float = 1.0  # times the usual length of the lead-in
    blade: float = 0.0  # [m] by which the blade behind them stands higher than usual, below what it sweeps


USUAL_RAILS = RailSetting()
# of the static rule, the first that does: a part on its stem comes with its shoulders at the wall
SETTINGS = (
    USUAL_RAILS, RailSetting(play=4e-4), RailSetting(offset=-4e-4), RailSetting(offset=-4e-4, play=4e-4),
)  # fmt: skip


def find_head(orientation: Orientation) -> Neck | None:
    """Return head and shank of a part as it lies: along the track, or on its stem with shoulders over it.

    Whether a part that lies so comes to hang between rails is a question for a trial: a short flanged part
    rolls, and yet hangs.

    Parameters
    ----------
    orientation : Orientation

    Returns
    -------
    Neck or None
        None without a head that is wider than its neck by more than ``LEAST_STEP_M``.
    """
    found = neck(orientation) or shouldered_neck(orientation, PLAY)
    return found if found is not None and found.head - found.shank > LEAST_STEP_M else None


def place_rails(
    orientation: Orientation, head: Neck, width: float, step: float, setting: RailSetting = USUAL_RAILS
) -> Rails | None:
    """Return rails with a slot about the foot of the centre of mass, as practice has them.

    Parameters
    ----------
    orientation : Orientation
    head : Neck
        Of ``find_head``.
    width : float [m]
        Of the slot, before what the setting adds.
    step : float [m]
        A shop makes: values are whole multiples.
    setting : RailSetting

    Returns
    -------
    Rails or None
        None where the head, clear of the wall, leaves the weight beside the slot, or no rail at the free
        edge.
    """
    width = snap_to_shop_step(width + setting.play, step, up=True)
    weight = orientation.distance - orientation.shift
    middle = max(weight, 0.5 * head.widest + HEAD_WALL_CLEARANCE_M, 0.5 * width + RAIL)
    first = snap_to_shop_step(max(middle + setting.offset - 0.5 * width, RAIL), step, up=True)
    span = round_finely(first), round_finely(first + width)
    # the lead-in, from under the tip of a shank that lies askew to as far beyond its middle. It is so narrow
    # that a head with a flat underside rests on both rails wherever the shank stands in it: with its shank at
    # one rail and none under its head at the other it hangs askew and stays; a cone does not
    tip = weight + head.tip - SINKS * 0.5 * head.shank
    near = max(min(tip, span[0] - WIDER), RAIL)
    near = min(snap_to_shop_step(near, step, up=True), span[0])
    # its middle as clear of the wall
    far = max(span[1] + WIDER, head.widest + 2.0 * HEAD_WALL_CLEARANCE_M - near)
    held = 0.2 if head.rise > CONE else 0.5
    far = min(far, near + head.head - max(LEAD_IN_MARGIN_M, held * (head.head - head.shank)))
    far = max(snap_to_shop_step(far, step, up=False), span[1])
    sizes = (
        snap_to_shop_step(setting.lead * share * orientation.length, step, up=True)
        for share in (STRAIGHT, TAPER)
    )
    lead = tuple(round_finely(size) for size in (near, far, *sizes))
    if lead[1] >= orientation.track.width - RAIL or not lead[0] < weight < lead[1]:
        return None
    return Rails(DESIGN_KEY, span=span, lead=lead).rewritten()


def slot_width(head: Neck, margin: float) -> float:
    """Return the usual width of a slot for a head.

    It is the shank and its play: the usual one or the margin, half of what the head is wider and ``MOST`` at
    most.

    Parameters
    ----------
    head : Neck
    margin : float [m]
        That the shank has of play at least.

    Returns
    -------
    float [m]
    """
    return head.shank + min(max(PLAY, margin), 0.5 * (head.head - head.shank), MOST)


def blade_behind(
    rails: Rails,
    orientations: Sequence[Orientation],
    same: Bools,
    others: Bools,
    margin: float,
    sweep: float | None = None,
    step: float = SHOP_STEP_M,
    *,
    sure: bool = True,
    raised: float = 0.0,
) -> Cut | None:
    """Return a swept wiper behind rails: heads pass below it, and what lies over the slot is swept off.

    Parameters
    ----------
    rails : Rails
    orientations : sequence of Orientation
        M, as they lie on the track.
    same : (M,) bool
        Which of them come to hang.
    others : (M,) bool
        Which of them the blade has to return, if it can.
    margin : float [m]
        Over the heads, and under the tops of the others.
    sweep : float [rad], optional
        Of its face to the direction of travel; the usual one without it.
    step : float [m]
        A shop makes.
    sure : bool
        Whether only what the static rule is sure of counts as swept; else all that stands high enough, until
        a trial says otherwise.
    raised : float [m]
        By which it stands higher than usual; below what it sweeps by the margin all the same.

    Returns
    -------
    Cut or None
        None where none of the others stands higher than the heads by twice the margin and the least height.
    """
    hanging = [
        hang(orientation, rails.span)
        for orientation, some in zip(orientations, same)
        if some and may_hang(orientation, rails.span)
    ]
    if not hanging:
        return None
    heads = max(one.height for one in hanging) + max(one.hop for one in orientations)
    low = heads + max(margin, LOWEST_BLADE_M)
    tall = np.array([one.height - margin > low for one in orientations])
    if not (tall & others).any():
        return None
    lowest = min(one.height for one, some in zip(orientations, tall & others) if some)
    limit = round_finely(
        snap_to_shop_step(
            min(min(0.5 * (heads + lowest), heads + HIGHEST_BLADE_M) + raised, lowest - margin), step, up=True
        )
    )
    blade = Wiper.proposal(DESIGN_KEY, max(limit, low))
    blade = (blade if sweep is None else replace(blade, sweep=sweep)).rewritten()
    swept = tall & others
    if sure:
        returned = [device_returns(blade, orientation, orientations, margin) for orientation in orientations]
        swept = swept & np.array(returned)
    if not swept.any():
        return None
    rejected = max(verdict(blade, one, orientations).margin for one, some in zip(orientations, swept) if some)
    return Cut(
        device=blade,
        margin_pass=float(blade.limit - heads),
        margin_reject=float(-rejected),
        smallest=blade.valued(float(lowest)),
        largest=blade.valued(float(heads)),
        returns=tuple(one.name for one, some in zip(orientations, swept) if some),
    )


def device_returns(
    device: Wiper, orientation: Orientation, orientations: Sequence[Orientation], margin: float
) -> bool:
    """Tell whether a blade returns an orientation by a margin, as the static rule says.

    Parameters
    ----------
    device : Wiper
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part.
    margin : float [m]

    Returns
    -------
    bool
    """
    outcome = verdict(device, orientation, orientations)
    fate = device.fate(DeviceEncounter(orientation, orientations))
    return bool(outcome.margin <= -margin and fate == RETURNED)
