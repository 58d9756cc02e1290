"""A twisted track: what keeps a part on both its faces, as what it goes on, and where it may stand."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapes
from on_track import WIDE, block, coming, load, lying, named, pick, read, slanted

from feederscrew.arrivals.entry import Shares
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.base import UNSURE
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.feeding.rate import rate
from feederscrew.resting.aspects import find
from feederscrew.sorting.device_passages import worst_passage
from feederscrew.sorting.fates import course, leading_devices
from feederscrew.sorting.on_side import find_on_side, side_levers
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.sorting.tooling import ToolingSearch, tooling
from feederscrew.sorting.verdicts import verdict

DEG = math.radians(1.0)
FLANGED = [(0, 0), (14, 0), (14, 3), (5, 3), (5, 15), (0, 15)]  # [mm] a foot and a web: it is long along X
T_SHAPED = [(-3, 0), (3, 0), (3, 8), (9, 8), (9, 11), (-9, 11), (-9, 8), (-3, 8)]


def twist(angle=80.0, length=0.12):
    return make_device("twisted track", "test", angle=angle * DEG, length=length).rewritten()


def lift(orientation, angle, turn):
    """Height [m] of the centre of mass over the corner, the part on both faces and turned about the track."""
    points = (orientation.solid.vertices - orientation.solid.centre_of_mass) @ orientation.axes.T
    y, z = points[:, 1], points[:, 2]
    y, z = y * np.cos(turn) - z * np.sin(turn), y * np.sin(turn) + z * np.cos(turn)
    return -y.min() * np.sin(angle) - z.min() * np.cos(angle)


@pytest.mark.parametrize("angle", [20.0, 45.0, 65.0, 80.0])
@pytest.mark.parametrize("ring", [[(0, 0), (12, 0), (12, 5), (0, 5)], FLANGED, T_SHAPED])
def test_a_lever_is_the_rise_of_the_weight_for_a_turn_on_both_faces(ring, angle):
    """By the principle of virtual work, of bodies whose section is the same all along the track."""
    seen = 0
    for one in lying(shapes.prism(ring, 30.0)):
        if not np.isclose(one.length, 0.03, rtol=1e-3):
            continue
        levers = side_levers(one, angle * DEG)
        for lever, turn in ((levers.out, 1e-7), (levers.back, -1e-7)):
            rise = (lift(one, angle * DEG, turn) - lift(one, angle * DEG, 0.0)) / abs(turn)
            assert lever == pytest.approx(rise, abs=2e-7)
        seen += 1
    assert seen > 1


def test_a_block_goes_on_on_the_side_that_was_at_the_wall_by_half_its_sides():
    every = coming(block())
    flat = pick(every, length=20, height=5)
    outcome = verdict(twist(70.0), flat, every)
    ((place, share),) = outcome.onto
    edge = every[place]
    assert share == 1.0 and (edge.height, edge.length) == (
        pytest.approx(0.012),
        pytest.approx(0.020, rel=1e-3),
    )
    lever = 2.5e-3 * math.sin(70.0 * DEG) + 6e-3 * math.cos(70.0 * DEG)
    assert outcome.margin == pytest.approx(lever - flat.hop, abs=1e-5) and outcome.decided
    back = verdict(twist(70.0), edge, every)  # the other way round it lies flat
    assert every[back.onto[0][0]].height == pytest.approx(0.005)


def test_what_has_its_weight_beyond_the_top_of_its_side_tips_out_and_that_is_not_decided():
    """A foot of 14 x 3 mm at the wall, a web over its far end: out from atan(9.65 / 2.91) = 73.2 deg on."""
    every = lying(shapes.prism(FLANGED, 30.0))
    standing = [one for one in every if abs(one.length - 0.030) < 1e-4 and abs(one.height - 0.015) < 1e-5]
    low = max(standing, key=lambda one: one.distance)
    centre = (42 * 7 + 60 * 2.5) / 102, (42 * 1.5 + 60 * 9) / 102  # [mm] of the section
    for degrees in (65.0, 73.0, 73.5, 80.0):
        c, s = math.cos(degrees * DEG), math.sin(degrees * DEG)
        levers = side_levers(low, degrees * DEG)
        wanted = 1e-3 * (s * (3.0 - centre[1]) + c * (14.0 - centre[0]))
        assert levers.out == pytest.approx(wanted, abs=1e-5)
        assert (levers.out < 0.0) == (degrees > 73.2) and min(levers.back, levers.along) > 0.0
        outcome = verdict(twist(degrees), low, every)
        assert not outcome.decided and outcome.margin <= -UNSURE


def test_it_is_named_by_its_aspect_and_heading_also_where_no_level_track_has_it_so():
    every = coming(load("lbracket_30x20x15"))
    flow = course((twist(),), every)
    names = [one.name for one in every]
    leaves = {name: flow.states[int(flow.leaving[k].argmax())] for k, name in enumerate(names)}
    assert leaves["A@90"] is named(every, "E@270") and leaves["B@114"] is named(every, "A@178")
    of_its_own = leaves["A@2"]
    assert of_its_own.name == "B@296" and of_its_own.name not in names
    assert of_its_own.height == named(every, "B@28").height and not of_its_own.returned
    # its axes ahead, inwards and up: as it came, turned about the track by a right angle
    x, y, z = named(every, "A@2").axes
    assert of_its_own.axes == pytest.approx(np.array([x, -z, y]), abs=0.05)
    assert worst_passage(twist(), named(every, "A@2"), every).after.name == "B@296"
    # a pose that two come to is one state
    assert len({one.name for one in flow.states}) == len(flow.states)
    kept = flow.leaving.sum(axis=1)
    assert kept == pytest.approx([float(not one.returned) for one in every])


def test_the_wall_of_the_twist_holds_what_the_drive_turns_over_on_the_level():
    every = coming(block(20, 12, 1))
    flat = pick(every, length=20, height=1)
    edges = [replace(one, turns_over=one.height > 2e-3) for one in every]
    row = every.index(flat)
    assert course((twist(),), edges).leaving[row].sum() == 1.0


def test_friction_may_tip_ahead_what_stands_short_on_its_side():
    """Blocks on a side of length a, w / 2 below the centre of mass: none tips if a >= mu w."""
    for length, sure in ((20.0, True), (14.0, True), (6.0, False)):
        every = lying(block(length, 20, 5))
        across = next(one for one in every if np.allclose([one.width, one.height], [0.020, 0.005], rtol=1e-3))
        levers, outcome = side_levers(across, 80.0 * DEG), verdict(twist(), across, every)
        assert levers.along == pytest.approx(0.5e-3 * length * math.sin(80.0 * DEG), abs=1e-5)
        assert levers.height == pytest.approx(0.010, rel=0.01) and outcome.sure == sure


def test_what_lies_on_none_of_its_aspects_then_is_not_sure():
    every = coming(load("lbracket_30x20x15"))
    one = named(every, "A@2")
    x, y, z = one.axes
    skew = np.array([x, (y + z) / math.sqrt(2.0), (z - y) / math.sqrt(2.0)])
    assert find_on_side(every, skew) is None
    across = named(every, "A@270")
    outcome = verdict(twist(), across, every)
    assert outcome.margin == -UNSURE and outcome.onto == ((every.index(across), 1.0),)


@pytest.mark.parametrize(
    ("lines", "fault"),
    [
        (
            ("twisted track: {angle: 80 deg, length: 120 mm}", "gap: 5 mm"),
            "gap stands on a track that is twisted",
        ),
        (
            ("V groove: {angle: 30 deg}", "twisted track: {angle: 80 deg, length: 120 mm}"),
            "stands in a groove",
        ),
        (
            ("rails: {from: 4 mm, to: 8 mm}", "twisted track: {angle: 80 deg, length: 120 mm}"),
            "between rails",
        ),
        (("twisted track: {angle: 50 deg, length: 120 mm}",), "give 65 to 80 deg"),
        (("twisted track: {angle: 80 deg, length: 5 mm}",), "give 20 to 1000 mm"),
        (("twisted track: {angle: 80 deg}",), "has no length"),
    ],
)
def test_where_it_may_not_stand(tmp_path, lines, fault):
    with pytest.raises(FeederError, match=fault):
        read(tmp_path, *lines)


def test_it_begins_at_its_own_place_over_its_own_length(tmp_path):
    line = "twisted track: {angle: 75 deg, length: 90 mm}"
    chain = read(tmp_path, line, "spacing section: {climb: -2 deg}").devices
    assert chain[0].value_words == "by 75 deg over 90 mm" and chain[0].rewritten().text == chain[0].text
    assert leading_devices(chain) == ()
    assert leading_devices((slanted("banked track", 4.0), *chain)) == (slanted("banked track", 4.0),)
    tooled = lay_out(WIDE.track, chain, coming(block()))
    for changes in (tooled.banks, tooled.walls):
        ((start, end, angle),) = changes
        assert (end - start, angle) == (pytest.approx(0.09), pytest.approx(75.0 * DEG))


def test_behind_it_the_wall_is_the_floor_that_stood_up_as_far_off_as_that_was_below():
    """Of poses of their own and of those of the level track, which some parts come back to."""
    seen = set()
    for part in (block(), load("lbracket_30x20x15")):
        every = coming(part)
        for one in every:
            passage = worst_passage(twist(), one, every)
            if passage.verdict.margin > 0.0:
                after = passage.after
                # known within ten degrees of heading: off by as much of the part's reach at most
                slack = 1e-4 if part.name == "block" else math.sin(10.0 * DEG) * one.length
                assert after.at_inner_wall and not one.at_inner_wall
                assert after.distance == pytest.approx(one.posture.height, abs=slack)
                seen.add(after.name in {other.name for other in every})
        # what lies so on the level keeps its wall
        assert not any(one.at_inner_wall for one in every)
    assert seen == {True, False}


CUTS = "wiper: {clearance: 6 mm, sweep: 30 deg}", "narrowed track: 11 mm"
TWIST_LINE = "twisted track: {angle: 80 deg, length: 120 mm}"


@pytest.mark.parametrize(
    ("part", "lines"),
    [
        (block(24, 14, 4), CUTS),
        (block(24, 14, 4), ("banked track: 4 deg", "canyon: 4 mm")),
        (load("lbracket_30x20x15"), ("gap: 9 mm",)),
    ],
    ids=["cuts", "canyon on a bank", "gap"],
)
def test_tooling_says_of_a_file_with_a_twist_what_the_rate_says(tmp_path, part, lines):
    bowl, aspects, ratios = read(tmp_path, *lines, TWIST_LINE), find(part), []
    search, every = ToolingSearch(rule="closed", turn=True), [one for one in coming(part) if not one.returned]
    for one in every[:6]:
        study = tooling(part, bowl, one.name, aspect_shares=aspects, search=search)
        rated = rate(part, bowl, one.name, rule="closed", aspect_shares=Shares(aspects)).rate
        design = study.design
        assert design.devices == bowl.devices and not design.cuts
        assert np.nan_to_num(design.purity) == pytest.approx(np.nan_to_num(rated.purity))
        assert study.isolates(study.wanted) == (np.nan_to_num(rated.purity) >= design.least_purity)
        if rated.efficiency > 0.0:
            ratios.append(design.efficiency / rated.efficiency)
    # the rate counts of what the bare track carries, tooling of all that come
    assert ratios and ratios == pytest.approx([ratios[0]] * len(ratios)) and 0.9 < ratios[0] <= 1.0


def test_tooling_names_the_pose_to_ask_for_where_a_twist_has_turned_the_one_that_was(tmp_path):
    part = block(24, 14, 4)
    bowl = read(tmp_path, *CUTS, TWIST_LINE)
    flat = pick(coming(part), length=24, height=4)
    study = tooling(part, bowl, flat.name, aspect_shares=find(part), search=ToolingSearch(rule="closed"))
    edge = pick(study.orientations, length=24, height=14)
    assert any(f"leaves as {edge.name}" in reason for reason in study.design.reasons)
