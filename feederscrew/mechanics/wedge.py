"""A banked track with an upright wall, as a level track of another friction.

The bowl moves along the tangent of its track and along its own axis, whatever the bank: so the drive, the
weight and every impact press a part down square to the tangent, and floor and wall share that. Per unit of it
the floor carries 1 / cos(bank) and an upright wall tan(bank), at every instant of the cycle; both press at
the same times, and a part leaves both at once. Left out is the centripetal force.

Source: the balance of forces in a wedge with Coulomb's friction; docs/conveying.md.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.bowl.record import Friction


def effective(friction, wall, bank) -> Any:
    """Return the friction of the level track that holds a part as floor and wall together do.

    Source: docs/conveying.md, "The model".

    Parameters
    ----------
    friction, wall : array_like [1]
        Coefficients of the floor and of the upright wall.
    bank : array_like [rad]
        Less than a quarter turn.

    Returns
    -------
    array [1]
        friction / cos(bank) + wall tan(bank).
    """
    return friction / np.cos(bank) + wall * np.tan(bank)


def of_floor(friction, wall, bank) -> Any:
    """Return the coefficient of the floor that makes, with the wall, an effective one: the inverse [1].

    Source: ``effective`` solved for the floor.
    """
    return friction * np.cos(bank) - wall * np.sin(bank)


def level(bowl) -> Any:
    """Return a bowl without bank on which a part travels as in this one.

    Parameters
    ----------
    bowl : Bowl
        Its fields may be arrays that broadcast together.

    Returns
    -------
    Bowl
        With the effective friction, of rest and of sliding, up and down the track.
    """
    mu, bank = bowl.friction, bowl.track.bank
    held = (effective(coefficient, mu.wall, bank) for coefficient in (mu.static, mu.kinetic, *mu.backward))
    static, kinetic, static_back, kinetic_back = held
    surfaces = Friction(static, kinetic, mu.wall, static_back, kinetic_back)
    return replace(bowl, friction=surfaces, track=replace(bowl.track, bank=0.0 * bank))
