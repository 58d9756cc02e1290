"""Files that ask for more than they hold: nested 3MF components, STEP files that take for ever."""

import io
import subprocess
import sys
import time
import zipfile

import pytest

from feederscrew.errors import MeshError
from feederscrew.part import load, loading, scenes

NEEDS_3MF = pytest.mark.needs("lxml", "networkx")

MODEL = (
    '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
    '<object id="1" type="model"><mesh><vertices>{}</vertices><triangles>{}</triangles></mesh></object>{}'
    '</resources><build><item objectid="{}"/></build></model>'
)
CORNERS = ((0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def nested(components, build):
    """A 3MF of one tetrahedron and objects made of others: (id, (other, ...)) each."""
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in CORNERS)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in FACES)
    objects = "".join(
        f'<object id="{name}" type="model"><components>'
        + "".join(f'<component objectid="{inner}"/>' for inner in others)
        + "</components></object>"
        for name, others in components
    )
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", MODEL.format(vertices, triangles, objects, build))
        archive.writestr("_rels/.rels", "<Relationships/>")
    return file.getvalue()


@NEEDS_3MF
@pytest.mark.parametrize(
    ("components", "build", "reason"),
    [
        ([(k, [k - 1] * 10) for k in range(2, 9)], 8, "its components stand for more than 5000 bodies"),
        ([(k, [k - 1]) for k in range(2, 60)], 59, "components within components more than 50 deep"),
        ([(2, [3]), (3, [2])], 2, "components within components more than 50 deep"),
    ],
    ids=["wide", "deep", "round"],
)
def test_nested_components_are_counted_before_they_are_placed(tmp_path, components, build, reason):
    path = tmp_path / "bomb.3mf"
    path.write_bytes(nested(components, build))
    start = time.perf_counter()
    with pytest.raises(MeshError) as caught:
        load(path)
    assert str(caught.value) == f"{path}: is a damaged 3MF ({reason}) - export the part again"
    assert time.perf_counter() - start < 5.0


@pytest.mark.needs("cascadio")
def test_a_step_file_that_takes_too_long_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(scenes, "STEP_TIMEOUT_S", 1)
    monkeypatch.setattr(scenes, "CONVERT_STEP_SCRIPT", "import time; time.sleep(30)")
    path = tmp_path / "part.step"
    path.write_bytes(b"ISO-10303-21;")
    with pytest.raises(MeshError) as caught:
        load(path)
    reason = "not converted within 1 s"
    assert str(caught.value) == f"{path}: is a damaged STEP ({reason}) - export the part again"


def test_a_stream_without_end_is_given_up_at_half_a_gigabyte(monkeypatch):
    """It was read up to 1 GB, which took 1.09 GB."""

    class Endless(io.RawIOBase):
        given = 0

        def read(self, count):
            self.given += count
            return bytes(count)

    assert loading.MAX_MESH_BYTES == 512 << 20
    monkeypatch.setattr(loading, "MAX_MESH_BYTES", 3 << 20)
    stream = Endless()
    with pytest.raises(MeshError, match="standard input: is larger than 3 MB - export it with fewer facets"):
        load("-", stdin=stream)
    assert stream.given == (3 << 20) + 1


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for it")
def test_the_converter_of_step_ends_with_its_parent():
    waits = (
        scenes.CONVERT_STEP_SCRIPT.partition("import cascadio")[0]
        + "print(1, flush=True); import time; time.sleep(50)"
    )
    parent = (
        "import subprocess, sys, time;"
        "child = subprocess.Popen([sys.executable, '-c', sys.argv[1]], stdout=subprocess.PIPE);"
        "child.stdout.readline(); print(child.pid, flush=True); time.sleep(50)"
    )
    call = [sys.executable, "-c", parent, waits]
    with subprocess.Popen(call, stdout=subprocess.PIPE, text=True) as made:
        child = int(made.stdout.readline())
        made.kill()
    assert _gone(child)


def _gone(process):
    """Whether a process ends within five seconds; one that nobody waited for counts as ended."""
    from pathlib import Path

    for _ in range(50):
        stat = Path(f"/proc/{process}/stat")
        if not stat.exists() or stat.read_text().rsplit(")", 1)[1].split()[0] == "Z":
            return True
        time.sleep(0.1)
    return False
