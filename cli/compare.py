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
    from feederscrew.output import columns
    from feederscrew.output.profiles import tables as profile_tables
    from feederscrew.resting.aspects import find
    from feederscrew.resting.counts import deviation, profiles

    solid = out.part(part)
    found = find(solid, as_published=as_published)
    out.warn(*found.warnings)
    rules = profiles.of_rules(found)
    measured = profiles.read(counts, found.names, [rule.name for rule in rules])
    every = (*measured.profiles, *rules)
    compared, inputs = deviation.compare(every), {p.source: p.sha256 for p in (solid, measured)}
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        out.say("\n".join(measured.notes))
        if folder:
            profile_tables.write(folder, solid.name, found.names, every, compared, pictures=pictures)
    document = {"part": solid.name, **profile_tables.document(found.names, every, compared)}
    out.show(profile_tables.comparisons(compared, out.format), document)
