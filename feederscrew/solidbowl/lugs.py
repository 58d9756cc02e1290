"""Lugs outside the wall of a bowl in segments, with screws across its seams."""

import itertools
from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.errors import FeederError
from feederscrew.solidbowl import facets
from feederscrew.solidbowl.plan import FULL_TURN

HOLE = 3.4e-3  # [m] for a screw M3, ISO 273
FLATS, DEEP = 5.7e-3, 2.6e-3  # [m] of the pocket for its nut, ISO 4032 and 0.2 mm of play
SCREW_LENGTH_M = 16e-3  # [m] of the screw, and of both halves of a lug
SCREW_NAME = "M3 x 16"
WEIGHT = 1.5e-3  # [kg] of a screw, ISO 4762, with its nut
LUG_HALF_WIDTH_M = 5e-3  # [m] of a lug to either side of its screw
OFF, OVER = 6e-3, 5e-3  # [m] from the wall to the screw, and from there to the lug's outer face
LUG_OVERLAP_M = 5e-4  # [m] by which a lug reaches into the wall
SCREW_SPACING_M = 40e-3  # [m] between screws of a seam, about
LUG_CLEARANCE_M = 15e-3  # [m] from devices and outlet
MAX_WALL_BULGE_M = 8e-4  # [m] by which the wall may bulge between places of a lug
MAX_LUG_LEAN_M = 16e-3  # [m] by which the wall may lean away over a lug: 45 deg
POKE = 1e-11  # [m3] of it on the inner side of the wall at most
BEYOND_LUGS_M = 10.0  # [m] beyond everything
SCREW_HOLE_SIDES = 24  # corners of a hole
STANDS = OFF + OVER  # [m] of a lug over the wall, at least


@dataclass(frozen=True, eq=False)
class Lug:
    """A lug across a seam, with its screw; the seam lies in the middle of it."""

    middle: np.ndarray  # (3,) [m] of the screw, in the seam
    along: np.ndarray  # (3,) the screw's direction, from its nut to its head
    out: np.ndarray  # (3,) off the wall
    body: object  # Manifold [mm], without its holes
    under: float  # [m] by which it goes on beyond its nut, where it is carried at 45 deg

    @property
    def holes(self):
        """The hole of its screw and the pocket of its nut."""
        side = np.cross(self.along, self.out)
        axes = np.column_stack([self.out, side, self.along])
        more = 1e-3 + self.under
        end = self.middle - (0.5 * SCREW_LENGTH_M + more) * self.along
        return [
            facets.plank(_regular(SCREW_HOLE_SIDES, HOLE), SCREW_LENGTH_M + more + 1e-3, axes, end),
            facets.plank(_regular(6, FLATS), DEEP + more, axes, end),
        ]


def _regular(corners, across):
    """A regular polygon [m] by the distance of its flats, one of them outwards."""
    turns = FULL_TURN * (np.arange(corners) + 0.5) / corners
    size = 0.5 * across / np.cos(np.pi / corners)
    return shapely.Polygon(size * np.column_stack([np.cos(turns), np.sin(turns)]))


def lugs(body, planes, kept, extents):
    """Return the lugs along the seams of a bowl, none near its devices or its outlet.

    Parameters
    ----------
    body : Manifold [mm]
        The bowl, turned as its seams are.
    planes : list of (int, float [m])
        Axis and place of each seam.
    kept : shapely geometry [m]
        Seen from above: devices and outlet, in those axes.
    extents : (3, 2) float [m]
        Of the bowl in those axes.

    Returns
    -------
    found : list of Lug
    bare : int
        Of the ends of seams, those that have none.
    ends : int
        Of seams: two of an upright one; a level one goes round and counts once.
    """
    found: list[Lug] = []
    with_one, every = set(), set()
    for axis, at in planes:
        for frame in _upright(at, axis, extents) if axis < 2 else _level(at, extents):
            end = axis, at, *(frame[2] if axis < 2 else ())
            every.add(end)
            made = _lug(body, frame, axis == 2, extents[2, 0])
            if made is not None and _clear(made, kept, found, planes) and _outside(made, body):
                found.append(made)
                with_one.add(end)
    return found, len(every - with_one), len(every)


def remarks(bare, ends):
    """Return what must not be overlooked of ends of seams without a lug, of how many; a tuple of str."""
    if not bare:
        return ()
    what = f"{bare} of {ends} ends of seams have no room for a lug: dowels alone hold them there"
    return (str(FeederError("join", what, "glue those seams, or take a larger bed")),)


def _upright(at, axis, extents):
    """Frames (place, along, out, across) of lugs at both ends of an upright seam."""
    low, high = extents[2] + [LUG_HALF_WIDTH_M + STANDS + 2e-3, -LUG_HALF_WIDTH_M - 1e-3]
    count = 1 + int((high - low) / SCREW_SPACING_M)
    heights = np.linspace(low, high, count) if count > 1 else [0.5 * (low + high)]
    unit, up = np.eye(3), np.array([0.0, 0.0, 1.0])
    along = unit[axis] if at >= 0.0 else -unit[axis]
    for side, z in itertools.product((1.0, -1.0), heights if high >= low else ()):
        yield at * unit[axis] + z * up, along, side * unit[1 - axis], up


def _level(at, extents):
    """Frames of lugs round a level seam."""
    around = np.pi * (extents[0, 1] - extents[0, 0])
    up = np.array([0.0, 0.0, 1.0])
    for turn in FULL_TURN * (np.arange(count := int(around / SCREW_SPACING_M / 2.0)) + 0.5) / count:
        out = np.array([np.cos(turn), np.sin(turn), 0.0])
        yield at * up, up, out, np.cross(up, out)


def _lug(body, frame, level, low):
    """A lug on the wall's outer face; None where that is not smooth there."""
    place, along, out, across = frame
    n, t = 0.5 * SCREW_LENGTH_M * np.linspace(-1.0, 1.0, 5), LUG_HALF_WIDTH_M * np.linspace(-1.0, 1.0, 3)
    off = np.array([[_wall(body, place + a * along + b * across, out) for b in t] for a in n])
    if not np.isfinite(off).all() or np.ptp(off) > MAX_LUG_LEAN_M:
        return None
    if max(np.abs(np.diff(off, 2, axis=k)).max() for k in (0, 1)) > MAX_WALL_BULGE_M:
        return None
    top = off.max() + STANDS
    foot = [(a, b, off[i, j] - LUG_OVERLAP_M) for i, a in enumerate(n) for j, b in enumerate(t)]
    rim = [(a, b, top) for a in n[[0, -1]] for b in t[[0, -1]]]
    deep = top - off.min()
    under = [(n[0] - deep, b) for b in t] if level else [(a, t[0] - deep) for a in n]
    if (place + under[0][0] * along + under[0][1] * across)[2] < low:
        return None
    foot += [(a, b, _wall(body, place + a * along + b * across, out) - LUG_OVERLAP_M) for a, b in under]
    corners = np.array([*foot, *rim])
    if not np.isfinite(corners).all():
        return None
    places = place + corners[:, :1] * along + corners[:, 1:2] * across + corners[:, 2:] * out
    return Lug(place + (off.max() + OFF) * out, along, out, facets.hull(places), deep if level else 0.0)


def _wall(body, place, out):
    """How far out [m] the outer face of the wall lies from a place; not a number without one."""
    found = facets.first_met(body, place + BEYOND_LUGS_M * out, place)
    return BEYOND_LUGS_M - found[0] if found else np.nan


def _clear(made, kept, others, planes):
    """Whether a lug lies apart from devices, from other lugs and from other seams."""
    if kept.distance(shapely.Point(made.middle[:2])) < LUG_CLEARANCE_M:
        return False
    if any(np.sum((made.middle - one.middle) ** 2) < (2.0 * SCREW_LENGTH_M) ** 2 for one in others):
        return False
    own = int(np.argmax(np.abs(made.along)))
    return all(axis == own or abs(made.middle[axis] - at) > SCREW_LENGTH_M for axis, at in planes)


def _outside(made, body):
    """Whether a lug does not come out of the wall on its inner side."""
    return len(facets.parts_of(facets.without(made.body, [body]), POKE)) == 1
