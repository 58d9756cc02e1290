"""``feeder compare``."""

from pathlib import Path

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.values import Place


@grouped.command(short_help="Measured aspects against every rule, of one part or over many files.")
@options.parts
@click.option("--with", "counts", metavar="CSV", type=Place(), help="Counts or fractions of PART.")
@click.option(
    "--launch", type=options.LAUNCHES, help="What was done to PART.  [default: as the file says, else feed]"
)
@click.option("--as-published", is_flag=True, help="Count each class once in PMI, as Tables 3-8 and 3-9 do.")
@click.option(
    "--bowl",
    "bowl",
    metavar="FILE",
    type=options.FILE,
    help="Bowl file of the bowl in which FILE was filmed: fit friction, restitution and stroke to it.",
)
@options.pictures
@options.output
def compare(sources, reading, counts, launch, as_published, bowl, pictures, out):
    """Example: feeder compare parts/arc_chute.yaml --with counts.csv -o results

    How far your counts of PART are from each rule. Three measures: the deviation of the thesis's
    Tables 3-12 and 3-13 (square root of the mean squared difference), the total variation, and for
    counts the chi-square test.

    The CSV begins with the line 'aspect,NAME,...'. One line an aspect follows, by the names that
    `feeder aspects` gives. It may also have one line an orientation: 'orientation,NAME,...', then
    'A@180,...'. Whole numbers are counts. Other columns hold fractions that sum to 1, or percents that
    sum to 100. Lines that begin with # are comments. Above the table, '# launch: roll', '# part: FILE'
    and other keys say what was done (docs/counts.md). The test joins aspects of which fewer than five
    are expected.

    Without --with, every FILE is such a CSV and its head names its part (feeder compare
    docs/measured/*.csv). The table has the total variation of each set from each rule, and from the
    recommended answer for its launch. With -o: compare.csv, compare.png and run.json.

    A feeding test counts by device ('device,passed,rejected') and names its bowl ('# config: FILE').
    The share that passed each device then stands beside what the static rules say, with both intervals
    (devices.csv).

    With --bowl the one FILE has velocities that were filmed in that bowl: columns of bowl-file keys that
    were changed ('drive.amplitude'), then 'velocity_mm_s', and 'spread_mm_s' and 'parts'. The answer is
    friction, restitution and stroke with their intervals, and what remains of each velocity
    (bowl_fit.csv, velocities.csv). How to measure: docs/validation.md.

    The acceptance.csv of `feeder design`, filled in at the machine, is read back: it says line by line
    what agrees with what was computed.
    """
    from feederscrew.designing import acceptance_sheet

    if bowl is not None:
        _fitted(sources, bowl, out)
    elif counts is None and len(sources) == 1 and acceptance_sheet.is_sheet(sources[0]):
        _accepted(sources[0], out)
    elif counts is None:
        _over_files(sources, launch, as_published, pictures, out)
    elif len(sources) > 1:
        raise click.UsageError("--with goes with one PART - leave it out to compare many files")
    else:
        _of_part(reading | {"source": sources[0]}, counts, launch, as_published, pictures, out)


def _fitted(sources, bowl, out):
    """What explains the velocities of one bowl."""
    from feederscrew import bowl as bowls
    from feederscrew.output import compare as compare_output
    from feederscrew.output import offers
    from feederscrew.studies.bowl_fit import fit_bowl

    if len(sources) > 1:
        raise click.UsageError(
            "--bowl goes with one file of velocities - compare counts in a call of their own"
        )
    study = fit_bowl(sources[0], bowl)
    inputs = bowls.identity(sources[0]) | bowls.identity(bowl)
    with out.folder("bowl_fit", inputs) as folder:
        offers.write(folder, compare_output.fit_offers(study))
    out.say(compare_output.fit_remark(study))
    out.show(compare_output.fit_quantities(study), compare_output.fit_document(study))
    if out.format == "table":
        out.show(compare_output.fit_velocities(study), compare_output.fit_document(study))


def _accepted(source, out):
    """A filled-in acceptance sheet."""
    from feederscrew.designing import acceptance_sheet
    from feederscrew.output import designs

    lines = acceptance_sheet.sheet(source)
    out.show(designs.accepted_summary(lines), designs.accepted_document(lines))


def _of_part(part, counts, launch, as_published, pictures, out):
    """One part against one file."""
    from feederscrew.output import columns, offers
    from feederscrew.output.compare import of_kind
    from feederscrew.studies.compare import compare as compare_study

    solid = out.part(part)
    chosen = {"launch": launch, "as_published": as_published}
    study = compare_study(solid, counts, **chosen, **orientation.telling(out))
    out.warn(*study.warnings)
    offered, printed, hidden, document = of_kind(study)
    inputs = solid.inputs | study.inputs
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        out.say(*study.measured.notes)
        offers.write(folder, offered(study), pictures=pictures)
    out.show(printed(study, out.format), document(study), hidden=hidden(study))


def _over_files(sources, launch, as_published, pictures, out):
    """Many files, each with its own part."""
    from feederscrew.output import compare as compare_output
    from feederscrew.output import offers
    from feederscrew.studies.compare import compare_sets

    if any(Path(source).suffix.lower() != ".csv" for source in sources):
        raise click.UsageError("Missing option '--with' - or name CSV files that say which part they are of")
    with progress.bar(out, "files") as bar:
        study = compare_sets(sources, launch=launch, as_published=as_published, progress=bar.reach)
    out.warn(*study.warnings)
    with out.folder("measured", study.inputs) as folder:
        offers.write(folder, compare_output.sets_offers(study), pictures=pictures)
    for frame in compare_output.sets_printed(study, out.format):
        out.show(frame, compare_output.sets_document(study), spare=compare_output.SPARE_RULES)
