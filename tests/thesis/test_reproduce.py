"""The thesis gone through: items, statements on the figures, chapter 5, the page and the pictures."""

import re
from dataclasses import replace

import numpy as np
import pytest

from feederscrew.output import style
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import Heading, Links
from feederscrew.thesis import figures, reproduction
from feederscrew.thesis.figures import FIGURE_OF, THESIS_FIGURES, Claim
from feederscrew.thesis.findings import FINDING_OF, FINDINGS
from feederscrew.thesis.tables import DIFFERS, EXACT_TO_PRINT, EXPLAINED, TABLES, Cell

NUMBERS = [f"3-{n}" for n in range(6, 14)] + [f"5-{n}" for n in range(1, 8)]


@pytest.fixture(scope="module")
def items():
    return reproduction.reproduce().items


@pytest.fixture(scope="module")
def page(items):
    """The page, every figure on it a white one."""
    white = style.png(style.page(2, 2))
    return reproduction.page(items, {f"{i.stem}.png": white for i in items if i.kind == "figure"})


def blocks(page, kind):
    return [block for section in page.sections for block in section.blocks if isinstance(block, kind)]


def test_every_table_and_figure_is_an_item_and_none_differs(items):
    names = [*(f"table {n}" for n in TABLES), *(f"figure {n}" for n in NUMBERS)]
    assert [item.name for item in items] == names
    for item in items:
        counts = item.counts
        assert counts["cells"] == counts["exact"] + counts["explained"] + counts["differs"] > 0
        assert counts["cells"] + counts["given"] == len(item.entries)
    assert reproduction.unexplained(items) == []
    odd = replace(items[0], entries=(Cell("A", "csa", "1", 2.0),))
    assert reproduction.unexplained([odd, items[1]]) == [odd]


def test_findings_bear_on_items_or_on_chapter_4(items):
    for item in items:
        assert set(item.findings) <= set(FINDING_OF)
        assert {e.finding for e in item.entries if e.verdict == EXPLAINED} <= set(item.findings)
    carried = {id for item in items for id in item.findings}
    carried |= {id for ids in reproduction.CONCLUSIONS.values() for id in ids}
    rest = [finding for finding in FINDINGS if finding.id not in carried]
    assert all("4." in finding.where or "2.2" in finding.where for finding in rest)


def test_statements_in_print_hold_but_for_three_that_are_explained():
    claims = [(figure.number, one) for figure in THESIS_FIGURES for one in figure.claims]
    odd = {(n, one.finding, one.verdict) for n, one in claims if one.verdict != EXACT_TO_PRINT}
    findings = {"3-10": "dominant-aspect", "3-12": "magnet-csa-mixed", "5-1": "beta-sliding"}
    assert odd == {(number, finding, EXPLAINED) for number, finding in findings.items()}
    assert Claim("x", "1", 2.0, False, "hop", False).verdict == DIFFERS
    assert Claim("x", "1", 2.0, False, "", True).verdict == DIFFERS


def test_figure_5_1_is_equation_4_28():
    data, g, b = figures.figure_5_1(), 0.5, np.radians(20.0)
    assert list(data.limits) == [10.0, 20.0, 30.0, 40.0]
    at = np.flatnonzero(np.isclose(data.ratios, g, rtol=1e-12, atol=0))[0]
    assert data.limits[20.0][at] == pytest.approx(g * np.cos(b) / (1 - g * np.sin(b)), rel=1e-12)


@pytest.mark.parametrize(("number", "beta"), [("5-2", 10.0), ("5-3", 20.0), ("5-4", 40.0), ("5-5", 10.0)])
def test_figures_5_2_to_5_5_are_equation_4_27(number, beta):
    data, b, i, j = figures.limit_surface(number), np.radians(beta), 30, 40
    expected = data.y[i] * np.cos(b) * np.cos(data.x[j]) / (1 - data.y[i] * np.sin(b))
    assert data.values[i, j] == pytest.approx(expected, rel=1e-12)
    assert not data.hops.any()


def test_figure_5_6_has_its_maximum_where_tan_beta_is_mu():
    data, greatest = figures.figure_5_6(), 0.5e-3 * (2 * np.pi * 60) ** 2
    best = data.x[data.values.argmax(axis=1)]
    np.testing.assert_allclose(best, np.arctan(data.y), rtol=0, atol=np.radians(0.51))
    np.testing.assert_allclose(data.values[[0, -1], 0], [greatest, greatest - 9.8], rtol=1e-12)


def test_figure_5_7_grows_with_the_amplitude_and_with_the_square_of_the_frequency():
    data = figures.figure_5_7()
    drive = data.values + 0.5 * 9.8
    np.testing.assert_allclose(drive[:, 100], 4.0 * drive[:, 50], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(drive[50], 2.0 * drive[25], rtol=1e-12, atol=1e-12)
    assert data.hops[-1, -1] and not data.hops[0].any() and not data.hops[:, 0].any()


def test_figure_3_7_goes_through_the_table():
    data = figures.by_ratio("pmi")
    _, points = data.points["Table 3-9"]
    for name, line in data.lines.items():
        np.testing.assert_allclose(line, points[name], rtol=0, atol=5e-5)


@pytest.mark.parametrize("number", ["3-6", "3-9", "3-10", "3-11", "3-12", "3-13"])
def test_bar_charts_hold_whole_profiles(number):
    data = FIGURE_OF[number].data()
    for values in data.profiles.values():
        assert len(values) == len(data.aspects) and values.sum() == pytest.approx(1.0, abs=2e-3)
    for name, printed in data.printed.items():
        np.testing.assert_allclose(data.profiles[name], printed, rtol=0, atol=1e-4)
    if number == "3-9":  # drawn bars are the numbers
        (axes,) = figures.draw(FIGURE_OF[number]).axes
        for container, values in zip(axes.containers, data.profiles.values(), strict=True):
            assert [bar.get_height() for bar in container] == pytest.approx(list(100.0 * values))
        assert axes.get_ylabel() == "probability [%]"
        assert axes.get_title(loc="left").startswith("Figure 3-9.")


def test_the_page_follows_the_thesis(page):
    titles = [block.text for block in blocks(page, Heading)]
    matches = [re.match(r"(Table|Figure) (\S+)\.", title) for title in titles]
    names = tuple(f"{match[1].lower()} {match[2]}" for match in matches if match)
    assert names == reproduction.ORDER_OF_THESIS
    assert titles[len(names) :] == [f"{f.title[:1].upper()}{f.title[1:]}: {f.where}" for f in FINDINGS]
    texts = {label: text for links in blocks(page, Links) for _, label, text in links.entries}
    assert texts["radial gravity left out"].startswith("Equation [4.33]. ")
    assert texts["alpha plus theta"].endswith("the print gives 0.766.")


def test_the_page_shows_print_and_ours(items):
    entries = next(item.entries for item in items if item.name == "table 3-13")
    entry = next(one for one in entries if (one.row, one.column) == ("CSA - PMI", "deviation"))
    for cell, text in (
        (entry, "0.089 → 0.2292 (0.0897)"),
        (Cell("a", "b", "0.12", 0.5), "0.12 → 0.500 DIFFERS"),
        (Cell("a", "b", "0.12", 0.12), "0.12"),
        (Cell("a", "b", "1.2.3", 1.203, finding="x"), "1.2.3 → 1.20"),
    ):
        assert reproduction.print_and_ours(cell) == text


def test_links_lead_somewhere_and_html_needs_no_other_file(items, page):
    names = [item.stem + ".png" for item in items if item.kind == "figure"]
    text = markdown(page)
    links, anchors = set(re.findall(r"\]\(#([\w-]+)\)", text)), set(re.findall(r'<a id="([\w-]+)">', text))
    assert links and links <= anchors and "| 1 → 3.1 (1.5) |" in text
    assert re.findall(r"!\[.*\]\((.*)\)", text) == names
    text = html(page)
    links, anchors = set(re.findall(r'href="#([\w-]+)"', text)), set(re.findall(r'id="([\w-]+)"', text))
    assert links and links <= anchors
    assert text.count("data:image/png;base64,iVBORw") == len(names)
    assert not re.search(r'(src|href)="(?!data:|#)', text)
