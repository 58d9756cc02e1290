"""What is said of a STEP file that was opened again."""

from types import SimpleNamespace

import pytest

from feederscrew.output import solidbowl


@pytest.mark.parametrize(("stairs", "said"), [(None, False), (SimpleNamespace(shape="conical"), True)])
def test_a_wall_that_is_no_surface_of_revolution_is_said(stairs, said):
    step = SimpleNamespace(volume=1e-6, faces={"plane": 3}, off=1e-9)
    told = solidbowl._step(SimpleNamespace(step=step, plan=SimpleNamespace(stairs=stairs)))
    assert any("no surface of revolution" in one for one in told["not_exact"]) == said
    assert told["volume_mm3"] == pytest.approx(1e3) and told["track_off_mm"] == pytest.approx(1e-6)
