"""The thesis gone through: items, statements on the figures, chapter 5, the page and the pictures."""

import re
from dataclasses import replace

import numpy as np
import pytest

from feederscrew.mechanics import limits
from feederscrew.output import style
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import Chapter, Heading, Links, MarkedCell, Matrix, Page
from feederscrew.thesis import chapter_5, figure_data, reproduction
from feederscrew.thesis.claims import Claim, claims
from feederscrew.thesis.findings import BY_ID, FINDINGS
from feederscrew.thesis.pages import figures as thesis_plots
from feederscrew.thesis.pages import page as thesis_page
from feederscrew.thesis.printed_cells import DIFFERS, EXACT, EXPLAINED, Cell
from feederscrew.thesis.printed_tables import NUMBERS, table

FIGURES = [f"3-{n}" for n in range(6, 14)] + [f"5-{n}" for n in range(1, 8)]
BY_NUMBER = {figure.number: figure for figure in figure_data.FIGURES}


@pytest.fixture(scope="module")
def items():
    return reproduction.items()


@pytest.fixture(scope="module")
def page(items):
    """The page, every figure on it a white one."""
    white = style.png(style.page(2, 2))
    return thesis_page.page(items, {f"{i.stem}.png": white for i in items if i.kind == "figure"})


def blocks(page, kind):
    return [block for section in page.sections for block in section.blocks if isinstance(block, kind)]


def test_every_table_and_figure_is_an_item(items):
    keys = [(item.kind, item.id) for item in items]
    assert keys == [("table", n) for n in NUMBERS] + [("figure", n) for n in FIGURES]


def test_every_item_has_cells_and_none_differs(items):
    for item in items:
        counts = reproduction.summary(item)
        assert counts["cells"] == counts["exact"] + counts["explained"] + counts["differs"] > 0
        assert counts["cells"] + counts["given"] == len(item.entries)
    assert reproduction.unexplained(items) == []


def test_a_cell_that_differs_is_noticed(items):
    odd = replace(items[0], entries=(Cell("A", "csa", "1", 2.0),))
    assert reproduction.unexplained([odd, items[1]]) == [odd]


def test_explained_entries_name_a_finding_that_exists(items):
    for item in items:
        assert set(item.findings) <= set(BY_ID)
        assert {e.finding for e in item.entries if e.verdict == EXPLAINED} <= set(item.findings)


def test_every_finding_bears_on_an_item_or_on_chapter_4(items):
    carried = {id for item in items for id in item.findings}
    rest = [finding for finding in FINDINGS if finding.id not in carried]
    assert all("4." in finding.where for finding in rest)


@pytest.mark.parametrize("number", FIGURES)
def test_statements_in_print_hold_or_are_explained(number):
    assert [claim for claim in claims(number) if claim.verdict == DIFFERS] == []


def test_statements_that_do_not_hold_as_printed():
    failing = {(n, c.finding) for n in FIGURES for c in claims(n) if c.verdict == EXPLAINED}
    assert failing == {("3-10", "dominant-aspect"), ("3-12", "magnet-csa-mixed"), ("5-1", "beta-sliding")}


@pytest.mark.parametrize(
    ("holds", "finding", "explained", "verdict"),
    [
        (True, "", False, EXACT),
        (False, "hop", True, EXPLAINED),
        (False, "hop", False, DIFFERS),
        (False, "", True, DIFFERS),
    ],
)
def test_verdict_of_a_statement(holds, finding, explained, verdict):
    assert Claim("x", "1", 2.0, holds, finding, explained).verdict == verdict


def test_figure_5_1_is_equation_4_28():
    data = chapter_5.figure_5_1()
    assert list(data.limits) == [10.0, 20.0, 30.0, 40.0]
    g, b = 0.5, np.radians(20.0)
    at = np.flatnonzero(np.isclose(data.ratios, g, rtol=1e-12, atol=0))[0]
    assert data.limits[20.0][at] == pytest.approx(g * np.cos(b) / (1 - g * np.sin(b)), rel=1e-12)


@pytest.mark.parametrize(("number", "beta"), [("5-2", 10.0), ("5-3", 20.0), ("5-4", 40.0), ("5-5", 10.0)])
def test_figures_5_2_to_5_5_are_equation_4_27(number, beta):
    data, b = chapter_5.limit_surface(number), np.radians(beta)
    i, j = 30, 40
    g, turn = data.y[i], data.x[j]
    expected = g * np.cos(b) * np.cos(turn) / (1 - g * np.sin(b))
    assert data.values[i, j] == pytest.approx(expected, rel=1e-12)
    assert not data.hops.any()


def test_figure_5_6_has_its_maximum_where_tan_beta_is_mu():
    data = chapter_5.figure_5_6()
    best = data.x[data.values.argmax(axis=1)]
    np.testing.assert_allclose(best, np.arctan(data.y), rtol=0, atol=np.radians(0.51))
    assert data.values[0, 0] == pytest.approx(0.5e-3 * (2 * np.pi * 60) ** 2, rel=1e-12)
    assert data.values[-1, 0] == pytest.approx(data.values[0, 0] - 9.8, rel=1e-12)


def test_figure_5_6_hops_from_7_9_degrees():
    data = chapter_5.figure_5_6()
    np.testing.assert_array_equal(data.hops.any(axis=0), np.degrees(data.x) > 7.93)


def test_figure_5_7_grows_with_the_amplitude_and_with_the_square_of_the_frequency():
    data = chapter_5.figure_5_7()
    drive = data.values + 0.5 * 9.8
    np.testing.assert_allclose(drive[:, 100], 4.0 * drive[:, 50], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(drive[50], 2.0 * drive[25], rtol=1e-12, atol=1e-12)
    assert data.hops[-1, -1] and not data.hops[0].any() and not data.hops[:, 0].any()


def test_sliding_starts_at_the_limiting_friction():
    ratio, beta = 0.6, np.radians(25.0)
    at_limit = limits.published_limit(ratio, beta)
    assert chapter_5.sliding_acceleration(ratio * 9.8, beta, at_limit) == pytest.approx(0.0, abs=1e-12)


def test_figure_3_7_goes_through_the_table(items):
    data = figure_data.pmi_by_ratio()
    _, points = data.points["Table 3-9"]
    for name, line in data.lines.items():
        np.testing.assert_allclose(line, points[name], rtol=0, atol=5e-5)


def test_figure_3_8_shows_what_survives():
    data = figure_data.csa_by_ratio()
    assert list(data.points) == ["CSA, Table 3-1", "experiment, Table 3-1"]
    assert all(len(ratios) == 1 for ratios, _ in data.points.values())


@pytest.mark.parametrize("number", ["3-6", "3-9", "3-10", "3-11", "3-12", "3-13"])
def test_bar_charts_hold_whole_profiles(number):
    data = BY_NUMBER[number].data()
    for values in data.profiles.values():
        assert len(values) == len(data.aspects)
        assert values.sum() == pytest.approx(1.0, abs=2e-3)
    for name, printed in data.printed.items():
        np.testing.assert_allclose(data.profiles[name], printed, rtol=0, atol=1e-4)


def test_drawn_bars_are_the_numbers():
    figure = thesis_plots.drawn(BY_NUMBER["3-9"])
    (axes,) = figure.axes
    data = BY_NUMBER["3-9"].data()
    for container, values in zip(axes.containers, data.profiles.values(), strict=True):
        assert [bar.get_height() for bar in container] == pytest.approx(list(100.0 * values))
    assert axes.get_ylabel() == "probability [%]"
    assert axes.get_title(loc="left").startswith("Figure 3-9.")


def test_drawn_curves_are_the_numbers():
    left, _ = thesis_plots.drawn(BY_NUMBER["5-1"]).axes
    data = chapter_5.figure_5_1()
    for line, values in zip(left.lines, data.limits.values(), strict=True):
        np.testing.assert_array_equal(line.get_ydata(), values)


def test_the_hop_region_is_marked():
    axes = thesis_plots.drawn(BY_NUMBER["5-6"]).axes
    assert "Where the part slides" in [each.get_title(loc="left") for each in axes]
    assert any("not a part's" in text.get_text() for each in axes for text in each.texts)


def test_figure_5_7_marks_where_the_part_sticks():
    axes = thesis_plots.drawn(BY_NUMBER["5-7"]).axes
    assert "sticks" in [text.get_text() for each in axes for text in each.texts]


@pytest.mark.parametrize("number", FIGURES)
def test_numbers_of_a_figure_are_a_table(number):
    frame = thesis_plots.numbers(BY_NUMBER[number])
    assert len(frame.rows()) >= 3
    assert not any(cell is None or cell != cell for row in frame.rows() for cell in row.values())


def test_the_page_follows_the_thesis(items, page):
    titles = [block.text for block in blocks(page, Heading)]
    order = [re.match(r"(Table|Figure) (\S+)\.", title) for title in titles]
    found = [(m[1].lower(), m[2]) for m in order if m]
    assert found == thesis_page.ORDER
    assert len(set(found)) == len(items)
    assert titles[len(found) :] == [f"{f.id}: {f.where}" for f in FINDINGS]


def test_chapter_4_names_each_equation_and_its_slip(page):
    told = {label: text for links in blocks(page, Links) for _, label, text in links.entries}
    assert told["radial-gravity"].startswith("Equation [4.33]. ")
    assert told["alpha-plus-theta"].endswith("the print gives 0.766.")


def test_the_page_shows_print_and_ours(items):
    by_id = {(item.kind, item.id): item for item in items}
    entry = {(e.row, e.column): e for e in by_id["table", "3-13"].entries}["CSA - PMI", "deviation"]
    assert thesis_page.shown(entry) == "0.089 → 0.2292 (0.0897)"
    assert thesis_page.shown(Cell("a", "b", "0.12", 0.5)) == "0.12 → 0.500 DIFFERS"
    assert thesis_page.shown(Cell("a", "b", "0.12", 0.12)) == "0.12"
    assert thesis_page.shown(Cell("a", "b", "1.2.3", 1.203, finding="x")) == "1.2.3 → 1.20"


def test_markdown_links_lead_somewhere(items, page):
    text = markdown(page)
    links, anchors = set(re.findall(r"\]\(#([\w-]+)\)", text)), set(re.findall(r'<a id="([\w-]+)">', text))
    assert links and links <= anchors
    assert "| 1 → 3.1 (1.5) |" in text
    assert re.findall(r"!\[.*\]\((.*)\)", text) == [i.stem + ".png" for i in items if i.kind == "figure"]


def test_html_needs_no_other_file(items, page):
    text = html(page)
    assert text.count("data:image/png;base64,iVBORw") == sum(item.kind == "figure" for item in items)
    assert not re.search(r'(src|href)="(?!data:|#)', text)
    links, anchors = set(re.findall(r'href="#([\w-]+)"', text)), set(re.findall(r'id="([\w-]+)"', text))
    assert links and links <= anchors


def test_html_escapes_what_markdown_may_say():
    text = html(Page("a < b", "", (Chapter((Matrix(("x",), ((MarkedCell("<b>", "exact"),),)),)),)))
    assert "<h1>a &lt; b</h1>" in text and '<td class="exact">&lt;b&gt;</td>' in text


def test_tables_on_the_page_have_every_printed_row(items):
    for item in items:
        if item.kind == "table":
            grid = next(block for block in thesis_page._item(item, {}) if isinstance(block, Matrix))
            rows = [row[0].text for row in grid.rows]
            assert rows[: len(table(item.id).rows)] == list(table(item.id).rows)
