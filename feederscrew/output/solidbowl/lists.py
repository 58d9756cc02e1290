"""The lists of a drawing sheet: cuts with tolerances, parts, and the title block of the quotation."""

import numpy as np

from feederscrew.output.machine import sheet as sheets
from feederscrew.output.solidbowl.unrolled_strip import numbered
from feederscrew.output.tooling.drawing import EDGES
from feederscrew.solidbowl import segments
from feederscrew.units import MM, PER_MINUTE, factor

LITRE = factor("l", "volume")
CUT = "±0.1"  # [mm] of an edge that parts meet
GENERAL = "ISO 2768-m"
MOST = 12  # rows of a list
LONG = 46  # letters of a line in the title block
NARROW = 38  # letters of its left column


def cuts(paper, study, at):
    """Draw the table of cuts and blades at its upper left corner [mm]."""
    stretch, plan = study.solid.plan.stretch, study.solid.plan
    rows = [["no.", "device", "from [mm]", "to [mm]", "tolerance [mm]"]]
    for _, words, start, end in numbered(stretch):
        far = f"{end / MM:.5g}" if np.isfinite(end) else "outlet, open"
        rows.append([str(len(rows)), words, f"{start / MM:.5g}", far, CUT])
    left = len(rows) - MOST
    rows = rows if left <= 0 else [*rows[: MOST - 1], ["", f"and {left + 1} more in bowl.json", "", "", ""]]
    low = paper.table(*at, [9.0, 90.0, 32.0, 32.0, 32.0], rows)
    listed = [
        f"from and to: along the wall from the begin of the stretch; cuts {CUT}, everything else {GENERAL}",
        f"arcs are facets within {plan.chord / MM:.3g} mm; {EDGES}",
    ]
    for k, line in enumerate(listed):
        paper.text(at[0], low - 4.0 - 3.6 * k, line, size=2.2)


def parts(paper, study, at):
    """Draw the parts list at its upper left corner [mm]."""
    plan, under = study.solid.plan, study.bowl.machine
    leaf = " x ".join(
        f"{side / MM:.3g}" for side in (under.leaf_width, under.leaf_thickness, under.leaf_length)
    )
    rows = [["pos.", "quantity", "what"]]
    rows.append(["1", "1", f"bowl, {plan.material.name}, {study.solid.mass:.4g} kg"])
    weight, angle = study.solid.balance
    rows.append(
        ["2", "1", f"weight to balance it, {1e3 * weight:.3g} g on the wall at {np.degrees(angle):.0f}°"]
    )
    for name, _, _ in study.solid.gates:
        rows.append([str(len(rows)), "1", f"{name.replace('_', ' ')}, in its notch of the wall"])
    cut = study.solid.segments
    if cut is not None and cut.dowels:
        size = f"{cut.dowel / MM:.3g} x {cut.dowel_length / MM:.3g} mm"
        text = f"dowels {size}, between {len(cut.pieces)} segments"
        rows.append([str(len(rows)), str(cut.dowels), text])
    if cut is not None and len(cut.screws):
        screw = f"screws ISO 4762 {segments.SCREW_NAME} with nuts ISO 4032"
        text = f"{screw}, in lugs of the segments; floor: dowels"
        rows.append([str(len(rows)), str(len(cut.screws)), text])
    rows.append([str(len(rows)), str(plan.bolts + 1), f"bolts for holes of {plan.bolt / MM:.4g} mm"])
    rows.append([str(len(rows)), f"{under.leaves:.0f}", f"leaves {leaf} mm"])
    rows.append(
        [
            str(len(rows)),
            "1",
            f"coil, force amplitude {study.force:.3g} N, {sheets.supply(study.stroke.frequency)} Hz",
        ]
    )
    peak = study.stroke.peak_to_peak / MM
    share = 100.0 * study.bowl.sizing.controller
    rows.append([str(len(rows)), "1", f"controller, set to {share:.3g} %: {peak:.3g} mm peak to peak"])
    paper.table(*at, [10.0, 18.0, 136.0], rows)


def title(paper, study, found, scale, tried=None):
    """Draw the title block in the lower right corner; of a bowl that was tried as it was tried."""
    left, low, right, high = 246.0, 10.0, 410.0, 78.0
    paper.box(left, low, right, high, 1.2)
    solid, order = study.solid, study.order
    paper.text(left + 2.0, high - 6.0, f"Bowl for {_short(order.part.name)}", size=4.0, fontweight="bold")
    for k, line in enumerate(_not_made(study)):
        paper.text(left, high + 5.4 - 3.2 * k, line, size=1.85, color="#d55e00")
    pairs = _fields(study, solid, found, scale, tried)
    half = (len(pairs) + 1) // 2
    for k, (name, value) in enumerate(pairs):
        x, y = left + 2.0 + 82.0 * (k // half), high - 13.0 - 5.6 * (k % half)
        paper.text(x, y, name, size=1.9, color="#5b6b78")
        paper.text(x + 27.0, y, value, size=2.1)


def _not_made(study):
    """What of its drive the springs do not make, at most two lines."""
    said = sheets.two_axis(study.bowl.drive)
    if said:
        yield said
    if study.mismatch is not None:
        yield f"these springs make {study.mismatch.machine.text}"


def _short(words, letters=LONG):
    return words if len(words) <= letters else f"{words[: letters - 1]}…"


def _fields(study, solid, found, scale, tried):
    """Names and values of the title block."""
    plan, order = solid.plan, study.order
    centre = ", ".join(f"{x / MM:.1f}" for x in solid.centre)
    extent = " x ".join(f"{x / MM:.4g}" for x in found.extent)
    wanted = (
        "all that pass"
        if order.wanted is None
        else f"{order.wanted[0]} at {np.degrees(order.wanted[1]):.3g}°"
    )
    return [
        ("drawing of part", _short(order.part.source.rpartition("/")[2])),
        ("rate asked for", f"{order.target / PER_MINUTE:.4g} a minute"),
        ("orientation", wanted if tried is None else _short(tried.wanted, NARROW)),
        *([] if tried is None else [("rate of its trial", _short(sheets.rate_of_trial(tried), NARROW))]),
        ("part material", sheets.material(order.part)),
        ("fill, hopper", f"{study.fill.mass:.3g} kg, {order.hopper / LITRE:.3g} l"),
        ("drive", f"{study.stroke.frequency:.4g} Hz, {study.stroke.peak_to_peak / MM:.3g} mm"),
        ("vibration angle", sheets.angles(study, phase=False)),
        ("natural frequency", f"{study.springs.natural_frequency:.4g} Hz"),
        ("climb, bank", f"{np.degrees(plan.way.climb):.3g}°, {_banks(plan.way)}"),
        (
            "hand",
            f"{'left' if plan.left else 'right'}: parts climb {'' if plan.left else 'counter-'}clockwise",
        ),
        ("turns", f"{study.turns:.3g}"),
        ("material", f"{plan.material.name}, {plan.material.density:.4g} kg/m³"),
        ("mass, volume", f"{solid.mass:.4g} kg, {solid.with_lugs.volume / MM**3:.6g} mm³"),
        ("inertia about axis", f"{solid.inertia:.4g} kg m²"),
        ("centre of mass", f"{centre} mm"),
        ("size", f"{extent} mm"),
        ("general tolerance", f"{GENERAL}; cuts {CUT} mm"),
        ("scale, sheet", f"1 : {1.0 / scale:g}, A3, sizes in mm"),
        ("drawn by", "feeder bowl" if tried is None else "feeder design, feeder bowl"),
    ]


def _banks(way):
    """'0°', '0° to 12°': the banks of the track, one after the other."""
    return " to ".join(f"{np.degrees(bank):.3g}°" for bank in (way.bank, *(one[2] for one in way.leans)))
