"""Damaged files end in one line each: no traceback, no hang, no half-written output."""

import pytest
from fuzz import __main__ as runs
from fuzz import harness, mutate, readers

COUNTS = {
    "stl": 25,
    "bowl": 50,
    "card": 60,
    "counts": 50,
    "names": 20,
    "list": 120,
    "batch": 4,
    "dxf": 60,
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
    assert harness.run(harness.Case(kind, seed) for seed in range(100)) == []


def test_a_case_is_made_again_from_its_seed():
    for kind in harness.KINDS:
        assert harness.Case(kind, 7).build() == harness.Case(kind, 7).build()


@pytest.mark.parametrize("damage", mutate.BYTES + mutate.LINES + mutate.FACETS, ids=lambda f: f.__name__)
def test_every_kind_of_damage_changes_something(damage, rng):
    whole = (harness.ROOT / "parts/squarenut_m5.stl").read_bytes()
    text = (harness.ROOT / "configs/bowl.yaml").read_bytes()
    seed = whole if damage in mutate.FACETS else text
    assert any(damage(seed, text[::-1], rng) != seed for _ in range(20))


def test_each_run_goes_on_behind_the_last(tmp_path):
    kept = tmp_path / "runs.csv"
    assert runs.next_seeds(kept)[1] == 0
    for _ in range(2):
        first, _ = runs.next_seeds(kept)
        runs.keep(kept, first, dict.fromkeys(harness.KINDS, 50), {kind: [] for kind in harness.KINDS})
    first, count = runs.next_seeds(kept)
    assert set(first.values()) == {100}
    assert count == 100 * len(harness.KINDS)
