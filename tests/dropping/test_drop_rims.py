"""Round sides as round sides: the rims of a hull, and drops that do not depend on its sections."""

import numpy as np
import pytest
import shapes
import trimesh
from scipy.spatial.transform import Rotation

from feederscrew.dropping import ensemble
from feederscrew.dropping.kernel import body, falling, touch
from feederscrew.dropping.kernel.floor_motion import at_rest
from feederscrew.dropping.kernel.one_drop import Steps
from feederscrew.dropping.launch_conditions import PRESETS
from feederscrew.dropping.rounded_hull import (
    MIDDLE,
    OPENING,
    RADIUS,
    lowest_on,
    principal_axes,
    rims_of,
    shape_of_part,
)
from feederscrew.resting.aspects import find
from feederscrew.resting.half_edges import half_edges

MM = 1e-3


def shaped(mesh):
    """Part, its ground, its shape and length."""
    part = shapes.part(mesh)
    found = find(part).ground
    return part, found, *shape_of_part(part, found)


def rims(mesh):
    """Rims of a mesh."""
    hull = find(shapes.part(mesh)).ground.hull
    return rims_of(half_edges(hull), hull.radius)


def cylinder(radius, height, sections):
    return trimesh.creation.cylinder(radius, height, sections=sections)


def rounded(radius, sections):
    """Corners of a plate 20 x 12 x 4 mm whose upright edges are rounded, with so many edges a quarter."""
    turn = np.pi / 2 * np.arange(sections + 1) / sections
    corner = radius * np.column_stack([np.cos(turn), np.sin(turn)]) + (10.0 - radius, 6.0 - radius)
    quarters = [corner, (corner * (-1, 1))[::-1], corner * (-1, -1), (corner * (1, -1))[::-1]]
    ring = np.concatenate(quarters)
    return np.concatenate([np.column_stack([ring, np.full(len(ring), z)]) for z in (-2.0, 2.0)])


@pytest.mark.parametrize("sections", [16, 48, 200])
def test_a_cylinder_has_two_circles(sections):
    found = rims(cylinder(5.0, 8.0, sections))
    assert len(found.table) == 2 and found.inner.all()
    assert found.table[:, RADIUS] == pytest.approx(5.0 * MM, rel=1e-6)
    assert (found.table[:, OPENING] < -1.0).all()


def test_flats_are_meant_and_no_circle():
    assert len(rims(cylinder(5.0, 8.0, 6)).table) == len(rims(cylinder(5.0, 8.0, 12)).table) == 0
    assert len(rims(shapes.box(4.0, 5.0, 6.0)).table) == 0


def test_a_rounded_plate_has_arcs_whose_ends_stay_corners():
    found = rims(trimesh.convex.convex_hull(rounded(3.0, 6)))
    assert len(found.table) == 8 and (~found.inner).sum() == 16
    assert found.table[:, RADIUS] == pytest.approx(3.0 * MM, rel=1e-6)
    assert found.table[:, OPENING] == pytest.approx(np.cos(np.pi / 4), abs=1e-6)
    assert np.abs(found.table[:, MIDDLE][:, :2]) == pytest.approx(np.sqrt(0.5), abs=1e-6)


@pytest.mark.parametrize(
    ("mesh", "fine"),
    [
        (cylinder(5.0, 8.0, 24), cylinder(5.0, 8.0, 6000).vertices),
        (trimesh.convex.convex_hull(rounded(3.0, 6)), rounded(3.0, 1500)),
    ],
)
def test_the_lowest_point_is_that_of_a_file_of_many_sections(mesh, fine, rng):
    _, _, shape, length = shaped(mesh)
    principal = principal_axes(shapes.part(mesh).inertia)[1]
    corners = MM * fine @ principal / length
    up = rng.normal(size=(200, 3))
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    turn = np.zeros(9)
    for one in up:
        turn[6:] = one
        assert body.bottom(shape.solid, turn, 0)[1] == pytest.approx((corners @ one).min(), abs=2e-6)


def test_compiled_and_array_lowest_points_agree(rng):
    shape = shaped(cylinder(5.0, 8.0, 24))[2]
    up = rng.normal(size=(50, 3))
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    lows, turn = np.einsum("ni,nri->nr", up, lowest_on(shape, up)), np.zeros(9)
    for one, low in zip(up, lows):
        turn[6:] = one
        assert [body.rim_level(shape.solid.rims, k, turn) for k in (0, 1)] == pytest.approx(low, abs=1e-12)


@pytest.mark.parametrize("sections", [16, 64])
def test_heights_and_barriers_are_those_of_the_round_part(sections):
    """A cylinder's side lies at its radius, and tips over a rim at the distance of the rim."""
    _, _, shape, length = shaped(cylinder(5.0, 8.0, sections))
    rolling = shape.rolls
    top = np.hypot(5.0, 4.0) * MM / length
    assert shape.heights[rolling] == pytest.approx(5.0 * MM / length, rel=1e-6)
    assert shape.heights[~rolling] == pytest.approx(4.0 * MM / length, rel=1e-6)
    assert shape.barriers + shape.heights == pytest.approx(top, rel=1e-6)


def test_a_cone_lies_on_the_side_of_its_true_circle():
    mesh = trimesh.creation.cone(5.0, 10.0, sections=32)
    _, _, shape, length = shaped(mesh)
    slope = np.arctan2(5.0, 10.0)
    side = 7.5 * np.sin(slope) * MM / length  # distance from the centre, a quarter up, to the side
    assert shape.heights[shape.rolls] == pytest.approx(side, rel=2e-3)  # the file's centre, not the cone's


@pytest.mark.parametrize(("tilt", "points"), [(0.3, 1), (0.0, 4)])
def test_a_tilted_disc_touches_in_one_point_and_a_flat_one_in_four(tilt, points):
    shape = shaped(cylinder(5.0, 2.0, 40))[2]
    axis = shape.solid.rims[0, 3:6]
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    up = np.cos(tilt) * axis + np.sin(tilt) * across / np.linalg.norm(across)
    work = falling.scratch(shape)
    work.turn[6:] = up
    corner, level = body.bottom(shape.solid, work.turn, 0)
    count = touch.touching(shape.solid, work, -level, corner, 1e-4)
    assert count == points
    assert work.spots[:count] @ up == pytest.approx(level, abs=1e-9)


def share_on_edge(sections, drops=500):
    part = shapes.part(cylinder(10.0, 9.0, sections))
    aspects = find(part)
    shape, _ = shape_of_part(part, aspects.ground)
    done = ensemble.drop(shape, PRESETS["feed"], np.random.default_rng(1), count=drops)
    counted = ensemble.tally(done, aspects.ground.rows, len(aspects.names))
    return counted.p[np.argmax(aspects.heights)]


def test_a_coin_lands_alike_whatever_its_sections():
    few, many = share_on_edge(24), share_on_edge(160)
    assert few == pytest.approx(many, abs=4.0 * np.sqrt(2.0 * 0.25 / 500))


def test_a_disc_that_rolls_upright_keeps_its_energy_and_goes_straight():
    """Both rims touch; without resistance nothing slows it."""
    shape = shaped(cylinder(5.0, 2.0, 32))[2]
    axis = int(np.argmax(np.abs(shape.solid.rims[0, 3:6])))
    work = falling.scratch(shape)
    order = [axis, (axis + 1) % 3, (axis + 2) % 3]
    turn = np.eye(3)[order]  # the disc's axis along the floor's x
    work.state[body.Q : body.Q + 4] = np.roll(Rotation.from_matrix(turn).as_quat(), 1)
    radius, rate = shape.solid.rims[0, RADIUS], 2.0
    work.state[body.Z] = radius
    work.state[body.W + axis], work.state[body.VY] = rate, -rate * radius
    before = body.energy(work.state, shape.inertia)
    corner, gap = falling.start(shape.solid, work)
    time, steps = 0.0, Steps(rolling=0.0, pivot=0.0)
    while time < 5.0:
        corner, gap, dt, count, _ = falling.advance(
            shape.solid, work, at_rest(), time, corner, gap, falling.Pairing(0.3, 0.4), steps
        )
        time += dt
        assert count == 2
    assert body.energy(work.state, shape.inertia) == pytest.approx(before, rel=1e-6)
    assert work.state[1] == pytest.approx(-rate * radius * time, rel=1e-6)
