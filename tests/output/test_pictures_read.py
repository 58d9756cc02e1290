"""Pictures can be read: nothing under something else, nothing off the page, nothing that says nothing."""

from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from feederscrew.batch import summary
from feederscrew.bowl import read, settings
from feederscrew.bowl.reading import key_ranges
from feederscrew.output import aspects, batch, designs, plate, shading, style, tipping_graph
from feederscrew.output import compare as compare_output
from feederscrew.output import convey as convey_output
from feederscrew.output import floor as floor_output
from feederscrew.output import headings as headings_output
from feederscrew.output import slide as slide_output
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page
from feederscrew.output.trial.rides import DeviceRide
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.exact_tumbling import Transition
from feederscrew.studies import convey as convey_study
from feederscrew.studies.aspects import aspects as aspects_study
from feederscrew.studies.floor import floor
from feederscrew.studies.headings import headings
from feederscrew.studies.slide import slide
from feederscrew.studies.track import track

LOOKED_AT = True

PARTS = Path(__file__).parents[2] / "parts"
NUT = load(PARTS / "squarenut_m5.stl")
STRONG = ("drive.amplitude=2 mm",)
HOPS = read(None, STRONG)


def words(figure):
    return [text.get_text() for text in figure.axes[0].texts]


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
    figure = tipping_graph.graph("nut", names, lifts(count), np.full(count, 1.0 / count))
    texts = [text for text in figure.axes[0].texts if text.get_text()]
    assert len(texts) == count + count * (count - 1) + 2  # and head and note
    assert not any(a.overlaps(b) for a, b in combinations(boxes(figure, texts), 2))


def test_the_tipping_graph_of_a_part_shows_it_on_each_aspect_under_a_whole_title():
    """The title was cut in half once."""
    study = aspects_study(NUT)
    figure = tipping_graph.of_part(study, study.transitions, study.aspects.probabilities["quasistatic"])
    axes = figure.axes[0]
    texts = [one for one in axes.texts if "lift to tip" in one.get_text() or "below" in one.get_text()]
    found = boxes(figure, texts)
    assert len(found) == 2 and axes.get_title(loc="left") == ""
    assert all(figure.bbox.contains(x, y) for box in found for x, y in (box.min, box.max))
    images = [image.get_array() for image in axes.images]
    assert len(images) == len(study.aspects.names)
    assert all((one[..., :3] < 0.9).any() for one in images) and not np.array_equal(images[0], images[1])
    assert all(f"{name}  " in " ".join(words(figure)) for name in study.aspects.names)


def test_a_way_of_the_tipping_graph_is_drawn_once_and_the_easiest_stand_out():
    """The bracket's B and C are mirror images: the lifts into them differ by rounding."""
    twice = [*lifts(2), lift(0, 1, 0.5e-3)]
    figure = tipping_graph.graph("nut", ["A", "B"], twice, np.array([0.5, 0.5]))
    arrows = [text.arrow_patch for text in figure.axes[0].texts if getattr(text, "arrow_patch", None)]
    assert len(arrows) == 2 and all(arrow.get_arrowstyle().fillend for arrow in arrows)
    assert "0.5" in words(figure)
    same = [lift(0, 1), lift(0, 2, 1e-3 * (1 + 1e-9)), lift(1, 2)]
    figure = tipping_graph.graph("nut", ["A", "B", "C"], same, np.ones(3) / 3)
    assert [one.get_color() for one in figure.axes[0].texts if one.get_text() == "1"] == [style.ACCENT] * 3


def test_a_thumbnail_shows_the_aspect_that_is_named():
    found = find(NUT)
    first, other = (batch.thumbnail(NUT, found, name) for name in ("A", "C"))
    assert batch.thumbnail(NUT, found, found.likeliest) == batch.thumbnail(NUT, found) and first != other


def test_headings_name_their_axes_and_their_numbers_stand_apart():
    for part, name, aspect in ((NUT, "nut", "A"), (load(PARTS / "shcs_m3x8_simple.stl"), "screw", "B")):
        study = headings(part, read(), aspect)
        figure = headings_output.headings(study.postures[0], study.headings[0], study.track, name)
        assert figure.get_supxlabel() == "along the track [mm]"
        assert figure.get_supylabel() == "away from the wall [mm]"
        for axes in figure.axes:
            ticks = [tick for tick in axes.get_xticklabels() if tick.get_text()]
            assert not any(a.overlaps(b) for a, b in pairwise(boxes(figure, ticks)))


def test_a_map_where_the_bowl_hops_shows_the_throw_number_and_a_note_a_line_each():
    grid = track(NUT, HOPS).over(settings(None, STRONG))
    own = {"title": "nut", "labels": ("x", "y"), "value": "", "note": ("one", "two")}
    texts = words(floor_output.regime_map(grid, "acceleration_x_m_s2", **own))
    assert any(text.startswith("k = ") for text in texts) and "one\ntwo" in texts


def test_no_cross_where_nothing_presses():
    for bowl, crosses in ((HOPS, 0), (read(), 1)):
        study = floor(NUT, bowl)
        figure = floor_output.plan(study.posture, study.heading, study.now)
        marks = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
        assert (len(marks), len(figure.legends[0].get_texts())) == (crosses, 2 + crosses)


def test_the_zero_line_of_a_map_of_velocities_is_named():
    spans = key_ranges(["drive.vibration_angle=5:60:8", "track.climb=0:12:8"])
    study = convey_study.velocity_map(settings(None), spans)
    axes = convey_output.velocity_map(study.grid).axes[0]
    assert (study.grid.values["velocity"] < 0.0).any() == ("line: 0" in axes.get_title(loc="left"))
    assert axes.get_legend() is None  # it would hide cells


def test_a_comparison_with_every_rule_fits_a_screen():
    names = "pmi csa stability quasistatic crsa barrier surface hops".split()
    shares = np.array([0.7, 0.3])
    rules = dict.fromkeys(names, shares)
    figure = compare_output.comparison(
        "coin", ["A", "B"], {"tosses": shares}, rules, {("tosses", "pmi"): 0.1}
    )
    assert figure.get_figheight() * style.DPI <= 1200


def test_the_point_of_the_bowl_among_the_curves_is_named():
    figure = slide_output.curves(slide(read(), (0.3, 0.6)).maps)
    assert slide_output.OWN_LABEL in [text.get_text() for text in figure.legends[0].get_texts()]


def test_a_long_name_leaves_the_scale_bar_alone():
    figure = aspects.aspect_views(replace(NUT, name="n" * 60), find(NUT), [0])
    texts = [text for axes in figure.axes for text in axes.texts]
    name = next(text for text in texts if text.get_text().startswith("nnn"))
    scale = next(text for text in texts if text.get_text().endswith(" mm"))
    a, b = boxes(figure, [name, scale])
    assert a.x1 < b.x0


def test_the_strokes_of_plates_stand_within_their_axes():
    axes, x = style.figure(4.0, 3.8).add_subplot(), np.array([0.696, 0.714, 0.732])
    speeds = [np.full(3, 1e-3 * v) for v in (20.8, 21.7, 22.8)]
    results = [SimpleNamespace(bowl=read(), occupancy=SimpleNamespace(velocity=speed)) for speed in speeds]
    axes.plot(x, [1e3 * speed[0] for speed in speeds])
    plate.named(axes, x, results, ["bowl"] * 3)
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


def test_a_ride_is_named_by_its_device_and_a_single_value():
    values = {"gap": "9 mm", "cut-out": "[[0 mm]]", "vision reject": "{of: A@90, play: 0.2 mm}"}
    devices = [SimpleNamespace(name=name, short=short) for name, short in values.items()]
    section = SimpleNamespace(stations=[SimpleNamespace(device=one) for one in devices])
    titles = [DeviceRide(place, "A@0", "rolled_back", np.zeros((1, 8))).title(section) for place in range(3)]
    assert titles == [f"A@0 at {name}: rolled back" for name in ("gap 9 mm", "cut-out", "vision reject")]


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


def test_the_history_of_a_loop_can_be_read():
    """Once it was 7 x 3 pixels."""
    attempts = [SimpleNamespace(rate=0.5 * k, clean=k > 1, wanted="A@0") for k in (1, 2)]
    figure = designs.history_figure(SimpleNamespace(attempts=attempts, request=SimpleNamespace(target=1.0)))
    assert (figure.get_size_inches() * figure.dpi >= [600, 250]).all()


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
