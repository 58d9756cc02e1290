"""``feeder rate``."""

import click

from feederscrew_cli import options, orientation


@click.command(short_help="Well-oriented parts per minute, with each factor of the chain.")
@options.part
@orientation.chain
@options.bowl
@options.output
def rate(part, aspect, heading, rule, gap, fill, bowl, out):
    """Example: feeder rate parts/lbracket_30x20x15.stl --aspect A --config bowl.yaml

    Parts per minute in the wanted aspect and heading: velocity over pitch, times the probability
    of that orientation, the share of it that passes the track and its devices, and the fill.

    Devices are a list in the bowl file, in the order parts meet them:
    'devices:' with lines such as '- wiper: 6 mm', '- height_bar: 5 mm', '- narrowed_track: 8 mm',
    '- pressure_break: 10 mm' and '- yield:' with the share that passes for each aspect below it.
    With -o: rate.json and orientations.csv, what each device does with each orientation.
    """
    from feederscrew import bowl as bowls
    from feederscrew.output import columns
    from feederscrew.output.rate import tables as rate_tables
    from feederscrew.rates import queue

    solid, feeder = out.part(part), bowls.read(**bowl)
    effective = columns.conditions(solid) | bowls.texts(bowls.settings(**bowl))
    with out.folder(solid.name, {solid.source: solid.sha256}, effective) as folder:
        aspects, known, target = orientation.stream(out, solid, feeder.track, bowl["path"], aspect, heading)
        found = queue.rate(known, queue.velocity(feeder), target, rule, gap=gap, fill=fill)
        document = columns.part(solid, aspects.warnings) | rate_tables.document(found, rule)
        out.warn(*aspects.warnings, *rate_tables.remarks(found))
        rate_tables.write(folder, document)
        out.show(rate_tables.summary(document), document)
