"""Round bodies with the noise of single precision: every walk arrives, and the graph is that of a sphere."""

import io
from dataclasses import replace

import numpy as np
import part_files
import pytest
import round_bodies
import trimesh
from fuzz import rounds
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew import bowl
from feederscrew.mechanics import floor_balance
from feederscrew.part import load, mass
from feederscrew.part.hull import convex_hull
from feederscrew.resting import aspects
from feederscrew.resting.exact_tumbling import tumble
from feederscrew.resting.half_edges import facet_borders, half_edges
from feederscrew.resting.posture import posture

# Seeds of bodies that had a doubt, or some of whose walks arrived nowhere.
WENT_WRONG = (11, 80, 83, 161, 174, 209, 299, 100430, 101374, 101382, 102273)
FRUSTA = (15, 18, 24, 54)


def hull_of(triangles):
    triangles = 1e-3 * triangles
    return convex_hull(np.unique(triangles.reshape(-1, 3), axis=0), mass.integrate_solid(triangles).centre)


def assert_sound(triangles):
    result = tumble(hull_of(triangles))
    assert result.doubts == () and (result.pairs >= 0).all()
    assert result.shares.sum() == pytest.approx(1.0, rel=1e-9)
    assert len(result.sinks) - len(result.pairs) + len(result.maxima) == 2


@pytest.mark.parametrize("seed", FRUSTA)
def test_a_turned_frustum_with_every_facet_in_four(seed):
    assert_sound(round_bodies.frustum(seed))
    assert rounds.fault(round_bodies.frustum(seed)) == ""


@pytest.mark.parametrize("seed", WENT_WRONG)
def test_bodies_that_went_wrong_once(seed):
    assert_sound(round_bodies.body(seed))


@given(st.integers(0, 2**31))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_every_round_body_is_sound(seed):
    assert_sound(round_bodies.body(seed))


@pytest.mark.parametrize("seed", range(0, 2000, 250))
def test_round_bodies_from_their_files(seed):
    assert rounds.fault(round_bodies.body(seed)) == ""


@pytest.mark.parametrize("seed", (*FRUSTA[:2], None))
def test_three_facets_at_every_corner_and_three_corners_to_every_facet(seed):
    edges = half_edges(hull_of(round_bodies.frustum(seed)))
    lines = np.flatnonzero(edges.borders)
    at_corners = np.bincount(edges.origins[lines])
    of_facets = np.bincount(edges.facets[lines // 3], minlength=len(edges.normals))
    assert at_corners[at_corners > 0].min() >= 3 and of_facets.min() >= 3
    assert (edges.twins[edges.twins[lines]] == lines).all()
    assert (edges.origins[edges.twins[lines]] == edges.targets[lines]).all()
    assert (edges.origins[edges.ahead[lines]] == edges.targets[lines]).all()
    assert (at_corners > 0).sum() - len(lines) // 2 + len(edges.normals) == 2  # Euler's formula


def test_a_needle_on_an_edge_becomes_part_of_its_neighbour():
    """A tetrahedron with a corner on one edge, and a needle between the edge and the two halves."""
    points = np.array([(0, 0, 0), (2, 0, 0), (1, -1, 2), (1, 2, 0), (1, 0, 0)], float) - (1, 0.3, 0.4)
    hull = convex_hull(points[:4], np.zeros(3))
    triangles = np.array([(0, 4, 2), (4, 1, 2), (0, 1, 4), (1, 0, 3), (1, 3, 2), (0, 2, 3)])
    hull = replace(
        hull,
        vertices=points,
        triangles=triangles,
        normals=np.cross(*np.moveaxis(np.diff(points[triangles], axis=1), 1, 0)),
        areas=np.array([1.0, 1.0, 1e-12, 1.0, 1.0, 1.0]),
    )
    origins, targets = triangles[:, [1, 2, 0]].ravel(), triangles[:, [2, 0, 1]].ravel()
    lines = {(a, b): h for h, (a, b) in enumerate(zip(origins, targets))}
    twins = np.array([lines[b, a] for a, b in zip(origins, targets)])
    found = facet_borders(hull, origins, targets, twins, np.repeat([0, 0, 4, 1, 2, 3], 3))
    assert found.facets.max() == 3 and found.part.sum() == 12
    assert 4 not in origins[found.part] and 4 not in found.targets[found.part]
    assert (found.twins[found.twins[found.part]] == np.flatnonzero(found.part)).all()


def test_a_facet_that_would_not_be_convex_is_left_in_triangles():
    """Two of the four triangles of a box's face are merged to a kite with a reflex corner: not for long."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    hull = convex_hull(np.vstack([corners, [(0.0, 0.0, 1.0 + 1e-3)]]), np.zeros(3))
    edges = half_edges(hull)
    top = np.flatnonzero((hull.triangles == 8).any(axis=1))
    assert len(top) == 4 and len(np.unique(edges.facets[top])) == 4
    facets = edges.facets.copy()
    facets[facets == facets[top[1]]] = facets[top[0]]
    beside = [t for t in hull.neighbours[top[0]] if t in top]
    facets = np.where(np.isin(np.arange(len(facets)), [top[0], *beside]), facets[top[0]], facets)
    origins, targets = hull.triangles[:, [1, 2, 0]].ravel(), hull.triangles[:, [2, 0, 1]].ravel()
    lines = {(a, b): h for h, (a, b) in enumerate(zip(origins, targets))}
    twins = np.array([lines[b, a] for a, b in zip(origins, targets)])
    found = facet_borders(hull, origins, targets, twins, np.repeat(facets, 3))
    assert len(np.unique(found.facets[::3][top])) == 4


def aspects_of(profile, sections=96, finer=0):
    """Part and aspects of a body of revolution about x [mm]."""
    triangles = round_bodies.revolved(profile, sections)
    for _ in range(finer):
        triangles = round_bodies.split(triangles)
    part = load("-", stdin=io.BytesIO(part_files.binary_stl(triangles)))
    return part, aspects.find(part)


def ball(cut=5.0):
    """Profile of a ball of 5 mm, cut off at some place."""
    turn = np.linspace(0.0, np.pi, 61)[1:-1]
    arc = [(-5.0 * np.cos(u), 5.0 * np.sin(u)) for u in turn if -5.0 * np.cos(u) < cut]
    end = [(cut, np.sqrt(25.0 - cut**2)), (cut, 0.0)] if cut < 5.0 else [(5.0, 0.0)]
    return [(-5.0, 0.0), *arc, *end]


@pytest.mark.parametrize("finer", [1, 2])
def test_the_critical_solid_angle_does_not_depend_on_the_triangulation(finer):
    profile = [(0, 0), (0, 10), (14, 7), (14, 0)]
    once, again = (aspects_of(profile, 48, n)[1] for n in (0, finer))
    assert again.names == once.names
    assert again.probabilities["crsa"] == pytest.approx(once.probabilities["crsa"], abs=1e-6)
    assert again.tip_angles == pytest.approx(once.tip_angles, rel=1e-5)


def test_a_part_on_two_circles_stands_and_tips_on_the_line_between_them():
    _, found = aspects_of([(0, 0), (0, 5), (2, 5), (2, 1.5), (10, 1.5), (10, 3.5), (12, 3.5), (12, 0)], 360)
    volumes = np.array([2 * 25.0, 8 * 2.25, 2 * 12.25])
    centre = volumes @ [1.0, 6.0, 11.0] / volumes.sum()
    slope = np.arctan2(1.5, 10.0)
    height = 5.0 * np.cos(slope) - (centre - 2.0) * np.sin(slope)
    to_end = 5.0 * np.sin(slope) + (centre - 2.0) * np.cos(slope)
    row = found.kinds.index("rolling")
    assert found.heights[row] == pytest.approx(1e-3 * height, rel=1e-4)
    assert found.tip_angles[row] == pytest.approx(np.arctan2(to_end, height), rel=1e-4)


def test_a_cone_rolls_in_a_circle_round_its_tip():
    part, found = aspects_of([(0, 0), (0, 5), (12, 0)], 360)
    lying = posture(part, found, found.names[found.kinds.index("rolling")])
    assert lying.rolling_circle == pytest.approx(9e-3 * 12.0 / 13.0, rel=1e-4)
    assert (lying.form, set(found.forms)) == ("cone", {"cone", "flat"})
    part, found = aspects_of([(0, 0), (0, 5), (12, 5), (12, 0)], 360)
    lying = posture(part, found, found.names[found.kinds.index("rolling")])
    assert lying.rolling_circle == np.inf and lying.form == "cylinder"


def test_a_ball_with_a_flat_rests_on_a_point_and_on_the_flat():
    for cut in (1.0, 3.0):
        _, found = aspects_of(ball(cut))
        x = np.linspace(-5.0, cut, 100_001)
        centre = (x * (25.0 - x**2)).sum() / (25.0 - x**2).sum()
        assert sorted(found.kinds) == ["flat", "rolling"]
        row = found.kinds.index("rolling")
        assert np.isnan(found.axes[row]).all()
        assert found.heights[row] == pytest.approx(1e-3 * (5.0 + centre), rel=2e-3)
        assert found.warnings == (
            "a rolling class is the side of a ball with a flat, whose middle is not the centre of mass: it"
            " rests on one point of it and rocks in every direction",
        )
        assert found.forms[row] == "ball with a flat"


@pytest.mark.parametrize(("height", "radius"), [(1.3756, 2.0), (0.75, 2.0), (0.3, 3.0)])
def test_a_flat_in_a_shallow_cone_stays_a_flat(height, radius):
    """A cone and a plane across it touch one ball, but nothing is curved along the cone."""
    triangles = round_bodies.revolved([(0, 0), (0, 5), (3, 5), (3 + height, radius), (3 + height, 0)], 48)
    turn = trimesh.transformations.rotation_matrix(1.1, (0.3, -0.5, 0.8))[:3, :3]
    noisy = part_files.binary_stl(round_bodies.split(triangles) @ turn.T + [7.0, -3.0, 11.0])
    found = aspects.find(load("-", stdin=io.BytesIO(noisy)))
    assert sorted(found.forms) == ["cylinder", "flat", "flat"] and not found.warnings
    assert np.nanmin(found.contact_areas) == pytest.approx(1e-6 * np.pi * radius**2, rel=5e-3)


def test_a_ball_on_the_floor_rolls_with_two_sevenths_of_the_friction_of_sliding():
    part, found = aspects_of(ball())
    settings = bowl.default()
    for heading in (0.0, 1.0):
        now = floor_balance.motion(posture(part, found, "A"), settings, heading)
        push = floor_balance.drive_force(posture(part, found, "A"), settings, heading)
        sliding = np.hypot(push[0], push[1]) / float(now.normal_force)
        assert float(now.limiting_friction) == pytest.approx(2.0 / 7.0 * sliding, rel=2e-3)
        assert floor_balance.MOTION_STATES[int(now.state)] != "tip"
