"""The picture of a part on each aspect: what hides what, where things are, one scale."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew.output import aspects, style
from feederscrew.output import shading as shading_output
from feederscrew.resting.aspects import find

LOOKED_AT = True

SIDES = np.array([0.030, 0.020, 0.010])  # [m]
BOX = shapes.part(shapes.box(30, 20, 10), "box")


def moved(rotation, shift):
    """The box, turned and moved."""
    turn = rotation.as_matrix()
    return replace(
        BOX, centre_of_mass=turn @ BOX.centre_of_mass + shift, inertia=turn @ BOX.inertia @ turn.T,
        vertices=BOX.vertices @ turn.T + shift,
    )  # fmt: skip


def cylinder(sections):
    """Corners and facets of a tube without ends, radius 1, and the outward direction at each facet corner."""
    turn = 2.0 * np.pi * np.arange(sections) / sections
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(sections)])
    k, after = np.arange(sections), (np.arange(sections) + 1) % sections
    halves = np.stack([k, after, after + sections], 1), np.stack([k, after + sections, k + sections], 1)
    return np.concatenate([ring, ring + np.array([0.0, 0.0, 2.0])]), np.concatenate(halves)


def standing(part=BOX, row=0):
    solid = shading_output.Rays(part.vertices, part.faces, part.centre_of_mass)
    found = find(part)
    stand = shading_output.stance(solid.points, found.normals[row], found.heights[row] / solid.size)
    return solid, stand, found


def words(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def test_a_ray_meets_the_top_first_and_an_image_covers_the_projected_area():
    solid, stand, _ = standing()
    distances, normals, _ = solid.hits([[0.0, 0.0, 3.0], [0.9, 0.9, 3.0]], [0.0, 0.0, -1.0])
    assert distances[0] == pytest.approx(3.0 - 0.005 / solid.size, rel=1e-6)
    assert normals[0] == pytest.approx([0.0, 0.0, 1.0])
    assert np.isinf(distances[1]) and not normals[1].any()
    step = 0.005
    grid = np.arange(-1.2, 1.2, step)
    depths, _ = stand.camera.cast(solid, grid, grid)
    faces = np.array([SIDES[1] * SIDES[2], SIDES[0] * SIDES[2], SIDES[0] * SIDES[1]]) / solid.size**2
    area = faces @ np.abs(stand.camera.towards_viewer)
    assert np.isfinite(depths).sum() * step**2 == pytest.approx(area, rel=0.01)


def test_the_part_hides_the_back_of_its_contact_polygon_only():
    solid, stand, found = standing()
    polygon = found.polygons[0] / solid.size
    edges = 0.5 * (polygon + np.roll(polygon, -1, axis=0))  # middle of each edge
    seen = stand.camera.sees(solid, edges)
    assert seen[np.argsort(edges @ stand.camera.towards_viewer)].tolist() == [False, False, True, True]
    assert not stand.camera.sees(solid, np.array([[0.0, 0.0, 0.0]]))[0]


def test_the_part_stands_on_the_floor_under_a_camera_that_looks_down():
    solid, stand, _ = standing()
    assert stand.floor_axes @ stand.floor_axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert (solid.points @ stand.floor_axes[2]).min() == pytest.approx(-stand.height, rel=1e-9)
    assert np.abs(stand.floor_axes[0] @ [1.0, 0.0, 0.0]) == pytest.approx(1.0)  # the long side
    camera, up = stand.camera, stand.floor_axes[2]
    frame = np.stack([camera.right, camera.up, camera.towards_viewer])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)
    assert camera.towards_viewer @ up == pytest.approx(np.sin(shading_output.ELEVATION))
    assert camera.up @ up == pytest.approx(np.cos(shading_output.ELEVATION))


@pytest.mark.parametrize("row", [0, 1, 2])
def test_turning_and_moving_the_file_changes_no_outline(row):
    other = moved(Rotation.from_rotvec([0.3, -1.1, 0.6]), (1.0, -2.0, 3.0))
    size, same = (np.diff(standing(part, row)[1].bounds, axis=0) for part in (BOX, other))
    assert same == pytest.approx(size, rel=1e-6)


def test_background_is_paper_the_part_is_not_and_each_face_has_its_own_shade():
    solid, stand, _ = standing()
    image = shading_output.picture(solid, stand, shading_output.Shot(-1.5, -1.5, 0.03, 100, 100))
    assert image.shape == (100, 100, 3) and image.min() >= 0.0 and image.max() <= 1.0
    assert image[0] == pytest.approx(1.0) and image[50, 50].max() < 0.95
    normals = np.array([n for n in (*np.eye(3), *-np.eye(3)) if n @ stand.camera.towards_viewer > 0.0])
    shades = shading_output.lit(normals, stand.camera, shading_output.STEEL_COLOUR).mean(axis=1)
    assert len(shades) == 3 and np.diff(np.sort(shades)).min() > 0.03


def test_a_tessellated_cylinder_is_shaded_round_and_a_coarse_prism_keeps_its_edges(monkeypatch):
    points, faces = cylinder(24)
    normals = shading_output.corner_normals(points, faces)
    radial = points[faces] * [1.0, 1.0, 0.0]
    assert np.einsum("fki,fki->fk", normals, radial).min() > np.cos(np.radians(3.0))
    assert np.ptp(shading_output.corner_normals(*cylinder(8)), axis=1) == pytest.approx(0.0, abs=1e-12)
    monkeypatch.setattr(shading_output, "MOST_FACETS", 10)  # a large mesh is not smoothed
    assert shading_output.corner_normals(points, faces) is None
    solid = shading_output.Rays(points, faces, centre=np.zeros(3))
    _, normals, _ = solid.hits([[3.0, 0.02, 0.3]], [-1.0, 0.0, 0.0])
    assert normals[0, 0] == pytest.approx(np.cos(np.pi / 24), rel=1e-6)


def test_outermost_points_reach_as_far_as_all():
    points = np.random.default_rng(1).normal(size=(50_000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    few = shading_output.outermost(points)
    assert len(few) < 10_000
    assert np.ptp(few, axis=0) == pytest.approx(np.ptp(points, axis=0), rel=0.002)


def test_the_sheet_has_one_panel_a_class_in_one_scale_and_the_recommended_answer_first():
    found = find(BOX)
    answer, figure = found.recommended, aspects.aspect_views(BOX, found, range(3), found.recommended)
    images = [axes for axes in figure.axes if axes.images]
    scales = [np.ptp(axes.images[0].get_extent()[:2]) / axes.get_window_extent().width for axes in images]
    assert scales == pytest.approx([scales[0]] * 3)
    texts = words(figure)
    assert {"A", "B", "C", "flat ×2", "PMI", "CSA", "stability", "box", "centre of mass"} <= set(texts)
    assert all(f"{100.0 * chance[0]:.1f} %" in texts for chance in found.probabilities.values())
    share, low, high = (100.0 * ends[0] for ends in (answer.p, answer.low, answer.high))
    assert f"{share:.0f} % ({low:.0f}–{high:.0f})" in texts
    assert texts.index("recommended") < texts.index("PMI")
    places = [axes.get_position() for axes in images]
    assert all(place.min.min() >= 0.0 and place.max.max() <= 1.0 for place in places)
    assert len({(round(place.x0, 3), round(place.y0, 3)) for place in places}) == 3
    first, second = (style.png(aspects.aspect_views(BOX, found, [2])) for _ in range(2))
    assert first == second


def test_the_scale_bar_is_round_and_true_and_the_axis_of_a_rolling_class_goes_through_the_centre():
    axes = style.figure().add_subplot()
    shading_output.scale_bar(axes, right=500.0, y=0.0, pixel=0.00013)  # [m] a data unit
    left, right = axes.lines[0].get_xdata()
    assert axes.texts[0].get_text() == "10 mm" and (right - left) * 0.13 == pytest.approx(10.0)
    solid, stand, _ = standing()
    axes = style.figure().add_subplot()
    shading_output.rolling_axis(axes, solid, stand, np.full(3, np.nan))
    assert not axes.lines
    shading_output.rolling_axis(axes, solid, stand, np.array([1.0, 0.0, 0.0]))
    x, y = axes.lines[0].get_data()
    assert (x[0], y[0]) == pytest.approx((-x[1], -y[1]))


@pytest.mark.parametrize("name", ["a$b$_{x} 部品 tab\there", "n" * 200])
def test_any_name_of_a_part_can_be_drawn_and_an_open_surface_is_labelled(name):
    figure = aspects.aspect_views(replace(BOX, name=name, open_surface=True), find(BOX), [0])
    assert style.png(figure)
    ends = [text.get_window_extent().x1 for axes in figure.axes for text in axes.texts]
    assert max(ends) <= figure.bbox.width
    assert any("open surface" in text for text in words(figure))
