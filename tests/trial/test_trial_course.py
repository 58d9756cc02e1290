"""Parts through devices: at the limits of the closed forms, and what is told of them."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.dropping.launch_conditions import named
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import frozen_rows
from feederscrew.output.trial import tables
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.studies import trial as studies
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import course, looks, part_poses, runs, shape, staging
from feederscrew.trial.kernel import plate_views, workspace

OWN = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=50 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
]  # fmt: skip
PART = shapes.part(shapes.box(20, 12, 5))
L_SHAPE = [(0, 0), (26, 0), (26, 7), (9, 7), (9, 18), (0, 18)]


@pytest.fixture
def bowl(tmp_path):
    def read(*lines):
        path = tmp_path / "bowl.yaml"
        path.write_text("devices:\n" + "".join(f"  - {line}\n" for line in lines))
        return bowls.read(path if lines else None, OWN)

    return read


def sent(bowl, length, parts=2):
    """What became of the flat block of a length along the wall."""
    every = orientations(PART, find(PART), bowl.track)
    flat = [k for k, one in enumerate(every) if one.height < 6e-3 and abs(one.length - length) < 1e-3]
    return course.course(PART, bowl, every, course.Sending(flat, parts), bowl.devices, run=RunSettings(3))


@pytest.mark.parametrize(
    ("device", "length", "passes"),
    [
        ("gap: 9.9 mm", 0.02, True),  # half its length
        ("gap: 11.5 mm", 0.02, False),  # beyond what its way while it tips over adds
        ("narrowed_track: 5.9 mm", 0.02, False),
        ("canyon: 10.8 mm", 0.012, False),  # beyond what the wall carries
        ("wiper: 4.9 mm", 0.012, False),
        ("profile: [[0 mm, 0 mm], [12.1 mm, 0 mm], [12.1 mm, 5.1 mm], [0 mm, 5.1 mm]]", 0.02, True),
        ("step: 3 mm", 0.02, True),  # below its barrier
    ],
)
def test_a_part_at_the_limit_of_a_device(bowl, device, length, passes):
    seen = sent(bowl(device), length)
    assert (seen.fates == course.PASSED).all() == passes
    assert (seen.fates == course.PASSED).any() == passes
    assert (seen.depths < 2.5e-4).all()
    assert (seen.gains < 1e-6).all()
    if passes:
        assert (seen.orientations[-1] == seen.entered).all()
        assert (seen.ended == 2).all()


def test_a_step_wins_nothing_that_gravity_and_the_drive_did_not_give(tmp_path):
    """A bracket that falls down a step onto an edge won 6 to 8 um at once there."""
    path = tmp_path / "falls.yaml"
    path.write_text("devices:\n  - step: 4 mm\n  - gap: 7 mm\n")
    bracket, bowl = load("parts/lbracket_30x20x15.stl"), bowls.read(path, [])
    every = orientations(bracket, find(bracket), bowl.track)
    long_side_up = [k for k, one in enumerate(every) if one.name == "D@1"]
    for seed in (1, 3):
        seen = course.course(
            bracket, bowl, every, course.Sending(long_side_up, 1), bowl.devices, run=RunSettings(seed)
        )
        assert seen.gains.max() < 5e-7


def test_a_part_that_falls_over_the_free_edge_does_not_sink_into_the_track():
    """An L on the end of its long leg, across, the short one towards the edge, tips and slides down it."""
    part, bowl = shapes.part(shapes.prism(L_SHAPE, 11)), bowls.read(None, [])
    every = orientations(part, find(part), bowl.track)
    across = [
        k for k, one in enumerate(every) if one.aspect == "F" and one.distance < 7e-3 and one.length < 0.012
    ]
    seen = course.course(part, bowl, every, course.Sending(across, 2), (), run=RunSettings(1))
    assert (seen.fates == course.RETURNED).all() and seen.depths.max() < 5e-5


def left(part, bowl, one, place, aside=0.0):
    """Height [m] of the centre of mass of a part some time after it was laid, at rest, over a device."""
    still = replace(bowl, drive=replace(bowl.drive, amplitude=0.0), track=replace(bowl.track, climb=0.0))
    solid, length, principal = shape.solid_of(part)
    known = runs.setting(solid, length, still)
    cut = staging.stage(bowl.devices[0], still.track, orientations(part, find(part), still.track))
    state = part_poses.pose_on_track(one, principal, length, still.track, place=place, aside=aside)
    ride = runs.ride(
        runs.past(known, cut, limits=(0.6, 1.0, 0.0, 1.0), interval=0.01, places=9), state[None], np.zeros(1)
    )
    return ride.states[0][2] * length


@pytest.mark.parametrize("over", [-1e-4, 1e-4])
@pytest.mark.parametrize(
    ("device", "place", "aside", "inwards"),
    [
        ("gap: 40 mm", 0.0, 1e-3, 0.0),  # half its length hangs over
        ("narrowed_track: 8 mm", 0.013, 2e-3, 1.0),  # half its width
        ("canyon: 10 mm", 0.013, 4e-3, -1.0),  # the same; off the wall, which else holds it
        ("slot: {from: 7 mm, to: 30 mm}", 0.013, 1e-3, 1.0),  # its weight beyond the near edge
        ("slot: {from: 4 mm, to: 13 mm}", 0.013, 1e-3, -1.0),  # or its far side on the far one
    ],
)
def test_a_part_laid_over_an_edge_tips_at_its_centre_of_mass(bowl, device, place, aside, inwards, over):
    one, falls = bowl(device), over > 0.0
    flat = next(k for k in orientations(PART, find(PART), one.track) if k.height < 6e-3 and k.length > 0.015)
    height = left(PART, one, flat, place if place else over, aside + inwards * over)
    assert (height < 2e-3) == falls
    assert falls or height == pytest.approx(2.5e-3, abs=1e-6)


HEADED = shapes.prism([(-2.5, 0), (2.5, 0), (2.5, 14), (5, 14), (5, 17), (-5, 17), (-5, 14), (-2.5, 14)], 5)


@pytest.mark.parametrize(
    ("width", "height"),
    [  # [mm] of the slot, and of the centre of mass over the rails
        (4.9, 2.5),  # the shank, 5 mm, does not go down
        (5.1, -4.45),  # it hangs, the centre of mass that far below the head
        (9.9, -4.45),
        (10.1, -10.0),  # the head, 10 mm, goes through
    ],
)
def test_a_headed_part_laid_over_rails_hangs_between_shank_and_head(bowl, width, height):
    part = shapes.part(HEADED)
    one = bowl(f"rails: {{from: {6 - width / 2} mm, to: {6 + width / 2} mm}}")
    lying = next(k for k in orientations(part, find(part), one.track) if k.height < 6e-3 and k.length > 0.017)
    along = replace(lying, heading=np.pi, distance=6e-3)  # off the wall, its axis over the slot's middle
    found = 1e3 * left(part, one, along, 0.02)
    assert found < height + 0.5 if height < -5.0 else found == pytest.approx(height, abs=0.1)


def test_a_round_side_touches_with_points_on_its_circle():
    turn = np.arange(24) * 2.0 * np.pi / 24
    disc = shapes.part(shapes.prism(np.column_stack([5 * np.cos(turn), 5 * np.sin(turn)]), 8))
    solid, length, _ = shape.solid_of(disc)
    axis = np.eye(3)[np.argmax(np.abs(solid.inertia - np.median(solid.inertia)))]
    fine = shape.rounded(solid, [axis])
    across = fine.corners - np.einsum("ci,i->c", fine.corners, axis)[:, None] * axis
    assert len(fine.corners) == 2 * 24 * 3  # 15 degrees in parts of at most 6
    assert fine.on_circle.all() and not len(fine.singles)
    np.testing.assert_allclose(fine.circles.radius * length, 5e-3, rtol=1e-5)
    middles = np.column_stack([fine.circles.x, fine.circles.y, fine.circles.z])
    np.testing.assert_allclose(np.sort(vectors.product(middles, axis)) * length, [-4e-3, 4e-3])
    np.testing.assert_allclose(np.linalg.norm(across, axis=1) * length, 5e-3, rtol=1e-5)
    np.testing.assert_array_equal(fine.vertices[fine.triangles], solid.vertices[solid.triangles])
    box = shape.rounded(shape.solid_of(PART)[0], [axis])
    assert len(box.corners) == 8 and not len(box.circles)  # a box has no circle


@pytest.mark.parametrize("line", ["wiper: 6 mm", "wiper: {clearance: 6 mm, sweep: 40 deg, friction: 0.2}"])
def test_a_blade_faces_the_part_that_arrives(bowl, line):
    """The axis out of it is square to both along it and points against the way along the wall."""
    made = bowl(line)
    plates = staging.stage(made.devices[0], made.track, orientations(PART, find(PART), made.track)).plates
    blade = plates[np.argmin(np.abs(plates.front_z))]
    first, second, front = ([blade[f"{axis}_{e}"] for e in "xyz"] for axis in ("first", "second", "front"))
    np.testing.assert_allclose(np.cross(second, first), front, atol=1e-12)
    assert front[0] < -0.5


def test_a_circle_touches_at_its_lowest_point_and_lying_flat_furthest_out():
    # about z, half over the middle, of radius 2
    (rim,) = frozen_rows([(0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 2.0)], workspace.CIRCLE)
    for tilt in (0.0, 0.3, np.pi / 2):
        c, s = np.cos(tilt), np.sin(tilt)
        frame = np.array([c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c, 0.0, 0.0, 3.0])
        low, sine = plate_views.circle_height(frame, rim)
        turn = np.linspace(0.0, 2.0 * np.pi, 2001)
        circle = np.column_stack([2.0 * np.cos(turn), 2.0 * np.sin(turn), np.full(2001, 0.5)])
        assert low == pytest.approx(
            (vectors.product(circle, frame[6:9])).min() + 3.0, abs=1e-5
        ) and sine == pytest.approx(s)


def test_a_washer_lies_on_a_few_points_of_its_rim():
    washer, bowl = load("parts/washer_m6.stl"), bowls.read(None, [])
    every = orientations(washer, find(washer), bowl.track)
    flat = next(k for k, one in enumerate(every) if one.height < 2e-3)
    seen = course.course(washer, bowl, every, course.Sending([flat], 1), ())
    assert seen.fates[0] == course.PASSED and seen.depths[0] < 1e-5 and seen.gains[0] < 1e-6
    assert seen.velocities[0] == pytest.approx(answer.answer(bowl).velocity, rel=0.05)


def test_the_order_of_work_changes_nothing(bowl):
    one = bowl("gap: 9 mm")
    every = orientations(PART, find(PART), one.track)
    both = [
        course.course(PART, one, every, course.Sending([0, 1], 6), one.devices, run=RunSettings(7, jobs))
        for jobs in (1, 2)
    ]
    np.testing.assert_array_equal(both[0].seconds, both[1].seconds)
    np.testing.assert_array_equal(both[0].rides[-1].states, both[1].rides[-1].states)


def test_a_study_tells_what_the_static_rule_says_beside(bowl):
    found = studies.trial(PART, [bowl("gap: 9 mm")], "A", parts=4, seed=1)
    run = found.runs[0]
    tried = np.flatnonzero(run.tried)
    assert run.shares.sum() == pytest.approx(1.0)
    assert (run.holding[tried] == run.tried[tried]).all()
    assert run.jams and not run.sorts  # what lies across hangs in the gap
    assert run.purity == 1.0 and 0.0 < run.efficiency < 1.0
    assert run.parts <= run.velocity / run.orientations.lengths[run.wanted]
    low, high = run.ends[tried].T
    assert ((low <= 1.0) & (high >= 0.0) & (low < high)).all()
    assert not any("hop" in told or "deep" in told for told in found.warnings)
    sunk = replace(run.course, depths=np.where(run.course.entered == tried[0], 7e-4, 2e-4))
    (said,) = replace(run, course=sunk).remarks
    assert said.startswith(
        f"{run.orientations.lying[tried[0]].name}: up to 0.7 mm deep in the track or a device"
    )


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


def test_a_corner_that_slides_along_the_wall_does_not_slip_past_a_gate(bowl):
    """The wedge comes with its sharp upright edge foremost, which touches wall and track."""
    wedge = shapes.part(shapes.prism([(0, 0), (16, 0), (10, 8), (0, 8)], 11))
    gate = bowl("profile: [[0 mm, 0 mm], [16 mm, 0 mm], [16 mm, 8.4 mm], [0 mm, 8.4 mm]]")
    every = orientations(wedge, find(wedge), gate.track)
    sharp = [k for k, one in enumerate(every) if abs(one.height - 11e-3) < 1e-5 and one.length > 15.9e-3]
    seen = course.course(
        wedge, gate, every, course.Sending(sharp, len(sharp)), gate.devices, run=RunSettings(1)
    )
    assert len(sharp) >= 2 and (seen.fates == course.STOPPED).all()


def test_parts_that_fall_onto_the_track_go_on_as_they_come_to_lie(bowl):
    one, aspects = bowl("narrowed_track: 9 mm"), find(PART)
    every = orientations(PART, aspects, one.track)
    own, begun = {"launch": "drop", "parts": 24}, []
    kinds = [RunSettings(2, jobs, before=lambda: begun.append(1)) for jobs in (1, 2)]
    both = [course.landing(PART, one, aspects, every, every, run=run, **own) for run in kinds]
    fell = both[0]
    assert begun == [1, 1]  # once each, not again where those that lie go on
    np.testing.assert_array_equal(fell.fates, both[1].fates)
    assert fell.lost + fell.landed.sum() == 24 and 0 < fell.lost < 24
    assert fell.landed[0] > fell.landed[1:].sum()  # most lie flat
    assert fell.left == fell.fates[:, [course.PASSED, course.TURNED]].sum()
    assert fell.fates[:, course.RETURNED].sum() > 0  # their middle lies beyond the track that is left
    assert fell.depth < 1.5e-4


def test_parts_that_fall_anywhere_over_the_track_clear_the_wall():
    bowl, aspects = bowls.read(None, OWN), find(PART)
    below = looks.AspectsBelow(PART, aspects)
    states, times = part_poses.falling(bowl, named("feed"), below.shape, 40, shape.solid_of(PART)[1], 3)
    for state in states:
        corners = state[:3] + np.einsum("ij,cj->ci", part_poses.matrix(state), below.shape.vertices)
        assert corners[:, 1].min() > 0.0 and corners[:, 2].min() > 1.99
    assert (states[:, 1] < bowl.track.width / shape.solid_of(PART)[1]).all()
    assert ((times >= 0.0) & (times < 1.0 / bowl.drive.frequency)).all()


def test_what_else_leaves_is_no_sorting_however_unsure(bowl):
    run = studies.trial(PART, [bowl("gap: 2 mm")], "A", parts=4, seed=1).runs[0]
    row = int(np.flatnonzero(run.counts[:, course.PASSED])[0])
    passes, margins = run.orientations.passes.copy(), np.full_like(run.orientations.margins, np.nan)
    passes[row] = 0.0  # it is said to be returned, by no margin
    other = replace(run, orientations=replace(run.orientations, passes=passes, margins=margins))
    assert run.sorts and not other.sorts and not other.predicted[row]
