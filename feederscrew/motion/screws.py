"""Twists, wrenches and momentum screws; knows neither parts nor bowls.

The track uses them for the contact that opens first and the axis the part then tips about
(``motion.track_contacts``): reactions and tipping twists are reciprocal screws there. The equations of
floor and track are solved for whole maps at once, as arrays of six components in ``motion.track_balance``;
the tests hold them, and every screw the thesis prints, against this room.

Source: the thesis by the numbers of its equations; docs/method/screws.md and docs/equations.md.
"""

from dataclasses import dataclass
from types import EllipsisType
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.geometry.vectors import dot, ratio

Choice = int | slice | EllipsisType | Ints | Bools  # along one axis of a batch


def vectors(name: str, value: ArrayLike) -> Floats:
    """Return a copy of an array of 3-vectors that nobody can write to.

    Parameters
    ----------
    name : str
        Name of the array, used in the fault.
    value : (..., 3) array_like of float [any]

    Returns
    -------
    (..., 3) float [any]

    Raises
    ------
    ValueError
        If the last axis does not have length 3, or an entry is not finite.
    """
    array = np.array(value, dtype=float)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} has shape {array.shape}, not (..., 3)")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return check.frozen(array)


def length(u: Floats) -> Floats:
    """Return the length of vectors in their own unit; no square overflows.

    Parameters
    ----------
    u : (..., 3) float [any]

    Returns
    -------
    (...,) float [any]
        sqrt(x^2 + y^2 + z^2), computed by two calls of ``hypot``. Source: own.
    """
    return np.hypot(np.hypot(u[..., 0], u[..., 1]), u[..., 2])


@dataclass(frozen=True, eq=False)
class Dual:
    """A dual number, or an array of them; NaN marks a number that does not exist.

    Source: W. K. Clifford, "Preliminary sketch of biquaternions", Proc. London Math. Soc. 4, 381-395, 1873.
    """

    real: Floats  # (...,) without eps: of a dual angle the angle, of a product of screws the scalar product
    dual: Floats  # (...,) with eps: of a dual angle the distance, of screws the reciprocal product

    def __add__(self, other: "Dual") -> "Dual":
        return Dual(self.real + other.real, self.dual + other.dual)

    def __sub__(self, other: "Dual") -> "Dual":
        return Dual(self.real - other.real, self.dual - other.dual)

    def __mul__(self, other: "Dual") -> "Dual":
        """Return a c + eps (a d + b c); a screw is multiplied by its own rule."""
        if not isinstance(other, Dual):
            return NotImplemented
        return Dual(self.real * other.real, self.real * other.dual + self.dual * other.real)

    def __truediv__(self, other: "Dual") -> "Dual":
        """Return a / c + eps (b c - a d) / c^2; not finite where c = 0, which has no inverse."""
        with np.errstate(divide="ignore", invalid="ignore"):
            quotient = np.divide(self.real, other.real)
            return Dual(quotient, np.divide(self.dual - quotient * other.dual, other.real))


@dataclass(frozen=True, eq=False)
class Point:
    """A point with a name for people and coordinates for the arithmetic.

    The coordinates decide; the name only says in print what a moment or a velocity is taken about, so that
    ``v_C`` cannot be read as ``v_O``. A moving point is one point with a leading axis.
    """

    name: str  # as in the drawing: 'C' for a centre of mass, 'O' for the origin
    coordinates: Floats  # (..., 3) [m] in the axes of the vectors it goes with

    def __post_init__(self) -> None:
        object.__setattr__(self, "coordinates", vectors(f"point {self.name}", self.coordinates))

    def __sub__(self, other: "Point") -> Floats:
        """Return the vector from the other point to this one, (..., 3) [m]."""
        return self.coordinates - other.coordinates


ORIGIN = Point("O", np.zeros(3))


@dataclass(frozen=True, eq=False)
class Axis:
    """The line of a screw."""

    foot: Floats  # (..., 3) [m] its point nearest the reference, NaN where there is no line
    direction: Floats  # (..., 3) [1] its unit vector


@dataclass(frozen=True, eq=False)
class Screw:
    """The dual vector s + eps s0, its moment part s0 taken about a named point; or a batch of them.

    Two screws of one kind add even when their reference points differ: the second is re-expressed at the
    first's point. Nothing is guessed in that, since both points carry coordinates and the sum is the same
    screw whichever point is used; the mistake worth stopping, adding moments taken about different points,
    cannot be written down. Screws of different kinds never add, whatever their points.
    Raises ValueError if a shape is wrong, leading axes do not fit, or an entry is not finite.
    Source: R. S. Ball, "A Treatise on the Theory of Screws", Cambridge University Press, 1900. J. K.
    Davidson, K. H. Hunt, "Robots and Screw Theory", Oxford University Press, 2004.
    """

    resultant: Floats  # (..., 3) s: line direction times magnitude
    moment: Floats  # (..., 3) s0: moment about ``reference``
    reference: Point = ORIGIN

    __array_ufunc__ = None  # numpy leaves `array * screw` to us

    def __post_init__(self) -> None:
        parts = self.resultant, self.moment
        shape = np.broadcast_shapes(*map(np.shape, parts), self.reference.coordinates.shape)
        for name, part in zip(("resultant", "moment"), parts, strict=True):
            object.__setattr__(self, name, vectors(name, np.broadcast_to(part, shape)))

    @classmethod
    def on_axis(
        cls,
        foot: ArrayLike,
        direction: ArrayLike,
        magnitude: ArrayLike = 1.0,
        pitch: ArrayLike = 0.0,
        reference: Point = ORIGIN,
    ) -> Self:
        """Return the screw of a given line, magnitude and pitch, expressed at ``reference``.

        The pitch is the length along the axis that belongs to one radian about it. Pitch zero gives a pure
        force or a pure rotation. An infinite pitch gives a free vector: a couple or a translation, which has
        no line.

        Parameters
        ----------
        foot : (..., 3) float [m]
            Any point of the line; not used where the pitch is infinite.
        direction : (..., 3) float [1]
            Direction of the line, of any length but zero.
        magnitude : (...,) float [any]
            |s|, or |s0| where the pitch is infinite.
        pitch : (...,) float [m]
        reference : Point
            Point about which the moment part is taken.

        Returns
        -------
        Screw
            s + eps (h s + OF x s), with the foot F and the pitch h.

        Raises
        ------
        ValueError
            If the direction has no length, a shape is wrong, or an entry is not finite.
        """
        direction, pitch = vectors("direction", direction), np.asarray(pitch, dtype=float)[..., None]
        size, free = length(direction)[..., None], np.isinf(pitch)
        if (size == 0.0).any():
            raise ValueError("direction has no length")
        along = np.asarray(magnitude, dtype=float)[..., None] * direction / size
        parallel = np.where(free, 1.0, pitch) * along
        line = Point("foot", np.where(free, reference.coordinates, foot))
        return cls(np.where(free, 0.0, along), parallel, line).at(reference)

    @property
    def shape(self) -> tuple[int, ...]:
        """Leading axes; () for one screw."""
        return self.resultant.shape[:-1]

    def __getitem__(self, index: Choice | tuple[Choice, ...]) -> Self:
        """Return a part of a batch; the index acts on the leading axes, as in an array."""
        index = (*index, slice(None)) if isinstance(index, tuple) else index
        place = np.broadcast_to(self.reference.coordinates, self.resultant.shape)
        moving = self.reference.coordinates.ndim > 1
        point = Point(self.reference.name, place[index]) if moving else self.reference
        return type(self)(self.resultant[index], self.moment[index], point)

    def at(self, point: Point) -> Self:
        """Return the same screw with its moment about another point: s0(P) = s0(O) + s x OP.

        Parameters
        ----------
        point : (..., 3) float [m]

        Returns
        -------
        Screw
            Of the same kind.
        """
        moment = self.moment + np.cross(self.resultant, point - self.reference)
        return type(self)(self.resultant, moment, point)

    def sum(self) -> Self:
        """Return the sum over the last leading axis; at the origin where the reference points differ."""
        common = self if self.reference.coordinates.ndim == 1 else self.at(ORIGIN)
        return type(self)(common.resultant.sum(axis=-2), common.moment.sum(axis=-2), common.reference)

    def __add__(self, other: Self) -> Self:
        """Return the sum by parts, at the first screw's reference point."""
        self._same_kind(other, "add")
        other = other.at(self.reference)
        return type(self)(self.resultant + other.resultant, self.moment + other.moment, self.reference)

    def __sub__(self, other: Self) -> Self:
        self._same_kind(other, "subtract")
        return self + -other

    def __neg__(self) -> Self:
        return self * -1.0

    def __mul__(self, factor: "ArrayLike | Dual | Screw") -> Self:
        """Return the product with a real or a dual number; arrays (...,) scale screw by screw."""
        if isinstance(factor, Dual):
            real, dual = np.asarray(factor.real)[..., None], np.asarray(factor.dual)[..., None]
            moment = real * self.moment + dual * self.resultant
            return type(self)(real * self.resultant, moment, self.reference)
        if isinstance(factor, Screw):
            raise ValueError("two screws have three products: dot, cross and reciprocal")
        factor = np.asarray(factor, dtype=float)[..., None]
        return type(self)(factor * self.resultant, factor * self.moment, self.reference)

    __rmul__ = __mul__

    def __truediv__(self, divisor: ArrayLike) -> Self:
        """Return the screw divided by a real number; arrays (...,) divide screw by screw."""
        divisor = np.asarray(divisor, dtype=float)[..., None]
        with np.errstate(divide="ignore", invalid="ignore"):  # a zero is refused below, as not finite
            return type(self)(self.resultant / divisor, self.moment / divisor, self.reference)

    def dot(self, other: "Screw") -> Dual:
        """Return the scalar product s1.s2 + eps (s1.s02 + s01.s2).

        Parameters
        ----------
        other : Screw
            Of any kind.

        Returns
        -------
        Dual
        """
        other = other.at(self.reference)
        dual = dot(self.resultant, other.moment) + dot(self.moment, other.resultant)
        return Dual(dot(self.resultant, other.resultant), dual)

    def reciprocal(self, other: "Screw") -> Floats:
        """Return the reciprocal product s1.s02 + s01.s2; of a twist and a wrench the power [W].

        Parameters
        ----------
        other : Screw

        Returns
        -------
        (...) float [product of both units]
        """
        return self.dot(other).dual

    def cross(self, other: "Screw") -> "Screw":
        """Return the dual cross product (s1 x s2) + eps (s1 x s02 + s01 x s2), at the first screw's point.

        A twist crossed with a momentum screw is a ``Wrench``: the rate at which a momentum carried along by
        that twist changes. Other pairs give a plain ``Screw``.

        Parameters
        ----------
        other : Screw

        Returns
        -------
        Screw
        """
        other = other.at(self.reference)
        resultant = np.cross(self.resultant, other.resultant)
        moment = np.cross(self.resultant, other.moment) + np.cross(self.moment, other.resultant)
        kind = Wrench if isinstance(self, Twist) and isinstance(other, Momentum) else Screw
        return kind(resultant, moment, self.reference)

    @property
    def direction(self) -> Floats:
        """Unit vector of the axis, (..., 3); the moment's where s = 0; NaN for the zero screw."""
        carrier = np.where(_has_line(self)[..., None], self.resultant, self.moment)
        return ratio(carrier, length(carrier)[..., None])

    @property
    def magnitude(self) -> Floats:
        """|s|, or |s0| of a screw of infinite pitch, (...,): how much there is of the unit screw."""
        return np.where(_has_line(self), length(self.resultant), length(self.moment))[()]

    @property
    def pitch(self) -> Floats:
        """h = s.s0 / s.s, (...,) [m]; infinite for a couple or a translation, NaN for the zero screw."""
        along, size = dot(self.direction, self.moment), length(self.resultant)
        nowhere = np.where(length(self.moment) > 0.0, np.inf, np.nan)
        return ratio(along, size, nowhere)[()]

    @property
    def axis(self) -> Axis:
        """The line, foot r = s x s0 / s.s from the reference; the foot is NaN where s = 0: no line."""
        lever = ratio(np.cross(self.direction, self.moment), length(self.resultant)[..., None])
        return Axis(self.reference.coordinates + lever, self.direction)

    def unit(self) -> Self:
        """Return the screw of magnitude 1 with the same axis and pitch; the zero screw as it is."""
        size = self.magnitude
        return self / np.where(size > 0.0, size, 1.0)

    def _same_kind(self, other: "Screw", verb: str) -> None:
        if type(self) is not type(other):
            raise ValueError(f"a {type(self).__name__} and a {type(other).__name__} do not {verb}")


class Twist(Screw):
    """Angular velocity [rad/s] and the velocity [m/s] of the body's point at ``reference``, eq. [2.1]."""

    @property
    def angular_velocity(self) -> Floats:
        """omega, (..., 3) [rad/s]."""
        return self.resultant

    @property
    def velocity(self) -> Floats:
        """v of the reference point, (..., 3) [m/s]."""
        return self.moment


class Wrench(Screw):
    """Force [N] and its moment [N m] about ``reference``, eq. [4.5]."""

    @property
    def force(self) -> Floats:
        """f, (..., 3) [N]."""
        return self.resultant


class Momentum(Screw):
    """Linear momentum [kg m/s] and angular momentum [kg m2/s] about ``reference``, eq. [2.4]."""

    @property
    def linear(self) -> Floats:
        """q, (..., 3) [kg m/s]."""
        return self.resultant

    @property
    def angular(self) -> Floats:
        """H about the reference point, (..., 3) [kg m2/s]."""
        return self.moment


def _has_line(screw: Screw) -> Bools:
    """Return where s is not zero, so that there is an axis."""
    return np.any(screw.resultant != 0.0, axis=-1)


SYMMETRY_TOLERANCE = 1e-9  # of the largest entry of an inertia matrix
INDEPENDENCE_TOLERANCE = 1e-12  # of the largest singular value: below it a contact adds nothing to the others


@dataclass(frozen=True, eq=False)
class Body:
    """Mass properties, constant in axes fixed to the body.

    Raises ValueError if the mass is not positive, or the inertia is not symmetric and positive definite.
    """

    mass: Floats  # (...,) [kg]
    inertia: Floats  # (..., 3, 3) [kg m2] about the centre of mass
    centre: Point  # G, the centre of mass

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

    def momentum(self, twist: Twist) -> Momentum:
        """Return the momentum screw q + eps H_A of the body that moves with a twist omega + eps v_A.

            q   = m (v_A + omega x AG)         eq. [2.2]
            H_A = I_A omega + m AG x v_A       eq. [2.3]

        G is the centre of mass, A the twist's reference point, and I_A the inertia about A by Huygens and
        Steiner: I_A = I_G + m (|AG|^2 E - AG AG^T). Together they are eq. [2.4]. The thesis writes the screw
        out in eqs. [4.8], [4.39], for the twists of eqs. [4.7], [4.38].

        Parameters
        ----------
        twist : Twist
            Components in axes fixed to the body.

        Returns
        -------
        Momentum
            [kg m/s] and [kg m2/s], at the twist's reference point.
        """
        spin, speed, lever = twist.resultant, twist.moment, self.centre - twist.reference
        mass = np.asarray(self.mass)[..., None]
        linear = mass * (speed + np.cross(spin, lever))  # eq. [2.2]
        square = dot(lever, lever)[..., None, None] * np.eye(3)
        about = self.inertia + mass[..., None] * (square - lever[..., :, None] * lever[..., None, :])
        angular = np.einsum("...ij,...j->...i", about, spin) + mass * np.cross(lever, speed)  # eq. [2.3]
        return Momentum(linear, angular, twist.reference)


def force_screw(body: Body, twist: Twist, twist_rate: Twist) -> Wrench:
    """Return the wrench that a moving body needs: the dual Euler equation.

        wrench = twist (x) momentum + d/dt momentum        eq. [4.6]

    The components are those along axes that turn with the body. The derivative of such components misses the
    turning of the axes themselves; the term twist (x) momentum, eq. [4.4], adds it. The thesis writes the
    wrench out for its parts on the floor, eqs. [4.9] to [4.12], eqs. [4.40] to [4.42], and on the track,
    eqs. [4.30], [4.31], eqs. [4.55], [4.56].

    Parameters
    ----------
    body : Body
    twist : Twist
        (...,) omega + eps v_A [rad/s, m/s] about a point A of the body, along body axes.
    twist_rate : Twist
        (...,) time derivatives of those components [rad/s2, m/s2]; given about another point of the body,
        they are re-expressed at A.

    Returns
    -------
    Wrench
        [N, N m] at A.

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

    A body that is about to leave contact i, and keeps all others, moves with twist i: its ``axis`` is the
    line about which the body tips. The sense is the one that opens the contact, so the reciprocal product
    with the contact's own wrench is positive.

    Parameters
    ----------
    wrenches : Wrench
        (..., 6) wrenches with which the contacts push on the body.

    Returns
    -------
    Twist
        (..., 6) [1], column i of the inverse of the six wrenches, at the first wrench's reference point.

    Raises
    ------
    ValueError
        If there are not six wrenches, or they are not independent.

    References
    ----------
    K. H. Hunt, "Kinematic Geometry of Mechanisms", Oxford University Press, 1978.
    """
    if len(wrenches.shape) < 1:
        raise ValueError("wrenches need an axis that counts them: (..., k)")
    if wrenches.shape[-1] != 6:
        raise ValueError(f"there are {wrenches.shape[-1]} wrenches, not six")
    point = wrenches.reference
    if point.coordinates.ndim > 1:
        point = Point(point.name, point.coordinates[..., :1, :])
    wrenches = wrenches.at(point)  # moments about different points cannot stand in one matrix
    # Rows (f, m / arm) of length 1. The arm (...,) [m], a typical lever, makes force and moment comparable:
    # no answer depends on the unit of length.
    force, moment = (length(part).max(axis=-1, initial=0.0) for part in (wrenches.resultant, wrenches.moment))
    arm = np.divide(moment, force, out=np.ones_like(force), where=(force > 0.0) & (moment > 0.0))
    arm = arm[..., None, None]
    rows = np.concatenate([wrenches.resultant, wrenches.moment / arm], axis=-1)
    size = np.linalg.norm(rows, axis=-1, keepdims=True)
    rows = rows / np.where(size > 0.0, size, 1.0)
    values = np.linalg.svd(rows, compute_uv=False)
    dependent = values[..., -1] <= INDEPENDENCE_TOLERANCE * values[..., 0]
    if dependent.any():
        raise ValueError(f"{dependent.sum()} of {dependent.size} sets of six wrenches are not independent")
    # Column i of the inverse has product 1 with row i and 0 with the others: it is the reciprocal twist, as
    # (v, arm times omega). A turn lost in rounding is set to zero, so that the twist is a translation.
    columns = np.swapaxes(np.linalg.inv(rows), -1, -2)
    speed, spin = columns[..., :3], columns[..., 3:]
    lost = length(spin) <= INDEPENDENCE_TOLERANCE * length(speed)
    return Twist(np.where(lost[..., None], 0.0, spin) / arm, speed, point).unit()


def reactions(wrenches: Wrench, external: Wrench) -> Floats:
    """Return how hard each of six contacts pushes: the solution of sum_i lambda_i w_i = -external.

        lambda_i = -(external o t_i) / (w_i o t_i)

    The twist t_i of ``tipping_twists`` is reciprocal to all contacts but i. Its product with the sum
    therefore leaves lambda_i alone, and no system of equations is solved here.

    Parameters
    ----------
    wrenches : Wrench
        (..., 6) wrenches of the contacts, each for a reaction of 1.
    external : Wrench
        (...,) [N, N m] everything else that acts on the body: weight, inertia, drive.

    Returns
    -------
    (..., 6) float [1]
        Multiples of the wrenches; negative where the contact would have to pull.

    Raises
    ------
    ValueError
        As in ``tipping_twists``.

    References
    ----------
    Reciprocal screws: R. S. Ball 1900; docs/method/screws.md, "Contacts: reciprocal screws".
    """
    twists, place = tipping_twists(wrenches), external.reference
    # The external wrench gets an axis of length one, on which it meets each of the six twists.
    if place.coordinates.ndim > 1:
        place = Point(place.name, place.coordinates[..., None, :])
    acting = Wrench(external.resultant[..., None, :], external.moment[..., None, :], place)
    return -acting.reciprocal(twists) / wrenches.reciprocal(twists)
