"""A device of a kind of its own, added in one file: every command and every drawing knows it."""

import io
import json

import numpy as np
import pytest
import trimesh
from click.testing import CliRunner

from feederscrew.bowl import read
from feederscrew.bowl.documentation import json_schema
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.tooling import devices
from feederscrew.tooling.devices import kinds
from feederscrew.tooling.isolating import chain
from feederscrew.tooling.orientations import orientations
from feederscrew.value_forms import pattern
from feederscrew_cli.main import feeder

FILE = '''
"""A strip removed along the wall, by another name."""

from feederscrew import value_forms as forms
from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import Device


class Ravine(Device):
    kind = "ravine"
    form = forms.LENGTH_FORM | {"title": "its width"}
    example = "8 mm"
    meaning = "strip along the wall"
    picture = "above"
    bound = "lower"
    proposed = True
    rank = 1
    feature = "what lies beside it"

    @classmethod
    def needed(cls, one):
        return one.canyon

    @classmethod
    def read(cls, entry):
        return values.length(entry)

    def span_on(self, track):
        return 0.0, self.limit

    def judged(self, met):
        return met.verdict(met.over_span((0.0, self.limit)))
'''


@pytest.fixture
def ravine(tmp_path, monkeypatch):
    folder = tmp_path / "kinds"
    folder.mkdir()
    (folder / "ravine.py").write_text(FILE)
    monkeypatch.setattr(devices, "__path__", [*devices.__path__, str(folder)])
    kinds.register_kinds()
    trimesh.creation.box((0.02, 0.012, 0.005)).apply_scale(1e3).export(tmp_path / "block.stl")
    (tmp_path / "bowl.yaml").write_text("track: {width: 30 mm}\ndevices:\n  - ravine: 8 mm\n")
    yield tmp_path
    kinds.KINDS.pop("ravine")


def test_a_device_added_in_one_file_is_known_everywhere(ravine):
    part, bowl = str(ravine / "block.stl"), ["--config", str(ravine / "bowl.yaml")]

    def ran(*words):
        found = CliRunner().invoke(feeder, [*words, *bowl], catch_exceptions=False)
        assert found.exit_code == 0, found.output
        return found.stdout

    rows = json.loads(ran("rate", part, "--aspect", "A", "--rule", "csa", "--format", "json"))["orientations"]
    passes = {round(row["length_mm"]): row["ravine_1"] for row in rows if row["aspect"] == "A"}
    assert passes == {20: 0.0, 12: 1.0}
    out = ravine / "out"
    ran("tooling", part, "--aspect", "A", "--heading", "90", "--rule", "csa", "--static", "-o", str(out))
    files = {path.name: path for path in out.rglob("*")}
    drawn = files["tooling.dxf"].read_text()
    assert all(word in drawn for word in ("ravine", "8 mm", "CUT"))
    assert "ravine: 8 mm" in files["tooling.yaml"].read_text()
    mesh = trimesh.load(io.BytesIO(files["tooling.stl"].read_bytes()), file_type="stl")
    assert mesh.is_watertight
    over = mesh.triangles_center[np.abs(mesh.triangles_center[:, 2]) < 1e-6]
    assert len(over) and files["tooling.png"].stat().st_size > 1000
    made = json_schema()["properties"]["devices"]["items"]["properties"]["ravine"]
    assert (made["title"], made["pattern"]) == ("its width", pattern("length"))
    tried = json.loads(ran("trial", part, "--parts", "8", "--rule", "csa", "--format", "json"))[
        "orientations"
    ]
    passed = {(row["aspect"], round(row["heading_deg"])): row["passed"] for row in tried if row["tried"]}
    assert passed["A", 0] == 0 and passed["A", 90] > 0
    block = load(part)
    every = orientations(block, find(block), read(bowl[1]).track)
    across = next(k for k, one in enumerate(every) if one.width == pytest.approx(20e-3, abs=2e-4))
    (proposed,) = [one for one in chain.candidates(every, across, 5e-4) if one.kind == "ravine"]
    assert proposed.limit == pytest.approx(10e-3 - 5e-4, abs=2e-4)  # half its width, less the margin
