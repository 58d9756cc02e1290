"""Single drops followed from launch to rest."""

from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.constants import g

from feederscrew.arrivals import drop_test
from feederscrew.arrivals.drop import DropStudy
from feederscrew.arrivals.drop_test import telling
from feederscrew.output import drop
from feederscrew.part import load
from feederscrew.resting.aspects import find

PARTS = Path(__file__).parents[2] / "parts"
BRACKET = PARTS / "lbracket_30x20x15.stl"


def followed(path, preset="feed", count=8, drops=300, own=None):
    part = load(path)
    aspects = find(part)
    return part, aspects, drop_test.test(part, aspects, preset, own or {}, drops=drops, traced=count)


@pytest.fixture(scope="module")
def bracket():
    return followed(BRACKET)


def assert_falls(trace, width):
    """Rows until the first impact are on a parabola, and all are no further apart than promised."""
    first = np.argmax(trace.impacts)
    time, place = trace.times[: first + 1], trace.positions[: first + 1]
    assert place[0, :2] == pytest.approx([0.0, 0.0])
    assert place[:, :2] == pytest.approx(time[:, None] * place[-1, :2] / time[-1], abs=1e-9)
    assert place[:, 2] == pytest.approx(place[0, 2] - 0.5 * g * time**2, abs=1e-9)
    assert trace.energies[: first + 1] == pytest.approx(trace.energies[0], rel=1e-9)
    assert np.diff(trace.times).max() < 2.001 * drop_test.ROW_INTERVAL * np.sqrt(width / g)


def test_a_trace_from_launch_to_rest(bracket):
    part, aspects, result = bracket
    width = np.cbrt(part.hull.volume)
    for trace in result.traces:
        assert_falls(trace, width)
        # The quaternion puts the file's part on the plane.
        arms = part.vertices - part.centre_of_mass
        lowest = np.array([
            (turn.apply(arms) + place)[:, 2].min() for turn, place in zip(trace.turns, trace.positions)
        ])  # fmt: skip
        assert lowest.min() > -3e-3 * width
        assert lowest[[*np.flatnonzero(trace.impacts), -1]] == pytest.approx(0.0, abs=3e-3 * width)
        # Energy is never won, and lost at impacts.
        assert np.diff(trace.energies).max() < 1e-9 * trace.energies[0]
        hits = np.flatnonzero(trace.impacts)
        assert (trace.energies[hits + 1] < trace.energies[hits]).all()
        assert trace.impacts[0] == np.False_ and (np.diff(trace.times) > 0.0).all()
        # The end rests on a facet of the class that is counted.
        down = trace.turns[-1].apply(result.ground.faces[trace.face].normal)
        assert trace.still and result.ground.rows[trace.face] == trace.row
        assert down == pytest.approx([0.0, 0.0, -1.0], abs=0.01)
        end = (trace.positions[-1, 2], trace.energies[-1])
        assert end == pytest.approx([aspects.heights[trace.row]] * 2, abs=2e-3 * width)
        # Stills go from the first impact to the end.
        rows = drop_test.chosen(trace, 12)
        assert rows[0] == np.argmax(trace.impacts) and rows[-1] == len(trace.times) - 1
        assert len(rows) == 12 and (np.diff(rows) > 0).all()
        end = drop.still_caption(trace, rows[-1], aspects.names, 0.0)
        assert end == f"{1e3 * trace.times[-1]:.0f} ms, rests on {aspects.names[trace.row]}"
        assert drop.still_caption(trace, rows[0], aspects.names, 0.0).endswith("ms, hits")
    for trace in followed(BRACKET, "drop", count=4, drops=4)[2].traces:
        assert_falls(trace, width)


def test_a_drop_that_never_settles_has_no_class(tmp_path):
    shapes.box(10.0, 13.0, 17.0).export(tmp_path / "box.stl")
    own = {"restitution": "1", "friction": "0"}
    part, aspects, result = followed(tmp_path / "box.stl", count=1, drops=1, own=own)
    (trace,) = result.traces
    assert result.tally.unsettled == 1
    assert trace.row == trace.face == -1 and not trace.still
    table = DropStudy(part, aspects, result).traces_table()
    assert set(table["aspect"]) == {"none"} and table["event"][-1] != "still"
    axes = drop.strip(part, aspects, trace, "box").axes
    texts = [text.get_text() for text in axes[-1].texts + axes[0].texts]
    assert any("line: path of the centre of mass" in text for text in texts)


def test_the_drop_shown_tumbles_if_one_does(bracket):
    traces = bracket[2].traces
    shown = telling(traces)
    assert shown.tumbled() and shown.still
    assert not any(trace.tumbled() and trace.still for trace in traces[: shown.number - 1])
    placed = followed(BRACKET, "place", own={"fall": "0.01 mm"})[2]
    calm = [trace for trace in placed.traces if not trace.tumbled()]
    assert telling(calm).number == calm[0].number
