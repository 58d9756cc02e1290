"""``feeder compare``."""

import click

from feederscrew_cli import options


@click.command(short_help="Measured aspects against every rule.")
@options.part
@click.option(
    "--with",
    "counts",
    metavar="CSV",
    required=True,
    type=options.Place(),
    help="Counts or fractions by aspect.",
)
@click.option("--as-published", is_flag=True, help="Count each class once in PMI, as Tables 3-8 and 3-9 do.")
@options.pictures
@options.output
def compare(part, counts, as_published, pictures, out):
    """Example: feeder compare parts/arc_chute.yaml --with counts.csv -o results

    How far what was measured on PART is from each rule, and from the rest: the deviation of the
    thesis's Tables 3-12 and 3-13 (square root of the mean squared difference), the total variation,
    and the chi-square test where there are counts.

    The CSV opens with a line 'aspect,NAME,...'; then comes one line an aspect of the part, by the names
    that `feeder aspects` gives. Whole numbers are counts; else a column holds fractions that sum to 1
    or percents that sum to 100. Lines that begin with # are comments. Aspects of which fewer than five
    are expected are joined for the test. With -o: compare.csv, compare.png and run.json.
    """
    from feederscrew.output import columns, offers
    from feederscrew.output.compare import files, tables
    from feederscrew.studies.compare import compare as compare_study

    solid = out.part(part)
    study = compare_study(solid, counts, as_published=as_published)
    out.warn(*study.aspects.warnings)
    inputs = {each.source: each.sha256 for each in (solid, study.measured)}
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        out.say("\n".join(study.measured.notes))
        offers.write(folder, files.offers(study), pictures=pictures)
    out.show(tables.comparisons(study), tables.document(study), hidden=tables.hidden(study))
