"""The drop kernel, its moving floor and its round sides, against closed forms and the laws of mechanics."""

import math
from pathlib import Path

import drop_bodies
import numpy as np
import pytest
import shapes
import trimesh
from drop_bodies import lying_flat
from scipy.spatial.transform import Rotation

from feederscrew import bowl as bowls
from feederscrew.arrivals import plate_test
from feederscrew.arrivals.kernel import body, falling, floor_contacts, floor_motion, one_drop
from feederscrew.arrivals.kernel import ride as shaken
from feederscrew.arrivals.kernel.falling import Steps, scratch
from feederscrew.arrivals.kernel.floor_motion import Floor, at_rest
from feederscrew.arrivals.launch_conditions import PRESETS, sample
from feederscrew.arrivals.rounded_hull import MIDDLE, OPENING, RADIUS, principal_axes, rims_of, shape_of_part
from feederscrew.base.geometry.vectors import solid_angles
from feederscrew.motion import conveying as answer
from feederscrew.part import load
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.half_edges import half_edges

DATA = Path(__file__).parents[1] / "data"
BOX, _ = drop_bodies.box((1.0, 1.3, 1.7))
PLATE, _ = drop_bodies.box((3.0, 3.0, 0.6))
LENGTH = 0.01  # [m]
ELLIPSE = Floor(3.0, 0.2, 0.1, 0.7, 0.06, 0.05, -0.4, 0.01)
AXES = (ELLIPSE.along, ELLIPSE.second_along), (ELLIPSE.up, ELLIPSE.second_up)
SECOND = "drive.second_harmonic_phase=60 deg"
MM = 1e-3
CYLINDER = shapes.cylinder(5.0, 8.0, 24)


def traced(shape, state, restitution, friction, steps=None, rows=20000):
    work = scratch(shape, rows)
    work.state[:] = state
    _, _, used = one_drop.settle(shape, work, restitution, friction, steps or Steps())
    return work.trace[:used]


def high_up():
    """A state standing 5 over the floor on the box's +z side."""
    state = np.zeros(body.STATE)
    state[body.Q], state[body.Z] = 1.0, 5.0 - BOX.solid.vertices[:, 2].min()
    return state


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.3, 1.0])
def test_energy_never_grows(restitution, friction, rng):
    for state in sample(PRESETS["roll"], BOX, 12, rng).states:
        trace = traced(BOX, state, restitution, friction, Steps(early=False, longest=20.0))
        velocity, rates = trace[:, 1 + body.VX : 1 + body.VX + 3], trace[:, 1 + body.W :]
        energy = 0.5 * (velocity**2).sum(axis=1) + 0.5 * rates**2 @ BOX.solid.inertia + trace[:, 1 + body.Z]
        assert np.diff(energy).max() < 1e-9


def test_free_rotation(rng):
    state = high_up()
    state[body.W : body.W + 3] = rng.normal(size=3) * 3.0

    def momentum():
        return Rotation.from_quat(state[[7, 8, 9, 6]]).apply(BOX.solid.inertia * state[body.W :])

    before, start = body.spin_energy(state, BOX.solid.inertia), momentum()
    for _ in range(2000):
        body.tumble(state, BOX.solid.inertia, 2e-3)
    assert body.spin_energy(state, BOX.solid.inertia) == pytest.approx(before, rel=1e-12)
    assert momentum() == pytest.approx(start, abs=1e-4 * np.linalg.norm(start))
    rates, attitudes = rng.normal(size=3) * 3.0, []
    for steps in (2000, 100, 200):
        state = high_up()
        state[body.W : body.W + 3] = rates
        for _ in range(steps):
            body.tumble(state, BOX.solid.inertia, 2.0 / steps)
        attitudes.append(state[body.Q : body.Q + 4].copy())
    errors = [np.linalg.norm(attitude - attitudes[0]) for attitude in attitudes[1:]]
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)


def struck(restitution, friction, rng):
    """State of a tilted box that falls on one corner, what is there after the impact, and its contacts."""
    state = sample(PRESETS["roll"], BOX, 1, rng).states[0].copy()
    body.rotation(state, turn := np.zeros(9))
    state[body.Z], state[body.VZ] = -(BOX.solid.vertices @ turn[6:]).min(), -2.0
    work = scratch(BOX)
    work.state[:] = state
    body.rotation(work.state, work.turn)
    corner, _ = body.lowest(BOX.solid.vertices, BOX.solid.links, work.turn, 0)
    count = floor_contacts.touching(BOX.solid, work, state[body.Z], corner, 1e-3)
    floor_contacts.levers(BOX.solid.inertia, work, count)
    pairing, steps = falling.Pairing(restitution, friction), Steps(converged=1e-13)
    floor_contacts.strike(BOX.solid.inertia, work.state, work.saved, work.contacts, count, pairing, steps)
    return state, work, count


@pytest.mark.parametrize("friction", [0.0, 0.2, 5.0])
def test_an_impact_balances_momentum(friction, rng):
    state, work, count = struck(0.4, friction, rng)
    contacts, corners = work.contacts[:count], work.spots[:count]
    impulse = np.column_stack([contacts.ahead_impulse, contacts.aside_impulse, contacts.up_impulse])
    won = work.state[body.VX : body.VX + 3] - state[body.VX : body.VX + 3]
    spun = BOX.solid.inertia * (work.state[body.W :] - state[body.W :])
    in_body = impulse @ work.turn.reshape(3, 3)
    assert won == pytest.approx(impulse.sum(axis=0), abs=1e-12)
    assert spun == pytest.approx(np.cross(corners, in_body).sum(axis=0), abs=1e-12)
    assert np.hypot(*impulse[:, :2].T).max() <= friction * impulse[:, 2].max() + 1e-12


@pytest.mark.parametrize("restitution", [0.0, 0.6, 1.0])
def test_a_frictionless_corner_hit_is_its_closed_form(restitution, rng):
    state, work, count = struck(restitution, 0.0, rng)
    assert count == 1
    lever = np.cross(work.spots[0], work.turn[6:])
    fall = state[body.VZ] + lever @ state[body.W :]
    impulse = -(1.0 + restitution) * fall / (1.0 + lever @ (lever / BOX.solid.inertia))
    assert work.state[body.VZ] == pytest.approx(state[body.VZ] + impulse, rel=1e-9)
    assert work.state[body.W :] == pytest.approx(
        state[body.W :] + impulse * lever / BOX.solid.inertia, rel=1e-9
    )
    if restitution == 1.0:
        before, after = (body.energy(values, BOX.solid.inertia) for values in (state, work.state))
        assert after == pytest.approx(before, rel=1e-9)


@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_a_flat_bounce_rises_to_the_square_of_the_restitution(restitution):
    state, floor = high_up(), -BOX.solid.vertices[:, 2].min()
    state[body.Z] = 2.0 + floor
    trace = traced(BOX, state, restitution, 0.0, Steps(early=False, longest=6.0))
    landed = np.argmax(trace[:, 1 + body.VZ] > 0.0)
    top = (trace[landed:, 1 + body.Z] + 0.5 * trace[landed:, 1 + body.VZ] ** 2).max()
    assert top - floor == pytest.approx(2.0 * restitution**2, rel=0.01)


@pytest.mark.parametrize("resistance", [0.01, 0.02, 0.04])
def test_a_cylinder_rolls_until_its_energy_is_the_work_of_the_lever_of_its_weight(resistance):
    """Rolled by an angle the weight at a lever takes lever times angle: way = energy radius / lever."""
    part = shapes.part(shapes.cylinder(4.0, 30.0, 96))
    shape, length = shape_of_part(part, find(part).ground)
    radius, rate = 4e-3 / length, 0.8
    assert np.argmin(shape.solid.inertia) == 0  # its axis is level as it is drawn
    state = np.zeros(body.STATE)
    state[body.Q], state[body.Z] = 1.0, radius
    state[body.W], state[body.VY] = rate, -rate * radius
    trace = traced(shape, state, 0.0, 0.5, Steps(early=False, rolling=resistance, longest=300.0), 40000)
    energy = 0.5 * shape.solid.inertia[0] * rate**2 + 0.5 * (rate * radius) ** 2
    way = abs(trace[-1, 1 + body.Y] - trace[0, 1 + body.Y])
    assert way == pytest.approx(energy * radius / resistance, rel=0.05)


def run(shape, count, steps=None, seed=3, preset="feed"):
    starts = sample(PRESETS[preset], shape, count, np.random.default_rng(seed))
    faces, times = np.empty(count, int), np.empty(count)
    one_drop.settle_all(shape, scratch(shape), starts.launched(), steps or Steps(), faces, times)
    return faces


def test_when_a_drop_ends():
    early, late = run(BOX, 800), run(BOX, 800, Steps(early=False))
    assert (early == late).mean() >= 0.985
    assert np.abs(np.bincount(early, minlength=6) - np.bincount(late, minlength=6)).max() <= 0.006 * 800
    assert (run(BOX, 20, Steps(most=3)) == one_drop.UNSETTLED).all()
    # Without the early stop: at the turning point of a slow rocking a part stands still, and goes on.
    starts, steps = sample(PRESETS["place"], BOX, 300, np.random.default_rng(3)), Steps(early=False)
    for state, restitution, friction in zip(starts.states, starts.restitutions, starts.frictions):
        work = scratch(BOX)
        work.state[:] = state
        face, _, _ = one_drop.settle(BOX, work, restitution, friction, steps)
        assert body.energy(work.state, BOX.solid.inertia) - BOX.heights[face] < 1e-3 + 1e-9


def test_opposite_sides_are_alike_and_a_turned_file_too():
    turned, _ = drop_bodies.box((1.0, 1.3, 1.7), Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix())
    first, second = (
        np.bincount(run(shape, 3000, seed=seed), minlength=6).reshape(3, 2)
        for shape, seed in ((BOX, 3), (turned, 4))
    )
    for counts in (first, second):
        assert (np.abs(np.diff(counts, axis=1)[:, 0]) < 3.9 * np.sqrt(counts.sum(axis=1))).all()
    both = (first + second).sum(axis=1)
    assert (np.abs((first - second).sum(axis=1)) < 3.9 * np.sqrt(both)).all()


def test_a_body_set_down_rests_where_it_tumbles_to():
    placed = np.bincount(run(BOX, 3000, preset="place") // 2) / 3000
    hull = convex_hull(drop_bodies.CUBE * (1.0, 1.3, 1.7), np.zeros(3))
    angles = solid_angles(np.zeros(3), hull.corners)
    basins = [angles[np.abs(hull.normals[:, k]) > 0.5].sum() / (4 * np.pi) for k in range(3)]
    assert placed == pytest.approx(basins, abs=0.06)


def test_a_cone_whose_drops_never_ended():
    """Turned, in single precision, every facet in sixteen: corners on its straight edges made arcs."""
    part = load(str(DATA / "cone_never_ends.stl"))
    shape, _ = shape_of_part(part, find(part).ground)
    assert len(shape.solid.rims) == 2 and shape.solid.inner.sum() == len(shape.solid.vertices) - 1
    assert (run(shape, 1200, seed=1) != one_drop.UNSETTLED).mean() > 0.99  # the 1,066th never came back


def test_an_arc_that_does_not_hold_what_it_replaces_leaves_no_hole_in_the_body():
    """The lowest point is never higher than the lowest corner, and something touches where it does."""
    rims = np.array([[0.0, 0.0, -0.5, 0.0, 0.0, 1.0, 0.1, 1.0, 0.0, 0.0, 0.9]])
    solid = BOX.solid._replace(rims=rims, inner=np.ones(len(BOX.solid.vertices), bool))
    work = scratch(BOX._replace(solid=solid))
    for turn in Rotation.random(50, random_state=1).as_matrix():
        work.turn[:] = turn.ravel()
        corner, level = body.bottom(solid, work.turn, 0)
        assert level <= (BOX.solid.vertices @ turn[2]).min() + 1e-12
        assert floor_contacts.touching(solid, work, -level, corner, 1e-4) >= 1
    # The middle of a rim that bends down is lower than its ends, which are further out.
    x = np.linspace(-1.0, 1.0, 41)
    points, owners = np.column_stack([x, np.zeros(41), 1e-4 * x**2]), np.arange(41)
    count = floor_contacts.thin_out(points, owners, np.eye(3).ravel(), 41)
    assert owners[0] == 20 and {0, 40} <= set(owners[:count])
    assert points[:, 0] == pytest.approx(x[owners]) and count <= floor_contacts.MAX_CONTACTS


@pytest.mark.parametrize("axis", AXES)
def test_speed_is_the_slope_of_place(axis):
    for angle in 3.0 * np.linspace(0.0, 3.0, 7):
        after, before = (floor_motion.place(ELLIPSE, *axis, angle + 3.0 * step) for step in (1e-6, -1e-6))
        assert floor_motion.speed(ELLIPSE, *axis, angle) == pytest.approx((after - before) / 2e-6, abs=1e-8)


def test_flight_over_a_moving_floor_is_a_parabola_in_the_room():
    """Seen from the room a flying part knows nothing of the floor."""
    work, time = falling.scratch(BOX), 0.4
    work.state[:] = sample(PRESETS["roll"], BOX, 1, np.random.default_rng(2)).states[0]

    def in_the_room(state, time):
        at = 3.0 * time
        place, speed = (
            [motion(ELLIPSE, *AXES[0], at + 0.7), 0.0, motion(ELLIPSE, *AXES[1], at)]
            for motion in (floor_motion.place, floor_motion.speed)
        )
        return state[:3] + place, state[3:6] + speed

    start, speed = in_the_room(work.state, time)
    for dt in (0.03, 0.2, 0.17):
        body.keep(work.state, work.saved)
        falling.gap_after(BOX.solid, work, ELLIPSE, time, 0, dt)
        time += dt
    gone = time - 0.4
    place, now = in_the_room(work.state, time)
    assert place == pytest.approx(start + gone * speed - [0.0, 0.0, 0.5 * gone**2], abs=1e-12)
    assert now == pytest.approx(speed - [0.0, 0.0, gone], abs=1e-12)


def test_a_floor_that_does_not_move_is_the_floor_of_a_drop_test():
    """To the share of drops by which stopping early and running to rest may differ."""
    starts = sample(PRESETS["roll"], BOX, 150, np.random.default_rng(4)).launched()
    faces, times = np.empty(150, int), np.empty(150)
    steps = Steps(early=False, longest=60.0)
    one_drop.settle_all(BOX, falling.scratch(BOX), starts, steps, faces, times)
    looks = shaken.empty_looks(150, np.array([60.0]))
    shaken.ride_all(BOX, falling.scratch(BOX), at_rest(), starts, Steps(), looks, np.inf)
    assert (looks.faces[:, 0] == faces).mean() >= 0.985


def ride(bowl, state, looks, friction):
    """Places (looks, 2) of a plate on a bowl's floor, looked at after some cycles."""
    floor, unit = plate_test.floor_of(bowl, LENGTH), math.sqrt(LENGTH / bowl.gravity)
    work = falling.scratch(PLATE)
    work.state[:] = state
    pairing, steps = falling.Pairing(0.0, friction), plate_test.steps_of(floor)
    record = shaken.ride(PLATE, work, floor, pairing, steps, np.asarray(looks) / 60.0 / unit)
    assert record.taken[0] == len(looks)
    return record.places[0]


def bowl_of(ratio, *more):
    """A level bowl with a peak acceleration of ``ratio`` g along its normal."""
    stroke = ratio * 9.81 / (2.0 * math.pi * 60.0) ** 2 / math.sin(math.radians(20.0))
    own = (
        "drive.frequency=60 Hz", f"drive.amplitude={1e3 * stroke} mm", "drive.vibration_angle=20 deg",
        "track.climb=0 deg", "friction.static=0.4", "restitution=0", *more,
    )  # fmt: skip
    return bowls.record(bowls.settings(path=None, overrides=own))


@pytest.mark.parametrize(
    ("ratio", "more"),
    [
        (0.5, ()), (0.9, ()),
        (1.2, ()),  # hops
        (2.5, ()),  # thrown
        (0.7, ("drive.phase=40 deg",)), (0.7, ("drive.phase=-40 deg",)),
        (0.5, ("drive.second_harmonic=0.15", SECOND)),
        (0.5, ("drive.second_harmonic=0.3", SECOND, "drive.second_harmonic_angle=5 deg")),
    ],
)  # fmt: skip
def test_a_flat_part_travels_like_a_point(ratio, more):
    """At the velocity of a point on the level floor, from event to event."""
    bowl = bowl_of(ratio, *more)
    quickest = 2.0 * math.pi * 60.0 * LENGTH * plate_test.floor_of(bowl, LENGTH).along
    places = (ride(bowl, lying_flat(PLATE, turn), [40.0, 160.0], 0.4) for turn in (0.0, 0.4))
    speeds = [LENGTH * (last[0] - first[0]) / 2.0 for first, last in places]
    assert speeds == pytest.approx([answer.answer(bowl).velocity] * 2, abs=0.012 * quickest)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0)])
def test_a_part_near_its_edge_lies_on_no_face(axis):
    """Tilted almost over the lowest way out, it holds nearly the whole barrier: it may be tipping over."""
    flat, share, work = lying_flat(BOX), shaken.SURE_BARRIER_SHARE, falling.scratch(BOX)
    tipping = []
    for tilt in (0.0, *np.linspace(0.02, 1.5, 40)):
        turn = Rotation.from_rotvec(tilt * np.array(axis)) * Rotation.from_quat(flat[[7, 8, 9, 6]])
        work.state[:] = flat
        work.state[body.Q : body.Q + 4] = turn.as_quat()[[3, 0, 1, 2]]
        corner, gap = falling.start(BOX.solid, work)
        face = shaken.lying(BOX, work.state, work.turn, corner, share)
        level = work.state[body.Z] - gap
        assert tilt or face != one_drop.UNSETTLED
        if face == one_drop.UNSETTLED:
            tipping.append(level - flat[body.Z])
        else:
            assert level - BOX.heights[face] < share * BOX.barriers[face]
    assert tipping and max(tipping) > share * BOX.barriers.min()


def shaped(mesh):
    part = shapes.part(mesh)
    return shape_of_part(part, find(part).ground)


def rims(mesh):
    hull = find(shapes.part(mesh)).ground.hull
    return rims_of(half_edges(hull), hull.radius)


def rounded(radius, sections):
    """Corners of a plate 20 x 12 x 4 mm whose upright edges are rounded, with so many edges a quarter."""
    turn = np.pi / 2 * np.arange(sections + 1) / sections
    corner = radius * np.column_stack([np.cos(turn), np.sin(turn)]) + (10.0 - radius, 6.0 - radius)
    ring = np.concatenate([corner, (corner * (-1, 1))[::-1], corner * (-1, -1), (corner * (1, -1))[::-1]])
    return np.concatenate([np.column_stack([ring, np.full(len(ring), z)]) for z in (-2.0, 2.0)])


ROUNDED = trimesh.convex.convex_hull(rounded(3.0, 6))


def directions(count, rng):
    up = rng.normal(size=(count, 3))
    return up / np.linalg.norm(up, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("mesh", "count", "radius"),
    [
        *((shapes.cylinder(5.0, 8.0, sections), 2, 5.0) for sections in (16, 48, 200)),
        *((shapes.cylinder(5.0, 8.0, sections), 0, None) for sections in (6, 12)),  # flats are meant
        (shapes.box(4.0, 5.0, 6.0), 0, None),
        (ROUNDED, 8, 3.0),
    ],
)
def test_circles_and_arcs_of_a_part(mesh, count, radius):
    arcs = rims(mesh)
    assert len(arcs.table) == count
    if count:
        assert arcs.table[:, RADIUS] == pytest.approx(radius * MM, rel=1e-6)
    if count == 2:
        assert arcs.inner.all() and (arcs.table[:, OPENING] < -1.0).all()
    if count == 8:  # the ends of an arc stay corners
        assert (~arcs.inner).sum() == 16
        assert arcs.table[:, OPENING] == pytest.approx(np.cos(np.pi / 4), abs=1e-6)
        assert np.abs(arcs.table[:, MIDDLE][:, :2]) == pytest.approx(np.sqrt(0.5), abs=1e-6)


@pytest.mark.parametrize(
    ("mesh", "fine"),
    [(CYLINDER, shapes.cylinder(5.0, 8.0, 6000).vertices), (ROUNDED, rounded(3.0, 1500))],
    ids=["cylinder", "plate"],
)
def test_the_lowest_point_is_that_of_a_file_of_many_sections(mesh, fine, rng):
    shape, length = shaped(mesh)
    corners = MM * fine @ principal_axes(shapes.part(mesh).inertia)[1] / length
    turn = np.zeros(9)
    for up in directions(200, rng):
        turn[6:] = up
        assert body.bottom(shape.solid, turn, 0)[1] == pytest.approx((corners @ up).min(), abs=2e-6)


@pytest.mark.parametrize("sections", [16, 64])
def test_heights_and_barriers_are_those_of_the_round_part(sections):
    """A cylinder's side lies at its radius, and tips over a rim at the distance of the rim."""
    shape, length = shaped(shapes.cylinder(5.0, 8.0, sections))
    heights = np.where(shape.rolls, 5.0, 4.0) * MM / length
    assert shape.heights == pytest.approx(heights, rel=1e-6)
    assert shape.barriers + shape.heights == pytest.approx(np.hypot(5.0, 4.0) * MM / length, rel=1e-6)


@pytest.mark.parametrize(("tilt", "points"), [(0.3, 1), (0.0, 4)])
def test_a_tilted_disc_touches_in_one_point_and_a_flat_one_in_four(tilt, points):
    shape = shaped(shapes.cylinder(5.0, 2.0, 40))[0]
    axis = shape.solid.rims[0, 3:6]
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    up = np.cos(tilt) * axis + np.sin(tilt) * across / np.linalg.norm(across)
    work = falling.scratch(shape)
    work.turn[6:] = up
    corner, level = body.bottom(shape.solid, work.turn, 0)
    assert floor_contacts.touching(shape.solid, work, -level, corner, 1e-4) == points
    assert work.spots[:points] @ up == pytest.approx(level, abs=1e-9)
