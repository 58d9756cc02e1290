"""The rigid body: its momentum screw, the dual Euler equation, its contacts as reciprocal screws."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.screw.screws import Momentum, Point, Screw, Twist, Wrench, dot, length, vectors

SYMMETRY_TOLERANCE = 1e-9  # of the largest entry of an inertia matrix
INDEPENDENCE_TOLERANCE = 1e-12  # of the largest singular value: below it a contact adds nothing to the others
Array = NDArray[np.float64]


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

    mass: Array
    inertia: Array
    centre: Point

    def __post_init__(self) -> None:
        mass, inertia = np.asarray(self.mass, dtype=float), vectors("inertia", self.inertia)
        if not (np.isfinite(mass) & (mass > 0.0)).all():
            raise ValueError(f"mass is {self.mass}, not a positive number")
        if inertia.shape[-2:] != (3, 3):
            raise ValueError(f"inertia has shape {inertia.shape}, not (..., 3, 3)")
        skew = np.abs(inertia - np.swapaxes(inertia, -1, -2)).max(axis=(-1, -2))
        even = (skew <= SYMMETRY_TOLERANCE * np.abs(inertia).max(axis=(-1, -2))).all()
        if not even or (np.linalg.eigvalsh(inertia) <= 0.0).any():
            raise ValueError("inertia is not symmetric and positive definite")
        object.__setattr__(self, "mass", mass[()])
        object.__setattr__(self, "inertia", inertia)

    def inertia_about(self, point: Point) -> Array:
        """Return I_A about any point A (Huygens and Steiner), (..., 3, 3) [kg m2]."""
        lever = self.centre - point
        square = dot(lever, lever)[..., None, None] * np.eye(3)
        outer = lever[..., :, None] * lever[..., None, :]
        return self.inertia + np.asarray(self.mass)[..., None, None] * (square - outer)

    def momentum(self, twist: Twist) -> Momentum:
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


def force_screw(body: Body, twist: Twist, twist_rate: Twist) -> Wrench:
    """Return the wrench twist (x) momentum + d/dt momentum of a moving body: the dual Euler equation.

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
    Wrench of shape (...,)
        At A.

    Notes
    -----
    The thesis, eq. [4.4] and eq. [4.6]; written out for its parts on the floor, eqs. [4.9] to [4.12],
    eqs. [4.40] to [4.42], and on the track, eqs. [4.30], [4.31], eqs. [4.55], [4.56].

    References
    ----------
    G. R. Pennock, B. A. Oncu, "Application of screw theory to rigid body dynamics", J. Dynamic Systems,
    Measurement, and Control 114(2), 262-269, 1992.
    """
    rate = body.momentum(twist_rate.at(twist.reference))  # linear in the twist, so its rate has its form
    carried = twist.cross(body.momentum(twist))  # eq. [4.4]
    force, moment = rate.resultant + carried.resultant, rate.moment + carried.moment  # eq. [4.6]
    return Wrench(force, moment, twist.reference)


def tipping_twists(wrenches: Wrench) -> Twist:
    """Return for each of six contacts the unit twist reciprocal to the other five.

    A body about to leave contact i, all others kept, moves with twist i: ``axis`` is the line it tips about.
    The sense is the one that opens the contact: the reciprocal product with its own wrench is positive.

    Parameters
    ----------
    wrenches : Wrench of shape (..., 6)
        Of the six contacts, pushing on the body.

    Returns
    -------
    Twist of shape (..., 6)
        Column i of the inverse of the six wrenches; at the first wrench's reference point.

    Raises
    ------
    ValueError
        If there are not six wrenches, or they are not independent.

    References
    ----------
    K. H. Hunt, "Kinematic Geometry of Mechanisms", Oxford University Press, 1978.
    """
    rows, arm, point = _rows(wrenches)
    _check_independent(rows)
    return _twists(np.swapaxes(np.linalg.inv(rows), -1, -2), arm, point)


def reactions(wrenches: Wrench, external: Wrench) -> Array:
    """Return how hard each of six contacts pushes: the solution of sum_i lambda_i w_i = -external.

    Each equals -(external o t_i) / (w_i o t_i) with t_i of ``tipping_twists``.

    Source: reciprocal screws, Ball 1900; docs/method/screws.md, "Contacts: reciprocal screws".

    Parameters
    ----------
    wrenches : Wrench of shape (..., 6)
        Of the six contacts, each for a reaction of 1.
    external : Wrench of shape (...,)
        All else that acts: weight, inertia, drive.

    Returns
    -------
    (..., 6) float [1]
        In units of each contact's wrench; negative where the contact would have to pull.

    Raises
    ------
    ValueError
        If there are not six wrenches, or they are not independent.
    """
    twists = tipping_twists(wrenches)
    return -_widened(external).reciprocal(twists) / wrenches.reciprocal(twists)


def _rows(wrenches: Wrench) -> tuple[Array, Array, Point]:
    """Wrenches as rows (f, m / arm) of length 1, (..., k, 6), the arm (...,) [m] and their common point.

    The arm, a typical lever, makes force and moment comparable, so that no answer depends on the unit of
    length.
    """
    if len(wrenches.shape) < 1:
        raise ValueError("wrenches need an axis that counts them: (..., k)")
    reference = wrenches.reference
    if reference.coordinates.ndim > 1:
        reference = Point(reference.name, reference.coordinates[..., :1, :])
    wrenches = wrenches.at(reference)
    force, moment = (length(part).max(axis=-1, initial=0.0) for part in (wrenches.resultant, wrenches.moment))
    arm = np.divide(moment, force, out=np.ones_like(force), where=(force > 0.0) & (moment > 0.0))
    rows = np.concatenate([wrenches.resultant, wrenches.moment / arm[..., None, None]], axis=-1)
    size = np.linalg.norm(rows, axis=-1, keepdims=True)
    return rows / np.where(size > 0.0, size, 1.0), arm, reference


def _twists(columns: Array, arm: Array, reference: Point) -> Twist:
    """Unit twists of the columns (v, arm times omega); a turn lost in rounding is none."""
    speed, spin = columns[..., :3], columns[..., 3:]
    lost = length(spin) <= INDEPENDENCE_TOLERANCE * length(speed)
    spin = np.where(lost[..., None], 0.0, spin)
    return Twist(spin / arm[..., None, None], speed, reference).unit()


def _check_independent(rows: Array) -> None:
    if rows.shape[-2] != 6:
        raise ValueError(f"there are {rows.shape[-2]} wrenches, not six")
    values = np.linalg.svd(rows, compute_uv=False)
    dependent = values[..., -1] <= INDEPENDENCE_TOLERANCE * values[..., 0]
    if dependent.any():
        raise ValueError(f"{dependent.sum()} of {dependent.size} sets of six wrenches are not independent")


def _widened(screw: Screw) -> Screw:
    """The same screws with a further axis of length 1 behind the leading ones."""
    place = screw.reference.coordinates
    point = screw.reference if place.ndim == 1 else Point(screw.reference.name, place[..., None, :])
    return type(screw)(screw.resultant[..., None, :], screw.moment[..., None, :], point)
