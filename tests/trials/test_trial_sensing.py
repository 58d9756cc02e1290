"""What a sensor sees differ is blown off in the trial as the static rule says; jets by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from block_rides import ASPECTS, LENGTH, PART, SOLID, laid, ridden, still

from feederscrew import bowl as bowls
from feederscrew.arrivals.kernel import body
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.devices.pneumatics import Nozzles, thrust
from feederscrew.sorting.orientations import add_travel, orientations, travel_speed
from feederscrew.sorting.verdicts import verdict
from feederscrew.trials import course, queue, runs, staging
from feederscrew.trials.kernel import jets
from feederscrew.trials.queue import queue_of
from feederscrew.trials.supply import QueuePlan

BOWL = bowls.read(None, ["track.width=40 mm"])
EVERY = add_travel(orientations(PART, ASPECTS, BOWL.track), BOWL)
ALONG = next(one for one in EVERY if one.length > 0.0199 and one.height < 0.0051)
SORTER = make_device("vision reject", "here", like=(ALONG.aspect, ALONG.heading, 5e-4))
SORTING = replace(BOWL, devices=(SORTER,))


def test_the_trial_blows_off_what_a_sorter_sees_differ():
    seen = course.course(PART, BOWL, EVERY, course.SentParts(range(len(EVERY)), len(EVERY)), [SORTER])
    for k, fate in zip(seen.entry_rows, seen.fates):
        said = verdict(SORTER, EVERY[k], EVERY)
        tall = EVERY[k].length < 0.0051  # has turned half way round by then: the jet spins it along the track
        others = (course.RETURNED, course.TURNED) if tall else (course.RETURNED,)
        assert said.sure and fate in ((course.PASSED,) if said.passes else others), EVERY[k].name


def test_a_steady_jet_and_a_steeper_way_do_in_the_trial_what_they_say():
    chain = [make_device("spacing section", "here", angle=np.radians(-6.0))]
    chain += [make_device("air jet", "here", nozzle=2e-3, pressure=5e4, height=8e-3)]
    tall = next(k for k, one in enumerate(EVERY) if one.length > 0.0119 and one.height > 0.0199)
    seen = course.course(PART, BOWL, EVERY, course.SentParts([EVERY.index(ALONG), tall], 2), chain)
    assert seen.fates.tolist() == [course.PASSED, course.RETURNED] and seen.end_stations[1] == 2
    steep = replace(BOWL, track=replace(BOWL.track, climb=np.radians(-6.0)))
    assert seen.velocities[0] == pytest.approx(travel_speed(steep), rel=0.03)  # from the entry on


def test_what_a_jet_does_on_a_part_that_tumbles_is_paid_for():
    jet = make_device("air jet", "here", nozzle=2e-3, pressure=5e4, height=8e-3)
    station = staging.stage_device(jet, BOWL.track, EVERY)
    state = laid(PART, ALONG, BOWL, place=station.begin, aside=3e-3)
    state[body.Z] += 20e-3 / LENGTH
    state[body.VX], state[body.W : body.W + 3] = 2.0, (20.0, 33.0, 27.0)
    _, ride = ridden(PART, still(BOWL), state, 0.5, station, places=9, interval=0.1)
    assert 0.0 < ride.gains[0] < 1e-6


def parts_on(bowl, count=1):
    line = queue.lay_out_track(bowl, EVERY, bowl.devices, 0.1)
    return line, queue.PartsOnTrack(runs.setting(SOLID, LENGTH, bowl), line, count)


def test_a_queue_blows_off_what_differs_and_what_cannot_be_told_from_its_neighbour():
    shares = np.array([float(one is ALONG) for one in EVERY])
    alone = queue_of(PART, SORTING, ASPECTS, EVERY, EVERY, shares, QueuePlan(1, 5.0), RunSettings(1))
    assert alone.leaving_counts.sum() and not alone.returned and alone.velocity > 0.0
    _, parts = parts_on(SORTING, 3)
    for n, place in enumerate((0.0, 0.0200001, 0.05)):
        parts.lay(n, np.array([place / LENGTH, 0.0, 0.0, *np.zeros(3), 1.0, *np.zeros(6)]))
    assert parts.parts_near(0, range(3), 1e-4) == [1] and parts.parts_near(2, range(3), 1e-4) == []


def test_the_thrust_is_that_of_isentropic_flow_on_the_share_that_the_outline_takes():
    area = 0.25 * np.pi * 4e-6
    assert thrust(2e-3, 3e5) == pytest.approx(1.268 * 401325.0 * area - 101325.0 * area, rel=2e-4)
    critical = 101325.0 * (1.2**3.5 - 1.0)
    assert thrust(2e-3, critical * (1 - 1e-9)) == pytest.approx(thrust(2e-3, critical * (1 + 1e-9)))
    assert thrust(2e-3, 100.0) == pytest.approx(2.0 * 100.0 * area, rel=1e-3)  # twice the small difference
    # a jet at the edge of a block, half on it, against the area of the disc
    for height, share in ((2.5e-3, 1.0), (5e-3, 0.5), (9e-3, 0.0)):
        nozzles = Nozzles(2e-3, 3e5, height)
        out, down = nozzles.push(ALONG, EVERY)
        assert out / nozzles.thrust == pytest.approx(share, abs=0.04) and down == pytest.approx(0.0, abs=1e-9)
    points = np.array([jets.ray(k) for k in range(jets.RAYS)])
    assert np.hypot(*points.T).max() < 1.0 and np.abs(points.mean(axis=0)).max() < 0.03
    assert (points**2).sum(axis=1).mean() == pytest.approx(0.5, abs=0.01)  # of a disc


def test_the_lean_of_the_track_changes_where_a_slope_begins_and_pulses_blow_for_both():
    flat = staging.tabulate_leans((), 0.02, 0.0, 0.01, 1.0)
    assert flat.shape == (1, 8) and flat[0, 1] == pytest.approx(-np.sin(0.02))
    changes = staging.PlacedSlope(0.1, climb=-0.05), staging.PlacedSlope(0.2, bank=0.1)
    rows = staging.tabulate_leans(changes, 0.02, 0.0, 0.01, 0.5)
    # each angle is linear over half of the part's size, and stays as it is between
    corners = [0.2, 0.205, 0.4, 0.405]
    assert {0.2, 0.4} <= {*rows[:, 0]} and rows[-1, 0] == pytest.approx(0.405)
    assert -np.arcsin(rows[:, 1]) == pytest.approx(
        np.interp(rows[:, 0], corners, [0.02, -0.05, -0.05, -0.05])
    )
    tilts = np.arctan2(rows[:, 4], rows[:, 5])
    assert tilts == pytest.approx(np.interp(rows[:, 0], corners, [0.0, 0.0, 0.0, 0.1]))
    assert rows[-1, 4:] == pytest.approx([np.sin(0.1), np.cos(0.1)] * 2)
    pulses = staging.Pulses()
    assert pulses.next(0.0) == (np.inf, np.inf)
    pulses.set_off(2.0, 1.0)
    pulses.set_off(1.0, 0.5)  # sensed later, there sooner
    assert pulses.next(0.5) == (1.0, 1.5)
    assert pulses.next(1.2) == (1.0, 1.5)  # goes on
    assert pulses.next(1.6) == (2.0, 3.0)
    pulses.set_off(2.5, 1.0)
    assert pulses.next(1.6) == (2.0, 3.5)  # one that begins within another makes it longer
    assert pulses.next(3.5) == (np.inf, np.inf)


def test_what_flies_past_the_outlet_on_its_way_off_the_track_has_not_left():
    _, parts = parts_on(BOWL)
    state = laid(PART, ALONG, BOWL, place=0.05)
    parts.lay(0, state)
    assert not parts.slides_off(0)
    out = (40e-3 - 6e-3) / LENGTH  # to the free edge
    just = np.sqrt(2.0 * BOWL.friction.kinetic * out)  # friction stops it there
    turn = 0.05 / BOWL.track.radius  # the track's direction has turned by that
    for share, off in ((0.95, False), (1.05, True)):
        state[body.VX : body.VX + 2] = share * just * np.array([-np.sin(turn), np.cos(turn)])
        parts.lay(0, state)
        assert parts.slides_off(0) == off


def test_a_part_that_is_held_up_as_it_is_seen_is_blown_at_by_its_mean_speed():
    line, parts = parts_on(SORTING)
    (watch,) = line.stage.air.watches
    across = next(one for one in EVERY if one.length < 0.0121 and one.height < 0.0051)
    parts.lay(0, laid(PART, across, BOWL, place=watch.place))
    place, moved = np.array([watch.place / LENGTH]), 2e-3 / LENGTH
    for step in range(3, 0, -1):  # three periods of 2 mm, then one of 0.2 mm past the sensor
        parts.watch([0], place - (step + 0.05) * moved, place - (step - 0.95) * moved, 10 - step)
    parts.watch([0], place - 0.05 * moved, place + 0.05 * moved, 10)
    mean = 3.1 * moved / (4 * parts.period)
    left = watch.nozzles / LENGTH - (place[0] + 0.05 * moved)
    assert parts.surface.jets.begin[watch.jets] == pytest.approx(10 * parts.period + left / mean)


def test_a_part_that_rocks_at_a_sensor_is_seen_once_and_its_pulse_is_none_of_the_past():
    """Three periods of 2 mm back, then 0.2 mm past the sensor: its mean speed is below 0."""
    line, parts = parts_on(SORTING)
    (watch,) = line.stage.air.watches
    across = next(one for one in EVERY if one.length < 0.0121 and one.height < 0.0051)
    parts.lay(0, laid(PART, across, BOWL, place=watch.place))
    place, moved = np.array([watch.place / LENGTH]), 2e-3 / LENGTH
    for step in range(3):
        parts.watch([0], place + (2.9 - step) * moved, place + (1.9 - step) * moved, 10 + step)
    parts.watch([0], place - 0.05 * moved, place + 0.05 * moved, 14)
    left = watch.nozzles / LENGTH - (place[0] + 0.05 * moved)
    ((begin, _),) = parts.pulses[0].log
    assert begin == pytest.approx(14 * parts.period + left / (0.1 * moved / parts.period))
    for turn in range(15, 25):  # it rocks
        ends = place + 0.05 * moved, place - 0.05 * moved
        parts.watch([0], *(ends if turn % 2 else ends[::-1]), turn)
    assert len(parts.pulses[0].log) == 1
    # half a part's length back it comes anew
    parts.watch([0], place, place - 0.6, 30)
    parts.watch([0], place - 0.6, place + 0.01, 31)
    assert len(parts.pulses[0].log) == 2
