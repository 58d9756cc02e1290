"""The part on the floor for arrays of settings: what the maps of Figures 5-6 and 5-7 show."""

from dataclasses import replace

import numpy as np

from feederscrew.mechanics import limits
from feederscrew.mechanics.floor import balance
from feederscrew.mechanics.floor.balance import HOP, STATES
from feederscrew.mechanics.published import floor as published_floor

REGIMES = STATES  # a regime code is a place in this list


def over_angle_and_friction(posture, bowl, heading, vibration_angle, friction):
    """Return the upper reversal over (beta, mu), as Figure 5-6.

    Parameters
    ----------
    posture : Posture
    bowl : Bowl
        Its vibration angle and friction are replaced.
    heading : float [rad]
        theta.
    vibration_angle, friction : array_like [rad, 1]
        That broadcast together; one friction for sticking and sliding.

    Returns
    -------
    dict of str to array
        As ``cells``.
    """
    varied = replace(bowl, drive=replace(bowl.drive, vibration_angle=vibration_angle))
    return cells(posture, balance.with_friction(varied, friction), heading)


def over_frequency_and_amplitude(posture, bowl, heading, frequency, amplitude):
    """Return the upper reversal over (f, A), as Figure 5-7.

    Parameters
    ----------
    posture, bowl, heading
        As above; the bowl's frequency and amplitude are replaced.
    frequency, amplitude : array_like [Hz, m]
        That broadcast together.

    Returns
    -------
    dict of str to array
        As ``cells``.
    """
    drive = replace(bowl.drive, frequency=frequency, amplitude=amplitude)
    return cells(posture, replace(bowl, drive=drive), heading)


def cells(posture, bowl, heading):
    """Return the upper reversal for arrays of bowl settings.

    Parameters
    ----------
    posture : Posture
    bowl : Bowl
        Fields may be arrays.
    heading : array_like [rad]
        theta.

    Returns
    -------
    dict of str to array
        ``acceleration_z_m_s2`` V'_z, NaN where the part has lost contact; ``published_z_m_s2`` the printed
        formula, which goes on there; ``alignment_acceleration_rad_s2``; ``throw_number``, above 1 where it
        hops; 'regime', places in ``REGIMES``.
    """
    found = balance.motion(posture, bowl, heading)
    printed = published_floor.motion(posture, bowl, heading)
    contact = found.state != HOP
    ratio = limits.acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity)
    return {
        "acceleration_z_m_s2": np.where(contact, found.acceleration[..., 0], np.nan),
        "published_z_m_s2": printed.acceleration[..., 0],
        "alignment_acceleration_rad_s2": np.where(contact, found.turning, np.nan),
        "published_alignment_rad_s2": printed.turning,
        "throw_number": limits.throw_number(ratio, bowl.drive.vibration_angle),
        "regime": found.state,
    }
