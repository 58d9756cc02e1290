"""Designs of tooling: what they promise holds in the verdicts and in the rate."""

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.output import tooling as tables
from feederscrew.rates import stream, well_oriented
from feederscrew.rates.tipping import steady
from feederscrew.resting.aspects import find
from feederscrew.studies.rate import rate
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.kinds import make_device as device_of
from feederscrew.tooling.isolating import chain, hole_search
from feederscrew.tooling.isolating.chain import DesignConstraints
from feederscrew.tooling.isolating.design import design
from feederscrew.tooling.isolating.proposal import Goal
from feederscrew.tooling.orientations import name_mirror_images, orientations
from feederscrew.tooling.verdicts import verdict

MARGIN = 2.5e-4
ONES = ("sorter",)
PLAIN, UNSEEN = DesignConstraints(without=("cut_out",)), DesignConstraints(without=("cut_out", *ONES))
SETTINGS = ("track.radius=150 mm", "track.width=200 mm")


@pytest.fixture(scope="module")
def bracket():
    part = shapes.part(shapes.prism(shapes.l_profile(30, 20, 2), 15))
    found = find(part)
    track = bowls.read(None, SETTINGS).track
    every = name_mirror_images(orientations(part, found, track))
    return part, found, every, np.array([one.chances["recommended"] for one in every])


def test_a_block_is_isolated_by_devices_of_one_number(monkeypatch):
    monkeypatch.setattr(hole_search, "STARTS", 20)
    study = tooling(
        shapes.part(shapes.box(20, 12, 5)),
        bowls.read(None, SETTINGS),
        verdicts=2000,
        without="sorter",
        vary=False,
    )
    told = [one.reasons[0] for one in study.designs if not one.isolated]
    assert len(told) == 4  # what stands tall on a small foot goes wherever the block lying flat goes
    assert sum("which stands on a larger foot and is no higher" in one for one in told) >= 2
    for one in (one for one in study.designs if one.isolated):
        assert one.purity == pytest.approx(1.0)
        assert one.efficiency == pytest.approx(study.shares[one.wanted] / study.shares.sum())
        assert one.margin >= MARGIN - 1e-9
        assert {cut.device.kind for cut in one.cuts} <= {
            "wiper", "narrowed_track", "canyon", "gap", "cut_out",
        }  # fmt: skip


def test_a_cut_leaves_as_much_of_a_foot_as_keeps_it_from_rocking():
    bowl = bowls.read(None, [])
    study = tooling(
        shapes.part(shapes.box(22, 13, 6)), bowl, "C", heading=0.0, verdicts=1, without=ONES, vary=False
    )
    found, one = study.design, study.orientations[study.wanted]
    asked = {"margin": study.margin, "search": hole_search.HoleSearch(verdicts=1)}
    asked["constraints"] = DesignConstraints(without=ONES)
    midway = design(study.orientations, study.shares, study.wanted, **asked)
    assert not steady(midway.devices, [one], bowl, study.margin)[0]
    assert found.steady and steady(found.devices, [one], bowl, study.margin)[0]
    assert not any("may rock" in reason for reason in found.reasons)
    assert found.cuts[0].margin_pass > midway.cuts[0].margin_pass
    assert found.cuts[0].margin_reject == pytest.approx(study.margin, abs=5e-5)


def test_every_cut_holds_what_it_says(bracket):
    _, _, every, shares = bracket
    wanted = next(k for k, one in enumerate(every) if one.height > 0.0295)
    found = design(every, shares, wanted, constraints=PLAIN)
    assert found.cuts
    for cut in found.cuts:
        margins = {one.name: verdict(cut.device, one, every).margin for one in every}
        assert margins[every[wanted].name] == pytest.approx(cut.margin_pass)
        assert cut.margin_pass >= MARGIN - 1e-9
        assert {name for name, margin in margins.items() if margin < 0.0} == set(cut.returns)
        least = verdict(cut.smallest, every[wanted], every).margin
        most = verdict(cut.largest, every[wanted], every).margin
        assert least >= cut.margin_pass - 1e-9 >= most - 2e-9


def test_a_hole_parts_mirror_images(bracket):
    _, _, every, _ = bracket
    wanted = next(k for k, one in enumerate(every) if one.mirror and one.foot.rings and one.height < 0.016)
    partner = next(k for k, one in enumerate(every) if one.name == every[wanted].mirror)
    found = hole_search.cut_out(every, wanted, [partner], MARGIN, hole_search.HoleSearch(seed=3))
    assert found is not None
    cut, held = found
    assert held == [partner]
    assert 3 <= len(cut.device.corners) <= 6
    assert cut.margin_pass >= MARGIN and cut.margin_reject >= MARGIN
    assert verdict(cut.smallest, every[partner]).margin < 1e-6
    assert verdict(cut.largest, every[wanted]).margin > -1e-6
    again, _ = hole_search.cut_out(every, wanted, [partner], MARGIN, hole_search.HoleSearch(seed=3))
    assert again.device == cut.device


def test_a_bowl_of_the_design_is_as_pure_and_efficient(bracket, tmp_path):
    part, aspects, every, shares = bracket
    wanted = int(np.argmax([one.canyon for one in every]))
    found = design(every, shares, wanted, constraints=PLAIN)
    lines = "".join(f"  - {cut.device.kind}: {cut.device.text}\n" for cut in found.cuts)
    path = tmp_path / "tooling.yaml"
    path.write_text(f"track: {{radius: 150 mm, width: 200 mm}}\ndevices:\n{lines}")
    bowl = bowls.read(path)
    known = stream.follow_orientations(part, aspects, bowl.track, bowl.devices)
    target = every[wanted].aspect, every[wanted].heading
    made = well_oriented.rate(known, well_oriented.Range(0.02, 0.02, 0.02), target, "recommended")
    assert made.purity == pytest.approx(found.purity, rel=1e-9)
    assert made.efficiency == pytest.approx(found.efficiency, rel=1e-9)
    assert made.offered.value == pytest.approx(0.02 / (shares * [one.length for one in every]).sum())


def test_a_headed_pin_is_fed_hanging():
    head, shank = shapes.cylinder(5.0, 4.0, 32), shapes.cylinder(2.0, 20.0, 32)
    head.apply_translation([0, 0, 12.0])
    study = tooling(shapes.part(head.union(shank)), bowls.read(None, SETTINGS), "A", seconds=20.0, vary=False)
    assert [cut.device.kind for cut in study.design.cuts][-1] == "rails"
    lying = [k for k, one in enumerate(study.orientations) if one.aspect == "A" and one.length > 0.02]
    assert study.design.efficiency == pytest.approx(study.shares[lying].sum() / study.shares.sum())
    assert study.design.hopeful == pytest.approx(1.0) and study.design.purity_is_least
    assert study.design.reasons == ("no verdict is sure to return A@90: the purity counts it as leaving",)
    assert ", purity at least 81.86 %, by " in tables.bowl_file(study, ())
    assert "leave so, at least 81.86 % of what leaves" in tables.remarks(study)[0]
    leaves, across = (
        study.shares[lying].sum(),
        study.shares[[one.name == "A@90" for one in study.orientations]],
    )
    assert study.design.purity == pytest.approx(leaves / (leaves + across.sum()))  # it rolls along the bank
    assert across.sum() > 0.1


def test_rails_end_on_the_track():
    """An L that hangs over a track by more than half has no second rail there."""
    outline = [(0, 0), (26, 0), (26, 7), (9, 7), (9, 18), (0, 18)]
    part, track = shapes.part(shapes.prism(outline, 11)), bowls.read(None, ["track.width=8 mm"]).track
    every = name_mirror_images(orientations(part, find(part), track))
    flat = [k for k, one in enumerate(every) if one.aspect in "AB" and not one.falls_off]
    assert flat
    for wanted in flat:
        cuts = design(every, np.ones(len(every)), wanted, constraints=UNSEEN).cuts
        assert all(cut.device.span[1] < track.width for cut in cuts if cut.device.kind == "rails")


def test_a_purity_that_is_enough_makes_a_shorter_chain(bracket):
    _, _, every, shares = bracket
    wanted = next(k for k, one in enumerate(every) if one.height < 0.016)
    whole, part = (
        design(every, shares, wanted, goal=Goal(purity=share), constraints=PLAIN) for share in (1.0, 0.3)
    )
    assert len(part.cuts) <= len(whole.cuts)
    assert part.isolated
    assert 0.3 <= part.purity <= whole.purity + 1e-12
    assert part.efficiency == pytest.approx(whole.efficiency)


def test_the_design_is_found_behind_the_devices_of_the_bowl(bracket, tmp_path):
    part, _, every, shares = bracket
    wanted = int(np.argmax([one.canyon for one in every]))
    before = (device_of("wiper", "bowl.yaml:2:3", limit=0.019, text="19 mm"),)
    found = design(every, shares, wanted, constraints=PLAIN, before=before)
    assert not found.cuts and "is returned by the devices" in found.reasons[0]
    low = max((k for k, one in enumerate(every) if one.height < 0.016), key=lambda k: shares[k])
    alone, behind = (design(every, shares, low, before=some, constraints=UNSEEN) for some in ((), before))
    assert behind.devices[0] == before[0]
    assert "wiper" in [cut.device.kind for cut in alone.cuts]
    assert "wiper" not in [cut.device.kind for cut in behind.cuts]
    assert behind.efficiency == pytest.approx(alone.efficiency)
    path = tmp_path / "bowl.yaml"
    path.write_text("track: {radius: 150 mm, width: 200 mm}\ndevices:\n  - wiper: 19 mm\n")
    study = tooling(part, bowls.read(path), every[low].aspect, heading=every[low].heading, without="cut_out")
    text = tables.bowl_file(study, bowls.settings(path))
    assert text.count("wiper: 19 mm") == 1
    path.write_text(text)
    made = rate(part, bowls.read(path), every[low].aspect, heading=every[low].heading).rate
    assert made.efficiency == pytest.approx(study.design.efficiency, rel=1e-9)
    assert made.purity == pytest.approx(study.design.purity, rel=1e-9)


def test_the_search_ends_by_a_count_of_verdicts_and_says_when_by_time(bracket):
    _, _, every, shares = bracket
    wanted = next(k for k, one in enumerate(every) if one.mirror and one.foot.rings and one.height < 0.016)
    search, unseen = (
        hole_search.HoleSearch(verdicts=300),
        {"constraints": DesignConstraints(without=("sorter",), vary=False)},
    )
    first, second = (design(every, shares, wanted, search=search, **unseen) for _ in range(2))
    assert [cut.device for cut in first.cuts] == [cut.device for cut in second.cuts]
    assert not first.late
    assert design(every, shares, wanted, search=hole_search.HoleSearch(until=0.0), **unseen).late


def test_no_hole_is_looked_for_where_something_simpler_isolates(bracket, monkeypatch):
    """Of all 18 orientations of the bracket: 74 of 86 s went into holes, of which none was needed."""
    _, _, every, shares = bracket
    wanted = next(k for k, one in enumerate(every) if one.mirror and one.foot.rings and one.height < 0.016)
    asked = []
    monkeypatch.setattr(hole_search, "cut_out", lambda *_: asked.append(1))
    assert design(every, shares, wanted).isolated and not asked
    assert (
        not design(
            every, shares, wanted, constraints=DesignConstraints(without=("sorter",), vary=False)
        ).isolated
        and asked
    )


def test_an_inside_that_differs_is_told_from_a_chamfer():
    """A block with a bore off its middle: turned by half it has the same outside, its weight elsewhere."""
    solid, bore = shapes.box(20, 12, 5), shapes.cylinder(2.5, 8.0, 48)
    bore.apply_translation([5.0, 0.0, 0.0])
    part = shapes.part(solid.difference(bore))
    every = name_mirror_images(orientations(part, find(part), bowls.read(None, SETTINGS).track))
    flat = [one for one in every if one.height < 0.006 and one.length > 0.019]
    apart_by = chain.find_difference(flat[0], flat[1])
    off = 5.0 * 5.0 * np.pi * 2.5**2 / (20 * 12 * 5 - 5.0 * np.pi * 2.5**2)  # [mm] of the centre of mass
    assert apart_by.shape < 2e-4
    assert sorted(abs(1e3 * by) for by in apart_by.shift)[-1] == pytest.approx(2.0 * off, rel=0.02)
    tall = [one for one in every if one.height > 0.019 and one.length > 0.011]
    told = chain.inseparable_reason(
        tall[0], next(one for one in tall if one.aspect != tall[0].aspect), MARGIN
    )
    assert "have the same outside" in told and "needs a feature on the outside" in told
    assert f"{2.0 * off:.2f} mm in height" in told
