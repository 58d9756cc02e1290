"""Text from tables: for people, for spreadsheets, for programs."""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pytest

import feederscrew as fs
from feederscrew import bowl as bowls
from feederscrew.base.columns import ColumnHead, Frame, quantities
from feederscrew.base.geometry.polygons import centroid
from feederscrew.base.records import ReadableRecord
from feederscrew.output import record_views, tables
from feederscrew.output.offers import RecordView
from feederscrew.output.page.as_html import escape, texts_of
from feederscrew.output.tables import heading_note
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooling import ToolingSearch, tooling

PARTS = Path(__file__).parents[2] / "parts"
COLUMNS = {"aspect": ["A", "BB"], "stable": np.array([True, False]), "faces": np.array([1, 12])}
COLUMNS |= {"height_mm": [12.34567, 1.0], "normal_x": [1e-17, -0.99999], "p_pmi": [0.1234567, math.nan]}
FRAME = Frame.of(COLUMNS, {"height_mm": ColumnHead("height", "mm"), "p_pmi": ColumnHead("PMI", "%", 100.0)})


def test_a_table_for_people_for_spreadsheets_and_for_programs():
    assert tables.text(FRAME, "table").splitlines() == [
        "aspect  stable  faces  height  normal x    PMI",
        "                         [mm]              [%]",
        "A       yes         1  12.35      0      12.35",
        "BB      no         12   1.000    -1.000   -",
    ]
    assert tables.text(FRAME, "csv") == (  # six digits, empty cells and plain newlines
        "aspect,stable,faces,height_mm,normal_x,p_pmi\nA,True,1,12.3457,1e-17,0.123457\nBB,False,12,1,-0.99999,\n"
    )
    rows = json.loads(tables.json_text({"rows": FRAME}))["rows"]
    own = dict(zip(COLUMNS, ("BB", False, 12, 1.0, -0.99999, None)))
    assert rows[0]["stable"] is True and rows[1] == own
    with pytest.raises(ValueError, match="same length"):
        Frame.of({"a": [1, 2], "b": [1]})
    # JSON keeps full precision and order, and has null for no number.
    third = 1.0 / 3.0
    values = {"b": np.float64(third), "a": np.array([math.nan, 1.0]), "c": math.inf, "n": np.int64(3)}
    text = tables.json_text(values)
    assert list(json.loads(text).items()) == [("b", third), ("a", [None, 1.0]), ("c", None), ("n", 3)]
    assert text.endswith("}\n")
    # Four significant digits.
    own = {9.99999: "10.00", 1234.56: "1235", 0.00123456: "0.001235", 3.2e-7: "3.200e-07", 4.2e9: "4.200e+09"}
    for value, text in own.items():
        assert tables.text(Frame.of({"x": [value]}), "table").split() == ["x", text]


LENGTHS = {f"length{k}_mm": [1.5, 22.25] for k in range(20)}
ENDS = {f"{name}{end}": [0.5, 0.25] for name in ("p_pmi", "p_csa") for end in ("", "_low", "_high")}


def headed(columns):
    """Return a table whose columns of lengths and shares are declared by a rule of this test."""
    table = Frame.of(columns)
    shares = {name: name.removeprefix("p_").split("_") for name in table if name.startswith("p_")}
    heads = {name: ColumnHead.of_name(name, "mm") for name in table if name.endswith("_mm")}
    for name, (rule, *end) in shares.items():
        heads[name] = ColumnHead(end[0] if end else rule.upper(), "%", 100.0)
    return table.headed(heads)


def folded(width, columns):
    lines = tables.text(headed(columns), "table", width).splitlines()
    assert max(map(len, lines)) <= width
    return lines


def test_a_wide_table_is_folded_to_the_window():
    columns = {"part": ["a.stl", "b.stl"]} | LENGTHS
    assert max(map(len, tables.text(headed(columns), "table").splitlines())) > 190
    lines = folded(60, columns)
    heads = [line.split() for line in lines if line.startswith("part")]
    assert [name for head in heads for name in head[1:]] == [f"length{k}" for k in range(20)]
    assert sum(line.startswith("b.stl") for line in lines) == len(heads)
    # A long text goes on below where the window ends.
    words = [f"word{k}" for k in range(50)]
    lines = folded(50, {"part": ["a.stl", "b.stl"], "reason": [" ".join(words), "none"], "x": [1, 2]})
    assert [word for line in lines for word in line.split() if word.startswith("word")] == words
    assert any(line.split() == ["b.stl", "none", "2"] for line in lines)  # not in a piece of its own
    # A table a little too wide stays whole.
    values = ["of A@188, A@354, play 8.4 mm, sees outline", "4.4 to 11.45 mm"]
    columns = {"device": ["vision reject", "rails"], "value": values, "margin_pass_mm": [8.3, 0.4073]}
    columns |= {"returns": ["A@90, all of B, C", "A@90, all of C"]}
    head, _, *lines = folded(70, columns)
    assert head.split() == ["device", "value", "margin", "pass", "returns"] and len(lines) == 3
    start = head.index("value")
    assert " ".join(line[start:].split("  ")[0] for line in lines[:2]) == values[0]
    assert lines[2].startswith("rails")
    # An interval stays with its value; rows keep their names.
    columns = {"aspect": ["A", "A"], "heading": [0.0, 90.0], "long_name_of_a_column_mm": [1.0, 2.0]}
    heads = [line.split() for line in folded(46, columns | ENDS) if line.startswith("aspect")]
    assert all(head[:2] == ["aspect", "heading"] for head in heads)
    assert [head[2:] for head in heads[-2:]] == [["PMI", "low", "high"], ["CSA", "low", "high"]]


def test_a_table_wider_than_a_page_loses_its_spare_columns_in_order():
    columns = {"name": ["x" * 30], "low_mm": [1.5], "high_mm": [2.5], "note": ["y" * 60], "kept": ["z"]}
    wide, spare = headed(columns), [("low_mm", "high_mm"), ("gone",), ("note",)]
    shown, left_out = tables.to_page(wide, spare)
    assert list(shown) == ["name", "note", "kept"] and left_out == ["low", "high"]
    assert len(tables.text(shown, "table").splitlines()[-1]) <= tables.PAGE
    assert tables.to_page(wide, spare, 200)[1] == []
    assert tables.to_page(wide, spare, 10)[1] == ["low", "high", "note"]


def test_texts_of_a_page_are_printable_and_what_has_a_unit_of_its_own_is_no_rounding_beside_another():
    """On the terminal and on a page; in a column of one unit it is."""
    assert escape("red\x1b[31m <b>\nnext \u202e") == "red\\x1b[31m &lt;b&gt;\nnext \\u202e"
    mixed = quantities([("density", 7.85), ("volume", 2.1e13)])
    assert "7.850" in tables.text(mixed, "table")
    assert texts_of(mixed)[2][1][0] == "7.850"
    assert texts_of(Frame.of({"volume_mm3": [1e-3, 2.1e13]}))[2][0][0] == "0"


@pytest.mark.parametrize(
    ("text", "begins"),
    [
        ("A@188 is isolated", "A@188: aspect A, turned 188 deg counter-clockwise"),
        ("aspect  heading  share\nA  188  39", "heading: "),
        ("keeps A@188 and A@354", "A@188: "), ("aspect  lies\nA  flat", None),
        ("mass 13 g", None), ("quantity  value\naspect and heading  A at 188 deg", None),
        ("user@example", None), ("climbs at 3 deg", None),
    ],
)  # fmt: skip
def test_a_text_that_names_a_heading_has_a_note(text, begins):
    assert heading_note(text).startswith(begins) if begins else heading_note(text) == ""


def test_the_note_is_true_of_a_part():
    """In the axes of the track the middle of the face lies at the heading from the way ahead."""
    part = fs.load(PARTS / "lbracket_30x20x15.stl")
    for one in orientations(part, find(part), bowls.default().track):
        middle = centroid(one.posture.contact)
        if np.hypot(*middle) < 1e-4:
            continue
        ahead, inwards, _ = one.axes @ one.posture.axes.T[:, :2] @ middle  # posture to file, as columns
        turn = 2.0 * np.pi
        assert np.arctan2(inwards, ahead) % turn == pytest.approx(one.heading % turn, abs=1e-9)
        assert np.linalg.det(one.axes) == pytest.approx(1.0)  # y inwards, z up: counter-clockwise from above


def viewed(kind: type) -> list[type]:
    """The classes made from a record that name a view."""
    below = [found for child in kind.__subclasses__() for found in viewed(child)]
    return ([kind] if "_view_name" in vars(kind) else []) + below


def test_each_record_of_the_library_names_a_view_that_is_there():
    """The view of a ToolingStudy stood in a module that had gone: it had no table."""
    for name in fs.__all__:
        getattr(fs, name)  # the modules of the library are imported when a name is asked for
    kinds = viewed(ReadableRecord)
    views = {kind.__name__: record_views.view_of(object.__new__(kind)) for kind in kinds if kind._view_name}
    assert {"AspectsStudy", "RateStudy", "ToolingStudy", "DesignStudy", "Part", "Bowl"} <= set(views)
    for name, view in views.items():
        assert isinstance(view, RecordView), name
        assert view.line or view.offers, name
        assert bool(view.command) == bool(view.offers or view.files), name


def test_a_record_under_another_name_shows_the_same():
    class Renamed(type(fs.convey(fs.read_bowl()))):
        """A class that no module of the output knows."""

    study = fs.convey(fs.read_bowl())
    renamed = Renamed(**{field.name: getattr(study, field.name) for field in dataclasses.fields(study)})
    assert repr(renamed) == repr(study).replace(type(study).__name__, "Renamed", 1)
    assert list(renamed.to_frame()) == list(study.to_frame())


def test_a_study_of_tooling_has_a_table():
    own = {"search": ToolingSearch(rule="csa", verdicts=1, vary=False)}
    study = tooling(fs.load(PARTS / "squarenut_m5.stl"), fs.read_bowl(), "A", **own)
    assert {"aspect", "share"} <= set(study.to_frame().columns)
