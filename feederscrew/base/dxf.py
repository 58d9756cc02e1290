"""DXF files, the one door to ezdxf: closed outlines read from a layer, and drawings written."""

import contextlib
import io
import itertools
import logging
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.base import documents, units
from feederscrew.base.errors import DAMAGE, ConfigError

if TYPE_CHECKING:
    from ezdxf.document import Drawing

MILLIMETRES = {  # by $INSUNITS: DXF Reference of Autodesk, "HEADER Section"; 0 states none
    0: 1.0,
    1: 25.4,
    2: 304.8,
    3: 1609344.0,
    4: 1.0,
    5: 10.0,
    6: 1000.0,
    7: 1e6,
    8: 25.4e-6,
    9: 25.4e-3,
    10: 914.4,
    11: 1e-7,
    12: 1e-6,
    13: 1e-3,
    14: 100.0,
    15: 1e4,
    16: 1e5,
    21: 1200e3 / 3937.0,
    22: 100e3 / 3937.0,
    23: 3600e3 / 3937.0,
}
# of $INSUNITS
NO_UNIT_CODE = 0
MILLIMETRE_CODE = 4
MAX_DXF_COORDINATE_M = 1e3  # [m] from the origin of a drawing to a corner of a hole
CHORD_ERROR_M = 1e-6  # at most between a curve and the chord read for it; the corners lie on the curve
MAX_CHORD_ANGLE = math.radians(15.0)  # of an arc to one chord
JOIN_M = 1e-6  # ends of lines and arcs so near are one corner
WIDE_JOIN_M = 20e-6  # ends so near are joined, which is said: shops cut within 0.05 mm
MAX_ENDS_AT_A_CORNER = 100  # that are looked at for lines drawn twice
MAX_OUTLINES = 50  # that are looked at for one drawn twice
FLAT_M = 1e-6  # by which the heights of an outline may differ
REPEATED_M = 1e-9  # a corner so near to the last one is none
STRAIGHT_M = 1e-12  # a corner so near to the line through its neighbours is none
MAX_DXF_BYTES = 10_000_000
MAX_ENTITIES = 10_000  # on the layer, those of blocks included
MAX_CORNERS = 1000  # of one outline, after its curves are read as chords
MAX_BLOCK_DEPTH = 8  # blocks within blocks
ANNOTATIONS = frozenset(
    ("TEXT", "MTEXT", "DIMENSION", "LEADER", "MULTILEADER", "POINT", "ATTDEF", "VIEWPORT", "TOLERANCE")
)  # no edges of a hole
ALIGNMENTS = ("left", "center", "right")  # of a text
FITTED = 2 | 4  # flags of a POLYLINE that stands for a fitted curve
REFUSED = (ArithmeticError, LookupError, OSError, RecursionError, ValueError)  # of damaged entities
Point = tuple[float, ...]  # (x, y, z) in the drawing's own unit, then (x, y) [m]


class _Unread(Exception):
    """What a layer holds that is not read: what is wrong, and how to mend it."""

    def __init__(self, what: str, mend: str) -> None:
        super().__init__(what)
        self.what, self.mend = what, mend


@dataclass(frozen=True)
class Outlines:
    """The closed outlines of one layer of a drawing."""

    rings: list[list[tuple[float, float]]]  # [m] corners of each
    has_unit: bool  # whether the drawing names its unit; else it was read in millimetres
    doubled: int  # lines, arcs and outlines that lie on others: left out
    gap: float  # [m] the widest between ends that were joined; 0 where all meet


def outlines(path: Path, layer: str, where: str) -> Outlines:
    """Read the closed outlines of one layer of a DXF file.

    Closed polylines, circles, ellipses and splines are outlines by themselves. Lines, arcs and open curves
    are joined where their ends meet, or are as near as ``WIDE_JOIN_M``; what lies on another is left out.
    Blocks are read as what they hold. Texts and dimensions are left out. A curve becomes chords that are at
    most ``CHORD_ERROR_M`` away from it.

    Parameters
    ----------
    path : Path
    layer : str
        Case does not matter.
    where : str
        Place of the file's name in the bowl file.

    Returns
    -------
    Outlines
        Corners in m; it says whether the file names a unit, what lay on others, and which gaps were closed.

    Raises
    ------
    ConfigError
        If the file cannot be read as DXF, has no such layer, no known unit, or something on the layer that is
        no flat closed outline.
    """
    import ezdxf

    logging.getLogger(ezdxf.__name__).setLevel(logging.CRITICAL)  # our line says what is wrong
    name = units.printable(str(path))
    try:
        if not path.exists():
            raise FileNotFoundError
        if not path.is_file():
            raise ConfigError(where, f"{name} is no regular file", "name a DXF file")
        if path.stat().st_size > MAX_DXF_BYTES:
            what = f"{name} has more than {MAX_DXF_BYTES // 10**6} MB"
            raise ConfigError(where, what, "save the hole alone")
        with path.open("rb") as file:
            if file.read(len(documents.POINTER_HEAD)) == documents.POINTER_HEAD:
                raise ConfigError(where, f"{name} {documents.POINTER}", documents.PULL)
        try:
            drawing = ezdxf.readfile(path)
        except (*DAMAGE, ezdxf.DXFError) as error:
            raise ValueError(str(error)) from None
        # of a drawing that states none the reader would supply metres
        states_unit = b"$INSUNITS" in path.read_bytes().partition(b"ENTITIES")[0]
        code = int(drawing.header.get("$INSUNITS", NO_UNIT_CODE)) if states_unit else NO_UNIT_CODE
        rings, doubled, gap = _rings(drawing, code, layer)
    except FileNotFoundError:
        raise ConfigError(where, f"{name}: no such file", "check the path") from None
    except _Unread as fault:
        what = f"layer {units.quantity_text(layer)} of {units.printable(path.name)} {fault.what}"
        raise ConfigError(where, what, fault.mend) from None
    except (*REFUSED, ezdxf.DXFError):
        mend = "save it as ASCII DXF R2000 or later"
        raise ConfigError(where, f"{name} cannot be read as DXF", mend) from None
    if not rings:
        what = f"{units.printable(path.name)} has no closed outline on layer {units.quantity_text(layer)}"
        raise ConfigError(where, what, "draw the hole as one closed polyline (LWPOLYLINE)")
    return Outlines(rings, code != NO_UNIT_CODE, doubled, gap)


def _rings(drawing: "Drawing", code: int, layer: str) -> tuple[list[list[tuple[float, float]]], int, float]:
    """Corners (x, y) [m] of each closed outline on a layer of a drawing in a unit of $INSUNITS.

    Also how many lines and outlines lie on others, and the widest gap [m] that was closed.
    """
    if code not in MILLIMETRES:
        raise _Unread(f"is drawn in unit {code} of $INSUNITS", "save the drawing in millimetres")
    size = MILLIMETRES[code] * 1e-3
    rings: list[list[tuple[float, float]]] = []
    chains: list[list[tuple[float, float]]] = []
    for count, entity in enumerate(_within_blocks(drawing.modelspace(), layer.casefold(), 0), 1):
        if count > MAX_ENTITIES:
            raise _Unread(f"has more than {MAX_ENTITIES} entities", "keep the hole alone on its layer")
        points, closed = _points(entity.dxftype(), entity, CHORD_ERROR_M / size)
        if not all(abs(place) * size <= MAX_DXF_COORDINATE_M for point in points for place in point):
            what = f"has a corner farther than {MAX_DXF_COORDINATE_M:g} m from the origin"
            mend = "check the drawing's units, and save it again"
            raise _Unread(f"{what}, or at no finite place", mend)
        heights = [point[2] * size for point in points]
        if heights and max(heights) - min(heights) > FLAT_M:
            raise _Unread("has an outline that is not flat", "draw the hole in the plane of X and Y")
        flat = [(point[0] * size, point[1] * size) for point in points]
        ends_meet = len(flat) > 2 and math.dist(flat[0], flat[-1]) <= JOIN_M
        (rings if closed or ends_meet else chains).append(flat)
    once = _without_doubles(chains)
    joined, gap = _joined(once)
    outlines = [_simplified(ring) for ring in (*rings, *joined)]
    distinct = _distinct(outlines)
    doubled = sum(len(chain) > 1 for chain in chains) - len(once) + len(outlines) - len(distinct)
    return distinct, doubled, gap


def _within_blocks(space: Iterable[Any], layer: str, depth: int) -> Iterator[Any]:
    """Entities on a layer, those of inserted blocks as they stand; within a block layer 0 is the insert's."""
    for entity in space:
        own = str(entity.dxf.get("layer", "0")).casefold()
        if entity.dxftype() != "INSERT":
            if own == layer and entity.dxftype() not in ANNOTATIONS:
                yield entity
            continue
        if depth >= MAX_BLOCK_DEPTH:
            raise _Unread(f"has blocks nested deeper than {MAX_BLOCK_DEPTH}", "explode the blocks")
        for single in entity.multi_insert() if entity.mcount > 1 else (entity,):
            held = list(itertools.islice(single.virtual_entities(), MAX_ENTITIES + 1))
            for inner in held:
                if str(inner.dxf.get("layer", "0")) == "0":
                    inner.dxf.layer = entity.dxf.get("layer", "0")
            yield from _within_blocks(held, layer, depth + 1)


def _points(kind: str, entity: Any, sagitta: float) -> tuple[list[Point], bool]:
    """Points (x, y, z) [drawing units] along an entity, chords within the sagitta; whether it is closed."""
    dxf = entity.dxf
    if kind == "LINE":
        return [tuple(dxf.start), tuple(dxf.end)], False
    if kind == "LWPOLYLINE":
        corners = [tuple(corner) for corner in entity.get_points("xyb")]
        return _bulged(corners, bool(entity.closed), float(dxf.get("elevation", 0.0)), entity.ocs(), sagitta)
    if kind == "POLYLINE" and not dxf.flags & FITTED:
        if entity.is_2d_polyline:
            places = [vertex.dxf.location for vertex in entity.vertices]
            bulges = [float(vertex.dxf.get("bulge", 0.0)) for vertex in entity.vertices]
            corners = [(place.x, place.y, bulge) for place, bulge in zip(places, bulges, strict=True)]
            height = float(tuple(dxf.get("elevation", (0.0, 0.0, 0.0)))[2])
            return _bulged(corners, bool(entity.is_closed), height, entity.ocs(), sagitta)
        if entity.is_3d_polyline:
            return [tuple(vertex.dxf.location) for vertex in entity.vertices], bool(entity.is_closed)
    if kind in ("ARC", "CIRCLE"):
        radius, closed = abs(float(dxf.radius)), kind == "CIRCLE"
        start, end = (0.0, 360.0) if closed else (float(dxf.start_angle), float(dxf.end_angle))
        _near((*dxf.center, radius, start, end))
        sweep = 360.0 if closed else (end - start) % 360.0 or 360.0
        count = _chords(radius, math.radians(sweep), sagitta)
        angles = [start + sweep * n / count for n in range(count if closed else count + 1)]
        return [tuple(point) for point in entity.vertices(angles)], closed
    if kind == "ELLIPSE":
        _near((*dxf.center, *dxf.major_axis))
        flattened = itertools.islice(entity.flattening(sagitta, MAX_CORNERS // 16), MAX_CORNERS + 2)
        return [tuple(point) for point in flattened], False
    if kind == "SPLINE" and len(entity.control_points):
        return _spline(entity, sagitta), False
    if kind == "SPLINE":
        raise _Unread("holds a SPLINE of fit points alone", "draw it of control points, or as a polyline")
    raise _Unread(
        f"holds {units.one_line(kind)}, which is not read",
        "draw the hole of polylines, lines, arcs, circles, ellipses and splines",
    )


def _bulged(
    corners: list[Point], closed: bool, height: float, frame: Any, sagitta: float
) -> tuple[list[Point], bool]:
    """Points of a polyline whose corners (x, y, bulge) stand in a frame of their own; whether it is closed.

    A bulge is the tangent of a quarter of the angle of the arc to the next corner, positive to the left: DXF
    Reference of Autodesk, "LWPOLYLINE".
    """
    _near([place for corner in corners for place in corner])
    if len(corners) > MAX_ENTITIES:
        raise _Unread(f"has an outline of {len(corners)} corners", f"keep it below {MAX_CORNERS}")
    flat: list[tuple[float, float]] = []
    following = corners[1:] + corners[:1]
    for k, ((x, y, bulge), (to_x, to_y, _)) in enumerate(zip(corners, following, strict=True)):
        flat.append((x, y))
        if bulge == 0.0 or (k == len(corners) - 1 and not closed):
            continue
        angle, across, up = 4.0 * math.atan(bulge), to_x - x, to_y - y
        to_centre = (1.0 - bulge**2) / (4.0 * bulge)
        centre = 0.5 * (x + to_x) - up * to_centre, 0.5 * (y + to_y) + across * to_centre
        radius, start = math.dist(centre, (x, y)), math.atan2(y - centre[1], x - centre[0])
        count = _chords(radius, abs(angle), sagitta)
        for n in range(1, count):
            turn = start + angle * n / count
            flat.append((centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn)))
    return [tuple(point) for point in frame.points_to_wcs((x, y, height) for x, y in flat)], closed


def _spline(entity: Any, sagitta: float) -> list[Point]:
    """Points of a spline, from the knot where its curve begins to the one where it ends.

    A rational spline is one in (w x, w y, w z, w): L. Piegl and W. Tiller, "The NURBS Book", 2nd ed., ch. 4.
    """
    from scipy.interpolate import BSpline

    places, degree = np.array([tuple(place) for place in entity.control_points]), int(entity.dxf.degree)
    knots, weights = np.array(entity.knots, float), np.array(entity.weights or np.ones(len(places)), float)
    _near((*places.ravel(), *knots, *weights))
    fits = len(knots) == len(places) + degree + 1 and 1 <= degree <= 15 and degree < len(places)
    if not fits or len(weights) != len(places) or (np.diff(knots) < 0.0).any() or not (weights > 0.0).all():
        raise _Unread("holds a SPLINE whose knots do not fit it", "draw it again, or as a polyline")
    curve = BSpline(knots, np.column_stack([places * weights[:, None], weights]), degree)
    spans = np.unique(knots[degree : len(places) + 1])
    count = 4
    while count * len(spans) <= 4 * MAX_CORNERS:
        shares = np.arange(2 * count) / (2.0 * count)
        times = np.append((spans[:-1, None] + np.diff(spans)[:, None] * shares).ravel(), spans[-1])
        homogeneous = curve(times)
        points = homogeneous[:, :3] / homogeneous[:, 3:]
        off = points[1::2] - 0.5 * (points[:-2:2] + points[2::2])
        if np.sqrt((off**2).sum(axis=1)).max(initial=0.0) <= sagitta:
            return [tuple(map(float, point)) for point in points[::2]]
        count *= 2
    raise _Unread("holds a SPLINE of too many chords", "check the drawing's units")


def _chords(radius: float, angle: float, sagitta: float) -> int:
    """Return how many chords an arc of an angle [rad] takes for none to be off by more than the sagitta."""
    if not radius > 0.0 or not angle > 0.0:
        return 1
    step = min(2.0 * math.acos(max(1.0 - sagitta / radius, 0.0)), MAX_CHORD_ANGLE)
    count = math.ceil(angle / max(step, 1e-12))
    if count > MAX_CORNERS:
        raise _Unread(f"has an arc that takes {count} chords", "check the drawing's units")
    return count


def _near(places: Iterable[float]) -> None:
    """Refuse numbers that are of no drawing, before curves are made of them."""
    if not all(abs(float(place)) <= 1e12 for place in places):
        raise _Unread("has a corner at no finite place", "check the drawing's units, and save it again")


def _joined(chains: list[list[tuple[float, float]]]) -> tuple[list[list[tuple[float, float]]], float]:
    """Outlines of chains whose ends meet, by a grid of their ends, and the widest gap [m] that is closed.

    Ends that are one corner are joined first, then ends as near as WIDE_JOIN_M. Raises _Unread where an
    outline stays open, or branches.
    """
    ends = _grid_of_ends(chains)
    rings, widest, left = list[list[tuple[float, float]]](), 0.0, set(range(len(chains)))
    while left:
        first = min(left)
        left.remove(first)
        ring = list(chains[first])
        while (gap := math.dist(ring[0], ring[-1])) > JOIN_M or len(ring) < 3:
            near = [
                (math.dist(chains[k][end], ring[-1]), k, end)
                for k, end in _ends_near(ends, ring[-1])
                if k in left and math.dist(chains[k][end], ring[-1]) <= WIDE_JOIN_M
            ]
            contacts = [contact for contact in near if contact[0] <= JOIN_M]
            if not contacts and gap <= WIDE_JOIN_M and len(ring) > 3:
                widest = max(widest, gap)
                ring.pop()
                break
            contacts = contacts or near
            if len(contacts) != 1:
                place = ring[-1]
                at = f"at ({1e3 * place[0]:.4g}, {1e3 * place[1]:.4g}) mm"
                if contacts:
                    mend = "keep one closed outline on the layer, without lines that lie on others"
                    raise _Unread(f"has an outline that branches {at}", mend)
                rest = [chains[k][end] for k in left for end in (0, -1)] + [ring[0]]
                gap = min(math.dist(place, other) for other in rest)
                what = f"has an outline that is open {at}: {1e3 * gap:.3g} mm to the next end"
                raise _Unread(what, "close the outline")
            ((gap, k, end),) = contacts
            left.remove(k)
            if gap > JOIN_M:
                widest = max(widest, gap)
            ring += chains[k][1:] if end == 0 else chains[k][-2::-1]
        rings.append(ring)
    return rings, widest


def _without_doubles(chains: list[list[tuple[float, float]]]) -> list[list[tuple[float, float]]]:
    """Chains of two points or more, each once: one that runs along another, either way, is left out."""
    chains = [chain for chain in chains if len(chain) > 1]
    ends, doubled = _grid_of_ends(chains), set[int]()
    for k, chain in enumerate(chains):
        for other in {
            other for other, _ in itertools.islice(_ends_near(ends, chain[0]), MAX_ENDS_AT_A_CORNER)
        }:
            if other <= k or other in doubled or len(chains[other]) != len(chain):
                continue
            for way in (chains[other], chains[other][::-1]):
                if all(math.dist(a, b) <= JOIN_M for a, b in zip(chain, way, strict=True)):
                    doubled.add(other)
    return [chain for k, chain in enumerate(chains) if k not in doubled]


def _distinct(rings: list[list[tuple[float, float]]]) -> list[list[tuple[float, float]]]:
    """Outlines (x, y) [m], each once: one that encloses what another does is left out."""
    if len(rings) < 2:
        return rings
    import shapely

    distinct = list[Any]()
    kept = list[list[tuple[float, float]]]()
    for ring in rings:
        area = shapely.Polygon(ring) if len(ring) > 2 else shapely.Polygon()
        alike = (  # by less than curves are off their chords
            np.allclose(area.bounds, other.bounds, rtol=0.0, atol=JOIN_M)
            and area.is_valid
            and other.is_valid
            and area.symmetric_difference(other).area <= 2.0 * CHORD_ERROR_M * area.length
            for other in distinct[-MAX_OUTLINES:]
        )
        if area.is_empty or not any(alike):
            kept.append(ring)
            if not area.is_empty:
                distinct.append(area)
    return kept


def _grid_of_ends(chains: list[list[tuple[float, float]]]) -> dict[tuple[int, int], list[tuple[int, int]]]:
    """Chain and which of its ends (0 or -1), by cell of a grid as wide as WIDE_JOIN_M."""
    ends: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for k, chain in enumerate(chains):
        for end in (0, -1):
            ends.setdefault(_cell(chain[end]), []).append((k, end))
    return ends


def _ends_near(ends: dict[tuple[int, int], list[tuple[int, int]]], place: Point) -> Iterator[tuple[int, int]]:
    """Chains and which of their ends in the cells about a place."""
    x, y = _cell(place)
    for i, j in itertools.product((-1, 0, 1), repeat=2):
        yield from ends.get((x + i, y + j), ())


def _cell(place: Point) -> tuple[int, int]:
    return math.floor(place[0] / WIDE_JOIN_M), math.floor(place[1] / WIDE_JOIN_M)


def _simplified(ring: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The outline without corners that repeat the last one or lie on the line through their neighbours."""
    corners = [b for a, b in zip((ring[-1], *ring), ring, strict=False) if math.dist(a, b) > REPEATED_M]
    corners, simplified = corners or ring[:1], []
    for a, b, c in zip((corners[-1], *corners), corners, (*corners[1:], corners[0]), strict=False):
        before, after = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
        off = abs(before[0] * (c[1] - a[1]) - before[1] * (c[0] - a[0]))
        ahead = before[0] * after[0] + before[1] * after[1] > 0.0
        if off > STRAIGHT_M * math.dist(a, c) or not ahead:
            simplified.append(b)
    if len(simplified) > MAX_CORNERS:
        raise _Unread(f"has an outline of {len(simplified)} corners", f"keep it below {MAX_CORNERS}")
    return simplified


def new_document() -> Any:
    """Return an empty drawing of ``ezdxf`` in millimetres, without a date.

    Returns
    -------
    ezdxf.document.Drawing
    """
    import ezdxf

    with _without_a_date(ezdxf.options):
        drawing = ezdxf.new("R2010", units=MILLIMETRE_CODE)
    drawing.header["$MEASUREMENT"] = 1  # metric
    return drawing


def document_bytes(drawing: "Drawing") -> bytes:
    """Return a drawing as the bytes of a DXF file, the same for the same entities.

    Parameters
    ----------
    drawing : ezdxf.document.Drawing
        Made by ``new_document``; classes of its entities are added to it.

    Returns
    -------
    bytes
    """
    import ezdxf

    with _without_a_date(ezdxf.options):
        # ezdxf would add those that it needs in the order of a set, another one in each process
        for kind in sorted(drawing.entitydb.dxf_types_in_use()):
            drawing.classes.add_class(kind)
        file = io.StringIO()
        drawing.write(file)
    return file.getvalue().encode()


def primitives(entity: Any, sagitta: float) -> Iterator[tuple[str, Any]]:
    """Yield the lines, filled areas and texts that an entity is drawn by, those of its blocks too.

    Parameters
    ----------
    entity : entity of ezdxf
    sagitta : float [drawing unit]
        By how much an arc may be too flat.

    Returns
    -------
    iterator of (str, value)
        ('line', (K, 2) float), ('area', list of (K, 2) float) or ('text', (words, place (2,), height, turn
        [deg], 'left' | 'center' | 'right', 'baseline' | 'center_baseline')).
    """
    from ezdxf.disassemble import recursive_decompose
    from ezdxf.path import make_path

    simple: Any
    for simple in recursive_decompose([entity]):
        kind, dxf = simple.dxftype(), simple.dxf
        if kind == "TEXT":
            place = dxf.align_point if dxf.halign else dxf.insert
            look = dxf.height, dxf.get("rotation", 0.0), ALIGNMENTS[dxf.halign], "baseline"
            yield "text", (dxf.text, (place.x, place.y), *look)
        elif kind == "MTEXT":
            across = ALIGNMENTS[(dxf.attachment_point - 1) % 3]
            look = dxf.char_height, simple.get_rotation(), across, "center_baseline"
            yield "text", (simple.plain_text(), (dxf.insert.x, dxf.insert.y), *look)
        elif kind in ("SOLID", "HATCH"):
            rings = [simple.vertices()] if kind == "SOLID" else [path.vertices for path in simple.paths]
            yield "area", [np.array([(place[0], place[1]) for place in ring]) for ring in rings]
        elif kind != "POINT":
            places = make_path(simple).flattening(sagitta)
            yield "line", np.array([(place.x, place.y) for place in places])


@contextlib.contextmanager
def _without_a_date(options: Any) -> Iterator[None]:
    """Let ezdxf write neither a date nor a fresh identity into the file."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
