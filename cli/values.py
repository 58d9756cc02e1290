"""Types of values on the command line: paths, numbers, quantities with their units."""

import math
import re

import click

MICRO_SIGNS = str.maketrans("\u00b5\u03bc", "uu")  # the sign of its own, and the Greek letter
WHOLE_NUMBER = re.compile(r"[+-]?[0-9]{1,30}")
DECIMAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
MAX_ANGLE_RAD = 20.0 * math.pi  # further round, rounding begins to tell


class Place(click.Path):
    """A path; the library says what is wrong with it, unless it is none, as of an unset shell variable."""

    def convert(self, value, param, ctx):
        """The path as typed, or a wrong call."""
        return (
            super().convert(value, param, ctx) if value else self.fail("is empty - give a path", param, ctx)
        )


class LengthUnit(click.Choice):
    """A unit of a file; that of a micrometre also with its sign."""

    def convert(self, value, param, ctx):
        """The unit, or a wrong call."""
        return super().convert(value.translate(MICRO_SIGNS) if isinstance(value, str) else value, param, ctx)


class Number(click.FloatRange):
    """A number within limits, of the digits 0 to 9; not 'nan', which is within any."""

    name = "number"

    def convert(self, value, param, ctx):
        """The number, or a wrong call."""
        if isinstance(value, str) and not DECIMAL.fullmatch(value.strip()):
            self.fail(f"{value!r} is not a number", param, ctx)
        number = super().convert(value, param, ctx)
        return number if number == number else self.fail(f"{value!r} is not a number", param, ctx)


class Whole(click.IntRange):
    """A whole number within limits, of the digits 0 to 9: Python takes those of other scripts, and '1_0'."""

    def convert(self, value, param, ctx):
        """The number, or a wrong call."""
        if isinstance(value, str) and not WHOLE_NUMBER.fullmatch(value.strip()):
            self.fail(f"{value!r} is not a valid whole number - write digits, as 10", param, ctx)
        return super().convert(value, param, ctx)


class Quantity(click.ParamType):
    """'0.5 mm', '120/min': a quantity of one dimension, in SI units."""

    def __init__(self, dimension, *, positive=False, most=None):
        self.name = dimension
        self.positive, self.most = positive, most

    def convert(self, value, param, ctx):
        """The number in SI units, or a wrong call."""
        from feederscrew import units

        if not isinstance(value, str):
            return value
        try:
            number = units.quantity(value, self.name)
        except units.QuantityError as fault:
            return self.fail(f"{fault.what} - {fault.mend}", param, ctx)
        return (
            number if self._within(number) else self.fail(self._range(units.quantity_text(value)), param, ctx)
        )

    def _within(self, number):
        if self.most is not None and number > self.most:
            return False
        return number > 0.0 or (number == 0.0 and not self.positive)

    def _range(self, typed):
        low = "more than 0" if self.positive else "at least 0"
        most = "" if self.most is None else f" and at most {self.most:g}"
        return f"{typed} is out of range - give {low}{most}"


class Angle(click.ParamType):
    """An angle in radians; a number alone is in degrees."""

    name = "angle"

    def convert(self, value, param, ctx):
        """The angle, or a wrong call."""
        from feederscrew.units import QuantityError, quantity

        try:
            angle = quantity(value, "angle", bare="deg") if isinstance(value, str) else value
        except QuantityError as fault:
            return self.fail(str(fault), param, ctx)
        if not -MAX_ANGLE_RAD <= angle <= MAX_ANGLE_RAD:
            return self.fail(f"{value!r} is out of range - stay within ten turns", param, ctx)
        return angle


class Span(click.ParamType):
    """A least and a greatest length in metres; one alone is both."""

    name = "span"

    def convert(self, value, param, ctx):
        """The two lengths, or a wrong call."""
        if not isinstance(value, str):
            return value
        ends = value.split(":")
        if len(ends) > 2:
            return self.fail(f"{value!r} has more than two ends - write 200mm:400mm", param, ctx)
        low, high = (
            Quantity("length", positive=True).convert(end, param, ctx) for end in (ends[0], ends[-1])
        )
        return (
            (low, high)
            if low <= high
            else self.fail(f"{value!r} runs backwards - write 200mm:400mm", param, ctx)
        )
