"""The study of ``feeder rate``: well-oriented parts per minute of one part from one bowl."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike

import numpy as np

from feederscrew import check
from feederscrew.bowl.devices import strangers
from feederscrew.bowl.record import Bowl
from feederscrew.machine import speeds
from feederscrew.part.record import Part
from feederscrew.rates import arrivals, well_oriented
from feederscrew.records import Shown
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.counts import profiles
from feederscrew.resting.rules.recommended import LAUNCH, launch_named
from feederscrew.studies.aspects import aspects as resting
from feederscrew.tooling.devices.base import Device

ALIKE = 1.0 - 1e-9  # of the most frequent orientation: as frequent
LEAST = 1e-6  # of what must be above 0
SEED = 1  # of the parts that are fed onto the moving floor


@dataclass(frozen=True, eq=False)
class Shares(Shown):
    """The aspects of a part with the one answer that is taken for their shares."""

    aspects: Aspects  # their ``recommended`` is that answer
    measured: profiles.Measured | None = None  # the file it was read from, if it was
    fed: bool = False  # whether they are what lies on the bowl's moving floor, at its own drive

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of the file, by its path."""
        return {} if self.measured is None else {self.measured.source: self.measured.sha256}


def shares(
    part: Part,
    bowl: Bowl,
    *,
    launch: str | None = None,
    probabilities: str | PathLike[str] | None = None,
    fed: bool = False,
    jobs: int | None = None,
    progress=None,
    before=None,
) -> Shares:
    """Return the aspects of a part with the answer that rate, report, tune, batch and tooling take.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        Its floor, for ``fed``.
    launch : str, optional
        What is done to the part; 'feed' without it.
    probabilities : str or Path, optional
        File of counts in place of an answer of ours, by aspect or by orientation.
    fed : bool
        Feed parts onto the moving floor of the bowl: what lies at the track's entry then.
    jobs : int, optional
        Cores for that; all there are without it. Nothing else depends on it.
    progress, before : function, optional
        Of drops and of parts on the floor, as for ``studies.aspects``.

    Returns
    -------
    Shares

    Raises
    ------
    FeederError
        Every fault of the file; if the part has no shape to drop.
    """
    launch = LAUNCH if launch is None else launch_named(launch)
    own = {"progress": progress, "before": before}
    if probabilities is not None:
        found = resting(part, drops=0).aspects
        measured = profiles.read(probabilities, found.names)
        return Shares(arrivals.counted(found, measured), measured)
    if not fed or part.vertices is None:
        return Shares(resting(part, launch=launch, **own).aspects)
    from feederscrew.dropping.plate.arrival import arrival

    found = resting(part, drops=0).aspects
    if np.count_nonzero(found.stable) < 2:
        return Shares(found)
    if before:
        before(None)
    floor = arrival(part, found, bowl, seed=SEED, jobs=jobs or os.cpu_count() or 1, progress=progress)
    arrived = arrivals.arrived(found, floor, SEED)
    return Shares(arrived, fed=arrived.recommended is not found.recommended)


@dataclass(frozen=True, eq=False)
class RateStudy(Shown):
    """The rate of one orientation, and the chain of factors behind it."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    devices: tuple[Device, ...]  # in the order parts meet them
    rule: str  # whose probabilities are taken
    rate: well_oriented.Rate
    measured: profiles.Measured | None = None  # the counts that are taken, if they are

    @property
    def parts(self) -> well_oriented.Range:
        """Well-oriented parts per second [1/s]."""
        return self.rate.parts

    @property
    def answer(self) -> str:
        """Say whose probabilities are taken: 'hops, launch feed', 'csa'."""
        return self.aspects.source(self.rule)

    @property
    def warnings(self):
        """What a user must not overlook, a sentence each: of the devices, the aspects, the velocity."""
        odd = speeds.remark(self.rate.velocity.value, self.bowl.sizing)
        other = () if self.measured is None else self.measured.warnings(self.part)
        return (*strangers(self.devices, self.aspects.names), *self.aspects.warnings, *other, *odd)


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
    known: Shares | None = None,
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
    known : Shares, optional
        Of the part; without them those of the launch 'feed'.

    Returns
    -------
    RateStudy

    Raises
    ------
    FeederError
        If the part has no outline or no such aspect, no such rule has probabilities of it, or the bowl has
        no steady state.
    """
    checked(bowl, heading, gap, fill, sigma)
    chain = bowl.devices if devices is None else tuple(devices)
    known = shares(part, bowl) if known is None else known
    found = known.aspects
    target = None if aspect is None else well_oriented.wanted(part, found, bowl.track, aspect, heading)
    ways = well_oriented.orientations(part, found, bowl.track, chain, sigma, bowl)
    lying = arrivals.oriented(ways, known.measured)
    speed = well_oriented.velocity(bowl)
    target = most_frequent(lying, rule) if target is None else target
    return RateStudy(
        part=part,
        bowl=bowl,
        aspects=found,
        devices=chain,
        rule=rule,
        rate=well_oriented.rate(lying, speed, target, rule, gap=gap, fill=fill),
        measured=known.measured,
    )


def checked(bowl, heading, gap, fill, sigma=0.0):
    """Raise an ArgumentError that names the argument that cannot be used."""
    check.argument("gap", gap, 0.0)
    check.argument("fill", fill, LEAST, 1.0)
    check.argument("sigma", sigma, 0.0)
    if heading is not None:
        check.argument("heading", heading)


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
    leaving = (chance[:, None] * known.leaving).sum(axis=0)[known.leaves_as]
    weight = leaving if leaving.any() else chance
    row = int(np.argmax(weight >= ALIKE * weight.max()))  # the first of equals, whatever the rounding
    return known.aspects[row], known.headings[row]
