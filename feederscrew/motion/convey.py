"""The study of ``feeder convey``: how fast a part travels, at one point, along a curve, over a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base.arrays import Array, Bools, Floats, Ints
from feederscrew.base.columns import Column, Frame, of_arrays
from feederscrew.base.geometry import grids
from feederscrew.base.records import ReadableRecord
from feederscrew.base.units import DEG, MM
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import former_keywords
from feederscrew.bowl.reading import KeyRange, Setting
from feederscrew.bowl.record import Bowl, BowlGrid
from feederscrew.motion import conveying as answer
from feederscrew.motion import steady
from feederscrew.motion.conveying import Neighbours
from feederscrew.motion.steady import STATUSES, MotionStatus


@dataclass(frozen=True, eq=False)
class ConveyStudy(ReadableRecord, view="convey.CONVEY_VIEW"):
    """One operating point of a bowl, and its neighbours."""

    bowl: Bowl
    answer: answer.Answer

    @cached_property
    def nearby(self) -> dict[str, Neighbours]:
        """Velocities with each quantity ``answer.SENSITIVITY_CHANGE`` lower and higher."""
        return answer.sensitivity(self.bowl)

    @cached_property
    def doubt(self) -> Neighbours:
        """Velocities for friction ``answer.FRICTION_DOUBT`` lower and higher, Neighbours."""
        return answer.friction_doubt(self.bowl)

    @cached_property
    def rebound(self) -> Neighbours | None:
        """Velocities at both ends of the spread of restitution; None where nothing is thrown up."""
        return answer.restitution_doubt(self.bowl) if self.answer.throw_number > 1.0 else None

    @property
    def validity(self) -> str:
        """Return what the answer leaves out, in one sentence."""
        return answer.validity(self.answer, self.bowl)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what is odd about the velocity, a tuple of at most one sentence."""
        return tuple(answer.speed_remark(self.answer.velocity, self.bowl.sizing))

    def trace(self) -> steady.CycleTrace:
        """Follow plate and part over one steady cycle, as a ``motion.steady.CycleTrace``."""
        return steady.trace(self.answer.setting)


@dataclass(frozen=True, eq=False)
class ConveyCurve(ReadableRecord, view="convey.CURVE_VIEW"):
    """Motion of a part along one quantity of the bowl; N points."""

    kind: str  # 'curve' over a key, or 'radius'
    over: str  # what varies: the key's name, or 'the radius'
    axes: tuple[grids.GridAxis, ...]  # the quantity, then what follows from it; (N,) values each
    cells: dict[str, Array]  # (N,) as ``motion.conveying.cells`` names them, in SI

    @property
    def statuses(self) -> Ints:
        """Return the status of each point, (N,) of ``STATUSES``."""
        return np.asarray(STATUSES)[self.cells["status"]]

    def table(self) -> Frame:
        """Return its points, a row each: ``convey_curve.csv``, ``convey_radius.csv``."""
        axes = {axis.column: axis.in_unit for axis in self.axes}
        return _behind_axes(self.axes, axes, of_arrays(CURVE_COLUMNS, self))

    @property
    def several(self) -> Bools:
        """Return where a part has several steady velocities, (N,) bool."""
        spread, high = self.cells["high"] - self.cells["low"], np.abs(self.cells["high"])
        return (self.statuses == MotionStatus.PERIODIC) & (spread > answer.COEXISTING_VELOCITY_GAP * high)


CURVE_COLUMNS: tuple[Column[ConveyCurve], ...] = (  # behind those of its axes
    Column("velocity_mm_s", lambda curve: curve.cells["velocity"], "mm/s"),
    Column("velocity_low_mm_s", lambda curve: curve.cells["low"], "mm/s"),
    Column("velocity_high_mm_s", lambda curve: curve.cells["high"], "mm/s"),
    Column("regime", lambda curve: np.asarray(answer.SWEEP_REGIMES)[curve.cells["regime"]]),
    Column("throw_number", lambda curve: curve.cells["throw_number"]),
    Column("status", lambda curve: curve.statuses),
)


@dataclass(frozen=True, eq=False)
class ConveyPhase(ReadableRecord, view="convey.PHASE_VIEW"):
    """Effect of the phase of an elliptical drive in a bowl."""

    bowl: Bowl
    best: answer.BestPhase

    @property
    def curve(self) -> ConveyCurve:
        """Return the velocities over the phase, as a ConveyCurve."""
        axis = grids.GridAxis("phase_deg", self.best.phases, DEG, "deg")
        return ConveyCurve("phase", "drive.phase", (axis,), self.best.cells)


@dataclass(frozen=True, eq=False)
class ConveyMap(ReadableRecord, view="convey.MAP_VIEW"):
    """Motion of a part over two keys of the bowl."""

    ranges: tuple[KeyRange, KeyRange]
    grid: grids.Grid  # velocities [m/s], several, throw_number [1], status; the codes are the regimes
    line: BowlGrid | None  # operating points to be drawn over the map; None if not asked for

    @property
    def statuses(self) -> Ints:
        """Return the status of each cell, (N1, N2) of ``STATUSES``."""
        return np.asarray(STATUSES)[self.grid.values["status"].astype(int)]

    def table(self) -> Frame:
        """Return its cells, a row each, the second key running fastest: ``convey_map.csv``."""
        axes = (self.grid.first, self.grid.second)
        cells = self.grid.columns()
        return _behind_axes(axes, {a.column: cells[a.column] for a in axes}, of_arrays(MAP_COLUMNS, self))


def _behind_axes(axes: Sequence[grids.GridAxis], places: Mapping[str, Array], table: Frame) -> Frame:
    """Return a table with the quantities that vary before its columns."""
    return Frame.of({**places, **table}, {axis.column: axis.head for axis in axes} | table.heads)


MAP_COLUMNS: tuple[Column[ConveyMap], ...] = (  # behind those of its axes
    Column("velocity_mm_s", lambda over: over.grid.values["velocity"].ravel(), "mm/s"),
    Column("velocity_low_mm_s", lambda over: over.grid.values["low"].ravel(), "mm/s"),
    Column("velocity_high_mm_s", lambda over: over.grid.values["high"].ravel(), "mm/s"),
    Column("regime", lambda over: over.grid.columns()["regime"]),
    Column("throw_number", lambda over: over.grid.values["throw_number"].ravel()),
    Column("status", lambda over: over.statuses.ravel()),
)


@former_keywords()
def convey(bowl: Bowl) -> ConveyStudy:
    """Compute how a part travels on the bowl's track, as ``feeder convey``.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    ConveyStudy
        Its ``answer`` has the velocity in m/s, status, regime and margins.

    Raises
    ------
    ConfigError
        If the bowl cannot convey.

    References
    ----------
    docs/conveying.md: a point on the track, solved from event to event.
    """
    bowl = arguments.a_bowl(bowl)
    return ConveyStudy(bowl, answer.answer(bowl))


def curve(settings: Sequence[Setting], span: KeyRange) -> ConveyCurve:
    """Study a bowl along one of its keys.

    Parameters
    ----------
    settings : sequence of Setting
        Of the bowl.
    span : KeyRange
        Key and its values.

    Returns
    -------
    ConveyCurve
    """
    columns = answer.cells(bowls.swept(settings, {span.key.name: np.array(span.values)}))
    cells = {name: np.broadcast_to(values, len(span.values)) for name, values in columns.items()}
    return ConveyCurve("curve", span.key.name, (span.axis,), cells)


def along_radius(bowl: Bowl) -> ConveyCurve:
    """Study a bowl along its radius, inwards, where its angle is steeper.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    ConveyCurve

    Raises
    ------
    ConfigError
        If the drive is elliptical.
    """
    there = answer.inwards(bowl)
    axes = (
        grids.GridAxis("radius_mm", np.asarray(there.track.radius), MM, "mm"),
        grids.GridAxis("vibration_angle_deg", np.asarray(there.drive.vibration_angle), DEG, "deg"),
        grids.GridAxis("amplitude_mm", np.asarray(there.drive.amplitude), MM, "mm"),
    )
    return ConveyCurve("radius", "the radius", axes, answer.cells(there))


def best_phase(bowl: Bowl) -> ConveyPhase:
    """Study a bowl over the phase of its drive.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    ConveyPhase

    Raises
    ------
    ConfigError
        If the bowl cannot convey, or has no steady velocity at any phase.
    """
    return ConveyPhase(bowl, answer.best_phase(bowl))


def velocity_map(
    settings: Sequence[Setting], ranges: Sequence[KeyRange], *, drawn: str | None = None
) -> ConveyMap:
    """Study a bowl over two of its keys.

    Parameters
    ----------
    settings : sequence of Setting
        Of the bowl.
    ranges : (KeyRange, KeyRange)
        The two keys and their values.
    drawn : str, optional
        What is drawn over the map: the bowl's own 'point', or its points along the 'radius'.

    Returns
    -------
    ConveyMap
    """
    first, second = ranges

    def function(x: Floats, y: Floats) -> dict[str, Array]:
        return answer.cells(bowls.swept(settings, {first.key.name: x, second.key.name: y}))

    grid = grids.evaluate(first.axis, second.axis, function, answer.SWEEP_REGIMES)
    bowl = bowls.record(settings)
    line = answer.inwards(bowl) if drawn == "radius" else bowl
    return ConveyMap((first, second), grid, line if drawn else None)
