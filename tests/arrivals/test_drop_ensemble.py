"""Launches, many drops and their counts."""

import time
from concurrent.futures import wait

import drop_bodies
import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew.arrivals import drop_test, ensemble, launch_conditions
from feederscrew.arrivals.ensemble import Aim, Drops, drop, tally, wilson
from feederscrew.arrivals.kernel.one_drop import UNSETTLED
from feederscrew.arrivals.launch_conditions import FLIP_LEAN_RAD, PRESETS, named, sample
from feederscrew.arrivals.pool import gather
from feederscrew.base.errors import ArgumentError, ConfigError
from feederscrew.base.running import RunSettings
from feederscrew.resting.aspects import find
from feederscrew.resting.rules import recommended

BOX, _ = drop_bodies.box((1.0, 1.3, 1.7))
ROWS = np.array([0, 0, 1, 1, 2, 2])
NOTHING = dict.fromkeys(launch_conditions.CONDITION_KEYS)
OUT = "is out of range - give"


def seeded(**more):
    return drop(BOX, PRESETS["roll"], np.random.default_rng(5), **more)


def same(first, second):
    return all((getattr(first, k) == getattr(second, k)).all() for k in ("faces", "times", "energies"))


def test_counts_depend_neither_on_jobs_nor_on_looks_and_fewer_drops_are_the_first_of_many(monkeypatch):
    many = seeded(count=2300, jobs=1)
    assert same(many, seeded(count=2300, jobs=3))
    assert (seeded(count=300).faces == many.faces[:300]).all()
    monkeypatch.setattr(ensemble, "DROPS_A_LOOK", 500)
    assert same(many, seeded(count=2300))


def test_until_ends_when_every_interval_is_narrow():
    aim = Aim(0.015, ROWS, 3)
    drops = seeded(aim=aim)
    assert tally(drops, ROWS, 3).widest == aim.widest(drops.faces) <= 0.015
    assert len(drops.faces) > ensemble.DROPS_A_LOOK
    assert aim.widest(drops.faces[: -ensemble.DROPS_A_LOOK]) > 0.015
    # Four times as many for half the width, in whole rounds.
    aim = Aim(0.01, ROWS, 3)
    assert [aim.needed(*done) for done in ((4000, 0.01), (2000, 0.02), (2000, 0.0101))] == [4000, 8000, 4000]


@pytest.mark.parametrize(("jobs", "batches"), [(1, 1), (3, 5)])
def test_an_interrupt_keeps_what_is_finished(jobs, batches):
    """The batches done so far, as a shorter run gives them; those the others were at may come on top."""
    counts = []

    def stop(done, total, widest):
        counts.append(done)
        if len(counts) == batches:
            raise KeyboardInterrupt

    drops = seeded(count=20_000, jobs=jobs, progress=stop)
    count = len(drops.faces)
    assert drops.partial and counts[-1] == batches * ensemble.DROPS_A_BATCH <= count < 20_000
    assert count % ensemble.DROPS_A_BATCH == 0
    whole = seeded(count=count)
    assert not whole.partial and same(drops, whole)


def test_a_pool_keeps_what_is_finished_in_order():
    """Of three batches the second has a fault: only the first counts, though the third is there."""

    def work(begin):
        wait([begin(lambda: "first"), begin(lambda: 1 / 0), begin(lambda: "third")])
        raise KeyboardInterrupt

    assert gather(work, 3) == (["first"], True)

    # Draws that cannot hold any more end so: a task that waits is cancelled, which is no fault.
    def work(begin):
        first = begin(int, 7)
        begin(time.sleep, 0.2)  # on the only thread
        begin(int, 9)
        first.result()

    results, partial = gather(work, 1)
    assert results[0] == 7 and 9 not in results and not partial


def drops_of(faces, energies=None, restitutions=None):
    empty = np.zeros(len(faces))
    values = [empty if column is None else np.asarray(column) for column in (energies, restitutions)]
    return Drops(np.asarray(faces), empty, *values, False)


def test_tallies_and_their_intervals():
    faces = [0, 1, 2, 5, UNSETTLED, 4, 0, 3, UNSETTLED]
    counts = tally(drops_of(faces, np.arange(9.0)), ROWS, 3)
    assert counts.counts.tolist() == [3, 2, 2]
    assert (counts.unsettled, counts.unsettled_share) == (2, pytest.approx(2 / 9))
    assert counts.p == pytest.approx([3 / 7, 2 / 7, 2 / 7])
    assert counts.gentle == pytest.approx([2 / 3, 1 / 3, 0])
    assert counts.violent == pytest.approx([1 / 2, 1 / 2, 0])  # of the two that settled
    nothing = tally(drops_of([UNSETTLED] * 4), ROWS, 3)
    assert np.isnan(nothing.p).all() and (nothing.unsettled, nothing.unsettled_share) == (4, 1.0)
    assert nothing.low.tolist() == [0.0] * 3 and nothing.high.tolist() == [1.0] * 3
    counts = tally(drops_of(np.tile([0, 2], 200_000)), ROWS, 3)
    own = np.hypot(ensemble.NUMERICAL_SHARE_ERROR, counts.widest)
    assert counts.high[0] - 0.5 == pytest.approx(np.hypot(own, recommended.LAUNCH_WIDTH), rel=1e-3)
    rare = recommended.LAUNCH_WIDTH * recommended.shape(0.0)
    assert counts.low[2] == 0.0 and counts.high[2] == pytest.approx(rare, abs=1e-4)
    # Its ends solve (p - x)^2 = z^2 x (1 - x) / n.
    low, high = wilson(np.array([0, 10, 40]), 40)
    for x in (low[1], high[1]):
        assert (10 / 40 - x) ** 2 == pytest.approx(ensemble.NORMAL_95**2 * x * (1 - x) / 40)
    assert low[0] == 0.0 and high[2] == 1.0 and high[0] > 0.0 and low[2] < 1.0


def test_what_restitution_moves_is_in_the_interval_of_an_own_surface():
    """The share of a face goes from 0.3 to 0.7 as restitution does from 0 to 1."""
    rng, count, rows = np.random.default_rng(5), 40_000, np.array([0, 1])
    restitutions = rng.random(count)
    faces = np.where(rng.random(count) < 0.3 + 0.4 * restitutions, 0, 1)
    drops = drops_of(faces, restitutions=restitutions)
    plain, own = tally(drops, rows, 2), tally(drops, rows, 2, surface=True)
    width = 1.96 * 0.4 * np.sqrt((1.0 - 1.0 / 16.0) / 12.0)
    assert plain.restitution == pytest.approx([width, width], rel=0.05)
    more = (own.high - own.p) ** 2 - (plain.high - plain.p) ** 2
    assert more == pytest.approx(plain.restitution**2, rel=1e-6)
    assert (tally(drops_of(faces, restitutions=rng.random(count)), rows, 2).restitution < 0.012).all()


def launched(preset, count, rng):
    states = sample(PRESETS[preset], BOX, count, rng).states.copy()
    turns = Rotation.from_quat(states[:, [7, 8, 9, 6]])
    return states, turns, turns.apply(states[:, 10:])


def assert_all_round(angle, *orders):
    """No direction is preferred, nor a pair of opposite ones where order 2 is asked for."""
    for order in orders:
        assert np.abs([np.cos(order * angle).mean(), np.sin(order * angle).mean()]).max() < 0.03


def test_every_drop_starts_at_its_fall_within_the_ranges(rng):
    launch = PRESETS["roll"]
    starts = sample(launch, BOX, 500, rng)
    turns = Rotation.from_quat(starts.states[:, [7, 8, 9, 6]])
    fall = starts.states[:, 2] + [turn.apply(BOX.solid.vertices.copy())[:, 2].min() for turn in turns]
    speed, spin = np.hypot(*starts.states[:, 3:5].T), np.linalg.norm(starts.states[:, 10:], axis=1)
    ranges = (launch.fall, launch.speed, launch.spin, launch.friction)
    for values, (low, high) in zip((fall, speed, spin, starts.frictions), ranges):
        tenth = 0.1 * (high - low)
        assert low <= values.min() < low + tenth and high - tenth < values.max() <= high
    # Attitudes and spins that are drawn.
    states, _, spin = launched("roll", 2000, rng)
    assert np.abs(spin[:, 2]).max() < 1e-12 and np.linalg.norm(spin, axis=1).min() > 0.9
    size = np.linalg.norm(spin[:, :2], axis=1) * np.linalg.norm(states[:, 3:5], axis=1)
    assert np.abs(((spin[:, :2] * states[:, 3:5]).sum(axis=1) / size).mean()) < 0.06
    down = launched("drop", 20000, rng)[1].inv().apply([0.0, 0.0, 1.0]).T
    assert np.abs(down.mean(axis=1)).max() < 0.02
    assert down @ down.T / 20000 == pytest.approx(np.eye(3) / 3.0, abs=0.01)


def test_a_flip_is_held_level_to_its_lean_and_alike_all_round(rng):
    """An axis that points anywhere stands as often as it lies: no thumb flips so."""
    states, turns, spin = launched("flip", 20000, rng)
    size = np.linalg.norm(spin, axis=1)
    assert size.min() >= 6.0 and size.max() <= 14.0
    rise = np.abs(np.arcsin(spin[:, 2] / size))
    assert rise.max() <= FLIP_LEAN_RAD
    assert np.quantile(rise, 0.5) == pytest.approx(FLIP_LEAN_RAD / 2, rel=0.03)
    assert_all_round(np.arctan2(spin[:, 1], spin[:, 0]), 1, 2)
    assert_all_round(np.arctan2(states[:, 11], states[:, 10]), 1, 2)  # in the plane of the greatest face
    flat, side = turns.apply(BOX.flat.copy()), np.cross(spin / size[:, None], [0.0, 0.0, 1.0])
    assert_all_round(np.arctan2((flat * side).sum(axis=1), flat[:, 2]), 1)


def test_thick_coins_flipped_by_hand():
    """0.41 of them on edge; with an axis that points anywhere they were 0.32."""
    part = shapes.part(shapes.cylinder(10.0, 20.0 * 0.577, 96))
    aspects = find(part)
    answer = drop_test.test(part, aspects, "flip", NOTHING, drops=4000, run=RunSettings(5))
    edge = answer.tally.p[np.abs(aspects.heights - 0.01) < 1e-4].sum()
    assert edge == pytest.approx(0.41, abs=0.03)


@pytest.mark.parametrize("value, half", [(0.0, 0.0), (0.5, 0.1386), (0.95, 0.05), (1.0, 0.0)])
def test_one_value_of_restitution_becomes_a_range_of_the_deviation_of_impacts(value, half):
    scattered = PRESETS["feed"].but(restitution=(value, value)).scattering().restitution
    assert scattered == pytest.approx((value - half, value + half), abs=1e-4)
    assert PRESETS["feed"].scattering() == PRESETS["feed"]


def test_names_and_own_conditions_of_a_launch():
    assert named("tumble") is PRESETS["roll"]  # its former name
    with pytest.raises(ArgumentError, match="launch: is 'kick'"):
        named("kick")
    launch = launch_conditions.launch_of("feed", 0.01, NOTHING | {"fall": "20 mm", "friction": "0.2:0.3"})
    assert launch.name == "own" and launch.fall == pytest.approx((2.0, 2.0))
    assert launch.friction == (0.2, 0.3) and launch.spin == PRESETS["feed"].spin
    values = launch_conditions.described(launch, 0.01)
    assert values["height_mm"] == pytest.approx([20.0, 20.0]) and values["friction"] == [0.2, 0.3]
    assert launch_conditions.launch_of("drop", 0.01, NOTHING) == PRESETS["drop"]


@pytest.mark.parametrize(
    ("key", "text", "line"),
    [
        ("fall", "20", "'20' has no unit - write 20 mm"),
        ("friction", "0.5:0.2",
         "'0.5:0.2' is not a range - give one value, or the smaller and the larger as a:b"),
        ("fall", "20 m", f"'20 m' {OUT} 0 mm to 10000 mm for this part"),
        ("spin", "1e5 rad/s", f"'1e5 rad/s' {OUT} 0 rad/s to 3130 rad/s for this part"),
        ("restitution", "1.5", f"'1.5' {OUT} 0 to 1"),
    ],
)  # fmt: skip
def test_conditions_that_are_none(key, text, line):
    with pytest.raises(ConfigError) as fault:
        launch_conditions.launch_of("feed", 0.01, NOTHING | {key: text})
    assert str(fault.value) == f"{key}: {line}"
