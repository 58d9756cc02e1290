"""``feeder drop --launches``: its run."""

from dataclasses import replace

import click

from feederscrew_cli import waiting
from feederscrew_cli.interrupt import held_back
from feederscrew_cli.values import Place

FOREIGN = {"fall": "--height", "spin": "--spin", "speed": "--speed"}  # what the file says instead
launches = click.option(
    "--launches",
    metavar="FILE",
    type=Place(),
    help="Follow each launch of a CSV file from its own state, in place of random ones.",
)


def run(part, path, own, test, pictures, out):
    """Follow the launches of a file, write and tell where they lead."""
    _fitting(own, test)
    with held_back():
        from feederscrew.output import columns, offers
        from feederscrew.output import tosses as tosses_output
        from feederscrew.studies import tosses as tosses_study

    out = replace(out, command="drop launches")
    solid = out.part(part)
    with waiting.bar(out, "tosses") as bar:
        values = {"progress": bar.reach, "before": lambda: waiting.drops(out)}
        run = {"runs": test["drops"], "seed": test["seed"], "jobs": test["jobs"]}
        study = tosses_study.follow(solid, path, own, **values, **run)
    inputs = solid.inputs | {study.launches.source: study.launches.sha256}
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        out.warn(*tosses_output.remarks(study))
        out.say(*tosses_output.summary(study))
        offers.write(folder, tosses_output.offers(study), pictures=pictures)
    out.show(
        tosses_output.tosses(study), tosses_output.document(study), hidden=tosses_output.HIDDEN_TOSS_COLUMNS
    )


def _fitting(own, test):
    """Wrong calls."""
    context = click.get_current_context()
    has_launch = context.get_parameter_source("launch") is click.core.ParameterSource.COMMANDLINE
    foreign = ["--launch"] * has_launch + [option for key, option in FOREIGN.items() if own[key] is not None]
    foreign += [option for key, option in (("until", "--until"), ("traced", "--trace")) if test[key]]
    if foreign:
        raise click.UsageError(f"{foreign[0]} cannot be combined with --launches - leave one of them out")
