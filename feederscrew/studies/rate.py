"""The study of ``feeder rate``: well-oriented parts per minute of one part from one bowl."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.bowl.devices import Device, strangers
from feederscrew.bowl.record import Bowl
from feederscrew.machine import speeds
from feederscrew.part.record import Part
from feederscrew.rates import queue
from feederscrew.resting.aspects import Aspects, find

ALIKE = 1.0 - 1e-9  # of the most frequent orientation: as frequent


@dataclass(frozen=True, eq=False)
class RateStudy:
    """The rate of one orientation, and the chain of factors behind it."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    devices: tuple[Device, ...]  # in the order parts meet them
    rule: str  # whose probabilities are taken
    rate: queue.Rate

    @property
    def warnings(self):
        """What a user must not overlook, a sentence each: of the devices, the aspects, the velocity."""
        odd = speeds.remark(self.rate.velocity.value, self.bowl.sizing)
        return (*strangers(self.devices, self.aspects.names), *self.aspects.warnings, *odd)


def rate(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: float | None = None,
    rule: str = "recommended",
    devices: Sequence[Device] | None = None,
    gap: float = 0.0,
    fill: float = 1.0,
    sigma: float = 0.0,
    aspects: Aspects | None = None,
) -> RateStudy:
    """Study how many well-oriented parts leave a bowl.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        The one wanted, as ``feeder aspects`` names it; without it the orientation that leaves the bowl
        most often.
    heading : float [rad], optional
        Of that aspect; without one, the most frequent that stays on the track.
    rule : str
        Whose probabilities are taken.
    devices : sequence of Device
        Along the track, in the order parts meet them; those of the bowl without it.
    gap : float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    aspects : Aspects, optional
        Of the part, where they are known already.

    Returns
    -------
    RateStudy

    Raises
    ------
    FeederError
        If the part has no outline or no such aspect, no such rule has probabilities of it, or the bowl has
        no steady state.
    """
    chain = bowl.devices if devices is None else tuple(devices)
    found = find(part) if aspects is None else aspects
    target = None if aspect is None else queue.wanted(part, found, bowl.track, aspect, heading)
    known = queue.orientations(part, found, bowl.track, chain, sigma)
    speed = queue.velocity(bowl)
    target = most_frequent(known, rule) if target is None else target
    return RateStudy(
        part=part,
        bowl=bowl,
        aspects=found,
        devices=chain,
        rule=rule,
        rate=queue.rate(known, speed, target, rule, gap=gap, fill=fill),
    )


def most_frequent(known, rule):
    """Return the aspect and the heading in which most parts leave the bowl.

    Parameters
    ----------
    known : Orientations
    rule : str
        Whose probabilities are taken.

    Returns
    -------
    (str, float [rad])
        Where none leaves, the ones most likely to land in.
    """
    chance = np.nan_to_num(known.rules[rule])
    lengths = np.array([one.length for one in known.states])
    leaving = ((chance[:, None] * known.leaving).sum(axis=0) / lengths)[known.leaves_as]
    weight = leaving if leaving.any() else chance
    row = int(np.argmax(weight >= ALIKE * weight.max()))  # the first of equals, whatever the rounding
    return known.aspects[row], known.headings[row]
