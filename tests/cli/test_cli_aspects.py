"""``feeder aspects`` and ``inertia``: their columns, their files, their warnings and errors."""

import json

import part_files as files
import pytest
import shapes
from command_lines import CARD, NUT, PARTS, ROOT, names, rows

from feederscrew.resting import exact_tumbling

COLUMNS = [
    "aspect", "lies", "rolls", "faces", "stable", "normal_x", "normal_y", "normal_z", "height_mm",
    "contact_area_mm2", "solid_angle_sr", "polar_inertia_g_mm2", "p_pmi", "p_csa", "p_stability",
]  # fmt: skip
INERTIA = [
    "part", "units", "material", "density_g_cm3", "mass_g", "volume_mm3", "centre_of_mass_mm",
    "inertia_g_mm2", "open_surface", "inertia_at_origin_g_mm2", "principal_moments_g_mm2", "principal_axes",
    "hull_volume_mm3", "bounding_box_mm", "bounding_box_corner_mm", "warnings",
]  # fmt: skip


@pytest.fixture
def stl(tmp_path):
    """A box of 10 x 20 x 30 mm about the origin, as an STL."""
    shapes.box(10.0, 20.0, 30.0).export(tmp_path / "box.stl")
    return tmp_path / "box.stl"


def test_the_contract_is_in_mm_and_grams(run_json, run, stl):
    """Closed forms of a box of 12 g; a stream and other columns are of the same rows."""
    document = run_json("aspects", stl, "--density", "2 g/cm3")
    about_x = 12.0 * (20.0**2 + 30.0**2) / 12.0
    assert (document["part"], document["units"], document["warnings"]) == ("box", "mm", [])
    assert document["mass_g"] == pytest.approx(12.0, rel=1e-6)
    assert document["inertia_g_mm2"][0][0] == pytest.approx(about_x, rel=1e-6)
    on_largest = document["aspects"][0]
    assert list(on_largest)[: len(COLUMNS)] == COLUMNS
    numbers = [on_largest[name] for name in ("height_mm", "contact_area_mm2", "polar_inertia_g_mm2")]
    assert numbers == pytest.approx([5.0, 600.0, about_x], rel=1e-6)
    for rule in COLUMNS[-3:]:
        assert sum(row[rule] for row in document["aspects"]) == pytest.approx(1.0, abs=1e-12)
    table = rows(run("aspects", stl, "--format", "csv").stdout)
    assert list(table[0])[: len(COLUMNS)] == COLUMNS
    assert [(row["aspect"], row["faces"]) for row in table] == [("A", "2"), ("B", "2"), ("C", "2")]
    pipe = run_json("aspects", "-", "--density", "2 g/cm3", stdin=stl.read_bytes())
    assert pipe["aspects"] == document["aspects"]
    first = run("aspects", stl, "--columns", "aspect, barrier_mm").stdout.splitlines()[0]
    assert first.split() == ["aspect", "barrier"]
    table = run("aspects", stl, "--columns", "aspect,height_mm", "--format", "csv").stdout.splitlines()
    assert table[0] == "aspect,height_mm" and table[1].startswith("A,")
    everything = run("aspects", stl, "--columns", "all").stdout
    assert all(word in everything for word in ("hops", "normal", "quasistatic"))


def test_unstable_facets_have_no_probability_and_the_published_rule_counts_a_class_once(run_json):
    key = PARTS / "key_a_d12x20.stl"
    stable, every = (run_json("aspects", key, *more)["aspects"] for more in ((), ("--all",)))
    assert every[: len(stable)] == stable and len(every) > len(stable)
    assert not any(row["stable"] or row["p_csa"] for row in every[len(stable) :])
    plain, once = (run_json("aspects", NUT, *more)["aspects"] for more in ((), ("--as-published",)))
    weights = [row["p_pmi"] / row["faces"] for row in plain]
    assert [row["p_pmi"] for row in once] == pytest.approx([weight / sum(weights) for weight in weights])
    assert [row["p_csa"] for row in once] == [row["p_csa"] for row in plain]


def test_o_writes_tables_pictures_and_the_record(run, tmp_path, stl):
    assert run("aspects", stl, "-o", "res").exit_code == 0
    folder = tmp_path / "res/box"
    tables = {"aspects.csv", "aspects.json", "names.yaml", "run.json"}
    assert names(folder) == tables | {"aspects.png", "probabilities.png"}
    before = {path: path.read_bytes() for path in folder.iterdir()}
    run("aspects", stl, "-o", "res")
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
    record = json.loads((folder / "run.json").read_text())["aspects"]
    assert record["effective"]["density_g_cm3"] == pytest.approx(7.85)
    assert record["inputs"][0]["path"] == "../../box.stl"
    assert run("aspects", stl, "--graph", "-o", "graph").exit_code == 0
    assert (tmp_path / "graph/box/graph.csv").read_text().startswith("from,to,barrier_mm")
    assert (tmp_path / "graph/box/graph.png").stat().st_size > 5000


def test_an_open_surface_is_labelled_everywhere(run, run_json, tmp_path):
    mesh = shapes.box(10.0, 20.0, 30.0)
    mesh.update_faces([True] * (len(mesh.faces) - 1) + [False])
    mesh.export(tmp_path / "open.stl")
    document = run_json("aspects", "open.stl", "--allow-open")
    assert document["open_surface"] is True and document["warnings"]
    assert {row["surface"] for row in document["aspects"]} == {"open"}
    assert run("aspects", "open.stl", "--allow-open").stderr.startswith("Warning: ")


def test_a_failed_self_check_marks_every_row(run, run_json, stl, tmp_path, monkeypatch):
    assert "doubtful" not in run("aspects", stl).output
    monkeypatch.setattr(exact_tumbling, "SHARE_SUM_TOLERANCE", -1.0)  # no sum is close enough to 1
    line = "exact tumbling is doubtful: the basins fill 1 of the sphere"
    document = run_json("aspects", stl, "-o", "res", "--no-pictures")
    assert document["warnings"] == [line]
    assert {row["tumbling"] for row in document["aspects"]} == {"doubtful"}
    assert {row["tumbling"] for row in rows(tmp_path / "res/box/aspects.csv")} == {"doubtful"}
    assert line in (tmp_path / "res/box/run.json").read_text()
    done = run("aspects", stl)
    assert f"Warning: {line}" in done.stderr
    assert all(text.endswith("doubtful") for text in done.stdout.splitlines()[-3:])


def test_inertia_carries_the_units_in_its_names(run_json, tmp_path):
    """Closed forms of a box of 6 cm3 and 12 g with a corner at the origin."""
    document = run_json("inertia", files.written(tmp_path, files.box(), "box.stl"), "--density", "2 g/cm3")
    assert list(document) == INERTIA
    assert (document["part"], document["units"], document["material"]) == ("box", "mm", "2 g/cm3")
    assert (document["warnings"], document["open_surface"]) == ([], False)
    about = [12.0 * (400 + 900) / 12, 12.0 * (100 + 900) / 12, 12.0 * (100 + 400) / 12]
    values = {
        "density_g_cm3": 2.0, "mass_g": 12.0, "volume_mm3": 6000.0, "hull_volume_mm3": 6000.0,
        "bounding_box_mm": [10.0, 20.0, 30.0], "bounding_box_corner_mm": [0.0, 0.0, 0.0],
        "centre_of_mass_mm": [5.0, 10.0, 15.0], "principal_moments_g_mm2": sorted(about),
    }  # fmt: skip
    for name, value in values.items():
        assert document[name] == pytest.approx(value, rel=1e-6, abs=1e-9), name
    assert [document["inertia_g_mm2"][k][k] for k in range(3)] == pytest.approx(about, rel=1e-6)
    assert document["principal_axes"][0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
    at_corner = [12.0 * 1300 / 3, -12.0 * 200 / 4, -12.0 * 300 / 4]
    assert document["inertia_at_origin_g_mm2"][0] == pytest.approx(at_corner, rel=1e-6)


def test_inertia_of_a_card_leaves_empty_what_it_does_not_tell_and_writes_what_it_prints(
    run, run_json, stl, tmp_path
):
    document = run_json("inertia", CARD)
    silent = ("density_g_cm3", "volume_mm3", "hull_volume_mm3", "bounding_box_mm", "bounding_box_corner_mm")
    assert [document[name] for name in silent] == [None] * len(silent)
    assert document["mass_g"] == pytest.approx(1.982)
    assert document["inertia_g_mm2"][0] == pytest.approx([95.32, 0.0, -24.48])
    assert "volume_mm3,\n" in run("inertia", CARD, "--format", "csv").stdout
    for format, name in (("table", "csv"), ("csv", "csv"), ("json", "json")):
        done, folder = run("inertia", stl, "--format", format, "-o", format), tmp_path / format / "box"
        assert done.exit_code == 0 and names(folder) == {f"inertia.{name}", "run.json"}
        assert (folder / f"inertia.{name}").read_text() == done.stdout or format == "table"


@pytest.mark.parametrize(
    "name", ["truncated_hexbolt", "not_an_stl", "zero_bytes", "flat_sheet", "nan_lbracket", "open_lbracket"]
)
def test_a_file_without_an_honest_number_is_one_line_and_leaves_nothing(run, tmp_path, name):
    path = ROOT / f"tests/data/broken/{name}.stl"
    line = files.refused(path).replace("`allow_open`", "--allow-open")
    for command in ("inertia", "aspects"):
        done = run(command, path, "-o", "res")
        assert (done.exit_code, done.stdout, done.stderr) == (1, "", f"Error: {path}: {line}\n")
    assert not (tmp_path / "res").exists()


def test_micrometres_may_be_typed_with_their_sign(run_json, stl):
    """'Did you mean m?' was said of it, a factor of a million."""
    for unit in ("um", "\u00b5m", "\u03bcm"):
        assert run_json("inertia", stl, "--units", unit, "-q")["volume_mm3"] == pytest.approx(6e-6)


def test_what_a_newcomer_cannot_act_on_is_said_with_verbose_and_stays_in_the_document(run, run_json):
    """24 facets of a bolt came as a warning, with shares by a rule that nobody had asked for."""
    bolt, quick = str(PARTS / "hexbolt_m8x25.stl"), ("--rule", "closed")
    remark = "facets are no aspects"
    assert remark not in run("aspects", bolt, *quick).stderr
    assert remark in run("aspects", bolt, *quick, "-v").stderr
    assert any(remark in line for line in run_json("aspects", bolt, *quick)["warnings"])


def test_the_launch_of_the_recommended_answer_is_explained_where_it_is_first_named(run):
    said = run("aspects", NUT, "--rule", "closed", "--launch", "flip").stderr
    assert "launch flip (spun as a coin)" in said


def test_a_heap_says_how_many_come_single(run):
    """Square nuts do not hold each other: all of a heap come single."""
    from feederscrew.trials.heap import PARTS

    call = "aspects", NUT, "--rule", "closed", "--heap"
    heap = json.loads(run(*call, "--format", "json").stdout)["heap"]
    assert (heap["parts"], heap["single"], heap["single_share"], heap["seed"]) == (PARTS, PARTS, 1.0, 1)
    assert 0.75 < heap["single_share_low"] < 1.0 == heap["single_share_high"]
    assert f"Heap: {PARTS} of {PARTS} parts of a heap come single" in run(*call).stderr
