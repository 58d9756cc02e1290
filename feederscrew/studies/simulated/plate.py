"""The study of ``feeder drop --plate``: a virtual dynamic bowl test of one part."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Unpack

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.dropping.plate import bowl_test
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import launch_named
from feederscrew.running import RunKeywords, RunSettings
from feederscrew.studies.simulated.drop import check_run

LEAST = 1e-6  # [s]


@dataclass(frozen=True, eq=False)
class PlateStudy(ReadableRecord):
    """How one part lay and travelled on the plates of one or several bowls."""

    part: Part
    aspects: Aspects
    seed: int  # of the random launches
    plates: tuple[bowl_test.Shaken, ...]  # one a bowl; fewer, the last of them partial, after an interrupt
    names: tuple[str, ...]  # of the bowl of each plate

    @property
    def partial(self) -> bool:
        """Whether the user stopped it before all parts were done."""
        return any(plate.partial for plate in self.plates)


def plate(
    part: Part,
    bowls: Sequence[Bowl],
    launch: str = "feed",
    conditions: Mapping[str, str | None] | None = None,
    *,
    names: Sequence[str] | None = None,
    drops: int | None = None,
    seconds: float | None = None,
    **run: Unpack[RunKeywords],
) -> PlateStudy:
    """Study what parts do on plates that vibrate with the drives of bowls.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : sequence of Bowl
        One plate each: the drive, its restitution, and the kinetic friction.
    launch : str
        How the parts come onto the plate: 'place', 'drop' or 'tumble'.
    conditions : dict of str to (str or None), optional
        Ranges that replace the launch's, and the bowl's restitution and friction.
    names : sequence of str, optional
        Of the bowls; 'bowl' without them.
    drops : int, optional
        Parts on each plate; 400 without it.
    seconds : float, optional [s]
        How long each is followed; 5 without it.
    **run
        With the defaults of ``RunSettings``.
        seed : int, of the random launches, the same on all plates.
        jobs : int, cores to use; the outcome does not depend on it.
        progress : function, called after every batch with the parts done, on all plates together, and how
        many there will be.
        before : function, called once all inputs are found right, before anything is compiled.

    Returns
    -------
    PlateStudy

    Raises
    ------
    FeederError
        If the part has no shape, or a condition is not such a quantity or out of range.
    KeyboardInterrupt
        If nothing was finished.
    """
    own = check.options("plate", RunSettings, run)
    launch_named(launch)
    check_run(drops, own.seed, own.jobs)
    pace = bowl_test.EXACT
    if seconds is not None:
        check.argument("seconds", seconds, LEAST)
        pace = replace(pace, seconds=seconds)
    found = find(part)
    plates = bowl_test.test(
        part, found, bowls, launch, dict(conditions or {}),
        drops=drops, pace=pace, run=own,
    )  # fmt: skip
    given = names or ["bowl"] * len(bowls)
    return PlateStudy(part, found, own.seed, tuple(plates), tuple(given[: len(plates)]))
