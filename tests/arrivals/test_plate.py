"""The dynamic bowl test: statistics in closed form, parts on a plate, and what a bowl's floor delivers."""

from dataclasses import replace
from types import SimpleNamespace

import drop_bodies
import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.arrivals import arrival, entry, plate_test
from feederscrew.arrivals.entry import shares
from feederscrew.arrivals.kernel import falling, floor_motion
from feederscrew.arrivals.launch_conditions import PRESETS, sample
from feederscrew.arrivals.plate_test import lasting, limit_of, occupancy, ride
from feederscrew.base.errors import FeederError
from feederscrew.resting.aspects import find

BOX, _ = drop_bodies.box((1.0, 1.3, 1.7))
ROWS = np.array([0, 0, 1, 1])  # two classes of two faces
LEAVING = np.zeros((4, 4))
LEAVING[0, 1:3] = 1e-4, 3e-4  # 0 leaves to 1 and 2; no way leads to 3 or from it
FLIPPING = np.array([[5.0, 0.3], [1.7, 0.0]])  # flips onto an equal face change nothing
MOTIONS = floor_motion.place, floor_motion.speed
OWN = dict.fromkeys(("fall", "spin", "speed", "restitution", "friction"))


def counted(faces, places=None, period=0.5):
    faces = np.array(faces)
    places = np.zeros(faces.shape) if places is None else np.array(places, float)
    return occupancy(faces, places, ROWS, 2, period, np.random.default_rng(1))


def test_counts_of_looks():
    faces = np.array([[-1, 2, -1, -1, 3, -1], [0, -1, 1, 1, -1, 0]])
    # A part between two faces still counts for the one it lay on.
    assert lasting(faces).tolist() == [[-1, 2, 2, 2, 3, 3], [0, 0, 1, 1, 1, 0]]
    seen = counted([[0, 2, -1, 2, 3, 0, 0, 0], [-1, 1, 1, -1, 0, 2, 2, 2]])
    assert seen.counts.tolist() == [[1, 2], [1, 1]]  # 1 -> 0 and 2 -> 3 stay within their class
    assert seen.times.tolist() == [0.5 * 7, 0.5 * 6]  # the last look spends nothing
    assert seen.rates == pytest.approx(seen.counts / seen.times[:, None])
    # The start is what each part lay on first.
    seen = counted([[-1, -1, 2, 0, 0, 0, 0, 0], [0, 2, 2, 2, 2, 2, 2, 2], [-1] * 8, [1] * 8])
    assert seen.start == pytest.approx([0.5, 0.25])


@pytest.mark.parametrize(
    ("rates", "start", "limit"),
    [
        (FLIPPING, [1.0, 0.0], [1.7 / 2.0, 0.3 / 2.0]),  # the ratio of the rates
        (FLIPPING, [0.2, 0.8], [1.7 / 2.0, 0.3 / 2.0]),
        (LEAVING, [0.4, 0.1, 0.0, 0.5], [0.0, 0.2, 0.3, 0.5]),  # keeps what cannot leave, empties what can
        (np.zeros((2, 2)), [0.4, 0.6], [0.4, 0.6]),
    ],
)
def test_the_limit_of_rates(rates, start, limit):
    assert limit_of(rates, np.array(start)) == pytest.approx(limit)


def chain(rates, parts, looks, period, rng):
    up, down = rates
    total = up + down
    stay = np.exp(-total * period)
    state = rng.random(parts) < up / total
    seen = np.empty((parts, looks), int)
    for k in range(looks):
        seen[:, k] = 2 * state
        high = np.where(state, up / total + down / total * stay, up / total * (1.0 - stay))
        state = rng.random(parts) < high
    return seen


def test_intervals_hold_the_rates_and_the_limit_of_a_known_chain():
    inside = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        faces = chain((0.02, 0.05), 80, 200, 0.1, rng)
        seen = occupancy(faces, np.zeros(faces.shape), ROWS, 2, 0.1, rng)
        inside.append(seen.rates_low[0, 1] <= 0.02 <= seen.rates_high[0, 1])
        inside.append(seen.limit_low[1] <= 2 / 7 <= seen.limit_high[1])
        inside.append(seen.plate_low[1] <= 2 / 7 <= seen.plate_high[1])
    assert np.mean(inside) > 0.88


def test_classes_that_nothing_left_or_that_nothing_was_on():
    """Ten leave the one class and none the other: it may still lose some, and the interval says so."""
    faces = np.zeros((40, 100), int)
    faces[20:] = 2
    faces[:10, 50:] = 2
    seen = counted(faces)
    assert seen.counts.tolist() == [[0, 10], [0, 0]]
    assert seen.limit[1] > 0.8 and seen.limit_low[1] < 0.9
    assert np.isnan(counted(np.zeros((4, 30), int)).limit).all()
    # How it would be left is not known: it must not swallow the others.
    rng = np.random.default_rng(1)
    faces = chain((2.0, 1.0), 200, 60, 0.1, rng)  # classes 0 and 2
    seen = occupancy(faces, np.zeros(faces.shape), np.arange(3), 3, 0.1, rng)
    assert np.isnan([seen.limit[1], seen.limit_low[1], seen.limit_high[1]]).all()
    assert seen.limit[[0, 2]].sum() == pytest.approx(1.0)
    assert seen.limit_low[2] <= 2 / 3 <= seen.limit_high[2] < 0.8
    # Shares that change, and velocities.
    assert counted(np.where(np.arange(80) < np.linspace(5, 79, 200)[:, None], 0, 2)).changing.all()
    assert not counted(chain((0.5, 0.5), 200, 80, 0.5, np.random.default_rng(2))).changing.any()
    faces, speeds = np.zeros((6, 21), int), np.repeat([1.0, 3.0], 3)  # [m/s]
    faces[3:] = 2
    seen = counted(faces, np.outer(speeds, np.arange(21) * 0.5))
    assert seen.velocities[:, 0] == pytest.approx([1.0, 3.0])
    assert seen.velocities[:, 1:] == pytest.approx(np.array([[1.0, 1.0], [3.0, 3.0]]))
    assert seen.velocity[0] == pytest.approx(2.0) and seen.velocity[1] < 2.0 < seen.velocity[2]
    assert np.isnan(counted(np.zeros((2, 9), int)).velocities[1]).all()


def bowl(*own):
    return bowls.record(bowls.settings(path=None, overrides=own))


def plate(amplitude, *more):
    return bowl(f"drive.amplitude={amplitude} mm", *more)


def pace(seconds):
    return replace(plate_test.EXACT_PACE, seconds=seconds)


def test_the_outcome_does_not_depend_on_the_jobs():
    floor = plate_test.floor_of(plate(0.5), 0.01)
    starts, looks = sample(PRESETS["drop"], BOX, 25, np.random.default_rng(1)), np.arange(30.0, 60.0)
    one, two = (ride(BOX, floor, starts, looks, plate_test.steps_of(floor), jobs=jobs) for jobs in (1, 2))
    assert (one.faces == two.faces).all() and (one.places == two.places).all() and one.lost == 0


def test_a_gentle_plate_leaves_parts_where_they_fell_and_a_violent_one_does_not():
    """Aspects shift once a hop is as high as a barrier: small parts on a strong drive."""
    part = shapes.part(shapes.box(3.0, 3.0, 5.0))
    aspects, plates = find(part), [plate(0.05), plate(0.6)]
    still, strong = plate_test.test(part, aspects, plates, "place", OWN, drops=24, pace=pace(0.5))
    assert still.throw_number < 1.0 < 2.5 < strong.throw_number
    assert still.occupancy.counts.sum() == 0
    assert np.isnan(still.occupancy.limit).all()
    tall = np.argmax(aspects.heights)
    assert strong.occupancy.plate[tall] < still.occupancy.plate[tall]


def test_the_plate_is_the_bowls_and_the_surface_too_unless_given():
    part = shapes.part(shapes.box(6.0, 7.0, 8.0))
    slippery, rough = (plate(0.2, f"friction.static={friction}") for friction in (0.05, 0.8))
    speeds, more = [], {"drops": 10, "pace": pace(0.5)}
    for own, texts in ((slippery, OWN), (rough, OWN), (slippery, OWN | {"friction": "0.8"})):
        (run,) = plate_test.test(part, find(part), [own], "place", texts, **more)
        speeds.append(run.occupancy.velocity[0])
    assert speeds[0] < 0.5 * speeds[1] and speeds[1] == pytest.approx(speeds[2])


def test_the_throw_number_of_a_plate():
    """With a second harmonic its acceleration is sin x + 4 r sin(2 x + psi): 1 + 4 r for psi = -90 deg."""
    plain = bowl("drive.amplitude=0.3 mm", "drive.frequency=60 Hz", "drive.vibration_angle=30 deg")
    assert plate_test.throw_number(plain) == pytest.approx(0.3e-3 * (120 * np.pi) ** 2 * 0.5 / 9.81)
    second = bowl("drive.second_harmonic=0.2", "drive.second_harmonic_phase=-90 deg")
    assert plate_test.throw_number(second) == pytest.approx(1.8 * plate_test.throw_number(bowl()))


def test_a_launch_keeps_its_speed_whatever_the_gravity():
    """Without friction nothing stops a part along the plate: it goes on as fast as it came."""
    part = shapes.part(shapes.box(12.0, 12.0, 3.0))
    own = OWN | {"speed": "0.1 m/s", "friction": "0"}
    plates = [plate(0, f"gravity={gravity} m/s2") for gravity in (9.81, 1.0)]
    earth, moon = plate_test.test(part, find(part), plates, "place", own, drops=16, pace=pace(0.2))
    assert earth.launch["speed_mm_s"] == moon.launch["speed_mm_s"] == pytest.approx([100.0, 100.0])
    assert abs(earth.occupancy.velocity[0]) > 1e-3  # not all ways cancel
    assert moon.occupancy.velocity[0] == pytest.approx(earth.occupancy.velocity[0], rel=1e-3)


@pytest.fixture(scope="module")
def box():
    part = shapes.part(shapes.box(8.0, 12.0, 15.0))
    return part, find(part)


@pytest.fixture(scope="module")
def gentle(box):
    return plate_test.test(*box, [plate(0.02)], "feed", {}, drops=30, pace=pace(0.5))[0]


def changed(run, **values):
    values = {name: np.asarray(value) for name, value in values.items()}
    return replace(run, occupancy=replace(run.occupancy, **values))


def test_floors_that_settle_the_shares_and_that_do_not(box, gentle):
    answer = arrival.arrival(*box, plate(0.02), drops=30)
    assert answer.settled and answer.reason == "" and answer.p.sum() == pytest.approx(1.0)
    assert (answer.low <= answer.p).all() and (answer.p <= answer.high).all()
    assert answer.shaken.seconds == pytest.approx(arrival.FLOOR_TIMES_S[0], rel=0.05)
    answer = arrival.judge(changed(gentle, changing=[True, False, False]))
    assert not answer.settled and answer.reason == arrival.MOVING_REMARK.format(gentle.seconds)
    answer = arrival.judge(changed(gentle, plate=[0.3, 0.2, 0.1]))  # parts lie on nothing
    assert not answer.settled and answer.p == pytest.approx([1 / 2, 1 / 3, 1 / 6])
    assert answer.reason == arrival.UNSEEN_REMARK.format(12, 30)
    answer = arrival.judge(changed(gentle, plate=[0.0, 0.0, 0.0]))
    assert np.isnan(answer.p).all() and answer.low.tolist() == [0.0] * 3


def test_rates_that_lead_elsewhere_are_undecided_and_in_the_interval(gentle):
    run = changed(
        gentle, start=[0.5, 0.3, 0.2], plate=[0.5, 0.3, 0.2], plate_low=[0.4, 0.2, 0.1],
        plate_high=[0.6, 0.4, 0.3], limit=[0.9, 0.1, 0.0], limit_low=[0.8, 0.05, 0.0],
        limit_high=[0.95, 0.15, 0.05], changing=[False] * 3, counts=[[0, 0, 0], [9, 0, 0], [0, 0, 0]],
    )  # fmt: skip
    answer = arrival.judge(run)
    assert not answer.settled and answer.low == pytest.approx([0.4, 0.05, 0.0])
    assert answer.high == pytest.approx([0.95, 0.4, 0.3])
    for near in ({"limit": [0.53, 0.28, 0.19]}, {"counts": np.zeros((3, 3), int)}):
        answer = arrival.judge(changed(run, **near))
        assert answer.settled and answer.low == pytest.approx([0.4, 0.2, 0.1])


def test_a_part_too_small_to_be_followed_on_its_floor_ends_at_once():
    """A file in a wrong unit, 30 nm long, took 50 times 300,000 steps for each of its parts."""
    part, own = shapes.part(shapes.box(3e-5, 2e-5, 1e-5)), bowls.read(None)
    answer = shares(part, own)
    assert not answer.fed
    assert answer.aspects.recommended.rule == answer.aspects.closed.rule
    assert answer.aspects.warnings[-1] == entry.TOO_LONG
    with pytest.raises(FeederError, match=r"a part so small takes .* steps at this drive for so long"):
        plate_test.test(part, answer.aspects, [own], "feed", {})


def test_on_a_floor_that_throws_parts_as_many_are_followed_as_the_share_needs(box, monkeypatch):
    """The cap at a throw number of 1.7: 800 parts at 82 % are known to 2.7 % only."""
    own, runs = plate(0.4), []

    def test(*_, drops, pace, **__):
        runs.append((drops, pace.seconds, pace.done))
        error = np.array([0.4, 0.4, 0.0]) / np.sqrt(drops)
        seen = SimpleNamespace(error=error, plate_low=np.full(3, 0.3), plate_high=np.full(3, 0.4))
        return [plate_test.PlateResult(own, {}, 1.7, drops, pace.seconds, seen, 0, False, rides="kept")]

    def judge(run):
        return arrival.Arrival(0, 0, 0, run.seconds == arrival.FLOOR_TIMES_S[1], "", run)

    for name, count in (("FIRST_PARTS", 400), ("LONGER_TIME_PARTS", 800), ("MAX_ARRIVALS", 4000)):
        monkeypatch.setattr(arrival, name, count)
    monkeypatch.setattr(plate_test, "test", test)
    monkeypatch.setattr(arrival, "judge", judge)
    arrival.arrival(*box, own)
    short, long = arrival.FLOOR_TIMES_S
    assert runs == [(400, short, None), (800, long, None), (1200, long, "kept")]
    assert 1.96 * 0.4 / np.sqrt(1200) <= arrival.ARRIVAL_HALF_WIDTH < 1.96 * 0.4 / np.sqrt(800)


def test_on_a_floor_that_throws_parts_that_lie_still_are_followed_no_further(box):
    """The same parts on the same faces as of those that are followed to the end, on a floor of throw 1.5."""
    own = plate(0.35)
    assert plate_test.throw_number(own) > 1.0
    thrown = replace(arrival.ARRIVAL_PACE, settling=arrival.THROWN_SETTLING, seconds=0.5, keep=True)
    more = {"drops": 60, "run": replace(plate_test.USUAL_RUN, seed=3)}
    stopped, whole, fine = (
        plate_test.test(*box, [own], "feed", {}, pace=pace, **more)[0].rides
        for pace in (thrown, replace(thrown, kick=np.inf), replace(thrown, coarse=1.0, flight=1.0))
    )
    assert (stopped.faces[:, -1] == whole.faces[:, -1]).mean() >= 0.98
    assert (stopped.faces[:, -1] == fine.faces[:, -1]).mean() >= 0.95  # steps in the air as short as on it
    # Of the looks at parts that rest: where they lie is noted without a step.
    assert (np.diff(stopped.places, axis=1) == 0.0).all(axis=2).mean() > 0.3


def test_no_step_in_the_air_passes_over_a_rise_of_the_floor():
    """Boxes let go flat near a floor of throw 10 land where the parabola does, drawn at 5,000 instants."""
    floor = plate_test.floor_of(plate(0.6, "drive.frequency=100 Hz"), 0.01, arrival.ARRIVAL_PACE.flight)
    steps, work = plate_test.steps_of(floor, arrival.ARRIVAL_PACE.coarse), falling.scratch(BOX)
    times, rng = np.linspace(0.0, 2.5, 5001), np.random.default_rng(1)
    for begin, gap, speed in rng.uniform([0.0, 0.02, -1.0], [2.0 * np.pi, 2.5, 2.0], (200, 3)):
        begin, gap, speed = begin / floor.rate, gap * floor.up, speed * floor.up * floor.rate
        high, driven = (motion(floor, floor.up, 0.0, floor.rate * begin) for motion in MOTIONS)
        path = gap + high + speed * times - 0.5 * times**2 - floor.up * np.sin(floor.rate * (begin + times))
        work.state[:] = [0.0] * 5 + [speed - driven, 1.0] + [0.0] * 6
        corner, level = falling.start(BOX.solid, work)
        work.state[2], time = gap - level, begin
        while gap > steps.tolerance:
            corner, gap, dt = falling.approach(BOX.solid, work, floor, time, corner, gap, steps)
            time += dt
        assert time - begin == pytest.approx(times[np.argmax(path < steps.tolerance)], abs=0.02)
