"""The study of ``feeder drop --plate``: a virtual dynamic bowl test of one part."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Unpack

from feederscrew.bowl.record import Bowl
from feederscrew.dropping import plate_test
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import launch_named
from feederscrew.running import RunSettings
from feederscrew.studies import arguments
from feederscrew.studies.arguments import Condition, DriveSettings, Overrides, Quantity, with_settings
from feederscrew.studies.drop import check_run

MIN_SECONDS_S = 1e-6  # [s]


@dataclass(frozen=True, eq=False)
class PlateStudy(ReadableRecord):
    """How one part lay and travelled on the plates of one or several bowls."""

    part: Part
    aspects: Aspects
    seed: int  # of the random launches
    plates: tuple[
        plate_test.PlateResult, ...
    ]  # one a bowl; fewer, the last of them partial, after an interrupt
    names: tuple[str, ...]  # of the bowl of each plate

    @property
    def partial(self) -> bool:
        """Whether the user stopped it before all parts were done."""
        return any(plate.partial for plate in self.plates)


@with_settings
def shake(
    part: Part,
    bowls: Bowl | Sequence[Bowl],
    launch: str = "feed",
    *,
    names: Sequence[str] | None = None,
    drops: int | None = None,
    seconds: Quantity | None = None,
    seed: int = 1,
    jobs: int = 1,
    fall: Condition = None,
    spin: Condition = None,
    speed: Condition = None,
    restitution: Condition = None,
    friction: Condition = None,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
    overrides: Overrides = (),
    **settings: Unpack[DriveSettings],
) -> PlateStudy:
    """Run a virtual dynamic bowl test, as ``feeder drop --plate``: parts on a plate with each bowl's drive.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : Bowl or sequence of Bowl
    launch : str
        As for ``drop``.
    names : sequence of str, optional
        Of the bowls; 'bowl' without them.
    drops : int, optional
        Parts on each plate; 400 without it.
    seconds : str or float [s], optional
        How long each is followed; 5 without it.
    seed, jobs, fall, spin, speed, restitution, friction
        As for ``drop``; restitution and friction are each bowl's unless given.
    progress : callable, optional
        Called after every batch with the parts done, on all plates together, and how many there will be.
    before : callable, optional
        Called once all inputs are found right, before anything is compiled.
    overrides, **settings
        As for ``read_bowl``, amplitude='0.3 mm': in place of each bowl's own.

    Returns
    -------
    PlateStudy
        Its ``plates``, one a bowl, have ``occupancy``: shares, transition rates and velocities with their
        intervals.

    Raises
    ------
    FeederError
        As for ``drop``.
    """
    ranges = arguments.conditions(
        fall=fall, spin=spin, speed=speed, restitution=restitution, friction=friction
    )
    part, drops = arguments.a_part(part), arguments.count("drops", drops)
    driven = arguments.some_bowls(bowls, overrides, settings)
    launch_named(launch)
    check_run(drops, seed, jobs)
    pace = plate_test.EXACT_PACE
    if seconds is not None:
        pace = replace(pace, seconds=arguments.amount("seconds", seconds, "time", MIN_SECONDS_S))
    aspects = find(part)
    plates = plate_test.test(
        part, aspects, driven, launch, ranges,
        drops=drops, pace=pace, run=RunSettings(seed, jobs, progress, before),
    )  # fmt: skip
    bowl_names = names or ["bowl"] * len(driven)
    return PlateStudy(part, aspects, seed, tuple(plates), tuple(bowl_names[: len(plates)]))
