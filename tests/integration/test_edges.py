"""Every edge of every feature lies where its device says, to 0.03 mm, in all that a tooled track becomes."""

import functools
import io
import itertools
import tempfile
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import edge_probes as edges
import ezdxf
import numpy as np
import pytest
import shapely
import test_one_track as chains
import track_views as views
from shapely import affinity

from feederscrew.bowl.devices.features import Features, Jet, Sensor, Slope
from feederscrew.bowl.devices.kinds import KINDS, make_device
from feederscrew.bowl.record import Track
from feederscrew.cad import closed_body, facets
from feederscrew.cad import section as printed
from feederscrew.cad.closed_body import pieces
from feederscrew.cad.exact import exact_body, exact_file
from feederscrew.cad.track import CUT_OVERRUN_M, OUTLET_OVERRUN_M
from feederscrew.output import bowl_sheet, tooling_drawing
from feederscrew.output.drafting import Drawing
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.solid import PLATE, WALL, WALL_OVERLAP_M
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.trials import queue, staging

MM = 1e-3
NEAR = 2e-5  # [m] within which places agree
FAR_MM = 611.0, 373.0, 4999.0  # beyond every body, along no axis of it
CORNERS = ((0.0, 2e-3), (8e-3, 1e-3), (6e-3, 9e-3))
HOLE = {"corners": CORNERS}
GATE = {"corners": ((4e-3, 0.0), (12e-3, 0.0), (10e-3, 6e-3), (5e-3, 4e-3))}
JET = {"nozzle": 2e-3, "pressure": 2e4, "height": 4e-3}
DROPS = {  # what falls on a bank lies further out as well, and so does all behind it
    "steps on a bank": [("banked track", {"angle": 7.0}), ("step", {"limit": 4e-3}), ("cut-out", HOLE),
                        ("step ", {"limit": 3e-3}), ("profile gate", GATE), ("air jet", JET)],
    "ledges on a bank": [("banked track", {"angle": 6.0}), ("tipping ledge", {"limit": 7e-3}),
                         ("slot", {"span": (5e-3, 8e-3)}), ("tipping ledge ", {"limit": 9e-3}),
                         ("air jet", JET)],
    "a ledge between twists": [("step", {"limit": 4e-3}), ("banked track", {"angle": 5.0}),
                               ("tipping ledge", {"limit": 8e-3}), ("banked track ", {"angle": 2.0}),
                               ("wiper", {"limit": 6e-3}), ("gap", {"limit": 7e-3})],
    "blades on a steep bank": [("banked track", {"angle": 16.0}), ("wiper", {"limit": 5e-3, "sweep": 28.0}),
                               ("air jet", JET), ("height bar", {"limit": 7e-3})],
    "spaced within a groove": [("V groove", {"angle": 25.0}), ("spacing section", {"angle": 1.0}),
                               ("banked track", {"angle": 3.0}), ("canyon", {"limit": 4e-3})],
}  # fmt: skip
CASES = [*range(chains.CHAINS), *DROPS]


def laid_out(case):
    """Track, orientations, chain and tooled track of a seed or of one of ``DROPS``."""
    if case not in DROPS:
        return chains.drawn(case, 0.15)
    track = Track(climb=np.radians(3.5), bank=0.0, radius=0.15, width=24e-3)
    every = orientations(chains.part(), find(chains.part()), track)
    chain = []
    for kind, values in DROPS[case]:
        own = {k: np.radians(x) if k in ("angle", "sweep") else x for k, x in values.items()}
        chain.append(make_device(kind.strip(), "test", **own))
    return track, every, chain, lay_out(track, chain, every)


def of_facets(bodies):
    """Whether a place (3,) [m] is within bodies [mm] of facets: a ray from it leaves them once more."""

    def is_solid(place):
        ends = tuple(place / MM), tuple(place / MM + FAR_MM)
        return any(len(one.ray_cast(*ends)) % 2 for one in bodies)

    return is_solid


def of_exact(bodies):
    """Whether a place (3,) [m] is within bodies [mm] of OpenCASCADE."""
    from OCP import BRepClass3d, TopAbs

    own = [BRepClass3d.BRepClass3d_SolidClassifier(one) for one in bodies]

    def is_solid(place):
        for one in own:
            one.Perform(exact_body.point(place / MM), 1e-7)
        return any(one.State() == TopAbs.TopAbs_IN for one in own)

    return is_solid


def of_stage(stage):
    """Whether a place (3,) [m] is within a plate of the trial."""
    plates = [views.plate_of(stage, row) for row in stage.plates]

    def is_solid(place):
        inner = [((place - at) @ axes.T, depth, area) for at, axes, depth, area in plates]
        return any(-deep < z < 0.0 and area.contains(shapely.Point(x, y)) for (x, y, z), deep, area in inner)

    return is_solid


TRIED = (
    "opening",
    "surface",
    "edge",
    "face",
    "lower track",
    "ledge",
    "blade",
)  # plates; walls and bores are numbers there
MADE = (*TRIED, "ramp", "bore", "wall")


def wrong(tooled, place, is_solid, whats=MADE):
    """Probes of which a consumer says otherwise: ``place`` and ``is_solid`` are asked of each device."""
    found, seen = [], 0
    for number, (placed, own) in enumerate(zip(tooled.devices, edges.probes(tooled))):
        for probe in own:
            if probe.what.endswith(whats):
                seen += 1
                if is_solid(number)(place(placed, probe)) != probe.solid:
                    found.append(probe)
    assert seen > 10
    return found


@pytest.mark.parametrize("case", CASES)
def test_edges_of_the_trial_and_of_its_queue(case):
    track, every, chain, tooled = laid_out(case)
    wide = lay_out(track, chain, every, whole=True)
    alone = [of_stage(staging.stage_placed(wide, k, track, every)) for k in range(len(chain))]
    assert not wrong(tooled, lambda *one: edges.in_trial(tooled, *one), alone.__getitem__, TRIED)
    crowd = of_stage(queue.lay_out_track(SimpleNamespace(track=track), every, chain, 0.1).stage)
    assert not wrong(tooled, lambda *one: edges.in_queue(tooled, *one), lambda _: crowd, TRIED)


@pytest.mark.parametrize("case", CASES)
def test_air_sensors_and_slopes_of_the_trial_and_of_its_queue(case):
    track, every, chain, tooled = laid_out(case)
    wide = lay_out(track, chain, every, whole=True)
    crowd = queue.lay_out_track(SimpleNamespace(track=track), every, chain, 0.1)
    mouths, watched, sloped, level = [], [], [], 0.0
    for number, placed in enumerate(tooled.devices):
        own, stage = placed.features, staging.stage_placed(wide, number, track, every)
        places = [edges.Probe("jet", placed.begin + x, y, placed.level, z, False) for (x, y, z) in
                  (jet.at for jet in own.jets)]  # fmt: skip
        mouths += [edges.in_queue(tooled, placed, place) for place in places]
        alone = [edges.in_trial(tooled, placed, place) for place in places]
        assert np.allclose(mouth_of(stage), np.reshape(alone, (-1, 3)), rtol=0.0, atol=NEAR)
        watched += (
            [] if own.sensor is None else [(placed.begin + own.sensor.at, placed.begin + own.jets[0].at[0])]
        )
        sloped += [placed.begin + slope.begin for slope in own.slopes]
        # by how much what leaves it lies lower, and further out
        height, bank = 0.0 if placed.drop is None else placed.drop.height, float(tooled.bank_at(placed.begin))
        assert (stage.drop, stage.aside) == pytest.approx((height * np.cos(bank), height * np.sin(bank)))
        level -= height * np.cos(bank)
        assert crowd.levels[number + 1] == pytest.approx(level)
        ledge = own.length if placed.drop is not None and placed.drop.aside > 0.0 else 0.0
        assert crowd.changes[number] == pytest.approx(placed.begin + ledge)
    assert np.allclose(mouth_of(crowd.stage), np.reshape(mouths, (-1, 3)), rtol=0.0, atol=NEAR)
    air = crowd.stage.air
    assert np.allclose([(one.place, one.nozzles) for one in air.watches], watched, rtol=0.0, atol=NEAR)
    assert np.allclose([one.place for one in air.slopes][-len(sloped) :] if sloped else [], sloped, atol=NEAR)


def mouth_of(stage):
    """Places (J, 3) [m] of the mouths of a stage's jets."""
    jets = stage.air.jets
    return np.column_stack([jets[f"mouth_{end}"] for end in "xyz"])


@pytest.mark.parametrize("case", [1, "ledges on a bank"])
def test_ramps_of_the_trial(case):
    """On a level track: with climb or bank what falls upright moves along or across its plane as well."""
    sloped, every, chain, _ = laid_out(case)
    track, chain = replace(sloped, climb=0.0, bank=0.0), [one for one in chain if not one.action.leans]
    tooled, wide = (lay_out(track, chain, every, whole=whole) for whole in (False, True))
    alone = [of_stage(staging.stage_placed(wide, k, track, every)) for k in range(len(chain))]
    ramps = "ramp", "ramp as tried"
    assert not wrong(tooled, lambda *one: edges.in_trial(tooled, *one), alone.__getitem__, ramps)


def test_ramps_on_a_slope_in_the_trial_and_in_its_queue():
    """To 2 um of their height, where the track climbs and is banked; the second ledge lies further out."""
    case = "ledges on a bank"
    track, every, chain, tooled = laid_out(case)
    wide = lay_out(track, chain, every, whole=True)
    alone = [of_stage(staging.stage_placed(wide, k, track, every)) for k in range(len(chain))]
    crowd = of_stage(queue.lay_out_track(SimpleNamespace(track=track), every, chain, 0.1).stage)
    found, seen = [], 0
    for number, (placed, own) in enumerate(zip(tooled.devices, edges.probes(tooled))):
        for probe in (one for one in own if one.what.endswith("ramp as tried")):
            seen += 1
            lies = edges.on_ramp(tooled, placed, probe, placed.begin, edges.in_queue)
            found += [("queue", probe)] * (crowd(lies) != probe.solid)
            lies = edges.on_ramp(tooled, placed, probe, 0.0, edges.in_trial)
            found += [("alone", probe)] * (alone[number](lies) != probe.solid)
        for off in (4e-4, -4e-4) if placed.drop is not None else ():  # its side, where it begins to come down
            s, y = placed.begin + placed.drop.length + 1e-3, placed.drop.aside + off
            probe = edges.Probe("ramp beside", s, y, placed.level - 1e-3, 0.0, off < 0.0)
            lies = edges.on_ramp(tooled, placed, probe, placed.begin, edges.in_queue)
            found += [("queue", probe)] * (crowd(lies) != probe.solid)
    assert not found
    assert seen > 40


def test_jets_of_any_direction_and_slopes_at_any_place():
    """Turned about the bowl's axis with the track: devices of today blow straight off the wall."""
    track, every, *_ = laid_out(0)
    size, (x, y, z), towards = 0.5 * every[0].length, (4e-3, 2e-3, 5e-3), np.array([0.48, 0.6, -0.64])
    jets = (
        Jet((x, y, z), tuple(2.0 * towards), 1.1e-3, 0.21, 0.3, 0.04, 0.03),
        Jet((x, y, z + 1e-3), tuple(towards), 1.1e-3, 0.21, 0.3, 0.04, 0.05),
    )
    slopes = Slope(3e-3, climb=0.02), Slope(7e-3, bank=0.1, wall=0.3)
    sensor = Sensor(2e-3, "height", (every[0],), 1e-4, 1e-4)
    own = Features(jets=jets, slopes=slopes, sensor=sensor)
    air = staging.place_air([staging.Placement(own, (), size, 0.1)], track, every)
    theta, r = (size + x) / track.radius, track.radius - y
    ahead, inwards = np.array([np.cos(theta), np.sin(theta), 0.0]), [-np.sin(theta), np.cos(theta), 0.0]
    for row, jet in zip(air.jets, jets):
        mouth = [r * np.sin(theta), track.radius - r * np.cos(theta), jet.at[2]]
        assert [row[f"mouth_{end}"] for end in "xyz"] == pytest.approx(mouth)
        blows = towards[0] * ahead + towards[1] * np.array(inwards) + [0.0, 0.0, towards[2]]
        assert [row[f"towards_{end}"] for end in "xyz"] == pytest.approx(blows)
        told = [row[name] for name in ("radius", "spread", "thrust", "reach")]
        assert told == pytest.approx([1.1e-3, 0.21, 0.3 / every[0].posture.mass, 0.04])
        assert (row["begin"], row["end"]) == (np.inf, np.inf)
    assert [(one.place, one.climb, one.bank, one.wall) for one in air.slopes] == [
        (pytest.approx(size + 3e-3), 0.02, None, None),
        (pytest.approx(size + 7e-3), None, 0.1, 0.3),
    ]
    (watch,) = air.watches
    assert (watch.place, watch.nozzles) == (pytest.approx(size + 2e-3), pytest.approx(size + x))
    assert (watch.seconds, watch.jets, watch.sensor) == (0.05, slice(0, 2), sensor)


@pytest.mark.parametrize("case", CASES)
def test_edges_of_the_print_and_of_the_bowl(case):
    _, every, _, tooled = laid_out(case)
    section = of_facets([views.mesh(*printed.solid(tooled))])
    assert not wrong(tooled, lambda _, probe: edges.in_section(tooled, probe), lambda _: section)
    plan, _ = chains.bowl_of(tooled, every)
    whole, gates = pieces(plan, facets)
    bowl = of_facets([whole, *(gate for _, gate in gates)])
    assert not wrong(tooled, lambda _, probe: edges.in_bowl(tooled, plan, probe), lambda _: bowl)


@pytest.mark.parametrize("case", [0, 3, "steps on a bank", "blades on a steep bank"])
def test_bores_go_through_the_wall_and_gates_stand_in_their_notches(case):
    _, every, _, tooled = laid_out(case)
    section, thick = of_facets([views.mesh(*printed.solid(tooled))]), WALL - WALL_OVERLAP_M
    plan, _ = chains.bowl_of(tooled, every)
    whole, gates = pieces(plan, facets)
    bowl, own = of_facets([whole]), iter(of_facets([gate]) for _, gate in gates)
    seen = 0
    for placed in tooled.devices:
        for probe in edges.through_bores(placed, thick):
            assert not section(edges.in_section(tooled, probe)), probe
        notch, gate = edges.gate_in_notch(placed, closed_body.GATE_PLAY_M, plan.material.wall)
        bores = edges.through_bores(placed, plan.material.wall)
        for probe in (*bores, *notch):
            assert bowl(edges.in_bowl(tooled, plan, probe)) == probe.solid, probe
        is_gate = next(own) if gate else None
        for probe in gate:
            assert is_gate(edges.in_bowl(tooled, plan, probe)) == probe.solid, probe
        seen += len(bores) + len(gate)
    assert seen > 0


def wrong_below(tooled, is_solid):
    """Probes of openings below the surface of which a section says otherwise."""
    own = [edges.through_openings(placed, tooled.width, PLATE) for placed in tooled.devices]
    below = list(itertools.chain(*own))
    return [probe for probe in below if is_solid(edges.in_section(tooled, probe)) != probe.solid]


@pytest.mark.parametrize("case", CASES)
def test_openings_of_the_print_go_through_the_plate(case):
    *_, tooled = laid_out(case)
    assert not wrong_below(tooled, of_facets([views.mesh(*printed.solid(tooled))]))


def opened_again(data):
    """The bodies [mm] of a STEP file."""
    from OCP import STEPControl, TopAbs

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "section.step"
        path.write_bytes(data)
        reader = STEPControl.STEPControl_Reader()
        reader.ReadFile(str(path))
        reader.TransferRoots()
        return exact_body.parts(reader.OneShape(), TopAbs.TopAbs_SOLID)


@pytest.mark.needs("OCP")
@pytest.mark.parametrize("case", CASES)
def test_edges_of_the_step_file(case):
    """Of the file as it is written, opened again; openings also below their edges."""
    *_, tooled = laid_out(case)
    (body,) = opened_again(exact_file.section_file(tooled))
    section = of_exact([body])
    assert not wrong(tooled, lambda _, probe: edges.in_section(tooled, probe), lambda _: section)
    assert not wrong_below(tooled, section)


@pytest.mark.parametrize("case", [case for case in CASES if case not in (4, "blades on a steep bank")])
@pytest.mark.parametrize("moved", ["inwards", "along", "across"])
def test_an_opening_that_is_cut_a_twentieth_of_a_millimetre_off_is_noticed(monkeypatch, case, moved):
    """Each opening in turn, in a body of facets: exact ones are asked at the same places."""
    *_, tooled = laid_out(case)
    over, order, turn = facets.over, itertools.count(), 0

    def cut_off(path, ring, *rest):
        """As ``facets.over``; the opening of the turn is cut off."""
        if is_opening(ring) and next(order) == turn:
            area = shapely.Polygon(ring)
            shift = {"along": (5e-5, 0.0), "across": (0.0, 5e-5)}.get(moved, (0.0, 0.0))
            area = affinity.translate(area, *shift) if any(shift) else area.buffer(-5e-5, join_style="mitre")
            ring = shapely.get_coordinates(area)[:-1]
        return over(path, ring, *rest)

    plan = printed.section_plan(tooled)
    rings = [
        outline + [plan.first, 0.0]
        for _, opening in plan.stretch.opened_to(OUTLET_OVERRUN_M + plan.path.end - plan.first).openings
        for outline in opening.carried_over(plan.width, CUT_OVERRUN_M)
    ]

    def is_opening(ring):
        return any(len(ring) == len(one) and np.allclose(ring, one, rtol=0.0, atol=1e-9) for one in rings)

    assert rings
    monkeypatch.setattr(facets, "over", cut_off)
    for number, ring in enumerate(rings):
        if moved == "across" and ring[:, 1].min() < 0.0 and ring[:, 1].max() > tooled.width:
            continue  # it goes through the track from side to side
        turn, order = number, itertools.count()
        section = of_facets([printed.section_body(tooled, facets)])
        assert wrong(tooled, lambda _, probe: edges.in_section(tooled, probe), lambda _: section)  # noqa: B023


@pytest.mark.needs("OCP")
@pytest.mark.parametrize("case", [4, "ledges on a bank"])
def test_edges_of_the_exact_bowl(case):
    _, every, _, tooled = laid_out(case)
    plan, _ = chains.bowl_of(tooled, every)
    whole, gates = pieces(plan, exact_body)
    bowl = of_exact([whole, *(gate for _, gate in gates)])
    assert not wrong(tooled, lambda _, probe: edges.in_bowl(tooled, plan, probe), lambda _: bowl)


@functools.cache
def files(case):
    """DXF files of a track section, and of its bowl with one sheet for the devices."""
    _, every, _, tooled = laid_out(case)
    plan, _ = chains.bowl_of(tooled, every)
    sheets = Drawing(tooling_drawing.DEVICE_PENS)
    bowl_sheet.draw_devices(sheets, plan, tooled, "part", None, "2 of 3")
    return {
        name: ezdxf.read(io.StringIO(data.decode())).modelspace()
        for name, data in (("tooling", tooling_drawing.dxf(tooled)), ("bowl", sheets.dxf()))
    }


def outlines(space, tooled):
    """Outlines [m] by layer, its number left out: along the wall from the datum, and off the wall."""
    rings = {}
    for line in space.query("LWPOLYLINE"):
        layer = line.dxf.layer.rstrip("0123456789").rstrip("_")
        rings.setdefault(layer, []).append(np.array([point[:2] for point in line.get_points()]))
    low, high = rings["TRACK"][0].min(axis=0), rings["TRACK"][0].max(axis=0)
    scale = (high - low)[1] / tooled.width
    return {layer: [(ring - low) / scale for ring in own] for layer, own in rings.items()}


@pytest.mark.parametrize("name", ["tooling", "bowl"])
@pytest.mark.parametrize("case", CASES)
def test_edges_of_the_drawings(case, name):
    *_, tooled = laid_out(case)
    rings = outlines(files(case)[name], tooled)
    track, *cuts = (
        shapely.union_all([shapely.Polygon(ring) for ring in rings.get(layer, ())])
        for layer in ("TRACK", "CUT")
    )
    left = track.difference(shapely.union_all(cuts))
    shapely.prepare(left)
    for own in edges.probes(tooled):
        for probe in own:
            if probe.what.endswith("opening"):
                assert left.contains(shapely.Point(probe.s, probe.y)) == probe.solid, probe
    for placed in tooled.devices:
        if placed.drop is not None:
            layer = "LEDGE" if placed.drop.aside > 0.0 else "STEP"
            foot = [placed.begin, placed.drop.aside]
            line = min(rings[layer], key=lambda ring: abs(ring[:, 0].min() - foot[0]))
            assert np.abs(line.min(axis=0) - foot).max() < NEAR
            if placed.drop.aside > 0.0:
                assert abs(line[:, 0].max() - placed.begin - placed.drop.length) < NEAR
    for placed in tooled.devices:
        own = placed.features
        for slope in own.slopes:
            begins = [ring[:, 0].min() for ring in rings["SLOPE"]]
            assert np.abs(np.array(begins) - placed.begin - slope.begin).min() < NEAR
        if own.sensor is not None:
            ends = [(ring[:, 0].min(), ring[:, 0].max()) for ring in rings["SENSOR"]]
            assert np.abs(np.array(ends) - [placed.start, placed.end]).max(axis=1).min() < NEAR
        for jet in own.jets if own.sensor is None else ():  # its beam grows towards the free edge
            # square to the wall, or askew along a blade's face: in the plane of complex numbers
            x, y, _ = jet.towards
            axis, way = complex(x, y), tooled.width / y
            mouth = placed.begin + jet.at[0] - jet.at[1] * x / y
            near, far = jet.radius, jet.radius + jet.spread * way
            beam = [mouth + 1j * near * axis, mouth - 1j * near * axis]
            beam += [mouth + (way - 1j * far) * axis, mouth + (way + 1j * far) * axis]
            gaps = [np.abs(ring[:, 0] + 1j * ring[:, 1] - beam).max() for ring in rings["NOZZLE"]]
            assert min(gaps) < NEAR
    blades = [ring for placed in tooled.devices for ring in placed.footprints]
    for ring, drawn in itertools.zip_longest(blades, rings.get("GATE", [])):
        assert np.hypot(*(ring[:, None] - drawn).transpose(2, 0, 1)).min(axis=1).max() < NEAR


def dimensions(space):
    """Numbers of ordinates: along the track, off the wall or over the track [m]."""
    along, off = [], []
    for one in space.query("DIMENSION"):
        if one.dimtype == 6:
            value, factor = one.get_measurement(), one.get_dim_style().dxf.dimlfac
            is_along = bool(one.dxf.dimtype & 64)
            (along if is_along else off).append(factor * (value.x if is_along else value.y) * MM)
    return np.array(along), np.array(off)


def on_track(placed, width):
    """Corners (K, 2) [m] of what each opening of a device takes of the track, as its features have it."""
    track = shapely.box(-1.0, 0.0, 1.0, width)
    rings = [shapely.Polygon(opening.ring).intersection(track) for opening in placed.features.openings]
    return [shapely.get_coordinates(ring) + [placed.begin, 0.0] for ring in rings]


def plate_begins(placed):
    """Lengths [m] from the datum at which the faces of blades begin."""
    for blade in placed.features.blades:
        near, (c, s) = blade.solid.bounds[0], blade.axes[0]
        turn = np.arctan2(near * c, placed.radius - blade.foot[1] - near * s)
        yield placed.begin + blade.foot[0] + placed.radius * turn


@pytest.mark.parametrize("name", ["tooling", "bowl"])
@pytest.mark.parametrize("case", CASES)
def test_every_feature_has_its_numbers_in_the_drawings(case, name):
    *_, tooled = laid_out(case)
    along, off = dimensions(files(case)[name])
    known = []  # every place along the track of which a number may be
    for placed in tooled.devices:
        own, cuts = placed.features, on_track(placed, tooled.width)
        places = [*(slope.begin for slope in own.slopes), *(jet.place for jet in own.jets[:1])]
        places += [] if own.sensor is None else [own.sensor.at]
        places += [] if placed.drop is None else [0.0]
        wanted = [*(placed.begin + place for place in places), *plate_begins(placed)]
        wanted += [float(corners[:, 0].min()) for corners in cuts]
        across = [bore.height for bore in own.bores]
        across += [placed.drop.aside] if placed.drop is not None and placed.drop.aside > 0.0 else []
        for corners in cuts:
            first = corners[corners[:, 0] <= corners[:, 0].min() + 1e-9]
            across += [float(y) for y in first[:, 1] if 1e-9 < y < tooled.width - 1e-9]
        for place, numbers in (*((s, along) for s in wanted), *((y, off) for y in across)):
            assert np.abs(numbers - place).min() < NEAR, (placed.label, place)
        known += [*wanted, placed.start, *(float(s) for corners in cuts for s in corners[:, 0])]
        if name == "tooling":  # openings of gates, beside the track
            known += [float(y) for blade in own.blades for ring in blade.opening() for y in ring[:, 0]]
    known += [opening.end for _, opening in tooled.openings]
    assert max(np.abs(np.array(known) - number).min() for number in along) < NEAR


def test_every_kind_that_has_an_edge_is_looked_at():
    whats = {probe.what for case in CASES for own in edges.probes(laid_out(case)[-1]) for probe in own}
    kinds = {kind for kind, own in KINDS.items() if own.action.has_place and not own.action.leans}
    shapes = {what.rpartition(" ")[0] for what in whats if not what.endswith("wall")}
    assert {kind for kind in kinds if any(what.startswith(kind) for what in shapes)} == kinds
