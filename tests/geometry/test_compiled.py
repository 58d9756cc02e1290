"""The one way to compiled code: it gives what its source does, wherever it is kept."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from feederscrew.geometry import compiled as door
from feederscrew.geometry.object_code import ObjectCode


def kernel():
    """A new entry that calls one part in two places; both make an array."""

    def swing(x, y):
        made = np.array([x, y])
        return made[0] / (1.0 + x * x) + made[1]

    def filled(numbers, out):
        made = np.empty(len(numbers))
        for k in range(len(numbers)):
            made[k] = swing(numbers[k], 0.1) if numbers[k] > 1.0 else swing(numbers[k], -0.1)
            out[k] = made[k] / 3.0

    door.compiled(swing, arrays=True)
    return door.entry(filled, arrays=True)


def test_a_kernel_gives_what_its_source_does(monkeypatch):
    monkeypatch.setattr(door, "_fingerprint", lambda module: "own")
    numbers, out, plain = np.linspace(0.5, 2.0, 7), np.empty(7), np.empty(7)
    both = kernel()
    both(numbers, out)
    both.py_func(numbers, plain)
    assert np.array_equal(out, plain)


def test_a_kernel_runs_where_no_folder_can_be_written(monkeypatch):
    """It raised a RuntimeError where neither the sources' folder nor the user's own takes a file."""
    from numba.core import caching

    door._can_keep.cache_clear()
    monkeypatch.setattr(caching.CacheImpl, "_locator_classes", [])
    monkeypatch.setattr(door, "_fingerprint", lambda module: "nowhere")
    try:
        numbers, out, plain = np.linspace(0.5, 2.0, 7), np.empty(7), np.empty(7)
        both = kernel()
        both(numbers, out)
        both.py_func(numbers, plain)
        assert np.array_equal(out, plain)
        assert not door.on_disk(both)
    finally:
        door._can_keep.cache_clear()


def spun(turns, out):
    """The sum of sines of each number, and of a flag."""
    for k in range(len(turns.angles)):
        out[k] = math.sin(turns.angles[k]) * turns.scale + (1.0 if turns.raised else turns.count)


class Turns(NamedTuple):
    """What an entry is handed."""

    angles: np.ndarray
    scale: float
    count: int
    raised: bool


def test_object_code_gives_what_numba_gives_and_is_not_read_once_it_is_damaged(tmp_path, monkeypatch):
    monkeypatch.setattr(door, "_can_keep", lambda: False)  # of what numba kept it cannot say the text
    numbers, plain = np.linspace(-2.0, 2.0, 9), np.empty(9)
    called = []

    def outcome(turns, numba_does):
        fresh = ObjectCode(spun, lambda: door.entry(spun), tmp_path, "own")
        numba = fresh.dispatcher
        called.clear()
        fresh.dispatcher = lambda: called.append(1) or numba()
        out = np.empty(9)
        fresh(turns, out)
        assert bool(called) is numba_does
        return out

    for count, turns in enumerate((Turns(numbers, 2.5, -3, False), Turns(numbers, -0.25, 4, True))):
        spun(turns, plain)
        assert np.array_equal(outcome(turns, numba_does=count == 0), plain)
    assert np.array_equal(outcome(turns, numba_does=False), plain)
    other = Turns(numbers.astype(np.float32), 2.5, 3, False)  # of another type: not that file
    assert outcome(other, numba_does=True) == pytest.approx(np.sin(numbers) * 2.5 + 3, abs=1e-6)
    for file in tmp_path.glob("*.o"):
        file.write_bytes(file.read_bytes()[:-40])
    assert np.array_equal(outcome(turns, numba_does=True), plain)
