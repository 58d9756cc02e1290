"""Where the track runs: round the wall as a helix of one climb, then straight on along its tangent.

Where the wall steps outwards with the track, the track's foot is a helix on a cone: its radius grows by
``flare`` over its length, and so does its height, by the climb.
"""

from dataclasses import dataclass

import numpy as np
import shapely


@dataclass(frozen=True, eq=False)
class Way:
    """The foot of the wall as a line in space, and the track inwards of it.

    Lengths s [m] run along the wall from where the track leaves the floor, distances y [m] from the wall
    along the track's surface. Seen from above parts travel counter-clockwise about the Z axis and leave
    where the outlet begins, at the angle 0.
    """

    radius: float  # [m] of the wall's inner face where the outlet begins
    climb: float  # [rad]
    bank: float  # [rad] down towards the wall, where it begins
    end: float  # [m] s where the outlet begins: from there on the way is straight and level
    drops: tuple[tuple[float, float], ...] = ()  # s of each step of the track and its height [m]
    bends: tuple[tuple[float, float], ...] = ()  # s from which the track climbs otherwise, and how [rad]
    flare: float = 0.0  # [1] by which the wall's radius grows over s
    leans: tuple[tuple[float, float, float], ...] = ()  # from and to s it twists to another bank [rad]

    def wall_radius(self, s):
        """Return the radius [m] of the wall's inner face at lengths s."""
        return self.radius + self.flare * (np.minimum(s, self.end) - self.end)

    def at(self, theta):
        """Return the lengths s at angles about the axis, at most 0."""
        theta = np.asarray(theta, float)
        if self.flare == 0.0:
            return self.end + self.radius * theta
        return self.end + self.radius * np.expm1(self.flare * theta) / self.flare

    def angle(self, s):
        """Return the angle [rad] about the axis at lengths s; it stays at 0 along the outlet."""
        before = (np.minimum(s, self.end) - self.end) / self.radius
        return before if self.flare == 0.0 else np.log1p(self.flare * before) / self.flare

    def bank_at(self, s):
        """Return the bank [rad] at lengths s."""
        banks = [self.bank, *(bank for _, _, bank in self.leans)]
        found = np.full(np.shape(s), float(self.bank))
        for (start, end, bank), before in zip(self.leans, banks):
            found = found + (bank - before) * np.clip((s - start) / (end - start), 0.0, 1.0)
        return found

    @property
    def least_bank(self):
        """The least bank [rad] anywhere: there the track is widest, seen from above."""
        return min([self.bank, *(bank for _, _, bank in self.leans)])

    def rises(self, width):
        """Return the length s [m], at most 0, at which a track of a width first comes out of the floor.

        Its free edge is the first on a banked track, and does so before the wall's side.
        """
        return -width * np.sin(self.bank) / np.tan(self.climb)

    def plan(self, s, y):
        """Return the places (..., 2) [m] from above at lengths s and distances y."""
        s, y = np.broadcast_arrays(np.asarray(s, float), np.asarray(y, float))
        theta, straight = self.angle(s), np.maximum(s - self.end, 0.0)
        r, c, sn = self.wall_radius(s) - y * np.cos(self.bank_at(s)), np.cos(theta), np.sin(theta)
        return np.stack([r * c - straight * sn, r * sn + straight * c], axis=-1)

    def height(self, s, y=0.0):
        """Return the height [m] of the track's surface over the floor's edge at lengths s, distances y."""
        s = np.asarray(s, float)
        fallen = sum((np.where(s >= at, drop, 0.0) for at, drop in self.drops), np.zeros(s.shape))
        return self.risen(np.minimum(s, self.end)) - fallen + np.sin(self.bank_at(s)) * np.asarray(y)

    def risen(self, s):
        """Return by how much [m] the track climbs up to lengths s, its steps down left out."""
        climbs = [self.climb, *(climb for _, climb in self.bends)]
        found = np.tan(self.climb) * s
        for (at, climb), before in zip(self.bends, climbs):
            found = found + (np.tan(climb) - np.tan(before)) * np.maximum(s - at, 0.0)
        return found

    @property
    def highest(self):
        """Greatest height [m] of the track by the wall, its steps down left out."""
        return float(max(self.risen(at) for at in (*(at for at, _ in self.bends), self.end)))

    @property
    def lowest(self):
        """Least height [m] from the first other climb on."""
        ends = [*(at for at, _ in self.bends), *(at for at, _ in self.drops), self.end]
        return float(min(self.height(at) for at in ends))

    def places(self, s, y):
        """Return points (..., 3) [m] of the track's surface."""
        flat = self.plan(s, y)
        z = np.broadcast_to(self.height(s, y), flat.shape[:-1])
        return np.concatenate([flat, z[..., None]], axis=-1)

    def laid(self, ring, chord):
        """Return a ring (K, 2) [m] of lengths and distances as a polygon seen from above.

        Parameters
        ----------
        ring : (K, 2) float [m]
        chord : float [m]
            By which an arc may be seen too flat.

        Returns
        -------
        shapely geometry [m]
        """
        border = shapely.linestrings(np.vstack([ring, ring[:1]]))
        fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(4.0 * self.radius * chord)))[:-1]
        return shapely.make_valid(shapely.Polygon(self.plan(fine[:, 0], fine[:, 1])))
