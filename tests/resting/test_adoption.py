"""Sinks of no face: which faces take them in, and mirror twins that must take the same."""

import numpy as np
import pytest
import shapes
import trimesh
from hypothesis import example, given, settings
from hypothesis import strategies as st

from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.barriers import UNNAMED, adopted_shares
from feederscrew.resting.exact_tumbling import transitions, tumble

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2.0


def box_sides(size, centre=(0.0, 0.0, 0.0)):
    """Tumbling of a box and the label of each sink: 2 k at -x_k, 2 k + 1 at +x_k."""
    tumbling = tumble(convex_hull(CUBE * size, np.array(centre, float)))
    axis = np.argmax(np.abs(tumbling.normals), axis=1)
    return tumbling, 2 * axis + (tumbling.normals[np.arange(6), axis] > 0)


def without(labels, *faces):
    return np.where(np.isin(labels, faces), UNNAMED, labels)


def house(ridge):
    """A house with a ridge that is no resting place; one end slants, so that no turn is a symmetry."""
    outline = [(-6, 0), (6, 0), (9, 8), (ridge, 14), (-ridge, 14), (-9, 8)]
    mesh = shapes.prism(outline, 20.0)
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
    found = find(shapes.part(mesh))
    assert np.isfinite(
        found.ground.tips.heights
    ).all()  # every face holds the facet the part comes to rest on
    mirrored = found.normals * (-1.0, 1.0, 1.0)
    image = np.argmax(mirrored @ found.normals.T, axis=1)
    assert (image[image] == np.arange(len(image))).all()
    assert found.heights[image] == pytest.approx(found.heights, rel=tolerance)
    for rule, chance in found.probabilities.items():
        assert chance.sum() == pytest.approx(1.0, rel=1e-9), rule
        assert chance[image] == pytest.approx(chance, rel=tolerance), rule
    lifts = {(way.start, way.end): way.lift for way in transitions(found.ground)}
    for (start, end), lift in lifts.items():
        assert lifts[image[start], image[end]] == pytest.approx(lift, rel=tolerance)
    return found, np.flatnonzero(image != np.arange(len(image)))


@pytest.mark.parametrize("ridge", [0.02, 0.1])
def test_a_sink_on_a_mirror_plane_is_shared_by_the_twins_beside_it(ridge):
    found, paired = assert_twins_agree(house(ridge), 1e-9)
    assert len(paired) == 4  # both slopes of the roof and both walls
    tumbling = tumble(found.ground.hull)
    top = np.argmax(tumbling.normals[:, 1])
    assert tumbling.normals[top] == pytest.approx([0, 1, 0], abs=1e-9)  # the ridge: a sink, but no aspect
    assert found.ground.labels[tumbling.sinks[top]] == UNNAMED and found.normals[:, 1].max() < 0.9


@given(st.integers(0, 2**32 - 1))
@example(1163)  # the broader of two facets that nearly agree is not the one it rests on
@example(1238)
@example(245)  # a few flat facets that bend gently both ways are no part of a ball
@settings(max_examples=60, deadline=None, derandomize=True)
def test_mirror_twins_are_equally_likely_by_every_rule(seed):
    assert_twins_agree(mirrored_body(seed), 1e-6)


def test_equal_saddles_share_and_a_lower_one_takes_all():
    tumbling, sides = box_sides((1.0, 2.0, 3.0))
    parts = adopted_shares(tumbling, without(sides, 5), 5).toarray()
    assert parts[sides == 5][0] == pytest.approx([0.5, 0.5, 0, 0, 0])
    assert parts[sides != 5] == pytest.approx(np.eye(5)[sides[sides != 5]])
    tumbling, sides = box_sides((1.0, 2.0, 3.0), (0.01, 0.0, 0.0))
    assert adopted_shares(tumbling, without(sides, 5), 5).toarray()[sides == 5][0] == pytest.approx(
        [0, 1, 0, 0, 0]
    )


@pytest.mark.parametrize("gone", [(2, 3, 4, 5), (2, 4, 5), (2, 3, 4), (4, 5)])
def test_what_a_shared_sink_takes_in_is_shared_as_well(gone):
    tumbling, sides = box_sides((2.0, 2.0, 3.0))
    parts = adopted_shares(tumbling, without(sides, *gone), 6)
    shares = tumbling.shares @ parts
    assert shares[0] == pytest.approx(shares[1], rel=1e-12) and shares.sum() == pytest.approx(1.0)


def test_the_same_plain_and_compiled(monkeypatch):
    from feederscrew.geometry import compiled

    rng = np.random.default_rng(3)
    points = rng.normal(size=(60, 3))
    tumbling = tumble(convex_hull(np.vstack([points, points * (-1, 1, 1)]), np.zeros(3)))
    labels = np.where(rng.random(len(tumbling.sinks)) < 0.5, UNNAMED, np.arange(len(tumbling.sinks)))
    plain = adopted_shares(tumbling, labels, len(labels)).toarray()
    assert plain.sum(axis=1) == pytest.approx(1.0) and (plain[labels == UNNAMED] < 0.9).any()
    monkeypatch.setattr(compiled, "SMALL", 0)
    np.testing.assert_array_equal(adopted_shares(tumbling, labels, len(labels)).toarray(), plain)
