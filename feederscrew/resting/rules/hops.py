"""A cascade of hops: a bouncing part wanders over the saddles until its energy lets it over none."""

from functools import partial

import numpy as np

from feederscrew import check

KEPT = 0.25  # [1] a hop keeps at most the share u of its energy with probability u^KEPT: a fifth on average
BLOCK = 1 << 16  # ways times levels at a time
LEVELS = 200  # of energy, between the part's highest way to stand and the lowest saddle


def hop_shares(tips, radius):
    """Return the shares in which hops of falling energy leave a part on its faces.

    Parameters
    ----------
    tips : Tipping
    radius : float [m]
        Largest distance from the centre of mass to a corner: the energy, as a height, at which every
        attitude is open and the cascade begins.

    Returns
    -------
    (F,) float [1]
        Sums to 1; zero for faces without a sink.

    Raises
    ------
    ValueError
        If the radius is not positive.

    Notes
    -----
    Energies e are heights, h those of the faces, t those of the saddles, A the shares of the basins. A
    hop of energy e from face i ends on i or on a neighbour j whose saddle lies below e, with weights
    A_i (e - h_i) and A_j (e - h_j) (e - t_ij) / (e - h_i): the room a face offers at that energy, times the
    share of the hops that are high enough. Then the part keeps a random share of its energy over the
    face it is on, and once no saddle lies below, it stays. Deep faces hold what comes, high and shallow
    ones pass it on.

    KEPT and the powers of one were chosen by eye: docs/resting.md says on what, ``benchmarks/accuracy.py``
    compares.
    """
    present = np.flatnonzero(np.isfinite(tips.heights) & (tips.shares > 0.0))
    ways = np.isin(tips.pairs, present).all(axis=1)
    pairs = np.searchsorted(present, tips.pairs[ways])
    tops, radius = tips.tops[ways], check.positive("radius", radius)
    ended = _cascade(tips.shares[present], tips.heights[present] / radius, pairs, tops / radius)
    shares = np.zeros(len(tips.shares))
    shares[present] = ended / ended.sum() if ended.any() else tips.shares[present]  # a ball has no room
    return shares


def _cascade(shares, heights, pairs, tops):
    """(F,) where the parts end; lengths in units of the radius."""
    if not len(tops):
        return shares
    levels = np.linspace(1.0, tops.min(), LEVELS + 1)
    lowest = np.full(len(shares), np.inf)
    np.minimum.at(lowest, pairs.ravel(), np.repeat(tops, 2))
    start, end = np.concatenate([pairs, pairs[:, ::-1]]).T
    over = _Ways(shares, heights, start, end, np.concatenate([tops, tops]))
    below = np.maximum(levels[:, None] - heights, 0.0) ** KEPT  # of what is kept, up to each level
    room = np.maximum(below[0], np.finfo(float).tiny)
    density, ended = next(over.hops(np.ones(1)))(shares) / room, np.zeros(len(shares))
    energies, kept = 0.5 * (levels[:-1] + levels[1:]), below[:-1] - below[1:]
    stays, sinking = energies[:, None] <= lowest, below[1:] > 0.0
    reach = np.where(sinking, below[1:], np.inf)
    stays, moves, sunk = 1.0 * stays, 1.0 * ~stays, 1.0 * ~sinking
    for k, hop in enumerate(over.hops(energies)):
        mass = density * kept[k]
        moving = hop(mass * moves[k])
        density += moving / reach[k]
        ended += mass * stays[k]
        ended += moving * sunk[k]
    return ended + density * below[-1]


class _Ways:
    """Which faces a hop can reach; W directed ways."""

    def __init__(self, shares, heights, start, end, tops):
        self.shares, self.heights, self.start, self.end, self.tops = shares, heights, start, end, tops

    def hops(self, energies):
        """Yield for each energy a function from the mass (F,) on the faces to that after one hop."""
        step = max(1, BLOCK // len(self.start))
        for some in (energies[k : k + step, None] for k in range(0, len(energies), step)):
            for room, rate, total in zip(*self._rates(some)):
                yield partial(self._hop, room=room, rate=rate, total=total)

    def _rates(self, energies):
        """Room of each face, rate of each way, and their sums at each start; energies (K, 1)."""
        depth = np.maximum(energies - self.heights, np.finfo(float).eps)
        room = self.shares * depth
        rate = room[:, self.end] * np.maximum(energies - self.tops, 0.0) / depth[:, self.start]
        starts = self.start + len(self.shares) * np.arange(len(energies))[:, None]
        led = np.bincount(starts.ravel(), rate.ravel(), minlength=room.size)
        return room, rate, room + led.reshape(room.shape)

    def _hop(self, mass, room, rate, total):
        each = mass / total
        return each * room + np.bincount(self.end, each[self.start] * rate, minlength=len(mass))
