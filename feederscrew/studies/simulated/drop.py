"""The study of ``feeder drop``: a virtual drop test of one part on a hard plane."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Unpack

import numpy as np

from feederscrew import check
from feederscrew.dropping import drop_test, traces
from feederscrew.dropping.ensemble import Drops, Tally
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import launch_named
from feederscrew.running import RunKeywords, RunSettings

BESIDE = ("csa", "surface")  # rules that the drops are shown with


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
        return {rule: self.aspects.probabilities[rule] for rule in BESIDE}

    @property
    def telling(self) -> traces.DropTrace:
        """The followed drop to show: the first that tumbled and lies still, else tumbled, else the first."""
        return traces.telling(self.result.traces)


def drop(
    part: Part,
    launch: str = "feed",
    conditions: Mapping[str, str | None] | None = None,
    *,
    drops: int | None = None,
    until: str | None = None,
    traced: int = 0,
    aspects: Aspects | None = None,
    dropped: Drops | None = None,
    **run: Unpack[RunKeywords],
) -> DropStudy:
    """Study on which aspects a part comes to rest when it is dropped again and again.

    Parameters
    ----------
    part : Part
        From a mesh.
    launch : str
        'place', 'drop' or 'tumble'.
    conditions : dict of str to (str or None), optional
        Ranges that replace the launch's, as typed: fall, spin, speed, restitution, friction.
    drops : int, optional
        How many; with ``until`` at most so many.
    until : str, optional
        Go on until every class's 95 % interval is this narrow to either side, '1%'.
    traced : int
        Of how many drops, from the first, the motion is kept as well.
    aspects : Aspects, optional
        Of the part, where they are known already.
    dropped : Drops, optional
        Of an earlier run of the same arguments: nothing is dropped then.
    **run
        With the defaults of ``RunSettings``.
        seed : int, of the random launches.
        jobs : int, cores to use; the counts do not depend on it.
        progress : function, as in ``ensemble.drop``.
        before : function, called once all inputs are found right, before anything is compiled.

    Returns
    -------
    DropStudy

    Raises
    ------
    FeederError
        If the part has no shape, or a condition is not such a quantity or out of range.
    KeyboardInterrupt
        If the user stops it before there is anything to count; later, the result is partial.
    """
    own = check.options("drop", RunSettings, run)
    launch_named(launch)
    check_run(drops, own.seed, own.jobs)
    found = find(part) if aspects is None else aspects
    result = drop_test.test(
        part, found, launch, dict(conditions or {}),
        drops=drops, until=until, traced=traced, dropped=dropped, run=own,
    )  # fmt: skip
    return DropStudy(part, found, result)


def check_run(drops: int | None, seed: int | None, jobs: int | None) -> None:
    """Raise an ArgumentError that names the argument of a run that cannot be used."""
    for name, value, low in (("drops", drops, 1), ("seed", seed, 0), ("jobs", jobs, 1)):
        if value is not None:
            check.argument(name, value, low)
