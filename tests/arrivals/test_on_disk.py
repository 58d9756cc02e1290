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
from feederscrew.arrivals import arrival, simulation_cache
from feederscrew.arrivals.entry import shares
from feederscrew.base import caches

PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.read(None, ())
KEY = {"kind": "test", "settings": "()"}
NUMBERED = [KEY | {"part": str(k)} for k in range(10)]
NUMBERS = {"p": np.arange(3.0)}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv(caches.SIMULATIONS_VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def entry(folder):
    """The file of one entry."""
    simulation_cache.write(KEY, NUMBERS)
    (path,) = folder.iterdir()
    return path


@pytest.fixture
def feed(folder, monkeypatch):
    """Each call is a run of its own: it gives the shares, and how often was simulated so far."""
    simulated, real = [], arrival.arrival
    monkeypatch.setattr(arrival, "arrival", lambda *args, **own: simulated.append(1) or real(*args, **own))

    def run(part=PART, bowl=BOWL, **own):
        monkeypatch.setattr(simulation_cache, "_RECORDS", OrderedDict())
        return shares(part, bowl, fed=40, **own).aspects.recommended.p, len(simulated)

    return run


def test_the_same_is_simulated_once_and_what_differs_anew(feed, folder, monkeypatch, tmp_path):
    first, again = feed(), feed()
    assert (first[1], again[1], len(list(folder.iterdir()))) == (1, 1, 1)
    np.testing.assert_array_equal(first[0], again[0])
    other_bowl, other_part = bowls.read(None, ["restitution=0.31"]), shapes.part(shapes.box(20, 12, 5.01))
    for count, other in enumerate(({"seed": 2}, {"bowl": other_bowl}, {"part": other_part}), start=2):
        assert feed(**other)[1] == count
    (tmp_path / "file").write_text("")
    for count, place in enumerate(("", str(tmp_path / "file/below")), start=5):  # nowhere to write
        monkeypatch.setenv(caches.SIMULATIONS_VARIABLE, place)
        assert feed()[1] == count


def test_the_oldest_go_and_what_is_kept_cannot_be_changed(monkeypatch, folder):
    monkeypatch.setattr(simulation_cache, "MAX_ENTRIES", 3)
    (folder / "mine.simulated").mkdir(parents=True)
    (folder / "mine.txt").write_text("older than all")
    for k in range(5):
        simulation_cache.write(NUMBERED[k], NUMBERS)
    assert len(list(folder.iterdir())) == 5 and (folder / "mine.txt").exists()
    with pytest.raises(ValueError, match="read-only"):
        simulation_cache.read(NUMBERED[4])["p"][0] = 1.0
    monkeypatch.setattr(simulation_cache, "MAX_ENTRY_BYTES", 10)
    simulation_cache.write(NUMBERED[9], NUMBERS)
    assert simulation_cache.read(NUMBERED[9]) is None


def test_arrays_come_back_as_they_were(folder):
    arrays = {"p": np.array([[1.0 / 3.0, np.nan], [-np.inf, 5e-324]]), "n": np.array(7)}
    arrays |= {"which": np.array([True, False]), "none": np.zeros((0, 3))}
    simulation_cache.write(KEY, arrays)
    read = simulation_cache.read(KEY)
    assert set(read) == set(arrays)
    for name, array in arrays.items():
        np.testing.assert_array_equal(read[name], array)
        assert (read[name].dtype, read[name].shape) == (array.dtype, array.shape)


class Bomb:
    """Runs code where it is unpickled."""

    def __reduce__(self):
        return (open, ("ran", "w"))


def test_nothing_of_an_entry_is_run(entry, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = pickle.dumps(Bomb())
    entry.write_bytes(hashlib.sha256(data).digest() + data)
    assert simulation_cache.read(KEY) is None and not (tmp_path / "ran").exists()


OTHERS = {  # what may lie in the place of an entry
    "pipe": lambda entry, moved: os.mkfifo(entry),
    "device": lambda entry, moved: entry.symlink_to("/dev/zero"),
    "link": lambda entry, moved: entry.symlink_to(moved),
    "folder": lambda entry, moved: entry.mkdir(),
    "hole": lambda entry, moved: entry.touch() or os.truncate(entry, 1 << 40),
}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes")
@pytest.mark.parametrize("other", OTHERS)
def test_only_a_regular_file_is_read(entry, folder, tmp_path, other):
    entry.rename(tmp_path / "moved")
    OTHERS[other](entry, tmp_path / "moved")
    assert simulation_cache.read(KEY) is None
    simulation_cache.write(KEY, NUMBERS)
    assert (simulation_cache.read(KEY) is not None) == (other != "folder")
    assert len(list(folder.iterdir())) == 1


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="needs owners")
def test_a_folder_that_others_may_write_is_not_used(entry, folder, monkeypatch):
    assert simulation_cache.refusal() is None and stat.S_IMODE(folder.stat().st_mode) == 0o700
    folder.chmod(0o777)
    assert simulation_cache.read(KEY) is None and "other users" in simulation_cache.refusal()
    simulation_cache.write(NUMBERED[2], NUMBERS)
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
    simulation_cache.write(KEY, NUMBERS)
    assert list(folder.iterdir()) == []


def test_an_entry_damaged_anywhere_is_as_none(entry, rng):
    whole = entry.read_bytes()
    for _ in range(300):
        start, length = rng.integers(len(whole)), rng.integers(0, 40)
        odd = rng.choice([b"", b"[" * 3000, b"1e999", b"null", b"\x00", b"9" * 5000, bytes(rng.bytes(10))])
        entry.write_bytes(whole[:start] + odd + whole[start + length :])
        read = simulation_cache.read(KEY)
        assert read is None or (read["p"] == NUMBERS["p"]).all()


def held(value):
    """An array as an entry holds it; what is no array nor list stays as it is."""
    if not isinstance(value, np.ndarray | list):
        return value
    value = np.array(value)
    kind = "float" if value.dtype.kind == "f" else "int"
    return {"kind": kind, "shape": list(value.shape), "data": base64.b64encode(value.tobytes()).decode()}


WRONG = {
    "plate": ([1.0, 1.0, 1.0], [np.nan, 0.0, 0.0], [5.0, 0.0, 0.0], [-0.5, 1.0, 0.5], [0.5, 0.5], [1, 0, 0]),
    "start": ([2.0, 0.0, 0.0],), "error": ([np.inf, 0.0, 0.0],), "counts": (np.full((3, 3), -1),),
    "times": ([-1.0, 0.0, 0.0],), "changing": ([0, 0, 0],), "course": (np.zeros((0, 3)),),
    "velocity": ([np.inf, 0.0, 0.0],), "parts": (np.array(0), np.array(41), np.array(-40)),
    "lost": (np.array(1),), "seconds": (np.array(1e300),),
    "limit": (
        [0.1, 0.1, 7.0], {"kind": "object", "shape": [3], "data": ""}, None,
        {"kind": "float", "shape": [10**30, 0], "data": ""}, {"kind": "float", "shape": [3], "data": "?"},
    ),
}  # fmt: skip


def test_an_entry_of_numbers_that_cannot_be_is_as_none(feed, folder):
    """Its digest is made right again: whoever writes the entry can do so."""
    first, _ = feed()
    (path,) = folder.iterdir()
    whole = json.loads(path.read_bytes())
    cases = [(name, wrong) for name, values in WRONG.items() for wrong in values]
    for count, (name, wrong) in enumerate(cases, start=2):
        arrays = whole["arrays"] | {name: held(wrong)}
        line = json.dumps([whole["key"], arrays], sort_keys=True).encode()
        path.write_text(json.dumps(whole | {"arrays": arrays, "sha256": hashlib.sha256(line).hexdigest()}))
        p, simulated = feed()
        assert simulated == count, (name, wrong)
        np.testing.assert_array_equal(first, p)
