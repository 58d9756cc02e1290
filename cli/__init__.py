"""The commands; arithmetic lives in feederscrew.

No answer passes through BLAS, and the products that pictures take are small: its threads would only wait
busily, for half a second of a report, and against each other in the processes of a batch.
"""

import os

for _library in ("OPENBLAS", "MKL"):  # before numpy is imported
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")
