"""Direction in which leaf springs move a bowl, over its radius.

Source: a rigid bowl on inclined leaves moves as a screw; docs/bowl.md, "How it is computed".
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.bowl.record import Machine

RIGHT_ANGLE_RAD = 0.5 * np.pi  # [rad] upright


def direction(machine: Machine, radius: ArrayLike) -> Any:
    """Return the angle of the bowl's motion to the horizontal.

    Source: docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine
    radius : array_like [m]
        From the bowl's axis.

    Returns
    -------
    array_like [rad]
        tan psi(r) = tan psi_s (r_s / r) [m2 / (m1 + m2)] / [I2 / (I1 + I2)], of the shape of ``radius``.

    Notes
    -----
    The springs fix the direction of the bowl against its base. Momentum fixes how much of it the bowl takes:
    m2 / (m1 + m2) of the rise and I2 / (I1 + I2) of the turn.
    """
    rise, turn = shares(machine)
    along = machine.spring_radius * rise * np.sin(machine.spring_angle)
    return np.arctan2(along, np.asarray(radius) * turn * np.cos(machine.spring_angle))


def shares(machine: Machine) -> tuple[float, float]:
    """Return the bowl's shares of the rise and of the turn between bowl and base [1].

    Source: the bowl and its base keep their momentum; docs/bowl.md, "How it is computed".
    """
    rise = machine.base_mass / (machine.bowl_mass + machine.base_mass)
    return rise, machine.base_inertia / (machine.bowl_inertia + machine.base_inertia)


def vibration_angle(machine: Machine, radius: ArrayLike, climb: ArrayLike) -> Any:
    """Return the angle from the track to the bowl's motion [rad], within 0 to 90 deg.

    Source: docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine
    radius, climb : array_like [m], [rad]
        Of the track.
    """
    return np.clip(direction(machine, radius) - climb, 0.0, RIGHT_ANGLE_RAD)
