"""Pictures can be read: nothing under something else, nothing off the page, nothing that says nothing."""

from itertools import combinations, pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew.batch import summary
from feederscrew.bowl import read, settings
from feederscrew.bowl.reading import key_ranges
from feederscrew.output import batch, style, tipping_graph
from feederscrew.output import compare as compare_output
from feederscrew.output import convey as convey_output
from feederscrew.output import floor as floor_output
from feederscrew.output import headings as headings_output
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
from feederscrew.studies.track import track

LOOKED_AT = True

PARTS = Path(__file__).parents[2] / "parts"
NUT = load(PARTS / "squarenut_m5.stl")
HOPS = read(None, ("drive.amplitude=2 mm",))


def boxes(figure, texts):
    figure.draw_without_rendering()
    return [text.get_window_extent() for text in texts if text.get_text()]


def ways(count):
    return [
        Transition(i, j, 1e-3 * (1 + i + j), np.zeros(3))
        for i in range(count)
        for j in range(count)
        if i != j
    ]


@pytest.mark.parametrize("count", [2, 5])
def test_labels_of_the_tipping_graph_stand_apart(count):
    names = [chr(65 + k) for k in range(count)]
    figure = tipping_graph.graph("nut", names, ways(count), np.full(count, 1.0 / count))
    texts = [text for text in figure.axes[0].texts if text.get_text()]
    assert len(texts) == count + count * (count - 1) + 2  # and head and note
    assert not any(a.overlaps(b) for a, b in combinations(boxes(figure, texts), 2))


def test_head_and_note_of_the_tipping_graph_are_on_the_picture():
    """The title was cut in half once."""
    study = aspects_study(NUT)
    figure = tipping_graph.of_part(study, study.transitions, study.aspects.probabilities["quasistatic"])
    texts = [
        text
        for text in figure.axes[0].texts
        if "lift to tip" in text.get_text() or "below" in text.get_text()
    ]
    found = boxes(figure, texts)
    assert len(found) == 2 and all(figure.bbox.containsx(x) for box in found for x in (box.x0, box.x1))
    assert all(figure.bbox.containsy(y) for box in found for y in (box.y0, box.y1))
    assert figure.axes[0].get_title(loc="left") == ""


def test_a_way_of_the_tipping_graph_is_drawn_once_with_its_head():
    twice = [*ways(2), Transition(0, 1, 0.5e-3, np.zeros(3))]
    figure = tipping_graph.graph("nut", ["A", "B"], twice, np.array([0.5, 0.5]))
    arrows = [text.arrow_patch for text in figure.axes[0].texts if getattr(text, "arrow_patch", None)]
    assert len(arrows) == 2
    assert all(arrow.get_arrowstyle().fillend for arrow in arrows)
    assert "0.5" in [text.get_text() for text in figure.axes[0].texts]


def test_two_ways_as_easy_as_each_other_both_stand_out():
    """The bracket's B and C are mirror images: the lifts into them differ by rounding."""
    same = [Transition(0, 1, 1e-3, np.zeros(3)), Transition(0, 2, 1e-3 * (1 + 1e-9), np.zeros(3))]
    figure = tipping_graph.graph(
        "nut", ["A", "B", "C"], [*same, Transition(1, 2, 1e-3, np.zeros(3))], np.ones(3) / 3
    )
    texts = figure.axes[0].texts
    assert [text.get_color() for text in texts if text.get_text() == "1"] == [style.ACCENT] * 3


def test_a_thumbnail_shows_the_aspect_that_is_named():
    found = find(NUT)
    first, other = (batch.thumbnail(NUT, found, name) for name in ("A", "C"))
    assert batch.thumbnail(NUT, found, found.likeliest) == batch.thumbnail(NUT, found)
    assert first != other


def test_headings_name_their_axes_and_their_numbers_stand_apart():
    study = headings(NUT, read())
    figure = headings_output.headings(study.postures[0], study.headings[0], study.track, "nut")
    assert (figure.get_supxlabel(), figure.get_supylabel()) == (
        "along the track [mm]",
        "away from the wall [mm]",
    )
    small = headings(load(PARTS / "shcs_m3x8_simple.stl"), read(), "B")
    beside = headings_output.headings(small.postures[0], small.headings[0], small.track, "screw")
    for drawn in (figure, beside):
        for axes in drawn.axes:
            ticks = [tick for tick in axes.get_xticklabels() if tick.get_text()]
            assert not any(a.overlaps(b) for a, b in pairwise(boxes(drawn, ticks)))


def test_a_map_where_the_bowl_hops_shows_the_throw_number():
    study = track(NUT, HOPS)
    grid = study.over(settings(None, ("drive.amplitude=2 mm",)))
    figure = floor_output.regime_map(grid, "acceleration_x_m_s2", title="nut", labels=("x", "y"), value="")
    assert any(text.get_text().startswith("k = ") for text in figure.axes[0].texts)


def test_sentences_under_a_title_have_a_line_each():
    grid = track(NUT, HOPS).over(settings(None, ("drive.amplitude=2 mm",)))
    figure = floor_output.regime_map(
        grid, "acceleration_x_m_s2", title="nut", labels=("x", "y"), value="", note=("one", "two")
    )
    assert "one\ntwo" in [text.get_text() for text in figure.axes[0].texts]


def test_no_cross_where_nothing_presses():
    for bowl, crosses in ((HOPS, 0), (read(), 1)):
        study = floor(NUT, bowl)
        figure = floor_output.plan(study.posture, study.heading, study.now)
        marks = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
        assert (len(marks), len(figure.legends[0].get_texts())) == (crosses, 2 + crosses)


def test_the_zero_line_of_a_map_of_velocities_is_named():
    spans = key_ranges(["drive.vibration_angle=5:60:8", "track.climb=0:12:8"])
    found = convey_study.velocity_map(settings(None), spans)
    figure = convey_output.velocity_map(found.grid)
    named = "line: 0" in figure.axes[0].get_title(loc="left")
    assert (found.grid.values["velocity"] < 0.0).any() == named
    assert figure.axes[0].get_legend() is None  # it would hide cells


def test_a_comparison_with_every_rule_fits_a_screen():
    shares = np.array([0.7, 0.3])
    rules = dict.fromkeys(
        ("pmi", "csa", "stability", "quasistatic", "crsa", "barrier", "surface", "hops"), shares
    )
    figure = compare_output.comparison(
        "coin", ["A", "B"], {"tosses": shares}, rules, {("tosses", "pmi"): 0.1}
    )
    assert figure.get_figheight() * style.DPI <= 1200


def test_the_point_of_the_bowl_among_the_curves_is_named():
    from feederscrew.output import slide as slide_output
    from feederscrew.studies.slide import slide as study

    found = study(read(), (0.3, 0.6))
    labels = [text.get_text() for text in slide_output.curves(found.maps).legends[0].get_texts()]
    assert slide_output.OWN_LABEL in labels


def test_a_long_name_leaves_the_scale_bar_alone():
    from dataclasses import replace

    from feederscrew.output import aspects

    figure = aspects.aspect_views(replace(NUT, name="n" * 60), find(NUT), [0])
    texts = {text.get_text(): text for axes in figure.axes for text in axes.texts}
    name = next(text for told, text in texts.items() if told.startswith("nnn"))
    scale = next(text for told, text in texts.items() if told.endswith(" mm"))
    a, b = boxes(figure, [name, scale])
    assert a.x1 < b.x0


def test_the_strokes_of_plates_stand_within_their_axes():
    from types import SimpleNamespace

    from feederscrew.output import plate

    axes = style.figure(4.0, 3.8).add_subplot()
    x = np.array([0.696, 0.714, 0.732])
    speeds = [np.full(3, 1e-3 * v) for v in (20.8, 21.7, 22.8)]
    results = [SimpleNamespace(bowl=read(), occupancy=SimpleNamespace(velocity=speed)) for speed in speeds]
    axes.plot(x, [1e3 * speed[0] for speed in speeds])
    plate.named(axes, x, results, ["bowl"] * 3)
    frame = axes.get_window_extent()
    for box in boxes(axes.figure, axes.texts):
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1


def test_the_tipping_graph_of_a_part_shows_it_on_each_aspect():
    study = aspects_study(NUT)
    figure = tipping_graph.of_part(study, study.transitions, study.aspects.probabilities["quasistatic"])
    shown = [image.get_array() for image in figure.axes[0].images]
    assert len(shown) == len(study.aspects.names)
    assert all((one[..., :3] < 0.9).any() for one in shown) and not np.array_equal(shown[0], shown[1])
    said = " ".join(text.get_text() for text in figure.axes[0].texts)
    assert all(f"{name}  " in said for name in study.aspects.names)


def test_a_contact_sheet_says_why_a_part_failed():
    why = "failed: is cut short: 476 facets announced, 316 are there"
    figure = batch._sheet([(None, "bolt", why)])
    said = " ".join(" ".join(text.get_text() for text in figure.axes[0].texts).split())
    assert why in said


def test_a_contact_sheet_says_why_a_rate_is_zero():
    """It said '0 / min' alone; the reason stands below the picture, above the lower edge."""
    row = {"status": summary.DONE, "parts_per_minute": 0.0, "orientation": "A@257", "folder": "washer"}
    row["note"] = "gap (9.35 mm) rejects the orientation you want; rate is 0"
    store = SimpleNamespace(file=lambda folder, name: batch.thumbnail(NUT, find(NUT)))
    [[tile]] = summary.sheets(store, [row])
    figure = batch._sheet([tile])
    text = figure.axes[0].texts[1]
    assert (
        " ".join(text.get_text().split()) == "A@257: 0 / min, gap (9.35 mm) rejects the orientation you want"
    )
    figure.canvas.draw()
    assert text.get_window_extent().y0 > 0.0
    [[other]] = summary.sheets(store, [row | {"parts_per_minute": 2.0}])
    assert other[2] == "A@257: 2 / min"


def test_a_ride_is_named_by_its_device_and_a_single_value():
    devices = [SimpleNamespace(name="gap", short="9 mm"), SimpleNamespace(name="cut-out", short="[[0 mm]]")]
    devices.append(SimpleNamespace(name="vision reject", short="{of: A@90, play: 0.2 mm}"))
    found = SimpleNamespace(stations=[SimpleNamespace(device=one) for one in devices])
    said = [DeviceRide(place, "A@0", "rolled_back", np.zeros((1, 8))).title(found) for place in range(3)]
    assert said == [f"A@0 at {name}: rolled back" for name in ("gap 9 mm", "cut-out", "vision reject")]


def test_a_matrix_can_be_sorted_where_it_says_so():
    cells = ((MarkedCell("b"),), (MarkedCell("a"),))
    for sortable in (False, True):
        page = html(Page("all", "", (Chapter((Matrix(("part",), cells, sortable),)),)))
        assert ('class="matrix sortable"' in page) == ("aria-sort" in page.split("</style>")[1]) == sortable


def test_a_part_behind_a_blade_shines_through():
    """A cube behind a plate as large: without what shines through it one colour would be all that is seen."""
    import numpy as np
    import trimesh

    from feederscrew.output import shading
    from feederscrew.output.shading import Camera

    part, blade = trimesh.creation.box((1.0, 1.0, 1.0)), trimesh.creation.box((4.0, 4.0, 0.1))
    blade.apply_translation((0.0, 0.0, 2.0))
    camera = Camera(
        right=np.array([1.0, 0.0, 0.0]),
        up=np.array([0.0, 1.0, 0.0]),
        towards_viewer=np.array([0.0, 0.0, 1.0]),
    )
    meshes = ((one.vertices, one.faces) for one in (blade, part))
    image, _, _ = shading.pair_picture(*meshes, np.zeros(3), camera, 1.5, 60, 60)
    colours = [image[30, 30], image[5, 5]]
    assert np.abs(colours[0] - colours[1]).max() > 0.04
    assert (np.abs(image - image[5, 5]).max(axis=2) > 0.02)[20:40, 20:40].all()


def test_the_history_of_a_loop_can_be_read():
    """Once it was 7 x 3 pixels."""
    from types import SimpleNamespace

    from feederscrew.output import designs

    attempts = [SimpleNamespace(rate=0.5 * k, clean=k > 1, wanted="A@0") for k in (1, 2)]
    figure = designs.history_figure(SimpleNamespace(attempts=attempts, request=SimpleNamespace(target=1.0)))
    assert (figure.get_size_inches() * figure.dpi >= [600, 250]).all()


def test_phases_of_a_cycle_are_told_apart_without_their_colours():
    assert len({convey_output.PHASE_LINES[name] for name in ("forward", "backward", "flight")}) == 3


def test_a_part_that_slips_back_is_said_to_slip_back():
    """Once the legend said 'part: backward'."""
    found = convey_study.convey(read(None, ("drive.amplitude=0.4 mm", "drive.frequency=50 Hz")))
    assert found.answer.fractions["backward"] > 0.1
    shown = convey_output.cycle(found.trace(), found.bowl.drive.amplitude, found.answer)
    labels = [label for axes in shown.axes for label in axes.get_legend_handles_labels()[1]]
    rows = convey_output.summary(convey_output.document(found))["quantity"]
    assert "part slips back" in labels and "time it slips back [%]" in rows
    assert not any("backward" in text for text in (*labels, *rows))


def test_the_heading_of_a_column_of_numbers_stands_over_them():
    cells = ((MarkedCell("b"), MarkedCell("7", "number")), (MarkedCell("a"), MarkedCell("failed", "failed")))
    page = html(Page("all", "", (Chapter((Matrix(("part", "mass"), cells),)),)))
    assert '<th>part</th><th class="number">mass</th>' in page
