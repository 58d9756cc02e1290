"""The dynamic bowl test: its statistics in closed form, and what it must say of parts on a plate."""

from dataclasses import replace

import drop_bodies
import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.dropping import plate_test
from feederscrew.dropping.launch_conditions import PRESETS, sample
from feederscrew.dropping.plate_test import lasting, limit_of, occupancy, ride
from feederscrew.resting.aspects import find

BOX, _ = drop_bodies.box((1.0, 1.3, 1.7))
ROWS = np.array([0, 0, 1, 1])  # two classes of two faces


def counted(faces, places=None, period=0.5, count=2):
    faces = np.array(faces)
    places = np.zeros(faces.shape) if places is None else np.array(places, float)
    return occupancy(faces, places, ROWS, count, period, np.random.default_rng(1))


def test_a_part_between_two_faces_still_counts_for_the_one_it_lay_on():
    faces = np.array([[-1, 2, -1, -1, 3, -1], [0, -1, 1, 1, -1, 0]])
    assert lasting(faces).tolist() == [[-1, 2, 2, 2, 3, 3], [0, 0, 1, 1, 1, 0]]


def test_every_transition_is_counted_once():
    found = counted([[0, 2, -1, 2, 3, 0, 0, 0], [-1, 1, 1, -1, 0, 2, 2, 2]])
    assert found.counts.tolist() == [[1, 2], [1, 1]]  # 1 -> 0 and 2 -> 3 stay within their class
    assert found.times.tolist() == [0.5 * 7, 0.5 * 6]  # the last look spends nothing
    assert found.rates == pytest.approx(found.counts / found.times[:, None])


def test_the_limit_of_two_classes_is_the_ratio_of_their_rates():
    rates = np.array([[5.0, 0.3], [1.7, 0.0]])  # flips onto an equal face change nothing
    for start in ([1.0, 0.0], [0.2, 0.8]):
        assert limit_of(rates, np.array(start)) == pytest.approx([1.7 / 2.0, 0.3 / 2.0])


def test_the_limit_keeps_what_cannot_leave_and_empties_what_can():
    rates = np.zeros((4, 4))
    rates[0, 1], rates[0, 2] = 1e-4, 3e-4  # 0 leaves to 1 and 2; 3 is apart
    assert limit_of(rates, np.array([0.4, 0.1, 0.0, 0.5])) == pytest.approx([0.0, 0.2, 0.3, 0.5])
    assert limit_of(np.zeros((2, 2)), np.array([0.4, 0.6])) == pytest.approx([0.4, 0.6])


def chain(rates, parts, looks, period, rng):
    """Looks at a Markov chain of two classes with known rates."""
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
        found = occupancy(faces, np.zeros(faces.shape), ROWS, 2, 0.1, rng)
        inside.append(found.rates_low[0, 1] <= 0.02 <= found.rates_high[0, 1])
        inside.append(found.limit_low[1] <= 2 / 7 <= found.limit_high[1])
        inside.append(found.plate_low[1] <= 2 / 7 <= found.plate_high[1])
    assert np.mean(inside) > 0.88


def test_a_class_nothing_was_seen_to_leave_is_not_called_final():
    """Ten leave the one class and none the other: it may still lose some, and the interval says so."""
    faces = np.zeros((40, 100), int)
    faces[20:] = 2
    faces[:10, 50:] = 2
    found = counted(faces)
    assert found.counts.tolist() == [[0, 10], [0, 0]]
    assert found.limit[1] > 0.8 and found.limit_low[1] < 0.9
    assert np.isnan(counted(np.zeros((4, 30), int)).limit).all()


def test_a_share_that_still_changes_is_marked_and_a_steady_one_is_not():
    drained = np.where(np.arange(80) < np.linspace(5, 79, 200)[:, None], 0, 2)
    assert counted(drained).changing.all()
    steady = chain((0.5, 0.5), 200, 80, 0.5, np.random.default_rng(2))
    assert not counted(steady).changing.any()


def test_velocities_are_ways_over_times():
    faces = np.zeros((6, 21), int)
    faces[3:] = 2
    places = np.outer([1.0, 1.0, 1.0, 3.0, 3.0, 3.0], np.arange(21) * 0.5)  # 1 and 3 m/s
    found = counted(faces, places)
    assert found.velocities[:, 0] == pytest.approx([1.0, 3.0])
    assert found.velocities[:, 1:] == pytest.approx(np.array([[1.0, 1.0], [3.0, 3.0]]))
    assert found.velocity[0] == pytest.approx(2.0) and found.velocity[1] < 2.0 < found.velocity[2]
    assert np.isnan(counted(np.zeros((2, 9), int)).velocities[1]).all()


def bowl(*own):
    return bowls.record(bowls.settings(path=None, overrides=own))


def followed(seconds):
    """How plates are told to follow their parts."""
    return replace(plate_test.EXACT_PACE, seconds=seconds)


def shaken(part, *bowl_list, preset="drop", seconds=1.0, **more):
    given = dict.fromkeys(("fall", "spin", "speed", "restitution", "friction"))
    more = {"drops": 40} | more
    return plate_test.test(part, find(part), bowl_list, preset, given, pace=followed(seconds), **more)


def test_the_outcome_does_not_depend_on_the_jobs():
    floor = plate_test.floor_of(bowl("drive.amplitude=0.5 mm"), 0.01)
    starts = sample(PRESETS["drop"], BOX, 25, np.random.default_rng(1))
    looks = np.arange(30.0, 60.0)
    one, two = (ride(BOX, floor, starts, looks, plate_test.steps_of(floor), jobs=jobs) for jobs in (1, 2))
    assert (one.faces == two.faces).all() and (one.places == two.places).all() and one.lost == 0


def test_a_gentle_plate_leaves_parts_where_they_fell_and_a_violent_one_does_not():
    """Aspects shift once a hop is as high as a barrier: small parts on a strong drive."""
    part = shapes.part(shapes.box(3.0, 3.0, 5.0))
    gentle, violent = "drive.amplitude=0.05 mm", "drive.amplitude=0.6 mm"
    still, strong = shaken(part, bowl(gentle), bowl(violent), preset="place", drops=24, seconds=0.5)
    assert still.throw_number < 1.0 < 2.5 < strong.throw_number
    assert still.occupancy.counts.sum() == 0
    assert np.isnan(still.occupancy.limit).all()
    tall = np.argmax(find(part).heights)
    assert strong.occupancy.plate[tall] < still.occupancy.plate[tall]


def test_the_plate_is_the_bowls_and_the_surface_too_unless_given():
    part = shapes.part(shapes.box(6.0, 7.0, 8.0))
    own = dict.fromkeys(("fall", "spin", "speed", "restitution", "friction"))
    slippery = [bowl("friction.static=0.05", "drive.amplitude=0.2 mm")]
    rough = [bowl("friction.static=0.8", "drive.amplitude=0.2 mm")]
    given = {"drops": 10, "pace": followed(0.5)}
    speeds = [
        plate_test.test(part, find(part), bowls_of, "place", texts, **given)[0].occupancy.velocity[0]
        for bowls_of, texts in ((slippery, own), (rough, own), (slippery, own | {"friction": "0.8"}))
    ]
    assert speeds[0] < 0.5 * speeds[1] and speeds[1] == pytest.approx(speeds[2])


def test_the_throw_number_of_a_plate():
    given = bowl("drive.amplitude=0.3 mm", "drive.frequency=60 Hz", "drive.vibration_angle=30 deg")
    assert plate_test.throw_number(given) == pytest.approx(0.3e-3 * (120 * np.pi) ** 2 * 0.5 / 9.81)


def test_the_start_is_what_each_part_lay_on_first():
    found = counted([[-1, -1, 2, 0, 0, 0, 0, 0], [0, 2, 2, 2, 2, 2, 2, 2], [-1] * 8, [1] * 8])
    assert found.start == pytest.approx([0.5, 0.25])


def test_nothing_leads_to_a_class_that_no_part_was_ever_on():
    """How it would be left is not known: it must not swallow the others."""
    rng = np.random.default_rng(1)
    faces = chain((2.0, 1.0), 200, 60, 0.1, rng)  # classes 0 and 2
    found = occupancy(faces, np.zeros(faces.shape), np.arange(3), 3, 0.1, rng)
    assert np.isnan([found.limit[1], found.limit_low[1], found.limit_high[1]]).all()
    assert found.limit[[0, 2]].sum() == pytest.approx(1.0)
    assert found.limit_low[2] <= 2 / 3 <= found.limit_high[2] < 0.8


def test_the_throw_number_counts_the_second_harmonic():
    """Its acceleration is sin x + 4 r sin(2 x + psi): 1 + 4 r at x = 90 deg for psi = -90 deg."""
    own = ("drive.second_harmonic=0.2", "drive.second_harmonic_phase=-90 deg")
    assert plate_test.throw_number(bowl(*own)) == pytest.approx(1.8 * plate_test.throw_number(bowl()))


def test_a_launch_keeps_its_speed_whatever_the_gravity():
    """Without friction nothing stops a part along the plate: it goes on as fast as it came."""
    part = shapes.part(shapes.box(12.0, 12.0, 3.0))
    own = dict.fromkeys(("fall", "spin", "restitution")) | {"speed": "0.1 m/s", "friction": "0"}
    plates = [bowl("drive.amplitude=0 mm", f"gravity={gravity} m/s2") for gravity in (9.81, 1.0)]
    earth, moon = plate_test.test(part, find(part), plates, "place", own, drops=16, pace=followed(0.2))
    assert earth.launch["speed_mm_s"] == moon.launch["speed_mm_s"] == pytest.approx([100.0, 100.0])
    assert abs(earth.occupancy.velocity[0]) > 1e-3  # not all ways cancel
    assert moon.occupancy.velocity[0] == pytest.approx(earth.occupancy.velocity[0], rel=1e-3)
