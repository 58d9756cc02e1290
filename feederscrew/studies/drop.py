"""The studies of ``feeder drop``: a part on a hard plane, on vibrating plates, and tosses of a file."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.arrays import Floats
from feederscrew.bowl.record import Bowl
from feederscrew.dropping import drop_test, launch_conditions, plate_test, toss_runs
from feederscrew.dropping.ensemble import Drops, Tally, wilson
from feederscrew.dropping.rounded_hull import shape_of_part
from feederscrew.dropping.toss_runs import FACE_NAMES, LaunchFile
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects, find, require_ground
from feederscrew.resting.rules.recommended import launch_of_name
from feederscrew.running import RunSettings
from feederscrew.signatures import with_shown_signature
from feederscrew.studies import arguments
from feederscrew.studies.arguments import Condition, Quantity, former_keywords

RULES_DRAWN = ("csa", "surface")  # rules that the drops are shown with
MIN_SECONDS_S = 1e-6  # [s]
SURE_SHARE = 0.95  # [1] from here on an answer is called sure


@dataclass(frozen=True, eq=False)
class DropStudy(ReadableRecord):
    """Shares in which one part came to rest on each of its aspects."""

    part: Part
    aspects: Aspects
    result: drop_test.Result

    @property
    def tally(self) -> Tally:
        """Counts, shares and intervals by class, in the order of the aspects."""
        return self.result.tally

    @property
    def drops(self) -> int:
        """Return how many there were."""
        return len(self.result.drops.faces)

    @property
    def rules(self) -> dict[str, Floats]:
        """Probabilities (A,) by the rules that the drops are shown with."""
        return {rule: self.aspects.probabilities[rule] for rule in RULES_DRAWN}

    @property
    def telling(self) -> drop_test.DropTrace:
        """The followed drop to show: the first that tumbled and lies still, else tumbled, else the first."""
        return drop_test.telling(self.result.traces)


@with_shown_signature
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
    own = {"fall": fall, "spin": spin, "speed": speed, "restitution": restitution, "friction": friction}
    ranges, run = arguments.conditions(**own), RunSettings(seed, jobs, progress, before)
    part, drops = arguments.a_part(part), arguments.count("drops", drops)
    launch_of_name(launch)
    _check_run(run)
    resting = find(part) if aspects is None else aspects
    result = drop_test.test(
        part, resting, launch, ranges, drops=drops, until=until, traced=traced, dropped=dropped, run=run
    )
    return DropStudy(part, resting, result)


def _check_run(run: RunSettings) -> None:
    check.argument("seed", run.seed, 0)
    check.argument("jobs", run.jobs, 1)


@dataclass(frozen=True, eq=False)
class PlateStudy(ReadableRecord):
    """Rest and travel of one part on the plates of one or several bowls."""

    part: Part
    aspects: Aspects
    seed: int  # of the random launches
    plates: tuple[plate_test.PlateResult, ...]  # one a bowl; fewer, the last partial, after an interrupt
    names: tuple[str, ...]  # of the bowl of each plate

    @property
    def partial(self) -> bool:
        """Return whether the user stopped it before all parts were done."""
        return any(plate.partial for plate in self.plates)


@former_keywords("bowls")
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
    own = {"fall": fall, "spin": spin, "speed": speed, "restitution": restitution, "friction": friction}
    ranges, run = arguments.conditions(**own), RunSettings(seed, jobs, progress, before)
    part, drops = arguments.a_part(part), arguments.count("drops", drops)
    driven = arguments.some_bowls(bowls)
    launch_of_name(launch)
    _check_run(run)
    pace = plate_test.EXACT_PACE
    if seconds is not None:
        pace = replace(pace, seconds=arguments.amount("seconds", seconds, "time", MIN_SECONDS_S))
    aspects = find(part)
    plates = plate_test.test(part, aspects, driven, launch, ranges, drops=drops, pace=pace, run=run)
    bowl_names = names or ["bowl"] * len(driven)
    return PlateStudy(part, aspects, seed, tuple(plates), tuple(bowl_names[: len(plates)]))


@dataclass(frozen=True, eq=False)
class Agreement(ReadableRecord):
    """Computed ends of measured tosses, beside what happened."""

    tosses: int  # with an answer
    right_share: float  # [1] share of them whose upper side was right
    low: float  # [1] ends of its 95 % interval
    high: float
    at_release: float  # [1] share that the side nearest to the top at the launch tells
    expected: float  # [1] mean of ``p``: the share that was to be expected
    sure: int  # answers with a ``p`` of at least SURE
    sure_right_share: float | None  # [1] share of those that were right; None without any
    median_off: float | None  # [m] from the place computed to the one measured; None where none was measured


@dataclass(frozen=True, eq=False)
class TossStudy(ReadableRecord):
    """Outcomes of the launches of a file."""

    part: Part
    aspects: Aspects
    launches: LaunchFile
    surface: toss_runs.SurfaceRanges
    seed: int
    result: toss_runs.Tosses

    @property
    def p(self) -> Floats:
        """Share (N,) of the settled runs that end as computed; NaN without any."""
        result = self.result
        best = np.take_along_axis(result.shares, np.maximum(result.faces, 0)[:, None], axis=1)[:, 0]
        return np.where(result.faces >= 0, best, np.nan)

    @property
    def intervals(self) -> tuple[Floats, ...]:
        """Ends (N,), (N,) of the 95 % interval that so few runs leave of ``p``."""
        settled = self.result.settled
        pairs = [wilson(np.nan_to_num(p) * n, n) if n else (0.0, 1.0) for p, n in zip(self.p, settled)]
        return tuple(np.array([float(np.ravel(pair[k])[0]) for pair in pairs]) for k in (0, 1))

    @property
    def off(self) -> Floats | None:
        """Distance (N,) [m] from the place computed to the one measured; None where none was measured."""
        ends = self.launches.ends
        return None if ends is None else np.hypot(*(self.result.places - ends[: len(self.p)]).T)

    @property
    def agreement(self) -> Agreement | None:
        """Return what was computed beside what was measured; None where the file holds no upper sides."""
        if self.launches.faces is None:
            return None
        result, p = self.result, self.p
        measured = np.array([FACE_NAMES.index(face) for face in self.launches.faces[: len(p)]])
        right, settled = result.faces == measured, result.faces >= 0
        low, high = wilson(right.sum(), len(right))
        sure = settled & (np.nan_to_num(p) >= SURE_SHARE)
        return Agreement(
            tosses=int(settled.sum()),
            right_share=float(right.mean()),
            low=float(low),
            high=float(high),
            at_release=float((result.released == measured).mean()),
            expected=float(np.nan_to_num(p).mean()),
            sure=int(sure.sum()),
            sure_right_share=float(right[sure].mean()) if sure.any() else None,
            median_off=None if self.off is None or not settled.any() else float(np.nanmedian(self.off)),
        )


def follow(
    part: Part,
    launches: str,
    own: Mapping[str, str | None] | None = None,
    *,
    runs: int | None = None,
    seed: int = 1,
    jobs: int = 1,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> TossStudy:
    """Study where tosses of a part from a mesh lead whose states at the launch are known.

    The surface is not known exactly, so each toss is made several times, over small changes of restitution
    and friction.

    Parameters
    ----------
    part : Part
        From a mesh.
    launches : str
        Path of a file for ``toss_runs.read_launches``.
    own : mapping, optional
        ``restitution`` and ``friction`` as typed, a value or a range; else they are those of any launch.
    runs : int, optional
        Of each toss.
    seed : int
        Of the changes.
    jobs : int
        Cores, on which the answer does not depend.
    progress : callable, optional
        Called with how many tosses are done, and of how many.
    before : callable, optional
        Called once all inputs are right.

    Returns
    -------
    TossStudy

    Raises
    ------
    FeederError
        If the part has no shape, the file has a fault, or a value is out of range.
    """
    run, runs = RunSettings(seed, jobs, progress, before), arguments.count("drops", runs)
    _check_run(run)
    read, aspects = toss_runs.read_launches(launches), find(part)
    grounded = require_ground(part, aspects)
    _, length = shape_of_part(part, grounded)
    ranges = {key: (own or {}).get(key) for key in ("restitution", "friction")}
    launch = launch_conditions.launch_of("feed", length, ranges)
    surface = toss_runs.SurfaceRanges(launch.restitution, launch.friction)
    run.begin()
    rng, runs = np.random.default_rng(seed), runs or toss_runs.DEFAULT_RUNS
    result = toss_runs.follow(part, grounded, read, surface, rng, runs=runs, jobs=jobs, progress=progress)
    return TossStudy(part, aspects, read, surface, seed, result)
