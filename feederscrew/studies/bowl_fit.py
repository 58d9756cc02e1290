"""The study of ``feeder compare --bowl``: the friction, restitution and stroke behind measured velocities."""

import csv
import io
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import bowl as bowls
from feederscrew import check, documents
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.errors import ConfigError
from feederscrew.heavy import heavy

stats = heavy("scipy.stats")

Vector = NDArray[np.float64]
Grid = tuple[Vector, ...]
VELOCITY, SPREAD, PARTS = "velocity_mm_s", "spread_mm_s", "parts"
MAX_BYTES, MAX_ROWS = 200_000, 200
LEAST_DOUBT = 0.03  # [1] of a velocity: what a film and a point mass leave open at least (assumption)
QUANTITIES = ("friction", "restitution", "stroke")
COARSE_GRID = (np.linspace(0.1, 1.0, 19), np.linspace(0.0, 0.8, 9), np.linspace(0.85, 1.15, 9))
FINE, LEVEL = 9, 0.95  # values of each quantity between the neighbours of the best; of the intervals


@dataclass(frozen=True, eq=False)
class BowlFit:
    """What explains N measured velocities, and what remains of each."""

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
    def open_ended(self) -> NDArray[np.bool_]:
        """(3,) whether an interval reaches an end of what was tried: the velocities do not decide it."""
        ends = np.array([(values[0], values[-1]) for values in COARSE_GRID])
        return (self.low <= ends[:, 0]) | (self.high >= ends[:, 1])


def fit_bowl(path: str | Path, bowl_path: str | Path | None = None) -> BowlFit:
    """Return which friction, restitution and stroke explain the velocities of a file best.

    The least sum of squares over a grid, then over a finer one about its best; an interval holds the values
    for which the sum rises by less than chi-square's 95 % of one quantity, whatever the two others are. Where
    the best does not explain the velocities, intervals are wider by the root of what remains.

    The CSV ``path`` has columns of keys of the bowl file that were changed ('drive.amplitude'), then
    'velocity_mm_s', and 'spread_mm_s' and 'parts' where several parts were filmed. The bowl file
    ``bowl_path`` has what was not changed; the defaults without it. Raises ConfigError if a file cannot
    be read, or there are fewer than three velocities.
    """
    rows = _read(path)
    measured, doubt = (np.array([row[place] for row in rows]) for place in (1, 2))
    own = [answer.conveying(bowls.read(bowl_path, row[0])) for row in rows]
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
        ours = answer.cells(_with(bowl, *shaped))["velocity"]
        sums = sums + ((np.where(np.isfinite(ours), ours, np.inf) - velocity) / error) ** 2
    return sums


def _velocities(own: list[Bowl], values: Vector) -> Vector:
    return np.array([float(answer.answer(_with(bowl, *map(float, values))).velocity) for bowl in own])


def _with(bowl: Bowl, friction: Any, restitution: Any, stroke: Any) -> Bowl:
    """Return a bowl of another friction, the other coefficients in proportion, restitution and stroke."""
    factor, drive = friction / bowl.friction.static, bowl.drive
    scaled = {name: value * factor for name, value in vars(bowl.friction).items() if value is not None}
    drive = replace(drive, amplitude=drive.amplitude * stroke)
    return replace(bowl, friction=replace(bowl.friction, **scaled), restitution=restitution, drive=drive)


def _read(path: str | Path) -> list[tuple[tuple[str, ...], float, float]]:
    data = documents.content(path, MAX_BYTES, "a CSV of velocities")
    lines = [line for line in documents.decoded(data, str(path)).splitlines() if not line.startswith("#")]
    table = csv.DictReader(io.StringIO("\n".join(lines)), skipinitialspace=True)
    if VELOCITY not in (table.fieldnames or ()):
        what = f"has no column '{VELOCITY}'"
        raise ConfigError(
            str(path), what, f"begin with a line such as drive.amplitude,{VELOCITY},{SPREAD},{PARTS}"
        )
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
