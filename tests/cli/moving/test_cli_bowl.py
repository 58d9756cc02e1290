"""``feeder bowl`` from the command line: machine, order, files, faults."""

import csv
import json
from pathlib import Path

import pytest
import trimesh

from feederscrew import part

PART = Path(__file__).parents[3] / "parts" / "lbracket_30x20x15.stl"
MACHINE = {
    "bowl_mass": "6 kg", "bowl_inertia": "0.06 kg m2", "base_mass": "25 kg", "base_inertia": "0.25 kg m2",
    "spring_radius": "90 mm", "spring_angle": "20 deg", "leaf_width": "40 mm", "leaf_thickness": "2.5 mm",
    "leaf_length": "80 mm", "leaf_modulus": "206 GPa", "leaves": "10", "damping": "0.01",
}  # fmt: skip
FILES = {
    "bowl.json", "bowl.csv", "bowl_angles.csv", "bowl_leaves.csv", "bowl_leaf_changes.csv",
    "bowl_emptying.csv", "bowl.png", "run.json",
}  # fmt: skip


def machine(**other):
    lines = [f"  {key}: {value}\n" for key, value in {**MACHINE, **other}.items()]
    Path("machine.yaml").write_text("machine:\n" + "".join(lines))
    return ("--config", "machine.yaml")


def document(result):
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


def told(run, *arguments, status=1):
    result = run("bowl", *arguments)
    assert result.exit_code == status
    return result.stderr.removeprefix("Error: ").strip()


def test_the_machine_of_a_file(run):
    found = document(run("bowl", *machine(), "--format", "json"))
    assert found["leaf_stiffness_n_per_mm"] == pytest.approx(251.46, abs=0.005)
    assert found["effective_mass_kg"] == pytest.approx(5.841, abs=5e-4)
    assert found["natural_frequency_without_twist_hz"] == pytest.approx(104.43, abs=0.005)
    assert found["drive_frequency_hz"] == 100.0
    angles = {round(row["radius_mm"]): row["vibration_angle_deg"] for row in found["angle_by_radius"]}
    assert angles[90] == pytest.approx(20.0, abs=1e-6) and angles[150] == pytest.approx(12.3, abs=0.05)
    assert {"parts_per_minute", "sheet"}.isdisjoint(found)


def test_the_bowl_of_a_part_reaches_its_rate(run):
    result = run("bowl", PART, "--target", "60/min", "-o", "results", "--format", "json")
    found = document(result)
    assert found["parts_per_minute"] == pytest.approx(60.0, rel=1e-6) and found["parts_per_minute"] >= 60.0
    assert found["rate_empty_bowl"] == pytest.approx(found["rate_at_this_stroke"])
    assert found["parts_per_minute"] == found["rate_lowest_left_alone"]
    assert found["leaves"] % 3 == 0 and all(row["leaves"] % 3 == 0 for row in found["leaf_sets"])
    assert found["bowl_diameter_mm"] == max(300.0, found["bowl_diameter_mm"])
    assert all(least <= found["bowl_diameter_mm"] for least in found["least_diameters_mm"].values())
    parts = found["part_width_mm"] + found["clearance_mm"] + found["bend_mm"]
    assert found["track_width_mm"] == pytest.approx(parts)
    assert 3.5 <= found["climb_deg"] < found["steepest_climb_deg"]
    assert 3.0 <= found["above_drive_percent"] <= 8.0
    assert found["leaf_stress_mpa"] < found["fatigue_stress_mpa"]
    folder = Path("results", PART.stem)
    assert {path.name for path in folder.iterdir()} == FILES
    sheet = list(csv.DictReader((folder / "bowl.csv").read_text().splitlines()))
    assert sheet == [{key: row[key] for key in ("quantity", "value")} for row in found["sheet"]]
    assert len((folder / "bowl_emptying.csv").read_text().splitlines()) == 22


WEAK = ("--set", "machine.leaves=9", "--set", "machine.leaf_thickness=2 mm")  # driven above its own frequency


def test_the_headline_is_the_lowest_rate_from_full_to_empty(run):
    found = document(run("bowl", PART, "--target", "60/min", *WEAK, "--format", "json"))
    rates = [row["rate_per_minute"] for row in found["emptying"]]
    assert found["lowest_with"] == "amplitude left alone"
    assert found["parts_per_minute"] == pytest.approx(min(rates)) and min(rates) >= 60.0 * (1.0 - 1e-6)
    assert (rates.index(min(rates)), found["lowest_at_fill_percent"]) == (0, 100.0)
    assert found["rate_at_this_stroke"] == pytest.approx(rates[-1]) and rates[-1] > 70.0
    (line,) = (row["value"] for row in found["sheet"] if row["quantity"].startswith("lowest rate"))
    assert line == "60 at 100 % of the fill, amplitude left alone"


def test_parts_fill_a_bowl_and_a_hopper_by_their_hulls(run):
    found = document(run("bowl", PART, "--target", "60/min", "--format", "json"))
    hull = document(run("inertia", PART, "--format", "json"))["hull_volume_mm3"]
    assert found["hopper_l"] == pytest.approx(60 * 30 * hull * 1e-6 / 0.5, rel=1e-9)
    grams = 10.827344
    full = found["full_bowl"]
    assert full["mass_kg"] == pytest.approx(full["volume_l"] * 1e6 * 0.5 / hull * grams * 1e-3, rel=1e-6)


def test_a_hop_that_is_higher_than_the_margin_of_the_tooling_is_told(run):
    """A hop of 0.49 mm is told as a warning, and one of 0.12 mm in the sheet alone."""
    Path("cut.yaml").write_text("devices:\n  - narrowed_track: 18 mm\n  - wiper: 40 mm\n")
    angle = ("--set", "drive.vibration_angle=25 deg")
    asked = ("bowl", "--config", "cut.yaml", *angle, "--set")
    high = run(*asked, "drive.frequency=50 Hz", "--set", "drive.amplitude=0.6 mm")
    assert "at the throw number 2.55 parts hop 0.49 mm high" in high.stderr
    assert "try the narrowed track with feeder trial" in high.stderr
    low = run(*asked, "drive.frequency=100 Hz", "--set", "drive.amplitude=0.15 mm")
    assert "parts hop" not in low.stderr and "a part hops" in low.stdout and "0.12 mm high" in low.stdout
    still = run(*asked, "drive.frequency=50 Hz", "--set", "drive.amplitude=0.1 mm")
    assert "parts hop" not in still.stderr and "a part hops" not in still.stdout


def test_one_key_of_the_machine_says_what_it_makes_of_the_drive(run):
    result = run("convey", "--set", "machine.leaves=10")
    assert (
        "Warning: machine.leaves: is given, so drive.frequency is 100 Hz by the machine, not 50 Hz and"
        " drive.vibration_angle is 16.1066 deg by the machine, not 25 deg"
        " - write drive.frequency and drive.vibration_angle"
    ) in result.stderr.splitlines()
    kept = ("--set", "drive.frequency=50 Hz", "--set", "drive.vibration_angle=25 deg")
    assert "by the machine" not in run("convey", "--set", "machine.leaves=10", *kept).stderr
    told = ("--set", "machine.supply=50 Hz half wave", "--set", "machine.spring_angle=20 deg")
    assert "by the machine" not in run("convey", *told).stderr


def test_the_sized_bowl_gives_the_same_rate_by_feeder_rate(run):
    """What was sized, written into a bowl file, brings the rate asked for on the aspect that counts."""
    wanted = ("--aspect", "A", "--rule", "pmi")
    found = document(run("bowl", PART, "--target", "15/min", *wanted, "--format", "json"))
    given = {
        "drive.peak_to_peak": f"{found['peak_to_peak_mm']!r} mm",
        "drive.frequency": f"{found['drive_frequency_hz']!r} Hz",
        "drive.vibration_angle": f"{found['vibration_angle_deg']!r} deg",
        "track.radius": f"{found['bowl_diameter_mm'] / 2!r} mm",
        "track.width": f"{found['track_width_mm']!r} mm",
        "track.climb": f"{found['climb_deg']!r} deg",
    }
    settings = [word for key, value in given.items() for word in ("--set", f"{key}={value}")]
    back = document(run("rate", PART, *wanted, *settings, "--format", "json"))
    assert back["parts_per_minute"] == pytest.approx(15.0, rel=1e-4)


def test_what_the_file_says_is_kept_and_devices_count(run):
    Path("bowl.yaml").write_text(
        "track:\n  radius: 200 mm\n  width: 40 mm\ndevices:\n  - height_bar: 21 mm\n"
    )
    found = document(run("bowl", PART, "--target", "30/min", "--config", "bowl.yaml", "--format", "json"))
    assert (found["bowl_diameter_mm"], found["track_width_mm"]) == (400.0, 40.0)
    assert 0.5 < found["share_counted"] < 0.99


@pytest.mark.parametrize(
    "key, value, line",
    [
        ("leaf_thickness", "2 mm", "machine.leaves: the natural frequency 77.99 Hz is below the drive's"),
        (
            "leaf_thickness",
            "3.5 mm",
            "machine.leaves: the natural frequency 180.6 Hz is 80.6 % above",
        ),
        ("leaf_length", "30 mm", "machine.leaf_thickness: the leaves bend to "),
    ],
)
def test_a_machine_that_is_out_of_tune_or_too_weak(run, key, value, line):
    result = run("bowl", *machine(**{key: value}))
    (found,) = [one for one in result.stderr.splitlines() if one.startswith(f"Warning: {line}")]
    assert result.exit_code == 0 and " - " in found


def test_faults_are_one_line(run):
    assert told(run, *machine(damping="-1")) == (
        "machine.yaml:13:12: machine.damping: '-1' is out of range - give 0 to 0.9"
    )
    assert told(run, *machine(leaves="9.5")) == (
        "machine.yaml:12:11: machine.leaves: '9.5' is not a whole number - give 9 or 10"
    )
    assert told(run, *machine(supply="50 Hz")) == (
        "machine.yaml:14:11: machine.supply: '50 Hz' is a frequency, not a supply"
        " - write 50 Hz full wave or 50 Hz half wave"
    )
    assert told(run, PART, "--target", "60/min", "--units", "cm") == (
        f"{PART}: needs a bowl of 3010 mm, and none is larger than 1200 mm"
        " - feed it from a step or belt feeder, or raise sizing.greatest_diameter"
    )
    line = told(run, PART, "--target", "9/s", "--rule", "nobody", status=2)
    assert line.startswith("--rule: unknown rule 'nobody'")
    assert told(run, PART, "--target", "1/min", "--set", "track.radius=30 mm") == (
        "track.radius: 30 mm is too small for a part 36.05 mm long - leave it out, to have the bowl sized"
    )


@pytest.mark.needs("lxml", "networkx")  # reads its own 3MF again
def test_the_bowl_as_a_solid(run, tmp_path):
    config = tmp_path / "gap.yaml"
    config.write_text("devices:\n  - gap: 9 mm\n")
    line = ["bowl", PART, "--target", "40/min", "--config", config, "--solid"]
    line += ["--print", "pla", "--bed", "220x220x250mm", "--join", "screws"]
    found = document(run(*line, "-o", tmp_path, "--no-pictures", "--format", "json"))
    made = tmp_path / "lbracket_30x20x15"
    assert {path.name for path in made.iterdir()} >= {"bowl.stl", "bowl.3mf", "bowl.pdf", "bowl_segments.3mf"}
    shape = trimesh.load(made / "bowl.stl")
    assert shape.is_watertight and shape.body_count == 1
    assert shape.volume == pytest.approx(found["solid_volume_mm3"], rel=1e-5)
    assert found["screws"] >= 4  # each with its lug
    assert found["bowl_mass_kg"] / (1240e-9 * shape.volume) == pytest.approx(1.04, abs=0.02)
    assert found["bowl_depth_mm"] == found["outlet_height_mm"]
    pieces = [trimesh.load(made / f"bowl_{one['name']}.stl") for one in found["segments"]]
    assert len(pieces) == 4 and max(max(one.extents) for one in pieces) <= 220.0
    again = part.load(made / "bowl.3mf")
    assert again.volume * 1e9 == pytest.approx(shape.volume, rel=1e-6)
    sheet = (made / "bowl.pdf").read_bytes()
    assert sheet.startswith(b"%PDF-") and b"/Subtype /Image" not in sheet and b"CreationDate" not in sheet


DOWN = """\
devices:
  - separation: {climb: -6 deg}
  - sorter: {of: A@188, play: 8.35 mm, sees: outline}
  - separation: {climb: 3 deg}
"""


def test_the_climb_makes_room_below_a_stretch_that_leads_down(run, tmp_path):
    """At 3.5 deg it is 24 mm over the turn below, less than a bolt of 30.5 mm needs."""
    (tmp_path / "down.yaml").write_text(DOWN)
    bolt = PART.with_name("hexbolt_m8x25.stl")
    line = ["bowl", bolt, "--target", "60/min", "--config", tmp_path / "down.yaml", "--rule", "csa"]
    flat = document(run(*line, "--format", "json"))["climb_deg"]
    refused = run(*line, "--solid", "--set", "track.climb=3.5 deg")
    assert refused.exit_code == 1 and "a device leads the track down to" in refused.stderr
    least = float(refused.stderr.partition("track.climb of at least ")[2].partition(" deg")[0])
    assert flat == pytest.approx(3.5) and least > 3.5
    made = run(*line, "--solid", "--format", "json")
    assert document(made)["climb_deg"] == pytest.approx(least, abs=1e-9)
    assert f"the track climbs at {least:.4g} deg, so that parts pass below" in made.stderr
    assert run(*line, "--solid", "--set", f"track.climb={least - 0.3} deg").exit_code == 1


def test_a_bowl_that_sorts_nothing_says_so(run, tmp_path):
    (tmp_path / "gap.yaml").write_text("devices:\n  - gap: 8 mm\n")
    line = ("bowl", PART, "--target", "60/min", "--rule", "csa")
    bare = run(*line).stderr
    assert "every way up" in bare and "--config" in bare
    assert "every way up" not in run(*line, "--config", tmp_path / "gap.yaml").stderr


def test_what_was_measured_is_set_beside_what_should_be(run):
    plain = ("bowl", *machine(), "--format", "json", "--measured")
    asked = document(run(*plain, "stroke=0.42 mm"))
    should = asked["should"]["stroke_mm"]
    assert asked["causes"] == ["the machine does what it should, within 10 %"]
    low = document(run(*plain, f"stroke={0.5 * should} mm, fill=0 %"))
    assert any("50 % of its setting" in cause for cause in low["causes"])
    assert low["measured"]["velocity_mm_s"] < low["should"]["velocity_mm_s"]
    peak = 0.25 * asked["should"]["acceleration_m_s2"]  # at the same stroke: half the frequency
    half = document(run(*plain, f"acceleration={peak} m/s2, stroke={should} mm"))
    assert half["measured"]["frequency_hz"] == pytest.approx(0.5 * half["should"]["frequency_hz"])
    assert half["causes"][0] == "only one half-wave pulls: the controller is set to half wave"


@pytest.mark.parametrize(
    "option",
    [
        ("--body", "7"), ("--units", "cm"), ("--density", "brass"), ("--centre-of-mass", "0,0,1"),
        ("--allow-open",), ("--aspect", "A"), ("--heading", "90deg"), ("--rule", "csa"), ("--gap", "1 mm"),
        ("--fill", "0.5"),
    ],
)  # fmt: skip
def test_what_is_said_of_a_part_without_one_is_a_wrong_call(run, option):
    """`feeder bowl --body 7` gave the machine of the defaults as if nothing had been asked of a part."""
    done = run("bowl", *option)
    assert done.exit_code == 2 and done.stdout == ""
    assert f"{option[0]} is given without PART - name the part's file" in done.stderr


@pytest.mark.parametrize("option", [("--print", "pla"), ("--chord", "1 mm"), ("--step",)])
def test_what_is_said_of_the_solid_without_one_is_a_wrong_call(run, option):
    done = run("bowl", PART, "--target", "60/min", *option)
    assert done.exit_code == 2 and f"{option[0]} is given without --solid - add --solid" in done.stderr


def test_a_rate_that_does_not_last_is_told(run):
    """A full bowl that runs far below its drive brings less, whatever the controller does."""
    heavy = ("--set", "machine.leaves=15", "--set", "machine.leaf_thickness=2.5 mm")
    result = run("bowl", PART, "--target", "60/min", *heavy, "--set", "sizing.carried=100 %")
    (line,) = (line for line in result.stderr.splitlines() if line.startswith("Warning: target: "))
    assert line.startswith("Warning: target: 60/min are not kept as the bowl empties: 8.93")
    assert "/min at 100 % of" in line
    assert " at 100 % of the fill, amplitude controlled" in result.stdout


def test_leaves_that_do_not_share_into_the_banks_are_told(run):
    line = "machine.leaves: 10 leaves do not share into 3 banks - take 9 or 12, or give sizing.banks"
    assert f"Warning: {line}" in run("bowl", *machine()).stderr.splitlines()
    five = run("bowl", *machine(), "--set", "sizing.banks=5")
    assert "banks" not in five.stderr and "5 banks of 2" in five.stdout


def test_a_speed_that_bowls_do_not_run_is_told(run):
    slow = ("--set", "drive.amplitude=0.15 mm")
    line = "mm/s is slower than bowls run (20 to 120 mm/s): check stroke, angle and friction"
    for command in (("convey",), ("rate", PART, "--aspect", "A")):
        assert line in run(*command, *slow).stderr
        assert run(*command).stderr == ""
