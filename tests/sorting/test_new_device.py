"""A device of a kind of its own, added in one file: every command and every drawing knows it."""

import io
import json

import numpy as np
import pytest
import trimesh
from click.testing import CliRunner
from on_track import block, lying, read

from feederscrew.base.value_forms import pattern
from feederscrew.bowl import devices
from feederscrew.bowl.devices import kinds
from feederscrew.bowl.documentation import json_schema
from feederscrew.sorting.isolating import chain
from feederscrew_cli.main import feeder

FILE = '''
"""A strip removed along the wall, by another name."""

from feederscrew.base import value_forms as forms
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.base import Device, room_of
from feederscrew.bowl.devices.features import Features, TrackOpening, box_ring
from feederscrew.bowl.devices.trade import Action, Bound, ProposedBy, Trade, ValueSearch


class Ravine(Device):
    kind = "ravine"
    own = forms.LENGTH_FORM | {"title": "its width"}
    trade = Trade("8 mm", "strip along the wall", own, measures="what lies beside it")
    action = Action.CUT
    search = ValueSearch(ProposedBy.VALUE, Bound.LOWER, rank=1)

    @classmethod
    def needed(cls, one):
        return one.canyon
    @classmethod
    def read(cls, entry):
        return values.length(entry)
    def features(self, track, every):
        room, span = room_of(every), (0.0, self.limit)
        return Features(room, openings=(TrackOpening(box_ring(0.0, room, *span), span),))
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
    trimesh.creation.box((20, 12, 5)).export(tmp_path / "block.stl")
    yield read(tmp_path, "ravine: 8 mm", track="{width: 30 mm}")
    kinds.KINDS.pop("ravine")


def test_a_device_added_in_one_file_is_known_everywhere(ravine, tmp_path):
    part, out = str(tmp_path / "block.stl"), tmp_path / "out"

    def ran(command, *words):
        own = ["--config", str(tmp_path / "bowl.yaml"), "--rule", "csa", *words]
        result = CliRunner().invoke(feeder, [command, part, *own], catch_exceptions=False)
        assert result.exit_code == 0, result.output
        return result.stdout

    rows = json.loads(ran("rate", "--aspect", "A", "--format", "json"))["orientations"]
    passes = {round(row["length_mm"]): row["ravine_1"] for row in rows if row["aspect"] == "A"}
    assert passes == {20: 0.0, 12: 1.0}
    ran("tooling", "--aspect", "A", "--heading", "90", "--static", "-o", str(out))
    files = {path.name: path for path in out.rglob("*")}
    drawn = files["tooling.dxf"].read_text()
    assert all(word in drawn for word in ("ravine", "8 mm", "CUT"))
    assert "ravine: 8 mm" in files["tooling.yaml"].read_text()
    mesh = trimesh.load(io.BytesIO(files["tooling.stl"].read_bytes()), file_type="stl")
    assert mesh.is_watertight and (np.abs(mesh.triangles_center[:, 2]) < 1e-6).any()
    assert files["tooling.png"].stat().st_size > 1000
    entry = json_schema()["properties"]["devices"]["items"]["properties"]["ravine"]
    assert (entry["title"], entry["pattern"]) == ("its width", pattern("length"))
    rows = json.loads(ran("trial", "--parts", "8", "--format", "json"))["orientations"]
    passed = {(row["aspect"], round(row["heading_deg"])): row["passed"] for row in rows if row["tried"]}
    assert passed["A", 0] == 0 and passed["A", 90] > 0
    every = lying(block(), ravine.track)
    across = next(k for k, one in enumerate(every) if one.width == pytest.approx(20e-3, abs=2e-4))
    (proposed,) = [one for one in chain.candidates(every, across, 5e-4) if one.kind == "ravine"]
    assert proposed.limit == pytest.approx(10e-3 - 5e-4, abs=2e-4)  # half its width, less the margin
