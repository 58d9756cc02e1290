"""Exact quasi-static tumbling against closed forms, an independent flow and its own invariances."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from feederscrew.errors import MeshError
from feederscrew.geometry import compiled
from feederscrew.geometry.vectors import solid_angles
from feederscrew.output import aspects as aspects_output
from feederscrew.output import tables, tipping_graph
from feederscrew.part.hull import convex_hull
from feederscrew.resting import walks
from feederscrew.resting.aspects import find
from feederscrew.resting.exact_tumbling import _doubts, exact, require_ground, transitions, tumble
from feederscrew.resting.half_edges import half_edges, sinks
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.thesis import parts

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2.0
ONCE = {"max_examples": 300, "deadline": None, "derandomize": True}


def tumbled(points, centre=None):
    """Tumbling of the hull of some points; the centre of mass defaults to their mean."""
    points = np.asarray(points, float)
    return tumble(convex_hull(points, points.mean(axis=0) if centre is None else np.asarray(centre, float)))


def prism(sides, radius, height):
    angles = 2.0 * np.pi * np.arange(sides) / sides
    return [(radius * np.cos(a), radius * np.sin(a), z) for a in angles for z in (-height / 2, height / 2)]


def random_body(seed):
    """Hull of random points of a random form, with a centre of mass anywhere inside."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(rng.integers(4, 60), 3)) * rng.uniform(0.1, 1.0, 3)
    if rng.random() < 0.5:
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    weights = rng.dirichlet(np.full(len(points), rng.choice([0.1, 1.0, 10.0])))
    return points, (0.999 * weights + 0.001 / len(points)) @ points  # strictly inside


def assert_shares(counts, result, slack, sigmas=4.0):
    """Counts of random starts agree with the shares of the sinks."""
    spread = np.sqrt(result.shares * (1 - result.shares) / counts.sum())
    assert (np.abs(counts / counts.sum() - result.shares) < sigmas * spread + slack).all()


@pytest.mark.parametrize("centre", [(0.1, 0.2, 0.3), (0.0, 0.0, -0.49), (0.49, 0.49, 0.49)])
def test_a_loaded_box_rests_by_the_solid_angles_from_its_centre_of_mass(centre):
    hull = convex_hull(CUBE, np.array(centre))
    result = tumble(hull)
    angles = solid_angles(np.zeros(3), hull.corners)
    for normal, share in zip(result.normals, result.shares):
        assert share == pytest.approx(angles[hull.normals @ normal > 0.999].sum() / (4 * np.pi), rel=1e-9)


@pytest.mark.parametrize("height", [1.0, 8.0, 40.0])
@pytest.mark.parametrize("sides", [3, 4, 5, 6, 12, 64])
def test_a_prism_rests_by_its_solid_angles(sides, height):
    """Of a regular polygon from a height over its middle: right triangles about the foot."""
    result, half, h = tumbled(prism(sides, 5.0, height)), np.pi / sides, height / 2
    corner = np.arcsin(h * np.sin(half) / np.hypot(h, 5.0 * np.cos(half)))
    end = 2.0 * sides * (half - corner) / (4 * np.pi)
    flat = np.abs(result.normals[:, 2]) > 0.5
    assert result.shares[flat] == pytest.approx([end, end], rel=1e-9)
    assert result.shares[~flat] == pytest.approx(np.full(sides, (1 - 2 * end) / sides), rel=1e-9)
    assert not result.doubts


def test_a_tetrahedron_that_rolls_off_one_facet():
    result = tumbled([(0, 0, 0), (20, 0, 0), (3, 6, 0), (26, 5, 9)])
    order = np.argsort(result.heights)
    assert result.heights[order] == pytest.approx([1.3112, 1.3340, 1.7603], abs=5e-5)
    assert result.shares[order] == pytest.approx([0.31620, 0.46386, 0.21994], abs=5e-6)


def test_the_t_shape_of_aspect_ratio_0_6():
    centre = (0.0, (25 * 13 * 18.5 + 11 * 12 * 6.0) / (25 * 13 + 11 * 12), 0.0)
    profile = [(-5.5, 0), (5.5, 0), (12.5, 12), (12.5, 25), (-12.5, 25), (-12.5, 12)]
    result = tumbled([(x, y, z) for x, y in profile for z in (-7.5, 7.5)], centre)
    want = {14.8895: 0.04982, 12.5: 0.14184, 10.1105: 0.15331, 12.2532: 0.15712, 7.5: 0.49790}
    for height, share in want.items():
        assert result.shares[np.abs(result.heights - height) < 1e-3].sum() == pytest.approx(share, abs=1e-5)


def test_a_weighted_doll_has_one_sink():
    steps = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    levels = np.linspace(-1.0, 0.3, 30)
    rings = [(np.cos(z) * np.cos(a), np.cos(z) * np.sin(a), np.sin(z)) for z in levels for a in steps]
    result = tumbled([*rings, (0.0, 0.0, 1.6)], (0.0, 0.0, -0.6))
    assert result.shares == pytest.approx([1.0]) and not result.doubts


@given(st.integers(0, 2**31))
@settings(**ONCE)
def test_shares_sum_to_one_and_the_euler_count_holds(seed):
    result = tumbled(*random_body(seed))
    assert result.doubts == ()
    assert result.shares.sum() == pytest.approx(1.0, rel=1e-9)
    assert len(result.sinks) - len(result.pairs) + len(result.maxima) == 2
    assert (result.shares >= 0.0).all()
    assert (result.saddle_heights[:, None] >= result.heights[result.pairs] - 1e-12).all()


@given(st.integers(0, 2**31), st.sampled_from([1.0, 1e-3, 7.0, "finer"]))
@settings(**{**ONCE, "max_examples": 90})
def test_turning_moving_scaling_shuffling_and_more_corners_change_nothing(seed, scale):
    """Sinks, shares, saddles and what they join; more corners lie on facets and edges."""
    points, centre = random_body(seed)
    rng, turn, hull = (
        np.random.default_rng(seed),
        Rotation.random(random_state=seed),
        convex_hull(points, centre),
    )
    if scale == "finer":
        turn, scale = Rotation.identity(), 1.0
        inside = np.einsum("tk,tki->ti", rng.dirichlet(np.ones(3), len(hull.triangles)), hull.corners)
        middles = 0.5 * (hull.corners + np.roll(hull.corners, 1, axis=1)).reshape(-1, 3)
        second = tumbled(np.vstack([hull.vertices, inside, middles]), np.zeros(3))
    else:
        off = rng.uniform(-2.0, 2.0, 3)
        second = tumbled(scale * turn.apply(rng.permutation(points) + off), scale * turn.apply(centre + off))
    first = tumble(hull)
    match = np.argmax(turn.apply(first.normals.copy()) @ second.normals.T, axis=1)
    assert sorted(match) == list(range(len(second.sinks)))
    assert second.shares[match] == pytest.approx(first.shares, abs=1e-7)
    assert second.heights[match] == pytest.approx(scale * first.heights, rel=1e-9)
    assert np.sort(second.saddle_heights) == pytest.approx(scale * np.sort(first.saddle_heights), rel=1e-9)
    ways = [{tuple(sorted(pair)) for pair in pairs.tolist()} for pairs in (match[first.pairs], second.pairs)]
    assert ways[0] == ways[1]
    assert len(second.maxima) == len(first.maxima) and second.doubts == first.doubts == ()


@pytest.mark.parametrize(("seed", "offset"), [(1, 0.0), (5, 0.0), (11, 0.0), (1, 0.5), (5, 0.8)])
def test_an_independent_monte_carlo_of_the_flow(seed, offset):
    """Down directions follow -grad H in small steps: brute force, no hull."""
    rng, steps = np.random.default_rng(seed), 900
    points = rng.normal(size=(9, 3)) * (1.0, 0.7, 0.5)
    points -= points.mean(axis=0) + offset * (points[0] - points.mean(axis=0)) / 2.0  # toward a corner
    down = rng.normal(size=(4000, 3))
    down /= np.linalg.norm(down, axis=1, keepdims=True)
    for k in range(steps):
        lowest = points[np.argmax(down @ points.T, axis=1)]
        slope = lowest - np.einsum("ni,ni->n", lowest, down)[:, None] * down
        length = np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-12)
        down = down - 4e-3 * min(1.0, 3.0 * (1.0 - k / steps)) * slope / length
        down /= np.linalg.norm(down, axis=1, keepdims=True)
    result = tumbled(points, np.zeros(3))
    ends = np.argmax(down @ result.normals.T, axis=1)
    assert_shares(np.bincount(ends, minlength=len(result.sinks)), result, 0.006)


@pytest.mark.parametrize("seed", range(2))
def test_rolls_agree_with_basin_areas(seed):
    hull = convex_hull(*random_body(seed))
    result, lines = tumble(hull), half_edges(hull)
    starts = np.random.default_rng(seed).normal(size=(20000, 3))
    ends = np.empty(len(starts), int)
    rolls = compiled.fitting(walks.rolls, compiled.SMALL + 1)
    rolls(lines, starts / np.linalg.norm(starts, axis=1, keepdims=True), ends)
    counts = np.bincount(np.searchsorted(sinks(lines), ends), minlength=len(result.sinks))
    assert_shares(counts, result, 1e-4, 4.5)


def test_a_failed_check_is_said():
    assert _doubts(np.array([2 * np.pi, 2 * np.pi]), 2, True) == ()
    doubts = _doubts(np.array([2 * np.pi, 3 * np.pi, -0.1]), 1, False)
    assert len(doubts) == 4 and doubts[2] == "sinks - saddles + maxima is 1, not 2"


@pytest.mark.parametrize("seed", range(20))
def test_walks_give_the_same_compiled_and_one_by_one(seed, monkeypatch):
    hull = convex_hull(*random_body(seed))
    together = tumble(hull)
    if seed == 7:
        with monkeypatch.context() as patch:
            patch.setattr(compiled, "SMALL", 0)
            fast = tumble(hull)
        np.testing.assert_allclose(fast.areas, together.areas, rtol=1e-12)
        np.testing.assert_array_equal(fast.pairs, together.pairs)
    monkeypatch.setattr(walks, "trace_saddles_together", walks.trace_saddles)
    singly = tumble(hull)
    np.testing.assert_array_equal(together.areas, singly.areas)
    np.testing.assert_array_equal(together.pairs, singly.pairs)
    assert together.doubts == singly.doubts == ()


# By class of aspect: columns, barriers and the tipping graph.


def everything(mesh, **exponent):
    part = shapes.part(mesh)
    aspects = find(part)
    ground = require_ground(part, aspects)
    return part, aspects, ground, exact(ground, part, aspects, **exponent)


def test_a_box_by_class():
    part, aspects, ground, result = everything(shapes.box(10.0, 20.0, 30.0))
    share = aspects.faces * aspects.solid_angles / (4.0 * np.pi)
    assert result.probabilities["quasistatic"] == pytest.approx(share, rel=1e-9)
    assert [p.sum() for p in result.probabilities.values()] == pytest.approx(
        [1.0] * len(result.probabilities)
    )
    lifts = [np.hypot(10, 20) / 2 - 5, np.hypot(10, 20) / 2 - 10, np.hypot(10, 30) / 2 - 15]
    assert 1e3 * result.barriers == pytest.approx(lifts)
    assert result.barrier_energies == pytest.approx(part.mass * 9.80665 * result.barriers)
    assert np.tan(result.tip_angles) == pytest.approx([20 / 10, 10 / 20, 10 / 30])
    assert not result.doubts
    # The graph is a table.
    study = AspectsStudy(part, aspects)
    frame = tipping_graph.transitions(study)
    assert list(frame) == ["from", "to", "barrier_mm", "barrier_uJ", "axis_x", "axis_y", "axis_z"]
    assert list(zip(frame["from"], frame["to"])) == [(a, b) for a in "ABC" for b in "ABC" if a != b]
    assert np.hypot(np.hypot(frame["axis_x"], frame["axis_y"]), frame["axis_z"]) == pytest.approx(1.0)
    lowest = tables.data_frame(frame).groupby("from")["barrier_mm"].min()
    assert lowest.to_numpy() == pytest.approx(lifts)
    assert aspects_output.aspects(study)["tip_angle_deg"][0] == pytest.approx(np.degrees(np.arctan(2.0)))
    # No arrow of its picture ends under a disc.
    ways = transitions(ground)
    axes = tipping_graph.graph("box", aspects.names, ways, np.array([1.0, 0.0, 0.0])).axes[0]
    discs = {tuple(disc.get_offsets()[0]): np.sqrt(disc.get_sizes()[0]) / 2.0 for disc in axes.collections}
    arrows = [text for text in axes.texts if getattr(text, "arrow_patch", None)]
    assert len(arrows) == 6
    for arrow in arrows:
        assert arrow.arrow_patch.shrinkA > discs[tuple(arrow.xyann)]
        assert arrow.arrow_patch.shrinkB > discs[tuple(arrow.xy)]


def test_the_surface_exponent_reaches_the_column():
    soft, hard = (everything(shapes.box(10, 20, 30), exponent=a)[3] for a in (0.0, 2.0))
    assert soft.probabilities["surface"] == pytest.approx(soft.probabilities["quasistatic"])
    assert hard.probabilities["surface"][0] > soft.probabilities["surface"][0]


@pytest.mark.parametrize("sections", [16, 64, 200])
def test_a_cylinder_rolls_and_stands(sections):
    _, aspects, ground, result = everything(shapes.cylinder(5.0, 20.0, sections))
    end, diagonal = aspects.kinds.index("flat"), np.hypot(10, 5)
    assert result.probabilities["quasistatic"][end] == pytest.approx(1 - 10 / diagonal, rel=1.5 / sections)
    assert 1e3 * result.barriers[end] == pytest.approx(diagonal - 10, rel=2.0 / sections)
    assert len(transitions(ground)) == 2


def test_a_cube_tips_into_its_equals():
    _, _, ground, result = everything(shapes.box(8.0, 8.0, 8.0))
    assert [(way.start, way.end) for way in transitions(ground)] == [(0, 0)]
    assert 1e3 * result.barriers == pytest.approx([np.sqrt(32.0) - 4.0])


def test_noise_and_turning_change_little(rng):
    box = shapes.box(10.0, 20.0, 30.0)
    clean = everything(box)[3]
    for mesh in (shapes.turned(box, rng), shapes.noisy(box.subdivide(), 2e-3, rng)):
        probabilities = everything(mesh)[3].probabilities
        for rule, p in clean.probabilities.items():
            assert probabilities[rule] == pytest.approx(p, abs=0.01), rule


def test_a_heavy_bottom_takes_the_sides_that_a_micrometre_holds():
    """Sides with the foot 0.1 mm from their edge have a barrier of 1 um: the part rolls off them."""
    part = shapes.part(shapes.box(10.0, 10.0, 10.0))
    object.__setattr__(part, "centre_of_mass", np.array([0.0, 0.0, -4.9e-3]))
    aspects = find(part)
    assert aspects.faces.tolist() == [1, 1]
    top = np.arcsin(10.0**2 / (10.0**2 + 4 * 9.9**2)) / np.pi  # its solid angle from 9.9 mm, over the sphere
    assert aspects.probabilities["quasistatic"] == pytest.approx([1.0 - top, top], rel=1e-9)


def test_a_card_has_no_shape():
    card = parts.card("magnet")
    with pytest.raises(MeshError, match=r"is a part card, it has no shape to tumble - give a mesh file$"):
        require_ground(card, find(card))
