"""Jets that blow all the time, stretches that lean otherwise, and the room that a sorter needs."""

import math
from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapely
import shapely.affinity
import shapes
import trimesh
from on_track import PARTS, WIDE, block, coming, device, load, lying, pick, read, slanted

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.units import GRAVITY
from feederscrew.bowl.devices import pneumatics
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.pneumatics import Nozzles
from feederscrew.bowl.verified import fingerprint
from feederscrew.feeding import stream
from feederscrew.sorting import sensor_views, verdicts
from feederscrew.sorting import tooling as tooling_study
from feederscrew.sorting.fates import at_entry
from feederscrew.sorting.orientations import travel_speed
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

BOWL, EVERY = WIDE, coming(block())
FLAT, TALL = pick(EVERY, 20, 5), pick(EVERY, 12, 20)
JET = device("air jet", nozzle=2e-3, pressure=5e4, height=8e-3)


@pytest.mark.parametrize(("push", "drift"), [(0.5, 1.60), (1.0, 3.88), (2.0, 10.1)])
def test_the_drift_is_that_of_coulomb_friction_over_a_sine(push, drift):
    """Solved by hand from v = a pi V / (2 mu g ln(4 V / v)), mu 0.6, V 60 mm/s."""
    assert 1e3 * verdicts.drift_speed(push, 0.6, 0.06, GRAVITY) == pytest.approx(drift, rel=0.005)


def test_a_jet_over_what_lies_flat_blows_off_what_stands():
    flat, tall = DeviceEncounter(FLAT, EVERY), DeviceEncounter(TALL, EVERY)
    assert verdict(JET, FLAT, EVERY).passes == 1.0 and verdict(JET, FLAT, EVERY).sure
    assert verdict(JET, TALL, EVERY).passes == 0.0 and JET.factor(tall) > 2.0
    assert JET.factor(tall) < replace(JET, height=0.015).factor(tall)  # a longer lever tips it sooner
    assert not verdict(replace(JET, pressure=5e4 / JET.factor(tall)), TALL, EVERY).sure
    force = verdicts.force_to_clear(replace(TALL, swing=0.0), 1.0, 0.015)  # weight times foot over height
    assert force == pytest.approx(TALL.posture.mass * BOWL.gravity * 2.5e-3 / 0.015, rel=1e-6)
    # The jets that a design tries surely blow off others and surely leave what is wanted.
    jets = KINDS["air jet"].proposals([flat], [tall], EVERY, "here")
    assert jets and all(jet.height > 0.5 * FLAT.height for jet in jets)  # else it blows at what lies flat
    for jet in jets:
        assert verdict(jet, FLAT, EVERY).sure and verdict(jet, FLAT, EVERY).passes == 1.0
        assert verdict(jet, TALL, EVERY).sure and verdict(jet, TALL, EVERY).passes == 0.0
        gentler = replace(jet, pressure=jet.pressure - 5e3)  # the least a regulator is set to
        assert jet.factor(tall) > 2.0 and gentler.factor(tall) < 2.2
    assert not KINDS["air jet"].proposals([tall], [flat], EVERY, "here")  # what lies flat is not met alone
    # A design takes one where air may be used and nothing else.
    others = [name for name, kind in KINDS.items() if kind.search.is_proposed and kind.kind != "air jet"]
    own = {"margin": 2.5e-4, "without": others, "play": 0.0, "tolerance": 0.0, "up": FLAT.aspect}
    own["heading"] = FLAT.heading
    with_air, without = (
        tooling_study.tooling(block(), BOWL, FLAT.aspect, **own, cost_class=one).design
        for one in ("air", "steel")
    )
    assert [cut.device.kind for cut in with_air.cuts] == ["air jet"] and not without.cuts
    assert TALL.name in with_air.cuts[0].returns and FLAT.name not in with_air.cuts[0].returns


def test_a_sorter_needs_room_that_a_steeper_way_makes():
    sorter = device("vision reject", like=(FLAT.aspect, FLAT.heading, 5e-4))
    alone = stream.needed_spacing([sorter], EVERY, BOWL)
    widest, shortest = max(one.width for one in EVERY), min(one.length for one in EVERY)
    assert alone == pytest.approx(2e-3 + 2 * math.tan(math.radians(11)) * widest + travel_speed(BOWL) * 0.05)
    steep = slanted("spacing section", -6.0)
    faster = travel_speed(replace(BOWL, track=replace(BOWL.track, climb=math.radians(-6.0))))
    behind = stream.needed_spacing([steep, sorter], EVERY, BOWL)
    needs = max(sorter.gap(one, faster) for one in EVERY)
    assert behind < alone
    assert behind == pytest.approx((needs + shortest) * travel_speed(BOWL) / faster - shortest)
    assert stream.needed_spacing([sorter, steep], EVERY, BOWL) == alone  # behind it, it is too late
    # A bank that comes first begins at the entry and holds what rolls.
    ball = replace(FLAT, may_roll_back=True)
    (held,) = at_entry([ball], [slanted("banked track", 8.0)])
    assert not held.may_roll_back
    assert held.shift == pytest.approx(ball.posture.height * math.tan(math.radians(8)))
    (low,) = at_entry([ball], [slanted("banked track", 0.5)])
    assert low.may_roll_back
    assert at_entry([ball], [JET, slanted("banked track", 8.0)]) == (ball,)


def test_a_sorter_of_two_orientations_passes_both(tmp_path):
    every = coming(load("hexbolt_m8x25"))
    along = [one for one in every if one.length > 0.025 and one.height < 0.02]
    first = along[0]
    second = max(along, key=lambda one: abs(math.sin(0.5 * (one.heading - first.heading))))
    names = [f"{one.aspect}@{math.degrees(one.heading):.6g}" for one in (first, second)]
    lines = (f"sorter: {{of: {k}, play: 1 mm, sees: outline}}" for k in (names[0], f"[{', '.join(names)}]"))
    single, both = (read(tmp_path, line).devices[0] for line in lines)
    assert verdict(single, first, every).passes == 1.0 and verdict(single, second, every).passes == 0.0
    assert verdict(both, first, every).passes == verdict(both, second, every).passes == 1.0
    rest = [other for other in every if all(other is not kept for kept in along)]
    assert rest and all(verdict(both, other, every).passes < 1.0 for other in rest)
    wider = both.with_play(2e-3)
    assert wider.text == f"{{of: [{', '.join(names)}], play: 2 mm, sees: outline}}"
    assert len(wider.features(BOWL.track, every).sensor.wanted) == 2


@pytest.mark.parametrize("turn", np.random.default_rng(3).uniform(0.0, 360.0, 20))
def test_a_sorter_read_back_is_the_one_that_was_written(tmp_path, turn):
    """To the last digits of its headings: what was verified of it stays so."""
    like, also = ("A", np.radians(turn), 1e-3), (("B", np.radians(0.37 * turn)),)
    one = KINDS["vision reject"]("b.yaml", like=like, also=also).with_play(2e-3)
    (copy,) = read(tmp_path, f"sorter: {one.text}").devices
    assert (copy.like[0], copy.also[0][0]) == ("A", "B")
    assert copy.like[1:] == pytest.approx(one.like[1:], rel=1e-14, abs=0.0)
    assert copy.also[0][1] == pytest.approx(one.also[0][1], rel=1e-14, abs=0.0)
    assert fingerprint(replace(BOWL, devices=(copy,))) == fingerprint(replace(BOWL, devices=(one,)))


def test_a_screw_that_hangs_is_seen_head_first_and_thread_first():
    """Both ways along the track end in the same slot: the sensor before it lets both pass."""
    screw = parts.load(PARTS.parent / "docs/tutorial/countersunk_m4x12.stl")
    steep = bowls.read(None, ["track.bank=8 deg", "track.width=15 mm"])
    without = [name for name, kind in KINDS.items() if kind.search.is_proposed and name != "vision reject"]
    own = {"heading": np.radians(350.93), "outcome": "hanging", "without": without}
    study = tooling_study.tooling(screw, steep, "A", **own)
    devices = [cut.device for cut in study.design.cuts]
    assert [one.kind for one in devices] == ["spacing section", "vision reject", "spacing section", "rails"]
    assert devices[2].angle == pytest.approx(steep.track.climb, abs=1e-6)  # time to turn down
    assert len(devices[1].also) == 1 and study.design.isolated


def test_a_laser_over_the_middle_tells_an_open_end_from_a_closed_one():
    """A cap's ends have the same outline from everywhere: only its hollow, seen from above, tells them."""
    every = coming(load("cap_14x10"))
    first, other = (one for one in every if one.height < 0.0101)
    met = DeviceEncounter(first, every)
    assert met.differs(other, "outline") < 1e-6 and met.differs(other, "side") < 1e-6
    assert met.differs(other, "relief") > 4e-3 and met.differs(first, "relief") == 0.0
    sorter = device("vision reject", like=(first.aspect, first.heading, 5e-4), sees="relief")
    assert [verdict(sorter, one, every).passes for one in (first, other)] == [1.0, 0.0]
    # The relief of a wedge, 10 mm long, 2 mm high at its rear and 6 mm at its front; beside it nothing.
    corners = [[x, y, z] for x, high in ((0, 2), (10, 6)) for y in (0, 8) for z in (0, high)]
    body = trimesh.convex.convex_hull(1e-3 * np.array(corners, dtype=float))
    wedge, faces = body.vertices, body.faces
    seen = sensor_views.visible_area(wedge, faces, "relief", line=3e-3)
    assert seen.bounds == pytest.approx((-0.01, 0.0, 0.0, 6e-3)) and seen.area == pytest.approx(40e-6)
    coarse = sensor_views.visible_area(wedge, faces, "relief", 4e-3, 3e-3)
    assert set(np.round(1e3 * np.array(coarse.exterior.coords)[:, 1])) <= {0.0, 4.0, 8.0}
    assert sensor_views.visible_area(wedge, faces, "relief", line=9e-3).area < 1e-12
    turn = np.array([[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 2.0]]) / 2.0
    askew = wedge @ turn.T  # the line grazes its rearmost edge, over less than a micrometre
    grazed = sensor_views.visible_area(askew, faces, "relief", line=float(askew[:, 1].min()) + 1e-7)
    assert 0.0 < grazed.area < 1e-8 and sensor_views.outline_distance(grazed, seen) > 1e-3


def test_an_outline_is_turned_until_it_fits_and_no_further():
    """A bar 23 x 8 mm, seen askew: within ten degrees it is the same, beyond that what is left to turn."""
    bar = shapely.box(-0.023, 0.0, 0.0, 0.008)

    def askew(degrees):
        area = shapely.affinity.rotate(bar, degrees, (0.0, 0.0))
        return shapely.affinity.translate(area, -area.bounds[2], -area.bounds[1])

    for degrees in (-9.0, -2.2, 0.0, 3.4, 9.9):
        assert sensor_views.fit_difference(askew(degrees), bar) < 3e-5
    assert sensor_views.outline_distance(askew(3.4), bar) > 1e-3  # what it was without
    left = sensor_views.outline_distance(askew(5.0), bar)
    assert sensor_views.fit_difference(askew(15.0), bar) == pytest.approx(left, abs=2e-4)
    other = shapely.box(-0.023, 0.0, 0.0, 0.007)
    assert sensor_views.fit_difference(askew(3.0), other) == pytest.approx(1e-3, abs=5e-5)
    # From the side a block is longer by l cos 4 deg + w sin 4 deg - l: what is that much longer may be it.
    turn = np.radians(4.0)
    longer = FLAT.length * (np.cos(turn) - 1.0) + FLAT.width * np.sin(turn)
    assert DeviceEncounter(FLAT).askew("side") == pytest.approx(longer, abs=4e-5)
    assert DeviceEncounter(FLAT).askew("outline") == DeviceEncounter(FLAT).askew("height") == 0.0
    sorter = device("vision reject", like=(FLAT.aspect, FLAT.heading, 2e-3), sees="side")
    assert verdict(sorter, FLAT, EVERY).margin == pytest.approx(2e-3 - longer - 1e-4, abs=5e-5)
    assert verdict(sorter, replace(FLAT, carry=1e-3), EVERY).margin == verdict(sorter, FLAT, EVERY).margin
    (_, side, _, _) = type(sorter).around(DeviceEncounter(FLAT, EVERY), 2.5e-4, "here")
    assert side.like[2] == pytest.approx(2.5e-4 + longer + 1e-4, abs=4e-5)


def test_borders_are_compared_as_shapely_does_where_holes_and_pieces_are_not_alike():
    """Random stars with holes, and two pieces: places every millimetre, to the nearest of all borders."""
    rng = np.random.default_rng(5)

    def star(count):
        turn, far = np.sort(rng.uniform(0.0, 2.0 * np.pi, count)), 0.01 * rng.uniform(0.4, 1.0, (count, 1))
        ring = far * np.column_stack([np.cos(turn), np.sin(turn)]) + rng.normal(0.0, 2e-3, 2)
        return shapely.Polygon(ring).buffer(0.0).difference(shapely.box(-2e-3, -1e-3, 1e-3, 1e-3))

    def farthest(area, other):
        places = shapely.get_coordinates(shapely.segmentize(area.boundary, 1e-3))
        return max(shapely.Point(place).distance(other.boundary) for place in places)

    for _ in range(20):
        first, second = star(9), star(5).union(shapely.box(0.02, 0.0, 0.025, 0.003))
        apart_by = max(farthest(first, second), farthest(second, first))
        assert sensor_views.outline_distance(first, second) == pytest.approx(apart_by, rel=1e-12)
        assert sensor_views.outline_distance(second, first) == sensor_views.outline_distance(first, second)


@pytest.mark.parametrize(("push", "press"), [(1.3, 0.0), (1.9, 0.7), (1.1, -0.4), (0.9, 0.3), (9.0, -2.0)])
def test_a_pulse_carries_a_part_as_far_as_its_motion_in_small_steps(push, press):
    """So many times its weight times friction, for 8 ms, pressed down or lifted; then friction stops it."""
    friction, gravity, step = awkward.bowl().friction.static, awkward.bowl().gravity, 1e-6
    for one in awkward.lying()[::4]:
        mass = one.posture.mass
        force, down = push * friction * mass * gravity, press * mass * 9.80665
        speed = way = 0.0
        for _ in range(8000):
            speed += step * max((force - friction * max(mass * gravity + down, 0.0)) / mass, 0.0)
            way += step * speed
        way += speed**2 / (2.0 * friction * gravity)
        left = max(way, 0.0) - (one.track.width - one.distance)
        assert DeviceEncounter(one).blown(force, down, 8e-3) == pytest.approx(left, rel=1e-3)


@pytest.mark.parametrize(
    ("thickness", "bore", "count"),
    [(0.5, 2e-3, 4), (0.9, 2e-3, 2), (1.2, 1.5e-3, 3), (6.0, 2e-3, 4), (0.5, 2e-3, 1), (0.7, 2e-3, 9)],
)
def test_bores_stand_upon_the_track_with_a_web_between_them(thickness, bore, count):
    """However thin a part is: a drill cannot make two bores that overlap, nor half a bore."""
    angle = [(0, 0), (25, 0), (25, thickness), (thickness, thickness), (thickness, 12), (0, 12)]
    every = lying(shapes.prism(angle, 10.0), BOWL.track)
    nozzles = Nozzles(bore, 3e5, count=count)
    heights = nozzles.heights(every)
    assert len(heights) == count and heights[0] >= 0.5 * bore * (1.0 - 1e-9)
    assert np.all(np.diff(heights) >= 1.1 * bore * (1.0 - 1e-9))
    if count > 1:  # the thinnest, flat, still offers its edge
        assert min(nozzles.push(one, every)[0] for one in every) > 0.0
    given = replace(nozzles, height=20e-3).heights(every)  # near the top of the tallest, or over it
    assert given[0] == 20e-3 and np.all(np.diff(given) >= 1.1 * bore * (1.0 - 1e-9))


def test_so_thin_a_part_that_its_nozzles_do_not_fit_gets_a_stack_from_the_track_on():
    """A key of 4 mm was met by one of four nozzles where these were spread over it, and is by two."""
    every = lying(shapes.box(20.0, 12.0, 4.0), BOWL.track)
    flat = [one for one in every if one.height < 5e-3]
    assert Nozzles(2e-3, 3e5, count=6).heights(flat) == pytest.approx(1e-3 * (1.0 + 2.2 * np.arange(6)))
    assert Nozzles(2e-3, 3e5, count=3).heights(flat) == pytest.approx([1e-3, 3.2e-3, 5.4e-3])
    assert Nozzles(2e-3, 3e5, count=2).heights(flat)[0] > 1e-3  # the middles of two are below its top


@pytest.mark.parametrize(
    ("own", "top", "filled"),
    [
        ([3.0], 12.0, [3.0, 5.25, 7.5, 9.75]),  # amid the widest space
        ([9.0], 17.3, [6.8, 9.0, 13.15, 15.35]),  # no space is wide enough: above the highest, then below
        ([1.0], 4.0, [1.0, 3.2, 5.4, 7.6]),  # neither: over the top
    ],
)
def test_further_nozzles_fill_the_space_there_is(own, top, filled):
    placed = pneumatics._spread(Nozzles(2e-3, 3e5, count=4), [1e-3 * one for one in own], 1e-3 * top)
    assert placed == pytest.approx([1e-3 * one for one in filled])


def test_no_air_jet_is_proposed_that_cuts_into_the_track():
    """Of an angle 3.6 mm high the second of six heights is 0.9 mm: there the track cuts a bore of 2 mm."""
    angle = [(0.0, 0.0), (3.6, 0.0), (3.6, 0.4), (0.4, 0.4), (0.4, 1.2), (0.0, 1.2)]
    every = lying(shapes.prism(angle, 2.4), BOWL.track)
    encounters = [DeviceEncounter(one, every) for one in every]
    heights = [
        jet.height
        for n, own in enumerate(encounters)
        for jet in KINDS["air jet"].proposals([own], encounters[:n] + encounters[n + 1 :], every, "test")
    ]
    assert min(heights) == pytest.approx(1e-3)


def test_nozzles_meet_every_orientation_and_press_a_slope_down_or_lift_what_overhangs():
    every = lying(load("lbracket_30x20x15"), bowls.default().track)
    nozzles = Nozzles(2e-3, 3e5, count=4)
    heights = nozzles.heights(every)
    assert len(heights) == 4 and np.all(np.diff(heights) > 0.0)
    assert 0.0 < heights[0] < 3e-3 < heights[-1] < max(one.height for one in every)  # its legs are 3 mm thick
    assert min(nozzles.push(one, every)[0] for one in every) > 0.5 * nozzles.thrust
    lowest = min(one.posture.height for one in every)
    assert Nozzles(2e-3, 3e5).heights(every) == pytest.approx([lowest])
    assert Nozzles(2e-3, 3e5, 1e-3, 3).heights(every)[0] == 1e-3
    # Air gives a slope T cos2 outwards and T sin cos up or down, whatever the side it comes from.
    rise = 20.0 * np.tan(np.radians(35.0))
    every = lying(shapes.prism([(0, 0), (40, 0), (40, 2), (20, 2 + rise), (0, 2 + rise)], 30.0), BOWL.track)
    slopes = set()
    for one in every:
        points, faces = one.posture.surface, one.posture.solid.faces
        corners = np.column_stack([turned(points[:, :2], one.heading), points[:, 2]])[faces]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.sqrt((normal**2).sum(axis=1))[:, None]
        sloped = (normal[:, 1] < -0.1) & (np.abs(normal[:, 2]) > 0.1)
        leans = np.arctan2(normal[sloped, 2], -normal[sloped, 1])
        if not len(leans) or np.ptp(leans) >= 1e-6:  # one slope, which nothing hides
            continue
        nozzles, lean = Nozzles(1e-4, 3e5, corners[sloped][:, :, 2].mean()), leans[0]
        out, down = nozzles.push(one, every)
        assert out / nozzles.thrust == pytest.approx(np.cos(lean) ** 2, abs=0.03)
        assert down / nozzles.thrust == pytest.approx(np.sin(lean) * np.cos(lean), abs=0.03)
        slopes.add(bool(lean > 0.0))
    assert slopes == {True, False}
