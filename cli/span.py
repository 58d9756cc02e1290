"""Two lengths as people type them: '200mm:400mm'."""

import click

from feederscrew_cli.quantity import Quantity


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
