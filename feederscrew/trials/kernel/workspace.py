"""What the compiled steps work on: what stands along a stretch of track, and the parts on it.

The frame is fixed to the bowl: the track is z = 0, the wall is about an axis at (0, radius) and tangent to x
at the origin. The drive is a force that changes with time, and gravity turns with the place. Everything is
without dimensions, as in `feederscrew.arrivals.kernel`, forces over the part's weight.

Rows are records. Their fields are plain numbers, so that compiled code reads them without making an array.
"""

from typing import NamedTuple

from feederscrew.base.arrays import Bools, Floats, Ints, Rows, Triple
from feederscrew.base.geometry.compiled import record_type

Vec3 = Triple | Floats  # the same as an array, too
IntPair = tuple[int, int]
Island = IntPair  # where in ``Workspace.order`` its parts begin and end


def _spread(*names: str) -> list[str]:
    return [f"{name}_{e}" for name in names for e in "xyz"]


# a flat surface with borders; its solid lies behind it, as deep as it is, with sides straight back from the
# borders: the track with its holes, a blade seen by the part that arrives
PLATE_RECORD = record_type(
    *_spread("origin", "first", "second", "front"),  # its own axes: two along it, one out of it
    "depth",
    "rounding",  # of its borders
    # of its borders among all
    "begin",
    "end",
    "friction",  # its own, NaN for that of the track
    # box around its borders
    "least_x",
    "most_x",
    "least_y",
    "most_y",
    whole=("begin", "end"),
)
BORDER = record_type(
    "start_x",
    "start_y",
    "end_x",
    "end_y",
    # away from what is solid
    "normal_x",
    "normal_y",
    "convex",  # corner at its start
    "drawn_end",  # not what is solid ends there
    # normal of the border before
    "previous_x",
    "previous_y",
    # [1] how far it goes on in the solid before start, behind end
    "extension_start",
    "extension_end",
    flags=("convex", "drawn_end"),
)
JET = record_type(
    *_spread("mouth", "towards"), "radius", "spread", "thrust", "reach", "begin", "end"
)  # spread: growth of the radius by the way; begin and end in time
# a contact has axes of its own in the bowl's frame: along it two, along the track where that can be and aside
# of that, and its normal, towards the part
CONTACT = record_type(
    *_spread("along", "aside", "normal"),
    *_spread("along_lever", "aside_lever", "normal_lever"),  # in body axes
    *_spread("along_rate", "aside_rate", "normal_rate"),  # that one unit of impulse gives, in body axes
    # effective
    "along_mass",
    "aside_mass",
    "normal_mass",
    "target_speed",  # speed along the normal after the impulse
    # given to the part in this step
    "along_impulse",
    "aside_impulse",
    "normal_impulse",
    # against sliding ahead and back
    "friction_ahead",
    "friction_back",
    "friction",  # of what is touched, NaN for that of the track
    "gap",
    "key",  # which contact it is: its kind, then what touches
    *_spread("spot"),  # in body axes
)
IMPULSES = record_type("key", "along", "aside", "normal")  # of a contact in the step before
SUPPORT = record_type("place_x", "place_y", "gap", *_spread("spot"), "key")  # one of many that push one way
CIRCLE = record_type("x", "y", "z", *_spread("axis"), "radius")  # of a part, in its own axes
NEAR_CORNER = record_type(
    "corner",
    # the borders near it, among `sides`
    "first_side",
    "last_side",
    "off",  # over the plate, or from it along the plate where that is more, as the lists were made
    whole=("corner", "first_side", "last_side"),
)
NEAR_EDGE = record_type("edge", "border", "gap", "back", whole=("edge", "border"), flags=("back",))
NEAR_POST = record_type("edge", "border", whole=("edge", "border"))  # runs straight back from a border
NEAR_FACE = record_type("face", "border", "back", whole=("face", "border"), flags=("back",))
NEAR_CIRCLE = record_type("circle", "clear", whole=("circle",), flags=("clear",))  # clear: no border is near
NEAR_WALL = record_type("corner", "gap", whole=("corner",))
LIST_STATE = record_type(
    # pose in which the lists were made, ...
    "x",
    "y",
    "z",
    "qw",
    "qx",
    "qy",
    "qz",
    # ... tangent of the wall there, and ...
    "tangent_x",
    "tangent_y",
    "from_axis",  # ... how far from the bowl's axis
    "reach",  # how far off they look
    "shift",  # how far the part has moved since
    "free",  # how far along the track it may go
    # how many are near the wall
    "wall_corners",
    "wall_circles",
    whole=("wall_corners", "wall_circles"),
)
LISTS = ("corners", "sides", "edges", "posts", "faces", "circles", "rounds")
LIST_COUNTS = record_type(*LISTS, whole=LISTS)  # how many of each list are near the plates so far
PAIR_LISTS = record_type(
    "reach",  # how far off the lists of two parts look; negative where they have no room for what is near
    "partner",
    "nearest",  # how much nearer the first of them must come to touch
    # how many there are
    "own",
    "theirs",
    "edges",
    whole=("partner", "own", "theirs", "edges"),
)
PAIR_NEAR = record_type(
    "ours",  # corner, or edge, of the one part
    "theirs",  # face, or edge, of the other that it may touch
    "off",  # how much nearer it must come at least, as the lists were made
    whole=("ours", "theirs"),
)
JOURNAL = record_type(
    # taken, along the wall, the greatest
    "time",
    "way",
    "depth",
    "gain",  # greatest rise of the energy over what gravity and the drive gave
    # what the last is reckoned with
    "energy",
    "least_energy",
)


class TrueSolid(NamedTuple):
    """A rigid body about its centre of mass, along its principal axes; V corners, E edges, T triangles."""

    vertices: Floats  # (V, 3) every corner
    corners: Floats  # (C, 3) the first of them, in which convex edges end: no other can touch
    edges: Ints  # (E, 2) convex edges, both ends
    sides: Floats  # (E, 6) in both faces of an edge, unit vectors away from it
    extensions: Floats  # (E, 2) [1] how far an edge goes on within the body before its start, behind its end
    firsts: Ints  # (C + 1,) where the neighbours of each corner begin in ``neighbours``
    neighbours: Ints  # (N,) corners joined to a corner by an edge of the surface
    triangles: Ints  # (T, 3) counter-clockwise from outside
    normals: Floats  # (T, 3)
    outer: Bools  # (C,) corners of the hull: of a plane no other can touch
    block_order: Ints  # (C,) corners in an order in which each so many, BLOCK, lie together
    corner_blocks: Floats  # (ceil(C / BLOCK), 6) least and greatest place of so many corners
    edge_blocks: Floats  # (ceil(E / BLOCK), 6) the same of edges
    face_blocks: Floats  # (ceil(T / BLOCK), 6) and of triangles
    circles: Rows  # (K,) CIRCLE of its hull that touch as circles
    on_circle: Bools  # (C,) corners on them
    singles: Ints  # (S,) corners of the hull that are on no circle, grouped
    single_blocks: Floats  # (ceil(S / BLOCK), 6) least and greatest place of so many
    inertia: Floats  # (3,) principal moments at mass 1
    radius: float  # largest distance of a corner


class Surface(NamedTuple):
    """What a part meets on a stretch of track, in units of its length; P plates, B borders, J jets."""

    radius: float  # of the wall
    middle: float  # way along the wall; all ways are within half a turn of it
    # (K, 8) along the wall, evenly between two: gravity ahead, from the wall inwards and up; the bowl's axis,
    # along which it moves, inwards and up; the same of the wall, that stands along it but beside a groove
    slopes: Floats
    plates: Rows  # (P,) PLATE_RECORD
    borders: Rows  # (B,) BORDER
    jets: Rows  # (J,) JET
    friction: Floats  # (5,) static and kinetic ahead, static and kinetic back, wall
    restitution: float
    threshold: float  # approach speed from which a contact rebounds
    sweeps: int
    tolerance: float  # of a sweep's change, over its impulses


class Limits(NamedTuple):
    """When one part is done with a station."""

    exit: float  # way along the wall at which it has passed
    drop: float  # by which the track lies lower there
    fall_height: float  # height of the centre of mass below which what comes there has fallen below the track
    longest: float  # time after which it is given up
    patience: float  # time in which it must get on
    progress: float  # ... so far along the wall, or down
    back_limit: float  # way along the wall, behind which it has gone back
    edge: float  # from the wall, where the track ends: what slides beyond it does not pass
    free: float  # from the wall, beyond which the track does not hold it any more


class Solo(NamedTuple):
    """Arrays for N parts that are sent one at a time, each noted at K places."""

    limits: Limits
    states: Floats  # (N, 13) at the start; filled with those at the end
    times: Floats  # (N,) at the start: the phase of the drive
    stride: int  # steps between two places noted
    # (N, K, 8) filled with time, position and attitude, from the first row on; nothing more once it is full
    paths: Floats
    journals: Rows  # (N,) JOURNAL, filled
    outcomes: Ints  # (N,) filled with what became of each


class QueueSteps(NamedTuple):
    """How a crowd of N parts moves on, all at once."""

    active: Bools  # (N,) which of them are on the track
    time: float  # at the start
    steps: int  # of the floor
    journals: Rows  # (1,) JOURNAL of all


class Workspace(NamedTuple):
    """Arrays for N parts of one shape with C corners: their motion, what is near them, their contacts."""

    states: Floats  # (N, 13)
    starts: Floats  # (N, 13) at the start of a step
    push: Floats  # (N, 13) velocities that take parts out of what they are too deep in
    turns: Floats  # (N, 9) body to bowl, at the start of a step
    reaches: Floats  # (N,) how far ahead contacts are looked for, at the start of a step of the floor
    tangents: Floats  # (N, 2) of the wall where each is
    leans: Floats  # (N, 7) gravity, the bowl's axis and the wall where each is, in the track's frame
    changes: Floats  # (N, 6) of velocity and rates by gravity, drive and jets over a step
    free_rates: Floats  # (N, 3) rates at the end of a step by free rotation alone
    jet_loads: Floats  # (N, 6) force and torque of jets, the latter about the body's axes
    jets_until: Floats  # (N,) when that is looked at anew
    contacts: Rows  # (N, R) CONTACT with the track
    counts: Ints  # (N,) of them
    last_impulses: Rows  # (N, R) IMPULSES of the step before
    last_counts: Ints  # (N,) of them
    last_steps: Floats  # (N,) how long that was; negative where its impulses are not to be begun with
    list_states: Rows  # (N,) LIST_STATE
    ends: Rows  # (N, P + 1) LIST_COUNTS, where the candidates of each plate begin and end in the lists
    list_counts: Rows  # (1,) LIST_COUNTS as the lists are made
    near_corners: Rows  # (N, ...) NEAR_CORNER of a plate
    groups: Floats  # (N, ..., 6) box around each BLOCK of those corners: least places and greatest
    sides: Ints  # (N, ...) borders near them
    near_edges: Rows  # (N, ...) NEAR_EDGE of a border
    near_posts: Rows  # (N, ...) NEAR_POST
    near_faces: Rows  # (N, ...) NEAR_FACE of a border's start
    near_circles: Rows  # (N, ...) NEAR_CIRCLE of a plate's surface
    rounds: Ints  # (N, B) borders that tell whether a point of the part is over what is solid
    wall_corners: Rows  # (N, C) NEAR_WALL
    wall_circles: Ints  # (N, K) circles near the wall
    frame: Floats  # (12,) how a plate sees a part, or a part another: rotation and place
    views: Floats  # (C, 3) corners as a plate, or another part, sees them
    view_corners: Ints  # (C,) which corners those are
    blocks: Ints  # (E,) of which blocks of edges
    indices: Ints  # (C,)
    supports: Rows  # (L,) SUPPORT
    best: Floats  # (7, 2) the best of them each way
    borders_near: Ints  # (B,)
    borders_close: Ints  # (B,) of these, those near some corners
    dips: Floats  # (B,) how deep corners of the part come beside each border
    box: Floats  # (6,)
    pairs: Rows  # (2 K,) CONTACT of parts with each other, two rows each
    owners: Ints  # (2 K,) which part a row is of
    pair_rows: Ints  # (1,) how many rows there are
    pair_lists: Rows  # (N, S) PAIR_LISTS of a part with some others
    next_lists: Ints  # (N,) which of them make room for the next
    pair_frames: Floats  # (N, S, 12) how the other part saw the first as they were made
    own_corners: Rows  # (N, S, R) PAIR_NEAR: its corners, and the faces of the other that they may touch
    their_corners: Rows  # (N, S, R) the other's corners, and its own faces
    near_crossings: Rows  # (N, S, R) its edges, and those of the other that they may cross
    faces_of_corner: Rows  # (T,) a corner, and the faces that it may touch
    strains: Floats  # (N, 2) impulse from behind along the track, and from below, of other parts
    depths: Floats  # (N, 2) the deepest that each was in the track, and in another part
    order: Ints  # (N,) parts by islands: those that may touch each other
    islands: Ints  # (N + 1,) where each begins
    least: Floats  # (3,) box of the part in its own axes
    most: Floats  # (3,)
    first_edges: Ints  # (E,) edges of one part near another
    second_blocks: Ints  # (E,) blocks of edges of the other near the first
    face_blocks: Ints  # (T,) the same of faces
