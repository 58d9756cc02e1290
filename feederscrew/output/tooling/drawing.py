"""The stretch of track with its cuts 1:1 in millimetres: layers for a DXF file, and the same as SVG."""

import html

import numpy as np

from feederscrew import dxf as files
from feederscrew.dxf import Layer
from feederscrew.output import marking
from feederscrew.tooling.orientations import CUT_BORDER_RADIUS_M
from feederscrew.units import MM

APART = 20e-3  # [m] between the views
NARROW = 1e-9  # [m] the line of the wall needs no width
COLOURS = {
    "TRACK": 7,
    "WALL": 8,
    "CUT": 1,
    "GATE": 5,
    "OPENING": 4,
    "GHOST": 9,
    "TEXT": 8,
    "SENSOR": 3,
    "STEP": 6,
    "LEDGE": 6,
    "NOZZLE": 3,
    "SLOPE": 6,
    "MARK": 1,
}
PENS = {  # of the SVG: stroke, fill, dashes
    "TRACK": ("#22303c", "#eef1f4", ""),
    "WALL": ("#22303c", "#9aa5b1", ""),
    "CUT": ("#d55e00", "#ffffff", ""),
    "GATE": ("#0072b2", "#0072b2", ""),
    "OPENING": ("#0072b2", "#ffffff", ""),
    "SENSOR": ("#009e73", "none", "2 1"),
    "NOZZLE": ("#009e73", "none", "1 1"),
    "SLOPE": ("#cc79a7", "#cc79a7", "2 1"),
    "STEP": ("#cc79a7", "#cc79a7", ""),
    "LEDGE": ("#cc79a7", "#cc79a7", ""),
    "GHOST": ("#7a8793", "none", "1.5 1"),
}
WALL = 2e-3  # [m] thickness the wall is drawn with
EDGES = f"edges broken at most {CUT_BORDER_RADIUS_M / MM:.3g} mm"  # as they are tried
SHOP = f"values +-0.1 mm; {EDGES}; lands 1 mm and the sheet's thickness at least"


def dxf(strip, ghosts=(), mark=""):
    """Return the drawing of a strip as the bytes of a DXF file.

    Parameters
    ----------
    strip : TrackSection
    ghosts : sequence of ((K, 2) float [m], float [m])
        Outlines of parts from the wall, each with its place along it; they are not cut.
    mark : str
        Written across the drawing, on the layer ``MARK``, and among its notes.

    Returns
    -------
    bytes
    """
    return files.written(layers(strip, ghosts, mark))


def layers(strip, ghosts=(), mark=""):
    """Return the layers of a strip: unrolled, below it as bent, to the right the openings of gates.

    Parameters
    ----------
    strip : TrackSection
    ghosts : sequence of ((K, 2) float [m], float [m])
        Outlines of parts from the wall, each with its place along it.
    mark : str
        As for ``dxf``.

    Returns
    -------
    list of Layer
        ``TRACK``, ``WALL``, ``GATE``, ``GHOST`` unrolled, the wall along the X axis and parts moving towards
        +X; ``CUT``, ``CUT_2`` ... one hole each; the same with ``BENT_`` before it as it lies in the bowl;
        ``OPENING``, ``OPENING_2`` ... one gate each, seen along the track.
    """
    found = []
    for name, rings in _plan(strip).items():
        bent = tuple(strip.bent(ring) for ring in rings)
        found += _both(strip, name, tuple(rings), bent)
    plain = tuple(np.add(ring, [place, 0.0]) for ring, place in ghosts)
    found += _both(strip, "GHOST", plain, tuple(strip.laid(*ghost) for ghost in ghosts))
    found += [Layer(name, COLOURS["OPENING"], rings=rings) for name, rings in _openings(strip)]
    found.append(Layer("TEXT", COLOURS["TEXT"], texts=_texts(strip, mark)))
    if not mark:
        return found
    low, high = _corners(found)
    height, turn = marking.diagonal(high - low, mark)
    return [*found, Layer("MARK", COLOURS["MARK"], across=(mark, tuple(0.5 * (low + high)), height, turn))]


def _corners(drawn):
    """The lower left and the upper right corner [m] of all outlines."""
    corners = np.vstack([ring for one in drawn for ring in one.rings])
    return corners.min(axis=0), corners.max(axis=0)


def svg(strip, ghosts=(), mark=""):
    """Return the drawing of a strip as an SVG file of its true size.

    Parameters
    ----------
    strip : TrackSection
    ghosts : sequence of ((K, 2) float [m], float [m])
    mark : str
        Written across the drawing.

    Returns
    -------
    str
    """
    drawn = [one for one in layers(strip, ghosts) if one.name != "TEXT"]
    texts = _texts(strip, mark)
    low, high = (corner / MM for corner in _corners(drawn))
    low, high = low - 5.0, high + 5.0
    size = high - low + [20.0, 0.0]
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]:.2f}mm" height="{size[1]:.2f}mm" '
        f'viewBox="{low[0]:.2f} {-high[1]:.2f} {size[0]:.2f} {size[1]:.2f}">',
        f'<rect x="{low[0]:.2f}" y="{-high[1]:.2f}" width="100%" height="100%" fill="#ffffff"/>',
    ]
    for one in sorted(drawn, key=lambda one: list(PENS).index(_kind(one.name))):
        lines += [_path(ring, one.name) for ring in one.rings]
    lines += [
        f'<text x="{x / MM:.2f}" y="{-y / MM:.2f}" font-family="sans-serif" font-size="3" '
        f'fill="#22303c">{html.escape(text)}</text>'
        for text, (x, y) in texts
    ]
    if mark:
        height, turn = marking.diagonal(size, mark)
        x, y = low[0] + 0.5 * size[0], -high[1] + 0.5 * size[1]
        lines.append(
            f'<text class="MARK" x="{x:.2f}" y="{y:.2f}" font-family="sans-serif" font-weight="bold" '
            f'font-size="{height:.2f}" fill="{marking.COLOUR}" fill-opacity="{marking.STRENGTH}" '
            f'text-anchor="middle" dominant-baseline="middle" '
            f'transform="rotate({-np.degrees(turn):.2f} {x:.2f} {y:.2f})">{html.escape(mark)}</text>'
        )
    return "\n".join([*lines, "</svg>"]) + "\n"


def _both(strip, name, plain, bent):
    """A layer unrolled and as bent, the latter below."""
    colour, down = COLOURS[name.partition("_")[0]], [0.0, _drop(strip)]
    return Layer(name, colour, rings=plain), Layer(
        f"BENT_{name}", colour, rings=tuple(b - down for b in bent)
    )


def _plan(strip):
    """Rings of each layer, unrolled."""
    length, width = strip.length, strip.width
    found = {
        "TRACK": [_rectangle(0.0, 0.0, length, width)],
        "WALL": [_rectangle(0.0, -WALL, length, -NARROW)],
    }
    for station in strip.stations:
        if station.edge is not None:
            found.setdefault(station.device.layer, []).append(station.edge)
    cuts = [one.hole for one in strip.stations if one.hole is not None and one.edge is None]
    found |= {_numbered("CUT", place): [ring] for place, ring in enumerate(cuts)}
    blades = [station.blade for station in strip.stations if station.blade is not None]
    return found | {"GATE": blades}


def _openings(strip):
    """Openings of gates one after the other to the right of the track, each on its own layer."""
    right = strip.length + APART
    found: list[tuple[str, tuple[np.ndarray, ...]]] = []
    for station in strip.stations:
        if station.openings:
            shown = tuple(np.add(ring, [right, 0.0]) for ring in station.openings)
            found.append((_numbered("OPENING", len(found)), shown))
            right = max(ring[:, 0].max() for ring in shown) + APART
    return found


def _texts(strip, mark=""):
    above = strip.width + 3e-3
    named = [(_label(station), (station.start, above)) for station in strip.stations]
    gates = [station for station in strip.stations if station.openings]
    seen = [
        (f"opening of the {station.device.name}", (rings[0][:, 0].min(), -6e-3))
        for station, (_, rings) in zip(gates, _openings(strip))
    ]
    notes = [
        ("unrolled: wall below, parts move to the right", (0.0, -WALL - 4.5e-3)),
        (
            f"as bent: radius of the wall {strip.track.radius / MM:.6g} mm",
            (0.0, -_drop(strip) - WALL - 4.5e-3),
        ),
        (SHOP, (0.0, -WALL - 9e-3)),
        *([(mark, (0.0, -WALL - 13.5e-3))] if mark else []),
    ]
    return tuple(named + seen + notes)


def _label(station):
    return (
        f"{station.label}: quasi-static, until a trial confirms it" if station.device.turns else station.label
    )


def _drop(strip):
    """How far below the unrolled view the bent one lies [m]."""
    end = strip.bent(_rectangle(0.0, -WALL, strip.length, strip.width))
    return float(end[:, 1].max()) + APART


def _numbered(name, place):
    return f"{name}_{place + 1}" if place else name


def _kind(layer):
    return layer.removeprefix("BENT_").partition("_")[0]


def _path(ring, layer):
    stroke, fill, dashes = PENS[_kind(layer)]
    corners = " L ".join(f"{x / MM:.4f} {-y / MM:.4f}" for x, y in ring)
    dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
    look = f'fill="{fill}" stroke="{stroke}" stroke-width="0.25"{dashed}'
    return f'<path class="{layer}" d="M {corners} Z" {look}/>'


def _rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
