"""Many parts at once: the whole pipeline for each, on several processes or machines, resumable."""

from feederscrew.jobs.batch.batch_run import StoppedBatchError, count_stale, crew, run
from feederscrew.jobs.batch.inputs import find_folders_within, gather
from feederscrew.jobs.batch.task import Choices, Conditions, Outcome, Request, Task
from feederscrew.jobs.batch.workers import Cluster, Processes

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
