"""What a bowl's rules and a length of track give, against sums done by hand."""

from dataclasses import replace

import awkward
import numpy as np
import pytest

from feederscrew.base.errors import FeederError
from feederscrew.feeding import stream
from feederscrew.machine import sizing
from feederscrew.motion import conveying as answer
from feederscrew.motion.headings import headings
from feederscrew.resting.posture import posture

LYING = sizing.Lying(longest=0.031, tallest=0.026, length=0.03, width=0.0175)


@pytest.mark.parametrize(("tallest", "sheet"), [(0.026, 0.003), (0.04, 0.003), (0.04, 0.0055)])
def test_a_turn_rises_by_the_free_height_and_the_sheet_under_it(tallest, sheet):
    """Between the sheet of the next turn and the track there is the part's height and its headroom."""
    rules = replace(awkward.bowl().sizing, sheet=sheet, least_climb=0.0)
    found = sizing.size_bowl(replace(LYING, tallest=tallest), "a part", rules, sorts=False)
    assert found.pitch - sheet == pytest.approx(rules.headroom * tallest, rel=1e-9)
    assert found.pitch == pytest.approx(np.pi * found.diameter * np.tan(found.climb), rel=1e-9)


@pytest.fixture(scope="module")
def queue():
    part, aspects = awkward.part()
    bowl = awkward.bowl()
    return stream.follow_orientations(part, aspects, bowl.track, bowl=bowl)


@pytest.mark.parametrize("wanted", [None, 0])
def test_parts_a_metre_are_those_counted_on_a_drawn_queue(queue, wanted):
    """Parts of every orientation, laid end to end with their gap, counted over their length."""
    target = None if wanted is None else (queue.aspects[wanted], queue.headings[wanted])
    gap, fill, count = 7.3e-3, 0.8, 400_000
    chances = queue.rules["csa"] / queue.rules["csa"].sum()
    drawn = np.random.default_rng(3).choice(len(chances), count, p=chances)
    way = (queue.lengths[drawn] + gap).sum() / fill
    counts = queue.through[drawn].sum() if wanted is None else queue.leaving[drawn, wanted].sum()
    told = sizing.flow(queue, "csa", target=target, gap=gap, fill=fill)
    assert told.parts == pytest.approx(counts / way, rel=0.01)
    assert told.parts < 0.9 * sizing.flow(queue, "csa", target=target, fill=fill).parts


def test_what_the_track_does_not_carry_takes_no_room_on_it(queue):
    """Of a queue with every second orientation half as often: its parts that leave over its length."""
    passes = queue.passes.copy()
    passes[::2, 0] *= 0.5
    passes[0, 0] = 0.0
    some = np.column_stack([passes, np.linspace(0.2, 0.9, len(passes))])  # a device that lets some pass
    some, gap, fill = replace(queue, passes=some), 7.3e-3, 0.8
    comes = queue.rules["csa"] * passes[:, 0] * ~queue.rolls_back
    assert comes.sum() < 0.8 and (comes > 0.0).sum() > 3
    leave = (comes * some.passes[:, -1]).sum()
    told = sizing.flow(some, "csa", gap=gap, fill=fill)
    assert told.share == pytest.approx(leave / comes.sum(), rel=1e-12)
    assert told.parts == pytest.approx(fill * leave / (comes * (queue.lengths + gap)).sum(), rel=1e-12)
    # Something leaves but for the climb, or nothing leaves anyway
    rolls = tuple(replace(one, may_roll_back=True) for one in queue.lying)
    none = replace(queue, passes=np.zeros_like(queue.passes)), "devices: let no part pass"
    for other, said in (none, (replace(queue, lying=rolls), r"track\.climb")):
        with pytest.raises(FeederError, match=said):
            sizing.flow(other, "csa")


@pytest.mark.parametrize("shape", ["stepped", "conical"])
def test_beside_a_slope_a_turn_rises_by_the_slope_and_three_sheets_more(shape):
    """The track, the wall that leads to it and the wall above are a sheet each; the slope is 0.9 in 1."""
    rules = replace(awkward.bowl().sizing, sheet=0.003, least_climb=0.0)
    found = sizing.size_bowl(LYING, "a part", replace(rules, shape=shape), sorts=False)
    upright = sizing.size_bowl(LYING, "a part", rules, sorts=False)
    rise = np.pi * (found.diameter - found.track_width) * np.tan(found.climb)
    own = np.pi * upright.diameter * np.tan(upright.climb)
    assert rise - own == pytest.approx(0.9 * found.track_width + 3.0 * rules.sheet, rel=1e-9)


@pytest.mark.parametrize(("hanging", "free"), [(0.0, 0.0), (4e-3, 9e-3), (40e-3, 60e-3)])
def test_below_rails_a_turn_rises_by_what_hangs_as_well(hanging, free):
    """By 1.5 times a long part, and a short one and 5 mm: so much upright wall a stepped solid needs."""
    rules = replace(awkward.bowl().sizing, shape="stepped", headroom=1.5, least_climb=0.0)
    both = (replace(LYING, hanging=deep) for deep in (0.0, hanging))
    level, hung = (sizing.size_bowl(one, "a part", rules, sorts=False) for one in both)
    rise = np.pi * (hung.diameter - hung.track_width) * (np.tan(hung.climb) - np.tan(level.climb))
    assert rise == pytest.approx(free, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("more", "diameter"), [(0.0, 0.3), (1e-5, 0.4), (-1e-5, 0.3)])
def test_a_bowl_is_rounded_up_unless_it_is_a_whole_number_of_steps(more, diameter):
    """0.3 over 0.1 is a little less or more than 3, by how it was made: three steps either way."""
    for least in (0.3, 0.1 * 3, np.nextafter(0.1 * 3, 1.0)):
        rules = replace(awkward.bowl().sizing, least_diameter=least + more, diameter_step=0.1)
        rules = replace(rules, diameter_per_length=1.0, diameter_per_width=0.1)
        found = sizing.size_bowl(LYING, "a part", rules, sorts=False)
        assert found.diameter == pytest.approx(diameter, rel=1e-12)


def test_the_steepest_climb_is_that_to_which_the_springs_as_they_are_carry_a_part():
    """Springs of 25 deg to a track that climbs by 2 deg stand at 27 deg to the level, whatever the climb."""
    bowl = awkward.bowl("drive.vibration_angle=25 deg", "track.bank=0 deg")
    found = sizing.steepest_climb(bowl)

    def speed(climb):
        drive = replace(bowl.drive, vibration_angle=np.radians(27.0) - climb)
        return answer.answer(replace(bowl, drive=drive, track=replace(bowl.track, climb=climb))).velocity

    assert np.radians(2.0) < found < np.radians(20.0)
    assert speed(found - 1e-4) > 0.0 and not speed(found + 1e-4) > 0.0


def test_a_part_takes_the_longest_way_along_the_wall_and_has_other_headings_on_a_bend():
    """Wanted in one orientation, only that counts; the nearest heading is meant, any turns away."""
    part, aspects = awkward.part()
    stood = [posture(part, aspects, name) for name in np.array(aspects.names)[aspects.stable]]
    found = [headings(one, sizing.STRAIGHT_TRACK) for one in stood]
    every = sizing.find_lying(part, aspects)
    assert every.tallest == max(np.ptp(one.corners[:, 2]) for one in stood)
    assert every.length == every.longest == max(one.lengths.max() for one in found)
    assert every.width == max(one.widths.max() for one in found)
    uneven = 0
    for one in found[:2]:
        for heading, length, width in zip(one.headings, one.lengths, one.widths):
            for turns in (-1, 1):
                own = sizing.find_lying(part, aspects, (one.aspect, heading + 2.0 * np.pi * turns + 1e-3))
                assert (own.length, own.width, own.longest) == (length, width, every.longest)
                uneven += abs(length - width) > 1e-3
            laid = sizing.size_shape(part, aspects, sizing.STRAIGHT_TRACK, (one.aspect, heading))
            assert laid.length == length and np.ptp(laid.outline[:, 0]) == pytest.approx(length)
    assert uneven
    # on a straight track and on one of 40 mm some headings of the skew body differ by more than 3 deg
    part, aspects = awkward.part()
    track, away = replace(sizing.STRAIGHT_TRACK, radius=0.04), []
    for name in np.array(aspects.names)[aspects.stable]:
        lying = posture(part, aspects, name)
        straight, bent = headings(lying, sizing.STRAIGHT_TRACK), headings(lying, track)
        for heading in straight.headings:
            off = np.abs(np.angle(np.exp(1j * (bent.headings - heading))))
            away.append(np.degrees(off.min()))
            laid = sizing.size_shape(part, aspects, track, (name, heading))
            assert laid.length == bent.lengths[np.argmin(off)]
    assert max(away) > 3.0


def test_on_a_track_of_a_given_width_the_bowl_is_wide_enough_for_it_and_for_its_bend():
    """By L^2 / (2 D) a part stands off a bend; a diameter that is given is at least twice its length."""
    rules = replace(
        awkward.bowl().sizing, diameter_per_width=7.0, least_clearance=1e-3, greatest_clearance=1e-3
    )
    least = sizing.size_bowl(LYING, "a part", rules, sorts=False, width=0.0215).least
    assert least["width of the track"] == pytest.approx(7.0 * 0.0215)
    bend = least["bend on this track"]
    assert bend == pytest.approx(0.03**2 / (2.0 * 3e-3))  # 21.5 - 17.5 - 1 mm are free
    assert 0.5 * bend - np.sqrt(0.25 * bend**2 - 0.015**2) == pytest.approx(0.5 * 3e-3, rel=0.05)
    sizing.size_bowl(LYING, "a part", rules, sorts=False, diameter=2.03 * LYING.longest)
    with pytest.raises(FeederError, match=r"track\.radius"):
        sizing.size_bowl(LYING, "a part", rules, sorts=False, diameter=1.97 * LYING.longest)
