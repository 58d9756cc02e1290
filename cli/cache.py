"""``feeder cache``: what earlier runs have kept on the disk, and how to be rid of it."""

import click

from feederscrew_cli import grouped, options
from feederscrew_cli.options import Output


@click.group(
    cls=grouped.Words,
    short_help="What earlier runs have kept on the disk; clear it.",
    invoke_without_command=True,
)
@click.pass_context
def cache(ctx: click.Context) -> None:
    """Example: feeder cache

    Print where simulations of earlier runs are kept, how many they are and how large. A command that needs
    one of them again reads it. The folder is named by FEEDER_CACHE; set to nothing, nothing is kept.
    """
    if ctx.invoked_subcommand is None:
        from feederscrew.arrivals import simulation_cache
        from feederscrew.base import caches

        folder, refused = caches.simulation_folder(), simulation_cache.refusal()
        if folder is None:
            click.echo("no cache: FEEDER_CACHE is empty, or there is no home folder")
            return
        files = simulation_cache.entries()
        size = sum(path.stat().st_size for path in files if path.exists())
        click.echo(f"{folder}: {len(files)} simulations, {size / 1e6:.3g} MB")
        if refused:
            click.echo(f"Warning: {refused}", err=True)


@cache.command(short_help="Delete what earlier runs have kept.")
@options.QUIET
def clear(quiet: bool) -> None:
    """Example: feeder cache clear

    Delete the simulations that earlier runs have kept, and no other file. The next run makes them again.
    """
    from feederscrew.arrivals import simulation_cache
    from feederscrew.base import caches

    out = Output.of_call(format="table", quiet=quiet)
    count = simulation_cache.clear()
    refused = simulation_cache.refusal()
    if refused:
        out.warn(refused)
    out.say(f"Deleted {count} simulations from {caches.simulation_folder() or 'no cache'}")
