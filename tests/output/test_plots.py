"""Figures: their labels, their data, and the same bytes every time."""

import math
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.colors import to_rgba_array

from feederscrew import bowl
from feederscrew.mechanics.limits import published_ratio
from feederscrew.output import aspects, style
from feederscrew.output import slide as slide_output
from feederscrew.output.tables import regime_words
from feederscrew.resting.rules import registry
from feederscrew.studies.slide import sliding_map

LOOKED_AT = True

NAMES = ["A", "B", "C"]
PROFILES = {"pmi": np.array([0.5, 0.3, 0.2]), "csa": np.array([0.6, 0.4, np.nan])}
ANSWER = [[0.5, 0.3, 0.2], [0.4, 0.1, 0.0], [0.7, 0.4, 0.35]]


def heights(axes):
    return [bar.get_height() for bar in axes.patches]


def words(texts):
    return [text.get_text() for text in texts]


def test_bars_show_percentages_by_aspect_and_rule_the_same_bytes_each_time():
    figure = aspects.profile_bars(NAMES, PROFILES, title="nut")
    (axes,) = figure.axes
    assert heights(axes) == pytest.approx([50.0, 30.0, 20.0, 60.0, 40.0, 0.0])
    assert words(axes.get_xticklabels()) == NAMES
    assert words(axes.texts) == ["50.0", "30.0", "20.0", "60.0", "40.0"]
    assert axes.get_legend_handles_labels()[1] == ["PMI", "CSA"]
    labels = axes.get_xlabel(), axes.get_ylabel(), axes.get_title(loc="left")
    assert labels == ("aspect", "probability [%]", "nut")
    image = style.png(figure)
    assert image == style.png(aspects.profile_bars(NAMES, PROFILES, title="nut"))
    assert image.startswith(b"\x89PNG") and b"atplotlib" not in image  # no version of it


def test_the_recommended_answer_is_a_bar_with_its_interval_and_rules_differ_without_their_colours():
    figure = aspects.answer_bars(NAMES, ANSWER, PROFILES, title="nut")
    axes = figure.axes[0]
    assert heights(axes) == pytest.approx([50.0, 30.0, 20.0])
    ends = [segment[:, 1] for segment in axes.collections[0].get_segments()]
    assert np.array(ends) == pytest.approx(100.0 * np.array(ANSWER[1:]).T)
    assert words(axes.texts) == ["50.0", "30.0", "20.0"]
    assert words(figure.legends[0].get_texts()) == [aspects.ANSWERED, "PMI", "CSA"]
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


@pytest.mark.parametrize("name", ["$dollar^_{x}$", "$\\mathdefault{$", "部品\t", "bad\udcff\udcfe", r"a\$b"])
def test_any_name_can_stand_anywhere_in_a_figure(name):
    figure = style.figure()
    axes = style.tidy(figure.add_subplot(), title=name, x=name, y=name)
    axes.plot([1.0, 2.0], [1.0, 2.0], label=name)
    axes.set_xticks([1.0], labels=[name])
    axes.legend()
    assert style.png(figure)


def test_names_are_no_formulas_and_a_letter_without_a_glyph_stands_as_its_number():
    figure = style.figure()

    def width(text):
        return figure.text(0.0, 0.0, text).get_window_extent().width

    assert width("$x^{2}$ and more") > width("x2 and more")
    assert (width("部"), width("a\udcff")) == (width(r"\u90e8"), width(r"a\udcff"))


# Pictures of slip

SMALL = (61, 51)  # cells, for speed


def slide(beta=20, *overrides):
    return sliding_map(bowl.read(None, overrides), math.radians(beta), shape=SMALL)


def texts(figure):
    """Every text of a figure that is not a tick."""
    legends = [figure.axes[0].get_legend(), *figure.legends]
    return words(figure.axes[0].texts) + [t for one in legends if one for t in words(one.get_texts())]


@pytest.mark.parametrize(
    ("draw", "hop"),
    [(slide_output.regimes, math.cos(math.radians(3))), (slide_output.contours, 1.0)],
)
def test_the_own_point_is_marked_where_the_bowl_works_and_the_hop_begins_at_its_ratio(draw, hop):
    own = slide(20, "drive.amplitude=0.05 mm", "drive.frequency=60 Hz", "drive.direction=25 deg")
    figure = draw(own)
    (marker,) = [line for line in figure.axes[0].lines if line.get_marker() == "o"]
    assert marker.get_xydata()[0] == pytest.approx([25, own.ratio])
    assert "this bowl, G = 0.724" in texts(figure)
    begins = [line.get_ydata()[0] for line in draw(slide(20)).axes[0].lines if line.get_marker() != "o"]
    assert begins == pytest.approx([hop / math.sin(math.radians(20))])


def test_the_regime_map_shows_its_codes_and_names_them():
    one = slide(20)
    figure = slide_output.regimes(one)
    (image,) = figure.axes[0].images
    colours = 255.0 * to_rgba_array([slide_output.SLIDE_COLOURS[name] for name in one.grid.names])
    assert (np.asarray(image.get_array()) == np.round(colours)[one.grid.codes.T]).all()
    legend = [text.replace("\n", " ") for text in texts(figure)]
    for name, share in one.grid.shares().items():
        label = "no friction prevents forward slip (part hops)" if name == "hop" else regime_words(name)
        assert (label in legend) == (share > 0), name


def test_contour_lines_follow_4_27_and_carry_their_values():
    figure = slide_output.contours(
        sliding_map(bowl.default(), math.radians(20), shape=slide_output.MAP_SHAPE)
    )
    assert {"μ = 0.1", "μ = 1", "μ = 2", "this bowl's μ = 0.6"} <= set(texts(figure))
    assert "μ = 0.6" not in texts(figure)
    (drawn,) = (collection for collection in figure.axes[0].collections if hasattr(collection, "levels"))
    paths = [path for path in drawn.get_paths() if len(path.vertices)]
    angle, ratio = paths[list(drawn.levels).index(1.0)].vertices.T
    inner = np.abs(angle) < 60
    expected = published_ratio(1.0, math.radians(20), np.radians(angle[inner]))
    assert ratio[inner] == pytest.approx(expected, rel=1e-3)


def test_curves_are_4_28_for_each_angle():
    figure, b = slide_output.curves([slide(10), slide(40)]), math.radians(40)
    labels = words(figure.legends[0].get_texts())
    assert labels == ["β = 10°", "β = 40°", "slips back, this track", slide_output.OWN_LABEL]
    line = next(line for line in figure.axes[0].lines if line.get_label() == "β = 40°")
    ratio, friction = line.get_xydata()[np.isfinite(line.get_ydata())].T
    assert friction == pytest.approx(ratio * math.cos(b) / (1 - ratio * math.sin(b)), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("beta", [0, 90])
def test_extreme_angles_draw_without_a_warning(beta):
    one = slide(beta, "friction.static=0", "drive.amplitude=0 mm")
    figures = [draw(one) for draw in (slide_output.surface, slide_output.contours, slide_output.regimes)]
    assert all(style.png(figure) for figure in (*figures, slide_output.curves([one])))
