"""Files that a subject offers of its study, by name, each made only when it is asked for."""

import contextlib
import sys
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

from feederscrew.base.columns import Frame
from feederscrew.base.heavy import heavy
from feederscrew.output import tables

futures = heavy("concurrent.futures")
multiprocessing = heavy("multiprocessing")
style = heavy("feederscrew.output.style")


@dataclass(frozen=True, eq=False)
class Offer:
    """One file: its name, how its content is made, and for a picture what it shows."""

    name: str
    make: Callable[[], str | bytes]
    alt: str = ""
    view: Callable[[], Any] | None = None  # the frame, the document or the figure itself
    is_apart: bool = False  # a picture that no page shows

    @property
    def is_picture(self) -> bool:
        """Tell whether it is left out where no pictures are wanted."""
        return self.name.endswith(".png")

    @property
    def is_drawn(self) -> bool:
        """Tell whether it is a page or shown on one: these share work, and none with the others."""
        return self.name.endswith((".html", ".png", ".svg")) and not self.is_apart


@dataclass(frozen=True)
class RecordView:
    """What a record shows of itself: its answer in a line, and the files of its command.

    The class of the record names it, ``class RateStudy(ReadableRecord, view="rate.RATE_VIEW")``: a module of
    ``feederscrew.output``, which is imported when a view is asked for, and a name in it.
    """

    line: Callable[[Any], str] | None = None  # None: its fields are the line
    offers: Callable[[Any], Sequence[Offer]] | None = None  # its tables, documents and pictures
    command: str = ""  # under which its files are recorded
    files: Callable[[Any], Sequence[Offer]] | None = None  # what is saved, where that is more than ``offers``


class FileStore(Protocol):
    """Takes files: a ResultFolder, or what keeps them in memory."""

    left_out: list[str]  # files that an interrupt has left out

    def write(self, name: str, content: str | bytes) -> None:
        """Take one file.

        Parameters
        ----------
        name : str
        content : str or bytes
        """


def table(name: str, make: Callable[..., Any], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a CSV file.

    Parameters
    ----------
    name : str
        Of the file.
    make : callable
        Returns the frame, or its columns as a dict, of the other arguments.
    *arguments, **keywords
        For ``make``.

    Returns
    -------
    Offer
    """

    def view() -> Any:
        content = make(*arguments, **keywords)
        return Frame.of(content) if isinstance(content, dict) else content

    return Offer(name, lambda: tables.text(view(), "csv"), view=view)


def document(name: str, make: Callable[..., Any], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a JSON file.

    Parameters
    ----------
    name : str
        Of the file.
    make : callable
        Returns the document of the other arguments.
    *arguments, **keywords
        For ``make``.

    Returns
    -------
    Offer
    """
    view = partial(make, *arguments, **keywords)
    return Offer(name, lambda: tables.json_text(view()), view=view)


def text(name: str, make: Callable[..., str | bytes], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a file of text or of bytes.

    Parameters
    ----------
    name : str
        Of the file.
    make : callable
        Returns what is in it, of the other arguments.
    *arguments, **keywords
        For ``make``.

    Returns
    -------
    Offer
    """
    return Offer(name, partial(make, *arguments, **keywords))


def picture(name: str, alt: str, draw: Callable[..., Any], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a PNG.

    Parameters
    ----------
    name : str
        Of the file.
    alt : str
        What the picture shows, in words.
    draw : callable
        Returns the figure of the other arguments.
    *arguments, **keywords
        For ``draw``.

    Returns
    -------
    Offer
    """
    view = partial(draw, *arguments, **keywords)
    return Offer(name, lambda: style.png(view()), alt, view)


def write(folder: FileStore | None, files: Iterable[Offer], *, pictures: bool = True, jobs: int = 1) -> None:
    """Make every file offered and hand it to a folder, the numbers first.

    An interrupt while a picture is drawn leaves out that one and those after it: ``folder.left_out`` names
    them, and the tables are kept.

    Parameters
    ----------
    folder : FileStore or None
        A ResultFolder, or one of tests; nothing is made without one.
    files : iterable of Offer
    pictures : bool, optional
        Without them only tables and documents are made.
    jobs : int, optional
        With two or more, pages and pictures are made beside the rest, the same bytes.
    """
    if folder is None:
        return
    wanted = [offer for offer in files if pictures or not offer.is_picture]
    wanted.sort(key=lambda offer: (jobs > 1 and offer.is_drawn, offer.is_picture))  # numbers first
    is_stopped = False
    with _make_in_parallel([offer for offer in wanted if offer.is_drawn] if jobs > 1 else []) as wait_for:
        for offer in wanted:
            if is_stopped and offer.is_picture:
                folder.left_out.append(offer.name)
                continue
            try:
                content = wait_for(offer) if offer.is_drawn else None
                folder.write(offer.name, offer.make() if content is None else content)
            except KeyboardInterrupt:
                if not offer.is_picture:
                    raise
                is_stopped = True
                folder.left_out.append(offer.name)


@contextlib.contextmanager
def _make_in_parallel(files: Sequence[Offer]) -> Iterator[Callable[[Offer], str | bytes | None]]:
    """Make files in a process beside this one; what it yields waits for one, and gives None without it.

    It has none where the system cannot fork, where a thread runs, and of what failed there.
    """
    if not files or not sys.platform.startswith("linux") or threading.active_count() > 1:
        yield lambda offer: None
        return
    from feederscrew.base import processes  # and all of multiprocessing with it

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads that BLAS keeps, and that sleep
        process = processes.Process(multiprocessing.get_context("fork"), lambda k: _made(files[k]))

    def ask(k: int) -> str | bytes | None:
        process.give(k)
        return process.take()

    errand = futures.ThreadPoolExecutor(1)
    tasks = {offer.name: errand.submit(ask, k) for k, offer in enumerate(files)}

    def wait_for(offer: Offer) -> str | bytes | None:
        try:
            return tasks.pop(offer.name).result()
        except processes.ProcessEnded:
            return None

    try:
        yield wait_for
    finally:
        errand.shutdown(wait=False, cancel_futures=True)
        process.stop()
        errand.shutdown()


def _made(offer: Offer) -> str | bytes | None:
    """Return a file; None of one that fails, which the process that asks for it makes itself, and fails."""
    with contextlib.suppress(Exception):
        return offer.make()
    return None


def by_name(files: Iterable[Offer]) -> dict[str, Offer]:
    """Return the offers of a subject by the names of their files.

    Parameters
    ----------
    files : iterable of Offer

    Returns
    -------
    dict of str to Offer
    """
    return {offer.name: offer for offer in files}
