"""Help of commands with many options: what they have in common stands in groups, below their own."""

import click

LONG = 12  # options from which on they are grouped
GROUPS = {  # heading: names of the options
    "The part": ("units", "density", "centre_of_mass", "names", "body", "allow_open"),
    "The bowl": ("path", "paths", "overrides"),
    "How parts arrive": ("launch", "rule", "probabilities", "surface", "surface_exponent"),
    "The run": ("seed", "jobs"),
    "Output": ("pictures", "directory", "depfile", "format", "quiet", "verbose"),
}
OF = {name: heading for heading, names in GROUPS.items() for name in names}
OWN = "Options"


class Grouped(click.Command):
    """A command whose help lists its own options first, then those that it shares with others."""

    def format_options(self, ctx, formatter):
        """Write the options, in groups if there are many."""
        shown = [one for one in self.get_params(ctx) if isinstance(one, click.Option)]
        records = [(OF.get(one.name, OWN), one.get_help_record(ctx)) for one in shown]
        records = [(heading, record) for heading, record in records if record is not None]
        if len(records) < LONG:
            super().format_options(ctx, formatter)
            return
        for heading in (OWN, *GROUPS):
            rows = [record for at, record in records if at == heading]
            if rows:
                with formatter.section(heading):
                    formatter.write_dl(rows)


def command(**keywords):
    """Return the decorator ``click.command`` for a ``Grouped`` command."""
    return click.command(cls=Grouped, **keywords)
