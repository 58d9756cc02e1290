"""``feeder calibrate``."""

import click

from feederscrew_cli import options


@click.command(short_help="The surface exponent that your own counts ask for.")
@options.part
@click.option(
    "--with", "counts", metavar="CSV", required=True, type=options.Place(), help="Counted parts by aspect."
)
@options.output
def calibrate(part, counts, out):
    """Example: feeder calibrate parts/lbracket_30x20x15.stl --with counts.csv

    Fit the exponent of p_surface, quasi-static basin times (R - h)^exponent, to counts of PART by maximum
    likelihood: the exponent with its 95 % interval, and whether it explains the counts (chi-square). Give
    it to `feeder aspects --surface-exponent`.

    The CSV is that of `feeder compare`: a line 'aspect,NAME,...', then one line an aspect; columns that
    hold whole numbers are counts. With -o: calibrate.csv, calibrate.json and run.json.
    """
    from feederscrew.output import columns
    from feederscrew.output.profiles import calibration_tables as calibrate_tables
    from feederscrew.resting.aspects import find
    from feederscrew.resting.counts import profiles
    from feederscrew.resting.counts.calibration_file import fits

    solid = out.part(part)
    aspects = find(solid)
    measured = profiles.read(counts, aspects.names)
    found = fits(solid, aspects, measured)
    out.warn(*calibrate_tables.remarks(found))
    document = calibrate_tables.document(solid, aspects, found)
    inputs = {solid.source: solid.sha256, measured.source: measured.sha256}
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        if folder:
            calibrate_tables.write(folder, document)
    out.show(document["calibrations"], document)
