"""What the library hands over: a short text, the table and the picture of the command; faults by argument."""

import html
import json
import re
from dataclasses import replace

import pytest
import shapes
from matplotlib.figure import Figure

import feederscrew as fs
from feederscrew.base.columns import Frame
from feederscrew.designing.families import FamilyStudy
from feederscrew.designing.record import DesignRequest, DesignStudy, NearestDesign
from feederscrew.output import tables

DRIVE = ("track.width=40 mm", "drive.amplitude=0.05 mm")
BOWL = fs.read_bowl(None, DRIVE)
PART = shapes.part(shapes.box(8.0, 12.0, 20.0))
SHARES, HEADING = r"[ABC] \d\d(\.\d)? %, [ABC] ", r"heading [\d.]+ deg: "
MINUTE = r"[\d.]+ parts/min \([\d.]+ to [\d.]+\)"
NEAR = NearestDesign(20.0 / 60.0, "a lower rate")
NONE = DesignStudy(PART, DesignRequest(target=1.0), None, None, None, nearest=NEAR)
STUDIES = {  # function: its record, and what its text says
    "part": (lambda: PART, "8 x 12 x 20 mm"),
    "bowl": (lambda: BOWL, "2 overrides: amplitude 0.05 mm at 50 Hz"),
    "changed bowl": (lambda: replace(BOWL, gravity=9.8), "changed"),
    "aspects": (lambda: fs.aspects(PART, drops=0), f"part rests on .*{SHARES}"),
    "shares": (lambda: fs.shares(PART, BOWL, launch="feed", rule="csa"), SHARES),
    "find_aspects": (lambda: fs.find_aspects(PART), SHARES),
    "inertia": (lambda: fs.inertia(PART), r"\d g, centre of mass .* principal moments"),
    "drop": (lambda: fs.drop(PART, drops=20), r"20 drops, [ABC] \d+"),
    "shake": (lambda: fs.shake(PART, BOWL, drops=6, seconds=0.2), r"throw number 0\.\d+: [ABC] \d+"),
    "slide": (lambda: fs.slide(BOWL, ["20 deg"]), "at 20 deg"),
    "convey": (lambda: fs.convey(BOWL.with_values(amplitude="0.3 mm")), r"\d mm/s up the track, periodic"),
    "floor": (lambda: fs.floor(PART, BOWL, "A", heading="10 deg"), "on A at 10 deg: "),
    "track": (lambda: fs.track(PART, BOWL, "A"), f"on A at {HEADING}"),
    "headings": (lambda: fs.headings(PART, BOWL, "A"), r"A at [\d.]+, [\d.]+ deg"),
    "design": (lambda: NONE, r"DesignStudy\(part: none - .*nearest that holds: 20/min"),
    "family": (lambda: FamilyStudy((NONE,)), r"^FamilyStudy\(none, "),
    "rate": (
        lambda: fs.rate(PART, BOWL.with_values(amplitude="0.3 mm"), "A", rule="csa"),
        r"A@\d+: " + MINUTE + r", efficiency \d+",
    ),
}
PICTURES = {
    "aspects": ["probabilities"], "inertia": [], "drop": ["drop"], "slide": ["slide_curves"],
    "convey": ["convey"], "floor": ["floor_plan", "floor_heading"], "track": ["track_part", "track_cycle"],
    "headings": ["headings_A"],
}  # fmt: skip


@pytest.mark.parametrize("name", STUDIES)
def test_a_record_says_its_answer_and_shows_its_table_and_pictures(name):
    make, says = STUDIES[name]
    record = make()
    text = repr(record)
    assert re.search(says, text), text
    assert len(text) < 600 and "array>" not in text and "\n" not in text
    shown = record._repr_html_()
    assert html.escape(text) in shown
    if name == "part":
        assert 'src="data:image/png;base64,' in shown and len(shown) < 60_000
    else:
        assert "<table" in shown and ("<td>" in shown or name in ("design", "family"))  # these have no row
    if name not in PICTURES:
        return
    frame = record.to_frame()
    assert len(text) <= 400 and len(frame) >= 1 and len(frame.columns) >= 2
    for picture in PICTURES[name]:
        assert record.plot(picture).get_axes(), picture
    with pytest.raises(fs.FeederError, match=f"^name: {type(record).__name__} has no picture 'pie'"):
        record.plot("pie")
    with pytest.raises(fs.FeederError, match="has no table 'pie'"):
        record.to_frame("pie")


def test_a_table_is_the_file_of_its_command(run, run_json, tmp_path):
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "box.stl")
    part, own = fs.load("box.stl"), [word for value in DRIVE for word in ("--set", value)]
    said = run("headings", "box.stl", *own, "--format", "csv", "-q").stdout
    assert tables.text(Frame.of(dict(fs.headings(part, BOWL).to_frame())), "csv") == said
    assert run_json("inertia", "box.stl", "-q")["mass_g"] == pytest.approx(1e3 * part.mass)


def test_what_a_file_is_called_is_escaped_and_a_bowl_shows_what_was_given(tmp_path):
    named = replace(PART, name="<b>x\x1b[31m</b>", material="<script>alert(1)</script>")
    for record in (named, fs.inertia(named), fs.aspects(named, drops=0)):
        shown = record._repr_html_()
        assert "<b>" not in shown and "<script" not in shown and "\x1b" not in shown + repr(record)
    (tmp_path / "mine.yaml").write_text("drive: {frequency: 60 Hz}\ndevices:\n  - wiper: 10 mm\n")
    bowl = fs.read_bowl(tmp_path / "mine.yaml", amplitude="0.3 mm")
    assert re.search(r"mine\.yaml, 1 override: amplitude 0\.3 mm at 60 Hz .* devices: wiper", repr(bowl))
    shown = bowl._repr_html_()
    assert "drive.frequency" in shown and "wiper: 10 mm" in shown and "track.width" not in shown


CHARTS = {"aspects": "probabilities", "drop": "drop", "slide": "slide_curves", "floor": "floor_heading"}


@pytest.mark.parametrize("name", CHARTS)
def test_a_picture_of_one_chart_is_drawn_into_axes_of_ones_own(name):
    record = STUDIES[name][0]()
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert record.plot(CHARTS[name], ax=right) is figure
    assert right.has_data() and right.get_xlabel() and not left.has_data() and not figure.legends
    assert len(record.plot(CHARTS[name]).axes) == 1  # as before without


def test_a_picture_of_several_panels_takes_no_axes():
    axes = Figure().add_subplot()
    with pytest.raises(fs.FeederError, match="ax: picture 'floor_cycle' has several panels"):
        STUDIES["floor"][0]().plot("floor_cycle", ax=axes)
    with pytest.raises(fs.FeederError, match="ax: figure 5-2 has several pictures"):
        fs.reproduce().plot("5-2", ax=axes)
    assert fs.reproduce().plot("5-5", ax=axes) is axes.figure


SAVED = {"aspects": "part/aspects.csv", "convey": "defaults/convey.json", "rate": "part/rate.json"}


@pytest.mark.parametrize("name", SAVED)
def test_a_record_saves_what_its_command_writes(tmp_path, name):
    record = STUDIES[name][0]()
    folder = record.save(tmp_path, pictures=False)
    assert (tmp_path / SAVED[name]).exists() and folder == (tmp_path / SAVED[name]).parent
    runs = json.loads((folder / "run.json").read_text())
    assert runs[name]["files"] == sorted(p.name for p in folder.iterdir() if p.name != "run.json")
    assert not list(folder.glob("*.png"))
    table = next((p for p in folder.glob("*.csv")), None)
    if table:
        assert table.read_text() == tables.text(Frame.of(dict(record.to_frame(table.stem))), "csv")


def test_what_no_command_writes_is_not_saved(tmp_path):
    for record in (PART, BOWL, fs.find_aspects(PART)["A"]):
        with pytest.raises(fs.FeederError, match="folder: no command writes files of a"):
            record.save(tmp_path)


def test_aspects_are_found_by_their_names_and_places():
    study = fs.aspects(PART, drops=0)
    assert len(study) == 3 and [aspect.name for aspect in study] == list(study.aspects.names)
    first, named = study[0], study["B"]
    assert first.name == study.aspects.likeliest and study[-1].name == study.aspects.names[-1]
    assert named.height == study.aspects.heights[1] and named.share == study.recommended.p[1]
    assert named.low <= named.share <= named.high and named.probabilities["csa"] > 0.0
    with pytest.raises(KeyError, match="no aspect 'Q', known are A, B, C"):
        study["Q"]
    with pytest.raises(IndexError):
        study[3]
