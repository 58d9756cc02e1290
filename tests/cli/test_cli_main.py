"""The program: its commands, its help and its one error fence."""

import contextlib
import importlib
import json
import os
import signal
import subprocess
import sys

import click
import pytest
from click.testing import CliRunner
from command_lines import NUT, ROOT

from feederscrew import __version__
from feederscrew.base.columns import ColumnHead, Frame
from feederscrew.base.errors import Faults, FeederError, MeshError
from feederscrew.output import style
from feederscrew_cli import interrupt, options
from feederscrew_cli.main import Fence

HEAVY = {"numpy", "scipy", "trimesh", "pandas", "matplotlib", "numba", "embreex", "yaml"}
posix = pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")


def raising(name, fault):
    """A command that ends with a fault."""

    def callback():
        raise fault

    return click.Command(name, callback=callback, help=f"Example: feeder {name}")


@click.command()
@options.output
def speak(out):
    """Example: feeder speak"""
    out.warn("careful")
    out.say("done")
    with out.step("nothing"):
        out.detail("slowly")
    frame = Frame.of({"normal_x": [1.0], "height_mm": [2.0]})
    above = {"height_mm": ColumnHead.of_name("height_mm", "mm")}
    out.show(frame.headed(above), {"height_mm": 2.0}, hidden=["normal_x"])


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


ODD = Faults([FeederError("b.yaml:2:3", "is odd", "mend it"), FeederError("b.yaml:4:1", "is odd", "mend it")])
FAULTS = {  # a command that raises it, the exit status and what is said
    "bad": (MeshError("parts/a.stl", "is open", "close it"), 1, "Error: parts/a.stl: is open - close it\n"),
    "worse": (ODD, 1, "Error: b.yaml:2:3: is odd - mend it\nError: b.yaml:4:1: is odd - mend it\n"),
    "stop": (KeyboardInterrupt(), 130, "\nStopped.\n"),
    "bug": (ZeroDivisionError(), 1, ""),
}
RAISING = [raising(name, fault) for name, (fault, *_) in FAULTS.items()]
PROGRAM = Fence("feeder", commands=[speak, put, *RAISING])


def ran(*arguments):
    """A program of a few odd commands, run."""
    return CliRunner().invoke(PROGRAM, list(arguments))


def test_each_fault_is_a_line_our_own_bug_keeps_its_traceback_and_talk_goes_to_stderr_data_to_stdout():
    for name, (fault, status, said) in FAULTS.items():
        done = ran(name)
        assert (done.exit_code, done.stderr.strip(), done.stdout) == (status, said.strip(), "")
        assert isinstance(done.exception, ZeroDivisionError) == (name == "bug"), fault
    done = ran("speak")
    assert done.stderr == "Warning: careful\ndone\n"
    assert done.stdout.split() == ["height", "[mm]", "2.000"]
    assert ran("speak", "-q").stderr == "" and "slowly\nnothing: 0.00 s\n" in ran("speak", "-v").stderr


def test_shared_options_arrive_as_keywords_and_a_run_is_recorded_as_typed_without_the_folder(tmp_path):
    call = ["put", "nut.stl", "--units", "in", "--set", "a=1", "--set", "b=2", "--centre-of-mass", "-1,2,3"]
    part = {"source": "nut.stl", "units": "in", "centre_of_mass": "-1,2,3", "allow_open": False}
    part, bowl = (
        part | dict.fromkeys(("density", "names", "body")),
        {"path": None, "overrides": ["a=1", "b=2"]},
    )
    assert json.loads(ran(*call).stdout) == {"part": part, "bowl": bowl}
    done = ran("put", "nut.stl", "--set", "a=1", "-o", str(tmp_path / "res"))
    assert done.stderr.endswith(f"Wrote {tmp_path / 'res/nut'} (a.csv, run.json)\n")
    entry = json.loads((tmp_path / "res/nut/run.json").read_text())["put"]
    recorded = [entry[name] for name in ("version", "arguments", "effective", "warnings")]
    assert recorded == [__version__, ["put", "nut.stl", "--set", "a=1"], {"bowl": ["a=1"]}, ["careful"]]


def python(code, *arguments, **streams):
    """A Python process that runs a few lines at the root of the project."""
    call, pipe = [sys.executable, "-c", code, *arguments], subprocess.PIPE
    return subprocess.Popen(call, stdout=pipe, stderr=pipe, text=True, cwd=ROOT, **streams)


@pytest.mark.parametrize(
    ("words", "heavy"),
    [
        (["--help"], HEAVY),
        (["convey"], {"numba"}),
        (["slide", "-o", "FOLDER"], {"pandas"}),  # tables, documents and pictures of it
        (["aspects", str(NUT), "--rule", "closed", "-o", "FOLDER"], {"pandas"}),
        (["rate", str(NUT), "--rule", "closed"], {"scipy.optimize", "scipy.stats", "pandas"}),
    ],
    ids=["help", "convey", "slide", "aspects", "rate"],
)
def test_help_imports_no_heavy_library_and_one_point_no_compiler(words, heavy, tmp_path):
    words = [str(tmp_path) if word == "FOLDER" else word for word in words]
    code = "import sys; from click.testing import CliRunner; from feederscrew_cli.main import feeder\n"
    code += f"assert CliRunner().invoke(feeder, {words!r}).exit_code == 0\n"
    code += f"print(*sorted({heavy!r} & set(sys.modules)))"
    assert python(code).communicate() == ("\n", "")


def test_what_is_loaded_is_not_looked_through_for_garbage_as_the_program_ends():
    """That took a third of an import of numpy and scipy.spatial."""
    code = "import atexit, gc, sys; sys.argv[1:] = ['--version']; from feederscrew_cli.main import feeder\n"
    code += "atexit.register(lambda: print(gc.get_freeze_count() > 1000))\nfeeder()"
    said, told = python(code).communicate()
    assert said.splitlines()[-1] == "True" and not told


COMMAND = """
import click, sys, time
from feederscrew_cli.main import Fence
def work():
{body}
Fence("feeder", commands=[click.Command("work", callback=work)])(["work"])
"""


def test_a_closed_pipe_is_silent():
    with python(COMMAND.format(body='    for k in range(100_000): click.echo("line")')) as child:
        assert child.stdout.readline() == "line\n"
        child.stdout.close()
        assert (child.wait(timeout=20), child.stderr.read()) == (141, "")


@posix
@pytest.mark.parametrize(("name", "ending"), [("bin/feeder", (130, "Stopped.")), ("user.py", (1, "own"))])
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
    child = python(code)
    _, said = child.communicate()
    assert (child.returncode, said.strip()) == ending


@posix
def test_ctrl_c_does_not_kill_a_program_that_has_given_its_answer():
    """`feeder bowl` that had written all ended by the signal, -2: Python had taken its handler away."""
    late = """
class Late:
    def __del__(self, nap=time.sleep, out=sys.stdout):  # while Python ends
        out.write("late\\n")
        out.flush()
        nap(0.5)
sys.late = Late()  # among garbage it would not be asked: what is loaded is frozen
"""
    code = COMMAND.format(body='    print("done", flush=True)').replace("def work", f"{late}def work")
    code = code.replace('(["work"])', "()")  # as a user's program: it ends the process
    with python(f"import sys\nsys.argv = ['feeder', 'work']\n{code}") as child:
        assert [child.stdout.readline() for _ in range(2)] == ["done\n", "late\n"]
        child.send_signal(signal.SIGINT)
        assert child.wait(timeout=10) == 0


@posix
def test_work_that_goes_on_after_a_dropped_interrupt_ends_at_its_next_step():
    """`feeder tooling` went on for minutes where a library had dropped it."""
    steps = []
    with interrupt.note_every_interrupt():
        tell = interrupt.heed_interrupts(steps.append)
        tell(1)
        with contextlib.suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            tell(2)
    assert steps == [1]


@posix
@pytest.mark.parametrize(
    "held", [contextlib.nullcontext, interrupt.hold_interrupts, interrupt.note_interrupts]
)
@pytest.mark.parametrize(
    "after", [None, ImportError("a"), MeshError("a", "b", "c"), click.exceptions.Exit(1)]
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


LOADING = """
import time
try:
    print("loading", flush=True)
    time.sleep(0.4)
except BaseException:  # as libraries do that go without what they cannot load
    print("dropped", flush=True)
"""
CALLBACK = """
class Late:
    def __del__(self):
        print("loading", flush=True)
        time.sleep(0.4)
Late()
"""


@posix
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize(
    "line", ["import loading", "exec(open('callback.py').read())"], ids=["import", "callback"]
)
def test_a_signal_within_an_import_or_a_callback_ends_the_program_after_it(tmp_path, line, name):
    """In 0.28 s of the loading it was dropped with a traceback, and the run went on."""
    (tmp_path / "loading.py").write_text(LOADING)
    (tmp_path / "callback.py").write_text(CALLBACK)
    code = f"import os, sys; os.chdir({str(tmp_path)!r}); sys.path.insert(0, '')\n"
    code += COMMAND.format(body=f"    {line}\n    print('after', flush=True)\n    time.sleep(20)")
    with python(code) as child:
        assert child.stdout.readline() == "loading\n"
        child.send_signal(getattr(signal, name))
        said, err = child.stdout.read(), child.stderr.read()
        assert child.wait(timeout=10) == 128 + getattr(signal, name)
    assert "dropped" not in said and "Traceback" not in err and err.splitlines()[-1] == "Stopped."


@posix
def test_sigterm_is_ctrl_c_once_though_it_comes_twice_and_nohup_is_heeded():
    """`timeout` sends it to the program and to its group: the second cost what the first had saved."""
    body = """
    for turn in range(2):
        try:
            print("ready", flush=True)
            time.sleep(20 if turn == 0 else 0.3)
        except KeyboardInterrupt:
            print("stopped", flush=True)
    """
    with python(
        "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n" + COMMAND.format(body=body)
    ) as child:
        assert child.stdout.readline() == "ready\n"
        child.send_signal(signal.SIGHUP)
        child.send_signal(signal.SIGTERM)
        assert child.stdout.readline() == "stopped\n"
        child.send_signal(signal.SIGTERM)
        assert child.stdout.read() == "ready\n"
        assert child.wait(timeout=10) == 143


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
