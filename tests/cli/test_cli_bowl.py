"""``feeder bowl`` from the command line: machine, order, files, faults."""

import json
from pathlib import Path

import pytest
import trimesh
from command_lines import BRACKET, PARTS, called, names, rows

from feederscrew import part

MACHINE = {
    "bowl_mass": "6 kg", "bowl_inertia": "0.06 kg m2", "base_mass": "25 kg", "base_inertia": "0.25 kg m2",
    "spring_radius": "90 mm", "spring_angle": "20 deg", "leaf_width": "40 mm", "leaf_thickness": "2.5 mm",
    "leaf_length": "80 mm", "leaf_modulus": "206 GPa", "leaves": "10", "damping": "0.01",
}  # fmt: skip
FILES = {
    "bowl.json", "bowl.csv", "bowl_angles.csv", "bowl_leaves.csv", "bowl_leaf_changes.csv",
    "bowl_emptying.csv", "bowl.png", "run.json",
}  # fmt: skip
ORDER = ("bowl", BRACKET, "--target", "60/min")
WEAK = ("--set", "machine.leaves=9", "--set", "machine.leaf_thickness=2 mm")  # driven above its own frequency


def machine(**other):
    lines = [f"  {key}: {value}\n" for key, value in {**MACHINE, **other}.items()]
    Path("machine.yaml").write_text("machine:\n" + "".join(lines))
    return ("--config", "machine.yaml")


@pytest.fixture(scope="module")
def sized(tmp_path_factory):
    """What is printed of a bowl that feeds a bracket, and the folder that is written."""
    folder = tmp_path_factory.mktemp("sized")
    return json.loads(called(*ORDER, "-o", folder, "--format", "json").stdout), folder / BRACKET.stem


def test_the_machine_of_a_file(run_json):
    document = run_json("bowl", *machine())
    assert document["leaf_stiffness_n_per_mm"] == pytest.approx(251.46, abs=0.005)
    assert document["effective_mass_kg"] == pytest.approx(5.841, abs=5e-4)
    assert document["natural_frequency_without_twist_hz"] == pytest.approx(104.43, abs=0.005)
    angles = {round(row["radius_mm"]): row["vibration_angle_deg"] for row in document["angle_by_radius"]}
    assert angles[90] == pytest.approx(20.0, abs=1e-6) and angles[150] == pytest.approx(12.3, abs=0.05)
    assert {"parts_per_minute", "sheet"}.isdisjoint(document)


def test_the_bowl_of_a_part_reaches_its_rate(sized, run_json):
    document, folder = sized
    rate = document["parts_per_minute"]
    assert rate == pytest.approx(60.0, rel=1e-6) and rate == document["rate_lowest_left_alone"] >= 60.0
    assert document["rate_empty_bowl"] == pytest.approx(document["rate_at_this_stroke"])
    assert document["leaves"] % 3 == 0 and all(row["leaves"] % 3 == 0 for row in document["leaf_sets"])
    assert document["bowl_diameter_mm"] >= max(300.0, *document["least_diameters_mm"].values())
    parts = document["part_width_mm"] + document["clearance_mm"] + document["bend_mm"]
    assert document["track_width_mm"] == pytest.approx(parts)
    assert 3.5 <= document["climb_deg"] < document["steepest_climb_deg"]
    assert 3.0 <= document["above_drive_percent"] <= 8.0
    assert document["leaf_stress_mpa"] < document["fatigue_stress_mpa"]
    assert names(folder) == FILES
    sheet = [{key: row[key] for key in ("quantity", "value")} for row in document["sheet"]]
    assert rows(folder / "bowl.csv") == sheet and len(rows(folder / "bowl_emptying.csv")) == 21
    # parts fill a bowl and a hopper by their hulls
    hull, full, grams = run_json("inertia", BRACKET)["hull_volume_mm3"], document["full_bowl"], 10.827344
    assert document["hopper_l"] == pytest.approx(60 * 30 * hull * 1e-6 / 0.5, rel=1e-9)
    assert full["mass_kg"] == pytest.approx(full["volume_l"] * 1e6 * 0.5 / hull * grams * 1e-3, rel=1e-6)


def test_the_headline_is_the_lowest_rate_from_full_to_empty_and_one_that_does_not_last_is_told(run, run_json):
    document = run_json(*ORDER, *WEAK)
    rates = [row["rate_per_minute"] for row in document["emptying"]]
    assert document["lowest_with"] == "amplitude left alone"
    assert document["parts_per_minute"] == pytest.approx(min(rates)) and min(rates) >= 60.0 * (1.0 - 1e-6)
    assert (rates.index(min(rates)), document["lowest_at_fill_percent"]) == (0, 100.0)
    assert document["rate_at_this_stroke"] == pytest.approx(rates[-1]) and rates[-1] > 70.0
    (line,) = (row["value"] for row in document["sheet"] if row["quantity"].startswith("lowest rate"))
    assert line == "60 at 100 % of the fill, amplitude left alone"
    # a full bowl that runs far below its drive brings less, whatever the controller does
    heavy = ("--set", "machine.leaves=15", "--set", "machine.leaf_thickness=2.5 mm")
    result = run(*ORDER, *heavy, "--set", "sizing.carried=100 %")
    (line,) = (line for line in result.stderr.splitlines() if line.startswith("Warning: target: "))
    assert line.startswith("Warning: target: 60/min are not kept as the bowl empties: 11.3")
    assert "/min at 100 % of" in line and " at 100 % of the fill, amplitude controlled" in result.stdout


def test_a_hop_that_is_higher_than_the_margin_of_the_tooling_is_told(run):
    """A hop of 0.49 mm is told as a warning, and one of 0.12 mm in the sheet alone."""
    Path("cut.yaml").write_text("devices:\n  - narrowed_track: 18 mm\n  - wiper: 40 mm\n")
    call = ("bowl", "--config", "cut.yaml", "--set", "drive.vibration_angle=25 deg", "--set")
    drives = ("50 Hz", "0.6 mm"), ("100 Hz", "0.15 mm"), ("50 Hz", "0.1 mm")
    high, low, still = (
        run(*call, f"drive.frequency={f}", "--set", f"drive.amplitude={a}") for f, a in drives
    )
    assert "at the throw number 2.55 parts hop 0.49 mm high" in high.stderr
    assert "try the narrowed track with feeder trial" in high.stderr
    assert "parts hop" not in low.stderr and "a part hops" in low.stdout and "0.12 mm high" in low.stdout
    assert "parts hop" not in still.stderr and "a part hops" not in still.stdout


def test_one_key_of_the_machine_says_what_it_makes_of_the_drive(run):
    call = ("convey", "--set", "machine.leaves=10")
    line = "Warning: machine.leaves: is given, so drive.frequency is 100 Hz by the machine, not 50 Hz and"
    line += " drive.vibration_angle is 16.1066 deg by the machine, not 25 deg - write drive.frequency and"
    assert f"{line} drive.vibration_angle" in run(*call).stderr.splitlines()
    kept = ("--set", "drive.frequency=50 Hz", "--set", "drive.vibration_angle=25 deg")
    own = ("--set", "machine.supply=50 Hz half wave", "--set", "machine.spring_angle=20 deg")
    assert "by the machine" not in run(*call, *kept).stderr + run("convey", *own).stderr


def test_the_sized_bowl_gives_the_same_rate_by_feeder_rate(run_json):
    """What was sized, written into a bowl file, brings the rate asked for on the aspect that counts."""
    wanted = ("--aspect", "A", "--rule", "pmi")
    document = run_json("bowl", BRACKET, "--target", "15/min", *wanted)
    values = {
        "drive.peak_to_peak": "peak_to_peak_mm", "drive.frequency": "drive_frequency_hz",
        "drive.vibration_angle": "vibration_angle_deg", "track.width": "track_width_mm",
        "track.climb": "climb_deg",
    }  # fmt: skip
    settings = ["--set", f"track.radius={document['bowl_diameter_mm'] / 2!r} mm"]
    for key, name in values.items():
        settings += ["--set", f"{key}={document[name]!r} {name.rpartition('_')[2].replace('hz', 'Hz')}"]
    rate = run_json("rate", BRACKET, *wanted, *settings)["parts_per_minute"]
    assert rate == pytest.approx(15.0, rel=1e-4)


def test_what_the_file_says_is_kept_and_a_bowl_that_sorts_nothing_says_so(run, run_json):
    Path("bowl.yaml").write_text("track: {radius: 200 mm, width: 40 mm}\ndevices:\n  - height_bar: 21 mm\n")
    document = run_json("bowl", BRACKET, "--target", "30/min", "--config", "bowl.yaml", "--rule", "csa")
    assert (document["bowl_diameter_mm"], document["track_width_mm"]) == (400.0, 40.0)
    assert 0.5 < document["share_counted"] < 0.99
    bare, sorts = (run(*ORDER, "--rule", "csa", *own).stderr for own in ((), ("--config", "bowl.yaml")))
    assert "every way up" in bare and "--config" in bare and "every way up" not in sorts


def test_leaves_that_lean_by_thirty_degrees(run_json):
    """Of the bowl's turn cos psi twists a leaf: 4.57 % above the drive for 5.61, a gain of 11.4 for 9.5."""
    own = ("leaves=9", "leaf_width=40 mm", "leaf_thickness=3.5 mm", "leaf_length=90 mm")
    document = run_json(*ORDER, *(word for key in own for word in ("--set", f"machine.{key}")))
    assert document["spring_angle_deg"] == pytest.approx(30.0)
    assert document["stiffness_with_over_without_twist"] == pytest.approx(1.0634, abs=1e-4)
    assert document["natural_frequency_hz"] == pytest.approx(104.6, abs=0.05)
    assert document["gain"] == pytest.approx(11.4, abs=0.05)
    assert document["magnet_force_n"] == pytest.approx(107, abs=0.6)


OFF = {
    ("leaf_thickness", "2 mm"): "machine.leaves: the natural frequency 77.62 Hz is below the drive's",
    ("leaf_thickness", "3.5 mm"): "machine.leaves: the natural frequency 179.7 Hz is 79.7 % above",
    ("leaf_length", "30 mm"): "machine.leaf_thickness: the leaves bend to ",
    ("leaves", "10"): "machine.leaves: 10 leaves do not share into 3 banks - take 9 or 12, or give",
}


@pytest.mark.parametrize("key, value", OFF)
def test_a_machine_that_is_out_of_tune_too_weak_or_uneven(run, key, value):
    result = run("bowl", *machine(**{key: value}))
    lines = result.stderr.splitlines()
    (warning,) = [line for line in lines if line.startswith(f"Warning: {OFF[key, value]}")]
    assert result.exit_code == 0 and " - " in warning
    five = run("bowl", *machine(**{key: value}), "--set", "sizing.banks=5")
    assert "banks" not in five.stderr and "5 banks of 2" in five.stdout


FAULTS = {
    "damping=-1": "machine.yaml:13:12: machine.damping: '-1' is out of range - give 0 to 0.9",
    "leaves=9.5": "machine.yaml:12:11: machine.leaves: '9.5' is not a whole number - give 9 or",
    "supply=50 Hz": "machine.yaml:14:11: machine.supply: '50 Hz' is a frequency, not a supply",
    "--units cm": f"{BRACKET}: needs a bowl of 3010 mm, and none is larger than 1200 mm",
    "--set track.radius=30mm": "track.radius: 30 mm is too small for a part 36.05 mm long",
}


@pytest.mark.parametrize("wrong", FAULTS)
def test_faults_are_one_line(run, wrong):
    own = wrong.startswith("--")
    result = run(*ORDER, *wrong.split()) if own else run("bowl", *machine(**dict([wrong.split("=")])))
    assert (result.exit_code, result.stderr.count("\n")) == (1, 1) and " - " in result.stderr
    assert result.stderr.startswith(f"Error: {FAULTS[wrong]}")


@pytest.mark.needs("lxml", "networkx")  # reads its own 3MF again
def test_the_bowl_as_a_solid(run_json, tmp_path):
    (tmp_path / "gap.yaml").write_text("devices:\n  - gap: 9 mm\n")
    line = ["bowl", BRACKET, "--target", "40/min", "--config", "gap.yaml", "--solid"]
    line += ["--print", "pla", "--bed", "220x220x250mm", "--join", "screws"]
    document = run_json(*line, "-o", tmp_path, "--no-pictures")
    folder = tmp_path / BRACKET.stem
    assert names(folder) >= {"bowl.stl", "bowl.3mf", "bowl.pdf", "bowl_segments.3mf"}
    shape = trimesh.load(folder / "bowl.stl")
    assert shape.is_watertight and shape.body_count == 1
    assert shape.volume == pytest.approx(document["solid_volume_mm3"], rel=1e-5)
    assert document["screws"] >= 4  # each with its lug
    assert document["bowl_mass_kg"] / (1240e-9 * shape.volume) == pytest.approx(1.04, abs=0.02)
    assert document["bowl_depth_mm"] == document["outlet_height_mm"]
    pieces = [trimesh.load(folder / f"bowl_{piece['name']}.stl") for piece in document["segments"]]
    assert len(pieces) == 4 and max(max(piece.extents) for piece in pieces) <= 220.0
    assert part.load(folder / "bowl.3mf").volume * 1e9 == pytest.approx(shape.volume, rel=1e-6)
    sheet = (folder / "bowl.pdf").read_bytes()
    assert sheet.startswith(b"%PDF-") and b"/Subtype /Image" not in sheet and b"CreationDate" not in sheet


def test_the_climb_makes_room_below_a_stretch_that_leads_down(run, tmp_path):
    """At 3.5 deg it is 24 mm over the turn below, less than a bolt of 30.3 mm needs."""
    sorter = "{sorter: {of: A@186, play: 8.15 mm, sees: outline}}"
    text = f"devices: [{{separation: {{climb: -6 deg}}}}, {sorter}, {{separation: {{climb: 3 deg}}}}]\n"
    (tmp_path / "down.yaml").write_text(text)
    line = ("bowl", PARTS / "hexbolt_m8x25.stl", *"--target 60/min --config down.yaml --rule csa".split())
    flat = json.loads(run(*line, "--format", "json").stdout)["climb_deg"]
    refused = run(*line, "--solid", "--set", "track.climb=3.5 deg")
    assert refused.exit_code == 1 and "a device leads the track down to" in refused.stderr
    least = float(refused.stderr.partition("track.climb of at least ")[2].partition(" deg")[0])
    assert flat == pytest.approx(3.5) and least > 3.5
    made = run(*line, "--solid", "--format", "json")
    assert json.loads(made.stdout)["climb_deg"] == pytest.approx(least, abs=1e-9)
    assert f"the track climbs at {least:.4g} deg, so that parts pass below" in made.stderr
    assert run(*line, "--solid", "--set", f"track.climb={least - 0.3} deg").exit_code == 1


def test_what_was_measured_is_set_beside_what_should_be(run_json):
    call = ("bowl", *machine(), "--measured")
    fine = run_json(*call, "stroke=0.42 mm")
    should = fine["should"]["stroke_mm"]
    assert fine["causes"] == ["the machine does what it should, within 10 %"]
    low = run_json(*call, f"stroke={0.5 * should} mm, fill=0 %")
    assert any("50 % of its setting" in cause for cause in low["causes"])
    assert low["measured"]["velocity_mm_s"] < low["should"]["velocity_mm_s"]
    peak = 0.25 * fine["should"]["acceleration_m_s2"]  # at the same stroke: half the frequency
    half = run_json(*call, f"acceleration={peak} m/s2, stroke={should} mm")
    assert half["measured"]["frequency_hz"] == pytest.approx(0.5 * half["should"]["frequency_hz"])
    assert half["causes"][0] == "only one half-wave pulls: the controller is set to half wave"


def test_a_speed_that_bowls_do_not_run_is_told(run):
    line = "mm/s is slower than bowls run (20 to 240 mm/s): check stroke, angle and friction"
    for command in (("convey",), ("rate", BRACKET, "--aspect", "A")):
        assert line in run(*command, "--set", "drive.amplitude=0.15 mm").stderr
        assert "slower than bowls run" not in run(*command).stderr
