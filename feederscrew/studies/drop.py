"""The study of ``feeder drop``: a virtual drop test of one part on a hard plane."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.dropping import drop_test
from feederscrew.dropping.ensemble import Drops, Tally
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import launch_named
from feederscrew.running import RunSettings
from feederscrew.studies import arguments
from feederscrew.studies.arguments import Condition

RULES_DRAWN = ("csa", "surface")  # rules that the drops are shown with


@dataclass(frozen=True, eq=False)
class DropStudy(ReadableRecord):
    """How often one part came to rest on each of its aspects."""

    part: Part
    aspects: Aspects
    result: drop_test.Result

    @property
    def tally(self) -> Tally:
        """Counts, shares and intervals by class, in the order of the aspects."""
        return self.result.tally

    @property
    def drops(self) -> int:
        """How many there were."""
        return len(self.result.drops.faces)

    @property
    def rules(self) -> dict[str, np.ndarray]:
        """Probabilities (A,) by the rules that the drops are shown with."""
        return {rule: self.aspects.probabilities[rule] for rule in RULES_DRAWN}

    @property
    def telling(self) -> drop_test.DropTrace:
        """The followed drop to show: the first that tumbled and lies still, else tumbled, else the first."""
        return drop_test.telling(self.result.traces)


def drop(
    part: Part,
    launch: str = "feed",
    *,
    drops: int | None = None,
    until: str | None = None,
    seed: int = 1,
    jobs: int = 1,
    traced: int = 0,
    fall: Condition = None,
    spin: Condition = None,
    speed: Condition = None,
    restitution: Condition = None,
    friction: Condition = None,
    aspects: Aspects | None = None,
    dropped: Drops | None = None,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> DropStudy:
    """Run a virtual drop test on a hard plane, as ``feeder drop``.

    Parameters
    ----------
    part : Part
        From a mesh.
    launch : str
        'place', 'drop', 'flip', 'roll' or 'feed': what was done to the part.
    drops : int, optional
        How many; 10,000 without it. With ``until`` at most so many.
    until : str, optional
        Go on until every class's 95 % interval is this narrow to either side, '1%'.
    seed : int
        Of the random launches.
    jobs : int
        Cores to use; the counts do not depend on it.
    traced : int
        Of how many drops, from the first, the motion is kept as well.
    fall, spin, speed, restitution, friction : str, float or pair of them [m, rad/s, m/s, 1, 1], optional
        Ranges that replace the launch's: fall='20 mm:50 mm' or fall=(0.02, 0.05).
    aspects : Aspects, optional
        Of the part, where they are known already.
    dropped : Drops, optional
        Of an earlier run of the same arguments: nothing is dropped then.
    progress : callable, optional
        As in ``ensemble.drop``.
    before : callable, optional
        Called once all inputs are found right, before anything is compiled.

    Returns
    -------
    DropStudy
        Its ``tally`` has counts, shares and intervals by class, in the order of ``find_aspects``.

    Raises
    ------
    FeederError
        If the part has no shape, or an argument is of the wrong kind or out of range.
    KeyboardInterrupt
        If the user stops it before there is anything to count; later, the result is partial.
    """
    ranges = arguments.conditions(
        fall=fall, spin=spin, speed=speed, restitution=restitution, friction=friction
    )
    part, drops = arguments.a_part(part), arguments.count("drops", drops)
    launch_named(launch)
    check_run(drops, seed, jobs)
    resting = find(part) if aspects is None else aspects
    result = drop_test.test(
        part, resting, launch, ranges,
        drops=drops, until=until, traced=traced, dropped=dropped,
        run=RunSettings(seed, jobs, progress, before),
    )  # fmt: skip
    return DropStudy(part, resting, result)


def check_run(drops: int | None, seed: int | None, jobs: int | None) -> None:
    """Raise an ArgumentError that names the argument of a run that cannot be used."""
    for name, value, low in (("drops", drops, 1), ("seed", seed, 0), ("jobs", jobs, 1)):
        if value is not None:
            check.argument(name, value, low)
