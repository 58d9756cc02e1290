"""Ctrl-C where the program must not be cut short."""

import contextlib
import signal
import threading


@contextlib.contextmanager
def held_back():
    """Hold back Ctrl-C until the end of the block, as while libraries load; a second one gets through.

    Some of them drop an interrupt that reaches them while they load, or crash on it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    caught = []

    def catch(*told):
        if caught:
            raise KeyboardInterrupt
        caught.append(told)

    before = signal.signal(signal.SIGINT, catch)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if caught:
        raise KeyboardInterrupt
