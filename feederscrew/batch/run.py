"""A batch from its first part to its summary."""

import contextlib
from collections import Counter
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


class StoppedBatchError(KeyboardInterrupt):
    """A batch that was stopped by Ctrl-C, or by a signal that is taken for it; what is finished is kept."""

    def __init__(self, done, total, summary):
        super().__init__(f"{done} of {total} parts are done")
        self.done, self.total = done, total  # parts that are finished, failed ones among them; all of them
        self.summary = summary  # Path of the table of those


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
    StoppedBatchError
        If the user stops it: a summary lists what is done, the rest as 'not computed'.
    """
    from feederscrew.resting.rules.registry import require_rule  # while the processes import their libraries

    choices = choices or Choices()
    require_rule(choices.rule)
    with Store(directory) as store:
        under_way = _UnderWay(store, choices, resume, tell)
        try:
            with contextlib.closing(workers.outcomes(under_way.tasks(requests))) as outcomes:
                for outcome in outcomes:
                    under_way.finish(outcome)
            return _finished(store, requests, under_way.kept, workers)
        except KeyboardInterrupt:
            done = {
                one.name for one in requests if one.name in under_way.finished or _stays(store, one, choices)
            }
            raise StoppedBatchError(len(done), len(requests), _stopped(store, requests, done)) from None


def count_stale(requests, directory, choices=None):
    """Count the parts that a batch with ``resume`` computes, by the reason.

    Parameters
    ----------
    requests : sequence of Request
    directory : str or Path
        As for ``run``; it need not be there.
    choices : Choices, optional

    Returns
    -------
    dict of str to int
        The most frequent reason first; parts whose file cannot be read are not counted.
    """
    store, found = Store(directory), Counter[str]()
    for request in requests:
        with contextlib.suppress(FeederError):
            reason = _why_again(store, request, choices or Choices())
            found.update([reason] if reason else [])
    return dict(found.most_common())


def _why_again(store, request, choices):
    return store.why_again(Task.of(request, choices, source.file(request.source).data))


def _stays(store, request, choices):
    """Whether results that a run did not come to are those asked for, left by an earlier one."""
    try:
        return bool(store.record(request.name)) and _why_again(store, request, choices) is None
    except FeederError:
        return False


class _UnderWay:
    """A batch that is being worked on."""

    def __init__(self, store, choices, resume, tell):
        self.store, self.choices, self.resume, self.tell = store, choices, resume, tell
        self.kept = 0
        self.finished = set()  # folders of parts whose results are those asked for

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
                self.finished.add(request.name)
                self.tell(kept=True)
            else:
                yield task

    def finish(self, outcome):
        """Put what came of a part in place."""
        self.store.keep(outcome)
        self.finished.add(outcome.name)
        self.tell(kept=False)


def _contact_sheet(tiles):
    """Draw one contact sheet: a process of the crew has matplotlib, this one need not."""
    from feederscrew.output import batch

    return batch.sheet(tiles)


def _stopped(store, requests, finished):
    """Write the summary of a batch that was stopped; the path.

    The tables of an earlier run that ended stay until a run ends: then it is beside them.
    """
    before = store.text(summary.NAME)
    name = summary.NAME if before is None or summary.is_partial(before) else summary.PARTIAL
    rows = summary.rows(store, requests, finished)
    store.write({name: tables.text(summary.frame(rows), "csv")})
    return store.path / name


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
    store.write(files, without=[SHEET.format("*"), summary.PARTIAL])
    return Batch(
        rows=rows,
        kept=kept,
        strangers=tuple(store.strangers([request.name for request in requests])),
        targets=(store.path / summary.NAME, store.path / index_page.NAME),
        sources=tuple(dict.fromkeys(request.source for request in requests)),
    )
