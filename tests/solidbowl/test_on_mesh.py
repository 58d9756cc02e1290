"""Parts ride the mesh of the finished bowl, and what becomes of them is what the analytic track says."""

from types import SimpleNamespace

import numpy as np
import on_mesh
import pytest
import shapes
from test_solid import RULES

from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.solidbowl import cuts
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.plan import SolidOptions, material, plan
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import course

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
    tooled = cuts.stretch(bowl.track, bowl.devices, every)
    planned = plan(
        size, bowl.track, material("steel", RULES), tooled, SolidOptions(), extents=np.array(BLOCK) * 1e-3
    )
    made = body(planned)
    return bowl, part, every, made, *on_mesh.ridden(made, bowl, every)


def test_the_mesh_measures_what_was_planned(ridden):
    bowl, _, every, _, found, devices = ridden
    assert found.track.radius == pytest.approx(bowl.track.radius, abs=5e-5)
    assert found.track.width == pytest.approx(bowl.track.width, abs=5e-5)
    assert found.track.climb == pytest.approx(bowl.track.climb, abs=2e-4)
    assert found.track.bank == pytest.approx(0.0, abs=2e-3)
    for own, drawn in zip(devices, bowl.devices):
        mine, theirs = own.standing(found.track, every), drawn.standing(bowl.track, every)
        assert mine is not theirs and len(mine.holes) == len(theirs.holes)
        for one, other in zip(mine.holes, theirs.holes):
            inside = np.clip(other.outline, -np.inf, [np.inf, bowl.track.width])
            assert one.outline[:, 1].min() == pytest.approx(inside[:, 1].min(), abs=1.5e-4)
            assert np.ptp(one.outline[:, 0]) == pytest.approx(np.ptp(inside[:, 0]), abs=3e-4)
        for one, other in zip(mine.blades, theirs.blades):
            assert one.solid.bounds[1] == pytest.approx(other.solid.bounds[1], abs=1.5e-4)


def test_a_part_ends_on_the_mesh_as_on_the_analytic_track(ridden):
    bowl, part, every, _, found, devices = ridden
    seen = [
        course.course(part, own, every, course.Sending(LYING, 2), some, run=RunSettings(3))
        for own, some in ((bowl, bowl.devices), (found, devices))
    ]
    np.testing.assert_array_equal(seen[1].fates, seen[0].fates)
    np.testing.assert_array_equal(seen[1].ended, seen[0].ended)
    assert list(seen[0].fates) == [course.PASSED, course.RETURNED]  # along the wall and across it
    assert (seen[1].depths < 2.5e-4).all()


HELD = 4  # [deg] of bank that holds parts at the wall: on a level track a bank of 1e-5 rad may decide
OTHERS = {
    "a plate over a gap": (shapes.box(16.0, 10.0, 3.0), "wiper: 6 mm", "gap: 9 mm", 20, HELD),
    "a block on a banked track": (shapes.box(*BLOCK), "wiper: 8 mm", "narrowed_track: 8 mm", 24, 6),
}


@pytest.mark.parametrize("name", OTHERS)
def test_other_parts_end_on_the_mesh_as_on_the_analytic_track(name, tmp_path):
    part, *devices, width, bank = OTHERS[name]
    path = tmp_path / "bowl.yaml"
    path.write_text("devices:\n" + "".join(f"  - {one}\n" for one in devices))
    bowl = bowls.read(path, [*OWN, f"track.width={width} mm", f"track.bank={bank} deg"])
    part = shapes.part(part)
    every = orientations(part, find(part), bowl.track)
    size, extents = SimpleNamespace(diameter=0.3, depth=0.05), np.ptp(np.asarray(part.vertices), axis=0)
    tooled = cuts.stretch(bowl.track, bowl.devices, every)
    made = body(plan(size, bowl.track, material("steel", RULES), tooled, SolidOptions(), extents=extents))
    found, stations = on_mesh.ridden(made, bowl, every)
    assert np.degrees(found.track.bank) == pytest.approx(bank, abs=0.1)
    rows = tuple(range(min(4, len(every))))
    seen = [
        course.course(part, own, every, course.Sending(rows, len(rows)), some, run=RunSettings(3))
        for own, some in ((bowl, bowl.devices), (found, stations))
    ]
    np.testing.assert_array_equal(seen[1].fates, seen[0].fates)
    assert len(set(seen[0].fates)) > 1  # not one and the same for all


LEANING = {
    "a wiper and a narrowed track in a stepped bowl": (
        "stepped",
        ("wiper: 5 mm", "narrowed_track: 5 mm"),
        14,
    ),
    "a track too narrow for some in a cone": ("conical", (), 5),
}
PLATE = (12.0, 8.0, 3.0)  # [mm]


@pytest.mark.parametrize("name", LEANING)
def test_parts_end_alike_where_the_wall_steps_out_or_leans(name, tmp_path):
    shape, devices, width = LEANING[name]
    path = tmp_path / "bowl.yaml"
    path.write_text("devices:" + ("".join(f"\n  - {one}" for one in devices) or " []") + "\n")
    bowl = bowls.read(
        path, [*OWN, f"track.width={width} mm", f"track.bank={HELD} deg", "track.climb=2.6 deg"]
    )
    part = shapes.part(shapes.box(*PLATE))
    every = orientations(part, find(part), bowl.track)
    tooled = cuts.stretch(bowl.track, bowl.devices, every) if devices else None
    asked, size = SolidOptions(shape=shape), SimpleNamespace(diameter=0.3, depth=0.05)
    made = body(
        plan(size, bowl.track, material("steel", RULES), tooled, asked, extents=np.array(PLATE) / 1e3)
    )
    found, stations = on_mesh.ridden(made, bowl, every)
    assert made.plan.turns > 1.1
    assert found.track.width == pytest.approx(bowl.track.width, abs=5e-5)
    assert found.track.climb == pytest.approx(bowl.track.climb, abs=2e-5)
    rows = tuple(range(len(every)))
    seen = [
        course.course(part, own, every, course.Sending(rows, len(rows)), some, run=RunSettings(3))
        for own, some in ((bowl, bowl.devices), (found, stations))
    ]
    np.testing.assert_array_equal(seen[1].fates, seen[0].fates)
    np.testing.assert_array_equal(seen[1].ended, seen[0].ended)
    assert len(set(seen[0].fates)) > 1
