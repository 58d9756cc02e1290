"""``feeder calibrate``."""

import click

from feederscrew_cli import grouped, options
from feederscrew_cli.values import Place


@grouped.command(short_help="Fit the surface exponent to your own counts.")
@options.part
@click.option("--with", "counts", metavar="CSV", required=True, type=Place(), help="Counted parts by aspect.")
@options.output
def calibrate(part, counts, out):
    """Example: feeder calibrate parts/lbracket_30x20x15.stl --with counts.csv

    Fit the exponent of p_surface to counts of PART by maximum likelihood. p_surface is the quasi-static
    basin times (R - h)^exponent. Printed are the exponent with its 95 % interval, and whether it explains
    the counts (chi-square). Give it to `feeder aspects --surface-exponent`.

    The CSV is that of `feeder compare`: the line 'aspect,NAME,...', then one line an aspect. Columns
    that hold whole numbers are counts. With -o: calibrate.csv, calibrate.json and run.json.
    """
    from feederscrew.output import columns, offers
    from feederscrew.output import compare as compare_output
    from feederscrew.studies.calibrate import calibrate as calibrate_study

    solid = out.part(part)
    study = calibrate_study(solid, counts)
    out.warn(*study.measured.warnings(solid), *compare_output.calibration_remarks(study))
    inputs = solid.inputs | {study.measured.source: study.measured.sha256}
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        offers.write(folder, compare_output.calibration_offers(study))
    out.show(compare_output.exponents(study), compare_output.calibration_document(study))
