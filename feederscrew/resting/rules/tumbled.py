"""Rules of exact tumbling: the basin itself, the critical solid angle of a face, and a cascade of hops.

In the cascade a bouncing part loses energy until it can cross no saddle.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.resting.basins.barriers import critical_solid_angles

# A hop keeps at most the share u of its energy with probability u^KEPT_ENERGY_EXPONENT: a fifth on average.
KEPT_ENERGY_EXPONENT = 0.25
HOP_BLOCK_SIZE = 1 << 16  # ways times levels at a time
ENERGY_LEVELS = 200  # of energy, between the part's highest way to stand and the lowest saddle


def quasistatic(tips) -> NDArray[np.float64]:
    """Return the share of the attitudes from which a part let go without speed ends on each face.

    Source: docs/resting.md, "Exact tumbling".

    Parameters
    ----------
    tips : Tipping

    Returns
    -------
    (F,) float [1]
    """
    return tips.shares


def critical(faces) -> NDArray[np.float64]:
    """Return the critical solid angle of each face over its height; of a rolling one, from its lowest strip.

    Parameters
    ----------
    faces : sequence of Face
        F faces.

    Returns
    -------
    (F,) float [sr/m]

    References
    ----------
    As in `critical_solid_angles`.
    """
    heights, solid_angles = (
        np.array([getattr(face, name) for face in faces]) for name in ("height", "solid_angle")
    )
    shares = critical_solid_angles([face.polygon for face in faces], heights)
    return shares * solid_angles / heights


def hop_shares(tips, radius) -> NDArray[np.float64]:
    """Return the shares in which hops of falling energy leave a part on its faces.

    Source: own; docs/resting.md, "The cascade of hops".

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

    KEPT_ENERGY_EXPONENT and the powers of one were chosen by eye: docs/resting.md says on what,
    ``benchmarks/accuracy.py`` compares.
    """
    present = np.flatnonzero(np.isfinite(tips.heights) & (tips.shares > 0.0))
    between = np.isin(tips.pairs, present).all(axis=1)
    pairs = np.searchsorted(present, tips.pairs[between])
    tops, radius = tips.tops[between], check.positive("radius", radius)
    ended = _cascade(tips.shares[present], tips.heights[present] / radius, pairs, tops / radius)
    shares = np.zeros(len(tips.shares))
    shares[present] = ended / ended.sum() if ended.any() else tips.shares[present]  # a ball has no room
    return shares


def _cascade(shares, heights, pairs, tops) -> NDArray[np.float64]:
    """(F,) where the parts end; lengths in units of the radius."""
    if not len(tops):
        return shares
    levels = np.linspace(1.0, tops.min(), ENERGY_LEVELS + 1)
    lowest = np.full(len(shares), np.inf)
    np.minimum.at(lowest, pairs.ravel(), np.repeat(tops, 2))
    hops = _Hops(shares, heights, pairs, tops)
    below = (
        np.maximum(levels[:, None] - heights, 0.0) ** KEPT_ENERGY_EXPONENT
    )  # of what is kept, up to each level
    energies, retained, sinking = 0.5 * (levels[:-1] + levels[1:]), below[:-1] - below[1:], below[1:] > 0.0
    reach, moves = np.where(sinking, below[1:], np.inf), energies[:, None] > lowest
    density = hops.moved(shares, hops.parts(np.ones(1))[0]) / np.maximum(below[0], np.finfo(float).tiny)
    before, sunk = np.empty(retained.shape), np.zeros(len(shares))
    step = max(1, HOP_BLOCK_SIZE // len(hops.start))
    for some in (slice(k, k + step) for k in range(0, ENERGY_LEVELS, step)):
        parts = hops.parts(energies[some]) * (retained * moves)[some, hops.start]
        for k, part in enumerate(parts / reach[some, hops.end], some.start):
            before[k] = density
            density = density + hops.moved(density, part)
        lost = before[some, hops.start] * parts * ~sinking[some, hops.end]
        sunk += np.bincount(hops.end, lost.sum(axis=0), minlength=len(shares))
    return (before * retained * ~moves).sum(axis=0) + sunk + density * below[-1]


class _Hops:
    """Which faces a hop can end on; W directed ways, those of each face to itself among them."""

    def __init__(self, shares, heights, pairs, tops) -> None:
        own = np.arange(len(shares))
        self.shares, self.heights, self.tops = shares, heights, np.concatenate([tops, tops])
        self.start = np.concatenate([pairs[:, 0], pairs[:, 1], own])
        self.end = np.concatenate([pairs[:, 1], pairs[:, 0], own])

    def parts(self, energies) -> NDArray[np.float64]:
        """(K, W) part of the mass at its start that goes each way in a hop of each energy (K,)."""
        depth = np.maximum(energies[:, None] - self.heights, np.finfo(float).eps)
        rates, between = (self.shares * depth)[:, self.end], slice(0, len(self.tops))
        high = np.maximum(energies[:, None] - self.tops, 0.0)  # of the hops, those high enough
        rates[:, between] *= high / depth[:, self.start[between]]
        starts = self.start + len(self.shares) * np.arange(len(energies))[:, None]
        total = np.bincount(starts.ravel(), rates.ravel(), minlength=depth.size)
        return rates / total[starts]

    def moved(self, mass, parts) -> NDArray[Any]:
        """(F,) mass after one hop."""
        return np.bincount(self.end, mass[self.start] * parts, minlength=len(mass))
