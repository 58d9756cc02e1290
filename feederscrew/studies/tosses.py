"""The study of ``feeder drop --launches``: tosses of one part from a file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from feederscrew.dropping import launch_conditions, toss_runs
from feederscrew.dropping.ensemble import wilson
from feederscrew.dropping.rounded_hull import shape_of_part
from feederscrew.dropping.toss_runs import FACE_NAMES, LaunchFile
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.exact_tumbling import require_ground
from feederscrew.studies.drop import check_run

SURE_SHARE = 0.95  # [1] from here on an answer is called sure


@dataclass(frozen=True, eq=False)
class Agreement(ReadableRecord):
    """What was computed of measured tosses, beside what happened."""

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
    """Where each launch of a file leads."""

    part: Part
    aspects: Aspects
    launches: LaunchFile
    surface: toss_runs.SurfaceRanges
    seed: int
    result: toss_runs.Tosses

    @property
    def p(self) -> np.ndarray:
        """Share (N,) of the settled runs that end as computed; NaN without any."""
        result = self.result
        best = np.take_along_axis(result.shares, np.maximum(result.faces, 0)[:, None], axis=1)[:, 0]
        return np.where(result.faces >= 0, best, np.nan)

    @property
    def intervals(self) -> tuple[np.ndarray, ...]:
        """Ends (N,), (N,) of the 95 % interval that so few runs leave of ``p``."""
        settled = self.result.settled
        pairs = [wilson(np.nan_to_num(p) * n, n) if n else (0.0, 1.0) for p, n in zip(self.p, settled)]
        return tuple(np.array([float(np.ravel(pair[k])[0]) for pair in pairs]) for k in (0, 1))

    @property
    def off(self) -> np.ndarray | None:
        """Distance (N,) [m] from the place computed to the one measured; None where none was measured."""
        ends = self.launches.ends
        return None if ends is None else np.hypot(*(self.result.places - ends[: len(self.p)]).T)

    @property
    def agreement(self) -> Agreement | None:
        """What was computed beside what was measured; None where the file holds no upper sides."""
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

    ``launches`` is the path of a file for ``toss_runs.read_launches``. ``own`` has ``restitution`` and
    ``friction`` as typed, a value or a range; else they are those of any launch. Of each toss ``runs``
    are made, over small changes of what is not known, drawn by ``seed``; ``jobs`` are cores, on which the
    answer does not depend. ``progress`` is called with how many tosses are done, and of how many,
    ``before`` once all inputs are right. Raises FeederError if the part has no shape, the file has a
    fault, or a value is out of range.
    """
    check_run(runs, seed, jobs)
    read = toss_runs.read_launches(launches)
    aspects = find(part)
    grounded = require_ground(part, aspects)
    _, length = shape_of_part(part, grounded)
    ranges = {key: (own or {}).get(key) for key in ("restitution", "friction")}
    launch = launch_conditions.launch_of("feed", length, ranges)
    surface = toss_runs.SurfaceRanges(launch.restitution, launch.friction)
    if before:
        before()
    result = toss_runs.follow(
        part, grounded, read, surface, np.random.default_rng(seed),
        runs=runs or toss_runs.DEFAULT_RUNS, jobs=jobs, progress=progress,
    )  # fmt: skip
    return TossStudy(part, aspects, read, surface, seed, result)
