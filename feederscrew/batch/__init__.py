"""Many parts at once: the whole pipeline for each, on several processes or machines, resumable."""

from feederscrew.batch.batch_run import StoppedBatchError, count_stale, crew, run
from feederscrew.batch.inputs import find_folders_within, gather
from feederscrew.batch.task import Choices, Conditions, Outcome, Request, Task
from feederscrew.batch.workers import Cluster, Processes

__all__ = [
    "Choices",
    "Cluster",
    "Conditions",
    "Outcome",
    "Processes",
    "Request",
    "StoppedBatchError",
    "Task",
    "count_stale",
    "crew",
    "find_folders_within",
    "gather",
    "run",
]
