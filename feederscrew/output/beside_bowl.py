"""What stands beside a bowl, in words and numbers: vision stations, and the inline track with its sensors."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from feederscrew.base.columns import Document
from feederscrew.base.units import MM, MM_S
from feederscrew.bowl.devices.pneumatics import SEEN_BY
from feederscrew.bowl.verified import Verified
from feederscrew.machine.after_outlet import InlineTrack, plan_inline_track
from feederscrew.machine.sheet import MachineSheet
from feederscrew.machine.vision_station import (
    STAND_OFF_M,
    STAND_THREAD,
    VisionStation,
    plan_vision_stations,
)
from feederscrew.output.outlet_poses import find_leaving
from feederscrew.output.tables import Frame

MS = 1e-3  # [s]


@dataclass(frozen=True, eq=False)
class Beside:
    """Everything beside a bowl; ``starts`` [m] are where the vision stations' devices begin, from D."""

    vision: tuple[VisionStation, ...]
    starts: tuple[float, ...]
    inline: InlineTrack


def find_beside(study: MachineSheet, trial: Verified | None = None) -> Beside | None:
    """Return what stands beside the bowl of a MachineSheet; None without an order of a part with a mesh."""
    found, order = find_leaving(study, trial), study.order
    if found is None or order is None or order.on_track is None:
        return None
    plan = None if study.solid is None else study.solid.plan
    speed = float(np.nan_to_num(study.answer.velocity))
    height = math.nan if plan is None else plan.outlet_height
    vision = plan_vision_stations(study.bowl, order.on_track.lying)
    starts = [0.0] * len(vision)
    if plan is not None and plan.stretch is not None:
        starts = [plan.stretch.devices[one.number - 1].begin for one in vision]
    inline = plan_inline_track(study.bowl, found[1], max(speed, 0.0), height)
    return Beside(vision, tuple(starts), inline)


def rows(beside: Beside) -> list[dict[str, str]]:
    """Return what is bought and set, 'where', 'what' and 'value', one a row: the bill of what is beside."""
    listed = []
    for station, start in zip(beside.vision, beside.starts):
        where = f"vision reject, device {station.number}"
        listed += [(where, what, value) for what, value in vision_rows(station, start)]
    listed += [("behind the outlet", what, value) for what, value in _inline_rows(beside.inline)]
    return [dict(zip(("where", "what", "value"), row)) for row in listed]


def table(beside: Beside) -> Frame:
    """Return the same as a table."""
    return Frame.of_rows(rows(beside), ("where", "what", "value"))


def _length(size: float) -> str:
    """A length [m] as text: to a tenth of a millimetre, short ones to a hundredth."""
    return f"{size / MM:.{1 if size >= 10.0 * MM else 2}f} mm"


def vision_rows(station: VisionStation, start: float) -> Iterator[tuple[str, str]]:
    """Yield what a vision station is built from, what and value.

    Parameters
    ----------
    station : VisionStation
    start : float [m]
        Where its device begins, from D.

    Yields
    ------
    (str, str)
    """
    along, across = (size / MM for size in station.field)
    yield "sensor", f"{SEEN_BY[station.sees][0]}, resolves {_length(station.resolution)}"
    yield "speed of parts there", f"{station.speed / MM_S:.3g} mm/s"
    if (lens := station.lens) is not None:
        camera = lens.camera
        yield "field", f"{along:.4g} x {across:.4g} mm, a fifth more than the window"
        yield (
            "camera",
            f"{camera.chip}, {camera.columns} x {camera.rows} pixels of {1e6 * camera.pixel:.3g} µm",
        )
        where = "over the track" if station.sees == "outline" else "from the wall"
        yield "lens", f"f = {lens.focal_length / MM:.3g} mm, {_length(lens.distance)} {where}"
        covers = f"a pixel covers {lens.pixel / MM:.2g} mm, magnification {lens.magnification:.3g}"
        seen = "taught on parts in the middle of the window, or a telecentric lens"
        yield "picture", f"{covers}; parallax at its edge {station.parallax / MM:.2g} mm: {seen}"
        yield "exposure", f"at most {station.exposure / MS:.2g} ms: nothing moves by half the resolution"
        stand = f"a stand of its own, not on the bowl; foot with 4 holes for {STAND_THREAD}"
        yield "camera bracket", stand
    for beam in station.beams:
        yield "fibre beam", f"across the track, {_length(beam)} over it"
    if station.beams:
        yield "wanted part", "breaks the lower beam and leaves the upper one free"
    if station.profiles:
        yield "laser line", f"{_length(STAND_OFF_M)} over the track, {station.profiles:.3g} profiles a second"
    yield "light", station.light
    trigger = f"light barrier, {_length(start + station.trigger_at)} from D along the wall"
    delay = "no delay" if station.trigger_delay == 0.0 else f"delay {station.trigger_delay / MS:.4g} ms"
    yield "trigger", f"{trigger}: the front of a part meets it, {delay}"
    way = (
        f"{_length(station.valve_way)} at {station.speed / MM_S:.3g} mm/s: {station.valve_delay / MS:.3g} ms"
    )
    setting = f"set {station.valve_setting / MS:.3g} ms, sensor and valve take the rest"
    yield "valve delay", f"{way}; {setting}; pulse {station.pulse / MS:.3g} ms"
    for hole in station.holes:
        thread = f"{hole.thread}, " if hole.thread else ""
        at = f"{_length(start + hole.place)} from D, {_length(hole.height)} over the track"
        yield "hole to drill in the wall", f"{hole.what}: {thread}Ø{hole.diameter / MM:.3g}, {at}"
    if station.lacks:
        yield "does not do", station.lacks


def _inline_rows(inline: InlineTrack) -> Iterator[tuple[str, str]]:
    passes = (
        "what hangs passes any" if math.isinf(inline.bridged) else f"part bridges {_length(inline.bridged)}"
    )
    yield "gap to the inline track", f"{_length(inline.gap)} at rest; {passes}"
    height = "" if math.isnan(inline.height) else f", {_length(inline.height)} over the floor's edge"
    yield "height of the inline track", f"{_length(inline.step)} below the outlet{height}"
    sides = "between its rails" if inline.hangs else "between its sides"
    yield "width of the inline track", f"{_length(inline.width)} {sides}"
    yield "cover", f"{_length(inline.cover)} over its surface"
    yield "length of the stub", _length(inline.length)
    yield "speed of the inline track", f"at least {inline.speed / MM_S:.3g} mm/s"
    covered = "" if math.isinf(inline.dwell) else f" covered {inline.dwell / MS:.3g} ms"
    yield "level sensor, full", f"{_length(inline.full_at)} behind the outlet,{covered}: the bowl stops"
    yield "level sensor, low", f"{_length(inline.low_at)} behind the outlet, free: the bowl starts"
    if inline.lacks:
        yield "does not do", inline.lacks


def document(beside: Beside | None) -> Document:
    """Return the same in numbers, for the JSON document; empty where nothing is known."""
    if beside is None:
        return {}
    return {
        "vision_stations": [
            _vision_document(station, start) for station, start in zip(beside.vision, beside.starts)
        ],
        "behind_the_outlet": _inline_document(beside.inline),
    }


def _vision_document(station: VisionStation, start: float) -> Document:
    lens = station.lens
    optics = None
    if lens is not None:
        optics = {
            "camera": lens.camera.chip,
            "pixels": [lens.camera.columns, lens.camera.rows],
            "pixel_um": 1e6 * lens.camera.pixel,
            "focal_length_mm": lens.focal_length / MM,
            "distance_mm": lens.distance / MM,
            "magnification": lens.magnification,
            "pixel_on_part_mm": lens.pixel / MM,
            "parallax_mm": station.parallax / MM,
            "exposure_ms": station.exposure / MS,
        }
    return {
        "device": station.number,
        "sees": station.sees,
        "field_mm": [size / MM for size in station.field],
        "resolution_mm": station.resolution / MM,
        "speed_mm_s": station.speed / MM_S,
        "optics": optics,
        "beams_mm": [beam / MM for beam in station.beams],
        "profiles_per_second": station.profiles or None,
        "light": station.light,
        "sensor_at_mm": (start + station.sensor_at) / MM,
        "trigger_at_mm": (start + station.trigger_at) / MM,
        "trigger_delay_ms": station.trigger_delay / MS,
        "valve_way_mm": station.valve_way / MM,
        "valve_delay_ms": station.valve_delay / MS,
        "valve_setting_ms": station.valve_setting / MS,
        "pulse_ms": station.pulse / MS,
        "bracket_holes": [
            {
                "what": hole.what,
                "thread": hole.thread or None,
                "at_mm": (start + hole.place) / MM,
                "height_mm": hole.height / MM,
                "diameter_mm": hole.diameter / MM,
            }
            for hole in station.holes
        ],
        "lacks": station.lacks or None,
    }


def _inline_document(inline: InlineTrack) -> Document:
    lengths = ("gap", "bridged", "step", "height", "width", "cover", "length", "full_at", "low_at")
    values = {f"{name}_mm": getattr(inline, name) / MM for name in lengths}
    finite = {name: value if math.isfinite(value) else None for name, value in values.items()}
    return {
        **finite,
        "between_rails": inline.hangs,
        "dwell_ms": inline.dwell / MS if math.isfinite(inline.dwell) else None,
        "speed_mm_s": inline.speed / MM_S,
        "lacks": inline.lacks or None,
    }
