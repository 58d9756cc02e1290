"""The drawing sheets of a bowl: A3, to scale, with dimensions that are measured on the solid.

Sheet 1 has the bowl, its springs, what belongs to it, and the part as it leaves; sheet 2 the devices on the
unrolled track; sheet 3 the poses that each device lets pass and returns; the last sheet the stretches of the
track and their development in sheet metal.
"""

import itertools
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Floats
from feederscrew.base.units import DEG, GRAM, LITRE, MM, PER_MINUTE
from feederscrew.bowl.devices.pneumatics import SEEN_BY
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import Verified
from feederscrew.cad import facets, segments, track
from feederscrew.cad.closed_body import BowlSolid
from feederscrew.cad.measuring import Measures, measures
from feederscrew.cad.plan import DOME, BowlPlan, TrackPath
from feederscrew.machine.sheet import MachineSheet, Order
from feederscrew.output import beside_bowl, beside_sheet, pose_sheet, tooling_drawing
from feederscrew.output import machine_sheet as sheets
from feederscrew.output import solidbowl_views as views
from feederscrew.output.drafting import FRAME, Drawing, scale_words
from feederscrew.output.marking import SheetFields, of_trial
from feederscrew.output.outlet_poses import OutletPoses, find_outlet_poses
from feederscrew.output.tooling_drawing import EDGES, View
from feederscrew.sorting.tooled_track import TooledTrack

SCALES = (1.0, 0.5, 0.4, 0.2, 0.1, 0.05, 0.02)  # ISO 5455, with 1:2.5
VIEW_ROOM = 134.0, 56.0  # [mm] of paper for the bowl across, and upright in each of two views
TOP, VIEW_DISTANCE_MM = 276.0, 21.0  # [mm] where the upper of them begins, and from its foot to the lower one
CUT_TOLERANCE = "±0.1"  # [mm] of an edge that parts meet
GENERAL = "ISO 2768-m"
NARROW_LETTERS = 38  # letters of a line in the left column of the title block
PIECE_ANGLE = np.pi  # [rad] of one piece of the track's development, at most
DEVELOPED_PLACES = 61  # along a piece at which it is developed
OUTLET_BOX = 335.0, 136.0, 408.0, 206.0  # [mm] left, low, right, high: the part as it leaves
POSE_BOX = 356.0, 62.5, 409.0, 77.0  # [mm] the same as a small picture, in the title block
DATUM_CLEAR_RAD = np.radians(35.0)  # from the ray of the datum to that of the track's width, from above
NUMBERS_MM = 25.0  # [mm] from the wall of the unrolled track to the list of devices: room for numbers
POSE_ROWS = 6  # devices on one sheet of poses
POSE_LETTERS = 72  # of a line of the pose in the title block
BESIDE_HEAD = "what stands beside the bowl"
POSES_HEAD = (
    "what each device lets pass and what it returns, seen from inside the bowl; arrow: the way parts travel"
)
CONDITION_LETTERS, CONDITION_LINE_MM = 240, 2.8  # of a line of the condition; from line to line


def draw_sheets(
    study: MachineSheet,
    trial: Verified | None = None,
    mark: str | None = None,
    fields: SheetFields | None = None,
) -> Drawing:
    """Return the drawing of a bowl on its sheets.

    Parameters
    ----------
    study : MachineSheet
        With its order and its solid.
    trial : Verified, optional
        What a trial of the bowl has shown.
    mark : str, optional
        Stands across each sheet in place of the trial's.
    fields : SheetFields, optional
        Date and revision of the title block.

    Returns
    -------
    Drawing
    """
    order, whole = study.order, study.solid
    if order is None or whole is None:
        raise ValueError("the sheet of a bowl shows its order and its solid")
    drawing, solid = Drawing(tooling_drawing.DEVICE_PENS), whole.with_lugs
    wide, deep, high = (float(x) for x in np.ptp(solid.vertices, axis=0))
    sizes = replace(measures(whole), extent=(wide, deep, high))
    scale = min(_scale(max(wide, deep) / MM, VIEW_ROOM[0]), _scale(sizes.height / MM, VIEW_ROOM[1]))
    poses = find_outlet_poses(study, trial)
    rows = [] if poses is None else list(enumerate(poses.devices, start=1))
    of_poses = [rows[k : k + POSE_ROWS] for k in range(0, len(rows), POSE_ROWS)]
    beside = beside_bowl.find_beside(study, trial)
    stations = 0 if beside is None else max(len(beside.vision) - 1, 0)  # on sheets of their own
    count = 2 + (solid.plan.stretch is not None) + len(of_poses) + (beside is not None) + stations
    drawing.box(*FRAME)
    _draw_from_above(drawing, solid, sizes, scale)
    _draw_side_views(drawing, solid, sizes, scale)
    _draw_springs(drawing, study.bowl, whole.plan.turned)
    of_beside = [] if beside is None else _list_beside(beside, count - 1 - stations)
    _draw_list(drawing, study, whole, (246.0, 134.0), of_beside)
    if poses is not None:
        pose_sheet.draw_outlet_views(drawing, poses.leaving, OUTLET_BOX)
    _draw_title_block(drawing, study, order, whole, sizes, scale, trial, fields, f"1 of {count}", poses)
    drawing.mark(of_trial(trial, mark))
    if trial is not None and trial.condition:
        _draw_condition(drawing, trial)
    if solid.plan.stretch is not None:
        draw_devices(drawing, whole.plan, solid.plan.stretch, order.part.name, fields, f"2 of {count}")
        drawing.mark(of_trial(trial, mark))
    for k, group in enumerate(of_poses, start=3 if solid.plan.stretch is not None else 2):
        drawing.new_sheet()
        _draw_title(drawing, order.part.name, None, fields, f"{k} of {count}")
        _draw_head(drawing, 25.0, 281.0, POSES_HEAD, None)
        pose_sheet.draw_device_poses(drawing, group, 25.0, 276.0)
        drawing.mark(of_trial(trial, mark))
    if beside is not None:
        drawing.new_sheet()
        _draw_title(drawing, order.part.name, None, fields, f"{count - 1 - stations} of {count}")
        _draw_head(drawing, 25.0, 281.0, BESIDE_HEAD, None)
        outlet, plate = (whole.plan.outlet, whole.plan.width), whole.plan.material.plate / MM
        beside_sheet.draw_beside(drawing, beside, outlet, plate)
        drawing.mark(of_trial(trial, mark))
        for number in range(1, stations + 1):
            drawing.new_sheet()
            _draw_title(drawing, order.part.name, None, fields, f"{count - 1 - stations + number} of {count}")
            _draw_head(drawing, 25.0, 281.0, BESIDE_HEAD, None)
            beside_sheet.draw_station(drawing, beside, number)
            drawing.mark(of_trial(trial, mark))
    _draw_track(drawing, whole.plan, order.part.name, fields, f"{count} of {count}")
    drawing.mark(of_trial(trial, mark))
    return drawing


def _draw_condition(drawing: Drawing, trial: Verified) -> None:
    """The condition under which the bowl holds, in the margin above the frame: nobody builds it without."""
    left, _, _, top = FRAME
    lines = textwrap.wrap(f"{trial.status}: {trial.condition}", CONDITION_LETTERS)
    for k, line in enumerate(reversed(lines)):
        drawing.text(left, top + 1.5 + CONDITION_LINE_MM * k, line, 1.85, layer="NOTE")


def _scale(size: float, room: float) -> float:
    return next((scale for scale in SCALES if scale * size <= room), SCALES[-1])


def _to_paper(pieces: ArrayLike, at: ArrayLike, scale: float) -> Floats:
    return np.asarray(pieces, float) / MM * scale + np.asarray(at, float)


def _draw_view(drawing: Drawing, pieces: Floats) -> None:
    """Draw the edges of a view (N, 2, 2) [mm]; those that go on from each other as one line."""
    merged = shapely.line_merge(shapely.multilinestrings(np.round(pieces, 4)))
    drawing.lines(shapely.get_coordinates(line) for line in shapely.get_parts(merged))


def _draw_head(drawing: Drawing, x: float, y: float, words: str, scale: float | None) -> None:
    drawing.text(x, y, words if scale is None else f"{words}  {scale_words(scale)}", 3.0, bold=True)


def _draw_from_above(drawing: Drawing, solid: BowlSolid, sizes: Measures, scale: float) -> None:
    """The bowl from above: its diameter, the track's width, the bolts, and where the tooling begins."""
    at, plan = np.array([95.0, 203.0]), solid.plan
    drawn = views.lines(solid.vertices, solid.faces, views.camera(-90.0, 90.0))
    _draw_view(drawing, _to_paper(drawn, at, scale))
    r = 0.5 * sizes.diameter / MM * scale
    low = at[1] - 0.5 * max(sizes.extent[:2]) / MM * scale - 6.0
    if plan.stairs is None:
        drawing.length(at - [r, 0.0], at + [r, 0.0], (0.0, low - at[1]), scale, "Ø<>", decimals=1)
    else:
        drawing.round_size(at, r, plan.turned / DEG, scale, text="<> at the outlet", decimals=1)
        lowest = float(plan.path.wall_radius(0.0)) / MM
        drawing.text(25.0, 268.0, f"R{lowest:.4g} of the wall where the track begins", 2.2)
    # the track's width on a ray of its own, away from that of the datum
    sense = 1.0 if plan.left else -1.0
    across = plan.turned + sense * 0.5 * np.pi
    datum = np.nan
    if plan.stretch is not None:
        datum = plan.turned - sense * float(plan.path.angle(plan.first))
        if np.cos(across - datum) > np.cos(DATUM_CLEAR_RAD):
            across += DATUM_CLEAR_RAD if np.sin(across - datum) >= 0.0 else -DATUM_CLEAR_RAD
    outward = _ray(across)
    wide = sizes.track_width * np.cos(float(plan.path.bank_at(plan.path.at(-0.5 * np.pi)))) / MM * scale
    drawing.lines([[at + outward * (r - wide - 7.0), at + outward * r]], "DIMENSION")
    x, y = at + outward * (r - wide - 9.5)
    drawing.text(x, y - 1.0, f"track {sizes.track_width / MM:.4g}", 2.2, "center")
    drawing.circle(at, 0.5 * plan.bolt_circle / MM * scale, "CENTRE")
    bolts = f"{plan.bolts} x Ø{plan.bolt / MM:.4g} on Ø{plan.bolt_circle / MM:.4g}, and one in the middle"
    drawing.text(25.0, 276.5, bolts, 2.2)
    if plan.stretch is not None:
        start = _angle_from_outlet(plan, 0.0)
        drawing.text(25.0, 272.5, f"tooling begins at the datum D, {start:.4g}° before the outlet", 2.2)
        drawing.lines([[at + (r - wide - 2.0) * _ray(datum), at + (r + 5.0) * _ray(datum)]], "NOTE")
        x, y = at + (r + 7.5) * _ray(datum)
        if abs(x - at[0]) < 12.0 and y < at[1]:  # not on the number of the diameter
            x, y = at + (r - wide - 5.0) * _ray(datum)
        drawing.text(x, y - 1.2, "D", 3.0, "center", bold=True)
    drawing.lines([[at - [r + 6, 0], at + [r + 6, 0]]], "CENTRE")
    for side in (-1, 1):
        drawing.text(at[0] + side * (r + 10.0), at[1] - 5.0, "A", 3.0, "center", bold=True)
    _draw_head(drawing, 25.0, 281.0, "from above", scale)


def _ray(angle: float) -> Floats:
    return np.array([np.cos(angle), np.sin(angle)])


def _angle_from_outlet(plan: BowlPlan, place: float) -> float:
    """Return how far [deg] before the outlet a place [m] of the tooled stretch lies, along the bowl."""
    return -float(plan.path.angle(plan.first + place)) / DEG


def _draw_side_views(drawing: Drawing, solid: BowlSolid, sizes: Measures, scale: float) -> None:
    """Draw the section A-A with the yoke of the inner rail, the view from outside, and the bowl standing."""
    at = np.array([255.0, TOP - solid.vertices[:, 2].max() / MM * scale])
    rings = [_to_paper(ring, at, scale) for ring in facets.section(facets.placed(solid), 0.0)]
    drawing.hatch(rings)
    low = at[1] + solid.vertices[:, 2].min() / MM * scale
    left = min(ring[:, 0].min() for ring in rings)
    right = max(ring[:, 0].max() for ring in rings)
    high = low + sizes.height / MM * scale
    drawing.length((left, low), (left, high), (-6.0, 0.0), scale)
    drawing.length((right, at[1]), (right, at[1] + sizes.outlet_height / MM * scale), (6.0, 0.0), scale)
    _draw_head(drawing, 190.0, 281.0, "A-A", scale)
    plate, far = solid.plan.material.plate / MM, sizes.outlet_height / MM
    text = f"wall {sizes.wall / MM:.3g}, floor {sizes.floor / MM:.3g} at {DOME / DEG:.3g}°, track {plate:.3g}"
    text += f"; outlet {far:.4g} over the floor's edge"
    # a yoke of the inner rail, where A-A cuts the rails
    plan = solid.plan
    angle = (plan.turned if plan.left else -plan.turned) % (2.0 * np.pi)
    s = float(plan.path.at(angle - 2.0 * np.pi if angle > 1e-9 else 0.0))
    yoke = track.yoke_outline(plan, s)
    if len(yoke):
        outer = yoke + [float(plan.path.wall_radius(s)), 0.0]
        drawing.outline(_to_paper(outer, at, scale), "HIDDEN")
        text += "; dashed: yoke of the inner rail"
    drawing.text(at[0], low - 8.0, text, 2.2, "center")
    # below it towards the outlet, from outside
    top = TOP - sizes.height / MM * scale - VIEW_DISTANCE_MM
    at = np.array([255.0, top - solid.vertices[:, 2].max() / MM * scale])
    turn = np.degrees(plan.turned) + (-90.0 if plan.left else 90.0)
    drawn = _to_paper(views.lines(solid.vertices, solid.faces, views.camera(turn, 0.0)), at, scale)
    _draw_view(drawing, drawn)
    low = at[1] + solid.vertices[:, 2].min() / MM * scale
    wide = (0.5 * sizes.diameter + sizes.wall) / MM * scale
    left, right, text = at[0] - wide, at[0] + wide, "Ø<>"
    if plan.stairs is not None:
        left, right, text = drawn[..., 0].min(), drawn[..., 0].max(), "<>"
    drawing.length((left, low), (right, low), (0.0, -6.0), scale, text, decimals=1)
    _draw_head(drawing, 190.0, top + 3.0, "towards the outlet", scale)
    # and as it stands
    pieces = views.lines(solid.vertices, solid.faces, views.camera(np.degrees(plan.turned) - 125.0, 42.0))
    least, most = pieces.reshape(-1, 2).min(axis=0), pieces.reshape(-1, 2).max(axis=0)
    size = min(72.0 / (most - least)[0], 66.0 / (most - least)[1])
    _draw_view(drawing, (pieces - 0.5 * (least + most)) * size + [371.0, 244.0])
    drawing.text(335.0, 281.0, "not to scale", 2.2)


def _draw_springs(drawing: Drawing, bowl: Bowl, outlet: float) -> None:
    """The circle of the springs from above, the outlet at an angle [rad], and one bank from the axis."""
    under, banks = bowl.machine, sheets.spring_banks(bowl)
    at, reach = np.array([77.0, 68.0]), (under.spring_radius + under.leaf_width) / MM
    scale = _scale(2.0 * reach, 105.0)
    r = under.spring_radius / MM * scale
    _draw_head(drawing, 25.0, 127.0, "leaf springs from above", scale)
    drawing.circle(at, r, "CENTRE")
    sides = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    half = 0.5 * np.array([under.leaf_width, under.leaf_thickness]) / MM * scale
    for count, angle in zip(banks.counts, banks.angles):
        axes = np.array([_ray(angle), _ray(angle + 0.5 * np.pi)])
        for step in 4.0 * half[1] * (np.arange(count) - 0.5 * (count - 1)):
            drawing.outline(at + (sides * half + [r, step]) @ axes, "EDGE")
    drawing.round_size(at, r, 200.0, scale, diameter=True)
    if len(banks.angles) > 1:
        drawing.angle(at, 0.6 * r, banks.angles[0] / DEG, banks.angles[1] / DEG)
    drawing.lines([[at, at + (r + 8.0) * _ray(outlet)]], "CENTRE")
    x, y = at + (r + 10.0) * _ray(outlet)
    drawing.text(x, y, "outlet", 2.2, "left" if np.cos(outlet) >= 0.0 else "right")
    if abs((banks.angles[0] - outlet) / DEG % 360.0) > 1e-6:
        drawing.angle(at, 0.35 * r, outlet / DEG, banks.angles[0] / DEG)
    # one bank: its leaves with spacers, the free length and the tilt
    count, long, thick = max(banks.counts), under.leaf_length / MM, under.leaf_thickness / MM
    scale = _scale(max(long + 30.0, 2.0 * banks.stack / MM), 80.0)
    tilt, at = under.spring_angle, np.array([187.0, 72.0])
    along = np.array([np.sin(tilt), np.cos(tilt)])
    axes = np.array([[along[1], -along[0]], along])  # across the leaves, along them
    thin, clamp = 0.5 * thick * scale, 0.5 * long * scale
    low, high = np.array([-0.5 * long - 12.0, 0.5 * long + 12.0]) * scale
    outer = (2 * count - 1) * thin

    def placed(places: ArrayLike) -> Floats:
        return at + np.array(places) @ axes

    for k in range(2 * count - 1):  # leaves, and between them a spacer at each end
        left, right = (2.0 * thin * (k - (count - 1)) + x * thin for x in (-1, 1))
        for below, above in ((low, high),) if k % 2 == 0 else ((low, -clamp), (clamp, high)):
            corners = placed([(left, below), (right, below), (right, above), (left, above)])
            drawing.outline(corners, "EDGE") if k % 2 == 0 else drawing.hatch([corners])
    start, end = placed([(outer, -clamp), (outer, clamp)])
    drawing.length(start, end, 8.0 * axes[0], scale)
    top = clamp + 12.0 * scale
    start, end = placed([(-outer, top), (outer, top)])
    drawing.length(start, end, 6.0 * axes[1], scale)
    (foot,) = placed([(-outer, -clamp - 12.0 * scale)])
    drawing.lines([[foot, foot + [0.0, 0.75 * long * scale]]], "CENTRE")
    drawing.angle(foot, 0.62 * long * scale, 90.0 - tilt / DEG, 90.0)
    _draw_head(drawing, 140.0, 127.0, "one bank from the axis", scale)
    words = (
        f"{len(banks.counts)} banks: {', '.join(map(str, banks.counts))} leaves {sheets.leaf_words(under)}",
        f"{banks.spacers} spacers {under.leaf_width / MM:.3g} x {thick:.3g}; {long:.4g} free between clamps",
    )
    for k, line in enumerate(words):
        drawing.text(140.0, 19.0 - 4.0 * k, line, 2.2)


def _list_beside(beside: beside_bowl.Beside, sheet: int) -> list[tuple[str, str]]:
    """List what stands beside the bowl, as quantity and what, for the parts list; its sheet has details."""
    listed = []
    for more, station in enumerate(beside.vision):
        what = f"{SEEN_BY[station.sees][0]} with light, trigger and valve, device {station.number}"
        listed.append(("1", f"{what}: sheet {sheet + more}"))
    return [*listed, ("1", f"inline track with two level sensors: sheet {sheet}")]


def _draw_list(
    drawing: Drawing,
    study: MachineSheet,
    solid: BowlSolid,
    corner: tuple[float, float],
    beside: Sequence[tuple[str, str]],
) -> None:
    under, banks = study.bowl.machine, sheets.spring_banks(study.bowl)
    plan, cut, (weight, angle) = solid.plan, solid.segments, solid.balance
    turn = (angle - plan.turned) / DEG % 360.0
    rows = [
        ("1", f"bowl, {plan.material.name}, {solid.mass:.4g} kg"),
        ("1", f"weight of {weight / GRAM:.3g} g on the wall, {turn:.0f}° counter-clockwise from the outlet"),
    ]
    rows += [("1", f"{name.replace('_', ' ')}, in its notch of the wall") for name, _, _ in solid.gates]
    if cut is not None and cut.dowels:
        size = f"{cut.dowel / MM:.3g} x {cut.dowel_length / MM:.3g} mm"
        rows.append((str(cut.dowels), f"dowels {size}, between {len(cut.pieces)} segments"))
    if cut is not None and len(cut.screws):
        screw = f"screws ISO 4762 {segments.SCREW_NAME} with nuts ISO 4032"
        rows.append((str(len(cut.screws)), f"{screw}, in lugs of the segments; floor: dowels"))
    each = "/".join(map(str, dict.fromkeys(banks.counts)))
    leaves = f"leaves {sheets.leaf_words(under)} mm of spring steel, {len(banks.counts)} banks of {each}"
    peak, share = study.stroke.peak_to_peak / MM, 100.0 * study.bowl.sizing.controller
    supply = sheets.supply(study.stroke.frequency)
    rows += [
        (str(plan.bolts + 1), f"bolts for holes of {plan.bolt / MM:.4g} mm"),
        (f"{under.leaves:.0f}", f"{leaves}, at {under.spring_angle / DEG:.3g}°"),
        (str(banks.spacers), f"spacers {under.leaf_width / MM:.3g} x {banks.thickness / MM:.3g} mm"),
        ("1", f"coil, force amplitude {study.force:.3g} N, {supply} Hz"),
        ("1", f"controller, set to {share:.3g} %: {peak:.3g} mm peak to peak"),
    ]
    rows += beside
    numbered = [[str(k), *row] for k, row in enumerate(rows, start=1)]
    line = min(4.6, 54.0 / (len(rows) + 1))
    drawing.table(*corner, [10.0, 18.0, 136.0], [["pos.", "quantity", "what"], *numbered], line=line)


def _draw_title_block(
    drawing: Drawing,
    study: MachineSheet,
    order: Order,
    solid: BowlSolid,
    sizes: Measures,
    scale: float,
    trial: Verified | None,
    fields: SheetFields | None,
    sheet: str,
    poses: OutletPoses | None,
) -> None:
    """The title block in the lower right corner; of a bowl that was tried as it was tried."""
    left, low, right, high = 246.0, 10.0, 410.0, 78.0
    drawing.box(left, low, right, high)
    plan, path = solid.plan, solid.plan.path
    drawing.text(left + 2.0, high - 5.5, f"Bowl for {_shorten(order.part.name)}", 4.0, bold=True)
    # what of its drive the springs do not make, at most two lines
    lines = list(filter(None, [sheets.two_axis(study.bowl.drive)]))
    if study.mismatch is not None:
        lines.append(f"these springs make {study.mismatch.machine.text}")
    for k, line in enumerate(lines):
        drawing.text(left, high + 5.4 - 3.2 * k, line, 1.85, layer="NOTE")
    wanted, rate = "all that pass", []
    if trial is not None:
        wanted = _shorten(trial.wanted, NARROW_LETTERS)
        rate = [("rate of its trial", _shorten(sheets.rate_of_trial(trial), NARROW_LETTERS))]
    elif order.wanted is not None:
        wanted = f"{order.wanted[0]} at {np.degrees(order.wanted[1]):.3g}°"
    # climbs and banks of the track, one after the other
    climbs, banks = (
        " to ".join(f"{np.degrees(angle):.3g}°" for angle in angles)
        for angles in (_climbs(path), (path.bank, *(bank for _, _, bank in path.leans)))
    )
    hand = f"{'left' if plan.left else 'right'}: parts climb {'' if plan.left else 'counter-'}clockwise"
    pairs = [
        ("drawing of part", _shorten(order.part.source.rpartition("/")[2])),
        ("rate asked for", f"{order.target / PER_MINUTE:.4g} a minute"),
        ("orientation", wanted),
        *rate,
        ("part material", sheets.material(order.part)),
        ("fill, hopper", f"{study.fill.mass:.3g} kg, {order.hopper / LITRE:.3g} l"),
        ("drive", f"{study.stroke.frequency:.4g} Hz, {study.stroke.peak_to_peak / MM:.3g} mm"),
        ("vibration angle", sheets.angles(study, phase=False)),
        ("natural frequency", f"{study.springs.natural_frequency:.4g} Hz"),
        ("climb, bank", f"{climbs}, {banks}"),
        ("hand", hand),
        ("turns", f"{study.turns:.3g}"),
        ("material", f"{plan.material.name}, {plan.material.density:.4g} kg/m³"),
        ("mass, volume", f"{solid.mass:.4g} kg, {solid.with_lugs.volume / MM**3:.6g} mm³"),
        ("inertia about axis", f"{solid.inertia:.4g} kg m²"),
        ("centre of mass", f"{', '.join(f'{x / MM:.1f}' for x in solid.centre)} mm"),
        ("size", f"{' x '.join(f'{x / MM:.4g}' for x in sizes.extent)} mm"),
        ("general tolerance", f"{GENERAL}; cuts {CUT_TOLERANCE} mm"),
        ("drawn by", "feeder bowl" if trial is None else "feeder design, feeder bowl"),
        *_sheet_fields(fields, scale, sheet),
    ]
    if poses is not None:  # the pose that leaves, in words and as a picture
        pose_sheet.draw_pose(drawing, poses.leaving, POSE_BOX)
        for k, line in enumerate(textwrap.wrap(f"leaves {poses.words}", POSE_LETTERS)[:2]):
            drawing.text(left + 2.0, high - 9.5 - 3.2 * k, line, 2.0, bold=k == 0)
    half = (len(pairs) + 1) // 2
    for k, (name, value) in enumerate(pairs):
        x, y = left + 2.0 + 82.0 * (k // half), high - 19.0 - 4.0 * (k % half)
        drawing.text(x, y, name, 1.9, layer="EDGE")
        drawing.text(x + 27.0, y, value, 2.0)


def _sheet_fields(fields: SheetFields | None, scale: float | None, sheet: str) -> list[tuple[str, str]]:
    words = "not to scale" if scale is None else scale_words(scale)
    scales = ("scale, sheet", f"{words}, A3, {sheet}, sizes in mm")
    return [scales, *tooling_drawing.title_fields(fields)]


def _draw_title(
    drawing: Drawing, part: str, scale: float | None, fields: SheetFields | None, sheet: str
) -> None:
    left, low, right, _ = FRAME
    drawing.box(*FRAME)
    drawing.box(left, low, right, low + 8.0)
    name = ("bowl for", _shorten(part))
    for k, (key, value) in enumerate([name, *_sheet_fields(fields, scale, sheet)]):
        x = left + 2.0 + (0.0, 88.0, 190.0, 292.0, 342.0)[k]
        drawing.text(x, low + 2.8, f"{key}: {value}", 2.2)


def _shorten(words: str, letters: int = 46) -> str:
    return words if len(words) <= letters else f"{words[: letters - 1]}…"


def _climbs(path: TrackPath) -> list[float]:
    return [path.climb, *(climb for _, climb in path.bends)]


def _stretches(path: TrackPath) -> Iterator[tuple[tuple[float, float], float]]:
    """Stretches of one climb: from and to along the wall [m], the climb [rad]."""
    stops = itertools.pairwise([0.0, *(at for at, _ in path.bends), path.end])
    return zip(stops, _climbs(path))


def draw_devices(
    drawing: Drawing, plan: BowlPlan, stretch: TooledTrack, part: str, fields: SheetFields | None, sheet: str
) -> None:
    """Draw sheet 2: the tooled stretch unrolled, seen from above, with its dimensions and list of devices.

    Parameters
    ----------
    drawing : Drawing
    plan : BowlPlan
    stretch : TooledTrack
        Of that bowl.
    part : str
        Name.
    fields : SheetFields or None
        Date and revision.
    sheet : str
        '2 of 5'
    """
    length = stretch.length
    if stretch.hangs:  # with the outlet
        length = min(plan.path.end - plan.first + plan.outlet, 2.0 * length)
    scale = min(_scale(length / MM, 330.0), _scale(plan.width / MM, 45.0))
    drawing.new_sheet()
    _draw_title(drawing, part, scale, fields, sheet)
    # holes in the wall are drawn above the track, below the head
    bores = min(240.0, 270.0 - tooling_drawing.bore_height(stretch.devices) / MM * scale)
    view = View((45.0, bores - 25.0 - plan.width / MM * scale), scale, length)
    drawing.outline(view.placed([(0, 0), (length, 0), (length, plan.width), (0, plan.width)]), "TRACK")
    drawing.outline(view.placed([(0, -2e-3), (length, -2e-3), (length, -1e-9), (0, -1e-9)]), "WALL")
    opened = stretch.opened_to(length)
    for placed in opened.devices:
        for layer, ring in tooling_drawing.edges(placed, plan.width):
            drawing.outline(view.placed(ring), layer)
        for ring in (ring for opening in placed.openings for ring in opening.on_track(plan.width)):
            drawing.outline(view.placed(ring), "CUT")
        for ring in placed.footprints:
            drawing.outline(view.placed(ring), "GATE")
    tooling_drawing.dimension_devices(drawing, opened.devices, view, plan.width)
    drawing.length(view.placed([length, 0]), view.placed([length, plan.width]), (27.0, 0.0), scale)
    tooling_drawing.draw_wall_bores(drawing, opened.devices, view, bores, listed=False)
    behind = (plan.path.end - plan.first) / MM
    words = f"track unrolled: wall below, parts move to the right; D lies {behind:.5g} mm along the wall, "
    _draw_head(drawing, 25.0, 281.0, f"{words}{_angle_from_outlet(plan, 0.0):.4g}° before the outlet", scale)
    rows = tooling_drawing.device_rows(stretch.devices, plan.width, lambda s: _angle_from_outlet(plan, s))
    rows[0][4:6] = ["from [°] *", "to [°] *"]
    # changes of the track that are no device
    below = {ledge.begin for ledge in stretch.ledges}
    changes = [(f"step {drop / MM:.4g} mm down", at, at) for at, drop in stretch.drops if at not in below]
    for ledge in stretch.ledges:
        drop = ledge.drop
        level = f"ledge {drop.aside / MM:.4g} wide, track {drop.height / MM:.4g} lower"
        changes.append((f"{level}; to {ledge.end / MM:.5g} level", ledge.begin, ledge.foot))
    for start, end, bank in stretch.banks:
        changes.append((f"twists to a bank of {np.degrees(bank):.3g}°", start, end))
    for groove in stretch.grooves:
        words = f"groove: the wall leans back by {np.degrees(groove.lean):.3g}°"
        changes.append((words, max(groove.begin, 0.0), groove.end))
    for words, start, stop in changes:
        angles = [f"{_angle_from_outlet(plan, place):.4g}" for place in (start, stop)]
        rows.append(["", "track", f"{start / MM:.5g}", f"{stop / MM:.5g}", *angles, words])
    top = min(175.0, float(view.at[1]) - NUMBERS_MM)  # below the numbers along the track
    notes = [
        f"from and to: along the wall from D; cuts {CUT_TOLERANCE}, everything else {GENERAL}; "
        "* before the outlet",
        f"track of sheet {plan.material.plate / MM:.4g}, wall {plan.material.wall / MM:.4g}; "
        f"arcs are facets within {plan.chord / MM:.3g} mm; {EDGES}",
    ]
    places = [f"{(place - plan.first) / MM:.5g}" for place in track.yoke_places(plan)]
    if places:
        notes.append(
            f"inner rail: {len(places)} yokes of {track.YOKE / MM:.3g} below it, to the wall, at "
            f"{' and '.join(places)} from D; {plan.hanging / MM:.4g} clear below the track"
        )
    notes += tooling_drawing.bore_texts(stretch.devices)
    line = min(4.6, (top - 33.0 - 4.0 * len(notes)) / len(rows))
    low = drawing.table(25.0, top, tooling_drawing.DEVICE_LIST_COLUMNS_MM, rows, line=line)
    for k, note in enumerate(notes):
        drawing.text(25.0, low - 5.0 - 4.0 * k, note, 2.2)


def _develop_track(path: TrackPath, width: float, start: float, end: float) -> tuple[Floats, Floats]:
    """Return the flat outline of a piece of track between lengths along the wall: its borders, (N, 2) [m].

    The surface between the outer and the inner border is taken as triangles, which are laid into the plane
    one after the other. For a helicoid of one climb this is the annulus of a screw flight's blank.
    """

    def distance(a: Floats, b: Floats) -> float:
        return float(np.sqrt(((a - b) ** 2).sum()))

    s = np.linspace(start, end, DEVELOPED_PLACES)
    outer, inner = path.places(s, 0.0), path.places(s, width)
    flat = [np.array([0.0, 0.0]), np.array([0.0, -distance(outer[0], inner[0])])]
    for k in range(1, DEVELOPED_PLACES):
        a, b = flat[-2:]
        for from_a, from_b in (
            (distance(outer[k - 1], outer[k]), distance(inner[k - 1], outer[k])),
            (distance(outer[k], inner[k]), distance(inner[k - 1], inner[k])),
        ):  # the third corner of a triangle, ahead of the line between two
            base = distance(a, b)
            along = (b - a) / base
            x = (from_a**2 - from_b**2 + base**2) / (2.0 * base)
            y = np.sqrt(max(from_a**2 - x**2, 0.0))
            a = a + x * along + y * np.array([-along[1], along[0]])
            flat.append(a)
    return np.array(flat[0::2]), np.array(flat[1::2])


def _draw_track(drawing: Drawing, plan: BowlPlan, part: str, fields: SheetFields | None, sheet: str) -> None:
    """The last sheet: the stretches of the track from the side, and their development in sheet metal."""
    path = plan.path
    scale = _scale(path.end / MM, 340.0)
    drawing.new_sheet()
    _draw_title(drawing, part, scale, fields, sheet)
    # heights over the floor's edge along the wall, from where it rises to the outlet
    stops = sorted({0.0, path.end, *(at for at, _ in (*path.bends, *path.drops))})
    places = np.unique(np.concatenate([stops, np.nextafter(np.array(stops[1:-1]), 0.0), [plan.first]]))
    heights, height_at = path.height(places), {s: float(path.height(s)) for s in stops}
    at = np.array([40.0, 266.0 - float(heights.max()) / MM * scale])

    def placed(s: float, z: float) -> Floats:
        return np.array([s, z]) / MM * scale + at

    drawing.outline(np.column_stack([places, heights]) / MM * scale + at, "OUTLINE", is_closed=False)
    drawing.lines([[at, at + [path.end / MM * scale, 0.0]]], "CENTRE")
    for s, end in zip(stops, tooling_drawing.spread([s / MM * scale + at[0] for s in stops], 4.2)):
        drawing.ordinate(placed(s, height_at[s]), (end, at[1] - 14.0), at, False, scale)
    right = at[0] + path.end / MM * scale
    levels = sorted({round(z, 7) for z in height_at.values() if z > 1e-6})
    for z, end in zip(levels, tooling_drawing.spread([z / MM * scale + at[1] for z in levels], 4.2)):
        s = next(s for s in stops if abs(height_at[s] - z) < 1e-6)
        drawing.ordinate(placed(s, z), (right + 12.0, end), at, True, scale)
    for (start, end), climb in _stretches(path):
        middle = 0.5 * (start + end)
        x, y = placed(middle, float(path.height(middle)))
        drawing.text(x, y + 3.0, f"{climb / DEG:.3g}°", 2.5, "center")
    if plan.stretch is not None:
        x, y = placed(plan.first, float(path.height(plan.first)))
        drawing.lines([[(x, y - 3.0), (x, y + 7.0)]], "NOTE")
        drawing.text(x, y + 8.0, "D", 3.0, "center", bold=True)
    _draw_head(drawing, 25.0, 281.0, "track along the wall, heights over the floor's edge", scale)
    flat = []  # the outline of each piece: one climb, half a turn at most
    rows = [
        [
            "piece",
            "from [°] *",
            "to [°] *",
            "climb",
            "height [mm]",
            "pitch [mm]",
            "outer R",
            "inner R",
            "angle",
            "width",
        ]
    ]
    for (start, end), climb in _stretches(path):
        count = int(np.ceil((float(path.angle(end)) - float(path.angle(start))) / PIECE_ANGLE - 1e-9))
        for a, b in itertools.pairwise(np.linspace(start, end, max(count, 1) + 1)):
            if b <= a:
                continue
            flat.append(_develop_track(path, plan.width, a, b))
            # of the annulus whose borders are as long as its own
            long, short = (float(np.hypot(*np.diff(edge, axis=0).T).sum()) for edge in flat[-1])
            width = float(np.hypot(*(flat[-1][0][0] - flat[-1][1][0])))
            inner = width * short / (long - short)
            radii = [f"{radius / MM:.5g}" for radius in (inner + width, inner)]
            ends = [f"{abs(float(path.angle(s))) / DEG:.4g}" for s in (a, b)]
            heights = " to ".join(f"{float(path.height(s)) / MM:.4g}" for s in (a, b))
            pitch = 2.0 * np.pi * path.radius * np.tan(climb) / MM
            rows.append(
                [
                    str(len(flat)),
                    *ends,
                    f"{climb / DEG:.3g}°",
                    heights,
                    f"{pitch:.4g}",
                    *radii,
                    f"{long / (inner + width) / DEG:.4g}°",
                    f"{plan.width / MM:.4g}",
                ]
            )
    low = drawing.table(25.0, 212.0, [12.0, 22, 22, 18, 36, 24, 24, 24, 24, 22], rows)
    drawing.text(25.0, low - 5.0, "* before the outlet; radii, angle and width: of the flat sheet", 2.2)
    _draw_flat_pieces(drawing, flat, low - 14.0)


def _draw_flat_pieces(drawing: Drawing, pieces: Sequence[tuple[Floats, Floats]], top: float) -> None:
    """The outlines of the flat pieces beside each other, each upright in the middle."""
    bodies = []
    for outer, inner in pieces:
        ends = outer[-1] - outer[0]
        turn = -np.arctan2(ends[1], ends[0])
        c, s = np.cos(turn), np.sin(turn)
        bodies.append(np.vstack([outer, inner[::-1]]) @ np.array([[c, s], [-s, c]]) / MM)
    room = top - FRAME[1] - 26.0
    widest, tallest = np.max([np.ptp(ring, axis=0) for ring in bodies], axis=0)
    layouts = []  # the largest scale, and of these the fewest lines
    for columns in range(min(len(bodies), 6), 0, -1):
        lines = -(-len(bodies) // columns)
        size = min(_scale(widest, 375.0 / columns - 14.0), _scale(tallest, room / lines - 14.0))
        layouts.append((size, -lines, columns))
    scale, lines, columns = max(layouts)
    for k, ring in enumerate(bodies):
        line, column = divmod(k, columns)
        at = np.array([25.0 + (column + 0.5) * 375.0 / columns, top - 6.0 + line * room / lines])
        flat = ring * scale
        shift = at - [0.5 * (flat[:, 0].min() + flat[:, 0].max()), flat[:, 1].max()]
        drawing.outline(flat + shift, "OUTLINE")
        start, end = flat[[0, DEVELOPED_PLACES - 1]] + shift
        drawing.length(start, end, (0.0, flat[:, 1].min() - flat[0, 1] - 7.0), scale)
        drawing.text(at[0], at[1] + 2.0, f"piece {k + 1}", 2.5, "center", bold=True)
    _draw_head(drawing, 25.0, top + 3.5, "track in sheet metal, flat", scale)
