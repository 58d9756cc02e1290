"""The studies of ``feeder drop``: a part on a hard plane, on vibrating plates, and tosses of a file."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from feederscrew.arrivals import drop_test, launch_conditions, plate_test, toss_runs
from feederscrew.arrivals.ensemble import Drops, Tally, wilson
from feederscrew.arrivals.rounded_hull import shape_of_part
from feederscrew.arrivals.toss_runs import FACE_NAMES, LaunchFile
from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Ints
from feederscrew.base.columns import Column, Frame, of_arrays, of_pieces
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import RunSettings
from feederscrew.base.signatures import with_shown_signature
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Condition, Quantity, former_keywords
from feederscrew.bowl.record import Bowl
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, find, require_ground
from feederscrew.resting.rules.recommended import launch_of_name

RULES_DRAWN = ("csa", "surface")  # rules that the drops are shown with
MIN_SECONDS_S = 1e-6  # [s]
NO_ASPECT = "none"  # the class of a drop or toss that never settles
MOST_LOOKS = 101  # moments of a table over time
SURE_SHARE = 0.95  # [1] from here on an answer is called sure


@dataclass(frozen=True, eq=False)
class DropStudy(ReadableRecord, view="drop.DROP_VIEW"):
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

    def counted_on(self, trace: drop_test.DropTrace) -> str:
        """Return the aspect that a drop ends on; ``NO_ASPECT`` of one that never settles."""
        return self.aspects.names[trace.row] if trace.row >= 0 else NO_ASPECT

    def table(self) -> Frame:
        """Return how many drops rest on each aspect: ``drop.csv``, with ``partial`` if it was stopped."""
        partial = PARTIAL_COLUMNS if self.result.drops.partial else ()
        return of_arrays([*DROP_COLUMNS, *partial], self)

    def traces_table(self) -> Frame:
        """Return a row a moment of each followed drop: ``drop_traces.csv``.

        They are the centre of mass over the plane, the quaternion from the file's axes to the plane's, total
        energy over m g, what happens, and the aspect the drop ends on.
        """
        return of_pieces(DROP_MOMENT_COLUMNS, [(self, trace) for trace in self.result.traces])


def _events(trace: drop_test.DropTrace) -> Array:
    """Return what happens in each row of a trace: 'launch', 'impact', 'still' or nothing."""
    event = np.where(trace.impacts, "impact", "").astype(object)
    event[0] = "launch"
    event[-1] = "still" if trace.still else event[-1]
    return event


DROP_COLUMNS: tuple[Column[DropStudy], ...] = (  # a row an aspect
    Column("aspect", lambda study: study.aspects.names),
    Column("height_mm", lambda study: study.result.heights, "mm"),
    Column("count", lambda study: study.tally.counts),
    Column("p_drop", lambda study: study.tally.p, "share", "drop"),
    Column("p_drop_low", lambda study: study.tally.low, "share", "low"),
    Column("p_drop_high", lambda study: study.tally.high, "share", "high"),
    Column("p_gentle", lambda study: study.tally.gentle, "share", "gentle"),
    Column("p_violent", lambda study: study.tally.violent, "share", "violent"),
    Column("p_restitution", lambda study: study.tally.restitution, "share", "restitution"),
    Column("unsettled_share", lambda study: study.tally.unsettled_share, "share"),
)
PARTIAL_COLUMNS: tuple[Column[DropStudy], ...] = (  # of a test that was stopped
    Column("partial", lambda study: True),
)
DROP_TEST_COLUMNS: tuple[Column[DropStudy], ...] = (  # of the whole test
    Column("part", lambda study: study.part.name),
    Column("drops", lambda study: study.drops),
    Column("seed", lambda study: study.result.seed),
    Column("launch", lambda study: study.result.launch),
    Column("partial", lambda study: study.result.drops.partial),
    Column("unsettled", lambda study: study.result.tally.unsettled),
    Column("unsettled_share", lambda study: study.result.tally.unsettled_share, "share"),
    Column("until", lambda study: study.result.aim),
    Column("widest", lambda study: study.result.tally.widest),
)
DROP_TRACE_COLUMNS: tuple[
    Column[tuple[DropStudy, drop_test.DropTrace]], ...
] = (  # of a drop that was followed
    Column("drop", lambda drop: drop[1].number),
    Column("aspect", lambda drop: drop[0].counted_on(drop[1])),
    Column("counted_s", lambda drop: drop[1].decided, "s"),
    Column("still", lambda drop: drop[1].still),
)
DROP_MOMENT_COLUMNS: tuple[
    Column[tuple[DropStudy, drop_test.DropTrace]], ...
] = (  # a row a moment of a drop that was followed
    Column("drop", lambda drop: drop[1].number),
    Column("time_s", lambda drop: drop[1].times, "s"),
    Column("x_mm", lambda drop: drop[1].positions[:, 0], "mm"),
    Column("y_mm", lambda drop: drop[1].positions[:, 1], "mm"),
    Column("z_mm", lambda drop: drop[1].positions[:, 2], "mm"),
    Column("q_w", lambda drop: drop[1].attitudes[:, 0]),
    Column("q_x", lambda drop: drop[1].attitudes[:, 1]),
    Column("q_y", lambda drop: drop[1].attitudes[:, 2]),
    Column("q_z", lambda drop: drop[1].attitudes[:, 3]),
    Column("energy_mm", lambda drop: drop[1].energies, "mm"),
    Column("event", lambda drop: _events(drop[1])),
    Column("aspect", lambda drop: drop[0].counted_on(drop[1])),
)


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
        Called as drops end: how many are done, of how many at most, and how wide the longest interval of a
        share is [1].
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
    ranges, run = condition_texts(**own), RunSettings(seed, jobs, progress, before)
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


class PlateOf(NamedTuple):
    """One plate of a study, as its columns see it."""

    aspects: Aspects
    result: plate_test.PlateResult
    name: str  # of its bowl

    def changing(self) -> list[str]:
        """Return the aspects whose share still changes at the end."""
        changing = self.result.occupancy.changing
        return [name for name, is_changing in zip(self.aspects.names, changing) if is_changing]

    def pairs(self) -> tuple[Array, Array]:
        """Return from which aspect to which, (P,) names each: the pairs whose rate is known."""
        before, after = self._pairs()
        names = np.array(self.aspects.names)
        return names[before], names[after]

    def of_pairs(self, quantity: str) -> Array:
        """Return an (A, A) quantity of the occupancy for each pair, (P,)."""
        before, after = self._pairs()
        return getattr(self.result.occupancy, quantity)[before, after]

    def _pairs(self) -> tuple[Ints, ...]:
        occupancy = self.result.occupancy
        return np.nonzero(np.ones(occupancy.counts.shape, bool) & (occupancy.times > 0.0)[:, None])

    def moments(self) -> tuple[Floats, Array, Floats]:
        """Return time [s], aspect and share [1] of ``MOST_LOOKS`` looks at most, (L A,) each."""
        shares, count = self.result.occupancy.course, len(self.aspects.names)
        looks = np.unique(np.linspace(0, len(shares) - 1, MOST_LOOKS).astype(int))
        time = np.repeat(looks * self.result.seconds / (len(shares) - 1), count)
        return time, np.tile(self.aspects.names, len(looks)), shares[looks].ravel()


@dataclass(frozen=True, eq=False)
class PlateStudy(ReadableRecord, view="plate.PLATE_VIEW"):
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

    @property
    def each(self) -> list[PlateOf]:
        """Return the plates with the names of their bowls."""
        return [PlateOf(self.aspects, result, name) for result, name in zip(self.plates, self.names)]

    def _table(self, columns: Sequence[Column[PlateOf]]) -> Frame:
        """Return columns of every plate, headed by which plate; once the user stopped, which is not whole."""
        partial = PLATE_PARTIAL_COLUMNS if self.partial else ()
        return of_pieces([*PLATE_HEAD_COLUMNS, *columns, *partial], self.each)

    def table(self) -> Frame:
        """Return how often parts lie on each aspect and how fast they travel: ``plate.csv``."""
        return self._table(PLATE_COLUMNS)

    def rates_table(self) -> Frame:
        """Return the transitions seen and their rate, a row a plate and pair: ``plate_rates.csv``."""
        return self._table(PLATE_RATE_COLUMNS)

    def course_table(self) -> Frame:
        """Return the share of the parts on each aspect over time: ``plate_time.csv``."""
        return self._table(PLATE_COURSE_COLUMNS)

    def drives_table(self) -> Frame:
        """Return how fast parts travel on each plate, and how much was seen: ``plate_drives.csv``."""
        return self._table(PLATE_DRIVE_COLUMNS)


PLATE_HEAD_COLUMNS: tuple[Column[PlateOf], ...] = (  # before those of every table
    Column("bowl", lambda plate: plate.name),
    Column("amplitude_mm", lambda plate: plate.result.bowl.drive.amplitude, "mm"),
    Column("throw_number", lambda plate: plate.result.throw_number),
)
PLATE_COLUMNS: tuple[Column[PlateOf], ...] = (  # a row an aspect
    Column("aspect", lambda plate: plate.aspects.names),
    Column("height_mm", lambda plate: plate.aspects.heights, "mm"),
    Column("p_start", lambda plate: plate.result.occupancy.start, "share", "start"),
    Column("p_plate", lambda plate: plate.result.occupancy.plate, "share", "plate"),
    Column("p_plate_low", lambda plate: plate.result.occupancy.plate_low, "share", "low"),
    Column("p_plate_high", lambda plate: plate.result.occupancy.plate_high, "share", "high"),
    Column("p_limit", lambda plate: plate.result.occupancy.limit, "share", "limit"),
    Column("p_limit_low", lambda plate: plate.result.occupancy.limit_low, "share", "low"),
    Column("p_limit_high", lambda plate: plate.result.occupancy.limit_high, "share", "high"),
    Column("velocity_mm_s", lambda plate: plate.result.occupancy.velocities[..., 0], "mm/s"),
    Column("velocity_low_mm_s", lambda plate: plate.result.occupancy.velocities[..., 1], "mm/s", hidden=True),
    Column(
        "velocity_high_mm_s", lambda plate: plate.result.occupancy.velocities[..., 2], "mm/s", hidden=True
    ),
)
PLATE_RATE_COLUMNS: tuple[Column[PlateOf], ...] = (  # a row a pair of aspects
    Column("from", lambda plate: plate.pairs()[0]),
    Column("to", lambda plate: plate.pairs()[1]),
    Column("count", lambda plate: plate.of_pairs("counts")),
    Column("rate_per_s", lambda plate: plate.of_pairs("rates"), "1/s", "rate"),
    Column("rate_low_per_s", lambda plate: plate.of_pairs("rates_low"), "1/s", "rate low"),
    Column("rate_high_per_s", lambda plate: plate.of_pairs("rates_high"), "1/s", "rate high"),
)
PLATE_COURSE_COLUMNS: tuple[Column[PlateOf], ...] = (  # a row a moment and aspect
    Column("time_s", lambda plate: plate.moments()[0], "s"),
    Column("aspect", lambda plate: plate.moments()[1]),
    Column("p", lambda plate: plate.moments()[2], "share"),
)
PLATE_DRIVE_COLUMNS: tuple[Column[PlateOf], ...] = (  # a row a plate
    Column("drops", lambda plate: plate.result.parts),
    Column("seconds", lambda plate: plate.result.seconds),
    Column("unsettled", lambda plate: plate.result.unsettled),
    Column("transitions", lambda plate: plate.result.transitions),
    Column("steady", lambda plate: "no" if plate.result.occupancy.changing.any() else "yes"),
    Column("velocity_mm_s", lambda plate: plate.result.occupancy.velocity[..., 0], "mm/s"),
    Column("velocity_low_mm_s", lambda plate: plate.result.occupancy.velocity[..., 1], "mm/s", hidden=True),
    Column("velocity_high_mm_s", lambda plate: plate.result.occupancy.velocity[..., 2], "mm/s", hidden=True),
)
PLATE_PARTIAL_COLUMNS: tuple[Column[PlateOf], ...] = (  # of a test that was stopped
    Column("partial", lambda plate: plate.result.partial),
)
PLATE_TEST_COLUMNS: tuple[Column[PlateOf], ...] = (  # of the document
    Column("bowl", lambda plate: plate.name),
    Column("amplitude_mm", lambda plate: plate.result.bowl.drive.amplitude, "mm"),
    Column("frequency_Hz", lambda plate: plate.result.bowl.drive.frequency, "Hz"),
    Column("vibration_angle_deg", lambda plate: plate.result.bowl.drive.vibration_angle, "deg"),
    Column("throw_number", lambda plate: plate.result.throw_number),
    Column("restitution", lambda plate: plate.result.launch["restitution"]),
    Column("friction", lambda plate: plate.result.launch["friction"]),
    Column("drops", lambda plate: plate.result.parts),
    Column("lost", lambda plate: plate.result.lost),
    Column("unsettled", lambda plate: plate.result.unsettled),
    Column("seconds", lambda plate: plate.result.seconds),
    Column("steady", lambda plate: not plate.result.occupancy.changing.any()),
    Column("changing", lambda plate: plate.changing()),
    Column("transitions_seen", lambda plate: plate.result.transitions),
    Column("velocity_mm_s", lambda plate: plate.result.occupancy.velocity[..., 0], "mm/s"),
    Column("velocity_low_mm_s", lambda plate: plate.result.occupancy.velocity[..., 1], "mm/s"),
    Column("velocity_high_mm_s", lambda plate: plate.result.occupancy.velocity[..., 2], "mm/s"),
)


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
    seed, jobs : int
        As for ``drop``.
    fall, spin, speed, restitution, friction : str, float or pair of them [m, rad/s, m/s, 1, 1], optional
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
    ranges, run = condition_texts(**own), RunSettings(seed, jobs, progress, before)
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


AGREEMENT_COLUMNS: tuple[Column[Agreement], ...] = (
    Column("tosses", lambda agreement: agreement.tosses),
    Column("told", lambda agreement: agreement.right_share),
    Column("low", lambda agreement: agreement.low),
    Column("high", lambda agreement: agreement.high),
    Column("at_release", lambda agreement: agreement.at_release),
    Column("expected", lambda agreement: agreement.expected),
    Column("sure", lambda agreement: agreement.sure),
    Column("sure_told", lambda agreement: agreement.sure_right_share),
    Column("median_off_mm", lambda agreement: agreement.median_off, "mm"),
)


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

    def table(self) -> Frame:
        """Return where each toss leads, a row a toss: ``tosses.csv``."""
        ends = MEASURED_END_COLUMNS if self.launches.ends is not None else ()
        faces = MEASURED_FACE_COLUMNS if self.launches.faces is not None else ()
        return of_arrays([*TOSS_COLUMNS, *ends, *faces], self)

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


def _labels(study: TossStudy) -> Array | list[str]:
    """Return the names of the tosses; numbers where all are."""
    labels = list(study.launches.names[: len(study.result.faces)])
    return np.array([int(label) for label in labels]) if all(map(str.isdecimal, labels)) else labels


def _ends(study: TossStudy) -> Floats:
    """Return where the tosses (N, 2) [m] ended as measured."""
    ends = study.launches.ends
    return np.full((len(study.p), 2), np.nan) if ends is None else ends[: len(study.p)]


def _side_column(side: int) -> Column[TossStudy]:
    """Return the column of the share of the runs that end with a side up."""
    sign, axis = FACE_NAMES[side][0], FACE_NAMES[side][1]
    name = f"{'plus' if sign == '+' else 'minus'} {axis}"
    return Column(
        f"p_{name.replace(' ', '_')}", lambda study: study.result.shares[:, side], "share", name, hidden=True
    )


TOSS_FILE_COLUMNS: tuple[Column[TossStudy], ...] = (  # of the whole file
    Column("launches", lambda study: study.launches.source),
    Column("runs", lambda study: study.result.runs),
    Column("seed", lambda study: study.seed),
    Column("frame_s", lambda study: study.launches.frame, "s"),
)
TOSS_COLUMNS: tuple[Column[TossStudy], ...] = (  # a row a toss
    Column("toss", lambda study: _labels(study)),
    Column(
        "aspect",
        lambda study: [study.aspects.names[row] if row >= 0 else NO_ASPECT for row in study.result.rows],
    ),
    Column(
        "face_up", lambda study: [FACE_NAMES[face] if face >= 0 else NO_ASPECT for face in study.result.faces]
    ),
    Column("p", lambda study: study.p, "share"),
    Column("p_low", lambda study: study.intervals[0], "share", "low", hidden=True),
    Column("p_high", lambda study: study.intervals[1], "share", "high", hidden=True),
    Column("x_mm", lambda study: study.result.places[:, 0], "mm"),
    Column("y_mm", lambda study: study.result.places[:, 1], "mm"),
    Column("half_within_mm", lambda study: study.result.spreads, "mm"),
    Column("time_s", lambda study: study.result.times, "s", hidden=True),
    *(_side_column(side) for side in range(len(FACE_NAMES))),
    Column("settled_runs", lambda study: study.result.settled, hidden=True),
)
MEASURED_END_COLUMNS: tuple[Column[TossStudy], ...] = (  # where the end of a toss was measured
    Column("x_measured_mm", lambda study: _ends(study)[:, 0], "mm", hidden=True),
    Column("y_measured_mm", lambda study: _ends(study)[:, 1], "mm", hidden=True),
    Column("off_mm", lambda study: study.off, "mm"),
)
MEASURED_FACE_COLUMNS: tuple[Column[TossStudy], ...] = (
    Column("face_up_measured", lambda study: list((study.launches.faces or ())[: len(study.result.faces)])),
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


SI = {"length": "m", "angular velocity": "rad/s", "velocity": "m/s", "number": ""}


def condition_texts(**ranges: Condition) -> dict[str, str | None]:
    """Return the conditions of a launch that are given, as typed: '20 mm:50 mm'."""
    texts: dict[str, str | None] = {}
    for name, value in ranges.items():
        if value is not None:
            dimension = launch_conditions.CONDITION_KEYS[name][0]
            ends = value if isinstance(value, (tuple, list)) else (value,)
            texts[name] = ":".join(
                end
                if isinstance(end, str)
                else f"{arguments.amount(name, end, dimension)!r} {SI[dimension]}".strip()
                for end in ends
            )
    return texts
