"""The sheet of what stands beside a bowl: the inline track behind its outlet, and a vision station."""

import math
import textwrap

from feederscrew.base.units import MM
from feederscrew.bowl.devices.pneumatics import SEEN_BY
from feederscrew.machine.after_outlet import InlineTrack
from feederscrew.machine.vision_station import STAND_OFF_M, VisionStation
from feederscrew.output.beside_bowl import Beside, rows, vision_rows
from feederscrew.output.drafting import Drawing, scale_words

SCALES = (2.0, 1.0, 0.5, 0.4, 0.2, 0.1, 0.05)  # ISO 5455, with 1:2.5
ROW_MM = 4.6
LETTERS = 110
WIDTHS_MM = (12.0, 52.0, 172.0)
SHORT_MM = 9.0  # [mm] of paper: a number does not fit between the arrows of less
CAMERA_MM = 70.0  # [mm] of paper from the track to a camera


def draw_beside(drawing: Drawing, beside: Beside, outlet: tuple[float, float], material_mm: float) -> None:
    """Draw the sheet of what stands beside a bowl: the inline track, the first station, the list of all.

    Parameters
    ----------
    drawing : Drawing
        On a new sheet, with its title.
    beside : Beside
    outlet : (float, float) [m]
        Length and width of the bowl's outlet.
    material_mm : float [mm]
        Thickness of the track.
    """
    low = _draw_inline(drawing, beside.inline, outlet, material_mm)
    for station, start in zip(beside.vision[:1], beside.starts):
        _draw_vision(drawing, station, start)
    listed = [["pos.", "what", "value"]]
    where = ""
    for number, row in enumerate(rows(beside), start=1):
        if row["where"] != where:
            where = row["where"]
            listed.append(["", where, ""])
        lines = textwrap.wrap(row["value"], LETTERS) or [""]
        listed.append([str(number), row["what"], lines[0]])
        listed += [["", "", line] for line in lines[1:]]
    line = min(ROW_MM, (low - 26.0) / len(listed))
    drawing.table(25.0, low, WIDTHS_MM, listed, size=min(2.2, 0.52 * line), line=line)


def draw_station(drawing: Drawing, beside: Beside, number: int) -> None:
    """Draw the sheet of another vision station.

    Parameters
    ----------
    drawing : Drawing
        On a new sheet, with its title.
    beside : Beside
    number : int
        Of the station, from 1 on: the first is on the sheet of ``draw_beside``.
    """
    _draw_vision(drawing, beside.vision[number], beside.starts[number], left=60.0)
    listed = [["", "what", "value"]]
    for what, value in vision_rows(beside.vision[number], beside.starts[number]):
        lines = textwrap.wrap(value, LETTERS) or [""]
        listed += [["", what, lines[0]], *(["", "", line] for line in lines[1:])]
    drawing.table(25.0, 125.0, WIDTHS_MM, listed, size=2.2, line=ROW_MM)


def _draw_inline(drawing: Drawing, inline: InlineTrack, outlet: tuple[float, float], thick: float) -> float:
    """The outlet and the stub, from above and from the side; return the height [mm] below them."""
    long, wide = outlet[0] / MM, outlet[1] / MM
    reach, width = inline.length / MM, inline.width / MM
    fits = (s for s in SCALES if (long + reach) * s <= 215.0 and max(wide, width + 10.0) * s <= 26.0)
    scale = next(fits, SCALES[-1])
    x, y = 40.0 + long * scale, 236.0
    start, end, first = x + inline.gap / MM * scale, x + reach * scale, x - long * scale
    drawing.text(25.0, 271.0, f"behind the outlet, from above  {scale_words(scale)}", 3.0, bold=True)
    middle, half = y + 0.5 * wide * scale, 0.5 * width * scale
    drawing.outline(_corners(first, y, x, y + wide * scale), "TRACK")
    rail = 5.0 * scale + 1.0  # of a slot: its rails
    sides = [(middle - half, middle + half)]
    if inline.hangs:
        sides = [(middle - half - rail, middle - half), (middle + half, middle + half + rail)]
    for low, high in sides:
        drawing.outline(_corners(start, low, end, high), "TRACK")
    top = max(y + wide * scale, sides[-1][1])
    drawing.text(first, top + 2.0, "outlet of the bowl", 2.2)
    drawing.text(max(start, first + 32.0), top + 2.0, "inline track, stub", 2.2)
    _dimension_across(drawing, (end, middle - half), (end, middle + half), scale)
    below = min(y, sides[0][0])
    for name, at in (("low", inline.low_at), ("full", inline.full_at)):
        place = x + at / MM * scale
        drawing.lines([[(place, sides[0][0] - 3.0), (place, sides[-1][1] + 3.0)]], "SENSOR")
        drawing.text(place, below - 6.0, f"level {name}", 2.2, "center", layer="NOTE")
    drawing.text(25.0, below - 13.0, f"from the side  {scale_words(scale)}", 3.0, bold=True)
    side, drop = below - 18.0 - inline.cover / MM * scale, max(inline.step / MM * scale, 0.6)
    for left, right, upper in ((first, x, side), (start, end, side - drop)):
        drawing.outline(_corners(left, upper - thick * scale, right, upper), "SECTION")
    cover, foot = side - drop + inline.cover / MM * scale, side - drop - thick * scale
    drawing.lines([[(start, cover), (end, cover)]], "OUTLINE")
    _dimension_across(drawing, (end, side - drop), (end, cover), scale)
    for k, at in enumerate((inline.low_at, inline.full_at, inline.length)):
        place = x + at / MM * scale
        drawing.length((x, foot), (place, foot), (0.0, -6.0 - 5.0 * k), scale, decimals=1)
    words = f"gap {inline.gap / MM:.2f} at rest, inline track {inline.step / MM:.2f} lower"
    if not math.isnan(inline.height):
        words += f", {inline.height / MM:.1f} over the floor's edge"
    drawing.text(25.0, foot - 22.0, words, 2.2)
    return foot - 27.0


def _dimension_across(
    drawing: Drawing, low: tuple[float, float], high: tuple[float, float], scale: float
) -> None:
    """Dimension an upright length to the right of two places; a short one has its number beside its line."""
    long = high[1] - low[1]
    if long > SHORT_MM:
        drawing.length(low, high, (8.0, 0.0), scale)
        return
    right, (x, bottom), top = low[0] + 6.0, low, high[1]
    drawing.lines([[(x + 0.6, y), (right + 1.0, y)] for y in (bottom, top)], "DIMENSION")
    drawing.lines([[(right, bottom), (right, top)]], "DIMENSION")
    number = f"{long / scale:.2f}".rstrip("0").rstrip(".")
    drawing.text(right + 2.0, 0.5 * (bottom + top) - 1.2, number)


def _corners(left: float, low: float, right: float, high: float) -> list[tuple[float, float]]:
    return [(left, low), (right, low), (right, high), (left, high)]


def _draw_vision(drawing: Drawing, station: VisionStation, start: float, left: float = 318.0) -> None:
    """A vision station from the wall: camera, field, trigger and nozzles; the camera nearer than it is."""
    foot, room = 160.0, 84.0
    along = station.field[0] / MM
    middle, nozzles = station.sensor_at / MM, (station.sensor_at + station.valve_way) / MM
    last = max(nozzles + 14.0, station.trigger_at / MM, middle + 0.5 * along)
    first = min(0.0, middle - 0.5 * along, station.trigger_at / MM - 5.0)
    scale = next((s for s in SCALES if (last - first) * s <= room), SCALES[-1])
    origin = left - first * scale

    def at(place: float, height: float = 0.0) -> tuple[float, float]:
        return origin + place * scale, foot + height * scale

    sensor, track = SEEN_BY[station.sees][0], f"{scale_words(scale)} along the track"
    drawing.text(left - 8.0, 271.0, f"device {station.number}: {sensor}", 3.0, bold=True)
    drawing.text(left - 8.0, 267.0, f"{track}; the sensor stands farther off than it is drawn", 2.0)
    drawing.lines([[at(first), at(last)]], "OUTLINE")
    if station.sees in ("outline", "relief"):
        distance = STAND_OFF_M if station.lens is None else station.lens.distance
        head_x, head_y = at(middle)[0], foot + CAMERA_MM
        drawing.lines([[at(middle - 0.5 * along), (head_x, head_y), at(middle + 0.5 * along)]], "SENSOR")
        drawing.box(head_x - 5.0, head_y, head_x + 5.0, head_y + 9.0, "SENSOR")
        base, top = at(first), (at(first)[0], head_y)
        drawing.length(base, top, (-5.0, 0.0), text=f"{distance / MM:.0f}")
        low, high = at(middle - 0.5 * along), at(middle + 0.5 * along)
        drawing.length(low, high, (0.0, -5.0), scale, decimals=1)
    elif station.sees == "side":
        (x0, y0), (x1, y1) = at(middle - 0.5 * along), at(middle + 0.5 * along, station.field[1] / MM)
        drawing.box(x0, y0, x1, y1, "SENSOR")
    for beam in station.beams:
        drawing.circle(at(middle, beam / MM), 1.0, "SENSOR")
    places = sorted([(middle, "picture"), (nozzles, "nozzles"), (station.trigger_at / MM, "trigger")])
    for row, (place, words) in enumerate(places):
        x, y = at(place)
        drawing.lines([[(x, y + 3.0), (x, y - 12.0 - 4.0 * row)]], "NOTE")
        drawing.text(x + 1.0, y - 12.0 - 4.0 * row, f"{words} {start / MM + place:.1f} from D", 2.2)
    for hole in station.holes:
        x, y = at(hole.place / MM, hole.height / MM)
        drawing.circle((x, y), 0.5 * hole.diameter / MM * scale, "BORE")
        drawing.text(x, y + 0.5 * hole.diameter / MM * scale + 0.8, hole.thread or "fibre", 1.9, "center")
