"""What the tests need compiled, made once for all their processes, side by side, before the first test.

Run: python tests/compile_first.py            (all, in two processes)
     python tests/compile_first.py crowd ...  (only those, in this one)

Each kernel is called as a command calls it, with as little to do as it takes.
"""

import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

PARTS = Path(__file__).parents[1] / "parts"
BOWL = """\
devices:
  - gap: 2 mm
  - cut_out: [[0 mm, 1 mm], [4 mm, 1 mm], [4 mm, 3 mm], [0 mm, 3 mm]]
"""
COMMANDS = {
    "part": "trial {part} --parts 1 --jobs 1 --rule quasistatic",
    "verdicts": "rate {part} --aspect A --rule quasistatic --config {bowl}",
    "holes": "tooling {bracket} --aspect A --rule quasistatic --config {bowl} --static",
    "crowd": "trial {part} --parts 1 --jobs 1 --rule quasistatic --queue 2 --seconds 0.05",
    "drop": "drop {part} --drops 1 --jobs 1",
    "plate": "drop {part} --plate --drops 1 --seconds 0.1 --jobs 1",
    "hull": "aspects {ball} --rule closed",
}
SHARED_OUT = (  # nothing in both: the trial of a part is most of it, and a crowd's takes what that compiled
    ("part", "crowd"),
    ("sweep", "verdicts", "holes", "drop", "plate", "hull"),
)


def compile_side_by_side():
    """Compile everything, in a process each share; raises CalledProcessError."""
    calls = [[sys.executable, __file__, *names] for names in SHARED_OUT]
    children = [subprocess.Popen(call) for call in calls]
    for call, status in [(call, child.wait()) for call, child in zip(calls, children, strict=True)]:
        if status:
            raise subprocess.CalledProcessError(status, call)


def compile_here(name, folder):
    """Call what is compiled by a name, with files in a folder."""
    import numpy as np
    import trimesh
    from click.testing import CliRunner

    if name == "sweep":
        from feederscrew.conveying import setting, sweep

        sweep.sweep(np.array([setting.plain(1.0, 0.5, 0.0, 0.4)]))
        return
    from feederscrew_cli.main import feeder

    files = {"bowl": folder / "bowl.yaml", "ball": folder / "ball.stl"}
    files |= {"part": PARTS / "squarenut_m5.stl", "bracket": PARTS / "lbracket_30x20x15.stl"}
    files["bowl"].write_text(BOWL)
    trimesh.creation.icosphere(subdivisions=4).export(files["ball"])
    words = shlex.split(COMMANDS[name].format(**files))
    done = CliRunner().invoke(feeder, words)
    assert done.exit_code == 0, (words, done.output, done.exception)


if __name__ == "__main__":
    if not sys.argv[1:]:
        compile_side_by_side()
    for one in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as made:
            compile_here(one, Path(made))
