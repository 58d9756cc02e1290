"""``feeder batch``."""

from typing import Any

import click

from feederscrew_cli import grouped, options, orientation
from feederscrew_cli.interrupt import end_within, exit_status
from feederscrew_cli.options import WHOLE_NUMBER, Output
from feederscrew_cli.progress import Progress

END_AFTER_S = 6.0  # [s] from Ctrl-C to the end, whatever is loading


def process_count(value: str) -> int | None:
    """Return a number of processes.

    Parameters
    ----------
    value : str
        As typed: '4' or 'auto'.

    Returns
    -------
    int or None
        None of 'auto'.

    Raises
    ------
    click.BadParameter
        If it is not a whole number above 0.
    """
    if value == "auto":
        return None
    if not WHOLE_NUMBER.fullmatch(value) or not int(value) > 0:
        raise click.BadParameter(f"{value!r} is not a number of processes - give 1, 2, ... or auto")
    return int(value)


@grouped.command(short_help="Aspects, conveying and rate of any number of parts, in parallel.")
@click.argument("sources", metavar="PARTS...", nargs=-1, required=True, type=options.FILE)
@options.option(
    "--config configs", "FILE", "Bowl file or folder; may be repeated.", multiple=True, type=options.FILE
)
@options.overrides
@options.DENSITY
@options.rule
@orientation.LAUNCHED
@options.whole("--drops", 0, 10**7, "Simulated drops of each part; none without it.", default=0)
@options.option("--jobs", "N|auto", "Processes of this machine.  [default: auto]", type=process_count)
@options.option(
    "--scheduler",
    "ADDRESS",
    envvar="DASK_SCHEDULER_ADDRESS",
    text="Work on this Dask cluster: tcp://host:8786.  [default: $DASK_SCHEDULER_ADDRESS, if set]",
)
@options.flag("--resume", "Go on where a batch stopped: only what is missing or changed.")
@options.drawn_output
@click.pass_context
def batch(
    ctx: click.Context,
    rule: str,
    launch: str | None,
    drops: int,
    jobs: int | None,
    scheduler: str | None,
    resume: bool,
    out: Output,
    **inputs: Any,
) -> None:
    """Example: feeder batch squarenut_m5.stl washer_m6.stl --config bowl.yaml -o results/all --jobs 2

    Compute every part in every bowl: its aspects, how it travels, and a rate. The rate is that of the
    orientation that leaves the bowl most often, or of the aspect that a list asks for. How often parts
    lie on each aspect is what arrives from the bowl's moving floor, as for `feeder rate`. This takes one
    to five seconds a part.

    A part that fails is reported, and the others go on. Exit status 1 says
    that some failed. Ctrl-C stops it with exit status 130 and a summary of what is done; --resume goes on.

    PARTS are part files, folders of them (or of folders of them), patterns ("parts/**/*.stl") and lists.
    A list is a CSV whose first line names its columns: part, units, density, centre_of_mass, body, names,
    aspect and config, or some. -o DIR gets summary.csv with a row a part, index.html, contact_sheet.png,
    and a folder a part in DIR/parts.
    """
    ctx.with_resource(end_within(END_AFTER_S))
    from feederscrew.base.units import counted
    from feederscrew.jobs import batch as batches
    from feederscrew.jobs.batch import summary

    if out.directory is None:
        raise click.UsageError("Missing option '-o' - say where the results go")
    requests = batches.gather(**inputs)
    out.warn(*batches.find_folders_within(inputs["sources"]))
    out.warn(*dict.fromkeys(line for request in requests for line in request.conditions.warnings))
    workers = batches.crew(jobs, None if options.is_typed("jobs") else scheduler)
    chosen = batches.Choices(rule=rule, launch=launch, drops=drops, pictures=out.pictures)
    if resume:
        reasons = batches.count_stale(requests, out.directory, chosen)
        if reasons:
            why = ", ".join(f"{count} {reason}" for reason, count in reasons.items())
            out.say(f"Computes {sum(reasons.values())} of {len(requests)} parts: {why}")
    try:
        with Progress(len(requests), not out.quiet) as progress:
            result = batches.run(
                requests, out.directory, workers=workers, choices=chosen, resume=resume, tell=progress.tell
            )
    except batches.StoppedBatchError as stopped:
        out.say(f"Wrote {stopped.summary} (what is done; the rest is 'not computed')")
        count = f"{stopped.done} of {stopped.total} parts {'is' if stopped.done == 1 else 'are'} done"
        click.echo(f"Stopped: {count}; go on with --resume", err=True)
        ctx.exit(exit_status())
    out.depend(result.targets, result.sources)
    out.fault(*result.faults)
    if len(result.foreign) == 1:
        out.warn(f"1 folder is of a part not in this batch: {result.foreign[0]}")
    elif result.foreign:
        folders = f"{len(result.foreign)} folders are of parts"
        out.warn(f"{folders} not in this batch: {result.foreign[0]}, ...")
    reused = f", {result.reused} of them as they were" if result.reused else ""
    out.say(f"Wrote {out.directory} ({counted(len(result.rows), 'part')}{reused}; open index.html)")
    out.show(summary.frame(result.rows), {"parts": list(result.rows)}, hidden=summary.HIDDEN_SUMMARY_COLUMNS)
    ctx.exit(1 if result.faults else 0)
