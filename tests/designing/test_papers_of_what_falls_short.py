"""What a design hands over: which machine it asks for, and drawings that say where it falls short."""

import io
import json
import zipfile
from dataclasses import replace
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest
import shapes
from design_counts import design_study, queue
from matplotlib.text import Text

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.designing import design as designing
from feederscrew.designing import loop
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.output import design_pages, designs, machine_figures, marking, solidbowl, tooling_drawing
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.sorting.tooled_track import lay_out

PART = shapes.part(shapes.box(12.0, 10.0, 8.0))
SHORT = "FALLS SHORT"
BOWL = (
    "drive.amplitude=0.42 mm", "drive.frequency=50 Hz", "drive.vibration_angle=25 deg", "track.radius=150 mm",
    "track.width=14 mm", "track.climb=3.7 deg",
)  # fmt: skip
SENSOR = "devices:\n  - sorter: {of: A@0, play: 1 mm, sees: outline}\n  - gap: 5 mm\n"
STEP = (
    b"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('Open CASCADE Model'),'2;1');\nENDSEC;\nDATA;\n"
    b"#7 = PRODUCT('bowl','bowl','',(#8));\n#9 = PRODUCT_CONTEXT('',#2,'mechanical');\nENDSEC;\n"
)


def study(target=0.5, right=200, left=None, bowl=None, part=PART, **more):
    own = {"bowl": bowl or bowls.read(None, BOWL), "queues": (proved_queue(right, left),)} | more
    return design_study(part, target=60.0 * target, **own)


def proved_queue(right, left=None):
    left = 200 if left is None else left
    return queue(right, left, returned=0, seconds=200.0, counted=200.0)


@pytest.fixture
def sensing(tmp_path):
    """A bowl with a camera, and one device that needs no air."""
    (tmp_path / "bowl.yaml").write_text(SENSOR)
    return bowls.read(tmp_path / "bowl.yaml", BOWL)


@pytest.fixture(scope="module")
def built():
    return designing.Built(designing.machines.machine(bowls.settings(None, BOWL)))


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(12.0, 10.0, 8.0).export(path)
    return path


def offered(one, built=None):
    return {offer.name: offer for offer in design_pages.offers(one, (), built)}


def test_a_design_says_which_machine_it_asks_for(sensing):
    told = designs.document(study(bowl=sensing))["machine"]
    assert (told["drive"], told["cameras"], told["valves"], told["air"]) == ("leaf-spring drive", 1, 1, True)
    assert (told["frequency_hz"], told["stroke_peak_to_peak_mm"]) == pytest.approx((50.0, 0.84))
    # A w^2 sin(25 deg) over g cos(3.7 deg)
    peak = 0.42e-3 * (100.0 * np.pi) ** 2 * np.sin(np.radians(25.0))
    assert told["throw_number"] == pytest.approx(peak / (9.80665 * np.cos(np.radians(3.7))), rel=1e-3)
    # 1.77 g / w^2 at the throw number 1.8
    assert told["hop_height_mm"] == pytest.approx(1.77 * 9.80665e3 / (100.0 * np.pi) ** 2, rel=0.03)
    assert (told["vibration_angle_at_the_springs_deg"], told["hop_flight_mm"] > 1.0) == (None, True)
    drawn = designs.machine_facts(study(bowl=sensing, machine_drawn=True))
    assert "30 deg at the springs, 25 deg to the track" in designs.machine_text(drawn)
    plain = designs.document(study())["machine"]
    assert (plain["cameras"], plain["valves"], plain["air"]) == (0, 0, False)
    phased = replace(sensing, drive=replace(sensing.drive, phase=-1.0))
    told = designs.document(study(bowl=phased))["machine"]
    assert told["drive"] == "two-axis drive" and "two magnets" in told["drive_needs"]
    assert designs.document(DesignStudy(PART, DesignRequest(0.5), None, None, None))["machine"] is None


@pytest.mark.parametrize(("target", "short"), [(1.6, True), (0.5, False)])
def test_drawings_of_what_falls_short_bear_a_mark(built, target, short):
    some = study(target)
    offers = offered(some, built)
    assert (some.status == "falls short") is short
    texts = [text.get_text() for text in offers["bowl.png"].view().findobj(Text)]
    assert any(SHORT in text for text in texts) is short
    assert any("A@0" in text and "60/min" in text for text in texts)
    sheet = dict(zip(*(offers["bowl.csv"].view()[name] for name in ("quantity", "value")), strict=True))
    assert sheet["orientation that leaves"] == "A@0" and some.status in str(sheet)
    verified = json.loads(offers["bowl.json"].make())["verified"]
    assert verified["status"] == some.status and verified["parts_per_minute"] == pytest.approx(60.0)


def test_drawings_of_cuts_bear_a_mark_on_a_layer_of_its_own(sensing):
    track, devices = sensing.track, sensing.devices[1:]
    section = lay_out(track, devices, designing.machines.orientations(PART, find(PART), track))
    read = ezdxf.read(io.StringIO(tooling_drawing.dxf(section, mark=marking.MARK).decode()))
    across = [one for one in read.modelspace() if one.dxf.layer == "MARK"]
    assert [one.dxftype() for one in across] == ["TEXT"] and SHORT in across[0].dxf.text
    assert 0.0 < across[0].dxf.rotation < 90.0
    assert marking.MARK in [one.dxf.text for one in read.modelspace() if one.dxf.layer == "TEXT"]
    svg = tooling_drawing.svg(section, mark=marking.MARK)
    assert "rotate(-" in svg and SHORT in svg
    assert SHORT not in tooling_drawing.svg(section) and b"MARK" not in tooling_drawing.dxf(section)


def test_what_delivers_nothing_leaves_no_papers(built):
    names = "design.json design.html alternatives.csv design_trials.csv design_history.png design.yaml"
    for some in (study(right=0), study(right=0, left=0), study(queues=())):
        assert some.status in ("falls short", "none") and set(offered(some, built)) == set(names.split())
        assert "acceptance" not in design_pages.page(some, built).lower().replace("acceptance.csv", "")
    assert set(offered(study(queues=(), partial=True), built)) < set(names.split())


def test_the_bowl_file_has_the_trial_of_the_papers_and_the_leaves_that_are_drawn(built, tmp_path):
    some = replace(study(), request=DesignRequest(1.6, up=("A", "B")))
    (tmp_path / "design.yaml").write_text(designs.bowl_file(some, (), built.sheet))
    read, own = bowls.verified(tmp_path / "design.yaml"), designs.trial_of(some)
    for name in ("status", "wanted", "up", "jams", "draws", "held", "version", "part", "body", "bowl"):
        assert getattr(read, name) == getattr(own, name), name
    for name in ("target", "delivered", "low", "high", "purity", "queue_seconds"):
        assert getattr(read, name) == pytest.approx(getattr(own, name), rel=1e-3), name

    assert designs.trial_of(study(queues=())) is None and machine_figures.bowl(built.sheet, own) is not None
    # Leaves of 30 mm, which a design may choose, were written as the usual 40 mm
    lines = ("machine.leaf_width=30 mm", "machine.leaf_length=110 mm", "machine.leaves=6")
    sheet = designing.machines.machine(bowls.settings(None, (*BOWL, *lines)))
    text = designs.bowl_file(study(), (), sheet)
    assert "leaf_width: 30 mm" in text and "leaf_length: 110 mm" in text and "leaves: 6" in text


def test_a_stopped_design_leaves_the_files_of_an_earlier_one(run, box, tmp_path, monkeypatch):
    stopped = study(queues=(), partial=True)
    answers = [stopped, study(), stopped]
    monkeypatch.setattr(designing, "build_machine", lambda *_: designing.Built())
    monkeypatch.setattr(loop, "design", lambda part, *_, **__: replace(answers.pop(0), part=part))
    line = ("design", box, "--target", "30/min", "--no-pictures", "-o", tmp_path / "out")

    def written():
        return {path.name: path.read_bytes() for path in (tmp_path / "out/box").iterdir()}

    assert run(*line).exit_code == 130
    assert "design.html" not in written()  # of a stopped one what was tried is kept
    assert run(*line).exit_code == 0
    before = written()
    assert "design.html" in before
    done = run(*line)
    assert done.exit_code == 130 and "earlier" in done.stderr and "Wrote" not in done.stderr
    assert written() == before


def test_feeder_bowl_of_a_file_that_falls_short_marks_its_picture(built, run, tmp_path, monkeypatch):
    (tmp_path / "design.yaml").write_text(designs.bowl_file(study(1.6), (), built.sheet))
    drawn = []
    monkeypatch.setattr(marking, "mark_figure", lambda figure, mark: drawn.append(mark) or figure)
    done = run("bowl", "--config", tmp_path / "design.yaml", "-o", tmp_path / "out")
    assert done.exit_code == 0 and drawn == [marking.MARK]
    sheet = (tmp_path / "out/design/bowl.csv").read_text()
    assert "falls short" in sheet and "A@0" in sheet and "falls short" in done.stdout
    document = json.loads((tmp_path / "out/design/bowl.json").read_text())
    assert document["verified"]["status"] == "falls short"


def test_feeder_bowl_takes_the_drive_that_was_tried_till_it_is_changed(
    run, box, built, tmp_path, monkeypatch
):
    """Also where its own rule finds none; the stroke of the static rule, far less, is a note."""
    config, part = tmp_path / "design.yaml", load(box)
    config.write_text(designs.bowl_file(study(part=part), (), built.sheet))
    line = ("bowl", box, "--target", "30/min", "--format", "json", "--config", config)
    tried, static = run(*line), run(*line, "--set", "friction.static=0.5")
    document = json.loads(tried.stdout)
    assert document["peak_to_peak_mm"] == pytest.approx(0.84, rel=1e-9)
    assert document["leaves"] == int(built.sheet.bowl.machine.leaves)
    assert "the drive is the one that was tried, 0.84 mm peak to peak: the static rule takes" in tried.stderr
    assert "for 30/min" in tried.stderr and "is void" not in tried.stderr
    assert "the trial of this bowl file is void" in static.stderr and "static rule" not in static.stderr
    assert json.loads(static.stdout)["peak_to_peak_mm"] < 0.6

    def unreachable(*_, **__):
        raise FeederError("target", "no bowl reaches it", "split it")

    monkeypatch.setattr(designing.machines, "size_machine", unreachable)
    config.write_text(designs.bowl_file(study(4000.0 / 60.0, part=part), (), built.sheet))
    line = ("bowl", box, "--target", "4000/min", "--format", "json")
    done = run(*line, "--config", config)
    assert done.exit_code == 0 and "no bowl reaches it" in done.stderr
    assert json.loads(done.stdout)["peak_to_peak_mm"] == pytest.approx(0.84) and run(*line).exit_code == 1


@pytest.mark.parametrize(("mark", "name"), [("", "bowl"), (marking.MARK, "bowl_falls_short")])
def test_solids_of_what_falls_short_say_so_in_their_names_heads_and_bodies(mark, name):
    """A shop sees the name of an STL, a slicer that of a body, a CAD program that of a product."""
    step = SimpleNamespace(data=STEP)
    solid = SimpleNamespace(
        vertices=PART.vertices,
        faces=PART.faces,
        gates=(),
        segments=None,
        step=step,
        plan=SimpleNamespace(stretch=None),
    )
    sheet = SimpleNamespace(order=SimpleNamespace(part=PART, on_track=None), solid=solid)
    offers = {one.name: one for one in solidbowl.offers(sheet, None, mark)}
    assert {f"{name}.stl", f"{name}.3mf", f"{name}.step", "bowl.pdf"} <= set(offers)
    stl, step = offers[f"{name}.stl"].make(), offers[f"{name}.step"].make()
    assert (marking.MARK.encode() in stl[:80]) == bool(mark) and stl[:5] != b"solid"
    assert len(stl) == 84 + 50 * len(PART.faces)
    names = f"PRODUCT('bowl - {mark}','bowl - {mark}','',(#8))", f"('Open CASCADE Model - {mark}')"
    for text in (*names, "PRODUCT_CONTEXT('',#2,'mechanical')"):
        assert text in step.decode() if mark else step == STEP
    with zipfile.ZipFile(io.BytesIO(offers[f"{name}.3mf"].make())) as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert model.count(marking.MARK) == (2 if mark else 0)  # the title and the body
