"""The report as data and as text."""

import base64
import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
import trimesh
from scipy.spatial.transform import Rotation

import feederscrew as fs
from feederscrew import bowl as bowls
from feederscrew.arrivals.aspects_study import AspectsStudy
from feederscrew.arrivals.entry import Shares
from feederscrew.base.columns import ColumnHead, Frame, share_head
from feederscrew.output import DPI, style
from feederscrew.output import report_page as report_output
from feederscrew.output.page import as_html, blocks
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import Chapter, Page, Picture, Table
from feederscrew.output.report import ReportStudy, report
from feederscrew.output.report_page import BESIDE, CHAPTERS, THROWN, aspect_views, on_track, page
from feederscrew.output.shading import reduced_mesh
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.trials.course import FATES
from feederscrew_cli.report import repeat_command

PARTS = Path(__file__).parents[2] / "parts"


def chapters(*names):
    return [chapter for chapter in CHAPTERS if chapter[0] in names]


LIGHT = chapters("aspects", "part", "limits", "repeat")


@pytest.fixture(scope="module")
def bracket():
    return load(str(PARTS / "lbracket_30x20x15.stl"))


@pytest.fixture(scope="module")
def case(bracket):
    """What a report of the bracket is made of."""
    return report(bracket, command="feeder report x.stl")


@pytest.fixture(scope="module")
def light(case):
    """A report of the bracket without what takes long."""
    return page(case, chapters=LIGHT)


def decoded(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=kind)


@pytest.mark.parametrize("name", ["lbracket_30x20x15", "hexbolt_m8x25", "dowel_6x20"])
def test_the_mesh_is_stored_once_and_every_pose_stands_on_the_floor(name):
    part = load(str(PARTS / f"{name}.stl"))
    found = find(part)
    stored = next(aspect_views(part, AspectsStudy(part, found))).scene
    points = decoded(stored["positions"], "<f4").reshape(-1, 3)
    for kind, pose in zip(found.kinds, stored["poses"], strict=True):
        turn, height = Rotation.from_quat(pose["quaternion"]), pose["height"]
        contact = turn.apply(np.reshape(pose["contact"], (-1, 3)))[:, 2] + height
        ripple = (0.05 if kind == "rolling" else 1e-3) * height  # a tessellated curve is higher at edges
        assert np.abs(contact).max() < ripple
        assert abs((turn.apply(points)[:, 2] + height).min()) < ripple
    index = decoded(stored["index"], "<u4").reshape(-1, 3)
    assert len(index) == stored["facets"] == stored["all"] == len(part.faces)
    six_volumes = np.linalg.det(points[index].astype(float)).sum()
    assert six_volumes / 6.0 == pytest.approx(part.volume * 1e9, rel=1e-4)
    assert len(json.dumps(stored)) < 1.5 * (4 * 3 * len(part.vertices) + 12 * len(index)) + 3500


def test_a_large_mesh_is_reduced_to_its_shape_and_its_view_says_so(bracket, monkeypatch):
    ball = trimesh.creation.uv_sphere(radius=1.0, count=[120, 240])
    points, kept = reduced_mesh(ball.vertices, ball.faces, most=10_000)
    assert 2_000 < len(kept) <= 10_000
    assert np.allclose(np.linalg.norm(points, axis=1), 1.0, rtol=0.02, atol=0)
    assert np.linalg.det(points[kept]).sum() / 6.0 == pytest.approx(4.0 * np.pi / 3.0, rel=0.02)
    monkeypatch.setattr("feederscrew.output.shading.reduced_mesh", lambda v, f: (v, f[:-2]))
    text, count = html(page(report(bracket), chapters=LIGHT[:1])), len(bracket.faces)
    assert f"a coarser surface of {count - 2} facets; every number is of all {count}" in text


def test_html_loads_nothing_from_outside_and_has_the_cells_of_the_csv(light, case):
    text = html(light)
    assert not re.search(r"""(src|href)\s*=\s*["']?(https?:)?//""", text)
    assert "default-src 'none'" in text
    named = set(re.findall(r"https?://[\w./-]+", text))  # a name of XML, and a paper in a comment of three.js
    assert named == {"http://www.w3.org/1999/xhtml", "https://jcgt.org/published/0007/04/01/"}
    assert "The MIT License" in text and "three.js authors" in text
    sheet = next(b for s in light.sections for b in s.blocks if isinstance(b, blocks.CsvSheet))
    inside = re.search(r'id="aspects.csv">(.*?)</table>', text, re.S).group(1)
    rows = [re.findall(r"<t[hd]>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", inside)]
    assert "".join(",".join(row) + "\n" for row in rows) == sheet.csv
    folder = Path(blocks.__file__).parent / "vendor/three"
    digests = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.glob("*.js")}
    listed = dict(re.findall(r"`(three\S+js)` \| `(\w{64})`", (folder / "README.md").read_text()))
    assert len(digests) == 2 and digests == listed
    assert (folder / "LICENSE").read_text() in text
    # Markdown has every chapter and no script.
    text = markdown(light, BESIDE)
    heads = [line[3:] for line in text.splitlines() if line.startswith("## ")]
    assert heads == [section.title for section in light.sections]
    assert "![The part as it rests on each aspect](report/aspects.png)" in text
    assert "| A | on its largest face | no | 1 | yes | 4.651 | 450.0 | 3.699 | 1218 |" in text
    assert "| A | 31.2 | 42.7 | 34.9 |" in text and "<script" not in text
    # Shapes and probabilities are a table each: one of both would be broader than a window.
    section = next(section for section in light.sections if section.anchor == "aspects")
    forms, chances = (block.frame for block in section.blocks if isinstance(block, Table))
    assert list(forms["aspect"]) == list(chances["aspect"])
    assert {"height_mm", "contact_area_mm2", "barrier_mm", "tip_angle_deg"} <= set(forms)
    assert {"p_pmi", "p_csa", "p_surface"} <= set(chances)
    assert all(name == "aspect" or name.startswith("p_") for name in chances)
    assert not any(name.startswith("p_") for name in forms)
    # The views show the recommended answer first, with its interval.
    answer = case.resting.recommended
    views = next(block for s in light.sections for block in s.blocks if isinstance(block, blocks.Views))
    for row, (_, _, bars) in enumerate(views.captions):
        assert bars[0].label == "recommended" and bars[0].interval == (answer.low[row], answer.high[row])
        assert not any(bar.interval for bar in bars[1:])
    assert f"({100.0 * answer.low[0]:.0f}–{100.0 * answer.high[0]:.0f})" in html(light)


def test_what_cannot_be_computed_or_does_not_travel_is_said_and_markup_is_text(bracket):
    made = page(report(bracket, bowl=fs.read_bowl(radius="10 mm")), chapters=chapters("track", "rate"))
    for section in made.sections:
        (notes,) = section.blocks
        assert notes.loud and len(notes.lines) == 1 and " - " in notes.lines[0]
    assert made.warnings == tuple(f"{s.title}: {s.blocks[0].lines[0]}" for s in made.sections)
    assert made.tiles == ()
    # A bowl too steep to travel.
    steep = report(bracket, bowl=fs.read_bowl(climb="40 deg"))
    velocity, rate = page(steep, chapters=chapters("velocity", "rate")).sections
    assert "no steady state" in velocity.warnings[0]
    assert velocity.tiles == (blocks.Tile("travels", "–", "no steady state"),)
    assert velocity.blocks[-1].text.startswith("No drive of 5 to 60 deg")
    assert rate.blocks[0].lines[0].startswith("track.climb: is steeper than friction holds")
    # Markup in names is text.
    made = page(report(replace(bracket, name="<b>|*x*", source="a`<i>.stl")), chapters=chapters("part"))
    assert "<h1>&lt;b&gt;|*x*</h1>" in html(made) and "<i>" not in html(made)
    assert markdown(made).startswith("# \\<b>\\|\\*x\\*\n")


def test_a_part_card_has_no_views_and_its_likeliest_aspect_is_wanted():
    card = report(load(str(PARTS / "magnet.yaml")))
    text = html(page(card, chapters=(*LIGHT, *chapters("tipping"))))
    assert "without a shape: there is nothing to draw or to turn" in text
    assert "is a part card, it has no shape to tumble" in text  # it was a KeyError
    assert "<canvas" not in text and "THREE" not in text
    assert card.aspect == "3"  # of a card in the order of its source, 11, 14 and 75 % by CSA
    (tile,) = page(card, chapters=LIGHT[:1]).tiles
    assert tile == blocks.Tile("rests most often on", "aspect 3", "42.8 to 74.7 % of drops, by 3 rules")


def test_repeated_leaves_out_where_and_how_loud():
    typed = ["report", "a b.stl", "-o", "out", "--set", "drive.frequency=50 Hz", "-q", "--output=x"]
    line = "feeder report 'a b.stl' --set 'drive.frequency=50 Hz' --aspect B"
    assert repeat_command([*typed, "--aspect", "B"]) == line


def test_cells_for_people_and_a_column_for_each_fate_that_a_part_met():
    columns = {"aspect": ["A", None], "faces": [2, 10], "height_mm": [7.5, np.nan]}
    columns |= {"p_csa": [0.5, 1e-15], "fits": [True, False]}
    above = {"height_mm": ColumnHead.of_name("height_mm", "mm"), "p_csa": share_head("p_csa")}
    heads, numeric, texts = as_html.texts_of(Frame.of(columns).headed(above))
    assert heads[2:4] == [("height", "[mm]"), ("p csa", "[%]")]
    assert numeric == [False, True, True, True, False]
    assert list(zip(*texts)) == [("A", "2", "7.500", "50.0", "yes"), ("–", "10", "–", "0", "no")]
    # Of five bolts one was turned and one rolled back, and no column said so.
    counts = np.zeros((2, len(FATES)), dtype=int)
    for fates in ((), ("turned", "rolled_back")):
        for row, fate in enumerate(fates):
            counts[row, FATES.index(fate)] = 1
        names = "aspect heading_deg share tried passed {} leaves_as ended_at predicted margin_mm disagrees"
        assert report_output.columns(counts) == names.format(" ".join(fates)).split()


def test_one_drive_has_one_velocity(bracket, monkeypatch):
    """The chapters of velocity, rate, bowl and track: what has one label is equal."""
    monkeypatch.setattr(style, "png", lambda figure: b"")  # numbers are looked at
    targeted = report(bracket, target=1.0)
    made = page(targeted, chapters=chapters("velocity", "rate", "bowl", "track"))
    text, velocities = markdown(made, BESIDE), {}
    for label, value in re.findall(r"^\| ([^|]*velocity[^|]*\[mm/s\]) \| ([^|]*) \|$", text, re.M):
        velocities.setdefault(label, set()).add(value.partition(" (")[0])
    assert text.count("| velocity [mm/s] |") == 2 and all(len(values) == 1 for values in velocities.values())
    (value,) = velocities["velocity [mm/s]"]
    assert float(value) == pytest.approx(1e3 * targeted.convey.answer.velocity, rel=1e-3)
    assert made.tiles[0].value == f"{float(value):.1f} mm/s"
    assert "velocity at this stroke [mm/s]" in velocities and "velocity as it empties [mm/s]" in text
    along = "velocity along the wall, with its friction and the bank [mm/s]"
    assert float(*velocities[along]) == pytest.approx(1e3 * targeted.track.course.mean, rel=1e-4)


def laid_out(*shown):
    return html(Page("a", "", (Chapter(shown),))).split("</style>")[1]


def pairs(rows):
    return Table(Frame.of({"quantity": ["a"] * rows, "value": ["b"] * rows}))


def test_what_stands_alone_has_the_whole_width_and_names_with_values_are_set_in_two_halves(monkeypatch):
    """A list of thirty quantities took a page of paper and left its right half empty."""
    broad = Table(Frame.of({f"column_{k}": [1.0] for k in range(8)}))
    assert "beside" not in laid_out(pairs(30), broad)
    columns = laid_out(pairs(30), *[Table(Frame.of({"a": [1.0] * 9}))] * 3)
    assert columns.split('class="beside"')[1].count("<div>") == 2
    assert columns.split("<div>")[2].count("<table>") == 3  # the short ones below each other
    assert laid_out(pairs(13), pairs(7)).count('<table class="pairs">') == 1
    for height, tall in ((2.0, False), (8.0, True)):  # at the height of the others nobody could read it
        text = laid_out(pairs(1), Picture("a.png", style.png(style.figure(4.0, height)), ""))
        assert ('<div class="beside">' in text, 'class="plain tall"' in text) == (not tall, tall)
    monkeypatch.setattr(style, "DPI", DPI)
    picture = Picture("a.png", style.png(style.figure(4.0, 4.0)), "")  # 384 px; the table has 447
    texts = [laid_out(pairs(13), *[picture] * count) for count in (1, 2, 3)]
    above = [text.index('"pairs"') < text.index('<div class="beside">') for text in texts]
    assert above == [False, True, False]  # with three pictures the columns are even again


BOX = shapes.part(shapes.box(20, 14, 5))


def said(part, *overrides):
    settings, found = bowls.settings(None, overrides), find(part)
    case = ReportStudy(
        resting=AspectsStudy(part, found), settings=settings, bowl=bowls.record(settings), path=None,
        aspect="A", heading=None, rule="csa", gap=0.0, fill=1.0, target=None, counted=None,
        shares=Shares(found),
    )  # fmt: skip
    return on_track(case), case


def test_what_slides_is_thrown_rolls_back_slides_down_or_rocks_is_said():
    line, case = said(BOX)
    speed = 1e3 * case.rate.rate.velocity.value
    assert line.startswith(f"On this track the part travels at {speed:.1f} mm/s and slips both ways: the ")
    assert line.endswith("rate is computed with that. It stays on its aspect through the stroke.")
    assert THROWN in said(BOX, "drive.amplitude=0.4 mm")[0]
    ball = said(shapes.part(shapes.ball(5.0, 3)))[0]
    assert ball.endswith("It lies on its round side and rolls back down the climb, so the rate is 0.")
    assert said(BOX, "track.climb=40 deg")[0].endswith("slides down continuously: it does not travel.")
    rocks = said(shapes.part(shapes.box(2, 2, 8)), "friction.static=0.9", "track.climb=1 deg")[0]
    assert "travels at" in rocks and "turns it over" not in rocks
