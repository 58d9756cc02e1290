"""``feeder compare`` and ``feeder calibrate``: what was counted or filmed beside what is computed."""

from pathlib import Path

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.options import Output, Values


@grouped.command(short_help="Measured aspects against every rule, of one part or over many files.")
@options.parts
@options.path("--with counts", "CSV", "Counts or fractions of PART.")
@options.choice(
    "--launch", options.LAUNCHES, "What was done to PART.  [default: as the file says, else feed]"
)
@options.as_published("Count each class once in PMI, as Tables 3-8 and 3-9 do.")
@options.option(
    "--bowl bowl",
    "FILE",
    type=options.FILE,
    text="Bowl file of the bowl in which FILE was filmed: fit friction, restitution and stroke to it.",
)
@options.drawn_output
def compare(
    sources: tuple[str, ...],
    reading: Values,
    counts: str | None,
    launch: str | None,
    as_published: bool,
    bowl: str | None,
    out: Output,
) -> None:
    """Example: feeder compare lbracket_30x20x15.stl --with counts.csv -o results

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

    The acceptance.csv of `feeder design`, filled in at the machine, is judged by its demands, line by
    line: agrees, does not, or not shown where the sample is too small for 95 % confidence.
    """
    from feederscrew import bowl as bowls
    from feederscrew.designing import acceptance_sheet
    from feederscrew.feeding import compare as study_of
    from feederscrew.output import compare as compare_output
    from feederscrew.output import designs

    if bowl is not None:  # what explains the velocities of one bowl
        if len(sources) > 1:
            what = "--bowl goes with one file of velocities - compare counts in a call of their own"
            raise click.UsageError(what)
        out.check_folder("bowl_fit")
        fit = study_of.fit_bowl(sources[0], bowl)
        with out.folder("bowl_fit", bowls.identity(sources[0]) | bowls.identity(bowl)) as folder:
            out.write(folder, compare_output.fit_offers(fit))
        document = compare_output.fit_document(fit)
        out.say(document["remark"])
        out.show(document["quantities"], document)
        if out.format == "table":
            out.show(document["velocities"], document)
    elif counts is not None:  # one part against one file
        if len(sources) > 1:
            raise click.UsageError("--with goes with one PART - leave it out to compare many files")
        solid = out.part(reading | {"source": sources[0]})
        keywords = orientation.progress_keywords(out)
        study = study_of.compare(solid, counts, launch=launch, as_published=as_published, **keywords)
        out.warn(*study.warnings)
        with out.folder_of(solid, study.inputs) as folder:
            out.say(*study.measured.notes)
            out.write(folder, compare_output.offers(study))
        frame, document, hidden = compare_output.printout(study, out.format)
        out.show(frame, document, hidden=hidden)
    elif len(sources) == 1 and acceptance_sheet.is_sheet(sources[0]):  # filled in at the machine
        lines = acceptance_sheet.sheet(sources[0])
        out.show(designs.accepted_summary(lines), designs.accepted_document(lines))
    else:  # many files, each with its own part
        if any(Path(source).suffix.lower() != ".csv" for source in sources):
            what = "Missing option '--with' - or name CSV files that say which part they are of"
            raise click.UsageError(what)
        out.check_folder("measured")
        with progress.bar(out, "files") as bar:
            sets = study_of.compare_sets(
                sources, launch=launch, as_published=as_published, progress=bar.reach
            )
        out.warn(*sets.warnings)
        with out.folder("measured", sets.inputs) as folder:
            out.write(folder, compare_output.sets_offers(sets))
        for frame in compare_output.sets_printout(sets, out.format):
            out.show(frame, compare_output.sets_document(sets), spare=compare_output.SPARE_RULES)


@grouped.command(short_help="Fit the surface exponent to your own counts.")
@options.part
@options.path("--with counts", "CSV", "Counted parts by aspect.", required=True)
@options.output
def calibrate(part: Values, counts: str, out: Output) -> None:
    """Example: feeder calibrate lbracket_30x20x15.stl --with counts.csv

    Fit the exponent of p_surface to counts of PART by maximum likelihood. p_surface is the quasi-static
    basin times (R - h)^exponent. Printed are the exponent with its 95 % interval, and whether it explains
    the counts (chi-square). Give it to `feeder aspects --surface-exponent`.

    The CSV is that of `feeder compare`: the line 'aspect,NAME,...', then one line an aspect. Columns
    that hold whole numbers are counts. With -o: calibrate.csv, calibrate.json and run.json.
    """
    from feederscrew.feeding.compare import calibrate as calibrate_study
    from feederscrew.output import compare as compare_output

    solid = out.part(part)
    study = calibrate_study(solid, counts)
    out.warn(*study.measured.warnings(solid), *compare_output.calibration_remarks(study))
    with out.folder_of(solid, study.inputs) as folder:
        out.write(folder, compare_output.calibration_offers(study))
    out.show(compare_output.exponents(study), compare_output.calibration_document(study))
