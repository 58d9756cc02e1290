"""What became of parts: each fate where mechanics leaves no other; what hangs between rails; parts in a V."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import awkward
import numpy as np
import pytest
import shapes
import trimesh
from block_rides import ALONG, ASPECTS, BOWL, EVERY, LENGTH, PART, SOLID, laid, lying, ridden, sent, still

from feederscrew import bowl as bowls
from feederscrew.arrivals.kernel import body
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.feeding import stream
from feederscrew.motion import conveying as answer
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.sorting.fates import at_entry
from feederscrew.sorting.orientations import Hanging, add_travel, orientations
from feederscrew.sorting.verdicts import DeviceEncounter
from feederscrew.trials import course, long_ride, part_poses, queue, runs, shape, staging
from feederscrew.trials.long_ride import LEFT, RideOfTrack

DEG = np.radians(1.0)
TURNED = [(0, 0), (2, 0), (2, 10), (4, 10), (4, 13), (0, 13)]
SCREW = shapes.part(trimesh.creation.revolve(TURNED, sections=32))
FED_RAILS = make_device("rails", "r", span=(2.25e-3, 6.65e-3), lead=(1e-3, 6.95e-3, 20e-3, 10e-3))
RAIL_BOWL = awkward.bowl("track.radius=0.15 m", "track.bank=6 deg")
DOWEL = load(Path(__file__).resolve().parents[2] / "parts" / "dowel_6x20.stl")
GROOVE_BOWL = bowls.read(None, ["friction.wall=0.9", "track.width=30 mm", "track.climb=0 deg"])
RIDE_BOWL = replace(BOWL, track=replace(BOWL.track, radius=0.15, width=0.04, bank=np.radians(5.0)))
RIDE_EVERY = orientations(PART, ASPECTS, RIDE_BOWL.track)


def test_a_pin_across_a_climb_rolls_back_as_a_solid_cylinder_does():
    """From rest at 2/3 of g sin(climb): over the second half of its time at 3/4 of the speed it ends with."""
    pin, climb = shapes.part(shapes.cylinder(4.0, 10.0, 48)), np.radians(0.2)
    bowl = replace(still(climb=climb), drive=replace(BOWL.drive, amplitude=1e-8))
    across = [k for k, one in enumerate(lying(pin, bowl)) if one.kind == "rolling" and one.width > 9.9e-3]
    seen = sent(pin, bowl, across[:1], 1)
    assert seen.fates[0] == course.ROLLED_BACK and seen.end_stations[0] == 0
    ride, rolls = seen.rides[0], 2.0 / 3.0 * bowl.gravity * np.sin(climb)
    assert ride.distances[0] == pytest.approx(-0.5 * rolls * ride.seconds[0] ** 2, rel=0.02)
    assert seen.velocities[0] == pytest.approx(-0.75 * rolls * ride.seconds[0], rel=0.05)


@pytest.mark.parametrize(("drop", "low", "fate"), [
    # [mm] of the track behind the station, and of the part's lowest point; the third lies on the lower track
    (0.0, -0.11, course.HANGING), (0.0, -0.09, course.STOPPED),
    (3.0, -3.0, course.STOPPED), (3.0, -3.11, course.HANGING),
])  # fmt: skip
def test_a_part_hangs_where_it_reaches_below_the_track_it_has_come_to(drop, low, fate):
    corners = np.array([[-1.0, 0.0, -0.5], [1.0, 0.0, 0.5]])
    looks = SimpleNamespace(corners=corners, radius=100.0)
    state = np.zeros(body.STATE)
    state[:3], state[body.Q] = (2.0, 0.0, low / 4.0 + 0.5), 1.0  # of a unit of 4 mm
    for below, cut, outcome, expected in (
        (True, (3e-3, 9e-3), runs.RUNNING, fate),
        (False, (3e-3, 9e-3), runs.RUNNING, course.STOPPED),
        (False, (13e-3, 19e-3), runs.STANDS, course.STUCK),  # it reaches as far as 12 mm
    ):
        station = SimpleNamespace(leaves_hanging=below, drop=1e-3 * drop, cut=cut, middle=0.0)
        assert course.fate_at(station, outcome, state, looks, 4e-3) == expected


def test_a_blade_stops_a_part_at_its_own_place_and_behind_a_step_the_track_is_as_any():
    """The flat block along the wall past two devices; it goes over a gap behind a step."""
    gap = make_device("gap", "g", limit=2e-3)
    seen = sent(PART, BOWL, [ALONG], 1, (gap, make_device("wiper", "w", limit=4e-3)), seed=3)
    assert seen.fates[0] == course.STOPPED and seen.end_stations[0] == 2
    seen = sent(PART, BOWL, [ALONG], 1, (make_device("step", "s", limit=3e-3), gap), seed=3)
    assert seen.fates[0] == course.PASSED and seen.orientations[-1][0] == ALONG
    assert seen.depths[0] < 5e-5
    before, after = (ride.states[0][body.Z] * seen.length for ride in seen.rides[1:])
    assert before == pytest.approx(2.5e-3 - 3e-3, abs=5e-6)  # flat on the lower track, then on the next one
    assert after == pytest.approx(2.5e-3, abs=5e-6)


@pytest.mark.parametrize("way", [0.0, 0.11])
def test_what_went_down_a_banked_step_goes_on_as_far_from_the_wall(way):
    """A step of 5 mm at 8 deg: the wall there lies 0.7 mm further out. The unit of length is 4 mm."""
    lower, out = 5e-3 * np.cos(8.0 * DEG), 5e-3 * np.sin(8.0 * DEG)
    known, station = SimpleNamespace(length=4e-3, radius=37.5), SimpleNamespace(drop=lower, aside=out)
    states = np.zeros((2, body.STATE))
    angle = way / 0.15
    for state, off in zip(states, (9e-3, 2e-3)):
        reach = (0.15 - off + out) / 4e-3
        state[:3] = reach * np.sin(angle), 37.5 - reach * np.cos(angle), (2e-3 - lower) / 4e-3
        state[body.Q] = 1.0
    for state, off in zip(course.lead_on(states, station, 0.03, known), (9e-3, 2e-3)):
        x, y, z = 4e-3 * state[:3]
        assert 0.15 - np.hypot(x, 0.15 - y) == pytest.approx(off, abs=1e-9)
        assert 0.15 * np.arctan2(x, 0.15 - y) == pytest.approx(0.03, abs=1e-9)
        assert z == pytest.approx(2e-3, abs=1e-9)


def test_what_stays_on_a_ledge_comes_down_its_ramp_flat_on_the_lower_track():
    """A ledge a little wider than the block: it rides on it to its end, and down 10 mm at 15 deg."""
    ledge = make_device("tipping ledge", "t", limit=13e-3)
    drop = ledge.features(BOWL.track, EVERY).drop
    seen = sent(PART, BOWL, [ALONG], 1, (ledge,), seed=3)
    assert seen.fates[0] == course.PASSED and seen.orientations[-1][0] == ALONG
    height = seen.rides[1].states[0][body.Z] * seen.length
    assert drop.height == pytest.approx(10e-3, abs=1e-3)
    assert seen.depths[0] < 2e-4  # where its front edge meets the lower track at the ramp's foot
    assert height == pytest.approx(2.5e-3 - drop.height, abs=2e-5)


def test_a_jet_behind_a_step_blows_at_what_lies_on_the_lower_track():
    """All of it meets the side of the block, which it quickens by the thrust over the mass."""
    jet, bowl = make_device("air jet", "j", nozzle=2e-3, pressure=2e4, height=2.5e-3), still(climb=0.0)
    line = queue.lay_out_track(bowl, EVERY, (make_device("step", "s", limit=8e-3), jet), 0.1)
    known = replace(runs.setting(SOLID, LENGTH, bowl), friction=np.zeros(5))
    x, y, z = (line.stage.air.jets[f"mouth_{e}"][0] for e in "xyz")
    assert z == pytest.approx(2.5e-3 - 8e-3) and y < 1e-3
    parts = queue.PartsOnTrack(known, line, 1)
    state = laid(PART, EVERY[ALONG], bowl, place=x, aside=1e-3)
    state[body.Z] -= 8e-3 / LENGTH
    parts.lay(0, state)
    parts.ride(0)
    speed = parts.arrays.states[0, body.VY] * LENGTH / known.unit
    (one,) = jet.features(bowl.track, EVERY).jets
    assert speed == pytest.approx(one.thrust / PART.mass / BOWL.drive.frequency, rel=0.05)


def screws(device, parts=4):
    """Screws that come lengthwise to fed rails and a device over their heads."""
    chain = FED_RAILS, device
    return through(SCREW, RAIL_BOWL, chain, lambda k: k.height < 9e-3 and k.length > 0.012, parts)


def through(part, bowl, devices, which, parts):
    """The orientations of a part through devices, and what became of parts of some of them."""
    known = stream.follow_orientations(part, find(part), bowl.track, devices, bowl=bowl)
    rows = [k for k, one in enumerate(known.lying) if which(one)]
    own = {"poses": known.states, "may_leave": course.leaves_by_rule(known.leaving), "every": known.lying}
    return known, rows, sent(part, bowl, rows, parts, devices, seed=2, **own)


@pytest.mark.parametrize(("clearance", "passes"), [(5e-3, True), (2e-3, False)])
def test_a_hold_down_over_the_heads_does_as_its_rule_says(clearance, passes):
    hold_down = make_device("hold-down", "h", limit=clearance)
    known, rows, seen = screws(hold_down)
    hangs = [isinstance(one, Hanging) for one in known.states]
    assert known.leaving[rows].sum() == pytest.approx(len(rows) if passes else 0.0)
    if not passes:
        assert set(seen.fates) == {course.STOPPED} and set(seen.end_stations) == {2}
        return
    assert set(seen.fates) == {course.PASSED} and np.array(hangs)[seen.orientations[-1]].all()
    assert seen.depths.max() < 1e-4
    shares = np.isin(np.arange(len(known.lying)), rows) / len(rows)
    plan, here = queue.QueuePlan(2, 9.0), replace(RAIL_BOWL, devices=(FED_RAILS, hold_down))
    found = queue.queue_of(SCREW, here, find(SCREW), known.lying, known.states, shares, plan, RunSettings(2))
    assert found.jams == found.returned == 0 < found.leaving_counts.sum()
    assert found.leaving_counts[:-1][hangs].sum() == found.leaving_counts.sum()


def test_rails_hold_what_a_swept_wiper_would_clear():
    """The head stands 3 mm over the rails: a wiper at 2 mm stops it, and cannot sweep it off them."""
    known, rows, seen = screws(make_device("wiper", "w", limit=2e-3, sweep=0.5), 2)
    assert {known.fates[row] for row in rows} == {"stopped"} and set(seen.fates) == {course.STOPPED}


def test_a_t_nut_hangs_by_its_shoulders_in_rails_and_stops_in_a_slot():
    """Stem 5 mm wide and 6 mm deep, head 10 mm: between rails of 6.4 mm it goes down until the head rests."""
    nut, bowl, span = shapes.part(shapes.t_nut()), awkward.bowl("track.radius=0.15 m"), (2.2e-3, 8.6e-3)

    def stem_down(one):
        return abs(one.posture.axes[2][1] - 1.0) < 1e-6 and one.length > 0.015 and one.width < 0.011

    known, rows, seen = through(nut, bowl, (make_device("rails", "r", span=span),), stem_down, 2)
    assert len(rows) == 1 and seen.fates.tolist() == [course.PASSED] * 2
    (down,) = [one for one in known.states if isinstance(one, Hanging)]
    assert known.leaving[rows[0], known.states.index(down)] == 1.0
    assert down.height == pytest.approx(3e-3, abs=1e-9) and down.neck.shank == pytest.approx(5e-3, abs=1e-9)
    slot = make_device("slot", "s", span=span)
    meeting = DeviceEncounter(known.lying[rows[0]], known.lying)
    assert slot.judged(meeting).passes == 0.0 and slot.fate(meeting) == "stopped"
    assert set(through(nut, bowl, (slot,), stem_down, 2)[2].fates) == {course.STOPPED}


def in_groove(angle, radius=50.0, bowl=GROOVE_BOWL):
    """A bowl, the dowel's orientations in a groove, its state against the leaning wall, and how it rides."""
    bowl = replace(bowl, track=replace(bowl.track, radius=radius))
    chain = (make_device("V groove", "g", angle=angle * DEG),)
    every = at_entry(add_travel(orientations(DOWEL, find(DOWEL), bowl.track), bowl), chain)
    one = next(one for one in every if one.name == "A@0")
    solid, length, principal = shape.solid_of(DOWEL)
    solid = shape.round_circles(solid, course.roll_axes(every, principal))
    state = part_poses.pose_on_track(one, principal, length, one.track, place=0.0)
    state[body.Z] -= part_poses.lowest_height(solid.corners, state)
    state = part_poses.set_play(state, solid, one.track, length, 0.0, one.wall_leans)
    slopes = staging.slopes_before(staging.entry_slopes(chain, bowl.track, every))
    stage = staging.stage_bare_track(bowl.track, every, min(1.0, radius), slopes)

    def ride(seconds):
        return ridden(DOWEL, bowl, state, seconds, stage, solid=solid)

    return bowl, every, state, ride


@pytest.mark.parametrize("angle", [20.0, 45.0])
def test_both_faces_of_a_groove_brake_as_friction_over_the_cosine(angle):
    """The wall's own friction, 0.9, is not met: the leaning wall is made as the track."""
    *_, state, ride = in_groove(angle, bowl=still(GROOVE_BOWL))
    length = shape.solid_of(DOWEL)[1]
    assert state[1] * length == pytest.approx(3e-3 * np.tan(angle * DEG), rel=0.01)
    state[body.VX] = 0.8
    _, seen = ride(0.3)
    friction = GROOVE_BOWL.friction.kinetic / np.cos(angle * DEG)
    assert seen.distances[0] == pytest.approx(length * 0.5 * 0.64 / friction, rel=0.03)
    assert seen.depths[0] < 2e-5


def test_a_dowel_in_a_groove_comes_back_to_its_bottom_and_passes_it():
    """Up the inner face by 2 mm: it slides or rolls down to where both faces carry it."""
    *_, state, ride = in_groove(35.0, 0.15, still(GROOVE_BOWL))
    bottom = state[1]
    state[1] += 2e-3 / shape.solid_of(DOWEL)[1]
    known, seen = ride(0.5)
    end = seen.states[0]
    assert known.radius - np.hypot(end[0], known.radius - end[1]) == pytest.approx(bottom, abs=0.02)
    climbing = replace(GROOVE_BOWL, track=replace(GROOVE_BOWL.track, climb=3.0 * DEG))
    bowl, every, *_ = in_groove(30.0, 0.15, climbing)
    row = [k for k, one in enumerate(every) if one.name == "A@0"]
    chain = (
        make_device("V groove", "g", angle=30.0 * DEG),
        make_device("banked track", "b", angle=8.0 * DEG),
    )
    found = sent(DOWEL, bowl, row, 2, chain, every=every)
    assert list(found.fates) == [course.PASSED] * 2 and found.depths.max() < 5e-5


def test_a_queue_lies_in_the_groove_from_its_entry_and_its_wall_leans_from_stretch_to_stretch():
    bowl, every, *_ = in_groove(30.0, 0.15)
    chain = (
        make_device("V groove", "g", angle=30.0 * DEG),
        make_device("spacing section", "s", angle=-5.0 * DEG),
    )
    slopes = queue.lay_out_track(bowl, every, chain, 0.1).stage.air.slopes
    first = slopes[:2]
    assert [(slope.climb, slope.bank) for slope in first] == [(None, pytest.approx(30.0 * DEG)), (None, None)]
    assert all(place < -1.0 for place, *_ in first)
    assert any(climb is not None and place > 0.0 for place, climb, *_ in slopes)
    slopes = (
        staging.PlacedSlope(0.0, bank=30.0 * DEG, wall=60.0 * DEG),
        staging.PlacedSlope(0.1, bank=6.0 * DEG, wall=0.0),
    )
    rows = staging.tabulate_leans(slopes, 0.0, 0.0, 0.02, 1.0)
    tilt, lean = np.arctan2(rows[:, 4], rows[:, 5]) / DEG, np.arctan2(rows[:, 6], rows[:, 7]) / DEG
    second = int(np.flatnonzero(rows[:, 0] == 0.1)[0])  # where it begins, as the first has left it
    opened, closed = slice(0, second), slice(second, None)
    assert (tilt[second - 1], lean[second - 1]) == pytest.approx((30.0, -30.0))
    # the bank grows to 30 deg while the wall falls to -30 deg, then back, each angle linear along the wall
    for part, bank, wall in ((opened, (0.0, 30.0), (0.0, -30.0)), (closed, (30.0, 6.0), (-30.0, 6.0))):
        places = rows[part, 0]
        ends = places.min(), places.max()
        np.testing.assert_allclose(tilt[part], np.interp(places, ends, bank), atol=1e-9)
        np.testing.assert_allclose(lean[part], np.interp(places, ends, wall), atol=1e-9)


def ride_of(entered, ended):
    ones, askew = np.ones(len(entered)), np.zeros(len(entered), bool)
    return RideOfTrack(tuple("PQRS"), np.array(entered), np.array(ended), askew, ones, ones)


def test_the_mix_that_arrives_is_that_of_the_parts_by_hand():
    """P stays in 3 of 4, one becomes R; of Q one becomes R, one leaves; R does not ride; S leaves."""
    ride = ride_of([0, 0, 0, 0, 1, 1, 3, 3], [0, 0, 0, 2, 2, LEFT, LEFT, LEFT])
    entering = [0.3, 0.4, 0.2, 0.1]
    assert ride.counts.tolist() == [[3, 0, 1, 0, 0], [0, 0, 1, 0, 1], [0, 0, 0, 0, 0], [0, 0, 0, 0, 2]]
    assert ride.is_turned.tolist() == [True, True, False, True] and ride.rows == [0, 1, 3]
    arrive = np.array([0.3 * 0.75, 0.0, 0.3 * 0.25 + 0.4 * 0.5 + 0.2, 0.0])
    assert ride.arriving_shares(np.array(entering)) == pytest.approx(arrive / arrive.sum())
    assert ride_of([0, 1], [0, 1]).arriving_shares(np.array(entering)) == pytest.approx(entering)


def test_a_flat_block_rides_on_as_the_point_mass_and_stays_as_it_is(monkeypatch):
    """More than half a turn, where places along the wall begin again; the velocity is the closed form's."""
    monkeypatch.setattr(long_ride, "RIDE_S", 60.0)
    own = {"repeats": 2, "distance": 0.55, "run": RunSettings(3)}
    ride = long_ride.ride_of_track(PART, RIDE_BOWL, RIDE_EVERY, [ALONG], **own)
    assert ride.end_rows.tolist() == [ALONG, ALONG] and not ride.is_askew.any()
    assert ride.distances == pytest.approx(0.55, abs=0.01)
    assert ride.distances.min() / RIDE_BOWL.track.radius > np.pi
    along_the_wall = answer.answer(RIDE_BOWL).velocity * 150.0 / 144.0  # its middle is 6 mm off the wall
    assert ride.distances / ride.seconds == pytest.approx(along_the_wall, rel=0.05)


def test_what_rolls_back_or_over_the_free_edge_has_left_and_a_stopped_ride_decides_nothing():
    """A roller across a track that climbs 5 deg rolls back; one along a track leaning outwards leaves it."""
    roller = shapes.part(shapes.cylinder(4, 12, 48))
    steep = replace(RIDE_BOWL, track=replace(RIDE_BOWL.track, climb=np.radians(5.0), bank=np.radians(0.0)))
    lying = orientations(roller, find(roller), steep.track)
    across = [k for k, one in enumerate(lying) if one.kind == "rolling" and one.length < 9e-3]
    ride = long_ride.ride_of_track(roller, steep, lying, across[:1], repeats=3, distance=0.2)
    assert ride.end_rows.tolist() == [LEFT] * 3 and (ride.distances < 0.0).all()

    def stop(done, total):
        assert (done, total) == (1, 2)
        raise KeyboardInterrupt

    own = {"repeats": 1, "distance": 0.2, "run": RunSettings(1, progress=stop)}
    with pytest.raises(KeyboardInterrupt):
        long_ride.ride_of_track(PART, RIDE_BOWL, RIDE_EVERY, [ALONG], **own)


def test_two_corners_at_one_place_are_no_arc_between():
    """A washer that was changed had such a pair on a circle, and its advice ended in a traceback."""
    turn = np.radians(np.arange(0.0, 360.0, 15.0))
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    axis = np.array([0.0, 0.0, 1.0])
    (plain,) = shape.find_circles(ring, axis)
    (twice,) = shape.find_circles(np.vstack([ring, ring[3]]), axis)
    assert len(twice.corners) == len(plain.corners) + 1 and twice.radius == plain.radius
    np.testing.assert_allclose(np.sort(twice.points, axis=0), np.sort(plain.points, axis=0), atol=1e-12)
