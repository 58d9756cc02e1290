"""Designs of tooling: what they promise holds in the verdicts and in the rate, with no device for nothing."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
import trimesh
from on_track import block, coming, device, load, lying, named, slanted

from feederscrew import bowl as bowls
from feederscrew.feeding.rate import rate
from feederscrew.output import tooling as tables
from feederscrew.sorting.isolating import chain, design, hole_search
from feederscrew.sorting.isolating.chain import DesignConstraints, design_task, propose
from feederscrew.sorting.isolating.hole_search import HoleSearch
from feederscrew.sorting.orientations import name_mirror_images
from feederscrew.sorting.tipping import steady
from feederscrew.sorting.tooling import ToolingSearch, tooling
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

MARGIN = 2.5e-4
BY_ONE_NUMBER = {"wiper", "narrowed track", "canyon", "gap", "cut-out"}
SENSOR = ("vision reject",)
FREE, PLAIN = DesignConstraints(), DesignConstraints(without=("cut-out",))
UNSEEN = DesignConstraints(without=("cut-out", *SENSOR))
NUMBERS = DesignConstraints(without=("cut-out", "silhouette blade", *SENSOR))
BOWL = bowls.read(None, [])
ROOMY = bowls.read(None, ("track.radius=150 mm", "track.width=200 mm"))


@pytest.fixture(scope="module")
def bracket():
    """A bracket, its orientations on a broad track and their shares."""
    part = shapes.part(shapes.prism(shapes.l_profile(30, 20, 2), 15))
    every = name_mirror_images(lying(part, ROOMY.track))
    return part, every, np.array([one.chances["recommended"] for one in every])


@pytest.fixture(scope="module")
def flat():
    """A block's orientations as they travel, and their shares."""
    every = coming(block(), BOWL)
    return every, np.array([one.chances["csa"] for one in every])


def mirrored(every):
    """The place of one that has a mirror image and stands on a face."""
    return next(k for k, one in enumerate(every) if one.mirror and one.foot.rings and one.height < 0.016)


def test_a_block_is_isolated_by_devices_of_one_number(monkeypatch):
    monkeypatch.setattr(hole_search, "STARTS", 20)
    study = tooling(
        block(),
        ROOMY,
        search=ToolingSearch(verdicts=2000, vary=False),
        without="vision reject,air jet,silhouette blade",
    )
    reasons = [one.reasons[0] for one in study.designs if not one.isolated]
    assert len(reasons) == 4  # what stands tall on a small foot goes wherever the block lying flat goes
    assert sum("which stands on a larger foot and is no higher" in one for one in reasons) >= 2
    for one in (one for one in study.designs if one.isolated):
        assert one.purity == pytest.approx(1.0) and one.margin >= MARGIN - 1e-9
        assert one.efficiency == pytest.approx(study.shares[one.wanted] / study.shares.sum())
        assert {cut.device.kind for cut in one.cuts} <= BY_ONE_NUMBER


def test_a_cut_leaves_as_much_of_a_foot_as_keeps_it_from_rocking():
    own = {"heading": 0.0, "without": SENSOR, "search": ToolingSearch(verdicts=1, vary=False)}
    study = tooling(block(22, 13, 6), BOWL, "C", **own)
    made, one = study.design, study.orientations[study.wanted]
    own = {"search": HoleSearch(verdicts=1), "constraints": DesignConstraints(without=SENSOR)}
    midway = design.design(study.orientations, study.shares, study.wanted, margin=study.margin, **own)
    assert not steady(midway.devices, [one], BOWL, study.margin)[0]
    assert made.steady and steady(made.devices, [one], BOWL, study.margin)[0]
    assert not any("may rock" in reason for reason in made.reasons)
    assert made.cuts[0].margin_pass > midway.cuts[0].margin_pass
    assert made.cuts[0].margin_reject == pytest.approx(study.margin, abs=5e-5)


def test_a_cut_is_not_eased_without_end_for_what_falls_off_at_any_width():
    """It was infinitely wide where a shank, which rolls off, was all that a narrowed track had to return."""
    study = tooling(
        load("hexbolt_m8x25"), BOWL, "B", search=ToolingSearch(verdicts=1, vary=False), without=SENSOR
    )
    every, narrow = study.orientations, next(k for k in chain.numeric_kinds() if k.kind == "narrowed track")
    needed = chain.limits(narrow, every)
    cut = narrow("own").valued(float(needed[study.wanted]) + 5e-4)
    (placed,) = chain.place_devices(every, study.wanted, [cut], [np.isinf(needed)], least=2.5e-4)
    assert np.isinf(needed).any() and placed.device.limit == pytest.approx(cut.limit, abs=1e-6)


def test_every_cut_holds_what_it_says_holes_part_mirror_images_and_enough_purity_is_shorter(bracket):
    _, every, shares = bracket
    wanted = next(k for k, one in enumerate(every) if one.height > 0.0295)
    cuts = design.design(every, shares, wanted, constraints=PLAIN).cuts
    assert cuts
    for cut in cuts:
        margins = {one.name: verdict(cut.device, one, every).margin for one in every}
        assert margins[every[wanted].name] == pytest.approx(cut.margin_pass)
        assert cut.margin_pass >= MARGIN - 1e-9
        assert {name for name, margin in margins.items() if margin < 0.0} == set(cut.returns)
        least, most = (verdict(end, every[wanted], every).margin for end in (cut.smallest, cut.largest))
        assert least >= cut.margin_pass - 1e-9 >= most - 2e-9
    # A hole parts mirror images.
    wanted = mirrored(every)
    partner = every.index(named(every, every[wanted].mirror))
    searches = [HoleSearch(seed=3)] * 2
    (cut, held), (repeat, _) = (hole_search.cut_out(every, wanted, [partner], MARGIN, k) for k in searches)
    assert held == [partner] and 3 <= len(cut.device.corners) <= 6
    assert cut.margin_pass >= MARGIN and cut.margin_reject >= MARGIN
    assert verdict(cut.smallest, every[partner]).margin < 1e-6
    assert verdict(cut.largest, every[wanted]).margin > -1e-6
    assert repeat.device == cut.device
    # One that the count of verdicts ends is made once: the same again needs no hole to start from.
    first = HoleSearch(verdicts=300)
    again = first.start()
    hole_search.cut_out(every, wanted, [partner], MARGIN, first)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hole_search, "STARTS", 0)
        hole_search.cut_out(every, wanted, [partner], MARGIN, again)
    assert again.spent == first.spent >= 300
    # A purity that is enough makes a shorter chain.
    wanted = next(k for k, one in enumerate(every) if one.height < 0.016)
    whole, enough = (design.design(every, shares, wanted, purity=k, constraints=PLAIN) for k in (1.0, 0.3))
    assert enough.isolated and len(enough.cuts) <= len(whole.cuts)
    assert 0.3 <= enough.purity <= whole.purity + 1e-12
    assert enough.efficiency == pytest.approx(whole.efficiency)


def test_a_headed_pin_is_fed_hanging():
    head, shank = shapes.cylinder(5.0, 4.0, 32), shapes.cylinder(2.0, 20.0, 32)
    head.apply_translation([0, 0, 12.0])
    study = tooling(
        shapes.part(head.union(shank)), ROOMY, "A", search=ToolingSearch(seconds=20.0, vary=False)
    )
    made = study.design
    along = [k for k, one in enumerate(study.orientations) if one.aspect == "A" and one.length > 0.02]
    leaves = study.shares[along].sum()
    across = study.shares[[one.name == "A@90" for one in study.orientations]].sum()  # rolls along the bank
    assert [cut.device.kind for cut in made.cuts][-1] == "rails"
    assert made.efficiency == pytest.approx(leaves / study.shares.sum())
    assert made.hopeful == pytest.approx(1.0) and made.purity_is_least
    assert made.reasons == ("no verdict is sure to return A@90: the purity counts it as leaving",)
    assert ", purity at least 81.86 %, by " in tables.bowl_file(study, ())
    assert "leave hanging, at least 81.86 % of what leaves" in tables.remarks(study)[0]
    assert made.purity == pytest.approx(leaves / (leaves + across)) and across > 0.1
    # An L that hangs over a track by more than half has no second rail there.
    outline = [(0, 0), (26, 0), (26, 7), (9, 7), (9, 18), (0, 18)]
    track = bowls.read(None, ["track.width=8 mm"]).track
    every = name_mirror_images(lying(shapes.prism(outline, 11), track))
    wanted = [k for k, one in enumerate(every) if one.aspect in "AB" and not one.falls_off]
    assert wanted
    for k in wanted:
        cuts = design.design(every, np.ones(len(every)), k, constraints=UNSEEN).cuts
        assert all(cut.device.span[1] < track.width for cut in cuts if cut.device.kind == "rails")


def test_a_design_goes_on_behind_the_devices_of_the_bowl(bracket, tmp_path):
    part, every, shares = bracket
    before = (device("wiper", limit=0.019, text="19 mm"),)
    narrow = int(np.argmax([one.canyon for one in every]))
    none = design.design(every, shares, narrow, constraints=PLAIN, before=before)
    assert not none.cuts and "is returned by the devices" in none.reasons[0]
    low = max((k for k, one in enumerate(every) if one.height < 0.016), key=lambda k: shares[k])
    chains = (), before
    alone, behind = (design.design(every, shares, low, before=k, constraints=NUMBERS) for k in chains)
    assert behind.devices[0] == before[0]
    kinds = [[cut.device.kind for cut in one.cuts] for one in (alone, behind)]
    assert "wiper" in kinds[0] and "wiper" not in kinds[1]
    assert behind.efficiency == pytest.approx(alone.efficiency)
    path, one = tmp_path / "bowl.yaml", every[low]
    path.write_text("track: {radius: 150 mm, width: 200 mm}\ndevices:\n  - wiper: 19 mm\n")
    study = tooling(
        part,
        bowls.read(path),
        one.aspect,
        heading=one.heading,
        without="cut-out",
        search=ToolingSearch(vary=False),
    )
    text = tables.bowl_file(study, bowls.settings(path))
    assert text.count("wiper: 19 mm") == 1
    path.write_text(text)
    rated = rate(part, bowls.read(path), one.aspect, heading=one.heading).rate
    assert rated.efficiency == pytest.approx(study.design.efficiency, rel=1e-9)
    assert rated.purity == pytest.approx(study.design.purity, rel=1e-9)


def test_holes_are_searched_last_by_count_and_a_search_by_time_says_when_it_ended(bracket, monkeypatch):
    """Of all 18 orientations of the bracket 74 of 86 s once went into holes, of which none was needed."""
    _, every, shares = bracket
    wanted, blind = mirrored(every), {"constraints": DesignConstraints(without=SENSOR, vary=False)}
    runs = [HoleSearch(verdicts=300)] * 2
    first, second = (design.design(every, shares, wanted, search=one, **blind) for one in runs)
    assert [cut.device for cut in first.cuts] == [cut.device for cut in second.cuts] and not first.late
    assert design.design(every, shares, wanted, search=HoleSearch(until=0.0), **blind).late
    searches = []
    monkeypatch.setattr(hole_search, "cut_out", lambda *_: searches.append(1))
    assert design.design(every, shares, wanted).isolated and not searches
    assert not design.design(every, shares, wanted, **blind).isolated and searches


def test_an_inside_that_differs_is_told_from_a_chamfer():
    """A block with a bore off its middle: turned by half it has the same outside, its weight elsewhere."""
    bore = shapes.cylinder(2.5, 8.0, 48)
    bore.apply_translation([5.0, 0.0, 0.0])
    every = name_mirror_images(lying(shapes.box(20, 12, 5).difference(bore), ROOMY.track))
    level = [one for one in every if one.height < 0.006 and one.length > 0.019]
    shape, _, shift = chain.find_difference(level[0], level[1])
    off = 5.0 * 5.0 * np.pi * 2.5**2 / (20 * 12 * 5 - 5.0 * np.pi * 2.5**2)  # [mm] of the centre of mass
    assert shape < 2e-4
    assert max(abs(1e3 * by) for by in shift) == pytest.approx(2.0 * off, rel=0.02)
    tall = [one for one in every if one.height > 0.019 and one.length > 0.011]
    turned = next(one for one in tall if one.aspect != tall[0].aspect)
    reason = chain.inseparable_reason(tall[0], turned, MARGIN)
    assert "have the same outside" in reason and "needs a feature on the outside" in reason
    assert f"{2.0 * off:.2f} mm in height" in reason


ROLLING = bowls.read(None, ("track.width=30 mm", "track.climb=3 deg", "friction.wall=0.5"))


@pytest.fixture(scope="module")
def dowel():
    return coming(load("dowel_6x20"), ROLLING)


@pytest.mark.parametrize(
    ("name", "friction", "without", "stretches"),
    [
        ("A@0", 0.5, (), [("banked track", 7)]),  # atan(tan 3 deg / 0.5) = 5.98 deg, and a degree to spare
        ("A@0", 0.9, (), [("banked track", 6)]),
        ("A@90", 0.3, (), [("banked track", 11)]),  # 9.9 deg
        ("A@0", 0.1, (), [("V groove", 30), ("banked track", 6)]),
        ("A@0", 0.0, (), [("V groove", 30), ("banked track", 6)]),
        ("A@90", 0.1, (), []), ("A@0", 0.1, ("V groove",), []), ("A@0", 0.5, ("banked track",), []),
        ("B@86", 0.5, (), []),  # nothing rolls
    ],
)  # fmt: skip
def test_what_rolls_is_held_by_a_bank_or_lies_in_a_groove(dowel, name, friction, without, stretches):
    held = design.holding_stretches(named(dowel, name), friction, (), DesignConstraints(without=without))
    assert [(one.kind, pytest.approx(math.degrees(one.angle))) for one in held] == stretches
    leaning = replace(named(dowel, name), track=replace(ROLLING.track, bank=0.01))
    assert not design.holding_stretches(leaning, friction, (), FREE)
    assert not design.holding_stretches(named(dowel, name), friction, (slanted("banked track", 6),), FREE)


def test_the_design_of_a_dowel_begins_with_its_bank(dowel):
    own, part = {"search": ToolingSearch(rule="csa", vary=False)}, load("dowel_6x20")
    made = tooling(part, ROLLING, "A", heading=0.0, **own).design
    first, *others = made.cuts
    assert made.isolated and (first.device.kind, first.device.text) == ("banked track", "7 deg")
    assert np.isnan(first.margin_pass) and first.returns == ()
    assert made.devices == (first.device, *(cut.device for cut in others))
    own, headings = {"search": ToolingSearch(rule="csa"), "without": "banked track"}, (0.0, math.pi / 2)
    level, across = (tooling(part, ROLLING, "A", heading=one, **own).design for one in headings)
    assert all(cut.device.kind != "banked track" for cut in level.cuts)
    assert not across.isolated and "can roll back" in across.reasons[0]
    bank = design.holding_stretches(named(dowel, "A@90"), 0.3, (), FREE)[0]
    one = replace(named(dowel, "A@90"), wall_grip=0.3)
    assert one.may_roll_back and not bank.onward(one).may_roll_back
    # It leaves out of the groove in which what lies across turns.
    searches = [ToolingSearch(rule="csa", verdicts=1, vary=vary) for vary in (True, False)]
    varied, level = (tooling(part, BOWL, "A", heading=0.0, search=one).design for one in searches)
    assert [cut.device.text for cut in varied.cuts] == ["{angle: 55 deg}"]
    assert varied.isolated and varied.efficiency == pytest.approx(0.9927, abs=2e-4)
    assert level.efficiency == pytest.approx(0.8559, abs=2e-4)
    every = coming(part, BOWL)
    shares = np.array([one.chances["csa"] for one in every])
    bank = slanted("banked track", 6.0, "6 deg")
    grooves = {angle: slanted("V groove", angle, f"{{angle: {angle} deg}}") for angle in (15.0, 45.0, 55.0)}
    lying_along = {
        angle: design.coming_shares(every, shares, (one, bank))[0] for angle, one in grooves.items()
    }
    assert lying_along[45.0] == pytest.approx(shares[0])  # there what lies across stands on its end
    assert lying_along[15.0] == pytest.approx(shares[0], abs=8e-3)  # and there it rolls back first
    returned = shares[[one.returned for one in every]].sum()
    assert lying_along[55.0] == pytest.approx(shares.sum() - returned, abs=8e-3)


@pytest.mark.parametrize(
    ("values", "gains", "loses"),
    [
        ({"isolated": True, "purity": 0.4}, True, False), ({"purity": 0.52, "efficiency": 0.1}, True, False),
        ({"purity": 0.48, "efficiency": 0.4}, False, True), ({"efficiency": 0.205}, False, False),
        ({"efficiency": 0.22}, True, False), ({}, False, False),
    ],
)  # fmt: skip
def test_a_track_gives_more_that_isolates_or_is_purer_or_brings_more(values, gains, loses):
    best = SimpleNamespace(isolated=False, purity=0.5, efficiency=0.2)
    other = SimpleNamespace(**vars(best) | values)
    assert (design.gains(other, best), design.gains(best, other)) == (gains, loses)
    assert not design.gains(None, best)


def test_other_tracks_and_sweeps_are_tried_where_a_face_clears_itself(flat):
    every, shares = flat
    loose, firm = (SimpleNamespace(isolated=isolated, cuts=()) for isolated in (False, True))
    tracks = design.other_stretches(every[0], loose, FREE)
    assert [one[0].text for one in tracks] == ["6 deg", "10 deg", "15 deg"]
    assert design.other_stretches(every[0], firm, FREE) == []
    assert design.other_stretches(every[0], loose, DesignConstraints(without=("banked track",))) == []
    steep = replace(every[0], track=replace(every[0].track, bank=0.01))
    assert design.other_stretches(steep, loose, FREE) == []
    rough = [replace(one, grip=0.9) for one in every]
    for some, sweeps in ((every, [20, 45, 55]), (rough, [20, 45])):  # friction 0.6: below 59 deg
        devices = design.varied_devices(some, 0, MARGIN, FREE)
        assert [round(math.degrees(one.sweep)) for one in devices] == sweeps
    # A narrower track lets a pulse blow off what is heavy.
    assert design.widths(every, shares, 0, MARGIN) == []  # 9.4 g fly off 25 mm
    heavy = tuple(replace(one, posture=replace(one.posture, mass=0.1)) for one in every)
    (width,) = design.widths(heavy, shares, 0, MARGIN)
    sorter = device("vision reject", like=(heavy[0].aspect, heavy[0].heading, MARGIN))

    def blown(some):
        return [DeviceEncounter(k, some).blown(*sorter.jet.push(k, some), sorter.time) for k in some[1:]]

    far = [one.track.width + way for one, way in zip(heavy[1:], blown(heavy))]
    assert width == pytest.approx(math.floor(1e3 * min(far)) * 1e-3) and heavy[0].width < width < 25e-3
    there = tuple(replace(one, track=replace(one.track, width=width)) for one in heavy)
    assert min(blown(heavy)) < 0.0 < min(blown(there))


def test_what_falls_off_has_a_track_as_wide_as_it_is(tmp_path):
    narrow = bowls.read(None, ["track.width=9 mm"])
    search = ToolingSearch(rule="csa", verdicts=1)
    study = tooling(block(), narrow, "A", heading=math.pi / 2, search=search)  # 20 mm across
    made, one = study.design, study.orientations[study.wanted]
    assert made.isolated and made.width == study.bowl.track.width
    assert one.width + 1e-3 <= made.width < one.width + 2.1e-3 and not one.falls_off
    assert f"the track has to be {1e3 * made.width:g} mm wide" in made.reasons
    for settings in (["track.width=9 mm", "track.bank=0 deg"], []):
        (tmp_path / "tooling.yaml").write_text(tables.bowl_file(study, bowls.settings(None, settings)))
        assert bowls.read(tmp_path / "tooling.yaml").track.width == pytest.approx(made.width, abs=1e-12)
    search = replace(search, vary=False)
    assert tooling(block(), narrow, "A", heading=math.pi / 2, search=search).design.width is None


PROFILES = {  # [mm] radius, height
    "countersunk_m5": [(0, 0), (2.5, 0), (2.5, 13.2), (5.0, 15.7), (5.0, 16), (0, 16)],
    "nut": [(1.6, 0), (2.3, 0), (2.3, 2), (2, 2.4), (2, 2.9), (2.3, 3.3), (2.3, 5.7), (1.6, 5.7), (1.6, 0)],
}


def cut(every, wanted, kind, **values):
    one = device(kind, **values)
    must = np.array([chain.margin_at(one, other, every) <= -MARGIN for other in every])
    return chain.judge_cut(every, wanted, one, must, one, one), must


def test_a_device_that_changes_no_number_is_left_out_and_what_drops_parts_stays(flat):
    every, shares = flat
    wanted = every.index(named(every, "A@0"))  # 20 mm along the track
    task = design_task(every, shares, wanted, MARGIN, 1.0, ())
    first, gone = cut(every, wanted, "narrowed track", limit=every[wanted].balcony + 1e-3)
    repeat, also = cut(every, wanted, "narrowed track", limit=every[wanted].balcony + 2e-3)
    other, more = cut(every, wanted, "vision reject", like=("A", 0.0, 2e-3), sees="height")
    assert gone.any() and not (also & ~gone).any() and (more & ~gone).any()
    both = chain.propose_needed(task, (first, repeat), gone | also | ~task.stays)
    assert [one.device.limit for one in both.cuts] == [first.device.limit]
    alone = propose(task, (first,), gone | ~task.stays)
    assert (both.isolated, both.efficiency, both.purity) == (alone.isolated, alone.efficiency, alone.purity)
    two = chain.propose_needed(task, (first, other), gone | more | ~task.stays)
    assert [one.device.kind for one in two.cuts if not one.device.action.leans] == [
        "narrowed track",
        "vision reject",
    ]
    # One that alone returns a share by the margin stays, but of a share that is rare.
    rejected = np.array([one.name in first.returns for one in every])
    coming, rest = (np.where(rejected, 1e-6, some) for some in (task.coming, shares))
    rare = replace(task, coming=coming, shares=rest)
    assert chain.propose_needed(task, (first,), gone | ~task.stays).cuts
    assert not chain.propose_needed(rare, (first,), gone | ~task.stays).cuts


@pytest.mark.parametrize("name", PROFILES)
def test_no_device_of_these_parts_is_idle(name):
    part = shapes.part(trimesh.creation.revolve(PROFILES[name], sections=24), name)
    study = tooling(part, BOWL, "A", search=ToolingSearch(rule="csa", verdicts=1))
    made, every = study.design, study.orientations
    own = [one for one in made.cuts if not one.device.serves]
    assert own and all(one.device.serves for one in made.cuts if one not in own)
    task = design_task(every, study.shares, made.wanted, study.margin, 1.0, ())
    nothing = np.zeros(len(every), bool)
    whole = propose(task, own, nothing)
    for one in own:
        rest = propose(task, [other for other in own if other is not one], nothing)
        less = np.nan_to_num(rest.purity)  # NaN where nothing leaves without it
        assert abs(less - whole.purity) + abs(rest.efficiency - whole.efficiency) > 1e-3
    rows = tables.document(study)["chain"]
    assert all(bool(row["returns"] or row.get("stops")) != bool(row["serves"]) for row in rows)
