"""More to choose from where what is tried first isolates nothing: other sweeps, and steady jets."""

import math
from dataclasses import replace

import numpy as np

from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.devices.steady_jets import BORE, STEPS
from feederscrew.tooling.isolating import chain
from feederscrew.tooling.verdicts import Meeting

SWEEPS = (20.0, 45.0, 55.0)  # [deg] beside the 30 deg of the first design
JETS = 3  # at most, of those at all heights: those that return the most


def varied(every, wanted, margin, wishes, weight, same=()):
    """Return devices of values that are not tried first, with the margin of each orientation at them.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    every : sequence of Orientation
    wanted : int
    margin : float [m]
    wishes : Wishes
    weight : (M,) float [1]
        How much it matters to return each orientation.
    same : sequence of int
        Those that count as the wanted one.

    Returns
    -------
    dict of Device to (M,) float [m]
        As from ``chain.candidates``.
    """
    found = {}
    if wishes.allows("wiper"):
        found |= _swept(every, wanted, margin, wishes, same)
    if wishes.allows("jet") and every[wanted].speed > 0.0:
        jets = _jets(every, sorted({wanted, *same}), wishes)
        best = sorted(jets, key=lambda one: -float(weight[jets[one] <= -margin].sum()))
        found |= {device: jets[device] for device in best[:JETS]}
    return found


def _swept(every, wanted, margin, wishes, same):
    """Blades of other sweeps at the clearance that the wanted orientation just passes by the margin."""
    kind = KINDS["wiper"]
    highest = every[chain.pivot(kind, every, wanted, same)].height
    limit = chain.snapped(highest + margin, wishes.step, up=True)
    swept = [replace(kind.proposal(chain.WHERE, limit), sweep=math.radians(sweep)) for sweep in SWEEPS]
    return {device: _margins(device, every) for device in swept if device.clear_of(every[wanted].grip)}


def _jets(every, same, wishes):
    """Jets at the heights between the tops of the orientations, each of a force amid what it may be."""
    mets, found = [Meeting(one, every) for one in every], {}
    for height in _heights(every, wishes.step):
        unit = KINDS["jet"](chain.WHERE, height=height)
        _, strongest = unit.window([mets[k] for k in same], [])
        factors = np.array([strongest.factor(met) for met in mets])
        goes = [met for met, factor in zip(mets, factors) if factor >= 2.0]
        device = amid(*unit.window([mets[k] for k in same], goes)) if goes else None
        if device is not None:
            found[device] = _margins(device, every)
    return found


def amid(weakest, strongest):
    """Return the jet of a pressure amid two, in steps of a shop; None if none of them lies between.

    Amid in force: the margin of a jet is a factor of it.
    """
    middle = strongest.blowing(math.sqrt(weakest.jet.thrust * strongest.jet.thrust)).pressure
    for step in STEPS:
        pressure = step * round(middle / step)
        if 0.0 < weakest.pressure <= pressure <= strongest.pressure:
            return strongest.with_pressure(pressure)
    return None


def _heights(every, step):
    """Heights [m] of a nozzle: half as high as each orientation, and between the tops of two."""
    tops = np.unique(np.round([one.height for one in every], 5))
    middles = [*(0.5 * tops), *(0.5 * (tops[1:] + tops[:-1]))]
    found = [chain.fine(chain.snapped(height, step, up=True)) for height in middles]
    return sorted({height for height in found if height >= BORE / 2.0})


def _margins(device, every):
    return np.array([chain.margin_at(device, one, every) for one in every])
