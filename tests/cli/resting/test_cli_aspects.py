"""``feeder aspects``: its columns, its files, its warnings and errors."""

import csv
import io
import json
from pathlib import Path

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


def test_the_printed_table_fits_a_terminal_and_leads_with_the_answer(run, stl):
    heading = run("aspects", stl).stdout.splitlines()[0]
    assert len(heading) <= 100
    assert heading.index("recommended") < heading.index("PMI") < heading.index("stability")


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
