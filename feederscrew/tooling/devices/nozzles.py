"""Air: the thrust of a nozzle, what of it meets a part, and the steady jet.

Source: isentropic flow through a nozzle; docs/tooling.md.
"""

import functools
import math
from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.geometry import vectors
from feederscrew.geometry.polygons import turned
from feederscrew.tooling.devices.pieces import GRIP, Jet

AMBIENT_PRESSURE_PA = 101325.0  # [Pa]
CHOKED = ((1.4 + 1.0) / 2.0) ** (1.4 / 0.4)  # [1] of absolute pressures: beyond it the nozzle is choked
SPREAD = math.tan(math.radians(11.0))  # [1] growth of a free jet's radius: 10 to 12 deg to either side
RAYS, GOLDEN = 24, math.pi * (3.0 - math.sqrt(5.0))  # of a jet; [rad] from one to the next
TRIED, ENOUGH = 12, 0.5  # heights at which an orientation is blown at, and the least share of the thrust
JET_REACH_M = 0.5  # [m] no track is wider
ACROSS = (0.0, 1.0, 0.0)  # straight across the track


def thrust(diameter, pressure):
    """Return the thrust [N] of a nozzle.

    Source: the ideal nozzle, choked beyond a ratio of pressures; docs/validation.md, "Air jet".

    Parameters
    ----------
    diameter : float [m]
    pressure : float [Pa]
        At the nozzle, above the ambient.

    Notes
    -----
    Isentropic flow of air (ratio of heats 1.4), of a convergent nozzle: beyond the critical ratio of 1.893
    the mouth has the critical pressure, below it the ambient one.
    """
    area, whole = 0.25 * math.pi * diameter**2, pressure + AMBIENT_PRESSURE_PA
    if whole / AMBIENT_PRESSURE_PA > CHOKED:
        return 2.4 / CHOKED * whole * area - AMBIENT_PRESSURE_PA * area
    ratio = AMBIENT_PRESSURE_PA / whole
    return 2.0 * area * whole * 3.5 * (ratio ** (1.0 / 1.4) - ratio)


@dataclass(frozen=True)
class Nozzles:
    """Nozzles in the wall, one above the other, that blow straight across the track."""

    diameter: float  # [m] of each
    pressure: float  # [Pa] at the nozzles, above the ambient
    height: float | None = None  # [m] of the lowest over the track; None: as `heights` says
    count: int = 1

    @property
    def thrust(self):
        """Thrust [N] of one."""
        return thrust(self.diameter, self.pressure)

    def heights(self, every):
        """Return their heights [m] over the track, (N,), upwards.

        Where nothing is said of it, one nozzle blows at the lowest centre of mass. Several blow where each
        orientation has something before its centre of mass that is not a mere slope, as far as they are
        enough for that; the others are spread between those and the top of the tallest.
        """
        return np.array(_heights(self, tuple(every)))

    def _placed(self, every):
        low, top = self.height, max(one.height for one in every)
        if low is None and self.count > 1:
            met = _meeting([_solid_at_middle(one) for one in every], 0.5 * self.diameter)
            if len(met) <= self.count:
                return _spread(self._at_slopes(met, every), top, self.count)
        if low is None:
            low = max(min(one.posture.height for one in every), 0.5 * self.diameter)
        high = max(top - low, low)
        return np.linspace(low, high, self.count) if high > low else np.full(self.count, low)

    def _at_slopes(self, heights, every):
        """Some heights [m], and those at which what they blow at slopes of is pushed most, of the rest."""
        found = list(heights)
        for one in every:
            if len(found) < self.count and self._moves(one, found) < ENOUGH:
                tried = one.height * (np.arange(TRIED) + 0.5) / TRIED
                best = max(tried, key=lambda height: self._moves(one, [height]))
                found += [float(best)] if self._moves(one, [best]) > self._moves(one, found) else []
        return found

    def _moves(self, one, heights):
        """The force outwards, less the friction of that down, over the thrust of a nozzle [1]."""
        pushes = [_share(one, self.diameter, float(height)) for height in heights]
        return sum(out - (one.grip or GRIP) * down for out, down in pushes)

    def push(self, one, every, ahead=0.0):
        """Return the force [N] outwards, and down, on an orientation whose centre of mass is before them.

        Or ``ahead`` [m] of them. Air gives a facet what of its momentum goes into that, so a slope is pressed
        down or lifted as well.
        """
        pushes = [_share(one, self.diameter, float(height), ahead) for height in self.heights(every)]
        return tuple(self.thrust * sum(push[k] for push in pushes) for k in range(2))

    def jets(self, place, every, seconds=math.inf):
        """Return their Jets at a place [m] along the device."""
        return tuple(
            Jet((place, 0.0, height), ACROSS, 0.5 * self.diameter, SPREAD, self.thrust, JET_REACH_M, seconds)
            for height in self.heights(every)
        )


@functools.lru_cache(maxsize=256)
def _heights(nozzles, every):
    """As `Nozzles.heights`."""
    return tuple(nozzles._placed(every))


def _share(one, diameter, height, ahead=0.0):
    """What of a jet's thrust an orientation takes [1]: outwards from the wall, and down."""
    return _taken(one.posture, one.heading, (ahead, one.distance), diameter, height)


@functools.lru_cache(maxsize=4096)
def _taken(posture, heading, place, diameter, height):
    points, faces = posture.surface, posture.solid.faces
    plan = turned(points[:, :2], heading) + place
    corners = np.column_stack([plan, points[:, 2]])[faces]
    sides = vectors.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    corners, sides = corners[sides[:, 1] < 0.0], sides[sides[:, 1] < 0.0]  # those that face the wall
    turn, off = GOLDEN * np.arange(RAYS), np.sqrt((np.arange(RAYS) + 0.5) / RAYS)
    places = off[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    ways = np.column_stack([SPREAD * places[:, 0], np.ones(RAYS), SPREAD * places[:, 1]])
    mouths = 0.5 * diameter * places + [0.0, height]
    mouths = np.column_stack([mouths[:, 0], np.zeros(RAYS), mouths[:, 1]])
    out = down = 0.0
    for way, k in zip(ways, _first_met(corners, sides, mouths, ways)):
        if k >= 0:
            size = np.sqrt((sides[k] ** 2).sum())
            into = (sides[k] * way).sum() / (size * np.sqrt((way**2).sum()))
            out, down = out + into * sides[k, 1] / size, down - into * sides[k, 2] / size
    return float(out) / RAYS, float(down) / RAYS


def _first_met(corners, sides, mouths, ways):
    """Which (R,) of some triangles (F, 3, 3) [m] with normals (F, 3) each ray meets first; -1 of none."""
    if not len(sides):
        return np.full(len(ways), -1)
    slope = (sides * ways[:, None]).sum(axis=2)
    fall = ((corners[:, 0] - mouths[:, None]) * sides).sum(axis=2)
    far = np.divide(fall, slope, out=np.full(slope.shape, np.inf), where=slope < 0.0)
    ray, facet = np.nonzero(np.isfinite(far) & (far >= 0.0))
    spots = mouths[ray] + far[ray, facet][:, None] * ways[ray]
    inside = np.ones(len(ray), bool)
    for a in range(3):
        along, to = (corners[:, (a + 1) % 3] - corners[:, a])[facet], spots - corners[facet, a]
        inside &= (vectors.cross(along, to) * sides[facet]).sum(axis=1) >= 0.0
    nearest = np.full(far.shape, np.inf)
    nearest[ray[inside], facet[inside]] = far[ray[inside], facet[inside]]
    return np.where(np.isfinite(nearest.min(axis=1)), nearest.argmin(axis=1), -1)


def _solid_at_middle(one):
    """From which height [m] to which the lowest goes that an orientation has at its centre of mass."""
    upright = shapely.LineString([(0.0, -one.height), (0.0, 2.0 * one.height)])
    spans = [piece.bounds for piece in shapely.get_parts(one.aside.intersection(upright))]
    return min(((span[1], span[3]) for span in spans), default=(0.0, one.height))


def _meeting(spans, radius):
    """Return the fewest heights [m] of which each span (low, high) has one, a radius within its ends."""
    found: list[float] = []
    for low, high in sorted(spans, key=lambda span: span[1]):
        if not any(low <= height <= high for height in found):
            found.append(max(high - radius, 0.5 * (low + high)))
    return found


def _spread(heights, top, count):
    """Return some heights [m] and as many more as make a count, each amid the widest space up to a top."""
    found = sorted(heights)
    while len(found) < count:
        spaces = np.diff([*found, top])
        k = int(np.argmax(np.round(spaces, 9)))
        found.insert(k + 1, found[k] + 0.5 * float(spaces[k]))
    return np.array(found)
