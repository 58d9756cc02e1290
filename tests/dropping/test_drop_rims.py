"""Round sides as round sides: the rims of a hull, and drops that do not depend on its sections."""

import numpy as np
import pytest
import shapes
import trimesh

from feederscrew.dropping import ensemble
from feederscrew.dropping.kernel import body, falling, touch
from feederscrew.dropping.launch_conditions import PRESETS
from feederscrew.dropping.rounded_hull import (
    MIDDLE,
    OPENING,
    RADIUS,
    principal_axes,
    rims_of,
    shape_of_part,
)
from feederscrew.resting.aspects import find
from feederscrew.resting.half_edges import half_edges

MM = 1e-3
CYLINDER = shapes.cylinder(5.0, 8.0, 24)


def shaped(mesh):
    """Shape and length."""
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


PLATE = trimesh.convex.convex_hull(rounded(3.0, 6))


def directions(count, rng):
    up = rng.normal(size=(count, 3))
    return up / np.linalg.norm(up, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("mesh", "count", "radius"),
    [
        *((shapes.cylinder(5.0, 8.0, sections), 2, 5.0) for sections in (16, 48, 200)),
        *((shapes.cylinder(5.0, 8.0, sections), 0, None) for sections in (6, 12)),  # flats are meant
        (shapes.box(4.0, 5.0, 6.0), 0, None),
        (PLATE, 8, 3.0),
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
    [(CYLINDER, shapes.cylinder(5.0, 8.0, 6000).vertices), (PLATE, rounded(3.0, 1500))],
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
    assert touch.touching(shape.solid, work, -level, corner, 1e-4) == points
    assert work.spots[:points] @ up == pytest.approx(level, abs=1e-9)


def test_a_coin_lands_alike_whatever_its_sections():
    shares = []
    for sections in (24, 160):
        part = shapes.part(shapes.cylinder(10.0, 9.0, sections))
        aspects = find(part)
        shape, _ = shape_of_part(part, aspects.ground)
        drops = ensemble.drop(shape, PRESETS["feed"], np.random.default_rng(1), count=500)
        p = ensemble.tally(drops, aspects.ground.rows, len(aspects.names)).p
        shares.append(p[np.argmax(aspects.heights)])
    assert shares[0] == pytest.approx(shares[1], abs=4.0 * np.sqrt(2.0 * 0.25 / 500))
