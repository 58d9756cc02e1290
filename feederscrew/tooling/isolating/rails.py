"""Feeding headed parts hanging: rails at the end, and what has to be returned before them."""

import numpy as np

from feederscrew.tooling.devices.hanging_rails import Rails
from feederscrew.tooling.hanging import neck
from feederscrew.tooling.isolating import chain
from feederscrew.tooling.isolating.needed import told_needed
from feederscrew.tooling.isolating.proposal import weights
from feederscrew.tooling.isolating.shop_values import fine, snapped
from feederscrew.tooling.verdicts import verdict

PLAY, MOST = 4e-4, 6e-4  # [m] by which a slot is wider than the shank: 0.2 to 0.6 mm
CLEAR = 4e-4  # [m] between a hanging head and the wall, wherever the shank stands in its slot
# drops first, then what clears itself, then air, then what sees
STAGES: tuple[dict[str, bool], ...] = ({"clearing": False}, {}, {"air": True}, {"sensed": True})
RAIL = 1e-3  # [m] least width of a rail, and of the sheet it is cut from
# a part that lies along the wall is askew: its shank's tip lies nearer to the wall than its weight, and has
# to be over the slot. The lead-in reaches so far under it, in radii of the shank, and so much at least
SINKS, WIDER = 0.5, 3e-4  # [1], [m]
HELD = 4e-4  # [m] by which the lead-in is narrower than the head at least
CONE = 0.5  # a head whose underside rises by more is one
STRAIGHT, TAPER = 1.5, 1.0  # lengths of the part in which it goes down, and in which the slot narrows


def design(given):
    """Return the chain that ends in rails in which an orientation hangs.

    Parameters
    ----------
    given : DesignTask
        The slot is wider than the shank and narrower than the head by its margin at least.

    Returns
    -------
    Design or None
        None where the part has no head, lies elsewhere than over the slot, or others are left over.
    """
    every, wanted, margin = given.every, given.wanted, given.margin
    device = _between(every[wanted], margin, given.wishes.step)
    if device is None or every[wanted].returned:
        return None
    found = [verdict(device, one, every) for one in every]
    same = np.array([one.hangs and one.margin >= margin for one in found])
    if not same[wanted]:
        return None
    margins = np.array([one.margin for one in found])
    at_rails = np.array([chain.margin_at(device, one, every) for one in every])  # NaN of what stands there
    gone = (at_rails <= -margin) | ~given.stays | (given.coming <= 0.0)
    passed = gone | same
    for stage in STAGES:
        if all(getattr(given.wishes, name) for name in ("air", "sensed") if stage.get(name)):
            cuts, returned = _before(given, passed, same, stage)
        left = ~returned & ~passed & given.often
        jams = (left & np.isnan(at_rails)).any()  # however seldom it comes, it blocks the rails
        if not jams and given.coming[left].sum() <= given.allowed_beside(same):
            break
    else:
        return None
    returned |= gone
    last = chain.judged(
        every, wanted, device, margins <= -margin, *_ends(every[wanted], device, given.wishes.step)
    )
    return told_needed(given, (*cuts, last), returned, same)


def _before(given, passed, same, stage):
    """Cuts before the rails that return what they neither let hang nor return, and which those return."""
    alike = np.flatnonzero(same & given.often)
    found = chain.candidates(given.every, given.wanted, given.margin, given.wishes, same=alike, **stage)
    found = {
        device: some for device, some in found.items() if (some[same & given.often] >= given.margin).all()
    }
    devices = chain.fewest(found, np.where(passed, 0.0, weights(given)), given.margin)
    if not devices:
        return (), passed & ~same
    must = [some & ~passed for some in chain.shared_out(found, devices, given.margin)]
    cuts = chain.placed(given.every, given.wanted, devices, must, step=given.wishes.step, same=alike)
    return cuts, np.any([np.zeros(len(passed), bool), *must], axis=0)


def _between(one, margin, step):
    """Rails about the foot of the centre of mass, as practice has them; None without a head.

    The slot is a little wider than the shank, the head clear of the wall, and the rail at the wall at least
    as wide as its sheet is thick. None where that leaves the weight beside the slot, or no rail at the free
    edge of the track.
    """
    found = neck(one)
    if found is None or found.head - found.shank < 2.0 * margin:
        return None
    play = min(max(PLAY, margin), 0.5 * (found.head - found.shank), MOST)
    return _rails(one, found, found.shank + play, step)


def _ends(one, device, step):
    found = neck(one)
    return tuple(_rails(one, found, width, step) or device for width in (found.shank, found.head))


def _rails(one, found, width, step):
    width = snapped(width, step, up=True)
    middle = max(one.distance - one.shift, 0.5 * found.widest + CLEAR, 0.5 * width + RAIL)
    first = snapped(middle - 0.5 * width, step, up=True)
    span = fine(first), fine(first + width)
    lead = _lead(one, found, span, step)
    if lead[1] >= one.track.width - RAIL or not lead[0] < one.distance - one.shift < lead[1]:
        return None
    return Rails(chain.WHERE, span=span, lead=lead).rewritten()


def _lead(one, found, span, step):
    """Lead-in [m] of a slot: from under the tip of a shank that lies askew to as far beyond its middle.

    It is so narrow that a head with a flat underside rests on both rails wherever the shank stands in it:
    with its shank at one rail and none under its head at the other it hangs askew and stays; a cone does not.
    """
    tip = one.distance - one.shift + found.tip - SINKS * 0.5 * found.shank
    near = max(min(tip, span[0] - WIDER), RAIL)
    near = min(snapped(near, step, up=True), span[0])
    far = max(span[1] + WIDER, found.widest + 2.0 * CLEAR - near)  # its middle as clear of the wall
    held = 0.2 if found.rise > CONE else 0.5
    far = min(far, near + found.head - max(HELD, held * (found.head - found.shank)))
    far = max(snapped(far, step, up=False), span[1])
    sizes = (snapped(share * one.length, step, up=True) for share in (STRAIGHT, TAPER))
    return tuple(fine(size) for size in (near, far, *sizes))
