"""What the library hands over: a short text, the table and the picture of the command; faults by argument."""

import html
import re
from dataclasses import replace

import pytest
import shapes

import feederscrew as fs
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
        HEADING + MINUTE + r", efficiency \d+",
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
    assert tables.text(tables.frame(dict(fs.headings(part, BOWL).to_frame())), "csv") == said
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
