"""``feeder track``: the contract of its JSON, its maps and pictures, its faults."""

import csv
import json
from pathlib import Path

import pytest
import shapes

PARTS = Path(__file__).parents[3] / "parts"
BRACKET, CARD, MAGNET = PARTS / "lbracket_30x20x15.stl", PARTS / "arc_chute.yaml", PARTS / "magnet.yaml"
DOWEL = PARTS / "dowel_6x20.stl"
INSTANT = (
    "normal_force_N", "wall_1_N", "wall_2_N", "radial_friction_N", "traction_N",
    "normal_line_offset_mm", "acceleration_x_m_s2", "tips",
)  # fmt: skip
SETS = (
    "--set", "drive.amplitude=0.05 mm", "--set", "drive.vibration_angle=20 deg",
    "--set", "track.bank=10 deg", "--set", "friction.static=0.4",
)  # fmt: skip


def document(run, *arguments):
    result = run("track", *arguments, "--format", "json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_contract(run):
    found = document(run, BRACKET, "--aspect", "A", *SETS)
    assert set(INSTANT) <= set(found["instant"])
    assert found["first_to_open"] in ("floor", "wall_1", "wall_2", "none")
    assert set(found["tipping_axis"]) == {"point_mm", "direction", "pitch_mm"}
    assert set(found["friction_needed"]) == {"floor", "wall_1", "wall_2"}
    assert found["stays_on_wall"] is True
    assert {len(column) for column in found["cycle"].values()} == {72}
    assert min(found["cycle"]["wall_1_N"]) >= 0.0


def test_laid_at_a_heading_it_settles_in_that_range(run):
    headings = [
        document(run, BRACKET, "--aspect", "A", *SETS, "--heading", laid)["heading_deg"]
        for laid in ("10deg", "170deg")
    ]
    assert headings == pytest.approx([2.1345, 177.8655], abs=1e-3)


def test_map_over_any_two_keys(run):
    spans = ("--vary", "track.bank=0:20:3", "--vary", "friction.static=0.2:0.6:2")
    result = run("track", BRACKET, *SETS, *spans, "--format", "csv")
    rows = list(csv.DictReader(result.stdout.splitlines()))
    assert len(rows) == 6
    assert list(rows[0])[:2] == ["bank_deg", "static"]
    one = document(run, BRACKET, *SETS, "--set", "friction.static=0.6", "--set", "track.bank=20 deg")
    assert float(rows[-1]["normal_force_N"]) == pytest.approx(one["instant"]["normal_force_N"], rel=1e-5)


def test_files(run, tmp_path):
    result = run("track", BRACKET, *SETS, "-o", "out")
    assert result.exit_code == 0, result.output
    names = {p.name for p in (tmp_path / "out/lbracket_30x20x15").iterdir()}
    assert names == {
        "track.json", "track_cycle.csv", "track_cycle.png", "track_map.csv", "track_map.png",
        "track_part.png", "run.json",
    }  # fmt: skip


def test_one_verdict_stands_beside_the_velocity(run):
    """'tips: yes', 'opens at 0 times the drive' and 'nothing slides anywhere' stood beside 19.3 mm/s."""
    result = run("track", DOWEL, "--aspect", "B", "-o", "out", "--no-pictures")
    assert result.exit_code == 0
    rows = dict(line.rsplit("  ", 1) for line in result.stdout.splitlines())
    assert rows[f"{'on the track, over the strokes':62}"] == "turns over, goes back into the bowl"
    assert "carries nothing even at rest" in result.stdout
    assert "tips" not in result.stdout and "opens at" not in result.stdout
    assert "has its line of action outside the contact in" in result.stderr
    assert "nothing slides anywhere" not in result.stderr


def test_a_turned_and_moved_file_changes_nothing(run, tmp_path, rng):
    mesh = shapes.prism([(0, 0), (30, 0), (30, 5), (12, 5), (5, 14), (0, 14)], 7.0)
    mesh.export(tmp_path / "straight.stl")
    shapes.turned(mesh, rng).export(tmp_path / "turned.stl")
    first, second = (document(run, name, "--aspect", "A", *SETS) for name in ("straight.stl", "turned.stl"))
    for name in INSTANT[:-1]:
        assert second["instant"][name] == pytest.approx(first["instant"][name], rel=1e-3, abs=1e-7), name
    assert second["heading_deg"] == pytest.approx(first["heading_deg"], abs=1e-3)
    assert second["first_to_open"] == first["first_to_open"]


@pytest.mark.parametrize(
    ("sets", "line"),
    [
        (
            ("--set", "track.width=12 mm", "--heading", "270deg"),
            "Error: aspect A, heading 270 deg: the part needs 30.19 mm of track and falls off - "
            "give a wider track, or another heading",
        ),
    ],
)
def test_faults_are_one_line_and_leave_nothing(run, tmp_path, sets, line):
    result = run("track", BRACKET, "--aspect", "A", *sets, "-o", "out")
    assert result.exit_code == 1
    assert result.stderr.splitlines()[-1] == line
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("card", "aspect"), [(CARD, "5"), (MAGNET, "3")])
def test_a_card_gives_the_same_under_another_name(run, tmp_path, card, aspect):
    copy = tmp_path / "another.yaml"
    copy.write_bytes(card.read_bytes())
    printed = ("--aspect", aspect, "--as-published", *SETS)
    first, second = (document(run, path, *printed) for path in (card, copy))
    assert first["instant"] == second["instant"]
    other = {"tilted": "level", "level": "tilted"}
    text = card.read_text()
    (axes,) = (word for word in other if f"axes: {word}" in text)
    copy.write_text(text.replace(f"axes: {axes}", f"axes: {other[axes]}"))
    assert document(run, copy, *printed)["instant"] != first["instant"]
