"""Angles as people type them: '30deg', '30 deg', '0.5 rad', '30'."""

import math

import click

MOST = 20.0 * math.pi  # [rad] further round, rounding begins to tell


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
        if not -MOST <= angle <= MOST:
            return self.fail(f"{value!r} is out of range - stay within ten turns", param, ctx)
        return angle
