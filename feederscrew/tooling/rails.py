"""Feeding headed parts hanging: rails at the end, and what has to be returned before them."""

import numpy as np

from feederscrew.tooling import chain
from feederscrew.tooling.devices.hanging_rails import Rails
from feederscrew.tooling.hanging import neck
from feederscrew.tooling.proposal import told, weights
from feederscrew.tooling.verdicts import verdict


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
    device = _between(every[wanted], margin)
    if device is None or every[wanted].returned:
        return None
    found = [verdict(device, one, every) for one in every]
    same = np.array([one.hangs and one.margin >= margin for one in found])
    if not same[wanted]:
        return None
    margins = np.array([one.margin for one in found])
    gone = (margins <= -margin) | ~given.stays | (given.coming <= 0.0)
    before = chain.candidates(every, wanted, margin)
    devices = chain.fewest(before, np.where(gone | same, 0.0, weights(given)), margin)
    must = [some & ~gone & ~same for some in chain.shared_out(before, devices, margin)]
    cuts = chain.placed(every, wanted, devices, must)
    returned = np.any([gone, *must], axis=0)
    if np.any(~returned & ~same & given.often):
        return None
    last = chain.judged(every, wanted, device, margins <= -margin, *_ends(every[wanted], device))
    return told(given, (*cuts, last), returned, same)


def _between(one, margin):
    """Rails about the foot of the centre of mass, midway between shank and head; None without a head.

    None either where the slot would leave no rail by the wall, or none at the free edge of the track.
    """
    found = neck(one)
    if found is None or found.head - found.shank < 2.0 * margin:
        return None
    return _rails(one, 0.5 * (found.shank + found.head))


def _ends(one, device):
    found = neck(one)
    return tuple(_rails(one, width) or device for width in (found.shank, found.head))


def _rails(one, width):
    middle = one.distance - one.shift
    first = chain.fine(middle - 0.5 * width)
    span = first, first + chain.fine(width)
    if first <= 0.0 or span[1] >= one.track.width:
        return None
    text = f"{{from: {chain.millimetres(span[0])}, to: {chain.millimetres(span[1])}}}"
    return Rails(chain.WHERE, span=span, text=text)
