"""Chains of one or two turning devices that bring more parts into a wanted orientation."""

import itertools

import numpy as np

from feederscrew.bowl.devices import Device
from feederscrew.tooling import turning
from feederscrew.tooling.chain import WHERE, Cut, millimetres
from feederscrew.tooling.course import course
from feederscrew.tooling.verdicts import verdict

ROUND = 1e-4  # [m] to which a height or width is rounded
MORE = 1.05  # a chain is tried if it brings so many times what the best shorter one does
TRIED = 4  # chains of each length
HIGHEST = 2.0  # of the part's greatest length: no higher step


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
    matrices = {device: _matrix(given, device) for device in devices}
    start, found = given.coming[given.wanted], []
    for count in (1, 2):
        some = [
            (_brought(given, [matrices[device] for device in chosen]), chosen)
            for chosen in itertools.permutations(devices, count)
        ]
        best = sorted((one for one in some if one[0] > MORE * start), key=lambda one: -round(one[0], 9))
        found += [chosen for _, chosen in best[:TRIED]]
        start = max([start, *(brought for brought, _ in best)])
    return [_cuts(given, chosen) for chosen in found]


def _devices(given):
    """Steps and ledges, one between each two values at which what they do changes."""
    every = given.every
    often = [one for one, some in zip(every, given.often & given.stays) if some]
    longest = max(max(one.length, one.width, one.height) for one in often) if often else 0.0
    turns = [turning.pitched(one, every) for one in often]
    heights = {end for turn in turns for end in (turn.lift, turn.sure)}
    made = [Device("step", WHERE, limit=limit) for limit in _between(heights, HIGHEST * longest)]
    widths = {one.balcony for one in often if np.isfinite(one.balcony)}
    made += [Device("tip", WHERE, limit=limit) for limit in _between(widths, 0.0)]
    return [Device(one.kind, WHERE, limit=one.limit, text=millimetres(one.limit)) for one in made]


def _between(values, most):
    """Rounded middles between values, and one above them all where it may be that much."""
    known = sorted(values)
    middles = [0.5 * (low + high) for low, high in itertools.pairwise(known)]
    middles += [1.1 * known[-1]] if known and 1.1 * known[-1] < most else []
    return sorted({round(round(one / ROUND) * ROUND, 9) for one in middles if one > 2.0 * ROUND})


def _sure(given, device):
    """Whether the wanted orientation, if it comes often, stays or turns by the margin."""
    one = given.every[given.wanted]
    if one.falls_off or not given.often[given.wanted]:
        return not one.falls_off
    return verdict(device, one, given.every).margin >= given.margin


def _matrix(given, device):
    return course((device,), given.every).matrices[0]


def _brought(given, matrices):
    """Share of the parts that is in the wanted orientation behind some devices."""
    share = given.coming
    for matrix in matrices:
        share = np.einsum("i,ij->j", share, matrix)
    return float(share[given.wanted])


def _cuts(given, devices):
    """Turning devices as cuts of a design, the second with what the first brings to it."""
    cuts, coming = [], given.coming
    for device in devices:
        told = [verdict(device, one, given.every) for one in given.every]
        moved = [
            (given.every[k].name, given.every[onto].name, float(share))
            for k, one in enumerate(told)
            for onto, share in one.onto
            if onto != k and coming[k] > 0.0
        ]
        turned = [one.margin for k, one in enumerate(told) if coming[k] > 0.0 and one.onto[0][0] != k]
        cuts.append(
            Cut(
                device=device,
                margin_pass=float(told[given.wanted].margin) if coming[given.wanted] > 0.0 else np.nan,
                margin_reject=float(min((one for one in turned if one > 0.0), default=np.nan)),
                smallest=device,
                largest=device,
                returns=(),
                turns=tuple(moved),
            )
        )
        coming = np.einsum("i,ij->j", coming, _matrix(given, device))
    return tuple(cuts)
