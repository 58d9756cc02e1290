"""What ``feeder tooling`` draws: the cuts in every form give the verdicts again."""

import io
import itertools
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import design_counts
import ezdxf
import numpy as np
import pytest
import shapely
import shapes
import trimesh

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.bowl.devices.air_assist import AirAssist
from feederscrew.bowl.devices.base import UNSURE, Verdict
from feederscrew.bowl.devices.features import Bore, Features, ShopWork
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.cad import section as printed
from feederscrew.feeding.rate import rate
from feederscrew.output import (
    designs,
    marking,
    shading,
    solid_files,
    tooling_drawing,
    tooling_figures,
    tooling_views,
)
from feederscrew.output import tooling as files
from feederscrew.resting.aspects import find
from feederscrew.sorting import device_passages
from feederscrew.sorting.orientations import add_travel, orientations
from feederscrew.sorting.tooled_track import bend_ring, lay_out
from feederscrew.sorting.tooling import ToolingSearch, ToolingStudy, tooling
from feederscrew.sorting.verdicts import verdict

LOOKED_AT = True

ROOT = Path(__file__).parents[2]
BRACKET = parts.load(ROOT / "parts/lbracket_30x20x15.stl")
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
LAYERS = ["CUT", *(f"CUT_{k}" for k in range(2, 7))]  # six of these cut into the track


@pytest.fixture(scope="module")
def lying(tmp_path_factory):
    """A part's orientations on the track of a bowl with one device of each kind, and that bowl."""
    path = tmp_path_factory.mktemp("bowl") / "bowl.yaml"
    path.write_text(BOWL)
    bowl = bowls.read(path)
    return bowl, orientations(BRACKET, find(BRACKET), bowl.track)


@pytest.fixture(scope="module")
def drawn(lying):
    return lay_out(lying[0].track, lying[0].devices, lying[1])


@pytest.fixture(scope="module")
def at_gates(lying):
    """How each orientation stands at the wiper and at the profile."""
    bowl, every = lying
    gates = [device for device in bowl.devices if device.kind in ("wiper", "profile gate")]
    return [device_passages.worst_passage(device, one, every) for device in gates for one in every]


def even(every):
    return np.full(len(every), 1.0 / len(every))


def test_drawing_and_section_are_closed_and_give_the_verdicts_again(drawn, lying, tmp_path):
    file = ezdxf.read(io.StringIO(tooling_drawing.dxf(drawn, [(np.eye(3, 2), 0.01)]).decode()))
    others = ("TABLE", "CENTRE", "OUTLINE")
    lines = [one for one in file.modelspace().query("LWPOLYLINE") if one.dxf.layer not in others]
    assert file.units == 4 and not file.audit().has_errors and all(line.closed for line in lines)
    plain = {"TRACK", "WALL", "GATE", "GHOST", *LAYERS}
    layers = plain | {f"BENT_{name}" for name in plain} | {"OPENING", "OPENING_2"}
    assert {line.dxf.layer for line in lines} == layers
    # Each cut read back gives the verdicts again.
    (tmp_path / "tooling.dxf").write_bytes(tooling_drawing.dxf(drawn))
    cuts = [placed.device for placed in drawn.devices if placed.openings]
    lines = [f"  - cut_out: {{dxf: tooling.dxf, layer: {name}}}" for name in LAYERS]
    (tmp_path / "copy.yaml").write_text("\n".join(["track: {width: 45 mm}", "devices:", *lines]))
    for cut, hole in zip(cuts, bowls.read(tmp_path / "copy.yaml").devices, strict=True):
        passes = [verdict(cut, one, lying[1]).passes for one in lying[1]]
        assert passes == [verdict(hole, one).passes for one in lying[1]], cut.kind
    # The section to print is one closed body.
    data = solid_files.section_stl(drawn)
    mesh = trimesh.load(io.BytesIO(data), file_type="stl")
    assert mesh.is_watertight and mesh.body_count == 1 and data == solid_files.section_stl(drawn)
    vertices, faces = printed.solid(drawn)
    assert len(faces) == len(mesh.faces)
    assert vertices[faces].min() == pytest.approx(1e-3 * mesh.bounds[0].min())


def test_the_drawing_is_the_same_bytes_in_another_process():
    code = "\n".join([
        "from feederscrew.output.drafting import Drawing; import sys; made = Drawing()",
        "made.hatch([[(0, 0), (9, 0), (0, 9)]]); made.text(0, 0, 'a'); made.length((0, 0), (9, 0), (0, 5))",
        "sys.stdout.buffer.write(made.dxf() + made.pdf('a') + made.svg((0, 0), (9, 9)).encode())",
    ])  # fmt: skip
    seeds = [{**os.environ, "PYTHONHASHSEED": seed} for seed in "12"]
    one, two = (subprocess.run([sys.executable, "-c", code], capture_output=True, env=env) for env in seeds)
    assert one.stdout == two.stdout != b""


def test_bent_keeps_the_distance_from_the_wall():
    bent = bend_ring(np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.02], [0.0, 0.02]]), 0.15)
    away = np.hypot(bent[:, 0], bent[:, 1] - 0.15)
    assert (away.min(), away.max()) == pytest.approx((0.13, 0.15), rel=1e-9)
    assert shapely.Polygon(bent).area == pytest.approx(0.5 * (0.15**2 - 0.13**2) * 0.1 / 0.15, rel=1e-3)


def test_the_hull_drawn_at_the_worst_place_is_that_of_the_verdict(lying):
    bowl, every = lying
    cut = next(device for device in bowl.devices if device.kind == "cut-out")
    for one in every:
        passage = device_passages.worst_passage(cut, one, every)
        hull, weight = shapely.MultiPoint(passage.supported).convex_hull, shapely.Point(passage.weight)
        away = hull.boundary.distance(weight) if hull.contains(weight) else -hull.distance(weight)
        assert away == pytest.approx(passage.verdict.margin, abs=2e-5), one.name


@pytest.fixture(scope="module")
def isolated():
    """The bracket's aspect A at 270 deg, which a hole isolates, and its settings."""
    settings = bowls.settings(None, ["track.width=45 mm"])
    own = {"heading": 1.5 * np.pi, "without": ("vision reject",), "search": ToolingSearch(vary=False)}
    return tooling(BRACKET, bowls.record(settings), "A", **own), settings


def test_the_files_of_a_study_and_a_bowl_file_that_gives_what_it_promises(isolated, tmp_path):
    study, settings = isolated
    offered = {one.name: one.make() for one in files.offers(study, settings)}
    names = {f"tooling.{kind}" for kind in ("csv", "json", "png", "yaml", "dxf", "svg", "stl")}
    assert set(offered) == names | {"tooling_3d.png"}
    assert offered["tooling.svg"].startswith("<svg ") and offered["tooling.svg"].count('id="CUT"') == 1
    path = tmp_path / "tooling.yaml"
    path.write_text(offered["tooling.yaml"])
    bowl = bowls.read(path)
    assert bowl.track == study.bowl.track
    rated = rate(study.part, bowl, "A", heading=1.5 * np.pi).rate
    assert rated.purity == pytest.approx(1.0, rel=1e-9)
    assert rated.efficiency == pytest.approx(study.design.efficiency, rel=1e-6)


def test_pages_are_read_in_panels_and_no_text_lies_on_another(lying, isolated, tmp_path):
    """A page of one column of all orientations was three times as high as wide."""
    bowl, every = lying
    page = tooling_figures.chain(bowl.devices, every, even(every))
    path = tmp_path / "swept.yaml"  # its last head takes two lines
    path.write_text("devices: [gap: 8 mm, canyon: 9.7 mm, wiper: {clearance: 4.95 mm, sweep: 30 deg}]\n")
    last = tooling_figures.chain(bowls.read(path).devices, every, even(every))
    silhouette = "{clearance: 5.8 mm, reach: 3.5 mm, leaves: 7.15 mm, sweep: 30 deg}"  # three lines of head
    path.write_text(f"devices: [silhouette blade: {silhouette}, narrowed track: 9 mm]\n")
    long = tooling_figures.chain(bowls.read(path).devices, every, even(every))
    for figure in (page, last, long, tooling_figures.limits(isolated[0], "")):
        renderer = figure.canvas.get_renderer()
        boxes = [text.get_window_extent(renderer) for text in figure.texts if text.get_text()]
        width, height = figure.canvas.get_width_height()
        assert all(box.x0 >= 0 and box.x1 <= width and box.y0 >= 0 and box.y1 <= height for box in boxes)
        assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))
    assert len(every) > tooling_figures.MAX_ROWS_OF_ONE_PANEL
    page = tooling_figures.chain(bowl.devices[:1], every, even(every))
    places = {text.get_text(): text.get_position() for text in page.texts}
    columns = {round(places[one.name][0], 3) for one in every}
    assert len(columns) == 2 and min(y for _, y in places.values()) > 0
    wide, high = page.get_size_inches()
    assert high < 1.5 * wide
    few = every[: tooling_figures.MAX_ROWS_OF_ONE_PANEL]
    chains = [tooling_figures.chain(bowl.devices[:count], few, even(every)) for count in (1, 2, 3)]
    first, second, third = (figure.get_size_inches()[0] for figure in chains)
    assert first < second <= third  # no wider than what it shows


@pytest.mark.parametrize("sweep", [30.0, 50.0])
def test_a_blade_is_drawn_where_it_stands_and_no_farther(lying, sweep):
    """Beyond what a silhouette blade reaches a part is free: all of that was drawn as plate."""
    sizes = {"limit": 5e-3, "reach": 3.5e-3, "leaves": 8e-3, "sweep": np.radians(sweep)}
    every = lying[1]
    plate = device_passages.worst_passage(make_device("silhouette blade", "", **sizes), every[0], every).plate
    near, low, far, _ = plate.bounds
    assert (near, low, far) == pytest.approx((0.0, 5e-3, 3.5e-3), abs=1e-9)
    assert plate.area == pytest.approx(shapely.box(*plate.bounds).area)
    # a deflector's pieces stand one behind the other, each farther off the wall
    bend = make_device("curved deflector", "", limit=4e-3, end=np.radians(55.0))
    seen = device_passages.worst_passage(bend, every[0], every).plate
    assert seen.bounds[0] == pytest.approx(0.0, abs=1e-4) and seen.bounds[2] >= 0.9 * lying[0].track.width
    bar = device_passages.worst_passage(make_device("wiper", "", limit=4e-3), every[0], every).plate
    assert bar.bounds[1] == pytest.approx(4e-3) and bar.bounds[2] >= lying[0].track.width


def test_a_part_that_a_gate_stops_is_drawn_in_front_of_it(lying, at_gates):
    stopped = [one for one in at_gates if one.verdict.passes <= 0.0]
    assert {met.device.kind for met in stopped} == {"wiper", "profile gate"}
    for met in stopped:
        (placed,) = tooling_views.section_of(met, lying[1]).devices
        x, y, _ = tooling_views.part_on_section(met, placed).T
        ahead = lying[0].track.radius * np.arctan2(x, lying[0].track.radius - y)
        assert ahead.max() == pytest.approx(placed.footprints[0][:, 0].min(), abs=1e-6)
    # No gate hides it.
    for met in at_gates[::2]:
        section = tooling_views.section_of(met, lying[1])
        body = tooling_views.part_on_section(met, section.devices[0]), met.orientation.posture.solid.faces
        centre = 0.5 * (body[0].min(axis=0) + body[0].max(axis=0))
        angle, half = met.angle(section.devices[0]), np.ptp(body[0], axis=0).max()
        track = printed.solid(section)
        (view,) = tooling_views.clearest([track], [body], [centre], [angle], half)
        cameras = view, tooling_views.camera_at(angle)
        share, former = (shading.shown_share(track, body, centre, one, half) for one in cameras)
        assert share >= max(former, 0.6)


@pytest.mark.parametrize(
    ("size", "long"), [(0.1, 10.0), (0.0165, 1.0), (0.0167, 2.0), (0.05, 5.0), (0.2, 20.0), (1.0, 100.0)]
)
def test_a_scale_bar_is_1_2_or_5_of_a_power_of_ten_and_fits(size, long):
    """120 pixels at most, at so many millimetres a pixel."""
    assert tooling_figures.scale_bar_length(size) == pytest.approx(long)


def test_what_leaves_is_drawn_as_it_leaves(lying):
    """Behind two devices that let it pass, seen along the track: the wall at 0, its foot at height 0."""
    first = lying[1][0]
    narrow = [make_device("narrowed track", "here", limit=limit) for limit in (0.03, 0.029)]
    page = tooling_figures.chain(narrow, [first], np.ones(1))
    last = page.axes[-1]
    assert len(page.axes) == 3 and last.get_xlim()[0] < 0.0 < last.get_ylim()[1]
    (area,) = [patch.get_path().get_extents() for patch in last.patches]
    seen = np.array(first.view_ahead.bounds) * 1e3
    assert [area.x0, area.y0, area.x1, area.y1] == pytest.approx(seen, abs=1e-6)
    # What the bare track returns has a picture too.
    off = [replace(one, falls_off=True) for one in lying[1]]
    page = tooling_figures.chain(lying[0].devices, off, even(off))
    assert len(page.axes) == len(off)
    assert sum(text.get_text() == "before it meets a device" for text in page.texts) == len(off)


def test_what_the_track_does_not_carry_is_said_to_be_returned_as_the_table_says(lying):
    """The picture said that it meets no device, and the table that the vision reject returns it."""
    every = [replace(one, falls_off=place == 1) for place, one in enumerate(lying[1])]
    like = every[0].aspect, every[0].heading, 0.5e-3
    sorter = make_device("vision reject", "here", like=like, sees="outline").rewritten()
    wide = make_device("narrowed track", "here", limit=0.03)
    for devices, returns in (([wide, sorter], True), ([wide], False)):
        page = tooling_figures.chain(devices, every, even(every))
        shown = " ".join(text.get_text() for text in page.texts)
        assert ("falls off the track; else returned by vision reject" in shown) == returns


def test_what_left_in_a_trial_is_not_drawn_as_stopped(lying):
    """The wanted orientation was drawn in red, stopped by a wiper, in a bowl that fed it."""
    every = lying[1]
    wiper = make_device(
        "wiper", "here", limit=1e-3
    )  # lower than any lies: by the rule it stops or returns all
    by_rule = [device_passages.worst_passage(wiper, one, every) for one in every]
    assert all(passage.verdict.passes <= 0.0 for passage in by_rule)
    left, stays = every[0], every[1]
    for left_in_trial in ((), (left.name,)):
        page = tooling_figures.chain([wiper], every, even(every), 0, left_in_trial)
        colours = {text.get_text(): text.get_color() for text in page.texts}
        is_left = bool(left_in_trial)
        passed, rejected = tooling_figures.PASSED_COLOUR, tooling_figures.REJECTED_COLOUR
        assert colours[left.name] == (passed if is_left else rejected) and colours[stays.name] == rejected
        shown = " ".join(text.get_text() for text in page.texts)
        assert shown.count("leaves in the trial (by the") == int(is_left)
        solid = tooling_views.figure([wiper], every, even(every), 0, left_in_trial)
        first, *_ = solid.texts
        assert first.get_text().startswith(left.name) and "passes" not in first.get_text()
        assert ("leaves in the trial" in first.get_text()) is is_left
        assert first.get_color() == (passed if is_left else rejected)
    others = tooling_views.figure([wiper], every, even(every), 0, [one.name for one in every])
    assert len(others.axes) == 1, "none of them falls"


def test_rails_are_cut_across_under_what_hangs():
    screw = parts.load(ROOT / "docs/tutorial/countersunk_m4x12.stl")
    bowl = bowls.read(None, ["track.width=15 mm"])
    every = add_travel(orientations(screw, find(screw), bowl.track), bowl)
    along = next(one for one in every if one.length > 0.011 and one.height < 0.009)
    page = tooling_figures.chain([make_device("rails", "here", span=(2.1e-3, 6.6e-3))], [along], np.ones(1))
    near, far, part = (patch.get_path().get_extents() for patch in page.axes[-1].patches)
    assert (near.x0, near.x1, near.y1) == pytest.approx((0.0, 2.1, 0.0)) and far.x0 == pytest.approx(6.6)
    assert part.y0 < -9.0 < 0.0 < part.y1 < 3.0  # its shank below the rails, its head over them


@pytest.mark.parametrize("behind", [(), ("wiper",), ("rails",)])
def test_the_slot_that_parts_hang_in_is_open_at_the_outlet(behind):
    screw = parts.load(ROOT / "docs/tutorial/countersunk_m4x12.stl")
    track = bowls.read(None, ["track.width=15 mm"]).track
    every = orientations(screw, find(screw), track)
    more = {"wiper": {"limit": 14e-3}, "rails": {"span": (2.4e-3, 6.3e-3)}}
    spans = [(2.1e-3, 6.6e-3), *((2.4e-3, 6.3e-3) for kind in behind if kind == "rails")]
    devices = [make_device("rails", "here", span=spans[0])]
    devices += [make_device(kind, "here", **more[kind]) for kind in behind]
    strip = lay_out(track, devices, every)
    file = ezdxf.read(io.StringIO(tooling_drawing.dxf(strip).decode()))
    cuts = [one for one in file.modelspace().query("LWPOLYLINE") if one.dxf.layer.startswith("CUT")]
    assert max(p[0] for cut in cuts for p in cut.get_points()) == pytest.approx(1e3 * strip.length, abs=1e-6)
    # The list of devices says what the shop must do: the last slot is open, one before other rails runs on.
    listed = [row[-1] for row in tooling_drawing.device_rows(strip.devices, strip.width, lambda s: s)]
    ends = [ShopWork.RUNS_INTO_NEXT] * (len(spans) - 1) + [ShopWork.OPEN_AT_OUTLET]
    assert [words for words in listed if words in (ShopWork.RUNS_INTO_NEXT, ShopWork.OPEN_AT_OUTLET)] == ends
    # So do the bowl file behind the device, the body that a CAD program opens, and what a buyer signs.
    bowl = replace(bowls.default(), devices=tuple(one.rewritten() for one in devices), track=track)
    design = design_counts.proved(screw, bowl, tooling=SimpleNamespace(orientations=every))
    lines = [line for line in designs.bowl_file(design, ()).splitlines() if line.startswith("  - rails")]
    for line, end in zip(lines, ends, strict=True):
        assert f"# {end}; {ShopWork.YOKE_BELOW}" in line
    names = tooling_drawing.shop_names(strip)
    assert names.startswith(f"1 rails: {ends[0].short}, {ShopWork.YOKE_BELOW.short}")
    assert names.encode() in marking.mark_step(b"FILE_DESCRIPTION(('x'),'2;1');", "", names)
    webs = [row for row in designs.acceptance(design).rows() if row["quantity"].startswith("web left")]
    assert [(row["high"], row["computed"]) for row in webs] == [("0", "0")] * len(spans)
    # Rays from above find no web: between the rails from where they begin, and past the end of the track.
    vertices, faces = printed.solid(strip)
    mesh = trimesh.Trimesh(vertices, faces)
    begin = strip.devices[0].begin
    for s in np.arange(begin + 1e-3, strip.length, 0.5e-3):
        angle, off = s / track.radius, track.radius - 4.35e-3
        above = [off * np.sin(angle), track.radius - off * np.cos(angle), -1e-4]
        assert not mesh.ray.intersects_any([above], [[0.0, 0.0, -1.0]])[0], s
    # The rails are as wide as they are set, each up to the next.
    for (_, slot), (low, high) in zip(strip.openings, spans, strict=True):
        assert slot.ring[:, 1].min() == low and slot.ring[:, 1].max() == high
    assert mesh.is_watertight and mesh.body_count == 1


def test_the_acceptance_sheet_states_the_drive_of_the_bowl():
    settings = ["drive.amplitude=0.42 mm", "drive.frequency=47 Hz", "drive.vibration_angle=23 deg"]
    bowl = bowls.read(None, [*settings, "friction.static=0.37", "sizing.controller=0.8"])
    rows = {row["quantity"]: row for row in designs.acceptance(design_counts.proved(BRACKET, bowl)).rows()}
    wanted = {
        "stroke at the rim, peak to peak": 0.84,
        "acceleration, peak": (2.0 * np.pi * 47.0) ** 2 * 0.42e-3,
        "frequency of the drive": 47.0,
        "vibration angle": 23.0,
        "drive setting": 80.0,
        "reserve of the drive": 25.0,
        "angle at which a part slides down a tilted strip": np.degrees(np.arctan(0.37)),
    }
    for name, value in wanted.items():
        assert float(rows[name]["computed"]) == pytest.approx(value, rel=1e-4), name
        ends = float(rows[name]["low"]), float(rows[name]["high"])
        assert ends == pytest.approx((0.9 * value, 1.1 * value), rel=1e-4), name


def part_in_plan(part, one):
    """Corners (K, 2) [m] of a part as it lies, from the foot of its weight: ahead, and inwards."""
    return ((part.vertices - part.centre_of_mass) @ one.axes.T)[:, :2]


@pytest.mark.parametrize("name", ["level", "twisted"])
def test_outlines_of_parts_in_the_drawing_are_those_of_the_part_at_the_wall(name, tmp_path):
    """Before the devices, and at each that is no cut: as it comes there; bent so that it touches the wall."""
    lines = {
        "level": ("height bar: 12 mm", "gap: 5 mm", "banked track: 3 deg"),
        "twisted": (
            "height bar: 6 mm",
            "narrowed track: 11 mm",
            "twisted track: {angle: 75 deg, length: 120 mm}",
            "spacing section: {climb: 3 deg}",
        ),
    }[name]
    path = tmp_path / "bowl.yaml"
    path.write_text("track: {width: 30 mm}\ndevices:\n" + "".join(f"  - {line}\n" for line in lines))
    part, bowl = shapes.part(shapes.box(24.0, 14.0, 4.0)), bowls.read(path)
    study = tooling(part, bowl, "A" if name == "level" else "B", aspect_shares=find(part),
                    search=ToolingSearch(rule="closed"))  # fmt: skip
    offered = {one.name: one for one in files.offers(study, ())}
    space = ezdxf.read(io.StringIO(offered["tooling.dxf"].make().decode())).modelspace()
    rings = {"GHOST": [], "BENT_GHOST": [], "BENT_TRACK": []}
    for line in space.query("LWPOLYLINE"):
        if line.dxf.layer in rings:
            rings[line.dxf.layer].append(np.array([place[:2] for place in line.get_points()]) / 1e3)
    strip = lay_out(bowl.track, bowl.devices, study.orientations)
    flat = next(one for one in study.orientations if one.name == "A@0")  # what comes, also of what is turned
    corner, radius = rings["BENT_TRACK"][0].min(axis=0), bowl.track.radius
    places = [0.6 * flat.length]
    places += [placed.start + 0.5 * placed.length for placed in strip.devices if not placed.openings]
    own = shapely.MultiPoint(part_in_plan(part, flat)).convex_hull
    assert len(rings["GHOST"]) == len(rings["BENT_GHOST"]) == len(places) > 1
    for place, drawn, bent in zip(places, rings["GHOST"], rings["BENT_GHOST"], strict=True):
        turn, away = place / radius, (bent - corner - [0.0, radius]) @ [1.0, 1.0j]
        assert np.abs(away).max() == pytest.approx(radius, abs=2e-5)  # it touches the wall
        along = away * np.exp(-1j * turn)  # turned back to the datum, about the axis
        laid = np.column_stack([along.real, along.imag + radius])
        for ring, shift in ((drawn, place), (laid, 0.0)):
            moved = shapely.affinity.translate(own, shift, flat.distance)
            assert moved.hausdorff_distance(shapely.Polygon(ring)) < 2e-5


def test_the_view_of_a_vision_reject_has_its_sensor_its_nozzles_and_their_air(lying):
    """A mouth a nozzle; air at what is rejected alone."""
    bowl, every = lying
    like = every[0].aspect, every[0].heading, 0.5e-3
    sorter = make_device("vision reject", "here", like=like, sees="outline").rewritten()
    passes, rejected = tooling_views.figure([sorter], every, np.full(len(every), 0.2), 0).axes
    jets = lay_out(bowl.track, [sorter], every).devices[0].features.jets
    assert len(passes.patches) == len(jets) > 0  # mouths; nothing blows at what is kept
    assert len(rejected.patches) == 2 * len(jets)
    assert [[text.get_text() for text in axes.texts] for axes in (passes, rejected)] == [["sensor"]] * 2


def test_the_word_at_a_line_of_sight_across_the_track_is_not_cut_by_the_edge_of_its_view(lying):
    """An angle: 's' at the right edge was all that could be read of 'sensor'."""
    _, every = lying
    like = every[0].aspect, every[0].heading, 0.5e-3
    sorter = make_device("vision reject", "here", like=like, sees="side").rewritten()
    figure = tooling_views.figure([sorter], every, np.full(len(every), 0.2), 0)
    figure.canvas.draw()
    for axes in figure.axes:
        view, (text,) = axes.get_window_extent(), axes.texts
        box = text.get_window_extent()
        assert view.contains(*axes.transData.transform(text.xy))  # else it is not drawn
        assert view.x0 <= box.x0 and box.x1 <= view.x1 and view.y0 <= box.y0 and box.y1 <= view.y1


def test_air_at_a_blade_is_drawn_along_its_face_and_its_bore_has_its_angle(lying):
    """The side of the drawn jet lies on the face; the list says how to drill the bore, and the regulator."""
    bowl, every = lying
    wiper = make_device("wiper", "here", limit=4e-3, sweep=np.radians(30.0), air=AirAssist(2e-3, 3e4, 7e-3))
    strip = lay_out(bowl.track, [wiper.rewritten()], every)
    (placed,) = strip.devices
    (jet,) = placed.features.jets
    (text,) = tooling_drawing.bore_texts(strip.devices)
    assert "nozzle: 1 x Ø2 through the wall, 41 deg to its face towards the outlet, at" in text
    outline = jet.outline(bowl.track.width) - [placed.features.blades[0].foot[0], 0.0]
    off = outline[:, 1] * np.cos(np.radians(30.0)) - outline[:, 0] * np.sin(np.radians(30.0))
    assert np.sort(off)[:2] == pytest.approx([0.0, 0.0], abs=0.3e-3)
    assert np.ptp(outline[2:, 0]) > np.ptp(outline[:2, 0])  # it widens
    rows = tooling_drawing.device_rows(strip.devices, bowl.track.width, np.degrees)
    assert any("regulator 0.3 bar" in cell for row in rows for cell in row)
    # seen at the blade: a mouth and its air
    passes, rejected = tooling_views.figure([wiper.rewritten()], every, np.full(len(every), 0.2), 0).axes
    assert all(len(axes.patches) >= 2 for axes in (passes, rejected))


def test_what_is_written_of_two_columns_of_nozzles_stands_in_lines_of_its_own():
    """Texts of a second sensor lay on those of the first, and equal heights were written twice."""
    features = Features(mounts=tuple(Bore("nozzle", 0.01, z, 2e-3) for z in (2e-3, 6e-3)))
    devices = [SimpleNamespace(begin=begin, features=features) for begin in (0.04, 0.055)]
    texts, heights = [], []
    drawing = SimpleNamespace(
        lines=lambda *_: None, circle=lambda *_: None, ordinate=lambda *shown: heights.append(shown),
        text=lambda x, y, *words, **_: texts.append((x, y, words[0])),
    )  # fmt: skip
    top = tooling_drawing.draw_wall_bores(drawing, devices, tooling_drawing.View((20.0, 0.0), 1.0), 30.0)
    assert [words.partition(" from D")[0][-3:] for *_, words in texts[:2]] == [" 50", " 65"]
    rows = sorted(y for _, y, _ in texts)
    assert len(heights) == 2 and {x for x, *_ in texts} == {20.0}
    assert min(np.diff(rows)) >= 3.9 and top > rows[-1] and rows[0] > 36.0


def test_a_verdict_that_is_not_sure_has_no_margin_on_the_page():
    """Its margin is a mark of 2e-6 mm, not a length."""
    wiper = SimpleNamespace(kind="wiper")
    judged = [Verdict(0.0, margin) for margin in (-2e-3, -UNSURE)]
    passages = [[SimpleNamespace(verdict=one, fate="stopped", device=wiper)] for one in judged]
    named = [SimpleNamespace(name=name) for name in ("E@0", "E@90")]
    study = SimpleNamespace(orientations=named, passages=passages, shares=[0.5, 0.5], devices=[wiper])
    table = files.passages(study)
    assert table["wiper 1_mm"][0] == pytest.approx(-2.0) and not table["wiper 1_mm"][1] < np.inf
    assert list(table["outcome"]) == ["stopped by the wiper", "stopped by the wiper, not sure"]
    words = {np.nan: "no margin", 2.8e-3: "margin +2.80 mm", -2e-3: "margin -2.00 mm", -UNSURE: "not sure"}
    for margin, text in words.items():
        judged = Verdict(margin=margin, passes=float(not margin < 0.0))
        assert tooling_figures.margin_words(judged) == text


@pytest.mark.parametrize(("devices", "state", "leaves"), [
    ((), "", "A@188"), (("gap",), "", "A@188"), (("gap", "rails"), "", "hanging"),
    (("rails",), "hanging 2", "hanging 2"), ((), "A@188 or B", "A@188 or B"),
])  # fmt: skip
def test_what_leaves_between_rails_hangs_as_the_design_says(devices, state, leaves):
    values = {"gap": {"limit": 8e-3}, "rails": {"span": (2e-3, 6e-3)}}
    made = [make_device(kind, "here", **values[kind]) for kind in devices]
    chain = SimpleNamespace(devices=made, leaves_as="")
    lying = (SimpleNamespace(name="B@0"), SimpleNamespace(name="A@188"))
    study = ToolingStudy(
        BRACKET, bowls.default(), None, "csa", 0.0, lying, np.ones(2), (None, chain), 1, state=state
    )
    assert study.leaves_as == leaves and replace(study, wanted=None).leaves_as == ""
