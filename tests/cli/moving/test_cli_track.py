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

BANKED = (
    "drive.amplitude=0.15 mm", "drive.frequency=50 Hz", "drive.vibration_angle=25 deg", "friction.static=0.4",
    "track.radius=2 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=12 deg",
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


def test_as_published_lists_what_the_print_leaves_out(run):
    found = document(run, CARD, "--aspect", "5", *SETS, "--as-published")
    rows = {row["quantity"]: row for row in found["difference"]}
    assert "radial gravity" in rows["wall_1_N"]["omitted_term"]
    assert found["instant"]["wall_1_N"] == rows["wall_1_N"]["as_published"]
    assert "4.33" in {term["equation"] for term in found["omitted_terms"]}


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


def test_a_card_is_drawn_without_an_outline(run, tmp_path):
    result = run("track", CARD, "--aspect", "5", *SETS, "-o", "out", "--as-published")
    assert result.exit_code == 0, result.output
    folder = tmp_path / "out/arc_chute"
    assert (folder / "track_part.png").stat().st_size > 5000
    assert (folder / "track_omitted_terms.csv").exists()


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


def test_vary_is_given_twice(run):
    result = run("track", BRACKET, "--vary", "track.bank=0:5:3")
    assert result.exit_code == 2
    assert "--vary is given 1 times - give it twice, for a map" in result.stderr


def test_the_cycle_has_the_names_of_the_instant(run):
    found = document(run, BRACKET, "--aspect", "A", *SETS)
    assert set(found["instant"]) <= set(found["cycle"])
    place = found["cycle"]["phase_deg"].index(90.0)  # the upper reversal, from rest and in the settled cycle
    for name, near in (("normal_force_N", 1e-3), ("traction_N", 0.1), ("wall_1_N", 0.2), ("wall_2_N", 0.2)):
        assert found["cycle"][name][place] == pytest.approx(found["instant"][name], rel=near), name


def test_values_in_the_picture_do_not_cover_one_another(tmp_path):
    from feederscrew import bowl, part
    from feederscrew.output import track as track_output
    from feederscrew.studies.track import track

    figure = track_output.part(track(part.load(BRACKET), bowl.default()), "bracket")
    figure.canvas.draw()
    for axes in figure.axes:
        boxes = [text.get_window_extent() for text in axes.texts if text.get_text()]
        clashes = [a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i]]
        assert len(boxes) > 2 and not any(clashes)


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


@pytest.mark.parametrize("amplitude", ["0.5 mm"])
def test_while_it_hops_nothing_is_said_of_the_wall(run, amplitude):
    """Neither "stays against the wall: yes" nor "a contact is open 100 % of the cycle": it is in flight."""
    hopping = (BRACKET, "--aspect", "C", "--set", f"drive.amplitude={amplitude}")
    found = document(run, *hopping)
    assert found["regime"] == "hop" and found["stays_on_wall"] is None
    cycle = found["cycle"]
    assert all(
        (state == "hop") == (opened == "in flight") for state, opened in zip(cycle["state"], cycle["opened"])
    )
    told = run("track", *hopping)
    assert "stays against the wall" in told.stdout and "not known: it hops" in told.stdout
    assert "whether it stays against the wall is not known" in told.stderr
    assert "% of the cycle" not in told.stderr


@pytest.mark.parametrize(("wall", "turns"), [("0.5", False), ("0.7", True)])
def test_what_friction_turns_about_one_wall_contact_is_said_to_be_slower(run, tmp_path, wall, turns):
    block = tmp_path / "block.stl"
    shapes.box(20, 12, 5).export(block)
    sets = [f"--set={one}" for one in BANKED] + [f"--set=friction.wall={wall}"]
    told = run("track", block, "--aspect", "A", "--heading", "90deg", *sets).output
    assert ("friction turns the part about the wall contact that is left" in " ".join(told.split())) == turns
