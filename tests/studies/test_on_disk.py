"""What was simulated is taken again by a later run, if nothing of it has changed."""

from collections import OrderedDict

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.dropping.plate import arrival
from feederscrew.studies.rate import shares
from feederscrew.studies.simulated import memory, on_disk

PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.read(None, ())


@pytest.fixture
def runs(tmp_path, monkeypatch):
    """Each call is a run of its own: it tells the shares, and how often was simulated so far."""
    monkeypatch.setenv(on_disk.VARIABLE, str(tmp_path / "kept"))
    made, simulate = [], arrival.arrival
    monkeypatch.setattr(arrival, "arrival", lambda *args, **own: made.append(1) or simulate(*args, **own))

    def run(part=PART, bowl=BOWL, **own):
        monkeypatch.setattr(memory, "_MADE", OrderedDict())
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


def test_other_code_does_not_find_it(runs, monkeypatch):
    runs()
    monkeypatch.setattr(on_disk, "_code", lambda: b"another edition")
    assert runs()[1] == 2


@pytest.mark.parametrize("damaged", [lambda told: told[:-3], lambda told: told[:-1] + b"?", lambda told: b""])
def test_a_damaged_file_is_made_again(runs, damaged):
    first, _ = runs()
    (file,) = runs.folder.iterdir()
    file.write_bytes(damaged(file.read_bytes()))
    found, count = runs()
    assert count == 2
    np.testing.assert_array_equal(first.recommended.p, found.recommended.p)
    assert runs()[1] == 2


def test_without_a_place_to_write_all_goes_on(runs, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    for place in ("", str(tmp_path / "file" / "below")):
        monkeypatch.setenv(on_disk.VARIABLE, place)
        before = runs()[1]
        assert runs()[1] == before + 1


def test_the_oldest_go_and_what_is_kept_cannot_be_changed(monkeypatch, tmp_path):
    monkeypatch.setenv(on_disk.VARIABLE, str(tmp_path))
    monkeypatch.setattr(on_disk, "MOST", 3)
    (tmp_path / "mine.txt").write_text("older than all")
    for k in range(5):
        on_disk.write(bytes([k]), np.arange(3.0))
    assert len(list(tmp_path.iterdir())) == 4 and (tmp_path / "mine.txt").exists()
    found = on_disk.read(bytes([4]))
    with pytest.raises(ValueError, match="read-only"):
        found[0] = 1.0
    monkeypatch.setattr(on_disk, "LARGEST", 10)
    on_disk.write(b"large", np.arange(3.0))
    assert on_disk.read(b"large") is None
