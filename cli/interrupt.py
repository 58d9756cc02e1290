"""Ctrl-C where the program must not be cut short, and signals that are taken for it."""

import contextlib
import os
import signal
import threading

from feederscrew_cli import end_while_loading

INTERRUPTED = 128 + signal.SIGINT
_heard = threading.Event()  # whether this run of the program was told to stop


def was_heard():
    """Return whether Ctrl-C, or a signal taken for it, has come since the program began."""
    return _heard.is_set()


def heeding(tell):
    """Return ``tell``, which raises the interrupt again that a library dropped while it was loading.

    For work that says how far it is, and that nothing of is given where it is stopped.
    """

    def tell_unless_stopped(*values):
        if was_heard():
            raise KeyboardInterrupt
        tell(*values)

    return tell_unless_stopped


@contextlib.contextmanager
def listening(*, ends=False):
    """Note every Ctrl-C of the block beside letting it through: a library may drop it, a run end early.

    Parameters
    ----------
    ends : bool
        Whether the program ends after the block: then Ctrl-C does nothing more, as Python takes its own
        handler away while it ends, and the signal would kill a program that has given its answer.

    Yields
    ------
    callable
        From its call on Ctrl-C is noted alone.
    """
    _heard.clear()
    ours = threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT)
    if not ours or before not in (signal.default_int_handler, end_while_loading):
        yield lambda: None
        return
    done = threading.Event()

    def catch(*_):
        _heard.set()
        if not done.is_set():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, catch)
    try:
        yield done.set
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN if ends else signal.default_int_handler)


@contextlib.contextmanager
def _handled(catch, numbers=(signal.SIGINT,)):
    """Let a function handle signals within the block; in another than the main thread nothing changes."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, catch) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def held_back():
    """Hold back Ctrl-C until the end of the block, as while libraries load; a second one gets through.

    Some of them drop an interrupt that reaches them while they load, or crash on it.
    """
    caught: list[tuple] = []

    def catch(*received):
        _heard.set()
        if caught:
            raise KeyboardInterrupt
        caught.append(received)

    with _handled(catch):
        yield
    if caught:
        raise KeyboardInterrupt


@contextlib.contextmanager
def noted():
    """Note Ctrl-C beside letting it through; gives a function that lets it through again.

    A library that is loading may drop it: whoever works on asks now and then.
    """
    caught: list[tuple] = []

    def catch(*received):
        _heard.set()
        caught.append(received)
        raise KeyboardInterrupt

    def let_through():
        if caught:
            raise KeyboardInterrupt

    with _handled(catch):
        yield let_through


@contextlib.contextmanager
def ended_within(seconds):
    """Let Ctrl-C end the program within so many seconds [s], from any moment of the block.

    SIGTERM and the end of the terminal do the same; by themselves they would leave processes at work and
    temporary folders.

    Libraries drop an interrupt that reaches them while they load or tidy up, and a process that is still
    loading may not be waited for. What the block has written must be whole at any moment.
    """
    from multiprocessing import active_children  # before an interrupt: the import lock may be held then

    timer = threading.Timer(seconds, _leave, (active_children,))
    timer.daemon = True

    def catch(*_):
        _heard.set()
        if not timer.ident:
            timer.start()
        raise KeyboardInterrupt

    # those that end the program, but for those that it was started to ignore, as by nohup
    names = (getattr(signal, name, None) for name in ("SIGTERM", "SIGHUP"))  # Windows has the first only
    endings = [number for number in names if number and signal.getsignal(number) is signal.SIG_DFL]
    with _handled(catch, (signal.SIGINT, *endings)):
        yield
        timer.cancel()


def _leave(children):
    for child in children():
        child.kill()
    os.write(2, b"Stopped.\n")
    os._exit(INTERRUPTED)
