"""Several bodies in a file: one taken by number, size or name, or all as one part."""

import json
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import trimesh
from readings import loaded, mm3, refused

import feederscrew
from feederscrew.base.errors import FeederError
from feederscrew.jobs.batch import inputs
from feederscrew.part import load

DATA = Path(__file__).parents[1] / "data"
SMALL, LARGE = files.box((4.0, 4.0, 4.0)), files.box((10.0, 6.0, 5.0), (20.0, 0.0, 0.0))
TWO = files.binary_stl(np.concatenate([SMALL, LARGE]))
CAVITY = files.inside_out(files.box((2.0, 2.0, 2.0), (21.0, 1.0, 1.0)))
CUBE = files.box((10, 10, 10))


def named(format):
    if format == "stl":
        return files.ascii_stl(SMALL, "pin") + files.ascii_stl(LARGE, "Big block")
    if format == "obj":
        lines = files.obj(LARGE).decode().splitlines()
        faces = [" ".join(str(int(k) + 36) for k in line.split()[1:]) for line in lines if line[0] == "f"]
        large = ["o Big block", *(line for line in lines if line[0] == "v"), *(f"f {face}" for face in faces)]
        return b"o pin\n" + files.obj(SMALL) + "\n".join([*large, ""]).encode()
    scene = trimesh.Scene()
    for name, triangles in (("pin", SMALL), ("Big block", LARGE)):
        scaled = triangles / (1000.0 if format == "glb" else 1.0)
        mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(scaled))
        scene.add_geometry(mesh, node_name=name, geom_name=name)
    return scene.export(file_type=format)


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
    volumes = [mm3(loaded(data, body=name)) for name in ("pin", "big BLOCK")]
    assert volumes == pytest.approx([64.0, 300.0], rel=1e-6)
    line = refused(data)
    assert "'pin'" in line and "'Big block'" in line and "`body`" in line


@pytest.mark.needs("cascadio")
def test_two_solids_of_a_step_file():
    """Two housings of 20 x 10 x 6 mm, each with a hole of 5 mm through its 6 mm: 1082.2 mm3."""
    part = loaded((DATA / "two_solids.step").read_bytes(), body="2")
    assert "body 2 'Gehäuse" in part.warnings[0]
    assert mm3(part) == pytest.approx(1200.0 - 2.5**2 * np.pi * 6.0, abs=0.5)


@pytest.mark.parametrize("body", ["0", "3", "-1", "1.0", "second", "", "99999999999", "\u0662", "\x1b[31m"])
def test_a_body_that_is_not_there_is_a_line(body):
    line = refused(TWO, body=body)
    assert line.startswith("body: ") and "largest" in line and line.isprintable()


def test_what_belongs_to_one_body():
    data = files.binary_stl(np.concatenate([CAVITY, SMALL, LARGE]))
    assert [mm3(loaded(data, body=body)) for body in "12"] == pytest.approx([292.0, 64.0])
    # Each side of a box tessellated by itself, 2e-4 mm off: six sides are no six bodies.
    moved = LARGE + np.random.default_rng(3).uniform(-1e-4, 1e-4, (6, 1, 3))[np.arange(12) % 6]
    line = refused(files.binary_stl(np.concatenate([moved, SMALL])), body="7")
    assert "holds 1 (300" in line and "2 (64" in line
    data = files.ascii_stl(SMALL, "pin") + files.ascii_stl(LARGE, "pin")
    assert "1 and 2" in refused(data, body="pin")
    assert "one body" in refused(b"mass: 1 g\n", body="1")


def test_bodies_of_one_file_are_not_taken_for_each_other_here_or_in_a_batch(tmp_path):
    path = files.written(tmp_path, TWO)
    first, second = load(path, body="1"), feederscrew.load(path, body=2)
    assert mm3(second) == pytest.approx(300.0)
    assert first.sha256 != second.sha256 and first.name != second.name
    assert first.inputs == second.inputs == load(files.written(tmp_path, TWO), body="1").inputs
    with pytest.raises(FeederError, match="body"):
        feederscrew.load(path, body=2.5)
    (tmp_path / "parts.csv").write_text("part,body\r\npart.stl,1\r\npart.stl,largest\r\n")
    files.written(tmp_path, TWO)
    requests = inputs.gather([str(tmp_path / "parts.csv")])
    assert [dict(request.options) for request in requests] == [{"body": "1"}, {"body": "largest"}]
    assert len({request.name for request in requests}) == 2


def test_every_command_that_reads_a_part_takes_a_body(tmp_path, run):
    from feederscrew_cli.main import COMMANDS, Commands

    options = {name: {option.name for option in Commands()[name].params} for name in COMMANDS}
    reading = {name for name in COMMANDS if "units" in options[name]}
    assert reading == {name for name in COMMANDS if "body" in options[name]} and len(reading) > 10
    path = files.written(tmp_path, TWO)
    answer = run("inertia", path, "--body", "1", "--format", "json")
    assert json.loads(answer.stdout)["volume_mm3"] == pytest.approx(64.0)
    fault = run("inertia", path, "--body", "x")
    assert fault.exit_code == 2 and fault.stderr.startswith("Error: --body: ")


def together(*bodies):
    return loaded(files.obj(np.concatenate(bodies)), allow_open=True)


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("second", [False, True])
def test_bodies_apart_are_added_however_they_face(first, second):
    pairs = ((CUBE, first), (SMALL + [20, 0, 0], second))
    part = together(*(files.inside_out(body) if turn else body for body, turn in pairs))
    assert mm3(part) == pytest.approx(1064.0)  # it was 936 where one is inside out
    assert part.centre_of_mass[0] * 1e3 == pytest.approx((1000 * 5 + 64 * 22) / 1064)
    assert any("reversed" in text for text in part.warnings) == (first != second)


def test_cavities_and_chains_of_bodies():
    cavity = files.inside_out(SMALL + 3.0)
    bodies = CUBE, cavity, files.inside_out(np.concatenate([CUBE, cavity]) + [20, 0, 0])
    assert mm3(together(*bodies)) == pytest.approx(2 * (1000 - 64))
    assert mm3(together(*bodies, files.box((1, 1, 1), (4.5, 4.5, 4.5)))) == pytest.approx(2 * 936 + 1)
    part = together(*(files.box((4, 4, 4), (3 * k, 0, 0)) for k in range(3)))
    whole = loaded(files.binary_stl(files.box((10, 4, 4))))
    assert mm3(part) == pytest.approx(160.0)
    np.testing.assert_allclose(part.inertia, whole.inertia, atol=1e-9 * whole.inertia.max())
    triangles = np.concatenate([CUBE, files.inside_out(SMALL + [8, 3, 3])])
    line = refused(files.binary_stl(triangles), allow_open=True)
    assert "crosses" in line and "allow_open" not in line


@pytest.mark.parametrize(
    ("offset", "word"),
    [((8, 3, 3), "overlap"), ((8, 0, 0), "overlap"), ((6, 6, 6), "overlap"), ((3, 3, 3), "cavity")],
)
def test_bodies_that_overlap_are_united(offset, word):
    overlap = float(np.prod(np.clip(10.0 - np.array(offset), 0.0, 4.0)))
    part = together(CUBE, SMALL + np.array(offset))
    assert mm3(part) == pytest.approx(1064.0 - overlap)  # it was 1064, without a word
    assert any(word in text for text in part.warnings)
    edges = np.sort(part.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] % 2 == 0).all()  # closed
