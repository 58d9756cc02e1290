"""What is wrong on the command line ends with 2, what is wrong in a file with 1, both together with 1."""

from pathlib import Path

import pytest

PARTS = Path(__file__).parents[3] / "parts"
NUT, CARD = PARTS / "squarenut_m5.stl", PARTS / "magnet.yaml"


@pytest.mark.parametrize(
    ("call", "option"),
    [
        (["aspects", NUT, "--density", "stel"], "--density"),
        (["aspects", NUT, "--density", "-7 g/cm3"], "--density"),
        (["inertia", NUT, "--centre-of-mass", "1,2"], "--centre-of-mass"),
        (["inertia", NUT, "--centre-of-mass", "90,0,0"], "--centre-of-mass"),
        (["inertia", NUT, "--body", "7"], "--body"),
        (["inertia", CARD, "--density", "brass"], "--density"),
        (["aspects", NUT, "--columns", "aspet"], "--columns"),
        (["floor", NUT, "--aspect", "Z"], "--aspect"),
        (["headings", NUT, "--aspect", "Z"], "--aspect"),
        (["track", NUT, "--aspect", "Z"], "--aspect"),
        (["rate", NUT, "--aspect", "Z", "--rule", "csa"], "--aspect"),
        (["tune", NUT, "--aspect", "Z", "--rule", "csa", "--target", "30/min"], "--aspect"),
        (["bowl", NUT, "--aspect", "Z", "--rule", "csa", "--target", "30/min"], "--aspect"),
        (["report", NUT, "--aspect", "Z", "--rule", "csa", "-o", "out"], "--aspect"),
        (["tooling", NUT, "--aspect", "Z", "--rule", "csa"], "--aspect"),
        (["tooling", NUT, "--aspect", "A", "--heading", "31", "--rule", "csa"], "--heading"),
        (["trial", NUT, "--aspect", "Z", "--rule", "csa"], "--aspect"),
        (["design", NUT, "--target", "30/min", "--aspect", "Z", "--rule", "csa"], "--aspect"),
        (["design", NUT, "--target", "30/min", "--up", "Z", "--rule", "csa"], "--up"),
        (["design", NUT, "--target", "30/min", "--without", "slide"], "--without"),
        (["rate", NUT, "--aspect", "A", "--rule", "closd"], "--rule"),
        (["convey", "--set", "drive.frequency"], "--set"),
        (["convey", "--set", "drive.frequncy=50 Hz"], "--set"),
        (["convey", "--set", "drive.frequency=50 mm"], "--set"),
        (["convey", "--set", "friction.static=0.1", "--set", "friction.kinetic=0.3"], "--set"),
        (["convey", "--config", "good.yaml", "--set", "friction.kinetic=0.9"], "--set"),
        (["convey", *(f"--set=a{k}=1" for k in range(40))], "--set"),
        (["convey", "--vary", "drive.frequncy=5:6:3"], "--vary"),
        (["drop", NUT, "--height", "1 kg"], "--height"),
        (["reproduce", "no table"], ""),
        (["bowl", "--measured", "strok=0.3 mm"], "--measured"),
        (["bowl", "--measured", "stroke=-1 mm"], "--measured"),
        (["config", "show", "--set", "drive.frequency=0 Hz"], "--set"),
    ],
)
def test_a_wrong_value_of_an_option_is_status_2(run, tmp_path, call, option):
    (tmp_path / "good.yaml").write_text("friction:\n  static: 0.5\n")
    done = run(*call)
    assert (done.exit_code, done.stdout) == (2, ""), done.stderr
    assert done.stderr.splitlines()[-1].startswith("Error: ") and option in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "call",
    [
        ["convey", "--config", "bad.yaml"],
        ["convey", "--config", "bad.yaml", "--set", "drive.frequncy=50 Hz"],  # both: mend the file first
        ["convey", "--config", "gone.yaml"],
        ["aspects", "gone.stl"],
        ["aspects", NUT, "--names", "gone.yaml"],
        ["drop", NUT, "--launches", "gone.csv"],
        ["drop", CARD],
        ["compare", NUT, "--with", "gone.csv"],
        ["rate", NUT, "--aspect", "A", "--rule", "csa", "--config", "names.yaml"],
        ["batch", "list.csv", "--rule", "csa", "--no-pictures", "--jobs", "1", "-o", "out"],
    ],
)
def test_what_is_wrong_in_a_file_is_status_1(run, tmp_path, call):
    (tmp_path / "bad.yaml").write_text("drive:\n  frequncy: 50 Hz\n")
    (tmp_path / "names.yaml").write_text("devices:\n  - profile: {of: Z@0, play: 1 mm}\n")
    (tmp_path / "list.csv").write_text(f"part,aspect\n{NUT},Z\n")
    done = run(*call)
    assert done.exit_code == 1 and "Error: " in done.stderr and "Traceback" not in done.stderr
