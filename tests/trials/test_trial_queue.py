"""Parts that touch: momentum, weight and energy of a few; what a queue does at a device, blade or break."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from block_rides import (
    ALONG,
    ASPECTS,
    BOWL,
    EVERY,
    FLAT,
    LENGTH,
    PART,
    SHARES,
    SOLID,
    aspects_of,
    laid,
    lying,
    still,
)
from scipy.spatial.transform import Rotation

from feederscrew import bowl as bowls
from feederscrew.arrivals.kernel import body
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import zero_rows
from feederscrew.base.running import USUAL_RUN, RunSettings
from feederscrew.bowl.devices.kinds import KINDS, make_device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Friction
from feederscrew.feeding import stream
from feederscrew.motion import conveying as answer
from feederscrew.resting import profiles
from feederscrew.sorting import fates
from feederscrew.sorting.orientations import add_travel
from feederscrew.sorting.verdicts import verdict
from feederscrew.trials import fills, part_poses, queue, queue_counts, result, runs
from feederscrew.trials.kernel.steps import BEHIND, BELOW, IN_PART, IN_TRACK
from feederscrew.trials.kernel.workspace import JOURNAL, QueueSteps
from feederscrew.trials.shape import solid_of
from feederscrew.trials.supply import MEAN_GAP_SHARE, QueuePlan

STILL = still(climb=0.0)
# throw number 2.27 at 100 Hz, no rebound: 83.2 mm/s
HOPPING = bowls.read(
    None,
    ["drive.amplitude=0.1647 mm", "drive.frequency=100 Hz", "drive.vibration_angle=20 deg",
     "track.radius=50 m", "track.climb=3 deg", "track.bank=0 deg", "friction.static=0.6", "restitution=0",
     "track.width=30 mm"],
)  # fmt: skip
BLADE = make_device("wiper", "w", limit=4e-3)
SLOPE = np.radians(5.0)
BANKED = bowls.read(None, ["track.bank=3 deg"])


def parts_on(bowl, *places, heights=None, friction=None):
    """Blocks laid lengthwise with their middles at places [m] along the wall, some heights [m] over it."""
    known = runs.setting(SOLID, LENGTH, bowl)
    if friction is not None:
        known = replace(known, friction=np.full(5, friction))
    on = queue.PartsOnTrack(known, queue.lay_out_track(bowl, EVERY, (), 0.5), len(places))
    for n, place in enumerate(places):
        state = laid(PART, FLAT, bowl, place=place, aside=1e-3)
        state[body.Z] += 0.0 if heights is None else heights[n] / LENGTH
        on.lay(n, state)
    return on


def ride(row, turns, begin=0):
    """Follow parts for some periods; the deepest of the last one."""
    for turn in range(begin, begin + turns):
        depth = row.ride(turn)
    return depth


def queued(bowl, *planned, run=USUAL_RUN, **own):
    plan = QueuePlan(*planned, **own)
    return queue.queue_of(PART, bowl, ASPECTS, EVERY, EVERY, SHARES, plan, run)


def row_of(bowl, *planned, shares=SHARES, seed=3, part=PART):
    every = lying(part, bowl)
    return queue.PartsQueue(part, bowl, aspects_of(part), (every, shares), every, QueuePlan(*planned), seed)


def ways(row):
    """How far along the wall its parts are [m]."""
    return part_poses.ways_along_wall(row.crowd.arrays.states, row.part_in_bowl.radius) * LENGTH


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_a_part_that_strikes_another_shares_its_momentum(restitution):
    on = parts_on(replace(STILL, restitution=restitution), -0.10, -0.0795, friction=0.0)
    on.arrays.states[0, body.VX] = 0.3
    ride(on, 20)
    first, second = on.arrays.states[:, body.VX]
    assert first + second == pytest.approx(0.3, rel=1e-6)
    assert second - first == pytest.approx(0.3 * restitution, abs=1e-3)
    assert (on.reaches([1])[1][0] - on.reaches([0])[0][1] > 1e-2) == (restitution > 0.0)


def test_parts_in_each_other_are_pushed_apart():
    on = parts_on(STILL, -0.10, -0.0801)
    before = np.array(on.arrays.states[:, body.X]) * LENGTH
    ride(on, 4)
    assert on.depths.max() * LENGTH < 1e-4  # of the last period
    moved = on.arrays.states[:, body.X] * LENGTH - before
    assert moved[0] < -2e-5 and moved[1] > 2e-5
    assert np.diff(moved)[0] == pytest.approx(1e-4, abs=2e-5)


def test_a_part_on_another_bears_with_its_weight_and_falling_over_it_wins_no_energy():
    on = parts_on(STILL, -0.10, -0.097, heights=(0.0, 5e-3))
    assert ride(on, 40) * LENGTH < 1e-5
    assert on.arrays.states[1, body.Z] * LENGTH == pytest.approx(7.5e-3, abs=1e-5)
    assert on.forces[:, BELOW] == pytest.approx([0.0, 1.0], abs=0.02)
    assert on.forces[:, BEHIND] == pytest.approx(0.0, abs=0.02)
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


@pytest.mark.parametrize("room", [0, 2])
def test_lists_of_what_may_touch_decide_nothing(monkeypatch, room):
    """Parts that fall onto each other move by the same bytes where lists have no room, or only some have."""
    rows = [row_of(HOPPING, 8, 0.5, None), None]
    monkeypatch.setattr(runs, "MAX_NEAR_FACES", room)
    monkeypatch.setattr(runs, "MAX_CROSSINGS", room)
    rows[1] = row_of(HOPPING, 8, 0.5, None)
    for row in rows:
        row.follow(0.5)
    kept, without = (row.crowd.arrays for row in rows)
    assert kept.states.tobytes() == without.states.tobytes() and kept.strains.any()
    assert (kept.pair_lists.reach > 0.0).sum() > 1 and (without.pair_lists.reach < 0.0).any()
    assert (without.pair_lists.reach > 0.0).any() == (room > 0)


def test_lists_leave_out_nothing_that_touches_of_parts_with_many_corners(monkeypatch):
    """Gears that fall onto each other move by the same bytes with lists and where these have no room."""
    part = shapes.part(shapes.spur_gear())
    shares = np.full(len(lying(part, HOPPING)), 1.0 / len(lying(part, HOPPING)))
    row = row_of(HOPPING, 5, 0.5, None, shares=shares, part=part)
    monkeypatch.setattr(runs, "MAX_NEAR_FACES", 0)
    monkeypatch.setattr(runs, "MAX_CROSSINGS", 0)
    rows = [row, row_of(HOPPING, 5, 0.5, None, shares=shares, part=part)]
    for each in rows:
        each.follow(0.4)
    kept, without = (each.crowd.arrays for each in rows)
    assert kept.states.tobytes() == without.states.tobytes()
    assert (kept.pair_lists.reach > 0.0).any() and not (without.pair_lists.reach > 0.0).any()


@pytest.mark.parametrize(("bowl", "gaps", "seconds", "near"), [
    (BOWL, 0.0, 3.0, 0.02),
    (BOWL, MEAN_GAP_SHARE, 12.0, 0.05),  # so few uneven gaps are off by 1 mm in the mean
    (HOPPING, 0.0, 3.0, 0.08),
    (HOPPING, MEAN_GAP_SHARE, 3.0, 0.08),
])  # fmt: skip
def test_a_row_on_the_bare_track_delivers_what_its_velocity_brings(bowl, gaps, seconds, near):
    """It travels as the point mass, and the rate is its pitch's."""
    found = queued(bowl, 4, seconds, gaps=gaps)
    assert found.velocity == pytest.approx(answer.answer(bowl).velocity, rel=0.04)
    assert found.rate == pytest.approx(found.velocity / (0.02 + found.gap), rel=near)
    assert found.jams == found.returned == found.climbs == 0
    if bowl is BOWL:
        assert found.gap == pytest.approx(gaps * 0.02, abs=1e-4 if gaps == 0.0 else 2e-3)
        assert found.depth < 5e-6


@pytest.mark.parametrize("gaps", [MEAN_GAP_SHARE, 0.5, 0.0, None])
def test_parts_enter_one_behind_the_other_with_the_free_way_between_them_that_is_asked_for(gaps):
    """In a row they are even from 0 to twice the mean; parts that are poured or come touching have none."""
    row = row_of(STILL, 300, 1.0, gaps)
    ends = np.array([row.crowd.reaches([n])[n][:2] for n in range(300)])
    free = (ends[:-1, 0] - ends[1:, 1]) * LENGTH / FLAT.length
    assert not row.waiting_parts and ends[0, 1] <= 1e-9 and row.counts.max_on_track == 300
    if gaps:
        assert free.min() > 0.0 and 1.9 * gaps < free.max() < 2.0 * gaps
        assert free.mean() == pytest.approx(gaps, abs=4.0 * 2.0 * gaps / np.sqrt(12 * 300))
    else:
        assert np.abs(free).max() < 1e-9


def test_parts_wait_where_the_track_is_full_and_come_next_however_long_they_are():
    row = row_of(still(climb=0.0, radius=0.08, width=0.04), 40, 1.0)
    on = np.flatnonzero(row.crowd.is_on)
    rears = [row.crowd.reaches([n])[n][0] * LENGTH for n in on]
    room = 0.5 * 2.0 * np.pi * 0.08 - 2.0 * max(one.length for one in EVERY)
    assert len(on) + len(row.waiting_parts) == 40 and row.waiting_parts
    assert -room <= min(rears) < -room + 1.4 * FLAT.length + 1e-9
    bowl = replace(BOWL, track=replace(BOWL.track, radius=0.15))
    row = row_of(bowl, 40, 1.0, 0.0, shares=np.full(len(EVERY), 1.0 / len(EVERY)), seed=5)
    waits, came = row.supply.waiting, list(row.waiting_parts)
    assert waits is not None and came  # the row reaches back to where the track begins
    for _ in range(20):
        row.enter()
        assert row.supply.see_next() is waits and row.waiting_parts == came
    on = np.flatnonzero(row.crowd.is_on)
    for n in on[np.argsort(ways(row)[on])][:3]:
        row.crowd.take(int(n))
    row.enter()
    assert len(row.waiting_parts) < len(came)


def test_a_part_enters_however_much_room_a_device_needs(monkeypatch):
    """One block of 20 mm has 70 mm of bare track; with 0.2 m of room before it, it never came."""
    monkeypatch.setattr(queue.stream, "needed_spacing", lambda *own: 0.2)
    row = row_of(STILL, 1, 1.0, 0.2)
    assert row.crowd.is_on.all() and not row.waiting_parts
    row.ride(0)
    assert np.isfinite(row.result().velocity)


def test_what_blew_on_a_part_does_not_blow_on_the_next_in_its_place():
    on = parts_on(STILL, -0.1)
    on.arrays.jet_loads[0, 0], on.arrays.jets_until[0] = 5.0, 1.0
    on.lay(0, np.array(on.arrays.states[0]))
    on.ride(0)
    assert abs(on.arrays.states[0, body.VX]) < 1e-3


def test_what_left_stands_beside_what_was_measured():
    told = replace(queued(BOWL, 1, 0.02), whole=np.array([[9, 3, 0, 2]]))
    sheet = profiles.parse_count_sheet("aspect,MDFT\nA,0.5\nB,0.3\nC,0.2\n", "c.csv")
    columns = profiles.parse_profiles(sheet, "c.csv", "", ASPECTS.names).profiles
    shares = np.full(len(EVERY), 1.0 / len(EVERY))
    seen = result.outlet(told, EVERY, shares, ASPECTS.names, columns)
    assert seen.shares == pytest.approx([0.75, 0.25, 0.0]) and seen.other_count == 2
    assert seen.offered.sum() == pytest.approx(1.0)
    low, high = seen.ends
    assert (low <= seen.shares).all() and (seen.shares <= high).all()
    deviation, total = seen.distances["MDFT"]
    assert total == pytest.approx(0.25)
    assert deviation == pytest.approx(np.sqrt((0.25**2 + 0.05**2 + 0.2**2) / 3.0))


def test_a_queue_followed_bit_by_bit_is_that_of_one_go_and_an_interrupt_keeps_it():
    """It goes on where it was, and its times are no shorter than was asked for."""
    bits, told = row_of(BOWL, 2, 9.0), []
    for seconds in (0.2, 0.2, 0.41):
        bits.follow(seconds, lambda *row: told.append(row))
    first, whole = bits.result(), queued(BOWL, 2, 0.41, run=RunSettings(3))
    assert first.seconds == whole.seconds == pytest.approx(25 / 60) and not first.partial
    assert (first.velocity, first.gap, first.depth) == (whole.velocity, whole.gap, whole.depth)
    assert told == [(k, 12) for k in range(1, 13)] + [(k, 25) for k in range(13, 26)]
    bits.follow(1.0)
    assert first.seconds < bits.result().seconds == pytest.approx(1.0)

    def stop(done, total):
        assert total == 180
        if done == 6:
            raise KeyboardInterrupt

    found = queued(BOWL, 2, 3.0, run=RunSettings(1, progress=stop))
    assert found.partial and found.seconds == pytest.approx(0.1)


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


def slope():
    """A still track that falls and has no friction, with a blade; it is banked, or a row would slip out."""
    bowl = still(awkward.bowl("track.radius=50 m", "restitution=0"), climb=-SLOPE)
    return replace(bowl, friction=Friction(0.0, 0.0, 0.0, 0.0, 0.0), devices=(BLADE,))


@pytest.mark.parametrize("parts", [1, 3])
def test_a_row_pushes_what_a_blade_holds_with_its_weight_down_the_slope(parts):
    row = row_of(slope(), parts, 1.0, 0.0)
    ride(row, 30)
    row.counts.pressure[:], row.counts.touch_shares = 0.0, []  # without the impact
    ride(row, 10, 30)
    found, weight = row.result(), PART.mass * 9.81
    assert found.pressure[0] == pytest.approx((parts - 1) * weight * np.sin(SLOPE), abs=1e-3 * weight)
    assert found.touching == pytest.approx(1.0 - 1.0 / parts) and found.jams == found.returned == 0


def test_what_stands_at_a_blade_for_a_second_is_taken_out():
    row, seen = row_of(slope(), 1, 3.0, 0.0), []
    while not row.counts.jams and len(seen) < 200:
        seen.append(ways(row)[0])
        row.ride(len(seen) - 1)
    came = np.sqrt(2.0 * (seen[-1] - seen[0]) / (9.81 * np.sin(SLOPE)))
    assert row.time == pytest.approx(came + 1.0, abs=2.5 / row.bowl.drive.frequency)
    assert row.counts.jams == 1 and row.counts.whole == row.counts.returned == 0
    # it came in its own orientation, and stood at the blade: the first device
    jammed = row.result().jammed_at
    assert jammed.sum() == jammed[row.entry_rows[0], 1] == 1
    # what stands behind it was held up by it: it is taken out a second after it has come to the blade itself
    row, turn = row_of(slope(), 3, 5.0, 0.0), 0
    while not row.counts.jams and turn < 300:
        row.ride(turn)
        turn += 1
    first = row.time
    while row.counts.jams < 2 and turn < 600:
        row.ride(turn)
        turn += 1
    assert row.counts.jams == 2 and row.time - first >= 1.0
    row = row_of(STILL, 5, 1.0, 0.5)
    row.ride(0)
    free = -np.diff(ways(row)) - 0.02  # [m] from block to block, each 20 mm long
    assert free.min() > 0.0 and row.result().gap == pytest.approx(free.mean(), rel=0.01)


@pytest.mark.parametrize(("gap", "outcome"), [
    (0.1, queue.QueueOutcome.STANDS),  # behind a part that stands
    (0.3, queue.QueueOutcome.JAMS),
    (-5.0, queue.QueueOutcome.JAMS),  # the other one is behind it
])  # fmt: skip
def test_what_stands_close_behind_another_part_is_no_jam(gap, outcome):
    row = row_of(slope(), 2, 3.0, 0.0)
    begin, end = row.windows[0]
    front = 0.5 * (begin + end)
    reach = {0: [front + gap, front + gap + 1.0, 0.0], 1: [front - 1.0, front, 0.0]}
    row.mark[:], row.since[:] = front, -2.0
    assert row.crowd.is_on.all() and row.outcome_of(1, front - 0.5, reach, False) is outcome
    row.since[:] = -0.5
    assert row.outcome_of(1, front - 0.5, reach, False) is queue.QueueOutcome.STANDS


def test_what_stands_too_deep_in_something_is_a_fault_of_the_trial_and_no_jam(monkeypatch):
    """On either side of the limit, in the track or in another part; it is taken out as a jam is."""
    row, limit = row_of(slope(), 1, 3.0, 0.0), queue_counts.MAX_QUEUE_DEPTH_M / LENGTH
    front = row.windows[0].mean()
    row.mark[:], row.since[:] = front, -2.0
    for where in (IN_TRACK, IN_PART):
        for share, outcome in ((1.01, queue.QueueOutcome.OVERLAPS), (0.99, queue.QueueOutcome.JAMS)):
            row.crowd.arrays.depths[:] = 0.0
            row.crowd.arrays.depths[0, where] = share * limit
            assert row.outcome_of(0, front - 0.5, {0: [front - 1.0, front, 0.0]}, False) is outcome
    counted = []
    for limit in (queue_counts.MAX_QUEUE_DEPTH_M, -1.0):
        monkeypatch.setattr(queue, "MAX_QUEUE_DEPTH_M", limit)
        row = row_of(slope(), 1, 2.0, 0.0)
        while row.time < 2.0 and row.crowd.is_on[0]:
            row.ride(row.periods)
            row.waiting_parts = []
        made = row.result()
        counted.append((made.jams, made.jammed_at.sum(), made.overlaps, made.returned))
    assert counted == [(1, 1, 0, 0), (0, 0, 1, 0)]


def test_a_queue_says_how_deep_its_parts_were_in_the_track_and_in_each_other():
    """Blocks laid 0.1 mm into each other, then one 0.05 mm into the track: each depth where it is."""
    row = row_of(STILL, 2, 1.0, 0.0)
    state = row.crowd.arrays.states[1]
    first, second = ways(row)
    state[body.X] += (first - second - FLAT.length + 1e-4) / LENGTH
    row.ride(0)
    found = row.result()
    assert found.depth_in_part == pytest.approx(1e-4, abs=2e-5) and found.depth_in_track < 1e-5
    assert found.depth == found.depth_in_part
    row = row_of(STILL, 1, 1.0, 0.0)
    row.crowd.arrays.states[0, body.Z] -= 5e-5 / LENGTH
    row.ride(0)
    found = row.result()
    assert found.depth_in_track == pytest.approx(5e-5, abs=5e-6) and found.depth_in_part == 0.0


@pytest.mark.parametrize(("beyond", "deep"), [(1.9e-5, (0.0, 1e-6)), (-5e-5, (5e-5, 2.1e-4))])
def test_a_corner_beside_a_part_is_not_taken_for_deep_in_it(beyond, deep):
    """A block on end leans by 3 % over one that lies; its lower corner is 0.2 mm below the top of that one.

    Beyond the end of it by 13 um the corner is in the air. It was taken for 0.2 mm deep under the top, since
    a corner may lie up to 21 um outside the face that it touches. 50 um within the end it is in the part.
    """
    on, lean = parts_on(STILL, -0.10, -0.05), np.arctan(0.03)
    first, second = on.arrays.states
    upright = Rotation.from_euler("y", -0.5 * np.pi - lean) * Rotation.from_matrix(part_poses.matrix(first))
    second[body.Q : body.Q + 4] = np.roll(upright.as_quat(), 1)
    spots = vectors.product(SOLID.corners, upright.as_matrix().T) * LENGTH
    low = spots[np.argmin(spots[:, 2])]
    assert np.ptp(spots[:, 2]) > 0.02 * np.cos(lean)  # on end
    first[body.X : body.Z + 1] = np.array([-0.1, 7e-3, 2.5e-3]) / LENGTH
    second[body.X : body.Z + 1] = (first[:3] * LENGTH + [10e-3 + beyond, 3e-3, 2.3e-3] - low) / LENGTH
    one_step = QueueSteps(on.is_on, 0.0, 1, zero_rows(1, JOURNAL))
    runs.move_crowd(on.part_in_bowl, on.surface, on.arrays, one_step)
    least, most = deep
    assert least <= on.depths[:, IN_PART].min() * LENGTH <= on.depths[:, IN_PART].max() * LENGTH <= most


@pytest.mark.parametrize("comes_first", [False, True])
def test_an_edge_that_comes_to_the_end_of_a_hollow_edge_is_held_there(comes_first):
    """An edge of a T nut comes 20 um deep into another one, where its hollow edge ends in its end face.

    There two convex edges begin. The edge that comes crosses neither: it passes before both beginnings, by
    half its depth. Against either it is 20 um / sqrt(2) deep, the angle between the normals being 60 deg.
    """
    part, deep = shapes.part(shapes.t_nut()), 2e-5
    solid, length, principal = solid_of(part)
    on = queue.PartsOnTrack(runs.setting(solid, length, STILL), queue.lay_out_track(STILL, EVERY, (), 0.5), 2)
    along, middle = np.array([1.0, 1.0, -1.0]) / np.sqrt(3.0), np.array([2.0, -1.0, 1.0]) / np.sqrt(6.0)
    across = np.cross(along, middle)
    sides = (middle + across) / np.sqrt(2.0), (middle - across) / np.sqrt(2.0)
    # rotation of each from its file, the place [m] in its file that comes to one place in the air
    held = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), np.array([2.5e-3, 0.0, -10e-3])
    comes = np.column_stack([*sides, np.cross(*sides)]), np.array([5e-3, 3e-3, 0.0])
    for n, (turn, spot) in enumerate((comes, held) if comes_first else (held, comes)):
        state = np.zeros(body.STATE)
        state[body.Q : body.Q + 4] = np.roll(Rotation.from_matrix(turn @ principal).as_quat(), 1)
        state[:3] = (
            np.array([-0.1 + deep * (n != comes_first), 0.04, 0.06]) - turn @ (spot - part.centre_of_mass)
        ) / length
        on.lay(n, state)
    one_step = QueueSteps(on.is_on, 0.0, 1, zero_rows(1, JOURNAL))
    runs.move_crowd(on.part_in_bowl, on.surface, on.arrays, one_step)
    assert on.depths[:, IN_PART] * length == pytest.approx(deep / np.sqrt(2.0), rel=1e-3)


def test_poured_parts_come_to_lie_and_travel():
    row = row_of(BOWL, 3, 2.0, None)
    ride(row, 60)
    before = ways(row)
    ride(row, 60, 60)
    velocities = ways(row) - before  # [m/s] over the last second
    onwards = velocities > 0.0  # not one that left and was poured again
    assert onwards.sum() >= 2 and row.result().is_poured
    assert velocities[onwards] == pytest.approx(answer.answer(BOWL).velocity, rel=0.05)
    heights = row.crowd.arrays.states[onwards, body.Z] * LENGTH
    assert np.abs(heights[:, None] - [2.5e-3, 6e-3, 10e-3]).min(axis=1).max() < 1e-5  # on a face
    assert row.result().depth < queue_counts.MAX_QUEUE_DEPTH_M


@pytest.mark.parametrize("ledge, stop, leaves", [(6.5, True, True), (14.0, True, False), (6.5, False, False)])
def test_parts_that_back_up_and_reach_over_the_ledge_of_a_pressure_break_leave_there(ledge, stop, leaves):
    """Eight blocks that touch, 12 mm wide: they reach over a ledge of 6.5 mm, not over one of 14 mm."""
    chain = (make_device("pressure break", "", limit=1e-3 * ledge),)
    chain += (make_device("height bar", "", limit=4e-3),) * stop  # everything stands before it
    known = stream.follow_orientations(PART, ASPECTS, BANKED.track, chain, bowl=BANKED)
    plan, bowl = QueuePlan(8, 5.0, 0.0), replace(BANKED, devices=chain)
    found = queue.queue_of(PART, bowl, ASPECTS, known.lying, known.states, SHARES, plan, RunSettings(2))
    assert (found.relieved > 0) == leaves and found.returned == found.relieved
    assert (found.jams > 0) == stop and (found.leaving_counts.sum() > 0 or stop)


def test_the_break_that_is_proposed_carries_what_is_wanted_and_no_more_than_it_has_to():
    every = stream.follow_orientations(PART, ASPECTS, BANKED.track, bowl=BANKED).lying
    one = every[ALONG]
    (kind,) = [kind for kind in KINDS.values() if kind.action is Action.RELIEVE]
    device = kind.relieving([one], 2.5e-4, "design")
    assert device.kind == "pressure break"
    assert device.text == "6.15 mm"  # half the width less 2.5 tan(3 deg), plus 0.25 mm, in steps of 0.05 mm
    assert verdict(device, one, every).margin == pytest.approx(device.limit - one.balcony)
    assert 2.5e-4 <= device.limit - one.balcony < 3e-4 and device.limit < one.width
    assert kind.relieving([one, replace(one, width=6.3e-3)], 2.5e-4, "design") is None
    hopping = kind.relieving([replace(one, hop=1e-3)], 2.5e-4, "design")
    assert hopping.limit == pytest.approx(device.limit + 1e-3)


def test_who_lies_on_another_behind_a_step_has_climbed_as_before_it():
    """Behind a step of 8 mm a block on another lies 3 mm below the first level: it was not counted."""
    for place in (0.02, -0.05):
        bowl = replace(STILL, devices=(make_device("step", "s", limit=8e-3),))
        row = queue.PartsQueue(PART, bowl, ASPECTS, (EVERY, SHARES), EVERY, QueuePlan(2, 1.0), 1)
        (begin,) = row.track.changes
        level = row.track.level_at(begin + place)
        assert level == (-8e-3 if place > 0.0 else 0.0)
        for n, height in enumerate((0.0, 5e-3)):
            state = laid(PART, FLAT, bowl, place=begin + place, aside=1e-3)
            state[body.Z] += (level + height) / LENGTH
            row.crowd.lay(n, state)
        row.waiting_parts = []
        row.follow(0.1)
        assert row.counts.climbs == 1


def test_the_level_beside_a_ledge_is_that_of_the_ledge_up_to_its_end():
    line = queue.lay_out_track(BOWL, EVERY, (make_device("tipping ledge", "t", limit=6e-3),), 0.1)
    (end,) = line.changes
    height = max(one.length for one in EVERY) / 2.0  # half the greatest length
    assert line.level_at(end - 1e-6) == 0.0 and line.level_at(end) == pytest.approx(-height)
    assert end < line.outlet


def test_frames_of_a_queue_are_the_same_whether_it_is_followed_at_once_or_in_bits():
    plan = QueuePlan(2, 0.4, 0.0, 8)
    rows = [queue.PartsQueue(PART, BOWL, ASPECTS, (EVERY, SHARES), EVERY, plan, 1) for _ in range(2)]
    rows[0].follow(0.4)
    for seconds in (0.1, 0.25, 0.4):
        rows[1].follow(seconds)
    assert [one[0] for one in rows[0].moments] == [one[0] for one in rows[1].moments]
    assert len(rows[0].moments) == 8
    np.testing.assert_array_equal(rows[0].poses, rows[1].poses)


def test_blocks_that_lie_leave_a_twisted_track_on_their_edge():
    """The pose and the aspect in which they leave are those of statics, one behind the other as well."""
    twist = make_device("twisted track", "t", angle=1.3, length=0.06)
    bowl = replace(bowls.read(None, ["track.width=24 mm"]), devices=(twist,))
    every = add_travel(lying(PART, bowl), bowl)
    flow = fates.course(bowl.devices, every)
    shares = np.array([one.height < 6e-3 and one.length > 0.0199 for one in every], float)
    (row,) = np.flatnonzero(shares)
    edge = int(flow.leaving[row].argmax())
    assert flow.leaving[row, edge] == 1.0 and flow.states[edge].height == pytest.approx(0.012)
    run, plan = RunSettings(1), QueuePlan(3, 10.0, 0.1)
    found = queue.queue_of(PART, bowl, ASPECTS, every, flow.states, shares, plan, run)
    assert found.leaving_counts[edge] == found.leaving_counts.sum() >= 2 and found.returned == found.jams == 0
    assert found.aspects[ASPECTS.names.index(flow.states[edge].aspect)] == found.leaving_counts.sum()


@pytest.mark.parametrize("radius", [66.0, 52.0])  # [mm] of bowls: devices take 0.46 and 0.58 of a turn
def test_parts_leave_devices_that_go_round_more_than_half_the_bowl(radius):
    """A part that leaves reaches beyond half a turn from where the devices begin."""
    own = [f"track.radius={radius} mm", "drive.amplitude=0.1647 mm", "drive.frequency=100 Hz",
           "drive.vibration_angle=20 deg", "track.bank=0 deg", "friction.static=0.6", "restitution=0",
           "track.width=15 mm"]  # fmt: skip
    gaps = tuple(make_device("gap", f"gap {k}", limit=2e-3) for k in range(6))
    row = row_of(replace(bowls.read(None, own), devices=gaps), 3, 5.0, 0.0)
    row.follow(5.0)
    outcome = row.result()
    assert outcome.returned == outcome.jams == 0 and outcome.velocity > 0.04
    assert outcome.whole.sum() >= 3 and outcome.left_by_entry.sum() == outcome.whole.sum()
    assert row.track.outlet + LENGTH < 2.0 * np.pi * 1e-3 * radius


def test_devices_that_leave_no_room_for_a_row_in_a_turn_are_refused():
    gaps = tuple(make_device("gap", f"gap {k}", limit=2e-3) for k in range(6))
    own = replace(bowls.read(None, ["track.radius=40 mm", "track.width=15 mm"]), devices=gaps)
    with pytest.raises(FeederError, match=r"devices: take .* mm of track, and a row of parts needs .*radius"):
        row_of(own, 3, 5.0, None)
    with pytest.raises(FeederError):
        fills.require_room(own, lying(PART, own))
    fills.require_room(replace(own, devices=gaps[:2]), lying(PART, own))
