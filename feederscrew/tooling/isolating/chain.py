"""The fewest devices of one number that let one orientation pass and return the others."""

import itertools
from dataclasses import dataclass

import numpy as np

from feederscrew.tooling.devices.base import STOPPED, UNSURE, Device
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.falling_through import surely_gone
from feederscrew.tooling.isolating.shop_values import FINE, STEP, fine, snapped
from feederscrew.tooling.verdicts import Meeting, verdict

WHERE = "design"
HALVINGS = 10  # of the way from the value nearest to the wanted orientation to the middle


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
    stops: tuple[str, ...] = ()  # names of the orientations that come to stand at it


@dataclass(frozen=True)
class Wishes:
    """What a design may use, and how finely it is made."""

    outcome: str = "any"  # how parts leave: 'lying', 'hanging' or 'any'
    without: tuple[str, ...] = ()  # kinds of devices that are not used
    step: float = STEP  # [m] a shop makes: values are whole multiples
    up: tuple[str, ...] = ()  # aspects that count as the one wanted
    cutter: float = 0.0  # [m] radius that corners of holes are rounded to
    separation: Device | None = None  # that comes before a device that needs gaps
    vary: bool = True  # other tracks and sweeps are tried where they give more
    gentle: bool = False  # cuts take no more of the wanted orientation's foot than they must
    turn: bool = False  # devices that turn parts over, where returning them wastes too much
    air: bool = False  # air that blows all the time, where cuts and blades are not enough

    def allows(self, *kinds):
        """Return whether some kinds of devices may all be used."""
        return not set(kinds) & set(self.without)

    @property
    def sensed(self):
        """Whether a sensor may be used."""
        return any(self.allows(kind.kind) for kind in around())

    @property
    def clearing(self):
        """Whether a blade that clears itself may be used."""
        return any(self.allows(kind.kind) for kind in numbered() if kind.overhead)


def candidates(every, wanted, margin, wishes=None, *, clearing=True, air=False, sensed=False, same=()):
    """Return every device of one number that the wanted orientation passes by a margin.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    every : sequence of Orientation
    wanted : int
        Its place among them.
    margin : float [m]
    wishes : Wishes, optional
    same : sequence of int
        Those that count as the wanted one: a device of one number lets all of them pass.
    clearing, air, sensed : bool
        Whether what has to clear itself, air that blows all the time, and what sees, is tried beside what
        drops parts.

    Returns
    -------
    dict of Device to (M,) float [m]
        The device at which it returns the most, with the margin of each orientation at it; NaN of one that
        would come to stand there. What drops parts comes first, then what clears itself.
    """
    found, wishes = {}, wishes or Wishes()
    for kind in numbered():
        values, lower = limits(kind, every), kind.bound == "lower"
        first = pivot(kind, every, wanted, same)
        if not wishes.allows(kind.kind) or not np.isfinite(values[first]) or (kind.overhead and not clearing):
            continue
        play = margin + kind(WHERE).hop_blur(every[first])
        if lower and values[first] <= 2.0 * play:
            continue
        limit = snapped(values[first] + (-play if lower else play), wishes.step, up=not lower)
        device = kind.proposal(WHERE, limit)
        if limit > 0.0 and device.acts(every[wanted].track):
            found[device] = np.array([margin_at(device, one, every) for one in every])

    for kind in blowing() if air else ():
        rows = sorted({wanted, *same})
        meetings = [Meeting(one, every) for one in every]
        others = [met for k, met in enumerate(meetings) if k not in rows]
        for device in kind.proposals([meetings[k] for k in rows], others, every, WHERE):
            found[device] = np.array([margin_at(device, one, every) for one in every])

    def unlike(view):
        others = [every[k] for k in same if k != wanted]
        return [one for one in others if Meeting(one).differs(every[wanted], view) > margin]

    for kind in around() if sensed else ():
        if wishes.allows(kind.kind):
            for device in kind.around(Meeting(every[wanted], every), margin, WHERE, unlike):
                found[device] = np.array([margin_at(device, one, every) for one in every])
    return found


def pivot(kind, every, wanted, same=()):
    """Return which of those that count as the wanted one a device of one number lets pass last."""
    values = limits(kind, every)
    rows = sorted({wanted, *same}, key=lambda k: k != wanted)
    return (max if kind.bound == "upper" else min)(rows, key=lambda k: values[k])


def around():
    """Return the kinds that a design tries with the wanted orientation's own outline."""
    return [kind for kind in KINDS.values() if kind.proposed and kind.senses]


def blowing():
    """Return the kinds that a design tries that blow all the time."""
    return [kind for kind in KINDS.values() if kind.proposed and not (kind.senses or kind.bound)]


def margin_at(device, one, every):
    """Return the margin [m] of an orientation at a device; NaN of one that comes to stand there.

    None, a hair below 0, of one that travels and may be held there, though it is not supported.
    """
    margin = verdict(device, one, every).margin
    if not margin < 0.0:
        return margin
    if device.fate(Meeting(one, every)) == STOPPED:
        return np.nan
    return margin if one.grip <= 0.0 or surely_gone(device, one) else max(margin, -UNSURE)


def numbered():
    """Return the kinds of one number that a design tries, in the order of their ranks: drops first."""
    kinds = [kind for kind in KINDS.values() if kind.proposed and kind.bound]
    return sorted(kinds, key=lambda kind: kind.rank)


def limits(kind, every):
    """Return the value [m] of a device of one number that each orientation just passes, (M,)."""
    return np.array([kind.needed(one) for one in every])


def fewest(found, others, margin, enough=0.0):
    """Return the fewest devices that return the most of some orientations.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    found : dict of Device to (M,) float [m]
        From ``candidates``.
    others : (M,) float [1]
        How much each of the orientations to be returned weighs; 0 for those that need not be.
    margin : float [m]
    enough : float [1]
        Of what may be left over: a chain that leaves no more is not made longer.

    Returns
    -------
    tuple of Device
        In the order of ``candidates``.
    """
    best, weight, total = (), 0.0, float(others.sum())
    devices = [device for device, some in found.items() if others[some <= -margin].any()]
    for count in range(1, len(devices) + 1):
        if total - weight <= enough:
            break
        for chosen in itertools.combinations(devices, count):
            returned = np.any([found[device] <= -margin for device in chosen], axis=0)
            held = float(others[returned].sum())
            if held > weight + 1e-12 and not jams(found, chosen, others, margin):
                best, weight = chosen, held
    return best


def jams(found, chosen, others, margin):
    """Return whether an orientation that weighs comes to stand at a device, not returned before it."""
    gone = np.asarray(others) <= 0.0
    for device in chosen:
        if np.any(np.isnan(found[device]) & ~gone):
            return True
        gone = gone | (found[device] <= -margin)
    return False


def placed(every, wanted, devices, must, least=np.inf, step=FINE, same=()):
    """Return the cuts of a chain, each value in the middle of what it may be.

    Source: own; docs/tooling.md, "5. Where it ends".

    Parameters
    ----------
    every : sequence of Orientation
    wanted : int
    devices : sequence of Device
    must : sequence of (M,) bool
        Which orientations each device has to return.
    least : float [m]
        What leaves less of a foot returns them by no more than this: the wanted orientation has the rest.
    step : float [m]
        Values are whole multiples of it.
    same : sequence of int
        As for ``candidates``.

    Returns
    -------
    tuple of Cut
    """
    rows = [pivot(type(device), every, wanted, same) if device.bound else wanted for device in devices]
    given = zip(rows, devices, must)
    return tuple(_cut(every, row, device, some, least, step) for row, device, some in given)


def shared_out(found, devices, margin):
    """Return for each device (M,) which orientations it has to return: those that none before it does."""
    left, out = np.ones(len(next(iter(found.values()))), dtype=bool), []
    for device in devices:
        out.append(left & (found[device] <= -margin))
        left &= ~out[-1]
    return out


def _cut(every, wanted, device, must, least, step):
    if device.senses:
        return _sensor(every, wanted, device, must, step)
    if not device.bound:
        return judged(every, wanted, device, must, device, device)
    values, upper = limits(type(device), every), device.bound == "upper"
    values = values + np.where(np.arange(len(every)) == wanted, 0.0, _more(device, every))
    nearest = (values[must].min() if upper else values[must].max()) if must.any() else values[wanted]
    middle = float(0.5 * (values[wanted] + nearest))

    def at(value):
        value = fine(snapped(value, step, up=not upper)) if step > FINE else fine(value)
        return device.valued(value)

    chosen = _surest(every, must, at, middle if np.isfinite(nearest) else device.limit, device.limit)
    if device.carries and least < np.inf:
        eased = max(chosen.limit, nearest - least) if upper else min(chosen.limit, nearest + least)
        chosen = _surest(every, must, at, float(eased), chosen.limit, least - 2.0 * FINE)
    ends = [device.valued(float(end)) for end in (nearest, values[wanted])]
    return judged(every, wanted, chosen, must, *ends)


def _sensor(every, wanted, device, must, step):
    least = device.like[2]
    outside = [device.differs(Meeting(one, every)) for one, some in zip(every, must) if some]
    widest = min(outside, default=2.0 * least)

    def at(play):
        play = fine(max(snapped(play, step, up=False), least))
        return device.with_play(play)

    own = device.differs(Meeting(every[wanted], every))
    chosen = _surest(every, must, at, 0.5 * (own + widest), least)
    return judged(every, wanted, chosen, must, at(widest), at(least))


def _more(device, every):
    """By how much more [m] than placed each orientation passes a device as it travels, (M,)."""
    return np.array([device.more(Meeting(one)) for one in every])


def _surest(every, must, at, middle, near, by=UNSURE):
    """The device of a value midway, or as near to that as it still returns what it has to, by a margin."""

    def returns(device):
        return all(margin_at(device, one, every) < -by for one, some in zip(every, must) if some)

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
