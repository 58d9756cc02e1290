"""Air along the face of a blade, where trials or queues show that parts stand at it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from feederscrew.bowl.devices.air_assist import AirAssist
from feederscrew.bowl.devices.blades import SweptBlade
from feederscrew.bowl.devices.pneumatics import (
    JET_BORE_M,
    JET_PRESSURE_PA,
    MAX_JET_PRESSURE_PA,
    REGULATOR_STEP_PA,
    pressure_for,
    thrust,
)
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.hanging import HELD_FATES
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.short_trials import ShortTrial
from feederscrew.sorting.orientations import Orientation
from feederscrew.sorting.verdicts import DeviceEncounter

# mean force along the face over the friction of the track, mu m g, of the part that it pushes least: chosen
# on an eyelet, at whose wiper 6 of 10 on their side stand without air, and none at 6 of these
PUSHES = (3.0, 6.0, 1.5)
HEIGHTS = 8  # of the nozzle, from the blade's edge to the top of what stands
HEIGHT_DECIMALS = 4  # of a height in metres: it is rounded to 0.1 mm
STRONGER = 2.0  # times the pressure, where a queue shows that parts still stand


def blade_place(proposal: Proposal) -> int | None:
    """Return the place among its cuts of the last blade of a chain that has a face; None without one.

    Parameters
    ----------
    proposal : Proposal

    Returns
    -------
    int or None
    """
    places = [
        place
        for place, cut in enumerate(proposal.cuts)
        if isinstance(cut.device, SweptBlade)
        and cut.device.action is Action.OVERHEAD
        and cut.device.face is not None
    ]
    return places[-1] if places else None


def blade_of(proposal: Proposal) -> SweptBlade | None:
    """Return the last blade of a chain that has a face; None without one.

    Parameters
    ----------
    proposal : Proposal

    Returns
    -------
    SweptBlade or None
    """
    place = blade_place(proposal)
    device = None if place is None else proposal.cuts[place].device
    return device if isinstance(device, SweptBlade) else None


def assist(
    proposal: Proposal, trial: ShortTrial, stands: Sequence[int], orientations: Sequence[Orientation]
) -> Iterator[Proposal]:
    """Yield a chain with air along the face of its blade, for what came to stand there.

    The nozzle is at the height at which the least thrust pushes all of these, and leaves what passes below
    the blade. Pressures follow from ``PUSHES``.

    Parameters
    ----------
    proposal : Proposal
        With a blade that has a face.
    trial : ShortTrial
        Of the proposal: it shows what is wanted.
    stands : sequence of int
        Orientations that came to stand, in the trial or in a queue.
    orientations : sequence of Orientation

    Yields
    ------
    Proposal
        Nothing where the blade has air, or meets none of those that stand.
    """
    blade, wanted = blade_of(proposal), trial.wanted
    if blade is None or blade.air is not None or not wanted:
        return
    high = [orientations[row] for row in stands if row not in wanted]
    high = [orientation for orientation in high if orientation.height > blade.lowest]
    if not high:
        return
    states = [trial.orientations.states[k] for k in trial.states]
    passing = [state for state in states if state.height <= blade.lowest]
    top = max(orientation.height for orientation in high)
    tried = np.linspace(blade.lowest + 0.5 * JET_BORE_M, max(top, blade.lowest + JET_BORE_M), HEIGHTS)
    heights = {
        float(height): _least_push(blade, float(height), high) for height in tried.round(HEIGHT_DECIMALS)
    }
    for push in PUSHES:
        for height in sorted(heights, key=lambda height: -heights[height]):
            air = _air_for(push, heights[height], height)
            if air is not None and all(_leaves(blade.with_air(air), state, states) for state in passing):
                yield with_air(proposal, air)
                break


def stronger(proposal: Proposal) -> Proposal | None:
    """Return a chain with more air along the face of its blade, where parts still stand at it.

    Parameters
    ----------
    proposal : Proposal

    Returns
    -------
    Proposal or None
        None where its blade has no air, or the net does not give more.
    """
    blade = blade_of(proposal)
    if blade is None or blade.air is None or STRONGER * blade.air.pressure > MAX_JET_PRESSURE_PA:
        return None
    return with_air(proposal, blade.air._replace(pressure=STRONGER * blade.air.pressure))


def with_air(proposal: Proposal, air: AirAssist) -> Proposal:
    """Return a chain with air along the face of its last blade that has one.

    Parameters
    ----------
    proposal : Proposal
    air : AirAssist

    Returns
    -------
    Proposal
        Itself without such a blade.
    """
    place, blade = blade_place(proposal), blade_of(proposal)
    if place is None or blade is None:
        return proposal
    cut, changed = proposal.cuts[place], blade.with_air(air)
    ends = [end.with_air(air) if isinstance(end, SweptBlade) else end for end in (cut.smallest, cut.largest)]
    own = replace(cut, device=changed, smallest=ends[0], largest=ends[1])
    return proposal.with_cut(place, own, Move(MoveKind.AIR_ASSIST, air.pressure, blade.kind, air.text))


def keep_air(proposal: Proposal, changed: Proposal) -> Proposal:
    """Return a changed chain with the air that its blade had, as high over the blade's edge as before.

    Parameters
    ----------
    proposal : Proposal
        As it was.
    changed : Proposal
        With the same kind of blade.

    Returns
    -------
    Proposal
    """
    before, after = blade_of(proposal), blade_of(changed)
    if before is None or after is None or before.air is None or after.air is not None:
        return changed
    height = round(before.air.height + after.lowest - before.lowest, HEIGHT_DECIMALS)
    return replace(with_air(changed, before.air._replace(height=height)), move=changed.move)


def score(trial: ShortTrial, proposal: Proposal) -> float:
    """Return how good a chain would be, stood none at its blade that is not wanted.

    Parameters
    ----------
    trial : ShortTrial
    proposal : Proposal
        That was tried.

    Returns
    -------
    float [1]
        Efficiency, less three times the share that leaves wrongly, or stands elsewhere.
    """
    blade, wanted = blade_of(proposal), trial.wanted
    placed = [device for device in proposal.devices if device.action.has_place]
    station = placed.index(blade) + 1 if blade in placed else -1
    elsewhere = 0.0
    for n, row in enumerate(trial.rows.tolist()):
        held = sum(
            count
            for end, count in trial.ends[n].items()
            if end.fate in HELD_FATES and (row in wanted or end.station != station)
        )
        elsewhere += float(trial.weights[n]) * held
    return trial.efficiency - 3.0 * (elsewhere + trial.wrong_share)


def _least_push(blade: SweptBlade, height: float, orientations: Sequence[Orientation]) -> float:
    """The mean force along the face over the track's friction [1], at a usual pressure, where it is least."""
    air, pushes = AirAssist(JET_BORE_M, JET_PRESSURE_PA, height), []
    for orientation in orientations:
        forces = air.at_face(orientation, blade.chord(orientation.track), blade.lowest)
        holds = DeviceEncounter(orientation).grip * orientation.posture.mass * orientation.gravity
        pushes.append(float(np.mean([force.along for force in forces])) / holds if forces else 0.0)
    return min(pushes)


def _air_for(push: float, least: float, height: float) -> AirAssist | None:
    """The air that gives a push [1], of which a usual pressure gives ``least``; None beyond the net's."""
    force = thrust(JET_BORE_M, JET_PRESSURE_PA) * push / max(least, 1e-9)
    if force > thrust(JET_BORE_M, MAX_JET_PRESSURE_PA):
        return None
    steps = math.ceil(pressure_for(JET_BORE_M, force) / REGULATOR_STEP_PA - 1e-6)
    return AirAssist(JET_BORE_M, steps * REGULATOR_STEP_PA, height)


def _leaves(blade: SweptBlade, orientation: Orientation, orientations: Sequence[Orientation]) -> bool:
    """Tell whether the air surely leaves an orientation that passes below a blade."""
    return blade.judged(DeviceEncounter(orientation, orientations)).margin > 0.0
