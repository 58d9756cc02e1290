"""Settings of a run of the library: its seed, its cores, and who is told of its progress."""

import os
from collections.abc import Callable
from dataclasses import dataclass

STAGE_VARIABLE = "FEEDER_STAGE_FILE"  # names a file in which a run of several stages notes how far it is


@dataclass(frozen=True)
class OnCores:
    """Settings of work whose pieces do not depend on each other: on how many cores, and who is told of it."""

    jobs: int | None = None  # all there are without it
    progress: Callable[..., None] | None = None  # told how much is done, and of how much
    before: Callable[..., None] | None = None  # called before it begins

    @property
    def cores(self) -> int:
        """Return how many processors are used."""
        return self.jobs or os.cpu_count() or 1


@dataclass(frozen=True)
class RunSettings:
    """Settings that are the same for every run of parts: no field but the seed changes an outcome."""

    seed: int = 1  # of all that is drawn at random
    jobs: int = 1  # cores to use
    progress: Callable[..., None] | None = None  # told how much is done, and of how much
    before: Callable[..., None] | None = None  # called once all inputs are found right, before compiling

    def begin(self) -> None:
        """Call ``before`` where there is one."""
        if self.before:
            self.before()

    def tell(self, done: int, total: int) -> None:
        """Tell how much is done, and of how much, where somebody asks.

        Parameters
        ----------
        done, total : int
            In the units of whoever runs: parts, drops, periods of the drive.
        """
        if self.progress:
            self.progress(done, total)


USUAL_RUN = RunSettings()
