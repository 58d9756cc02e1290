"""The commands; arithmetic lives in feederscrew.

No answer passes through BLAS, and the products that pictures take are small: its threads would only wait
busily, for half a second of a report, and against each other in the processes of a batch.

Until ``main`` takes over, while the program loads, Ctrl-C ends it like at any later moment.
"""

import os
import signal
import sys
import threading

for _library in ("OPENBLAS", "MKL"):  # before numpy is imported
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")


def end_while_loading(*_received: object) -> None:
    """Leave at once with the status of Ctrl-C: nothing has been begun.

    Parameters
    ----------
    *_received : object
        The signal and the frame, as Python gives them; not used.
    """
    os.write(2, b"Stopped.\n")
    os._exit(128 + signal.SIGINT)


PROGRAM = sys.argv[0].replace("\\", "/").rpartition("/")[2].split(".")[0]  # not of a script that imports it
if (
    PROGRAM == "feeder"
    and threading.current_thread() is threading.main_thread()
    and signal.getsignal(signal.SIGINT) is signal.default_int_handler
):
    signal.signal(signal.SIGINT, end_while_loading)
