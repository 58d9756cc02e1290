"""Air: the thrust of a nozzle, what of it meets a part, and the steady jet.

Source: isentropic flow through a nozzle; docs/tooling.md.
"""

import math
from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.tooling.devices.pieces import Jet

AMBIENT = 101325.0  # [Pa]
CHOKED = ((1.4 + 1.0) / 2.0) ** (1.4 / 0.4)  # [1] of absolute pressures: beyond it the nozzle is choked
SPREAD = math.tan(math.radians(11.0))  # [1] growth of a free jet's radius: 10 to 12 deg to either side
REACH = 0.5  # [m] no track is wider
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
    area, whole = 0.25 * math.pi * diameter**2, pressure + AMBIENT
    if whole / AMBIENT > CHOKED:
        return 2.4 / CHOKED * whole * area - AMBIENT * area
    ratio = AMBIENT / whole
    return 2.0 * area * whole * 3.5 * (ratio ** (1.0 / 1.4) - ratio)


@dataclass(frozen=True)
class Nozzles:
    """Nozzles in the wall, one above the other, that blow straight across the track."""

    diameter: float  # [m] of each
    pressure: float  # [Pa] at the nozzles, above the ambient
    height: float = math.nan  # [m] of the lowest over the track; NaN: as `heights` says
    count: int = 1

    @property
    def thrust(self):
        """Thrust [N] of one."""
        return thrust(self.diameter, self.pressure)

    def heights(self, every):
        """Return their heights [m] over the track, (N,), upwards.

        Where nothing is said of it, one nozzle blows at the lowest centre of mass. Several blow where each
        orientation has something before its centre of mass, as far as they are enough for that; the others
        are spread between those and the top of the tallest.
        """
        low, top = self.height, max(one.height for one in every)
        if math.isnan(low) and self.count > 1:
            met = _meeting([_solid_at_middle(one) for one in every], 0.5 * self.diameter)
            if len(met) <= self.count:
                return _spread(met, top, self.count)
        if math.isnan(low):
            low = max(min(one.posture.height for one in every), 0.5 * self.diameter)
        high = max(top - low, low)
        return np.linspace(low, high, self.count) if high > low else np.full(self.count, low)

    def force(self, one, every):
        """Return the force [N] on an orientation whose centre of mass is before them."""
        return self.thrust * sum(self.share(one, height) for height in self.heights(every))

    def share(self, one, height):
        """Return the share of the jet at a height [m] that an orientation takes."""
        radius = 0.5 * self.diameter + SPREAD * max(one.distance - 0.5 * one.width, 0.0)
        disc = shapely.Point(0.0, height).buffer(radius)
        return float(one.aside.intersection(disc).area / disc.area)

    def jets(self, place, every, seconds=math.inf):
        """Return their Jets at a place [m] along the device."""
        return tuple(
            Jet((place, 0.0, height), ACROSS, 0.5 * self.diameter, SPREAD, self.thrust, REACH, seconds)
            for height in self.heights(every)
        )


def _solid_at_middle(one):
    """From which height [m] to which the lowest goes that an orientation has at its centre of mass."""
    upright = shapely.LineString([(0.0, -one.height), (0.0, 2.0 * one.height)])
    spans = [piece.bounds for piece in shapely.get_parts(one.aside.intersection(upright))]
    return min(((span[1], span[3]) for span in spans), default=(0.0, one.height))


def _meeting(spans, radius):
    """Return the fewest heights [m] of which each span (low, high) has one, a radius within its ends."""
    found = []
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
