"""A study over ranges: the rows of the study at each combination, whatever the cores."""

import threading

import pandas as pd
import pytest
from command_lines import PARTS

import feederscrew as fs

BOWL = fs.read_bowl()


def test_a_row_is_that_of_the_study_at_its_values_on_one_core_and_on_two():
    ranges = {"amplitude": ["0.1 mm", 3e-4], "frequency": ["50 Hz", "60 Hz", 70.0]}
    frame = fs.sweep(fs.convey, BOWL, **ranges, climb="2 deg", jobs=2)
    assert frame.columns[:2].tolist() == ["amplitude_mm", "frequency_Hz"] and len(frame) == 6
    assert frame["amplitude_mm"].tolist() == pytest.approx([0.1] * 3 + [0.3] * 3)
    assert frame["frequency_Hz"].tolist() == pytest.approx([50.0, 60.0, 70.0] * 2)
    there = fs.convey(BOWL.with_values(amplitude="0.3 mm", frequency="60 Hz", climb="2 deg"))
    assert frame["velocity_mm_s"][4] == pytest.approx(1e3 * there.answer.velocity, rel=1e-12)
    pd.testing.assert_frame_equal(frame, fs.sweep(fs.convey, BOWL, **ranges, climb="2 deg", jobs=1))
    told, done = [], threading.Thread(target=threading.Event().wait, daemon=True)
    done.start()  # beside a thread no process is forked
    fs.sweep(fs.convey, BOWL, **ranges, jobs=2, progress=lambda *state: told.append(state))
    assert told == [(k, 6) for k in range(1, 7)]


def test_keywords_of_the_study_are_swept_as_well():
    part = fs.load(PARTS / "lbracket_30x20x15.stl")
    frame = fs.sweep(fs.rate, part, BOWL, aspect=["A", "B"], rule="csa", static=[0.4, 0.5], jobs=1)
    assert frame["aspect"].tolist() == ["A", "A", "B", "B"] and "rule" not in frame.columns[:2]
    assert frame["static"].tolist() == [0.4, 0.5] * 2
    rates = [
        60.0 * fs.rate(part, BOWL.with_values(static=mu), "B", rule="csa").parts.value for mu in (0.4, 0.5)
    ]
    assert frame["parts_per_minute"][2:].tolist() == pytest.approx(rates, rel=1e-12)
    rows = fs.sweep(fs.slide, BOWL, climb=["1 deg", "2 deg"], angles=[["25 deg"]], table="slide", jobs=1)
    assert set(rows["climb_deg"]) == {1.0, 2.0} and len(rows) > 100


WRONG = {
    "amplitude: '2 s' is a time": lambda: fs.sweep(fs.convey, BOWL, amplitude=["1 mm", "2 s"]),
    "climb: is an empty list": lambda: fs.sweep(fs.convey, BOWL, climb=[]),
    "climb: is a key of a bowl, and no bowl is given": lambda: fs.sweep(fs.convey, climb=["1 deg"]),
    "climb: gives 200000 combinations": lambda: fs.sweep(fs.convey, BOWL, climb=[0.0] * 200_000),
    "function: returns a dict": lambda: fs.sweep(lambda bowl: {}, BOWL, climb=["1 deg"], jobs=1),
}


@pytest.mark.parametrize("line", WRONG)
def test_what_cannot_be_swept_is_a_line(line):
    with pytest.raises(fs.FeederError, match=line):
        WRONG[line]()


def test_an_unknown_keyword_is_answered_with_what_is_near():
    with pytest.raises(TypeError, match="did you mean 'amplitude'"):
        fs.sweep(fs.convey, BOWL, amplitud=["1 mm"])
