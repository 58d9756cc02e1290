"""Pictures: what hides what, where things are, one scale, their data; and nothing that cannot be read."""

import math
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
import trimesh
from matplotlib.colors import to_rgba_array
from scipy.spatial.transform import Rotation

from feederscrew.arrivals.aspects_study import aspects as aspects_study
from feederscrew.arrivals.floor import floor
from feederscrew.bowl import read, settings
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.reading import key_ranges
from feederscrew.designing.record import Alternative
from feederscrew.jobs.batch import summary
from feederscrew.motion import convey as convey_study
from feederscrew.motion.limits import published_ratio
from feederscrew.motion.slide import sliding_map
from feederscrew.output import aspects, batch, designs, plate, shading, style, tooling_views
from feederscrew.output import compare as compare_output
from feederscrew.output import convey as convey_output
from feederscrew.output import floor as floor_output
from feederscrew.output import headings as headings_output
from feederscrew.output import slide as slide_output
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page, Table
from feederscrew.output.tables import regime_words
from feederscrew.output.trial import figures
from feederscrew.output.trial.rides import DeviceRide
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.exact_tumbling import Transition
from feederscrew.resting.rules import registry
from feederscrew.sorting.headings import headings
from feederscrew.sorting.track import track
from feederscrew.trials.course import Fate

LOOKED_AT = True

PARTS = Path(__file__).parents[2] / "parts"
NUT = load(PARTS / "squarenut_m5.stl")
STRONG = ("drive.amplitude=2 mm",)
HOPS = read(None, STRONG)


def words(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def boxes(figure, texts):
    figure.draw_without_rendering()
    return [text.get_window_extent() for text in texts if text.get_text()]


def lift(first, onto, height=1e-3):
    return Transition(first, onto, height, np.zeros(3))


def lifts(count):
    return [lift(i, j, 1e-3 * (1 + i + j)) for i in range(count) for j in range(count) if i != j]


@pytest.mark.parametrize("count", [2, 5])
def test_labels_of_the_tipping_graph_stand_apart(count):
    names = [chr(65 + k) for k in range(count)]
    figure = aspects.tipping_graph("nut", names, lifts(count), np.full(count, 1.0 / count))
    texts = [text for text in figure.axes[0].texts if text.get_text()]
    assert len(texts) == count + count * (count - 1) + 2  # and head and note
    assert not any(a.overlaps(b) for a, b in combinations(boxes(figure, texts), 2))


def test_the_tipping_graph_of_a_part_shows_it_on_each_aspect_under_a_whole_title():
    """The title was cut in half once."""
    study = aspects_study(NUT)
    figure = aspects.draw_tipping_graph(study, study.transitions, study.aspects.probabilities["quasistatic"])
    axes = figure.axes[0]
    texts = [one for one in axes.texts if "lift to tip" in one.get_text() or "below" in one.get_text()]
    found = boxes(figure, texts)
    assert len(found) == 2 and axes.get_title(loc="left") == ""
    assert all(figure.bbox.contains(x, y) for box in found for x, y in (box.min, box.max))
    images = [image.get_array() for image in axes.images]
    assert len(images) == len(study.aspects.names)
    assert all((one[..., :3] < 0.9).any() for one in images) and not np.array_equal(images[0], images[1])
    assert all(f"{name}  " in " ".join(words(figure)) for name in study.aspects.names)
    # The bracket's B and C are mirror images, their lifts differ by rounding: each way is drawn once.
    twice = [*lifts(2), lift(0, 1, 0.5e-3)]
    figure = aspects.tipping_graph("nut", ["A", "B"], twice, np.array([0.5, 0.5]))
    arrows = [text.arrow_patch for text in figure.axes[0].texts if getattr(text, "arrow_patch", None)]
    assert len(arrows) == 2 and all(arrow.get_arrowstyle().fillend for arrow in arrows)
    assert "0.5" in words(figure)
    same = [lift(0, 1), lift(0, 2, 1e-3 * (1 + 1e-9)), lift(1, 2)]
    figure = aspects.tipping_graph("nut", ["A", "B", "C"], same, np.ones(3) / 3)
    assert [one.get_color() for one in figure.axes[0].texts if one.get_text() == "1"] == [style.ACCENT] * 3


def test_the_numbers_of_headings_stand_apart():
    for part, name, aspect in ((NUT, "nut", "A"), (load(PARTS / "shcs_m3x8_simple.stl"), "screw", "B")):
        study = headings(part, read(), aspect)
        figure = headings_output.headings(study.postures[0], study.headings[0], study.track, name)
        for axes in figure.axes:
            ticks = [tick for tick in axes.get_xticklabels() if tick.get_text()]
            assert not any(a.overlaps(b) for a, b in pairwise(boxes(figure, ticks)))


def test_a_floor_has_a_cross_where_something_presses_and_maps_say_what_hops_and_where_zero_is():
    for bowl, crosses in ((HOPS, 0), (read(), 1)):
        study = floor(NUT, bowl)
        figure = floor_output.plan(study.posture, study.heading, study.now)
        marks = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
        assert (len(marks), len(figure.legends[0].get_texts())) == (crosses, 2 + crosses)
    # A map of what hops.
    grid = track(NUT, HOPS).over(settings(None, STRONG))
    own = {"title": "nut", "labels": ("x", "y"), "value": "", "note": ("one", "two")}
    texts = words(floor_output.regime_map(grid, "acceleration_x_m_s2", **own))
    assert any(text.startswith("k = ") for text in texts) and "one\ntwo" in texts
    # The zero line of velocities.
    spans = key_ranges(["drive.vibration_angle=5:60:8", "track.climb=0:12:8"])
    study = convey_study.velocity_map(settings(None), spans)
    axes = convey_output.velocity_map(study.grid).axes[0]
    assert (study.grid.values["velocity"] < 0.0).any() == ("line: 0" in axes.get_title(loc="left"))
    assert axes.get_legend() is None  # it would hide cells


def test_a_comparison_with_every_rule_fits_a_screen():
    names = "pmi csa stability quasistatic crsa barrier surface hops".split()
    shares = np.array([0.7, 0.3])
    rules = dict.fromkeys(names, shares)
    measured, gaps = {"tosses": shares}, {("tosses", "pmi"): 0.1}
    figure = compare_output.comparison("coin", ["A", "B"], measured, rules, gaps)
    assert figure.get_figheight() * style.DPI <= 1200


def test_the_strokes_of_plates_stand_within_their_axes():
    axes, x = style.figure(4.0, 3.8).add_subplot(), np.array([0.696, 0.714, 0.732])
    speeds = [np.full(3, 1e-3 * v) for v in (20.8, 21.7, 22.8)]
    results = [SimpleNamespace(bowl=read(), occupancy=SimpleNamespace(velocity=speed)) for speed in speeds]
    axes.plot(x, [1e3 * speed[0] for speed in speeds])
    plate.label_strokes(axes, x, results, ["bowl"] * 3)
    frame = axes.get_window_extent()
    assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in boxes(axes.figure, axes.texts))


def test_a_contact_sheet_says_why_a_rate_is_zero_or_a_part_failed():
    """It said '0 / min' alone; the reason stands below the picture, above the lower edge."""
    row = {"status": summary.DONE, "parts_per_minute": 0.0, "orientation": "A@257", "folder": "washer"}
    row["note"] = "gap (9.35 mm) rejects the orientation you want; rate is 0"
    store = SimpleNamespace(file=lambda folder, name: batch.thumbnail(NUT, find(NUT)))
    [[tile]] = summary.sheets(store, [row])
    [[other]] = summary.sheets(store, [row | {"parts_per_minute": 2.0}])
    assert " ".join(tile[2].split()) == "A@257: 0 / min, gap (9.35 mm) rejects the orientation you want"
    assert other[2] == "A@257: 2 / min"
    why = "failed: is cut short: 476 facets announced, 316 are there"
    for shown, line in ((tile, tile[2]), ((None, "bolt", why), why)):
        figure = batch._sheet([shown])
        assert " ".join(line.split()) in " ".join(" ".join(words(figure)).split())
        assert min(box.y0 for box in boxes(figure, figure.axes[0].texts)) > 0.0
    # A thumbnail shows the aspect that is named.
    found = find(NUT)
    first, other = (batch.thumbnail(NUT, found, name) for name in ("A", "C"))
    assert batch.thumbnail(NUT, found, found.likeliest) == batch.thumbnail(NUT, found) and first != other


def test_a_ride_is_named_by_its_device_and_the_history_of_a_loop_can_be_read():
    values = {"gap": "9 mm", "cut-out": "[[0 mm]]", "vision reject": "{of: A@90, play: 0.2 mm}"}
    devices = [
        SimpleNamespace(kind=name, short=short, is_one_value=name == "gap") for name, short in values.items()
    ]
    section = SimpleNamespace(stations=[SimpleNamespace(device=one) for one in devices])
    titles = [
        DeviceRide(place, "A@0", Fate.ROLLED_BACK, np.zeros((1, 8))).title(section) for place in range(3)
    ]
    assert titles == [f"A@0 at {name}: rolled back" for name in ("gap 9 mm", "cut-out", "vision reject")]
    turned = DeviceRide(0, "A@0", Fate.PASSED, np.zeros((1, 8)), becomes="B@90").title(section)
    assert turned == "A@0 at gap 9 mm: becomes B@90", "it was headed 'passed'"
    # The history of a loop can be read: once it was 7 x 3 pixels.
    attempts = [SimpleNamespace(rate=0.5 * k, clean=k > 1, wanted="A@0") for k in (1, 2)]
    figure = designs.history_figure(SimpleNamespace(attempts=attempts, request=SimpleNamespace(target=1.0)))
    assert (figure.get_size_inches() * figure.dpi >= [600, 250]).all()


def test_what_leaves_has_a_row_in_the_picture_of_a_trial_however_seldom_it_comes():
    """Of 30 orientations the 24 most frequent had one, and the wanted one was left out."""
    count, names = 30, [f"A@{k}" for k in range(30)]
    leaving, lost = np.zeros((count, count + 1), int), np.zeros((count, len(Fate)), int)
    leaving[28, 28], lost[:, Fate.RETURNED] = 2, 2
    lost[28, Fate.RETURNED] = 0
    states = [SimpleNamespace(name=name) for name in names]
    run = SimpleNamespace(
        shares=np.linspace(2.0, 1.0, count) / 45.0,
        tried_counts=np.full(count, 2),
        matrix=leaving,
        counts=lost,
        orientations=SimpleNamespace(states=states),
        is_odd=np.zeros(count, bool),
    )
    labels = [label.get_text() for label in figures.matrix(run).axes[0].get_yticklabels()]
    assert labels == [*names[:23], "A@28"]


def test_a_matrix_can_be_sorted_where_it_says_so_and_headings_stand_over_numbers():
    cells = ((MarkedCell("b"), MarkedCell("7", "number")), (MarkedCell("a"), MarkedCell("failed", "failed")))
    for sortable in (False, True):
        page = html(Page("all", "", (Chapter((Matrix(("part", "mass"), cells, sortable),)),)))
        assert ('class="matrix sortable"' in page) == ("aria-sort" in page.split("</style>")[1]) == sortable
        assert sortable or '<th>part</th><th class="number">mass</th>' in page


def test_a_part_behind_a_blade_shines_through():
    """A cube behind a plate as large: without what shines through it one colour would be all that is seen."""
    part, blade = trimesh.creation.box((1.0, 1.0, 1.0)), trimesh.creation.box((4.0, 4.0, 0.1))
    blade.apply_translation((0.0, 0.0, 2.0))
    camera = shading.Camera(*np.eye(3))
    meshes = ((one.vertices, one.faces) for one in (blade, part))
    image, _, _ = shading.pair_picture(*meshes, np.zeros(3), camera, 1.5, 60, 60)
    assert np.abs(image[30, 30] - image[5, 5]).max() > 0.04
    assert (np.abs(image - image[5, 5]).max(axis=2) > 0.02)[20:40, 20:40].all()


def test_a_part_that_slips_back_is_said_to_slip_back_in_a_line_of_its_own():
    """Once the legend said 'part: backward'."""
    study = convey_study.convey(read(None, ("drive.amplitude=0.4 mm", "drive.frequency=50 Hz")))
    assert study.answer.fractions["backward"] > 0.1
    figure = convey_output.cycle(study.trace(), study.bowl.drive.amplitude, study.answer)
    labels = [label for axes in figure.axes for label in axes.get_legend_handles_labels()[1]]
    rows = convey_output.summary(convey_output.document(study))["quantity"]
    assert "part slips back" in labels and "time it slips back [%]" in rows
    assert not any("backward" in text for text in (*labels, *rows))
    assert len({convey_output.PHASE_LINES[name] for name in ("forward", "backward", "flight")}) == 3


SIDES = np.array([0.030, 0.020, 0.010])  # [m]
BOX = shapes.part(shapes.box(30, 20, 10), "box")


def cylinder(sections):
    """Corners and facets of a tube without ends, radius 1, and the outward direction at each facet corner."""
    turn = 2.0 * np.pi * np.arange(sections) / sections
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(sections)])
    k, after = np.arange(sections), (np.arange(sections) + 1) % sections
    halves = np.stack([k, after, after + sections], 1), np.stack([k, after + sections, k + sections], 1)
    return np.concatenate([ring, ring + np.array([0.0, 0.0, 2.0])]), np.concatenate(halves)


def standing(part=BOX, row=0):
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    found = find(part)
    stand = shading.stance(solid.points, found.normals[row], found.heights[row] / solid.size)
    return solid, stand, found


def test_a_part_on_an_aspect_is_seen_as_it_stands():
    solid, stand, found = standing()
    distances, normals, _ = solid.hits([[0.0, 0.0, 3.0], [0.9, 0.9, 3.0]], [0.0, 0.0, -1.0])
    assert distances[0] == pytest.approx(3.0 - 0.005 / solid.size, rel=1e-6)
    assert normals[0] == pytest.approx([0.0, 0.0, 1.0])
    assert np.isinf(distances[1]) and not normals[1].any()
    step = 0.005
    grid = np.arange(-1.2, 1.2, step)
    depths, _, _ = stand.camera.meet(solid, grid, grid)
    faces = np.array([SIDES[1] * SIDES[2], SIDES[0] * SIDES[2], SIDES[0] * SIDES[1]]) / solid.size**2
    area = faces @ np.abs(stand.camera.towards_viewer)
    assert np.isfinite(depths).sum() * step**2 == pytest.approx(area, rel=0.01)
    # It hides the back of its contact polygon only.
    polygon = found.polygons[0] / solid.size
    edges = 0.5 * (polygon + np.roll(polygon, -1, axis=0))  # middle of each edge
    seen = stand.camera.sees(solid, edges)
    assert seen[np.argsort(edges @ stand.camera.towards_viewer)].tolist() == [False, False, True, True]
    assert not stand.camera.sees(solid, np.array([[0.0, 0.0, 0.0]]))[0]
    # It stands on the floor under a camera that looks down.
    assert stand.floor_axes @ stand.floor_axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert (solid.points @ stand.floor_axes[2]).min() == pytest.approx(-stand.height, rel=1e-9)
    assert np.abs(stand.floor_axes[0] @ [1.0, 0.0, 0.0]) == pytest.approx(1.0)  # the long side
    camera, up = stand.camera, stand.floor_axes[2]
    frame = np.stack([camera.right, camera.up, camera.towards_viewer])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)
    assert camera.towards_viewer @ up == pytest.approx(np.sin(shading.ELEVATION))
    assert camera.up @ up == pytest.approx(np.cos(shading.ELEVATION))
    # The background is paper, each face has its own shade.
    image = shading.picture(solid, stand, shading.Shot(-1.5, -1.5, 0.03, 100, 100))
    assert image.shape == (100, 100, 3) and image.min() >= 0.0 and image.max() <= 1.0
    assert image[0] == pytest.approx(1.0) and image[50, 50].max() < 0.95
    normals = np.array([n for n in (*np.eye(3), *-np.eye(3)) if n @ stand.camera.towards_viewer > 0.0])
    shades = shading.lit(normals, stand.camera, shading.STEEL_COLOUR).mean(axis=1)
    assert len(shades) == 3 and np.diff(np.sort(shades)).min() > 0.03


@pytest.mark.parametrize("row", [0, 1, 2])
def test_turning_and_moving_the_file_changes_no_outline(row):
    turn, shift = Rotation.from_rotvec([0.3, -1.1, 0.6]).as_matrix(), (1.0, -2.0, 3.0)
    own = {"inertia": turn @ BOX.inertia @ turn.T, "vertices": BOX.vertices @ turn.T + shift}
    other = replace(BOX, centre_of_mass=turn @ BOX.centre_of_mass + shift, **own)
    size, same = (np.diff(standing(part, row)[1].bounds, axis=0) for part in (BOX, other))
    assert same == pytest.approx(size, rel=1e-6)


def test_a_tessellated_cylinder_is_shaded_round_and_a_coarse_prism_keeps_its_edges(monkeypatch):
    points, faces = cylinder(24)
    normals = shading.corner_normals(points, faces)
    radial = points[faces] * [1.0, 1.0, 0.0]
    assert np.einsum("fki,fki->fk", normals, radial).min() > np.cos(np.radians(3.0))
    assert np.ptp(shading.corner_normals(*cylinder(8)), axis=1) == pytest.approx(0.0, abs=1e-12)
    monkeypatch.setattr(shading, "MOST_FACETS", 10)  # a large mesh is not smoothed
    assert shading.corner_normals(points, faces) is None
    solid = shading.Rays(points, faces, centre=np.zeros(3))
    _, normals, _ = solid.hits([[3.0, 0.02, 0.3]], [-1.0, 0.0, 0.0])
    assert normals[0, 0] == pytest.approx(np.cos(np.pi / 24), rel=1e-6)
    # Outermost points reach as far as all.
    points = np.random.default_rng(1).normal(size=(50_000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    few = shading.outer_points(points)
    assert len(few) < 10_000
    assert np.ptp(few, axis=0) == pytest.approx(np.ptp(points, axis=0), rel=0.002)


def test_the_sheet_has_one_panel_a_class_in_one_scale_and_the_recommended_answer_first():
    found = find(BOX)
    answer, figure = found.recommended, aspects.aspect_views(BOX, found, range(3), found.recommended)
    images = [axes for axes in figure.axes if axes.images]
    scales = [np.ptp(axes.images[0].get_extent()[:2]) / axes.get_window_extent().width for axes in images]
    assert scales == pytest.approx([scales[0]] * 3)
    texts = words(figure)
    assert {
        "A",
        "B",
        "C",
        "on its largest face ×2",
        "PMI",
        "CSA",
        "stability",
        "box",
        "centre of mass",
    } <= set(texts)
    assert all(f"{100.0 * chance[0]:.1f} %" in texts for chance in found.probabilities.values())
    share, low, high = (100.0 * ends[0] for ends in (answer.p, answer.low, answer.high))
    assert f"{share:.0f} % ({low:.0f}–{high:.0f})" in texts
    assert texts.index("recommended") < texts.index("PMI")
    places = [axes.get_position() for axes in images]
    assert all(place.min.min() >= 0.0 and place.max.max() <= 1.0 for place in places)
    assert len({(round(place.x0, 3), round(place.y0, 3)) for place in places}) == 3
    first, second = (style.png(aspects.aspect_views(BOX, found, [2])) for _ in range(2))
    assert first == second
    # The scale bar is round and true, and the axis of a rolling class goes through the centre.
    axes = style.figure().add_subplot()
    shading.scale_bar(axes, right=500.0, y=0.0, pixel=0.00013)  # [m] a data unit
    left, right = axes.lines[0].get_xdata()
    assert axes.texts[0].get_text() == "10 mm" and (right - left) * 0.13 == pytest.approx(10.0)
    solid, stand, _ = standing()
    axes = style.figure().add_subplot()
    shading.rolling_axis(axes, solid, stand, np.full(3, np.nan))
    assert not axes.lines
    shading.rolling_axis(axes, solid, stand, np.array([1.0, 0.0, 0.0]))
    x, y = axes.lines[0].get_data()
    assert (x[0], y[0]) == pytest.approx((-x[1], -y[1]))


@pytest.mark.parametrize("name", ["a$b$_{x} 部品 tab\there", "n" * 200])
def test_any_name_of_a_part_can_be_drawn_and_an_open_surface_is_labelled(name):
    figure = aspects.aspect_views(replace(BOX, name=name, open_surface=True), find(BOX), [0])
    assert style.png(figure)
    texts = [text for axes in figure.axes for text in axes.texts]
    assert max(box.x1 for box in boxes(figure, texts)) <= figure.bbox.width
    assert any("open surface" in text for text in words(figure))
    title = next(text for text in texts if text.get_text().startswith(name[:3]))
    scale = next(text for text in texts if text.get_text().endswith(" mm"))
    long, bar = boxes(figure, [title, scale])
    assert long.x1 < bar.x0


NAMES = ["A", "B", "C"]
PROFILES = {"pmi": np.array([0.5, 0.3, 0.2]), "csa": np.array([0.6, 0.4, np.nan])}
ANSWER = [[0.5, 0.3, 0.2], [0.4, 0.1, 0.0], [0.7, 0.4, 0.35]]


def heights(axes):
    return [bar.get_height() for bar in axes.patches]


def printed(texts):
    return [text.get_text() for text in texts]


def test_bars_show_percentages_by_aspect_and_rule_and_the_answer_with_its_interval():
    figure = aspects.profile_bars(NAMES, PROFILES, title="nut")
    (axes,) = figure.axes
    assert heights(axes) == pytest.approx([50.0, 30.0, 20.0, 60.0, 40.0, 0.0])
    assert printed(axes.get_xticklabels()) == NAMES
    assert printed(axes.texts) == ["50.0", "30.0", "20.0", "60.0", "40.0"]
    assert axes.get_legend_handles_labels()[1] == ["PMI", "CSA"]
    image = style.png(figure)
    assert image == style.png(aspects.profile_bars(NAMES, PROFILES, title="nut"))
    assert image.startswith(b"\x89PNG") and b"atplotlib" not in image  # no version of it
    # The recommended answer has its interval; rules differ without their colours.
    figure = aspects.answer_bars(NAMES, ANSWER, PROFILES, title="nut")
    axes = figure.axes[0]
    assert heights(axes) == pytest.approx([50.0, 30.0, 20.0])
    ends = [segment[:, 1] for segment in axes.collections[0].get_segments()]
    assert np.array(ends) == pytest.approx(100.0 * np.array(ANSWER[1:]).T)
    assert printed(axes.texts) == ["50.0", "30.0", "20.0"]
    assert printed(figure.legends[0].get_texts()) == ["recommended, with interval", "PMI", "CSA"]
    rules = [style.method(name)[0] for name in PROFILES]
    assert len({line.get_marker() for line in axes.lines if line.get_label() in rules}) == len(PROFILES)
    assert len(aspects.MARKS) >= len(registry.RULE_NAMES)
    assert style.method("csa") == ("CSA", "#e69f00")
    assert style.method("MDBT_80", 1) == ("MDBT 80", style.SPARE_COLOURS[1])


@pytest.mark.parametrize("count", [1, 6, 24])
def test_the_answered_chart_keeps_everything_on_its_page(count):
    names, share = [chr(65 + k) for k in range(count)], np.full(count, 0.123)
    rules = dict.fromkeys(registry.RULE_NAMES, share)
    figure = aspects.answer_bars(names, [share, 0.5 * share, 2.0 * share], rules)
    figure.draw_without_rendering()
    legend = figure.legends[0].get_window_extent()
    assert 0.0 <= legend.x0 < legend.x1 <= figure.bbox.width
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert not any(a.overlaps(b) for a, b in pairwise(boxes))
    assert all(box.y1 <= figure.axes[0].get_window_extent().y1 for box in boxes)


def test_any_name_can_stand_anywhere_and_is_no_formula_and_a_letter_without_a_glyph_is_its_number():
    for name in ("$dollar^_{x}$", "$\\mathdefault{$", "部品\t", "bad\udcff\udcfe", r"a\$b"):
        figure = style.figure()
        axes = style.tidy(figure.add_subplot(), title=name, x=name, y=name)
        axes.plot([1.0, 2.0], [1.0, 2.0], label=name)
        axes.set_xticks([1.0], labels=[name])
        axes.legend()
        assert style.png(figure)
    figure = style.figure()

    def width(text):
        return figure.text(0.0, 0.0, text).get_window_extent().width

    assert width("$x^{2}$ and more") > width("x2 and more")
    assert (width("部"), width("a\udcff")) == (width(r"\u90e8"), width(r"a\udcff"))


SMALL = (61, 51)  # cells, for speed


def sliding(beta=20, *overrides):
    return sliding_map(read(None, overrides), math.radians(beta), shape=SMALL)


def texts(figure):
    """Every text of a figure that is not a tick."""
    legends = [figure.axes[0].get_legend(), *figure.legends]
    return printed(figure.axes[0].texts) + [t for one in legends if one for t in printed(one.get_texts())]


@pytest.mark.parametrize(
    ("draw", "hop"), [(slide_output.regimes, math.cos(math.radians(3))), (slide_output.contours, 1.0)]
)
def test_the_own_point_is_marked_where_the_bowl_works_and_the_hop_begins_at_its_ratio(draw, hop):
    own = sliding(20, "drive.amplitude=0.05 mm", "drive.frequency=60 Hz", "drive.direction=25 deg")
    figure = draw(own)
    (marker,) = [line for line in figure.axes[0].lines if line.get_marker() == "o"]
    assert marker.get_xydata()[0] == pytest.approx([25, own.ratio])
    assert "this bowl, G = 0.724" in texts(figure)
    begins = [line.get_ydata()[0] for line in draw(sliding(20)).axes[0].lines if line.get_marker() != "o"]
    assert begins == pytest.approx([hop / math.sin(math.radians(20))])


def test_the_regime_map_shows_its_codes_and_contour_lines_follow_4_27():
    one = sliding(20)
    figure = slide_output.regimes(one)
    (image,) = figure.axes[0].images
    colours = 255.0 * to_rgba_array([slide_output.SLIDE_COLOURS[name] for name in one.grid.names])
    assert (np.asarray(image.get_array()) == np.round(colours)[one.grid.codes.T]).all()
    legend = [text.replace("\n", " ") for text in texts(figure)]
    for name, share in one.grid.shares().items():
        label = "no friction prevents forward slip (part hops)" if name == "hop" else regime_words(name)
        assert (label in legend) == (share > 0), name
    # Contour lines follow [4.27] and carry their values.
    figure = slide_output.contours(sliding_map(read(), math.radians(20), shape=slide_output.MAP_SHAPE))
    assert {"μ = 0.1", "μ = 1", "μ = 2", "this bowl's μ = 0.6"} <= set(texts(figure))
    assert "μ = 0.6" not in texts(figure)
    (drawn,) = (collection for collection in figure.axes[0].collections if hasattr(collection, "levels"))
    paths = [path for path in drawn.get_paths() if len(path.vertices)]
    angle, ratio = paths[list(drawn.levels).index(1.0)].vertices.T
    inner = np.abs(angle) < 60
    expected = published_ratio(1.0, math.radians(20), np.radians(angle[inner]))
    assert ratio[inner] == pytest.approx(expected, rel=1e-3)


def overlapping(figure, texts):
    """Pairs of texts whose boxes share ground."""
    figure.canvas.draw()
    boxes = [text.get_window_extent(figure.canvas.get_renderer()) for text in texts]
    return [(a, b) for k, a in enumerate(boxes) for b in boxes[k + 1 :] if a.overlaps(b)]


@pytest.mark.parametrize("rates", [(0.0,) * 12, (0.0, 0.0, 1.2, 0.0), (0.0,)])
def test_the_labels_of_bars_without_height_do_not_lie_on_each_other(rates):
    """They stood side by side on the axis: 'hanginghanginghanging'."""
    attempts = [SimpleNamespace(rate=rate, clean=False, wanted="A@188 or hanging") for rate in rates]
    figure = designs.history_figure(SimpleNamespace(attempts=attempts, request=SimpleNamespace(target=1.0)))
    (axes,) = figure.axes
    low = [text for text, rate in zip(axes.texts, rates) if rate == 0.0]
    assert overlapping(figure, low) == []
    assert all(text.get_rotation() == (90.0 if len(rates) > 1 else 0.0) for text in low)


def test_the_legend_of_a_history_of_both_kinds_of_trials_lies_within_the_picture():
    """It ended in 'something else leaves, or parts sta', and the bars had three quarters of the width."""
    attempts = [SimpleNamespace(rate=1.0, clean=clean, wanted="A@87") for clean in (True, False)]
    figure = designs.history_figure(SimpleNamespace(attempts=attempts, request=SimpleNamespace(target=1.0)))
    figure.canvas.draw()
    (axes,) = figure.axes
    legend = axes.get_legend().get_window_extent()
    assert len(axes.get_legend().get_texts()) == 3
    assert figure.bbox.x0 <= legend.x0 and legend.x1 <= figure.bbox.x1 and legend.y1 <= figure.bbox.y1
    assert axes.get_window_extent().width > 0.85 * figure.bbox.width


def test_the_captions_of_views_side_by_side_stay_over_their_own(monkeypatch):
    """They ran into each other where a device has a long name."""
    words = ("A@188 is laid over at the narrowed track beside a height bar",
             "margin -0.64 mm, where it is supported least; outline: what supports it")  # fmt: skip
    monkeypatch.setattr(tooling_views, "_views", lambda *chain: [(None, words, "k"), (None, words, "k")])
    monkeypatch.setattr(tooling_views, "_draw_view", lambda *view: None)
    figure = tooling_views.figure([], [], np.ones(1), 0)
    figure.canvas.draw()
    assert overlapping(figure, figure.texts) == []
    for place, text in enumerate(figure.texts):
        box = text.get_window_extent(figure.canvas.get_renderer())
        view = figure.axes[2 * place // len(figure.texts)].get_window_extent()
        assert view.x0 <= box.x0 and box.x1 <= view.x1 and box.y0 >= view.y1 - 2.0


def test_devices_and_shares_of_a_design_are_in_words_on_its_page():
    """The page had a dump of YAML, and a yield of 0.0030 where the text says 0.299 %."""
    narrowed, sorter = (
        make_device("narrowed track", "test", limit=13.35e-3).rewritten(),
        make_device("vision reject", "test", like=("A", 0.5 * np.pi, 2e-4)).rewritten(),
    )
    assert (narrowed.brief, sorter.brief) == ("narrowed track 13.35 mm", "vision reject")
    chain = ("sorter: {of: A@90}",), ("camera from above",)
    option = Alternative(3, "holds", (1.0, 0.9, 1.1), 1.0, 0.00299, *chain)
    study = SimpleNamespace(alternatives=(option, Alternative(1, "not tried")))
    page = html(Page("p", "", (Chapter((Table(designs.short_alternatives(study)),)),)))
    assert "{of" not in page.split("</style>")[1] and "camera from above" in page
    assert (
        "yield <small>[%]</small>" in page and ">0.299<" in page and "0.003" not in page.split("</style>")[1]
    )
