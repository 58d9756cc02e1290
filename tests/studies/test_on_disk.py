"""What was simulated is taken again by a later run, if nothing of it has changed."""

import base64
import hashlib
import json
import os
import pickle
import stat
from collections import OrderedDict
from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.dropping import arrival
from feederscrew.studies import simulation_cache
from feederscrew.studies.rate import shares

PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.read(None, ())


@pytest.fixture
def runs(tmp_path, monkeypatch):
    """Each call is a run of its own: it tells the shares, and how often was simulated so far."""
    monkeypatch.setenv(simulation_cache.VARIABLE, str(tmp_path / "kept"))
    made, simulate = [], arrival.arrival
    monkeypatch.setattr(arrival, "arrival", lambda *args, **own: made.append(1) or simulate(*args, **own))

    def run(part=PART, bowl=BOWL, **own):
        monkeypatch.setattr(simulation_cache, "_RECORDS", OrderedDict())
        return shares(part, bowl, fed=40, **own).aspects, len(made)

    run.folder = tmp_path / "kept"
    return run


def test_the_same_is_simulated_once(runs):
    first, again = runs(), runs()
    assert (first[1], again[1]) == (1, 1)
    np.testing.assert_array_equal(first[0].recommended.p, again[0].recommended.p)
    assert len(list(runs.folder.iterdir())) == 1


@pytest.mark.parametrize(
    "other",
    [
        {"seed": 2},
        {"bowl": bowls.read(None, ["restitution=0.31"])},
        {"part": shapes.part(shapes.box(20, 12, 5.01))},
    ],
)
def test_what_differs_is_simulated_anew(runs, other):
    runs()
    assert runs(**other)[1] == 2


def test_without_a_place_to_write_all_goes_on(runs, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    for place in ("", str(tmp_path / "file" / "below")):
        monkeypatch.setenv(simulation_cache.VARIABLE, place)
        before = runs()[1]
        assert runs()[1] == before + 1


KEY = {"kind": "test", "settings": "()"}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv(simulation_cache.VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache"


def numbered(k):
    return KEY | {"part": str(k)}


def test_the_oldest_go_and_what_is_kept_cannot_be_changed(monkeypatch, folder):
    monkeypatch.setattr(simulation_cache, "MAX_ENTRIES", 3)
    folder.mkdir()
    (folder / "mine.txt").write_text("older than all")
    (folder / "mine.simulated").mkdir()
    for k in range(5):
        simulation_cache.write(numbered(k), {"p": np.arange(3.0)})
    assert len(list(folder.iterdir())) == 5 and (folder / "mine.txt").exists()
    found = simulation_cache.read(numbered(4))
    with pytest.raises(ValueError, match="read-only"):
        found["p"][0] = 1.0
    monkeypatch.setattr(simulation_cache, "MAX_ENTRY_BYTES", 10)
    simulation_cache.write(numbered(9), {"p": np.arange(3.0)})
    assert simulation_cache.read(numbered(9)) is None


def test_arrays_come_back_as_they_were(folder):
    arrays = {
        "p": np.array([[1.0 / 3.0, np.nan], [-np.inf, 5e-324]]),
        "n": np.array(7),
        "which": np.array([True, False]),
        "none": np.zeros((0, 3)),
    }
    simulation_cache.write(KEY, arrays)
    found = simulation_cache.read(KEY)
    assert set(found) == set(arrays)
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)
        assert (found[name].dtype, found[name].shape) == (array.dtype, array.shape)


class Bomb:
    """Runs code where it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return (open, (str(self.path), "w"))


def test_nothing_of_an_entry_is_run(folder, tmp_path):
    simulation_cache.write(KEY, {"p": np.arange(3.0)})
    (entry,) = folder.iterdir()
    data = pickle.dumps(Bomb(tmp_path / "ran"))
    entry.write_bytes(hashlib.sha256(data).digest() + data)
    assert simulation_cache.read(KEY) is None and not (tmp_path / "ran").exists()


def as_pipe(entry, tmp_path):
    os.mkfifo(entry)


def as_device(entry, tmp_path):
    entry.symlink_to("/dev/zero")


def as_link(entry, tmp_path):
    (tmp_path / "moved").write_bytes(as_link.data)
    entry.symlink_to(tmp_path / "moved")


def as_folder(entry, tmp_path):
    entry.mkdir()


def as_hole(entry, tmp_path):
    with entry.open("wb") as file:
        file.truncate(1 << 40)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes")
@pytest.mark.parametrize("other", [as_pipe, as_device, as_link, as_folder, as_hole])
def test_only_a_regular_file_is_read(folder, tmp_path, other):
    simulation_cache.write(KEY, {"p": np.arange(3.0)})
    (entry,) = folder.iterdir()
    as_link.data = entry.read_bytes()
    entry.unlink()
    other(entry, tmp_path)
    assert simulation_cache.read(KEY) is None
    simulation_cache.write(KEY, {"p": np.arange(3.0)})
    assert (simulation_cache.read(KEY) is not None) == (other is not as_folder)
    assert len(list(folder.iterdir())) == 1


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="needs owners")
def test_a_folder_that_others_may_write_is_not_used(folder, monkeypatch):
    simulation_cache.write(KEY, {"p": np.arange(3.0)})
    assert simulation_cache.refusal() is None and stat.S_IMODE(folder.stat().st_mode) == 0o700
    folder.chmod(0o777)
    assert simulation_cache.read(KEY) is None and "other users" in simulation_cache.refusal()
    simulation_cache.write(numbered(2), {"p": np.arange(3.0)})
    assert len(list(folder.iterdir())) == 1
    folder.chmod(0o755)
    assert simulation_cache.read(KEY) is not None
    monkeypatch.setattr(os, "geteuid", lambda: folder.stat().st_uid + 1)
    assert simulation_cache.read(KEY) is None and "another user" in simulation_cache.refusal()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a full disk")
def test_a_full_disk_leaves_nothing(folder, monkeypatch):
    real = os.open
    folder.mkdir()

    def full(path, flags, *mode):
        handle = real(path, flags, *mode)
        if flags & os.O_WRONLY:
            os.close(handle)
            return real("/dev/full", os.O_WRONLY)
        return handle

    monkeypatch.setattr(os, "open", full)
    simulation_cache.write(KEY, {"p": np.arange(3.0)})
    assert list(folder.iterdir()) == []


def rewritten(entry, change):
    """The entry with other arrays in it, its digest made right again: whoever writes it can do so."""
    held = json.loads(entry.read_bytes())
    change(held)
    line = json.dumps([held["key"], held["arrays"]], sort_keys=True).encode()
    held["sha256"] = hashlib.sha256(line).hexdigest()
    entry.write_text(json.dumps(held))


def test_an_entry_damaged_anywhere_is_as_none(folder, rng):
    arrays = {"p": np.arange(4.0), "n": np.array(3)}
    simulation_cache.write(KEY, arrays)
    (entry,) = folder.iterdir()
    whole = entry.read_bytes()
    for _ in range(300):
        start, length = rng.integers(len(whole)), rng.integers(0, 40)
        odd = rng.choice([b"", b"[" * 3000, b"1e999", b"null", b"\x00", b"9" * 5000, bytes(rng.bytes(10))])
        entry.write_bytes(whole[:start] + odd + whole[start + length :])
        found = simulation_cache.read(KEY)
        assert found is None or all((found[name] == arrays[name]).all() for name in arrays)


def of_floats(*values, shape=None):
    data = np.array(values, "<f8")
    return {"kind": "float", "shape": shape or [len(values)], "data": base64.b64encode(data).decode()}


def of_whole(*values, shape=None):
    data = np.array(values, "<i8")
    return {
        "kind": "int",
        "shape": [len(values)] if shape is None else shape,
        "data": base64.b64encode(data).decode(),
    }


WRONG = [
    ("plate", of_floats(1.0, 1.0, 1.0)),
    ("plate", of_floats(np.nan, 0.0, 0.0)),
    ("plate", of_floats(5.0, 0.0, 0.0)),
    ("plate", of_floats(-0.5, 1.0, 0.5)),
    ("plate", of_floats(0.5, 0.5)),
    ("plate", of_whole(1, 0, 0)),
    ("start", of_floats(2.0, 0.0, 0.0)),
    ("error", of_floats(np.inf, 0.0, 0.0)),
    ("counts", of_whole(*[-1] * 9, shape=[3, 3])),
    ("times", of_floats(-1.0, 0.0, 0.0)),
    ("changing", of_whole(0, 0, 0)),
    ("course", of_floats(shape=[0, 3])),
    ("velocity", of_floats(np.inf, 0.0, 0.0)),
    ("parts", of_whole(0, shape=[])),
    ("parts", of_whole(41, shape=[])),
    ("parts", of_whole(-40, shape=[])),
    ("lost", of_whole(1, shape=[])),
    ("seconds", of_floats(1e300, shape=[])),
    ("limit", of_floats(0.1, 0.1, 7.0)),
    ("limit", {"kind": "object", "shape": [3], "data": ""}),
    ("limit", {"kind": "float", "shape": [10**30, 0], "data": ""}),
    ("limit", {"kind": "float", "shape": [3], "data": "?"}),
    ("limit", None),
]


@pytest.mark.parametrize("name, wrong", WRONG)
def test_an_entry_of_numbers_that_cannot_be_is_as_none(runs, name, wrong):
    first, before = runs()
    (entry,) = runs.folder.iterdir()
    rewritten(entry, lambda held: held["arrays"].update({name: wrong}))
    found, after = runs()
    assert after == before + 1
    np.testing.assert_array_equal(first.recommended.p, found.recommended.p)
