"""A slicer, where one is installed, reads STL and 3MF of a bowl as one closed body that needs no repair."""

import shutil
import subprocess

import numpy as np
import pytest
from test_solid import CHAINS, planned
from test_stepped import STEEP

from feederscrew.output import solid_files
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.plan import SolidOptions

SLICER = shutil.which("prusa-slicer")


FLAT = SolidOptions(shape="stepped", chord=2e-4, outlet_height=0.03)
COARSE = ["--layer-height", "1", "--first-layer-height", "1", "--nozzle-diameter", "1.4",
          "--fill-density", "0%", "--bed-shape", "0x0,400x0,400x400,0x400"]  # fmt: skip


@pytest.mark.needs("prusa-slicer")
def test_a_slicer_takes_it_without_repair(tmp_path):
    solid = body(planned(CHAINS["narrowed and rails"], name="pla"))
    files = {"bowl.stl": solid_files.bowl_stl(solid), "bowl.3mf": solid_files.bowl_3mf(solid, "bowl")}
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
        told = subprocess.run([SLICER, "--info", name], cwd=tmp_path, capture_output=True, text=True).stdout
        found = dict(line.split(" = ") for line in told.splitlines() if " = " in line)
        assert found["manifold"].strip() == "yes" and found["number_of_parts"].strip() == "1"
        assert "repaired" not in told
        assert float(found["volume"]) == pytest.approx(solid.volume * 1e9, rel=1e-4)


@pytest.mark.needs("prusa-slicer")
def test_a_slicer_slices_both_files(tmp_path):
    solid = body(planned(CHAINS["gap"], asked=FLAT, track=STEEP, name="pla"))
    for name, content in (
        ("bowl.stl", solid_files.bowl_stl(solid)),
        ("bowl.3mf", solid_files.bowl_3mf(solid, "bowl")),
    ):
        (tmp_path / name).write_bytes(content)
        done = subprocess.run(
            [SLICER, "--export-gcode", *COARSE, "-o", "bowl.gcode", name],
            cwd=tmp_path, capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0 and "repair" not in (done.stdout + done.stderr).lower()
        layers = (tmp_path / "bowl.gcode").read_text().count(";LAYER_CHANGE")
        assert layers == pytest.approx(1e3 * np.ptp(solid.vertices[:, 2]), abs=1.0)
