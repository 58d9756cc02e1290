"""Dual numbers: a + eps b with eps squared equal to zero."""

from dataclasses import dataclass
from numbers import Real

import numpy as np


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

    real: np.ndarray
    dual: np.ndarray

    __array_ufunc__ = None  # numpy leaves `array * dual` to us

    def __post_init__(self):
        for name in ("real", "dual"):
            part = np.array(getattr(self, name), dtype=float)
            part.setflags(write=False)
            object.__setattr__(self, name, part[()])

    def __add__(self, other):
        """(a + c) + eps (b + d)."""
        other = as_dual(other)
        return Dual(self.real + other.real, self.dual + other.dual)

    __radd__ = __add__

    def __neg__(self):
        """The opposite number."""
        return Dual(-self.real, -self.dual)

    def __sub__(self, other):
        """(a - c) + eps (b - d)."""
        return self + -as_dual(other)

    def __rsub__(self, other):
        """An ordinary number minus this one."""
        return as_dual(other) - self

    def __mul__(self, other):
        """Product a c + eps (a d + b c); a screw is multiplied by its own rule."""
        if not isinstance(other, (Dual, Real, np.ndarray)):
            return NotImplemented
        other = as_dual(other)
        return Dual(self.real * other.real, self.real * other.dual + self.dual * other.real)

    __rmul__ = __mul__

    def __truediv__(self, other):
        """Quotient a / c + eps (b c - a d) / c^2; not finite where c = 0, which has no inverse."""
        other = as_dual(other)
        with np.errstate(divide="ignore", invalid="ignore"):
            quotient = np.divide(self.real, other.real)
            return Dual(quotient, np.divide(self.dual - quotient * other.dual, other.real))

    def __rtruediv__(self, other):
        """An ordinary number over this one."""
        return as_dual(other) / self

    def sin(self):
        """Return the sine of a dual angle, sin a + eps d cos a."""
        return Dual(np.sin(self.real), self.dual * np.cos(self.real))

    def cos(self):
        """Return the cosine of a dual angle, cos a - eps d sin a."""
        return Dual(np.cos(self.real), -self.dual * np.sin(self.real))

    def sqrt(self):
        """Return the square root; its dual part does not exist where the real part is zero."""
        root = np.sqrt(self.real)
        with np.errstate(divide="ignore", invalid="ignore"):
            return Dual(root, np.divide(self.dual, 2.0 * root))


def as_dual(number):
    """Return the same number as a ``Dual``; an ordinary one has no dual part."""
    return number if isinstance(number, Dual) else Dual(number, np.zeros(np.shape(number)))
