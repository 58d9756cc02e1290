"""The part on the floor for arrays of settings: what the maps of Figures 5-6 and 5-7 show."""

from typing import Any

import numpy as np

from feederscrew.mechanics import limits
from feederscrew.mechanics.floor import balance
from feederscrew.mechanics.floor.balance import HOP, MOTION_STATES

FLOOR_REGIMES = MOTION_STATES  # a regime code is a place in this list


def cells(posture, bowl, heading) -> dict[Any, Any]:
    """Return the upper reversal for arrays of bowl settings.

    Source: ``balance.motion``, cell by cell.

    Parameters
    ----------
    posture : Posture
    bowl : Bowl
        Fields may be arrays.
    heading : array_like [rad]
        theta.

    Returns
    -------
    dict of str to array [SI, as each name says]
        ``acceleration_z_m_s2`` V'_z, NaN where the part has lost contact; ``alignment_acceleration_rad_s2``;
        ``throw_number``, above 1 where it hops; 'regime', places in ``FLOOR_REGIMES``.
    """
    motion = balance.motion(posture, bowl, heading)
    contact = motion.state != HOP
    ratio = limits.acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity)
    return {
        "acceleration_z_m_s2": np.where(contact, motion.acceleration[..., 0], np.nan),
        "alignment_acceleration_rad_s2": np.where(contact, motion.turning, np.nan),
        "throw_number": limits.throw_number(ratio, bowl.drive.vibration_angle),
        "regime": motion.state,
    }
