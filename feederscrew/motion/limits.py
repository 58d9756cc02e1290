"""When a part starts to slip or hop: closed forms over the two reversals of the vibration.

The part is a point on a surface that vibrates harmonically. At phase s = sin(w t), and per unit of weight,
the normal force is cos(climb) - G s sin(beta) and the force that friction must supply along the track is
sin(climb) - G s cos(beta) cos(alpha - theta), with G = A w^2 / g. A wall carries what is across the track;
cos(alpha - theta) is 1 where there is none. A banked track with a wall is a level one of another friction
(`effective`). What friction must supply over the normal force is monotone in s, so the limits lie at the
reversals, s = +1 (the part is lightest) and s = -1 (heaviest).

Every function takes numbers or arrays that broadcast together: ``ratio`` [1] is G, ``beta`` [rad] the
vibration angle above the surface, ``alpha_minus_theta`` [rad] from the part's heading, up the track, to the
vibration in the surface (beyond 90 deg the strokes change places: the part is lightest while it is pushed
back), ``climb`` [rad] that of the track, ``friction`` [1] the static one.

The bowl moves along the tangent of its track and along its own axis, whatever the bank: so the drive, the
weight and every impact press a part down square to the tangent, and floor and wall share that. Per unit of it
the floor carries 1 / cos(bank) and an upright wall tan(bank), at every instant of the cycle; both press at
the same times, and a part leaves both at once. Left out is the centripetal force.

Source: the balance of forces in a wedge with Coulomb's friction, docs/conveying.md; the thesis, section 4.3,
for [4.27] and [4.28], a level floor at s = +1. The track's limits follow from the two forces above.
"""

import enum
from dataclasses import replace

import numpy as np

from feederscrew.base.arrays import Bools, Floats, Ints, Reals
from feederscrew.base.errors import ConfigError
from feederscrew.bowl.record import Bowl, BowlGrid, Friction, Number


class Regime(enum.StrEnum):
    """Regime of a part within one cycle of the drive; files print the word."""

    STICK = "stick"
    FORWARD = "forward"
    BACKWARD = "backward"
    BOTH = "both"
    HOP = "hop"
    NO_STEADY_STATE = "no steady state"  # it slides on without stopping


# a regime code is a place in this list
POINT_REGIMES = (Regime.STICK, Regime.FORWARD, Regime.BACKWARD, Regime.BOTH, Regime.HOP)
RIDE = POINT_REGIMES.index(Regime.STICK)
FORWARD = POINT_REGIMES.index(Regime.FORWARD)
BACKWARD = POINT_REGIMES.index(Regime.BACKWARD)
BOTH = POINT_REGIMES.index(Regime.BOTH)
HOP = POINT_REGIMES.index(Regime.HOP)
HOP_ROUNDING = 1e-9  # [1] a throw number this near 1 counts as hopping: there the forces hang on rounding
USE = "leave it out, or use feeder convey"


def plain(bowl: Bowl[Number]) -> Bowl[Number]:
    """Return the Bowl itself if its drive is straight and harmonic, with friction the same both ways.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Bowl

    Raises
    ------
    ConfigError
        If it is not: the formulas for one point of the cycle know no other drive.
    """
    for word in ("phase", "second_harmonic"):  # zero of a straight and harmonic drive
        if np.any(getattr(bowl.drive, word) != 0.0):
            what = "is not 0, and this command knows a straight harmonic drive only"
            raise ConfigError(f"drive.{word}", what, USE)
    for word, backward in zip(("static", "kinetic"), bowl.friction.backward, strict=True):
        if np.any(backward != getattr(bowl.friction, word)):
            what = f"is not friction.{word}, and this command knows one friction both ways only"
            raise ConfigError(f"friction.{word}_backward", what, USE)
    return bowl


def acceleration_ratio(amplitude: Reals, frequency: Reals, gravity: Reals) -> Floats:
    """Return G = A w^2 / g.

    Parameters
    ----------
    amplitude : float or (...) float [m]
        A, half a stroke.
    frequency : float or (...) float [Hz]
    gravity : float or (...) float [m/s2]

    Returns
    -------
    (...) float [1]

    References
    ----------
    The thesis, section 4.3.
    """
    return amplitude * (2.0 * np.pi * np.asarray(frequency)) ** 2 / gravity


def published_limit(ratio: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0) -> Floats:
    """Return the thesis's limiting friction: the least that holds on a level floor at the upper reversal.

        mu = G cos(b) cos(alpha - theta) / (1 - G sin(b))        eq. [4.27]

    It holds below the hop, G sin(b) < 1. Past it the value is negative, as printed, and no friction holds; at
    it the value is infinite. With alpha = theta it is eq. [4.28].

    Parameters
    ----------
    ratio : float or (...) float [1]
        G.
    beta : float or (...) float [rad]
        Vibration angle b.
    alpha_minus_theta : float or (...) float [rad]

    Returns
    -------
    (...) float [1]

    References
    ----------
    The thesis, eq. [4.27] and eq. [4.28].
    """
    normal = 1.0 - ratio * np.sin(beta)
    with np.errstate(divide="ignore", invalid="ignore"):
        return ratio * np.cos(beta) * np.cos(alpha_minus_theta) / normal  # eq. [4.27]


def published_ratio(friction: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0) -> Floats:
    """Return the acceleration ratio G at which eq. [4.27] equals a friction.

        G = mu / (cos(b) cos(alpha - theta) + mu sin(b))

    Parameters
    ----------
    friction : float or (...) float [1]
        mu.
    beta : float or (...) float [rad]
        Vibration angle b.
    alpha_minus_theta : float or (...) float [rad]
        Below a quarter turn.

    Returns
    -------
    (...) float [1]
    """
    return friction / (np.cos(beta) * np.cos(alpha_minus_theta) + friction * np.sin(beta))  # eq. [4.27]


def throw_number(ratio: Reals, beta: Reals, climb: Reals = 0.0) -> Floats:
    """Return k = G sin(b) / cos(climb); the part hops where it is above 1.

    The bank does not enter: drive and weight press the part down square to the tangent of the track, whatever
    the bank.

    Parameters
    ----------
    ratio : float or (...) float [1]
        G.
    beta : float or (...) float [rad]
        Vibration angle b.
    climb : float or (...) float [rad]

    Returns
    -------
    (...) float [1]

    References
    ----------
    The normal force of eq. [4.14] at the upper reversal, set to zero on a climbing track.
    """
    return ratio * np.sin(beta) / np.cos(climb)


def hops(ratio: Reals, beta: Reals, climb: Reals = 0.0) -> Bools:
    """Return whether contact is lost within the cycle.

    Parameters
    ----------
    ratio : float or (...) float [1]
        G.
    beta : float or (...) float [rad]
        Vibration angle.
    climb : float or (...) float [rad]

    Returns
    -------
    (...) bool
        True also at a throw number of 1 within rounding: there the normal force is zero at one instant, and
        rounding would decide.

    References
    ----------
    ``throw_number``.
    """
    return throw_number(ratio, beta, climb) >= 1.0 - HOP_ROUNDING


def hop_ratio(beta: Reals, climb: Reals = 0.0) -> Floats:
    """Return the acceleration ratio G from which the part hops: eq. [4.14] set to zero.

        G = cos(climb) / sin(b)

    Parameters
    ----------
    beta : float or (...) float [rad]
        Vibration angle b.
    climb : float or (...) float [rad]

    Returns
    -------
    (...) float [1]
        Infinite for b = 0: a level vibration throws nothing.
    """
    with np.errstate(divide="ignore", over="ignore"):
        return np.cos(climb) / np.sin(beta)


def forward_limit(ratio: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0) -> Floats:
    """Return the least static friction at which a part never slips forward, up the track.

        mu = (G cos b - sin c) / (cos c - G sin b)

    for a part aligned with the drive, c being the climb. Here friction must hold the part at the upper
    reversal, where it is lightest. For a part at an angle to the drive cos b is multiplied by cos(alpha -
    theta).

    Parameters
    ----------
    ratio : float or (...) float [1]
        G.
    beta : float or (...) float [rad]
        Vibration angle b.
    alpha_minus_theta : float or (...) float [rad]
    climb : float or (...) float [rad]
        c.

    Returns
    -------
    (...) float [1]
        Zero or less where the part slips on no surface; NaN past the hop where it slips on every one.

    References
    ----------
    Coulomb's law; eq. [4.28] if the track is level.
    """
    return _limit(1.0, ratio, beta, alpha_minus_theta, climb)


def backward_limit(ratio: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0) -> Floats:
    """Return the least static friction at which a part never slips back, down the track.

        mu = (G cos b + sin c) / (cos c + G sin b)

    for a part aligned with the drive: at the lower reversal, where it is heaviest.

    Parameters
    ----------
    ratio : float or (...) float [1]
        G.
    beta : float or (...) float [rad]
        Vibration angle b.
    alpha_minus_theta : float or (...) float [rad]
    climb : float or (...) float [rad]
        c.

    Returns
    -------
    (...) float [1]
        As in ``forward_limit``.

    References
    ----------
    Coulomb's law: ``forward_limit`` with the signs of push and lift reversed.
    """
    return _limit(-1.0, ratio, beta, alpha_minus_theta, climb)


def forward_ratio(friction: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0) -> Floats:
    """Return the acceleration ratio G from which a part slips forward, up the track.

        G = sin(c + p) / cos(b - p),   tan(p) = mu

    for a part aligned with the drive, c being the climb. It is ``forward_limit`` solved for G.

    Parameters
    ----------
    friction : float or (...) float [1]
        mu.
    beta : float or (...) float [rad]
        Vibration angle b.
    alpha_minus_theta : float or (...) float [rad]
    climb : float or (...) float [rad]
        c.

    Returns
    -------
    (...) float [1]
        Zero where the part slides at rest; infinite where it hops before it slips, or never slips.

    References
    ----------
    G. Boothroyd, "Assembly Automation and Product Design", 2nd ed., chapter 3; docs/formulas.md.
    """
    return _onset(1.0, friction, beta, alpha_minus_theta, climb)


def backward_ratio(
    friction: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0
) -> Floats:
    """Return the acceleration ratio G from which a part slips back, down the track.

        G = sin(p - c) / cos(b + p),   tan(p) = mu

    for a part aligned with the drive, c being the climb.

    Parameters
    ----------
    friction : float or (...) float [1]
        mu.
    beta : float or (...) float [rad]
        Vibration angle b.
    alpha_minus_theta : float or (...) float [rad]
    climb : float or (...) float [rad]
        c.

    Returns
    -------
    (...) float [1]
        As in ``forward_ratio``.

    References
    ----------
    G. Boothroyd, "Assembly Automation and Product Design", 2nd ed., chapter 3; docs/formulas.md.
    """
    return _onset(-1.0, friction, beta, alpha_minus_theta, climb)


def regimes(
    ratio: Reals, beta: Reals, friction: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0
) -> Ints:
    """Return the regime of a part within one cycle: it sticks, slips forward, back or both ways, or hops.

    A part whose static friction equals a limit still sticks.

    Parameters
    ----------
    ratio : float or (...) float [1]
        G.
    beta : float or (...) float [rad]
        Vibration angle.
    friction : float or (...) float [1]
        Static friction.
    alpha_minus_theta : float or (...) float [rad]
    climb : float or (...) float [rad]

    Returns
    -------
    (...) int
        Places in ``POINT_REGIMES``.

    References
    ----------
    The limits above; docs/mechanics.md, "The floor".
    """
    where = (ratio, beta, alpha_minus_theta, climb)
    slips = np.where(friction < forward_limit(*where), FORWARD, RIDE)
    slips = slips + np.where(friction < backward_limit(*where), BACKWARD, RIDE)  # 1 + 2 is BOTH
    return np.where(hops(ratio, beta, climb), HOP, slips)


def _limit(sense: float, ratio: Reals, beta: Reals, alpha_minus_theta: Reals, climb: Reals) -> Floats:
    """Return the greatest (s push - resist) / (weight - s lift) while there is contact; NaN if unbounded.

    The quotient is monotone in s = sin(w t), so its greatest value lies at s = 1 where it rises, else at s =
    -1.
    """
    push, resist = sense * (ratio * np.cos(beta) * np.cos(alpha_minus_theta)), sense * np.sin(climb)
    weight, lift = np.cos(climb), ratio * np.sin(beta)
    rises = push * weight > lift * resist  # the sign of its derivative in s
    hopping = hops(ratio, beta, climb)
    light = np.where(hopping, np.nan, (push - resist) / np.where(hopping, 1.0, weight - lift))
    return np.where(rises, light, (-push - resist) / (weight + lift))


def _onset(sense: float, friction: Reals, beta: Reals, alpha_minus_theta: Reals, climb: Reals) -> Floats:
    """Return the least G with G s gain > held at s = +1 or -1; infinite where the part hops before."""
    gain = sense * (np.cos(beta) * np.cos(alpha_minus_theta)) + friction * np.sin(beta)
    held = friction * np.cos(climb) + sense * np.sin(climb)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.maximum(held, 0.0) / np.abs(gain)
    ratio = np.where(gain == 0.0, np.inf, ratio)
    return np.where((gain > 0.0) & hops(ratio, beta, climb), np.inf, ratio)


def effective(friction: Reals, wall: Reals, bank: Reals) -> Floats:
    """Return the friction of the level track that holds a part as floor and wall together do.

        mu' = mu / cos(bank) + mu_w tan(bank)

    For each unit of force square to the track's tangent the floor carries 1 / cos(bank) and an upright wall
    tan(bank), at every instant of the cycle.

    Parameters
    ----------
    friction : float or (...) float [1]
        mu of the floor.
    wall : float or (...) float [1]
        mu_w of the upright wall.
    bank : float or (...) float [rad]
        Below a quarter turn.

    Returns
    -------
    (...) float [1]

    References
    ----------
    docs/conveying.md, "The model".
    """
    return friction / np.cos(bank) + wall * np.tan(bank)


def of_floor(friction: Reals, wall: Reals, bank: Reals) -> Floats:
    """Return the floor's coefficient that makes, with the wall, an effective one.

        mu = mu' cos(bank) - mu_w sin(bank)

    Parameters
    ----------
    friction : float or (...) float [1]
        mu', the effective friction.
    wall : float or (...) float [1]
        mu_w.
    bank : float or (...) float [rad]

    Returns
    -------
    (...) float [1]
        Negative where the wall alone holds more than mu'.

    References
    ----------
    ``effective`` solved for the floor.
    """
    return friction * np.cos(bank) - wall * np.sin(bank)


def level(bowl: BowlGrid) -> BowlGrid:
    """Return the Bowl without bank on which a part travels as in this one.

    It has the effective friction, of rest and of sliding, up and down the track.

    Parameters
    ----------
    bowl : BowlGrid
        Fields may be arrays that broadcast.

    Returns
    -------
    BowlGrid

    References
    ----------
    ``effective``.
    """
    mu, bank = bowl.friction, bowl.track.bank
    coefficients = (mu.static, mu.kinetic, *mu.backward)
    static, kinetic, *back = (effective(k, mu.wall, bank) for k in coefficients)
    surfaces = Friction(static, kinetic, mu.wall, *back)
    return replace(bowl, friction=surfaces, track=replace(bowl.track, bank=0.0 * bank))
