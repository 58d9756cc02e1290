"""``feeder design`` of several parts."""

import json

import pytest
import shapes

from feederscrew.designing import design, queues


@pytest.fixture
def cubes(tmp_path, monkeypatch):
    """Two cubes of other sizes, queues that are soon over, and no solid."""
    monkeypatch.setattr(design, "built", lambda study, settings: design.Built())
    monkeypatch.setattr(queues, "TOUCHING_PARTS", 4)
    monkeypatch.setattr(queues, "FILL_SECONDS", 2.0)
    monkeypatch.setattr(queues, "FILLS", queues.FILLS[1:])
    found = [tmp_path / "small.stl", tmp_path / "large.stl"]
    for path, size in zip(found, (9, 11), strict=True):
        shapes.box(size, size, size).export(path)
    return found


def test_two_cubes_run_in_one_bowl(run, cubes, tmp_path):
    few = ("--draws", "1", "--jobs", "1", "--no-pictures", "--format", "json")
    done = run("design", *cubes, "--target", "40/min", *few, "-o", "results")
    assert done.exit_code == 0, done.output
    document = json.loads(done.stdout)
    assert (document["status"], document["shared"]) == ("holds", True)
    assert [one["part"] for one in document["parts"]] == ["small", "large"]
    assert all(row["how"] == "set" for row in document["changeover"])  # the drive, if anything
    bowls = [one["bowl"] for one in document["parts"]]
    assert len({(one["diameter_mm"], one["track_width_mm"], one["bank_deg"]) for one in bowls}) == 1
    first, *rows = (tmp_path / "results/family/changeover.csv").read_text().splitlines()
    assert first == "what,how,small,large" and len(rows) == len(document["changeover"])
    page = (tmp_path / "results/family/family.html").read_text()
    assert "one bowl for several parts: holds" in page and "changeover.csv" in page
    assert all(f"{one}/design.html" in page for one in ("small", "large"))
    for name in ("small", "large"):
        assert (tmp_path / "results" / name / "design.yaml").read_text().startswith("# holds: ")


@pytest.mark.parametrize(
    ("more", "line"),
    [
        (("--aspect", "A"), "--aspect is of one part - design that one alone (see feeder design --help)"),
        (("--up", "A,B"), "--up is of one part - design that one alone (see feeder design --help)"),
        (("--heading", "90"), "--heading is of one part - design that one alone (see feeder design --help)"),
    ],
)
def test_what_is_of_one_part_is_refused_of_several(run, cubes, more, line):
    done = run("design", *cubes, "--target", "40/min", *more)
    assert (done.exit_code, done.stdout, done.stderr) == (2, "", f"Error: {line}\n")


def test_two_files_of_one_name_are_a_fault(run, cubes, tmp_path):
    (tmp_path / "other").mkdir()
    twin = tmp_path / "other" / "small.stl"
    twin.write_bytes(cubes[0].read_bytes())
    done = run("design", *cubes, twin, "--target", "40/min", "-o", "results")
    assert done.exit_code == 1 and done.stdout == ""
    assert done.stderr == (
        f"Error: {twin}: is another part of the name small: results would be overwritten - rename a file\n"
    )
    assert not (tmp_path / "results").exists()
