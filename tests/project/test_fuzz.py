"""Damaged files end in one line each: no traceback, no hang, no half-written output."""

import os
import time
from types import SimpleNamespace

import pytest
from fuzz import __main__ as runs
from fuzz import harness, mutate, readers

COUNTS = {
    "stl": 15,
    "bowl": 25,
    "card": 30,
    "counts": 30,
    "names": 12,
    "list": 80,
    "batch": 3,
    "dxf": 40,
}


@pytest.mark.parametrize("kind", list(harness.PLAN))
def test_damaged_files_give_a_line_and_never_a_traceback(kind):
    faults = harness.run(harness.Case(kind, seed) for seed in range(COUNTS[kind]))
    assert faults == []


def test_a_corner_beyond_any_bowl_is_one_line():
    """Found by a part, a bowl and options damaged together: its square overflowed."""
    assert harness.run([harness.Case(harness.TOGETHER, 1856)]) == []


def test_a_bowl_file_with_a_name_that_no_disk_can_hold_is_one_line():
    """Found in the config column of a list: asking whether it is a folder or a stream was refused."""
    assert harness.run([harness.Case("list", 1795355655052)]) == []


def test_an_attitude_beyond_all_numbers_is_one_line():
    """Found in a file of launches: the square of 1e308 overflowed."""
    assert harness.run([harness.Case("read launches", 1163)]) == []


@pytest.mark.parametrize("kind", list(readers.READERS))
def test_readers_take_damaged_files(kind):
    assert harness.run(harness.Case(kind, seed) for seed in range(60)) == []


def test_a_case_is_made_again_from_its_seed():
    for kind in harness.KINDS:
        assert harness.Case(kind, 7).build() == harness.Case(kind, 7).build()


@pytest.mark.parametrize("damage", mutate.BYTES + mutate.LINES + mutate.FACETS, ids=lambda f: f.__name__)
def test_every_kind_of_damage_changes_something(damage, rng):
    whole = (harness.ROOT / "parts/squarenut_m5.stl").read_bytes()
    text = (harness.ROOT / "configs/bowl.yaml").read_bytes()
    seed = whole if damage in mutate.FACETS else text
    assert any(damage(seed, text[::-1], rng) != seed for _ in range(20))


@pytest.mark.parametrize(("busy", "told"), [(True, "done"), (False, "no answer in 0.01 s")])
def test_a_process_that_computes_slowly_is_waited_for_and_one_that_stands_still_is_not(
    busy, told, monkeypatch
):
    """At nice 19 on a busy machine 3 of 50 cases had no answer in a minute; each has one in 2 s."""
    monkeypatch.setattr(harness, "STUCK", 0.01)
    ticks = iter(range(100)) if busy else iter([7] * 100)
    monkeypatch.setattr(harness, "_computed", lambda _: next(ticks))
    polls = iter([False, False, False, True])
    line = SimpleNamespace(poll=lambda _: next(polls), recv=lambda: "done")
    assert harness.answer(1, line) == told


def test_the_time_that_a_process_has_computed_grows_with_what_it_does():
    before = harness._computed(os.getpid())
    if before is None:
        pytest.skip("nobody says it here")
    end = time.process_time() + 0.05
    while time.process_time() < end:
        pass
    assert harness._computed(os.getpid()) > before


def test_each_run_goes_on_behind_the_last(tmp_path):
    kept = tmp_path / "runs.csv"
    assert runs.next_seeds(kept)[1] == 0
    for _ in range(2):
        first, _ = runs.next_seeds(kept)
        runs.keep(kept, first, dict.fromkeys(harness.KINDS, 50), {kind: [] for kind in harness.KINDS})
    first, count = runs.next_seeds(kept)
    assert set(first.values()) == {100}
    assert count == 100 * len(harness.KINDS)
