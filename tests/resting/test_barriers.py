"""Heights, passes and barriers of the hull, the rules built on them, and which faces take in other sinks."""

import numpy as np
import pytest
import shapes
import trimesh
from hypothesis import example, given, settings
from hypothesis import strategies as st

from feederscrew.geometry import compiled
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.barriers import (
    UNNAMED,
    adopted_shares,
    balance,
    barriers,
    critical_solid_angles,
    rises,
    tip_angles,
    tipping,
)
from feederscrew.resting.exact_tumbling import transitions, tumble
from feederscrew.resting.landscape import MIN_BARRIER_SHARE, RIPPLE_OF_RADIUS, edges, landscape, passes

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2.0


def box_sides(size, centre=(0.0, 0.0, 0.0)):
    """Tumbling of a box and the label of each sink: 2 k at -x_k, 2 k + 1 at +x_k."""
    tumbling = tumble(convex_hull(CUBE * size, np.array(centre, float)))
    axis = np.argmax(np.abs(tumbling.normals), axis=1)
    return tumbling, 2 * axis + (tumbling.normals[np.arange(6), axis] > 0)


def box_tipping(size, centre=(0.0, 0.0, 0.0), unnamed=()):
    """Tipping of a box over its sides, but for those without a name."""
    hull = convex_hull(CUBE * size, np.array(centre, float))
    axis = np.argmax(np.abs(hull.normals), axis=1)
    labels = 2 * axis + (hull.normals[np.arange(len(axis)), axis] > 0)
    return tipping(tumble(hull), without(labels, *unnamed))


def without(labels, *faces):
    return np.where(np.isin(labels, faces), UNNAMED, labels)


def tops_of(tips):
    return {tuple(pair): top for pair, top in zip(tips.pairs.tolist(), tips.tops)}


def rectangle(a, b, h, shift=0.0):
    return np.array([(-a, -b, -2 * h), (-a, b, -2 * h), (a, b, -2 * h), (a, -b, -2 * h)]) / 2.0 + [
        0,
        shift,
        0,
    ]


def rectangle_angle(a, b, h):
    return 4.0 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)))


def test_a_box_tips_over_the_middles_of_its_edges():
    a, b, c = size = (10.0, 20.0, 30.0)
    tips = box_tipping(size)
    tops = tops_of(tips)
    assert len(tops) == 12
    want = [np.hypot(a, b) / 2, np.hypot(a, c) / 2, np.hypot(b, c) / 2]
    assert [tops[0, 2], tops[0, 4], tops[3, 5]] == pytest.approx(want)
    lowest = barriers(tips)
    assert lowest[:2] == pytest.approx([np.hypot(a, b) / 2 - a / 2] * 2)
    assert lowest[4:] == pytest.approx([np.hypot(a, c) / 2 - c / 2] * 2)


def test_the_floor_tilts_by_half_the_width_over_the_height():
    for shift, half in ((0.0, 2.0), (1.5, 0.5)):
        assert tip_angles([rectangle(6.0, 4.0, 5.0, shift)], [5.0])[0] == pytest.approx(np.arctan(half / 5.0))
    assert tip_angles([rectangle(6.0, 4.0, 5.0, 2.5)], [5.0])[0] < 0.0


def test_the_critical_solid_angle_of_a_box():
    a, b, h = 3.0, 2.0, 1.2
    want = np.mean([rectangle_angle(a, b, np.hypot(h, side / 2)) for side in (a, a, b, b)])
    q = rectangle_angle(a, b, h)
    assert critical_solid_angles([rectangle(a, b, h)], [h])[0] == pytest.approx((q - want) / q)
    # Of a sheet 4 um thick, read in single precision, it was a division by zero.
    face = 1e-3 * np.array([[10.0, 0.0, 2.0], [-10.0, 0.0, 2.0], [-10.0, 0.0, -2.0], [10.0, 0.0, -2.0]])
    assert (critical_solid_angles([face, face[::-1]], [2e-6, 2e-6]) == 0.0).all()


def test_in_balance_as_much_tips_into_each_face_as_out_of_it():
    tips = box_tipping((3.0, 4.0, 5.0), (0.4, -0.3, 0.2))
    shares, net = balance(tips), np.zeros(6)
    for (i, j), (from_i, from_j) in zip(tips.pairs, rises(tips)):
        over = shares[i] / from_i - shares[j] / from_j
        net[i], net[j] = net[i] - over, net[j] + over
    assert net == pytest.approx(np.zeros(6), abs=1e-9)
    assert shares.sum() == pytest.approx(1.0) and shares.argmax() == np.nanargmin(tips.heights)


def test_an_unnamed_sink_joins_the_face_behind_its_lowest_saddle():
    size, centre = (1.0, 2.0, 3.0), (0.01, 0.0, 0.0)
    full, some = box_tipping(size, centre), box_tipping(size, centre, [5])
    assert some.shares[:5] - full.shares[:5] == pytest.approx([0, full.shares[5], 0, 0, 0], abs=1e-12)
    with pytest.raises(ValueError, match="no sink"):
        box_tipping(size, unnamed=range(6))


def test_faces_that_share_a_sink_tip_over_its_saddles_alike():
    tips = box_tipping((1.0, 2.0, 3.0), unnamed=[5])
    tops = tops_of(tips)
    assert tops[0, 1] == pytest.approx(np.hypot(1, 3) / 2)  # over the end that both share
    assert tops[0, 2] == tops[1, 2] == pytest.approx(np.hypot(1, 2) / 2)
    assert rises(tips).shape == (len(tops), 2) and barriers(tips)[0] == pytest.approx(barriers(tips)[1])


def test_a_part_with_one_face_cannot_tip():
    hull = convex_hull(CUBE, np.zeros(3))
    tips = tipping(tumble(hull), np.zeros(len(hull.triangles), int))
    assert len(tips.pairs) == 0 and np.isinf(barriers(tips)).all()
    assert balance(tips) == pytest.approx([1.0]) and tips.shares == pytest.approx([1.0])


# Sinks of no face: which faces take them in, and mirror twins that must take the same.


def house(ridge):
    """A house with a ridge that is no resting place; one end slants, so that no turn is a symmetry."""
    mesh = shapes.prism([(-6, 0), (6, 0), (9, 8), (ridge, 14), (-ridge, 14), (-9, 8)], 20.0)
    mesh.vertices[:, 2] += np.where(mesh.vertices[:, 2] > 0, 0.1 * mesh.vertices[:, 1], 0.0)
    return mesh


def mirrored_body(seed):
    """A convex body with x -> -x its only symmetry, and ridges along the mirror plane blunted a little."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(rng.integers(3, 12), 3)) * rng.uniform(0.5, 1.0, 3)
    ridge = rng.normal(size=(rng.integers(2, 6), 3)) * (0.0, 1.5, 1.5)
    ridge[:, 0] = rng.choice([3e-3, 6e-3, 1e-2])
    half = 10.0 * np.vstack([points, ridge])
    return trimesh.convex.convex_hull(np.vstack([half, half * (-1.0, 1.0, 1.0)]))


def assert_twins_agree(mesh, tolerance):
    """Every aspect and its mirror image have equal chances by every rule, and equal barriers to equals."""
    resting = find(shapes.part(mesh))
    tips = resting.ground.tips
    assert np.isfinite(tips.heights).all()  # every face holds the facet the part comes to rest on
    image = np.argmax((resting.normals * (-1.0, 1.0, 1.0)) @ resting.normals.T, axis=1)
    assert (image[image] == np.arange(len(image))).all()
    assert resting.heights[image] == pytest.approx(resting.heights, rel=tolerance)
    for rule, chance in resting.probabilities.items():
        assert chance.sum() == pytest.approx(1.0, rel=1e-9), rule
        assert chance[image] == pytest.approx(chance, rel=tolerance), rule
    lifts = {(way.start, way.end): way.lift for way in transitions(resting.ground)}
    for (start, end), lift in lifts.items():
        assert lifts[image[start], image[end]] == pytest.approx(lift, rel=tolerance)
    return resting, np.flatnonzero(image != np.arange(len(image)))


@pytest.mark.parametrize("ridge", [0.02, 0.1])
def test_a_sink_on_a_mirror_plane_is_shared_by_the_twins_beside_it(ridge):
    resting, paired = assert_twins_agree(house(ridge), 1e-9)
    assert len(paired) == 4  # both slopes of the roof and both walls
    tumbling = tumble(resting.ground.hull)
    top = np.argmax(tumbling.normals[:, 1])
    assert tumbling.normals[top] == pytest.approx([0, 1, 0], abs=1e-9)  # the ridge: a sink, but no aspect
    assert resting.ground.labels[tumbling.sinks[top]] == UNNAMED and resting.normals[:, 1].max() < 0.9


@given(st.integers(0, 2**32 - 1))
@example(1163)  # the broader of two facets that nearly agree is not the one it rests on
@example(1238)
@example(245)  # a few flat facets that bend gently both ways are no part of a ball
@settings(max_examples=60, deadline=None, derandomize=True)
def test_mirror_twins_are_equally_likely_by_every_rule(seed):
    assert_twins_agree(mirrored_body(seed), 1e-6)


@pytest.mark.parametrize(("off", "want"), [(0.0, [0.5, 0.5, 0, 0, 0]), (0.01, [0, 1, 0, 0, 0])])
def test_equal_saddles_share_and_a_lower_one_takes_all(off, want):
    tumbling, sides = box_sides((1.0, 2.0, 3.0), (off, 0.0, 0.0))
    parts = adopted_shares(tumbling, without(sides, 5), 5).toarray()
    assert parts[sides == 5][0] == pytest.approx(want)
    assert parts[sides != 5] == pytest.approx(np.eye(5)[sides[sides != 5]])


@pytest.mark.parametrize("gone", [(2, 3, 4, 5), (2, 4, 5), (2, 3, 4), (4, 5)])
def test_what_a_shared_sink_takes_in_is_shared_as_well(gone):
    tumbling, sides = box_sides((2.0, 2.0, 3.0))
    shares = tumbling.shares @ adopted_shares(tumbling, without(sides, *gone), 6)
    assert shares[0] == pytest.approx(shares[1], rel=1e-12) and shares.sum() == pytest.approx(1.0)


def test_the_same_plain_and_compiled(monkeypatch):
    rng = np.random.default_rng(3)
    points = rng.normal(size=(60, 3))
    tumbling = tumble(convex_hull(np.vstack([points, points * (-1, 1, 1)]), np.zeros(3)))
    labels = np.where(rng.random(len(tumbling.sinks)) < 0.5, UNNAMED, np.arange(len(tumbling.sinks)))
    plain = adopted_shares(tumbling, labels, len(labels)).toarray()
    assert plain.sum(axis=1) == pytest.approx(1.0) and (plain[labels == UNNAMED] < 0.9).any()
    monkeypatch.setattr(compiled, "SMALL", 0)
    np.testing.assert_array_equal(adopted_shares(tumbling, labels, len(labels)).toarray(), plain)


# Heights, passes and basins of the hull.


def hull_of(mesh):
    return convex_hull(mesh.vertices, mesh.center_mass)


def test_a_box_has_the_passes_of_its_edges():
    hull = hull_of(shapes.box(2, 4, 6))
    pairs, ends = edges(hull)
    assert len(pairs) == 18  # 12 edges and 6 diagonals
    sharp = np.abs(np.einsum("ei,ei->e", hull.normals[pairs[:, 0]], hull.normals[pairs[:, 1]])) < 0.5
    tops = np.unique(np.round(passes(hull, pairs, ends)[sharp], 9))
    np.testing.assert_allclose(tops, [np.sqrt(5), np.sqrt(10), np.sqrt(13)])


@pytest.mark.parametrize(
    ("mesh", "sinks"),
    [
        *((shapes.cylinder(5, 20, sections), sections + 2) for sections in (6, 12, 14, 16)),  # every strip
        *((shapes.cylinder(5, 20, sections), 3) for sections in (64, 256, 500)),  # the ripple merges
        (shapes.box(1, 1, 60), 6),  # a slender pin keeps its ends
    ],
)
def test_basins_that_are_no_ripple_are_kept(mesh, sinks):
    ground = landscape(hull_of(mesh))
    assert len(ground.sinks) == sinks
    if sinks == 18:
        np.testing.assert_allclose(ground.rises, 1 / np.cos(np.pi / 16) - 1)
        np.testing.assert_allclose(ground.bends, np.pi / 8)


def test_an_unstable_end_belongs_to_the_basin_it_rolls_into():
    leaning = hull_of(shapes.prism([(0, 0), (10, 0), (40, 20), (30, 20)], 8))  # too far for its short side
    ground = landscape(leaning)
    assert not np.any(leaning.normals[ground.sinks] @ [0, -1, 0] > 0.999)
    assert set(np.unique(ground.basins)) == set(ground.sinks)


def keel(chamfer=0.0):
    """A bar standing on a strip 0.6 wide whose sides leave at 40 deg, its centre of mass 5 over it.

    The way over the strip's edge rises by less than a ripple may, but it is sharp.
    """
    outwards = np.array([np.cos(np.radians(40)), np.sin(np.radians(40))])
    edge = np.array([0.3, -5.0])
    corner = [edge] if chamfer == 0.0 else [edge - (chamfer, 0.0), edge + chamfer * outwards]
    right = np.array([*corner, edge + 4 * outwards, (edge[0] + 4 * outwards[0], 5.0)])
    return shapes.prism(np.vstack([right, right[::-1] * (-1, 1)]), 20.0)


@pytest.mark.parametrize("chamfer", [0.0, 1e-6, 1e-4, 5e-3, *(f"noise {seed}" for seed in range(8))])
def test_a_sharp_edge_with_a_low_barrier_parts_two_faces(chamfer):
    """A chamfer too small to see leaves it sharp, and so do slivers that noise leaves at the edge."""
    if isinstance(chamfer, str):
        rng = np.random.default_rng(int(chamfer[-1]))
        mesh = shapes.noisy(shapes.subdivided(keel(), 1), 1e-4, rng)
    else:
        mesh = keel(chamfer)
    hull = convex_hull(mesh.vertices, np.zeros(3))
    rise = np.hypot(0.3, 5.0) - 5.0
    assert MIN_BARRIER_SHARE * hull.radius < rise < RIPPLE_OF_RADIUS * hull.radius
    ground = landscape(hull)
    assert len(ground.sinks) == 8
    assert hull.normals[ground.sinks, 1].min() < -0.999  # it stands on its keel
