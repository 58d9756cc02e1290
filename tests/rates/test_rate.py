"""Parts per minute: the chain of factors, orientations that are one, devices and their faults."""

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
from feederscrew.conveying import answer
from feederscrew.errors import FeederError
from feederscrew.mechanics.track_balance import seat
from feederscrew.part.loading import load
from feederscrew.rates import stream, tipping, well_oriented
from feederscrew.rates.stream import follow_orientations
from feederscrew.rates.well_oriented import Range
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import make_device

BOWL = bowls.read(
    None, ("drive.peak_to_peak=1 mm", "drive.frequency=50 Hz", "restitution=0", "friction.static=0.4")
)
STRAIGHT = replace(BOWL.track, radius=1e6, climb=0.0, bank=0.0, width=0.1)
PARTS = Path(__file__).parents[2] / "parts"
LSHAPE = [(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)]


def streamed(mesh, chain=()):
    part = shapes.part(mesh)
    found = find(part)
    return part, found, follow_orientations(part, found, STRAIGHT, chain)


@pytest.fixture(scope="module")
def box():
    """A box of 10 x 20 x 30 mm: part, aspects, orientations on a straight track."""
    return streamed(shapes.box(10, 20, 30))


@pytest.fixture
def chain(tmp_path):
    """Devices from lines of a bowl file."""

    def read(text):
        path = tmp_path / "bowl.yaml"
        path.write_text(text)
        return bowls.read(path).devices

    return read


@pytest.fixture
def passing(chain):
    """The orientations of the box through one device or more, each a line."""
    return lambda *lines: streamed(shapes.box(10, 20, 30), chain("devices:\n  - " + "\n  - ".join(lines)))[2]


def test_headings_equal_under_a_turn_are_one_and_their_probabilities_sum_to_one(box):
    # a box on each of three faces lies lengthwise or crosswise; either end ahead is the same
    _, found, known = box
    assert found.names == ("A", "B", "C")
    assert known.aspects == ("A", "A", "B", "B", "C", "C")
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


def test_what_never_leaves_the_bowl_or_comes_onto_the_track_is_no_rate(box, passing):
    part, found, known = box
    target = well_oriented.wanted(part, found, STRAIGHT, "A", heading=0.0)
    blade = passing("wiper: 5 mm")
    made = well_oriented.rate(blade, Range(0.1, 0.1, 0.1), target, "pmi")
    assert made.parts.value == 0.0 and np.isnan(made.purity)
    with pytest.raises(FeederError, match="never leaves the bowl - see the devices"):
        well_oriented.parts_per_metre(blade, target, "pmi")
    gone = replace(known, passes=np.zeros_like(known.passes), leaving=np.zeros_like(known.leaving))
    assert well_oriented.rate(gone, Range(0.1, 0.1, 0.1), target, "csa").parts.all == (0.0, 0.0, 0.0)
    assert np.isnan(well_oriented.mean_length(gone, "csa"))


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
        assert abs(at_end - found.value) > 0.04 * found.value
        assert found.low <= at_end <= found.high


def test_a_part_that_travels_back_gives_no_rate_and_no_steady_state_is_a_fault():
    drive = replace(BOWL.drive, vibration_angle=np.radians(15))
    back = replace(BOWL, drive=drive, friction=replace(BOWL.friction, static=0.2, kinetic=0.2))
    assert answer.answer(back).velocity < 0.0
    assert well_oriented.velocity(back).value == 0.0
    with pytest.raises(FeederError, match=r"track\.climb: is steeper than friction holds"):
        well_oriented.velocity(replace(BOWL, track=replace(BOWL.track, climb=0.6)))


def test_rules_and_aspects_that_do_not_exist(box):
    part, found, known = box
    target = well_oriented.wanted(part, found, STRAIGHT, "a")
    with pytest.raises(
        FeederError, match=r"^rule guess: has no probabilities of this part - known are pmi, "
    ):
        well_oriented.rate(known, Range(1, 1, 1), target, "guess")
    with pytest.raises(FeederError, match="there is no aspect"):
        well_oriented.wanted(part, found, STRAIGHT, "Z")


def test_heights_decide_wiper_and_bar(passing):
    known = passing("wiper: 20 mm", "height_bar: 19.9 mm")
    assert known.stations == ("track", "wiper", "height_bar")
    assert known.passes.T.tolist() == [[1.0] * 6, [1, 1, 1, 1, 0, 0], [1, 1, 0, 0, 0, 0]]
    assert known.through.tolist() == [1, 1, 0, 0, 0, 0]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (": 5 mm\n", "1:1: devices is not a list - write one '- wiper: 6 mm' a line"),
        (":\n  - wiper\n", "2:5: is not a device - write one '- wiper: 6 mm' a line"),
        (":\n  - wipr: 6 mm\n", "2:5: unknown device 'wipr' - did you mean wiper?"),
        (":\n  - wiper: 6\n", "2:12: wiper: '6' has no unit - write 6 mm"),
        (":\n  - wiper: -6 mm\n", "2:12: wiper is -6 mm - give more than 0 mm"),
        (":\n  - yield:\n      A: 1.5\n", "3:10: yield of A is 1.5 - give 0 to 1"),
        (
            ":\n  - yield: 0.5\n",
            "2:5: yield names no aspect - write below it one line an aspect, as 'A: 0.9'",
        ),
    ],
)
def test_faults_of_devices(tmp_path, chain, text, line):
    with pytest.raises(FeederError) as caught:
        chain("devices" + text)
    assert caught.value.lines == (f"{tmp_path}/bowl.yaml:{line}",)


KNOWN = SimpleNamespace(
    names=("track", "wiper_1", "gap_2", "gap_3"),
    stations=("track", "wiper", "gap", "gap"),
    aspects=("A", "A", "B"),
    heading_shares=np.array([0.25, 0.75, 1.0]),
    passes=np.array([[1.0, 0.5, 1.0, 0.0], [1.0, 1.0, 0.0, 1.0], [0.0, 1.0, 0.4, 1.0]]),
)


def counted(*rows):
    text = "\n".join(["device,passed,rejected", *rows])
    return profiles.device_counts(profiles.parse_count_sheet(text, "c.csv"), "c.csv", "")


def test_parts_are_followed_from_device_to_device():
    flow = stream.station_shares(KNOWN, ("A", "B", "C"))
    np.testing.assert_allclose(flow[0], [[1, 1, 0], [1, 0, 0], [0.875, 0, 0], [0.125, 0, 0]])
    share = stream.passing_shares(flow, np.array([0.5, 0.2, 0.3]))
    np.testing.assert_allclose(share, [0.5 / 0.7, 0.875, 0.125 / 0.875, 0.0])
    assert np.isnan(stream.passing_shares(flow, np.array([0.0, 1.0, 0.0]))[1])


shares = st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3).map(np.array)


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


def test_devices_are_known_by_their_names():
    rows = stream.counted_stations(KNOWN, counted("gap_3,1,2", "wiper,3,4", "track,1,0"))
    assert rows.tolist() == [3, 1, 0]
    for counts, said in (
        (("gap,1,2",), r"c.csv:2: the bowl has no device 'gap' - did you mean gap_"),
        (("wiper_1,1,2", "wiper,1,2"), r"c.csv:3: device 'wiper' is that of line 2 - keep one of them"),
    ):
        with pytest.raises(FeederError, match=said):
            stream.counted_stations(KNOWN, counted(*counts))


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        (["wiper,1"], "c.csv:2: has 1 value after the device - give the parts that passed and those"),
        (["gap,1,x"], "c.csv:2: rejected: 'x' is not a number of parts - give a whole number up to 1e"),
        (["gap,0,0"], "c.csv:2: no part came to device 'gap' - remove the row"),
        (["gap,1,2", "gap,1,3"], "c.csv:3: device 'gap' is already in line 2 - keep one of them"),
        ([], "c.csv: has no device - give a header 'device,passed,rejected' and one row a device"),
    ],
)
def test_faults_of_a_feeding_test(rows, line):
    with pytest.raises(FeederError) as caught:
        counted(*rows)
    assert str(caught.value).startswith(line)


SPEED = Range(0.04, 0.03, 0.05)


@pytest.fixture(scope="module")
def known():
    """Every orientation of the skew body behind a blade that some of them do not pass."""
    part, aspects = awkward.part()
    bowl = awkward.bowl()
    return stream.follow_orientations(
        part, aspects, bowl.track, [make_device("wiper", "test", limit=14e-3)], bowl=bowl
    )


def target(known, row):
    return known.aspects[row], known.headings[row]


def first(known):
    """The first orientation that leaves, as what it is."""
    return int(np.flatnonzero((known.leaves > 0.5) & (known.leaves_as == np.arange(len(known.aspects))))[0])


def test_what_is_not_sure_to_be_returned_counts_in_purity(known):
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


def test_the_probability_of_a_rule_ranges_over_all_rules(known):
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


def test_what_tips_lies_on_its_foot_and_what_rolls_on_its_line():
    lean = np.radians(3.0)
    for one in awkward.lying():
        if one.falls_off or one.touching is None:
            continue
        foot = seat(one.posture, one.heading, one.touching, lean).contact
        flat, line = (tipping.seat_in_groove(replace(one, kind=k), lean).contact for k in ("flat", "rolling"))
        np.testing.assert_array_equal(flat, foot)
        assert (line[:, 0].min(), line[:, 0].max()) == (foot[:, 0].min(), foot[:, 0].max())
        assert np.abs(line[:, 1]).min() > np.abs(foot[:, 1]).max()


def test_what_the_first_device_that_returns_it_may_leave_is_not_surely_gone(monkeypatch):
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
