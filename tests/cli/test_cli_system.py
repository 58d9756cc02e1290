"""What the system refuses, and names that are no letters: one line, and as much done as can be."""

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import click
import pytest
from click.testing import CliRunner
from command_lines import NUT, names, rows

from feederscrew.base.columns import Frame
from feederscrew.jobs.batch import batch_run as batches
from feederscrew.output import offers, tables
from feederscrew_cli.main import feeder
from feederscrew_cli.progress import Progress
from feederscrew_cli.talk import Output

UNDRAWN = True  # test_pictures.py and others look at pictures
QUICK = ("--no-pictures", "--jobs", 1, "--rule", "closed")  # nothing is simulated
FULL = Path("/dev/full")
ODD = ("$dollar^_{x}$.stl", "=1+1.stl", "n" * 240 + ".stl", os.fsdecode(b"bad\xff\xfe.stl"))
MOST_HELP_LINES = 60  # of one command
MOST_HELP_LINES_OF_ALL = 800
EXTRA = {"config": ("init",), "tune": ("--target", "60/min")}
EXTRA |= dict.fromkeys(("compare", "calibrate"), ("--with", "x.csv"))
NO_SPACE = "cannot be read or written (No space left on device) - check the disk and permissions"
linux = pytest.mark.skipif(not FULL.exists(), reason="no /dev/full here")


def program(*arguments, **streams):
    """The program in a process of its own."""
    code = "import sys; from feederscrew_cli.main import feeder; feeder(sys.argv[1:])"
    call = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(call, **streams, timeout=60, check=False)


@linux
def test_a_full_disk_under_stdout_is_one_line_and_under_stderr_does_not_cost_the_answer(monkeypatch):
    """Where stderr is buffered, Python's last flush of it once ended in status 120."""
    with FULL.open("wb") as full:
        for call in (["--help"], ["inertia", NUT]):
            done = program(*call, stdout=full, stderr=subprocess.PIPE)
            said = done.stderr.decode()
            assert (done.returncode, said.splitlines()[-1]) == (1, f"Error: output: {NO_SPACE}")
            assert "Traceback" not in said
        for unbuffered in ("", "1"):
            monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
            done = program("inertia", NUT, stdout=subprocess.PIPE, stderr=full)
            assert (done.returncode, b"volume" in done.stdout) == (0, True)


@pytest.mark.parametrize("name", list(feeder.commands))
def test_every_command_tells_of_a_full_disk_in_one_line(run, monkeypatch, name):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device", "x.csv")

    monkeypatch.setattr(click.Command, "invoke", full)
    parameters = feeder.commands[name].params
    needs = any(param.required for param in parameters if param.param_type_name == "argument")
    done = run(name, *(["x.stl"] if needs else []), *EXTRA.get(name, ()))
    assert (done.exit_code, done.stderr) == (1, f"Error: x.csv: {NO_SPACE}\n")


def test_a_full_disk_in_a_batch_is_one_line_and_keeps_what_is_finished(run, monkeypatch, tmp_path):
    for name in ("a.stl", "b.stl"):
        shutil.copy(NUT, tmp_path / name)
    call = ("batch", "a.stl", "b.stl", "-o", "out", *QUICK)
    finished, write, keep = [], Path.write_bytes, batches.Store.keep

    def full(path, *arguments, **keywords):
        if path.parent.name == "new" and "b" in finished:
            raise OSError(errno.ENOSPC, "No space left on device", str(path))
        return write(path, *arguments, **keywords)

    def noted(store, outcome):
        finished.append(outcome.name)
        return keep(store, outcome)

    with monkeypatch.context() as patch:
        patch.setattr(batches.Store, "keep", noted)
        patch.setattr(Path, "write_bytes", full)
        done = run(*call)
    assert done.exit_code == 1
    assert done.stderr.splitlines()[-1] == (
        "Error: out: cannot be written (No space left on device) - "
        "make room there, then start this batch again with --resume: what is finished is kept"
    )
    assert (tmp_path / "out/parts/a/run.json").exists()
    assert not list((tmp_path / "out").glob(f"{batches.STALE}*"))
    assert run(*call, "--resume").exit_code == 0


def test_a_batch_of_odd_names_ends_with_its_summary(run, tmp_path):
    for name in ODD:
        try:
            shutil.copy(NUT, tmp_path / name)
        except OSError:
            pytest.skip("this file system takes no such name")
    done = run("batch", ".", "-o", "out", *QUICK)
    assert (done.exit_code, "Error" in done.stderr) == (0, False)
    _, *lines = (tmp_path / "out/summary.csv").read_text().splitlines()
    assert len(lines) == len(ODD) and (tmp_path / "out/index.html").exists()
    for begin in ("'=1+1.stl,'=1+1,", r"bad\udcff\udcfe.stl,bad__,"):
        assert sum(line.startswith(begin) for line in lines) == 1, begin


def test_links_that_go_round_are_counted_once_and_dangling_ones_are_told(run, tmp_path):
    (tmp_path / "in").mkdir()
    shutil.copy(NUT, tmp_path / "in/a.stl")
    (tmp_path / "in/round").symlink_to(tmp_path / "in", target_is_directory=True)
    (tmp_path / "in/lost.stl").symlink_to(tmp_path / "nothing.stl")
    line = "Error: in/lost.stl: is a link to a file that is not there - mend or remove the link"
    for source in ("in/**/*.stl", "in"):
        done = run("batch", source, "-o", "out", *QUICK)
        assert done.exit_code == 1 and line in done.stderr.splitlines()
        assert len(rows(tmp_path / "out/summary.csv")) == 2


def test_an_interrupt_while_drawing_keeps_the_counts_and_one_before_that_writes_nothing(
    run, tmp_path, monkeypatch
):
    shutil.copy(NUT, tmp_path / "a.stl")

    def stopped(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        offers.write(SimpleNamespace(staged={}, left_out=[], write=print), [offers.Offer("a.csv", stopped)])
    monkeypatch.setattr("feederscrew.output.style.png", stopped)
    done = run("drop", "a.stl", "--drops", 20, "-o", "out", "--depfile", "drop.d")
    assert "Warning: stopped while drawing: without drop.png\n" in done.stderr
    assert done.exit_code == 130 and not (tmp_path / "drop.d").exists()
    assert names(tmp_path / "out/a") == {"drop.csv", "drop.json", "run.json"}


@pytest.mark.skipif(sys.platform != "linux", reason="asks for a pseudo terminal of Linux")
def test_a_table_fits_the_window():
    import pty

    ours, theirs = pty.openpty()
    environment = {**os.environ, "COLUMNS": "72"}
    done = program("aspects", NUT, "--rule", "closed", "-q", stdout=theirs, env=environment)
    os.close(theirs)
    lines = os.read(ours, 100_000).decode().splitlines()
    os.close(ours)
    assert done.returncode == 0 and max(map(len, lines)) <= 72
    assert sum(line.startswith("aspect ") for line in lines) == 2


def test_what_is_said_beside_a_bar_has_a_line_of_its_own(monkeypatch, capfd):
    """A tuning ended in `settings [####----]  1/340/min at this friction`."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with Progress(None, what="settings") as bar:
        bar.reach(1, 3)
        Output("tune", (), "table").say("40/min")
        bar.reach(2, 3)
    first, said, last, rest = capfd.readouterr().err.split("\n")
    assert "1/3" in first and said == "40/min" and "2/3" in last and "settings" not in rest


def test_a_name_that_would_command_a_terminal_is_shown_by_its_letters(run, tmp_path):
    odd = Path(shutil.copy(NUT, tmp_path / "red\x1b[31m\nrow.stl"))
    good, bad = run("inertia", odd.name, "-o", "out"), run("inertia", f"no {odd.name}")
    assert "\x1b" not in good.stderr + good.stdout + bad.stderr
    assert bad.stderr == "Error: no red\\x1b[31m row.stl: no such file - check the path\n"
    assert tables.text(Frame.of({"part": ["a\nb\x07"]}), "table") == "part\na b\\x07\n"


def test_each_help_fits_a_screen_and_all_of_them_can_be_read():
    """With the subcommands they were 962 lines once; the longest had 64."""
    long, lines = {}, 0
    for path in sorted(command_paths(feeder)):
        shown = CliRunner().invoke(feeder, [*path, "--help"], terminal_width=80).output.splitlines()
        lines += len(shown)
        long |= {path: len(shown)} if len(shown) > MOST_HELP_LINES else {}
        assert max(map(len, shown)) <= 80, path
    assert not long and lines <= MOST_HELP_LINES_OF_ALL


def command_paths(group, lead=()):
    """The words of each command, from the program itself to subcommands."""
    yield lead
    for name in getattr(group, "commands", {}):
        yield from command_paths(group.commands[name], (*lead, name))
