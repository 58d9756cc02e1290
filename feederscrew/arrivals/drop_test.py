"""One drop test of one part, from aspects to counts; and single drops, followed until the part lies still.

Source: docs/resting.md, "The drop test".
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.arrivals import ensemble, launch_conditions
from feederscrew.arrivals.ensemble import Aim, Drops, Tally
from feederscrew.arrivals.kernel import body, falling, one_drop
from feederscrew.arrivals.launch_conditions import Starts, sample
from feederscrew.arrivals.rounded_hull import Shape, lowest_on, principal_axes, shape_of_part
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import on_disk
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import USUAL_RUN, RunSettings
from feederscrew.base.units import GRAVITY
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, require_ground
from feederscrew.resting.exact_tumbling import Ground

DEFAULT_DROPS = 10_000  # drops, where the user names neither a number nor a width
ROW_INTERVAL = 0.05  # sqrt(L / g) from one row of a trace that is kept to the next, at least
MAX_TRACE_ROWS = 1000  # such rows; a longer drop has them further apart
MAX_IMPACTS = 250  # impacts that are kept, those that take most energy
FIRST_TRACE_ROWS = 8192  # of a trace at first; a longer drop is followed again with twice as many
STILL_ENERGY = 3e-3  # over a face's height at which a part lies still on it, contact tolerance included
ROWS_AT_ONCE = 256  # rows whose corners are looked at together
TUMBLED_RAD = np.radians(90.0)  # of the underside, from which on a part has tumbled


@dataclass(frozen=True, eq=False)
class DropTrace:
    """Motion of one drop, N rows, some hundreds: at even times, before and after every impact, and the end.

    Rows are steps of the simulation, and of free flight between two of them, about
    ROW_INTERVAL sqrt(L / g) apart, further if there would be more than MAX_TRACE_ROWS; of more than
    MAX_IMPACTS impacts those that take most energy. Positions are of the centre of mass, over the plane
    z = 0; the launch is at x = y = 0.
    """

    number: int  # of the drop, from 1
    face: int  # it is counted on, UNSETTLED for none
    row: int  # class of that face, UNSETTLED for none
    decided: float  # [s] when that face was certain, and the drop counted
    still: bool  # followed until it lies still on that face; else it ends when that face is certain
    times: Floats  # (N,) [s]
    positions: Floats  # (N, 3) [m]
    attitudes: Floats  # (N, 4) quaternions w x y z, from the file's axes to the plane's
    energies: Floats  # (N,) [m] kinetic and of height, over m g
    impacts: Bools  # (N,) bool, a corner comes down: the state just before

    @property
    def turns(self) -> Rotation:
        """Return rotations from the file's axes to the plane's."""
        return Rotation.from_quat(np.roll(self.attitudes, -1, axis=1))

    def tumbled(self) -> bool:
        """Return whether the underside of the first impact later turns by more than a quarter of a circle."""
        down = self.turns.inv().apply([0.0, 0.0, -1.0])[np.argmax(self.impacts) :]
        across = np.linalg.norm(np.cross(down, down[0]), axis=1)
        return bool((np.arctan2(across, vectors.product(down, down[0])) > TUMBLED_RAD).any())


@dataclass(frozen=True, eq=False)
class Result(ReadableRecord):
    """A drop test and how to repeat it."""

    launch: dict  # name and ranges sampled, in the units of the shop
    seed: int
    ground: Ground
    drops: Drops
    tally: Tally
    heights: Floats  # (A,) [m] of the centre of mass on each class; over the true circle of a round side
    aim: float | None = None  # [1] half-width the intervals were to reach
    traces: tuple[DropTrace, ...] = ()  # of the first drops
    single: float | None = None  # [1] restitution given as one value, which scatters as that of impacts does


def test(
    part: Part,
    aspects: Aspects,
    preset: str,
    own: Mapping[str, str | None],
    *,
    drops: int | None = None,
    until: str | None = None,
    traced: int = 0,
    dropped: Drops | None = None,
    run: RunSettings = USUAL_RUN,
) -> Result:
    """Drop a part and count the aspects it rests on.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    preset : str
        A key of ``launch_conditions.PRESETS``.
    own : mapping of str to str or None
        Ranges that replace the preset's, as typed: ``launch_conditions.launch_of``.
    drops : int, optional
        How many; with ``until`` at most so many.
    until : str, optional
        Go on until every class's 95 % interval is this narrow to either side, '1%'.
    traced : int
        Of how many drops, from the first, the motion is kept as well.
    dropped : Drops, optional
        Of a run of the same arguments: nothing is dropped then.
    run : RunSettings
        Its progress is as in ``ensemble.drop``.

    Returns
    -------
    Result

    Raises
    ------
    FeederError
        If the part has no shape, or an option is no such quantity or out of range.
    ValueError
        If ``dropped`` is of another part.
    KeyboardInterrupt
        If the user stops it before there is anything to count; later, the result is partial.
    """
    width = None if until is None else launch_conditions.share(until, "until")
    faces, count = require_ground(part, aspects), len(aspects.names)
    shape, length = shape_of_part(part, faces)
    launch = launch_conditions.launch_of(preset, length, own)
    single = launch_conditions.single(own.get("restitution"))
    launch = launch if single is None else launch.scattering()
    if dropped is None:
        run.begin()
        dropped = ensemble.drop(
            shape,
            launch,
            np.random.default_rng(run.seed),
            count=DEFAULT_DROPS if drops is None and until is None else drops,
            aim=None if width is None else Aim(width, faces.rows, count),
            jobs=run.jobs,
            progress=run.progress,
        )
    elif len(dropped.faces) and dropped.faces.max() >= len(faces.rows):
        raise ValueError("a drop rests on a face that the part has not")
    counted = ensemble.tally(dropped, faces.rows, count, surface=own.get("restitution") is not None)
    starts = sample(launch, shape, min(traced, len(dropped.faces)), np.random.default_rng(run.seed))
    traces = follow(shape, length, principal_axes(part.inertia)[1], starts, dropped, faces.rows)
    # Heights of the classes from those of the shape's faces; of a class without one as it was.
    lowest = np.full(count, np.inf)
    np.minimum.at(lowest, faces.rows, length * shape.heights)
    heights = check.frozen(np.where(np.isfinite(lowest) & (lowest > 0.0), lowest, aspects.heights))
    described = launch_conditions.described(launch, length)
    return Result(described, run.seed, faces, dropped, counted, heights, width, traces, single)


def compiled() -> bool:
    """Return whether the drop kernel is on disk already; else the first drop on a machine compiles it."""
    return on_disk(one_drop.settle_all)


def follow(
    shape: Shape,
    length: float,
    principal: Floats,
    starts: Starts,
    drops: Drops,
    rows: Ints,
) -> tuple[DropTrace, ...]:
    """Follow the first drops of a test once more.

    A drop is counted once its face is certain, while the part still moves. The trace goes on until it lies
    still. Should that be on another face, balanced on an edge, or never, as with a part that rolls on and on,
    it ends where the drop was counted.

    Parameters
    ----------
    shape : Shape
    length : float [m]
        Of the shape.
    principal : (3, 3) float [1]
        Columns are the shape's axes along the file's: ``rounded_hull.principal_axes``.
    starts : Starts
        Of the drops that are followed.
    drops : Drops
        Their outcome, in the same order; there may be more.
    rows : (F,) int
        Class of each face.

    Returns
    -------
    tuple of DropTrace

    References
    ----------
    docs/resting.md, "The drop test".
    """
    to_body = Rotation.from_matrix(np.array(principal.T))
    second = np.sqrt(length / GRAVITY)
    traces = []
    for k, start in enumerate(starts.states):
        face, surface = int(drops.faces[k]), (starts.restitutions[k], starts.frictions[k])
        # To rest on that face; else, to where the drop was counted.
        still = False
        if face != one_drop.UNSETTLED:
            end, states = _path(shape, start, *surface, falling.Steps(early=False))
            still = end == face and _energies(shape, states[-1:])[0] - shape.heights[face] < STILL_ENERGY
        if not still:
            _, states = _path(shape, start, *surface, falling.Steps())
        # Further rows in long steps of free flight, at most ROW_INTERVAL apart; followed back from the end of
        # the step, as an impact may come before its flight.
        path = [states[:1]]
        for after, step in zip(states[1:], np.diff(states[:, 0])):
            count = int(np.ceil(step / ROW_INTERVAL))
            between = np.repeat(after[None], max(count - 1, 0), axis=0)
            for row, dt in zip(between, step / max(count, 1) * np.arange(count - 1, 0, -1)):
                row[0] -= dt
                body.fly(row[1:], shape.solid.inertia, -dt)
            path += [between, after[None]]
        states = np.vstack(path)
        # Of the impacts those that take most energy; of the rows those that are kept.
        energies, struck = _energies(shape, states), np.flatnonzero(_impacts(shape, states))
        losses = energies[struck] - np.append(energies, energies[-1])[struck + 1]
        impacts = np.zeros(len(states), bool)
        impacts[struck[np.argsort(-losses, kind="stable")[:MAX_IMPACTS]]] = True
        times = states[:, 0]
        kept = np.diff(np.floor(times / max(ROW_INTERVAL, times[-1] / MAX_TRACE_ROWS)), prepend=-1.0) > 0.0
        kept[-1] = True
        kept[np.searchsorted(times, drops.times[k]).clip(max=len(times) - 1)] = True
        kept |= impacts | np.roll(impacts, 1)
        states = states[kept]
        attitudes = (_turns(states) * to_body).as_quat()
        traces.append(
            DropTrace(
                number=k + 1,
                face=face,
                row=int(rows[face]) if face != one_drop.UNSETTLED else one_drop.UNSETTLED,
                decided=float(second * drops.times[k]),
                still=bool(still),
                times=check.frozen(second * states[:, 0]),
                positions=check.frozen(length * states[:, 1 : 1 + body.VX]),
                attitudes=check.frozen(np.roll(attitudes, 1, axis=1)),
                energies=check.frozen(length * energies[kept]),
                impacts=check.frozen(impacts[kept]),
            )
        )
    return tuple(traces)


def _path(
    shape: Shape, start: Floats, restitution: float, friction: float, steps: falling.Steps
) -> tuple[int, Floats]:
    """Return the face, and (N, 14) time and state at the start of every step and at the end."""
    rows = FIRST_TRACE_ROWS
    while True:
        work = falling.scratch(shape, rows=rows)
        work.state[:] = start
        face, time, used = one_drop.settle(shape, work, restitution, friction, steps)
        if used < rows:
            break
        rows *= 2
    steady = work.trace[:used][work.trace[:used, 0] < time]  # the end replaces a row of the same time
    return face, np.vstack([steady, [time, *work.state]])


def _turns(states: Floats) -> Rotation:
    """Return the rotations from the principal axes to the plane's, of rows (N, 14)."""
    return Rotation.from_quat(states[:, 1 + body.Q + np.array([1, 2, 3, 0])])


def _impacts(shape: Shape, states: Floats) -> Bools:
    """Return the rows (N,) at which a corner on the plane comes down fast enough to rebound."""
    steps = falling.Steps()
    up = _turns(states).inv().apply([0.0, 0.0, 1.0])
    speeds = np.cross(up, states[:, 1 + body.W : 1 + body.W + 3])
    struck = np.zeros(len(states), bool)
    for first in range(0, len(states), ROWS_AT_ONCE):
        part = slice(first, first + ROWS_AT_ONCE)
        corners = np.broadcast_to(shape.solid.vertices, (len(up[part]), *shape.solid.vertices.shape))
        points = np.concatenate([corners, lowest_on(shape, up[part])], axis=1)
        gaps = states[part, 1 + body.Z, None] + np.einsum("ni,nvi->nv", up[part], points)
        rising = states[part, 1 + body.VZ, None] + np.einsum("ni,nvi->nv", speeds[part], points)
        struck[part] = ((gaps <= steps.tolerance) & (rising < -steps.threshold)).any(axis=1)
    return struck


def _energies(shape: Shape, states: Floats) -> Floats:
    """Return the total energy (N,) at mass 1 and gravity 1: (v^2 + w I w) / 2 + z."""
    velocities, rates = states[:, 1 + body.VX : 1 + body.Q], states[:, 1 + body.W :]
    turning = 0.5 * vectors.product(rates**2, shape.solid.inertia)
    return 0.5 * (velocities**2).sum(axis=1) + turning + states[:, 1 + body.Z]


def telling(traces: Sequence[DropTrace]) -> DropTrace:
    """Return the drop to show: the first that tumbled and lies still, else that tumbled, else the first."""
    return min(traces, key=lambda trace: (not trace.tumbled(), not trace.still, trace.number))


def chosen(trace: DropTrace, count: int) -> Ints:
    """Return the rows of the stills: first impact, end, others at equal shares of what goes on.

    What goes on is, half by half, how far the part turns and how much energy it loses (in powers), and by a
    quarter how long it takes.

    Parameters
    ----------
    trace : DropTrace
    count : int
        Stills.

    Returns
    -------
    (count,) int
    """
    first = int(np.argmax(trace.impacts))
    turned = (trace.turns[first + 1 :] * trace.turns[first:-1].inv()).magnitude()
    lost = -np.diff(np.log(trace.energies[first:])).clip(max=0.0)
    lost = lost.clip(max=0.5 * lost.sum() / count)  # one hard hit is one still
    distance = sum(
        share * np.cumsum(steps) / max(steps.sum(), 1e-9)
        for share, steps in ((0.5, turned), (0.5, lost), (0.25, np.diff(trace.times[first:])))
    )
    distance = np.append(0.0, distance)
    rows = first + np.searchsorted(distance, np.linspace(0.0, distance[-1], count) - 1e-9)
    rows = rows.clip(max=len(trace.times) - 1)
    rows[1:-1] -= trace.impacts[rows[1:-1] - 1]  # the hit, not the step after it
    return rows
