"""``feeder calibrate``: its answer, its files, its errors."""

import json

import pytest
import shapes


@pytest.fixture
def stl(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(10.0, 13.0, 17.0).export(path)
    return path


def counts(tmp_path, text):
    path = tmp_path / "counts.csv"
    path.write_text(text)
    return path


def test_counts_give_their_exponent_back(run, stl, tmp_path):
    from feederscrew.part import load
    from feederscrew.resting.aspects import find
    from feederscrew.resting.exact_tumbling import exact, require_ground

    part = load(stl)
    aspects = find(part)
    p = exact(require_ground(part, aspects), part, aspects, exponent=1.3).probabilities["surface"]
    lines = [f"{name},{round(20000 * share)}" for name, share in zip(aspects.names, p)]
    done = run(
        "calibrate",
        stl,
        "--with",
        counts(tmp_path, "\n".join(["aspect,tray", *lines])),
        "--format",
        "json",
        "-o",
        "r",
    )
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    (row,) = told["calibrations"]
    assert (
        row["exponent"] == pytest.approx(1.3, abs=0.01) and row["exponent_low"] < 1.3 < row["exponent_high"]
    )
    assert row["p_value"] > 0.9 and row["degrees_of_freedom"] == 1
    assert told["p_surface"]["tray"] == pytest.approx(dict(zip(aspects.names, p)), abs=1e-3)
    assert {path.name for path in (tmp_path / "r/box").iterdir()} == {
        "calibrate.csv",
        "calibrate.json",
        "run.json",
    }


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "aspect,tray\nA,0.5\nB,0.3\nC,0.2\n",
            "has no column of counts - give whole numbers of parts, not shares",
        ),
        ("aspect,tray\nA,5\nB,3\nQ,2\n", "Q"),
    ],
)
def test_faults_are_told(run, stl, tmp_path, text, words):
    done = run("calibrate", stl, "--with", counts(tmp_path, text))
    assert done.exit_code == 1 and words in done.stderr and done.stdout == ""
