"""Parts ride the mesh of the finished bowl, and what becomes of them is what the analytic track says."""

from types import SimpleNamespace

import numpy as np
import on_mesh
import pytest
import shapes
from solids import RULES

from feederscrew import bowl as bowls
from feederscrew.base.running import RunSettings
from feederscrew.cad.closed_body import body
from feederscrew.cad.plan import SolidOptions, material, plan
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.trials import course

OWN = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=150 mm", "track.width=24 mm", "track.climb=2.5 deg",
    "track.bank=0 deg",
]  # fmt: skip
LYING = 0, 1  # on its broad side; the others would stand at the wiper for long
BLOCK = (20.0, 12.0, 5.0)  # [mm]


@pytest.fixture(scope="module")
def ridden(tmp_path_factory):
    """A block's bowl with a wiper and a narrowed track, as it is planned and as its mesh is."""
    path = tmp_path_factory.mktemp("bowl") / "bowl.yaml"
    path.write_text("devices:\n  - wiper: 8 mm\n  - narrowed_track: 8 mm\n")
    bowl, part = bowls.read(path, OWN), shapes.part(shapes.box(*BLOCK))
    every = orientations(part, find(part), bowl.track)
    size = SimpleNamespace(diameter=0.3, depth=0.045)
    tooled = lay_out(bowl.track, bowl.devices, every)
    extents, steel = np.array(BLOCK) * 1e-3, material("steel", RULES)
    made = body(plan(size, bowl.track, steel, tooled, SolidOptions(), extents=extents))
    return bowl, part, every, made, *on_mesh.ridden(made, bowl, every)


def test_the_mesh_measures_what_was_planned_and_parts_end_on_it_as_on_the_analytic_track(ridden):
    bowl, part, every, _, found, devices = ridden
    assert found.track.radius == pytest.approx(bowl.track.radius, abs=5e-5)
    assert found.track.width == pytest.approx(bowl.track.width, abs=5e-5)
    assert found.track.climb == pytest.approx(bowl.track.climb, abs=2e-4)
    assert found.track.bank == pytest.approx(0.0, abs=2e-3)
    for own, drawn in zip(devices, bowl.devices):
        mine, theirs = own.features(found.track, every), drawn.features(bowl.track, every)
        assert mine is not theirs and len(mine.openings) == len(theirs.openings)
        for one, other in ((a.ring, b.ring) for a, b in zip(mine.openings, theirs.openings)):
            inside = np.clip(other, -np.inf, [np.inf, bowl.track.width])
            assert one[:, 1].min() == pytest.approx(inside[:, 1].min(), abs=1.5e-4)
            assert np.ptp(one[:, 0]) == pytest.approx(np.ptp(inside[:, 0]), abs=3e-4)
        for one, other in zip(mine.blades, theirs.blades):
            assert one.solid.bounds[1] == pytest.approx(other.solid.bounds[1], abs=1.5e-4)
    # A part ends on it as on the analytic track.
    sent, tracks = course.SentParts(LYING, 2), ((bowl, bowl.devices), (found, devices))
    seen = [course.course(part, own, every, sent, some, run=RunSettings(3)) for own, some in tracks]
    np.testing.assert_array_equal(seen[1].fates, seen[0].fates)
    np.testing.assert_array_equal(seen[1].end_stations, seen[0].end_stations)
    assert list(seen[0].fates) == [course.PASSED, course.RETURNED]  # along the wall and across it
    assert (seen[1].depths < 2.5e-4).all()
