"""``feeder doctor``."""

import click

from feederscrew_cli import grouped


@grouped.command(short_help="What is installed here, what is missing, and how to get it.")
def doctor():
    """Example: feeder doctor

    Print the versions of Python and of every library, and which extras are there. Of one that is not, the
    line that installs it is printed. Then where compiled kernels are kept, and how to turn on completion.
    """
    from feederscrew_cli import health

    for title, lines in health.report().items():
        click.echo(click.style(title, bold=True))
        for name, value in lines:
            click.echo(f"  {name:<20} {value}")
