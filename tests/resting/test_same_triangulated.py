"""What a body rests on depends neither on how its surface is cut into triangles nor on how it is turned."""

import numpy as np
import pytest
import round_bodies
import shapes
import trimesh
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from feederscrew.resting.aspects import find

SPLIT_TWICE = (29, 1)  # of these hulls a pair of facets changed sides with the order of its triangles
BENT = (8, 57)  # of these two facets 20 deg apart were a cone, with an axis from rounding


def solid(triangles):
    return shapes.part(trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles)))


def ellipsoid(seed):
    """A hull of many points on an ellipsoid: facets of a few degrees."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(int(rng.integers(80, 400)), 3))
    points = points / np.linalg.norm(points, axis=1)[:, None] * rng.uniform(5, 20, 3)
    return hull(points)


def cloud(seed):
    """A hull of few points."""
    rng = np.random.default_rng(seed)
    if seed % 4:
        points = rng.uniform(-1, 1, size=(int(rng.integers(8, 80)), 3))
    else:
        points = rng.normal(size=(int(rng.integers(8, 60)), 3))
    return hull(points * rng.uniform(3, 20, 3))


def hull(points):
    return trimesh.Trimesh(points, ConvexHull(points).simplices).convex_hull.triangles


@pytest.mark.parametrize(
    ("triangles", "times"),
    [*((ellipsoid(seed), 2) for seed in SPLIT_TWICE), *((cloud(seed), 1) for seed in BENT)],
    ids=[*(f"ellipsoid-{seed}" for seed in SPLIT_TWICE), *(f"cloud-{seed}" for seed in BENT)],
)
def test_a_body_split_finer_rests_as_before(triangles, times):
    finer = triangles
    for _ in range(times):
        finer = round_bodies.split(finer)
    before, after = find(solid(triangles)), find(solid(finer))
    assert after.kinds == before.kinds
    same = [int(np.argmax(after.normals @ normal)) for normal in before.normals]
    for name in ("contact_areas", "heights", "tip_angles", "solid_angles"):
        np.testing.assert_allclose(
            getattr(after, name)[same], getattr(before, name), rtol=1e-6, atol=0.0, err_msg=name
        )
    for rule in ("csa", "stability", "quasistatic", "pmi"):
        np.testing.assert_allclose(
            after.chances[rule][same], before.chances[rule], rtol=1e-6, atol=1e-12, err_msg=rule
        )


def test_two_planes_that_meet_are_a_bend_and_no_curve():
    assert set(find(solid(cloud(8))).kinds) == {"flat"}


@pytest.mark.parametrize("seed", [9, 31, 86])
def test_the_ends_of_a_coarse_capsule_are_one_class_however_it_is_turned(seed):
    rng = np.random.default_rng(seed)
    straight = round_bodies.revolved(round_bodies.profile("capsule", rng), int(rng.integers(6, 24)))
    before = find(solid(straight))
    for turn in range(2):
        matrix = Rotation.random(random_state=7 * seed + turn).as_matrix()
        turned = find(solid((straight @ matrix.T).astype(np.float32).astype(float)))
        assert turned.kinds == before.kinds == ("rolling", "rolling")
        assert turned.faces.tolist() == before.faces.tolist() == [1, 2]


def ball_with_a_flat(radius, half, rings, sections):
    """Triangles [mm] of a ball with a flat that spans a half-angle [rad] from the middle."""
    turn = np.linspace(0.0, np.pi - half, rings)
    profile = [(radius * np.cos(t), radius * np.sin(t)) for t in turn]
    profile[0] = (radius, 0.0)
    return round_bodies.revolved([(-radius * np.cos(half), 0.0), *profile[::-1]], sections)


@pytest.mark.parametrize(
    ("degrees", "rings", "sections"), [(11.3, 12, 23), (15.37, 11, 19), (8.86, 18, 31), (15.0, 11, 17)]
)
def test_a_flat_hardly_wider_than_the_facets_of_a_regular_ball_is_one(degrees, rings, sections):
    """'Off-centre ball, 100 %': its bend is no 1.5 of theirs, but nothing else of the ball comes near it."""
    half = np.radians(degrees)
    found = find(solid(ball_with_a_flat(5.0, half, rings, sections)))
    assert sorted(found.kinds) == ["flat", "rolling"]
    share = found.probabilities["quasistatic"][found.kinds.index("flat")]
    assert share == pytest.approx(0.5 * (1.0 - np.cos(half)), rel=0.05)


@pytest.mark.parametrize("sections", [17, 20, 23, 32])
def test_a_ball_without_a_flat_has_none(sections):
    turn = np.linspace(0.0, np.pi, sections // 2 + 1)
    profile = [(-5.0 * np.cos(t), 5.0 * np.sin(t)) for t in turn]
    profile[0], profile[-1] = (-5.0, 0.0), (5.0, 0.0)
    assert find(solid(round_bodies.revolved(profile, sections))).kinds == ("rolling",)


@pytest.mark.parametrize(("radius", "flat"), [(5.0, 1.4), (10.0, 2.8)])
def test_a_ball_with_a_small_flat_rests_on_it(radius, flat):
    """'Off-centre ball, 100 %': the flat was taken for one more facet of the ball."""
    found = find(solid(ball_with_a_flat(radius, np.arcsin(flat / radius), 24, 24)))
    assert found.forms == ("ball with a flat", "flat")
    share = 0.5 * (1.0 - np.sqrt(1.0 - (flat / radius) ** 2))  # of the sphere, about its middle
    np.testing.assert_allclose(found.probabilities["quasistatic"][1], share, rtol=0.03, atol=0.0)


@pytest.mark.parametrize(
    ("profile", "sections"),
    [([(0, 0), (0, 2.03), (28.25, 0.79), (28.25, 0)], 44), ([(0, 0), (0, 2.3), (24.0, 0.9), (24.0, 0)], 96)],
)
def test_the_slender_end_of_a_frustum_is_an_aspect_however_it_is_cut(profile, sections):
    """Slivers at the rim of the end took the direction of the side, and the end was no aspect."""
    straight = round_bodies.revolved(profile, sections)
    matrix = Rotation.random(random_state=4900021).as_matrix()
    for triangles in (straight, round_bodies.split(straight), straight @ matrix.T):
        found = find(solid(triangles))
        assert found.forms == ("cone", "flat", "flat")
        assert found.contact_areas[2] == pytest.approx(1e-6 * np.pi * profile[2][1] ** 2, rel=5e-3)
