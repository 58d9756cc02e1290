"""The study of ``feeder tune``: settings of the drive that reach a wanted rate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

from feederscrew.arrivals.entry import Shares, check_wanted, shares, the_shares
from feederscrew.base import check
from feederscrew.base.columns import Column, Frame, of_records
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import Keywords
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Path, Quantity, former_keywords
from feederscrew.bowl.device_list import shank_remarks, unknown_aspects
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.record import Bowl
from feederscrew.feeding import drive_settings as knobs
from feederscrew.feeding import stream, well_oriented
from feederscrew.feeding.rate import MIN_POSITIVE, RECOMMENDED
from feederscrew.motion import conveying as answer
from feederscrew.motion.hop import hop
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.orientations import orientations


@dataclass(frozen=True, eq=False)
class Tuned(ReadableRecord):
    """One setting that gives the rate, with what it gives."""

    solution: knobs.Solution
    velocity: well_oriented.Range  # [m/s] over all starts and surfaces; >= 0
    over: tuple[str, ...]  # orientations that this drive turns over on the track
    several: bool  # steady velocities, depending on how the part arrives
    driven: Bowl  # at this setting


TUNE_COLUMNS: tuple[Column[Tuned], ...] = (  # a row a setting
    Column("key", lambda tuned: tuned.solution.key.name),
    Column("value", lambda tuned: tuned.solution.number),
    Column("unit", lambda tuned: tuned.solution.key.unit),
    Column(
        "parts_per_minute",
        lambda tuned: tuned.velocity * tuned.solution.parts_per_metre,
        "1/min",
        interval=True,
    ),
    Column("velocity_mm_s", lambda tuned: tuned.solution.answer.velocity, "mm/s"),
    Column("regime", lambda tuned: tuned.solution.answer.regime),
    Column("throw_number", lambda tuned: tuned.solution.answer.throw_number),
    Column("hop_height_mm", lambda tuned: hop(tuned.driven).height, "mm"),
    Column("hop_flight_mm", lambda tuned: hop(tuned.driven).flight, "mm"),
    Column("hardest_impact_mm_s", lambda tuned: tuned.solution.answer.hardest_impact, "mm/s"),
    Column("margin_forward", lambda tuned: tuned.solution.answer.margins["forward"]),
    Column("margin_backward", lambda tuned: tuned.solution.answer.margins["backward"]),
    Column("margin_hop", lambda tuned: tuned.solution.answer.margins["hop"]),
    Column("several", lambda tuned: tuned.several),
    Column("tips_over", lambda tuned: " ".join(tuned.over) or None),
)


@dataclass(frozen=True, eq=False)
class TuneStudy(ReadableRecord, view="rate.TUNE_VIEW"):
    """Every setting of one key of the drive that gives a rate, the recommended one first."""

    part: Part
    bowl: Bowl
    aspects: Aspects  # with what arrives at the bowl's own drive
    devices: tuple[Device, ...]
    target: float  # [1/s] well-oriented parts
    worst: bool  # whether it is met at the slowest of every start and friction, else from rest
    settings: tuple[Tuned, ...]
    skipped: int = 0  # further settings of about that velocity, whose arriving parts were not simulated

    def table(self) -> Frame:
        """Return every setting, a row each: ``tune.csv``."""
        return of_records(TUNE_COLUMNS, self.settings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what a user must not overlook, a sentence each: of the devices, then of the aspects."""
        unknown = unknown_aspects(self.devices, self.aspects.names)
        return (*unknown, *shank_remarks(self.devices), *self.aspects.warnings)


def _take_arriving(given: Keywords, arriving: Callable[[Bowl], Shares] | None) -> None:
    given["aspect_shares"] = given.get("aspect_shares") or arriving


@former_keywords(former={"arriving": _take_arriving})
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
    aspect_shares: Shares | Callable[[Bowl], Shares] | None = None,
    progress: Callable[[int, int], None] | None = None,
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
    heading : str or float [rad], optional
    devices : sequence of Device, optional
    gap : str or float [m]
    fill : float [1]
    rule : str
    launch : str, optional
    probabilities : str or Path, optional
    fed : int, optional
    seed : int
        These nine as for ``rate``.
    worst : bool
        Meet the target at the worst of every start, of friction a fifth lower and higher and, where parts
        hop, of restitution over its spread.
    aspect_shares : Shares or callable, optional
        Of ``shares``, or what returns those that arrive at the drive of a bowl; ``shares`` without it.
    progress : callable, optional
        Called with how many settings are computed, and of how many, at first with none.

    Returns
    -------
    TuneStudy
        ``rate`` at one of its settings, with the same shares, says what the setting says.

    Raises
    ------
    FeederError
        If the part never leaves in that orientation, or no setting gives the rate.
    """
    part, bowl = arguments.part_in_bowl(part, bowl)
    wanted_rate = arguments.amount("target", target, "rate", MIN_POSITIVE)
    named, angle = arguments.an_orientation(aspect, heading)
    aspect = named or aspect
    space = arguments.amount("gap", gap, "length", 0.0)
    check.argument("fill", fill, MIN_POSITIVE, 1.0)
    arriving = aspect_shares if callable(aspect_shares) else None
    shared = None if callable(aspect_shares) else the_shares(aspect_shares)
    check_wanted(part, aspect, angle)

    def fed_there(driven: Bowl) -> Shares:
        return shared or shares(
            part, driven, fed=fed, rule=rule, launch=launch, probabilities=probabilities, seed=seed
        )

    chain = bowl.devices if devices is None else tuple(devices)
    shares_at = cache(arriving or fed_there)
    here = shares_at(bowl)
    on_the_track = orientations(part, here.aspects, bowl.track)

    @cache
    def as_here(driven: Bowl | None) -> well_oriented.Orientations:
        """At a drive, with what arrives at the bowl's own; None: as if it turned nothing over."""
        coming = stream.along(on_the_track, here.aspects, chain, bowl=driven)
        return stream.oriented(coming, here.measured)

    def along(driven: Bowl | None) -> well_oriented.Orientations:
        """At a drive, with what arrives there; None: at the bowl's own as if it turned nothing over."""
        coming, there = as_here(driven), shares_at(driven or bowl)
        if there is here:
            return coming
        return stream.oriented(stream.with_shares(coming, there.aspects), there.measured)

    wanted = well_oriented.wanted(part, here.aspects, bowl.track, aspect, angle, chain)

    def leaving(queue: stream.Orientations) -> float:
        return well_oriented.leaving_per_metre(queue, wanted, rule, gap=space, fill=fill)

    # raises where none ever leaves so
    well_oriented.parts_per_metre(along(None), wanted, rule, gap=space, fill=fill)
    well_oriented.holds(along(bowl), wanted)
    found = knobs.solutions(
        bowl,
        wanted_rate,
        lambda driven: leaving(along(driven)),
        rough=lambda driven: leaving(as_here(driven)),
        sampled=here.fed,
        worst=worst,
        progress=progress,
    )
    tuned = []
    for solution in found.solutions:  # with what it gives if friction is a fifth lower or higher
        there, driven = solution.answer, knobs.turned(bowl, solution.key, solution.value)
        over = tuple(o.name for o in along(driven).lying if o.turns_over)
        several = bool(there.high - there.low > answer.COEXISTING_VELOCITY_GAP * there.speed)
        tuned.append(Tuned(solution, well_oriented.velocity(driven), over, several, driven))
    return TuneStudy(part, bowl, here.aspects, chain, wanted_rate, worst, tuple(tuned), found.skipped)
