"""A groove: where a part comes to lie in a V, what it does to the chain, and what is drawn of it."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from on_track import WIDE, block, coming, device, load, named, read, slanted

from feederscrew.arrivals.entry import shares
from feederscrew.base.errors import Faults
from feederscrew.cad import section as printed
from feederscrew.feeding import stream
from feederscrew.feeding.rate import rate
from feederscrew.feeding.well_oriented import velocity
from feederscrew.output import tooling_figures
from feederscrew.output.rate import remarks
from feederscrew.sorting import solid
from feederscrew.sorting.device_passages import worst_passage
from feederscrew.sorting.fates import at_entry, course, leading_devices
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.sorting.verdicts import becomes_in_groove, groove_height, settled_in_groove, verdict

DEG = math.radians(1.0)


def groove(angle):
    return slanted("V groove", angle, f"{{angle: {angle:g} deg}}")


@pytest.fixture(scope="module")
def dowel():
    return coming(load("dowel_6x20"))


@pytest.mark.parametrize("angle", [15.0, 30.0, 45.0, 55.0])
def test_a_cylinder_lies_along_a_groove_at_its_radius_over_the_cosine(angle):
    turns = np.radians(np.arange(0.0, 360.0, 1.0))
    along = np.array([[x, 3e-3 * np.cos(t), 3e-3 * np.sin(t)] for x in (-9e-3, 11e-3) for t in turns])
    height = 3e-3 / np.cos(angle * DEG)
    assert groove_height(along, angle * DEG) == pytest.approx(height, rel=1e-3)
    yaw, tilt = 31.0 * DEG, 12.0 * DEG  # it finds its way back there
    turn = np.array([[np.cos(yaw), np.sin(yaw), 0.0], [-np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    lift = np.array([[np.cos(tilt), 0.0, np.sin(tilt)], [0.0, 1.0, 0.0], [-np.sin(tilt), 0.0, np.cos(tilt)]])
    if angle != 45.0:  # there its flat end may stand on the other face
        settled = settled_in_groove(along @ turn @ lift, angle * DEG)
        assert groove_height(settled, angle * DEG) == pytest.approx(height, rel=2e-3)


def test_what_lies_flat_stays_what_is_round_lies_along_and_a_queue_travels_as_in_the_groove(dowel):
    along = dowel.index(named(dowel, "A@0"))
    for name in ("A@0", "A@90", "B@86"):
        assert becomes_in_groove(named(dowel, name), dowel, 30.0 * DEG) == ((along, 1.0),)
    ell = coming(load("lbracket_30x20x15"))
    flat = verdict(groove(30.0), named(ell, "D@1"), ell)
    assert flat.passes == 1.0 and not flat.onto and math.isnan(flat.margin)
    # What turns is not sure and counts as what it turns into.
    upright = [replace(one, turns_over=False) for one in dowel]
    flow = course([groove(30.0)], upright)
    row, along = (dowel.index(named(dowel, name)) for name in ("B@86", "A@0"))
    assert not flow.decided[row] and flow.decided[along]
    assert flow.leaving[row, along] == 1.0 and flow.leaving[row, row] == 0.0
    passage = worst_passage(groove(30.0), upright[row], upright)
    assert passage.after.name == "A@0" and passage.after.groove == 30.0 * DEG
    assert tooling_figures.turned_words(passage) == "turns into A@0, not sure"
    # A queue travels as in the groove that is listed first.
    in_groove = at_entry(dowel, [groove(40.0), slanted("spacing section", -6.0)])
    assert stream.queueing(WIDE, in_groove).track.climb == WIDE.track.climb
    there = replace(WIDE, friction=stream.on_stretch(WIDE, in_groove[0]).friction)
    assert velocity(stream.queueing(WIDE, in_groove)).value == pytest.approx(velocity(there).value)
    assert stream.needed_spacing([groove(40.0)], in_groove, WIDE) == 0.0
    # A groove begins at the entry, and a bank ends it.
    bank, steep = slanted("banked track", 6.0), slanted("spacing section", -4.0)
    assert leading_devices([groove(30.0), steep, bank]) == (groove(30.0), steep)
    assert leading_devices([bank, groove(30.0), bank]) == (bank,)  # the groove begins at its own place
    assert leading_devices([device("gap", limit=1e-3), bank]) == ()


def test_a_round_part_is_sure_in_a_groove_and_no_bank_brings_it_to_the_wall():
    """A set screw across a bank of 6 deg came 0.8 mm off the wall in 6 of 6 trials, and fell."""
    part = load("dowel_6x20")
    own = {"rule": "csa", "aspect_shares": shares(part, WIDE, rule="csa")}
    chains = (), (groove(30.0),), (slanted("banked track", 6.0, "6 deg"),)
    level, lying, banked = (rate(part, WIDE, "A", devices=devices, **own) for devices in chains)
    names = [one.name for one in level.rate.orientations.lying]
    assert not level.rate.orientations.sure[names.index("A@0")]
    assert lying.rate.orientations.sure[names.index("A@0")]
    assert lying.rate.velocity.value > level.rate.velocity.value
    stage = banked.rate.orientations
    sure = {one.name: bool(stage.sure[k]) for k, one in enumerate(stage.lying) if one.aspect == "A"}
    assert sure == {"A@0": True, "A@90": False}
    assert any(line.startswith("A@90") and "no bank brings to the wall" in line for line in remarks(banked))


@pytest.mark.parametrize("angle", [10.0, 30.0, 50.0])
def test_friction_acts_as_over_the_cosine(angle):
    one = groove(angle).onward(named(coming(block()), "A@0"))
    there, mu = stream.on_stretch(WIDE, one), WIDE.friction
    more = 1.0 / math.cos(angle * DEG)
    own = [there.friction.static, there.friction.kinetic, *there.friction.backward]
    assert own == pytest.approx([more * value for value in (mu.static, mu.kinetic, *mu.backward)])
    assert there.track.bank == 0.0 and there.track.climb == WIDE.track.climb
    banked = stream.on_stretch(WIDE, slanted("banked track", 5.0).onward(one))
    assert banked.friction is WIDE.friction and banked.track.bank == 5.0 * DEG


@pytest.mark.parametrize(
    ("lines", "fault"),
    [
        (["groove: 30 deg"], "V groove has no angle - write {angle: 30 deg}"),
        (["groove: {angle: 70 deg}"], "angle is 70 deg - give 10 to 60 deg"),
        (["groove: {angle: 5 deg}"], "angle is 5 deg - give 10 to 60 deg"),
        (["groove: {angle: 30 deg}", "gap: 4 mm"], "gap stands in a groove - list 'banked track: 6 deg'"),
        (["groove: {angle: 30 deg}", "separation: {climb: -4 deg}", "wiper: 4 mm"], "wiper stands in a"),
        (["rails: {from: 4 mm, to: 8 mm}", "groove: {angle: 30 deg}"], "no meaning for parts that hang"),
    ],
)  # fmt: skip
def test_faults_of_a_groove(tmp_path, lines, fault):
    with pytest.raises(Faults, match=re.escape(fault)):
        read(tmp_path, *lines)


def test_its_section_is_closed_and_has_the_other_face(dowel):
    chain = (groove(30.0), slanted("banked track", 6.0), device("gap", limit=5e-3, text="5 mm"))
    section = lay_out(WIDE.track, chain, dowel)
    (stretch,) = section.grooves
    first, opens = stretch.end, stretch.closed - stretch.end
    assert stretch.begin < 0.0 and stretch.lean == pytest.approx(60.0 * DEG)
    vertices, faces = printed.solid(section)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    radius, (x, y, z) = WIDE.track.radius, vertices.T
    off, way = radius - np.hypot(x, radius - y), radius * np.arctan2(x, radius - y)
    behind = (way < first - 1e-3) & (z > 1e-3)  # where the wall leans back
    assert off[behind].min() < -0.9 * math.sin(60.0 * DEG) * (section.tallest + printed.WALL_MARGIN_M)
    assert off[(way > first + opens + 3e-3) & (z > 0.9 * z.max())].min() > -1.01 * solid.WALL
    inner = behind & (np.abs(off + z * math.tan(60.0 * DEG)) < 2e-5)
    assert inner.sum() > 10  # the face itself, from the wall's foot on
