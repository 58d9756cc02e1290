"""Signals that end the program: Ctrl-C, SIGTERM and the end of its terminal are one and the same.

Each raises KeyboardInterrupt, so that a run gives what it has computed, with the exit status of its signal.
"""

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any

from feederscrew_cli import end_while_loading

INTERRUPTED = 128 + signal.SIGINT
# Windows has no SIGHUP
ENDINGS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
SAME_SIGNAL_S = 1.0  # within which SIGTERM comes twice: `timeout` sends it to the program and to its group
LOOK_AGAIN_S = 0.03  # until it is looked again whether an import has ended
IMPORT_FILES = ("<frozen importlib._bootstrap>", "<frozen importlib._bootstrap_external>")
_heard: list[int] = []  # signals that told this run of the program to stop
_last: dict[int, float] = {}  # when each came last [s]
_waiting: list[int] = []  # the signal that waits for the end of an import


def was_heard() -> bool:
    """Tell whether Ctrl-C, or a signal taken for it, has come since the program began.

    Returns
    -------
    bool
    """
    return bool(_heard)


def exit_status() -> int:
    """Return the exit status of a run that was stopped.

    Returns
    -------
    int
        By its first signal: 130 for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.
    """
    return 128 + _heard[0] if _heard else INTERRUPTED


def heed_interrupts(tell: Callable[..., Any]) -> Callable[..., None]:
    """Return a function that tells, and raises again an interrupt that a loading library dropped.

    For work that says how far it is.

    Parameters
    ----------
    tell : callable
        Called with the values, as long as no signal has come.

    Returns
    -------
    callable
    """

    def tell_unless_stopped(*values: Any) -> None:
        if was_heard():
            raise KeyboardInterrupt
        tell(*values)

    return tell_unless_stopped


@contextlib.contextmanager
def note_every_interrupt(*, ends: bool = False) -> Iterator[Callable[[], None]]:
    """Note every signal of the block beside letting it through: a library may drop it, a run end early.

    Parameters
    ----------
    ends : bool, optional
        Whether the program ends after the block: then Ctrl-C does nothing more, as Python takes its own
        handler away while it ends, and the signal would kill a program that has given its answer.

    Yields
    ------
    callable
        From a call of it on signals are noted alone. A signal that the program was started to ignore, as by
        nohup, is ignored.
    """
    _heard.clear()
    done = threading.Event()
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGINT) not in (signal.default_int_handler, end_while_loading):
        yield done.set
        return

    def catch(number: int, frame: FrameType | None) -> None:
        if _note(number) and not done.is_set():
            _raise_after_import(number, frame)

    before = {number: signal.getsignal(number) for number in ENDINGS}
    taken = [n for n in ENDINGS if n == signal.SIGINT or before[n] is signal.SIG_DFL]
    for number in taken:
        signal.signal(number, catch)
    hook, sys.unraisablehook = sys.unraisablehook, _raise_again(sys.unraisablehook)
    try:
        yield done.set
    finally:
        sys.unraisablehook = hook
        _wait_no_more()
        for number in taken:
            signal.signal(number, signal.SIG_DFL)
        signal.signal(signal.SIGINT, signal.SIG_IGN if ends else signal.default_int_handler)


@contextlib.contextmanager
def _count_signals(
    act: Callable[[int, int, FrameType | None], Any], *, even_default: bool = False
) -> Iterator[list[int]]:
    """Call ``act`` with how many signals have come, and the last, at each of the block; yields them all.

    Signals are those that end in KeyboardInterrupt already, or with ``even_default`` those too that would
    kill the program. In another than the main thread nothing changes.
    """
    received: list[int] = []

    def catch(number: int, frame: FrameType | None) -> None:
        if _note(number):
            received.append(number)
            act(len(received), number, frame)

    if threading.current_thread() is not threading.main_thread():
        yield received
        return
    handlers = {number: signal.getsignal(number) for number in ENDINGS}
    taken = {
        number: handler
        for number, handler in handlers.items()
        if callable(handler) or (even_default and handler is signal.SIG_DFL)
    }
    for number in taken:
        signal.signal(number, catch)
    try:
        yield received
    finally:
        for number, handler in taken.items():
            signal.signal(number, handler)


def _note(number: int) -> bool:
    """Note a signal; whether it is another than the last one, which was sent twice."""
    now = time.monotonic()
    since, _last[number] = now - _last.get(number, -SAME_SIGNAL_S), now
    is_sent_again = _waiting[1:] == [number]
    if number != signal.SIGINT and since < SAME_SIGNAL_S and was_heard() and not is_sent_again:
        return False
    _heard.append(number)
    return True


def _raise_after_import(number: int, frame: FrameType | None) -> None:
    """Raise the interrupt; while a module is being imported, after that.

    In the midst of an import it is lost in a callback of the import itself, or a library catches it with
    whatever else may fail, and the run goes on. A second signal is let through.
    """
    is_second = len(_waiting) == 1
    _wait_no_more()
    while frame is not None and frame.f_code.co_filename not in IMPORT_FILES:
        frame = frame.f_back
    if frame is None or is_second or not hasattr(signal, "setitimer"):
        raise KeyboardInterrupt
    _send_later(number)


def _send_later(number: int) -> None:
    """Have a signal come again by itself; a thread cannot be started in the midst of anything."""

    def again(_: int, frame: FrameType | None) -> None:
        handler = signal.getsignal(number)
        if callable(handler):
            _waiting.append(number)  # as ``_note`` knows it
            handler(number, frame)

    _waiting[:] = [number]
    signal.signal(signal.SIGALRM, again)
    signal.setitimer(signal.ITIMER_REAL, LOOK_AGAIN_S)


def _wait_no_more() -> None:
    if _waiting:
        _waiting.clear()
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _raise_again(hook: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a hook for faults that nobody can catch, such as in callbacks: an interrupt comes again."""

    def tell_unless_interrupt(fault: Any) -> None:
        is_main = threading.current_thread() is threading.main_thread()
        if not (isinstance(fault.exc_value, KeyboardInterrupt) and is_main):
            hook(fault)
        elif hasattr(signal, "setitimer"):
            _send_later(_heard[-1] if _heard else signal.SIGINT)

    return tell_unless_interrupt


@contextlib.contextmanager
def hold_interrupts() -> Iterator[None]:
    """Hold back signals until the end of the block, as while libraries load; a second one gets through.

    Some of them drop an interrupt that reaches them while they load, or crash on it.

    Yields
    ------
    None

    Raises
    ------
    KeyboardInterrupt
        At the end of the block, if a signal has come; at once, if two have.
    """

    def hold(count: int, *_: Any) -> None:
        if count > 1:
            raise KeyboardInterrupt

    with _count_signals(hold) as received:
        yield
    if received:
        raise KeyboardInterrupt


@contextlib.contextmanager
def note_interrupts() -> Iterator[Callable[[], None]]:
    """Note signals beside letting them through.

    A library that is loading may drop one: whoever works on asks now and then.

    Yields
    ------
    callable
        Raises KeyboardInterrupt if a signal has come in the block.
    """

    def let_through_again() -> None:
        if received:
            raise KeyboardInterrupt

    with _count_signals(lambda _, number, frame: _raise_after_import(number, frame)) as received:
        yield let_through_again


@contextlib.contextmanager
def end_within(seconds: float) -> Iterator[None]:
    """Let a signal end the program within some time, from any moment of the block.

    Libraries drop an interrupt that reaches them while they load or tidy up, and a process that is still
    loading may not be waited for. What the block has written must be whole at any moment.

    Parameters
    ----------
    seconds : float [s]
        From the first signal to the end.

    Yields
    ------
    None
    """
    from multiprocessing import active_children  # before an interrupt: the import lock may be held then

    def leave() -> None:
        for child in active_children():
            child.kill()
        os.write(2, b"Stopped.\n")
        os._exit(exit_status())

    def begin_to_end(count: int, *_: Any) -> None:
        if count == 1:
            timer.start()
        raise KeyboardInterrupt

    timer = threading.Timer(seconds, leave)
    timer.daemon = True
    with _count_signals(begin_to_end, even_default=True):
        yield
        timer.cancel()
