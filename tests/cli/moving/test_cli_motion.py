"""``feeder floor``, ``track``, ``headings``, ``slide``: contracts of their JSON, maps, files and faults."""

import csv
import io
import json
import math
from pathlib import Path

import numpy as np
import pytest
import shapes

PARTS = Path(__file__).parents[3] / "parts"
BRACKET, CARD, MAGNET = PARTS / "lbracket_30x20x15.stl", PARTS / "arc_chute.yaml", PARTS / "magnet.yaml"
ON_FLOOR = {
    "normal_force_N", "alignment_acceleration_rad_s2", "stable_heading_deg", "limiting_friction",
    "acceleration_y_m_s2", "acceleration_z_m_s2", "normal_line_offset_mm", "tips",
}  # fmt: skip
ON_TRACK = (
    "normal_force_N", "wall_1_N", "wall_2_N", "radial_friction_N", "traction_N",
    "normal_line_offset_mm", "acceleration_x_m_s2", "tips",
)  # fmt: skip
GENTLE = ("--set", "drive.amplitude=0.05 mm", "--set", "drive.vibration_angle=20 deg")
SETS = (*GENTLE, "--set", "track.bank=10 deg", "--set", "friction.static=0.4")
COLUMNS = "beta_deg,alpha_minus_theta_deg,acceleration_ratio,mu_limit,mu_forward,mu_backward,regime"
MAPS = ("beta_friction", "frequency_amplitude", "heading")
FILES = {
    "floor": {f"floor_{kind}.{end}" for kind in MAPS for end in ("csv", "png")}
    | {"floor.json", "floor_cycle.csv", "floor_cycle.png", "floor_plan.png"},
    "track": {
        "track.json", "track_cycle.csv", "track_cycle.png", "track_map.csv", "track_map.png",
        "track_part.png",
    },
    "headings": {"headings.csv", "headings.json", "headings_A.png"},
}  # fmt: skip


def document(run, *arguments):
    result = run(*arguments, "--format", "json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@pytest.mark.parametrize("command", FILES)
def test_files(run, command):
    assert run(command, BRACKET, "--aspect", "A", *SETS, "-o", "out").exit_code == 0
    assert {path.name for path in Path("out", BRACKET.stem).iterdir()} == FILES[command] | {"run.json"}


def test_the_contract_of_the_floor(run):
    found = document(run, "floor", BRACKET, "--aspect", "A", "--heading", "30deg", *GENTLE)
    assert set(found["instant"]) >= ON_FLOOR and found["heading_deg"] == pytest.approx(30)
    assert found["regime"] in ("stick", "slide", "hop", "tip")
    assert {len(column) for column in found["cycle"].values()} == {72}
    assert set(found["cycle"]["state"]) <= {"stick", "slide", "hop", "tip"}


def test_as_published_names_the_omitted_terms(run):
    printed = ("--set", "drive.direction=10 deg", "--as-published")
    found = document(run, "floor", CARD, "--aspect", "5", *GENTLE, *printed)
    rows = {row["quantity"]: row for row in found["difference"]}
    assert rows["normal_force_N"]["omitted_term"] == "-"
    assert "a wall to take the force across" in rows["limiting_friction"]["omitted_term"]
    assert found["instant"]["normal_line_offset_mm"] == rows["normal_line_offset_mm"]["as_published"]


def test_the_contract_of_the_track(run):
    found = document(run, "track", BRACKET, "--aspect", "A", *SETS)
    assert set(ON_TRACK) <= set(found["instant"])
    assert found["first_to_open"] in ("floor", "wall_1", "wall_2", "none")
    assert set(found["tipping_axis"]) == {"point_mm", "direction", "pitch_mm"}
    assert set(found["friction_needed"]) == {"floor", "wall_1", "wall_2"} and found["stays_on_wall"] is True
    assert {len(column) for column in found["cycle"].values()} == {72}
    assert min(found["cycle"]["wall_1_N"]) >= 0.0


def test_laid_at_a_heading_it_settles_in_that_range(run):
    call = ("track", BRACKET, "--aspect", "A", *SETS, "--heading")
    headings = [document(run, *call, laid)["heading_deg"] for laid in ("10deg", "170deg")]
    assert headings == pytest.approx([2.1345, 177.8655], abs=1e-3)


def test_a_map_of_the_track_over_any_two_keys(run):
    spans = ("--vary", "track.bank=0:20:3", "--vary", "friction.static=0.2:0.6:2")
    rows = list(csv.DictReader(io.StringIO(run("track", BRACKET, *SETS, *spans, "--format", "csv").stdout)))
    assert len(rows) == 6 and list(rows[0])[:2] == ["bank_deg", "static"]
    sets = ("--set", "friction.static=0.6", "--set", "track.bank=20 deg")
    one = document(run, "track", BRACKET, *SETS, *sets)["instant"]["normal_force_N"]
    assert float(rows[-1]["normal_force_N"]) == pytest.approx(one, rel=1e-5)


def test_one_verdict_stands_beside_the_velocity(run):
    """'tips: yes', 'opens at 0 times the drive' and 'nothing slides anywhere' stood beside 19.3 mm/s."""
    result = run("track", PARTS / "dowel_6x20.stl", "--aspect", "B", "-o", "out", "--no-pictures")
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
    first, second = (
        document(run, "track", f"{n}.stl", "--aspect", "A", *SETS) for n in ("straight", "turned")
    )
    for name in ON_TRACK[:-1]:
        assert second["instant"][name] == pytest.approx(first["instant"][name], rel=1e-3, abs=1e-7), name
    assert second["heading_deg"] == pytest.approx(first["heading_deg"], abs=1e-3)
    assert second["first_to_open"] == first["first_to_open"]


def test_a_part_too_wide_for_the_track_is_one_line_and_leaves_nothing(run):
    sets = ("--set", "track.width=12 mm", "--heading", "270deg")
    result = run("track", BRACKET, "--aspect", "A", *sets, "-o", "out")
    line = "Error: aspect A, heading 270 deg: the part needs 30.19 mm of track and falls off - "
    assert result.exit_code == 1 and not Path("out").exists()
    assert result.stderr.splitlines()[-1] == f"{line}give a wider track, or another heading"


@pytest.mark.parametrize(("card", "aspect"), [(CARD, "5"), (MAGNET, "3")])
def test_a_card_gives_the_same_under_another_name(run, tmp_path, card, aspect):
    copy = tmp_path / "another.yaml"
    copy.write_bytes(card.read_bytes())
    printed = ("--aspect", aspect, "--as-published", *SETS)
    first, second = (document(run, "track", path, *printed)["instant"] for path in (card, copy))
    assert first == second
    axes = "tilted" if "axes: tilted" in card.read_text() else "level"
    other = {"tilted": "level", "level": "tilted"}[axes]
    copy.write_text(card.read_text().replace(f"axes: {axes}", f"axes: {other}"))
    assert document(run, "track", copy, *printed)["instant"] != first


def test_a_bar_at_a_straight_wall(run, tmp_path):
    shapes.box(30, 10, 5).export(tmp_path / "bar.stl")
    found = document(run, "headings", "bar.stl", "--aspect", "A", "--set", "track.radius=100 m")["headings"]
    assert set(found[0]) >= {"heading_deg", "share", "length_mm", "width_mm", "falls_off"}
    long_side = [row for row in found if row["length_mm"] == pytest.approx(30, rel=1e-3)]
    assert sum(row["share"] for row in long_side) == pytest.approx(4 * np.arctan(3) / (2 * np.pi), rel=1e-6)
    assert [row["heading_deg"] for row in long_side] == [0.0]  # half a turn maps the bar to itself


def test_the_sliding_map_as_csv_is_equation_4_27(run):
    text = run("slide", "--beta", "20", "--format", "csv").stdout
    assert text.splitlines()[0] == COLUMNS
    b = math.radians(20)
    for row in csv.DictReader(io.StringIO(text)):
        ratio, angle = float(row["acceleration_ratio"]), math.radians(float(row["alpha_minus_theta_deg"]))
        if ratio * math.sin(b) >= 1:
            assert (row["mu_limit"], row["regime"]) == ("", "hop")
        else:
            limit = ratio * math.cos(b) * math.cos(angle) / (1 - ratio * math.sin(b))
            assert float(row["mu_limit"]) == pytest.approx(limit, rel=1e-4, abs=1e-6)


def test_files_of_sliding_maps_are_the_same_bytes_each_time(run):
    call = ("slide", "--beta", "10", "--beta", "40", "-o", "results", "-q")
    result = run(*call)
    assert (result.exit_code, result.stderr) == (0, "")
    folder = Path("results/defaults")
    pictures = [f"slide_{kind}_beta{b}.png" for b in (10, 40) for kind in ("surface", "contours", "regimes")]
    assert {p.name for p in folder.iterdir()} == {"run.json", "slide.csv", "slide_curves.png", *pictures}
    assert json.loads((folder / "run.json").read_text())["slide"]["effective"]["drive.frequency"] == "50 Hz"
    before = {p.name: p.read_bytes() for p in folder.iterdir()}
    run(*call)
    assert before == {p.name: p.read_bytes() for p in folder.iterdir()}


@pytest.mark.parametrize(
    ("beta", "line"),
    [
        ("120", "'120' is out of range - give 0 deg to 90 deg"),
        ("nan", "'nan' is not a number - write digits with a decimal point, as in 0.4"),
        ("20 mm", "'20 mm' is a length, not an angle - give it in deg"),
    ],
)
def test_a_wrong_angle_is_a_wrong_call(run, beta, line):
    result = run("slide", "--beta", beta)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"Error: Invalid value for '--beta': {line} (see feeder slide --help)\n"
