"""The report in a browser: it loads without a fault, its views are drawn, turn and print."""

import json
import re
import shutil
import subprocess
from html import escape, unescape
from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.output import style, tables, tooling_views
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page, Picture, Table, Views
from feederscrew.output.report import CHAPTERS, over_cuts, page
from feederscrew.output.trial import rides
from feederscrew.part import load
from feederscrew.studies.report import report
from feederscrew.studies.trial import trial
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations

LOOKED_AT = True

BRACKET = Path(__file__).parents[2] / "parts" / "lbracket_30x20x15.stl"
BROWSER = shutil.which("chromium")
FLAGS = (
    "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --use-gl=angle --use-angle=swiftshader "
    "--enable-unsafe-swiftshader --hide-scrollbars --window-size=1280,900 --virtual-time-budget=6000 "
    "--enable-logging=stderr"
).split()
ADVICE = ("GL Driver Message", "will-read-frequently")  # about the speed of drawing without a graphics card
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
  const rows = [...document.getElementById("aspects.csv").rows];
  told.table = rows.map((row) => [...row.cells].map((cell) => cell.innerText));
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
    """Load a page with one more flag; gives what came to stdout and the lines of the console."""
    folder = tmp_path_factory.mktemp("visited")

    def call(text, *flags):
        (folder / "page.html").write_text(text, encoding="utf-8")
        command = [
            BROWSER,
            *FLAGS,
            f"--user-data-dir={folder / 'profile'}",
            *flags,
            f"file://{folder / 'page.html'}",
        ]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        lines = [
            line
            for line in done.stderr.splitlines()
            if "CONSOLE" in line and not any(word in line for word in ADVICE)
        ]
        return done.stdout, lines

    return call


@pytest.fixture(scope="module")
def told(visit, text):
    """What the probe found out."""
    dom, console = visit(text.replace("</body>", PROBE), "--dump-dom")
    assert console == []
    assert '<body class="has-views">' in dom and '<div id="views" hidden' not in dom
    return json.loads(unescape(re.search(r"<title>(.*?)</title>", dom, re.S).group(1)))


def test_views_are_drawn_and_turn(told, case):
    assert told["views"] == len(case.resting.aspects.names)
    area = 680 * 544
    for name in ("start", "turned", "key", "below"):
        assert 0.03 * area < told[name][0] < 0.6 * area
    assert told["back"] == told["start"]
    for name in ("turned", "key", "below"):
        assert abs(told[name][0] - told["start"][0]) > 0.01 * told["start"][0]


def test_a_fault_of_the_page_and_what_may_not_load_are_seen(visit):
    wrong = '<script>nothing.there()</script><img src="http://localhost:9/x.png"></body>'
    _, console = visit(html(Page("none", "", ())).replace("</body>", wrong), "--dump-dom")
    assert len(console) == 2
    assert any("nothing is not defined" in line for line in console)
    assert any("Content Security Policy" in line for line in console)


def test_without_webgl_the_still_picture_stays(visit, text):
    dom, console = visit(text, "--disable-3d-apis", "--dump-dom")
    assert console == []
    assert '<body class="has-views">' not in dom and '<div id="views" hidden' in dom


def test_it_prints_on_a4(visit, text, tmp_path):
    visit(text, "--no-pdf-header-footer", f"--print-to-pdf={tmp_path / 'page.pdf'}")
    paper = (tmp_path / "page.pdf").read_bytes()
    boxes = {tuple(map(float, box.split())) for box in re.findall(rb"/MediaBox \[([\d. ]+)\]", paper)}
    assert len(boxes) == 1
    assert next(iter(boxes)) == pytest.approx((0.0, 0.0, 595.3, 841.9), abs=1.0)


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
TELEPHONE = """<script>
window.addEventListener("load", () => {
  const seen = frames[0].document.documentElement;
  const button = seen.querySelector("figcaption > button").getBoundingClientRect();
  const lines = [...seen.querySelector("figcaption > span").getClientRects()];
  const under = lines.filter((one) =>
    one.right > button.left && one.top < button.bottom && one.bottom > button.top);
  document.title = [seen.scrollWidth, frames[0].innerWidth, lines.length, under.length].join();
});
</script>"""  # no browser without a head has a window of less than 500 pixels
MACHINE = (
    "change leaf_thickness_mm leaves natural_frequency_hz by_t_squared_hz above_drive gain stress_mpa".split()
)


def test_nothing_is_wider_than_the_paper(visit, text):
    """Where something is, a browser prints all of the page smaller: letters of 9 pt come out with 5."""
    table = Table(tables.frame({name: np.full(3, 124.5) for name in MACHINE}))
    many = Table(tables.frame({f"p_rule_{k}": np.full(3, 12.34) for k in range(13)}))
    tall = Table(tables.frame({"quantity": ["acceleration of the track"] * 40, "value": ["1.234 m/s2"] * 40}))
    added = html(Page("wide", "", (Chapter((tall, table, table, many)),)))
    for shown in (text, added):
        printed = shown.replace("@media print {", "@media all {").replace("</body>", WIDER)
        dom, _ = visit(printed, "--window-size=688,900", "--dump-dom")
        assert json.loads(unescape(re.search(r"<title>(.*?)</title>", dom, re.S).group(1))) == []


def test_what_stands_alone_has_the_whole_width():
    small = Table(tables.frame({"quantity": ["a"] * 30, "value": ["b"] * 30}))
    broad = Table(tables.frame({f"column_{k}": [1.0] for k in range(8)}))
    assert "beside" not in html(Page("t", "", (Chapter((small, broad)),))).split("</style>")[1]
    columns = html(Page("t", "", (Chapter((small, *[Table(tables.frame({"a": [1.0] * 9}))] * 3)),)))
    assert columns.split('class="beside"')[1].count("<div>") == 2
    assert columns.split("<div>")[2].count("<table>") == 3  # the short ones below each other


def test_names_with_values_are_set_in_two_halves():
    """A list of thirty quantities took a page of paper and left its right half empty."""
    names, short = ({"quantity": ["a"] * rows, "value": ["b"] * rows} for rows in (13, 7))
    alone = html(Page("t", "", (Chapter((Table(tables.frame(names)), Table(tables.frame(short)))),)))
    assert alone.split("</style>")[1].count('<table class="pairs">') == 1
    picture = Picture("a.png", style.png(style.figure(4.0, 4.0)), "")
    table = Table(tables.frame(names))  # 447 px; a picture 384
    one, two, three = (html(Page("t", "", (Chapter((table, *[picture] * count)),))) for count in (1, 2, 3))
    above = [text.index('"pairs"') < text.index('<div class="beside">') for text in (one, two, three)]
    assert above == [False, True, False]  # with three pictures the columns are even again


def test_the_part_turns_over_the_cut(visit, case):
    every = orientations(case.part, case.resting.aspects, case.bowl.track)
    shown = tooling_views.poses([make_device("gap", "test", limit=9e-3)], every, [0.1] * len(every), 0)
    views = Views(
        over_cuts(case.part, [met for met, _ in shown], every),
        tuple((met.orientation.name, told, ()) for met, told in shown), "cuts", "Orientation",
    )  # fmt: skip
    text = html(Page("part", "", (Chapter((views,), anchor="cuts-chapter", title="Tooling"),), "report"))
    probe = PROBE.replace('[...document.getElementById("aspects.csv").rows]', "[]")
    dom, console = visit(text.replace("</body>", probe), "--dump-dom")
    assert console == []
    assert '<div id="cuts" hidden' not in dom
    told = json.loads(unescape(re.search(r"<title>(.*?)</title>", dom, re.S).group(1)))
    assert told["views"] == 2
    assert told["back"] == told["start"]
    assert told["turned"] != told["start"]
    assert told["start"][0] > 0.02 * 680 * 544


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


def test_a_trial_plays(visit, tmp_path):
    block = shapes.part(shapes.box(20, 12, 5))
    (tmp_path / "bowl.yaml").write_text("devices:\n  - gap: 9 mm\n")
    run = trial(block, [bowls.read(tmp_path / "bowl.yaml")], "A", parts=2).runs[0]
    scene, captions = rides.scene(block, run)
    fates = [told.rpartition(" ")[2] for _, told in captions]
    assert fates[0] == "passed" != fates[1]
    views = Views(scene, tuple((*told, ()) for told in captions), "trial-views", "Orientation", plays=True)
    text = html(Page("part", "", (Chapter((views,), anchor="trial", title="Trial"),), "report"))
    dom, console = visit(text.replace("</body>", PLAY), "--dump-dom")
    assert console == []
    told = json.loads(unescape(re.search(r"<title>(.*?)</title>", dom, re.S).group(1)))
    times = {name: float(one["told"].split()[0]) for name, one in told.items()}
    assert times["start"] == 0.0 < times["playing"] <= times["paused"] == times["still"] < times["end"]
    assert [told[name]["button"] for name in ("start", "playing", "paused")] == ["play", "pause", "play"]
    assert told["paused"]["sum"] == told["still"]["sum"]
    assert len({told[name]["sum"] for name in ("start", "paused", "end")}) == 3
    assert 0.0 < times["again"] < times["end"]  # from the start once it has come to the end


SORTED = """<script>
window.addEventListener("load", () => {
  const head = document.querySelector("th .sort");
  const read = () => [...document.querySelectorAll("tbody td")].map((cell) => cell.textContent).join("");
  const seen = [document.querySelectorAll("button").length, read()];
  head.click(); seen.push(read());
  head.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter" })); seen.push(read());
  document.title = seen.join();
});
</script></body>"""


def test_a_click_or_a_key_on_a_heading_sorts_the_rows(visit):
    """By a heading without a button: with one in it a browser prints no heading on later pages."""
    rows = tuple((MarkedCell(letter),) for letter in "bca")
    text = html(Page("all", "", (Chapter((Matrix(("part",), rows, sortable=True),)),)))
    dom, console = visit(text.replace("</body>", SORTED), "--dump-dom")
    assert console == []
    assert re.search(r"<title>(.*?)</title>", dom)[1] == "0,bca,abc,cba"


def test_on_a_telephone_nothing_moves_the_page_sideways(visit):
    """The view of a trial was 384 pixels wide on a page of 358; tables and pictures scroll by themselves."""
    scene, wide = {"poses": []}, tables.frame({f"column_{k}_mm": np.full(3, 124.5) for k in range(20)})
    words = "at sorter of two orientations, play 3.75 mm, sees their outline: passed"
    views = Views(scene, (("A@2", words, ()),), "trial-views", "Orientation", plays=True)
    text = html(
        Page("part", "", (Chapter((views, Table(wide), Table(wide)), anchor="trial", title="Trial"),))
    )
    shown = text.split("<script")[0].replace(" hidden", "")  # as it is laid out, the views not drawn
    frame = (
        f'<title></title><iframe width="390" height="900" frameborder="0" srcdoc="{escape(shown)}"></iframe>'
    )
    dom, _ = visit(frame + TELEPHONE, "--dump-dom")
    width, window, lines, under = map(int, re.search(r"<title>([\d,]+)</title>", dom)[1].split(","))
    assert window == 390 and width <= window
    assert lines == 2 and under == 0  # of the caption: no line lies under the button beside it
