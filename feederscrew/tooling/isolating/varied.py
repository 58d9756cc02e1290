"""More to choose from where what is tried first isolates nothing: other sweeps of a blade."""

import math
from dataclasses import replace

import numpy as np

from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.isolating import chain

SWEEPS = (20.0, 45.0, 55.0)  # [deg] beside the 30 deg of the first design


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
    if not wishes.allows("wiper"):
        return {}
    kind = KINDS["wiper"]
    highest = every[chain.pivot(kind, every, wanted, same)].height
    limit = chain.snapped(highest + margin, wishes.step, up=True)
    swept = [replace(kind.proposal(chain.WHERE, limit), sweep=math.radians(sweep)) for sweep in SWEEPS]
    return {device: _margins(device, every) for device in swept if device.clear_of(every[wanted].grip)}


def _margins(device, every):
    return np.array([chain.margin_at(device, one, every) for one in every])
