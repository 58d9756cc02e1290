"""``feeder tune``."""

import click

from feederscrew_cli import options, orientation
from feederscrew_cli.convey import announce
from feederscrew_cli.quantity import Quantity


@click.command(short_help="Amplitude, angle or frequency that reaches a rate.")
@options.part
@click.option(
    "--target",
    type=Quantity("rate", positive=True),
    required=True,
    metavar="RATE",
    help="Well-oriented parts: 120/min.",
)
@orientation.chain
@options.bowl
@options.output
def tune(part, target, aspect, heading, rule, gap, fill, bowl, out):
    """Example: feeder tune parts/lbracket_30x20x15.stl --aspect A --target 20/min

    Every setting of amplitude, vibration angle or frequency alone that reaches the target, one-way
    and gentle motions first, each with its regime, hardest impact, the margins to slip forward, slip
    back and hop (below 0: beyond it), and the rate if friction is a fifth lower or higher.
    With -o: tune.csv and tune.json.
    """
    from feederscrew import bowl as bowls
    from feederscrew.output import columns
    from feederscrew.output.rate import tune_tables
    from feederscrew.rates import queue, tune

    solid, feeder = out.part(part), bowls.read(**bowl)
    effective = columns.conditions(solid) | bowls.texts(bowls.settings(**bowl))
    with out.folder(solid.name, {solid.source: solid.sha256}, effective) as folder:
        aspects, known, wanted = orientation.stream(out, solid, feeder.track, bowl["path"], aspect, heading)
        announce(out)
        density = queue.parts_per_metre(known, wanted, rule, gap=gap, fill=fill)
        frame = tune_tables.settings(tune.solutions(feeder, target, density), feeder, density)
        out.warn(*aspects.warnings)
        document = columns.part(solid, aspects.warnings) | {"settings": frame}
        tune_tables.write(folder, document)
        out.show(frame if out.format == "csv" else tune_tables.summary(frame), document)
