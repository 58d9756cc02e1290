"""The kernels are compiled by our passes, and by numba's own where those are untried: the same answers."""

import numpy as np
import pytest

from feederscrew.geometry import compiled as door

ANY, NONE = ((0, 0), (99, 0)), ((0, 0), (0, 0))  # versions of numba


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


@pytest.mark.parametrize(("tried", "name"), [(ANY, "ours"), (NONE, "its_own")])
def test_a_kernel_gives_the_same_by_either_compiler(tried, name, monkeypatch):
    monkeypatch.setattr(door, "TRIED", tried)
    monkeypatch.setattr(door, "_fingerprint", lambda: name)
    numbers, out, plain = np.linspace(0.5, 2.0, 7), np.empty(7), np.empty(7)
    both = kernel()
    both(numbers, out)
    both.py_func(numbers, plain)
    assert np.array_equal(out, plain)
    assert (tried == ANY) == both._compiler.pipeline_class.__module__.startswith("feederscrew")


def test_a_kernel_runs_where_no_folder_can_be_written(monkeypatch):
    """It raised a RuntimeError where neither the sources' folder nor the user's own takes a file."""
    from numba.core import caching

    door._can_keep.cache_clear()
    monkeypatch.setattr(caching.CacheImpl, "_locator_classes", [])
    monkeypatch.setattr(door, "_fingerprint", lambda: "nowhere")
    try:
        numbers, out, plain = np.linspace(0.5, 2.0, 7), np.empty(7), np.empty(7)
        both = kernel()
        both(numbers, out)
        both.py_func(numbers, plain)
        assert np.array_equal(out, plain)
        assert not door.on_disk(both)
    finally:
        door._can_keep.cache_clear()
