"""The formulas of the rules: published ones of a face's geometry, surface-weighted and exact tumbling.

A published rule gives the weight of a class of ``faces`` equal aspects; `normalise` makes probabilities of
them. Surface weights lie between dead landings and violent ones. In a cascade of hops a bouncing part loses
energy until it can cross no saddle.
"""

from collections.abc import Sequence

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Array, Bools, Floats, Ints
from feederscrew.resting.barriers import Tipping, critical_solid_angles
from feederscrew.resting.faces import Face


def pmi(faces: Array, polar_inertia: Floats, height: Floats) -> Floats:
    """Return polar moment of inertia over height: the thesis's rule, eq. [section 3.1].

        w = n I / h

    Parameters
    ----------
    faces : (A,) int
        n, equal aspects in the class. Tables 3-8 and 3-9 count each class once.
    polar_inertia : (A,) float [kg m2]
        I about the aspect's normal through the centre of mass.
    height : (A,) float [m]
        h of the centre of mass over the aspect.

    Returns
    -------
    (A,) float [kg m]
        Weights, not normalised.
    """
    return faces * polar_inertia / height


def csa(faces: Array, solid_angle: Floats, height: Floats) -> Floats:
    """Return centroid solid angle over height, eq. [Table 3-2].

        w = n Q / h

    Parameters
    ----------
    faces : (A,) int
        n, as in ``pmi``.
    solid_angle : (A,) float [sr]
        Q of one face, seen from the centre of mass.
    height : (A,) float [m]
        h.

    Returns
    -------
    (A,) float [sr/m]

    References
    ----------
    B. K. A. Ngoi, L. E. N. Lim, S. S. G. Lee, J. Electronics Manufacturing 5(3), 1995.
    """
    return faces * solid_angle / height


def stability(faces: Array, contact_area: Floats, height: Floats) -> Floats:
    """Return contact area over height, eq. [Table 3-3].

        w = n A / h

    Parameters
    ----------
    faces : (A,) int
        n, as in ``pmi``.
    contact_area : (A,) float [m2]
        A of one face.
    height : (A,) float [m]
        h.

    Returns
    -------
    (A,) float [m]

    References
    ----------
    P. S. K. Chua, M. L. Tay, "Modelling the natural resting aspect of small regular shaped parts", J.
    Manufacturing Science and Engineering 120(3), 1998.
    """
    return faces * contact_area / height


def normalise(weights: Floats, stable: Bools) -> Floats:
    """Return the probabilities of the stable aspects from their weights; the others have none.

        p_i = w_i / sum over the stable j of w_j

    Parameters
    ----------
    weights : (A,) float [any one unit]
    stable : (A,) bool

    Returns
    -------
    (A,) float [1]
        They sum to 1; NaN throughout where a weight is not known, or none is above 0.

    References
    ----------
    docs/resting.md, "How were the parts launched?".
    """
    weights = np.where(stable, weights, 0.0)
    total = weights.sum()
    return weights / (total if total != 0.0 else np.nan)


EXPONENTS = {"soft": 0.0, "medium": 1.2, "hard": 2.0}  # [1] by what the part lands on
"""Soft: dead landings, exact quasi-static tumbling. Medium and hard: what drop simulations of restitution
0.5 and of tumbling launches on a hard plane follow; 2 was chosen with measured cuboids in view."""


def surface_name(exponent: float) -> str:
    """Return the surface of an exponent, 'hard'; 'exponent 1.5' where it has no name."""
    names = {value: name for name, value in EXPONENTS.items()}
    return names.get(exponent, f"exponent {exponent:g}")


def surface_weights(shares: Floats, heights: Floats, radius: float, exponent: float) -> Floats:
    """Return the shares of a part that bounces before it settles, not normalised.

        w = share (1 - height / radius)^exponent

    A bouncing part visits every face and stays where it lies deep. Where radius - height is nearly zero for
    all faces (a nearly round body) the weight means nothing.

    Parameters
    ----------
    shares : (F,) float [1]
        Quasi-static probabilities.
    heights : (F,) float [m]
        Of the centre of mass on each face; NaN where the share is zero.
    radius : float [m]
        Largest distance from the centre of mass to a corner.
    exponent : float [1]
        0 for a dead landing; larger for harder surfaces and livelier launches.

    Returns
    -------
    (F,) float [1]

    Raises
    ------
    ValueError
        If the exponent is not finite or the radius not positive.

    References
    ----------
    Own; docs/resting.md, "Surface-weighted tumbling".
    """
    radius, exponent = check.positive("radius", radius), float(exponent)
    if not np.isfinite(exponent):
        raise ValueError(f"exponent is {exponent}, not a finite number")
    depth = np.clip(1.0 - np.asarray(heights, float) / radius, np.finfo(float).tiny, 1.0)
    return np.where(np.asarray(shares) > 0.0, shares * depth**exponent, 0.0)


def surface_shares(shares: Floats, heights: Floats, radius: float, exponent: float) -> Floats:
    """Return ``surface_weights`` that sum to 1.

    Parameters
    ----------
    shares : (F,) float [1]
    heights : (F,) float [m]
    radius : float [m]
    exponent : float [1]

    Returns
    -------
    (F,) float [1]

    References
    ----------
    Own; docs/resting.md, "Surface-weighted tumbling".
    """
    weights = surface_weights(shares, heights, radius, exponent)
    return weights / weights.sum()


# A hop keeps at most the share u of its energy with probability u^KEPT_ENERGY_EXPONENT: a fifth on average.
KEPT_ENERGY_EXPONENT = 0.25
HOP_BLOCK_SIZE = 1 << 16  # ways times levels at a time
ENERGY_LEVELS = 200  # of energy, between the part's highest way to stand and the lowest saddle


def quasistatic(tips: Tipping) -> Floats:
    """Return the share of the attitudes from which a part let go without speed ends on each face.

    Parameters
    ----------
    tips : Tipping

    Returns
    -------
    (F,) float [1]

    References
    ----------
    docs/resting.md, "Exact tumbling".
    """
    return tips.shares


def critical(faces: Sequence[Face]) -> Floats:
    """Return the critical solid angle of each face over its height.

    Parameters
    ----------
    faces : sequence of Face
        A rolling one counts by its lowest strip.

    Returns
    -------
    (F,) float [sr/m]

    References
    ----------
    As of ``critical_solid_angles``.
    """
    heights, solid_angles = (
        np.array([getattr(face, name) for face in faces]) for name in ("height", "solid_angle")
    )
    shares = critical_solid_angles([face.polygon for face in faces], heights)
    return shares * solid_angles / heights


def hop_shares(tips: Tipping, radius: float) -> Floats:
    """Return the shares in which hops of falling energy leave a part on its faces.

    Energies e are heights, h those of the faces, t those of the saddles, A the shares of the basins. A hop of
    energy e from face i ends on i or on a neighbour j whose saddle lies below e, with the weights

        A_i (e - h_i)   and   A_j (e - h_j) (e - t_ij) / (e - h_i)

    that is, the room a face offers at that energy times the share of the hops that are high enough. Then the
    part keeps a random share of its energy over the face it is on; once no saddle lies below, it stays. Deep
    faces hold the part, high and shallow ones pass it on.

    ``KEPT_ENERGY_EXPONENT`` and the powers of one were chosen by eye: docs/resting.md says on what data, and
    ``benchmarks/accuracy.py`` compares.

    Parameters
    ----------
    tips : Tipping
    radius : float [m]
        Largest distance from the centre of mass to a corner: the energy, as a height, at which every attitude
        is open and the cascade begins.

    Returns
    -------
    (F,) float [1]
        They sum to 1; zero for faces without a sink.

    Raises
    ------
    ValueError
        If the radius is not positive.

    References
    ----------
    Own; docs/resting.md, "The cascade of hops".
    """
    present = np.flatnonzero(np.isfinite(tips.heights) & (tips.shares > 0.0))
    between = np.isin(tips.pairs, present).all(axis=1)
    pairs = np.searchsorted(present, tips.pairs[between])
    tops, radius = tips.tops[between], check.positive("radius", radius)
    ended = _cascade(tips.shares[present], tips.heights[present] / radius, pairs, tops / radius)
    shares = np.zeros(len(tips.shares))
    shares[present] = ended / ended.sum() if ended.any() else tips.shares[present]  # a ball has no room
    return shares


def _cascade(shares: Floats, heights: Floats, pairs: Ints, tops: Floats) -> Floats:
    """Return the share (F,) [1] of the parts that ends on each face; lengths in units of the radius."""
    if not len(tops):
        return shares
    levels = np.linspace(1.0, tops.min(), ENERGY_LEVELS + 1)
    lowest = np.full(len(shares), np.inf)
    np.minimum.at(lowest, pairs.ravel(), np.repeat(tops, 2))
    # W directed ways a hop can go, those of each face to itself among them
    own, both = np.arange(len(shares)), np.concatenate([tops, tops])
    start = np.concatenate([pairs[:, 0], pairs[:, 1], own])
    end = np.concatenate([pairs[:, 1], pairs[:, 0], own])

    def way_parts(energies: Floats) -> Floats:
        """Return the part (K, W) of the mass at its start that goes each way in a hop of each energy (K,)."""
        depth = np.maximum(energies[:, None] - heights, np.finfo(float).eps)
        rates = (shares * depth)[:, end]
        high = np.maximum(energies[:, None] - both, 0.0)  # of the hops, those high enough
        rates[:, : len(both)] *= high / depth[:, start[: len(both)]]
        starts = start + len(shares) * np.arange(len(energies))[:, None]
        total = np.bincount(starts.ravel(), rates.ravel(), minlength=depth.size)
        return rates / total[starts]

    def carry(mass: Floats, part: Floats) -> Array:
        return np.bincount(end, mass[start] * part, minlength=len(mass))

    below = np.maximum(levels[:, None] - heights, 0.0) ** KEPT_ENERGY_EXPONENT  # of what is kept, up to each
    energies, retained, sinking = 0.5 * (levels[:-1] + levels[1:]), below[:-1] - below[1:], below[1:] > 0.0
    reach, moves = np.where(sinking, below[1:], np.inf), energies[:, None] > lowest
    density = carry(shares, way_parts(np.ones(1))[0]) / np.maximum(below[0], np.finfo(float).tiny)
    before, sunk = np.empty(retained.shape), np.zeros(len(shares))
    step = max(1, HOP_BLOCK_SIZE // len(start))
    for some in (slice(k, k + step) for k in range(0, ENERGY_LEVELS, step)):
        parts = way_parts(energies[some]) * (retained * moves)[some, start]
        for k, part in enumerate(parts / reach[some, end], some.start):
            before[k] = density
            density = density + carry(density, part)
        lost = before[some, start] * parts * ~sinking[some, end]
        sunk += np.bincount(end, lost.sum(axis=0), minlength=len(shares))
    return (before * retained * ~moves).sum(axis=0) + sunk + density * below[-1]
