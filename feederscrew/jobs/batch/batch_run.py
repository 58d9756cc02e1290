"""A batch from its first part to its summary; a part's results appear in its folder whole or not at all."""

import contextlib
import csv
import hashlib
import io
import json
import math
import os
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from feederscrew import __version__
from feederscrew.base.columns import Cells, Document
from feederscrew.base.errors import FeederError
from feederscrew.jobs.batch import summary
from feederscrew.jobs.batch.task import (
    DONE,
    FAILED,
    NOT_COMPUTED,
    PARTS,
    Choices,
    Outcome,
    Request,
    Task,
    libraries,
)
from feederscrew.jobs.batch.workers import Cluster, Processes, processors
from feederscrew.output import tables
from feederscrew.output.batch import SHEET_NAME, sheet
from feederscrew.output.folder import RECORD
from feederscrew.output.page.as_html import html
from feederscrew.part import loading

MARKER = "batch.json"  # says that the folder is a batch's
STALE = ".batch-"  # how the name of what is not finished begins
NUMBER_COLUMNS = (
    "mass_g", "aspects", "heading_deg", "p_orientation", "velocity_mm_s", "pitch_mm", "parts_per_minute",
    "parts_per_minute_low", "parts_per_minute_high", "drops", "p_drop",
)  # fmt: skip
CHANGED = "results changed or incomplete"  # since they were written
REPLACED = "replaced"  # folder in it of results that make room for new ones


class Store:
    """The results of a batch in a folder: empty, not there yet, or of an earlier batch.

    As a context it raises FeederError if the folder holds something else, cannot be written, or another batch
    is at work in it.
    """

    def __init__(self, directory: str | Path) -> None:
        self.path = Path(directory)
        self.parts = self.path / PARTS

    def __enter__(self) -> "Store":
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self.lock = _lock(self.path)
            own = sorted(p.name for p in self.path.iterdir() if not p.name.startswith(STALE))
            if own and MARKER not in own:
                mend = "give an empty folder to `directory`, or that of an earlier batch"
                raise FeederError(self.path, f"holds other files, such as {own[0]}", mend)
            self.parts.mkdir(exist_ok=True)
            for stale in self.path.glob(f"{STALE}*"):
                for old in stale.glob(f"{REPLACED}/*"):  # taken out of its place by a run that was killed
                    if not (self.parts / old.name).exists():
                        old.rename(self.parts / old.name)
                shutil.rmtree(stale) if stale.is_dir() else stale.unlink()
            self.write({MARKER: tables.json_text({"version": __version__})})
        except OSError as error:
            what = f"cannot be written ({error.strerror})"
            raise FeederError(self.path, what, "give another folder to `directory`") from error
        return self

    def __exit__(self, *fault: object) -> None:
        if self.lock is not None:
            os.close(self.lock)

    def why_stale(self, task: Task) -> str | None:
        """Return why the results of a part cannot stay; None where they are whole and of this very input."""
        record, folder = self.record(task.request.name), self.parts / task.request.name
        if not record:
            return CHANGED if (folder / RECORD).exists() else "new"
        if record.get("status") == FAILED and not record.get("key"):
            return "failed for want of its file or of memory"
        if record.get("key") == task.key:
            paths = (path for path in folder.rglob("*") if path.is_file())
            files = {path.relative_to(folder).as_posix(): _sha256(path.read_bytes()) for path in paths}
            files.pop(RECORD, None)
            return None if files == record.get("files", {}) else CHANGED
        inputs = record.get("inputs")
        before = inputs[0].get("sha256") if isinstance(inputs, list) and inputs else None
        if before != task.sha256:
            return "another file"
        same = record.get("version") == __version__ and record.get("libraries") == libraries()
        return "other options or bowl" if same else "another version of the program or a library"

    def keep(self, outcome: Outcome) -> None:
        """Put the results of one part in place, instead of those of an earlier run."""
        record = {
            "version": __version__,
            "key": outcome.key,
            "inputs": [{"path": outcome.source, "sha256": outcome.sha256}],
            "effective": outcome.effective,
            "warnings": list(outcome.warnings),
            "libraries": libraries(),
            "status": outcome.status,
            "reason": outcome.reason,
            "row": outcome.row,
            "files": {name: _sha256(data) for name, data in sorted(outcome.files.items())},
        }
        with self._staging() as staging:
            fresh, place = staging / "new", self.parts / outcome.name
            text = tables.json_text({"batch": record | {"digest": _digest(record)}})
            for name, content in {**outcome.files, RECORD: text.encode()}.items():
                (fresh / name).parent.mkdir(parents=True, exist_ok=True)
                (fresh / name).write_bytes(content)
            if place.exists():
                (staging / REPLACED).mkdir()
                place.rename(staging / REPLACED / outcome.name)
            fresh.rename(place)

    def file(self, name: str, file: str) -> bytes | None:
        """Return the bytes of one result of a part; None where it is not there."""
        path = self.parts / name / file
        return path.read_bytes() if path.exists() else None

    def write(self, files: dict[str, str | bytes], without: Sequence[str] = ()) -> None:
        """Put files of the batch in place, in order, once all are written; before that the old ones stay.

        ``without`` are patterns of files of an earlier run, which go where they are not among the new ones.
        """
        with self._staging() as staging:
            for name, content in files.items():
                (staging / name).write_bytes(tables.file_bytes(content))
            for name in files:
                (staging / name).replace(self.path / name)
            for path in (path for pattern in without for path in self.path.glob(pattern)):
                if path.name not in files:
                    path.unlink()

    @contextlib.contextmanager
    def _staging(self) -> Iterator[Path]:
        """A folder for what is not finished; what the disk refuses is a FeederError."""
        try:
            with tempfile.TemporaryDirectory(prefix=STALE, dir=self.path) as staging:
                yield Path(staging)
        except OSError as error:
            what = f"cannot be written ({error.strerror or error})"
            mend = "make room there, then start this batch again with `resume`: what is finished is kept"
            raise FeederError(self.path, what, mend) from error

    def record(self, name: str) -> Document:
        """Return what is recorded of one part: key, status, reason, row, files.

        Empty if there is none, or it is not as it was written: its digest differs, or what it says cannot be.
        """
        try:
            record = json.loads((self.parts / name / RECORD).read_text())["batch"]
            digest = record.pop("digest")
            return record if digest == _digest(record) and _is_possible(record) else {}
        except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
            return {}


def _digest(record: Document) -> str:
    """SHA-256 of a record as JSON."""
    text = json.dumps(json.loads(tables.json_text(record)), sort_keys=True)
    return _sha256(text.encode())


def _is_possible(record: Document) -> bool:
    """Tell whether the kinds of a record's values and the order of its interval are those of a result."""
    row, inputs = record["row"], record["inputs"]
    kinds = (("row", dict), ("files", dict), ("inputs", list), ("warnings", list), ("effective", dict))
    if not all(isinstance(record[name], kind) for name, kind in kinds):
        return False
    if record["status"] not in (DONE, FAILED) or not all(isinstance(given, dict) for given in inputs):
        return False
    texts = [*record["warnings"], record["key"], record["reason"], *record["files"].values()]
    if not all(text is None or isinstance(text, str) for text in texts):
        return False
    for name, value in row.items():
        kind = (int, float) if name in NUMBER_COLUMNS else (str, bool, int, float)
        if value is not None and not isinstance(value, kind):
            return False
        if isinstance(value, float) and not math.isfinite(value):
            return False
    low, rate, high = (row.get(f"parts_per_minute{end}") for end in ("_low", "", "_high"))
    return (rate is None or rate >= 0.0) and (None in (low, rate, high) or low <= rate <= high)


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _lock(folder: Path) -> int | None:
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
    """Results of a finished batch."""

    rows: tuple[Cells, ...]  # one a part, in the order asked for
    reused: int  # parts whose results were there already
    foreign: tuple[str, ...]  # folders of parts that are not in this batch
    targets: tuple[Path, ...]  # files of the whole batch
    sources: tuple[str, ...]  # files of its parts

    @property
    def faults(self) -> tuple[str, ...]:
        """One line a failed part."""
        return tuple(str(row["reason"]) for row in self.rows if row["status"] == FAILED)


class StoppedBatchError(KeyboardInterrupt):
    """A batch that was stopped by Ctrl-C, or by a signal that is taken for it; what is finished is kept."""

    def __init__(self, done: int, total: int, summary: Path) -> None:
        super().__init__(f"{done} of {total} parts are done")
        self.done, self.total = done, total  # parts that are finished, failed ones among them; all of them
        self.summary = summary  # the table of those


def crew(jobs: int | None = None, scheduler: str | None = None) -> Processes | Cluster:
    """Choose who does the work of a batch: processes of this machine, or the workers of a cluster.

    Parameters
    ----------
    jobs : int, optional
        Processes; as many as there are processors without it.
    scheduler : str, optional
        Address of a Dask scheduler, 'tcp://host:8786'; its workers are taken then.

    Returns
    -------
    Processes or Cluster
    """
    return Cluster(scheduler) if scheduler else Processes(jobs or processors())


def run(
    requests: Sequence[Request],
    directory: str | Path,
    *,
    workers: Processes | Cluster,
    choices: Choices | None = None,
    resume: bool = False,
    tell: Callable[[bool], None] = lambda is_reused: None,
) -> Batch:
    """Compute every part of a batch and write its folder.

    A part's results appear in its folder whole or not at all. If the user stops the batch, a summary lists
    what is done, the rest as 'not computed'.

    Parameters
    ----------
    requests : sequence of Request
        From ``gather``.
    directory : str or path
        Folder of the batch.
    workers : Processes or Cluster
        From ``crew``.
    choices : Choices, optional
        The same for all parts.
    resume : bool
        Leave alone what is there already, whole and of the same input.
    tell : callable
        Called for each part that is finished, with whether its results were there already.

    Returns
    -------
    Batch

    Raises
    ------
    FeederError
        If the folder cannot be used or the scheduler is lost; what is finished is kept.
    StoppedBatchError
        If the user stops it.
    """
    from feederscrew.resting.rules.registry import require_rule  # while the processes import their libraries

    choices = choices or Choices()
    require_rule(choices.rule)
    reused: set[str] = set()  # folders of parts whose results are those asked for: from an earlier run,
    finished: set[str] = set()  # and all of them

    def finish(outcome: Outcome) -> None:
        store.keep(outcome)
        finished.add(outcome.name)
        tell(False)

    def tasks() -> Iterator[Task]:
        """A task for each request that needs one, its file read only when the task is asked for."""
        for request in requests:
            try:
                task = _task(request, choices)
            except FeederError as fault:
                finish(Outcome.failed(Task.of(request, choices, b""), str(fault), final=False))
                continue
            if resume and store.why_stale(task) is None:
                reused.add(request.name)
                finished.add(request.name)
                tell(True)
            else:
                yield task

    with Store(directory) as store:
        try:
            with contextlib.closing(workers.outcomes(tasks())) as outcomes:
                for outcome in outcomes:
                    finish(outcome)
            return _finished(store, requests, len(reused))
        except KeyboardInterrupt:
            for request in requests:  # results that this run did not come to, left by an earlier one
                with contextlib.suppress(FeederError):
                    is_kept = request.name not in finished and store.record(request.name)
                    if is_kept and store.why_stale(_task(request, choices)) is None:
                        finished.add(request.name)
            rows = summary.rows(store, requests, finished)
            # the tables of an earlier run that ended stay until a run ends: then it is beside them
            before = store.path / summary.SUMMARY_FILE
            earlier = before.read_text("utf-8", errors="replace") if before.exists() else ""
            statuses = [row.get("status") for row in csv.DictReader(io.StringIO(earlier))]
            is_over = before.exists() and NOT_COMPUTED not in statuses
            name = summary.PARTIAL if is_over else summary.SUMMARY_FILE
            store.write({name: tables.text(summary.frame(rows), "csv")})
            raise StoppedBatchError(len(finished), len(requests), store.path / name) from None


def count_stale(
    requests: Iterable[Request], directory: str | Path, choices: Choices | None = None
) -> dict[str, int]:
    """Count the parts that a batch with ``resume`` computes, by the reason.

    Parts whose file cannot be read are not counted.

    Parameters
    ----------
    requests : iterable of Request
        From ``gather``.
    directory : str or path
        Folder of the batch; it need not be there.
    choices : Choices, optional
        The same for all parts.

    Returns
    -------
    dict of str to int
        The most frequent reason first.
    """
    store, stale = Store(directory), Counter[str]()
    for request in requests:
        with contextlib.suppress(FeederError):
            reason = store.why_stale(_task(request, choices or Choices()))
            stale.update([reason] if reason else [])
    return dict(stale.most_common())


def _task(request: Request, choices: Choices) -> Task:
    return Task.of(request, choices, bytes(loading.read_file(request.source).data))


def _finished(store: Store, requests: Sequence[Request], reused: int) -> Batch:
    """Write the summary, the contact sheets and the index page, from what lies on the disk."""
    rows = summary.rows(store, requests)
    sheets = enumerate(summary.sheets(store, rows), 1)
    files: dict[str, str | bytes] = {
        SHEET_NAME.format(f"_{k}" if k > 1 else ""): sheet(tiles) for k, tiles in sheets
    }
    files |= {file: html(page) for file, page in summary.index_pages(store, rows).items()}
    files[summary.SUMMARY_FILE] = tables.text(summary.frame(rows), "csv")  # last: it says that all is there
    old = [SHEET_NAME.format("*"), summary.LATER_INDEX_FILE.format("*"), summary.PARTIAL]
    store.write(files, without=old)
    return Batch(
        rows=rows,
        reused=reused,
        foreign=tuple(sorted({p.name for p in store.parts.iterdir()} - {r.name for r in requests})),
        targets=(store.path / summary.SUMMARY_FILE, store.path / summary.INDEX_FILE),
        sources=tuple(dict.fromkeys(request.source for request in requests)),
    )
