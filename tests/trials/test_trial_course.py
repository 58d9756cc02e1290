"""Parts through devices: at the limits of the closed forms, at ends and holes, and what is told of them."""

from dataclasses import replace
from types import SimpleNamespace

import block_rides
import numpy as np
import pytest
import shapely
import shapes
import trimesh
from block_rides import (
    ASPECTS,
    BOWL,
    EVERY,
    FLAT,
    LENGTH,
    PART,
    SOLID,
    aspects_of,
    laid,
    lying,
    ridden,
    sent,
    still,
)

from feederscrew import bowl as bowls
from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.launch_conditions import named
from feederscrew.base.geometry import vectors
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.air_assist import ASIDE_RAD, AirAssist
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.devices.pneumatics import pressure_for
from feederscrew.feeding import stream
from feederscrew.motion import conveying as answer
from feederscrew.output.trial import tables
from feederscrew.output.trial.rides import deciding_station
from feederscrew.part import load
from feederscrew.sorting import fates
from feederscrew.sorting.orientations import add_travel
from feederscrew.sorting.verdicts import verdict
from feederscrew.trials import course, looks, part_poses, runs, shape, staging
from feederscrew.trials import trial as studies
from feederscrew.trials.queue import queue_of
from feederscrew.trials.result import TrialRun
from feederscrew.trials.supply import QueuePlan

L_SHAPE = [(0, 0), (26, 0), (26, 7), (9, 7), (9, 18), (0, 18)]
SLANTED = [(0.0, 6.75), (2.05, 0.0), (19.55, 0.0), (23.5, 7.35), (16.85, 9.1), (12.85, 9.25)]  # [mm]
# a cube as a mesh program wrote it, by another diagonal on each face
CORNERS = [(-5, -5, 5), (5, 5, 5), (5, -5, -5), (-5, 5, 5), (-5, -5, -5), (5, 5, -5), (5, -5, 5), (-5, 5, -5)]
FACES = [
    (0, 3, 4), (2, 0, 4), (4, 3, 7), (7, 2, 4), (0, 1, 3), (6, 0, 2), (6, 1, 0), (3, 1, 7), (5, 2, 7),
    (7, 1, 5), (5, 6, 2), (1, 6, 5),
]  # fmt: skip


@pytest.fixture
def bowl(tmp_path):
    def read(*lines, own=block_rides.OWN):
        path = tmp_path / "bowl.yaml"
        path.write_text("devices:\n" + "".join(f"  - {line}\n" for line in lines))
        return bowls.read(path, own)

    return read


@pytest.mark.parametrize(("device", "length", "passes"), [
    ("gap: 9.9 mm", 0.02, True),  # half its length
    ("gap: 11.5 mm", 0.02, False),  # beyond what its way while it tips over adds
    ("narrowed_track: 5.9 mm", 0.02, False),
    ("dish-out: {leaves: 4 mm, radius: 14 mm}", 0.02, True),  # its ends bridge the bay
    ("dish-out: {leaves: 4 mm, radius: 14 mm}", 0.012, False),
    ("balance gap: {gap: 9 mm, clearance: 5.4 mm, hold: 8 mm}", 0.02, True),
    ("balance gap: {gap: 14.5 mm, clearance: 5.4 mm, hold: 4 mm}", 0.012, False),
    ("canyon: 10.8 mm", 0.012, False),  # beyond what the wall carries
    ("wiper: 4.9 mm", 0.012, False),
    ("profile: [[0 mm, 0 mm], [12.1 mm, 0 mm], [12.1 mm, 5.1 mm], [0 mm, 5.1 mm]]", 0.02, True),
    ("step: 3 mm", 0.02, True),  # below its barrier
])  # fmt: skip
def test_a_part_at_the_limit_of_a_device(bowl, device, length, passes):
    one = bowl(device)
    flat = [k for k, one in enumerate(EVERY) if one.height < 6e-3 and abs(one.length - length) < 1e-3]
    seen = sent(PART, one, flat, 2, one.devices, seed=3)
    assert (seen.fates == course.PASSED).all() == passes and (seen.fates == course.PASSED).any() == passes
    assert (seen.depths < 2.5e-4).all() and (seen.gains < 1e-6).all()
    if passes:
        assert (seen.orientations[-1] == seen.entry_rows).all() and (seen.end_stations == 2).all()


TWIST = "twisted track: {{angle: {} deg, length: 120 mm}}"


@pytest.mark.parametrize("angle", [65.0, 80.0])
def test_a_twisted_track_stands_parts_on_the_side_that_was_at_the_wall(bowl, angle):
    """At the default drive; the rule is that of statics, and so is the name of what leaves."""
    one = bowl(TWIST.format(angle), own=())
    for name, own in (
        ("key_a_d12x20", ("A@0", "B@0")),
        ("lbracket_30x20x15", ("A@2", "B@114", "E@90", "D@1")),
    ):
        part = load(f"parts/{name}.stl")
        every = add_travel(lying(part, one), one)
        flow = fates.course(one.devices, every)
        rows = [k for k, orientation in enumerate(every) if orientation.name in own]
        leaving = course.leaves_by_rule(flow.leaving)
        seen = sent(
            part, one, rows, len(rows), one.devices, every=every, poses=flow.states, may_leave=leaving
        )
        assert len(rows) == len(own) and (flow.margins[rows, 1] > 1e-4).all()
        assert (seen.fates == course.PASSED).all(), (name, seen.orientations[-1])
        assert (seen.orientations[-1] != seen.entry_rows).all() and (seen.depths < 2.5e-4).all()
        # the face below, as the queue tells it
        below = looks.AspectsBelow(part, aspects_of(part), one.track.radius / seen.length)
        aspects = [aspects_of(part).names[k] for k in below.find_aspects(seen.rides[-1].states)]
        assert aspects == [flow.states[k].aspect for k in seen.orientations[-1]]


@pytest.mark.parametrize(("angle", "tips"), [(66.0, False), (80.0, True)])
def test_a_low_foot_at_the_wall_lets_a_part_tip_out_of_a_twist_from_73_deg_on(bowl, angle, tips):
    """The angle is that of statics, tests/sorting/test_twist.py."""
    ring = [(0, 0), (14, 0), (14, 3), (5, 3), (5, 15), (0, 15)]
    part, one = shapes.part(shapes.prism(ring, 30.0)), bowl(TWIST.format(angle), own=())
    every = lying(part, one)
    standing = [k for k, own in enumerate(every) if own.length > 0.0299 and abs(own.height - 0.015) < 1e-5]
    low = max(standing, key=lambda k: every[k].distance)
    seen = sent(part, one, [low], 2, one.devices, every=every)
    for state in seen.rides[-1].states:
        radius = one.track.radius / seen.length
        place = np.arctan2(state[0], radius - state[1])
        inwards = np.array([-np.sin(place), np.cos(place), 0.0])
        up = np.einsum("i,ij,kj->k", inwards, part_poses.matrix(state), seen.principal)
        assert (up @ every[low].axes[1] > 0.95) != tips  # what was inwards is up


def test_a_cap_that_stays_before_a_straight_blade_leaves_along_a_curved_one(bowl):
    """On its round side, mouth ahead, at 50 Hz and throw number 1.8: a wiper of 30 deg stops it."""
    fast = ("drive.amplitude=0.52 mm", "drive.frequency=50 Hz", "drive.vibration_angle=20 deg",
            "drive.phase=0 deg", "track.width=16 mm")  # fmt: skip
    cap, gone = load("parts/cap_14x10.stl"), []
    for line in ("wiper: {clearance: 11.5 mm, sweep: 30 deg}",
                 "curved deflector: {clearance: 11.5 mm, from: 12 deg, to: 50 deg}"):  # fmt: skip
        one = bowl(line, own=fast)
        every = lying(cap, one)
        rows = [k for k, own in enumerate(every) if own.kind == "rolling" and abs(own.heading - np.pi) < 0.2]
        gone.append(np.mean(sent(cap, one, rows, 8, one.devices).fates == course.RETURNED))
    assert gone[0] < 0.5 and gone[1] >= 0.75


@pytest.mark.parametrize(("times", "gone"), [(0.0, False), (0.25, False), (1.1, True), (2.0, True)])
def test_air_takes_a_block_off_a_steep_face_as_the_closed_form_says(times, gone):
    """At 70 deg friction of 0.6 holds it. By hand, twice what just moves it along the face is 0.059 N:
    T sin(aim) (sin a + 2 mu cos a) = 2 mu W (mu sin a - cos a), the aim 11 deg beyond a. A quarter of
    that is half of what moves it: it stays."""
    part, own = shapes.part(shapes.box(20, 12, 16)), ["track.width=16 mm", "track.bank=0 deg"]
    one, a, grip = bowls.read(None, own), np.radians(70.0), 0.6
    every = lying(part, one)
    (row,) = [k for k, own in enumerate(every) if 15e-3 < own.height < 17e-3 and own.length > 19e-3]
    weight, turned = part.mass * one.gravity, np.sin(a) + 2.0 * grip * np.cos(a)
    enough = 2.0 * grip * weight * (grip * np.sin(a) - np.cos(a)) / (np.sin(a + ASIDE_RAD) * turned)
    air = AirAssist(2e-3, pressure_for(2e-3, times * enough), 10e-3) if times else None
    seen = sent(part, one, [row], 3, [make_device("wiper", "w", limit=8e-3, sweep=a, air=air)], seed=3)
    assert (seen.fates == (course.RETURNED if gone else course.STOPPED)).all()


def test_a_cap_on_its_bottom_rides_over_a_selector_and_one_on_its_mouth_falls(bowl):
    cap, one = (
        load("parts/cap_14x10.stl"),
        bowl("cap selector: {land: 3.85 mm, length: 22.1 mm, tongue: 3 mm, reach: 11.8 mm}"),
    )
    every = lying(cap, one)
    flat = sorted((k for k, own in enumerate(every) if own.kind == "flat"), key=lambda k: every[k].foot.mouth)
    assert len(flat) == 2 and every[flat[0]].foot.mouth == 0.0 < every[flat[1]].foot.mouth
    seen = sent(cap, one, flat, 4, one.devices)
    assert (seen.fates[seen.entry_rows == flat[0]] == course.PASSED).all()
    assert (seen.fates[seen.entry_rows == flat[1]] == course.RETURNED).all()


def test_an_angle_whose_leg_stands_at_the_wall_is_pushed_off_and_the_other_way_round_rides_on(bowl):
    """Its upright leg is 5 mm of 20 mm wide: at the wall a blade of 12 mm pushes it off a track of 15 mm."""
    part = shapes.part(shapes.prism([(0, 0), (20, 0), (20, 4), (5, 4), (5, 12), (0, 12)], 15))
    one = bowl("silhouette blade: {clearance: 6 mm, reach: 12 mm, leaves: 15 mm, sweep: 30 deg}")
    every = lying(part, one)
    rows = [k for k, own in enumerate(every) if abs(own.height - 12e-3) < 1e-5 and own.length < 15.1e-3]
    near, far = sorted(rows, key=lambda k: every[k].distance)
    seen = sent(part, one, [near, far], 8, one.devices)
    assert (seen.fates[seen.entry_rows == near] == course.RETURNED).all()
    assert (seen.fates[seen.entry_rows == far] == course.PASSED).all()


def test_a_fall_down_a_step_or_over_the_free_edge_wins_nothing_and_sinks_nowhere(bowl):
    """A bracket that falls down a step onto an edge won 6 to 8 um at once there."""
    bracket, one = load("parts/lbracket_30x20x15.stl"), bowl("step: 4 mm", "gap: 7 mm", own=())
    every = lying(bracket, one)
    long_side_up = [k for k, one in enumerate(every) if one.name == "D@1"]
    for seed in (1, 3):
        assert sent(bracket, one, long_side_up, 1, one.devices, seed=seed).gains.max() < 5e-7
    # an L on the end of its long leg, across, the short one towards the edge, tips and slides down it
    part, plain = shapes.part(shapes.prism(L_SHAPE, 11)), bowls.read(None, [])
    every = lying(part, plain)
    ends = [k for k, one in enumerate(every) if one.aspect == "F" and one.length < 0.012]
    seen = sent(part, plain, [k for k in ends if every[k].distance < 7e-3], 2)
    assert (seen.fates == course.RETURNED).all() and seen.depths.max() < 5e-5


def left(part, bowl, one, place, aside=0.0):
    """Height [m] of the centre of mass of a part some time after it was laid, at rest, over a device."""
    level = still(bowl, climb=0.0)
    cut = staging.stage_device(bowl.devices[0], level.track, lying(part, level))
    state = laid(part, one, level, place=place, aside=aside)
    known, ride = ridden(part, level, state, 0.6, cut, back=1.0)
    return ride.states[0][2] * known.length


@pytest.mark.parametrize("over", [-1e-4, 1e-4])
@pytest.mark.parametrize(("device", "place", "aside", "inwards"), [
    ("gap: 40 mm", 0.0, 1e-3, 0.0),  # half its length hangs over
    ("narrowed_track: 8 mm", 0.013, 2e-3, 1.0),  # half its width
    ("canyon: 10 mm", 0.013, 4e-3, -1.0),  # the same; off the wall, which else holds it
    ("slot: {from: 7 mm, to: 30 mm}", 0.013, 1e-3, 1.0),  # its weight beyond the near edge
    ("slot: {from: 4 mm, to: 13 mm}", 0.013, 1e-3, -1.0),  # or its far side on the far one
])  # fmt: skip
def test_a_part_laid_over_an_edge_tips_at_its_centre_of_mass(bowl, device, place, aside, inwards, over):
    height = left(PART, bowl(device), FLAT, place if place else over, aside + inwards * over)
    assert (height < 2e-3) == (over > 0.0)
    assert over > 0.0 or height == pytest.approx(2.5e-3, abs=1e-6)


@pytest.mark.parametrize(("width", "height"), [  # [mm] of the slot, and of the centre of mass over the rails
    (4.9, 2.5),  # the shank, 5 mm, does not go down
    (5.1, -4.45),  # it hangs, the centre of mass that far below the head
    (9.9, -4.45),
    (10.1, -10.0),  # the head, 10 mm, goes through
])  # fmt: skip
def test_a_headed_part_laid_over_rails_hangs_between_shank_and_head(bowl, width, height):
    one = bowl(f"rails: {{from: {6 - width / 2} mm, to: {6 + width / 2} mm}}")
    flat = next(k for k in lying(block_rides.HEADED, one) if k.height < 6e-3 and k.length > 0.017)
    along = replace(flat, heading=np.pi, distance=6e-3)  # off the wall, its axis over the slot's middle
    found = 1e3 * left(block_rides.HEADED, one, along, 0.02)
    assert found < height + 0.5 if height < -5.0 else found == pytest.approx(height, abs=0.1)


def test_a_round_side_touches_with_points_on_its_circle_and_a_washer_lies_on_a_few():
    turn = np.arange(24) * 2.0 * np.pi / 24
    disc = shapes.part(shapes.prism(np.column_stack([5 * np.cos(turn), 5 * np.sin(turn)]), 8))
    solid, length, _ = shape.solid_of(disc)
    axis = np.eye(3)[np.argmax(np.abs(solid.inertia - np.median(solid.inertia)))]
    fine = shape.round_circles(solid, [axis])
    across = fine.corners - np.einsum("ci,i->c", fine.corners, axis)[:, None] * axis
    assert len(fine.corners) == 2 * 24 * 3  # 15 degrees in parts of at most 6
    assert fine.on_circle.all() and not len(fine.singles)
    np.testing.assert_allclose(fine.circles.radius * length, 5e-3, rtol=1e-5)
    middles = np.column_stack([fine.circles.x, fine.circles.y, fine.circles.z])
    np.testing.assert_allclose(np.sort(vectors.product(middles, axis)) * length, [-4e-3, 4e-3])
    np.testing.assert_allclose(np.linalg.norm(across, axis=1) * length, 5e-3, rtol=1e-5)
    np.testing.assert_array_equal(fine.vertices[fine.triangles], solid.vertices[solid.triangles])
    box = shape.round_circles(SOLID, [axis])
    assert len(box.corners) == 8 and not len(box.circles)  # a box has no circle
    washer, plain = load("parts/washer_m6.stl"), bowls.read(None, [])
    flat = next(k for k, one in enumerate(lying(washer, plain)) if one.height < 2e-3)
    seen = sent(washer, plain, [flat], 1)
    assert seen.fates[0] == course.PASSED and seen.depths[0] < 1e-5 and seen.gains[0] < 1e-6
    assert seen.velocities[0] == pytest.approx(answer.answer(plain).velocity, rel=0.05)


def test_a_corner_that_slides_along_the_wall_does_not_slip_past_a_gate(bowl):
    """The wedge comes with its sharp upright edge foremost, which touches wall and track."""
    wedge = shapes.part(shapes.prism([(0, 0), (16, 0), (10, 8), (0, 8)], 11))
    gate = bowl("profile: [[0 mm, 0 mm], [16 mm, 0 mm], [16 mm, 8.4 mm], [0 mm, 8.4 mm]]")
    every = lying(wedge, gate)
    sharp = [k for k, one in enumerate(every) if abs(one.height - 11e-3) < 1e-5 and one.length > 15.9e-3]
    seen = sent(wedge, gate, sharp, len(sharp), gate.devices)
    assert len(sharp) >= 2 and (seen.fates == course.STOPPED).all()


def test_parts_that_fall_onto_the_track_go_on_as_they_come_to_lie(bowl):
    one, begun = bowl("narrowed_track: 9 mm"), []
    kinds = [RunSettings(2, jobs, before=lambda: begun.append(1)) for jobs in (1, 2)]
    own = {"launch": "drop", "parts": 24}
    both = [course.landing(PART, one, ASPECTS, EVERY, EVERY, run=run, **own) for run in kinds]
    fell = both[0]
    assert begun == [1, 1]  # once each, not again where those that lie go on
    np.testing.assert_array_equal(fell.fates, both[1].fates)
    assert fell.lost + fell.landed_counts.sum() == 24 and 0 < fell.lost < 24
    assert fell.landed_counts[0] > fell.landed_counts[1:].sum()  # most lie flat
    assert fell.leavers == fell.fates[:, [course.PASSED, course.TURNED]].sum()
    assert fell.fates[:, course.RETURNED].sum() > 0  # their middle lies beyond the track that is left
    assert fell.depth < 1.5e-4
    below = looks.AspectsBelow(PART, ASPECTS)
    states, times = part_poses.draw_falling(BOWL, named("feed"), below.shape, 40, LENGTH, 3)
    for state in states:
        corners = state[:3] + np.einsum("ij,cj->ci", part_poses.matrix(state), below.shape.solid.vertices)
        assert corners[:, 1].min() > 0.0 and corners[:, 2].min() > 1.99
    assert (states[:, 1] < BOWL.track.width / LENGTH).all()
    assert ((times >= 0.0) & (times < 1.0 / BOWL.drive.frequency)).all()


def test_a_hole_whose_corners_run_slanting_into_the_wall_is_the_one_that_is_drawn(bowl):
    """It leaves a wedge of track in two corners at the wall; a block that the corners carry gets over."""
    part = shapes.part(shapes.box(21.62, 11.89, 7.12))
    text = ", ".join(f"[{x} mm, {y} mm]" for x, y in SLANTED)
    slanted = bowl(f"cut_out: [{text}]", own=["track.width=25 mm"])
    track, every = slanted.track, add_travel(lying(part, slanted), slanted)
    stage = staging.stage_device(slanted.devices[0], track, every)
    borders = stage.borders[stage.plates[0].begin : stage.plates[0].end]
    x, y = borders.start_x, track.radius - borders.start_y
    floor = shapely.Polygon(np.column_stack([track.radius * np.arctan2(x, y), track.radius - np.hypot(x, y)]))
    # area of the track that it takes, about the bowl's axis, between the wall and the free edge
    missing = shapely.box(-5e-3, 0.0, 28e-3, track.width).difference(floor).area
    assert missing == pytest.approx(1e-6 * shapely.Polygon(SLANTED).area, rel=2e-3)
    row = next(k for k, one in enumerate(every) if one.length > 0.0216 and one.height < 0.0072)
    said = verdict(slanted.devices[0], every[row], every)
    assert said.passes == 1.0 and said.margin > 1e-3
    seen = sent(part, slanted, [row], 3, slanted.devices, seed=3, every=every)
    assert list(seen.fates) == [course.PASSED] * 3


@pytest.mark.parametrize("order", [range(8), (3, 7, 1, 0, 5, 2, 6, 4), (6, 5, 2, 7, 4, 1, 0, 3)])
@pytest.mark.parametrize(("speed", "falls"), [(0.5, False), (0.68, False), (0.8, True)])
def test_a_cube_stands_over_an_edge_whatever_order_its_corners_have(order, speed, falls):
    """It slides from 8 mm before an edge on. As it brakes, what carries it is 2 mm ahead of its centre."""
    faces = np.argsort(order)[np.roll(FACES, order[0], axis=0)]
    part = shapes.part(trimesh.Trimesh(np.array(CORNERS)[list(order)], faces, process=False))
    level = still(replace(BOWL, restitution=0.0), climb=0.0, width=0.04)
    every = lying(part, level)
    edge = staging.stage_device(make_device("gap", "here", limit=0.03), level.track, every)
    state = laid(part, every[0], level, place=-8e-3, aside=5e-3)
    state[body.VX] = speed
    known, end = ridden(part, level, state, 0.5, edge)
    assert (end.states[0, body.Z] < 0.0) == falls
    if not falls:
        assert end.distances[0] == pytest.approx(known.length * speed**2 / (2.0 * 0.4), rel=1e-3)


def test_every_cube_of_a_queue_on_a_bare_track_leaves():
    part = shapes.part(trimesh.Trimesh(CORNERS, FACES, process=False))
    one, aspects = bowls.read(None, ["track.width=20 mm", "track.bank=3 deg"]), block_rides.aspects_of(part)
    known = stream.follow_orientations(part, aspects, one.track, bowl=one)
    plan = QueuePlan(12, 2.0)
    seen = queue_of(part, one, aspects, known.lying, known.states, np.ones(1), plan, RunSettings(1))
    assert seen.returned == 0 and seen.jams == 0
    assert seen.leaving_counts[0] == seen.leaving_counts.sum() > 2


def test_a_hop_over_the_tooling_is_said(bowl):
    one = bowl("gap: 9 mm")
    hard = replace(one, drive=replace(one.drive, amplitude=4e-4))
    found = studies.trial(PART, [one, hard], "A", parts=2)
    assert any("hop" in told and told.startswith("amplitude 0.4 mm") for told in found.warnings)
    assert found.highest >= 0.15e-3
    spread = [told for told in found.warnings if "restitution of single impacts spreads from 0.145" in told]
    assert len(spread) == 1 and spread[0].startswith("amplitude 0.4 mm")
    calm, thrown = (run["point_restitution_doubt"] for run in tables.document(found)["drives"])
    assert calm is None and thrown["velocity_less_mm_s"] > 1.05 * thrown["velocity_more_mm_s"] > 0.0


def test_what_leaves_otherwise_or_not_at_all_is_odd_and_no_sorting(bowl):
    run = studies.trial(PART, [bowl("gap: 2 mm")], "A", parts=4, seed=1).runs[0]
    row = int(np.flatnonzero(run.counts[:, course.PASSED])[0])
    passes, margins = run.orientations.passes.copy(), np.full_like(run.orientations.margins, np.nan)
    passes[row] = 0.0  # it is said to be returned, by no margin
    other = replace(run, orientations=replace(run.orientations, passes=passes, margins=margins))
    assert run.sorts and not other.sorts and not other.passes_by_rule[row]
    seen = studies.trial(PART, [BOWL], "A", parts=4, seed=1).runs[0]
    tried = seen.tried_counts > 0
    assert seen.passes_by_rule[tried].all() and seen.is_sure[tried].all()
    assert np.isnan(seen.margin[tried]).all() and not seen.is_odd.any()
    lost = replace(seen, course=replace(seen.course, fates=np.full(4, course.RETURNED)))
    np.testing.assert_array_equal(lost.is_odd, tried)
    (first, *_) = lost.remarks
    assert first.endswith(f"0 of {seen.tried_counts[tried][0]} do what the static verdict says (passes)")


def run_of(entered, fates, *, velocities=0.06, ended=1, out=None):
    """Parts of two orientations, offered as 3 to 1 and 20 and 40 mm long, on a track with one device."""
    entered, fates = np.array(entered), np.array(fates)
    leave = np.where(fates <= course.TURNED, entered if out is None else out, -2)
    seen = SimpleNamespace(
        entry_rows=entered, fates=fates, velocities=np.broadcast_to(velocities, len(fates)),
        end_stations=np.broadcast_to(ended, len(fates)), orientations=np.array([entered, entered, leave]),
    )  # fmt: skip
    lengths = np.array([0.02, 0.04])
    rows = tuple(SimpleNamespace(length=length) for length in lengths)
    known = SimpleNamespace(lying=rows, states=rows, lengths=lengths)
    return TrialRun(bowls.default(), 0.5, known, np.array([0.75, 0.25]), seen)


@pytest.mark.parametrize(("fate", "ended", "counts"), [
    (course.STOPPED, 0, False),  # it sticks on the bare track
    (course.STUCK, 0, False),
    (course.STOPPED, 1, True),  # it came to the device, as fast as the bare track brought it
    (course.STUCK, 1, True),
    (course.RETURNED, 0, True),
    (course.PASSED, 2, True),
])  # fmt: skip
def test_what_sticks_on_the_bare_track_is_left_out_of_the_velocity(fate, ended, counts):
    run = run_of([0, 0], [course.PASSED, fate], velocities=[0.06, 0.02], ended=[2, ended])
    assert run.velocity == pytest.approx(0.04 if counts else 0.06, rel=1e-12)


def test_what_leaves_in_no_known_orientation_is_never_the_wanted_one():
    """Of the first three in four leave askew, a quarter as they came; of the second all as they came."""
    fates = [course.TURNED] * 3 + [course.PASSED] * 2
    run = run_of([0, 0, 0, 0, 1], fates, out=[-1, -1, -1, 0, 1])
    np.testing.assert_allclose(run.leaving_shares, [0.1875, 0.25, 0.5625], rtol=1e-12)
    assert run.main_row == 1 and run.efficiency == 0.25 and run.purity == 0.25
    askew = run_of([0, 1], [course.TURNED, course.TURNED], out=-1)
    assert askew.main_row is None and askew.efficiency == askew.purity == askew.parts == 0.0


def test_the_stills_are_of_the_device_that_decides():
    """Where most do not pass while others do; a device that loses all shows nothing that passes."""
    for lost, place in (((0, 1, 5, 2), 2), ((3, 0, 0, 0), 3), ((0, 2, 2), 1), ((0, 9, 1), 2)):
        outcomes = [np.where(np.arange(9) < count, runs.PASSED + 1, runs.PASSED) for count in lost]
        rides = [SimpleNamespace(outcomes=one) for one in outcomes]
        assert deciding_station(SimpleNamespace(rides=rides)) == place
