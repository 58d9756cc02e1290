"""An option's value with its unit."""

import click

METAVARS = {"length": "LENGTH", "number": "SHARE", "time": "TIME"}


def with_default(names, dimension, default, meaning, former=(), **bounds):
    """An option of a quantity with a default, which its help shows; bounds as of ``Quantity``."""
    from feederscrew_cli.options import Renamed  # which stands on this module

    renamed = {"cls": Renamed, "former": former} if former else {}
    return click.option(
        *names.split(),
        **renamed,
        type=Quantity(dimension, **bounds),
        default=default,
        show_default=True,
        metavar=METAVARS[dimension],
        help=meaning,
    )


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
