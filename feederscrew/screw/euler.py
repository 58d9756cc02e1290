"""The dual Euler equation of a rigid body, and the spatial triangle it draws."""

from dataclasses import dataclass

import numpy as np

from feederscrew.screw.angle_between import dual_angle
from feederscrew.screw.point import Point, dot, vectors
from feederscrew.screw.screws import Momentum, Twist, Wrench

SYMMETRIC_WITHIN = 1e-9  # of the largest entry of an inertia matrix


@dataclass(frozen=True, eq=False)
class Body:
    """Mass properties, constant in axes fixed to the body.

    Parameters
    ----------
    mass : (...,) float [kg]
        Positive.
    inertia : (..., 3, 3) float [kg m2]
        About the centre of mass.
    centre : Point
        G, the centre of mass.

    Raises
    ------
    ValueError
        If the mass is not positive, or the inertia is not symmetric and positive definite.
    """

    mass: np.ndarray
    inertia: np.ndarray
    centre: Point

    def __post_init__(self):
        mass, inertia = np.asarray(self.mass, dtype=float), vectors("inertia", self.inertia)
        if not (np.isfinite(mass) & (mass > 0.0)).all():
            raise ValueError(f"mass is {self.mass}, not a positive number")
        if inertia.shape[-2:] != (3, 3):
            raise ValueError(f"inertia has shape {inertia.shape}, not (..., 3, 3)")
        skew = np.abs(inertia - np.swapaxes(inertia, -1, -2)).max(axis=(-1, -2))
        even = (skew <= SYMMETRIC_WITHIN * np.abs(inertia).max(axis=(-1, -2))).all()
        if not even or (np.linalg.eigvalsh(inertia) <= 0.0).any():
            raise ValueError("inertia is not symmetric and positive definite")
        object.__setattr__(self, "mass", mass[()])
        object.__setattr__(self, "inertia", inertia)

    def inertia_about(self, point):
        """Return I_A about any point A (Huygens and Steiner), (..., 3, 3) [kg m2]."""
        lever = self.centre - point
        square = dot(lever, lever)[..., None, None] * np.eye(3)
        outer = lever[..., :, None] * lever[..., None, :]
        return self.inertia + np.asarray(self.mass)[..., None, None] * (square - outer)

    def momentum(self, twist):
        """Return the momentum screw of the body moving with a twist, at the twist's reference point A.

        Parameters
        ----------
        twist : Twist of shape (...,)
            omega + eps v_A.

        Returns
        -------
        Momentum of shape (...,)
            q = m (v_A + omega x AG) [2.2]; H_A = I_A omega + m AG x v_A [2.3]; q + eps H_A, eq. [2.4].
            The thesis writes it out, eqs. [4.8], [4.39], for the twists of eqs. [4.7], [4.38].
        """
        spin, speed, lever = twist.resultant, twist.moment, self.centre - twist.reference
        mass = np.asarray(self.mass)[..., None]
        linear = mass * (speed + np.cross(spin, lever))  # eq. [2.2]
        about = np.einsum("...ij,...j->...i", self.inertia_about(twist.reference), spin)
        angular = about + mass * np.cross(lever, speed)  # eq. [2.3]
        return Momentum(linear, angular, twist.reference)


@dataclass(frozen=True, eq=False)
class SpatialTriangle:
    """The three screws of the dual Euler equation, f = n + p, all at one point.

    References
    ----------
    G. R. Pennock, P. J. Meehan, "Geometric insight into the dynamics of a rigid body using the spatial
    triangle of screws", J. Mechanical Design 124(4), 684-689, 2002.
    """

    force: Wrench  # f, the force screw
    rate: Wrench  # n, the time rate of the momentum screw, seen in body axes
    centripetal: Wrench  # p, twist (x) momentum screw

    @property
    def sides(self):
        """The dual angles n to p, n to f and f to p, three ``Dual``; the last two add up to the first.

        The axes of n, p and their sum meet one common normal at right angles, which is why the sides lie on
        one line; a side is NaN where one of its screws is zero.
        """
        n, p, f = self.rate, self.centripetal, self.force
        return dual_angle(n, p), dual_angle(n, f), dual_angle(f, p)


def spatial_triangle(body, twist, twist_rate):
    """Return the force, momentum rate and centripetal screw of a moving body.

    Parameters
    ----------
    body : Body
        In body axes.
    twist : Twist of shape (...,)
        omega + eps v_A about a point A of the body, components along body axes.
    twist_rate : Twist of shape (...,)
        Time derivatives of those components; re-expressed at A where given elsewhere on the body.

    Returns
    -------
    SpatialTriangle
        All three screws at A.

    Notes
    -----
    The thesis, eq. [4.4] and eq. [4.6]; written out for its parts on the floor, eqs. [4.9] to [4.12],
    eqs. [4.40] to [4.42], and on the track, eqs. [4.30], [4.31], eqs. [4.55], [4.56].
    """
    rate = body.momentum(twist_rate.at(twist.reference))  # linear in the twist, so its rate has its form
    rate = Wrench(rate.resultant, rate.moment, rate.reference)
    centripetal = twist.cross(body.momentum(twist))  # eq. [4.4]
    return SpatialTriangle(rate + centripetal, rate, centripetal)  # eq. [4.6]


def force_screw(body, twist, twist_rate):
    """Return the wrench twist (x) momentum + d/dt momentum of a moving body: the dual Euler equation.

    Parameters as for ``spatial_triangle``; the wrench is at the twist's point.

    References
    ----------
    G. R. Pennock, B. A. Oncu, "Application of screw theory to rigid body dynamics", J. Dynamic Systems,
    Measurement, and Control 114(2), 262-269, 1992.
    """
    return spatial_triangle(body, twist, twist_rate).force


def twist_rate(body, twist, wrench):
    """Return how a body under a wrench changes its twist: the dual Euler equation solved for the motion.

    Parameters
    ----------
    body : Body
        In body axes.
    twist : Twist of shape (...,)
        omega + eps v_A about a point A of the body, components along body axes.
    wrench : Wrench of shape (...,)
        Everything that acts on the body.

    Returns
    -------
    Twist of shape (...,)
        Time derivatives of the components of ``twist``, at A.
    """
    centripetal = twist.cross(body.momentum(twist))
    rest = (wrench.at(twist.reference) - centripetal).at(body.centre)
    spin = np.linalg.solve(body.inertia, rest.moment[..., None])[..., 0]
    return Twist(spin, rest.resultant / np.asarray(body.mass)[..., None], body.centre).at(twist.reference)
