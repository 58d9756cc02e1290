"""The drawing sheets: their dimensions are those of the solid, and nothing lies beyond its frame."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from test_solid import CHAINS, TRACK, planned
from test_stepped import STEEP, STEPPED

from feederscrew.bowl.settings import effective, record
from feederscrew.output import bowl_sheet
from feederscrew.output.drafting import FRAME
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
    drawing = bowl_sheet.draw_sheets(study(solid))
    told = drawing.texts(0)
    low, high = solid.vertices[:, 2].min(), solid.vertices[:, 2].max()
    assert f"{1e3 * (high - low):.2f}".rstrip("0").rstrip(".") in told
    assert f"{1e3 * solid.plan.outlet_height:.2f}".rstrip("0").rstrip(".") in told
    assert ("R150 at the outlet" if name == "stepped" else "Ø300") in told
    assert "track 20" in told and f"{solid.mass:.4g} kg, {1e9 * solid.volume:.6g} mm³" in told
    within_the_frame(drawing)


def within_the_frame(drawing):
    left, bottom, right, top = FRAME
    for number in range(len(drawing.sheets)):
        (axes,) = drawing.figure(number).axes
        drawn = [path.vertices for some in axes.collections for path in some.get_paths()]
        drawn += [patch.get_path().vertices for patch in axes.patches]
        places = np.concatenate(drawn)
        assert (places >= np.array([left, bottom]) - 0.1).all(), number
        assert (places <= np.array([right, top]) + 0.1).all(), number


@pytest.mark.parametrize("name", CASES)
def test_no_letters_of_a_sheet_lie_on_others(name):
    devices, track, asked = CASES[name]
    solid = body(planned(devices, track=track, asked=asked, turns=1.8))
    drawing = bowl_sheet.draw_sheets(study(solid))
    for number in range(len(drawing.sheets)):
        assert not overlapping(drawing.figure(number))


def overlapping(figure):
    """Pairs of texts whose boxes overlap by more than a tenth of a millimetre, and texts off the page."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    texts = [text for text in figure.findobj(Text) if text.get_text()]
    boxes = [text.get_window_extent(renderer) for text in texts]
    slack, (wide, high) = 0.1 * figure.dpi / 25.4, figure.canvas.get_width_height()
    found = [text.get_text() for text, box in zip(texts, boxes)
             if box.x0 < 0 or box.y0 < 0 or box.x1 > wide or box.y1 > high]  # fmt: skip
    for (one, a), (other, b) in itertools.combinations(zip(texts, boxes), 2):
        across = min(a.x1, b.x1) - max(a.x0, b.x0)
        upright = min(a.y1, b.y1) - max(a.y0, b.y0)
        if min(across, upright) > slack:
            found.append((one.get_text(), other.get_text()))
    return found
