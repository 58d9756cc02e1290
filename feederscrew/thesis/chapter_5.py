"""The numbers of Figures 5-1 to 5-7."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.mechanics import limits

GRAVITY = 9.8  # [m/s2] as chapter 5 has it
FREQUENCY = 60.0  # [Hz] Figure 5-6
AMPLITUDE = 0.5e-3  # [m] Figure 5-6
BETA = np.radians(20.0)  # Figure 5-7
FRICTION = 0.5  # Figure 5-7
BETAS_OF_5_1 = (10.0, 20.0, 30.0, 40.0)  # [deg]
BETA_OF = {"5-2": 10.0, "5-3": 20.0, "5-4": 40.0, "5-5": 10.0}  # [deg]
RATIOS = np.linspace(0.0, 1.0, 51)  # G; the printed axis is lost, and nothing hops up to here
ANGLES = np.radians(np.linspace(-90.0, 90.0, 61))  # alpha - theta


@dataclass(frozen=True, eq=False)
class Curves:
    """Figure 5-1."""

    ratios: np.ndarray  # (N,) G
    limits: dict[float, np.ndarray]  # (N,) limiting friction by beta [deg]


@dataclass(frozen=True, eq=False)
class FigureGrid:
    """A value over two parameters."""

    x: np.ndarray  # (N,)
    y: np.ndarray  # (M,)
    values: np.ndarray  # (M, N)
    throw: np.ndarray  # (M, N) [1] throw number: contact is lost from 1 on

    @property
    def hops(self):
        """(M, N) bool, contact is lost."""
        return self.throw >= 1.0 - limits.ROUNDING


def figure_5_1():
    """Return limiting friction over G for alpha = theta, eq. [4.28]."""
    betas = {beta: limits.published_limit(RATIOS, np.radians(beta)) for beta in BETAS_OF_5_1}
    return Curves(RATIOS, betas)


def limit_surface(number):
    """Return limiting friction over (alpha - theta, G), eq. [4.27].

    Parameters
    ----------
    number : str
        '5-2' to '5-5'.

    Returns
    -------
    FigureGrid
        x is alpha - theta [rad], y is G.
    """
    beta = np.radians(BETA_OF[number])
    values = limits.published_limit(RATIOS[:, None], beta, ANGLES)
    throw = np.broadcast_to(limits.throw_number(RATIOS[:, None], beta), values.shape)
    return FigureGrid(ANGLES, RATIOS, check.frozen(values), check.frozen(throw))


def sliding_acceleration(acceleration, beta, friction, gravity=GRAVITY):
    """Return V'_z of a sliding part at the upper reversal, as the thesis draws it.

    Parameters
    ----------
    acceleration : array_like [m/s2]
        A w^2 of the drive.
    beta : array_like [rad]
        Vibration angle.
    friction : array_like [1]
    gravity : float [m/s2]

    Returns
    -------
    array [m/s2]
        Past the hop it is the formula's value, not a part's.

    References
    ----------
    The thesis, eqs. [4.14], [4.16] with R_z = mu N and alpha = theta.
    """
    return acceleration * np.cos(beta) - friction * (gravity - acceleration * np.sin(beta))


def ratio_of_5_6():
    """Return G of Figure 5-6."""
    return limits.acceleration_ratio(AMPLITUDE, FREQUENCY, GRAVITY)


def figure_5_6():
    """Return V'_z over (beta, mu): x is beta [rad], y is mu."""
    betas, frictions = np.radians(np.linspace(0.0, 90.0, 91)), np.linspace(0.0, 1.0, 51)
    ratio = ratio_of_5_6()
    values = sliding_acceleration(ratio * GRAVITY, betas, frictions[:, None])
    throw = np.broadcast_to(limits.throw_number(ratio, betas), values.shape)
    return FigureGrid(betas, frictions, check.frozen(values), check.frozen(throw))


def figure_5_7():
    """Return V'_z over (f, A): x is the frequency [Hz], y is the amplitude [m]."""
    frequencies, amplitudes = np.linspace(0.0, 100.0, 101), np.linspace(0.0, 1e-3, 51)
    ratio = limits.acceleration_ratio(amplitudes[:, None], frequencies, GRAVITY)
    values, throw = sliding_acceleration(ratio * GRAVITY, BETA, FRICTION), limits.throw_number(ratio, BETA)
    return FigureGrid(frequencies, amplitudes, check.frozen(values), check.frozen(throw))
