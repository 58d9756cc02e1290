"""The report as data and as text."""

import base64
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew import bowl as bowls
from feederscrew.output import report as report_output
from feederscrew.output import style, tables
from feederscrew.output.page import as_html, blocks
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.report import BESIDE, CHAPTERS, SLIDES_DOWN, THROWN, WORDS, on_track, page, scene
from feederscrew.output.shading import reduced_mesh
from feederscrew.part import load
from feederscrew.resting import aspects
from feederscrew.resting.aspects import find
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.studies.rate import Shares
from feederscrew.studies.report import ReportStudy, report
from feederscrew.trial.course import FATES
from feederscrew_cli.report import repeated

PARTS = Path(__file__).parents[2] / "parts"
BRACKET = PARTS / "lbracket_30x20x15.stl"
LIGHT = [chapter for chapter in CHAPTERS if chapter[0] in ("aspects", "part", "limits", "repeat")]
OUTSIDE = re.compile(r"""(src|href)\s*=\s*["']?(https?:)?//""")


@pytest.fixture(scope="module")
def bracket():
    return load(str(BRACKET))


@pytest.fixture(scope="module")
def case(bracket):
    """What a report of the bracket is made of."""
    return report(bracket)


@pytest.fixture(scope="module")
def light(bracket):
    """A report of the bracket without what takes long."""
    return page(report(bracket, command="feeder report x.stl"), chapters=LIGHT)


def decoded(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=kind)


@pytest.mark.parametrize("name", ["lbracket_30x20x15", "hexbolt_m8x25", "dowel_6x20"])
def test_every_pose_stands_on_the_floor(name):
    part = load(str(PARTS / f"{name}.stl"))
    found = aspects.find(part)
    told = scene(part, found, range(len(found.names)))
    points = decoded(told["positions"], "<f4").reshape(-1, 3)
    for kind, pose in zip(found.kinds, told["poses"]):
        turn = Rotation.from_quat(pose["quaternion"])
        contact = turn.apply(np.reshape(pose["contact"], (-1, 3)))[:, 2] + pose["height"]
        lowest = (turn.apply(points)[:, 2] + pose["height"]).min()
        ripple = (0.05 if kind == "rolling" else 1e-3) * pose[
            "height"
        ]  # a tessellated curve is higher at edges
        assert np.abs(contact).max() < ripple
        assert abs(lowest) < ripple


def test_the_mesh_is_stored_once_and_whole(bracket):
    found = aspects.find(bracket)
    told = scene(bracket, found, range(2))
    index = decoded(told["index"], "<u4").reshape(-1, 3)
    assert len(index) == told["facets"] == told["all"] == len(bracket.faces)
    corners = decoded(told["positions"], "<f4").reshape(-1, 3)[index]
    six_volumes = np.linalg.det(corners.astype(float)).sum()
    assert six_volumes / 6.0 == pytest.approx(bracket.volume * 1e9, rel=1e-5)
    assert len(json.dumps(told)) < 1.5 * (4 * 3 * len(bracket.vertices) + 12 * len(index)) + 3000


def test_shapes_and_probabilities_are_a_table_each(light):
    """One table of both would be broader than a window."""
    section = next(section for section in light.sections if section.anchor == "aspects")
    shapes, chances = (block.frame for block in section.blocks if isinstance(block, blocks.Table))
    assert list(shapes["aspect"]) == list(chances["aspect"])
    assert {"height_mm", "contact_area_mm2", "barrier_mm", "tip_angle_deg"} <= set(shapes)
    assert {"p_pmi", "p_csa", "p_surface"} <= set(chances)
    assert all(name == "aspect" or name.startswith("p_") for name in chances)
    assert not any(name.startswith("p_") for name in shapes)


def sphere(rings):
    """Corners and facets of a unit sphere."""
    v, u = np.meshgrid(
        np.linspace(0.0, np.pi, rings + 1), np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False)
    )
    corners = np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(2 * rings), np.arange(rings), indexing="ij"))
    at = lambda i, j: (i % (2 * rings)) * (rings + 1) + j  # noqa: E731
    one, other = [at(i, j), at(i, j + 1), at(i + 1, j)], [at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)]
    return corners, np.concatenate([np.column_stack(one), np.column_stack(other)])


def test_a_large_mesh_is_reduced_to_its_shape():
    corners, faces = sphere(120)
    points, kept = reduced_mesh(corners, faces, most=10_000)
    assert 2_000 < len(kept) <= 10_000
    assert np.allclose(np.linalg.norm(points, axis=1), 1.0, rtol=0.02, atol=0)
    assert np.linalg.det(points[kept]).sum() / 6.0 == pytest.approx(4.0 * np.pi / 3.0, rel=0.02)


def test_a_simplified_view_says_so(bracket, monkeypatch):
    monkeypatch.setattr("feederscrew.output.shading.reduced_mesh", lambda v, f: (v, f[:-2]))
    made = page(report(bracket), chapters=LIGHT[:1])
    count = len(bracket.faces)
    assert f"a coarser surface of {count - 2} facets; every number is of all {count}" in html(made)


def test_html_loads_nothing_from_outside(light):
    text = html(light)
    assert not OUTSIDE.search(text)
    assert "default-src 'none'" in text
    assert len(re.findall(r"https?://", text)) == 1  # the XHTML namespace, a name and no address
    assert "The MIT License" in text and "three.js authors" in text


def test_the_licence_and_sum_of_three_are_told():
    import hashlib

    folder = Path(blocks.__file__).parent
    assert (
        hashlib.sha256((folder / "three.js").read_bytes()).hexdigest()
        in (folder / "three.README.md").read_text()
    )


def test_cells_of_the_sheet_are_those_of_the_csv(light):
    sheet = next(b for s in light.sections for b in s.blocks if isinstance(b, blocks.CsvSheet))
    inside = re.search(r'id="aspects.csv">(.*?)</table>', html(light), re.S).group(1)
    rows = [re.findall(r"<t[hd]>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", inside)]
    assert "".join(",".join(row) + "\n" for row in rows) == sheet.csv


def test_markdown_has_every_chapter_and_no_script(light):
    text = markdown(light, BESIDE)
    assert [line[3:] for line in text.splitlines() if line.startswith("## ")] == [
        s.title for s in light.sections
    ]
    assert "![The part as it rests on each aspect](report/aspects.png)" in text
    assert "| A | flat | 1 | yes | 4.651 | 450.0 | 3.699 | 1218 |" in text
    assert "| A | 31.2 | 42.7 | 34.9 |" in text
    assert "<script" not in text


def test_a_chapter_that_cannot_be_computed_says_why(bracket):
    made = page(
        report(bracket, overrides=["track.radius=10 mm"]),
        chapters=[c for c in CHAPTERS if c[0] in ("track", "rate")],
    )
    for section in made.sections:
        (notes,) = section.blocks
        assert notes.loud and len(notes.lines) == 1 and " - " in notes.lines[0]
    assert made.warnings == tuple(f"{s.title}: {s.blocks[0].lines[0]}" for s in made.sections)
    assert made.tiles == ()


def test_markup_in_names_is_text(bracket):
    case = report(replace(bracket, name="<b>|*x*", source="a`<i>.stl"))
    made = page(case, chapters=[c for c in CHAPTERS if c[0] == "part"])
    assert "<h1>&lt;b&gt;|*x*</h1>" in html(made) and "<i>" not in html(made)
    assert markdown(made).startswith("# \\<b>\\|\\*x\\*\n")


def test_a_part_card_has_no_views():
    made = page(report(load(str(PARTS / "magnet.yaml"))), chapters=LIGHT)
    text = html(made)
    assert "without a shape: there is nothing to draw or to turn" in text
    assert "<canvas" not in text and "THREE" not in text


def test_repeated_leaves_out_where_and_how_loud():
    typed = [
        "report",
        "a b.stl",
        "-o",
        "out",
        "--set",
        "drive.frequency=50 Hz",
        "-q",
        "--output=x",
        "--aspect",
        "B",
    ]
    assert repeated(typed) == "feeder report 'a b.stl' --set 'drive.frequency=50 Hz' --aspect B"


def test_cells_for_people():
    frame = tables.frame(
        {
            "aspect": ["A", None],
            "faces": [2, 10],
            "height_mm": [7.5, np.nan],
            "p_csa": [0.5, 1e-15],
            "fits": [True, False],
        }
    )
    heads, numeric, columns = as_html.texts_of(frame)
    rows = list(zip(*columns))
    assert heads[2:4] == [("height", "[mm]"), ("CSA", "[%]")]
    assert numeric == [False, True, True, True, False]
    assert rows == [("A", "2", "7.500", "50.0", "yes"), ("–", "10", "–", "0", "no")]


def test_a_bowl_too_steep_to_travel_is_told(bracket):
    wanted = [chapter for chapter in CHAPTERS if chapter[0] in ("velocity", "rate")]
    velocity, rate = page(report(bracket, overrides=["track.climb=40 deg"]), chapters=wanted).sections
    assert "no steady state" in velocity.warnings[0]
    assert velocity.tiles == (blocks.Tile("travels", "–", "no steady state"),)
    assert velocity.blocks[-1].text.startswith("No drive of 5 to 60 deg")
    assert rate.blocks[0].lines[0].startswith("track.climb: is steeper than friction holds")


def test_the_views_show_the_recommended_answer_first_with_its_interval(case, light):
    answer, whole = case.resting.recommended, light
    views = next(block for s in whole.sections for block in s.blocks if isinstance(block, blocks.Views))
    for row, (_, _, bars) in enumerate(views.captions):
        assert bars[0].label == "recommended"
        assert bars[0].interval == (answer.low[row], answer.high[row])
        assert not any(bar.interval for bar in bars[1:])
    assert f"({100.0 * answer.low[0]:.0f}–{100.0 * answer.high[0]:.0f})" in html(whole)


def test_the_likeliest_aspect_is_wanted_unless_another_is():
    case = report(load(str(PARTS / "magnet.yaml")))
    assert case.aspect == "3"  # of a card in the order of its source, 11, 14 and 75 % by CSA
    (tile,) = page(case, chapters=LIGHT[:1]).tiles
    assert tile == blocks.Tile("rests most often on", "aspect 3", "42.8 to 74.7 % of drops, by 3 rules")


def velocities(text):
    """Every velocity that a page in Markdown prints, by what it is called: a label, and its values."""
    found = {}
    for label, value in re.findall(r"^\| ([^|]*velocity[^|]*\[mm/s\]) \| ([^|]*) \|$", text, re.M):
        found.setdefault(label, set()).add(value.partition(" (")[0])
    return found


def test_one_drive_has_one_velocity(bracket, monkeypatch):
    """The chapters of velocity, rate, bowl and track: what is called alike is equal."""
    monkeypatch.setattr(style, "png", lambda figure: b"")  # numbers are looked at
    wanted = [chapter for chapter in CHAPTERS if chapter[0] in ("velocity", "rate", "bowl", "track")]
    case = report(bracket, target=1.0)
    made = page(case, chapters=wanted)
    text = markdown(made, BESIDE)
    found, plain = velocities(text), "velocity [mm/s]"
    assert text.count(f"| {plain} |") == 2 and all(len(values) == 1 for values in found.values())
    (value,) = found[plain]
    assert float(value) == pytest.approx(1e3 * case.convey.answer.velocity, rel=1e-3)
    assert made.tiles[0].value == f"{float(value):.1f} mm/s"
    assert "velocity at this stroke [mm/s]" in found and "velocity as it empties [mm/s]" in text
    along = "velocity along the wall, with its friction and the bank [mm/s]"
    assert float(*found[along]) == pytest.approx(1e3 * case.track.course.mean, rel=1e-4)


@pytest.mark.parametrize("height, tall", [(2.0, False), (8.0, True)])
def test_a_picture_much_taller_than_wide_is_not_put_beside_a_table(height, tall):
    """On paper it may have a page; at the height of the others nobody could read it."""
    picture = blocks.Picture("a.png", style.png(style.figure(4.0, height)), "")
    frame = tables.frame({"quantity": ["a"], "value": ["b"]})
    text = html(blocks.Page("a", "", (blocks.Chapter((blocks.Table(frame), picture)),)))
    assert ('<div class="beside">' in text, 'class="plain tall"' in text) == (not tall, tall)


def test_each_fate_that_a_part_met_has_a_column_of_the_trials_table():
    """Of five bolts one was turned and one rolled back, and no column said so."""
    counts = np.zeros((2, len(FATES)), dtype=int)
    assert report_output.columns(counts) == (*report_output.CAME, "passed", *report_output.WENT)
    counts[1, FATES.index("turned")] = counts[0, FATES.index("rolled_back")] = 1
    assert report_output.columns(counts) == (
        *report_output.CAME,
        "passed",
        "turned",
        "rolled_back",
        *report_output.WENT,
    )


# The track chapter says one thing


def told(mesh, *overrides):
    part, settings = shapes.part(mesh), bowls.settings(None, overrides)
    found = find(part)
    case = ReportStudy(
        resting=AspectsStudy(part, found), settings=settings, bowl=bowls.record(settings), path=None,
        aspect="A", heading=None, rule="csa", gap=0.0, fill=1.0, target=None, counted=None,
        shares=Shares(found),
    )  # fmt: skip
    return on_track(case, WORDS), case


def test_what_slides_has_the_velocity_of_the_rate():
    said, case = told(shapes.box(20, 14, 5))
    speed = 1e3 * case.rate.rate.velocity.value
    assert said == f"On this track the part travels at {speed:.1f} mm/s and slips both ways:" + (
        " the rate is computed with that. It stays on its aspect through the stroke."
    )


def test_what_is_thrown_rolls_back_or_slides_down_is_said():
    assert THROWN in told(shapes.box(20, 14, 5), "drive.amplitude=0.4 mm")[0]
    ball = told(shapes.ball(5.0, 3))[0]
    assert ball.endswith("It lies on its round side and rolls back down the climb, so the rate is 0.")
    assert told(shapes.box(20, 14, 5), "track.climb=40 deg")[0] == SLIDES_DOWN


def test_what_rocks_says_why_it_tips_and_travels_on():
    said = told(shapes.box(2, 2, 8), "friction.static=0.9", "track.climb=1 deg")[0]
    assert "travels at" in said and "turns it over" not in said
