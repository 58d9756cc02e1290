"""The picture of a part on each aspect: what hides what, where things are, one scale."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from feederscrew.output import aspects, style
from feederscrew.output import shading as shading_output
from feederscrew.part.record import Part
from feederscrew.resting.aspects import find

LOOKED_AT = True

CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])
SIDES = np.array([0.030, 0.020, 0.010])  # [m]


def box(rotation=None, shift=(0.0, 0.0, 0.0)):
    """A homogeneous steel box of 30 x 20 x 10 mm, turned and moved."""
    turn = np.eye(3) if rotation is None else rotation.as_matrix()
    mass = 7850.0 * SIDES.prod()
    inertia = np.diag(mass / 12.0 * ((SIDES**2).sum() - SIDES**2))
    return Part(
        name="box", source="box.stl", sha256="0", units="mm", material="steel", density=7850.0,
        volume=SIDES.prod(), mass=mass, centre_of_mass=np.asarray(shift), inertia=turn @ inertia @ turn.T,
        vertices=CORNERS * SIDES @ turn.T + shift, faces=FACES,
    )  # fmt: skip


def cylinder(sections):
    """Corners and facets of a tube without ends, radius 1, and the outward direction at each facet corner."""
    turn = 2.0 * np.pi * np.arange(sections) / sections
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(sections)])
    k, after = np.arange(sections), (np.arange(sections) + 1) % sections
    faces = np.concatenate(
        [np.stack([k, after, after + sections], 1), np.stack([k, after + sections, k + sections], 1)]
    )
    return np.concatenate([ring, ring + np.array([0.0, 0.0, 2.0])]), faces


def solid_of(part):
    return shading_output.Rays(part.vertices, part.faces, part.centre_of_mass)


def standing(part, row=0):
    solid, found = solid_of(part), find(part)
    return (
        solid,
        shading_output.stance(solid.points, found.normals[row], found.heights[row] / solid.size),
        found,
    )


def test_a_ray_meets_the_top_first():
    solid = solid_of(box())
    distances, normals, _ = solid.hits([[0.0, 0.0, 3.0], [0.9, 0.9, 3.0]], [0.0, 0.0, -1.0])
    assert distances[0] == pytest.approx(3.0 - 0.005 / solid.size, rel=1e-6)
    assert normals[0] == pytest.approx([0.0, 0.0, 1.0])
    assert np.isinf(distances[1])
    assert not normals[1].any()


def test_the_image_covers_the_projected_area():
    solid, stand, _ = standing(box())
    step = 0.005
    grid = np.arange(-1.2, 1.2, step)
    depths, _ = stand.camera.cast(solid, grid, grid)
    faces = np.array([SIDES[1] * SIDES[2], SIDES[0] * SIDES[2], SIDES[0] * SIDES[1]]) / solid.size**2
    assert np.isfinite(depths).sum() * step**2 == pytest.approx(
        faces @ np.abs(stand.camera.towards_viewer), rel=0.01
    )


def test_the_part_hides_the_back_of_its_contact_polygon_only():
    solid, stand, found = standing(box())
    polygon = found.polygons[0] / solid.size
    edges = 0.5 * (polygon + np.roll(polygon, -1, axis=0))  # middle of each edge
    nearness = edges @ stand.camera.towards_viewer
    seen = stand.camera.sees(solid, edges)
    assert seen[np.argsort(nearness)].tolist() == [False, False, True, True]
    assert not stand.camera.sees(solid, np.array([[0.0, 0.0, 0.0]]))[0]


def test_the_part_stands_on_the_floor():
    solid, stand, _ = standing(box())
    up = stand.floor_axes @ stand.floor_axes.T
    assert up == pytest.approx(np.eye(3), abs=1e-12)
    assert (solid.points @ stand.floor_axes[2]).min() == pytest.approx(-stand.height, rel=1e-9)
    assert np.abs(stand.floor_axes[0] @ [1.0, 0.0, 0.0]) == pytest.approx(1.0)  # the long side


def test_the_camera_is_a_right_handed_frame_that_looks_down():
    _, stand, _ = standing(box())
    frame = np.stack([stand.camera.right, stand.camera.up, stand.camera.towards_viewer])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)
    assert stand.camera.towards_viewer @ stand.floor_axes[2] == pytest.approx(
        np.sin(shading_output.ELEVATION)
    )
    assert stand.camera.up @ stand.floor_axes[2] == pytest.approx(np.cos(shading_output.ELEVATION))


@pytest.mark.parametrize("row", [0, 1, 2])
def test_turning_and_moving_the_file_changes_no_outline(row):
    turn = Rotation.from_rotvec([0.3, -1.1, 0.6])
    plain, turned = standing(box(), row)[1], standing(box(turn, (1.0, -2.0, 3.0)), row)[1]
    size = np.diff(plain.bounds, axis=0)
    assert np.diff(turned.bounds, axis=0) == pytest.approx(size, rel=1e-6)


def test_background_is_paper_and_the_part_is_not():
    solid, stand, _ = standing(box())
    frame = shading_output.Shot(-1.5, -1.5, 0.03, 100, 100)
    image = shading_output.picture(solid, stand, frame)
    assert image.shape == (100, 100, 3)
    assert image[0] == pytest.approx(1.0)
    assert image[50, 50].max() < 0.95
    assert (image.min(), image.max()) >= (0.0, 0.0)
    assert image.max() <= 1.0


def test_each_face_of_a_box_has_its_own_shade():
    _, stand, _ = standing(box())
    normals = np.array([n for n in (*np.eye(3), *-np.eye(3)) if n @ stand.camera.towards_viewer > 0.0])
    shades = shading_output.lit(normals, stand.camera, shading_output.STEEL_COLOUR).mean(axis=1)
    assert len(shades) == 3
    assert np.diff(np.sort(shades)).min() > 0.03


def test_the_floor_is_darkest_under_the_part():
    solid, stand, _ = standing(box())
    shadow, _, _ = shading_output._shadow(solid, stand)
    middle = shading_output.FLOOR_GRID // 2
    assert shadow[middle, middle] == pytest.approx(shading_output.SHADE, rel=0.05)
    assert shadow[0, 0] < 0.02 * shading_output.SHADE


def test_a_tessellated_cylinder_is_shaded_round():
    points, faces = cylinder(24)
    normals = shading_output.corner_normals(points, faces)
    radial = points[faces] * [1.0, 1.0, 0.0]
    assert np.einsum("fki,fki->fk", normals, radial).min() > np.cos(np.radians(3.0))


def test_a_coarse_prism_keeps_its_edges():
    points, faces = cylinder(8)
    normals = shading_output.corner_normals(points, faces)
    assert np.ptp(normals, axis=1) == pytest.approx(0.0, abs=1e-12)


def test_a_large_mesh_is_not_smoothed(monkeypatch):
    monkeypatch.setattr(shading_output, "MOST_FACETS", 10)
    assert shading_output.corner_normals(*cylinder(24)) is None
    solid = shading_output.Rays(*cylinder(24), centre=np.zeros(3))
    _, normals, _ = solid.hits([[3.0, 0.02, 0.3]], [-1.0, 0.0, 0.0])
    assert normals[0, 0] == pytest.approx(np.cos(np.pi / 24), rel=1e-6)


def test_outermost_points_reach_as_far_as_all():
    points = np.random.default_rng(1).normal(size=(50_000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    few = shading_output.outermost(points)
    assert len(few) < 10_000
    assert np.ptp(few, axis=0) == pytest.approx(np.ptp(points, axis=0), rel=0.002)


def test_the_sheet_has_one_panel_a_class_in_one_scale():
    part = box()
    found = find(part)
    figure = aspects.aspect_views(part, found, range(3))
    images = [axes for axes in figure.axes if axes.images]
    assert len(images) == 3
    scales = [np.ptp(axes.images[0].get_extent()[:2]) / axes.get_window_extent().width for axes in images]
    assert scales == pytest.approx([scales[0]] * 3)
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert {"A", "B", "C", "flat ×2", "PMI", "CSA", "stability", "box", "centre of mass"} <= set(texts)
    for chance in found.probabilities.values():
        assert f"{100.0 * chance[0]:.1f} %" in texts
    assert style.png(figure) == style.png(aspects.aspect_views(part, found, range(3)))


def test_the_recommended_answer_comes_first_with_its_interval():
    part = box()
    found = find(part)
    answer = found.recommended
    figure = aspects.aspect_views(part, found, range(3), answer)
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    share, low, high = (100.0 * ends[0] for ends in (answer.p, answer.low, answer.high))
    assert f"{share:.0f} % ({low:.0f}–{high:.0f})" in texts
    assert texts.index("recommended") < texts.index("PMI")


@pytest.mark.parametrize("share", [0.0, 0.05, 0.5, 1.0])
def test_the_numbers_of_the_answer_stay_beside_its_bar(share):
    figure = style.page(aspects.PANEL_PX, 40)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, aspects.PANEL_PX), ylim=(0, 40))
    aspects._answer(axes, 20.0, share, 0.9 * share, 1.0)
    label, number = (text.get_window_extent() for text in axes.texts)
    assert label.x1 < aspects.BARS_PX
    assert aspects.BARS_PX + aspects.BAR_PX < number.x0 < number.x1 <= aspects.RIGHT_PX + 1


@pytest.mark.parametrize(
    ("count", "grid"), [(1, (1, 1)), (4, (4, 1)), (5, (3, 2)), (8, (4, 2)), (13, (4, 4))]
)
def test_panels_stay_on_the_page_and_apart(count, grid):
    _, stand, _ = standing(box())
    sheet = aspects._layout([stand] * count, 3, False)
    assert (sheet.columns, sheet.rows) == grid
    places = [sheet.place(k) for k in range(count)]
    assert len(set(places)) == count
    assert min(bottom for _, bottom in places) - sheet.caption >= aspects.FOOT_PX
    assert max(left for left, _ in places) + sheet.image[0] <= sheet.page[0]


def test_the_scale_bar_is_round_and_true():
    axes = style.figure().add_subplot()
    shading_output.scale_bar(axes, right=500.0, y=0.0, pixel=0.00013)  # [m] a data unit
    text = axes.texts[0].get_text()
    left, right = axes.lines[0].get_xdata()
    assert text == "10 mm"
    assert (right - left) * 0.13 == pytest.approx(10.0)


def test_the_axis_of_a_rolling_class_goes_through_the_centre():
    solid, stand, _ = standing(box())
    axes = style.figure().add_subplot()
    shading_output.rolling_axis(axes, solid, stand, np.full(3, np.nan))
    assert not axes.lines
    shading_output.rolling_axis(axes, solid, stand, np.array([1.0, 0.0, 0.0]))
    x, y = axes.lines[0].get_data()
    assert (x[0], y[0]) == pytest.approx((-x[1], -y[1]))


@pytest.mark.parametrize("name", ["a$b$_{x}", "部品", "n" * 200, "tab\there"])
def test_any_name_of_a_part_can_be_drawn(name):
    part = box()
    figure = aspects.aspect_views(Part(**{**part.__dict__, "name": name}), find(part), [0])
    assert style.png(figure)
    texts = [text for axes in figure.axes for text in axes.texts]
    page = figure.bbox.width
    assert max(text.get_window_extent().x1 for text in texts) <= page


def test_an_open_surface_is_labelled():
    part = box()
    fields = {**part.__dict__, "open_surface": True}
    figure = aspects.aspect_views(Part(**fields), find(part), [0])
    assert any("open surface" in text.get_text() for axes in figure.axes for text in axes.texts)
