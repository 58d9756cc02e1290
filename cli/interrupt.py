"""Ctrl-C where the program must not be cut short, and signals that are taken for it."""

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from feederscrew_cli import end_while_loading

INTERRUPTED = 128 + signal.SIGINT
_heard = threading.Event()  # whether this run of the program was told to stop


def was_heard() -> bool:
    """Return whether Ctrl-C, or a signal taken for it, has come since the program began."""
    return _heard.is_set()


def heed_interrupts(tell: Callable[..., Any]) -> Callable[..., None]:
    """Return ``tell``, which raises the interrupt again that a library dropped while it was loading.

    For work that says how far it is, and that nothing of is given where it is stopped.
    """

    def tell_unless_stopped(*values: Any) -> None:
        if was_heard():
            raise KeyboardInterrupt
        tell(*values)

    return tell_unless_stopped


@contextlib.contextmanager
def note_every_interrupt(*, ends: bool = False) -> Iterator[Callable[[], None]]:
    """Note every Ctrl-C of the block beside letting it through: a library may drop it, a run end early.

    Where the program ``ends`` after the block Ctrl-C does nothing more, as Python takes its own handler away
    while it ends, and the signal would kill a program that has given its answer. From a call of what it
    yields on Ctrl-C is noted alone.
    """
    _heard.clear()
    done = threading.Event()
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGINT) not in (signal.default_int_handler, end_while_loading):
        yield done.set
        return

    def catch(*_: Any) -> None:
        _heard.set()
        if not done.is_set():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, catch)
    try:
        yield done.set
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN if ends else signal.default_int_handler)


@contextlib.contextmanager
def _count_signals(
    act: Callable[[int], Any], numbers: Iterable[int] = (signal.SIGINT,)
) -> Iterator[list[Any]]:
    """Call ``act`` with how many signals have come, at each one of the block; yields those that have come.

    In another than the main thread nothing changes.
    """
    received: list[Any] = []

    def catch(*signal_and_frame: Any) -> None:
        _heard.set()
        received.append(signal_and_frame)
        act(len(received))

    if threading.current_thread() is not threading.main_thread():
        yield received
        return
    before = {number: signal.signal(number, catch) for number in numbers}
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _raise(count: int = 1) -> None:
    if count:
        raise KeyboardInterrupt


@contextlib.contextmanager
def hold_interrupts() -> Iterator[None]:
    """Hold back Ctrl-C until the end of the block, as while libraries load; a second one gets through.

    Some of them drop an interrupt that reaches them while they load, or crash on it.
    """
    with _count_signals(lambda count: _raise(count - 1)) as received:
        yield
    _raise(len(received))


@contextlib.contextmanager
def note_interrupts() -> Iterator[Callable[[], None]]:
    """Note Ctrl-C beside letting it through; gives a function that lets it through again.

    A library that is loading may drop it: whoever works on asks now and then.
    """
    with _count_signals(_raise) as received:
        yield lambda: _raise(len(received))


@contextlib.contextmanager
def end_within(seconds: float) -> Iterator[None]:
    """Let Ctrl-C end the program within so many seconds [s], from any moment of the block.

    SIGTERM and the end of the terminal do the same; by themselves they would leave processes at work and
    temporary folders.

    Libraries drop an interrupt that reaches them while they load or tidy up, and a process that is still
    loading may not be waited for. What the block has written must be whole at any moment.
    """
    from multiprocessing import active_children  # before an interrupt: the import lock may be held then

    def leave() -> None:
        for child in active_children():
            child.kill()
        os.write(2, b"Stopped.\n")
        os._exit(INTERRUPTED)

    def begin_to_end(count: int) -> None:
        if count == 1:
            timer.start()
        raise KeyboardInterrupt

    timer = threading.Timer(seconds, leave)
    timer.daemon = True
    # those that end the program, but for those that it was started to ignore, as by nohup
    names = (getattr(signal, name, None) for name in ("SIGTERM", "SIGHUP"))  # Windows has the first only
    endings = [number for number in names if number and signal.getsignal(number) is signal.SIG_DFL]
    with _count_signals(begin_to_end, (signal.SIGINT, *endings)):
        yield
        timer.cancel()
