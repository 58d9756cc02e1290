"""Figures: their labels, their data, and the same bytes every time."""

from itertools import pairwise

import matplotlib.pyplot
import numpy as np
import pytest

from feederscrew.output import aspects, style
from feederscrew.resting.rules import registry

LOOKED_AT = True

NAMES = ["A", "B", "C"]
PROFILES = {"pmi": np.array([0.5, 0.3, 0.2]), "csa": np.array([0.6, 0.4, np.nan])}


def heights(axes):
    return [bar.get_height() for bar in axes.patches]


def test_bars_show_percentages_by_aspect_and_rule():
    axes = aspects.profile_bars(NAMES, PROFILES, title="nut").axes[0]
    assert heights(axes) == pytest.approx([50.0, 30.0, 20.0, 60.0, 40.0, 0.0])
    assert [label.get_text() for label in axes.get_xticklabels()] == NAMES
    assert [text.get_text() for text in axes.texts] == ["50.0", "30.0", "20.0", "60.0", "40.0"]
    assert axes.get_legend_handles_labels()[1] == ["PMI", "CSA"]
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title(loc="left")) == (
        "aspect",
        "probability [%]",
        "nut",
    )


ANSWER = [[0.5, 0.3, 0.2], [0.4, 0.1, 0.0], [0.7, 0.4, 0.35]]


def test_the_recommended_answer_is_a_bar_with_its_interval_and_comes_first():
    figure = aspects.answer_bars(NAMES, ANSWER, PROFILES, title="nut")
    axes = figure.axes[0]
    assert heights(axes) == pytest.approx([50.0, 30.0, 20.0])
    ends = [segment[:, 1] for segment in axes.collections[0].get_segments()]
    assert np.array(ends) == pytest.approx(100.0 * np.array(ANSWER[1:]).T)
    assert [text.get_text() for text in axes.texts] == ["50.0", "30.0", "20.0"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [aspects.ANSWERED, "PMI", "CSA"]


@pytest.mark.parametrize("count", [1, 3, 6, 24])
def test_the_answered_chart_keeps_everything_on_its_page(count):
    names = [chr(65 + k) for k in range(count)]
    share = np.full(count, 0.123)
    figure = aspects.answer_bars(
        names, [share, 0.5 * share, 2.0 * share], dict.fromkeys(registry.RULE_NAMES, share)
    )
    figure.draw_without_rendering()
    legend = figure.legends[0].get_window_extent()
    assert 0.0 <= legend.x0 < legend.x1 <= figure.bbox.width
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert not any(a.overlaps(b) for a, b in pairwise(boxes))
    assert all(box.y1 <= figure.axes[0].get_window_extent().y1 for box in boxes)


def test_bars_of_one_aspect_stand_side_by_side():
    axes = aspects.profile_bars(["A"], {"pmi": [1.0], "csa": [1.0], "stability": [1.0]}).axes[0]
    left = [bar.get_x() for bar in axes.patches]
    assert np.all(np.diff(left) >= axes.patches[0].get_width())


def test_many_bars_keep_their_numbers_apart():
    names = [chr(65 + k) for k in range(20)]
    figure = aspects.profile_bars(names, {rule: np.full(20, 0.05) for rule in registry.RULE_NAMES})
    assert figure.get_figwidth() <= aspects.WIDE_IN
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert not any(a.overlaps(b) for a, b in pairwise(boxes))


def test_the_numbers_stay_below_the_top():
    figure = aspects.profile_bars(NAMES, PROFILES)
    figure.draw_without_rendering()
    top = figure.axes[0].get_window_extent().y1
    assert all(text.get_window_extent().y1 <= top for text in figure.axes[0].texts)


def test_the_same_figure_gives_the_same_bytes_and_no_version():
    first, second = (style.png(aspects.profile_bars(NAMES, PROFILES)) for _ in range(2))
    assert first == second
    assert first.startswith(b"\x89PNG")
    assert b"atplotlib" not in first


def test_figures_leave_no_global_state():
    style.png(aspects.profile_bars(NAMES, PROFILES))
    assert matplotlib.pyplot.get_fignums() == []


def test_methods_keep_their_colour_and_others_get_a_spare_one():
    assert style.method("csa") == ("CSA", "#e69f00")
    assert style.method("MDBT_80", 1) == ("MDBT 80", style.SPARE_COLOURS[1])


@pytest.mark.parametrize("name", ["$dollar^_{x}$", "$\\mathdefault{$", "部品\t", "bad\udcff\udcfe", r"a\$b"])
def test_any_name_can_stand_anywhere_in_a_figure(name):
    figure = style.figure()
    axes = style.tidy(figure.add_subplot(), title=name, x=name, y=name)
    axes.plot([1.0, 2.0], [1.0, 2.0], label=name)
    axes.set_xticks([1.0], labels=[name])
    axes.legend()
    assert style.png(figure) == style.png(figure)


def test_names_are_no_formulas_and_a_letter_without_a_glyph_is_told_by_its_number():
    figure = style.figure()

    def width(text):
        return figure.text(0.0, 0.0, text).get_window_extent().width

    assert width("$x^{2}$ and more") > width("x2 and more")
    assert width("部") == width(r"\u90e8")
    assert width("a\udcff") == width(r"a\udcff")


def test_tidy_labels_an_axes():
    axes = style.tidy(style.figure().add_subplot(), title="t", x="x [mm]", y="y [N]", grid="none")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [mm]", "y [N]")
    assert not axes.spines["top"].get_visible()


def test_the_rules_are_told_apart_without_their_colours():
    axes = aspects.answer_bars(NAMES, ANSWER, PROFILES).axes[0]
    marks = [line.get_marker() for line in axes.lines if line.get_label() in map(rule_label, PROFILES)]
    assert len(set(marks)) == len(PROFILES) > 1
    assert len(aspects.MARKS) >= len(registry.RULE_NAMES)


def rule_label(name):
    return style.method(name)[0]
