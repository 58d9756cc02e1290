"""The stretch of track with its devices, dimensioned: DXF and SVG of ``feeder tooling``, and for the sheet.

Every length along the track is measured from the datum D, where the stretch begins. Every length across it
is measured from the wall.
"""

import itertools
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Floats
from feederscrew.base.units import DEG, MM
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.features import Bore, box_ring
from feederscrew.output import marking
from feederscrew.output.drafting import Drawing, Pen, spread
from feederscrew.output.tables import Frame
from feederscrew.sorting.orientations import CUT_BORDER_RADIUS_M
from feederscrew.sorting.tooled_track import PlacedDevice, TooledTrack, bend_ring

VIEW_GAP_MM = 20.0  # [mm] between the views
SQUARE_RAD = 0.5 * np.pi  # [rad] of a bore to the wall
DRAWN_WALL_M = 2e-3  # [m] thickness the wall is drawn with
LETTER_ROOM_MM = 1.9  # [mm] of a digit of a dimension, along its line
EDGES = f"edges broken at most {CUT_BORDER_RADIUS_M / MM:.3g} mm"  # as they are tried
SHOP = f"values ±0.1 mm; {EDGES}; lands 1 mm and the sheet's thickness at least"
DEVICE_PENS = {  # of the layers of devices
    "TRACK": Pen(7, "#22303c", 0.25, face="#eef1f4"),
    "WALL": Pen(8, "#22303c", 0.25, face="#9aa5b1"),
    "CUT": Pen(1, "#d55e00", 0.35, face="#ffffff"),
    "GATE": Pen(5, "#0072b2", 0.25, face="#0072b2"),
    "OPENING": Pen(4, "#0072b2", 0.25, face="#ffffff"),
    "GHOST": Pen(9, "#7a8793", 0.18, "DASHED"),
    "SENSOR": Pen(3, "#009e73", 0.25, "DASHED"),
    "NOZZLE": Pen(3, "#009e73", 0.25),
    "BORE": Pen(3, "#009e73", 0.25),
    "SLOPE": Pen(6, "#cc79a7", 0.35),
    "STEP": Pen(6, "#cc79a7", 0.35),
    "LEDGE": Pen(6, "#cc79a7", 0.35),
}
TEXT_GAP = 4.2  # [mm] of paper between two numbers
NUMBERS = 11.0  # [mm] of paper from the wall to the numbers along it
DRAWN_LINE_M = 2e-4  # [m] the width with which a line along or across the track is drawn
CROSS = 2.0  # [mm] of paper: half of a sensor's cross
DEVICE_LIST_COLUMNS_MM = 9.0, 56.0, 21.0, 19.0, 20.0, 17.0, 160.0  # [mm] of the list of devices
LINE_LETTERS = 92  # of a line in the last column
LEAST_ANGLE_DEG = 0.01  # that is dimensioned


@dataclass(frozen=True)
class View:
    """Place of unrolled lengths [m] on a sheet [mm]."""

    at: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0
    right: float = field(default=np.inf)  # [m] where the drawn stretch ends

    def placed(self, places: ArrayLike) -> Floats:
        """Return where lengths of the track lie on the sheet.

        Parameters
        ----------
        places : (..., 2) array_like [m]
            Along the wall and off it; what is beyond the right end lies there.

        Returns
        -------
        (..., 2) array [mm]
        """
        lengths = np.array(places, float)
        lengths[..., 0] = np.minimum(lengths[..., 0], self.right)
        return np.asarray(self.at) + lengths / MM * self.scale


def dxf(*drawn: Any, **sheet: Any) -> bytes:
    """Return the drawing of a track section as a DXF file.

    Parameters
    ----------
    *drawn, **sheet
        As for ``draw``.

    Returns
    -------
    bytes
    """
    return draw(*drawn, **sheet)[0].dxf()


def svg(*drawn: Any, **sheet: Any) -> str:
    """Return the drawing of a track section as an SVG file of its true size.

    Parameters
    ----------
    *drawn, **sheet
        As for ``draw``.

    Returns
    -------
    str
    """
    drawing, low, high = draw(*drawn, **sheet)
    return drawing.svg(low, high)


def draw(
    strip: TooledTrack,
    ghosts: Sequence = (),
    mark: str = "",
    *,
    thickness: float | None = None,
    fields: marking.SheetFields | None = None,
    titles: Sequence[tuple[str, str]] = (),
) -> tuple[Drawing, Floats, Floats]:
    """Draw a track section 1:1: unrolled with dimensions, list of devices, as bent, openings of gates.

    Layers are named as pens are: ``CUT``, ``CUT_2`` ... one hole each; the same with ``BENT_`` before it as
    it lies in the bowl; ``OPENING``, ``OPENING_2`` ... one gate each, seen along the track.

    Parameters
    ----------
    strip : TrackSection
    ghosts : sequence of ((K, 2) float [m], float [m]), optional
        Outlines of parts from the wall, each with its place along it.
    mark : str, optional
        Stands across the drawing and among its notes.
    thickness : float [m], optional
        Of the track's sheet.
    fields : SheetFields, optional
        Date and revision.
    titles : sequence of (str, str), optional
        Names and values before these.

    Returns
    -------
    drawing : Drawing
    low, high : (2,) float [mm]
        Corners of all that is drawn.
    """
    drawing, view = Drawing(DEVICE_PENS), View()
    length, width = strip.length / MM, strip.width / MM
    plan = [(name, ring) for name, group in _plan(strip).items() for ring in group]
    for name, ring in plan:
        drawing.outline(view.placed(ring), name)
    for ring, place in ghosts:
        drawing.outline(view.placed(np.add(ring, [place, 0.0])), "GHOST")
    dimension_devices(drawing, strip.devices, view, strip.width)
    top = draw_wall_bores(drawing, strip.devices, view, width + 28.0)
    low = -DRAWN_WALL_M / MM - NUMBERS - 20.0
    sheet = "" if thickness is None else f"; track of sheet {thickness / MM:.4g} mm"
    place = "unrolled: wall below, parts move to the right; from the datum D, the begin of the stretch"
    for line in (f"{place}{sheet}", SHOP, *([mark] if mark else [])):
        drawing.text(0.0, low, line, 3.0)
        low -= 5.0
    rows = device_rows(strip.devices, strip.width, lambda s: s / strip.track.radius / DEG)
    low = drawing.table(0.0, low, DEVICE_LIST_COLUMNS_MM, rows)
    right = max(length, sum(DEVICE_LIST_COLUMNS_MM), _openings(drawing, strip))
    names = [*titles, ("scale", "1:1"), ("sizes", "mm"), *title_fields(fields)]
    for k, (name, value) in enumerate(names):
        drawing.text(0.0, top + 6.0 + 5.0 * (len(names) - 1 - k), f"{name}: {value}", 3.0)
    top += 6.0 + 5.0 * len(names)
    # the stretch as it lies in the bowl, below the list
    radius = strip.track.radius / MM
    rings = [(f"BENT_{name}", bend_ring(ring, strip.track.radius)) for name, ring in plan]
    rings += [("BENT_GHOST", _outline_in_bowl(ring, place, strip.track.radius)) for ring, place in ghosts]
    highest = max(float(ring[:, 1].max()) for _, ring in rings) / MM
    shift = np.array([0.0, low - VIEW_GAP_MM - highest])
    for name, ring in rings:
        drawing.outline(ring / MM + shift, name)
    middle, out = np.array([0.0, radius]) + shift, radius + 12.0
    starts = [placed.span[0] / strip.track.radius / DEG for placed in strip.devices]
    # a device that begins at the datum has no angle from it
    for k, start in enumerate(sorted({start for start in starts if start > LEAST_ANGLE_DEG})):
        drawing.angle(middle, out + 6.0 * k, -90.0, -90.0 + start)
    low = float(middle[1]) - out - 6.0 * len(starts) - 8.0
    text = f"as bent: radius of the wall {radius:.6g} mm; angles from the datum D"
    drawing.text(0.0, low, text, 3.0)
    corners = np.array([-16.0, low - 8.0]), np.array([right + 12.0, top + 6.0])
    drawing.mark(mark, corners[0], tuple(corners[1] - corners[0]))
    return drawing, *corners


def title_fields(fields: marking.SheetFields | None) -> list[tuple[str, str]]:
    """Return the fields of a title block that the user gives, and the kind of its views.

    Parameters
    ----------
    fields : SheetFields or None

    Returns
    -------
    list of (str, str)
        Names and values; a value that is not given is ''.
    """
    fields = fields or marking.SheetFields()
    views = "labelled views (ISO 128-3)"
    return [("projection", views), ("date", fields.date), ("rev", fields.revision)]


def dimension_devices(drawing: Drawing, devices: Sequence[PlacedDevice], view: View, width: float) -> None:
    """Dimension the devices of an unrolled stretch of a track, from the wall and from D.

    Parameters
    ----------
    drawing : Drawing
    devices : sequence of PlacedDevice
    view : View
        Where the stretch lies on the sheet.
    width : float [m]
        Of the track.
    """
    along: list[float] = []
    for number, placed in enumerate(devices, start=1):
        # the lengths along the wall [m] that a device is made by, from the datum
        features, origin = placed.features, placed.begin
        lengths = [origin + jet.place for jet in features.jets[:1]]
        if features.sensor is not None:
            lengths.insert(0, origin + features.sensor.at)
        cuts = [(opening, ring) for opening in placed.openings for ring in opening.on_track(width)]
        for opening, ring in cuts:
            corners = [float(x) for x in np.unique(np.round(_cut_corners(ring)[:, 0], 9))]
            far = min(opening.end, view.right) - 1e-9 if opening.hangs else np.inf
            lengths += [x for x in corners if x < far]
        lengths += [float(ring[0, 0]) for ring in placed.footprints]
        lengths += [origin + slope.begin for slope in features.slopes]
        if features.drop is not None:
            lengths.append(origin)
        places = sorted(lengths) or [placed.start]
        along += [place for place in places if place <= view.right]
        name = view.placed([places[0], width]) + [0.5, 13.0 + 4.0 * (number % 2 == 0)]
        drawing.text(float(name[0]), float(name[1]), f"{number}  {placed.device.kind}", 2.5)
        if features.drop is not None and features.drop.aside > 0.0:
            cuts.append((beside := features.drop.beside(width, made=True).shifted(origin), beside.ring))
        for _, ring in cuts:
            _dimension_cut(drawing, ring, view, width)
        if features.sensor is not None:
            middle = view.placed([origin + features.sensor.at, 0.5 * width])
            arms = np.array([[-CROSS, 0.0], [CROSS, 0.0], [0.0, -CROSS], [0.0, CROSS]])
            drawing.lines([middle + arms[:2], middle + arms[2:]], "SENSOR")
    wanted = np.unique(np.round(along, 8))
    ends = spread(view.placed(np.column_stack([wanted, 0.0 * wanted]))[:, 0], TEXT_GAP)
    foot = -DRAWN_WALL_M / MM * min(view.scale, 1.0)
    for place, end in zip(wanted, ends):
        begin = view.placed([place, 0.0]) + [0.0, foot]
        drawing.ordinate(begin, (end, view.at[1] + foot - NUMBERS + 4.0), view.at, False, view.scale)
    drawing.text(view.at[0] - 3.5, view.at[1] + 0.5, "D", 3.5, "right", bold=True)


def _cut_corners(hole: Floats) -> Floats:
    """Return the corners (K, 2) [m] of a cut that have dimensions: sharp ones and extremes, none of arcs."""
    ahead = np.roll(hole, -1, axis=0) - hole
    heading = np.arctan2(ahead[:, 1], ahead[:, 0])
    turn = np.abs((heading - np.roll(heading, 1) + np.pi) % (2.0 * np.pi) - np.pi)
    sharp = turn >= 1.0 * DEG
    if sharp.sum() > 12:  # an outline of arcs: what turns less than 20 deg is a chord of one
        sharp = turn >= 20.0 * DEG
    for side in (hole.argmin(axis=0), hole.argmax(axis=0)):
        sharp[side] = True
    return hole[sharp].copy()


def _dimension_cut(drawing: Drawing, hole: Floats, view: View, width: float) -> None:
    inside = _cut_corners(hole)
    inside[:, 0] = np.minimum(inside[:, 0], view.right)
    left, right = inside[:, 0].min(), inside[:, 0].max()
    at_left = inside[:, 0] <= left + 1e-9
    for side, x, sign in ((at_left, left, -1.0), (~at_left, right, 1.0)):
        heights = {round(float(y), 9) for y in inside[side, 1] if 1e-9 < y < width - 1e-9}
        if sign > 0.0:
            heights -= {round(float(y), 9) for y in inside[~side, 1]}
        levels = [[c for c in inside if abs(c[1] - y) < 1e-8] for y in sorted(heights)]
        corners = [max(level, key=lambda c: sign * c[0]) for level in levels]
        number_x = float(view.placed([x, 0.0])[0]) + sign * 9.0
        ends = spread([float(view.placed(c)[1]) for c in corners], TEXT_GAP)
        for corner, end in zip(corners, ends):
            origin = view.placed([corner[0], 0.0])
            drawing.ordinate(view.placed(corner), (number_x, end), origin, True, view.scale)
    stops = np.unique(np.round(inside[:, 0], 9))
    above = float(view.placed([0.0, width])[1]) + 4.0
    for start, stop in itertools.pairwise(stops):
        # the width of the cut there, where its borders are parallel to the wall
        middle, sides = 0.5 * (start + stop), zip(hole, np.roll(hole, -1, axis=0))
        crossing = [(a[1], b[1]) for a, b in sides if min(a[0], b[0]) < middle < max(a[0], b[0])]
        if len(crossing) == 2 and all(abs(a - b) <= 1e-9 for a, b in crossing):
            low, high = sorted(float(np.clip(a, 0.0, width)) for a, _ in crossing)
            if (high - low) / MM * view.scale > 5.0:
                low_end, high_end = view.placed([[middle, low], [middle, high]])
                drawing.length(low_end, high_end, (0.001, 0.0), view.scale)
        ends = view.placed([[start, width], [stop, width]])
        number = f"{(stop - start) / MM:.2f}".rstrip("0").rstrip(".")
        room = min(8.0, LETTER_ROOM_MM * (len(number) + 1))
        row = 3.8 if ends[1][0] - ends[0][0] < room else 0.0  # no room for its number between others
        drawing.length(ends[0], ends[1], (0.0, above + row - ends[0][1]), view.scale)


def draw_wall_bores(
    drawing: Drawing, devices: Sequence[PlacedDevice], view: View, low: float, *, listed: bool = True
) -> float:
    """Draw holes of nozzles in the wall, seen from the bowl's axis.

    Parameters
    ----------
    drawing : Drawing
    devices : sequence of PlacedDevice
    view : View
    low : float [mm]
        Height of the track on the sheet.
    listed : bool, optional
        Write what each hole is above them: ``bore_texts``.

    Returns
    -------
    float [mm]
        Height of the top.
    """
    bores, texts = _bores(devices), bore_texts(devices) if listed else []
    if not bores:
        return low - 10.0
    along = View((view.at[0], low), view.scale)
    top = low + max(z + r for _, z, r, _ in bores) / MM * view.scale + 5.0
    places = sorted({s for s, *_ in bores})
    columns = {s: sorted({(z, r) for place, z, r, _ in bores if place == s}) for s in places}
    middles = {s: float(along.placed([s, 0.0])[0]) for s in columns}
    title = top + 1.0 + 4.0 * len(texts)  # above a line of text for each column
    drawing.lines([[(min(middles.values()) - 25.0, low), (max(middles.values()) + 9.0, low)]], "OUTLINE")
    for s, column in columns.items():
        drawing.lines([[(middles[s], low - 2.0), (middles[s], top)]], "CENTRE")
        for z, r in column:
            drawing.circle(along.placed([s, z]), r / MM * view.scale, "BORE")
        following = next((other for other in columns if other > s), s)
        if following == s or column != columns[following]:  # the last of those alike has the heights
            ends = spread([low + z / MM * view.scale for z, _ in column], TEXT_GAP)
            for (z, _), end in zip(column, ends):
                at, number, origin = along.placed([s, z]), (middles[s] + 14.0, end), (middles[s], low)
                drawing.ordinate(at, number, origin, True, view.scale)
    for row, text in enumerate(texts, start=1):
        drawing.text(view.at[0], title - 4.0 * row, text, 2.5)
    drawing.text(view.at[0], title, "wall seen from the bowl's axis", 2.5, bold=True)
    return title + 4.0


def bore_height(devices: Sequence[PlacedDevice]) -> float:
    """Return how high over the track the highest hole in the wall reaches.

    Parameters
    ----------
    devices : sequence of PlacedDevice

    Returns
    -------
    float [m]
        0 without any.
    """
    return max((z + r for _, z, r, _ in _bores(devices)), default=0.0)


def bore_texts(devices: Sequence[PlacedDevice]) -> list[str]:
    """Return what the holes in the wall are for, how large, and where: one text for those above each other.

    Parameters
    ----------
    devices : sequence of PlacedDevice

    Returns
    -------
    list of str
    """
    bores, texts = _bores(devices), []
    for s in sorted({s for s, *_ in bores}):
        column = [(r, bore) for place, _, r, bore in bores if place == s]
        radius, bore = column[0]
        thread = f"{bore.thread}, " if bore.thread else ""
        hole = f"{bore.what}: {len(column)} x {thread}Ø{2.0 * radius / MM:.4g} through the wall"
        if bore.angle != SQUARE_RAD:
            hole += f", {np.degrees(bore.angle):.3g} deg to its face towards the outlet,"
        texts.append(f"{hole} at {s / MM:.5g} from D, heights over the track")
    return texts


def _bores(devices: Sequence[PlacedDevice]) -> list[tuple[float, float, float, Bore]]:
    """The holes in the wall: s along it, height and radius [m] of each, and what it is."""
    return [
        (placed.begin + bore.place, bore.height, 0.5 * bore.diameter, bore)
        for placed in devices
        for bore in placed.features.bores
    ]


def device_rows(
    devices: Sequence[PlacedDevice], width: float, angle: Callable[[float], float]
) -> list[list[str]]:
    """Return the list of devices.

    Parameters
    ----------
    devices : sequence of PlacedDevice
    width : float [m]
        Of the track.
    angle : callable
        From a length [m] from D to an angle [deg].

    Returns
    -------
    list of list of str
        The head first.
    """
    rows = [["no.", "device", "from [mm]", "to [mm]", "from [°]", "to [°]", "value; what is bought and set"]]
    for number, placed in enumerate(devices, start=1):
        device, (start, end) = placed.device, placed.span
        words = device.value_words
        if lead := getattr(device, "lead", ()):
            wide, narrow = ((far - near) / MM for near, far in (lead[:2], device.span))
            long, taper = (size / MM for size in lead[2:])
            words += f": {wide:.5g} mm wide for {long:.5g} mm, then over {taper:.5g} mm to {narrow:.5g} mm"
        listed = [
            f"{words}{': quasi-static, until a trial confirms it' * device.action.turns}",
            *device.shop_words,
        ]
        if placed.features.sensor is not None:
            listed[1] += f", at the cross; window {placed.features.length / MM:.4g} x {width / MM:.4g} mm"
        listed += placed.shop_work(width)
        lines = [line for words in listed for line in textwrap.wrap(words, LINE_LETTERS) or [""]]
        opened = any(opening.hangs and not opening.runs_on for opening in placed.openings)
        far = ["outlet", "outlet"] if opened else [f"{end / MM:.5g}", f"{angle(end):.4g}"]
        near = [str(number), device.full_name[:36], f"{start / MM:.5g}"]
        rows.append([*near, far[0], f"{angle(start):.4g}", far[1], lines[0]])
        rows += [["", "", "", "", "", "", line] for line in lines[1:]]
    return rows


def shop_table(strip: TooledTrack) -> Frame:
    """Return what the shop must do to each cut beside cutting its outline, as a table for pages.

    Parameters
    ----------
    strip : TooledTrack

    Returns
    -------
    Frame
        No rows where there is nothing to say.
    """
    rows = [
        {"device": f"{number} {placed.device.full_name}", "what the shop does": str(work)}
        for number, placed in enumerate(strip.devices, start=1)
        for work in placed.shop_work(strip.width)
    ]
    return Frame.of_rows(rows, ("device", "what the shop does"))


def shop_comments(strip: TooledTrack, devices: Sequence[Device]) -> list[str]:
    """Return what the shop must do to the cuts of each device, for its line of a bowl file.

    Parameters
    ----------
    strip : TooledTrack
    devices : sequence of Device
        Those that were laid out, among others without a place.

    Returns
    -------
    list of str
        One for each device; '' where there is nothing to say.
    """
    works = {id(placed.device): placed.shop_work(strip.width) for placed in strip.devices}
    return ["; ".join(works.get(id(device), ())) for device in devices]


def shop_names(strip: TooledTrack) -> str:
    """Return the same in few words, for the names of bodies: '1 rails: open at the outlet'.

    Parameters
    ----------
    strip : TooledTrack

    Returns
    -------
    str
        '' where there is nothing to say.
    """
    devices = enumerate(strip.devices, start=1)
    works = [(f"{number} {placed.device.kind}", placed.shop_work(strip.width)) for number, placed in devices]
    return "; ".join(f"{name}: {', '.join(work.short for work in own)}" for name, own in works if own)


def edges(placed: PlacedDevice, width: float) -> list[tuple[str, Floats]]:
    """Return lines and fields (4, 2) [m] that show what of a device is neither cut nor blade, by layer.

    Parameters
    ----------
    placed : PlacedDevice
    width : float [m]
        Of the track.

    Returns
    -------
    list of (str, array)
        Edges of steps and ledges, places where the track leans otherwise, beams of air, fields of sensors.
    """
    features, begin = placed.features, placed.begin
    drawn = [
        ("SLOPE", box_ring(begin + slope.begin, begin + slope.begin + DRAWN_LINE_M, 0.0, width))
        for slope in features.slopes
    ]
    if features.drop is not None:
        drop = features.drop
        ring = box_ring(begin, begin + DRAWN_LINE_M, 0.0, width)
        if drop.aside > 0.0:
            ring = box_ring(begin, begin + drop.length, drop.aside, drop.aside + DRAWN_LINE_M)
        drawn.append(("LEDGE" if drop.aside > 0.0 else "STEP", ring))
    if features.sensor is not None:
        return [*drawn, ("SENSOR", box_ring(placed.start, placed.end, 0.0, width))]
    for jet in features.jets:
        drawn.append(("NOZZLE", jet.outline(width) + [begin, 0.0]))
    return drawn


def _outline_in_bowl(outline: Floats, place: float, radius: float) -> Floats:
    """An outline (K, 2) [m] from the wall as it lies in the bowl at a length along it."""
    c, s = np.cos(place / radius), np.sin(place / radius)
    x, up = outline[:, 0], radius - outline[:, 1]
    return np.column_stack([c * x + s * up, radius + s * x - c * up])


def _plan(strip: TooledTrack) -> dict[str, list[Floats]]:
    length, width = strip.length, strip.width
    layers = {
        name: [np.array([[0.0, low], [length, low], [length, high], [0.0, high]])]
        for name, low, high in (("TRACK", 0.0, width), ("WALL", -DRAWN_WALL_M, -1e-9))
    }
    for placed in strip.devices:
        for layer, ring in edges(placed, width):
            layers.setdefault(layer, []).append(ring)
    layers |= {_numbered("CUT", k): [opening.ring] for k, (_, opening) in enumerate(strip.openings)}
    blades = [ring for placed in strip.devices for ring in placed.footprints]
    return layers | ({"GATE": blades} if blades else {})


def _openings(drawing: Drawing, strip: TooledTrack) -> float:
    """Draw the openings of gates to the right of the track, each on its own layer; return their right end."""
    right, count = strip.length / MM + VIEW_GAP_MM + 15.0, 0
    for placed in strip.devices:
        openings = [ring for blade in placed.features.blades for ring in blade.opening()]
        if not openings:
            continue
        name, widest = _numbered("OPENING", count), right
        for ring in openings:
            corners = ring / MM + [right, 0.0]
            drawing.outline(corners, name)
            widest = max(widest, float(corners[:, 0].max()))
        inner = np.vstack(openings) / MM
        heights = [float(z) for z in np.unique(np.round(inner[:, 1], 6)) if z > 1e-6][:8]
        for z, end in zip(heights, spread(heights, TEXT_GAP)):
            drawing.ordinate((right, z), (right - 9.0, end), (right, 0.0), True)
        places = [float(y) for y in np.unique(np.round(inner[:, 0], 6)) if y > 1e-6][:8]
        for y, end in zip(places, spread([right + y for y in places], TEXT_GAP)):
            drawing.ordinate((right + y, 0.0), (end, -NUMBERS), (right, 0.0), False)
        drawing.text(right, -NUMBERS - 6.0, f"opening of the {placed.device.kind}", 2.5)
        right, count = widest + VIEW_GAP_MM + 15.0, count + 1
    return right - VIEW_GAP_MM


def _numbered(name: str, place: int) -> str:
    return f"{name}_{place + 1}" if place else name
