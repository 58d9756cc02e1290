"""Parts by their sizes: fasteners of ISO standards, pins, caps, brackets and the T of the thesis.

A shape is described once, for either kit of bodies: ``cad.facets`` makes its mesh, and
``cad.exact.exact_body`` its exact faces, where OpenCASCADE is installed. A thread is a cylinder as
thick as its major diameter: that is what stands on a rail, and what a hole has to let through.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
import shapely

from feederscrew.base.errors import ArgumentError
from feederscrew.base.units import MM
from feederscrew.cad.facets import Body
from feederscrew.thesis import parts as thesis_parts

PITCHES_MM = {  # ISO 261, coarse series: of each size of thread, whose number is its major diameter
    "M1.6": 0.35,
    "M2": 0.4,
    "M2.5": 0.45,
    "M3": 0.5,
    "M4": 0.7,
    "M5": 0.8,
    "M6": 1.0,
    "M8": 1.25,
    "M10": 1.5,
    "M12": 1.75,
    "M16": 2.0,
    "M20": 2.5,
}
HEX_BOLTS_MM = {  # ISO 4017: height of the head, across flats (nominal), shortest and longest bolt
    "M1.6": (1.1, 3.2, 2, 16),
    "M2": (1.4, 4, 4, 20),
    "M2.5": (1.7, 5, 5, 25),
    "M3": (2, 5.5, 6, 30),
    "M4": (2.8, 7, 8, 40),
    "M5": (3.5, 8, 10, 50),
    "M6": (4, 10, 12, 60),
    "M8": (5.3, 13, 16, 80),
    "M10": (6.4, 16, 20, 100),
    "M12": (7.5, 18, 25, 120),
    "M16": (10, 24, 30, 150),
    "M20": (12.5, 30, 40, 150),
}
SOCKET_SCREWS_MM = {  # ISO 4762: across the plain head, across flats and depth of the socket, lengths
    "M1.6": (3, 1.5, 0.7, 2.5, 16),
    "M2": (3.8, 1.5, 1, 3, 20),
    "M2.5": (4.5, 2, 1.1, 4, 25),
    "M3": (5.5, 2.5, 1.3, 5, 30),
    "M4": (7, 3, 2, 6, 40),
    "M5": (8.5, 4, 2.5, 8, 50),
    "M6": (10, 5, 3, 10, 60),
    "M8": (13, 6, 4, 12, 80),
    "M10": (16, 8, 5, 16, 100),
    "M12": (18, 10, 6, 20, 120),
    "M16": (24, 14, 8, 25, 160),
    "M20": (30, 17, 10, 30, 200),
}
HEX_NUTS_MM = {  # ISO 4032: greatest height, across flats (nominal)
    "M1.6": (1.3, 3.2),
    "M2": (1.6, 4),
    "M2.5": (2, 5),
    "M3": (2.4, 5.5),
    "M4": (3.2, 7),
    "M5": (4.7, 8),
    "M6": (5.2, 10),
    "M8": (6.8, 13),
    "M10": (8.4, 16),
    "M12": (10.8, 18),
    "M16": (14.8, 24),
    "M20": (18, 30),
}
WASHERS_MM = {  # ISO 7089: hole, across, thickness (nominal)
    "M1.6": (1.7, 4, 0.3),
    "M2": (2.2, 5, 0.3),
    "M2.5": (2.7, 6, 0.5),
    "M3": (3.2, 7, 0.5),
    "M4": (4.3, 9, 0.8),
    "M5": (5.3, 10, 1),
    "M6": (6.4, 12, 1.6),
    "M8": (8.4, 16, 1.6),
    "M10": (10.5, 20, 2),
    "M12": (13, 24, 2.5),
    "M16": (17, 30, 3),
    "M20": (21, 37, 3),
}
LENGTHS_MM = (  # ISO 888, of bolts and screws
    2,
    2.5,
    3,
    4,
    5,
    6,
    8,
    10,
    12,
    16,
    20,
    25,
    30,
    35,
    40,
    45,
    50,
    55,
    60,
    65,
    70,
    80,
    90,
    100,
    110,
    120,
    130,
    140,
    150,
    160,
    180,
    200,
)
MINOR_OUTSIDE = 1.2269  # [1] of the pitch, major less minor diameter of a bolt's thread (ISO 724, d3)
MINOR_INSIDE = 1.0825  # [1] the same of a nut's thread (ISO 724, D1)
BEVEL_ANGLE_RAD = np.radians(30.0)  # of a hexagon's corners
BEVEL_CIRCLE = 0.95  # [1] of the width across flats: what the bevel leaves flat
CORE_MARGIN = 1.05  # [1] of the major diameter: where a nut's thread is countersunk
HEAD_BEVEL = 0.1  # [1] of the major diameter: upper edge of a socket head
PIN_BEVEL = 0.2  # [1] of the diameter of a pin
# a circle's chord ...
CHORD_M = 1e-5  # lies so far within it at most
CHORD_RAD = np.pi / 30.0  # spans so much at most
SIZE_RANGE_MM = (0.2, 500.0)  # of a part's edges
THREAD = re.compile(r"m([0-9]+(?:\.[0-9]+)?)", re.IGNORECASE)
NUMBER = re.compile(r"[0-9]+(?:\.[0-9]+)?")
BETWEEN = re.compile(r"\s*[x\u00d7]\s*", re.IGNORECASE)  # the sizes of 'M8x25'
T_RATIO_RANGE = (0.05, 20.0)  # thickness over width
# without an option
T_RATIO = 0.4
WALL_MM = 1.0

Kit = ModuleType  # ``cad.facets`` or ``cad.exact.exact_body``: functions of the same names


@dataclass(frozen=True)
class SampleShape:
    """A part by its sizes, made when a kit of bodies is given."""

    name: str  # of its file, without the ending
    build: Callable[[Kit], Body]


@dataclass(frozen=True)
class Family:
    """Parts of one kind that differ in size."""

    name: str
    size: str  # an example; empty where it has none
    options: tuple[str, ...]  # arguments of ``shape`` that it takes besides
    meaning: str
    shape: Callable[..., SampleShape]


def shape(name: str, size: str = "", *, ratio: float | None = None, wall: float | None = None) -> SampleShape:
    """Return a part of a family by its size.

    Parameters
    ----------
    name : str
        One of ``FAMILIES``: 'hex-bolt'.
    size : str, optional
        As the family writes it: 'M8x25', '16x9'; lengths in mm.
    ratio : float [1], optional
        Thickness over width of 't-shape'.
    wall : float [m], optional
        Thickness of what is made of sheet.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If there is no such family, size or value of it.
    """
    family = FAMILIES.get(name)
    if family is None:
        raise ArgumentError("name", f"{name!r} is no family of parts", f"give one of {', '.join(FAMILIES)}")
    given = {"ratio": ratio, "wall": wall}
    for option, value in given.items():
        if value is not None and option not in family.options:
            takers = (other.name for other in FAMILIES.values() if option in other.options)
            raise ArgumentError(option, f"{name} has none", f"leave it out: it is for {', '.join(takers)}")
    if not size and family.size:
        raise ArgumentError("size", f"{name} needs one", f"write it behind the name, as {family.size}")
    if size and not family.size:
        raise ArgumentError("size", f"{name} has none", f"leave {size!r} out")
    values = {option: given[option] for option in family.options if given[option] is not None}
    return family.shape(*BETWEEN.split(size.strip()) if size else (), **values)


# -- fasteners


def hex_bolt(*words: str) -> SampleShape:
    """Return a hexagon bolt of ISO 4017: thread up to its head, seat at Z = 0, shank downwards.

    Parameters
    ----------
    *words : str
        Thread and length in mm: 'M8', '25'.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If the standard has no such bolt.
    """
    thread, length = _bolt("ISO 4017", "M8x25", words, {key: row[-2:] for key, row in HEX_BOLTS_MM.items()})
    high, flats = (MM * value for value in HEX_BOLTS_MM[thread][:2])

    def build(kit: Kit) -> Body:
        head = kit.without(_hexagon(kit, flats, 0.0, high), [_bevel(kit, flats, high)])
        return kit.united([head, _shank(kit, thread, length, 0.5 * high)])

    return SampleShape(f"hexbolt_{thread.lower()}x{length / MM:g}", build)


def socket_screw(*words: str) -> SampleShape:
    """Return a socket head cap screw of ISO 4762 with a plain head; seat at Z = 0, shank downwards.

    Parameters
    ----------
    *words : str
        Thread and length in mm: 'M3', '8'.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If the standard has no such screw.
    """
    rows = {key: row[-2:] for key, row in SOCKET_SCREWS_MM.items()}
    thread, length = _bolt("ISO 4762", "M3x8", words, rows)
    across, flats, deep = (MM * value for value in SOCKET_SCREWS_MM[thread][:3])
    high = major_diameter(thread)  # of the head: that of the thread
    bevel, radius = HEAD_BEVEL * high, 0.5 * across

    def build(kit: Kit) -> Body:
        rim = [(0, 0), (radius, 0), (radius, high - bevel), (radius - bevel, high), (0, high)]
        head = kit.turned(np.array(rim), chords(radius))
        socket = _hexagon(kit, flats, high - deep, 1.5 * high)
        return kit.without(kit.united([head, _shank(kit, thread, length, 0.3 * high)]), [socket])

    return SampleShape(f"shcs_{thread.lower()}x{length / MM:g}", build)


def hex_nut(*words: str) -> SampleShape:
    """Return a hexagon nut of ISO 4032 on Z = 0; its bore is as wide as the thread's minor diameter.

    Parameters
    ----------
    *words : str
        Thread: 'M6'.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If the standard has no such nut.
    """
    thread = _thread("ISO 4032", "M6", words, HEX_NUTS_MM)
    high, flats = (MM * value for value in HEX_NUTS_MM[thread])
    minor = 0.5 * (major_diameter(thread) - MINOR_INSIDE * MM * PITCHES_MM[thread])
    wide = 0.5 * CORE_MARGIN * major_diameter(thread)
    sink = wide - minor  # countersunk at 45 degrees

    def build(kit: Kit) -> Body:
        out = [(wide + high, -high), (wide, 0.0), (minor, sink)]
        bore = np.array([(0.0, -high), *out, *((r, high - z) for r, z in reversed(out)), (0.0, 2.0 * high)])
        tools = [_bevel(kit, flats, high), _bevel(kit, flats, 0.0, up=-1.0), kit.turned(bore, chords(wide))]
        return kit.without(_hexagon(kit, flats, 0.0, high), tools)

    return SampleShape(f"hexnut_{thread.lower()}", build)


def washer(*words: str) -> SampleShape:
    """Return a plain washer of ISO 7089, on Z = 0.

    Parameters
    ----------
    *words : str
        The thread that goes through it: 'M6'.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If the standard has no such washer.
    """
    thread = _thread("ISO 7089", "M6", words, WASHERS_MM)
    hole, across, high = (MM * value for value in WASHERS_MM[thread])
    rim = 0.5 * np.array([(hole, 0), (across, 0), (across, 2 * high), (hole, 2 * high)])
    return SampleShape(f"plain_washer_{thread.lower()}", lambda kit: kit.turned(rim, chords(0.5 * across)))


def major_diameter(thread: str) -> float:
    """Return the major diameter of a thread, as thick as a shank with it.

    Parameters
    ----------
    thread : str
        'M8', as the tables above write it.

    Returns
    -------
    float [m]
    """
    return MM * float(thread[1:])


def _shank(kit: Kit, thread: str, length: float, top: float) -> Body:
    """A threaded shank [mm] from its bevelled end at Z = -length up to ``top`` [m] within the head."""
    radius = 0.5 * major_diameter(thread)
    bevel = 0.5 * MINOR_OUTSIDE * MM * PITCHES_MM[thread]
    ends = [(0, -length), (radius - bevel, -length), (radius, bevel - length), (radius, top), (0, top)]
    return kit.turned(np.array(ends), chords(radius))


def _hexagon(kit: Kit, flats: float, low: float, high: float) -> Body:
    """A hexagonal prism [mm] with corners on X, by its width across flats and its two heights [m]."""
    angles = np.radians(60.0 * np.arange(6))
    corners = flats / np.sqrt(3.0) * np.column_stack([np.cos(angles), np.sin(angles)])
    return kit.plank(shapely.Polygon(corners), high - low, np.eye(3), (0.0, 0.0, low))


def _bevel(kit: Kit, flats: float, at: float, up: float = 1.0) -> Body:
    """A ring [mm] that takes the corners off a hexagon whose end is at a height [m] and faces ``up``."""
    inner, outer = 0.5 * BEVEL_CIRCLE * flats, flats
    drop = (outer - inner) * np.tan(BEVEL_ANGLE_RAD)
    ring = np.array(
        [(inner, at), (outer, at - up * drop), (outer, at + up * flats), (inner, at + up * flats)]
    )
    return kit.turned(ring if up > 0.0 else ring[::-1], chords(outer))


def _bolt(
    standard: str, example: str, words: tuple[str, ...], limits: Mapping[str, tuple[float, ...]]
) -> tuple[str, float]:
    """Thread and length [m] of ('M8', '25'), within the shortest and the longest [mm] of its size."""
    thread = _thread(standard, example, words[:1] if len(words) == 2 else (), limits)
    (length,), (low, high) = _lengths(example, words[1:]), limits[thread]
    lengths = [value for value in LENGTHS_MM if low <= value <= high]
    if length / MM not in lengths:
        near = sorted(sorted(lengths, key=lambda value: abs(value - length / MM))[:2])
        what = f"{thread} of {standard} comes {low:g} to {high:g} mm long, not {length / MM:g}"
        raise ArgumentError("size", what, f"write {' or '.join(f'{thread}x{value:g}' for value in near)}")
    return thread, length


def _thread(standard: str, example: str, words: tuple[str, ...], sizes: Mapping[str, object]) -> str:
    """Thread 'M8' of ('m8',), one of the sizes that a standard has here."""
    typed = THREAD.fullmatch(words[0]) if len(words) == 1 else None
    if typed is None:
        raise ArgumentError("size", f"is not that of {standard}", f"write it as {example}")
    thread = f"M{float(typed[1]):g}"
    if thread not in sizes:
        raise ArgumentError("size", f"{standard} has no {thread} here", f"give one of {', '.join(sizes)}")
    return thread


# -- other parts


def pin(*words: str) -> SampleShape:
    """Return a dowel pin with bevelled ends, about the origin, along Z.

    Parameters
    ----------
    *words : str
        Diameter and length in mm: '6', '20'.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If a length is missing or out of range, or the bevels meet.
    """
    across, length = _lengths("6x20", words, 2)
    radius, half, bevel = 0.5 * across, 0.5 * length, PIN_BEVEL * across
    _check_room("size", "the bevels meet", bevel < half, f"make it longer than {2.0 * bevel / MM:g} mm")
    right = [(0.0, -half), (radius - bevel, -half), (radius, bevel - half)]
    rim = np.array([*right, *((r, -z) for r, z in reversed(right))])
    return SampleShape(f"pin_{_words(across, length)}", lambda kit: kit.turned(rim, chords(radius)))


def cap(*words: str, wall: float = WALL_MM * MM) -> SampleShape:
    """Return a cap, a round cup of sheet, open above; on Z = 0.

    Parameters
    ----------
    *words : str
        Outer diameter and height in mm: '14', '10'.
    wall : float [m], optional
        Thickness of its wall and of its bottom.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If a length is missing or out of range, or the wall is too thin or leaves no room in it.
    """
    across, high = _lengths("14x10", words, 2)
    radius, inner = 0.5 * across, 0.5 * across - wall
    _check_room("wall", "leaves no room in it", inner > 0.0 and wall < high, "make it thinner")
    _check_room("wall", "is too thin", wall >= SIZE_RANGE_MM[0] * MM, f"give {SIZE_RANGE_MM[0]:g} mm or more")
    rim = [(0, 0), (radius, 0), (radius, high), (inner, high), (inner, wall), (0, wall)]
    named = f"cap_{_words(across, high, wall)}"
    return SampleShape(named, lambda kit: kit.turned(np.array(rim), chords(radius)))


def bracket(*words: str, wall: float = WALL_MM * MM) -> SampleShape:
    """Return an angle of sheet with a hole.

    Its long leg lies on Z = 0 and has the hole, as wide as a third of the leg; the other one stands at X = 0.

    Parameters
    ----------
    *words : str
        Length, height and width in mm: '25', '10', '12'.
    wall : float [m], optional
        Thickness of the sheet.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If a length is missing or out of range, the wall is too thin or leaves no legs, or the hole leaves its
        leg.
    """
    long, high, wide = _lengths("25x10x12", words, 3)
    hole = wide / 3.0
    _check_room("wall", "leaves no legs", wall < min(high, long - hole), "make it thinner")
    _check_room("wall", "is too thin", wall >= SIZE_RANGE_MM[0] * MM, f"give {SIZE_RANGE_MM[0]:g} mm or more")
    middle = 0.5 * (wall + long)
    _check_room(
        "size", "the hole leaves the leg", middle - wall > 0.75 * hole, "make the first length longer"
    )

    def build(kit: Kit) -> Body:
        legs = [shapely.box(0.0, -wide, long, 0.0), shapely.box(0.0, -wide, wall, 0.0)]
        up = [kit.plank(leg, height, np.eye(3), (0.0, 0.0, 0.0)) for leg, height in zip(legs, (wall, high))]
        return kit.without(kit.united(up), [kit.disc((middle, -0.5 * wide), hole, -wall, 2.0 * wall)])

    return SampleShape(f"bracket_{_words(long, high, wide, wall)}", build)


def t_shape(ratio: float = T_RATIO) -> SampleShape:
    """Return the T of the thesis; upright along Y, about Z = 0.

    Its outline is that which follows from Table 3-8 of the thesis: ``thesis.parts.t_solid``.

    Parameters
    ----------
    ratio : float [1], optional
        Thickness over width, within ``T_RATIO_RANGE``.

    Returns
    -------
    SampleShape

    Raises
    ------
    ArgumentError
        If the ratio is out of range.
    """
    low, high = T_RATIO_RANGE
    if not low <= ratio <= high:
        raise ArgumentError("ratio", f"{ratio:g} is out of range", f"give {low:g} to {high:g}")
    vertices, _ = thesis_parts.t_solid(ratio)
    outline, half = vertices[: len(vertices) // 2, :2], float(vertices[:, 2].max())

    def build(kit: Kit) -> Body:
        return kit.plank(shapely.Polygon(outline), 2.0 * half, np.eye(3), (0.0, 0.0, -half))

    return SampleShape(f"t_shape_{ratio:g}", build)


def _lengths(example: str, words: tuple[str, ...], count: int = 1) -> tuple[float, ...]:
    """Lengths [m] of so many words, in mm."""
    if len(words) != count or not all(NUMBER.fullmatch(word) for word in words):
        what = f"{'x'.join(words)!r} is not that of this family" if words else "one is missing"
        raise ArgumentError("size", what, f"write it as {example}, in mm")
    low, high = SIZE_RANGE_MM
    for word in words:
        _check_room(
            "size", f"{word} is out of range", low <= float(word) <= high, f"give {low:g} to {high:g} mm"
        )
    return tuple(MM * float(word) for word in words)


def _check_room(where: str, what: str, holds: bool, mend: str) -> None:
    if not holds:
        raise ArgumentError(where, what, mend)


def _words(*lengths: float) -> str:
    return "x".join(f"{length / MM:g}" for length in lengths)


def chords(radius: float) -> int:
    """Return how many chords make a circle: a multiple of 12, so that hexagons fit.

    A chord that spans the angle s lies r (1 - cos(s / 2)) within the circle: at most ``CHORD_M``, and s at
    most ``CHORD_RAD``.

    Parameters
    ----------
    radius : float [m]
        r, above 0.

    Returns
    -------
    int
    """
    step = min(CHORD_RAD, 2.0 * np.arccos(1.0 - min(CHORD_M / radius, 1.0)))
    return 12 * int(np.ceil(2.0 * np.pi / step / 12.0))


FAMILIES = {
    family.name: family
    for family in (
        Family("hex-bolt", "M8x25", (), "hexagon bolt, ISO 4017, M1.6 to M20", hex_bolt),
        Family("socket-screw", "M3x8", (), "socket head cap screw, ISO 4762, M1.6 to M20", socket_screw),
        Family("hex-nut", "M6", (), "hexagon nut, ISO 4032, M1.6 to M20", hex_nut),
        Family("washer", "M6", (), "plain washer, ISO 7089, M1.6 to M20", washer),
        Family("pin", "6x20", (), "dowel pin: diameter x length", pin),
        Family("cap", "14x10", ("wall",), "cap open on one side: diameter x height", cap),
        Family("bracket", "25x10x12", ("wall",), "angle with a hole: length x height x width", bracket),
        Family("t-shape", "", ("ratio",), "T of the thesis, 25 x 25 mm, of any thickness", t_shape),
    )
}
