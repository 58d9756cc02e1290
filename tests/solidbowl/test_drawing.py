"""The drawing sheet: its dimensions are those of the solid, and nothing lies beyond its frame."""

from types import SimpleNamespace

import numpy as np
import pytest
from test_solid import CHAINS, TRACK, planned
from test_stepped import STEEP, STEPPED

from feederscrew.bowl.settings import effective, record
from feederscrew.output.solidbowl import drawing_sheet
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.plan import SolidOptions

TALL = SolidOptions(outlet_height=0.15, left=True)
CASES = {
    "cylinder": (CHAINS["narrowed and rails"], TRACK, SolidOptions()),
    "tall and left": ((), TRACK, TALL),
    "stepped": (CHAINS["gap"], STEEP, STEPPED),
}


def study(solid):
    part = SimpleNamespace(name="pin", source="parts/pin.stl", material="steel")
    return SimpleNamespace(
        order=SimpleNamespace(part=part, target=1.0, wanted=None, hopper=0.01),
        bowl=record(effective({})), solid=solid, force=100.0, fill=SimpleNamespace(mass=1.0),
        stroke=SimpleNamespace(frequency=100.0, peak_to_peak=4e-4),
        springs=SimpleNamespace(natural_frequency=105.0), mismatch=None, turns=1.8,
    )  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_dimensions_are_those_of_the_solid_and_all_is_within_the_frame(name):
    devices, track, asked = CASES[name]
    solid = body(planned(devices, track=track, asked=asked, turns=1.8))
    paper = drawing_sheet.sheet(study(solid))
    told = [one.get_text() for one in paper.axes.texts]
    low, high = solid.vertices[:, 2].min(), solid.vertices[:, 2].max()
    assert f"{1e3 * (high - low):.4g}" in told
    assert f"{1e3 * solid.plan.outlet_height:.4g}" in told
    assert ("R150 at the outlet" if name == "stepped" else "Ø300") in told
    assert "track 20" in told and f"{solid.mass:.4g} kg, {1e9 * solid.volume:.6g} mm³" in told
    left, bottom, right, top = drawing_sheet.FRAME
    for some in paper.axes.collections:
        places = np.concatenate([path.vertices for path in some.get_paths()])
        assert (places >= np.array([left, bottom]) - 0.1).all()
        assert (places <= np.array([right, top]) + 0.1).all()
    places = np.concatenate([patch.get_path().vertices for patch in paper.axes.patches])
    assert (places[:, 1] <= top + 0.1).all()
