"""The one way to compiled code: it gives what its source does, wherever it is kept."""

import numpy as np

from feederscrew.geometry import compiled as door


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
