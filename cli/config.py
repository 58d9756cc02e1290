"""``feeder config``: write a bowl file, show what holds."""

import click

from feederscrew_cli import options


@click.group(
    short_help="Write a commented bowl file; show the values in effect.", invoke_without_command=True
)
@click.pass_context
def config(ctx):
    """Example: feeder config init bowl.yaml

    Bowl files: start one with all defaults, or show the values in effect and where each came from.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())


@config.command(short_help="Write a commented bowl file of all defaults.")
@click.argument("file", type=options.FILE, default="-")
@click.option("--force", "replace", is_flag=True, help="Replace the file if it exists.")
def init(file, replace):
    """Example: feeder config init bowl.yaml

    Write a bowl file of all defaults, each key with its meaning, to FILE or to standard output.
    """
    from feederscrew.bowl import documentation

    if file == "-":
        click.echo(documentation.template(), nl=False)
    else:
        documentation.write_template(file, replace=replace)
        click.echo(f"Wrote {file}", err=True)


@config.command(short_help="Show the values in effect and where each came from.")
@options.bowl
@options.output
def show(bowl, out):
    """Example: feeder config show --config bowl.yaml --set drive.frequency="50 Hz"

    Show every value in effect and where it came from: the default, a line of the bowl file, or --set.
    """
    from feederscrew.bowl import identity, name, settings, texts
    from feederscrew.output import tables
    from feederscrew.output.slide import tables as slide_tables

    given, path = settings(**bowl), bowl["path"]
    frame = slide_tables.settings(given)
    with out.folder(name(path), identity(path), texts(given)) as folder:
        if folder:
            folder.write("config.csv", tables.text(frame, "csv"))
    out.show(frame, {"settings": frame}, hidden=("lowest", "highest", "meaning"))
