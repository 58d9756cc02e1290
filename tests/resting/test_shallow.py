"""Facets on which a body stands and that are no aspect: what the published rules make of them is said."""

import re

import numpy as np
import part_files as files
import pytest
import trimesh

from feederscrew.part import load
from feederscrew.resting.aspects import find


def roofed(folder, rise):
    """A box of 20 x 16 x 12 mm whose top is a flat roof of four planes that meet off the middle."""
    low = np.array([[x, y, -6.0] for x in (-10, 10) for y in (-8, 8)])
    high = np.array([[x, y, 6.0] for x in (-10, 10) for y in (-8, 8)])
    ridge = np.array([[-4.0, 0.1, 6.0 + rise], [5.0, 0.1, 6.0 + rise]])
    hull = trimesh.Trimesh(np.concatenate([low, high, ridge])).convex_hull
    return load(files.written(folder, files.obj(np.array(hull.triangles)), "roofed.obj"))


def inside(point, normal, corners):
    """Whether a point of the plane is in a triangle."""
    return all(
        np.cross(q - p, point - p) @ normal >= 0.0 for p, q in zip(corners, np.roll(corners, -1, axis=0))
    )


def by_hand(part):
    """Weights I/h, Q/h and A/h of every plane of the hull with the foot inside, from the triangles alone."""
    hull, rows = part.hull, []
    keys = np.unique(hull.normals.round(6), axis=0, return_inverse=True)[1].ravel()
    for key in range(keys.max() + 1):
        own = np.flatnonzero(keys == key)
        normal, height = hull.normals[own[0]], hull.heights[own[0]]
        if any(inside(height * normal, normal, corners) for corners in hull.corners[own]):
            angle, area = hull.solid_angles[own].sum(), hull.areas[own].sum()
            rows.append((normal @ part.inertia @ normal / height, angle / height, area / height))
    return np.array(rows)


def test_what_the_published_rules_give_with_every_facet(tmp_path):
    part = roofed(tmp_path, 0.6)
    aspects = find(part)
    weights = by_hand(part)
    assert len(weights) > aspects.faces[aspects.stable].sum()  # the part stands on more than it lists
    text = next(line for line in aspects.warnings if "facet" in line)
    for rule, weight in zip(("pmi", "csa", "stability"), weights.T):
        complete = np.sort(weight / weight.sum())
        for chance in aspects.complete[rule] / aspects.faces:  # each class with its share of all facets
            assert np.abs(complete - chance).min() < 1e-6
        change = aspects.probabilities[rule] - aspects.complete[rule]
        name, new, old = re.search(rf"p_{rule} of (\w+) ([\d.]+) for ([\d.]+)", text).groups()
        row = aspects.names.index(name)
        assert float(old) - float(new) == pytest.approx(change[row], abs=1.1e-3)
        assert np.abs(change[row]) == np.abs(change).max()


def test_nothing_is_said_where_every_facet_is_listed(tmp_path):
    part = load(files.written(tmp_path, files.box()))
    aspects = find(part)
    assert not any("facet" in line for line in aspects.warnings)
    for rule, chance in aspects.complete.items():
        np.testing.assert_allclose(chance, aspects.probabilities[rule])


@pytest.mark.parametrize("sections", [12, 24, 64])
def test_strips_of_a_tessellated_curve_are_no_facets_to_stand_on(tmp_path, sections):
    mesh = trimesh.creation.cylinder(5.0, 14.0, sections=sections)
    part = load(files.written(tmp_path, files.obj(np.array(mesh.triangles)), "round.obj"))
    assert not any("facet" in line for line in find(part).warnings)


def test_noise_of_a_file_is_no_facet_to_stand_on(tmp_path, rng):
    mesh = trimesh.creation.box((10, 8, 6)).subdivide().subdivide()
    mesh.vertices = mesh.vertices + rng.normal(size=mesh.vertices.shape) * 1e-3
    part = load(files.written(tmp_path, files.obj(np.array(mesh.triangles)), "noisy.obj"))
    assert not any("facet" in line for line in find(part).warnings)
