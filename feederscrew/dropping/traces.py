"""Single drops of a test, followed from the launch until the part lies still."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from feederscrew import check
from feederscrew.dropping.kernel import body, one_drop
from feederscrew.dropping.rounded_hull import lowest_on
from feederscrew.geometry import vectors
from feederscrew.units import GRAVITY

ROW_INTERVAL = 0.05  # sqrt(L / g) from one row that is kept to the next, at least
MAX_TRACE_ROWS = 1000  # such rows; a longer drop has them further apart
MAX_IMPACTS = 250  # impacts that are kept, those that take most energy
FIRST_TRACE_ROWS = 8192  # of a trace at first; a longer drop is followed again with twice as many
STILL_ENERGY = (
    3e-3  # energy over a face's height at which a part lies still on it, contact tolerance included
)
ROWS_AT_ONCE = 256  # rows whose corners are looked at together
TUMBLED_RAD = np.radians(90.0)  # of the underside, from which on a part has tumbled


@dataclass(frozen=True, eq=False)
class DropTrace:
    """Motion of one drop, N rows, some hundreds: at even times, before and after every impact, and the end.

    Rows are steps of the simulation, and of free flight between two of them, about
    ROW_INTERVAL sqrt(L / g) apart, further if there would be more than MAX_TRACE_ROWS; of more than
    MAX_IMPACTS impacts those that take most energy. Positions
    are of the centre of mass, over the plane z = 0; the launch is at x = y = 0.
    """

    number: int  # of the drop, from 1
    face: int  # it is counted on, UNSETTLED for none
    row: int  # class of that face, UNSETTLED for none
    decided: float  # [s] when that face was certain, and the drop counted
    still: bool  # followed until it lies still on that face; else it ends when that face is certain
    times: np.ndarray  # (N,) [s]
    positions: np.ndarray  # (N, 3) [m]
    attitudes: np.ndarray  # (N, 4) quaternions w x y z, from the file's axes to the plane's
    energies: np.ndarray  # (N,) [m] kinetic and of height, over m g
    impacts: np.ndarray  # (N,) bool, a corner comes down: the state just before

    @property
    def turns(self) -> Rotation:
        """Return rotations from the file's axes to the plane's."""
        return Rotation.from_quat(np.roll(self.attitudes, -1, axis=1))

    def tumbled(self) -> bool:
        """Tell whether the underside of the first impact later turns by more than a quarter of a circle."""
        down = self.turns.inv().apply([0.0, 0.0, -1.0])[np.argmax(self.impacts) :]
        across = np.linalg.norm(np.cross(down, down[0]), axis=1)
        return bool((np.arctan2(across, vectors.product(down, down[0])) > TUMBLED_RAD).any())


def follow(shape, length, principal, starts, drops, rows) -> tuple[Any, ...]:
    """Follow the first drops of a test once more.

    Source: docs/resting.md, "The drop test".

    Parameters
    ----------
    shape : Shape
    length : float [m]
        Of the shape.
    principal : (3, 3) float [1]
        Its columns are the shape's axes along the file's: `shape.principal_axes`.
    starts : Starts
        Of the drops to follow.
    drops : Drops
        Their outcome, in the same order; there may be more.
    rows : (F,) int
        Class of each face.

    Returns
    -------
    tuple of DropTrace

    Notes
    -----
    A drop is counted once its face is certain, while the part still moves. The trace goes on until it lies
    still. Should that be on another face, balanced on an edge, or never, as with a part that rolls on and on,
    it ends where the drop was counted.
    """
    to_body = Rotation.from_matrix(np.array(principal.T))
    second = np.sqrt(length / GRAVITY)
    traces = []
    for k, state in enumerate(starts.states):
        face, limits = int(drops.faces[k]), (starts.restitutions[k], starts.frictions[k])
        states = _to_rest(shape, state, *limits, face)
        still = states is not None
        if not still:
            _, states = _path(shape, state, *limits, one_drop.Steps())
        states = _filled(shape, states)
        energies = _energies(shape, states)
        impacts = _strongest(_impacts(shape, states, one_drop.Steps()), energies)
        strongest = _which_rows(states[:, 0], impacts, drops.times[k])
        states, energies, impacts = states[strongest], energies[strongest], impacts[strongest]
        turns = Rotation.from_quat(states[:, 1 + body.Q + np.array([1, 2, 3, 0])]) * to_body
        traces.append(
            DropTrace(
                number=k + 1,
                face=face,
                row=int(rows[face]) if face != one_drop.UNSETTLED else one_drop.UNSETTLED,
                decided=float(second * drops.times[k]),
                still=still,
                times=check.frozen(second * states[:, 0]),
                positions=check.frozen(length * states[:, 1 : 1 + body.VX]),
                attitudes=check.frozen(np.roll(turns.as_quat(), 1, axis=1)),
                energies=check.frozen(length * energies),
                impacts=check.frozen(impacts),
            )
        )
    return tuple(traces)


def telling(traces) -> Any:
    """Choose the drop to show: the first that tumbled and lies still, else that tumbled, else the first."""
    return min(traces, key=lambda trace: (not trace.tumbled(), not trace.still, trace.number))


def _to_rest(shape, start, restitution, friction, face) -> Any:
    """Rows until the part lies still on a face; None if it does not."""
    if face == one_drop.UNSETTLED:
        return None
    end, states = _path(shape, start, restitution, friction, one_drop.Steps(early=False))
    lies = end == face and _energies(shape, states[-1:])[0] - shape.heights[face] < STILL_ENERGY
    return states if lies else None


def _filled(shape, states) -> NDArray[np.float64]:
    """Rows with further ones in long steps of free flight, at most ROW_INTERVAL apart.

    They are followed back from the end of the step: an impact may come before its flight.
    """
    steps = np.diff(states[:, 0])
    if not (steps > ROW_INTERVAL).any():
        return states
    rows = [states[:1]]
    for after, step in zip(states[1:], steps):
        count = int(np.ceil(step / ROW_INTERVAL))
        between = np.repeat(after[None], count - 1, axis=0)
        for row, dt in zip(between, step / count * np.arange(count - 1, 0, -1)):
            row[0] -= dt
            body.fly(row[1:], shape.inertia, -dt)
        rows += [between, after[None]]
    return np.vstack(rows)


def _path(shape, start, restitution, friction, steps) -> tuple[int, NDArray[np.float64]]:
    """Face, and (N, 14) time and state at the start of every step and at the end."""
    rows, used = FIRST_TRACE_ROWS // 2, None
    while used is None or used == rows:
        rows *= 2
        work = one_drop.scratch(shape, rows=rows)
        work.state[:] = start
        face, time, used = one_drop.settle(shape, work, restitution, friction, steps)
    steady = work.trace[:used][work.trace[:used, 0] < time]  # the end replaces a row of the same time
    return face, np.vstack([steady, [time, *work.state]])


def _impacts(shape, states, steps) -> NDArray[np.bool_]:
    """(N,) bool, rows where a corner on the plane comes down fast enough to rebound."""
    turns = Rotation.from_quat(states[:, 1 + body.Q + np.array([1, 2, 3, 0])])
    up = turns.inv().apply([0.0, 0.0, 1.0])
    speeds = np.cross(up, states[:, 1 + body.W : 1 + body.W + 3])
    struck = np.zeros(len(states), bool)
    for first in range(0, len(states), ROWS_AT_ONCE):
        part = slice(first, first + ROWS_AT_ONCE)
        points = np.concatenate(
            [
                np.broadcast_to(shape.vertices, (len(up[part]), *shape.vertices.shape)),
                lowest_on(shape, up[part]),
            ],
            axis=1,
        )
        gaps = states[part, 1 + body.Z, None] + np.einsum("ni,nvi->nv", up[part], points)
        rising = states[part, 1 + body.VZ, None] + np.einsum("ni,nvi->nv", speeds[part], points)
        struck[part] = ((gaps <= steps.tolerance) & (rising < -steps.threshold)).any(axis=1)
    return struck


def _strongest(impacts, energies) -> NDArray[np.bool_]:
    """(N,) bool, of the rows of impacts the MAX_IMPACTS that take most energy."""
    rows = np.flatnonzero(impacts)
    losses = energies[rows] - np.append(energies, energies[-1])[rows + 1]
    strongest = np.zeros(len(impacts), bool)
    strongest[rows[np.argsort(-losses, kind="stable")[:MAX_IMPACTS]]] = True
    return strongest


def _which_rows(times, impacts, decided) -> NDArray[np.bool_]:
    """(N,) bool, the rows of a trace that are kept."""
    steps = np.floor(times / max(ROW_INTERVAL, times[-1] / MAX_TRACE_ROWS))
    chosen_rows = np.diff(steps, prepend=-1.0) > 0.0
    chosen_rows[-1] = True
    chosen_rows[np.searchsorted(times, decided).clip(max=len(times) - 1)] = True
    return chosen_rows | impacts | np.roll(impacts, 1)


def _energies(shape, states) -> NDArray[np.float64]:
    """(N,) total energy at mass 1 and gravity 1."""
    velocities, rates = states[:, 1 + body.VX : 1 + body.Q], states[:, 1 + body.W :]
    turning = 0.5 * vectors.product(rates**2, shape.inertia)
    return 0.5 * (velocities**2).sum(axis=1) + turning + states[:, 1 + body.Z]


def chosen(trace, count) -> NDArray[np.int64]:
    """Return the rows of the stills: the first impact, the end, and others at equal shares of what goes on.

    That is, half by half, how far the part turns and how much energy it loses (in powers), and by a quarter
    how long it takes.

    Parameters
    ----------
    trace : DropTrace
    count : int

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
