"""The program: its commands, its help and its one error fence."""

import contextlib
import importlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from feederscrew import __version__
from feederscrew.errors import Faults, FeederError, MeshError
from feederscrew.output import style, tables
from feederscrew_cli import interrupt, options
from feederscrew_cli.main import Fence, feeder

ROOT = Path(__file__).parents[3]
HEAVY = {"numpy", "scipy", "trimesh", "pandas", "matplotlib", "numba", "embreex", "yaml"}


def told(*arguments):
    """A program of a few odd commands, run."""
    return CliRunner().invoke(PROGRAM, list(arguments))


@click.command()
def bad():
    """Example: feeder bad"""
    raise MeshError("parts/a.stl", "is open", "close it")


@click.command()
def worse():
    """Example: feeder worse"""
    raise Faults(
        [FeederError("b.yaml:2:3", "is odd", "mend it"), FeederError("b.yaml:4:1", "is odd", "mend it")]
    )


@click.command()
def stop():
    """Example: feeder stop"""
    raise KeyboardInterrupt


@click.command()
def bug():
    """Example: feeder bug"""
    raise ZeroDivisionError


@click.command()
@options.output
def speak(out):
    """Example: feeder speak"""
    out.warn("careful")
    out.say("done")
    out.detail("slowly")
    with out.step("nothing"):
        pass
    out.show(tables.frame({"normal_x": [1.0], "height_mm": [2.0]}), {"height_mm": 2.0}, hidden=["normal_x"])


@click.command()
@options.part
@options.bowl
@options.output
def put(part, bowl, out):
    """Example: feeder put nut.stl -o results"""
    with out.folder("nut", {part["source"]: "aa"}, {"bowl": bowl["overrides"]}) as folder:
        out.warn("careful")
        if folder:
            folder.write("a.csv", "x\n")
    click.echo(json.dumps({"part": part, "bowl": bowl}))


EMPTY_PATHS = (  # and the option or argument that is to blame
    (["aspects", ""], "PART"),
    (["batch", ""], "PARTS..."),
    (["aspects", "a.stl", "-o", ""], "-o' / '--output"),
    (["report", "a.stl", "-o", ""], "-o' / '--output"),
    (["aspects", "a.stl", "--depfile", ""], "--depfile"),
    (["slide", "--config", ""], "--config"),
    (["compare", "a.stl", "--with", ""], "--with"),
    (["calibrate", "a.stl", "--with", ""], "--with"),
)
PROGRAM = Fence("feeder", commands=[bad, worse, stop, bug, speak, put])


def test_a_fault_is_one_line_and_status_1():
    done = told("bad")
    assert (done.exit_code, done.stderr, done.stdout) == (1, "Error: parts/a.stl: is open - close it\n", "")


def test_all_faults_of_a_file_are_told():
    done = told("worse")
    assert done.exit_code == 1
    assert done.stderr == "Error: b.yaml:2:3: is odd - mend it\nError: b.yaml:4:1: is odd - mend it\n"


def test_an_interrupt_is_one_line_and_status_130():
    done = told("stop")
    assert (done.exit_code, done.stderr.strip(), done.stdout) == (130, "Stopped.", "")


def test_our_own_bug_keeps_its_traceback():
    assert isinstance(told("bug").exception, ZeroDivisionError)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["aspect"], "Error: No such command 'aspect'. Did you mean 'aspects'? (see feeder --help)"),
        (["--versoin"], "Error: No such option '--versoin'. Did you mean '--version'? (see feeder --help)"),
        (
            ["aspects", "a.stl", "--densty", "steel"],
            "Error: No such option '--densty'. Did you mean '--density'? (see feeder aspects --help)",
        ),
        (["aspects"], "Error: Missing argument 'PART'. (see feeder aspects --help)"),
        (
            ["aspects", "a.stl", "--units", "ft"],
            "Error: Invalid value for '--units': 'ft' is not one of 'mm', 'cm', 'm', 'um', 'in'."
            " (see feeder aspects --help)",
        ),
        (
            ["aspects", "a.stl", "--format", "jsn"],
            "Error: Invalid value for '--format': 'jsn' is not one of 'table', 'csv', 'json'."
            " Did you mean 'json'? (see feeder aspects --help)",
        ),
        *(
            (call, f"Error: Invalid value for '{name}': is empty - give a path (see feeder {call[0]} --help)")
            for call, name in EMPTY_PATHS
        ),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_wrong_call_is_one_line_and_status_2(run, arguments, line):
    done = run(*arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.splitlines() == [line.replace("feeder", feeder.name)]


def test_talk_goes_to_stderr_and_data_to_stdout():
    done = told("speak")
    assert done.stderr == "Warning: careful\ndone\n"
    assert done.stdout.split() == ["height", "[mm]", "2.000"]


def test_quiet_and_verbose():
    assert told("speak", "-q").stderr == ""
    assert "slowly\nnothing: 0.00 s\n" in told("speak", "-v").stderr


def test_shared_options_arrive_as_keywords(tmp_path):
    call = ["put", "nut.stl", "--units", "in", "--set", "a=1", "--set", "b=2", "--centre-of-mass", "-1,2,3"]
    assert json.loads(told(*call).stdout) == {
        "part": {
            "source": "nut.stl", "units": "in", "density": None,
            "centre_of_mass": "-1,2,3", "names": None, "body": None, "allow_open": False,
        },
        "bowl": {"path": None, "overrides": ["a=1", "b=2"]},
    }  # fmt: skip


def test_a_run_into_a_folder_is_recorded_as_typed_without_the_folder(tmp_path):
    done = told("put", "nut.stl", "--set", "a=1", "-o", str(tmp_path / "res"))
    assert done.stderr.endswith(f"Wrote {tmp_path / 'res/nut'} (a.csv, run.json)\n")
    entry = json.loads((tmp_path / "res/nut/run.json").read_text())["put"]
    assert entry["version"] == __version__
    assert entry["arguments"] == ["put", "nut.stl", "--set", "a=1"]
    assert entry["effective"] == {"bowl": ["a=1"]}
    assert entry["warnings"] == ["careful"]


def test_help_imports_no_heavy_library():
    code = f"""
import sys
from click.testing import CliRunner
from feederscrew_cli.main import feeder
done = CliRunner().invoke(feeder, ["--help"])
assert done.exit_code == 0 and "aspects" in done.stdout, done.output
print(*sorted({HEAVY!r} & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert (done.stderr, done.stdout.strip()) == ("", "")


@pytest.mark.parametrize("name", list(feeder.commands))
def test_every_command_is_shown_by_example(run, name):
    command = feeder.commands[name]
    for each in [command, *getattr(command, "commands", {}).values()]:
        assert each.help.startswith(f"Example: feeder {name}"), each.name
        assert each.short_help
    lines = [line.strip() for line in run(name, "--help").stdout.splitlines() if line.strip()]
    assert lines[1].startswith("Example: feeder")


def test_a_closed_pipe_is_silent():
    code = """
import click
from feederscrew_cli.main import Fence
def talk():
    for k in range(100_000):
        click.echo("line")
Fence("feeder", commands=[click.Command("talk", callback=talk)])(["talk"])
"""
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT
    ) as child:
        assert child.stdout.readline() == "line\n"
        child.stdout.close()
        assert (child.wait(timeout=20), child.stderr.read()) == (141, "")


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(("name", "ending"), [("bin/feeder", "(130, 'Stopped.')"), ("user.py", "(1, 'own')")])
def test_ctrl_c_while_the_program_loads_is_one_line_and_a_script_keeps_its_own(name, ending):
    code = f"""
import os, signal, sys
sys.argv[0] = {name!r}
import feederscrew_cli
try:
    os.kill(os.getpid(), signal.SIGINT)
except KeyboardInterrupt:
    sys.exit("own")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert str((done.returncode, done.stderr.strip())) == ending


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_stops_in_one_line():
    code = """
import click, time
from feederscrew_cli.main import Fence
def nap():
    print("up", flush=True)
    time.sleep(30)
Fence("feeder", commands=[click.Command("nap", callback=nap)])(["nap"])
"""
    child = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT
    )
    assert child.stdout.readline() == "up\n"
    time.sleep(0.05)
    child.send_signal(signal.SIGINT)
    _, said = child.communicate(timeout=10)
    assert (child.returncode, said.strip()) == (130, "Stopped.")


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_does_not_kill_a_program_that_has_given_its_answer():
    """`feeder bowl` that had written all ended by the signal, -2: Python had taken its handler away."""
    code = """
import click, sys, time
from feederscrew_cli.main import Fence
class Late:
    def __del__(self, nap=time.sleep, out=sys.stdout):  # while Python ends
        out.write("late\\n")
        out.flush()
        nap(0.5)
late = Late()
sys.argv = ["feeder", "work"]
Fence("feeder", commands=[click.Command("work", callback=lambda: print("done", flush=True))])()
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, cwd=ROOT) as child:
        assert [child.stdout.readline() for _ in range(2)] == ["done\n", "late\n"]
        child.send_signal(signal.SIGINT)
        assert child.wait(timeout=10) == 0


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_work_that_goes_on_after_a_dropped_interrupt_ends_at_its_next_step():
    """`feeder tooling` went on for minutes where a library had dropped it."""
    steps = []
    with interrupt.listening():
        tell = interrupt.heeding(steps.append)
        tell(1)
        with contextlib.suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            tell(2)
    assert steps == [1]


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("held", [contextlib.nullcontext, interrupt.held_back, interrupt.noted])
@pytest.mark.parametrize(
    "after", [None, ImportError("half-loaded"), MeshError("a", "b", "c"), click.exceptions.Exit(1)]
)
def test_an_interrupt_that_somebody_drops_is_no_success(capsys, held, after):
    """A library that loads drops it, a run gives what is there: make must not take it as done."""

    def work():
        with contextlib.suppress(KeyboardInterrupt), held():
            signal.raise_signal(signal.SIGINT)
        if after is not None:
            raise after

    with pytest.raises(SystemExit) as ended:
        Fence("feeder", commands=[click.Command("work", callback=work)])(["work"])
    assert ended.value.code == 130 and "Traceback" not in capsys.readouterr().err
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.long
@pytest.mark.thorough
def test_the_readme_says_what_the_program_says(monkeypatch, capsys, fewer):
    monkeypatch.chdir(ROOT)
    monkeypatch.syspath_prepend(ROOT / "docs")
    monkeypatch.setattr(sys, "argv", ["readme.py", "--check"])
    readme = importlib.import_module("readme")
    monkeypatch.setattr(readme, "CHECKED", fewer)
    monkeypatch.setattr(style, "png", lambda figure: b"")  # what is printed is compared
    status = readme.main()
    assert (status, *capsys.readouterr()) == (0, "", ""), "run: make docs"


RULED = {
    "rate": (), "tooling": (), "trial": (), "report": ("--aspect", "A"), "batch": ("-o", "out"),
    "design": ("--target", "30/min"), "bowl": ("--target", "30/min"),
    "tune": ("--aspect", "A", "--target", "30/min"),
}  # fmt: skip


@pytest.mark.parametrize("command", RULED)
def test_an_unknown_rule_is_told_before_anything_is_read(command):
    """It was a KeyError of design."""
    done = CliRunner().invoke(feeder, [command, "gone.stl", "--rule", "closd", *RULED[command]])
    assert (
        done.exit_code == 2 and done.stderr == "Error: --rule: unknown rule 'closd' - did you mean closed?\n"
    )


def _numbers(command, above=()):
    """Every option of a command that takes a number."""
    for option in command.params:
        if isinstance(option.type, (click.types.IntParamType, click.types.FloatParamType)):
            yield (*above, option.opts[-1])


NUMBERED = [given for name in feeder.commands for given in _numbers(feeder.commands[name], (name,))]


@pytest.mark.parametrize("command, option", NUMBERED)
@pytest.mark.parametrize("text", ["1_0", "\u0661\u0662", "nan"])
def test_a_number_is_of_plain_digits(command, option, text):
    done = CliRunner().invoke(feeder, [command, "gone.stl", option, text])
    assert done.exit_code == 2 and option in done.stderr and "Traceback" not in done.stderr
