"""The bowl as STEP: opened again it is the bowl of the facets, its track nearer to the formula."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from test_solid import CHAINS, TRACK, planned

from feederscrew.errors import FeederError
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.exact import exact_body
from feederscrew.solidbowl.exact.exact_file import step_file
from feederscrew.solidbowl.plan import SolidOptions


@pytest.mark.needs("OCP")
def test_what_is_opened_again_is_the_bowl():
    asked, track = SolidOptions(left=True, outlet_angle=0.5), replace(TRACK, bank=np.radians(6.0))
    made = body(planned(CHAINS["narrowed and rails"], track=track, asked=asked, turns=0.6))
    found = step_file(made)
    assert found.data.startswith(b"ISO-10303-21;") and b"'bowl'" in found.data
    assert found.volume == pytest.approx(made.volume, rel=1e-3)
    assert found.volume > made.volume  # chords lie within an arc, and there is more outside than inside
    assert found.off < 1e-7
    assert found.faces["cylinders"] >= 10 and found.faces["cones"] == 2 and found.faces["ruled"] >= 20
    assert step_file(made).data == found.data


def test_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "OCP.STEPControl", None)
    with pytest.raises(FeederError, match=r"^step: needs OpenCASCADE, which is not installed - pip install"):
        exact_body.check()


@pytest.mark.long
@pytest.mark.needs("OCP")
@pytest.mark.parametrize(
    ("shape", "turns", "climb", "width"),
    [
        ("conical", 0.9, 6.24, 29.1e-3),  # lost wall and floor where edges had to meet exactly
    ],
)
def test_a_wall_that_steps_outwards_is_the_bowl_of_the_facets(shape, turns, climb, width):
    track = replace(TRACK, climb=np.radians(climb), width=width)
    made = body(planned(CHAINS["none"], track=track, asked=SolidOptions(shape=shape), turns=turns))
    found = step_file(made)
    assert found.volume == pytest.approx(made.volume, rel=1.5e-3)
    assert found.volume > made.volume
    assert found.off < 1e-7
    assert found.faces["cones"] == 2 and found.faces["ruled"] >= 40
