"""More to choose from where what is tried first isolates nothing: other sweeps of a blade."""

import math
from dataclasses import replace

import numpy as np

from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.isolating import chain
from feederscrew.tooling.isolating.shop_values import snapped

VARIED_SWEEPS_DEG = (20.0, 45.0, 55.0)  # [deg] beside the 30 deg of the first design


def varied(every, wanted, margin, wishes, same=()):
    """Return blades of sweeps that are not tried first, with the margin of each orientation at them.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    every : sequence of Orientation
    wanted : int
    margin : float [m]
    wishes : Wishes
    same : sequence of int
        Those that count as the wanted one.

    Returns
    -------
    dict of Device to (M,) float [m]
        As from ``chain.candidates``.
    """
    found: dict[Device, np.ndarray] = {}
    for kind in (kind for kind in chain.numbered() if kind.overhead and wishes.allows(kind.kind)):
        highest = every[chain.pivot(kind, every, wanted, same)].height
        limit = snapped(highest + margin, wishes.step, up=True)
        swept = [
            replace(kind.proposal(chain.DESIGN_KEY, limit), sweep=math.radians(sweep))
            for sweep in VARIED_SWEEPS_DEG
        ]
        found |= {one: _margins(one, every) for one in swept if one.clear_of(every[wanted].grip)}
    return found


def _margins(device, every):
    return np.array([chain.margin_at(device, one, every) for one in every])
