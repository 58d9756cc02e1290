"""What is tried is what is drawn, printed and cut: chains at random, compared by areas and by rays."""

import functools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
import shapes
import track_views as views
from shapely import affinity

from feederscrew.bowl.devices.air_assist import AirAssist
from feederscrew.bowl.devices.kinds import KINDS, make_device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.reading import effective, record
from feederscrew.bowl.record import Track
from feederscrew.cad import facets
from feederscrew.cad import section as printed
from feederscrew.cad.closed_body import body, pieces
from feederscrew.cad.exact import exact_body, exact_file
from feederscrew.cad.plan import SolidOptions, material, plan
from feederscrew.cad.track import groove_spans
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.trials import queue, staging

NEAR = 2e-5  # [m] within which edges agree
BESIDE = 8e-3  # [m] of the lower track behind a step that is compared
WALL_HEIGHT = 4e-3  # [m] over the track, where the wall is met
BORDER = 3e-5  # [m] beside the wall that is not compared: there a seam may be left
SIZE = (20.0, 12.0, 5.0)  # [mm] of the part
CHAINS = 5  # of four devices and more: together with one behind them they have every kind
LONG = 100  # the seed of a chain that is longer than half a turn of its bowl, with blades where it begins
LONG_RADIUS = 0.09  # [m] of that bowl
TWO_DROPS = 101  # the seed of a chain with a step before another one, and a cut between
BODIES = ("print", "exact", "bowl")
RULES = record(effective({})).sizing
MM = 1e-3


@functools.cache
def part():
    return shapes.part(shapes.box(*SIZE))


def air_over(clearance):
    """Air along the face of every other blade, its nozzle over the blade's edge."""
    odd = round(clearance / (0.01 * MM)) % 2
    return AirAssist(2e-3, 2e4, round(clearance + 2e-3, 5)) if odd else None


def draw_device(kind, rng, every):
    """A device of a kind with values at random; lengths in whole hundredths of a millimetre."""

    def mm(low, high):
        return round(rng.uniform(low, high), 2) * MM

    def made(**values):
        return make_device(kind, "test", **values)

    near = mm(1.0, 7.0)
    free = (near, 0.0), (near + mm(6.0, 9.0), 0.0), (near + mm(4.0, 6.0), mm(4.0, 7.0)), (near, mm(3.0, 6.0))
    whole = KINDS[kind]
    if whole.action is Action.SENSE:
        one = every[int(rng.integers(len(every)))]
        return made(like=(one.aspect, one.heading, mm(0.3, 1.0)))
    if kind == "profile gate":
        one = every[int(rng.integers(len(every)))]
        like = one.aspect, one.heading, mm(0.2, 1.0)
        return made(like=like) if rng.random() < 0.5 else made(corners=free)
    if kind == "cut-out":
        corners = [(0.0, mm(-0.5, 2.0)), (mm(6.0, 9.0), mm(0.0, 3.0)), (mm(3.0, 8.0), mm(6.0, 12.0))]
        return made(corners=tuple(corners))
    if kind == "dish-out":
        return made(limit=mm(6.0, 11.0), radius=mm(6.0, 25.0))
    if kind == "cap selector":
        land, length = mm(2.0, 5.0), mm(16.0, 22.0)
        return made(limit=land, length=length, tongue=mm(3.0, 8.0), reach=land + mm(3.0, 9.0))
    if kind == "silhouette blade":
        reach = mm(3.0, 6.0)
        sizes = {"limit": mm(3.0, 7.0), "reach": reach, "leaves": reach + mm(2.0, 6.0)}
        return made(sweep=np.radians(rng.uniform(20.0, 60.0)), **sizes)
    if kind == "balance gap":
        return made(limit=mm(6.0, 11.0), clearance=mm(5.0, 8.0), hold=mm(3.0, 12.0))
    if kind == "curved deflector":
        begin, end = np.radians(rng.uniform(10.0, 20.0)), np.radians(rng.uniform(35.0, 60.0))
        limit = mm(4.0, 6.0)
        return made(limit=limit, begin=begin, end=end, air=air_over(limit))
    if kind == "air jet":
        return made(nozzle=mm(1.5, 3.0), pressure=2e4, height=mm(2.0, 7.0))
    if kind == "slot":
        return made(span=(near, near + mm(2.0, 5.0)))
    if kind == "rails":
        near = mm(3.0, 6.0)
        slot = near, near + mm(3.0, 5.0)
        lead = (slot[0] - mm(0.0, 1.5), slot[1] + mm(0.0, 2.0), mm(8.0, 15.0), mm(5.0, 10.0))
        return made(span=slot, lead=lead if rng.random() < 0.5 else ())
    if kind == "wiper" and rng.random() < 0.7:
        fall = mm(4.0, 6.0)
        contour = ((0.0, fall), (mm(6.0, 12.0), fall), (mm(13.0, 18.0), fall - mm(1.0, 3.0)))
        own = {"contour": contour} if rng.random() < 0.5 else {}
        return made(limit=fall, sweep=np.radians(rng.uniform(25.0, 80.0)), air=air_over(fall), **own)
    if kind == "spacing section":
        return made(angle=np.radians(rng.uniform(-3.0, 5.0)))
    if whole.action is Action.TWIST:
        return made(angle=np.radians(rng.uniform(65.0, 80.0)), length=mm(90.0, 130.0))
    if whole.action.leans:
        return made(
            angle=np.radians(
                rng.uniform(10.0, 35.0) if whole.action is Action.GROOVE else rng.uniform(2.0, 9.0)
            )
        )
    return made(limit=mm(3.0, 5.0) if kind == "step" else mm(6.0, 11.0))


def draw_chain(seed, every):
    """A chain at random; ``CHAINS`` seeds one after the other, and the next, have every kind."""
    rng = np.random.default_rng(seed)
    twist = [kind for kind, own in KINDS.items() if own.action is Action.TWIST]
    lean = [kind for kind, own in KINDS.items() if own.action.leans and kind not in twist]
    last = [kind for kind, own in KINDS.items() if own.action is Action.HANG]
    others = *lean, *last, *twist
    kinds = [kind for kind, own in KINDS.items() if own.action.has_place and kind not in others]
    turned = np.roll(kinds, -4 * seed)[:4].tolist()
    first = [] if seed % 2 else [lean[seed // 2 % len(lean)]]
    first += ["banked track"] * (first == ["V groove"])
    drops = any(KINDS[kind].action.turns for kind in turned)
    if seed == CHAINS:  # a twist ends a chain, and needs a long way
        return [draw_device(kind, rng, every) for kind in ("banked track", "gap", *twist)]
    if seed == LONG:
        names = "banked track", "wiper", "silhouette blade", "narrowed track", "gap", "balance gap", *last
        return [draw_device(kind, rng, every) for kind in names]
    if seed == TWO_DROPS:
        return [draw_device(kind, rng, every) for kind in ("banked track", "step", "gap", "step", "wiper")]
    rails = [] if drops or seed % 3 else last
    middle = [] if drops or seed % 4 != 1 else ["banked track"]
    names = [*first, turned[0], *middle, *turned[1:], *rails]
    return [draw_device(kind, rng, every) for kind in names]


@functools.cache
def drawn(seed, radius):
    """Everything that is made of the chain of a seed on a bowl of a radius [m]."""
    bank = np.radians(4.0 * (seed % 5 in (1, 2)))
    track = Track(climb=np.radians(3.5), bank=bank, radius=radius, width=24e-3)
    every = orientations(part(), find(part()), track)
    chain = draw_chain(seed, every)
    return track, every, chain, lay_out(track, chain, every)


def plan_of(tooled):
    """The measures of the bowl of a tooled track."""
    size = SimpleNamespace(diameter=2.0 * tooled.track.radius, depth=0.07)
    options, extents = SolidOptions(chord=1e-5), np.array(SIZE) * MM
    return plan(size, tooled.track, material("steel", RULES), tooled, options, extents=extents)


def bowl_of(tooled, every):
    """The bowl of a tooled track and its unrolled stretch."""
    made = body(plan_of(tooled))
    return made.plan, views.unrolled(made)


def thickness(difference):
    """How wide [m] a difference of two areas is where it is widest, to a micrometre or so."""

    def is_thinner(width):
        return difference.buffer(-0.5 * width, join_style="mitre").is_empty

    if difference.is_empty:
        return 0.0
    low, high = 0.0, NEAR if is_thinner(NEAR) else 8e-3
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_thinner(middle) else (middle, high)
    return high


def apart(one, other, window):
    """How far [m] the borders of two areas within a window are apart."""
    return thickness(one.symmetric_difference(other).intersection(window))


def apart_over(one, other, height, window):
    """The same of two areas as functions of the height [m], where heights may differ by ``NEAR``."""
    around = [one(height + step) for step in (-NEAR, 0.0, NEAR)]
    most, least = shapely.union_all(around), shapely.intersection_all(around)
    here = other(height)
    beyond = here.difference(most), least.difference(here)
    return max(thickness(area.intersection(window)) for area in beyond)


def differences(seed, radius, consumers):
    """Yield (device, consumer, what, [m]) for everything that a device of a chain is, against its trial."""
    track, every, chain, tooled = drawn(seed, radius)
    flat = bowl_of(tooled, every) if "bowl" in consumers else None
    strip = views.unrolled_section(tooled) if "print" in consumers else None
    crowd = queue.lay_out_track(SimpleNamespace(track=track), every, chain, 0.1, 1e-3).stage
    assert [placed.device for placed in tooled.devices] == chain
    slopes, wide = [], lay_out(track, chain, every, whole=True)
    for number, placed in enumerate(tooled.devices):
        device, features, bank = placed.device, placed.features, float(tooled.bank_at(placed.begin))
        slopes += [
            staging.PlacedSlope(float(len(slopes)), one.climb, one.bank, one.wall) for one in features.slopes
        ]
        tried = views.trial(staging.stage_placed(wide, number, track, every), 0.0, track, bank)
        seen = {}
        if "queue" in consumers:
            seen["queue"] = views.crowded(crowd, placed, track, bank)
        if "print" in consumers:
            seen["print"] = views.bowl(strip[1], strip[0], placed)
        if "exact" in consumers:
            seen["exact"] = consumers["exact"](tooled, placed)
        if flat is not None:
            seen["bowl"] = views.bowl(flat[1], flat[0], placed)
        if "drawing" in consumers:
            seen["drawing"] = drawn_view(tooled, placed, number)
        ends = placed.start - placed.begin, placed.end - placed.begin
        if features.hangs:
            ends = ends[0], features.length
        if features.drop is not None and features.drop.aside > 0.0:
            ends = ends[0], features.drop.length
        rest = shapely.box(ends[0], BORDER, ends[1], track.width - BORDER)
        for name, view in seen.items():
            if name in BODIES and not features.slopes and placed.level == 0.0:
                # where the wall stands over the track, as the trial leans it
                *_, out, up = staging.tabulate_leans(slopes, track.climb, track.bank, SIZE[0] * MM, 1.0)[-1]
                foot = shapely.box(-1.1e-3, -WALL_HEIGHT, -0.9e-3, WALL_HEIGHT)
                face = view.over(WALL_HEIGHT).intersection(foot).bounds[3]
                yield device.kind, name, "wall", abs(face - WALL_HEIGHT * out / up)
            yield device.kind, name, "floor", apart(tried.floor(0.0), view.floor(0.0), rest)
            if features.drop is not None:
                drop, far = features.drop, features.drop.length or BESIDE
                low = shapely.box(1e-3, BORDER + drop.aside, far, track.width - BORDER)
                both = [one.floor(-drop.height) for one in (tried, view)]
                yield device.kind, name, "lower track", apart(*both, low)
                both = [one.floor(0.0) for one in (tried, view)]
                beside = shapely.box(2e-4, BORDER, far, track.width - BORDER)
                yield device.kind, name, "ledge", apart(*both, beside)
                if drop.aside > 0.0 and name in BODIES:
                    half = -0.5 * drop.height  # the ledge's side stands upright in the bowl
                    edge = drop.aside + half * np.sin(bank) - BORDER
                    fold = shapely.box(drop.length + 1e-3, BORDER, features.length, edge)
                    if name == "print":  # which has no climb
                        level = replace(tooled, track=replace(tooled.track, climb=0.0), climbs=())
                        stage = staging.stage_placed(level, number, track, every)
                        off = apart(views.trial(stage, 0.0, track, bank).ramp(half), view.over(half), fold)
                    else:
                        off = apart(tried.ramp(half), view.over(half), fold)
                    yield device.kind, name, "ramp", off * np.tan(drop.ramp)  # as a height
            for blade in features.blades:
                least, top = blade.solid.bounds[1], blade.top
                if name == "drawing":
                    yield device.kind, name, "plate", apart(tried.over(0.98 * top), view.over(top), rest)
                    faces = [
                        affinity.translate(face, own.foot[1])
                        for face, own in zip(tried.faces, features.blades)
                    ]
                    plates = shapely.union_all(faces)
                    end = min(track.width, plates.bounds[2])  # a blade may end before the free edge
                    free = shapely.box(0.0, 0.0, end, top).difference(plates)
                    # it stands to the right of the track: what it shows is its shape
                    shown = affinity.translate(view.faces[0], free.bounds[0] - view.faces[0].bounds[0])
                    whole = shapely.box(0.0, NEAR, end, top)
                    yield device.kind, name, "opening", apart(free, shown, whole)
                    continue
                for height in (least + 2.0 * NEAR, least + 0.3 * (top - least), 0.7 * top):
                    beside = BORDER + height * np.tan(bank)
                    room = shapely.box(ends[0], beside, ends[1], track.width - BORDER)
                    # a flat plate that reaches ahead along a banked track cannot stand square to all of it
                    reach = blade.solid.bounds[2] * np.cos(blade.heading)
                    # its back is seen as lengths of the wall: the longer the nearer it is to the bowl's axis
                    back = blade.thickness * (track.radius / (track.radius - track.width)) ** 2
                    ahead = (reach + back) / track.radius
                    sure = height * np.sin(bank + track.climb * (name == "bowl")) * ahead
                    if name == "queue":  # what is lower lies further out, on a longer arc
                        sure = -placed.level * np.sin(bank) * ahead
                    off = apart_over(tried.over, view.over, height, room)
                    yield device.kind, name, f"blade {1e3 * height:.2f}", max(off - sure, 0.0)
                if least > 0.0:
                    beside = BORDER + least * np.tan(bank) + NEAR
                    room = shapely.box(ends[0], beside, ends[1], track.width - BORDER)
                    clear = view.over(least - 2.0 * NEAR).intersection(room)
                    yield device.kind, name, "clearance", thickness(clear)
            # what blows in the trial, and the holes for what is mounted
            mounts = [(bore.place, bore.height, bore.diameter) for bore in features.mounts]
            mounts = [] if name == "queue" else mounts
            bores = views.in_order([*tried.bores, *mounts])
            assert len(view.bores) == len(bores), (seed, device.kind, name)
            for one, other in zip(view.bores, bores):
                yield device.kind, name, "bore", max(abs(own - wanted) for own, wanted in zip(one, other))


def drawn_view(tooled, placed, number):
    """A device as the DXF file draws it."""
    rings, circles = views.drawing(tooled)
    shift = [-placed.begin, 0.0]
    own = {k: [shapely.Polygon(ring + shift) for ring in some if len(ring) > 2] for k, some in rings.items()}
    track = shapely.union_all(own["TRACK"]).difference(shapely.union_all(own.get("CUT", [])))
    ledges = [shapely.box(*one.bounds) for one in own.get("LEDGE", [])]

    def floor(level):
        below = placed.features.drop is not None and level < 0.0
        for one in ledges:
            x0, y0, x1, _ = one.bounds
            beside = shapely.box(x0, y0, x1, tooled.width)
            if placed.features.drop is not None and placed.features.drop.aside > 0.0:
                return beside if below else track.difference(beside)
        steps = sorted((one.bounds[0] for one in own.get("STEP", [])), key=abs)
        if placed.features.drop is not None and steps:  # its own is the one where it begins
            upper = track.intersection(shapely.box(-1.0, 0.0, steps[0], 1.0))
            return track.difference(upper) if below else upper
        return track

    # plates in the order of the chain; their openings to the right of the track, each with those of its gate
    blades = [item for item in tooled.devices if item.features.blades]
    plate, face = shapely.Polygon(), []
    if placed in blades:
        first = sum(len(item.features.blades) for item in blades[: blades.index(placed)])
        plate = shapely.union_all(own["GATE"][first : first + len(placed.features.blades)])
        groups, right = [], tooled.length + 20e-3
        for ring in sorted(rings["OPENING"], key=lambda ring: ring[:, 0].min()):
            if not groups or ring[:, 0].min() > right + 20e-3:
                groups.append((round(ring[:, 0].min() / 35e-3), []))
            groups[-1][1].append(ring)
            right = max(right, float(ring[:, 0].max()))
        face = [shapely.union_all([shapely.Polygon(ring) for ring in groups[blades.index(placed)][1]])]

    low = tooled.width + 28e-3
    bores = [(x - placed.begin, y - low, size) for x, y, size in circles if placed.start < x < placed.end]
    return views.View(floor, lambda height: plate, views.in_order(bores), face)


@pytest.mark.parametrize("seed", range(CHAINS + 1))
def test_a_chain_is_the_same_in_trial_queue_print_bowl_and_drawing(seed):
    found = list(differences(seed, 0.15, dict.fromkeys(("queue", "print", "bowl", "drawing"))))
    wrong = [(*names, f"{1e3 * size:.3f} mm") for *names, size in found if size > NEAR]
    assert not wrong


@pytest.mark.parametrize(
    ("seed", "share"), [(0, 0.46), (0, 0.49), (3, 0.52), (4, 0.56), (1, 0.5), (2, 0.64), (7, 0.6)]
)
def test_a_queue_has_its_track_however_far_that_goes_round_the_bowl(seed, share):
    """A chain on a bowl of which it takes such a share of a turn: its track ends beyond half of one.

    An angle does not say the turn: beyond half of one borders of cuts once counted as ends of the drawing,
    which hold nothing.
    """
    radius = drawn(seed, 0.15)[-1].length / (2.0 * np.pi * share)
    found = list(differences(seed, radius, ("queue",)))
    assert found and [(*names, f"{1e3 * size:.3f} mm") for *names, size in found if size > NEAR] == []
    track, every, chain, tooled = drawn(seed, radius)
    line = queue.lay_out_track(SimpleNamespace(track=track), every, chain, 0.1, 1e-3)
    floors = [row for row in line.stage.plates if row["front_z"] == 1.0]
    borders = np.concatenate([line.stage.borders[row["begin"] : row["end"]] for row in floors])
    off = np.hypot(borders["end_x"], radius - borders["end_y"])
    ends = borders[borders["drawn_end"] & (off < radius - 0.02 * radius)]
    angles, size = np.arctan2(ends["end_x"], radius - ends["end_y"]), line.stage.size
    drawn_to = np.array([line.start - size, tooled.length + queue.TAIL * size]) / radius
    off = np.abs(np.exp(1j * angles[:, None]) - np.exp(1j * drawn_to)).min(axis=1)
    assert len(ends) and off.max() * radius < 1e-6 and np.ptp(drawn_to) < 2.0 * np.pi


def test_a_chain_that_is_longer_than_half_a_turn_is_the_same_too():
    """An angle about the bowl's axis does not say the turn: blades stood a pitch too high in the bowl."""
    *_, tooled = drawn(LONG, LONG_RADIUS)
    blade = next(item for item in tooled.devices if item.features.blades)
    assert blade.begin < tooled.length - 1.1 * np.pi * LONG_RADIUS
    consumers = dict.fromkeys(("queue", "print", "bowl", "drawing"))
    found = list(differences(LONG, LONG_RADIUS, consumers))
    wrong = [(*names, f"{1e3 * size:.3f} mm") for *names, size in found if size > NEAR]
    assert not wrong


def test_steps_one_after_another_are_the_same_in_all():
    consumers = dict.fromkeys(("queue", "print", "bowl", "drawing"))
    found = list(differences(TWO_DROPS, 0.15, consumers))
    assert sum(what == "lower track" for *_, what, _ in found) == 2 * len(consumers)
    assert not [(*names, f"{1e3 * size:.3f} mm") for *names, size in found if size > NEAR]


@pytest.mark.parametrize(
    "kinds",
    [
        {"gap": 0.0, "V groove": 30.0, "banked track": 6.0},  # the V opens and closes further on
        {"V groove": 55.0, "banked track": 8.0},
        {"V groove": 20.0, "V groove ": 45.0},  # from lean to lean, and not by way of an upright wall
        {"banked track": 4.0, "banked track ": 33.0},
        {"gap": 0.0, "banked track": 4.0, "twisted track": 80.0},  # floor and wall turn together
    ],
)
def test_the_track_twists_in_the_trial_as_it_is_drawn(kinds):
    """Bank and wall along the queue's track and the printed section, as heights at the free edge."""
    track, every, *_ = drawn(1, 0.15)
    chain = []
    for kind, degrees in kinds.items():
        value = {"angle": np.radians(degrees)} if degrees else {"limit": 9e-3}
        if KINDS[kind.strip()].action is Action.TWIST:
            value["length"] = 0.12
        chain.append(make_device(kind.strip(), "test", **value))
    tooled = lay_out(track, chain, every)
    stage = queue.lay_out_track(SimpleNamespace(track=track), every, chain, 0.1).stage
    rows = staging.tabulate_leans(stage.air.slopes, track.climb, track.bank, stage.size, 1.0)
    strip, s = printed.section_plan(tooled), np.linspace(0.0, tooled.length, 400)
    for made in (strip, plan_of(tooled)):
        own = made.path.bank_at(made.first + s)
        assert np.abs(np.sin(own) - np.sin(tooled.bank_at(s))).max() * track.width < NEAR
        lean = np.zeros(len(s))
        for span in groove_spans(made):
            along = made.first + s
            lean += np.where((span.begin <= along) & (along <= span.closed), span.lean_at(along), 0.0)
        assert np.abs(np.sin(lean - tooled.wall_lean_at(s))).max() * every[0].height < NEAR
    tried = {k: np.interp(s, rows[:, 0], rows[:, k]) for k in range(1, 8)}
    bank = strip.path.bank_at(strip.first + s)
    for k, own in ((4, np.sin(bank)), (5, np.cos(bank))):
        assert np.abs(tried[k] - own).max() * track.width < NEAR
    # gravity as the turned track has it: back along the climb, to the wall and down
    turned = -np.sin(track.climb), -np.cos(track.climb) * np.sin(bank), -np.cos(track.climb) * np.cos(bank)
    for k, own in enumerate(turned, start=1):
        assert np.abs(tried[k] - own).max() < 1e-3
    wall = bank - sum(
        np.where(
            (span.begin <= strip.first + s) & (strip.first + s <= span.closed),
            span.lean_at(strip.first + s),
            0.0,
        )
        for span in groove_spans(strip)
    )
    for k, own in ((6, np.sin(wall)), (7, np.cos(wall))):
        assert np.abs(tried[k] - own).max() * every[0].height < NEAR


@pytest.mark.needs("OCP")
@pytest.mark.parametrize("seed", [*range(7), 18, TWO_DROPS])  # grooves that end in banks, twists, every ledge
def test_rays_meet_the_step_file_where_they_meet_the_print(seed):
    *_, tooled = drawn(seed, 0.15)
    exact, flat = exact_file.exact_section(tooled), printed.section_body(tooled, facets)
    rng, radius, met = np.random.default_rng(seed), tooled.track.radius, 0
    for s, y in zip(rng.uniform(2e-3, tooled.length - 2e-3, 60), rng.uniform(1e-4, tooled.width - 1e-4, 60)):
        off = radius - y
        above = np.array([off * np.sin(s / radius), radius - off * np.cos(s / radius), 0.05])
        one, other = facets.below(flat, above), exact_body.below(exact, above / MM)
        met += one is not None
        assert (one is None) == (other is None)
        square = np.cos(float(tooled.bank_at(s)))  # rays come down on the track askew where it is twisted
        assert one is None or abs(one - other * MM) * square <= NEAR
    assert met > 20


@pytest.mark.needs("OCP")
@pytest.mark.parametrize("seed", [4, CHAINS])
def test_the_exact_bowl_has_the_volume_of_its_facets(seed):
    _, every, _, tooled = drawn(seed, 0.15)
    planned, _ = bowl_of(tooled, every)
    exact, flat = (pieces(planned, kit)[0] for kit in (exact_body, facets))
    assert exact_body.volume(exact) == pytest.approx(flat.volume(), rel=1e-3)
