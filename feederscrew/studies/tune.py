"""The study of ``feeder tune``: settings of the drive that reach a wanted rate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Unpack

from feederscrew import check
from feederscrew.bowl.devices import unknown_aspects
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.part.record import Part
from feederscrew.rates import arrivals, well_oriented
from feederscrew.rates import drive_settings as knobs
from feederscrew.rates.stream import along
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.studies.rate import LEAST, Shares, Spacing, SpacingKeywords, checked, shares
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import orientations

FEW = 200  # parts that lead to a setting; as many as `rate` feeds decide on it


@dataclass(frozen=True, eq=False)
class Tuned(ReadableRecord):
    """One setting that gives the rate, with what it gives."""

    solution: knobs.Solution
    velocity: well_oriented.Range  # [m/s] over all starts and surfaces; >= 0
    over: tuple[str, ...]  # orientations that this drive turns over on the track
    several: bool  # steady velocities, depending on how the part arrives
    driven: Bowl  # at this setting


@dataclass(frozen=True, eq=False)
class TuneStudy(ReadableRecord):
    """Every setting of one key of the drive that gives a rate, the recommended one first."""

    part: Part
    bowl: Bowl
    aspects: Aspects  # with what arrives at the bowl's own drive
    devices: tuple[Device, ...]
    target: float  # [1/s] well-oriented parts
    worst: bool  # whether it is met at the slowest of every start and friction, else from rest
    settings: tuple[Tuned, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each: of the devices, then of the aspects."""
        return (*unknown_aspects(self.devices, self.aspects.names), *self.aspects.warnings)


@dataclass(frozen=True)
class TuneOptions(Spacing):
    """How parts come and what is enough; an option means what it means for ``tune``."""

    devices: Sequence[Device] | None = None
    worst: bool = False
    arriving: Callable[[Bowl], Shares] | None = None
    rough: Callable[[Bowl], Shares] | None = None
    progress: Callable[[int, int], None] | None = None


class TuneKeywords(SpacingKeywords, total=False):
    """The same as keywords."""

    devices: Sequence[Device] | None
    worst: bool
    arriving: Callable[[Bowl], Shares] | None
    rough: Callable[[Bowl], Shares] | None
    progress: Callable[[int, int], None] | None


def tune(
    part: Part,
    bowl: Bowl,
    aspect: str,
    target: float,
    *,
    heading: float | None = None,
    rule: str = "recommended",
    **options: Unpack[TuneKeywords],
) -> TuneStudy:
    """Study which amplitude, angle or frequency alone gives a rate.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str
        The one wanted.
    target : float [1/s]
        Well-oriented parts, above 0.
    heading, rule
        As for ``rate``.
    **options
        With the defaults of ``TuneOptions``.
        devices, gap, fill : as for ``rate``.
        worst : bool, meet the target at the slowest of every start and surface, as
        ``well_oriented.velocity``.
        arriving : function, from a bowl to the Shares that arrive at its drive; ``studies.rate.shares``
        without it.
        rough : function, the same of FEW parts, which leads to a setting.
        progress : function, called with how many settings are found, and of how many.

    Returns
    -------
    TuneStudy
        ``rate`` at one of its settings, with the same shares, says what the setting says.

    Raises
    ------
    FeederError
        If the part never leaves in that orientation, or no setting gives the rate.
    """
    own = check.options("tune", TuneOptions, options)
    check.argument("target", target, LEAST)
    checked(bowl, heading, own)
    chain = bowl.devices if own.devices is None else tuple(own.devices)
    arriving, rough = own.arriving, own.rough
    if arriving is None:
        arriving, rough = (partial(shares, part, rule=rule, fed=fed) for fed in (None, FEW))
    ways = _DriveWays(part, bowl, chain, arriving)
    lead = None if rough is None else _DriveWays(part, bowl, chain, rough)
    found = ways.shares(bowl).aspects
    wanted = well_oriented.wanted(part, found, bowl.track, aspect, heading)
    # raises where none ever leaves so
    well_oriented.parts_per_metre(ways.along(None), wanted, rule, gap=own.gap, fill=own.fill)
    well_oriented.holds(ways.along(bowl), wanted)

    def density(ways: _DriveWays, driven: Bowl | None) -> float:
        return well_oriented.leaving_per_metre(ways.along(driven), wanted, rule, gap=own.gap, fill=own.fill)

    led = None if lead is None else partial(density, lead)
    to_turn = bowl, target, partial(density, ways)
    made = knobs.solutions(*to_turn, rough=led, worst=own.worst, progress=own.progress)
    return TuneStudy(
        part=part,
        bowl=bowl,
        aspects=found,
        devices=chain,
        target=target,
        worst=own.worst,
        settings=tuple(_tuned(one, bowl, ways) for one in made),
    )


class _DriveWays:
    """The orientations along the track of a bowl at other drives, with what arrives at each of them."""

    def __init__(
        self, part: Part, bowl: Bowl, chain: Sequence[Device], arriving: Callable[[Bowl], Shares]
    ) -> None:
        self.part, self.bowl, self.chain = part, bowl, chain
        self.shares, self.along = cache(arriving), cache(self._along)

    def _along(self, driven: Bowl | None) -> well_oriented.Orientations:
        """At a drive; None: at the bowl's own as if it turned nothing over."""
        known = self.shares(driven or self.bowl)
        every = orientations(self.part, known.aspects, self.bowl.track)
        return arrivals.oriented(along(every, known.aspects, self.chain, bowl=driven), known.measured)


def _tuned(solution: knobs.Solution, bowl: Bowl, ways: _DriveWays) -> Tuned:
    """Add to a solution what it gives if friction is a fifth lower or higher, and what it turns over."""
    found, driven = solution.answer, knobs.turned(bowl, solution.key, solution.value)
    return Tuned(
        solution=solution,
        velocity=well_oriented.velocity(driven),
        over=tuple(one.name for one in ways.along(driven).lying if one.turns_over),
        several=bool(found.high - found.low > answer.COEXIST * found.speed),
        driven=driven,
    )
