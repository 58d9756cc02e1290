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
from typing import Any

import numpy as np

from feederscrew.arrays import Floats, Ints, Reals
from feederscrew.bowl.record import Bowl, Friction
from feederscrew.errors import ConfigError


class Regime(enum.StrEnum):
    """What a part does within one cycle of the drive; files print the word."""

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


def plain(bowl: Bowl) -> Bowl:
    """Return the Bowl itself once its drive is straight and harmonic, with friction the same both ways.

    Raises ConfigError if it is not: the formulas for one point of the cycle know no other.
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


def acceleration_ratio(amplitude: Reals, frequency: Reals, gravity: Reals) -> Any:
    """Return G = A w^2 / g [1], of half a stroke [m] at a frequency [Hz].

    Source: the thesis, section 4.3.
    """
    return amplitude * (2.0 * np.pi * np.asarray(frequency)) ** 2 / gravity


def published_limit(ratio: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0) -> Any:
    """Return the thesis's limiting friction [1]: the least that holds on a level floor at the upper reversal.

    As printed: negative past the hop, G sin(beta) > 1, where no friction holds; infinite at it.
    Source: the thesis, eq. [4.27]; eq. [4.28] for alpha = theta.
    """
    normal = 1.0 - ratio * np.sin(beta)
    with np.errstate(divide="ignore", invalid="ignore"):
        return ratio * np.cos(beta) * np.cos(alpha_minus_theta) / normal  # eq. [4.27]


def published_ratio(friction: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0) -> Any:
    """Return the G [1] at which eq. [4.27] equals a friction; ``alpha_minus_theta`` below a quarter turn."""
    return friction / (np.cos(beta) * np.cos(alpha_minus_theta) + friction * np.sin(beta))  # eq. [4.27]


def throw_number(ratio: Reals, beta: Reals, climb: Reals = 0.0) -> Any:
    """Return k = G sin(beta) / cos(climb) [1], whatever the bank; the part hops where it is above 1.

    Source: the normal force of eq. [4.14] at the upper reversal, set to zero on a climbing track.
    """
    return ratio * np.sin(beta) / np.cos(climb)


def hops(ratio: Reals, beta: Reals, climb: Reals = 0.0) -> Any:
    """Return whether contact is lost within the cycle; at k = 1 [1] within rounding it counts as lost."""
    return throw_number(ratio, beta, climb) >= 1.0 - HOP_ROUNDING


def hop_ratio(beta: Reals, climb: Reals = 0.0) -> Any:
    """Return G [1] from which the part hops, eq. [4.14] set to zero; infinite for beta = 0."""
    with np.errstate(divide="ignore", over="ignore"):
        return np.cos(climb) / np.sin(beta)


def forward_limit(ratio: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0) -> Floats:
    """Return the least static friction [1] at which a part never slips forward, up the track.

    For a part aligned with the drive, (G cos b - sin c)/(cos c - G sin b). Zero or less where no slip comes
    on any surface; NaN past the hop where it comes on every one. Source: Coulomb's law; eq. [4.28] if level.
    """
    return _limit(1.0, ratio, beta, alpha_minus_theta, climb)


def backward_limit(ratio: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0) -> Floats:
    """Return the least static friction [1] at which a part never slips back, down the track.

    For a part aligned with the drive, (G cos b + sin c)/(cos c + G sin b); else as ``forward_limit``.
    """
    return _limit(-1.0, ratio, beta, alpha_minus_theta, climb)


def forward_ratio(friction: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0) -> Floats:
    """Return G [1] from which a part of a given static friction slips forward, by ``forward_limit``.

    For a part aligned with the drive, sin(c + p)/cos(b - p) with p = atan(friction); zero where it slides at
    rest; infinite where it hops before, or never slips.
    """
    return _onset(1.0, friction, beta, alpha_minus_theta, climb)


def backward_ratio(
    friction: Reals, beta: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0
) -> Floats:
    """Return G [1] from which a part of a given static friction slips back.

    For a part aligned with the drive, sin(p - c)/cos(b + p); else as ``forward_ratio``.
    """
    return _onset(-1.0, friction, beta, alpha_minus_theta, climb)


def regimes(
    ratio: Reals, beta: Reals, friction: Reals, alpha_minus_theta: Reals = 0.0, climb: Reals = 0.0
) -> Ints:
    """Return what a part does within one cycle, places in ``POINT_REGIMES``.

    A part whose static friction [1] equals a limit still sticks.
    Source: the limits above; docs/mechanics.md, "The floor".
    """
    where = (ratio, beta, alpha_minus_theta, climb)
    slips = np.where(friction < forward_limit(*where), FORWARD, RIDE)
    slips = slips + np.where(friction < backward_limit(*where), BACKWARD, RIDE)
    return np.where(hops(ratio, beta, climb), HOP, slips)


def _limit(sense: float, ratio: Reals, beta: Reals, alpha_minus_theta: Reals, climb: Reals) -> Floats:
    """Greatest (s push - resist) / (weight - s lift) while there is contact; NaN if unbounded."""
    push, resist = sense * (ratio * np.cos(beta) * np.cos(alpha_minus_theta)), sense * np.sin(climb)
    weight, lift = np.cos(climb), ratio * np.sin(beta)
    rises = push * weight > lift * resist  # the sign of its derivative in s
    hopping = hops(ratio, beta, climb)
    light = np.where(hopping, np.nan, (push - resist) / np.where(hopping, 1.0, weight - lift))
    return np.where(rises, light, (-push - resist) / (weight + lift))


def _onset(sense: float, friction: Reals, beta: Reals, alpha_minus_theta: Reals, climb: Reals) -> Floats:
    """Least G with G s gain > held at s = +1 or -1; infinite where it hops before."""
    gain = sense * (np.cos(beta) * np.cos(alpha_minus_theta)) + friction * np.sin(beta)
    held = friction * np.cos(climb) + sense * np.sin(climb)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.maximum(held, 0.0) / np.abs(gain)
    ratio = np.where(gain == 0.0, np.inf, ratio)
    return np.where((gain > 0.0) & hops(ratio, beta, climb), np.inf, ratio)


def effective(friction: Reals, wall: Reals, bank: Reals) -> Any:
    """Return the friction of the level track that holds a part as floor and wall together do.

    From the coefficients [1] of the floor and of the upright wall, and a bank [rad] below a quarter turn.
    Source: docs/conveying.md, "The model".
    """
    return friction / np.cos(bank) + wall * np.tan(bank)


def of_floor(friction: Reals, wall: Reals, bank: Reals) -> Any:
    """Return the floor's coefficient [1] that makes, with the wall, an effective one.

    Source: ``effective`` solved for the floor.
    """
    return friction * np.cos(bank) - wall * np.sin(bank)


def level(bowl: Bowl) -> Bowl:
    """Return a Bowl without bank on which a part travels as in this one; fields may be arrays that broadcast.

    It has the effective friction, of rest and of sliding, up and down the track.
    """
    mu, bank = bowl.friction, bowl.track.bank
    static, kinetic, *back = (effective(k, mu.wall, bank) for k in (mu.static, mu.kinetic, *mu.backward))
    surfaces = Friction(static, kinetic, mu.wall, *back)
    return replace(bowl, friction=surfaces, track=replace(bowl.track, bank=0.0 * bank))
