"""Single drops followed from launch to rest."""

from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.constants import g

from feederscrew.dropping import drop_test
from feederscrew.dropping.drop_test import telling
from feederscrew.output import drop
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.studies.drop import DropStudy

PARTS = Path(__file__).parents[2] / "parts"
MM = 1e-3


@pytest.fixture(scope="module")
def bracket():
    return followed(PARTS / "lbracket_30x20x15.stl")


def followed(path, preset="feed", count=8, drops=300, own=None, **more):
    """A part, its aspects and a test of it with some traces."""
    part = load(path)
    aspects = find(part)
    return part, aspects, drop_test.test(part, aspects, preset, own or {}, drops=drops, traced=count, **more)


def corners(part, trace):
    """(N, V, 3) [m] corners of the part over the plane, from its file's vertices."""
    arms = part.vertices - part.centre_of_mass
    return np.stack([turn.apply(arms) + place for turn, place in zip(trace.turns, trace.positions)])


def test_the_quaternion_puts_the_files_part_on_the_plane(bracket):
    part, _, result = bracket
    tolerance = 3e-3 * np.cbrt(part.hull.volume)
    for trace in result.traces:
        lowest = corners(part, trace)[:, :, 2].min(axis=1)
        assert lowest.min() > -tolerance
        assert lowest[trace.impacts] == pytest.approx(0.0, abs=tolerance)
        assert lowest[-1] == pytest.approx(0.0, abs=tolerance)


def test_the_end_rests_on_a_facet_of_the_counted_class(bracket):
    part, aspects, result = bracket
    tolerance = 2e-3 * np.cbrt(part.hull.volume)
    for trace in result.traces:
        face = result.ground.faces[trace.face]
        down = trace.turns[-1].apply(face.normal)
        assert trace.still and result.ground.rows[trace.face] == trace.row
        assert down == pytest.approx([0.0, 0.0, -1.0], abs=0.01)
        assert trace.positions[-1, 2] == pytest.approx(aspects.heights[trace.row], abs=tolerance)
        assert trace.energies[-1] == pytest.approx(aspects.heights[trace.row], abs=tolerance)


def test_a_part_falls_on_a_parabola_between_impacts(bracket):
    for trace in bracket[2].traces:
        first = np.argmax(trace.impacts)
        time, place = trace.times[: first + 1], trace.positions[: first + 1]
        assert place[0, :2] == pytest.approx([0.0, 0.0])
        speed = place[-1, :2] / time[-1]
        assert place[:, :2] == pytest.approx(time[:, None] * speed, abs=1e-9)
        assert place[:, 2] == pytest.approx(place[0, 2] - 0.5 * g * time**2, abs=1e-9)
        assert trace.energies[: first + 1] == pytest.approx(trace.energies[0], rel=1e-9)


def test_energy_is_never_won_and_lost_at_impacts(bracket):
    for trace in bracket[2].traces:
        assert np.diff(trace.energies).max() < 1e-9 * trace.energies[0]
        hits = np.flatnonzero(trace.impacts)
        assert (trace.energies[hits + 1] < trace.energies[hits]).all()
        assert trace.impacts[0] == np.False_ and (np.diff(trace.times) > 0.0).all()


@pytest.mark.parametrize("preset", ["place", "drop", "feed"])
def test_what_is_said_to_lie_still_lies_on_its_face(preset):
    part, aspects, result = followed(PARTS / "squarenut_m5.stl", preset, count=60, drops=60)
    tolerance = 4e-3 * np.cbrt(part.hull.volume)
    still = [trace for trace in result.traces if trace.still]
    assert len(still) > 0.9 * len(result.traces)
    for trace in still:
        assert trace.energies[-1] == pytest.approx(aspects.heights[trace.row], abs=tolerance)
    for trace in set(result.traces) - set(still):
        assert trace.times[-1] == trace.decided


def test_rows_are_no_further_apart_than_promised(bracket):
    second = np.sqrt(np.cbrt(bracket[0].hull.volume) / g)
    _, _, calm = followed(PARTS / "lbracket_30x20x15.stl", "drop", count=4, drops=4)
    for trace in (*bracket[2].traces, *calm.traces):
        assert np.diff(trace.times).max() < 2.001 * drop_test.ROW_INTERVAL * second
        first = np.argmax(trace.impacts)
        time, height = trace.times[: first + 1], trace.positions[: first + 1, 2]
        assert height == pytest.approx(height[0] - 0.5 * g * time**2, abs=1e-9)


def test_a_drop_that_never_settles_has_no_class(tmp_path):
    shapes.box(10.0, 13.0, 17.0).export(tmp_path / "box.stl")
    own = {"restitution": "1", "friction": "0"}
    part, aspects, result = followed(tmp_path / "box.stl", count=1, drops=2, own=own)
    (trace,) = result.traces
    assert result.tally.unsettled == 2
    assert trace.row == trace.face == -1 and not trace.still
    told = drop.traces(DropStudy(part, aspects, result))
    assert set(told["aspect"]) == {"none"} and told["event"][-1] != "still"
    drawn = drop.strip(part, aspects, trace, "box")
    assert any(
        "line: path of the centre of mass" in text.get_text()
        for text in drawn.axes[-1].texts + drawn.axes[0].texts
    )


def test_the_drop_shown_tumbles_if_one_does(bracket):
    _, _, result = bracket
    shown = telling(result.traces)
    assert shown.tumbled() and shown.still
    assert not any(trace.tumbled() and trace.still for trace in result.traces[: shown.number - 1])
    placed = followed(PARTS / "lbracket_30x20x15.stl", "place", own={"fall": "0.01 mm"})[2]
    calm = [trace for trace in placed.traces if not trace.tumbled()]
    assert telling(calm).number == calm[0].number


def test_stills_go_from_the_first_impact_to_the_end(bracket):
    _, aspects, result = bracket
    for trace in result.traces:
        rows = drop_test.chosen(trace, 12)
        assert rows[0] == np.argmax(trace.impacts) and rows[-1] == len(trace.times) - 1
        assert len(rows) == 12 and (np.diff(rows) > 0).all()
        end = drop.still_caption(trace, rows[-1], aspects.names, 0.0)
        assert end == f"{1e3 * trace.times[-1]:.0f} ms, rests on {aspects.names[trace.row]}"
        assert drop.still_caption(trace, rows[0], aspects.names, 0.0).endswith("ms, hits")
