"""Parts that touch: momentum, weight and energy of a few, and what a queue does at a device."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.dropping.kernel import body
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.running import USUAL_RUN, RunSettings
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import looks, part_poses, queue, result, runs, shape
from feederscrew.trial.kernel.steps import BEHIND, BELOW

OWN = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=50 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
]  # fmt: skip
PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.read(None, OWN)
STILL = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0), track=replace(BOWL.track, climb=0.0))
ASPECTS = find(PART)
EVERY = orientations(PART, ASPECTS, BOWL.track)
FLAT = next(one for one in EVERY if one.height < 6e-3 and one.length > 0.015)
SOLID, LENGTH, PRINCIPAL = shape.solid_of(PART)


def parts_on(bowl, *places, heights=None, friction=None):
    """Blocks laid lengthwise with their middles at places [m] along the wall, some heights [m] over it."""
    known = runs.setting(SOLID, LENGTH, bowl)
    if friction is not None:
        known = replace(known, friction=np.full(5, friction))
    on = queue.PartsOnTrack(known, queue.crowded(bowl, EVERY, (), 0.5), len(places))
    for n, place in enumerate(places):
        state = part_poses.pose_on_track(FLAT, PRINCIPAL, LENGTH, bowl.track, place=place, aside=1e-3)
        state[body.Z] += 0.0 if heights is None else heights[n] / LENGTH
        on.lay(n, state)
    return on


def queued(bowl, *planned, run=USUAL_RUN, **own):
    shares = np.array([one is FLAT for one in EVERY], float)
    return queue.queue_of(PART, bowl, ASPECTS, EVERY, EVERY, shares, queue.QueuePlan(*planned, **own), run)


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_a_part_that_strikes_another_shares_its_momentum(restitution):
    on = parts_on(replace(STILL, restitution=restitution), -0.10, -0.0795, friction=0.0)
    on.arrays.states[0, body.VX] = 0.3
    for turn in range(20):
        on.ride(turn)
    first, second = on.arrays.states[:, body.VX]
    assert first + second == pytest.approx(0.3, rel=1e-6)
    assert second - first == pytest.approx(0.3 * restitution, abs=1e-3)
    assert (on.reaches([1])[1][0] - on.reaches([0])[0][1] > 1e-2) == (restitution > 0.0)


def test_parts_in_each_other_are_pushed_apart():
    on = parts_on(STILL, -0.10, -0.0801)
    before = np.array(on.arrays.states[:, body.X]) * LENGTH
    for turn in range(4):
        on.ride(turn)
    moved = on.arrays.states[:, body.X] * LENGTH - before
    assert moved[0] < -2e-5 and moved[1] > 2e-5
    assert np.diff(moved)[0] == pytest.approx(1e-4, abs=2e-5)


def test_a_part_on_another_bears_on_it_with_its_weight():
    on = parts_on(STILL, -0.10, -0.097, heights=(0.0, 5e-3))
    for turn in range(40):
        depth = on.ride(turn)
    assert on.arrays.states[1, body.Z] * LENGTH == pytest.approx(7.5e-3, abs=1e-5)
    assert on.forces[:, BELOW] == pytest.approx([0.0, 1.0], abs=0.02)
    assert on.forces[:, BEHIND] == pytest.approx(0.0, abs=0.02)
    assert depth * LENGTH < 1e-5


def test_falling_over_each_other_wins_no_energy():
    on = parts_on(STILL, -0.10, -0.094, -0.11, heights=(0.0, 12e-3, 24e-3))
    on.arrays.states[1, body.W : body.W + 3] = 1.0, 2.0, 0.5
    energies = []
    for turn in range(30):
        states = on.arrays.states
        moving = sum(body.moving_energy(state, SOLID.inertia) for state in states)
        energies.append(moving + states[:, body.Z].sum())
        on.ride(turn)
    assert np.diff(energies).max() < 2e-4  # of m g L
    assert (np.array([on.reaches([n])[n][2] for n in range(3)]) * LENGTH > -2e-4).all()


@pytest.mark.parametrize(
    ("gaps", "seconds", "near"),
    [
        (0.0, 3.0, 0.02),
        (queue.MEAN_GAP_SHARE, 12.0, 0.05),
    ],  # so few uneven gaps are off by 1 mm in the mean
)
def test_a_row_on_the_bare_track_delivers_what_its_velocity_brings(gaps, seconds, near):
    found = queued(BOWL, 4, seconds, gaps=gaps)
    assert found.velocity == pytest.approx(answer.answer(BOWL).velocity, rel=0.04)
    assert found.gap == pytest.approx(gaps * 0.02, abs=1e-4 if gaps == 0.0 else 2e-3)
    assert found.rate == pytest.approx(found.velocity / (0.02 + found.gap), rel=near)
    assert found.jams == found.returned == found.climbs == 0 and found.depth < 5e-6


@pytest.mark.parametrize("gaps", [0.0, queue.MEAN_GAP_SHARE])
def test_a_row_that_hops_travels_as_the_point_mass_touching_or_not(gaps):
    """Throw number 2.27 at 100 Hz, no rebound: 83.2 mm/s; nothing climbs, and the rate is its pitch's."""
    own = ("drive.amplitude=0.1647 mm", "drive.frequency=100 Hz", "drive.vibration_angle=20 deg")
    more = ("track.radius=50 m", "track.climb=3 deg", "track.bank=0 deg", "friction.static=0.6")
    bowl = bowls.read(None, [*own, *more, "restitution=0", "track.width=30 mm"])
    found = queued(bowl, 4, 3.0, gaps=gaps)
    assert found.velocity == pytest.approx(answer.answer(bowl).velocity, rel=0.04)
    assert found.rate == pytest.approx(found.velocity / (0.02 + found.gap), rel=0.08)
    assert found.climbs == found.returned == found.jams == 0


@pytest.mark.parametrize("gaps", [queue.MEAN_GAP_SHARE, 0.5, 0.0, None])
def test_parts_enter_one_behind_the_other_with_the_free_way_between_them_that_is_asked_for(gaps):
    """In a row they are even from 0 to twice the mean; parts that are poured or come touching have none."""
    shares = np.array([one is FLAT for one in EVERY], float)
    made = queue.PartsQueue(PART, STILL, ASPECTS, (EVERY, shares), EVERY, queue.QueuePlan(300, 1.0, gaps), 3)
    ends = np.array([made.crowd.reaches([n])[n][:2] for n in range(300)])
    free = (ends[:-1, 0] - ends[1:, 1]) * LENGTH / FLAT.length
    assert not made.waiting and ends[0, 1] <= 1e-9 and made.most == 300
    if gaps:
        assert free.min() > 0.0 and 1.9 * gaps < free.max() < 2.0 * gaps
        assert free.mean() == pytest.approx(gaps, abs=4.0 * 2.0 * gaps / np.sqrt(12 * 300))
    else:
        assert np.abs(free).max() < 1e-9


def test_parts_wait_where_the_track_before_the_first_device_is_full():
    tight = replace(STILL, track=replace(STILL.track, radius=0.08, width=0.04))
    shares = np.array([one is FLAT for one in EVERY], float)
    made = queue.PartsQueue(PART, tight, ASPECTS, (EVERY, shares), EVERY, queue.QueuePlan(40, 1.0), 3)
    lying = np.flatnonzero(made.crowd.on)
    rears = [made.crowd.reaches([n])[n][0] * LENGTH for n in lying]
    room = 0.5 * 2.0 * np.pi * 0.08 - 2.0 * max(one.length for one in EVERY)
    assert len(lying) + len(made.waiting) == 40 and made.waiting
    assert -room <= min(rears) < -room + 1.4 * FLAT.length + 1e-9


def test_what_blew_on_a_part_does_not_blow_on_the_next_in_its_place():
    on = parts_on(STILL, -0.1)
    on.arrays.blown[0, 0], on.arrays.blown_until[0] = 5.0, 1.0
    on.lay(0, np.array(on.arrays.states[0]))
    on.ride(0)
    assert abs(on.arrays.states[0, body.VX]) < 1e-3


def test_an_interrupt_keeps_the_periods_until_then():
    def stop(done, total):
        assert total == 180
        if done == 6:
            raise KeyboardInterrupt

    found = queued(BOWL, 2, 3.0, run=RunSettings(1, progress=stop))
    assert found.partial and found.seconds == pytest.approx(0.1)


def test_what_left_stands_beside_what_was_measured():
    told = replace(queued(BOWL, 1, 0.02), whole=np.array([[9, 3, 0, 2]]))
    sheet = profiles.parse_count_sheet("aspect,MDFT\nA,0.5\nB,0.3\nC,0.2\n", "c.csv")
    columns = profiles.measured(sheet, "c.csv", "", ASPECTS.names).profiles
    shares = np.full(len(EVERY), 1.0 / len(EVERY))
    seen = result.outlet(told, EVERY, shares, ASPECTS.names, columns)
    assert seen.shares == pytest.approx([0.75, 0.25, 0.0]) and seen.other == 2
    assert seen.offered.sum() == pytest.approx(1.0)
    low, high = seen.ends
    assert (low <= seen.shares).all() and (seen.shares <= high).all()
    deviation, total = seen.distances["MDFT"]
    assert total == pytest.approx(0.25)
    assert deviation == pytest.approx(np.sqrt((0.25**2 + 0.05**2 + 0.2**2) / 3.0))


def test_a_part_lies_on_its_aspect_at_any_heading():
    below = looks.AspectsBelow(PART, ASPECTS)
    for one in EVERY:
        laid = [part_poses.pose_on_track(replace(one, heading=turn), PRINCIPAL, LENGTH, BOWL.track, place=0.0)
                for turn in (0.0, 1.0, 4.0)]  # fmt: skip
        assert [ASPECTS.names[row] for row in below.of(laid)] == [one.aspect] * 3


def test_what_has_no_room_yet_comes_next_however_long_it_is():
    even = np.full(len(EVERY), 1.0 / len(EVERY))
    small = replace(BOWL, track=replace(BOWL.track, radius=0.15))
    row = queue.PartsQueue(PART, small, ASPECTS, (EVERY, even), EVERY, queue.QueuePlan(40, 1.0, 0.0), 5)
    waits, came = row.coming, list(row.waiting)
    assert waits is not None and came  # the row reaches back to where the track begins
    for _ in range(20):
        row.enter()
        assert row.coming is waits and row.waiting == came
    on = np.flatnonzero(row.crowd.on)
    last = on[np.argsort(part_poses.ways_along_wall(row.crowd.arrays.states, row.part_in_bowl.radius)[on])][
        :3
    ]
    for n in last:
        row.crowd.take(int(n))
    row.enter()
    assert len(row.waiting) < len(came)


def test_a_queue_that_is_followed_bit_by_bit_is_that_of_one_go():
    """It goes on where it was, and its times are no shorter than was asked for."""
    shares, told = np.array([one is FLAT for one in EVERY], float), []
    bits = queue.PartsQueue(PART, BOWL, ASPECTS, (EVERY, shares), EVERY, queue.QueuePlan(2, 9.0), 3)
    for seconds in (0.2, 0.2, 0.41):
        bits.follow(seconds, lambda *row: told.append(row))
    first, whole = bits.result(), queued(BOWL, 2, 0.41, run=RunSettings(3))
    assert first.seconds == whole.seconds == pytest.approx(25 / 60) and not first.partial
    assert (first.velocity, first.gap, first.depth) == (whole.velocity, whole.gap, whole.depth)
    assert told == [(k, 12) for k in range(1, 13)] + [(k, 25) for k in range(13, 26)]
    bits.follow(1.0)
    assert first.seconds < bits.result().seconds == pytest.approx(1.0)


def test_parts_reach_as_far_together_as_alone_all_round_the_bowl():
    """A block in closed form: half its length before and behind it at the wall's angle, its foot at 0."""
    places = np.radians([10.0, 100.0, -150.0]) * 50.0
    on = parts_on(STILL, *places)
    reach = on.reaches([2, 0, 1])
    assert list(reach) == [2, 0, 1]
    for n, place in enumerate(places):
        off = 50.0 - 1e-3 - 12e-3  # [m] from the bowl's axis to the block's inner side
        half = 50.0 * np.arctan2(10e-3, off)
        assert np.array(reach[n]) * LENGTH == pytest.approx([place - half, place + half, 0.0], abs=1e-7)
        assert on.reaches([n])[n] == reach[n]
