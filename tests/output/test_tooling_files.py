"""What ``feeder tooling`` draws: the cuts in every form give the verdicts again."""

import io
import itertools
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest
import shapely
import trimesh

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.output import (
    designs,
    shading,
    solid_files,
    tooling_drawing,
    tooling_figures,
    tooling_views,
)
from feederscrew.output import tooling as files
from feederscrew.resting.aspects import find
from feederscrew.studies.rate import rate
from feederscrew.studies.tooling import tooling
from feederscrew.tooling import solid, track_sections
from feederscrew.tooling.devices.base import UNSURE, Verdict
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.track_sections import bend_ring, build_section
from feederscrew.tooling.verdicts import verdict

LOOKED_AT = True

PART = Path(__file__).parents[2] / "parts" / "lbracket_30x20x15.stl"
BOWL = """\
track:
  width: 45 mm
devices:
  - wiper: 25 mm
  - canyon: 9.7 mm
  - gap: 8 mm
  - slot: {from: 4 mm, to: 8 mm}
  - narrowed_track: 16 mm
  - pressure_break: 20 mm
  - profile: {of: A@90, play: 0.5 mm}
  - cut_out: [[0 mm, 0 mm], [12 mm, 3 mm], [14 mm, 9 mm], [2 mm, 11 mm]]
  - yield: {A: 0.5}
"""
CUTS = 6  # of these cut into the track


@pytest.fixture(scope="module")
def lying(tmp_path_factory):
    """A part's orientations on the track of a bowl with one device of each kind, and that bowl."""
    path = tmp_path_factory.mktemp("bowl") / "bowl.yaml"
    path.write_text(BOWL)
    part, bowl = parts.load(PART), bowls.read(path)
    return bowl, orientations(part, find(part), bowl.track)


@pytest.fixture(scope="module")
def drawn(lying):
    return build_section(lying[0].track, lying[0].devices, lying[1])


def test_the_drawing_opens_in_millimetres_with_closed_polylines(drawn):
    file = ezdxf.read(io.StringIO(tooling_drawing.dxf(drawn, [(np.eye(3, 2), 0.01)]).decode()))
    others = ("TABLE", "CENTRE", "OUTLINE")
    lines = [one for one in file.modelspace().query("LWPOLYLINE") if one.dxf.layer not in others]
    assert file.units == 4
    assert all(line.closed for line in lines)
    layers = {line.dxf.layer for line in lines}
    cuts = {"CUT", *(f"CUT_{k}" for k in range(2, CUTS + 1))}
    plain = {"TRACK", "WALL", "GATE", "GHOST", *cuts}
    assert layers == plain | {f"BENT_{name}" for name in plain} | {"OPENING", "OPENING_2"}
    assert not file.audit().has_errors


def test_the_drawing_is_the_same_bytes_in_another_process(tmp_path):
    code = "\n".join([
        "from feederscrew.output.drafting import Drawing; import sys; made = Drawing()",
        "made.hatched([[(0, 0), (9, 0), (0, 9)]]); made.text(0, 0, 'a'); made.length((0, 0), (9, 0), (0, 5))",
        "sys.stdout.buffer.write(made.dxf() + made.pdf('a') + made.svg((0, 0), (9, 9)).encode())",
    ])  # fmt: skip
    seeds = [{**os.environ, "PYTHONHASHSEED": seed} for seed in "12"]
    one, two = (subprocess.run([sys.executable, "-c", code], capture_output=True, env=env) for env in seeds)
    assert one.stdout == two.stdout != b""


def test_each_cut_read_back_from_the_drawing_gives_the_verdicts_again(lying, drawn, tmp_path):
    (tmp_path / "tooling.dxf").write_bytes(tooling_drawing.dxf(drawn))
    cuts = [station.device for station in drawn.stations if station.hole is not None]
    names = ["CUT", *(f"CUT_{k}" for k in range(2, CUTS + 1))]
    lines = [f"  - cut_out: {{dxf: tooling.dxf, layer: {name}}}" for name in names]
    (tmp_path / "back.yaml").write_text("\n".join(["track: {width: 45 mm}", "devices:", *lines]))
    read = bowls.read(tmp_path / "back.yaml").devices
    assert len(cuts) == len(read) == CUTS
    for cut, hole in zip(cuts, read):
        told = [verdict(cut, one, lying[1]).passes for one in lying[1]]
        assert told == [verdict(hole, one).passes for one in lying[1]], cut.kind


def test_the_section_to_print_is_one_closed_body(drawn):
    mesh = trimesh.load(io.BytesIO(solid_files.section_stl(drawn)), file_type="stl")
    assert mesh.is_watertight
    assert mesh.body_count == 1
    assert solid_files.section_stl(drawn) == solid_files.section_stl(drawn)
    vertices, faces = solid.solid(drawn)
    assert len(faces) == len(mesh.faces) and vertices[faces].min() == pytest.approx(
        1e-3 * mesh.bounds[0].min()
    )


def test_bent_keeps_the_distance_from_the_wall():
    ring = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.02], [0.0, 0.02]])
    found = bend_ring(ring, 0.15)
    away = np.hypot(found[:, 0], found[:, 1] - 0.15)
    assert away.min() == pytest.approx(0.13, rel=1e-9)
    assert away.max() == pytest.approx(0.15, rel=1e-9)
    area = shapely.Polygon(found).area
    assert area == pytest.approx(0.5 * (0.15**2 - 0.13**2) * 0.1 / 0.15, rel=1e-3)


def test_the_hull_drawn_at_the_worst_place_is_that_of_the_verdict(lying):
    bowl, every = lying
    cut = next(device for device in bowl.devices if device.kind == "cut_out")
    for one in every:
        found = track_sections.worst_passage(cut, one, every)
        hull, weight = shapely.MultiPoint(found.supported).convex_hull, shapely.Point(found.weight)
        away = hull.boundary.distance(weight) if hull.contains(weight) else -hull.distance(weight)
        assert away == pytest.approx(found.verdict.margin, abs=2e-5), one.name


@pytest.fixture(scope="module")
def isolated():
    """The bracket's aspect A at 270 deg, which a hole isolates, and its settings."""
    settings = bowls.settings(None, ["track.width=45 mm"])
    part = parts.load(PART)
    study = tooling(part, bowls.record(settings), "A", heading=1.5 * np.pi, without=("sorter",), vary=False)
    return study, settings


def test_the_bowl_file_gives_the_promised_efficiency_and_purity(isolated, tmp_path):
    study, settings = isolated
    path = tmp_path / "tooling.yaml"
    path.write_text(files.bowl_file(study, settings))
    bowl = bowls.read(path)
    assert bowl.track == study.bowl.track
    found = rate(study.part, bowl, "A", heading=1.5 * np.pi).rate
    assert found.purity == pytest.approx(1.0, rel=1e-9)
    assert found.efficiency == pytest.approx(study.design.efficiency, rel=1e-6)


def test_files(isolated):
    offered = {one.name: one.make() for one in files.offers(*isolated)}
    names = {f"tooling.{kind}" for kind in ("csv", "json", "png", "yaml", "dxf", "svg", "stl")}
    assert set(offered) == names | {"tooling_3d.png"}
    assert offered["tooling.svg"].startswith("<svg ")
    assert offered["tooling.svg"].count('id="CUT"') == 1


def test_texts_of_the_pictures_do_not_meet(lying, isolated):
    bowl, every = lying
    shares = np.full(len(every), 1.0 / len(every))
    pictures = [tooling_figures.chain(bowl.devices, every, shares), tooling_figures.limits(isolated[0], "")]
    for figure in pictures:
        renderer = figure.canvas.get_renderer()
        boxes = [text.get_window_extent(renderer) for text in figure.texts if text.get_text()]
        width, height = figure.canvas.get_width_height()
        assert all(box.x0 >= 0 and box.x1 <= width and box.y0 >= 0 and box.y1 <= height for box in boxes)
        assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))


def test_what_the_bare_track_returns_has_a_picture_too(lying):
    bowl, every = lying
    off = [replace(one, falls_off=True) for one in every]
    page = tooling_figures.chain(bowl.devices, off, np.full(len(off), 1.0 / len(off)))
    assert len(page.axes) == len(off)
    assert sum(text.get_text() == "meets no device" for text in page.texts) == len(off)


def test_a_part_that_a_gate_stops_is_drawn_in_front_of_it(lying):
    bowl, every = lying
    gates = [device for device in bowl.devices if device.kind in ("wiper", "profile")]
    met = [track_sections.worst_passage(device, one, every) for device in gates for one in every]
    stopped = [one for one in met if one.verdict.passes <= 0.0]
    assert {met.device.kind for met in stopped} == {"wiper", "profile"}
    for met in stopped:
        (station,) = tooling_views.station_of(met, every).stations
        x, y, _ = tooling_views.part_on_section(met, station).T
        ahead = bowl.track.radius * np.arctan2(x, bowl.track.radius - y)
        assert ahead.max() == pytest.approx(station.blade[:, 0].min(), abs=1e-6)


def test_no_gate_hides_the_part_that_is_drawn_at_it(lying):
    bowl, every = lying
    gates = [device for device in bowl.devices if device.kind in ("wiper", "profile")]
    for met in (track_sections.worst_passage(device, one, every) for device in gates for one in every):
        section = tooling_views.station_of(met, every)
        body = tooling_views.part_on_section(met, section.stations[0]), met.orientation.posture.solid.faces
        centre = 0.5 * (body[0].min(axis=0) + body[0].max(axis=0))
        angle, half = met.angle(section.stations[0]), np.ptp(body[0], axis=0).max()
        track = solid.solid(section)
        (view,) = tooling_views.clearest([track], [body], [centre], [angle], half)
        share = shading.shown_share(track, body, centre, view, half)
        former = shading.shown_share(track, body, centre, tooling_views.camera_at(angle), half)
        assert share >= max(former, 0.6)


def test_a_picture_of_one_device_is_no_wider_than_what_it_shows(lying):
    bowl, every = lying
    few, shares = every[: tooling_figures.MAX_ROWS_OF_ONE_PANEL], np.full(len(every), 1.0 / len(every))
    wide = [
        tooling_figures.chain(bowl.devices[:count], few, shares).get_size_inches()[0] for count in (1, 2, 3)
    ]
    assert wide[0] < wide[1] <= wide[2]


@pytest.mark.parametrize(
    ("size", "long"), [(0.1, 10.0), (0.0165, 1.0), (0.0167, 2.0), (0.05, 5.0), (0.2, 20.0), (1.0, 100.0)]
)
def test_a_scale_bar_is_1_2_or_5_of_a_power_of_ten_and_fits(size, long):
    """120 pixels at most, at so many millimetres a pixel."""
    assert tooling_figures.scale_bar_length(size) == pytest.approx(long)


def test_what_leaves_is_drawn_as_it_leaves(lying):
    """Behind two devices that let it pass, seen along the track: the wall at 0, its foot at height 0."""
    _, every = lying
    narrow = [make_device("narrowed_track", "here", limit=limit) for limit in (0.03, 0.029)]
    page = tooling_figures.chain(narrow, every[:1], np.ones(1))
    last = page.axes[-1]
    assert len(page.axes) == 3 and last.get_xlim()[0] < 0.0 < last.get_ylim()[1]
    (area,) = [patch.get_path().get_extents() for patch in last.patches]
    seen = np.array(every[0].view_ahead.bounds) * 1e3
    assert [area.x0, area.y0, area.x1, area.y1] == pytest.approx(seen, abs=1e-6)


def test_rails_are_cut_across_under_what_hangs():
    screw = parts.load(Path(__file__).parents[2] / "docs/tutorial/countersunk_m4x12.stl")
    bowl = bowls.read(None, ["track.width=15 mm"])
    every = travelling(orientations(screw, find(screw), bowl.track), bowl)
    rails = make_device("rails", "here", span=(2.1e-3, 6.6e-3))
    along = next(one for one in every if one.length > 0.011 and one.height < 0.009)
    page = tooling_figures.chain([rails], [along], np.ones(1))
    near, far, part = (patch.get_path().get_extents() for patch in page.axes[-1].patches)
    assert (near.x0, near.x1, near.y1) == pytest.approx((0.0, 2.1, 0.0)) and far.x0 == pytest.approx(6.6)
    assert part.y0 < -9.0 < 0.0 < part.y1 < 3.0  # its shank below the rails, its head over them


def test_many_orientations_stand_in_two_panels(lying):
    """A page of one column of them was three times as high as wide."""
    bowl, every = lying
    assert len(every) > tooling_figures.MAX_ROWS_OF_ONE_PANEL
    page = tooling_figures.chain(bowl.devices[:1], every, np.full(len(every), 1.0 / len(every)))
    named = {text.get_text(): text.get_position() for text in page.texts}
    places = {round(named[one.name][0], 3) for one in every}
    assert len(places) == 2 and min(y for _, y in named.values()) > 0.0
    wide, high = page.get_size_inches()
    assert high < 1.5 * wide


def test_a_design_names_its_devices_as_the_trade_does():
    sorter = make_device("sorter", "here", like=("A", np.radians(359.7), 2.35e-3), sees="side").rewritten()
    rates = "target delivered worst_friction static".split()
    found = {"status": "holds", "wanted": "A@0"} | {f"{name}_per_minute": 1.0 for name in rates}
    found |= {"delivered_low": 1.0, "delivered_high": 1.0, "purity": None, "jams": 0, "queue_seconds": 0.0}
    found |= {"jams_per_hour_high": None, "robust": {"held": 0, "draws": 0}, "up": []}
    name, said = designs.outcome(found, (sorter,))[-1]
    assert name == "device 1" and said.startswith(
        "vision reject (camera from the side): keeps A at heading 0 deg"
    )
    assert said.endswith("2.35 mm") and "sorter" not in said


def test_a_device_without_a_margin_is_drawn_so():
    assert tooling_figures.margin_words(Verdict(margin=np.nan, passes=1.0)) == "no margin"
    assert tooling_figures.margin_words(Verdict(margin=2.8e-3, passes=1.0)) == "margin +2.80 mm"


def test_a_table_of_polygons_fits_a_page():
    hole = make_device("cut_out", "here", corners=((0.0, 0.0), (12e-3, 3e-3), (14e-3, 9e-3), (2e-3, 11e-3)))
    assert hole.value_words == "polygon of 4 corners"
    names = " ".join(f"A@{k}" for k in range(100, 120))
    assert files._few(names, 34) == "A@100 A@101 A@102 A@103 A@104 and 15 more"
    assert files._few("A@90, all of C", 34) == "A@90, all of C"


def test_a_margin_that_is_none_is_not_printed_as_a_number():
    assert tooling_figures.margin_words(Verdict(1.0, 1.234e-3)) == "margin +1.23 mm"
    assert tooling_figures.margin_words(Verdict(0.0, -2e-3)) == "margin -2.00 mm"
    assert tooling_figures.margin_words(Verdict(0.0, -UNSURE)) == "not sure"


def test_a_verdict_that_is_not_sure_has_no_margin_on_the_page():
    """Its margin is a mark of 2e-6 mm, not a length."""
    wiper = SimpleNamespace(name="wiper")
    met = [
        [SimpleNamespace(verdict=Verdict(0.0, margin), fate="stopped", device=wiper)]
        for margin in (-2e-3, -UNSURE)
    ]
    orientations = [SimpleNamespace(name=name) for name in ("E@0", "E@90")]
    table = files.passages(
        SimpleNamespace(orientations=orientations, passages=met, shares=[0.5, 0.5], devices=[wiper])
    )
    assert table["wiper 1_mm"][0] == pytest.approx(-2.0) and not table["wiper 1_mm"][1] < np.inf
    assert list(table["outcome"]) == ["stopped by the wiper", "stopped by the wiper, not sure"]


def test_the_view_of_a_vision_reject_has_its_sensor_its_nozzles_and_their_air(lying):
    """A mouth a nozzle; air at what is rejected alone."""
    wanted = lying[1][0]
    name, heading = wanted.aspect, wanted.heading
    sorter = make_device("sorter", "here", like=(name, heading, 0.5e-3), sees="outline").rewritten()
    figure = tooling_views.figure([sorter], lying[1], np.full(len(lying[1]), 0.2), 0)
    passes, rejected = figure.axes
    jets = track_sections.build_section(lying[0].track, [sorter], lying[1]).stations[0].standing.jets
    assert len(passes.patches) == len(jets) > 0  # mouths; nothing blows at what is kept
    assert len(rejected.patches) == 2 * len(jets)
    for axes in (passes, rejected):
        assert [text.get_text() for text in axes.texts] == ["sensor"]


def test_what_is_written_of_two_columns_of_nozzles_stands_in_lines_of_its_own():
    """Texts of a second sensor lay on those of the first, and heights alike were written twice."""
    jets = [SimpleNamespace(at=(0.01, 0.0, z), radius=1e-3) for z in (2e-3, 6e-3)]
    stations = [SimpleNamespace(start=start, standing=SimpleNamespace(jets=jets)) for start in (0.04, 0.055)]
    texts, heights = [], []
    drawing = SimpleNamespace(
        lines=lambda *_: None, circle=lambda *_: None, ordinate=lambda *shown: heights.append(shown),
        text=lambda x, y, *words, **_: texts.append((x, y, words[0])),
    )  # fmt: skip
    view = tooling_drawing.View((20.0, 0.0), 1.0)
    top = tooling_drawing.draw_wall_bores(drawing, stations, view, 30.0)
    assert [words.partition(" from D")[0][-3:] for *_, words in texts[:2]] == [" 50", " 65"] and len(
        heights
    ) == 2
    rows = sorted(y for _, y, _ in texts)
    assert (
        {x for x, *_ in texts} == {20.0} and min(np.diff(rows)) >= 3.9 and top > rows[-1] and rows[0] > 36.0
    )
