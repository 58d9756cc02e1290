"""``feeder inertia``: its names, formats, files and errors."""

import json
from pathlib import Path

import part_files as files
import pytest
import shapes

PARTS = Path(__file__).parents[3] / "parts"
BROKEN = Path(__file__).parents[2] / "data" / "broken"
NAMES = [
    "part", "units", "material", "density_g_cm3", "mass_g", "volume_mm3", "centre_of_mass_mm",
    "inertia_g_mm2", "open_surface", "inertia_at_origin_g_mm2", "principal_moments_g_mm2", "principal_axes",
    "hull_volume_mm3", "bounding_box_mm", "bounding_box_corner_mm", "warnings",
]  # fmt: skip


@pytest.fixture
def stl(tmp_path):
    """A box of 10 x 20 x 30 mm with a corner at the origin; its path."""
    return files.written(tmp_path, files.box(), "box.stl")


def document(done):
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_json_carries_the_units_in_its_names(run, stl):
    told = document(run("inertia", stl, "--density", "2 g/cm3", "--format", "json"))
    mass = 12.0  # [g] 6 cm3 of 2 g/cm3
    assert list(told) == NAMES
    assert (told["part"], told["units"], told["material"]) == ("box", "mm", "2 g/cm3")
    assert told["density_g_cm3"] == pytest.approx(2.0)
    assert told["mass_g"] == pytest.approx(mass, rel=1e-6)
    assert told["volume_mm3"] == pytest.approx(6000.0, rel=1e-6)
    assert told["hull_volume_mm3"] == pytest.approx(6000.0, rel=1e-6)
    assert told["bounding_box_mm"] == pytest.approx([10.0, 20.0, 30.0])
    assert told["bounding_box_corner_mm"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert told["centre_of_mass_mm"] == pytest.approx([5.0, 10.0, 15.0])
    about = [mass * (400 + 900) / 12, mass * (100 + 900) / 12, mass * (100 + 400) / 12]
    assert [told["inertia_g_mm2"][k][k] for k in range(3)] == pytest.approx(about, rel=1e-6)
    assert told["principal_moments_g_mm2"] == pytest.approx(sorted(about), rel=1e-6)
    assert told["principal_axes"][0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
    assert told["inertia_at_origin_g_mm2"][0] == pytest.approx(
        [mass * 1300 / 3, -mass * 200 / 4, -mass * 300 / 4], rel=1e-6
    )
    assert told["warnings"] == []
    assert told["open_surface"] is False


def test_card_leaves_empty_what_it_does_not_tell(run):
    told = document(run("inertia", PARTS / "arc_chute.yaml", "--format", "json"))
    silent = ("density_g_cm3", "volume_mm3", "hull_volume_mm3", "bounding_box_mm", "bounding_box_corner_mm")
    assert [told[name] for name in silent] == [None] * len(silent)
    assert told["mass_g"] == pytest.approx(1.982)
    assert told["inertia_g_mm2"][0] == pytest.approx([95.32, 0.0, -24.48])
    done = run("inertia", PARTS / "arc_chute.yaml", "--format", "csv")
    assert "volume_mm3,\n" in done.stdout


@pytest.mark.parametrize(("format", "name"), [("table", "csv"), ("csv", "csv"), ("json", "json")])
def test_output_folder(run, stl, tmp_path, format, name):
    done = run("inertia", stl, "--format", format, "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results" / "box"
    assert {path.name for path in folder.iterdir()} == {f"inertia.{name}", "run.json"}
    first = (folder / f"inertia.{name}").read_bytes()
    run("inertia", stl, "--format", format, "-o", "results")
    assert (folder / f"inertia.{name}").read_bytes() == first
    if format != "table":
        assert first.decode() == done.stdout


@pytest.mark.parametrize(
    "name", ["truncated_hexbolt", "not_an_stl", "zero_bytes", "flat_sheet", "nan_lbracket", "open_lbracket"]
)
def test_file_without_an_honest_number_is_one_line(run, name):
    path = BROKEN / f"{name}.stl"
    done = run("inertia", path)
    assert done.exit_code == 1
    assert done.stdout == ""
    told = files.refused(path).replace("`allow_open`", "--allow-open")
    assert done.stderr == f"Error: {path}: {told}\n"


@pytest.mark.parametrize("unit", ["um", "\u00b5m", "\u03bcm"])
def test_micrometres_may_be_typed_with_their_sign(run, tmp_path, unit):
    """'Did you mean m?' was said of it, a factor of a million."""
    shapes.box(20_000, 12_000, 5_000).export(tmp_path / "small.stl")
    done = run("inertia", "small.stl", "--units", unit, "--format", "json", "-q")
    assert json.loads(done.stdout)["volume_mm3"] == pytest.approx(1200.0)
