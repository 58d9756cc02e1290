"""One body of several in a file: listed, numbered in the file's order, named as the file names them."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import trimesh
from test_formats import loaded, mm3

import feederscrew
from feederscrew.batch import inputs
from feederscrew.errors import FeederError
from feederscrew.part import load

DATA = Path(__file__).parents[1] / "data"
SMALL, LARGE = files.box((4.0, 4.0, 4.0)), files.box((10.0, 6.0, 5.0), (20.0, 0.0, 0.0))
TWO = files.binary_stl(np.concatenate([SMALL, LARGE]))
CAVITY = files.inside_out(files.box((2.0, 2.0, 2.0), (21.0, 1.0, 1.0)))


def named(format):
    """Bytes of a file of the two boxes, with the names of its bodies."""
    if format == "stl":
        return files.ascii_stl(SMALL, "pin") + files.ascii_stl(LARGE, "Big block")
    if format == "obj":
        small, large = files.obj(SMALL), files.obj(LARGE)
        lines = [line for line in large.decode().splitlines() if line.startswith("f")]
        moved = ["f " + " ".join(str(int(k) + 36) for k in line.split()[1:]) for line in lines]
        corners = [line for line in large.decode().splitlines() if line.startswith("v")]
        return b"o pin\n" + small + "\n".join(["o Big block", *corners, *moved, ""]).encode()
    scene = trimesh.Scene()
    for name, triangles in (("pin", SMALL), ("Big block", LARGE)):
        mesh = trimesh.Trimesh(
            **trimesh.triangles.to_kwargs(triangles / (1000.0 if format == "glb" else 1.0))
        )
        scene.add_geometry(mesh, node_name=name, geom_name=name)
    return scene.export(file_type=format)


def refused(data, **options):
    """The line that bytes are refused with."""
    with pytest.raises(FeederError) as caught:
        loaded(data, **options)
    assert len(caught.value.lines) == 1
    return str(caught.value)


@pytest.mark.parametrize(
    ("body", "volume"), [("1", 64.0), ("2", 300.0), ("largest", 300.0), (" LARGEST ", 300.0)]
)
def test_a_body_is_taken_by_its_number_or_its_size(body, volume):
    part = loaded(TWO, body=body)
    assert mm3(part) == pytest.approx(volume)
    assert "left out" in part.warnings[0]
    assert not part.open_surface


@pytest.mark.parametrize("format", ["stl", "obj", "glb", "3mf"])
def test_a_body_is_taken_by_its_name(format):
    data = named(format)
    assert mm3(loaded(data, body="pin")) == pytest.approx(64.0, rel=1e-6)
    assert mm3(loaded(data, body="big BLOCK")) == pytest.approx(300.0, rel=1e-6)
    line = refused(data)
    assert "'pin'" in line and "'Big block'" in line and "`body`" in line


def test_two_solids_of_a_step_file():
    """Two housings of 20 x 10 x 6 mm, each with a hole of 5 mm through its 6 mm: 1082.2 mm3."""
    pytest.importorskip("cascadio")
    part = loaded((DATA / "two_solids.step").read_bytes(), body="2")
    assert "body 2 'Gehäuse" in part.warnings[0]
    assert mm3(part) == pytest.approx(1200.0 - 2.5**2 * np.pi * 6.0, abs=0.5)


@pytest.mark.parametrize("body", ["0", "3", "-1", "1.0", "second", "", "99999999999", "\u0662", "\x1b[31m"])
def test_a_body_that_is_not_there_is_a_line(body):
    line = refused(TWO, body=body)
    assert line.startswith("body: ") and "largest" in line and line.isprintable()


def test_a_name_of_two_bodies_is_a_line():
    data = files.ascii_stl(SMALL, "pin") + files.ascii_stl(LARGE, "pin")
    assert "1 and 2" in refused(data, body="pin")
    assert mm3(loaded(data, body="2")) == pytest.approx(300.0)


def test_a_cavity_goes_with_its_body():
    data = files.binary_stl(np.concatenate([CAVITY, SMALL, LARGE]))
    assert mm3(loaded(data, body="1")) == pytest.approx(292.0)
    assert mm3(loaded(data, body="2")) == pytest.approx(64.0)


def test_faces_that_nearly_meet_are_one_body():
    """Each side of a box tessellated by itself, 2e-4 mm off: six sides are no six bodies."""
    rng = np.random.default_rng(3)
    moved = LARGE + np.repeat(rng.uniform(-1e-4, 1e-4, (6, 1, 3)), 1, axis=0)[np.arange(12) % 6]
    with pytest.raises(FeederError) as caught:
        loaded(files.binary_stl(np.concatenate([moved, SMALL])), body="7")
    assert "holds 1 (300" in str(caught.value) and "2 (64" in str(caught.value)


def test_bodies_of_one_file_are_not_taken_for_each_other(tmp_path):
    path = files.written(tmp_path, TWO)
    one, two = load(path, body="1"), load(path, body="2")
    assert one.sha256 != two.sha256
    assert one.name != two.name
    assert one.inputs == two.inputs == load(files.written(tmp_path, TWO), body="1").inputs


def test_the_library_takes_a_number(tmp_path):
    path = files.written(tmp_path, TWO)
    assert mm3(feederscrew.load(path, body=2)) == pytest.approx(300.0)
    with pytest.raises(FeederError, match="body"):
        feederscrew.load(path, body=2.5)


def test_a_list_of_a_batch_takes_bodies(tmp_path):
    path = files.written(tmp_path, TWO)
    rows = io.StringIO()
    csv.writer(rows).writerows([("part", "body"), (path.name, "1"), (path.name, "largest")])
    (tmp_path / "parts.csv").write_text(rows.getvalue())
    requests = inputs.gather([str(tmp_path / "parts.csv")])
    assert [dict(request.options) for request in requests] == [{"body": "1"}, {"body": "largest"}]
    assert len({request.name for request in requests}) == 2


def test_a_part_card_is_of_one_body(tmp_path):
    assert "one body" in refused(b"mass: 1 g\n", body="1")


def test_every_command_that_reads_a_part_takes_a_body():
    from feederscrew_cli.main import COMMANDS, Commands

    reading = {name for name in COMMANDS if any(one.name == "units" for one in Commands()[name].params)}
    taking = {name for name in COMMANDS if any(one.name == "body" for one in Commands()[name].params)}
    assert reading == taking and len(reading) > 10


def test_the_command_takes_a_body(tmp_path, run):
    path = files.written(tmp_path, TWO)
    done = run("inertia", path, "--body", "1", "--format", "json")
    assert json.loads(done.stdout)["volume_mm3"] == pytest.approx(64.0)
    fault = run("inertia", path, "--body", "x")
    assert fault.exit_code == 2 and fault.stderr.startswith("Error: --body: ")
