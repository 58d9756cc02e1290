"""The fewest devices of one number that let one orientation pass and return the others."""

import itertools
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.tooling.devices.base import UNSURE, Device
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.verdicts import Meeting, gate_margin, opening_margin, verdict

WHERE = "design"
HALVINGS = 10  # of the way from the value nearest to the wanted orientation to the middle
FINE = 1e-7  # [m] to which a value is rounded


@dataclass(frozen=True)
class Cut:
    """One device of a design, with how much it may change."""

    device: Device
    margin_pass: float  # [m] by which the wanted orientation passes
    margin_reject: float  # [m] by which the nearest of those it must return fails
    smallest: Device  # the least cut that still returns them
    largest: Device  # the greatest cut that the wanted orientation still passes
    returns: tuple[str, ...]  # names of the orientations it returns
    turns: tuple[tuple[str, str, float], ...] = ()  # name, name it turns over into, share


def candidates(every, wanted, margin):
    """Return every device of one number that the wanted orientation passes by a margin.

    Parameters
    ----------
    every : sequence of Orientation
    wanted : int
        Its place among them.
    margin : float [m]

    Returns
    -------
    dict of Device to (M,) float [m]
        The device at which it returns the most, with the margin of each orientation at it.
    """
    found = {}
    for kind in numbered():
        values, lower = limits(kind, every), kind.bound == "lower"
        if not np.isfinite(values[wanted]) or (lower and values[wanted] <= 2.0 * margin):
            continue
        limit = float(values[wanted] + (-margin if lower else margin))
        device = kind(WHERE, limit=limit)
        if limit > 0.0 and device.acts(every[wanted].track):
            found[device] = np.array([verdict(device, one, every).margin for one in every])
    for kind in around():
        gate = kind.around(every[wanted], margin, WHERE)
        opening = gate.free(every)
        found[gate] = np.array([gate_margin(opening, one) for one in every])
    return found


def numbered():
    """Return the kinds of one number that a design tries, what a greater cut makes of them last."""
    kinds = [kind for kind in KINDS.values() if kind.proposed and kind.bound]
    return sorted(kinds, key=lambda kind: (kind.bound == "lower", kind.rank))


def around():
    """Return the kinds of gates that a design tries, with the wanted orientation's own outline."""
    return [kind for kind in KINDS.values() if kind.proposed and hasattr(kind, "around")]


def limits(kind, every):
    """Return the value [m] of a device of one number that each orientation just passes, (M,)."""
    return np.array([kind.needed(one) for one in every])


def fewest(found, others, margin, enough=0.0):
    """Return the fewest devices that return the most of some orientations.

    Parameters
    ----------
    found : dict of Device to (M,) float [m]
        From ``candidates``.
    others : (M,) float
        How much each of the orientations to be returned weighs; 0 for those that need not be.
    margin : float [m]
    enough : float
        Of what may be left over: a chain that leaves no more is not made longer.

    Returns
    -------
    tuple of Device
        In the order of ``candidates``.
    """
    best, weight, total = (), 0.0, float(others.sum())
    devices = list(found)
    for count in range(1, len(devices) + 1):
        if total - weight <= enough:
            break
        for chosen in itertools.combinations(devices, count):
            returned = np.any([found[device] <= -margin for device in chosen], axis=0)
            held = float(others[returned].sum())
            if held > weight + 1e-12:
                best, weight = chosen, held
    return best


def placed(every, wanted, devices, must, least=np.inf):
    """Return the cuts of a chain, each value in the middle of what it may be.

    Parameters
    ----------
    every : sequence of Orientation
    wanted : int
    devices : sequence of Device
    must : sequence of (M,) bool
        Which orientations each device has to return.
    least : float [m]
        What leaves less of a foot returns them by no more than this: the wanted orientation has the rest.

    Returns
    -------
    tuple of Cut
    """
    return tuple(_cut(every, wanted, device, some, least) for device, some in zip(devices, must))


def shared_out(found, devices, margin):
    """Return for each device (M,) which orientations it has to return: those that none before it does."""
    left, out = np.ones(len(next(iter(found.values()))), dtype=bool), []
    for device in devices:
        out.append(left & (found[device] <= -margin))
        left &= ~out[-1]
    return out


def _cut(every, wanted, device, must, least):
    if not device.bound:
        return _gate(every, wanted, device, must)
    values, upper = limits(type(device), every), device.bound == "upper"
    values = values + np.where(np.arange(len(every)) == wanted, 0.0, _more(device, every))
    nearest = (values[must].min() if upper else values[must].max()) if must.any() else values[wanted]
    middle = float(0.5 * (values[wanted] + nearest))

    def at(value):
        return replace(device, limit=fine(value), text=millimetres(fine(value)))

    chosen = _surest(every, must, at, middle if np.isfinite(nearest) else device.limit, device.limit)
    if device.carries and least < np.inf:
        eased = max(chosen.limit, nearest - least) if upper else min(chosen.limit, nearest + least)
        chosen = _surest(every, must, at, float(eased), chosen.limit, least - 2.0 * FINE)
    ends = [replace(device, limit=float(end), text=millimetres(end)) for end in (nearest, values[wanted])]
    return judged(every, wanted, chosen, must, *ends)


def _more(device, every):
    """By how much more [m] than placed each orientation passes a device as it travels, (M,)."""
    return np.array([device.more(Meeting(one)) for one in every])


def _gate(every, wanted, device, must):
    least = device.like[2]
    outside = [-opening_margin(every[wanted].seen, one) for one, some in zip(every, must) if some]
    widest = min(outside, default=2.0 * least)

    def at(play):
        return device.with_play(play, millimetres(play))

    def rounded(play):
        return at(fine(play) if np.isfinite(widest) else play)

    chosen = _surest(every, must, rounded, 0.5 * widest if np.isfinite(widest) else least, least)
    return judged(every, wanted, chosen, must, at(widest), at(0.0))


def _surest(every, must, at, middle, near, by=UNSURE):
    """The device of a value midway, or as near to that as it still returns what it has to, by a margin."""

    def returns(device):
        return all(verdict(device, one, every).margin < -by for one, some in zip(every, must) if some)

    if returns(at(middle)):
        return at(middle)
    for _ in range(HALVINGS):
        half = 0.5 * (near + middle)
        near, middle = (half, middle) if returns(at(half)) else (near, half)
    return at(near)


def judged(every, wanted, device, must, smallest, largest):
    """Return a device as a Cut, with its true margins and what it returns."""
    margins = np.array([verdict(device, one, every).margin for one in every])
    return Cut(
        device=device,
        margin_pass=float(margins[wanted]),
        margin_reject=float(-margins[must].max()) if must.any() else np.nan,
        smallest=smallest,
        largest=largest,
        returns=tuple(one.name for one, margin in zip(every, margins) if margin < 0.0),
    )


def millimetres(value):
    """Return a length as a bowl file has it, to a tenth of a micrometre: '9.25 mm'."""
    return f"{1e3 * fine(value):.9g} mm"


def fine(value):
    """Return a length rounded to what a bowl file says of it."""
    return float(np.round(value / FINE)) * FINE
