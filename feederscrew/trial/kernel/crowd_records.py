"""What the compiled steps work on: what stands along a stretch of track, and the parts on it.

The frame is fixed to the bowl: the track is z = 0, the wall is about an axis at (0, radius) and tangent to x
at the origin. The drive is a force that changes with time, and gravity turns with the place. Everything is
without dimensions, as in `feederscrew.dropping.kernel`, forces over the part's weight.
"""

from typing import NamedTuple

import numpy as np

ORIGIN, ACROSS, ALONG, FRONT, DEPTH, ROUNDED, FIRST, LAST = 0, 3, 6, 9, 12, 13, 14, 15  # of a plate's row
RUBS, BOX = 16, 17  # its own friction, NaN for that of the track; least and greatest place of its borders (4)
NORMAL, BEND, END, BEFORE = 4, 6, 7, 8  # of a border: normal; a convex corner at its start; the drawing's end
ONWARDS = 10  # ... how far it goes on in the solid before its start and behind its end (2)
LEAN, WALL = 3, 5  # how the track leans where a part is: gravity (3), the bowl's axis (2), the wall's (2)
REACHES, MOVED, FREE = 7, 8, 9  # of what is noted as lists are made
VERTS, EDGES, POSTS, CORNERS, RIMS, ROUND, LISTS = range(7)  # lists of what of a part is near a plate


class Surface(NamedTuple):
    """What a part meets on a stretch of track, in units of its length; P plates, B borders, J jets.

    A plate is a flat surface with borders; its solid lies behind it, as deep as it is, with sides straight
    back from the borders: the track with its holes, a blade seen by the part that arrives.
    """

    radius: float  # of the wall
    # (K, 8) along the wall, evenly between two: gravity ahead, from the wall inwards and up; the bowl's axis,
    # along which it moves, inwards and up; the same of the wall, that stands along it but beside a groove
    slopes: np.ndarray
    plates: np.ndarray  # (P, 21) origin, three axes, depth, round, borders, friction, box
    borders: np.ndarray  # (B, 12) start, end, normal, corner, drawing's end, normal before, onwards
    jets: np.ndarray  # (J, 12) mouth, direction, radius and its growth, thrust, reach, begin and end in time
    friction: np.ndarray  # (5,) static and kinetic ahead, static and kinetic back, wall
    restitution: float
    threshold: float  # approach speed from which a contact rebounds
    sweeps: int
    converged: float


class Limits(NamedTuple):
    """When one part is done with a station."""

    exit: float  # way along the wall at which it has passed
    drop: float  # by which the track lies lower there
    under: float  # height of the centre of mass below which what comes there has fallen below the track
    longest: float  # time after which it is given up
    patience: float  # time in which it must get on
    progress: float  # ... so far along the wall, or down
    back: float  # way along the wall, behind which it has gone back
    edge: float  # from the wall, where the track ends: what slides beyond it does not pass
    free: float  # from the wall, beyond which the track does not hold it any more


class Sent(NamedTuple):
    """Arrays for N parts that are sent one at a time, each noted at K places."""

    states: np.ndarray  # (N, 13) at the start; filled with those at the end
    times: np.ndarray  # (N,) at the start: the phase of the drive
    every: int  # steps between two places noted
    # (N, K, 8) filled with time, position and attitude, from the first row on; nothing more once it is full
    paths: np.ndarray
    # (N, NOTES + 2) filled with the time taken, the way along the wall, the greatest depth and the greatest
    # rise of the energy over what gravity and the drive gave; then what the last is reckoned with
    notes: np.ndarray
    outcomes: np.ndarray  # (N,) int, filled with what became of each


class Together(NamedTuple):
    """How a crowd of N parts moves on, all at once."""

    active: np.ndarray  # (N,) bool, which of them are on the track
    time: float  # at the start
    steps: int  # of the floor
    notes: np.ndarray  # (NOTES + 2,) as of ``Sent``


class Crowd(NamedTuple):
    """Arrays for N parts of one shape with C corners: their motion, what is near them, their contacts."""

    states: np.ndarray  # (N, 13)
    before: np.ndarray  # (N, 13) at the start of a step
    push: np.ndarray  # (N, 13) velocities that take parts out of what they are too deep in
    turns: np.ndarray  # (N, 9) body to bowl, at the start of a step
    tangents: np.ndarray  # (N, 2) of the wall where each is
    leans: np.ndarray  # (N, 7) gravity, the bowl's axis and the wall where each is, in the track's frame
    given: np.ndarray  # (N, 6) changes of velocity and rates by gravity, drive and jets over a step
    free: np.ndarray  # (N, 3) rates at the end of a step by free rotation alone
    blown: np.ndarray  # (N, 7) force and torque of jets, the latter about the body's axes; until when
    rows: np.ndarray  # (N, R, WIDTH) contacts with the track
    counts: np.ndarray  # (N,) int, of them
    known: np.ndarray  # (N, R, 4) of the step before: which contact, its impulses
    knowns: np.ndarray  # (N,) int, of them
    lasted: np.ndarray  # (N,) that step; negative where its impulses are not to be begun with
    # (N, 10) place and attitude at which the lists were made, how far off they reach, how far it has moved
    # since, how far along the track it may go
    made: np.ndarray
    made_at: np.ndarray  # (N, 3) tangent of the wall there, and how far from the axis
    ends: np.ndarray  # (N, P, LISTS) int, where the candidates of each plate end in the lists
    verts: np.ndarray  # (N, 3, ...) int, corners near a plate, and where their borders begin and end
    # (N, ...) of those corners over the plate, or beside it where that is more, as the lists were made
    offs: np.ndarray
    groups: np.ndarray  # (N, ..., 6) box around each BLOCK of those corners: least places and greatest
    sides: np.ndarray  # (N, ...) int, those borders
    edges: np.ndarray  # (N, ..., 3) int, edges near a border: edge, border, front or back
    edge_gaps: np.ndarray  # (N, ...) how far from the border, as the lists were made
    posts: np.ndarray  # (N, ..., 2) int, edges near what runs straight back from a border's start
    corners: np.ndarray  # (N, ..., 3) int, faces near a border's start: border, front or back, face
    rims: np.ndarray  # (N, ..., 2) int, circles near a plate's surface, and whether no border is near
    rounds: np.ndarray  # (N, B) int, borders that tell whether a point of the part is over what is solid
    rims_walled: np.ndarray  # (N, K + 1) int, how many circles are near the wall, and which
    walled: np.ndarray  # (N, C + 1) int, how many corners are near the wall, and which
    wall_gaps: np.ndarray  # (N, C + 1) and how far from the wall, as the lists were made
    frame: np.ndarray  # (12,) how a plate sees a part, or a part another: rotation and place
    shown: np.ndarray  # (C, 3) corners as a plate, or another part, sees them
    seen: np.ndarray  # (C,) int, which corners those are
    blocks: np.ndarray  # (E,) int, of which blocks of edges
    low: np.ndarray  # (C,) int
    levels: np.ndarray  # (L, 7) contacts that push one way, of `supports`
    best: np.ndarray  # (7, 2) the best of them each way
    near: np.ndarray  # (B,) int
    close: np.ndarray  # (B,) int, of these, those near some corners
    dips: np.ndarray  # (B,) how deep corners of the part come beside each border
    box: np.ndarray  # (6,)
    pairs: np.ndarray  # (2 K, WIDTH) contacts with each other, two rows each
    owners: np.ndarray  # (2 K,) int, which part a row is of
    paired: np.ndarray  # (1,) int, how many rows there are
    strains: np.ndarray  # (N, 2) impulse from behind along the track, and from below, of other parts
    order: np.ndarray  # (N,) int, parts by islands: those that may touch each other
    islands: np.ndarray  # (N + 1,) int, where each begins
    least: np.ndarray  # (3,) box of the part in its own axes
    most: np.ndarray  # (3,)
    ours: np.ndarray  # (E,) int, edges of one part near another
    theirs: np.ndarray  # (E,) int
    faces: np.ndarray  # (T,) int
