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
from feederscrew.rates import drive_settings as knobs
from feederscrew.rates import stream, well_oriented
from feederscrew.rates.stream import along, with_shares
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.studies import arguments
from feederscrew.studies.arguments import BowlSettings, Overrides, Path, Quantity, with_settings
from feederscrew.studies.rate import MIN_POSITIVE, RECOMMENDED, Shares, shares, the_shares
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import orientations


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


@with_settings
def tune(
    part: Part,
    bowl: Bowl,
    aspect: str,
    target: Quantity,
    *,
    heading: Quantity | None = None,
    devices: Sequence[Device] | None = None,
    worst: bool = False,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    rule: str = RECOMMENDED,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    aspect_shares: Shares | None = None,
    arriving: Callable[[Bowl], Shares] | None = None,
    progress: Callable[[int, int], None] | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> TuneStudy:
    """Find settings of the drive that reach a rate, as ``feeder tune``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str
        The one wanted.
    target : str or float [1/s]
        '60/min' of it.
    heading, devices, gap, fill, rule, launch, probabilities, fed, seed, known, overrides, **settings
        As for ``rate``.
    worst : bool
        Meet the target at the worst of every start, of friction a fifth lower and higher and, where parts
        hop, of restitution over its spread.
    arriving : callable, optional
        From a bowl to the Shares that arrive at its drive; ``shares`` without it.
    progress : callable, optional
        Called with how many settings are computed, and of how many.

    Returns
    -------
    TuneStudy
        ``rate`` at one of its settings, with the same shares, says what the setting says.

    Raises
    ------
    FeederError
        If the part never leaves in that orientation, or no setting gives the rate.
    """
    part, bowl = arguments.a_part(part), arguments.a_bowl(bowl, overrides, settings)
    wanted_rate = arguments.amount("target", target, "rate", MIN_POSITIVE)
    angle, space = arguments.angle("heading", heading), arguments.amount("gap", gap, "length", 0.0)
    check.argument("fill", fill, MIN_POSITIVE, 1.0)
    shared = the_shares(aspect_shares)

    def fed_there(driven: Bowl) -> Shares:
        return shared or shares(
            part, driven, fed=fed, rule=rule, launch=launch, probabilities=probabilities, seed=seed
        )

    chain = bowl.devices if devices is None else tuple(devices)
    drive_ways = _DriveWays(part, bowl, chain, fed_there if shared or arriving is None else arriving)
    aspects = drive_ways.shares(bowl).aspects
    wanted = well_oriented.wanted(part, aspects, bowl.track, aspect, angle)
    # raises where none ever leaves so
    well_oriented.parts_per_metre(drive_ways.along(None), wanted, rule, gap=space, fill=fill)
    well_oriented.holds(drive_ways.along(bowl), wanted)

    def density(along: Callable[[Bowl | None], well_oriented.Orientations], driven: Bowl | None) -> float:
        return well_oriented.leaving_per_metre(along(driven), wanted, rule, gap=space, fill=fill)

    solutions = knobs.solutions(
        bowl, wanted_rate, partial(density, drive_ways.along),
        rough=partial(density, drive_ways.along_as_here), sampled=drive_ways.shares(bowl).fed,
        worst=worst, progress=progress,
    )  # fmt: skip
    return TuneStudy(
        part=part,
        bowl=bowl,
        aspects=aspects,
        devices=chain,
        target=wanted_rate,
        worst=worst,
        settings=tuple(_tuned(solution, bowl, drive_ways) for solution in solutions),
    )


class _DriveWays:
    """The orientations along the track of a bowl at other drives, with what arrives at each of them."""

    def __init__(
        self, part: Part, bowl: Bowl, chain: Sequence[Device], arriving: Callable[[Bowl], Shares]
    ) -> None:
        self.bowl, self.chain = bowl, chain
        self.shares, self.along_as_here = cache(arriving), cache(self._along_as_here)
        self.on_the_track = orientations(part, self.shares(bowl).aspects, bowl.track)

    def _along_as_here(self, driven: Bowl | None) -> well_oriented.Orientations:
        """At a drive, with what arrives at the bowl's own; None: as if it turned nothing over."""
        here = self.shares(self.bowl)
        return stream.oriented(along(self.on_the_track, here.aspects, self.chain, bowl=driven), here.measured)

    def along(self, driven: Bowl | None) -> well_oriented.Orientations:
        """At a drive, with what arrives there; None: at the bowl's own as if it turned nothing over."""
        here, aspect_shares = self.along_as_here(driven), self.shares(driven or self.bowl)
        if aspect_shares is self.shares(self.bowl):
            return here
        return stream.oriented(with_shares(here, aspect_shares.aspects), aspect_shares.measured)


def _tuned(solution: knobs.Solution, bowl: Bowl, drive_ways: _DriveWays) -> Tuned:
    """Add to a solution what it gives if friction is a fifth lower or higher, and what it turns over."""
    answer_there, driven = solution.answer, knobs.turned(bowl, solution.key, solution.value)
    return Tuned(
        solution=solution,
        velocity=well_oriented.velocity(driven),
        over=tuple(
            orientation.name for orientation in drive_ways.along(driven).lying if orientation.turns_over
        ),
        several=bool(
            answer_there.high - answer_there.low > answer.COEXISTING_VELOCITY_GAP * answer_there.speed
        ),
        driven=driven,
    )
