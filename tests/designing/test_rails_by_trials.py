"""Rails are proposed for every part with a head, and trials say what hangs: a short flanged part rolls."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
import shapes
import trimesh
from design_counts import end_at, short_trial, stopped_at

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing import calm_drive, exploring, hanging, proposals
from feederscrew.designing.findings import MoveKind
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.search import Search
from feederscrew.feeding import stream
from feederscrew.resting.aspects import find
from feederscrew.sorting.isolating import chain
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.sorting.isolating.rails import find_head
from feederscrew.sorting.orientations import hang, may_hang
from feederscrew.sorting.orientations import orientations as on_the_track
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import JammedParts

# a sleeve of 7 mm, 9 mm long with its flange of 12 mm: its head is as long as the part
SLEEVE = [(0, 0), (6, 0), (6, 1.5), (3.5, 1.5), (3.5, 9), (0, 9)]


@pytest.fixture(scope="module")
def sleeve():
    return shapes.part(trimesh.creation.revolve(np.array(SLEEVE, float), sections=32), "sleeve")


@pytest.fixture(scope="module")
def lying(sleeve):
    """Its orientations along a track of 14 mm."""
    track = bowls.default().track
    return on_the_track(sleeve, find(sleeve), replace(track, width=14e-3, bank=np.radians(3.0)))


@pytest.fixture
def rails_search(lying):
    shares = np.full(len(lying), 1.0 / len(lying))
    row = hanging.head_rows(lying, shares, range(len(lying)))[0]
    return hanging.RailsSearch(lying, shares, row, (), DesignRequest(0.5), 1)


def test_a_flange_wider_than_its_neck_is_a_head_whatever_rolls(lying):
    heads = [find_head(orientation) for orientation in lying]
    headed = [head for head in heads if head is not None]
    assert len(headed) == 2  # along the track, either way round
    for head in headed:  # the sleeve's own sizes, to a facet's sagitta
        assert head.shank == pytest.approx(7e-3, abs=0.1e-3)
        assert head.head == pytest.approx(12e-3, abs=0.4e-3)
    # of a step of less than 1 mm nothing hangs by its head
    low = np.array([(0, 0), (3.9, 0), (3.9, 1.5), (3.5, 1.5), (3.5, 9), (0, 9)], float)
    stepped = shapes.part(trimesh.creation.revolve(low, sections=32), "stepped")
    track = replace(bowls.default().track, width=14e-3)
    assert all(find_head(orientation) is None for orientation in on_the_track(stepped, find(stepped), track))


def test_rails_are_proposed_for_what_rolls(lying, rails_search):
    assert lying[rails_search.row].posture.kind == "rolling"
    first, bare = rails_search.start()
    kinds = [[cut.device.kind for cut in tried.proposal.cuts] for tried in (first, bare)]
    assert kinds[0][-2:] == ["rails", "wiper"] and kinds[1][-1] == "rails"
    slot = next(cut.device for cut in bare.proposal.cuts if cut.device.action is Action.HANG)
    assert 7e-3 < slot.span[1] - slot.span[0] < 8e-3
    assert may_hang(lying[rails_search.row], slot.span)
    # heads of what hangs pass below the blade, and it sweeps the foot of what lies over the slot
    blade = first.proposal.cuts[-1].device
    head = hang(lying[rails_search.row], slot.span).height
    assert head + 1e-3 <= blade.limit <= head + 4e-3


@pytest.mark.parametrize("left_out", ["rails", "wiper"])
def test_no_kind_of_device_is_proposed_that_the_user_left_out(lying, rails_search, left_out):
    request = DesignRequest(0.5, without=(left_out,))
    search = hanging.RailsSearch(lying, rails_search.shares, rails_search.row, (), request, 1)
    kinds = {cut.device.kind for tried in search.start() for cut in tried.proposal.cuts}
    assert left_out not in kinds and bool(kinds) == (left_out != "rails")


def trial_of(lying, search, proposal, held_at_blade):
    """A trial in which what has the head hangs, and one other orientation stands at the blade."""
    ways = type("Ways", (), {"lying": lying})()
    same = hanging.same_head(lying, find_head(lying[search.row]))
    right = [k for k in range(len(lying)) if same[k]]
    placed = [device.kind for device in proposal.devices if device.action.has_place]
    blade = stopped_at("wiper", placed.index("wiper") + 1)
    ends = tuple({blade: 2} if k == held_at_blade else {} for k in range(len(lying)))
    held = [] if held_at_blade is None else [held_at_blade]
    return short_trial(ways, right, held=held, row=search.row, ends=ends)


def test_what_stands_at_the_blade_asks_for_a_livelier_drive_then_cuts_then_sweeps(lying, rails_search):
    first = next(rails_search.start())
    other = next(k for k in range(len(lying)) if find_head(lying[k]) is None)
    trial = trial_of(lying, rails_search, first.proposal, other)
    shown = hanging.shown_by(trial, first.proposal, len(lying))
    assert shown.unswept[other] and not shown.stands.any() and not shown.gone[other]
    tries = list(rails_search.moves(first, trial))
    assert tries[0].is_livelier and tries[0].proposal is first.proposal
    assert not any(tried.is_livelier for tried in tries[1:])
    kinds = [tried.proposal.move.kind for tried in tries[1:]]
    assert MoveKind.SWEEP in kinds and MoveKind.SLOT_PLACE in kinds
    assert kinds.index(MoveKind.SWEEP) < kinds.index(MoveKind.SLOT_PLACE)
    chains = [tried.proposal.chain for tried in tries[1:]]
    assert len(set(chains)) == len(chains) and first.proposal.chain not in chains
    # where nothing stands there, the blade is left as it is
    clean = trial_of(lying, rails_search, first.proposal, None)
    kinds = {tried.proposal.move.kind for tried in rails_search.moves(first, clean)}
    assert MoveKind.SWEEP not in kinds and not any(t.is_livelier for t in rails_search.moves(first, clean))


def test_what_stands_in_a_queue_says_what_is_changed(lying, rails_search):
    """Another orientation is returned before; of one that hangs the slot, its lead-in or the blade change."""
    first = next(rails_search.start())
    proposal = first.proposal
    placed = [device.kind for device in proposal.devices if device.action.has_place]
    rails, blade = (placed.index(kind) + 1 for kind in ("rails", "wiper"))
    # what has no head is swept off by the blade
    trial = trial_of(lying, rails_search, proposal, None)
    swept = tuple({end_at(Fate.RETURNED, "wiper", blade): 2} if not right else {} for right in trial.right)
    trial = replace(trial, ends=swept)
    own, other = (
        next(one.name for one in lying if (find_head(one) is None) == is_other) for is_other in (False, True)
    )

    def changes(*jammed):
        search = hanging.RailsSearch(lying, rails_search.shares, rails_search.row, (), DesignRequest(0.5), 1)
        return list(search.mends_of_jams(proposal, trial, [JammedParts(*some) for some in jammed]))

    def slot(changed):
        return next(device for device in changed.devices if device.action is Action.HANG)

    at_rails = changes((own, rails, "rails", 2))
    kinds = [changed.move.kind for changed in at_rails]
    assert MoveKind.WIDER_SLOT in kinds and MoveKind.LEAD_IN in kinds and MoveKind.BLADE_HEIGHT not in kinds
    wider = at_rails[kinds.index(MoveKind.WIDER_SLOT)]
    widths = [np.ptp(slot(one).span) for one in (proposal, wider)]
    assert widths[0] + 2.5e-4 < widths[1] < widths[0] + 4e-4
    assert wider.rails.play == pytest.approx(3e-4)  # what is changed next goes on from there
    at_blade = changes((own, blade, "wiper", 1))
    kinds = [changed.move.kind for changed in at_blade]
    assert MoveKind.BLADE_HEIGHT in kinds and MoveKind.WIDER_SLOT not in kinds
    higher = at_blade[kinds.index(MoveKind.BLADE_HEIGHT)]
    assert higher.devices[-1].limit > proposal.devices[-1].limit
    # below a blade that was raised stands what has not sunk all the way
    proposal = higher
    kinds = [changed.move.kind for changed in changes((own, blade, "wiper", 1))]
    assert MoveKind.BLADE_HEIGHT not in kinds and kinds.count(MoveKind.WIDER_SLOT) == 1
    (sinks,) = (one for one in changes((own, blade, "wiper", 1)) if one.move.kind is MoveKind.WIDER_SLOT)
    before_it, after_it = slot(higher), slot(sinks)
    assert np.ptp(after_it.span) == pytest.approx(np.ptp(before_it.span) + 6e-4, abs=1e-4)
    assert after_it.lead[2] == pytest.approx(1.7 * before_it.lead[2], abs=1e-4)
    assert sinks.rails.blade == higher.rails.blade > 0.0
    proposal = first.proposal
    before = {MoveKind.CUTS_BEFORE, MoveKind.OTHER_CUTS}
    for place in (rails, blade):
        assert {changed.move.kind for changed in changes((other, place, "", 1))} <= before


OUTLINE = [(-5, 0), (5, 0), (5, 3), (3, 3), (3, 6), (-3, 6), (-3, 3), (-5, 3)]
NUT = shapes.part(trimesh.creation.extrude_polygon(shapely.Polygon(OUTLINE), 16.0), "nut")
NUT_TRACK = replace(bowls.default().track, width=18e-3, bank=np.radians(3.0))


@pytest.fixture(scope="module")
def nut():
    """Orientations of a T-nut of 16 mm along a track of 18 mm: base of 10 x 3 mm, neck of 6 x 3 mm."""
    return on_the_track(NUT, find(NUT), NUT_TRACK)


def search_of(lying):
    shares = np.full(len(lying), 1.0 / len(lying))
    row = hanging.head_rows(lying, shares, range(len(lying)))[0]
    return hanging.RailsSearch(lying, shares, row, (), DesignRequest(0.5), 1)


def cut_before(lying, name):
    """The chain with cuts before the rails because an orientation stood at the blade, and its trial."""
    search = search_of(lying)
    first, row = next(search.start()), next(k for k, one in enumerate(lying) if one.name == name)
    blade = [device.kind for device in first.proposal.devices if device.action.has_place].index("wiper") + 1
    trial = trial_of(lying, search, first.proposal, row)
    jam = JammedParts(name, blade, "wiper", 1)
    (proposal,) = (
        changed
        for changed in search.mends_of_jams(first.proposal, trial, [jam])
        if changed.move.kind is MoveKind.CUTS_BEFORE
    )
    return proposal, trial_of(lying, search_of(lying), proposal, row)


def kinds_before_rails(proposal):
    actions = [cut.device.action for cut in proposal.cuts]
    return [cut.device.kind for cut in proposal.cuts[: actions.index(Action.HANG)]]


def test_what_hangs_and_stands_at_a_cut_before_the_rails_asks_for_another_kind_of_cut(lying, nut):
    """A nut that hooks at a narrowed track went from one width to another and back."""
    # C@90 stands 10 mm high, what hangs 6 mm: a blade does what the narrowed track does
    proposal, trial = cut_before(nut, "C@90")
    assert kinds_before_rails(proposal) == ["narrowed track"]
    jam = JammedParts("B@0", 1, "narrowed track", 1)
    tries = list(search_of(nut).mends_of_jams(proposal, trial, [jam]))
    assert [changed.move.kind for changed in tries[:2]] == [MoveKind.VALUE, MoveKind.OTHER_CUTS]
    other = tries[1]
    assert kinds_before_rails(other) == ["wiper"] and "C@90" in other.cuts[0].returns
    assert 6e-3 < other.cuts[0].device.limit < 10e-3
    # a blade off the wall alone tells what stands as high as what hangs
    proposal, trial = cut_before(lying, "A@90")
    assert kinds_before_rails(proposal) == ["narrowed track"]
    wanted = lying[search_of(lying).row].name
    tries = list(search_of(lying).mends_of_jams(proposal, trial, [JammedParts(wanted, 1, "", 1)]))
    others = [changed for changed in tries if changed.move.kind is MoveKind.OTHER_CUTS]
    assert tries and all(kinds_before_rails(other) == ["silhouette blade"] for other in others)


@pytest.mark.parametrize(
    ("places", "first"),
    [({"C@90": 3}, MoveKind.CUTS_BEFORE), ({"C@90": 3, "B@0": 1}, MoveKind.OTHER_CUTS)],
)
def test_any_cuts_come_first_unless_what_hangs_stands_at_them(nut, places, first):
    """A track that was widened, as B@0 hooked there, lets C@90 past: it is narrowed, or a blade comes."""
    narrow, trial = cut_before(nut, "C@90")
    proposal = proposals.ease_cut(narrow, 1, nut)
    jammed = [JammedParts(name, place, "", 1) for name, place in places.items()]
    tries = list(search_of(nut).mends_of_jams(proposal, trial, jammed))
    both = [one for one in tries if one.move.kind in (MoveKind.CUTS_BEFORE, MoveKind.OTHER_CUTS)]
    assert next(one.move.kind for one in both) is first and len(both) == 2
    chains = {one.move.kind: one.cuts[0].device for one in both}
    assert chains[MoveKind.CUTS_BEFORE] == narrow.cuts[0].device
    assert chains[MoveKind.OTHER_CUTS].kind == "wiper"


def test_a_steady_jet_before_the_rails_blows_off_what_came_to_stand():
    """On its side a nut stands at any blade, and a queue pushes it past a narrowed track."""
    # with the friction of a track, which holds against air
    nut = stream.follow_orientations(NUT, find(NUT), NUT_TRACK, (), bowl=bowls.default()).lying
    proposal, trial = cut_before(nut, "C@270")
    rows = {one.name: row for row, one in enumerate(nut)}
    trial = replace(trial, shown=(rows["B@0"],))
    blown = hanging.blow_off(proposal, trial, [rows["C@270"], rows["B@0"]], nut)
    # where the track is whole: at a narrowed one a queue held C@90, which leans over the edge
    assert kinds_before_rails(blown) == ["air jet", "narrowed track"] and blown.cost_class == 2
    jet, narrowed = blown.cuts[:2]
    # above what hangs, 6 mm high, and below the top of what stands, 10 mm high
    assert 6e-3 < jet.device.height < 10e-3
    assert {"C@270", "C@90"} <= {*jet.returns} and not {"A@90", "B@0"} & {*jet.returns}
    # amid the widths that carry B@0, 4.8 mm, and the next one that is left to it, A@90, 7.9 mm
    needed = [chain.limits(type(narrowed.device), nut)[rows[name]] for name in ("B@0", "A@90")]
    assert narrowed.device.limit == pytest.approx(np.mean(needed), abs=1e-4)
    assert narrowed.device.limit > proposal.cuts[0].device.limit + 8e-4
    assert blown.cuts[2:] == proposal.cuts[1:]
    # where only what hangs stood, it is what the narrowed track returns that a queue pushed past it
    hooked = hanging.blow_off(proposal, trial, [rows["B@0"]], nut)
    assert [cut.device for cut in hooked.cuts] == [cut.device for cut in blown.cuts]
    assert hanging.blow_off(replace(proposal, cuts=proposal.cuts[1:]), trial, [rows["B@0"]], nut) is None
    # one jet is enough, and none where there are no rails
    assert hanging.blow_off(blown, trial, [rows["C@270"]], nut) is None
    assert hanging.blow_off(replace(proposal, cuts=()), trial, [rows["C@270"]], nut) is None
    # what changes it after a jam keeps the jet where it is
    swept = end_at(Fate.RETURNED, "wiper", 4)
    off = {end_at(Fate.RETURNED, "air jet", 1): 2}
    ends = ({} if row == rows["B@0"] else off if one.name in jet.returns else {swept: 2}
            for row, one in enumerate(nut))  # fmt: skip
    trial = replace(trial, ends=tuple(ends))
    changed = list(search_of(nut).mends_of_jams(blown, trial, [JammedParts("B@0", 3, "rails", 1)]))
    assert changed and all(kinds_before_rails(one)[0] == "air jet" for one in changed)
    # no cut has to return what it blows off, only what else stands
    jam = [JammedParts("A@90", 4, "wiper", 1)]
    changed = next(search_of(nut).mends_of_jams(blown, trial, jam))
    assert changed.move.kind is MoveKind.CUTS_BEFORE and changed.cuts[0] == jet
    assert kinds_before_rails(changed) == ["air jet", "narrowed track"]
    # C@270 asks for less than 6.1 mm
    assert "A@90" in changed.cuts[1].returns and changed.cuts[1].device.limit > 6.1e-3


def test_standing_counts_more_against_a_chain_than_coming_back(lying, rails_search):
    first = next(rails_search.start())
    stands = trial_of(lying, rails_search, first.proposal, next(
        k for k in range(len(lying)) if find_head(lying[k]) is None
    ))  # fmt: skip
    clean = trial_of(lying, rails_search, first.proposal, None)
    assert hanging.score(clean) == pytest.approx(clean.efficiency)
    assert hanging.score(stands) < hanging.score(clean) - stands.stopped


def test_a_livelier_drive_is_the_next_of_the_list_before_another_blade(sleeve):
    plain = bowls.default()
    plain_bowl = calm_drive.section(sleeve, find(sleeve), plain, frozenset(), diameter=None, bank=0.05)
    calm = calm_drive.drive_at(plain_bowl, 0.05)
    next_one = calm_drive.find_livelier(plain_bowl, calm, calm_drive.NEXT_LIVELIER_HOP, 0.0)
    far = calm_drive.find_livelier(plain_bowl, calm)
    hops = [calm_drive.hop(bowl).height for bowl in (calm, next_one, far)]
    assert 1.6 * hops[0] <= hops[1] < hops[2]


def test_hanging_is_searched_once_for_each_head_where_steel_is_asked_for(sleeve, monkeypatch):
    """And by nothing else: a design of what hangs tries no chain of what lies."""
    request = DesignRequest(0.5, outcome=OutcomeKind.HANGING, rule="csa")
    search = Search.begin(sleeve, request, bowls.default())
    searched, lying_rows = [], []
    monkeypatch.setattr(exploring, "_try_rails", lambda s, t, rails: searched.append(rails.row) or iter(()))
    monkeypatch.setattr(exploring, "_propose", lambda s, t, row, recipe: lying_rows.append(recipe.outcome))
    assert not list(exploring.candidates(search, proposals.COST_CLASSES[0]))
    assert len(searched) >= len(search.state.tracks)  # of each bank, and what the static rule proposes
    assert set(lying_rows) <= {OutcomeKind.HANGING}
    assert not search.state.attempts
