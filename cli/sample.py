"""``feeder sample``."""

from pathlib import Path

import click

from feederscrew_cli import grouped, options
from feederscrew_cli.options import Output


@grouped.command(short_help="Write a part, a bowl file or counts to begin with.")
@click.argument("name", required=False)
@click.argument("size", required=False, default="")
@options.option(
    "--ratio",
    "NUMBER",
    "Thickness over width of t-shape.  [default: 0.4]",
    type=options.Number(min=0, min_open=True),
)
@options.option(
    "--wall",
    "LENGTH",
    "Thickness of cap and bracket.  [default: 1 mm]",
    type=options.quantity_type("length", positive=True),
)
@options.flag("--step", "Write the exact faces beside the mesh; sizes of your own need the extra cad.")
@options.flag("--all everything", "Write every file that an example of --help names.")
@options.flag("--force replace", "Write over a file of the same name.")
@options.FORMAT
@options.QUIET
def sample(
    name: str | None,
    size: str,
    ratio: float | None,
    wall: float | None,
    step: bool,
    everything: bool,
    replace: bool,
    format: str,
    quiet: bool,
) -> None:
    """Example: feeder sample washer_m6

    Write a file into the current folder: a part, a bowl file, or counts of dropped parts. Without NAME it
    lists what there is.

    A family takes a size: hex-bolt M8x25, socket-screw M3x8, hex-nut M6, washer M6, pin 6x20, cap 14x10,
    bracket 25x10x12 (lengths in mm); t-shape takes --ratio. Bolts, screws, nuts and washers have the nominal
    sizes of their standard. A thread is a cylinder as thick as its major diameter.
    """
    from feederscrew.base.columns import of_records
    from feederscrew.jobs.samples import catalogue

    out = Output.of_call(format=format, quiet=quiet)
    if name is None and not everything:
        frame = of_records(catalogue.SAMPLE_COLUMNS, catalogue.samples())
        out.show(frame, {"samples": list(frame.rows())})
        out.say("Write one with its call: feeder sample washer_m6")
        return
    if name is not None and everything:
        raise click.UsageError("--all writes every file: leave the name out, or --all")
    contents = (
        catalogue.all_files()
        if name is None
        else catalogue.files(name, size, ratio=ratio, wall=wall, step=step)
    )
    written, alike = catalogue.write(contents, Path(), replace=replace)
    out.say(*(f"Wrote {file}" for file in written), *(f"{file} is there already, the same" for file in alike))
