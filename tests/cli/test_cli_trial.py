"""``feeder trial`` from the command line."""

import json
from pathlib import Path

import pytest
import shapes
from command_lines import names, rows

from feederscrew.trials import runs

BOWL = """\
drive: {amplitude: 0.15 mm, frequency: 60 Hz, vibration_angle: 20 deg}
friction: {static: 0.4}
track: {radius: 2 m, width: 60 mm, climb: 2 deg, bank: 0 deg}
devices:
  - narrowed_track: 8 mm
"""
CONTRACT = set("velocity_mm_s parts_per_minute efficiency purity jams engine warnings orientations".split())
ROW = "aspect heading_deg length_mm tried passed passed_low passed_high returned hanging stuck predicted"
CALL = ("trial", "block.stl", "--aspect", "A", "--config", "bowl.yaml", "--jobs", "1")
FOLDER = Path("out/block")


@pytest.fixture
def block(tmp_path):
    shapes.box(20, 12, 5).export(tmp_path / "block.stl")
    (tmp_path / "bowl.yaml").write_text(BOWL)


def test_the_document_keeps_its_contract(run, block):
    Path("counts.csv").write_text("aspect,MDFT_80\nA,0.9\nB,0.1\nC,0\n")
    result = run(
        *CALL, "--parts", "4", "--queue", "3", "--seconds", "0.5", "--launch", "place", "--landing", "6",
        "--with", "counts.csv", "--format", "json",
    )  # fmt: skip
    assert result.exit_code == 0
    document = json.loads(result.stdout)
    tried, queue, fell = document["orientations"], document["queue"], document["landing"]
    assert set(document) >= CONTRACT and all(set(row) >= set(ROW.split()) for row in tried)
    verdicts = [(row["passed"], row["returned"], row["predicted"]) for row in tried]
    assert verdicts == [(2, 0, "passes"), (0, 2, "returned")]
    assert (queue["parts"], queue["seconds"], queue["jams"]) == (3, 0.5, document["jams"])
    measured = [(row["aspect"], row["measured MDFT_80"]) for row in queue["outlet"]]
    assert measured == [("A", 0.9), ("B", 0.1), ("C", 0.0)]
    assert [row["offered"] for row in queue["outlet"]] == pytest.approx([1.0, 0.0, 0.0])
    assert "no part has left the queue yet: there is nothing to set beside" in result.stderr
    assert fell["parts"] == 6 == fell["lost"] + sum(row["landed"] for row in fell["aspects"])
    assert f"{fell['lost']} went over its edge" in result.stderr
    assert document["launch"] == fell["launch"] == "place" and document["answer"].endswith("launch place")
    assert 0.0 <= document["largest_penetration_mm"] < 1.0 and 0.0 <= document["energy_won_um"] < 1.0


def test_files_and_amplitudes(run, block):
    result = run(*CALL, "--parts", "2", "--amplitude", "90%,100%", "--format", "csv", "-o", "out")
    assert result.exit_code == 0
    amplitudes = [row["amplitude_mm"] for row in rows(result.stdout)]
    assert amplitudes == ["0.135", "0.135", "0.15", "0.15"]
    pictures = {"trial.png", "trial_paths.png", "trial_stills.png"}
    assert names(FOLDER) == pictures | {"trial.csv", "trial_stations.csv", "trial.json", "run.json"}
    assert "the tooling sorts up to an amplitude of 0.15 mm" in result.stderr


@pytest.mark.parametrize("number", [3, 1])
def test_an_interrupt_prints_and_writes_what_is_there(run, block, monkeypatch, number):
    """Ctrl-C as this part comes to the bare track; before anything is done it leaves nothing."""
    past, stations, begun = runs.make_follower, [], []

    def past_until(*args, **own):
        stations.append(past(*args, **own))

        def follow_until(states, times):
            begun.extend(times)
            if len(begun) >= number:
                raise KeyboardInterrupt
            return stations[0](states, times)

        return follow_until if len(stations) == 1 else stations[-1]

    monkeypatch.setattr(runs, "make_follower", past_until)
    result = run(*CALL, "--parts", "6", "--no-pictures", "-o", "out")
    if number == 1:
        assert result.exit_code == 130 and result.stderr.strip().endswith("Stopped.")
        assert not FOLDER.exists()
        return
    assert result.exit_code == 0 and "Warning: partial: stopped after 2 parts" in result.stderr
    document = json.loads((FOLDER / "trial.json").read_text())
    assert document["partial"] and sum(row["tried"] for row in document["orientations"]) == 2
