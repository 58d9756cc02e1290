"""How far a design is: a bar of its stages on a terminal, now and then a line elsewhere."""

import io

import pytest

from feederscrew_cli import progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def now(monkeypatch):
    """A clock that is set by hand."""
    clock = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: clock[0])
    return clock


def test_a_bar_of_the_stage_and_the_time_to_go(monkeypatch, now):
    screen = Terminal()
    monkeypatch.setattr(progress.sys, "stderr", screen)
    shown = progress.StageBar()
    shown.reach("draws", 5, 20, 30.0, 90.0)
    bar = screen.getvalue()
    assert "draws: 5 of 20" in bar and "30 s gone, about 90 s to go" in bar and "\n" not in bar
    assert bar.count("#") == round(progress.StageBar.WIDTH / 4)
    shown.clear()
    assert screen.getvalue().endswith("\r\033[K")
    before = screen.getvalue()
    shown.end()
    assert screen.getvalue() == before


def test_a_line_now_and_then_where_stderr_is_a_file(monkeypatch, now):
    file = io.StringIO()
    monkeypatch.setattr(progress.sys, "stderr", file)
    shown = progress.StageBar()
    for second in range(0, 41, 4):
        now[0] = float(second)
        shown.reach("queue", second, 60, float(second), 60.0 - second)
    lines = file.getvalue().splitlines()
    assert lines == ["queue: 27 % after 16 s, about 44 s to go", "queue: 53 % after 32 s, about 28 s to go"]
    shown.clear()  # a line was printed: the next one has time
    now[0] = 50.0
    shown.reach("trial", 2, 16, 50.0, 10.0)
    assert len(file.getvalue().splitlines()) == 2
    quiet = progress.StageBar(False)
    now[0] = 500.0
    quiet.reach("trial", 2, 16, 50.0, 10.0)
    assert len(file.getvalue().splitlines()) == 2
