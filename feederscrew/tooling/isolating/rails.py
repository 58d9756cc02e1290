"""Feeding headed parts hanging: rails at the end, and what has to be returned before them."""

import numpy as np

from feederscrew.tooling.devices.hanging_rails import Rails
from feederscrew.tooling.hanging import neck
from feederscrew.tooling.isolating import chain
from feederscrew.tooling.isolating.proposal import told, weights
from feederscrew.tooling.verdicts import verdict

PLAY, MOST = 4e-4, 6e-4  # [m] by which a slot is wider than the shank: 0.2 to 0.6 mm
CLEAR = 2e-4  # [m] between a hanging head and the wall
# drops first, then what clears itself, then what sees
STAGES: tuple[dict[str, bool], ...] = ({"clearing": False}, {}, {"sensed": True})
RAIL = 1e-3  # [m] least width of a rail, and of the sheet it is cut from


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
    gone = (margins <= -margin) | ~given.stays | (given.coming <= 0.0)
    passed = gone | same
    for stage in STAGES:
        if not stage.get("sensed") or given.wishes.allows("sorter"):
            cuts, returned = _before(given, passed, same, stage)
        left = ~returned & ~passed & given.often
        if given.coming[left].sum() <= given.coming[same].sum() * (1.0 / given.purity - 1.0):
            break
    else:
        return None
    returned |= gone
    last = chain.judged(
        every, wanted, device, margins <= -margin, *_ends(every[wanted], device, given.wishes.step)
    )
    return told(given, (*cuts, last), returned, same)


def _before(given, passed, same, stage):
    """Cuts before the rails that return what they neither let hang nor return, and which those return."""
    found = chain.candidates(given.every, given.wanted, given.margin, given.wishes, **stage)
    found = {
        device: some for device, some in found.items() if (some[same & given.often] >= given.margin).all()
    }
    devices = chain.fewest(found, np.where(passed, 0.0, weights(given)), given.margin)
    if not devices:
        return (), passed & ~same
    must = [some & ~passed for some in chain.shared_out(found, devices, given.margin)]
    cuts = chain.placed(given.every, given.wanted, devices, must, step=given.wishes.step)
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
    width = chain.snapped(width, step, up=True)
    middle = max(one.distance - one.shift, 0.5 * found.head + CLEAR, 0.5 * width + RAIL)
    first = chain.snapped(middle - 0.5 * width, step, up=True)
    span = chain.fine(first), chain.fine(first + width)
    if span[1] >= one.track.width - RAIL or not span[0] < one.distance - one.shift < span[1]:
        return None
    text = f"{{from: {chain.millimetres(span[0])}, to: {chain.millimetres(span[1])}}}"
    return Rails(chain.WHERE, span=span, text=text)
