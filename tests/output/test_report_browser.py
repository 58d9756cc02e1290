"""The report in a browser: it loads without a fault, its views are drawn, turn and print."""

import functools
import re
from html import escape
from pathlib import Path

import browser
import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.base.columns import Frame
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.output import tooling_views
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page, Table, Views
from feederscrew.output.report import report
from feederscrew.output.report_page import CHAPTERS, over_cuts, page
from feederscrew.output.trial import rides
from feederscrew.part import load
from feederscrew.sorting.orientations import orientations
from feederscrew.trials.trial import trial

LOOKED_AT = True

BRACKET = Path(__file__).parents[2] / "parts" / "lbracket_30x20x15.stl"
AREA = 680 * 544  # pixels of a view
PROBE = """<script>
(() => {
  const canvas = document.querySelector(".view canvas"), paper = canvas.getContext("2d");
  const seen = () => {
    const pixels = paper.getImageData(0, 0, canvas.width, canvas.height).data, place = [0, 0, 0];
    for (let k = 0; k < pixels.length; k += 4) {
      const steel = pixels[k + 3] > 250 && pixels[k + 2] - pixels[k] > 15;
      if (!steel) continue;
      place[0] += 1; place[1] += (k / 4) % canvas.width; place[2] += Math.floor(k / 4 / canvas.width);
    }
    return place.map((sum, k) => (k ? sum / place[0] : sum));
  };
  const drag = (kind, x, y) =>
    canvas.dispatchEvent(new PointerEvent(kind, { clientX: x, clientY: y, pointerId: 1, bubbles: true }));
  canvas.setPointerCapture = () => {};
  const told = { start: seen() };
  drag("pointerdown", 100, 100); drag("pointermove", 220, 130); drag("pointerup", 220, 130);
  told.turned = seen();
  canvas.dispatchEvent(new MouseEvent("dblclick"));
  told.back = seen();
  canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
  told.key = seen();
  canvas.parentElement.querySelector("button").click();
  told.below = seen();
  told.views = document.querySelectorAll(".view canvas").length;
  document.title = JSON.stringify(told);
})();
</script>
</body>"""

pytestmark = pytest.mark.needs("chromium")


@pytest.fixture(scope="module")
def case():
    return report(load(str(BRACKET)), command="feeder report x.stl")


@pytest.fixture(scope="module")
def text(case):
    """The page without the chapters that take long."""
    wanted = [chapter for chapter in CHAPTERS if chapter[0] in ("aspects", "part", "limits", "repeat")]
    return html(page(case, chapters=wanted))


@pytest.fixture(scope="module")
def visit(tmp_path_factory):
    return functools.partial(browser.visit, tmp_path_factory.mktemp("visited"))


@pytest.fixture(scope="module")
def probed(tmp_path_factory):
    return functools.partial(browser.probed, tmp_path_factory.mktemp("probed"))


def test_views_are_drawn_and_turn(probed, text, case):
    seen, dom = probed(text, PROBE)
    assert '<body class="has-views">' in dom and '<div id="views" hidden' not in dom
    assert seen["views"] == len(case.resting.aspects.names) and seen["back"] == seen["start"]
    start = seen["start"][0]
    assert all(0.03 * AREA < seen[name][0] < 0.6 * AREA for name in ("start", "turned", "key", "below"))
    assert all(abs(seen[name][0] - start) > 0.01 * start for name in ("turned", "key", "below"))


def test_a_fault_of_the_page_and_what_may_not_load_are_seen(visit):
    wrong = '<script>nothing.there()</script><img src="http://localhost:9/x.png"></body>'
    _, console = visit(html(Page("none", "", ())).replace("</body>", wrong), "--dump-dom")
    assert len(console) == 2 and "nothing is not defined" in "".join(console)
    assert "Content Security Policy" in "".join(console)


PHONE = """<script>
(() => {
  const page = document.documentElement, shown = (e) => e.getClientRects().length > 0;
  const white = [...document.querySelectorAll("tr")].filter(shown).map((row) => {
    const lines = [...row.cells].filter(shown).map((cell) => {
      const text = document.createRange();
      text.selectNodeContents(cell);
      return text.getBoundingClientRect().height;
    });
    const tops = [...row.cells].filter(shown).map((cell) => Math.round(cell.getBoundingClientRect().top));
    return new Set(tops).size > 1 ? 0 : Math.max(...lines) - Math.min(...lines);
  });
  const over = page.scrollWidth - innerWidth;
  document.title = JSON.stringify({ wide: innerWidth, over, white: Math.max(0, ...white) });
})();
</script></body>"""


@pytest.mark.parametrize("width", [390, 1280])
def test_no_row_of_a_table_is_white_beside_a_long_text(probed, width):
    """A reason of nine lines made rows of 300 px with nothing in the other columns, on a telephone."""
    why = "the trial rejects this design: 3 of 20 parts left in a wrong orientation; " * 6
    rows = {
        "trial": [1, 2],
        "wanted": ["A@188", "B@0"],
        "purity": [0.5, np.nan],
        "what goes wrong": [why, "-"],
    }
    page = Page("cap", "", (Chapter((Table(Frame.of(rows)),), title="The loop"),))
    text = escape(html(page).replace("</body>", PHONE))
    frame = f'<iframe style="width:{width}px;height:900px;border:0" srcdoc="{text}">'
    said, _ = probed(
        f"<html><head><title></title></head><body>{frame}</iframe></body></html>",
        "<script>onload = () => { document.title = frames[0].document.title; }</script></body>",
    )
    assert said["wide"] == width and said["over"] <= 0 and said["white"] < 120


def test_without_webgl_the_still_picture_stays(visit, text, tmp_path):
    dom, console = visit(text, "--disable-3d-apis", "--dump-dom")
    assert console == []
    assert '<body class="has-views">' not in dom and '<div id="views" hidden' in dom
    # It prints on A4.
    visit(text, "--no-pdf-header-footer", f"--print-to-pdf={tmp_path / 'page.pdf'}")
    paper = (tmp_path / "page.pdf").read_bytes()
    (box,) = {tuple(map(float, box.split())) for box in re.findall(rb"/MediaBox \[([\d. ]+)\]", paper)}
    assert box == pytest.approx((0.0, 0.0, 595.3, 841.9), abs=1.0)


WIDER = """<script>
window.addEventListener("load", () => {
  const paper = document.documentElement.clientWidth, found = [];
  for (const one of document.querySelectorAll("body *:not(.sheet *):not(.sheet)")) {
    const box = one.getBoundingClientRect();
    if (box.width > 0 && box.right > paper + 1) found.push(`${one.tagName}.${one.className}`);
  }
  document.title = JSON.stringify(found);
});
</script>
</body>"""
MACHINE = "change leaf_thickness_mm leaves natural_frequency_hz by_t_squared_hz above_drive gain stress_mpa"


def test_nothing_is_wider_than_the_paper(probed, text):
    """Where something is, a browser prints all of the page smaller: letters of 9 pt come out with 5."""
    columns = (
        {"quantity": ["acceleration of the track"] * 40, "value": ["1.234 m/s2"] * 40},
        {name: np.full(3, 124.5) for name in MACHINE.split()},
        {f"p_rule_{k}": np.full(3, 12.34) for k in range(13)},
    )
    added = html(Page("wide", "", (Chapter(tuple(Table(Frame.of(one)) for one in columns)),)))
    for shown in (text, added):
        printed = shown.replace("@media print {", "@media all {")
        assert probed(printed, WIDER, "--window-size=688,900", quiet=False)[0] == []


def test_the_part_turns_over_the_cut(probed, case):
    every = orientations(case.part, case.resting.aspects, case.bowl.track)
    shown = tooling_views.poses([make_device("gap", "test", limit=9e-3)], every, [0.1] * len(every), 0)
    views = Views(
        over_cuts(case.part, [met for met, _ in shown], every),
        tuple((met.orientation.name, words, ()) for met, words in shown), "cuts", "Orientation",
    )  # fmt: skip
    text = html(Page("part", "", (Chapter((views,), anchor="cuts-chapter", title="Tooling"),), "report"))
    seen, dom = probed(text, PROBE)
    assert '<div id="cuts" hidden' not in dom
    assert seen["views"] == 2 and seen["start"][0] > 0.02 * AREA
    assert seen["back"] == seen["start"] != seen["turned"]


PLAY = """<script>
(async () => {
  const figure = document.querySelectorAll(".view")[1], canvas = figure.querySelector("canvas");
  const button = figure.querySelector(".play"), bar = figure.querySelector("input");
  const wait = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));
  const seen = () => {
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let sum = 0;
    for (let k = 0; k < pixels.length; k += 4) sum = (31 * sum + pixels[k] + 7 * pixels[k + 3]) % 1000003;
    return { told: figure.querySelector("output").textContent, sum, button: button.textContent };
  };
  const told = { start: seen() };
  button.click(); await wait(0.2); told.playing = seen();
  button.click(); told.paused = seen(); await wait(0.1); told.still = seen();
  bar.value = 1; bar.dispatchEvent(new Event("input")); told.end = seen();
  button.click(); await wait(0.05); told.again = seen(); button.click();
  document.title = JSON.stringify(told);
})();
</script>
</body>"""


def test_a_trial_plays(probed, tmp_path):
    (tmp_path / "bowl.yaml").write_text("devices:\n  - gap: 9 mm\n")
    block = shapes.part(shapes.box(20, 12, 5))
    run = trial(block, [bowls.read(tmp_path / "bowl.yaml")], "A", parts=2).runs[0]
    scene, captions = rides.scene(block, run)
    fates = [words.rpartition(" ")[2] for _, words in captions]
    assert fates[0] == "passed" != fates[1]
    views = Views(scene, tuple((*one, ()) for one in captions), "trial-views", "Orientation", plays=True)
    chapter = Chapter((views,), anchor="trial", title="Trial")
    seen, _ = probed(html(Page("part", "", (chapter,), "report")), PLAY)
    times = {name: float(one["told"].split()[0]) for name, one in seen.items()}
    assert times["start"] == 0.0 < times["playing"] <= times["paused"] == times["still"] < times["end"]
    assert [seen[name]["button"] for name in ("start", "playing", "paused")] == ["play", "pause", "play"]
    assert seen["paused"]["sum"] == seen["still"]["sum"]
    assert len({seen[name]["sum"] for name in ("start", "paused", "end")}) == 3
    assert 0.0 < times["again"] < times["end"]  # from the start once it has come to the end


SORTED = """<script>
window.addEventListener("load", () => {
  const head = document.querySelector("th .sort");
  const read = () => [...document.querySelectorAll("tbody td")].map((cell) => cell.textContent).join("");
  const seen = [document.querySelectorAll("button").length, read()];
  head.click(); seen.push(read());
  head.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter" })); seen.push(read());
  document.title = JSON.stringify(seen);
});
</script></body>"""


def test_a_click_or_a_key_on_a_heading_sorts_the_rows(probed):
    """By a heading without a button: with one in it a browser prints no heading on later pages."""
    rows = tuple((MarkedCell(letter),) for letter in "bca")
    text = html(Page("all", "", (Chapter((Matrix(("part",), rows, sortable=True),)),)))
    assert probed(text, SORTED)[0] == [0, "bca", "abc", "cba"]


TELEPHONE = """<script>
window.addEventListener("load", () => {
  const seen = frames[0].document.documentElement;
  const button = seen.querySelector("figcaption > button").getBoundingClientRect();
  const lines = [...seen.querySelector("figcaption > span").getClientRects()];
  const under = lines.filter((one) =>
    one.right > button.left && one.top < button.bottom && one.bottom > button.top);
  document.title = JSON.stringify([seen.scrollWidth, frames[0].innerWidth, lines.length, under.length]);
});
</script></body>"""  # no browser without a head has a window of less than 500 pixels


def test_on_a_telephone_nothing_moves_the_page_sideways(probed):
    """The view of a trial was 384 pixels wide on a page of 358; tables and pictures scroll by themselves."""
    wide = Table(Frame.of({f"column_{k}_mm": np.full(3, 124.5) for k in range(20)}))
    words = "at sorter of two orientations, play 3.75 mm, sees their outline: passed"
    views = Views({"poses": []}, (("A@2", words, ()),), "trial-views", "Orientation", plays=True)
    text = html(Page("part", "", (Chapter((views, wide, wide), anchor="trial", title="Trial"),)))
    shown = text.split("<script")[0].replace(" hidden", "")  # as it is laid out, the views not drawn
    frame = f'<iframe width="390" height="900" frameborder="0" srcdoc="{escape(shown)}"></iframe>'
    seen, _ = probed(f"<title></title><body>{frame}</body>", TELEPHONE, quiet=False)
    width, window, lines, under = seen
    assert window == 390 and width <= window
    assert lines == 2 and under == 0  # of the caption: no line lies under the button beside it
