"""``feeder trial`` from the command line."""

import csv
import io
import json

import pytest
import shapes

BOWL = """\
drive: {amplitude: 0.15 mm, frequency: 60 Hz, vibration_angle: 20 deg}
friction: {static: 0.4}
track: {radius: 2 m, width: 60 mm, climb: 2 deg, bank: 0 deg}
devices:
  - narrowed_track: 8 mm
"""
CONTRACT = {
    *("velocity_mm_s", "parts_per_minute", "efficiency", "purity", "jams", "engine", "warnings"),
    "orientations",
}
ROW = {
    *("aspect", "heading_deg", "length_mm", "tried", "passed", "passed_low", "passed_high", "returned"),
    *("hanging", "stuck", "predicted", "margin_mm"),
}


@pytest.fixture
def block(tmp_path):
    path = tmp_path / "block.stl"
    shapes.box(20, 12, 5).export(path)
    (tmp_path / "bowl.yaml").write_text(BOWL)
    return path, tmp_path / "bowl.yaml"


def test_the_document_keeps_its_contract(run, block):
    part, bowl = block
    counts = part.parent / "counts.csv"
    counts.write_text("aspect,MDFT_80\nA,0.9\nB,0.1\nC,0\n")
    result = run(
        "trial", part, "--aspect", "A", "--config", bowl, "--parts", "4", "--queue", "3", "--seconds", "0.5",
        "--launch", "place", "--landing", "6", "--with", counts, "--format", "json",
    )  # fmt: skip
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert set(found) >= CONTRACT
    assert all(set(one) >= ROW for one in found["orientations"])
    assert [(one["passed"], one["returned"], one["predicted"]) for one in found["orientations"]] == [
        (2, 0, "passes"), (0, 2, "returned"),
    ]  # fmt: skip
    assert found["queue"]["parts"] == 3 and found["queue"]["seconds"] == 0.5
    assert found["jams"] == found["queue"]["jams"]
    seen = found["queue"]["outlet"]
    assert [(one["aspect"], one["measured MDFT_80"]) for one in seen] == [("A", 0.9), ("B", 0.1), ("C", 0.0)]
    assert [one["offered"] for one in seen] == pytest.approx([1.0, 0.0, 0.0])
    assert "no part has left the queue yet: there is nothing to set beside" in result.stderr
    fell = found["landing"]
    assert fell["parts"] == 6 == fell["lost"] + sum(one["landed"] for one in fell["aspects"])
    assert fell["launch"] == "place" and f"{fell['lost']} went over its edge" in result.stderr
    assert found["launch"] == "place" and found["answer"].endswith("launch place")
    assert 0.0 <= found["largest_penetration_mm"] < 1.0 and 0.0 <= found["energy_won_um"] < 1.0
    worst = max(one["penetration_mm"] for one in found["orientations"])
    assert worst == pytest.approx(found["largest_penetration_mm"])


def test_files_and_amplitudes(run, block, tmp_path):
    part, bowl = block
    result = run(
        "trial", part, "--aspect", "A", "--config", bowl, "--parts", "2", "--amplitude", "90%,100%",
        "--format", "csv", "-o", tmp_path / "out",
    )  # fmt: skip
    assert result.exit_code == 0
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert [row["amplitude_mm"] for row in rows] == ["0.135", "0.135", "0.15", "0.15"]
    folder = tmp_path / "out" / "block"
    names = {"trial.csv", "trial_stations.csv", "trial.json", "trial.png", "trial_paths.png"}
    assert {path.name for path in folder.iterdir()} == names | {"trial_stills.png", "run.json"}
    assert "the tooling sorts up to an amplitude of 0.15 mm" in result.stderr
    assert json.loads((folder / "trial.json").read_text())["highest_amplitude_mm"] == pytest.approx(0.15)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--poured"], "--poured is for a queue - give --queue N as well"),
        (["--with", "counts.csv"], "--with is for a queue - give --queue N as well"),
        (["--aspect", "Q"], "there is no aspect 'Q' - choose one of"),
        (["--rule", "nothing"], "--rule: unknown rule 'nothing' - "),
        (["--amplitude", "9 m"], "--amplitude: drive.amplitude: '9 m' is out of range - give 0 mm to 20 mm"),
    ],
)
def test_faults_are_one_line(run, block, given, said):
    result = run("trial", block[0], "--config", block[1], *given)
    assert result.exit_code == 2 and said in result.stderr and "Traceback" not in result.stderr


def interrupted_at(monkeypatch, number):
    """Stop the trial as this part comes to the bare track."""
    from feederscrew.trial import runs

    past, stations, begun = runs.past_sensor, [], []

    def past_until(*given, **own):
        follow = past(*given, **own)
        stations.append(follow)
        if len(stations) > 1:
            return follow

        def follow_until(states, times):
            begun.extend(times)
            if len(begun) >= number:
                raise KeyboardInterrupt
            return follow(states, times)

        return follow_until

    monkeypatch.setattr(runs, "past_sensor", past_until)


def test_an_interrupt_prints_and_writes_what_is_there(run, block, tmp_path, monkeypatch):
    interrupted_at(monkeypatch, 3)
    own = ("--aspect", "A", "--config", block[1], "--parts", "6", "--jobs", "1", "--no-pictures")
    own += ("-o", tmp_path / "out")
    result = run("trial", block[0], *own)
    assert result.exit_code == 0 and "Warning: partial: stopped after 2 parts" in result.stderr
    found = json.loads((tmp_path / "out" / "block" / "trial.json").read_text())
    assert found["partial"] and sum(one["tried"] for one in found["orientations"]) == 2


def test_an_interrupt_before_anything_is_done_leaves_nothing(run, block, tmp_path, monkeypatch):
    interrupted_at(monkeypatch, 1)
    result = run("trial", block[0], "--config", block[1], "--jobs", "1", "-o", tmp_path / "out")
    assert result.exit_code == 130 and result.stderr.strip().endswith("Stopped.")
    assert not (tmp_path / "out").exists()
