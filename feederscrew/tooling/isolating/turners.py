"""Chains of one or two turning devices that bring more parts into a wanted orientation."""

import itertools

import numpy as np

from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating.chain import DESIGN_KEY, Cut
from feederscrew.tooling.isolating.proposal import LEAST_SHARE
from feederscrew.tooling.verdicts import Meeting, verdict

TURNER_STEP_M = 1e-4  # [m] to which a height or width is rounded
TURNER_GAIN = 1.05  # a chain is tried if it brings so many times what the best shorter one does
TRIED = 4  # chains of each length
MAX_STEP_SHARE = 0.5  # of the part's greatest length: over a higher step it tumbles freely


def chains(given):
    """Return the chains worth a design behind them: those that bring most parts into the wanted orientation.

    Parameters
    ----------
    given : DesignTask

    Returns
    -------
    list of tuple of Cut
        Single devices first, then pairs; their order matters.
    """
    devices = [device for device in _devices(given) if _sure(given, device)]
    matrices = {device: _counted(given, device) for device in devices}
    start, found = given.coming[given.wanted], []
    for count in (1, 2):
        some = [
            (_brought(given, [matrices[device] for device in chosen]), chosen)
            for chosen in itertools.permutations(devices, count)
        ]
        best = sorted(
            (one for one in some if one[0] > TURNER_GAIN * start), key=lambda one: -round(one[0], 9)
        )
        found += [chosen for _, chosen in best[:TRIED]]
        start = max([start, *(brought for brought, _ in best)])
    return [_cuts(given, chosen) for chosen in found]


def _devices(given):
    """Steps and ledges, one between each two values at which what they do changes."""
    every = given.every
    often = [one for one, some in zip(every, given.often & given.stays) if some]
    longest = max((max(one.length, one.height) for one in often), default=0.0)
    kinds = [kind for kind in KINDS.values() if kind.turns]
    made = [_device(kind, one) for kind in kinds for one in _between(_changes(given, kind))]
    return [one for one in made if one.inwards or one.limit <= MAX_STEP_SHARE * longest]


def _changes(given, kind):
    """Values [m] at which a device changes what it does with an orientation that comes often, ascending."""
    often = [one for one, some in zip(given.every, given.often & given.stays) if some]
    return kind.changes([Meeting(one, given.every) for one in often])


def _between(known):
    """Rounded middles between ascending values, and one above them all."""
    middles = [0.5 * (low + high) for low, high in itertools.pairwise(known)]
    middles += [1.1 * known[-1]] if known else []
    return sorted(
        {round(round(one / TURNER_STEP_M) * TURNER_STEP_M, 9) for one in middles if one > 2.0 * TURNER_STEP_M}
    )


def _device(kind, limit):
    return kind(DESIGN_KEY).valued(float(limit))


def _sure(given, device):
    """Whether a device does by the margin with the wanted orientation what it does."""
    return verdict(device, given.every[given.wanted], given.every).margin >= given.margin


def _matrix(given, device):
    return course((device,), given.every).matrices[0]


def _counted(given, device):
    """Matrix of a device in which what momentum may decide counts as lost."""
    matrix = np.array(_matrix(given, device))
    some = [verdict(device, one, given.every).margin >= given.margin for one in given.every]
    matrix[~np.array(some)] = 0.0
    return matrix


def _brought(given, matrices):
    """Share of the parts that is in the wanted orientation behind some devices."""
    share = given.coming
    for matrix in matrices:
        share = np.einsum("i,ij->j", share, matrix)
    return float(share[given.wanted])


def _around(known, limit):
    """The values nearest to a limit at which what its device does changes; itself where there is none."""
    below = [one for one in known if one <= limit]
    above = [one for one in known if one >= limit]
    return max(below, default=limit), min(above, default=limit)


def _cuts(given, devices):
    """Turning devices as cuts of a design, the second with what the first brings to it."""
    cuts, coming = [], given.coming
    for device in devices:
        listed = [verdict(device, one, given.every) for one in given.every]
        moved = [
            (given.every[k].name, given.every[onto].name, float(share))
            for k, one in enumerate(listed)
            for onto, share in one.onto
            if onto != k and coming[k] >= LEAST_SHARE
        ]
        often = [one.margin for one, share in zip(listed, coming) if share >= LEAST_SHARE]
        below, above = _around(_changes(given, type(device)), device.limit)
        cuts.append(
            Cut(
                device=device,
                margin_pass=float(min((one for one in often if one >= given.margin), default=np.nan)),
                margin_reject=np.nan,
                smallest=_device(type(device), below),
                largest=_device(type(device), above),
                returns=(),
                turns=tuple(moved),
            )
        )
        coming = np.einsum("i,ij->j", coming, _matrix(given, device))
    return tuple(cuts)
