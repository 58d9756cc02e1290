"""``feeder drop``."""

import os
import sys

import click

from cli import options

LAUNCHES = click.Choice(["place", "drop", "tumble"])


def conditions(command):
    """A launch preset and the ranges that replace its own."""
    for option in reversed(
        [
            click.option(
                "--launch", type=LAUNCHES, default="tumble", show_default=True, help="How it comes in."
            ),
            click.option("--height", "fall", metavar="LENGTH", help='Fall: "20 mm" or "5 mm:50 mm".'),
            click.option("--spin", metavar="RATE", help='How fast it turns: "20 rad/s".'),
            click.option("--speed", metavar="SPEED", help='Along the plane: "0.3 m/s".'),
            click.option("--restitution", metavar="E", help="Of a corner hit: 0.3 or 0.1:0.5."),
            click.option("--friction", metavar="MU", help="Against the plane: 0.4 or 0.3:0.6."),
        ]
    ):
        command = option(command)
    return command


@click.command(short_help="A virtual drop test: how often a part lands on each aspect.")
@options.part
@conditions
@click.option("--drops", type=click.IntRange(1, 10_000_000), help="How many.  [default: 10000]")
@click.option("--until", metavar="SHARE", help='Go on until no 95 % interval is wider: "1%" to either side.')
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True, help="Of the random launches.")
@click.option("--jobs", type=click.IntRange(1, 256), metavar="N", help="Cores to use.  [default: all]")
@options.pictures
@options.output
def drop(part, launch, drops, until, seed, jobs, pictures, out, **own):
    """Example: feeder drop parts/lbracket_30x20x15.stl --launch tumble --until 1% -o results

    Drop PART on a hard plane, again and again, each time from a launch drawn from the ranges of
    --launch (place: set down by hand; drop: let fall without spin; tumble: thrown in, as parts leave
    a bowl's floor) or from your own ranges, and count the aspects it comes to rest on.

    p_drop_low and p_drop_high are the 95 % interval of the sampling; p_gentle and p_violent the shares
    among the third of the launches with the least and with the most energy. The same seed gives the same
    counts whatever the number of jobs. With -o: drop.csv, drop.json, drop.png and run.json.
    """
    from feederscrew.output import columns, drop_sheets
    from feederscrew.resting.aspects import find
    from feederscrew.resting.drop import report

    solid = out.part(part)
    aspects = find(solid)
    announce(out)
    until = {"drops": drops, "until": until, "seed": seed, "jobs": jobs or os.cpu_count()}
    with out.folder(solid.name, {solid.source: solid.sha256}, columns.conditions(solid)) as folder:
        result = report.test(solid, aspects, launch, own, progress=progress(out), **until)
        document = drop_sheets.document(solid, aspects, result)
        out.warn(*drop_sheets.remarks(document))
        if folder:
            drop_sheets.write(folder, solid, aspects, result, document, pictures=pictures)
    out.show(document["aspects"], document)


def announce(out):
    """Say so when the first drop on this machine must wait for the compiler."""
    from feederscrew.resting.drop import report

    if not report.compiled():
        out.say("Compiling the drop kernel, once on this machine: about twenty seconds.")


def progress(out):
    """A function that shows how far the test is where a person waits; None elsewhere."""
    if out.quiet or not sys.stderr.isatty():
        return None

    def show(done, total):
        click.echo(f"\r{done} of {total} drops", nl=done == total, err=True)

    return show
