"""How long the pulse of air is that a sensor sets off: the shorter, the more parts pass it a minute."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from feederscrew.designing.trying import Tried
from feederscrew.tooling.devices.pneumatics import PULSE
from feederscrew.tooling.isolating.chain import Cut
from feederscrew.tooling.orientations import Orientation
from feederscrew.tooling.verdicts import DeviceEncounter

STEP, LEAST = 5e-3, 4  # [s] to which a pulse is set, and of how many of them the shortest one is
RESERVE = 6.0  # times as long as takes off what stands before the nozzles: they do not blow at its middle
LONGER = 2.0  # times, where something is carried through all the same


def quickened(cut: Cut, every: Sequence[Orientation]) -> Cut:
    """Return a cut whose pulse is the shortest that blows off what it returns, with a reserve.

    Source: own; docs/design.md, "The loop".

    Parameters
    ----------
    cut : Cut
    every : sequence of Orientation
        Of the part.

    Returns
    -------
    Cut
        Itself where its pulse is as short, or it has none.
    """
    device: Any = cut.device  # a sorter, where it senses
    if not device.senses:
        return cut
    gone = [DeviceEncounter(one, every) for one in every if one.name in cut.returns]
    pushes = [device.jet.push(met.orientation, every) for met in gone]
    for steps in range(LEAST, round(device.time / STEP)):
        time = steps * STEP
        if all(met.blown(out, down, time / RESERVE) > 0.0 for met, (out, down) in zip(gone, pushes)):
            return replace(cut, device=_timed(device, time))
    return cut


def longer(proposal: Any, tried: Tried, every: Sequence[Orientation]) -> Any:
    """Return a proposal with a longer pulse where something is carried through that it should blow off.

    Parameters
    ----------
    proposal : Proposal
    tried : Tried
    every : sequence of Orientation

    Returns
    -------
    Proposal or None
        None where nothing is, or the pulse is as long as it was proposed.
    """
    for place, cut in enumerate(proposal.cuts):
        device: Any = cut.device
        slipped = any(tried.wrong[n] and every[k].name in cut.returns for n, k in enumerate(tried.rows))
        if not device.senses or not slipped or device.time >= PULSE:
            continue
        other = _timed(device, min(LONGER * device.time, PULSE))
        cuts = (*proposal.cuts[:place], replace(cut, device=other), *proposal.cuts[place + 1 :])
        return replace(proposal, cuts=cuts, step=f"pulse of {_milliseconds(other.time)}")
    return None


def _timed(device: Any, time: float) -> Any:
    return device.with_pulse(time)


def _milliseconds(time: float) -> str:
    return f"{1e3 * time:.0f} ms"
