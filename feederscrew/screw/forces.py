"""Poinsot's reduction: any system of forces and couples is one wrench."""

import numpy as np

from feederscrew.screw.point import ORIGIN, length, vectors
from feederscrew.screw.screws import Wrench


def poinsot(forces, points, couples=None, reference=ORIGIN):
    """Return the one wrench a system of forces and couples amounts to.

    Its ``axis``, ``pitch`` and ``magnitude`` are the line, the couple per force and the force;
    ``reduced()`` expresses it on that line.

    Parameters
    ----------
    forces : (..., K, 3) float [N]
        K forces of each system.
    points : (..., K, 3) float [m]
        Where each acts.
    couples : (..., J, 3) float [N m], optional
        Free couples of each system, any number.
    reference : Point
        Where the wrench is to be expressed.

    Returns
    -------
    Wrench of shape (...,)
        Forces that cancel up to the rounding of their own sum give a pure couple, not a tiny force far away.

    Raises
    ------
    ValueError
        If a shape is wrong or an entry is not finite.

    References
    ----------
    L. Poinsot, "Elements de statique", Paris, 1803.
    """
    forces, points = vectors("forces", forces), vectors("points", points)
    if forces.ndim < 2 or points.ndim < 2:
        raise ValueError("forces and points need an axis that counts them: (..., K, 3)")
    levers = points - reference.coordinates[..., None, :]
    moment = np.cross(levers, forces).sum(axis=-2)
    if couples is not None:
        moment = moment + vectors("couples", couples).sum(axis=-2)
    return Wrench(_sum_above_rounding(forces), moment, reference)


def _sum_above_rounding(forces):
    """Their sum, exactly zero where it is no longer than the rounding error of adding them up."""
    total = forces.sum(axis=-2)
    rounding = forces.shape[-2] * np.finfo(float).eps * length(forces).sum(axis=-1)
    return np.where((length(total) <= rounding)[..., None], 0.0, total)
