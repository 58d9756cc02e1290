"""``feeder aspects``: its columns, its files, its warnings and errors."""

import csv
import io
import json
from pathlib import Path

import part_files as files
import pytest
import shapes

PARTS = Path(__file__).parents[3] / "parts"
COLUMNS = [
    "aspect", "kind", "faces", "stable", "normal_x", "normal_y", "normal_z", "height_mm", "contact_area_mm2",
    "solid_angle_sr", "polar_inertia_g_mm2", "p_pmi", "p_csa", "p_stability",
]  # fmt: skip


@pytest.fixture
def stl(tmp_path):
    """Write a box of 10 x 20 x 30 mm as an STL; its path."""
    path = tmp_path / "box.stl"
    shapes.box(10.0, 20.0, 30.0).export(path)
    return path


def document(done):
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_csv_has_the_columns_of_the_contract(run, stl):
    done = run("aspects", stl, "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert list(rows[0])[: len(COLUMNS)] == COLUMNS
    assert [row["aspect"] for row in rows] == ["A", "B", "C"]
    assert {row["faces"] for row in rows} == {"2"}


def test_json_converts_to_mm_and_grams(run, stl):
    told = document(run("aspects", stl, "--density", "2 g/cm3", "--format", "json"))
    a, b, c = 10.0, 20.0, 30.0
    mass = 2.0e-3 * a * b * c
    assert told["part"] == "box"
    assert told["units"] == "mm"
    assert told["density_g_cm3"] == pytest.approx(2.0)
    assert told["mass_g"] == pytest.approx(mass, rel=1e-6)
    assert told["volume_mm3"] == pytest.approx(a * b * c, rel=1e-6)
    assert told["centre_of_mass_mm"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    assert told["inertia_g_mm2"][0][0] == pytest.approx(mass * (b * b + c * c) / 12.0, rel=1e-6)
    assert told["warnings"] == []
    on_largest = told["aspects"][0]
    assert list(on_largest)[: len(COLUMNS)] == COLUMNS
    assert on_largest["height_mm"] == pytest.approx(5.0)
    assert on_largest["contact_area_mm2"] == pytest.approx(600.0)
    assert on_largest["polar_inertia_g_mm2"] == pytest.approx(mass * (b * b + c * c) / 12.0, rel=1e-6)
    for rule in COLUMNS[-3:]:
        assert sum(row[rule] for row in told["aspects"]) == pytest.approx(1.0, abs=1e-12)


def test_all_adds_the_unstable_facets_without_a_probability(run):
    part = PARTS / "key_a_d12x20.stl"
    stable = document(run("aspects", part, "--format", "json"))["aspects"]
    every = document(run("aspects", part, "--all", "--format", "json"))["aspects"]
    assert every[: len(stable)] == stable
    assert len(every) > len(stable)
    assert not any(row["stable"] or row["p_csa"] for row in every[len(stable) :])


def test_as_published_counts_each_class_once(run):
    part = PARTS / "squarenut_m5.stl"
    plain = document(run("aspects", part, "--format", "json"))["aspects"]
    once = document(run("aspects", part, "--as-published", "--format", "json"))["aspects"]
    weights = [row["p_pmi"] / row["faces"] for row in plain]
    assert [row["p_pmi"] for row in once] == pytest.approx([weight / sum(weights) for weight in weights])
    assert [row["p_csa"] for row in once] == [row["p_csa"] for row in plain]


def test_o_writes_tables_pictures_and_the_record(run, tmp_path, stl):
    done = run("aspects", stl, "-o", "res")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "res/box"
    names = {"aspects.csv", "aspects.json", "aspects.png", "names.yaml", "probabilities.png", "run.json"}
    assert {path.name for path in folder.iterdir()} == names
    before = {path: path.read_bytes() for path in folder.iterdir()}
    run("aspects", stl, "-o", "res")
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
    record = json.loads((folder / "run.json").read_text())["aspects"]
    assert record["effective"]["density_g_cm3"] == pytest.approx(7.85)
    assert record["inputs"][0]["path"] == "../../box.stl"


def test_standard_input(run, stl):
    from_file = document(run("aspects", stl, "--format", "json"))
    from_pipe = document(run("aspects", "-", "--format", "json", stdin=stl.read_bytes()))
    assert from_pipe["aspects"] == from_file["aspects"]


@pytest.mark.parametrize("content", [b"", b"solid", b"\x00" * 100])
def test_a_broken_file_is_one_line_and_leaves_nothing(run, tmp_path, content):
    (tmp_path / "bad.stl").write_bytes(content)
    done = run("aspects", "bad.stl", "-o", "res")
    assert (done.exit_code, done.stdout) == (1, "")
    assert len(done.stderr.splitlines()) == 1
    assert done.stderr.startswith("Error: bad.stl: ")
    assert not (tmp_path / "res").exists()


def test_an_open_surface_is_labelled_everywhere(run, tmp_path):
    mesh = shapes.box(10.0, 20.0, 30.0)
    mesh.update_faces([True] * (len(mesh.faces) - 1) + [False])
    mesh.export(tmp_path / "open.stl")
    assert run("aspects", "open.stl").exit_code == 1
    done = run("aspects", "open.stl", "--allow-open", "--format", "json")
    told = document(done)
    assert told["open_surface"] is True
    assert {row["surface"] for row in told["aspects"]} == {"open"}
    assert told["warnings"]
    assert done.stderr.startswith("Warning: ")


def test_a_failed_self_check_marks_every_row(run, stl, tmp_path, monkeypatch):
    from feederscrew.resting import exact_tumbling

    assert "doubtful" not in run("aspects", stl).output
    monkeypatch.setattr(exact_tumbling, "SHARE_SUM_TOLERANCE", -1.0)  # no sum is close enough to 1
    line = "exact tumbling is doubtful: the basins fill 1 of the sphere"
    done = run("aspects", stl, "--format", "json", "-o", "res", "--no-pictures")
    assert document(done)["warnings"] == [line] and f"Warning: {line}" in done.stderr
    assert {row["tumbling"] for row in document(done)["aspects"]} == {"doubtful"}
    with (tmp_path / "res" / "box" / "aspects.csv").open() as file:
        assert {row["tumbling"] for row in csv.DictReader(file)} == {"doubtful"}
    assert line in (tmp_path / "res" / "box" / "run.json").read_text()
    assert all(text.endswith("doubtful") for text in run("aspects", stl).stdout.splitlines()[-3:])


def test_the_graph_is_written(run, tmp_path, stl):
    assert run("aspects", stl, "--graph", "-o", "res").exit_code == 0
    assert (tmp_path / "res/box/graph.csv").read_text().startswith("from,to,barrier_mm")
    assert (tmp_path / "res/box/graph.png").stat().st_size > 5000


def test_other_columns_are_printed_on_demand(run, stl):
    some = run("aspects", stl, "--columns", "aspect, barrier_mm").stdout.splitlines()[0].split()
    assert some == ["aspect", "barrier"]
    csv = run("aspects", stl, "--columns", "aspect,height_mm", "--format", "csv").stdout.splitlines()
    assert csv[0] == "aspect,height_mm" and csv[1].startswith("A,")
    everything = run("aspects", stl, "--columns", "all").stdout
    assert all(word in everything for word in ("hops", "normal", "quasistatic"))
    wrong = run("aspects", stl, "--columns", "aspect,barier_mm")
    assert wrong.exit_code == 2
    assert "Error: --columns: there is no column 'barier_mm' - did you mean barrier_mm?" in wrong.stderr


BROKEN = Path(__file__).parents[2] / "data" / "broken"


NAMES = [
    "part", "units", "material", "density_g_cm3", "mass_g", "volume_mm3", "centre_of_mass_mm",
    "inertia_g_mm2", "open_surface", "inertia_at_origin_g_mm2", "principal_moments_g_mm2", "principal_axes",
    "hull_volume_mm3", "bounding_box_mm", "bounding_box_corner_mm", "warnings",
]  # fmt: skip


@pytest.fixture
def inertia_stl(tmp_path):
    """A box of 10 x 20 x 30 mm with a corner at the origin; its path."""
    return files.written(tmp_path, files.box(), "box.stl")


def test_json_carries_the_units_in_its_names(run, inertia_stl):
    told = document(run("inertia", inertia_stl, "--density", "2 g/cm3", "--format", "json"))
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
def test_output_folder(run, inertia_stl, tmp_path, format, name):
    done = run("inertia", inertia_stl, "--format", format, "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results" / "box"
    assert {path.name for path in folder.iterdir()} == {f"inertia.{name}", "run.json"}
    first = (folder / f"inertia.{name}").read_bytes()
    run("inertia", inertia_stl, "--format", format, "-o", "results")
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
