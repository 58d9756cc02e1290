"""A batch from its first part to its summary."""

from dataclasses import dataclass
from pathlib import Path

from feederscrew.batch import index_page, summary
from feederscrew.batch.cluster import Cluster
from feederscrew.batch.store import Store
from feederscrew.batch.task import FAILED, Choices, Outcome, Task
from feederscrew.batch.workers import Processes, processors
from feederscrew.errors import FeederError
from feederscrew.output import tables
from feederscrew.output.batch import SHEET
from feederscrew.part.reading import source


@dataclass(frozen=True, eq=False)
class Batch:
    """What a finished batch has to say."""

    rows: tuple[dict[str, object], ...]  # one a part, in the order asked for
    kept: int  # parts whose results were there already
    strangers: tuple[str, ...]  # folders of parts that are not in this batch
    targets: tuple[Path, ...]  # files of the whole batch
    sources: tuple[str, ...]  # files of its parts

    @property
    def faults(self):
        """Return one line a failed part."""
        return tuple(str(row["reason"]) for row in self.rows if row["status"] == FAILED)


def crew(jobs=None, scheduler=None):
    """Choose who does the work.

    Parameters
    ----------
    jobs : int, optional
        Processes of this machine; as many as it has processors without it.
    scheduler : str, optional
        Address of a Dask scheduler, 'tcp://host:8786', whose workers are taken instead.
    """
    return Cluster(scheduler) if scheduler else Processes(jobs or processors())


def run(requests, directory, *, workers, choices=None, resume=False, tell=lambda kept: None):
    """Compute every part and write the folder of the batch.

    Parameters
    ----------
    requests : sequence of Request
        From ``gather``.
    directory : str or Path
        Where the results go.
    workers : Processes or Cluster
        From ``crew``.
    choices : Choices, optional
    resume : bool
        Leave alone what is there already, whole and of the same input.
    tell : function
        Called for each part that is finished; ``kept`` says whether its results were there already.

    Returns
    -------
    Batch

    Raises
    ------
    FeederError
        If the folder cannot be used or the scheduler is lost; what is finished is kept.
    """
    from feederscrew.resting.rules.registry import require_rule  # while the processes import their libraries

    choices = choices or Choices()
    require_rule(choices.rule)
    with Store(directory) as store:
        under_way = _UnderWay(store, choices, resume, tell)
        for outcome in workers.outcomes(under_way.tasks(requests)):
            under_way.finish(outcome)
        return _finished(store, requests, under_way.kept, workers)


class _UnderWay:
    """A batch that is being worked on."""

    def __init__(self, store, choices, resume, tell):
        self.store, self.choices, self.resume, self.tell = store, choices, resume, tell
        self.kept = 0

    def tasks(self, requests):
        """Yield a task for each request that needs one, its file read only when the task is asked for."""
        for request in requests:
            try:
                data = source.file(request.source).data
            except FeederError as fault:
                unread = Task.of(request, self.choices, b"")
                self.finish(Outcome.failed(unread, str(fault), final=False))
                continue
            task = Task.of(request, self.choices, data)
            if self.resume and self.store.holds(request.name, task.key):
                self.kept += 1
                self.tell(kept=True)
            else:
                yield task

    def finish(self, outcome):
        """Put what came of a part in place."""
        self.store.keep(outcome)
        self.tell(kept=False)


def _contact_sheet(tiles):
    """Draw one contact sheet: a process of the crew has matplotlib, this one need not."""
    from feederscrew.output.batch import contact_sheet

    return contact_sheet.sheet(tiles)


def _finished(store, requests, kept, workers):
    """Write the summary, the contact sheets and the index page, from what lies on the disk."""
    from feederscrew.output.page.as_html import html

    rows = summary.rows(store, requests)
    sheets = workers.each(_contact_sheet, summary.sheets(store, rows))
    files = {
        SHEET.format(f"_{number}" if number > 1 else ""): sheet for number, sheet in enumerate(sheets, 1)
    }
    files[index_page.NAME] = html(index_page.page(store, rows))
    files[summary.NAME] = tables.text(summary.frame(rows), "csv")  # last: it says that all is there
    store.write(files, without=[SHEET.format("*")])
    return Batch(
        rows=rows,
        kept=kept,
        strangers=tuple(store.strangers([request.name for request in requests])),
        targets=(store.path / summary.NAME, store.path / index_page.NAME),
        sources=tuple(dict.fromkeys(request.source for request in requests)),
    )
