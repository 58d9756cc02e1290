"""Ends what a server that was killed leaves behind: its design at work, and its folder.

A program of its own that imports nothing of the library. It reads lines from the server, ``run PID`` and
``end PID`` of groups of processes. When the server ends, in whatever way, the line breaks: groups that still
run are killed, and the folder is removed.
"""

import contextlib
import os
import shutil
import signal
import sys


def main(folder: str) -> None:
    """Wait for the end of the server, then kill what runs and remove its folder.

    Parameters
    ----------
    folder : str
        The folder of the server, with everything in it.
    """
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    running: set[int] = set()
    for line in sys.stdin:
        word, number = line.split()
        (running.add if word == "run" else running.discard)(int(number))
    for group in running:
        with contextlib.suppress(OSError):
            os.killpg(group, signal.SIGKILL)
    shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1])
