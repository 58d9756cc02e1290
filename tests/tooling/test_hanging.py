"""Headed parts hanging between rails: an orientation of its own from there on."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.errors import FeederError
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.falling import hangs_free
from feederscrew.tooling.fates import course
from feederscrew.tooling.orientations import Hanging, neck, orientations
from feederscrew.tooling.track_sections import until_returned
from feederscrew.tooling.verdicts import verdict

HEAD, SHANK, UNDER = 5e-3, 2e-3, 4e-3  # [m] radii, height of the head
SLOT = 6e-3


@pytest.fixture(scope="module")
def pin():
    head, shank = shapes.cylinder(5.0, 4.0, 64), shapes.cylinder(2.0, 20.0, 64)
    head.apply_translation([0, 0, 12.0])
    part = shapes.part(head.union(shank))
    track = bowls.read(None, ("track.radius=100 m", "track.width=200 mm", "track.bank=0 deg")).track
    return orientations(part, find(part), track)


def rails(every, width=SLOT):
    along = next(one for one in every if one.length > 0.02 and one.height < 0.012)
    return make_device("rails", "test", span=(along.distance - 0.5 * width, along.distance + 0.5 * width))


def test_what_hangs_by_one_head_is_one_orientation(pin):
    found = course([rails(pin)], pin)
    (hung,) = found.states[len(pin) :]
    assert isinstance(hung, Hanging)
    assert (hung.name, hung.kind) == ("hanging", "hanging")
    along = [k for k, one in enumerate(pin) if found.leaving[k, -1] > 0.0]
    assert len(along) == 2  # head ahead and head behind
    assert all(found.leaves_as(k) == len(pin) for k in along)
    assert hung.length == pytest.approx(2 * HEAD, rel=5e-3)
    assert hung.height == pytest.approx(UNDER)
    assert hung.posture.height < 0.0  # its centre of mass lies below the rails
    rest = math.sqrt(HEAD**2 - (0.5 * SLOT) ** 2)  # half the head's chord along the edge of the slot
    assert hung.gap == pytest.approx(rest, rel=5e-3)
    assert hung.balcony == pytest.approx(sum(rails(pin).span) / 2 + 0.5 * SLOT, rel=5e-3)


@pytest.mark.parametrize(
    ("device", "margin"),
    [
        (make_device("hold_down", "test", limit=4.5e-3), 0.5e-3),
        (make_device("wiper", "test", limit=3.8e-3), -0.2e-3),
        (make_device("gap", "test", limit=3.5e-3), 0.5e-3),
        (make_device("gap", "test", limit=4.3e-3), -0.3e-3),
    ],
)
def test_devices_behind_rails_judge_what_hangs(pin, device, margin):
    found = course([rails(pin), device], pin)
    hung = len(pin)
    assert found.verdicts[1][hung].margin == pytest.approx(margin, abs=2e-5)
    row = next(k for k, one in enumerate(found.verdicts[0]) if one is not None and one.hangs)
    assert found.leaving[row, hung] == float(margin > 0.0)
    met = until_returned([rails(pin), device], pin[row], pin)
    assert [one.orientation.name for one in met] == [pin[row].name, "hanging"]


def test_rails_may_narrow_and_widen(pin):
    first, last = rails(pin).span
    for by, margin in ((0.5e-3, 0.5e-3), (-1.5e-3, 0.5e-3), (-2.5e-3, -0.5e-3), (1.2e-3, -0.2e-3)):
        other = make_device("rails", "test", span=(first + by, last - by))
        found = course([rails(pin), other], pin)
        assert found.verdicts[1][len(pin)].margin == pytest.approx(margin, abs=3e-5)


def test_what_lies_over_the_slot_stands_beside_it_from_there_on(pin):
    across = next(k for k, one in enumerate(pin) if one.height > 0.023)
    wide, gap = rails(pin, 8e-3), make_device("gap", "test", limit=4e-3)
    assert course([gap], pin).leaving[across].sum() == 1.0  # half of 10 mm
    assert course([wide], pin).leaving[across].sum() == 1.0
    assert course([wide, gap], pin).leaving[across].sum() == 0.0  # 3 mm of the disc beside the slot


@pytest.mark.parametrize("line", ["pressure_break: 5 mm", "step: 5 mm", "tip: 5 mm"])
def test_a_device_without_meaning_for_hanging_parts_is_refused(tmp_path, line):
    path = tmp_path / "bowl.yaml"
    path.write_text(f"devices:\n  - rails: {{from: 4.5 mm, to: 8.5 mm}}\n  - {line}\n")
    kind = line.partition(":")[0]
    told = f"{path}:3:5: {kind} has no meaning for parts that hang between rails - list it before the rails"
    with pytest.raises(FeederError) as raised:
        bowls.read(path)
    assert str(raised.value) == told


def test_a_conical_head_rests_on_its_cone():
    turn = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rings = [(0.0, 2.0), (15.0, 2.0), (18.0, 5.0), (18.5, 5.0)]
    points = np.array([[r * np.cos(t), r * np.sin(t), z] for z, r in rings for t in turn])
    part = shapes.part(
        shapes.trimesh.convex.convex_hull(points[:96]).union(shapes.trimesh.convex.convex_hull(points[48:]))
    )
    track = bowls.read(None, ("track.radius=100 m", "track.width=200 mm", "track.bank=0 deg")).track
    every = orientations(part, find(part), track)
    row = next(k for k, one in enumerate(every) if one.length > 0.015)
    span = every[row].distance - 3e-3, every[row].distance + 3e-3
    hung = course([make_device("rails", "test", span=span)], every).states[-1]
    assert hung.name == "hanging"
    assert hung.height == pytest.approx(2.5e-3, abs=1e-4)  # the cone is 6 mm wide 2.5 mm below its top
    assert len(hung.foot.rings) == 2
    assert hung.margin > 0.0


def test_air_does_not_blow_off_what_rails_hold_and_a_groove_has_no_place_behind_them(pin, tmp_path):
    jet = make_device("jet", "test", nozzle=2e-3, pressure=1e5, height=2e-3)
    along = next(one for one in pin if one.length > 0.02 and one.height < 0.012)
    sorter = make_device("sorter", "test", like=(along.aspect, along.heading, 1e-3), sees="height")
    for device in (jet, sorter):
        found = course([rails(pin), device], [replace(one, grip=0.6, speed=0.02, swing=0.06) for one in pin])
        assert found.leaving[:, -1].sum() == pytest.approx(2.0)  # head ahead and head behind
    path = tmp_path / "bowl.yaml"
    path.write_text("devices:\n  - rails: {from: 4 mm, to: 8 mm}\n  - groove: {angle: 30 deg}\n")
    with pytest.raises(FeederError, match="no meaning for parts that hang"):
        course(bowls.read(path).devices, pin)


@pytest.mark.parametrize(("near", "sure"), [(3.05e-3, False), (3.15e-3, True)])  # head 5 mm, shank 2 mm
def test_a_head_that_touches_the_wall_may_wedge(pin, near, sure):
    along = next(one for one in pin if one.length > 0.02 and one.height < 0.012)
    device = make_device("rails", "test", span=(near, near + SLOT), lead=(1e-3, near + SLOT, 0.01, 0.01))
    found = verdict(device, replace(along, grip=0.1), pin)
    assert found.hangs and found.sure == sure


@pytest.mark.parametrize(("thick", "lever", "sure"), [(4.0, 0.21, True), (8.0, 0.03, False)])
def test_a_weight_near_the_end_of_a_head_does_not_turn_the_shank_down(thick, lever, sure):
    """A head 10 mm wide on a shank of 5.6 mm, 24 mm long in all."""
    head, shank = shapes.cylinder(5.0, thick, 32), shapes.cylinder(2.8, 24.0 - thick, 32)
    head.apply_translation([0, 0, 12.0])
    part = shapes.part(head.union(shank))
    every = orientations(
        part, find(part), bowls.read(None, ("track.radius=100 m", "track.width=60 mm")).track
    )
    one = next(k for k in every if k.length > 0.02 and neck(k) is not None)
    assert neck(one).lever / one.length == pytest.approx(lever, abs=0.02)
    assert hangs_free(one, (3.2e-3, 9.2e-3)) == sure and not hangs_free(one, (2.1e-3, 8.1e-3))
