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
    from feederscrew.output import columns, offers
    from feederscrew.output.rate import files, tables
    from feederscrew.rates import devices
    from feederscrew.studies.rate import rate as study

    solid, settings, chain = out.part(part), bowls.settings(**bowl), devices.read(bowl["path"])
    effective = columns.conditions(solid) | bowls.texts(settings)
    with out.folder(solid.name, {solid.source: solid.sha256}, effective) as folder:
        found = study(
            solid, bowls.record(settings), aspect,
            heading=heading, rule=rule, devices=chain, gap=gap, fill=fill,
        )  # fmt: skip
        document = tables.document(found)
        out.warn(*found.warnings, *tables.remarks(found))
        offers.write(folder, files.offers(found))
        out.show(tables.summary(document), document)
