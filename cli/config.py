"""``feeder config``: write a bowl file, show what holds."""

import click

from feederscrew_cli import grouped, options
from feederscrew_cli.options import Output, Values

FORCE = options.flag("--force replace", "Replace the file if it exists.")
FILE_OR_STDOUT = click.argument("file", type=options.FILE, default="-")


@click.group(
    cls=grouped.Words,
    short_help="Write a commented bowl file; show the values in effect.",
    invoke_without_command=True,
)
@click.pass_context
def config(ctx: click.Context) -> None:
    """Example: feeder config init bowl.yaml

    Bowl files: start one with all defaults, show the values in effect and where each came from, or print the
    schema that editors complete and check them by.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())


@config.command(short_help="Write a commented bowl file of all defaults.")
@FILE_OR_STDOUT
@FORCE
@options.option("--machine", "NAME", "A usual drive unit instead of all defaults; 'list' shows them.")
@options.QUIET
def init(file: str, replace: bool, machine: str | None, quiet: bool) -> None:
    """Example: feeder config init bowl.yaml

    Write a bowl file of all defaults, each key with its meaning, to FILE or to standard output. Its first
    line names the JSON Schema that editors complete and check it by; with FILE that is written beside it.

    With --machine NAME: the bowl file of a usual drive unit, with its diameter, frequency, springs, masses
    and greatest stroke. feeder design keeps that machine and looks for the stroke. --machine list prints a
    line for each drive unit and writes no file.
    """
    from feederscrew.bowl import documentation
    from feederscrew.machine import drive_sizing

    if machine is not None and machine.strip().casefold() == "list":
        click.echo("\n".join(drive_sizing.lines()))
        return
    text = documentation.template() if machine is None else drive_sizing.bowl_file(drive_sizing.unit(machine))
    if file == "-":
        click.echo(text, nl=False)
    else:
        documentation.write_new(file, text, replace=replace)
        out = Output.of_call(format="table", quiet=quiet)
        out.say(f"Wrote {file}", f"Wrote {documentation.write_beside(file)}, which editors read")


@config.command(short_help="Print the JSON Schema of a bowl file, for editors.")
@FILE_OR_STDOUT
@FORCE
@options.QUIET
def schema(file: str, replace: bool, quiet: bool) -> None:
    """Example: feeder config schema feeder.schema.json

    Write the JSON Schema of a bowl file to FILE or to standard output: its keys with units, bounds, defaults
    and meaning, and every device. Editors with a YAML language server then complete and check bowl files
    that begin with '# yaml-language-server: $schema=feeder.schema.json', as those of config init do.
    """
    from feederscrew.bowl import documentation

    if file == "-":
        click.echo(documentation.schema_text(), nl=False)
    else:
        documentation.write_new(file, documentation.schema_text(), replace=replace)
        Output.of_call(format="table", quiet=quiet).say(f"Wrote {file}")


@config.command(short_help="List the materials that --density knows.")
@options.printed
def materials(out: Output) -> None:
    """Example: feeder config materials

    List the materials that --density and the key 'density' of a part card know by name, with their densities.
    """
    from feederscrew.output import inertia

    frame = inertia.materials()
    out.show(frame, {"materials": list(frame.rows())})


@config.command(short_help="Show the values in effect and where each came from.")
@click.argument("file", type=options.FILE, required=False)
@options.bowl
@options.output
def show(file: str | None, bowl: Values, out: Output) -> None:
    """Example: feeder config show bowl.yaml --set drive.frequency="50 Hz"

    Show every value in effect and where it came from: the default, a line of the bowl file, or --set. The
    bowl file is given as FILE or by --config.
    """
    from feederscrew.bowl import identity, name, settings, texts
    from feederscrew.output import slide, tables

    if file is not None and options.is_typed("path"):
        raise click.UsageError(f"{file} is given, and --config as well - leave one of them out")
    bowl = bowl if file is None else {**bowl, "path": file}
    out.tell_unread(bowl["path"])
    bowl_settings, path = settings(**bowl), bowl["path"]
    frame = slide.settings(bowl_settings)
    with out.folder(name(path), identity(path), texts(bowl_settings)) as folder:
        if folder:
            folder.write("config.csv", tables.text(frame, "csv"))
    out.show(frame, {"settings": frame}, hidden=("lowest", "highest", "meaning"))
