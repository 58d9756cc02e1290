"""Screws with a named reference point, and the three kinds mechanics needs: Twist, Wrench, Momentum."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from feederscrew import check

Array = NDArray[np.float64]


def vectors(name: str, value: ArrayLike) -> Array:
    """Return a finite float copy of an array of 3-vectors, closed to writing.

    Parameters
    ----------
    name : str
        The argument, as the caller knows it.
    value : (..., 3) array_like [any]
        Any leading axes.

    Returns
    -------
    (..., 3) float [the same]

    Raises
    ------
    ValueError
        If the last axis is not of length 3 or an entry is not finite.
    """
    array = np.array(value, dtype=float)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} has shape {array.shape}, not (..., 3)")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return check.frozen(array)


def dot(u: Array, v: Array) -> Array:
    """Return the scalar product (...,) over the last axis of (..., 3) and (..., 3) [any units].

    Source: its definition.
    """
    return np.einsum("...i,...i->...", u, v)


def length(u: Array) -> Array:
    """Return the length (...,) of vectors (..., 3), in their unit [any]; no square overflows or vanishes.

    Source: own: scaled by the largest component.
    """
    return np.hypot(np.hypot(u[..., 0], u[..., 1]), u[..., 2])


@dataclass(frozen=True, eq=False)
class Dual:
    """A dual number, or an array of them; NaN marks a number that does not exist.

    Parameters
    ----------
    real : (...,) float
        The part without eps: of a dual angle the angle, of a product of screws the scalar product.
    dual : (...,) float
        The part with eps: of a dual angle the distance, of a product of screws the reciprocal product.

    References
    ----------
    W. K. Clifford, "Preliminary sketch of biquaternions", Proc. London Math. Soc. 4, 381-395, 1873.
    """

    real: Array
    dual: Array

    def __add__(self, other: "Dual") -> "Dual":
        """(a + c) + eps (b + d)."""
        return Dual(self.real + other.real, self.dual + other.dual)

    def __sub__(self, other: "Dual") -> "Dual":
        """(a - c) + eps (b - d)."""
        return Dual(self.real - other.real, self.dual - other.dual)

    def __mul__(self, other: "Dual") -> "Dual":
        """Product a c + eps (a d + b c); a screw is multiplied by its own rule."""
        if not isinstance(other, Dual):
            return NotImplemented
        return Dual(self.real * other.real, self.real * other.dual + self.dual * other.real)

    def __truediv__(self, other: "Dual") -> "Dual":
        """Quotient a / c + eps (b c - a d) / c^2; not finite where c = 0, which has no inverse."""
        with np.errstate(divide="ignore", invalid="ignore"):
            quotient = np.divide(self.real, other.real)
            return Dual(quotient, np.divide(self.dual - quotient * other.dual, other.real))


@dataclass(frozen=True, eq=False)
class Point:
    """A point with a name for people and coordinates for the arithmetic.

    The coordinates decide; the name only says in print what a moment or a velocity is taken about, so that
    ``v_C`` cannot be read as ``v_O``. A moving point is one point with a leading axis.

    Parameters
    ----------
    name : str
        As in the drawing: 'C' for a centre of mass, 'O' for the origin.
    coordinates : (..., 3) float [m]
        In the axes of the vectors it goes with.
    """

    name: str
    coordinates: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "coordinates", vectors(f"point {self.name}", self.coordinates))

    def __sub__(self, other: "Point") -> Array:
        """The vector from the other point to this one, (..., 3) [m]."""
        return self.coordinates - other.coordinates


ORIGIN = Point("O", np.zeros(3))


@dataclass(frozen=True, eq=False)
class Axis:
    """The line of a screw: ``foot`` (..., 3) [m] its point nearest the reference, NaN where there is no
    line; ``direction`` (..., 3) [1] its unit vector.
    """

    foot: Array
    direction: Array


@dataclass(frozen=True, eq=False)
class Screw:
    """The dual vector s + eps s0, its moment part s0 taken about a named point; or a batch of them.

    Two screws of one kind add even when their reference points differ: the second is re-expressed at the
    first's point. Nothing is guessed in that, since both points carry coordinates and the sum is the same
    screw whichever point is used; the mistake worth stopping, adding moments taken about different points,
    cannot be written down. Screws of different kinds never add, whatever their points.

    Parameters
    ----------
    resultant : (..., 3) float
        s: line direction times magnitude.
    moment : (..., 3) float
        s0: moment about ``reference``.
    reference : Point
        Where ``moment`` is taken; the origin of coordinates unless said.

    Raises
    ------
    ValueError
        If a shape is wrong, leading axes do not fit, or an entry is not finite.

    References
    ----------
    R. S. Ball, "A Treatise on the Theory of Screws", Cambridge University Press, 1900.
    J. K. Davidson, K. H. Hunt, "Robots and Screw Theory", Oxford University Press, 2004.
    """

    resultant: Array
    moment: Array
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
        """Return the screw of a given line, magnitude and pitch; infinite pitch makes it a free vector.

        Parameters
        ----------
        foot : (..., 3) float [m]
            Any point of the line; not looked at where the pitch is infinite.
        direction : (..., 3) float [1]
            Along the line, of any length but zero.
        magnitude : (...,) float
            |s|, or |s0| where the pitch is infinite.
        pitch : (...,) float [m]
            Zero for a pure force or rotation.
        reference : Point
            Where the result is to be expressed.

        Raises
        ------
        ValueError
            If the direction has no length, a shape is wrong or an entry is not finite.
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
        """The leading axes: () for one screw."""
        return self.resultant.shape[:-1]

    def __getitem__(self, index: Any) -> Self:
        """Part of a batch, indexed as an array over the leading axes is."""
        index = (*index, slice(None)) if isinstance(index, tuple) else index
        place = np.broadcast_to(self.reference.coordinates, self.resultant.shape)
        moving = self.reference.coordinates.ndim > 1
        point = Point(self.reference.name, place[index]) if moving else self.reference
        return type(self)(self.resultant[index], self.moment[index], point)

    def at(self, point: Point) -> Self:
        """Return the same screw with its moment about another point: s0(P) = s0(O) + s x OP."""
        moment = self.moment + np.cross(self.resultant, point - self.reference)
        return type(self)(self.resultant, moment, point)

    def sum(self) -> Self:
        """Sum over the last leading axis; where the reference point differs along it, at the origin."""
        common = self if self.reference.coordinates.ndim == 1 else self.at(ORIGIN)
        return type(self)(common.resultant.sum(axis=-2), common.moment.sum(axis=-2), common.reference)

    def __add__(self, other: Self) -> Self:
        """Sum by parts, at the first screw's reference point."""
        self._same_kind(other, "add")
        other = other.at(self.reference)
        return type(self)(self.resultant + other.resultant, self.moment + other.moment, self.reference)

    def __sub__(self, other: Self) -> Self:
        """Difference by parts, at the first screw's reference point."""
        self._same_kind(other, "subtract")
        return self + -other

    def __neg__(self) -> Self:
        """The opposite screw."""
        return self * -1.0

    def __mul__(self, factor: Any) -> Self:
        """Times an ordinary number or a dual one; arrays (...,) scale screw by screw."""
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
        """Over an ordinary number; arrays (...,) screw by screw."""
        divisor = np.asarray(divisor, dtype=float)[..., None]
        with np.errstate(divide="ignore", invalid="ignore"):  # a zero is refused below, as not finite
            return type(self)(self.resultant / divisor, self.moment / divisor, self.reference)

    def dot(self, other: "Screw") -> Dual:
        """Return the scalar product s1.s2 + eps (s1.s02 + s01.s2), a ``Dual``; any two kinds."""
        other = other.at(self.reference)
        dual = dot(self.resultant, other.moment) + dot(self.moment, other.resultant)
        return Dual(dot(self.resultant, other.resultant), dual)

    def reciprocal(self, other: "Screw") -> Array:
        """Return the reciprocal product s1.s02 + s01.s2, (...,); of a twist and a wrench the power [W]."""
        return self.dot(other).dual

    def cross(self, other: "Screw") -> "Screw":
        """Return the dual cross product (s1 x s2) + eps (s1 x s02 + s01 x s2), at the first screw's point.

        A twist crossed with a momentum screw is a ``Wrench``: the rate at which a momentum carried along by
        that twist changes. Other pairs have no name in mechanics and give a plain ``Screw``.
        """
        other = other.at(self.reference)
        resultant = np.cross(self.resultant, other.resultant)
        moment = np.cross(self.resultant, other.moment) + np.cross(self.moment, other.resultant)
        kind = Wrench if isinstance(self, Twist) and isinstance(other, Momentum) else Screw
        return kind(resultant, moment, self.reference)

    @property
    def direction(self) -> Array:
        """Unit vector of the axis, (..., 3); the moment's where s = 0; NaN for the zero screw."""
        carrier = np.where(_has_line(self)[..., None], self.resultant, self.moment)
        size = length(carrier)[..., None]
        return np.divide(carrier, size, out=np.full(carrier.shape, np.nan), where=size > 0.0)

    @property
    def magnitude(self) -> Array:
        """|s|, or |s0| of a screw of infinite pitch, (...,): how much there is of the unit screw."""
        return np.where(_has_line(self), length(self.resultant), length(self.moment))[()]

    @property
    def pitch(self) -> Array:
        """h = s.s0 / s.s, (...,) [m]; infinite for a couple or a translation, NaN for the zero screw."""
        along, size = dot(self.direction, self.moment), length(self.resultant)
        nowhere = np.where(length(self.moment) > 0.0, np.inf, np.nan)
        return np.divide(along, size, out=nowhere, where=size > 0.0)[()]

    @property
    def axis(self) -> Axis:
        """The line, foot r = s x s0 / s.s from the reference; the foot is NaN where s = 0: no line."""
        lever = np.cross(self.direction, self.moment)
        size = length(self.resultant)[..., None]
        lever = np.divide(lever, size, out=np.full(lever.shape, np.nan), where=size > 0.0)
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
    def angular_velocity(self) -> Array:
        """omega, (..., 3) [rad/s]."""
        return self.resultant

    @property
    def velocity(self) -> Array:
        """v of the reference point, (..., 3) [m/s]."""
        return self.moment


class Wrench(Screw):
    """Force [N] and its moment [N m] about ``reference``, eq. [4.5]."""

    @property
    def force(self) -> Array:
        """f, (..., 3) [N]."""
        return self.resultant


class Momentum(Screw):
    """Linear momentum [kg m/s] and angular momentum [kg m2/s] about ``reference``, eq. [2.4]."""

    @property
    def linear(self) -> Array:
        """q, (..., 3) [kg m/s]."""
        return self.resultant

    @property
    def angular(self) -> Array:
        """H about the reference point, (..., 3) [kg m2/s]."""
        return self.moment


def _has_line(screw: Screw) -> NDArray[np.bool_]:
    """Where s is not zero, so that there is an axis."""
    return np.any(screw.resultant != 0.0, axis=-1)
