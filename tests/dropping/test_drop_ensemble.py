"""Launches, many drops and their counts."""

import time
from concurrent.futures import wait

import drop_bodies
import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew.dropping import drop_test, ensemble, launch_conditions
from feederscrew.dropping.ensemble import Aim, Drops, drop, tally, wilson
from feederscrew.dropping.kernel.one_drop import UNSETTLED
from feederscrew.dropping.launch_conditions import FLIP_LEAN_RAD, PRESETS, named, sample
from feederscrew.dropping.pool import gather
from feederscrew.errors import ArgumentError, ConfigError
from feederscrew.resting.aspects import find
from feederscrew.resting.rules import recommended
from feederscrew.running import RunSettings

BOX, LENGTH = drop_bodies.box((1.0, 1.3, 1.7))
ROWS = np.array([0, 0, 1, 1, 2, 2])
NOTHING = dict.fromkeys(launch_conditions.CONDITION_KEYS)


def seeded(**more):
    return drop(BOX, PRESETS["roll"], np.random.default_rng(5), **more)


def test_counts_do_not_depend_on_the_number_of_jobs():
    one, three = seeded(count=2300, jobs=1), seeded(count=2300, jobs=3)
    assert (one.faces == three.faces).all() and (one.times == three.times).all()


def test_fewer_drops_are_the_first_of_many(monkeypatch):
    few, many = seeded(count=300), seeded(count=2500)
    assert (few.faces == many.faces[:300]).all()
    monkeypatch.setattr(ensemble, "DROPS_A_LOOK", 500)
    assert (seeded(count=2500).faces == many.faces).all()


def test_until_ends_when_every_interval_is_narrow():
    aim = Aim(0.015, ROWS, 3)
    drops = seeded(aim=aim)
    counted = tally(drops, ROWS, 3)
    assert counted.widest == aim.widest(drops.faces) <= 0.015
    assert (
        len(drops.faces) > ensemble.DROPS_A_LOOK and aim.widest(drops.faces[: -ensemble.DROPS_A_LOOK]) > 0.015
    )


def test_what_an_aim_needs():
    aim = Aim(0.01, ROWS, 3)
    assert aim.needed(4000, 0.01) == 4000
    assert aim.needed(2000, 0.02) == 8000  # four times as many for half the width
    assert aim.needed(2000, 0.0101) == 4000  # in whole rounds


@pytest.mark.parametrize(("jobs", "batches"), [(1, 1), (3, 5)])
def test_an_interrupt_keeps_what_is_finished(jobs, batches):
    """The batches done so far, as a shorter run gives them; those the others were at may come on top."""
    told = []

    def stop(done, total, widest):
        told.append(done)
        if len(told) == batches:
            raise KeyboardInterrupt

    drops = seeded(count=20_000, jobs=jobs, progress=stop)
    count = len(drops.faces)
    assert drops.partial and told[-1] == batches * ensemble.DROPS_A_BATCH <= count < 20_000
    assert count % ensemble.DROPS_A_BATCH == 0
    whole = seeded(count=count)
    assert not whole.partial
    for name in ("faces", "times", "energies"):
        assert (getattr(drops, name) == getattr(whole, name)).all()


def test_a_batch_that_failed_ends_what_is_kept():
    """Of three batches the second has a fault: only the first counts, though the third is there."""

    def work(begin):
        tasks = [begin(lambda: "first"), begin(lambda: 1 / 0), begin(lambda: "third")]
        wait(tasks)
        raise KeyboardInterrupt

    assert gather(work, 3) == (["first"], True)


def test_work_may_end_before_all_that_it_began():
    """Draws that cannot hold any more end so: a task that waits is cancelled, which is no fault."""

    def work(begin):
        first = begin(int, 7)
        begin(time.sleep, 0.2)  # on the only thread
        begin(int, 9)
        first.result()

    results, partial = gather(work, 1)
    assert results[0] == 7 and 9 not in results and not partial


def test_a_tally_counts_every_drop_once():
    faces = np.array([0, 1, 2, 5, UNSETTLED, 4, 0, 3, UNSETTLED])
    energies = np.arange(9.0)
    counted = tally(Drops(faces, np.zeros(9), energies, np.zeros(9), False), ROWS, 3)
    assert counted.counts.tolist() == [3, 2, 2] and counted.unsettled == 2
    assert counted.p == pytest.approx([3 / 7, 2 / 7, 2 / 7]) and counted.unsettled_share == pytest.approx(
        2 / 9
    )
    assert counted.gentle == pytest.approx([2 / 3, 1 / 3, 0])
    assert counted.violent == pytest.approx([1 / 2, 1 / 2, 0])  # of the two that settled


def test_a_tally_of_drops_that_never_settle_knows_nothing():
    counted = tally(Drops(np.full(4, UNSETTLED), *np.zeros((3, 4)), False), ROWS, 3)
    assert np.isnan(counted.p).all() and counted.unsettled == 4 and counted.unsettled_share == 1.0
    assert counted.low.tolist() == [0.0] * 3 and counted.high.tolist() == [1.0] * 3


def test_the_interval_holds_the_numerical_error_beside_the_sampling():
    faces = np.tile([0, 2], 200_000)
    counted = tally(Drops(faces, *np.zeros((3, len(faces))), False), ROWS, 3)
    known = np.hypot(ensemble.NUMERICAL_SHARE_ERROR, counted.widest)
    assert counted.high[0] - 0.5 == pytest.approx(np.hypot(known, recommended.LAUNCH_WIDTH), rel=1e-3)
    rare = recommended.LAUNCH_WIDTH * recommended.shape(0.0)
    assert counted.low[2] == 0.0 and counted.high[2] == pytest.approx(rare, abs=1e-4)


def test_the_wilson_interval():
    low, high = wilson(np.array([0, 10, 40]), 40)  # ends solve (p - x)^2 = z^2 x (1 - x) / n
    for count, ends in ((10, (low[1], high[1])),):
        for x in ends:
            assert (count / 40 - x) ** 2 == pytest.approx(ensemble.NORMAL_95**2 * x * (1 - x) / 40)
    assert low[0] == 0.0 and high[2] == 1.0 and high[0] > 0.0 and low[2] < 1.0


def test_every_drop_starts_at_its_fall_within_the_ranges(rng):
    launch = PRESETS["roll"]
    starts = sample(launch, BOX, 500, rng)
    speed = np.hypot(starts.states[:, 3], starts.states[:, 4])
    spin = np.linalg.norm(starts.states[:, 10:], axis=1)
    turns = Rotation.from_quat(starts.states[:, [7, 8, 9, 6]])
    fall = starts.states[:, 2] + [turn.apply(BOX.vertices.copy())[:, 2].min() for turn in turns]
    for values, (low, high) in (
        (fall, launch.fall),
        (speed, launch.speed),
        (spin, launch.spin),
        (starts.frictions, launch.friction),
    ):
        assert (
            low <= values.min() < low + 0.1 * (high - low)
            and high - 0.1 * (high - low) < values.max() <= high
        )


def test_a_rolled_part_spins_about_a_level_axis_whatever_its_way(rng):
    states = sample(PRESETS["roll"], BOX, 2000, rng).states.copy()
    spin = Rotation.from_quat(states[:, [7, 8, 9, 6]]).apply(states[:, 10:])
    assert np.abs(spin[:, 2]).max() < 1e-12 and np.linalg.norm(spin, axis=1).min() > 0.9
    size = np.linalg.norm(spin[:, :2], axis=1) * np.linalg.norm(states[:, 3:5], axis=1)
    assert np.abs(((spin[:, :2] * states[:, 3:5]).sum(axis=1) / size).mean()) < 0.06


def test_a_flip_is_held_level_to_its_lean_and_alike_all_round(rng):
    """An axis that points anywhere stands as often as it lies: no thumb flips so."""
    states = sample(PRESETS["flip"], BOX, 20000, rng).states.copy()
    spin = Rotation.from_quat(states[:, [7, 8, 9, 6]]).apply(states[:, 10:])
    size = np.linalg.norm(spin, axis=1)
    assert size.min() >= 6.0 and size.max() <= 14.0
    rise, ahead = np.arcsin(spin[:, 2] / size), np.arctan2(spin[:, 1], spin[:, 0])
    assert np.abs(rise).max() <= FLIP_LEAN_RAD and np.quantile(np.abs(rise), 0.5) == pytest.approx(
        FLIP_LEAN_RAD / 2, rel=0.03
    )
    assert np.abs([np.cos(ahead).mean(), np.sin(ahead).mean(), np.cos(2 * ahead).mean()]).max() < 0.03
    around = np.arctan2(states[:, 11], states[:, 10])  # in the plane of the box's greatest face
    assert np.abs([np.cos(around).mean(), np.sin(around).mean(), np.cos(2 * around).mean()]).max() < 0.03
    turned = Rotation.from_quat(states[:, [7, 8, 9, 6]]).apply(BOX.flat.copy())
    side = np.cross(spin / size[:, None], [0.0, 0.0, 1.0])
    phase = np.arctan2((turned * side).sum(axis=1), turned[:, 2])
    assert np.abs([np.cos(phase).mean(), np.sin(phase).mean()]).max() < 0.03


@pytest.mark.parametrize(("thick", "measured"), [(0.354, 0.132), (0.577, 0.41)])
def test_thick_coins_flipped_by_hand(thick, measured):
    """With an axis that points anywhere they were 0.12 and 0.32 on edge."""
    part = shapes.part(shapes.cylinder(10.0, 20.0 * thick, 96))
    aspects = find(part)
    found = drop_test.test(
        part, aspects, "flip", dict.fromkeys(launch_conditions.CONDITION_KEYS), drops=4000, run=RunSettings(5)
    )
    edge = found.tally.p[np.abs(aspects.heights - 0.01) < 1e-4].sum()
    assert edge == pytest.approx(measured, abs=0.03)


def test_the_former_name_of_a_launch_is_known():
    assert named("tumble") is PRESETS["roll"]
    with pytest.raises(ArgumentError, match="launch: is 'kick'"):
        named("kick")


def test_attitudes_are_uniform(rng):
    q = sample(PRESETS["drop"], BOX, 20000, rng).states[:, 6:10]
    down = Rotation.from_quat(q[:, [1, 2, 3, 0]]).inv().apply([0.0, 0.0, 1.0]).T
    assert np.abs(down.mean(axis=1)).max() < 0.02
    assert down @ down.T / len(q) == pytest.approx(np.eye(3) / 3.0, abs=0.01)


def test_what_restitution_moves_is_in_the_interval_of_an_own_surface():
    """The share of a face goes from 0.3 to 0.7 as restitution does from 0 to 1."""
    rng, count = np.random.default_rng(5), 40_000
    restitutions = rng.random(count)
    faces = np.where(rng.random(count) < 0.3 + 0.4 * restitutions, 0, 1)
    drops = Drops(faces, np.zeros(count), np.zeros(count), restitutions, False)
    plain, own = tally(drops, np.array([0, 1]), 2), tally(drops, np.array([0, 1]), 2, surface=True)
    told = 1.96 * 0.4 * np.sqrt((1.0 - 1.0 / 16.0) / 12.0)
    assert plain.restitution == pytest.approx([told, told], rel=0.05)
    assert (own.high - own.p) ** 2 - (plain.high - plain.p) ** 2 == pytest.approx(
        plain.restitution**2, rel=1e-6
    )
    still = tally(
        Drops(faces, np.zeros(count), np.zeros(count), rng.random(count), False), np.array([0, 1]), 2
    )
    assert (still.restitution < 0.012).all()


@pytest.mark.parametrize("value, half", [(0.0, 0.0), (0.5, 0.1386), (0.95, 0.05), (1.0, 0.0)])
def test_one_value_of_restitution_becomes_a_range_of_the_deviation_of_impacts(value, half):
    low, high = PRESETS["feed"].but(restitution=(value, value)).scattering().restitution
    assert (low, high) == pytest.approx((value - half, value + half), abs=1e-4)
    assert PRESETS["feed"].scattering() == PRESETS["feed"]


def test_own_conditions_replace_the_presets():
    launch = launch_conditions.launch_of("feed", 0.01, NOTHING | {"fall": "20 mm", "friction": "0.2:0.3"})
    assert launch.name == "own" and launch.fall == pytest.approx((2.0, 2.0))
    assert launch.friction == (0.2, 0.3) and launch.spin == PRESETS["feed"].spin
    told = launch_conditions.described(launch, 0.01)
    assert told["height_mm"] == pytest.approx([20.0, 20.0]) and told["friction"] == [0.2, 0.3]
    assert launch_conditions.launch_of("drop", 0.01, NOTHING) == PRESETS["drop"]


@pytest.mark.parametrize(
    ("key", "text", "line"),
    [
        ("fall", "20", "fall: '20' has no unit - write 20 mm"),
        (
            "friction",
            "0.5:0.2",
            "friction: '0.5:0.2' is not a range - give one value, or the smaller and the larger as a:b",
        ),
        ("fall", "20 m", "fall: '20 m' is out of range - give 0 mm to 10000 mm for this part"),
        ("spin", "1e5 rad/s", "spin: '1e5 rad/s' is out of range - give 0 rad/s to 3130 rad/s for this part"),
        ("restitution", "1.5", "restitution: '1.5' is out of range - give 0 to 1"),
    ],
)
def test_conditions_that_are_none(key, text, line):
    with pytest.raises(ConfigError) as fault:
        launch_conditions.launch_of("feed", 0.01, NOTHING | {key: text})
    assert str(fault.value) == line
