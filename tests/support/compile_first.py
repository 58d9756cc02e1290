"""What the tests need compiled, made once for all their processes.

Run: python tests/support/compile_first.py            (all)
     python tests/support/compile_first.py trial ...  (only those)

The suite begins while the trial is still compiled: tests that need it wait for it. Each kernel is called as
a command calls it, with as little to do as it takes.
"""

import os
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PARTS = Path(__file__).parents[2] / "parts"
BOWL = """\
devices:
  - gap: 2 mm
  - cut_out: [[0 mm, 1 mm], [4 mm, 1 mm], [4 mm, 3 mm], [0 mm, 3 mm]]
"""
COMMANDS = {
    "trial": "trial {part} --parts 1 --jobs 1 --rule quasistatic",
    "verdicts": "rate {part} --aspect A --rule quasistatic --config {bowl}",
    "holes": "tooling {key} --aspect A --rule quasistatic --config {bowl} --static",
    "drop": "drop {part} --drops 1 --jobs 1",
    "plate": "drop {part} --plate --drops 1 --seconds 0.1 --jobs 1",
    "hull": "aspects {ball} --rule closed",
}
TRIAL = ("trial",)  # the longer of two processes
OTHERS = ("sweep", "verdicts", "holes", "drop", "plate", "hull")
READY = "FEEDER_TESTS_TRIAL"  # names the file that says how compiling the trial ended


def compile_side_by_side():
    """Compile all in two processes; return that of the trial, the longer one, which may still be at it.

    Raises CalledProcessError if the other fails.
    """
    os.environ[READY] = str(Path(tempfile.mkdtemp()) / "ready")
    longer = subprocess.Popen([sys.executable, __file__, *TRIAL])
    subprocess.run([sys.executable, __file__, *OTHERS], check=True)
    return longer


def wait_for_the_trial():
    """Return once the trial is compiled, if another process does it; it would be done twice."""
    if READY in os.environ:
        ready = Path(os.environ[READY])
        while not ready.exists():
            time.sleep(0.1)
        assert ready.read_text() == "compiled"


def compile_here(name, folder):
    """Call what is compiled by a name, with files in a folder."""
    import numpy as np
    import trimesh
    from click.testing import CliRunner

    if name == "sweep":
        from feederscrew.motion import conveying as answer
        from feederscrew.motion import operating_point

        answer.sweep(np.array([operating_point.plain(1.0, 0.5, 0.0, 0.4)]))
        return
    from feederscrew_cli.main import feeder

    files = {"bowl": folder / "bowl.yaml", "ball": folder / "ball.stl"}
    files |= {"part": PARTS / "squarenut_m5.stl", "key": PARTS / "key_a_d12x20.stl"}
    files["bowl"].write_text(BOWL)
    trimesh.creation.icosphere(subdivisions=4).export(files["ball"])
    words = shlex.split(COMMANDS[name].format(**files))
    done = CliRunner().invoke(feeder, words)
    assert done.exit_code == 0, (words, done.output, done.exception)


def main(names):
    """Compile what is named, or all; say how the trial ended, for those who wait."""
    how = "failed"
    try:
        for name in names or (*TRIAL, *OTHERS):
            with tempfile.TemporaryDirectory() as folder:
                compile_here(name, Path(folder))
        how = "compiled"
    finally:
        if "trial" in names and READY in os.environ:
            ready = Path(os.environ[READY])
            ready.with_suffix(".new").write_text(how)
            ready.with_suffix(".new").rename(ready)


if __name__ == "__main__":
    main(sys.argv[1:])
