"""A groove: where a part comes to lie in a V, what it does to the chain, and what is drawn of it."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
import trimesh

from feederscrew import bowl as bowls
from feederscrew.errors import Faults
from feederscrew.output import tooling_figures
from feederscrew.output.rate import remarks
from feederscrew.part import load
from feederscrew.rates import stream
from feederscrew.rates.well_oriented import velocity
from feederscrew.resting.aspects import find
from feederscrew.studies.rate import rate, shares
from feederscrew.tooling import solid
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.fates import at_entry, course, leading
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.track_sections import build_section, worst_passage
from feederscrew.tooling.verdicts import (
    becomes_in_groove,
    groove_height,
    settled_in_groove,
    verdict,
)

PARTS = Path(__file__).resolve().parents[2] / "parts"
BOWL = bowls.read(None, ["track.width=30 mm"])
DEG = math.radians(1.0)


def groove(angle):
    return make_device("groove", "here", angle=angle * DEG, text=f"{{angle: {angle:g} deg}}")


def known(part):
    return travelling(orientations(part, find(part), BOWL.track), BOWL)


@pytest.fixture(scope="module")
def dowel():
    part = load(PARTS / "dowel_6x20.stl")
    return part, known(part)


def named(every, name):
    return next(one for one in every if one.name == name)


@pytest.mark.parametrize("angle", [15.0, 30.0, 45.0, 55.0])
def test_a_cylinder_lies_along_a_groove_at_its_radius_over_the_cosine(angle):
    round_it = np.radians(np.arange(0.0, 360.0, 1.0))
    along = np.array([[x, 3e-3 * np.cos(t), 3e-3 * np.sin(t)] for x in (-9e-3, 11e-3) for t in round_it])
    assert groove_height(along, angle * DEG) == pytest.approx(3e-3 / np.cos(angle * DEG), rel=1e-3)
    yaw, tilt = 31.0 * DEG, 12.0 * DEG  # it finds its way back there
    turn = np.array([[np.cos(yaw), np.sin(yaw), 0.0], [-np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    lift = np.array([[np.cos(tilt), 0.0, np.sin(tilt)], [0.0, 1.0, 0.0], [-np.sin(tilt), 0.0, np.cos(tilt)]])
    if angle != 45.0:  # there its flat end may stand on the other face
        found = settled_in_groove(along @ turn @ lift, angle * DEG)
        assert groove_height(found, angle * DEG) == pytest.approx(3e-3 / np.cos(angle * DEG), rel=2e-3)


def test_what_lies_flat_stays_and_what_is_round_lies_along(dowel):
    _, every = dowel
    place = {one.name: k for k, one in enumerate(every)}
    for one, onto in (("A@0", "A@0"), ("A@90", "A@0"), ("B@86", "A@0")):
        assert becomes_in_groove(named(every, one), every, 30.0 * DEG) == ((place[onto], 1.0),)
    ell = known(load(PARTS / "lbracket_30x20x15.stl"))
    flat = verdict(groove(30.0), named(ell, "D@1"), ell)
    assert flat.passes == 1.0 and not flat.onto and math.isnan(flat.margin)


def test_what_turns_is_not_sure_and_counts_as_what_it_turns_into(dowel):
    _, every = dowel
    upright = [replace(one, turns_over=False) for one in every]
    found = course([groove(30.0)], upright)
    row, lying = (next(k for k, one in enumerate(every) if one.name == name) for name in ("B@86", "A@0"))
    assert not found.decided[row] and found.decided[lying]
    assert found.leaving[row, lying] == 1.0 and found.leaving[row, row] == 0.0
    seen = worst_passage(groove(30.0), upright[row], upright)
    assert seen.after.name == "A@0" and seen.after.groove == 30.0 * DEG
    assert tooling_figures.turned_words(seen) == "turns into A@0, not sure"


def test_a_round_part_is_sure_in_a_groove_and_counts_in_full(dowel):
    part, _ = dowel
    arriving = shares(part, BOWL, rule="csa")
    level = rate(part, BOWL, "A", rule="csa", aspect_shares=arriving).rate
    in_groove = rate(part, BOWL, "A", rule="csa", aspect_shares=arriving, devices=(groove(30.0),)).rate
    row = next(k for k, one in enumerate(level.orientations.lying) if one.name == "A@0")
    assert not level.orientations.sure[row] and in_groove.orientations.sure[row]
    assert in_groove.velocity.value > level.velocity.value


def test_a_bank_brings_to_the_wall_only_what_does_not_roll_along_it(dowel):
    """A set screw across a bank of 6 deg came 0.8 mm off the wall in 6 of 6 trials, and fell."""
    part, _ = dowel
    bank = make_device("bank", "devices", angle=np.radians(6.0), text="6 deg")
    study = rate(part, BOWL, "A", rule="csa", devices=(bank,))
    found = study.rate.orientations
    sure = {one.name: bool(found.sure[k]) for k, one in enumerate(found.lying) if one.aspect == "A"}
    assert sure == {"A@0": True, "A@90": False}
    assert any(line.startswith("A@90") and "no bank brings to the wall" in line for line in remarks(study))


@pytest.mark.parametrize("angle", [10.0, 30.0, 50.0])
def test_friction_acts_as_over_the_cosine(angle):
    one = groove(angle).onward(named(known(shapes.part(shapes.box(20, 12, 5))), "A@0"))
    there = stream.on_stretch(BOWL, one)
    more = 1.0 / math.cos(angle * DEG)
    mu = BOWL.friction
    assert there.friction.static == pytest.approx(mu.static * more)
    assert there.friction.kinetic == pytest.approx(mu.kinetic * more)
    assert there.friction.backward == pytest.approx([one * more for one in mu.backward])
    assert there.track.bank == 0.0 and there.track.climb == BOWL.track.climb
    back = stream.on_stretch(BOWL, make_device("bank", "b", angle=5.0 * DEG).onward(one))
    assert back.friction is BOWL.friction and back.track.bank == 5.0 * DEG


def test_a_queue_travels_as_in_the_groove_that_is_listed_first(dowel):
    _, every = dowel
    steep = make_device("separation", "s", angle=-6.0 * DEG)
    lying = at_entry(every, [groove(40.0), steep])
    assert stream.queueing(BOWL, lying).track.climb == BOWL.track.climb
    there = replace(BOWL, friction=stream.on_stretch(BOWL, lying[0]).friction)
    assert velocity(stream.queueing(BOWL, lying)).value == pytest.approx(velocity(there).value)
    assert stream.needed_spacing([groove(40.0)], lying, BOWL) == 0.0


def test_a_groove_begins_at_the_entry_and_a_bank_ends_it():
    bank, steep = make_device("bank", "b", angle=6.0 * DEG), make_device("separation", "s", angle=-4.0 * DEG)
    assert leading([groove(30.0), steep, bank]) == (groove(30.0), steep)
    assert leading([bank, groove(30.0), bank]) == (bank, groove(30.0))
    assert leading([make_device("gap", "g", limit=1e-3), bank]) == ()


def read(tmp_path, *lines):
    path = tmp_path / "b.yaml"
    path.write_text("devices:\n" + "".join(f"  - {line}\n" for line in lines))
    return bowls.read(path, []).devices


@pytest.mark.parametrize(
    ("lines", "fault"),
    [
        (["groove: 30 deg"], "groove has no angle - write {angle: 30 deg}"),
        (["groove: {angle: 70 deg}"], "angle is 70 deg - give 10 to 60 deg"),
        (["groove: {angle: 5 deg}"], "angle is 5 deg - give 10 to 60 deg"),
        (["groove: {angle: 30 deg}", "gap: 4 mm"], "gap stands in a groove - list 'bank: 6 deg' before it"),
        (
            ["groove: {angle: 30 deg}", "separation: {climb: -4 deg}", "wiper: 4 mm"],
            "wiper stands in a groove",
        ),
    ],
)
def test_faults_of_a_groove(tmp_path, lines, fault):
    with pytest.raises(Faults, match=fault.replace("{", r"\{").replace("}", r"\}")):
        read(tmp_path, *lines)


def test_its_section_is_closed_and_has_the_other_face(dowel):
    _, every = dowel
    chain = (
        groove(30.0),
        make_device("bank", "b", angle=6.0 * DEG),
        make_device("gap", "g", limit=5e-3, text="5 mm"),
    )
    section = build_section(BOWL.track, chain, every)
    (begin, first, lean), (_, end, upright) = section.walls
    assert (begin, end, upright) == (0.0, section.length, 0.0) and lean == pytest.approx(30.0 * DEG)
    vertices, faces = solid.solid(section)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    off = BOWL.track.radius - np.hypot(vertices[:, 0], BOWL.track.radius - vertices[:, 1])
    way = BOWL.track.radius * np.arctan2(vertices[:, 0], BOWL.track.radius - vertices[:, 1])
    top = vertices[:, 2].max()
    leaning_back = (way < first - 1e-3) & (vertices[:, 2] > 1e-3)
    assert off[leaning_back].min() < -0.9 * math.sin(30.0 * DEG) * (section.tallest + solid.WALL_MARGIN_M)
    assert off[(way > first + 3e-3) & (vertices[:, 2] > 0.9 * top)].min() > -1.01 * solid.WALL
    inner = leaning_back & (np.abs(off + vertices[:, 2] * math.tan(30.0 * DEG)) < 2e-5)
    assert inner.sum() > 10  # the face itself, from the wall's foot on
