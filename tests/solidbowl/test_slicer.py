"""A slicer, where one is installed, reads STL and 3MF of a bowl as one closed body that needs no repair."""

import shutil
import subprocess

import pytest
from test_solid import CHAINS, planned

from feederscrew.output import solid_files
from feederscrew.solidbowl.closed_body import body

SLICER = shutil.which("prusa-slicer")


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
