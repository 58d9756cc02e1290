"""The study of ``feeder tune``: settings of the drive that reach a wanted rate."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from feederscrew import check
from feederscrew.bowl.devices import strangers
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer, sensitivity
from feederscrew.part.record import Part
from feederscrew.rates import arrivals, well_oriented
from feederscrew.rates import drive_settings as knobs
from feederscrew.rates.stream import along
from feederscrew.resting.aspects import Aspects
from feederscrew.studies.rate import LEAST, Shares, checked, shares
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import orientations


@dataclass(frozen=True, eq=False)
class Tuned:
    """One setting that reaches the rate, with what it gives."""

    solution: knobs.Solution
    # [m/s] over all starts and for friction a fifth lower and higher; the low end >= 0
    velocity: well_oriented.Range
    over: tuple[str, ...]  # orientations that this drive turns over on the track
    several: bool  # steady velocities, depending on how the part arrives


@dataclass(frozen=True, eq=False)
class TuneStudy:
    """Every setting of one key of the drive that reaches a rate, the recommended one first."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    devices: tuple[Device, ...]
    target: float  # [1/s] well-oriented parts
    settings: tuple[Tuned, ...]
    own_drive: bool  # whether the shares are those on the moving floor at the bowl's own drive

    @property
    def warnings(self):
        """What a user must not overlook, a sentence each: of the devices, then of the aspects."""
        return (*strangers(self.devices, self.aspects.names), *self.aspects.warnings)


def tune(
    part: Part,
    bowl: Bowl,
    aspect: str,
    target: float,
    *,
    heading: float | None = None,
    rule: str = "recommended",
    devices: Sequence[Device] | None = None,
    gap: float = 0.0,
    fill: float = 1.0,
    known: Shares | None = None,
) -> TuneStudy:
    """Study which amplitude, angle or frequency alone reaches a rate.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str
        The one wanted.
    target : float [1/s]
        Well-oriented parts, above 0.
    heading, rule, devices, gap, fill, known
        As for ``rate``; the shares stay as they are while the drive changes, what turns over does not.

    Returns
    -------
    TuneStudy

    Raises
    ------
    FeederError
        If the part never leaves in that orientation, or no setting reaches the rate.
    """
    check.argument("target", target, LEAST)
    checked(bowl, heading, gap, fill)
    chain = bowl.devices if devices is None else tuple(devices)
    known = shares(part, bowl) if known is None else known
    found = known.aspects
    wanted = well_oriented.wanted(part, found, bowl.track, aspect, heading)
    ways = _ways(part, bowl, chain, known)
    # raises where none ever leaves so
    well_oriented.parts_per_metre(ways(None), wanted, rule, gap=gap, fill=fill)

    def density(driven):
        return well_oriented.leaving_per_metre(ways(driven), wanted, rule, gap=gap, fill=fill)

    return TuneStudy(
        part=part,
        bowl=bowl,
        aspects=found,
        devices=chain,
        target=target,
        settings=tuple(_tuned(one, bowl, ways) for one in knobs.solutions(bowl, target, density)),
        own_drive=known.fed and rule == "recommended",
    )


def _ways(part, bowl, chain, known):
    """A function from a bowl with another drive, or None, to the orientations along its track."""
    every = orientations(part, known.aspects, bowl.track)

    @cache
    def ways(driven):
        return arrivals.oriented(along(every, known.aspects, chain, bowl=driven), known.measured)

    return ways


def _tuned(solution, bowl, ways):
    """Add to a solution what it gives if friction is a fifth lower or higher, and what it turns over."""
    found, driven = solution.answer, knobs.turned(bowl, solution.key, solution.value)
    doubt = sensitivity.friction_doubt(driven)
    slowest = np.nanmin([found.low, doubt.less, doubt.more])
    fastest = np.nanmax([found.high, doubt.less, doubt.more])
    return Tuned(
        solution=solution,
        velocity=well_oriented.Range(found.velocity, max(slowest, 0.0), max(fastest, 0.0)),
        over=tuple(one.name for one in ways(driven).lying if one.turns_over),
        several=bool(found.high - found.low > answer.COEXIST * found.speed),
    )
