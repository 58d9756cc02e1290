"""The one way to compiled code: it gives what its source does, wherever it is kept."""

import math
import os
import subprocess
import sys
from typing import NamedTuple

import numpy as np
import pytest

from feederscrew.base import caches
from feederscrew.base.geometry import compiled as door

POINT = door.record_type("x", "y", "turns", "far", whole=("turns",), flags=("far",))


class Pair(NamedTuple):
    first: np.ndarray
    scale: float


class Body(NamedTuple):
    pair: Pair
    rows: np.recarray
    count: int
    flag: bool


def swing(x: float, y: float) -> float:
    return x / (1.0 + x * x) + math.sin(y)


def filled(body, out, shift) -> float:
    for k in range(body.count):
        out[k, 0] = swing(body.pair.first[k] * body.pair.scale, 0.1) + shift
        body.rows[k].x, body.rows[k].turns, body.rows[k].far = out[k, 0], k, not body.flag
        out[k, 1] = body.rows[k].y
    return out[0, 0]


def body(count: int = 5, flag: bool = True) -> Body:
    rows = door.zero_rows(count, POINT)
    rows.y = np.arange(count)
    return Body(Pair(np.linspace(0.5, 2.0, count), 0.7), rows, count, flag)


@pytest.fixture
def kernel(monkeypatch, tmp_path):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))
    monkeypatch.setattr(door, "_fingerprint", lambda module: "own")
    door.compiled(swing)
    return lambda: door.entry(filled)


@pytest.mark.parametrize("shift", [0.25, 3])
def test_a_kernel_gives_what_its_source_does_compiled_and_loaded(kernel, shift):
    """Numbers, yes or no, arrays and records within records, whole numbers or not."""
    plain, given = body(), np.empty((5, 2))
    value = filled(plain, given, shift)
    for _ in range(2):  # compiled, then from the disk
        own, out = body(), np.empty((5, 2))
        assert kernel()(own, out, shift) == value
        assert np.array_equal(out, given) and np.array_equal(own.rows, plain.rows)
    assert len(kernel().files()) == 1 and door.on_disk(kernel())


def test_other_kinds_of_arguments_are_compiled_anew_and_the_oldest_go(kernel, monkeypatch):
    monkeypatch.setattr(door, "MAX_KERNELS", 1)
    run, out = kernel(), np.empty((5, 2))
    assert run(body(), out, 1.0) == run(body(), out, 1) == run(body(flag=False), out, 1.0)
    assert len(run.files()) == 1


def test_a_damaged_file_is_compiled_again(kernel):
    out = np.empty((5, 2))
    value = kernel()(body(), out, 1.0)
    file = kernel().files()[0]
    file.write_bytes(file.read_bytes()[:-100])
    assert kernel()(body(), out, 1.0) == value
    assert len(file.read_bytes()) > 100
    # Rows that do not follow each other are refused.
    with pytest.raises(ValueError, match="C order"):
        kernel()(body(), np.empty((2, 5)).T, 1.0)


def test_a_kernel_runs_where_no_folder_can_be_written(kernel, monkeypatch):
    monkeypatch.setattr(caches, "kernel_folder", lambda: None)
    out, given = np.empty((5, 2)), np.empty((5, 2))
    assert kernel()(body(), out, 1.0) == filled(body(), given, 1.0)
    assert np.array_equal(out, given) and not door.on_disk(kernel())


def counted(monkeypatch):
    """The list of functions that are compiled from here on."""
    names, compile_ = [], door._compile
    monkeypatch.setattr(door, "_compile", lambda f, kinds: names.append(f.__name__) or compile_(f, kinds))
    return names


def shifted(body, out, shift) -> float:
    """As ``filled``, with another answer: what somebody put into a cache under its name."""
    return 1000.0 + shift


def test_another_kernel_under_the_name_of_one_is_not_run(kernel, monkeypatch, tmp_path):
    """It was: with other arguments that is a segmentation fault."""
    out = np.empty((5, 2))
    value = kernel()(body(), out, 1.0)
    assert door.entry(shifted)(body(), out, 1.0) == 1001.0
    own, other = (next((tmp_path / "kernels").glob(f"{name}-*")) for name in ("filled", "shifted"))
    own.write_bytes(other.read_bytes())
    compiled = counted(monkeypatch)
    assert kernel()(body(), out, 1.0) == value and compiled == ["filled"]
    # ... nor one for other kinds of arguments
    kernel()(body(), out, 1)
    first, second = kernel().files()
    kept = {path: path.read_bytes() for path in (first, second)}
    first.write_bytes(kept[second])
    second.write_bytes(kept[first])
    assert kernel()(body(), out, 1.0) == kernel()(body(), out, 1) == value
    assert compiled == ["filled"] * 4


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with a name here")
@pytest.mark.parametrize("what", ["pipe", "link", "written by others", "folder"])
def test_what_is_no_file_of_ones_own_is_not_loaded(kernel, monkeypatch, tmp_path, what):
    """A pipe made a run wait for ever."""
    out = np.empty((5, 2))
    value = kernel()(body(), out, 1.0)
    (file,) = kernel().files()
    if what == "written by others":
        file.chmod(0o666)
    else:
        file.rename(tmp_path / "moved")
        {"pipe": os.mkfifo, "link": lambda path: path.symlink_to(tmp_path / "moved"), "folder": os.mkdir}[
            what
        ](file)
    compiled = counted(monkeypatch)
    assert kernel()(body(), out, 1.0) == value and compiled == ["filled"]
    assert door.on_disk(kernel()) == (what != "folder")  # else it took the place


def test_a_folder_of_kernels_is_not_used_where_others_may_write_or_that_belongs_to_another(
    kernel, monkeypatch, tmp_path
):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "own"))
    monkeypatch.setattr(caches, "LIBRARY", tmp_path / "nowhere")
    named, out = tmp_path / "kernels", np.empty((5, 2))
    value = kernel()(body(), out, 1.0)
    assert named.stat().st_mode & 0o777 == 0o700 and len(list(named.iterdir())) == 1
    named.chmod(0o777)
    elsewhere = caches.kernel_folder()
    assert elsewhere != named and tmp_path in elsewhere.parents and not kernel().files()
    assert "other users may write to it" in caches.kernel_refusals()[0]
    before = [path.stat().st_mtime_ns for path in named.iterdir()]
    assert kernel()(body(), out, 1.0) == value
    assert [path.stat().st_mtime_ns for path in named.iterdir()] == before
    assert [path.parent for path in kernel().files()] == [elsewhere]
    named.chmod(0o700)
    assert caches.kernel_folder() == named
    if hasattr(os, "geteuid"):
        monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
        assert caches.kernel_folder() not in (named, elsewhere)
        assert ["another user" in line for line in caches.kernel_refusals()] == [True, True]


def test_a_drop_from_the_disk_loads_no_compiler(tmp_path):
    """A process that finds its kernels on the disk does without numba: half a second of each call."""
    script = (
        "import sys; sys.argv = ['feeder', 'drop', 'parts/squarenut_m5.stl', '--drops', '50', '-q']\n"
        "from feederscrew_cli.main import feeder\n"
        "try: feeder()\n"
        "except SystemExit: print('numba' in sys.modules)"
    )
    for _ in range(2):
        call, own = [sys.executable, "-c", script], os.environ | {"FEEDER_CACHE": ""}
        done = subprocess.run(call, env=own, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "False"
