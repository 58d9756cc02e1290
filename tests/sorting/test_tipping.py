"""Orientations that the drive turns over or only rocks, and verdicts of parts that it throws."""

import math
from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapely
import shapes
import trimesh
from scipy.optimize import brentq

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import Shares
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.base import UNSURE
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.feeding import drive_settings as knobs
from feederscrew.feeding.rate import passages, rate
from feederscrew.feeding.stream import follow_orientations
from feederscrew.feeding.tune import tune
from feederscrew.machine.sheet import size_machine as sized
from feederscrew.motion.conveying import throw_number
from feederscrew.motion.floor_balance import TIP
from feederscrew.motion.hop import hop
from feederscrew.motion.track_balance import seat
from feederscrew.output import rate as rate_output
from feederscrew.output.tooling import passages as passage_table
from feederscrew.resting.aspects import find
from feederscrew.sorting import tipping as verdicts
from feederscrew.sorting.isolating.chain import candidates
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tipping import OVER, ROCKS, STAYS, over_period, steady, tipping
from feederscrew.sorting.tooling import ToolingSearch, tooling
from feederscrew.sorting.track import track
from feederscrew.sorting.verdicts import verdict

ROUGH = ("friction.static=0.9", "track.climb=1 deg")
SAID = "B@0 can tip over on the track at this drive and count as returned"
BOWL = bowls.read(None, ROUGH)
BOWL_STEADINESS = bowls.read(None, ["track.radius=100 m"])
CLEAR = 2.5e-4
FAST = ("drive.frequency=100 Hz", "drive.vibration_angle=20 deg", "track.bank=3 deg", "restitution=0.3")
AMPLITUDE = {0.9: 0.0655, 1.8: 0.1309, 2.4: 0.1746}  # [mm] by throw number, at 100 Hz


def pin(size):
    """A square pin four times as high as it is wide [mm]; its aspect B stands."""
    part = shapes.part(shapes.box(size, size, 4 * size))
    return part, find(part)


def studied(size, aspect=None):
    part, found = pin(size)
    return rate(part, BOWL, aspect, rule="csa", aspect_shares=Shares(found))


def tilts(size, bowl=BOWL):
    part, found = pin(size)
    known = follow_orientations(part, found, bowl.track)
    return known, tipping(known.lying, bowl)


def test_what_tips_over_lowers_the_rate_to_zero_and_what_rocks_passes():
    study = studied(1, "B")
    row, ways = study.rate.row, study.rate.orientations
    assert study.rate.parts.all == (0.0, 0.0, 0.0) and ways.passes[row, 0] == 0.0
    assert rate_output.remarks(study) == [f"{SAID}; rate is 0"] and ways.leaving[:, row].sum() == 0.0
    study = studied(10, "B")
    assert study.rate.parts.value > 0.0
    (line,) = rate_output.remarks(study)
    assert line.startswith("B@0 rocks on the track: a stroke tilts it by 1.6") and "from 14 deg" in line


def test_tilt_goes_with_size_and_the_square_of_the_period():
    """M / (m (r^2 + h^2)) has the unit 1/length at one throw; half a period enters squared."""
    one, large = (tilts(size)[1] for size in (1, 10))
    slow = bowls.read(None, (*ROUGH, "drive.frequency=25 Hz", "drive.amplitude=0.84 mm"))
    row = int(np.argmax(one.tips))
    assert one.tilt[row] == pytest.approx(10.0 * large.tilt[row], rel=2e-2)
    assert tilts(10, slow)[1].tilt[row] == pytest.approx(4.0 * large.tilt[row], rel=1e-6)
    assert np.degrees(one.balance[row]) == pytest.approx(np.degrees(np.arctan(0.25)), rel=1e-9)
    for more in ("drive.amplitude=0.5 mm", "drive.second_harmonic=0.3"):
        _, told = tilts(1, bowls.read(None, (*ROUGH, more)))
        assert not told.tips.any() and not told.over.any()


@pytest.fixture(scope="module")
def ball():
    part = shapes.part(shapes.ball(5.0, 3))
    return part, Shares(find(part))


def test_a_ball_rolls_back_and_is_not_counted_but_for_the_highest_rate(ball):
    part, known = ball
    made = rate(part, BOWL, "A", rule="csa", aspect_shares=known).rate
    (one,) = made.orientations.lying
    assert one.may_roll_back and not one.turns_over
    assert (made.parts.value, made.parts.low) == (0.0, 0.0)
    assert made.parts.high == pytest.approx(made.offered.high)
    with pytest.raises(FeederError, match=r"aspect A, heading .*: lies on its round side and rolls back"):
        tune(part, BOWL, "A", 1.0, rule="csa", aspect_shares=lambda bowl: known)
    with pytest.raises(FeederError, match=r"track\.climb: the part lies on its round side and rolls back"):
        sized(bowls.settings(None), part, 1.0, rule="csa", aspects=known.aspects)


@pytest.mark.parametrize(("share", "back"), [(0.99, True), (1.01, False)])
def test_a_banked_wall_holds_what_would_roll_back(ball, share, back):
    """The wall bears tan(bank) of the weight: from friction.wall tan(bank) = tan(climb) on it holds."""
    part, known = ball
    bank = share * np.arctan(np.tan(BOWL.track.climb) / BOWL.friction.wall)
    bowl = replace(BOWL, track=replace(BOWL.track, bank=float(bank)))
    made = rate(part, bowl, "A", rule="csa", aspect_shares=known).rate
    assert made.orientations.rolls_back.all() == back and (made.parts.value == 0.0) == back


def test_a_lying_pin_along_the_wall_is_not_in_the_way_of_those_across_it(monkeypatch):
    """It is said how many must come where few stay on the track."""
    part = shapes.part(shapes.cylinder(3.0, 20.0, 48))
    study = rate(part, BOWL, "A", heading=0.0, rule="csa", aspect_shares=Shares(find(part)))
    made, ways = study.rate, study.rate.orientations
    back, chance, on = ways.rolls_back, ways.rules["csa"], ways.stays > 0.0
    assert back.any() and not back[made.row] and not (on & back).any()
    assert made.efficiency == pytest.approx(chance[made.row] / chance[on].sum())
    assert made.parts.value == pytest.approx(made.offered.value * made.efficiency)
    share = float((chance * ways.stays).sum())
    assert 0.0 < share < 1.0

    def said(**parts):
        other = replace(study, rate=replace(made, parts=replace(made.parts, **parts)))
        return [line for line in rate_output.remarks(other) if "at the entry" in line]

    assert said() == []
    monkeypatch.setattr(rate_output, "SCARCE", share + 0.01)
    text = f"{100.0 * share:.2g} % of the parts at the entry stay on the track: this rate needs "
    text += f"{60.0 * made.offered.value / share:,.0f} parts a minute there"
    assert said() == [text] and said(low=0.0) == [f"{text}, and is 0 if none stays"]


def test_tune_tooling_passages_and_a_sized_bowl_reckon_without_what_tips_over():
    part, found = pin(1)
    own = {"rule": "csa", "aspect_shares": lambda bowl: Shares(found)}
    study = tune(part, BOWL, "A", 400.0 / 60.0, **own)
    assert {one.over for one in study.settings} == {("B@0",), ()}
    for one in study.settings:
        driven = knobs.turned(BOWL, one.solution.key, one.solution.value)
        parts = rate(part, driven, "A", rule="csa", aspect_shares=Shares(found)).rate.parts
        assert parts.value == pytest.approx(400.0 / 60.0, rel=knobs.ACCEPTED_RATE_ERROR)
        assert parts.value == pytest.approx(one.solution.rate, rel=1e-9)
    standing = tune(part, BOWL, "B", 5.0 / 60.0, **own)
    assert {one.solution.answer.regime for one in standing.settings} == {"hop"}
    study = tooling(part, BOWL, search=ToolingSearch(rule="csa"), aspect_shares=found)
    assert study.warnings == (SAID,)
    isolated = {one.name: made for one, made in zip(study.orientations, study.designs)}
    assert isolated["B@0"].reasons == ("B@0 can tip over on the track at this drive",)
    assert isolated["A@0"].isolated and "B@0" not in isolated["A@0"].left_over
    told = passage_table(passages(part, BOWL, found, "csa"))
    assert dict(zip(told["orientation"], told["outcome"]))["B@0"] == "tips over on the track"
    given = bowls.settings(None, (*ROUGH, "drive.frequency=50 Hz", "track.radius=60 mm"))
    sheet = sized(given, part, 8.0, rule="csa", aspects=found)
    ways = follow_orientations(part, found, sheet.bowl.track, bowl=sheet.bowl)
    on = ways.rules["csa"][ways.stays > 0.0]
    assert sheet.order.flow.share == pytest.approx(1.0)  # of what stays on the track, all of it leaves
    assert sheet.order.flow.parts == pytest.approx(on.sum() / (on * ways.lengths[ways.stays > 0.0]).sum())
    assert sheet.rates(sheet.answer.velocity) >= 8.0 - 1e-9
    assert on.sum() < 1.0 - 1e-3 and SAID in sheet.remarks


@pytest.mark.parametrize(("size", "aspect", "way"), [(1, "B", OVER), (2, "B", ROCKS), (10, "A", STAYS)])
def test_the_track_says_what_the_rate_reckons_with(size, aspect, way):
    part, _ = pin(size)
    study, (known, tips) = track(part, BOWL, aspect), tilts(size)
    row, stands = known.aspects.index(aspect), study.stands
    assert stands.verdict == way and (TIP in study.cycle.state) == bool(tips.tips[row])
    assert (stands.tilt > 0.0) == bool(tips.tips[row])
    if way == ROCKS:
        assert stands.tilt == pytest.approx(tips.tilt[row], rel=1e-9)
        assert f"rocks by {np.degrees(stands.tilt):.2g} deg a stroke" in stands.sentence


def test_a_skew_body_goes_on_by_itself_from_where_its_weight_is_over_a_side_of_its_face():
    """At atan(d / h): h over the face on which it lies, d from one of the sides between its corners."""
    bowl = awkward.plain_bowl("friction.static=0.9", "friction.kinetic=0.85", "friction.wall=0.8")
    lying, leans = awkward.lying(), []
    told = tipping(lying, bowl)
    for one, tips, tilt, lean in zip(lying, told.tips, told.tilt, told.balance):
        seen = (one.posture.solid.vertices - one.posture.solid.centre_of_mass) @ one.axes.T
        height = -seen[:, 2].min()
        face = shapely.MultiPoint(seen[seen[:, 2] < -height + 1e-7, :2]).convex_hull
        corners = shapely.get_coordinates(face)
        along = np.diff(corners, axis=0)
        sides = abs(along[:, 0] * corners[1:, 1] - along[:, 1] * corners[1:, 0]) / np.hypot(*along.T)
        assert (tilt > 0.0) == tips == np.isfinite(lean)
        if tips:
            assert min(abs(np.arctan2(sides, height) - lean)) < 1e-6
            leans.append(round(float(lean), 6))
    assert len(set(leans)) > 3


@pytest.fixture(scope="module")
def upright():
    part = shapes.part(shapes.box(10, 10, 14))
    return next(one for one in orientations(part, find(part), BOWL_STEADINESS.track) if one.height > 0.012)


def is_steady(one, kind, limit, bowl=BOWL_STEADINESS, margin=CLEAR):
    (found,) = steady([make_device(kind, "test", limit=limit)], [one], bowl, margin)
    return found


def farthest(one):
    """Farthest that the force of the track acts from below the centre of mass [m]."""
    place = seat(one.posture, one.heading, one.touching, BOWL_STEADINESS.track.bank)
    return float(np.abs(over_period(place, BOWL_STEADINESS)[1][:, 0]).max())


@pytest.mark.parametrize("carried, steadily", [(1e-5, 0), (5e-5, 0), (1e-4, 0), (2e-3, 1), (4e-3, 1)])
def test_over_a_gap_a_part_rocks_over_where_little_carries_it(upright, carried, steadily):
    """Half its width less the gap, well below the force's farthest place; a hole across is as a gap."""
    assert 2e-3 < farthest(upright) < 4.9e-3 and upright.gap == pytest.approx(5e-3, abs=1e-6)
    limit = upright.gap - carried
    assert is_steady(upright, "gap", limit) == steadily
    corners = ((0.0, 0.0), (limit, 0.0), (limit, 0.1), (0.0, 0.1))
    (hole,) = steady([make_device("cut-out", "test", corners=corners)], [upright], BOWL_STEADINESS, CLEAR)
    assert hole == steadily


@pytest.mark.parametrize("kind", ["narrowed track", "canyon"])
def test_beside_an_edge_along_the_track_the_force_stays_within_what_is_left(upright, kind):
    """Ahead and behind half the width is left, to the side what the edge leaves."""
    ahead = 5e-3 - farthest(upright)
    limits = {"narrowed track": (6e-3, 12e-3), "canyon": (4e-3, 0.0)}[kind]
    assert is_steady(upright, kind, limits[0], margin=min(ahead, 1e-3) - 1e-6)
    assert not is_steady(upright, kind, limits[0], margin=min(ahead, 1e-3) + 1e-6)
    assert is_steady(upright, kind, limits[1], margin=1.0)  # which takes nothing from it


def test_what_rolls_along_the_track_rocks_over_a_gap_and_behind_rails_nothing_is_said(upright):
    """What rolls across it is not followed: only what takes nothing from it leaves it as it is."""
    along = replace(upright, kind="rolling", posture=replace(upright.posture, axis=np.array([1.0, 0.0])))
    across = replace(along, posture=replace(along.posture, axis=np.array([0.0, 1.0])))
    for carried, steadily in ((0.01e-3, False), (2e-3, True)):
        assert is_steady(along, "gap", upright.gap - carried) == steadily
        assert not is_steady(across, "gap", upright.gap - carried)
    assert is_steady(across, "canyon", 0.0)
    limit = upright.gap - 0.01e-3
    rails, gap = make_device("rails", "test", span=(0.1, 0.11)), make_device("gap", "test", limit=limit)
    assert steady([rails, gap], [upright], BOWL_STEADINESS, CLEAR).all()
    assert not steady([gap, rails], [upright], BOWL_STEADINESS, CLEAR).any()
    assert is_steady(replace(upright, touching=None), "gap", limit)
    for more in ("drive.amplitude=0.5 mm", "drive.second_harmonic=0.3"):
        assert is_steady(upright, "gap", limit, bowls.read(None, ["track.radius=100 m", more]))


@pytest.mark.parametrize("bank", [0.0, 3.0])
def test_what_is_round_is_sure_of_nothing_without_a_bank(bank):
    """A pin along the track rolls off a level one; towards the wall of a banked one it rolls, and stays."""
    pin = shapes.part(shapes.cylinder(6, 20, 48))
    bowl = bowls.read(None, ["track.width=30 mm", f"track.bank={bank} deg"])
    sorter = make_device("vision reject", "test", like=("A", 0.0, 2e-3), sees="height")
    found = follow_orientations(pin, find(pin), bowl.track, [sorter], bowl=bowl)
    row = next(k for k, one in enumerate(found.lying) if one.kind == "rolling" and one.length > 0.019)
    assert found.sure[row] == (bank > 0.0)


def thrown(throw, *more):
    return bowls.read(None, (*FAST, f"drive.amplitude={AMPLITUDE[throw]} mm", *more))


def lying(bowl, *sizes, chain=()):
    part = shapes.part(shapes.box(*sizes))
    return follow_orientations(part, find(part), bowl.track, chain, bowl=bowl)


def one_of(bowl, *sizes, length):
    """The orientation of the lowest aspect of a box that is so long [mm] along the track."""
    every = lying(bowl, *sizes).lying
    found = [one for one in every if math.isclose(one.length, 1e-3 * length, rel_tol=1e-3)]
    return min(found, key=lambda one: one.height)


@pytest.mark.parametrize(("kind", "values", "less"), [
    ("gap", {"limit": 8e-3}, "flight"),
    ("gap", {"limit": 18e-3}, "flight"),
    ("wiper", {"limit": 6e-3}, "hop"),
    ("wiper", {"limit": 4e-3}, "hop"),
    ("height bar", {"limit": 6e-3}, "hop"),
    ("narrowed track", {"limit": 10e-3}, "hop"),
    ("narrowed track", {"limit": 4e-3}, "hop"),
    ("vision reject", {"sees": "side"}, "hop"),
    ("vision reject", {}, ""),
    ("rails", {"span": (4e-3, 8e-3)}, ""),
])  # fmt: skip
def test_a_margin_is_less_the_hop_or_the_flight_to_either_side(kind, values, less):
    """Over a gap the way of a flight; under a blade and beside a ledge the height of the hop."""
    bowl = thrown(1.8)
    known = hop(bowl)
    one = one_of(bowl, 20, 12, 5, length=20)
    assert (one.hop, one.flight) == (known.height, known.flight) and 0.0 < one.hop < one.flight
    values = values | ({"like": (one.aspect, one.heading, 2e-3)} if kind == "vision reject" else {})
    device, still = make_device(kind, "", **values), replace(one, hop=0.0, flight=0.0)
    by = getattr(one, less) if less else 0.0
    found, before = verdict(device, one, (one,)), verdict(device, still, (still,))
    assert abs(before.margin) > 2.0 * by
    assert found.margin == pytest.approx(before.margin - math.copysign(by, before.margin), abs=1e-12)
    assert found.passes == before.passes


@pytest.mark.parametrize(("hops", "passes"), [(0.9, 1.0), (-0.9, 0.0), (1.1, 1.0), (-1.1, 0.0)])
def test_within_a_hop_nothing_is_sure_either_way(hops, passes):
    one = one_of(thrown(2.4), 20, 12, 5, length=20)
    found = verdict(make_device("wiper", "", limit=5e-3 + hops * one.hop), one)
    assert found.passes == passes and found.sure == (abs(hops) > 1.0) == (abs(found.margin) > UNSURE)


def test_a_drive_that_does_not_throw_changes_nothing_and_a_design_keeps_its_margin():
    for one in lying(thrown(0.9), 20, 12, 5).lying:
        assert (one.hop, one.flight, one.may_tip) == (0.0, 0.0, False)
    assert not any(one.may_yaw for one in lying(thrown(0.9, "track.bank=0 deg"), 20, 10, 5).lying)
    every = lying(thrown(2.4), 20, 12, 5).lying
    wanted = int(np.argmin([one.height - one.length for one in every]))
    for device, margins in candidates(every, wanted, 2.5e-4).items():
        assert margins[wanted] >= 2.5e-4 - 1e-9, device.kind
    part = shapes.part(shapes.cylinder(7, 5, 48))
    flat = follow_orientations(part, find(part), thrown(1.8).track, bowl=thrown(1.8)).lying[0]
    assert flat.kind == "flat" and not flat.may_yaw


@pytest.mark.parametrize(("length", "tips"), [(11.9, True), (12.1, False)])
def test_the_track_drags_the_foot_away_below_what_is_higher_than_its_friction_allows(length, tips):
    """mu h > b: 0.6 x 10 mm against half the length; the hop at the throw number 1.8 is 0.04 mm."""
    assert one_of(thrown(1.8), length, 25, 20, length=length).may_tip == tips


@pytest.mark.parametrize(("x", "y", "share"), [(4.0, 9.0, 1.0), (9.0, 4.0, 0.25 * 1.3**2)])
def test_the_energy_of_a_landing_lifts_a_part_over_its_side(x, y, share):
    """sqrt(h^2 + b^2) - h = 1 mm at h = 7.5 mm, b = 4 mm; across, (1 + e)^2 / 4 of the energy, by hand."""
    bowl = thrown(1.8, "friction.static=0.05", "friction.wall=0.6")
    one = one_of(thrown(1.8), 30, 30.1, 15, length=30)
    contact = 1e-3 * np.array([[-x, -9.0], [x, -9.0], [x, y], [-x, y]])
    assert one.posture.height == pytest.approx(7.5e-3)
    for energy, tips in ((1.02e-3, True), (0.98e-3, False)):
        assert verdicts.may_tip(contact, one, bowl, energy / share) == tips
    assert verdicts.may_tip(contact, one, bowl, 0.98e-3 / share, margin=2e-4)


def test_the_energy_is_that_of_the_hardest_landing():
    """The parabola of a plastic point mass between take-off, sin(a) = 1 / k, and landing; nothing below 1."""
    bowl = thrown(1.8, "restitution=0")
    k, rate = throw_number(bowl), 2.0 * math.pi * bowl.drive.frequency
    weight = bowl.gravity * math.cos(bowl.track.climb)

    def gap(turn):
        way = turn - leaves
        return k * (math.sin(leaves) - math.sin(turn) + math.cos(leaves) * way) - 0.5 * way**2

    leaves = math.asin(1.0 / k)
    lands = brentq(gap, leaves + 1.0, leaves + 6.0)
    speed = weight / rate * (k * (math.cos(leaves) - math.cos(lands)) - (lands - leaves))
    assert verdicts.landing_energy(bowl) == pytest.approx(speed**2 / (2.0 * bowl.gravity), rel=5e-3)
    assert verdicts.landing_energy(thrown(0.9)) == 0.0


@pytest.mark.parametrize(("wide", "yaws"), [(11.0, True), (13.0, False)])
def test_the_wall_turns_what_it_holds_before_its_corner(wide, yaws):
    """mu d > x: 0.6 x 10 mm against half of what lies at the wall, thrown or pressed on by a bank."""
    for bowl in (thrown(1.8), thrown(1.8, "track.bank=0 deg"), thrown(0.9)):
        assert one_of(bowl, 20, wide, 4, length=wide).may_yaw == yaws
    assert one_of(bowl, 20, wide, 4, length=wide).may_yaw == yaws
    assert not one_of(bowl, 20, wide, 4, length=20).may_yaw


def test_nothing_that_may_turn_or_stands_on_little_of_a_foot_is_sure():
    bowl = thrown(1.8)
    known = lying(bowl, 20, 10, 4)
    assert known.sure.tolist() == [not one.may_turn for one in known.lying]
    flat = known.lying[0].aspect
    yaws = np.array([one.may_yaw and not one.may_tip for one in known.lying])
    assert yaws[[one.aspect == flat for one in known.lying]].any()
    high = lying(bowl, 20, 10, 4, chain=(make_device("narrowed track", "", limit=1e-3),))
    rows = np.array([one.aspect == flat for one in high.lying])
    assert high.sure[rows].all() and (high.through[rows] == 0.0).all()
    # Half a width of 6 mm over a ledge: 1.3 mm remain of the 10 mm high block; 5.9 mm hold it
    bowl = thrown(2.4)
    one = one_of(bowl, 30, 12, 10, length=30)
    for limit, holds in ((7.3e-3, False), (11.9e-3, True)):
        device = make_device("narrowed track", "", limit=limit)
        assert verdict(device, one).passes == 1.0
        assert steady((device,), [one], bowl, 2.5e-4).tolist() == [holds]


@pytest.mark.parametrize("bank", [0.0, 2.0])
def test_a_disc_on_a_stem_along_a_banked_track_is_carried(bank):
    """It rolls in a circle into the wall: docs/conveying.md has 222 of 224 such rows of trials."""
    outline = [(0, 0), (7.5, 0), (7.5, 2), (3, 2), (3, 15), (0, 15)]
    part = shapes.part(trimesh.creation.revolve(np.array(outline, float), sections=40))
    slope = {"climb": float(np.radians(3.0)), "bank": float(np.radians(bank))}  # too little to hold a ball
    bowl = replace(BOWL, track=replace(BOWL.track, **slope))
    lying = follow_orientations(part, find(part), bowl.track, bowl=bowl).lying
    rolling = [one for one in lying if one.kind == "rolling"]
    assert {one.rolls_along for one in rolling} == {True, False}
    for one in rolling:
        assert one.may_roll_back == (not one.rolls_along or bank == 0.0)
