"""Exact quasi-static tumbling against closed forms, an independent flow and its own invariances."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from feederscrew.part.hull import convex_hull
from feederscrew.resting.exact_tumbling import tumble

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2.0
ONCE = {"max_examples": 300, "deadline": None, "derandomize": True}


def tumbled(points, centre=None):
    """Tumbling of the hull of some points; the centre of mass defaults to their mean."""
    points = np.asarray(points, float)
    return tumble(convex_hull(points, points.mean(axis=0) if centre is None else np.asarray(centre, float)))


def prism(sides, radius, height):
    angles = 2.0 * np.pi * np.arange(sides) / sides
    return [(radius * np.cos(a), radius * np.sin(a), z) for a in angles for z in (-height / 2, height / 2)]


def rectangle_angle(a, b, h):
    """Solid angle [sr] of an a x b rectangle from height h over its centre."""
    return 4.0 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)))


def random_body(seed):
    """Hull of random points of a random form, with a centre of mass anywhere inside."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(rng.integers(4, 60), 3)) * rng.uniform(0.1, 1.0, 3)
    if rng.random() < 0.5:
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    weights = rng.dirichlet(np.full(len(points), rng.choice([0.1, 1.0, 10.0])))
    return points, (0.999 * weights + 0.001 / len(points)) @ points  # strictly inside


def euler(result):
    return len(result.sinks) - len(result.pairs) + len(result.maxima)


def by_normal(result, direction):
    """Share of the sink whose normal points in a direction."""
    return result.shares[np.argmax(result.normals @ np.asarray(direction))]


@pytest.mark.parametrize("size", [(10, 20, 30), (4, 5, 6), (8, 8, 20), (1, 1, 1)])
def test_a_box_rests_by_its_solid_angles(size):
    result = tumbled(CUBE * size)
    assert len(result.sinks) == 6 and not result.doubts
    for axis in range(3):
        a, b = np.delete(size, axis)
        want = rectangle_angle(a, b, size[axis] / 2) / (4 * np.pi)
        assert by_normal(result, np.eye(3)[axis]) == pytest.approx(want, rel=1e-12)


@pytest.mark.parametrize("centre", [(0.1, 0.2, 0.3), (0.0, 0.0, -0.49), (0.49, 0.49, 0.49)])
def test_a_loaded_box_rests_by_the_solid_angles_from_its_centre_of_mass(centre):
    from feederscrew.geometry.vectors import solid_angles

    hull = convex_hull(CUBE, np.array(centre))
    result = tumble(hull)
    angles = solid_angles(np.zeros(3), hull.corners)
    for normal, share in zip(result.normals, result.shares):
        assert share == pytest.approx(angles[hull.normals @ normal > 0.999].sum() / (4 * np.pi), rel=1e-9)


def test_the_ends_of_a_cylinder():
    for sides, tolerance in ((64, 3e-3), (256, 2e-4)):
        result = tumbled(prism(sides, 5.0, 20.0))
        want = (1.0 - 10.0 / np.hypot(10.0, 5.0)) / 2.0
        assert by_normal(result, (0, 0, 1)) == pytest.approx(want, rel=tolerance)
        assert len(result.sinks) == sides + 2 and not result.doubts


def polygon_angle(sides, apothem, h):
    """Solid angle [sr] of a regular polygon from height h over its middle: right triangles about the foot."""
    half = np.pi / sides
    return 2.0 * sides * (half - np.arcsin(h * np.sin(half) / np.hypot(h, apothem)))


@pytest.mark.parametrize("height", [1.0, 8.0, 40.0])
@pytest.mark.parametrize("sides", [3, 4, 5, 6, 12])
def test_a_prism_rests_by_its_solid_angles(sides, height):
    result = tumbled(prism(sides, 5.0, height))
    end = polygon_angle(sides, 5.0 * np.cos(np.pi / sides), height / 2) / (4 * np.pi)
    flat = np.abs(result.normals[:, 2]) > 0.5
    assert result.shares[flat] == pytest.approx([end, end], rel=1e-9)
    assert result.shares[~flat] == pytest.approx(np.full(sides, (1 - 2 * end) / sides), rel=1e-9)
    assert not result.doubts


def test_a_tetrahedron_that_rolls_off_one_facet():
    result = tumbled([(0, 0, 0), (20, 0, 0), (3, 6, 0), (26, 5, 9)])
    order = np.argsort(result.heights)
    assert result.heights[order] == pytest.approx([1.3112, 1.3340, 1.7603], abs=5e-5)
    assert result.shares[order] == pytest.approx([0.31620, 0.46386, 0.21994], abs=5e-6)


def t_shape(ratio):
    profile = [(-5.5, 0), (5.5, 0), (12.5, 12), (12.5, 25), (-12.5, 25), (-12.5, 12)]
    return [(x, y, z) for x, y in profile for z in (-12.5 * ratio, 12.5 * ratio)]


def test_the_t_shape_of_aspect_ratio_0_6():
    area = 25 * 13 + 11 * 12
    centre = (0.0, (25 * 13 * 18.5 + 11 * 12 * 6.0) / area, 0.0)
    result = tumbled(t_shape(0.6), centre)
    want = {14.8895: 0.04982, 12.5: 0.14184, 10.1105: 0.15331, 12.2532: 0.15712, 7.5: 0.49790}
    for height, share in want.items():
        assert result.shares[np.abs(result.heights - height) < 1e-3].sum() == pytest.approx(share, abs=1e-5)


def test_a_weighted_doll_has_one_sink():
    steps = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    rings = [
        (np.cos(z) * np.cos(a), np.cos(z) * np.sin(a), np.sin(z))
        for z in np.linspace(-1.0, 0.3, 30)
        for a in steps
    ]
    result = tumbled([*rings, (0.0, 0.0, 1.6)], (0.0, 0.0, -0.6))
    assert result.shares == pytest.approx([1.0]) and not result.doubts


@given(st.integers(0, 2**31))
@settings(**ONCE)
def test_shares_sum_to_one_and_the_euler_count_holds(seed):
    result = tumbled(*random_body(seed))
    assert result.doubts == ()
    assert result.shares.sum() == pytest.approx(1.0, rel=1e-9) and euler(result) == 2
    assert (result.shares >= 0.0).all()
    assert (result.saddle_heights[:, None] >= result.heights[result.pairs] - 1e-12).all()


def assert_alike(first, second, turn, scale):
    """The second result is the first, turned and scaled: sinks, shares, saddles and what they join."""
    match = np.argmax(turn.apply(first.normals.copy()) @ second.normals.T, axis=1)
    assert sorted(match) == list(range(len(second.sinks)))
    assert second.shares[match] == pytest.approx(first.shares, abs=1e-7)
    assert second.heights[match] == pytest.approx(scale * first.heights, rel=1e-9)
    assert np.sort(second.saddle_heights) == pytest.approx(scale * np.sort(first.saddle_heights), rel=1e-9)
    ways = [{tuple(sorted(pair)) for pair in pairs.tolist()} for pairs in (match[first.pairs], second.pairs)]
    assert ways[0] == ways[1]
    assert len(second.maxima) == len(first.maxima) and second.doubts == first.doubts == ()


@given(st.integers(0, 2**31), st.sampled_from([1.0, 1e-3, 7.0]))
@settings(**{**ONCE, "max_examples": 60})
def test_turning_moving_scaling_and_shuffling_change_nothing(seed, scale):
    points, centre = random_body(seed)
    rng, turn = np.random.default_rng(seed), Rotation.random(random_state=seed)
    away = rng.uniform(-2.0, 2.0, 3)
    moved = scale * turn.apply(rng.permutation(points) + away), scale * turn.apply(centre + away)
    assert_alike(tumbled(points, centre), tumbled(*moved), turn, scale)


@given(st.integers(0, 2**31))
@settings(**{**ONCE, "max_examples": 40})
def test_more_corners_on_facets_and_edges_change_nothing(seed):
    points, centre = random_body(seed)
    rng, hull = np.random.default_rng(seed), convex_hull(points, centre)
    inside = np.einsum("tk,tki->ti", rng.dirichlet(np.ones(3), len(hull.triangles)), hull.corners)
    middles = 0.5 * (hull.corners + np.roll(hull.corners, 1, axis=1)).reshape(-1, 3)
    finer = tumbled(np.vstack([hull.vertices, inside, middles]), np.zeros(3))
    assert_alike(tumbled(points, centre), finer, Rotation.identity(), 1.0)


def descend(points, directions, step=4e-3, steps=900):
    """Down directions after following -grad H in small steps: brute force, no hull."""
    for k in range(steps):
        lowest = points[np.argmax(directions @ points.T, axis=1)]
        slope = lowest - np.einsum("ni,ni->n", lowest, directions)[:, None] * directions
        length = np.linalg.norm(slope, axis=1, keepdims=True)
        stride = step * min(1.0, 3.0 * (1.0 - k / steps))
        directions = directions - stride * slope / np.maximum(length, 1e-12)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return directions


@pytest.mark.parametrize(("seed", "offset"), [(1, 0.0), (5, 0.0), (11, 0.0), (1, 0.5), (5, 0.8)])
def test_an_independent_monte_carlo_of_the_flow(seed, offset):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(9, 3)) * (1.0, 0.7, 0.5)
    points -= points.mean(axis=0) + offset * (points[0] - points.mean(axis=0)) / 2.0  # toward a corner
    result = tumbled(points, np.zeros(3))
    starts = rng.normal(size=(4000, 3))
    ends = descend(points, starts / np.linalg.norm(starts, axis=1, keepdims=True))
    found = np.bincount(np.argmax(ends @ result.normals.T, axis=1), minlength=len(result.sinks)) / len(ends)
    spread = np.sqrt(result.shares * (1 - result.shares) / len(ends))
    assert (np.abs(found - result.shares) < 4.0 * spread + 0.006).all()


@pytest.mark.parametrize("seed", range(4))
def test_rolls_agree_with_basin_areas(seed):
    from feederscrew.geometry.compiled import SMALL, fitting
    from feederscrew.resting import walks
    from feederscrew.resting.half_edges import half_edges, sinks

    points, centre = random_body(seed)
    hull = convex_hull(points, centre)
    result, edges = tumble(hull), half_edges(hull)
    starts = np.random.default_rng(seed).normal(size=(20000, 3))
    ends = np.empty(len(starts), int)
    rolls = fitting(walks.rolls, SMALL + 1)
    rolls(edges, starts / np.linalg.norm(starts, axis=1, keepdims=True), ends)
    found = np.bincount(np.searchsorted(sinks(edges), ends), minlength=len(result.sinks)) / len(starts)
    spread = np.sqrt(result.shares * (1 - result.shares) / len(starts))
    assert (np.abs(found - result.shares) < 4.5 * spread + 1e-4).all()


def test_a_failed_check_is_said():
    from feederscrew.resting.exact_tumbling import _doubts

    assert _doubts(np.array([2 * np.pi, 2 * np.pi]), 2, True) == ()
    doubts = _doubts(np.array([2 * np.pi, 3 * np.pi, -0.1]), 1, False)
    assert len(doubts) == 4 and doubts[2] == "sinks - saddles + maxima is 1, not 2"


def test_the_walks_give_the_same_plain_and_compiled(monkeypatch):
    from feederscrew.geometry import compiled

    points, centre = random_body(7)
    hull = convex_hull(points, centre)
    plain = tumble(hull)
    monkeypatch.setattr(compiled, "SMALL", 0)
    fast = tumble(hull)
    np.testing.assert_allclose(fast.areas, plain.areas, rtol=1e-12)
    np.testing.assert_array_equal(fast.pairs, plain.pairs)


@pytest.mark.parametrize("seed", range(20))
def test_walks_abreast_give_the_digits_of_walks_one_by_one(seed, monkeypatch):
    from feederscrew.resting import walks

    points, centre = random_body(seed)
    hull = convex_hull(points, centre)
    together = tumble(hull)
    monkeypatch.setattr(walks, "trace_saddles_together", walks.trace_saddles)
    singly = tumble(hull)
    np.testing.assert_array_equal(together.areas, singly.areas)
    np.testing.assert_array_equal(together.pairs, singly.pairs)
    assert together.doubts == singly.doubts == ()
