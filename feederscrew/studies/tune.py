"""The study of ``feeder tune``: settings of the drive that reach a wanted rate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, Unpack

from feederscrew import check
from feederscrew.bowl.devices import unknown_aspects
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.part.record import Part
from feederscrew.rates import drive_settings as knobs
from feederscrew.rates import stream, well_oriented
from feederscrew.rates.stream import along
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.studies import arguments
from feederscrew.studies.arguments import BowlSettings, Overrides, Path, Quantity, with_settings
from feederscrew.studies.rate import MIN_POSITIVE, RECOMMENDED, Shares, shares, the_shares
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import orientations

ROUGH_PARTS = 200  # parts that lead to a setting; as many as `rate` feeds decide on it


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
    rough: Callable[[Bowl], Shares] | None = None,
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
    rough : callable, optional
        The same of FEW parts, which leads to a setting.
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
    if (shared := the_shares(aspect_shares)) is not None:
        arriving, rough = (lambda driven: shared), None
    if arriving is None:
        own: dict[str, Any] = {"rule": rule, "launch": launch, "probabilities": probabilities, "seed": seed}
        arriving = partial(shares, part, fed=fed, **own)
        is_fed = rule == RECOMMENDED and launch is None and probabilities is None and fed is None
        rough = partial(shares, part, fed=ROUGH_PARTS, **own) if is_fed else None
    chain = bowl.devices if devices is None else tuple(devices)
    drive_ways = _DriveWays(part, bowl, chain, arriving)
    lead = None if rough is None else _DriveWays(part, bowl, chain, rough)
    aspects = drive_ways.shares(bowl).aspects
    wanted = well_oriented.wanted(part, aspects, bowl.track, aspect, angle)
    # raises where none ever leaves so
    well_oriented.parts_per_metre(drive_ways.along(None), wanted, rule, gap=space, fill=fill)
    well_oriented.holds(drive_ways.along(bowl), wanted)

    def density(drive_ways: _DriveWays, driven: Bowl | None) -> float:
        return well_oriented.leaving_per_metre(drive_ways.along(driven), wanted, rule, gap=space, fill=fill)

    led = None if lead is None else partial(density, lead)
    to_turn = bowl, wanted_rate, partial(density, drive_ways)
    solutions = knobs.solutions(*to_turn, rough=led, worst=worst, progress=progress)
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
        self.part, self.bowl, self.chain = part, bowl, chain
        self.shares, self.along = cache(arriving), cache(self._along)

    def _along(self, driven: Bowl | None) -> well_oriented.Orientations:
        """At a drive; None: at the bowl's own as if it turned nothing over."""
        aspect_shares = self.shares(driven or self.bowl)
        on_the_track = orientations(self.part, aspect_shares.aspects, self.bowl.track)
        return stream.oriented(
            along(on_the_track, aspect_shares.aspects, self.chain, bowl=driven), aspect_shares.measured
        )


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
