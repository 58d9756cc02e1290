"""Parts per minute: the chain of factors, orientations that are one, devices and their faults."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.errors import FeederError
from feederscrew.part.loading import load
from feederscrew.rates import well_oriented
from feederscrew.rates.stream import follow_orientations
from feederscrew.rates.well_oriented import Range
from feederscrew.resting.aspects import find

BOWL = bowls.read(
    None, ("drive.peak_to_peak=1 mm", "drive.frequency=50 Hz", "restitution=0", "friction.static=0.4")
)
STRAIGHT = replace(BOWL.track, radius=1e6, climb=0.0, bank=0.0, width=0.1)
PARTS = Path(__file__).parents[2] / "parts"
LSHAPE = [(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)]


def stream(mesh, track=STRAIGHT, chain=()):
    part = shapes.part(mesh)
    found = find(part)
    return part, found, follow_orientations(part, found, track, chain)


def chain(tmp_path, text):
    path = tmp_path / "bowl.yaml"
    path.write_text(text)
    return bowls.read(path).devices


def test_probabilities_of_all_orientations_sum_to_one():
    _, _, known = stream(shapes.prism(LSHAPE, 15))
    for chances in known.rules.values():
        assert chances.sum() == pytest.approx(1.0, abs=1e-9)


def test_headings_equal_under_a_turn_are_one():
    # a box on each of three faces lies lengthwise or crosswise; either end ahead is the same
    _, found, known = stream(shapes.box(10, 20, 30))
    assert found.names == ("A", "B", "C")
    assert known.aspects == ("A", "A", "B", "B", "C", "C")
    assert sorted(np.round(known.lengths[:2] * 1e3, 9)) == [20.0, 30.0]
    for pair in (0, 2, 4):
        assert known.heading_shares[pair : pair + 2].sum() == pytest.approx(1.0, abs=1e-9)
    # an L on its back does not map to itself by half a turn
    _, _, bracket = stream(shapes.prism(LSHAPE, 15))
    assert bracket.aspects.count("A") > 2


def test_rate_is_the_product_of_its_chain():
    part, found, known = stream(shapes.box(10, 20, 30))
    target = well_oriented.wanted(part, found, STRAIGHT, "A")
    made = well_oriented.rate(known, Range(0.1, 0.05, 0.2), target, "csa", gap=5e-3, fill=0.8)
    row = made.row
    chance = known.rules["csa"]
    assert made.pitch == pytest.approx((chance * (known.lengths + 5e-3)).sum())
    assert made.offered.value == pytest.approx(0.1 * 0.8 / made.pitch)
    assert made.efficiency == pytest.approx(chance[row])
    assert made.parts.value == pytest.approx(made.offered.value * made.efficiency)
    assert made.parts.low <= made.parts.value <= made.parts.high
    chances = [chance[row] for chance in known.rules.values()]
    assert made.parts.high == pytest.approx(0.2 / made.pitch * max(chances) * 0.8)
    assert made.purity == pytest.approx(known.rules["csa"][row])
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


def test_a_track_that_carries_nothing_offers_nothing():
    part, found, known = stream(shapes.box(10, 20, 30))
    target = well_oriented.wanted(part, found, STRAIGHT, "A")
    gone = replace(known, passes=np.zeros_like(known.passes), leaving=np.zeros_like(known.leaving))
    made = well_oriented.rate(gone, Range(0.1, 0.1, 0.1), target, "csa")
    assert made.parts.all == (0.0, 0.0, 0.0)
    assert np.isnan(well_oriented.mean_length(gone, "csa"))


def test_velocity_brackets_friction_and_starts():
    found = well_oriented.velocity(BOWL)
    softer = answer.answer(answer.scaled(BOWL, friction=0.8)).velocity
    assert found.value == pytest.approx(answer.answer(BOWL).velocity)
    assert found.low <= min(softer, found.value)
    assert found.high >= max(softer, found.value)


def bouncing(restitution):
    """A bowl whose parts hop: throw number 1.84, where a harder bounce is a slower travel."""
    drive = replace(BOWL.drive, amplitude=0.3e-3, frequency=60.0, vibration_angle=np.radians(25.0))
    friction = replace(BOWL.friction, static=0.6, kinetic=0.6, wall=0.6)
    return replace(BOWL, drive=drive, friction=friction, restitution=restitution)


def test_velocity_brackets_the_spread_of_restitution_where_parts_hop():
    """An even range of one standard deviation of 16 % about 0.2 ends at 0.145 and 0.255."""
    found = well_oriented.velocity(bouncing(0.2))
    assert found.value == answer.answer(bouncing(0.2)).velocity
    for end in (0.2 * (1 - 0.16 * 3**0.5), 0.2 * (1 + 0.16 * 3**0.5)):
        at_end = answer.answer(bouncing(end)).velocity
        assert abs(at_end - found.value) > 0.04 * found.value
        assert found.low <= at_end <= found.high


def test_the_spread_of_restitution_alone_widens_what_friction_leaves_open(monkeypatch):
    wide = well_oriented.velocity(bouncing(0.5))
    monkeypatch.setattr(answer, "even_range", lambda restitution: (restitution, restitution))
    narrow = well_oriented.velocity(bouncing(0.5))
    assert wide.value == narrow.value and wide.high - wide.low > 1.05 * (narrow.high - narrow.low)


def test_a_part_that_does_not_hop_asks_for_no_restitution():
    assert len(answer.surfaces(BOWL, False)) == 3
    ends = [one.restitution for one in answer.surfaces(bouncing(0.95), True)[3:]]
    assert ends == pytest.approx([0.9, 0.99])  # of 0.687 to 1.213


def test_a_part_that_travels_back_gives_no_rate():
    back = replace(BOWL, drive=replace(BOWL.drive, vibration_angle=np.radians(15)))
    friction = replace(BOWL.friction, static=0.2, kinetic=0.2)
    assert answer.answer(replace(back, friction=friction)).velocity < 0.0
    assert well_oriented.velocity(replace(back, friction=friction)).value == 0.0


def test_no_steady_state_is_a_fault():
    with pytest.raises(FeederError, match=r"track\.climb: is steeper than friction holds"):
        well_oriented.velocity(replace(BOWL, track=replace(BOWL.track, climb=0.6)))


def test_rules_and_aspects_that_do_not_exist():
    part, found, known = stream(shapes.box(10, 20, 30))
    target = well_oriented.wanted(part, found, STRAIGHT, "a")
    with pytest.raises(FeederError) as caught:
        well_oriented.rate(known, Range(1, 1, 1), target, "guess")
    assert str(caught.value).startswith("rule guess: has no probabilities of this part - known are pmi, ")
    with pytest.raises(FeederError, match="there is no aspect"):
        well_oriented.wanted(part, found, STRAIGHT, "Z")


def test_heights_decide_wiper_and_bar(tmp_path):
    found = chain(tmp_path, "devices:\n  - wiper: 20 mm\n  - height_bar: 19.9 mm\n")
    _, _, known = stream(shapes.box(10, 20, 30), chain=found)
    assert known.stations == ("track", "wiper", "height_bar")
    assert known.passes[:, 0].tolist() == [1.0] * 6
    assert known.passes[:, 1].tolist() == [1, 1, 1, 1, 0, 0]
    assert known.passes[:, 2].tolist() == [1, 1, 0, 0, 0, 0]
    assert known.through.tolist() == [1, 1, 0, 0, 0, 0]


def test_width_and_centre_of_mass_decide_at_the_edge(tmp_path):
    # crosswise the 10 x 20 x 30 box on A covers 30 mm, its centre of mass 15 mm from the wall
    for width, kept in (("14.9 mm", 20.0), ("15.1 mm", None)):
        _, _, known = stream(
            shapes.box(10, 20, 30), chain=chain(tmp_path, f"devices:\n  - narrowed_track: {width}\n")
        )
        passing = known.widths[(known.passes[:, 1] == 1.0) & (np.array(known.aspects) == "A")] * 1e3
        assert (
            (sorted(passing) == pytest.approx([20.0, 30.0]))
            if kept is None
            else (passing == pytest.approx([kept]))
        )
    for kind in ("pressure_break", "narrowed_track"):  # alone parts meet the same ledge
        _, _, known = stream(
            shapes.box(10, 20, 30), chain=chain(tmp_path, f"devices:\n  - {kind}: 14.9 mm\n")
        )
        np.testing.assert_array_equal(known.passes[:, 1] == 1.0, known.widths <= 20e-3 + 1e-9)


def test_yield_by_aspect(tmp_path):
    found = chain(tmp_path, "devices:\n  - yield:\n      a: 0.25\n      C: 0\n")
    _, _, known = stream(shapes.box(10, 20, 30), chain=found)
    assert known.passes[:, 1].tolist() == [0.25, 0.25, 1, 1, 0, 0]


def test_what_never_leaves_the_bowl(tmp_path):
    part, found, known = stream(shapes.box(10, 20, 30), chain=chain(tmp_path, "devices:\n  - wiper: 5 mm\n"))
    target = well_oriented.wanted(part, found, STRAIGHT, "A", heading=0.0)
    made = well_oriented.rate(known, Range(0.1, 0.1, 0.1), target, "pmi")
    assert made.parts.value == 0.0
    assert np.isnan(made.purity)
    with pytest.raises(FeederError, match="never leaves the bowl - see the devices"):
        well_oriented.parts_per_metre(known, target, "pmi")


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("devices: 5 mm\n", "1:1: devices is not a list - write one '- wiper: 6 mm' a line"),
        ("devices:\n  - wiper\n", "2:5: is not a device - write one '- wiper: 6 mm' a line"),
        ("devices:\n  - wipr: 6 mm\n", "2:5: unknown device 'wipr' - did you mean wiper?"),
        ("devices:\n  - wiper: 6\n", "2:12: wiper: '6' has no unit - write 6 mm"),
        ("devices:\n  - wiper: -6 mm\n", "2:12: wiper is -6 mm - give more than 0 mm"),
        ("devices:\n  - yield:\n      A: 1.5\n", "3:10: yield of A is 1.5 - give 0 to 1"),
        (
            "devices:\n  - yield: 0.5\n",
            "2:5: yield names no aspect - write below it one line an aspect, as 'A: 0.9'",
        ),
    ],
)
def test_faults_of_devices(tmp_path, text, line):
    with pytest.raises(FeederError) as caught:
        chain(tmp_path, text)
    assert caught.value.lines == (f"{tmp_path}/bowl.yaml:{line}",)
