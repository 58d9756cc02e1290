"""The studies of ``feeder compare`` and ``calibrate``: what was counted against every rule, and a surface.

Also the friction, restitution and stroke behind velocities that were filmed in one bowl.
"""

import csv
import io
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.arrivals.aspects_study import aspects as resting
from feederscrew.arrivals.ensemble import wilson
from feederscrew.arrivals.entry import shares
from feederscrew.base import check, documents
from feederscrew.base.arrays import Bools, Floats, Vector
from feederscrew.base.columns import Column, Frame, of_records
from feederscrew.base.errors import ArgumentError, ConfigError, Faults, FeederError
from feederscrew.base.heavy import heavy
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import with_shown_signature
from feederscrew.bowl import arguments
from feederscrew.bowl.record import Bowl
from feederscrew.feeding import stream
from feederscrew.motion import conveying
from feederscrew.part import load
from feederscrew.part.record import Part
from feederscrew.resting import deviation, profiles
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.calibration import Fit, fit_counts, fit_passes
from feederscrew.resting.profiles import DeviceCounts
from feederscrew.resting.rules import registry
from feederscrew.resting.rules.recommended import LAUNCH, Recommended

stats = heavy("scipy.stats")

MAX_FILES = 500  # files of one comparison


class _Counted(ReadableRecord):
    """Counts of a part, with its ``part``, ``aspects`` and ``measured``."""

    part: Part
    aspects: Aspects
    measured: profiles.CountFile | DeviceCounts

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of the files, by path."""
        return {self.measured.source: self.measured.sha256}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what a user must not overlook, a sentence each."""
        return (*self.aspects.warnings, *self.measured.warnings(self.part))


@dataclass(frozen=True, eq=False)
class FeedingStudy(_Counted, view="compare.FEEDING_VIEW"):
    """A feeding test of one part in one bowl; D devices that were counted."""

    part: Part
    bowl: Bowl
    config: str  # path of the bowl file
    aspects: Aspects
    measured: DeviceCounts
    stations: tuple[str, ...]  # (D,) as 'gap_2'
    answers: dict[str, Floats]  # (D,) [1] share that passes, by whose shares of the aspects
    low: Floats  # (D,) [1] of the recommended answer's interval
    high: Floats  # (D,) [1]

    @property
    def answer(self) -> str:
        """Say whose shares of the aspects the prediction takes."""
        return self.aspects.source("recommended")

    @property
    def ends(self) -> Floats:
        """(D, 2) [1] the 95 % interval of the share that was measured."""
        pairs = zip(self.measured.passed, self.measured.rejected)
        return np.array([[float(end[0]) for end in wilson([on], on + off)] for on, off in pairs])

    @property
    def agrees(self) -> Bools:
        """(D,) bool, whether the predicted and the measured interval have something in common."""
        low, high = self.ends.T
        return (self.low <= high) & (low <= self.high)

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of the files, by path."""
        return super().inputs | bowls.identity(self.config)


def feedings_table(tests: Iterable[FeedingStudy]) -> Frame:
    """Return what passed of the parts that came to each device, measured and predicted: ``devices.csv``.

    Parameters
    ----------
    tests : iterable of FeedingStudy

    Returns
    -------
    Frame
        A row a device of each test; what the rules predict is hidden.
    """
    rows = [(study, place) for study in tests for place in range(len(study.stations))]
    rules = dict.fromkeys(rule for study, _ in rows for rule in study.answers if rule != "recommended")
    return of_records([*FEEDING_COLUMNS, *map(_predicted_column, rules)], rows)


def _predicted_column(rule: str) -> Column[tuple[FeedingStudy, int]]:
    """Return the column of the share that passes by a rule; empty of a test without it."""

    def share(row: tuple[FeedingStudy, int]) -> float | None:
        study, place = row
        return float(study.answers[rule][place]) if rule in study.answers else None

    return Column(f"p_{rule}", share, "share", registry.heading(rule), hidden=True)


FEEDING_COLUMNS: tuple[Column[tuple[FeedingStudy, int]], ...] = (  # a row a device
    Column("set", lambda row: row[0].measured.source, hidden=True),
    Column("device", lambda row: row[0].stations[row[1]]),
    Column("passed", lambda row: int(row[0].measured.passed[row[1]])),
    Column("rejected", lambda row: int(row[0].measured.rejected[row[1]])),
    Column("measured", lambda row: float(row[0].measured.shares[row[1]]), "share"),
    Column("measured_low", lambda row: row[0].ends[row[1]][0], "share"),
    Column("measured_high", lambda row: row[0].ends[row[1]][1], "share"),
    Column("predicted", lambda row: float(row[0].answers["recommended"][row[1]]), "share"),
    Column("predicted_low", lambda row: float(row[0].low[row[1]]), "share"),
    Column("predicted_high", lambda row: float(row[0].high[row[1]]), "share"),
    Column("agrees", lambda row: bool(row[0].agrees[row[1]])),
)


@dataclass(frozen=True, eq=False)
class CompareStudy(_Counted, view="compare.COMPARE_VIEW"):
    """Profiles of one part, measured and by rule, and how far every two of them are apart."""

    part: Part
    aspects: Aspects
    measured: profiles.CountFile
    rules: tuple[profiles.AspectProfile, ...]
    comparisons: tuple[deviation.Comparison, ...]  # of every two, in the order of the profiles

    @property
    def profiles(self) -> tuple[profiles.AspectProfile, ...]:
        """Return what was measured, then the rules."""
        return (*self.measured.profiles, *self.rules)


@dataclass(frozen=True, eq=False)
class SetStudy(ReadableRecord):
    """One measured profile and every answer for its part."""

    part: Part
    aspects: Aspects
    measured: profiles.CountFile
    profile: profiles.AspectProfile
    answers: dict[str, profiles.AspectProfile]  # by rule, and the recommended one where there is one

    @property
    def recommended(self) -> Recommended | None:
        """The answer for the launch that was used; None of a card."""
        return self.aspects.recommended

    @property
    def distances(self) -> dict[str, float]:
        """Total variation [1] of the profile from each answer."""
        mine = self.profile.fractions / self.profile.fractions.sum()
        return {
            name: deviation.total_variation(mine, answer.fractions / answer.fractions.sum())
            for name, answer in self.answers.items()
        }

    @property
    def inside(self) -> int | None:
        """Return how many aspects' shares lie in the interval of the recommended answer; None without one."""
        if self.recommended is None:
            return None
        shares = self.profile.fractions
        return int(((self.recommended.low <= shares) & (shares <= self.recommended.high)).sum())


SET_COLUMNS: tuple[Column[SetStudy], ...] = (
    Column("file", lambda item: item.measured.source),
    Column("name", lambda item: item.profile.name),
)


@dataclass(frozen=True, eq=False)
class SetsStudy(ReadableRecord, view="compare.SETS_VIEW"):
    """Many measured profiles, each against every answer for its part, and feeding tests."""

    sets: tuple[SetStudy, ...]
    inputs: dict[str, str]  # sha256 by path
    feedings: tuple[FeedingStudy, ...] = ()  # the files that count by device

    @property
    def answers(self) -> tuple[str, ...]:
        """Every answer that some set has, in their order."""
        return tuple(dict.fromkeys(name for study in self.sets for name in study.answers))

    @property
    def series(self) -> dict[str, tuple[SetStudy, ...]]:
        """The sets by the series they say they belong to, else by their file."""
        by_series: dict[str, list[SetStudy]] = {}
        for study in self.sets:
            name = study.measured.head.series or Path(study.measured.source).stem
            by_series.setdefault(name, []).append(study)
        return {name: tuple(sets) for name, sets in by_series.items()}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what a user must not overlook, a sentence each."""
        studies: tuple[SetStudy | FeedingStudy, ...] = (*self.sets, *self.feedings)
        listed = [line for study in studies for line in study.measured.warnings(study.part)]
        listed += [f"{study.part.source}: {line}" for study in studies for line in study.aspects.warnings]
        return tuple(dict.fromkeys(listed))


@with_shown_signature
def compare(
    part: Part,
    counts: str | PathLike[str],
    *,
    launch: str | None = None,
    as_published: bool = False,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> CompareStudy | FeedingStudy:
    """Set the rules' probabilities beside counts of a test, as ``feeder compare PART --with COUNTS``.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    counts : str or Path
        CSV file with one line an aspect, one column a profile; or with one line a device.
    launch : str, optional
        What was done to the part; without it what the head of the file says, else 'feed'.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    progress, before : callable, optional
        As for ``shares``: for a file by device, parts are fed onto the moving floor of its bowl.

    Returns
    -------
    CompareStudy or FeedingStudy
        The second of a file that counts by device.

    Raises
    ------
    FeederError
        Every fault of the file, each with its line.
    """
    table, sha256 = _read(check.path("counts", counts))
    arguments.a_part(part)
    if profiles.counts_by_device(table):
        tested = profiles.device_counts(table, str(counts), sha256)
        return _feeding(part, tested, launch=launch, progress=progress, before=before)
    measured = _measured(part, table, str(counts), sha256)
    aspects, rules = _answers(part, table.head, launch, as_published)
    compared = deviation.compare((*measured.profiles, *rules))
    return CompareStudy(part, aspects, measured, rules, tuple(compared))


def compare_sets(
    files: Iterable[str | PathLike[str]],
    *,
    launch: str | None = None,
    as_published: bool = False,
    progress: Callable[..., None] | None = None,
) -> SetsStudy:
    """Study how far many measured sets are from every rule and from the recommended answer.

    Parameters
    ----------
    files : iterable of str or path
        Files of counts. The head of each names the part file, from the folder of the counts.
    launch : str, optional
        As for ``compare``.
    as_published : bool
        As for ``compare``.
    progress : callable, optional
        Called after every file with how many are done, and of how many.

    Returns
    -------
    SetsStudy

    Raises
    ------
    Faults
        Every fault of the files, one a line.
    FeederError
        If there is no file, or more than ``MAX_FILES``.
    """
    names = [str(path) for path in files]
    if not 0 < len(names) <= MAX_FILES:
        raise FeederError("files", f"are {len(names)}", f"name 1 to {MAX_FILES} files of counts")
    faults: list[FeederError] = []
    sets: list[SetStudy] = []
    feedings: list[FeedingStudy] = []
    inputs: dict[str, str] = {}
    for done, path in enumerate(names, 1):
        try:
            table, sha256 = _read(path)
            if not table.head.part:
                what = "does not say which part was counted"
                raise FeederError(path, what, "add a line '# part: FILE' at its top")
            folder = Path(path).parent
            aspect_names = str(folder / table.head.names) if table.head.names else None
            part = load(str(folder / table.head.part), names=aspect_names, **table.head.reading)
            inputs |= {path: sha256} | part.inputs
            if profiles.counts_by_device(table):
                feeding = _feeding(part, profiles.device_counts(table, path, sha256), launch=launch)
                feedings.append(feeding)
                inputs |= feeding.inputs
            else:
                measured = _measured(part, table, path, sha256)
                aspects, rules = _answers(part, table.head, launch, as_published)
                answers = {rule.name: rule for rule in rules}
                sets += [SetStudy(part, aspects, measured, profile, answers) for profile in measured.profiles]
        except FeederError as fault:
            faults += fault.faults if isinstance(fault, Faults) else [fault]
        if progress:
            progress(done, len(names))
    if faults:
        raise Faults(faults)
    return SetsStudy(tuple(sets), inputs, tuple(feedings))


def _read(path: str | PathLike[str]) -> tuple[profiles.CountSheet, str]:
    text, sha256 = profiles.read_count_text(path)
    return profiles.parse_count_sheet(text, str(path)), sha256


def _measured(part: Part, table: profiles.CountSheet, path: str, sha256: str) -> profiles.CountFile:
    """Return the counts by the aspects of the part: faults of the file come before the part is dropped."""
    aspects, rules = _answers(part, table.head, None, as_published=False, drops=0)
    return profiles.parse_profiles(table, path, sha256, aspects.names, [rule.name for rule in rules])


def _answers(
    part: Part, head: profiles.Head, launch: str | None, as_published: bool, drops: int | None = None
) -> tuple[Aspects, tuple[profiles.AspectProfile, ...]]:
    """The aspects of a part with the answer for a launch, and the profiles of all rules and of that."""
    launch = launch or head.launch or LAUNCH
    aspects = resting(part, as_published=as_published, launch=launch, drops=drops).aspects
    rules = profiles.rule_profiles(aspects)
    if aspects.recommended is not None:
        rules += (profiles.profile_of("recommended", "rule", aspects.recommended.p[aspects.stable]),)
    return aspects, rules


def _feeding(
    part: Part,
    counts: DeviceCounts,
    *,
    launch: str | None = None,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> FeedingStudy:
    """Return what passed the devices of the bowl that a feeding test names.

    The launch is what was done to the part; without it what the head of the file says, else parts are fed
    onto the moving floor of that bowl.
    """
    config, bowl = _bowl_of(counts)
    launch = launch or counts.head.launch or None
    aspects = shares(part, bowl, launch=launch, progress=progress, before=before).aspects
    flow, stations = _counted_flow(part, aspects, bowl, counts)
    if (answer := aspects.recommended) is None:
        raise ArgumentError("part", "is a part card, which meets no device", "give a mesh")
    low, high = map(check.frozen, stream.passing_ends(flow, answer.low, answer.high))
    answers = {rule: check.frozen(stream.passing_shares(flow, p)) for rule, p in aspects.chances.items()}
    return FeedingStudy(part, bowl, config, aspects, counts, stations, answers, low, high)


def _bowl_of(counts: DeviceCounts) -> tuple[str, Bowl]:
    if not counts.head.config:
        what = "counts by device but does not name the bowl"
        raise FeederError(counts.source, what, "add a line '# config: FILE' at its top")
    config = str(Path(counts.source).parent / counts.head.config)
    return config, bowls.read(config)


def _counted_flow(
    part: Part, aspects: Aspects, bowl: Bowl, counts: DeviceCounts
) -> tuple[Floats, tuple[str, ...]]:
    """(2, D, A) [1] of each aspect's parts what comes to each counted device and goes on; names of the D."""
    followed = stream.follow_orientations(part, aspects, bowl.track, bowl.devices, bowl=bowl)
    places = stream.counted_stations(followed, counts)
    flow = stream.station_shares(followed, aspects.names)[:, places]
    return flow, tuple(followed.names[place] for place in places)


@dataclass(frozen=True, eq=False)
class CalibrateStudy(_Counted, view="compare.CALIBRATE_VIEW"):
    """An exponent for every column of counts of one part, or for its feeding test."""

    part: Part
    aspects: Aspects
    measured: profiles.CountFile | DeviceCounts
    fits: tuple[Fit, ...]


FIT_COLUMNS: tuple[Column[Fit], ...] = (  # a row a column of counts
    Column("counts", lambda fit: fit.name),
    Column("parts", lambda fit: fit.parts),
    Column("exponent", lambda fit: fit.calibration.exponent),
    Column("exponent_low", lambda fit: fit.calibration.low),
    Column("exponent_high", lambda fit: fit.calibration.high),
    Column("chi_square", lambda fit: fit.calibration.chi_square.statistic),
    Column("degrees_of_freedom", lambda fit: fit.calibration.chi_square.degrees_of_freedom or None),
    Column("p_value", lambda fit: fit.calibration.chi_square.p_value),
)


@with_shown_signature
def calibrate(part: Part, counts: str | PathLike[str]) -> CalibrateStudy:
    """Fit the exponent of a surface to counts by aspect or by device, as ``feeder calibrate``.

    Parameters
    ----------
    part : Part
        From a mesh.
    counts : str or Path
        CSV file as for ``compare``.

    Returns
    -------
    CalibrateStudy

    Raises
    ------
    FeederError
        Every fault of the file, each with its line; if the part has no shape, no column holds counts, or they
        do not tell an exponent.
    """
    table, sha256 = _read(check.path("counts", counts))
    aspects = find(arguments.a_part(part))
    if not profiles.counts_by_device(table):
        measured = profiles.parse_profiles(table, str(counts), sha256, aspects.names)
        return CalibrateStudy(part, aspects, measured, tuple(fit_counts(part, aspects, measured)))
    tested = profiles.device_counts(table, str(counts), sha256)
    flow, _ = _counted_flow(part, aspects, _bowl_of(tested)[1], tested)
    return CalibrateStudy(part, aspects, tested, (fit_passes(part, aspects, tested, flow),))


Grid = tuple[Vector, ...]
VELOCITY = "velocity_mm_s"
SPREAD = "spread_mm_s"
PARTS = "parts"
MAX_BYTES = 200_000
MAX_ROWS = 200
LEAST_DOUBT = 0.03  # [1] of a velocity: what a film and a point mass leave open at least (assumption)
QUANTITIES = ("friction", "restitution", "stroke")
COARSE_GRID = (np.linspace(0.1, 1.0, 19), np.linspace(0.0, 0.8, 9), np.linspace(0.85, 1.15, 9))
FINE = 9  # values of each quantity between the neighbours of the best
LEVEL = 0.95  # of the intervals


@dataclass(frozen=True, eq=False)
class BowlFit:
    """Friction, restitution and stroke that explain N measured velocities, and what remains of each."""

    settings: tuple[str, ...]  # (N,) of the bowl's keys, as the file writes them
    measured: Vector  # (N,) [m/s]
    doubt: Vector  # (N,) [m/s] standard error, LEAST_DOUBT at least
    file: Vector  # (N,) [m/s] by the bowl file as it stands
    fitted: Vector  # (N,) [m/s]
    values: Vector  # (3,) [1] friction, restitution, stroke over that of the file
    low: Vector  # (3,) [1] ends of the intervals
    high: Vector  # (3,) [1]
    assumed: Vector  # (3,) [1] what the bowl file says
    misfit: float  # [1] chi-square over the degrees of freedom; NaN where there are none

    @property
    def open_ended(self) -> Bools:
        """(3,) whether an interval reaches an end of what was tried: the velocities do not decide it."""
        ends = np.array([(values[0], values[-1]) for values in COARSE_GRID])
        return (self.low <= ends[:, 0]) | (self.high >= ends[:, 1])


FIT_QUANTITY_COLUMNS: tuple[Column[BowlFit], ...] = (  # a row a quantity
    Column("quantity", lambda fit: QUANTITIES),
    Column("bowl_file", lambda fit: fit.assumed),
    Column("fitted", lambda fit: fit.values),
    Column("low", lambda fit: fit.low),
    Column("high", lambda fit: fit.high),
    Column(
        "decided",
        lambda fit: ["not decided by these velocities" if is_open else "yes" for is_open in fit.open_ended],
    ),
)
FIT_VELOCITY_COLUMNS: tuple[Column[BowlFit], ...] = (  # a row a velocity
    Column("setting", lambda fit: [setting or "as the bowl file" for setting in fit.settings]),
    Column("measured_mm_s", lambda fit: fit.measured, "mm/s"),
    Column("doubt_mm_s", lambda fit: fit.doubt, "mm/s"),
    Column("bowl_file_mm_s", lambda fit: fit.file, "mm/s"),
    Column("fitted_mm_s", lambda fit: fit.fitted, "mm/s"),
    Column("remains_mm_s", lambda fit: fit.measured - fit.fitted, "mm/s"),
)


def fit_bowl(path: str | Path, bowl_path: str | Path | None = None) -> BowlFit:
    """Return which friction, restitution and stroke explain the velocities of a file best.

    S = sum ((v_k - v(mu, e, A)) / s_k)^2 is least over a grid, then over a finer one about its best. An
    interval holds the values for which S, least over the two other quantities, rises by less than
    chi-square's 95 % of one quantity. If the best does not explain the velocities, intervals are wider by the
    square root of S over its degrees of freedom. None is narrower than the grid.

    Parameters
    ----------
    path : str or path
        CSV with a column for each key of the bowl file that was changed ('drive.amplitude'), then
        'velocity_mm_s', and 'spread_mm_s' and 'parts' where several parts were filmed.
    bowl_path : str or path, optional
        Bowl file with the values that were not changed; the defaults without it.

    Returns
    -------
    BowlFit

    Raises
    ------
    ConfigError
        If a file cannot be read, or there are fewer than three velocities.

    References
    ----------
    Weighted least squares; the profile of the sum of squares against chi-square of one degree of freedom.
    """
    rows = _read_velocities(path)
    measured, doubt = (np.array([row[place] for row in rows]) for place in (1, 2))
    own = [conveying.conveying(bowls.read(bowl_path, row[0])) for row in rows]
    assumed = np.array([own[0].friction.static, own[0].restitution, 1.0])
    sums = _sums(own, measured, doubt, COARSE_GRID)
    place = np.unravel_index(np.nanargmin(sums), sums.shape)
    best = [values[k] for values, k in zip(COARSE_GRID, place)]
    steps = [values[1] - values[0] for values in COARSE_GRID]
    near = tuple(
        np.linspace(max(value - step, values[0]), min(value + step, values[-1]), FINE)
        for values, value, step in zip(COARSE_GRID, best, steps)
    )
    fine_sums = _sums(own, measured, doubt, near)
    if np.nanmin(fine_sums) <= np.nanmin(sums):
        place = np.unravel_index(np.nanargmin(fine_sums), fine_sums.shape)
        best = [values[k] for values, k in zip(near, place)]
    least, free = float(np.nanmin([np.nanmin(sums), np.nanmin(fine_sums)])), len(rows) - len(QUANTITIES)
    misfit = least / free if free > 0 else np.nan
    rise = stats.chi2.ppf(LEVEL, 1) * max(1.0, misfit if free > 0 else 1.0)
    grids = (COARSE_GRID, sums), (near, fine_sums)
    ends = [_ends(k, grids, least + rise) for k in range(len(QUANTITIES))]
    step = [values[1] - values[0] for values in near]  # an interval is no narrower than the grid
    bounds = np.array([(values[0], values[-1]) for values in COARSE_GRID]).T
    low, high = np.clip(np.array(ends).T + np.array([[-1.0], [1.0]]) * step, *bounds)
    values, settings = np.array(best), tuple(", ".join(row[0]) for row in rows)
    columns = {"measured": measured, "doubt": doubt, "values": values, "low": low, "high": high}
    columns |= {"file": _velocities(own, assumed), "fitted": _velocities(own, values), "assumed": assumed}
    arrays = {name: check.frozen(column) for name, column in columns.items()}
    return BowlFit(settings=settings, misfit=misfit, **arrays)


def _ends(axis: int, grids: tuple, limit: float) -> tuple[float, float]:
    """Least and greatest value of a quantity whose best sum over the two others stays below a limit."""
    inside = []
    for tried, sums in grids:
        other_axes = tuple(k for k in range(len(QUANTITIES)) if k != axis)
        best = np.nanmin(np.where(np.isfinite(sums), sums, np.inf), axis=other_axes)
        inside += list(tried[axis][best <= limit])
    return min(inside), max(inside)


def _sums(own: list[Bowl], measured: Vector, doubt: Vector, grid: Grid) -> Vector:
    """Sum of squares (F, R, S) over a grid of friction, restitution and stroke."""
    shaped = np.ix_(*grid)
    sums = np.zeros(tuple(len(values) for values in grid))
    for bowl, velocity, error in zip(own, measured, doubt):
        ours = conveying.cells(_with(bowl, *shaped))["velocity"]
        sums = sums + ((np.where(np.isfinite(ours), ours, np.inf) - velocity) / error) ** 2
    return sums


def _velocities(own: list[Bowl], values: Vector) -> Vector:
    return np.array([float(conveying.answer(_with(bowl, *map(float, values))).velocity) for bowl in own])


def _with(bowl: Bowl, friction: Any, restitution: Any, stroke: Any) -> Bowl:
    """Return a bowl of another friction, the other coefficients in proportion, restitution and stroke."""
    factor, drive = friction / bowl.friction.static, bowl.drive
    scaled = {name: value * factor for name, value in vars(bowl.friction).items() if value is not None}
    drive = replace(drive, amplitude=drive.amplitude * stroke)
    return replace(bowl, friction=replace(bowl.friction, **scaled), restitution=restitution, drive=drive)


def _read_velocities(path: str | Path) -> list[tuple[tuple[str, ...], float, float]]:
    data = documents.content(path, MAX_BYTES, "a CSV of velocities")
    lines = [line for line in documents.decoded(data, str(path)).splitlines() if not line.startswith("#")]
    table = csv.DictReader(io.StringIO("\n".join(lines)), skipinitialspace=True)
    if VELOCITY not in (table.fieldnames or ()):
        mend = f"begin with a line such as drive.amplitude,{VELOCITY},{SPREAD},{PARTS}"
        raise ConfigError(str(path), f"has no column '{VELOCITY}'", mend)
    rows = []
    for number, row in enumerate(table, 1):
        keys = tuple(f"{k}={v}" for k, v in row.items() if k and v and k not in (VELOCITY, SPREAD, PARTS))
        velocity, spread, parts = (_number(path, number, row, name) for name in (VELOCITY, SPREAD, PARTS))
        if not np.isfinite(velocity):
            raise ConfigError(f"{path}: velocity {number}", "is missing", "write mm/s, or leave the line out")
        error = 0.0 if np.isnan(spread) else spread / np.sqrt(1.0 if np.isnan(parts) else max(parts, 1.0))
        rows.append((keys, 1e-3 * velocity, 1e-3 * max(error, LEAST_DOUBT * abs(velocity), 0.1)))
    if not len(QUANTITIES) <= len(rows) <= MAX_ROWS:
        what = f"has {len(rows)} velocities"
        raise ConfigError(str(path), what, f"give {len(QUANTITIES)} to {MAX_ROWS}, at several strokes")
    return rows


def _number(path: str | Path, line: int, row: dict, name: str) -> float:
    """A number of a cell; NaN where it is empty."""
    text = (row.get(name) or "").strip()
    try:
        value = float(text) if text else np.nan
    except ValueError:
        value = np.inf
    if np.isinf(value):
        raise ConfigError(f"{path}: velocity {line}", f"{name} {text[:40]!r} is not a number", "write mm/s")
    return value
