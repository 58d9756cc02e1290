"""``feeder floor``, ``track``, ``headings``, ``slide``: contracts of their JSON, maps, files and faults."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapes
from command_lines import BRACKET, CARD, PARTS, names, rows

MAGNET = PARTS / "magnet.yaml"
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
    "track": {f"track_{kind}" for kind in ("cycle.csv", "cycle.png", "map.csv", "map.png", "part.png")}
    | {"track.json"},
    "headings": {"headings.csv", "headings.json", "headings_A.png"},
}  # fmt: skip


@pytest.mark.parametrize("command", FILES)
def test_files(run, command):
    assert run(command, BRACKET, "--aspect", "A", *SETS, "-o", "out").exit_code == 0
    assert names(Path("out", BRACKET.stem)) == FILES[command] | {"run.json"}


def test_the_contract_of_the_floor(run_json):
    document = run_json("floor", BRACKET, "--aspect", "A", "--heading", "30deg", *GENTLE)
    assert set(document["instant"]) >= ON_FLOOR and document["heading_deg"] == pytest.approx(30)
    assert document["regime"] in ("stick", "slide", "hop", "tip")
    assert {len(column) for column in document["cycle"].values()} == {72}
    printed = ("--set", "drive.direction=10 deg", "--as-published")
    document = run_json("floor", CARD, "--aspect", "5", *GENTLE, *printed)
    omitted = {row["quantity"]: row for row in document["difference"]}
    assert omitted["normal_force_N"]["omitted_term"] == "-"
    assert "a wall to take the force across" in omitted["limiting_friction"]["omitted_term"]
    offset = document["instant"]["normal_line_offset_mm"]
    assert offset == omitted["normal_line_offset_mm"]["as_published"]


def test_the_contract_of_the_track_its_maps_and_the_heading_in_which_a_part_settles(run, run_json):
    call = ("track", BRACKET, "--aspect", "A", *SETS)
    document = run_json(*call)
    assert set(ON_TRACK) <= set(document["instant"])
    assert document["first_to_open"] in ("floor", "wall_1", "wall_2", "none")
    assert set(document["tipping_axis"]) == {"point_mm", "direction", "pitch_mm"}
    assert set(document["friction_needed"]) == {"floor", "wall_1", "wall_2"}
    assert document["stays_on_wall"] is True and min(document["cycle"]["wall_1_N"]) >= 0.0
    headings = [run_json(*call, "--heading", laid)["heading_deg"] for laid in ("10deg", "170deg")]
    assert headings == pytest.approx([2.1345, 177.8655], abs=1e-3)
    # a map over any two keys
    spans = ("--vary", "track.bank=0:20:3", "--vary", "friction.static=0.2:0.6:2")
    grid = rows(run("track", BRACKET, *SETS, *spans, "--format", "csv").stdout)
    assert len(grid) == 6 and list(grid[0])[:2] == ["bank_deg", "static"]
    last = ("--set", "friction.static=0.6", "--set", "track.bank=20 deg")
    force = run_json("track", BRACKET, *SETS, *last)["instant"]["normal_force_N"]
    assert float(grid[-1]["normal_force_N"]) == pytest.approx(force, rel=1e-5)


def test_one_verdict_stands_beside_the_velocity_and_what_is_too_wide_is_one_line(run):
    """'tips: yes', 'opens at 0 times the drive' and 'nothing slides anywhere' stood beside 19.3 mm/s."""
    result = run("track", PARTS / "dowel_6x20.stl", "--aspect", "B", "-o", "out", "--no-pictures")
    table = dict(line.rsplit("  ", 1) for line in result.stdout.splitlines())
    assert table[f"{'on the track, over the strokes':62}"] == "turns over, goes back into the bowl"
    assert "carries nothing even at rest" in result.stdout
    assert "tips" not in result.stdout and "opens at" not in result.stdout
    assert "has its line of action outside the contact in" in result.stderr
    assert "nothing slides anywhere" not in result.stderr
    # one that is too wide for the track is one line and leaves nothing
    sets = ("--set", "track.width=12 mm", "--heading", "270deg")
    result = run("track", BRACKET, "--aspect", "A", *sets, "-o", "narrow")
    line = "Error: aspect A, heading 270 deg: the part needs 30.19 mm of track and falls off - "
    assert result.exit_code == 1 and not Path("narrow").exists()
    assert result.stderr.splitlines()[-1] == f"{line}give a wider track, or another heading"


def test_a_turned_and_moved_file_changes_nothing(run_json, tmp_path, rng):
    mesh = shapes.prism([(0, 0), (30, 0), (30, 5), (12, 5), (5, 14), (0, 14)], 7.0)
    mesh.export(tmp_path / "straight.stl")
    shapes.turned(mesh, rng).export(tmp_path / "turned.stl")
    first, second = (run_json("track", f"{k}.stl", "--aspect", "A", *SETS) for k in ("straight", "turned"))
    for name in ON_TRACK[:-1]:
        assert second["instant"][name] == pytest.approx(first["instant"][name], rel=1e-3, abs=1e-7), name
    assert second["heading_deg"] == pytest.approx(first["heading_deg"], abs=1e-3)
    assert second["first_to_open"] == first["first_to_open"]


@pytest.mark.parametrize(("card", "aspect"), [(CARD, "5"), (MAGNET, "3")])
def test_a_card_gives_the_same_under_another_name_and_not_in_other_axes(run_json, card, aspect):
    text, axes = card.read_text(), ["axes: tilted", "axes: level"]
    this, other = axes if axes[0] in text else axes[::-1]
    Path("same.yaml").write_text(text)
    Path("other.yaml").write_text(text.replace(this, other))
    own = ("--aspect", aspect, "--as-published", *SETS)
    forces = [run_json("track", path, *own)["instant"] for path in ("same.yaml", card, "other.yaml")]
    assert forces[0] == forces[1] != forces[2]


def test_a_bar_at_a_straight_wall(run_json, tmp_path):
    shapes.box(30, 10, 5).export(tmp_path / "bar.stl")
    headings = run_json("headings", "bar.stl", "--aspect", "A", "--set", "track.radius=100 m")["headings"]
    assert set(headings[0]) >= {"heading_deg", "share", "length_mm", "width_mm", "falls_off"}
    long_side = [row for row in headings if row["length_mm"] == pytest.approx(30, rel=1e-3)]
    assert sum(row["share"] for row in long_side) == pytest.approx(4 * np.arctan(3) / (2 * np.pi), rel=1e-6)
    assert [row["heading_deg"] for row in long_side] == [0.0]  # half a turn maps the bar to itself


def test_files_of_sliding_maps_are_the_same_bytes_each_time(run):
    folder, before = Path("results/defaults"), {}
    for _ in range(2):
        result = run("slide", "--beta", "40", "-o", "results", "-q")
        assert (result.exit_code, result.stderr) == (0, "")
        files = {path.name: path.read_bytes() for path in folder.iterdir()}
        assert before in ({}, files)
        before = files
    pictures = [f"slide_{kind}_beta40.png" for kind in ("surface", "contours", "regimes")]
    assert files["slide.csv"].decode().split("\n")[0] == COLUMNS
    assert set(files) == {"run.json", "slide.csv", "slide_curves.png", *pictures}
    assert json.loads(files["run.json"])["slide"]["effective"]["drive.frequency"] == "50 Hz"
