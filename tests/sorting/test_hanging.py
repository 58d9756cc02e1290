"""Headed parts hanging between rails: an orientation of its own from there on, and the rails' lead-in."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapes
import trimesh
from on_track import device, load, lying, named, read

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.base.errors import FeederError
from feederscrew.bowl.device_list import THREADED_SHANK
from feederscrew.bowl.devices.base import opening_at
from feederscrew.bowl.devices.trade import Action
from feederscrew.sorting import tooling as tooling_study
from feederscrew.sorting.device_passages import until_returned
from feederscrew.sorting.falling import hangs_free
from feederscrew.sorting.fates import course
from feederscrew.sorting.isolating.chain import design_task, judge_cut, propose
from feederscrew.sorting.orientations import Hanging, neck
from feederscrew.sorting.verdicts import verdict
from feederscrew.trials import course as trial_course
from feederscrew.trials import trial

HEAD, SHANK, UNDER = 5e-3, 2e-3, 4e-3  # [m] radii, height of the head
SLOT = 6e-3


@pytest.fixture(scope="module")
def pin():
    head, shank = shapes.cylinder(5.0, 4.0, 64), shapes.cylinder(2.0, 20.0, 64)
    head.apply_translation([0, 0, 12.0])
    return lying(head.union(shank))


def along_track(every):
    return next(one for one in every if one.length > 0.02 and one.height < 0.012)


def rails(every, width=SLOT):
    middle = along_track(every).distance
    return device("rails", span=(middle - 0.5 * width, middle + 0.5 * width))


def test_what_hangs_by_one_head_is_one_orientation(pin):
    flow = course([rails(pin)], pin)
    (hung,) = flow.states[len(pin) :]
    assert isinstance(hung, Hanging) and (hung.name, hung.kind) == ("hanging", "hanging")
    along = [k for k, one in enumerate(pin) if flow.leaving[k, -1] > 0.0]
    assert len(along) == 2 and all(flow.leaves_as(k) == len(pin) for k in along)  # head ahead, head behind
    assert hung.length == pytest.approx(2 * HEAD, rel=5e-3) and hung.height == pytest.approx(UNDER)
    assert hung.posture.height < 0.0  # its centre of mass lies below the rails
    rest = math.sqrt(HEAD**2 - (0.5 * SLOT) ** 2)  # half the head's chord along the edge of the slot
    assert hung.gap == pytest.approx(rest, rel=5e-3)
    assert hung.balcony == pytest.approx(sum(rails(pin).span) / 2 + 0.5 * SLOT, rel=5e-3)
    # What lies over the slot stands beside it from there on.
    across = next(k for k, one in enumerate(pin) if one.height > 0.023)
    wide, gap = rails(pin, 8e-3), device("gap", limit=4e-3)
    # half of 10 mm; 3 mm of the disc beside the slot
    assert [course(chain, pin).leaving[across].sum() for chain in ([gap], [wide], [wide, gap])] == [1, 1, 0]
    # Air does not blow off what rails hold.
    one = along_track(pin)
    jet = device("air jet", nozzle=2e-3, pressure=1e5, height=2e-3)
    sorter = device("vision reject", like=(one.aspect, one.heading, 1e-3), sees="height")
    moving = [replace(one, grip=0.6, speed=0.02, swing=0.06) for one in pin]
    for air in (jet, sorter):
        flow = course([rails(pin), air], moving)
        assert flow.leaving[:, -1].sum() == pytest.approx(2.0)  # head ahead and head behind


@pytest.mark.parametrize(
    ("kind", "limit", "margin"),
    [("hold-down", 4.5e-3, 5e-4), ("wiper", 3.8e-3, -2e-4), ("gap", 3.5e-3, 5e-4), ("gap", 4.3e-3, -3e-4)],
)
def test_devices_behind_rails_judge_what_hangs(pin, kind, limit, margin):
    chain, hung = [rails(pin), device(kind, limit=limit)], len(pin)
    flow = course(chain, pin)
    assert flow.verdicts[1][hung].margin == pytest.approx(margin, abs=2e-5)
    row = next(k for k, one in enumerate(flow.verdicts[0]) if one is not None and one.hangs)
    assert flow.leaving[row, hung] == float(margin > 0.0)
    passages = until_returned(chain, pin[row], pin)
    assert [one.orientation.name for one in passages] == [pin[row].name, "hanging"]


@pytest.mark.parametrize(("by", "margin"), [(0.5, 0.5), (-1.5, 0.5), (-2.5, -0.5), (1.2, -0.2)])
def test_rails_may_narrow_and_widen(pin, by, margin):
    first, last = rails(pin).span
    flow = course([rails(pin), device("rails", span=(first + 1e-3 * by, last - 1e-3 * by))], pin)
    assert 1e3 * flow.verdicts[1][len(pin)].margin == pytest.approx(margin, abs=0.03)


@pytest.mark.parametrize("line", ["pressure break: 5 mm", "step: 5 mm", "tipping ledge: 5 mm"])
def test_a_device_without_meaning_for_hanging_parts_is_refused(tmp_path, line):
    with pytest.raises(FeederError) as raised:
        read(tmp_path, "rails: {from: 4.5 mm, to: 8.5 mm}", line)
    kind, path = line.partition(":")[0], tmp_path / "bowl.yaml"
    line = f"{kind} has no meaning for parts that hang between rails - list it before the rails"
    assert str(raised.value) == f"{path}:3:5: {line}"


def test_a_conical_head_rests_on_its_cone():
    turn = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rings = [(0.0, 2.0), (15.0, 2.0), (18.0, 5.0), (18.5, 5.0)]
    points = np.array([[r * np.cos(t), r * np.sin(t), z] for z, r in rings for t in turn])
    every = lying(trimesh.convex.convex_hull(points[:96]).union(trimesh.convex.convex_hull(points[48:])))
    one = next(one for one in every if one.length > 0.015)
    hung = course([device("rails", span=(one.distance - 3e-3, one.distance + 3e-3))], every).states[-1]
    assert hung.name == "hanging" and len(hung.foot.rings) == 2 and hung.margin > 0.0
    assert hung.height == pytest.approx(2.5e-3, abs=1e-4)  # the cone is 6 mm wide 2.5 mm below its top


@pytest.mark.parametrize(("near", "sure"), [(3.05e-3, False), (3.15e-3, True)])  # head 5 mm, shank 2 mm
def test_a_head_that_touches_the_wall_may_wedge(pin, near, sure):
    slot = device("rails", span=(near, near + SLOT), lead=(1e-3, near + SLOT, 0.01, 0.01))
    judged = verdict(slot, replace(along_track(pin), grip=0.1), pin)
    assert judged.hangs and judged.sure == sure


@pytest.mark.parametrize(("thick", "lever", "sure"), [(4.0, 0.21, True), (8.0, 0.03, False)])
def test_a_weight_near_the_end_of_a_head_does_not_turn_the_shank_down(thick, lever, sure):
    """A head 10 mm wide on a shank of 5.6 mm, 24 mm long in all."""
    head, shank = shapes.cylinder(5.0, thick, 32), shapes.cylinder(2.8, 24.0 - thick, 32)
    head.apply_translation([0, 0, 12.0])
    own = bowls.read(None, ("track.radius=100 m", "track.width=60 mm")).track
    one = next(one for one in lying(head.union(shank), own) if one.length > 0.02 and neck(one) is not None)
    assert neck(one).lever / one.length == pytest.approx(lever, abs=0.02)
    assert hangs_free(one, (3.2e-3, 9.2e-3)) == sure and not hangs_free(one, (2.1e-3, 8.1e-3))


LEAD = "lead_in: {from: 3 mm, to: 12 mm, length: 40 mm, taper: 30 mm}"


def test_a_lead_in_is_read_drawn_and_written_anew(tmp_path):
    (slot,) = read(tmp_path, f"rails: {{from: 4.4 mm, to: 11.45 mm, {LEAD}}}").devices
    assert slot.lead == pytest.approx((3e-3, 12e-3, 40e-3, 30e-3))
    near = [[0, 3], [40, 3], [70, 4.4], [200, 4.4]]
    far = [[200, 11.45], [70, 11.45], [40, 12], [0, 12]]
    opening = opening_at(slot, next(iter(lying(load("hexbolt_m8x25")))))
    assert 1e3 * opening.extended(0.2).ring == pytest.approx(np.array(near + far))
    assert slot.document_values()["span_mm"] == pytest.approx([4.4, 11.45])
    assert slot.document_values()["lead_in"]["taper_mm"] == pytest.approx(30.0)
    wider = slot.with_span((2.5e-3, 12.5e-3))
    (copy,) = read(tmp_path, f"rails: {wider.text}").devices
    assert copy.span == pytest.approx(wider.span)
    assert copy.lead == pytest.approx((2.5e-3, 12.5e-3, 40e-3, 30e-3))
    # A shank whose tip lies on the rail is not sure to go down.
    bowl = read(tmp_path, "rails: {from: 3.7 mm, to: 12.15 mm}")
    study = tooling_study.tooling(
        load("hexbolt_m8x25"), bowl, search=tooling_study.ToolingSearch(rule="csa", verdicts=1, seconds=0.001)
    )
    one = named(study.orientations, "A@186")
    assert 1e3 * neck(one).tip == pytest.approx(-2.03, abs=0.05)  # nearer to the wall than its weight
    narrow = verdict(bowl.devices[0], one, study.orientations)
    wide = verdict(bowl.devices[0].with_span((3.7e-3, 12.15e-3), (2.5e-3, 12.15e-3, 0.05, 0.03)), one)
    assert narrow.hangs and not narrow.sure
    assert wide.hangs and wide.sure


def test_the_screw_is_fed_between_rails_and_its_trial_agrees(tmp_path):
    part = load("hexbolt_m8x25")
    search = tooling_study.ToolingSearch(rule="csa")
    study = tooling_study.tooling(part, bowls.read(None, []), "A", search=search)
    design = study.design
    # Rails that fit a file with the minor diameter of a thread stop the real screw: said, and said once.
    assert study.warnings.count(THREADED_SHANK) == 1
    assert THREADED_SHANK not in replace(study, designs=(None,) * len(study.designs)).warnings
    (slot,) = [cut.device for cut in design.cuts if cut.device.action is Action.HANG]
    assert 0.2e-3 < slot.span[1] - slot.span[0] - 8e-3 < 0.6e-3
    assert slot.lead[0] < slot.span[0] and slot.lead[1] > slot.span[1]
    tried = trial.trial(part, [read(tmp_path, f"rails: {slot.text}")], rule="csa", parts=10, jobs=1)
    assert tried.warnings.count(THREADED_SHANK) == 1
    run = tried.runs[0]
    rows = [k for k, one in enumerate(run.orientations.lying) if one.name in ("A@186", "A@354")]
    assert run.counts[rows, 0].tolist() == run.tried_counts[rows].tolist()


@pytest.mark.parametrize(("near", "wedging"), [(2.2, 0.39e-3), (3.0, 0.0)])
def test_a_trial_says_where_a_head_at_the_wall_may_wedge(tmp_path, near, wedging):
    """In MuJoCo, with a drive and soft contacts, it stands there."""
    profile = [(0, 0), (2.5, 0), (2.5, 13.2), (5.0, 15.7), (5.0, 16), (0, 16)]
    trimesh.creation.revolve(profile, sections=24).export(tmp_path / "screw.stl")
    bowl = read(tmp_path, f"rails: {{from: {near} mm, to: {near + 5.4} mm}}")
    run = trial.trial(parts.load(tmp_path / "screw.stl"), [bowl], rule="csa", parts=6, jobs=1).runs[0]
    row = next(k for k, one in enumerate(run.orientations.lying) if one.name == "A@189")
    assert run.counts[row, trial_course.TURNED] > 0  # it hangs and goes on
    assert run.wedge_depths[row] == pytest.approx(wedging, abs=0.03e-3 if wedging else 0.0)
    remarks = [line for line in run.remarks if "may wedge" in line]
    assert len(remarks) == bool(wedging)
    assert all(line.startswith("A@189: hangs with its head at the wall") for line in remarks)


def test_behind_rails_a_cut_has_the_margin_of_what_hangs_there(pin):
    """A blade is as high as the heads and no more: for the part as it lies there is no number, and no return.

    A margin of -2e-06 mm stood beside the wanted part, among those that the blade returns.
    """
    along = pin.index(along_track(pin))
    shares = np.full(len(pin), 1.0 / len(pin))
    task = design_task(pin, shares, along, 1e-4, 1.0, ())
    same = np.arange(len(pin)) == along
    slot = judge_cut(pin, along, rails(pin), ~same, rails(pin), rails(pin))
    blade = device("wiper", limit=6e-3)  # over the heads that hang 4 mm high; the part lies 10 mm high
    over = judge_cut(pin, along, blade, ~same, blade, blade)
    assert over.margin_pass < 0.0 and pin[along].name in over.returns
    design = propose(task, (slot, over), ~same, same)
    hung = next(cut for cut in design.cuts if cut.device.kind == "wiper")
    assert hung.margin_pass == pytest.approx(6e-3 - UNDER, abs=2e-4) and pin[along].name not in hung.returns
    low = device("wiper", limit=3e-3)  # by the rule the head stands at it: no number says by how much
    under = judge_cut(pin, along, low, ~same, low, low)
    (last,) = [cut for cut in propose(task, (slot, under), ~same, same).cuts if cut.device.kind == "wiper"]
    assert np.isnan(last.margin_pass) and pin[along].name not in last.returns
    alone = propose(task, (over,), ~same, same).cuts[0]
    assert alone.margin_pass == over.margin_pass, "without rails it lies"
