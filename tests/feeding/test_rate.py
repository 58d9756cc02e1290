"""Parts per minute: the chain of factors, whose shares they take, devices, and settings that reach a rate."""

import math
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import awkward
import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew import bowl as bowls
from feederscrew.arrivals import arrival as floor
from feederscrew.arrivals import entry
from feederscrew.base import units
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.feeding import drive_settings, stream, well_oriented
from feederscrew.feeding import rate as study
from feederscrew.feeding.stream import follow_orientations
from feederscrew.feeding.well_oriented import Range
from feederscrew.motion import conveying as answer
from feederscrew.motion.track_balance import seat
from feederscrew.output import rate as rate_output
from feederscrew.part.loading import load
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.sorting import tipping

OWN = "drive.peak_to_peak=1 mm", "drive.frequency=50 Hz", "restitution=0", "friction.static=0.4"
BOWL = bowls.read(None, OWN)
STRAIGHT = replace(BOWL.track, radius=1e6, climb=0.0, bank=0.0, width=0.1)
PARTS = Path(__file__).parents[2] / "parts"
LSHAPE = [(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)]
KNOWN = SimpleNamespace(
    names=("track", "wiper_1", "gap_2", "gap_3"),
    stations=("track", "wiper", "gap", "gap"),
    aspects=("A", "A", "B"),
    heading_shares=np.array([0.25, 0.75, 1.0]),
    passes=np.array([[1.0, 0.5, 1.0, 0.0], [1.0, 1.0, 0.0, 1.0], [0.0, 1.0, 0.4, 1.0]]),
)
shares = st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3).map(np.array)
SPEED = Range(0.04, 0.03, 0.05)
SLOW = bowls.read(None, ["drive.frequency=50 Hz", "drive.amplitude=0.1 mm", *OWN[2:], "track.climb=2 deg"])
PER_METRE = 10.0


def streamed(mesh, chain=()):
    part = shapes.part(mesh)
    found = find(part)
    return part, found, follow_orientations(part, found, STRAIGHT, chain)


@pytest.fixture(scope="module")
def box():
    return streamed(shapes.box(10, 20, 30))


@pytest.fixture
def chain(tmp_path):
    def read(text):
        (tmp_path / "bowl.yaml").write_text(text)
        return bowls.read(tmp_path / "bowl.yaml").devices

    return read


def test_a_spacing_section_is_asked_for_where_the_chain_has_none(tmp_path):
    """Before the camera: one behind it parts nothing that the camera looks at."""
    block, lines = shapes.part(shapes.box(20, 12, 5)), {}
    camera = "  - vision reject: {of: A@0, play: 2 mm, sees: outline, jet: {time: 25 ms}}\n"
    section = "  - spacing section: {climb: -4 deg}\n"
    for name, chain in (("none", camera), ("before", section + camera), ("behind", camera + section)):
        (tmp_path / f"{name}.yaml").write_text(f"devices:\n{chain}")
        rated = study.rate(block, bowls.read(tmp_path / f"{name}.yaml"), "A", rule="csa")
        (lines[name],) = [line for line in rate_output.remarks(rated) if "one part at a time" in line]
    asks = {name for name, line in lines.items() if "a spacing section before it" in line}
    assert asks == {"none", "behind"}


def test_headings_equal_under_a_turn_are_one_and_their_probabilities_sum_to_one(box):
    # a box on each of three faces lies lengthwise or crosswise; either end ahead is the same
    _, found, known = box
    assert found.names == ("A", "B", "C") and known.aspects == ("A", "A", "B", "B", "C", "C")
    assert sorted(np.round(known.lengths[:2] * 1e3, 9)) == [20.0, 30.0]
    for pair in (0, 2, 4):
        assert known.heading_shares[pair : pair + 2].sum() == pytest.approx(1.0, abs=1e-9)
    # an L on its back does not map to itself by half a turn
    _, _, bracket = streamed(shapes.prism(LSHAPE, 15))
    assert bracket.aspects.count("A") > 2
    for chances in bracket.rules.values():
        assert chances.sum() == pytest.approx(1.0, abs=1e-9)


def test_rate_is_the_product_of_its_chain(box):
    part, found, known = box
    target = well_oriented.wanted(part, found, STRAIGHT, "A")
    made = well_oriented.rate(known, Range(0.1, 0.05, 0.2), target, "csa", gap=5e-3, fill=0.8)
    row, chance = made.row, known.rules["csa"]
    assert made.pitch == pytest.approx((chance * (known.lengths + 5e-3)).sum())
    assert made.offered.value == pytest.approx(0.1 * 0.8 / made.pitch)
    assert made.efficiency == pytest.approx(chance[row]) and made.purity == pytest.approx(chance[row])
    assert made.parts.value == pytest.approx(made.offered.value * made.efficiency)
    assert made.parts.low <= made.parts.value <= made.parts.high
    chances = [chance[row] for chance in known.rules.values()]
    assert made.parts.high == pytest.approx(0.2 / made.pitch * max(chances) * 0.8)
    density = well_oriented.parts_per_metre(known, target, "csa", gap=5e-3, fill=0.8)
    assert made.parts.value == pytest.approx(0.1 * density)


@pytest.mark.parametrize(("width", "wanted"), [(25, 5.607), (14, 5.775), (8, 8.221)])
def test_what_falls_off_at_the_entry_is_in_nobodys_way(width, wanted):
    """A narrower track: fewer ways to lie on it, so more of what is on it is as wanted."""
    bowl = bowls.read(None, (f"track.width={width} mm",))
    part = load(PARTS / "lbracket_30x20x15.stl")
    found = find(part)
    target = well_oriented.wanted(part, found, bowl.track, "A")
    known = follow_orientations(part, found, bowl.track)
    made = well_oriented.rate(known, well_oriented.velocity(bowl), target, "quasistatic")
    assert made.parts.value * 60 == pytest.approx(wanted, abs=5e-4)
    chance, stays = known.rules["quasistatic"], known.passes[:, 0] == 1.0
    assert 0 < stays.sum() < len(stays)
    assert made.pitch == pytest.approx((chance * known.lengths)[stays].sum() / chance[stays].sum())
    assert made.efficiency == pytest.approx(chance[made.row] / chance[stays].sum())
    assert made.efficiency == pytest.approx(made.purity)
    assert made.parts.value == pytest.approx(made.offered.value * made.efficiency)
    density = well_oriented.parts_per_metre(known, target, "quasistatic")
    assert made.parts.value == pytest.approx(made.velocity.value * density)


def test_what_never_leaves_and_rules_and_aspects_that_do_not_exist_give_no_rate(box):
    part, found, known = box
    target = well_oriented.wanted(part, found, STRAIGHT, "A", heading=0.0)
    _, _, blade = streamed(shapes.box(10, 20, 30), [make_device("wiper", "test", limit=5e-3)])
    made = well_oriented.rate(blade, Range(0.1, 0.1, 0.1), target, "pmi")
    assert made.parts.value == 0.0 and np.isnan(made.purity)
    with pytest.raises(FeederError, match="never leaves the bowl - see the devices"):
        well_oriented.parts_per_metre(blade, target, "pmi")
    gone = replace(known, passes=np.zeros_like(known.passes), leaving=np.zeros_like(known.leaving))
    assert well_oriented.rate(gone, Range(0.1, 0.1, 0.1), target, "csa").parts.all == (0.0, 0.0, 0.0)
    assert np.isnan(well_oriented.mean_length(gone, "csa"))
    target = well_oriented.wanted(part, found, STRAIGHT, "a")
    with pytest.raises(FeederError, match=r"^rule guess: has no probabilities of this part - known are pmi"):
        well_oriented.rate(known, Range(1, 1, 1), target, "guess")
    with pytest.raises(FeederError, match="there is no aspect"):
        well_oriented.wanted(part, found, STRAIGHT, "Z")


@pytest.mark.parametrize("of", ["A@352", "A@90"])
def test_of_an_aspect_the_heading_is_wanted_that_the_devices_let_leave(of, tmp_path):
    """A camera keeps another way up than the most frequent, as `feeder tooling` may write."""
    part = load(PARTS / "hexbolt_m8x25.stl")
    found = find(part)
    devices = tmp_path / "devices.yaml"
    devices.write_text(f"devices:\n  - sorter: {{of: {of}, play: 3 mm}}\n")
    chain = bowls.read(devices).devices
    target = well_oriented.wanted(part, found, STRAIGHT, "A", devices=chain)
    assert np.degrees(target[1]) == pytest.approx(float(of[2:]), abs=1.0)
    queue = follow_orientations(part, found, STRAIGHT, chain)
    assert well_oriented.parts_per_metre(queue, target, "csa") > 0.0
    given_heading = well_oriented.wanted(part, found, STRAIGHT, "A", np.radians(188.0), chain)
    assert np.degrees(given_heading[1]) == pytest.approx(188.0, abs=1.0)
    none_so = well_oriented.wanted(part, found, STRAIGHT, "B", devices=chain)
    assert none_so == well_oriented.wanted(part, found, STRAIGHT, "B")


def bouncing(restitution):
    """A bowl whose parts hop: throw number 1.84, where a harder bounce is a slower travel."""
    drive = replace(BOWL.drive, amplitude=0.3e-3, frequency=60.0, vibration_angle=np.radians(25.0))
    friction = replace(BOWL.friction, static=0.6, kinetic=0.6, wall=0.6)
    return replace(BOWL, drive=drive, friction=friction, restitution=restitution)


def test_velocity_brackets_friction_starts_and_the_spread_of_restitution_where_parts_hop():
    """An even range of one standard deviation of 16 % about 0.2 ends at 0.145 and 0.255."""
    found, plain = well_oriented.velocity(BOWL), answer.answer(BOWL).velocity
    softer = answer.answer(answer.scaled(BOWL, friction=0.8)).velocity
    assert found.value == pytest.approx(plain)
    assert found.low <= min(softer, found.value) and found.high >= max(softer, found.value)
    found = well_oriented.velocity(bouncing(0.2))
    assert found.value == answer.answer(bouncing(0.2)).velocity
    for end in (0.2 * (1 - 0.16 * 3**0.5), 0.2 * (1 + 0.16 * 3**0.5)):
        at_end = answer.answer(bouncing(end)).velocity
        assert abs(at_end - found.value) > 0.04 * found.value and found.low <= at_end <= found.high


def test_a_part_that_travels_back_gives_no_rate_and_no_steady_state_is_a_fault():
    drive = replace(BOWL.drive, vibration_angle=np.radians(15))
    back = replace(BOWL, drive=drive, friction=replace(BOWL.friction, static=0.2, kinetic=0.2))
    assert answer.answer(back).velocity < 0.0 and well_oriented.velocity(back).value == 0.0
    with pytest.raises(FeederError, match=r"track\.climb: is steeper than friction holds"):
        well_oriented.velocity(replace(BOWL, track=replace(BOWL.track, climb=0.6)))


def test_heights_decide_wiper_and_bar(chain):
    devices = chain("devices:\n  - wiper: 20 mm\n  - height_bar: 19.9 mm")
    known = streamed(shapes.box(10, 20, 30), devices)[2]
    assert known.stations == ("track", "wiper", "height bar")
    assert known.passes.T.tolist() == [[1.0] * 6, [1, 1, 1, 1, 0, 0], [1, 1, 0, 0, 0, 0]]
    assert known.through.tolist() == [1, 1, 0, 0, 0, 0]


@pytest.mark.parametrize(("text", "line"), [
    (": 5 mm\n", "1:1: devices is not a list - write one '- wiper: 6 mm' a line"),
    (":\n  - wiper\n", "2:5: is not a device - write one '- wiper: 6 mm' a line"),
    (":\n  - wipr: 6 mm\n", "2:5: unknown device 'wipr' - did you mean wiper?"),
    (":\n  - wiper: 6\n", "2:12: wiper: '6' has no unit - write 6 mm"),

    (":\n  - yield:\n      A: 1.5\n", "3:10: measured yield of A is 1.5 - give 0 to 1"),
    (":\n  - yield: 0.5\n",
     "2:5: measured yield names no aspect - write below it one line an aspect, as 'A: 0.9'"),
])  # fmt: skip
def test_faults_of_devices(tmp_path, chain, text, line):
    with pytest.raises(FeederError) as caught:
        chain("devices" + text)
    assert caught.value.lines == (f"{tmp_path}/bowl.yaml:{line}",)


def counted(*rows):
    text = "\n".join(["device,passed,rejected", *rows])
    return profiles.device_counts(profiles.parse_count_sheet(text, "c.csv"), "c.csv", "")


def test_parts_and_devices_are_followed_by_their_names():
    flow = stream.station_shares(KNOWN, ("A", "B", "C"))
    np.testing.assert_allclose(flow[0], [[1, 1, 0], [1, 0, 0], [0.875, 0, 0], [0.125, 0, 0]])
    share = stream.passing_shares(flow, np.array([0.5, 0.2, 0.3]))
    np.testing.assert_allclose(share, [0.5 / 0.7, 0.875, 0.125 / 0.875, 0.0])
    assert np.isnan(stream.passing_shares(flow, np.array([0.0, 1.0, 0.0]))[1])
    rows = stream.counted_stations(KNOWN, counted("gap_3,1,2", "wiper,3,4", "track,1,0"))
    assert rows.tolist() == [3, 1, 0]
    seen = SimpleNamespace(
        names=("track", "vision_reject_1", "gap_2"), stations=("track", "vision reject", "gap")
    )
    for name in (
        "vision_reject_1",
        "vision reject",
        "sorter",
        "sorter_1",
    ):  # as printed, and as files of before
        assert stream.counted_stations(seen, counted(f"{name},1,2")).tolist() == [1]
    with pytest.raises(FeederError, match="the bowl has no device"):
        stream.counted_stations(seen, counted("sorter_2,1,2"))
    for counts, said in (
        (("gap,1,2",), r"c.csv:2: the bowl has no device 'gap' - did you mean gap_"),
        (("wiper_1,1,2", "wiper,1,2"), r"c.csv:3: device 'wiper' is that of line 2 - keep one of them"),
    ):
        with pytest.raises(FeederError, match=said):
            stream.counted_stations(KNOWN, counted(*counts))


@settings(max_examples=60, deadline=None)
@given(shares, shares, shares, shares)
def test_the_ends_are_those_of_the_corners(came, through, one, other):
    flow = np.stack([came, came * through])[:, None]
    low, high = np.minimum(one, other), np.maximum(one, other)
    corners = np.array(list(product(*zip(low, high))))
    total = corners @ came
    every = (corners @ (came * through))[total > 0.0] / total[total > 0.0]
    found = np.array(stream.passing_ends(flow, low, high))[:, 0]
    if not len(every):
        assert np.isnan(found).all()
    else:
        np.testing.assert_allclose(found, [every.min(), every.max()], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("rows", "line"), [
    (["wiper,1"], "c.csv:2: has 1 value after the device - give the parts that passed and those"),
    (["gap,1,x"], "c.csv:2: rejected: 'x' is not a number of parts - give a whole number up to 1e"),
    (["gap,0,0"], "c.csv:2: no part came to device 'gap' - remove the row"),
    (["gap,1,2", "gap,1,3"], "c.csv:3: device 'gap' is already in line 2 - keep one of them"),
    ([], "c.csv: has no device - give a header 'device,passed,rejected' and one row a device"),
])  # fmt: skip
def test_faults_of_a_feeding_test(rows, line):
    with pytest.raises(FeederError) as caught:
        counted(*rows)
    assert str(caught.value).startswith(line)


@pytest.fixture(scope="module")
def known():
    """Every orientation of the skew body behind a blade that some of them do not pass."""
    part, aspects = awkward.part()
    bowl = awkward.bowl()
    wiper = make_device("wiper", "test", limit=14e-3)
    return follow_orientations(part, aspects, bowl.track, [wiper], bowl=bowl)


def target(known, row):
    return known.aspects[row], known.headings[row]


def first(known):
    return int(np.flatnonzero((known.leaves > 0.5) & (known.leaves_as == np.arange(len(known.aspects))))[0])


def test_purity_counts_what_is_not_sure_to_be_returned_and_a_rule_ranges_over_all(known):
    """Wanted parts over all that may leave: the doubtful ones too, but for the wanted row, which is sure."""
    row = first(known)
    doubtful = np.where(known.leaves < 0.5, 0.3, 0.0)
    assert doubtful.any()
    doubt = replace(known, doubtful=doubtful)
    chance = known.rules["csa"]
    wanted = float(chance[row] * known.leaves[row])
    others = float((chance * (known.leaves + doubtful)).sum() - chance[row] * known.leaves[row])
    made_of = well_oriented.rate(doubt, SPEED, target(known, row), "csa")
    assert made_of.purity == pytest.approx(wanted / (wanted + others))
    assert made_of.purity < well_oriented.rate(known, SPEED, target(known, row), "csa").purity
    row = first(known)
    found = well_oriented.rate(known, SPEED, target(known, row), "csa").probability
    chances = [chance[row] for chance in known.rules.values() if not np.isnan(chance[row])]
    assert found.all == (known.rules["csa"][row], min(chances), max(chances)) and found.low < found.high


def test_what_rolls_back_is_carried_in_the_highest_rate_only(known):
    """Half of the orientations roll back: those that are left share the track among themselves."""
    row = first(known)

    def parts(*stays):
        lying = tuple(replace(one, may_roll_back=k not in stays) for k, one in enumerate(known.lying))
        return well_oriented.rate(replace(known, lying=lying), SPEED, target(known, row), "csa").parts

    found, gone = parts(row), parts()
    alone = well_oriented.rate(known, SPEED, target(known, row), "csa").parts
    assert found.value == pytest.approx(SPEED.value / (known.lengths[row] + known.gap))
    assert found.value > alone.value and found.high >= alone.high
    assert gone.value == 0.0 and gone.high == pytest.approx(alone.high)


def test_a_part_that_is_swept_off_keeps_the_others_waiting(known):
    """So often as it comes, for so long: the time between two parts is that much longer."""
    row, chance, swept = first(known), known.rules["csa"], np.where(known.leaves < 0.5, 0.8, 0.0)

    def density(speed):
        lying = tuple(replace(one, speed=speed) for one in known.lying)
        slow = replace(known, clearing=swept, lying=lying)
        return well_oriented.parts_per_metre(slow, target(known, row), "csa")

    waits, speed = float((chance * swept).sum() / (chance * known.stays).sum()), 0.037
    freely = well_oriented.parts_per_metre(known, target(known, row), "csa")
    share = well_oriented.efficiency(known, row, "csa")
    whole = 1.0 / (share / freely + waits * speed)  # all parts on a metre
    assert density(speed) == pytest.approx(share * whole) and density(speed) < 0.95 * freely
    assert density(0.0) == pytest.approx(freely)


def test_what_tips_lies_on_its_foot_and_what_may_pass_a_device_is_not_surely_gone(monkeypatch):
    lean = np.radians(3.0)
    for one in awkward.lying():
        if one.falls_off or one.touching is None:
            continue
        foot = seat(one.posture, one.heading, one.touching, lean).contact
        flat, line = (tipping.seat_in_groove(replace(one, kind=k), lean).contact for k in ("flat", "rolling"))
        np.testing.assert_array_equal(flat, foot)
        assert (line[:, 0].min(), line[:, 0].max()) == (foot[:, 0].min(), foot[:, 0].max())
        assert np.abs(line[:, 1]).min() > np.abs(foot[:, 1]).max()
    lying = [SimpleNamespace(returned=back) for back in (False, True, False, False)]
    passes = np.array([[1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]])
    monkeypatch.setattr(tipping, "surely_gone", lambda device, one: device == "sure")
    assert tipping.is_surely_gone(["unsure", "sure"], lying, passes).tolist() == [True, True, False, True]


def test_no_more_leave_than_fit_on_the_track_behind_what_turns_them_lengthwise(known):
    """All of them turned into the longest orientation: one a length, however many came."""
    row = int(np.argmax(known.lengths))
    leaving = np.zeros_like(known.leaving)
    leaving[:, row] = 1.0
    states = np.arange(len(known.aspects))
    turned = replace(known, leaving=leaving, passes=np.ones_like(known.passes), leaves_as=states)
    long = known.lengths[row]
    assert well_oriented.mean_length(turned, "csa") < 0.9 * long
    assert well_oriented.parts_per_metre(turned, target(known, row), "csa") == pytest.approx(1.0 / long)
    parts = well_oriented.rate(turned, SPEED, target(known, row), "csa").parts
    assert parts.all == pytest.approx([speed / long for speed in SPEED.all])


@pytest.fixture(scope="module")
def part():
    return shapes.part(shapes.box(8.0, 12.0, 20.0))


@pytest.fixture(scope="module")
def plain():
    return bowls.record(bowls.settings(path=None, overrides=("track.width=40 mm",)))


def test_counts_are_the_answer_with_wilsons_interval_and_orientations_stand_as_is(part, plain, tmp_path):
    def counts(text):
        (tmp_path / "c.csv").write_text(text)
        return str(tmp_path / "c.csv")

    path = counts("# launch: roll\naspect,tray\nA,60\nB,30\nC,10\n")
    known = entry.shares(part, plain, probabilities=path)
    answer = known.aspects.recommended
    assert answer.p.tolist() == pytest.approx([0.6, 0.3, 0.1]) and answer.launch == "roll"
    assert answer.rule == f"{path}, 100 parts" and list(known.inputs) == [path]
    assert (answer.low[2], answer.high[2]) == pytest.approx((0.0552, 0.1744), abs=1e-4)  # Wilson's, 10 of 100
    ways = study.rate(part, plain, aspect_shares=known).rate.orientations
    total = dict.fromkeys("ABC", 0.0)
    for one, share in zip(ways.lying, ways.rules["recommended"], strict=True):
        total[one.aspect] += share
    assert list(total.values()) == pytest.approx([0.6, 0.3, 0.1])
    known = study.rate(part, plain).rate.orientations
    a, b = (next(one.name for one in known.lying if one.aspect == name) for name in "AB")

    def counted(text):
        shares = entry.shares(part, plain, probabilities=counts(f"orientation,track\n{text}C@0,0\n"))
        return study.rate(part, plain, aspect_shares=shares).rate.orientations

    found = counted(f"{a},30\n{b},10\n")
    names = [one.name for one in found.lying]
    taken = dict(zip(names, found.rules["recommended"]))
    assert taken.pop(a) == 0.75 and taken.pop(b) == 0.25 and not any(taken.values())
    low, high = found.interval[names.index(a)]
    assert low < 0.75 < high
    with pytest.raises(FeederError, match=r"counts orientation A@47, which the part does not have - known"):
        counted(f"A@47,30\n{b},10\n")
    with pytest.raises(FeederError, match=r"has 2 columns of shares \(x, y\) - leave one of them in the fi"):
        entry.shares(part, plain, probabilities=counts("aspect,x,y\nA,60,1\nB,30,1\nC,10,1\n"))


def arrival(**values):
    ends = {"low": np.array([0.5, 0.1, 0.0]), "high": np.array([0.8, 0.4, 0.2])}
    usual = {"p": np.array([0.7, 0.2, 0.1]), **ends, "settled": True, "reason": ""}
    return SimpleNamespace(**(usual | values), shaken=SimpleNamespace(parts=80, partial=False))


def test_what_arrives_is_named_and_what_is_undecided_is_said(part):
    aspects = find(part)
    found = entry.arrived(aspects, arrival(), 1)
    assert found.recommended.rule == "fed onto the moving floor, 80 parts, seed 1"
    assert found.recommended.p.tolist() == [0.7, 0.2, 0.1] and found.warnings == aspects.warnings
    doubtful = entry.arrived(aspects, arrival(settled=False, reason="they change - wait"), 1)
    assert doubtful.warnings[-1] == "the shares at the track's entry are undecided: they change - wait"
    stopped = arrival()
    stopped.shaken.partial = True
    assert entry.arrived(aspects, stopped, 1).warnings[-1] == "the parts on the floor were stopped after 80"
    nothing = entry.arrived(aspects, arrival(p=np.full(3, np.nan)), 1)
    assert nothing.recommended is aspects.recommended and nothing.warnings[-1] == entry.NO_ARRIVALS_MESSAGE
    sheet = profiles.parse_count_sheet("aspect,x\nA,0.5\nB,0.25\nC,0.25\n", "c")
    made = profiles.parse_profiles(sheet, "c.csv", "", "ABC")
    answer = entry.counted(aspects, made).recommended
    np.testing.assert_array_equal(answer.low, answer.high)


def test_a_bowl_of_its_own_feeds_its_floor_and_a_stop_keeps_the_shorter_spell(part, plain, monkeypatch):
    """Of a floor that hardly moves; the interval of an orientation is its share of that of its aspect."""
    bowl = replace(plain, drive=replace(plain.drive, amplitude=0.02e-3))
    aspects = entry.shares(part, bowl, fed=100).aspects
    answer = aspects.recommended
    assert answer.rule.startswith("fed onto the moving floor, 100 parts")
    assert answer.p.sum() == pytest.approx(1.0) and (answer.low <= answer.p).all()
    assert (answer.high > answer.p).all() and answer.p[0] > answer.p[1] > answer.p[2]
    low, high = follow_orientations(part, aspects, bowl.track).interval.T
    assert (low.sum(), high.sum()) == pytest.approx((answer.low.sum(), answer.high.sum()))
    assert (low <= high).all() and (low < high).any()
    monkeypatch.setattr(floor, "judge", lambda _: floor.Arrival(0, 0, 0, False, "open", ran[0]))
    ran = []

    def test(*_, pace, **__):
        if ran:
            raise KeyboardInterrupt
        ran.append(floor.plate_test.PlateResult(plain, {}, 1.0, 5, pace.seconds, None, 0, False))
        return ran

    monkeypatch.setattr(floor.plate_test, "test", test)
    found = floor.arrival(part, None, plain)
    assert found.shaken.partial and not found.settled


def per_metre(bowl):
    return PER_METRE


def test_each_solution_reaches_the_target_and_its_value_can_be_given_again():
    solutions = drive_settings.solutions(SLOW, 0.05, per_metre).solutions
    assert {one.key.name for one in solutions} >= {"drive.amplitude", "drive.frequency"}
    for one in solutions:
        there = answer.answer(drive_settings.turned(SLOW, one.key, one.value))
        assert there.velocity == pytest.approx(0.05 / PER_METRE, rel=1e-4)  # values have five digits
        assert there.regime == one.answer.regime
        assert one.value == units.quantity(f"{one.number} {one.key.unit}", one.key.dimension)
        assert len(f"{one.number}".replace(".", "").lstrip("0")) <= drive_settings.SETTING_DIGITS
    orders = [one.order for one in drive_settings.solutions(SLOW, 0.4, per_metre).solutions]
    assert orders == sorted(orders)
    gentle = drive_settings.REGIMES_BY_GENTLENESS
    assert gentle.index("forward") < gentle.index("both") < gentle.index("hop")
    for one in drive_settings.solutions(SLOW, 0.05, per_metre, worst=True).solutions:
        there = drive_settings.turned(SLOW, one.key, one.value)
        assert well_oriented.velocity(there).low == pytest.approx(0.05 / PER_METRE, rel=1e-4)
        assert one.answer.velocity >= one.speed
    gentle = ("drive.amplitude=0.05 mm", "drive.frequency=60 Hz", "drive.vibration_angle=30 deg")
    bouncing = bowls.read(None, gentle)  # from rest its velocity jumps onto the regular bounce of a period
    for one in drive_settings.solutions(bouncing, 0.866, per_metre).solutions:
        assert one.rate == pytest.approx(0.866, rel=drive_settings.ACCEPTED_RATE_ERROR)


def test_a_target_that_is_not_reached_or_that_the_rate_jumps_over(monkeypatch):
    with pytest.raises(FeederError) as caught:
        drive_settings.solutions(SLOW, 100.0, per_metre)
    line = str(caught.value)
    assert line.startswith("target: no setting reaches 6000/min: the most is ")
    most = float(line.split("the most is ")[1].split("/min")[0])
    name, amplitude = line.split(", at ")[1].split(" mm")[0].split()
    assert name == "drive.amplitude"
    stroke = drive_settings.BY_NAME[name]
    there = answer.answer(drive_settings.turned(SLOW, stroke, float(amplitude) * 1e-3))
    assert there.velocity * PER_METRE * 60 == pytest.approx(most, rel=1e-2)
    assert there.throw_number < drive_settings.HIGHEST_THROW
    back = bowls.read(None, ("drive.vibration_angle=0 deg", "drive.amplitude=0.001 mm", "restitution=0"))
    with pytest.raises(FeederError, match="no setting reaches 6/min: the part never travels up the track"):
        drive_settings.solutions(back, 0.1, per_metre)
    # More parts arrive from some stroke on: below it there are too few, beyond it more than asked for
    monkeypatch.setattr(drive_settings, "KNOBS", ("drive.amplitude",))

    def more(bowl):
        return PER_METRE if bowl is None or bowl.drive.amplitude < 0.1e-3 else 2.0 * PER_METRE

    target = 1.5 * PER_METRE * answer.answer(drive_settings.turned(SLOW, stroke, 0.1e-3)).velocity
    assert all(one.rate > 1.1 * target for one in drive_settings.solutions(SLOW, target, more).solutions)


def test_what_arrives_at_a_setting_counts_there():
    """A stronger drive turns more away from the wanted side: the rate is met with what is left."""

    def fewer(bowl):
        there = (bowl or SLOW).drive
        return PER_METRE * math.exp(-2e3 * there.amplitude) * (50.0 / there.frequency) ** 0.5

    solutions = drive_settings.solutions(SLOW, 0.05, fewer).solutions
    assert {one.key.name for one in solutions} == set(drive_settings.KNOBS)
    for one in solutions:
        there = drive_settings.turned(SLOW, one.key, one.value)
        for rate in (answer.answer(there).velocity * fewer(there), one.rate):
            assert rate == pytest.approx(0.05, rel=drive_settings.RATE_TOLERANCE)


def test_a_search_whose_parts_are_simulated_ends_and_says_what_it_left_out(monkeypatch):
    """With a second harmonic it went through 17 simulations of 4 s each; each key gets its turn."""
    rough_drive = bowls.read(None, ["drive.second_harmonic=0.5", "drive.second_harmonic_phase=90 deg"])
    asked, told = [], []

    def jumping(bowl):
        if bowl is not None:
            asked.append(bowl.drive)
        return PER_METRE * (1.0 + 0.01 * (-1) ** len(asked))  # what is simulated scatters

    def find():
        asked.clear()
        found = drive_settings.solutions(
            rough_drive, 1.0, jumping, rough=per_metre, sampled=True, progress=lambda *now: told.append(now)
        )
        return found, len(asked)

    monkeypatch.setattr(drive_settings, "MAX_SIMULATED", 100)
    everything, simulated = find()
    assert told[0] == (0, told[-1][1]) and everything.skipped == 0 and simulated > 4
    monkeypatch.setattr(drive_settings, "MAX_SIMULATED", 4)
    some, simulated = find()
    assert simulated <= 4 and some.skipped > 0
    assert len({one.key.name for one in some.solutions}) > 1
    for one in some.solutions:
        assert one.rate == pytest.approx(1.0, rel=drive_settings.ACCEPTED_RATE_ERROR)
    # where none gives the rate it goes on for a while
    monkeypatch.setattr(drive_settings, "ACCEPTED_RATE_ERROR", 0.0)
    monkeypatch.setattr(drive_settings, "MAX_SIMULATED_IN_VAIN", 6)
    assert find()[1] == 6


def test_many_parts_decide_only_on_settings_that_few_lead_to():
    """Each decision feeds thousands of parts: they were spent on starts 20 and 30 % off the target, too."""
    asked, led = [], []

    def many(bowl):
        asked.append(bowl)
        return 1.02 * PER_METRE  # what few parts say is 2 % off

    def few(bowl):
        led.append(bowl)
        return PER_METRE

    plain = drive_settings.solutions(SLOW, 0.4, many).solutions
    spent = len(asked)
    asked.clear()
    found = drive_settings.solutions(SLOW, 0.4, many, rough=few).solutions
    near = drive_settings.ACCEPTED_RATE_ERROR
    assert [one.rate for one in found] == pytest.approx([0.4] * len(found), rel=near)
    assert {one.key.name for one in found} == {one.key.name for one in plain}
    decided = [bowl for bowl in asked if bowl is not None]
    assert len(decided) <= 2 * len(found) < spent and len(led) <= drive_settings.LEADS * 6
