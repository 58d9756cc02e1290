"""A batch from its first part to its summary; a part's results appear in its folder whole or not at all."""

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from feederscrew import __version__
from feederscrew.batch import summary
from feederscrew.batch.task import (
    CHANGED_FILE,
    CHANGED_OPTIONS,
    CHANGED_PROGRAM,
    FAILED,
    FAILED_BEFORE,
    MEDDLED,
    NEW,
    PARTS,
    Choices,
    Outcome,
    Task,
    libraries,
)
from feederscrew.batch.workers import Cluster, Processes, processors
from feederscrew.errors import FeederError
from feederscrew.output import tables
from feederscrew.output.batch import SHEET_NAME
from feederscrew.output.folder import RECORD
from feederscrew.output.page.as_html import html
from feederscrew.part import loading

MARKER = "batch.json"  # says that the folder is a batch's
RESUME_STORE_ADVICE = "make room there, then start this batch again with `resume`: what is finished is kept"
STALE = ".batch-"  # how the name of what is not finished begins
REPLACED = "replaced"  # folder in it of results that make room for new ones


class Store:
    """The results of a batch on disk.

    Parameters
    ----------
    directory : str or Path
        Empty, not there yet, or of an earlier batch.

    Raises
    ------
    FeederError
        If it holds something else, cannot be written, or another batch is at work in it.
    """

    def __init__(self, directory) -> None:
        self.path = Path(directory)
        self.parts = self.path / PARTS

    def __enter__(self):
        try:
            self.parts.parent.mkdir(parents=True, exist_ok=True)
            self.lock = _locked(self.path)
            self._check_ours()
            self.parts.mkdir(exist_ok=True)
            for stale in self.path.glob(f"{STALE}*"):
                self._put_back(stale)
                shutil.rmtree(stale) if stale.is_dir() else stale.unlink()
            self.write({MARKER: tables.json_text({"version": __version__})})
        except OSError as error:
            mend = "give another folder to `directory`"
            raise FeederError(self.path, f"cannot be written ({error.strerror})", mend) from error
        return self

    def __exit__(self, *fault) -> None:
        if self.lock is not None:
            os.close(self.lock)

    def _check_ours(self) -> None:
        held = [p.name for p in self.path.iterdir() if not p.name.startswith(STALE)]
        if held and MARKER not in held:
            what = f"holds other files, such as {sorted(held)[0]}"
            raise FeederError(
                self.path, what, "give an empty folder to `directory`, or that of an earlier batch"
            )

    def holds(self, name, key):
        """Return whether the results of one part are there, whole and of this very input."""
        record = self.record(name)
        if record.get("key") != key or not key:
            return False
        folder, files = self.parts / name, record.get("files", {})
        there = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()} - {RECORD}
        return there == set(files) and all(
            hashlib.sha256((folder / file).read_bytes()).hexdigest() == sha256
            for file, sha256 in files.items()
        )

    def why_again(self, task):
        """Return why the results of a part cannot stay as they are; None where they can.

        Parameters
        ----------
        task : Task

        Returns
        -------
        str or None
            As ``task.NEW`` and the constants behind it.
        """
        record = self.record(task.request.name)
        if not record:
            return NEW
        if record.get("status") == FAILED and not record.get("key"):
            return FAILED_BEFORE
        if record.get("key") == task.key:
            return None if self.holds(task.request.name, task.key) else MEDDLED
        inputs = record.get("inputs")
        before = inputs[0].get("sha256") if isinstance(inputs, list) and inputs else None
        if before != task.sha256:
            return CHANGED_FILE
        same = record.get("version") == __version__ and record.get("libraries") == libraries()
        return CHANGED_OPTIONS if same else CHANGED_PROGRAM

    def keep(self, outcome) -> None:
        """Put the results of one part in place, instead of those of an earlier run."""
        with self._writing(), tempfile.TemporaryDirectory(prefix=STALE, dir=self.path) as staging:
            fresh, place = Path(staging, "new"), self.parts / outcome.name
            record = tables.json_text({"batch": _report_outcome(outcome)})
            for name, content in {**outcome.files, RECORD: record.encode()}.items():
                (fresh / name).parent.mkdir(parents=True, exist_ok=True)
                (fresh / name).write_bytes(content)
            if place.exists():
                Path(staging, REPLACED).mkdir()
                place.rename(Path(staging, REPLACED, outcome.name))
            fresh.rename(place)

    def _put_back(self, staging) -> None:
        """Put results back that a run had taken out of their place when it was killed."""
        for old in staging.glob(f"{REPLACED}/*"):
            if not (self.parts / old.name).exists():
                old.rename(self.parts / old.name)

    def file(self, name, file):
        """Read the bytes of one result of a part; None where it is not there."""
        path = self.parts / name / file
        return path.read_bytes() if path.exists() else None

    def has(self, name, file) -> bool:
        """Return whether one result of a part is there."""
        return (self.parts / name / file).exists()

    def text(self, name):
        """Read a text of the whole batch; None where it is not there."""
        path = self.path / name
        return path.read_text(encoding="utf-8", errors="replace") if path.exists() else None

    def write(self, files, without=()) -> None:
        """Put files of the whole batch in place once all of them are written; until then the old ones stay.

        Parameters
        ----------
        files : dict of str to (str or bytes)
            Content by name, in the order in which they are put in place.
        without : sequence of str
            Patterns of files of an earlier run, which go where they are not among the new ones.
        """
        with self._writing(), tempfile.TemporaryDirectory(prefix=STALE, dir=self.path) as staging:
            for name, content in files.items():
                Path(staging, name).write_bytes(tables.encoded(content))
            for name in files:
                Path(staging, name).replace(self.path / name)
            for path in (path for pattern in without for path in self.path.glob(pattern)):
                if path.name not in files:
                    path.unlink()

    @contextlib.contextmanager
    def _writing(self):
        """Turn what the disk refuses into a FeederError; what is finished stays."""
        try:
            yield
        except OSError as error:
            what = f"cannot be written ({error.strerror or error})"
            raise FeederError(self.path, what, RESUME_STORE_ADVICE) from error

    def foreign_folders(self, names) -> list[Any]:
        """Return the folders of parts that are not in this batch, by name."""
        return sorted({p.name for p in self.parts.iterdir()} - set(names))

    def record(self, name):
        """Read what is recorded of one part: key, status, reason, row, files; empty if there is none."""
        try:
            record = json.loads((self.parts / name / RECORD).read_text())["batch"]
        except (OSError, ValueError, LookupError, TypeError):
            return {}
        return record if isinstance(record, dict) else {}


def _report_outcome(outcome) -> dict[Any, Any]:
    return {
        "version": __version__,
        "key": outcome.key,
        "inputs": [{"path": outcome.source, "sha256": outcome.sha256}],
        "effective": outcome.effective,
        "warnings": list(outcome.warnings),
        "libraries": libraries(),
        "status": outcome.status,
        "reason": outcome.reason,
        "row": outcome.row,
        "files": {name: hashlib.sha256(data).hexdigest() for name, data in sorted(outcome.files.items())},
    }


def _locked(folder):
    """Take a lock on the folder that goes with this process, however it ends; None where there is none."""
    try:
        import fcntl
    except ImportError:  # Windows
        return None
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        with contextlib.suppress(OSError):
            os.close(handle)
        raise FeederError(folder, "another batch is at work in it", "wait for it, or stop it") from None
    return handle


@dataclass(frozen=True, eq=False)
class Batch:
    """What a finished batch has to say."""

    rows: tuple[dict[str, object], ...]  # one a part, in the order asked for
    reused: int  # parts whose results were there already
    foreign: tuple[str, ...]  # folders of parts that are not in this batch
    targets: tuple[Path, ...]  # files of the whole batch
    sources: tuple[str, ...]  # files of its parts

    @property
    def faults(self) -> tuple[Any, ...]:
        """Return one line a failed part."""
        return tuple(str(row["reason"]) for row in self.rows if row["status"] == FAILED)


class StoppedBatchError(KeyboardInterrupt):
    """A batch that was stopped by Ctrl-C, or by a signal that is taken for it; what is finished is kept."""

    def __init__(self, done, total, summary) -> None:
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


def run(requests, directory, *, workers, choices=None, resume=False, tell=lambda is_reused: None) -> Batch:
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
        Called for each part that is finished; ``is_reused`` says whether its results were there already.

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
                request.name
                for request in requests
                if request.name in under_way.finished or _stays(store, request, choices)
            }
            raise StoppedBatchError(len(done), len(requests), _stopped(store, requests, done)) from None


def count_stale(requests, directory, choices=None) -> dict[Any, Any]:
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
    store, stale = Store(directory), Counter[str]()
    for request in requests:
        with contextlib.suppress(FeederError):
            reason = _why_again(store, request, choices or Choices())
            stale.update([reason] if reason else [])
    return dict(stale.most_common())


def _why_again(store, request, choices):
    return store.why_again(Task.of(request, choices, loading.read_file(request.source).data))


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

    def tasks(self, requests) -> Iterator[Any]:
        """Yield a task for each request that needs one, its file read only when the task is asked for."""
        for request in requests:
            try:
                data = loading.read_file(request.source).data
            except FeederError as fault:
                unread = Task.of(request, self.choices, b"")
                self.finish(Outcome.failed(unread, str(fault), final=False))
                continue
            task = Task.of(request, self.choices, data)
            if self.resume and self.store.holds(request.name, task.key):
                self.kept += 1
                self.finished.add(request.name)
                self.tell(True)
            else:
                yield task

    def finish(self, outcome) -> None:
        """Put what came of a part in place."""
        self.store.keep(outcome)
        self.finished.add(outcome.name)
        self.tell(False)


def _contact_sheet(tiles):
    """Draw one contact sheet: a process of the crew has matplotlib, this one need not."""
    from feederscrew.output import batch

    return batch.sheet(tiles)


def _stopped(store, requests, finished):
    """Write the summary of a batch that was stopped; the path.

    The tables of an earlier run that ended stay until a run ends: then it is beside them.
    """
    before = store.text(summary.SUMMARY_FILE)
    name = summary.SUMMARY_FILE if before is None or summary.is_partial(before) else summary.PARTIAL
    rows = summary.rows(store, requests, finished)
    store.write({name: tables.text(summary.frame(rows), "csv")})
    return store.path / name


def _finished(store, requests, complete, workers) -> Batch:
    """Write the summary, the contact sheets and the index page, from what lies on the disk."""
    rows = summary.rows(store, requests)
    sheets = workers.each(_contact_sheet, summary.sheets(store, rows))
    files = {
        SHEET_NAME.format(f"_{number}" if number > 1 else ""): sheet for number, sheet in enumerate(sheets, 1)
    }
    pages = summary.index_pages(store, rows)
    files |= {file: html(page) for file, page in pages.items()}
    files[summary.SUMMARY_FILE] = tables.text(summary.frame(rows), "csv")  # last: it says that all is there
    old = [SHEET_NAME.format("*"), summary.LATER_INDEX_FILE.format("*"), summary.PARTIAL]
    store.write(files, without=old)
    return Batch(
        rows=rows,
        reused=complete,
        foreign=tuple(store.foreign_folders([request.name for request in requests])),
        targets=(store.path / summary.SUMMARY_FILE, store.path / summary.INDEX_FILE),
        sources=tuple(dict.fromkeys(request.source for request in requests)),
    )
