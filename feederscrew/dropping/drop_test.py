"""One drop test of one part, from its aspects to counts."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.dropping import ensemble, launch_conditions
from feederscrew.dropping.ensemble import Aim, Drops, Tally
from feederscrew.dropping.kernel import one_drop
from feederscrew.dropping.launch_conditions import sample
from feederscrew.dropping.rounded_hull import principal_axes, shape_of_part
from feederscrew.dropping.traces import DropTrace, follow
from feederscrew.geometry.compiled import on_disk
from feederscrew.records import ReadableRecord
from feederscrew.resting.exact_tumbling import Ground, require_ground
from feederscrew.running import USUAL_RUN

DEFAULT_DROPS = 10_000  # drops, where the user names neither a number nor a width


@dataclass(frozen=True, eq=False)
class Result(ReadableRecord):
    """A drop test and how to repeat it."""

    launch: dict  # name and ranges sampled, in the units of the shop
    seed: int
    ground: Ground
    drops: Drops
    tally: Tally
    heights: np.ndarray  # (A,) [m] of the centre of mass on each class; over the true circle of a round side
    aim: float | None = None  # [1] half-width the intervals were to reach
    traces: tuple[DropTrace, ...] = ()  # of the first drops
    single: float | None = None  # [1] restitution given as one value, which scatters as that of impacts does


def test(
    part, aspects, preset, own, *, drops=None, until=None, traced=0, dropped=None, run=USUAL_RUN
) -> Result:
    """Drop a part and count the aspects it rests on.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    preset : str
        A key of ``launch.PRESETS``.
    own : dict of str to (str or None)
        Ranges that replace the preset's, as typed: see ``conditions.launch_of``.
    drops : int, optional
        How many; with ``until`` at most so many.
    until : str, optional
        Go on until every class's 95 % interval is this narrow to either side, '1%'.
    traced : int
        Of how many drops, from the first, the motion is kept as well.
    dropped : Drops, optional
        Of a run of the same arguments: nothing is dropped then.
    run : RunSettings
        Its progress as in ``ensemble.drop``.

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
    faces = require_ground(part, aspects)
    shape, length = shape_of_part(part, faces)
    launch, single = (
        launch_conditions.launch_of(preset, length, own),
        launch_conditions.single(own.get("restitution")),
    )
    launch = launch if single is None else launch.scattering()
    count = len(aspects.names)
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
    described = launch_conditions.described(launch, length)
    heights = check.frozen(_heights(shape, length, faces.rows, aspects.heights))
    return Result(described, run.seed, faces, dropped, counted, heights, width, traces, single)


def _heights(shape, length, rows, heights) -> NDArray[np.float64]:
    """(A,) [m] heights of the classes, from those of the shape's faces; of a class without one as it was."""
    lowest = np.full(len(heights), np.inf)
    np.minimum.at(lowest, rows, length * shape.heights)
    return np.where(np.isfinite(lowest) & (lowest > 0.0), lowest, heights)


def compiled():
    """Tell whether the drop kernel is on disk already; else the first drop on a machine compiles it."""
    return on_disk(one_drop.settle_all)
